//! A film is written frame by frame, each as soon as it is finished, while the next one is rendered.

use std::sync::mpsc::{self, SyncSender};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Instant;

use lightmesh_render::RenderError;

use super::movie::Movie;
use super::{Film, FrameRange, FrameRenderer, RenderedFrame, summary};
use crate::context::{Context, Prepared};
use crate::error::{Error, RequestError};
use crate::expose::Metering;
use crate::files::PictureFiles;
use crate::host::{FrameDone, Parts};
use crate::manifest::Manifest;
use crate::plan::Plan;
use crate::save::save;
use crate::words::Name;

/// Frames that are rendered and wait to be written, besides the one that is.
const WAITING: usize = 1;

/// A failure in a frame.
type InFrame = Box<(u32, Error)>;

/// A frame that is rendered.
struct Finished {
    rendered: RenderedFrame,
    files: PictureFiles,
    /// Ends with the frame.
    _in_memory: InMemory,
}

/// The frames that are rendered and still in memory.
#[derive(Clone, Default)]
struct Pending(Arc<(Mutex<usize>, Condvar)>);

/// One of them.
struct InMemory(Pending);

impl Pending {
    fn count(&self) -> MutexGuard<'_, usize> {
        self.0.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn add(&self) -> InMemory {
        *self.count() += 1;
        InMemory(self.clone())
    }

    /// Waits until all are written, or nobody writes them; whether there were any.
    fn wait(&self) -> bool {
        let mut count = self.count();
        let had_some = *count > 0;
        while *count > 0 {
            count = self.0.1.wait(count).unwrap_or_else(PoisonError::into_inner);
        }
        had_some
    }
}

impl Drop for InMemory {
    fn drop(&mut self) {
        *self.0.count() -= 1;
        self.0.0.1.notify_all();
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

/// Renders the frames that are left, and writes their files. Returns what was done.
pub(crate) fn write(prepared: &Prepared, mut range: FrameRange, context: Context) -> Result<String, Error> {
    let (mut renderer, writer) = begin(prepared, &mut range, context)?;
    let begin = writer.begin;
    context.host.cancellable(|| -> Result<(), Error> {
        both(&mut renderer, writer, &range, context)?;
        if !range.numbers.is_empty() {
            renderer.save_mesh(context.host);
        }
        Ok(())
    })?;
    Ok(summary(&range, begin.elapsed(), &prepared.scene.scene.name, context.load))
}

/// Renders frames on this thread, and writes them on another one.
fn both(
    renderer: &mut FrameRenderer,
    mut writer: FrameWriter,
    range: &FrameRange,
    context: Context,
) -> Result<(), Error> {
    let (queue, waiting) = mpsc::sync_channel(WAITING);
    let (rendered, written, writer) = thread::scope(|scope| {
        let writing = scope.spawn(move || {
            let written = waiting.into_iter().try_for_each(|frame| writer.write(frame, context));
            (written, writer)
        });
        let rendered = render_all(renderer, range, context, &queue);
        drop(queue);
        let (written, writer) = writing.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        (rendered, written, writer)
    });
    // What is written was rendered before.
    match written.and(rendered) {
        Ok(()) => writer.close(),
        Err(error) => Err(writer.fail(error.0, error.1)),
    }
}

/// Renders all frames, until nobody takes them.
fn render_all(
    renderer: &mut FrameRenderer,
    range: &FrameRange,
    context: Context,
    queue: &SyncSender<Finished>,
) -> Result<(), InFrame> {
    let (pending, mut parts) = (Pending::default(), Parts::new(range.numbers.len()));
    for &number in &range.numbers {
        let (start, part) = (Instant::now(), parts.next(context.host));
        let context = Context { host: &part, ..context };
        let in_frame = |cause| Box::new((number, cause));
        let files = files_of(context.plan, number).map_err(in_frame)?;
        let rendered = match renderer.render(number, context) {
            // Frames that are being written take memory, too: without them it may suffice.
            Err(error) if error.is_of_memory() && pending.wait() => renderer.render(number, context),
            rendered => rendered,
        };
        let rendered = rendered.map_err(in_frame)?;
        if queue.send(Finished { rendered, files, _in_memory: pending.add() }).is_err() {
            break;
        }
        if context.host.cancelled() {
            return Err(in_frame(RenderError::Cancelled.into()));
        }
        parts.took(start.elapsed().as_secs_f64());
    }
    Ok(())
}

/// The files of a frame.
fn files_of(plan: &Plan, number: u32) -> Result<PictureFiles, Error> {
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
    begin: Instant,
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
    fn write(&mut self, mut frame: Finished, context: Context) -> Result<(), InFrame> {
        let number = frame.rendered.number;
        self.put(&mut frame.rendered, &frame.files, context).map_err(|cause| Box::new((number, cause)))
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

    fn is_movie(&self) -> bool {
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

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    #[test]
    fn frames_in_memory_are_waited_for() {
        let pending = Pending::default();
        assert!(!pending.wait(), "there are none");
        let (queue, waiting) = mpsc::sync_channel(2);
        for _ in 0..2 {
            queue.send(pending.add()).unwrap();
        }
        // Long enough for this thread to wait for both.
        let writer = thread::spawn(move || {
            thread::sleep(Duration::from_millis(200));
            drop(waiting.recv());
        });
        assert!(pending.wait(), "one is written, and the other one is dropped with the queue");
        assert_eq!(*pending.count(), 0);
        writer.join().unwrap();
        assert!(!pending.wait());
    }
}
