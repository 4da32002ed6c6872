//! Cameras. They look along −Z of their node, with +Y up; its scale does not affect them. The other angle follows from the
//! image's aspect ratio, and there is no clipping: `aspectRatio`, `xmag`, `znear` and `zfar` are ignored.

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

/// A camera with this name in its node, at the local frame's origin.
pub(super) fn placed(axes: &Axes, placed: &Placed, name: String, projection: Projection) -> Result<Camera, LoadError> {
    let direction = axes.forward(placed)?;
    let up = upright(direction, axes.up(placed)?).ok_or_else(|| axes.flat(placed))?;
    let (direction, up) = (direction.as_vec3(), up.as_vec3());
    Ok(Camera { name, position: Vec3::ZERO, direction, up, projection, motion: None })
}

/// The projection of camera number `index` of the document.
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
        return Err(malformed(path, format!("camera {index} has neither yfov nor ymag")));
    };
    // A negative value would mirror the image; exporters write it without meaning that.
    let height = (2.0 * orthographic.ymag.abs()) as f32;
    if height > 0.0 && height.is_finite() {
        Ok(Projection::Orthographic { height })
    } else {
        bad("ymag", orthographic.ymag)
    }
}
