//! Everything about a stress field that depends on the body, the grid and the pressure alone.

use std::ops::ControlFlow;

use ndarray::{Array1, ArrayRef2};

use super::repeats::Repeats;
use crate::compliance::kernel::COMPONENTS;
use crate::compliance::kernel::loads;
use crate::compliance::kernel::plans::Kernels;
use crate::compliance::response::interior::Place;
use crate::error::{Error, Result};
use crate::model::body::{HalfSpace, Substrate};
use crate::model::grid::{Grid, Window};
use crate::numerics::fft::{PaddedTransform, QuarterTransform, Transformed};
use crate::numerics::parallel::{Threads, check_memory};
use crate::stress::friction::Sliding;
use crate::stress::options::StressProgress;
use crate::stress::subcell::{Pair, SubcellStress};

/// Stress of the body that goes on along x and y, planned once and evaluated any number of times.
#[derive(Debug)]
pub(in crate::stress) struct HalfSpacePlan {
    pub(in crate::stress) body: HalfSpace,
    pub(in crate::stress) grid: Grid,
    pub(in crate::stress) sliding: Sliding,
    /// Half the width of the loaded cells along their shorter side \[m\].
    pub(in crate::stress) half_width: f64,
    pub(in crate::stress) kernels: Kernels,
    /// Present where the grid repeats.
    pub(in crate::stress) repeats: Option<Repeats>,
    /// Number of offsets along x and y between a loaded cell and any other.
    pub(in crate::stress) offsets: [usize; 2],
    /// The pressure \[Pa\], in C order.
    pub(in crate::stress) pressure: Vec<f64>,
    pub(in crate::stress) transform: PaddedTransform,
    pub(in crate::stress) quarter: QuarterTransform,
    /// Transform of the pressure that is taken as uniform over cells for stresses.
    pub(in crate::stress) uniform: Transformed,
    /// Present where the pressure is reconstructed within cells.
    pub(in crate::stress) solved: Option<Solved>,
    pub(in crate::stress) threads: Threads,
}

/// Additional parts of a solved contact's plan.
#[derive(Debug)]
pub(in crate::stress) struct Solved {
    pub(in crate::stress) subcell: SubcellStress,
    /// Transform of the solver's pressure, whose convolution gives displacements.
    pub(in crate::stress) given: Transformed,
}

/// Distribution of the pressure over a cell.
pub(in crate::stress) enum Form<'a> {
    /// Uniform over each cell.
    Uniform,
    /// Reconstructed within cells, from the pressure of a solved contact of these bodies.
    Solved(Pair<'a>),
}

/// The pressure that a plan is made for, and the body below it.
pub(in crate::stress) struct Source<'a> {
    pub(in crate::stress) body: &'a HalfSpace,
    pub(in crate::stress) grid: &'a Grid,
    pub(in crate::stress) pressure: &'a ArrayRef2<f64>,
    pub(in crate::stress) form: Form<'a>,
    pub(in crate::stress) sliding: Sliding,
    /// Tractions along x and y on the body itself, where they are known.
    pub(in crate::stress) tractions: Option<[&'a ArrayRef2<f64>; 2]>,
}

impl<'a> Source<'a> {
    /// A pressure that is uniform over each cell, and whose shape is not known.
    pub(in crate::stress) fn uniform(
        body: &'a HalfSpace,
        grid: &'a Grid,
        pressure: &'a ArrayRef2<f64>,
    ) -> Self {
        Self {
            body,
            grid,
            pressure,
            form: Form::Uniform,
            sliding: Sliding {
                sign: 1.0,
                direction: grid.rolling_direction(),
                is_known: false,
            },
            tractions: None,
        }
    }

    /// Bytes that planning takes.
    pub(in crate::stress) fn memory(&self) -> u64 {
        // The transform of the pressure and its rows, counted as 8 arrays of cells; the reconstruction
        // and the transform of the solver's pressure, as 24.
        let arrays = 8 + if matches!(self.form, Form::Uniform) {
            0
        } else {
            24
        };
        // The coefficients of a component, at all offsets.
        let repeated = if self.grid.is_periodic() == [false; 2] {
            0
        } else {
            2 * COMPONENTS as u64
        };
        transforms_memory(self.grid, arrays + repeated)
    }

