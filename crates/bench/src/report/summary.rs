//! Facts about the runs.

use super::document::{Block, Cell, Column, Section, Table};
use super::numbers;
use super::runs::{Run, Runs};
use crate::Gpu;

/// The name of the table of facts, which are sentences.
pub(crate) const TABLE: &str = "runs";

/// A fact about a run.
type Fact = fn(&Run) -> String;

/// One column per run, one line per fact.
pub(crate) fn section(runs: &Runs) -> Section {
    let facts: [(&str, Fact); 9] = [
        ("Suite", |run| format!("{}{}", run.results.suite, if run.results.quick { ", the short version" } else { "" })),
        ("CPU", |run| format!("{}, {} threads", run.results.machine.cpu, run.results.machine.threads)),
        ("Memory", |run| numbers::bytes(run.results.machine.memory_bytes as f64)),
        ("System", |run| run.results.machine.os.clone()),
        ("GPU, driver", |run| gpus(&run.results.machine.gpus)),
        ("Program", |run| format!("{} {}", run.results.program.name, run.results.program.version)),
        ("Commit", |run| run.results.program.commit.clone().unwrap_or_else(|| "unknown".to_owned())),
        ("Command", |run| run.results.program.command.clone()),
        ("Started, took", |run| format!("{}, {}", run.results.started, duration(run.results.seconds))),
    ];
    let mut table = Table::new(TABLE, "One column per result file.", facts.len());
    table.add(Column::words("fact", ""), facts.iter().map(|(name, _)| (*name).into()));
    for run in &runs.0 {
        table.add(Column::words(&run.label, &run.label), facts.iter().map(|(_, fact)| Cell::from(fact(run))));
    }
    Section { title: "Runs and machines".to_owned(), blocks: vec![Block::Table(table)] }
}

/// Notes of the runs; `None` if there are none.
pub(crate) fn notes(runs: &Runs) -> Option<Section> {
    let label = |run: &Run| if runs.0.len() > 1 { format!("{}: ", run.label) } else { String::new() };
    let of =
        |run: &Run| run.results.notes.iter().map(|note| Block::Text(label(run) + &short(note))).collect::<Vec<_>>();
    let blocks: Vec<Block> = runs.0.iter().flat_map(of).collect();
    (!blocks.is_empty()).then(|| Section { title: "Notes".to_owned(), blocks })
}

/// The note, without the rest of a long list.
fn short(note: &str) -> String {
    let begin = note.char_indices().nth(240).and_then(|(end, _)| note[..end].rsplit_once("; "));
    begin.map_or_else(|| note.to_owned(), |(begin, _)| format!("{begin}; and more, which the result file lists."))
}

fn gpus(gpus: &[Gpu]) -> String {
    let facts = |gpu: &Gpu| format!("{}, {}, {}", gpu.name, numbers::bytes(gpu.memory_bytes as f64), gpu.driver);
    let facts: Vec<String> = gpus.iter().map(facts).collect();
    if facts.is_empty() { "none".to_owned() } else { facts.join("; ") }
}

fn duration(seconds: f64) -> String {
    const MINUTE: f64 = 60.0;
    if seconds < MINUTE {
        format!("{} s", numbers::significant(seconds, 2))
    } else {
        format!("{:.0} min {:02.0} s", (seconds / MINUTE).floor(), (seconds % MINUTE).floor())
    }
}
