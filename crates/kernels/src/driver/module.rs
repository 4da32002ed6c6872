//! Modules and their kernels, loaded on first use.

use std::collections::HashMap;
use std::ffi::{CString, c_void};
use std::ptr;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use cudarc::driver::result::{function, module};
use cudarc::driver::sys::{
    self, CUdeviceptr, CUfunction, CUfunction_attribute_enum as FunctionAttribute, CUjit_option, CUmodule, CUresult,
};

use super::context::Context;
use super::fault::describe;
use super::ptx::MODULES;
use crate::gpu::Version;
use crate::runtime::{Fault, Kernel};

/// Size of the buffer for the log of the driver's compiler, in bytes.
const LOG: usize = 8 << 10;
/// Dynamic shared memory per block, in bytes, above which the driver's own choice leaves room for too few blocks.
const MUCH_SHARED_MEMORY: u32 = 4 << 10;

/// All modules loaded so far.
pub(super) struct Modules {
    context: Arc<Context>,
    /// The CUDA version that the driver supports, for messages.
    version: Version,
    loaded: Mutex<Loaded>,
}

#[derive(Default)]
struct Loaded {
    modules: HashMap<&'static str, CUmodule>,
    functions: HashMap<Kernel, Function>,
}

/// A kernel on the device.
#[derive(Clone, Copy)]
struct Function {
    handle: CUfunction,
    /// Bytes of dynamic shared memory that a block is allowed so far.
    shared: u32,
    /// Whether shared memory takes precedence over L1 cache.
    carved: bool,
}

// SAFETY: the handles name driver objects, which may be used from any thread.
unsafe impl Send for Loaded {}

impl Modules {
    /// A store without modules.
    pub(super) fn new(context: &Arc<Context>, version: Version) -> Modules {
        Modules { context: Arc::clone(context), version, loaded: Mutex::default() }
    }

    /// Loads a module unless it is loaded.
    pub(super) fn load(&self, name: &str) -> Result<(), Fault> {
        self.module(&mut self.loaded(), name).map(|_| ())
    }

    /// The kernel, allowed to use `shared` bytes of dynamic shared memory.
    pub(super) fn function(&self, kernel: Kernel, shared: u32) -> Result<CUfunction, Fault> {
        let mut loaded = self.loaded();
        let mut function = match loaded.functions.get(&kernel) {
            Some(function) => *function,
            None => self.find(&mut loaded, kernel)?,
        };
        if shared > MUCH_SHARED_MEMORY && !function.carved {
            // Shared memory limits the number of resident blocks: make it as large as possible. It is taken from the L1 cache,
            // which other kernels need more.
            let attribute = FunctionAttribute::CU_FUNC_ATTRIBUTE_PREFERRED_SHARED_MEMORY_CARVEOUT;
            // SAFETY: the function's module is loaded.
            let set = |_| unsafe { function::set_function_attribute(function.handle, attribute, 100) };
            self.context.run(|| format!("giving {kernel} more shared memory than cache"), set)?;
            function.carved = true;
        }
        if shared > function.shared {
            // By default a block may use 48 KiB in all; more only if the kernel opts in.
            let attribute = FunctionAttribute::CU_FUNC_ATTRIBUTE_MAX_DYNAMIC_SHARED_SIZE_BYTES;
            // SAFETY: the function's module is loaded.
            let set = |_| unsafe { function::set_function_attribute(function.handle, attribute, shared as i32) };
            self.context.run(|| format!("giving {kernel} {shared} bytes of shared memory"), set)?;
            function.shared = shared;
        }
        loaded.functions.insert(kernel, function);
        Ok(function.handle)
    }

    /// Address and size of a module's variable.
    pub(super) fn variable(&self, module: &'static str, name: &str) -> Result<(CUdeviceptr, u64), Fault> {
        let handle = self.module(&mut self.loaded(), module)?;
        let symbol = text(name)?;
        // SAFETY: the module is loaded.
        let find = |_| unsafe { module::get_global(handle, symbol) };
        let (address, bytes) = self.context.run(|| format!("looking for the variable {module}::{name}"), find)?;
        Ok((address, bytes as u64))
    }

    fn find(&self, loaded: &mut Loaded, kernel: Kernel) -> Result<Function, Fault> {
        let module = self.module(loaded, kernel.module)?;
        let name = text(kernel.name)?;
        // SAFETY: the module is loaded.
        let handle = self
            .context
            .run(|| format!("looking for the kernel {kernel}"), |_| unsafe { module::get_function(module, name) })?;
        let attribute = FunctionAttribute::CU_FUNC_ATTRIBUTE_MAX_DYNAMIC_SHARED_SIZE_BYTES;
        // SAFETY: the function was just looked up.
        let read = |_| unsafe { function::get_function_attribute(handle, attribute) };
        let shared = self.context.run(|| format!("querying the attributes of {kernel}"), read)?;
        Ok(Function { handle, shared: u32::try_from(shared).unwrap_or(0), carved: false })
    }

    fn module(&self, loaded: &mut Loaded, name: &str) -> Result<CUmodule, Fault> {
        let entry = MODULES.iter().find(|module| module.name == name);
        let ptx = entry.ok_or_else(|| Fault::Failed(format!("unknown module {name}")))?;
        if let Some(&module) = loaded.modules.get(name) {
            return Ok(module);
        }
        let module = self.compile(name, &ptx.unpacked().map_err(Fault::Failed)?)?;
        loaded.modules.insert(ptx.name, module);
        Ok(module)
    }

    /// Passes PTX, zero-terminated, to the driver, which compiles it or uses the result that it cached the last time.
    fn compile(&self, name: &str, image: &[u8]) -> Result<CUmodule, Fault> {
        let mut log = vec![0_u8; LOG];
        let mut options = [CUjit_option::CU_JIT_ERROR_LOG_BUFFER, CUjit_option::CU_JIT_ERROR_LOG_BUFFER_SIZE_BYTES];
        let mut values: [*mut c_void; 2] = [log.as_mut_ptr().cast(), ptr::without_provenance_mut(LOG)];
        let mut module = ptr::null_mut();
        let load = |_| {
            let (options, values) = (options.as_mut_ptr(), values.as_mut_ptr());
            // SAFETY: the image is zero-terminated; there are as many options as values, and the log has the given size.
            unsafe { sys::cuModuleLoadDataEx(&mut module, image.as_ptr().cast(), 2, options, values) }.result()
        };
        let Err(error) = self.context.call(load) else { return Ok(module) };
        let mut reason = describe(error);
        if error.0 == CUresult::CUDA_ERROR_UNSUPPORTED_PTX_VERSION {
            reason += &format!("; the driver supports CUDA {}: install a newer one", self.version);
        }
        let log = String::from_utf8_lossy(&log);
        let log = log.split('\0').next().unwrap_or_default().trim();
        let said = if log.is_empty() { String::new() } else { format!("; its compiler says: {log}") };
        Err(Fault::Failed(format!("loading the kernels of {name}: {reason}{said}")))
    }

    fn loaded(&self) -> MutexGuard<'_, Loaded> {
        self.loaded.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for Modules {
    fn drop(&mut self) {
        let _ = self.context.wait();
        for &module in self.loaded().modules.values() {
            // SAFETY: loaded above; none of its kernels is running any more.
            let _ = self.context.call(|_| unsafe { module::unload(module) });
        }
    }
}

/// Text for the driver, which ends at the first zero.
fn text(text: &str) -> Result<CString, Fault> {
    CString::new(text).map_err(|_| Fault::Failed("a name contains a zero byte".to_owned()))
}
