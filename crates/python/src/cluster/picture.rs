//! A picture of which others render the rows, for the process that leads.

use std::path::PathBuf;

use lightmesh::request::cluster::{Band, BandedPicture};
use lightmesh::request::{Error, Request};
use lightmesh_files::visible;
use numpy::{PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::{json, listed, order, parsed, request_for_workers};
use crate::errors::{self, IntoException, OrRaise};
use crate::frame::Frame;
use crate::process;
use crate::watch::{self, Watch, Wishes};

/// A band as Python has it: its first row, colours, alpha if there is one, and statistics as text.
type Given<'py> = (i64, Bound<'py, PyAny>, Option<Bound<'py, PyAny>>, String);

/// A picture of which others render the rows.
#[pyclass(frozen, module = "lightmesh._lightmesh")]
pub(crate) struct _BandedPicture {
    picture: BandedPicture,
    notes: Vec<String>,
}

/// What ends the rendering of bands.
enum Failure {
    Library(Error),
    Python(PyErr),
}

impl From<Error> for Failure {
    fn from(error: Error) -> Failure {
        Failure::Library(error)
    }
}

impl IntoException for Failure {
    fn into_exception(self) -> PyErr {
        match self {
            Failure::Library(error) => error.into_exception(),
            Failure::Python(error) => error,
        }
    }
}

#[pymethods]
impl _BandedPicture {
    #[new]
    fn new(
        py: Python<'_>,
        scene: PathBuf,
        output: Option<PathBuf>,
        settings: &Bound<'_, PyDict>,
    ) -> PyResult<_BandedPicture> {
        let order = order(scene, output, settings)?;
        let threads = process::threads();
        let begin = |watch: &Watch| BandedPicture::begin(order, threads, watch).map(|picture| (picture, watch.said()));
        let (picture, notes) = watch::run(py, Wishes::of_warnings(), begin)?.or_raise()?;
        Ok(_BandedPicture { picture, notes })
    }

    /// What was chosen, corrected or guessed, as sentences.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.notes.clone()
    }

    /// The request of workers, as text.
    #[getter]
    fn request(&self) -> String {
        request_for_workers(self.picture.order())
    }

    /// The files that are needed: path, size and checksum.
    #[getter]
    fn inputs(&self) -> Vec<(PathBuf, u64, String)> {
        listed(self.picture.inputs())
    }

    /// Makes the image of the bands that `render` returns for each pass, which it gets as text; writes the file if there is an output, and returns
    /// the frame with what was said of it.
    fn render(&self, py: Python<'_>, render: &Bound<'_, PyAny>) -> PyResult<(Frame, Vec<String>)> {
        let said = Said::default();
        let bands = |pass: &_| -> Result<Vec<Band>, Failure> {
            let given = render.call1((json(pass),)).and_then(|bands| bands.extract::<Vec<Given>>());
            let bands = given.and_then(|bands| bands.into_iter().map(band).collect());
            bands.map_err(Failure::Python)
        };
        let (mut frame, stops) = self.picture.render(&said, bands).or_raise()?;
        let order = self.picture.order();
        if order.files.output.is_some() {
            process::detach(py, || self.picture.save(&mut frame, stops, &said))?.or_raise()?;
        }
        let notes = said.sentences();
        // The exposure is that of the whole.
        let storage = Request { exposure: None, ..order.request.clone() };
        Ok((Frame::stored_as(frame, stops, notes.clone(), self.picture.scene(), storage), notes))
    }
}

/// A band of arrays that may be read-only, as those of a store of objects are, and of any layout.
fn band((first, color, alpha, stats): Given<'_>) -> PyResult<Band> {
    let numpy = color.py().import("numpy")?;
    let plane = |array: &Bound<'_, PyAny>| -> PyResult<Vec<f32>> {
        let array = numpy.call_method1("ascontiguousarray", (array, "float32"))?;
        let array = array.cast_into::<PyArrayDyn<f32>>()?.try_readonly()?;
        Ok(array.as_slice()?.to_vec())
    };
    let rgb =
        color.cast::<PyArrayDyn<f32>>().map_err(|_| errors::wrong_type("colours as an array of float32", &color))?;
    if rgb.shape().last() != Some(&3) {
        return Err(errors::geometry("colours need the shape (H, W, 3)"));
    }
    let color = plane(&color)?.chunks_exact(3).map(|rgb| [rgb[0], rgb[1], rgb[2]]).collect();
    Ok(Band { first, color, alpha: alpha.as_ref().map(plane).transpose()?, stats: parsed(&stats)? })
}

/// Collects what is said.
#[derive(Default)]
struct Said(std::sync::Mutex<Vec<String>>);

impl Said {
    fn sentences(self) -> Vec<String> {
        let said = self.0.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
        said.iter().map(|text| visible(text).into_owned()).collect()
    }
}

impl lightmesh::Observer for Said {
    fn note(&self, text: &str) {
        self.0.lock().unwrap_or_else(std::sync::PoisonError::into_inner).push(text.to_owned());
    }
}

impl lightmesh::request::Host for Said {
    fn warning(&self, text: &str) {
        lightmesh::Observer::note(self, text);
    }
}
