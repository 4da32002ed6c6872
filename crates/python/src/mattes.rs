//! Which things pixels see.

use std::sync::Arc;

use lightmesh::Frame as Rendered;
use lightmesh::image::Matte;
use numpy::ndarray::Array3;
use numpy::{PyArray2, PyArray3};
use pyo3::prelude::*;

use crate::errors::no_layers;
use crate::planes::plane;
use crate::process;

/// Which things.
#[derive(Clone, Copy)]
pub(crate) enum Which {
    Objects,
    Materials,
}

/// Which things, objects or materials, pixels see. Things are numbered from 1; 0 is nothing.
#[pyclass(frozen, module = "lightmesh")]
pub(crate) struct Mattes {
    rendered: Arc<Rendered>,
    which: Which,
}

/// What pixels see by number, and the shares of it.
type RankArrays<'py> = (Bound<'py, PyArray2<u32>>, Bound<'py, PyArray2<f32>>);

impl Mattes {
    pub(crate) fn new(rendered: Arc<Rendered>, which: Which) -> Mattes {
        Mattes { rendered, which }
    }

    fn matte(&self) -> PyResult<&Matte> {
        let layers = self.rendered.layers().ok_or_else(no_layers)?;
        Ok(match self.which {
            Which::Objects => &layers.object,
            Which::Materials => &layers.material,
        })
    }
}

#[pymethods]
impl Mattes {
    /// The name of thing n is number n - 1.
    #[getter]
    fn names(&self) -> PyResult<Vec<String>> {
        Ok(self.matte()?.names.clone())
    }

    /// (H, W): what the nearest sample of each pixel sees.
    #[getter]
    fn nearest<'py>(slf: &Bound<'py, Mattes>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        let mattes = slf.get();
        plane(slf.as_any(), mattes.rendered.size(), &mattes.matte()?.nearest)
    }

    /// From the largest share of a pixel to the smallest: thing and share, (H, W) each.
    #[getter]
    fn ranks<'py>(slf: &Bound<'py, Mattes>) -> PyResult<Vec<RankArrays<'py>>> {
        let (owner, mattes) = (slf.as_any(), slf.get());
        let size = mattes.rendered.size();
        let arrays = mattes
            .matte()?
            .ranks
            .iter()
            .map(|rank| Ok((plane(owner, size, &rank.number)?, plane(owner, size, &rank.share)?)));
        arrays.collect()
    }

    /// (H, W, 4) each, as Cryptomatte 1.2 lays them out: hash and share of two things.
    fn cryptomatte<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyArray3<f32>>>> {
        let [width, height] = self.rendered.size().map(|side| side as usize);
        let matte = self.matte()?;
        let pictures = process::detach(py, || matte.cryptomatte())?;
        let array = |picture: Vec<[f32; 4]>| {
            let array = Array3::from_shape_vec((height, width, 4), picture.into_flattened());
            PyArray3::from_owned_array(py, array.expect("a picture has all pixels of the frame"))
        };
        Ok(pictures.into_iter().map(array).collect())
    }

    /// The hashes of the names, as Cryptomatte's JSON.
    fn manifest(&self) -> PyResult<String> {
        Ok(self.matte()?.manifest())
    }

    fn __repr__(&self) -> PyResult<String> {
        let what = match self.which {
            Which::Objects => "objects",
            Which::Materials => "materials",
        };
        Ok(format!("<lightmesh.Mattes of {} {what}>", self.matte()?.names.len()))
    }
}
