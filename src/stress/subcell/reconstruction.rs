//! The pressure of a solved contact, in cells and within them, and cells cut into rectangles.
//!
//! - In the interior p is parabolic in a cell, with the slopes and curvatures of the neighbours'
//!   pressures.
//! - Near the edge it is the root of a polynomial ([`super::edge`]), shifted by thousandths of a cell
//!   until the cells around carry the force that the solver's cells do.
//! - Elsewhere it stays uniform.
//!
//! The uniform part of a cell is its mean plus the shares ±m/2 that it takes of its neighbours' first
//! moments m. In the interior the solver's pressure is that sum already: deep planes change by the edge
//! alone.
//!
//! The stresses of the rectangles are summed ([`super::near`]): the nearer the target, the finer the cut.

use std::collections::BTreeSet;
use std::ops::ControlFlow;

use rayon::prelude::*;

use super::edge::{BAND, EdgeCell, Fitting, RectangleSums, around, edge_cells, edge_distances};
use super::law::{EdgeLaw, EdgeProfile};
use super::squared_pressure::SquaredPressure;
use crate::numerics::parallel::Threads;
use crate::stress::options::StressProgress;

/// The pressure of a solved contact, reconstructed.
#[derive(Debug)]
pub(super) struct Reconstruction {
    /// Pressure that is taken as uniform over cells, at all depths.
    pub(super) uniform: Vec<f64>,
    pub(super) interior: Interior,
    /// Cells near the edge, in which p is the root of a polynomial times the law's factor.
    pub(super) roots: Vec<RootCell>,
    pub(super) law: EdgeLaw,
}

/// Parabolas within the cells of the interior; zero in all cells up to [`BAND`] from the edge.
#[derive(Debug)]
pub(super) struct Interior {
    /// Slopes along x and along y, per cell.
    pub(super) slopes: [Vec<f64>; 2],
    /// Curvatures along x and along y, per cell squared.
    pub(super) curvatures: [Vec<f64>; 2],
}

/// A cell near the edge.
#[derive(Debug, Clone, Copy)]
pub(super) struct RootCell {
    pub(super) cell: [usize; 2],
    /// p² without the law's factor; the pressure is its root times that where it is positive, and 0 elsewhere.
    pub(super) squared: SquaredPressure,
    /// Mean of p.
    pub(super) mean: f64,
    /// First moments of p along x and along y.
    pub(super) moments: [f64; 2],
    /// Change of the mean per change of p².
    rate: f64,
}

/// Second moment of a cell, in cells.
pub(super) const INERTIA: f64 = 1.0 / 12.0;

/// Pieces along each side of a cell for the mean of a root. Where the edge is in reach each piece is
/// sampled at four points along each side, so that a root is missed within 1/24 of a cell.
const MEAN_DIVISIONS: usize = 6;

/// Steps of Newton's method that balance the force. Each leaves the square of the shift before, and the
/// first shifts by thousandths of a cell.
const BALANCE_STEPS: usize = 2;

/// The same on layers, where the first shifts are up to [`SHIFT_LIMIT_ON_LAYERS`].
const BALANCE_STEPS_ON_LAYERS: usize = 3;

/// Cells to each side whose forces are balanced together: some runs of the staircase.
const BALANCE_REACH: usize = 12;

/// Largest shift of the edge in one step, in cells; a cell whose edge would have to shift more keeps its
/// uniform pressure. Twice the largest uncertainty of a fit ([`super::edge`]).
pub(super) const SHIFT_LIMIT: f64 = 0.1;

/// The same on layers, whose law changes between the cells of a fit and the edge: there the force tells where the edge is. Chosen on
/// coats of one to four cells, three times as stiff as what is below (`tests/stress/coats.rs`).
const SHIFT_LIMIT_ON_LAYERS: f64 = 0.3;

/// Step of p² for [`RootCell::rate`], over the change of p² across a cell: the edge shifts by about a
/// hundredth of a cell.
const RATE_STEP: f64 = 0.01;

