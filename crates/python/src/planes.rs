//! Views of the planes of frames as arrays.

use numpy::ndarray::{ArrayView2, ArrayView3};
use numpy::{Element, PyArray2, PyArray3, PyArrayMethods};
use pyo3::exceptions::PyAttributeError;
use pyo3::prelude::*;

/// A read-only view of a plane, one value per pixel; `owner` has it.
pub(crate) fn plane<'py, T: Element>(
    owner: &Bound<'py, PyAny>,
    size: [u32; 2],
    values: &[T],
) -> PyResult<Bound<'py, PyArray2<T>>> {
    let [width, height] = size.map(|side| side as usize);
    let view = ArrayView2::from_shape((height, width), values).map_err(|_| no_layers())?;
    // SAFETY: the owner is an object that never changes and has the values, and the array keeps it alive.
    let array = unsafe { PyArray2::borrow_from_array(&view, owner.clone()) };
    array.try_readwrite()?.make_nonwriteable();
    Ok(array)
}

/// The same with three values per pixel.
pub(crate) fn planes<'py>(
    owner: &Bound<'py, PyAny>,
    size: [u32; 2],
    values: &[[f32; 3]],
) -> PyResult<Bound<'py, PyArray3<f32>>> {
    let [width, height] = size.map(|side| side as usize);
    let view = ArrayView3::from_shape((height, width, 3), values.as_flattened()).map_err(|_| no_layers())?;
    // SAFETY: as above.
    let array = unsafe { PyArray3::borrow_from_array(&view, owner.clone()) };
    array.try_readwrite()?.make_nonwriteable();
    Ok(array)
}

pub(crate) fn no_layers() -> PyErr {
    PyAttributeError::new_err("the frame has no layers: render it with layers=True")
}
