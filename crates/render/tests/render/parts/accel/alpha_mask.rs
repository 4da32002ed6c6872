//! What is there and what is not.

use glam::{Vec2, Vec3};
use lightmesh_memory::Budget;
use lightmesh_render::accel::{Hit, Ray, Triangle};
use lightmesh_render::internals::accel::{AlphaMask, between};
use lightmesh_scene::{Geometry, Material, Mesh, Opacity, OpacityChannel, Texture, TextureUse, Wrap};

/// A triangle over half of the unit square, cut out by `alphas`, two by two texels, with `opacities` at its corners.
fn geometry(alphas: [u8; 4], opacities: &[f32], opacity: impl Fn(Opacity) -> Opacity) -> Geometry {
    let mesh = Mesh {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
        uvs: vec![Vec2::ZERO, Vec2::X, Vec2::Y],
        opacities: opacities.to_vec(),
        triangles: vec![[0, 1, 2]],
        materials: vec![0],
        ..Mesh::default()
    };
    let texture = Texture { name: "leaf".into(), size: [2; 2], texels: alphas.map(|alpha| [9, 9, 9, alpha]).to_vec() };
    let uses = TextureUse { wrap: [Wrap::Clamp; 2], ..TextureUse::new(0) };
    let material = Material::default().with_opacity(opacity(Opacity::by(uses, OpacityChannel::Alpha)));
    Geometry { mesh, materials: vec![material], textures: vec![texture].into(), ..Geometry::default() }
}

fn of(geometry: &Geometry) -> (AlphaMask, Vec<u32>) {
    AlphaMask::of(geometry, Budget::default()).unwrap()
}

/// Whether the whole geometry counts as opaque.
fn is_opaque(geometry: &Geometry) -> bool {
    let (alpha_mask, numbers) = of(geometry);
    assert_eq!(alpha_mask.table().is_none(), numbers.is_empty());
    numbers.is_empty()
}

#[test]
fn a_check_of_alpha_is_cut_out_along_its_edges() {
    let (alpha_mask, numbers) = of(&geometry([255, 0, 0, 255], &[], |it| it));
    assert_eq!(numbers, [1]);
    let covers = |u, v| alpha_mask.covers(1, u, v);
    for (u, v) in [(0.1, 0.1), (0.49, 0.49), (0.49, 0.0), (0.0, 0.49)] {
        assert!(covers(u, v), "{u} {v}");
    }
    for (u, v) in [(0.51, 0.1), (0.9, 0.0), (0.1, 0.51), (0.0, 1.0), (0.49, 0.51)] {
        assert!(!covers(u, v), "{u} {v}");
    }
    // At the cutoff itself there is a surface.
    assert!(covers(0.5, 0.2) && !covers(f32::NAN, 0.2));
}

#[test]
fn rays_and_segments_meet_what_is_left() {
    let geometry = geometry([255, 0, 0, 255], &[], |it| it);
    let (alpha_mask, numbers) = of(&geometry);
    let triangle = Triangle::new(geometry.mesh.corners(0), 0).alpha_tested(numbers[0]);
    for (x, y, there) in [(0.2, 0.2, true), (0.7, 0.2, false), (0.2, 0.7, false), (0.7, 0.7, false)] {
        let (origin, direction) = (Vec3::new(x, y, 1.0), Vec3::NEG_Z);
        assert_eq!(alpha_mask.stops(&triangle, origin, direction), there, "{x} {y}");
        let all = lightmesh_render::accel::BruteForce::new(&[triangle]).with_alpha_mask(&alpha_mask);
        let ray = Ray { origin, direction, t_max: f32::INFINITY };
        let mut hits = [Hit::MISS];
        lightmesh_render::accel::Accelerator::closest_hits(&all, &[ray], &mut hits);
        assert_eq!(hits[0].is_some(), there, "{x} {y}");
    }
}

#[test]
fn what_is_nowhere_below_the_cutoff_is_opaque() {
    let cutoff = |alphas, cutoff| is_opaque(&geometry(alphas, &[], |it| it.with_cutoff(cutoff)));
    assert!(cutoff([255; 4], 1.0) && cutoff([128, 200, 255, 130], 0.5) && cutoff([0; 4], 0.0));
    assert!(!cutoff([127, 255, 255, 255], 0.5) && !cutoff([254, 255, 255, 255], 1.0));
    let factor = |factor| is_opaque(&geometry([200; 4], &[], |it| it.with_factor(factor)));
    assert!(factor(0.7) && !factor(0.6));
    let opacities = |opacities: [f32; 3]| is_opaque(&geometry([255; 4], &opacities, |it| it));
    assert!(opacities([1.0; 3]) && opacities([0.5; 3]) && !opacities([0.5, 0.4, 1.0]));
    let mut plain = geometry([0; 4], &[], |it| it);
    plain.materials[0].opacity = None;
    assert!(is_opaque(&plain));
}

#[test]
fn a_cut_out_without_an_image_goes_by_its_corners() {
    let without_image = |mut opacity: Opacity| {
        opacity.texture = None;
        opacity
    };
    let mut geometry = geometry([0; 4], &[1.0, 0.0, 0.0], without_image);
    let (alpha_mask, _) = of(&geometry);
    assert!(alpha_mask.covers(1, 0.25, 0.25) && alpha_mask.covers(1, 0.5, 0.0) && !alpha_mask.covers(1, 0.3, 0.3));
    // An image that is not there hides nothing, and shows nothing.
    geometry.mesh.opacities.clear();
    geometry.materials[0].opacity = Some(Opacity::by(TextureUse::new(7), OpacityChannel::Alpha));
    assert!(is_opaque(&geometry));
}

#[test]
fn the_channel_is_the_one_that_is_named() {
    let mut geometry = geometry([255; 4], &[], |it| Opacity::by(it.texture.unwrap(), OpacityChannel::Green));
    geometry.textures[0].texels = vec![[0, 255, 0, 0]; 4];
    assert!(is_opaque(&geometry));
    geometry.textures[0].texels[3] = [255, 0, 255, 255];
    assert!(!is_opaque(&geometry));
}

#[test]
fn interpolation_falls_nowhere_below_the_least_texel() {
    let shares = (0..=64).map(|step| step as f32 / 64.0).chain([1e-8, 0.333_333_34, 0.999_999_94]);
    for share in shares.clone() {
        for (a, b) in [(1.0, 255.0), (3.0, 200.0), (77.0, 78.0)] {
            let mean = between(b, a, share);
            assert!(mean >= a && between(a, mean, share) >= a && between(mean, a, share) >= a, "{a} {b} {share}");
        }
    }
}

#[test]
fn opacities_that_do_not_fit_are_refused() {
    let mut geometry = geometry([0; 4], &[], |it| it);
    geometry.textures[0] = Texture { name: "vast".into(), size: [1024; 2], texels: vec![[0; 4]; 1 << 20] };
    let (index, short) = AlphaMask::of(&geometry, Budget::new(Some(1))).unwrap_err();
    assert_eq!((index, short.needed), (0, 1 << 20));
    assert!(of(&geometry).0.memory() > 1 << 20);
}
