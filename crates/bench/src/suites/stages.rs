//! Seconds of each stage of full frames, for work on kernels and inner loops.
//!
//! Rows of the experiment `stages` have the keys scene, size, mode, accel, device and threads; those of the method also step,
//! radius, weight and `short_tests`, the kind of evaluation. Times are those of the stages, on a GPU from its own events, and of
//! `render`, the whole frame; values are the counts. Steps are the thesis', or a scene's own. Radii and weight are the thesis',
//! except in one row with the automatic step and the defaults.

use lightmesh::render::{PreparedScene, ShortTests};
use lightmesh::scene::Weight;
use lightmesh::{Acceleration, Mode, Observer, Settings, Step};

use super::subjects::{self, Subject};
use super::turns::Turns;
use crate::engine::{self, Engine};
use crate::measure::{Measured, Silent, Variant};
use crate::{BenchError, Findings, Key, Plan, Row, STAGES};

/// Pixels along a side, and in the short version.
const SIDES: [u32; 2] = [1024, 512];
/// The thesis' radii; everything else is measured with the larger one.
const RADII: [f32; 2] = [3.1, 2.1];

/// The settings of an image, with its keys.
struct Case {
    keys: Vec<(&'static str, Key)>,
    settings: Settings,
}

/// A case with structure and device.
struct Trial<'a> {
    case: &'a Case,
    engine: &'a Engine,
    scene: &'a PreparedScene,
}

pub(super) fn run(plan: &Plan, observer: &dyn Observer, findings: &mut Findings) -> Result<(), BenchError> {
    let engines = engine::engines(plan)?;
    findings.devices = engines.iter().map(|engine| engine.device.clone()).collect();
    subjects::each(plan, observer, |subject, share| {
        let structures = [Acceleration::Bvh, Acceleration::Grid(None)];
        let silent = Silent(observer);
        let prepared = structures.iter().map(|structure| PreparedScene::new(&subject.scene, structure, &silent));
        let prepared: Vec<PreparedScene> = prepared.collect::<Result<_, _>>()?;
        let cases = cases(subject, plan.side_or(SIDES));
        let trials: Vec<Trial> = engines
            .iter()
            .flat_map(|engine| prepared.iter().map(move |scene| (engine, scene)))
            .flat_map(|(engine, scene)| cases.iter().map(move |case| Trial { case, engine, scene }))
            .collect();
        let variants: Vec<Variant> = trials.iter().map(Trial::variant).collect();
        let turns = Turns::take(&variants, plan.repetitions, share, observer)?;
        findings.add(trials.iter().zip(&turns.measured).map(|(trial, measured)| trial.row(subject, measured)));
        findings.notes.extend(turns.notes(&subject.name, plan.repetitions));
        Ok(())
    })
}

/// The method, then variants that differ in one setting, then hard shadows.
fn cases(subject: &Subject, side: u32) -> Vec<Case> {
    let case = |mode: Mode, settings: Settings, keys: Vec<(&'static str, Key)>| {
        let common = [("size", f64::from(side).into()), ("mode", mode.name().into())];
        Case { keys: common.into_iter().chain(keys).collect(), settings: settings.with_mode(mode).with_size([side; 2]) }
    };
    let mesh = |step: Option<f32>, radius: f32, weight: Weight, (way, short_tests): (&str, ShortTests)| {
        let keys = vec![
            ("step", step.map_or_else(|| "auto".into(), Key::from)),
            ("radius", radius.into()),
            ("weight", weight.name().into()),
            ("short_tests", way.into()),
        ];
        let settings = Settings::default().with_step(step.map_or(Step::Auto, Step::Fixed));
        let settings = settings.with_radius(radius).with_weight(weight).with_short_tests(short_tests);
        case(Mode::LightMesh, settings, keys)
    };
    let (cells, plain) = (("cells", ShortTests::Cells), ("plain", ShortTests::Plain));
    vec![
        mesh(subject.step, RADII[0], Weight::Constant, cells),
        mesh(subject.step, RADII[1], Weight::Constant, cells),
        mesh(subject.step, RADII[0], Weight::Constant, plain),
        mesh(None, Settings::DEFAULT_RADIUS, Weight::Smooth, cells),
        case(Mode::RayTrace, Settings::default(), Vec::new()),
    ]
}

impl Trial<'_> {
    fn variant(&self) -> Variant<'_> {
        Variant {
            renderer: &self.engine.renderer,
            scene: self.scene,
            settings: self.case.settings.clone().with_acceleration(self.scene.geometry.acceleration().clone()),
        }
    }

    fn row(&self, subject: &Subject, measured: &Measured) -> Row {
        let own = [("scene", subject.name.as_str().into()), ("accel", self.scene.geometry.accelerator.name().into())];
        let mut row = Row::new(STAGES, own.into_iter().chain(self.case.keys.clone()).chain(self.engine.keys()));
        measured.fill(&mut row);
        row
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::path::PathBuf;

    use lightmesh::Device;
    use lightmesh::render::Unobserved;

    use super::*;

    fn found(plan: Plan) -> Findings {
        let plan = Plan { device: Device::Cpu, threads: Some(2), repetitions: 2, ..plan };
        let mut findings = Findings::default();
        run(&plan, &Unobserved, &mut findings).unwrap();
        findings
    }

    #[test]
    fn each_structure_has_each_way_with_all_its_stages() {
        let scenes = vec![PathBuf::from("builtin:gazebo")];
        let findings = found(Plan { scenes, size: Some(24), ..Plan::new(true) });
        let ids: BTreeSet<&str> = findings.rows.iter().map(|row| row.id.as_str()).collect();
        assert_eq!((findings.rows.len(), ids.len()), (10, 10), "{ids:#?}");
        assert_eq!(findings.notes, Vec::<String>::new());
        let method: Vec<&Row> = findings.rows.iter().filter(|row| row.keys["mode"] == "light-mesh".into()).collect();
        for row in &method {
            for stage in ["primary_rays", "short_tests", "collect", "long_tests", "shade", "render"] {
                assert_eq!(row.seconds[stage].0.len(), 2, "{stage} of {}", row.id);
            }
            assert_eq!(row.values["pixels"], 24.0 * 24.0);
        }
        // The same light points with either structure and either kind of short tests.
        let thesis = method.iter().filter(|row| row.keys["radius"] == RADII[0].into());
        let points: Vec<f64> = thesis.map(|row| row.values["light_points"]).collect();
        assert_eq!((points.len(), points.iter().all(|count| *count == points[0])), (4, true), "{points:?}");
    }

    #[test]
    fn without_time_one_picture_is_made_of_each_scene() {
        let findings = found(Plan { budget: std::time::Duration::ZERO, shrink: 32, ..Plan::new(true) });
        assert_eq!((findings.rows.len(), findings.notes.len()), (3, 6), "{:#?}", findings.notes);
    }
}
