//! With which error cells resolve the pressure of a solved contact; whether it has a law at its smooth edges.
//!
//! # The error
//!
//! Within a cell the pressure is known up to a part of the step to the next cell: a quarter where it is
//! taken as uniform. Where an edge is reconstructed it is a thirtieth, and on layers as much more as their law
//! changes over the cells of a fit; a hundredth in the interior, where it is parabolic. Of tractions that are uniform over cells, as those of partial slip are, it is a half, and three
//! quarters where they may grow as a root within a cell: at an edge that is not located, and at the border of a zone that sticks.
//! Steps of known tractions are their own. A step on cells of side d
//! holds wavelengths of about 4 d and less, shorter ones in proportion to their length, and each
//! reaches a depth z with the transfer of the layered body, (1 + αz) e^{−αz} and the like:
//!
//! ```text
//! max over axes, α ≥ 1.5/d, components:   share · step · |D(α; z)| · 1.5/(α d)
//! ```
//!
//! D is the stress under a unit pressure of wavenumber α, and under the friction in proportion to it. On
//! hard coatings it is large at wavelengths of a few thicknesses. Steps are those within some cells of a place.
//!
//! At an edge that is reconstructed, the loads of cells are followed over some cells only ([`super::near`]). What is left
//! out falls off as the inverse cube of the distance from the edge, which is added.
//!
//! The edge is known to a part of a cell, and with it the width of the contact. Extremes at depths of up to a half-width have
//! the error c/n² + c' of the largest pressure in a contact n cells wide, and more in layers whose stress under waves as long as
//! the contact exceeds the pressure; the shear stress below has its part of that error. Farther below, it falls as the square of
//! the depth, at least as fast as the stress.

use crate::compliance::response::Response;
use crate::compliance::response::interior::{Column, Place};
use crate::model::body::HalfSpace;
use crate::model::grid::{Grid, Window};

use super::edge::{BAND, around, edge_distances};
use super::law::EdgeLaw;
use super::near::DEPTH_LIMIT;
use super::reconstruction::Reconstruction;

// With these shares, the estimate is some three times the error (`tests/stress/resolution.rs`).

/// Share of a step that is not known where pressure is uniform over cells.
const UNIFORM_SHARE: f64 = 0.25;

/// Share of a step that is not known where an edge is reconstructed.
const EDGE_SHARE: f64 = 0.03;

/// The same at points whose stress is summed over ever smaller pieces, as those of an edge, where the pressure is 0 and the place
/// of the edge moves the whole curve. Of c √d under friction, the smallest piece misses 0.022 μ of the step and pieces that grow
/// by a half make 0.009 μ too much ([`super::reconstruction`]), for 0.04 μ of this.
const POINT_SHARE: f64 = 0.02;

/// Share of a step that is not known in the interior. Below Hertz' contact of 128 cells to the half-width,
/// stresses there err by 3.3e-4 of the peak pressure (`tests/stress/edge.rs`), and a step is a 34th of it.
const INTERIOR_SHARE: f64 = 0.01;

/// Share of a step that is not known where an edge is reconstructed on layers, per change of the law's factor by e over the cells of
/// a fit. Chosen by trial (`tests/stress/resolution.rs`).
const SHARE_OF_CHANGE: f64 = 0.12;

/// Share of a step of the tractions that is not known where they are uniform over cells. Under a sliding ball of 21 to 85
/// cells to the radius, stresses at the surface err by 0.38 to 0.43 of it.
const TRACTION_SHARE: f64 = 0.5;

/// Share of a step of tractions that is not known where they grow as the root of the distance from a place within a cell: at an
/// edge that is not located, and at the border of a zone that sticks, of what they differ by there from a fixed part of the
/// pressure. With exact means of c √d over cells and the place anywhere in one, the largest tension at centres is too small
/// by up to 2 · 0.63 steps behind an edge (less a quarter of the pressure's), and von Mises' stress at a border by up to 2 · 0.62:
/// σ_yy falls to one side and σ_yz to the other. Computed here; with the pressure of 35 contacts of 5 to 22 cells, by up to 2 · 0.74.
const CUSP_SHARE: f64 = 0.75;

