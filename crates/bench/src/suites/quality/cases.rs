//! The cases that are compared with the reference.

use lightmesh::render::ShadowTests;
use lightmesh::scene::Weight;
use lightmesh::{Lookup, Mode, Settings, Step};

use crate::Key;

/// Numbers of shadow rays per pixel and light.
pub(super) const AREA_SAMPLES: [u32; 4] = [1, 4, 16, 64];
/// Other lookups of light-mesh mode, with the numbers of samples of a light at each surface point.
const LOOKUPS: [(Lookup, &[u32]); 2] = [(Lookup::Lists, &[4, 16, 64]), (Lookup::Adaptive, &[16, 64])];
/// The thesis' larger radius.
const THESIS_RADIUS: f32 = 3.1;

/// The emitters seen by light points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Emitter {
    /// Area lights.
    Ball,
    /// Their centres.
    Point,
}

/// One way to compute shadows.
pub(super) struct Case {
    /// Its keys.
    pub(super) keys: Vec<(&'static str, Key)>,
    /// The render settings.
    pub(super) settings: Settings,
    /// The lights.
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

/// Shadow rays first, hard ones and n per light; then the light mesh with step `h`, which is used for images; then occluder lists and
/// adaptive shadow rays; then light meshes that differ from the first in one setting; then the thesis' own. With `automatic` also the
/// automatic step.
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
    let mut meshes = meshes.iter().map(|mesh| mesh.case(side));
    cases.extend(meshes.next());
    cases.extend(LOOKUPS.iter().flat_map(|(lookup, samples)| samples.iter().map(|&n| Case::lookup(*lookup, n, side))));
    cases.extend(meshes);
    cases
}

impl Case {
    /// Number of shadow rays to each light.
    pub(super) fn shadow_rays(mode: Mode, samples: u32, side: u32) -> Case {
        let settings = Settings::default()
            .with_aa(1)
            .with_mode(mode)
            .with_shadow_tests(ShadowTests::Rays)
            .with_size([side; 2])
            .with_samples(samples);
        let keys = vec![("mode", mode.name().into()), ("samples", f64::from(samples).into())];
        Case { keys, settings, emitter: Emitter::Ball }
    }

    /// Light-mesh mode with a lookup other than the half-ball.
    fn lookup(lookup: Lookup, samples: u32, side: u32) -> Case {
        let settings = Settings::default().with_aa(1).with_lookup(lookup).with_size([side; 2]).with_samples(samples);
        let keys = [("mode", settings.mode.name()), ("lookup", lookup.name()), ("emitter", "ball")];
        let keys = keys.map(|(name, word)| (name, word.into())).into_iter();
        Case { keys: keys.chain([("samples", f64::from(samples).into())]).collect(), settings, emitter: Emitter::Ball }
    }
}

impl Mesh {
    fn case(&self, side: u32) -> Case {
        let step = match self.step {
            Step::Auto => "auto".into(),
            Step::Fixed(step) => step.into(),
        };
        let mut keys = vec![
            ("mode", Mode::LightMesh.name().into()),
            ("step", step),
            ("radius", self.radius.into()),
            ("weight", self.weight.name().into()),
        ];
        match self.emitter {
            Emitter::Ball => keys.extend([("emitter", "ball".into()), ("samples", f64::from(self.samples).into())]),
            Emitter::Point => keys.push(("emitter", "point".into())),
        }
        let settings = Settings::default()
            .with_aa(1)
            .with_size([side; 2])
            .with_step(self.step)
            .with_radius(self.radius)
            .with_weight(self.weight)
            .with_lookup(Lookup::HalfBall)
            .with_samples(self.samples);
        Case { keys, settings, emitter: self.emitter }
    }
}
