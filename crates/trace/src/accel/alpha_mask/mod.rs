//! Alpha: at which points a triangle that is cut out, such as a leaf or a fence, has a surface, and how opaque one is that lets light through.
//! Twin of the decisions: `alpha_mask.cuh`.
//!
//! ```text
//! opacity at (u, v) = mask(A · uv) × opacity of the corners,      a surface where that is at least the cutoff
//! ```
//!
//! Opacities and texture coordinates of the corners are interpolated barycentrically, texels of the mask bilinearly, at its finest level
//! whatever sees them: samples of a pixel, and of a light, average what they decide.
//!
//! A structure's triangle that is cut out holds the number of its entry here, others hold 0. So what is decided about a triangle costs
//! nothing more until an opaque one would be hit. Tests that give no barycentric weights, those of short segments and of samples in rows, ask
//! where the ray of the [watertight test](super::triangle::RayShear) meets the triangle: [`AlphaMask::stops`].

mod build;

use std::sync::Arc;

use glam::{Affine2, Vec2, Vec3};
use lightmesh_layout::constants::OPAQUE;
use lightmesh_layout::geometry::CutTriangle;
use lightmesh_scene::Wrap;
use xxhash_rust::xxh3::Xxh3;

use super::triangle::RayShear;
use super::{Hit, Triangle};
use crate::textures::neighbours;

pub use build::BYTES_TO_BUILD;

/// The opacities of cut-out triangles; clones share them.
#[derive(Clone, Debug, Default)]
pub struct AlphaMask {
    /// `None`: all triangles are opaque.
    table: Option<Arc<Table>>,
}

/// What is known of all triangles that are cut out.
#[derive(Debug, Default)]
pub struct Table {
    /// By number, from 1.
    pub triangles: Arc<[CutTriangle]>,
    /// By the number in [`CutTriangle::mask`].
    pub masks: Vec<Mask>,
    /// Opacities of texels, from 0 to 255, row by row.
    pub planes: Vec<Arc<[u8]>>,
}

/// How a material is cut out.
#[derive(Clone, Debug)]
pub struct Mask {
    /// Index of its opacities.
    pub plane: usize,
    /// Width and height.
    pub size: [u32; 2],
    /// How it goes on beyond its borders, along each axis.
    pub wrap: [Wrap; 2],
    /// From texture coordinates to those of the image.
    pub transform: Affine2,
    /// The cutoff, as texels count.
    pub limit: f32,
    /// Whether light goes through as far as the opacity is below 1.
    pub blends: bool,
}

impl AlphaMask {
    /// Everything that is cut out, if anything is.
    #[inline]
    pub fn table(&self) -> Option<&Table> {
        self.table.as_deref()
    }

    /// The same where what is at least half opaque is a surface, and the rest is none. Both share all but the masks.
    pub fn halved(&self) -> AlphaMask {
        let halve = |mask: &Mask| match mask.blends {
            true => Mask { limit: 0.5 * OPAQUE, blends: false, ..mask.clone() },
            false => mask.clone(),
        };
        let table = self.table().map(|table| Table {
            triangles: Arc::clone(&table.triangles),
            masks: table.masks.iter().map(halve).collect(),
            planes: table.planes.clone(),
        });
        AlphaMask { table: table.map(Arc::new) }
    }

    /// Adds all that decides where surfaces are to a hash.
    #[inline]
    pub fn add_to_hash(&self, hash: &mut Xxh3) {
        let Some(table) = self.table() else { return };
        hash.update(bytemuck::cast_slice(&table.triangles));
        for mask in &table.masks {
            // Numbers are shown with all digits that tell them apart.
            hash.update(format!("{mask:?}").as_bytes());
        }
        table.planes.iter().for_each(|plane| hash.update(plane));
    }

    /// Bytes on the heap.
    #[inline]
    pub fn memory(&self) -> usize {
        self.table().map_or(0, |table| {
            size_of_val(&*table.triangles) + table.planes.iter().map(|plane| plane.len()).sum::<usize>()
        })
    }

