// Shapes in many places, and the triangles that rays meet there: twin of instanced.rs, bit by bit.
//
// Where triangles are told by index, those of instances begin at FIRST_INSTANCED; where by their place in a structure, too: then they are in the
// order of the shape's leaves. What looks them up is in functions of its own, and not in modules without INSTANCES: it would take registers
// from loops over triangles. See gpu/per_structure.rs.
#pragma once

#include "accel/triangle.cuh"

// A triangle where it is stored, or that of a shape at one of its places.
struct Placed {
    const Triangle *stored;
    // Null where it is where it is stored.
    const Instanced *instance;
};

// A row of an affine map.
DEVICE float4 load_row(const float (&rows)[3][4], unsigned row) {
    return __ldg(reinterpret_cast<const float4 *>(rows[row]));
}

// Where a point goes.
DEVICE Vec3 placed_point(const float (&rows)[3][4], Vec3 v) {
    const float4 x = load_row(rows, 0), y = load_row(rows, 1), z = load_row(rows, 2);
    return Vec3{(x.x * v.x + x.y * v.y) + (x.z * v.z + x.w), (y.x * v.x + y.y * v.y) + (y.z * v.z + y.w),
                (z.x * v.x + z.y * v.y) + (z.z * v.z + z.w)};
}

// Where a direction goes.
DEVICE Vec3 placed_vector(const float (&rows)[3][4], Vec3 v) {
    const float4 x = load_row(rows, 0), y = load_row(rows, 1), z = load_row(rows, 2);
    return Vec3{(x.x * v.x + x.y * v.y) + x.z * v.z, (y.x * v.x + y.y * v.y) + y.z * v.z, (z.x * v.x + z.y * v.y) + z.z * v.z};
}

// Where the normal of a surface goes, of unit length, if this is the inverse of the surface's place; zero stays zero.
DEVICE Vec3 placed_normal(const float (&back)[3][4], Vec3 v) {
    const float4 a = load_row(back, 0), b = load_row(back, 1), c = load_row(back, 2);
    const Vec3 normal = {(a.x * v.x + b.x * v.y) + c.x * v.z, (a.y * v.x + b.y * v.y) + c.y * v.z, (a.z * v.x + b.z * v.y) + c.z * v.z};
    const float square = length_squared(normal);
    return square > 0.0f ? normal / sqrtf(square) : splat(0.0f);
}

DEVICE float4 load_corner(const Placed &triangle, unsigned corner) {
    const float4 own = load_corner(triangle.stored, corner);
    if (triangle.instance == nullptr)
        return own;
    const Vec3 placed = placed_point(triangle.instance->place, Vec3{own.x, own.y, own.z});
    return float4{placed.x, placed.y, placed.z, own.w};
}

DEVICE unsigned triangle_index(const Placed &triangle) {
    const unsigned stored = triangle_index(triangle.stored);
    const Instanced *instance = triangle.instance;
    return instance == nullptr ? stored : __ldg(&instance->first) + (stored - __ldg(&instance->stored));
}

DEVICE const unsigned *cut_of(const Placed &triangle) { return cut_of(triangle.stored); }

// The number of the instance that a structure holds in place of a triangle, from 1; 0 if this is a triangle.
DEVICE unsigned held_by(const Triangle *triangle) { return __float_as_uint(__ldg(&triangle->corners[2][3])); }

// The instance that has triangle number `index`, which is at least FIRST_INSTANCED.
DEVICE const Instanced *instance_of(const Instanced *instances, unsigned count, unsigned index) {
    unsigned low = 0, high = count;
    while (low < high) {
        const unsigned middle = low + (high - low) / 2;
        if (__ldg(&instances[middle].first) <= index)
            low = middle + 1;
        else
            high = middle;
    }
    return instances + (low - 1);
}

COLD Corners instanced_corners(const Triangle *stored, const Instanced *instances, unsigned count, unsigned index) {
    const Instanced *instance = instance_of(instances, count, index);
    return load_corners(Placed{stored + (__ldg(&instance->stored) + (index - __ldg(&instance->first))), instance});
}

COLD unsigned stored_of_instance(const Instanced *instances, unsigned count, unsigned index) {
    const Instanced *instance = instance_of(instances, count, index);
    return __ldg(&instance->stored) + (index - __ldg(&instance->first));
}

// The corners of the triangle `index`, where it is in the scene.
DEVICE Corners corners_at(const Triangles &triangles, unsigned index) {
    if (!INSTANCES || index < FIRST_INSTANCED)
        return load_corners(triangles.stored + index);
    return instanced_corners(triangles.stored, triangles.instances, triangles.instance_count, index);
}

// Where the triangle `index` is stored: its vertices and its material.
DEVICE unsigned stored_index(const Triangles &triangles, unsigned index) {
    return !INSTANCES || index < FIRST_INSTANCED ? index : stored_of_instance(triangles.instances, triangles.instance_count, index);
}

// The triangle `index` where it is stored.
DEVICE const Triangle *stored_triangle(const Triangles &triangles, unsigned index) {
    return triangles.stored + stored_index(triangles, index);
}

// The index of a triangle's material.
DEVICE unsigned material_index(const Scene &scene, const Triangles &triangles, unsigned triangle) {
    return __ldg(scene.triangle_materials + stored_index(triangles, triangle));
}

DEVICE unsigned material_index(const Scene &scene, unsigned triangle) { return material_index(scene, scene.triangles, triangle); }

// The triangle at a place in a structure, and the structure that has the places which visitors note.
template <class Structure>
DEVICE const Triangle *triangle_at(const Structure &structure, unsigned place) {
    return structure.triangles + place;
}

template <class Structure>
DEVICE unsigned noted_place(const Structure &, unsigned place) {
    return place;
}

template <class Structure>
DEVICE const Structure &whole_of(const Structure &structure) {
    return structure;
}

DEVICE Placed triangle_at(const InstancedBvh &bvh, unsigned place) {
    if (place < FIRST_INSTANCED)
        return Placed{bvh.triangles + place, nullptr};
    const Instanced *instance = instance_of(bvh.instances, bvh.instance_count, place);
    return Placed{bvh.triangles + (__ldg(&instance->leaves) + (place - __ldg(&instance->first))), instance};
}

// A shape at one of its places, or the scene's own triangles if `instance` is null. Places are those in the structure's array.
struct Part {
    const InstancedBvh &bvh;
    const AlphaMask &alpha_mask;
    const Instanced *instance;
};

DEVICE Placed triangle_at(const Part &part, unsigned place) { return Placed{part.bvh.triangles + place, part.instance}; }

DEVICE unsigned noted_place(const Part &part, unsigned place) {
    return part.instance == nullptr ? place : __ldg(&part.instance->first) + (place - __ldg(&part.instance->leaves));
}

DEVICE const InstancedBvh &whole_of(const Part &part) { return part.bvh; }
