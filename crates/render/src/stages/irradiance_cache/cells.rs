//! Surface cells: cubes of space, and one point of each kind of surface in them, a *record*.
//!
//! A cell is a cube of a power of two, the *level*. Its records depend on the cell and on the geometry alone, not on the rays that ask for it:
//! so does all that is computed for them, in whatever order, for this image and for others. Twin: `cells.cuh`.

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

use glam::{IVec3, Vec3};
use lightmesh_layout::constants::{
    CELL_INDEX_BITS, CELL_OFFSET_X, CELL_OFFSET_Y, CELL_OFFSET_Z, GOLDEN_RATIO, LEVEL_BIAS, MAX_LEVEL, MIN_LEVEL,
    MIN_SQUARE, NODE_OPEN, NODE_REACH, RECORD_CANDIDATES, RECORD_INWARDS, RECORD_OPEN, RECORD_RADIUS, RECORD_RAISED,
    SURFACE_KINDS,
};
use lightmesh_scene::Bounds;
use lightmesh_trace::accel::{Hit, Ray, Region, Triangle};
use rayon::prelude::*;

use crate::prepared::PreparedScene;
use crate::surface::SurfacePoint;

/// Cells are offset from round coordinates, on which floors and walls tend to lie, by this fraction of their size.
const OFFSET: Vec3 = Vec3::new(CELL_OFFSET_X, CELL_OFFSET_Y, CELL_OFFSET_Z);

/// A kind of surface.
pub(super) type Kind = u8;

/// A cell in 58 bits: level, then index along z, y and x.
pub(super) type CellKey = u64;

/// Bits of a kind of surface in names.
pub(super) const KIND_BITS: u32 = 4;
pub(super) const KIND: u64 = (1 << KIND_BITS) - 1;
/// The most levels by which the cell of a node is smaller than what was asked at first, as bits of its name.
pub(super) const FINER: u64 = 3;
/// Bits of names of nodes that follow that of their cell: these levels, and the kind.
pub(super) const NAME_BITS: u32 = KIND_BITS + FINER.count_ones();

/// The largest power of two up to `width`, as its exponent, and the rest, from 1 to 2.
#[inline(always)]
pub(super) fn level_of(width: f32) -> (i32, f32) {
    let bits = width.max(f32::MIN_POSITIVE).to_bits();
    (((bits >> 23) as i32 - 127).clamp(MIN_LEVEL, MAX_LEVEL), f32::from_bits(bits & 0x7f_ffff | 0x3f80_0000))
}

/// The size of the cells of a level.
#[inline(always)]
pub(super) fn size_of_level(level: i32) -> f32 {
    f32::from_bits(((level + 127) as u32) << 23)
}

/// The cell of a level in which a position lies.
#[inline(always)]
pub(super) fn cell_at(level: i32, position: Vec3) -> IVec3 {
    (position / size_of_level(level) + OFFSET).floor().as_ivec3()
}

/// The lowest corner of a cell.
#[inline(always)]
pub(super) fn corner_of(level: i32, cell: IVec3) -> Vec3 {
    (cell.as_vec3() - OFFSET) * size_of_level(level)
}

#[inline(always)]
pub(super) fn key_of(level: i32, cell: IVec3) -> CellKey {
    let axis = |index: i32| u64::from(index as u32 & ((1 << CELL_INDEX_BITS) - 1));
    let level = (level + LEVEL_BIAS) as u64;
    level << (3 * CELL_INDEX_BITS)
        | axis(cell.z) << (2 * CELL_INDEX_BITS)
        | axis(cell.y) << CELL_INDEX_BITS
        | axis(cell.x)
}

/// A point of the surfaces in a cell.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Record {
    pub(super) point: SurfacePoint,
    pub(super) level: i32,
    /// Distinguishes its random pattern from others.
    pub(super) seed: u64,
}

/// The records of some cells.
#[derive(Default)]
pub(super) struct Cells {
    /// The first record of each cell, and their number.
    pub(super) ranges: HashMap<CellKey, (u32, u32), BuildHasherDefault<CellHasher>>,
    pub(super) records: Vec<Record>,
}

/// Keys are mixed by the golden ratio.
#[derive(Default)]
pub(super) struct CellHasher(u64);

impl Hasher for CellHasher {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|&byte| self.write_u64(u64::from(byte)));
    }

    fn write_u64(&mut self, key: u64) {
        let mixed = (self.0 ^ key).wrapping_mul(GOLDEN_RATIO);
        self.0 = mixed ^ mixed >> 32;
    }
}

/// A cell that is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Asked {
    pub(super) key: CellKey,
    pub(super) level: i32,
    pub(super) cell: [i32; 3],
}

impl Asked {
    pub(super) fn new(level: i32, cell: IVec3) -> Asked {
        Asked { key: key_of(level, cell), level, cell: cell.to_array() }
    }

