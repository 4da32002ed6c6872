//! One image on several devices, for which renderers on the CPU stand.

use std::sync::Mutex;
use std::sync::atomic::{AtomicU32, Ordering};

use lightmesh_render::{
    AmbientSource, Crop, Device, Frame, Lookup, MeshCache, Mode, Observer, PreparedScene, Progress, Quality,
    RenderError, Renderer, Settings, Speeds, Unobserved, Worker, render_together,
};
use lightmesh_scene::Scene;

const SIZE: [u32; 2] = [40, 300];

fn renderer() -> Renderer {
    Renderer::with_threads(Device::Cpu, Some(2)).unwrap()
}

fn settings() -> Settings {
    Settings::default().with_size(SIZE)
}

fn together(workers: &[&dyn Worker], scene: &PreparedScene, settings: &Settings) -> Result<Frame, RenderError> {
    render_together(workers, &Speeds::default(), (&mut MeshCache::new(), scene, settings), &Unobserved)
}

/// A renderer whose device fails from a band on.
struct Failing {
    renderer: Renderer,
    bands: AtomicU32,
    error: fn() -> RenderError,
}

impl Failing {
    fn after(bands: u32, error: fn() -> RenderError) -> Failing {
        Failing { renderer: renderer(), bands: AtomicU32::new(bands), error }
    }
}

impl Worker for Failing {
    fn name(&self) -> String {
        "a frail device".to_owned()
    }

    fn id(&self) -> Option<u64> {
        Some(7)
    }

    fn render(
        &self,
        cache: &mut MeshCache,
        scene: &PreparedScene,
        settings: &Settings,
        observer: &dyn Observer,
    ) -> Result<Frame, RenderError> {
        let left = self.bands.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |bands| bands.checked_sub(1));
        left.map_err(|_| (self.error)())?;
        self.renderer.render_with(cache, scene, settings, observer)
    }
}

fn lost() -> RenderError {
    RenderError::Device { device: "cuda:7".to_owned(), reason: "it fell off the bus".to_owned() }
}

#[test]
fn several_devices_render_the_image_of_one() {
    let [a, b, c] = [renderer(), renderer(), renderer()];
    let park = Scene::open("builtin:childpark").unwrap();
    let sky = Scene::open("builtin:gazebo").unwrap();
    let gathered = settings().with_ambient_light(AmbientSource::Mesh).with_quality(Quality::Draft);
    let cases = [
        ("lists", &park, settings()),
        ("layers", &park, settings().with_layers(true).with_quality(Quality::Draft)),
        ("rays", &park, settings().with_mode(Mode::RayTrace).with_aa(4)),
        ("a mesh", &park, settings().with_lookup(Lookup::HalfBall).with_step(4.0)),
        ("transparent", &park, settings().with_transparent(true)),
        ("a crop", &park, settings().with_crop(Crop::new([5, 20], [30, 260]))),
        ("around", &park, settings().with_crop(Crop::new([-3, -40], [50, 380]))),
        ("gathered light", &sky, gathered),
    ];
    for (name, scene, settings) in cases {
        let prepared = a.prepare(scene, &settings, &Unobserved).unwrap();
        let one = a.render_prepared(&prepared, &settings, &Unobserved).unwrap();
        for workers in [&[&a as &dyn Worker, &b][..], &[&a, &b, &c]] {
            let all = together(workers, &prepared, &settings).unwrap();
            assert!(all.image == one.image, "{name} on {}", workers.len());
            assert_eq!(all.stats.settings.crop, one.stats.settings.crop, "{name}");
            assert_eq!(all.stats.counts.pixels as usize, one.color().len(), "{name}");
        }
    }
}

#[test]
fn what_light_points_know_goes_on_to_the_next_image() {
    let (sound, frail) = (renderer(), Failing::after(0, lost));
    let scene = Scene::open("builtin:childpark").unwrap();
    let settings = settings().with_lookup(Lookup::HalfBall).with_step(4.0);
    let prepared = sound.prepare(&scene, &settings, &Unobserved).unwrap();
    for workers in [[&sound as &dyn Worker, &frail], [&frail, &sound]] {
        let mut cache = MeshCache::new();
        let mut render =
            || render_together(&workers, &Speeds::default(), (&mut cache, &prepared, &settings), &Unobserved).unwrap();
        // All rows are those of the sound device: which rows another takes depends on the time.
        let (first, again) = (render(), render());
        assert!(again.image == first.image);
        assert!(first.stats.counts.long_tests > 0 && again.stats.counts.long_tests == 0);
    }
}

