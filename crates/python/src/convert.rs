//! What Python gives: vectors, colours and arrays.

use glam::{Affine2, DMat4, DVec3, Vec2, Vec3};
use lightmesh::scene::is_affine;
use numpy::{
    PyArray1, PyArrayDescrMethods, PyArrayMethods, PyReadonlyArray, PyReadonlyArrayDyn, PyUntypedArray,
    PyUntypedArrayMethods,
};
use pyo3::prelude::*;
use pyo3::types::PyString;
use serde::{Deserialize, Serialize};

use crate::errors;

/// What codes of 8 bits are divided by.
const MOST: f64 = u8::MAX as f64;

/// Three numbers, in double precision.
#[derive(Clone, Copy)]
pub(crate) struct Vector(pub(crate) DVec3);

impl<'a, 'py> FromPyObject<'a, 'py> for Vector {
    type Error = PyErr;

    fn extract(object: Borrowed<'a, 'py, PyAny>) -> PyResult<Vector> {
        let numbers: Vec<f64> =
            object.extract().map_err(|_| errors::wrong_type("three numbers, x, y and z", &object))?;
        let numbers: [f64; 3] = numbers
            .try_into()
            .map_err(|numbers: Vec<f64>| errors::setting(format!("give three numbers, not {}", numbers.len())))?;
        // Single precision is what they end in.
        if numbers.iter().all(|number| (*number as f32).is_finite()) {
            Ok(Vector(numbers.into()))
        } else {
            Err(errors::setting(format!("{numbers:?} is not finite in single precision")))
        }
    }
}

/// One number, or red, green and blue; linear. Codes of 8 bits, which only an array or a scalar of NumPy can be, are shares of 255.
#[derive(Clone, Copy)]
pub(crate) struct Color(pub(crate) Vec3);

impl<'a, 'py> FromPyObject<'a, 'py> for Color {
    type Error = PyErr;

    fn extract(object: Borrowed<'a, 'py, PyAny>) -> PyResult<Color> {
        let color = match object.extract::<f64>() {
            Ok(grey) => DVec3::splat(grey),
            Err(_) if object.is_instance_of::<PyString>() => {
                return Err(errors::argument("a colour is one number, or red, green and blue"));
            }
            Err(_) => object.extract::<Vector>()?.0,
        };
        let color = if is_coded(&object) { color / MOST } else { color };
        let color = color.as_vec3();
        if color.is_finite() && color.cmpge(Vec3::ZERO).all() {
            Ok(Color(color))
        } else {
            Err(errors::setting(format!(
                "the colour {color} cannot be used: its channels must be finite and not negative"
            )))
        }
    }
}

/// Whether an array, or a number of NumPy, consists of codes of 8 bits.
pub(crate) fn is_coded(object: &Bound<'_, PyAny>) -> bool {
    let kind = object.getattr("dtype").and_then(|kind| kind.str()?.extract::<String>());
    kind.is_ok_and(|kind| kind == "uint8")
}

/// The share of light that a surface reflects. Whole numbers above 1 are codes of 8 bits of which nobody said so.
#[derive(Clone, Copy)]
pub(crate) struct Reflectance(pub(crate) Vec3);

impl<'a, 'py> FromPyObject<'a, 'py> for Reflectance {
    type Error = PyErr;

    fn extract(object: Borrowed<'a, 'py, PyAny>) -> PyResult<Reflectance> {
        let Color(color) = object.extract()?;
        let is_whole = || object.extract::<i64>().is_ok() || object.extract::<Vec<i64>>().is_ok();
        if color.max_element() > 1.0 && is_whole() {
            return Err(errors::setting(format!(
                "the colour {color} reflects more than it receives: give shares from 0 to 1, or an array of uint8, which are shares of 255"
            )));
        }
        Ok(Reflectance(color))
    }
}

/// A shape, as messages tell it.
fn shown(shape: &[usize]) -> String {
    let sides: Vec<String> = shape.iter().map(usize::to_string).collect();
    format!("({})", sides.join(", "))
}

/// An array of numbers of any kind, as one of `T` of `width` columns; its rows. NumPy converts where the kind differs.
fn rows<'py, T: numpy::Element>(
    what: &str,
    array: &Bound<'py, PyAny>,
    kind: &str,
    width: usize,
) -> PyResult<PyReadonlyArrayDyn<'py, T>> {
    let array = converted::<T>(what, array, kind)?;
    match array.shape() {
        [_, columns] if *columns == width => Ok(array),
        other => Err(errors::geometry(format!("{what} must have the shape (N, {width}), not {}", shown(other)))),
    }
}

/// The same, of finite numbers.
fn finite_rows<'py, T: numpy::Element + Copy + Into<f64>>(
    what: &str,
    array: &Bound<'py, PyAny>,
    kind: &str,
    width: usize,
) -> PyResult<PyReadonlyArrayDyn<'py, T>> {
    let array = rows::<T>(what, array, kind, width)?;
    match array.as_slice()?.iter().position(|&number| !number.into().is_finite()) {
        None => Ok(array),
        Some(place) => Err(errors::geometry(format!("row {} of {what} is not finite", place / width))),
    }
}

