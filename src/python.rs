//! Python bindings: newtypes and thin wrappers. Nothing else in the crate knows Python.
//!
//! The files in their order; each imports from earlier ones only: errors, arguments, background, data, value,
//! bodies, grid, hertz, shapes, coefficients, solved, contact, friction, wear, stress, fatigue, gradient, indent, paths.

use pyo3::prelude::*;

mod arguments;
mod background;
mod bodies;
mod coefficients;
mod contact;
mod data;
mod errors;
mod fatigue;
mod friction;
mod gradient;
mod grid;
mod hertz;
mod indent;
mod paths;
mod shapes;
mod solved;
mod stress;
mod value;
mod wear;

#[pymodule(name = "_core")]
mod core {
    #[pymodule_export]
    use super::arguments::{check_memory, integer, number, plain, py_real_array, vector};
    use super::bodies::{self, PyFree, PyRigid};
    #[pymodule_export]
    use super::bodies::{PyElastic, PyHalfSpace, PyLayer, PyResponse, PySpring};
    #[pymodule_export]
    use super::coefficients::{
        PyConvolution, frequency_response, graded_layers, influence_coefficients,
        surface_compliance,
    };
    #[pymodule_export]
    use super::contact::{PyPlan, solve};
    #[pymodule_export]
    use super::data::checked;
    #[pymodule_export]
    use super::errors::{ConvergenceError, NacreWarning};
    #[pymodule_export]
    use super::fatigue::{fatigue_constants, fatigue_stress, shakedown};
    #[pymodule_export]
    use super::friction::{PyFrictionSolved, PyFrictionSteps, creep_coefficients, roll, slide};
    #[pymodule_export]
    use super::gradient::PyLinear;
    #[pymodule_export]
    use super::grid::PyGrid;
    #[pymodule_export]
    use super::hertz::{PyHertz, contact_modulus, equivalent_radius, relative_radii};
    #[pymodule_export]
    use super::indent::{PyIndentStates, PyIndentation};
    #[pymodule_export]
    use super::paths::{at, numbers, with_value};
    #[pymodule_export]
    use super::shapes::{PyLogarithmicProfile, PySampledProfile};
    #[pymodule_export]
    use super::solved::{PySolved, checked_report};
    #[pymodule_export]
    use super::stress::{
        PyStressPlan, checked_stress, layer_values, stress, stress_invariants, stress_plan,
        stress_summary, stress_under,
    };
    #[pymodule_export]
    use super::wear::{PyWearSteps, wear};
    use super::{indent, shapes};
    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        shapes::register(module)?;
        module.add("RIGID", bodies::rigid(module.py())?)?;
        module.add("FREE", bodies::free(module.py())?)?;
        // As Python writes it, and maturin: 0.2.0-dev is 0.2.0.dev0.
        module.add("__version__", env!("CARGO_PKG_VERSION").replace("-dev", ".dev0"))?;
        // Not among the public names.
        module.setattr("Rigid", module.py().get_type::<PyRigid>())?;
        module.setattr("Free", module.py().get_type::<PyFree>())?;
        // The names of `nacre.indent`.
        let py = module.py();
        module.setattr("Tip", py.get_type::<indent::PyTip>())?;
        module.setattr("Adhesion", py.get_type::<indent::PyAdhesion>())?;
        module.setattr("slope_of", wrap_pyfunction!(indent::slope_of, module)?)?;
        Ok(())
    }
}
