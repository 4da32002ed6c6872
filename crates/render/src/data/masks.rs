//! Which light points each surface point sees: formula (2).

/// The masks of all surface points, in the order of [`CellGroups::members`](super::cells::CellGroups::members).
#[derive(Clone, Debug)]
pub struct Masks {
    /// 32-bit words per mask.
    pub words: usize,
    /// `words` words for each surface point; bit k of a mask is bit k % 32 of word k / 32.
    pub bits: Vec<u32>,
}

impl Masks {
    /// The mask of the surface point at `slot`.
    #[inline(always)]
    pub fn mask(&self, slot: usize) -> &[u32] {
        &self.bits[slot * self.words..][..self.words]
    }
}

/// Number of set bits.
#[inline(always)]
pub(crate) fn population(mask: &[u32]) -> u64 {
    let mut count = 0;
    for word in mask {
        count += word.count_ones();
    }
    u64::from(count)
}
