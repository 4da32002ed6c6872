//! Rows of an image in a device's memory.

use std::ops::Range;

use lightmesh_image::Matte;
use lightmesh_kernels::{Buffer, Runtime};
use lightmesh_layout::Out;
use lightmesh_layout::geometry::Vec3;
use lightmesh_layout::stages::{PixelSamples, Shade};
use lightmesh_scene::Geometry;

use super::device::Cuda;
use super::rays::DeviceRays;
use crate::data::mattes::{slots_of, write_ranks};
use crate::data::picture::{Picture, light_groups_of};
use crate::error::RenderError;
use crate::plan::Plan;

/// Radiance and, if requested, layers of some rows.
pub struct DeviceFilm<R: Runtime> {
    rows: Range<u32>,
    kept: Range<u32>,
    width: u32,
    color: Buffer<R, Vec3>,
    coverage: Option<Buffer<R, f32>>,
    /// What is seen of what is behind everything, by pixel.
    caught: Option<Buffer<R, f32>>,
    layers: Option<DeviceLayers<R>>,
    /// The radiance of each ray of a wave, while groups of lights follow or pixels have several rays.
    sums: Option<Buffer<R, Vec3>>,
    /// The share of that in each of them.
    ray_caught: Option<Buffer<R, f32>>,
}

struct DeviceLayers<R: Runtime> {
    lights: u32,
    depth: Buffer<R, f32>,
    normal: Buffer<R, Vec3>,
    position: Buffer<R, Vec3>,
    /// By light, then pixel.
    visibility: Buffer<R, f32>,
    used: Buffer<R, u32>,
    /// By light, then pixel, and then what belongs to no light.
    light_groups: Option<Buffer<R, Vec3>>,
    /// Number of the object by pixel, then of the material.
    ids: Option<Buffer<R, u32>>,
    /// If pixels have several samples: these by what they see.
    mattes: Option<DeviceMattes<R>>,
}

/// The samples of pixels by object, then by material: slot by slot a number by pixel, then a count by pixel.
struct DeviceMattes<R: Runtime> {
    samples: u32,
    slots: usize,
    words: Buffer<R, u32>,
}

impl<R: Runtime> DeviceFilm<R> {
    /// Black rows: all that are rendered, and those of them that are kept.
    pub(crate) fn new(
        cuda: &Cuda<R>,
        plan: &Plan,
        [rows, kept]: [Range<u32>; 2],
    ) -> Result<DeviceFilm<R>, RenderError> {
        let pool = &cuda.pool;
        let (width, pixels) = (plan.size[0], plan.size[0] as usize * rows.len());
        let mattes = plan.compositing && plan.pixel_samples() > 1;
        let layers = plan.layers.map(|lights| {
            Ok::<_, RenderError>(DeviceLayers {
                lights: lights as u32,
                depth: pool.zeros("layer Z", pixels)?,
                normal: pool.zeros("layer N", pixels)?,
                position: pool.zeros("layer P", pixels)?,
                visibility: pool.zeros("layers V", pixels * lights)?,
                used: pool.zeros("layer M", pixels)?,
                light_groups: plan.compositing.then(|| pool.zeros("layers L", pixels * (lights + 1))).transpose()?,
                ids: plan.compositing.then(|| pool.zeros("layers id", 2 * pixels)).transpose()?,
                mattes: mattes.then(|| DeviceMattes::new(cuda, plan.pixel_samples(), pixels)).transpose()?,
            })
        });
        let layers = layers.transpose()?;
        let coverage = plan.coverage.then(|| pool.zeros("coverage", pixels)).transpose()?;
        let caught = plan.caught.then(|| pool.zeros("light of shadow catchers", pixels)).transpose()?;
        let color = pool.zeros("radiance", pixels)?;
        Ok(DeviceFilm { rows, kept, width, color, coverage, caught, layers, sums: None, ray_caught: None })
    }

    /// Makes room for the sums of a wave of `rays` rays if they have to wait for other groups of lights, where there is none yet.
    pub(crate) fn begin_sums(&mut self, cuda: &Cuda<R>, rays: usize, wait: bool) -> Result<(), RenderError> {
        if !wait || self.sums.as_ref().is_some_and(|sums| sums.len() < rays) {
            self.sums = None;
        }
        if wait && self.sums.is_none() {
            self.sums = Some(cuda.pool.room("radiance of rays", rays)?);
            if self.caught.is_some() {
                self.ray_caught = Some(cuda.pool.room("light of shadow catchers by ray", rays)?);
            }
        }
        Ok(())
    }

    /// Writes the film's addresses into the arguments of `shade`. Layers contain what the camera sees.
    pub(crate) fn expose(&self, rays: &DeviceRays<R>, arguments: &mut Shade) {
        arguments.film_pixel = u64::from(self.rows.start) * u64::from(self.width);
        arguments.film_pixels = self.color.len() as u64;
        arguments.color = self.color.output();
        arguments.sums = self.sums.as_ref().map_or(Out::NULL, Buffer::output);
        let sees = rays.is_from_camera() || rays.are_fragments;
        let caught = |plane: &Option<Buffer<R, f32>>| plane.as_ref().map_or(Out::NULL, Buffer::output);
        (arguments.caught, arguments.ray_caught) = (caught(&self.caught), caught(&self.ray_caught));
        let layers = self.layers.as_ref().filter(|_| sees);
        arguments.visibility = layers.map_or(Out::NULL, |layers| layers.visibility.output());
        arguments.light_points = layers.map_or(Out::NULL, |layers| layers.used.output());
        // Rays from mirrors add to these, too.
        arguments.light_groups = self.light_groups().map_or(Out::NULL, Buffer::output);
        // With several samples, these are the nearest one's.
        let layers = layers.filter(|_| rays.is_from_camera() && rays.sampled.is_none());
        arguments.depth = layers.map_or(Out::NULL, |layers| layers.depth.output());
        arguments.normal = layers.map_or(Out::NULL, |layers| layers.normal.output());
        arguments.position = layers.map_or(Out::NULL, |layers| layers.position.output());
        arguments.ids = layers.and_then(|layers| layers.ids.as_ref()).map_or(Out::NULL, Buffer::output);
    }