    /// The plan, without a callback.
    pub(in crate::stress) fn plan_unwatched(
        &self,
        threads: Option<usize>,
    ) -> Result<HalfSpacePlan> {
        let mut progress = |_| ControlFlow::Continue(());
        let stopped = Error::Inconsistent("the stress plan was stopped before it was complete");
        self.plan(threads, &mut progress)?.ok_or(stopped)
    }

    /// The plan; none where `progress` stops it. `progress` is asked, with 0, while the pressure is
    /// reconstructed within cells; the rest is quick.
    pub(in crate::stress) fn plan(
        &self,
        threads: Option<usize>,
        progress: &mut StressProgress,
    ) -> Result<Option<HalfSpacePlan>> {
        let Self { body, grid, .. } = *self;
        check_magnitudes(body, grid)?;
        let pressure = checked(grid, self.pressure)?;
        check_memory(grid.shape(), self.memory())?;
        let threads = Threads::new(threads)?;
        let subcell = match &self.form {
            Form::Uniform => None,
            Form::Solved(pair) => {
                match SubcellStress::plan((body, pair), grid, &pressure, &threads, progress) {
                    ControlFlow::Continue(subcell) => Some(subcell),
                    ControlFlow::Break(()) => return Ok(None),
                }
            }
        };
        let [lx, ly] = grid.size();
        let repeats = threads.run(|| Repeats::plan(body, grid));
        // One per cent more than the diagonal, for rounding.
        let reach = (repeats.as_ref()).map_or(1.01 * lx.hypot(ly), Repeats::reach);
        let kernels = threads.run(|| Kernels::new::<6, loads::Pressure>(body, grid, 1.0, reach));
        let uniform = subcell.as_ref().map_or(&*pressure, SubcellStress::uniform);
        let offsets = offsets(grid.shape(), [&pressure, uniform]);
        let transform = PaddedTransform::plan_even(grid.shape(), offsets, &threads);
        let transformed =
            |input: &[f64]| transform.transform(input, &mut transform.workspace(), &threads);
        let uniform = transformed(uniform);
        let solved = subcell.map(|subcell| Solved {
            subcell,
            given: transformed(&pressure),
        });
        Ok(Some(HalfSpacePlan {
            body: body.clone(),
            grid: *grid,
            sliding: self.sliding,
            half_width: half_width(grid, &pressure),
            kernels,
            repeats,
            offsets,
            quarter: transform.quarter_transform(),
            pressure,
            transform,
            uniform,
            solved,
            threads,
        }))
    }
}

impl HalfSpacePlan {
    /// Estimated errors \[Pa\] of the stress at `places` in the cells of `window`, from the size of the cells;
    /// none where the pressure is given as uniform over them.
    pub(in crate::stress) fn uncertainties(
        &self,
        places: &[Place],
        friction: [f64; 2],
        window: &Window,
    ) -> Option<Array1<f64>> {
        let subcell = &self.solved.as_ref()?.subcell;
        let steps = subcell.steps(window);
        let error = |place: &Place| subcell.uncertainty(&self.body, place, friction, steps);
        Some(places.iter().map(error).collect())
    }

    /// Pressure that is taken as uniform over cells for stresses.
    pub(in crate::stress) fn stress_pressure(&self) -> &[f64] {
        let solved = self.solved.as_ref();
        solved.map_or(&self.pressure, |solved| solved.subcell.uniform())
    }
}

/// Smallest and largest length and modulus, in whatever units: kernels take fifth powers of lengths and
/// fourth powers of moduli, which neither overflow nor vanish between these.
pub(in crate::stress) const MAGNITUDES: [f64; 2] = [1e-60, 1e60];

