//! One solve: `nacre.solve`, and the arguments that it shares with `Contact.solve`.

use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::friction::solved;
use crate::compliance::response::Body;
use crate::contact::{Contact, Motion, Options, Progress, Setup, Solution, solve_with};
use crate::model::body::HalfSpace;
use crate::model::grid::Grid;
use crate::python::arguments::keywords::{
    self, Keywords, Single, motion_docs, motion_signature, search_docs, search_signature,
    single_docs, single_signature,
};
use crate::python::background;
use crate::python::bodies::body;
use crate::python::grid::PyGrid;
use crate::python::shapes::{Shape, shape};
use crate::python::solution::{PyReport, PySolution};

/// Setup of a plan with the coefficients of the bodies.
pub(super) fn setup(
    counterbody: Option<&Bound<'_, PyAny>>,
    keywords: &Keywords,
) -> PyResult<Setup> {
    Ok(Setup {
        counterbody: counterbody.map(body).transpose()?.map(Body::from),
        coefficients: None,
        threads: keywords.count("threads", 1)?,
    })
}

#[doc = concat!("solve(shape, body, counterbody=None, *, grid=None, threads=None, ", motion_signature!(), ", ", search_signature!(), ", ", single_signature!(), ")\n--\n")]
/// Presses a shape into a body, in one call: chooses a grid where none is given, plans, solves.
///
/// By default the grid of a height map is its own. Any other shape gets a grid that holds the whole
/// contact, with 64 cells across its narrower width, oblong where the contact is long, and a margin of a
/// quarter of the contact on every side. The cells are divided until the estimated error of the peak
/// pressure (``report.discretisation``) is at most 1 %; where that needs more than 2²² cells, or does
/// not lower the estimate, a warning says so.
///
/// Parameters
/// ----------
/// shape : Shape
///     Shape that is pressed in.
/// body : HalfSpace or Elastic
///     Body that it is pressed into.
/// counterbody : HalfSpace or Elastic, optional
///     Body that carries the shape; rigid where there is none. A roller of finite length ends on both
///     sides: ``HalfSpace(steel, ends=roller.ends)``.
/// grid : Grid, optional
///     Cells of the pressure; by default those of an `initial` solution whose surfaces have a permanent indentation.
///     An endless shape, such as a cylinder, needs a grid.
/// threads : int, optional
///     Number of threads; all of the machine's by default.
#[doc = motion_docs!()]
#[doc = search_docs!()]
#[doc = single_docs!()]
///
/// Returns
/// -------
/// Solution
///     Pressure, gap, displacement, approach and tilt.
///
/// Raises
/// ------
/// ValueError
///     If an argument is out of range, the arguments contradict each other, no grid is found, a free end of a
///     body lies within a cell, or the counterbody ends within the shape that it carries.
/// ConvergenceError
///     If the tolerance was not met; the unfinished solution is its `solution`.
///
/// See Also
/// --------
/// Contact.solve : explains the degrees of freedom of the motion.
///
/// Examples
/// --------
/// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
/// >>> dlc = nacre.Elastic(young=420e9, poisson=0.3)
/// >>> body = nacre.HalfSpace(steel, layers=[nacre.Layer(dlc, thickness=40e-6)])
/// >>> roller = nacre.Roller(radius=5e-3, flat_length=19.13e-3, crown_radius=7.5)
/// >>> solution = nacre.solve(roller, body, load=1e3, eccentricity=(2.87e-3, None))
/// >>> round(solution.eccentricity[0], 8)
/// 0.00287
#[pyfunction]
#[pyo3(signature = (shape, body, counterbody=None, **keywords), text_signature = None)]
pub(in crate::python) fn solve<'py>(
    py: Python<'py>,
    shape: &Bound<'py, PyAny>,
    #[pyo3(from_py_with = body)] body: HalfSpace,
    counterbody: Option<&Bound<'py, PyAny>>,
    keywords: Option<&Bound<'py, PyDict>>,
) -> PyResult<PySolution> {
    let keywords = Keywords::new(py, keywords)?;
    let grid: Option<PyGrid> = keywords.object("grid", "a nacre.Grid")?;
    let setup = setup(counterbody, &keywords)?;
    let call = Call::new(shape, &keywords)?;
    keywords.finish("keywords of solve")?;
    let body = Body::from(body);
    let initial = call.initial;
    let dented = initial.filter(|_| call.options.indentation.is_some());
    let grid = grid.map(|grid| grid.0).or(dented);
    call.run(py, move |shape, motion, options, progress| match grid {
        Some(grid) => {
            grid.check_initial(initial.as_ref())?;
            Contact::plan(&body, grid, setup)?.solve(shape, motion, options.watched(progress))
        }
        None => {
            let solution = solve_with(shape, &body, &setup, motion, options.watched(progress))?;
            solution.grid().check_initial(initial.as_ref())?;
            Ok(solution)
        }
    })
}

/// Arguments that `solve` and `Contact.solve` share.
pub(super) struct Call {
    shape: Shape,
    motion: Motion,
    options: Options,
    /// Grid of the solution to start from.
    pub(super) initial: Option<Grid>,
    progress: Option<Py<PyAny>>,
    check: bool,
}

impl Call {
    pub(super) fn new(shape: &Bound<'_, PyAny>, keywords: &Keywords) -> PyResult<Self> {
        let motion = keywords::motion(keywords)?;
        let Single { mut options, initial, progress, check } = keywords::single(keywords)?;
        let mut grid = None;
        if let Some(before) = initial {
            if let Ok(before) = before.cast::<PySolution>() {
                let before = before.get().solution();
                options.indentation.clone_from(&before.indentation);
                grid = Some(*before.grid());
            } else if let Some(before) = solved(&before) {
                grid = Some(*before.grid());
            }
        }
        Ok(Self {
            shape: self::shape(shape)?.get().0.clone(),
            motion,
            options,
            initial: grid,
            progress,
            check,
        })
    }

    /// Runs `work` in the background; Ctrl-C and the callback can stop it.
    pub(super) fn run(
        self,
        py: Python<'_>,
        work: impl FnOnce(&Shape, &Motion, &Options, &mut Progress) -> crate::Result<Solution>
        + Send
        + 'static,
    ) -> PyResult<PySolution> {
        let Self { shape, motion, options, progress, check, .. } = self;
        let tolerance = options.tolerance;
        let pressed = shape.clone();
        let solution = background::run(py, progress, move |caller| {
            work(&shape, &motion, &options, &mut |report| {
                caller.ask(|| (PyReport(report.clone()),))
            })
        })?;
        PySolution::finished(py, solution?, &pressed, tolerance, check)
    }
}
