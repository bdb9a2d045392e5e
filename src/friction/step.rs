//! What is asked for: friction, and the tangential motion of sliding and of rolling.

use ndarray::Array2;

use crate::contact::Motion;
use crate::error::{Error, Result, finite, not_negative, refuse_if, require, same_shape};
use crate::model::grid::Grid;

/// Coefficient of friction μ ≥ 0.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Friction {
    /// One number.
    Uniform(f64),
    /// A number for each cell of the grid, (nx, ny).
    Cells(Array2<f64>),
}

impl From<f64> for Friction {
    fn from(coefficient: f64) -> Self {
        Self::Uniform(coefficient)
    }
}

impl From<Array2<f64>> for Friction {
    fn from(coefficients: Array2<f64>) -> Self {
        Self::Cells(coefficients)
    }
}

impl Friction {
    /// Bound μp of the traction in each cell: all that the rest of friction asks of the law.
    pub(super) fn times(&self, pressure: &Array2<f64>) -> Array2<f64> {
        match self {
            Self::Uniform(coefficient) => pressure * *coefficient,
            Self::Cells(coefficients) => pressure * coefficients,
        }
    }

    pub(super) fn check(&self, grid: &Grid) -> Result<()> {
        let check = |value: f64| not_negative("friction", value).map(|_| ());
        match self {
            Self::Uniform(coefficient) => check(*coefficient),
            Self::Cells(coefficients) => {
                same_shape("friction", coefficients, grid.shape())?;
                coefficients.iter().try_for_each(|value| check(*value))
            }
        }
    }
}

/// One step of a load history. The counterbody, which carries the shape, moves over the body by a shift along x and
/// along y and a twist about the origin; each is prescribed, or found so that the tractions have a given force or torque.
/// What is not given stays where it was; at first, where the surfaces met.
///
/// ```
/// use nacre::friction::Step;
/// use nacre::Motion;
/// // Press, then pull along x.
/// let steps = [Step::press(Motion::load(10.0), 0.3), Step::default().with_force([Some(2.0), None])];
/// assert_eq!(steps[1].motion, None);
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct Step {
    /// Load or approach, and tilts. What it leaves open, and all of it where it is `None`, is as in the step before.
    pub motion: Option<Motion>,
    /// Coefficient of friction. `None`: as in the step before.
    pub friction: Option<Friction>,
    /// Shift (δ_x, δ_y) at the end of the step \[m\], since the first touch.
    pub shift: [Option<f64>; 2],
    /// Forces (Σ q_x dA, Σ q_y dA) \[N\] of the tractions on the body.
    pub force: [Option<f64>; 2],
    /// Twist ω at the end of the step \[rad\], about the origin.
    pub twist: Option<f64>,
    /// Torque Σ (x q_y − y q_x) dA \[N m\] of the tractions on the body, about the origin.
    pub torque: Option<f64>,
}

builders! {
    Step {
        with_motion(motion: impl Into<Option<Motion>>),
        with_shift(shift: [Option<f64>; 2]),
        with_force(force: [Option<f64>; 2]),
        with_twist(twist: impl Into<Option<f64>>),
        with_torque(torque: impl Into<Option<f64>>),
    }
    Rolling {
        with_creepage(creepage: [Option<f64>; 2]),
        with_force(force: [Option<f64>; 2]),
        with_spin(spin: f64),
    }
    FrictionOptions {
        with_tolerance(tolerance: f64),
        with_max_convolutions(max_convolutions: usize),
        with_coupling(coupling: bool),
        with_order(order: usize),
    }
}

/// A motion of any size but one at which numbers overflow.
fn bounded(name: &'static str, value: f64, unit: f64) -> Result<f64> {
    let requirement = match name {
        "shift" => "at most a million times the width of the grid",
        "spin" => "at most a million over the width of the grid",
        _ => "at most a million",
    };
    let holds = finite(name, value)?.abs() <= 1e6 * unit;
    require(name, value, holds, requirement)
}

impl Step {
    /// A first step: the motion along z and the friction.
    pub fn press(motion: Motion, friction: impl Into<Friction>) -> Self {
        Self { motion: Some(motion), friction: Some(friction.into()), ..Self::default() }
    }

    /// This, with a coefficient of friction.
    #[must_use]
    pub fn with_friction(mut self, friction: impl Into<Friction>) -> Self {
        self.friction = Some(friction.into());
        self
    }

    /// Degrees of freedom along x, along y, and about z.
    pub(super) fn freedoms(&self, grid: &Grid) -> Result<[Freedom; 3]> {
        let pairs = [
            (self.shift[0], self.force[0]),
            (self.shift[1], self.force[1]),
            (self.twist, self.torque),
        ];
        let names = [("shift", "force"), ("shift", "force"), ("twist", "torque")];
        let [lx, ly] = grid.size();
        let units = [lx, ly, 1.0];
        for (((motion, load), (of_motion, of_load)), unit) in
            pairs.into_iter().zip(names).zip(units)
        {
            if let Some(value) = motion {
                bounded(of_motion, value, unit)?;
            }
            if let Some(value) = load {
                finite(of_load, value)?;
            }
            refuse_if(
                motion.is_some() && load.is_some(),
                "of shift and force along one axis, and of twist and torque, one must be given, not both",
            )?;
        }
        refuse_if(
            grid.is_line() && (self.twist.is_some() || self.torque.is_some()),
            "twist and torque must not be given in line contact",
        )?;
        Ok(pairs.map(|(motion, load)| match (motion, load) {
            (_, Some(force)) => Freedom::Loaded(force),
            (Some(value), None) => Freedom::Prescribed(value),
            (None, None) => Freedom::Kept,
        }))
    }
}

