// The search for all triangles that meet a region, by a warp: twin of `triangles_in` of the trait in mod.rs.
//
// Every function exists for each of the structures:
//
//     unsigned search_words(structure);                       // words of shared memory that a search takes, a multiple of four
//     auto search = begin_search(structure, region, memory);  // `memory`: so many words
//     while (goes_on(structure, search))
//         next_triangles<FILTERED>(structure, region, search, found, count);
//     unsigned find_starts(structure, region, list);          // where searches in parts of a region start
//     auto search = begin_search_at(structure, region, memory, starts, count);
//
// The whole warp takes part in every round. It adds places of triangles in the structure to the list `found` of `count`
// entries: 96 at most, often none. A grid may find a triangle several times. Where FILTERED, the result is the twin's: nothing that meets
// the region is missing, and the region may meet the bounding box of everything found. Else it also holds triangles of the same leaf,
// cell or row of cells, for callers that test triangles more strictly themselves.
#pragma once

#include "accel/brute_force.cuh"
#include "accel/bvh/search.cuh"
#include "accel/grid/search.cuh"
