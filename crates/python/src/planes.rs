//! Views of the planes of frames, and of the lists of scenes, as arrays.

use numpy::ndarray::{ArrayView1, ArrayView2, ArrayView3};
use numpy::{Element, PyArray1, PyArray2, PyArray3, PyArrayMethods};
use pyo3::prelude::*;

use crate::errors::no_layers;

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

/// A read-only view of rows; `owner` has them.
pub(crate) fn table<'py, T: Element, const WIDTH: usize>(
    owner: &Bound<'py, PyAny>,
    rows: &[[T; WIDTH]],
) -> PyResult<Bound<'py, PyArray2<T>>> {
    let view = ArrayView2::from_shape((rows.len(), WIDTH), rows.as_flattened()).expect("all rows are as wide");
    // SAFETY: as above.
    let array = unsafe { PyArray2::borrow_from_array(&view, owner.clone()) };
    array.try_readwrite()?.make_nonwriteable();
    Ok(array)
}

/// A read-only view of a list; `owner` has it.
pub(crate) fn column<'py, T: Element>(owner: &Bound<'py, PyAny>, values: &[T]) -> PyResult<Bound<'py, PyArray1<T>>> {
    let view = ArrayView1::from(values);
    // SAFETY: as above.
    let array = unsafe { PyArray1::borrow_from_array(&view, owner.clone()) };
    array.try_readwrite()?.make_nonwriteable();
    Ok(array)
}