/// Steps of Newton's method from a cell's centre to the edge. Across a cell p² is nearly linear: its slope changes by a cell
/// over the radius of the contact, some 1/8 where an edge is fitted at all, and each step squares that.
const EDGE_STEPS: usize = 5;

impl Reconstruction {
    /// The reconstruction of `pressure`, near the edge by its law, if that is known. `progress` is asked many times, with 0.
    pub(super) fn new(
        pressure: &[f64],
        shape: [usize; 2],
        law: Option<(EdgeLaw, Fitting)>,
        threads: &Threads,
        progress: &mut StressProgress,
    ) -> ControlFlow<(), Self> {
        let line = shape[0] == 1;
        let distances = edge_distances(pressure, shape, BAND + 1);
        progress(0.0)?;
        let interior = Interior::new(pressure, &distances, shape);
        progress(0.0)?;
        let edges = match &law {
            Some((law, fitting)) => {
                edge_cells(pressure, &distances, shape, (law, *fitting), threads, progress)?
            }
            None => Vec::new(),
        };
        let law = law.map(|(law, _)| law).unwrap_or_default();
        let divisions = pieces(Piece::CELL, MEAN_DIVISIONS, line);
        let root = |edge| RootCell::new(edge, &law, &divisions, line);
        let mut roots: Vec<RootCell> = threads.run(|| edges.into_par_iter().map(root).collect());
        let mut uniform = uniform_part(pressure, &interior, &roots, shape);
        let steps = if law.is_of_layers() { BALANCE_STEPS_ON_LAYERS } else { BALANCE_STEPS };
        for _ in 0..steps {
            progress(0.0)?;
            let raises = balancing_raises(pressure, &uniform, &roots, shape);
            progress(0.0)?;
            let raised = roots.into_par_iter().zip(raises);
            let root = |(root, by): (RootCell, f64)| root.raised(by, &law, &divisions, line);
            roots = threads.run(|| raised.filter_map(root).collect());
            uniform = uniform_part(pressure, &interior, &roots, shape);
        }
        // Cells beyond the edge hold nothing; one that the edge just enters may hold no sampled point. It is kept where no
        // cell beside it has the edge.
        let with_edge = |root: &&RootCell| root.mean > 0.0 && root.edge(0.5).is_some();
        let edges: BTreeSet<_> = roots.iter().filter(with_edge).map(|root| root.cell).collect();
        let is_alone = |cell| !around(shape, cell, 1).any(|beside| edges.contains(&beside));
        roots.retain(|root| root.mean > 0.0 || root.edge(0.5).is_some() && is_alone(root.cell));
        ControlFlow::Continue(Self { uniform, interior, roots, law })
    }
}

impl Interior {
    fn new(pressure: &[f64], distances: &[u8], [nx, ny]: [usize; 2]) -> Self {
        let zeros = || [0, 1].map(|_| vec![0.0; pressure.len()]);
        let (mut slopes, mut curvatures) = (zeros(), zeros());
        // The neighbours along x of a cell of line contact are the cell itself.
        let steps = if nx == 1 { [0, 1] } else { [ny, 1] };
        for cell in (0..pressure.len()).filter(|cell| distances[*cell] > BAND) {
            for axis in 0..2 {
                let [left, here, right] = [cell - steps[axis], cell, cell + steps[axis]];
                let [left, here, right] = [left, here, right].map(|cell| pressure[cell]);
                slopes[axis][cell] = 0.5 * (right - left);
                curvatures[axis][cell] = right - 2.0 * here + left;
            }
        }
        Self { slopes, curvatures }
    }
}

