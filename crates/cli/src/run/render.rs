//! `lightmesh render`.

use std::time::Instant;

use glam::{DMat4, DVec3, Vec3};
use lightmesh::image::{self, Description, Format, Ready, SaveOptions};
use lightmesh::render::{Choice, PreparedScene, Stats, devices};
use lightmesh::scene::Camera;
use lightmesh::{Device, Frame, Observer, RenderError, Renderer, SaveError, Scene, Settings};
use lightmesh_memory::Bytes;

use super::exposure::{Metering, exposure};
use super::mesh_file::Mesh;
use super::{BUILDING, film, movie, open::open, range, sun};
use crate::args::RenderArgs;
use crate::failure::Failure;
use crate::plan::scene::Applied;
use crate::plan::{PictureFiles, RenderPlan};
use crate::progress::Watcher;
use crate::report::Report;
use crate::value::Exposure;
use crate::{interrupt, memory, output};

pub(super) fn run(args: &RenderArgs) -> Result<(), Failure> {
    let plan = RenderPlan::new(args)?;
    if let Some(container) = plan.files.movie {
        movie::check(args, container)?;
    }
    let watcher = Watcher::new(args.progress, args.quiet);
    let choice = Choice::of(plan.device).inspect_err(|_| explain_devices(args, &watcher))?;
    let using = using(&choice, args.verbose);
    let renderer = Renderer::on(choice, plan.threads.map(usize::from))?;
    let start = Instant::now();
    let animation = args.form.animation.as_deref();
    let mut scene = open(&plan.scene, plan.meshes(), animation, &plan.files.outputs, &watcher)?;
    let work = plan.film.as_ref().map(|film| film.work(args, &scene)).transpose()?;
    let load = start.elapsed().as_secs_f64();
    if matches!(plan.device, Device::Auto | Device::Cuda(None)) {
        watcher.note(&format!("device {}: using {using}", plan.device));
    }
    if let Some(crease) = plan.smooth.filter(|_| args.verbose) {
        let (made, degrees) = (scene.smooth_normals, crease.degrees());
        watcher.note(&format!("smooth {degrees}: made {made} normals (--smooth off shows facets)"));
    }

    if let Some(file) = plan.choices.file() {
        plan.files.outputs.keep("the environment", Some(file))?;
    }
    let applied = plan.choices.apply(&mut scene, &watcher)?;
    let metering = metering(&mut scene, &plan, &applied);
    let prepared = memory::during(BUILDING, || renderer.prepare(&scene, &plan.settings, &watcher))?;
    film::explain(&scene, plan.film.is_some(), &watcher);
    let studio =
        Studio { renderer: &renderer, prepared: &prepared, scene: &scene, plan: &plan, load, watcher: &watcher };
    if let Some(study) = &plan.sun {
        sun::hours(&studio, study)?;
    }
    match (&plan.film, work) {
        (Some(film), Some(work)) => return film::run(args, film, work, &studio, metering),
        _ if plan.sun.is_some() => return Ok(()),
        _ => {}
    }
    let mesh = Mesh::open(&plan, (&renderer, &prepared), false, &watcher)?;
    let finish = || finish(&renderer, (prepared, mesh), &scene, &plan, &metering, load, &watcher);
    let frame = if args.image.partial { interrupt::keeping(finish) } else { finish() }?;
    if interrupt::requested() {
        // The last message says what is written.
        return Ok(());
    }
    if args.verbose {
        details(&frame.stats).iter().for_each(|line| watcher.note(line));
    }
    watcher.summary(&summary(&frame, &plan.files));
    Ok(())
}

/// How the image is exposed: not at all if its file stores linear values.
fn metering(scene: &mut Scene, plan: &RenderPlan, applied: &Applied) -> Metering {
    let is_linear = plan.files.format() == Some(Format::Exr);
    let exposure = if is_linear { Exposure::Stops(0.0) } else { exposure(scene, plan.files.exposure, applied.indoors) };
    Metering::new(scene, exposure, plan.settings.transparent, applied.behind)
        .of_highlights(applied.outdoors && !is_linear, plan.files.exposure)
}

