//! Groups of lights: what surface points see is held for a group at a time, so that memory does not grow with the number of lights.
//!
//! A wave has the group of four lights that its shadow stages work on, shading adds it to each ray's sum, and its memory serves the next group. The
//! light's terms are added in the same order as without groups, so that the bits are the same. Except for the half-ball, whose light points keep
//! the visibility of all lights, memory thus does not grow with their number: occluder lists take at most 32 bytes per pixel. Layers, and visibility
//! at given points, are for all lights.

use std::ops::Range;

/// Consecutive lights of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LightGroup {
    first: usize,
    end: usize,
}

impl LightGroup {
    /// All lights.
    pub const ALL: LightGroup = LightGroup { first: 0, end: usize::MAX };

    /// Their numbers in a scene of `lights` lights.
    pub fn of(self, lights: usize) -> Range<usize> {
        self.first..self.end.min(lights)
    }
}

impl From<Range<usize>> for LightGroup {
    fn from(Range { start, end }: Range<usize>) -> LightGroup {
        LightGroup { first: start, end }
    }
}

/// All lights of a scene, `at_once` in a group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LightGroups {
    /// Number of lights.
    pub lights: usize,
    /// Number of lights in each group but the last; at least 1.
    pub at_once: usize,
}

impl LightGroups {
    /// The groups in order: an empty one if there are no lights.
    pub fn iter(self) -> impl ExactSizeIterator<Item = LightGroup> {
        let LightGroups { lights, at_once } = self;
        (0..lights.max(1)).step_by(at_once).map(move |first| LightGroup { first, end: lights.min(first + at_once) })
    }

    /// Number of lights of which shares are held.
    pub fn held(self) -> usize {
        self.lights.min(self.at_once)
    }
}
