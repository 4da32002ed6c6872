//! What was run, where, and how.

use super::document::{Block, Cell, Column, Finding, Section, Table, Verdict};
use super::numbers;
use super::runs::{Run, Runs};

/// Seconds of a minute.
const MINUTE: f64 = 60.0;

/// The name of the table of facts.
pub(crate) const TABLE: &str = "runs";

/// What is told of a run.
type Fact = fn(&Run) -> String;

/// A column a run, a line a fact; then what the runs have to note.
pub(crate) fn section(runs: &Runs) -> Section {
    let columns = runs.0.iter().map(|run| Column::words(run.label.as_str(), run.label.as_str()));
    let columns = std::iter::once(Column::words("fact", "")).chain(columns).collect();
    let mut table = Table::new(TABLE, "One column for each file of results.", columns);
    let facts: [(&str, Fact); 9] = [
        ("Suite", |run| format!("{}{}", run.results.suite, if run.results.quick { ", the short form" } else { "" })),
        ("Processor", |run| format!("{}, {} threads", run.results.machine.cpu, run.results.machine.threads)),
        ("Memory", |run| numbers::bytes(run.results.machine.memory_bytes as f64)),
        ("System", |run| run.results.machine.os.clone()),
        ("GPU, driver", gpus),
        ("Program", |run| format!("{} {}", run.results.program.name, run.results.program.version)),
        ("Commit", |run| run.results.program.commit.clone().unwrap_or_else(|| "unknown".to_owned())),
        ("Command", |run| run.results.program.command.clone()),
        ("Begun, took", |run| format!("{}, {}", run.results.started, duration(run.results.seconds))),
    ];
    for (name, fact) in facts {
        table.rows.push(std::iter::once(Cell::from(name)).chain(runs.0.iter().map(|run| fact(run).into())).collect());
    }
    let mut blocks = vec![Block::Table(table)];
    let notes: Vec<Finding> = runs
        .0
        .iter()
        .flat_map(|run| run.results.notes.iter().map(move |note| (run, note)))
        .map(|(run, note)| {
            let text = if runs.0.len() > 1 { format!("{}: {note}", run.label) } else { note.clone() };
            Finding::new(Verdict::Open, text)
        })
        .collect();
    if !notes.is_empty() {
        blocks.push(Block::Findings(notes));
    }
    Section::new("What was run", blocks)
}

fn gpus(run: &Run) -> String {
    let gpus = run.results.machine.gpus.iter();
    let gpus: Vec<String> =
        gpus.map(|gpu| format!("{}, {}, {}", gpu.name, numbers::bytes(gpu.memory_bytes as f64), gpu.driver)).collect();
    if gpus.is_empty() { "none used".to_owned() } else { gpus.join("; ") }
}

fn duration(seconds: f64) -> String {
    if seconds < MINUTE {
        format!("{} s", numbers::significant(seconds, 2))
    } else {
        format!("{:.0} min {:02.0} s", (seconds / MINUTE).floor(), (seconds % MINUTE).floor())
    }
}
