//! `KHR_lights_punctual`: point, spot and directional lights, in candela and lux, with inverse-square falloff.
//!
//! They shine along −Z of their node; its scale does not affect them. A light's `range` is ignored: it is a hint for programs that
//! sort lights, and cuts off light that would still be visible. Area lights are our own extension, see [`extras`](super::extras).

use std::{f32::consts::FRAC_PI_2, path::Path};

use glam::{DVec3, Vec3};

use super::{
    container::malformed,
    document::{self, Spot},
    extras::{LightExtras, ShapeExtras},
};
use crate::model::light::{usable_angle, usable_radius};
use crate::{Falloff, Light, LightKind, LoadError};

/// Light number `index` of the document in the coordinates of a node, still without a name. `None` if its type is unknown.
pub(super) fn read(
    path: &Path,
    index: u32,
    light: &document::Light,
    own: &LightExtras,
) -> Result<Option<Light>, LoadError> {
    let color = light.color.as_deref().map_or(DVec3::ONE, |&color| color.into());
    let unit = own.unit.filter(|_| own.no_falloff).unwrap_or(1.0);
    if !(unit > 0.0 && unit.is_finite()) {
        return Err(malformed(path, format!("light {index} has extras.lightmesh.unit = {unit}")));
    }
    let intensity = (light.intensity.unwrap_or(1.0) * color / unit).as_vec3();
    if !(intensity.is_finite() && intensity.cmpge(Vec3::ZERO).all()) {
        return Err(malformed(path, format!("light {index} has the intensity {intensity}")));
    }
    let (position, direction) = (Vec3::ZERO, Vec3::NEG_Z);
    let kind = match (&*light.kind, &own.shape) {
        (_, Some(shape)) => shaped(shape),
        ("directional", None) => LightKind::Directional { direction, angle: usable_angle(own.angle.unwrap_or(0.0)) },
        ("spot", None) => {
            let (inner, outer) = cone(path, index, light.spot.as_deref().unwrap_or(&Spot::default()))?;
            let radius = usable_radius(own.radius.unwrap_or(0.0));
            LightKind::Spot { position, direction, inner, outer, radius }
        }
        ("point", None) => LightKind::Point { position, spread: spread(own) },
        _ => return Ok(None),
    };
    let light = Light {
        name: String::new(),
        kind,
        intensity,
        falloff: if own.no_falloff { Falloff::None } else { Falloff::InverseSquare },
        surface: None,
        lamp: false,
        visible: own.visible,
        motion: None,
    };
    Ok(Some(light.with_one_sided(own.one_sided)))
}

/// Radius of the ball that represents a point light; an invalid length counts as 0.
fn spread(own: &LightExtras) -> f32 {
    own.spread.filter(|spread| spread.is_finite()).unwrap_or(0.0).max(0.0)
}

/// Inner and outer half-angle.
fn cone(path: &Path, index: u32, spot: &Spot) -> Result<(f32, f32), LoadError> {
    // As `f32`, in which a right angle is a little more than in `f64`.
    let (inner, outer) = (spot.inner_cone_angle as f32, spot.outer_cone_angle as f32);
    if 0.0 <= inner && inner <= outer && outer <= FRAC_PI_2 {
        Ok((inner, outer))
    } else {
        Err(malformed(path, format!("light {index} has a cone from {inner} to {outer} radians")))
    }
}

/// An area light. Its node may rotate it and scale it uniformly.
fn shaped(shape: &ShapeExtras) -> LightKind {
    let position = Vec3::ZERO;
    match *shape {
        ShapeExtras::Sphere { radius } => LightKind::Sphere { position, radius },
        ShapeExtras::Disk { normal, radius } => LightKind::Disk { position, normal: normal.into(), radius },
        ShapeExtras::Rectangle { half_u, half_v } => {
            LightKind::Rectangle { position, half_u: half_u.into(), half_v: half_v.into() }
        }
    }
}
