//! What a promise must hold for: devices, modes, accelerators, radii and weights.

use lightmesh_render::{Acceleration, Device, Frame, Mode, Renderer, Settings, devices};
use lightmesh_scene::{Scene, Weight};

/// All modes.
pub const MODES: [Mode; 3] = [Mode::LightMesh, Mode::RayTrace, Mode::Area];

/// Accelerators that are built on the spot; the grid chooses its cells itself.
pub const ACCELERATIONS: [Acceleration; 3] = [Acceleration::Bvh, Acceleration::Grid(None), Acceleration::BruteForce];

/// Interpolation radii in steps, on both sides of whole numbers and of the sizes where a mask gets another word.
pub const RADII: [f32; 10] = [1.0, 1.5, 2.0, 2.1, 2.5, 3.0, 3.1, 3.2, 4.1, 5.1];

/// All weights.
pub const WEIGHTS: [Weight; 3] = [Weight::Constant, Weight::Quadratic, Weight::Smooth];

/// Runs a test on a renderer for each device that can be used here.
pub fn each_device(test: impl Fn(&Renderer)) {
    let usable: Vec<String> =
        devices().into_iter().filter(|report| report.usable).map(|report| report.device).collect();
    assert!(usable.iter().any(|device| device == "cpu"), "the host's processor can always be used: {usable:?}");
    for device in usable {
        let device: Device = device.parse().expect("devices are listed by the names that they are asked for by");
        test(&Renderer::new(device).expect("a device that is listed as usable works"));
    }
}

/// Renders with layers on the host's processor.
pub fn render(scene: &Scene, settings: &Settings) -> Frame {
    let renderer = Renderer::new(Device::Cpu).expect("the host's processor can always be used");
    let settings = Settings { layers: true, ..settings.clone() };
    renderer.render(scene, &settings).unwrap_or_else(|error| panic!("{}: {error}", scene.name))
}
