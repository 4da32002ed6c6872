//! How much a build does, and how deep a tree may become.

use lightmesh_layout::constants::BVH_STACK;

/// Most levels: of the binary tree without its leaves, and so of the wide one.
pub const LEVELS: usize = BVH_STACK as usize;

/// What a build does.
#[derive(Clone, Copy, Debug, Default)]
pub struct Work {
    /// Boxes that others are compared with.
    pub boxes: u64,
}
