//! A film: what is gained by keeping what two frames have in common.
//!
//! Scenes that move are shown as they do, 24 frames for each second, and others as the camera goes once around them, in as many frames as a film has
//! here. Each frame is rendered with one [`MeshCache`] for the whole film, from what was prepared for the frame before; some of them once more from
//! nothing but their scene.
//!
//! Rows of the experiment `film` have the keys scene, size, frames, `shadows`, `frame`, accel, device and threads. `shadows` is the lookup, or
//! `gathered`: lists with gathered light under a clear sky. `frame` is
//!
//! * `kept`: with what was kept. `first_seconds` is the time of the first frame, which is not in `seconds`;
//! * `fresh`: without. `differing_frames` counts those that are not the same to the bit.
//!
//! Values: `build_seconds` for structures of surfaces that moved; `long_tests_per_pixel`, `gather_rays_per_pixel`; `time_ratio`, `test_ratio` and `ray_ratio`: those of
//! `kept`, with its first frame, divided by those of `fresh`.

use std::time::{Duration, Instant};

use lightmesh::render::{AmbientSource, PreparedScene};
use lightmesh::{Frame, Lookup, MeshCache, Observer, Scene, Settings, Step};

use super::flight::under_a_sky;
use super::subjects::{self, Subject};
use crate::engine::{self, Engine};
use crate::measure::Silent;
use crate::{BenchError, FILM, Findings, Key, Plan, Row, Samples, WHOLE};

/// Pixels along the width, and in the short version; the height is nine sixteenths of it.
const WIDTHS: [u32; 2] = [1280, 192];
/// Frames, and in the short version.
const FRAMES: [u32; 2] = [120, 8];
/// Frames per second of scenes that move.
const RATE: f64 = 24.0;
/// Frames that are rendered again from nothing, at most.
const CHECKS: u32 = 10;

/// What is looked up for shadows, and whether light is gathered.
const WAYS: [(&str, Lookup, bool); 3] =
    [("lists", Lookup::Lists, false), ("half-ball", Lookup::HalfBall, false), ("gathered", Lookup::Lists, true)];

pub(super) fn run(plan: &Plan, observer: &dyn Observer, findings: &mut Findings) -> Result<(), BenchError> {
    let engines = engine::engines(plan)?;
    findings.devices = engines.iter().map(|engine| engine.device.clone()).collect();
    subjects::each(plan, observer, |subject, share| {
        for engine in &engines {
            for way in WAYS {
                observer.note(&format!("{} on {}", way.0, engine.device));
                let share = share / (engines.len() * WAYS.len()) as u32;
                Film::new(plan, subject, engine, way)?.measure(share, observer, findings)?;
            }
        }
        Ok(())
    })
}

/// A film on a device.
struct Film<'a> {
    engine: &'a Engine,
    scene: Scene,
    settings: Settings,
    frames: u32,
    keys: Vec<(&'static str, Key)>,
}

/// A series of renders.
#[derive(Default)]
struct Series {
    seconds: Samples,
    build: f64,
    pixels: f64,
    long_tests: f64,
    gather_rays: f64,
    frames: f64,
}

impl Series {
    fn add(&mut self, frame: &Frame) {
        let (counts, seconds) = (&frame.stats.counts, &frame.stats.seconds);
        self.seconds.push(seconds.render);
        self.build += seconds.build;
        self.pixels += counts.pixels as f64;
        self.long_tests += counts.long_tests as f64;
        self.gather_rays += counts.gather_rays as f64;
        self.frames += 1.0;
    }

    /// Seconds, long tests and gather rays for each frame, with `first` among them.
    fn means(&self, first: Option<&Series>) -> [f64; 3] {
        let sum = |of: fn(&Series) -> f64| of(self) + first.map_or(0.0, of);
        let frames = sum(|series| series.frames).max(1.0);
        [
            sum(|series| series.seconds.0.iter().sum()) / frames,
            sum(|series| series.long_tests) / frames,
            sum(|series| series.gather_rays) / frames,
        ]
    }

    fn fill(&self, row: &mut Row) {
        row.seconds.insert(WHOLE.to_owned(), self.seconds.clone());
        let (frames, pixels) = (self.frames.max(1.0), self.pixels.max(1.0));
        let values = [
            ("build_seconds", self.build / frames),
            ("long_tests_per_pixel", self.long_tests / pixels),
            ("gather_rays_per_pixel", self.gather_rays / pixels),
        ];
        row.values.extend(values.map(|(name, value)| (name.to_owned(), value)));
    }
}

