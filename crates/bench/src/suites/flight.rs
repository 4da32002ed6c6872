//! A slow flight through a scene: whether the film flickers, with gathered light and with soft shadows, and what is gained by keeping what was
//! gathered.
//!
//! From frame to frame the camera goes ahead by 1/2400 of the scene's diagonal and turns by a tenth of a degree. A frame is compared with the
//! one before, moved to where its surfaces are seen now ([`reproject`]): nothing but the view has changed, so that they should be the same. The
//! exposure is that of the first frame; pixels have one sample, so that it is known which surface they see.
//!
//! Even a perfect film changes a little, because a moved frame is interpolated between pixels. How much tell a few pairs of frames in which each
//! surface point gathers light for itself, by thousands of rays in the same directions everywhere ([`AmbientSource::Rays`]): there are neither
//! cells nor levels, and noise does not differ from point to point. A path tracer with independent samples would flicker more, by its own noise.
//!
//! Rows of the experiment `flight` have the keys scene, size, frames, `light`, accel, device and threads, where `light` is
//!
//! * `kept`: one [`MeshCache`] for the whole flight. Values: `flicker`, the mean FLIP of neighbours over what is compared, and
//!   `gathered_flicker`, the same of gathered light alone; the largest of all pairs; `steps`, by how many codes of 8 bits a channel of the gathered
//!   light changes; `compared_share`; `gather_rays_per_pixel` and `shadow_rays_per_pixel` without the first frame, which gathers
//!   `first_rays_per_pixel`;
//! * `fresh`: some frames once more without it. `differing_frames` counts those that are not the same to the bit;
//! * `rays`: pairs of frames in which surface points gather for themselves. `kept_flicker` and `kept_gathered_flicker` are those of the flight
//!   in the same pairs, `flicker_by_rays` and `gathered_by_rays` the ratios: above 1 the flight flickers more.
//!
//! These are under a sky and without other lights. The flicker of shadows of the scene's own lights is in another experiment ([`shadows`]).

mod course;
mod reproject;
mod shadows;

use std::time::{Duration, Instant};

use lightmesh::glam::Vec3;
use lightmesh::render::{AmbientSource, PreparedScene};
use lightmesh::scene::{Lights, Sky, SunPosition, Up};
use lightmesh::{Acceleration, Frame, MeshCache, Observer, Scene, Settings};

use super::subjects::{self, Subject};
use crate::engine::{self, Engine};
use crate::measure::Silent;
use crate::{BenchError, FLIGHT, Findings, Key, Plan, Row, Samples, WHOLE};
use course::{camera, frames, keys, mean, pairs, settings};
use reproject::{Change, Shot, change};

/// Frames that are rendered again without what was kept.
const CHECKS: u32 = 4;
/// Pairs of frames with rays alone, and in the short version.
const PAIRS: [u32; 2] = [4, 2];
/// Where the sun stands: its light comes into courtyards, but not everywhere.
const SUN: SunPosition = SunPosition { elevation: 55.0, azimuth: 200.0 };
/// The part of the time for gathered light.
const PART_FOR_GATHERED: f64 = 0.75;
/// The part of that which the flight itself may take.
const PART_FOR_FLIGHT: f64 = 0.6;

pub(super) fn run(plan: &Plan, observer: &dyn Observer, findings: &mut Findings) -> Result<(), BenchError> {
    let engines = engine::engines(plan)?;
    findings.devices = engines.iter().map(|engine| engine.device.clone()).collect();
    subjects::each(plan, observer, |subject, share| {
        let scene = PreparedScene::new(&under_a_sky(&subject.scene)?, &Acceleration::Auto, &Silent(observer))?;
        for engine in &engines {
            let (begin, share) = (Instant::now(), share / engines.len() as u32);
            let flight = Flight::new(plan, subject, engine, &scene);
            flight.measure(plan, share.mul_f64(PART_FOR_GATHERED), observer, findings)?;
            shadows::measure(plan, subject, engine, share.saturating_sub(begin.elapsed()), observer, findings)?;
        }
        Ok(())
    })
}

/// The scene with no other light than that of a clear sky.
pub(super) fn under_a_sky(scene: &Scene) -> Result<Scene, BenchError> {
    let mut scene = scene.clone();
    scene.lights = Lights::default();
    let up = scene.cameras.first().map_or(Vec3::Y, |camera| camera.up);
    scene.lights.surround(Sky::clear(SUN).surroundings(if up.z > up.y { Up::Z } else { Up::Y })?);
    Ok(scene)
}

/// A flight on a device.
struct Flight<'a> {
    engine: &'a Engine,
    scene: &'a PreparedScene,
    settings: Settings,
    frames: u32,
    keys: Vec<(&'static str, Key)>,
}

/// A series of renders.
#[derive(Default)]
struct Series {
    seconds: Samples,
    /// Per pixel: gather rays and shadow rays.
    rays: [Vec<f64>; 2],
}

