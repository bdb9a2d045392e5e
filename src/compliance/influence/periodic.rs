//! Influence coefficients of grids that repeat: sums over images ([`crate::compliance::images`]), or waves.
//!
//! The mean of the coefficients is û/p̂(0) under a pressure everywhere on a rigid base, and taken as 0 on an elastic one
//! and on a plate with a free base; where one direction is open, it is that of the line contact.
//!
//! Sums over the images of a plate with a free base diverge. It is the same plate on a rigid base, and waves of the
//! difference, which falls as e^{−2αH} with the thickness H of the plate: derived here.

use std::any::Any;
use std::f64::consts::PI;

use ndarray::{Array2, Axis, Zip};

use super::exact::{CellInfluence, WHOLE_CELLS, strip_coefficients, strips_apart};
use crate::compliance::images::CellImages;
use crate::compliance::response::{Response, ResponseSlope, is_free};
use crate::error::{Error, Result, require};
use crate::model::body::{HalfSpace, Substrate};
use crate::model::grid::Grid;
use crate::numerics::fft::inverse_even;
use crate::numerics::parallel::Threads;
use crate::numerics::rounding::cells_within;

/// Distance of the end of the sums, in longest lengths of what is summed: 1e-10 of the coefficient of the loaded cell is
/// left.
const RINGS: f64 = 16.0;

/// Distance of the offsets from the corners of a block, in its shorter sides, at least.
const NEAREST: f64 = 1e-3;

/// Sums over the images of a cell at `offsets` along x and the offsets of the cells along y that are computed, up to
/// constants.
fn sums(
    body: &dyn Response,
    images: &CellImages,
    spacing: [f64; 2],
    offsets: &[f64],
    threads: &Threads,
) -> Result<Array2<f64>> {
    let cell = CellInfluence::plan_on(body, spacing, WHOLE_CELLS, images.reach(), threads)?;
    let (sides, reach) = (images.block_sides(), images.block_reach());
    let block = CellInfluence::plan_on(body, sides, NEAREST, reach, threads)?;
    let mut sums = Array2::zeros((offsets.len(), images.kept()[1]));
    threads.run(|| {
        let far = images.far(|at| [cell.at_distance(at)], |at| [block.at_distance(at)]);
        Zip::indexed(&mut sums).and(&far[0]).par_for_each(|(i, j), sum, far| {
            let at = [offsets[i], j as f64 * spacing[1]];
            *sum = *far;
            for k in images.near(0) {
                for l in images.near(1) {
                    *sum += cell.at_distance(images.place(at, [k, l]));
                }
            }
        });
    });
    Ok(sums)
}

/// Coefficients \[m/Pa\] on a `grid` that repeats along y alone, at any `offsets` along x of at least a cell, with the
/// datum at a distance: (offsets, ny/2 + 1).
pub(super) fn apart(
    body: &dyn Response,
    grid: &Grid,
    (offsets, datum): (&[f64], f64),
    threads: &Threads,
) -> Result<Array2<f64>> {
    let (spacing, [_, ny]) = (grid.spacing(), grid.shape());
    let farthest = offsets.iter().fold(0.0_f64, |most, x| most.max(*x));
    let rows = cells_within(farthest, spacing[0]) + 1;
    let longer = Grid::new([rows, ny], [rows as f64 * spacing[0], grid.size()[1]])?;
    let images = CellImages::plan(&longer.periodic(grid.is_periodic())?, RINGS).at_offsets(offsets);
    let mut sums = sums(body, &images, spacing, offsets, threads)?;
    let uniform = strips_apart(body, (spacing[0], datum), offsets, threads)?;
    for (mut line, uniform) in sums.axis_iter_mut(Axis(0)).zip(uniform) {
        let total: f64 = (0..ny).map(|l| line[l.min(ny - l)]).sum();
        line += (uniform - total) / ny as f64;
    }
    Ok(sums)
}

/// Coefficients (nx, ny) \[m/Pa\] without the local compliance; C\[n − i\] = C\[i\] along periodic directions.
pub(super) fn coefficients(
    body: &dyn Response,
    grid: &Grid,
    threads: &Threads,
) -> Result<Array2<f64>> {
    if let (true, Some(plate)) = (is_free(body), body.half_space()) {
        return of_plate(body, plate, grid, threads);
    }
    let (spacing, size) = (grid.spacing(), grid.size());
    let images = CellImages::plan(grid, RINGS);
    let rows = (0..images.kept()[0]).map(|i| i as f64 * spacing[0]);
    let sums = sums(body, &images, spacing, &rows.collect::<Vec<_>>(), threads)?;
    let mut whole = images.whole(&sums, [false; 2]);
    let mean = if grid.is_periodic() == [true; 2] {
        vec![uniform(body)]
    } else {
        let open = usize::from(grid.is_periodic()[0]);
        let strips = Grid::line(grid.shape()[open], size[open])?;
        strip_coefficients(body, &strips, threads)?.iter().copied().collect()
    };
    images.with_mean(&mut whole, &mean);
    Ok(whole)
}