/// One degree of freedom of the tangential motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Freedom {
    /// Stays where it was.
    Kept,
    Prescribed(f64),
    /// Has this force or torque.
    Loaded(f64),
}

impl Freedom {
    /// The force or torque that is given, or 0.
    pub(super) fn force(self) -> f64 {
        match self {
            Self::Loaded(force) => force,
            _ => 0.0,
        }
    }
}

/// Direction in which the contact moves over the bodies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum RollingDirection {
    /// Towards +x.
    #[cfg_attr(feature = "serde", serde(rename = "+x"))]
    PlusX,
    /// Towards −x.
    #[cfg_attr(feature = "serde", serde(rename = "-x"))]
    MinusX,
    /// Towards +y, as rollers with their axis along x do.
    #[cfg_attr(feature = "serde", serde(rename = "+y"))]
    PlusY,
    /// Towards −y.
    #[cfg_attr(feature = "serde", serde(rename = "-y"))]
    MinusY,
}

impl RollingDirection {
    /// The unit vector.
    pub fn vector(self) -> [f64; 2] {
        match self {
            Self::PlusX => [1.0, 0.0],
            Self::MinusX => [-1.0, 0.0],
            Self::PlusY => [0.0, 1.0],
            Self::MinusY => [0.0, -1.0],
        }
    }

    /// The axis along which it points.
    pub(crate) fn axis(self) -> usize {
        usize::from(matches!(self, Self::PlusY | Self::MinusY))
    }

    /// Whether it points along its axis, and not against it.
    pub(super) fn is_forward(self) -> bool {
        matches!(self, Self::PlusX | Self::PlusY)
    }
}

/// Rolling at constant speed. The material flows against the direction of rolling; relative to it the counterbody slips
/// by creepages: ξ along the direction of rolling e, η along z × e, and the spin φ about +z.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Rolling {
    /// Load or approach, and tilts.
    pub motion: Motion,
    /// Coefficient of friction.
    pub friction: Friction,
    /// The direction.
    pub direction: RollingDirection,
    /// Creepages (ξ, η); 0 where neither it nor a force is given.
    pub creepage: [Option<f64>; 2],
    /// Forces of the tractions on the body along e and along z × e \[N\].
    pub force: [Option<f64>; 2],
    /// Spin φ \[1/m\].
    pub spin: f64,
}

impl Rolling {
    /// Free rolling without creepage.
    pub fn new(motion: Motion, friction: impl Into<Friction>, direction: RollingDirection) -> Self {
        Self {
            motion,
            friction: friction.into(),
            direction,
            creepage: [None; 2],
            force: [None; 2],
            spin: 0.0,
        }
    }

    pub(super) fn freedoms(&self, grid: &Grid) -> Result<[Freedom; 2]> {
        finite("spin", self.spin)?;
        let axis_is_x = self.direction.vector()[0].abs() > 0.5;
        refuse_if(
            grid.is_line() && (axis_is_x || self.spin != 0.0),
            "in line contact, the direction of rolling must be +y or -y, and the spin 0",
        )?;
        let [lx, ly] = grid.size();
        bounded("spin", self.spin, 1.0 / lx.hypot(ly))?;
        let mut freedoms = [Freedom::Prescribed(0.0); 2];
        for (freedom, (creepage, force)) in
            freedoms.iter_mut().zip(self.creepage.iter().zip(self.force))
        {
            *freedom = match (*creepage, force) {
                (Some(_), Some(_)) => {
                    return Err(Error::Inconsistent(
                        "of creepage and force along one axis, one must be given, not both",
                    ));
                }
                (Some(value), None) => Freedom::Prescribed(bounded("creepage", value, 1.0)?),
                (None, Some(value)) => Freedom::Loaded(finite("force", value)?),
                (None, None) => Freedom::Prescribed(0.0),
            };
        }
        Ok(freedoms)
    }
}

/// What the counterbody does next.
#[derive(Debug, Clone, Copy)]
pub enum Move<'a> {
    /// A step of sliding.
    Slide(&'a Step),
    /// Rolling at constant speed, in the steady state.
    RollSteadily(&'a Rolling),
    /// Rolling by the length of one cell.
    RollOneCell(&'a Rolling),
}

/// How tangential problems are solved.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct FrictionOptions {
    /// Largest slip of a sticking cell, or slip across the traction, over the largest displacement; also the tolerance
    /// of the normal contact, and of the pressure's change where both act on each other. Default: 1e-8.
    pub tolerance: f64,
    /// Largest number of tangential convolutions of a step. Default: 4000.
    pub max_convolutions: usize,
    /// Whether tractions act on the pressure and pressure on the slip where the bodies differ. Default: true.
    pub coupling: bool,
    /// Order of rolling in the length of a cell: 2, or 1 as in Kalker's program CONTACT, without an estimate of the error.
    /// Sliding does not depend on it. Default: 2.
    pub order: usize,
}

impl Default for FrictionOptions {
    fn default() -> Self {
        Self { tolerance: 1e-8, max_convolutions: 4000, coupling: true, order: 2 }
    }
}
