//! A body under pressure and friction: one component on one plane is one convolution.

use ndarray::ArrayRef2;

use super::StressOptions;
use super::cells::{Cells, Source};
use super::components::{self, COMPONENTS, EXCHANGED, Load, ODD, PressureStress, TractionStress};
use super::kernel::{Kernel, Plan};
use super::line::{self, LinePlan};
use super::near::Near;
use super::within::Within;
use crate::body::{HalfSpace, Interface};
use crate::error::{Error, Result, finite};
use crate::fft::{
    Blocks, KernelTransform, PaddedTransform, ParitySpectrum, Transformed, Workspace,
};
use crate::grid::Grid;
use crate::response::interior::Place;
use crate::threads::Threads;

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
    shape: [usize; 2],
    spacing: [f64; 2],
    kind: Kernels,
    displacement: bool,
    /// μ times the unit vector of the traction.
    friction: [f64; 2],
    transform: PaddedTransform,
    pressure: Transformed,
    /// Where pressure is not uniform over cells, and the transform of the cells' pressure, of which
    /// displacements are; stresses are the convolution of [`Loaded::pressure`].
    within: Option<(Within, Transformed)>,
    threads: Threads,
}

/// What makes the coefficients.
#[derive(Debug)]
enum Kernels {
    Plane {
        plan: Box<Plan>,
        pressure: Vec<Vec<(f64, f64)>>,
        traction: Vec<Vec<(f64, f64)>>,
    },
    Line(LinePlan),
}

/// Memory that all depths use.
#[derive(Debug)]
pub(super) struct Scratch {
    loads: Vec<LoadCells>,
    kernel: KernelTransform,
    blocks: Blocks,
    workspace: Workspace,
    near: Near,
}

/// Coefficients of one load at one depth.
#[derive(Debug)]
struct LoadCells {
    factor: f64,
    /// The axis along which it acts, and of which it turns the parities; none for pressure.
    axis: Option<usize>,
    cells: Cells,
    spectra: Vec<ParitySpectrum>,
}

impl LoadCells {
    fn flipped(&self) -> [bool; 2] {
        [0, 1].map(|axis| self.axis == Some(axis))
    }
}

impl Loaded {
    pub(super) fn new(
        body: &HalfSpace,
        grid: &Grid,
        pressure: &ArrayRef2<f64>,
        form: Form,
        options: &StressOptions,
    ) -> Result<Self> {
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
        let spacing = grid.spacing();
        let kind = if grid.is_line() {
            Kernels::Line(LinePlan::new(body, grid, 1.0))
        } else {
            let [lx, ly] = grid.size();
            let plan = threads.run(|| Plan::new(body, spacing, 1.0, 1.01 * lx.hypot(ly)));
            Kernels::Plane {
                pressure: plan.multipliers::<6, components::Pressure>(),
                traction: plan.multipliers::<9, components::Traction>(),
                plan: Box::new(plan),
            }
        };
        let transform = PaddedTransform::plan_even(shape, &threads);
        let input: Vec<f64> = pressure.iter().copied().collect();
        let transformed =
            |input: &[f64]| transform.transform(input, &mut transform.workspace(), &threads);
        let within = (form == Form::Solved)
            .then(|| threads.run(|| Within::new(body, grid, &input, friction)))
            .map(|within| (within, transformed(&input)));
        let pressure = match &within {
            Some((within, _)) => transformed(within.uniform()),
            None => transformed(&input),
        };
        Ok(Self {
            shape,
            spacing,
            kind,
            displacement: options.displacement,
            friction,
            transform,
            pressure,
            within,
            threads,
        })
    }

    /// μ times the unit vector of the traction on the body.
    pub(super) fn friction(&self) -> [f64; 2] {
        self.friction
    }

    /// Bytes that it takes, with the coefficients of one depth.
    pub(super) fn memory(grid: &Grid, form: Form, options: &StressOptions) -> u64 {
        let [nx, ny] = grid.shape().map(|n| n as u64);
        let loads = if options.friction == 0.0 { 1 } else { 3 };
        let fields = if options.displacement { 9 } else { 6 };
        let within = if form == Form::Solved { 24 } else { 0 };
        // Coefficients and spectra of each load; the transforms of planes, and of the pressure;
        // what is not uniform in it, and its transform.
        (nx + 1) * (ny + 1) * 8 * (loads * 3 * fields + 2 * fields + 16 + within)
    }

    /// Memory for `fields` components.
    pub(super) fn scratch(&self, fields: usize) -> Scratch {
        let [fx, fy] = self.friction;
        let loads = [(1.0, None), (fx, Some(0)), (fy, Some(1))];
        Scratch {
            loads: loads
                .into_iter()
                .filter(|(factor, _)| *factor != 0.0)
                .map(|(factor, axis)| LoadCells {
                    factor,
                    axis,
                    cells: Cells::new(self.shape, fields),
                    spectra: (0..fields)
                        .map(|_| self.transform.empty_spectrum())
                        .collect(),
                })
                .collect(),
            kernel: self.transform.kernel_transform(),
            blocks: self.transform.block_memory(fields),
            workspace: self.transform.workspace(),
            near: Near::default(),
        }
    }

