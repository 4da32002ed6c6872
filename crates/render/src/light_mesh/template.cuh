// Twin of template.rs: formula (6) as rows along x, and operations of a warp on the points of a cell.
//
// Lanes are surface points of one cell, up to 32. A template point's word has a bit for each lane: whether its surface point uses
// the light point.
#pragma once

#include "light_mesh/lattice.cuh"

// The lines of the template along x that have points, `LightMesh::lines` of them by z and y; set by the host.
CONSTANT(TemplateRow, template_rows, [TEMPLATE_LINES])

// Offset of template point k from the cell.
DEVICE IVec3 template_offset(const LightMesh &mesh, unsigned k) {
    const unsigned packed = __ldg(&mesh.offsets[k]);
    return IVec3{(int)(packed & 255) - MAX_REACH, (int)(packed >> 8 & 255) - MAX_REACH, (int)(packed >> 16) - MAX_REACH};
}

// A line as lanes see it that take one line each: first bit, number of points and offset of the first. The template is symmetric
// about the cell's middle, so the number of points determines where the line begins.
DEVICE void template_row(const LightMesh &mesh, int row, unsigned &bit, int &count, int &x) {
    const unsigned packed = __ldg(&mesh.rows[row]);
    bit = packed & 0xffff;
    count = packed >> 16;
    x = 1 - count / 2;
}

// The line at the given y and z.
DEVICE int row_of(const LightMesh &mesh, int y, int z) {
    return (z - 1 + mesh.reach) * 2 * mesh.reach + y - 1 + mesh.reach;
}
