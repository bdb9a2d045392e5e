//! Keyword arguments: signature, documentation and meaning of each stand here, once for every function
//! that takes it.
//!
//! A function takes `**keywords`, and the macros here spell out its signature and its documentation. To
//! add a keyword to all solves, add it to `search_signature`, `search_docs` and [`options`], and its type
//! to `python/nacre/_keywords.py`, from which type stubs and case files take it.

use pyo3::conversion::FromPyObjectOwned;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyMapping};

use super::{Real, Repr, count, number, pair, real_array, real_matrix};
use crate::contact::{Hardness, Motion, Options};
use crate::python::words::Word;

/// Signature of the keywords that say what is asked of the rigid motion.
macro_rules! motion_signature {
    () => {
        "load=None, approach=None, eccentricity=None, moment=None, tilt=None"
    };
}

/// Documentation of the keywords of `motion_signature`.
macro_rules! motion_docs {
    () => {
        "\
load : float, optional
    Force W that presses the bodies together [N], above 0; a force per length [N/m] on a
    `Grid.line`. Either `load` or `approach` is given.
approach : float, optional
    Distance by which the shape moves towards the body at x = y = 0 [m], from the position in
    which the plane h = 0 of the shape lies on the surface of the body. Below 0 the bodies are
    apart.
eccentricity : tuple of float or None, optional
    Point ``(e_x, e_y)`` at which the load acts [m]. Along a direction with a number the shape is
    free to tilt, and the tilt that balances the moment is found; along a direction with None
    it is not, and the tilt is 0 or what `tilt` says. It needs `load`, and the point must
    lie inside the region that can touch.
moment : tuple of float or None, optional
    First moments of the pressure about x = y = 0, ``(∬ p x dA, ∬ p y dA)`` [N m]: load times
    eccentricity, for contacts under a given approach too. None has the meaning that it has in
    `eccentricity`.
tilt : tuple of float or None, optional
    Slopes ``(s_x, s_y)`` by which the shape is turned [rad]: at positive x, a positive s_x brings
    it nearer to the body. None stands for 0 along a direction without eccentricity or moment."
    };
}

/// Signature of the keywords that say how a solution is found.
macro_rules! search_signature {
    () => {
        "hardness=None, tolerance=1e-8, max_iterations=None, algorithm='cascade'"
    };
}

/// Documentation of the keywords of `search_signature`.
macro_rules! search_docs {
    () => {
        "\
hardness : float or array_like, optional
    Largest pressure H that the surfaces bear [Pa], above 0, of all cells or of each, ``(nx, ny)``: cells that would
    bear more yield, and keep a permanent indentation (``Solution.indentation``). By default they do not yield.
tolerance : float, optional
    Largest `Report.residual` and `Report.overlap` of a converged solution, both relative, above 0
    and below 1.
max_iterations : int, optional
    Iterations of one solve before it gives up; 10 000 by default.
algorithm : {\"cascade\", \"polonsky-keer\"}, optional
    Preconditioned conjugate gradients on nested grids, in a window around the contact; or the
    method of Polonsky and Keer (doi:10.1016/S0043-1648(99)00113-1), as a reference."
    };
}

/// Signature of the keywords that only a single solve takes.
macro_rules! single_signature {
    () => {
        "initial=None, progress=None, check=True"
    };
}

/// Documentation of the keywords of `single_signature`.
macro_rules! single_docs {
    () => {
        "\
initial : Solution or array_like, optional
    Pressure to start from ``(nx, ny)`` [Pa], at least 0: a solution near the one that is
    sought, on the same grid, such as the previous one of a series. The result does not depend on it, but that the surfaces keep
    the permanent indentation of a solution: a history of loads goes from one to the next.
progress : callable, optional
    Function that is called with a `Report` at each iteration; returning False stops, and gives
    the unfinished solution.
check : bool, optional
    Whether to raise an error if the tolerance was not met."
    };
}

pub(in crate::python) use {
    motion_docs, motion_signature, search_docs, search_signature, single_docs, single_signature,
};

/// Rigid motion that is asked.
pub(in crate::python) fn motion(keywords: &Keywords) -> PyResult<Motion> {
    Ok(Motion {
        load: number("load", keywords.given("load")?.as_ref())?,
        approach: number("approach", keywords.given("approach")?.as_ref())?,
        eccentricity: pair("eccentricity", keywords.given("eccentricity")?.as_ref())?,
        moment: pair("moment", keywords.given("moment")?.as_ref())?,
        tilt: pair("tilt", keywords.given("tilt")?.as_ref())?,
    })
}

/// Way in which a solution is found, from a uniform pressure.
pub(in crate::python) fn options(keywords: &Keywords) -> PyResult<Options> {
    let default = Options::default();
    Ok(Options {
        tolerance: keywords.real("tolerance", default.tolerance)?,
        max_iterations: keywords.count("max_iterations", 0)?,
        algorithm: keywords.word("cascade")?,
        initial: None,
        hardness: hardness(keywords)?,
        indentation: None,
    })
}

/// Largest pressure that the surfaces bear.
fn hardness(keywords: &Keywords) -> PyResult<Option<Hardness>> {
    let Some(given) = keywords.given("hardness")? else {
        return Ok(None);
    };
    let values = real_array("hardness", &given)?;
    Ok(Some(match values.ndim() {
        0 => Hardness::Uniform(values.sum()),
        _ => Hardness::Cells(real_matrix("hardness", &given)?),
    }))
}

/// What only a single solve takes.
pub(in crate::python) struct Single<'py> {
    pub(in crate::python) options: Options,
    /// What the options start from.
    pub(in crate::python) initial: Option<Bound<'py, PyAny>>,
    pub(in crate::python) progress: Option<Py<PyAny>>,
    pub(in crate::python) check: bool,
}

