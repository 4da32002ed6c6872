// Made from crates/layout by `cargo xtask kernels`; do not edit.
//
// What host and device share: constants and records.
#pragma once

// Threads of a warp, and the maximum number of surface points of a bundle.
#define WARP 32u
// Edge of the square of pixels that a block processes, one per thread.
#define BLOCK_SIDE 16u
// Threads per block in kernels with one ray, one light point or one slot per thread.
#define BLOCK 256u
// Edge of the square of pixels whose surface points one block groups by cell.
#define TILE_SIDE 32u
// Rays of such a tile, or of a list, that one block groups.
#define TILE 1024u
// Parts of the unit interval at whose ends the inverse of a pixel filter's cumulative distribution is tabulated.
#define FILTER_STEPS 63u
// Number of these ends.
#define FILTER_PLACES 64u
// Stands for a light in the random pattern of a pixel's samples.
#define PIXEL_PATTERN 0x7fffffffu
// Samples of a pixel at most if any are shaded together.
#define MAX_SHARED 32u
// A pixel's samples and its centre lie on one surface.
#define PIXEL_SHARED 1u
// The same, but neighbours differ so much that each sample is shaded by itself.
#define PIXEL_SPLIT 2u
// Samples lie on one surface if the cosine between their normals is at least this: less than 2.6 degrees. Then light at 45 degrees
// differs by less than 5 %.
#define SAME_COSINE 0x1.ff7ceep-1f
// The same for the geometric normals of triangles that share smooth ones.
#define SAME_FACET_COSINE 0x1.99999ap-1f
// And if neither is farther from the other's tangent plane than this part of a pixel's width.
#define SAME_HEIGHT 0x1p-1f
// The same for neighbouring pixels.
#define NEAR_HEIGHT 0x1p1f
// Neighbouring pixels are compared if the cosine between their normals is at least this.
#define NEAR_COSINE 0x1.ccccccp-1f
// Differences between neighbouring pixels are relative to the brighter one and this radiance: darker ones are hardly seen.
#define CONTRAST_FLOOR 0x1.99999ap-3f
// Rows above and below a band with which its pixels are compared.
#define MARGIN_ROWS 1u
// Pixels outside of the image are numbered by rows of 2 to this power,
#define OUTSIDE_BITS 16u
// with this number where the image begins: those of the image are smaller.
#define OUTSIDE 0x80000000u
// Values per thread of a prefix sum.
#define VALUES_OF_THREAD 4u
// The largest number of single precision.
#define F32_MAX 0x1.fffffep127f
// The smallest positive number of single precision that has all its digits.
#define F32_MIN_POSITIVE 0x1p-126f
// The largest number of double precision.
#define F64_MAX 0x1.fffffffffffffp1023
// The bits of infinity in single precision.
#define F32_INFINITY_BITS 0x7f800000u
// 2 π.
#define TAU 0x1.921fb6p2f
// Half a turn.
#define PI 0x1.921fb6p1f
// 1 / π.
#define FRAC_1_PI 0x1.45f306p-2f
// π/2.
#define FRAC_PI_2 0x1.921fb6p0f
// The largest relative error of one operation in single precision, 2^-24.
#define UNIT_ROUNDOFF 0x1p-24f
// Ray origins farther than this many radii from the centre of the triangles are moved closer.
#define REACH 0x1p3f
// Directions whose largest component exceeds this value, 2^40, or is below its reciprocal are scaled.
#define LARGEST_DIRECTION 0x1p40f
// Direction components below this share of the largest, 2^-30, count as such a share or as zero.
#define MIN_COMPONENT 0x1p-30f
// Relative margin of tests against the boxes of a BVH, 2^-19; derived in bvh/walk.rs.
#define BVH_MARGIN 0x1p-19f
// Relative margin by which boxes of shapes in many places are enlarged, 2^-18; derived in accel/instanced.rs.
#define INSTANCE_MARGIN 0x1p-18f
// The index of the first triangle of the first instance: those below are stored.
#define FIRST_INSTANCED 0x80000000u
// Rounding margin of tests of a box against a region, 2^-20 or 16 units of roundoff; derived in accel/region/.
#define REGION_ROUNDING 0x1p-20f
// Stack entries of a traversal of the BVH: the maximum number of its levels.
#define BVH_STACK 64u
// In the word of a traversal's hits in a node, the first bit of a child that is a node.
#define FIRST_INNER 24u
// All bits of children that are nodes.
#define INNER_HITS 0xff000000u
// All bits of triangles in children that are leaves.
#define TRIANGLE_HITS 0x00ffffffu
// The hits with which a traversal begins: the root as the only child, in the slot that is entered first.
#define ROOT_HIT 0x80000000u
// Bound on the relative error of a chain of 32 operations (Higham's gamma).
#define GAMMA_32 0x1.00002p-19f
// The tangent of a sixteenth of a turn: above, the polynomial below takes the difference from an eighth.
#define TANGENT_OF_EIGHTH 0x1.a8279ap-2f
// An eighth of a turn.
#define EIGHTH_OF_TURN 0x1p-3f
// Coefficients of the polynomial for the arc tangent up to there, within 2^-22, from the highest power (Cephes, Moshier 1992).
#define ARC_TANGENT_9 0x1.49e1a2p-4f
// See above.
#define ARC_TANGENT_7 -0x1.1c370ap-3f
// See above.
#define ARC_TANGENT_5 0x1.9924bep-3f
// See above.
#define ARC_TANGENT_3 -0x1.555454p-2f
// A radian in turns.
#define TURN_OF_RADIAN 0x1.45f306p-3f
// The natural logarithm of 2.
#define LN_2 0x1.62e43p-1f
// The bits of √½, where mantissas that logarithms are computed from start.
#define ROOT_OF_HALF_BITS 0x3f3504f3u
// If the square of twice its area is below this, a triangle's normal has lost its bits to underflow.
#define MIN_SQUARE 0x1.4484cp-100f
// If the square of its length is below this, an interpolated normal has cancelled out.
#define MIN_SMOOTH_SQUARE 0x1.197998p-40f
// The code of 0 in an image of normals.
#define NORMAL_CODE_ZERO 0x1p7f
// By how much that of 1 is larger.
#define NORMAL_CODE_ONE 0x1.fcp6f
// What surfaces with images of normals mirror goes at least at this cosine from the geometric normal, or half as far from the surface as the
// view.
#define MIN_MIRRORED_COSINE 0x1.47ae14p-7f
// The ellipse in which a cone meets a surface is longer than wide by at most the reciprocal of this cosine.
#define MIN_FOOTPRINT_COSINE 0x1.0c6f7ap-20f
// Lookups along the major axis of a footprint in a texture, at most.
#define MAX_PROBES 16u
// Bits of a channel of a texel below the image itself.
#define TEXEL_BITS 21u
// White in such a channel.
#define TEXEL_ONE 0x1p20f
// Places of the table of what facets reflect, along each axis.
#define FACET_PLACES 32u
// The least width of their lobes: smoother ones are points in single precision.
#define MIN_FACET_WIDTH 0x1.0624dep-9f
// The least cosine at which they are seen.
#define MIN_VIEW_COSINE 0x1.0624dep-10f
// The least cosine at which the width of a ray on a light is told,
#define MIN_SEEN_COSINE 0x1.47ae14p-7f
// and at which lights that shine evenly become brighter.
#define MIN_SHINING_COSINE 0x1.99999ap-4f
// A light is in front of a surface as far away, by rounding and by a hair: lamps lie in ceilings.
#define SAME_DISTANCE 0x1.0004p0f
// Up to this roughness, mirror rays show all that facets reflect,
#define MIRROR_FADES 0x1p-1f
// and from here on nothing.
#define MIRROR_ENDS 0x1.333334p-1f
// Up to this roughness, they show all of lights, too,
#define LIGHTS_FADE 0x1.99999ap-5f
// and from here on nothing: highlights do, without noise.
#define LIGHTS_END 0x1.5c28f6p-3f
// That is counted in so many parts, which fit into the bits of a ray,
#define PARTS_OF_FADE 15u
// above the surfaces that it went through.
#define FADE_SHIFT 28u
// The angle of the cone that all mirror rays of facets stand for, in widths of their lobes: most of what they reflect comes from there.
#define WIDTH_OF_LOBE 0x1.8p1f
// A mirror ray of facets that shows all of a pixel is as many as that, in different directions, if the lobe is wide,
#define MAX_DIRECTIONS 8u
// as from this width on, the square of the roughness.
#define WIDE_LOBE 0x1.47ae14p-7f
// Cones of mirror rays are as narrow as if a pixel had that many at most.
#define MAX_CONES 0x1p6f
// The bit from which on a ray's number among them is in a list, above its sample.
#define DIRECTION_SHIFT 17u
// Stands for a light in the random pattern of the directions of a pixel's mirror rays.
#define LOBE_PATTERN 0x7ffffffeu
// Those of a square of so many pixels along each side are one pattern.
#define LOBE_TILE 256u
// Half of the part of a light that one of its points stands for, as a share of its size.
#define PART_OF_LIGHT 0x1.666666p-2f
// Share of each channel in the brightness of a colour (ITU-R BT.709-6, item 3.2).
#define LUMINANCE_RED 0x1.b367ap-3f
// Of green.
#define LUMINANCE_GREEN 0x1.6e2eb2p-1f
// Of blue.
#define LUMINANCE_BLUE 0x1.27bb3p-4f
// Vertex normals farther from the triangle's than this cosine says, 45°, do not tell a curved surface.
#define MIN_CURVED_COSINE 0x1.69fbe8p-1f
// How far the curved surface is from the triangle, as a share of the way to the planes that touch it at the corners (Boubekeur
// and Alexa: *Phong Tessellation*, SIGGRAPH Asia 2008).
#define SHAPE_FACTOR 0x1.8p-1f
// The sine of the height over a triangle, 6°, below which a light is looked for from the curved surface.
#define LOW_LIGHT 0x1.99999ap-4f
// Bits of a brick's key for each axis.
#define AXIS_BITS 19u
// Bits of a light point's index along an axis that give its position in its brick: bricks have 4 x 4 x 4 points.
#define BRICK_BITS 2u
// Bits of a light point's index along an axis.
#define INDEX_BITS 21u
// Added to indices, so that keys are unsigned.
#define INDEX_BIAS 1048576
// Bits of a light point's number within its brick.
#define POINT_BITS 6u
// The slot of a brick that is not in the table.
#define NO_SLOT 0xffffffffu
// 2^64 over the golden ratio: multiplication by it spreads consecutive numbers far apart (Fibonacci hashing, SplitMix64).
#define GOLDEN_RATIO 0x9e3779b97f4a7c15ull
// The reach of the template with the largest radius, in steps; added to offsets before they are packed.
#define MAX_REACH 16
// Lines along x of that template.
#define TEMPLATE_LINES 1024
// The opacity of a texel that hides everything, as texels count.
#define OPAQUE 0x1.fep7f
// The bit from which on the number of surfaces that a ray went through is in a list, above its sample.
#define THROUGHS_SHIFT 20u
// These bits, shifted down.
#define THROUGHS_MASK 255u
// 1/ln 2.
#define LOG2_E 0x1.715476p0f
// ln 2 in two parts, the first of few digits.
#define LN_2_HIGH 0x1.63p-1f
// ln 2 without that part.
#define LN_2_LOW -0x1.bd0106p-13f
// exp(x) = 1 + x + EXP_2 x² + …, so 1/2.
#define EXP_2 0x1p-1f
// 1/6.
#define EXP_3 0x1.555556p-3f
// 1/24.
#define EXP_4 0x1.555556p-5f
// 1/120.
#define EXP_5 0x1.111112p-7f
// 1/720.
#define EXP_6 0x1.6c16c2p-10f
// exp(−x) is 0 for larger x.
#define LARGEST_EXPONENT 0x1.5cp6f
// A ray goes through so many surfaces.
#define MAX_THROUGHS 64u
// Where surfaces let rays through, a ray always goes on from this depth if at least this share of what it sees reaches the pixel; others are
// thinned.
#define MIN_THICK_DEEP 0x1p-8f
// The same for rays that met fewer surfaces: what a single thing of glass shows is smooth, also of bright lamps.
#define MIN_THICK 0x1p-12f
// How many surfaces a ray met that counts as deep.
#define DEEP 6u
// Shares are counted in parts of that: so many bits.
#define THIN_BITS 16u
// Less is nothing: one of these parts.
#define MIN_THIN 0x1p-24f
// By how much the offset of thinning differs between neighbours in a row, as a share of 2³²: 1/ρ, with ρ³ = ρ + 1.
#define THIN_ACROSS 0xc13fa9a9u
// In a column: 1/ρ².
#define THIN_DOWN 0x91e10da5u
// From depth to depth: the golden ratio.
#define THIN_DEEPER 0x9e3779b9u
// Of surfaces without diffuse reflection it is asked what transmissive surfaces leave of a light if its highlight is at least that much of a pixel.
#define MIN_SHOWN 0x1p-18f
// So many hits of a shadow ray are found at once.
#define HITS_AT_ONCE 16u
// The least cosine at which a shadow ray counts as meeting a pane.
#define MIN_STEEPNESS 0x1p-6f
// Where all surfaces are opaque, a ray goes on at a surface, mirrored, if at least this share of the radiance that it sees reaches the pixel: less changes
// no code of an image.
#define MIN_ONWARD 0x1p-12f
// Surface points of which a small share reaches the pixel follow fewer samples of lights through transmissive surfaces: levels of that.
#define TRANSMITTANCE_LEVELS 3u
// Each level takes this part of the samples of the one before, where at most this part of its share reaches the pixel.
#define PART_OF_LEVEL 0x1p-2f
// So many of its bits.
#define LEVEL_SHIFT 2u
// More samples are not followed at levels beyond the first: one set of rows has them.
#define MAX_OF_LEVEL 64u
// Surfaces that mirror this share at most are faint mirrors: half of a pixel's samples show what is in them.
#define FAINT_MIRROR 0x1p-3f
// Mirror rays of a pixel that meet one surface are one if at most this share of what it mirrors reaches the pixel.
#define MAX_MERGED 0x1p-5f
// Sample points of a light that determine its share above the horizon.
#define HORIZON_SAMPLES 64u
// Points of an area light from which its unshadowed light is computed.
#define LIGHT_TARGETS 16u
// The height of the strip of an area light for which one of these points stands, relative to that of all of them.
#define STRIP_OF_TARGET 0x1p-3f
// Directional lights of a disc larger than this, at distance 1, are wide: the tangent of 1.5°. Up to there, the mean of a few points of the
// disc is within 2e-4 of the light of the whole.
#define WIDE_SUN 0x1.aceeep-6f
// A light is near in part from here on, as its size over its distance: up to there, the mean of a few of its points is within 0.003.
#define NEAR_LIGHT 0x1p-3f
// Surface points that are nearer to an emissive ball than this share of their distance from its centre see it from there.
#define BEFORE_BODY 0x1p-10f
// More than the square root of 2: no ray to an emissive ball ends farther from its centre, in radii.
#define ASIDE_OF_BODY 0x1.6a0f9p0f
// Corners of a polygon that represents a disc.
#define DISC_CORNERS 32u
// The cosine of the angle between two of them,
#define CORNER_COSINE 0x1.f6297ep-1f
// its sine,
#define CORNER_SINE 0x1.8f8b84p-3f
// and their distance from the centre, for the area of the disc.
#define CORNER_RADIUS 0x1.00d32ap0f
// First factor of the finaliser of SplitMix64 (Steele, Lea, Flood 2014).
#define MIX_1 0xbf58476d1ce4e5b9ull
// Second factor.
#define MIX_2 0x94d049bb133111ebull
// The upper byte of each pair.
#define UPPER_BYTES 0xff00ff00u
// The upper half of each byte.
#define UPPER_NIBBLES 0xf0f0f0f0u
// The upper pair of each four bits.
#define UPPER_PAIRS 0xccccccccu
// The upper bit of each pair.
#define UPPER_BITS 0xaaaaaaaau
// First factor of Owen scrambling (Laine and Karras 2011, factors of Burley's paper, JCGT 2020).
#define OWEN_1 0x6c50b47cu
// Second factor.
#define OWEN_2 0xb82f1e52u
// Third factor.
#define OWEN_3 0xc7afe638u
// Last factor.
#define OWEN_4 0x8d22f6e6u
// Binary digits of a sample's coordinate: those of a float's mantissa.
#define SAMPLE_DIGITS 24u
// The value of the last of these digits.
#define LAST_DIGIT 0x1p-24f
// Maximum number of rows of samples that are tested at once.
#define MAX_ROWS 20u
// Maximum number of words of their bits.
#define MAX_WORDS 10u
// Maximum number of samples in a row, so that its bits are an exact difference of powers of two in 32 bits.
#define MAX_OF_ROW 30u
// Edge functions below this in size, along a row, count as constant.
#define MIN_SLOPE 0x1.ef2d1p-84f
// Far outside of every emitter: the bound of a row without an edge on that side.
#define UNBOUNDED 0x1.93e594p99f
// Number of places by which samples are shifted along their rows: sums of a few shifts are exact.
#define SHIFT_STEPS 0x1p16f
// By how much the boxes of surface points and emitters are enlarged before bounds are derived from them.
#define ENLARGEMENT 0x1.0000a8p0f
// Least width in pixels of the cells by which surface points are grouped.
#define CELL_PIXELS 0x1p5f
// The exponent's last bit in single precision.
#define F32_EXPONENT_STEP 0x00800000u
// The exponent of numbers from 1 to 2 in single precision.
#define F32_EXPONENT_BIAS 127u
// The largest hash of a cell.
#define LAST_HASH 65534u
// Parts of four words of a candidate that may hide a light: three corners with the normal.
#define OCCLUDER_PARTS 3u
// Words that describe where such candidates are searched for.
#define SEARCHED_WORDS 64u
// Words of the rows of samples in shared memory, of one shape: four a row, and the end of each word's rows.
#define ROW_TABLE_WORDS 92u
// The margin of searches for what may hide a light, 2^-16 of the size of the searched space.
#define SHADOW_MARGIN 0x1p-16f
// Pixels on each side of a pixel that belong to its neighbourhood.
#define AROUND 2u
// Edge of a neighbourhood.
#define NEIGHBORHOOD 5u
// Pixels of a neighbourhood, and points of a light that their first rays are cast to.
#define FIRST_TARGETS 25u
// Answer of a surface point's first ray: it arrives.
#define ANSWER_LIT 1u
// It does not arrive.
#define ANSWER_DARK 2u
// Both.
#define ANSWER_BOTH 3u
// Added to the answer: the light is partly behind the surface.
#define ANSWER_STRADDLES 4u
// Maximum number of tangent planes that a region distinguishes.
#define TANGENT_PLANES 4u
// Words of a region's tangent planes in shared memory.
#define PLANE_WORDS 20u
// Words of a shaft's faces in shared memory, a multiple of four.
#define SHAFT_WORDS 20u
// Number of entries of a search's node stack up to which a round takes four nodes.
#define STACK_OF_ROUNDS 64u
// Additional stack entries per level of the tree.
#define STACK_PER_LEVEL 7u
// The same as `STACK_OF_ROUNDS` for a search that enters instances.
#define STACK_OF_INSTANCES 128u
// Number of instances that a node's leaves hold at most.
#define MAX_HELD 24u
// Maximum number of boxes from which the searches of a tile's bundles start.
#define MAX_SEARCH_ROOTS 48u
// Marks a box that is a leaf.
#define LEAF_START 0x80000000u
// The number of such boxes that means "start at the root".
#define FROM_ROOT 0xffffffffu
// Maximum number of recently found triangles that a search through a grid remembers.
#define RECENT_TRIANGLES 512u
// Words that describe the part of a grid that is searched.
#define GRID_FRAME_WORDS 20u
// Triangles found but not yet processed: fewer than 32, and at most 96 that one round of a search adds.
#define FOUND_TRIANGLES 128u
// Words of a candidate of the short tests by cell, a triangle that can matter.
#define CANDIDATE_WORDS 24u
// Candidates of one round.
#define CANDIDATES 32u
// Pairs of a candidate and a light point that are tested in one go.
#define LISTED_TARGETS 64u
// Words of such a pair.
#define TARGET_WORDS 4u
// Warps of a block that marks light points or interpolates, a bundle each.
#define BUNDLE_WARPS 4u
// Maximum number of lights without an area that are interpolated at once.
#define MAX_LIGHTS 3u
// Surface cells are offset from round coordinates, on which floors and walls tend to lie, by this fraction of their size, along x.
#define CELL_OFFSET_X 0x1.189374p-3f
// The same along y.
#define CELL_OFFSET_Y 0x1.ed9168p-3f
// The same along z.
#define CELL_OFFSET_Z 0x1.46a7fp-2f
// Bits of a surface cell's index along an axis; it repeats beyond.
#define CELL_INDEX_BITS 17u
// Added to a level so that it is positive, with seven bits.
#define LEVEL_BIAS 64
// The level of all widths that are smaller. Levels of cells differ from those of widths by a few.
#define MIN_LEVEL -60
// The level of all widths that are larger.
#define MAX_LEVEL 58
// Kinds of surfaces in a cell, by their normal: the largest component of three, its sign, and whether it is the triangle's front.
#define SURFACE_KINDS 12u
// How far records move away from edges, in cells.
#define RECORD_INWARDS 0x1p-4f
// Records lie in the cube around their cell's middle with this half edge, in cells: half a cell, and more since they move inwards from edges.
#define RECORD_MARGIN 0x1.4p-1f
// A record is open if nothing is above it within this distance, in cells: as far as layers in a cell may be from each other. With half of it,
// the ground below a floor would take the cell's only record from the floor.
#define RECORD_OPEN 0x1p0f
// The same for records that rays of others hit, of which smaller cells may have better ones.
#define NODE_OPEN 0x1p-2f
// How many points of a kind are looked at for an open one.
#define RECORD_CANDIDATES 4u
// The distance within which records count, in cells.
#define RECORD_RADIUS 0x1.8p0f
// The cells around one, and itself, in which they are: the ball around a place ends two cells away, at most.
#define CELLS_AROUND 125u
// The distance from each other's tangent planes within which they count, in cells.
#define RECORD_THICKNESS 0x1.8p-1f
// The cosine of the angle between normals beyond which they do not.
#define RECORD_COSINE 0x1.8p-1f
// Records that are nearly in line do not tell how light changes beside it: the product of the variances, relative to the square of their
// sum.
#define MIN_SPREAD 0x1.47ae14p-6f
// Segments to records begin and end above the surface by this share of their length, so that gentle curves do not hide them.
#define RECORD_RAISED 0x1.333334p-3f
// They rise no farther than this share of the way to what is above.
#define RECORD_STEP 0x1p-1f
// They rise no more slowly than by this cosine, unless something is in the way.
#define MIN_RISE 0x1.333334p-2f
// Bins of directions along each side of the octahedron's square.
#define BINS_PER_SIDE 8u
// What tilts a surface changes light by the slope of the cosine, which has no bound at the horizon: smaller cosines count as this.
#define MIN_TILT_COSINE 0x1.99999ap-3f
// Bins of all directions.
#define BINS 64u
// By how many levels coarse cells are coarser than fine ones: they are four times as large.
#define COARSER 2
// The last part of a level, from here to 2, becomes the next one.
#define BLEND_FROM 0x1.cp0f
// Near is what is not farther than this many coarse cells.
#define NEAR_CELLS 0x1p1f
// How far near rays reach, relative to what coarse records leave out as near. What is near to these may be farther away here, but only
// from some: with 1, light is too bright before walls, with 2 too dark.
#define NEAR_REACH 0x1.4p0f
// Records cast more rays if the luminance that the first ones see deviates by more than this from its mean, relative to it.
#define EVEN 0x1.ccccccp-2f
// This share of a record's second rays goes where its first ones see different things; the rest goes everywhere.
#define GUIDED 0x1p-1f
// First rays along each side of a block of directions.
#define GUIDE_BLOCK 2u
// How many rays beside a block tell how different what is seen in it is.
#define GUIDE_RING 1u
// A record's first ray counts as much as this many of its second ones, which go where they are needed.
#define FIRST_COUNT 0x1p-2f
// Near rays see a record's surroundings as crowded where the mean inverse distance of what they hit, times the size of the coarse cells, is more:
// then it asks coarse cells of half the size.
#define CROWDED 0x1p-1f
// To ask cells that are smaller once more, that must be more than this many times as much.
#define CROWDED_AGAIN 0x1p2f
// Where it is more than this, as among leaves, smaller cells would not help either.
#define HOPELESS 0x1.8p1f
// By how many levels coarse cells may become smaller.
#define CLOSER 2u
// The cone of the surroundings that a ray sees is this share of its own: wider ones would look below the horizon.
#define SKY_CONE 0x1p-2f
// What a ray hits is asked for light in a cell of this share of the distance.
#define BOUNCE_SIZE 0x1.99999ap-3f
// If a record is hidden or covered, cells that are smaller by up to this many levels are asked, one after the other.
#define BOUNCE_FINER 2
// The rays of a record that other rays hit form a square with this side.
#define BOUNCE_SIDE 8u
// What is so many times brighter than the mean of what a hemisphere of rays sees asks the smallest of these at once: around it, light changes fast.
#define BRIGHT 0x1p3f
// Where there are more lights, what a ray hits asks about so many of them, chosen by what they may give.
#define CHOSEN_LIGHTS 4u
// How often light is reflected before it reaches what a gather ray hits, at most, with the first time by a light's. After so many, a share of
// the twelfth power of what surfaces reflect is missing: 2 % in a closed room that reflects 0.7.
#define ORDERS 12u
// Where records that rays hit are looked for first, in cells around the middle of theirs; then twice as far, up to a whole cell.
#define NODE_REACH 0x1p-3f
// A table in which a name is not found after this many places is too full.
#define NAME_PROBES 1024u
// Added to the number of names of such a table.
#define FULL_TABLE 0x80000000u
// No name, record or node.
#define NO_NUMBER 0xffffffffu

