//! Cells near a smooth edge of the contact, with a polynomial for p² that is continued from the
//! interior.
//!
//! A polynomial of second or of third degree is fitted to p² of cells that are [`BAND`] cells from the
//! edge and farther ([`FitWindow`]), and continued to the edge. The outermost two cells carry the
//! staircase of the solver's contact; those farther inside determine the edge within some thousandths
//! of a cell. A cell keeps its uniform pressure
//!
//! - where too few cells are inside: contacts of few cells, ridges, tips;
//! - where the residuals of the fit leave the edge uncertain by more than [`UNCERTAINTY_LIMIT`] cells:
//!   rough surfaces;
//! - where the fitted edge is farther than [`OFFSET_LIMIT`] cells from that of the solver's cells: sharp
//!   edges, at which p grows;
//! - where the grid's border cuts the contact, which is no edge of it;
//! - within [`NEIGHBOURS`] cells of such a place: a fit that looks certain among others that are not does
//!   so by chance.

use std::ops::ControlFlow;

use rayon::prelude::*;

use super::law::EdgeLaw;
use super::squared_pressure::{SquaredPressure, TERMS};
use crate::numerics::dense::{backward, cholesky, forward};
use crate::numerics::parallel::Threads;
use crate::stress::options::StressProgress;

/// Distance from the edge, in cells, from which on inwards pressure is fitted. Cells up to here take
/// the fitted pressure. Two cells carry the staircase.
pub(super) const BAND: u8 = 3;

/// Which polynomials are fitted, and to which cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Fitting {
    /// Cells to each side of a cell that its fit uses: over more of them p² of a small
    /// contact is no polynomial, over fewer the solver's staircase is felt more.
    window: usize,
    /// Degrees of the polynomials that are tried: at the second, Hertz' contact is exact.
    degrees: &'static [u8],
}

impl Fitting {
    pub(super) const BEST: Self = Self { window: 8, degrees: &[2, 3] };
    /// Simpler ones, whose differences from the best tell what the fit leaves uncertain.
    pub(super) const SIMPLER: Self = Self { degrees: &[2], ..Self::BEST };
}

/// Distance, in cells, around a cell without a fit in which no other cell takes its own.
const NEIGHBOURS: usize = 3;

/// Cells that are fitted between two calls of the callback: some hundredths of a second of work.
const FITS_BETWEEN_CALLS: usize = 4096;

/// Largest uncertainty of the place of the edge, in cells, at which a fit is taken: the pressure there
/// errs by the root of it times the slope of p². Rough contacts are a tenth of a cell
/// uncertain or more, smooth ones some thousandths.
const UNCERTAINTY_LIMIT: f64 = 0.05;

/// Largest distance, in cells, of the fitted edge from the centres of the outermost cells of the
/// contact: half a cell where the solver's contact ends with the pressure, and a tenth for the fit.
const OFFSET_LIMIT: f64 = 0.6;

/// Change of the place of the edge from one pass of a fit to the next, in cells, at which it is taken.
const PASS_TOLERANCE: f64 = 1e-3;

/// A cell near the edge, and the polynomial for p² in it.
#[derive(Debug, Clone, Copy)]
pub(super) struct EdgeCell {
    pub(super) cell: [usize; 2],
    pub(super) squared: SquaredPressure,
}

