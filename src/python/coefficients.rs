//! Response of a body to loads on its surface: `nacre.frequency_response`, `nacre.surface_compliance`,
//! `nacre.influence_coefficients`, `nacre.graded_layers` and `nacre.Convolution`.

use numpy::{IntoPyArray, PyArray2};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

use super::arguments::{Real, Repr, count, items, real_array};
use super::background::{self, Caller};
use super::bodies::{PyLayer, body, substrate};
use super::grid::PyGrid;
use crate::compliance::influence::{self, Method};
use crate::compliance::response::{self, Compliance};

mod convolution;

pub(super) use convolution::PyConvolution;

/// Normal surface displacement per unit pressure of one wavenumber.
///
/// Parameters
/// ----------
/// body : HalfSpace or Elastic
///     Body under the pressure; its free ends are not counted.
/// wavenumber : float or array_like
///     ``alpha = sqrt(m**2 + n**2)`` [1/m], above 0, of any shape.
///
/// Returns
/// -------
/// float or numpy.ndarray
///     ``u_z/p`` [m/Pa], in the shape of `wavenumber`. For one layer it equals the formula of Nogi &
///     Kato, J. Tribol. 119 (1997) 493, with the sign of its denominator corrected.
///
/// Raises
/// ------
/// ValueError
///     If a wavenumber is not finite and above 0.
///
/// Examples
/// --------
/// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
/// >>> alpha = 1e3
/// >>> round(nacre.frequency_response(steel, alpha) * alpha * steel.plane_strain_modulus, 12)
/// 2.0
#[pyfunction]
pub(super) fn frequency_response<'py>(
    py: Python<'py>,
    #[pyo3(from_py_with = body)] body: crate::HalfSpace,
    wavenumber: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyAny>> {
    let mut values = real_array("wavenumber", wavenumber)?;
    py.detach(|| {
        values.iter_mut().try_for_each(|alpha| {
            *alpha = response::frequency_response(&body, *alpha)?;
            Ok::<_, crate::Error>(())
        })
    })?;
    if values.ndim() == 0 {
        return Ok(values.sum().into_pyobject(py)?.into_any());
    }
    Ok(values.into_pyarray(py).into_any())
}

/// Surface displacements per unit traction of one wavenumber, normal and lateral.
///
/// With the x axis along the wave, under pressure p and tractions q_x, q_y on the body::
///
///     u_z = c11 p - i c12 q_x      u_x = i c12 p + c22 q_x      u_y = ct q_y
///
/// Parameters
/// ----------
/// body : HalfSpace or Elastic
///     Body under the tractions; its free ends are not counted.
/// wavenumber : float or array_like
///     ``alpha = sqrt(m**2 + n**2)`` [1/m], above 0, of any shape.
///
/// Returns
/// -------
/// SurfaceCompliance
///     Named tuple ``(c11, c12, c22, ct)`` of numbers or arrays [m/Pa] in the shape of `wavenumber`;
///     ``c11`` equals `frequency_response`.
///
/// Raises
/// ------
/// TypeError
///     If the wavenumbers are not real numbers.
/// ValueError
///     If a wavenumber is not finite and above 0.
///
/// Examples
/// --------
/// On a half-space ``c12/c11 = (1 - 2 nu)/(2 - 2 nu)``:
///
/// >>> compliance = nacre.surface_compliance(nacre.Elastic(young=1.0, poisson=0.25), [1.0, 2.0])
/// >>> (compliance.c12 / compliance.c11).round(12)
/// array([0.33333333, 0.33333333])
#[pyfunction]
pub(super) fn surface_compliance<'py>(
    py: Python<'py>,
    #[pyo3(from_py_with = body)] body: crate::HalfSpace,
    wavenumber: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyAny>> {
    let wavenumbers = real_array("wavenumber", wavenumber)?;
    let at = |alpha: &f64| response::surface_compliance(&body, *alpha);
    let compliances =
        py.detach(|| wavenumbers.iter().map(at).collect::<crate::Result<Vec<_>>>())?;
    let component = |value: fn(&Compliance) -> f64| {
        let mut values = wavenumbers.clone();
        let targets = values.iter_mut().zip(&compliances);
        targets.for_each(|(target, compliance)| *target = value(compliance));
        match values.ndim() {
            0 => values.sum().into_pyobject(py).map(Bound::into_any),
            _ => Ok(values.into_pyarray(py).into_any()),
        }
    };
    let components =
        (component(|c| c.c11)?, component(|c| c.c12)?, component(|c| c.c22)?, component(|c| c.ct)?);
    let class = py.import("nacre._compliance")?.getattr("SurfaceCompliance")?;
    class.call1(components)
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

/// Displacement at offsets from a cell under unit pressure.
///
/// Parameters
/// ----------
/// body : HalfSpace or Elastic
///     Body under the pressure; its free ends are not counted.
/// grid : Grid
///     Grid with that cell; there is an offset for each of its cells.
/// method : {"exact", "plain", "difference", "image", "spectral"}, optional
///     ``"exact"`` has no aliasing, for any thickness and any cell. The other methods sample a
///     frequency response and transform it back: ``"plain"`` the response of the body;
///     ``"difference"`` its difference from the response of a half-space of the coating's material;
///     ``"image"`` the remainder of that difference beside an image potential. ``"plain"`` and
///     ``"difference"`` are inaccurate on long thin domains; ``"image"`` needs layers thicker than a
///     cell. On a periodic grid, ``"exact"`` sums over the images of the cell; ``"spectral"`` samples the response at
///     the waves of a grid that repeats in both directions, as other programs do.
/// refinement : int, optional
///     Refinement of the spectral mesh of the conversions.
///
/// Returns
/// -------
/// numpy.ndarray
///     Coefficients ``(nx, ny)`` [m/Pa] of the offsets ``(i dx, j dy)``, ``i, j >= 0``.
///
/// Raises
/// ------
/// ValueError
///     If the method is another word or the refinement is below 1.
/// MemoryError
///     If the grid does not fit.
///
/// Examples
/// --------
/// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
/// >>> grid = nacre.Grid(shape=(8, 8), size=(8e-6, 8e-6))
/// >>> nacre.influence_coefficients(steel, grid).shape
/// (8, 8)
#[pyfunction]
#[pyo3(signature = (body, grid, method="exact", refinement=None))]
pub(super) fn influence_coefficients<'py>(
    py: Python<'py>,
    #[pyo3(from_py_with = body)] body: crate::HalfSpace,
    grid: PyGrid,
    method: &str,
    refinement: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let refinement = refinement.map_or(Ok(REFINEMENT), |r| count("refinement", 1, r))?;
    let method = self::method(method, refinement)?;
    let coefficients = background::run(py, None, move |_: &mut Caller<()>| {
        influence::influence_coefficients(&body, &grid.0, method)
    })??;
    Ok(coefficients.into_pyarray(py))
}

