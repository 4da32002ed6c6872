//! Where finished frames go: to their files, or into a movie, and into the manifest.

use std::sync::Arc;
use std::time::Instant;

use super::movie::Movie;
use super::{Film, FrameRange, FrameRenderer, RenderedFrame};
use crate::context::{Context, Prepared};
use crate::error::{Error, RequestError};
use crate::expose::Metering;
use crate::files::PictureFiles;
use crate::host::FrameDone;
use crate::manifest::Manifest;
use crate::plan::Plan;
use crate::save::save;
use crate::words::Name;

/// A failure in a frame.
pub(crate) struct InFrame {
    pub(crate) number: u32,
    pub(crate) cause: Box<Error>,
}

impl InFrame {
    pub(crate) fn new(number: u32, cause: Error) -> InFrame {
        InFrame { number, cause: cause.into() }
    }
}

/// Begins a film with files: what is finished is taken out of `range`. Exposure and step hold for all frames.
pub(crate) fn begin(
    prepared: &Prepared,
    range: &mut FrameRange,
    context: Context,
) -> Result<(FrameRenderer, FrameWriter), Error> {
    let (plan, host) = (Arc::clone(&prepared.plan), context.host);
    let film = plan.film.as_ref().ok_or(RequestError::NoFilm)?;
    let mut manifest = Manifest::begin(&plan.order, film, &prepared.scene.scene, range, host)?;
    let display = plan.files.options.display;
    let movie = plan.files.movie.map(|container| Movie::begin(&plan.order, container, display, host)).transpose()?;
    let begin = Instant::now();
    let mut renderer = FrameRenderer::new(prepared, range, context)?;
    // A request to end leaves time to record what is finished.
    host.cancellable(|| -> Result<(), Error> {
        if manifest.chosen().is_none() && !range.numbers.is_empty() {
            manifest.choose(renderer.chosen_across(context)?);
        }
        Ok(())
    })?;
    renderer.keep(manifest.chosen().unwrap_or_default());
    let metering = renderer.metering().clone();
    let writer = FrameWriter { plan, metering, range: range.clone(), manifest, movie, begin, finished: 0 };
    Ok((renderer, writer))
}

/// The files of a frame.
pub(super) fn files_of(plan: &Plan, number: u32) -> Result<PictureFiles, Error> {
    let film = plan.film.as_ref().ok_or(RequestError::NoFilm)?;
    Ok(film.files(&plan.order, number)?)
}

/// Where finished frames go.
pub(crate) struct FrameWriter {
    plan: Arc<Plan>,
    metering: Metering,
    range: FrameRange,
    manifest: Manifest,
    movie: Option<Movie>,
    pub(super) begin: Instant,
    /// Frames that are written.
    finished: usize,
}

impl FrameWriter {
    /// Renders a frame and writes its files, one after the other.
    pub(crate) fn next(
        &mut self,
        number: u32,
        renderer: &mut FrameRenderer,
        context: Context,
    ) -> Result<RenderedFrame, Error> {
        let files = files_of(&self.plan, number)?;
        let mut rendered = renderer.render(number, context)?;
        self.put(&mut rendered, &files, context)?;
        Ok(rendered)
    }

    /// Writes the files of a frame, and records that they are there.
    pub(super) fn write(
        &mut self,
        rendered: &mut RenderedFrame,
        files: &PictureFiles,
        context: Context,
    ) -> Result<(), InFrame> {
        let number = rendered.number;
        self.put(rendered, files, context).map_err(|cause| InFrame::new(number, cause))
    }

    fn put(&mut self, rendered: &mut RenderedFrame, files: &PictureFiles, context: Context) -> Result<(), Error> {
        let RenderedFrame { number, when, scene, frame, stops } = rendered;
        save(frame, *stops, files, scene, &self.metering, context)?;
        if let Some(movie) = &mut self.movie {
            movie.push(&frame.image, *stops, context.host)?;
        }
        self.manifest.finished(*number, files)?;
        self.finished += 1;
        self.report((*number, when), frame.stats.seconds.render, files, context);
        Ok(())
    }

    /// Ends the film after its last frame.
    pub(crate) fn close(mut self) -> Result<(), Error> {
        self.manifest.close()?;
        self.movie.take().map_or(Ok(()), Movie::finish)
    }

    /// Ends the film before its last frame: records which frames are finished.
    pub(crate) fn stop(mut self) -> Result<(), Error> {
        Ok(self.manifest.close()?)
    }

    /// Ends the film with a failure of a frame; returns what is told of it.
    pub(crate) fn fail(mut self, number: u32, cause: Error) -> Error {
        // What ended the film is told, not that it cannot be recorded either.
        let _ = self.manifest.close();
        // A movie is there as a whole or not at all.
        let finished = if self.is_movie() { 0 } else { self.finished + self.range.skipped };
        cause.in_frame(number, self.range.last, finished, self.goes_on())
    }

    pub(super) fn is_movie(&self) -> bool {
        self.plan.film.as_ref().is_some_and(Film::is_movie)
    }

    /// The setting that goes on with what is there.
    fn goes_on(&self) -> Name {
        if self.manifest.is_kept() { "resume" } else { "skip_existing" }
    }

    fn report(&self, (number, when): (u32, &str), seconds: f64, files: &PictureFiles, Context { host, .. }: Context) {
        let (count, kept, index) = (self.range.numbers.len(), self.range.skipped, self.finished);
        if !self.is_movie() {
            let (finished, all, goes_on) = (index + kept, count + kept, host.words().on(self.goes_on()));
            host.remark(format!("{finished} of {all} frames are finished ({goes_on} goes on)"));
        }
        host.frame(&FrameDone {
            number,
            last: self.range.last,
            when: when.to_owned(),
            index,
            count,
            kept,
            seconds,
            left: self.begin.elapsed().mul_f64((count - index) as f64 / index as f64),
            files: files.paths().map(|path| path.display().to_string()).collect(),
            picture: files.picture_name(),
        });
    }
}
