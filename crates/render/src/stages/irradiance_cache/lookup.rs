//! Which records a place takes light from, and how much from each. Twin: `lookup.cuh`.

use std::ops::Range;

use glam::{IVec3, Vec2, Vec3};
use lightmesh_layout::constants::{
    CELLS_AROUND, MIN_RISE, MIN_SPREAD, RECORD_COSINE, RECORD_MARGIN, RECORD_RADIUS, RECORD_RAISED, RECORD_STEP,
    RECORD_THICKNESS,
};
use lightmesh_scene::Bounds;
use lightmesh_trace::accel::{Hit, Ray};
use rayon::prelude::*;

use super::cells::{Asked, CellKey, Cells, cell_at, corner_of, key_of, size_of_level};
use super::directions::basis;
use super::scene::Scene;
use crate::surface::{SurfacePoint, long_segment};

/// Places per task.
const BATCH: usize = 256;

/// A place that light is asked for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub(super) position: Vec3,
    pub(super) normal: Vec3,
    pub(super) level: i32,
    open: Open,
}

/// How ways to records leave a place.
#[derive(Clone, Copy, Debug)]
struct Open {
    from: Vec3,
    /// A direction in which nothing is in the way,
    direction: Vec3,
    /// up to here.
    reach: f32,
}

impl Place {
    /// What is above it is found by [`Links::settle`].
    pub(super) fn new(point: &SurfacePoint, level: i32) -> Place {
        let open = Open { from: point.origin, direction: point.normal, reach: f32::INFINITY };
        Place { position: point.position, normal: point.normal, level, open }
    }

    /// A place that a ray of this direction hits at this distance: nothing is in its way.
    pub(super) fn seen(point: &SurfacePoint, level: i32, direction: Vec3, distance: f32) -> Place {
        let open = Open { from: point.position, direction: -direction, reach: distance };
        Place { position: point.position, normal: point.normal, level, open }
    }

    /// A ray to whatever is above it, as high as ways to records may begin.
    fn above(&self) -> Ray {
        let t_max = RECORD_RAISED * RECORD_RADIUS * size_of_level(self.level) / RECORD_STEP;
        Ray { origin: self.open.from, direction: self.normal, t_max }
    }

    /// The cell in which it lies.
    pub(super) fn cell(&self) -> IVec3 {
        cell_at(self.level, self.position)
    }

    /// The weight of a record: it falls with the distance, with the angle between normals, and with the distance from tangent planes.
    #[inline(always)]
    fn weight(&self, size: f32, record: &SurfacePoint) -> f32 {
        let way = record.position - self.position;
        let near = 1.0 - way.length_squared() / (RECORD_RADIUS * RECORD_RADIUS * size * size);
        let cosine = (self.normal.dot(record.normal) - RECORD_COSINE) / (1.0 - RECORD_COSINE);
        if near <= 0.0 || cosine <= 0.0 {
            return 0.0;
        }
        let height = self.normal.dot(way).abs().max(record.normal.dot(way).abs()) / (RECORD_THICKNESS * size);
        let flat = (1.0 - height * height).max(0.0);
        near * near * cosine * cosine * flat * flat
    }

    /// The segment to a record. Both ends are raised, as far as nothing is in the way: not through a thin board.
    pub(super) fn segment(&self, record: &SurfacePoint, covered: bool) -> Ray {
        let raised = RECORD_RAISED * (record.position - self.position).length();
        let Open { from, direction, reach } = self.open;
        let step = (raised / direction.dot(self.normal).max(MIN_RISE)).min(RECORD_STEP * reach);
        let end = if covered { record.origin } else { record.origin + raised * record.normal };
        long_segment(from + step * direction, end)
    }
}

/// A record with its weight.
pub(super) type Link = (u32, f32);

/// The records of some places, in batches.
pub(super) struct Links {
    batches: Vec<Batch>,
}

#[derive(Default)]
struct Batch {
    /// By place.
    ranges: Vec<Range<u32>>,
    links: Vec<Link>,
}