#[test]
fn the_rows_of_a_device_that_fails_go_to_the_others() {
    /// Keeps what is noted.
    #[derive(Default)]
    struct Notes(Mutex<Vec<String>>);
    impl Observer for Notes {
        fn note(&self, text: &str) {
            self.0.lock().unwrap().push(text.to_owned());
        }
    }
    let sound = renderer();
    let scene = Scene::open("builtin:childpark").unwrap();
    let prepared = sound.prepare(&scene, &settings(), &Unobserved).unwrap();
    let one = sound.render_prepared(&prepared, &settings(), &Unobserved).unwrap();
    for bands in [0, 1] {
        let (frail, notes) = (Failing::after(bands, lost), Notes::default());
        let all = render_together(
            &[&frail, &sound],
            &Speeds::default(),
            (&mut MeshCache::new(), &prepared, &settings()),
            &notes,
        )
        .unwrap();
        assert!(all.image == one.image);
        let notes = notes.0.into_inner().unwrap();
        let told = notes.iter().filter(|note| note.contains("a frail device") && note.contains("fell off")).count();
        // The other may have been so quick that it was never asked again.
        assert!(told == 1 || told == 0 && bands == 1, "{notes:?}");
    }
    let none = [Failing::after(0, lost), Failing::after(1, lost)];
    let failed = together(&[&none[0], &none[1]], &prepared, &settings());
    assert!(matches!(failed, Err(RenderError::Device { .. })), "{failed:?}");
}

#[test]
fn an_error_of_the_image_ends_all() {
    let (sound, frail) = (
        renderer(),
        Failing::after(0, || RenderError::Setting {
            setting: lightmesh_render::Setting::Samples,
            value: "0".to_owned(),
            remedy: "choose more",
        }),
    );
    let prepared = sound.prepare(&Scene::open("builtin:childpark").unwrap(), &settings(), &Unobserved).unwrap();
    for settings in [settings(), settings().with_partial(true)] {
        let failed = together(&[&sound, &frail], &prepared, &settings);
        assert!(matches!(failed, Err(RenderError::Setting { .. })), "{failed:?}");
    }
    // One that has more rows than there are numbers.
    let far = settings().with_crop(Crop::new([0, i32::MAX - 3], [4, 300]));
    let errors =
        [together(&[&sound, &renderer()], &prepared, &far), sound.render_prepared(&prepared, &far, &Unobserved)];
    assert_eq!(errors[0].as_ref().err().map(ToString::to_string), errors[1].as_ref().err().map(ToString::to_string));
}

#[test]
fn progress_is_that_of_the_whole_and_a_stop_leaves_rows_from_the_top() {
    /// Stops when so much is done.
    struct Stop(f64, Mutex<Vec<Progress>>);
    impl Observer for Stop {
        fn progress(&self, progress: Progress) {
            self.1.lock().unwrap().push(progress);
        }

        fn cancelled(&self) -> bool {
            self.1.lock().unwrap().last().is_some_and(|progress| progress.done > self.0)
        }
    }
    let [a, b] = [renderer(), renderer()];
    let settings = settings().with_layers(true).with_mode(Mode::RayTrace);
    let prepared = a.prepare(&Scene::open("builtin:childpark").unwrap(), &settings, &Unobserved).unwrap();
    let one = a.render_prepared(&prepared, &settings, &Unobserved).unwrap();
    let render = |settings: &Settings, share: f64| {
        let stop = Stop(share, Mutex::default());
        let frame = render_together(&[&a, &b], &Speeds::default(), (&mut MeshCache::new(), &prepared, settings), &stop);
        (frame, stop.1.into_inner().unwrap())
    };
    let (whole, told) = render(&settings, 2.0);
    assert!(whole.unwrap().image == one.image);
    assert!(told.windows(2).all(|pair| pair[0].done <= pair[1].done) && told.last().unwrap().done == 1.0, "{told:?}");

    assert!(matches!(render(&settings, 0.3).0, Err(RenderError::Cancelled)));
    let part = render(&settings.clone().with_partial(true), 0.5).0.unwrap();
    let finished = part.finished_rows();
    assert!(part.size() == SIZE && finished > 0, "{finished}");
    let pixels = (finished * SIZE[0]) as usize;
    assert_eq!(part.color()[..pixels], one.color()[..pixels]);
    let depth = &part.layers().unwrap().depth;
    assert!(
        depth[..pixels] == one.layers().unwrap().depth[..pixels]
            && depth[pixels..].iter().all(|depth| depth.is_infinite())
    );
}
