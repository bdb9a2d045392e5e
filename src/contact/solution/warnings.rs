//! Warnings about a finished solution.

use std::fmt;

use ndarray::Array2;

use crate::compliance::ends::Ends;
use crate::contact::problem::patch::rows;
use crate::model::grid::{Axis, Grid, Window};
use crate::model::surface::{Extent, Surface};
use crate::numerics::layout::slice;
use crate::numerics::parallel::{Lanes, ONE, all, sum, update_with_largest, where_positive};

/// A warning: something about a solution that its user should know.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Warning {
    /// The contact touches the edge of the grid, and the shape extends beyond it.
    GridEdge,
    /// The contact reaches the end of a shape of finite length, as of a roller.
    SharpEnd {
        /// The axis.
        axis: Axis,
    },
    /// The contact reaches the free end of one body, where the other extends beyond it.
    FreeEnd,
    /// A body with layers has a free end, for which there is only a model.
    CoatedEnd,
    /// The contact reaches an edge of the shape that is not an end along x or y, as that of a punch.
    SharpEdge,
    /// The contact reaches the rim of a measured map.
    MapRim {
        /// The axis.
        axis: Axis,
    },
    /// Fewer than eight cells resolve the contact.
    Coarse {
        /// The axis.
        axis: Axis,
        /// Number of cells across the contact.
        cells: usize,
    },
    /// The spots of a rough contact are only a few cells wide.
    CoarseSpots {
        /// The axis.
        axis: Axis,
        /// Mean width of the spots in cells, weighted by their load.
        cells: f64,
    },
    /// The contact is not small compared with a radius of curvature.
    LargeContact {
        /// The axis.
        axis: Axis,
        /// Half-width over radius.
        ratio: f64,
    },
    /// Outside the grid that was chosen, the shape overlaps the deformed surface.
    OutsideGrid {
        /// Deepest overlap \[m\].
        depth: f64,
    },
    /// The peak pressure on the grid that was chosen has an estimated error above 1 %.
    PeakError {
        /// Estimated error, relative to the peak.
        error: f64,
    },
    /// What lies between the stations of a sampled profile makes the peak pressure uncertain.
    Stations {
        /// Estimated error, relative to the peak.
        error: f64,
    },
    /// A profile through fewer of the stations of a sampled profile has no solution, so that no error is known.
    UnknownStations,
    /// A roller is loaded beyond its flat part, on a crown that has no end.
    EndlessCrown {
        /// Coordinate along x at which the load acts, from the middle of the roller \[m\].
        at: f64,
    },
    /// Creepages, with spin, or a twist are not small.
    LargeMotion {
        /// Largest creepage in the contact, or twist \[rad\].
        size: f64,
    },
    /// Sliding or rolling has no estimate of its discretisation error.
    Unestimated {
        /// Why.
        reason: Unestimated,
    },
}

/// Why sliding or rolling has no estimate of its discretisation error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Unestimated {
    /// Too few cells lie across the contact.
    Coarse,
    /// There is no solution on cells of twice the length.
    Unsolved,
    /// The contact was given its influence coefficients, which cells of twice the length do not have.
    Coefficients,
    /// The step goes on from one that has no estimate.
    Before,
}

/// Half-width over radius at which a circle leaves its parabola by 1 %: (a/R)²/4.
const LARGE_CONTACT: f64 = 0.2;

/// Question where a contact is wider than the body it is on.
const WRONG_UNITS: &str = ": are moduli and lengths in consistent units, such as Pa and m?";

/// Cells across the contact below which pressure errs by some per cent.
const FEW_CELLS: usize = 8;

/// Mean width of the contact's spots, in cells, below which pressure errs by ten per cent and more: a round
/// spot of six cells across has 5.3.
const NARROW_SPOTS: f64 = 5.0;

/// Distance between the end of a shape and the rim of its map, relative to the map, that is rounding.
const ROUNDING: f64 = 1e-9;

