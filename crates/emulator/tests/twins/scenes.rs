//! Scenes on which devices are compared with the CPU.

use std::path::Path;
use std::sync::OnceLock;

use glam::{DVec3, Vec3};
use lightmesh_render::{Acceleration, PreparedScene, Unobserved, View};
use lightmesh_scene::{Falloff, LightKind, Material, Scene, Sky, SunPosition, Up};
use lightmesh_testkit::{
    SceneDraft, glazed, half_plane, many_balls, mirror_room, perforated, pile, runs_all, soup, thicket,
};

/// The structures, in the order of [`Subject::prepared`].
pub(crate) const ACCELERATIONS: [Acceleration; 3] =
    [Acceleration::Bvh, Acceleration::Grid(None), Acceleration::BruteForce];

/// A scene that is built and prepared on first use.
pub(crate) struct Subject {
    pub(crate) name: &'static str,
    /// Light-mesh step for tests.
    pub(crate) step: f32,
    /// Few triangles: every stage may test all of them.
    pub(crate) small: bool,
    build: fn() -> Scene,
    scene: OnceLock<Scene>,
    prepared: [OnceLock<PreparedScene>; 3],
}

const fn subject(name: &'static str, step: f32, small: bool, build: fn() -> Scene) -> Subject {
    Subject { name, step, small, build, scene: OnceLock::new(), prepared: [const { OnceLock::new() }; 3] }
}

/// All scenes.
pub(crate) static SUBJECTS: [Subject; 10] = [
    subject("gazebo", 2.0, false, || builtin("gazebo")),
    subject("childpark", 1.0, false, || builtin("childpark")),
    subject("garden", 0.1, false, || builtin("garden")),
    subject("still_life", 0.2, false, still_life),
    subject("all_lights", 0.25, true, all_lights),
    subject("cut_outs", 0.25, true, || perforated(all_lights())),
    subject("instances", 0.4, true, many_balls),
    subject("half_plane", 0.2, true, half_plane),
    subject("soup", 0.3, true, || soup(7, 200)),
    subject("empty", 1.0, true, || SceneDraft::new().point_light([0.0; 3]).camera([1.0; 3], [0.0; 3]).finish("empty")),
];

/// For images only: what it adds affects no other stage than shading.
pub(crate) static TEXTURED: Subject = subject("textured", 0.25, true, crate::textured::textured);

/// For images only, too.
pub(crate) static SURROUNDED: Subject = subject("surrounded", 0.25, true, surrounded);

/// For images with rays that surfaces let through.
pub(crate) static GLAZED: Subject = subject("glazed", 0.25, true, || rounded(glazed(all_lights())));

/// The same with shapes in many places.
pub(crate) static GLAZED_INSTANCES: Subject = subject("glazed_instances", 0.4, true, || glazed(many_balls()));

/// For occluder lists that give way to rays.
pub(crate) static THICKET: Subject = subject("thicket", 0.4, true, thicket);

/// For rays that are mirrored several times.
pub(crate) static MIRRORS: Subject = subject("mirrors", 0.25, true, || mirror_room(0.9));

/// For gathered light.
pub(crate) static LAMPS: Subject = subject("lamps", 0.5, true, lamps);
/// For gathered light, too: parallel planes within a cell.
pub(crate) static STEPS: Subject = subject("steps", 0.5, true, steps);

impl Subject {
    /// Whether comparisons have their whole size: those of scenes with many triangles are small by default.
    pub(crate) fn runs_whole(&self) -> bool {
        self.small || runs_all()
    }