    /// The same for the samples of pixels.
    pub(crate) fn expose_to_samples(&self, arguments: &mut PixelSamples) {
        arguments.film_pixels = self.color.len() as u64;
        arguments.color = self.color.output();
        arguments.coverage = self.coverage.as_ref().map_or(Out::NULL, Buffer::output);
        arguments.caught = self.caught.as_ref().map_or(Out::NULL, Buffer::output);
        if let Some(layers) = &self.layers {
            arguments.light_count = layers.lights;
            arguments.depth = layers.depth.output();
            arguments.normal = layers.normal.output();
            arguments.position = layers.position.output();
            arguments.visibility = layers.visibility.output();
            arguments.light_points = layers.used.output();
            arguments.light_groups = self.light_groups().map_or(Out::NULL, Buffer::output);
            arguments.ids = layers.ids.as_ref().map_or(Out::NULL, Buffer::output);
            if let Some(mattes) = &layers.mattes {
                arguments.mattes = mattes.words.output();
                arguments.matte_slots = mattes.slots as u32;
            }
        }
    }

    /// Whether samples add to coverage or layers.
    pub(crate) fn keeps_samples(&self) -> bool {
        self.coverage.is_some() || self.layers.is_some()
    }

    fn light_groups(&self) -> Option<&Buffer<R, Vec3>> {
        self.layers.as_ref().and_then(|layers| layers.light_groups.as_ref())
    }

    /// Whether the radiance of each light by itself is kept.
    pub(crate) fn has_light_groups(&self) -> bool {
        self.light_groups().is_some()
    }

    /// Whether samples are counted by what they see.
    pub(crate) fn has_mattes(&self) -> bool {
        self.layers.as_ref().is_some_and(|layers| layers.mattes.is_some())
    }

    /// The places of the first pixel that is kept, and of the end.
    pub(crate) fn kept_places(&self) -> [usize; 2] {
        [self.kept.start, self.kept.end].map(|row| (row - self.rows.start) as usize * self.width as usize)
    }

    /// Copies the kept rows to their place in the image.
    pub(crate) fn develop(&self, geometry: &Geometry, picture: &mut Picture) -> Result<(), RenderError> {
        let places = picture.places(&self.kept);
        let [first, _] = self.kept_places();
        self.color.read_into(first, bytemuck::cast_slice_mut(&mut picture.color[places.clone()]))?;
        if let (Some(from), Some(to)) = (&self.coverage, &mut picture.coverage) {
            from.read_into(first, &mut to[places.clone()])?;
        }
        if let (Some(from), Some(to)) = (&self.caught, &mut picture.caught) {
            from.read_into(first, &mut to[places.clone()])?;
        }
        let (Some(from), Some(to)) = (&self.layers, &mut picture.layers) else { return Ok(()) };
        from.depth.read_into(first, &mut to.depth[places.clone()])?;
        from.normal.read_into(first, bytemuck::cast_slice_mut(&mut to.normal[places.clone()]))?;
        from.position.read_into(first, bytemuck::cast_slice_mut(&mut to.position[places.clone()]))?;
        from.used.read_into(first, &mut to.used[places.clone()])?;
        for (light, plane) in to.visibility.iter_mut().enumerate() {
            from.visibility.read_into(light * self.color.len() + first, &mut plane[places.clone()])?;
        }
        if let Some(from) = &from.light_groups {
            for (group, plane) in light_groups_of(to).enumerate() {
                let plane = bytemuck::cast_slice_mut(&mut plane[places.clone()]);
                from.read_into(group * self.color.len() + first, plane)?;
            }
        }
        let pixels = self.color.len();
        for (number, matte) in [&mut to.object, &mut to.material].into_iter().enumerate() {
            if let Some(from) = &from.ids {
                from.read_into(number * pixels + first, &mut matte.nearest[places.clone()])?;
            }
            if let Some(from) = &from.mattes {
                from.develop(number, pixels, first, matte, &places)?;
            }
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

impl<R: Runtime> DeviceMattes<R> {
    fn new(cuda: &Cuda<R>, samples: u32, pixels: usize) -> Result<DeviceMattes<R>, RenderError> {
        let slots = slots_of(samples);
        Ok(DeviceMattes { samples, slots, words: cuda.pool.zeros("mattes", 4 * slots * pixels)? })
    }

    /// Writes what the pixels from place `first` on see to their `places` in a matte; `number` is 0 for objects, 1 for materials.
    fn develop(
        &self,
        number: usize,
        pixels: usize,
        first: usize,
        matte: &mut Matte,
        places: &Range<usize>,
    ) -> Result<(), RenderError> {
        let mut planes = vec![vec![0_u32; places.len()]; 2 * self.slots];
        for (plane, words) in planes.iter_mut().enumerate() {
            self.words.read_into((2 * number * self.slots + plane) * pixels + first, words)?;
        }
        let mut slots = vec![[0; 2]; self.slots];
        for (index, pixel) in places.clone().enumerate() {
            for (slot, words) in slots.iter_mut().zip(planes.chunks_exact(2)) {
                *slot = [words[0][index], words[1][index]];
            }
            write_ranks(&slots, self.samples, matte, pixel);
        }
        Ok(())
    }
}
