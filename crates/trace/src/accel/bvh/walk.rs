//! The walk over compressed wide nodes, for rays and segments.
//!
//! # Theory
//!
//! A walk holds two groups. A *node group* is a set of sibling nodes still to be entered: the index of the first sibling, and a
//! word with a hit bit for each slot (bits 24–31, nearest octant highest) above the mask of inner slots (bits 0–7). A *triangle
//! group* is a set of triangles still to be tested: the index of the first, and a bit for each (bits 0–23).
//!
//! # The margin
//!
//! Let ε = 2⁻²⁴ and S the largest coordinate, relative to the ray's origin, of the node's frame.
//! [`RayShear::intersect`](crate::accel::triangle::RayShear::intersect) reports points that lie up to 9 ε S outside their
//! triangle. The slab test itself rounds by at most 12 ε S: ε S for the frame's origin, 2 ε S for its product with the
//! reciprocal direction, 4 ε S for the plane (whose offset is at most 2 S), and 3 ε S for the sum; 2 ε S for the margin. So a
//! margin of γ S with γ = 2⁻¹⁹ = 32 ε on both sides of every slab never loses a hit. It is the same for all eight children, so
//! it costs next to nothing.
//!
//! A direction component below 2⁻³⁰ of the largest is replaced by that bound, sign kept: over the length of a node this moves
//! the ray by 2⁻²⁹ S at most, and γ S times the reciprocal then exceeds every `t` in the node. No reciprocal is infinite, no
//! product NaN.

use fearless_simd::f32x8;
use fearless_simd::prelude::*;
use fearless_simd_macros::simd;
use glam::{Vec3, Vec3A};
use lightmesh_layout::constants::{BVH_MARGIN, FIRST_INNER, INNER_HITS, MIN_COMPONENT, ROOT_HIT, TRIANGLE_HITS};

use super::tree::{Bvh, Node};
use crate::accel::visit::{All, Any, Closest, Short, Visitor};
use crate::accel::{Hit, Instanced, Ray, ShortSegments, Triangle};

/// Entries of the stack that lies in registers and cache; deeper trees, which only hostile input produces, get one from the heap.
const STACK: usize = 32;

/// A set of siblings to enter, or of triangles to test.
#[derive(Clone, Copy, Default)]
pub(super) struct Group {
    pub(super) base: u32,
    pub(super) bits: u32,
}

/// A ray prepared for the slab tests.
#[derive(Clone, Copy)]
pub(super) struct Slabs {
    origin: Vec3A,
    inverse: Vec3A,
    /// Margin for a node of unit distance, in units of the ray parameter.
    margin: Vec3A,
    /// Added to the distance S: how far outside of a box the ray may pass and still count.
    slack: f32,
    /// The octant that the ray points into: traversal order is slot xor this.
    octant: u32,
}

impl Slabs {
    #[inline(always)]
    pub(super) fn new(origin: Vec3, direction: Vec3, slack: f32) -> Slabs {
        let least = MIN_COMPONENT * direction.abs().max_element();
        let direction = direction.abs().max(Vec3::splat(least)).copysign(direction);
        let (origin, inverse) = (Vec3A::from(origin), Vec3A::from(direction.recip()));
        let octant = octant_of(direction);
        Slabs { origin, inverse, margin: BVH_MARGIN * inverse.abs(), slack: slack / BVH_MARGIN, octant }
    }
}

/// The octant that a direction points into: in the order of slot xor this, near children come first.
#[inline(always)]
pub(super) fn octant_of(direction: Vec3) -> u32 {
    let onward = |component: f32| u32::from(component >= 0.0);
    onward(direction.x) << 2 | onward(direction.y) << 1 | onward(direction.z)
}

#[simd]
pub(super) fn closest_hits<S: Simd>(simd: S, bvh: &Bvh, rays: &[Ray], hits: &mut [Hit]) {
    let mut stack = Stack::new(bvh.depth);
    for (hit, ray) in hits.iter_mut().zip(rays) {
        *hit = bvh.ray_clamp.ray(ray).map_or(Hit::MISS, |near| {
            let mut closest = Closest::new(&near, &bvh.alpha_mask);
            walk(simd, bvh, 0, &Walked::new(near.origin, near.direction, 0.0), stack.entries(), &mut closest);
            near.finish(closest.best)
        });
    }
}

#[simd]
pub(super) fn all_hits<S: Simd>(simd: S, bvh: &Bvh, rays: &[Ray], take: &mut dyn FnMut(usize, &[Hit])) {
    let (mut stack, mut hits) = (Stack::new(bvh.depth), Vec::new());
    for (number, ray) in rays.iter().enumerate() {
        let Some(near) = bvh.ray_clamp.ray(ray) else { continue };
        let mut all = All::new(&near, &bvh.alpha_mask, &mut hits);
        walk(simd, bvh, 0, &Walked::new(near.origin, near.direction, 0.0), stack.entries(), &mut all);
        all.finish(&near, |hits| take(number, hits));
    }
}