/// Any array-like as a contiguous array of `T`.
fn converted<'py, T: numpy::Element>(
    what: &str,
    array: &Bound<'py, PyAny>,
    kind: &str,
) -> PyResult<PyReadonlyArrayDyn<'py, T>> {
    let numpy = array.py().import("numpy")?;
    let contiguous = numpy.call_method1("ascontiguousarray", (array, kind)).map_err(|error| {
        errors::geometry(format!("{what} cannot be read as an array of {kind}: {}", error.value(array.py())))
    })?;
    let contiguous = contiguous.cast_into::<numpy::PyArrayDyn<T>>()?;
    Ok(contiguous.try_readonly()?)
}

/// Points in single or double precision.
#[derive(Serialize, Deserialize)]
pub(crate) enum Points {
    Single(#[serde(with = "lightmesh::scene::packed")] Vec<Vec3>),
    Double(#[serde(with = "lightmesh::scene::packed")] Vec<DVec3>),
}

impl Points {
    pub(crate) fn len(&self) -> usize {
        match self {
            Points::Single(points) => points.len(),
            Points::Double(points) => points.len(),
        }
    }

    pub(crate) fn double(self) -> Vec<DVec3> {
        match self {
            Points::Single(points) => points.into_iter().map(Vec3::as_dvec3).collect(),
            Points::Double(points) => points,
        }
    }
}

/// Points, (N, 3).
pub(crate) fn points(what: &str, array: &Bound<'_, PyAny>) -> PyResult<Points> {
    let is_single =
        array.cast::<PyUntypedArray>().is_ok_and(|array| array.dtype().is_equiv_to(&numpy::dtype::<f32>(array.py())));
    if is_single {
        return Ok(Points::Single(vectors(what, array)?));
    }
    let array = finite_rows::<f64>(what, array, "float64", 3)?;
    Ok(Points::Double(array.as_slice()?.as_chunks().0.iter().map(|&[x, y, z]| DVec3::new(x, y, z)).collect()))
}

/// Vectors in single precision, (N, 3).
pub(crate) fn vectors(what: &str, array: &Bound<'_, PyAny>) -> PyResult<Vec<Vec3>> {
    let array = finite_rows::<f32>(what, array, "float32", 3)?;
    Ok(array.as_slice()?.as_chunks().0.iter().map(|&numbers| Vec3::from_array(numbers)).collect())
}

/// The same, or one that stands for each of `count`.
pub(crate) fn one_or_each(what: &str, array: &Bound<'_, PyAny>, count: usize) -> PyResult<Vec<Vec3>> {
    let all = converted::<f32>(what, array, "float32")?;
    let [3] = all.shape() else { return vectors(what, array) };
    let row = all.call_method1("reshape", ((1, 3),))?;
    Ok(vec![vectors(what, &row)?[0]; count])
}

/// Linear colours, (N, 3). Codes of 8 bits are shares of 255; of other whole numbers it cannot be known what they are shares of.
pub(crate) fn colors(what: &str, array: &Bound<'_, PyAny>) -> PyResult<Vec<Vec3>> {
    let any = array.py().import("numpy")?.call_method1("asarray", (array,))?;
    let colors = vectors(what, &any)?;
    if is_coded(&any) {
        return Ok(colors.into_iter().map(|color| color / MOST as f32).collect());
    }
    if let Some(row) = colors.iter().position(|color| color.cmplt(Vec3::ZERO).any()) {
        return Err(errors::geometry(format!("row {row} of {what} is negative: give shares from 0 to 1")));
    }
    let is_whole = matches!(any.getattr("dtype")?.getattr("kind")?.extract::<String>()?.as_str(), "i" | "u");
    match colors.iter().position(|color| is_whole && color.max_element() > 1.0) {
        None => Ok(colors),
        Some(row) => Err(errors::geometry(format!(
            "row {row} of {what} has the whole numbers {}: give shares from 0 to 1, or an array of uint8, which are shares of 255",
            colors[row]
        ))),
    }
}

/// Texture coordinates, (N, 2).
pub(crate) fn pairs(what: &str, array: &Bound<'_, PyAny>) -> PyResult<Vec<Vec2>> {
    let array = finite_rows::<f32>(what, array, "float32", 2)?;
    Ok(array.as_slice()?.as_chunks().0.iter().map(|&numbers| Vec2::from_array(numbers)).collect())
}

/// Indices of vertices, (N, 3). Negative ones and those beyond 32 bits are refused.
pub(crate) fn triangles(what: &str, array: &Bound<'_, PyAny>) -> PyResult<Vec<[u32; 3]>> {
    let indices = indices(what, array)?;
    if let [_, 3] = indices.shape() {
        let all = indices.as_slice()?;
        return all.as_chunks().0.iter().map(|corners| number_triangle(what, corners)).collect();
    }
    Err(errors::geometry(format!("{what} must have the shape (N, 3), not {}", shown(indices.shape()))))
}

/// Indices by triangle, (N,).
pub(crate) fn list(what: &str, array: &Bound<'_, PyAny>) -> PyResult<Vec<u32>> {
    let indices = indices(what, array)?;
    if let [_] = indices.shape() {
        return indices.as_slice()?.iter().map(|&index| number(what, index)).collect();
    }
    Err(errors::geometry(format!("{what} must have the shape (N,), not {}", shown(indices.shape()))))
}

/// Whole numbers; NumPy would cut off what follows the point of others.
fn indices<'py>(what: &str, array: &Bound<'py, PyAny>) -> PyResult<PyReadonlyArrayDyn<'py, i64>> {
    let any = array.py().import("numpy")?.call_method1("asarray", (array,))?;
    let dtype = any.getattr("dtype")?.getattr("kind")?.extract::<String>()?;
    let is_empty = any.getattr("size")?.extract::<usize>()? == 0;
    if !matches!(dtype.as_str(), "i" | "u") && !is_empty {
        return Err(errors::geometry(format!("{what} must be whole numbers")));
    }
    converted::<i64>(what, &any, "int64")
}

