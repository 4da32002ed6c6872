//! Whole images in all modes, with mirrors and layers; and visibility at given points.

use glam::Vec3;
use lightmesh_image::{Layers, Transfer};
use lightmesh_render::backend::{Cpu, Cuda};
use lightmesh_render::{
    AmbientSource, Counts, Crop, Frame, GivenPoints, Glass, Lookup, Mode, PointVisibility, PreparedScene, Settings,
    Step, Unobserved, render_on, visibility_on,
};
use lightmesh_scene::{Bounds, Camera, Light, Lights, Up};
use lightmesh_testkit::{Picture, Random, runs_all, seed};

use crate::pairwise;
use crate::scenes::{ACCELERATIONS, GLAZED, GLAZED_INSTANCES, MIRRORS, SUBJECTS, SURROUNDED, Subject, TEXTURED};
use crate::stages::{SHARE_TOLERANCE, alike};
use crate::trials::{Case, Target};

const SIZE: [u32; 2] = [45, 37];
const SMALL: [u32; 2] = [21, 17];

/// Subjects whose peculiarities only images show.
const OF_PICTURES: [&Subject; 4] = [&TEXTURED, &SURROUNDED, &GLAZED, &GLAZED_INSTANCES];

/// A technique: its name, and the mode and lookup that select it.
type Way = (&'static str, Mode, Lookup);

const WAYS: [Way; 5] = [
    ("lists", Mode::LightMesh, Lookup::Lists),
    ("adaptive", Mode::LightMesh, Lookup::Adaptive),
    ("light-mesh", Mode::LightMesh, Lookup::HalfBall),
    ("ray-trace", Mode::RayTrace, Lookup::Auto),
    ("area", Mode::Area, Lookup::Auto),
];

/// What other techniques than the default are compared in by default, beside the [`sweep`]: four subjects, one kind each.
const CHOSEN: [(&str, &str, Kind); 16] = [
    ("adaptive", "garden", Kind::Picture),
    ("adaptive", "surrounded", Kind::Samples),
    ("adaptive", "all_lights", Kind::Points),
    ("adaptive", "glazed_instances", Kind::Picture),
    ("light-mesh", "garden", Kind::Points),
    ("light-mesh", "surrounded", Kind::Picture),
    ("light-mesh", "all_lights", Kind::Samples),
    ("light-mesh", "glazed_instances", Kind::Points),
    ("ray-trace", "garden", Kind::Samples),
    ("ray-trace", "surrounded", Kind::Points),
    ("ray-trace", "all_lights", Kind::Picture),
    ("ray-trace", "glazed_instances", Kind::Samples),
    ("area", "garden", Kind::Picture),
    ("area", "surrounded", Kind::Points),
    ("area", "all_lights", Kind::Samples),
    ("area", "glazed_instances", Kind::Picture),
];

pub(crate) fn cases<R: Target>() -> Vec<Case<R>> {
    let mut cases = Vec::new();
    for subject in SUBJECTS.iter().chain(OF_PICTURES) {
        for way in WAYS {
            for kind in [Kind::Picture, Kind::Samples, Kind::Points] {
                let name = format!("{}::{}::{}", subject.name, kind.name(), way.0);
                let size = if subject.runs_whole() { SIZE } else { SMALL };
                let case = Case::new(name, move |cuda| same(cuda, subject, way, kind, 0, size));
                cases.push(case.only_if(way.0 == "lists" || CHOSEN.contains(&(way.0, subject.name, kind))));
            }
        }
    }
    for bounces in [1, 6] {
        let settings = move || settings(&MIRRORS, WAYS[0]).with_bounces(bounces);
        let name = format!("{}::bounces::{bounces}", MIRRORS.name);
        cases.push(Case::new(name, move |cuda| same_picture(cuda, &MIRRORS, 0, settings())));
    }
    for way in WAYS {
        let part = format!("{}::part::{}", TEXTURED.name, way.0);
        let crop = move || settings(&TEXTURED, way).with_aa(3).with_crop(Crop::new([17, 9], [15, 11]));
        let case = Case::new(part, move |cuda| same_picture(cuda, &TEXTURED, 0, crop()));
        cases.push(case.only_if(way.0 == "lists"));
        for (subject, kind) in [(&TEXTURED, Kind::Around), (&MIRRORS, Kind::Around), (&GLAZED, Kind::Clipped)] {
            let name = format!("{}::{}::{}", subject.name, kind.name(), way.0);
            let case = Case::new(name, move |cuda| same(cuda, subject, way, kind, 0, SMALL));
            cases.push(case.only_if(way.0 == "lists" || way.0 == "adaptive"));
        }
        for aa in [1, 3] {
            for subject in [&TEXTURED, &SURROUNDED, &GLAZED] {
                let ground = format!("{}::ground::{}::{aa}", subject.name, way.0);
                let settings = move || settings(subject, way).with_aa(aa).with_size(SMALL);
                let case = Case::new(ground, move |cuda| same_shadows(cuda, subject, 0, settings()));
                cases.push(case.only_if(way.0 == "lists" && aa == 3));
            }
        }
    }
    for subject in [&GLAZED, &GLAZED_INSTANCES] {
        cases.push(Case::new(format!("{}::hours", subject.name), move |cuda| same_hours(cuda, subject)));
    }
    cases.extend(sweep());
    cases
}

/// Small subjects with all techniques, kinds and structures: cases in which every pair of two choices occurs, drawn by a seed that is part of
/// their names.
fn sweep<R: Target>() -> Vec<Case<R>> {
    let subjects: Vec<_> = SUBJECTS.iter().filter(|subject| subject.small).chain(OF_PICTURES).collect();
    let kinds = Kind::ALL;
    let case = |row: &Vec<usize>| {
        let (subject, way, kind, structure) = (subjects[row[0]], WAYS[row[1]], kinds[row[2]], row[3]);
        let place = format!("sweep::{}::{}", seed(), subject.name);
        let name = format!("{place}::{}::{}::{structure}", kind.name(), way.0);
        Case::new(name, move |cuda: &Cuda<R>| same(cuda, subject, way, kind, structure, SMALL))
    };
    pairwise::rows(&[subjects.len(), WAYS.len(), kinds.len(), 2], seed()).iter().map(case).collect()
}

/// What is compared.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    /// An image by rays through the centres of pixels.
    Picture,
    /// One with several samples of each pixel.
    Samples,
    /// Visibility at given points.
    Points,
    /// What a ground catches, with alpha.
    Ground,
    /// A part of an image.
    Part,
    /// A part, and what is around the image there.
    Around,
    /// One of which the nearest and the farthest surfaces are cut away.
    Clipped,
}

