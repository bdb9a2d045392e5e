//! A body under pressure and friction: one component on one plane is one convolution.

use std::ops::Range;

use ndarray::ArrayRef2;

use super::StressOptions;
use super::friction::friction;
use super::subcell::Within;
use super::subcell::{NearTable, STRESSES};
use crate::body::HalfSpace;
use crate::error::{Error, Result};
use crate::fft::{Keep, KernelRows, PaddedTransform, QuarterTransform, Transformed, Workspace};
use crate::grid::Grid;
use crate::kernel::cells::Source;
use crate::kernel::loads::{
    self, COMPONENTS, EXCHANGED, Load, ODD, PressureStress, TractionStress,
};
use crate::kernel::plane::{Kernel, Plan};
use crate::kernel::plans::Kernels;
use crate::kernel::strip::{self, LinePlan};
use crate::parallel::Threads;
use crate::response::interior::Place;

/// Components that are convolved together: the more, the less often the load is read; the fewer, the
/// less memory is written and read in between.
const TOGETHER: usize = 3;

// Stresses and displacements are of different pressures: no three are of both.
const _: () = assert!(STRESSES.is_multiple_of(TOGETHER));

/// How pressure is distributed over a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    /// It is uniform.
    Uniform,
    /// It is that of a solved contact.
    Solved,
}

/// A body under a load, of which planes are evaluated.
#[derive(Debug)]
pub(super) struct Loaded {
    spacing: [f64; 2],
    kind: Kernels,
    displacement: bool,
    /// μ times the unit vector of the traction.
    friction: [f64; 2],
    /// How many offsets along x and y there are from a loaded cell.
    offsets: [usize; 2],
    transform: PaddedTransform,
    quarter: QuarterTransform,
    pressure: Transformed,
    /// Where pressure is not uniform over cells, and the transform of the cells' pressure, of which
    /// displacements are; stresses are the convolution of [`Loaded::pressure`].
    within: Option<(Within, Transformed)>,
    threads: Threads,
}

/// Memory that all depths use.
#[derive(Debug)]
pub(super) struct Scratch {
    loads: Vec<LoadRows>,
    workspace: Workspace,
    near: NearTable,
}

/// Coefficients of one load at one depth.
#[derive(Debug)]
struct LoadRows {
    factor: f64,
    /// The axis along which it acts, and of which it turns the parities; none for pressure.
    axis: Option<usize>,
    rows: KernelRows,
}

/// Whether each component is odd in x and in y, under a load along `axis`.
fn odd(axis: Option<usize>) -> [[bool; 2]; COMPONENTS] {
    ODD.map(|odd| [0, 1].map(|along| odd[along] != (axis == Some(along))))
}