/// Stress that is left out at a distance of one cell from an edge, as a part of the step there, if it fell off as the inverse
/// cube of the distance: that of the four cells at an edge p = √d under a strip of pressure, less their means and shares,
/// summed for the edge anywhere in a cell and for all targets at depths of four to eight cells. Where loads four cells to the
/// side are left out, it is at most 3.2e-4 of the step, less than half of what this bounds. Computed here.
const LEFT_OUT: f64 = 0.05;

/// Error of extremes over the largest pressure, times the square of the cells across a contact. Chosen by trial: of 489
/// extremes of 76 random contacts of 16 to 64 cells across, bare and coated, points and lines, whose other errors are below
/// half a per cent, 99 % are within it and these.
const WIDTH_ERROR: f64 = 0.3;

/// Error of extremes over the largest pressure on cells however small, from the search for their depth and from loads that are
/// followed over some cells only. Of a line contact refined to a thousand cells across, they are within 2.4e-5 of those on
/// 1 088 cells.
const LEAST_ERROR: f64 = 3e-5;

/// Wavenumbers, over the inverse of the half-width, at which stresses that exceed the pressure, as in hard layers that bend, tell
/// how much more their error of the width is.
const OF_WIDTH: [f64; 3] = [0.5, 1.0, 2.0];

/// Wavenumber of the longest waves of a step, times the side of a cell.
const LONGEST: f64 = 1.5;

/// Largest wavenumber that is looked at, as a multiple of that of the longest waves.
const HIGHEST_RATIO: f64 = 100.0;

/// Number of those wavenumbers, even in their logarithm: four to an octave.
const COUNT: u32 = 27;

/// Distance in cells to which a step is felt near the surface.
pub(super) const STEP_REACH: usize = 6;

/// What is not known of the pressure of a solved contact, at the wavenumbers that matter.
#[derive(Debug)]
pub(super) struct Uncertainty {
    shape: [usize; 2],
    /// Sides of a cell.
    spacing: [f64; 2],
    /// Depth to which the loads of cells at an edge are followed.
    followed: f64,
    /// Error of the stress down to the depth of half the width of the contact, due to that width.
    of_width: f64,
    half_width: f64,
    /// The body at wavenumbers of the width.
    columns: Vec<Column>,
    known: Vec<Known>,
    /// Known tractions along x and along y.
    tractions: Option<[Vec<f64>; 2]>,
    /// Waves along x and along y.
    waves: [Vec<Wave>; 2],
}

/// One wave of a step of the pressure.
#[derive(Debug)]
struct Wave {
    /// Its pressure over the step, by how well the pressure is known.
    shares: [f64; 3],
    /// The same near an edge, at points whose stress is summed over ever smaller pieces.
    at_point: f64,
    /// The same of tractions that are uniform over cells, and where they may grow as a root.
    tractions: [f64; 2],
    /// The body at its wavenumber.
    column: Column,
}

/// Largest steps from cell to cell along one axis \[Pa\]: of the pressure by how well it is known in the worse of the two cells,
/// of known tractions likewise, and of what they differ by from a fixed part of the pressure, where that is known.
type AxisSteps = [f64; STEPS];

/// Number of kinds of [`AxisSteps`].
const STEPS: usize = 7;

/// Number of the first step of known tractions.
const OF_TRACTION: usize = 3;

/// Number of the step of what tractions differ by from a fixed part of the pressure.
const OF_RATIO: usize = 6;

/// Largest steps along x and along y in a part of the grid.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(in crate::stress) struct LocalSteps([AxisSteps; 2]);

