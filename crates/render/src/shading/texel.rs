//! What the sample of a pixel sees of an image of a material: the mean over its [footprint](crate::footprint). Twin: `texel.cuh`.

use glam::{Vec2, Vec3};
use lightmesh_trace::accel::{Hit, Ray};

use crate::footprint::{self, Cone};
use crate::prepared::PreparedScene;
use crate::textures::{Image, filtered};

/// The value of an image where `ray` with a cone hits a surface.
pub(super) fn texel_at(scene: &PreparedScene, image: &Image, ray: &Ray, cone: Cone, hit: &Hit) -> Vec3 {
    let (uvs, transform) = (uvs_of(scene, hit), image.uses.transform);
    let place = transform.transform_point2(interpolated(hit, uvs));
    let axes = axes_of(scene, ray, cone, hit, uvs).map(|axis| transform.matrix2 * axis);
    filtered(image, scene.geometry.mip_levels.of_image(image), place, axes)
}

/// The texture coordinates of the corners of the triangle at `hit`.
pub(super) fn uvs_of(scene: &PreparedScene, hit: &Hit) -> [Vec2; 3] {
    let mesh = &scene.scene.geometry.mesh;
    mesh.triangles[mesh.stored(hit.triangle)].map(|vertex| mesh.uvs[vertex as usize])
}

/// The axes of the footprint at `hit`, in texture coordinates.
fn axes_of(scene: &PreparedScene, ray: &Ray, cone: Cone, hit: &Hit, uvs: [Vec2; 3]) -> [Vec2; 2] {
    if cone.is_point() {
        return [Vec2::ZERO; 2];
    }
    let [a, b, c] = scene.geometry.triangles.at(hit.triangle).corners();
    let position = (1.0 - hit.u - hit.v) * a + hit.u * b + hit.v * c;
    let direction = footprint::direction_to(position, ray, cone);
    footprint::axes(direction, cone.after(hit.t).width, [a, b, c], uvs)
}

fn interpolated(hit: &Hit, [a, b, c]: [Vec2; 3]) -> Vec2 {
    (1.0 - hit.u - hit.v) * a + hit.u * b + hit.v * c
}
