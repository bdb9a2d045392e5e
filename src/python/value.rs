//! Classes of values: a macro that writes one, and what `repr`, hash and pickle make of the call that makes it.

use numpy::{PyArrayDyn, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyTuple};

use super::arguments::{array_repr, hash};

/// Arguments of a call by name, in their order.
pub(super) type Arguments<'py> = Vec<(&'static str, Bound<'py, PyAny>)>;

/// Name of an argument that paths do not name, but the arguments of which.
pub(super) const INNER: &str = ".";

/// A value that a call of its class makes.
pub(super) trait Value {
    /// Name of the class.
    const NAME: &'static str;
    /// Number of the arguments that `repr` shows without their names.
    const UNNAMED: usize = 0;

    /// Static method that makes the value; the class itself where `None`, and `repr` shows it where the method is hidden.
    fn maker(&self) -> Option<&'static str> {
        None
    }

    /// Arguments of the call that makes the value.
    fn arguments<'py>(&self, py: Python<'py>) -> PyResult<Arguments<'py>>;
}

/// Text of the call that makes a value.
pub(super) fn repr<V: Value>(value: &V, py: Python<'_>) -> PyResult<String> {
    let maker = value.maker().filter(|name| !name.starts_with('_'));
    let maker = maker.map_or(String::new(), |name| format!(".{name}"));
    call_text(&format!("{}{maker}", V::NAME), &value.arguments(py)?, V::UNNAMED)
}

/// Text of a call. Arguments that say nothing, as None or `smooth=True`, are left out; the first `unnamed` have no names.
pub(super) fn call_text(called: &str, arguments: &Arguments, unnamed: usize) -> PyResult<String> {
    let mut texts = Vec::new();
    for (number, (name, argument)) in arguments.iter().enumerate() {
        let text = if let Ok(array) = argument.cast::<PyArrayDyn<f64>>() {
            array_repr(argument.py(), array.to_owned_array())?
        } else if let Ok(layers) = argument.cast::<PyTuple>()
            && layers.iter().all(|layer| layer.hasattr("thickness").unwrap_or(false))
        {
            layers.to_list().repr()?.to_string()
        } else {
            argument.repr()?.to_string()
        };
        match text.as_str() {
            "None" | "(None, None)" | "(False, False)" | "True" => {}
            _ if number < unnamed => texts.push(text),
            _ => texts.push(format!("{name}={text}")),
        }
    }
    Ok(format!("{called}({})", texts.join(", ")))
}

/// Callable and arguments that make a value again; a static method with a name of its own is a `functools.partial`.
pub(super) type Reduced<'py> = (Bound<'py, PyAny>, Bound<'py, PyTuple>);

/// Pickled form of a value of `class`.
pub(super) fn reduced<'py>(
    value: &impl Value,
    class: &Bound<'py, PyAny>,
) -> PyResult<Reduced<'py>> {
    let (py, arguments) = (class.py(), value.arguments(class.py())?);
    let make = match value.maker() {
        Some(name) if !name.starts_with('_') => {
            let partial = py.import("functools")?.getattr("partial")?;
            let make = partial.call((class.getattr(name)?,), Some(&arguments.into_py_dict(py)?))?;
            return Ok((make, PyTuple::empty(py)));
        }
        Some(name) => class.getattr(name)?,
        None => class.clone(),
    };
    let arguments = arguments.into_iter().map(|(_, argument)| argument);
    Ok((make, PyTuple::new(py, arguments.collect::<Vec<_>>())?))
}

/// Hash of a value, which equal values share.
pub(super) fn hashed(value: &impl Value, py: Python<'_>) -> PyResult<u64> {
    Ok(hash(&repr(value, py)?))
}

/// Writes the class of a value: its arguments and what follows from them as attributes, with the methods that are given.
///
/// `of` names the value and `py` Python in the expressions.
macro_rules! class {
    (
        $(#[$meta:meta])*
        $class:ident($kind:ty) is $name:literal of $module:literal;
        |$of:ident, $py:ident|
        arguments { $($(#[$doc:meta])* $argument:ident: $of_type:ty = $read:expr;)* }
        attributes { $($(#[$more:meta])* $attribute:ident: $type:ty = $compute:expr;)* }
        methods { $($methods:tt)* }
    ) => {
        class! {
            $(#[$meta])*
            $class($kind) is $name of $module;
            |$of, $py|
            attributes {
                $($(#[$doc])* $argument: $of_type = $read;)*
                $($(#[$more])* $attribute: $type = $compute;)*
            }
            methods { $($methods)* }
        }

        impl Value for $class {
            const NAME: &'static str = $name;

            fn arguments<'py>(&self, $py: Python<'py>) -> PyResult<Arguments<'py>> {
                let $of = &self.0;
                Ok(vec![$((stringify!($argument), ($read).into_bound_py_any($py)?),)*])
            }
        }
    };
    (
        $(#[$meta:meta])*
        $class:ident($kind:ty) is $name:literal of $module:literal;
        |$of:ident, $py:ident|
        attributes { $($(#[$more:meta])* $attribute:ident: $type:ty = $compute:expr;)* }
        methods { $($methods:tt)* }
    ) => {
        $(#[$meta])*
        #[pyclass(name = $name, module = $module, frozen, eq, from_py_object)]
        #[derive(Clone, PartialEq)]
        pub(in crate::python) struct $class(pub(in crate::python) $kind);

        #[pymethods]
        impl $class {
            $($methods)*

            $($(#[$more])*
            #[getter]
            fn $attribute<'py>(&self, $py: Python<'py>) -> PyResult<$type> {
                let ($of, _) = (&self.0, $py);
                Ok($compute)
            })*

            fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
                value::repr(self, py)
            }

            fn __hash__(&self, py: Python<'_>) -> PyResult<u64> {
                value::hashed(self, py)
            }

            /// Arguments of the call that makes the value, by name: for paths.
            fn _arguments<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, pyo3::types::PyDict>> {
                pyo3::types::IntoPyDict::into_py_dict(self.arguments(py)?, py)
            }

            /// Callable and arguments that make the value again.
            fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<value::Reduced<'py>> {
                value::reduced(slf.get(), slf.get_type().as_any())
            }
        }
    };
}

pub(super) use class;