impl Kind {
    const ALL: [Kind; 7] =
        [Kind::Picture, Kind::Samples, Kind::Points, Kind::Ground, Kind::Part, Kind::Around, Kind::Clipped];

    fn name(self) -> &'static str {
        match self {
            Kind::Picture => "picture",
            Kind::Samples => "samples",
            Kind::Points => "points",
            Kind::Ground => "ground",
            Kind::Part => "part",
            Kind::Around => "around",
            Kind::Clipped => "clipped",
        }
    }
}

/// Compares one kind. `structure` is a place in [`ACCELERATIONS`].
fn same<R: Target>(cuda: &Cuda<R>, subject: &'static Subject, way: Way, kind: Kind, structure: usize, size: [u32; 2]) {
    let settings = settings(subject, way).with_size(size);
    match kind {
        Kind::Picture => same_picture(cuda, subject, structure, settings),
        Kind::Samples => {
            let samples = if subject.runs_whole() { 6 } else { 3 };
            same_picture(cuda, subject, structure, settings.with_aa(samples));
        }
        Kind::Points => same_at_points(cuda, subject, structure, settings),
        Kind::Ground => same_shadows(cuda, subject, structure, settings.with_aa(3)),
        Kind::Part => {
            let part = Crop::new([size[0] / 3, size[1] / 4].map(|place| place as i32), size.map(|length| length / 3));
            same_picture(cuda, subject, structure, settings.with_aa(3).with_crop(part));
        }
        Kind::Around => {
            let around = Crop::new([-7, -5], [size[0] + 11, size[1] / 2]);
            same_picture(cuda, subject, structure, settings.with_aa(3).with_crop(around));
        }
        Kind::Clipped => same_picture(cuda, subject, structure, settings.with_aa(2).with_camera(clipped(subject))),
    }
}

fn settings(subject: &Subject, (_, mode, lookup): Way) -> Settings {
    // Gathered light has cases of its own.
    let settings = Settings::default().with_ambient_light(AmbientSource::Constant).with_bounces(2).with_layers(true);
    let settings = settings.with_mode(mode).with_lookup(lookup).with_size(SIZE);
    settings.with_samples(4).with_step(Step::Fixed(subject.step)).with_radius(2.1).with_aa(1)
}