/// Pressure that is taken as uniform over cells: means, and shares of the neighbours' first moments.
fn uniform_part(
    pressure: &[f64],
    interior: &Interior,
    roots: &[RootCell],
    [nx, ny]: [usize; 2],
) -> Vec<f64> {
    let mut means = pressure.to_vec();
    let moment = |cell: usize| [0, 1].map(|axis| INERTIA * interior.slopes[axis][cell]);
    let mut moments: Vec<[f64; 2]> = (0..pressure.len()).map(moment).collect();
    let mut is_root = vec![false; pressure.len()];
    for root in roots {
        let cell = root.cell[0] * ny + root.cell[1];
        means[cell] = root.mean;
        moments[cell] = root.moments;
        is_root[cell] = true;
    }
    // The solver's pressure holds shares already, but cells at the edge no longer have it.
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

/// For each root, by how much p² must rise so that the cells around it carry the solver's force.
fn balancing_raises(
    pressure: &[f64],
    uniform: &[f64],
    roots: &[RootCell],
    shape: [usize; 2],
) -> Vec<f64> {
    let ny = shape[1];
    let missing: Vec<f64> = pressure.iter().zip(uniform).map(|(p, u)| p - u).collect();
    let mut rates = vec![0.0; pressure.len()];
    for root in roots {
        rates[root.cell[0] * ny + root.cell[1]] = root.rate;
    }
    let missing = RectangleSums::new(&missing, shape);
    let rates = RectangleSums::new(&rates, shape);
    let raise = |root: &RootCell| {
        let rate = rates.around(root.cell, BALANCE_REACH);
        if rate > 0.0 { missing.around(root.cell, BALANCE_REACH) / rate } else { 0.0 }
    };
    roots.iter().map(raise).collect()
}

impl RootCell {
    fn new(edge: EdgeCell, law: &EdgeLaw, divisions: &[Piece], line: bool) -> Self {
        let EdgeCell { cell, squared } = edge;
        let (mean, moments) = mean_and_moments(&law.profile(&squared), divisions, line);
        let step = RATE_STEP * squared.variation([1.0, 1.0]);
        let higher = squared.raised(step);
        let (higher, _) = mean_and_moments(&law.profile(&higher), divisions, line);
        Self { cell, squared, mean, moments, rate: (higher - mean) / step }
    }

    /// The point of the edge that is nearest to the cell's centre, if it is within `reach` of it along both axes: distances
    /// from the centre, in cells.
    pub(super) fn edge(&self, reach: f64) -> Option<[f64; 2]> {
        let mut at = [0.0; 2];
        for _ in 0..EDGE_STEPS {
            let [slope_u, slope_v] = self.squared.gradient(at);
            let square = slope_u * slope_u + slope_v * slope_v;
            let step = self.squared.at(at[0], at[1]) / square;
            at = [at[0] - step * slope_u, at[1] - step * slope_v];
        }
        at.iter().all(|u| u.abs() <= reach).then_some(at)
    }

    /// The cell with p² raised; none where that shifts the edge too far.
    fn raised(self, by: f64, law: &EdgeLaw, divisions: &[Piece], line: bool) -> Option<Self> {
        let limit = if law.is_of_layers() { SHIFT_LIMIT_ON_LAYERS } else { SHIFT_LIMIT };
        if by.abs() > limit * self.squared.slope() {
            return None;
        }
        let squared = self.squared.raised(by);
        let (mean, moments) = mean_and_moments(&law.profile(&squared), divisions, line);
        Some(Self { squared, mean, moments, ..self })
    }
}

/// Mean and first moments of the pressure over the cell.
fn mean_and_moments(profile: &EdgeProfile, divisions: &[Piece], line: bool) -> (f64, [f64; 2]) {
    let (mut mean, mut moments) = (0.0, [0.0; 2]);
    for piece in divisions {
        let p = piece.area() * mean_root(profile, piece, 1, line);
        mean += p;
        moments[0] += p * piece.centre[0];
        moments[1] += p * piece.centre[1];
    }
    (mean, moments)
}

/// Mean of the pressure near an edge over a piece, from `count` points along each side.
pub(super) fn mean_root(profile: &EdgeProfile, piece: &Piece, count: usize, line: bool) -> f64 {
    let half = piece.half.map(|half| half / count as f64);
    // Twice the variation, so that curvature does not hide the edge.
    let variation = 2.0 * profile.squared.variation(half);
    let rows = if line { 1 } else { count };
    let mut sum = 0.0;
    for a in 0..rows {
        for b in 0..count {
            let u = piece.centre[0] + half[0] * (2 * a + 1) as f64 - half[0] * count as f64;
            let u = if line { 0.0 } else { u };
            let v = piece.centre[1] + half[1] * (2 * b + 1) as f64 - half[1] * count as f64;
            let value = profile.squared.at(u, v);
            if value > variation {
                sum += profile.root(value);
            } else if value > -variation {
                sum += mean_root_at_edge(profile, [u, v], half, line);
            }
        }
    }
    sum / (rows * count) as f64
}

/// Mean of the pressure over the rectangle of half sides (hu, hv) around (u, v), which the edge may cross,
/// from four points along each side.
#[cold]
fn mean_root_at_edge(
    profile: &EdgeProfile,
    [u, v]: [f64; 2],
    [hu, hv]: [f64; 2],
    line: bool,
) -> f64 {
    const PLACES: [f64; 4] = [-0.75, -0.25, 0.25, 0.75];
    let along = if line { &[0.0] } else { &PLACES[..] };
    let mut sum = 0.0;
    for a in along {
        for b in &PLACES {
            sum += profile.at([u + a * hu, v + b * hv]);
        }
    }
    sum / (along.len() * PLACES.len()) as f64
}

/// A rectangle in a cell, in cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Piece {
    /// Distance from the cell's centre.
    pub(super) centre: [f64; 2],
    pub(super) half: [f64; 2],
}