#if defined(__CUDACC_RTC__)
#define PLACE_OF(record, field) __INTADDR__(&(((record *)0)->field))
#else
#define PLACE_OF(record, field) __builtin_offsetof(record, field)
#endif

struct alignas(8) Counters {
    unsigned long long rays;
    unsigned long long hits;
    unsigned long long surface_points;
    unsigned long long half_ball;
    unsigned long long used;
    unsigned long long fallbacks;
    unsigned long long light_points;
    unsigned long long short_tests;
    unsigned long long short_tests_culled;
    unsigned long long long_tests;
    unsigned long long long_tests_saved;
    unsigned long long shadow_rays;
    unsigned long long gather_rays;
    unsigned long long overruns;
};
static_assert(sizeof(Counters) == 112, "size of Counters");
static_assert(PLACE_OF(Counters, rays) == 0, "place of Counters::rays");
static_assert(PLACE_OF(Counters, hits) == 8, "place of Counters::hits");
static_assert(PLACE_OF(Counters, surface_points) == 16, "place of Counters::surface_points");
static_assert(PLACE_OF(Counters, half_ball) == 24, "place of Counters::half_ball");
static_assert(PLACE_OF(Counters, used) == 32, "place of Counters::used");
static_assert(PLACE_OF(Counters, fallbacks) == 40, "place of Counters::fallbacks");
static_assert(PLACE_OF(Counters, light_points) == 48, "place of Counters::light_points");
static_assert(PLACE_OF(Counters, short_tests) == 56, "place of Counters::short_tests");
static_assert(PLACE_OF(Counters, short_tests_culled) == 64, "place of Counters::short_tests_culled");
static_assert(PLACE_OF(Counters, long_tests) == 72, "place of Counters::long_tests");
static_assert(PLACE_OF(Counters, long_tests_saved) == 80, "place of Counters::long_tests_saved");
static_assert(PLACE_OF(Counters, shadow_rays) == 88, "place of Counters::shadow_rays");
static_assert(PLACE_OF(Counters, gather_rays) == 96, "place of Counters::gather_rays");
static_assert(PLACE_OF(Counters, overruns) == 104, "place of Counters::overruns");

struct alignas(4) Vec3 {
    float x;
    float y;
    float z;
};
static_assert(sizeof(Vec3) == 12, "size of Vec3");
static_assert(PLACE_OF(Vec3, x) == 0, "place of Vec3::x");
static_assert(PLACE_OF(Vec3, y) == 4, "place of Vec3::y");
static_assert(PLACE_OF(Vec3, z) == 8, "place of Vec3::z");

struct alignas(8) DVec3 {
    double x;
    double y;
    double z;
};
static_assert(sizeof(DVec3) == 24, "size of DVec3");
static_assert(PLACE_OF(DVec3, x) == 0, "place of DVec3::x");
static_assert(PLACE_OF(DVec3, y) == 8, "place of DVec3::y");
static_assert(PLACE_OF(DVec3, z) == 16, "place of DVec3::z");

struct alignas(4) Hit {
    enum : unsigned {
        // The triangle index that means "no triangle".
        NONE = 0xffffffffu,
    };
    float t;
    float u;
    float v;
    unsigned triangle;
};
static_assert(sizeof(Hit) == 16, "size of Hit");
static_assert(PLACE_OF(Hit, t) == 0, "place of Hit::t");
static_assert(PLACE_OF(Hit, u) == 4, "place of Hit::u");
static_assert(PLACE_OF(Hit, v) == 8, "place of Hit::v");
static_assert(PLACE_OF(Hit, triangle) == 12, "place of Hit::triangle");