/// The device that was chosen. That no CUDA device was, is only said where one could be expected, or to those who ask.
fn using(choice: &Choice, verbose: bool) -> String {
    let why = match &choice.no_cuda {
        Some(why) if verbose => format!("; no CUDA device can be used: {why}"),
        Some(_) if choice.misses_cuda => "; no CUDA device (-v says why)".to_owned(),
        _ => String::new(),
    };
    format!("{}{why}", choice.reason)
}

/// All that is known of devices that cannot be used, for those who ask.
fn explain_devices(args: &RenderArgs, watcher: &Watcher) {
    if args.verbose {
        let unusable = devices().into_iter().filter(|report| !report.usable);
        unusable.for_each(|report| watcher.note(&format!("device {}: not usable: {}", report.device, report.remark)));
    }
}

/// What an image is made with.
pub(super) struct Studio<'a> {
    pub(super) renderer: &'a Renderer,
    pub(super) prepared: &'a PreparedScene,
    pub(super) scene: &'a Scene,
    pub(super) plan: &'a RenderPlan,
    pub(super) load: f64,
    pub(super) watcher: &'a Watcher,
}

/// Renders the image and writes all files.
fn finish(
    renderer: &Renderer,
    (prepared, mut mesh): (PreparedScene, Mesh),
    scene: &Scene,
    plan: &RenderPlan,
    metering: &Metering,
    load: f64,
    watcher: &Watcher,
) -> Result<Frame, Failure> {
    let studio = Studio { renderer, prepared: &prepared, scene, plan, load, watcher };
    let has_file = mesh.has_file();
    let render = |prepared: &PreparedScene, settings: &Settings| match has_file {
        true => renderer.render_with(&mut mesh.cache, prepared, settings, watcher),
        false => renderer.render_prepared(prepared, settings, watcher),
    };
    let (frame, stops) = studio.picture(&plan.settings, metering, render)?;
    mesh.check(watcher);
    if !watcher.cancelled() {
        mesh.save(&prepared, watcher)?;
    }
    drop((prepared, mesh)); // frees memory for the encoders
    save(frame, stops, &plan.files, (renderer, scene, plan), scene.cameras.first(), metering, watcher)
}

impl Studio<'_> {
    /// Renders an image by `render`; also returns its exposure in stops.
    pub(super) fn picture(
        &self,
        settings: &Settings,
        metering: &Metering,
        mut render: impl FnMut(&PreparedScene, &Settings) -> Result<Frame, RenderError> + Send,
    ) -> Result<(Frame, f32), Failure> {
        let Studio { prepared, plan, load, watcher, .. } = *self;
        let (mut frame, stops) = metering.picture(prepared, settings, watcher, |prepared, settings| {
            memory::during(memory::RENDERING, || interrupt::watched(|| render(prepared, settings)))
        })?;
        if plan.settings.partial {
            interrupt::remark(rows(&frame));
        } else if watcher.cancelled() {
            return Err(RenderError::Cancelled.into());
        }
        frame.stats.seconds.load = load;
        Ok((frame, stops))
    }
}

/// Writes all files of an image.
pub(super) fn save(
    mut frame: Frame,
    stops: f32,
    files: &PictureFiles,
    (renderer, scene, plan): (&Renderer, &Scene, &RenderPlan),
    camera: Option<&Camera>,
    metering: &Metering,
    watcher: &Watcher,
) -> Result<Frame, Failure> {
    let odd = frame.stats.counts.non_finite_pixels;
    if odd > 0 {
        let of = frame.stats.counts.pixels;
        let text = format!(
            "{odd} of {of} pixels have infinite or undefined colours: lower the intensities of lights or the coefficients of materials"
        );
        watcher.warning_about("non-finite", &text);
    }
    if files.format() != Some(Format::Exr) {
        let display = files.options.display.with_exposure(stops);
        let warnings = range::warnings(&frame, &display, metering.has_ground());
        warnings.iter().for_each(|(what, text)| watcher.warning_about(what, text));
    }
    let mut options = files.options.clone().with_description(describe(&frame, scene.to_world(Vec3::ZERO), camera));
    options.display.exposure = stops;
    memory::during("writing the image", || write(renderer, &mut frame, scene, (plan, files), &options))?;
    Ok(frame)
}

