//! Whole images in all modes, with mirrors and layers; and visibility at given points.

use glam::Vec3;
use lightmesh_image::{Layers, Transfer};
use lightmesh_render::backend::{Cpu, Cuda};
use lightmesh_render::{
    Acceleration, AmbientSource, Counts, Crop, Frame, GivenPoints, Lookup, Mode, PointVisibility, PreparedScene,
    Settings, Step, Unobserved, render_on, visibility_on,
};
use lightmesh_scene::{Bounds, Up};
use lightmesh_testkit::{Picture, Random};

use crate::scenes::{GLAZED, GLAZED_INSTANCES, MIRRORS, SUBJECTS, SURROUNDED, Subject, TEXTURED};
use crate::stages::{SHARE_TOLERANCE, alike};
use crate::trials::{Case, Target};

const SIZE: [u32; 2] = [45, 37];

/// A technique: its name, and the mode and lookup that select it.
type Way = (&'static str, Mode, Lookup);

const WAYS: [Way; 5] = [
    ("lists", Mode::LightMesh, Lookup::Lists),
    ("adaptive", Mode::LightMesh, Lookup::Adaptive),
    ("light-mesh", Mode::LightMesh, Lookup::HalfBall),
    ("ray-trace", Mode::RayTrace, Lookup::Auto),
    ("area", Mode::Area, Lookup::Auto),
];

pub(crate) fn cases<R: Target>() -> Vec<Case<R>> {
    let mut cases = Vec::new();
    for subject in SUBJECTS.iter().chain([&TEXTURED, &SURROUNDED, &GLAZED, &GLAZED_INSTANCES]) {
        for way in WAYS {
            let (name, ..) = way;
            let picture = format!("{}::picture::{name}", subject.name);
            cases.push(Case::new(picture, move |cuda| same_picture(cuda, subject, settings(subject, way))));
            let samples = format!("{}::samples::{name}", subject.name);
            cases.push(Case::new(samples, move |cuda| same_picture(cuda, subject, settings(subject, way).with_aa(6))));
            let points = format!("{}::points::{name}", subject.name);
            cases.push(Case::new(points, move |cuda| same_at_points(cuda, subject, way)));
        }
    }
    for bounces in [1, 6] {
        let settings = move || settings(&MIRRORS, WAYS[0]).with_bounces(bounces);
        let name = format!("{}::bounces::{bounces}", MIRRORS.name);
        cases.push(Case::new(name, move |cuda| same_picture(cuda, &MIRRORS, settings())));
    }
    for way in WAYS {
        let part = format!("{}::part::{}", TEXTURED.name, way.0);
        let crop = move || settings(&TEXTURED, way).with_aa(3).with_crop(Crop::new([17, 9], [15, 11]));
        cases.push(Case::new(part, move |cuda| same_picture(cuda, &TEXTURED, crop())));
        for aa in [1, 3] {
            for subject in [&TEXTURED, &SURROUNDED, &GLAZED] {
                let ground = format!("{}::ground::{}::{aa}", subject.name, way.0);
                let settings = move || settings(subject, way).with_aa(aa).with_size([21, 17]);
                cases.push(Case::new(ground, move |cuda| same_shadows(cuda, subject, settings())));
            }
        }
    }
    cases
}

fn settings(subject: &Subject, (_, mode, lookup): Way) -> Settings {
    // Gathered light has cases of its own.
    let settings = Settings::default().with_ambient_light(AmbientSource::Constant).with_bounces(2).with_layers(true);
    let settings = settings.with_mode(mode).with_lookup(lookup).with_size(SIZE);
    settings.with_samples(4).with_step(Step::Fixed(subject.step)).with_radius(2.1).with_aa(1)
}

/// The image with these settings.
fn same_picture<R: Target>(cuda: &Cuda<R>, subject: &'static Subject, settings: Settings) {
    same_frame(cuda, subject.prepared(0), settings);
}

/// What a ground under the scene catches, with alpha.
fn same_shadows<R: Target>(cuda: &Cuda<R>, subject: &'static Subject, settings: Settings) {
    let mut scene = subject.scene().clone();
    scene.add_ground(Up::Y);
    let scene = PreparedScene::new(&scene, &Acceleration::Bvh, &Unobserved).unwrap();
    same_frame(cuda, &scene, settings.with_transparent(true));
}

pub(crate) fn same_frame<R: Target>(cuda: &Cuda<R>, scene: &PreparedScene, settings: Settings) -> [Frame; 2] {
    let host = render_on(&Cpu, scene, &settings, &Unobserved).unwrap();
    let device = render_on(cuda, scene, &settings, &Unobserved).unwrap();
    same_colors::<R>(&host, &device);
    same_layers::<R>(host.image.layers().expect("asked for"), device.image.layers().expect("asked for"));
    assert_eq!(counts(&host.stats.counts), counts(&device.stats.counts));

    let again = render_on(cuda, scene, &settings, &Unobserved).unwrap();
    assert!(Picture::new(&device).bits() == Picture::new(&again).bits(), "the same image twice");
    for frame in [&host, &device] {
        assert_eq!(Picture::new(frame).ungrouped(), None, "the radiance of single lights adds up");
    }
    [host, device]
}

/// Given points, all over the scene and a little outside of it, see the same.
fn same_at_points<R: Target>(cuda: &Cuda<R>, subject: &'static Subject, way: Way) {
    let scene = subject.prepared(0);
    let unit = Bounds { min: Vec3::ZERO, max: Vec3::ONE };
    let bounds = if scene.geometry.bounds.is_empty() { unit } else { scene.geometry.bounds };
    let mut random = Random::new(7);
    let mut signed = || Vec3::from([0; 3].map(|_| 2.0 * random.unit() as f32 - 1.0));
    let points: Vec<Vec3> = (0..1500).map(|_| bounds.center() + 0.6 * signed() * bounds.extent()).collect();
    let normals: Vec<Vec3> = points.iter().map(|_| signed()).collect();
    let given = GivenPoints::new(scene, &points, &normals).unwrap();
    let settings = settings(subject, way);
    let host = visibility_on(&Cpu, &given, &settings, &Unobserved).unwrap();
    let device = visibility_on(cuda, &given, &settings, &Unobserved).unwrap();
    let counted = |seen: &PointVisibility| counts(&seen.stats.counts);
    assert_eq!(counted(&host), counted(&device));
    assert_eq!(host.points(), points.len());
    for light in 0..host.lights() {
        let twins = host.of_light(light).iter().zip(device.of_light(light));
        let differ = twins.filter(|&(&a, &b)| !alike(a, b, SHARE_TOLERANCE)).count();
        assert!(differ <= R::allowed(points.len(), 100), "{differ} visibilities of light {light} differ");
        assert!(host.of_light(light).iter().any(|&share| share > 0.0), "light {light} is seen");
    }
}

/// All counts. How many short tests are decided without intersecting triangles differs between devices; their sum does not.
fn counts(counts: &Counts) -> String {
    let mut counts = counts.clone();
    counts.short_tests += std::mem::take(&mut counts.short_tests_culled);
    format!("{counts:?}")
}

/// 8-bit colours differ by one at most.
fn same_colors<R: Target>(host: &Frame, device: &Frame) {
    let near = |a: f32, b: f32| b.is_finite() && Transfer::Srgb.encode(a).abs_diff(Transfer::Srgb.encode(b)) <= 1;
    let twins = || host.image.color().iter().zip(device.image.color()).enumerate();
    let differ = || twins().filter(|(_, (a, b))| !a.iter().zip(*b).all(|(&a, &b)| near(a, b)));
    let allowed = R::allowed(twins().count(), 1000);
    assert!(differ().count() <= allowed, "pixels, on the CPU and on the device: {:?}", differ().collect::<Vec<_>>());
    let [host, device] = [host, device].map(|frame| frame.image.alpha().unwrap_or_default());
    assert_eq!(host.len(), device.len());
    let differ = host.iter().zip(device).filter(|&(&a, &b)| !alike(a, b, SHARE_TOLERANCE)).count();
    assert!(differ <= allowed, "{differ} alphas differ");
}

/// What pixels see is bit-identical; visibility differs by no more than the order of a sum can change.
fn same_layers<R: Target>(host: &Layers, device: &Layers) {
    let bits = |values: &[f32]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
    assert!(bits(&host.depth) == bits(&device.depth), "depth");
    assert!(bits(host.position.as_flattened()) == bits(device.position.as_flattened()), "position");
    assert!(bits(host.normal.as_flattened()) == bits(device.normal.as_flattened()), "normal");
    assert_eq!(host.used, device.used, "light points used");
    for (light, (a, b)) in host.visibility.iter().zip(&device.visibility).enumerate() {
        let differ = a.iter().zip(b).filter(|&(&a, &b)| !alike(a, b, SHARE_TOLERANCE)).count();
        assert!(differ <= R::allowed(a.len(), 100), "{differ} visibilities of light {light} differ");
    }
    for (a, b) in [(&host.object, &device.object), (&host.material, &device.material)] {
        assert!(a.names == b.names && a.nearest == b.nearest && !a.is_empty(), "ids");
        // What a shadow catcher covers follows from visibility.
        for number in 1..=a.names.len() as u32 {
            let (a, b) = (a.of(number), b.of(number));
            let differ = a.iter().zip(&b).filter(|&(&a, &b)| !alike(a, b, SHARE_TOLERANCE)).count();
            assert!(differ <= R::allowed(a.len(), 100), "{differ} shares of {number} differ");
        }
    }
    assert_eq!((host.lights.len(), host.rest.len()), (host.visibility.len(), host.depth.len()));
    let groups = |layers: &Layers| layers.lights.iter().chain([&layers.rest]).flatten().copied().collect::<Vec<_>>();
    let near = |a: f32, b: f32| Transfer::Srgb.encode(a).abs_diff(Transfer::Srgb.encode(b)) <= 1;
    let (a, b) = (groups(host), groups(device));
    assert_eq!(a.len(), b.len());
    let differ = a.as_flattened().iter().zip(b.as_flattened()).filter(|&(&a, &b)| !near(a, b)).count();
    assert!(differ <= R::allowed(a.len(), 1000), "{differ} values of light groups differ");
}
