//! Curved building blocks: surfaces of revolution, tubes, sheets, balls, lumps and height fields.

use glam::{Vec2, Vec3};

use super::math::around;
use super::parts::{Paint, Parts, Place, normal_plane};

impl Parts {
    /// A surface of revolution about Y through `profile`, points (radius, height) from bottom to top. A radius of 0 closes the
    /// end in a point.
    pub(super) fn lathe(&mut self, profile: &[Vec2], sides: u32, smooth: bool, paint: Paint) {
        let rings: Vec<Vec<u32>> =
            (0..profile.len()).map(|index| self.lathe_ring(profile, index, sides, smooth)).collect();
        for pair in rings.windows(2) {
            self.band(&pair[0], &pair[1], paint);
        }
    }

    /// A faceted [lathe](Parts::lathe) that is placed at `foot`.
    pub(super) fn lathe_at(&mut self, foot: Vec3, profile: &[Vec2], sides: u32, paint: Paint) {
        self.put(Place::at(foot.x, foot.y, foot.z), |parts| parts.lathe(profile, sides, false, paint));
    }

    fn lathe_ring(&mut self, profile: &[Vec2], index: usize, sides: u32, smooth: bool) -> Vec<u32> {
        let Vec2 { x: radius, y: height } = profile[index];
        let slope = profile[(index + 1).min(profile.len() - 1)] - profile[index.saturating_sub(1)];
        let count = if radius == 0.0 { 1 } else { sides };
        (0..count)
            .map(|side| {
                let Vec2 { x, y: z } = around((side as f32 + 0.5) / sides as f32);
                let outward = Vec3::new(x * slope.y, -slope.x, z * slope.y);
                let tip = if radius == 0.0 { Vec3::Y * outward.y } else { outward };
                self.vertex(Vec3::new(x * radius, height, z * radius), if smooth { tip } else { Vec3::ZERO })
            })
            .collect()
    }

    /// Joins two rings of vertices; a ring of one vertex is a tip. Seen from outside with the first ring below, vertices run
    /// to the left.
    fn band(&mut self, below: &[u32], above: &[u32], paint: Paint) {
        let sides = below.len().max(above.len());
        for side in 0..sides {
            let at = |ring: &[u32], index: usize| ring[index % ring.len()];
            let [a, b] = [at(below, side), at(below, side + 1)];
            let [d, c] = [at(above, side), at(above, side + 1)];
            if a != b {
                self.face([a, d, b], paint);
            }
            if c != d {
                self.face([b, d, c], paint);
            }
        }
    }

    /// A round pipe along `path`, with a radius for each of its points; its ends stay open.
    pub(super) fn tube(&mut self, path: &[Vec3], radius: impl Fn(usize) -> f32, sides: u32, paint: Paint) {
        let last = path.len() - 1;
        let tangent = |index: usize| (path[(index + 1).min(last)] - path[index.saturating_sub(1)]).normalize();
        let mut side = normal_plane(tangent(0)).0;
        let mut previous: Option<Vec<u32>> = None;
        for (index, &point) in path.iter().enumerate() {
            let along = tangent(index);
            side = (side - along * side.dot(along)).normalize();
            let across = side.cross(along);
            let ring: Vec<u32> = (0..sides)
                .map(|step| {
                    let circle = around(step as f32 / sides as f32);
                    let normal = side * circle.x + across * circle.y;
                    self.vertex(point + normal * radius(index), normal)
                })
                .collect();
            if let Some(below) = previous.replace(ring.clone()) {
                self.band(&below, &ring, paint);
            }
        }
    }

    /// A straight pipe.
    pub(super) fn rod(&mut self, from: Vec3, to: Vec3, radius: f32, sides: u32, paint: Paint) {
        self.tube(&[from, to], |_| radius, sides, paint);
    }

    /// A flat round lid facing up or, with `up` false, down.
    pub(super) fn disk(&mut self, center: Vec3, radius: f32, sides: u32, up: bool, paint: Paint) {
        let corner = |side: u32| {
            let Vec2 { x, y: z } = around((side as f32 + 0.5) / sides as f32);
            center + Vec3::new(x, 0.0, z) * radius
        };
        let rim: Vec<Vec3> = (0..sides).map(|side| corner(if up { sides - 1 - side } else { side })).collect();
        self.polygon(&rim, paint);
    }

