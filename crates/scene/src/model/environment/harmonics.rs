//! What surfaces of all normals receive, as spherical harmonics of the second degree.

use std::f64::consts::PI;

use glam::{DVec3, Vec3};

/// What all surfaces receive.
#[derive(Clone, Copy, Debug)]
pub(super) struct Irradiance {
    pub(super) mean: Vec3,
    pub(super) terms: [Vec3; 9],
}

/// The harmonics along a direction, without their constants.
pub(super) fn basis(d: DVec3) -> [f64; 9] {
    [1.0, d.x, d.y, d.z, d.x * d.y, d.y * d.z, d.z * d.x, 3.0 * d.z * d.z - 1.0, d.x * d.x - d.y * d.y]
}

impl Irradiance {
    /// By the integrals of radiance times the [basis].
    pub(super) fn of(integrals: &[DVec3; 9]) -> Irradiance {
        // Squares of the constants of spherical harmonics, and what a cosine keeps of each degree: 1, 2/3 and 1/4.
        let kept = |index: usize, constant: f64, share: f64| share * constant * constant * integrals[index];
        let linear = |index: usize| kept(index, 0.488_603, 2.0 / 3.0);
        let product = |index: usize| kept(index, 1.092_548, 0.25);
        let zonal = kept(7, 0.315_392, 0.25);
        let terms = [
            kept(0, 0.282_095, 1.0) - zonal,
            linear(1),
            linear(2),
            linear(3),
            product(4),
            product(5),
            product(6),
            3.0 * zonal,
            kept(8, 0.546_274, 0.25),
        ];
        Irradiance { mean: (integrals[0] / (4.0 * PI)).as_vec3(), terms: terms.map(|term| term.as_vec3()) }
    }
}