impl Links {
    /// Finds the records of places; their cells are added where they are new.
    pub(super) fn new(scene: &Scene, cells: &mut Cells, places: &[Place]) -> Links {
        let groups: Vec<Groups> = places.par_chunks(BATCH).map(Groups::new).collect();
        let missing = |groups: &Groups| -> Vec<Asked> {
            let asked = groups.cells.iter().filter(|asked| !cells.has(asked.key));
            asked.copied().collect()
        };
        let asked = groups.par_iter().flat_map_iter(missing).collect();
        cells.admit(scene.scene, asked);
        let cells = &*cells;
        let batches = places.par_chunks(BATCH).zip(&groups).map(|(places, groups)| groups.links(cells, places));
        Links { batches: batches.collect() }
    }

    /// Those of a place, but for hidden ones.
    pub(super) fn of(&self, place: usize) -> impl Iterator<Item = Link> + Clone {
        let batch = &self.batches[place / BATCH];
        let Range { start, end } = batch.ranges[place % BATCH];
        seen(&batch.links[start as usize..end as usize])
    }

    /// All records with a weight, once.
    pub(super) fn records(&self) -> Vec<u32> {
        let used = self.batches.par_iter().flat_map_iter(|batch| seen(&batch.links));
        let mut records: Vec<u32> = used.map(|(record, _)| record).collect();
        records.par_sort_unstable();
        records.dedup();
        records
    }

    /// Takes their weight from records that a place does not see, and balances the others. All are tested: that nothing is near in front of a record says
    /// nothing of what is behind its surface.
    pub(super) fn settle(&mut self, scene: &Scene, cells: &Cells, places: &[Place]) {
        self.batches.par_iter_mut().zip(places.par_chunks(BATCH)).for_each(|(batch, places)| {
            let mut segments = Vec::with_capacity(batch.links.len());
            let mut owners = Vec::with_capacity(batch.links.len());
            let above: Vec<Ray> = places.iter().map(Place::above).collect();
            let mut covers = vec![Hit::MISS; places.len()];
            scene.scene.geometry.accelerator.closest_hits(&above, &mut covers);
            for ((place, cover), range) in places.iter().zip(&covers).zip(&batch.ranges) {
                let place = Place { open: Open { reach: cover.t, ..place.open }, ..*place };
                for link in range.start as usize..range.end as usize {
                    segments.push(place.segment(&cells.records[batch.links[link].0 as usize].point, false));
                    owners.push(link);
                }
            }
            let mut hidden = vec![false; segments.len()];
            scene.scene.geometry.accelerator.occluded(&segments, &mut hidden);
            for (&link, _) in owners.iter().zip(&hidden).filter(|(_, hidden)| **hidden) {
                batch.links[link].1 = 0.0;
            }
            for (place, range) in places.iter().zip(&batch.ranges) {
                balance(cells, place, &mut batch.links[range.start as usize..range.end as usize]);
            }
        });
    }
}

/// Those that have a weight.
fn seen(links: &[Link]) -> impl Iterator<Item = Link> + Clone {
    links.iter().copied().filter(|&(_, weight)| weight > 0.0)
}

/// Places in one cell.
struct Around {
    level: i32,
    cell: IVec3,
    bounds: Bounds,
    /// Their normal, and the least and the greatest height along it, if they share one.
    plane: Option<(Vec3, [f32; 2])>,
}

impl Around {
    fn new<'p>(mut places: impl Iterator<Item = &'p Place> + Clone) -> Around {
        let bounds = Bounds::around(places.clone().map(|place| place.position));
        let mut all = places.clone();
        let first = places.next().expect("a group has a place");
        let normal = first.normal;
        let heights = all.try_fold([f32::INFINITY, f32::NEG_INFINITY], |[least, most], place| {
            let height = normal.dot(place.position);
            (place.normal == normal).then(|| [least.min(height), most.max(height)])
        });
        Around { level: first.level, cell: first.cell(), bounds, plane: heights.map(|heights| (normal, heights)) }
    }

    /// Whether records of a cell may count: only if it is near some place and its tangent plane.
    fn may_use(&self, cell: IVec3) -> bool {
        let size = size_of_level(self.level);
        let middle = corner_of(self.level, cell) + 0.5 * size;
        let half = RECORD_MARGIN * size;
        let outside = (self.bounds.min - middle).max(middle - self.bounds.max) - half;
        let is_flat = |&(normal, [least, most]): &(Vec3, [f32; 2])| {
            let (height, slab) = (normal.dot(middle), RECORD_THICKNESS * size + half * normal.abs().element_sum());
            least - slab < height && height < most + slab
        };
        outside.max(Vec3::ZERO).length_squared() < RECORD_RADIUS * RECORD_RADIUS * size * size
            && self.plane.iter().all(is_flat)
    }
}

