//! How much memory there is, how much of it a program may use, and what happens when it wants more.
//!
//! Two lines of defence:
//!
//! 1. A [`Budget`] is asked before anything large is allocated whose size comes from a file or a setting. Its answer is a typed error,
//!    with which a library says what would have been too large.
//! 2. [`Counting`], a global allocator that a program may install, knows what the program holds to the byte, and [ends it](set_ceiling)
//!    in the program's own way when an allocation would exceed a ceiling, or the system refuses it. So nothing has to foresee how much
//!    memory a parser needs for a hostile file.

mod budget;
mod counting;
mod size;
mod system;

pub use budget::{Budget, OverBudget};
pub use counting::{Counting, Refused, ceiling, held, set_ceiling};
pub use size::Bytes;
pub use system::{available, peak, resident};
