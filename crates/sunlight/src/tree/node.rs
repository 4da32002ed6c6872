//! Nodes of the tree.

/// Children of a node.
pub(super) const WIDTH: usize = 8;
/// Marks a child that is a triangle.
pub(super) const LEAF: u32 = 1 << 31;
/// A child that is not there.
pub(super) const NONE: u32 = u32::MAX;
/// Single precision rounds coordinates by so much, relatively, and differences of two by twice that.
pub(super) const ROUNDING: f32 = 1.5e-7;

/// Eight boxes, and what is in them.
#[derive(Clone, Debug)]
pub(super) struct Node {
    pub(super) low: [[f32; WIDTH]; 3],
    pub(super) high: [[f32; WIDTH]; 3],
    /// A node, or a facet with the mark [`LEAF`].
    pub(super) child: [u32; WIDTH],
    /// The object that all in a box belongs to, else [`MANY`](crate::MANY).
    pub(super) object: [u32; WIDTH],
}
