//! What light points see.

/// The visibility of every light at every used light point.
#[derive(Clone, Debug, Default)]
pub struct LightPointVisibility {
    /// One entry per light.
    pub lights: Vec<VisibilityOfLight>,
}

/// The visibility of one light at the used light points.
#[derive(Clone, Debug)]
pub enum VisibilityOfLight {
    /// Lit or not: one word per brick, addressed like the used-bitmap, so that no rank is needed.
    Bits(Vec<u64>),
    /// Shadow rays out of `samples` that reached the light, by rank.
    Share {
        /// Rays that reached the light.
        seen: Vec<u16>,
        /// Rays cast.
        samples: u32,
    },
}