impl Film<'_> {
    fn new<'a>(
        plan: &Plan,
        subject: &Subject,
        engine: &'a Engine,
        (name, lookup, gathers): (&'static str, Lookup, bool),
    ) -> Result<Film<'a>, BenchError> {
        let width = plan.side_or(WIDTHS);
        let most = plan.frames.unwrap_or(FRAMES[usize::from(plan.quick)]).max(2);
        let own = subject.scene.animation().map(|animation| (animation.duration() * RATE) as u32 + 1);
        let frames = own.unwrap_or(most).min(most);
        let scene = if gathers { under_a_sky(&subject.scene)? } else { subject.scene.clone() };
        let ambient = if gathers { AmbientSource::Mesh } else { AmbientSource::Constant };
        let mut settings = Settings::default().with_size([width, (9 * width / 16).max(1)]);
        settings = settings.with_lookup(lookup).with_ambient_light(ambient);
        if let Some(step) = subject.step {
            settings = settings.with_step(Step::Fixed(step));
        }
        let keys = vec![
            ("scene", subject.name.as_str().into()),
            ("size", f64::from(width).into()),
            ("frames", f64::from(frames).into()),
            ("shadows", name.into()),
        ];
        Ok(Film { engine, scene, settings, frames, keys })
    }

    fn measure(mut self, share: Duration, observer: &dyn Observer, findings: &mut Findings) -> Result<(), BenchError> {
        let (begin, silent) = (Instant::now(), Silent(observer));
        let renderer = &self.engine.renderer;
        let (mut first, mut kept, mut fresh, mut differing) =
            (Series::default(), Series::default(), Series::default(), 0);
        let mut cache = MeshCache::new();
        let mut prepared = renderer.prepare(&self.scene, &self.settings, &silent)?;
        self.keys.push(("accel", prepared.geometry.accelerator.name().into()));
        // Kernels are loaded when they are first used.
        let warm = self.at(0);
        let warm = renderer.prepare_moved(&prepared, &warm, &self.settings, &silent)?;
        renderer.render_prepared(&warm, &self.settings, &silent)?;
        for number in 0..self.frames {
            if number > 1 && begin.elapsed() > share {
                findings.notes.push(format!("Because of the time budget a film ended after {number} frames."));
                break;
            }
            let scene = self.at(number);
            let next = renderer.prepare_moved(&prepared, &scene, &self.settings, &silent)?;
            let frame = renderer.render_with(&mut cache, &next, &self.settings, &silent)?;
            prepared = next;
            if number == 0 { &mut first } else { &mut kept }.add(&frame);
            if let Step::Auto = self.settings.step.unwrap_or(Step::Auto)
                && let Some(step) = frame.stats.settings.step
            {
                self.settings = self.settings.clone().with_step(Step::Fixed(step));
            }
            if number % self.frames.div_ceil(CHECKS) == 0 {
                let alone = PreparedScene::new(&scene, &self.settings.acceleration, &silent)?;
                let again = renderer.render_prepared(&alone, &self.settings, &silent)?;
                differing += u32::from(again.image.color() != frame.image.color());
                fresh.add(&again);
            }
        }
        let mut row = self.row("kept");
        kept.fill(&mut row);
        row.values.insert("first_seconds".to_owned(), first.means(None)[0]);
        row.values.insert("cache_bytes".to_owned(), cache.memory() as f64);
        let ratios = kept.means(Some(&first)).into_iter().zip(fresh.means(None));
        for (name, (kept, fresh)) in ["time_ratio", "test_ratio", "ray_ratio"].into_iter().zip(ratios) {
            row.values.extend((fresh > 0.0).then(|| (name.to_owned(), kept / fresh)));
        }
        let mut without = self.row("fresh");
        fresh.fill(&mut without);
        without.values.insert("differing_frames".to_owned(), f64::from(differing));
        findings.add([row, without]);
        Ok(())
    }

    fn row(&self, frame: &str) -> Row {
        let keys = self.keys.iter().cloned().chain([("frame", frame.into())]);
        Row::new(FILM, keys.chain(self.engine.keys()))
    }

    /// The scene at a frame: as it moves, or with the camera turned about its middle.
    fn at(&self, number: u32) -> Scene {
        if self.scene.animation().is_some() {
            return self.scene.at(f64::from(number) / RATE);
        }
        let angle = std::f32::consts::TAU * number as f32 / self.frames as f32;
        let camera = self.scene.cameras[0].clone().turned_about(self.scene.geometry.mesh.bounds().center(), angle);
        self.scene.clone().with_cameras(vec![camera])
    }
}