struct alignas(4) Triangle {
    float corners[3][4];
};
static_assert(sizeof(Triangle) == 48, "size of Triangle");
static_assert(PLACE_OF(Triangle, corners) == 0, "place of Triangle::corners");

struct alignas(4) Instanced {
    float place[3][4];
    float back[3][4];
    unsigned first;
    unsigned stored;
    unsigned leaves;
    unsigned root;
    float norm;
    float reach;
    float shift;
    unsigned object;
};
static_assert(sizeof(Instanced) == 128, "size of Instanced");
static_assert(PLACE_OF(Instanced, place) == 0, "place of Instanced::place");
static_assert(PLACE_OF(Instanced, back) == 48, "place of Instanced::back");
static_assert(PLACE_OF(Instanced, first) == 96, "place of Instanced::first");
static_assert(PLACE_OF(Instanced, stored) == 100, "place of Instanced::stored");
static_assert(PLACE_OF(Instanced, leaves) == 104, "place of Instanced::leaves");
static_assert(PLACE_OF(Instanced, root) == 108, "place of Instanced::root");
static_assert(PLACE_OF(Instanced, norm) == 112, "place of Instanced::norm");
static_assert(PLACE_OF(Instanced, reach) == 116, "place of Instanced::reach");
static_assert(PLACE_OF(Instanced, shift) == 120, "place of Instanced::shift");
static_assert(PLACE_OF(Instanced, object) == 124, "place of Instanced::object");

struct alignas(8) Triangles {
    const Triangle *stored;
    const Instanced *instances;
    unsigned instance_count;
    unsigned spare;
};
static_assert(sizeof(Triangles) == 24, "size of Triangles");
static_assert(PLACE_OF(Triangles, stored) == 0, "place of Triangles::stored");
static_assert(PLACE_OF(Triangles, instances) == 8, "place of Triangles::instances");
static_assert(PLACE_OF(Triangles, instance_count) == 16, "place of Triangles::instance_count");
static_assert(PLACE_OF(Triangles, spare) == 20, "place of Triangles::spare");

struct alignas(4) CutTriangle {
    float uvs[3][2];
    float opacities[3];
    unsigned mask;
};
static_assert(sizeof(CutTriangle) == 40, "size of CutTriangle");
static_assert(PLACE_OF(CutTriangle, uvs) == 0, "place of CutTriangle::uvs");
static_assert(PLACE_OF(CutTriangle, opacities) == 24, "place of CutTriangle::opacities");
static_assert(PLACE_OF(CutTriangle, mask) == 36, "place of CutTriangle::mask");

struct alignas(8) Mask {
    const unsigned char *texels;
    unsigned size[2];
    unsigned wrap[2];
    float u_axis[2];
    float v_axis[2];
    float translation[2];
    float limit;
    unsigned blends;
};
static_assert(sizeof(Mask) == 56, "size of Mask");
static_assert(PLACE_OF(Mask, texels) == 0, "place of Mask::texels");
static_assert(PLACE_OF(Mask, size) == 8, "place of Mask::size");
static_assert(PLACE_OF(Mask, wrap) == 16, "place of Mask::wrap");
static_assert(PLACE_OF(Mask, u_axis) == 24, "place of Mask::u_axis");
static_assert(PLACE_OF(Mask, v_axis) == 32, "place of Mask::v_axis");
static_assert(PLACE_OF(Mask, translation) == 40, "place of Mask::translation");
static_assert(PLACE_OF(Mask, limit) == 48, "place of Mask::limit");
static_assert(PLACE_OF(Mask, blends) == 52, "place of Mask::blends");

struct alignas(8) AlphaMask {
    const CutTriangle *triangles;
    const Mask *masks;
};
static_assert(sizeof(AlphaMask) == 16, "size of AlphaMask");
static_assert(PLACE_OF(AlphaMask, triangles) == 0, "place of AlphaMask::triangles");
static_assert(PLACE_OF(AlphaMask, masks) == 8, "place of AlphaMask::masks");

struct alignas(4) BvhNode {
    Vec3 p;
    unsigned char e[3];
    unsigned char imask;
    unsigned child_base;
    unsigned triangle_base;
    unsigned char meta[8];
    unsigned char min_x[8];
    unsigned char max_x[8];
    unsigned char min_y[8];
    unsigned char max_y[8];
    unsigned char min_z[8];
    unsigned char max_z[8];
};
static_assert(sizeof(BvhNode) == 80, "size of BvhNode");
static_assert(PLACE_OF(BvhNode, p) == 0, "place of BvhNode::p");
static_assert(PLACE_OF(BvhNode, e) == 12, "place of BvhNode::e");
static_assert(PLACE_OF(BvhNode, imask) == 15, "place of BvhNode::imask");
static_assert(PLACE_OF(BvhNode, child_base) == 16, "place of BvhNode::child_base");
static_assert(PLACE_OF(BvhNode, triangle_base) == 20, "place of BvhNode::triangle_base");
static_assert(PLACE_OF(BvhNode, meta) == 24, "place of BvhNode::meta");
static_assert(PLACE_OF(BvhNode, min_x) == 32, "place of BvhNode::min_x");
static_assert(PLACE_OF(BvhNode, max_x) == 40, "place of BvhNode::max_x");
static_assert(PLACE_OF(BvhNode, min_y) == 48, "place of BvhNode::min_y");
static_assert(PLACE_OF(BvhNode, max_y) == 56, "place of BvhNode::max_y");
static_assert(PLACE_OF(BvhNode, min_z) == 64, "place of BvhNode::min_z");
static_assert(PLACE_OF(BvhNode, max_z) == 72, "place of BvhNode::max_z");

struct alignas(4) RayClamp {
    Vec3 center;
    float radius;
};
static_assert(sizeof(RayClamp) == 16, "size of RayClamp");
static_assert(PLACE_OF(RayClamp, center) == 0, "place of RayClamp::center");
static_assert(PLACE_OF(RayClamp, radius) == 12, "place of RayClamp::radius");

struct alignas(8) Bvh {
    const BvhNode *nodes;
    const Triangle *triangles;
    AlphaMask alpha_mask;
    RayClamp ray_clamp;
    unsigned node_count;
    unsigned depth;
};
static_assert(sizeof(Bvh) == 56, "size of Bvh");
static_assert(PLACE_OF(Bvh, nodes) == 0, "place of Bvh::nodes");
static_assert(PLACE_OF(Bvh, triangles) == 8, "place of Bvh::triangles");
static_assert(PLACE_OF(Bvh, alpha_mask) == 16, "place of Bvh::alpha_mask");
static_assert(PLACE_OF(Bvh, ray_clamp) == 32, "place of Bvh::ray_clamp");
static_assert(PLACE_OF(Bvh, node_count) == 48, "place of Bvh::node_count");
static_assert(PLACE_OF(Bvh, depth) == 52, "place of Bvh::depth");

struct alignas(8) InstancedBvh {
    const BvhNode *nodes;
    const Triangle *triangles;
    AlphaMask alpha_mask;
    const Instanced *instances;
    RayClamp ray_clamp;
    unsigned node_count;
    unsigned depth;
    unsigned instance_count;
    unsigned spare;
};
static_assert(sizeof(InstancedBvh) == 72, "size of InstancedBvh");
static_assert(PLACE_OF(InstancedBvh, nodes) == 0, "place of InstancedBvh::nodes");
static_assert(PLACE_OF(InstancedBvh, triangles) == 8, "place of InstancedBvh::triangles");
static_assert(PLACE_OF(InstancedBvh, alpha_mask) == 16, "place of InstancedBvh::alpha_mask");
static_assert(PLACE_OF(InstancedBvh, instances) == 32, "place of InstancedBvh::instances");
static_assert(PLACE_OF(InstancedBvh, ray_clamp) == 40, "place of InstancedBvh::ray_clamp");
static_assert(PLACE_OF(InstancedBvh, node_count) == 56, "place of InstancedBvh::node_count");
static_assert(PLACE_OF(InstancedBvh, depth) == 60, "place of InstancedBvh::depth");
static_assert(PLACE_OF(InstancedBvh, instance_count) == 64, "place of InstancedBvh::instance_count");
static_assert(PLACE_OF(InstancedBvh, spare) == 68, "place of InstancedBvh::spare");

struct alignas(8) Grid {
    const int *cells;
    const Triangle *triangles;
    const unsigned char *distances;
    DVec3 origin;
    Vec3 size;
    unsigned dims[3];
    RayClamp ray_clamp;
    unsigned triangle_count;
    float margin;
};
static_assert(sizeof(Grid) == 96, "size of Grid");
static_assert(PLACE_OF(Grid, cells) == 0, "place of Grid::cells");
static_assert(PLACE_OF(Grid, triangles) == 8, "place of Grid::triangles");
static_assert(PLACE_OF(Grid, distances) == 16, "place of Grid::distances");
static_assert(PLACE_OF(Grid, origin) == 24, "place of Grid::origin");
static_assert(PLACE_OF(Grid, size) == 48, "place of Grid::size");
static_assert(PLACE_OF(Grid, dims) == 60, "place of Grid::dims");
static_assert(PLACE_OF(Grid, ray_clamp) == 72, "place of Grid::ray_clamp");
static_assert(PLACE_OF(Grid, triangle_count) == 88, "place of Grid::triangle_count");
static_assert(PLACE_OF(Grid, margin) == 92, "place of Grid::margin");

struct alignas(8) BruteForce {
    const Triangle *triangles;
    AlphaMask alpha_mask;
    RayClamp ray_clamp;
    unsigned count;
    unsigned spare;
};
static_assert(sizeof(BruteForce) == 48, "size of BruteForce");
static_assert(PLACE_OF(BruteForce, triangles) == 0, "place of BruteForce::triangles");
static_assert(PLACE_OF(BruteForce, alpha_mask) == 8, "place of BruteForce::alpha_mask");
static_assert(PLACE_OF(BruteForce, ray_clamp) == 24, "place of BruteForce::ray_clamp");
static_assert(PLACE_OF(BruteForce, count) == 40, "place of BruteForce::count");
static_assert(PLACE_OF(BruteForce, spare) == 44, "place of BruteForce::spare");

struct alignas(4) View {
    Vec3 origin;
    Vec3 forward;
    Vec3 right;
    Vec3 down;
    Vec3 axis;
    unsigned size[2];
    int first[2];
    unsigned whole[2];
    float near;
    float far;
    unsigned clips;
    unsigned perspective;
    unsigned spare;
};
static_assert(sizeof(View) == 104, "size of View");
static_assert(PLACE_OF(View, origin) == 0, "place of View::origin");
static_assert(PLACE_OF(View, forward) == 12, "place of View::forward");
static_assert(PLACE_OF(View, right) == 24, "place of View::right");
static_assert(PLACE_OF(View, down) == 36, "place of View::down");
static_assert(PLACE_OF(View, axis) == 48, "place of View::axis");
static_assert(PLACE_OF(View, size) == 60, "place of View::size");
static_assert(PLACE_OF(View, first) == 68, "place of View::first");
static_assert(PLACE_OF(View, whole) == 76, "place of View::whole");
static_assert(PLACE_OF(View, near) == 84, "place of View::near");
static_assert(PLACE_OF(View, far) == 88, "place of View::far");
static_assert(PLACE_OF(View, clips) == 92, "place of View::clips");
static_assert(PLACE_OF(View, perspective) == 96, "place of View::perspective");
static_assert(PLACE_OF(View, spare) == 100, "place of View::spare");

struct alignas(4) ListedRay {
    Vec3 origin;
    unsigned pixel;
    Vec3 direction;
    unsigned sample;
    Vec3 weight;
    unsigned shared;
};
static_assert(sizeof(ListedRay) == 48, "size of ListedRay");
static_assert(PLACE_OF(ListedRay, origin) == 0, "place of ListedRay::origin");
static_assert(PLACE_OF(ListedRay, pixel) == 12, "place of ListedRay::pixel");
static_assert(PLACE_OF(ListedRay, direction) == 16, "place of ListedRay::direction");
static_assert(PLACE_OF(ListedRay, sample) == 28, "place of ListedRay::sample");
static_assert(PLACE_OF(ListedRay, weight) == 32, "place of ListedRay::weight");
static_assert(PLACE_OF(ListedRay, shared) == 44, "place of ListedRay::shared");

struct alignas(4) Cone {
    float width;
    float spread;
};
static_assert(sizeof(Cone) == 8, "size of Cone");
static_assert(PLACE_OF(Cone, width) == 0, "place of Cone::width");
static_assert(PLACE_OF(Cone, spread) == 4, "place of Cone::spread");

struct alignas(8) Rays {
    View view;
    const ListedRay *list;
    const Cone *cones;
    unsigned first_pixel;
    unsigned count;
    unsigned depth;
    unsigned bounces;
    Cone cone;
};
static_assert(sizeof(Rays) == 144, "size of Rays");
static_assert(PLACE_OF(Rays, view) == 0, "place of Rays::view");
static_assert(PLACE_OF(Rays, list) == 104, "place of Rays::list");
static_assert(PLACE_OF(Rays, cones) == 112, "place of Rays::cones");
static_assert(PLACE_OF(Rays, first_pixel) == 120, "place of Rays::first_pixel");
static_assert(PLACE_OF(Rays, count) == 124, "place of Rays::count");
static_assert(PLACE_OF(Rays, depth) == 128, "place of Rays::depth");
static_assert(PLACE_OF(Rays, bounces) == 132, "place of Rays::bounces");
static_assert(PLACE_OF(Rays, cone) == 136, "place of Rays::cone");

struct alignas(8) Tally {
    enum : unsigned {
        // Number of shards.
        SHARDS = 64u,
    };
    Counters *shards;
};
static_assert(sizeof(Tally) == 8, "size of Tally");
static_assert(PLACE_OF(Tally, shards) == 0, "place of Tally::shards");

