//! The angle from which an edge is a crease.

/// Neighbouring triangles whose normals differ by less than this are parts of one smooth surface; others meet in a crease.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CreaseAngle {
    degrees: f64,
}

/// It is never NaN.
impl Eq for CreaseAngle {}

impl CreaseAngle {
    /// An angle above 0 and at most 180 degrees; `None` for others.
    pub fn from_degrees(degrees: f64) -> Option<CreaseAngle> {
        (degrees > 0.0 && degrees <= 180.0).then_some(CreaseAngle { degrees })
    }

    /// In degrees.
    pub fn degrees(self) -> f64 {
        self.degrees
    }

    pub(super) fn radians(self) -> f64 {
        self.degrees.to_radians()
    }
}

/// 30 degrees: columns of 13 sides and more are round, bevels stay.
impl Default for CreaseAngle {
    fn default() -> CreaseAngle {
        CreaseAngle { degrees: 30.0 }
    }
}
