//! Closed forms for the contact of curved bodies: what `nacre.hertz` is around.

use ndarray::ArrayD;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use super::arguments::{Real, pair, real_array, shaped};
use super::bodies::PyElastic;
use crate::model::hertz::{self, Ellipse, Line, Point};

/// Equivalent radius of two surfaces in contact, in one direction.
#[pyfunction]
pub(super) fn equivalent_radius(
    radius: Option<Real>,
    counter_radius: Option<Real>,
) -> PyResult<f64> {
    let [radius, counter_radius] = [radius, counter_radius].map(|r| r.map(|r| r.0));
    Ok(hertz::equivalent_radius(radius, counter_radius)?)
}

/// Principal relative radii of two surfaces in contact, and the angle of the axis of the longer one.
#[pyfunction]
pub(super) fn relative_radii(
    radii: &Bound<'_, PyAny>,
    counter_radii: &Bound<'_, PyAny>,
    angle: Real,
) -> PyResult<([f64; 2], f64)> {
    let radii = pair("radii", Some(radii))?;
    let counter_radii = pair("counter_radii", Some(counter_radii))?;
    Ok(hertz::relative_radii(radii, counter_radii, angle.0)?)
}

/// Contact modulus of two bodies.
#[pyfunction]
pub(super) fn contact_modulus(body: PyElastic, counterbody: Option<PyElastic>) -> f64 {
    hertz::contact_modulus(&body.0, counterbody.as_ref().map(|other| &other.0))
}

enum Form {
    Point(Point),
    Line(Line),
    Ellipse(Ellipse),
}

/// A contact after Hertz.
#[pyclass(name = "Hertz", module = "nacre._core", frozen)]
pub(super) struct PyHertz(Form);

#[pymethods]
impl PyHertz {
    #[staticmethod]
    fn point(radius: Real, contact_modulus: Real, load: Real) -> PyResult<Self> {
        Ok(Self(Form::Point(Point::new(radius.0, contact_modulus.0, load.0)?)))
    }

    #[staticmethod]
    fn line(radius: Real, contact_modulus: Real, line_load: Real) -> PyResult<Self> {
        Ok(Self(Form::Line(Line::new(radius.0, contact_modulus.0, line_load.0)?)))
    }

    #[staticmethod]
    fn ellipse(
        radius_x: Option<Real>,
        radius_y: Option<Real>,
        contact_modulus: Real,
        load: Real,
        counter_radius_x: Option<Real>,
        counter_radius_y: Option<Real>,
    ) -> PyResult<Self> {
        let radii = [
            equivalent_radius(radius_x, counter_radius_x)?,
            equivalent_radius(radius_y, counter_radius_y)?,
        ];
        Ok(Self(Form::Ellipse(Ellipse::new(radii, contact_modulus.0, load.0)?)))
    }

    /// Radius, half-width or semi-axes, peak pressure, and approach where it has a limit.
    fn numbers(&self) -> Vec<f64> {
        match &self.0 {
            Form::Point(of) => vec![of.radius, of.peak_pressure, of.approach],
            Form::Line(of) => vec![of.half_width, of.peak_pressure],
            Form::Ellipse(of) => {
                vec![of.semi_axes[0], of.semi_axes[1], of.peak_pressure, of.approach]
            }
        }
    }

    /// Pressures at coordinates, each a number or an array of one shape, by name.
    fn pressure<'py>(
        &self,
        py: Python<'py>,
        names: Vec<String>,
        coordinates: Vec<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let read =
            names.iter().zip(&coordinates).map(|(name, coordinate)| real_array(name, coordinate));
        let arrays = read.collect::<PyResult<Vec<ArrayD<f64>>>>()?;
        let [first, others @ ..] = &arrays[..] else {
            return Err(PyValueError::new_err("coordinates must be given"));
        };
        if let Some(other) = others.iter().find(|other| other.shape() != first.shape()) {
            return Err(PyValueError::new_err(format!(
                "{} must have the same shape, got {:?} and {:?}",
                names.join(" and "),
                first.shape(),
                other.shape()
            )));
        }
        let mut pressures = first.clone();
        match &self.0 {
            Form::Point(point) => pressures.mapv_inplace(|r| point.pressure(r)),
            Form::Line(line) => pressures.mapv_inplace(|y| line.pressure(y)),
            Form::Ellipse(ellipse) => {
                for y in others {
                    pressures.zip_mut_with(y, |x, y| *x = ellipse.pressure(*x, *y));
                }
            }
        }
        shaped(py, pressures)
    }

    /// Largest shear stress, and its depth.
    fn max_shear(&self, poisson: Real) -> PyResult<(f64, f64)> {
        let shear = match &self.0 {
            Form::Point(point) => point.max_shear(poisson.0)?,
            Form::Line(line) => line.max_shear(poisson.0)?,
            Form::Ellipse(ellipse) => ellipse.max_shear(poisson.0)?,
        };
        Ok((shear.stress, shear.depth))
    }
}
