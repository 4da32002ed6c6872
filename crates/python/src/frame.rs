//! Rendered images.

use std::sync::Arc;

use lightmesh::image::{Description, Format, Layers, publish};
use lightmesh::request::film::RenderedFrame;
use lightmesh::request::table::Group;
use lightmesh::request::{Request, StoragePlan, describe};
use lightmesh::{Frame as Rendered, Scene};
use lightmesh_files::visible;
use numpy::{PyArray2, PyArray3};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::errors::{OrRaise, no_layers};
use crate::mattes::{Mattes, Which};
use crate::planes::{plane, planes};
use crate::process;
use crate::settings;
use crate::target::{self, Target};

/// A rendered image. Its arrays are views into it that cannot be written; row 0 is the top. Those from `depth` on exist if it was
/// rendered with `layers=True`.
#[pyclass(frozen, module = "lightmesh")]
pub(crate) struct Frame {
    rendered: Arc<Rendered>,
    /// Exposure of image files, in stops.
    stops: f32,
    notes: Vec<String>,
    description: Description,
    /// How its files store it, unless `save` says otherwise.
    storage: Request,
    /// Its number in a film, if it is of one.
    number: Option<u32>,
    /// The time of day in a sun study.
    when: String,
}

/// A value as Python's dictionaries, lists and numbers.
pub(crate) fn dict<'py>(py: Python<'py>, value: &impl serde::Serialize) -> PyResult<Bound<'py, PyAny>> {
    let text = serde_json::to_string(value).expect("all keys are strings, and nothing is written");
    py.import("json")?.call_method1("loads", (text,))
}

impl Frame {
    /// A frame of a scene as it was rendered.
    pub(crate) fn new(rendered: Rendered, stops: f32, notes: Vec<String>, world: &Scene) -> Frame {
        let description = describe(&rendered, world);
        let (storage, rendered) = (Request::default(), Arc::new(rendered));
        Frame { rendered, stops, notes, description, storage, number: None, when: String::new() }
    }

    /// A frame whose files are stored as a request says.
    pub(crate) fn stored_as(
        rendered: Rendered,
        stops: f32,
        notes: Vec<String>,
        world: &Scene,
        storage: Request,
    ) -> Frame {
        Frame { storage, ..Frame::new(rendered, stops, notes, world) }
    }

    /// A frame of a film of this request.
    pub(crate) fn of_film(rendered: RenderedFrame, request: &Request, notes: Vec<String>) -> Frame {
        let RenderedFrame { number, when, scene, frame, stops } = rendered;
        // The exposure is that of the film.
        let storage = Request { exposure: None, ..request.clone() };
        Frame { storage, number: Some(number), when, ..Frame::new(frame, stops, notes, &scene) }
    }

    pub(crate) fn layers(&self) -> PyResult<&Layers> {
        self.rendered.layers().ok_or_else(no_layers)
    }

    pub(crate) fn pixels(&self) -> [u32; 2] {
        self.rendered.size()
    }

    fn options(&self, settings: Option<&Bound<'_, PyDict>>) -> PyResult<lightmesh::image::SaveOptions> {
        let mut request = self.storage.clone();
        settings::apply(&mut request, settings, Group::SAVE)?;
        Ok(StoragePlan::new(&request).options(&self.rendered, self.stops, self.description.clone()))
    }
}

#[pymethods]
impl Frame {
    /// Width and height.
    #[getter]
    fn size(&self) -> (u32, u32) {
        self.rendered.size().into()
    }

    /// (H, W, 3): linear radiance, Rec. 709 primaries, premultiplied.
    #[getter]
    fn rgb<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray3<f32>>> {
        let frame = slf.get();
        planes(slf.as_any(), frame.pixels(), frame.rendered.color())
    }

