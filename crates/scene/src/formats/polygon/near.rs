//! Finds corners of a polygon in a box: a k-d tree (Bentley 1975). Not a grid, because corners lie along a line and fill few cells.

use glam::DVec2;

/// Corners that are not divided further.
const FEW: usize = 8;

/// Some corners, sorted so that the middle one of a range divides the others, by x at the first level, by y at the second, and so on.
#[derive(Debug, Default)]
pub(super) struct Near {
    corners: Vec<(DVec2, usize)>,
    /// First and last corner of ranges to be handled, and the axis that divides them.
    ranges: Vec<(usize, usize, usize)>,
}

impl Near {
    /// Sorts `corners`, whose positions are in `points`.
    pub(super) fn sort(&mut self, points: &[DVec2], corners: &[usize]) {
        self.corners.clear();
        self.corners.extend(corners.iter().map(|&corner| (points[corner], corner)));
        self.ranges.clear();
        self.ranges.push((0, corners.len(), 0));
        while let Some((first, end, axis)) = self.ranges.pop() {
            if end - first > FEW {
                let middle = (first + end) / 2;
                let by_axis = |a: &(DVec2, usize), b: &(DVec2, usize)| a.0[axis].total_cmp(&b.0[axis]);
                self.corners[first..end].select_nth_unstable_by(middle - first, by_axis);
                self.ranges.extend([(first, middle, 1 - axis), (middle + 1, end, 1 - axis)]);
            }
        }
    }

    /// Whether any corner in a box fulfils a condition. Adds the corners looked at to `cost`.
    pub(super) fn any(
        &mut self,
        (low, high): (DVec2, DVec2),
        cost: &mut u64,
        fulfils: impl Fn(DVec2, usize) -> bool,
    ) -> bool {
        self.ranges.clear();
        self.ranges.push((0, self.corners.len(), 0));
        while let Some((first, end, axis)) = self.ranges.pop() {
            let (middle, divided) = ((first + end) / 2, end - first > FEW);
            let looked_at = if divided { middle..middle + 1 } else { first..end };
            *cost += 1 + looked_at.len() as u64;
            if self.corners[looked_at].iter().any(|&(point, corner)| fulfils(point, corner)) {
                return true;
            }
            if divided {
                // Corners with coordinates that are not numbers are in no triangle, wherever they are sorted to.
                let border = self.corners[middle].0[axis];
                self.ranges.extend((border >= low[axis]).then_some((first, middle, 1 - axis)));
                self.ranges.extend((border <= high[axis]).then_some((middle + 1, end, 1 - axis)));
            }
        }
        false
    }
}
