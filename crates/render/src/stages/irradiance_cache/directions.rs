//! Directions of gather rays, and the bins into which they are sorted. Only + − × ÷ √, so that all devices agree. Twin: `directions.cuh`.

use glam::{Vec2, Vec3};
use lightmesh_layout::constants::BINS_PER_SIDE;

/// Bins along each side of the octahedron's square.
const PER_SIDE: usize = BINS_PER_SIDE as usize;
/// Bins of all directions.
pub const BINS: usize = PER_SIDE * PER_SIDE;

/// Two unit vectors that form a right-handed basis with the unit vector `n` (Duff et al.: *Building an Orthonormal Basis, Revisited*, JCGT
/// 6(1), 2017).
#[inline(always)]
pub fn basis(n: Vec3) -> [Vec3; 2] {
    let sign = if n.z >= 0.0 { 1.0 } else { -1.0 };
    let a = -1.0 / (sign + n.z);
    let b = n.x * n.y * a;
    [Vec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x), Vec3::new(b, sign + n.y * n.y * a, -n.y)]
}

/// The direction above the z axis that a point of the square [−1, 1]² stands for, and the weight of its cosine: the density of directions,
/// times the cosine, relative to that of the square.
///
/// The square becomes the unit disc, x = u √(1 − v²/2), y = v √(1 − u²/2), and the disc the hemisphere above it, so that equal areas of the
/// disc have the same irradiance. The weight is the map's Jacobian.
#[inline(always)]
pub fn above(square: Vec2) -> (Vec3, f32) {
    let (u, v) = (square.x * square.x, square.y * square.y);
    let (across, along) = ((1.0 - 0.5 * v).sqrt(), (1.0 - 0.5 * u).sqrt());
    let height = ((1.0 - u) * (1.0 - v)).max(0.0).sqrt();
    let weight = (1.0 - 0.5 * u - 0.5 * v) / (across * along);
    (Vec3::new(square.x * across, square.y * along, height), weight)
}

/// The bin of a direction: its place in the octahedral map of all directions.
#[inline(always)]
pub fn bin(direction: Vec3) -> usize {
    let sum = direction.x.abs() + direction.y.abs() + direction.z.abs();
    let (mut x, mut y) = (direction.x / sum, direction.y / sum);
    if direction.z < 0.0 {
        let sign = |value: f32| if value >= 0.0 { 1.0 } else { -1.0 };
        (x, y) = ((1.0 - y.abs()) * sign(x), (1.0 - x.abs()) * sign(y));
    }
    let place = |along: f32| ((0.5 * along + 0.5) * PER_SIDE as f32).clamp(0.0, PER_SIDE as f32 - 1.0) as usize;
    place(y) * PER_SIDE + place(x)
}