/// Options, callback and check of a single solve.
pub(in crate::python) fn single<'py>(keywords: &Keywords<'py>) -> PyResult<Single<'py>> {
    let (mut options, mut given) = (options(keywords)?, None);
    if let Some(initial) = keywords.given("initial")? {
        let pressure = initial.getattr_opt("pressure")?;
        let pressure = pressure.as_ref().unwrap_or(&initial);
        options.initial = Some(real_matrix("initial", pressure)?);
        given = Some(initial);
    }
    Ok(Single {
        options,
        initial: given,
        progress: keywords.callable("progress")?,
        check: keywords.flag("check", true)?,
    })
}

/// Keyword arguments of one call. Each is taken once; [`Keywords::finish`] refuses the others.
pub(in crate::python) struct Keywords<'py> {
    given: Bound<'py, PyDict>,
    taken: Bound<'py, PyDict>,
}

impl<'py> Keywords<'py> {
    /// Keywords that pyo3 collected.
    pub(in crate::python) fn new(
        py: Python<'py>,
        given: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Self> {
        Ok(Self {
            given: given.map_or_else(|| Ok(PyDict::new(py)), |given| given.copy())?,
            taken: PyDict::new(py),
        })
    }

    /// Keywords of a mapping.
    pub(in crate::python) fn of_mapping(mapping: &Bound<'py, PyMapping>) -> PyResult<Self> {
        let given = PyDict::new(mapping.py());
        given.update(mapping)?;
        Self::new(mapping.py(), Some(&given))
    }

    /// Argument as it was given, `None` included.
    fn take(&self, name: &str) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.taken.set_item(name, true)?;
        let found = self.given.get_item(name)?;
        if found.is_some() {
            self.given.del_item(name)?;
        }
        Ok(found)
    }

    /// Argument as it was given; `None` where it was not.
    pub(in crate::python) fn any(&self, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let none = || self.given.py().None().into_bound(self.given.py());
        Ok(self.take(name)?.unwrap_or_else(none))
    }

    /// Argument that was given and is not `None`.
    pub(in crate::python) fn given(&self, name: &str) -> PyResult<Option<Bound<'py, PyAny>>> {
        Ok(self.take(name)?.filter(|value| !value.is_none()))
    }

    /// Argument of type `T`, or the default; `kind` describes it in the error.
    fn typed<T: FromPyObjectOwned<'py>>(&self, name: &str, kind: &str, default: T) -> PyResult<T> {
        let Some(value) = self.take(name)? else {
            return Ok(default);
        };
        value.extract().map_err(|_| {
            PyTypeError::new_err(format!("{name} must be {kind}, got {}", Repr(&value)))
        })
    }

    /// Object of a class that `kind` describes.
    pub(in crate::python) fn object<T: FromPyObjectOwned<'py>>(
        &self,
        name: &str,
        kind: &str,
    ) -> PyResult<Option<T>> {
        self.typed(name, kind, None)
    }

    /// Real number.
    pub(in crate::python) fn real(&self, name: &str, default: f64) -> PyResult<f64> {
        Ok(self.typed(name, "a real number", Real(default))?.0)
    }

    /// Real number that may be missing.
    pub(in crate::python) fn optional_real(&self, name: &str) -> PyResult<Option<f64>> {
        number(name, self.given(name)?.as_ref())
    }

    /// Truth value.
    pub(in crate::python) fn flag(&self, name: &str, default: bool) -> PyResult<bool> {
        self.typed(name, "a bool", default)
    }

    /// Text.
    pub(in crate::python) fn text(&self, name: &str, default: &str) -> PyResult<String> {
        self.typed(name, "a str", default.to_owned())
    }

    /// Text that may be missing.
    pub(in crate::python) fn optional_text(&self, name: &str) -> PyResult<Option<String>> {
        let value = self.given(name)?;
        let text = |value: Bound<'_, PyAny>| {
            value.extract::<String>().map_err(|_| {
                PyTypeError::new_err(format!("{name} must be a str, got {}", Repr(&value)))
            })
        };
        value.map(text).transpose()
    }

    /// Value that the argument [`Word::ARGUMENT`] names by a word.
    pub(in crate::python) fn word<W: Word>(&self, default: &str) -> PyResult<W> {
        W::from_word(&self.text(W::ARGUMENT, default)?)
    }

    /// Integer of at least `least`.
    pub(in crate::python) fn count(&self, name: &str, least: usize) -> PyResult<Option<usize>> {
        let value = self.given(name)?;
        value.map(|value| count(name, least, &value)).transpose()
    }

    /// Function.
    pub(in crate::python) fn callable(&self, name: &str) -> PyResult<Option<Py<PyAny>>> {
        match self.given(name)? {
            Some(value) if !value.is_callable() => {
                Err(PyTypeError::new_err(format!("{name} must be callable, got {}", Repr(&value))))
            }
            value => Ok(value.map(Bound::unbind)),
        }
    }

    /// Ends the reading.
    ///
    /// # Errors
    /// A `TypeError` if a keyword was given that nobody took; it lists those that `what` takes.
    pub(in crate::python) fn finish(&self, what: &str) -> PyResult<()> {
        match self.given.keys().iter().next() {
            None => Ok(()),
            Some(other) => Err(PyTypeError::new_err(format!(
                "{what} must be among {}, got {}",
                self.known()?,
                Repr(&other)
            ))),
        }
    }

    fn known(&self) -> PyResult<String> {
        let names: Vec<String> = self.taken.keys().extract()?;
        Ok(names.join(", "))
    }
}
