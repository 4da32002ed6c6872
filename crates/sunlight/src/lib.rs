//! When points see the sun, and what hides it from them: exact spells of sunlight, without a time step.
//!
//! ```text
//! place, day ─▶ SunPath ─┐
//! Blocker    ─▶ Tree    ─┼─▶ walk ─▶ Open: spells, and who takes the rest
//! Receiver   ────────────┘
//! ```
//!
//! The sun's way over a day is a cone about the pole that drifts slowly. The plane through a receiver and an edge of a triangle cuts the cone in closed
//! form, and Newton steps from there lead to the true sun. So a triangle hides the sun from a receiver during a few closed intervals; what is left of the
//! day are the spells.
//!
//! 1. A [`SunPath`] is the sun's way on one day, as a table and as the circle that lies closest.
//! 2. `edge` has the times when the sun is on one side of a plane through the receiver, `triangle` those when it is behind a triangle.
//! 3. [`Open`] is what is still open of the day; intervals are taken from it.
//! 4. A [`Tree`] has the triangles in boxes along the equator's axes: the times when the sun can be behind a box follow from two of its corners. A walk
//!    visits only boxes that touch what is open.
//!
//! All lengths are those of the scene, in double precision; times are seconds after midnight of the day's clock. The sun is a point.
//!
//! Prior art: shadow volumes (Crow, *Shadow Algorithms for Computer Graphics*, 1977) bound by edges what a light does not reach; obstructions drawn on the
//! sun's paths (Szokolay, *Solar Geometry*, 1996) are the circle cut by edges, by hand.
#![forbid(unsafe_code)]

mod blocker;
mod edge;
mod open;
mod path;
mod samples;
mod spans;
mod time;
mod tree;
mod triangle;
mod turn;

pub use blocker::{Blocker, Receiver};
pub use open::{MANY, Open, Taken};
pub use path::{Place, PlaceError, SunPath, arcs_of_day};
pub use spans::Spans;
pub use tree::{HourTable, Tree, Walker};
