//! Rays per second of each acceleration structure in isolation: primary rays, hard-shadow rays and short segments.
//!
//! Rows of the experiment `rays` have the keys scene, size, `rays` (`primary`, `hard shadow`, `short`), `accel`, device and
//! threads; values are the number of `rays` and `million_per_second`, by the median. Times are those of the stage that casts
//! them, including ray generation. Short segments are traced one by one ([`ShortTests::Plain`]), as by a generic ray tracer; the
//! method's own short tests by cell cast no rays. Brute force is included for tiny scenes on the CPU, as a measure of the triangle test:
//! CUDA devices do not have it.

use lightmesh::render::{Counts, PreparedScene, ShortTests};
use lightmesh::{Acceleration, Lookup, Mode, Observer, Settings, Stage, Step};

use super::subjects::{self, Subject};
use super::turns::Turns;
use crate::engine::{self, Engine};
use crate::measure::{Measured, Silent, Variant};
use crate::{BenchError, Findings, Plan, Row, Samples};

/// Pixels along a side, and in the short version.
const SIDES: [u32; 2] = [1024, 512];
/// Maximum number of triangles for which brute force is measured,
const TINY: usize = 1000;
/// in an image with sides reduced by this factor: rates do not depend on it.
const SHORTER: u32 = 4;

/// A kind of rays.
struct Kind {
    name: &'static str,
    mode: Mode,
    stage: Stage,
    count: fn(&Counts) -> u64,
}

const KINDS: [Kind; 3] = [
    Kind { name: "primary", mode: Mode::RayTrace, stage: Stage::PrimaryRays, count: |counts| counts.rays },
    Kind { name: "hard shadow", mode: Mode::RayTrace, stage: Stage::ShadowRays, count: |counts| counts.shadow_rays },
    Kind { name: "short", mode: Mode::LightMesh, stage: Stage::ShortTests, count: |counts| counts.short_tests },
];

/// An image to render: settings, structure, device.
struct Case<'a> {
    mode: Mode,
    engine: &'a Engine,
    scene: &'a PreparedScene,
    side: u32,
}

pub(super) fn run(plan: &Plan, observer: &dyn Observer, findings: &mut Findings) -> Result<(), BenchError> {
    let engines = ray_engines(plan)?;
    findings.devices = engines.iter().map(|engine| engine.device.clone()).collect();
    subjects::each(plan, observer, |subject, share| {
        let silent = Silent(observer);
        let structures = structures(plan, subject);
        let prepared =
            structures.iter().map(|(acceleration, _)| PreparedScene::new(&subject.scene, acceleration, &silent));
        let prepared: Vec<PreparedScene> = prepared.collect::<Result<_, _>>()?;
        let cases = cases(&engines, &structures, &prepared);
        let variants: Vec<Variant> = cases.iter().map(|case| case.variant(subject)).collect();
        let turns = Turns::take(&variants, plan.repetitions, share, observer)?;
        let measured = cases.iter().zip(&turns.measured);
        findings.add(measured.flat_map(|(case, measured)| case.rows(subject, measured)));
        findings.notes.extend(turns.notes(&subject.name, plan.repetitions));
        Ok(())
    })
}

/// The devices of the plan, and a single CPU thread if there are several.
fn ray_engines(plan: &Plan) -> Result<Vec<Engine>, BenchError> {
    let mut engines = engine::engines(plan)?;
    if engines.iter().any(|engine| engine.thread_count.is_some_and(|threads| threads > 1)) {
        engines.push(Engine::cpu(Some(1))?);
    }
    Ok(engines)
}

/// Acceleration structures for a scene, with the sizes of their images.
fn structures(plan: &Plan, subject: &Subject) -> Vec<(Acceleration, u32)> {
    let side = plan.side_or(SIDES);
    let mut structures = vec![(Acceleration::Bvh, side), (Acceleration::Grid(None), side)];
    if subject.scene.geometry.mesh.triangles.len() <= TINY {
        structures.push((Acceleration::BruteForce, plan.side(side / SHORTER)));
    }
    structures
}

