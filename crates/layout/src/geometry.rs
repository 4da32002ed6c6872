//! Rays, what they hit, and the structures that find it.

use crate::counters::Counters;
use crate::record::records;
use crate::{In, Out};

records! {
    /// Three coordinates or colours.
    Vec3 { x: f32, y: f32, z: f32, }

    /// Three coordinates in double precision.
    DVec3 { x: f64, y: f64, z: f64, }

    /// Where a ray meets a triangle; `triangle` is [`Hit::NONE`] where it meets none.
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

    /// Three corners as `float4`; the index in the mesh is the bits of the first `w`.
    Triangle {
        /// Corners.
        corners: [[f32; 4]; 3],
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
        /// What each slot holds.
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

    /// The sphere of interest around the triangles: where rays that start far away are brought to.
    Approach {
        /// Middle of the box around the triangles.
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
        /// Where its triangles are.
        approach: Approach,
        /// 0: there are no triangles.
        node_count: u32,
        /// Levels.
        depth: u32,
    }

    /// A regular grid of one or two levels in the flat form of the thesis.
    Grid {
        /// `nx ny nz <offset>…`, cells, nested grids.
        cells: In<i32>,
        /// The triangles of all cells, one cell after the other.
        triangles: In<Triangle>,
        /// For each cell of the outer grid the distance to the nearest one that holds something, in cells; at most 255.
        distances: In<u8>,
        /// Lowest corner.
        origin: DVec3,
        /// Edges of a cell.
        size: Vec3,
        /// Cells on each axis.
        dims: [u32; 3],
        /// Where its triangles are.
        approach: Approach,
        /// Entries of `triangles`.
        triangle_count: u32,
        /// By how much cells were enlarged when triangles were sorted into them.
        margin: f32,
    }

    /// Every triangle, always.
    BruteForce {
        /// The usable triangles.
        triangles: In<Triangle>,
        /// Where they are.
        approach: Approach,
        /// How many.
        count: u32,
        /// For eight-byte size.
        spare: u32,
    }

    /// A camera and a picture size, ready to make rays; see the renderer's `view.rs`.
    View {
        /// The eye, or the middle of an orthographic picture.
        origin: Vec3,
        /// Where it looks.
        forward: Vec3,
        /// One pixel to the right.
        right: Vec3,
        /// One pixel down.
        down: Vec3,
        /// Width and height in pixels.
        size: [u32; 2],
        /// 1 for perspective, 0 for orthographic.
        perspective: u32,
        /// For eight-byte size.
        spare: u32,
    }

    /// A ray from a mirror.
    ListedRay {
        /// Where it starts.
        origin: Vec3,
        /// The pixel that it brings light to, y · width + x.
        pixel: u32,
        /// Where it goes; unit length.
        direction: Vec3,
        /// For sixteen-byte steps.
        spare: u32,
        /// The share of its radiance that reaches the pixel.
        weight: Vec3,
        /// For sixteen-byte steps.
        spare_too: u32,
    }

    /// Rays: those of some rows of a camera's picture, made where they are needed, or a list.
    ///
    /// Ray number `y' · width + x` of a camera belongs to column x of the y'-th of these rows.
    Rays {
        /// The camera.
        view: View,
        /// The rays of mirrors; null for a camera.
        list: In<ListedRay>,
        /// The first pixel of a camera's rows.
        first_pixel: u32,
        /// Number of rays.
        count: u32,
    }

    /// Where kernels count.
    Tally {
        /// [`Tally::SHARDS`] of them.
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