/// Errors of the stress at one depth per unit of the steps around a place.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::stress) struct StepErrors {
    /// Of each component, under pressure and the friction in proportion to it, and under tractions that are uniform over cells.
    factors: [[AxisSteps; 2]; COMPONENTS_APART],
    /// Errors of each component that do not depend on the steps.
    everywhere: ByComponent,
}

/// What an error is of: components whose errors differ.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::stress) enum ErrorOf {
    /// σ_zz.
    Normal,
    /// σ_xz and σ_yz.
    Shear,
    /// σ_xx, σ_yy and σ_xy.
    Lateral,
    /// All components.
    Any,
}

/// Number of components whose errors differ.
pub(in crate::stress) const COMPONENTS_APART: usize = 3;

/// An error \[Pa\] of each of them: of σ_zz, of the shear stresses on planes of constant depth, and of the lateral stresses.
pub(in crate::stress) type ByComponent = [f64; COMPONENTS_APART];

impl ErrorOf {
    /// Numbers of its components.
    fn numbers(self) -> std::ops::Range<usize> {
        match self {
            Self::Any => 0..COMPONENTS_APART,
            of => of as usize..of as usize + 1,
        }
    }
}

impl StepErrors {
    /// Errors \[Pa\] from waves along x and along y, where the pressure has these steps.
    pub(in crate::stress) fn by_axis(&self, steps: &LocalSteps, of: ErrorOf) -> [f64; 2] {
        let parts = of.numbers().map(|part| self.of_part(part, steps));
        parts.fold([0.0; 2], |a, b| [0, 1].map(|axis| f64::max(a[axis], b[axis])))
    }

    fn of_part(&self, part: usize, LocalSteps(steps): &LocalSteps) -> [f64; 2] {
        [0, 1].map(|axis| {
            let errors =
                self.factors[part][axis].iter().zip(&steps[axis]).map(|(f, step)| f * step);
            let mut largest = [0.0; 2];
            for (k, error) in errors.enumerate() {
                let largest = &mut largest[usize::from(k >= OF_TRACTION)];
                *largest = error.max(*largest);
            }
            largest[0] + largest[1] + self.everywhere[part]
        })
    }

    /// The error \[Pa\] where the pressure has these steps.
    pub(in crate::stress) fn at(&self, steps: &LocalSteps, of: ErrorOf) -> f64 {
        let [along, across] = self.by_axis(steps, of);
        along.max(across)
    }

    /// The larger of two errors.
    pub(in crate::stress) fn larger(self, other: Self) -> Self {
        let larger = |part: usize, axis: usize, k: usize| {
            self.factors[part][axis][k].max(other.factors[part][axis][k])
        };
        let of_part = |part| [0, 1].map(|axis| std::array::from_fn(|k| larger(part, axis, k)));
        Self {
            factors: std::array::from_fn(of_part),
            everywhere: std::array::from_fn(|k| self.everywhere[k].max(other.everywhere[k])),
        }
    }

    /// These errors, and others that do not depend on the steps.
    pub(in crate::stress) fn plus(mut self, everywhere: ByComponent) -> Self {
        self.everywhere.iter_mut().zip(everywhere).for_each(|(error, added)| *error += added);
        self
    }

    /// The error that does not depend on the steps.
    pub(in crate::stress) fn everywhere(&self, of: ErrorOf) -> f64 {
        self.everywhere[of.numbers()].iter().copied().fold(0.0, f64::max)
    }

    /// The errors of values in cells of the layer at the surface, whose larger values at an edge that is known are found at
    /// points of the edge. What is not in proportion to the pressure there stays uniform over cells.
    pub(in crate::stress) fn beside_points(mut self) -> Self {
        for factors in self.factors.as_flattened_mut() {
            factors[OF_TRACTION + Known::Edge as usize] = 0.0;
        }
        self
    }

    /// The errors of values in cells whose errors due to an edge that is known are those of points around it.
    pub(in crate::stress) fn without_edges(mut self) -> Self {
        for factors in self.factors.as_flattened_mut() {
            factors[Known::Edge as usize] = 0.0;
        }
        self
    }

