//! Shadows of lights with a size: occluder lists, against the ways to compute the same shadows without them.
//!
//! Every light of a scene becomes a ball. Rows of the experiment `shadows` have the keys scene, emitter (the balls' radius as a part of
//! their distance from the middle of the scene; `own` for the scene's own sizes), size, samples, method, accel, device and threads:
//!
//! * `lists`: light-mesh mode by occluder lists;
//! * `rows`: area mode, each surface point on its own, whose bits the lists must equal;
//! * `rays`: an ordinary shadow ray to each of the same samples;
//! * `adaptive`: one such ray, all of them where the answers of neighbouring pixels disagree.
//!
//! Times are those of all stages; `shadows` is the sum of those between primary rays and shading. Values: `differing_pixels`, pixels
//! times lights whose visibility is not that of `rows`, and `differing_samples`, the samples by which they differ, as a part of
//! all; all rows but those of `rows` have them. `visibility_rmse` is the error relative to a converged reference, and
//! `lists_by_adaptive`, of rows of `adaptive`, the time of the lists' shadows by that of adaptive ones.
//!
//! Rows of `whole frames` compare the program's defaults ([`frames`]), those of `many lights` numbers of lights ([`many_lights`]).

mod case;
mod frames;
mod many_lights;

use std::time::Duration;

use lightmesh::render::{PreparedScene, ShadowTests};
use lightmesh::scene::LightKind;
use lightmesh::{Acceleration, Lookup, Mode, Observer, Scene, Settings, image};

use self::case::{Case, Method, SAMPLES, shadow_seconds};
use super::quality::visibility_rmse;
use super::subjects::{self, Subject};
use super::turns::Turns;
use crate::engine;
use crate::measure::{Silent, Variant};
use crate::{BenchError, Findings, Plan};

/// Pixels along a side, and in the short version.
const SIDES: [u32; 2] = [2048, 512];
/// Radii of the lights as parts of their distances.
pub(super) const EMITTERS: [f32; 3] = [0.016, 0.042, 0.107];
/// Samples of the reference, and in the short version.
const CONVERGED: [u32; 2] = [1024, 256];
/// Different from seed 0, which all measurements use.
const SEED: u64 = 1;

const METHODS: [Method; 4] = [
    Method { name: "lists", choose: |settings| settings.with_mode(Mode::LightMesh).with_lookup(Lookup::Lists) },
    Method { name: "rows", choose: |settings| settings.with_mode(Mode::Area) },
    Method { name: "rays", choose: |settings| settings.with_mode(Mode::Area).with_shadow_tests(ShadowTests::Rays) },
    Method { name: "adaptive", choose: |settings| settings.with_mode(Mode::LightMesh).with_lookup(Lookup::Adaptive) },
];

pub(super) fn run(plan: &Plan, observer: &dyn Observer, findings: &mut Findings) -> Result<(), BenchError> {
    let engines = engine::engines(plan)?;
    findings.devices = engines.iter().map(|engine| engine.device.clone()).collect();
    let side = plan.side_or(SIDES);
    subjects::each(plan, observer, |subject, share| {
        let emitters: Vec<Option<f32>> = std::iter::once(None).chain(EMITTERS.map(Some)).collect();
        // Whole frames are measured like one more number of samples.
        let cases = emitters.len() * (SAMPLES.len() + 1) + many_lights::parts(&subject.name);
        let parts = (cases * engines.len()) as u32;
        let own = PreparedScene::new(&with_emitters(subject, None), &Acceleration::Auto, &Silent(observer))?;
        for engine in &engines {
            for &emitter in &emitters {
                let scene = own.with_lights(with_emitters(subject, emitter).lights);
                let settings = Settings::default().with_aa(1).with_size([side; 2]);
                let case = Case { subject, engine, scene: &scene, emitter, settings };
                let reference = case.converged(plan, observer)?;
                for samples in SAMPLES {
                    let case = Case { settings: case.settings.clone().with_samples(samples), ..case };
                    case.measure(plan, (share / parts, &reference), observer, findings)?;
                }
                frames::measure(&case, plan, (share / parts, &reference), observer, findings)?;
            }
            let scene = (subject.name.as_str(), &own);
            many_lights::measure(scene, engine, side, (plan, share / parts), observer, findings)?;
        }
        Ok(())
    })
}

/// The scene with balls as lights: of a radius that is a part of their distance from its middle, or their own.
pub(super) fn with_emitters(subject: &Subject, emitter: Option<f32>) -> Scene {
    let Some(part) = emitter else { return subject.with_balls() };
    let mut scene = subject.scene.clone();
    let middle = scene.geometry.mesh.bounds().center();
    for light in &mut scene.lights {
        if let Some(position) = light.position() {
            light.kind = LightKind::Sphere { position, radius: part * position.distance(middle) };
        }
    }
    scene
}

