//! The irradiance cache of gathered light: its tables, and the arguments of its kernels.

use crate::constants::{BINS, ORDERS};
use crate::geometry::{Hit, ListedRay, Rays, Tally, Vec3};
use crate::record::records;
use crate::scene::{Sampling, Scene};
use crate::{In, Out};

records! {
    /// A cell of space, or one kind of surface in it.
    Name {
        /// Distinguishes it from all others; never zero.
        key: u64,
        /// The index of the cell along each axis.
        cell: [i32; 3],
        /// Its level.
        level: i32,
        /// The kind of surface.
        kind: u32,
        /// By how many levels the cell of a node is smaller than what was asked at first.
        finer: u32,
    }

    /// Numbers of names: open addressing with linear probing.
    Names {
        /// The key in each slot; 0 if the slot is empty.
        keys: Out<u64>,
        /// The number of the name in each slot.
        numbers: Out<u32>,
        /// The names by number.
        names: Out<Name>,
        /// How many there are, or more than `room` if they do not fit.
        count: Out<u32>,
        /// Number of slots, a power of two.
        capacity: u32,
        /// Maximum number of names.
        room: u32,
    }

    /// A point of the surfaces that gathers light.
    Record {
        /// Its position.
        position: Vec3,
        /// The level of its cell.
        level: i32,
        /// Where rays begin.
        origin: Vec3,
        /// Geometric normal; unit length.
        normal: Vec3,
        /// Distinguishes its random pattern from others.
        seed: u64,
    }

    /// Cells with their records, some of which have a value: what they gather.
    SurfaceCells {
        /// The cells.
        cells: Names,
        /// By cell: the first record, and their number times 2³².
        ranges: Out<u64>,
        /// The records of all cells.
        records: Out<Record>,
        /// Their number.
        record_count: Out<u32>,
        /// By record: the number of its value, and one; 0 if it has none.
        values: Out<u32>,
        /// The record of each value.
        owners: Out<u32>,
        /// Number of values.
        value_count: Out<u32>,
    }

    /// A place that light is asked for.
    LightPlace {
        /// Its position.
        position: Vec3,
        /// The level of the cells that are asked.
        level: i32,
        /// Geometric normal; unit length.
        normal: Vec3,
        /// The share of the answer that counts; 0 if nothing is asked.
        share: f32,
        /// Where rays begin.
        origin: Vec3,
    }

    /// A record that a place takes light from.
    Link {
        /// The number of the record.
        record: u32,
        /// Its weight.
        weight: f32,
    }

    /// Light by the direction that a surface faces, near the one that it faces.
    SurfaceLight {
        /// Mean radiance, by the cosine.
        mean: Vec3,
        /// How it changes as the normal turns: along x, y and z.
        tilt: [Vec3; 3],
        /// The most radiance that comes from any direction, channel by channel.
        most: Vec3,
    }

    /// Radiance by direction.
    Bins {
        /// Sums over rays.
        sums: [Vec3; BINS as usize],
        /// Numbers of rays.
        counts: [f32; BINS as usize],
    }

    /// What a coarse record gathers.
    CoarseLight {
        /// The light that it receives.
        light: SurfaceLight,
        /// The radiance that all rays see.
        all: Bins,
        /// That of rays that go far.
        beyond: Bins,
        /// 1: some rays do not go far.
        has_near: u32,
    }

    /// What a ray of a record sees.
    SeenRay {
        /// Where the other light is asked for.
        position: Vec3,
        /// The level of the cell that is asked at first.
        level: i32,
        /// Geometric normal there; unit length.
        normal: Vec3,
        /// The kind of surface; [`SURFACE_KINDS`](crate::constants::SURFACE_KINDS) if nothing is asked.
        kind: u32,
        /// Emitted light, light that lights give, or the surroundings.
        radiance: Vec3,
        /// The node that answers; none if something is in the way.
        node: u32,
        /// How much of the other light is reflected.
        kd: Vec3,
        /// By how many levels the largest cell that it may ask is smaller than `level`; more than
        /// [`BOUNCE_FINER`](crate::constants::BOUNCE_FINER): it asks no more.
        from: i32,
    }

    /// What arrives at a record that rays of others hit.
    Node {
        /// After up to one, two, … reflections.
        values: [Vec3; ORDERS as usize],
        /// The weight of hits that see no node.
        hidden: Vec3,
        /// How many of the values are known.
        known: u32,
        /// How many are asked for.
        wanted: u32,
        /// Which list of links is its own, and one; 0 if it is not linked.
        links: u32,
        /// 1: something covers it.
        covered: u32,
    }

    /// What a ray of a node sees.
    NodeLink {
        /// The node there; none where nothing is asked, or something is in the way.
        node: u32,
        /// The weight of what arrives there.
        weight: Vec3,
    }

    /// `take_records`: one thread per record.
    TakeRecords {
        /// All records.
        records: In<Record>,
        /// The numbers of those that are taken.
        numbers: In<u32>,
        /// Result.
        taken: Out<Record>,
        /// The same as places that ask; may be null.
        places: Out<LightPlace>,
        /// Their numbers; may be null.
        owners: Out<u32>,
        /// The place of the first one in `numbers`.
        first: u32,
        /// How many are taken.
        count: u32,
        /// Added to their levels.
        coarser: i32,
        /// Padding to a multiple of eight bytes.
        spare: u32,
    }

    /// `find_cells`, `count_links`, `fill_links`, `settle_links` and `value_links`: one thread per place. `place_records`: one warp per cell.
    Lookup {
        /// The scene.
        scene: Scene,
        /// Counts what structures count.
        tally: Tally,
        /// The cells.
        table: SurfaceCells,
        /// The places.
        places: In<LightPlace>,
        /// Number of links of each place; after the scan, of all places before it.
        offsets: Out<u32>,
        /// Records with their weights, place by place.
        links: Out<Link>,
        /// Number of places, or of cells.
        count: u32,
        /// The first cell.
        first: u32,
    }

    /// `cast_hemispheres`: one warp per record; `trace_hemispheres` and `see`: one thread per ray; `level_hemispheres` and `brighten_hemispheres`: one thread per record.
    HemisphereRays {
        /// The scene.
        scene: Scene,
        /// The rays: `list`.
        rays: Rays,
        /// How points on lights are chosen.
        sampling: Sampling,
        /// Counts shadow rays.
        tally: Tally,
        /// The records.
        records: In<Record>,
        /// Rays, record by record.
        list: Out<ListedRay>,
        /// Shares of the mean radiance by the cosine.
        weights: Out<f32>,
        /// How many rays of an even hemisphere each stands for.
        areas: Out<f32>,
        /// What the rays hit.
        hits: Out<Hit>,
        /// What they see.
        seen: Out<SeenRay>,
        /// The level of the smallest cells that the rays of each record ask.
        levels: Out<i32>,
        /// The mean luminance that the rays of each record see: `brighten_hemispheres`.
        brightness: Out<f32>,
        /// By record and block of directions: the rays of all blocks up to this one; null if they are spread evenly.
        ends: In<u32>,
        /// Number of records.
        count: u32,
        /// The side of the square that the rays of a record form.
        side: u32,
        /// How far they go, in cells of their record.
        reach: f32,
        /// 1: those that hit nothing see nothing, for others answer for them.
        is_near: u32,
        /// 1: there are lights for what lamps emit.
        lamps: u32,
        /// Blocks along each side of the square of directions.
        blocks: u32,
    }

    /// `guide_hemispheres`: one warp per record.
    GuideRays {
        /// The first rays.
        hemispheres: HemisphereRays,
        /// The records that see different things: numbers of this batch.
        uneven: In<u32>,
        /// Result: by record and block, the second rays of all blocks up to this one.
        ends: Out<u32>,
        /// The place of the first one in `uneven`.
        first: u32,
        /// How many there are.
        count: u32,
        /// Second rays of a record.
        rays: u32,
        /// Padding to a multiple of eight bytes.
        spare: u32,
    }

    /// `come_closer`: one thread per record.
    ComeCloser {
        /// The near rays.
        hemispheres: HemisphereRays,
        /// The records; their levels change.
        records: Out<Record>,
        /// The same as places that ask.
        places: Out<LightPlace>,
    }

    /// `name_nodes`, `hide_nodes` and `list_nodes`: one thread per ray; `place_nodes`: one warp per node; `list_unlinked` and `sum_nodes`: one thread per
    /// listed node; `list_seen`: one thread per link of these; `link_nodes`: one thread per record; `reflect`: one warp per record.
    Bounce {
        /// The scene.
        scene: Scene,
        /// The rays.
        hemispheres: HemisphereRays,
        /// Names of nodes.
        names: Names,
        /// What arrives there.
        nodes: Out<Node>,
        /// Their records.
        records: Out<Record>,
        /// What their rays see, record by record.
        links: Out<NodeLink>,
        /// The nodes of which less is known than is asked.
        listed: Out<u32>,
        /// Their number.
        listed_count: Out<u32>,
        /// Those that are not linked.
        unlinked: Out<u32>,
        /// Their number.
        unlinked_count: Out<u32>,
        /// The number of linked nodes before.
        linked: u32,
        /// How many reflections are asked for.
        order: u32,
        /// By how many levels the cells that are asked are smaller than those that were asked at first.
        finer: i32,
        /// The first node: new, listed, or unlinked.
        first: u32,
        /// How many there are.
        count: u32,
        /// 1: all rays ask on where something is in the way; 0: those that see more than the mean.
        insist: u32,
    }

    /// `gather_coarse`: one warp per record.
    GatherCoarse {
        /// The rays.
        hemispheres: HemisphereRays,
        /// What the records gather.
        coarse: Out<CoarseLight>,
        /// The place of each in `coarse` after `first`; null if they follow each other.
        owners: In<u32>,
        /// The records that see different things: numbers of this batch.
        uneven: Out<u32>,
        /// Their number.
        uneven_count: Out<u32>,
        /// The place of the first one.
        first: u32,
        /// The number of rays that were cast before, to which these are added; 0: none.
        before: u32,
    }

    /// `gather_fine`: one warp per record; `take_light`: one thread per record.
    GatherFine {
        /// The near rays.
        hemispheres: HemisphereRays,
        /// The coarse records around.
        lookup: Lookup,
        /// What these gather.
        coarse: In<CoarseLight>,
        /// Result.
        fine: Out<SurfaceLight>,
        /// The records that see no coarse one: numbers of this batch.
        misses: Out<u32>,
        /// Their number.
        miss_count: Out<u32>,
        /// The place of the first record of this batch in `fine`.
        first: u32,
        /// The first of the records in `misses` that gather now.
        first_miss: u32,
        /// How many do.
        count: u32,
        /// Padding to a multiple of eight bytes.
        spare: u32,
    }

    /// `ask_light`, `find_normals`, `add_means`: one thread per ray; `mean_light`: one thread per place; `take_misses` and `answer_misses`: one thread per place
    /// that sees no record.
    GatherPoints {
        /// The scene.
        scene: Scene,
        /// Rays that found the surface points.
        rays: Rays,
        /// Their hits.
        hits: In<Hit>,
        /// The fine records around places.
        lookup: Lookup,
        /// What these receive.
        fine: In<SurfaceLight>,
        /// What is asked: two places per ray.
        places: Out<LightPlace>,
        /// The answers.
        means: Out<Vec3>,
        /// The places that see no record.
        misses: Out<u32>,
        /// Their number.
        miss_count: Out<u32>,
        /// These as records, as coarse as what they ask.
        records: Out<Record>,
        /// The same as places that ask.
        asked: Out<LightPlace>,
        /// What those receive as fine records.
        own: In<SurfaceLight>,
        /// What they gather as coarse ones; only if all surface points gather for themselves.
        coarse: In<CoarseLight>,
        /// The mean radiance that each surface point receives, by ray.
        light: Out<Vec3>,
        /// The normals of the surface points of this launch's rays; null if no material has an image of normals.
        normals: Out<Vec3>,
        /// What the samples of the camera's pixels see, sample by sample; null if a pixel has one.
        samples: In<Hit>,
        /// Number of pixels of `samples`.
        sampled_pixels: u64,
        /// Samples of a pixel in `samples`.
        sample_count: u32,
        /// The first pixel of `samples`.
        first_sampled: u32,
        /// The eye.
        eye: Vec3,
        /// The size of a pixel: a constant, and a multiple of its distance.
        spacing: [f32; 2],
        /// The largest size of fine cells, in pixels.
        pixels: f32,
        /// The least level of fine cells.
        least_level: i32,
        /// The first ray of this launch.
        first: u32,
        /// Number of rays, or of places.
        count: u32,
        /// The first of the places that see no record.
        first_miss: u32,
        /// 1: there are no records, and all surface points gather for themselves, by the same pattern.
        brute_force: u32,
        /// Padding to a multiple of eight bytes.
        spare: u32,
    }
}
