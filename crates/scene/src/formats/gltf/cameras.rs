//! Cameras. They look along −Z of their node, with +Y up; its scale does not affect them. The other angle follows from the
//! image's aspect ratio: `aspectRatio` and `xmag` are ignored. So are `znear` and `zfar`, which exporters choose for the depth buffers of
//! rasterisers; clip planes that cut are `near` and `far` in the extras of files that we have written.

use std::{f64::consts::PI, path::Path};

use glam::{Vec2, Vec3};

use super::{
    container::malformed,
    document,
    extras::{self, CameraExtras},
};
use crate::model::camera::LARGEST_SHIFT;
use crate::{Camera, Fov, LoadError, Projection};

/// A camera in the coordinates of a node.
pub(super) fn camera(name: String, Lens { projection, shift, clip: [near, far] }: Lens) -> Camera {
    let (position, direction, up) = (Vec3::ZERO, Vec3::NEG_Z, Vec3::Y);
    Camera { name, position, direction, up, projection, shift, near, far, motion: None }
}

/// What a camera of the document says.
#[derive(Clone, Copy)]
pub(super) struct Lens {
    projection: Projection,
    shift: Vec2,
    /// The depths from and up to which it sees.
    clip: [f32; 2],
}

/// That of camera number `index` of the document.
pub(super) fn lens(path: &Path, index: u32, camera: &document::Camera) -> Result<Lens, LoadError> {
    let own: CameraExtras = extras::read(path, &format!("camera {index}"), camera.extras)?.unwrap_or_default();
    let shift = Vec2::from(own.shift.unwrap_or_default());
    if shift.abs().max_element() > LARGEST_SHIFT {
        return Err(malformed(path, format!("camera {index} has extras.lightmesh.shift = {shift}")));
    }
    let clip = [own.near.unwrap_or(0.0), own.far.unwrap_or(f32::INFINITY)];
    if !(clip[0] >= 0.0 && clip[0] < clip[1]) {
        return Err(malformed(path, format!("camera {index} has extras.lightmesh.near and far = {clip:?}")));
    }
    Ok(Lens { projection: projection(path, index, camera, &own)?, shift, clip })
}

fn projection(path: &Path, index: u32, camera: &document::Camera, own: &CameraExtras) -> Result<Projection, LoadError> {
    let bad = |what: &str, value: f64| Err(malformed(path, format!("camera {index} has {what} = {value}")));
    if let Some(perspective) = &camera.perspective {
        if !(perspective.yfov > 0.0 && perspective.yfov < PI) {
            return bad("yfov", perspective.yfov);
        }
        return match own.hfov {
            Some(hfov) if hfov > 0.0 && hfov < 180.0 => Ok(Projection::Perspective(Fov::Horizontal(hfov))),
            Some(hfov) => bad("extras.lightmesh.hfov", hfov.into()),
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