struct alignas(4) Light {
    enum : unsigned {
        // A point light.
        POINT = 0u,
        // Parallel light.
        DIRECTIONAL = 1u,
        // A spot without a size.
        SPOT = 2u,
        // A ball, with a cone if it is a spot. This kind and all that follow are area lights.
        SPHERE = 3u,
        // A disk.
        DISK = 4u,
        // A rectangle.
        RECTANGLE = 5u,
        // How it is seen: mirror rays see it,
        SEEN = 1u,
        // as a surface that is none of the scene's: rays that go on from any surface do,
        SURFACE = 2u,
        // and those of the camera.
        CAMERA = 4u,
        // Mirror rays see it in the image of what surrounds the scene, however rough the mirror is.
        PAINTED = 8u,
        // That image alone shows it in mirrors: what is seen there has no highlight of it.
        BOXED = 16u,
    };
    Vec3 position;
    unsigned kind;
    Vec3 direction;
    float radius;
    Vec3 half_u;
    float size;
    Vec3 half_v;
    unsigned inverse_square;
    Vec3 intensity;
    float cos_outer;
    float cone_scale;
    float scale;
    unsigned surface;
    unsigned seen;
    float body;
};
static_assert(sizeof(Light) == 100, "size of Light");
static_assert(PLACE_OF(Light, position) == 0, "place of Light::position");
static_assert(PLACE_OF(Light, kind) == 12, "place of Light::kind");
static_assert(PLACE_OF(Light, direction) == 16, "place of Light::direction");
static_assert(PLACE_OF(Light, radius) == 28, "place of Light::radius");
static_assert(PLACE_OF(Light, half_u) == 32, "place of Light::half_u");
static_assert(PLACE_OF(Light, size) == 44, "place of Light::size");
static_assert(PLACE_OF(Light, half_v) == 48, "place of Light::half_v");
static_assert(PLACE_OF(Light, inverse_square) == 60, "place of Light::inverse_square");
static_assert(PLACE_OF(Light, intensity) == 64, "place of Light::intensity");
static_assert(PLACE_OF(Light, cos_outer) == 76, "place of Light::cos_outer");
static_assert(PLACE_OF(Light, cone_scale) == 80, "place of Light::cone_scale");
static_assert(PLACE_OF(Light, scale) == 84, "place of Light::scale");
static_assert(PLACE_OF(Light, surface) == 88, "place of Light::surface");
static_assert(PLACE_OF(Light, seen) == 92, "place of Light::seen");
static_assert(PLACE_OF(Light, body) == 96, "place of Light::body");

struct alignas(4) Indices {
    unsigned vertices[3];
};
static_assert(sizeof(Indices) == 12, "size of Indices");
static_assert(PLACE_OF(Indices, vertices) == 0, "place of Indices::vertices");

struct alignas(4) Uv {
    float u;
    float v;
};
static_assert(sizeof(Uv) == 8, "size of Uv");
static_assert(PLACE_OF(Uv, u) == 0, "place of Uv::u");
static_assert(PLACE_OF(Uv, v) == 4, "place of Uv::v");

struct alignas(8) TextureLevel {
    const unsigned long long *texels;
    unsigned size[2];
};
static_assert(sizeof(TextureLevel) == 16, "size of TextureLevel");
static_assert(PLACE_OF(TextureLevel, texels) == 0, "place of TextureLevel::texels");
static_assert(PLACE_OF(TextureLevel, size) == 8, "place of TextureLevel::size");

struct alignas(8) Texture {
    enum : unsigned {
        // The same again.
        REPEAT = 0u,
        // The same again, every other time mirrored.
        MIRROR = 1u,
        // The outermost texels.
        CLAMP = 2u,
    };
    const unsigned *texels;
    const TextureLevel *levels;
    unsigned size[2];
    unsigned wrap[2];
    float u_axis[2];
    float v_axis[2];
    float translation[2];
    unsigned level_count;
    unsigned first_code;
};
static_assert(sizeof(Texture) == 64, "size of Texture");
static_assert(PLACE_OF(Texture, texels) == 0, "place of Texture::texels");
static_assert(PLACE_OF(Texture, levels) == 8, "place of Texture::levels");
static_assert(PLACE_OF(Texture, size) == 16, "place of Texture::size");
static_assert(PLACE_OF(Texture, wrap) == 24, "place of Texture::wrap");
static_assert(PLACE_OF(Texture, u_axis) == 32, "place of Texture::u_axis");
static_assert(PLACE_OF(Texture, v_axis) == 40, "place of Texture::v_axis");
static_assert(PLACE_OF(Texture, translation) == 48, "place of Texture::translation");
static_assert(PLACE_OF(Texture, level_count) == 56, "place of Texture::level_count");
static_assert(PLACE_OF(Texture, first_code) == 60, "place of Texture::first_code");

struct alignas(4) FacetShare {
    float normal;
    float grazing;
};
static_assert(sizeof(FacetShare) == 8, "size of FacetShare");
static_assert(PLACE_OF(FacetShare, normal) == 0, "place of FacetShare::normal");
static_assert(PLACE_OF(FacetShare, grazing) == 4, "place of FacetShare::grazing");

struct alignas(4) Material {
    enum : unsigned {
        // The material has no texture.
        NO_TEXTURE = 0xffffffffu,
    };
    Vec3 ka;
    float shininess;
    Vec3 kd;
    unsigned tinted;
    Vec3 ks;
    unsigned texture;
    Vec3 emission;
    unsigned catcher;
    Vec3 ks_tinted;
    unsigned number;
    Vec3 emission_tinted;
    unsigned lamp;
    Vec3 transmittance;
    unsigned blends;
    Vec3 absorption;
    float ior;
    unsigned thin;
    float eta;
    unsigned emission_texture;
    unsigned normal_texture;
    Vec3 smooth;
    float normal_scale;
    unsigned facets;
    float roughness;
    float metallic;
    float grazing;
    Vec3 all;
    float square;
    Vec3 mirrored;
    float seen_square;
    Vec3 gain;
    float cosine;
    float shown;
    float boxed;
    float unmirrored;
    float opacity;
    unsigned metallic_roughness_texture;
};
static_assert(sizeof(Material) == 244, "size of Material");
static_assert(PLACE_OF(Material, ka) == 0, "place of Material::ka");
static_assert(PLACE_OF(Material, shininess) == 12, "place of Material::shininess");
static_assert(PLACE_OF(Material, kd) == 16, "place of Material::kd");
static_assert(PLACE_OF(Material, tinted) == 28, "place of Material::tinted");
static_assert(PLACE_OF(Material, ks) == 32, "place of Material::ks");
static_assert(PLACE_OF(Material, texture) == 44, "place of Material::texture");
static_assert(PLACE_OF(Material, emission) == 48, "place of Material::emission");
static_assert(PLACE_OF(Material, catcher) == 60, "place of Material::catcher");
static_assert(PLACE_OF(Material, ks_tinted) == 64, "place of Material::ks_tinted");
static_assert(PLACE_OF(Material, number) == 76, "place of Material::number");
static_assert(PLACE_OF(Material, emission_tinted) == 80, "place of Material::emission_tinted");
static_assert(PLACE_OF(Material, lamp) == 92, "place of Material::lamp");
static_assert(PLACE_OF(Material, transmittance) == 96, "place of Material::transmittance");
static_assert(PLACE_OF(Material, blends) == 108, "place of Material::blends");
static_assert(PLACE_OF(Material, absorption) == 112, "place of Material::absorption");
static_assert(PLACE_OF(Material, ior) == 124, "place of Material::ior");
static_assert(PLACE_OF(Material, thin) == 128, "place of Material::thin");
static_assert(PLACE_OF(Material, eta) == 132, "place of Material::eta");
static_assert(PLACE_OF(Material, emission_texture) == 136, "place of Material::emission_texture");
static_assert(PLACE_OF(Material, normal_texture) == 140, "place of Material::normal_texture");
static_assert(PLACE_OF(Material, smooth) == 144, "place of Material::smooth");
static_assert(PLACE_OF(Material, normal_scale) == 156, "place of Material::normal_scale");
static_assert(PLACE_OF(Material, facets) == 160, "place of Material::facets");
static_assert(PLACE_OF(Material, roughness) == 164, "place of Material::roughness");
static_assert(PLACE_OF(Material, metallic) == 168, "place of Material::metallic");
static_assert(PLACE_OF(Material, grazing) == 172, "place of Material::grazing");
static_assert(PLACE_OF(Material, all) == 176, "place of Material::all");
static_assert(PLACE_OF(Material, square) == 188, "place of Material::square");
static_assert(PLACE_OF(Material, mirrored) == 192, "place of Material::mirrored");
static_assert(PLACE_OF(Material, seen_square) == 204, "place of Material::seen_square");
static_assert(PLACE_OF(Material, gain) == 208, "place of Material::gain");
static_assert(PLACE_OF(Material, cosine) == 220, "place of Material::cosine");
static_assert(PLACE_OF(Material, shown) == 224, "place of Material::shown");
static_assert(PLACE_OF(Material, boxed) == 228, "place of Material::boxed");
static_assert(PLACE_OF(Material, unmirrored) == 232, "place of Material::unmirrored");
static_assert(PLACE_OF(Material, opacity) == 236, "place of Material::opacity");
static_assert(PLACE_OF(Material, metallic_roughness_texture) == 240, "place of Material::metallic_roughness_texture");

struct alignas(8) EnvironmentLevel {
    const Vec3 *texels;
    unsigned size[2];
};
static_assert(sizeof(EnvironmentLevel) == 16, "size of EnvironmentLevel");
static_assert(PLACE_OF(EnvironmentLevel, texels) == 0, "place of EnvironmentLevel::texels");
static_assert(PLACE_OF(EnvironmentLevel, size) == 8, "place of EnvironmentLevel::size");

struct alignas(8) Environment {
    const EnvironmentLevel *levels;
    const EnvironmentLevel *gathered;
    Vec3 east;
    unsigned lower;
    Vec3 up;
    unsigned hidden;
    Vec3 north;
    float sun_radius;
    Vec3 sun;
    unsigned gathered_lower;
    Vec3 sun_radiance;
    unsigned lights;
    float terms[27];
    unsigned spare_b;
};
static_assert(sizeof(Environment) == 208, "size of Environment");
static_assert(PLACE_OF(Environment, levels) == 0, "place of Environment::levels");
static_assert(PLACE_OF(Environment, gathered) == 8, "place of Environment::gathered");
static_assert(PLACE_OF(Environment, east) == 16, "place of Environment::east");
static_assert(PLACE_OF(Environment, lower) == 28, "place of Environment::lower");
static_assert(PLACE_OF(Environment, up) == 32, "place of Environment::up");
static_assert(PLACE_OF(Environment, hidden) == 44, "place of Environment::hidden");
static_assert(PLACE_OF(Environment, north) == 48, "place of Environment::north");
static_assert(PLACE_OF(Environment, sun_radius) == 60, "place of Environment::sun_radius");
static_assert(PLACE_OF(Environment, sun) == 64, "place of Environment::sun");
static_assert(PLACE_OF(Environment, gathered_lower) == 76, "place of Environment::gathered_lower");
static_assert(PLACE_OF(Environment, sun_radiance) == 80, "place of Environment::sun_radiance");
static_assert(PLACE_OF(Environment, lights) == 92, "place of Environment::lights");
static_assert(PLACE_OF(Environment, terms) == 96, "place of Environment::terms");
static_assert(PLACE_OF(Environment, spare_b) == 204, "place of Environment::spare_b");

struct alignas(8) Scene {
    Triangles triangles;
    const Indices *indices;
    const Vec3 *normals;
    const Uv *uvs;
    const Vec3 *colors;
    const Texture *textures;
    const float *codes;
    const unsigned *triangle_materials;
    const Material *materials;
    const FacetShare *facet_table;
    const unsigned *object_starts;
    const unsigned *objects;
    const Light *lights;
    const Vec3 *light_targets;
    AlphaMask alpha_mask;
    Environment environment;
    Grid grid;
    Bvh bvh;
    BruteForce brute_force;
    InstancedBvh instanced;
    unsigned light_count;
    Vec3 ambient;
    Vec3 background;
    Vec3 center;
    float far;
    unsigned object_runs;
    unsigned seen_lights;
    unsigned spare;
};
static_assert(sizeof(Scene) == 680, "size of Scene");
static_assert(PLACE_OF(Scene, triangles) == 0, "place of Scene::triangles");
static_assert(PLACE_OF(Scene, indices) == 24, "place of Scene::indices");
static_assert(PLACE_OF(Scene, normals) == 32, "place of Scene::normals");
static_assert(PLACE_OF(Scene, uvs) == 40, "place of Scene::uvs");
static_assert(PLACE_OF(Scene, colors) == 48, "place of Scene::colors");
static_assert(PLACE_OF(Scene, textures) == 56, "place of Scene::textures");
static_assert(PLACE_OF(Scene, codes) == 64, "place of Scene::codes");
static_assert(PLACE_OF(Scene, triangle_materials) == 72, "place of Scene::triangle_materials");
static_assert(PLACE_OF(Scene, materials) == 80, "place of Scene::materials");
static_assert(PLACE_OF(Scene, facet_table) == 88, "place of Scene::facet_table");
static_assert(PLACE_OF(Scene, object_starts) == 96, "place of Scene::object_starts");
static_assert(PLACE_OF(Scene, objects) == 104, "place of Scene::objects");
static_assert(PLACE_OF(Scene, lights) == 112, "place of Scene::lights");
static_assert(PLACE_OF(Scene, light_targets) == 120, "place of Scene::light_targets");
static_assert(PLACE_OF(Scene, alpha_mask) == 128, "place of Scene::alpha_mask");
static_assert(PLACE_OF(Scene, environment) == 144, "place of Scene::environment");
static_assert(PLACE_OF(Scene, grid) == 352, "place of Scene::grid");
static_assert(PLACE_OF(Scene, bvh) == 448, "place of Scene::bvh");
static_assert(PLACE_OF(Scene, brute_force) == 504, "place of Scene::brute_force");
static_assert(PLACE_OF(Scene, instanced) == 552, "place of Scene::instanced");
static_assert(PLACE_OF(Scene, light_count) == 624, "place of Scene::light_count");
static_assert(PLACE_OF(Scene, ambient) == 628, "place of Scene::ambient");
static_assert(PLACE_OF(Scene, background) == 640, "place of Scene::background");
static_assert(PLACE_OF(Scene, center) == 652, "place of Scene::center");
static_assert(PLACE_OF(Scene, far) == 664, "place of Scene::far");
static_assert(PLACE_OF(Scene, object_runs) == 668, "place of Scene::object_runs");
static_assert(PLACE_OF(Scene, seen_lights) == 672, "place of Scene::seen_lights");
static_assert(PLACE_OF(Scene, spare) == 676, "place of Scene::spare");

struct alignas(8) Sampling {
    unsigned long long seed;
    unsigned samples;
    unsigned spread;
};
static_assert(sizeof(Sampling) == 16, "size of Sampling");
static_assert(PLACE_OF(Sampling, seed) == 0, "place of Sampling::seed");
static_assert(PLACE_OF(Sampling, samples) == 8, "place of Sampling::samples");
static_assert(PLACE_OF(Sampling, spread) == 12, "place of Sampling::spread");

