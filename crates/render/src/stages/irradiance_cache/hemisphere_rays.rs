//! The rays of records, one in each part of the hemisphere. Twin: `rays.cuh`.

use std::f32::consts::PI;

use glam::Vec2;

use crate::footprint::Cone;
use crate::sampling::random_bits;

/// The rays of one record: `side`² directions, one in each part of the hemisphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct HemisphereRays {
    side: u32,
}

impl HemisphereRays {
    pub(super) const fn new(side: u32) -> HemisphereRays {
        HemisphereRays { side }
    }

    /// The side of the square that they form.
    pub(super) fn side(self) -> u32 {
        self.side
    }

    /// Number of rays.
    pub(super) fn len(self) -> usize {
        (self.side * self.side) as usize
    }

    /// The cone around each ray: together they fill the hemisphere.
    pub(super) fn cone(self) -> Cone {
        Cone { width: 0.0, spread: (2.0 * PI).sqrt() / self.side as f32 }
    }

    /// Where ray number `index` lies in the square [−1, 1]².
    pub(super) fn place(self, seed: u64, index: u32) -> Vec2 {
        let random = random_bits(seed, u64::from(index), self.side as usize);
        let place = |part: u32, bits: u32| {
            let within = (bits >> 8) as f32 * (1.0 / (1 << 24) as f32);
            2.0 * (part as f32 + within) / self.side as f32 - 1.0
        };
        let (column, row) = (index % self.side, index / self.side);
        Vec2::new(place(column, random as u32), place(row, (random >> 32) as u32))
    }
}

/// The rays of both kinds of records.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RecordRays {
    /// Those of coarse records, and of points that see none: at first, and where these see different things.
    pub(super) coarse: [HemisphereRays; 2],
    /// Those of fine records.
    pub(super) fine: HemisphereRays,
}
