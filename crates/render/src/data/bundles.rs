//! Surface points in small groups.

/// Surface points in bundles of up to [`WARP`](lightmesh_layout::constants::WARP) that lie close together.
#[derive(Clone, Debug, Default)]
pub struct Bundles {
    /// Ray numbers, bundle by bundle.
    members: Vec<u32>,
    /// The end of each bundle.
    ends: Vec<u32>,
}

impl Bundles {
    /// Appends a bundle.
    pub(crate) fn push(&mut self, members: impl IntoIterator<Item = u32>) {
        self.members.extend(members);
        self.ends.push(self.members.len() as u32);
    }

    /// Appends all bundles of another list.
    pub(crate) fn append(&mut self, other: &Bundles) {
        let before = self.members.len() as u32;
        self.members.extend_from_slice(&other.members);
        self.ends.extend(other.ends.iter().map(|end| before + end));
    }

    /// Number of bundles.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there are no surface points.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// The rays of bundle number `bundle`.
    pub fn members(&self, bundle: usize) -> &[u32] {
        let first = if bundle == 0 { 0 } else { self.ends[bundle - 1] };
        &self.members[first as usize..self.ends[bundle] as usize]
    }

    /// Number of surface points.
    pub fn points(&self) -> usize {
        self.members.len()
    }
}