/// Cells near the edge in which a fitted polynomial is taken, in the order of the grid. `progress` is
/// asked before every block of them.
pub(super) fn edge_cells(
    pressure: &[f64],
    distances: &[u8],
    shape: [usize; 2],
    (law, fitting): (&EdgeLaw, Fitting),
    threads: &Threads,
    progress: &mut StressProgress,
) -> ControlFlow<(), Vec<EdgeCell>> {
    let known = pressures_at_centres(pressure, distances, shape);
    progress(0.0)?;
    let band = edge_band(distances, shape);
    progress(0.0)?;
    let mut open = OpenCells::new(&band, shape);
    for cell in band.iter().filter(|cell| is_at_border(shape, **cell)) {
        open.close(*cell, usize::from(BAND) - 1 + NEIGHBOURS);
    }
    // Every third cell along x and y first: where those are refused, the others need no fit.
    let (first, others): (Vec<usize>, Vec<usize>) =
        (0..band.len()).partition(|k| band[*k].iter().all(|at| at % NEIGHBOURS == 0));
    let mut fitted: Vec<Option<SquaredPressure>> = vec![None; band.len()];
    for block in first.chunks(FITS_BETWEEN_CALLS).chain(others.chunks(FITS_BETWEEN_CALLS)) {
        progress(0.0)?;
        let is_needed = |k: &usize| open.any_around(band[*k], NEIGHBOURS);
        let needed: Vec<usize> = block.iter().copied().filter(is_needed).collect();
        let fit = |k: &usize| accepted_fit(&known, pressure, (shape, band[*k]), (law, fitting));
        let fits: Vec<_> = threads.run(|| needed.par_iter().map(fit).collect());
        for (k, squared) in needed.into_iter().zip(fits) {
            if squared.is_none() {
                open.close(band[k], NEIGHBOURS);
            }
            fitted[k] = squared;
        }
    }
    let cells = band.into_iter().zip(fitted).filter_map(|(cell, squared)| {
        let squared = squared.filter(|_| open.is_open(cell))?;
        Some(EdgeCell { cell, squared })
    });
    ControlFlow::Continue(cells.collect())
}

/// Cells up to [`BAND`] from the edge, and those beside them that have no pressure.
fn edge_band(distances: &[u8], shape @ [nx, ny]: [usize; 2]) -> Vec<[usize; 2]> {
    let loaded = |[i, j]: [usize; 2]| distances[i * ny + j] > 0;
    let is_in_band = |cell: &[usize; 2]| match distances[cell[0] * ny + cell[1]] {
        0 => around(shape, *cell, 1).any(loaded),
        distance => distance <= BAND,
    };
    let cells = (0..nx * ny).map(|cell| [cell / ny, cell % ny]);
    cells.filter(is_in_band).collect()
}

/// Cells near the edge that may still take a fitted pressure.
struct OpenCells {
    shape: [usize; 2],
    open: Vec<bool>,
}

impl OpenCells {
    fn new(band: &[[usize; 2]], shape @ [nx, ny]: [usize; 2]) -> Self {
        let mut open = vec![false; nx * ny];
        for [i, j] in band {
            open[i * ny + j] = true;
        }
        Self { shape, open }
    }

    fn is_open(&self, [i, j]: [usize; 2]) -> bool {
        self.open[i * self.shape[1] + j]
    }

    fn any_around(&self, cell: [usize; 2], reach: usize) -> bool {
        around(self.shape, cell, reach).any(|cell| self.is_open(cell))
    }

    fn close(&mut self, cell: [usize; 2], reach: usize) {
        for [i, j] in around(self.shape, cell, reach) {
            self.open[i * self.shape[1] + j] = false;
        }
    }
}

/// Pressure at the centres of cells that are [`BAND`] cells from the edge and farther. A solver's pressure
/// stands for the mean over its cell, which differs from the value at the centre by
/// (δ_x² + δ_y²) p / 24.
fn pressures_at_centres(
    pressure: &[f64],
    distances: &[u8],
    [nx, ny]: [usize; 2],
) -> Vec<Option<f64>> {
    let at_centre = |cell: usize| {
        let p = pressure[cell];
        let mut differences = pressure[cell - 1] + pressure[cell + 1] - 2.0 * p;
        if nx > 1 {
            differences += pressure[cell - ny] + pressure[cell + ny] - 2.0 * p;
        }
        p + differences / 24.0
    };
    let inside = |(cell, distance): (usize, &u8)| (*distance >= BAND).then(|| at_centre(cell));
    distances.iter().enumerate().map(inside).collect()
}