impl Warning {
    /// Name of the kind of warning, without numbers, by which warnings are counted.
    ///
    /// ```
    /// assert_eq!(nacre::Warning::SharpEnd { axis: nacre::Axis::X }.kind(), "sharp end");
    /// ```
    pub fn kind(&self) -> &'static str {
        match self {
            Self::GridEdge => "grid edge",
            Self::SharpEnd { .. } => "sharp end",
            Self::FreeEnd => "free end",
            Self::CoatedEnd => "coated end",
            Self::SharpEdge => "sharp edge",
            Self::MapRim { .. } => "map rim",
            Self::Coarse { .. } => "coarse",
            Self::CoarseSpots { .. } => "coarse spots",
            Self::LargeContact { .. } => "large contact",
            Self::OutsideGrid { .. } => "outside grid",
            Self::PeakError { .. } => "peak error",
            Self::Stations { .. } => "stations",
            Self::UnknownStations => "unknown stations",
            Self::EndlessCrown { .. } => "endless crown",
            Self::LargeMotion { .. } => "large motion",
            Self::Unestimated { .. } => "no estimate",
        }
    }

    /// Whether the pressure is singular there, so that its peak has no limit on ever finer cells.
    pub(crate) fn is_singular(&self) -> bool {
        matches!(
            self,
            Self::GridEdge
                | Self::SharpEnd { .. }
                | Self::FreeEnd
                | Self::SharpEdge
                | Self::MapRim { .. }
        )
    }
}

// What warnings without numbers say.
const GRID_EDGE: &str = "the contact touches the edge of the grid; take a larger grid";
const SHARP_END_X: &str = "the contact reaches the end of the shape along x, and the bodies extend beyond it: the \
    pressure there is that of a sharp edge on a half-space, far too high for a roller's end, \
    and grows as the grid is refined; give the bodies their ends";
const SHARP_END_Y: &str = "the contact reaches the end of the shape along y: the pressure there is that of \
    a sharp edge on a half-space that extends beyond it, and grows as the grid is refined";
const FREE_END: &str = "the contact reaches the free end of one body along x, beyond which the other extends: the pressure \
    there has no limit, and grows slowly as the grid is refined";
const COATED_END: &str = "a body with layers has a free end: what the end adds to the displacement there is a model, with \
    an error of up to 4 % of the displacement where moduli differ by a factor of 4, and 9 % at 10";
const SHARP_EDGE: &str = "the contact reaches a sharp edge of the shape: the pressure there has no limit, and \
    grows as the grid is refined";
