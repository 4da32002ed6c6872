//! Every scene file in `scenes/` opens without a warning and renders in every mode.

use std::path::{Path, PathBuf};

use lightmesh::{Device, Mode, Renderer, Scene, Settings};

fn scenes() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let files = std::fs::read_dir(folder).expect("the repository has scenes").flatten().map(|entry| entry.path());
    files.filter(|path| path.extension().is_some_and(|extension| extension == "toml")).collect()
}

#[test]
fn the_repository_s_scenes_render_in_every_mode() {
    let renderer = Renderer::new(Device::Cpu).unwrap();
    assert!(!scenes().is_empty());
    for path in scenes() {
        let scene = Scene::open(&path).unwrap();
        assert!(scene.warnings.is_empty(), "{}: {:?}", path.display(), scene.warnings);
        for mode in [Mode::LightMesh, Mode::RayTrace, Mode::Area] {
            let settings =
                Settings::default().with_aa(1).with_mode(mode).with_size([40, 30]).with_samples(4).with_bounces(1);
            let frame = renderer.render(&scene, &settings).unwrap();
            let seen = frame.stats.counts.hits as f64 / frame.stats.counts.pixels as f64;
            // The rest is sky, where a scene has one.
            assert!(seen > 0.6, "{}: {seen} of the image shows something", path.display());
            assert!(frame.image.color().iter().flatten().all(|value| value.is_finite()), "{}", path.display());
        }
    }
}
