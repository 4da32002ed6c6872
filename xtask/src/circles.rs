//! Rejects circular imports: the modules of a crate must depend on each other in one direction.
//!
//! Every `use` of a module's own crate is followed to the file that defines the imported name, through re-exports. Tests, and imports
//! for documentation only, may point in any direction. Re-exports, and paths written out in the code, do not count.

use std::collections::{BTreeMap, BTreeSet};
use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

use crate::{Outcome, Verdict};

/// Crates to check.
const CRATES: [&str; 3] = ["crates/kernels/src", "crates/trace/src", "crates/render/src"];

/// A module, as its path from the crate's root, such as `["accel", "bvh"]`.
type Module = Vec<String>;

/// The imports of a module.
#[derive(Debug, Default)]
struct Imports {
    /// Full paths of all imports.
    uses: Vec<Module>,
    /// Names that are re-exported, and their origins.
    exports: BTreeMap<String, Module>,
}

pub(crate) fn check(root: &Path) -> Outcome {
    let mut problems = Vec::new();
    let mut files = 0;
    for folder in CRATES {
        let modules = modules_of(&root.join(folder))?;
        files += modules.len();
        let circles = circles(&edges(&modules));
        problems.extend(circles.iter().map(|circle| format!("{folder}: circular imports: {}", circle.join(" -> "))));
    }
    Ok(Verdict::new(problems, || format!("{files} modules without circular imports")))
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
            let own: Module = match name.as_str() {
                "lib" | "main" | "mod" => module.clone(),
                _ => module.iter().cloned().chain([name.clone()]).collect(),
            };
            if name == "tests" {
                continue;
            } else if path.is_dir() {
                folders.push((path, own));
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let text = fs::read_to_string(&path)?;
                modules.insert(own.clone(), imports(&text, &own));
            }
        }
    }
    Ok(modules)
}

/// The imports of a module from its own crate, without those of tests and documentation.
fn imports(text: &str, module: &Module) -> Imports {
    let mut imports = Imports::default();
    // By convention tests come last.
    let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or(text);
    let mut lines = code.lines();
    let mut attribute = "";
    while let Some(line) = lines.next() {
        let line = line.trim();
        let skipped = matches!(std::mem::replace(&mut attribute, line), "#[cfg(test)]" | "#[cfg(doc)]");
        let exported = line.strip_prefix("pub use ").or_else(|| line.strip_prefix("pub(crate) use "));
        let Some(first) = exported.or_else(|| line.strip_prefix("use ")) else { continue };
        let mut statement = first.to_owned();
        while !statement.ends_with(';') {
            let Some(next) = lines.next() else { break };
            statement.push_str(next.trim());
        }
        if skipped {
            continue;
        }
        for path in expanded(statement.trim_end_matches(';')) {
            let Some((path, name)) = absolute(&path, module) else { continue };
            match exported {
                Some(_) => drop(imports.exports.insert(name, path)),
                None => imports.uses.push(path),
            }
        }
    }
    imports
}

/// The paths of a use tree: `a::{b, c::d}` is `a::b` and `a::c::d`.
fn expanded(tree: &str) -> Vec<String> {
    let Some((prefix, group)) = tree.split_once('{') else { return vec![tree.trim().to_owned()] };
    let group = group.strip_suffix('}').unwrap_or(group);
    let mut parts = Vec::new();
    let (mut depth, mut part) = (0, String::new());
    for character in group.chars().chain([',']) {
        match character {
            ',' if depth == 0 => parts.push(std::mem::take(&mut part)),
            _ => part.push(character),
        }
        depth += i32::from(character == '{') - i32::from(character == '}');
    }
    let parts = parts.iter().filter(|part| !part.trim().is_empty());
    parts.flat_map(|part| expanded(part.trim())).map(|part| format!("{prefix}{part}")).collect()
}

/// A path within the crate from its root, and the name under which it is imported; `None` for other crates.
fn absolute(path: &str, module: &Module) -> Option<(Module, String)> {
    let (path, alias) = match path.split_once(" as ") {
        Some((path, alias)) => (path, Some(alias)),
        None => (path, None),
    };
    let mut parts: Vec<String> = path.split("::").map(|part| part.trim().to_owned()).collect();
    if parts.last().is_some_and(|last| last == "self") {
        parts.pop();
    }
    let mut base = module.clone();
    let first = parts.first()?.clone();
    match first.as_str() {
        "crate" => base.clear(),
        "super" => drop(base.pop()),
        "self" => {}
        // A child of the module, or another crate: only existing modules count.
        _ => base.push(first),
    }
    let rest = parts.into_iter().skip(1);
    for part in rest {
        match part.as_str() {
            "super" => drop(base.pop()),
            _ => base.push(part),
        }
    }
    let name = alias.map_or_else(|| base.last().cloned().unwrap_or_default(), str::to_owned);
    Some((base, name))
}

