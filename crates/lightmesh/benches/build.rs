//! How build times grow with the number of triangles, and how good the trees are.
//!
//! `cargo bench -p lightmesh --bench build [-- FILTER]`: builds the BVH and the grid over each family of shapes (those whose name
//! contains FILTER) with 10 000, 100 000 and 1 000 000 triangles; the fastest of three builds counts. Fails if ten times as many
//! triangles take more than 15 times as long. `-- --scenes [SCENE…]` builds BVHs over scenes instead, by default the built-in ones
//! and all shared models, and prints the time and what a ray is expected to do.
#![allow(clippy::print_stdout, reason = "a benchmark prints its result")]

use std::process::ExitCode;
use std::time::Instant;

use lightmesh::Scene;
use lightmesh::render::accel::{Bvh, Grid, GridOptions, Triangle};
use lightmesh_testkit::{FAMILIES, Family, MODELS};

/// Numbers of triangles.
const COUNTS: [usize; 3] = [10_000, 100_000, 1_000_000];
/// Most by which ten times as many triangles may multiply the time.
const MOST: f64 = 15.0;
const REPETITIONS: usize = 3;

type Build = fn(&[Triangle]);

const STRUCTURES: [(&str, Build); 2] = [
    ("bvh", |triangles| drop(Bvh::new(triangles))),
    ("grid", |triangles| drop(Grid::new(triangles, &GridOptions::default()))),
];

fn seconds(build: Build, triangles: &[Triangle]) -> f64 {
    let once = |_| {
        let start = Instant::now();
        build(triangles);
        start.elapsed().as_secs_f64()
    };
    (0..REPETITIONS).map(once).fold(f64::INFINITY, f64::min)
}

/// Prints a row. Whether the growth stays within its bound.
fn grows_evenly(family: &Family, (name, build): (&str, Build)) -> bool {
    let times = COUNTS.map(|count| {
        let corners = family.triangles(count);
        let triangles: Vec<_> =
            corners.iter().zip(0..).map(|(&corners, index)| Triangle::new(corners, index)).collect();
        seconds(build, &triangles)
    });
    let growth = [times[1] / times[0], times[2] / times[1]];
    let held = growth.iter().all(|&growth| growth <= MOST);
    let [a, b, c] = times;
    println!(
        "{:14} {name:5} {a:8.4} {b:8.4} {c:8.4} {:7.1} {:7.1}{}",
        family.name,
        growth[0],
        growth[1],
        if held { "" } else { "  MISSED" }
    );
    held
}

fn print_quality(name: &str, scene: &Scene) {
    let mesh = &scene.geometry.mesh;
    let triangles: Vec<_> = (0..mesh.triangles.len()).map(|at| Triangle::new(mesh.corners(at), at as u32)).collect();
    let time = seconds(|triangles| drop(Bvh::new(triangles)), &triangles);
    let cost = Bvh::new(&triangles).cost();
    println!("{name:40} {:9} {time:8.4} {:8.3} {:9.3} {:6}", triangles.len(), cost.nodes, cost.triangles, cost.levels);
}

fn qualities(names: &[String]) -> ExitCode {
    println!("{:40} triangles  seconds    nodes triangles levels", "scene");
    let built_in = ["builtin:gazebo", "builtin:childpark", "builtin:garden"].map(str::to_owned);
    for name in if names.is_empty() { &built_in } else { names } {
        print_quality(name, &Scene::open(name).unwrap_or_else(|error| panic!("{error}")));
    }
    for model in MODELS.iter().filter(|model| names.is_empty() && model.is_there()) {
        print_quality(model.file, &model.open());
    }
    ExitCode::SUCCESS
}

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| word != "--bench").collect();
    if words.first().is_some_and(|word| word == "--scenes") {
        return qualities(&words[1..]);
    }
    println!("family         kind    10 000  100 000 1000000  growth  growth");
    let wanted = FAMILIES.iter().filter(|family| words.first().is_none_or(|word| family.name.contains(word.as_str())));
    let rows: Vec<bool> =
        wanted.flat_map(|family| STRUCTURES.map(|structure| grows_evenly(family, structure))).collect();
    if rows.iter().all(|&held| held) { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
