//! Reductions due to the time budget, and notes about them.

use std::collections::BTreeMap;

use super::task::Task;
use crate::schedule::Decision;

/// Rows that got less time than requested.
#[derive(Default)]
pub(super) struct Cuts {
    /// By repetitions and experiment: the number of rows with fewer repetitions than requested.
    fewer: BTreeMap<usize, BTreeMap<String, usize>>,
    /// Ids of rows that were dropped.
    out: Vec<String>,
}

impl Cuts {
    /// Records the decision about a task.
    pub(super) fn add(&mut self, task: &Task, decision: Decision) {
        let (kept, out) = task.cases.split_at(decision.variants);
        self.out.extend(out.iter().map(|case| case.row.id.clone()));
        if decision.rounds.repetitions < task.repetitions {
            let rows = self.fewer.entry(decision.rounds.repetitions).or_default();
            for case in kept {
                *rows.entry(case.row.experiment.clone()).or_default() += 1;
            }
        }
    }

    /// A sentence for each number of repetitions, and one that names all dropped rows.
    pub(super) fn notes(&self) -> Vec<String> {
        let fewer = self.fewer.iter().filter(|(_, rows)| !rows.is_empty()).map(|(repetitions, rows)| {
            let rows: Vec<String> = rows.iter().map(|(experiment, count)| format!("{count} of {experiment}")).collect();
            let times = if *repetitions == 1 {
                "once, without warm-up".to_owned()
            } else {
                format!("{repetitions} times after a warm-up")
            };
            format!("Measured only {times} because of the time budget: {}.", rows.join(", "))
        });
        let out = (!self.out.is_empty())
            .then(|| format!("Dropped because of the time budget, {} rows: {}.", self.out.len(), self.out.join("; ")));
        fewer.chain(out).collect()
    }
}
