//! The axis that points up.

use glam::Vec3;

use crate::parse_by_name;

/// The axis that points up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Up {
    /// +Y: glTF, most OBJ.
    #[default]
    Y,
    /// +Z: CAD, most STL.
    Z,
}

impl Up {
    /// Both axes.
    pub const ALL: &'static [Up] = &[Up::Y, Up::Z];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Up::Y => "y",
            Up::Z => "z",
        }
    }

    /// The axis as a unit vector.
    pub fn axis(self) -> Vec3 {
        match self {
            Up::Y => Vec3::Y,
            Up::Z => Vec3::Z,
        }
    }
}

parse_by_name!(Up, "axis");
