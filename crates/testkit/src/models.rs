//! The models next to the repository, with cameras and lights.

use std::path::PathBuf;

use glam::{DVec3, Vec3};
use lightmesh_scene::{Camera, Light, Scene};

/// A shared model with its view, in world coordinates.
#[derive(Clone, Copy, Debug)]
pub struct Model {
    /// File below the folder of shared scenes.
    pub file: &'static str,
    /// The eye.
    pub eye: [f64; 3],
    /// The view target.
    pub target: [f64; 3],
    /// Vertical field of view, degrees.
    pub vfov: f32,
    /// Position of a point light.
    pub light: [f64; 3],
}

const fn model(file: &'static str, eye: [f64; 3], target: [f64; 3], vfov: f32, light: [f64; 3]) -> Model {
    Model { file, eye, target, vfov, light }
}

/// All shared models.
#[rustfmt::skip]
pub const MODELS: [Model; 28] = [
    model("balloon/scene.gltf", [0.7, 0.75, 1.1], [0.15, 0.55, 0.0], 45.0, [1.5, 2.0, 1.5]),
    model("beetle/beetle.obj", [-1.0, 0.9, 1.2], [-0.04, 0.43, 0.2], 40.0, [-1.5, 2.5, 1.5]),
    model("bunny/bunny.ply", [-0.02, 0.15, 0.3], [-0.017, 0.11, 0.0], 40.0, [0.2, 0.4, 0.4]),
    model("bunny/stanford-bunny.obj", [-0.02, 0.15, 0.3], [-0.017, 0.11, 0.0], 40.0, [0.2, 0.4, 0.4]),
    model("camera_light/geometry-camera-light.glb", [8.0, -12.0, 8.0], [0.0, 0.0, 0.0], 45.0, [5.0, -5.0, 8.0]),
    model("chess/chess-board.glb", [110.0, 160.0, 260.0], [10.0, -10.0, 0.0], 45.0, [200.0, 400.0, 200.0]),
    model("complete/complete.glb", [600.0, 500.0, 1100.0], [-50.0, 100.0, 0.0], 50.0, [400.0, 900.0, 800.0]),
    model("cornell_box/cornell_box.obj", [278.0, 273.0, -800.0], [278.0, 273.0, 280.0], 39.0, [278.0, 500.0, 280.0]),
    model("cornell_gltf/cornellBox.gltf", [0.0, 0.0, 19.0], [0.0, 0.0, 0.0], 38.0, [0.0, 4.5, 0.0]),
    model("cubes/Cubes.glb", [8.0, 6.0, 10.0], [0.0, 0.5, 0.0], 45.0, [3.0, 6.0, 5.0]),
    model("cycloidal/cycloidal.ply", [1.2, -2.5, 4.0], [1.18, 0.6, 1.35], 40.0, [3.0, -3.0, 5.0]),
    model("duck/Duck.glb", [2.2, 2.2, 3.5], [0.1, 0.85, 0.0], 40.0, [3.0, 5.0, 4.0]),
    model("featuretype/featuretype.STL", [4.5, -6.0, 4.5], [0.0, 0.0, 0.5], 40.0, [5.0, -5.0, 8.0]),
    model("house/house.glb", [0.55, 0.35, 0.6], [0.0, 0.06, 0.0], 40.0, [0.8, 1.2, 0.6]),
    model("milk_truck/CesiumMilkTruck.glb", [5.0, 3.5, 6.0], [0.0, 1.1, 0.0], 40.0, [6.0, 8.0, 8.0]),
    model("mountains/Mountains.gltf", [1.6, 1.0, 1.6], [0.0, 0.0, 0.0], 45.0, [3.0, 2.0, 0.0]),
    model("node_hierarchy/02_node_hierarchy.gltf", [9.0, 7.0, 11.0], [2.0, 2.0, 0.0], 45.0, [10.0, 12.0, 10.0]),
    model("ogre/ogre.obj", [18.0, 24.0, 55.0], [0.0, 16.0, 0.0], 40.0, [30.0, 50.0, 50.0]),
    model("spider/spider.obj", [120.0, 110.0, 190.0], [-15.0, -5.0, -10.0], 45.0, [150.0, 250.0, 150.0]),
    model("spider/spider_ascii.stl", [5.0, -8.0, 7.0], [0.0, 0.0, 0.0], 45.0, [6.0, -4.0, 10.0]),
    model("spider/spider_binary.stl", [5.0, -8.0, 7.0], [0.0, 0.0, 0.0], 45.0, [6.0, -4.0, 10.0]),
    model("sponza/sponza.obj", [-13.0, 3.0, 0.0], [10.0, 5.0, 0.0], 60.0, [0.0, 13.0, 0.0]),
    model("spot/spot.obj", [2.0, 1.5, -2.8], [0.0, 0.1, 0.1], 40.0, [3.0, 4.0, -3.0]),
    model("suzanne/suzanne.obj", [-2.5, 1.6, 9.0], [-2.5, 1.25, 4.1], 35.0, [1.0, 5.0, 9.0]),
    model("suzanne/suzanne.ply", [1.5, 1.8, 4.5], [0.0, 1.25, 0.0], 35.0, [4.0, 5.0, 6.0]),
    model("teapot/teapot.obj", [3.0, 4.5, 8.0], [0.2, 1.4, 0.0], 40.0, [5.0, 8.0, 6.0]),
    model("teapot/teapot.ply", [3.0, -8.0, 4.5], [0.2, 0.0, 1.4], 40.0, [5.0, -6.0, 8.0]),
    model("u32_indices/01_vertex_count_32bit.gltf", [4.0, 3.0, 8.0], [0.0, 0.0, 0.0], 40.0, [5.0, 6.0, 6.0]),
];

impl Model {
    /// Whether the file exists.
    pub fn is_there(&self) -> bool {
        self.path().is_file()
    }

    fn path(&self) -> PathBuf {
        let shared = std::env::var_os("LIGHTMESH_SHARED")
            .map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared"), PathBuf::from);
        shared.join("scenes").join(self.file)
    }

    /// The up axis: z in CAD parts and scans, and in one file that specifies it.
    fn up(&self) -> Vec3 {
        const Z_UP: [&str; 5] = ["camera_light/", "cycloidal/", "featuretype/", "teapot/teapot.ply", "spider/spider_"];
        if Z_UP.iter().any(|beginning| self.file.starts_with(beginning)) { Vec3::Z } else { Vec3::Y }
    }

    /// Reads the model, with the file's own lights, or a white point light if it has none.
    pub fn open(&self) -> Scene {
        let mut scene = Scene::open(self.path()).unwrap_or_else(|error| panic!("{error}"));
        let direction = DVec3::from(self.target) - DVec3::from(self.eye);
        let camera = Camera::look_to(scene.to_local(DVec3::from(self.eye)), direction, self.up(), self.vfov);
        scene.cameras.insert(0, camera.unwrap_or_else(|error| panic!("{error}")).named("test"));
        if scene.lights.is_empty() {
            let position = scene.to_local(DVec3::from(self.light));
            scene.lights.push(Light::point(position));
        }
        scene
    }
}
