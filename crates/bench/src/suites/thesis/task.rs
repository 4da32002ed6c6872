//! What is measured, before it is: rows without results.

use lightmesh::scene::Weight;
use lightmesh::{Lookup, Mode, Settings, Step};

use crate::engine::Engine;
use crate::{Key, Row};

/// Pictures of one scene on one device, measured in turn.
pub(super) struct Task {
    /// The scene, as in `builtin:garden?lights=3`.
    pub(super) scene: String,
    /// Index of the device.
    pub(super) engine: usize,
    /// Repetitions that are wanted.
    pub(super) repetitions: usize,
    /// The pictures, the most wanted first.
    pub(super) cases: Vec<Case>,
}

/// One of the pictures.
pub(super) struct Case {
    /// Its row, with keys alone.
    pub(super) row: Row,
    /// How it is made.
    pub(super) settings: Settings,
    /// Its title where it is kept.
    pub(super) title: Option<String>,
}

impl Task {
    /// Pixels of a side; they are the same in all cases.
    pub(super) fn side(&self) -> u32 {
        self.cases.first().map_or(1, |case| case.settings.size[0])
    }
}

/// The scene with a number of lights.
pub(super) fn scene_with_lights(name: &str, lights: u32) -> String {
    format!("builtin:{name}?lights={lights}")
}

/// A picture with `side` pixels a side, as the thesis makes them: w = 1.
fn settings(side: u32, mode: Mode) -> Settings {
    Settings {
        size: [side, side],
        mode,
        weight: Some(Weight::Constant),
        lookup: Lookup::HalfBall,
        ..Settings::default()
    }
}

/// What tells pictures of a scene apart.
pub(super) struct Picture<'a> {
    /// The table or figure.
    pub(super) experiment: &'static str,
    /// The built-in scene.
    pub(super) scene: &'static str,
    /// Its lights.
    pub(super) lights: u32,
    /// Pixels of a side.
    pub(super) side: u32,
    /// The device.
    pub(super) engine: &'a Engine,
}

impl Picture<'_> {
    /// By the method, with step h in scene units and radius R in steps.
    pub(super) fn light_mesh(&self, step: f64, radius: f64) -> Case {
        let method = Settings {
            step: Some(Step::Fixed(step as f32)),
            radius: Some(radius as f32),
            ..settings(self.side, Mode::LightMesh)
        };
        self.case(method, [("step", step.into()), ("radius", radius.into())])
    }

    /// With hard shadows.
    pub(super) fn ray_trace(&self) -> Case {
        self.case(settings(self.side, Mode::RayTrace), [])
    }

    /// With area shadows of `samples` shadow rays a light.
    pub(super) fn area(&self, samples: u32) -> Case {
        let area = Settings { samples: Some(samples), ..settings(self.side, Mode::Area) };
        self.case(area, [("samples", f64::from(samples).into())])
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
