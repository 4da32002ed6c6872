//! Points given by the caller, on a device.

use std::sync::Arc;

use bytemuck::Zeroable;
use lightmesh_kernels::Runtime;
use lightmesh_layout::geometry::{Hit, ListedRay, Rays, Triangle};

use super::device::Cuda;
use super::rays::{DeviceHits, DeviceRays, DeviceVisibility};
use super::scene::{DeviceScene, vec3};
use crate::backend::Probed;
use crate::data::visibility::Visibility;
use crate::error::RenderError;
use crate::probes::Probes;

impl<R: Runtime> Cuda<R> {
    /// Given points as a wave of listed rays. Stages find the triangles that rays hit through the scene's record: in the scene of this wave
    /// they are the probes' own triangles, while the structures keep the triangles that hide lights.
    pub(crate) fn device_probes(&self, scene: &DeviceScene<R>, probes: &Probes) -> Result<Probed<Self>, RenderError> {
        let pool = self.pool();
        let listed: Vec<ListedRay> = (0..probes.hits.len()).map(|ray| listed(probes, ray)).collect();
        let list = pool.upload("rays to given points", &listed)?;
        let hits = pool.upload("hits of given points", bytemuck::cast_slice::<_, Hit>(&probes.hits))?;
        let triangles = pool.upload("given points", bytemuck::cast_slice::<_, Triangle>(&probes.rays.probes))?;
        let rays = Rays { list: list.input(), count: listed.len() as u32, ..Rays::zeroed() };
        let scene = scene.with_triangles(Arc::new(triangles));
        Ok((scene, DeviceRays::new(rays, Some(list), [0.0; 2]), DeviceHits { hits }))
    }
}

fn listed(probes: &Probes, ray: usize) -> ListedRay {
    let rays = &probes.rays;
    ListedRay {
        origin: vec3(rays.rays[ray].origin),
        pixel: rays.pixels[ray],
        direction: vec3(rays.rays[ray].direction),
        weight: vec3(rays.weight(ray)),
        ..ListedRay::zeroed()
    }
}

impl<R: Runtime> DeviceVisibility<R> {
    /// Copies the visibility to the host.
    ///
    /// # Errors
    /// [`RenderError::DeviceFault`] if the device fails.
    pub(crate) fn to_host(&self) -> Result<Visibility, RenderError> {
        let used = self.used.as_ref().map_or(Ok(Vec::new()), |used| used.read())?;
        let passed = self.passed.as_ref().map_or(Ok(Vec::new()), |passed| passed.read())?;
        let passed = bytemuck::cast_vec(passed);
        Ok(Visibility {
            rays: self.rays,
            lights: self.lights.clone(),
            share: self.read()?,
            passed,
            used,
            weighed: self.weighed,
        })
    }
}
