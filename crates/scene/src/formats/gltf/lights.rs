//! `KHR_lights_punctual`: point, spot and directional lights, in candela and lux, with inverse-square falloff.
//!
//! They shine along −Z of their node; its scale does not affect them. A light's `range` is ignored: it is a hint for programs that
//! sort lights, and cuts off light that would still be visible. Area lights are our own extension, see [`extras`](super::extras).

use std::f32::consts::FRAC_PI_2;

use glam::{DMat4, DVec3, Vec3};

use super::{
    axes::Axes,
    container::malformed,
    document::{self, Spot},
    extras::{LightExtras, ShapeExtras},
    nodes::Placed,
};
use crate::{Falloff, Light, LightKind, LoadError, formats::toml::unit, light::usable_angle};

/// Light number `index` of the document in its node, at the local frame's origin, still without a name. `None` if its type is
/// unknown.
pub(super) fn placed(
    axes: &Axes,
    placed: &Placed,
    index: u32,
    light: &document::Light,
    own: &LightExtras,
) -> Result<Option<Light>, LoadError> {
    let color = light.color.as_deref().map_or(DVec3::ONE, |&color| color.into());
    let intensity = (light.intensity.unwrap_or(1.0) * color).as_vec3();
    if !(intensity.is_finite() && intensity.cmpge(Vec3::ZERO).all()) {
        return Err(malformed(axes.path, format!("light {index} has the intensity {intensity}")));
    }
    let position = Vec3::ZERO;
    let kind = match (&*light.kind, &own.shape) {
        (_, Some(shape)) => shaped(shape, &placed.transform).ok_or_else(|| {
            malformed(axes.path, format!("extras.lightmesh of light {index} does not give it a valid size"))
        })?,
        ("directional", None) => LightKind::Directional {
            direction: axes.forward(placed)?.as_vec3(),
            angle: usable_angle(own.angle.unwrap_or(0.0)),
        },
        ("spot", None) => {
            let (inner, outer) = cone(axes, index, light.spot.as_deref().unwrap_or(&Spot::default()))?;
            LightKind::Spot { position, direction: axes.forward(placed)?.as_vec3(), inner, outer }
        }
        ("point", None) => LightKind::Point { position, spread: spread(own) },
        _ => return Ok(None),
    };
    Ok(Some(Light {
        name: String::new(),
        kind,
        intensity,
        falloff: if own.no_falloff { Falloff::None } else { Falloff::InverseSquare },
        surface: None,
        motion: None,
    }))
}

/// Radius of the ball that represents a point light; an invalid length counts as 0.
fn spread(own: &LightExtras) -> f32 {
    own.spread.filter(|spread| spread.is_finite()).unwrap_or(0.0).max(0.0)
}

/// Inner and outer half-angle.
fn cone(axes: &Axes, index: u32, spot: &Spot) -> Result<(f32, f32), LoadError> {
    // As `f32`, in which a right angle is a little more than in `f64`.
    let (inner, outer) = (spot.inner_cone_angle as f32, spot.outer_cone_angle as f32);
    if 0.0 <= inner && inner <= outer && outer <= FRAC_PI_2 {
        Ok((inner, outer))
    } else {
        Err(malformed(axes.path, format!("light {index} has a cone from {inner} to {outer} radians")))
    }
}

/// An area light, whose extras are in the node's coordinates. Its node may rotate it and scale it uniformly. `None` if it becomes
/// degenerate.
fn shaped(shape: &ShapeExtras, transform: &DMat4) -> Option<LightKind> {
    let vector = |v: [f32; 3]| transform.transform_vector3(Vec3::from(v).as_dvec3());
    let scaled = |radius: f32| {
        let radius = radius * transform.x_axis.truncate().length() as f32;
        (radius > 0.0 && radius.is_finite()).then_some(radius)
    };
    let position = Vec3::ZERO;
    Some(match *shape {
        ShapeExtras::Sphere { radius } => LightKind::Sphere { position, radius: scaled(radius)? },
        ShapeExtras::Disk { normal, radius } => {
            LightKind::Disk { position, normal: unit(vector(normal))?.as_vec3(), radius: scaled(radius)? }
        }
        ShapeExtras::Rectangle { half_u, half_v } => {
            let (half_u, half_v) = (vector(half_u).as_vec3(), vector(half_v).as_vec3());
            let area = half_u.cross(half_v).length();
            (area > 0.0 && area.is_finite()).then_some(LightKind::Rectangle { position, half_u, half_v })?
        }
    })
}
