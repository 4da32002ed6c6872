//! Facts about the runs.

use super::document::{Block, Cell, Column, Finding, Section, Table, Verdict};
use super::numbers;
use super::runs::{Run, Runs};
use crate::Gpu;

/// Seconds per minute.
const MINUTE: f64 = 60.0;

/// The name of the table of facts.
pub(crate) const TABLE: &str = "runs";

/// A fact about a run.
type Fact = fn(&Run) -> String;

/// Length after which a note with a list is shortened.
const LONG_NOTE: usize = 240;

/// One column per run, one line per fact.
pub(crate) fn section(runs: &Runs) -> Section {
    let columns = runs.0.iter().map(|run| Column::words(run.label.as_str(), run.label.as_str()));
    let columns = std::iter::once(Column::words("fact", "")).chain(columns).collect();
    let mut table = Table::new(TABLE, "One column per result file.", columns);
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
    for (name, fact) in facts {
        table.rows.push(std::iter::once(Cell::from(name)).chain(runs.0.iter().map(|run| fact(run).into())).collect());
    }
    Section::new("What was run", vec![Block::Table(table)])
}

/// Notes of the runs; `None` if there are none.
pub(crate) fn notes(runs: &Runs) -> Option<Section> {
    let notes: Vec<Finding> = runs
        .0
        .iter()
        .flat_map(|run| run.results.notes.iter().map(move |note| (run, shortened(note))))
        .map(|(run, note)| {
            let text = if runs.0.len() > 1 { format!("{}: {note}", run.label) } else { note };
            Finding::new(Verdict::Open, text)
        })
        .collect();
    (!notes.is_empty()).then(|| Section::new("Notes", vec![Block::Findings(notes)]))
}

/// The note; a long list is shortened to its beginning and the number of omitted items.
fn shortened(note: &str) -> String {
    const SEPARATOR: &str = "; ";
    let mut parts = note.split(SEPARATOR);
    let mut text = parts.next().unwrap_or_default().to_owned();
    let rest: Vec<&str> = parts.collect();
    let fit = rest
        .iter()
        .scan(text.len(), |length, part| {
            *length += SEPARATOR.len() + part.len();
            Some(*length)
        })
        .take_while(|length| *length <= LONG_NOTE)
        .count();
    for part in &rest[..fit] {
        text = text + SEPARATOR + part;
    }
    match rest.len() - fit {
        0 => text,
        left => format!("{text}{SEPARATOR}and {left} more, listed in the result file."),
    }
}

fn gpus(gpus: &[Gpu]) -> String {
    let memory = |gpu: &Gpu| numbers::bytes(gpu.memory_bytes as f64);
    let facts: Vec<String> =
        gpus.iter().map(|gpu| [gpu.name.clone(), memory(gpu), gpu.driver.clone()].join(", ")).collect();
    if facts.is_empty() { "none".to_owned() } else { facts.join("; ") }
}

fn duration(seconds: f64) -> String {
    if seconds < MINUTE {
        format!("{} s", numbers::significant(seconds, 2))
    } else {
        format!("{:.0} min {:02.0} s", (seconds / MINUTE).floor(), (seconds % MINUTE).floor())
    }
}

#[cfg(test)]
mod tests {
    use super::shortened;

    #[test]
    fn long_lists_break_off_and_count_the_rest() {
        assert_eq!(shortened("a; b; c."), "a; b; c.");
        let parts: Vec<String> = (0..100).map(|part| format!("part {part}")).collect();
        let short = shortened(&parts.join("; "));
        assert!(short.starts_with("part 0; part 1; ") && short.len() < 300, "{short}");
        let kept = short.matches("part ").count();
        assert!(short.ends_with(&format!("; and {} more, listed in the result file.", 100 - kept)), "{short}");
    }
}