#[simd]
pub(super) fn occluded<S: Simd>(simd: S, bvh: &Bvh, segments: &[Ray], occluded: &mut [bool]) {
    let mut stack = Stack::new(bvh.depth);
    for (occluded, segment) in occluded.iter_mut().zip(segments) {
        *occluded = bvh.ray_clamp.ray(segment).is_some_and(|near| {
            let mut any = Any::new(&near, &bvh.alpha_mask);
            walk(simd, bvh, 0, &Walked::new(near.origin, near.direction, 0.0), stack.entries(), &mut any);
            any.hit
        });
    }
}

#[simd]
pub(super) fn short_segments<S: Simd>(simd: S, bvh: &Bvh, segments: &ShortSegments, blocked: &mut [bool]) {
    let mut stack = Stack::new(bvh.depth);
    for (blocked, &direction) in blocked.iter_mut().zip(segments.directions) {
        let mut short = Short::new(segments, direction);
        let ray = Walked::new(segments.test.origin, direction, segments.slack);
        walk(simd, bvh, 0, &ray, stack.entries(), &mut short);
        *blocked = short.blocked;
    }
}

/// A ray that walks, and which instances it is taken to.
pub(super) struct Walked {
    ray: (Vec3, Vec3),
    /// How far outside of a box it may pass and still count.
    slack: f32,
    slabs: Slabs,
}

impl Walked {
    #[inline(always)]
    pub(super) fn new(origin: Vec3, direction: Vec3, slack: f32) -> Walked {
        Walked { ray: (origin, direction), slack, slabs: Slabs::new(origin, direction, slack) }
    }
}

/// Visits the triangles of all leaves whose boxes the ray meets between 0 and the visitor's limit, near octants first.
#[inline(always)]
pub(super) fn walk<S: Simd>(
    simd: S,
    bvh: &Bvh,
    root: u32,
    ray: &Walked,
    stack: &mut [Group],
    visitor: &mut impl Visitor,
) {
    descend(bvh, root, ray.slabs.octant, stack, &mut RayGuide { simd, bvh, ray, visitor });
}

/// Visits the triangles of an instance in the same way, where they are in the scene. False ends the walk.
#[inline(never)]
pub(super) fn enter<S: Simd>(simd: S, bvh: &Bvh, number: usize, ray: &Walked, visitor: &mut impl Visitor) -> bool {
    let instance = &bvh.instances[number];
    let (origin, direction) = instance.ray(ray.ray);
    let slabs = &Slabs::new(origin, direction, instance.slack(ray.ray.0, ray.slack));
    let mut guide = ShapeGuide { simd, slabs, instance, visitor };
    descend(bvh, instance.tree.root, slabs.octant, Stack::new(bvh.shape_depth).entries(), &mut guide)
}

/// Decides where a descent through the tree goes.
pub(super) trait Guide {
    /// Bit k: enter the box of slot k.
    fn met(&self, node: &Node) -> u32;

    /// Takes a triangle of a leaf that is entered; `false` ends the descent.
    fn triangle(&mut self, triangle: &Triangle) -> bool;
}

/// A ray that looks for triangles.
struct RayGuide<'a, S: Simd, V: Visitor> {
    simd: S,
    bvh: &'a Bvh,
    ray: &'a Walked,
    visitor: &'a mut V,
}

/// The same within a shape.
struct ShapeGuide<'a, S: Simd, V: Visitor> {
    simd: S,
    slabs: &'a Slabs,
    instance: &'a Instanced,
    visitor: &'a mut V,
}

impl<S: Simd, V: Visitor> Guide for ShapeGuide<'_, S, V> {
    #[inline(always)]
    fn met(&self, node: &Node) -> u32 {
        met_slots(self.simd, node, self.slabs, self.visitor.limit())
    }

    #[inline(always)]
    fn triangle(&mut self, triangle: &Triangle) -> bool {
        self.visitor.triangle(&self.instance.triangle(triangle))
    }
}

impl<S: Simd, V: Visitor> Guide for RayGuide<'_, S, V> {
    #[inline(always)]
    fn met(&self, node: &Node) -> u32 {
        met_slots(self.simd, node, &self.ray.slabs, self.visitor.limit())
    }

    #[inline(always)]
    fn triangle(&mut self, triangle: &Triangle) -> bool {
        match triangle.instance() {
            None => self.visitor.triangle(triangle),
            Some(number) => enter(self.simd, self.bvh, number, self.ray, self.visitor),
        }
    }
}

