//! From cases to trials on the emulator and on every device.
//!
//! Cases beyond the part that runs by default are *ignored*, unless `LIGHTMESH_TESTS=all`.

use std::sync::{Arc, Mutex, PoisonError};

use libtest_mimic::{Failed, Trial};
use lightmesh_emulator::Emulator;
use lightmesh_render::backend::Cuda;
use lightmesh_render::cuda::{Driver, Runtime, open_cuda};
use lightmesh_render::{Device, devices};
use lightmesh_testkit::runs_all;

use crate::scenes::ACCELERATIONS;
use crate::{irradiance_cache, kept, pictures, stages, structures, textured};

/// Where cases run.
pub(crate) trait Target: Runtime {
    /// Whether its sines, cosines and powers are the host's, so that nothing may differ. Those of a device may be rounded
    /// differently, so that a ray to a sampled point of a light may just pass an edge, or just miss it.
    const EXACT: bool;

    /// How many structures of [`ACCELERATIONS`] it has: brute force, the last, is in the emulator alone.
    const STRUCTURES: usize;

    /// How many of `all` values that depend on sampled rays may differ, if a target that is not exact may have one in `one_in`.
    fn allowed(all: usize, one_in: usize) -> usize {
        if Self::EXACT { 0 } else { all.div_ceil(one_in) }
    }
}

impl Target for Emulator {
    const EXACT: bool = true;
    const STRUCTURES: usize = ACCELERATIONS.len();
}

impl Target for Driver {
    const EXACT: bool = false;
    const STRUCTURES: usize = ACCELERATIONS.len() - 1;
}

/// Something that must be the same on the CPU and on a device. Panics if it is not.
pub(crate) struct Case<R: Target> {
    /// Scene, structure and what is compared.
    name: String,
    /// Whether it runs with `LIGHTMESH_TESTS=all` only.
    extra: bool,
    run: Run<R>,
}

type Run<R> = Box<dyn FnOnce(&Cuda<R>) + Send>;

impl<R: Target> Case<R> {
    pub(crate) fn new(name: String, run: impl FnOnce(&Cuda<R>) + Send + 'static) -> Case<R> {
        Case { name, extra: false, run: Box::new(run) }
    }

    /// The same case, left out by default unless it is one of the `chosen` ones.
    pub(crate) fn only_if(self, chosen: bool) -> Case<R> {
        Case { extra: !chosen, ..self }
    }
}

/// All cases.
fn cases<R: Target>() -> impl Iterator<Item = Case<R>> {
    let pictures = pictures::cases().into_iter().chain(textured::cases());
    stages::cases().into_iter().chain(pictures).chain(kept::cases()).chain(irradiance_cache::cases())
}

/// The emulator's trials, and those of all CUDA devices.
pub(crate) fn all() -> Vec<Trial> {
    let mut all = on_emulator();
    let numbers: Vec<u32> =
        devices().iter().filter(|report| report.usable).filter_map(|it| number(&it.device)).collect();
    for &number in &numbers {
        all.extend(on_device(&format!("cuda:{number}"), Some(number)));
    }
    if numbers.is_empty() {
        // If they are required, they fail and say why there is no device.
        let required = std::env::var_os("LIGHTMESH_REQUIRE_GPU").is_some_and(|value| value == "1");
        all.extend(on_device("cuda", None).into_iter().map(|trial| trial.with_ignored_flag(!required)));
    }
    all
}

/// N of `cuda:N`.
fn number(device: &str) -> Option<u32> {
    match device.parse() {
        Ok(Device::Cuda(number)) => number,
        _ => None,
    }
}

/// Each trial has its own emulator.
fn on_emulator() -> Vec<Trial> {
    let trial = |case: Case<Emulator>| {
        let left_out = case.extra && !runs_all();
        Trial::test(format!("emulator::{}", case.name), || {
            (case.run)(&Cuda::new(Arc::new(Emulator::new())));
            Ok(())
        })
        .with_ignored_flag(left_out)
    };
    let trials = cases().map(trial).chain(structures::trials());
    // Without a compiler it has no kernels.
    trials.map(|trial| if cfg!(no_cxx) { trial.with_ignored_flag(true) } else { trial }).collect()
}

/// The trials share the device and take turns.
fn on_device(name: &str, number: Option<u32>) -> Vec<Trial> {
    let shared: Arc<Mutex<Option<Cuda<Driver>>>> = Arc::default();
    let trial = |case: Case<Driver>| {
        let shared = Arc::clone(&shared);
        Trial::test(format!("{name}::{}", case.name), move || {
            let mut cuda = shared.lock().unwrap_or_else(PoisonError::into_inner);
            if cuda.is_none() {
                *cuda = Some(Cuda::new(open_cuda(number).map_err(|error| Failed::from(error.to_string()))?));
            }
            if let Some(cuda) = &*cuda {
                (case.run)(cuda);
            }
            Ok(())
        })
    };
    cases().map(trial).collect()
}
