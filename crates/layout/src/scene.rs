//! The scene as a device holds it.

use crate::In;
use crate::geometry::{BruteForce, Bvh, Grid, Triangle, Vec3};
use crate::record::records;

records! {
    /// A light; what a kind does not need is zero.
    Light {
        /// Middle of the light.
        position: Vec3,
        /// Kind of light: one of [`Light`]'s constants.
        kind: u32,
        /// Where a directional light or a spot shines, or the normal of a disk.
        direction: Vec3,
        /// Radius of a sphere or disk, spread of a point light.
        radius: f32,
        /// Half edge of a rectangle, or a tangent of a disk.
        half_u: Vec3,
        /// The largest distance of a point of the light from its middle; 0 for all that have no size.
        size: f32,
        /// The other half edge or tangent.
        half_v: Vec3,
        /// 1: falls off with the square of the distance.
        inverse_square: u32,
        /// Strength.
        intensity: Vec3,
        /// Cosine of a spot's outer angle.
        cos_outer: f32,
        /// 1 / (cos inner − cos outer) of a spot.
        cone_scale: f32,
        /// For sixteen-byte steps.
        spare: [u32; 3],
    }

    /// The vertices of a triangle.
    Indices {
        /// Vertex numbers.
        vertices: [u32; 3],
    }

    /// Texture coordinates of a vertex.
    Uv { u: f32, v: f32, }

    /// A texture on a material: the image, and how texture coordinates lead into it.
    Texture {
        /// Row by row, red in the lowest byte, encoded as sRGB.
        texels: In<u32>,
        /// Width and height; at least 1.
        size: [u32; 2],
        /// What it shows beyond its edge, horizontally and vertically: see [`Texture`]'s constants.
        wrap: [u32; 2],
        /// Where a step in u leads in the image.
        u_axis: [f32; 2],
        /// Where a step in v leads.
        v_axis: [f32; 2],
        /// Where texture coordinates (0, 0) lie.
        translation: [f32; 2],
    }

    /// The coefficients of formula (1).
    Material {
        /// Ambient.
        ka: Vec3,
        /// Phong's exponent.
        shininess: f32,
        /// Diffuse.
        kd: Vec3,
        /// 1: surface points have a tint; 0: the coefficients are what they are, and those to be tinted are added to the others.
        tinted: u32,
        /// Specular.
        ks: Vec3,
        /// Index of its texture, or [`Material::NO_TEXTURE`].
        texture: u32,
        /// Light of its own.
        emission: Vec3,
        /// For sixteen-byte steps.
        spare_a: u32,
        /// The specular part that takes on the tint.
        ks_tinted: Vec3,
        /// For sixteen-byte steps.
        spare_b: u32,
        /// The light of its own that takes on the tint.
        emission_tinted: Vec3,
        /// For sixteen-byte steps.
        spare_c: u32,
    }

    /// Everything about a scene that kernels ask for. Of the three structures that one is there which rays walk; and the BVH, where
    /// short tests go by cell.
    Scene {
        /// By index in the mesh.
        triangles: In<Triangle>,
        /// Three vertices a triangle; null where vertices have nothing.
        indices: In<Indices>,
        /// By vertex; null where there are none.
        normals: In<Vec3>,
        /// Texture coordinates by vertex; null where no texture needs them.
        uvs: In<Uv>,
        /// Colours by vertex; null where there are none.
        colors: In<Vec3>,
        /// Textures, by material.
        textures: In<Texture>,
        /// Linear values of the 256 codes of sRGB.
        srgb: In<f32>,
        /// The material of each triangle.
        triangle_materials: In<u32>,
        /// Materials.
        materials: In<Material>,
        /// Lights.
        lights: In<Light>,
        /// [`LIGHT_TARGETS`](crate::constants::LIGHT_TARGETS) points on each light, from which its unshadowed light is computed.
        light_targets: In<Vec3>,
        /// The regular grid.
        grid: Grid,
        /// The wide BVH.
        bvh: Bvh,
        /// The oracle.
        brute_force: BruteForce,
        /// Number of lights.
        light_count: u32,
        /// I_a of formula (1).
        ambient: Vec3,
        /// What rays see that miss everything.
        background: Vec3,
        /// Middle of the scene.
        center: Vec3,
        /// How far a directional light stands away, at least.
        far: f32,
        /// For eight-byte size.
        spare: u32,
    }

    /// How area lights are sampled.
    Sampling {
        /// The user's seed.
        seed: u64,
        /// Shadow rays per area light.
        samples: u32,
        /// 1: point lights are strewn over their spread.
        spread: u32,
    }
}
