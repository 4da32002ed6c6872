//! Errors are detected, and do not affect later launches.

use lightmesh_render::cuda::{Fault, Kernel, Launch, Runtime};

use crate::Bench;

#[track_caller]
fn says(message: &str, parts: &[&str]) {
    for part in parts {
        assert!(message.contains(part), "'{part}' is missing: {message}");
    }
}

#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn a_collective_that_a_thread_does_not_reach() {
    let message = Bench::new(256).fault("wait_for_ended", 2, 64, 0);
    says(
        &message,
        &["own::wait_for_ended", "block 0", "thread 32 waits at __ballot_sync", "thread 37, which has ended"],
    );
}

#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn threads_that_wait_at_different_places() {
    let message = Bench::new(64).fault("wait_at_two_places", 1, 64, 0);
    says(&message, &["thread 0 waits at __syncwarp", "for thread 3, which waits at __syncthreads"]);
}

#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn a_barrier_for_some_threads_of_the_block() {
    let bench = Bench::new(64);
    let message = bench.fault("barrier_for_some", 1, 64, 63);
    says(&message, &["thread 0 waits at __syncthreads", "thread 63, which has ended"]);
    bench.launch("barrier_for_some", 1, 64, 64).expect("all threads come");
    bench.launch("barrier_for_some", 1, 64, 0).expect("no thread comes");
}

#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn the_first_block_that_fails_is_named() {
    for _ in 0..20 {
        let message = Bench::new(1).fault("trap", 1000, 256, 256 * 700 + 11);
        says(&message, &["block 700: thread 11: __trap()"]);
    }
}

#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn wrong_masks() {
    says(
        &Bench::new(32).fault("not_in_mask", 1, 32, 0),
        &["thread 16 calls __ballot_sync without being in the mask 0000ffff"],
    );
    says(&Bench::new(32).fault("shuffle_from_outside", 1, 32, 0), &["shuffles from lane 16, which is not in the mask"]);
    // Half a warp: the full mask names lanes that do not exist.
    says(&Bench::new(16 * 12).fault("warp_words", 1, 16, 0), &["lanes ffffffff, of which 0000ffff exist"]);
}

#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn writing_outside_of_memory() {
    let bench = Bench::new(10);
    for (choice, part) in
        [(10, "0 bytes past the end of 40 bytes"), (1000, "3960 bytes past"), (u32::MAX, "4 bytes before 40 bytes")]
    {
        let bench = Bench::new(10);
        says(&bench.fault("write_outside", 1, 32, choice), &["own::write_outside", part]);
    }
    bench.launch("write_outside", 1, 32, 9).expect("the last of ten values");
}

#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn addresses_that_are_none() {
    let bench = Bench::new(32);
    says(&bench.fault("wild_address", 3, 64, 50), &["own::wild_address: block 0: thread 50 reads or writes at"]);
    says(&bench.fault("wild_address", 1, 64, 3), &["block 0: thread 3 reads or writes at"]);
    assert_eq!(bench.run("write_numbers", 1, 32)[31], 31);
}

#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn writing_outside_of_shared_memory() {
    let bench = Bench::new(32);
    says(&bench.fault("write_outside_shared", 1, 32, 3), &["past the end of small (12 bytes)"]);
    bench.launch("write_outside_shared", 1, 32, 2).expect("the last of three values");
}

#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn too_much_shared_memory() {
    says(
        &Bench::new(32).fault("much_shared", 1, 32, 0),
        &["bigger (12000 bytes) does not fit into a block's shared memory"],
    );
}

#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn a_device_works_on_after_a_failure() {
    let bench = Bench::new(3072);
    bench.fault("wait_for_ended", 3, 1024, 0);
    bench.fault("barrier_for_some", 3, 1024, 1000);
    assert_eq!(bench.run("block_sum", 5, 256)[0], 255 * 128 + 128);
}

#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn launches_that_do_not_fit_the_kernel() {
    let bench = Bench::new(1);
    says(&bench.fault("no_such_kernel", 1, 32, 0), &["own::no_such_kernel: there is no such kernel"]);
    bench.launch("write_numbers", 0, 32, 0).expect("no blocks: nothing to do");
    says(&bench.fault("write_numbers", 1, 0, 0), &["blocks of 0 threads"]);
    says(&bench.fault("write_numbers", 1, 1025, 0), &["1025 threads; they may have 1 to 1024"]);
    let launch = |shared, arguments: &[u8]| {
        let kernel = Kernel { module: "own", name: "write_numbers" };
        match bench.pool.runtime().launch(kernel, Launch { blocks: 1, threads: 32, shared }, arguments) {
            Err(Fault::Failed(message)) => message,
            other => panic!("{other:?}"),
        }
    };
    says(&launch(65537, &[0; 24]), &["65537 bytes of shared memory"]);
    says(&launch(0, &[0; 23]), &["23 bytes of arguments; it takes 24"]);
}
