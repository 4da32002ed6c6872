//! Surfaces with textures and vertex colours: scenes with both, and bit-identical images, also of textures that are filtered.

use glam::{Affine2, DVec3, Vec2, Vec3};
use lightmesh_render::backend::{Cpu, Cuda};
use lightmesh_render::{
    Acceleration, AmbientSource, Frame, Mode, PreparedScene, Quality, Settings, Sharing, Unobserved, render_on,
};
use lightmesh_scene::{
    Dielectric, Environment, Facets, Light, LightKind, Material, NormalMap, Opacity, Scene, Sun, Texture, TextureUse,
    Up, Wrap,
};
use lightmesh_testkit::{SceneDraft, pile, runs_all};

use crate::trials::{Case, Target};

pub(crate) fn cases<R: Target>() -> Vec<Case<R>> {
    let mut cases = vec![Case::new("textured::bits".to_owned(), same_bits)];
    for aa in [1, 4, 40] {
        let name = format!("textured::surrounded::{aa}");
        cases.push(Case::new(name, move |cuda: &Cuda<R>| same_surrounded_bits(cuda, aa)));
    }
    for ambient in [AmbientSource::Constant, AmbientSource::Mesh] {
        for aa in [1, 4] {
            let name = format!("textured::facets::{}::{aa}", ambient.name());
            cases.push(Case::new(name, move |cuda: &Cuda<R>| same_facet_bits(cuda, ambient, aa)));
        }
    }
    for (aa, ambient) in [(1, AmbientSource::Constant), (4, AmbientSource::Constant), (4, AmbientSource::Mesh)] {
        let name = format!("textured::roughness::{aa}::{}", ambient.name());
        cases.push(Case::new(name, move |cuda: &Cuda<R>| same_roughness_bits(cuda, aa, ambient)));
        let name = format!("textured::relief::{aa}::{}", ambient.name());
        cases.push(Case::new(name, move |cuda: &Cuda<R>| same_relief_bits(cuda, aa, ambient)));
    }
    for wrap in [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp] {
        for height in [None, Some(4.0)] {
            let view = if height.is_some() { "orthographic" } else { "perspective" };
            let name = format!("textured::filtered::{wrap:?}::{view}");
            cases.push(Case::new(name, move |cuda: &Cuda<R>| same_filtered_bits(cuda, wrap, height)));
        }
    }
    cases
}

/// Half of a size, or all of it with the whole products of tests.
fn size(whole: [u32; 2]) -> [u32; 2] {
    if runs_all() { whole } else { whole.map(|length| length / 2) }
}

/// A pile whose triangles alternate between all kinds of materials, two textures, and colours at some vertices.
pub(crate) fn textured() -> Scene {
    let light = LightKind::Point { position: Vec3::new(2.0, 3.0, 3.0), spread: 0.0 };
    let mut scene = pile(DVec3::ZERO, &[light]);
    scene.geometry_mut().textures = vec![checks("odd", [5, 3]), checks("wide", [64, 2])].into();
    let matrix = Affine2::from_scale_angle_translation(Vec2::new(1.7, -0.6), 0.4, Vec2::new(0.3, -9.2));
    let material = |texture, ks_tinted: f32, emission_tinted: f32| {
        let plain = Material::default().with_ks([0.1, 0.0, 0.0]).with_ks_tinted([ks_tinted; 3]);
        let mut material = plain.with_emission_tinted([emission_tinted; 3]);
        material.texture = texture;
        material
    };
    let uses = |texture, wrap| Some(TextureUse { wrap, transform: matrix, ..TextureUse::new(texture) });
    scene.geometry_mut().materials = vec![
        material(uses(0, [Wrap::Repeat; 2]), 0.0, 0.0),
        material(uses(1, [Wrap::Mirror, Wrap::Clamp]), 0.5, 0.0),
        material(None, 0.25, 0.0),
        material(uses(0, [Wrap::Clamp, Wrap::Mirror]), 0.0, 0.75),
        material(Some(TextureUse::new(7)), 0.0, 0.5),
    ];
    // Emission with images: the other one, the same one, and alone.
    for (number, image) in [(0, 1), (1, 1), (2, 0)] {
        let material = &mut scene.geometry_mut().materials[number];
        material.emission = Vec3::new(0.5, 0.25, 1.0);
        material.emission_texture = uses(image, [Wrap::Mirror, Wrap::Repeat]);
    }
    // Normals with images that are colours elsewhere.
    for (number, image, scale) in [(0, 1, 0.7), (2, 0, -1.5), (3, 0, 1.0)] {
        let map = uses(image, [Wrap::Repeat, Wrap::Mirror]).map(NormalMap::new);
        scene.geometry_mut().materials[number].normal_texture = map.map(|map| map.with_scale(scale));
    }
    let mesh = &mut scene.geometry_mut().mesh;
    mesh.materials = (0..mesh.triangles.len() as u32).map(|index| index % 5).collect();
    mesh.uvs = mesh.positions.iter().map(|p| Vec2::new(1.3 * p.x + 0.7 * p.y, p.z - 0.2 * p.y)).collect();
    mesh.colors = mesh.positions.iter().map(|p| (0.5 * p.abs()).min(Vec3::ONE)).collect();
    scene
}

