//! The data layouts shared by host and device, declared once.
//!
//! Each record is a Rust struct; [`header`] prints all of them as C++ with assertions about every size and offset. Kernels include
//! that header, so a field that moves on one side only does not compile.
//!
//! * [`geometry`]: rays, hits, triangles, acceleration structures.
//! * [`scene`]: lights, materials, and the whole scene as a device holds it.
//! * [`mesh`]: the light mesh and the results computed on it.
//! * [`irradiance_cache`]: the irradiance cache of gathered light, and the arguments of its kernels.
//! * [`stages`]: the arguments of all other kernels.
//! * [`Structure`]: the acceleration structures; every kernel that traces rays exists once for each.
//! * [`constants`]: numbers that both sides must agree on; those of a record are its own.
//! * [`counters`]: all counters.
//!
//! This is a separate crate because the tool that generates the header and the kernels needs nothing else of the renderer.

mod codes;
pub mod constants;
pub mod counters;
pub mod geometry;
mod header;
pub mod irradiance_cache;
mod literal;
pub mod mesh;
mod record;
pub mod scene;
pub mod stages;
mod structure;

pub use header::header;
pub use record::{DeviceType, Field, In, Out, Record};
pub use structure::Structure;
