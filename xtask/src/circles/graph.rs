//! Which module needs which, and where that goes round in a circle.

use std::collections::{BTreeMap, BTreeSet};

use super::imports::{Imports, Module};

/// Longer chains of re-exports are not followed.
const DEEPEST: usize = 8;

/// Which module needs which, with re-exports followed to the defining module.
pub(super) fn edges(modules: &BTreeMap<Module, Imports>) -> BTreeMap<Module, BTreeSet<Module>> {
    let targets = |module: &Module, imports: &Imports| {
        let found = imports.uses.iter().chain(&imports.written).filter_map(|path| defined_in(modules, path, 0));
        found.filter(|target| target != module).collect()
    };
    modules.iter().map(|(module, imports)| (module.clone(), targets(module, imports))).collect()
}

/// The module that defines what a path names; `None` outside the crate.
fn defined_in(modules: &BTreeMap<Module, Imports>, path: &Module, depth: usize) -> Option<Module> {
    let length = (0..=path.len()).rev().find(|&length| modules.contains_key(&path[..length]))?;
    let (module, rest) = (path[..length].to_vec(), &path[length..]);
    let Some(name) = rest.first() else { return Some(module) };
    let imports = &modules[&module];
    if depth < DEEPEST {
        if let Some(source) = imports.exports.get(name).filter(|&source| source != path) {
            let source: Module = source.iter().chain(&rest[1..]).cloned().collect();
            return defined_in(modules, &source, depth + 1).or(Some(module)).filter(|found| !found.is_empty());
        }
        if !imports.items.contains(name) {
            let from_all = |all: &Module| all.iter().chain(rest).cloned().collect::<Module>();
            let mut globs = imports.globs.iter().map(from_all);
            if let Some(found) = globs.find_map(|source| defines(modules, &source, depth + 1)) {
                return Some(found);
            }
        }
    }
    if !module.is_empty() || imports.items.contains(name) {
        return Some(module);
    }
    // Macros have their paths at the root, wherever they are.
    let has_macro = |(module, imports): (&Module, &Imports)| imports.macros.contains(name).then(|| module.clone());
    modules.iter().find_map(has_macro)
}

/// The module that defines what a path names, if its text says so.
fn defines(modules: &BTreeMap<Module, Imports>, path: &Module, depth: usize) -> Option<Module> {
    let name = path.last()?;
    let found = defined_in(modules, path, depth)?;
    modules[&found].items.contains(name).then_some(found)
}

/// The circles: for each, the modules along it.
pub(super) fn circles(edges: &BTreeMap<Module, BTreeSet<Module>>) -> Vec<Vec<String>> {
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