    /// Whether there is a surface where `triangle` is hit.
    #[inline(always)]
    pub(super) fn has(&self, triangle: &Triangle, hit: &Hit) -> bool {
        triangle.cut() == 0 || self.covers(triangle.cut(), hit.u, hit.v)
    }

    /// Whether there is a surface where the segment from `origin` along `direction` meets the plane of `triangle`. Only asked where another
    /// test says that it meets the triangle itself; next to its edge the two may differ, and there is none where this one says no.
    #[inline(always)]
    pub fn stops(&self, triangle: &Triangle, origin: Vec3, direction: Vec3) -> bool {
        triangle.cut() == 0 || self.stops_cut(triangle, origin, direction)
    }

    #[inline(never)]
    fn stops_cut(&self, triangle: &Triangle, origin: Vec3, direction: Vec3) -> bool {
        let met = RayShear::new(origin, direction).intersect(triangle);
        met.is_some_and(|(_, u, v)| self.covers(triangle.cut(), u, v))
    }

    /// Those of `lanes` in which there is a surface, of eight rays that hit one cut-out triangle.
    #[inline(never)]
    pub(super) fn covered_lanes(&self, cut: u32, u: [f32; 8], v: [f32; 8], lanes: u32) -> u32 {
        let covered = |lane: &usize| lanes >> lane & 1 != 0 && self.covers(cut, u[*lane], v[*lane]);
        (0..8).filter(covered).fold(0, |all, lane| all | 1 << lane)
    }

    /// Whether the cut-out triangle number `cut` has a surface at these barycentric weights of its second and third corner.
    #[inline(never)]
    pub fn covers(&self, cut: u32, u: f32, v: f32) -> bool {
        let Some(table) = self.table() else { return true };
        // NaN is nothing.
        table.value(cut, u, v) >= table.mask_of(cut).limit
    }

    /// How opaque `triangle` is where it is hit, from 0 to 1.
    #[inline]
    pub fn opacity(&self, triangle: &Triangle, hit: &Hit) -> f32 {
        match self.table() {
            Some(table) if triangle.cut() != 0 && table.mask_of(triangle.cut()).blends => {
                (table.value(triangle.cut(), hit.u, hit.v) / OPAQUE).min(1.0)
            }
            _ => 1.0,
        }
    }
}

impl Mask {
    /// What at least is opaque everywhere, as texels count.
    fn enough(&self) -> f32 {
        if self.blends { OPAQUE } else { self.limit }
    }
}

impl Table {
    /// The mask of cut-out triangle number `cut`.
    fn mask_of(&self, cut: u32) -> &Mask {
        &self.masks[self.triangles[cut as usize - 1].mask as usize]
    }

    /// The opacity of cut-out triangle number `cut` at these barycentric weights of its second and third corner, as texels count.
    fn value(&self, cut: u32, u: f32, v: f32) -> f32 {
        let own = &self.triangles[cut as usize - 1];
        let mask = &self.masks[own.mask as usize];

        // 1. The opacity of the corners; exactly theirs if it is the same.
        let [a, b, c] = own.opacities;
        let opacity = a + u * (b - a) + v * (c - a);

        // 2. The place in the mask.
        let [a, b, c] = own.uvs.map(Vec2::from);
        let place = mask.transform.transform_point2((1.0 - u - v) * a + u * b + v * c);

        // 3. What is there.
        opacity * mask.at(&self.planes[mask.plane], place)
    }
}

impl Mask {
    /// The four nearest texels, interpolated.
    fn at(&self, plane: &[u8], place: Vec2) -> f32 {
        let (columns, x) = neighbours(place.x, self.size[0], self.wrap[0]);
        let (rows, y) = neighbours(place.y, self.size[1], self.wrap[1]);
        let texel = |column: u32, row: u32| f32::from(plane[row as usize * self.size[0] as usize + column as usize]);
        let [upper, lower] = rows.map(|row| between(texel(columns[0], row), texel(columns[1], row), x));
        between(upper, lower, y)
    }
}

/// From `a` to `b`. Of whole numbers up to 255, and of such means of them, it is no less than the smallest: their differences are exact.
#[inline]
pub fn between(a: f32, b: f32, share: f32) -> f32 {
    a + share * (b - a)
}
