//! What is wrong with mesh files.

use std::io;
use std::path::PathBuf;

use lightmesh_files::{ReadError, TargetError};
use lightmesh_memory::OverBudget;

use super::frame::VERSION;
use crate::error::RenderError;

/// Why a mesh cannot be saved.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MeshSaveError {
    /// No such file can exist.
    #[error(transparent)]
    Target(#[from] TargetError),
    /// Writing failed, most often for lack of space; a file that was there is as it was.
    #[error("cannot write {}: {reason}; an earlier file of this name is unchanged, check the space left on the disk", path.display())]
    Write {
        /// The target.
        path: PathBuf,
        /// What the system reported.
        reason: io::Error,
    },
    /// What a device keeps cannot be read.
    #[error("the mesh cannot be saved to {}: {reason}", path.display())]
    Device {
        /// The target.
        path: PathBuf,
        /// What the device reported.
        reason: Box<RenderError>,
    },
}

/// Why a mesh file cannot be used.
#[derive(Debug, thiserror::Error)]
#[error("{}: {fault}; {}", path.display(), fault.remedy())]
pub struct MeshFileError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong with it.
    #[source]
    pub fault: MeshFault,
}

/// What is wrong with a mesh file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MeshFault {
    /// It cannot be read.
    #[error("cannot be read: {0}")]
    Read(ReadError),
    /// It is another kind of file.
    #[error("is not a mesh file")]
    NotAMesh,
    /// It was written by another version of this program.
    #[error("has format version {found}, this program reads version {VERSION}")]
    Version {
        /// The version in the file.
        found: u32,
    },
    /// It belongs to other triangles.
    #[error(
        "belongs to another scene ({found} triangles in the file, {expected} in the scene, or other positions or opacities)"
    )]
    OtherGeometry {
        /// Triangles of the scene in the file.
        found: u32,
        /// Triangles of the scene.
        expected: usize,
    },
    /// Its light points are at other places.
    #[error("has light points of step {found}, this image those of step {expected}")]
    OtherStep {
        /// The step in the file.
        found: f32,
        /// The step of the image.
        expected: f32,
    },
    /// Its gathered light depends on something that has changed.
    #[error(
        "has light gathered from other lights, surroundings or materials, with another seed or quality, or by another version"
    )]
    OtherSources,
    /// It is cut off, or its content is not as written.
    #[error("is damaged: {0}")]
    Damaged(&'static str),
    /// Its content does not fit into memory.
    #[error("is too large: {0}")]
    Memory(OverBudget),
}

impl MeshFault {
    /// Whether the file is one of ours that is stale or damaged: it may be replaced.
    pub fn is_replaceable(&self) -> bool {
        !matches!(self, MeshFault::Read(_) | MeshFault::NotAMesh | MeshFault::Memory(_))
    }

    /// Whether light points of the file may be used nonetheless.
    pub fn is_of_gathered_light(&self) -> bool {
        matches!(self, MeshFault::OtherSources)
    }

    /// What to do about it.
    fn remedy(&self) -> &'static str {
        match self {
            MeshFault::Read(_) => "check the path and its permissions",
            MeshFault::NotAMesh => "choose the name of a mesh file, or one that does not exist yet",
            MeshFault::Memory(_) => "raise the limit, or remove the file",
            _ => "render without it and save the mesh again",
        }
    }
}
