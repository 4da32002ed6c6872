//! Triangles that have a texture but no texture coordinates. They are not cut out by one, either.

use std::collections::HashMap;
use std::ops::Range;

use crate::{Material, Mesh, Opacity};

/// Gives the triangles in `ranges`, which have no texture coordinates, materials without texture. Returns a sentence if any of
/// them had a texture.
pub(crate) fn untextured(mesh: &mut Mesh, materials: &mut Vec<Material>, ranges: &[Range<usize>]) -> Option<String> {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{NormalMap, OpacityChannel, TextureUse};
    use glam::Vec3;

    #[test]
    fn triangles_without_a_place_in_the_picture_are_plain() {
        let uses = TextureUse::new(0);
        let opacity = Opacity::by(uses, OpacityChannel::Red).with_factor(0.7);
        let textured = Material::default().with_texture(uses).with_opacity(opacity).named("oak");
        let textured = textured.with_emission(Vec3::ONE).with_emission_texture(uses);
        let textured = textured.with_normal_texture(NormalMap::new(uses)).with_metallic_roughness_texture(uses);
        let mut materials = vec![Material::default(), textured];
        let mut mesh = Mesh { materials: vec![1, 0, 1, 1, 1], ..Mesh::default() };
        let warning = untextured(&mut mesh, &mut materials, &[0..1, 1..3]).unwrap();
        assert!(warning.starts_with("2 triangles have a texture"), "{warning}");
        assert_eq!(mesh.materials, [2, 0, 2, 1, 1]);
        assert_eq!((materials.len(), materials[2].name.as_str(), materials[2].texture), (3, "oak", None));
        assert_eq!((materials[2].emission, materials[2].emission_texture), (Vec3::ZERO, None));
        assert_eq!((materials[2].normal_texture, materials[2].metallic_roughness_texture), (None, None));
        assert_eq!(materials[2].opacity, Some(Opacity { texture: None, ..opacity }));
        assert_eq!(untextured(&mut mesh, &mut materials, &[0..1, 1..2]), None);
    }
}