    fn bounds(&self) -> Bounds {
        let min = corner_of(self.level, self.cell.into());
        Bounds { min, max: min + size_of_level(self.level) }
    }
}

impl Cells {
    /// The numbers of the records of a cell.
    #[inline(always)]
    pub(super) fn of(&self, key: CellKey) -> std::ops::Range<u32> {
        self.ranges.get(&key).map_or(0..0, |&(first, count)| first..first + count)
    }

    /// Bytes in memory.
    pub(super) fn memory(&self) -> usize {
        self.ranges.capacity() * size_of::<(CellKey, (u32, u32))>() + self.records.capacity() * size_of::<Record>()
    }

    pub(super) fn has(&self, key: CellKey) -> bool {
        self.ranges.contains_key(&key)
    }

    /// Adds cells with their records. None of them is there.
    pub(super) fn admit(&mut self, scene: &PreparedScene, mut asked: Vec<Asked>) {
        asked.par_sort_unstable();
        asked.dedup();
        let found: Vec<Vec<Record>> = asked
            .par_chunks(64)
            .flat_map_iter(|asked| {
                let mut triangles = Vec::new();
                asked.iter().map(|asked| records_of(scene, asked, &mut triangles)).collect::<Vec<_>>()
            })
            .collect();
        self.ranges.reserve(asked.len());
        for (asked, records) in asked.iter().zip(found) {
            self.ranges.insert(asked.key, (self.records.len() as u32, records.len() as u32));
            self.records.extend(records);
        }
    }
}

/// The records of a cell: of each kind of surface the point nearest to its middle that lies in the cell.
fn records_of(scene: &PreparedScene, asked: &Asked, triangles: &mut Vec<u32>) -> Vec<Record> {
    let bounds = asked.bounds();
    scene.geometry.accelerator.triangles_in(&Region::within(bounds), triangles);
    let mut candidates: [Candidates; SURFACE_KINDS as usize] = Default::default();
    for &index in &*triangles {
        let triangle = &scene.geometry.triangles.at(index);
        let Some(kinds) = kinds_of(triangle) else { continue };
        let near = Near::new(bounds.center(), index, triangle);
        if near.point.cmpge(bounds.min).all() && near.point.cmple(bounds.max).all() {
            kinds.into_iter().for_each(|kind| candidates[usize::from(kind)].add(near));
        }
    }
    // Ways to a record end above it: in what is thinner, such as a rug, they would lead past the cover.
    let is_free = |record: &Record| is_free(scene, record, RECORD_RAISED * RECORD_RADIUS);
    let record = |(kind, candidates): (Kind, &Candidates)| candidates.record(scene, asked, kind).filter(is_free);
    (0..).zip(&candidates).filter_map(record).collect()
}

/// The record of a kind of surface that is nearest to a cell's middle, wherever it lies: the cell must have that kind. Whether nothing covers it.
pub(super) fn nearest_of_kind(
    scene: &PreparedScene,
    asked: &Asked,
    kind: Kind,
    triangles: &mut Vec<u32>,
) -> Option<(Record, bool)> {
    let bounds = asked.bounds();
    let (middle, size) = (bounds.center(), size_of_level(asked.level));
    // Cells may have many triangles: those in the middle come first.
    let mut share = NODE_REACH;
    while share <= 1.0 {
        let reach = share * size;
        let mut candidates = Candidates::default();
        let around = Region::near(Bounds { min: middle, max: middle }, reach);
        scene.geometry.accelerator.triangles_in(&around, triangles);
        for &index in &*triangles {
            let triangle = &scene.geometry.triangles.at(index);
            if kinds_of(triangle).is_some_and(|kinds| kinds.contains(&kind)) {
                let near = Near::new(middle, index, triangle);
                if near.square <= reach * reach {
                    candidates.add(near);
                }
            }
        }
        if let Some(found) = candidates.open_record(scene, asked, kind, NODE_OPEN) {
            return Some(found);
        }
        share *= 2.0;
    }
    None
}

/// The point of a triangle that is nearest to a cell's middle.
#[derive(Clone, Copy, Debug)]
struct Near {
    point: Vec3,
    /// The square of its distance.
    square: f32,
    triangle: u32,
    u: f32,
    v: f32,
}

impl Near {
    fn new(middle: Vec3, index: u32, triangle: &Triangle) -> Near {
        let (point, u, v) = closest_point(middle, triangle.corners());
        Near { point, square: (point - middle).length_squared(), triangle: index, u, v }
    }

