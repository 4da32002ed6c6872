// Twin of Windows in light_points/mod.rs: the block of bricks that the template reaches into around a cell, computed where it is
// needed instead of looked up.
#pragma once

#include "light_mesh/bricks.cuh"
#include "light_mesh/template.cuh"

struct Window {
    // Coordinates of the lowest brick.
    IVec3 low;
    // Bricks along each axis.
    int side;
};

// Bricks of a window along each axis: offsets run from 1 - reach to reach, and a run of n points meets at most (n + 2) / 4 + 1.
DEVICE int window_side(const LightMesh &mesh) {
    return (2 * mesh.reach + 2) / (1 << BRICK_BITS) + 1;
}

// The window around a cell.
DEVICE Window window_around(const LightMesh &mesh, IVec3 cell) {
    const int least = 1 - mesh.reach;
    return Window{IVec3{(cell.x + least) >> BRICK_BITS, (cell.y + least) >> BRICK_BITS, (cell.z + least) >> BRICK_BITS},
                  window_side(mesh)};
}

// Number of bricks.
DEVICE int window_size(const Window &window) {
    return window.side * window.side * window.side;
}

// The position in the window of the brick that contains a light point.
DEVICE int window_place(const Window &window, IVec3 point) {
    const int x = (point.x >> BRICK_BITS) - window.low.x, y = (point.y >> BRICK_BITS) - window.low.y,
              z = (point.z >> BRICK_BITS) - window.low.z;
    return (z * window.side + y) * window.side + x;
}

// The key of the brick at a position.
DEVICE unsigned long long window_key(const Window &window, int place) {
    const int x = place % window.side, y = place / window.side % window.side, z = place / (window.side * window.side);
    const int side = 1 << BRICK_BITS;
    return brick_of(IVec3{(window.low.x + x) * side, (window.low.y + y) * side, (window.low.z + z) * side});
}
