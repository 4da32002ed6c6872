//! Rays for the property tests.

use glam::Vec3;
use lightmesh_render::accel::{Grid, Ray, Triangle};

use super::Random;

/// What rays can be aimed at in a scene.
pub(super) struct Targets<'a> {
    pub(super) triangles: &'a [Triangle],
    pub(super) grids: &'a [Grid],
}

impl Targets<'_> {
    /// A ray of one of many kinds.
    pub(super) fn ray(&self, random: &mut Random) -> Ray {
        let (origin, direction) = match random.below(9) {
            0 => (self.around(random), random.signed()),
            1 => self.along_axis(random),
            2 => self.towards(random, |random, corners| random.pick(&corners)),
            3 => self.towards(random, |random, [a, b, _]| a.lerp(b, random.pick(&[0.5, 0.25, 0.3]))),
            4 => self.through_cell_corner(random),
            5 => self.along_cell_edge(random),
            6 => self.in_plane(random),
            7 => (self.point(random) + random.signed() * 1e-3, random.signed() * 1e-2),
            _ => self.far_away(random),
        };
        let direction = spoiled(direction, random);
        let t_max = random.pick(&[f32::INFINITY, 1.0, 0.999, 3.0, 1e-3]);
        Ray { origin, direction, t_max: if random.below(3) == 0 { t_max } else { f32::INFINITY } }
    }

    /// Neighbouring rays of one of many kinds, enough to fill none, one or several packets; a few of them are spoiled or cut short.
    pub(super) fn beam(&self, random: &mut Random) -> Vec<Ray> {
        let count = random.pick(&[1, 3, 4, 7, 8, 9, 31, 32, 33, 64, 77]);
        let (origin, target) = (self.around(random), self.point(random));
        let (right, down) = (random.signed() * 0.05, random.signed() * 0.05);
        let along = axis(random);
        let kind = random.below(6);
        let mut rays: Vec<Ray> = (0..count)
            .map(|index| {
                let aside = right * (index % 8) as f32 + down * (index / 8) as f32;
                let (origin, direction) = match kind {
                    // The fan of a pinhole camera.
                    0 => (origin, target + aside - origin),
                    // Parallel rays.
                    1 => (origin + aside, target - origin),
                    // Axis-aligned rays: zeros of both signs.
                    2 => (target + aside - along * 4.0, along),
                    // Segments from a surface towards one light.
                    3 => (target + aside, origin - target - aside),
                    // From everywhere towards one point: all octants.
                    4 => (target + random.signed() * 4.0, Vec3::ZERO),
                    // Around an axis: signs and dominant axes change within a packet.
                    _ => (origin, along + aside - 4.0 * right - 4.0 * down),
                };
                let direction = if kind == 4 { target - origin } else { direction };
                Ray { origin, direction, t_max: if kind == 3 { 0.999 } else { f32::INFINITY } }
            })
            .collect();
        for _ in 0..random.below(4) {
            let ray = &mut rays[random.below(count)];
            match random.below(5) {
                0 => ray.direction = Vec3::ZERO,
                1 => ray.t_max = random.pick(&[0.0, 1e-3, 1e-30, f32::NAN]),
                2 => ray.origin += random.signed() * 1e6,
                3 => ray.origin = Vec3::NAN,
                _ => ray.direction = spoiled(ray.direction, random),
            }
        }
        rays
    }

    fn corners(&self, random: &mut Random) -> [Vec3; 3] {
        let usable: Vec<_> = self.triangles.iter().filter(|triangle| triangle.is_usable()).collect();
        if usable.is_empty() { [Vec3::ZERO, Vec3::X, Vec3::Y] } else { random.pick(&usable).corners() }
    }

    /// A point of a triangle.
    fn point(&self, random: &mut Random) -> Vec3 {
        let [a, b, c] = self.corners(random);
        a.lerp(b, random.unit()).lerp(c, random.unit())
    }

    /// A point near the triangles; some with whole coordinates.
    fn around(&self, random: &mut Random) -> Vec3 {
        let point = self.point(random) + random.signed() * 4.0;
        if random.below(3) == 0 { point.round() } else { point }
    }

    /// Along an axis, half of them through a vertex, where boxes are only touched.
    fn along_axis(&self, random: &mut Random) -> (Vec3, Vec3) {
        let direction = axis(random);
        let corners = self.corners(random);
        let vertex = random.pick(&corners);
        let origin = if random.below(2) == 0 { vertex - direction * 4.0 } else { self.around(random) };
        (origin, direction)
    }

    fn towards(&self, random: &mut Random, target: impl Fn(&mut Random, [Vec3; 3]) -> Vec3) -> (Vec3, Vec3) {
        let corners = self.corners(random);
        let (origin, target) = (self.around(random), target(random, corners));
        (origin, target - origin)
    }

    fn cell_corner(&self, random: &mut Random) -> Vec3 {
        let grid = &self.grids[random.below(self.grids.len())];
        grid.corner(grid.dims().map(|count| random.below(count as usize + 1) as u32))
    }

    fn through_cell_corner(&self, random: &mut Random) -> (Vec3, Vec3) {
        let target = self.cell_corner(random);
        let origin = if random.below(2) == 0 { self.cell_corner(random) } else { self.around(random) };
        (origin, target - origin)
    }

    fn along_cell_edge(&self, random: &mut Random) -> (Vec3, Vec3) {
        let direction = axis(random);
        (self.cell_corner(random) - direction * random.pick(&[0.0, 0.5, 4.0]), direction)
    }

    /// In the plane of a triangle, as far as rounding allows.
    fn in_plane(&self, random: &mut Random) -> (Vec3, Vec3) {
        let [a, b, c] = self.corners(random);
        let mut inside = || (b - a) * (random.unit() * 4.0 - 2.0) + (c - a) * (random.unit() * 4.0 - 2.0);
        let origin = a + inside();
        (origin, inside())
    }

    fn far_away(&self, random: &mut Random) -> (Vec3, Vec3) {
        let target = self.point(random);
        let origin = target + random.signed() * random.pick(&[30.0, 1e3, 1e6, 1e9]);
        (origin, (target - origin) * random.pick(&[1.0, 1e-3, 1e-6]))
    }
}

/// Along an axis, with zeros of both signs elsewhere.
fn axis(random: &mut Random) -> Vec3 {
    let mut direction = Vec3::from([0; 3].map(|_| random.pick(&[0.0, -0.0])));
    direction[random.below(3)] = random.pick(&[1.0, -1.0, 0.3]);
    direction
}

/// Makes some components zero, negative zero, tiny or subnormal, and some directions very long or short.
fn spoiled(mut direction: Vec3, random: &mut Random) -> Vec3 {
    if random.below(4) == 0 {
        direction[random.below(3)] = random.pick(&[0.0, -0.0, 1e-30, -1e-12, 1e-42, -1e-45]);
    }
    match random.below(16) {
        0 => direction * 1e-20,
        1 => direction * 1e20,
        _ => direction,
    }
}