const UNKNOWN_STATIONS: &str = "the error of the peak pressure is not known: with a profile through fewer of its stations there is no \
    such contact; give more stations";

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::GridEdge => f.write_str(GRID_EDGE),
            Self::SharpEnd { axis: Axis::X } => f.write_str(SHARP_END_X),
            Self::SharpEnd { .. } => f.write_str(SHARP_END_Y),
            Self::FreeEnd => f.write_str(FREE_END),
            Self::CoatedEnd => f.write_str(COATED_END),
            Self::SharpEdge => f.write_str(SHARP_EDGE),
            Self::MapRim { axis } => write!(
                f,
                "the contact reaches the rim of the measured map along {axis}: nothing is known beyond it, \
                 so that nothing touches there, and the pressure at the rim is that of a sharp edge; \
                 take a larger map"
            ),
            Self::Coarse { axis, cells } => {
                write!(f, "the contact is only {cells} cells wide along {axis}; take a finer grid")
            }
            Self::CoarseSpots { axis, cells } => write!(
                f,
                "the spots that carry the load are on average only {cells:.1} cells wide along {axis}, \
                 which does not resolve their pressure; take a finer grid"
            ),
            Self::LargeContact { axis, ratio } => {
                write!(
                    f,
                    "the contact is not small compared with the radius along {axis}: half-width/radius = \
                     {ratio:.2}; the bodies are taken as half-spaces"
                )?;
                f.write_str(if *ratio > 1.0 { WRONG_UNITS } else { "" })
            }
            Self::OutsideGrid { depth } => write!(
                f,
                "outside the grid that was chosen, the shape overlaps the deformed surface by {depth:.3e}: \
                 part of the contact is missing; give a grid that holds the whole contact"
            ),
            Self::PeakError { error } => write!(
                f,
                "the peak pressure has an estimated error of {:.1} %: dividing the cells further does \
                 not lower it, or needs too many cells; give a finer grid around the peak, or round \
                 edges and corners of the shape (a sampled profile that is straight between its stations has \
                 a corner at each)",
                100.0 * error
            ),
            Self::Stations { error } => write!(
                f,
                "the peak pressure has an estimated error of {:.0} % from what lies between the stations of the \
                 profile: give more stations, the corners of true edges, or a smoothing length against noise",
                100.0 * error
            ),
            Self::UnknownStations => f.write_str(UNKNOWN_STATIONS),
            Self::EndlessCrown { at } => write!(
                f,
                "the load acts {at:.3e} from the middle of the roller, beyond its flat part, and the contact does not reach \
                 back to the middle: the roller lies on its crown alone, which has no end; give the roller its length",
            ),
            Self::LargeMotion { size } => write!(
                f,
                "the creepage or twist is not small: it reaches {size:.2}, of which the linear theory of elasticity leaves \
                 out the square: about {:.0} % of strains and slip",
                50.0 * size
            ),
            Self::Unestimated { reason } => write!(
                f,
                "force, torque, motion and dissipated energy have no estimate of their discretisation error: {}",
                reason.explanation()
            ),
        }
    }
}

impl Unestimated {
    /// Why, and what to do.
    fn explanation(self) -> &'static str {
        match self {
            Self::Coarse => "it needs 16 cells across the contact; take a finer grid",
            Self::Unsolved => {
                "on cells of twice the length there is no solution; take a finer or larger grid"
            }
            Self::Coefficients => {
                "the influence coefficients that were given are those of this grid alone; leave them out"
            }
            Self::Before => "the step before has none",
        }
    }
}

