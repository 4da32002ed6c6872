//! Vertices of all parts, each in the precision of its file, until the local frame is known.
//!
//! Most files contain `f32`. Those vertices stay where they will end up, in their part's own coordinates, together with the part's
//! transform; they are placed in double precision in one pass at the end. So a large model is held once, not twice.

use glam::{DMat4, DVec3, Vec3};

use crate::{OwnedPositions, Position, Positions};

/// Placed vertices without a local frame.
#[derive(Debug, Default)]
pub struct Vertices {
    /// One entry per vertex: of a single-precision run in its part's coordinates, of a double-precision run not yet set. Empty if all
    /// runs are of double precision.
    single: Vec<Vec3>,
    /// World positions of the double-precision runs, one after another.
    double: Vec<DVec3>,
    runs: Vec<Run>,
    count: usize,
    bounds: Option<(DVec3, DVec3)>,
}

/// A run of consecutive vertices that are stored in the same way.
#[derive(Debug)]
enum Run {
    /// This many, yet to be placed, with their transform.
    Single(usize, Box<DMat4>),
    /// This many, placed.
    Double(usize),
}

impl Vertices {
    /// Adds vertices placed by `transform`.
    pub fn add(&mut self, positions: Positions, transform: &DMat4) {
        match positions {
            Positions::Single(positions) => {
                self.include(positions, transform);
                self.single.resize(self.count, Vec3::ZERO);
                self.single.extend_from_slice(positions);
                self.runs.push(Run::Single(positions.len(), Box::new(*transform)));
                self.count += positions.len();
            }
            Positions::Double(positions) => {
                self.include(positions, transform);
                self.double.extend(positions.iter().map(|&position| transform.transform_point3(position)));
                self.push_double(positions.len());
            }
        }
    }

    /// [`Vertices::add`] for owned vertices: the first ones are placed without copying.
    pub(crate) fn take(&mut self, positions: OwnedPositions, transform: &DMat4) {
        match positions {
            OwnedPositions::Single(positions) if self.count == 0 => {
                self.include(&positions, transform);
                self.runs.push(Run::Single(positions.len(), Box::new(*transform)));
                self.count = positions.len();
                self.single = positions;
            }
            OwnedPositions::Double(mut positions) if self.double.is_empty() => {
                self.include(&positions, transform);
                positions.iter_mut().for_each(|position| *position = transform.transform_point3(*position));
                self.push_double(positions.len());
                self.double = positions;
            }
            OwnedPositions::Single(positions) => self.add(Positions::Single(&positions), transform),
            OwnedPositions::Double(positions) => self.add(Positions::Double(&positions), transform),
        }
    }

    fn push_double(&mut self, more: usize) {
        self.count += more;
        match self.runs.last_mut() {
            Some(Run::Double(count)) => *count += more,
            _ => self.runs.push(Run::Double(more)),
        }
    }

    /// Number of vertices.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Lowest and highest corner of the bounding box of all finite vertices; `None` if there are none.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        self.bounds
    }

    /// Reserves memory for `more` vertices; `false` if there is not enough.
    pub(crate) fn reserve(&mut self, more: usize) -> bool {
        let missing = self.count - self.single.len();
        reserve(&mut self.single, missing + more)
    }

    /// All vertices relative to `origin`.
    pub fn finish(self, origin: DVec3) -> Vec<Vec3> {
        let Vertices { mut single, double, runs, count, .. } = self;
        if single.is_empty() {
            return double.into_iter().map(|world| (world - origin).as_vec3()).collect();
        }
        single.resize(count, Vec3::ZERO);
        let mut rest = &mut single[..];
        let mut double = double.iter();
        for run in runs {
            let (Run::Single(count, _) | Run::Double(count)) = run;
            let (vertices, after) = rest.split_at_mut(count);
            rest = after;
            match run {
                Run::Single(_, transform) => vertices
                    .iter_mut()
                    .for_each(|vertex| *vertex = (transform.transform_point3(vertex.as_dvec3()) - origin).as_vec3()),
                Run::Double(_) => vertices
                    .iter_mut()
                    .zip(double.by_ref())
                    .for_each(|(vertex, &world)| *vertex = (world - origin).as_vec3()),
            }
        }
        single
    }

    fn include<P: Position>(&mut self, positions: &[P], transform: &DMat4) {
        let world = positions.iter().map(|position| transform.transform_point3(position.to_double()));
        let (min, max) = world
            .filter(|world| world.is_finite())
            .fold(self.bounds.unwrap_or((DVec3::INFINITY, DVec3::NEG_INFINITY)), |(min, max), world| {
                (min.min(world), max.max(world))
            });
        self.bounds = min.cmple(max).all().then_some((min, max));
    }
}

/// Reserves memory for exactly `more` elements in the first file of a scene, which may be the only one.
pub(crate) fn reserve<T>(elements: &mut Vec<T>, more: usize) -> bool {
    let reserved = if elements.is_empty() { elements.try_reserve_exact(more) } else { elements.try_reserve(more) };
    reserved.is_ok()
}
