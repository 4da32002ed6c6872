//! Every shared model renders in all modes.

use lightmesh_render::{Mode, Settings};
use lightmesh_testkit::{MODELS, MODES, Picture, render};

const SIZE: [u32; 2] = [48, 48];

#[test]
#[cfg_attr(not(shared_scenes), ignore = "needs ../shared/scenes")]
fn every_model_is_seen_in_every_mode() {
    for model in MODELS {
        let scene = model.open();
        for mode in MODES {
            let frame = render(&scene, &Settings { mode, size: SIZE, samples: Some(4), ..Settings::default() });
            let picture = Picture::new(&frame);
            assert_eq!(picture.fault(), None, "{}, {mode:?}", model.file);
            let hits = picture.hits().count();
            assert!(20 * hits > SIZE[0] as usize * SIZE[1] as usize, "{}, {mode:?}: {hits} pixels", model.file);
            let lit = frame.image.color().iter().filter(|color| color.iter().any(|&value| value > 0.0)).count();
            assert!(lit >= hits / 4, "{}, {mode:?}: {lit} of {hits} pixels are not black", model.file);
        }
    }
}

#[test]
#[cfg_attr(not(shared_scenes), ignore = "needs ../shared/scenes")]
fn no_model_is_speckled() {
    // Details smaller than a pixel cast shadows that are: over all models under 0.1 %, in a single one under 1 %.
    let (mut all_isolated, mut all_looked_at) = (0, 0);
    for model in MODELS {
        let scene = model.open();
        let frame = render(&scene, &Settings { mode: Mode::RayTrace, size: [128, 128], ..Settings::default() });
        let picture = Picture::new(&frame);
        for light in 0..scene.lights.len() {
            let (isolated, looked_at) = picture.isolated(light);
            assert!(isolated <= 1 + looked_at / 100, "{}, light {light}: {isolated} of {looked_at}", model.file);
            (all_isolated, all_looked_at) = (all_isolated + isolated, all_looked_at + looked_at);
        }
    }
    assert!(all_looked_at > 20_000, "{all_looked_at} pixels on smooth pieces of surface");
    assert!(1000 * all_isolated < all_looked_at, "{all_isolated} of {all_looked_at}");
}

#[test]
#[cfg_attr(not(shared_scenes), ignore = "needs ../shared/scenes")]
fn files_of_one_mesh_in_two_formats_give_one_picture() {
    let pairs = [
        ["bunny/bunny.ply", "bunny/stanford-bunny.obj"],
        ["spider/spider_ascii.stl", "spider/spider_binary.stl"],
        ["spider/spider_ascii.stl", "suzanne/suzanne.ply"],
    ];
    for (pair, same) in pairs.into_iter().zip([true, true, false]) {
        let pictures = pair.map(|file| {
            let scene = MODELS.iter().find(|model| model.file == file).expect("a shared model").open();
            let frame = render(&scene, &Settings { mode: Mode::LightMesh, size: [256, 256], ..Settings::default() });
            frame.image.color().to_vec()
        });
        assert_eq!(pictures[0] == pictures[1], same, "{pair:?}");
    }
}
