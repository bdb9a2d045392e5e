//! Influence coefficients of a plan at one place, row by row, for whichever sum is made of them.

use std::ops::Range;

use crate::compliance::kernel::cells::Source;
use crate::compliance::kernel::loads::{
    self, COMPONENTS, EXCHANGED, Load, ODD, PressureStress, TractionStress,
};
use crate::compliance::kernel::plane::{Kernel, Plan};
use crate::compliance::kernel::plans::Kernels;
use crate::compliance::kernel::strip::{self, LinePlan};
use crate::compliance::response::interior::Place;
use crate::numerics::fft::Keep;
use crate::stress::half_space::plan::HalfSpacePlan;
use crate::stress::half_space::repeats::{Repeats, rows_of};

pub(super) use crate::stress::half_space::repeats::RowSource;
use crate::stress::subcell::STRESSES;

/// A load on the surface, in proportion to the pressure.
#[derive(Debug, Clone, Copy)]
pub(in crate::stress) struct SurfaceLoad {
    /// Load per unit of pressure: 1, or a component of the friction.
    pub(super) factor: f64,
    /// Axis along which the traction acts; none for pressure.
    pub(super) axis: Option<usize>,
}

impl SurfaceLoad {
    /// The pressure, and the tractions of `friction` that are not 0.
    pub(in crate::stress) fn all(friction: [f64; 2]) -> Vec<Self> {
        let loads = [(1.0, None), (friction[0], Some(0)), (friction[1], Some(1))];
        let loads = loads.into_iter().filter(|(factor, _)| *factor != 0.0);
        loads.map(|(factor, axis)| Self { factor, axis }).collect()
    }

    /// Whether each component is odd in x and in y.
    pub(super) fn odd(self) -> [[bool; 2]; COMPONENTS] {
        ODD.map(|odd| [0, 1].map(|along| odd[along] != (self.axis == Some(along))))
    }
}

/// Number of components: six stresses, and three displacements where they are asked for.
pub(in crate::stress) const fn components(displacement: bool) -> usize {
    if displacement { COMPONENTS } else { STRESSES }
}

/// Coefficients of a plan at one place.
#[derive(Debug, Clone, Copy)]
pub(super) struct Coefficients<'a> {
    pub(super) plan: &'a HalfSpacePlan,
    pub(super) place: &'a Place,
    /// Numbers of offsets along x and y.
    pub(super) offsets: [usize; 2],
    /// Whether displacements are wanted beside the stresses.
    pub(super) displacement: bool,
    /// Whether offsets along x are half a cell longer: those between cells and the line between two rows.
    pub(super) between: bool,
}

