//! Cameras and lights.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DVec3, Vec2, Vec3};
use serde_json::{Value, json};

use crate::build::shapes::tangents;
use crate::export::lights::toward_surface;
use crate::formats::gltf::extras::{CameraExtras, LightExtras, ShapeExtras};
use crate::model::transforms::upright;
use crate::{Bounds, Camera, Falloff, Fov, Light, LightKind, Projection, Scene};

pub(super) fn camera_entry(scene: &Scene, camera: &Camera) -> Value {
    // Other programs need clip planes: the camera's own, else wide enough to contain the scene from anywhere near it.
    let size = f64::from(scene.geometry.mesh.bounds().diagonal()).max(1.0);
    let [near, far] = own_clip(camera);
    let shift = (camera.shift != Vec2::ZERO).then_some(camera.shift.to_array());
    let mut own = CameraExtras { shift, near, far, ..CameraExtras::default() };
    let [near, far] = [near, far].map(|depth| depth.map(f64::from));
    let mut entry = match camera.projection {
        Projection::Perspective(fov) => {
            let radians = match fov {
                Fov::Vertical(degrees) => f64::from(degrees).to_radians(),
                Fov::Horizontal(_) => f64::from(fov.vertical(1.0)).to_radians(),
            };
            if let Fov::Horizontal(hfov) = fov {
                own.hfov = Some(hfov);
            }
            let mut perspective = json!({"yfov": radians, "znear": near.unwrap_or(1e-4 * size)});
            if let Some(far) = far {
                perspective["zfar"] = json!(far);
                // The format has no range that begins behind its end.
                perspective["znear"] = json!(near.unwrap_or((1e-4 * size).min(0.5 * far)));
            }
            json!({"type": "perspective", "perspective": perspective})
        }
        Projection::Orthographic { height } => {
            let mag = 0.5 * f64::from(height);
            let near = near.unwrap_or(0.0);
            let planes = json!({"xmag": mag, "ymag": mag, "znear": near, "zfar": far.unwrap_or(near + 100.0 * size)});
            json!({"type": "orthographic", "orthographic": planes})
        }
    };
    if own != CameraExtras::default() {
        entry["extras"] = json!({"lightmesh": own});
    }
    entry
}

/// The clip planes of a camera that has some.
fn own_clip(camera: &Camera) -> [Option<f32>; 2] {
    [(camera.near > 0.0).then_some(camera.near), camera.far.is_finite().then_some(camera.far)]
}

pub(super) fn camera_node(scene: &Scene, index: usize, camera: &Camera) -> Value {
    let direction = camera.direction.as_dvec3();
    let up = upright(direction, camera.up.as_dvec3()).unwrap_or(camera.up.as_dvec3());
    let mut node = json!({"camera": index, "matrix": look(scene.to_world(camera.position), direction, up)});
    name(&mut node, &camera.name);
    node
}

pub(super) fn light_entry(bounds: &Bounds, light: &Light) -> Value {
    let unit = standard_unit(bounds, light);
    let strength = light.intensity.as_dvec3() * unit;
    let strongest = strength.max_element();
    let color = if strongest > 0.0 { strength / strongest } else { DVec3::ONE };
    let mut extras = LightExtras {
        shape: match light.kind {
            LightKind::Sphere { radius, .. } => Some(ShapeExtras::Sphere { radius }),
            LightKind::Disk { normal, radius, .. } => {
                Some(ShapeExtras::Disk { normal: light.surface.unwrap_or(normal).to_array(), radius })
            }
            LightKind::Rectangle { half_u, half_v, .. } => {
                let half_v = toward_surface(light, half_u, half_v);
                Some(ShapeExtras::Rectangle { half_u: half_u.to_array(), half_v: half_v.to_array() })
            }
            _ => None,
        },
        one_sided: light.surface.is_some(),
        aimed: light.surface.is_some(),
        no_falloff: light.falloff == Falloff::None,
        visible: light.visible,
        ..LightExtras::default()
    };
    extras.unit = extras.no_falloff.then_some(unit);
    let some = |length: f32| (length > 0.0).then_some(length);
    let kind = match light.kind {
        LightKind::Directional { angle, .. } => {
            extras.angle = some(angle);
            "directional"
        }
        LightKind::Spot { radius, .. } => {
            extras.radius = some(radius);
            "spot"
        }
        LightKind::Point { spread, .. } => {
            extras.spread = some(spread);
            "point"
        }
        _ if light.surface.is_some() => "spot",
        _ => "point",
    };
    let mut entry = json!({"type": kind, "color": color.to_array(), "intensity": strongest});
    name(&mut entry, &light.name);
    if extras != LightExtras::default() {
        entry["extras"] = json!({"lightmesh": extras});
    }
    if let LightKind::Spot { inner, outer, .. } = light.kind {
        // A right angle in single precision is a little more; and the format has no cone with a sharp edge.
        let outer = f64::from(outer).min(FRAC_PI_2);
        let inner = f64::from(inner).min(outer * (1.0 - 1e-9));
        entry["spot"] = json!({"innerConeAngle": inner, "outerConeAngle": outer});
    }
    if light.surface.is_some() {
        // From all to nothing over a right angle: programs that follow the format's advice fade it by the square of the cosine.
        entry["spot"] = json!({"innerConeAngle": 0.0, "outerConeAngle": FRAC_PI_2});
    }
    entry
}

/// How many candela or lux give the light that one unit of intensity gives at the middle of the scene, which is within `bounds`.
fn standard_unit(bounds: &Bounds, light: &Light) -> f64 {
    if light.falloff == Falloff::InverseSquare {
        return 1.0;
    }
    let Some(position) = light.position() else { return PI };
    let middle = if bounds.is_empty() { Vec3::ZERO } else { bounds.center() };
    // A lamp at the middle itself would be infinitely near; any strength will do where there is nothing.
    let nearest = 0.25 * f64::from(bounds.diagonal());
    let distance = position.as_dvec3().distance(middle.as_dvec3()).max(nearest);
    if distance > 0.0 { PI * distance * distance } else { PI }
}

/// Directional lights and spots store their direction in the node. The extras of area lights are in the node's frame, or if they are aimed, in
/// that around it.
pub(super) fn light_node(scene: &Scene, index: usize, light: &Light) -> Value {
    let world = light.position().map_or(DVec3::ZERO, |position| scene.to_world(position));
    let mut node = json!({"extensions": {"KHR_lights_punctual": {"light": index}}});
    name(&mut node, &light.name);
    let aim = match light.kind {
        LightKind::Directional { direction, .. } | LightKind::Spot { direction, .. } => Some(direction),
        _ => light.surface,
    };
    match aim {
        Some(direction) => {
            let direction = direction.as_dvec3();
            node["matrix"] = json!(look(world, direction, tangents(direction).1));
        }
        None => node["translation"] = json!(world.to_array()),
    }
    node
}

/// The matrix, by columns, of a node that looks along `direction`.
fn look(position: DVec3, direction: DVec3, up: DVec3) -> [f64; 16] {
    let columns = [(direction.cross(up), 0.0), (up, 0.0), (-direction, 0.0), (position, 1.0)];
    let mut matrix = [0.0; 16];
    for (column, (vector, w)) in matrix.chunks_exact_mut(4).zip(columns) {
        column.copy_from_slice(&vector.extend(w).to_array());
    }
    matrix
}

/// Names it, if it has a name.
fn name(entry: &mut Value, name: &str) {
    if !name.is_empty() {
        entry["name"] = json!(name);
    }
}
