use glam::Vec3;
use lightmesh_scene::internals::texture::untextured;
use lightmesh_scene::{Material, Mesh, NormalMap, Opacity, OpacityChannel, TextureUse};

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
    let mut whole = opacity;
    whole.texture = None;
    assert_eq!(materials[2].opacity, Some(whole));
    assert_eq!(untextured(&mut mesh, &mut materials, &[0..1, 1..2]), None);
}