/// Layers that replace a coating whose properties vary with depth.
///
/// The functions are evaluated at two thousand depths, and wherever neighbours differ, the interval is
/// bisected: jumps are located to rounding, and steep parts are set apart. Each section between them is
/// cut into equal layers with the properties at their middle, and their number is doubled until the
/// frequency response, at wavelengths down to a fifth of the thickness, is within `tolerance` of its limit
/// by two estimates: the last two doublings, and the mean properties that the search found in each layer.
///
/// No number of samples shows what lies between them: a feature thinner than a thousandth of the
/// thickness may be missed, unless one of `breakpoints` lies on it.
///
/// Parameters
/// ----------
/// substrate : Elastic or nacre.RIGID
///     Material below the coating.
/// thickness : float
///     Thickness of the coating [m].
/// young : float or callable
///     Young's modulus [Pa], or a function of the depth z [m] that returns it.
/// poisson : float or callable
///     Poisson's ratio, or a function of the depth.
/// tolerance : float, optional
///     Relative error of the frequency response.
/// breakpoints : sequence of float, optional
///     Depths [m] of jumps and of thin features that are known. A section begins at each, and its
///     neighbourhood is searched down to a trillionth of the thickness.
///
/// Returns
/// -------
/// list of Layer
///     Layers from the surface down.
///
/// Raises
/// ------
/// ValueError
///     If an argument is out of range, the functions vary at every scale, as noise does, or 4096 layers do
///     not meet the tolerance.
///
/// Examples
/// --------
/// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
/// >>> layers = nacre.graded_layers(steel, 10e-6, young=lambda z: 420e9 - 21e15 * z, poisson=0.3)
/// >>> len(layers)
/// 64
/// >>> body = nacre.HalfSpace(steel, layers)
///
/// An adhesive of 20 nm is found where a breakpoint tells of it:
///
/// >>> glued = lambda z: 1e9 if abs(z - 5e-6) < 10e-9 else 210e9
/// >>> len(nacre.graded_layers(steel, 10e-6, glued, 0.3, breakpoints=[5e-6]))
/// 3
#[pyfunction]
#[pyo3(
    signature = (substrate, thickness, young, poisson, tolerance=Real(1e-3), breakpoints=None),
    text_signature = "(substrate, thickness, young, poisson, tolerance=0.001, breakpoints=None)"
)]
pub(super) fn graded_layers(
    #[pyo3(from_py_with = substrate)] substrate: crate::Substrate,
    thickness: Real,
    young: &Bound<'_, PyAny>,
    poisson: &Bound<'_, PyAny>,
    tolerance: Real,
    breakpoints: Option<&Bound<'_, PyAny>>,
) -> PyResult<Vec<PyLayer>> {
    let breakpoints: Vec<Real> = match breakpoints {
        Some(depths) => items("breakpoints", "real numbers", depths)?,
        None => Vec::new(),
    };
    let breakpoints: Vec<f64> = breakpoints.iter().map(|depth| depth.0).collect();
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
