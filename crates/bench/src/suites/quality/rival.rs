//! The light mesh compared with shadow rays: at equal error, and in equal time.

use lightmesh::Mode;

use super::cases::Case;
use super::curve::{Cost, Point, Reach, cost_at, samples_in};
use super::errors::Errors;
use super::study::{Outcome, Study};
use crate::engine::Engine;
use crate::measure::Silent;
use crate::{BenchError, Findings, Picture, Row};

/// An error as a single number.
type Measure = fn(&Errors) -> f64;

/// The measures of equal error.
const MEASURES: [(&str, Measure); 2] =
    [("visibility_rmse", |errors| errors.visibility_rmse), ("mean_flip", |errors| errors.mean_flip)];

/// Adds rows, and on request images, for the measurements on a device.
pub(super) fn compare(
    study: &Study,
    engine: &Engine,
    outcomes: &[Outcome],
    pictures: bool,
    findings: &mut Findings,
) -> Result<(), BenchError> {
    let of = |mode| outcomes.iter().filter(move |outcome: &&Outcome| outcome.case.settings.mode == mode);
    let meshes: Vec<&Outcome> = of(Mode::LightMesh).collect();
    let Some(usual) = meshes.first() else { return Ok(()) };
    let mut never = 0;
    for (measure, error) in MEASURES {
        let curve: Vec<Point> = of(Mode::Area).map(|outcome| outcome.point(error)).collect();
        for mesh in &meshes {
            let reach = cost_at(&curve, error(&mesh.errors));
            never += usize::from(reach == Reach::Never);
            findings.add([equal_error(study, engine, mesh, measure, error(&mesh.errors), reach)]);
        }
    }
    if never > 0 {
        let all = MEASURES.len() * meshes.len();
        let (scene, kind) = (&study.subject.name, engine.kind);
        findings.notes.push(format!(
            "{scene} on {kind}: for {never} of {all} errors of the light mesh, no measured number of shadow rays reaches an equally small error."
        ));
    }
    let curve: Vec<Point> = of(Mode::Area).map(|outcome| outcome.point(MEASURES[0].1)).collect();
    equal_time(study, engine, usual, &curve, pictures, findings)
}

impl Outcome {
    fn point(&self, error: Measure) -> Point {
        let samples = f64::from(self.measured.frame.stats.settings.samples);
        let rays = self.measured.frame.stats.counts.shadow_rays as f64;
        Point { error: error(&self.errors), cost: Cost { samples, rays, seconds: self.measured.median() } }
    }
}

/// The cost of the light mesh and of shadow rays with the same error. `upper_bound` is 1 if a single ray already has a smaller
/// error, `not_reached` is 1 if no measured number of rays has an error this small; their cost is then missing.
fn equal_error(study: &Study, engine: &Engine, mesh: &Outcome, measure: &'static str, error: f64, reach: Reach) -> Row {
    let keys = mesh.case.keys.iter().cloned().chain([("measure", measure.into())]).collect();
    study.row("equal error", engine, keys, |row| {
        let (counts, seconds) = (&mesh.measured.frame.stats.counts, mesh.measured.median());
        let mut add = |name: &str, value: f64| row.values.insert(name.to_owned(), value);
        add("error", error);
        add("seconds", seconds);
        add("rays", (counts.long_tests + counts.shadow_rays) as f64);
        add("short_tests", counts.short_tests as f64);
        let cost = match reach {
            Reach::At(cost) => cost,
            Reach::AtMost(cost) => {
                add("upper_bound", 1.0);
                cost
            }
            Reach::Never => {
                add("not_reached", 1.0);
                return;
            }
        };
        add("area_samples", cost.samples);
        add("area_rays", cost.rays);
        add("area_seconds", cost.seconds);
        add("faster_than_area", cost.seconds / seconds);
    })
}

/// Shadow rays in the time of the usual light mesh.
fn equal_time(
    study: &Study,
    engine: &Engine,
    usual: &Outcome,
    curve: &[Point],
    pictures: bool,
    findings: &mut Findings,
) -> Result<(), BenchError> {
    let seconds = usual.measured.median();
    let case = Case::shadow_rays(Mode::Area, samples_in(curve, seconds), study.side);
    let layered = case.settings.clone().with_layers(true);
    let rival = engine.renderer.render_prepared(study.scene(case.emitter), &layered, &Silent(study.observer))?;
    let errors = Errors::between(&study.reference.frame, &rival.image)?;
    findings.add([study.row("equal time", engine, Vec::new(), |row| {
        let figures = [
            ("seconds", seconds),
            ("samples", f64::from(rival.stats.settings.samples)),
            ("visibility_rmse", usual.errors.visibility_rmse),
            ("area_visibility_rmse", errors.visibility_rmse),
            ("mean_flip", usual.errors.mean_flip),
            ("area_mean_flip", errors.mean_flip),
        ];
        row.values.extend(figures.map(|(name, figure)| (name.to_owned(), figure)));
    })]);
    if pictures {
        let picture = |what: &str, frame| Picture::new("equal time", &format!("{}, {what}", study.subject.name), frame);
        let reference = picture("reference", &study.reference.frame)?;
        let ours = picture("light mesh", &usual.measured.frame.image)?.against(&reference);
        let theirs = picture("shadow rays in the same time", &rival.image)?.against(&reference);
        findings.pictures.extend([reference, ours, theirs]);
    }
    Ok(())
}
