//! Which rays share a packet.

use super::size::RAYS;
use crate::accel::Ray;
use crate::accel::ray_clamp::{ClampedRay, RayClamp};
use crate::accel::triangle::largest_axis;

/// Kinds of rays: three axes, eight octants.
const KINDS: usize = 24;

/// The rays of a chunk that can hit something, by kind.
#[derive(Default)]
pub(super) struct Order {
    /// Each with its index in the chunk.
    pub(super) rays: Vec<(ClampedRay, usize)>,
    kinds: Vec<u8>,
    /// Indices into `rays`, sorted by kind.
    sorted: Vec<u16>,
}

impl Order {
    #[inline(always)]
    pub(super) fn sort(&mut self, ray_clamp: &RayClamp, rays: &[Ray]) {
        self.rays.clear();
        self.kinds.clear();
        let mut starts = [0; KINDS + 1];
        for (index, ray) in rays.iter().enumerate() {
            if let Some(near) = ray_clamp.ray(ray) {
                let kind = kind(&near);
                starts[usize::from(kind) + 1] += 1;
                self.kinds.push(kind);
                self.rays.push((near, index));
            }
        }
        // A counting sort, stable: neighbours stay together.
        for kind in 0..KINDS {
            starts[kind + 1] += starts[kind];
        }
        self.sorted.resize(self.rays.len(), 0);
        for (index, &kind) in self.kinds.iter().enumerate() {
            let place = &mut starts[usize::from(kind)];
            self.sorted[*place] = index as u16;
            *place += 1;
        }
    }

    /// Rays of one kind from `start` on, at most as many as fit into a packet.
    #[inline(always)]
    pub(super) fn packet(&self, start: usize) -> &[u16] {
        let rest = &self.sorted[start..];
        let kind = self.kind(rest[0]);
        let mut count = 1;
        while count < rest.len().min(RAYS) && self.kind(rest[count]) == kind {
            count += 1;
        }
        &rest[..count]
    }

    #[inline(always)]
    pub(super) fn kind(&self, index: u16) -> u8 {
        self.kinds[usize::from(index)]
    }
}

/// Signs of the direction (bit k: axis k negative), plus eight times the axis of its largest component.
#[inline(always)]
fn kind(near: &ClampedRay) -> u8 {
    let direction = near.direction;
    let negative = |component: f32| u8::from(component.is_sign_negative());
    let signs = negative(direction.x) | negative(direction.y) << 1 | negative(direction.z) << 2;
    signs | (largest_axis(direction) as u8) << 3
}
