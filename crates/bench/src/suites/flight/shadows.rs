//! Whether soft shadows flicker: pairs of frames of the flight in the light of the scene's own lights, as balls.
//!
//! Rows of the experiment `flicker` have the keys scene, size, frames, `shadows`, accel, device and threads, where `shadows` is
//!
//! * `half-ball`: the thesis' light points, kept from frame to frame, with the step of the first frame;
//! * `lists`: occluder lists;
//! * `area`: [`SAMPLES`] shadow rays to each light;
//! * `reference`: [`MANY`] of them, in fewer pairs. What is left is the interpolation of the moved frame.
//!
//! Values: `flicker`, the mean FLIP of neighbours over what is compared; the largest of all pairs; `flicker_by_area`: divided by that of `area`
//! in the same pairs, as `area_flicker` has it. Above 1, shadows flicker more than those of an ordinary renderer.

use std::time::{Duration, Instant};

use lightmesh::render::PreparedScene;
use lightmesh::{Lookup, MeshCache, Mode, Observer, Settings, Step};

use super::course::{camera, frames, keys, mean, pairs, settings};
use super::reproject::{Shot, change};
use crate::engine::Engine;
use crate::measure::Silent;
use crate::suites::subjects::Subject;
use crate::{BenchError, FLICKER, Findings, Plan, Row};

/// Shadow rays to each light, and those of the reference.
const SAMPLES: u32 = 64;
const MANY: u32 = 1024;
/// Pairs of frames, and in the short version.
const PAIRS: [u32; 2] = [24, 3];
/// Of these the reference renders one in so many.
const REFERENCE_PAIRS: usize = 6;

/// A way to compute shadows.
struct Method {
    name: &'static str,
    choose: fn(Settings) -> Settings,
    /// It is measured in one pair in so many.
    each: usize,
}

/// What the others are compared with comes first.
const METHODS: [Method; 4] = [
    Method { name: "area", choose: |settings| settings.with_mode(Mode::Area).with_samples(SAMPLES), each: 1 },
    Method { name: "lists", choose: |settings| settings.with_lookup(Lookup::Lists), each: 1 },
    Method { name: "half-ball", choose: |settings| settings.with_lookup(Lookup::HalfBall), each: 1 },
    Method {
        name: "reference",
        choose: |settings| settings.with_mode(Mode::Area).with_samples(MANY),
        each: REFERENCE_PAIRS,
    },
];

/// Measures pairs of frames by all methods, one pair after another while there is time: at least one.
pub(super) fn measure(
    plan: &Plan,
    subject: &Subject,
    engine: &Engine,
    share: Duration,
    observer: &dyn Observer,
    findings: &mut Findings,
) -> Result<(), BenchError> {
    let (begin, silent) = (Instant::now(), Silent(observer));
    let settings = settings(plan);
    let scene = PreparedScene::new(&subject.with_balls(), &settings.acceleration, &silent)?;
    let mut ways = METHODS.map(|method| (method.choose)(settings.clone()));
    let mut caches = METHODS.map(|_| MeshCache::new());
    let mut flicker = METHODS.map(|_| Vec::new());
    let (mut exposure, chosen) = (None, pairs(frames(plan), PAIRS[usize::from(plan.quick)]));
    for (index, &pair) in chosen.iter().enumerate() {
        if index > 0 && begin.elapsed() >= share {
            findings.notes.push(format!(
                "Because of the time budget shadows were compared in {index} of {} pairs of frames.",
                chosen.len()
            ));
            break;
        }
        for (number, method) in METHODS.iter().enumerate().filter(|(_, method)| index % method.each == 0) {
            observer.note(&format!("{} in frame {pair}", method.name));
            let mut shots = Vec::new();
            for at in [pair, pair + 1] {
                let camera = camera(&scene, at);
                let way = ways[number].clone().with_camera(camera.clone());
                let frame = engine.renderer.render_with(&mut caches[number], &scene, &way, &silent)?;
                if let Some(step) = frame.stats.settings.step {
                    ways[number] = ways[number].clone().with_step(Step::Fixed(step));
                }
                shots.push(Shot { camera, frame: frame.image });
            }
            let stops = *exposure.get_or_insert_with(|| shots[0].frame.auto_exposure());
            flicker[number].push((index, change(&shots[0], &shots[1], stops)?));
        }
    }
    let [area, ..] = &flicker;
    let rows = METHODS.iter().zip(&flicker).map(|(method, own)| {
        let keys = keys(plan, subject, &scene).into_iter().chain([("shadows", method.name.into())]);
        let mut row = Row::new(FLICKER, keys.chain(engine.keys()));
        let of_area = area.iter().filter(|(pair, _)| own.iter().any(|(own, _)| own == pair));
        let of_area = mean(of_area.map(|(_, change)| change.flicker));
        let flicker = mean(own.iter().map(|(_, change)| change.flicker));
        let values = [
            ("flicker", flicker),
            ("area_flicker", of_area),
            ("flicker_by_area", flicker.zip(of_area).filter(|(_, area)| *area > 0.0).map(|(own, area)| own / area)),
            ("largest_flicker", own.iter().map(|(_, change)| change.flicker).max_by(f64::total_cmp)),
            ("compared_share", mean(own.iter().map(|(_, change)| change.compared))),
            ("pairs", Some(own.len() as f64)),
        ];
        row.values.extend(values.into_iter().filter_map(|(name, value)| Some((name.to_owned(), value?))));
        row
    });
    findings.add(rows);
    Ok(())
}
