//! Triangles that have a texture but no texture coordinates. They are not cut out by one, either.

use std::collections::HashMap;
use std::ops::Range;

use crate::{Material, Mesh, Opacity};

/// Gives the triangles in `ranges`, which have no texture coordinates, materials without texture. Returns a sentence if any of
/// them had a texture.
pub fn untextured(mesh: &mut Mesh, materials: &mut Vec<Material>, ranges: &[Range<usize>]) -> Option<String> {
    if !materials.iter().any(Material::needs_uvs) {
        return None;
    }
    let mut plain: HashMap<u32, u32> = HashMap::new();
    let mut count = 0;
    for triangle in ranges.iter().flat_map(|range| range.clone()) {
        let material = &mut mesh.materials[triangle];
        let Some(textured) = materials.get(*material as usize).filter(|known| known.needs_uvs()) else {
            continue;
        };
        *material = match plain.get(material) {
            Some(&known) => known,
            None => {
                let opacity = textured.opacity.map(|opacity| Opacity { texture: None, ..opacity });
                let dark = textured.emission_texture.is_some();
                let emission = if dark { Material::EMISSION_WITHOUT_IMAGE } else { textured.emission };
                materials.push(Material {
                    texture: None,
                    emission_texture: None,
                    normal_texture: None,
                    metallic_roughness_texture: None,
                    emission,
                    opacity,
                    ..textured.clone()
                });
                plain.insert(*material, materials.len() as u32 - 1);
                materials.len() as u32 - 1
            }
        };
        count += 1;
    }
    (count > 0).then(|| {
        format!(
            "{count} triangles have a texture but no texture coordinates, so their materials keep their plain colours"
        )
    })
}