struct alignas(4) SampleRows {
    float y[20];
    float density[20];
    float half[20];
    float shift[20];
    unsigned count[20];
    unsigned place[20];
    unsigned line[20];
    unsigned ends[10];
    unsigned full[10];
    unsigned rows;
    unsigned words;
    unsigned lines;
    unsigned surplus;
    unsigned entering;
    unsigned leaving;
};
static_assert(sizeof(SampleRows) == 664, "size of SampleRows");
static_assert(PLACE_OF(SampleRows, y) == 0, "place of SampleRows::y");
static_assert(PLACE_OF(SampleRows, density) == 80, "place of SampleRows::density");
static_assert(PLACE_OF(SampleRows, half) == 160, "place of SampleRows::half");
static_assert(PLACE_OF(SampleRows, shift) == 240, "place of SampleRows::shift");
static_assert(PLACE_OF(SampleRows, count) == 320, "place of SampleRows::count");
static_assert(PLACE_OF(SampleRows, place) == 400, "place of SampleRows::place");
static_assert(PLACE_OF(SampleRows, line) == 480, "place of SampleRows::line");
static_assert(PLACE_OF(SampleRows, ends) == 560, "place of SampleRows::ends");
static_assert(PLACE_OF(SampleRows, full) == 600, "place of SampleRows::full");
static_assert(PLACE_OF(SampleRows, rows) == 640, "place of SampleRows::rows");
static_assert(PLACE_OF(SampleRows, words) == 644, "place of SampleRows::words");
static_assert(PLACE_OF(SampleRows, lines) == 648, "place of SampleRows::lines");
static_assert(PLACE_OF(SampleRows, surplus) == 652, "place of SampleRows::surplus");
static_assert(PLACE_OF(SampleRows, entering) == 656, "place of SampleRows::entering");
static_assert(PLACE_OF(SampleRows, leaving) == 660, "place of SampleRows::leaving");

// DO(structure, …) for each acceleration structure, by the name of its field in `Scene`.
#define PER_STRUCTURE(DO, ...) DO(bvh, __VA_ARGS__) DO(grid, __VA_ARGS__) DO(brute_force, __VA_ARGS__) DO(instanced, __VA_ARGS__)

struct alignas(8) LightMesh {
    enum : unsigned {
        // w of formula (3) is 1.
        WEIGHT_CONSTANT = 0u,
        // w falls with the square of the distance.
        WEIGHT_QUADRATIC = 1u,
        // w falls with the square of that.
        WEIGHT_SMOOTH = 2u,
    };
    Vec3 anchor;
    float step;
    float radius;
    float least_height;
    float edge_on;
    float slack;
    unsigned weight;
    unsigned points;
    unsigned words;
    int reach;
    unsigned number[3];
    unsigned lines;
    const unsigned *offsets;
    const unsigned *rows;
};
static_assert(sizeof(LightMesh) == 80, "size of LightMesh");
static_assert(PLACE_OF(LightMesh, anchor) == 0, "place of LightMesh::anchor");
static_assert(PLACE_OF(LightMesh, step) == 12, "place of LightMesh::step");
static_assert(PLACE_OF(LightMesh, radius) == 16, "place of LightMesh::radius");
static_assert(PLACE_OF(LightMesh, least_height) == 20, "place of LightMesh::least_height");
static_assert(PLACE_OF(LightMesh, edge_on) == 24, "place of LightMesh::edge_on");
static_assert(PLACE_OF(LightMesh, slack) == 28, "place of LightMesh::slack");
static_assert(PLACE_OF(LightMesh, weight) == 32, "place of LightMesh::weight");
static_assert(PLACE_OF(LightMesh, points) == 36, "place of LightMesh::points");
static_assert(PLACE_OF(LightMesh, words) == 40, "place of LightMesh::words");
static_assert(PLACE_OF(LightMesh, reach) == 44, "place of LightMesh::reach");
static_assert(PLACE_OF(LightMesh, number) == 48, "place of LightMesh::number");
static_assert(PLACE_OF(LightMesh, lines) == 60, "place of LightMesh::lines");
static_assert(PLACE_OF(LightMesh, offsets) == 64, "place of LightMesh::offsets");
static_assert(PLACE_OF(LightMesh, rows) == 72, "place of LightMesh::rows");

struct alignas(4) TemplateRow {
    unsigned short bit;
    unsigned short count;
    int x;
    int y;
    int z;
};
static_assert(sizeof(TemplateRow) == 16, "size of TemplateRow");
static_assert(PLACE_OF(TemplateRow, bit) == 0, "place of TemplateRow::bit");
static_assert(PLACE_OF(TemplateRow, count) == 2, "place of TemplateRow::count");
static_assert(PLACE_OF(TemplateRow, x) == 4, "place of TemplateRow::x");
static_assert(PLACE_OF(TemplateRow, y) == 8, "place of TemplateRow::y");
static_assert(PLACE_OF(TemplateRow, z) == 12, "place of TemplateRow::z");

struct alignas(8) Bundle {
    unsigned long long cell;
    unsigned first;
    unsigned count;
};
static_assert(sizeof(Bundle) == 16, "size of Bundle");
static_assert(PLACE_OF(Bundle, cell) == 0, "place of Bundle::cell");
static_assert(PLACE_OF(Bundle, first) == 8, "place of Bundle::first");
static_assert(PLACE_OF(Bundle, count) == 12, "place of Bundle::count");

struct alignas(8) BrickTable {
    unsigned long long *keys;
    unsigned capacity;
    unsigned spare;
};
static_assert(sizeof(BrickTable) == 16, "size of BrickTable");
static_assert(PLACE_OF(BrickTable, keys) == 0, "place of BrickTable::keys");
static_assert(PLACE_OF(BrickTable, capacity) == 8, "place of BrickTable::capacity");
static_assert(PLACE_OF(BrickTable, spare) == 12, "place of BrickTable::spare");

struct alignas(8) VisibilityOfLight {
    unsigned long long *bits;
    unsigned short *seen;
};
static_assert(sizeof(VisibilityOfLight) == 16, "size of VisibilityOfLight");
static_assert(PLACE_OF(VisibilityOfLight, bits) == 0, "place of VisibilityOfLight::bits");
static_assert(PLACE_OF(VisibilityOfLight, seen) == 8, "place of VisibilityOfLight::seen");

struct alignas(8) KeptBy {
    unsigned long long *known;
    unsigned long long *bits;
    unsigned short *seen;
};
static_assert(sizeof(KeptBy) == 24, "size of KeptBy");
static_assert(PLACE_OF(KeptBy, known) == 0, "place of KeptBy::known");
static_assert(PLACE_OF(KeptBy, bits) == 8, "place of KeptBy::bits");
static_assert(PLACE_OF(KeptBy, seen) == 16, "place of KeptBy::seen");

struct alignas(8) UsedPoints {
    BrickTable table;
    const unsigned long long *used;
    const unsigned *rank;
    const unsigned long long *points;
};
static_assert(sizeof(UsedPoints) == 40, "size of UsedPoints");
static_assert(PLACE_OF(UsedPoints, table) == 0, "place of UsedPoints::table");
static_assert(PLACE_OF(UsedPoints, used) == 16, "place of UsedPoints::used");
static_assert(PLACE_OF(UsedPoints, rank) == 24, "place of UsedPoints::rank");
static_assert(PLACE_OF(UsedPoints, points) == 32, "place of UsedPoints::points");

struct alignas(8) Name {
    unsigned long long key;
    int cell[3];
    int level;
    unsigned kind;
    unsigned finer;
};
static_assert(sizeof(Name) == 32, "size of Name");
static_assert(PLACE_OF(Name, key) == 0, "place of Name::key");
static_assert(PLACE_OF(Name, cell) == 8, "place of Name::cell");
static_assert(PLACE_OF(Name, level) == 20, "place of Name::level");
static_assert(PLACE_OF(Name, kind) == 24, "place of Name::kind");
static_assert(PLACE_OF(Name, finer) == 28, "place of Name::finer");

struct alignas(8) Names {
    unsigned long long *keys;
    unsigned *numbers;
    Name *names;
    unsigned *count;
    unsigned capacity;
    unsigned room;
};
static_assert(sizeof(Names) == 40, "size of Names");
static_assert(PLACE_OF(Names, keys) == 0, "place of Names::keys");
static_assert(PLACE_OF(Names, numbers) == 8, "place of Names::numbers");
static_assert(PLACE_OF(Names, names) == 16, "place of Names::names");
static_assert(PLACE_OF(Names, count) == 24, "place of Names::count");
static_assert(PLACE_OF(Names, capacity) == 32, "place of Names::capacity");
static_assert(PLACE_OF(Names, room) == 36, "place of Names::room");

struct alignas(8) Record {
    Vec3 position;
    int level;
    Vec3 origin;
    Vec3 normal;
    unsigned long long seed;
};
static_assert(sizeof(Record) == 48, "size of Record");
static_assert(PLACE_OF(Record, position) == 0, "place of Record::position");
static_assert(PLACE_OF(Record, level) == 12, "place of Record::level");
static_assert(PLACE_OF(Record, origin) == 16, "place of Record::origin");
static_assert(PLACE_OF(Record, normal) == 28, "place of Record::normal");
static_assert(PLACE_OF(Record, seed) == 40, "place of Record::seed");

struct alignas(8) SurfaceCells {
    Names cells;
    unsigned long long *ranges;
    Record *records;
    unsigned *record_count;
    unsigned *values;
    unsigned *owners;
    unsigned *value_count;
};
static_assert(sizeof(SurfaceCells) == 88, "size of SurfaceCells");
static_assert(PLACE_OF(SurfaceCells, cells) == 0, "place of SurfaceCells::cells");
static_assert(PLACE_OF(SurfaceCells, ranges) == 40, "place of SurfaceCells::ranges");
static_assert(PLACE_OF(SurfaceCells, records) == 48, "place of SurfaceCells::records");
static_assert(PLACE_OF(SurfaceCells, record_count) == 56, "place of SurfaceCells::record_count");
static_assert(PLACE_OF(SurfaceCells, values) == 64, "place of SurfaceCells::values");
static_assert(PLACE_OF(SurfaceCells, owners) == 72, "place of SurfaceCells::owners");
static_assert(PLACE_OF(SurfaceCells, value_count) == 80, "place of SurfaceCells::value_count");

struct alignas(4) LightPlace {
    Vec3 position;
    int level;
    Vec3 normal;
    float share;
    Vec3 origin;
};
static_assert(sizeof(LightPlace) == 44, "size of LightPlace");
static_assert(PLACE_OF(LightPlace, position) == 0, "place of LightPlace::position");
static_assert(PLACE_OF(LightPlace, level) == 12, "place of LightPlace::level");
static_assert(PLACE_OF(LightPlace, normal) == 16, "place of LightPlace::normal");
static_assert(PLACE_OF(LightPlace, share) == 28, "place of LightPlace::share");
static_assert(PLACE_OF(LightPlace, origin) == 32, "place of LightPlace::origin");

struct alignas(4) Link {
    unsigned record;
    float weight;
};
static_assert(sizeof(Link) == 8, "size of Link");
static_assert(PLACE_OF(Link, record) == 0, "place of Link::record");
static_assert(PLACE_OF(Link, weight) == 4, "place of Link::weight");

struct alignas(4) SurfaceLight {
    Vec3 mean;
    Vec3 tilt[3];
    Vec3 most;
};
static_assert(sizeof(SurfaceLight) == 60, "size of SurfaceLight");
static_assert(PLACE_OF(SurfaceLight, mean) == 0, "place of SurfaceLight::mean");
static_assert(PLACE_OF(SurfaceLight, tilt) == 12, "place of SurfaceLight::tilt");
static_assert(PLACE_OF(SurfaceLight, most) == 48, "place of SurfaceLight::most");

struct alignas(4) Bins {
    Vec3 sums[64];
    float counts[64];
};
static_assert(sizeof(Bins) == 1024, "size of Bins");
static_assert(PLACE_OF(Bins, sums) == 0, "place of Bins::sums");
static_assert(PLACE_OF(Bins, counts) == 768, "place of Bins::counts");

struct alignas(4) CoarseLight {
    SurfaceLight light;
    Bins all;
    Bins beyond;
    unsigned has_near;
};
static_assert(sizeof(CoarseLight) == 2112, "size of CoarseLight");
static_assert(PLACE_OF(CoarseLight, light) == 0, "place of CoarseLight::light");
static_assert(PLACE_OF(CoarseLight, all) == 60, "place of CoarseLight::all");
static_assert(PLACE_OF(CoarseLight, beyond) == 1084, "place of CoarseLight::beyond");
static_assert(PLACE_OF(CoarseLight, has_near) == 2108, "place of CoarseLight::has_near");

struct alignas(4) SeenRay {
    Vec3 position;
    int level;
    Vec3 normal;
    unsigned kind;
    Vec3 radiance;
    unsigned node;
    Vec3 kd;
    int from;
};
static_assert(sizeof(SeenRay) == 64, "size of SeenRay");
static_assert(PLACE_OF(SeenRay, position) == 0, "place of SeenRay::position");
static_assert(PLACE_OF(SeenRay, level) == 12, "place of SeenRay::level");
static_assert(PLACE_OF(SeenRay, normal) == 16, "place of SeenRay::normal");
static_assert(PLACE_OF(SeenRay, kind) == 28, "place of SeenRay::kind");
static_assert(PLACE_OF(SeenRay, radiance) == 32, "place of SeenRay::radiance");
static_assert(PLACE_OF(SeenRay, node) == 44, "place of SeenRay::node");
static_assert(PLACE_OF(SeenRay, kd) == 48, "place of SeenRay::kd");
static_assert(PLACE_OF(SeenRay, from) == 60, "place of SeenRay::from");

struct alignas(4) Node {
    Vec3 values[12];
    Vec3 hidden;
    unsigned known;
    unsigned wanted;
    unsigned links;
    unsigned covered;
};
static_assert(sizeof(Node) == 172, "size of Node");
static_assert(PLACE_OF(Node, values) == 0, "place of Node::values");
static_assert(PLACE_OF(Node, hidden) == 144, "place of Node::hidden");
static_assert(PLACE_OF(Node, known) == 156, "place of Node::known");
static_assert(PLACE_OF(Node, wanted) == 160, "place of Node::wanted");
static_assert(PLACE_OF(Node, links) == 164, "place of Node::links");
static_assert(PLACE_OF(Node, covered) == 168, "place of Node::covered");

struct alignas(4) NodeLink {
    unsigned node;
    Vec3 weight;
};
static_assert(sizeof(NodeLink) == 16, "size of NodeLink");
static_assert(PLACE_OF(NodeLink, node) == 0, "place of NodeLink::node");
static_assert(PLACE_OF(NodeLink, weight) == 4, "place of NodeLink::weight");

struct alignas(8) TakeRecords {
    const Record *records;
    const unsigned *numbers;
    Record *taken;
    LightPlace *places;
    unsigned *owners;
    unsigned first;
    unsigned count;
    int coarser;
    unsigned spare;
};
static_assert(sizeof(TakeRecords) == 56, "size of TakeRecords");
static_assert(PLACE_OF(TakeRecords, records) == 0, "place of TakeRecords::records");
static_assert(PLACE_OF(TakeRecords, numbers) == 8, "place of TakeRecords::numbers");
static_assert(PLACE_OF(TakeRecords, taken) == 16, "place of TakeRecords::taken");
static_assert(PLACE_OF(TakeRecords, places) == 24, "place of TakeRecords::places");
static_assert(PLACE_OF(TakeRecords, owners) == 32, "place of TakeRecords::owners");
static_assert(PLACE_OF(TakeRecords, first) == 40, "place of TakeRecords::first");
static_assert(PLACE_OF(TakeRecords, count) == 44, "place of TakeRecords::count");
static_assert(PLACE_OF(TakeRecords, coarser) == 48, "place of TakeRecords::coarser");
static_assert(PLACE_OF(TakeRecords, spare) == 52, "place of TakeRecords::spare");

