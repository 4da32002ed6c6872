//! Arguments that say what is wrong with them, by exceptions of the package.
//!
//! The interpreter adds which argument it is: see `LightmeshError.add_note` in `_errors.py`.

use std::ops::Deref;

use pyo3::conversion::FromPyObject;
use pyo3::exceptions::PyOverflowError;
use pyo3::prelude::*;

use crate::errors;

/// A finite number, in double precision.
#[derive(Clone, Copy)]
pub(crate) struct Double(pub(crate) f64);

/// A finite number, in single precision.
#[derive(Clone, Copy)]
pub(crate) struct Single(pub(crate) f32);

/// Anything else. What cannot be converted is an exception of the package, too.
#[derive(Clone)]
pub(crate) struct Given<T>(pub(crate) T);

impl FromPyObject<'_, '_> for Double {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, '_, PyAny>) -> PyResult<Double> {
        let number: f64 =
            object.extract().map_err(|error: PyErr| match error.is_instance_of::<PyOverflowError>(object.py()) {
                true => errors::setting("the number is too large for double precision"),
                false => errors::wrong_type("a number", &object),
            })?;
        if number.is_finite() {
            return Ok(Double(number));
        }
        Err(errors::setting(format!("give a finite number, not {}", shown(number))))
    }
}

/// As Python shows it.
fn shown(number: f64) -> String {
    number.to_string().to_lowercase()
}

impl FromPyObject<'_, '_> for Single {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, '_, PyAny>) -> PyResult<Single> {
        let Double(number) = object.extract()?;
        let single = number as f32;
        if single.is_finite() {
            return Ok(Single(single));
        }
        Err(errors::setting(format!("{number:e} is beyond single precision: give a number of less than 3.4e38")))
    }
}

impl<'a, 'py, T: FromPyObject<'a, 'py>> FromPyObject<'a, 'py> for Given<T> {
    type Error = PyErr;

    fn extract(object: Borrowed<'a, 'py, PyAny>) -> PyResult<Given<T>> {
        object.extract::<T>().map(Given).map_err(|error| errors::of_argument(object.py(), error.into()))
    }
}

impl<T> Deref for Given<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.0
    }
}