impl Piece {
    pub(super) const CELL: Self = Self { centre: [0.0; 2], half: [0.5; 2] };

    /// Area over the cell's.
    pub(super) fn area(&self) -> f64 {
        4.0 * self.half[0] * self.half[1]
    }

    /// Mean over the piece of the squared distance from the cell's centre along one axis.
    pub(super) fn mean_square(&self, axis: usize) -> f64 {
        self.centre[axis].powi(2) + self.half[axis].powi(2) / 3.0
    }
}

#[derive(Debug)]
pub(super) struct Cut {
    pub(super) pieces: Vec<Piece>,
    /// Along x and y, 1/12 over the second moment of the pieces' centres: 1 for infinitely many pieces,
    /// 0 along an axis that is not cut.
    pub(super) norms: [f64; 2],
    /// Points along a side of a piece at which a pressure is sampled for the piece's mean.
    pub(super) points: usize,
}

impl Cut {
    /// A cell cut ever finer towards a point (u, v) from its centre, which is the middle of the `smallest` piece: squares in rings
    /// around it, each as large as half its distance; a strip in steps that grow by the factor [`GROWTH`].
    pub(super) fn towards(point: [f64; 2], smallest: f64, line: bool) -> Self {
        match line {
            true => Self::new(steps_towards(point[1], smallest), 1),
            false => Self::new(rings_towards(point, smallest), 1),
        }
    }

    fn new(pieces: Vec<Piece>, points: usize) -> Self {
        let norms = [0, 1].map(|axis| {
            let second = |piece: &Piece| piece.area() * piece.centre[axis].powi(2);
            let sum: f64 = pieces.iter().map(second).sum();
            if sum > 0.0 { 1.0 / (12.0 * sum) } else { 0.0 }
        });
        Self { pieces, norms, points }
    }
}

/// Side of the smallest piece at a point, in cells. What pressure c √d adds within it to the stress of a traction is missed:
/// (2/π) c √(2 s) of μ. With a side d of cells, that is 0.005 √(d/a) μ p0 for Hertz' pressure on a half-width a.
pub(super) const SMALLEST_AT_POINT: f64 = 1.0 / 65536.0;

/// Growth of steps of a strip away from a point. Uniform pressure on a step from d to 1.5 d makes the stress of c √d there by 0.7 %
/// too large, which the smallest step, of 1/4096, makes up for.
const GROWTH: f64 = 1.5;
const SMALLEST_STEP: f64 = 1.0 / 4096.0;