struct alignas(8) Lookup {
    Scene scene;
    Tally tally;
    SurfaceCells table;
    const LightPlace *places;
    unsigned *offsets;
    Link *links;
    unsigned count;
    unsigned first;
};
static_assert(sizeof(Lookup) == 808, "size of Lookup");
static_assert(PLACE_OF(Lookup, scene) == 0, "place of Lookup::scene");
static_assert(PLACE_OF(Lookup, tally) == 680, "place of Lookup::tally");
static_assert(PLACE_OF(Lookup, table) == 688, "place of Lookup::table");
static_assert(PLACE_OF(Lookup, places) == 776, "place of Lookup::places");
static_assert(PLACE_OF(Lookup, offsets) == 784, "place of Lookup::offsets");
static_assert(PLACE_OF(Lookup, links) == 792, "place of Lookup::links");
static_assert(PLACE_OF(Lookup, count) == 800, "place of Lookup::count");
static_assert(PLACE_OF(Lookup, first) == 804, "place of Lookup::first");

struct alignas(8) HemisphereRays {
    Scene scene;
    Rays rays;
    Sampling sampling;
    Tally tally;
    const Record *records;
    ListedRay *list;
    float *weights;
    float *areas;
    Hit *hits;
    SeenRay *seen;
    int *levels;
    float *brightness;
    const unsigned *ends;
    unsigned count;
    unsigned side;
    float reach;
    unsigned is_near;
    unsigned lamps;
    unsigned blocks;
};
static_assert(sizeof(HemisphereRays) == 944, "size of HemisphereRays");
static_assert(PLACE_OF(HemisphereRays, scene) == 0, "place of HemisphereRays::scene");
static_assert(PLACE_OF(HemisphereRays, rays) == 680, "place of HemisphereRays::rays");
static_assert(PLACE_OF(HemisphereRays, sampling) == 824, "place of HemisphereRays::sampling");
static_assert(PLACE_OF(HemisphereRays, tally) == 840, "place of HemisphereRays::tally");
static_assert(PLACE_OF(HemisphereRays, records) == 848, "place of HemisphereRays::records");
static_assert(PLACE_OF(HemisphereRays, list) == 856, "place of HemisphereRays::list");
static_assert(PLACE_OF(HemisphereRays, weights) == 864, "place of HemisphereRays::weights");
static_assert(PLACE_OF(HemisphereRays, areas) == 872, "place of HemisphereRays::areas");
static_assert(PLACE_OF(HemisphereRays, hits) == 880, "place of HemisphereRays::hits");
static_assert(PLACE_OF(HemisphereRays, seen) == 888, "place of HemisphereRays::seen");
static_assert(PLACE_OF(HemisphereRays, levels) == 896, "place of HemisphereRays::levels");
static_assert(PLACE_OF(HemisphereRays, brightness) == 904, "place of HemisphereRays::brightness");
static_assert(PLACE_OF(HemisphereRays, ends) == 912, "place of HemisphereRays::ends");
static_assert(PLACE_OF(HemisphereRays, count) == 920, "place of HemisphereRays::count");
static_assert(PLACE_OF(HemisphereRays, side) == 924, "place of HemisphereRays::side");
static_assert(PLACE_OF(HemisphereRays, reach) == 928, "place of HemisphereRays::reach");
static_assert(PLACE_OF(HemisphereRays, is_near) == 932, "place of HemisphereRays::is_near");
static_assert(PLACE_OF(HemisphereRays, lamps) == 936, "place of HemisphereRays::lamps");
static_assert(PLACE_OF(HemisphereRays, blocks) == 940, "place of HemisphereRays::blocks");

struct alignas(8) GuideRays {
    HemisphereRays hemispheres;
    const unsigned *uneven;
    unsigned *ends;
    unsigned first;
    unsigned count;
    unsigned rays;
    unsigned spare;
};
static_assert(sizeof(GuideRays) == 976, "size of GuideRays");
static_assert(PLACE_OF(GuideRays, hemispheres) == 0, "place of GuideRays::hemispheres");
static_assert(PLACE_OF(GuideRays, uneven) == 944, "place of GuideRays::uneven");
static_assert(PLACE_OF(GuideRays, ends) == 952, "place of GuideRays::ends");
static_assert(PLACE_OF(GuideRays, first) == 960, "place of GuideRays::first");
static_assert(PLACE_OF(GuideRays, count) == 964, "place of GuideRays::count");
static_assert(PLACE_OF(GuideRays, rays) == 968, "place of GuideRays::rays");
static_assert(PLACE_OF(GuideRays, spare) == 972, "place of GuideRays::spare");

struct alignas(8) ComeCloser {
    HemisphereRays hemispheres;
    Record *records;
    LightPlace *places;
};
static_assert(sizeof(ComeCloser) == 960, "size of ComeCloser");
static_assert(PLACE_OF(ComeCloser, hemispheres) == 0, "place of ComeCloser::hemispheres");
static_assert(PLACE_OF(ComeCloser, records) == 944, "place of ComeCloser::records");
static_assert(PLACE_OF(ComeCloser, places) == 952, "place of ComeCloser::places");

struct alignas(8) Bounce {
    Scene scene;
    HemisphereRays hemispheres;
    Names names;
    Node *nodes;
    Record *records;
    NodeLink *links;
    unsigned *listed;
    unsigned *listed_count;
    unsigned *unlinked;
    unsigned *unlinked_count;
    unsigned linked;
    unsigned order;
    int finer;
    unsigned first;
    unsigned count;
    unsigned insist;
};
static_assert(sizeof(Bounce) == 1744, "size of Bounce");
static_assert(PLACE_OF(Bounce, scene) == 0, "place of Bounce::scene");
static_assert(PLACE_OF(Bounce, hemispheres) == 680, "place of Bounce::hemispheres");
static_assert(PLACE_OF(Bounce, names) == 1624, "place of Bounce::names");
static_assert(PLACE_OF(Bounce, nodes) == 1664, "place of Bounce::nodes");
static_assert(PLACE_OF(Bounce, records) == 1672, "place of Bounce::records");
static_assert(PLACE_OF(Bounce, links) == 1680, "place of Bounce::links");
static_assert(PLACE_OF(Bounce, listed) == 1688, "place of Bounce::listed");
static_assert(PLACE_OF(Bounce, listed_count) == 1696, "place of Bounce::listed_count");
static_assert(PLACE_OF(Bounce, unlinked) == 1704, "place of Bounce::unlinked");
static_assert(PLACE_OF(Bounce, unlinked_count) == 1712, "place of Bounce::unlinked_count");
static_assert(PLACE_OF(Bounce, linked) == 1720, "place of Bounce::linked");
static_assert(PLACE_OF(Bounce, order) == 1724, "place of Bounce::order");
static_assert(PLACE_OF(Bounce, finer) == 1728, "place of Bounce::finer");
static_assert(PLACE_OF(Bounce, first) == 1732, "place of Bounce::first");
static_assert(PLACE_OF(Bounce, count) == 1736, "place of Bounce::count");
static_assert(PLACE_OF(Bounce, insist) == 1740, "place of Bounce::insist");

struct alignas(8) GatherCoarse {
    HemisphereRays hemispheres;
    CoarseLight *coarse;
    const unsigned *owners;
    unsigned *uneven;
    unsigned *uneven_count;
    unsigned first;
    unsigned before;
};
static_assert(sizeof(GatherCoarse) == 984, "size of GatherCoarse");
static_assert(PLACE_OF(GatherCoarse, hemispheres) == 0, "place of GatherCoarse::hemispheres");
static_assert(PLACE_OF(GatherCoarse, coarse) == 944, "place of GatherCoarse::coarse");
static_assert(PLACE_OF(GatherCoarse, owners) == 952, "place of GatherCoarse::owners");
static_assert(PLACE_OF(GatherCoarse, uneven) == 960, "place of GatherCoarse::uneven");
static_assert(PLACE_OF(GatherCoarse, uneven_count) == 968, "place of GatherCoarse::uneven_count");
static_assert(PLACE_OF(GatherCoarse, first) == 976, "place of GatherCoarse::first");
static_assert(PLACE_OF(GatherCoarse, before) == 980, "place of GatherCoarse::before");

struct alignas(8) GatherFine {
    HemisphereRays hemispheres;
    Lookup lookup;
    const CoarseLight *coarse;
    SurfaceLight *fine;
    unsigned *misses;
    unsigned *miss_count;
    unsigned first;
    unsigned first_miss;
    unsigned count;
    unsigned spare;
};
static_assert(sizeof(GatherFine) == 1800, "size of GatherFine");
static_assert(PLACE_OF(GatherFine, hemispheres) == 0, "place of GatherFine::hemispheres");
static_assert(PLACE_OF(GatherFine, lookup) == 944, "place of GatherFine::lookup");
static_assert(PLACE_OF(GatherFine, coarse) == 1752, "place of GatherFine::coarse");
static_assert(PLACE_OF(GatherFine, fine) == 1760, "place of GatherFine::fine");
static_assert(PLACE_OF(GatherFine, misses) == 1768, "place of GatherFine::misses");
static_assert(PLACE_OF(GatherFine, miss_count) == 1776, "place of GatherFine::miss_count");
static_assert(PLACE_OF(GatherFine, first) == 1784, "place of GatherFine::first");
static_assert(PLACE_OF(GatherFine, first_miss) == 1788, "place of GatherFine::first_miss");
static_assert(PLACE_OF(GatherFine, count) == 1792, "place of GatherFine::count");
static_assert(PLACE_OF(GatherFine, spare) == 1796, "place of GatherFine::spare");

struct alignas(8) GatherPoints {
    Scene scene;
    Rays rays;
    const Hit *hits;
    Lookup lookup;
    const SurfaceLight *fine;
    LightPlace *places;
    Vec3 *means;
    unsigned *misses;
    unsigned *miss_count;
    Record *records;
    LightPlace *asked;
    const SurfaceLight *own;
    const CoarseLight *coarse;
    Vec3 *light;
    Vec3 *normals;
    const Hit *samples;
    unsigned long long sampled_pixels;
    unsigned sample_count;
    unsigned first_sampled;
    Vec3 eye;
    float spacing[2];
    float pixels;
    int least_level;
    unsigned first;
    unsigned count;
    unsigned first_miss;
    unsigned brute_force;
    unsigned spare;
};
static_assert(sizeof(GatherPoints) == 1800, "size of GatherPoints");
static_assert(PLACE_OF(GatherPoints, scene) == 0, "place of GatherPoints::scene");
static_assert(PLACE_OF(GatherPoints, rays) == 680, "place of GatherPoints::rays");
static_assert(PLACE_OF(GatherPoints, hits) == 824, "place of GatherPoints::hits");
static_assert(PLACE_OF(GatherPoints, lookup) == 832, "place of GatherPoints::lookup");
static_assert(PLACE_OF(GatherPoints, fine) == 1640, "place of GatherPoints::fine");
static_assert(PLACE_OF(GatherPoints, places) == 1648, "place of GatherPoints::places");
static_assert(PLACE_OF(GatherPoints, means) == 1656, "place of GatherPoints::means");
static_assert(PLACE_OF(GatherPoints, misses) == 1664, "place of GatherPoints::misses");
static_assert(PLACE_OF(GatherPoints, miss_count) == 1672, "place of GatherPoints::miss_count");
static_assert(PLACE_OF(GatherPoints, records) == 1680, "place of GatherPoints::records");
static_assert(PLACE_OF(GatherPoints, asked) == 1688, "place of GatherPoints::asked");
static_assert(PLACE_OF(GatherPoints, own) == 1696, "place of GatherPoints::own");
static_assert(PLACE_OF(GatherPoints, coarse) == 1704, "place of GatherPoints::coarse");
static_assert(PLACE_OF(GatherPoints, light) == 1712, "place of GatherPoints::light");
static_assert(PLACE_OF(GatherPoints, normals) == 1720, "place of GatherPoints::normals");
static_assert(PLACE_OF(GatherPoints, samples) == 1728, "place of GatherPoints::samples");
static_assert(PLACE_OF(GatherPoints, sampled_pixels) == 1736, "place of GatherPoints::sampled_pixels");
static_assert(PLACE_OF(GatherPoints, sample_count) == 1744, "place of GatherPoints::sample_count");
static_assert(PLACE_OF(GatherPoints, first_sampled) == 1748, "place of GatherPoints::first_sampled");
static_assert(PLACE_OF(GatherPoints, eye) == 1752, "place of GatherPoints::eye");
static_assert(PLACE_OF(GatherPoints, spacing) == 1764, "place of GatherPoints::spacing");
static_assert(PLACE_OF(GatherPoints, pixels) == 1772, "place of GatherPoints::pixels");
static_assert(PLACE_OF(GatherPoints, least_level) == 1776, "place of GatherPoints::least_level");
static_assert(PLACE_OF(GatherPoints, first) == 1780, "place of GatherPoints::first");
static_assert(PLACE_OF(GatherPoints, count) == 1784, "place of GatherPoints::count");
static_assert(PLACE_OF(GatherPoints, first_miss) == 1788, "place of GatherPoints::first_miss");
static_assert(PLACE_OF(GatherPoints, brute_force) == 1792, "place of GatherPoints::brute_force");
static_assert(PLACE_OF(GatherPoints, spare) == 1796, "place of GatherPoints::spare");

struct alignas(4) TileBox {
    Vec3 low;
    Vec3 high;
};
static_assert(sizeof(TileBox) == 24, "size of TileBox");
static_assert(PLACE_OF(TileBox, low) == 0, "place of TileBox::low");
static_assert(PLACE_OF(TileBox, high) == 12, "place of TileBox::high");

struct alignas(8) GroupBundles {
    Scene scene;
    Rays rays;
    const Hit *hits;
    unsigned *members;
    unsigned short *ends;
    unsigned *counts;
    unsigned long long *bundles;
    TileBox *tiles;
    unsigned long long first_block;
    float spacing[2];
};
static_assert(sizeof(GroupBundles) == 888, "size of GroupBundles");
static_assert(PLACE_OF(GroupBundles, scene) == 0, "place of GroupBundles::scene");
static_assert(PLACE_OF(GroupBundles, rays) == 680, "place of GroupBundles::rays");
static_assert(PLACE_OF(GroupBundles, hits) == 824, "place of GroupBundles::hits");
static_assert(PLACE_OF(GroupBundles, members) == 832, "place of GroupBundles::members");
static_assert(PLACE_OF(GroupBundles, ends) == 840, "place of GroupBundles::ends");
static_assert(PLACE_OF(GroupBundles, counts) == 848, "place of GroupBundles::counts");
static_assert(PLACE_OF(GroupBundles, bundles) == 856, "place of GroupBundles::bundles");
static_assert(PLACE_OF(GroupBundles, tiles) == 864, "place of GroupBundles::tiles");
static_assert(PLACE_OF(GroupBundles, first_block) == 872, "place of GroupBundles::first_block");
static_assert(PLACE_OF(GroupBundles, spacing) == 880, "place of GroupBundles::spacing");

