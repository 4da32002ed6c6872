//! Documents must not refer to missing files.
//!
//! Three kinds of reference are checked: targets of Markdown or HTML links, relative to the document; paths in backticks,
//! relative to the repository's root, as [recognised](crate::references); and what pages of the book [include](super::pages). Links of an
//! included document must lead to a file from both places. Fenced blocks are skipped: they contain commands and examples.

use std::fs;
use std::path::Path;

use crate::pages;
use crate::references::{Pointer, Problem, leads_somewhere, pointers};
use crate::verdict::{Outcome, Verdict};

/// The documents that describe the repository; the book's pages come from its table of contents.
const DOCUMENTS: [&str; 15] = [
    "README.md",
    "ARCHITECTURE.md",
    "docs/method/occluder_lists.md",
    "docs/method/thesis.md",
    "docs/method/surroundings.md",
    "docs/method/surfaces.md",
    "docs/method/devices_and_numbers.md",
    "CONTRIBUTING.md",
    "SECURITY.md",
    "CODE_OF_CONDUCT.md",
    "docs/results/README.md",
    "bench/kernels/README.md",
    "bench/peers/README.md",
    "bench/sheet/README.md",
    "findings/README.md",
];

/// Checks the documents in `root`.
pub(crate) fn check(root: &Path) -> Outcome {
    let (mut problems, mut count) = (Vec::new(), 0);
    for document in DOCUMENTS {
        let path = root.join(document);
        let text = fs::read_to_string(&path).map_err(|error| format!("cannot read {document}: {error}"))?;
        let folder = path.parent().unwrap_or(root);
        for (line, pointer) in pointers(root, &text) {
            count += 1;
            if !leads_somewhere(&pointer, root, folder) {
                let (Pointer::Link(target) | Pointer::Path(target)) = pointer;
                problems.push(Problem { document: document.to_owned(), line, target });
            }
        }
    }
    let book = pages::check(root)?;
    problems.extend(book.problems);
    count += book.count;
    let documents = DOCUMENTS.len();
    Ok(Verdict::new(problems, || {
        format!("{count} links, paths and inclusions in {documents} documents and {} pages, all present", book.pages)
    }))
}
