// Rays as kernels number them: those of some rows of a camera's image, or a list. Twin of view.rs and of the ray lists of
// primary_rays.
//
// A camera ray is computed where it is needed. Threads take a camera's pixels by square tiles, left to right, top to bottom; a warp
// takes 8 × 4 pixels, so that its rays are coherent. The rays of a list are taken in order.
#pragma once

#include "accel/ray.cuh"

// The ray of a thread whose block covers SIDE × SIDE pixels; false if there is none.
template <unsigned SIDE>
DEVICE bool ray_in_tile(const Rays &rays, unsigned tile, unsigned thread, unsigned &ray) {
    if (rays.list != nullptr) {
        ray = tile * (SIDE * SIDE) + thread;
        return ray < rays.count;
    }
    const unsigned width = rays.view.size[0], across = (width + SIDE - 1) / SIDE;
    const unsigned warp = thread / WARP, lane = thread % WARP;
    const unsigned x = tile % across * SIDE + warp % (SIDE / 8) * 8 + lane % 8;
    const unsigned y = tile / across * SIDE + warp / (SIDE / 8) * 4 + lane / 8;
    ray = y * width + x;
    // In 64 bits: the last tile may extend beyond the last row that 32 bits can number.
    return x < width && (unsigned long long)y * width + x < rays.count;
}

// The ray of a thread in a block of BLOCK threads.
DEVICE bool ray_of_thread(const Rays &rays, unsigned block, unsigned thread, unsigned &ray) {
    return ray_in_tile<BLOCK_SIDE>(rays, block, thread, ray);
}

// The same for blocks of TILE.
DEVICE bool tile_ray_of_thread(const Rays &rays, unsigned block, unsigned thread, unsigned &ray) {
    return ray_in_tile<TILE_SIDE>(rays, block, thread, ray);
}

// The pixel of a ray, y · width + x of the window.
DEVICE unsigned pixel_of(const Rays &rays, unsigned ray) {
    return rays.list != nullptr ? __ldg(&rays.list[ray].pixel) : rays.first_pixel + ray;
}

// The ray `x` pixels to the right and `y` down from the image's centre.
DEVICE Ray ray_towards(const View &view, float x, float y) {
    const Vec3 aside = x * view.right + y * view.down;
    if (view.perspective) {
        const Vec3 direction = view.forward + aside;
        return Ray{view.origin, direction / length(direction), INFINITE};
    }
    return Ray{view.origin + aside, view.forward, INFINITE};
}

// The column (axis 0) or row (axis 1) in the image of a pixel of the window; negative to the left of it and above.
DEVICE int place_in_image(const View &view, unsigned pixel, unsigned axis) {
    return (int)(axis == 0 ? pixel % view.size[0] : pixel / view.size[0]) + view.first[axis];
}

// Where a column or row of the image lies among the `step` that repeat from its first one on, in both directions.
DEVICE unsigned place_in_step(int place, unsigned step) {
    const int rest = place % (int)step;
    return (unsigned)(rest < 0 ? rest + (int)step : rest);
}

// Whether a place is in the image.
DEVICE bool is_in_image(const View &view, int x, int y) { return (unsigned)x < view.whole[0] && (unsigned)y < view.whole[1]; }

// Whether some pixels of the window are not.
DEVICE bool leaves_image(const View &view) {
    const int right = view.first[0] + (int)view.size[0] - 1, bottom = view.first[1] + (int)view.size[1] - 1;
    return !(is_in_image(view, view.first[0], view.first[1]) && is_in_image(view, right, bottom));
}

// Whether a pixel of the window is in the image and another one, `x` to the right and `y` down, is not: the first does not depend on it.
DEVICE bool is_beyond(const View &view, unsigned pixel, int x, int y) {
    const int column = place_in_image(view, pixel, 0), row = place_in_image(view, pixel, 1);
    return is_in_image(view, column, row) && !is_in_image(view, column + x, row + y);
}

