//! Pressure inside of the cells of a solved contact.
//!
//! A solver's pressure is uniform over each cell, and right for what is farther off than a cell or
//! two. Within that
//!
//! - inside the contact p is linear in a cell, with the slope of its neighbours;
//! - near the edge it is the root of a polynomial ([`super::edge`]);
//! - where neither is known it stays uniform.
//!
//! What p in a cell differs from its mean has a first moment, m per cell, which is felt far off. It
//! is left to the convolution, as ±m/2 on the neighbours: what remains is a load without force and
//! moment, which is felt within a few cells only ([`super::near`]). Inside the contact the solver's
//! pressure holds those shares already.

use rayon::prelude::*;

use super::cut::{Piece, pieces};
use super::edge::{BAND, EdgeCell, Square, around, distances, edge_cells};

/// The pressure of a solved contact, in cells and within them.
#[derive(Debug)]
pub(super) struct Reconstruction {
    /// What is to be taken as uniform over cells, at all depths.
    pub(super) uniform: Vec<f64>,
    /// Slopes within cells, per cell, along x and y; 0 where p is not linear.
    pub(super) slopes: [Vec<f64>; 2],
    /// Where p is the root of a polynomial.
    pub(super) roots: Vec<RootCell>,
}

/// A cell near the edge.
#[derive(Debug, Clone, Copy)]
pub(super) struct RootCell {
    pub(super) cell: [usize; 2],
    pub(super) square: Square,
    pub(super) mean: f64,
    /// First moments of p over the cell, along x and y.
    pub(super) moments: [f64; 2],
    /// Change of the mean per change of p².
    rate: f64,
}

/// Second moment of a cell.
pub(super) const INERTIA: f64 = 1.0 / 12.0;

/// Pieces along each side of a cell for its mean.
const FINE: usize = 15;

/// Steps that move the edge until it bears the force of the solver's cells.
const STEPS: usize = 3;

/// Cells to each side that bear it together.
const TOGETHER: usize = 5;

impl Reconstruction {
    pub(super) fn new(pressure: &[f64], shape @ [nx, ny]: [usize; 2]) -> Self {
        let line = nx == 1;
        let distances = distances(pressure, shape, BAND + 1);
        let fine = pieces(Piece::WHOLE, FINE, line);
        let inside = |cell: usize| distances[cell] > BAND;
        let mut slopes = [vec![0.0; pressure.len()], vec![0.0; pressure.len()]];
        for cell in (0..pressure.len()).filter(|cell| inside(*cell)) {
            slopes[1][cell] = 0.5 * (pressure[cell + 1] - pressure[cell - 1]);
            if !line {
                slopes[0][cell] = 0.5 * (pressure[cell + ny] - pressure[cell - ny]);
            }
        }
        let mut edges = edge_cells(pressure, &distances, shape);
        let mut roots = root_cells(&edges, &fine, line);
        let mut uniform = convolved(pressure, &inside, &slopes, &roots, shape);
        for _ in 0..STEPS {
            let moves = moves(pressure, &uniform, &roots, shape);
            for (edge, by) in edges.iter_mut().zip(moves) {
                edge.square.raise(by);
            }
            roots = root_cells(&edges, &fine, line);
            uniform = convolved(pressure, &inside, &slopes, &roots, shape);
        }
        Self {
            uniform,
            slopes,
            roots,
        }
    }
}