/// A texture without two adjacent texels of the same colour.
fn checks(name: &str, size: [u32; 2]) -> Texture {
    let texel = |index: u32| [(37 * index) as u8, (91 * index + 5) as u8, (200 - 13 * index % 200) as u8, 255];
    Texture { name: name.to_owned(), size, texels: (0..size[0] * size[1]).map(texel).collect() }
}

/// Without highlights, whose powers a device may round differently, nothing differs.
fn same_bits<R: Target>(cuda: &Cuda<R>) {
    let colored = textured();
    let mut plain = colored.clone();
    plain.geometry_mut().mesh.colors.clear();
    for mut scene in [colored, plain] {
        for material in &mut scene.geometry_mut().materials {
            (material.ks, material.ks_tinted) = (Vec3::ZERO, Vec3::ZERO);
        }
        let scene = PreparedScene::new(&scene, &Acceleration::Bvh, &Unobserved).unwrap();
        let settings = Settings::default().with_mode(Mode::RayTrace).with_size([64, 48]);
        assert_same_bits(cuda, &scene, &settings, 4);
    }
}

/// A panorama with a sun, seen directly, in flat and curved mirrors and as ambient light.
fn same_surrounded_bits<R: Target>(cuda: &Cuda<R>, aa: u32) {
    let scene = PreparedScene::new(&surrounded(), &Acceleration::Bvh, &Unobserved).unwrap();
    let settings = Settings::default().with_ambient_light(AmbientSource::Constant).with_bounces(2);
    let settings = settings.with_size([64, 48]).with_aa(aa);
    assert_same_bits(cuda, &scene, &settings, 2);
}

/// The same with relief on everything, and the curved mirror, or a body of glass in its place.
fn same_relief_bits<R: Target>(cuda: &Cuda<R>, aa: u32, ambient: AmbientSource) {
    let mut scene = surrounded();
    for glass in [false, true] {
        let materials = &mut scene.geometry_mut().materials;
        if glass {
            materials[2] = Material::of(Dielectric::new(1.4).with_absorption([0.2, 0.1, 0.0]));
        }
        for (material, scale) in materials[1..].iter_mut().zip([0.5, 0.2, -0.7]) {
            material.kd = Vec3::splat(0.3);
            material.normal_texture = Some(NormalMap::new(TextureUse::new(0)).with_scale(scale));
        }
        let scene = PreparedScene::new(&scene, &Acceleration::Bvh, &Unobserved).unwrap();
        let settings = Settings::default().with_ambient_light(ambient).with_quality(Quality::Draft).with_bounces(2);
        assert_same_bits(cuda, &scene, &settings.with_size(size([40, 30])).with_aa(aa), 3);
    }
}

