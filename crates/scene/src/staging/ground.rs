//! A ground that catches shadows.

use glam::{DMat4, Vec3};

use crate::build::geometry_check::check_room;
use crate::{GeometryError, Material, Mesh, Scene, Up};

/// Half the edge of the ground, as a multiple of the scene's diagonal: shadows of a light that stands 6° high end on it.
const HALF: f32 = 10.0;
/// How far it is below the scene, as a share of the diagonal: a floor that belongs to the scene hides it.
const BELOW: f32 = 1e-4;

/// The object, and its material.
const NAME: &str = "ground";

impl Scene {
    /// Adds a [shadow catcher](Material::catcher) just below the scene's lowest point; nothing to a scene without extent, or in which no more
    /// triangles can be numbered. Cameras and lights that depend on the scene's size should have been [added](Scene::complete) before; ambient
    /// light stays what it was.
    pub fn add_ground(&mut self, up: Up) {
        let bounds = self.geometry.mesh.bounds();
        let diagonal = bounds.diagonal();
        if bounds.is_empty() || !(diagonal > 0.0 && (HALF * diagonal).is_finite()) {
            return;
        }
        if self.lights.ambient.is_none() && self.lights.environment.is_none() {
            self.lights.ambient = Some(self.lights.default_ambient(&bounds));
        }
        let axis = up.axis();
        let along = if axis == Vec3::Y { [Vec3::Z, Vec3::X] } else { [Vec3::X, Vec3::Y] };
        let center = bounds.center();
        let middle = center + (bounds.min.dot(axis) - BELOW * diagonal - center.dot(axis)) * axis;
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let corners = corners.map(|[a, b]: [f32; 2]| middle + HALF * diagonal * (a * along[0] + b * along[1]));
        let geometry = self.geometry_mut();
        if add_square(&mut geometry.mesh, corners, geometry.materials.len() as u32).is_ok() {
            geometry.materials.push(Material::matt([1.0; 3]).named(NAME).with_catcher(true));
        }
    }
}

/// Adds a square of this material to a mesh, as an object of its own.
fn add_square(mesh: &mut Mesh, corners: [Vec3; 4], material: u32) -> Result<(), GeometryError> {
    let (positions, triangles) = (corners.to_vec(), vec![[0, 1, 2], [0, 2, 3]]);
    let square = Mesh { positions, triangles, materials: vec![material; 2], ..Mesh::default() };
    if !mesh.instances.is_empty() {
        // Other triangles come before all shapes, which would have to move.
        return mesh.add_instances(&square, &[DMat4::IDENTITY], NAME);
    }
    let first = mesh.positions.len();
    check_room(first + square.positions.len(), mesh.triangles.len() + square.triangles.len())?;
    mesh.append_vertices(&square);
    mesh.objects.begin(mesh.triangles.len(), NAME);
    mesh.triangles.extend(square.triangles.iter().map(|triangle| triangle.map(|corner| first as u32 + corner)));
    mesh.materials.extend(square.materials);
    Ok(())
}