    /// The scene.
    pub(crate) fn scene(&'static self) -> &'static Scene {
        self.scene.get_or_init(self.build)
    }

    /// The scene prepared with one of [`ACCELERATIONS`].
    pub(crate) fn prepared(&'static self, acceleration: usize) -> &'static PreparedScene {
        self.prepared[acceleration].get_or_init(|| {
            PreparedScene::new(self.scene(), &ACCELERATIONS[acceleration], &Unobserved)
                .unwrap_or_else(|error| panic!("{}: {error}", self.name))
        })
    }

    /// What its first camera sees.
    pub(crate) fn view(&'static self, size: [u32; 2]) -> View {
        let scene = self.scene();
        let camera = scene.cameras.first().cloned().unwrap_or_else(|| scene.default_camera(Default::default()));
        View::new(&camera, size)
    }
}

fn builtin(name: &str) -> Scene {
    Scene::open(format!("builtin:{name}")).unwrap_or_else(|error| panic!("{error}"))
}

/// Mirrors, vertex normals, area lights. Also found from the repository's root, if the test was built elsewhere.
fn still_life() -> Scene {
    let built_in = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/still_life.toml"));
    let path = if built_in.exists() { built_in } else { Path::new("scenes/still_life.toml") };
    Scene::open(path).unwrap_or_else(|error| panic!("{error}"))
}

/// Textures, colours and mirrors under a sky with its sun.
fn surrounded() -> Scene {
    let mut scene = crate::textured::textured();
    let sky = Sky { north: 20.0, ..Sky::clear(SunPosition { elevation: 30.0, azimuth: 170.0 }) };
    scene.lights.surround(sky.surroundings(Up::Y).expect("there is such a sky"));
    scene
}

/// With the vertex normals of a ball, whatever its shape.
fn rounded(mut scene: Scene) -> Scene {
    let mesh = &mut scene.geometry_mut().mesh;
    mesh.normals = mesh.positions.iter().map(|position| position.normalize_or(Vec3::Y)).collect();
    scene
}

/// A room with a lamp that is a box, one that is a panel, one that is a ball, and a glowing wall.
fn lamps() -> Scene {
    let [wall, lamp, glow] = [[0.0; 3], [6.0, 5.0, 4.0], [0.2, 0.1, 0.3]]
        .map(|emission| Material::matt([0.6, 0.5, 0.4]).with_emission(emission));
    let draft = SceneDraft::new().painted(wall.clone()).cuboid([-4.0, 0.0, -4.0], [4.0, 4.0, 4.0]);
    let draft = draft.cuboid([-2.0, 0.0, -1.0], [-1.0, 1.5, 0.0]).painted(wall.named("other").with_ks([0.2; 3]));
    let draft = draft.cuboid([1.0, 0.0, -2.0], [2.0, 0.7, -1.0]);
    let draft = draft.painted(lamp.clone().named("box")).cuboid([0.2, 3.0, 0.1], [0.7, 3.25, 0.5]);
    let draft = draft.painted(lamp.clone().named("ball")).smooth_ball(DVec3::new(-0.4, 1.4, -0.6), 0.2, [6, 8]);
    let draft = draft.painted(lamp.named("panel"));
    let draft = draft.quad([[-3.0, 3.0, 1.0], [-2.0, 3.0, 1.0], [-2.0, 3.2, 2.0], [-3.0, 3.2, 2.0]]);
    let draft = draft.painted(glow.named("glow")).quad([
        [-3.9, 0.5, -3.0],
        [-3.9, 0.5, 3.0],
        [-3.9, 3.5, 3.0],
        [-3.9, 3.5, -3.0],
    ]);
    let mut scene = draft.camera([0.5, 2.0, 3.5], [0.0, 1.5, -2.0]).finish("lamps");
    scene.add_lamps();
    // The wall is left to gather rays.
    scene.lights.list.retain(|light| light.name != "glow");
    scene.geometry_mut().materials.iter_mut().for_each(|material| material.lamp &= material.name != "glow");
    let balls = scene.lights.iter().filter(|light| light.surface.is_none()).count();
    assert!(scene.lights.len() > 5 && balls == 1);
    scene
}

/// Stairs beside a wall, with steps so low that several belong to one cell.
fn steps() -> Scene {
    let draft =
        SceneDraft::new().cuboid([-3.0, -0.5, -3.5], [3.0, 0.0, 3.0]).cuboid([-3.0, 0.0, -3.5], [3.0, 3.0, -3.0]);
    let step = |draft: SceneDraft, index: i32| {
        let front = 1.5 - 0.25 * f64::from(index);
        draft.cuboid([-1.5, 0.0, front - 0.25], [1.5, 0.12 * f64::from(index + 1), front])
    };
    let draft = (0..16).fold(draft, step).light(LightKind::Sphere { position: Vec3::new(-2.0, 4.0, 3.0), radius: 0.5 });
    draft.camera([1.0, 3.0, 4.5], [0.0, 0.8, -0.5]).finish("steps")
}

/// A light of every kind over a pile and a mirror, far from the world's origin.
fn all_lights() -> Scene {
    let position = Vec3::new(-1.5, 3.0, 1.0);
    let (down, slanted) = (Vec3::NEG_Y, Vec3::new(0.6, -0.8, 0.0));
    // Its disk crosses the horizon of the boxes' sides.
    let grazing = Vec3::new(0.6, -0.8, -0.05).normalize();
    let kinds = [
        LightKind::Point { position, spread: 0.2 },
        LightKind::Directional { direction: slanted, angle: 0.0 },
        LightKind::Directional { direction: grazing, angle: 0.2 },
        LightKind::Spot { position: Vec3::new(1.0, 3.0, 0.5), direction: down, inner: 0.2, outer: 0.6, radius: 0.0 },
        LightKind::Spot {
            position: Vec3::new(-1.0, 3.5, 2.0),
            direction: slanted,
            inner: 0.1,
            outer: 0.9,
            radius: 0.4,
        },
        LightKind::Sphere { position: Vec3::new(2.0, 2.5, -1.0), radius: 0.3 },
        LightKind::Disk { position: Vec3::new(-2.0, 2.0, -2.0), normal: slanted, radius: 0.4 },
        LightKind::Rectangle { position: Vec3::new(0.0, 1.5, 2.0), half_u: 0.3 * Vec3::X, half_v: 0.2 * Vec3::Z },
    ];
    let mut scene = pile(DVec3::new(1.0e5, -2.0e4, 3.0e5), &kinds);
    for (light, index) in scene.lights.iter_mut().zip(0..) {
        light.intensity = Vec3::new(0.3, 0.25, 0.2) * (1.0 + index as f32);
        light.falloff = if index % 2 == 0 { Falloff::None } else { Falloff::InverseSquare };
        light.visible = index % 3 == 1;
    }
    let material = scene.geometry.materials[0].clone().with_ks([0.4, 0.3, 0.2]);
    scene.geometry_mut().materials.fill(material);
    scene.lights.ambient = Some(Vec3::splat(0.1));
    scene.lights.background = Some(Vec3::new(0.2, 0.3, 0.4));
    scene
}