/// Steps of a strip, across it, that grow away from the distance `at` from its centre.
fn steps_towards(at: f64, smallest: f64) -> Vec<Piece> {
    let mut ends = vec![-0.5, 0.5];
    let mut distance = 0.5 * smallest.max(SMALLEST_STEP);
    while distance < 0.5 + at.abs() {
        ends.extend([at - distance, at + distance].into_iter().filter(|end| end.abs() < 0.5));
        distance *= GROWTH;
    }
    ends.sort_by(f64::total_cmp);
    let step = |pair: &[f64]| Piece {
        centre: [0.0, 0.5 * (pair[0] + pair[1])],
        half: [0.5, 0.5 * (pair[1] - pair[0])],
    };
    ends.windows(2).map(step).filter(|step| step.half[1] > 0.0).collect()
}

/// Squares of a cell in rings around a point, each as large as half its distance, as far as they are in the cell.
fn rings_towards(point: [f64; 2], smallest: f64) -> Vec<Piece> {
    let mut pieces = Vec::new();
    let mut add = |along: [f64; 2], across: [f64; 2]| {
        let within =
            |axis: usize, ends: [f64; 2]| ends.map(|end| (point[axis] + end).clamp(-0.5, 0.5));
        let ends = [within(0, along), within(1, across)];
        if ends.iter().all(|[from, to]| from < to) {
            let centre = ends.map(|[from, to]| 0.5 * (from + to));
            pieces.push(Piece { centre, half: ends.map(|[from, to]| 0.5 * (to - from)) });
        }
    };
    let mut hole = 0.5 * smallest;
    add([-hole, hole], [-hole, hole]);
    while hole < 0.5 + point[0].abs().max(point[1].abs()) {
        let step = |k: i32| [0.5 * hole * f64::from(k), 0.5 * hole * f64::from(k + 1)];
        let is_inner = |k: i32| (-2..2).contains(&k);
        for k in -4..4 {
            for l in (-4..4).filter(|l| !(is_inner(k) && is_inner(*l))) {
                add(step(k), step(l));
            }
        }
        hole *= 2.0;
    }
    pieces
}

pub(super) const CUTS: usize = 3;

/// Cuts of a cell, seen from its own centre, from the cells next to it, and from those farther off.
#[derive(Debug)]
pub(super) struct Cuts([Cut; CUTS]);

impl Cuts {
    /// Side of the smallest pieces, in cells.
    pub(super) const SMALLEST: f64 = 1.0 / 135.0;

    /// Cuts of cells, or of strips along x if `line`. A cell's own cut is 5 × 5, and its inner 3 × 3
    /// are cut by three in each direction, three times over towards the centre. The cut seen from the
    /// cells next to it is 5 × 5, the one seen from farther off 3 × 3.
    pub(super) fn new(line: bool) -> Self {
        let mut own = Vec::new();
        grade(pieces(Piece::CELL, 5, line), 0.2, 3, line, &mut own);
        Self([
            Cut::new(own, 1),
            Cut::new(pieces(Piece::CELL, 5, line), 2),
            Cut::new(pieces(Piece::CELL, 3, line), 2),
        ])
    }

    pub(super) fn get(&self, number: usize) -> &Cut {
        &self.0[number]
    }

    /// Number of the cut for a target `offset` cells away, at a depth in cells.
    pub(super) fn cut_number(&self, offset: [isize; 2], depth: f64) -> usize {
        let near = match offset.map(isize::unsigned_abs) {
            [0, 0] => 0,
            [0 | 1, 0 | 1] => 1,
            _ => 2,
        };
        near.max(Self::finest_at(depth))
    }

    /// Number of the finest cut that is used at a depth in cells: what pieces of side s leave out falls
    /// off as e^{−2πz/s}.
    pub(super) fn finest_at(depth: f64) -> usize {
        if depth < 0.4 {
            0
        } else if depth < 0.8 {
            1
        } else {
            2
        }
    }
}

/// `count` × `count` equal pieces of one; of a strip, `count` across.
pub(super) fn pieces(whole: Piece, count: usize, line: bool) -> Vec<Piece> {
    let place = |k: usize| (2 * k + 1) as f64 / count as f64 - 1.0;
    let rows = if line { 1 } else { count };
    let mut pieces = Vec::with_capacity(rows * count);
    for a in 0..rows {
        for b in 0..count {
            let Piece { centre: [u, v], half: [hu, hv] } = whole;
            let across = place(b) * hv;
            let (along, hu) = if line { (0.0, hu) } else { (place(a) * hu, hu / count as f64) };
            pieces.push(Piece { centre: [u + along, v + across], half: [hu, hv / count as f64] });
        }
    }
    pieces
}

