//! Axis-aligned boxes.

use glam::Vec3;
use serde::{Deserialize, Serialize};

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bounds {
    /// Lowest corner.
    pub min: Vec3,
    /// Highest corner.
    pub max: Vec3,
}

impl Bounds {
    /// The empty box: any point enlarges it.
    pub const EMPTY: Bounds = Bounds { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    /// The smallest box around `points`.
    #[inline]
    pub fn around(points: impl IntoIterator<Item = Vec3>) -> Bounds {
        points.into_iter().fold(Bounds::EMPTY, Bounds::including)
    }

    /// This box enlarged to contain `point`.
    #[inline]
    pub fn including(self, point: Vec3) -> Bounds {
        Bounds { min: self.min.min(point), max: self.max.max(point) }
    }

    /// The box around this one and another.
    pub(crate) fn with_box(self, other: Bounds) -> Bounds {
        self.including(other.min).including(other.max)
    }

    /// The largest absolute value of a coordinate within; 0 if it is empty.
    #[inline]
    pub fn farthest(&self) -> f32 {
        if self.is_empty() { 0.0 } else { self.min.abs().max(self.max.abs()).max_element() }
    }

    /// Whether the box is empty.
    #[inline]
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// The centre.
    #[inline]
    pub fn center(&self) -> Vec3 {
        0.5 * (self.min + self.max)
    }

    /// Edge lengths; zero if the box is empty.
    #[inline]
    pub fn extent(&self) -> Vec3 {
        (self.max - self.min).max(Vec3::ZERO)
    }

    /// Length of the diagonal.
    #[inline]
    pub fn diagonal(&self) -> f32 {
        self.extent().length()
    }
}
