//! Triangulates polygons: a convex one becomes a fan, any other is clipped ear by ear.
//!
//! Ears are found as described by Meisters (1975): a convex corner whose triangle contains no other corner is clipped, until three
//! corners are left. Polygons are projected along their normal (Newell's sum), so that they need not be flat. One that intersects
//! itself has no correct triangulation; like every other it becomes n − 2 triangles, which use only its corners.
//!
//! The corners that may lie in a triangle are found through a tree, so that a polygon of very many corners takes little longer for each.

mod near;

use glam::{DVec2, DVec3};

use self::near::Near;

/// Comparisons per corner of a polygon that do not count towards [`Cutter::patience`].
const CHEAP: u64 = 256;

/// Comparisons that all polygons of a file may need beyond the cheap ones: about a second.
const PATIENCE: u64 = 1 << 28;

/// Triangulates polygons; used for a whole file, because it reuses its memory and counts its work.
#[derive(Debug)]
pub(super) struct Cutter {
    flat: Vec<DVec2>,
    next: Vec<usize>,
    previous: Vec<usize>,
    /// Corners that may lie in another corner's triangle.
    reflex: Vec<usize>,
    /// Corners to be looked at, and where each is in the queue; entries elsewhere do not count.
    queue: Vec<usize>,
    place: Vec<usize>,
    near: Near,
    patience: u64,
    given_up: usize,
}

/// The corner has been clipped.
const CUT: usize = usize::MAX;

impl Default for Cutter {
    fn default() -> Cutter {
        Cutter {
            flat: Vec::new(),
            next: Vec::new(),
            previous: Vec::new(),
            reflex: Vec::new(),
            queue: Vec::new(),
            place: Vec::new(),
            near: Near::default(),
            patience: PATIENCE,
            given_up: 0,
        }
    }
}

impl Cutter {
    /// Calls `emit` with the corners of each triangle, in the polygon's order. Fewer than three corners yield nothing.
    pub(super) fn cut(&mut self, corners: &[DVec3], mut emit: impl FnMut([usize; 3])) {
        if corners.len() > 3 && self.flatten(corners) {
            self.clip_ears(emit);
        } else {
            (2..corners.len()).for_each(|third| emit([0, third - 1, third]));
        }
    }

    /// The problem, for a warning about the file.
    pub(super) fn warning(&self) -> Option<String> {
        let count = self.given_up;
        (count > 0).then(|| {
            format!("{count} polygons with very many corners were triangulated without regard to their concave parts")
        })
    }

    /// Projects the polygon so that it is counter-clockwise, and lists its reflex corners; false if there are none.
    fn flatten(&mut self, corners: &[DVec3]) -> bool {
        let first = corners[0];
        let normal: DVec3 = corners.windows(2).map(|pair| (pair[0] - first).cross(pair[1] - first)).sum();
        // Seen along the axis that is closest to the normal, from the side on which it is counter-clockwise.
        let size = normal.abs().to_array();
        let axis = (0..3).fold(0, |most, axis| if size[axis] > size[most] { axis } else { most });
        let [right, up] = [(axis + 1) % 3, (axis + 2) % 3];
        let [right, up] = if normal[axis] < 0.0 { [up, right] } else { [right, up] };
        self.flat.clear();
        self.flat.extend(corners.iter().map(|&corner| corner - first).map(|p| DVec2::new(p[right], p[up])));
        let count = corners.len();
        self.reflex.clear();
        let mut notched = false;
        for corner in 0..count {
            let area = self.area([(corner + count - 1) % count, corner, (corner + 1) % count]);
            notched |= area < 0.0;
            if area <= 0.0 {
                self.reflex.push(corner);
            }
        }
        notched
    }