impl Coefficients<'_> {
    /// Calls `take` with the number of each load, and the source of its coefficients. On the threads of the
    /// caller.
    pub(super) fn each(&self, loads: &[SurfaceLoad], take: &mut dyn FnMut(usize, &RowSource)) {
        let slides = loads.iter().any(|load| load.axis.is_some());
        match &self.plan.kernels {
            Kernels::Line(plan) => self.strips(plan, loads, take),
            Kernels::Plane {
                plan,
                pressure,
                traction,
            } => {
                // Made without rayon, so that a thread that waits for it cannot be asked to make it.
                let traction = slides
                    .then(|| traction.get_or_init(|| plan.multipliers::<9, loads::Traction>()));
                // Stresses alone need fewer radial functions.
                if self.displacement {
                    self.cells::<6, COMPONENTS, loads::Pressure>(plan, pressure, loads, take);
                    if let Some(traction) = traction {
                        self.cells::<9, COMPONENTS, loads::Traction>(plan, traction, loads, take);
                    }
                } else {
                    self.cells::<4, 6, PressureStress>(plan, pressure, loads, take);
                    if let Some(traction) = traction {
                        self.cells::<6, 6, TractionStress>(plan, traction, loads, take);
                    }
                }
            }
        }
    }

    /// Coefficients of line contact.
    fn strips(
        &self,
        plan: &LinePlan,
        loads: &[SurfaceLoad],
        take: &mut dyn FnMut(usize, &RowSource),
    ) {
        let components = components(self.displacement);
        for (number, load) in loads.iter().enumerate() {
            let values = match load.axis {
                None => plan.coefficients::<6, strip::Pressure>(self.place),
                Some(0) => plan.coefficients::<3, strip::Along>(self.place),
                Some(_) => plan.coefficients::<6, strip::Across>(self.place),
            };
            take(number, &|rows: Range<usize>, keep: &mut Keep| {
                for i in rows {
                    for k in 0..components {
                        let row: Vec<f64> = values.iter().map(|values| values[k]).collect();
                        keep(i, k, &row);
                    }
                }
            });
        }
    }

    /// C coefficients of the loads of the kind L: of pressure, or of the tractions along x and along y.
    fn cells<const N: usize, const C: usize, L: Load<N>>(
        &self,
        plan: &Plan,
        multipliers: &[Vec<(f64, f64)>],
        loads: &[SurfaceLoad],
        take: &mut dyn FnMut(usize, &RowSource),
    ) {
        let kernel = Kernel::new::<L>(plan, multipliers, self.place);
        let (offsets, spacing) = (self.offsets, self.plan.grid.spacing());
        let half @ [a, b] = spacing.map(|d| 0.5 * d);
        let depth = self.place.depth;
        // Where the grid repeats, all offsets are computed at once, from those of one cell at the near ones.
        let repeats = self.plan.repeats.as_ref();
        let block = repeats.and_then(|repeats| repeats.block_kernel::<N, L>(self.place));
        let needed = repeats.map_or(offsets, Repeats::extents);
        let of_kind = |load: &SurfaceLoad| load.axis.is_some() == L::IS_TRACTION;
        for (number, load) in loads.iter().enumerate().filter(|(_, load)| of_kind(load)) {
            let odd = load.odd();
            let odd: [[bool; 2]; C] = std::array::from_fn(|k| odd[k]);
            if load.axis == Some(1) {
                // Traction along y is traction along x with both exchanged.
                let exchanged = |values: [f64; COMPONENTS]| EXCHANGED.map(|k| values[k]);
                let source = Source {
                    offsets: needed,
                    spacing,
                    depth,
                    between: self.between,
                    odd,
                    mean: |x, y| exchanged(kernel.at::<L>([y, x], [b, a])),
                    point: |x, y| exchanged(kernel.far::<L>(y, x)),
                };
                let of_block = |[x, y]: [f64; 2], [a, b]: [f64; 2]| {
                    let at = |block: &Kernel<N>| exchanged(block.at::<L>([y, x], [b, a]));
                    block.as_ref().map_or([0.0; COMPONENTS], at)
                };
                self.give(number, *load, &source, of_block, take);
            } else {
                let source = Source {
                    offsets: needed,
                    spacing,
                    depth,
                    between: self.between,
                    odd,
                    mean: |x, y| kernel.at::<L>([x, y], half),
                    point: |x, y| kernel.far::<L>(x, y),
                };
                let of_block = |at: [f64; 2], half: [f64; 2]| {
                    let at = |block: &Kernel<N>| block.at::<L>(at, half);
                    block.as_ref().map_or([0.0; COMPONENTS], at)
                };
                self.give(number, *load, &source, of_block, take);
            }
        }
    }

    /// Gives the coefficients of a load to `take`, summed over images where the grid repeats.
    fn give<M, P, const C: usize>(
        &self,
        number: usize,
        load: SurfaceLoad,
        source: &Source<M, P, C>,
        block: impl Fn([f64; 2], [f64; 2]) -> [f64; COMPONENTS] + Sync,
        take: &mut dyn FnMut(usize, &RowSource),
    ) where
        M: Fn(f64, f64) -> [f64; COMPONENTS] + Sync,
        P: Fn(f64, f64) -> [f64; COMPONENTS] + Sync,
    {
        match &self.plan.repeats {
            None => take(number, &|rows, keep| source.rows(rows, keep)),
            Some(repeats) => {
                let summed = repeats.coefficients(source, block, (self.place, load.axis));
                take(number, &*rows_of(&summed, self.offsets[1]));
            }
        }
    }
}