/// Visits the triangles of all leaves below `root` that the guide enters, in the order of slot xor `octant`. Returns whether the guide has
/// taken all of them.
#[inline(always)]
pub(super) fn descend(bvh: &Bvh, root: u32, octant: u32, stack: &mut [Group], guide: &mut impl Guide) -> bool {
    if bvh.nodes.is_empty() {
        return true;
    }
    // 1. Begin with the root, as if it were the only child in the slot entered first.
    let mut nodes = Group { base: root, bits: ROOT_HIT };
    let mut height = 0;
    loop {
        // 2. Take the first node out of its group; keep the rest for later.
        let bit = 31 - nodes.bits.leading_zeros();
        let siblings = nodes.bits;
        nodes.bits &= !(1 << bit);
        if nodes.bits > TRIANGLE_HITS {
            stack[height] = nodes;
            height += 1;
        }
        let slot = (bit - FIRST_INNER) ^ octant;
        let before = siblings & ((1 << slot) - 1) & 0xff;
        let node = &bvh.nodes[(nodes.base + before.count_ones()) as usize];

        // 3. Which of its children are entered?
        let hits = child_hits(node, guide.met(node), octant);
        nodes = Group { base: node.child_base_idx, bits: (hits & INNER_HITS) | u32::from(node.imask) };

        // 4. Take the triangles of those that are leaves.
        let mut triangles = hits & TRIANGLE_HITS;
        while triangles != 0 {
            let triangle = node.primitive_base_idx + triangles.trailing_zeros();
            triangles &= triangles - 1;
            if !guide.triangle(&bvh.triangles[triangle as usize]) {
                return false;
            }
        }

        // 5. No child left to enter: continue with the group most recently set aside.
        if nodes.bits <= TRIANGLE_HITS {
            if height == 0 {
                return true;
            }
            height -= 1;
            nodes = stack[height];
        }
    }
}

/// Bit k: the ray meets the box of slot k between 0 and `limit`.
#[inline(always)]
fn met_slots<S: Simd>(simd: S, node: &Node, slabs: &Slabs, limit: f32) -> u32 {
    // 1. The node's frame in units of the ray parameter.
    let extent = node.compute_extent();
    let offset = Vec3A::from(node.p) - slabs.origin;
    let margin = ((offset.abs() + 256.0 * extent).max_element() + slabs.slack) * slabs.margin;
    let scale = extent * slabs.inverse;
    let start = offset * slabs.inverse;
    let (near, far) = (start - margin, start + margin);

    // 2. Where the ray enters and leaves each child's slabs.
    let (near_x, far_x) = by_sign(slabs.inverse.x, &node.child_min_x, &node.child_max_x);
    let (near_y, far_y) = by_sign(slabs.inverse.y, &node.child_min_y, &node.child_max_y);
    let (near_z, far_z) = by_sign(slabs.inverse.z, &node.child_min_z, &node.child_max_z);
    let enter = planes(simd, near_x, scale.x, near.x)
        .max(planes(simd, near_y, scale.y, near.y))
        .max(planes(simd, near_z, scale.z, near.z));
    let leave = planes(simd, far_x, scale.x, far.x)
        .min(planes(simd, far_y, scale.y, far.y))
        .min(planes(simd, far_z, scale.z, far.z));

    // 3. Met if the slabs overlap within the segment.
    let met = enter.max(f32x8::splat(simd, 0.0)).simd_le(leave.min(f32x8::splat(simd, limit)));
    met.to_bitmask() as u32
}

/// Where eight planes lie: bytes times `scale`, from `start` on.
#[inline(always)]
pub(super) fn planes<S: Simd>(simd: S, bytes: &[u8; 8], scale: f32, start: f32) -> f32x8<S> {
    let [a, b, c, d, e, f, g, h] = *bytes;
    let planes = [a as f32, b as f32, c as f32, d as f32, e as f32, f as f32, g as f32, h as f32];
    f32x8::from_slice(simd, &planes) * scale + start
}

#[inline(always)]
fn by_sign<'a>(inverse: f32, low: &'a [u8; 8], high: &'a [u8; 8]) -> (&'a [u8; 8], &'a [u8; 8]) {
    if inverse < 0.0 { (high, low) } else { (low, high) }
}

/// The hit bits of a node group and a triangle group for the slots met: inner nodes from bit 24 on in traversal order, the
/// triangles of leaves below.
#[inline(always)]
pub(super) fn child_hits(node: &Node, mut met: u32, octant: u32) -> u32 {
    let mut hits = 0;
    while met != 0 {
        let slot = met.trailing_zeros();
        met &= met - 1;
        let meta = u32::from(node.child_meta[slot as usize & 7]);
        // Inner nodes have index 24 + slot, which the octant reorders; leaves the index of their first triangle.
        let order = if meta & 0b1_1000 == 0b1_1000 { octant } else { 0 };
        hits |= (meta >> 5) << ((meta & 0b1_1111) ^ order);
    }
    hits
}

/// The node groups left for later: at most one for each level of the tree.
pub(super) struct Stack {
    fixed: [Group; STACK],
    deep: Vec<Group>,
}

impl Stack {
    #[inline(always)]
    pub(super) fn new(depth: usize) -> Stack {
        let deep = if depth > STACK { vec![Group::default(); depth] } else { Vec::new() };
        Stack { fixed: [Group::default(); STACK], deep }
    }

    #[inline(always)]
    pub(super) fn entries(&mut self) -> &mut [Group] {
        if self.deep.is_empty() { &mut self.fixed } else { &mut self.deep }
    }
}
