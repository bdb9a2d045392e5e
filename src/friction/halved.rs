//! From a solution on cells of twice the length: tractions to start from, and the discretisation error.

use ndarray::Array2;

use super::solution::{FrictionDiscretisation, FrictionSolution, TangentialMotion};
use super::step::{Freedom, Friction};
use crate::contact::{Report, Solution, Unestimated};
use crate::error;
use crate::model::grid::{Grid, Window, each_cell, full_window};

/// Cells across the contact, of twice the length, from which on their solution tells the error.
pub(super) const LEAST: usize = 8;

/// The error of a number over its change from cells of twice the length, of which second order leaves a third. Edges that
/// are staircases of cells add errors of any sign: of 90 random contacts on 40 and on 80 cells across, 97 and 99 % have all
/// four errors within this multiple of the largest change, 90 and 97 % within the change itself.
const BEYOND: f64 = 1.5;

/// Least relative error of forces, times the cells across the contact to the power of 3/2: where the traction rises as the
/// root of the distance from an edge, which lies anywhere in its cell, the cell there has force of this order, so that
/// changes between two grids may be small by chance. Of 800 placings of Carter's contact on 20 to 200 cells across, with
/// 0.09 all are within the error; without it, 97 % are where the creepage is given, and 94 % where the force is. Of 150 of
/// Cattaneo's, 98 % have the shift within the error without it, and all with it.
const CHANCE: f64 = 0.09;

/// Error of a creepage over that of the force, both relative: ½/(t − t²) by Carter's law, F = μW (2t − t²), is 2 to 5.3 for
/// forces of 0.2 to 0.98 μW.
const STEEPNESS: f64 = 10.0 / 3.0;

/// Mean over each cell of twice the length, from the cells within that are on the grid.
fn means(field: &Array2<f64>, fine: &Grid, coarse: &Grid) -> Array2<f64> {
    let ratio = ratio(fine, coarse);
    Array2::from_shape_fn(coarse.shape(), |(i, j)| {
        let window = within([i, j], ratio, fine.shape());
        let count = window[0].len() * window[1].len();
        each_cell(&window).map(|cell| field[cell]).sum::<f64>() / count as f64
    })
}

/// Friction on cells of twice the length.
pub(super) fn coarse_friction(friction: &Friction, fine: &Grid, coarse: &Grid) -> Friction {
    match friction {
        Friction::Uniform(coefficient) => Friction::Uniform(*coefficient),
        Friction::Cells(cells) => Friction::Cells(means(cells, fine, coarse)),
    }
}

/// The state of `solution` on cells of twice the length, from which a history goes on where none was solved on them.
///
/// # Errors
/// Fields that are not finite.
pub(super) fn coarse_state(
    solution: &FrictionSolution,
    coarse: &Grid,
) -> error::Result<FrictionSolution> {
    let (normal, fine) = (&solution.normal, solution.grid());
    let mean = |field: &Array2<f64>| means(field, fine, coarse);
    let fields = [mean(&normal.pressure), mean(&normal.gap()), mean(&normal.displacement)];
    let report = Report { grid: *coarse, ..normal.report.clone() };
    Ok(FrictionSolution {
        normal: Solution::from_fields(fields, normal.approach, normal.tilt, report)?,
        friction: coarse_friction(&solution.friction, fine, coarse),
        traction: solution.traction.each_ref().map(mean),
        displacement: solution.displacement.each_ref().map(mean),
        slip: solution.slip.each_ref().map(mean),
        motion: solution.motion,
        report: solution.report.clone(),
        half: None,
    })
}

/// The lengths of coarse cells in fine ones along both axes.
fn ratio(fine: &Grid, coarse: &Grid) -> [usize; 2] {
    let (fine, coarse) = (fine.shape(), coarse.shape());
    [0, 1].map(|axis| if coarse[axis] < fine[axis] { 2 } else { 1 })
}

/// The fine cells within a coarse one.
fn within(cell: [usize; 2], ratio: [usize; 2], shape: [usize; 2]) -> Window {
    [0, 1].map(|k| ratio[k] * cell[k]..(ratio[k] * (cell[k] + 1)).min(shape[k]))
}

