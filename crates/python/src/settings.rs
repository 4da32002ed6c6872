//! Keyword arguments as settings of a request; `None` stands for a setting that is not given.

use lightmesh::request::Request;
use lightmesh::request::field;
use lightmesh::request::table::{Group, Shape, Value};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyString};

use crate::convert::{Color, is_coded};
use crate::errors::{self, OrRaise};

/// Sets what keyword arguments say, of these groups of settings.
pub(crate) fn apply(request: &mut Request, arguments: Option<&Bound<'_, PyDict>>, groups: &[Group]) -> PyResult<()> {
    for (name, argument) in arguments.into_iter().flatten() {
        if argument.is_none() {
            continue;
        }
        let name = name.extract::<String>()?;
        let is_color = field(&name).is_some_and(|field| field.shape == Shape::Color);
        if is_color && is_coded(&argument) {
            let Color(color) = argument.extract()?;
            let shares = color.to_array().map(|channel| Value::Number(channel.into())).into();
            request.set_in(&name, Value::List(shares), |group| groups.contains(&group)).or_raise()?;
            continue;
        }
        let value = value(&argument).map_err(|_| {
            let kind = argument.get_type().name().map_or_else(|_| "this".to_owned(), |name| name.to_string());
            errors::argument(format!("{name} cannot be of type {kind}: give a number, a text or a sequence of numbers"))
        })?;
        request.set_in(&name, value, |group| groups.contains(&group)).or_raise()?;
    }
    Ok(())
}

/// A request that says what keyword arguments say.
pub(crate) fn of(arguments: Option<&Bound<'_, PyDict>>, groups: &[Group]) -> PyResult<Request> {
    let mut request = Request::default();
    apply(&mut request, arguments, groups)?;
    Ok(request)
}

fn value(argument: &Bound<'_, PyAny>) -> PyResult<Value> {
    if let Ok(switch) = argument.cast::<PyBool>() {
        return Ok(Value::Switch(switch.is_true()));
    }
    if let Ok(text) = argument.cast::<PyString>() {
        return Ok(Value::Text(text.to_str()?.to_owned()));
    }
    if argument.hasattr("__fspath__")? {
        return Ok(Value::Text(argument.call_method0("__fspath__")?.extract()?));
    }
    let is_whole = argument.is_instance_of::<PyInt>() || argument.hasattr("__index__")?;
    // Of arrays, only those with one number have an index.
    if let Some(whole) = is_whole.then(|| argument.call_method0("__index__").ok()).flatten() {
        let text = whole.str()?.to_string();
        return Ok(whole.extract().map_or(Value::Text(text), Value::Whole));
    }
    let is_list = !argument.is_instance_of::<PyFloat>() && argument.hasattr("__iter__")? && argument.len().is_ok();
    if is_list {
        let items = argument.try_iter()?.map(|item| value(&item?)).collect::<PyResult<Vec<Value>>>()?;
        return Ok(Value::List(items));
    }
    argument.extract::<f64>().map(Value::Number)
}
