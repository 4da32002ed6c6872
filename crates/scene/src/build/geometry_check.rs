//! Consistency checks of geometry: every index is in range, and lists that belong together have the same length. Loaders guarantee
//! this; geometry built by hand is checked here, when it is added and when it is prepared for ray tracing.

use glam::{DMat4, DVec4};
use rayon::prelude::*;

use super::mesh_part::MeshPart;
use crate::{Geometry, Instances, Material, Mesh};

/// Inconsistent geometry.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum GeometryError {
    /// A triangle refers to a vertex that does not exist.
    #[error(
        "triangle {triangle} has the vertex index {index}, but there are {vertices} vertices: indices count from 0"
    )]
    Vertex {
        /// Number of the triangle.
        triangle: usize,
        /// The index.
        index: u32,
        /// Number of vertices.
        vertices: usize,
    },
    /// An attribute does not have one value per vertex.
    #[error("there are {found} {attribute} for {vertices} vertices: give one per vertex, or none at all")]
    Attribute {
        /// `normals`, `uvs`, `colors` or `opacities`.
        attribute: &'static str,
        /// Number of values.
        found: usize,
        /// Number of vertices.
        vertices: usize,
    },
    /// The list of materials by triangle does not have one entry per triangle.
    #[error("there are {found} material indices for {triangles} triangles: give one per triangle")]
    MaterialCount {
        /// Number of entries.
        found: usize,
        /// Number of triangles.
        triangles: usize,
    },
    /// A triangle refers to a material that does not exist.
    #[error("triangle {triangle} has the material {index}, but there are {materials} materials: indices count from 0")]
    Material {
        /// Number of the triangle.
        triangle: usize,
        /// The index.
        index: u32,
        /// Number of materials.
        materials: usize,
    },
    /// A material reflects more than it receives.
    #[error(
        "material {index} (`{name}`) has a specular coefficient of {value}, which adds light: lower ks + ks_tinted to 1"
    )]
    Reflectance {
        /// Number of the material.
        index: usize,
        /// Its name.
        name: String,
        /// The largest channel of `ks` + `ks_tinted`.
        value: String,
    },
    /// A shape cannot be at a place.
    #[error(
        "place {place} of a shape squeezes, shears, enlarges or lessens it too much, or has no inverse: change the shape itself so, and place it by \
         a map that turns, moves, and scales it by factors from 1e-6 to 1e6"
    )]
    Place {
        /// Number of the place.
        place: usize,
    },
    /// A map is not affine: what its last row says would be lost.
    #[error(
        "the last row of transform {place} is {row} and not 0, 0, 0, 1: give an affine map for column vectors, with the translation in the last column"
    )]
    NotAffine {
        /// Number of the place.
        place: usize,
        /// The last row.
        row: String,
    },
    /// Shapes that are placed many times are not the last of all triangles, or not there.
    #[error("shapes in many places have to be the last triangles of a mesh: add them behind all others")]
    ShapesNotLast,
    /// More vertices or triangles than 32-bit indices can address.
    #[error("{vertices} vertices and {triangles} triangles are too many for 32-bit indices: split the scene")]
    TooLarge {
        /// Number of vertices.
        vertices: usize,
        /// Number of triangles.
        triangles: usize,
    },
}

/// Rows of affine maps end in 0, 0, 0, 1, but for rounding in their products and inverses.
const ROUNDING: f64 = 1e-9;

/// Whether nothing is lost if the last row of a map is taken for 0, 0, 0, 1.
pub fn is_affine(map: &DMat4) -> bool {
    let largest = map.to_cols_array().iter().fold(1.0_f64, |largest, number| largest.max(number.abs()));
    (map.row(3) - DVec4::W).abs().max_element() <= ROUNDING * largest
}

/// Fails if a map is not affine.
pub(super) fn check_affine(places: &[DMat4]) -> Result<(), GeometryError> {
    match places.iter().position(|place| !is_affine(place)) {
        None => Ok(()),
        Some(place) => {
            let [a, b, c, d] = places[place].row(3).to_array();
            Err(GeometryError::NotAffine { place, row: format!("{a}, {b}, {c}, {d}") })
        }
    }
}