/// Refuses lengths and moduli outside of [`MAGNITUDES`].
fn check_magnitudes(body: &HalfSpace, grid: &Grid) -> Result<()> {
    let check = |name, value: f64| match (MAGNITUDES[0]..=MAGNITUDES[1]).contains(&value) {
        true => Ok(()),
        false => Err(Error::Parameter {
            name,
            requirement: "between 1e-60 and 1e60 for stresses (take other units)",
            value,
        }),
    };
    for axis in 0..2 {
        check("size of the grid", grid.size()[axis])?;
        check("spacing of the grid", grid.spacing()[axis])?;
    }
    for layer in body.layers() {
        check("thickness", layer.thickness())?;
        check("young", layer.material().young())?;
    }
    match body.substrate() {
        Substrate::Elastic(material) => check("young", material.young()),
        Substrate::Rigid => Ok(()),
    }
}

/// Bytes of `arrays` arrays of cells as transforms keep them. Transforms store whole blocks of
/// columns, at lengths that are products of small primes: together a fifth more than the cells.
pub(in crate::stress) fn transforms_memory(grid: &Grid, arrays: u64) -> u64 {
    let [nx, ny] = grid.shape().map(|n| n as u64);
    (nx + 1) * (ny + 8) * 8 * arrays * 6 / 5
}

/// `pressure` in C order, if it is finite and of the grid's shape.
fn checked(grid: &Grid, pressure: &ArrayRef2<f64>) -> Result<Vec<f64>> {
    let found = [pressure.nrows(), pressure.ncols()];
    if found != grid.shape() {
        return Err(Error::Shape {
            name: "pressure",
            expected: grid.shape(),
            found,
        });
    }
    if let Some((index, _)) = pressure.indexed_iter().find(|(_, p)| !p.is_finite()) {
        return Err(Error::NonFinite {
            name: "pressure",
            index: [index.0, index.1],
        });
    }
    Ok(pressure.iter().copied().collect())
}

/// First and last row, then first and last column, of the cells that any of `pressures` loads; none
/// where all are zero.
pub(in crate::stress) fn loaded_cells(
    shape: [usize; 2],
    pressures: &[&[f64]],
) -> Option<[[usize; 2]; 2]> {
    let mut ends = [[usize::MAX, 0]; 2];
    for pressure in pressures {
        for (k, _) in pressure.iter().enumerate().filter(|(_, p)| **p != 0.0) {
            for (end, at) in ends.iter_mut().zip([k / shape[1], k % shape[1]]) {
                *end = [end[0].min(at), end[1].max(at)];
            }
        }
    }
    (ends[0][0] <= ends[0][1]).then_some(ends)
}

/// How many offsets along x and y, 0 included, lie between a cell and one that any of `pressures` loads.
fn offsets(shape: [usize; 2], pressures: [&[f64]; 2]) -> [usize; 2] {
    let Some(ends) = loaded_cells(shape, &pressures) else {
        return shape;
    };
    // From the first loaded cell to the last cell, from the first cell to the last loaded one.
    [0, 1].map(|axis| {
        let [first, last] = ends[axis];
        (shape[axis] - first).max(last + 1)
    })
}

/// Half the width of the cells with a `pressure` along their shorter side; of the whole grid if there are none. Along
/// directions that repeat, which have no first cell, the lines with a pressure count.
fn half_width(grid: &Grid, pressure: &[f64]) -> f64 {
    let [nx, ny] = grid.shape();
    let loaded = loaded_cells([nx, ny], &[pressure]);
    let lines = |axis: usize| -> usize {
        let touches = |line: &usize| match axis {
            0 => (0..ny).any(|j| pressure[line * ny + j] != 0.0),
            _ => (0..nx).any(|i| pressure[i * ny + line] != 0.0),
        };
        (0..[nx, ny][axis]).filter(touches).count()
    };
    let width = |axis: usize| {
        let cells = match loaded {
            None => grid.shape()[axis],
            Some(_) if grid.is_periodic()[axis] => lines(axis),
            Some(ends) => ends[axis][1] - ends[axis][0] + 1,
        };
        0.5 * cells as f64 * grid.spacing()[axis]
    };
    if grid.is_line() {
        width(1)
    } else {
        width(0).min(width(1))
    }
}
