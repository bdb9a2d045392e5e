//! Keywords of friction: signature, documentation and meaning of each.

use pyo3::prelude::*;

use crate::friction::{Friction, FrictionOptions, RollingDirection};
use crate::python::arguments::keywords::Keywords;
use crate::python::arguments::{real_array, real_matrix};
use crate::python::words::Word;

/// Signature of the keywords that say how tractions are found.
macro_rules! found_signature {
    () => {
        "tolerance=1e-8, max_convolutions=4000, coupling=True, initial=None, progress=None, check=True"
    };
}

/// Documentation of the keywords of `found_signature`.
macro_rules! found_docs {
    () => {
        "\
tolerance : float, optional
    Largest slip of a sticking cell, or slip across the traction, over the largest displacement; also the
    tolerance of the pressure. Above 0 and below 1.
max_convolutions : int, optional
    Tangential convolutions of a step before it gives up.
coupling : bool, optional
    Whether tractions act on the pressure and pressure on the slip. Between equal bodies neither is so.
initial : FrictionSolution, optional
    State to go on from: the last step of an earlier history, on the same grid. It carries tractions and shift, and no
    pressure, which is solved afresh. By default the surfaces have not touched.
progress : callable, optional
    Function that is called with the number of the step and a `FrictionReport` at each convolution; returning
    False stops, and gives the unfinished solution, with tractions and shift as before the step: with it as
    `initial`, the same step goes on.
check : bool, optional
    Whether to raise an error if the tolerance was not met."
    };
}

/// Signature of the keywords of sliding.
macro_rules! slide_signature {
    () => {
        "friction=None, shift=None, force=None, twist=None, torque=None"
    };
}

/// Documentation of the arguments of sliding.
macro_rules! slide_docs {
    () => {
        "\
steps : iterable of mapping, optional
    Steps of a history, each a mapping of the keywords from `load` to `torque`. Motion along z and friction
    that a step does not give stay as in the step before; at first, they are those of the call.
load, approach, eccentricity, moment, tilt : optional
    Motion along z, as `Contact.solve` explains.
friction : float or array_like
    Coefficient of friction, at least 0: one number, or one for each cell ``(nx, ny)``.
shift : tuple of float or None, optional
    Shift ``(d_x, d_y)`` of the counterbody over the body at the end of the step [m], since the first touch.
    None: it stays where it is, unless there is a force.
force : tuple of float or None, optional
    Forces ``(∬ q_x dA, ∬ q_y dA)`` of the tractions on the body [N]; the shift along an axis with a number is
    found.
twist : float, optional
    Rotation of the counterbody over the body about the z axis [rad], since the first touch.
torque : float, optional
    Torque ``∬ (x q_y - y q_x) dA`` of the tractions on the body [N m]; the twist is found."
    };
}

/// What sliding returns and raises.
macro_rules! slid_docs {
    () => {
        "
Returns
-------
FrictionSolution or list of FrictionSolution
    Tractions, slip, and all of the normal contact; a list where there are `steps`.

Raises
------
ValueError
    If an argument is out of range, friction cannot bear the force, a body has free ends or a frictionless
    interface, or is known by its normal response alone.
ConvergenceError
    If the tolerance was not met; the unfinished solution is its `solution`.

Notes
-----
Coulomb's law holds in each cell. The bodies are half-spaces, and all is quasi-static. Once a history has
begun, every exception that ends it, `KeyboardInterrupt` included, carries the finished steps as `solutions`.
With the last of them as `initial`, the history goes on to the bit."
    };
}

/// Signature of the keywords of rolling.
macro_rules! roll_signature {
    () => {
        "friction=None, creepage=None, force=None, spin=0.0, direction=None, cells=None"
    };
}

/// Documentation of the arguments of rolling.
macro_rules! roll_docs {
    () => {
        "\
load, approach, eccentricity, moment, tilt : optional
    Motion along z, as `Contact.solve` explains.
friction : float or array_like
    Coefficient of friction, at least 0: one number, or one for each cell ``(nx, ny)``.
creepage : tuple of float or None, optional
    Creepages ``(xi, eta)`` of the counterbody over the body, along the direction of rolling e and along
    z × e: relative velocities over the speed of rolling, which are small in the linear theory: above 0.1 a
    warning says so. None: 0, unless there is a force.
force : tuple of float or None, optional
    Forces of the tractions on the body along e and along z × e [N]; the creepage along an axis with a number
    is found.
spin : float, optional
    Relative angular velocity about the z axis over the speed of rolling [1/m].
direction : {\"+x\", \"-x\", \"+y\", \"-y\"}, optional
    Direction of rolling, in which the leading edge lies; \"+y\" for shapes that roll across the x axis, as
    rollers do. Other shapes need it.
cells : int, optional
    Number of cells to roll from `initial` on, or from the first touch. By default the steady state is found."
    };
}

/// What rolling returns and raises.
macro_rules! rolled_docs {
    () => {
        "
Returns
-------
FrictionSolution or list of FrictionSolution
    Steady state; a list with one solution for each cell rolled where `cells` is given.

Raises
------
ValueError
    As `Contact.slide`; and if the contact touches the edge of the grid in the direction of rolling.
ConvergenceError
    If the tolerance was not met; the unfinished solution is its `solution`.

Notes
-----
Material flows against the direction of rolling. The change of displacement over a cell stands for its
derivative (Kalker 1990), so that forces are right to the first order of the cells."
    };
}

pub(in crate::python::contact) use {
    found_docs, found_signature, roll_docs, roll_signature, rolled_docs, slid_docs, slide_docs,
    slide_signature,
};

/// Coefficient of friction.
pub(super) fn friction(keywords: &Keywords) -> PyResult<Option<Friction>> {
    let Some(given) = keywords.given("friction")? else {
        return Ok(None);
    };
    let values = real_array("friction", &given)?;
    if values.ndim() == 0 {
        return Ok(Some(Friction::Uniform(values.sum())));
    }
    Ok(Some(Friction::Cells(real_matrix("friction", &given)?)))
}

/// How tractions are found, the callback and the check.
pub(super) struct Found {
    pub(super) options: FrictionOptions,
    pub(super) progress: Option<Py<PyAny>>,
    pub(super) check: bool,
}

pub(super) fn found(keywords: &Keywords) -> PyResult<Found> {
    let default = FrictionOptions::default();
    let most = keywords.count("max_convolutions", 1)?;
    Ok(Found {
        options: FrictionOptions {
            tolerance: keywords.real("tolerance", default.tolerance)?,
            max_convolutions: most.unwrap_or(default.max_convolutions),
            coupling: keywords.flag("coupling", default.coupling)?,
        },
        progress: keywords.callable("progress")?,
        check: keywords.flag("check", true)?,
    })
}

impl Word for RollingDirection {
    const ARGUMENT: &'static str = "direction";
    const VALUES: &'static [Self] = &[Self::PlusX, Self::MinusX, Self::PlusY, Self::MinusY];

    fn word(self) -> &'static str {
        match self {
            Self::PlusX => "+x",
            Self::MinusX => "-x",
            Self::PlusY => "+y",
            Self::MinusY => "-y",
        }
    }
}