/// What the user of a solution should know. The pressure is zero outside `window`; the `gap` is infinite
/// where the shape cannot touch, as beyond the ends of `bodies`.
pub(crate) fn warnings(
    pressure: &Array2<f64>,
    window: &Window,
    gap: &Array2<f64>,
    grid: &Grid,
    shape: &dyn Surface,
    bodies: &Ends,
) -> Vec<Warning> {
    let outline = Outline::of(pressure, gap, window);
    let mut warnings = Vec::new();
    if !outline.lines[0].contains(&true) {
        return warnings;
    }
    let rim = Rim::of(pressure, grid, shape);
    if rim.goes_on {
        warnings.push(Warning::GridEdge);
    }

    let mut is_cut = outline.is_cut || rim.ends;
    let (extent, radii) = (shape.extent(), shape.radii());
    let axes = if grid.is_line() { 1..2 } else { 0..2 };
    for axis in axes.clone() {
        let (spacing, coordinates) = (grid.spacing()[axis], grid.coordinates(axis));
        let lines = || outline.lines[axis].iter().zip(&coordinates);
        let touching = || lines().filter(|(touches, _)| **touches).map(|(_, at)| *at);
        let cells = touching().count();
        let (first, last) = (touching().next(), touching().next_back());
        let [low, high] = [first, last].map(|end| end.unwrap_or(0.0));
        if let Extent::CutOff(ends) = extent[axis]
            && !grid.is_periodic()[axis]
        {
            let reached = [low - spacing < ends[0], high + spacing > ends[1]];
            let on_map = on_map_rim(ends, axis, shape);
            let sharp = |k: usize| {
                (reached[k] && !on_map[k]).then(|| sharpness(bodies, axis, k, ends[k], spacing))
            };
            let sharp = [sharp(0), sharp(1)];
            let mut distinct: Vec<Warning> = sharp.into_iter().flatten().flatten().collect();
            distinct.dedup();
            warnings.extend(distinct);
            is_cut &= sharp == [None; 2];
            if (0..2).any(|k| reached[k] && on_map[k]) {
                warnings.push(Warning::MapRim { axis: Axis::ALL[axis] });
                is_cut = false;
            }
        }
        if cells < FEW_CELLS {
            warnings.push(Warning::Coarse { axis: Axis::ALL[axis], cells });
        }
        let half_width = 0.5 * (high - low + spacing);
        let ratio = if grid.is_periodic()[axis] { 0.0 } else { half_width / radii[axis] };
        if ratio > LARGE_CONTACT {
            warnings.push(Warning::LargeContact { axis: Axis::ALL[axis], ratio });
        }
    }
    if is_cut {
        warnings.push(Warning::SharpEdge);
    }
    if let Some(flat) = shape.endless_crown()
        && !matches!(extent[0], Extent::CutOff(_))
    {
        warnings.extend(on_crown(pressure, grid, flat));
    }
    if bodies.layered {
        warnings.push(Warning::CoatedEnd);
    }
    let widths = outline.widths;
    let narrow = axes.min_by(|&a, &b| widths[a].total_cmp(&widths[b]));
    let is_coarse = |warning: &Warning| matches!(warning, Warning::Coarse { .. });
    if let Some(axis) = narrow
        && widths[axis] < NARROW_SPOTS
        && !warnings.iter().any(is_coarse)
    {
        let cells = widths[axis];
        warnings.push(Warning::CoarseSpots { axis: Axis::ALL[axis], cells });
    }
    warnings
}

/// The warning of a contact on the crown alone of a roller that is straight over the range `flat` of x. A true roller ends
/// before: a load beyond the flat part of a roller, which does not even touch the middle, turns it on its end.
fn on_crown(pressure: &Array2<f64>, grid: &Grid, flat: [f64; 2]) -> Option<Warning> {
    let middle = 0.5 * (flat[0] + flat[1]);
    let (mut load, mut moment, mut reached) = (0.0, 0.0, [f64::INFINITY, f64::NEG_INFINITY]);
    for (x, row) in grid.x().iter().zip(pressure.rows()) {
        let force = row.sum();
        if force > 0.0 {
            (load, moment) = (load + force, moment + force * x);
            reached = [reached[0].min(*x), reached[1].max(*x)];
        }
    }
    let (at, half) = (moment / load, 0.5 * grid.spacing()[0]);
    let beyond = at < flat[0] || at > flat[1];
    let apart = reached[0] - half > middle || reached[1] + half < middle;
    (beyond && apart).then_some(Warning::EndlessCrown { at: at - middle })
}

/// The warning of a contact that reaches the end of a shape on side `k` of an axis; `None` where all bodies end there.
fn sharpness(bodies: &Ends, axis: usize, k: usize, end: f64, spacing: f64) -> Option<Warning> {
    match bodies.at(k, end, 0.5 * spacing) {
        (count, _) if axis != 0 || count == 0 => Some(Warning::SharpEnd { axis: Axis::ALL[axis] }),
        (_, true) => None,
        (_, false) => Some(Warning::FreeEnd),
    }
}

/// How a contact meets the outermost cells of its grid.
#[derive(Default)]
struct Rim {
    /// Whether it touches one of them beyond which the shape extends.
    goes_on: bool,
    /// Whether it touches one of them beyond which the shape cannot touch.
    ends: bool,
}

