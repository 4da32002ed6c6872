use glam::Vec3;
use lightmesh_scene::internals::principled::{SHARPEST, reflectance, shininess};
use lightmesh_scene::{Dielectric, Facets, Material, Opacity, Principled};

const COPPER: Vec3 = Vec3::new(0.95, 0.64, 0.54);

fn plain(metallic: f32, roughness: f32) -> Material {
    Principled { base: COPPER, metallic, roughness, ..Principled::default() }.material()
}

#[test]
fn factors_are_facets_of_the_base_colour() {
    let copper = plain(0.75, 0.5);
    assert_eq!((copper.kd, copper.ks), (COPPER, Vec3::splat(0.04)));
    assert_eq!(copper.facets, Some(Facets::new(0.5).with_metallic(0.75).with_grazing(1.0)));
}

#[test]
fn the_lobe_of_glass_is_as_wide_as_its_roughness_says() {
    assert!((shininess(0.5) - 30.0).abs() < 1e-4);
    assert_eq!((shininess(0.0), shininess(1.0)), (SHARPEST, 1.0));
}

#[test]
fn factors_out_of_range_are_brought_back() {
    assert_eq!(plain(7.0, -1.0), plain(1.0, 0.0));
    assert_eq!(plain(-1.0, 3.0), plain(0.0, 1.0));
}

#[test]
fn the_index_of_refraction_and_the_specular_factor_set_the_reflectance() {
    let near = |of: Principled, expected: [f32; 3], end: f32| {
        let (found, grazing) = reflectance(&of);
        (found - Vec3::from(expected)).length() < 1e-6 && grazing == end
    };
    let of = |ior| Principled { ior: Some(ior), ..Principled::default() };
    assert!(near(of(1.5), [0.04; 3], 1.0));
    assert!(near(of(2.0), [1.0 / 9.0; 3], 1.0));
    assert!(near(of(1.0), [0.0; 3], 1.0));
    assert!(near(of(0.0), [1.0; 3], 1.0));
    let halved = Principled { specular: 0.5, specular_color: Vec3::new(1.0, 0.0, 100.0), ..Principled::default() };
    assert!(near(halved, [0.02, 0.0, 0.5], 0.5));
}

#[test]
fn what_is_transmitted_goes_through_what_is_no_metal() {
    let glass = Principled { base: COPPER, metallic: 0.5, transmission: 0.5, ..Principled::default() }.material();
    assert_eq!(glass.opacity, Some(Opacity::blend(0.75).with_filter(COPPER)));
    assert_eq!(glass.dielectric, Some(Dielectric::new(Dielectric::GLASS)));
}
