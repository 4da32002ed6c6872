//! Whether geometry holds together: every index leads somewhere, and lists that belong together have one length. Loaders see to it;
//! geometry put together by hand is checked here, when it is added and when it is prepared for rays.

use rayon::prelude::*;

use crate::{Geometry, MeshPart};

/// Geometry that does not hold together.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum GeometryError {
    /// A triangle has a corner that is not there.
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
    /// An attribute has not one value per vertex.
    #[error("there are {found} {attribute} for {vertices} vertices: give one a vertex, or none at all")]
    Attribute {
        /// `normals`, `uvs` or `colors`.
        attribute: &'static str,
        /// How many there are.
        found: usize,
        /// Number of vertices.
        vertices: usize,
    },
    /// The list of materials by triangle has another length than that of triangles.
    #[error("there are {found} material indices for {triangles} triangles: give one a triangle")]
    MaterialCount {
        /// How many there are.
        found: usize,
        /// Number of triangles.
        triangles: usize,
    },
    /// A triangle has a material that is not there.
    #[error("triangle {triangle} has the material {index}, but there are {materials} materials: indices count from 0")]
    Material {
        /// Number of the triangle.
        triangle: usize,
        /// The index.
        index: u32,
        /// Number of materials.
        materials: usize,
    },
    /// More than 32-bit indices can tell apart.
    #[error("{vertices} vertices and {triangles} triangles are more than 32-bit indices tell apart: split the scene")]
    TooLarge {
        /// Number of vertices.
        vertices: usize,
        /// Number of triangles.
        triangles: usize,
    },
}

impl Geometry {
    /// Checks that every index of a vertex or material leads somewhere and all lengths fit. A texture that is not there, or not whole,
    /// is no error: it counts as none. In parallel, and short beside anything that is done with geometry.
    ///
    /// # Errors
    ///
    /// The first [`GeometryError`] that there is.
    pub fn check(&self) -> Result<(), GeometryError> {
        let mesh = &self.mesh;
        let (vertices, triangles) = (mesh.positions.len(), mesh.triangles.len());
        check_room(vertices, triangles)?;
        check_attributes(vertices, mesh.normals.len(), mesh.uvs.len(), mesh.colors.len())?;
        check_triangles(&mesh.triangles, vertices)?;
        if mesh.materials.len() != triangles {
            return Err(GeometryError::MaterialCount { found: mesh.materials.len(), triangles });
        }
        if let Some(triangle) = first_beyond(&mesh.materials, self.materials.len()) {
            let index = mesh.materials[triangle];
            return Err(GeometryError::Material { triangle, index, materials: self.materials.len() });
        }
        Ok(())
    }
}

impl<P> MeshPart<'_, P> {
    /// Checks that every index leads somewhere and all lengths fit.
    pub(crate) fn check(&self) -> Result<(), GeometryError> {
        let vertices = self.positions.len();
        check_attributes(vertices, self.normals.len(), self.uvs.len(), self.colors.len())?;
        check_triangles(self.triangles, vertices)
    }
}

/// Fails where numbers of vertices or triangles do not fit 32 bits.
pub(crate) fn check_room(vertices: usize, triangles: usize) -> Result<(), GeometryError> {
    let limit = u32::MAX as usize;
    if vertices > limit || triangles > limit {
        return Err(GeometryError::TooLarge { vertices, triangles });
    }
    Ok(())
}