/// The most certain of the fits around one cell, if it is certain enough and its edge agrees with the
/// solver's cells.
fn accepted_fit(
    known: &[Option<f64>],
    pressure: &[f64],
    (shape, cell @ [i, j]): ([usize; 2], [usize; 2]),
    (law, fitting): (&EdgeLaw, Fitting),
) -> Option<SquaredPressure> {
    if !may_be_fitted(known, (shape, cell), fitting.window) {
        return None;
    }
    let window = FitWindow::around(shape, cell, fitting.window, |number| known[number].is_some());
    let degrees = fitting.degrees.iter();
    let equations: Vec<_> = degrees.filter_map(|degree| window.equations(*degree)).collect();
    let mut last: Option<Fit> = None;
    let mut edge = f64::NAN;
    for _ in 0..law.passes() {
        let profile = last.as_ref().map(|fit| law.profile(&fit.polynomial));
        let squared = |number: usize, at: [f64; 2]| {
            let factor = profile.as_ref().map_or(1.0, |profile| profile.factor_at(at));
            (known[number].unwrap_or_default() / factor).powi(2)
        };
        let fit = window.fit(&equations, squared)?;
        let before = std::mem::replace(&mut edge, fit.polynomial.offset());
        last = Some(fit);
        if (edge - before).abs() < PASS_TOLERANCE {
            break;
        }
    }
    let Fit { polynomial, uncertainty } = last?;
    // Distance of the cell's centre from the edge, positive inside.
    let distance = polynomial.offset();
    let agrees = if pressure[i * shape[1] + j] > 0.0 {
        distance > -OFFSET_LIMIT
    } else {
        distance < OFFSET_LIMIT
    };
    (uncertainty <= UNCERTAINTY_LIMIT && agrees).then_some(polynomial)
}

/// Square of the distance, in windows, at which the weight (1.1 − r²)² of a value falls to 0: cells at
/// the window's sides still count a little.
const WEIGHT_RADIUS_SQUARED: f64 = 1.1;

/// Smallest pivot of Cholesky's factorisation, over the diagonal entry that it comes from: below it
/// the values do not determine the polynomial. Far above rounding and far below the pivots of windows
/// that are half filled.
const PIVOT_LIMIT: f64 = 1e-9;

/// Powers of u and of v in each term.
const POWERS: [[u8; 2]; TERMS] =
    [[0, 0], [1, 0], [0, 1], [2, 0], [1, 1], [0, 2], [3, 0], [2, 1], [1, 2], [0, 3]];

/// A fitted polynomial, and how certain it is.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fit {
    pub(super) polynomial: SquaredPressure,
    /// Standard deviation of the place of the edge, in cells, from the residuals of the fit.
    pub(super) uncertainty: f64,
}

/// Fewest values that a polynomial of so many terms is fitted to.
fn fewest_values(terms: usize, line: bool) -> usize {
    if line { terms + 2 } else { 2 * terms }
}

/// Whether there may be values enough around a cell for a polynomial of second degree. They are
/// counted in a square, and the fit uses a circle within it: counting is far cheaper than summing.
fn may_be_fitted(
    values: &[Option<f64>],
    (shape, cell): ([usize; 2], [usize; 2]),
    window: usize,
) -> bool {
    let line = shape[0] == 1;
    let terms = if line { 3 } else { 6 };
    let known = |[i, j]: &[usize; 2]| values[i * shape[1] + j].is_some();
    around(shape, cell, window).filter(known).count() >= fewest_values(terms, line)
}

/// The cells around one cell to whose values polynomials are fitted, by normal equations.
pub(super) struct FitWindow {
    line: bool,
    /// Cells to each side.
    reach: usize,
    cells: Vec<FittedCell>,
    /// Lower triangle of the matrix.
    matrix: [[f64; TERMS]; TERMS],
    weights: f64,
}

/// A cell to whose value polynomials are fitted.
struct FittedCell {
    number: usize,
    /// Distances from the window's middle, in cells.
    at: [f64; 2],
    weight: f64,
    /// The terms of a polynomial there.
    basis: [f64; TERMS],
}

/// The normal equations of one degree, factored.
pub(super) struct FactoredEquations {
    powers: Vec<usize>,
    factor: Vec<Vec<f64>>,
    /// The first entry of the inverse: the variance of the value at the middle, over that of values.
    spread: f64,
}

