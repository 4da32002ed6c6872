//! Soft shadows by the light mesh method.
//!
//! Start reading at `techniques/half_ball.rs`: the whole method as a handful of calls. Each call is a stage with its own folder under
//! `stages`, each device implements all of them behind [`backend::Backend`], and [`Renderer`] assembles an image.
//!
//! Devices: [`backend::Cpu`] is the CPU, [`backend::Cuda`] any CUDA device behind [`cuda::Runtime`]. [`devices`] lists
//! them, [`Device`] names one.
//!
//! Data flows one way: [`Scene`](lightmesh_scene::Scene) ▶ [`PreparedScene`] ▶ hits ▶ cells ▶ masks ▶ light points ▶ visibility ▶
//! radiance ▶ [`Frame`].

mod antialiasing;
pub mod backend;
mod bands;
mod cache;
mod counters;
mod data;
mod deformation;
mod device;
mod error;
mod footprint;
mod gpu;
#[doc(hidden)]
pub mod internals;
pub mod light_mesh;
mod material_ids;
mod observer;
mod passes;
mod plan;
mod prepared;
mod probes;
mod progress;
mod render_context;
mod renderer;
pub mod sampling;
mod settings;
mod shading;
mod shadow;
mod stage;
mod stages;
mod stats;
mod steps;
mod surface;
mod sync;
mod techniques;
mod textures;
mod view;

/// Acceleration structures, of [`lightmesh_trace`].
pub mod accel {
    pub use lightmesh_trace::accel::triangle;
    pub use lightmesh_trace::accel::{
        Accelerator, AcceleratorKind, BruteForce, Bvh, BvhCost, CHUNK, ChunkSink, Grid, GridError, GridFault,
        GridFileError, GridOptions, GridSaveError, Hit, Levels, Ray, Region, ShortSegments, ShortTest, TangentPlanes,
        Triangle, Triangles,
    };
}

/// What a CUDA device, or a substitute for one, must provide, and typed memory on it; of [`lightmesh_kernels`].
pub mod cuda {
    pub use lightmesh_kernels::{
        Buffer, DeviceError, DeviceMemory, Driver, Event, Fault, Kernel, Launch, Pool, Runtime, new_id, open_cuda,
    };
}

pub use cache::{Cache, DeviceTable, HostTable, MeshCache, MeshFault, MeshFileError, MeshSaveError, SavedMesh, Table};
pub use counters::{Counts, Tally};
pub use data::cells::CellGroups;
pub use data::light_point_visibility::{LightPointVisibility, VisibilityOfLight};
pub use data::lights::{LightGroup, LightGroups};
pub use data::masks::Masks;
pub use data::picture::Picture;
pub use data::rays::RayList;
pub use data::visibility::Visibility;
#[doc(hidden)]
pub use deformation::are_same;
pub use device::{Choice, Device, DeviceList, DeviceReport, UnknownDevice, devices};
pub use error::RenderError;
pub use footprint::Cone;
pub use observer::{Observer, Progress, Unobserved};
pub use plan::{BytesPerRay, Plan};
pub use prepared::{PreparedGeometry, PreparedScene};
pub use probes::{GivenPoints, PointVisibility, Probes};
pub use render_context::{RenderContext, Sampling};
pub use renderer::{
    Frame, Make, Renderer, Speeds, Worker, crew, render_on, render_on_with, render_together, visibility_on, waking,
};
pub use settings::{
    Acceleration, AmbientSource, Crop, Filter, Glass, Lookup, Mode, Quality, Setting, SettingSet, Settings,
    ShadowTests, Sharing, ShortTests, Step, UnknownCrop, UnknownStep,
};
pub use stage::{Seconds, Stage};
pub use stages::irradiance_cache::Gathering;
pub use stages::irradiance_cache::cpu::SurfaceLight;
pub use stats::{CameraStats, DeviceStats, LatticeStats, MemoryStats, SceneStats, SettingsStats, Stats};
pub use surface::SurfacePoint;
pub use view::{View, Window};
