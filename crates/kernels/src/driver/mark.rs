//! Events in the stream: synchronisation and clocks.

use std::sync::Arc;

use cudarc::driver::result::event;
use cudarc::driver::sys::{CUevent, CUevent_flags};

use super::context::Context;
use crate::runtime::Fault;

/// A point in the stream: it is reached when all work queued before it has finished.
pub struct Event {
    context: Arc<Context>,
    handle: CUevent,
}

// SAFETY: the handle names a driver object, which may be used from any thread.
unsafe impl Send for Event {}
// SAFETY: as above.
unsafe impl Sync for Event {}

impl Event {
    /// An event that counts as reached until it is recorded.
    pub(super) fn new(context: &Arc<Context>, flags: CUevent_flags) -> Result<Event, Fault> {
        let handle = context.run(|| "creating an event".to_owned(), |_| event::create(flags))?;
        Ok(Event { context: Arc::clone(context), handle })
    }

    /// An event at the current end of the stream, with timing.
    pub(super) fn now(context: &Arc<Context>) -> Result<Event, Fault> {
        let event = Event::new(context, CUevent_flags::CU_EVENT_DEFAULT)?;
        event.record()?;
        Ok(event)
    }

    /// Moves the event to the current end of the stream.
    pub(super) fn record(&self) -> Result<(), Fault> {
        // SAFETY: event and stream belong to this context.
        let record = |stream| unsafe { event::record(self.handle, stream) };
        self.context.run(|| "recording an event".to_owned(), record)
    }

    /// Whether it has been reached.
    pub(super) fn has_come(&self) -> bool {
        // SAFETY: the event lives as long as this.
        self.context.call(|_| unsafe { event::query(self.handle) }).is_ok()
    }

    /// Waits until it is reached.
    pub(super) fn wait(&self) -> Result<(), Fault> {
        // SAFETY: the event lives as long as this.
        let wait = |_| unsafe { event::synchronize(self.handle) };
        self.context.run(|| "waiting for the device".to_owned(), wait)
    }

    /// Waits for `later` and returns the seconds between the two.
    pub(super) fn seconds_until(&self, later: &Event) -> Result<f64, Fault> {
        later.wait()?;
        // SAFETY: both are alive; both are in the same stream, since a context has only one.
        let elapsed = |_| unsafe { event::elapsed(self.handle, later.handle) };
        let milliseconds = self.context.run(|| "reading the device's clock".to_owned(), elapsed)?;
        Ok(f64::from(milliseconds) * 1e-3)
    }
}

impl Drop for Event {
    fn drop(&mut self) {
        // SAFETY: created in `new`. An event that has not been reached yet is released once it is.
        let _ = self.context.call(|_| unsafe { event::destroy(self.handle) });
    }
}
