//! The C++ side: `shim/host.cpp` and the structs of `shim/machine.h` and `shim/block.h`.

use std::collections::HashMap;
use std::ffi::{CStr, c_char, c_void};
use std::ptr::NonNull;
use std::sync::{Mutex, OnceLock, PoisonError};

/// `emulator::Kernel`.
#[repr(C)]
pub(crate) struct Kernel {
    module: *const c_char,
    name: *const c_char,
    /// Bytes of its parameter.
    pub(crate) arguments: u32,
    /// Maximum number of threads per block.
    pub(crate) threads: u32,
    run: *const c_void,
    next: *const Kernel,
}

/// `emulator::Constant`.
#[repr(C)]
pub(crate) struct Constant {
    module: *const c_char,
    name: *const c_char,
    /// Its size.
    pub(crate) bytes: usize,
    place: *const c_void,
    next: *const Constant,
}

/// `emulator::ConstantImage`.
#[repr(C)]
pub(crate) struct ConstantImage {
    pub(crate) constant: *const Constant,
    pub(crate) bytes: *const u8,
}

/// `emulator::Launch`.
#[repr(C)]
pub(crate) struct Launch {
    pub(crate) kernel: *const Kernel,
    pub(crate) arguments: *const c_void,
    pub(crate) constants: *const ConstantImage,
    pub(crate) constant_count: usize,
    pub(crate) blocks: u32,
    pub(crate) threads: u32,
    pub(crate) dynamic_shared: u32,
}

// SAFETY: C++ globals that never change while the program runs.
unsafe impl Sync for Kernel {}
// SAFETY: as above; the host's copies are accessed through `place`, by the thread that they belong to.
unsafe impl Sync for Constant {}
// SAFETY: the data it points to outlives the launch and is not changed during it.
unsafe impl Sync for Launch {}

#[cfg(not(no_cxx))]
unsafe extern "C" {
    fn lightmesh_emulator_kernels() -> *const Kernel;
    fn lightmesh_emulator_constants() -> *const Constant;
    fn lightmesh_emulator_machine() -> *mut c_void;
    fn lightmesh_emulator_drop(machine: *mut c_void);
    fn lightmesh_emulator_prepare(machine: *mut c_void, launch: *const Launch);
    fn lightmesh_emulator_run(machine: *mut c_void, launch: *const Launch, block: u32) -> *const c_char;
}

#[cfg(no_cxx)]
use none::*;

/// There was no C++ compiler: no kernels, no constants, and no machine that runs them.
#[cfg(no_cxx)]
mod none {
    use std::ptr;

    use super::{Constant, Kernel, Launch, c_char, c_void};

    pub(super) unsafe fn lightmesh_emulator_kernels() -> *const Kernel {
        ptr::null()
    }

    pub(super) unsafe fn lightmesh_emulator_constants() -> *const Constant {
        ptr::null()
    }

    pub(super) unsafe fn lightmesh_emulator_machine() -> *mut c_void {
        ptr::null_mut()
    }

    pub(super) unsafe fn lightmesh_emulator_drop(_: *mut c_void) {}

    pub(super) unsafe fn lightmesh_emulator_prepare(_: *mut c_void, _: *const Launch) {}

    pub(super) unsafe fn lightmesh_emulator_run(_: *mut c_void, _: *const Launch, _: u32) -> *const c_char {
        ptr::null()
    }
}

type Names = (&'static str, &'static str);

/// The compiled kernels and constants, by module and name.
pub(crate) struct Modules {
    pub(crate) kernels: HashMap<Names, &'static Kernel>,
    pub(crate) constants: HashMap<Names, &'static Constant>,
}

/// All modules.
pub(crate) fn modules() -> &'static Modules {
    static MODULES: OnceLock<Modules> = OnceLock::new();
    MODULES.get_or_init(|| {
        // SAFETY: both lists are complete before `main` and end with null; their strings are literals.
        unsafe {
            let kernels = list(lightmesh_emulator_kernels(), |kernel| (kernel.module, kernel.name, kernel.next));
            let constants = list(lightmesh_emulator_constants(), |it| (it.module, it.name, it.next));
            Modules { kernels, constants }
        }
    })
}

/// A C++ list as a map.
///
/// # Safety
/// `first` and all `next` are null or valid forever, as are the strings.
unsafe fn list<T>(
    first: *const T,
    parts: impl Fn(&T) -> (*const c_char, *const c_char, *const T),
) -> HashMap<Names, &'static T> {
    let mut map = HashMap::new();
    let mut next = first;
    // SAFETY: guaranteed by the caller.
    while let Some(entry) = unsafe { next.as_ref::<'static>() } {
        let (module, name, following) = parts(entry);
        // SAFETY: guaranteed by the caller.
        let text = |string| unsafe { CStr::from_ptr::<'static>(string) }.to_str().unwrap_or_default();
        map.insert((text(module), text(name)), entry);
        next = following;
    }
    map
}

/// Runs blocks, with its fibres and shared memory. Kept for later launches when returned.
pub(crate) struct Machine(NonNull<c_void>);

// SAFETY: all fibres are suspended between blocks, and none of them is bound to a host thread.
unsafe impl Send for Machine {}

static SPARE: Mutex<Vec<Machine>> = Mutex::new(Vec::new());

impl Machine {
    /// A machine that is not in use.
    pub(crate) fn take() -> Option<Machine> {
        let spare = SPARE.lock().unwrap_or_else(PoisonError::into_inner).pop();
        // SAFETY: the function has no arguments.
        spare.or_else(|| NonNull::new(unsafe { lightmesh_emulator_machine() }).map(Machine))
    }

    /// Keeps the machine for a later launch.
    pub(crate) fn give_back(self) {
        SPARE.lock().unwrap_or_else(PoisonError::into_inner).push(self);
    }

    /// Prepares the calling thread for the blocks of a launch.
    ///
    /// # Safety
    /// All pointers of `launch` are valid, the arguments have the size that the kernel declares, and each image that of its
    /// constant.
    pub(crate) unsafe fn prepare(&mut self, launch: &Launch) {
        // SAFETY: guaranteed by the caller.
        unsafe { lightmesh_emulator_prepare(self.0.as_ptr(), launch) }
    }

    /// Runs one block on the calling thread; the error describes what went wrong.
    ///
    /// # Safety
    /// As for [`prepare`](Self::prepare), which this thread has called; and all memory that the kernel accesses exists.
    pub(crate) unsafe fn run(&mut self, launch: &Launch, block: u32) -> Result<(), String> {
        // SAFETY: guaranteed by the caller; a message is a string that stays valid until the machine runs again.
        unsafe {
            let message = lightmesh_emulator_run(self.0.as_ptr(), launch, block);
            if message.is_null() { Ok(()) } else { Err(CStr::from_ptr(message).to_string_lossy().into_owned()) }
        }
    }
}

impl Drop for Machine {
    fn drop(&mut self) {
        // SAFETY: it is not running, and nobody else has access to it.
        unsafe { lightmesh_emulator_drop(self.0.as_ptr()) }
    }
}