/// Coefficients of a plate with a free base, or of its derivative with respect to a number.
fn of_plate(
    body: &dyn Response,
    plate: &HalfSpace,
    grid: &Grid,
    threads: &Threads,
) -> Result<Array2<f64>> {
    let rigid_base = plate.with_rigid_base();
    let rigid_base: Box<dyn Response> = match (body as &dyn Any).downcast_ref::<ResponseSlope>() {
        Some(slope) => Box::new(slope.of(&rigid_base)),
        None => Box::new(rigid_base),
    };
    let waves = PlateWaves::new(plate, grid)?;
    let difference = |k: usize, l: usize| match (k, l) {
        (0, 0) => -uniform(&*rigid_base),
        _ => waves.sum([k, l], |[m, n]| {
            let alpha = m.hypot(n);
            [(body.normal(alpha) - rigid_base.normal(alpha)) / alpha]
        })[0],
    };
    let difference = inverse_even(grid.shape(), grid.shape(), difference, threads);
    Ok(coefficients(&*rigid_base, grid, threads)? + difference)
}

/// Waves of loads that are uniform over the cells of a grid that repeats along x and along y, on a plate with a free
/// base: those that look alike at the centres of the cells are summed.
#[derive(Debug)]
pub(crate) struct PlateWaves {
    shape: [usize; 2],
    spacing: [f64; 2],
    /// Largest wavenumber that is summed.
    highest: f64,
}

/// Sides of cells, in thicknesses of the plate, up to which waves are summed: 3200 alias each other then.
const WIDEST_CELL: f64 = 4.0;

/// αH beyond which a free base is not seen: e^{−44} is below rounding.
const UNSEEN: f64 = 44.0;

impl PlateWaves {
    /// # Errors
    /// Where cells are much wider than the plate is thick.
    pub(crate) fn new(plate: &HalfSpace, grid: &Grid) -> Result<Self> {
        let spacing = grid.spacing();
        let widest = spacing[0].max(spacing[1]);
        let requirement =
            "at most 4 times the thickness of the plate with a free base: take more cells";
        let fine = widest <= WIDEST_CELL * plate.thickness();
        require("spacing of the grid", widest, fine, requirement)?;
        Ok(Self { shape: grid.shape(), spacing, highest: UNSEEN / plate.thickness() })
    }

    /// Sums of `response` at the wave vectors (m, n) that look like wave (k, l), times the transforms of a cell.
    pub(crate) fn sum<const N: usize>(
        &self,
        waves: [usize; 2],
        response: impl Fn([f64; 2]) -> [f64; N],
    ) -> [f64; N] {
        let [along, across] = [0, 1].map(|axis| self.aliases(axis, waves[axis]));
        let mut sum = [0.0; N];
        for (m, weight_m) in &along {
            for (n, weight_n) in &across {
                if m.hypot(*n) < self.highest {
                    let values = response([*m, *n]);
                    let pairs = sum.iter_mut().zip(values);
                    pairs.for_each(|(sum, value)| *sum += weight_m * weight_n * value);
                }
            }
        }
        sum
    }

    /// Wavenumbers that look like that of a wave, and the mean of the wave over a cell; both have signs.
    ///
    /// ```text
    /// q = 2π (k/N + a)/dx      sin(q dx/2) / (q dx/2)      a = …, −1, 0, 1, …
    /// ```
    fn aliases(&self, axis: usize, wave: usize) -> Vec<(f64, f64)> {
        if wave == 0 {
            return vec![(0.0, 1.0)];
        }
        let turns = wave as f64 / self.shape[axis] as f64;
        let step = 2.0 * PI / self.spacing[axis];
        let last = (self.highest / step).ceil() as i64 + 1;
        let alias = |a: i64| {
            let number = turns + a as f64;
            (step * number, (PI * number).sin() / (PI * number))
        };
        (-last..=last).map(alias).filter(|(q, _)| q.abs() < self.highest).collect()
    }
}

/// Coefficients with which waves of the grid are displaced by û/p̂ at their wave number.
///
/// # Errors
/// Unless both directions are periodic.
pub(super) fn sampled(body: &dyn Response, grid: &Grid, threads: &Threads) -> Result<Array2<f64>> {
    if grid.is_periodic() != [true; 2] {
        return Err(Error::Inconsistent(
            "method \"spectral\" needs a grid that is periodic along x and along y",
        ));
    }
    let step = grid.size().map(|length| 2.0 * PI / length);
    let response = |k: usize, l: usize| {
        let alpha = (k as f64 * step[0]).hypot(l as f64 * step[1]);
        match alpha > 0.0 {
            true => body.normal(alpha) / alpha,
            false => uniform(body),
        }
    };
    Ok(inverse_even(grid.shape(), grid.shape(), response, threads))
}

/// Displacement under a unit pressure everywhere, on a rigid base; 0 on an elastic one, without the local compliance.
fn uniform(body: &dyn Response) -> f64 {
    let limits = body.asymptotes();
    // A derivative of the response of layers has limits of either sign.
    let elastic =
        body.half_space().map_or(limits.long > 0.0, |body| body.substrate() != Substrate::Rigid);
    match elastic {
        true => 0.0,
        false => limits.constant,
    }
}
