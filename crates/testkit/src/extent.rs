//! How much runs: a part of large products of cases, or all of them with `LIGHTMESH_TESTS=all`.
//!
//! The part is to find what the whole finds: `fuzz/mutants/mutants.py` breaks the code in many places, and shows what the part notices.

use std::env::var;

/// Whether the whole products run: `LIGHTMESH_TESTS=all`.
///
/// # Panics
/// If the variable has another value: a misspelt one would leave out what was asked for.
pub fn runs_all() -> bool {
    match var("LIGHTMESH_TESTS").as_deref() {
        Ok("all") => true,
        Err(_) | Ok("") => false,
        Ok(other) => panic!("LIGHTMESH_TESTS is `{other}`; give `all`, or leave it out"),
    }
}

/// The seed of cases that are drawn at random: `LIGHTMESH_SEED`, or 1. Names of cases contain it, so that each can be repeated.
///
/// # Panics
/// If the variable is no number.
pub fn seed() -> u64 {
    match var("LIGHTMESH_SEED") {
        Ok(seed) => seed.parse().unwrap_or_else(|_| panic!("LIGHTMESH_SEED is `{seed}`; give a whole number")),
        Err(_) => 1,
    }
}
