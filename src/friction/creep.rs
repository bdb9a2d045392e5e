//! Kalker's linear coefficients: forces of rolling with full adhesion.

use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::sync::Arc;

use super::coulomb::Law;
use super::newton::{Effort, Operator, TractionProblem};
use super::step::RollingDirection;
use super::tangential_problem::{GRID_BYTES, ROLLING_BYTES};
use crate::compliance::response::Body;
use crate::compliance::traction::Tangential;
use crate::error::{Error, Result, positive, refuse_if, require};
use crate::model::body::{HalfSpace, Substrate};
use crate::model::grid::Grid;
use crate::numerics::parallel::{Threads, check_memory};

/// Kalker's coefficients of an elliptic contact with the semi-axes a, along the direction of rolling, and b:
///
/// ```text
/// F_x = a b G C11 ξ      F_y = a b G (C22 η + √(ab) C23 φ)      M_z = (ab)^{3/2} G (−C23 η + √(ab) C33 φ)
/// ```
///
/// for the tractions on the body, ξ, η and φ being the creepages and the spin of the counterbody over it. Kalker,
/// Three-Dimensional Elastic Bodies in Rolling Contact, Kluwer (1990), §2.2.3 and table E3,
/// doi:10.1007/978-94-015-7889-9; those of coated bodies are derived here; not published elsewhere.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
#[non_exhaustive]
pub struct CreepCoefficients {
    /// C11, of the longitudinal creepage.
    pub c11: f64,
    /// C22, of the lateral creepage.
    pub c22: f64,
    /// C23, of the spin in the lateral force.
    pub c23: f64,
    /// C33, of the spin in the torque.
    pub c33: f64,
    /// Estimated errors of the four: the change from grids of half as many cells, extrapolated.
    pub errors: [f64; 4],
    /// Modulus G \[Pa\]: 1/G is the mean of 1/G of both bodies, far below their layers.
    pub shear: f64,
    /// Semi-axes (a, b) \[m\].
    pub semi_axes: [f64; 2],
}

/// Callback that says whether to continue.
pub type CreepWatch<'a> = dyn FnMut() -> ControlFlow<()> + Send + 'a;

/// Cells along each axis of the ellipse, by default.
const CELLS: usize = 64;

/// Residual slip over the largest displacement.
const TOLERANCE: f64 = 1e-6;

/// Convolutions for one motion.
const MOST: usize = 2000;

/// Kalker's coefficients of `body` and `counterbody`, rigid where `None`, in an elliptic contact with the semi-axes
/// \[a, b\], a along the direction of rolling. The effect of the pressure of different bodies on their slip, which adds a
/// force without creepage, is not part of them. `cells` across the ellipse (default: 64) and half as many are
/// extrapolated, as errors fall in proportion to the size of the cells.
///
/// `watch` is asked with each convolution whether to continue.
///
/// # Errors
/// Semi-axes that are not above 0, fewer than 8 cells, too little memory, bodies without layers and substrate, two rigid bodies;
/// [`Error::Stopped`] where `watch` breaks.
///
/// ```
/// use nacre::friction::creep_coefficients;
/// use nacre::Elastic;
/// let steel = Elastic::new(210e9, 0.25)?;
/// let creep = creep_coefficients(steel, Some(steel.into()), [1e-3, 1e-3], Some(32), None)?;
/// // Kalker's table E3: 4.12, 3.67, 1.47
/// assert!((creep.c11 / 4.12 - 1.0).abs() < 0.01 && (creep.c23 / 1.47 - 1.0).abs() < 0.01);
/// # Ok::<(), nacre::Error>(())
/// ```
pub fn creep_coefficients(
    body: impl Into<Body>,
    counterbody: Option<Body>,
    semi_axes: [f64; 2],
    cells: Option<usize>,
    mut watch: Option<&mut CreepWatch>,
) -> Result<CreepCoefficients> {
    let body = body.into();
    let cells = cells.unwrap_or(CELLS);
    for length in semi_axes {
        positive("semi_axes", length)?;
    }
    require("cells", cells as f64, cells >= 8, "at least 8")?;
    for body in std::iter::once(&body).chain(&counterbody) {
        refuse_if(
            body.half_space().is_some_and(|layers| layers.ends() != [None; 2]),
            crate::compliance::traction::FRICTION_NEEDS_ENDLESS_BODIES,
        )?;
    }
    let shear = shear(&body, counterbody.as_ref())?;
    // All divides as the square of the cells.
    let shape = [cells.saturating_add(2), cells];
    let bytes = (GRID_BYTES + ROLLING_BYTES) as f64 * (cells as f64).powi(2);
    check_memory(shape, bytes as u64)?;
    let threads = Arc::new(Threads::new(None)?);
    let mut ask = || watch.as_mut().map_or(ControlFlow::Continue(()), |watch| watch());
    let mut on = |cells: usize| {
        let on = EllipticContact::plan(&body, counterbody.as_ref(), semi_axes, cells, &threads)?;
        threads.run(|| on.coefficients(shear, &mut ask))
    };
    let (coarse, fine) = (on(cells / 2)?, on(cells)?);
    let share = cells as f64 / (cells / 2) as f64 - 1.0;
    let changes: [f64; 4] = std::array::from_fn(|k| (fine[k] - coarse[k]) / share);
    let [c11, c22, c23, c33] = std::array::from_fn(|k| fine[k] + changes[k]);
    Ok(CreepCoefficients {
        c11,
        c22,
        c23,
        c33,
        // What is left after the extrapolation is some tenth of what it changes.
        errors: changes.map(|change| 0.2 * change.abs()),
        shear,
        semi_axes,
    })
}

