//! Surface points grouped by light-mesh cell.

use std::ops::Range;

use crate::light_mesh::PointKey;

/// The cells that contain surface points, in ascending order of key, and the surface points of each.
#[derive(Clone, Debug, Default)]
pub struct CellGroups {
    cells: Vec<PointKey>,
    /// The start of each cell's members, and their total number at the end.
    starts: Vec<u32>,
    members: Vec<u32>,
}

impl CellGroups {
    /// The groups of rays sorted by the cell of their surface point.
    pub(crate) fn of_sorted(keyed: &[(PointKey, u32)]) -> CellGroups {
        let mut groups = CellGroups { members: keyed.iter().map(|&(_, ray)| ray).collect(), ..CellGroups::default() };
        for (slot, &(cell, _)) in keyed.iter().enumerate() {
            if groups.cells.last() != Some(&cell) {
                groups.cells.push(cell);
                groups.starts.push(slot as u32);
            }
        }
        groups.starts.push(keyed.len() as u32);
        groups
    }

    /// Number of cells.
    pub fn len(&self) -> usize {
        self.cells.len()
    }

    /// Whether there are no surface points.
    pub fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    /// The key of cell number `group`.
    pub fn cell(&self, group: usize) -> PointKey {
        self.cells[group]
    }

    /// The slots of the surface points in cell number `group`.
    pub fn slots(&self, group: usize) -> Range<usize> {
        self.starts[group] as usize..self.starts[group + 1] as usize
    }

    /// The slots of the surface points in some consecutive cells.
    pub(crate) fn slots_of(&self, groups: &Range<usize>) -> Range<usize> {
        self.starts[groups.start] as usize..self.starts[groups.end] as usize
    }

    /// The ray of each slot.
    pub fn members(&self) -> &[u32] {
        &self.members
    }

    /// Splits the cells into runs of about `size` surface points, to distribute among threads: ranges of groups.
    pub(crate) fn runs(&self, size: usize) -> Vec<Range<usize>> {
        let mut runs = Vec::new();
        let mut first = 0;
        for group in 0..self.len() {
            if self.slots_of(&(first..group + 1)).len() >= size || group + 1 == self.len() {
                runs.push(first..group + 1);
                first = group + 1;
            }
        }
        runs
    }
}