/// How much of an image is finished.
fn rows(frame: &Frame) -> String {
    let ([_, height], finished) = (frame.size(), frame.finished_rows());
    let finished = if finished == height { "all".to_owned() } else { format!("{finished} of") };
    format!("{finished} {height} rows are finished")
}

/// Seconds of each stage, counts, and memory, by their names in `--stats`.
fn details(stats: &Stats) -> Vec<String> {
    let of = |what: &str, values: serde_json::Value, unit: &dyn Fn(f64) -> String| {
        let known = values.as_object().into_iter().flatten();
        let parts =
            known.filter_map(|(name, value)| value.as_f64().filter(|value| *value > 0.0).map(|value| (name, value)));
        let parts: Vec<String> = parts.map(|(name, value)| format!("{name} {}", unit(value))).collect();
        format!("{what}: {}", parts.join(", "))
    };
    vec![
        of("seconds", serde_json::json!(stats.seconds), &|value| format!("{value:.4}")),
        of("counts", serde_json::json!(stats.counts), &|value| format!("{value}")),
        of("memory", serde_json::json!(stats.memory), &|value| Bytes(value as u64).to_string()),
    ]
}

/// Writes all files, which appear together; the statistics last, because they include the time taken by the others.
fn write(
    renderer: &Renderer,
    frame: &mut Frame,
    scene: &Scene,
    (plan, files): (&RenderPlan, &PictureFiles),
    options: &SaveOptions,
) -> Result<(), Failure> {
    let start = Instant::now();
    let mut outputs = renderer.install(|| encode(&frame.image, files, options))?;
    frame.stats.seconds.write = start.elapsed().as_secs_f64();
    if let Some(destination) = &files.stats {
        let lights = scene.info().lights;
        let report = Report::new(&frame.stats, plan, options, &lights);
        outputs.push(destination.ready(output::json(&report).as_bytes())?);
    }
    Ok(output::publish(outputs)?)
}

/// The image and the layers, encoded at the same time: while one waits for the disk, the other is compressed.
fn encode(image: &image::Frame, files: &PictureFiles, options: &SaveOptions) -> Result<Vec<Ready>, SaveError> {
    let picture = Some(&files.picture).filter(|_| files.movie.is_none());
    let (picture, layers) = rayon::join(
        || picture.map(|picture| image.ready_to(picture.open()?, options)).transpose(),
        || files.layers.as_ref().map(|layers| image.ready_layers_to(layers.open()?, options)).transpose(),
    );
    Ok(layers?.into_iter().chain(picture?).collect())
}

/// Settings that say nothing about an image: the machine, and ways to the same result.
const MACHINE: [&str; 6] = ["device", "threads", "memory_limit", "rows_per_band", "accel", "short_tests"];

/// What exr files say about an image of a scene whose local frame lies at `origin`.
pub(crate) fn describe(frame: &Frame, origin: DVec3, camera: Option<&Camera>) -> Description {
    let mut settings = serde_json::json!(frame.stats.settings);
    // The bytes of an image do not depend on the machine.
    if let Some(settings) = settings.as_object_mut() {
        MACHINE.iter().for_each(|&name| drop(settings.remove(name)));
    }
    let description = Description::default()
        .with_software(concat!("Lightmesh ", env!("CARGO_PKG_VERSION")))
        .with_scene(&*frame.stats.scene.name)
        .with_settings(settings.to_string());
    let Some(camera) = camera else { return description };
    let [width, height] = frame.stats.settings.size.map(f64::from);
    // Columns of a matrix for column vectors are rows of one for row vectors.
    let rows = |matrix: DMat4| matrix.as_mat4().to_cols_array();
    description.with_camera(rows(camera.from_world(origin)), rows(camera.from_world_to_image(origin, width / height)))
}

fn summary(frame: &Frame, files: &PictureFiles) -> String {
    let (settings, seconds) = (&frame.stats.settings, &frame.stats.seconds);
    let [width, height] = settings.crop.map_or(settings.size, |[_, _, width, height]| [width, height]);
    format!(
        "{}, {width}x{height}, {}: {:.3} s (load {:.3} s, build {:.3} s, write {:.3} s), {}",
        frame.stats.scene.name,
        settings.mode,
        seconds.render,
        seconds.load,
        seconds.build,
        seconds.write,
        files.picture
    )
}
