//! What a source file takes from other modules of its crate, read from its tokens: so comments and strings name nothing.

use std::collections::{BTreeMap, BTreeSet};
use std::str::FromStr;

use proc_macro2::{Delimiter, LexError, TokenStream, TokenTree};

/// A module, as its path from the crate's root, such as `["accel", "bvh"]`; also the path of what is in it.
pub(super) type Module = Vec<String>;

/// Keywords before the name of what is defined.
const ITEMS: [&str; 8] = ["const", "enum", "fn", "static", "struct", "trait", "type", "union"];

/// The imports of a module, without those of tests and documentation.
#[derive(Debug, Default)]
pub(super) struct Imports {
    /// Full paths of all imports.
    pub(super) uses: Vec<Module>,
    /// Full paths that are written out in the code.
    pub(super) written: Vec<Module>,
    /// Names that are re-exported, and their origins.
    pub(super) exports: BTreeMap<String, Module>,
    /// Modules all of whose names are re-exported.
    pub(super) globs: Vec<Module>,
    /// Names of what is defined here.
    pub(super) items: BTreeSet<String>,
    /// Macros that are defined here: their paths begin at the crate's root.
    pub(super) macros: Vec<String>,
    /// Modules that are declared here, each with a file of its own.
    children: Vec<String>,
    /// Imported names, and what they stand for.
    names: BTreeMap<String, Module>,
    /// Paths that begin with another name, perhaps an imported one.
    relative: Vec<Vec<String>>,
}

impl Imports {
    /// Those in the text of the file of a module.
    pub(super) fn read(text: &str, module: &Module) -> Result<Imports, LexError> {
        let mut imports = Imports::default();
        imports.scan(TokenStream::from_str(text)?, module);
        for path in std::mem::take(&mut imports.relative) {
            let Some((first, rest)) = path.split_first() else { continue };
            let start = match imports.names.get(first) {
                Some(known) => known.clone(),
                None if imports.children.contains(first) => joined(module, [first.clone()]),
                None => continue,
            };
            imports.written.push(joined(&start, rest.iter().cloned()));
        }
        Ok(imports)
    }

    /// Reads what is in a module: its file, a block in it, or a module within the file.
    fn scan(&mut self, tokens: TokenStream, module: &Module) {
        let tokens: Vec<TokenTree> = tokens.into_iter().collect();
        let (mut at, mut is_exported) = (0, false);
        while at < tokens.len() {
            let here = &tokens[at..];
            let word = word(here);
            let word = word.as_deref();
            if skips_item(here) {
                at += item(here);
            } else if word == Some("pub") {
                at += if says_to_whom(here.get(1)) { 2 } else { 1 };
                is_exported = true;
                continue;
            } else if word == Some("use") && !is_mark(here.get(1), '<') {
                let length = here.iter().take_while(|token| !is_mark(Some(token), ';')).count();
                self.note_use(&here[1..length], module, is_exported);
                at += length;
            } else if word == Some("mod")
                && let [_, TokenTree::Ident(name), TokenTree::Group(content), ..] = here
            {
                self.scan(content.stream(), &joined(module, [name.to_string()]));
                at += 3;
            } else if word == Some("mod")
                && let [_, TokenTree::Ident(name), ..] = here
            {
                self.children.push(name.to_string());
                at += 2;
            } else if word == Some("macro_rules")
                && let [_, _, TokenTree::Ident(name), ..] = here
            {
                self.macros.push(name.to_string());
                at += 3;
            } else if word.is_some_and(|word| ITEMS.contains(&word))
                && let [_, TokenTree::Ident(name), ..] = here
            {
                self.items.insert(name.to_string());
                at += 2;
            } else if word.is_some() {
                let (path, length) = path(here);
                self.note_path(path, module);
                at += length;
            } else {
                if let TokenTree::Group(group) = &here[0] {
                    self.scan(group.stream(), module);
                }
                at += 1;
            }
            is_exported = false;
        }
    }

    /// Notes an import or a re-export.
    fn note_use(&mut self, tree: &[TokenTree], module: &Module, is_exported: bool) {
        for (mut path, alias) in leaves(tree) {
            let is_glob = path.last().is_some_and(|last| last == "*");
            if is_glob || path.last().is_some_and(|last| last == "self") {
                path.pop();
            }
            let name = alias.or_else(|| path.last().cloned()).unwrap_or_default();
            let path = absolute(&path, module);
            match (is_exported, is_glob) {
                (true, true) => self.globs.push(path),
                (true, false) => drop(self.exports.insert(name, path)),
                (false, _) => {
                    self.names.insert(name, path.clone());
                    self.uses.push(path);
                }
            }
        }
    }

