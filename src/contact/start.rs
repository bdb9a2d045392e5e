//! The start of a solve: the gaps of a shape, and a pressure.

use std::sync::{Arc, Weak};

use ndarray::{Array2, ArrayRef2};

use crate::contact::problem::{Problem, array};
use crate::error::{Error, Result, none_negative, refuse_if, same_shape};
use crate::model::grid::Grid;
use crate::model::surface::{Extent, Surface};
use crate::numerics::layout::slice_mut;
use crate::numerics::parallel::{ONE, Rows, all, sum};

/// Gaps of the shape that was sampled last on one grid, kept while a solution has them.
#[derive(Default)]
pub(super) struct Sampled<'a>(Option<(&'a dyn Surface, Weak<Array2<f64>>)>);

impl<'a> Sampled<'a> {
    /// The gaps of `shape`; `sample` computes them where another shape was sampled last.
    pub(super) fn gaps(
        &mut self,
        shape: &'a dyn Surface,
        sample: impl FnOnce() -> Result<Array2<f64>>,
    ) -> Result<Arc<Array2<f64>>> {
        if let Some((known, gaps)) = &self.0
            && std::ptr::eq(*known, shape)
            && let Some(gaps) = gaps.upgrade()
        {
            return Ok(gaps);
        }
        let gaps = Arc::new(sample()?);
        self.0 = Some((shape, Arc::downgrade(&gaps)));
        Ok(gaps)
    }
}

/// Gaps of `shape` on `grid`, finite or +∞.
pub(super) fn checked_gaps(shape: &dyn Surface, grid: &Grid, rows: &Rows) -> Result<Array2<f64>> {
    let mut gaps = shape.gaps(grid)?;
    same_shape("shape", &gaps, grid.shape())?;
    let (values, lowest) = (&*slice_mut(&mut gaps), f64::NEG_INFINITY);
    let [good] =
        rows.each([values], [], |_, gaps, []| sum(gaps, |[h]| [h.simd_gt(all(lowest)) & ONE]));
    // Counts of cells are exact in f64.
    if good < values.len() as f64 {
        let columns = grid.shape()[1];
        let bad = |h: &f64| h.is_nan() || *h <= lowest;
        let cell = values.iter().position(bad).unwrap_or(0);
        return Err(Error::NonFinite { name: "shape", index: [cell / columns, cell % columns] });
    }
    Ok(gaps)
}

/// An error where `shape` is flat, or along the line of a line contact, and the grid does not repeat: every cell of the
/// grid touches, however large it is.
pub(super) fn check_curved(shape: &dyn Surface, grid: &Grid) -> Result<()> {
    let axes = usize::from(grid.is_line())..2;
    let is_flat = axes.clone().all(|axis| shape.extent()[axis] == Extent::Endless);
    let repeats = axes.clone().all(|axis| grid.is_periodic()[axis]);
    refuse_if(
        is_flat && !repeats,
        "shape must be curved across the contact: a flat one without end touches the whole grid, however large it is",
    )
}

/// An error where `shape` repeats along an axis and `grid` does not as it does, or where its gap jumps at the seam of a
/// grid that repeats. A line contact extends along x.
///
/// # Errors
/// [`Error::Period`], [`Error::Seam`].
pub(super) fn check_seam(shape: &dyn Surface, grid: &Grid) -> Result<()> {
    let (center, size) = (grid.center(), grid.size());
    for (axis, extent) in shape.extent().iter().enumerate() {
        if axis == 1 || !grid.is_line() {
            extent.check_period(axis, grid.periods()[axis])?;
        }
    }
    for axis in (0..2).filter(|&axis| grid.is_periodic()[axis]) {
        let ends = [-0.5, 0.5].map(|half| center[axis] + half * size[axis]);
        for across in grid.coordinates(1 - axis) {
            let at = |along: f64| match axis {
                0 => shape.gap(along, across),
                _ => shape.gap(across, along),
            };
            let [low, high] = ends.map(at);
            let middle = at(center[axis]);
            let range = [low, high, middle].map(|h| if h.is_finite() { h.abs() } else { 0.0 });
            let most = range.into_iter().fold(0.0, f64::max);
            // NaN where neither end can touch.
            if (low - high).abs() > 1e-6 * most {
                return Err(Error::Seam { axis: ["x", "y"][axis], gaps: [low, high] });
            }
        }
    }
    Ok(())
}

/// The pressure that the caller gave to start from, balanced; `None` where it cannot carry the load.
pub(super) fn initial_pressure(
    problem: &Problem,
    initial: Option<&ArrayRef2<f64>>,
) -> Result<Option<Array2<f64>>> {
    let Some(initial) = initial else {
        return Ok(None);
    };
    let shape = problem.convolution.shape();
    same_shape("initial", initial, shape)?;
    none_negative("initial", initial)?;
    let cells = initial.iter().zip(problem.gap);
    let mut p: Vec<f64> = cells.map(|(&p, h)| if h.is_finite() { p } else { 0.0 }).collect();
    let balanced = problem.freedoms.balance(&mut p, problem.bounds);
    Ok(balanced.then(|| array(shape, p)))
}

/// A balanced pressure on all cells that can touch.
pub(super) fn uniform_pressure(problem: &Problem) -> Result<Array2<f64>> {
    let shape = problem.convolution.shape();
    let mut p = vec![0.0; problem.gap.len()];
    if problem.freedoms.balance(&mut p, problem.bounds) {
        return Ok(array(shape, p));
    }
    let uniform = problem.freedoms.typical_pressure(p.len());
    for (p, h) in p.iter_mut().zip(problem.gap) {
        *p = if h.is_finite() { uniform } else { 0.0 };
    }
    let balanced = match problem.bounds.is_limited() {
        true => problem.press_springs(&mut p, problem.gap),
        false => problem.freedoms.balance(&mut p, problem.bounds),
    };
    if balanced {
        return Ok(array(shape, p));
    }
    Err(Error::Inconsistent(
        "eccentricity or moment is too near the rim of the cells that can touch",
    ))
}

/// A balanced pressure up to the hardness near an elastic solution of this `pressure` and gap `g`.
///
/// # Errors
/// Eccentricity or moment that no pressure up to the hardness has.
pub(super) fn yielding_pressure(
    problem: &Problem,
    pressure: &[f64],
    g: &[f64],
) -> Result<Array2<f64>> {
    let mut p = pressure.to_vec();
    if !problem.freedoms.any_loaded() {
        (p.iter_mut().enumerate()).for_each(|(k, p)| *p = problem.bounds.nearest(k, *p));
    } else if !problem.press_springs(&mut p, g) {
        return Err(Error::Inconsistent(
            "no pressure up to the hardness has this eccentricity or moment: give a larger hardness or a smaller load",
        ));
    }
    Ok(array(problem.convolution.shape(), p))
}
