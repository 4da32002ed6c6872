//! Meshes: primitives of all triangle modes, placed once for every node that uses them.

use std::path::Path;

use glam::{DMat4, DVec3, Vec2, Vec3};
use gltf::{Document, Mesh, Primitive, Semantic, mesh::Mode};

use super::{accessor::Accessors, container::malformed, exact::Exact, material};
use crate::{
    LoadError, MeshPart,
    draft::{Draft, Placement},
};

/// Adds meshes to a draft, and counts what it cannot show.
pub(super) struct Primitives<'a> {
    accessors: Accessors<'a>,
    exact: &'a Exact,
    /// Replaces all materials of the file.
    material: Option<u32>,
    first_material: u32,
    /// Index of glTF's own default material, once a primitive has used it.
    default_material: Option<u32>,
    points_and_lines: usize,
    textured: usize,
}

impl<'a> Primitives<'a> {
    /// Adds the document's materials to the draft, in its order, unless the placement replaces them.
    pub(super) fn new(
        path: &'a Path,
        document: &Document,
        exact: &'a Exact,
        buffers: &'a [Vec<u8>],
        placement: &Placement,
        draft: &mut Draft,
    ) -> Result<Primitives<'a>, LoadError> {
        let first_material = draft.materials.len() as u32;
        let mut textured = 0;
        if placement.material.is_none() {
            for material in document.materials() {
                draft.materials.push(material::read(path, &material, exact)?);
                textured += usize::from(material.pbr_metallic_roughness().base_color_texture().is_some());
            }
        }
        Ok(Primitives {
            accessors: Accessors { path, buffers },
            exact,
            material: placement.material,
            first_material,
            default_material: None,
            points_and_lines: 0,
            textured,
        })
    }

    /// Adds all primitives of a mesh.
    pub(super) fn add(&mut self, mesh: &Mesh, transform: &DMat4, draft: &mut Draft) -> Result<(), LoadError> {
        mesh.primitives().try_for_each(|primitive| self.add_primitive(&primitive, transform, draft))
    }

    /// One sentence for each kind of thing that was left out.
    pub(super) fn warn(&self, draft: &mut Draft) {
        let path = self.accessors.path.display();
        if self.points_and_lines > 0 {
            let count = self.points_and_lines;
            draft.warnings.push(format!("{path}: {count} primitives of points or lines were left out"));
        }
        if self.textured > 0 {
            let count = self.textured;
            draft.warnings.push(format!("{path}: {count} materials have textures, which are not read"));
        }
    }

    fn add_primitive(&mut self, primitive: &Primitive, transform: &DMat4, draft: &mut Draft) -> Result<(), LoadError> {
        if matches!(primitive.mode(), Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip) {
            self.points_and_lines += 1;
            return Ok(());
        }
        let Some(positions) = primitive.get(&Semantic::Positions) else {
            return Ok(());
        };
        let positions: Vec<DVec3> = self.accessors.triples(&positions)?.into_iter().map(DVec3::from).collect();
        let normals = match primitive.get(&Semantic::Normals) {
            Some(normals) => self.accessors.triples(&normals)?,
            None => Vec::new(),
        };
        let uvs = match primitive.get(&Semantic::TexCoords(0)) {
            Some(uvs) => self.accessors.pairs(&uvs)?,
            None => Vec::new(),
        };
        let normals: Vec<Vec3> = normals.into_iter().map(|normal| DVec3::from(normal).as_vec3()).collect();
        let uvs: Vec<Vec2> = uvs.into_iter().map(|[u, v]| Vec2::new(u as f32, v as f32)).collect();
        for (name, length) in [("normals", normals.len()), ("texture coordinates", uvs.len())] {
            if length != 0 && length != positions.len() {
                let problem = format!("a primitive has {length} {name} for {} vertices", positions.len());
                return Err(malformed(self.accessors.path, problem));
            }
        }
        let triangles = self.triangles(primitive, positions.len())?;
        let material = self.material_index(primitive, draft)?;
        let part = MeshPart {
            positions: &positions,
            normals: &normals,
            uvs: &uvs,
            triangles: &triangles,
            ..Default::default()
        };
        draft.add(part, transform, |_| material)
    }

    fn triangles(&self, primitive: &Primitive, vertices: usize) -> Result<Vec<[u32; 3]>, LoadError> {
        let indices = match primitive.indices() {
            Some(accessor) => self.accessors.indices(&accessor)?,
            None => (0..vertices as u32).collect(),
        };
        if let Some(index) = indices.iter().find(|&&index| index as usize >= vertices) {
            let problem = format!("a primitive asks for vertex {index} of {vertices}");
            return Err(malformed(self.accessors.path, problem));
        }
        Ok(triangles(primitive.mode(), &indices))
    }

    fn material_index(&mut self, primitive: &Primitive, draft: &mut Draft) -> Result<u32, LoadError> {
        if let Some(material) = self.material {
            return Ok(material);
        }
        if let Some(index) = primitive.material().index() {
            return Ok(self.first_material + index as u32);
        }
        if let Some(default) = self.default_material {
            return Ok(default);
        }
        let index = draft.materials.len() as u32;
        draft.materials.push(material::read(self.accessors.path, &primitive.material(), self.exact)?);
        self.default_material = Some(index);
        Ok(index)
    }
}

/// Cuts strips and fans into triangles that face the same way (glTF 2.0, section 3.7.2.1). Indices left over are no triangle.
fn triangles(mode: Mode, indices: &[u32]) -> Vec<[u32; 3]> {
    match mode {
        Mode::Triangles => indices.as_chunks().0.to_vec(),
        Mode::TriangleStrip => indices
            .windows(3)
            .enumerate()
            .map(|(i, w)| if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[0], w[2], w[1]] })
            .collect(),
        Mode::TriangleFan => {
            indices.get(1..).unwrap_or_default().windows(2).map(|w| [w[0], w[1], indices[0]]).collect()
        }
        Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_and_fans_face_one_way() {
        assert_eq!(triangles(Mode::Triangles, &[0, 1, 2, 3, 4, 5, 6]), [[0, 1, 2], [3, 4, 5]]);
        assert_eq!(triangles(Mode::TriangleStrip, &[0, 1, 2, 3, 4]), [[0, 1, 2], [1, 3, 2], [2, 3, 4]]);
        assert_eq!(triangles(Mode::TriangleFan, &[0, 1, 2, 3]), [[1, 2, 0], [2, 3, 0]]);
        assert!(triangles(Mode::TriangleFan, &[]).is_empty());
    }
}
