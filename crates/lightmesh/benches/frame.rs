//! Seconds per stage of whole frames on the CPU, as `--stats` counts them.
//!
//! `cargo bench -p lightmesh --bench frame [-- SIZE [RUNS]]`: the three built-in scenes at the thesis' steps and R = 3.1, and the
//! same with plain short tests, hard shadows and the automatic step. The variants of a scene are rendered in turn, so that a
//! machine whose speed drifts slows all of them; medians are printed.
#![allow(clippy::print_stdout, reason = "a benchmark prints its result")]

use lightmesh::render::{ShortTests, Unobserved};
use lightmesh::scene::Weight;
use lightmesh::{Device, Mode, Renderer, Scene, Settings, Stats, Step};

/// One way to render a scene.
struct Variant {
    name: &'static str,
    settings: Settings,
}

fn variants(step: f32, size: u32) -> Vec<Variant> {
    let thesis = Settings {
        size: [size, size],
        step: Some(Step::Fixed(step)),
        radius: Some(3.1),
        weight: Some(Weight::Constant),
        ..Settings::default()
    };
    let auto = Settings { step: Some(Step::Auto), radius: None, weight: None, ..thesis.clone() };
    vec![
        Variant { name: "thesis, by cell", settings: thesis.clone() },
        Variant { name: "thesis, plain", settings: Settings { short_tests: ShortTests::Plain, ..thesis.clone() } },
        Variant { name: "automatic step", settings: auto },
        Variant { name: "hard shadows", settings: Settings { mode: Mode::RayTrace, ..thesis } },
    ]
}

fn main() {
    let mut arguments = std::env::args().skip(1).filter_map(|argument| argument.parse::<u32>().ok());
    let size = arguments.next().unwrap_or(1024);
    let runs = arguments.next().unwrap_or(5).max(1);
    let renderer = Renderer::new(Device::Cpu).expect("the CPU can always be used");
    println!("{size}x{size}, median of {runs}, seconds");
    println!("scene      variant          primary   short collect    long   shade   frame  light points");
    for (name, step) in [("gazebo", 2.0), ("childpark", 1.0), ("garden", 0.1)] {
        let scene = Scene::open(format!("builtin:{name}")).expect("built-in scenes always open");
        let variants = variants(step, size);
        let prepared = renderer.prepare(&scene, &variants[0].settings, &Unobserved).expect("a BVH always builds");
        let mut stats: Vec<Vec<Stats>> = variants.iter().map(|_| Vec::new()).collect();
        for _ in 0..runs {
            for (variant, stats) in variants.iter().zip(&mut stats) {
                let frame = renderer.render_prepared(&prepared, &variant.settings, &Unobserved);
                stats.push(frame.expect("the settings have sense").stats);
            }
        }
        for (variant, stats) in variants.iter().zip(&stats) {
            print_row(name, variant.name, stats);
        }
    }
}

fn print_row(scene: &str, variant: &str, stats: &[Stats]) {
    let median = |value: fn(&Stats) -> f64| {
        let mut values: Vec<f64> = stats.iter().map(value).collect();
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    };
    println!(
        "{scene:10} {variant:16} {:7.3} {:7.3} {:7.3} {:7.3} {:7.3} {:7.3}  {:12}",
        median(|stats| stats.seconds.primary_rays),
        median(|stats| stats.seconds.short_tests),
        median(|stats| stats.seconds.collect),
        median(|stats| stats.seconds.long_tests),
        median(|stats| stats.seconds.shade),
        median(|stats| stats.seconds.render),
        stats[0].counts.light_points,
    );
}
