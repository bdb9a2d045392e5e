//! Pressure inside of the cells of a solved contact.
//!
//! A solver's pressure is uniform over each cell, and right for what is farther off than a cell or
//! two. Within that
//!
//! - inside the contact p is parabolic in a cell, with the slopes and curvatures of its neighbours;
//! - near the edge it is the root of a polynomial ([`super::edge`]), of which the edge is moved, by
//!   thousandths of a cell, until the cells around bear the force that the solver's do;
//! - where neither is known it stays uniform.
//!
//! Within a cell, p less its mean has a first moment m, which is felt far off. The convolution takes
//! it, as ±m/2 on the two neighbours. What remains has neither force nor moment, and is felt within a
//! few cells only ([`super::near`]). Inside the contact the solver's pressure holds those shares
//! already: deep planes change by the edge alone.

use rayon::prelude::*;

use super::cut::{Piece, pieces};
use super::edge::{BAND, EdgeCell, distances, edge_cells};
use super::fit::Square;
use crate::parallel::Threads;

/// The pressure of a solved contact, in cells and within them.
#[derive(Debug)]
pub(super) struct Reconstruction {
    /// What is to be taken as uniform over cells, at all depths.
    pub(super) uniform: Vec<f64>,
    /// Slopes within cells, per cell, and curvatures, per cell squared, along x and along y; 0
    /// outside of the inside.
    pub(super) bends: [Vec<f64>; 4],
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

/// Pieces along each side of a cell for its mean. Where the edge is in reach each is cut by four
/// again, so that a root is missed in 1/24 of a cell.
const FINE: usize = 6;

/// Steps that move the edge until it bears the force of the solver's cells. As Newton's they leave
/// the square of what the one before left: the first moves by thousandths of a cell.
const STEPS: usize = 2;

/// Cells to each side that bear it together: some runs of the staircase. Chosen by trial.
const BEARERS: usize = 12;

/// By how many cells the edge may be moved: twice as far as a fit may be uncertain of it
/// ([`super::edge`]).
const FARTHEST: f64 = 0.1;

impl Reconstruction {
    /// None where `go_on`, which is asked many times, stops it.
    pub(super) fn new(
        pressure: &[f64],
        shape @ [nx, ny]: [usize; 2],
        threads: &Threads,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Option<Self> {
        let line = nx == 1;
        let distances = distances(pressure, shape, BAND + 1);
        if !go_on() {
            return None;
        }
        let fine = pieces(Piece::WHOLE, FINE, line);
        let inside = |cell: usize| distances[cell] > BAND;
        let mut bends: [Vec<f64>; 4] = std::array::from_fn(|_| vec![0.0; pressure.len()]);
        for cell in (0..pressure.len()).filter(|cell| inside(*cell)) {
            let steps = if line { [0, 1] } else { [ny, 1] };
            for axis in 0..2 {
                let [left, here, right] = [cell - steps[axis], cell, cell + steps[axis]];
                let [left, here, right] = [left, here, right].map(|cell| pressure[cell]);
                bends[axis][cell] = 0.5 * (right - left);
                bends[axis + 2][cell] = right - 2.0 * here + left;
            }
        }
        if !go_on() {
            return None;
        }
        let edges = edge_cells(pressure, &distances, shape, threads, go_on)?;
        let root = |edge| RootCell::new(edge, &fine, line);
        let mut roots: Vec<RootCell> = threads.run(|| edges.into_par_iter().map(root).collect());
        let mut uniform = uniform_part(pressure, &bends, &roots, shape);
        for _ in 0..STEPS {
            if !go_on() {
                return None;
            }
            let moves = moves(pressure, &uniform, &roots, shape);
            if !go_on() {
                return None;
            }
            let moved = roots.into_par_iter().zip(moves);
            let root = |(root, by): (RootCell, f64)| root.moved(by, &fine, line);
            roots = threads.run(|| moved.filter_map(root).collect());
            uniform = uniform_part(pressure, &bends, &roots, shape);
        }
        // Those beyond the edge hold nothing.
        roots.retain(|root| root.mean > 0.0);
        Some(Self {
            uniform,
            bends,
            roots,
        })
    }
}

/// What is to be taken as uniform over cells: means and shares.
fn uniform_part(
    pressure: &[f64],
    bends: &[Vec<f64>; 4],
    roots: &[RootCell],
    [nx, ny]: [usize; 2],
) -> Vec<f64> {
    let mut means = pressure.to_vec();
    let moment = |cell: usize| [0, 1].map(|axis| INERTIA * bends[axis][cell]);
    let mut moments: Vec<[f64; 2]> = (0..pressure.len()).map(moment).collect();
    let mut is_root = vec![false; pressure.len()];
    for root in roots {
        let cell = root.cell[0] * ny + root.cell[1];
        means[cell] = root.mean;
        moments[cell] = root.moments;
        is_root[cell] = true;
    }
    // The solver's pressure holds shares already; those at the edge have gone with it.
    let takes = |cell: usize, neighbour: usize| {
        is_root[cell] || is_root[neighbour] && pressure[cell] == 0.0
    };
    let mut uniform = means.clone();
    for (cell, uniform) in uniform.iter_mut().enumerate() {
        let mut share = |within: bool, neighbour: usize, axis: usize, half: f64| {
            if within && takes(cell, neighbour) {
                *uniform += half * moments[neighbour][axis];
            }
        };
        let (i, j) = (cell / ny, cell % ny);
        share(j > 0, cell.wrapping_sub(1), 1, 0.5);
        share(j + 1 < ny, cell + 1, 1, -0.5);
        if nx > 1 {
            share(i > 0, cell.wrapping_sub(ny), 0, 0.5);
            share(i + 1 < nx, cell + ny, 0, -0.5);
        }
    }
    uniform
}

/// By how much p² is to be raised, for the cells around each to bear the force that they are given.
fn moves(pressure: &[f64], uniform: &[f64], roots: &[RootCell], shape: [usize; 2]) -> Vec<f64> {
    let ny = shape[1];
    let missing: Vec<f64> = pressure.iter().zip(uniform).map(|(p, u)| p - u).collect();
    let mut rates = vec![0.0; pressure.len()];
    for root in roots {
        rates[root.cell[0] * ny + root.cell[1]] = root.rate;
    }
    let (missing, rates) = (Sums::new(&missing, shape), Sums::new(&rates, shape));
    let move_of = |root: &RootCell| {
        let rate = rates.around(root.cell, BEARERS);
        if rate > 0.0 {
            missing.around(root.cell, BEARERS) / rate
        } else {
            0.0
        }
    };
    roots.iter().map(move_of).collect()
}

/// Sums over rectangles of cells, from those over all that begin at the first.
struct Sums {
    shape: [usize; 2],
    sums: Vec<f64>,
}

impl Sums {
    fn new(values: &[f64], shape @ [nx, ny]: [usize; 2]) -> Self {
        let width = ny + 1;
        let mut sums = vec![0.0; (nx + 1) * width];
        for i in 0..nx {
            let mut row = 0.0;
            for j in 0..ny {
                row += values[i * ny + j];
                sums[(i + 1) * width + j + 1] = sums[i * width + j + 1] + row;
            }
        }
        Self { shape, sums }
    }

