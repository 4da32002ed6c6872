//! The frames of a film on several devices: each renders whole frames, which are written when they are finished, those of a movie in their order.
//!
//! What is said of a frame is told when it is written. A device that is so far ahead that no more frames may be in memory waits.

use std::collections::{BTreeMap, VecDeque};
use std::fmt;
use std::time::Instant;

use lightmesh_render::crew::{Crew, Failure, ObserverOfPart, Team, Work};
use lightmesh_render::{RenderError, Renderer, Worker};

use super::frames::{FrameRenderer, Kept, Reel};
use super::said::{Recorder, Said};
use super::writer::{FrameWriter, InFrame, files_of};
use super::{FrameRange, RenderedFrame};
use crate::context::Context;
use crate::error::Error;
use crate::host::RENDERING;

/// Frames that may be in memory for each device: one that is rendered, and one that waits to be written. One more is written.
const IN_MEMORY: usize = 2;

/// A frame that is rendered.
pub(crate) struct Finished {
    rendered: RenderedFrame,
    said: Said,
}

impl Finished {
    /// The frame, after what was said of it is told, and its files are written if there is a writer.
    pub(crate) fn written(
        mut self,
        writer: Option<&mut FrameWriter>,
        context: Context,
    ) -> Result<RenderedFrame, InFrame> {
        self.said.tell(context.host);
        let number = self.rendered.number;
        if let Some(writer) = writer {
            let files = files_of(context.plan, number).map_err(|cause| InFrame::new(number, cause))?;
            writer.write(&mut self.rendered, &files, context)?;
        }
        Ok(self.rendered)
    }
}

/// The devices that render whole frames: GPUs if there are any, since a CPU takes long for one, and has those of others to encode.
pub(crate) fn devices(renderer: &Renderer) -> Vec<&dyn Worker> {
    let mut devices = renderer.devices();
    if devices.iter().any(|device| device.id().is_some()) {
        devices.retain(|device| device.id().is_some());
    }
    devices
}

/// Renders frames on several devices, and writes their files.
pub(super) fn write(
    renderer: &mut FrameRenderer,
    writer: &mut FrameWriter,
    range: &FrameRange,
    devices: &[&dyn Worker],
    context: Context,
) -> Result<(), InFrame> {
    let most = IN_MEMORY * devices.len() + 1;
    let frames = FrameQueue::new(&range.numbers, most, writer.is_movie());
    let crew = Crew::new(frames, devices.iter().map(|_| None), context.host);
    let (reel, kept) = renderer.on(devices);
    let work = |number, device: &dyn Worker, kept| render(&crew, reel, (number, device), kept, context);
    let write = || {
        while let Some(frame) = crew.wait_for(FrameQueue::begin_to_write) {
            let written = frame.written(Some(&mut *writer), context).map(drop);
            crew.change(FrameQueue::end_to_write);
            written.inspect_err(|_| crew.stop())?;
        }
        Ok(())
    };
    let (_, written) = context.host.during(RENDERING, || crew.run(devices, kept, work, write));
    let (frames, _, error) = crew.into_result();
    written.and(frames.all_or(error))
}

/// Renders a few frames on several devices. Returns those that are finished, and why others are not.
pub(crate) fn render_ahead(
    renderer: &mut FrameRenderer,
    numbers: &[u32],
    devices: &[&dyn Worker],
    context: Context,
) -> (Vec<Finished>, Result<(), InFrame>) {
    let crew = Crew::new(FrameQueue::new(numbers, numbers.len(), true), devices.iter().map(|_| None), context.host);
    let (reel, kept) = renderer.on(devices);
    let work = |number, device: &dyn Worker, kept| render(&crew, reel, (number, device), kept, context);
    let next = || {
        let frame = crew.wait_for(FrameQueue::begin_to_write)?;
        crew.change(FrameQueue::end_to_write);
        Some(frame)
    };
    let finished = || std::iter::from_fn(next).collect();
    let (_, finished) = context.host.during(RENDERING, || crew.run(devices, kept, work, finished));
    let (frames, _, error) = crew.into_result();
    (finished, frames.all_or(error))
}

