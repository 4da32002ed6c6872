//! Errors of a render.

use std::convert::Infallible;

use lightmesh_kernels::DeviceError;
use lightmesh_memory::OverBudget;
use lightmesh_scene::GeometryError;
use lightmesh_trace::accel::{GridError, GridFileError};

use crate::light_mesh::{LatticeError, TemplateError};
use crate::settings::{Setting, SettingSet};

/// Why an image could not be rendered.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// The light points cannot be numbered.
    #[error(transparent)]
    Lattice(#[from] LatticeError),
    /// There is no template for the radius.
    #[error(transparent)]
    Template(#[from] TemplateError),
    /// The geometry is inconsistent.
    #[error(transparent)]
    Geometry(#[from] GeometryError),
    /// The grid cannot be built.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// The grid file cannot be used.
    #[error(transparent)]
    GridFile(#[from] GridFileError),
    /// A setting is invalid.
    #[error("{setting} = {value} cannot be used: {remedy}")]
    Setting {
        /// The setting.
        setting: Setting,
        /// The value given.
        value: String,
        /// What to use instead.
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
    #[error("cannot start {threads} threads ({reason}): choose a smaller number")]
    Threads {
        /// The number requested.
        threads: usize,
        /// The system's error message.
        reason: String,
    },
    /// The image, or even one row of it, does not fit into the host's memory.
    #[error("there is not enough memory for {buffer}: {short}; raise the limit{}", or_choose("choose ", .helps))]
    Memory {
        /// What is counted.
        buffer: &'static str,
        /// Bytes needed and left.
        short: OverBudget,
        /// The settings by which this work takes less.
        helps: SettingSet,
    },
    /// The geometry is too large for the host's memory.
    #[error(
        "there is not enough memory for the acceleration structure of {triangles} triangles: {short}; raise the limit, or simplify the scene"
    )]
    BuildMemory {
        /// Number of triangles.
        triangles: usize,
        /// Bytes needed and left.
        short: OverBudget,
    },
    /// The smaller levels of a texture do not fit into the host's memory.
    #[error(
        "there is not enough memory for the mip levels of texture `{name}`, {} x {} texels: {short}; raise the limit, or use a smaller image",
        size[0], size[1]
    )]
    TextureMemory {
        /// The texture's name.
        name: String,
        /// Its width and height in texels.
        size: [u32; 2],
        /// Bytes needed and left.
        short: OverBudget,
    },
    /// The device does not exist or cannot be used.
    #[error("device {device} cannot be used: {reason}")]
    Device {
        /// The requested device.
        device: String,
        /// Why not, and what to do.
        reason: String,
    },
    /// The device does not have the kernels of an acceleration structure.
    #[error(
        "{device} has no kernels for the acceleration structure {structure}: choose bvh or grid, or the device cpu"
    )]
    Structure {
        /// The structure.
        structure: String,
        /// The vendor's name for the device.
        device: String,
    },
    /// A device does not have enough memory, however few rows are rendered at once.
    #[error(
        "{device} cannot hold {buffer}: {needed} bytes are needed, {} are free; choose the device cpu{}",
        free.map_or_else(|| "fewer".to_owned(), |free| free.to_string()), or_choose("", .helps)
    )]
    DeviceMemory {
        /// The vendor's name for the device.
        device: String,
        /// The buffer that did not fit.
        buffer: &'static str,
        /// Its bytes.
        needed: u64,
        /// Bytes that were free, if the device reports them.
        free: Option<u64>,
        /// The settings by which this work takes less.
        helps: SettingSet,
    },
    /// A device failed.
    #[error("{device} failed: {reason}; the device cpu renders without it")]
    DeviceFault {
        /// The vendor's name for the device.
        device: String,
        /// The driver's error message.
        reason: String,
    },
    /// The observer requested cancellation.
    #[error("cancelled")]
    Cancelled,
}

impl From<DeviceError> for RenderError {
    fn from(error: DeviceError) -> RenderError {
        match error {
            DeviceError::Unusable { device, reason } => RenderError::Device { device, reason },
            DeviceError::Memory { device, buffer, needed, free } => {
                RenderError::DeviceMemory { device, buffer, needed, free, helps: SettingSet::default() }
            }
            DeviceError::Fault { device, reason } => RenderError::DeviceFault { device, reason },
        }
    }
}

impl RenderError {
    /// Whether there was not enough memory on the host.
    pub fn is_of_memory(&self) -> bool {
        matches!(self, RenderError::Memory { .. } | RenderError::BuildMemory { .. } | RenderError::TextureMemory { .. })
    }

    /// The same of work that takes less memory if these settings are chosen otherwise.
    pub(crate) fn helped_by(self, helps: SettingSet) -> RenderError {
        match self {
            RenderError::Memory { buffer, short, .. } => RenderError::Memory { buffer, short, helps },
            RenderError::DeviceMemory { device, buffer, needed, free, .. } => {
                RenderError::DeviceMemory { device, buffer, needed, free, helps }
            }
            other => other,
        }
    }

    /// The settings that the message mentions and that may solve the problem; empty if the cause lies elsewhere.
    pub fn settings(&self) -> Vec<Setting> {
        match self {
            RenderError::Lattice(_) => vec![Setting::Step],
            RenderError::Template(_) => vec![Setting::Radius],
            RenderError::Grid(_) | RenderError::GridFile(_) => vec![Setting::Acceleration],
            RenderError::Setting { setting, .. } => vec![*setting],
            RenderError::Structure { .. } => vec![Setting::Acceleration, Setting::Device],
            RenderError::Threads { .. } => vec![Setting::Threads],
            RenderError::Memory { helps, .. } => [Setting::MemoryLimit].into_iter().chain(helps.iter()).collect(),
            RenderError::BuildMemory { .. } | RenderError::TextureMemory { .. } => vec![Setting::MemoryLimit],
            RenderError::DeviceMemory { helps, .. } => [Setting::Device].into_iter().chain(helps.iter()).collect(),
            RenderError::Device { .. } | RenderError::DeviceFault { .. } => vec![Setting::Device],
            RenderError::Geometry(_)
            | RenderError::Points { .. }
            | RenderError::Point { .. }
            | RenderError::Cancelled => Vec::new(),
        }
    }
}

/// What else helps where memory is short, as the end of a sentence.
fn or_choose(choose: &str, helps: &SettingSet) -> String {
    let choices: Vec<&str> = helps.iter().filter_map(Setting::that_takes_less).collect();
    match choices.split_last() {
        None => String::new(),
        Some((only, [])) => format!(", or {choose}{only}"),
        Some((last, others)) => format!(", or {choose}{} or {last}", others.join(", ")),
    }
}

impl From<Infallible> for RenderError {
    fn from(never: Infallible) -> RenderError {
        match never {}
    }
}
