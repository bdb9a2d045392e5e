//! `nacre.indent.Adhesion`.

use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::indent::Adhesion;
use crate::python::arguments::{Real, hash};

/// Adhesion of tip and surface, made by one of its static methods.
///
/// Examples
/// --------
/// >>> nacre.indent.Adhesion.jkr(work=0.05)
/// Adhesion.jkr(work=0.05)
#[pyclass(name = "Adhesion", module = "nacre.indent", frozen, eq, from_py_object)]
#[derive(Clone, PartialEq)]
pub(in crate::python) struct PyAdhesion(pub(in crate::python) Adhesion);

#[pymethods]
impl PyAdhesion {
    /// Adhesion within the contact, of this work [J/m^2]: Johnson, Kendall & Roberts, Proc. R. Soc. Lond. A 324 (1971) 301,
    /// doi:10.1098/rspa.1971.0141.
    #[staticmethod]
    fn jkr(work: Real) -> PyResult<Self> {
        Ok(Self(Adhesion::Jkr { work: work.0 }.checked()?))
    }

    /// A force 2 pi w R around the contact that does not deform: Derjaguin, Muller & Toporov, J. Colloid Interface Sci. 53 (1975) 314,
    /// doi:10.1016/0021-9797(75)90018-1.
    #[staticmethod]
    fn dmt(work: Real) -> PyResult<Self> {
        Ok(Self(Adhesion::Dmt { work: work.0 }.checked()?))
    }

    /// A stress `strength` [Pa] up to a gap of work/strength around the contact: Maugis, J. Colloid Interface Sci. 150 (1992) 243,
    /// doi:10.1016/0021-9797(92)90285-T.
    #[staticmethod]
    fn maugis(work: Real, strength: Real) -> PyResult<Self> {
        let (work, strength) = (work.0, strength.0);
        Ok(Self(Adhesion::Maugis { work, strength }.checked()?))
    }

    /// Name of the static method that makes it.
    #[getter]
    fn kind(&self) -> &'static str {
        match self.0 {
            Adhesion::None => "none",
            Adhesion::Jkr { .. } => "jkr",
            Adhesion::Dmt { .. } => "dmt",
            Adhesion::Maugis { .. } => "maugis",
        }
    }

    /// Work of adhesion [J/m^2].
    #[getter]
    fn work(&self) -> f64 {
        self.0.work().unwrap_or(0.0)
    }

    /// Tensile strength [Pa]; None but for Maugis's.
    #[getter]
    fn strength(&self) -> Option<f64> {
        match self.0 {
            Adhesion::Maugis { strength, .. } => Some(strength),
            _ => None,
        }
    }

    pub(super) fn __repr__(&self) -> String {
        let strength = self.strength().map_or(String::new(), |s| format!(", strength={s:?}"));
        format!("Adhesion.{}(work={:?}{strength})", self.kind(), self.work())
    }

    fn __hash__(&self) -> u64 {
        hash(&self.__repr__())
    }

    /// Callable and arguments that make the adhesion again.
    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let make = py.get_type::<Self>().getattr(self.kind())?;
        let numbers = [Some(self.work()), self.strength()].into_iter().flatten();
        Ok((make, PyTuple::new(py, numbers.collect::<Vec<f64>>())?))
    }
}
