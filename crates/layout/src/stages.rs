//! The arguments of kernels: one record for those of a stage.

use crate::constants::FIRST_TARGETS;
use crate::geometry::{Cone, Hit, ListedRay, Rays, Tally, Triangles, Vec3};
use crate::mesh::{BrickTable, Bundle, KeptBy, LightMesh, UsedPoints, VisibilityOfLight};
use crate::record::records;
use crate::scene::{SampleRows, Sampling, Scene};
use crate::{In, Out};

records! {
    /// The box around the origins of a tile's surface points; empty, with the corners exchanged, if there are none.
    TileBox {
        /// The lowest corner.
        low: Vec3,
        /// The highest corner.
        high: Vec3,
    }

    /// `group_bundles` and `gather_bundles`: one block per tile of 1024 rays.
    GroupBundles {
        /// The scene.
        scene: Scene,
        /// Rays.
        rays: Rays,
        /// Their hits.
        hits: In<Hit>,
        /// Surface points by tile, then cell: ray numbers, 1024 entries per tile.
        members: Out<u32>,
        /// The end of each bundle among the members of its tile, 1024 entries per tile.
        ends: Out<u16>,
        /// Number of bundles of each tile; after the scan, of all tiles before it.
        counts: Out<u32>,
        /// All bundles, one tile after another: slot of the first member · 64 + their number.
        bundles: Out<u64>,
        /// The boxes around the surface points of each tile.
        tiles: Out<TileBox>,
        /// The first block of this launch among all blocks.
        first_block: u64,
        /// The distance between the surface points of neighbouring pixels: a constant, and a multiple of their distance.
        spacing: [f32; 2],
    }

    /// What a surface point sees of the samples of a light that is near, by their weights.
    Weighed {
        /// Number of samples above the horizon.
        above: u32,
        /// Of those that are seen.
        seen: u32,
        /// The sum of the weights of all,
        all: f32,
        /// and of those that are seen.
        lit: f32,
    }

    /// `area_shadows`: one warp per 32 rays; `find_starts`: one warp per tile and light; `occluder_lists`: one warp per bundle; `sample_rays`:
    /// one thread per ray.
    Shadows {
        /// The scene.
        scene: Scene,
        /// Rays that found the surface points.
        rays: Rays,
        /// Their hits.
        hits: In<Hit>,
        /// Ray numbers by slot.
        members: In<u32>,
        /// Slot of the first member · 64 + their number, by bundle.
        bundles: In<u64>,
        /// The boxes around the surface points of each tile.
        tiles: In<TileBox>,
        /// By tile, then light of the group, MAX_SEARCH_ROOTS + 1 words each: the number of boxes from which searches start, then these; see
        /// `accel/search.cuh`.
        starts: Out<u32>,
        /// Number of bundles of this launch that are taken.
        taken: Out<u32>,
        /// Share of each light by light, then ray; the number of samples seen until the last set.
        share: Out<f32>,
        /// What is seen of lights that are near, by light, then ray, until the last set; null for a single set.
        weighed: Out<Weighed>,
        /// How area lights are sampled.
        sampling: Sampling,
        /// Counts samples.
        tally: Tally,
        /// The first warp, bundle or block of this launch.
        first: u64,
        /// Number of warps, bundles or blocks in this launch.
        count: u64,
        /// The samples of discs and rectangles that are tested now; no rows if there are none left.
        sets: [SampleRows; 2],
        /// Number of this set.
        set: u32,
        /// Number of sets.
        set_count: u32,
        /// The first light of this launch.
        first_light: u32,
        /// The last, and one.
        end_light: u32,
    }

    /// `transmittance`: one thread per ray.
    Transmittance {
        /// The scene, of which only what is opaque hides.
        scene: Scene,
        /// What kernels that test samples need; of its scene only what lets light through is hit.
        shadows: Shadows,
        /// What is hit, by index in the mesh: given points have other triangles in a scene.
        triangles: Triangles,
        /// Normals of the mesh's vertices; null without any.
        normals: In<Vec3>,
        /// What is left of each light by light, then ray; what is lost until the last set.
        passed: Out<Vec3>,
        /// 1: one ray to the centre of each light.
        middle: u32,
        /// The level whose surface points are followed.
        level: u32,
        /// How many parts the samples of each light are divided into: each ray takes one.
        parts: u32,
        /// Padding to a multiple of eight bytes.
        spare: u32,
    }

    /// `first_rays`: one thread per ray; `find_open` and `list_open`: one block per light and 256 rays; `open_rays`: one thread per entry.
    AdaptiveShadows {
        /// The scene.
        scene: Scene,
        /// What other kernels that test samples need. For rows next to a band without shares.
        shadows: Shadows,
        /// Answers of first rays, by light of this slice, then pixel of the band and the rows next to it.
        answers: Out<u8>,
        /// Number of these pixels.
        answer_count: u64,
        /// The first ray's place among them.
        first_answer: u64,
        /// Number of entries of each block; after the scan, of all blocks before it.
        counts: Out<u32>,
        /// The surface points whose neighbours disagree on a light: light · 2^32 + ray.
        entries: Out<u64>,
        /// Their number.
        entry_count: u64,
        /// Where first rays end: on discs, then on rectangles.
        places: [[[f32; 2]; FIRST_TARGETS as usize]; 2],
        /// Number of blocks of a light.
        tiles: u32,
        /// Padding to a multiple of eight bytes.
        spare: u32,
    }

    /// `primary_rays`: one thread per ray.
    PrimaryRays {
        /// The scene.
        scene: Scene,
        /// The rays.
        rays: Rays,
        /// One hit per ray.
        hits: Out<Hit>,
        /// Counts surface points.
        tally: Tally,
        /// The first block of this launch among all blocks.
        first_block: u64,
    }

    /// `shadow_rays`: one thread per ray.
    ShadowRays {
        /// The scene.
        scene: Scene,
        /// Rays that found the surface points.
        rays: Rays,
        /// Their hits.
        hits: In<Hit>,
        /// Share of each light by light, then ray.
        share: Out<f32>,
        /// Counts shadow rays.
        tally: Tally,
        /// The first block of this launch among all blocks.
        first_block: u64,
        /// The first light of this launch.
        first_light: u32,
        /// Number of lights in this launch.
        light_count: u32,
    }

    /// `shade`: one thread per ray; `add_rays` and `add_light_groups`: one thread per ray, of which the first of a pixel works.
    Shade {
        /// The scene.
        scene: Scene,
        /// Rays.
        rays: Rays,
        /// Their hits.
        hits: In<Hit>,
        /// Share of each light by light, then ray.
        share: In<f32>,
        /// What is left of each light, in the same order; null if all surfaces are opaque.
        passed: In<Vec3>,
        /// Number of light points used, by ray; null if the technique uses none.
        used: In<u32>,
        /// What was gathered, by ray; null if ambient light stands for it.
        gathered: In<Vec3>,
        /// The first pixel of the film.
        film_pixel: u64,
        /// Radiance by pixel of the film, which is added to.
        color: Out<Vec3>,
        /// While groups of lights follow, the radiance of each ray so far; null if that has its place in `color`.
        sums: Out<Vec3>,
        /// The share that shows what is behind everything, by pixel: what rays see that go through surfaces, and shadow catchers, as far as
        /// these get the light that they would get alone; null if that is not kept.
        caught: Out<f32>,
        /// The same for each ray; null if a pixel has one.
        ray_caught: Out<f32>,
        /// What the samples of the camera's pixels see, sample by sample; null if a pixel has one.
        samples: In<Hit>,
        /// Distance by pixel; null if no layers are kept, like all fields that follow.
        depth: Out<f32>,
        /// Geometric normal by pixel.
        normal: Out<Vec3>,
        /// Surface point by pixel, local frame.
        position: Out<Vec3>,
        /// Share of each light by light, then pixel of the film.
        visibility: Out<f32>,
        /// Number of light points used, by pixel.
        light_points: Out<u32>,
        /// Radiance by light, then pixel of the film; after the lights what belongs to none. Null if that is not kept.
        light_groups: Out<Vec3>,
        /// Number of the object by pixel, then of the material; null if these are not kept.
        ids: Out<u32>,
        /// Number of pixels of the film.
        film_pixels: u64,
        /// The first block of this launch among all blocks.
        first_block: u64,
        /// The first light of the group.
        first_light: u32,
        /// The last, and one.
        end_light: u32,
        /// 1 if a pixel may have several rays, next to each other in the list: sums of rays are added to pixels afterwards.
        several: u32,
        /// 1 if the rays go through samples of the camera's pixels: their shares are added to layers.
        sampled: u32,
        /// Samples of a pixel in `samples`.
        sample_count: u32,
        /// The first pixel of `samples`.
        first_sampled: u32,
        /// Number of pixels of `samples`.
        sampled_pixels: u64,
        /// 1 if the scene has shadow catchers.
        catches: u32,
        /// 1 if the shares of lights that are near or wide are those of what is above the horizon, by the weights of their samples.
        weighed: u32,
    }

    /// `pixel_samples`, `count_ids`, `merge_samples`, `find_contrast`, `count_fragments` and `emit_fragments`: one thread per pixel of a camera's rows,
    /// the first also per sample.
    PixelSamples {
        /// The scene.
        scene: Scene,
        /// The camera's rays through the centres of pixels.
        rays: Rays,
        /// What samples see: sample by sample, then by pixel.
        hits: Out<Hit>,
        /// What the centres see. Where a pixel's samples do not share a surface with it, it is taken away.
        centers: Out<Hit>,
        /// State of each pixel.
        state: Out<u32>,
        /// The owner of each sample: sample by sample, then by pixel. Only those of pixels that are not shared are known.
        owners: Out<u8>,
        /// Radiance by pixel, with what samples share.
        color: Out<Vec3>,
        /// Number of shared fragments, of single samples and of mirror samples of each block; after the scans, of all blocks before it.
        counts: [Out<u32>; 3],
        /// Shared fragments, single samples and mirror samples.
        fragments: [Out<ListedRay>; 3],
        /// What they see.
        fragment_hits: [Out<Hit>; 3],
        /// Share of samples that see anything, by pixel; null if that is not kept.
        coverage: Out<f32>,
        /// How much light shadow catchers get, by pixel; null if that is not kept.
        caught: Out<f32>,
        /// Distance of the nearest sample by pixel; null if no layers are kept, like all fields that follow.
        depth: Out<f32>,
        /// Its geometric normal.
        normal: Out<Vec3>,
        /// Its surface point, local frame.
        position: Out<Vec3>,
        /// Share of each light by light, then pixel.
        visibility: Out<f32>,
        /// Number of light points used.
        light_points: Out<u32>,
        /// Radiance by light, then pixel, then what belongs to none; null if that is not kept.
        light_groups: Out<Vec3>,
        /// Number of the nearest sample's object by pixel, then of its material; null if these are not kept, like the next.
        ids: Out<u32>,
        /// Samples by what they see: of objects, then of materials, slot by slot, a number by pixel and then a count by pixel.
        mattes: Out<u32>,
        /// Counts grid walks.
        tally: Tally,
        /// The first block of this launch among all blocks.
        first_block: u64,
        /// Selects the random pattern.
        seed: u64,
        /// Number of pixels of the film.
        film_pixels: u64,
        /// The distance between the surface points of neighbouring pixels: a constant, and a multiple of their distance.
        spacing: [f32; 2],
        /// The first of these samples, and their number.
        samples: [u32; 2],
        /// The first ray whose pixel gets fragments, and the end.
        inner: [u32; 2],
        /// Number of samples of a pixel in all ranges.
        all_samples: u32,
        /// Number of samples of a pixel that neighbouring threads cast: a power of two.
        together: u32,
        /// Number of threads that take the samples of a pixel: a power of two.
        lanes: u32,
        /// Number of lights with layers.
        light_count: u32,
        /// Share of a sample in its pixel.
        weight: f32,
        /// The relative difference to a neighbour from which a pixel is not shared.
        contrast: f32,
        /// 1 if samples are never shared.
        apart: u32,
        /// 1 if mirrors are followed: then what mirrors is not shared.
        mirrors: u32,
        /// 1 if the hits of centres stay.
        keeps: u32,
        /// Number of slots in `mattes`, of objects and of materials.
        matte_slots: u32,
        /// Where the inverse of the filter's cumulative distribution is, at equal distances: offsets from the centre in pixels.
        quantiles: [f32; 64],
    }

    /// `mirror_rays_thin`, `mirror_rays_count` and `mirror_rays_emit`: one thread per ray.
    MirrorRays {
        /// The scene.
        scene: Scene,
        /// Rays.
        rays: Rays,
        /// Their hits.
        hits: In<Hit>,
        /// Number of rays that go on from each block of 256 rays; after the scan, of all blocks before it.
        counts: Out<u32>,
        /// The shares of thin rays that go on from each ray; null if none are thinned.
        thin: Out<u32>,
        /// How many rays go on from each ray.
        per_ray: Out<u32>,
        /// Random pattern.
        seed: u64,
        /// Samples of a pixel at most, as a power of two.
        pixel_samples: u64,
        /// The rays that go on, in the order of the rays: of each first the one that goes through, then those that are mirrored.
        onward: Out<ListedRay>,
        /// Their cones; null if textures are not filtered.
        cones: Out<Cone>,
    }

    /// `merge_mirrored`, `count_merged` and `emit_merged`: one thread per ray.
    MergedRays {
        /// The scene.
        scene: Scene,
        /// Mirrored rays.
        rays: Rays,
        /// Their hits.
        hits: In<Hit>,
        /// Of each ray, those that are merged with it: bit k stands for the k-th ray after it; 0 if it is merged with one before.
        merged: Out<u32>,
        /// Number of rays that are left of each block of 256 rays; after the scan, of all blocks before it.
        counts: Out<u32>,
        /// The rays that are left, in their order.
        left: Out<ListedRay>,
        /// Their hits.
        left_hits: Out<Hit>,
        /// Their cones; null if textures are not filtered.
        cones: Out<Cone>,
        /// The distance between the surface points of neighbouring pixels: a constant, and a multiple of their distance.
        spacing: [f32; 2],
    }

    /// `group_points` and `gather_bundles`: one block per tile of 1024 rays.
    GroupCells {
        /// The scene.
        scene: Scene,
        /// Rays.
        rays: Rays,
        /// Their hits.
        hits: In<Hit>,
        /// The mesh whose cells define the groups.
        mesh: LightMesh,
        /// Surface points by tile, then cell: ray numbers, 1024 entries per tile.
        members: Out<u32>,
        /// Bundles by tile, 1024 entries per tile.
        tile_bundles: Out<Bundle>,
        /// Number of bundles of each tile; after the scan, of all tiles before it.
        counts: Out<u32>,
        /// All bundles, one tile after another.
        bundles: Out<Bundle>,
        /// The first block of this launch among all blocks.
        first_block: u64,
    }

    /// `short_tests`: one warp per bundle.
    ShortTests {
        /// The scene.
        scene: Scene,
        /// Rays.
        rays: Rays,
        /// Their hits.
        hits: In<Hit>,
        /// The light mesh.
        mesh: LightMesh,
        /// Ray numbers by slot.
        members: In<u32>,
        /// Up to 32 surface points of a cell each.
        bundles: In<Bundle>,
        /// Masks: 32 · words words per bundle; bit l of word k says whether the bundle's l-th surface point sees light point k.
        masks: Out<u32>,
        /// Counters.
        tally: Tally,
        /// The first bundle of this launch.
        first_bundle: u64,
        /// Number of bundles in this launch.
        bundle_count: u64,
    }

    /// `mark_bundles`: one warp per bundle; `insert_bricks` and `mark_points`: one thread per brick of a bundle's window; `count_points` and
    /// `list_points`: one thread per slot.
    LightPoints {
        /// The light mesh.
        mesh: LightMesh,
        /// Bundles.
        bundles: In<Bundle>,
        /// Their masks.
        masks: In<u32>,
        /// The used points of each brick of the window around each bundle's cell.
        marks: Out<u64>,
        /// The first bundle of this launch.
        first_bundle: u64,
        /// Number of bundles in this launch.
        bundle_count: u64,
        /// The bricks that contain used points.
        table: BrickTable,
        /// Used points of each slot.
        used: Out<u64>,
        /// Number of used points of each slot; after the scan, of all slots before it.
        rank: Out<u32>,
        /// Every used point by rank.
        points: Out<u64>,
        /// Number of bricks in the table.
        bricks: Out<u32>,
        /// The slot of each brick of each bundle's window that has used points.
        slots: Out<u32>,
    }

    /// `long_tests`: one thread per light point.
    LongTests {
        /// The scene.
        scene: Scene,
        /// The light mesh.
        mesh: LightMesh,
        /// The used light points.
        points: UsedPoints,
        /// The results.
        lit: VisibilityOfLight,
        /// How area lights are sampled.
        sampling: Sampling,
        /// Counts overruns.
        tally: Tally,
        /// The light.
        light: u32,
        /// Number of light points in this launch.
        point_count: u32,
        /// The first light point of this launch.
        first_point: u64,
        /// The first ray from each light point in this launch. A later launch adds to the results of earlier ones.
        first_sample: u32,
        /// Number of rays from each light point in this launch.
        sample_count: u32,
    }

    /// `admit_bricks`, `find_unknown`, `learn` and `recall`: one thread per slot of the image's table; `move_bricks` and `move_answers`:
    /// one thread per slot of the smaller table.
    Cache {
        /// Used light points of the image, or some of them.
        points: UsedPoints,
        /// The cached bricks.
        table: BrickTable,
        /// Their number.
        bricks: Out<u32>,
        /// The number of the last image that used each of them, by slot.
        ages: Out<u32>,
        /// For each slot that a thread processes, the slot in the cached table.
        rows: Out<u32>,
        /// The cached values for the light.
        kept: KeptBy,
        /// The visibility of the light at the points.
        lit: VisibilityOfLight,
        /// The points whose value is unknown, by slot of the image's table.
        unknown: Out<u64>,
        /// The table that became too small.
        from_table: BrickTable,
        /// Its ages.
        from_ages: Out<u32>,
        /// Its values for the light.
        from: KeptBy,
        /// The number of the image.
        image: u32,
        /// Padding to a multiple of eight bytes.
        spare: u32,
    }

    /// `interpolate`: one warp per bundle; `fallback`: one thread per ray.
    Interpolate {
        /// The scene.
        scene: Scene,
        /// Rays.
        rays: Rays,
        /// Their hits.
        hits: In<Hit>,
        /// The light mesh.
        mesh: LightMesh,
        /// Ray numbers by slot.
        members: In<u32>,
        /// Bundles.
        bundles: In<Bundle>,
        /// Their masks.
        masks: In<u32>,
        /// The used light points.
        points: UsedPoints,
        /// The slot of each brick of the window around each bundle's cell that has used points.
        slots: In<u32>,
        /// The visibility at these points, by light.
        lit: In<VisibilityOfLight>,
        /// Share of each light by light, then ray; negative if the fallback must compute it.
        share: Out<f32>,
        /// Number of light points used, by ray.
        used: Out<u32>,
        /// The rays that have a negative share.
        fallback_rays: Out<u32>,
        /// Their number.
        fallback_count: Out<u32>,
        /// How area lights are sampled.
        sampling: Sampling,
        /// Counters.
        tally: Tally,
        /// The first bundle, or block of rays that fall back, of this launch.
        first: u64,
        /// Number of bundles in this launch.
        count: u64,
    }

    /// `scan_blocks` and `add_offsets`: exclusive prefix sums of `u32`, in place.
    Scan {
        /// The values to sum.
        values: Out<u32>,
        /// The sum of each block of 1024 values; after their own scan, of all preceding blocks.
        sums: Out<u32>,
        /// Number of values.
        count: u64,
    }

    /// `copy_words`: one thread per word.
    Copy {
        /// From here
        from: In<u32>,
        /// to here.
        to: Out<u32>,
        /// Number of words.
        count: u64,
    }
}