impl FitWindow {
    /// The known cells around `cell`, nearer ones weighing more.
    pub(super) fn around(
        shape: [usize; 2],
        cell @ [i, j]: [usize; 2],
        reach: usize,
        is_known: impl Fn(usize) -> bool,
    ) -> Self {
        let scale = 1.0 / reach as f64;
        let fitted = |[k, l]: [usize; 2]| {
            let number = k * shape[1] + l;
            let at = [k as f64 - i as f64, l as f64 - j as f64];
            let [u, v] = at.map(|cells| cells * scale);
            let (uu, vv) = (u * u, v * v);
            let rest = WEIGHT_RADIUS_SQUARED - (uu + vv);
            let basis = [1.0, u, v, uu, u * v, vv, u * uu, uu * v, u * vv, v * vv];
            let counts = rest > 0.0 && is_known(number);
            counts.then_some(FittedCell { number, at, weight: rest * rest, basis })
        };
        let cells: Vec<FittedCell> = around(shape, cell, reach).filter_map(fitted).collect();
        let mut matrix = [[0.0; TERMS]; TERMS];
        for FittedCell { weight, basis, .. } in &cells {
            for (a, row) in matrix.iter_mut().enumerate() {
                let along = weight * basis[a];
                for (sum, across) in row[..=a].iter_mut().zip(basis) {
                    *sum += along * across;
                }
            }
        }
        let weights = cells.iter().map(|cell| cell.weight).sum();
        Self { line: shape[0] == 1, reach, cells, matrix, weights }
    }

    /// The equations of a polynomial of `degree`; none where there are too few values, or they do not determine it.
    pub(super) fn equations(&self, degree: u8) -> Option<FactoredEquations> {
        let used = |[a, b]: [u8; 2]| a + b <= degree && !(self.line && a > 0);
        let powers: Vec<usize> = (0..TERMS).filter(|k| used(POWERS[*k])).collect();
        let terms = powers.len();
        if self.cells.len() < fewest_values(terms, self.line) {
            return None;
        }
        let factor = cholesky(terms, PIVOT_LIMIT, |a, b| self.matrix[powers[a]][powers[b]])?;
        let mut first = vec![0.0; terms];
        first[0] = 1.0;
        let spread = backward(&factor, forward(&factor, first))[0];
        Some(FactoredEquations { powers, factor, spread })
    }

    /// The most certain of the polynomials that fit best to the values of the cells, which `value` gives from their numbers and
    /// places in cells from the middle.
    pub(super) fn fit(
        &self,
        equations: &[FactoredEquations],
        value: impl Fn(usize, [f64; 2]) -> f64,
    ) -> Option<Fit> {
        let (mut right, mut squares) = ([0.0; TERMS], 0.0);
        for FittedCell { number, at, weight, basis } in &self.cells {
            let value = value(*number, *at);
            let along = weight * value;
            right.iter_mut().zip(basis).for_each(|(sum, across)| *sum += along * across);
            squares += along * value;
        }
        let fits = equations.iter().filter_map(|of_degree| {
            let FactoredEquations { powers, factor, spread } = of_degree;
            let right: Vec<f64> = powers.iter().map(|row| right[*row]).collect();
            let solution = backward(factor, forward(factor, right.clone()));
            let product: f64 = solution.iter().zip(&right).map(|(c, r)| c * r).sum();
            let count = self.cells.len() as f64;
            let free = count / (count - powers.len() as f64);
            let variance = ((squares - product) / self.weights * free).max(0.0);
            let mut polynomial = SquaredPressure([0.0; TERMS]);
            for (value, k) in solution.iter().zip(powers) {
                let [a, b] = POWERS[*k];
                polynomial.0[*k] = value / (self.reach as f64).powi(i32::from(a + b));
            }
            let deviation = (variance * spread * self.weights / count).sqrt();
            let uncertainty = deviation / polynomial.slope();
            uncertainty.is_finite().then_some(Fit { polynomial, uncertainty })
        });
        fits.reduce(|a, b| if b.uncertainty < a.uncertainty { b } else { a })
    }
}

/// Cells of the grid within `reach` rows and columns of a cell, itself included.
pub(in crate::stress) fn around(
    [nx, ny]: [usize; 2],
    [i, j]: [usize; 2],
    reach: usize,
) -> impl Iterator<Item = [usize; 2]> {
    let rows = i.saturating_sub(reach)..(i + reach + 1).min(nx);
    rows.flat_map(move |i| (j.saturating_sub(reach)..(j + reach + 1).min(ny)).map(move |j| [i, j]))
}

/// Whether a cell is at the border of the grid; a row of line contact is endless and has none.
pub(super) fn is_at_border([nx, ny]: [usize; 2], [i, j]: [usize; 2]) -> bool {
    let ends = |at: usize, count: usize| at == 0 || at + 1 == count;
    ends(j, ny) || nx > 1 && ends(i, nx)
}

