//! Experiments: timed suites, what they find, and what is made of that.
//!
//! Data flows one way: [`run`] takes a [`Suite`] and a [`Plan`] and gives [`Results`], which are kept as JSON; comparison and reports
//! read them. A suite makes renderers ([`engine`]), times pictures in turn ([`measure`]) and gathers rows, pictures and notes
//! ([`Findings`]).
#![forbid(unsafe_code)]

mod compare;
pub mod engine;
mod error;
mod findings;
mod load;
mod machine;
pub mod measure;
mod plan;
pub mod readme;
pub mod report;
mod results;
pub mod schedule;
mod suites;
mod table;

pub use compare::{RunComparison, StageComparison, Verdict};
pub use error::BenchError;
pub use findings::Findings;
pub use plan::{Plan, Suite};
pub(crate) use results::WHOLE;
pub use results::{Gpu, Key, Machine, Picture, Program, Results, Row, Samples};
pub use suites::run;
