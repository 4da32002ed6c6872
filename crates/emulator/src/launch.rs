//! One launch: its blocks on the host's threads.

use std::collections::HashMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

use lightmesh_render::cuda::{Fault, Kernel, Launch};

use crate::host::{self, ConstantImage, Machine};
use crate::memory::POISON;

/// Shared memory per block that every device provides.
const SHARED_BYTES: u32 = 64 * 1024;
/// Number of emulated threads that justify another host thread.
const WORTH_A_THREAD: u64 = 2048;

/// Runs all blocks. Fails with the first block that fails, in order of block number.
pub(crate) fn run(
    kernel: Kernel,
    launch: Launch,
    arguments: &[u8],
    constants: &HashMap<(&'static str, &'static str), Vec<u8>>,
) -> Result<(), Fault> {
    let failed = |why: String| during(kernel, Fault::Failed(why));
    let modules = host::modules();
    let found = modules
        .kernels
        .get(&(kernel.module, kernel.name))
        .ok_or_else(|| failed("there is no such kernel".to_owned()))?;
    let Launch { blocks, threads, shared } = launch;
    if threads == 0 || threads > found.threads {
        return Err(failed(format!("blocks of {threads} threads; they may have 1 to {}", found.threads)));
    }
    if shared > SHARED_BYTES {
        return Err(failed(format!("{shared} bytes of shared memory; there are {SHARED_BYTES}")));
    }
    if arguments.len() != found.arguments as usize {
        return Err(failed(format!("{} bytes of arguments; it takes {}", arguments.len(), found.arguments)));
    }
    // Records are aligned to 16 bytes at most.
    let mut aligned = vec![0u128; arguments.len().div_ceil(16)];
    // SAFETY: the buffer is large enough.
    unsafe { aligned.as_mut_ptr().cast::<u8>().copy_from_nonoverlapping(arguments.as_ptr(), arguments.len()) };

    let of_module = modules.constants.iter().filter(|((module, _), _)| *module == kernel.module);
    let values: Vec<_> = of_module
        .map(|(names, &constant)| (constant, constants.get(names).cloned().unwrap_or_else(|| poisoned(constant.bytes))))
        .collect();
    let images: Vec<_> =
        values.iter().map(|(constant, value)| ConstantImage { constant: *constant, bytes: value.as_ptr() }).collect();
    run_blocks(&host::Launch {
        kernel: *found,
        arguments: aligned.as_ptr().cast(),
        constants: images.as_ptr(),
        constant_count: images.len(),
        blocks,
        threads,
        dynamic_shared: shared,
    })
    .map_err(failed)
}

/// Blocks are taken in order by as many threads as there is work for. A thread stops after a block that fails, and no thread starts
/// another block; all blocks with smaller numbers have started by then, so the smallest one that fails is always found.
fn run_blocks(launch: &host::Launch) -> Result<(), String> {
    let next = AtomicU32::new(0);
    let stop = AtomicBool::new(false);
    let failure: Mutex<Option<(u32, String)>> = Mutex::new(None);
    let work = || {
        let Some(mut machine) = Machine::take() else { return };
        // SAFETY: the launch was assembled by `run`.
        unsafe { machine.prepare(launch) };
        while !stop.load(Ordering::Relaxed) {
            let block = next.fetch_add(1, Ordering::Relaxed);
            if block >= launch.blocks {
                break;
            }
            // SAFETY: as above; addresses among the arguments are the responsibility of the test.
            if let Err(message) = unsafe { machine.run(launch, block) } {
                stop.store(true, Ordering::Relaxed);
                let mut failure = failure.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
                if failure.as_ref().is_none_or(|(first, _)| block < *first) {
                    *failure = Some((block, message));
                }
            }
        }
        machine.give_back();
    };
    let processors = std::thread::available_parallelism().map_or(1, usize::from) as u64;
    let worth = u64::from(launch.blocks) * u64::from(launch.threads) / WORTH_A_THREAD;
    std::thread::scope(|scope| {
        for _ in 1..worth.min(processors).min(u64::from(launch.blocks)) {
            scope.spawn(work);
        }
        work();
    });
    match failure.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner) {
        Some((_, message)) => Err(message),
        None => Ok(()),
    }
}

/// Uninitialised bytes.
pub(crate) fn poisoned(bytes: usize) -> Vec<u8> {
    POISON.to_ne_bytes().into_iter().cycle().take(bytes).collect()
}

/// Adds to a fault which kernel failed.
pub(crate) fn during(kernel: Kernel, fault: Fault) -> Fault {
    match fault {
        Fault::Failed(why) => Fault::Failed(format!("{kernel}: {why}")),
        out_of_memory => out_of_memory,
    }
}
