//! Structures that a device does not have: an error before any work, or another one with a note.

use std::sync::{Arc, Mutex};

use libtest_mimic::Trial;
use lightmesh_emulator::Emulator;
use lightmesh_render::backend::{Cpu, Cuda};
use lightmesh_render::{
    Acceleration, AmbientSource, GivenPoints, Mode, Observer, RenderError, Settings, Unobserved, render_on,
    visibility_on,
};

use crate::scenes::{ACCELERATIONS, GLAZED, SUBJECTS, Subject};

pub(crate) fn trials() -> Vec<Trial> {
    let trial = |name: &str, run: fn()| {
        Trial::test(format!("emulator::structures::{name}"), move || {
            run();
            Ok(())
        })
    };
    vec![
        trial("brute_force_is_refused", brute_force_is_refused),
        trial("cut_outs_take_a_bvh", || takes_a_bvh(subject("cut_outs"))),
        trial("panes_take_a_bvh", || takes_a_bvh(&GLAZED)),
        trial("opaque_scenes_keep_their_grid", opaque_scenes_keep_their_grid),
    ]
}

fn subject(name: &str) -> &'static Subject {
    SUBJECTS.iter().find(|subject| subject.name == name).expect("there is one")
}

/// As on a device: nothing is allocated before the error, which names structure, device and remedy.
fn brute_force_is_refused() {
    let runtime = Arc::new(Emulator::new().without_brute_force());
    let cuda = Cuda::new(Arc::clone(&runtime));
    let scene = subject("soup").prepared(2);
    let settings = settings(2);
    assert_eq!(settings.acceleration, Acceleration::BruteForce);
    let refused = render_on(&cuda, scene, &settings, &Unobserved).map(drop);
    let points = [glam::Vec3::ZERO];
    let given = GivenPoints::new(scene, &points, &[glam::Vec3::Y]).unwrap();
    let also = visibility_on(&cuda, &given, &settings, &Unobserved).map(drop);
    for refused in [refused, also] {
        let error = refused.unwrap_err();
        assert!(matches!(&error, RenderError::Structure { .. }), "{error:?}");
        let text = error.to_string();
        for word in ["brute-force", "emulated CUDA device", "choose bvh or grid"] {
            assert!(text.contains(word), "{text}");
        }
    }
    assert_eq!(runtime.take_traffic(), Default::default());
    render_on(&Cuda::new(Arc::new(Emulator::new())), scene, &settings, &Unobserved).unwrap();
    let settings = settings.with_acceleration(Acceleration::Bvh);
    render_on(&cuda, subject("soup").prepared(0), &settings, &Unobserved).unwrap();
}

/// What an observer is told.
#[derive(Default)]
struct Notes(Mutex<Vec<String>>);

impl Observer for Notes {
    fn note(&self, text: &str) {
        self.0.lock().unwrap().push(text.to_owned());
    }
}

impl Notes {
    fn on_grids(&self) -> usize {
        self.0.lock().unwrap().iter().filter(|note| note.contains("a BVH takes the grid's place")).count()
    }
}

/// Few kernels: hard shadows, one sample of a pixel.
fn settings(acceleration: usize) -> Settings {
    let settings = Settings::default().with_mode(Mode::RayTrace).with_aa(1).with_size([21, 17]);
    settings.with_ambient_light(AmbientSource::Constant).with_acceleration(ACCELERATIONS[acceleration].clone())
}

/// A grid with cut-outs: the same image as with a BVH and on the CPU, and one note for all images.
fn takes_a_bvh(subject: &'static Subject) {
    let cuda = Cuda::new(Arc::new(Emulator::new()));
    let notes = Notes::default();
    let [grid, again] = [(); 2].map(|()| render_on(&cuda, subject.prepared(1), &settings(1), &notes).unwrap());
    assert_eq!(notes.on_grids(), 1);
    let bvh = render_on(&cuda, subject.prepared(0), &settings(0), &notes).unwrap();
    assert_eq!(notes.on_grids(), 1);
    assert!(grid.color() == bvh.color() && again.color() == bvh.color());
    let host = render_on(&Cpu, subject.prepared(1), &settings(1), &notes).unwrap();
    assert_eq!((notes.on_grids(), host.stats.settings.accel), (1, "grid"), "the CPU keeps its grid");
}

fn opaque_scenes_keep_their_grid() {
    let runtime = Arc::new(Emulator::new());
    let notes = Notes::default();
    render_on(&Cuda::new(Arc::clone(&runtime)), subject("soup").prepared(1), &settings(1), &notes).unwrap();
    assert_eq!(notes.on_grids(), 0);
    let launched = runtime.take_traffic().launches;
    assert!(launched.contains_key("primary_rays::primary_rays_grid"), "{launched:?}");
}
