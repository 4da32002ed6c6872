//! CUDA devices: the kernels as PTX, what runs them, and typed memory on it. Nothing here knows what kernels compute.
//!
//! [`Runtime`] is what a CUDA device, or a substitute for one, must provide. Everything above is the same for every [`Runtime`]: the
//! driver is the real device, and the emulator that the tests use runs the same kernels, compiled as C++ for the host. So every launch,
//! every buffer and every plan is tested without a GPU.
//!
//! Kernels are written next to the code that launches them, in the folders of the renderer. `cuda` has the headers that all of them
//! share, and in `cuda/ptx` what `cargo xtask kernels` compiled.

#[cfg(not(feature = "cuda"))]
#[path = "no_driver.rs"]
mod driver;

mod buffer;
#[cfg(feature = "cuda")]
mod driver;
mod error;
mod gpu;
mod runtime;

pub use buffer::{Buffer, Pool};
pub use driver::{DeviceMemory, Driver, Event, Library, open_cuda};
pub use error::DeviceError;
pub use gpu::{Gpu, Version, capability, visible_devices};
pub use runtime::{Fault, Kernel, Launch, Runtime, new_id};

/// Parts for tests. They are no interface: they change with any release.
#[doc(hidden)]
#[cfg(feature = "cuda")]
pub mod internals {
    pub use crate::driver::library::Unavailable;
    pub use crate::driver::open::no_such_device;
    pub use crate::driver::ptx::{MODULES, Module, Needs, VERSIONS, directive};
}
