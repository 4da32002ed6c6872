//! Rows of an image in a device's memory.

use std::ops::Range;

use lightmesh_layout::Out;
use lightmesh_layout::geometry::Vec3;
use lightmesh_layout::stages::Shade;
use lightmesh_scene::Geometry;

use super::device::Cuda;
use crate::cuda::{Buffer, Runtime};
use crate::data::picture::Picture;
use crate::error::RenderError;
use crate::plan::Plan;

/// Radiance and, if requested, layers of some rows.
pub struct DeviceFilm<R: Runtime> {
    rows: Range<u32>,
    width: u32,
    color: Buffer<R, Vec3>,
    layers: Option<DeviceLayers<R>>,
    /// While groups of lights follow: the radiance of each ray of a wave of mirrors so far.
    sums: Option<Buffer<R, Vec3>>,
}

struct DeviceLayers<R: Runtime> {
    depth: Buffer<R, f32>,
    normal: Buffer<R, Vec3>,
    position: Buffer<R, Vec3>,
    /// By light, then pixel.
    visibility: Buffer<R, f32>,
    used: Buffer<R, u32>,
}

impl<R: Runtime> DeviceFilm<R> {
    pub(crate) fn new(cuda: &Cuda<R>, plan: &Plan, rows: Range<u32>) -> Result<DeviceFilm<R>, RenderError> {
        let pool = &cuda.pool;
        let pixels = plan.size[0] as usize * rows.len();
        let layers = plan.layers.map(|lights| {
            Ok::<_, RenderError>(DeviceLayers {
                depth: pool.zeros("layer Z", pixels)?,
                normal: pool.zeros("layer N", pixels)?,
                position: pool.zeros("layer P", pixels)?,
                visibility: pool.zeros("layers V", pixels * lights)?,
                used: pool.zeros("layer M", pixels)?,
            })
        });
        let layers = layers.transpose()?;
        Ok(DeviceFilm { rows, width: plan.size[0], color: pool.zeros("radiance", pixels)?, layers, sums: None })
    }

    /// Makes room for the sums of a wave of `rays` rays if they have to wait for other groups of lights, where there is none yet.
    pub(crate) fn begin_sums(&mut self, cuda: &Cuda<R>, rays: usize, wait: bool) -> Result<(), RenderError> {
        if !wait || self.sums.as_ref().is_some_and(|sums| sums.len() < rays) {
            self.sums = None;
        }
        if wait && self.sums.is_none() {
            self.sums = Some(cuda.pool.room("radiance of mirror rays", rays)?);
        }
        Ok(())
    }

    /// Writes the film's addresses into the arguments of `shade`. Layers contain what the camera sees.
    pub(crate) fn expose(&self, from_camera: bool, arguments: &mut Shade) {
        arguments.film_pixel = u64::from(self.rows.start) * u64::from(self.width);
        arguments.film_pixels = self.color.len() as u64;
        arguments.color = self.color.output();
        arguments.sums = self.sums.as_ref().map_or(Out::NULL, Buffer::output);
        let layers = self.layers.as_ref().filter(|_| from_camera);
        arguments.depth = layers.map_or(Out::NULL, |layers| layers.depth.output());
        arguments.normal = layers.map_or(Out::NULL, |layers| layers.normal.output());
        arguments.position = layers.map_or(Out::NULL, |layers| layers.position.output());
        arguments.visibility = layers.map_or(Out::NULL, |layers| layers.visibility.output());
        arguments.light_points = layers.map_or(Out::NULL, |layers| layers.used.output());
    }

    /// Copies the rows to their place in the image.
    pub(crate) fn develop(&self, geometry: &Geometry, picture: &mut Picture) -> Result<(), RenderError> {
        let places = picture.places(&self.rows);
        self.color.read_into(0, bytemuck::cast_slice_mut(&mut picture.color[places.clone()]))?;
        let (Some(from), Some(to)) = (&self.layers, &mut picture.layers) else { return Ok(()) };
        from.depth.read_into(0, &mut to.depth[places.clone()])?;
        from.normal.read_into(0, bytemuck::cast_slice_mut(&mut to.normal[places.clone()]))?;
        from.position.read_into(0, bytemuck::cast_slice_mut(&mut to.position[places.clone()]))?;
        from.used.read_into(0, &mut to.used[places.clone()])?;
        for (light, plane) in to.visibility.iter_mut().enumerate() {
            from.visibility.read_into(light * places.len(), &mut plane[places.clone()])?;
        }
        // The device uses the local frame, and 0 instead of infinity as the depth of a miss.
        for index in places {
            if to.depth[index] == 0.0 {
                to.depth[index] = f32::INFINITY;
            } else {
                let local = glam::Vec3::from(to.position[index]);
                to.position[index] = geometry.to_world(local).as_vec3().to_array();
            }
        }
        Ok(())
    }
}
