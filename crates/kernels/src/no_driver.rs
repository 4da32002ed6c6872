//! Replaces the driver if the crate is built without the feature `cuda`: there is no device, and messages say why.

use std::sync::Arc;

use crate::error::DeviceError;
use crate::gpu::{Gpu, Version, name_of};
use crate::runtime::{Fault, Kernel, Launch, Runtime};

const WHY: &str = "this program was built without CUDA: build it with the feature cuda";

/// A CUDA device: there is none.
#[derive(Debug)]
pub enum Driver {}

/// Memory of a CUDA device: there is none.
#[derive(Debug)]
pub enum DeviceMemory {}

/// A moment on the clock of a CUDA device: there is none.
#[derive(Debug)]
pub enum Event {}

/// NVIDIA's driver: it is not searched for.
pub struct Library {
    /// The CUDA version it supports.
    pub version: Version,
    /// Its devices.
    pub devices: Vec<Gpu>,
}

/// Why CUDA cannot be used: always for the same reason.
#[derive(Debug)]
pub struct Unavailable;

impl Unavailable {
    /// Why, and what to do.
    pub fn explained(&self) -> String {
        WHY.to_owned()
    }

    /// Whether there is nothing to mend: CUDA was left out on purpose.
    pub fn is_ordinary(&self) -> bool {
        true
    }
}

impl Library {
    /// Fails, always.
    pub fn open() -> Result<Library, Unavailable> {
        Err(Unavailable)
    }

    /// Fails, always.
    pub fn ready(&self, _: &Gpu) -> Result<Driver, String> {
        Err(WHY.to_owned())
    }
}

/// Fails, since the crate is built without the feature `cuda`.
///
/// # Errors
/// [`DeviceError::Unusable`], always.
pub fn open_cuda(number: Option<u32>) -> Result<Arc<Driver>, DeviceError> {
    Err(DeviceError::Unusable { device: name_of(number), reason: WHY.to_owned() })
}

impl Driver {
    /// N of `cuda:N`.
    pub fn number(&self) -> u32 {
        match *self {}
    }

    /// The device as described by the driver.
    pub fn gpu(&self) -> &Gpu {
        match *self {}
    }

    /// The CUDA version that the driver supports.
    pub fn version(&self) -> Version {
        match *self {}
    }
}

impl Runtime for Driver {
    type Memory = DeviceMemory;
    type Mark = Event;

    fn name(&self) -> String {
        match *self {}
    }

    fn id(&self) -> u64 {
        match *self {}
    }

    fn has_brute_force(&self) -> bool {
        match *self {}
    }

    fn free_memory(&self) -> Option<u64> {
        match *self {}
    }

    fn allocate(&self, _: u64) -> Result<DeviceMemory, Fault> {
        match *self {}
    }

    fn address(&self, _: &DeviceMemory) -> u64 {
        match *self {}
    }

    fn clear(&self, _: &DeviceMemory, _: u64, _: u64) -> Result<(), Fault> {
        match *self {}
    }

    fn write(&self, _: &DeviceMemory, _: u64, _: &[u8]) -> Result<(), Fault> {
        match *self {}
    }

    fn read(&self, _: &DeviceMemory, _: u64, _: &mut [u8]) -> Result<(), Fault> {
        match *self {}
    }

    fn constant(&self, _: &'static str, _: &'static str, _: &[u8]) -> Result<(), Fault> {
        match *self {}
    }

    fn launch(&self, _: Kernel, _: Launch, _: &[u8]) -> Result<(), Fault> {
        match *self {}
    }

    fn mark(&self) -> Result<Event, Fault> {
        match *self {}
    }

    fn seconds(&self, _: &Event, _: &Event) -> Result<f64, Fault> {
        match *self {}
    }
}