impl Geometry {
    /// Checks that every vertex and material index is in range and all lengths match. A missing or incomplete texture is not an error:
    /// it counts as none. Runs in parallel, and takes little time compared with anything that is done with geometry.
    ///
    /// # Errors
    ///
    /// The first [`GeometryError`].
    pub fn check(&self) -> Result<(), GeometryError> {
        let mesh = &self.mesh;
        let (vertices, triangles) = (mesh.positions.len(), mesh.triangles.len());
        check_room(vertices, triangles)?;
        let attributes = [mesh.normals.len(), mesh.uvs.len(), mesh.colors.len(), mesh.opacities.len()];
        check_attributes(vertices, attributes)?;
        check_triangles(&mesh.triangles, vertices)?;
        check_instances(mesh)?;
        if mesh.materials.len() != triangles {
            return Err(GeometryError::MaterialCount { found: mesh.materials.len(), triangles });
        }
        if let Some(triangle) = first_beyond(&mesh.materials, self.materials.len()) {
            let index = mesh.materials[triangle];
            return Err(GeometryError::Material { triangle, index, materials: self.materials.len() });
        }
        check_materials(&self.materials)
    }
}

impl<P> MeshPart<'_, P> {
    /// Checks that every index is in range and all lengths match.
    pub(crate) fn check(&self) -> Result<(), GeometryError> {
        let vertices = self.positions.len();
        let attributes = [self.normals.len(), self.uvs.len(), self.colors.len(), self.opacities.len()];
        check_attributes(vertices, attributes)?;
        check_triangles(self.triangles, vertices)
    }
}

/// Fails unless shapes are the last of a mesh.
pub(crate) fn check_instances(mesh: &Mesh) -> Result<(), GeometryError> {
    let Instances { shapes, vertices, .. } = &mesh.instances;
    let ends = (shapes.end as usize, vertices.end as usize);
    let are_last = shapes.is_empty() || ends == (mesh.triangles.len(), mesh.positions.len());
    are_last.then_some(()).ok_or(GeometryError::ShapesNotLast)
}

/// Fails if a mirror adds light.
fn check_materials(materials: &[Material]) -> Result<(), GeometryError> {
    for (index, material) in materials.iter().enumerate() {
        if let Some(excess) = material.excess() {
            let (name, value) = (material.name.clone(), excess.max_element().to_string());
            return Err(GeometryError::Reflectance { index, name, value });
        }
    }
    Ok(())
}

/// Fails if the numbers of vertices or triangles do not fit in 32 bits.
pub(crate) fn check_room(vertices: usize, triangles: usize) -> Result<(), GeometryError> {
    let limit = u32::MAX as usize;
    if vertices > limit || triangles > limit {
        return Err(GeometryError::TooLarge { vertices, triangles });
    }
    Ok(())
}

/// Of normals, uvs, colors and opacities.
fn check_attributes(vertices: usize, found: [usize; 4]) -> Result<(), GeometryError> {
    for (attribute, found) in ["normals", "uvs", "colors", "opacities"].into_iter().zip(found) {
        if found != 0 && found != vertices {
            return Err(GeometryError::Attribute { attribute, found, vertices });
        }
    }
    Ok(())
}

fn check_triangles(triangles: &[[u32; 3]], vertices: usize) -> Result<(), GeometryError> {
    let indices = triangles.as_flattened();
    match first_beyond(indices, vertices) {
        Some(corner) => Err(GeometryError::Vertex { triangle: corner / 3, index: indices[corner], vertices }),
        None => Ok(()),
    }
}

/// The position of the first index that is not below `count`.
pub fn first_beyond(indices: &[u32], count: usize) -> Option<usize> {
    /// Number of indices that a thread checks at once, without branching between them.
    const RUN: usize = 1 << 14;
    let beyond = |index: u32| index as usize >= count;
    let runs = indices.par_chunks(RUN).enumerate();
    let found = runs.find_first(|(_, run)| run.iter().fold(false, |any, &index| any | beyond(index)));
    found.and_then(|(number, run)| Some(number * RUN + run.iter().position(|&index| beyond(index))?))
}