/// Structures first: if time runs out, one device has all of them.
fn cases<'a>(
    engines: &'a [Engine],
    structures: &[(Acceleration, u32)],
    prepared: &'a [PreparedScene],
) -> Vec<Case<'a>> {
    let mut cases = Vec::new();
    for engine in engines {
        let has =
            |acceleration: &Acceleration| *acceleration != Acceleration::BruteForce || engine.thread_count.is_some();
        for ((_, side), scene) in structures.iter().zip(prepared).filter(|((acceleration, _), _)| has(acceleration)) {
            cases.extend([Mode::RayTrace, Mode::LightMesh].map(|mode| Case { mode, engine, scene, side: *side }));
        }
    }
    cases
}

impl Case<'_> {
    fn variant(&self, subject: &Subject) -> Variant<'_> {
        let mut settings = Settings::default()
            .with_aa(1)
            .with_mode(self.mode)
            .with_size([self.side; 2])
            .with_lookup(Lookup::HalfBall)
            .with_short_tests(ShortTests::Plain)
            .with_acceleration(self.scene.geometry.acceleration().clone());
        settings.step = subject.step.map(Step::Fixed);
        Variant { renderer: &self.engine.renderer, scene: self.scene, settings }
    }

    /// A row for each kind of rays in the image.
    fn rows(&self, subject: &Subject, measured: &Measured) -> Vec<Row> {
        let kinds = KINDS.iter().filter(|kind| kind.mode == self.mode);
        kinds.filter_map(|kind| self.row(subject, kind, measured)).collect()
    }

    fn row(&self, subject: &Subject, kind: &Kind, measured: &Measured) -> Option<Row> {
        let (stage, counts) = (kind.stage.name(), &measured.frame.stats.counts);
        let (rays, seconds) = ((kind.count)(counts) as f64, measured.seconds.get(stage)?);
        let keys = [
            ("scene", subject.name.as_str().into()),
            ("size", f64::from(self.side).into()),
            ("rays", kind.name.into()),
            ("accel", self.scene.geometry.accelerator.name().into()),
        ];
        let mut row = Row::new("rays", keys.into_iter().chain(self.engine.keys()));
        row.values.insert("rays".to_owned(), rays);
        row.values.insert("million_per_second".to_owned(), rays / seconds.median()? / 1e6);
        row.seconds.insert(stage.to_owned(), Samples(seconds.0.clone()));
        Some(row)
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
        let mut findings = Findings::default();
        run(
            &Plan { device: Device::Cpu, threads: Some(2), shrink: 32, repetitions: 2, ..plan },
            &Unobserved,
            &mut findings,
        )
        .unwrap();
        findings
    }

    #[test]
    fn every_structure_casts_every_kind_of_rays() {
        let findings = found(Plan { scenes: vec![PathBuf::from("builtin:gazebo")], ..Plan::new(true) });
        let ids: BTreeSet<&str> = findings.rows.iter().map(|row| row.id.as_str()).collect();
        // Three structures, three kinds, two threads and one.
        assert_eq!((findings.rows.len(), ids.len()), (18, 18), "{ids:#?}");
        for row in &findings.rows {
            assert!(row.values["rays"] > 0.0 && row.values["million_per_second"] > 0.0, "{row:?}");
            assert_eq!(row.seconds.values().next().unwrap().0.len(), 2);
        }
        assert_eq!(findings.notes, Vec::<String>::new());
    }

    #[test]
    fn all_structures_cast_the_same_rays() {
        let findings = found(Plan { scenes: vec![PathBuf::from("builtin:childpark")], ..Plan::new(true) });
        assert_eq!(findings.rows.len(), 12);
        for kind in KINDS {
            let counts: BTreeSet<u64> = findings
                .rows
                .iter()
                .filter(|row| row.keys["rays"] == kind.name.into())
                .map(|row| row.values["rays"] as u64)
                .collect();
            assert_eq!(counts.len(), 1, "{}", kind.name);
        }
    }

    #[test]
    fn without_time_one_picture_is_made_of_each_scene() {
        let findings = found(Plan { budget: std::time::Duration::ZERO, ..Plan::new(true) });
        assert_eq!(findings.rows.len(), 6);
        assert_eq!(findings.notes.len(), 6, "{:#?}", findings.notes);
    }
}
