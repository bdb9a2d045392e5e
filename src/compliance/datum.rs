//! The datum of line contacts, with which their operator is positive definite; the method was derived here.

use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::sync::Arc;

use ndarray::Array2;

use crate::compliance::convolution::{Addition, Convolution};
use crate::compliance::response::Body;
use crate::error::{Error, Result};
use crate::model::grid::Grid;
use crate::numerics::linear_cg;
use crate::numerics::parallel::Threads;

/// Factor between data that are tried.
const FARTHER: f64 = 10.0;

/// Number of data that are tried: far more than the stiffest layers need, whose reach is the thickness times
/// the cube root of the ratio of moduli.
const TRIALS: i32 = 15;

/// Residual of the linear system. The error of the sum that is found is its square.
const TOLERANCE: f64 = 1e-6;

/// The datum that line contacts are solved with: where the displacement is 0.
///
/// In plane strain the displacement grows as A/π ln(1/y) with the distance y from the load, where A belongs
/// to the substrates, so that it is counted from that of the bare substrate at a distance, the datum. Users
/// see the datum at the width of the grid ([`Grid::line`]). Below a stiff layer that is wider than the grid
/// the true displacement at this distance is far less: pressures would lift the surface, and the operator
/// would not be positive definite. Such contacts are solved with a farther datum ℓ'. Under a load W this
/// changes no pressure, and displacement and approach by the same A W/π ln(ℓ'/ℓ), which is taken back in the
/// end. The method was derived here.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Datum {
    /// A of both bodies \[1/Pa\], over the period where a grid repeats in one direction; 0 where there is no datum.
    compliance: f64,
    /// ℓ' \[m\].
    distance: f64,
    /// Width ℓ of the grid \[m\].
    width: f64,
    /// Datum from which on the operator is positive definite \[m\]; 0 where that of the grid does.
    least: f64,
    /// Whether a uniform pressure displaces nothing, as on a grid that repeats in both directions on an elastic base: a
    /// prescribed approach is that of the mean plane of the deformed surface.
    pub(crate) floats: bool,
}

/// Mean of coefficients, relative to that of their magnitudes, which is rounding.
const ROUNDING: f64 = 1e-12;

impl Datum {
    /// Finds the datum for the `coefficients` of `bodies` together on `grid`, and what their free ends add.
    ///
    /// # Errors
    /// [`Error::Indefinite`] where the operator is not positive definite with any datum.
    pub(crate) fn find(
        bodies: &[&Body],
        grid: &Grid,
        (coefficients, additions): (&Array2<f64>, &[Addition]),
        threads: &Arc<Threads>,
    ) -> Result<Self> {
        if open_direction(grid).is_none() {
            let magnitude: f64 = coefficients.iter().map(|c| c.abs()).sum();
            let displaced = coefficients.sum().abs() > ROUNDING * magnitude;
            return Ok(Self {
                floats: grid.is_periodic() == [true; 2] && !displaced,
                ..Self::default()
            });
        }
        let compliance = bodies.iter().map(|body| body.asymptotes().long).sum();
        let homogeneous = bodies.iter().all(|body| body.lengths().is_none());
        let homogeneous = homogeneous && additions.is_empty();
        Self::of_compliance(compliance, homogeneous, grid, (coefficients, additions), threads)
    }

    /// The same for one direction of loads, far below which the bodies have the `compliance` A \[1/Pa\] together; there is no
    /// datum on grids without an open direction.
    ///
    /// # Errors
    /// As [`Datum::find`].
    pub(crate) fn of_compliance(
        compliance: f64,
        homogeneous: bool,
        grid: &Grid,
        (coefficients, additions): (&Array2<f64>, &[Addition]),
        threads: &Arc<Threads>,
    ) -> Result<Self> {
        let Some(open) = open_direction(grid) else {
            return Ok(Self::default());
        };
        let (width, period) = (grid.size()[open], grid.size()[1 - open]);
        let period = if grid.is_line() { 1.0 } else { period };
        let near =
            Self { compliance: compliance / period, distance: width, width, ..Self::default() };
        if homogeneous || near.compliance <= 0.0 {
            return Ok(near);
        }
        for trial in 0..TRIALS {
            let datum = Self { distance: width * FARTHER.powi(trial), ..near };
            let moved = datum.moved(coefficients.clone(), grid);
            let total = total_pressure((&moved, additions), grid, threads)?;
            let Some(total) = total.filter(|&total| total > 0.0) else {
                continue;
            };
            if trial == 0 {
                return Ok(near);
            }
            // K − s 1ᵀ1 is positive definite as long as s 1ᵀK⁻¹1 < 1.
            let nearer = PI / (near.compliance * grid.cell_area() * total);
            return Ok(Self {
                distance: FARTHER * datum.distance,
                least: datum.distance * (-nearer).exp(),
                ..near
            });
        }
        Err(Error::Indefinite)
    }