/// Tractions with the shares of the bounds that those of `half` have, linear between the centres of its cells in contact;
/// where most of these slip, at the bound.
pub(super) fn refined(
    half: &FrictionSolution,
    fine: &Grid,
    bound: &Array2<f64>,
) -> [Array2<f64>; 2] {
    let ratio = ratio(fine, half.grid());
    let (coarse_bound, sticks) = (half.bound(), half.stick());
    let [rows, columns] = half.grid().shape();
    // The cell around and the nearest one beside it along an axis, and how much they count.
    let around = |at: usize, axis: usize, count: usize| -> Vec<(usize, f64)> {
        if ratio[axis] == 1 {
            return vec![(at, 1.0)];
        }
        let (own, beside) =
            (at / 2, if at.is_multiple_of(2) { (at / 2).checked_sub(1) } else { Some(at / 2 + 1) });
        let mut cells = vec![(own, 0.75)];
        cells.extend(beside.filter(|beside| *beside < count).map(|beside| (beside, 0.25)));
        cells
    };
    let mut traction = [(); 2].map(|()| Array2::zeros(bound.dim()));
    for (i, j) in each_cell(&full_window(fine.shape())).filter(|cell| bound[*cell] > 0.0) {
        let (mut share, mut slips, mut whole) = ([0.0; 2], 0.0, 0.0);
        let mut largest = 0.0_f64;
        for (k, along) in around(i, 0, rows) {
            for (l, across) in around(j, 1, columns) {
                let (cell, weight) = ([k, l], along * across);
                if coarse_bound[cell] > 0.0 {
                    whole += weight;
                    slips += if sticks[cell] { 0.0 } else { weight };
                    let [x, y] = half.traction.each_ref().map(|q| q[cell]);
                    largest = largest.max(x.hypot(y));
                    for (share, q) in share.iter_mut().zip(&half.traction) {
                        *share += weight * q[cell] / coarse_bound[cell];
                    }
                }
            }
        }
        let size = share[0].hypot(share[1]);
        let slips = slips > 0.5 * whole;
        let most = if slips { size } else { whole.max(size) };
        // A sticking cell carries no more than those around it, however large its bound.
        let scale = if slips { bound[[i, j]] } else { bound[[i, j]].min(largest * most / size) };
        if size > 0.0 {
            for (q, share) in traction.iter_mut().zip(share) {
                q[[i, j]] = scale * (share / most);
            }
        }
    }
    traction
}

/// Numbers whose changes tell the error.
struct Numbers {
    force: [f64; 2],
    torque: f64,
    dissipated: f64,
    /// Shift, or creepage in rolling.
    motion: [f64; 2],
    twist: f64,
    stick_share: f64,
}

impl Numbers {
    fn of(solution: &FrictionSolution) -> Self {
        let (motion, twist) = match solution.motion {
            TangentialMotion::Roll { creepage, .. } => (creepage, 0.0),
            TangentialMotion::Slide { shift, twist } => (shift, twist),
        };
        Self {
            force: solution.force(),
            torque: solution.torque(),
            dissipated: solution.dissipated(),
            motion,
            twist,
            stick_share: solution.stick_share(),
        }
    }
}

