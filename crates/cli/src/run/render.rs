//! `lightmesh render`.

use std::time::Instant;

use lightmesh::image::{self, Format};
use lightmesh::render::Choice;
use lightmesh::{Device, Frame, Observer, RenderError, Renderer, Scene};

use super::open::open;
use crate::args::RenderArgs;
use crate::failure::Failure;
use crate::plan::{PictureFiles, RenderPlan};
use crate::progress::Watcher;
use crate::report::Report;
use crate::value::Exposure;
use crate::{interrupt, output};

pub(super) fn run(args: &RenderArgs) -> Result<(), Failure> {
    let plan = RenderPlan::new(args)?;
    let watcher = Watcher::new(args.progress, args.quiet);
    let choice = Choice::of(plan.device)?;
    let reason = choice.reason.clone();
    let renderer = Renderer::on(choice, plan.threads.map(usize::from))?;
    let start = Instant::now();
    let mut scene = open(&plan.scene, &plan.files.outputs, &watcher)?;
    let load = start.elapsed().as_secs_f64();
    if matches!(plan.device, Device::Auto | Device::Cuda(None)) {
        watcher.note(&format!("device {}: using {}", plan.device, reason));
    }

    let settings = plan.settings;
    plan.choices.apply(&mut scene, &watcher)?;
    let prepared = renderer.prepare(&scene, &settings, &watcher)?;
    let mut frame = interrupt::watched(|| renderer.render_prepared(&prepared, &settings, &watcher))?;
    drop(prepared); // frees memory for the encoders
    if watcher.cancelled() {
        return Err(RenderError::Cancelled.into());
    }

    frame.stats.seconds.load = load;
    let odd = frame.stats.counts.non_finite_pixels;
    if odd > 0 {
        let of = frame.stats.counts.pixels;
        watcher.warning(&format!(
            "{odd} of {of} pixels have infinite or undefined colours: lower the intensities of lights or the coefficients of materials"
        ));
    }
    write(&mut frame, &scene, &plan.files, &watcher)?;
    watcher.summary(&summary(&frame, &plan.files));
    Ok(())
}

/// Writes all files, which appear together; the statistics last, because they include the time taken by the others.
fn write(frame: &mut Frame, scene: &Scene, files: &PictureFiles, watcher: &Watcher) -> Result<(), Failure> {
    let start = Instant::now();
    let mut outputs = Vec::new();
    if let Some(path) = &files.layers {
        outputs.push(frame.image.ready_layers(path)?);
    }
    let stops = exposure(&frame.image, files, watcher);
    if stops != 0.0 {
        frame.image.expose(stops);
    }
    outputs.push(frame.image.ready(&files.picture, files.transfer)?);
    frame.stats.seconds.write = start.elapsed().as_secs_f64();
    if let Some(path) = &files.stats {
        let lights = scene.info().lights;
        let report = Report::new(&frame.stats, files.transfer.name(), stops, &lights);
        outputs.push(output::ready(path, output::json(&report).as_bytes())?);
    }
    Ok(output::publish(outputs)?)
}

/// Exposure of the image file: none if it stores linear values.
fn exposure(image: &image::Frame, files: &PictureFiles, watcher: &Watcher) -> f32 {
    match files.exposure {
        _ if Format::from_path(&files.picture) == Some(Format::Exr) => 0.0,
        Exposure::Stops(stops) => stops,
        Exposure::Auto => {
            let stops = image.auto_exposure();
            watcher.note(&format!("exposure auto: using {stops} stops (--exposure {stops} keeps this value)"));
            stops
        }
    }
}

fn summary(frame: &Frame, files: &PictureFiles) -> String {
    let (settings, seconds) = (&frame.stats.settings, &frame.stats.seconds);
    let [width, height] = settings.size;
    format!(
        "{}, {width}x{height}, {}: {:.3} s (load {:.3} s, build {:.3} s, write {:.3} s), {}",
        frame.stats.scene.name,
        settings.mode,
        seconds.render,
        seconds.load,
        seconds.build,
        seconds.write,
        files.picture.display()
    )
}