/// The floor and the mirrors in a panorama with a sun and a window, which is light.
fn surrounded() -> Scene {
    let mut scene = small_texels(Wrap::Repeat, None);
    let texel = |index: u32| [0.1 * (index % 7) as f32, (index % 1021) as f32 / 1021.0, 0.001 * (index / 331) as f32];
    let window = |index: u32| (120..150).contains(&(index % 331)) && (30..55).contains(&(index / 331));
    let texel = |index: u32| if window(index) { [30.0, 25.0, 20.0] } else { texel(index) };
    let map = Environment::new("noise", [331, 170], (0..331 * 170).map(texel).collect(), Up::Y).turned(17.0);
    let map = map.find_lights();
    assert!(!map.discs().is_empty());
    let sun = Sun::new(Vec3::new(0.1, 0.2, -1.0), 6.0, Vec3::new(3.0, 2.0, 1.0));
    scene.lights.environment = Some(map.with_sun(Some(sun)).into());
    (scene.lights.ambient, scene.lights.background) = (None, None);
    scene
}

/// Smooth and rough facets under lights with a size and without, one of them the panorama's sun, in mirrors and in gathered light.
fn same_facet_bits<R: Target>(cuda: &Cuda<R>, ambient: AmbientSource, aa: u32) {
    let scene = PreparedScene::new(&faceted(), &Acceleration::Bvh, &Unobserved).unwrap();
    let settings =
        Settings::default().with_ambient_light(ambient).with_bounces(2).with_size(size([48, 36])).with_aa(aa);
    assert_same_bits(cuda, &scene, &settings, 2);
}

/// The same with images of how rough and metallic the facets are, smaller in the picture than they are and larger.
fn same_roughness_bits<R: Target>(cuda: &Cuda<R>, aa: u32, ambient: AmbientSource) {
    let mut scene = faceted();
    for (number, material) in (0..).zip(&mut scene.geometry_mut().materials[1..]) {
        let Some(facets) = material.facets else { continue };
        let transform = Affine2::from_scale_angle_translation(Vec2::new(1.3, -0.4), 0.7, Vec2::new(0.2, -0.3));
        let wrap = [Wrap::Mirror, Wrap::Repeat];
        let uses = TextureUse { wrap, transform, ..TextureUse::new(number % 2) };
        *material = material.clone().with_facets(facets.with_metallic(0.9)).with_metallic_roughness_texture(uses);
    }
    let scene = PreparedScene::new(&scene, &Acceleration::Bvh, &Unobserved).unwrap();
    for bounces in [0, 2] {
        let settings = Settings::default().with_ambient_light(ambient).with_quality(Quality::Draft);
        let settings = settings.with_bounces(bounces).with_size(size([40, 30])).with_aa(aa);
        assert_same_bits(cuda, &scene, &settings, 3);
    }
}

/// The floor and the mirrors with facets, below a panorama's sun and two lights.
fn faceted() -> Scene {
    let mut scene = surrounded();
    let facets = [Facets::new(0.6), Facets::new(0.2).with_metallic(1.0), Facets::new(0.35).with_metallic(0.5)];
    // All that are seen: Phong's powers may be rounded differently.
    for (material, facets) in scene.geometry_mut().materials[1..].iter_mut().zip(facets) {
        *material = material.clone().with_kd([0.8, 0.6, 0.4]).with_ks([0.04; 3]).with_facets(facets);
    }
    let last = scene.geometry.materials.len() - 1;
    scene.geometry_mut().materials[last].opacity = Some(Opacity::blend(0.75));
    scene.geometry_mut().materials[last].normal_texture = Some(NormalMap::new(TextureUse::new(0)).with_scale(0.4));
    let sun = scene.lights.environment.as_ref().and_then(|around| around.sun()).expect("there is a sun").direction;
    let panel = Light::rectangle(Vec3::new(-1.0, 2.5, 1.0), 0.5 * Vec3::X, 0.25 * Vec3::Z).unwrap();
    let lights = [Light::directional(-sun).unwrap(), panel, Light::point(Vec3::new(1.0, 2.0, 2.0))];
    scene.lights.list = lights.map(|light| light.with_intensity([0.4; 3])).to_vec();
    scene
}

