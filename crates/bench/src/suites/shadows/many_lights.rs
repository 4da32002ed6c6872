//! Many lights: what occluder lists cost with up to 256 balls around a scene, in time and memory.
//!
//! Rows have the keys scene, lights, size, samples, method, accel, device and threads. Times are those of all stages;
//! `shadows` is the sum of those between primary rays and shading. Values besides counts: `per_light_by_one`, the
//! shadows' time per light by that of a single light with as many samples, and `peak_bytes_per_pixel`, the peak memory
//! of the device, or of the whole process, by pixel.

use std::time::Duration;

use lightmesh::render::PreparedScene;
use lightmesh::{Lookup, Mode, Observer, Scene, Settings};

use super::case::{SAMPLES, shadow_seconds};
use crate::engine::Engine;
use crate::measure::Variant;
use crate::suites::turns::Turns;
use crate::{BenchError, Findings, MANY_LIGHTS, Plan, Row};

/// The scene that is measured if it is among those of the plan.
const SCENE: &str = "childpark";
/// The radius of each light in it.
const RADIUS: f32 = 0.6;
/// Numbers of lights; the last only with the fewest samples.
const LIGHTS: [usize; 5] = [1, 4, 16, 64, 256];

/// The part of a scene's time, as cases of `shadows`.
pub(super) fn parts(scene: &str) -> usize {
    if scene == SCENE { SAMPLES.len() } else { 0 }
}

/// Measures a scene, which was prepared with other lights, if it is the one.
pub(super) fn measure(
    (name, scene): (&str, &PreparedScene),
    engine: &Engine,
    side: u32,
    (plan, share): (&Plan, Duration),
    observer: &dyn Observer,
    findings: &mut Findings,
) -> Result<(), BenchError> {
    if name != SCENE {
        return Ok(());
    }
    for samples in SAMPLES {
        let numbers = &LIGHTS[..if samples == SAMPLES[0] { LIGHTS.len() } else { LIGHTS.len() - 1 }];
        let scenes = numbers.iter().map(|&lights| {
            let lit = Scene::open(format!("builtin:{SCENE}?lights={lights}&spread={RADIUS}"))?;
            Ok(scene.with_lights(lit.lights))
        });
        let scenes = scenes.collect::<Result<Vec<PreparedScene>, BenchError>>()?;
        let settings = Settings::default().with_aa(1).with_mode(Mode::LightMesh).with_lookup(Lookup::Lists);
        let settings = settings.with_size([side; 2]).with_samples(samples);
        let variant = |scene| Variant { renderer: &engine.renderer, scene, settings: settings.clone() };
        let variants: Vec<Variant> = scenes.iter().map(variant).collect();
        let turns = Turns::take(&variants, plan.repetitions, share, observer)?;
        findings.notes.extend(turns.notes(&format!("many lights with {samples} samples"), plan.repetitions));
        let mut of_one = None;
        for (&lights, measured) in numbers.iter().zip(&turns.measured) {
            let keys = [
                ("scene", name.into()),
                ("lights", (lights as f64).into()),
                ("size", f64::from(side).into()),
                ("samples", f64::from(samples).into()),
                ("method", "lists".into()),
                ("accel", scene.geometry.accelerator.name().into()),
            ];
            let mut row = Row::new(MANY_LIGHTS, keys.into_iter().chain(engine.keys()));
            measured.fill(&mut row);
            let shadows = shadow_seconds(&row, turns.repetitions);
            let per_light = shadows.median().map(|seconds| seconds / lights as f64);
            let one = *of_one.get_or_insert(per_light);
            row.values.extend(per_light.zip(one).map(|(own, one)| ("per_light_by_one".to_owned(), own / one)));
            let peak = ["device_peak_bytes", "host_peak_bytes"].iter().find_map(|name| row.values.get(*name)).copied();
            let pixels = f64::from(side) * f64::from(side);
            row.values.extend(peak.map(|bytes| ("peak_bytes_per_pixel".to_owned(), bytes / pixels)));
            row.seconds.insert("shadows".to_owned(), shadows);
            findings.add([row]);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use lightmesh::render::Unobserved;
    use lightmesh::{Acceleration, Device};

    use super::*;
    use crate::engine;

    fn found(name: &str, share: Duration) -> Findings {
        let plan = Plan { device: Device::Cpu, threads: Some(2), repetitions: 1, ..Plan::new(true) };
        let scene = Scene::open(format!("builtin:{name}")).unwrap();
        let scene = PreparedScene::new(&scene, &Acceleration::Auto, &Unobserved).unwrap();
        let mut findings = Findings::default();
        for engine in engine::engines(&plan).unwrap() {
            measure((name, &scene), &engine, 6, (&plan, share), &Unobserved, &mut findings).unwrap();
        }
        findings
    }

    #[test]
    fn every_number_of_lights_has_a_row() {
        let findings = found(SCENE, Duration::from_secs(600));
        let case = |row: &Row| (row.keys["samples"].clone(), row.keys["lights"].clone());
        let wanted = SAMPLES.iter().flat_map(|&samples| {
            LIGHTS.iter().filter(move |&&lights| samples == 16 || lights < 256).map(move |&lights| (samples, lights))
        });
        let wanted: Vec<_> = wanted.map(|(n, lights)| (f64::from(n).into(), (lights as f64).into())).collect();
        assert_eq!(findings.rows.iter().map(case).collect::<Vec<_>>(), wanted);
        for row in &findings.rows {
            assert!(row.seconds["shadows"].0.iter().all(|seconds| *seconds > 0.0), "{}", row.id);
            assert!(row.values["per_light_by_one"] > 0.0, "{}", row.id);
            if row.keys["lights"] == 1.0.into() {
                assert_eq!(row.values["per_light_by_one"], 1.0, "{}", row.id);
            }
        }
    }

    #[test]
    fn time_and_scene_limit_what_is_measured() {
        let short = found(SCENE, Duration::ZERO);
        assert!(short.rows.iter().all(|row| row.keys["lights"] == 1.0.into()));
        assert_eq!((short.rows.len(), short.notes.len()), (SAMPLES.len(), 2 * SAMPLES.len()));
        assert!(found("gazebo", Duration::from_secs(600)).rows.is_empty());
    }
}
