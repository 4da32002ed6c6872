//! The output that is published if the program ends early.

use std::convert::Infallible;
use std::sync::{LazyLock, Mutex, PoisonError};

use crate::output::Ready;
use crate::per_process::PerProcess;
use crate::registry::Registry;

static STANDBY: LazyLock<PerProcess<Mutex<Option<Ready>>>> = LazyLock::new(|| PerProcess::new(Mutex::new(None)));

/// Lets another output stand by, or none, and returns that before it. Whoever holds the registry is the only one here.
pub(crate) fn exchange(output: Option<Ready>, _: &mut Registry) -> Option<Ready> {
    let Ok(standby) = STANDBY.get_or_make(|| Ok::<_, Infallible>(Mutex::default()));
    let mut standby = standby.lock().unwrap_or_else(PoisonError::into_inner);
    std::mem::replace(&mut standby, output)
}
