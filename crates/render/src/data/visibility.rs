//! What surface points see of lights.

use std::ops::Range;

/// What each surface point sees of each light, with χ: 0 where the light is behind the surface.
///
/// The same on devices ([`DeviceVisibility`](crate::gpu::rays::DeviceVisibility)): a plane of shares for each light.
#[derive(Clone, Debug, Default)]
pub struct Visibility {
    /// Number of rays.
    pub rays: usize,
    /// Shares in [0, 1] by light, then ray; 0 for rays that missed.
    pub share: Vec<f32>,
    /// Light points that each ray's surface point used; empty where none are used at all.
    pub used: Vec<u32>,
}

impl Visibility {
    /// Nothing is seen of `lights` lights by `rays` rays.
    pub(crate) fn dark(lights: usize, rays: usize) -> Visibility {
        Visibility { rays, share: vec![0.0; lights * rays], used: Vec::new() }
    }

    /// The share of light number `light` that ray number `ray` sees.
    #[inline(always)]
    pub fn of(&self, light: usize, ray: usize) -> f32 {
        self.share[light * self.rays + ray]
    }

    /// Takes over what `part` knows of the rays in `range`.
    pub(crate) fn put(&mut self, range: Range<usize>, part: &Visibility) {
        let planes = self.share.chunks_exact_mut(self.rays.max(1));
        for (plane, part) in planes.zip(part.share.chunks_exact(part.rays.max(1))) {
            plane[range.clone()].copy_from_slice(part);
        }
    }

    /// The planes of all lights, cut into parts of `size` rays: for each part a slice of every plane.
    pub(crate) fn parts(&mut self, size: usize) -> Vec<Vec<&mut [f32]>> {
        let mut parts: Vec<Vec<&mut [f32]>> = (0..self.rays.div_ceil(size)).map(|_| Vec::new()).collect();
        for plane in self.share.chunks_exact_mut(self.rays.max(1)) {
            for (part, slice) in parts.iter_mut().zip(plane.chunks_mut(size)) {
                part.push(slice);
            }
        }
        parts
    }
}
