//! `nacre.indent.Adhesion`.

use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;

use crate::indent::Adhesion;
use crate::python::arguments::Real;
use crate::python::value::{self, Arguments, Value, class};

class! {
    /// Adhesion of tip and surface, made by one of its static methods.
    ///
    /// Examples
    /// --------
    /// >>> nacre.indent.Adhesion.jkr(work=0.05)
    /// Adhesion.jkr(work=0.05)
    PyAdhesion(Adhesion) is "Adhesion" of "nacre.indent";
    |of, py|
    attributes {
        /// Name of the static method that makes it.
        kind: &'static str = kind(of);
        /// Work of adhesion [J/m^2].
        work: f64 = of.work().unwrap_or(0.0);
        /// Tensile strength [Pa]; None but for Maugis's.
        strength: Option<f64> = strength(of);
    }
    methods {
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
    }
}

fn kind(adhesion: &Adhesion) -> &'static str {
    match adhesion {
        Adhesion::None => "none",
        Adhesion::Jkr { .. } => "jkr",
        Adhesion::Dmt { .. } => "dmt",
        Adhesion::Maugis { .. } => "maugis",
    }
}

fn strength(adhesion: &Adhesion) -> Option<f64> {
    match adhesion {
        Adhesion::Maugis { strength, .. } => Some(*strength),
        _ => None,
    }
}

impl Value for PyAdhesion {
    const NAME: &'static str = "Adhesion";

    fn maker(&self) -> Option<&'static str> {
        Some(kind(&self.0))
    }

    fn arguments<'py>(&self, py: Python<'py>) -> PyResult<Arguments<'py>> {
        let mut arguments = vec![("work", self.0.work().into_bound_py_any(py)?)];
        if let Some(strength) = strength(&self.0) {
            arguments.push(("strength", strength.into_bound_py_any(py)?));
        }
        Ok(arguments)
    }
}