/// Distance in cells of each cell from the nearest without pressure, a diagonal step counting as one;
/// at most `limit`. Beyond the grid there is no pressure; a row of line contact is endless.
pub(super) fn edge_distances(pressure: &[f64], [nx, ny]: [usize; 2], limit: u8) -> Vec<u8> {
    let mut distances: Vec<u8> = pressure.iter().map(|p| u8::from(*p > 0.0)).collect();
    for level in 1..limit {
        let before = distances.clone();
        let inside = |i: isize, j: isize| {
            let row = nx == 1 || (0..nx as isize).contains(&i);
            let column = (0..ny as isize).contains(&j);
            let i = if nx == 1 { 0 } else { i };
            row && column && before[i as usize * ny + j as usize] >= level
        };
        for (cell, distance) in distances.iter_mut().enumerate() {
            if *distance == level {
                let (i, j) = ((cell / ny) as isize, (cell % ny) as isize);
                let all = (-1..=1).all(|a| (-1..=1).all(|b| inside(i + a, j + b)));
                *distance += u8::from(all);
            }
        }
    }
    distances
}

/// Sums of a field over rectangles of cells, from its sums over all rectangles that begin at the first
/// cell.
pub(super) struct RectangleSums {
    shape: [usize; 2],
    sums: Vec<f64>,
}

