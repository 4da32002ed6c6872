//! `[[light]]` to [`Light`]: the keys of each kind, and their combined meaning.

use glam::{DVec3, Vec3};

use super::{
    check::{Source, present, required},
    schema::{FalloffName, LightEntry, LightKindName},
    spanned::Spanned,
    values::Number,
};
use crate::model::light::LARGEST_ANGLE;
use crate::model::transforms::unit;
use crate::{Falloff, Light, LightKind, LoadError};

/// Default half-angle of a spot light, degrees.
const DEFAULT_OUTER: f64 = 45.0;

/// The light and its world position (zero for a directional one).
pub(super) fn read(source: &Source, table: &Spanned<LightEntry>) -> Result<(Light, DVec3), LoadError> {
    let entry = table.get_ref();
    refuse_foreign_keys(source, table)?;
    let position = match &entry.position {
        Some(position) => source.vector("position", position)?,
        None if *entry.kind.get_ref() == LightKindName::Directional => DVec3::ZERO,
        None => return Err(source.missing(table, "position", "add the light's position, `position = [x, y, z]`")),
    };
    let light = Light {
        name: entry.name.as_ref().map_or(String::new(), |name| name.get_ref().clone()),
        kind: kind(source, table, position)?,
        intensity: entry.intensity.as_ref().map_or(Ok(Vec3::ONE), |color| source.color("intensity", color))?,
        falloff: match entry.falloff {
            None | Some(FalloffName::None) => Falloff::None,
            Some(FalloffName::InverseSquare) => Falloff::InverseSquare,
        },
        surface: None,
        lamp: false,
        visible: entry.visible.as_ref().is_some_and(|visible| *visible.get_ref()),
        motion: None,
    };
    let one_sided = entry.one_sided.as_ref().is_none_or(|one_sided| *one_sided.get_ref());
    Ok((light.with_one_sided(one_sided), position))
}

fn kind(source: &Source, table: &Spanned<LightEntry>, position: DVec3) -> Result<LightKind, LoadError> {
    let entry = table.get_ref();
    let local = Vec3::ZERO;
    Ok(match entry.kind.get_ref() {
        LightKindName::Point => {
            let spread = entry.spread.as_ref().map_or(Ok(0.0), |spread| source.between("spread", spread, 0.0, 1e18))?;
            LightKind::Point { position: local, spread: spread as f32 }
        }
        LightKindName::Directional => {
            let angle = entry.angle.as_ref();
            let angle = angle.map_or(Ok(0.0), |angle| source.between("angle", angle, 0.0, LARGEST_ANGLE))?;
            let direction = direction(source, table, position)?.as_vec3();
            LightKind::Directional { direction, angle: angle.to_radians() as f32 }
        }
        LightKindName::Spot => {
            let (inner, outer) = cone(source, entry)?;
            let radius = entry.radius.as_ref().map_or(Ok(0.0), |radius| source.between("radius", radius, 0.0, 1e18))?;
            LightKind::Spot {
                position: local,
                direction: direction(source, table, position)?.as_vec3(),
                inner,
                outer,
                radius: radius as f32,
            }
        }
        LightKindName::Sphere => LightKind::Sphere { position: local, radius: radius(source, table)? },
        LightKindName::Disk => LightKind::Disk {
            position: local,
            normal: direction(source, table, position)?.as_vec3(),
            radius: radius(source, table)?,
        },
        LightKindName::Rectangle => {
            let (half_u, half_v) = rectangle(source, table, position)?;
            LightKind::Rectangle { position: local, half_u: half_u.as_vec3(), half_v: half_v.as_vec3() }
        }
    })
}

/// A key that the kind does not have is a misunderstanding, and must not be ignored.
fn refuse_foreign_keys(source: &Source, table: &Spanned<LightEntry>) -> Result<(), LoadError> {
    let entry = table.get_ref();
    let there = present(&[
        ("position", entry.position.is_some()),
        ("direction", entry.direction.is_some()),
        ("target", entry.target.is_some()),
        ("normal", entry.normal.is_some()),
        ("radius", entry.radius.is_some()),
        ("spread", entry.spread.is_some()),
        ("angle", entry.angle.is_some()),
        ("inner", entry.inner.is_some()),
        ("outer", entry.outer.is_some()),
        ("u", entry.u.is_some()),
        ("v", entry.v.is_some()),
        ("size", entry.size.is_some()),
        ("up", entry.up.is_some()),
        ("one_sided", entry.one_sided.is_some()),
        ("visible", entry.visible.is_some()),
    ]);
    let taken: &[&str] = match entry.kind.get_ref() {
        LightKindName::Point => &["position", "spread"],
        LightKindName::Directional => &["direction", "angle", "visible"],
        LightKindName::Spot => &["position", "direction", "target", "inner", "outer", "radius", "visible"],
        LightKindName::Sphere => &["position", "radius", "visible"],
        LightKindName::Disk => &["position", "direction", "target", "normal", "radius", "one_sided", "visible"],
        LightKindName::Rectangle => {
            &["position", "direction", "target", "u", "v", "size", "up", "one_sided", "visible"]
        }
    };
    match there.iter().find(|key| !taken.contains(key)) {
        None => Ok(()),
        Some(key) => {
            let problem = format!("does not take `{key}`");
            let remedy = format!("it takes {}, name, intensity and falloff", taken.join(", "));
            Err(source.refuse("kind", &entry.kind, &problem, &remedy))
        }
    }
}

