//! Rejects circular imports: the modules of a crate must depend on each other in one direction.
//!
//! Every `use` of a module's own crate, and every path that is written out in the code, is followed to the file that defines the name, through
//! re-exports. So `child::name` in a module counts like `use child::name`: a module either has children that import from it, or calls them. Tests,
//! and imports for documentation only, may point in any direction. Re-exports themselves do not count, and methods are not followed.

mod graph;
mod imports;

use std::collections::BTreeMap;
use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

use self::graph::{circles, edges};
use self::imports::{Imports, Module};
use crate::verdict::{Outcome, Verdict};

pub(crate) fn check(root: &Path) -> Outcome {
    let mut problems = Vec::new();
    let mut files = 0;
    for folder in source_folders(root)? {
        let modules = modules_of(&root.join(&folder))?;
        files += modules.len();
        let circles = circles(&edges(&modules));
        let folder = folder.display();
        problems.extend(circles.iter().map(|circle| format!("{folder}: circular imports: {}", circle.join(" -> "))));
    }
    Ok(Verdict::new(problems, || format!("{files} modules without circular imports")))
}

/// The folders with the sources of crates, relative to the root, in order.
fn source_folders(root: &Path) -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let mut folders = vec![PathBuf::from("xtask/src")];
    for entry in fs::read_dir(root.join("crates"))? {
        folders.push(Path::new("crates").join(entry?.file_name()).join("src"));
    }
    folders.retain(|folder| root.join(folder).is_dir());
    folders.sort();
    Ok(folders)
}

/// All modules of a crate except tests.
fn modules_of(folder: &Path) -> Result<BTreeMap<Module, Imports>, Box<dyn Error>> {
    let mut modules = BTreeMap::new();
    let mut folders = vec![(folder.to_owned(), Module::new())];
    while let Some((folder, module)) = folders.pop() {
        let mut entries: Vec<PathBuf> =
            fs::read_dir(&folder)?.map(|entry| Ok(entry?.path())).collect::<Result<_, std::io::Error>>()?;
        entries.sort();
        for path in entries {
            let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            // A program beside a library is another crate.
            let is_root = |name: &str| name != "main" || !folder.join("lib.rs").exists();
            let own: Module = match name.as_str() {
                "lib" | "main" | "mod" if is_root(&name) => module.clone(),
                _ => module.iter().cloned().chain([name.clone()]).collect(),
            };
            if name == "tests" {
                continue;
            } else if path.is_dir() {
                folders.push((path, own));
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let imports = Imports::read(&fs::read_to_string(&path)?, &own);
                modules.insert(own.clone(), imports.map_err(|error| format!("{}: {error}", path.display()))?);
            }
        }
    }
    Ok(modules)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    fn crate_of(files: &[(&str, &str)]) -> BTreeMap<Module, Imports> {
        let module =
            |path: &str| path.split("::").filter(|part| !part.is_empty()).map(str::to_owned).collect::<Module>();
        files.iter().map(|(path, text)| (module(path), Imports::read(text, &module(path)).unwrap())).collect()
    }

    fn circles_of(files: &[(&str, &str)]) -> Vec<String> {
        circles(&edges(&crate_of(files))).iter().map(|circle| circle.join(" ")).collect()
    }

    #[test]
    fn a_circle_is_found_through_a_re_export() {
        let files = [
            ("", "mod a;\nmod b;\npub use a::A;"),
            ("a", "use crate::b::{B, C};\nuse std::fmt;"),
            ("b", "use super::A as Other;"),
        ];
        assert_eq!(circles_of(&files), ["a b a"]);
    }

    #[test]
    fn a_path_that_is_written_out_makes_a_circle() {
        let a = ("a", "use crate::b::B;\npub struct A;");
        for b in [
            "pub struct B(crate::a::A);",
            "fn b() { super::a::a() }",
            "fn b() -> impl Fn(<crate::a::A as Trait>::Out) + use<> { |_| {} }",
            "use super::a;\nfn b() { println!(\"{}\", a::NUMBER) }",
            "mod inner { type A = super::super::a::A; }",
            "#[error(\"{}\", crate::a::text(problem))]\nstruct B;",
        ] {
            assert_eq!(circles_of(&[a, ("b", b)]), ["a b a"], "{b}");
        }
        assert_eq!(
            circles_of(&[("a", "mod child;\nfn a() { child::run() }"), ("a::child", "use super::A;")]),
            ["a a::child a"]
        );
    }

    #[test]
    fn what_names_no_module_makes_no_circle() {
        let a = ("a", "use crate::b::B;\npub struct A;");
        for b in [
            "// crate::a::A",
            "/// [A](crate::a::A)\npub struct B;",
            "const B: &str = \"crate::a::A\";",
            "pub(in crate::a) struct B;",
            "#[cfg(test)]\nfn b() { crate::a::a() }\npub struct B;",
            "#[cfg(doc)]\nuse crate::a::A;",
            "pub use crate::a::A;",
            "fn b(this: B) { this.a::<u32>(); other::a::A }",
        ] {
            assert_eq!(circles_of(&[a, ("b", b)]), Vec::<String>::new(), "{b}");
        }
    }

    #[test]
    fn names_are_followed_through_globs_and_to_macros() {
        let files = [
            ("", "mod a;\nmod b;\npub use a::*;\npub fn run() { b::b() }"),
            ("a", "use crate::b;\npub struct A;\nmacro_rules! words { () => {} }"),
            ("b", "use crate::{A, words};"),
        ];
        assert_eq!(circles_of(&files), ["a b a"]);
        assert_eq!(
            circles_of(&[("", "mod a;\nfn main() { a::a() }\nstruct Root;"), ("a", "use crate::Root;")]),
            [" a "]
        );
        let macros = [("", ""), ("a", "use crate::b;\nmacro_rules! words { () => {} }"), ("b", "crate::words!();")];
        assert_eq!(circles_of(&macros), ["a b a"]);
    }

    #[test]
    fn tests_documentation_and_parents_make_no_circle() {
        let files = [
            ("", "pub use a::A;"),
            ("a", "mod part;\npub(crate) use part::Part;\n#[cfg(doc)]\nuse crate::b::B;\nuse glam::Vec3;"),
            ("a::part", "use super::super::c::{\n    One,\n    Two,\n};"),
            ("b", "use crate::a::Part;\n#[cfg(test)]\nmod tests {\n    use crate::d::D;\n}"),
            ("c", "use std::fmt;"),
            ("d", "use crate::b::B;"),
        ];
        assert_eq!(circles_of(&files), Vec::<String>::new());
        let b = vec!["b".to_owned()];
        assert_eq!(edges(&crate_of(&files))[&b], BTreeSet::from([vec!["a".to_owned(), "part".to_owned()]]));
    }

    #[test]
    fn trees_are_expanded() {
        let imports = Imports::read("use a::{b, c::{self, d, e as f}};", &Module::new()).unwrap();
        assert_eq!(
            imports.uses.iter().map(|path| path.join("::")).collect::<Vec<_>>(),
            ["a::b", "a::c", "a::c::d", "a::c::e"]
        );
    }
}
