//! What is measured of shadows, and how.

use lightmesh::render::PreparedScene;
use lightmesh::{Observer, Settings, image};

use crate::engine::Engine;
use crate::measure::{Silent, Variant};
use crate::suites::subjects::Subject;
use crate::{BenchError, Key, Row, SHADOWS, Samples};

/// Numbers of samples.
pub(super) const SAMPLES: [u32; 2] = [16, 64];
/// The stages between primary rays and shading.
const STAGES: [&str; 5] = ["items", "occluder_lists", "area_shadows", "shadow_rays", "adaptive_shadows"];

/// A way to compute the shadows.
pub(super) struct Method {
    pub(super) name: &'static str,
    pub(super) choose: fn(Settings) -> Settings,
}

/// A scene with some lights and a number of samples.
pub(super) struct Case<'a> {
    pub(super) subject: &'a Subject,
    pub(super) engine: &'a Engine,
    pub(super) scene: &'a PreparedScene,
    pub(super) emitter: Option<f32>,
    pub(super) settings: Settings,
}

impl Case<'_> {
    pub(super) fn variant(&self, method: &Method, layers: bool) -> Variant<'_> {
        let settings = (method.choose)(self.settings.clone()).with_layers(layers);
        Variant { renderer: &self.engine.renderer, scene: self.scene, settings }
    }

    /// An image with layers, which timed ones do not have.
    pub(super) fn layered(&self, method: &Method, observer: &dyn Observer) -> Result<image::Frame, BenchError> {
        let Variant { renderer, scene, settings } = self.variant(method, true);
        Ok(renderer.render_prepared(scene, &settings, &Silent(observer))?.image)
    }

    pub(super) fn row(&self, method: &Method) -> Row {
        let samples = ("samples", f64::from(self.settings.samples.unwrap_or_default()).into());
        self.row_of(SHADOWS, method.name, [samples])
    }

    /// A row of an experiment with keys of its own.
    pub(super) fn row_of<const N: usize>(&self, experiment: &str, method: &str, own: [(&'static str, Key); N]) -> Row {
        let emitter = self.emitter.map_or_else(|| "own".into(), Key::from);
        let keys = [
            ("scene", self.subject.name.as_str().into()),
            ("emitter", emitter),
            ("size", f64::from(self.settings.size[0]).into()),
            ("method", method.into()),
            ("accel", self.scene.geometry.accelerator.name().into()),
        ];
        Row::new(experiment, keys.into_iter().chain(own).chain(self.engine.keys()))
    }
}

/// The seconds between primary rays and shading, by repetition.
pub(super) fn shadow_seconds(row: &Row, repetitions: usize) -> Samples {
    let mut sums = Samples::default();
    for round in 0..repetitions {
        sums.push(STAGES.iter().filter_map(|stage| row.seconds.get(*stage)).map(|samples| samples.0[round]).sum());
    }
    sums
}
