use lightmesh_scene::internals::texture::packed;
use lightmesh_scene::{OpacityChannel, Texture};

fn texture(name: &str, size: [u32; 2], texels: &[[u8; 4]]) -> Texture {
    Texture { name: name.into(), size, texels: texels.to_vec() }
}

#[test]
fn each_image_has_a_channel() {
    let rough = texture("a", [2, 1], &[[10, 10, 10, 255], [20, 20, 20, 255]]);
    let metal = texture("b", [2, 1], &[[1, 2, 3, 4], [5, 6, 7, 8]]);
    let (rough, metal) = (Some((&rough, OpacityChannel::Luminance)), Some((&metal, OpacityChannel::Blue)));
    let both = packed([rough, metal]);
    assert_eq!((both.size, both.texels), ([2, 1], vec![[255, 10, 3, 255], [255, 20, 7, 255]]));
    assert_eq!(both.name, "a as roughness, b as metallic");
    let alone = packed([None, metal]);
    assert_eq!((alone.name, alone.texels[1]), ("b as metallic".into(), [255, 255, 7, 255]));
    assert_eq!(packed([rough, None]).texels[1], [255, 20, 255, 255]);
}

#[test]
fn the_smaller_image_is_stretched() {
    let small = texture("a", [2, 1], &[[10; 4], [20; 4]]);
    let large = texture("b", [3, 2], &[[0; 4], [1; 4], [2; 4], [3; 4], [4; 4], [5; 4]]);
    let (small, large) = (Some((&small, OpacityChannel::Red)), Some((&large, OpacityChannel::Red)));
    let green = |texture: &Texture| texture.texels.iter().map(|texel| texel[1]).collect::<Vec<_>>();
    let found = packed([small, large]);
    assert_eq!((found.size, green(&found)), ([3, 2], vec![10, 20, 20, 10, 20, 20]));
    assert_eq!(green(&packed([large, small])), [0, 1, 2, 3, 4, 5]);
}
