//! Experiments: timed suites, what they find, and what is made of that.
//!
//! Data flows one way: a suite gives [`Results`], which are kept as JSON; comparison and reports read them.
#![forbid(unsafe_code)]

mod results;

pub use results::{Gpu, Key, Machine, Picture, Program, Results, Row, Samples};
