//! All measurements of the suite, most important first: those that get no time are at the end.

use lightmesh::Lookup;

use super::experiments::{AREA_SHADOWS, LIGHTS, PICTURES, TIMINGS};
use super::published::{
    AREA_SAMPLES, FIGURE_SCENE, GARDEN_LIGHTS, LIGHTS_RADIUS, PICTURE_RADII, RADII, SCENES, SIZES, STEP_PARTS,
    SceneOfThesis,
};
use super::task::{Picture, Task, scene_with_lights};
use crate::Plan;
use crate::engine::Engine;

/// Numbers of lights of figure 11.
const LIGHT_COUNTS: [u32; 7] = [1, 2, 4, 8, 16, 32, 64];
/// The same in the short version.
const QUICK_LIGHT_COUNTS: [u32; 4] = [1, 4, 16, 64];
/// Pixels along a side for figure 11, and in the short version.
const LIGHTS_SIDES: [u32; 2] = [2048, 512];
/// Pixels along a side of images that are kept, and in the short version.
const PICTURE_SIDES: [u32; 2] = [384, 256];

/// All tasks. `engines` has the fastest device first; a single thread, if among them, only gets the timings.
pub(super) fn tasks(plan: &Plan, engines: &[Engine]) -> Vec<Task> {
    let one_thread = |engine: usize| engine > 0 && engines[engine].thread_count == Some(1);
    let (slow, fast): (Vec<usize>, Vec<usize>) = (0..engines.len()).partition(|&engine| one_thread(engine));
    let mut tasks = area_shadows(plan, engines, 0);
    tasks.push(pictures(plan, engines, 0));
    for engine in fast {
        tasks.extend(timings(plan, engines, engine));
        tasks.extend(lights(plan, engines, engine));
    }
    for engine in slow {
        tasks.extend(timings(plan, engines, engine));
    }
    tasks
}

/// Sizes of the timings: only the smaller one in the short version.
pub(super) fn sizes(plan: &Plan) -> &'static [u32] {
    if plan.quick { &SIZES[..1] } else { &SIZES }
}

/// The 24 cells of the tables, hard shadows, and Garden with more lights.
fn timings(plan: &Plan, engines: &[Engine], engine: usize) -> Vec<Task> {
    let more_lights = SceneOfThesis { lights: GARDEN_LIGHTS, ..SCENES[2] };
    let scenes: Vec<SceneOfThesis> = SCENES.into_iter().chain([more_lights]).collect();
    let cells = sizes(plan).iter().flat_map(|&size| scenes.iter().map(move |&scene| (size, scene)));
    cells.map(|(size, scene)| timing(plan, engines, engine, size, scene)).collect()
}

fn timing(plan: &Plan, engines: &[Engine], engine: usize, size: u32, scene: SceneOfThesis) -> Task {
    let SceneOfThesis { name, lights, step } = scene;
    let picture = Picture { experiment: TIMINGS, scene: name, lights, side: plan.side(size), engine: &engines[engine] };
    let method = STEP_PARTS.into_iter().flat_map(|part| RADII.map(|radius| (part * step, radius)));
    let method = method.map(|(step, radius)| picture.light_mesh(step, radius));
    Task {
        scene: scene_with_lights(name, lights),
        engine,
        repetitions: plan.repetitions,
        cases: std::iter::once(picture.ray_trace()).chain(method).collect(),
    }
}

/// Figure 11: the method and hard shadows against the number of lights.
fn lights(plan: &Plan, engines: &[Engine], engine: usize) -> Vec<Task> {
    let counts: &[u32] = if plan.quick { &QUICK_LIGHT_COUNTS } else { &LIGHT_COUNTS };
    let side = plan.side(LIGHTS_SIDES[usize::from(plan.quick)]);
    let SceneOfThesis { name, step, .. } = FIGURE_SCENE;
    let task = |&lights: &u32| {
        let picture = Picture { experiment: LIGHTS, scene: name, lights, side, engine: &engines[engine] };
        Task {
            scene: scene_with_lights(name, lights),
            engine,
            repetitions: plan.repetitions,
            cases: vec![picture.light_mesh(step, LIGHTS_RADIUS), picture.ray_trace()],
        }
    };
    counts.iter().map(task).collect()
}

/// Figure 1: area shadows. The one with the most samples, the reference of all images, is a separate, first task. Occluder lists and
/// adaptive shadow rays have as many.
fn area_shadows(plan: &Plan, engines: &[Engine], engine: usize) -> Vec<Task> {
    let picture = kept_picture(plan, engines, engine, AREA_SHADOWS);
    let cases = AREA_SAMPLES.map(|samples| {
        let mut case = picture.area(samples);
        case.title = Some(format!("area shadows, {samples} per light"));
        case
    });
    let scene = scene_with_lights(picture.scene, picture.lights);
    let [reference, few, more] = cases;
    let [lists, adaptive] =
        [(Lookup::Lists, "occluder lists"), (Lookup::Adaptive, "adaptive shadow rays")].map(|(lookup, title)| {
            let mut case = picture.lookup(lookup, AREA_SAMPLES[0]);
            case.title = Some(format!("{title}, {} samples per light", AREA_SAMPLES[0]));
            case
        });
    // It takes long, and only its image is needed.
    let once = Task { scene: scene.clone(), engine, repetitions: 1, cases: vec![reference] };
    vec![once, Task { scene, engine, repetitions: plan.repetitions, cases: vec![few, more, lists, adaptive] }]
}

/// Figures 12 to 15: images for growing R.
fn pictures(plan: &Plan, engines: &[Engine], engine: usize) -> Task {
    let picture = kept_picture(plan, engines, engine, PICTURES);
    let case = |radius: f64| {
        let mut case = picture.light_mesh(FIGURE_SCENE.step, radius);
        case.title = Some(format!("light mesh, R = {radius}"));
        case
    };
    let cases = PICTURE_RADII.map(case).into();
    let scene = scene_with_lights(picture.scene, picture.lights);
    Task { scene, engine, repetitions: plan.repetitions, cases }
}

fn kept_picture<'a>(plan: &Plan, engines: &'a [Engine], engine: usize, experiment: &'static str) -> Picture<'a> {
    let SceneOfThesis { name, lights, .. } = FIGURE_SCENE;
    let side = plan.side(PICTURE_SIDES[usize::from(plan.quick)]);
    Picture { experiment, scene: name, lights, side, engine: &engines[engine] }
}
