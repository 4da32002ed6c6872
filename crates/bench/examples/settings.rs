//! `cargo xtask settings`: annotations and documentation of Python's keyword arguments, made from the table of settings.
//!
//! `settings PYTHON BLENDER [--check]`, where PYTHON is the folder of the Python package and BLENDER that of the add-on. Each function that takes settings
//! has a type of them in `_settings.py` and a list of them in its help. The add-on has the items of its menus in `choices.py`.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a program for the terminal")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use lightmesh::render::{AmbientSource, Glass, Quality};
use lightmesh::request::table::{Group, Shape};
use lightmesh::request::{FIELDS, Field, Words, field};
use lightmesh::{Lookup, Mode};

/// What takes settings: the name of its type, that of its list, the first sentence of the type, and the groups.
const TAKERS: [(&str, &str, &str, &[Group]); 4] = [
    (
        "ImageSettings",
        "image",
        "Settings of an image: those of `lightmesh render`. What is left out, or `None`, is as there.",
        Group::IMAGE,
    ),
    (
        "FilmSettings",
        "film",
        "Settings of a film or a sun study: those of `lightmesh render`. What is left out, or `None`, is as there.",
        Group::FILM,
    ),
    ("SaveSettings", "save", "How an image file shows a frame: settings of `lightmesh render`.", Group::SAVE),
    ("OpenSettings", "open", "How a scene file is read: settings of `lightmesh render`.", Group::OPEN),
];

/// Keyword arguments of `lightmesh.ray`: the name of the type, what it extends, its first sentence, and the groups.
const REQUESTS: [(&str, &str, &str, &[Group]); 2] = [
    (
        "PictureRequest",
        "TypedDict",
        "Settings of a picture on a cluster: those of `lightmesh render`. What is left out, or `None`, is as there.",
        &[Group::Reading, Group::Memory, Group::Form, Group::Storage, Group::Exposure, Group::Image, Group::Machine],
    ),
    ("FilmRequest", "PictureRequest", "The same of a film.", &[Group::Motion, Group::Frames]),
];
/// What is a parameter of its own, or is not for many processes.
const NOT_IN_REQUESTS: [&str; 2] = ["frames", "partial"];

const REQUESTS_HEADER: &str = "\
\"\"\"The settings that films and pictures on a cluster take as keyword arguments. Made by `cargo xtask settings`.\"\"\"

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from typing import Literal, TypedDict, Union

from numpy.typing import ArrayLike

_Path = Union[str, PathLike[str]]
_Color = Union[float, ArrayLike]
";

const HEADER: &str = "\
\"\"\"The settings that functions take as keyword arguments. Made by `cargo xtask settings`.\"\"\"

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from typing import Literal, TypedDict, Union

from numpy.typing import ArrayLike

from ._lightmesh import Camera, Environment, Light

_Path = Union[str, PathLike[str]]
_Color = Union[float, ArrayLike]
";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let ([python, blender], is_check) = match &arguments[..] {
        [python, blender] => ([python, blender].map(Path::new), false),
        [python, blender, check] if check == "--check" => ([python, blender].map(Path::new), true),
        _ => {
            eprintln!("usage: settings PYTHON BLENDER [--check]");
            return ExitCode::from(2);
        }
    };
    let mut files = files(python);
    files.push((blender.join("choices.py"), choices()));
    for (path, text) in &files {
        let problem = match is_check {
            true if fs::read_to_string(path).is_ok_and(|found| found == *text) => continue,
            true => "is out of date: run `cargo xtask settings`".to_owned(),
            false => match fs::write(path, text) {
                Ok(()) => continue,
                Err(error) => format!("cannot be written: {error}"),
            },
        };
        eprintln!("error: {} {problem}", path.display());
        return ExitCode::FAILURE;
    }
    println!("{} files of settings", files.len());
    ExitCode::SUCCESS
}

/// All files with their texts.
fn files(folder: &Path) -> Vec<(PathBuf, String)> {
    let of = |group: Group| FIELDS.iter().filter(move |field| field.group == group);
    let mut types = HEADER.to_owned();
    // No group is in two of what a type is made of: type checkers allow no field twice.
    for &group in Group::FILM {
        let entry = |field: &Field| {
            format!("    {}: {} | None\n    \"\"\"{}\"\"\"\n", field.name, annotation(field), doc(field))
        };
        types += &format!("\nclass _{group:?}(TypedDict, total=False):\n");
        types.extend(of(group).map(entry));
    }
    let mut files = Vec::new();
    for (name, list, sentence, groups) in TAKERS {
        let bases = groups.iter().map(|group| format!("_{group:?}, ")).collect::<String>();
        types += &format!("\nclass {name}({bases}total=False):\n    \"\"\"{sentence}\"\"\"\n");
        let fields = FIELDS.iter().filter(|field| groups.contains(&field.group));
        let item = |field: &Field| format!("{}: {}\n    {}\n", field.name, annotation(field), doc(field));
        files.push((folder.join(format!("src/docs/{list}.txt")), fields.map(item).collect()));
    }
    files.push((folder.join("python/lightmesh/_settings.py"), types));
    files.push((folder.join("python/lightmesh/ray/_settings.py"), requests()));
    files
}

