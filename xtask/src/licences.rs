//! Every dependency must be under a licence that the project may pass on.
//!
//! `cargo metadata` names the packages that are built for *any* target, test and build dependencies included, each with an
//! SPDX expression. An expression passes where [`ALLOWED`] satisfies it: one side of an `OR`, both sides of an `AND`, and for
//! `WITH` the pair of licence and exception.

use std::path::Path;
use std::process::Command;

use serde::Deserialize;
use spdx::{Expression, Licensee, ParseMode};

use crate::Verdict;

/// Permissive licences. What is missing here and needed may be added after a look at its text.
const ALLOWED: [&str; 12] = [
    "0BSD",
    "Apache-2.0",
    "Apache-2.0 WITH LLVM-exception",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "BSL-1.0",
    "CC0-1.0",
    "ISC",
    "MIT",
    "MIT-0",
    "Unicode-3.0",
    "Zlib",
];

/// Why licences could not be checked.
#[derive(Debug, thiserror::Error)]
pub(crate) enum LicencesError {
    /// Cargo could not be started.
    #[error("cannot run `cargo metadata`: {0}; start this check with `cargo xtask licences`")]
    Start(std::io::Error),
    /// Cargo could not describe the workspace.
    #[error("`cargo metadata --locked` failed: {0}")]
    Cargo(String),
    /// Its answer is not of the form that it is documented to have.
    #[error("`cargo metadata` answered something unknown: {0}")]
    Answer(#[from] serde_json::Error),
}

/// What we read of `cargo metadata`.
#[derive(Deserialize)]
struct Metadata {
    packages: Vec<Package>,
}

/// A package that is built, and what it says of its licence.
#[derive(Deserialize)]
struct Package {
    name: String,
    version: String,
    license: Option<String>,
    license_file: Option<String>,
    manifest_path: String,
}

/// A package that must not be used as it is.
#[derive(Debug, thiserror::Error)]
#[error("{package}: {fault}; {}", fault.remedy())]
struct Problem {
    /// Name and version.
    package: String,
    fault: Fault,
}

#[derive(Debug, thiserror::Error, PartialEq, Eq)]
enum Fault {
    #[error("`{expression}` needs {}, which the project may not use", needed.join(", "))]
    NotAllowed { expression: String, needed: Vec<String> },
    #[error("`{expression}` is no SPDX expression ({reason})")]
    Unreadable { expression: String, reason: String },
    #[error("no licence in {manifest}{}", file.as_ref().map_or(String::new(), |file| format!(" but the file {file}")))]
    None { manifest: String, file: Option<String> },
}

impl Fault {
    fn remedy(&self) -> &'static str {
        match self {
            Fault::NotAllowed { .. } => {
                "take another crate or switch off the feature that brings it (`cargo tree -i CRATE --target all`); add the \
                 licence to ALLOWED in xtask/src/licences.rs only if it is permissive"
            }
            Fault::Unreadable { .. } => "take a version whose manifest is right, or another crate",
            Fault::None { .. } => "take another crate, or ask its authors for a `license` in the manifest",
        }
    }
}

/// Checks the workspace in `root`.
pub(crate) fn check(root: &Path) -> Result<Verdict, LicencesError> {
    let packages = packages(root)?;
    let problems: Vec<Problem> = packages.iter().filter_map(|package| package.problem()).collect();
    Ok(Verdict::new(problems, || format!("{} packages, all under licences that may be used", packages.len())))
}

fn packages(root: &Path) -> Result<Vec<Package>, LicencesError> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let answer = Command::new(cargo)
        .args(["metadata", "--format-version", "1", "--all-features", "--locked"])
        .current_dir(root)
        .output()
        .map_err(LicencesError::Start)?;
    if !answer.status.success() {
        return Err(LicencesError::Cargo(String::from_utf8_lossy(&answer.stderr).trim().to_owned()));
    }
    let Metadata { packages } = serde_json::from_slice(&answer.stdout)?;
    Ok(packages)
}

impl Package {
    fn problem(&self) -> Option<Problem> {
        let fault = match &self.license {
            Some(expression) => judge(expression).err(),
            None => Some(Fault::None { manifest: self.manifest_path.clone(), file: self.license_file.clone() }),
        };
        fault.map(|fault| Problem { package: format!("{} {}", self.name, self.version), fault })
    }
}

