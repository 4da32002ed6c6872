//! Measurements to be made: rows without results.

use lightmesh::scene::Weight;
use lightmesh::{Lookup, Mode, Settings, Step};

use crate::engine::Engine;
use crate::{Key, Row};

/// Images of one scene on one device, measured alternately.
pub(super) struct Task {
    /// The scene, as in `builtin:garden?lights=3`.
    pub(super) scene: String,
    /// Index of the device.
    pub(super) engine: usize,
    /// Requested repetitions.
    pub(super) repetitions: usize,
    /// The images, most important first.
    pub(super) cases: Vec<Case>,
}

/// One of the images.
pub(super) struct Case {
    /// Its row, with keys only.
    pub(super) row: Row,
    /// The render settings.
    pub(super) settings: Settings,
    /// Its title, if it is kept.
    pub(super) title: Option<String>,
}

impl Task {
    /// Pixels along a side, the same in all cases.
    pub(super) fn side(&self) -> u32 {
        self.cases.first().map_or(1, |case| case.settings.size[0])
    }
}

/// The scene with a number of lights.
pub(super) fn scene_with_lights(name: &str, lights: u32) -> String {
    format!("builtin:{name}?lights={lights}")
}

/// Settings of an image with `side` pixels per side, as in the thesis: w = 1, and one sample of each pixel. Lists and adaptive rays
/// would take several by default, which neither time nor error of the other modes could be compared with.
fn settings(side: u32, mode: Mode) -> Settings {
    Settings::default()
        .with_size([side, side])
        .with_mode(mode)
        .with_aa(1)
        .with_weight(Weight::Constant)
        .with_lookup(Lookup::HalfBall)
}

/// The parameters of a measurement.
pub(super) struct Picture<'a> {
    /// The table or figure.
    pub(super) experiment: &'static str,
    /// The built-in scene.
    pub(super) scene: &'static str,
    /// Number of lights.
    pub(super) lights: u32,
    /// Pixels along a side.
    pub(super) side: u32,
    /// The device.
    pub(super) engine: &'a Engine,
}

impl Picture<'_> {
    /// With the method, step h in scene units and radius R in steps.
    pub(super) fn light_mesh(&self, step: f64, radius: f64) -> Case {
        let method =
            settings(self.side, Mode::LightMesh).with_step(Step::Fixed(step as f32)).with_radius(radius as f32);
        self.case(method, [("step", step.into()), ("radius", radius.into())])
    }

    /// With hard shadows.
    pub(super) fn ray_trace(&self) -> Case {
        self.case(settings(self.side, Mode::RayTrace), [])
    }

    /// With area shadows of `samples` shadow rays per light.
    pub(super) fn area(&self, samples: u32) -> Case {
        let area = settings(self.side, Mode::Area).with_samples(samples);
        self.case(area, [("samples", f64::from(samples).into())])
    }

    /// With another lookup of light-mesh mode and `samples` samples of each light.
    pub(super) fn lookup(&self, lookup: Lookup, samples: u32) -> Case {
        let settings = settings(self.side, Mode::LightMesh).with_lookup(lookup).with_samples(samples);
        self.case(settings, [("lookup", lookup.name().into()), ("samples", f64::from(samples).into())])
    }

    fn case<const N: usize>(&self, settings: Settings, own: [(&'static str, Key); N]) -> Case {
        let common = [
            ("scene", self.scene.into()),
            ("lights", f64::from(self.lights).into()),
            ("size", f64::from(self.side).into()),
            ("mode", settings.mode.name().into()),
        ];
        let keys = common.into_iter().chain(own).chain(self.engine.keys());
        Case { row: Row::new(self.experiment, keys), settings, title: None }
    }
}
