//! Milliseconds per stage of whole frames, as `--stats` counts them: on a CUDA device by the device's own events.
//!
//! `cargo bench -p lightmesh --bench frame [-- DEVICE] [SIZE] [RUNS] [ACCEL]`, for instance `-- cuda 2048 20 grid`: the three built-in
//! scenes at the thesis' steps and R = 3.1, and the same with R = 2.1, plain short tests, the automatic step and hard shadows. The
//! variants of a scene are rendered in turn, so that a machine whose speed drifts slows all of them; after a first round that does
//! not count, medians are printed. `frame` is the sum of the stages, `wall` what a caller waits, copies included.
#![allow(clippy::print_stdout, reason = "a benchmark prints its result")]

use std::time::Instant;

use lightmesh::render::{Seconds, ShortTests, Unobserved};
use lightmesh::scene::Weight;
use lightmesh::{Acceleration, Device, Mode, Renderer, Scene, Settings, Stats, Step};

/// One way to render a scene.
struct Variant {
    name: &'static str,
    settings: Settings,
}

/// What is measured.
struct Plan {
    device: Device,
    size: u32,
    runs: usize,
    acceleration: Acceleration,
}

impl Plan {
    /// Words in any order; what is left out has a default. Words of `cargo bench` itself are passed over.
    fn from_arguments() -> Plan {
        let mut plan = Plan { device: Device::Cpu, size: 1024, runs: 5, acceleration: Acceleration::Auto };
        let mut numbers = Vec::new();
        for word in std::env::args().skip(1) {
            match (word.parse::<u32>(), word.as_str()) {
                (Ok(number), _) => numbers.push(number.max(1)),
                (_, "grid") => plan.acceleration = Acceleration::Grid(None),
                (_, "bvh") => plan.acceleration = Acceleration::Bvh,
                (_, word) => plan.device = word.parse().unwrap_or(plan.device),
            }
        }
        plan.size = numbers.first().copied().unwrap_or(plan.size);
        plan.runs = numbers.get(1).map_or(plan.runs, |&runs| runs as usize);
        plan
    }
}

fn variants(step: f32, plan: &Plan) -> Vec<Variant> {
    let thesis = Settings {
        size: [plan.size, plan.size],
        step: Some(Step::Fixed(step)),
        radius: Some(3.1),
        weight: Some(Weight::Constant),
        acceleration: plan.acceleration.clone(),
        ..Settings::default()
    };
    let small = Settings { radius: Some(2.1), ..thesis.clone() };
    let auto = Settings { step: Some(Step::Auto), radius: None, weight: None, ..thesis.clone() };
    vec![
        Variant { name: "R 3.1, by cell", settings: thesis.clone() },
        Variant { name: "R 2.1, by cell", settings: small },
        Variant { name: "R 3.1, plain", settings: Settings { short_tests: ShortTests::Plain, ..thesis.clone() } },
        Variant { name: "automatic step", settings: auto },
        Variant { name: "hard shadows", settings: Settings { mode: Mode::RayTrace, ..thesis } },
    ]
}

fn main() {
    let plan = Plan::from_arguments();
    let renderer = match Renderer::new(plan.device) {
        Ok(renderer) => renderer,
        Err(error) => return println!("{error}"),
    };
    println!("{0}x{0}, median of {1}, milliseconds", plan.size, plan.runs);
    println!("scene      variant          primary   short collect    long   shade    frame     wall  light points");
    for (name, step) in [("gazebo", 2.0), ("childpark", 1.0), ("garden", 0.1)] {
        let scene = Scene::open(format!("builtin:{name}")).expect("built-in scenes always open");
        let variants = variants(step, &plan);
        let prepared = renderer.prepare(&scene, &variants[0].settings, &Unobserved).expect("a structure always builds");
        let mut runs: Vec<Vec<(Stats, f64)>> = variants.iter().map(|_| Vec::new()).collect();
        for round in 0..=plan.runs {
            for (variant, runs) in variants.iter().zip(&mut runs) {
                let start = Instant::now();
                let frame = renderer.render_prepared(&prepared, &variant.settings, &Unobserved);
                let wall = start.elapsed().as_secs_f64();
                let stats = frame.expect("the settings have sense").stats;
                if round > 0 {
                    runs.push((stats, wall));
                }
            }
        }
        for (variant, runs) in variants.iter().zip(&runs) {
            print_row(name, variant.name, runs);
        }
    }
}

/// Seconds of all stages together.
fn frame(seconds: &Seconds) -> f64 {
    seconds.primary_rays + seconds.short_tests + seconds.collect + seconds.long_tests + seconds.shade
}

fn print_row(scene: &str, variant: &str, runs: &[(Stats, f64)]) {
    let median = |value: &dyn Fn(&(Stats, f64)) -> f64| {
        let mut values: Vec<f64> = runs.iter().map(|run| 1e3 * value(run)).collect();
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    };
    println!(
        "{scene:10} {variant:16} {:7.2} {:7.2} {:7.2} {:7.2} {:7.2} {:8.2} {:8.2}  {:12}",
        median(&|(stats, _)| stats.seconds.primary_rays),
        median(&|(stats, _)| stats.seconds.short_tests),
        median(&|(stats, _)| stats.seconds.collect),
        median(&|(stats, _)| stats.seconds.long_tests),
        median(&|(stats, _)| stats.seconds.shade),
        median(&|(stats, _)| frame(&stats.seconds)),
        median(&|(_, wall)| *wall),
        runs[0].0.counts.light_points,
    );
}
