//! What a written scene does not say, or only to us: one sentence for each kind.

use glam::{Affine2, Mat2, Vec3};

use super::glb::{material::has_alpha, material::is_unlit, material::shown_emission, pictures::parts};
use super::lights::own_lights;
use crate::{Falloff, Light, LightKind, Material, Projection, Scene};

/// What no format keeps.
pub(super) fn always(scene: &Scene) -> Vec<String> {
    let mut lost = Vec::new();
    if scene.animation().is_some() {
        lost.push("animations are not exported: the scene is written at rest".to_owned());
    }
    if let Some(environment) = &scene.lights.environment {
        lost.push(format!("{}: skies and panoramas are not exported, only the sun in them", environment.name));
    }
    lost
}

/// What glTF cannot say: it is in the extras, where only we find it.
pub(super) fn to_others(scene: &Scene) -> Vec<String> {
    let lights: Vec<&Light> = own_lights(scene).collect();
    let materials = used(scene);
    let light = |holds: fn(&Light) -> bool| lights.iter().filter(|light| holds(light)).count();
    let material = |holds: fn(&Material) -> bool| materials.iter().filter(|material| holds(material)).count();
    let camera = scene.cameras.iter().filter(|camera| camera.shift != glam::Vec2::ZERO).count();
    let horizontal = |projection| matches!(projection, Projection::Perspective(crate::Fov::Horizontal(_)));
    let horizontal = scene.cameras.iter().filter(|camera| horizontal(camera.projection)).count();
    let colors = &scene.geometry.mesh.colors;
    let bright = colors.iter().filter(|color| color.max_element() > 1.0 || color.min_element() < 0.0).count();
    let counted = [
        (
            light(|it| it.falloff == Falloff::None && it.position().is_some()),
            "light",
            "the same at any distance",
            "with inverse-square falloff, in candela that give the same light at the middle of the scene",
        ),
        (light(is_surface), "light", "shining to one side of a surface", "like a spot to that side, with hard shadows"),
        (light(has_other_size), "light", "with a size", "as light from a point, with hard shadows"),
        (light(|it| it.visible), "light", "that cameras see", "without a surface"),
        (camera, "camera", "with a shift", "without it"),
        (horizontal, "camera", "with a fixed horizontal field of view", "with that of a square image"),
        (
            material(|it| it.faceted().is_none() && it.dielectric.is_none() && it.ks + it.ks_tinted != Vec3::ZERO),
            "material",
            "with a Phong lobe (ks, shininess)",
            "as a rough layer",
        ),
        (
            material(|it| it.kd.max_element() > 1.0),
            "material",
            "that reflects more light than it gets",
            "with a colour of at most 1",
        ),
        (material(|it| it.catcher), "material", "that catches shadows", "as an ordinary surface"),
        (
            material(|it| !is_unlit(it) && shown_emission(it) != it.emission + it.emission_tinted),
            "material",
            "that shows its image unlit in part",
            "without that part",
        ),
        (
            material(|it| it.dielectric.is_none() && it.opacity.is_some_and(|opacity| !has_alpha(&opacity, it))),
            "material",
            "whose opacity lies elsewhere than its colours",
            "opaque",
        ),
        (
            material(|it| {
                it.dielectric.is_none() && it.opacity.and_then(|it| it.filter()).is_some_and(|it| it != Vec3::ONE)
            }),
            "material",
            "that tints the light that it lets through",
            "without that tint",
        ),
        (material(is_sheared), "material", "with an image that is sheared", "with one that is turned and scaled only"),
        (bright, "vertex colour", "above 1", "as 1"),
    ];
    let sentence = |(count, what, which, shown): (usize, &str, &str, &str)| {
        let plural = if count == 1 { "" } else { "s" };
        (count > 0).then(|| {
            format!(
                "{count} {what}{plural} {which}: other programs show {} {shown}",
                if count == 1 { "it" } else { "them" }
            )
        })
    };
    let has_ambient = scene.lights.ambient.is_some_and(|ambient| ambient != Vec3::ZERO);
    let of_scene = [
        has_ambient.then(|| "ambient light: other programs show the scene without it".to_owned()),
        scene.lights.background.map(|_| "a background: other programs show one of their own".to_owned()),
    ];
    counted.into_iter().filter_map(sentence).chain(of_scene.into_iter().flatten()).collect()
}

/// The materials of triangles.
fn used(scene: &Scene) -> Vec<&Material> {
    let mut numbers = scene.geometry.mesh.materials.clone();
    numbers.sort_unstable();
    numbers.dedup();
    numbers.iter().filter_map(|&number| scene.geometry.materials.get(number as usize)).collect()
}

fn is_surface(light: &Light) -> bool {
    light.surface.is_some()
}

/// Whether shadows are soft although it does not shine like a surface.
fn has_other_size(light: &Light) -> bool {
    let spread = matches!(light.kind, LightKind::Point { spread, .. } if spread > 0.0);
    (light.has_size() || spread) && !is_surface(light)
}

/// Whether glTF's factors and angle do not give a transform.
fn is_sheared(material: &Material) -> bool {
    let normals = material.normal_texture.map(|map| map.uses);
    let all = [material.texture, material.emission_texture, normals, material.metallic_roughness_texture];
    all.into_iter().flatten().any(|uses| {
        let (scale, rotation, offset) = parts(&uses.transform);
        let near = crate::formats::gltf::affine(scale, rotation, offset);
        let largest = |matrix: Mat2| matrix.x_axis.abs().max(matrix.y_axis.abs()).max_element();
        let Affine2 { matrix2: exact, .. } = uses.transform;
        // Rounding of sines and of factors.
        largest(near.matrix2 - exact) > 1e-5 * largest(exact)
    })
}
