//! A ground that catches shadows.

use glam::{Vec2, Vec3};

use crate::{Material, Scene, Up};

/// Half the edge of the ground, as a multiple of the scene's diagonal: shadows of a light that stands 6° high end on it.
const HALF: f32 = 10.0;
/// How far it is below the scene, as a share of the diagonal: a floor that belongs to the scene hides it.
const BELOW: f32 = 1e-4;

impl Scene {
    /// Adds a [shadow catcher](Material::catcher) just below the scene's lowest point; nothing to a scene without extent. Cameras and lights
    /// that depend on the scene's size should have been [added](Scene::complete) before; ambient light stays what it was.
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
        let geometry = self.geometry_mut();
        let material = geometry.materials.len() as u32;
        geometry.materials.push(Material::matt([1.0; 3]).named("ground").with_catcher(true));
        let mesh = &mut geometry.mesh;
        let first = mesh.positions.len() as u32;
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        mesh.positions.extend(corners.map(|[a, b]: [f32; 2]| middle + HALF * diagonal * (a * along[0] + b * along[1])));
        let attribute = |is_used: bool| if is_used { corners.len() } else { 0 };
        mesh.normals.extend(vec![Vec3::ZERO; attribute(!mesh.normals.is_empty())]);
        mesh.uvs.extend(vec![Vec2::ZERO; attribute(!mesh.uvs.is_empty())]);
        mesh.colors.extend(vec![Vec3::ONE; attribute(!mesh.colors.is_empty())]);
        mesh.opacities.extend(vec![1.0; attribute(!mesh.opacities.is_empty())]);
        mesh.objects.begin(mesh.triangles.len(), "ground");
        mesh.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
        mesh.materials.extend([material; 2]);
    }
}