/// Length of the difference of two vectors.
fn apart(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// A part of a whole, or 0 where there is none.
fn over(amount: f64, whole: f64) -> f64 {
    if whole > 0.0 { amount / whole } else { 0.0 }
}

/// Errors of sliding and of rolling steadily, from the solution on cells of twice the length.
///
/// ```text
/// Δ = max( |ΔF|/μW, |ΔM|/μW c, |ΔD|/max(μW v, D), |Δv|/v )      c = √(ab)
/// ```
///
/// with the half-widths a and b of the contact, what is dissipated D, and the motion v: in rolling |creepage| + |spin| c; in
/// sliding the change of |shift| + |twist| c, over the largest displacement. One number may have the same value on two
/// grids by chance, so that the largest change counts for all, and at least [`CHANCE`]. Where the pressure has a larger
/// relative error, that counts. In rolling D is the work of forces and creepages, and errs as they do. In sliding, quadratic
/// in tractions, it has twice the relative error, or its own change. The border of the stick zone is known to half a cell at
/// best; the square of that, over the width of the slip zone, is an error of D in sliding.
///
/// `freedoms` say which motions and forces are given; what is kept has the error that it had in the solution `before`.
/// Where that is a copy, which knows no cells of twice the length, its errors are added.
///
/// # Errors
/// Why there is no estimate.
pub(super) fn discretisation(
    solution: &FrictionSolution,
    half: &FrictionSolution,
    freedoms: &[Freedom; 3],
    before: Option<&FrictionSolution>,
) -> Result<FrictionDiscretisation, Unestimated> {
    if !half.report.converged() {
        return Err(Unestimated::Unsolved);
    }
    let is_line = solution.grid().is_line();
    let wide = |window: Window| window[1].len() >= LEAST && (is_line || window[0].len() >= LEAST);
    if solution.normal.cells_in_contact().is_some()
        && !half.normal.cells_in_contact().is_some_and(wide)
    {
        return Err(Unestimated::Coarse);
    }
    let [fine, coarse] = [solution, half].map(Numbers::of);
    let [[x0, x1], [y0, y1]] = solution.normal.contact_extent();
    let c = 0.5 * if is_line { y1 - y0 } else { ((x1 - x0) * (y1 - y0)).sqrt() };
    let capacity = solution.bound().sum() * solution.grid().cell_area();
    let dissipated = (fine.dissipated - coarse.dissipated).abs();
    let motion = match solution.motion {
        TangentialMotion::Roll { spin, .. } => {
            fine.motion[0].hypot(fine.motion[1]) + spin.abs() * c
        }
        TangentialMotion::Slide { .. } => {
            let [x, y] = &solution.displacement;
            x.iter().zip(y).fold(0.0_f64, |most, (x, y)| most.max(x.hypot(*y)))
        }
    };
    let changes = [
        over(apart(fine.force, coarse.force), capacity),
        over((fine.torque - coarse.torque).abs(), capacity * c),
        over(dissipated, (capacity * motion).max(fine.dissipated.abs())),
        over(apart(fine.motion, coarse.motion) + (fine.twist - coarse.twist).abs() * c, motion),
    ];
    let pressure = solution.normal.report.discretisation.map_or(0.0, |of| {
        let peak = over(of.peak_pressure.unwrap_or(0.0), solution.normal.peak_pressure());
        peak.max(over(of.load, solution.normal.load()))
    });
    let across = solution.normal.cells_in_contact().map_or(f64::INFINITY, |[rows, columns]| {
        let narrow = if is_line { columns.len() } else { rows.len().min(columns.len()) };
        narrow as f64
    });
    let slides = matches!(solution.motion, TangentialMotion::Slide { .. });
    let chance = CHANCE / across.powf(1.5);
    // The edges of a line contact are no staircases, and [`CHANCE`] is for where they lie in their cells.
    let beyond = if is_line && !slides { 1.0 } else { BEYOND };
    let relative = changes.into_iter().fold(pressure, |most, change| most.max(beyond * change));
    let [relative, of_motion] = [1.0, STEEPNESS].map(|times| relative.max(times * chance));
    let border = border(solution);
    let stick_share = (BEYOND * (fine.stick_share - coarse.stick_share).abs()).max(border);
    let slips = over(border, 1.0 - fine.stick_share).powi(2).min(1.0);
    let is = |freedoms: &[Freedom], kind: fn(&Freedom) -> bool| freedoms.iter().any(kind);
    let loaded = |freedom: &Freedom| matches!(freedom, Freedom::Loaded(_));
    let free = |freedom: &Freedom| !matches!(freedom, Freedom::Loaded(_));
    let (in_plane, about) = freedoms.split_at(2);
    let unless = |given: bool, error: f64| if given { 0.0 } else { error };
    // What one given component leaves to the other may vanish by symmetry.
    let rest = match [loaded(&freedoms[0]), loaded(&freedoms[1])] {
        [true, false] if slides => Some(1),
        [false, true] if slides => Some(0),
        _ => None,
    };
    let force = match rest {
        Some(axis) => {
            let [own, other] = [fine.force[axis], coarse.force[axis]];
            (BEYOND * (own - other).abs()).max(relative * own.abs())
        }
        None => unless(!is(in_plane, free), relative * capacity),
    };
    // Without tractions along a line contact there is no torque.
    let turns = !is_line || [fine.torque, coarse.torque].iter().any(|torque| torque.abs() > 0.0);
    let torque = unless(!turns || !is(about, free), relative * capacity * c);
    let motion_error = unless(!is(in_plane, loaded), of_motion * motion);
    let least = match solution.motion {
        TangentialMotion::Slide { .. } => (2.0 * relative).max(slips) * fine.dissipated.abs(),
        TangentialMotion::Roll { creepage, spin, direction } => {
            // Where the force along a direction is given, the creepage errs alone, else the force.
            let ([x, y], [ex, ey]) = (fine.force, direction.vector());
            let along = [x * ex + y * ey, y * ex - x * ey];
            let works = [0, 1].map(|k| match loaded(&freedoms[k]) {
                true => motion_error * along[k].abs(),
                false => force * creepage[k].abs(),
            });
            works[0] + works[1] + torque * spin.abs()
        }
    };
    let dissipated = (beyond * dissipated).max(least);
    if !slides {
        return Ok(FrictionDiscretisation {
            force,
            torque,
            dissipated,
            creepage: Some(motion_error),
            shift: None,
            twist: None,
            stick_share,
        });
    }
    let is_copy = before.is_some_and(|before| before.half.is_none());
    let stated = before.and_then(|before| before.report.discretisation);
    if is_copy && stated.is_none() {
        return Err(Unestimated::Before);
    }
    let stated = stated.unwrap_or_default();
    let added =
        |error: f64, earlier: f64| if is_copy && error > 0.0 { error + earlier } else { error };
    // What is kept differs between the grids by what it did before.
    let moved = |freedoms: &[Freedom], error: f64, change: f64, earlier: Option<f64>| {
        let earlier = earlier.unwrap_or(0.0);
        match is(freedoms, |freedom| *freedom == Freedom::Kept) {
            true => added(error, earlier).max(earlier).max(BEYOND * change),
            false => added(error, earlier),
        }
    };
    let [turn, turned] = [over(of_motion * motion, c), (fine.twist - coarse.twist).abs()];
    Ok(FrictionDiscretisation {
        force: added(force, stated.force),
        torque: added(torque, stated.torque),
        dissipated,
        creepage: None,
        shift: Some(moved(in_plane, motion_error, apart(fine.motion, coarse.motion), stated.shift)),
        twist: Some(moved(about, unless(!is(about, loaded), turn), turned, stated.twist)),
        stick_share,
    })
}

/// Share of the contact in the halves of the sticking cells that lie beside slipping ones, or in half a cell. In a line
/// contact each border and each edge lies anywhere in its cell and none makes up for others: with ε of them, up to half a
/// cell each, a stick zone with one border has ε₁ − ε₂ cells too many, the contact ε₁ − ε₃, and the share s of the one in the
/// other errs by (1 − s) ε₁ − ε₂ + s ε₃, up to a whole cell.
fn border(solution: &FrictionSolution) -> f64 {
    let (stick, pressure) = (solution.stick(), &solution.normal.pressure);
    let [rows, columns] = solution.grid().shape();
    let slips =
        |i: usize, j: usize| i < rows && j < columns && pressure[[i, j]] > 0.0 && !stick[[i, j]];
    let beside = |(i, j): (usize, usize)| {
        slips(i.wrapping_sub(1), j)
            || slips(i + 1, j)
            || slips(i, j.wrapping_sub(1))
            || slips(i, j + 1)
    };
    let touching = pressure.iter().filter(|p| **p > 0.0).count().max(1);
    let border = stick.indexed_iter().filter(|(cell, stick)| **stick && beside(*cell)).count();
    let part = if solution.grid().is_line() { 1.0 } else { 0.5 };
    part * border.max(1) as f64 / touching as f64
}