/// Which module imports which, with re-exports followed to the defining module.
fn edges(modules: &BTreeMap<Module, Imports>) -> BTreeMap<Module, BTreeSet<Module>> {
    let targets = |module: &Module, imports: &Imports| {
        let found = imports.uses.iter().filter_map(|path| defined_in(modules, path, 0));
        found.filter(|target| target != module).collect()
    };
    modules.iter().map(|(module, imports)| (module.clone(), targets(module, imports))).collect()
}

/// The module that defines what a path names; `None` outside the crate.
fn defined_in(modules: &BTreeMap<Module, Imports>, path: &Module, depth: usize) -> Option<Module> {
    let length = (0..=path.len()).rev().find(|&length| modules.contains_key(&path[..length]))?;
    let (module, rest) = (path[..length].to_vec(), &path[length..]);
    let Some(name) = rest.first() else { return Some(module) };
    match modules[&module].exports.get(name) {
        Some(source) if depth < 8 => {
            let source: Module = source.iter().chain(&rest[1..]).cloned().collect();
            defined_in(modules, &source, depth + 1).or(Some(module))
        }
        // The root defines nothing: a path that ends there belongs to another crate.
        _ if module.is_empty() => None,
        _ => Some(module),
    }
}

/// The circles: for each, the modules along it.
fn circles(edges: &BTreeMap<Module, BTreeSet<Module>>) -> Vec<Vec<String>> {
    let mut found = BTreeSet::new();
    for start in edges.keys() {
        if let Some(circle) = way_back(edges, start) {
            // The same circle is found from each of its modules: it is reported from its first one.
            let least = circle.iter().enumerate().min_by_key(|(_, module)| *module).map_or(0, |(index, _)| index);
            let turned: Vec<String> =
                (0..=circle.len()).map(|i| circle[(least + i) % circle.len()].join("::")).collect();
            found.insert(turned);
        }
    }
    found.into_iter().collect()
}

/// The shortest path from a module back to itself.
fn way_back(edges: &BTreeMap<Module, BTreeSet<Module>>, start: &Module) -> Option<Vec<Module>> {
    let mut before: BTreeMap<&Module, &Module> = BTreeMap::new();
    let mut queue = std::collections::VecDeque::from([start]);
    while let Some(module) = queue.pop_front() {
        for next in edges.get(module).into_iter().flatten() {
            if next == start {
                let mut way = vec![module.clone()];
                let mut at = module;
                while at != start {
                    at = before[at];
                    way.push(at.clone());
                }
                way.reverse();
                return Some(way);
            }
            if !before.contains_key(next) {
                before.insert(next, module);
                queue.push_back(next);
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn crate_of(files: &[(&str, &str)]) -> BTreeMap<Module, Imports> {
        let module =
            |path: &str| path.split("::").filter(|part| !part.is_empty()).map(str::to_owned).collect::<Module>();
        files.iter().map(|(path, text)| (module(path), imports(text, &module(path)))).collect()
    }

    #[test]
    fn a_circle_is_found_through_a_re_export() {
        let files = [
            ("", "mod a;\nmod b;\npub use a::A;"),
            ("a", "use crate::b::{B, C};\nuse std::fmt;"),
            ("b", "use super::A as Other;"),
        ];
        assert_eq!(circles(&edges(&crate_of(&files))), [["a", "b", "a"]]);
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
        let modules = crate_of(&files);
        assert_eq!(circles(&edges(&modules)), Vec::<Vec<String>>::new());
        let b = vec!["b".to_owned()];
        assert_eq!(edges(&modules)[&b], BTreeSet::from([vec!["a".to_owned(), "part".to_owned()]]));
    }

    #[test]
    fn trees_are_expanded() {
        assert_eq!(expanded("a::{b, c::{d, e}}"), ["a::b", "a::c::d", "a::c::e"]);
    }
}