/// Whether the allowed licences satisfy `expression`. Crates of old write `MIT/Apache-2.0` for `MIT OR Apache-2.0`.
fn judge(expression: &str) -> Result<(), Fault> {
    let old_slash = ParseMode { allow_slash_as_or_operator: true, ..ParseMode::STRICT };
    let parsed = Expression::parse_mode(expression, old_slash)
        .map_err(|error| Fault::Unreadable { expression: expression.to_owned(), reason: error.reason.to_string() })?;
    let allowed =
        ALLOWED.map(|licence| Licensee::parse(licence).expect("ALLOWED holds SPDX names, which a test checks"));
    parsed.evaluate_with_failures(|needed| allowed.iter().any(|licence| licence.satisfies(needed))).map_err(|needed| {
        Fault::NotAllowed {
            expression: expression.to_owned(),
            needed: needed.iter().map(|failure| failure.req.to_string()).collect(),
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn passes(expression: &str) -> bool {
        judge(expression).is_ok()
    }

    #[test]
    fn every_allowed_licence_allows_itself() {
        for licence in ALLOWED {
            assert!(passes(licence), "{licence}");
        }
    }

    #[test]
    fn one_side_of_an_or_is_enough() {
        for expression in ["MIT OR Apache-2.0", "GPL-3.0-only OR MIT", "Unlicense OR MIT", "MIT/Apache-2.0"] {
            assert!(passes(expression), "{expression}");
        }
        for expression in ["GPL-3.0-only OR AGPL-3.0-only", "Unlicense OR WTFPL", "LGPL-2.1-only/MPL-2.0"] {
            assert!(!passes(expression), "{expression}");
        }
    }

    #[test]
    fn both_sides_of_an_and_are_needed() {
        assert!(passes("MIT AND BSD-3-Clause"));
        for expression in ["MIT AND GPL-3.0-only", "GPL-3.0-only AND MIT", "Apache-2.0 AND MIT AND MPL-2.0"] {
            assert!(!passes(expression), "{expression}");
        }
    }

    #[test]
    fn parentheses_bind_and_goes_before_or() {
        assert!(passes("(MIT OR Apache-2.0) AND Unicode-3.0"));
        assert!(passes("MIT OR Apache-2.0 AND GPL-3.0-only"));
        assert!(!passes("(MIT OR Apache-2.0) AND GPL-3.0-only"));
        assert!(!passes("(MIT AND GPL-3.0-only) OR (Zlib AND MPL-2.0)"));
    }

    #[test]
    fn an_exception_counts_only_with_its_licence() {
        assert!(passes("Apache-2.0 WITH LLVM-exception"));
        for expression in [
            "GPL-2.0-only WITH Classpath-exception-2.0",
            "MIT WITH LLVM-exception",
            "MIT AND GPL-3.0-only WITH GCC-exception-3.1",
        ] {
            assert!(!passes(expression), "{expression}");
        }
    }

    #[test]
    fn what_is_no_expression_fails() {
        for expression in ["", "MIT OR", "(MIT", "MIT Apache-2.0", "MITT", "LicenseRef-Own"] {
            assert!(!passes(expression), "{expression}");
        }
    }

    #[test]
    fn a_report_names_crate_expression_and_remedy() {
        let package = Package {
            name: "copyleft".to_owned(),
            version: "1.2.3".to_owned(),
            license: Some("MIT AND GPL-3.0-only".to_owned()),
            license_file: None,
            manifest_path: "copyleft/Cargo.toml".to_owned(),
        };
        let report = package.problem().map(|problem| problem.to_string()).unwrap_or_default();
        for part in ["copyleft 1.2.3", "`MIT AND GPL-3.0-only`", "needs GPL-3.0-only,", "cargo tree -i"] {
            assert!(report.contains(part), "{report}");
        }
    }

    #[test]
    fn a_package_without_an_expression_fails() {
        for license_file in [None, Some("LICENSE.txt".to_owned())] {
            let package = Package {
                name: "silent".to_owned(),
                version: "0.1.0".to_owned(),
                license: None,
                license_file,
                manifest_path: "silent/Cargo.toml".to_owned(),
            };
            assert!(matches!(package.problem(), Some(Problem { fault: Fault::None { .. }, .. })));
        }
    }

    #[test]
    fn the_answer_of_cargo_is_read() {
        let answer = r#"{"packages": [{"name": "a", "version": "1.0.0", "license": null, "license_file": "L", "manifest_path":
            "a/Cargo.toml", "targets": []}], "version": 1}"#;
        let Metadata { packages } = serde_json::from_str(answer).unwrap();
        assert_eq!((packages[0].name.as_str(), packages[0].license_file.as_deref()), ("a", Some("L")));
    }
}
