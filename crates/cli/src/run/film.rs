//! The frames of a film: one scene in the memory of one device, and what does not depend on the camera is kept from frame to frame.

use std::time::{Duration, Instant};

use glam::Quat;
use lightmesh::render::PreparedScene;
use lightmesh::scene::Camera;
use lightmesh::{Frame, MeshCache, Observer, RenderError, Settings, Step};

use super::exposure::Metering;
use super::render::{Studio, save};
use super::sun;
use crate::args::RenderArgs;
use crate::failure::Failure;
use crate::interrupt;
use crate::plan::{Film, Motion, Work};

/// Renders the frames that are left, and writes the files of each as soon as it is finished.
pub(super) fn run(args: &RenderArgs, film: &Film, studio: &Studio, mut metering: Metering) -> Result<(), Failure> {
    let Studio { renderer, prepared, plan, watcher, .. } = *studio;
    let work = film.work(args, film.motion.last())?;
    let (begin, count) = (Instant::now(), work.numbers.len());
    let (mut cache, mut settings) = (MeshCache::new(), plan.settings.clone());
    for (index, &number) in work.numbers.iter().enumerate() {
        let files = film.files(args, number)?;
        let (moved, camera, when) = match film.motion {
            Motion::Turntable(last) => (None, turned(prepared, number, last), String::new()),
            Motion::Sun(_) => {
                let (moved, when) = sun::frame(studio, number)?;
                (Some(moved), prepared.scene.cameras[0].clone(), when)
            }
        };
        if moved.is_some() {
            // Nothing that is kept belongs to another sun.
            cache = MeshCache::new();
        }
        let moved = moved.as_ref().unwrap_or(prepared);
        let view = settings.clone().with_camera(camera.clone());
        let render = |prepared: &PreparedScene, settings: &Settings| {
            renderer.render_with(&mut cache, prepared, settings, watcher)
        };
        let (frame, stops) = Studio { prepared: moved, ..*studio }.picture(&view, &metering, render)?;
        if index == 0 {
            // What is chosen by the first frame holds for all.
            settings = kept(settings, &frame);
            metering = metering.fixed(stops);
        }
        let frame = save(frame, stops, &files, (renderer, &moved.scene, plan), Some(&camera), &metering, watcher)?;
        let seconds = frame.stats.seconds.render;
        let left = begin.elapsed().mul_f64((count - index - 1) as f64 / (index + 1) as f64);
        watcher.note(&format!(
            "frame {number} of {}{when}: {seconds:.3} s, {}{}",
            work.last,
            files.picture,
            time_left(left)
        ));
        if interrupt::requested() {
            return Err(RenderError::Cancelled.into());
        }
    }
    watcher.summary(&summary(&work, begin.elapsed(), studio));
    Ok(())
}

/// The camera of frame `number` of a turntable: that of the scene, turned about the vertical through the middle of the scene. All `last` frames
/// make one turn.
fn turned(prepared: &PreparedScene, number: u32, last: u32) -> Camera {
    let mut camera = prepared.scene.cameras[0].clone();
    if number == 1 {
        return camera;
    }
    let share = f64::from(number - 1) / f64::from(last);
    let turn = Quat::from_axis_angle(camera.up.normalize(), (std::f64::consts::TAU * share) as f32);
    let bounds = prepared.geometry.bounds;
    let middle = 0.5 * (bounds.min + bounds.max);
    camera.direction = turn * camera.direction;
    let position = middle + turn * (camera.position - middle);
    camera.with_position(position)
}

/// Settings with the step that a frame was rendered with.
fn kept(settings: Settings, frame: &Frame) -> Settings {
    match frame.stats.settings.step {
        Some(step) => settings.with_step(Step::Fixed(step)),
        None => settings,
    }
}

fn time_left(left: Duration) -> String {
    match left.as_secs() {
        0 => String::new(),
        seconds if seconds < 60 => format!(", about {seconds} s left"),
        seconds if seconds < 3600 => format!(", about {} min {} s left", seconds / 60, seconds % 60),
        seconds => format!(", about {} h {} min left", seconds / 3600, seconds % 3600 / 60),
    }
}

fn summary(work: &Work, elapsed: Duration, studio: &Studio) -> String {
    let (count, seconds) = (work.numbers.len(), elapsed.as_secs_f64());
    let skipped = match work.skipped {
        0 => String::new(),
        skipped => format!(", {skipped} left as they were"),
    };
    if count == 0 {
        return format!("no frame is missing: {} left as they were", work.skipped);
    }
    let frames = if count == 1 { "frame" } else { "frames" };
    format!(
        "{}: {count} {frames}{skipped}: {seconds:.3} s, {:.2} per second (load {:.3} s)",
        studio.scene.name,
        count as f64 / seconds,
        studio.load
    )
}