/// Fails if any colour differs, or if there are not more colours than one for every `most` pixels.
fn assert_same_bits<R: Target>(cuda: &Cuda<R>, scene: &PreparedScene, settings: &Settings, most: usize) {
    let bits = |frame: Frame| frame.image.color().iter().map(|color| color.map(f32::to_bits)).collect::<Vec<_>>();
    let host = bits(render_on(&Cpu, scene, settings, &Unobserved).unwrap());
    let device = bits(render_on(cuda, scene, settings, &Unobserved).unwrap());
    let mut colors = host.clone();
    colors.sort_unstable();
    colors.dedup();
    assert!(colors.len() > host.len() / most, "{} colours: textures are to be seen", colors.len());
    let differ = host.iter().zip(&device).filter(|(a, b)| a != b).count();
    assert_eq!(differ, 0, "of {} pixels, {:?} samples", host.len(), settings.aa);
}

/// A floor to the horizon with a fine texture, and a convex and a concave mirror on it. What is seen is the ambient term: a device may round
/// nothing differently.
fn small_texels(wrap: Wrap, height: Option<f32>) -> Scene {
    let plain = Material::default().with_ka([0.9; 3]).with_kd([0.0; 3]);
    let transform = Affine2::from_scale_angle_translation(Vec2::new(3.1, -2.3), 0.3, Vec2::new(0.4, -1.2));
    let uses = |texture| TextureUse { wrap: [wrap, Wrap::Repeat], transform, ..TextureUse::new(texture) };
    let mirror = plain.clone().with_ka([0.1; 3]).with_ks([0.8, 0.7, 0.9]);
    let draft = SceneDraft::new()
        .ambient(1.0)
        .painted(plain.clone().with_texture(uses(0)))
        .floor(0.0, 300.0)
        .painted(mirror.clone())
        .smooth_ball(DVec3::new(-0.8, 1.0, 0.0), 0.9, [6, 8])
        .painted(mirror.with_ks_tinted([0.1; 3]).with_texture(uses(1)))
        .quad([[0.4, 0.1, -0.6], [2.0, 0.1, -1.0], [2.0, 1.9, -1.1], [0.4, 1.9, -0.7]]);
    let (eye, target) = ([0.4, 1.7, 3.2], [0.1, 0.8, 0.0]);
    let draft = match height {
        Some(height) => draft.orthographic(eye, target, height),
        None => draft.camera(eye, target),
    };
    let mut scene = draft.finish("small texels");
    let geometry = scene.geometry_mut();
    geometry.textures = vec![checks("large", [37, 64]), checks("narrow", [1, 50])].into();
    let mesh = &mut geometry.mesh;
    // The quadrilateral is a concave mirror.
    mesh.normals.resize(mesh.positions.len(), Vec3::ZERO);
    let corners = mesh.positions.len() - 4;
    for (normal, position) in mesh.normals[corners..].iter_mut().zip(&mesh.positions[corners..]) {
        *normal = Vec3::new(1.2 - position.x, 1.0 - position.y, 4.0).normalize();
    }
    mesh.uvs = mesh.positions.iter().map(|p| Vec2::new(p.x + 0.2 * p.y, p.z - 0.7 * p.y)).collect();
    scene
}

/// Textures that are smaller in the image than they are, seen directly and in mirrors, with samples that are shaded together and apart.
fn same_filtered_bits<R: Target>(cuda: &Cuda<R>, wrap: Wrap, height: Option<f32>) {
    let scene = PreparedScene::new(&small_texels(wrap, height), &Acceleration::Bvh, &Unobserved).unwrap();
    for (aa, sharing) in [(4, Sharing::default()), (8, Sharing::Never)] {
        let settings = Settings::default().with_mode(Mode::RayTrace).with_size([40, 30]);
        let settings = settings.with_aa(aa).with_sharing(sharing).with_bounces(2);
        assert_same_bits(cuda, &scene, &settings, 3);
    }
}