    /// The errors of values in cells at depths of less than a cell, where larger ones may lie between centres at an edge that is
    /// known, but has no points. Farther below, stresses are smooth enough for parabolas.
    pub(in crate::stress) fn without_points(mut self) -> Self {
        for factors in self.factors.as_flattened_mut() {
            factors[Known::Edge as usize] = factors[Known::Mean as usize];
        }
        self
    }
}

impl Uncertainty {
    pub(super) fn new(
        body: &HalfSpace,
        grid: &Grid,
        (pressure, tractions): (&[f64], Option<[Vec<f64>; 2]>),
        reconstruction: &Reconstruction,
    ) -> Self {
        let shape = grid.shape();
        let distances = edge_distances(pressure, shape, BAND + 1);
        let state = |distance: &u8| match *distance {
            1..=BAND => Known::Mean,
            _ => Known::Well,
        };
        let mut known: Vec<Known> = distances.iter().map(state).collect();
        for root in &reconstruction.roots {
            known[root.cell[0] * shape[1] + root.cell[1]] = Known::Edge;
        }
        let edge = SHARE_OF_CHANGE * reconstruction.law.change();
        let [edge, at_point] =
            [EDGE_SHARE, POINT_SHARE].map(|least| (least + edge).min(UNIFORM_SHARE));
        let waves = |spacing: f64| {
            let wave = |k: u32| {
                let ratio = HIGHEST_RATIO.powf(f64::from(k) / f64::from(COUNT - 1));
                let alpha = ratio * LONGEST / spacing;
                Wave {
                    shares: [INTERIOR_SHARE, edge, UNIFORM_SHARE].map(|share| share / ratio),
                    at_point: at_point / ratio,
                    tractions: [TRACTION_SHARE, CUSP_SHARE].map(|share| share / ratio),
                    column: Column::new(body, alpha),
                }
            };
            (0..COUNT).map(wave).collect()
        };
        let peak = pressure.iter().copied().fold(0.0, f64::max);
        let spacing = grid.spacing();
        let across = cells_across(pressure, shape);
        let shorter = if grid.is_line() { spacing[1] } else { spacing[0].min(spacing[1]) };
        let half_width = 0.5 * f64::min(across[0] * spacing[0], across[1] * spacing[1]);
        let column = |alpha: f64| Column::new(body, alpha / half_width);
        let is_wide = half_width > 0.0 && half_width.is_finite();
        Self {
            shape,
            spacing,
            followed: DEPTH_LIMIT * shorter,
            of_width: peak * (WIDTH_ERROR / across[0].min(across[1]).powi(2) + LEAST_ERROR),
            half_width,
            columns: OF_WIDTH.into_iter().filter(|_| is_wide).map(column).collect(),
            known,
            tractions,
            waves: spacing.map(waves),
        }
    }

    /// Whether the pressure is known within a cell and those beside it.
    pub(super) fn is_known_around(&self, cell: [usize; 2]) -> bool {
        around(self.shape, cell, 1).all(|[i, j]| self.known[i * self.shape[1] + j] != Known::Mean)
    }

    /// Errors of the stress in `body` at the depth of `place` \[Pa\] due to the width of the contact, at all places, under pressure
    /// and `friction` times it.
    pub(super) fn width_errors(
        &self,
        body: &HalfSpace,
        place: &Place,
        friction: [f64; 2],
    ) -> ByComponent {
        if self.of_width <= 0.0 {
            return ByComponent::default();
        }
        let beyond = (self.half_width / place.depth.max(self.half_width)).powi(2);
        let friction = friction[0].hypot(friction[1]);
        // Waves as long as the contact and, where it is wide, all longer ones.
        let mut responses = [1.0, friction, 1.0];
        for fields in self.columns.iter().map(|column| column.at(body, place)) {
            let (along, across) = fields.pressure.lateral_stress(place.material);
            let shear = fields.pressure.tau.abs() + friction * fields.shear.tau.abs();
            let of_wave = [fields.pressure.p.abs(), shear, along.abs().max(across.abs())];
            responses = std::array::from_fn(|k| f64::max(responses[k], of_wave[k]));
        }
        responses.map(|response| self.of_width * beyond * response)
    }