struct alignas(4) Weighed {
    unsigned above;
    unsigned seen;
    float all;
    float lit;
};
static_assert(sizeof(Weighed) == 16, "size of Weighed");
static_assert(PLACE_OF(Weighed, above) == 0, "place of Weighed::above");
static_assert(PLACE_OF(Weighed, seen) == 4, "place of Weighed::seen");
static_assert(PLACE_OF(Weighed, all) == 8, "place of Weighed::all");
static_assert(PLACE_OF(Weighed, lit) == 12, "place of Weighed::lit");

struct alignas(8) Shadows {
    Scene scene;
    Rays rays;
    const Hit *hits;
    const unsigned *members;
    const unsigned long long *bundles;
    const TileBox *tiles;
    unsigned *starts;
    unsigned *taken;
    float *share;
    Weighed *weighed;
    Sampling sampling;
    Tally tally;
    unsigned long long first;
    unsigned long long count;
    SampleRows sets[2];
    unsigned set;
    unsigned set_count;
    unsigned first_light;
    unsigned end_light;
};
static_assert(sizeof(Shadows) == 2272, "size of Shadows");
static_assert(PLACE_OF(Shadows, scene) == 0, "place of Shadows::scene");
static_assert(PLACE_OF(Shadows, rays) == 680, "place of Shadows::rays");
static_assert(PLACE_OF(Shadows, hits) == 824, "place of Shadows::hits");
static_assert(PLACE_OF(Shadows, members) == 832, "place of Shadows::members");
static_assert(PLACE_OF(Shadows, bundles) == 840, "place of Shadows::bundles");
static_assert(PLACE_OF(Shadows, tiles) == 848, "place of Shadows::tiles");
static_assert(PLACE_OF(Shadows, starts) == 856, "place of Shadows::starts");
static_assert(PLACE_OF(Shadows, taken) == 864, "place of Shadows::taken");
static_assert(PLACE_OF(Shadows, share) == 872, "place of Shadows::share");
static_assert(PLACE_OF(Shadows, weighed) == 880, "place of Shadows::weighed");
static_assert(PLACE_OF(Shadows, sampling) == 888, "place of Shadows::sampling");
static_assert(PLACE_OF(Shadows, tally) == 904, "place of Shadows::tally");
static_assert(PLACE_OF(Shadows, first) == 912, "place of Shadows::first");
static_assert(PLACE_OF(Shadows, count) == 920, "place of Shadows::count");
static_assert(PLACE_OF(Shadows, sets) == 928, "place of Shadows::sets");
static_assert(PLACE_OF(Shadows, set) == 2256, "place of Shadows::set");
static_assert(PLACE_OF(Shadows, set_count) == 2260, "place of Shadows::set_count");
static_assert(PLACE_OF(Shadows, first_light) == 2264, "place of Shadows::first_light");
static_assert(PLACE_OF(Shadows, end_light) == 2268, "place of Shadows::end_light");

struct alignas(8) Transmittance {
    Scene scene;
    Shadows shadows;
    Triangles triangles;
    const Vec3 *normals;
    Vec3 *passed;
    unsigned middle;
    unsigned level;
    unsigned parts;
    unsigned spare;
};
static_assert(sizeof(Transmittance) == 3008, "size of Transmittance");
static_assert(PLACE_OF(Transmittance, scene) == 0, "place of Transmittance::scene");
static_assert(PLACE_OF(Transmittance, shadows) == 680, "place of Transmittance::shadows");
static_assert(PLACE_OF(Transmittance, triangles) == 2952, "place of Transmittance::triangles");
static_assert(PLACE_OF(Transmittance, normals) == 2976, "place of Transmittance::normals");
static_assert(PLACE_OF(Transmittance, passed) == 2984, "place of Transmittance::passed");
static_assert(PLACE_OF(Transmittance, middle) == 2992, "place of Transmittance::middle");
static_assert(PLACE_OF(Transmittance, level) == 2996, "place of Transmittance::level");
static_assert(PLACE_OF(Transmittance, parts) == 3000, "place of Transmittance::parts");
static_assert(PLACE_OF(Transmittance, spare) == 3004, "place of Transmittance::spare");

struct alignas(8) AdaptiveShadows {
    Scene scene;
    Shadows shadows;
    unsigned char *answers;
    unsigned long long answer_count;
    unsigned long long first_answer;
    unsigned *counts;
    unsigned long long *entries;
    unsigned long long entry_count;
    float places[2][25][2];
    unsigned tiles;
    unsigned spare;
};
static_assert(sizeof(AdaptiveShadows) == 3408, "size of AdaptiveShadows");
static_assert(PLACE_OF(AdaptiveShadows, scene) == 0, "place of AdaptiveShadows::scene");
static_assert(PLACE_OF(AdaptiveShadows, shadows) == 680, "place of AdaptiveShadows::shadows");
static_assert(PLACE_OF(AdaptiveShadows, answers) == 2952, "place of AdaptiveShadows::answers");
static_assert(PLACE_OF(AdaptiveShadows, answer_count) == 2960, "place of AdaptiveShadows::answer_count");
static_assert(PLACE_OF(AdaptiveShadows, first_answer) == 2968, "place of AdaptiveShadows::first_answer");
static_assert(PLACE_OF(AdaptiveShadows, counts) == 2976, "place of AdaptiveShadows::counts");
static_assert(PLACE_OF(AdaptiveShadows, entries) == 2984, "place of AdaptiveShadows::entries");
static_assert(PLACE_OF(AdaptiveShadows, entry_count) == 2992, "place of AdaptiveShadows::entry_count");
static_assert(PLACE_OF(AdaptiveShadows, places) == 3000, "place of AdaptiveShadows::places");
static_assert(PLACE_OF(AdaptiveShadows, tiles) == 3400, "place of AdaptiveShadows::tiles");
static_assert(PLACE_OF(AdaptiveShadows, spare) == 3404, "place of AdaptiveShadows::spare");

struct alignas(8) PrimaryRays {
    Scene scene;
    Rays rays;
    Hit *hits;
    Tally tally;
    unsigned long long first_block;
};
static_assert(sizeof(PrimaryRays) == 848, "size of PrimaryRays");
static_assert(PLACE_OF(PrimaryRays, scene) == 0, "place of PrimaryRays::scene");
static_assert(PLACE_OF(PrimaryRays, rays) == 680, "place of PrimaryRays::rays");
static_assert(PLACE_OF(PrimaryRays, hits) == 824, "place of PrimaryRays::hits");
static_assert(PLACE_OF(PrimaryRays, tally) == 832, "place of PrimaryRays::tally");
static_assert(PLACE_OF(PrimaryRays, first_block) == 840, "place of PrimaryRays::first_block");

struct alignas(8) ShadowRays {
    Scene scene;
    Rays rays;
    const Hit *hits;
    float *share;
    Tally tally;
    unsigned long long first_block;
    unsigned first_light;
    unsigned light_count;
};
static_assert(sizeof(ShadowRays) == 864, "size of ShadowRays");
static_assert(PLACE_OF(ShadowRays, scene) == 0, "place of ShadowRays::scene");
static_assert(PLACE_OF(ShadowRays, rays) == 680, "place of ShadowRays::rays");
static_assert(PLACE_OF(ShadowRays, hits) == 824, "place of ShadowRays::hits");
static_assert(PLACE_OF(ShadowRays, share) == 832, "place of ShadowRays::share");
static_assert(PLACE_OF(ShadowRays, tally) == 840, "place of ShadowRays::tally");
static_assert(PLACE_OF(ShadowRays, first_block) == 848, "place of ShadowRays::first_block");
static_assert(PLACE_OF(ShadowRays, first_light) == 856, "place of ShadowRays::first_light");
static_assert(PLACE_OF(ShadowRays, light_count) == 860, "place of ShadowRays::light_count");

struct alignas(8) Shade {
    Scene scene;
    Rays rays;
    const Hit *hits;
    const float *share;
    const Vec3 *passed;
    const unsigned *used;
    const Vec3 *gathered;
    unsigned long long film_pixel;
    Vec3 *color;
    Vec3 *sums;
    float *caught;
    float *ray_caught;
    const Hit *samples;
    float *depth;
    Vec3 *normal;
    Vec3 *position;
    float *visibility;
    unsigned *light_points;
    Vec3 *light_groups;
    unsigned *ids;
    unsigned long long film_pixels;
    unsigned long long first_block;
    unsigned first_light;
    unsigned end_light;
    unsigned several;
    unsigned sampled;
    unsigned sample_count;
    unsigned first_sampled;
    unsigned long long sampled_pixels;
    unsigned catches;
    unsigned weighed;
};
static_assert(sizeof(Shade) == 1024, "size of Shade");
static_assert(PLACE_OF(Shade, scene) == 0, "place of Shade::scene");
static_assert(PLACE_OF(Shade, rays) == 680, "place of Shade::rays");
static_assert(PLACE_OF(Shade, hits) == 824, "place of Shade::hits");
static_assert(PLACE_OF(Shade, share) == 832, "place of Shade::share");
static_assert(PLACE_OF(Shade, passed) == 840, "place of Shade::passed");
static_assert(PLACE_OF(Shade, used) == 848, "place of Shade::used");
static_assert(PLACE_OF(Shade, gathered) == 856, "place of Shade::gathered");
static_assert(PLACE_OF(Shade, film_pixel) == 864, "place of Shade::film_pixel");
static_assert(PLACE_OF(Shade, color) == 872, "place of Shade::color");
static_assert(PLACE_OF(Shade, sums) == 880, "place of Shade::sums");
static_assert(PLACE_OF(Shade, caught) == 888, "place of Shade::caught");
static_assert(PLACE_OF(Shade, ray_caught) == 896, "place of Shade::ray_caught");
static_assert(PLACE_OF(Shade, samples) == 904, "place of Shade::samples");
static_assert(PLACE_OF(Shade, depth) == 912, "place of Shade::depth");
static_assert(PLACE_OF(Shade, normal) == 920, "place of Shade::normal");
static_assert(PLACE_OF(Shade, position) == 928, "place of Shade::position");
static_assert(PLACE_OF(Shade, visibility) == 936, "place of Shade::visibility");
static_assert(PLACE_OF(Shade, light_points) == 944, "place of Shade::light_points");
static_assert(PLACE_OF(Shade, light_groups) == 952, "place of Shade::light_groups");
static_assert(PLACE_OF(Shade, ids) == 960, "place of Shade::ids");
static_assert(PLACE_OF(Shade, film_pixels) == 968, "place of Shade::film_pixels");
static_assert(PLACE_OF(Shade, first_block) == 976, "place of Shade::first_block");
static_assert(PLACE_OF(Shade, first_light) == 984, "place of Shade::first_light");
static_assert(PLACE_OF(Shade, end_light) == 988, "place of Shade::end_light");
static_assert(PLACE_OF(Shade, several) == 992, "place of Shade::several");
static_assert(PLACE_OF(Shade, sampled) == 996, "place of Shade::sampled");
static_assert(PLACE_OF(Shade, sample_count) == 1000, "place of Shade::sample_count");
static_assert(PLACE_OF(Shade, first_sampled) == 1004, "place of Shade::first_sampled");
static_assert(PLACE_OF(Shade, sampled_pixels) == 1008, "place of Shade::sampled_pixels");
static_assert(PLACE_OF(Shade, catches) == 1016, "place of Shade::catches");
static_assert(PLACE_OF(Shade, weighed) == 1020, "place of Shade::weighed");

struct alignas(8) PixelSamples {
    Scene scene;
    Rays rays;
    Hit *hits;
    Hit *centers;
    unsigned *state;
    unsigned char *owners;
    Vec3 *color;
    unsigned *counts[3];
    ListedRay *fragments[3];
    Hit *fragment_hits[3];
    float *coverage;
    float *caught;
    float *depth;
    Vec3 *normal;
    Vec3 *position;
    float *visibility;
    unsigned *light_points;
    Vec3 *light_groups;
    unsigned *ids;
    unsigned *mattes;
    Tally tally;
    unsigned long long first_block;
    unsigned long long seed;
    unsigned long long film_pixels;
    float spacing[2];
    unsigned samples[2];
    unsigned inner[2];
    unsigned all_samples;
    unsigned together;
    unsigned lanes;
    unsigned light_count;
    float weight;
    float contrast;
    unsigned apart;
    unsigned mirrors;
    unsigned keeps;
    unsigned matte_slots;
    float quantiles[64];
};
static_assert(sizeof(PixelSamples) == 1368, "size of PixelSamples");
static_assert(PLACE_OF(PixelSamples, scene) == 0, "place of PixelSamples::scene");
static_assert(PLACE_OF(PixelSamples, rays) == 680, "place of PixelSamples::rays");
static_assert(PLACE_OF(PixelSamples, hits) == 824, "place of PixelSamples::hits");
static_assert(PLACE_OF(PixelSamples, centers) == 832, "place of PixelSamples::centers");
static_assert(PLACE_OF(PixelSamples, state) == 840, "place of PixelSamples::state");
static_assert(PLACE_OF(PixelSamples, owners) == 848, "place of PixelSamples::owners");
static_assert(PLACE_OF(PixelSamples, color) == 856, "place of PixelSamples::color");
static_assert(PLACE_OF(PixelSamples, counts) == 864, "place of PixelSamples::counts");
static_assert(PLACE_OF(PixelSamples, fragments) == 888, "place of PixelSamples::fragments");
static_assert(PLACE_OF(PixelSamples, fragment_hits) == 912, "place of PixelSamples::fragment_hits");
static_assert(PLACE_OF(PixelSamples, coverage) == 936, "place of PixelSamples::coverage");
static_assert(PLACE_OF(PixelSamples, caught) == 944, "place of PixelSamples::caught");
static_assert(PLACE_OF(PixelSamples, depth) == 952, "place of PixelSamples::depth");
static_assert(PLACE_OF(PixelSamples, normal) == 960, "place of PixelSamples::normal");
static_assert(PLACE_OF(PixelSamples, position) == 968, "place of PixelSamples::position");
static_assert(PLACE_OF(PixelSamples, visibility) == 976, "place of PixelSamples::visibility");
static_assert(PLACE_OF(PixelSamples, light_points) == 984, "place of PixelSamples::light_points");
static_assert(PLACE_OF(PixelSamples, light_groups) == 992, "place of PixelSamples::light_groups");
static_assert(PLACE_OF(PixelSamples, ids) == 1000, "place of PixelSamples::ids");
static_assert(PLACE_OF(PixelSamples, mattes) == 1008, "place of PixelSamples::mattes");
static_assert(PLACE_OF(PixelSamples, tally) == 1016, "place of PixelSamples::tally");
static_assert(PLACE_OF(PixelSamples, first_block) == 1024, "place of PixelSamples::first_block");
static_assert(PLACE_OF(PixelSamples, seed) == 1032, "place of PixelSamples::seed");
static_assert(PLACE_OF(PixelSamples, film_pixels) == 1040, "place of PixelSamples::film_pixels");
static_assert(PLACE_OF(PixelSamples, spacing) == 1048, "place of PixelSamples::spacing");
static_assert(PLACE_OF(PixelSamples, samples) == 1056, "place of PixelSamples::samples");
static_assert(PLACE_OF(PixelSamples, inner) == 1064, "place of PixelSamples::inner");
static_assert(PLACE_OF(PixelSamples, all_samples) == 1072, "place of PixelSamples::all_samples");
static_assert(PLACE_OF(PixelSamples, together) == 1076, "place of PixelSamples::together");
static_assert(PLACE_OF(PixelSamples, lanes) == 1080, "place of PixelSamples::lanes");
static_assert(PLACE_OF(PixelSamples, light_count) == 1084, "place of PixelSamples::light_count");
static_assert(PLACE_OF(PixelSamples, weight) == 1088, "place of PixelSamples::weight");
static_assert(PLACE_OF(PixelSamples, contrast) == 1092, "place of PixelSamples::contrast");
static_assert(PLACE_OF(PixelSamples, apart) == 1096, "place of PixelSamples::apart");
static_assert(PLACE_OF(PixelSamples, mirrors) == 1100, "place of PixelSamples::mirrors");
static_assert(PLACE_OF(PixelSamples, keeps) == 1104, "place of PixelSamples::keeps");
static_assert(PLACE_OF(PixelSamples, matte_slots) == 1108, "place of PixelSamples::matte_slots");
static_assert(PLACE_OF(PixelSamples, quantiles) == 1112, "place of PixelSamples::quantiles");