fn check_attributes(vertices: usize, normals: usize, uvs: usize, colors: usize) -> Result<(), GeometryError> {
    for (attribute, found) in [("normals", normals), ("uvs", uvs), ("colors", colors)] {
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

/// The place of the first index that is not below `count`.
fn first_beyond(indices: &[u32], count: usize) -> Option<usize> {
    /// Indices that a thread looks at in one go, without a branch among them.
    const RUN: usize = 1 << 14;
    let beyond = |index: u32| index as usize >= count;
    let runs = indices.par_chunks(RUN).enumerate();
    let found = runs.find_first(|(_, run)| run.iter().fold(false, |any, &index| any | beyond(index)));
    found.and_then(|(number, run)| Some(number * RUN + run.iter().position(|&index| beyond(index))?))
}

#[cfg(test)]
mod tests {
    use glam::{DMat4, DVec3, Vec2, Vec3};

    use super::*;
    use crate::{Material, Mesh, SceneBuilder};

    const CORNERS: [DVec3; 4] = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];

    fn geometry() -> Geometry {
        let mesh = Mesh {
            positions: CORNERS.map(|corner| corner.as_vec3()).to_vec(),
            triangles: vec![[0, 1, 2], [1, 2, 3]],
            materials: vec![0, 1],
            ..Mesh::default()
        };
        Geometry { mesh, materials: vec![Material::default(); 2], ..Geometry::default() }
    }

    fn message(change: impl FnOnce(&mut Geometry)) -> String {
        let mut geometry = geometry();
        assert_eq!(geometry.check(), Ok(()));
        change(&mut geometry);
        geometry.check().unwrap_err().to_string()
    }

    #[test]
    fn indices_that_lead_nowhere_are_named() {
        let vertex = message(|geometry| geometry.mesh.triangles[1][2] = 99);
        assert_eq!(vertex, "triangle 1 has the vertex index 99, but there are 4 vertices: indices count from 0");
        assert!(message(|geometry| geometry.mesh.triangles[0][0] = 4).contains("triangle 0 has the vertex index 4"));
        assert!(message(|geometry| geometry.mesh.materials[1] = 2).contains("triangle 1 has the material 2"));
        assert!(message(|geometry| geometry.materials.clear()).contains("there are 0 materials"));
    }

    #[test]
    fn lengths_that_do_not_fit_are_named() {
        let normals = message(|geometry| geometry.mesh.normals = vec![Vec3::X; 3]);
        assert_eq!(normals, "there are 3 normals for 4 vertices: give one a vertex, or none at all");
        assert!(message(|geometry| geometry.mesh.uvs = vec![Vec2::X; 5]).contains("5 uvs for 4"));
        assert!(message(|geometry| geometry.mesh.colors = vec![Vec3::X]).contains("1 colors for 4"));
        assert!(message(|geometry| geometry.mesh.materials.truncate(1)).contains("1 material indices for 2"));
    }

    #[test]
    fn the_first_of_many_is_found() {
        let mut indices = vec![7; 100_000];
        assert_eq!(first_beyond(&indices, 8), None);
        for place in [99_999, 70_000, 16_384, 16_383, 0] {
            indices[place] = 8;
            assert_eq!(first_beyond(&indices, 8), Some(place));
        }
        assert_eq!((first_beyond(&[], 0), first_beyond(&[u32::MAX], u32::MAX as usize)), (None, Some(0)));
    }

    #[test]
    fn a_part_that_does_not_hold_together_is_not_added() {
        let mut builder = SceneBuilder::new();
        let good = MeshPart { positions: &CORNERS, triangles: &[[0, 1, 3]], ..Default::default() };
        builder.add(good, &DMat4::IDENTITY, |_| 0).unwrap();
        let beyond = MeshPart { triangles: &[[0, 1, 2], [0, 99, 1]], ..good };
        let error = builder.add(beyond, &DMat4::IDENTITY, |_| 0).unwrap_err();
        assert_eq!(error, GeometryError::Vertex { triangle: 1, index: 99, vertices: 4 });
        let short = MeshPart { colors: &[Vec3::ONE; 3], ..good };
        assert!(matches!(builder.add(short, &DMat4::IDENTITY, |_| 0), Err(GeometryError::Attribute { .. })));
        assert_eq!((builder.triangle_count(), builder.vertex_count()), (1, 4));
        assert_eq!(builder.finish_scene("one").geometry.check(), Ok(()));
    }
}
