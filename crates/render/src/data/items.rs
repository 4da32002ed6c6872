//! Surface points in small groups.

/// Surface points in items of up to [`WARP`](lightmesh_layout::constants::WARP) that lie close together.
#[derive(Clone, Debug, Default)]
pub struct Items {
    /// Ray numbers, item by item.
    members: Vec<u32>,
    /// The end of each item.
    ends: Vec<u32>,
}

impl Items {
    /// Appends an item.
    pub(crate) fn push(&mut self, members: impl IntoIterator<Item = u32>) {
        self.members.extend(members);
        self.ends.push(self.members.len() as u32);
    }

    /// Appends all items of another list.
    pub(crate) fn append(&mut self, other: &Items) {
        let before = self.members.len() as u32;
        self.members.extend_from_slice(&other.members);
        self.ends.extend(other.ends.iter().map(|end| before + end));
    }

    /// Number of items.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there are no surface points.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// The rays of item number `item`.
    pub fn members(&self, item: usize) -> &[u32] {
        let first = if item == 0 { 0 } else { self.ends[item - 1] };
        &self.members[first as usize..self.ends[item] as usize]
    }

    /// Number of surface points.
    pub fn points(&self) -> usize {
        self.members.len()
    }
}