impl Case<'_> {
    fn measure(
        &self,
        plan: &Plan,
        (share, converged): (Duration, &image::Frame),
        observer: &dyn Observer,
        findings: &mut Findings,
    ) -> Result<(), BenchError> {
        let variants: Vec<Variant> = METHODS.iter().map(|method| self.variant(method, false)).collect();
        let turns = Turns::take(&variants, plan.repetitions, share, observer)?;
        let what =
            format!("{} with emitters {:?}, {:?} samples", self.subject.name, self.emitter, self.settings.samples);
        findings.notes.extend(turns.notes(&what, plan.repetitions));
        let (mut reference, mut of_lists) = (None, None);
        for (method, measured) in METHODS.iter().zip(&turns.measured) {
            let mut row = self.row(method);
            measured.fill(&mut row);
            let sums = shadow_seconds(&row, turns.repetitions);
            if method.name == "lists" {
                of_lists = sums.median();
            }
            let ratio = of_lists.zip(sums.median()).filter(|_| method.name == "adaptive").map(|(a, b)| a / b);
            row.values.extend(ratio.map(|ratio| ("lists_by_adaptive".to_owned(), ratio)));
            row.seconds.insert("shadows".to_owned(), sums);
            if method.name != "rows" {
                if reference.is_none() {
                    reference = Some(visibility(&self.layered(&METHODS[1], observer)?));
                }
                let own = self.layered(method, observer)?;
                let (pixels, samples) = differences(reference.as_deref().unwrap_or_default(), &visibility(&own));
                row.values.insert("differing_pixels".to_owned(), pixels);
                row.values.insert("differing_samples".to_owned(), samples);
                row.values.insert("visibility_rmse".to_owned(), visibility_rmse(converged, &own));
            }
            findings.add([row]);
        }
        Ok(())
    }

    /// With enough samples to count as converged.
    fn converged(&self, plan: &Plan, observer: &dyn Observer) -> Result<image::Frame, BenchError> {
        let settings = self.settings.clone().with_samples(CONVERGED[usize::from(plan.quick)]).with_seed(SEED);
        Case { settings, ..*self }.layered(&METHODS[0], observer)
    }
}

/// The visibility of each light at each pixel.
fn visibility(frame: &image::Frame) -> Vec<f32> {
    frame.layers().map(|layers| layers.visibility.concat()).unwrap_or_default()
}

/// How many values differ, and the mean difference.
fn differences(a: &[f32], b: &[f32]) -> (f64, f64) {
    let differing = a.iter().zip(b).filter(|(a, b)| a.to_bits() != b.to_bits()).count();
    let sum: f64 = a.iter().zip(b).map(|(a, b)| f64::from((a - b).abs())).sum();
    (differing as f64, sum / a.len().max(1) as f64)
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use lightmesh::Device;
    use lightmesh::render::Unobserved;

    use super::*;
    use crate::SHADOWS;
    use crate::WHOLE_FRAMES;

    fn found(plan: Plan) -> Findings {
        let scenes = vec![PathBuf::from("builtin:gazebo")];
        let plan = Plan { device: Device::Cpu, threads: Some(2), repetitions: 1, scenes, size: Some(48), ..plan };
        let mut findings = Findings::default();
        run(&plan, &Unobserved, &mut findings).unwrap();
        findings
    }

    #[test]
    fn lists_give_the_bits_of_the_reference_and_the_others_nearly() {
        let findings = found(Plan::new(true));
        let rows = |experiment| findings.rows.iter().filter(move |row| row.experiment == experiment);
        let cases = EMITTERS.len() + 1;
        assert_eq!(rows(SHADOWS).count(), cases * SAMPLES.len() * METHODS.len());
        for row in rows(SHADOWS) {
            assert!(row.seconds["shadows"].0.iter().all(|seconds| *seconds > 0.0), "{}", row.id);
            let differing = row.values.get("differing_samples").copied().unwrap_or(0.0);
            let is = |method: &str| row.keys["method"] == method.into();
            let allowed = if is("rays") { 1e-4 } else { 0.0 };
            assert!(differing <= if is("adaptive") { 0.02 } else { allowed }, "{}: {differing}", row.id);
            assert_eq!(row.values.contains_key("visibility_rmse"), !is("rows"), "{}", row.id);
            assert_eq!(row.values.contains_key("lists_by_adaptive"), is("adaptive"), "{}", row.id);
            let error = row.values.get("visibility_rmse").copied().unwrap_or(0.0);
            assert!(error < if row.keys["samples"] == 64.0.into() { 0.03 } else { 0.06 }, "{}: {error}", row.id);
        }
        let ids: std::collections::BTreeSet<&str> = findings.rows.iter().map(|row| row.id.as_str()).collect();
        assert_eq!(ids.len(), findings.rows.len(), "ids repeat");
        assert_eq!(rows(WHOLE_FRAMES).count(), 3 * cases);
    }

    #[test]
    fn without_time_the_lists_are_measured_and_what_is_missing_is_said() {
        let findings = found(Plan { budget: Duration::ZERO, ..Plan::new(true) });
        assert!(findings.rows.iter().all(|row| row.keys["method"] == "lists".into()));
        assert_eq!(findings.rows.len(), (EMITTERS.len() + 1) * (SAMPLES.len() + 1));
        assert_eq!(findings.notes.len(), 2 * findings.rows.len(), "{:#?}", findings.notes);
    }

    #[test]
    fn differences_count_values_and_average_them() {
        assert_eq!(differences(&[0.0, 1.0, 0.5, 0.5], &[0.0, 0.5, 0.5, 1.0]), (2.0, 0.25));
    }
}
