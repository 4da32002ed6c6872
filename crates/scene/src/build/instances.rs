//! Adds shapes to a mesh that are placed many times, see [`Instances`](crate::Instances).

use std::ops::Range;

use glam::{DMat4, Vec2, Vec3};

use super::geometry_check::{check_affine, check_instances, check_room};
use crate::model::instances::{Affine, MAX_INSTANCED};
use crate::{FIRST_INSTANCED, GeometryError, Mesh, ObjectKey, UNNAMED};

impl Mesh {
    /// Adds a shape that is stored once for several places, each of them an object with this name. `places` take the shape's coordinates to the
    /// local frame. All shapes have to be added after all other triangles. The instances of `shape` itself are copied.
    ///
    /// # Errors
    ///
    /// [`GeometryError::Place`] if a map cannot be inverted, or distorts too much; [`GeometryError::NotAffine`]; [`GeometryError::ShapesNotLast`];
    /// [`GeometryError::TooLarge`].
    pub fn add_instances(&mut self, shape: &Mesh, places: &[DMat4], object: &str) -> Result<(), GeometryError> {
        if let Some(place) = places.iter().position(|place| !Affine::holds(place)) {
            return Err(GeometryError::Place { place });
        }
        check_affine(places)?;
        check_instances(self)?;
        let flat = shape.flattened()?;
        if flat.triangles.is_empty() || places.is_empty() {
            return Ok(());
        }
        let mirrors = |place: &DMat4| place.determinant() < 0.0;
        let (count, shapes) = (flat.triangles.len(), if places.iter().any(mirrors) { 2 } else { 1 });
        let (vertices, all) = (self.positions.len() + flat.positions.len(), self.triangles.len() + shapes * count);
        check_room(vertices, all.max(self.instances.triangle_count() + count.saturating_mul(places.len())))?;
        if all > FIRST_INSTANCED as usize || self.instances.triangle_count() + count * places.len() >= MAX_INSTANCED {
            return Err(GeometryError::TooLarge { vertices, triangles: self.triangle_count() + count * places.len() });
        }
        // 1. The shape, and behind it the same with its corners in reverse order, if it is mirrored anywhere.
        let (first_vertex, first) = (self.positions.len() as u32, self.triangles.len() as u32);
        if self.instances.shapes.is_empty() {
            (self.instances.shapes, self.instances.vertices) = (first..first, first_vertex..first_vertex);
        }
        self.append_vertices(&flat);
        let own = flat.triangles.iter().map(|triangle| triangle.map(|vertex| first_vertex + vertex));
        let mut own: Vec<[u32; 3]> = own.collect();
        for number in 0..shapes {
            self.triangles.extend_from_slice(&own);
            self.materials.extend_from_slice(&flat.materials);
            if number == 0 {
                own.iter_mut().for_each(|triangle| triangle.swap(1, 2));
            }
        }
        self.instances.shapes.end = self.triangles.len() as u32;
        self.instances.vertices.end = self.positions.len() as u32;
        // 2. Its places.
        let before = self.instances.list().len();
        for place in places {
            let start = first + if mirrors(place) { count as u32 } else { 0 };
            self.place(start..start + count as u32, place, object);
        }
        self.find_bounds_of_instances(|number| number >= before);
        Ok(())
    }

    /// Places the stored triangles of a shape as the object `object`, see [`Instances::place`].
    pub(crate) fn place(&mut self, triangles: Range<u32>, map: &DMat4, object: impl Into<ObjectKey>) {
        let object = object.into();
        if self.objects.runs().0.is_empty() {
            // What nobody named has the first number.
            let first = if self.instances.shapes.start == 0 { object.clone() } else { UNNAMED.into() };
            self.objects.begin(0, first);
        }
        let object = self.objects.number(object);
        self.instances.place(triangles, map, object);
    }

    /// Vertices of another mesh behind those that are there; what attributes either does not have becomes neutral.
    pub(crate) fn append_vertices(&mut self, other: &Mesh) {
        fn append<T: Copy>(to: &mut Vec<T>, from: &[T], (before, after): (usize, usize), none: T) {
            if to.is_empty() && from.is_empty() {
                return;
            }
            to.resize(before, none);
            to.extend_from_slice(from);
            to.resize(after, none);
        }
        let before = self.positions.len();
        self.positions.extend_from_slice(&other.positions);
        let counts = (before, self.positions.len());
        append(&mut self.normals, &other.normals, counts, Vec3::ZERO);
        append(&mut self.uvs, &other.uvs, counts, Vec2::ZERO);
        append(&mut self.colors, &other.colors, counts, Vec3::ONE);
        append(&mut self.opacities, &other.opacities, counts, 1.0);
    }
}
