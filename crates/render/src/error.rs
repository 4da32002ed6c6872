//! What can go wrong in a render.

use lightmesh_scene::GeometryError;

use crate::accel::{GridError, GridFileError};
use crate::light_mesh::{LatticeError, TemplateError};
use crate::settings::Setting;

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// The light mesh cannot be numbered.
    #[error(transparent)]
    Lattice(#[from] LatticeError),
    /// There is no template for the radius.
    #[error(transparent)]
    Template(#[from] TemplateError),
    /// The geometry does not hold together.
    #[error(transparent)]
    Geometry(#[from] GeometryError),
    /// The grid cannot be built.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// The grid file cannot be used.
    #[error(transparent)]
    GridFile(#[from] GridFileError),
    /// A setting has no sense.
    #[error("{setting} = {value} cannot be used: {remedy}")]
    Setting {
        /// Which one.
        setting: Setting,
        /// What was given.
        value: String,
        /// What to give instead.
        remedy: &'static str,
    },
    /// Given points and normals do not match, or are too many.
    #[error(
        "{points} points with {normals} normals cannot be used: give one normal per point, and at most {most} points at once"
    )]
    Points {
        /// Number of points.
        points: usize,
        /// Number of normals.
        normals: usize,
        /// Most points.
        most: usize,
    },
    /// A given point is none.
    #[error(
        "point {index} at {position:?} with normal {normal:?} cannot be used: coordinates must be finite, and the normal must not be zero"
    )]
    Point {
        /// Its place among the points.
        index: usize,
        /// Its position, local frame.
        position: [f32; 3],
        /// Its normal.
        normal: [f32; 3],
    },
    /// The threads could not be started.
    #[error("cannot start {threads} threads ({reason}): ask for fewer")]
    Threads {
        /// How many were asked for.
        threads: usize,
        /// What the system said.
        reason: String,
    },
    /// Not even one row of the picture fits.
    #[error(
        "one row of the picture needs {needed} bytes for {buffer}, more than the limit of {limit}: raise the limit, or choose a smaller picture, a larger step or a smaller radius"
    )]
    Memory {
        /// The largest buffer.
        buffer: &'static str,
        /// Bytes a row.
        needed: u64,
        /// Bytes allowed.
        limit: u64,
    },
    /// The device does not exist or cannot be used.
    #[error("device {device} cannot be used: {reason}")]
    Device {
        /// What was asked for.
        device: String,
        /// Why not, and what to do.
        reason: String,
    },
    /// A device has not enough memory, however few rows are taken at once.
    #[error(
        "{device} cannot hold {buffer}: {needed} bytes are needed, {} are free; choose a smaller picture, a larger step or a smaller radius, or the device cpu",
        free.map_or_else(|| "fewer".to_owned(), |free| free.to_string())
    )]
    DeviceMemory {
        /// What the maker calls the device.
        device: String,
        /// The buffer that did not fit.
        buffer: &'static str,
        /// Its bytes.
        needed: u64,
        /// Bytes that were free, where the device tells.
        free: Option<u64>,
    },
    /// A device failed.
    #[error("{device} failed: {reason}; the device cpu renders without it")]
    DeviceFault {
        /// What the maker calls the device.
        device: String,
        /// What the driver said.
        reason: String,
    },
    /// The observer asked to stop.
    #[error("cancelled")]
    Cancelled,
}

impl RenderError {
    /// The settings that the message speaks of and that may mend it; none where the cause lies elsewhere.
    pub fn settings(&self) -> Vec<Setting> {
        match self {
            RenderError::Lattice(_) => vec![Setting::Step],
            RenderError::Template(_) => vec![Setting::Radius],
            RenderError::Grid(_) | RenderError::GridFile(_) => vec![Setting::Acceleration],
            RenderError::Setting { setting, .. } => vec![*setting],
            RenderError::Threads { .. } => vec![Setting::Threads],
            RenderError::Memory { .. } => vec![Setting::MemoryLimit, Setting::Size, Setting::Step, Setting::Radius],
            RenderError::DeviceMemory { .. } => {
                vec![Setting::Size, Setting::Step, Setting::Radius, Setting::Device]
            }
            RenderError::Device { .. } | RenderError::DeviceFault { .. } => vec![Setting::Device],
            RenderError::Geometry(_)
            | RenderError::Points { .. }
            | RenderError::Point { .. }
            | RenderError::Cancelled => Vec::new(),
        }
    }
}