    /// Notes a path of one or more names.
    fn note_path(&mut self, path: Vec<String>, module: &Module) {
        match path.first().map(String::as_str) {
            _ if path.len() < 2 => {}
            Some("crate" | "super" | "self") => self.written.push(absolute(&path, module)),
            _ => self.relative.push(path),
        }
    }
}

/// The path at the beginning of some tokens, which begin with a name, and how many of them it takes.
fn path(tokens: &[TokenTree]) -> (Vec<String>, usize) {
    let mut path: Vec<String> = word(tokens).into_iter().collect();
    let mut length = 1;
    while let [TokenTree::Punct(first), TokenTree::Punct(second), TokenTree::Ident(name), ..] = &tokens[length..]
        && (first.as_char(), second.as_char()) == (':', ':')
    {
        path.push(name.to_string());
        length += 3;
    }
    (path, length)
}

/// The paths of a use tree, each with its other name: `a::{b, c::d as e}` is `a::b` and `a::c::d`, called `e`.
fn leaves(tree: &[TokenTree]) -> Vec<(Vec<String>, Option<String>)> {
    let mut prefix = Vec::new();
    for (at, token) in tree.iter().enumerate() {
        match token {
            TokenTree::Group(group) => {
                let inner: Vec<TokenTree> = group.stream().into_iter().collect();
                let parts = inner.split(|token| is_mark(Some(token), ',')).filter(|part| !part.is_empty());
                let all = parts.flat_map(leaves);
                return all.map(|(path, alias)| (joined(&prefix, path), alias)).collect();
            }
            TokenTree::Ident(name) if *name == "as" => {
                return vec![(prefix, tree.get(at + 1).map(ToString::to_string))];
            }
            TokenTree::Ident(name) => prefix.push(name.to_string()),
            token if is_mark(Some(token), '*') => prefix.push("*".to_owned()),
            _ => {}
        }
    }
    vec![(prefix, None)]
}

/// A path within the crate from its root. One that begins with another name is taken for that of a child: only modules that exist count.
fn absolute(path: &[String], module: &Module) -> Module {
    let mut absolute = module.clone();
    for (index, part) in path.iter().enumerate() {
        match part.as_str() {
            "crate" if index == 0 => absolute.clear(),
            "self" if index == 0 => {}
            "super" => drop(absolute.pop()),
            _ => absolute.push(part.clone()),
        }
    }
    absolute
}

/// Whether tokens begin with an attribute that keeps an item out of the program: of tests, or for documentation.
fn skips_item(tokens: &[TokenTree]) -> bool {
    let [TokenTree::Punct(mark), TokenTree::Group(attribute), ..] = tokens else { return false };
    let text = attribute.to_string().replace(' ', "");
    mark.as_char() == '#' && matches!(text.as_str(), "[cfg(test)]" | "[cfg(doc)]")
}

/// Whether this is what follows `pub` in brackets, and no type.
fn says_to_whom(token: Option<&TokenTree>) -> bool {
    let Some(TokenTree::Group(group)) = token else { return false };
    let first = word(&group.stream().into_iter().take(1).collect::<Vec<_>>());
    matches!(first.as_deref(), Some("crate" | "super" | "self" | "in"))
}

/// The number of tokens of an item with its attributes.
fn item(tokens: &[TokenTree]) -> usize {
    let is_end = |token: &TokenTree| match token {
        TokenTree::Group(group) => group.delimiter() == Delimiter::Brace,
        token => is_mark(Some(token), ';'),
    };
    tokens.iter().position(is_end).map_or(tokens.len(), |end| end + 1)
}

/// The name or keyword with which tokens begin.
fn word(tokens: &[TokenTree]) -> Option<String> {
    match tokens.first() {
        Some(TokenTree::Ident(name)) => Some(name.to_string()),
        _ => None,
    }
}

fn is_mark(token: Option<&TokenTree>, mark: char) -> bool {
    matches!(token, Some(TokenTree::Punct(found)) if found.as_char() == mark)
}

fn joined(path: &[String], more: impl IntoIterator<Item = String>) -> Vec<String> {
    path.iter().cloned().chain(more).collect()
}
