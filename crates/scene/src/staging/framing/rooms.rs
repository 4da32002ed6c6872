//! Is a scene something to look at, or something to stand in? And where would one stand?

use std::f32::consts::TAU;

use glam::{Vec2, Vec3};
use rayon::prelude::*;

use super::rays::{AROUND, directions, sparse_rays};
use super::sight::Sight;
use crate::{Bounds, Camera, Fov, Projection};

/// Places per axis of the ground plan where one might stand.
const PLACES: usize = 9;
/// From where a floor is looked for, and how far the eye is above it, as shares of the scene's height.
const FROM: f32 = 0.2;
const EYE: f32 = 0.12;
/// A floor rises at most as steeply: the cosine of its slope.
const FLAT: f32 = 0.5;
/// In a room, at least this share of the directions around meets something, and this share of what is met shows its front.
const WALLS: f32 = 0.7;
const FRONTS: f32 = 0.75;
/// How near the nearest thing may be, as a share of the diagonal.
const ELBOW: f32 = 0.005;
/// Share of the places that are in a room, if the scene is an interior.
const ROOMS: f32 = 0.6;

/// An interior with an open side is looked into from there: the share of directions that leave it, and how much they agree, as the length of
/// their mean.
const OPENING: f32 = 0.04;
const AGREEING: f32 = 0.7;

/// Horizontal directions of view that are compared; rays of each, across and upwards.
const VIEWS: usize = 32;
const ACROSS: [f32; 5] = [-0.5, -0.25, 0.0, 0.25, 0.5];
const UPWARDS: [f32; 4] = [-0.25, -0.05, 0.15, 0.35];
/// How far away the sky counts as, as a share of the diagonal.
const SKY: f32 = 0.3;
/// Vertical field of view of a camera inside, degrees.
const VFOV: f32 = 60.0;

/// A camera from outside that sees an interior's walls from behind, or less than this share of its triangles, shows nothing of it.
const BACKS: f32 = 0.5;
const MIN_SEEN: f32 = 0.1;
/// Triangles of which it is found out whether they are seen.
const ASKED: usize = 1024;

/// Where one could stand in a room.
pub(super) struct Place {
    eye: Vec3,
    /// Sum of the directions that leave the scene, and their number.
    open: Vec3,
    leaving: usize,
}

/// How an interior is looked at.
pub(super) enum Interior {
    /// From outside along this horizontal direction, through an open side.
    OpenSide(Vec3),
    /// From inside.
    Inside(Camera),
}

/// The interior that a scene is, or `None`: a camera in front shows it.
pub(super) fn interior(sight: &Sight, bounds: &Bounds, up: Vec3, front: &Camera) -> Option<Interior> {
    let places = places(sight, bounds, up);
    if (places.len() as f32) < ROOMS * (PLACES * PLACES) as f32 || !hides(sight, front) {
        return None;
    }
    let (open, leaving) =
        places.iter().fold((Vec3::ZERO, 0), |(open, number), place| (open + place.open, number + place.leaving));
    let (mean, share) = (open / leaving.max(1) as f32, leaving as f32 / (places.len() * AROUND) as f32);
    let sideways = mean - mean.dot(up) * up;
    if share >= OPENING && sideways.length() >= AGREEING {
        // Walls stand along the axes.
        let axis = Vec3::AXES[sideways.abs().max_position()];
        return Some(Interior::OpenSide(-sideways.dot(axis).signum() * axis));
    }
    Some(Interior::Inside(longest_view(sight, bounds, up, &places)))
}

