//! Gathered light: its tables, and the arguments of its kernels.

use crate::constants::BINS;
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
        /// Padding to a multiple of eight bytes.
        spare: u32,
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
    Site {
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

    /// Cells with their sites, some of which have a value: what they gather.
    SurfaceCells {
        /// The cells.
        cells: Names,
        /// By cell: the first site, and their number times 2³².
        ranges: Out<u64>,
        /// The sites of all cells.
        sites: Out<Site>,
        /// Their number.
        site_count: Out<u32>,
        /// By site: the number of its value, and one; 0 if it has none.
        values: Out<u32>,
        /// The site of each value.
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
    }

    /// A site that a place takes light from.
    Link {
        /// The number of the site.
        site: u32,
        /// Its weight.
        weight: f32,
    }

    /// Light by the direction that a surface faces, near the one that it faces.
    SurfaceLight {
        /// Mean radiance, by the cosine.
        mean: Vec3,
        /// How it changes as the normal turns: along x, y and z.
        tilt: [Vec3; 3],
    }

    /// Radiance by direction.
    Bins {
        /// Sums over rays.
        sums: [Vec3; BINS as usize],
        /// Numbers of rays.
        counts: [f32; BINS as usize],
    }

    /// What a coarse site gathers.
    FarLight {
        /// The light that it receives.
        light: SurfaceLight,
        /// The radiance that all rays see.
        all: Bins,
        /// That of rays that go far.
        beyond: Bins,
        /// 1: some rays do not.
        has_near: u32,
        /// Padding to a multiple of eight bytes.
        spare: u32,
    }

    /// What a fine site receives.
    FineLight {
        /// The light.
        light: SurfaceLight,
        /// The distance of what is nearest in front of it.
        nearest: f32,
        /// Padding to a multiple of eight bytes.
        spare: u32,
    }

    /// What a ray of a site sees.
    SeenRay {
        /// Where the other light is asked for.
        position: Vec3,
        /// The level of the cell that is asked.
        level: i32,
        /// Geometric normal there; unit length.
        normal: Vec3,
        /// The kind of surface; [`SURFACE_KINDS`](crate::constants::SURFACE_KINDS) if nothing is asked.
        kind: u32,
        /// Emitted light, light that lights give, or the surroundings.
        radiance: Vec3,
        /// The site that answers; none if something is in the way.
        node: u32,
        /// How much of the other light is reflected.
        kd: Vec3,
        /// Padding to a multiple of sixteen bytes.
        spare: u32,
    }

    /// What arrives at a site that rays of others hit.
    Node {
        /// After up to one reflection.
        first: Vec3,
        /// The distance of what is nearest in front of it.
        nearest: f32,
        /// After up to two.
        second: Vec3,
        /// How many of these are known.
        known: u32,
    }

    /// `take_sites`: one thread per site.
    TakeSites {
        /// All sites.
        sites: In<Site>,
        /// The numbers of those that are taken.
        numbers: In<u32>,
        /// Result.
        taken: Out<Site>,
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

    /// `find_cells`, `count_links`, `fill_links`, `settle_links` and `value_links`: one thread per place. `place_sites`: one warp per cell.
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
        /// Sites with their weights, place by place.
        links: Out<Link>,
        /// The distance of what is nearest to each place; null if that of sites counts.
        nearest: In<f32>,
        /// The values of the sites, if so.
        fine: In<FineLight>,
        /// Number of places, or of cells.
        count: u32,
        /// The first cell.
        first: u32,
    }

    /// `cast_fans`: one warp per site; `trace_fans` and `see`: one thread per ray; `nearest_of_fans`: one thread per site.
    Fans {
        /// The scene.
        scene: Scene,
        /// The rays: `list`.
        rays: Rays,
        /// How points on lights are chosen.
        sampling: Sampling,
        /// Counts shadow rays.
        tally: Tally,
        /// The sites.
        sites: In<Site>,
        /// The nodes that the sites are: for those whose light is known, lights are left out. Null if they are none.
        owners: In<u32>,
        /// All nodes.
        nodes: In<Node>,
        /// Rays, fan by fan.
        list: Out<ListedRay>,
        /// Shares of the mean radiance by the cosine.
        weights: Out<f32>,
        /// What the rays hit.
        hits: Out<Hit>,
        /// What they see.
        seen: Out<SeenRay>,
        /// The distance of what is nearest to each site.
        nearest: Out<f32>,
        /// Number of sites.
        count: u32,
        /// The side of the square that the rays of a site form.
        side: u32,
        /// How far they go, in cells of their site.
        reach: f32,
        /// 1: those that hit nothing see nothing, for others answer for them.
        is_near: u32,
        /// 1: there are lights for what lamps emit.
        lamps: u32,
        /// Padding to a multiple of eight bytes.
        spare: u32,
    }

    /// `name_nodes`, `list_nodes` and `hide_nodes`: one thread per ray; `reflect`: one thread per site; `place_nodes`: one warp per node;
    /// `sum_first` and `sum_second`: one thread per site.
    Bounce {
        /// The scene.
        scene: Scene,
        /// The rays.
        fans: Fans,
        /// Names of nodes.
        names: Names,
        /// What arrives there.
        nodes: Out<Node>,
        /// Their sites.
        sites: Out<Site>,
        /// When each was listed for the last time.
        stamps: Out<u32>,
        /// The nodes of which less is known than is asked.
        listed: Out<u32>,
        /// Their number.
        listed_count: Out<u32>,
        /// How many reflections are asked for.
        order: u32,
        /// Distinguishes this list from all before.
        stamp: u32,
        /// The first new node.
        first: u32,
        /// How many are new.
        count: u32,
    }

    /// `gather_far`: one warp per site.
    GatherFar {
        /// The rays.
        fans: Fans,
        /// What the sites gather.
        far: Out<FarLight>,
        /// The place of each in `far` after `first`; null if they follow each other.
        owners: In<u32>,
        /// The sites that see different things: numbers of this batch.
        uneven: Out<u32>,
        /// Their number.
        uneven_count: Out<u32>,
        /// The place of the first one.
        first: u32,
        /// The number of rays that were cast before, to which these are added; 0: none.
        before: u32,
    }

    /// `gather_fine`: one warp per site; `take_light`: one thread per site.
    GatherFine {
        /// The near rays.
        fans: Fans,
        /// The coarse sites around.
        lookup: Lookup,
        /// What these gather.
        far: In<FarLight>,
        /// Result.
        fine: Out<FineLight>,
        /// The sites that see no coarse one: numbers of this batch.
        alone: Out<u32>,
        /// Their number.
        alone_count: Out<u32>,
        /// The place of the first site of this batch in `fine`.
        first: u32,
        /// The first of the sites in `alone` that gather now.
        first_alone: u32,
        /// How many do.
        count: u32,
        /// Padding to a multiple of eight bytes.
        spare: u32,
    }

    /// `ask_light`, `find_normals`, `add_means`: one thread per ray; `mean_light`: one thread per place; `take_alone` and `give_alone`: one thread per place
    /// that sees no site.
    GatherPoints {
        /// The scene.
        scene: Scene,
        /// Rays that found the surface points.
        rays: Rays,
        /// Their hits.
        hits: In<Hit>,
        /// The fine sites around places.
        lookup: Lookup,
        /// What these receive.
        fine: In<FineLight>,
        /// What is asked: two places per ray.
        places: Out<LightPlace>,
        /// The answers.
        means: Out<Vec3>,
        /// The places that see no site.
        alone: Out<u32>,
        /// Their number.
        alone_count: Out<u32>,
        /// These as sites, as coarse as what they ask.
        sites: Out<Site>,
        /// The same as places that ask.
        asked: Out<LightPlace>,
        /// What those receive as fine sites.
        own: In<FineLight>,
        /// What they gather as coarse ones; only if all surface points gather for themselves.
        far: In<FarLight>,
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
        /// The first of the places that see no site.
        first_alone: u32,
        /// 1: there are no sites, and all surface points gather for themselves, by the same pattern.
        all_alone: u32,
        /// Padding to a multiple of eight bytes.
        spare: u32,
    }
}
