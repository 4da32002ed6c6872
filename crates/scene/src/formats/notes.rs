//! Oddities of a text file that are read all the same. One warning for each kind says where the first is, and how many there are.

use std::path::Path;

/// The kinds found so far.
#[derive(Debug, Default)]
pub struct Notes(Vec<Note>);

#[derive(Debug)]
struct Note {
    /// A predicate: "is ignored".
    kind: &'static str,
    count: usize,
    /// Of the first: its line, and what is there.
    line: usize,
    subject: String,
}

impl Notes {
    /// Counts one; `first` is called for the first of its kind and returns its line and a quotation.
    pub fn add(&mut self, kind: &'static str, first: impl FnOnce() -> (usize, String)) {
        if let Some(known) = self.0.iter_mut().find(|note| note.kind == kind) {
            known.count += 1;
        } else {
            let (line, subject) = first();
            self.0.push(Note { kind, count: 1, line, subject });
        }
    }

    /// A sentence for each kind.
    pub fn warnings(self, path: &Path) -> impl Iterator<Item = String> {
        self.0.into_iter().map(move |Note { kind, count, line, subject }| {
            let all = if count > 1 { format!(" (the first of {count})") } else { String::new() };
            format!("{}:{line}: `{subject}` {kind}{all}", path.display())
        })
    }
}
