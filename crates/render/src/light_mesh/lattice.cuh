// Positions of light points, and the numbering of formula (7): twin of lattice.rs.
#pragma once

#include "cuda/prelude.cuh"

// Position of a light point along one axis.
DEVICE float lattice_coordinate(float anchor, float step, int index) { return anchor + step * (float)index; }

// Position of a light point, local frame.
DEVICE Vec3 lattice_point(const LightMesh &mesh, IVec3 index) {
    return Vec3{lattice_coordinate(mesh.anchor.x, mesh.step, index.x), lattice_coordinate(mesh.anchor.y, mesh.step, index.y),
                lattice_coordinate(mesh.anchor.z, mesh.step, index.z)};
}

// The cell that contains a position.
DEVICE IVec3 lattice_cell(const LightMesh &mesh, Vec3 position) {
    const Vec3 cell = (position - mesh.anchor) / mesh.step;
    return IVec3{__float2int_rd(cell.x), __float2int_rd(cell.y), __float2int_rd(cell.z)};
}

// The world index of a light point along one axis, of which the lowest bits are kept.
DEVICE unsigned long long world_index(unsigned number, int index) { return (number + (unsigned)index) & ((1u << INDEX_BITS) - 1); }

// Formula (7): the number of a light point.
DEVICE unsigned long long lattice_packed(const LightMesh &mesh, IVec3 index) {
    return world_index(mesh.number[2], index.z) << 2 * INDEX_BITS | world_index(mesh.number[1], index.y) << INDEX_BITS |
           world_index(mesh.number[0], index.x);
}