fn number_triangle(what: &str, corners: &[i64; 3]) -> PyResult<[u32; 3]> {
    Ok([number(what, corners[0])?, number(what, corners[1])?, number(what, corners[2])?])
}

fn number(what: &str, index: i64) -> PyResult<u32> {
    let refused = |_| errors::geometry(format!("{what} contains the index {index}: indices count from 0, in 32 bits"));
    u32::try_from(index).map_err(refused)
}

/// One transform, (4, 4), or many, (N, 4, 4); for column vectors.
pub(crate) fn transforms(what: &str, array: &Bound<'_, PyAny>) -> PyResult<Vec<DMat4>> {
    let array: PyReadonlyArray<'_, f64, _> = converted::<f64>(what, array, "float64")?;
    match array.shape() {
        [4, 4] | [_, 4, 4] => {}
        other => {
            let shape = shown(other);
            return Err(errors::geometry(format!("{what} must have the shape (4, 4) or (N, 4, 4), not {shape}")));
        }
    }
    let numbers = array.as_slice()?;
    if numbers.iter().any(|number| !number.is_finite()) {
        return Err(errors::geometry(format!("{what} must be finite")));
    }
    // Rows of NumPy's arrays are columns to glam.
    let matrix = |rows: &[f64; 16]| DMat4::from_cols_array(rows).transpose();
    let matrices: Vec<DMat4> = numbers.as_chunks().0.iter().map(matrix).collect();
    for (number, matrix) in matrices.iter().enumerate() {
        let which = if array.ndim() == 2 { String::new() } else { format!("[{number}]") };
        check_affine(&format!("{what}{which}"), matrix)?;
    }
    Ok(matrices)
}

/// Fails if the last row is that of no affine map: what it says would be lost.
fn check_affine(what: &str, matrix: &DMat4) -> PyResult<()> {
    if is_affine(matrix) {
        return Ok(());
    }
    let remedy = match is_affine(&matrix.transpose()) {
        true => "it looks transposed: move the translation to the last column, as in matrix.T",
        false => "give an affine map for column vectors",
    };
    let [a, b, c, d] = matrix.row(3).to_array();
    Err(errors::geometry(format!("the last row of {what} is {a}, {b}, {c}, {d} and not 0, 0, 0, 1: {remedy}")))
}

/// A transform of texture coordinates, (2, 3).
pub(crate) fn affine(what: &str, array: &Bound<'_, PyAny>) -> PyResult<Affine2> {
    let array = rows::<f32>(what, array, "float32", 3)?;
    let numbers = array.as_slice()?;
    if numbers.iter().any(|number| !number.is_finite()) {
        return Err(errors::setting(format!("{what} must be finite")));
    }
    let [a, b, c, d, e, f] = numbers else {
        return Err(errors::setting(format!("{what} must have the shape (2, 3)")));
    };
    Ok(Affine2::from_cols_array(&[*a, *d, *b, *e, *c, *f]))
}

/// An image: width, height, channels, and all values.
pub(crate) fn image<T: numpy::Element + Copy>(
    what: &str,
    array: &Bound<'_, PyAny>,
    kind: &str,
) -> PyResult<([u32; 2], usize, Vec<T>)> {
    let array = converted::<T>(what, array, kind)?;
    let shape = array.shape();
    match *shape {
        [height, width, channels @ (3 | 4)] if height > 0 && width > 0 => {
            let side = |side: usize| u32::try_from(side).map_err(|_| errors::setting(format!("{what} is too large")));
            Ok(([side(width)?, side(height)?], channels, array.as_slice()?.to_vec()))
        }
        _ => {
            let shape = shown(shape);
            Err(errors::setting(format!("{what} must have the shape (H, W, 3) or (H, W, 4), not {shape}")))
        }
    }
}

/// Numbers as a one-dimensional array that owns them.
pub(crate) fn owned<T: numpy::Element>(py: Python<'_>, numbers: Vec<T>) -> Bound<'_, PyArray1<T>> {
    PyArray1::from_vec(py, numbers)
}