// The number in the image of a pixel of the window.
DEVICE unsigned number_in_image(const View &view, unsigned pixel) {
    // All of an image. Given points have no window.
    if (view.first[0] == 0 && view.first[1] == 0 && view.size[0] == view.whole[0] && view.size[1] <= view.whole[1])
        return pixel;
    const int x = place_in_image(view, pixel, 0), y = place_in_image(view, pixel, 1);
    return is_in_image(view, x, y) ? (unsigned)y * view.whole[0] + (unsigned)x : OUTSIDE + ((unsigned)y << OUTSIDE_BITS) + (unsigned)x;
}

// The centre of a pixel along an axis, in pixels from that of the image.
DEVICE float center_of(const View &view, unsigned pixel, unsigned axis) {
    return (float)place_in_image(view, pixel, axis) + 0.5f - 0.5f * (float)view.whole[axis];
}

// The camera ray through the centre of a pixel.
DEVICE Ray view_ray(const View &view, unsigned pixel) { return ray_towards(view, center_of(view, pixel, 0), center_of(view, pixel, 1)); }

// The ray through the point of a pixel that is (`right`, `down`) from its centre, in pixels.
DEVICE Ray view_ray_beside(const View &view, unsigned pixel, float right, float down) {
    return ray_towards(view, center_of(view, pixel, 0) + right, center_of(view, pixel, 1) + down);
}

// Sixteen bytes of a listed ray: origin and pixel, direction, weight.
DEVICE Vec3 load_listed(const ListedRay *listed, unsigned part) {
    const float4 values = __ldg(reinterpret_cast<const float4 *>(listed) + part);
    return Vec3{values.x, values.y, values.z};
}

DEVICE Ray ray_at(const Rays &rays, unsigned ray) {
    if (rays.list == nullptr)
        return view_ray(rays.view, rays.first_pixel + ray);
    const ListedRay *listed = rays.list + ray;
    return Ray{load_listed(listed, 0), load_listed(listed, 1), INFINITE};
}

// The share of a ray's radiance that reaches its pixel.
DEVICE Vec3 weight_of(const Rays &rays, unsigned ray) {
    return rays.list == nullptr ? Vec3{1.0f, 1.0f, 1.0f} : load_listed(rays.list + ray, 2);
}

// The number of the pixel's sample that a ray goes through, and one, 0 for a camera's; from bit DIRECTION_SHIFT on, which of a rough mirror's
// rays of this sample it is; from bit THROUGHS_SHIFT on, through how many surfaces
// it went; from bit FADE_SHIFT on, how much of lights it does not show.
DEVICE unsigned sample_of(const Rays &rays, unsigned ray) { return rays.list != nullptr ? __ldg(&rays.list[ray].sample) : 0; }

// Through how many surfaces a ray went.
DEVICE unsigned throughs_of(const Rays &rays, unsigned ray) { return sample_of(rays, ray) >> THROUGHS_SHIFT & THROUGHS_MASK; }

// The share of lights that a ray shows: highlights on the rough mirror that it comes from show the rest.
DEVICE float lights_share(const Rays &rays, unsigned ray) {
    return 1.0f - (float)(sample_of(rays, ray) >> FADE_SHIFT) / (float)PARTS_OF_FADE;
}

// Whether a mirror reflected a ray.
DEVICE bool is_mirrored(const Rays &rays, unsigned ray) { return rays.depth > throughs_of(rays, ray); }

// The number of a ray among those of its pixel: by the pixel's sample that it goes through, then by its direction from a rough mirror.
DEVICE unsigned number_in_pixel(const Rays &rays, unsigned ray) {
    const unsigned one = sample_of(rays, ray) & ((1u << DIRECTION_SHIFT) - 1), sample = one > 0 ? one - 1 : 0;
    const unsigned direction = sample_of(rays, ray) >> DIRECTION_SHIFT & (MAX_DIRECTIONS - 1);
    return is_mirrored(rays, ray) ? sample * MAX_DIRECTIONS + direction : sample;
}

// The key that distinguishes the random patterns of two surface points: the pixel, its sample, the surfaces on the way that let it through, and
// whether it is in a list, such as that of mirror rays.
DEVICE unsigned long long ray_key(const Rays &rays, unsigned ray) {
    const unsigned long long key = (unsigned long long)number_in_image(rays.view, pixel_of(rays, ray)) << 1 | (rays.list != nullptr ? 1 : 0);
    return (unsigned long long)sample_of(rays, ray) << 33 | key;
}
