//! Smooth normals for meshes that have none.
//!
//! A file without vertex normals does not say which of its edges are creases. Here it is the angle that does: where two triangles meet at
//! less than the [crease angle](CreaseAngle), they are parts of one smooth surface. In steps:
//!
//! 1. Vertices at the same position are [welded](weld): their triangles meet there, whatever the vertices' other attributes.
//! 2. An edge is smooth if exactly two triangles have it, in opposite directions, their normals differ by less than the crease angle, and
//!    they are in the same smoothing group. Two that run along it in the same direction have different fronts; which of them is wrong is
//!    not known, and they are not smooth there. Neither are edges of three triangles and more.
//! 3. The corners around a point that are connected through smooth edges form a [fan](fans) and get one unit normal: the sum of the
//!    triangles' normals, weighted by corner angle (Thürmer, Wüthrich: *Computing Vertex Normals from Polygonal Facets*, Journal of Graphics
//!    Tools 3(1), 1998) times area (which Max compares with other weights: *Weights for Computing Vertex Normals from Facet Normals*,
//!    Journal of Graphics Tools 4(2), 1999): neither the way polygons are cut nor slivers at bevels turn it.
//! 4. A triangle with three fans whose triangles lie in one plane stays flat. Fans of such triangles alone have no normal; if no fan has one,
//!    neither has the mesh.
//! 5. Vertices with several normals are [split]. Triangles keep their order, their corners' order and positions.
//!
//! Degenerate triangles, and those with unusable coordinates, take no part in this: they have no edges, and do not move any normal.
//!
//! All steps take O(n log n) for every input and run in a fixed order. Angles are compared with a margin, for coordinates are rounded: a
//! prism whose edges are exactly as sharp as the crease angle has creases everywhere, and a plane that is not quite flat is a plane.

pub(crate) mod buckets;
mod crease;
mod error;
pub(crate) mod facets;
mod fans;
mod split;
pub(crate) mod steps;
mod triangles;
pub(crate) mod weld;

use glam::{DVec3, Vec3};
use lightmesh_memory::Budget;

use self::{
    facets::Facets,
    fans::{Fan, Fans},
    split::FLAT,
    triangles::Triangles,
};
use super::loaded_mesh::LoadedMesh;
use crate::Position;

pub use self::crease::CreaseAngle;
pub use self::error::Unsmooth;

/// Gives normals to a mesh that has none; returns how many vertices have one.
///
/// # Errors
///
/// [`Unsmooth`]; then the mesh is unchanged.
pub fn smooth<P: Position>(
    mesh: &mut LoadedMesh<P>,
    crease: CreaseAngle,
    usable: impl Fn(&P) -> bool,
    budget: &Budget,
) -> Result<usize, Unsmooth> {
    let (vertices, corners) = (mesh.positions.len() as u64, 3 * mesh.triangles.len() as u64);
    if corners > u64::from(u32::MAX) {
        return Err(Unsmooth::TooMany);
    }
    const INDEX: u64 = size_of::<u32>() as u64;
    // Of each vertex: its hash and index, its point, the start of its edges. Of each corner: an edge, a fan; a third of a normal.
    let sizes = [vertices * 4 * INDEX, corners * 2 * INDEX, corners / 3 * size_of::<DVec3>() as u64];
    budget.check(sizes.iter().sum())?;

    let triangles = Triangles { positions: &mesh.positions, triangles: &mesh.triangles };
    let facets = Facets::new(&triangles, usable);
    let points = weld::weld(&mesh.positions);
    let (numbers, count) = Fans::new(&triangles, &points, &facets, &mesh.groups, crease).into_numbers();
    drop(points);
    // And to split vertices: of each vertex the start of its corners, of each corner an index.
    budget.check((count * size_of::<Fan>()) as u64 + (vertices + corners) * INDEX)?;
    let fans = fans::summed(&triangles, &facets, &numbers, count);
    if !fans.iter().any(|fan| fan.is_used) {
        return Ok(0);
    }
    let number = |corner: u32| {
        let number = numbers[corner as usize];
        facets.of(corner).map(|_| if fans[number as usize].is_used { number } else { FLAT })
    };
    split::split(mesh, number, |number| fans[number as usize].normal.as_vec3(), budget)?;
    Ok(mesh.normals.iter().filter(|&&normal| normal != Vec3::ZERO).count())
}