/// The combined shear modulus.
fn shear(body: &Body, counterbody: Option<&Body>) -> Result<f64> {
    let compliance = |body: &Body| match body.half_space().map(HalfSpace::substrate) {
        Some(Substrate::Elastic(material)) => 1.0 / material.shear(),
        _ => 0.0,
    };
    let sum = compliance(body) + counterbody.map_or(0.0, compliance);
    if sum > 0.0 {
        return Ok(2.0 / sum);
    }
    Err(Error::Inconsistent(
        "creep coefficients need a body whose substrate is not rigid: its shear modulus is their unit",
    ))
}

/// An elliptic contact on a grid.
struct EllipticContact {
    grid: Grid,
    tangential: Tangential,
    law: Law,
    semi_axes: [f64; 2],
}

/// A bound that no traction reaches.
const UNBOUNDED: f64 = 1e200;

impl EllipticContact {
    fn plan(
        body: &Body,
        counterbody: Option<&Body>,
        semi_axes: [f64; 2],
        cells: usize,
        threads: &Arc<Threads>,
    ) -> Result<Self> {
        // A cell more on each side along the direction of rolling.
        let shape = [cells + 2, cells];
        let unit = |k: usize, n: usize| (2.0 * k as f64 + 1.0 - n as f64) / cells as f64;
        let inside = |i: usize, j: usize| unit(i, shape[0]).hypot(unit(j, shape[1])) < 1.0;
        let bound: Vec<f64> = (0..shape[0])
            .flat_map(|i| (0..shape[1]).map(move |j| [i, j]))
            .map(|[i, j]| if inside(i, j) { UNBOUNDED } else { 0.0 })
            .collect();
        let count = bound.iter().filter(|bound| **bound > 0.0).count();
        // All cells together have the area of the ellipse.
        let side = (PI / count as f64).sqrt();
        let size = [0, 1].map(|axis| shape[axis] as f64 * side * semi_axes[axis]);
        let grid = Grid::new(shape, size)?;
        Ok(Self {
            tangential: Tangential::plan(body, counterbody, &grid, threads)?,
            grid,
            law: Law { bound },
            semi_axes,
        })
    }

    /// C11, C22, C23, C33 for the modulus `shear`.
    fn coefficients(&self, shear: f64, watch: &mut CreepWatch) -> Result<[f64; 4]> {
        let motions: [&dyn Fn([f64; 2]) -> [f64; 2]; 3] =
            [&|_| [1.0, 0.0], &|_| [0.0, 1.0], &|[x, y]| [-y, x]];
        let mut results = [[0.0; 3]; 3];
        for (motion, result) in motions.into_iter().zip(&mut results) {
            *result = self.forces(motion, watch)?;
        }
        let [a, b] = self.semi_axes;
        let unit = shear * a * b;
        let c = (a * b).sqrt();
        Ok([
            results[0][0] / unit,
            results[1][1] / unit,
            results[2][1] / (unit * c),
            results[2][2] / (unit * c * c),
        ])
    }

    /// Forces along x and y and torque of rolling with full adhesion under unit creepages or spin, given by `motion` at (x, y).
    fn forces(
        &self,
        motion: &dyn Fn([f64; 2]) -> [f64; 2],
        watch: &mut CreepWatch,
    ) -> Result<[f64; 3]> {
        let window = self.tangential.window(self.grid.shape());
        let cells = window.cells();
        let (x, y) = (self.grid.x(), self.grid.y());
        let place = |at: usize| [x[at / y.len()], y[at % y.len()]];
        let d = self.grid.spacing()[0];
        let mut displacements = vec![0.0; 2 * cells];
        for at in 0..cells {
            let [along, across] = motion(place(at));
            (displacements[at], displacements[cells + at]) = (along * d, across * d);
        }
        let problem = TractionProblem {
            operator: Operator {
                window: &window,
                rolling: Some(RollingDirection::PlusX),
                second_order: None,
                blends: false,
            },
            law: &self.law,
            displacements,
            columns: Vec::new(),
            forces: Vec::new(),
        };
        let effort = Effort { tolerance: TOLERANCE, most: MOST };
        let solution = problem.solve(vec![0.0; 2 * cells], effort, &mut |_, _| watch());
        if solution.stopped {
            return Err(Error::Stopped);
        }
        if solution.misfit.worst() > TOLERANCE {
            let (iterations, residual) = (solution.convolutions, solution.misfit.worst());
            return Err(Error::not_converged(iterations, residual, TOLERANCE, "cells"));
        }
        let (qx, qy) = solution.q.split_at(cells);
        let area = self.grid.cell_area();
        let torque = (0..cells).map(|at| place(at)[0] * qy[at] - place(at)[1] * qx[at]);
        Ok([qx.iter().sum::<f64>(), qy.iter().sum(), torque.sum()].map(|sum| sum * area))
    }
}