    /// Computes the coefficients at `place`.
    pub(super) fn coefficients(&self, place: &Place, scratch: &mut Scratch) {
        if let Some((within, _)) = &self.within {
            scratch.near = self.threads.run(|| within.at(place));
        }
        let (plan, pressure, traction) = match &self.kind {
            Kernels::Line(plan) => {
                for LoadCells { axis, cells, .. } in &mut scratch.loads {
                    cells.fill_line(&match axis {
                        None => plan.coefficients::<6, line::Pressure>(place),
                        Some(0) => plan.coefficients::<3, line::Along>(place),
                        Some(_) => plan.coefficients::<6, line::Across>(place),
                    });
                }
                return;
            }
            Kernels::Plane {
                plan,
                pressure,
                traction,
            } => (plan, pressure, traction),
        };
        self.threads.run(|| {
            // Stresses alone need fewer radial functions.
            if self.displacement {
                let normal = Kernel::new::<components::Pressure>(plan, pressure, place);
                self.fill::<6, components::Pressure>(&normal, scratch, place, false);
                if self.slides() {
                    let lateral = Kernel::new::<components::Traction>(plan, traction, place);
                    self.fill::<9, components::Traction>(&lateral, scratch, place, true);
                }
            } else {
                let normal = Kernel::new::<PressureStress>(plan, pressure, place);
                self.fill::<4, PressureStress>(&normal, scratch, place, false);
                if self.slides() {
                    let lateral = Kernel::new::<TractionStress>(plan, traction, place);
                    self.fill::<6, TractionStress>(&lateral, scratch, place, true);
                }
            }
        });
    }

    fn slides(&self) -> bool {
        self.friction.iter().any(|factor| *factor != 0.0)
    }

    /// Computes the coefficients of pressure, or those of traction along x and along y.
    fn fill<const N: usize, L: Load<N>>(
        &self,
        kernel: &Kernel<N>,
        scratch: &mut Scratch,
        place: &Place,
        lateral: bool,
    ) {
        let half @ [a, b] = self.spacing.map(|d| 0.5 * d);
        let loads = scratch.loads.iter_mut();
        for load in loads.filter(|load| load.axis.is_some() == lateral) {
            let (spacing, depth, flipped) = (self.spacing, place.depth, load.flipped());
            if load.axis == Some(1) {
                // Traction along y is traction along x with both exchanged.
                let exchanged = |values: [f64; COMPONENTS]| EXCHANGED.map(|k| values[k]);
                load.cells.fill(&Source {
                    spacing,
                    depth,
                    flipped,
                    mean: |x, y| exchanged(kernel.at::<L>([y, x], [b, a])),
                    point: |x, y| exchanged(kernel.point::<L>(y, x)),
                });
            } else {
                load.cells.fill(&Source {
                    spacing,
                    depth,
                    flipped,
                    mean: |x, y| kernel.at::<L>([x, y], half),
                    point: |x, y| kernel.point::<L>(x, y),
                });
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
            kernel,
            blocks,
            workspace,
            near,
        } = scratch;
        let count = outputs.len();
        for (k, parity) in ODD[..count].iter().enumerate() {
            if !go_on(k as f64 / count as f64) {
                return false;
            }
            for load in loads.iter_mut() {
                let flipped = load.flipped();
                let odd = [0, 1].map(|axis| parity[axis] != flipped[axis]);
                let cells = &load.cells;
                self.transform.parity_spectrum_into(
                    odd,
                    |i| cells.row(i, k),
                    &mut load.spectra[k],
                    kernel,
                    workspace,
                    &self.threads,
                );
            }
        }
        let kernels: Vec<Vec<(f64, &ParitySpectrum)>> = (0..count)
            .map(|k| {
                loads
                    .iter()
                    .map(|load| (load.factor, &load.spectra[k]))
                    .collect()
            })
            .collect();
        let mut convolve = |pressure, kernels: &[_], outputs: &mut [&mut [f64]]| {
            self.transform.convolve_parities(
                pressure,
                kernels,
                outputs,
                blocks,
                workspace,
                &self.threads,
            );
        };
        let Some((within, given)) = &self.within else {
            convolve(&self.pressure, &kernels, outputs);
            return true;
        };
        let (stresses, displacements) = outputs.split_at_mut(6);
        convolve(&self.pressure, &kernels[..6], stresses);
        if !displacements.is_empty() {
            convolve(given, &kernels[6..], displacements);
        }
        self.threads.run(|| within.add(near, stresses));
        true
    }
}

/// μ times the unit vector of the traction on the body.
fn friction(body: &HalfSpace, options: &StressOptions) -> Result<[f64; 2]> {
    let friction = finite("friction", options.friction)?;
    if friction < 0.0 {
        return Err(Error::Parameter {
            name: "friction",
            requirement: "at least 0 (turn the direction)",
            value: friction,
        });
    }
    let [x, y] = options.direction;
    let length = x.hypot(y);
    if !(length > 0.0 && length.is_finite()) {
        return Err(Error::Parameter {
            name: "direction",
            requirement: "a vector of finite length above 0",
            value: length,
        });
    }
    let slips = |layer: &crate::Layer| layer.interface() == Interface::Frictionless;
    if friction > 0.0 && body.layers().iter().any(slips) {
        return Err(Error::Inconsistent(
            "friction must be 0 on a body with a frictionless interface: nothing holds the layers \
             above it",
        ));
    }
    Ok([friction * x / length, friction * y / length])
}
