//! `[camera]` to [`Camera`].

use glam::{DVec3, Vec2, Vec3};

use super::{
    check::Source,
    schema::{CameraEntry, ProjectionName},
    spanned::Spanned,
};
use crate::build::warnings::Warnings;
use crate::model::transforms::{unit, upright};
use crate::{Camera, Fov, LoadError, Projection};

/// Default vertical field of view, degrees.
const DEFAULT_VFOV: f32 = 50.0;

/// The camera and its world position.
pub(super) fn read(source: &Source, table: &Spanned<CameraEntry>) -> Result<(Camera, DVec3), LoadError> {
    let entry = table.get_ref();
    let position = source.vector("position", &entry.position)?;
    let direction = view_direction(source, table, position)?;
    let up = match &entry.up {
        Some(up) => source.direction("up", up)?,
        None => DVec3::Y,
    };
    let Some(up) = upright(direction, up) else {
        let remedy = "choose an `up` that is not parallel to the view direction";
        return Err(match &entry.up {
            Some(up) => source.refuse("up", up, "is parallel to the view direction", remedy),
            None => source.missing(table, "up", "the camera looks along Y, the default `up`; add `up = [0, 0, 1]`"),
        });
    };
    let [near, far] = clip(source, entry)?;
    let camera = Camera {
        name: entry.name.as_ref().map_or(String::new(), |name| name.get_ref().clone()),
        position: Vec3::ZERO,
        direction: direction.as_vec3(),
        up: up.as_vec3(),
        projection: projection(source, table)?,
        shift: entry.shift.as_ref().map_or(Ok(Vec2::ZERO), |shift| source.shift("shift", shift))?,
        near,
        far,
        motion: None,
    };
    Ok((camera, position))
}

fn view_direction(source: &Source, table: &Spanned<CameraEntry>, position: DVec3) -> Result<DVec3, LoadError> {
    let entry = table.get_ref();
    match (&entry.target, &entry.direction) {
        (Some(target), None) => unit(source.vector("target", target)? - position)
            .ok_or_else(|| source.refuse("target", target, "is the camera's own position", "move one of them")),
        (None, Some(direction)) => source.direction("direction", direction),
        (None, None) => {
            Err(source.missing(table, "target", "add the point to look at, `target = [x, y, z]`, or a `direction`"))
        }
        (Some(_), Some(direction)) => {
            Err(source.refuse("direction", direction, "contradicts `target`", "keep one of them"))
        }
    }
}

/// The depths from and up to which a camera sees.
fn clip(source: &Source, entry: &CameraEntry) -> Result<[f32; 2], LoadError> {
    let near = match &entry.near {
        Some(near) if source.number("near", near)? < 0.0 => {
            return Err(source.refuse("near", near, "is negative", "give a distance from the camera, 0 or more"));
        }
        near => near.as_ref().map_or(0.0, |near| *near.get_ref() as f32),
    };
    let Some(far) = &entry.far else { return Ok([near, f32::INFINITY]) };
    let depth = source.positive("far", far)? as f32;
    if depth > near {
        Ok([near, depth])
    } else {
        Err(source.refuse("far", far, "is not beyond `near`", "give a larger `far`, or a smaller `near`"))
    }
}

/// Of cameras with two angles that differ: one warning, however many there are.
pub(super) fn warn_of_two_angles(source: &Source, tables: &[Spanned<CameraEntry>], warnings: &mut Warnings) {
    let mut found = tables.iter().filter_map(|table| {
        let CameraEntry { vfov: Some(vfov), hfov: Some(hfov), .. } = table.get_ref() else { return None };
        let (vfov, hfov) = (*vfov.get_ref() as f32, *hfov.get_ref() as f32);
        (vfov != hfov).then(|| (table.span(), vfov))
    });
    if let Some((span, vfov)) = found.next() {
        let others = found.count();
        let more = if others == 0 { String::new() } else { format!(", as of {others} more cameras") };
        let place = source.place(span);
        warnings.push(format!("{place}: the camera has vfov and hfov; vfov = {vfov} is used{more}"));
    }
}

fn projection(source: &Source, table: &Spanned<CameraEntry>) -> Result<Projection, LoadError> {
    let entry = table.get_ref();
    let vfov = entry.vfov.as_ref().map(|angle| source.view_angle("vfov", angle)).transpose()?;
    let hfov = entry.hfov.as_ref().map(|angle| source.view_angle("hfov", angle)).transpose()?;
    if entry.projection.as_ref().map(|name| *name.get_ref()) == Some(ProjectionName::Orthographic) {
        let Some(height) = &entry.height else {
            return Err(source.missing(table, "height", "add the height of the orthographic image in scene units"));
        };
        if let Some(angle) = entry.vfov.as_ref().or(entry.hfov.as_ref()) {
            return Err(source.refuse("fov", angle, "has no meaning in an orthographic camera", "remove it"));
        }
        return Ok(Projection::Orthographic { height: source.positive("height", height)? as f32 });
    }
    if let Some(height) = &entry.height {
        let remedy = "remove it, or add `projection = \"orthographic\"`";
        return Err(source.refuse("height", height, "has no meaning in a perspective camera", remedy));
    }
    Ok(Projection::Perspective(match (vfov, hfov) {
        (None, Some(hfov)) => Fov::Horizontal(hfov),
        // Of two angles the vertical one is used.
        (vfov, _) => Fov::Vertical(vfov.unwrap_or(DEFAULT_VFOV)),
    }))
}
