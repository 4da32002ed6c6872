//! Numbers that host and device must agree on: a `#define` for each in the header.

macro_rules! constants {
    ($($(#[doc = $doc:literal])* $name:ident = $value:expr;)*) => {
        $($(#[doc = $doc])* pub const $name: u32 = $value;)*

        /// All of them by name.
        pub(crate) const ALL: &[(&str, u32)] = &[$((stringify!($name), $name)),*];
    };
}

constants! {
    /// Threads of the blocks that take one ray, one light point or one slot a thread.
    BLOCK = 256;
    /// Values that a thread of a prefix sum takes.
    VALUES_OF_THREAD = 4;
    /// Entries of the stack of a walk through the BVH: the most levels that it may have.
    BVH_STACK = 64;
    /// Bits of a brick's key for each axis.
    AXIS_BITS = 19;
    /// Points of a light that decide how much of it stands above the horizon.
    HORIZON_SAMPLES = 64;
    /// Points of a light with a size from which its unshadowed light is computed.
    LIGHT_TARGETS = 16;
    /// Rays whose object points one block groups by cell: 32 x 32 pixels, or so many of a list.
    TILE = 1024;
    /// Tangent planes of an item's object points that short tests tell apart.
    TANGENT_PLANES = 4;
    /// Words of a candidate of the short tests by cell, a triangle that can matter.
    CANDIDATE_WORDS = 24;
    /// Candidates of one round.
    CANDIDATES = 32;
    /// Pairs of a candidate and a light point that are tested in one go.
    LISTED_TARGETS = 64;
    /// Words of such a pair.
    TARGET_WORDS = 4;
    /// Triangles found and not yet looked at: fewer than 32, and at most 96 that one round of the search adds.
    FOUND_TRIANGLES = 128;
    /// Entries of the search's stack up to which a round takes four nodes.
    STACK_OF_ROUNDS = 64;
    /// Entries kept beyond those for each level of the tree.
    STACK_PER_LEVEL = 7;
    /// Warps of a block that interpolates, an item each.
    ITEM_WARPS = 4;
    /// Lights without a size that are interpolated at once, at most.
    MOST_LIGHTS = 3;
}