/// The settings of films and pictures on a cluster, where objects of Python stay on their machine.
fn requests() -> String {
    let mut types = REQUESTS_HEADER.to_owned();
    for (name, base, sentence, groups) in REQUESTS {
        types += &format!("\nclass {name}({base}, total=False):\n    \"\"\"{sentence}\"\"\"\n\n");
        let is_in = |field: &&Field| groups.contains(&field.group) && !NOT_IN_REQUESTS.contains(&field.name);
        for field in FIELDS.iter().filter(is_in) {
            let kind = match field.name {
                "camera" => "str".to_owned(),
                "environment" => "_Path".to_owned(),
                "light" => "str | Sequence[str]".to_owned(),
                _ => annotation(field),
            };
            types += &format!("    {}: {kind} | None\n    \"\"\"{}\"\"\"\n", field.name, doc(field));
        }
    }
    types
}

/// A text of the table in the words of Python, which may stand in quotes.
fn plain(text: &str) -> String {
    let text = Words::Fields.spell(text.trim().trim_end_matches('.'), |name| field(name).map(|field| field.name));
    text.replace('"', "'").replace('\\', "\\\\")
}

/// What a setting means, with its default.
fn doc(this: &Field) -> String {
    let text = plain(this.doc);
    match this.default() {
        Some(default) => format!("{text} [default: {default}]"),
        None => text,
    }
}

/// The type of a setting's value.
fn annotation(field: &Field) -> String {
    let quoted = |names: &[&str]| names.iter().map(|name| format!("{name:?}")).collect::<Vec<_>>().join(", ");
    let names: Vec<&str> = (field.choices)().iter().map(|choice| choice.name).collect();
    match (field.name, field.shape) {
        ("camera", _) => "Camera | str".to_owned(),
        ("environment", _) => "Environment | _Path".to_owned(),
        ("light", _) => "Light | str | Sequence[Light] | Sequence[str]".to_owned(),
        ("memory_limit", _) => "int | str".to_owned(),
        ("fps", _) => "float | str".to_owned(),
        ("dither", _) | (_, Shape::Switch) => "bool".to_owned(),
        (_, Shape::Whole) if !names.is_empty() => format!("Literal[{}]", names.join(", ")),
        _ if !names.is_empty() => format!("Literal[{}]", quoted(&names)),
        (_, Shape::Whole) => "int".to_owned(),
        (_, Shape::Text) => "str".to_owned(),
        (_, Shape::Number([])) => "float".to_owned(),
        (_, Shape::Number(words)) => format!("float | Literal[{}]", quoted(words)),
        (_, Shape::Path) => "_Path".to_owned(),
        (_, Shape::Wholes(count)) => format!("tuple[{}] | str", vec!["int"; count].join(", ")),
        (_, Shape::Color) => "_Color | str".to_owned(),
        (_, Shape::Texts) => "str | Sequence[str]".to_owned(),
    }
}

/// The first items of the add-on's menu of techniques, in the order of their numbers in files of Blender.
const TECHNIQUES: [&str; 5] = ["lists", "adaptive", "half-ball", "ray-trace", "area"];
/// Labels that say more than a name.
const LABELS: [(&str, &str); 9] = [
    ("lists", "Occluder Lists"),
    ("adaptive", "Adaptive Rays"),
    ("half-ball", "Half-Ball"),
    ("ray-trace", "Hard Shadows"),
    ("area", "Area Shadows"),
    ("auto", "Automatic"),
    ("constant", "Unshadowed"),
    ("mesh", "Gathered"),
    ("rays", "Gathered by Rays"),
];

/// The items of the add-on's menus.
fn choices() -> String {
    let lookups = Lookup::ALL.iter().filter(|lookup| **lookup != Lookup::Auto);
    let mut techniques: Vec<(&str, &str, String)> = lookups
        .map(|lookup| {
            let settings = format!("\"mode\": \"{}\", \"lookup\": \"{}\"", Mode::LightMesh.name(), lookup.name());
            (lookup.name(), lookup.help(), settings)
        })
        .collect();
    let modes = Mode::ALL.iter().filter(|mode| **mode != Mode::LightMesh);
    techniques.extend(modes.map(|mode| (mode.name(), mode.help(), format!("\"mode\": \"{}\"", mode.name()))));
    techniques.sort_by_key(|(name, ..)| TECHNIQUES.iter().position(|first| first == name).unwrap_or(TECHNIQUES.len()));
    let mut text = "\"\"\"The items of menus. Made by `cargo xtask settings`.\"\"\"\n".to_owned();
    let listed =
        |name: &str, items: &mut dyn Iterator<Item = String>| format!("\n{name} = [\n{}]\n", items.collect::<String>());
    text += &listed("QUALITIES", &mut Quality::ALL.iter().map(|quality| item(quality.name(), quality.help())));
    text += &listed("TECHNIQUES", &mut techniques.iter().map(|(name, help, _)| item(name, help)));
    text += &listed("AMBIENT", &mut AmbientSource::ALL.iter().map(|source| item(source.name(), source.help())));
    text += &listed("GLASS", &mut Glass::ALL.iter().map(|glass| item(glass.name(), glass.help())));
    text += "\n#: What each technique is in settings of a render.\nSETTINGS = {\n";
    text.extend(
        techniques.iter().map(|(name, _, settings)| format!("    \"{}\": {{{settings}}},\n", identifier(name))),
    );
    text + "}\n"
}

/// What files of Blender call a choice.
fn identifier(name: &str) -> String {
    name.replace('-', "_").to_uppercase()
}

/// An item of a menu: what files call it, its label, and what it means.
fn item(name: &str, help: &str) -> String {
    let label = LABELS
        .iter()
        .find(|(known, _)| *known == name)
        .map_or_else(|| format!("{}{}", name[..1].to_uppercase(), &name[1..]), |(_, label)| (*label).to_owned());
    format!("    (\"{}\", \"{label}\", \"{}\"),\n", identifier(name), plain(help))
}
