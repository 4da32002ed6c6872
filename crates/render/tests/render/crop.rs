//! A part of an image has the bits of the whole.

use lightmesh_render::{Crop, Filter, RenderError, Settings, Sharing};
use lightmesh_scene::Material;
use lightmesh_testkit::{TECHNIQUES, pile, render};

use crate::lists::kinds;

const SIZE: [u32; 2] = [41, 31];

fn ways() -> Vec<Settings> {
    let settings = Settings::default().with_size(SIZE).with_samples(16).with_layers(true);
    let of_mode = |(mode, lookup)| {
        let settings = settings.clone().with_mode(mode).with_lookup(lookup).with_step(0.3).with_bounces(1);
        let several = settings.clone().with_aa(5).with_filter(Filter::Gauss);
        [settings.with_aa(1), several.clone().with_sharing(Sharing::Never), several.with_transparent(true)]
    };
    TECHNIQUES.into_iter().flat_map(of_mode).collect()
}

#[test]
fn a_crop_is_a_part_of_the_whole() {
    let mut scene = pile(glam::DVec3::ZERO, &kinds());
    let shiny = Material::matt([0.6, 0.7, 0.8]).with_ks([0.3; 3]);
    scene.geometry_mut().materials.fill(shiny);
    for settings in ways() {
        let whole = render(&scene, &settings);
        for crop in [
            Crop::new([0, 0], SIZE),
            Crop::new([13, 7], [17, 12]),
            Crop::new([40, 30], [1, 1]),
            Crop::new([0, 20], [41, 3]),
        ] {
            let part = render(&scene, &settings.clone().with_crop(crop));
            let expected = whole.image.cropped(crop.first, crop.size).unwrap();
            assert_eq!(part.size(), crop.size);
            assert!(part.image == expected, "{crop} with {settings:?}");
        }
    }
}

#[test]
fn a_crop_out_of_the_image_is_refused() {
    let scene = pile(glam::DVec3::ZERO, &kinds());
    let renderer = lightmesh_render::Renderer::new(lightmesh_render::Device::Cpu).unwrap();
    for crop in [Crop::new([41, 0], [1, 1]), Crop::new([0, 0], [42, 1]), Crop::new([5, 5], [0, 5])] {
        let error = renderer.render(&scene, &Settings::default().with_size(SIZE).with_crop(crop)).unwrap_err();
        assert!(
            matches!(error, RenderError::Setting { .. }) && error.to_string().contains(&crop.to_string()),
            "{error}"
        );
    }
}