impl Rim {
    fn of(pressure: &Array2<f64>, grid: &Grid, shape: &dyn Surface) -> Self {
        let [nx, ny] = grid.shape();
        let [dx, dy] = grid.spacing();
        let (x, y) = (grid.x(), grid.y());
        let mut rim = Self::default();
        let mut look = |i: usize, j: usize, [beyond_x, beyond_y]: [f64; 2]| {
            if pressure[[i, j]] > 0.0 {
                let goes_on = shape.gap(x[i] + beyond_x, y[j] + beyond_y).is_finite();
                rim.goes_on |= goes_on;
                rim.ends |= !goes_on;
            }
        };
        let repeats = grid.is_periodic();
        for i in (0..nx).filter(|_| !repeats[1]) {
            look(i, 0, [0.0, -dy]);
            look(i, ny - 1, [0.0, dy]);
        }
        if !grid.is_line() && !repeats[0] {
            for j in 0..ny {
                look(0, j, [-dx, 0.0]);
                look(nx - 1, j, [dx, 0.0]);
            }
        }
        rim
    }
}

/// Whether the ends of a shape along an axis are those of its measured map.
fn on_map_rim(ends: [f64; 2], axis: usize, shape: &dyn Surface) -> [bool; 2] {
    shape.grid().map_or([false; 2], |map| {
        let (center, size) = (map.center()[axis], map.size()[axis]);
        let rims = [center - 0.5 * size, center + 0.5 * size];
        [0, 1].map(|k| (ends[k] - rims[k]).abs() <= ROUNDING * size)
    })
}

/// Outline of the cells in contact.
pub(super) struct Outline {
    /// Lines of cells across x and across y: whether each of them has a cell in contact.
    pub(super) lines: [Vec<bool>; 2],
    /// Mean width of the contact along x and along y, in cells; 0 where nothing touches.
    ///
    /// A run is a row of neighbouring cells in contact along the axis, as long as it can be. The mean of
    /// the lengths n of all runs is weighted by their pressures, Σ n Σp / Σ Σp, so that small spots count
    /// only as much as they carry. A round contact whose pressure is Hertz's has 0.88 of its diameter,
    /// a rough one the width of its spots.
    pub(super) widths: [f64; 2],
    /// Whether a cell in contact lies beside one that cannot touch.
    pub(super) is_cut: bool,
}

/// 1 where the shape cannot touch, 0 elsewhere.
fn beyond(gap: Lanes) -> Lanes {
    gap.simd_ge(all(f64::INFINITY)) & ONE
}

impl Outline {
    /// Outline of a pressure that is zero outside `window`. The `gap` is infinite where the shape cannot
    /// touch.
    pub(super) fn of(pressure: &Array2<f64>, gap: &Array2<f64>, window: &Window) -> Self {
        let shape = [pressure.nrows(), pressure.ncols()];
        let mut lines = shape.map(|n| vec![false; n]);
        let (mut carried, mut along_x, mut along_y) = (0.0, 0.0, 0.0);
        let mut is_cut = false;
        let columns = window[1].len();
        // Runs along x that have begun: cells and sum of pressures in each column, and the largest pressure.
        let (mut cells, mut forces) = (vec![0.0; columns], vec![0.0; columns]);
        let mut highest = vec![0.0; columns];
        let mut gap_before: &[f64] = &vec![0.0; columns];
        let (pressure, gap) = (slice(pressure), slice(gap));
        let [pressures, gaps] = [&pressure, &gap].map(|values| rows(values, shape[1], window));
        for ((i, row), gap) in window[0].clone().zip(pressures).zip(gaps) {
            let mut start = 0;
            for run in row.chunk_by(|a, b| (*a > 0.0) == (*b > 0.0)) {
                let end = start + run.len();
                if run[0] > 0.0 {
                    let [force] = sum([run], |[p]| [p]);
                    carried += force;
                    along_y += force * run.len() as f64;
                    lines[0][i] = true;
                    let beside = [start.checked_sub(1), Some(end)];
                    let mut gaps = beside.into_iter().filter_map(|j| gap.get(j?));
                    is_cut |= gaps.any(|h| h.is_infinite());
                }
                start = end;
            }
            let ([cut], [ended]) = update_with_largest(
                [row, gap, gap_before],
                [&mut cells, &mut forces, &mut highest],
                |[p, h, before], [n, force, highest]| {
                    let inside = |value| where_positive(p, value);
                    let edges = inside(beyond(before)) + where_positive(n, beyond(h));
                    let product = n * force;
                    let new = [inside(n + ONE), inside(force + p), highest.fast_max(p)];
                    (new, [edges], [product - inside(product)])
                },
            );
            is_cut |= cut > 0.0;
            along_x += ended;
            gap_before = gap;
        }
        let [last] = sum([&cells, &forces], |[n, force]| [n * force]);
        along_x += last;
        for (line, p) in lines[1][window[1].clone()].iter_mut().zip(highest) {
            *line = p > 0.0;
        }
        let mean = |weighted: f64| {
            if carried > 0.0 { weighted / carried } else { 0.0 }
        };
        Self { lines, widths: [mean(along_x), mean(along_y)], is_cut }
    }
}

