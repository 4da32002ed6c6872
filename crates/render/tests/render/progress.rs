//! Progress: every stage ends at its total, and so does the whole image.

use std::collections::BTreeSet;

use lightmesh_render::backend::Cpu;
use lightmesh_render::{Acceleration, Mode, PreparedScene, Settings, Stage, Step, Unobserved, render_on};
use lightmesh_scene::{Geometry, Scene};
use lightmesh_testkit::{Watch, half_plane};

use crate::renderer;

fn settings(mode: Mode) -> Settings {
    Settings::default()
        .with_aa(1)
        .with_size([60, 44])
        .with_mode(mode)
        .with_bounces(1)
        .with_samples(3)
        .with_step(Step::Fixed(0.3))
}

/// The stages of an image; each has ended at its total.
fn stages(scene: &Scene, settings: &Settings) -> BTreeSet<&'static str> {
    let prepared = PreparedScene::new(scene, &Acceleration::Bvh, &Unobserved).unwrap();
    let watch = Watch::default();
    render_on(&Cpu, &prepared, settings, &watch).unwrap();
    watch.finished().iter().map(|watched| watched.stage.name()).collect()
}

#[test]
fn every_stage_ends_at_its_total() {
    for &mode in Mode::ALL {
        let stages = stages(&half_plane(), &settings(mode));
        let common = [Stage::CameraRays, Stage::PrimaryRays, Stage::Shade, Stage::MirrorRays];
        assert!(common.iter().all(|stage| stages.contains(stage.name())), "{mode:?}: {stages:?}");
        let own = |stage, of| assert_eq!(stages.contains(stage), mode == of, "{mode:?}: {stages:?}");
        own("long_tests", Mode::LightMesh);
        own("interpolate", Mode::LightMesh);
        own("area_shadows", Mode::Area);
        own("shadow_rays", Mode::RayTrace);
    }
}

/// The default has neither cells nor long tests: each stage has its own name and clock.
#[test]
fn stages_of_lists_are_their_own() {
    let settings = Settings::default().with_size([24, 16]).with_bounces(1);
    let stages = stages(&half_plane(), &settings);
    for stage in ["pixel_samples", "fragments", "items", "occluder_lists"] {
        assert!(stages.contains(stage), "{stage} in {stages:?}");
    }
    for stage in ["cells", "short_tests", "collect", "long_tests", "interpolate"] {
        assert!(!stages.contains(stage), "{stage} in {stages:?}");
    }
    let seconds = renderer().render(&half_plane(), &settings).unwrap().stats.seconds;
    assert!(seconds.occluder_lists > 0.0 && seconds.items > 0.0 && seconds.pixel_samples > 0.0, "{seconds:?}");
    assert_eq!([seconds.cells, seconds.long_tests], [0.0; 2]);
}

#[test]
fn a_picture_of_nothing_ends_too() {
    for &mode in Mode::ALL {
        assert!(stages(&Scene::new("empty", Geometry::default()), &settings(mode)).contains("shade"));
    }
}
