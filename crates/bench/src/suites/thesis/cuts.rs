//! What was cut for want of time, and how it is told.

use std::collections::BTreeMap;

use super::task::Task;
use crate::schedule::Decision;

/// Rows that got less time than they wanted.
#[derive(Default)]
pub(super) struct Cuts {
    /// By repetitions and experiment: the number of rows with fewer repetitions than wanted.
    fewer: BTreeMap<usize, BTreeMap<String, usize>>,
    /// Ids of rows that were left out.
    out: Vec<String>,
}

impl Cuts {
    /// Takes note of what was decided for a task.
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

    /// A sentence for each number of repetitions, and one that names all that was left out.
    pub(super) fn notes(&self) -> Vec<String> {
        let fewer = self.fewer.iter().filter(|(_, rows)| !rows.is_empty()).map(|(repetitions, rows)| {
            let rows: Vec<String> = rows.iter().map(|(experiment, count)| format!("{count} of {experiment}")).collect();
            let times = if *repetitions == 1 {
                "once, without warm-up".to_owned()
            } else {
                format!("{repetitions} times after a warm-up")
            };
            format!("For want of time measured {times}: {}.", rows.join(", "))
        });
        let out = (!self.out.is_empty())
            .then(|| format!("For want of time left out, {} rows: {}.", self.out.len(), self.out.join("; ")));
        fewer.chain(out).collect()
    }
}
