// Numbers of the objects and materials that rays see, from 1: twin of ids.rs.
#pragma once

#include "accel/instanced.cuh"
#include "data/rays.cuh"

// The number of a triangle's object: that of its instance, or of the last run that begins at it or before.
DEVICE unsigned object_of(const Scene &scene, unsigned triangle) {
    if (INSTANCES && triangle >= FIRST_INSTANCED)
        return __ldg(&instance_of(scene.triangles.instances, scene.triangles.instance_count, triangle)->object) + 1;
    unsigned low = 0, high = scene.object_runs;
    while (low < high) {
        const unsigned middle = low + (high - low) / 2;
        if (__ldg(scene.object_starts + middle) <= triangle)
            low = middle + 1;
        else
            high = middle;
    }
    return low == 0 ? 1 : __ldg(scene.objects + low - 1) + 1;
}

// The number of a triangle's material.
DEVICE unsigned material_of(const Scene &scene, unsigned triangle) {
    return scene.materials[material_index(scene, triangle)].number;
}