    fn clip_ears(&mut self, mut emit: impl FnMut([usize; 3])) {
        let count = self.flat.len();
        self.next.clear();
        self.next.extend((1..count).chain([0]));
        self.previous.clear();
        self.previous.extend([count - 1].into_iter().chain(0..count - 1));
        self.near.sort(&self.flat, &self.reflex);
        self.queue.clear();
        self.queue.extend(0..count);
        self.place.clear();
        self.place.extend(0..count);
        let (mut left, mut sorted, mut refused, mut at, mut last) = (count, count, 0, 0, 0);
        let mut free = CHEAP * count as u64;
        while left > 3 {
            if at == self.queue.len() {
                // All that are left once more: what blocked one may be gone.
                self.queue.clear();
                self.queue.extend((0..count).filter(|&corner| self.next[corner] != CUT));
                self.queue.iter().enumerate().for_each(|(place, &corner)| self.place[corner] = place);
                at = 0;
            }
            let corner = self.queue[at];
            at += 1;
            if self.next[corner] == CUT || self.place[corner] != at - 1 {
                continue;
            }
            let ear = [self.previous[corner], corner, self.next[corner]];
            // After a round without an ear a flat corner is accepted, after another one any.
            let (is_ear, cost) = match self.area(ear) {
                area if area > 0.0 => self.is_empty(ear),
                area => (area == 0.0 && refused >= left, 1),
            };
            if !self.spend(cost, &mut free) {
                self.given_up += 1;
                return self.fan(corner, emit);
            }
            if !is_ear && refused < 2 * left {
                refused += 1;
                continue;
            }
            emit(ear);
            self.next[ear[0]] = ear[2];
            self.previous[ear[2]] = ear[0];
            self.next[corner] = CUT;
            (left, refused, last) = (left - 1, 0, ear[2]);
            // The neighbours come last: polygons lose ears all around, not one long triangle after the other.
            for neighbour in [ear[0], ear[2]] {
                self.place[neighbour] = self.queue.len();
                self.queue.push(neighbour);
            }
            if 2 * left < sorted {
                sorted = left;
                self.forget_convex();
            }
        }
        emit([self.previous[last], last, self.next[last]]);
    }

    /// Cuts what is left into a fan.
    fn fan(&self, first: usize, mut emit: impl FnMut([usize; 3])) {
        let mut corner = self.next[first];
        while self.next[corner] != first {
            emit([first, corner, self.next[corner]]);
            corner = self.next[corner];
        }
    }

    /// Forgets the corners that are gone, and those that have become convex by what was clipped next to them.
    fn forget_convex(&mut self) {
        let mut reflex = std::mem::take(&mut self.reflex);
        reflex.retain(|&corner| {
            self.next[corner] != CUT && self.area([self.previous[corner], corner, self.next[corner]]) <= 0.0
        });
        self.near.sort(&self.flat, &reflex);
        self.reflex = reflex;
    }

    /// Accounts for comparisons; false if the file has used up its patience.
    fn spend(&mut self, cost: u64, free: &mut u64) -> bool {
        let purse = if *free >= cost { free } else { &mut self.patience };
        let enough = *purse >= cost;
        *purse -= if enough { cost } else { 0 };
        enough
    }

    /// Whether no remaining corner lies in or on the triangle, and the comparisons that this took. Corners at the same position do
    /// not count: a polygon with a hole is drawn with a seam whose two sides coincide.
    fn is_empty(&mut self, triangle: [usize; 3]) -> (bool, u64) {
        let [a, b, c] = triangle.map(|corner| self.flat[corner]);
        let mut cost = 1;
        let next = &self.next;
        let held = self.near.any((a.min(b).min(c), a.max(b).max(c)), &mut cost, |point, corner| {
            next[corner] != CUT
                && point != a
                && point != b
                && point != c
                && (b - a).perp_dot(point - a) >= 0.0
                && (c - b).perp_dot(point - b) >= 0.0
                && (a - c).perp_dot(point - c) >= 0.0
        });
        (!held, cost)
    }