/// Warnings as data.
#[cfg(feature = "serde")]
mod data {
    use serde::de::Error as _;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    use super::{Unestimated, Warning};
    use crate::model::grid::Axis;

    /// A warning by its kind, axis and figure, which are 0 where it has none.
    #[derive(Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    struct WarningData {
        kind: String,
        axis: usize,
        figure: f64,
    }

    /// Reasons why sliding or rolling has no estimate, by their numbers in a file.
    const REASONS: [Unestimated; 4] = [
        Unestimated::Coarse,
        Unestimated::Unsolved,
        Unestimated::Coefficients,
        Unestimated::Before,
    ];

    impl Serialize for Warning {
        fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
            let (axis, figure) = match *self {
                Self::GridEdge | Self::SharpEdge | Self::FreeEnd | Self::CoatedEnd => (0, 0.0),
                Self::UnknownStations => (0, 0.0),
                Self::EndlessCrown { at } => (0, at),
                Self::SharpEnd { axis } | Self::MapRim { axis } => (axis.index(), 0.0),
                Self::Coarse { axis, cells } => (axis.index(), cells as f64),
                Self::CoarseSpots { axis, cells } => (axis.index(), cells),
                Self::LargeContact { axis, ratio } => (axis.index(), ratio),
                Self::OutsideGrid { depth } => (0, depth),
                Self::PeakError { error } | Self::Stations { error } => (0, error),
                Self::LargeMotion { size } => (0, size),
                Self::Unestimated { reason } => (reason as usize, 0.0),
            };
            WarningData { kind: self.kind().into(), axis, figure }.serialize(serializer)
        }
    }

    impl<'de> Deserialize<'de> for Warning {
        fn deserialize<D: Deserializer<'de>>(data: D) -> std::result::Result<Self, D::Error> {
            let WarningData { kind, axis, figure } = WarningData::deserialize(data)?;
            let direction = if axis == 0 { Axis::X } else { Axis::Y };
            let all = [
                Self::GridEdge,
                Self::SharpEnd { axis: direction },
                Self::FreeEnd,
                Self::CoatedEnd,
                Self::SharpEdge,
                Self::MapRim { axis: direction },
                Self::Coarse { axis: direction, cells: figure as usize },
                Self::CoarseSpots { axis: direction, cells: figure },
                Self::LargeContact { axis: direction, ratio: figure },
                Self::OutsideGrid { depth: figure },
                Self::PeakError { error: figure },
                Self::Stations { error: figure },
                Self::UnknownStations,
                Self::EndlessCrown { at: figure },
                Self::LargeMotion { size: figure },
            ];
            let unestimated = || {
                let reason = *REASONS.get(axis)?;
                Some(Self::Unestimated { reason }).filter(|warning| warning.kind() == kind)
            };
            let warning = all.iter().find(|warning| warning.kind() == kind);
            warning
                .copied()
                .or_else(unestimated)
                .ok_or_else(|| D::Error::custom(format!("no warning is of the kind {kind:?}")))
        }
    }
}

