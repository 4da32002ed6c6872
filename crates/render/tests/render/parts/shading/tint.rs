use glam::{Affine2, Vec2, Vec3};
use lightmesh_render::accel::{Hit, Ray};
use lightmesh_render::internals::shading::Coefficients;
use lightmesh_render::{Acceleration, Cone, PreparedScene, Unobserved};
use lightmesh_scene::{Facets, Material, Scene, Texture, TextureUse};

fn texture(size: [u32; 2], texels: &[[u8; 3]]) -> Texture {
    Texture { name: String::new(), size, texels: texels.iter().map(|&[r, g, b]| [r, g, b, 255]).collect() }
}

/// A triangle with corners of all kinds, hit in the middle of its first edge.
fn scene(colors: bool) -> (Scene, Hit) {
    let positions = [glam::DVec3::ZERO, glam::DVec3::X, glam::DVec3::Y];
    let uvs = [Vec2::ZERO, Vec2::new(0.5, 0.0), Vec2::Y];
    let colors = if colors { &[Vec3::X, Vec3::Y, Vec3::Z][..] } else { &[] };
    let part = lightmesh_scene::MeshPart {
        positions: &positions,
        uvs: &uvs,
        colors,
        triangles: &[[0, 1, 2]],
        ..Default::default()
    };
    let mut builder = lightmesh_scene::SceneBuilder::new();
    builder.add(part, &glam::DMat4::IDENTITY, |_| 0).unwrap();
    let mut scene = builder.finish_scene("triangle");
    scene.geometry_mut().textures.push(texture([2, 1], &[[255, 255, 0], [0, 255, 255]]));
    (scene, Hit { t: 1.0, u: 0.5, v: 0.0, triangle: 0 })
}

/// The coefficients of `material` in a scene, seen with a cone from straight above.
fn seen(scene: &Scene, material: &Material, cone: Cone, hit: &Hit) -> Coefficients {
    let mut scene = scene.clone();
    scene.geometry_mut().materials = vec![material.clone()];
    let scene = PreparedScene::new(&scene, &Acceleration::BruteForce, &Unobserved).unwrap();
    let ray = Ray { origin: Vec3::new(0.5, 0.0, 1.0), direction: Vec3::NEG_Z, t_max: f32::INFINITY };
    Coefficients::at(&scene, material, &ray, cone, hit)
}

#[test]
fn every_coefficient_takes_its_part_of_the_tint() {
    let (mut scene, hit) = scene(true);
    let (ka, kd, ks) = (Vec3::splat(0.25), Vec3::splat(0.5), Vec3::splat(0.125));
    let shift = Affine2::from_translation(Vec2::new(0.5, 0.0));
    let material = Material::matt(kd).with_ka(ka).with_ks(ks).with_ks_tinted(1.5 * kd).with_emission_tinted(4.0 * kd);
    let material = material.with_texture(TextureUse { transform: shift, ..TextureUse::new(0) });
    // The texture's right half, and half red half green.
    let tint = Vec3::new(0.0, 1.0, 1.0) * Vec3::new(0.5, 0.5, 0.0);
    let coefficients = seen(&scene, &material, Cone::default(), &hit);
    let expected = Coefficients {
        ka: ka * tint,
        kd: kd * tint,
        ks: ks + 1.5 * kd * tint,
        emission: 4.0 * kd * tint,
        transmittance: Vec3::ZERO,
        opacity: 1.0,
        roughness: 0.0,
        metallic: 0.0,
        all: kd * tint,
        mirrored: ks + 1.5 * kd * tint,
    };
    assert_eq!(coefficients, expected);
    scene.geometry_mut().mesh.colors.clear();
    assert_eq!(seen(&scene, &material, Cone::default(), &hit).kd, kd * Vec3::new(0.0, 1.0, 1.0));
}

#[test]
fn what_is_emitted_has_an_image_of_its_own() {
    let (mut scene, hit) = scene(true);
    scene.geometry_mut().textures.push(texture([1, 1], &[[0, 0, 255]]));
    let material = Material::matt(Vec3::ONE).with_emission([2.0, 3.0, 4.0]).with_emission_tinted([1.0; 3]);
    let material = material.with_texture(TextureUse::new(0)).with_emission_texture(TextureUse::new(1));
    let found = seen(&scene, &material, Cone::default(), &hit);
    assert_eq!(found.emission, Vec3::new(0.0, 0.0, 4.0) + found.kd, "the tint belongs to the other part");
    scene.geometry_mut().mesh.colors.clear();
    let mut alone = material;
    alone.texture = None;
    assert_eq!(seen(&scene, &alone, Cone::default(), &hit).emission, Vec3::new(1.0, 1.0, 5.0));
}

#[test]
fn facets_are_as_rough_and_metallic_as_an_image_says() {
    let (mut scene, hit) = scene(false);
    scene.geometry_mut().textures.push(texture([1, 1], &[[9, 51, 204]]));
    let facets = Facets::new(0.5).with_metallic(0.25);
    let material = Material::matt(Vec3::ONE).with_metallic_roughness_texture(TextureUse::new(1));
    let shares = |material: &Material| {
        let found = seen(&scene, material, Cone::default(), &hit);
        assert_eq!(found.kd, Vec3::ONE);
        [found.roughness, found.metallic]
    };
    assert_eq!(shares(&material), [0.0; 2], "no facets");
    let [roughness, metallic] = shares(&material.clone().with_facets(facets));
    assert!((roughness - 0.1).abs() < 1e-6 && (metallic - 0.2).abs() < 1e-6, "{roughness} {metallic}");
    let gone = material.with_facets(facets).with_metallic_roughness_texture(TextureUse::new(7));
    assert_eq!(shares(&gone), [0.5, 0.25]);
}

#[test]
fn a_texture_that_cannot_be_looked_up_is_none() {
    let (mut scene, hit) = scene(false);
    let material = Material::default().with_texture(TextureUse::new(0)).with_ks_tinted(Vec3::X);
    let untinted = Coefficients::untinted(&material);
    assert_eq!(untinted.ks, Vec3::X);
    assert_ne!(seen(&scene, &material, Cone::default(), &hit), untinted);
    let other = material.clone().with_texture(TextureUse::new(7));
    assert_eq!(seen(&scene, &other, Cone::default(), &hit), untinted);
    scene.geometry_mut().textures[0].texels.pop();
    assert_eq!(seen(&scene, &material, Cone::default(), &hit), untinted);
    scene.geometry_mut().textures[0] = texture([0, 1], &[]);
    assert_eq!(seen(&scene, &material, Cone::default(), &hit), untinted);
}

#[test]
fn a_cone_sees_the_mean_of_its_footprint() {
    let (scene, hit) = scene(false);
    // The border between the texels, and one texel's middle.
    for (shift, point) in [(0.25, Vec3::new(0.5, 1.0, 0.5)), (0.5, Vec3::new(0.0, 1.0, 1.0))] {
        let shift = Affine2::from_translation(Vec2::new(shift, 0.0));
        let material = Material::matt(Vec3::ONE).with_texture(TextureUse { transform: shift, ..TextureUse::new(0) });
        let seen = |cone| seen(&scene, &material, cone, &hit).kd;
        assert_eq!(seen(Cone { width: 0.0, spread: 0.0 }), point);
        // Half of the image is as wide as the triangle's edge: a texel is as wide as it, too.
        assert_eq!(seen(Cone { width: 1.0, spread: 0.0 }), point, "magnified");
        assert_eq!(seen(Cone { width: 0.0, spread: 2.0 }), Vec3::new(0.5, 1.0, 0.5), "twice as wide: all of it");
    }
}
