//! A film is rendered frame by frame, each of which is written as soon as it is finished, while the next one is rendered.

use std::sync::mpsc::{self, SyncSender};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Instant;

use lightmesh_render::RenderError;

use super::writer::{FrameWriter, InFrame, begin, files_of};
use super::{FrameRange, FrameRenderer, RenderedFrame, summary, together};
use crate::context::{Context, Prepared};
use crate::error::Error;
use crate::files::PictureFiles;
use crate::host::Parts;

/// Frames that are rendered and wait to be written, besides the one that is.
const WAITING: usize = 1;

/// A frame that is rendered while the one before it is written.
struct Waiting {
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

/// Renders frames, and writes them at the same time.
fn both(
    renderer: &mut FrameRenderer,
    mut writer: FrameWriter,
    range: &FrameRange,
    context: Context,
) -> Result<(), Error> {
    let devices = together::devices(context.renderer);
    let done = if devices.len().min(range.numbers.len()) > 1 {
        together::write(renderer, &mut writer, range, &devices, context)
    } else {
        one_by_one(renderer, &mut writer, range, context)
    };
    match done {
        Ok(()) => writer.close(),
        Err(InFrame { number, cause }) => Err(writer.fail(number, *cause)),
    }
}

/// Renders frames on this thread, and writes them on another one.
fn one_by_one(
    renderer: &mut FrameRenderer,
    writer: &mut FrameWriter,
    range: &FrameRange,
    context: Context,
) -> Result<(), InFrame> {
    let (queue, waiting) = mpsc::sync_channel(WAITING);
    thread::scope(|scope| {
        let write = move |Waiting { mut rendered, files, _in_memory }| writer.write(&mut rendered, &files, context);
        let writing = scope.spawn(move || waiting.into_iter().try_for_each(write));
        let rendered = render_all(renderer, range, context, &queue);
        drop(queue);
        // What is written was rendered before.
        writing.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)).and(rendered)
    })
}

/// Renders all frames, until nobody takes them.
fn render_all(
    renderer: &mut FrameRenderer,
    range: &FrameRange,
    context: Context,
    queue: &SyncSender<Waiting>,
) -> Result<(), InFrame> {
    let (pending, mut parts) = (Pending::default(), Parts::new(range.numbers.len()));
    for &number in &range.numbers {
        let (start, part) = (Instant::now(), parts.next(context.host));
        let context = Context { host: &part, ..context };
        let in_frame = |cause| InFrame::new(number, cause);
        let files = files_of(context.plan, number).map_err(in_frame)?;
        let rendered = match renderer.render(number, context) {
            // Frames that are being written take memory, too: without them it may suffice.
            Err(error) if error.is_of_memory() && pending.wait() => renderer.render(number, context),
            rendered => rendered,
        };
        let rendered = rendered.map_err(in_frame)?;
        if queue.send(Waiting { rendered, files, _in_memory: pending.add() }).is_err() {
            break;
        }
        if context.host.cancelled() {
            return Err(in_frame(RenderError::Cancelled.into()));
        }
        parts.took(start.elapsed().as_secs_f64());
    }
    Ok(())
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
