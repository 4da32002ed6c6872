//! Processes that were forked from one that has used the library, as those of servers and of loaders of data are.
//!
//! A child has its parent's memory and none of its threads. So work that was handed to threads of the parent would never be done, a lock that was held
//! in that moment is never released, and no device can be used. Here the work of a child runs on threads of its own, and what consists of
//! threads, locks and devices is made anew by each process that asks for it.

use std::env;
use std::process;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{LazyLock, Once};

use lightmesh::RenderError;
pub(crate) use lightmesh_files::PerProcess;
use pyo3::prelude::*;
use rayon::ThreadPoolBuilder;

use crate::errors::IntoException;

/// The process that has loaded the module.
static HOME: AtomicU32 = AtomicU32::new(0);

/// The module is loaded.
pub(crate) fn begin() {
    HOME.store(process::id(), Ordering::Relaxed);
}

fn is_child() -> bool {
    HOME.load(Ordering::Relaxed) != process::id()
}

/// The threads that the process is to use: those that OpenMP was told of, which Ray, SLURM and others set to a job's share of the machine. `None` if
/// nobody says, or Rayon is told itself.
pub(crate) fn threads() -> Option<usize> {
    static THREADS: LazyLock<Option<usize>> = LazyLock::new(|| {
        let of_rayon = env::var("RAYON_NUM_THREADS").ok().and_then(|text| text.parse::<usize>().ok());
        match of_rayon {
            Some(1..) => None,
            _ => first_count(&env::var("OMP_NUM_THREADS").ok()?),
        }
    });
    *THREADS
}

/// The first of the numbers that OpenMP takes, one for each level of nesting.
fn first_count(text: &str) -> Option<usize> {
    text.split(',').next()?.trim().parse().ok().filter(|&count| count > 0)
}

/// The pool that all work of this process shares has as many threads as [`threads`] says, if nothing has used it yet.
fn limit_shared_pool() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        if let Some(threads) = threads() {
            // One that is there stays.
            let _ = ThreadPoolBuilder::new().num_threads(threads).build_global();
        }
    });
}

/// Does work that may use all threads, in a child on a pool that lives as long.
///
/// The pool is not kept: a thread that waits takes other work of its pool, which may need a lock that it holds itself.
pub(crate) fn run<T: Send>(work: impl FnOnce() -> T + Send) -> PyResult<T> {
    if !is_child() {
        limit_shared_pool();
        return Ok(work());
    }
    let pool = ThreadPoolBuilder::new().num_threads(threads().unwrap_or(0)).build().map_err(|error| {
        RenderError::Threads { threads: rayon::current_num_threads(), reason: error.to_string() }.into_exception()
    })?;
    Ok(pool.install(work))
}

/// The same while the interpreter is free.
pub(crate) fn detach<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    py.detach(|| run(work))
}