#[cfg(test)]
mod tests {
    use ndarray::Array2;

    use super::{Outline, Warning};
    use crate::model::grid::{Axis, full_window};

    #[test]
    fn a_contact_wider_than_its_radius_asks_for_units() {
        let asks = |ratio| {
            Warning::LargeContact { axis: Axis::Y, ratio }.to_string().contains("consistent units")
        };
        assert!(asks(1.1) && !asks(0.9));
    }

    /// Outline of the contact with these pressures, in a window of the whole grid.
    fn outline(pressure: &Array2<f64>, gap: &Array2<f64>) -> Outline {
        let shape = [pressure.nrows(), pressure.ncols()];
        Outline::of(pressure, gap, &full_window(shape))
    }

    fn assert_widths(pressure: &Array2<f64>, expected: [f64; 2]) {
        let gap = Array2::zeros(pressure.dim());
        let contact_outline = outline(pressure, &gap);
        for (width, expected) in contact_outline.widths.iter().zip(expected) {
            assert!((width - expected).abs() < 1e-12 * (1.0 + expected), "{width} {expected}");
        }
        assert!(!contact_outline.is_cut);
    }

    #[test]
    fn widths_are_means_over_runs_weighted_by_pressure() {
        let mut pressure = Array2::zeros([12, 17]);
        assert_widths(&pressure, [0.0; 2]);
        for (i, j) in (2..7).flat_map(|i| (3..6).map(move |j| (i, j))) {
            pressure[[i, j]] = 2.0;
        }
        assert_widths(&pressure, [5.0, 3.0]);
        // A single cell that carries as much as the rectangle.
        pressure[[9, 10]] = 30.0;
        assert_widths(&pressure, [3.0, 2.0]);
        // Up to the edges of the grid.
        assert_widths(&Array2::from_elem([5, 6], 0.5), [5.0, 6.0]);
        assert_widths(&Array2::from_elem([1, 6], 0.5), [1.0, 6.0]);
    }

    /// Hertz's pressure: ∫ 2a(1−η²)^½ (1−η²) dη / ∫ (1−η²) dη = 9π/32 of the diameter.
    #[test]
    fn a_round_contact_is_nearly_as_wide_as_its_diameter() {
        let radius = 40.0_f64;
        let pressure = Array2::from_shape_fn([96, 96], |(i, j)| {
            let r2 = (i as f64 - 47.5).powi(2) + (j as f64 - 47.5).powi(2);
            (1.0 - r2 / radius.powi(2)).max(0.0).sqrt()
        });
        let contact_outline = outline(&pressure, &Array2::zeros([96, 96]));
        for width in contact_outline.widths {
            let expected = 9.0 * std::f64::consts::PI / 32.0 * 2.0 * radius;
            // The staircase of cells.
            assert!((width / expected - 1.0).abs() < 5e-3, "{width} {expected}");
        }
        let touching = |lines: &[bool]| lines.iter().filter(|touches| **touches).count();
        assert_eq!(contact_outline.lines.map(|lines| touching(&lines)), [80, 80]);
    }

    /// A contact of one cell beside one that cannot touch, on each of its four sides; at its corner that
    /// is no edge.
    #[test]
    fn cells_beside_those_that_cannot_touch_are_found() {
        let mut pressure = Array2::zeros([7, 9]);
        pressure[[3, 4]] = 1.0;
        for (i, j) in (0..7).flat_map(|i| (0..9).map(move |j| (i, j))) {
            let mut gap = Array2::zeros([7, 9]);
            gap[[i, j]] = f64::INFINITY;
            let cut = i.abs_diff(3) + j.abs_diff(4) == 1;
            assert_eq!(outline(&pressure, &gap).is_cut, cut, "{i} {j}");
        }
    }
}