/// Renders frames on a device until there is none left, or a failure.
fn render(
    crew: &Crew<FrameQueue, InFrame>,
    reel: &Reel,
    (number, device): (usize, &dyn Worker),
    kept: &mut Kept,
    context: Context,
) {
    while let Some(frame) = crew.take(number, device) {
        let start = Instant::now();
        let host = Recorder::new(ObserverOfPart::new(crew, number, &frame), context.host);
        let context = Context { host: &host, ..context };
        let mut render = || reel.render(frame, kept, device, context);
        let rendered = match render() {
            // Frames that wait to be written take memory, too: without them it may suffice.
            Err(error) if error.is_of_memory() && has_room(crew) => render(),
            rendered => rendered,
        };
        match rendered {
            Ok(rendered) => {
                let finished = Finished { rendered, said: host.said() };
                crew.finish(number, (1.0, start.elapsed().as_secs_f64()), |all| {
                    all.finished.insert(frame, finished);
                });
            }
            Err(cause) => {
                crew.fail(frame, (number, device), InFrame::new(frame, cause));
                break;
            }
        }
    }
}

/// Waits until all frames are written that can be; whether there were any.
fn has_room(crew: &Crew<FrameQueue, InFrame>) -> bool {
    let had_some = crew.change(|frames| frames.can_write());
    crew.wait_for(|frames, _| (crew.cancelled() || !frames.can_write()).then_some(()));
    had_some
}

/// The frames of a film, or a part of it.
struct FrameQueue<F = Finished> {
    count: usize,
    /// Those that nobody has taken, in their order.
    left: VecDeque<u32>,
    /// Those that came back.
    returned: Vec<u32>,
    /// So many are taken and not written.
    in_memory: usize,
    /// How many may be.
    most: usize,
    finished: BTreeMap<u32, F>,
    /// Those that are not written, in the order in which they are, if it matters.
    order: Option<VecDeque<u32>>,
    is_writing: bool,
}

impl<F> FrameQueue<F> {
    fn new(numbers: &[u32], most: usize, is_ordered: bool) -> FrameQueue<F> {
        let left: VecDeque<u32> = numbers.iter().copied().collect();
        FrameQueue {
            count: numbers.len(),
            order: is_ordered.then(|| left.clone()),
            left,
            returned: Vec::new(),
            in_memory: 0,
            most,
            finished: BTreeMap::new(),
            is_writing: false,
        }
    }

    /// The next one that can be written.
    fn next(&self) -> Option<u32> {
        let first = match &self.order {
            Some(order) => order.front().filter(|number| self.finished.contains_key(number)),
            None => self.finished.keys().next(),
        };
        first.copied()
    }

    /// The next one that is to be written; `None` in it if there will be none.
    fn begin_to_write(&mut self, is_over: bool) -> Option<Option<F>> {
        let next = self.next();
        if let (Some(_), Some(order)) = (next, &mut self.order) {
            order.pop_front();
        }
        self.is_writing = next.is_some();
        (next.is_some() || is_over).then(|| self.finished.remove(&next?))
    }

    fn end_to_write(&mut self) {
        self.is_writing = false;
        self.in_memory -= 1;
    }

    /// Whether some are written, or can be.
    fn can_write(&self) -> bool {
        self.is_writing || self.next().is_some()
    }

    /// Fails if frames are left, by an error if there was one.
    fn all_or(&self, error: Option<InFrame>) -> Result<(), InFrame> {
        let left = self.returned.iter().chain(&self.left).copied().min();
        let cancelled = || left.map(|left| InFrame::new(left, RenderError::Cancelled.into()));
        error.or_else(cancelled).map_or(Ok(()), Err)
    }
}

impl<F: Send> Work for FrameQueue<F> {
    type Part = u32;

    fn take(&mut self, device: usize, team: &Team) -> Option<u32> {
        let frame = self.returned.pop().or_else(|| {
            // A frame that comes late holds up those after it that may be in memory.
            let next = if self.order.is_some() { self.left.len().min(self.most) } else { self.left.len() };
            // Others are at their own before they do these.
            let busy = self.in_memory - self.finished.len() - usize::from(self.is_writing);
            let is_late = |speed| team.is_late(device, speed, 1.0, (next + busy) as f64);
            let takes = self.in_memory < self.most && !team.speed(device).is_some_and(is_late);
            if takes { self.left.pop_front() } else { None }
        })?;
        self.in_memory += 1;
        Some(frame)
    }

    fn give_back(&mut self, frame: u32) {
        self.in_memory -= 1;
        self.returned.push(frame);
    }

    fn is_taken(&self) -> bool {
        self.left.is_empty() && self.returned.is_empty()
    }

    fn whole(&self) -> f64 {
        self.count as f64
    }

