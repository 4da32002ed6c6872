//! References in documents to files of the repository: links, and paths in backticks. Fenced blocks are skipped.

use std::path::Path;
use std::{fmt, fs};

/// Extensions of the repository's files.
const EXTENSIONS: [&str; 10] = ["rs", "md", "toml", "png", "svg", "json", "cu", "cuh", "h", "yml"];

/// A reference to a missing file.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Problem {
    pub(crate) document: String,
    pub(crate) line: usize,
    pub(crate) target: String,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Problem { document, line, target } = self;
        write!(f, "{document}:{line}: there is no `{target}`; correct the document or restore the file")
    }
}

/// A reference in a document.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Pointer {
    /// Relative to the document's folder.
    Link(String),
    /// Relative to the root.
    Path(String),
}

/// Whether the target of a reference exists. `folder` is the document's.
pub(crate) fn leads_somewhere(pointer: &Pointer, root: &Path, folder: &Path) -> bool {
    match pointer {
        Pointer::Link(target) => exists(folder, target),
        Pointer::Path(target) => exists(root, target),
    }
}

/// All references of a document with their lines.
pub(crate) fn pointers(root: &Path, text: &str) -> Vec<(usize, Pointer)> {
    let mut found = Vec::new();
    let mut fenced = false;
    for (number, line) in text.lines().enumerate() {
        if line.trim_start().starts_with("```") {
            fenced = !fenced;
            continue;
        }
        if fenced {
            continue;
        }
        let pieces: Vec<&str> = line.split('`').collect();
        let code = pieces.iter().skip(1).step_by(2).filter(|code| is_path(root, code));
        found.extend(code.map(|code| (number + 1, Pointer::Path((*code).to_owned()))));
        found.extend(links(line).map(|link| (number + 1, Pointer::Link(link.to_owned()))));
    }
    found
}

/// The targets of relative links, without the part after `#`.
fn links(line: &str) -> impl Iterator<Item = &str> {
    let markdown = line.split("](").skip(1).filter_map(|rest| rest.split([')', ' ']).next());
    let html = ["src=\"", "href=\""].into_iter().flat_map(|name| line.split(name).skip(1));
    let html = html.filter_map(|rest| rest.split('"').next());
    markdown.chain(html).filter_map(|target| {
        let file = target.split('#').next().unwrap_or_default();
        (!file.is_empty() && !target.contains("://") && !target.starts_with("mailto:")).then_some(file)
    })
}

/// Whether a code span is a path in the repository: it has a slash, and either an extension of our files or one of our folders as
/// its first part. Build products in `target` and paths outside the repository are not.
fn is_path(root: &Path, code: &str) -> bool {
    let letter = |c: char| c.is_ascii_alphanumeric() || "_-./<>*".contains(c);
    let Some((first, rest)) = code.split_once('/') else { return false };
    if !code.chars().all(letter) || matches!(first, "" | "." | ".." | "target") {
        return false;
    }
    let ends_as_ours =
        rest.is_empty() || code.ends_with('/') || EXTENSIONS.iter().any(|ending| has_ending(code, ending));
    ends_as_ours || root.join(first).is_dir()
}

fn has_ending(path: &str, ending: &str) -> bool {
    Path::new(path).extension().is_some_and(|extension| extension == ending)
}

/// Whether a file or folder exists. A part with `<name>` or `*` matches any name with the same beginning and end; one match is
/// enough.
fn exists(folder: &Path, path: &str) -> bool {
    let (part, rest) = path.split_once('/').unwrap_or((path, ""));
    if part.is_empty() {
        return folder.is_dir();
    }
    let ends = |next: &Path| if path.contains('/') { exists(next, rest) } else { next.exists() };
    let Some((before, after)) = wildcard(part) else { return ends(&folder.join(part)) };
    let Ok(entries) = fs::read_dir(folder) else { return false };
    entries.flatten().any(|entry| {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        name.len() >= before.len() + after.len()
            && name.starts_with(before)
            && name.ends_with(after)
            && ends(&entry.path())
    })
}

/// The text before and after a wildcard.
fn wildcard(part: &str) -> Option<(&str, &str)> {
    part.split_once('*').or_else(|| {
        let (before, rest) = part.split_once('<')?;
        Some((before, rest.split_once('>')?.1))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn root() -> &'static Path {
        Path::new(env!("CARGO_MANIFEST_DIR"))
    }

    #[test]
    fn links_are_found_and_addresses_left_alone() {
        let line = "![a](x.png) [b](y.md#part \"t\") [c](https://a.b/c) [d](#here) <img src=\"z.png\"> [e](mailto:a@b)";
        assert_eq!(links(line).collect::<Vec<_>>(), ["x.png", "y.md", "z.png"]);
    }

    #[test]
    fn paths_are_told_from_other_code() {
        for code in ["src/main.rs", "src/gone.rs", "gone/x.md", "gone/", "src/<name>/cpu.rs", "src/anything"] {
            assert!(is_path(root(), code), "{code}");
        }
        for code in
            ["r/h", "cargo test", "main.rs", "a / b", "../shared/scenes", "target/release/x", "--size", "/usr/x.h"]
        {
            assert!(!is_path(root(), code), "{code}");
        }
    }

    #[test]
    fn what_is_there_is_found_and_nothing_else() {
        for path in ["src/main.rs", "src", "src/", "src/*.rs", "<folder>/docs.rs", "Cargo.toml"] {
            assert!(exists(root(), path), "{path}");
        }
        for path in ["src/gone.rs", "gone/", "src/*.md", "<folder>/gone.rs", "src/main.rs/", "Cargo.toml/x"] {
            assert!(!exists(root(), path), "{path}");
        }
    }

    #[test]
    fn pointers_come_with_their_lines_and_without_fenced_blocks() {
        let text = "see `src/main.rs`\n```\n`src/gone.rs` [x](y)\n```\nand [it](src/docs.rs) or `r/h`\n";
        let expected = vec![(1, Pointer::Path("src/main.rs".to_owned())), (5, Pointer::Link("src/docs.rs".to_owned()))];
        assert_eq!(pointers(root(), text), expected);
    }

    #[test]
    fn a_report_names_document_line_and_target() {
        let problem = Problem { document: "README.md".to_owned(), line: 7, target: "gone/".to_owned() };
        assert_eq!(problem.to_string(), "README.md:7: there is no `gone/`; correct the document or restore the file");
    }
}
