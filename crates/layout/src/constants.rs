//! Numbers that host and device must agree on, each declared once: a constant here, a `#define` in the header. Those that belong to
//! a record are its associated constants, in `codes.rs`.
//!
//! Numbers used on one side only are declared where they are used.

use crate::literal::Constant;

macro_rules! constants {
    ($($(#[doc = $doc:literal])* $name:ident: $type:ty = $value:expr;)*) => {
        $($(#[doc = $doc])* pub const $name: $type = $value;)*

        /// All constants that belong to no record.
        pub(crate) fn all() -> Vec<Constant> {
            vec![$(Constant::new(stringify!($name), &[$($doc),*], $name)),*]
        }
    };
}

constants! {
    // Launches.

    /// Threads of a warp, and the maximum number of surface points of a bundle.
    WARP: u32 = 32;
    /// Edge of the square of pixels that a block processes, one per thread.
    BLOCK_SIDE: u32 = 16;
    /// Threads per block in kernels with one ray, one light point or one slot per thread.
    BLOCK: u32 = BLOCK_SIDE * BLOCK_SIDE;
    /// Edge of the square of pixels whose surface points one block groups by cell.
    TILE_SIDE: u32 = 32;
    /// Rays of such a tile, or of a list, that one block groups.
    TILE: u32 = TILE_SIDE * TILE_SIDE;
    /// Parts of the unit interval at whose ends the inverse of a pixel filter's cumulative distribution is tabulated.
    FILTER_STEPS: u32 = 63;
    /// Number of these ends.
    FILTER_PLACES: u32 = FILTER_STEPS + 1;
    /// Stands for a light in the random pattern of a pixel's samples.
    PIXEL_PATTERN: u32 = 0x7fff_ffff;
    /// Samples of a pixel at most if any are shaded together.
    MAX_SHARED: u32 = 32;
    /// A pixel's samples and its centre lie on one surface.
    PIXEL_SHARED: u32 = 1;
    /// The same, but neighbours differ so much that each sample is shaded by itself.
    PIXEL_SPLIT: u32 = 2;
    /// Samples lie on one surface if the cosine between their normals is at least this: less than 2.6 degrees. Then light at 45 degrees
    /// differs by less than 5 %.
    SAME_COSINE: f32 = 0.999;
    /// The same for the geometric normals of triangles that share smooth ones.
    SAME_FACET_COSINE: f32 = 0.8;
    /// And if neither is farther from the other's tangent plane than this part of a pixel's width.
    SAME_HEIGHT: f32 = 0.5;
    /// The same for neighbouring pixels.
    NEAR_HEIGHT: f32 = 2.0;
    /// Neighbouring pixels are compared if the cosine between their normals is at least this.
    NEAR_COSINE: f32 = 0.9;
    /// Differences between neighbouring pixels are relative to the brighter one and this radiance: darker ones are hardly seen.
    CONTRAST_FLOOR: f32 = 0.2;
    /// Rows above and below a band with which its pixels are compared.
    MARGIN_ROWS: u32 = 1;
    /// Pixels outside of the image are numbered by rows of 2 to this power,
    OUTSIDE_BITS: u32 = 16;
    /// with this number where the image begins: those of the image are smaller.
    OUTSIDE: u32 = 1 << 31;
    /// Values per thread of a prefix sum.
    VALUES_OF_THREAD: u32 = 4;

    // Numbers from Rust's standard library; kernels have no headers for them.

    /// The largest number of single precision.
    F32_MAX: f32 = f32::MAX;
    /// The smallest positive number of single precision that has all its digits.
    F32_MIN_POSITIVE: f32 = f32::MIN_POSITIVE;
    /// The largest number of double precision.
    F64_MAX: f64 = f64::MAX;
    /// The bits of infinity in single precision.
    F32_INFINITY_BITS: u32 = f32::INFINITY.to_bits();
    /// 2 π.
    TAU: f32 = std::f32::consts::TAU;
    /// Half a turn.
    PI: f32 = std::f32::consts::PI;
    /// 1 / π.
    FRAC_1_PI: f32 = std::f32::consts::FRAC_1_PI;
    /// π/2.
    FRAC_PI_2: f32 = std::f32::consts::FRAC_PI_2;
    /// The largest relative error of one operation in single precision, 2^-24.
    UNIT_ROUNDOFF: f32 = 0.5 * f32::EPSILON;

    // Rays and acceleration structures.

    /// Ray origins farther than this many radii from the centre of the triangles are moved closer.
    REACH: f32 = 8.0;
    /// Directions whose largest component exceeds this value, 2^40, or is below its reciprocal are scaled.
    LARGEST_DIRECTION: f32 = (1u64 << 40) as f32;
    /// Direction components below this share of the largest, 2^-30, count as such a share or as zero.
    MIN_COMPONENT: f32 = 1.0 / (1u32 << 30) as f32;
    /// Relative margin of tests against the boxes of a BVH, 2^-19; derived in bvh/walk.rs.
    BVH_MARGIN: f32 = 1.0 / (1u32 << 19) as f32;
    /// Relative margin by which boxes of shapes in many places are enlarged, 2^-18; derived in accel/instanced.rs.
    INSTANCE_MARGIN: f32 = 1.0 / (1u32 << 18) as f32;
    /// The index of the first triangle of the first instance: those below are stored.
    FIRST_INSTANCED: u32 = 1 << 31;
    /// Rounding margin of tests of a box against a region, 2^-20 or 16 units of roundoff; derived in accel/region/.
    REGION_ROUNDING: f32 = 16.0 * UNIT_ROUNDOFF;
    /// Stack entries of a traversal of the BVH: the maximum number of its levels.
    BVH_STACK: u32 = 64;
    /// In the word of a traversal's hits in a node, the first bit of a child that is a node.
    FIRST_INNER: u32 = 24;
    /// All bits of children that are nodes.
    INNER_HITS: u32 = u32::MAX << FIRST_INNER;
    /// All bits of triangles in children that are leaves.
    TRIANGLE_HITS: u32 = !INNER_HITS;
    /// The hits with which a traversal begins: the root as the only child, in the slot that is entered first.
    ROOT_HIT: u32 = 1 << 31;

    // Surfaces.

    /// Bound on the relative error of a chain of 32 operations (Higham's gamma).
    GAMMA_32: f32 = 32.0 * UNIT_ROUNDOFF / (1.0 - 32.0 * UNIT_ROUNDOFF);
    /// The tangent of a sixteenth of a turn: above, the polynomial below takes the difference from an eighth.
    TANGENT_OF_EIGHTH: f32 = 0.414_213_56;
    /// An eighth of a turn.
    EIGHTH_OF_TURN: f32 = 0.125;
    /// Coefficients of the polynomial for the arc tangent up to there, within 2^-22, from the highest power (Cephes, Moshier 1992).
    ARC_TANGENT_9: f32 = 8.053_744_5e-2;
    /// See above.
    ARC_TANGENT_7: f32 = -1.387_768_6e-1;
    /// See above.
    ARC_TANGENT_5: f32 = 1.997_771_1e-1;
    /// See above.
    ARC_TANGENT_3: f32 = -3.333_295e-1;
    /// A radian in turns.
    TURN_OF_RADIAN: f32 = 0.159_154_94;
    /// The natural logarithm of 2.
    LN_2: f32 = std::f32::consts::LN_2;
    /// The bits of √½, where mantissas that logarithms are computed from start.
    ROOT_OF_HALF_BITS: u32 = 0x3f35_04f3;
    /// If the square of twice its area is below this, a triangle's normal has lost its bits to underflow.
    MIN_SQUARE: f32 = 1e-30;
    /// If the square of its length is below this, an interpolated normal has cancelled out.
    MIN_SMOOTH_SQUARE: f32 = 1e-12;
    /// The code of 0 in an image of normals.
    NORMAL_CODE_ZERO: f32 = 128.0;
    /// By how much that of 1 is larger.
    NORMAL_CODE_ONE: f32 = 127.0;
    /// What surfaces with images of normals mirror goes at least at this cosine from the geometric normal, or half as far from the surface as the
    /// view.
    MIN_MIRRORED_COSINE: f32 = 0.01;
    /// The ellipse in which a cone meets a surface is longer than wide by at most the reciprocal of this cosine.
    MIN_FOOTPRINT_COSINE: f32 = 1e-6;
    /// Lookups along the major axis of a footprint in a texture, at most.
    MAX_PROBES: u32 = 16;
    /// Bits of a channel of a texel below the image itself.
    TEXEL_BITS: u32 = 21;
    /// White in such a channel.
    TEXEL_ONE: f32 = (1u32 << (TEXEL_BITS - 1)) as f32;
    /// Places of the table of what facets reflect, along each axis.
    FACET_PLACES: u32 = 32;
    /// The least width of their lobes: smoother ones are points in single precision.
    MIN_FACET_WIDTH: f32 = 0.002;
    /// The least cosine at which they are seen.
    MIN_VIEW_COSINE: f32 = 1e-3;
    /// The least cosine at which the width of a ray on a light is told,
    MIN_SEEN_COSINE: f32 = 0.01;
    /// and at which lights that shine evenly become brighter.
    MIN_SHINING_COSINE: f32 = 0.1;
    /// A light is in front of a surface as far away, by rounding and by a hair: lamps lie in ceilings.
    SAME_DISTANCE: f32 = 1.0 + 1.0 / 16384.0;
    /// Up to this roughness, mirror rays show all that facets reflect,
    MIRROR_FADES: f32 = 0.5;
    /// and from here on nothing.
    MIRROR_ENDS: f32 = 0.6;
    /// Up to this roughness, they show all of lights, too,
    LIGHTS_FADE: f32 = 0.05;
    /// and from here on nothing: highlights do, without noise.
    LIGHTS_END: f32 = 0.17;
    /// That is counted in so many parts, which fit into the bits of a ray,
    PARTS_OF_FADE: u32 = 15;
    /// above the surfaces that it went through.
    FADE_SHIFT: u32 = 28;
    /// The angle of the cone that all mirror rays of facets stand for, in widths of their lobes: most of what they reflect comes from there.
    WIDTH_OF_LOBE: f32 = 3.0;
    /// A mirror ray of facets that shows all of a pixel is as many as that, in different directions, if the lobe is wide,
    MAX_DIRECTIONS: u32 = 8;
    /// as from this width on, the square of the roughness.
    WIDE_LOBE: f32 = 0.01;
    /// Cones of mirror rays are as narrow as if a pixel had that many at most.
    MAX_CONES: f32 = 64.0;
    /// The bit from which on a ray's number among them is in a list, above its sample.
    DIRECTION_SHIFT: u32 = 17;
    /// Stands for a light in the random pattern of the directions of a pixel's mirror rays.
    LOBE_PATTERN: u32 = 0x7fff_fffe;
    /// Those of a square of so many pixels along each side are one pattern.
    LOBE_TILE: u32 = 256;
    /// Half of the part of a light that one of its points stands for, as a share of its size.
    PART_OF_LIGHT: f32 = 0.35;
    /// Share of each channel in the brightness of a colour (ITU-R BT.709-6, item 3.2).
    LUMINANCE_RED: f32 = 0.2126;
    /// Of green.
    LUMINANCE_GREEN: f32 = 0.7152;
    /// Of blue.
    LUMINANCE_BLUE: f32 = 0.0722;
    /// Vertex normals farther from the triangle's than this cosine says, 45°, do not tell a curved surface.
    MIN_CURVED_COSINE: f32 = 0.707;
    /// How far the curved surface is from the triangle, as a share of the way to the planes that touch it at the corners (Boubekeur
    /// and Alexa: *Phong Tessellation*, SIGGRAPH Asia 2008).
    SHAPE_FACTOR: f32 = 0.75;
    /// The sine of the height over a triangle, 6°, below which a light is looked for from the curved surface.
    LOW_LIGHT: f32 = 0.1;

    // Light points.

    /// Bits of a brick's key for each axis.
    AXIS_BITS: u32 = 19;
    /// Bits of a light point's index along an axis that give its position in its brick: bricks have 4 x 4 x 4 points.
    BRICK_BITS: u32 = 2;
    /// Bits of a light point's index along an axis.
    INDEX_BITS: u32 = AXIS_BITS + BRICK_BITS;
    /// Added to indices, so that keys are unsigned.
    INDEX_BIAS: i32 = 1 << (INDEX_BITS - 1);
    /// Bits of a light point's number within its brick.
    POINT_BITS: u32 = 3 * BRICK_BITS;
    /// The slot of a brick that is not in the table.
    NO_SLOT: u32 = u32::MAX;
    /// 2^64 over the golden ratio: multiplication by it spreads consecutive numbers far apart (Fibonacci hashing, SplitMix64).
    GOLDEN_RATIO: u64 = 0x9e37_79b9_7f4a_7c15;
    /// The reach of the template with the largest radius, in steps; added to offsets before they are packed.
    MAX_REACH: i32 = 16;
    /// Lines along x of that template.
    TEMPLATE_LINES: i32 = (2 * MAX_REACH) * (2 * MAX_REACH);

    // Rays.

    /// The opacity of a texel that hides everything, as texels count.
    OPAQUE: f32 = 255.0;
    /// The bit from which on the number of surfaces that a ray went through is in a list, above its sample.
    THROUGHS_SHIFT: u32 = 20;
    /// These bits, shifted down.
    THROUGHS_MASK: u32 = 0xff;
    /// 1/ln 2.
    LOG2_E: f32 = std::f32::consts::LOG2_E;
    /// ln 2 in two parts, the first of few digits.
    LN_2_HIGH: f32 = 0.693_359_4;
    /// ln 2 without that part.
    LN_2_LOW: f32 = -2.1219444e-4;
    /// exp(x) = 1 + x + EXP_2 x² + …, so 1/2.
    EXP_2: f32 = 0.5;
    /// 1/6.
    EXP_3: f32 = 0.16666667;
    /// 1/24.
    EXP_4: f32 = 0.041666668;
    /// 1/120.
    EXP_5: f32 = 0.008333334;
    /// 1/720.
    EXP_6: f32 = 0.0013888889;
    /// exp(−x) is 0 for larger x.
    LARGEST_EXPONENT: f32 = 87.0;
    /// A ray goes through so many surfaces.
    MAX_THROUGHS: u32 = 64;
    /// Where surfaces let rays through, a ray always goes on from this depth if at least this share of what it sees reaches the pixel; others are
    /// thinned.
    MIN_THICK_DEEP: f32 = 1.0 / 256.0;
    /// The same for rays that met fewer surfaces: what a single thing of glass shows is smooth, also of bright lamps.
    MIN_THICK: f32 = 1.0 / 4096.0;
    /// How many surfaces a ray met that counts as deep.
    DEEP: u32 = 6;
    /// Shares are counted in parts of that: so many bits.
    THIN_BITS: u32 = 16;
    /// Less is nothing: one of these parts.
    MIN_THIN: f32 = 1.0 / 16_777_216.0;
    /// By how much the offset of thinning differs between neighbours in a row, as a share of 2³²: 1/ρ, with ρ³ = ρ + 1.
    THIN_ACROSS: u32 = 0xc13f_a9a9;
    /// In a column: 1/ρ².
    THIN_DOWN: u32 = 0x91e1_0da5;
    /// From depth to depth: the golden ratio.
    THIN_DEEPER: u32 = 0x9e37_79b9;
    /// Of surfaces without diffuse reflection it is asked what transmissive surfaces leave of a light if its highlight is at least that much of a pixel.
    MIN_SHOWN: f32 = 1.0 / 262_144.0;
    /// So many hits of a shadow ray are found at once.
    HITS_AT_ONCE: u32 = 16;
    /// The least cosine at which a shadow ray counts as meeting a pane.
    MIN_STEEPNESS: f32 = 1.0 / 64.0;
    /// Where all surfaces are opaque, a ray goes on at a surface, mirrored, if at least this share of the radiance that it sees reaches the pixel: less changes
    /// no code of an image.
    MIN_ONWARD: f32 = 1.0 / 4096.0;
    /// Surface points of which a small share reaches the pixel follow fewer samples of lights through transmissive surfaces: levels of that.
    TRANSMITTANCE_LEVELS: u32 = 3;
    /// Each level takes this part of the samples of the one before, where at most this part of its share reaches the pixel.
    PART_OF_LEVEL: f32 = 1.0 / 4.0;
    /// So many of its bits.
    LEVEL_SHIFT: u32 = 2;
    /// More samples are not followed at levels beyond the first: one set of rows has them.
    MAX_OF_LEVEL: u32 = 64;
    /// Surfaces that mirror this share at most are faint mirrors: half of a pixel's samples show what is in them.
    FAINT_MIRROR: f32 = 1.0 / 8.0;
    /// Mirror rays of a pixel that meet one surface are one if at most this share of what it mirrors reaches the pixel.
    MAX_MERGED: f32 = 1.0 / 32.0;

    // Lights.

    /// Sample points of a light that determine its share above the horizon.
    HORIZON_SAMPLES: u32 = 64;
    /// Points of an area light from which its unshadowed light is computed.
    LIGHT_TARGETS: u32 = 16;
    /// The height of the strip of an area light for which one of these points stands, relative to that of all of them.
    STRIP_OF_TARGET: f32 = 0.125;
    /// Directional lights of a disc larger than this, at distance 1, are wide: the tangent of 1.5°. Up to there, the mean of a few points of the
    /// disc is within 2e-4 of the light of the whole.
    WIDE_SUN: f32 = 0.026_18;
    /// A light is near in part from here on, as its size over its distance: up to there, the mean of a few of its points is within 0.003.
    NEAR_LIGHT: f32 = 0.125;
    /// Surface points that are nearer to an emissive ball than this share of their distance from its centre see it from there.
    BEFORE_BODY: f32 = 1.0 / 1024.0;
    /// More than the square root of 2: no ray to an emissive ball ends farther from its centre, in radii.
    ASIDE_OF_BODY: f32 = 1.4143;
    /// Corners of a polygon that represents a disc.
    DISC_CORNERS: u32 = 32;
    /// The cosine of the angle between two of them,
    CORNER_COSINE: f32 = 0.980_785_3;
    /// its sine,
    CORNER_SINE: f32 = 0.195_090_32;
    /// and their distance from the centre, for the area of the disc.
    CORNER_RADIUS: f32 = 1.003_222_1;
    /// First factor of the finaliser of SplitMix64 (Steele, Lea, Flood 2014).
    MIX_1: u64 = 0xbf58_476d_1ce4_e5b9;
    /// Second factor.
    MIX_2: u64 = 0x94d0_49bb_1331_11eb;
    /// The upper byte of each pair.
    UPPER_BYTES: u32 = 0xff00_ff00;
    /// The upper half of each byte.
    UPPER_NIBBLES: u32 = 0xf0f0_f0f0;
    /// The upper pair of each four bits.
    UPPER_PAIRS: u32 = 0xcccc_cccc;
    /// The upper bit of each pair.
    UPPER_BITS: u32 = 0xaaaa_aaaa;
    /// First factor of Owen scrambling (Laine and Karras 2011, factors of Burley's paper, JCGT 2020).
    OWEN_1: u32 = 0x6c50_b47c;
    /// Second factor.
    OWEN_2: u32 = 0xb82f_1e52;
    /// Third factor.
    OWEN_3: u32 = 0xc7af_e638;
    /// Last factor.
    OWEN_4: u32 = 0x8d22_f6e6;
    /// Binary digits of a sample's coordinate: those of a float's mantissa.
    SAMPLE_DIGITS: u32 = f32::MANTISSA_DIGITS;
    /// The value of the last of these digits.
    LAST_DIGIT: f32 = 1.0 / (1u32 << SAMPLE_DIGITS) as f32;

    // Rows of samples.

    /// Maximum number of rows of samples that are tested at once.
    MAX_ROWS: u32 = 20;
    /// Maximum number of words of their bits.
    MAX_WORDS: u32 = 10;
    /// Maximum number of samples in a row, so that its bits are an exact difference of powers of two in 32 bits.
    MAX_OF_ROW: u32 = 30;
    /// Edge functions below this in size, along a row, count as constant.
    MIN_SLOPE: f32 = 1e-25;
    /// Far outside of every emitter: the bound of a row without an edge on that side.
    UNBOUNDED: f32 = 1e30;
    /// Number of places by which samples are shifted along their rows: sums of a few shifts are exact.
    SHIFT_STEPS: f32 = (1u32 << 16) as f32;
    /// By how much the boxes of surface points and emitters are enlarged before bounds are derived from them.
    ENLARGEMENT: f32 = 1.0 + 1e-5;
    /// Least width in pixels of the cells by which surface points are grouped.
    CELL_PIXELS: f32 = 32.0;
    /// The exponent's last bit in single precision.
    F32_EXPONENT_STEP: u32 = 1 << (f32::MANTISSA_DIGITS - 1);
    /// The exponent of numbers from 1 to 2 in single precision.
    F32_EXPONENT_BIAS: u32 = f32::MAX_EXP as u32 - 1;
    /// The largest hash of a cell.
    LAST_HASH: u32 = 0xfffe;
    /// Parts of four words of a candidate that may hide a light: three corners with the normal.
    OCCLUDER_PARTS: u32 = 3;
    /// Words that describe where such candidates are searched for.
    SEARCHED_WORDS: u32 = 64;
    /// Words of the rows of samples in shared memory, of one shape: four a row, and the end of each word's rows.
    ROW_TABLE_WORDS: u32 = 4 * MAX_ROWS + 12;
    /// The margin of searches for what may hide a light, 2^-16 of the size of the searched space.
    SHADOW_MARGIN: f32 = 1.0 / (1u32 << 16) as f32;

    // Adaptive shadow rays.

    /// Pixels on each side of a pixel that belong to its neighbourhood.
    AROUND: u32 = 2;
    /// Edge of a neighbourhood.
    NEIGHBORHOOD: u32 = 2 * AROUND + 1;
    /// Pixels of a neighbourhood, and points of a light that their first rays are cast to.
    FIRST_TARGETS: u32 = NEIGHBORHOOD * NEIGHBORHOOD;
    /// Answer of a surface point's first ray: it arrives.
    ANSWER_LIT: u32 = 1;
    /// It does not arrive.
    ANSWER_DARK: u32 = 2;
    /// Both.
    ANSWER_BOTH: u32 = ANSWER_LIT | ANSWER_DARK;
    /// Added to the answer: the light is partly behind the surface.
    ANSWER_STRADDLES: u32 = 4;

    // Searches by region.

    /// Maximum number of tangent planes that a region distinguishes.
    TANGENT_PLANES: u32 = 4;
    /// Words of a region's tangent planes in shared memory.
    PLANE_WORDS: u32 = 5 * TANGENT_PLANES;
    /// Words of a shaft's faces in shared memory, a multiple of four.
    SHAFT_WORDS: u32 = 20;
    /// Number of entries of a search's node stack up to which a round takes four nodes.
    STACK_OF_ROUNDS: u32 = 64;
    /// Additional stack entries per level of the tree.
    STACK_PER_LEVEL: u32 = 7;
    /// The same as `STACK_OF_ROUNDS` for a search that enters instances.
    STACK_OF_INSTANCES: u32 = 128;
    /// Number of instances that a node's leaves hold at most.
    MAX_HELD: u32 = 24;
    /// Maximum number of boxes from which the searches of a tile's bundles start.
    MAX_SEARCH_ROOTS: u32 = 48;
    /// Marks a box that is a leaf.
    LEAF_START: u32 = 1 << 31;
    /// The number of such boxes that means "start at the root".
    FROM_ROOT: u32 = u32::MAX;
    /// Maximum number of recently found triangles that a search through a grid remembers.
    RECENT_TRIANGLES: u32 = 512;
    /// Words that describe the part of a grid that is searched.
    GRID_FRAME_WORDS: u32 = 20;
    /// Triangles found but not yet processed: fewer than 32, and at most 96 that one round of a search adds.
    FOUND_TRIANGLES: u32 = 128;

    // Short tests.

    /// Words of a candidate of the short tests by cell, a triangle that can matter.
    CANDIDATE_WORDS: u32 = 24;
    /// Candidates of one round.
    CANDIDATES: u32 = 32;
    /// Pairs of a candidate and a light point that are tested in one go.
    LISTED_TARGETS: u32 = 64;
    /// Words of such a pair.
    TARGET_WORDS: u32 = 4;

    // Interpolation.

    /// Warps of a block that marks light points or interpolates, a bundle each.
    BUNDLE_WARPS: u32 = 4;
    /// Maximum number of lights without an area that are interpolated at once.
    MAX_LIGHTS: u32 = 3;

    // Gathered light.

    /// Surface cells are offset from round coordinates, on which floors and walls tend to lie, by this fraction of their size, along x.
    CELL_OFFSET_X: f32 = 0.137;
    /// The same along y.
    CELL_OFFSET_Y: f32 = 0.241;
    /// The same along z.
    CELL_OFFSET_Z: f32 = 0.319;
    /// Bits of a surface cell's index along an axis; it repeats beyond.
    CELL_INDEX_BITS: u32 = 17;
    /// Added to a level so that it is positive, with seven bits.
    LEVEL_BIAS: i32 = 64;
    /// The level of all widths that are smaller. Levels of cells differ from those of widths by a few.
    MIN_LEVEL: i32 = -60;
    /// The level of all widths that are larger.
    MAX_LEVEL: i32 = 58;
    /// Kinds of surfaces in a cell, by their normal: the largest component of three, its sign, and whether it is the triangle's front.
    SURFACE_KINDS: u32 = 12;
    /// How far records move away from edges, in cells.
    RECORD_INWARDS: f32 = 0.0625;
    /// Records lie in the cube around their cell's middle with this half edge, in cells: half a cell, and more since they move inwards from edges.
    RECORD_MARGIN: f32 = 0.625;
    /// A record is open if nothing is above it within this distance, in cells: as far as layers in a cell may be from each other. With half of it,
    /// the ground below a floor would take the cell's only record from the floor.
    RECORD_OPEN: f32 = 1.0;
    /// The same for records that rays of others hit, of which smaller cells may have better ones.
    NODE_OPEN: f32 = 0.25;
    /// How many points of a kind are looked at for an open one.
    RECORD_CANDIDATES: u32 = 4;
    /// The distance within which records count, in cells.
    RECORD_RADIUS: f32 = 1.5;
    /// The cells around one, and itself, in which they are: the ball around a place ends two cells away, at most.
    CELLS_AROUND: u32 = 5 * 5 * 5;
    /// The distance from each other's tangent planes within which they count, in cells.
    RECORD_THICKNESS: f32 = 0.75;
    /// The cosine of the angle between normals beyond which they do not.
    RECORD_COSINE: f32 = 0.75;
    /// Records that are nearly in line do not tell how light changes beside it: the product of the variances, relative to the square of their
    /// sum.
    MIN_SPREAD: f32 = 0.02;
    /// Segments to records begin and end above the surface by this share of their length, so that gentle curves do not hide them.
    RECORD_RAISED: f32 = 0.15;
    /// They rise no farther than this share of the way to what is above.
    RECORD_STEP: f32 = 0.5;
    /// They rise no more slowly than by this cosine, unless something is in the way.
    MIN_RISE: f32 = 0.3;
    /// Bins of directions along each side of the octahedron's square.
    BINS_PER_SIDE: u32 = 8;
    /// What tilts a surface changes light by the slope of the cosine, which has no bound at the horizon: smaller cosines count as this.
    MIN_TILT_COSINE: f32 = 0.2;
    /// Bins of all directions.
    BINS: u32 = BINS_PER_SIDE * BINS_PER_SIDE;
    /// By how many levels coarse cells are coarser than fine ones: they are four times as large.
    COARSER: i32 = 2;
    /// The last part of a level, from here to 2, becomes the next one.
    BLEND_FROM: f32 = 1.75;
    /// Near is what is not farther than this many coarse cells.
    NEAR_CELLS: f32 = 2.0;
    /// How far near rays reach, relative to what coarse records leave out as near. What is near to these may be farther away here, but only
    /// from some: with 1, light is too bright before walls, with 2 too dark.
    NEAR_REACH: f32 = 1.25;
    /// Records cast more rays if the luminance that the first ones see deviates by more than this from its mean, relative to it.
    EVEN: f32 = 0.45;
    /// This share of a record's second rays goes where its first ones see different things; the rest goes everywhere.
    GUIDED: f32 = 0.5;
    /// First rays along each side of a block of directions.
    GUIDE_BLOCK: u32 = 2;
    /// How many rays beside a block tell how different what is seen in it is.
    GUIDE_RING: u32 = 1;
    /// A record's first ray counts as much as this many of its second ones, which go where they are needed.
    FIRST_COUNT: f32 = 0.25;
    /// Near rays see a record's surroundings as crowded where the mean inverse distance of what they hit, times the size of the coarse cells, is more:
    /// then it asks coarse cells of half the size.
    CROWDED: f32 = 0.5;
    /// To ask cells that are smaller once more, that must be more than this many times as much.
    CROWDED_AGAIN: f32 = 4.0;
    /// Where it is more than this, as among leaves, smaller cells would not help either.
    HOPELESS: f32 = 3.0;
    /// By how many levels coarse cells may become smaller.
    CLOSER: u32 = 2;
    /// The cone of the surroundings that a ray sees is this share of its own: wider ones would look below the horizon.
    SKY_CONE: f32 = 0.25;
    /// What a ray hits is asked for light in a cell of this share of the distance.
    BOUNCE_SIZE: f32 = 0.2;
    /// If a record is hidden or covered, cells that are smaller by up to this many levels are asked, one after the other.
    BOUNCE_FINER: i32 = 2;
    /// The rays of a record that other rays hit form a square with this side.
    BOUNCE_SIDE: u32 = 8;
    /// What is so many times brighter than the mean of what a hemisphere of rays sees asks the smallest of these at once: around it, light changes fast.
    BRIGHT: f32 = 8.0;
    /// Where there are more lights, what a ray hits asks about so many of them, chosen by what they may give.
    CHOSEN_LIGHTS: u32 = 4;
    /// How often light is reflected before it reaches what a gather ray hits, at most, with the first time by a light's. After so many, a share of
    /// the twelfth power of what surfaces reflect is missing: 2 % in a closed room that reflects 0.7.
    ORDERS: u32 = 12;
    /// Where records that rays hit are looked for first, in cells around the middle of theirs; then twice as far, up to a whole cell.
    NODE_REACH: f32 = 0.125;
    /// A table in which a name is not found after this many places is too full.
    NAME_PROBES: u32 = 1024;
    /// Added to the number of names of such a table.
    FULL_TABLE: u32 = 1 << 31;
    /// No name, record or node.
    NO_NUMBER: u32 = u32::MAX;
}
