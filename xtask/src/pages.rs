//! The book's pages: what they include exists, and links of what they include work from there, too.
//!
//! Pages are those of `book/src/SUMMARY.md`. A page has its own text and lines `{{#include FILE}}` or `{{#include FILE:ANCHOR}}`,
//! relative to the page. A link to a document leads to a page, or nowhere: documents that are no pages are not in the book.

use std::path::{Path, PathBuf};
use std::{fs, io};

use crate::references::{Pointer, Problem, leads_somewhere, pointers};

const FOLDER: &str = "book/src";

/// What was found.
pub(crate) struct Checked {
    pub(crate) problems: Vec<Problem>,
    pub(crate) count: usize,
    pub(crate) pages: usize,
}

/// Checks all pages.
pub(crate) fn check(root: &Path) -> Result<Checked, String> {
    let folder = root.join(FOLDER);
    let read = |name: &str| fs::read_to_string(folder.join(name)).map_err(|error| unreadable(name, &error));
    let summary = read("SUMMARY.md")?;
    let names: Vec<String> = pointers(root, &summary).into_iter().filter_map(|(_, pointer)| link(pointer)).collect();
    let mut checked = Checked { problems: Vec::new(), count: 0, pages: names.len() };
    for name in &names {
        let text = read(name)?;
        check_page(root, name, &text, &names, &mut checked);
    }
    Ok(checked)
}

fn unreadable(name: &str, error: &io::Error) -> String {
    format!("cannot read {FOLDER}/{name}: {error}; correct SUMMARY.md or restore the page")
}

fn link(pointer: Pointer) -> Option<String> {
    match pointer {
        Pointer::Link(target) => Some(target),
        Pointer::Path(_) => None,
    }
}

/// Checks a page and what it includes.
fn check_page(root: &Path, name: &str, text: &str, pages: &[String], checked: &mut Checked) {
    let page = Path::new(FOLDER).join(name);
    let folder = root.join(&page).parent().map_or_else(PathBuf::new, Path::to_owned);
    let mut problem = |line: usize, target: String| {
        checked.problems.push(Problem { document: page.display().to_string(), line, target });
    };
    let mut links: Vec<(usize, Pointer)> = pointers(root, text);
    for (line, target) in inclusions(text) {
        checked.count += 1;
        match included(&folder, target) {
            // The links of a document, at the line that includes it; its paths are checked where it is.
            Some(text) if target.contains(".md") => {
                let found = pointers(root, &text).into_iter().filter_map(|(_, pointer)| link(pointer));
                links.extend(found.map(|target| (line, Pointer::Link(target))));
            }
            Some(_) => {}
            None => problem(line, target.to_owned()),
        }
    }
    for (line, pointer) in links {
        checked.count += 1;
        let to_page = match &pointer {
            Pointer::Link(target) if has_page_name(target) => is_page(Path::new(name), target, pages),
            _ => true,
        };
        if !to_page || !leads_somewhere(&pointer, root, &folder) {
            let (Pointer::Link(target) | Pointer::Path(target)) = pointer;
            problem(line, target);
        }
    }
}

fn has_page_name(target: &str) -> bool {
    Path::new(target).extension().is_some_and(|extension| extension == "md")
}

/// Whether a link in a page leads to one of the pages.
fn is_page(from: &Path, target: &str, pages: &[String]) -> bool {
    let mut parts: Vec<&str> =
        from.parent().into_iter().flat_map(Path::iter).filter_map(|part| part.to_str()).collect();
    for part in target.split('/') {
        match part {
            "." => {}
            ".." if parts.pop().is_none() => return false,
            ".." => {}
            part => parts.push(part),
        }
    }
    pages.contains(&parts.join("/"))
}

/// What a page includes, with its lines. Code is included within fenced blocks.
fn inclusions(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.lines().enumerate().filter_map(|(number, line)| {
        let (_, rest) = line.split_once("{{#include ")?;
        Some((number + 1, rest.split_once("}}")?.0.trim()))
    })
}

/// The text of `FILE` or `FILE:ANCHOR`; none if the file or the anchor is missing.
fn included(folder: &Path, target: &str) -> Option<String> {
    let (file, anchor) = target.split_once(':').map_or((target, None), |(file, anchor)| (file, Some(anchor)));
    let text = fs::read_to_string(folder.join(file)).ok()?;
    let Some(anchor) = anchor else { return Some(text) };
    let names = |line: &str, word: &str| {
        let name = line.split_once(word).map(|(_, rest)| rest.trim_start().split([' ', '-']).next());
        name.flatten() == Some(anchor)
    };
    let mut lines = text.lines().skip_while(|line| !names(line, " ANCHOR:"));
    lines.next()?;
    let mut part = String::new();
    for line in lines {
        if names(line, "ANCHOR_END:") {
            return Some(part);
        }
        part += line;
        part.push('\n');
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A repository with a page and a document that it includes.
    fn problems(page: &str, document: &str) -> Vec<(usize, String)> {
        let root = tempfile::tempdir().unwrap();
        let folder = root.path().join(FOLDER);
        fs::create_dir_all(folder.join("deep")).unwrap();
        fs::write(folder.join("SUMMARY.md"), "# Summary\n\n- [A](deep/a.md)\n- [B](b.md)\n").unwrap();
        fs::write(folder.join("deep/a.md"), page).unwrap();
        fs::write(folder.join("b.md"), "# B\n").unwrap();
        fs::write(folder.join("no_page.md"), "# No page\n").unwrap();
        fs::write(root.path().join("DOCUMENT.md"), document).unwrap();
        let checked = check(root.path()).unwrap();
        assert_eq!(checked.pages, 2);
        checked.problems.into_iter().map(|problem| (problem.line, problem.target)).collect()
    }

    #[test]
    fn what_pages_include_and_link_is_found() {
        let document = "<!-- ANCHOR: first -->\nsee [b](../b.md)\n<!-- ANCHOR_END: first -->\n";
        let page =
            "# A\n\n{{#include ../../../DOCUMENT.md:first}}\n{{#include ../../../DOCUMENT.md}}\n[b](../b.md#part)\n";
        assert_eq!(problems(page, document), []);
    }

    #[test]
    fn missing_files_anchors_and_pages_are_reported_with_their_lines() {
        let page = "{{#include ../../../GONE.md}}\n```rust\n{{#include ../../../DOCUMENT.md:gone}}\n```\n[x](../no_page.md)\n\
                    {{#include ../../../DOCUMENT.md}}\n[x](../../../../../b.md)\n";
        let expected = [(1, "../../../GONE.md"), (3, "../../../DOCUMENT.md:gone"), (5, "../no_page.md")];
        let mut found = problems(page, "[b](b.md)\n<!-- ANCHOR: gone -->\nnever ends\n");
        found.sort();
        let mut expected: Vec<_> = expected.map(|(line, target)| (line, target.to_owned())).into();
        expected.extend([(6, "b.md".to_owned()), (7, "../../../../../b.md".to_owned())]);
        assert_eq!(found, expected);
    }
}
