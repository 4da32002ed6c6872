//! Positions of vertices in the precision of their file.

use glam::{DVec3, Vec3};

/// A vertex as provided by a loader, in single or double precision.
pub trait Position: Copy {
    /// The same position in double precision.
    fn to_double(self) -> DVec3;

    /// The slice, by its precision.
    fn slice(positions: &[Self]) -> Positions<'_>;

    /// The vector, by its precision.
    fn owned(positions: Vec<Self>) -> OwnedPositions;
}

/// A slice of vertices in either precision.
#[derive(Clone, Copy, Debug)]
pub enum Positions<'a> {
    /// Single precision, as in most binary files.
    Single(&'a [Vec3]),
    /// Double precision, as in ASCII files.
    Double(&'a [DVec3]),
}

/// Owned vertices in either precision.
#[derive(Clone, Debug)]
pub enum OwnedPositions {
    /// Single precision, as in most binary files.
    Single(Vec<Vec3>),
    /// Double precision, as in ASCII files.
    Double(Vec<DVec3>),
}

impl OwnedPositions {
    /// Number of vertices.
    pub(crate) fn len(&self) -> usize {
        match self {
            OwnedPositions::Single(positions) => positions.len(),
            OwnedPositions::Double(positions) => positions.len(),
        }
    }

    /// A vertex in double precision.
    pub(crate) fn get(&self, vertex: usize) -> DVec3 {
        match self {
            OwnedPositions::Single(positions) => positions[vertex].as_dvec3(),
            OwnedPositions::Double(positions) => positions[vertex],
        }
    }
}

impl Position for Vec3 {
    fn to_double(self) -> DVec3 {
        self.as_dvec3()
    }

    fn slice(positions: &[Vec3]) -> Positions<'_> {
        Positions::Single(positions)
    }

    fn owned(positions: Vec<Vec3>) -> OwnedPositions {
        OwnedPositions::Single(positions)
    }
}

impl Position for DVec3 {
    fn to_double(self) -> DVec3 {
        self
    }

    fn slice(positions: &[DVec3]) -> Positions<'_> {
        Positions::Double(positions)
    }

    fn owned(positions: Vec<DVec3>) -> OwnedPositions {
        OwnedPositions::Double(positions)
    }
}
