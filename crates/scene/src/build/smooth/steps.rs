//! Counts steps, for the tests of hostile inputs.

use std::cell::Cell;

thread_local! {
    /// See [`count_step`].
    pub static STEPS: Cell<u64> = const { Cell::new(0) };
}

/// Counts the steps whose number is not simply that of vertices or triangles, for the tests of hostile inputs. Builds without debug assertions
/// count nothing.
#[inline(always)]
pub(super) fn count_step() {
    if cfg!(debug_assertions) {
        STEPS.set(STEPS.get() + 1);
    }
}
