//! What surfaces that are not opaque leave of the light of each light: colours in place of shares.
//!
//! ```text
//! V = share − 1/n Σ_s (1 − T_s)      over the samples s that nothing opaque hides;      T = Π (1 − α) filter      over the surfaces on the way
//! ```
//!
//! In: the shares that a technique found with opaque surfaces alone. Out: colours, and their means as shares. A technique that tests the same
//! samples thus gets what it would if it had asked for a transmittance in place of a yes or no; and nothing is asked where no surface is on the
//! way. Factors are multiplied from the surface point to the light, whatever structure finds the surfaces in which order.
//!
//! That takes all samples where the camera sees the surface, and at given points. Of other surface points the share
//!
//! ```text
//! a = weight · parts · max(1 − T)
//! ```
//!
//! of a white surface's light reaches the pixel at most, T being what the surface itself lets through. So they follow as many samples as
//! give the pixel's sum the noise of a single surface: a quarter of them where a is at most 1/4, and 1/16 where it is at most 1/16. V is
//! then the technique's share times the mean T of these few: of those that nothing opaque hides, or of all if it hides them all.

pub(crate) mod cpu;
pub(crate) mod cuda;
mod shown;

use lightmesh_layout::constants::{LEVEL_SHIFT, MAX_OF_LEVEL, TRANSMITTANCE_LEVELS};

use crate::render_context::Sampling;
use crate::shadow::ShadowTarget;

/// Where shadow rays end at each level of surface points, the first of which takes all samples.
fn levels(target: &ShadowTarget) -> Vec<ShadowTarget> {
    let ShadowTarget::Area(all) = *target else { return vec![*target] };
    let samples = |level: u32| match level {
        0 => all.samples,
        _ => (all.samples >> (LEVEL_SHIFT * level)).clamp(1, MAX_OF_LEVEL),
    };
    (0..TRANSMITTANCE_LEVELS).map(|level| ShadowTarget::Area(Sampling { samples: samples(level), ..all })).collect()
}
