//! What is held against the reference.

use lightmesh::scene::Weight;
use lightmesh::{Lookup, Mode, Settings, Step};

use crate::Key;

/// Numbers of shadow rays a pixel and light.
pub(super) const AREA_SAMPLES: [u32; 4] = [1, 4, 16, 64];
/// The thesis' larger radius.
const THESIS_RADIUS: f32 = 3.1;

/// What light points look at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Emitter {
    /// Lights with a size.
    Ball,
    /// Their middles.
    Point,
}

/// One way to find shadows.
pub(super) struct Case {
    /// What tells it from the others.
    pub(super) keys: Vec<(&'static str, Key)>,
    /// How it is rendered.
    pub(super) settings: Settings,
    /// Which lights there are.
    pub(super) emitter: Emitter,
}

/// Settings of a light mesh.
#[derive(Clone, Copy)]
struct Mesh {
    step: Step,
    radius: f32,
    weight: Weight,
    emitter: Emitter,
    samples: u32,
}

/// Shadow rays first, hard ones and n a light; then the light mesh with step `h`, which is the one for pictures; then others that differ
/// from it in one setting; then the thesis' own. With `automatic` also the step that is chosen for the picture.
pub(super) fn cases(h: f32, side: u32, automatic: bool) -> Vec<Case> {
    let usual = Mesh {
        step: Step::Fixed(h),
        radius: Settings::DEFAULT_RADIUS,
        weight: Weight::Smooth,
        emitter: Emitter::Ball,
        samples: 4,
    };
    let mut meshes = vec![usual];
    meshes.extend([1, 16].map(|samples| Mesh { samples, ..usual }));
    meshes.push(Mesh { emitter: Emitter::Point, ..usual });
    meshes.extend([0.5, 0.25, 2.0].map(|factor| Mesh { step: Step::Fixed(factor * h), ..usual }));
    meshes.extend(automatic.then_some(Mesh { step: Step::Auto, ..usual }));
    meshes.extend([1.5, THESIS_RADIUS, 4.1].map(|radius| Mesh { radius, ..usual }));
    meshes.extend([Weight::Quadratic, Weight::Constant].map(|weight| Mesh { weight, ..usual }));
    meshes.push(Mesh { radius: THESIS_RADIUS, weight: Weight::Constant, emitter: Emitter::Point, ..usual });

    let mut cases = vec![Case::shadow_rays(Mode::RayTrace, 1, side)];
    cases.extend(AREA_SAMPLES.map(|samples| Case::shadow_rays(Mode::Area, samples, side)));
    cases.extend(meshes.iter().map(|mesh| mesh.case(side)));
    cases
}

impl Case {
    /// Shadow rays to each light.
    pub(super) fn shadow_rays(mode: Mode, samples: u32, side: u32) -> Case {
        let settings = Settings { mode, size: [side; 2], samples: Some(samples), ..Settings::default() };
        let keys = vec![("mode", mode.name().into()), ("samples", f64::from(samples).into())];
        Case { keys, settings, emitter: Emitter::Ball }
    }
}

impl Mesh {
    fn case(&self, side: u32) -> Case {
        let step = match self.step {
            Step::Auto => "auto".into(),
            Step::Fixed(step) => number(step),
        };
        let mut keys = vec![
            ("mode", Mode::LightMesh.name().into()),
            ("step", step),
            ("radius", number(self.radius)),
            ("weight", self.weight.name().into()),
        ];
        match self.emitter {
            Emitter::Ball => keys.extend([("emitter", "ball".into()), ("samples", f64::from(self.samples).into())]),
            Emitter::Point => keys.push(("emitter", "point".into())),
        }
        let settings = Settings {
            size: [side; 2],
            step: Some(self.step),
            radius: Some(self.radius),
            weight: Some(self.weight),
            lookup: Lookup::HalfBall,
            samples: Some(self.samples),
            ..Settings::default()
        };
        Case { keys, settings, emitter: self.emitter }
    }
}

/// With as few digits as tell it from other `f32`: 2.1, not 2.0999999.
fn number(value: f32) -> Key {
    Key::Number(value.to_string().parse().unwrap_or(f64::from(value)))
}