    fn around(&self, [i, j]: [usize; 2], reach: usize) -> f64 {
        let [nx, ny] = self.shape;
        let at = |i: usize, j: usize| self.sums[i * (ny + 1) + j];
        let (top, left) = (i.saturating_sub(reach), j.saturating_sub(reach));
        let (bottom, right) = ((i + reach + 1).min(nx), (j + reach + 1).min(ny));
        at(bottom, right) - at(top, right) - at(bottom, left) + at(top, left)
    }
}

impl RootCell {
    fn new(edge: EdgeCell, fine: &[Piece], line: bool) -> Self {
        let EdgeCell { cell, square } = edge;
        let (mean, moments) = moments(&square, fine, line);
        // A hundredth of a cell.
        let step = 0.01 * square.varies([1.0, 1.0]);
        let (higher, _) = self::moments(&square.raised(step), fine, line);
        Self {
            cell,
            square,
            mean,
            moments,
            rate: (higher - mean) / step,
        }
    }

    /// With p² raised; none where that moves the edge too far.
    fn moved(self, by: f64, fine: &[Piece], line: bool) -> Option<Self> {
        if by.abs() > FARTHEST * self.square.slope() {
            return None;
        }
        let square = self.square.raised(by);
        let (mean, moments) = moments(&square, fine, line);
        Some(Self {
            square,
            mean,
            moments,
            ..self
        })
    }
}

/// Mean and first moments over the cell.
fn moments(square: &Square, fine: &[Piece], line: bool) -> (f64, [f64; 2]) {
    let (mut mean, mut moments) = (0.0, [0.0; 2]);
    for piece in fine {
        let p = piece.area() * root(square, piece, 1, line);
        mean += p;
        moments[0] += p * piece.centre[0];
        moments[1] += p * piece.centre[1];
    }
    (mean, moments)
}

/// Mean of √max(p², 0) over a piece, of `count` points along each side.
pub(super) fn root(square: &Square, piece: &Piece, count: usize, line: bool) -> f64 {
    let half = piece.half.map(|half| half / count as f64);
    let varies = 2.0 * square.varies(half);
    let rows = if line { 1 } else { count };
    let mut sum = 0.0;
    for a in 0..rows {
        for b in 0..count {
            let u = piece.centre[0] + half[0] * (2 * a + 1) as f64 - half[0] * count as f64;
            let u = if line { 0.0 } else { u };
            let v = piece.centre[1] + half[1] * (2 * b + 1) as f64 - half[1] * count as f64;
            let value = square.at(u, v);
            if value > varies {
                sum += value.sqrt();
            } else if value > -varies {
                sum += finer_root(square, [u, v], half, line);
            }
        }
    }
    sum / (rows * count) as f64
}

/// The same where the edge is in reach: of four points along each side.
#[cold]
fn finer_root(square: &Square, [u, v]: [f64; 2], [hu, hv]: [f64; 2], line: bool) -> f64 {
    const PLACES: [f64; 4] = [-0.75, -0.25, 0.25, 0.75];
    let along = if line { &[0.0] } else { &PLACES[..] };
    let mut sum = 0.0;
    for a in along {
        for b in &PLACES {
            sum += square.at(u + a * hu, v + b * hv).max(0.0).sqrt();
        }
    }
    sum / (along.len() * PLACES.len()) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::{Error, Result};

    fn reconstructed(pressure: &[f64], shape: [usize; 2]) -> Result<Reconstruction> {
        Reconstruction::new(pressure, shape, &Threads::new(Some(2))?, &mut || true)
            .ok_or(Error::Inconsistent("it was stopped"))
    }

    /// Where the grid's border cuts a contact, its cells stay as they are, though pressure is smooth
    /// there, or rises smoothly to the cut; the edges farther off are known.
    #[test]
    fn a_cut_is_no_edge() -> Result<()> {
        let shape @ [nx, ny] = [40, 44];
        let rises: [fn(f64) -> f64; 2] = [|_| 1.0, |x| 1.0 / (x + 3.0).sqrt()];
        for rise in rises {
            let pressure: Vec<f64> = (0..nx * ny)
                .map(|cell| {
                    let (x, y) = ((cell / ny) as f64, (cell % ny) as f64 - 21.3);
                    (rise(x) * (1.0 - y * y / 290.0)).max(0.0).sqrt()
                })
                .collect();
            let found = reconstructed(&pressure, shape)?;
            let reach = usize::from(BAND);
            for i in (0..reach).chain(nx - reach..nx) {
                for cell in i * ny..(i + 1) * ny {
                    assert_eq!(found.uniform[cell].to_bits(), pressure[cell].to_bits());
                    assert!(found.bends.iter().all(|bend| bend[cell] == 0.0));
                }
            }
            let is_cut = |root: &RootCell| root.cell[0] < reach || root.cell[0] >= nx - reach;
            assert!(!found.roots.iter().any(is_cut));
            assert!(found.roots.len() > 100, "{}", found.roots.len());
        }
        Ok(())
    }

    /// The edge bears what it is given: two steps leave the square of the first move, a tenth of a
    /// cell at most, of what the edge's cells bear, a twentieth of all.
    #[test]
    fn the_force_is_kept() -> Result<()> {
        let (n, radius) = (61, 24.3);
        let pressure: Vec<f64> = (0..n * n)
            .map(|cell| {
                let (x, y) = ((cell / n) as f64 - 30.0, (cell % n) as f64 - 29.6);
                (1.0 - (x * x + y * y) / (radius * radius)).max(0.0).sqrt()
            })
            .collect();
        let reconstruction = reconstructed(&pressure, [n, n])?;
        assert!(reconstruction.roots.len() > 500);
        let force = |pressure: &[f64]| pressure.iter().sum::<f64>();
        let change = force(&reconstruction.uniform) / force(&pressure) - 1.0;
        assert!(change.abs() < 5e-4, "{change:.1e}");
        // What is not near the edge is the solver's.
        for (cell, bend) in reconstruction.bends[2].iter().enumerate() {
            if *bend != 0.0 {
                assert_eq!(
                    reconstruction.uniform[cell].to_bits(),
                    pressure[cell].to_bits()
                );
            }
        }
        Ok(())
    }
}
