//! Twins: every stage and whole images, the CPU against a CUDA device.
//!
//! One list of cases always runs on the emulator, and on each CUDA device. If no device can be used, its cases count as ignored;
//! with `LIGHTMESH_REQUIRE_GPU=1` they fail. `cargo test -p lightmesh-emulator --test twins -- garden` runs the cases of one scene.

#[cfg(unix)]
mod irradiance_cache;
#[cfg(unix)]
mod kept;
#[cfg(unix)]
mod pairwise;
#[cfg(unix)]
mod pictures;
#[cfg(unix)]
mod scenes;
#[cfg(unix)]
mod stages;
#[cfg(unix)]
mod structures;
#[cfg(unix)]
mod textured;
#[cfg(unix)]
mod trials;

fn main() -> std::process::ExitCode {
    let arguments = libtest_mimic::Arguments::from_args();
    if cfg!(no_cxx) {
        #[expect(clippy::print_stderr, reason = "trials that are ignored have no reason of their own")]
        {
            eprintln!("twins on the emulator are ignored: no C++ compiler worked; install one, or set CXX");
        }
    }
    #[cfg(unix)]
    let trials = trials::all();
    // On other systems the emulator has no fibres.
    #[cfg(not(unix))]
    let trials = Vec::new();
    libtest_mimic::run(&arguments, trials).exit_code()
}
