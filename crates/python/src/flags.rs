//! Keyword arguments as flags of the command line: `_` stands for `-`, `None` for a flag that is not given.

use lightmesh_cli::request::{Flag, FlagValue};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyInt, PyString};

/// The flags that keyword arguments stand for.
pub(crate) fn of(arguments: Option<&Bound<'_, PyDict>>) -> PyResult<Vec<Flag>> {
    let mut flags = Vec::new();
    for (name, value) in arguments.into_iter().flatten() {
        if value.is_none() {
            continue;
        }
        let name = name.extract::<String>()?;
        let value = of_value(&name, &value)?;
        flags.push(Flag { name: name.replace('_', "-"), value });
    }
    Ok(flags)
}

/// `flags` with those of `more` in place of flags of the same name.
pub(crate) fn merged(flags: &[Flag], more: Vec<Flag>) -> Vec<Flag> {
    let stays = |flag: &&Flag| more.iter().all(|other| other.name != flag.name);
    flags.iter().filter(stays).cloned().chain(more.iter().cloned()).collect()
}

fn of_value(name: &str, value: &Bound<'_, PyAny>) -> PyResult<FlagValue> {
    if let Ok(switch) = value.cast::<PyBool>() {
        return Ok(FlagValue::Switch(switch.is_true()));
    }
    if name == "light" && !value.is_instance_of::<PyString>() {
        let lights: Vec<String> = value.extract()?;
        return Ok(FlagValue::Texts(lights));
    }
    Ok(FlagValue::Texts(vec![text(name, value)?]))
}

/// A value as it is typed.
fn text(name: &str, value: &Bound<'_, PyAny>) -> PyResult<String> {
    if let Ok(text) = value.cast::<PyString>() {
        return Ok(text.to_str()?.to_owned());
    }
    if let Ok(number) = number(value) {
        return Ok(number);
    }
    if value.hasattr("__fspath__")? {
        let path = value.call_method0("__fspath__")?;
        return path.extract();
    }
    let parts = value.try_iter().and_then(|parts| parts.map(|part| number(&part?)).collect::<PyResult<Vec<_>>>());
    let separator = if matches!(name, "size" | "grid") { "x" } else { "," };
    parts.map(|parts| parts.join(separator)).map_err(|_| {
        let kind = value.get_type().name().map_or_else(|_| "this".to_owned(), |name| name.to_string());
        PyTypeError::new_err(format!("{name} cannot be of type {kind}: give a number, a text or a sequence of numbers"))
    })
}

/// A number in as many digits as tell it from all others.
fn number(value: &Bound<'_, PyAny>) -> PyResult<String> {
    let is_whole = value.is_instance_of::<PyInt>() || value.hasattr("__index__")?;
    if is_whole {
        Ok(value.call_method0("__index__")?.str()?.to_string())
    } else {
        Ok(value.extract::<f64>()?.to_string())
    }
}
