//! The visibility of lights at surface points.

use std::ops::Range;

use glam::Vec3;

/// The visibility of each light at each surface point, including χ: 0 if the light is behind the surface.
///
/// On devices, [`DeviceVisibility`](crate::gpu::rays::DeviceVisibility) has the same form: a plane of shares for each light.
#[derive(Clone, Debug, Default)]
pub struct Visibility {
    /// Number of rays.
    pub rays: usize,
    /// The numbers of the lights.
    pub lights: Range<usize>,
    /// Shares in [0, 1] by light, then ray; 0 for rays that missed.
    pub share: Vec<f32>,
    /// What is left of each light after surfaces that are not opaque, by light, then ray; shares are the means of its channels. Empty if
    /// all are opaque.
    pub passed: Vec<Vec3>,
    /// Number of light points that each ray's surface point used; empty if the technique uses none.
    pub used: Vec<u32>,
    /// Whether the shares of lights that are near or wide are those of what is above the horizon, by the weights of their samples.
    pub weighed: bool,
}

impl Visibility {
    /// No visibility of the lights numbered `lights` from `rays` rays.
    pub(crate) fn dark(lights: Range<usize>, rays: usize) -> Visibility {
        Visibility { rays, share: vec![0.0; lights.len() * rays], lights, ..Visibility::default() }
    }

    /// The share of light number `light` that ray number `ray` sees.
    #[inline(always)]
    pub fn of(&self, light: usize, ray: usize) -> f32 {
        self.share[(light - self.lights.start) * self.rays + ray]
    }

    /// What is left of light number `light` at ray number `ray`.
    #[inline(always)]
    pub(crate) fn color(&self, light: usize, ray: usize) -> Vec3 {
        let place = (light - self.lights.start) * self.rays + ray;
        self.passed.get(place).copied().unwrap_or(Vec3::splat(self.share[place]))
    }

    /// Takes over what `part` knows of the rays in `range`.
    pub(crate) fn put(&mut self, range: Range<usize>, part: &Visibility) {
        let planes = self.share.chunks_exact_mut(self.rays.max(1));
        for (plane, part) in planes.zip(part.share.chunks_exact(part.rays.max(1))) {
            plane[range.clone()].copy_from_slice(part);
        }
    }

    /// The planes of the lights, split into parts of `size` rays: for each part a slice of every plane.
    pub(crate) fn parts(&mut self, size: usize) -> Vec<Vec<&mut [f32]>> {
        let planes = self.share.chunks_exact_mut(self.rays.max(1));
        in_parts(self.rays.div_ceil(size), planes.map(|plane| plane.chunks_mut(size)))
    }

    /// The same with what is left in each part.
    pub(crate) fn colored_parts(&mut self, size: usize) -> Vec<Vec<(&mut [f32], &mut [Vec3])>> {
        let rays = self.rays.max(1);
        let planes = self.share.chunks_exact_mut(rays).zip(self.passed.chunks_exact_mut(rays));
        let slices = planes.map(|(shares, passed)| shares.chunks_mut(size).zip(passed.chunks_mut(size)));
        in_parts(self.rays.div_ceil(size), slices)
    }
}

/// For each part the slices of all planes, which are split into so many.
fn in_parts<T>(parts: usize, planes: impl Iterator<Item = impl Iterator<Item = T>>) -> Vec<Vec<T>> {
    let mut slices: Vec<Vec<T>> = (0..parts).map(|_| Vec::new()).collect();
    for plane in planes {
        for (part, slice) in slices.iter_mut().zip(plane) {
            part.push(slice);
        }
    }
    slices
}
