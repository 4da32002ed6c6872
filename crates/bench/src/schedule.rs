//! What fits into the time there is.
//!
//! Tasks come in the order of their worth, each with an estimate of what one round of it takes. For each in turn, just before it runs:
//!
//! 1. the tasks after it are set aside time for one round each, with a margin;
//! 2. it gets as many rounds of what is left as it wants, one of them to warm up, but at least one, which then counts; rounds that take
//!    next to nothing, as those of a GPU beside those of a processor, it gets at any rate;
//! 3. where not even one fits, it keeps those of its variants, from the first, that do.
//!
//! So repetitions go first, then rows, the least worthy ones first. Estimates come from small trials and are wrong in a like way for
//! like tasks: what a task really took corrects those of its class.

use std::collections::BTreeMap;

use crate::measure::Rounds;

/// What is set aside for later tasks is so much more than their estimate.
const MARGIN: f64 = 1.1;
/// A task is not grudged so small a share of what is left, whatever comes after it.
const SMALL_SHARE: f64 = 0.02;
/// Cheap tasks are repeated for this many seconds,
const SPAN: f64 = 1.0;
/// but at most this many times as often as asked for.
const MOST: usize = 4;

/// A task as far as time is concerned.
#[derive(Clone, Debug)]
pub struct Estimate {
    /// Tasks of a class are misjudged alike: device and size, for instance.
    pub class: String,
    /// Seconds of one render of each variant.
    pub seconds: Vec<f64>,
    /// Repetitions that are wanted.
    pub repetitions: usize,
}

/// The plan for all tasks.
#[derive(Debug)]
pub struct Schedule {
    estimates: Vec<Estimate>,
    /// By class: the seconds that were estimated, and those that passed.
    passed: BTreeMap<String, [f64; 2]>,
}

/// What becomes of a task.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Decision {
    /// How many of its variants, from the first, are measured; 0: the task is left out.
    pub variants: usize,
    /// How often.
    pub rounds: Rounds,
}

impl Schedule {
    /// A plan for tasks in this order.
    pub fn new(estimates: Vec<Estimate>) -> Schedule {
        Schedule { estimates, passed: BTreeMap::new() }
    }

    /// What becomes of task `index`, with `left` seconds for it and all that follow.
    pub fn decide(&self, index: usize, left: f64) -> Decision {
        let task = &self.estimates[index];
        let later: f64 = (index + 1..self.estimates.len()).map(|later| self.round(later)).sum();
        let (round, free) = (self.round(index), (left - MARGIN * later).max(SMALL_SHARE * left));
        let all = task.seconds.len();
        let affordable = if round > 0.0 { free / round } else { f64::INFINITY };
        // Beside the warm-up.
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

    /// Task `index` took `seconds` for this decision.
    pub fn done(&mut self, index: usize, decision: Decision, seconds: f64) {
        let task = &self.estimates[index];
        let rounds = (decision.rounds.repetitions + usize::from(decision.rounds.warm_up)) as f64;
        let estimated = rounds * task.seconds.iter().take(decision.variants).sum::<f64>();
        let [sum, passed] = self.passed.entry(task.class.clone()).or_default();
        *sum += estimated;
        *passed += seconds;
    }

    /// Seconds that the tasks from `index` on take, for one round each.
    pub fn remaining(&self, index: usize) -> f64 {
        (index..self.estimates.len()).map(|task| self.round(task)).sum()
    }

    /// Seconds of one round.
    fn round(&self, index: usize) -> f64 {
        let task = &self.estimates[index];
        self.correction(&task.class) * task.seconds.iter().sum::<f64>()
    }

    /// How far estimates of a class were wrong; of all classes where it has not had its turn.
    fn correction(&self, class: &str) -> f64 {
        let all = || self.passed.values().fold([0.0, 0.0], |[a, b], [c, d]| [a + c, b + d]);
        let [estimated, passed] = self.passed.get(class).copied().unwrap_or_else(all);
        if estimated > 0.0 { passed / estimated } else { 1.0 }
    }
}

impl Estimate {
    /// Repetitions that are worth their time.
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
        // 11 are set aside for the second.
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
        // Two seconds are a small share, and make six rounds.
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