impl Loaded {
    /// None where `go_on` stops it, which is asked many times where pressure is of a solved contact.
    pub(super) fn new(
        body: &HalfSpace,
        grid: &Grid,
        pressure: &ArrayRef2<f64>,
        form: Form,
        options: &StressOptions,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Option<Self>> {
        let shape = grid.shape();
        let found = [pressure.nrows(), pressure.ncols()];
        if found != shape {
            return Err(Error::Shape {
                name: "pressure",
                expected: shape,
                found,
            });
        }
        if let Some((index, _)) = pressure.indexed_iter().find(|(_, p)| !p.is_finite()) {
            return Err(Error::NonFinite {
                name: "pressure",
                index: [index.0, index.1],
            });
        }
        let friction = friction(body, options)?;
        let threads = Threads::new(options.threads)?;
        let input: Vec<f64> = pressure.iter().copied().collect();
        let within = match form {
            Form::Uniform => None,
            Form::Solved => match Within::new(body, grid, &input, friction, &threads, go_on) {
                None => return Ok(None),
                within => within,
            },
        };
        let [lx, ly] = grid.size();
        let (reach, slides) = (1.01 * lx.hypot(ly), friction != [0.0, 0.0]);
        let kind = threads.run(|| {
            Kernels::new::<6, 9, loads::Pressure, loads::Traction>(body, grid, 1.0, reach, slides)
        });
        let uniform = within.as_ref().map_or(input.as_slice(), Within::uniform);
        let offsets = offsets(shape, [&input, uniform]);
        let transform = PaddedTransform::plan_even(shape, offsets, &threads);
        let transformed =
            |input: &[f64]| transform.transform(input, &mut transform.workspace(), &threads);
        let pressure = transformed(uniform);
        let within = within.map(|within| (within, transformed(&input)));
        Ok(Some(Self {
            spacing: grid.spacing(),
            kind,
            displacement: options.displacement,
            friction,
            offsets,
            quarter: transform.quarter_transform(),
            transform,
            pressure,
            within,
            threads,
        }))
    }

    /// Bytes that it takes, with the coefficients of one depth.
    pub(super) fn memory(grid: &Grid, form: Form, options: &StressOptions) -> u64 {
        let [nx, ny] = grid.shape().map(|n| n as u64);
        let loads = if options.friction == 0.0 { 1 } else { 3 };
        let fields = if options.displacement { 9 } else { 6 };
        let within = if form == Form::Solved { 24 } else { 0 };
        // Coefficients of each load; the transform of the pressure and what it is made from, 8; of
        // components, 2 for each; what is not uniform in the pressure, and its transform. Transforms
        // come by blocks of columns, and in lengths that are products of small primes: half a block,
        // and a tenth, more.
        let cells = (nx + 1) * (ny + 8) * 8;
        cells * (loads * fields + 8 + 2 * TOGETHER as u64 + within) * 6 / 5
    }

    /// Memory for `fields` components.
    pub(super) fn scratch(&self, fields: usize) -> Scratch {
        let [fx, fy] = self.friction;
        let loads = [(1.0, None), (fx, Some(0)), (fy, Some(1))];
        Scratch {
            loads: loads
                .into_iter()
                .filter(|(factor, _)| *factor != 0.0)
                .map(|(factor, axis)| LoadRows {
                    factor,
                    axis,
                    rows: self
                        .transform
                        .kernel_rows(self.offsets, odd(axis)[..fields].to_vec()),
                })
                .collect(),
            workspace: self.transform.workspace(),
            near: NearTable::default(),
        }
    }

    /// Computes the coefficients at `place`.
    pub(super) fn coefficients(&self, place: &Place, scratch: &mut Scratch) {
        if let Some((within, _)) = &self.within {
            scratch.near = self.threads.run(|| within.at(place));
        }
        self.threads.run(|| match &self.kind {
            Kernels::Line(plan) => self.line(plan, place, scratch),
            Kernels::Plane {
                plan,
                pressure,
                traction,
            } => self.plane_coefficients(plan, [pressure, traction], place, scratch),
        });
    }

    fn plane_coefficients(
        &self,
        plan: &Plan,
        [pressure, traction]: [&[Vec<(f64, f64)>]; 2],
        place: &Place,
        scratch: &mut Scratch,
    ) {
        // Stresses alone need fewer radial functions.
        if self.displacement {
            let normal = Kernel::new::<loads::Pressure>(plan, pressure, place);
            self.fill::<6, COMPONENTS, loads::Pressure>(&normal, scratch, place, false);
            if self.slides() {
                let lateral = Kernel::new::<loads::Traction>(plan, traction, place);
                self.fill::<9, COMPONENTS, loads::Traction>(&lateral, scratch, place, true);
            }
        } else {
            let normal = Kernel::new::<PressureStress>(plan, pressure, place);
            self.fill::<4, 6, PressureStress>(&normal, scratch, place, false);
            if self.slides() {
                let lateral = Kernel::new::<TractionStress>(plan, traction, place);
                self.fill::<6, 6, TractionStress>(&lateral, scratch, place, true);
            }
        }
    }

    /// Computes the coefficients of line contact.
    fn line(&self, plan: &LinePlan, place: &Place, scratch: &mut Scratch) {
        let Scratch {
            loads, workspace, ..
        } = scratch;
        for LoadRows { axis, rows, .. } in loads {
            let values = match axis {
                None => plan.coefficients::<6, strip::Pressure>(place),
                Some(0) => plan.coefficients::<3, strip::Along>(place),
                Some(_) => plan.coefficients::<6, strip::Across>(place),
            };
            let components = rows.count();
            let source = |rows: Range<usize>, keep: &mut Keep| {
                for i in rows {
                    for k in 0..components {
                        let row: Vec<f64> = values.iter().map(|values| values[k]).collect();
                        keep(i, k, &row);
                    }
                }
            };
            self.transform
                .transform_rows(&self.quarter, rows, source, workspace, &self.threads);
        }
    }

    fn slides(&self) -> bool {
        self.friction.iter().any(|factor| *factor != 0.0)
    }

    /// Computes C coefficients of pressure, or those of traction along x and along y.
    fn fill<const N: usize, const C: usize, L: Load<N>>(
        &self,
        kernel: &Kernel<N>,
        scratch: &mut Scratch,
        place: &Place,
        lateral: bool,
    ) {
        let half @ [a, b] = self.spacing.map(|d| 0.5 * d);
        let Scratch {
            loads, workspace, ..
        } = scratch;
        let loads = loads.iter_mut();
        for load in loads.filter(|load| load.axis.is_some() == lateral) {
            let odd = odd(load.axis);
            let (offsets, spacing, depth) = (self.offsets, self.spacing, place.depth);
            let odd: [[bool; 2]; C] = std::array::from_fn(|k| odd[k]);
            let rows = &mut load.rows;
            let mut transform = |source: &(dyn Fn(Range<usize>, &mut Keep) + Sync)| {
                self.transform.transform_rows(
                    &self.quarter,
                    rows,
                    source,
                    workspace,
                    &self.threads,
                );
            };
            if load.axis == Some(1) {
                // Traction along y is traction along x with both exchanged.
                let exchanged = |values: [f64; COMPONENTS]| EXCHANGED.map(|k| values[k]);
                let source = Source {
                    offsets,
                    spacing,
                    depth,
                    odd,
                    mean: |x, y| exchanged(kernel.at::<L>([y, x], [b, a])),
                    point: |x, y| exchanged(kernel.far::<L>(y, x)),
                };
                transform(&|rows, keep| source.rows(rows, keep));
            } else {
                let source = Source {
                    offsets,
                    spacing,
                    depth,
                    odd,
                    mean: |x, y| kernel.at::<L>([x, y], half),
                    point: |x, y| kernel.far::<L>(x, y),
                };
                transform(&|rows, keep| source.rows(rows, keep));
            }
        }
    }

    /// Components on the plane of the coefficients, as many as there are `outputs`. Asks `go_on`
    /// with the part that is done, and ends where it is false; returns whether it did all.
    pub(super) fn plane(
        &self,
        outputs: &mut [&mut [f64]],
        scratch: &mut Scratch,
        go_on: &mut dyn FnMut(f64) -> bool,
    ) -> bool {
        let Scratch {
            loads,
            workspace,
            near,
        } = scratch;
        let sets: Vec<_> = loads.iter().map(|load| (load.factor, &load.rows)).collect();
        let count = outputs.len();
        let mut done = 0;
        for outputs in outputs.chunks_mut(TOGETHER) {
            if !go_on(done as f64 / count as f64) {
                return false;
            }
            let numbers = done..done + outputs.len();
            done = numbers.end;
            let pressure = match &self.within {
                Some((_, given)) if numbers.start >= STRESSES => given,
                _ => &self.pressure,
            };
            self.threads.run(|| {
                self.transform.convolve_parities(
                    pressure,
                    (&self.quarter, &sets),
                    numbers,
                    outputs,
                    workspace,
                    &self.threads,
                );
            });
        }
        if let Some((within, _)) = &self.within {
            self.threads
                .run(|| within.add(near, &mut outputs[..STRESSES]));
        }
        true
    }
}

/// How many offsets along x and y, 0 included, lie between a cell and one that any of `loads` is on.
fn offsets(shape: [usize; 2], loads: [&[f64]; 2]) -> [usize; 2] {
    let mut ends = shape.map(|n| [n, 0]);
    for load in loads {
        for (k, _) in load.iter().enumerate().filter(|(_, p)| **p != 0.0) {
            for (end, at) in ends.iter_mut().zip([k / shape[1], k % shape[1]]) {
                *end = [end[0].min(at), end[1].max(at)];
            }
        }
    }
    // From the first loaded cell to the last cell, from the first cell to the last loaded one.
    [0, 1].map(|axis| match (ends[axis], shape[axis]) {
        ([first, last], n) if first <= last => (n - first).max(last + 1),
        (_, n) => n,
    })
}
