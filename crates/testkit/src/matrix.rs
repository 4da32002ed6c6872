//! The cases for which a guarantee must hold: devices, modes, accelerators, radii and weights.

use lightmesh_render::{Acceleration, Device, Frame, Lookup, Mode, Renderer, Settings, devices};
use lightmesh_scene::{Scene, Weight};

/// All modes.
pub const MODES: [Mode; 3] = [Mode::LightMesh, Mode::RayTrace, Mode::Area];

/// All techniques, by the mode and lookup that select them.
pub const TECHNIQUES: [(Mode, Lookup); 5] = [
    (Mode::LightMesh, Lookup::Lists),
    (Mode::LightMesh, Lookup::Adaptive),
    (Mode::LightMesh, Lookup::HalfBall),
    (Mode::Area, Lookup::Auto),
    (Mode::RayTrace, Lookup::Auto),
];

/// Accelerators without parameters; the grid chooses its own cells.
pub const ACCELERATIONS: [Acceleration; 3] = [Acceleration::Bvh, Acceleration::Grid(None), Acceleration::BruteForce];

/// Interpolation radii in steps, on both sides of integers and of the sizes at which a mask gets another word.
pub const RADII: [f32; 10] = [1.0, 1.5, 2.0, 2.1, 2.5, 3.0, 3.1, 3.2, 4.1, 5.1];

/// All weights.
pub const WEIGHTS: [Weight; 3] = [Weight::Constant, Weight::Quadratic, Weight::Smooth];

/// Runs a test with a renderer for each usable device.
pub fn each_device(test: impl Fn(&Renderer)) {
    let usable: Vec<String> =
        devices().into_iter().filter(|report| report.usable).map(|report| report.device).collect();
    assert!(usable.iter().any(|device| device == "cpu"), "the CPU can always be used: {usable:?}");
    for device in usable {
        let device: Device = device.parse().expect("devices are listed by their names");
        test(&Renderer::new(device).expect("a device listed as usable works"));
    }
}

/// Renders with layers on the CPU.
pub fn render(scene: &Scene, settings: &Settings) -> Frame {
    let renderer = Renderer::new(Device::Cpu).expect("the CPU can always be used");
    let settings = settings.clone().with_layers(true);
    renderer.render(scene, &settings).unwrap_or_else(|error| panic!("{}: {error}", scene.name))
}
