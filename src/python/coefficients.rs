//! Response of a body to loads on its surface, and planned convolutions: what `nacre.contact.compliance` is around.

use std::sync::Arc;

use ndarray::Array2;
use numpy::{IntoPyArray, PyArray2};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

use super::arguments::{Real, Repr, count, read_only, real_array, real_matrix, shaped};
use super::background::{self, Caller};
use super::bodies::{PyLayer, body, half_space, substrate};
use super::grid::PyGrid;
use crate::compliance::convolution::Convolution;
use crate::compliance::influence::{self, Method, coefficients_on};
use crate::compliance::response::{self, Body, Compliance};
use crate::error::positive;
use crate::model::body::HalfSpace;
use crate::numerics::parallel::{Threads, check_memory};

/// Normal surface displacements per unit pressure of wavenumbers.
#[pyfunction]
pub(super) fn frequency_response<'py>(
    py: Python<'py>,
    #[pyo3(from_py_with = body)] body: Body,
    wavenumber: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyAny>> {
    let mut values = real_array("wavenumber", wavenumber)?;
    py.detach(|| {
        values.iter_mut().try_for_each(|alpha| {
            *alpha = match body.half_space() {
                Some(layers) => response::frequency_response(layers, *alpha)?,
                None => body.normal(positive("wavenumber", *alpha)?) / *alpha + body.local(),
            };
            Ok::<_, crate::Error>(())
        })
    })?;
    shaped(py, values)
}

/// Surface displacements per unit traction of wavenumbers: c11, c12, c22 and ct.
#[pyfunction]
pub(super) fn surface_compliance<'py>(
    py: Python<'py>,
    #[pyo3(from_py_with = half_space)] body: HalfSpace,
    wavenumber: &Bound<'py, PyAny>,
) -> PyResult<[Bound<'py, PyAny>; 4]> {
    let wavenumbers = real_array("wavenumber", wavenumber)?;
    let at = |alpha: &f64| response::surface_compliance(&body, *alpha);
    let compliances =
        py.detach(|| wavenumbers.iter().map(at).collect::<crate::Result<Vec<_>>>())?;
    let component = |value: fn(&Compliance) -> f64| {
        let mut values = wavenumbers.clone();
        let targets = values.iter_mut().zip(&compliances);
        targets.for_each(|(target, compliance)| *target = value(compliance));
        shaped(py, values)
    };
    Ok([component(|c| c.c11)?, component(|c| c.c12)?, component(|c| c.c22)?, component(|c| c.ct)?])
}

/// Refinement of the spectral mesh where none is given.
const REFINEMENT: usize = 4;

/// Method with that name and that refinement.
fn method(word: &str, refinement: usize) -> PyResult<Method> {
    Ok(match word {
        "exact" => Method::Exact,
        "plain" => Method::Plain { refinement },
        "difference" => Method::Difference { refinement },
        "image" => Method::Image { refinement },
        "spectral" => Method::Spectral,
        other => {
            return Err(PyValueError::new_err(format!(
                "method must be \"exact\", \"plain\", \"difference\", \"image\" or \"spectral\", got {other:?}"
            )));
        }
    })
}

/// Displacements at offsets from a cell under unit pressure.
#[pyfunction]
pub(super) fn influence_coefficients<'py>(
    py: Python<'py>,
    #[pyo3(from_py_with = body)] body: Body,
    grid: PyGrid,
    method: &str,
    refinement: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let refinement = refinement.map_or(Ok(REFINEMENT), |r| count("refinement", 1, r))?;
    let method = self::method(method, refinement)?;
    let coefficients = background::run(py, None, move |_: &mut Caller<()>| {
        influence::influence_coefficients(body, &grid.0, method)
    })??;
    Ok(coefficients.into_pyarray(py))
}