    /// How well the pressure is known in the worse of two cells.
    fn worse(&self, a: usize, b: usize) -> usize {
        self.known[a].max(self.known[b]) as usize
    }

    /// Steps of `pressure`, and of known tractions, from one cell to another.
    fn steps_between(&self, pressure: &[f64], a: usize, b: usize) -> AxisSteps {
        let (known, mut steps) = (self.worse(a, b), AxisSteps::default());
        let [p, next] = [a, b].map(|cell| pressure[cell]);
        steps[known] = (p - next).abs();
        if let Some(tractions) = &self.tractions {
            let length = |of: &dyn Fn(&[f64]) -> f64| of(&tractions[0]).hypot(of(&tractions[1]));
            steps[OF_TRACTION + known] = length(&|q| q[a] - q[b]);
            let larger = p.max(next);
            if known != Known::Mean as usize && larger > 0.0 {
                steps[OF_RATIO] = length(&|q| (q[a] * next - q[b] * p) / larger);
            }
        }
        steps
    }

    /// Largest steps of `pressure`, and of known tractions, that are felt in the cells of `window`.
    pub(super) fn steps(&self, pressure: &[f64], window: &Window) -> LocalSteps {
        let [nx, ny] = self.shape;
        let rows = window[0].start.saturating_sub(STEP_REACH)..(window[0].end + STEP_REACH).min(nx);
        let columns =
            window[1].start.saturating_sub(STEP_REACH)..(window[1].end + STEP_REACH).min(ny);
        let count = |largest: &mut AxisSteps, a: usize, b: usize| {
            let steps = self.steps_between(pressure, a, b);
            largest.iter_mut().zip(steps).for_each(|(largest, step)| *largest = largest.max(step));
        };
        let [mut along, mut across] = [AxisSteps::default(); 2];
        for i in rows.clone() {
            for j in columns.clone() {
                let cell = i * ny + j;
                if i + 1 < rows.end {
                    count(&mut along, cell, cell + ny);
                }
                if j + 1 < columns.end {
                    count(&mut across, cell, cell + 1);
                }
            }
        }
        LocalSteps([along, across])
    }

    /// [`Uncertainty::steps`] of each cell by itself.
    pub(super) fn steps_by_cell(&self, pressure: &[f64]) -> Vec<LocalSteps> {
        let [nx, ny] = self.shape;
        let mut steps = vec![LocalSteps::default(); pressure.len()];
        for (axis, (next, count)) in [(ny, nx), (1, ny)].into_iter().enumerate() {
            let kinds = if self.tractions.is_some() { STEPS } else { OF_TRACTION };
            for kind in 0..kinds {
                // The step from each cell to the next along the axis.
                let step = |cell: usize| match [cell / ny, cell % ny][axis] + 1 < count {
                    true => self.steps_between(pressure, cell, cell + next)[kind],
                    false => 0.0,
                };
                let mut largest: Vec<f64> = (0..pressure.len()).map(step).collect();
                for along in 0..2 {
                    let ahead = STEP_REACH - usize::from(along == axis);
                    largest = largest_around(&largest, self.shape, along, [STEP_REACH, ahead]);
                }
                for (steps, largest) in steps.iter_mut().zip(largest) {
                    steps.0[axis][kind] = largest;
                }
            }
        }
        steps
    }

