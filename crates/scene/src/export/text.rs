//! A scene file that refers to its triangles in a GLB next to it.

use glam::{DVec3, Vec2, Vec3};

use super::lights::{own_lights, toward_surface};
use crate::export::info::shortest;
use crate::formats::toml::schema::{
    AmbientEntry, CameraEntry, FalloffName, LightEntry, LightKindName, LightMeshEntry, MeshEntry, ProjectionName,
    SceneFile, WeightName,
};
use crate::formats::toml::spanned::Spanned;
use crate::formats::toml::values::Color;
use crate::model::light::LARGEST_ANGLE;
use crate::model::transforms::upright;
use crate::{Camera, Falloff, Fov, Light, LightKind, Projection, Scene, Weight};

/// The text of a scene file whose triangles are in `mesh_file`.
pub(super) fn encode(scene: &Scene, mesh_file: &str) -> Result<String, toml::ser::Error> {
    let mesh = MeshEntry {
        file: anywhere(mesh_file.to_owned()),
        name: None,
        material: None,
        translate: None,
        rotate: None,
        scale: None,
        motion: None,
    };
    toml::to_string(&SceneFile {
        origin: (scene.geometry.origin != DVec3::ZERO).then(|| anywhere(scene.geometry.origin.to_array())),
        camera: scene.cameras.iter().map(|camera| anywhere(camera_entry(scene, camera))).collect(),
        ambient: (scene.lights.ambient.is_some() || scene.lights.background.is_some()).then(|| AmbientEntry {
            intensity: scene.lights.ambient.map(color),
            background: scene.lights.background.map(color),
        }),
        light: own_lights(scene).map(|light| anywhere(light_entry(scene, light))).collect(),
        mesh: if scene.geometry.mesh.triangles.is_empty() { Vec::new() } else { vec![anywhere(mesh)] },
        lightmesh: light_mesh_entry(scene),
        ..SceneFile::default()
    })
}

/// A value without a location in a text.
fn anywhere<T>(value: T) -> Spanned<T> {
    Spanned::new(0..0, value)
}

fn vector(vector: Vec3) -> Spanned<[f64; 3]> {
    anywhere(vector.to_array().map(shortest))
}

fn color(color: Vec3) -> Spanned<Color> {
    anywhere(Color::Rgb(color.to_array().map(shortest)))
}

fn number(number: f32) -> Spanned<f64> {
    anywhere(shortest(number))
}

/// World coordinates, with no more digits than the local ones if both frames are the same.
fn world(scene: &Scene, local: Vec3) -> Spanned<[f64; 3]> {
    if scene.geometry.origin == DVec3::ZERO { vector(local) } else { anywhere(scene.to_world(local).to_array()) }
}

fn named(name: &str) -> Option<Spanned<String>> {
    (!name.is_empty()).then(|| anywhere(name.to_owned()))
}

fn camera_entry(scene: &Scene, camera: &Camera) -> CameraEntry {
    let up = upright(camera.direction.as_dvec3(), camera.up.as_dvec3()).map_or(camera.up, |up| up.as_vec3());
    let mut entry = CameraEntry {
        name: named(&camera.name),
        position: world(scene, camera.position),
        target: None,
        direction: Some(vector(camera.direction)),
        up: Some(vector(up)),
        vfov: None,
        hfov: None,
        projection: None,
        height: None,
        shift: (camera.shift != Vec2::ZERO).then(|| anywhere(camera.shift.to_array().map(shortest))),
        near: (camera.near > 0.0).then(|| number(camera.near)),
        far: camera.far.is_finite().then(|| number(camera.far)),
        motion: None,
    };
    match camera.projection {
        Projection::Perspective(Fov::Vertical(degrees)) => entry.vfov = Some(number(degrees)),
        Projection::Perspective(Fov::Horizontal(degrees)) => entry.hfov = Some(number(degrees)),
        Projection::Orthographic { height } => {
            entry.projection = Some(anywhere(ProjectionName::Orthographic));
            entry.height = Some(number(height));
        }
    }
    entry
}

fn light_entry(scene: &Scene, light: &Light) -> LightEntry {
    let mut entry = LightEntry {
        name: named(&light.name),
        kind: anywhere(LightKindName::Point),
        position: light.position().map(|position| world(scene, position)),
        direction: None,
        target: None,
        normal: None,
        radius: None,
        spread: None,
        angle: None,
        inner: None,
        outer: None,
        u: None,
        v: None,
        size: None,
        up: None,
        one_sided: None,
        visible: light.visible.then(|| anywhere(true)),
        intensity: Some(color(light.intensity)),
        falloff: Some(match light.falloff {
            Falloff::None => FalloffName::None,
            Falloff::InverseSquare => FalloffName::InverseSquare,
        }),
        motion: None,
    };
    if matches!(light.kind, LightKind::Disk { .. } | LightKind::Rectangle { .. }) && light.surface.is_none() {
        entry.one_sided = Some(anywhere(false));
    }
    match light.kind {
        LightKind::Point { spread, .. } => entry.spread = (spread > 0.0).then(|| number(spread)),
        LightKind::Directional { direction, angle } => {
            entry.kind = anywhere(LightKindName::Directional);
            entry.direction = Some(vector(direction));
            // The largest angle in `f32` radians may be a little more than that in degrees.
            entry.angle = (angle > 0.0).then(|| anywhere(f64::from(angle).to_degrees().min(LARGEST_ANGLE)));
        }
        LightKind::Spot { direction, inner, outer, radius, .. } => {
            // A right angle in `f32` radians is a little more than 90 degrees.
            let degrees = |angle: f32| anywhere(f64::from(angle).to_degrees().min(90.0));
            entry.kind = anywhere(LightKindName::Spot);
            entry.direction = Some(vector(direction));
            (entry.inner, entry.outer) = (Some(degrees(inner)), Some(degrees(outer)));
            entry.radius = (radius > 0.0).then(|| number(radius));
        }
        LightKind::Sphere { radius, .. } => {
            entry.kind = anywhere(LightKindName::Sphere);
            entry.radius = Some(number(radius));
        }
        LightKind::Disk { normal, radius, .. } => {
            entry.kind = anywhere(LightKindName::Disk);
            entry.normal = Some(vector(light.surface.unwrap_or(normal)));
            entry.radius = Some(number(radius));
        }
        LightKind::Rectangle { half_u, half_v, .. } => {
            entry.kind = anywhere(LightKindName::Rectangle);
            let half_v = toward_surface(light, half_u, half_v);
            (entry.u, entry.v) = (Some(vector(2.0 * half_u)), Some(vector(2.0 * half_v)));
        }
    }
    entry
}

fn light_mesh_entry(scene: &Scene) -> Option<LightMeshEntry> {
    let defaults = &scene.light_mesh;
    let any = defaults.step.is_some() || defaults.radius.is_some() || defaults.weight.is_some();
    any.then(|| LightMeshEntry {
        step: defaults.step.map(number),
        radius: defaults.radius.map(number),
        weight: defaults.weight.map(|weight| match weight {
            Weight::Constant => WeightName::Constant,
            Weight::Quadratic => WeightName::Quadratic,
            Weight::Smooth => WeightName::Smooth,
        }),
    })
}
