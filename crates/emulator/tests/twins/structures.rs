//! Structures that a device does not have: an error before any work, or another one with a note.

use std::sync::{Arc, Mutex};

use libtest_mimic::Trial;
use lightmesh_emulator::Emulator;
use lightmesh_render::backend::Cuda;
use lightmesh_render::{
    Acceleration, GivenPoints, Observer, PreparedScene, RenderError, Settings, Unobserved, render_on, visibility_on,
};

use crate::scenes::{ACCELERATIONS, SUBJECTS, Subject};

pub(crate) fn trials() -> Vec<Trial> {
    let trial = |name: &str, run: fn()| {
        Trial::test(format!("emulator::structures::{name}"), move || {
            run();
            Ok(())
        })
    };
    vec![trial("brute_force_is_refused", brute_force_is_refused)]
}

fn subject(name: &str) -> &'static Subject {
    SUBJECTS.iter().find(|subject| subject.name == name).expect("there is one")
}

/// As on a device: nothing is allocated before the error, which names structure, device and remedy.
fn brute_force_is_refused() {
    let runtime = Arc::new(Emulator::new().without_brute_force());
    let cuda = Cuda::new(Arc::clone(&runtime));
    let scene = subject("soup").prepared(2);
    let settings = Settings::default().with_size([8, 8]).with_acceleration(Acceleration::BruteForce);
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
