//! Tables of documents that are made from results, so that no figure stands where nothing was measured.
//!
//! A comment names the files, a table of the [report](crate::report) on them, and what of it is wanted:
//!
//! ```text
//! <!-- from docs/results/h200.json: timings; where scene=garden, size=2048; columns step, radius as R, median as ms -->
//! | h | R | ms |
//! |--:|--:|--:|
//! | 0.1 | 2.1 | 5.63 |
//! ```
//!
//! Several files have commas between them. A value may hold commas too, as in `place=CPU, 2 threads`. Without `where` all rows are
//! taken, without `columns` all columns. Names of columns are those of the report; a misspelt one is refused with a list of them.
//! Paths are relative to the document. `cargo xtask readme` writes the tables, `cargo xtask readme --check` says which are not as
//! they should be.

use std::path::{Path, PathBuf};

use crate::report::{Report, ReportError, Selection, TableError};

/// How a comment above a table begins.
const BEGIN: &str = "<!-- from ";
const END: &str = " -->";

/// Why tables cannot be made.
#[derive(Debug, thiserror::Error)]
#[error("line {line}: {reason}")]
pub struct ReadmeError {
    /// The comment's line, from 1.
    pub line: usize,
    /// What is wrong there.
    pub reason: ReadmeFault,
}

/// What is wrong with a comment above a table.
#[derive(Debug, thiserror::Error)]
pub enum ReadmeFault {
    /// It is not of the form that is understood.
    #[error(
        "`{0}` is not of the form `<!-- from FILE.json: TABLE; where COLUMN=VALUE; columns NAME as TITLE -->`; correct it"
    )]
    Form(String),
    /// There are no such results.
    #[error(transparent)]
    Report(#[from] ReportError),
    /// They have no such table.
    #[error(transparent)]
    Table(#[from] TableError),
}

/// A document with tables from results.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tables {
    /// The document with every table as it should be.
    pub text: String,
    /// Lines, from 1, of the comments whose tables were otherwise.
    pub differing: Vec<usize>,
    /// How many tables there are.
    pub count: usize,
}

/// What a comment asks for.
#[derive(Debug, PartialEq, Eq)]
struct Request {
    files: Vec<PathBuf>,
    selection: Selection,
}

/// Makes the tables of a document anew. Comments in fenced blocks are examples, and left alone.
///
/// # Errors
/// [`ReadmeError`] for the first comment that cannot be followed.
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

/// The table that a comment asks for.
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
                        // What follows a comma and is no condition belongs to the value before it.
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
