//! The light mesh, and what is computed about it.

use crate::geometry::Vec3;
use crate::record::records;
use crate::{In, Out};

records! {
    /// The light mesh of one image.
    LightMesh {
        /// Position of light point (0, 0, 0).
        anchor: Vec3,
        /// h.
        step: f32,
        /// r, scene units.
        radius: f32,
        /// What (n, x − P) must exceed.
        least_height: f32,
        /// How near a triangle's plane may pass before it is edge-on.
        edge_on: f32,
        /// How much boxes grow before triangles are looked up.
        slack: f32,
        /// w of formula (3): one of [`LightMesh`]'s constants.
        weight: u32,
        /// Light points of the template.
        points: u32,
        /// 32-bit words of a mask.
        words: u32,
        /// Largest component of an offset.
        reach: i32,
        /// What it is numbered by on each axis: formula (7).
        number: [u32; 3],
        /// Lines of the template that have points.
        lines: u32,
        /// Offset of each template point from the cell: x, y and z, each plus [`MOST_REACH`](crate::constants::MOST_REACH), a byte
        /// each. For lanes that take a point each; a warp that takes them one by one has the rows in constant memory.
        offsets: In<u32>,
        /// The template's rows, packed: first bit, and number of points in the upper half. For lanes that take a row each.
        rows: In<u32>,
    }

    /// The points of the template on one line along x.
    TemplateRow {
        /// Bit of the first point.
        bit: u16,
        /// Number of points.
        count: u16,
        /// Offsets of the first one.
        x: i32,
        /// The line's y.
        y: i32,
        /// The line's z.
        z: i32,
    }

    /// Up to 32 surface points of one cell: the work of one warp.
    Item {
        /// Key of the cell.
        cell: u64,
        /// Where its surface points begin in the list of members.
        first: u32,
        /// How many there are.
        count: u32,
    }

    /// The set of bricks: open addressing with linear probing. The place of a brick's key is the brick's slot, which is the
    /// address of whatever is kept about the brick.
    BrickTable {
        /// Key + 1 of the brick in each slot; 0: none.
        keys: Out<u64>,
        /// Number of slots, a power of two.
        capacity: u32,
        /// For eight-byte size.
        spare: u32,
    }

    /// What the light points see of one light.
    LitBy {
        /// Seen or not, a word a slot of the table; null for an area light.
        bits: Out<u64>,
        /// Rays that reached an area light, by rank; null for one without.
        seen: Out<u16>,
    }

    /// What is kept about one light from image to image, by slot of a table that outlives them.
    KeptBy {
        /// Light points whose answer is known.
        known: Out<u64>,
        /// Seen or not; null for an area light.
        bits: Out<u64>,
        /// Rays that reached an area light, 64 numbers a slot; null for one without.
        seen: Out<u16>,
    }

    /// All that is known about the used light points.
    UsedPoints {
        /// The bricks that hold them.
        table: BrickTable,
        /// The used points of each slot.
        used: In<u64>,
        /// Number of used points in all slots before.
        rank: In<u32>,
        /// Every used point by rank: its slot · 64 + its bit.
        points: In<u64>,
    }
}
