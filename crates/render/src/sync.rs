//! Locks.

use std::sync::{Mutex, MutexGuard, PoisonError};

/// The content of a mutex. What a thread left behind that panicked is taken as it is: nothing here is ever half changed.
pub(crate) fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
