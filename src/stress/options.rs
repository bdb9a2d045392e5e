//! Options of an evaluation of stress, and its progress callback.

use std::ops::ControlFlow;

use crate::error::{Error, Result, finite};
use crate::model::body::HalfSpace;

/// Side of an interface, for a depth that lies on one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Side {
    /// The layer above the interface.
    Above,
    /// The layer or the substrate below the interface.
    #[default]
    Below,
}

/// Points of each plane z = const at which fields are returned. Beyond a free end of the body they are NaN.
///
/// Lines and points are interpolated between cell centres, and on the outer half of the grid's first and last cells
/// extrapolated from two of them; on periodic grids the first cell follows the last. Between a free end and the cells
/// beside it, they are interpolated from the body's side alone: from its last cells, and from the face itself.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Section {
    /// All cell centres.
    #[default]
    Plane,
    /// The line x = const, by linear interpolation.
    X(f64),
    /// The line y = const, by linear interpolation.
    Y(f64),
    /// The point (x, y), by linear interpolation.
    Axis([f64; 2]),
}

/// Options of an evaluation; the depths are an argument of their own.
#[derive(Debug, Clone, PartialEq)]
pub struct StressOptions {
    /// Side of an interface, for depths that lie on one. Default: below.
    pub side: Side,
    /// Where fields are returned. Default: on whole planes.
    pub section: Section,
    /// Coefficient of friction μ. Default: 0.
    pub friction: f64,
    /// Direction of the traction on the body, a vector of any length above 0; a counterbody gets the
    /// opposite. Default: the direction in which the shape rolls
    /// ([`Report::rolling_direction`](crate::Report::rolling_direction)), across the axis of a roller, and
    /// across the strips of a line contact. With friction it must be given for other shapes.
    pub direction: Option<[f64; 2]>,
    /// Residual stress \[Pa\] of each layer from the surface down, then of the substrate; a shorter
    /// list leaves the rest at 0. It is added to σ_xx and σ_yy. Default: none.
    pub residual: Vec<f64>,
    /// Whether displacements are evaluated too. Default: no.
    pub displacement: bool,
    /// Threads of the plan that a single call makes. An evaluation of a
    /// [`StressPlan`](crate::StressPlan) uses the plan's threads instead. Default: all of the
    /// machine's.
    pub threads: Option<usize>,
}

impl Default for StressOptions {
    fn default() -> Self {
        Self {
            side: Side::default(),
            section: Section::default(),
            friction: 0.0,
            direction: None,
            residual: Vec::new(),
            displacement: false,
            threads: None,
        }
    }
}

impl StressOptions {
    /// Residual stress of every layer and of the substrate.
    pub(super) fn residual_by_layer(&self, body: &HalfSpace) -> Result<Vec<f64>> {
        let count = body.layers().len() + 1;
        if self.residual.len() > count {
            return Err(Error::Parameter {
                name: "number of values in residual",
                requirement: "at most one for each layer and one for the substrate",
                value: self.residual.len() as f64,
            });
        }
        let mut values = vec![0.0; count];
        for (value, given) in values.iter_mut().zip(&self.residual) {
            *value = finite("residual", *given)?;
        }
        Ok(values)
    }
}

/// Callback that is told the fraction of the work done, from 0 to 1; it breaks to stop the work.
pub type StressProgress<'a> = dyn FnMut(f64) -> ControlFlow<()> + 'a;
