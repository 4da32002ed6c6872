//! The scene in a device's memory.

use crate::In;
use crate::constants::{MAX_ROWS, MAX_WORDS};
use crate::geometry::{AlphaMask, BruteForce, Bvh, Grid, InstancedBvh, Triangles, Vec3};
use crate::record::records;

records! {
    /// A light; fields that its kind does not use are zero.
    Light {
        /// Centre of the light.
        position: Vec3,
        /// Kind of light: one of [`Light`]'s constants.
        kind: u32,
        /// Direction of a directional light or a spot, or the normal of a disk or of an emissive surface.
        direction: Vec3,
        /// Radius of a sphere, disk or spot, spread of a point light. Of the disk that a directional light comes from: at distance 1.
        radius: f32,
        /// Half edge of a rectangle, or a tangent of a disk or of a directional light's disk.
        half_u: Vec3,
        /// The largest distance of a point of the light from its centre, for a directional light at distance 1; 0 for lights without an
        /// area.
        size: f32,
        /// The other half edge or tangent.
        half_v: Vec3,
        /// 1: falls off with the square of the distance.
        inverse_square: u32,
        /// Strength.
        intensity: Vec3,
        /// Cosine of a spot's outer angle.
        cos_outer: f32,
        /// 1 / (cos inner − cos outer) of a spot; 0 for lights without a cone.
        cone_scale: f32,
        /// A power of two: vectors to the light are multiplied by it, so that their products with triangles do not overflow.
        scale: f32,
        /// 1: it stands for an emissive surface.
        surface: u32,
        /// How it is seen, bits of [`Light`]'s constants.
        seen: u32,
        /// The radius of an emissive ball that it stands for, which hides none of its light; else 0.
        body: f32,
    }

    /// The vertices of a triangle.
    Indices {
        /// Vertex numbers.
        vertices: [u32; 3],
    }

    /// Texture coordinates of a vertex.
    Uv { u: f32, v: f32, }

    /// A level of a texture below the image itself.
    TextureLevel {
        /// Row by row, three channels of [`TEXEL_BITS`](crate::constants::TEXEL_BITS) bits, red in the lowest ones.
        texels: In<u64>,
        /// Width and height; at least 1.
        size: [u32; 2],
    }

    /// A texture on a material: the image, and how texture coordinates are mapped to it.
    Texture {
        /// Row by row, red in the lowest byte.
        texels: In<u32>,
        /// The levels below the image, from the largest to the one that is a single texel.
        levels: In<TextureLevel>,
        /// Width and height; at least 1.
        size: [u32; 2],
        /// Wrapping beyond its edges, horizontally and vertically: see [`Texture`]'s constants.
        wrap: [u32; 2],
        /// The step in the image for a step in u.
        u_axis: [f32; 2],
        /// The step in the image for a step in v.
        v_axis: [f32; 2],
        /// The position of texture coordinates (0, 0).
        translation: [f32; 2],
        /// Number of levels below the image.
        level_count: u32,
        /// Where the linear values of its codes begin in the scene's table.
        first_code: u32,
    }

    /// What facets reflect of light from all sides.
    FacetShare {
        /// As a multiple of what they reflect at normal incidence.
        normal: f32,
        /// As a multiple of what they reflect at grazing incidence.
        grazing: f32,
    }

    /// The coefficients of formula (1).
    Material {
        /// Ambient.
        ka: Vec3,
        /// Phong exponent.
        shininess: f32,
        /// Diffuse.
        kd: Vec3,
        /// 1: surface points have a tint; 0: the coefficients apply everywhere, and those to be tinted are added to the others.
        tinted: u32,
        /// Specular.
        ks: Vec3,
        /// Index of its texture, or [`Material::NO_TEXTURE`].
        texture: u32,
        /// Emitted light.
        emission: Vec3,
        /// 1: only the shadows on it are seen.
        catcher: u32,
        /// The specular part that is tinted.
        ks_tinted: Vec3,
        /// Its number among names, from 1.
        number: u32,
        /// The emitted light that is tinted.
        emission_tinted: Vec3,
        /// 1: lights stand for what it emits.
        lamp: u32,
        /// What is left of light that goes straight on: at a surface point all of it; of a material, if it went through nothing else than
        /// its filter.
        transmittance: Vec3,
        /// 1: light goes through as far as the opacity is below 1.
        blends: u32,
        /// Absorption coefficient of the body that the surface bounds.
        absorption: Vec3,
        /// Its index of refraction; 0 without one.
        ior: f32,
        /// 1: surfaces are thin walls.
        thin: u32,
        /// At a surface point that bends light: n₁/n₂, from the side of the viewer to the other; else 0.
        eta: f32,
        /// Index of the texture that emitted light is multiplied with, or [`Material::NO_TEXTURE`].
        emission_texture: u32,
        /// Index of the image of its normals, or [`Material::NO_TEXTURE`].
        normal_texture: u32,
        /// At a surface point with an image of normals: the unit normal without it.
        smooth: Vec3,
        /// What the slopes of the image of normals are multiplied with.
        normal_scale: f32,
        /// 1: it reflects by facets; then the coefficients of a material are its base colour and its layer.
        facets: u32,
        /// Roughness of the facets.
        roughness: f32,
        /// How metallic they are.
        metallic: f32,
        /// What they reflect at grazing incidence.
        grazing: f32,
        /// What is reflected of light from all sides, where it is gathered.
        all: Vec3,
        /// At a surface point with facets: the square of the width of their lobe.
        square: f32,
        /// What is mirrored.
        mirrored: Vec3,
        /// At a surface point with facets: the same for the part of the surface that is seen.
        seen_square: f32,
        /// At a surface point with facets: what repeated reflection adds, a factor.
        gain: Vec3,
        /// At a surface point with facets: the cosine between the normal and the direction to the eye.
        cosine: f32,
        /// At a surface point with facets: the share of reflections that mirror rays show.
        shown: f32,
        /// At a surface point with facets: the same of what an image alone shows, also where the last mirror ray ends.
        boxed: f32,
        /// At a surface point with facets: the share of the reflections of lights that they do not show.
        unmirrored: f32,
        /// At a surface point with facets: how opaque it is.
        opacity: f32,
        /// Index of the image that roughness and `metallic` of its facets are multiplied with, or [`Material::NO_TEXTURE`].
        metallic_roughness_texture: u32,
    }

    /// A level of an environment.
    EnvironmentLevel {
        /// Radiances row by row, from the top.
        texels: In<Vec3>,
        /// Width and height; at least 1.
        size: [u32; 2],
    }

    /// What surrounds a scene.
    Environment {
        /// The image, and its means from the largest to the one that is a single texel; null if nothing surrounds the scene.
        levels: In<EnvironmentLevel>,
        /// The same for light that is gathered, without what is lights.
        gathered: In<EnvironmentLevel>,
        /// Unit vector to the right of the image's middle.
        east: Vec3,
        /// Number of means below the image.
        lower: u32,
        /// Unit vector to the image's top.
        up: Vec3,
        /// 1: the camera sees the background instead.
        hidden: u32,
        /// Unit vector to the image's middle.
        north: Vec3,
        /// The distance of the sun's edge from its centre, one unit away; negative if there is none.
        sun_radius: f32,
        /// Unit vector to the sun.
        sun: Vec3,
        /// Number of means below the image for light that is gathered.
        gathered_lower: u32,
        /// Radiance of the sun.
        sun_radiance: Vec3,
        /// 1: the ambient light is the irradiance of the environment by the terms below.
        lights: u32,
        /// Coefficients of 1, x, y, z, xy, yz, zx, z² and x² − y² of a normal: red, green and blue of each.
        terms: [f32; 27],
        /// Padding to a multiple of eight bytes.
        spare_b: u32,
    }

    /// Everything about a scene that kernels need. Of the three structures, the one that rays traverse is present; and the BVH, if
    /// short tests go by cell.
    Scene {
        /// By index in the mesh.
        triangles: Triangles,
        /// Three vertices per triangle; null if vertices have no attributes.
        indices: In<Indices>,
        /// By vertex; null if there are none.
        normals: In<Vec3>,
        /// Texture coordinates by vertex; null if no texture needs them.
        uvs: In<Uv>,
        /// Colours by vertex; null if there are none.
        colors: In<Vec3>,
        /// Textures, by material.
        textures: In<Texture>,
        /// Linear values of the 256 codes of sRGB, and of those of data.
        codes: In<f32>,
        /// The material of each triangle.
        triangle_materials: In<u32>,
        /// Materials.
        materials: In<Material>,
        /// What facets reflect of light from all sides, [`FACET_PLACES`](crate::constants::FACET_PLACES)² of them by roughness, then by the root
        /// of the cosine; null if there are none.
        facet_table: In<FacetShare>,
        /// The first triangle of each run of one object; null if nothing has a name.
        object_starts: In<u32>,
        /// The object of each run, from 0.
        objects: In<u32>,
        /// Lights.
        lights: In<Light>,
        /// [`LIGHT_TARGETS`](crate::constants::LIGHT_TARGETS) points on each light, from which its unshadowed light is computed; of a
        /// directional light at distance 1 from the origin.
        light_targets: In<Vec3>,
        /// Where triangles are cut out, and how opaque they are.
        alpha_mask: AlphaMask,
        /// What surrounds it.
        environment: Environment,
        /// The regular grid.
        grid: Grid,
        /// The wide BVH.
        bvh: Bvh,
        /// The test of all triangles, for reference.
        brute_force: BruteForce,
        /// The wide BVH over instances.
        instanced: InstancedBvh,
        /// Number of lights.
        light_count: u32,
        /// I_a of formula (1).
        ambient: Vec3,
        /// Radiance of rays that miss everything.
        background: Vec3,
        /// Centre of the scene.
        center: Vec3,
        /// Minimum distance of a directional light.
        far: f32,
        /// Number of these runs.
        object_runs: u32,
        /// 1: rays see lights as surfaces.
        seen_lights: u32,
        /// Padding to a multiple of eight bytes.
        spare: u32,
    }

    /// How area lights are sampled.
    Sampling {
        /// The user's seed.
        seed: u64,
        /// Shadow rays per area light.
        samples: u32,
        /// 1: point lights are distributed over their spread.
        spread: u32,
    }

    /// Samples of an emitter in rows, all or some of them. Entries of arrays are by row unless stated.
    SampleRows {
        /// Position across the emitter, in [-1, 1].
        y: [f32; MAX_ROWS as usize],
        /// Samples per unit of length along the row.
        density: [f32; MAX_ROWS as usize],
        /// Half the number of samples.
        half: [f32; MAX_ROWS as usize],
        /// By how much of their distance samples are shifted, in addition to the surface point's own shift; in [0, 1).
        shift: [f32; MAX_ROWS as usize],
        /// Number of samples.
        count: [u32; MAX_ROWS as usize],
        /// Bit of the first sample in its word.
        place: [u32; MAX_ROWS as usize],
        /// The row of the emitter that the samples belong to: two lines of a rectangle share one.
        line: [u32; MAX_ROWS as usize],
        /// The end of each word's rows, by word.
        ends: [u32; MAX_WORDS as usize],
        /// All bits, by word.
        full: [u32; MAX_WORDS as usize],
        /// Number of rows.
        rows: u32,
        /// Number of words.
        words: u32,
        /// Number of rows of the whole emitter.
        lines: u32,
        /// Number of rows of the whole emitter that have a sample too many; only a rectangle's.
        surplus: u32,
        /// The line that enters the rectangle within its length, or MAX_ROWS.
        entering: u32,
        /// The line that leaves it, or MAX_ROWS.
        leaving: u32,
    }
}