    /// A smooth ball with poles on Y.
    pub(super) fn ball(&mut self, center: Vec3, radius: f32, rings: u32, paint: Paint) {
        self.globe(rings, |direction| (center + radius * direction, direction), paint);
    }

    /// A curved sheet through rows of equally many points, each with its normal.
    pub(super) fn sheet(&mut self, rows: &[Vec<(Vec3, Vec3)>], paint: Paint) {
        let rows: Vec<Vec<u32>> =
            rows.iter().map(|row| row.iter().map(|&(point, normal)| self.vertex(point, normal)).collect()).collect();
        for pair in rows.windows(2) {
            for (low, high) in pair[0].windows(2).zip(pair[1].windows(2)) {
                self.face([low[0], low[1], high[1]], paint);
                self.face([low[0], high[1], high[0]], paint);
            }
        }
    }

    /// A lump: an ellipsoid with poles on Y, its flat facets displaced in or out by the factor that `bulge` returns for each
    /// vertex.
    pub(super) fn lump(&mut self, center: Vec3, radii: Vec3, rings: u32, mut bulge: impl FnMut() -> f32, paint: Paint) {
        self.globe(rings, |d| (center + radii * d * bulge(), Vec3::ZERO), paint);
    }

    /// Tessellates a sphere of unit directions into `rings` bands of `2 rings` sides and takes the vertex of each from `vertex`.
    fn globe(&mut self, rings: u32, mut vertex: impl FnMut(Vec3) -> (Vec3, Vec3), paint: Paint) {
        let mut previous: Option<Vec<u32>> = None;
        for ring in 0..=rings {
            let Vec2 { x: y, y: radius } = around(0.5 - 0.5 * ring as f32 / rings as f32);
            let pole = ring == 0 || ring == rings;
            let count = if pole { 1 } else { 2 * rings };
            let next: Vec<u32> = (0..count)
                .map(|side| {
                    let Vec2 { x, y: z } = around(side as f32 / (2 * rings) as f32);
                    let (position, normal) =
                        vertex(if pole { Vec3::Y * y } else { Vec3::new(x * radius, y, z * radius) });
                    self.vertex(position, normal)
                })
                .collect();
            if let Some(below) = previous.replace(next.clone()) {
                self.band(&below, &next, paint);
            }
        }
    }

    /// A height field over the rectangle from `min` to `max` (x, z) with `cells` cells; smooth.
    pub(super) fn terrain(
        &mut self,
        min: Vec2,
        max: Vec2,
        cells: [u32; 2],
        height: impl Fn(f32, f32) -> f32,
        paint: impl Fn(f32, f32) -> Paint,
    ) {
        let cell = (max - min) / Vec2::new(cells[0] as f32, cells[1] as f32);
        let at = |i: u32, j: u32| min + cell * Vec2::new(i as f32, j as f32);
        let mut ids = Vec::new();
        for (j, i) in (0..=cells[1]).flat_map(|j| (0..=cells[0]).map(move |i| (j, i))) {
            let Vec2 { x, y: z } = at(i, j);
            let rise = |dx: f32, dz: f32| height(x + dx, z + dz) - height(x - dx, z - dz);
            let reach = 0.25 * cell;
            let normal = Vec3::new(-rise(reach.x, 0.0) / reach.x, 2.0, -rise(0.0, reach.y) / reach.y);
            ids.push(self.vertex(Vec3::new(x, height(x, z), z), normal));
        }
        for (j, i) in (0..cells[1]).flat_map(|j| (0..cells[0]).map(move |i| (j, i))) {
            let center = at(i, j) + 0.5 * cell;
            let paint = paint(center.x, center.y);
            let corner = |i: u32, j: u32| ids[(j * (cells[0] + 1) + i) as usize];
            let [a, b, c, d] = [corner(i, j), corner(i, j + 1), corner(i + 1, j + 1), corner(i + 1, j)];
            self.face([a, b, c], paint);
            self.face([a, c, d], paint);
        }
    }
}

/// The points of a cubic Bézier curve at `count` equal steps of its parameter, ends included.
pub(super) fn bezier(control: [Vec3; 4], count: usize) -> Vec<Vec3> {
    let [a, b, c, d] = control;
    let point = |step: usize| {
        let t = step as f32 / (count - 1) as f32;
        let s = 1.0 - t;
        a * (s * s * s) + b * (3.0 * s * s * t) + c * (3.0 * s * t * t) + d * (t * t * t)
    };
    (0..count).map(point).collect()
}
