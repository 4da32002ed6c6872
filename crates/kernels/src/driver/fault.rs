//! Errors reported by the driver.

use cudarc::driver::DriverError;
use cudarc::driver::sys::CUresult;

use crate::runtime::{Fault, Kernel};

/// The driver's own description: `out of memory (CUDA_ERROR_OUT_OF_MEMORY)`.
pub(super) fn describe(error: DriverError) -> String {
    let number = error.0 as u32;
    let name =
        error.error_name().map_or_else(|_| format!("error {number}"), |name| name.to_string_lossy().into_owned());
    match error.error_string() {
        Ok(text) => format!("{} ({name})", text.to_string_lossy()),
        Err(_) => name,
    }
}

/// A failed operation. Kernels fail after the call that queued them, so `last`, the kernel that was launched last, is named if
/// the error is one that kernels cause.
pub(super) fn failed(what: &str, error: DriverError, last: Option<Kernel>) -> Fault {
    let words = describe(error);
    Fault::Failed(match last.filter(|_| KERNEL_ERRORS.contains(&error.0)) {
        None => format!("{what}: {words}"),
        Some(kernel) => format!(
            "{what}: {words}; the last kernel launched was {kernel}, and CUDA_LAUNCH_BLOCKING=1 in the environment shows the one \
             that failed"
        ),
    })
}

/// Errors caused by a running kernel.
const KERNEL_ERRORS: [CUresult; 10] = [
    CUresult::CUDA_ERROR_ECC_UNCORRECTABLE,
    CUresult::CUDA_ERROR_ILLEGAL_ADDRESS,
    CUresult::CUDA_ERROR_LAUNCH_TIMEOUT,
    CUresult::CUDA_ERROR_ASSERT,
    CUresult::CUDA_ERROR_HARDWARE_STACK_ERROR,
    CUresult::CUDA_ERROR_ILLEGAL_INSTRUCTION,
    CUresult::CUDA_ERROR_MISALIGNED_ADDRESS,
    CUresult::CUDA_ERROR_INVALID_ADDRESS_SPACE,
    CUresult::CUDA_ERROR_INVALID_PC,
    CUresult::CUDA_ERROR_LAUNCH_FAILED,
];
