//! Moments in the queue.

use std::sync::Arc;

use cudarc::driver::result::event;
use cudarc::driver::sys::{CUevent, CUevent_flags};

use super::context::Context;
use crate::cuda::Fault;

/// A moment in the queue: it comes when all work queued before is done.
pub struct Event {
    context: Arc<Context>,
    handle: CUevent,
}

// SAFETY: the handle names an object of the driver, which may be used from any thread.
unsafe impl Send for Event {}
// SAFETY: as above.
unsafe impl Sync for Event {}

impl Event {
    /// An event that has come, as long as it is not recorded.
    pub(super) fn new(context: &Arc<Context>, flags: CUevent_flags) -> Result<Event, Fault> {
        let handle = context.run(|| "creating an event".to_owned(), |_| event::create(flags))?;
        Ok(Event { context: Arc::clone(context), handle })
    }

    /// An event at the present moment of the queue, with its time.
    pub(super) fn now(context: &Arc<Context>) -> Result<Event, Fault> {
        let event = Event::new(context, CUevent_flags::CU_EVENT_DEFAULT)?;
        event.record()?;
        Ok(event)
    }

    /// Moves it to the present moment of the queue.
    pub(super) fn record(&self) -> Result<(), Fault> {
        // SAFETY: event and stream belong to this context.
        let record = |stream| unsafe { event::record(self.handle, stream) };
        self.context.run(|| "recording an event".to_owned(), record)
    }

    /// Whether it has come.
    pub(super) fn has_come(&self) -> bool {
        // SAFETY: the event lives as long as this.
        self.context.call(|_| unsafe { event::query(self.handle) }).is_ok()
    }

    /// Waits until it comes.
    pub(super) fn wait(&self) -> Result<(), Fault> {
        // SAFETY: the event lives as long as this.
        let wait = |_| unsafe { event::synchronize(self.handle) };
        self.context.run(|| "waiting for the device".to_owned(), wait)
    }

    /// Waits for `later` and gives the seconds between both.
    pub(super) fn seconds_until(&self, later: &Event) -> Result<f64, Fault> {
        later.wait()?;
        // SAFETY: both live; both are in the same stream, since a context has only one.
        let elapsed = |_| unsafe { event::elapsed(self.handle, later.handle) };
        let milliseconds = self.context.run(|| "reading the device's clock".to_owned(), elapsed)?;
        Ok(f64::from(milliseconds) * 1e-3)
    }
}

impl Drop for Event {
    fn drop(&mut self) {
        // SAFETY: made in `new`. An event that has not come yet is released when it does.
        let _ = self.context.call(|_| unsafe { event::destroy(self.handle) });
    }
}
