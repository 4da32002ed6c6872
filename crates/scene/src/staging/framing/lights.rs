//! Lights inside, for a camera that sees what lights outside do not reach.

use std::f32::consts::PI;

use glam::Vec3;

use super::rays::{directions, sparse_rays};
use super::sight::Sight;
use crate::{Bounds, Camera, Falloff, Light, LightKind, Projection};

/// By how much what is seen is moved towards the camera, as a share of the diagonal: off its surface.
const OFF: f32 = 1e-4;

/// Share of what is seen that the key light has to reach.
const REACHED: f32 = 0.2;
/// The middle of the view: rays whose median is how far one can go.
const FAN: [f32; 5] = [-0.2, -0.1, 0.0, 0.1, 0.2];
/// Where the key light may be, in order of preference: how far into the free space ahead, and how far up to the ceiling from there.
const PLACES: [[f32; 2]; 6] = [[0.5, 0.8], [0.4, 0.8], [0.6, 0.8], [0.3, 0.8], [0.5, 0.5], [0.3, 0.5]];
/// A place is taken if it reaches this share of what the best one reaches.
const NEARLY: f32 = 0.75;
/// How far the fill light is above the eye, as a share of the height of the ceiling there.
const ABOVE_EYE: f32 = 0.3;
/// The largest radius of a light as a share of the distance to what is next to it.
const ELBOW: f32 = 0.5;

/// How high a lamp may hang, as a share of the scene's height: above a lower ceiling, it reaches nothing. Its radius, as a share of the diagonal.
const LAMP_HEIGHTS: [f32; 6] = [0.97, 0.9, 0.8, 0.7, 0.6, 0.5];
const LAMP_RADIUS: f32 = 0.08;
/// What is about as high as a lamp or below it: directions that rise by at most this sine.
const LEVEL: f32 = 0.3;

/// Strengths of the lights inside, and the ambient term that goes with them: a white surface is not clipped.
const KEY_LIGHT: f32 = 0.6;
const FILL_LIGHT: f32 = 0.2;
pub(super) const AMBIENT: f32 = 0.2;

/// A point that a camera sees, just off its surface, and the normal there, turned to the camera.
struct Point {
    position: Vec3,
    normal: Vec3,
}

/// A key light and a fill light in the space that the camera sees, if `key` reaches too little of it.
pub(super) fn inside(sight: &Sight, bounds: &Bounds, camera: &Camera, key: Vec3, spread: f32) -> Option<[Light; 2]> {
    let points = seen(sight, bounds, camera);
    let reached = |light: Vec3| reached(sight, &points, light);
    let outside = reached(key);
    if outside as f32 >= REACHED * points.len() as f32 {
        return None;
    }
    let up = upwards(camera);
    let ceiling = |from: Vec3| sight.free(from, up, top(bounds, up) - from.dot(up)).max(0.0);
    let (start, end) = ahead(sight, bounds, camera);
    let places = PLACES.map(|[share, height]| {
        let below = start.lerp(end, share);
        below + height * ceiling(below) * up
    });
    let shares = places.map(reached);
    let best = shares.into_iter().max().filter(|&best| best > outside)?;
    let taken = shares.iter().position(|&share| share as f32 >= NEARLY * best as f32)?;
    let light = |name: &str, position: Vec3, intensity: f32| {
        let room = directions().map(|direction| sight.free(position, direction, bounds.diagonal()));
        let nearest = room.into_iter().fold(f32::INFINITY, f32::min);
        Light::point(position).with_spread(spread.min(ELBOW * nearest)).with_intensity([intensity; 3]).named(name)
    };
    let above_eye = start + ABOVE_EYE * ceiling(start) * up;
    Some([light("key", places[taken], KEY_LIGHT), light("fill", above_eye, FILL_LIGHT)])
}

