// The shared memory of a warp that tests by cell.
#pragma once

#include "accel/search.cuh"
#include "stages/short_tests/cell_bundle.cuh"

// Follows the last target.
#define NO_TARGET 0xffffffffu

// A triangle that can matter: its corners, and all q - P with q on it and P an origin of the bundle.
struct Candidate {
    // The w components hold the packed box of light points that it can hide, then low and high x of q - P.
    float4 corners[3];
    // Low and high y, low and high z, and their reciprocals.
    float4 span_yz, inverse_yz;
    // The largest factor by which its shadow is stretched, the reciprocal of the number of lines in a plane of its box, and the number of its
    // opacities if it is cut out, else 0.
    float4 most;
};

// A light point that a candidate may hide: its position, and its template point and its candidate, packed.
typedef float4 Target;

static_assert(sizeof(Candidate) == 4 * CANDIDATE_WORDS, "words of a candidate");
static_assert(sizeof(Target) == 4 * TARGET_WORDS, "words of a target");

// The shared memory of one warp.
struct CellMemory {
    // For each template point, the lanes that see it. In global memory if the template is too large.
    unsigned *seen;
    Candidate *candidates;
    Target *targets;
    PlanesMemory *planes;
    // Triangles found but not yet processed, and the memory of the search for more.
    unsigned *found;
    unsigned *search;
};

// Divides a block's shared memory, as `shared_words` in cuda.rs counts it. A block is one warp: bundles differ in cost, and a block
// keeps its place until its last warp is done. Whether masks are kept in it is a template parameter, so that the compiler knows
// what kind of memory they are in.
template <bool SHARED_MASKS, class Structure>
DEVICE CellMemory cell_memory(const ShortTests &args, const Structure &structure, unsigned *shared, unsigned long long bundle) {
    const unsigned candidates = CANDIDATE_WORDS * CANDIDATES, targets = TARGET_WORDS * (LISTED_TARGETS + 1);
    CellMemory memory;
    memory.candidates = (Candidate *)shared;
    memory.targets = (Target *)(shared + candidates);
    memory.planes = (PlanesMemory *)(shared + candidates + targets);
    memory.found = shared + candidates + targets + PLANE_WORDS;
    memory.search = memory.found + FOUND_TRIANGLES;
    memory.seen = SHARED_MASKS ? memory.search + search_words(structure) : args.masks + bundle * 32 * args.mesh.words;
    return memory;
}

DEVICE Vec3 corner_of(const float4 &corner) { return Vec3{corner.x, corner.y, corner.z}; }
