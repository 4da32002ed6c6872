//! What surfaces that are not opaque leave of the light of each light: colours in place of shares.
//!
//! ```text
//! V = share − 1/n Σ_s (1 − T_s)      over the samples s that nothing opaque hides;      T = Π (1 − α) filter      over the surfaces on the way
//! ```
//!
//! In: the shares that a technique found with opaque surfaces alone. Out: colours, and their means as shares. A technique that tests the same
//! samples thus gets what it would if it had asked for a transmittance in place of a yes or no; and nothing is asked where no surface is on the
//! way. Factors are multiplied from the surface point to the light, whatever structure finds the surfaces in which order.

pub(crate) mod cpu;
pub(crate) mod cuda;
