//! Cameras. They look along −Z of their node, with +Y up; its scale does not change them. How wide they see follows from the
//! image's shape, and what they clip is not clipped: `aspectRatio`, `xmag`, `znear` and `zfar` are not looked at.

use std::{f64::consts::PI, path::Path};

use glam::Vec3;

use super::{
    axes::Axes,
    container::malformed,
    document,
    extras::{self, CameraExtras},
    nodes::Placed,
};
use crate::{Camera, Fov, LoadError, Projection, formats::toml::upright};

/// A camera of this name in its node, at the local frame's zero.
pub(super) fn placed(axes: &Axes, placed: &Placed, name: String, projection: Projection) -> Result<Camera, LoadError> {
    let direction = axes.forward(placed)?;
    let up = upright(direction, axes.up(placed)?).ok_or_else(|| axes.flat(placed))?;
    Ok(Camera { name, position: Vec3::ZERO, direction: direction.as_vec3(), up: up.as_vec3(), projection })
}

/// What camera number `index` of the document sees.
pub(super) fn projection(path: &Path, index: u32, camera: &document::Camera) -> Result<Projection, LoadError> {
    let bad = |what: &str, value: f64| Err(malformed(path, format!("camera {index} has {what} = {value}")));
    if let Some(perspective) = &camera.perspective {
        if !(perspective.yfov > 0.0 && perspective.yfov < PI) {
            return bad("yfov", perspective.yfov);
        }
        let own: Option<CameraExtras> = extras::read(path, &format!("camera {index}"), camera.extras)?;
        return match own {
            Some(own) if own.hfov > 0.0 && own.hfov < 180.0 => Ok(Projection::Perspective(Fov::Horizontal(own.hfov))),
            Some(own) => bad("extras.lightmesh.hfov", own.hfov.into()),
            None => Ok(Projection::Perspective(Fov::Vertical(perspective.yfov.to_degrees() as f32))),
        };
    }
    let Some(orthographic) = &camera.orthographic else {
        return Err(malformed(path, format!("camera {index} says neither yfov nor ymag")));
    };
    // Negative, it would mirror the image; exporters write it for nothing.
    let height = (2.0 * orthographic.ymag.abs()) as f32;
    if height > 0.0 && height.is_finite() {
        Ok(Projection::Orthographic { height })
    } else {
        bad("ymag", orthographic.ymag)
    }
}