    /// Estimated errors of the components of the stress at `place`, under pressure and `friction` times it; `within` cells at a
    /// point, where known tractions are in proportion to the pressure, and elsewhere uniform over cells.
    pub(super) fn at(
        &self,
        body: &HalfSpace,
        place: &Place,
        (friction, within): ([f64; 2], bool),
    ) -> StepErrors {
        let friction = friction[0].hypot(friction[1]);
        let uniform = self.tractions.is_some() && !within;
        let material = place.material;
        let mut errors = StepErrors::default();
        // Numbers of p, τ and the two lateral stresses of a wave, by part.
        let parts =
            |part: usize| part..(if part == ErrorOf::Lateral as usize { 4 } else { part + 1 });
        for axis in 0..2 {
            for wave in &self.waves[axis] {
                let fields = wave.column.at(body, place);
                let [pressed, sheared] = [&fields.pressure, &fields.shear].map(|state| {
                    let (along, across) = state.lateral_stress(material);
                    [state.p, state.tau, along, across].map(f64::abs)
                });
                let (q, u) = fields.twist;
                let twisted = [0.0, q.abs(), (material.shear() * u).abs()];
                let factors = &mut errors.factors;
                let [well, edge, mean] = wave.shares;
                let shares = [well, if within { wave.at_point } else { edge }, mean];
                for (known, share) in shares.into_iter().enumerate() {
                    let of_tractions = match known == Known::Mean as usize {
                        _ if uniform => 0.0,
                        true => wave.tractions[1],
                        false => share,
                    };
                    // With these shares of the pressure and of the tractions.
                    for (part, factors) in factors.iter_mut().enumerate() {
                        let sums = parts(part)
                            .map(|k| share * pressed[k] + of_tractions * friction * sheared[k]);
                        let twist = of_tractions * friction * twisted[part];
                        let error = &mut factors[axis][known];
                        *error = sums.fold(twist.max(*error), f64::max);
                    }
                }
                let first = if uniform { OF_TRACTION } else { OF_RATIO };
                for (part, factors) in factors.iter_mut().enumerate() {
                    let sheared = parts(part).map(|k| sheared[k]).fold(twisted[part], f64::max);
                    for (k, error) in factors[axis].iter_mut().enumerate().skip(first) {
                        let is_cusp = k == OF_RATIO || k == OF_TRACTION + Known::Mean as usize;
                        *error = error.max(wave.tractions[usize::from(is_cusp)] * sheared);
                    }
                }
            }
            // Beside the loads that are followed, or below all of them.
            let distance = match place.depth < self.followed {
                true => DEPTH_LIMIT * self.spacing[0].max(self.spacing[1]),
                false => place.depth,
            } / self.spacing[axis];
            let left_out = LEFT_OUT / distance.powi(3) * (1.0 + friction);
            for factors in &mut errors.factors {
                // Without any load that is followed, pressure is uniform over cells.
                let uniform = factors[axis][Known::Mean as usize];
                let edge = &mut factors[axis][Known::Edge as usize];
                *edge = edge.max(left_out.min(uniform));
            }
        }
        errors
    }
}

/// The largest of `values` within so many cells before and after each along one axis.
fn largest_around(
    values: &[f64],
    [nx, ny]: [usize; 2],
    axis: usize,
    [before, after]: [usize; 2],
) -> Vec<f64> {
    let (count, next) = [(nx, ny), (ny, 1)][axis];
    let largest = |cell: usize| {
        let at = [cell / ny, cell % ny][axis];
        let around = at.saturating_sub(before)..(at + after + 1).min(count);
        around.map(|k| values[cell - at * next + k * next]).fold(0.0, f64::max)
    };
    (0..values.len()).map(largest).collect()
}

/// Mean number of cells in a row across a contact along each axis; infinite where there is no contact, and along x in line
/// contact, whose rows are endless.
fn cells_across(pressure: &[f64], [nx, ny]: [usize; 2]) -> [f64; 2] {
    let touches = |i: usize, j: usize| pressure[i * ny + j] > 0.0;
    let (mut cells, mut starts) = (0.0, [0.0, 0.0]);
    for i in 0..nx {
        for j in (0..ny).filter(|j| touches(i, *j)) {
            cells += 1.0;
            starts[0] += f64::from(u8::from(nx > 1 && (i == 0 || !touches(i - 1, j))));
            starts[1] += f64::from(u8::from(j == 0 || !touches(i, j - 1)));
        }
    }
    starts.map(|starts| if starts > 0.0 { cells / starts } else { f64::INFINITY })
}

