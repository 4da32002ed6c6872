//! What clients and servers say to each other.

use std::ffi::OsString;
use std::path::PathBuf;

use lightmesh::request::files::Files;
use lightmesh::request::{Order, Request};
use serde::{Deserialize, Serialize};

use crate::color::When;
use crate::job::{Job, Told};

/// The version of both sides, which must be the same.
pub(super) const VERSION: &str = env!("CARGO_PKG_VERSION");

/// The part of a call that tells the form of the rest.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Form {
    pub(super) version: String,
}

/// A call.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Call {
    #[serde(flatten)]
    pub(super) form: Form,
    pub(super) asked: Asked,
}

/// What is asked for.
#[derive(Debug, Serialize, Deserialize)]
pub(super) enum Asked {
    /// To end.
    Stop,
    /// To render.
    Render(Box<Rendering>),
}

/// A [`Job`] with the place that names of files count from. Names need not be Unicode.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Rendering {
    pub(super) folder: OsString,
    pub(super) color: When,
    /// What new files may not be for others.
    pub(super) umask: u32,
    pub(super) scene: OsString,
    pub(super) request: Request,
    output: Option<OsString>,
    layers: Option<OsString>,
    stats: Option<OsString>,
    sun_hours: Vec<OsString>,
    mesh_file: Option<OsString>,
    told: Told,
}

/// What a server says.
#[derive(Debug, Serialize, Deserialize)]
pub(super) enum Answer {
    /// Nobody else is before this client any more: it may send its standard output and error.
    Begun,
    /// The exit code.
    Exit(u8),
    /// The server is another version.
    Version(String),
}

impl Call {
    pub(super) fn new(asked: Asked) -> Call {
        Call { form: Form { version: VERSION.to_owned() }, asked }
    }
}

impl Rendering {
    pub(super) fn new(job: &Job, folder: PathBuf, color: When, umask: u32) -> Rendering {
        let Job { order: Order { scene, request, files }, told } = job.clone();
        let text = PathBuf::into_os_string;
        Rendering {
            folder: text(folder),
            color,
            umask,
            scene: text(scene),
            request,
            output: files.output.map(text),
            layers: files.layers.map(text),
            stats: files.stats.map(text),
            sun_hours: files.sun_hours.into_iter().map(text).collect(),
            mesh_file: files.mesh_file.map(text),
            told,
        }
    }

    pub(super) fn into_job(self) -> Job {
        let files = Files {
            output: self.output.map(PathBuf::from),
            layers: self.layers.map(PathBuf::from),
            stats: self.stats.map(PathBuf::from),
            sun_hours: self.sun_hours.into_iter().map(PathBuf::from).collect(),
            mesh_file: self.mesh_file.map(PathBuf::from),
        };
        Job { order: Order { scene: self.scene.into(), request: self.request, files }, told: self.told }
    }
}
