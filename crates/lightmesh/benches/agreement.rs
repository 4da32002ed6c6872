//! Agreement between the CPU and a CUDA device: hits, masks and images.
//!
//! `cargo bench -p lightmesh --bench agreement [-- SIZE]`: the three built-in scenes and, if they are available next to the
//! repository, Sponza and the bunny; BVH and grid; all modes. Fails if a threshold is missed: 99.999 % of hits, 99.999 % of mask
//! bits, 99.99 % of pixels within 1/255, and identical bytes in a second run.
#![allow(clippy::print_stdout, reason = "a benchmark prints its result")]

use std::process::ExitCode;

use lightmesh::render::accel::Hit;
use lightmesh::render::backend::{Backend, Cpu, Cuda, Wave};
use lightmesh::render::cuda::{Driver, open_cuda};
use lightmesh::render::light_mesh::{Lattice, LightMesh, Template};
use lightmesh::render::{
    LightGroup, PreparedScene, RenderContext, RenderError, Sampling, ShortTests, Unobserved, View, render_on,
};
use lightmesh::scene::Weight;
use lightmesh::{Acceleration, Frame, Mode, Scene, Settings, Step, Transfer};
use lightmesh_testkit::MODELS;

/// The scenes to render.
struct Case {
    scene: Scene,
    step: f32,
}

fn cases() -> Vec<Case> {
    let builtin = [("gazebo", 2.0), ("childpark", 1.0), ("garden", 0.1)];
    let mut cases: Vec<Case> = builtin
        .iter()
        .map(|(name, step)| Case {
            scene: Scene::open(format!("builtin:{name}")).expect("it is built in"),
            step: *step,
        })
        .collect();
    let wanted = [("sponza/sponza.obj", 0.2), ("bunny/stanford-bunny.obj", 0.004)];
    for (file, step) in wanted {
        let model = MODELS.iter().find(|model| model.file == file && model.is_there());
        match model {
            Some(model) => cases.push(Case { scene: model.open(), step }),
            None => println!("{file} is missing: skipped"),
        }
    }
    cases
}

/// Checks shares against thresholds, and whether all were reached.
struct Verdict {
    held: bool,
}

impl Verdict {
    fn share(&mut self, what: &str, agreeing: u64, all: u64, bound: f64) {
        let share = agreeing as f64 / (all as f64).max(1.0);
        let held = share >= bound;
        self.held &= held;
        let word = if held { "" } else { "  MISSED" };
        println!("    {what:44} {:11.6} % of {all:11}, {} differ{word}", 100.0 * share, all - agreeing);
    }
}

