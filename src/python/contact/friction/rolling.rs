//! `nacre.roll`, and the arguments that it shares with `Contact.roll`.

use std::sync::Arc;

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::keywords::{Found, found, friction};
use super::sliding::{planned, series};
use super::solution::PyFrictionSolution;
use super::{found_docs, found_signature, roll_docs, roll_signature, rolled_docs};
use crate::compliance::response::Body;
use crate::contact::Contact;
use crate::friction::{FrictionProgress, Last, Move, Rolling, RollingDirection};
use crate::model::body::HalfSpace;
use crate::model::surface::Surface;
use crate::python::arguments::keywords::{self, Keywords, motion_signature};
use crate::python::arguments::pair;
use crate::python::bodies::body;
use crate::python::contact::single::setup;
use crate::python::grid::PyGrid;
use crate::python::shapes::{Shape, shape};
use crate::python::words::Word;

/// Arguments of rolling.
pub(in crate::python::contact) struct Rolled {
    shape: Shape,
    rolling: Rolling,
    /// Cells to roll; none for the steady state.
    cells: Option<usize>,
    initial: Option<Py<PyFrictionSolution>>,
    found: Found,
}

impl Rolled {
    pub(in crate::python::contact) fn new(
        given: &Bound<'_, PyAny>,
        keywords: &Keywords,
    ) -> PyResult<Self> {
        let shape = shape(given)?.get().0.clone();
        let friction = friction(keywords)?
            .ok_or_else(|| PyValueError::new_err("friction must be given in rolling"))?;
        let direction = match keywords.optional_text("direction")? {
            Some(word) => RollingDirection::from_word(&word)?,
            None => match shape.rolling_direction() {
                Some([x, _]) if x.abs() < 0.5 => RollingDirection::PlusY,
                Some(_) => RollingDirection::PlusX,
                None => {
                    return Err(PyValueError::new_err(
                        "direction must be \"+x\", \"-x\", \"+y\" or \"-y\" for a shape that rolls in any direction",
                    ));
                }
            },
        };
        let cells = keywords.count("cells", 1)?;
        let initial: Option<Py<PyFrictionSolution>> =
            keywords.object("initial", "a nacre.types.FrictionSolution")?;
        if initial.is_some() && cells.is_none() {
            return Err(PyValueError::new_err(
                "initial must be given with cells: the steady state does not depend on it",
            ));
        }
        Ok(Self {
            rolling: Rolling {
                creepage: pair("creepage", keywords.given("creepage")?.as_ref())?,
                force: pair("force", keywords.given("force")?.as_ref())?,
                spin: keywords.real("spin", 0.0)?,
                ..Rolling::new(keywords::motion(keywords)?, friction, direction)
            },
            shape,
            cells,
            initial,
            found: found(keywords)?,
        })
    }

    pub(in crate::python::contact) fn run<'py>(
        self,
        py: Python<'py>,
        contact: &Arc<Contact>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let Self { shape, rolling, cells, initial, found } = self;
        let (options, transient) = (found.options, cells.is_some());
        let (shape, rolling) = (Arc::new(shape), Arc::new(rolling));
        let last = initial.map(|solution| Arc::clone(solution.get().inner()));
        let steps = (0..cells.unwrap_or(1)).map(|_| {
            let (contact, shape) = (Arc::clone(contact), Arc::clone(&shape));
            let rolling = Arc::clone(&rolling);
            move |last: Option<Last>, progress: &mut FrictionProgress| {
                let next = match transient {
                    true => Move::RollOneCell(&rolling),
                    false => Move::RollSteadily(&rolling),
                };
                contact.friction_step(&*shape, next, &options, last, progress)
            }
        });
        series(py, steps, last, &found, transient)
    }
}

#[doc = concat!("roll(shape, body, counterbody=None, *, grid=None, threads=None, ", motion_signature!(), ", ", roll_signature!(), ", ", found_signature!(), ")\n--\n")]
/// Presses a shape into a body, which rolls, in one call.
///
/// It chooses a grid where none is given, plans, and solves.
///
/// Parameters
/// ----------
/// shape : Shape
///     Shape that is pressed in.
/// body : HalfSpace or Elastic
///     Body that it is pressed into.
/// counterbody : HalfSpace or Elastic, optional
///     Body that carries the shape; rigid where there is none.
/// grid : Grid, optional
///     Cells of pressure and traction; by default that of `solve`.
/// threads : int, optional
///     Number of threads; all of the machine's by default.
#[doc = roll_docs!()]
#[doc = found_docs!()]
#[doc = rolled_docs!()]
///
/// Examples
/// --------
/// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
/// >>> ball = nacre.Sphere(5e-3)
/// >>> wheel = nacre.roll(ball, steel, steel, load=10.0, friction=0.3, force=(1.5, None), direction="+x")
/// >>> round(wheel.force[0], 6), wheel.creepage[0] > 0
/// (1.5, True)
#[pyfunction]
#[pyo3(signature = (shape, body, counterbody=None, **keywords), text_signature = None)]
pub(in crate::python) fn roll<'py>(
    py: Python<'py>,
    shape: &Bound<'py, PyAny>,
    #[pyo3(from_py_with = body)] body: HalfSpace,
    counterbody: Option<&Bound<'py, PyAny>>,
    keywords: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let keywords = Keywords::new(py, keywords)?;
    let grid: Option<PyGrid> = keywords.object("grid", "a nacre.Grid")?;
    let setup = setup(counterbody, &keywords)?;
    let rolled = Rolled::new(shape, &keywords)?;
    keywords.finish("keywords of roll")?;
    let motion = Some(rolled.rolling.motion);
    let contact = planned(py, (&rolled.shape, Body::from(body), setup), grid, motion)?;
    rolled.run(py, &contact)
}
