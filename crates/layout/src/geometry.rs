//! Rays, hits, and acceleration structures.

use crate::counters::Counters;
use crate::record::records;
use crate::{In, Out};

records! {
    /// Three coordinates or colours.
    Vec3 { x: f32, y: f32, z: f32, }

    /// Three coordinates in double precision.
    DVec3 { x: f64, y: f64, z: f64, }

    /// Where a ray meets a triangle; `triangle` is [`Hit::NONE`] if it meets none.
    Hit {
        /// Ray parameter.
        t: f32,
        /// Barycentric weight of the second corner.
        u: f32,
        /// Barycentric weight of the third corner.
        v: f32,
        /// Index of the triangle in the scene's mesh.
        triangle: u32,
    }

    /// Three corners as `float4`; the bits of the first `w` are the index in the mesh, those of the second the number of its
    /// [`CutTriangle`], from 1, or 0 if it is opaque, those of the third the number of the [`Instanced`] shape that is held in its place, from
    /// 1, or 0 if this is a triangle.
    Triangle {
        /// Corners.
        corners: [[f32; 4]; 3],
    }

    /// A shape at one of its places.
    Instanced {
        /// From the shape's coordinates to the local frame: three rows, each with its translation.
        place: [[f32; 4]; 3],
        /// The inverse.
        back: [[f32; 4]; 3],
        /// The index of its first triangle in the scene.
        first: u32,
        /// The index of the shape's first triangle where it is stored.
        stored: u32,
        /// The position of the shape's first triangle in the structure.
        leaves: u32,
        /// The root of the shape's tree.
        root: u32,
        /// The largest sum of absolute values in a row of `back`.
        norm: f32,
        /// The largest sum of absolute values that are added where a corner of its shape is placed.
        reach: f32,
        /// The largest coordinate of the local frame's origin in the shape's.
        shift: f32,
        /// The number of its object, from 0.
        object: u32,
    }

    /// Triangles by index: those that are stored, and from [`FIRST_INSTANCED`](crate::constants::FIRST_INSTANCED) on those of instances, which
    /// are computed.
    Triangles {
        /// Those that are stored; those of shapes in the shapes' coordinates.
        stored: In<Triangle>,
        /// In the order of their triangles.
        instances: In<Instanced>,
        /// Their number.
        instance_count: u32,
        /// Padding to a multiple of eight bytes.
        spare: u32,
    }

    /// How a triangle is cut out.
    CutTriangle {
        /// Texture coordinates of its corners.
        uvs: [[f32; 2]; 3],
        /// Opacities of its corners, by which those of the mask are multiplied.
        opacities: [f32; 3],
        /// Index of its mask.
        mask: u32,
    }

    /// How a material is cut out: opacities in an image, and how texture coordinates are mapped to it.
    Mask {
        /// From 0 to 255, row by row.
        texels: In<u8>,
        /// Width and height; at least 1.
        size: [u32; 2],
        /// Wrapping beyond its edges, as a [`Texture`](crate::scene::Texture)'s.
        wrap: [u32; 2],
        /// The step in the image for a step in u.
        u_axis: [f32; 2],
        /// The step in the image for a step in v.
        v_axis: [f32; 2],
        /// The position of texture coordinates (0, 0).
        translation: [f32; 2],
        /// The least opacity at which there is a surface, as texels count.
        limit: f32,
        /// 1: light goes through as far as the opacity is below 1.
        blends: u32,
    }

    /// Where triangles are cut out.
    AlphaMask {
        /// By number, from 1; null if nothing is cut out.
        triangles: In<CutTriangle>,
        /// Masks.
        masks: In<Mask>,
    }

    /// A compressed node of eight children (Ylitie, Karras, Laine: *Efficient Incoherent Ray Traversal on GPUs Through Compressed
    /// Wide BVHs*, HPG 2017), planes interleaved as `obvhs` does.
    BvhNode {
        /// Lowest corner.
        p: Vec3,
        /// Biased exponents of the plane distances.
        e: [u8; 3],
        /// Bit k: the child in slot k is a node.
        imask: u8,
        /// Index of the first child node.
        child_base: u32,
        /// Index of the first triangle.
        triangle_base: u32,
        /// Content of each slot.
        meta: [u8; 8],
        /// Lower x planes of the slots.
        min_x: [u8; 8],
        /// Upper x planes.
        max_x: [u8; 8],
        /// Lower y planes.
        min_y: [u8; 8],
        /// Upper y planes.
        max_y: [u8; 8],
        /// Lower z planes.
        min_z: [u8; 8],
        /// Upper z planes.
        max_z: [u8; 8],
    }

    /// The sphere of interest around the triangles: rays that start far away are moved to it.
    RayClamp {
        /// Centre of the box around the triangles.
        center: Vec3,
        /// Half its longest edge.
        radius: f32,
    }

    /// A wide BVH.
    Bvh {
        /// Root first.
        nodes: In<BvhNode>,
        /// In leaf order.
        triangles: In<Triangle>,
        /// Where they are cut out.
        alpha_mask: AlphaMask,
        /// The sphere around its triangles.
        ray_clamp: RayClamp,
        /// Number of nodes; 0 if there are no triangles.
        node_count: u32,
        /// Number of levels.
        depth: u32,
    }

    /// A wide BVH of two levels: one over triangles and the boxes around instances, and for each shape a tree in its own coordinates.
    InstancedBvh {
        /// Those of the scene, root first, then those of shapes.
        nodes: In<BvhNode>,
        /// In leaf order; triangles with the number of an instance are the boxes around it.
        triangles: In<Triangle>,
        /// Where they are cut out.
        alpha_mask: AlphaMask,
        /// By number, in the order of their triangles.
        instances: In<Instanced>,
        /// The sphere around all.
        ray_clamp: RayClamp,
        /// Number of nodes; 0 if there are no triangles.
        node_count: u32,
        /// Number of levels, of the scene's tree and the deepest shape's together.
        depth: u32,
        /// Number of instances.
        instance_count: u32,
        /// Padding to a multiple of eight bytes.
        spare: u32,
    }

    /// A regular grid with one or two levels, in the flat form of the thesis.
    Grid {
        /// `nx ny nz <offset>…`, cells, nested grids.
        cells: In<i32>,
        /// The triangles of all cells, one cell after another.
        triangles: In<Triangle>,
        /// For each cell of the outer grid, the distance to the nearest non-empty one, in cells; at most 255.
        distances: In<u8>,
        /// Lowest corner.
        origin: DVec3,
        /// Edges of a cell.
        size: Vec3,
        /// Number of cells along each axis.
        dims: [u32; 3],
        /// The sphere around its triangles.
        ray_clamp: RayClamp,
        /// Entries of `triangles`.
        triangle_count: u32,
        /// The margin by which cells were enlarged when triangles were sorted into them.
        margin: f32,
    }

    /// A list of triangles, all of which are tested.
    BruteForce {
        /// The usable triangles.
        triangles: In<Triangle>,
        /// Where they are cut out.
        alpha_mask: AlphaMask,
        /// The sphere around them.
        ray_clamp: RayClamp,
        /// Their number.
        count: u32,
        /// Padding to a multiple of eight bytes.
        spare: u32,
    }

    /// A camera and an image size, ready to generate rays; see the renderer's `view.rs`.
    View {
        /// The eye, or the centre of an orthographic image.
        origin: Vec3,
        /// Viewing direction.
        forward: Vec3,
        /// One pixel to the right.
        right: Vec3,
        /// One pixel down.
        down: Vec3,
        /// Unit vector along which depths are measured, from the origin on.
        axis: Vec3,
        /// Width and height of the window that is rendered, in pixels.
        size: [u32; 2],
        /// Column and row of its first pixel in the image; negative to the left of it and above.
        first: [i32; 2],
        /// Width and height of the image.
        whole: [u32; 2],
        /// The depth from which on surfaces are seen.
        near: f32,
        /// The depth up to which they are seen.
        far: f32,
        /// 1 if some depths are not seen.
        clips: u32,
        /// 1 for perspective, 0 for orthographic.
        perspective: u32,
        /// Padding to a multiple of eight bytes.
        spare: u32,
    }

    /// A ray from a mirror, or through a sample of a pixel.
    ListedRay {
        /// Origin.
        origin: Vec3,
        /// The pixel that it contributes to, y · width + x.
        pixel: u32,
        /// Direction; unit length.
        direction: Vec3,
        /// The number of the pixel's sample that it goes through, and one; 0 if the pixel has one sample.
        sample: u32,
        /// The share of its radiance that reaches the pixel.
        weight: Vec3,
        /// The samples of the pixel that are shaded with it, a bit each; 0 if none are.
        shared: u32,
    }

    /// The cone around a ray, or around each ray of a list.
    Cone {
        /// Its width where the ray begins.
        width: f32,
        /// By how much it widens per unit of distance.
        spread: f32,
    }

    /// Rays: those of some rows of a camera's image, generated where they are needed, or a list.
    ///
    /// Ray number `y' · width + x` of a camera belongs to column x of the y'-th of these rows.
    Rays {
        /// The camera.
        view: View,
        /// The rays of a list; null for a camera.
        list: In<ListedRay>,
        /// The cone of each ray of a list; null if all have the same.
        cones: In<Cone>,
        /// The first pixel of a camera's rows.
        first_pixel: u32,
        /// Number of rays.
        count: u32,
        /// How often they went on at surfaces: 0 for a camera's.
        depth: u32,
        /// How often they are mirrored at most.
        bounces: u32,
        /// The cone of all rays; without a width, textures are looked up at points.
        cone: Cone,
    }

    /// The counters that kernels add to.
    Tally {
        /// [`Tally::SHARDS`] shards.
        shards: Out<Counters>,
    }
}

impl From<[f32; 3]> for Vec3 {
    fn from([x, y, z]: [f32; 3]) -> Vec3 {
        Vec3 { x, y, z }
    }
}

impl From<[f64; 3]> for DVec3 {
    fn from([x, y, z]: [f64; 3]) -> DVec3 {
        DVec3 { x, y, z }
    }
}
