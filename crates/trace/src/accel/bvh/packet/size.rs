//! How large a packet is.

use crate::accel::packet::LANES;

/// Vectors of rays in a packet.
pub(super) const GROUPS: usize = 4;
/// Rays in a packet.
pub(super) const RAYS: usize = GROUPS * LANES;
