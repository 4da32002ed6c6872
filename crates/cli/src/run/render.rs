//! `lightmesh render`.

use std::time::Instant;

use lightmesh::render::{Stats, devices};
use lightmesh::request::film::FrameRange;
use lightmesh::request::film::check_encoder;
use lightmesh::request::{Error, Part, Plan, RequestError, Session, Warm, WarmDevices};
use lightmesh::{Device, Frame, Observer, Renderer};
use lightmesh_memory::Bytes;

use super::open::{opened, read};
use crate::args::RenderArgs;
use crate::failure::{Failure, INTERRUPTED};
use crate::job::{Job, Told};
use crate::progress::Watcher;
use crate::{interrupt, server};

/// The share of a day's film and hours that the hours take, more or less.
const HOURS: f64 = 0.1;

/// Returns the exit code, which is that of the server if there is one.
pub(super) fn run(args: &RenderArgs) -> Result<u8, Failure> {
    let job = Job::of(args);
    match &args.server {
        Some(path) => server::render(path, &job).inspect_err(|error| tell_of(error, &job)),
        None => render(&job, &mut Warm::default()).map(|()| 0),
    }
}

/// Does a job with what is warm.
pub(crate) fn render(job: &Job, warm: &mut Warm) -> Result<(), Failure> {
    let watcher = Watcher::new(job.told.progress, job.told.quiet);
    let done = work(job.clone(), warm, &watcher);
    done.inspect_err(|error| tell(error, &watcher))
}

/// Tells that a job has failed before there was a watcher.
fn tell_of(error: &Failure, job: &Job) {
    tell(error, &Watcher::new(job.told.progress, job.told.quiet));
}

/// Tells that a job has failed; one that was cancelled has not.
fn tell(error: &Failure, watcher: &Watcher) {
    if error.exit_code() != INTERRUPTED {
        watcher.failed(error);
    }
}

fn work(Job { order, told }: Job, warm: &mut Warm, watcher: &Watcher) -> Result<(), Failure> {
    // The parser lets that pass for a day alone, of which there is more than one output.
    if order.files.output.is_none() && order.files.sun_hours.is_empty() {
        return Err(RequestError::NothingOfSun.into());
    }
    let plan = Plan::new(order)?;
    if let Some(container) = plan.files.movie {
        check_encoder(&plan.order, container).map_err(Error::from)?;
    }
    let device = plan.order.request.device;
    let devices = warm.devices(&plan).inspect_err(|_| explain_devices(told, watcher))?;
    let (using, renderer) = (using(&devices, told.verbose), &*devices.renderer);
    let start = Instant::now();
    let scene = (&*plan.order.scene, plan.order.request.scene_format);
    let read = || read(scene, &plan.load_options());
    let scene = opened(&plan.order.scene, || warm.scene(&plan, read), &plan.files.outputs, watcher)?;
    let range = plan.range(&scene)?;
    let load = start.elapsed().as_secs_f64();
    if matches!(device, Device::Auto | Device::Cuda(None) | Device::Several(_)) {
        watcher.note(&format!("device {device}: using {using}"));
    }
    if let Some(crease) = plan.smooth.filter(|_| told.verbose) {
        let (made, degrees) = (scene.smooth_normals, crease.degrees());
        watcher.note(&format!("smooth {degrees}: made {made} normals (--smooth off shows facets)"));
    }
    let session = warm.session(renderer, plan, scene, load, watcher)?;
    if let Some(range) = range {
        return film(&session, range, renderer, watcher);
    }
    if let Some(done) = session.write_sun_hours(renderer, watcher)? {
        watcher.summary(&done);
    }
    if session.plan().sun.is_some() {
        return Ok(());
    }
    picture(session, told, renderer, watcher)
}

/// Renders the frames of a film, after the hours of direct sun if these are asked for, too.
fn film(session: &Session, range: FrameRange, renderer: &Renderer, watcher: &Watcher) -> Result<(), Failure> {
    let start = Instant::now();
    let has_hours = session.plan().sun.as_ref().is_some_and(|study| !study.outputs.is_empty());
    let hours = if has_hours { HOURS } else { 0.0 };
    if let Some(done) = session.write_sun_hours(renderer, &Part::new(watcher, [0.0, hours], 0.0))? {
        watcher.note(&done);
    }
    let part = Part::new(watcher, [hours, 1.0], start.elapsed().as_secs_f64());
    watcher.summary(&session.write_film(range, renderer, &part)?);
    Ok(())
}

/// Renders the picture and writes its files.
fn picture(session: Session, told: Told, renderer: &Renderer, watcher: &Watcher) -> Result<(), Failure> {
    let is_partial = session.plan().settings.partial;
    let picture = session.plan().files.picture_name();
    let write = || session.write_picture(renderer, watcher).map_err(Failure::from);
    let frame = if is_partial { interrupt::keeping(write) } else { write() }?;
    if interrupt::requested() {
        // The last message says what is written.
        return Ok(());
    }
    if told.verbose {
        details(&frame.stats).iter().for_each(|line| watcher.note(line));
    }
    watcher.summary(&summary(&frame, &picture));
    Ok(())
}

/// The device that was chosen. That no CUDA device was, is only said where one could be expected, or to those who ask.
fn using(devices: &WarmDevices, verbose: bool) -> String {
    let why = match &devices.no_cuda {
        Some(why) if verbose => format!("; no CUDA device can be used: {why}"),
        Some(_) if devices.misses_cuda => "; no CUDA device (-v says why)".to_owned(),
        _ => String::new(),
    };
    format!("{}{why}", devices.reason)
}

/// All that is known of devices that cannot be used, for those who ask.
fn explain_devices(told: Told, watcher: &Watcher) {
    if told.verbose {
        let unusable = devices().into_iter().filter(|report| !report.usable);
        unusable.for_each(|report| watcher.note(&format!("device {}: not usable: {}", report.device, report.remark)));
    }
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

fn summary(frame: &Frame, picture: &str) -> String {
    let (settings, seconds) = (&frame.stats.settings, &frame.stats.seconds);
    let [width, height] = frame.size();
    let method = settings.lookup.unwrap_or(settings.mode);
    format!(
        "{}, {width}x{height}, {method}: {:.3} s (load {:.3} s, build {:.3} s, write {:.3} s), {}",
        frame.stats.scene.name, seconds.render, seconds.load, seconds.build, seconds.write, picture
    )
}
