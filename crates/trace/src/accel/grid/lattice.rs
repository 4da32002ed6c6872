//! The geometry of a grid: equal cells over a box.
//!
//! # How far a walk can err
//!
//! Let r be half the longest edge of the box around the triangles and ε = 2⁻²⁴. Ray origins lie within 8 r of its centre
//! (`ray_clamp`), so that every coordinate relative to an origin is below S = 10 r. Planes are multiples of the cell size,
//! relative to the grid's corner. On each axis,
//!
//! * a reported hit lies up to 9 ε S outside its triangle;
//! * the origin relative to the corner is rounded by ε S, at each of two levels;
//! * a plane is rounded by ε S, at each of two levels;
//! * a crossing parameter errs by as much as 3 ε S of distance along the ray;
//! * the point that determines the first cell errs by 4 ε S;
//! * a direction component treated as zero moves the ray by less than ε S.
//!
//! That is 21 ε S. A triangle is therefore listed in every cell that it meets once the cell is enlarged by
//! 32 ε S = 320 ε r on all sides: see [`margin`].

use glam::{DVec3, UVec3, Vec3};
use lightmesh_scene::Bounds;

/// The margin by which cells are enlarged when triangles are sorted into them, for triangles in a box of half edge `radius`.
pub(super) fn margin(radius: f32) -> f32 {
    320.0 / (1u32 << 24) as f32 * radius
}

/// `dims` cells of edge lengths `size`, from the corner `origin` on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lattice {
    pub(super) origin: DVec3,
    pub(super) size: Vec3,
    pub(super) dims: UVec3,
}

impl Lattice {
    /// `dims` cells over `bounds`, which are first enlarged by twice the margin (so that flat scenes have a volume).
    pub(super) fn new(bounds: &Bounds, margin: f32, dims: UVec3) -> Lattice {
        let border = DVec3::splat(2.0 * f64::from(margin));
        let origin = bounds.min.as_dvec3() - border;
        let extent = bounds.max.as_dvec3() + border - origin;
        Lattice { origin, size: (extent / dims.as_dvec3()).as_vec3(), dims }
    }

    /// The lattice of `dims` cells over one cell of this one.
    pub(super) fn nested(&self, cell: UVec3, dims: UVec3) -> Lattice {
        Lattice { origin: self.corner(cell), size: self.size / dims.as_vec3(), dims }
    }

    /// The lowest corner of a cell.
    pub(super) fn corner(&self, cell: UVec3) -> DVec3 {
        self.origin + self.size.as_dvec3() * cell.as_dvec3()
    }

    /// Number of cells.
    pub(super) fn len(&self) -> usize {
        self.dims.as_u64vec3().element_product() as usize
    }

    /// Position of a cell in the list of offsets.
    pub(super) fn index(&self, cell: UVec3) -> usize {
        let [x, y, z] = cell.to_array().map(|index| index as usize);
        (z * self.dims.y as usize + y) * self.dims.x as usize + x
    }

    /// The first and the last cell that the box, enlarged by `margin`, overlaps; `None` if it overlaps none.
    pub(super) fn cells(&self, bounds: &Bounds, margin: f32) -> Option<(UVec3, UVec3)> {
        let margin = f64::from(margin);
        let size = self.size.as_dvec3();
        let low = ((bounds.min.as_dvec3() - margin - self.origin) / size).floor();
        let high = ((bounds.max.as_dvec3() + margin - self.origin) / size).floor();
        let last = self.dims.as_dvec3() - 1.0;
        let meets = low.cmple(last).all() && high.cmpge(DVec3::ZERO).all() && low.cmple(high).all();
        meets.then(|| (low.max(DVec3::ZERO).as_uvec3(), high.min(last).as_uvec3()))
    }
}

/// All cells from `first` to `last`, x fastest.
pub(super) fn cells_between(first: UVec3, last: UVec3) -> impl Iterator<Item = UVec3> {
    (first.z..=last.z)
        .flat_map(move |z| (first.y..=last.y).flat_map(move |y| (first.x..=last.x).map(move |x| UVec3::new(x, y, z))))
}