    /// Coefficients on `grid`, whose datum is its own width, with this datum.
    pub(crate) fn moved(&self, mut coefficients: Array2<f64>, grid: &Grid) -> Array2<f64> {
        if let Some(open) = open_direction(grid)
            && self.compliance > 0.0
        {
            let width = grid.size()[open];
            coefficients += self.compliance * grid.cell_area() / PI * (self.distance / width).ln();
        }
        coefficients
    }

    /// Displacement per load per length \[m²/N\] by which this datum raises displacement and approach.
    pub(crate) fn raise(&self) -> f64 {
        if self.compliance > 0.0 {
            self.compliance / PI * (self.distance / self.width).ln()
        } else {
            0.0
        }
    }

    /// An error where an `approach` cannot be prescribed to a shape with these gaps, less the approach.
    ///
    /// # Errors
    /// [`Error::FullContact`] where the mean of the gaps, which no pressure changes, would be 0 or less.
    pub(crate) fn check_gap(&self, approach: f64, gap: &Array2<f64>) -> Result<()> {
        let mean = gap.sum() / gap.len() as f64;
        match self.floats && mean <= 0.0 {
            true => Err(Error::FullContact { approach, most: approach + mean }),
            false => Ok(()),
        }
    }

    /// An error where an approach cannot be prescribed.
    ///
    /// # Errors
    /// [`Error::Datum`] where the operator is not positive definite with the datum of the grid.
    pub(crate) fn check_approach(&self) -> Result<()> {
        let error = |[width, needed]: [f64; 2]| Err(Error::Datum { width, needed });
        self.widths().map_or(Ok(()), error)
    }

    /// An error where the `motion` along the surface, a shift or a creepage, cannot be prescribed.
    ///
    /// # Errors
    /// [`Error::TangentialDatum`] as [`Datum::check_approach`].
    pub(crate) fn check_motion(&self, motion: &'static str) -> Result<()> {
        let error =
            |[width, needed]: [f64; 2]| Err(Error::TangentialDatum { motion, width, needed });
        self.widths().map_or(Ok(()), error)
    }

    /// Width of the grid and the one that is needed, where it is wider. The wider the grid, the farther its datum must lie,
    /// by a quarter of the width at last.
    fn widths(&self) -> Option<[f64; 2]> {
        (self.least > 0.0).then_some([self.width, 2.0 * self.least])
    }
}

/// The direction across a line contact, or the open one of a grid that repeats along the other.
fn open_direction(grid: &Grid) -> Option<usize> {
    match grid.is_periodic() {
        _ if grid.is_line() => Some(1),
        [true, false] => Some(1),
        [false, true] => Some(0),
        _ => None,
    }
}

/// Sum of the pressure that displaces all cells by 1 \[1/m\], 1ᵀK⁻¹1. It is above 0 where K, which is
/// positive definite for pressures of sum 0, is so for all; `None` where the system shows that it is not.
///
/// Rows beyond a free end, which carry no pressure, are left out: the mirror image acts between the others alone, and
/// with rows beyond, the sum of both is not positive definite below stiff layers that are thick compared with the grid.
fn total_pressure(
    (coefficients, additions): (&Array2<f64>, &[Addition]),
    grid: &Grid,
    threads: &Arc<Threads>,
) -> Result<Option<f64>> {
    let repeats = grid.is_periodic();
    let convolution = Convolution::plan_repeated(coefficients, repeats, Arc::clone(threads))?;
    let convolution = convolution.plus(additions.to_vec());
    let inverse = convolution.approximation(coefficients, repeats).inverse;
    let [mut first, mut second] = [convolution.workspace(), convolution.workspace()];
    let [rows, columns] = grid.shape();
    let beyond: Vec<usize> =
        (0..rows).filter(|row| !additions.iter().all(|ends| ends.has(*row))).collect();
    let leave_out = |values: &mut [f64]| {
        beyond.iter().for_each(|row| values[row * columns..(row + 1) * columns].fill(0.0));
    };
    let mut uniform = vec![1.0; coefficients.len()];
    leave_out(&mut uniform);
    let pressure = linear_cg::solve(
        &uniform,
        |input, out| {
            convolution.apply_slices(input, out, &mut first);
            leave_out(out);
        },
        |input, out| {
            inverse.apply_slices(input, out, &mut second);
            leave_out(out);
        },
        TOLERANCE,
        &mut || ControlFlow::Continue(()),
    );
    Ok(pressure.ok().map(|pressure| pressure.iter().sum()))
}
