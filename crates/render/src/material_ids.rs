//! Numbers of materials, from 1, and their names.

use std::collections::HashMap;

use lightmesh_scene::Geometry;

/// Materials by name: those of the same name have one number.
#[derive(Clone)]
pub struct MaterialIds {
    /// The number of each material.
    pub numbers: Vec<u32>,
    /// The name of each number.
    pub names: Vec<String>,
}

impl MaterialIds {
    /// A material without a name is called after its place.
    pub fn new(geometry: &Geometry) -> MaterialIds {
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
