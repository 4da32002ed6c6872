//! Fits tasks into a time budget.
//!
//! Tasks are ordered by importance, each with an estimated time per round. For each task, just before it runs:
//!
//! 1. time for one round of each later task is reserved, with a margin;
//! 2. from the remaining time it gets as many rounds as it requests, including one to warm up, but at least one, which then
//!    counts; rounds that take almost no time, like those of a GPU compared with a CPU, are always granted;
//! 3. if not even one round fits, the task is reduced to the first variants that do.
//!
//! So repetitions are reduced first, then rows are dropped, least important first. Estimates come from small trials and have
//! similar errors for similar tasks: the measured time of a task corrects the estimates of its class.

use std::collections::BTreeMap;

use crate::measure::Rounds;

/// Factor by which the time reserved for later tasks exceeds their estimate.
const MARGIN: f64 = 1.1;
/// A task that needs less than this share of the remaining time always gets it.
const SMALL_SHARE: f64 = 0.02;
/// Cheap tasks are repeated for this many seconds,
const SPAN: f64 = 1.0;
/// but at most this many times as often as requested.
const MOST: usize = 4;

/// The timing of a task.
#[derive(Clone, Debug)]
pub struct Estimate {
    /// Estimates of tasks of the same class have similar errors: device and size, for instance.
    pub class: String,
    /// Seconds of one render of each variant.
    pub seconds: Vec<f64>,
    /// Requested repetitions.
    pub repetitions: usize,
}

/// The schedule of all tasks.
#[derive(Debug)]
pub struct Schedule {
    estimates: Vec<Estimate>,
    /// By class: estimated and measured seconds.
    passed: BTreeMap<String, [f64; 2]>,
}

/// The decision about a task.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Decision {
    /// Number of its variants, from the first, that are measured; 0: the task is dropped.
    pub variants: usize,
    /// The rounds.
    pub rounds: Rounds,
}

impl Schedule {
    /// A schedule for tasks in this order.
    pub fn new(estimates: Vec<Estimate>) -> Schedule {
        Schedule { estimates, passed: BTreeMap::new() }
    }

    /// Decides about task `index`, with `left` seconds for it and all later tasks.
    pub fn decide(&self, index: usize, left: f64) -> Decision {
        let task = &self.estimates[index];
        let later: f64 = (index + 1..self.estimates.len()).map(|later| self.round(later)).sum();
        let (round, free) = (self.round(index), (left - MARGIN * later).max(SMALL_SHARE * left));
        let all = task.seconds.len();
        let affordable = if round > 0.0 { free / round } else { f64::INFINITY };
        // In addition to the warm-up.
        let repetitions = task.wanted(round).min((affordable - 1.0).max(0.0) as usize);
        if repetitions >= 2 {
            return Decision { variants: all, rounds: Rounds { warm_up: true, repetitions } };
        }
        let once = Rounds { warm_up: false, repetitions: 1 };
        let correction = self.correction(&task.class);
        let mut sum = 0.0;
        let fitting = task.seconds.iter().take_while(|&&seconds| {
            sum += correction * seconds;
            sum <= left
        });
        Decision { variants: fitting.count(), rounds: once }
    }

    /// Records that task `index` took `seconds` with this decision.
    pub fn done(&mut self, index: usize, decision: Decision, seconds: f64) {
        let task = &self.estimates[index];
        let rounds = (decision.rounds.repetitions + usize::from(decision.rounds.warm_up)) as f64;
        let estimated = rounds * task.seconds.iter().take(decision.variants).sum::<f64>();
        let [sum, passed] = self.passed.entry(task.class.clone()).or_default();
        *sum += estimated;
        *passed += seconds;
    }

    /// Seconds for one round of each task from `index` on.
    pub fn remaining(&self, index: usize) -> f64 {
        (index..self.estimates.len()).map(|task| self.round(task)).sum()
    }

    /// Seconds of one round.
    fn round(&self, index: usize) -> f64 {
        let task = &self.estimates[index];
        self.correction(&task.class) * task.seconds.iter().sum::<f64>()
    }

    /// Error factor of the estimates of a class; of all classes if none of its tasks has run.
    fn correction(&self, class: &str) -> f64 {
        let all = || self.passed.values().fold([0.0, 0.0], |[a, b], [c, d]| [a + c, b + d]);
        let [estimated, passed] = self.passed.get(class).copied().unwrap_or_else(all);
        if estimated > 0.0 { passed / estimated } else { 1.0 }
    }
}

impl Estimate {
    /// Worthwhile repetitions.
    fn wanted(&self, round: f64) -> usize {
        let fill = if round > 0.0 { (SPAN / round) as usize } else { 0 };
        fill.clamp(self.repetitions, MOST * self.repetitions)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn task(class: &str, seconds: &[f64]) -> Estimate {
        Estimate { class: class.to_owned(), seconds: seconds.to_vec(), repetitions: 5 }
    }

    fn decision(variants: usize, warm_up: bool, repetitions: usize) -> Decision {
        Decision { variants, rounds: Rounds { warm_up, repetitions } }
    }

    #[test]
    fn with_time_enough_all_is_repeated() {
        let schedule = Schedule::new(vec![task("a", &[1.0, 2.0]), task("a", &[0.01])]);
        assert_eq!(schedule.decide(0, 1000.0), decision(2, true, 5));
        assert_eq!(schedule.decide(1, 1000.0), decision(1, true, 20));
    }

    #[test]
    fn repetitions_go_before_rows_and_the_last_rows_go_first() {
        let schedule = Schedule::new(vec![task("a", &[2.0, 2.0]), task("a", &[5.0, 5.0])]);
        // 11 are reserved for the second.
        assert_eq!(schedule.decide(0, 11.0 + 16.5), decision(2, true, 3));
        assert_eq!(schedule.decide(0, 11.0 + 4.5), decision(2, false, 1));
        assert_eq!(schedule.decide(0, 5.0), decision(2, false, 1));
        assert_eq!(schedule.decide(0, 3.0), decision(1, false, 1));
        assert_eq!(schedule.decide(1, 4.0), decision(0, false, 1));
    }

    #[test]
    fn cheap_tasks_are_repeated_though_dear_ones_follow() {
        let schedule = Schedule::new(vec![task("a", &[0.1]), task("a", &[0.3]), task("b", &[500.0])]);
        assert_eq!(schedule.decide(0, 100.0), decision(1, true, 10));
        // Two seconds are a small share, and suffice for six rounds.
        assert_eq!(schedule.decide(1, 100.0), decision(1, true, 5));
        assert_eq!(schedule.decide(1, 50.0), decision(1, true, 2));
    }

    #[test]
    fn what_tasks_took_corrects_the_estimates() {
        let mut schedule = Schedule::new(vec![task("a", &[1.0]), task("a", &[1.0]), task("b", &[1.0])]);
        schedule.done(0, decision(1, true, 5), 18.0);
        assert_eq!((schedule.round(1), schedule.round(2), schedule.remaining(1)), (3.0, 3.0, 6.0));
        schedule.done(2, decision(1, false, 1), 0.5);
        assert_eq!((schedule.round(1), schedule.round(2)), (3.0, 0.5));
    }

    #[test]
    fn what_is_wanted_once_is_not_warmed_up() {
        let once = Estimate { repetitions: 1, ..task("a", &[10.0]) };
        let schedule = Schedule::new(vec![once]);
        assert_eq!(schedule.decide(0, 100.0), decision(1, false, 1));
    }
}
