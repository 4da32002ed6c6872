//! Wavefront OBJ with MTL, through `tobj` in double precision.
//!
//! tobj reads numbers, groups and materials and makes one vertex of every combination of place, normal and texture
//! coordinate. In front of it stands [`lines`], which checks each line, so that errors name it, and smooths what tobj would
//! misread. Points, lines and free-form surfaces are left out with a warning; polygons are cut into fans.

mod lines;
mod mtl;
#[cfg(test)]
mod tests;

use std::{cell::RefCell, path::Path};

use glam::{DVec3, Vec2, Vec3};

use self::{lines::Lines, mtl::Libraries};
use crate::{
    LoadError, MeshPart,
    draft::{Draft, Placement},
    error::Place,
    open::read_bytes,
};

/// Reads an OBJ file and its material libraries into `draft`.
pub(crate) fn read(path: &Path, placement: &Placement, draft: &mut Draft) -> Result<(), LoadError> {
    let bytes = read_bytes(path)?;
    let mut lines = Lines::new(path, &bytes);
    let libraries = RefCell::new(Libraries::default());
    let options = tobj::LoadOptions { triangulate: true, single_index: true, ..Default::default() };
    let loaded = tobj::load_obj_buf(&mut lines, &options, |name| libraries.borrow_mut().load(path, name));
    let libraries = libraries.into_inner();
    if let Some(failure) = libraries.failure {
        return Err(failure);
    }
    let (models, materials) = match loaded {
        Ok((models, materials)) => (models, materials.unwrap_or_default()),
        Err(error) => return Err(lines.failure(error)),
    };

    draft.warnings.extend(lines.warnings(&materials));
    let first = draft.materials.len() as u32;
    if placement.material.is_none() {
        draft.warnings.extend(libraries.warnings);
        draft.materials.extend(materials.iter().map(mtl::material));
    }
    for model in &models {
        let material = match (placement.material, model.mesh.material_id) {
            (Some(material), _) => material,
            (None, Some(id)) => first + id as u32,
            (None, None) => draft.default_material(),
        };
        add(&model.mesh, placement, material, draft)?;
    }
    Ok(())
}

fn add(mesh: &tobj::Mesh, placement: &Placement, material: u32, draft: &mut Draft) -> Result<(), LoadError> {
    let triples = |flat: &[f64]| flat.as_chunks().0.iter().map(|&triple| DVec3::from_array(triple)).collect::<Vec<_>>();
    let positions = triples(&mesh.positions);
    let normals: Vec<Vec3> = triples(&mesh.normals).iter().map(|normal| normal.as_vec3()).collect();
    let uvs: Vec<Vec2> = mesh.texcoords.as_chunks().0.iter().map(|&[u, v]| Vec2::new(u as f32, v as f32)).collect();
    let triangles = mesh.indices.as_chunks().0;
    let part = MeshPart { positions: &positions, normals: &normals, uvs: &uvs, triangles, ..Default::default() };
    draft.add(part, &placement.transform, |_| material)
}

/// The error for a line that cannot be used.
fn malformed(path: &Path, line: usize, problem: String, remedy: &str) -> LoadError {
    LoadError::Malformed { place: Place::line(path, line).into(), problem, remedy: remedy.to_owned() }
}