    /// Twice the area of a triangle; negative if it is clockwise.
    fn area(&self, triangle: [usize; 3]) -> f64 {
        let [a, b, c] = triangle.map(|corner| self.flat[corner]);
        (b - a).perp_dot(c - b)
    }
}

#[cfg(test)]
mod tests {
    use glam::DMat3;

    use super::*;

    fn cut(corners: &[DVec3]) -> Vec<[usize; 3]> {
        let mut triangles = Vec::new();
        Cutter::default().cut(corners, |triangle| triangles.push(triangle));
        triangles
    }

    fn area(corners: &[DVec3], normal: DVec3) -> f64 {
        let triangles = cut(corners).into_iter();
        triangles.map(|t| t.map(|i| corners[i])).map(|[a, b, c]| 0.5 * (b - a).cross(c - a).dot(normal)).sum()
    }

    /// The total area of the triangles if none is reversed: each counts by its size.
    fn covered(corners: &[DVec3]) -> f64 {
        cut(corners).iter().map(|t| t.map(|i| corners[i])).map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length()).sum()
    }

    fn flat(corners: &[[f64; 2]]) -> Vec<DVec3> {
        corners.iter().map(|&[x, y]| DVec3::new(x, y, 0.0)).collect()
    }

    const NOTCHED: [[f64; 2]; 4] = [[0.0, 0.0], [4.0, 0.0], [1.0, 1.0], [0.0, 4.0]];

    #[test]
    fn a_convex_polygon_is_a_fan() {
        assert_eq!(
            cut(&flat(&[[0.0, 0.0], [1.0, 0.0], [2.0, 1.0], [1.0, 2.0], [0.0, 1.0]])),
            [[0, 1, 2], [0, 2, 3], [0, 3, 4]]
        );
        assert_eq!(cut(&flat(&[[0.0, 0.0], [1.0, 0.0]])), [[0; 3]; 0]);
    }

    #[test]
    fn a_notch_is_left_open_wherever_the_polygon_begins_and_lies() {
        for turn in 0..4 {
            for (x, y) in [(0.0, 0.0), (0.7, 0.0), (1.6, 1.6), (2.5, 0.3), (3.1, 1.0), (0.2, 4.5)] {
                let placed = DMat3::from_rotation_x(x) * DMat3::from_rotation_y(y);
                let mut corners: Vec<DVec3> = flat(&NOTCHED).iter().map(|&p| placed * p + DVec3::splat(1e3)).collect();
                corners.rotate_left(turn);
                let normal = placed * DVec3::Z;
                assert!(
                    (covered(&corners) - 4.0).abs() < 1e-9 && (area(&corners, normal) - 4.0).abs() < 1e-9,
                    "{turn}, {x}"
                );
                corners.reverse();
                assert!(
                    (covered(&corners) - 4.0).abs() < 1e-9 && (area(&corners, normal) + 4.0).abs() < 1e-9,
                    "{turn}, {x}"
                );
            }
        }
    }

    #[test]
    fn a_comb_a_spiral_and_a_frame_keep_their_area() {
        let comb: Vec<[f64; 2]> = (0..40)
            .flat_map(|x| [[f64::from(x), 0.0], [f64::from(x) + 0.5, 9.0]])
            .chain([[40.0, 10.0], [-1.0, 10.0]])
            .collect();
        let teeth = flat(&comb);
        // The area enclosed by the outline, by the shoelace formula.
        let gauss = |points: &[DVec3]| {
            0.5 * (0..points.len()).map(|i| points[i].cross(points[(i + 1) % points.len()]).z).sum::<f64>()
        };
        assert_eq!(cut(&teeth).len(), teeth.len() - 2);
        assert!((covered(&teeth) - gauss(&teeth).abs()).abs() < 1e-9);
        // A square with a square hole, joined by a seam.
        let frame = flat(&[
            [0.0, 0.0],
            [3.0, 0.0],
            [3.0, 3.0],
            [0.0, 3.0],
            [0.0, 0.0],
            [1.0, 1.0],
            [1.0, 2.0],
            [2.0, 2.0],
            [2.0, 1.0],
            [1.0, 1.0],
        ]);
        assert_eq!(cut(&frame).len(), 8);
        assert!((covered(&frame) - 8.0).abs() < 1e-9, "{}", covered(&frame));
        let arm = |r: f64, i: usize| {
            [(r + 0.05 * i as f64) * (0.3 * i as f64).cos(), (r + 0.05 * i as f64) * (0.3 * i as f64).sin()]
        };
        let spiral = flat(&(0..80).map(|i| arm(1.0, i)).chain((0..80).rev().map(|i| arm(1.3, i))).collect::<Vec<_>>());
        assert!((covered(&spiral) - gauss(&spiral).abs()).abs() < 1e-9);
    }

    #[test]
    fn corners_in_a_row_are_kept() {
        let row = flat(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 0.5], [0.0, 2.0], [0.0, 1.0]]);
        assert_eq!(cut(&row).len(), 5);
        assert!((covered(&row) - 2.5).abs() < 1e-12, "{}", covered(&row));
    }

    #[test]
    fn whatever_comes_becomes_n_minus_2_triangles() {
        let nan = DVec3::NAN;
        for corners in
            [vec![DVec3::ZERO; 9], vec![nan; 9], flat(&[[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0], [1.0, 9.0]])]
        {
            assert_eq!(cut(&corners).len(), corners.len() - 2);
        }
    }

    /// Each corner used to be compared with all that are not convex, until patience ended.
    #[test]
    fn polygons_of_very_many_corners_are_cut_in_little_work() {
        const CORNERS: usize = 90_000;
        let around = |index: usize, radius: f64| {
            let angle = std::f64::consts::TAU * index as f64 / CORNERS as f64;
            DVec3::new(radius * angle.cos(), radius * angle.sin(), 0.0)
        };
        let flower = |index: usize| around(index, 2.0 + (0.01 * index as f64).cos());
        let gear = |index: usize| around(index, 1.0 + 0.001 * (index % 2) as f64);
        // Single precision makes some corners of a circle reflex.
        let circle = |index: usize| around(index, 1.0).as_vec3().as_dvec3();
        for (name, corner) in [("flower", &flower as &dyn Fn(usize) -> DVec3), ("gear", &gear), ("circle", &circle)] {
            let corners: Vec<DVec3> = (0..CORNERS).map(corner).collect();
            let enclosed = 0.5 * (0..CORNERS).map(|i| corners[i].cross(corners[(i + 1) % CORNERS]).z).sum::<f64>();
            let (mut cutter, mut covered) = (Cutter::default(), 0.0);
            cutter.cut(&corners, |triangle| {
                let [a, b, c] = triangle.map(|corner| corners[corner]);
                covered += 0.5 * (b - a).cross(c - a).length();
            });
            assert!((covered / enclosed - 1.0).abs() < 1e-6, "{name}: {covered} instead of {enclosed}");
            assert_eq!((cutter.patience, cutter.warning()), (PATIENCE, None), "{name}");
        }
    }

    #[test]
    fn patience_ends() {
        // A zigzag that offers an ear only after a long search, again and again.
        let zigzag: Vec<DVec3> =
            (0..60_000).map(|i| DVec3::new(f64::from(i).sin(), (1.7 * f64::from(i)).cos(), 0.0)).collect();
        let mut cutter = Cutter::default();
        let mut count = 0;
        cutter.cut(&zigzag, |_| count += 1);
        assert_eq!(count, zigzag.len() - 2);
        assert!(cutter.warning().is_some_and(|warning| warning.starts_with("1 polygons")));
        cutter.cut(&flat(&NOTCHED), |triangle| assert!(triangle.contains(&2), "the notch is cut at its corner"));
    }
}