/// Layers that replace a coating whose properties vary with depth.
#[pyfunction]
pub(super) fn graded_layers(
    #[pyo3(from_py_with = substrate)] substrate: crate::Substrate,
    thickness: Real,
    young: &Bound<'_, PyAny>,
    poisson: &Bound<'_, PyAny>,
    tolerance: Real,
    breakpoints: Option<&Bound<'_, PyAny>>,
) -> PyResult<Vec<PyLayer>> {
    let breakpoints: Vec<f64> = match breakpoints {
        Some(depths) => real_array("breakpoints", depths)?.into_iter().collect(),
        None => Vec::new(),
    };
    let mut failure = None;
    let at = |name: &str, property: &Bound<'_, PyAny>, z: f64| -> PyResult<f64> {
        let value = if property.is_callable() { property.call1((z,))? } else { property.clone() };
        match value.extract::<Real>() {
            Ok(number) => Ok(number.0),
            Err(_) => Err(PyTypeError::new_err(format!(
                "{name} must be a number, or a function of the depth that returns one, got {}",
                Repr(&value)
            ))),
        }
    };
    let layers = crate::graded_layers(substrate, thickness.0, tolerance.0, &breakpoints, |z| {
        let values =
            at("young", young, z).and_then(|young| Ok((young, at("poisson", poisson, z)?)));
        let (young, poisson) = values.unwrap_or_else(|error| {
            failure = Some(error);
            (f64::NAN, f64::NAN)
        });
        crate::Elastic::new(young, poisson)
    });
    match failure {
        Some(error) => Err(error),
        None => Ok(layers?.into_iter().map(PyLayer).collect()),
    }
}

/// A planned convolution.
#[pyclass(name = "Convolution", module = "nacre._core", frozen)]
pub(super) struct PyConvolution {
    convolution: Arc<Convolution>,
    coefficients: Array2<f64>,
    /// Number of threads that was asked for.
    #[pyo3(get)]
    asked_threads: Option<usize>,
}

impl PyConvolution {
    /// Plan of the coefficients that `coefficients` finds, on threads of its own.
    fn plan(
        py: Python<'_>,
        threads: Option<&Bound<'_, PyAny>>,
        coefficients: impl FnOnce(&Threads) -> crate::Result<Array2<f64>> + Send + 'static,
    ) -> PyResult<Self> {
        let asked_threads = threads.map(|n| count("threads", 1, n)).transpose()?;
        Ok(background::run(py, None, move |_: &mut Caller<()>| {
            let threads = Arc::new(Threads::new(asked_threads)?);
            let coefficients = coefficients(&threads)?;
            let convolution = Arc::new(Convolution::plan_on(&coefficients, threads)?);
            Ok::<_, crate::Error>(Self { convolution, coefficients, asked_threads })
        })??)
    }
}

#[pymethods]
impl PyConvolution {
    #[new]
    fn new(
        py: Python<'_>,
        coefficients: &Bound<'_, PyAny>,
        threads: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let coefficients = real_matrix("coefficients", coefficients)?;
        Self::plan(py, threads, move |_| Ok(coefficients))
    }

    /// Convolution with the exact influence coefficients of one or two bodies.
    #[staticmethod]
    fn of_bodies(
        py: Python<'_>,
        #[pyo3(from_py_with = body)] body: Body,
        grid: PyGrid,
        counterbody: Option<&Bound<'_, PyAny>>,
        threads: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let counterbody = counterbody.map(self::body).transpose()?;
        Self::plan(py, threads, move |threads| {
            let grid = grid.0;
            check_memory(grid.shape(), Convolution::memory(grid.shape()))?;
            let mut sum = coefficients_on(&*body, &grid, Method::Exact, threads)?;
            if let Some(counterbody) = counterbody {
                sum += &coefficients_on(&*counterbody, &grid, Method::Exact, threads)?;
            }
            Ok(sum)
        })
    }

    fn apply<'py>(
        &self,
        py: Python<'py>,
        pressure: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let pressure = real_matrix("pressure", pressure)?;
        let displacement = py.detach(|| self.convolution.apply(&pressure))?;
        Ok(displacement.into_pyarray(py))
    }

    fn coefficients<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        read_only(py, self.coefficients.clone())
    }

    fn shape(&self) -> (usize, usize) {
        self.convolution.shape().into()
    }

    fn threads(&self) -> usize {
        self.convolution.threads()
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.coefficients == other.coefficients && self.asked_threads == other.asked_threads
    }
}
