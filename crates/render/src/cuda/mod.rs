//! What a CUDA device, or a substitute for one, must provide; and typed memory on it.
//!
//! Everything above this module is the same for every [`Runtime`]: the driver is the real device, and the emulator that the tests
//! use runs the same kernels, compiled as C++ for the host. So every launch, every buffer and every plan is tested without a GPU.

#[cfg(not(feature = "cuda"))]
#[path = "no_driver.rs"]
pub(crate) mod driver;

mod buffer;
#[cfg(feature = "cuda")]
pub(crate) mod driver;
pub(crate) mod gpu;
mod runtime;

pub use buffer::{Buffer, Pool};
pub(crate) use driver::Library;
pub use driver::{DeviceMemory, Driver, Event, open_cuda};
pub(crate) use gpu::{Gpu, Version, capability, visible_devices};
pub use runtime::{Fault, Kernel, Launch, Runtime, new_id};
