//! The frames of a film: one scene in the memory of one device, and what does not depend on the camera is kept from frame to frame.

use std::time::{Duration, Instant};

use glam::Quat;
use lightmesh::render::PreparedScene;
use lightmesh::scene::Camera;
use lightmesh::{Frame, MeshCache, RenderError, Settings, Step};

use super::exposure::Metering;
use super::movie::Movie;
use super::render::{Studio, save};
use crate::args::RenderArgs;
use crate::failure::Failure;
use crate::interrupt;
use crate::manifest::{Chosen, Ledger};
use crate::plan::{Film, Motion, PictureFiles, Work};
use crate::progress::FrameDone;

/// Renders the frames that are left, and writes the files of each as soon as it is finished.
pub(super) fn run(args: &RenderArgs, film: &Film, studio: &Studio, metering: Metering) -> Result<(), Failure> {
    let Motion::Turntable(last) = film.motion;
    let mut work = film.work(args, last)?;
    let ledger = Ledger::begin(args, film, studio.scene, &mut work, studio.watcher)?;
    let (display, watcher) = (studio.plan.files.options.display, studio.watcher);
    let movie = studio.plan.files.movie.map(|container| Movie::begin(args, container, display, watcher)).transpose()?;
    let begin = Instant::now();
    let mut reel = Reel { args, film, studio, metering, work: &work, ledger, movie, cache: MeshCache::new(), begin };
    // A request to end leaves time to record what is finished.
    interrupt::watched(|| reel.render())?;
    watcher.summary(&summary(&work, begin.elapsed(), studio));
    Ok(())
}

/// A film while it is rendered.
struct Reel<'a> {
    args: &'a RenderArgs,
    film: &'a Film,
    studio: &'a Studio<'a>,
    metering: Metering,
    work: &'a Work,
    ledger: Ledger,
    movie: Option<Movie>,
    cache: MeshCache,
    begin: Instant,
}

impl Reel<'_> {
    /// Renders all frames; whatever ends that, those that are finished are recorded.
    fn render(&mut self) -> Result<(), Failure> {
        let work = self.work;
        for (index, &number) in work.numbers.iter().enumerate() {
            let rendered = self.frame(index, number).and_then(|()| match interrupt::requested() {
                true => Err(RenderError::Cancelled.into()),
                false => Ok(()),
            });
            if let Err(cause) = rendered {
                // The first error is the one to tell.
                let _ = self.ledger.close();
                // A movie is there as a whole or not at all.
                let finished = if self.film.is_movie() { 0 } else { index + work.skipped };
                return Err(cause.in_frame(number, work.last, finished, self.flag_that_goes_on()));
            }
        }
        self.ledger.close()?;
        self.movie.take().map_or(Ok(()), Movie::finish)
    }

    /// Renders a frame and writes its files.
    fn frame(&mut self, index: usize, number: u32) -> Result<(), Failure> {
        let Studio { renderer, prepared, scene, plan, watcher, .. } = *self.studio;
        let files = self.film.files(self.args, number)?;
        let camera = turned(prepared, number, self.work.last);
        let (settings, metering) = self.chosen_by_others(number);
        let view = settings.with_camera(camera.clone());
        let cache = &mut self.cache;
        let render =
            |prepared: &PreparedScene, settings: &Settings| renderer.render_with(cache, prepared, settings, watcher);
        let (frame, stops) = self.studio.picture(&view, &metering, render)?;
        if self.ledger.chosen().is_none() {
            self.ledger.choose(Chosen { frame: number, exposure: stops, step: frame.stats.settings.step });
        }
        let frame = save(frame, stops, &files, (renderer, scene, plan), Some(&camera), &metering, watcher)?;
        if let Some(movie) = &mut self.movie {
            movie.push(&frame.image, stops)?;
        }
        self.ledger.finished(number, &files)?;
        self.tell(index, number, &frame, &files);
        Ok(())
    }

    /// The settings of a frame: with what another one has chosen.
    fn chosen_by_others(&self, number: u32) -> (Settings, Metering) {
        let (settings, metering) = (self.studio.plan.settings.clone(), self.metering.clone());
        match self.ledger.chosen().filter(|chosen| chosen.frame != number) {
            Some(Chosen { exposure, step: Some(step), .. }) => {
                (settings.with_step(Step::Fixed(step)), metering.fixed(exposure))
            }
            Some(Chosen { exposure, step: None, .. }) => (settings, metering.fixed(exposure)),
            None => (settings, metering),
        }
    }

    fn flag_that_goes_on(&self) -> &'static str {
        if self.ledger.is_kept() { "--resume" } else { "--skip-existing" }
    }

    fn tell(&self, index: usize, number: u32, frame: &Frame, files: &PictureFiles) {
        let (count, kept, index) = (self.work.numbers.len(), self.work.skipped, index + 1);
        if !self.film.is_movie() {
            let (finished, all, flag) = (index + kept, count + kept, self.flag_that_goes_on());
            interrupt::remark(format!("{finished} of {all} frames are finished ({flag} goes on)"));
        }
        self.studio.watcher.frame(&FrameDone {
            number,
            last: self.work.last,
            index,
            count,
            kept,
            seconds: frame.stats.seconds.render,
            left: self.begin.elapsed().mul_f64((count - index) as f64 / index as f64),
            files: files.paths().map(|path| path.display().to_string()).collect(),
            picture: files.picture.to_string(),
        });
    }
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