/// The camera of a subject without the nearest and the farthest thirds of the depths of its scene.
fn clipped(subject: &'static Subject) -> Camera {
    let scene = subject.scene();
    let camera = scene.cameras[0].clone();
    let Bounds { min, max } = scene.geometry.mesh.bounds();
    let corner = |number: usize| Vec3::from_array([0, 1, 2].map(|axis| [min, max][number >> axis & 1][axis]));
    let depth = |number: usize| (corner(number) - camera.position).dot(camera.direction);
    let (low, high) = (0..8).map(depth).fold((f32::INFINITY, 0.0_f32), |(low, high), at| (low.min(at), high.max(at)));
    // Without surfaces there are no depths.
    let low = low.min(high).max(0.0);
    let (near, far) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
    camera.clone().with_clip(near, far).unwrap_or(camera)
}

/// The image with these settings.
fn same_picture<R: Target>(cuda: &Cuda<R>, subject: &'static Subject, structure: usize, settings: Settings) {
    let settings = settings.with_acceleration(ACCELERATIONS[structure].clone());
    same_frame(cuda, subject.prepared(structure), settings);
}

/// What a ground under the scene catches, with alpha.
fn same_shadows<R: Target>(cuda: &Cuda<R>, subject: &'static Subject, structure: usize, settings: Settings) {
    let mut scene = subject.scene().clone();
    scene.add_ground(Up::Y);
    let acceleration = &ACCELERATIONS[structure];
    let scene = PreparedScene::new(&scene, acceleration, &Unobserved).unwrap();
    same_frame(cuda, &scene, settings.with_transparent(true).with_acceleration(acceleration.clone()));
}

/// The suns of hours of direct sun: one is a disc, one all that it passes over. Where glass is open or closed, shadow rays meet other triangles than
/// where it is tinted, and nothing is transmitted.
fn same_hours<R: Target>(cuda: &Cuda<R>, subject: &'static Subject) {
    let scene = subject.prepared(0);
    let bounds = scene.geometry.bounds;
    let way = Vec3::new(0.3, 0.9, 0.2).normalize();
    let (u, v) = way.any_orthonormal_pair();
    let distance = 2048.0 * 0.5 * bounds.diagonal();
    let sweep = Light::rectangle(bounds.center() + distance * way, 0.03 * distance * u, 0.004 * distance * v).unwrap();
    let disc = Light::directional(-way).unwrap().with_angle(0.0093);
    let dark = [disc, sweep].map(|light| light.with_intensity(Vec3::ZERO));
    let lit = scene.with_lights(dark.into_iter().collect::<Lights>().with_ambient(Vec3::ZERO));
    let settings = settings(subject, WAYS[0]).with_bounces(0).with_samples(16).with_size(SMALL);
    let [open, tinted, closed] = [Glass::Open, Glass::Tinted, Glass::Closed].map(|glass| {
        let [host, _] = same_frame(cuda, &lit, settings.clone().with_glass(glass));
        let layers = host.image.layers().expect("asked for");
        layers.visibility.iter().flatten().sum::<f32>()
    });
    assert!(open > tinted && tinted > closed && closed > 0.0, "{open} {tinted} {closed}");
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
fn same_at_points<R: Target>(cuda: &Cuda<R>, subject: &'static Subject, structure: usize, settings: Settings) {
    let scene = subject.prepared(structure);
    let count = match (runs_all(), subject.small) {
        (true, _) => 1500,
        (false, true) => 400,
        (false, false) => 150,
    };
    let unit = Bounds { min: Vec3::ZERO, max: Vec3::ONE };
    let bounds = if scene.geometry.bounds.is_empty() { unit } else { scene.geometry.bounds };
    let mut random = Random::new(7);
    let mut signed = || Vec3::from([0; 3].map(|_| 2.0 * random.unit() as f32 - 1.0));
    let points: Vec<Vec3> = (0..count).map(|_| bounds.center() + 0.6 * signed() * bounds.extent()).collect();
    let normals: Vec<Vec3> = points.iter().map(|_| signed()).collect();
    let given = GivenPoints::new(scene, &points, &normals).unwrap();
    let settings = settings.with_acceleration(ACCELERATIONS[structure].clone());
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
