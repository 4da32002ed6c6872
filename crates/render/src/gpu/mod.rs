//! What the stages on a CUDA device share: the copy of the scene, data passed between stages, memory, launches, counters and clocks.
//!
//! The launches of each stage are next to its CPU twin (`stages/<stage>/cuda.rs` and `kernel.cu`); [`backend`](crate::backend) combines
//! them. This module contains the device itself ([`device`]), the copy of the scene ([`scene`]), the data that stages pass to each other
//! ([`rays`], [`cells`], [`masks`], [`points`], [`light_point_visibility`], [`film`]),
//! launches split into pieces short enough for any watchdog ([`pieces`]),
//! and the memory plan ([`memory`]).

pub(crate) mod bundles;
pub(crate) mod cells;
mod copy;
mod device;
pub(crate) mod film;
pub(crate) mod light_point_visibility;
pub(crate) mod masks;
mod materials;
pub(crate) mod memory;
mod mesh;
mod per_structure;
mod pieces;
pub(crate) mod points;
mod probes;
mod rates;
pub(crate) mod rays;
mod resident;
pub(crate) mod samples;
mod scan;
mod scene;

pub use device::Cuda;
pub(crate) use device::{blocks_for, warps_for};
pub(crate) use lightmesh_layout::constants::{BLOCK, BLOCK_SIDE};
pub(crate) use mesh::sampling;
pub(crate) use per_structure::{Modules, PerModule, PerStructure, modules, per_module, per_structure};
pub(crate) use rates::{Work, slices_of_rays};
pub use scene::DeviceScene;
pub(crate) use scene::check_structure;
