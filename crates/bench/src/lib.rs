//! Experiments: timed suites, their results, comparisons and reports.
//!
//! Data flows in one direction: [`run`] takes a [`Suite`] and a [`Plan`] and returns [`Results`], which are stored as JSON;
//! comparisons and reports read them. A suite creates renderers ([`engine`]), times alternating renders ([`measure`]) and
//! collects rows, images and notes ([`Findings`]).
#![forbid(unsafe_code)]

mod compare;
pub mod engine;
mod error;
mod findings;
mod json;
mod load;
mod machine;
pub mod measure;
mod output;
mod plan;
pub mod readme;
pub mod report;
mod results;
mod save;
pub mod schedule;
mod suite;
mod suites;
mod table;

pub use compare::{RunComparison, StageComparison, Verdict};
pub use error::BenchError;
pub use findings::Findings;
pub use machine::commit;
pub use output::{OutputError, check_output_folder};
pub use plan::Plan;
pub(crate) use results::{
    ANTIALIASING, FILM, FLICKER, FLIGHT, LIGHT, MANY_LIGHTS, SHADOWS, STAGES, WHOLE, WHOLE_FRAMES,
};
pub use results::{Gpu, Key, Machine, Picture, Program, Results, Row, Samples};
pub use suite::Suite;
pub use suites::{run, run_keeping};
