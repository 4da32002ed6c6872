//! A part of an image has the bits of the whole.

use lightmesh_render::{Crop, Filter, Frame, Mode, RenderError, Settings, Sharing};
use lightmesh_scene::{Facets, Fov, Material, Projection, Scene};
use lightmesh_testkit::{Random, TECHNIQUES, glazed, pile, render, seed};

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

/// A few boxes of one material under all kinds of lights.
fn of(material: Material) -> Scene {
    let mut scene = pile(glam::DVec3::ZERO, &kinds());
    scene.geometry_mut().materials.fill(material);
    scene
}

fn shiny() -> Scene {
    of(Material::matt([0.6, 0.7, 0.8]).with_ks([0.3; 3]))
}

fn rough() -> Scene {
    of(Material::matt([0.6, 0.7, 0.8]).with_facets(Facets::new(0.4).with_metallic(0.7)))
}

#[test]
fn a_crop_is_a_part_of_the_whole() {
    let scene = shiny();
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

/// What is around the image does not change it, and is the same in every crop that has it.
#[test]
fn a_crop_around_the_image_continues_it() {
    // Whose tiles, blocks and neighbourhoods do not begin where those of the image do.
    let around = Crop::new([-7, -5], [56, 43]);
    let mut random = Random::new(seed());
    let every =
        |scene: Scene, step: usize| ways().into_iter().step_by(step).map(move |settings| (scene.clone(), settings));
    // Of mirrors that draw directions, and glass, what depends on the place of a pixel is the same with all techniques.
    for (scene, settings) in every(shiny(), 1).chain(every(rough(), 4)).chain(every(glazed(shiny()), 4)) {
        let large = render(&scene, &settings.clone().with_crop(around));
        let whole = render(&scene, &settings);
        assert_eq!(large.size(), around.size);
        let own = large.image.cropped([0, 0], SIZE).unwrap();
        assert!(own == whole.image, "the image in {around} with {settings:?}");
        let mut between = |low: u32, high: u32| low + (random.unit() * f64::from(high - low)) as u32;
        for _ in 0..2 {
            let [x, y] = [0, 1].map(|axis| between(0, around.size[axis] - 1));
            let size = [between(1, around.size[0] - x), between(1, around.size[1] - y)];
            let crop = Crop::new([x as i32 + around.first[0], y as i32 + around.first[1]], size);
            let part = render(&scene, &settings.clone().with_crop(crop));
            let expected = large.image.cropped(crop.first, crop.size).unwrap();
            assert!(part.image == expected, "{crop} with {settings:?}");
        }
    }
}

/// A camera of a wider angle sees what is around the image of a narrower one.
#[test]
fn around_the_image_the_view_goes_on() {
    let mut scene = pile(glam::DVec3::ZERO, &kinds());
    let camera = scene.cameras[0].clone();
    let Projection::Perspective(fov) = camera.projection else { panic!("it is perspective") };
    let tangent = (0.5 * fov.vertical(1.0)).to_radians().tan();
    let wide = 2.0 * (tangent * 45.0 / 31.0).atan().to_degrees();
    let settings = Settings::default().with_size(SIZE).with_aa(1).with_mode(Mode::RayTrace).with_layers(true);
    let around = render(&scene, &settings.clone().with_crop(Crop::new([-7, -7], [55, 45])));
    scene.cameras = vec![camera.with_projection(Projection::Perspective(Fov::Vertical(wide)))];
    let larger = render(&scene, &settings.with_size([55, 45]));
    let depths = |frame: &Frame| frame.layers().unwrap().depth.clone();
    for (pixel, (a, b)) in depths(&around).into_iter().zip(depths(&larger)).enumerate() {
        assert!(a == b || (a - b).abs() < 1e-4 * a, "pixel {pixel}: {a} and {b}");
    }
}

/// Nothing of the image: it may have any place around it.
#[test]
fn a_crop_beside_the_image_has_pixels_too() {
    let settings = Settings::default().with_size(SIZE).with_aa(2).with_samples(4);
    for first in [[-20, 3], [41, 0], [0, -9], [5, 31], [-30_000, 200], [60_000, 60_000]] {
        let crop = Crop::new(first, [9, 9]);
        let frame = render(&shiny(), &settings.clone().with_crop(crop));
        assert_eq!((frame.image.window().first, frame.image.window().whole, frame.size()), (first, SIZE, [9, 9]));
        assert!(frame.color().as_flattened().iter().all(|channel| channel.is_finite()), "{crop}");
    }
}

#[test]
fn a_crop_far_from_the_image_is_refused() {
    let scene = pile(glam::DVec3::ZERO, &kinds());
    let renderer = lightmesh_render::Renderer::new(lightmesh_render::Device::Cpu).unwrap();
    for crop in [
        Crop::new([41 + 65_536, 0], [1, 1]),
        Crop::new([0, -65_537], [42, 1]),
        Crop::new([5, 5], [0, 5]),
        Crop::new([-65_536, -65_536], [131_000, 131_000]),
    ] {
        let error = renderer.render(&scene, &Settings::default().with_size(SIZE).with_crop(crop)).unwrap_err();
        assert!(
            matches!(error, RenderError::Setting { .. }) && error.to_string().contains(&crop.to_string()),
            "{error}"
        );
    }
}