struct alignas(8) MirrorRays {
    Scene scene;
    Rays rays;
    const Hit *hits;
    unsigned *counts;
    unsigned *thin;
    unsigned *per_ray;
    unsigned long long seed;
    unsigned long long pixel_samples;
    ListedRay *onward;
    Cone *cones;
};
static_assert(sizeof(MirrorRays) == 888, "size of MirrorRays");
static_assert(PLACE_OF(MirrorRays, scene) == 0, "place of MirrorRays::scene");
static_assert(PLACE_OF(MirrorRays, rays) == 680, "place of MirrorRays::rays");
static_assert(PLACE_OF(MirrorRays, hits) == 824, "place of MirrorRays::hits");
static_assert(PLACE_OF(MirrorRays, counts) == 832, "place of MirrorRays::counts");
static_assert(PLACE_OF(MirrorRays, thin) == 840, "place of MirrorRays::thin");
static_assert(PLACE_OF(MirrorRays, per_ray) == 848, "place of MirrorRays::per_ray");
static_assert(PLACE_OF(MirrorRays, seed) == 856, "place of MirrorRays::seed");
static_assert(PLACE_OF(MirrorRays, pixel_samples) == 864, "place of MirrorRays::pixel_samples");
static_assert(PLACE_OF(MirrorRays, onward) == 872, "place of MirrorRays::onward");
static_assert(PLACE_OF(MirrorRays, cones) == 880, "place of MirrorRays::cones");

struct alignas(8) MergedRays {
    Scene scene;
    Rays rays;
    const Hit *hits;
    unsigned *merged;
    unsigned *counts;
    ListedRay *left;
    Hit *left_hits;
    Cone *cones;
    float spacing[2];
};
static_assert(sizeof(MergedRays) == 880, "size of MergedRays");
static_assert(PLACE_OF(MergedRays, scene) == 0, "place of MergedRays::scene");
static_assert(PLACE_OF(MergedRays, rays) == 680, "place of MergedRays::rays");
static_assert(PLACE_OF(MergedRays, hits) == 824, "place of MergedRays::hits");
static_assert(PLACE_OF(MergedRays, merged) == 832, "place of MergedRays::merged");
static_assert(PLACE_OF(MergedRays, counts) == 840, "place of MergedRays::counts");
static_assert(PLACE_OF(MergedRays, left) == 848, "place of MergedRays::left");
static_assert(PLACE_OF(MergedRays, left_hits) == 856, "place of MergedRays::left_hits");
static_assert(PLACE_OF(MergedRays, cones) == 864, "place of MergedRays::cones");
static_assert(PLACE_OF(MergedRays, spacing) == 872, "place of MergedRays::spacing");

struct alignas(8) GroupCells {
    Scene scene;
    Rays rays;
    const Hit *hits;
    LightMesh mesh;
    unsigned *members;
    Bundle *tile_bundles;
    unsigned *counts;
    Bundle *bundles;
    unsigned long long first_block;
};
static_assert(sizeof(GroupCells) == 952, "size of GroupCells");
static_assert(PLACE_OF(GroupCells, scene) == 0, "place of GroupCells::scene");
static_assert(PLACE_OF(GroupCells, rays) == 680, "place of GroupCells::rays");
static_assert(PLACE_OF(GroupCells, hits) == 824, "place of GroupCells::hits");
static_assert(PLACE_OF(GroupCells, mesh) == 832, "place of GroupCells::mesh");
static_assert(PLACE_OF(GroupCells, members) == 912, "place of GroupCells::members");
static_assert(PLACE_OF(GroupCells, tile_bundles) == 920, "place of GroupCells::tile_bundles");
static_assert(PLACE_OF(GroupCells, counts) == 928, "place of GroupCells::counts");
static_assert(PLACE_OF(GroupCells, bundles) == 936, "place of GroupCells::bundles");
static_assert(PLACE_OF(GroupCells, first_block) == 944, "place of GroupCells::first_block");

struct alignas(8) ShortTests {
    Scene scene;
    Rays rays;
    const Hit *hits;
    LightMesh mesh;
    const unsigned *members;
    const Bundle *bundles;
    unsigned *masks;
    Tally tally;
    unsigned long long first_bundle;
    unsigned long long bundle_count;
};
static_assert(sizeof(ShortTests) == 960, "size of ShortTests");
static_assert(PLACE_OF(ShortTests, scene) == 0, "place of ShortTests::scene");
static_assert(PLACE_OF(ShortTests, rays) == 680, "place of ShortTests::rays");
static_assert(PLACE_OF(ShortTests, hits) == 824, "place of ShortTests::hits");
static_assert(PLACE_OF(ShortTests, mesh) == 832, "place of ShortTests::mesh");
static_assert(PLACE_OF(ShortTests, members) == 912, "place of ShortTests::members");
static_assert(PLACE_OF(ShortTests, bundles) == 920, "place of ShortTests::bundles");
static_assert(PLACE_OF(ShortTests, masks) == 928, "place of ShortTests::masks");
static_assert(PLACE_OF(ShortTests, tally) == 936, "place of ShortTests::tally");
static_assert(PLACE_OF(ShortTests, first_bundle) == 944, "place of ShortTests::first_bundle");
static_assert(PLACE_OF(ShortTests, bundle_count) == 952, "place of ShortTests::bundle_count");

struct alignas(8) LightPoints {
    LightMesh mesh;
    const Bundle *bundles;
    const unsigned *masks;
    unsigned long long *marks;
    unsigned long long first_bundle;
    unsigned long long bundle_count;
    BrickTable table;
    unsigned long long *used;
    unsigned *rank;
    unsigned long long *points;
    unsigned *bricks;
    unsigned *slots;
};
static_assert(sizeof(LightPoints) == 176, "size of LightPoints");
static_assert(PLACE_OF(LightPoints, mesh) == 0, "place of LightPoints::mesh");
static_assert(PLACE_OF(LightPoints, bundles) == 80, "place of LightPoints::bundles");
static_assert(PLACE_OF(LightPoints, masks) == 88, "place of LightPoints::masks");
static_assert(PLACE_OF(LightPoints, marks) == 96, "place of LightPoints::marks");
static_assert(PLACE_OF(LightPoints, first_bundle) == 104, "place of LightPoints::first_bundle");
static_assert(PLACE_OF(LightPoints, bundle_count) == 112, "place of LightPoints::bundle_count");
static_assert(PLACE_OF(LightPoints, table) == 120, "place of LightPoints::table");
static_assert(PLACE_OF(LightPoints, used) == 136, "place of LightPoints::used");
static_assert(PLACE_OF(LightPoints, rank) == 144, "place of LightPoints::rank");
static_assert(PLACE_OF(LightPoints, points) == 152, "place of LightPoints::points");
static_assert(PLACE_OF(LightPoints, bricks) == 160, "place of LightPoints::bricks");
static_assert(PLACE_OF(LightPoints, slots) == 168, "place of LightPoints::slots");

struct alignas(8) LongTests {
    Scene scene;
    LightMesh mesh;
    UsedPoints points;
    VisibilityOfLight lit;
    Sampling sampling;
    Tally tally;
    unsigned light;
    unsigned point_count;
    unsigned long long first_point;
    unsigned first_sample;
    unsigned sample_count;
};
static_assert(sizeof(LongTests) == 864, "size of LongTests");
static_assert(PLACE_OF(LongTests, scene) == 0, "place of LongTests::scene");
static_assert(PLACE_OF(LongTests, mesh) == 680, "place of LongTests::mesh");
static_assert(PLACE_OF(LongTests, points) == 760, "place of LongTests::points");
static_assert(PLACE_OF(LongTests, lit) == 800, "place of LongTests::lit");
static_assert(PLACE_OF(LongTests, sampling) == 816, "place of LongTests::sampling");
static_assert(PLACE_OF(LongTests, tally) == 832, "place of LongTests::tally");
static_assert(PLACE_OF(LongTests, light) == 840, "place of LongTests::light");
static_assert(PLACE_OF(LongTests, point_count) == 844, "place of LongTests::point_count");
static_assert(PLACE_OF(LongTests, first_point) == 848, "place of LongTests::first_point");
static_assert(PLACE_OF(LongTests, first_sample) == 856, "place of LongTests::first_sample");
static_assert(PLACE_OF(LongTests, sample_count) == 860, "place of LongTests::sample_count");

struct alignas(8) Cache {
    UsedPoints points;
    BrickTable table;
    unsigned *bricks;
    unsigned *ages;
    unsigned *rows;
    KeptBy kept;
    VisibilityOfLight lit;
    unsigned long long *unknown;
    BrickTable from_table;
    unsigned *from_ages;
    KeptBy from;
    unsigned image;
    unsigned spare;
};
static_assert(sizeof(Cache) == 184, "size of Cache");
static_assert(PLACE_OF(Cache, points) == 0, "place of Cache::points");
static_assert(PLACE_OF(Cache, table) == 40, "place of Cache::table");
static_assert(PLACE_OF(Cache, bricks) == 56, "place of Cache::bricks");
static_assert(PLACE_OF(Cache, ages) == 64, "place of Cache::ages");
static_assert(PLACE_OF(Cache, rows) == 72, "place of Cache::rows");
static_assert(PLACE_OF(Cache, kept) == 80, "place of Cache::kept");
static_assert(PLACE_OF(Cache, lit) == 104, "place of Cache::lit");
static_assert(PLACE_OF(Cache, unknown) == 120, "place of Cache::unknown");
static_assert(PLACE_OF(Cache, from_table) == 128, "place of Cache::from_table");
static_assert(PLACE_OF(Cache, from_ages) == 144, "place of Cache::from_ages");
static_assert(PLACE_OF(Cache, from) == 152, "place of Cache::from");
static_assert(PLACE_OF(Cache, image) == 176, "place of Cache::image");
static_assert(PLACE_OF(Cache, spare) == 180, "place of Cache::spare");

struct alignas(8) Interpolate {
    Scene scene;
    Rays rays;
    const Hit *hits;
    LightMesh mesh;
    const unsigned *members;
    const Bundle *bundles;
    const unsigned *masks;
    UsedPoints points;
    const unsigned *slots;
    const VisibilityOfLight *lit;
    float *share;
    unsigned *used;
    unsigned *fallback_rays;
    unsigned *fallback_count;
    Sampling sampling;
    Tally tally;
    unsigned long long first;
    unsigned long long count;
};
static_assert(sizeof(Interpolate) == 1064, "size of Interpolate");
static_assert(PLACE_OF(Interpolate, scene) == 0, "place of Interpolate::scene");
static_assert(PLACE_OF(Interpolate, rays) == 680, "place of Interpolate::rays");
static_assert(PLACE_OF(Interpolate, hits) == 824, "place of Interpolate::hits");
static_assert(PLACE_OF(Interpolate, mesh) == 832, "place of Interpolate::mesh");
static_assert(PLACE_OF(Interpolate, members) == 912, "place of Interpolate::members");
static_assert(PLACE_OF(Interpolate, bundles) == 920, "place of Interpolate::bundles");
static_assert(PLACE_OF(Interpolate, masks) == 928, "place of Interpolate::masks");
static_assert(PLACE_OF(Interpolate, points) == 936, "place of Interpolate::points");
static_assert(PLACE_OF(Interpolate, slots) == 976, "place of Interpolate::slots");
static_assert(PLACE_OF(Interpolate, lit) == 984, "place of Interpolate::lit");
static_assert(PLACE_OF(Interpolate, share) == 992, "place of Interpolate::share");
static_assert(PLACE_OF(Interpolate, used) == 1000, "place of Interpolate::used");
static_assert(PLACE_OF(Interpolate, fallback_rays) == 1008, "place of Interpolate::fallback_rays");
static_assert(PLACE_OF(Interpolate, fallback_count) == 1016, "place of Interpolate::fallback_count");
static_assert(PLACE_OF(Interpolate, sampling) == 1024, "place of Interpolate::sampling");
static_assert(PLACE_OF(Interpolate, tally) == 1040, "place of Interpolate::tally");
static_assert(PLACE_OF(Interpolate, first) == 1048, "place of Interpolate::first");
static_assert(PLACE_OF(Interpolate, count) == 1056, "place of Interpolate::count");

struct alignas(8) Scan {
    unsigned *values;
    unsigned *sums;
    unsigned long long count;
};
static_assert(sizeof(Scan) == 24, "size of Scan");
static_assert(PLACE_OF(Scan, values) == 0, "place of Scan::values");
static_assert(PLACE_OF(Scan, sums) == 8, "place of Scan::sums");
static_assert(PLACE_OF(Scan, count) == 16, "place of Scan::count");

struct alignas(8) Copy {
    const unsigned *from;
    unsigned *to;
    unsigned long long count;
};
static_assert(sizeof(Copy) == 24, "size of Copy");
static_assert(PLACE_OF(Copy, from) == 0, "place of Copy::from");
static_assert(PLACE_OF(Copy, to) == 8, "place of Copy::to");
static_assert(PLACE_OF(Copy, count) == 16, "place of Copy::count");
