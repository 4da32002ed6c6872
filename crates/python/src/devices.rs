//! Devices, and the command line.

use lightmesh_files::visible;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::argument::Given;
use crate::process;

/// What `lightmesh info --devices` lists.
#[pyfunction]
pub(crate) fn devices(py: Python<'_>) -> PyResult<Bound<'_, PyList>> {
    let reports = process::detach(py, lightmesh::render::devices)?;
    let list = PyList::empty(py);
    for report in reports {
        let device = PyDict::new(py);
        device.set_item("device", report.device)?;
        device.set_item("name", report.name)?;
        device.set_item("usable", report.usable)?;
        device.set_item("remark", visible(&report.remark).into_owned())?;
        device.set_item("memory_bytes", report.memory_bytes)?;
        device.set_item("free_bytes", report.free_bytes)?;
        device.set_item("compute_capability", report.compute_capability)?;
        device.set_item("driver_cuda_version", report.driver_cuda_version)?;
        list.append(device)?;
    }
    Ok(list)
}

/// Runs the command line program with these arguments, and returns its exit code.
#[pyfunction]
pub(crate) fn command(py: Python<'_>, arguments: Given<Vec<std::ffi::OsString>>) -> PyResult<u8> {
    let line = ["lightmesh".into()].into_iter().chain(arguments.0);
    process::detach(py, || lightmesh_cli::run_command(line))
}
