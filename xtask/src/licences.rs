//! Every dependency, also of the fuzz targets, must be under a licence that the project may pass on.
//!
//! `cargo metadata` names the packages that are built for *any* target, test and build dependencies included, each with an
//! SPDX expression. An expression passes where [`ALLOWED`] satisfies it: one side of an `OR`, both sides of an `AND`, and for
//! `WITH` the pair of licence and exception.

use std::error::Error;
use std::path::Path;
use std::process::Command;
use std::{env, fmt};

use serde_json::Value;
use spdx::{Expression, Licensee, ParseMode};

use crate::{Outcome, Verdict};

/// Permissive licences. What is missing here and needed may be added after a look at its text.
const ALLOWED: [&str; 13] = [
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
    "NCSA",
    "Unicode-3.0",
    "Zlib",
];

/// A package that is built, and what it says of its licence.
struct Package {
    name: String,
    version: String,
    license: Option<String>,
    license_file: Option<String>,
    manifest_path: String,
}

/// A package that must not be used as it is.
struct Problem {
    /// Name and version.
    package: String,
    fault: Fault,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}: {}; {}", self.package, self.fault, self.fault.remedy())
    }
}

/// What is wrong with a licence.
#[derive(Debug, PartialEq, Eq)]
enum Fault {
    NotAllowed { expression: String, needed: Vec<String> },
    Unreadable { expression: String, reason: String },
    None { manifest: String, file: Option<String> },
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Fault::NotAllowed { expression, needed } => {
                write!(f, "`{expression}` needs {}, which the project may not use", needed.join(", "))
            }
            Fault::Unreadable { expression, reason } => write!(f, "`{expression}` is no SPDX expression ({reason})"),
            Fault::None { manifest, file: None } => write!(f, "no licence in {manifest}"),
            Fault::None { manifest, file: Some(file) } => write!(f, "no licence in {manifest} but the file {file}"),
        }
    }
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

/// Checks the workspace in `root`, and that of the fuzz targets.
pub(crate) fn check(root: &Path) -> Outcome {
    let mut packages = packages(&metadata(root)?)?;
    packages.extend(self::packages(&metadata(&root.join("fuzz"))?)?);
    packages.sort_by(|a, b| a.key().cmp(&b.key()));
    packages.dedup_by(|a, b| a.key() == b.key());
    let problems: Vec<Problem> = packages.iter().filter_map(Package::problem).collect();
    Ok(Verdict::new(problems, || format!("{} packages, all under licences that may be used", packages.len())))
}

/// What Cargo knows of the workspace, as JSON.
fn metadata(root: &Path) -> Result<Value, Box<dyn Error>> {
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let answer = Command::new(cargo)
        .args(["metadata", "--format-version", "1", "--all-features", "--locked"])
        .current_dir(root)
        .output()
        .map_err(|error| {
            format!("cannot run `cargo metadata` ({error}); start this check with `cargo xtask licences`")
        })?;
    if !answer.status.success() {
        return Err(
            format!("`cargo metadata --locked` failed: {}", String::from_utf8_lossy(&answer.stderr).trim()).into()
        );
    }
    Ok(serde_json::from_slice(&answer.stdout)?)
}

/// The packages of the answer; an error where it has none, so that nothing passes unseen.
fn packages(metadata: &Value) -> Result<Vec<Package>, String> {
    let packages = metadata["packages"].as_array().map_or(&[][..], Vec::as_slice);
    let packages: Option<Vec<Package>> = packages.iter().map(Package::read).collect();
    packages
        .filter(|packages| !packages.is_empty())
        .ok_or_else(|| "`cargo metadata` answered something unknown".to_owned())
}

impl Package {
    fn read(entry: &Value) -> Option<Package> {
        let text = |key: &str| entry[key].as_str().map(str::to_owned);
        Some(Package {
            name: text("name")?,
            version: text("version")?,
            license: text("license"),
            license_file: text("license_file"),
            manifest_path: text("manifest_path")?,
        })
    }

    /// What tells packages apart.
    fn key(&self) -> (&str, &str) {
        (&self.name, &self.version)
    }

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
        let package = serde_json::json!({
            "name": "a", "version": "1.0.0", "license": null, "license_file": "L", "manifest_path": "a/Cargo.toml"
        });
        let packages = packages(&serde_json::json!({ "packages": [package], "version": 1 })).unwrap();
        assert_eq!((packages[0].name.as_str(), packages[0].license_file.as_deref()), ("a", Some("L")));
    }

    #[test]
    fn an_answer_without_packages_does_not_pass() {
        for answer in
            [serde_json::json!({}), serde_json::json!({ "packages": [] }), serde_json::json!({ "packages": [{}] })]
        {
            assert!(packages(&answer).is_err(), "{answer}");
        }
    }
}
