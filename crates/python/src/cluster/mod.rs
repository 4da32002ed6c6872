//! What `lightmesh.ray` needs of the library: private classes, of which `python/lightmesh/ray` makes what users see.
//!
//! They exchange text of JSON and bytes, which any process understands that has the same version of the package.

mod film_log;
mod picture;
mod worker;

use std::ffi::OsString;
use std::path::PathBuf;

use lightmesh::request::cluster::{Input, digest_of, for_workers, seal_beside, sweep_beside};
use lightmesh::request::files::Files;
use lightmesh::request::table::Group;
use lightmesh::request::{Order, Request};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::{self, OrRaise};
use crate::process;
use crate::settings;
pub(crate) use film_log::_FilmLog;
pub(crate) use picture::_BandedPicture;
pub(crate) use worker::_Worker;

/// All settings of a request.
const ALL: &[Group] = &[
    Group::Reading,
    Group::Memory,
    Group::Motion,
    Group::Frames,
    Group::Form,
    Group::Storage,
    Group::Exposure,
    Group::Image,
    Group::Layers,
    Group::Machine,
];

/// What keyword arguments ask for.
fn order(scene: PathBuf, output: Option<PathBuf>, arguments: &Bound<'_, PyDict>) -> PyResult<Order> {
    let mut request = Request::default();
    settings::apply(&mut request, Some(arguments), ALL)?;
    Ok(Order { scene, request, files: Files { output, ..Files::default() } })
}

/// The request of workers, as text.
fn request_for_workers(order: &Order) -> String {
    json(&for_workers(&order.request))
}

/// Files with size and checksum, as Python gets them.
fn listed(inputs: &[Input]) -> Vec<(PathBuf, u64, String)> {
    inputs.iter().map(|input| (input.path.clone(), input.bytes, input.xxh3.clone())).collect()
}

fn json(value: &impl serde::Serialize) -> String {
    serde_json::to_string(value).expect("all keys are strings, and nothing is written")
}

fn parsed<T: serde::de::DeserializeOwned>(text: &str) -> PyResult<T> {
    serde_json::from_str(text)
        .map_err(|error| errors::setting(format!("this is not of this version of lightmesh: {error}")))
}

/// Size and checksum of a file, `path`.
#[pyfunction]
pub(crate) fn _digest(py: Python<'_>, path: PathBuf) -> PyResult<(u64, String)> {
    process::detach(py, || digest_of(&path))?.map_err(lightmesh::request::Error::from).or_raise()
}

/// The seal of the manifest beside `output`, if there is one.
#[pyfunction]
pub(crate) fn _seal(py: Python<'_>, output: PathBuf) -> PyResult<Option<String>> {
    process::detach(py, || seal_beside(&output))
}

/// Removes the temporary files that dead processes of this system have left beside `output`.
#[pyfunction]
pub(crate) fn _sweep(py: Python<'_>, output: PathBuf) -> PyResult<()> {
    process::detach(py, || sweep_beside(&output))
}

/// The scene, the output and the request, as text, of the arguments of `lightmesh render`. What cannot be read is explained, and `SystemExit` raised.
#[pyfunction]
pub(crate) fn _parse(arguments: Vec<OsString>) -> PyResult<(PathBuf, Option<PathBuf>, String)> {
    let line = ["lightmesh".into(), "render".into()].into_iter().chain(arguments);
    match lightmesh_cli::parse_render(line) {
        Ok(Order { files, .. }) if files != (Files { output: files.output.clone(), ..Files::default() }) => {
            Err(errors::setting(
                "only -o is written by many processes: leave out --layers, --stats, --sun-hours and --mesh-file",
            ))
        }
        Ok(order) => Ok((order.scene, order.files.output, json(&order.request))),
        Err(code) => Err(pyo3::exceptions::PySystemExit::new_err(code)),
    }
}