impl Series {
    fn add(&mut self, frame: &Frame) {
        let counts = &frame.stats.counts;
        self.seconds.push(frame.stats.seconds.render);
        for (all, count) in self.rays.iter_mut().zip([counts.gather_rays, counts.shadow_rays]) {
            all.push(count as f64 / counts.pixels as f64);
        }
    }

    fn fill(&self, row: &mut Row) {
        row.seconds.insert(WHOLE.to_owned(), self.seconds.clone());
        for (name, rays) in ["gather_rays_per_pixel", "shadow_rays_per_pixel"].iter().zip(&self.rays) {
            row.values.extend(mean(rays.iter().copied()).map(|mean| ((*name).to_owned(), mean)));
        }
    }
}

impl Flight<'_> {
    fn new<'a>(plan: &Plan, subject: &Subject, engine: &'a Engine, scene: &'a PreparedScene) -> Flight<'a> {
        let frames = frames(plan);
        let settings = settings(plan).with_ambient_light(AmbientSource::Mesh);
        Flight { engine, scene, settings, frames, keys: keys(plan, subject, scene) }
    }

    fn measure(
        &self,
        plan: &Plan,
        share: Duration,
        observer: &dyn Observer,
        findings: &mut Findings,
    ) -> Result<(), BenchError> {
        let begin = Instant::now();
        // Pairs of frames that are rendered by rays.
        let chosen = pairs(self.frames, PAIRS[usize::from(plan.quick)]);

        // 1. The flight.
        let (mut kept, mut fresh) = (Series::default(), Series::default());
        let (mut first, mut differing) = (0.0, 0);
        let (mut changes, mut last): (Vec<Change>, Option<Shot>) = (Vec::new(), None);
        let (mut cache, mut exposure) = (MeshCache::new(), None);
        for number in 0..self.frames {
            if number > 1 && begin.elapsed() > share.mul_f64(PART_FOR_FLIGHT) {
                findings.notes.push(format!("Because of the time budget the flight ended after {number} frames."));
                break;
            }
            let frame = self.render(number, AmbientSource::Mesh, Some(&mut cache), observer)?;
            match number {
                0 => first = frame.stats.counts.gather_rays as f64 / frame.stats.counts.pixels as f64,
                _ => kept.add(&frame),
            }
            if number > 0 && number % self.frames.div_ceil(CHECKS) == 0 {
                let again = self.render(number, AmbientSource::Mesh, None, observer)?;
                differing += u32::from(again.image.color() != frame.image.color());
                fresh.add(&again);
            }
            let stops = *exposure.get_or_insert_with(|| frame.image.auto_exposure());
            let shot = Shot { camera: camera(self.scene, number), frame: frame.image };
            changes.extend(last.as_ref().map(|last| change(last, &shot, stops)).transpose()?);
            last = Some(shot);
        }
        let exposure = exposure.unwrap_or(0.0);
        let mut row = self.row("kept");
        kept.fill(&mut row);
        fill_changes(&mut row, &changes);
        row.values.insert("first_rays_per_pixel".to_owned(), first);
        row.values.insert("cache_bytes".to_owned(), cache.memory() as f64);
        let mut without = self.row("fresh");
        fresh.fill(&mut without);
        without.values.insert("differing_frames".to_owned(), f64::from(differing));
        findings.add([row, without]);

        // 2. The same pairs by rays.
        let (mut by_rays, mut own, mut of_kept) = (Series::default(), Vec::new(), Vec::new());
        let mut cache = MeshCache::new();
        for &pair in &chosen {
            let Some(of_flight) = changes.get(pair as usize) else { break };
            if !own.is_empty() && begin.elapsed() >= share {
                findings.notes.push(format!(
                    "Because of the time budget {} of {} pairs of frames were rendered by rays.",
                    own.len(),
                    chosen.len()
                ));
                break;
            }
            let mut shots = Vec::new();
            for number in [pair, pair + 1] {
                observer.note(&format!("frame {number} by rays"));
                let frame = self.render(number, AmbientSource::Rays, Some(&mut cache), observer)?;
                by_rays.add(&frame);
                shots.push(Shot { camera: camera(self.scene, number), frame: frame.image });
            }
            own.push(change(&shots[0], &shots[1], exposure)?);
            of_kept.push(of_flight.clone());
        }
        let mut row = self.row("rays");
        by_rays.fill(&mut row);
        fill_changes(&mut row, &own);
        compare(&mut row, &own, &of_kept);
        findings.add([row]);
        Ok(())
    }

    fn row(&self, light: &str) -> Row {
        let keys = self.keys.iter().cloned().chain([("light", light.into())]);
        Row::new(FLIGHT, keys.chain(self.engine.keys()))
    }

    fn render(
        &self,
        number: u32,
        light: AmbientSource,
        cache: Option<&mut MeshCache>,
        observer: &dyn Observer,
    ) -> Result<Frame, BenchError> {
        let settings = self.settings.clone().with_ambient_light(light).with_camera(camera(self.scene, number));
        let (renderer, silent) = (&self.engine.renderer, Silent(observer));
        let frame = match cache {
            Some(cache) => renderer.render_with(cache, self.scene, &settings, &silent),
            None => renderer.render_prepared(self.scene, &settings, &silent),
        };
        Ok(frame?)
    }
}

