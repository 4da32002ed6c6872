use glam::{DVec3, Vec2, Vec3};
use lightmesh_layout::constants::TEXEL_ONE;
use lightmesh_memory::Budget;
use lightmesh_render::internals::textures::{AllLevels, Encoding, MipLevels, bytes_to_build, packed, unpacked};
use lightmesh_scene::{Geometry, Material, Mesh, Opacity, OpacityChannel, Texture, TextureUse};

fn texture(size: [u32; 2]) -> Texture {
    let texel = |index: u32| [(37 * index) as u8, (91 * index + 5) as u8, (index % 101 * index) as u8, 255];
    Texture { name: String::new(), size, texels: (0..size[0] * size[1]).map(texel).collect() }
}

fn colors(texture: &Texture) -> MipLevels {
    MipLevels::new(texture, Encoding::Color)
}

fn mean(texels: impl ExactSizeIterator<Item = Vec3>) -> DVec3 {
    let count = texels.len() as f64;
    texels.map(|texel| texel.as_dvec3()).sum::<DVec3>() / count
}

#[test]
fn sizes_are_halved_and_rounded_up_down_to_one_texel() {
    let sizes = |size| colors(&texture(size)).levels.iter().map(|level| level.size).collect::<Vec<_>>();
    assert_eq!(sizes([8, 8]), [[4, 4], [2, 2], [1, 1]]);
    assert_eq!(sizes([5, 3]), [[3, 2], [2, 1], [1, 1]]);
    assert_eq!(sizes([1, 6]), [[1, 3], [1, 2], [1, 1]]);
    assert_eq!(sizes([1, 1]), [[0; 2]; 0]);
    let largest = colors(&texture([1, 16384])).levels;
    assert_eq!((largest.len(), largest[13].size), (14, [1, 1]));
}

#[test]
fn every_level_has_the_mean_of_the_image() {
    for size in [[8, 8], [5, 3], [7, 7], [1, 13], [17, 1], [100, 37], [33, 64], [2, 3]] {
        let texture = texture(size);
        let wanted = mean(texture.texels.iter().map(|&texel| Encoding::Color.linear(texel)));
        for level in colors(&texture).levels {
            let found = mean(level.texels.iter().map(|&texel| unpacked(texel)));
            // Half a step of the format, and rounding.
            assert!((found - wanted).abs().max_element() < 7e-7, "{size:?}, {:?}: {found} {wanted}", level.size);
        }
    }
}

#[test]
fn texels_are_the_means_of_their_areas() {
    let grey = |values: &[u8], size| Texture {
        name: String::new(),
        size,
        texels: values.iter().map(|&value| [value, value, value, 255]).collect(),
    };
    let level = |texture: &Texture, level: usize| {
        let texels = &colors(texture).levels[level].texels;
        texels.iter().map(|&texel| unpacked(texel).x).collect::<Vec<_>>()
    };
    // In linear light: half of white, not the code in the middle.
    assert_eq!(level(&grey(&[0, 255, 255, 0], [4, 1]), 0), [0.5, 0.5]);
    assert_eq!(level(&grey(&[255, 255, 255, 0], [2, 2]), 0), [0.75]);
    // Three texels to two: the middle one belongs to both.
    let thirds = level(&grey(&[255, 0, 0], [3, 1]), 0);
    assert!((thirds[0] - 2.0 / 3.0).abs() < 1e-6 && thirds[1] == 0.0, "{thirds:?}");
    // Seven to four: the third covers the texels from 3.5 to 5.25.
    let sevenths = level(&grey(&[0, 0, 0, 255, 0, 255, 0], [7, 1]), 0);
    let wanted = [0.0, 0.5 / 1.75, 0.75 / 1.75, 0.75 / 1.75];
    assert!(sevenths.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-6), "{sevenths:?}");
}

#[test]
fn data_is_averaged_as_it_is() {
    let texture = Texture { name: String::new(), size: [2, 1], texels: vec![[0, 128, 255, 9], [255, 128, 51, 0]] };
    let mean = unpacked(MipLevels::new(&texture, Encoding::Data).levels[0].texels[0]);
    assert!((mean - Vec3::new(0.5, 128.0 / 255.0, 0.6)).abs().max_element() < 1e-6, "{mean}");
}

#[test]
fn black_white_and_what_is_in_between_survive_packing() {
    assert_eq!([0.0, 1.0, 0.5].map(|value| unpacked(packed(Vec3::splat(value))).y), [0.0, 1.0, 0.5]);
    let color = Vec3::new(0.1, 0.7, 0.0123);
    assert!((unpacked(packed(color)) - color).abs().max_element() <= 0.5 / TEXEL_ONE);
}

#[test]
fn what_is_cut_out_darkens_no_level() {
    // A green leaf in one corner of what is else black and cut out; a texel between them is half there.
    let (leaf, between, nothing) = ([0, 255, 0, 255], [0, 255, 0, 128], [0, 0, 0, 0]);
    for size in [[16, 16], [13, 7], [1, 9]] {
        let texel = |index: u32| match (index % size[0] + index / size[0]).cmp(&2) {
            std::cmp::Ordering::Less => leaf,
            std::cmp::Ordering::Equal => between,
            std::cmp::Ordering::Greater => nothing,
        };
        let texels = (0..size[0] * size[1]).map(texel).collect();
        let uses = TextureUse::new(0);
        let by = |channel| Material::default().with_texture(uses).with_opacity(Opacity::by(uses, channel));
        let levels = |material: Material| {
            let texture = Texture { name: String::new(), size, texels: Vec::clone(&texels) };
            let mesh = Mesh { uvs: vec![Vec2::ZERO], ..Mesh::default() };
            let scene =
                Geometry { textures: vec![texture].into(), materials: vec![material], mesh, ..Geometry::default() };
            let all = AllLevels::of(&scene, Budget::default()).unwrap().by_texture.remove(0);
            let all = &all[Encoding::Color as usize].levels;
            all.iter().flat_map(|level| &level.texels).map(|&texel| unpacked(texel)).collect::<Vec<_>>()
        };
        let near = |color: Vec3| (color - Vec3::Y).length() < 1e-5;
        assert!(levels(by(OpacityChannel::Alpha)).into_iter().all(near), "{size:?}");
        // Another channel, or none, leaves the image as it is.
        assert!(!levels(by(OpacityChannel::Green)).into_iter().all(near), "{size:?}");
        assert_eq!(levels(by(OpacityChannel::Green)), levels(Material::default().with_texture(uses)));
    }
}

#[test]
fn levels_that_do_not_fit_are_refused() {
    let uses = TextureUse::new(0);
    let scene = Geometry {
        textures: vec![texture([2048, 1024])].into(),
        materials: vec![Material::default().with_texture(uses)],
        mesh: Mesh { uvs: vec![Vec2::ZERO], ..Mesh::default() },
        ..Geometry::default()
    };
    assert_eq!(AllLevels::of(&scene, Budget::default()).unwrap().by_texture[0][0].levels.len(), 11);
    let (index, short) = AllLevels::of(&scene, Budget::new(Some(1))).unwrap_err();
    assert_eq!((index, short.needed), (0, bytes_to_build([2048, 1024])));
    let levels = colors(&scene.textures[0]);
    assert!((short.needed as usize) > levels.memory() && levels.memory() > 2048 * 1024 * 8 / 4);
}
