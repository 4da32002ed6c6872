//! Numbers of the objects and materials that rays see, from 1; 0 is nothing. Twin: `ids.cuh`.

use std::collections::HashMap;

use lightmesh_scene::Geometry;

use crate::accel::Hit;
use crate::prepared::PreparedScene;

/// The number of what a ray sees: its object, and its material.
pub(crate) fn ids_of(scene: &PreparedScene, hit: &Hit) -> [u32; 2] {
    if !hit.is_some() {
        return [0; 2];
    }
    let mesh = &scene.scene.geometry.mesh;
    let material = mesh.materials[hit.triangle as usize] as usize;
    [mesh.objects.of(hit.triangle) + 1, scene.geometry.materials.numbers[material]]
}

/// Materials by name: those of the same name have one number.
pub(crate) struct MaterialIds {
    /// The number of each material.
    pub(crate) numbers: Vec<u32>,
    /// The name of each number.
    pub(crate) names: Vec<String>,
}

impl MaterialIds {
    /// A material without a name is called after its place.
    pub(crate) fn new(geometry: &Geometry) -> MaterialIds {
        let (mut known, mut names) = (HashMap::new(), Vec::new());
        let mut number = |(index, name): (usize, &String)| {
            let name = if name.is_empty() { format!("material {}", index + 1) } else { name.clone() };
            *known.entry(name).or_insert_with_key(|name| {
                names.push(name.clone());
                names.len() as u32
            })
        };
        let numbers = geometry.materials.iter().map(|material| &material.name).enumerate().map(&mut number).collect();
        MaterialIds { numbers, names }
    }
}

/// The numbers of objects and of materials with anything that only shows shadows, in order.
pub(crate) fn catchers(scene: &PreparedScene) -> [Vec<u32>; 2] {
    let geometry = &scene.scene.geometry;
    let mesh = &geometry.mesh;
    let is_catcher = |triangle: &u32| geometry.materials[mesh.materials[*triangle as usize] as usize].catcher;
    let triangles = (0..mesh.triangles.len() as u32).filter(is_catcher);
    let of = |triangle: u32| ids_of(scene, &Hit { triangle, ..Hit::MISS });
    let mut ids: [Vec<u32>; 2] = Default::default();
    for found in triangles.map(of) {
        ids.iter_mut().zip(found).for_each(|(ids, found)| ids.push(found));
    }
    ids.map(|mut ids| {
        ids.sort_unstable();
        ids.dedup();
        ids
    })
}

#[cfg(test)]
mod tests {
    use lightmesh_scene::Material;

    use super::*;

    #[test]
    fn materials_of_one_name_have_one_number() {
        let materials = ["a", "", "b", "a", ""].map(|name| Material::default().named(name)).to_vec();
        let ids = MaterialIds::new(&Geometry { materials, ..Geometry::default() });
        assert_eq!((ids.numbers, ids.names.join(",")), (vec![1, 2, 3, 1, 4], "a,material 2,b,material 5".to_owned()));
    }
}
