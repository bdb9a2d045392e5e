//! Options of an evaluation of stress, its friction, and its progress callback.

use std::fmt;
use std::ops::ControlFlow;

use crate::compliance::response::refuse_free;
use crate::error::{Error, Result, finite, require};
use crate::model::body::HalfSpace;

/// Side of an interface, for a depth that lies on one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "lowercase")
)]
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
#[non_exhaustive]
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
#[non_exhaustive]
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
    /// across the strips of a line contact; x below a body of revolution that is pressed on its axis. With friction it must
    /// be given for other shapes.
    pub direction: Option<[f64; 2]>,
    /// Residual stress \[Pa\] of each layer from the surface down, then of the substrate; a shorter
    /// list leaves the rest at 0. It is added to σ_xx and σ_yy. Default: none.
    pub residual: Vec<f64>,
    /// Whether displacements are evaluated too. Default: no.
    pub displacement: bool,
    /// Largest estimated error of the extremes of a [`Solution::stress_summary`](crate::Solution::stress_summary), as a part of
    /// them, above 0 and below 1: places where the cells leave a larger one are solved again on finer cells. Fields have no use
    /// for it. Default: none, the cells of the grid.
    pub refine: Option<f64>,
    /// Threads of the plan that a single call makes. An evaluation of a
    /// [`StressPlan`](crate::StressPlan) uses the plan's threads instead. Default: all of the
    /// machine's.
    pub threads: Option<usize>,
}

builders! {
    StressOptions {
        with_side(side: Side),
        with_section(section: Section),
        with_friction(friction: f64),
        with_direction(direction: impl Into<Option<[f64; 2]>>),
        with_residual(residual: impl Into<Vec<f64>>),
        with_displacement(displacement: bool),
        with_refine(refine: impl Into<Option<f64>>),
        with_threads(threads: impl Into<Option<usize>>),
    }
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
            refine: None,
            threads: None,
        }
    }
}

impl StressOptions {
    /// These options, with a callback that is told the fraction of the work done, and that may break to stop it.
    pub fn watched<'a>(&'a self, progress: &'a mut StressProgress<'a>) -> WatchedStress<'a> {
        WatchedStress { options: self, progress: Some(progress) }
    }

    /// Residual stress of every layer and of the substrate.
    pub(super) fn residual_by_layer(&self, body: &HalfSpace) -> Result<Vec<f64>> {
        let count = body.layers().len() + 1;
        let number = self.residual.len();
        let requirement = "at most one for each layer and one for the substrate";
        require("number of values in residual", number as f64, number <= count, requirement)?;
        let mut values = vec![0.0; count];
        for (value, stress) in values.iter_mut().zip(&self.residual) {
            *value = finite("residual", *stress)?;
        }
        Ok(values)
    }
}

/// Callback that is told the fraction of the work done, from 0 to 1; it breaks to stop the work.
pub type StressProgress<'a> = dyn FnMut(f64) -> ControlFlow<()> + 'a;

/// Options of an evaluation, and the callback that watches it, if there is one: [`StressOptions::watched`].
pub struct WatchedStress<'a> {
    options: &'a StressOptions,
    progress: Option<&'a mut StressProgress<'a>>,
}

impl<'a> WatchedStress<'a> {
    pub(crate) fn options(&self) -> &'a StressOptions {
        self.options
    }

    /// Tells the callback the fraction of the work done.
    pub(crate) fn tell(&mut self, fraction: f64) -> ControlFlow<()> {
        match &mut self.progress {
            Some(progress) => progress(fraction),
            None => ControlFlow::Continue(()),
        }
    }
}

impl<'a> From<&'a StressOptions> for WatchedStress<'a> {
    fn from(options: &'a StressOptions) -> Self {
        Self { options, progress: None }
    }
}

impl fmt::Debug for WatchedStress<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.options.fmt(f)
    }
}

/// How one body of a contact slides on the other.
#[derive(Debug, Clone, Copy)]
pub(super) struct SlidingSense {
    /// 1, or −1 for a counterbody, on which the traction acts the other way.
    pub(super) sign: f64,
    /// Direction of the traction where the options have none.
    pub(super) direction: Option<[f64; 2]>,
    /// Whether the tractions of the contact are known, and no others may be added.
    pub(super) is_known: bool,
}

impl SlidingSense {
    /// μ times the unit vector of the traction on `body`.
    ///
    /// # Errors
    /// A negative or infinite μ, a direction without length, friction without a direction, or friction on
    /// a body with a frictionless interface.
    pub(super) fn traction(&self, body: &HalfSpace, options: &StressOptions) -> Result<[f64; 2]> {
        let friction = finite("friction", options.friction)?;
        require("friction", friction, friction >= 0.0, "at least 0 (turn the direction)")?;
        require("friction", friction, friction <= 1e100, "at most 1e100")?;
        let direction = options.direction.map(check_direction).transpose()?;
        if friction <= 0.0 {
            return Ok([0.0; 2]);
        }
        if self.is_known {
            return Err(Error::Inconsistent(
                "friction must be 0: the tractions of this contact are known, and their stress is part of the result",
            ));
        }
        refuse_free(body, "a body with friction")?;
        if body.slips() {
            return Err(Error::Inconsistent(
                "friction must be 0 on a body with a frictionless interface: nothing holds the layers \
                 above it against the traction",
            ));
        }
        let [x, y] = direction.or(self.direction).ok_or(Error::Inconsistent(
            "direction must be given where friction is above 0: only rollers, cylinders and line \
             contacts, and bodies of revolution that are pressed on their axis, have one to take instead; \
             (1, 0) is along x",
        ))?;
        let length = x.hypot(y);
        Ok([x, y].map(|component| friction * (self.sign * component) / length))
    }
}

/// `direction`, if it has a finite length above 0.
fn check_direction(direction @ [x, y]: [f64; 2]) -> Result<[f64; 2]> {
    let length = x.hypot(y);
    let holds = length > 0.0 && length.is_finite();
    require("direction", length, holds, "a vector of finite length above 0")?;
    Ok(direction)
}