fn main() -> ExitCode {
    let size = std::env::args().skip(1).find_map(|argument| argument.parse().ok()).unwrap_or(512);
    let driver = match open_cuda(None) {
        Ok(driver) => driver,
        Err(error) => {
            println!("no device to compare with: {error}");
            return ExitCode::FAILURE;
        }
    };
    let cuda = Cuda::new(driver);
    let mut verdict = Verdict { held: true };
    println!("{size}x{size}, CPU compared with {}", cuda.name());
    for case in cases() {
        for acceleration in [Acceleration::Bvh, Acceleration::Grid(None)] {
            if let Err(error) = compare(&cuda, &case, &acceleration, size, &mut verdict) {
                println!("    {error}");
                return ExitCode::FAILURE;
            }
        }
    }
    if verdict.held { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn compare(
    cuda: &Cuda<Driver>,
    case: &Case,
    acceleration: &Acceleration,
    size: u32,
    verdict: &mut Verdict,
) -> Result<(), RenderError> {
    let scene = PreparedScene::new(&case.scene, acceleration, &Unobserved)?;
    println!("{}, {}", case.scene.name, scene.geometry.accelerator.name());
    stages(cuda, case, &scene, size, verdict)?;
    for mode in [Mode::RayTrace, Mode::LightMesh, Mode::Area] {
        let settings = Settings::default()
            .with_aa(1)
            .with_mode(mode)
            .with_size([size, size])
            .with_step(Step::Fixed(case.step))
            .with_radius(3.1)
            .with_bounces(1)
            .with_samples(16);
        let host = render_on(&Cpu, &scene, &settings, &Unobserved)?;
        let device = render_on(cuda, &scene, &settings, &Unobserved)?;
        let again = render_on(cuda, &scene, &settings, &Unobserved)?;
        let name = mode.name();
        let pixels = u64::from(size) * u64::from(size);
        verdict.share(&format!("{name}: pixels within 1/255"), near(&host, &device), pixels, 0.9999);
        verdict.share(&format!("{name}: pixels equal when rendered again"), equal(&device, &again), pixels, 1.0);
    }
    Ok(())
}

/// Hits and masks of camera rays.
fn stages(
    cuda: &Cuda<Driver>,
    case: &Case,
    scene: &PreparedScene,
    size: u32,
    verdict: &mut Verdict,
) -> Result<(), RenderError> {
    let camera = case.scene.cameras.first().cloned().unwrap_or_else(|| case.scene.default_camera(Default::default()));
    let view = View::new(&camera, [size, size]);
    let sampling = Sampling { samples: 4, seed: 0, spread: false };
    let context = |short_tests| RenderContext::new(&Unobserved, sampling).with_short_tests(short_tests);
    let (by_cell, plain) = (context(ShortTests::Cells), context(ShortTests::Plain));
    let rays = Cpu.camera_rays(&view, 0..size, 0)?;
    let hits = Cpu.primary_rays(&by_cell, scene, &rays)?;
    let device_rays = cuda.camera_rays(&view, 0..size, 0)?;
    let device_scene = cuda.scene(&by_cell, scene, None)?;
    let device_hits = cuda.primary_rays(&by_cell, &device_scene, &device_rays)?;

    let found = device_hits.read()?;
    let twins = || hits.iter().zip(&rays.pixels).map(|(hit, &pixel)| (hit, &found[pixel as usize]));
    let same = |(a, b): &(&Hit, &Hit)| a.triangle == b.triangle && (a.t == b.t || (a.t - b.t).abs() <= 1e-5 * a.t);
    let all = hits.len() as u64;
    verdict.share("hits agree", twins().filter(same).count() as u64, all, 0.99999);
    println!("    {:44} {:11.6} %", "hits identical", {
        100.0 * twins().filter(|(a, b)| bits(a) == bits(b)).count() as f64 / all as f64
    });

    for radius in [2.1, 3.1] {
        let mesh = LightMesh {
            lattice: Lattice::around(scene, case.step, radius)?,
            template: Template::new(radius)?,
            radius: radius * case.step,
            weight: Weight::Smooth,
        };
        let wave = Wave { context: &by_cell, scene, rays: &rays, hits: &hits, lights: LightGroup::ALL, parts: 1 };
        let cells = Cpu.cells(&wave, &mesh)?;
        let masks = Cpu.short_tests(&wave, &cells, &mesh)?;
        let mut expected = vec![Vec::new(); hits.len()];
        for (slot, &ray) in cells.members().iter().enumerate() {
            expected[rays.pixels[ray as usize] as usize] = masks.mask(slot).to_vec();
        }
        let on_device = |context| Wave {
            context,
            scene: &device_scene,
            rays: &device_rays,
            hits: &device_hits,
            lights: LightGroup::ALL,
            parts: 1,
        };
        let device_cells = cuda.cells(&on_device(&by_cell), &mesh)?;
        let masks_of = |context| cuda.short_tests(&on_device(context), &device_cells, &mesh)?.read(&device_cells);
        let (device, oracle) = (masks_of(&by_cell)?, masks_of(&plain)?);
        let points = mesh.template.len() as u64 * device.len() as u64;
        let differing =
            |a: &[u32], b: &[u32]| -> u64 { a.iter().zip(b).map(|(a, b)| u64::from((a ^ b).count_ones())).sum() };
        let host: u64 = device.iter().map(|(ray, _, mask)| differing(mask, &expected[*ray as usize])).sum();
        verdict.share(&format!("mask bits agree, R = {radius}"), points - host, points, 0.99999);
        let own: u64 = device.iter().zip(&oracle).map(|(a, b)| differing(&a.2, &b.2)).sum();
        verdict.share(&format!("mask bits by cell equal to plain, R = {radius}"), points - own, points, 1.0);
    }
    Ok(())
}

fn bits(hit: &Hit) -> [u32; 4] {
    [hit.t.to_bits(), hit.u.to_bits(), hit.v.to_bits(), hit.triangle]
}

/// Pixels whose 8-bit colours differ by at most one.
fn near(a: &Frame, b: &Frame) -> u64 {
    let near = |a: f32, b: f32| Transfer::Srgb.encode(a).abs_diff(Transfer::Srgb.encode(b)) <= 1;
    count(a, b, |a, b| a.iter().zip(b).all(|(&a, &b)| near(a, b)))
}

/// Pixels with the same bits.
fn equal(a: &Frame, b: &Frame) -> u64 {
    count(a, b, |a, b| a.map(f32::to_bits) == b.map(f32::to_bits))
}

fn count(a: &Frame, b: &Frame, alike: impl Fn(&[f32; 3], &[f32; 3]) -> bool) -> u64 {
    a.image.color().iter().zip(b.image.color()).filter(|(a, b)| alike(a, b)).count() as u64
}
