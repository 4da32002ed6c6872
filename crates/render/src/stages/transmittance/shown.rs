//! Whether it can be seen what transmissive surfaces leave of a light: glass and other surfaces without diffuse reflection show little more of a light than its
//! highlight, and most of them are looked at from where there is none. Twin: `shown.cuh`.
//!
//! The light is within a cone around the way to its centre, of the half angle β with sin β = radius / distance. If the mirrored view makes the angle
//! α > β with that way, then the highlight is at most cosⁿ(α − β), n being the largest power of two up to the exponent, times what a light of this
//! strength would be at the nearest point. That times the share of the pixel must reach [`MIN_SHOWN`].

use lightmesh_layout::constants::MIN_SHOWN;
use lightmesh_scene::{Light, LightKind, Material};

use crate::data::wave::HostWave;
use crate::prepared::PreparedScene;
use crate::sampling::light_center;
use crate::shading::falloff;
use crate::shadow::projected_light::spread;
use crate::shadow::size;
use crate::surface::{SurfacePoint, shading_normal};

/// Whether what a ray sees at `point` may show that much of `light`.
pub(super) fn may_show(
    wave: &HostWave,
    transmissive: &PreparedScene,
    ray: usize,
    point: &SurfacePoint,
    light: &Light,
) -> bool {
    let (geometry, hit) = (&transmissive.scene.geometry, &wave.hits[ray]);
    if wave.rays.depth == 0 {
        return true;
    }
    let material = &geometry.materials[geometry.mesh.materials[geometry.mesh.stored(hit.triangle)] as usize];
    if !has_mere_highlights(material) {
        return true;
    }
    // 1. The mirrored view, and the cone that the light is in.
    let normal = shading_normal(&geometry.mesh, hit, point.normal);
    let view = -wave.rays.rays[ray].direction;
    let mirrored = 2.0 * normal.dot(view) * normal - view;
    let reach = wave.scene.geometry.sun_distance(point.origin);
    let way = light_center(light, point.origin, reach) - point.origin;
    let largest = size(light, 1.0).max(spread(light));
    let radius = if matches!(light.kind, LightKind::Directional { .. }) { reach * largest } else { largest };

    // 2. The cosine between both, at most.
    let (square, along) = (way.length_squared(), mirrored.dot(way));
    let beyond = square - radius * radius;
    if !(beyond > 0.0 && along < beyond.sqrt()) {
        return true;
    }
    let aside = (square - along * along).max(0.0).sqrt();
    let cosine = (along * beyond.sqrt() + radius * aside) / square;

    // 3. The highlight.
    let mut highlight = cosine.clamp(0.0, 1.0);
    let mut power = 2.0;
    while power <= material.shininess {
        (highlight, power) = (highlight * highlight, 2.0 * power);
    }
    let strength = falloff(light, square.sqrt() - radius) * light.intensity.max_element();
    wave.rays.weight(ray).max_element() * (highlight * strength) > MIN_SHOWN
}

/// Whether highlights are all that surfaces of this material show of lights.
fn has_mere_highlights(material: &Material) -> bool {
    let is_plain = material.faceted().is_none() && material.normal_texture.is_none() && !material.catcher;
    is_plain && material.kd == glam::Vec3::ZERO && material.shininess >= 1.0
}
