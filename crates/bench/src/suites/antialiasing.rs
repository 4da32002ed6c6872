//! What several samples of a pixel cost, and what they gain.
//!
//! The lights of a scene become balls, as in the suite `shadows`. Rows of the experiment `antialiasing` have the keys scene,
//! emitter, size, quality, `aa`, accel, device and threads; those of a quality alternate. Times are those of all stages and of the
//! whole frame. Values: `mean_flip` and `rmse` relative to a converged reference of many samples, each of which is shaded by
//! itself, and with several samples of a pixel `time_by_one` and `error_by_one`, the time and the mean FLIP by those of one sample
//! at the pixel's centre.

use std::time::Duration;

use lightmesh::render::{PreparedScene, Quality};
use lightmesh::{Acceleration, Observer, Settings, image};

use super::shadows::{EMITTERS, with_emitters};
use super::subjects;
use super::turns::Turns;
use crate::engine::{self, Engine};
use crate::measure::{Silent, Variant};
use crate::{ANTIALIASING, BenchError, Findings, Key, Plan, Row, WHOLE};

/// Pixels along a side, and in the short version.
const SIDES: [u32; 2] = [512, 256];
/// Samples of a pixel of the reference, and in the short version.
const CONVERGED: [u32; 2] = [1024, 128];
/// Samples of a light for each of them.
const LIGHT_SAMPLES: u32 = 8;
/// Different from seed 0, which all measurements use.
const SEED: u64 = 1;

pub(super) fn run(plan: &Plan, observer: &dyn Observer, findings: &mut Findings) -> Result<(), BenchError> {
    let engines = engine::engines(plan)?;
    findings.devices = engines.iter().map(|engine| engine.device.clone()).collect();
    let side = plan.side_or(SIDES);
    subjects::each(plan, observer, |subject, share| {
        let emitters: Vec<Option<f32>> = std::iter::once(None).chain(EMITTERS.map(Some)).collect();
        let share = share / (emitters.len() * engines.len() * Quality::ALL.len()) as u32;
        let own = PreparedScene::new(&with_emitters(subject, None), &Acceleration::Auto, &Silent(observer))?;
        for engine in &engines {
            for &emitter in &emitters {
                let scene = own.with_lights(with_emitters(subject, emitter).lights);
                let settings = Settings::default().with_size([side; 2]);
                let keys = [
                    ("scene", subject.name.as_str().into()),
                    ("emitter", emitter.map_or_else(|| "own".into(), Key::from)),
                    ("size", f64::from(side).into()),
                    ("accel", scene.geometry.accelerator.name().into()),
                ];
                let case = Case { engine, scene: &scene, settings, keys: &keys };
                let reference = case.converged(plan, observer)?;
                for &quality in [Quality::Good, Quality::Draft, Quality::Final].iter() {
                    case.measure(quality, plan, (share, &reference), observer, findings)?;
                }
            }
        }
        Ok(())
    })
}

/// A scene with some lights on a device.
struct Case<'a> {
    engine: &'a Engine,
    scene: &'a PreparedScene,
    settings: Settings,
    keys: &'a [(&'static str, Key)],
}

impl Case<'_> {
    /// With enough samples to count as converged.
    fn converged(&self, plan: &Plan, observer: &dyn Observer) -> Result<image::Frame, BenchError> {
        let aa = CONVERGED[usize::from(plan.quick)] / plan.shrink.max(1);
        let settings = self.settings.clone().with_aa(aa.max(2)).with_samples(LIGHT_SAMPLES * aa).with_seed(SEED);
        Ok(self.engine.renderer.render_prepared(self.scene, &settings, &Silent(observer))?.image)
    }

    fn measure(
        &self,
        quality: Quality,
        plan: &Plan,
        (share, converged): (Duration, &image::Frame),
        observer: &dyn Observer,
        findings: &mut Findings,
    ) -> Result<(), BenchError> {
        let numbers = [1, quality.pixel_samples()];
        let variant = |aa: u32| {
            let settings = self.settings.clone().with_quality(quality).with_aa(aa);
            Variant { renderer: &self.engine.renderer, scene: self.scene, settings }
        };
        let turns = Turns::take(&numbers.map(variant), plan.repetitions, share, observer)?;
        findings.notes.extend(turns.notes(quality.name(), plan.repetitions));
        let mut rows = Vec::new();
        for (aa, measured) in numbers.into_iter().zip(&turns.measured) {
            let own = [("quality", quality.name().into()), ("aa", f64::from(aa).into())];
            let mut row = Row::new(ANTIALIASING, self.keys.iter().cloned().chain(own).chain(self.engine.keys()));
            measured.fill(&mut row);
            let error = image::compare(converged, &measured.frame.image)?;
            row.values.insert("mean_flip".to_owned(), error.mean_flip);
            row.values.insert("rmse".to_owned(), error.rmse);
            rows.push(row);
        }
        if let [one, several] = &mut rows[..] {
            let times = one.median(WHOLE).zip(several.median(WHOLE));
            let errors = one.values.get("mean_flip").copied().zip(several.values.get("mean_flip").copied());
            for (name, pair) in [("time_by_one", times), ("error_by_one", errors)] {
                let ratio = pair.filter(|(one, _)| *one > 0.0).map(|(one, several)| several / one);
                several.values.extend(ratio.map(|ratio| (name.to_owned(), ratio)));
            }
        }
        findings.add(rows);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use lightmesh::Device;
    use lightmesh::render::Unobserved;

    use super::*;

    #[test]
    fn several_samples_are_compared_with_one() {
        let plan = Plan {
            device: Device::Cpu,
            threads: Some(2),
            repetitions: 1,
            shrink: 8,
            scenes: vec![PathBuf::from("builtin:gazebo")],
            ..Plan::new(true)
        };
        let mut findings = Findings::default();
        run(&plan, &Unobserved, &mut findings).unwrap();
        // Two of each quality and emitter.
        assert_eq!(findings.rows.len(), 2 * 3 * 4);
        for pair in findings.rows.chunks(2) {
            assert_eq!(pair[0].keys["aa"], 1.0.into());
            let [time, error] = ["time_by_one", "error_by_one"].map(|name| pair[1].values[name]);
            assert!(time > 0.0 && (0.0..0.8).contains(&error), "{:?}: {error}", pair[1].keys);
        }
    }
}