    /// (H, W): the covered share of each pixel, with `background="transparent"`.
    #[getter]
    fn alpha<'py>(slf: &Bound<'py, Self>) -> PyResult<Option<Bound<'py, PyArray2<f32>>>> {
        let frame = slf.get();
        frame.rendered.image.alpha().map(|alpha| plane(slf.as_any(), frame.pixels(), alpha)).transpose()
    }

    /// (H, W): distance along the ray, scene units; infinite where nothing is seen.
    #[getter]
    fn depth<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let frame = slf.get();
        plane(slf.as_any(), frame.pixels(), &frame.layers()?.depth)
    }

    /// (H, W, 3): unit geometric normal towards the viewer, world coordinates; 0 where nothing is seen.
    #[getter]
    fn normal<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray3<f32>>> {
        let frame = slf.get();
        planes(slf.as_any(), frame.pixels(), &frame.layers()?.normal)
    }

    /// (H, W, 3): world coordinates.
    #[getter]
    fn position<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray3<f32>>> {
        let frame = slf.get();
        planes(slf.as_any(), frame.pixels(), &frame.layers()?.position)
    }

    /// (H, W) of each light, then of each lamp: the share of it that is seen, from 0 to 1.
    #[getter]
    fn visibility<'py>(slf: &Bound<'py, Self>) -> PyResult<Vec<Bound<'py, PyArray2<f32>>>> {
        let frame = slf.get();
        frame.layers()?.visibility.iter().map(|of_light| plane(slf.as_any(), frame.pixels(), of_light)).collect()
    }

    /// (H, W, 3) of each light, then of each lamp: what the pixel shows of it alone. Empty if that is not known.
    #[getter]
    fn lights<'py>(slf: &Bound<'py, Self>) -> PyResult<Vec<Bound<'py, PyArray3<f32>>>> {
        let frame = slf.get();
        frame.layers()?.lights.iter().map(|of_light| planes(slf.as_any(), frame.pixels(), of_light)).collect()
    }

    /// (H, W, 3): what belongs to no light.
    #[getter]
    fn rest<'py>(slf: &Bound<'py, Self>) -> PyResult<Option<Bound<'py, PyArray3<f32>>>> {
        let frame = slf.get();
        let rest = &frame.layers()?.rest;
        (!rest.is_empty()).then(|| planes(slf.as_any(), frame.pixels(), rest)).transpose()
    }

    /// (H, W): number of light points that a pixel was interpolated from.
    #[getter]
    fn used<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        let frame = slf.get();
        plane(slf.as_any(), frame.pixels(), &frame.layers()?.used)
    }

    /// The objects that pixels see.
    #[getter]
    fn ids(slf: &Bound<'_, Self>) -> PyResult<Mattes> {
        slf.get().layers()?;
        Ok(Mattes::new(Arc::clone(&slf.get().rendered), Which::Objects))
    }

    /// The materials that pixels see.
    #[getter]
    fn material_ids(slf: &Bound<'_, Self>) -> PyResult<Mattes> {
        slf.get().layers()?;
        Ok(Mattes::new(Arc::clone(&slf.get().rendered), Which::Materials))
    }

    /// Counts, seconds, memory and settings: what `--stats` writes.
    #[getter]
    fn stats<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        dict(py, &self.rendered.stats)
    }

    /// Stops that image files are shown at, unless `save` says otherwise.
    #[getter]
    fn exposure(&self) -> f32 {
        self.stops
    }

    /// Its number in a film; `None` for a picture.
    #[getter]
    fn number(&self) -> Option<u32> {
        self.number
    }

    /// The time of day in a film of a sun study, as in "06:15"; else empty.
    #[getter]
    fn when(&self) -> &str {
        &self.when
    }

    /// All, unless the render was stopped with `partial=True`.
    #[getter]
    fn finished_rows(&self) -> u32 {
        self.rendered.finished_rows()
    }

    /// What was chosen automatically.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.notes.iter().map(|note| visible(note).into_owned()).collect()
    }

    /// Writes a bmp, png, exr or jpg file; the same bytes as the command line. `path` may also be a file that is open for writing bytes: then `format` is
    /// needed. Raises `SaveError`; no partial file is left.
    ///
    /// Settings:
    #[doc = include_str!("docs/save.txt")]
    #[pyo3(signature = (path, **settings))]
    fn save(&self, py: Python<'_>, path: Target, settings: Option<&Bound<'_, PyDict>>) -> PyResult<()> {
        let options = self.options(settings)?;
        let image = &self.rendered.image;
        match path {
            Target::Path(path) => {
                let named = Format::from_path(&path).map(Format::name);
                target::warn_if_misnamed(py, &path, options.format.map(Format::name), named)?;
                let ready = process::detach(py, || image.ready_with(&path, &options))?.or_raise()?;
                publish([ready]).or_raise()
            }
            Target::File(file) => {
                let format = options.format.ok_or_else(|| target::no_format("bmp, png, exr or jpg"))?;
                target::write(py, &file, &process::detach(py, || image.encode(format, &options))?.or_raise()?)
            }
        }
    }

    /// Writes all layers as a multilayer exr file. `path` may also be a file that is open for writing bytes.
    ///
    /// Settings:
    #[doc = include_str!("docs/save.txt")]
    #[pyo3(signature = (path, **settings))]
    fn save_layers(&self, py: Python<'_>, path: Target, settings: Option<&Bound<'_, PyDict>>) -> PyResult<()> {
        self.layers()?;
        let options = self.options(settings)?;
        let image = &self.rendered.image;
        match path {
            Target::Path(path) => {
                let ready = process::detach(py, || image.ready_layers_with(&path, &options))?.or_raise()?;
                publish([ready]).or_raise()
            }
            Target::File(file) => {
                target::write(py, &file, &process::detach(py, || image.encode_layers_with(&options))?.or_raise()?)
            }
        }
    }

    /// A png file, in memory.
    ///
    /// Settings:
    #[doc = include_str!("docs/save.txt")]
    #[pyo3(signature = (**settings))]
    fn to_png<'py>(&self, py: Python<'py>, settings: Option<&Bound<'_, PyDict>>) -> PyResult<Bound<'py, PyBytes>> {
        let options = self.options(settings)?;
        let encode = || self.rendered.image.encode(Format::Png, &options);
        Ok(PyBytes::new(py, &process::detach(py, encode)?.or_raise()?))
    }

    fn _repr_png_<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        self.to_png(py, None)
    }

    /// For `numpy.asarray`.
    #[pyo3(signature = (dtype = None, copy = None))]
    fn __array__<'py>(
        slf: &Bound<'py, Self>,
        dtype: Option<&Bound<'py, PyAny>>,
        copy: Option<bool>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let array = Frame::rgb(slf)?.into_any();
        let converted = match dtype {
            Some(dtype) => array.call_method(
                "astype",
                (dtype,),
                Some(&{
                    let words = PyDict::new(slf.py());
                    words.set_item("copy", false)?;
                    words
                }),
            )?,
            None => array,
        };
        if copy == Some(true) { converted.call_method0("copy") } else { Ok(converted) }
    }

    fn __repr__(&self) -> String {
        let [width, height] = self.pixels();
        let stats = &self.rendered.stats;
        let (scene, seconds) = (&stats.scene.name, stats.seconds.render);
        format!("<lightmesh.Frame of {scene:?}, {width}x{height}, {seconds:.3} s>")
    }
}
