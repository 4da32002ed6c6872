//! The visibility of lights at light points, on a device.

use lightmesh_kernels::{Buffer, Runtime};
use lightmesh_layout::Out;
use lightmesh_layout::mesh::VisibilityOfLight;
use lightmesh_scene::Light;

use super::device::Cuda;
use super::points::DevicePoints;
use crate::error::RenderError;

/// The visibility of every light at every used light point, on a device.
pub struct DeviceLightPointVisibility<R: Runtime> {
    /// One record per light.
    pub(crate) lit: Buffer<R, VisibilityOfLight>,
    /// The same records on the host.
    pub(crate) records: Vec<VisibilityOfLight>,
    bits: Buffer<R, u64>,
    seen: Buffer<R, u16>,
}

impl<R: Runtime> DeviceLightPointVisibility<R> {
    pub(crate) fn new(
        cuda: &Cuda<R>,
        lights: &[Light],
        points: &DevicePoints<R>,
    ) -> Result<DeviceLightPointVisibility<R>, RenderError> {
        let sized = lights.iter().filter(|light| light.has_size()).count();
        let (slots, count) = (points.capacity(), points.count);
        let bits = cuda.pool().zeros("light points that see lights", slots * (lights.len() - sized))?;
        let seen = cuda.pool().room("light points' shares of lights", count * sized)?;
        let (mut next_bits, mut next_seen) = (bits.output().address(), seen.output().address());
        let records: Vec<VisibilityOfLight> = lights
            .iter()
            .map(|light| {
                if light.has_size() {
                    next_seen += (2 * count) as u64;
                    VisibilityOfLight { bits: Out::NULL, seen: Out::to(next_seen - (2 * count) as u64) }
                } else {
                    next_bits += (8 * slots) as u64;
                    VisibilityOfLight { bits: Out::to(next_bits - (8 * slots) as u64), seen: Out::NULL }
                }
            })
            .collect();
        Ok(DeviceLightPointVisibility { lit: cuda.pool().upload("lights' tables", &records)?, records, bits, seen })
    }

    /// Reads the visibility, in the form of the CPU twin but in the order of the device's slots.
    pub fn read(&self) -> Result<(Vec<u64>, Vec<u16>), RenderError> {
        Ok((self.bits.read()?, self.seen.read()?))
    }
}