/// Changes weights so that the weighted mean of the positions of records is the place itself, as far as that is possible without negative ones:
/// next to a wall all records are on one side, and what changes linearly from place to place would be shifted. (This is local linear regression:
/// HemisphereRays: *Design-adaptive Nonparametric Regression*, JASA 87, 1992.)
fn balance(cells: &Cells, place: &Place, links: &mut [Link]) {
    let [tangent, other] = basis(place.normal);
    let aside = |record: u32| {
        let way = cells.records[record as usize].point.position - place.position;
        Vec2::new(tangent.dot(way), other.dot(way))
    };
    let (mut first, mut xx, mut xy, mut yy) = (Vec2::ZERO, 0.0, 0.0, 0.0);
    for &(record, weight) in &*links {
        let Vec2 { x, y } = aside(record);
        first += weight * Vec2::new(x, y);
        xx += weight * x * x;
        xy += weight * x * y;
        yy += weight * y * y;
    }
    let (determinant, trace) = (xx * yy - xy * xy, xx + yy);
    if determinant <= MIN_SPREAD * trace * trace {
        return;
    }
    let slope = Vec2::new(yy * first.x - xy * first.y, xx * first.y - xy * first.x) / determinant;
    for (record, weight) in links {
        *weight *= (1.0 - slope.dot(aside(*record))).max(0.0);
    }
}

/// The places of a batch by the cell that they lie in, with the cells around.
struct Groups {
    /// The places of all groups.
    members: Vec<u32>,
    /// By group: the ends of its places and of its cells.
    ends: Vec<[u32; 2]>,
    cells: Vec<Asked>,
}

impl Groups {
    fn new(places: &[Place]) -> Groups {
        let mut keys: Vec<(CellKey, u32)> =
            (0..).zip(places).map(|(index, place)| (key_of(place.level, place.cell()), index)).collect();
        keys.sort_unstable();
        let mut groups =
            Groups { members: keys.iter().map(|key| key.1).collect(), ends: Vec::new(), cells: Vec::new() };
        for group in keys.chunk_by(|a, b| a.0 == b.0) {
            let around = Around::new(group.iter().map(|&(_, index)| &places[index as usize]));
            for offset in (0..CELLS_AROUND as i32).map(|index| IVec3::new(index % 5, index / 5 % 5, index / 25) - 2) {
                let cell = around.cell + offset;
                if around.may_use(cell) {
                    groups.cells.push(Asked::new(around.level, cell));
                }
            }
            let end = groups.ends.last().map_or(0, |ends| ends[0]) + group.len() as u32;
            groups.ends.push([end, groups.cells.len() as u32]);
        }
        groups
    }

    fn links(&self, cells: &Cells, places: &[Place]) -> Batch {
        let mut batch = Batch { ranges: vec![0..0; places.len()], links: Vec::new() };
        let mut start = [0, 0];
        let mut records = Vec::new();
        for &end in &self.ends {
            let around = &self.cells[start[1] as usize..end[1] as usize];
            records.clear();
            records.extend(around.iter().flat_map(|asked| cells.of(asked.key)));
            for &member in &self.members[start[0] as usize..end[0] as usize] {
                let place = &places[member as usize];
                let size = size_of_level(place.level);
                let first = batch.links.len() as u32;
                for &record in &records {
                    let weight = place.weight(size, &cells.records[record as usize].point);
                    if weight > 0.0 {
                        batch.links.push((record, weight));
                    }
                }
                batch.ranges[member as usize] = first..batch.links.len() as u32;
            }
            start = end;
        }
        batch
    }
}
