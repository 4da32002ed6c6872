//! Fans: corners of triangles around one point that are connected through smooth edges.

use glam::DVec3;

use super::{
    buckets::Buckets,
    crease::CreaseAngle,
    facets::{Facets, corner_angle},
    steps::count_step,
    triangles::{Triangles, next},
};
use crate::Position;

/// Angles that differ by this, a hundredth of a degree in radians, may be equal but for rounding.
const NOISE: f64 = 1.7e-4;

/// A set of corners, as a forest: each corner refers to one before it, or to itself (Tarjan 1975). The first corner of a set is its root,
/// whatever the order in which sets were united.
pub(super) struct Fans {
    parents: Vec<u32>,
}

impl Fans {
    /// Connects the corners of triangles on both sides of each smooth edge.
    pub(super) fn new<P: Position>(
        mesh: &Triangles<P>,
        points: &[u32],
        facets: &Facets,
        groups: &[u32],
        crease: CreaseAngle,
    ) -> Fans {
        let mut fans = Fans { parents: (0..mesh.corner_count() as u32).collect() };
        let least_cosine = (crease.radians() - NOISE).max(0.0).cos();
        let point = |corner: u32| points[mesh.vertex(corner) as usize];
        // An edge is named by the corner where it begins, listed by its lower point, and ordered by its higher one.
        let ends = |edge: u32| (point(edge), point(next(edge)));
        let higher = |edge: u32| ends(edge).0.max(ends(edge).1);
        let lower = |edge: u32| facets.of(edge).map(|_| ends(edge).0.min(ends(edge).1));
        let group = |edge: u32| groups.get(edge as usize / 3).copied().unwrap_or(1);
        let is_smooth = |a: u32, b: u32| {
            let cosine = facets.of(a).zip(facets.of(b)).map_or(-1.0, |(a, b)| a.dot(b));
            // Triangles with the same orientation run along the edge in opposite directions.
            ends(a).0 == ends(b).1 && group(a) == group(b) && group(a) > 0 && cosine > least_cosine
        };
        Buckets::new(points.len(), mesh.corner_count(), lower).each(|_, edges| {
            edges.sort_unstable_by(|&a, &b| {
                count_step();
                higher(a).cmp(&higher(b)).then(a.cmp(&b))
            });
            for same in edges.chunk_by(|&a, &b| higher(a) == higher(b)) {
                if let &[a, b] = same
                    && is_smooth(a, b)
                {
                    fans.unite(a, next(b));
                    fans.unite(next(a), b);
                }
            }
        });
        fans
    }

    fn unite(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.parents[a.max(b) as usize] = a.min(b);
    }

    fn root(&mut self, mut corner: u32) -> u32 {
        loop {
            count_step();
            let parent = self.parents[corner as usize];
            if parent == corner {
                return corner;
            }
            // Half of the way is cut short for the next time.
            let grandparent = self.parents[parent as usize];
            self.parents[corner as usize] = grandparent;
            corner = grandparent;
        }
    }

    /// By corner: the number of its fan. And how many fans there are.
    pub(super) fn into_numbers(self) -> (Vec<u32>, usize) {
        let mut numbers = self.parents;
        let mut count = 0;
        for corner in 0..numbers.len() {
            count_step();
            let parent = numbers[corner] as usize;
            // Those before this corner are numbers already.
            numbers[corner] = if parent == corner { count } else { numbers[parent] };
            count += u32::from(parent == corner);
        }
        (numbers, count as usize)
    }
}

/// What the corners of a fan have in common.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fan {
    /// The sum of the triangles' normals; of unit length in the end, or zero if it has no direction.
    pub(super) normal: DVec3,
    /// The first corner.
    first: u32,
    /// Whether its triangles lie in different planes.
    is_curved: bool,
    /// Whether a triangle has it, or another one, that is curved: the others stay flat.
    pub(super) is_used: bool,
}

/// Each fan, with the sum of its triangles' normals weighted by corner angle (Thürmer, Wüthrich 1998) and area (Max 1999).
pub(super) fn summed<P: Position>(mesh: &Triangles<P>, facets: &Facets, fans: &[u32], count: usize) -> Vec<Fan> {
    const NONE: u32 = u32::MAX;
    let least_cosine = NOISE.cos();
    let mut sums = vec![Fan { normal: DVec3::ZERO, first: NONE, is_curved: false, is_used: false }; count];
    for (corner, &fan) in (0..).zip(fans) {
        let Some(normal) = facets.of(corner) else { continue };
        let sum = &mut sums[fan as usize];
        if sum.first == NONE {
            sum.first = corner;
        }
        sum.is_curved |= facets.of(sum.first).is_some_and(|first| normal.dot(first) < least_cosine);
        let [at, b, c] = mesh.around(corner);
        let (u, v) = (b - at, c - at);
        sum.normal += corner_angle(u, v) * u.cross(v);
    }
    sums.iter_mut().for_each(|sum| sum.normal = sum.normal.normalize_or_zero());
    for around in fans.as_chunks::<3>().0 {
        if around.iter().any(|&fan| sums[fan as usize].is_curved) {
            around.iter().for_each(|&fan| sums[fan as usize].is_used = true);
        }
    }
    sums
}
