//! What hides the sun, and who looks for it.

use glam::DVec3;

/// A triangle that hides the sun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blocker {
    /// Its corners.
    pub corners: [DVec3; 3],
    /// The object that it belongs to, below [`MANY`](crate::MANY).
    pub object: u32,
}

/// A point that may see the sun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Receiver {
    /// Where it is.
    pub point: DVec3,
    /// It sees only what is in front of the plane with this normal; zero: everything.
    pub normal: DVec3,
}