/// What is to be taken as uniform over cells: means and shares.
fn convolved(
    pressure: &[f64],
    inside: &impl Fn(usize) -> bool,
    slopes: &[Vec<f64>; 2],
    roots: &[RootCell],
    [nx, ny]: [usize; 2],
) -> Vec<f64> {
    let mut means = pressure.to_vec();
    // First moments, where p is known within the cell.
    let moment = |cell: usize| [0, 1].map(|axis| INERTIA * slopes[axis][cell]);
    let known = |cell: usize| inside(cell).then(|| moment(cell));
    let mut moments: Vec<Option<[f64; 2]>> = (0..pressure.len()).map(known).collect();
    for root in roots {
        let cell = root.cell[0] * ny + root.cell[1];
        means[cell] = root.mean;
        moments[cell] = Some(root.moments);
    }
    let mut uniform = means.clone();
    for (cell, uniform) in uniform.iter_mut().enumerate() {
        let (i, j) = (cell / ny, cell % ny);
        let (mut shares, mut held) = (0.0, inside(cell));
        let mut share = |within: bool, neighbour: usize, axis: usize, half: f64| {
            let moment = Some(neighbour)
                .filter(|_| within)
                .and_then(|cell| moments[cell]);
            match moment {
                Some(moment) => shares += half * moment[axis],
                None => held = false,
            }
        };
        share(j > 0, cell.wrapping_sub(1), 1, 0.5);
        share(j + 1 < ny, cell + 1, 1, -0.5);
        if nx > 1 {
            share(i > 0, cell.wrapping_sub(ny), 0, 0.5);
            share(i + 1 < nx, cell + ny, 0, -0.5);
        }
        if !held {
            *uniform += shares;
        }
    }
    uniform
}

/// By how much p² is to be raised, for the cells around each to bear the force that they are given.
fn moves(pressure: &[f64], uniform: &[f64], roots: &[RootCell], shape: [usize; 2]) -> Vec<f64> {
    let ny = shape[1];
    let mut rates = vec![0.0; pressure.len()];
    for root in roots {
        rates[root.cell[0] * ny + root.cell[1]] = root.rate;
    }
    let move_of = |root: &RootCell| {
        let (mut force, mut rate) = (0.0, 0.0);
        for [i, j] in around(shape, root.cell, TOGETHER) {
            let cell = i * ny + j;
            force += pressure[cell] - uniform[cell];
            rate += rates[cell];
        }
        if rate > 0.0 { force / rate } else { 0.0 }
    };
    roots.par_iter().map(move_of).collect()
}

fn root_cells(edges: &[EdgeCell], fine: &[Piece], line: bool) -> Vec<RootCell> {
    edges
        .par_iter()
        .map(|edge| root_cell(*edge, fine, line))
        .collect()
}

fn root_cell(edge: EdgeCell, fine: &[Piece], line: bool) -> RootCell {
    let EdgeCell { cell, square } = edge;
    // A hundredth of a cell.
    let step = 0.01 * square.varies([1.0, 1.0]);
    let mut raised = square;
    raised.raise(step);
    let (mut mean, mut moments) = (0.0, [0.0; 2]);
    for piece in fine {
        let p = piece.area() * root(&square, piece, 1, line);
        mean += p;
        moments[0] += p * piece.centre[0];
        moments[1] += p * piece.centre[1];
    }
    let higher: f64 = fine
        .iter()
        .map(|piece| piece.area() * root(&raised, piece, 1, line))
        .sum();
    RootCell {
        cell,
        square,
        mean,
        moments,
        rate: (higher - mean) / step,
    }
}

/// Mean of √max(p², 0) over a piece, of `count` points along each side; four times as many where the
/// edge is in reach.
pub(super) fn root(square: &Square, piece: &Piece, count: usize, line: bool) -> f64 {
    let [u, v] = piece.centre;
    let [hu, hv] = piece.half.map(|half| half / count as f64);
    let place = |k: usize, count: usize| (2 * k + 1) as f64 - count as f64;
    let rows = |count: usize| if line { 1 } else { count };
    let range = |count: usize| (0..rows(count)).flat_map(move |a| (0..count).map(move |b| (a, b)));
    let mut sum = 0.0;
    for (a, b) in range(count) {
        let u = if line { u } else { u + hu * place(a, count) };
        let v = v + hv * place(b, count);
        let varies = 2.0 * square.varies([hu, hv]);
        let value = square.at(u, v);
        if value > varies {
            sum += value.sqrt();
        } else if value > -varies {
            const FINER: usize = 4;
            let part: f64 = range(FINER)
                .map(|(a, b)| {
                    let step = |h: f64, k: usize| h * place(k, FINER) / FINER as f64;
                    let u = if line { u } else { u + step(hu, a) };
                    square.at(u, v + step(hv, b)).max(0.0).sqrt()
                })
                .sum();
            sum += part / (rows(FINER) * FINER) as f64;
        }
    }
    sum / (rows(count) * count) as f64
}