impl RectangleSums {
    pub(super) fn new(values: &[f64], shape @ [nx, ny]: [usize; 2]) -> Self {
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

    /// Sum over the cells of [`around`].
    pub(super) fn around(&self, [i, j]: [usize; 2], reach: usize) -> f64 {
        let [nx, ny] = self.shape;
        let at = |i: usize, j: usize| self.sums[i * (ny + 1) + j];
        let (top, left) = (i.saturating_sub(reach), j.saturating_sub(reach));
        let (bottom, right) = ((i + reach + 1).min(nx), (j + reach + 1).min(ny));
        at(bottom, right) - at(top, right) - at(bottom, left) + at(top, left)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Result;

    const SHAPE: [usize; 2] = [41, 44];

    /// Values of a function of the distances, in cells, from a centre that is off the grid's.
    fn field(q: impl Fn(f64, f64) -> f64) -> Vec<f64> {
        let [nx, ny] = SHAPE;
        let at = |cell: usize| ((cell / ny) as f64 - 20.3, (cell % ny) as f64 - 21.1);
        (0..nx * ny).map(at).map(|(x, y)| q(x, y)).collect()
    }

    /// All edges of a smooth contact are known; none of one that is rough by 5 %, nor under a punch.
    /// Values at centres are taken for those of a solver: that shifts the edge by p p''/12 over the
    /// slope of p², 1/48 of a cell at one cell from it, twice as much at half a cell.
    #[test]
    fn edges_are_known_where_they_are_smooth() -> Result<()> {
        let hertz = field(|x, y| (1.0 - (x * x + y * y) / 225.0).max(0.0).sqrt());
        let find_edges = |pressure: &[f64]| -> Result<Vec<EdgeCell>> {
            let distances = edge_distances(pressure, SHAPE, BAND + 1);
            let threads = Threads::new(Some(2))?;
            let mut progress = |_| ControlFlow::Continue(());
            match edge_cells(
                pressure,
                &distances,
                SHAPE,
                (&EdgeLaw::default(), Fitting::BEST),
                &threads,
                &mut progress,
            ) {
                ControlFlow::Continue(cells) => Ok(cells),
                ControlFlow::Break(()) => panic!("nothing stops it"),
            }
        };
        let edges = find_edges(&hertz)?;
        assert!(edges.len() > 300);
        for EdgeCell { cell, squared } in edges {
            let (x, y) = (cell[0] as f64 - 20.3, cell[1] as f64 - 21.1);
            let exact = 1.0 - (x * x + y * y) / 225.0;
            // In cells, by the slope 2/15 of p² at the edge.
            let shift = (squared.at(0.0, 0.0) - exact) * 7.5;
            assert!(shift.abs() < 1.0 / 24.0, "{cell:?}: {shift:.1e}");
        }
        let wave = field(|x, y| 1.0 + 0.05 * (1.7 * x).sin() * (1.9 * y).cos());
        let rough: Vec<f64> = hertz.iter().zip(&wave).map(|(p, w)| p * w).collect();
        assert!(find_edges(&rough)?.is_empty());
        let punch: Vec<f64> = hertz.iter().map(|p| if *p > 0.0 { 1.0 / p } else { 0.0 }).collect();
        assert!(find_edges(&punch)?.is_empty());
        Ok(())
    }

    /// A polynomial is found from cells that are three cells inside of its zero and farther, and
    /// continued over it: three cells beyond those that are fitted, rounding grows by 1e4.
    #[test]
    fn polynomials_are_exact() {
        const ROUNDING: f64 = 1e-12;
        let ellipse = |x: f64, y: f64| 1.0 - x * x / 200.0 - y * y / 310.0 + x * y / 900.0;
        let cubic = |x: f64, y: f64| ellipse(x, y) + x.powi(3) / 3e4 - x * y * y / 5e4;
        let check = |q: &dyn Fn(f64, f64) -> f64, degree: u8| {
            let place = |cell: usize| [cell / SHAPE[1], cell % SHAPE[1]];
            let value = |cell: usize| {
                let [i, j] = place(cell);
                q(i as f64 - 20.3, j as f64 - 21.1)
            };
            let values: Vec<f64> = (0..SHAPE[0] * SHAPE[1]).map(value).collect();
            let distances = edge_distances(&values, SHAPE, BAND + 1);
            let inside = |(q, d): (&f64, &u8)| (*d >= BAND).then_some(*q);
            let known: Vec<_> = values.iter().zip(&distances).map(inside).collect();
            let mut count = 0;
            for (cell, distance) in distances.iter().enumerate() {
                if *distance == 0 || *distance > BAND {
                    continue;
                }
                let cell @ [i, j] = place(cell);
                let window = FitWindow::around(SHAPE, cell, 8, |k| known[k].is_some());
                let equations: Vec<_> = window.equations(degree).into_iter().collect();
                let Some(fit) = window.fit(&equations, |k, _| known[k].unwrap_or_default()) else {
                    panic!("too few values around {cell:?}")
                };
                let (x, y) = (i as f64 - 20.3, j as f64 - 21.1);
                for (u, v) in [(0.0, 0.0), (0.5, -0.5), (-1.0, 0.7)] {
                    let error = fit.polynomial.at(u, v) - q(x + u, y + v);
                    assert!(error.abs() < 1e4 * ROUNDING, "{cell:?}: {error:.1e}");
                }
                // The residual is a difference of squares.
                assert!(fit.uncertainty < 1e-5, "{cell:?}: {:.1e}", fit.uncertainty);
                count += 1;
            }
            assert!(count > 200);
        };
        check(&ellipse, 2);
        check(&cubic, 3);
    }

    #[test]
    fn sums_over_rectangles_are_those_of_their_cells() {
        let shape @ [nx, ny] = [5, 7];
        let values: Vec<f64> = (0..nx * ny).map(|k| (k * k % 11) as f64).collect();
        let sums = RectangleSums::new(&values, shape);
        for cell in around(shape, [0, 0], 7) {
            for reach in [0, 1, 3] {
                let direct: f64 = around(shape, cell, reach).map(|[i, j]| values[i * ny + j]).sum();
                // Small whole numbers are summed exactly.
                assert!((sums.around(cell, reach) - direct).abs() < f64::EPSILON);
            }
        }
    }

    /// A contact of 5 × 6 cells, which the grid's border cuts; in line contact, of 6 cells.
    #[test]
    fn distances_are_counted_from_the_edge_and_the_border() {
        let (nx, ny) = (5, 8);
        let pressure: Vec<f64> =
            (0..nx * ny).map(|k| f64::from(u8::from((1..7).contains(&(k % ny))))).collect();
        let distances = edge_distances(&pressure, [nx, ny], 4);
        assert_eq!(distances[..ny], [0, 1, 1, 1, 1, 1, 1, 0]);
        assert_eq!(distances[2 * ny..3 * ny], [0, 1, 2, 3, 3, 2, 1, 0]);
        let line = edge_distances(&pressure[..ny], [1, ny], 3);
        assert_eq!(line, [0, 1, 2, 3, 3, 2, 1, 0]);
        assert!(is_at_border([1, ny], [0, 0]) && !is_at_border([1, ny], [0, 3]));
    }
}
