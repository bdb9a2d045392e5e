//! `nacre.stress`, and the results of evaluations of stress.

use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::arguments::keywords::Keywords;
use super::arguments::real_matrix;
use super::bodies::body;
use super::grid::PyGrid;
use crate::model::body::HalfSpace;

mod field;
pub(super) mod keywords;
mod plan;
mod summary;

pub(super) use field::PyStress;
pub(super) use plan::PyStressPlan;
pub(super) use summary::{PyInterfaceStress, PyLayerStress, PyStressSummary};

use keywords::{
    progress_docs, run_signature, section_docs, section_signature, threads_docs, traction_docs,
    traction_signature,
};

#[doc = concat!("stress(body, grid, pressure, z, *, ", section_signature!(), ", ", traction_signature!(), ", ", run_signature!(), ")\n--\n")]
/// Stress of a body under a pressure, at any depth.
///
/// Parameters
/// ----------
/// body : HalfSpace or Elastic
///     Body under the pressure; its free ends are counted, but not in the stress of friction.
/// grid : Grid
///     Cells of the pressure.
/// pressure : array_like
///     Pressure ``(nx, ny)`` on the cells [Pa], uniform over each.
/// z : float or array_like
///     Depths, at least 0 [m].
#[doc = section_docs!()]
#[doc = traction_docs!()]
#[doc = threads_docs!()]
#[doc = progress_docs!()]
///
/// Returns
/// -------
/// Stress
///     Components, invariants and displacement.
///
/// Raises
/// ------
/// ValueError
///     If an argument is out of range.
/// MemoryError
///     If the fields do not fit.
///
/// Notes
/// -----
/// The pressure is uniform over a cell. `Solution.stress` uses the pressure within cells of a solved
/// contact, and is more accurate within some cells of the surface.
///
/// Friction does not change the pressure. That is exact where the bodies are alike or
/// incompressible, and a good approximation where the friction is small: the neglected coupling
/// changes the pressure by the order of ``friction * (1 - 2 nu) / (2 - 2 nu)``.
///
/// Examples
/// --------
/// The normal stress under a uniformly loaded square, at the surface minus the pressure:
///
/// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
/// >>> grid = nacre.Grid(shape=(65, 65), size=(2e-3, 2e-3))
/// >>> field = nacre.stress(steel, grid, np.full((65, 65), 1e9), [0.0, 0.5e-3], y=0.0)
/// >>> field.zz.shape
/// (2, 65)
/// >>> bool(abs(field.zz[0, 32] + 1e9) < 1.0)
/// True
#[pyfunction]
#[pyo3(signature = (body, grid, pressure, z, **keywords), text_signature = None)]
pub(super) fn stress<'py>(
    py: Python<'py>,
    #[pyo3(from_py_with = body)] body: HalfSpace,
    grid: PyGrid,
    pressure: &Bound<'py, PyAny>,
    z: &Bound<'py, PyAny>,
    keywords: Option<&Bound<'py, PyDict>>,
) -> PyResult<PyStress> {
    let pressure = real_matrix("pressure", pressure)?;
    let (depths, one) = keywords::depths(z)?;
    let keywords = Keywords::new(py, keywords)?;
    let mut options = keywords::options(&keywords, &body)?;
    options.threads = keywords.count("threads", 1)?;
    let lines = keywords::section(&keywords, &mut options)?;
    let progress = keywords.callable("progress")?;
    keywords.finish("keywords of stress")?;
    let evaluated = keywords::watched(py, progress, move |progress| {
        let options = options.watched(progress);
        crate::stress::stress(&body, &grid.0, &pressure, &depths, options)
    })?;
    Ok(PyStress::new(evaluated, one, lines))
}