/// How well the pressure within a cell is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Known {
    /// Parabolic, or without pressure.
    Well,
    /// A root near a smooth edge.
    Edge,
    /// Uniform.
    Mean,
}

/// Deflection of springs at the surface that makes no difference to the law at an edge, over that of a wave as long as the
/// bodies under it are stiff on 2π cells.
const NEGLIGIBLE_SPRINGS: f64 = 0.06;

/// The bodies of a contact, whose responses add.
pub(in crate::stress) struct BodyPair<'a>(pub(in crate::stress) Vec<&'a dyn Response>);

impl BodyPair<'_> {
    /// α û/p̂ of all bodies at the wavenumber α, without springs at the surface.
    pub(super) fn response(&self, alpha: f64) -> f64 {
        self.0.iter().map(|body| body.normal(alpha)).sum()
    }

    /// The law at smooth edges on the cells of `grid`; none on springs, on which pressure does not fall as a root.
    pub(super) fn edge_law(&self, grid: &Grid) -> Option<EdgeLaw> {
        let [dx, dy] = grid.spacing();
        let sides = if grid.is_line() { [dy; 2] } else { [dx, dy] };
        let wave = 1.0 / sides[0].min(sides[1]);
        let springs: f64 = self.0.iter().map(|body| wave * body.local()).sum();
        let holds = springs <= NEGLIGIBLE_SPRINGS * self.response(wave);
        holds.then(|| EdgeLaw::new(|alpha| self.response(alpha), sides))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steps of each cell by itself are those of a window of one cell, in a plane and in a line.
    #[test]
    fn steps_by_cell_are_those_of_windows() {
        for shape @ [nx, ny] in [[17, 23], [1, 31]] {
            let known = [Known::Well, Known::Edge, Known::Mean];
            let cells = 0..nx * ny;
            let uncertainty = Uncertainty {
                shape,
                spacing: [1.0; 2],
                followed: DEPTH_LIMIT,
                of_width: 0.0,
                half_width: 1.0,
                columns: Vec::new(),
                known: cells.clone().map(|k| known[k * k % 7 % 3]).collect(),
                tractions: Some(
                    [3, 5].map(|n| cells.clone().map(|k| (k * n % 13) as f64).collect()),
                ),
                waves: [Vec::new(), Vec::new()],
            };
            let pressure: Vec<f64> = cells.clone().map(|k| (k * k % 101) as f64).collect();
            let steps = uncertainty.steps_by_cell(&pressure);
            for (k, steps) in cells.zip(&steps) {
                let window = [k / ny, k % ny].map(|at| at..at + 1);
                let expected = uncertainty.steps(&pressure, &window);
                // The same differences, of which the largest is chosen.
                assert_eq!(Some(*steps), Some(expected), "{k}");
            }
        }
    }

    /// A ring of two cells, and a line of contacts of 3 and 5 cells.
    #[test]
    fn cells_across_are_means_of_rows() {
        let ring: Vec<f64> = (0..49)
            .map(|k| {
                f64::from(u8::from(![2, 3, 4].contains(&(k / 7)) || ![2, 3, 4].contains(&(k % 7))))
            })
            .collect();
        // 40 cells: four rows of 7, three of twice 2.
        assert_eq!(Some(cells_across(&ring, [7, 7])), Some([4.0; 2]));
        let line = [0.0, 1.0, 1.0, 1.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0];
        assert_eq!(Some(cells_across(&line, [1, 10])), Some([f64::INFINITY, 4.0]));
        assert_eq!(Some(cells_across(&[0.0; 4], [2, 2])), Some([f64::INFINITY; 2]));
    }
}
