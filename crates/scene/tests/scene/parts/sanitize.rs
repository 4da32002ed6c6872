use glam::{DVec3, Vec3};
use lightmesh_scene::internals::sanitize::{clamp_reflectance, drop_invalid_positions, keep_finite, too_long, unseen};
use lightmesh_scene::{Dielectric, Material, Mesh, Opacity};

#[test]
fn what_has_no_place_is_left_out_and_counted() {
    let mut items =
        vec![(1, DVec3::ONE), (2, DVec3::new(0.0, f64::NAN, 0.0)), (3, DVec3::NEG_INFINITY), (4, 1e19 * DVec3::X)];
    let warning = drop_invalid_positions(&mut items, "lights");
    assert_eq!(items, [(1, DVec3::ONE)]);
    assert_eq!(warning.as_deref(), Some("3 lights with infinite, undefined or far too large coordinates were ignored"));
    assert_eq!(drop_invalid_positions(&mut items, "lights"), None);
}

#[test]
fn mirrors_that_add_light_are_lowered_and_named() {
    let tinted = Material::default().with_ks([0.5; 3]).with_ks_tinted([0.75, 0.25, 0.5]).named("gold");
    let usual = Material::matt([1.0; 3]).with_ks([1.0; 3]);
    let mut materials = [Material::default().with_ks([1.5, 1.0, 0.5]).named("box"), tinted, usual.clone()];
    let warning = clamp_reflectance(&mut materials).unwrap();
    assert_eq!(
        warning,
        "2 materials reflect more than they receive, so their ks is lowered to 1: `box` (ks = 1.5 1 0.5), `gold` (ks = 1.25 0.75 1)"
    );
    assert_eq!((materials[0].ks, materials[1].ks), (Vec3::new(1.0, 1.0, 0.5), Vec3::splat(0.5)));
    assert_eq!((materials[1].ks_tinted, &materials[2]), (Vec3::new(0.5, 0.25, 0.5), &usual));
    assert_eq!(clamp_reflectance(&mut materials), None);
}

#[test]
fn opacities_out_of_range_are_brought_back() {
    let of = |factor: f32| Material::default().with_opacity(Opacity::blend(factor));
    let mut materials = [0.5, 2.0, -1.0, f32::INFINITY, f32::NAN].map(of);
    assert!(keep_finite(&mut materials).is_some_and(|warning| warning.starts_with("4 materials have infinite")));
    assert_eq!(materials.map(|material| material.opacity.unwrap().factor), [0.5, 1.0, 0.0, 0.0, 0.0]);
}

#[test]
fn what_is_nowhere_opaque_is_named() {
    let of = |opacity: Opacity, name: &str| Material::default().with_opacity(opacity).named(name);
    let foil = of(Opacity::blend(0.0).with_filter([1.0, 0.0, 0.0]), "foil");
    let mut materials = vec![foil, of(Opacity::blend(0.5), "pane"), Material::default()];
    assert_eq!(unseen(&materials, &[0, 1, 2, 3]), None);
    materials.push(of(Opacity::blend(0.0), "glass").with_dielectric(Dielectric::new(1.5)));
    assert_eq!(unseen(&materials, &[0, 1, 2, 3]), None);
    materials.push(of(Opacity::blend(0.0), "air"));
    assert_eq!(unseen(&materials, &[0, 1, 2, 3]), None, "nothing is made of it");
    assert_eq!(unseen(&materials, &[4, 4, 0]).as_deref(), Some("1 material is not seen, for lack of opacity: `air`"));
}

#[test]
fn coefficients_without_a_value_count_as_0() {
    let odd = Material::default().with_kd([f32::INFINITY, 0.5, -0.25]).with_ks(Vec3::NAN);
    let mut materials = [Material::default(), odd];
    let warning = keep_finite(&mut materials);
    assert_eq!((materials[1].kd, materials[1].ks), (Vec3::new(0.0, 0.5, 0.0), Vec3::ZERO));
    assert!(warning.is_some_and(|warning| warning.starts_with("1 materials have infinite")));
    assert_eq!((keep_finite(&mut materials), &materials[0]), (None, &Material::default()));
}

#[test]
fn edges_whose_products_are_no_numbers_are_told() {
    let mesh = |size: f32| Mesh {
        positions: vec![Vec3::ZERO, Vec3::new(size, 0.0, 0.0), Vec3::new(0.0, 0.5 * size, 0.0)],
        triangles: vec![[0, 1, 2]],
        ..Mesh::default()
    };
    for size in [1.0, 3.5e9] {
        assert_eq!(too_long(&mesh(size)), None, "{size}");
    }
    let warning = too_long(&mesh(5e9)).unwrap();
    assert!(warning.starts_with("1 triangle has edges longer than 4e9 units"), "{warning}");
}
