// Where light points lie, and the numbering of formula (7): twin of lattice.rs.
#pragma once

#include "cuda/prelude.cuh"

// Position of a light point on one axis.
DEVICE float lattice_coordinate(float origin, float step, int index) { return origin + step * (float)index; }

// Position of a light point, local frame.
DEVICE Vec3 lattice_point(const LightMesh &mesh, IVec3 index) {
    return Vec3{lattice_coordinate(mesh.origin.x, mesh.step, index.x), lattice_coordinate(mesh.origin.y, mesh.step, index.y),
                lattice_coordinate(mesh.origin.z, mesh.step, index.z)};
}

// The cell that holds a position.
DEVICE IVec3 lattice_cell(const LightMesh &mesh, Vec3 position) {
    const Vec3 cell = (position - mesh.origin) / mesh.step;
    return IVec3{__float2int_rd(cell.x), __float2int_rd(cell.y), __float2int_rd(cell.z)};
}

// Formula (7): the number of a light point in row-major order.
DEVICE unsigned long long lattice_packed(const LightMesh &mesh, IVec3 index) {
    const unsigned long long nx = mesh.dims[0], ny = mesh.dims[1];
    return nx * ny * (unsigned)index.z + nx * (unsigned)index.y + (unsigned)index.x;
}
