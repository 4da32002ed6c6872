//! Images on surfaces.

use std::collections::HashMap;
use std::sync::Arc;

use glam::Affine2;
use lightmesh::scene::{Texture as Image, TextureUse, Wrap};
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use crate::argument::Given;
use crate::convert;
use crate::errors;
use crate::stored::{self, Reduced};

/// An image on a surface, with the way it is placed.
///
/// `pixels` has shape (H, W, 3) or (H, W, 4), `uint8`, row 0 at the top: colours as sRGB, data (normals, roughness) as they are. `wrap`
/// says how it goes on beyond its edges, across and down. `transform`, shape (2, 3), takes the texture coordinates of vertices to those
/// of the image, whose origin is the upper left corner. `name` is for display.
#[pyclass(frozen, from_py_object, module = "lightmesh")]
#[derive(Clone, Serialize, Deserialize)]
pub(crate) struct Texture {
    image: Arc<Image>,
    wrap: [Wrap; 2],
    transform: Affine2,
}

/// How an image goes on, alike on both axes or not.
#[derive(FromPyObject)]
pub(crate) enum Wraps {
    Both(String),
    Each(String, String),
}

impl Wraps {
    fn read(&self) -> PyResult<[Wrap; 2]> {
        let named = |name: &str| match name {
            "repeat" => Ok(Wrap::Repeat),
            "mirror" => Ok(Wrap::Mirror),
            "clamp" => Ok(Wrap::Clamp),
            other => Err(errors::setting(format!("wrap is repeat, mirror or clamp, not '{other}'"))),
        };
        match self {
            Wraps::Both(name) => Ok([named(name)?; 2]),
            Wraps::Each(across, down) => Ok([named(across)?, named(down)?]),
        }
    }
}

#[pymethods]
impl Texture {
    #[new]
    #[pyo3(
        signature = (pixels, *, wrap = None, transform = None, name = Given(String::new())),
        text_signature = "(pixels, *, wrap='repeat', transform=None, name='')"
    )]
    fn new(
        pixels: &Bound<'_, PyAny>,
        wrap: Option<Given<Wraps>>,
        transform: Option<&Bound<'_, PyAny>>,
        name: Given<String>,
    ) -> PyResult<Texture> {
        let kind = pixels.py().import("numpy")?.call_method1("asarray", (pixels,))?.getattr("dtype")?.to_string();
        if kind != "uint8" {
            return Err(errors::setting(format!("pixels must be of type uint8, not {kind}")));
        }
        let (size, channels, values) = convert::image::<u8>("pixels", pixels, "uint8")?;
        let texel = |texel: &[u8]| [texel[0], texel[1], texel[2], texel.get(3).copied().unwrap_or(u8::MAX)];
        let texels = values.chunks_exact(channels).map(texel).collect();
        let image = Arc::new(Image { name: name.0, size, texels });
        Texture { image, wrap: [Wrap::Repeat; 2], transform: Affine2::IDENTITY }.placed(wrap, transform)
    }

    /// Width and height, pixels.
    #[getter]
    fn size(&self) -> (u32, u32) {
        self.image.size.into()
    }

    /// As it was given; may be empty.
    #[getter]
    fn name(&self) -> &str {
        &self.image.name
    }

    /// The same image, placed otherwise; nothing is copied.
    #[pyo3(signature = (*, wrap = None, transform = None))]
    fn placed(&self, wrap: Option<Given<Wraps>>, transform: Option<&Bound<'_, PyAny>>) -> PyResult<Texture> {
        let mut placed = self.clone();
        if let Some(Given(wrap)) = wrap {
            placed.wrap = wrap.read()?;
        }
        if let Some(transform) = transform {
            placed.transform = convert::affine("transform", transform)?;
        }
        Ok(placed)
    }

    /// For `pickle`.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        stored::reduce(py, "Texture", self)
    }

    /// It never changes: a copy is the same.
    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }

    fn __repr__(&self) -> String {
        let [width, height] = self.image.size;
        format!("<lightmesh.Texture {:?} {width}x{height}>", self.image.name)
    }
}

/// The images of a scene: each once, however often it is used.
#[derive(Default)]
pub(crate) struct Album {
    numbers: HashMap<*const Image, u32>,
    images: Vec<Arc<Image>>,
}

impl Album {
    /// The number of a texture's image, and how it is placed.
    pub(crate) fn add(&mut self, texture: &Texture) -> TextureUse {
        let next = self.images.len() as u32;
        let number = *self.numbers.entry(Arc::as_ptr(&texture.image)).or_insert_with(|| {
            self.images.push(Arc::clone(&texture.image));
            next
        });
        TextureUse { texture: number, wrap: texture.wrap, transform: texture.transform }
    }

    pub(crate) fn into_images(self) -> Vec<Image> {
        self.images.into_iter().map(Arc::unwrap_or_clone).collect()
    }
}
