//! Images with cached light points: the same bits as without, and the same long tests saved as on the CPU.

use glam::Vec3;
use lightmesh_render::backend::{Cpu, Cuda};
use lightmesh_render::{Cache, Frame, PreparedScene, Settings, Step, Unobserved, render_on, render_on_with};
use lightmesh_scene::{Light, LightKind};
use lightmesh_testkit::runs_all;

use crate::scenes::{SUBJECTS, Subject};
use crate::trials::{Case, Target};

const SIZE: [u32; 2] = [45, 37];
/// For scenes with many triangles or many lights.
const SMALL: [u32; 2] = [18, 13];

pub(crate) fn cases<R: Target>() -> Vec<Case<R>> {
    let case = |subject: &'static Subject| {
        Case::new(format!("{}::kept", subject.name), move |cuda| same_pictures(cuda, subject))
    };
    SUBJECTS.iter().map(case).collect()
}

fn same_pictures<R: Target>(cuda: &Cuda<R>, subject: &'static Subject) {
    let (mut kept, mut on_host) = (Cache::default(), Cache::default());
    let mut saved = 0;
    for (step, scene) in scenes(subject).iter().enumerate() {
        let settings = settings(subject, step);
        let with = render_on_with(cuda, &mut kept, scene, &settings, &Unobserved).unwrap();
        let without = render_on(cuda, scene, &settings, &Unobserved).unwrap();
        assert!(bits(&with) == bits(&without), "picture {step}");
        let host = render_on_with(&Cpu, &mut on_host, scene, &settings, &Unobserved).unwrap();
        assert_eq!(tests(&with), tests(&host), "picture {step}");
        assert_eq!(tests(&with).iter().sum::<u64>(), tests(&without)[0], "picture {step}");
        saved += tests(&with)[1];
    }
    assert_eq!(kept.len(), on_host.len());
    assert_eq!(!kept.is_empty(), saved > 0, "what is known is used");
    same_files(cuda, subject);
}

/// Both write the same file, and each reads that of the other.
fn same_files<R: Target>(cuda: &Cuda<R>, subject: &'static Subject) {
    let folder = tempfile::tempdir().unwrap();
    let [of_device, of_host] = ["device.mesh", "host.mesh"].map(|name| folder.path().join(name));
    let (scene, settings) = (subject.prepared(0), settings(subject, 0));
    let (mut kept, mut on_host) = (Cache::default(), Cache::default());
    let whole = render_on_with(cuda, &mut kept, scene, &settings, &Unobserved).unwrap();
    render_on_with(&Cpu, &mut on_host, scene, &settings, &Unobserved).unwrap();
    let Some(saved) = kept.save(&of_device, scene).unwrap() else {
        assert_eq!(on_host.save(&of_host, scene).unwrap(), None);
        return;
    };
    assert_eq!(Some(saved), on_host.save(&of_host, scene).unwrap());
    assert!(std::fs::read(&of_device).unwrap() == std::fs::read(&of_host).unwrap(), "the files differ");
    let mut kept = Cache::load(&of_host, scene, Default::default()).unwrap();
    assert_eq!(kept.len(), saved.values);
    let again = render_on_with(cuda, &mut kept, scene, &settings, &Unobserved).unwrap();
    assert!(bits(&again) == bits(&whole) && tests(&again)[0] == 0, "{:?}", tests(&again));
    assert_eq!(kept.len(), saved.values);
    let mut on_host = Cache::load(&of_device, scene, Default::default()).unwrap();
    let again = render_on_with(&Cpu, &mut on_host, scene, &settings, &Unobserved).unwrap();
    assert_eq!(tests(&again), [0, tests(&whole).iter().sum()]);
    // Other light points than those of the file are added to it.
    let elsewhere = self::settings(subject, 2);
    let fresh = render_on(cuda, scene, &elsewhere, &Unobserved).unwrap();
    let with = render_on_with(cuda, &mut kept, scene, &elsewhere, &Unobserved).unwrap();
    assert!(bits(&with) == bits(&fresh) && tests(&with).iter().sum::<u64>() == tests(&fresh)[0]);
}

/// The scene; with its last light moved; and with some of its triangles moved.
fn scenes(subject: &'static Subject) -> [PreparedScene; 5] {
    let scene = subject.prepared(0);
    let mut lights = scene.scene.lights.clone();
    if let Some(light) = lights.last_mut() {
        move_light(light);
    }
    let moved = scene.with_lights(lights);
    let mut elsewhere = moved.scene.clone();
    let mesh = &mut elsewhere.geometry_mut().mesh;
    let last = mesh.triangles[..mesh.triangles.len() / 8].iter().flatten().max();
    let moved_ones = last.map_or(0, |&last| last as usize + 1);
    mesh.positions[..moved_ones].iter_mut().for_each(|place| *place += Vec3::new(0.05, 0.02, -0.03));
    mesh.find_instance_bounds();
    let elsewhere = moved.moved(&elsewhere, Default::default(), &Unobserved).unwrap().expect("only places differ");
    [scene.clone(), scene.clone(), moved.clone(), moved, elsewhere]
}

fn move_light(light: &mut Light) {
    match &mut light.kind {
        LightKind::Directional { direction, .. } => *direction = Vec3::new(0.6, -0.8, 0.0),
        LightKind::Point { position, .. }
        | LightKind::Spot { position, .. }
        | LightKind::Sphere { position, .. }
        | LightKind::Disk { position, .. }
        | LightKind::Rectangle { position, .. } => *position += Vec3::new(0.2, 0.1, -0.1),
    }
}

/// A camera that moves to its right; area lights, mirrors.
fn settings(subject: &'static Subject, step: usize) -> Settings {
    let scene = subject.scene();
    let camera = scene.cameras.first().cloned().unwrap_or_else(|| scene.default_camera(Default::default()));
    let (right, ..) = camera.basis();
    let position = camera.position + 3.0 * subject.step * step as f32 * right;
    Settings::default()
        .with_aa(1)
        .with_size(if matches!(subject.name, "soup" | "half_plane") || runs_all() { SIZE } else { SMALL })
        .with_bounces(2)
        .with_samples(4)
        .with_step(Step::Fixed(subject.step))
        .with_radius(2.1)
        .with_camera(camera.with_position(position))
}

fn bits(frame: &Frame) -> Vec<[u32; 3]> {
    frame.image.color().iter().map(|color| color.map(f32::to_bits)).collect()
}

/// Long tests performed and saved.
fn tests(frame: &Frame) -> [u64; 2] {
    [frame.stats.counts.long_tests, frame.stats.counts.long_tests_saved]
}