/// Places in rooms, in the order of the ground plan.
fn places(sight: &Sight, bounds: &Bounds, up: Vec3) -> Vec<Place> {
    let (extent, height) = (bounds.extent(), bounds.extent().dot(up));
    let (right, back) = if up == Vec3::Y { (Vec3::X, Vec3::Z) } else { (Vec3::X, Vec3::Y) };
    let directions = directions();
    let share = |number: usize| 0.1 + 0.8 * number as f32 / (PLACES - 1) as f32;
    let place = |number: usize| {
        let (x, z) = (share(number % PLACES), share(number / PLACES));
        let above = bounds.min + extent * (x * right + z * back + FROM * up);
        let floor = sight.first(above, -up).filter(|floor| sight.normal(floor.triangle).dot(up) > FLAT)?;
        let eye = above + (EYE * height - floor.distance) * up;
        let mut place = Place { eye, open: Vec3::ZERO, leaving: 0 };
        let (mut fronts, mut nearest) = (0, f32::INFINITY);
        for &direction in &directions {
            let Some(seen) = sight.first(eye, direction) else {
                place.open += direction;
                place.leaving += 1;
                continue;
            };
            fronts += usize::from(sight.normal(seen.triangle).dot(direction) < 0.0);
            nearest = nearest.min(seen.distance);
        }
        let walls = (AROUND - place.leaving) as f32;
        let is_room =
            walls > WALLS * AROUND as f32 && fronts as f32 > FRONTS * walls && nearest > ELBOW * bounds.diagonal();
        is_room.then_some(place)
    };
    (0..PLACES * PLACES).into_par_iter().filter_map(place).collect()
}

/// Whether a camera outside shows little of the scene: walls from behind, or few of its triangles.
fn hides(sight: &Sight, camera: &Camera) -> bool {
    let rays = sparse_rays(camera);
    let seen: Vec<(Vec3, u32)> = rays
        .iter()
        .filter_map(|&[origin, direction]| Some((direction, sight.first(origin, direction)?.triangle)))
        .collect();
    let backs = seen.iter().filter(|&&(direction, triangle)| sight.normal(triangle).dot(direction) > 0.0).count();
    if backs as f32 > BACKS * seen.len() as f32 {
        return true;
    }
    let mesh = sight.mesh();
    let asked = mesh.triangles.len().min(ASKED);
    let is_seen = |&number: &usize| {
        let triangle = number * mesh.triangles.len() / asked;
        let center = mesh.corners(triangle).iter().sum::<Vec3>() / 3.0;
        let first = sight.first(camera.position, center - camera.position);
        first.is_some_and(|first| first.triangle == triangle as u32 || first.distance >= 0.999)
    };
    ((0..asked).filter(is_seen).count() as f32) < MIN_SEEN * asked as f32
}

/// The view of all places and horizontal directions that is longest: the largest mean logarithm of the distance of what is seen.
fn longest_view(sight: &Sight, bounds: &Bounds, up: Vec3, places: &[Place]) -> Camera {
    let diagonal = bounds.diagonal();
    let (x, z) = if up == Vec3::Y { (Vec3::X, Vec3::Z) } else { (Vec3::X, Vec3::Y) };
    let view = |number: usize| {
        let (sin, cos) = (TAU * (number % VIEWS) as f32 / VIEWS as f32).sin_cos();
        let forward = cos * x + sin * z;
        (places[number / VIEWS].eye, forward, forward.cross(up))
    };
    let depth = |number: usize| {
        let (eye, forward, right) = view(number);
        let rays = ACROSS.iter().flat_map(|across| UPWARDS.map(|upwards| forward + *across * right + upwards * up));
        rays.map(|ray| (sight.free(eye, ray.normalize(), SKY * diagonal) / diagonal).max(f32::MIN_POSITIVE).ln()).sum()
    };
    let depths: Vec<f32> = (0..places.len() * VIEWS).into_par_iter().map(depth).collect();
    let deepest = (1..depths.len()).fold(0, |best, number| if depths[number] > depths[best] { number } else { best });
    let (position, forward, _) = view(deepest);
    Camera {
        name: "default".to_owned(),
        position,
        direction: forward.normalize(),
        up,
        projection: Projection::Perspective(Fov::Vertical(VFOV)),
        shift: Vec2::ZERO,
        near: 0.0,
        far: f32::INFINITY,
        motion: None,
    }
}