/// Cuts the middle one of the `coarse` pieces, of side `side`, and those that touch it, `levels` times.
fn grade(coarse: Vec<Piece>, side: f64, levels: usize, line: bool, graded: &mut Vec<Piece>) {
    if levels == 0 {
        graded.extend(coarse);
        return;
    }
    let inner = |piece: &Piece| {
        let near = |u: f64| u.abs() < 1.5 * side;
        (line || near(piece.centre[0])) && near(piece.centre[1])
    };
    let (middle, outer): (Vec<Piece>, Vec<Piece>) = coarse.into_iter().partition(inner);
    graded.extend(outer);
    let finer = middle.into_iter().flat_map(|piece| pieces(piece, 3, line)).collect();
    grade(finer, side / 3.0, levels - 1, line, graded);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Result;

    fn reconstructed(pressure: &[f64], shape: [usize; 2]) -> Result<Reconstruction> {
        let threads = Threads::new(Some(2))?;
        let mut progress = |_| ControlFlow::Continue(());
        match Reconstruction::new(
            pressure,
            shape,
            Some((EdgeLaw::default(), Fitting::BEST)),
            &threads,
            &mut progress,
        ) {
            ControlFlow::Continue(reconstruction) => Ok(reconstruction),
            ControlFlow::Break(()) => panic!("nothing stops it"),
        }
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
            let reconstruction = reconstructed(&pressure, shape)?;
            let Interior { slopes, curvatures } = &reconstruction.interior;
            let reach = usize::from(BAND);
            for i in (0..reach).chain(nx - reach..nx) {
                for cell in i * ny..(i + 1) * ny {
                    assert_eq!(reconstruction.uniform[cell].to_bits(), pressure[cell].to_bits());
                    assert!(slopes.iter().chain(curvatures).all(|part| part[cell] == 0.0));
                }
            }
            let is_cut = |root: &RootCell| root.cell[0] < reach || root.cell[0] >= nx - reach;
            assert!(!reconstruction.roots.iter().any(is_cut));
            assert!(reconstruction.roots.len() > 100, "{}", reconstruction.roots.len());
        }
        Ok(())
    }

    /// The edge carries the solver's force: two steps leave the square of the first shift, a tenth of a
    /// cell at most, of what the edge's cells carry, a twentieth of all.
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
        // The interior keeps the solver's pressure.
        for (cell, curvature) in reconstruction.interior.curvatures[0].iter().enumerate() {
            if *curvature != 0.0 {
                assert_eq!(reconstruction.uniform[cell].to_bits(), pressure[cell].to_bits());
            }
        }
        Ok(())
    }

    #[test]
    fn pieces_make_up_the_cell() {
        for line in [false, true] {
            let cuts = Cuts::new(line);
            for cut in &cuts.0 {
                let area: f64 = cut.pieces.iter().map(Piece::area).sum();
                assert!((area - 1.0).abs() < 1e-14);
                for axis in 0..2 {
                    let second = |piece: &Piece| piece.area() * piece.mean_square(axis);
                    let inertia: f64 = cut.pieces.iter().map(second).sum();
                    assert!((inertia - 1.0 / 12.0).abs() < 1e-14);
                }
            }
            // 5 × 5 less 9, four times 81 less 9, and the last 81; in one dimension 5, 9, 9, 9.
            let count = if line { 2 + 6 + 6 + 9 } else { 16 + 72 + 72 + 81 };
            assert_eq!(cuts.0[0].pieces.len(), count);
            let sides = cuts.0[0].pieces.iter().map(|piece| 2.0 * piece.half[1]);
            let smallest = sides.fold(1.0, f64::min);
            assert!((smallest / Cuts::SMALLEST - 1.0).abs() < 1e-14);
        }
    }
}
