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
pub const PATIENCE: u64 = 1 << 28;

/// Triangulates polygons; used for a whole file, because it reuses its memory and counts its work.
#[derive(Debug)]
pub struct Cutter {
    flat: Vec<DVec2>,
    next: Vec<usize>,
    previous: Vec<usize>,
    /// Corners that may lie in another corner's triangle.
    reflex: Vec<usize>,
    /// Corners to be looked at, and where each is in the queue; entries elsewhere do not count.
    queue: Vec<usize>,
    place: Vec<usize>,
    near: Near,
    /// Steps that are left.
    pub patience: u64,
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
    pub fn cut(&mut self, corners: &[DVec3], mut emit: impl FnMut([usize; 3])) {
        if corners.len() > 3 && self.flatten(corners) {
            self.clip_ears(emit);
        } else {
            (2..corners.len()).for_each(|third| emit([0, third - 1, third]));
        }
    }

    /// The problem, for a warning about the file.
    pub fn warning(&self) -> Option<String> {
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