    fn size(_: &u32) -> f64 {
        1.0
    }

    fn name(frame: &u32) -> String {
        format!("frame {frame}")
    }
}

impl fmt::Display for InFrame {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.cause.fmt(f)
    }
}

impl Failure for InFrame {
    fn is_of_device(&self) -> bool {
        matches!(&*self.cause, Error::Render(error) if error.is_of_device())
    }

    fn is_cancelled(&self) -> bool {
        matches!(*self.cause, Error::Render(RenderError::Cancelled))
    }
}

#[cfg(test)]
mod tests {
    use std::thread;
    use std::time::Duration;

    use lightmesh_render::{Device, Unobserved};

    use super::*;

    fn crew(most: usize, is_ordered: bool) -> Crew<'static, FrameQueue<u32>, InFrame> {
        Crew::new(FrameQueue::new(&[1, 2, 3, 5, 8], most, is_ordered), [None; 2].into_iter(), &Unobserved)
    }

    fn take(crew: &Crew<FrameQueue<u32>, InFrame>, device: usize) -> Option<u32> {
        crew.take(device, &Renderer::with_threads(Device::Cpu, Some(1)).unwrap())
    }

    fn finish(crew: &Crew<FrameQueue<u32>, InFrame>, frame: u32) {
        crew.finish(0, (1.0, 1.0), |frames| assert!(frames.finished.insert(frame, 10 * frame).is_none()));
    }

    fn next(crew: &Crew<FrameQueue<u32>, InFrame>) -> Option<u32> {
        crew.change(|frames| frames.begin_to_write(false)).flatten()
    }

    #[test]
    fn a_movie_is_written_in_its_order_and_files_as_they_come() {
        for (is_ordered, order) in [(true, [None, Some(10), Some(20)]), (false, [Some(20), Some(10), None])] {
            let crew = crew(9, is_ordered);
            assert_eq!([take(&crew, 0), take(&crew, 1)], [Some(1), Some(2)]);
            finish(&crew, 2);
            let first = next(&crew);
            finish(&crew, 1);
            assert_eq!([first, next(&crew), next(&crew)], order);
        }
    }

    #[test]
    fn a_device_that_is_far_ahead_waits_until_a_frame_is_written() {
        let crew = crew(2, true);
        assert_eq!([take(&crew, 0), take(&crew, 1)], [Some(1), Some(2)]);
        finish(&crew, 2);
        thread::scope(|scope| {
            let third = scope.spawn(|| take(&crew, 1));
            thread::sleep(Duration::from_millis(100));
            let before = third.is_finished();
            finish(&crew, 1);
            let written = next(&crew);
            thread::sleep(Duration::from_millis(100));
            let meanwhile = third.is_finished();
            crew.change(FrameQueue::end_to_write);
            thread::sleep(Duration::from_millis(100));
            crew.stop();
            assert_eq!((before, written, meanwhile), (false, Some(10), false));
            assert_eq!(third.join().unwrap(), Some(3));
        });
    }

    #[test]
    fn a_device_takes_no_frame_that_others_finish_before() {
        for (seconds, takes) in [(1.2, true), (9.0, false)] {
            let crew = crew(9, false);
            assert_eq!([take(&crew, 0), take(&crew, 1)], [Some(1), Some(2)]);
            finish(&crew, 1);
            crew.finish(1, (1.0, seconds), |frames| assert!(frames.finished.insert(2, 20).is_none()));
            // Others are at two frames, and one is left.
            assert_eq!([take(&crew, 0), take(&crew, 0)], [Some(3), Some(5)]);
            thread::scope(|scope| {
                let second = scope.spawn(|| take(&crew, 1));
                thread::sleep(Duration::from_millis(100));
                let has_taken = second.is_finished();
                crew.stop();
                assert_eq!(has_taken, takes);
            });
        }
    }

    #[test]
    fn a_frame_that_comes_back_is_taken_first_and_what_is_left_is_cancelled() {
        let crew = crew(3, true);
        assert_eq!([take(&crew, 0), take(&crew, 1), take(&crew, 0)], [Some(1), Some(2), Some(3)]);
        crew.change(|frames| frames.give_back(2));
        assert_eq!(take(&crew, 0), Some(2));
        crew.stop();
        assert_eq!(take(&crew, 0), None);
        let (frames, _, error) = crew.into_result();
        assert!(frames.all_or(error).is_err_and(|error| error.number == 5 && error.is_cancelled()));
    }
}
