//! Generates tables in documents from results, so that every figure in them has been measured.
//!
//! A comment names the files, a table of the [report](crate::report) on them, and a selection:
//!
//! ```text
//! <!-- from docs/results/h200.json: timings; where scene=garden, size=2048; columns step, radius as R, median as ms -->
//! | h | R | ms |
//! |--:|--:|--:|
//! | 0.1 | 2.1 | 5.63 |
//! ```
//!
//! Files are separated by commas. A value may contain commas, too, as in `place=CPU, 2 threads`. Without `where` all rows are
//! selected, without `columns` all columns. Column names are those of the report; an unknown one is an error that lists them.
//! Paths are relative to the document. `cargo xtask readme` writes the tables, `cargo xtask readme --check` lists those that are
//! out of date.

use std::path::{Path, PathBuf};

use crate::report::{Report, ReportError, Selection, TableError};

/// The beginning of a comment above a table.
const BEGIN: &str = "<!-- from ";
const END: &str = " -->";

/// Why tables cannot be generated.
#[derive(Debug, thiserror::Error)]
#[error("line {line}: {reason}")]
pub struct ReadmeError {
    /// The comment's line, from 1.
    pub line: usize,
    /// The problem.
    pub reason: ReadmeFault,
}

/// What is wrong with a comment above a table.
#[derive(Debug, thiserror::Error)]
pub enum ReadmeFault {
    /// It has the wrong form.
    #[error(
        "`{0}` is not of the form `<!-- from FILE.json: TABLE; where COLUMN=VALUE; columns NAME as TITLE -->`; correct it"
    )]
    Form(String),
    /// The results cannot be read.
    #[error(transparent)]
    Report(#[from] ReportError),
    /// They do not have the requested table.
    #[error(transparent)]
    Table(#[from] TableError),
}

/// A document with tables from results.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tables {
    /// The document with all tables up to date.
    pub text: String,
    /// Lines, from 1, of the comments whose tables were out of date.
    pub differing: Vec<usize>,
    /// The number of tables.
    pub count: usize,
}

/// The selection of a comment.
#[derive(Debug, PartialEq, Eq)]
struct Request {
    files: Vec<PathBuf>,
    selection: Selection,
}

/// Regenerates the tables of a document. Comments in fenced blocks are examples and ignored.
///
/// # Errors
/// [`ReadmeError`] for the first comment with a problem.
pub fn tables(text: &str, root: &Path) -> Result<Tables, ReadmeError> {
    let mut tables = Tables { text: String::with_capacity(text.len()), differing: Vec::new(), count: 0 };
    let mut lines = text.lines().enumerate().peekable();
    let mut fenced = false;
    while let Some((index, line)) = lines.next() {
        tables.text += line;
        tables.text.push('\n');
        fenced ^= line.trim_start().starts_with("```");
        if fenced || !line.starts_with(BEGIN) {
            continue;
        }
        let wanted = wanted(line, root).map_err(|reason| ReadmeError { line: index + 1, reason })?;
        let mut found = String::new();
        while let Some((_, line)) = lines.next_if(|(_, line)| line.starts_with('|')) {
            found += line;
            found.push('\n');
        }
        tables.count += 1;
        if found != wanted {
            tables.differing.push(index + 1);
        }
        tables.text += &wanted;
    }
    if !text.ends_with('\n') {
        tables.text.pop();
    }
    Ok(tables)
}

/// The table selected by a comment.
fn wanted(comment: &str, root: &Path) -> Result<String, ReadmeFault> {
    let request = parse(comment).ok_or_else(|| ReadmeFault::Form(comment.to_owned()))?;
    let files: Vec<PathBuf> = request.files.iter().map(|file| root.join(file)).collect();
    Ok(Report::open(&files)?.table(&request.selection)?)
}

fn parse(comment: &str) -> Option<Request> {
    let inner = comment.trim_end().strip_prefix(BEGIN)?.strip_suffix(END)?;
    let (files, rest) = inner.split_once(": ")?;
    let mut parts = rest.split(';').map(str::trim);
    let mut selection = Selection { table: parts.next()?.to_owned(), ..Selection::default() };
    for part in parts {
        let (word, list) = part.split_once(' ')?;
        let list = list.split(',').map(str::trim);
        match word {
            "where" => {
                for part in list {
                    match (part.split_once('='), selection.conditions.last_mut()) {
                        (Some((column, value)), _) => {
                            selection.conditions.push((column.trim().to_owned(), value.trim().to_owned()));
                        }
                        // After a comma, text that is not a condition belongs to the value before it.
                        (None, Some((_, value))) => *value += &format!(", {part}"),
                        (None, None) => return None,
                    }
                }
            }
            "columns" => selection.columns.extend(list.map(|column| match column.split_once(" as ") {
                Some((name, title)) => (name.trim().to_owned(), Some(title.trim().to_owned())),
                None => (column.to_owned(), None),
            })),
            _ => return None,
        }
    }
    Some(Request { files: files.split(',').map(|file| PathBuf::from(file.trim())).collect(), selection })
}

#[cfg(test)]
mod tests;
