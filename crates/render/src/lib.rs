//! Soft shadows by the light mesh method.
//!
//! [`method`] is the file to read first: the whole method as a handful of calls. Each call is a stage with a folder of its own
//! under `stages`, each device implements all of them behind [`backend::Backend`], and [`Renderer`] puts a picture together.
//!
//! Devices: [`backend::Cpu`] is the host's processor, [`backend::Cuda`] any CUDA device behind [`cuda::Runtime`]. [`devices`] lists
//! them, [`Device`] names one.
//!
//! Data flows one way: [`Scene`](lightmesh_scene::Scene) ▶ [`PreparedScene`] ▶ hits ▶ masks ▶ light points ▶ visibility ▶
//! radiance ▶ [`Frame`].

pub mod accel;
pub mod backend;
pub mod cuda;
mod device;
mod error;
mod job;
pub mod light_mesh;
mod memory;
pub mod method;
mod modes;
mod observer;
mod picture;
mod prepared;
mod renderer;
pub mod sampling;
mod settings;
mod simd;
mod stages;
mod stats;
mod surface;
mod view;

pub use device::{Choice, Device, DeviceReport, UnknownDevice, devices};
pub use error::RenderError;
pub use job::{Job, Sampling, Tally};
pub use modes::{Plan, Technique};
pub use observer::{Observer, Stage, Unobserved};
pub use picture::Picture;
pub use prepared::PreparedScene;
pub use renderer::{Frame, Renderer, render_on};
pub use settings::{Acceleration, Lookup, Mode, Settings, ShortTests, Step};
pub use stages::long_tests::{Lit, LitBy};
pub use stages::primary_rays::RayList;
pub use stages::shadow_rays::Visibility;
pub use stages::short_tests::{CellGroups, Masks};
pub use stats::{
    CameraStats, Counts, DeviceStats, LatticeStats, MemoryStats, SceneStats, Seconds, SettingsStats, Stats,
};
pub use surface::SurfacePoint;
pub use view::View;
