//! The real device: NVIDIA's driver, loaded on first use.
//!
//! Only the driver is needed, no toolkit: kernels are embedded in the program as PTX ([`ptx`]) and the driver compiles them. If the
//! driver is missing or too old, [`open`] reports this and the remedy ([`library`]).
//!
//! Everything goes through one stream ([`context`]), in the order of the calls. Errors carry the name of the operation and the
//! driver's own description ([`fault`]).

mod context;
mod fault;
pub(crate) mod library;
mod mark;
mod memory;
mod module;
pub(crate) mod open;
pub(crate) mod ptx;
mod transfer;

use std::ffi::c_void;
use std::ptr;
use std::sync::Arc;

use cudarc::driver::sys;

pub use library::Library;
pub use mark::Event;
pub use memory::DeviceMemory;
pub use open::open_cuda;

use self::context::Context;
use self::module::Modules;
use self::transfer::Staging;
use crate::gpu::{Gpu, Version};
use crate::runtime::{Fault, Kernel, Launch, Runtime, new_id};

/// A CUDA device.
pub struct Driver {
    id: u64,
    gpu: Gpu,
    version: Version,
    modules: Modules,
    staging: Staging,
    context: Arc<Context>,
}

impl Driver {
    /// Prepares a device, and checks that it accepts kernels.
    fn new(gpu: &Gpu, version: Version) -> Result<Driver, Fault> {
        let context = Arc::new(Context::new(gpu)?);
        let driver = Driver {
            id: new_id(),
            gpu: gpu.clone(),
            version,
            modules: Modules::new(&context, version),
            staging: Staging::new(&context),
            context,
        };
        // The smallest module. A driver without its compiler, for instance, fails here and not in the middle of an image.
        driver.modules.load("scan")?;
        Ok(driver)
    }

    /// N of `cuda:N`.
    pub fn number(&self) -> u32 {
        self.gpu.number
    }

    /// The device as described by the driver.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// The CUDA version that the driver supports.
    pub fn version(&self) -> Version {
        self.version
    }
}

impl Runtime for Driver {
    type Memory = DeviceMemory;
    type Mark = Event;

    fn name(&self) -> String {
        self.gpu.name.clone()
    }

    fn id(&self) -> u64 {
        self.id
    }

    fn has_brute_force(&self) -> bool {
        false
    }

    fn free_memory(&self) -> Option<u64> {
        memory::free(&self.context)
    }

    fn allocate(&self, bytes: u64) -> Result<DeviceMemory, Fault> {
        DeviceMemory::new(&self.context, bytes)
    }

    fn address(&self, memory: &DeviceMemory) -> u64 {
        memory.address()
    }

    fn clear(&self, memory: &DeviceMemory, offset: u64, bytes: u64) -> Result<(), Fault> {
        memory.clear(offset, bytes)
    }

    fn write(&self, memory: &DeviceMemory, offset: u64, bytes: &[u8]) -> Result<(), Fault> {
        self.staging.upload(memory.place(offset, bytes.len() as u64)?, bytes)
    }

    fn read(&self, memory: &DeviceMemory, offset: u64, bytes: &mut [u8]) -> Result<(), Fault> {
        self.staging.download(memory.place(offset, bytes.len() as u64)?, bytes)
    }

    fn constant(&self, module: &'static str, name: &'static str, bytes: &[u8]) -> Result<(), Fault> {
        let (address, room) = self.modules.variable(module, name)?;
        if bytes.len() as u64 > room {
            return Err(Fault::Failed(format!("{} bytes for {module}::{name}, which has {room}", bytes.len())));
        }
        self.staging.upload(address, bytes)
    }

    fn launch(&self, kernel: Kernel, launch: Launch, arguments: &[u8]) -> Result<(), Fault> {
        let Launch { blocks, threads, shared } = launch;
        if blocks == 0 {
            return Ok(());
        }
        let function = self.modules.function(kernel, shared)?;
        let mut size = arguments.len();
        // As one buffer with its size: the driver rejects a record whose size differs from that of the kernel's parameter.
        let mut parameters: [*mut c_void; 5] = [
            ptr::without_provenance_mut(sys::CU_LAUNCH_PARAM_BUFFER_POINTER_AS_INT as usize),
            arguments.as_ptr().cast_mut().cast(),
            ptr::without_provenance_mut(sys::CU_LAUNCH_PARAM_BUFFER_SIZE_AS_INT as usize),
            (&raw mut size).cast(),
            ptr::without_provenance_mut(sys::CU_LAUNCH_PARAM_END_AS_INT as usize),
        ];
        *self.context.last_kernel() = Some(kernel);
        let queue = |stream| {
            let (none, extra) = (ptr::null_mut(), parameters.as_mut_ptr());
            // SAFETY: the function's module is loaded; the driver copies the arguments before it returns. What the kernel does with
            // the addresses in them is the responsibility of the stages.
            unsafe { sys::cuLaunchKernel(function, blocks, 1, 1, threads, 1, 1, shared, stream, none, extra) }.result()
        };
        let what = || {
            format!(
                "launching {kernel} with {blocks} blocks of {threads} threads, {shared} bytes of shared memory and {size} bytes of \
                 arguments"
            )
        };
        self.context.run(what, queue)
    }

    fn mark(&self) -> Result<Event, Fault> {
        Event::now(&self.context)
    }

    fn seconds(&self, from: &Event, to: &Event) -> Result<f64, Fault> {
        from.seconds_until(to)
    }
}