/// Means over all pairs, and the largest flicker.
fn fill_changes(row: &mut Row, changes: &[Change]) {
    let mut insert = |name: &str, value: Option<f64>| row.values.extend(value.map(|value| (name.to_owned(), value)));
    insert("flicker", mean(changes.iter().map(|change| change.flicker)));
    insert("largest_flicker", changes.iter().map(|change| change.flicker).max_by(f64::total_cmp));
    insert("gathered_flicker", mean(changes.iter().map(|change| change.gathered_flicker)));
    insert("largest_gathered_flicker", changes.iter().map(|change| change.gathered_flicker).max_by(f64::total_cmp));
    insert("steps", mean(changes.iter().map(|change| change.steps)));
    insert("compared_share", mean(changes.iter().map(|change| change.compared)));
    insert("pairs", (!changes.is_empty()).then_some(changes.len() as f64));
}

/// A value of a change.
type Figure = fn(&Change) -> f64;

/// Adds the flicker of the flight in the same pairs.
fn compare(row: &mut Row, own: &[Change], of_kept: &[Change]) {
    let figures: [(&str, &str, Figure); 2] = [
        ("kept_flicker", "flicker_by_rays", |change| change.flicker),
        ("kept_gathered_flicker", "gathered_by_rays", |change| change.gathered_flicker),
    ];
    for (name, ratio, figure) in figures {
        let [Some(own), Some(kept)] = [own, of_kept].map(|changes| mean(changes.iter().map(figure))) else { continue };
        row.values.insert(name.to_owned(), kept);
        if own > 0.0 {
            row.values.insert(ratio.to_owned(), kept / own);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use lightmesh::Device;
    use lightmesh::render::Unobserved;

    use super::*;

    fn found(plan: Plan) -> Findings {
        let scenes = vec![PathBuf::from("builtin:gazebo")];
        let plan = Plan { device: Device::Cpu, threads: Some(2), scenes, size: Some(20), ..plan };
        let mut findings = Findings::default();
        run(&plan, &Unobserved, &mut findings).unwrap();
        findings
    }

    #[test]
    fn a_flight_has_its_flicker_its_rays_and_its_reference() {
        let findings = found(Plan { frames: Some(5), ..Plan::new(true) });
        let [kept, fresh, rays, shadows @ ..] = &findings.rows[..] else { panic!("{findings:?}") };
        assert_eq!([kept, fresh, rays].map(|row| row.keys["light"].clone()), ["kept", "fresh", "rays"].map(Key::from));
        assert_eq!((kept.values["pairs"], kept.seconds[WHOLE].0.len()), (4.0, 4));
        assert_eq!((fresh.values["differing_frames"], fresh.seconds[WHOLE].0.len()), (0.0, 2));
        assert!(2.0 * kept.values["gather_rays_per_pixel"] < fresh.values["gather_rays_per_pixel"], "{findings:?}");
        assert_eq!((rays.values["pairs"], rays.seconds[WHOLE].0.len()), (2.0, 4));
        assert!(rays.values["gather_rays_per_pixel"] > 500.0 && rays.values["flicker_by_rays"] > 0.0);
        assert!([kept, rays].iter().all(|row| (0.2..1.0).contains(&row.values["compared_share"])), "{findings:?}");
        assert_eq!(findings.notes, Vec::<String>::new());

        let methods = ["area", "lists", "half-ball", "reference"].map(Key::from);
        assert_eq!(shadows.iter().map(|row| row.keys["shadows"].clone()).collect::<Vec<_>>(), methods);
        assert_eq!(shadows.iter().map(|row| row.values["pairs"]).collect::<Vec<_>>(), [3.0, 3.0, 3.0, 1.0]);
        assert!(shadows.iter().all(|row| row.values["compared_share"] > 0.2 && row.values["flicker"] > 0.0));
        let [area, .., reference] = shadows else { panic!("{findings:?}") };
        assert_eq!(area.values["flicker_by_area"], 1.0);
        assert!(reference.values["flicker_by_area"] < 1.0 && area.values["flicker"] < 0.1, "{findings:?}");
    }

    #[test]
    fn without_time_a_flight_is_short() {
        let findings = found(Plan { budget: Duration::ZERO, frames: Some(9), ..Plan::new(true) });
        assert_eq!((findings.rows.len(), findings.rows[0].values["pairs"]), (7, 1.0));
        assert_eq!(
            findings.notes,
            [
                "Because of the time budget the flight ended after 2 frames.",
                "Because of the time budget shadows were compared in 1 of 3 pairs of frames."
            ]
        );
    }
}
