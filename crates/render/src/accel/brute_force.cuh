// Asks every triangle: twin of brute_force.rs.
#pragma once

#include "accel/visit.cuh"

template <class Visitor>
DEVICE void walk(const BruteForce &all, const Tally &, const Ray &, Visitor &visitor) {
    ask(visitor, all.triangles, Run{0, all.count});
}

DEVICE void walk_short(const BruteForce &all, Short &segment, float) {
    ask(segment, all.triangles, Run{0, all.count});
}