/// A round panel high above the middle of a room that this camera looks into: below its ceiling. A white floor below it is white.
pub(super) fn lamp(sight: &Sight, bounds: &Bounds, camera: &Camera) -> Light {
    let up = upwards(camera);
    let points = seen(sight, bounds, camera);
    let height = bounds.extent().dot(up.abs());
    let floor = bounds.center() - 0.5 * height * up;
    let places = LAMP_HEIGHTS.map(|share| floor + share * height * up);
    let shares = places.map(|place| reached(sight, &points, place));
    let best = shares.into_iter().max().unwrap_or_default();
    let taken = shares.iter().position(|&share| share as f32 >= NEARLY * best as f32).unwrap_or_default();
    let position = places[taken];
    let level = directions().into_iter().filter(|direction| direction.dot(up) <= LEVEL);
    let room = level.map(|direction| sight.free(position, direction, bounds.diagonal())).fold(f32::INFINITY, f32::min);
    let radius = (LAMP_RADIUS * bounds.diagonal()).min(ELBOW * room);
    let above = sight.free(position, -up, bounds.diagonal());
    Light::new(LightKind::Disk { position, normal: -up, radius })
        .with_one_sided(true)
        .with_visible(true)
        .with_falloff(Falloff::InverseSquare)
        .with_intensity([PI * above * above; 3])
        .named("lamp")
}

/// How many of these points a light reaches.
fn reached(sight: &Sight, points: &[Point], light: Vec3) -> usize {
    let faces = |point: &&Point| (light - point.position).dot(point.normal) > 0.0;
    points.iter().filter(faces).filter(|point| sight.is_free(point.position, light)).count()
}

/// What the camera sees.
fn seen(sight: &Sight, bounds: &Bounds, camera: &Camera) -> Vec<Point> {
    let off = OFF * bounds.diagonal();
    let point = |[origin, direction]: [Vec3; 2]| {
        let seen = sight.first(origin, direction)?;
        let normal = sight.normal(seen.triangle);
        let normal = if normal.dot(direction) > 0.0 { -normal } else { normal };
        Some(Point { position: origin + seen.distance * direction + off * normal, normal })
    };
    sparse_rays(camera).into_iter().filter_map(point).collect()
}

/// The free space ahead: from the eye, or where its view enters the scene, to what is met in the middle of the image.
fn ahead(sight: &Sight, bounds: &Bounds, camera: &Camera) -> (Vec3, Vec3) {
    let (right, up, _) = camera.basis();
    let (eye, forward) = camera.middle(1.0);
    let Projection::Perspective(_) = camera.projection else {
        return within(sight, bounds, eye, forward);
    };
    let rays = FAN.iter().flat_map(|x| FAN.map(|y| (forward + *x * right + y * up).normalize()));
    let mut free: Vec<(Vec3, Vec3)> = rays.map(|ray| within(sight, bounds, eye, ray)).collect();
    free.sort_by(|a, b| a.0.distance(a.1).total_cmp(&b.0.distance(b.1)));
    free[free.len() / 2]
}

/// The first free piece of a ray in the box of the scene.
fn within(sight: &Sight, bounds: &Bounds, origin: Vec3, direction: Vec3) -> (Vec3, Vec3) {
    let (a, b) = ((bounds.min - origin) / direction, (bounds.max - origin) / direction);
    let (enters, leaves) = (a.min(b).max_element().max(0.0), a.max(b).min_element());
    let end = sight.free(origin, direction, leaves.max(enters));
    (origin + enters.min(end) * direction, origin + end * direction)
}

/// The axis that is nearest to the image's upper edge: a camera that looks down a little has a tilted one.
fn upwards(camera: &Camera) -> Vec3 {
    let axis = Vec3::AXES[camera.up.abs().max_position()];
    camera.up.dot(axis).signum() * axis
}

/// Where the scene ends in the direction of an axis or its opposite.
fn top(bounds: &Bounds, up: Vec3) -> f32 {
    (bounds.min.dot(up)).max(bounds.max.dot(up))
}
