//! Rays, hits and visibility on a device.

use std::ops::Range;

use lightmesh_kernels::{Buffer, Runtime};
use lightmesh_layout::Out;
use lightmesh_layout::geometry::{Cone, Hit, ListedRay, Rays, Vec3};
use lightmesh_trace::accel;

use super::device::Cuda;
use super::samples::DeviceSampled;
use super::scene::DeviceScene;
use crate::data::wave::Wave;
use crate::error::RenderError;

/// A wave on a device.
pub(crate) type DeviceWave<'a, R> = Wave<'a, DeviceScene<R>, DeviceRays<R>, DeviceHits<R>>;

/// Rays on a device.
pub struct DeviceRays<R: Runtime> {
    pub(crate) record: Rays,
    /// Keeps the list alive that the record points to.
    pub(crate) list: Option<Buffer<R, ListedRay>>,
    /// Keeps the cones alive that the record points to.
    pub(crate) cones: Option<Buffer<R, Cone>>,
    /// As in [`RayList`](crate::data::rays::RayList).
    pub(crate) spacing: [f32; 2],
    /// Whether a pixel may have several of them.
    pub(crate) several: bool,
    /// Whether they go through samples of a camera's pixels.
    pub(crate) are_fragments: bool,
    /// What the samples see that they are shaded with.
    pub(crate) sampled: Option<DeviceSampled<R>>,
}

/// Hits on a device, one per ray.
pub struct DeviceHits<R: Runtime> {
    pub(crate) hits: Buffer<R, Hit>,
}

/// The visibility of each light at surface points, on a device.
pub struct DeviceVisibility<R: Runtime> {
    /// Number of rays.
    pub(crate) rays: usize,
    /// The numbers of the lights.
    pub(crate) lights: Range<usize>,
    /// By light, then ray.
    pub(crate) share: Buffer<R, f32>,
    /// As in [`Visibility`](crate::data::visibility::Visibility).
    pub(crate) passed: Option<Buffer<R, Vec3>>,
    /// Number of light points used by each ray.
    pub(crate) used: Option<Buffer<R, u32>>,
    /// As in [`Visibility`](crate::data::visibility::Visibility).
    pub(crate) weighed: bool,
}

impl<R: Runtime> DeviceHits<R> {
    /// Reads the hits in the order of the rays: for a camera, y · width + x of the band.
    ///
    /// # Errors
    /// [`RenderError::DeviceFault`] if the device fails.
    pub fn read(&self) -> Result<Vec<accel::Hit>, RenderError> {
        Ok(bytemuck::cast_vec(self.hits.read()?))
    }
}

impl<R: Runtime> DeviceWave<'_, R> {
    /// The numbers of the lights whose visibility is asked for.
    pub(crate) fn group(&self) -> Range<usize> {
        self.lights.of(self.scene.host.scene.lights.len())
    }
}

impl<R: Runtime> DeviceVisibility<R> {
    /// No visibility of the lights numbered `lights`.
    pub(crate) fn dark(cuda: &Cuda<R>, rays: usize, lights: Range<usize>) -> Result<DeviceVisibility<R>, RenderError> {
        let share = cuda.pool().zeros("shares of lights", rays * lights.len())?;
        Ok(DeviceVisibility { rays, lights, share, passed: None, used: None, weighed: false })
    }

    /// Where the shares of light 0 would be: kernels find those of a light by its number.
    pub(crate) fn planes(&self) -> Out<f32> {
        let before = self.lights.start as u64 * self.rays as u64 * size_of::<f32>() as u64;
        Out::to(self.share.output().address().wrapping_sub(before))
    }

    /// The same for what is let through; null if nothing was asked.
    pub(crate) fn passed_planes(&self) -> Out<Vec3> {
        let before = self.lights.start as u64 * self.rays as u64 * size_of::<Vec3>() as u64;
        let start = self.passed.as_ref().map(|passed| Out::to(passed.output().address().wrapping_sub(before)));
        start.unwrap_or(Out::NULL)
    }

    /// Reads the shares, by light, then ray.
    ///
    /// # Errors
    /// [`RenderError::DeviceFault`] if the device fails.
    pub fn read(&self) -> Result<Vec<f32>, RenderError> {
        Ok(self.share.read()?)
    }
}

impl<R: Runtime> DeviceRays<R> {
    /// Rays of a list, at most one of each pixel, or without any the camera's.
    pub(crate) fn new(record: Rays, list: Option<Buffer<R, ListedRay>>, spacing: [f32; 2]) -> DeviceRays<R> {
        DeviceRays { record, list, cones: None, spacing, several: false, are_fragments: false, sampled: None }
    }

    /// Whether the rays come from the camera rather than from mirrors.
    pub(crate) fn is_from_camera(&self) -> bool {
        self.list.is_none()
    }

    /// Whether textures are filtered.
    pub(crate) fn has_cones(&self) -> bool {
        let Cone { width, spread } = self.record.cone;
        self.cones.is_some() || width != 0.0 || spread != 0.0
    }

    /// Number of rays.
    pub(crate) fn len(&self) -> usize {
        self.record.count as usize
    }

    /// Number of blocks of `edge`² threads with one ray per thread: tiles of a camera's rows, runs of a list.
    pub(crate) fn blocks(&self, edge: u32) -> u64 {
        if !self.is_from_camera() {
            return u64::from(self.record.count.div_ceil(edge * edge));
        }
        let width = self.record.view.size[0];
        let rows = self.record.count / width;
        u64::from(width.div_ceil(edge)) * u64::from(rows.div_ceil(edge))
    }
}