/// The one of `direction`, `target` and `normal` that is present.
fn direction(source: &Source, table: &Spanned<LightEntry>, position: DVec3) -> Result<DVec3, LoadError> {
    let entry = table.get_ref();
    match (&entry.direction, &entry.target, &entry.normal) {
        (Some(direction), None, None) => source.direction("direction", direction),
        (None, None, Some(normal)) => source.direction("normal", normal),
        (None, Some(target), None) => unit(source.vector("target", target)? - position)
            .ok_or_else(|| source.refuse("target", target, "is the light's own position", "move one of them")),
        (None, None, None) => Err(source.missing(
            table,
            "direction",
            "add the direction in which the light shines, `direction = [x, y, z]`",
        )),
        _ => Err(source.refuse(
            "kind",
            &entry.kind,
            "has more than one direction",
            "keep one of direction, target, normal",
        )),
    }
}

fn radius(source: &Source, table: &Spanned<LightEntry>) -> Result<f32, LoadError> {
    let radius = required(
        source,
        table,
        "radius",
        &table.get_ref().radius,
        "add its radius; a light without a size is a `point`",
    )?;
    Ok(source.positive("radius", radius)? as f32)
}

/// Inner and outer half-angle in radians.
fn cone(source: &Source, entry: &LightEntry) -> Result<(f32, f32), LoadError> {
    let angle = |key, value: &Option<Number>, default: f64| {
        value.as_ref().map_or(Ok(default), |value| source.between(key, value, 0.0, 90.0))
    };
    let outer = angle("outer", &entry.outer, DEFAULT_OUTER)?;
    let inner = angle("inner", &entry.inner, 0.0)?;
    if let (Some(outer), true) = (&entry.outer, outer as f32 <= 0.0) {
        return Err(source.refuse("outer", outer, "is not positive", "give the half-angle of the cone in degrees"));
    }
    if let (Some(value), true) = (&entry.inner, inner > outer) {
        let problem = format!("is above outer = {outer}");
        return Err(source.refuse("inner", value, &problem, "give an inner angle within the outer"));
    }
    Ok((inner.to_radians() as f32, outer.to_radians() as f32))
}

/// Half edges from `u` and `v`, or from a direction and `size`.
fn rectangle(source: &Source, table: &Spanned<LightEntry>, position: DVec3) -> Result<(DVec3, DVec3), LoadError> {
    let entry = table.get_ref();
    if let (Some(u), Some(v)) = (&entry.u, &entry.v) {
        let foreign = entry.direction.is_some() || entry.target.is_some() || entry.size.is_some() || entry.up.is_some();
        if foreign {
            let remedy = "keep either u and v, or a direction and size";
            return Err(source.refuse("kind", &entry.kind, "is specified twice", remedy));
        }
        let (edge_u, edge_v) = (source.vector("u", u)?, source.vector("v", v)?);
        let square = (edge_u.dot(edge_v)).abs() <= 1e-4 * edge_u.length() * edge_v.length();
        return match edge_u.cross(edge_v).as_vec3().length() > 0.0 {
            false => Err(source.refuse("v", v, "spans no area with `u`", "give two edges of the rectangle")),
            true if !square => Err(source.refuse("v", v, "is not at a right angle to `u`", "rotate one of them")),
            true => Ok((0.5 * edge_u, 0.5 * edge_v)),
        };
    }
    let remedy = "give both edges `u` and `v`, or a `direction` and `size = [width, height]`";
    let size = required(source, table, "size", &entry.size, remedy)?;
    let [width, height] = source.lengths("size", size)?;
    let normal = direction(source, table, position)?;
    let up = match &entry.up {
        Some(up) => source.direction("up", up)?,
        None if normal.y.abs() > 0.999 => DVec3::Z,
        None => DVec3::Y,
    };
    // So that side × up is the side to which it shines.
    let side = up.cross(normal).try_normalize();
    match (side, &entry.up) {
        (Some(side), _) => Ok((0.5 * width * side, 0.5 * height * normal.cross(side))),
        (None, Some(up)) => Err(source.refuse("up", up, "is parallel to the direction", "choose another `up`")),
        (None, None) => Err(source.refuse("kind", &entry.kind, "has no up direction", "add `up`")),
    }
}
