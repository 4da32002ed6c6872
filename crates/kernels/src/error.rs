//! Errors of devices.

/// Why a device cannot be used, or has failed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DeviceError {
    /// The device does not exist or cannot be used.
    #[error("device {device} cannot be used: {reason}")]
    Unusable {
        /// The requested device.
        device: String,
        /// Why not, and what to do.
        reason: String,
    },
    /// It does not have enough memory.
    #[error(
        "{device} cannot hold {buffer}: {needed} bytes are needed, {} are free",
        free.map_or_else(|| "fewer".to_owned(), |free| free.to_string())
    )]
    Memory {
        /// The vendor's name for the device.
        device: String,
        /// The buffer that did not fit.
        buffer: &'static str,
        /// Its bytes.
        needed: u64,
        /// Bytes that were free, if the device reports them.
        free: Option<u64>,
    },
    /// It failed.
    #[error("{device} failed: {reason}")]
    Fault {
        /// The vendor's name for the device.
        device: String,
        /// The driver's error message.
        reason: String,
    },
}