    /// The surface point on its side. From edges it moves inwards: at corners of rooms, rays from an edge would begin in the other wall.
    fn surface_point(&self, scene: &PreparedScene, kind: Kind, size: f32) -> SurfacePoint {
        let triangle = &scene.geometry.triangles.at(self.triangle);
        let [a, b, c] = triangle.corners();
        let inwards = (a + b + c) / 3.0 - self.point;
        let share = (RECORD_INWARDS * size / inwards.length()).min(0.5);
        let inside = |weight: f32| weight + share * (1.0 / 3.0 - weight);
        let (u, v) = (inside(self.u), inside(self.v));
        let outward = outward(triangle);
        // As seen by a ray that comes from that side.
        let direction = if kind.is_multiple_of(2) { -outward } else { outward };
        let ray = Ray { origin: Vec3::ZERO, direction, t_max: f32::INFINITY };
        let hit = Hit { t: 0.0, u, v, triangle: self.triangle };
        SurfacePoint::new(&ray, &hit, triangle)
    }
}

/// Points of one kind of surface, the nearest first; of equal ones that of the first triangle.
#[derive(Default)]
struct Candidates {
    nearest: [Option<Near>; RECORD_CANDIDATES as usize],
}

impl Candidates {
    fn add(&mut self, near: Near) {
        let mut next = near;
        for place in &mut self.nearest {
            match place {
                Some(other) if (other.square, other.triangle) <= (next.square, next.triangle) => {}
                Some(other) => std::mem::swap(other, &mut next),
                None => {
                    *place = Some(next);
                    return;
                }
            }
        }
    }

    /// The first one that is not covered, such as a wall behind panels; the nearest if all are, or if it is the only one.
    fn record(&self, scene: &PreparedScene, asked: &Asked, kind: Kind) -> Option<Record> {
        match self.nearest[1] {
            Some(_) => self.open_record(scene, asked, kind, RECORD_OPEN).map(|(record, _)| record),
            None => self.records(scene, asked, kind).next(),
        }
    }

    /// The first one above which nothing is within this distance, in cells, or the nearest if all are covered; which of both.
    fn open_record(&self, scene: &PreparedScene, asked: &Asked, kind: Kind, open: f32) -> Option<(Record, bool)> {
        let mut records = self.records(scene, asked, kind);
        let first = records.next()?;
        let is_open = |record: &Record| is_free(scene, record, open);
        let open = if is_open(&first) { Some(first) } else { records.find(is_open) };
        Some((open.unwrap_or(first), open.is_some()))
    }

    fn records(&self, scene: &PreparedScene, asked: &Asked, kind: Kind) -> impl Iterator<Item = Record> {
        let size = size_of_level(asked.level);
        let record = move |near: &Near| Record {
            point: near.surface_point(scene, kind, size),
            level: asked.level,
            seed: asked.key << 4 | u64::from(kind),
        };
        self.nearest.iter().flatten().map(record)
    }
}

/// Whether nothing is above a record within this distance, in cells.
fn is_free(scene: &PreparedScene, record: &Record, cells: f32) -> bool {
    let t_max = cells * size_of_level(record.level);
    let ray = Ray { origin: record.point.origin, direction: record.point.normal, t_max };
    let mut hidden = [false];
    scene.geometry.accelerator.occluded(&[ray], &mut hidden);
    !hidden[0]
}

/// Along the normal of a triangle's front.
#[inline(always)]
pub(super) fn outward(triangle: &Triangle) -> Vec3 {
    let [a, b, c] = triangle.corners();
    (b - a).cross(c - a)
}

/// The kinds of surface that the front and the back of a triangle are; `None` for needles.
#[inline(always)]
fn kinds_of(triangle: &Triangle) -> Option<[Kind; 2]> {
    let outward = outward(triangle);
    if !triangle.is_usable() || outward.length_squared() <= MIN_SQUARE {
        return None;
    }
    Some([kind_of(outward, true), kind_of(-outward, false)])
}

/// The kind of the side of a surface that `normal` leaves: even on fronts.
#[inline(always)]
pub(super) fn kind_of(normal: Vec3, front: bool) -> Kind {
    let Vec3 { x, y, z } = normal.abs();
    let axis = if x >= y && x >= z {
        0
    } else if y >= z {
        1
    } else {
        2
    };
    4 * axis as Kind + 2 * Kind::from(normal[axis] < 0.0) + Kind::from(!front)
}

/// The point of a triangle that is closest to `p`, with the weights of its second and third corner (Ericson: *Real-Time Collision Detection*,
/// 5.1.5).
fn closest_point(p: Vec3, [a, b, c]: [Vec3; 3]) -> (Vec3, f32, f32) {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    let at = |u: f32, v: f32| (a + u * ab + v * ac, u, v);
    if d1 <= 0.0 && d2 <= 0.0 {
        return at(0.0, 0.0);
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return at(1.0, 0.0);
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return at(d1 / (d1 - d3), 0.0);
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return at(0.0, 1.0);
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return at(0.0, d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        let w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return at(1.0 - w, w);
    }
    let sum = va + vb + vc;
    if sum > 0.0 { at(vb / sum, vc / sum) } else { at(0.0, 0.0) }
}
