//! How far away, and where across, a camera of a given direction has to be.

use glam::{Vec2, Vec3};

use super::{sight::Sight, strays::Subject};
use crate::{Bounds, Camera, Fov, Mesh, Projection, Up};

/// Vertical field of view of the camera that frames a scene, degrees.
pub const VFOV: f32 = 40.0;
/// Share of the image's half height that the framed scene fills.
pub const FILL: f32 = 0.92;

/// A camera of this direction that frames the subject, which fills this share of the image.
pub(super) fn framing((sight, subject): (&Sight, &Subject), direction: Vec3, up: Up, aspect: f32, fill: f32) -> Camera {
    let mut camera = Camera {
        name: "default".to_owned(),
        position: subject.bounds.center(),
        direction,
        up: up.axis(),
        projection: Projection::Perspective(Fov::Vertical(VFOV)),
        shift: Vec2::ZERO,
        near: 0.0,
        far: f32::INFINITY,
        motion: None,
    };
    camera.position = fitting(sight.mesh(), subject, &camera, aspect, fill);
    camera
}

/// Calls a function with each point that is framed, in coordinates to the right, up and forward.
type EachPoint<'a> = dyn Fn(&mut dyn FnMut(Vec3)) + 'a;

/// Where a camera of this direction has to be so that all vertices of what it frames fit in this share of an image of this width, relative to its height, in its middle.
///
/// In coordinates to the right, up and forward, with T the tangent of half the field of view along an axis of the image, a point is left of the right border of a
/// camera at c if `x - c.x <= T (z - c.z)`, so the largest `x - T z` of all points bounds `c.x - T c.z`; and so for each border. The
/// axis with the larger distance between its borders decides how far the camera is, and [`middle`] its place across.
fn fitting(mesh: &Mesh, subject: &Subject, camera: &Camera, aspect: f32, fill: f32) -> Vec3 {
    let (right, up, forward) = camera.basis();
    let high = fill * (0.5 * VFOV).to_radians().tan();
    let wide = aspect * high;
    let center = subject.bounds.center();
    let each = |take: &mut dyn FnMut(Vec3)| {
        let seen = |point: Vec3| {
            let point = point - center;
            take(Vec3::new(point.dot(right), point.dot(up), point.dot(forward)));
        };
        if subject.has_vertices(mesh) {
            subject.each_vertex(mesh, seen);
        } else {
            (0..8).map(|i| corner(&subject.bounds, i)).for_each(seen);
        }
    };
    let mut borders = [f32::NEG_INFINITY; 4];
    each(&mut |Vec3 { x, y, z }| {
        for (border, (aside, tangent)) in borders.iter_mut().zip([(x, wide), (-x, wide), (y, high), (-y, high)]) {
            *border = border.max(aside - tangent * z);
        }
    });
    let [east, west, north, south] = borders;
    let back = ((east + west) / (2.0 * wide)).max((north + south) / (2.0 * high)).max(0.0);
    let [x, y] = middle(&each, back, [0.5 * (east - west), 0.5 * (north - south)]);
    center + x * right + y * up - back * forward
}

/// Where across a camera has to be, this far back, so that points reach as far to the right as to the left in its image, and as far up as down: the
/// borders that [`fitting`] found meet only along the axis that decides, and along the other one the points would be beside the middle.
///
/// Of a camera at s, the points at u and v, at the depths p and q, are outermost if (u − s) / p is the largest and (v − s) / q the smallest.
/// They are equally far from the middle where s = (u q + v p) / (p + q). There, others may be outermost: so it is repeated until it stays.
fn middle(each: &EachPoint, back: f32, mut place: [f32; 2]) -> [f32; 2] {
    /// Usual models take two or three.
    const ROUNDS: usize = 8;
    for _ in 0..ROUNDS {
        let mut outermost = [[(f32::NEG_INFINITY, 0.0, 1.0), (f32::INFINITY, 0.0, 1.0)]; 2];
        each(&mut |point| {
            let depth = point.z + back;
            for ((axis, place), [most, least]) in [point.x, point.y].into_iter().zip(place).zip(&mut outermost) {
                let slope = (axis - place) / depth;
                if depth > 0.0 && slope > most.0 {
                    *most = (slope, axis, depth);
                }
                if depth > 0.0 && slope < least.0 {
                    *least = (slope, axis, depth);
                }
            }
        });
        let between = outermost.map(|[(_, u, p), (_, v, q)]| (u * q + v * p) / (p + q));
        let usual = between.iter().all(|place| place.is_finite());
        if !usual || between == place {
            break;
        }
        place = between;
    }
    place
}

/// One of the eight corners of a box.
pub fn corner(Bounds { min, max }: &Bounds, i: u32) -> Vec3 {
    let pick = |bit: u32, low: f32, high: f32| if i & bit == 0 { low } else { high };
    Vec3::new(pick(1, min.x, max.x), pick(2, min.y, max.y), pick(4, min.z, max.z))
}
