//! What light points see.

/// What every used light point sees of every light.
#[derive(Clone, Debug, Default)]
pub struct Lit {
    /// One entry a light.
    pub lights: Vec<LitBy>,
}

/// What the used light points see of one light.
#[derive(Clone, Debug)]
pub enum LitBy {
    /// Seen or not: one word a brick, addressed as the used-bitmap is, so that no rank is needed.
    Bits(Vec<u64>),
    /// Shadow rays out of `samples` that reached the light, by rank.
    Share {
        /// Rays that got through.
        seen: Vec<u16>,
        /// Rays cast.
        samples: u32,
    },
}
