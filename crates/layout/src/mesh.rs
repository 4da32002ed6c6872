//! The light mesh, and the results computed on it.

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
        /// The minimum of (n, x − P).
        least_height: f32,
        /// How close a triangle's plane may pass before it counts as edge-on.
        edge_on: f32,
        /// How much boxes are enlarged before triangles are looked up.
        slack: f32,
        /// w of formula (3): one of [`LightMesh`]'s constants.
        weight: u32,
        /// Light points of the template.
        points: u32,
        /// 32-bit words of a mask.
        words: u32,
        /// Largest component of an offset.
        reach: i32,
        /// The number of its first point on each axis: formula (7).
        number: [u32; 3],
        /// Lines of the template that have points.
        lines: u32,
        /// Offset of each template point from the cell: x, y and z, each plus [`MAX_REACH`](crate::constants::MAX_REACH), one
        /// byte each. For lanes that take one point each; a warp that takes points one by one uses the rows in constant memory.
        offsets: In<u32>,
        /// The template's rows, packed: first bit, and number of points in the upper half. For lanes that take one row each.
        rows: In<u32>,
    }

    /// The points of the template on one line along x.
    TemplateRow {
        /// Bit of the first point.
        bit: u16,
        /// Number of points.
        count: u16,
        /// The x offset of the first point.
        x: i32,
        /// The line's y.
        y: i32,
        /// The line's z.
        z: i32,
    }

    /// Up to 32 surface points of one cell: the work of one warp.
    Bundle {
        /// Key of the cell.
        cell: u64,
        /// The index of its first surface point in the list of members.
        first: u32,
        /// Their number.
        count: u32,
    }

    /// The set of bricks: open addressing with linear probing. The position of a brick's key is the brick's slot, which is the
    /// index of all data about the brick.
    BrickTable {
        /// Key + 1 of the brick in each slot; 0 if the slot is empty.
        keys: Out<u64>,
        /// Number of slots, a power of two.
        capacity: u32,
        /// Padding to a multiple of eight bytes.
        spare: u32,
    }

    /// The visibility of one light at the light points.
    VisibilityOfLight {
        /// Lit or not, one word per slot of the table; null for an area light.
        bits: Out<u64>,
        /// Rays that reached an area light, by rank; null for a light without an area.
        seen: Out<u16>,
    }

    /// The cached values for one light, by slot of a table that outlives images.
    KeptBy {
        /// Light points whose value is known.
        known: Out<u64>,
        /// Lit or not; null for an area light.
        bits: Out<u64>,
        /// Rays that reached an area light, 64 counts per slot; null for a light without an area.
        seen: Out<u16>,
    }

    /// Everything about the used light points.
    UsedPoints {
        /// The bricks that contain them.
        table: BrickTable,
        /// The used points of each slot.
        used: In<u64>,
        /// Number of used points in all preceding slots.
        rank: In<u32>,
        /// Every used point by rank: its slot · 64 + its bit.
        points: In<u64>,
    }
}
