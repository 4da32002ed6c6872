//! `cargo xtask settings`: annotations and documentation of Python's keyword arguments, made from the table of settings.
//!
//! `settings FOLDER [--check]`, where FOLDER is that of the Python package. Each function that takes settings has a type of them in `_settings.py` and a list of
//! them in its help.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a program for the terminal")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use lightmesh::request::table::{Field, Group, Shape};
use lightmesh::request::{FIELDS, Words, field};

/// What takes settings: the name of its type, that of its list, the first sentence of the type, and the groups.
const TAKERS: [(&str, &str, &str, &[Group]); 4] = [
    (
        "ImageSettings",
        "image",
        "Settings of an image: those of `lightmesh render`. What is left out, or `None`, is as there.",
        &[Group::Exposure, Group::Image, Group::Layers, Group::Memory],
    ),
    (
        "FilmSettings",
        "film",
        "Settings of a film or a sun study: those of `lightmesh render`. What is left out, or `None`, is as there.",
        &[
            Group::Motion,
            Group::Frames,
            Group::Exposure,
            Group::Image,
            Group::Layers,
            Group::Storage,
            Group::Reading,
            Group::Form,
            Group::Memory,
        ],
    ),
    (
        "SaveSettings",
        "save",
        "How an image file shows a frame: settings of `lightmesh render`.",
        &[Group::Storage, Group::Exposure],
    ),
    (
        "OpenSettings",
        "open",
        "How a scene file is read: settings of `lightmesh render`.",
        &[Group::Reading, Group::Form, Group::Memory],
    ),
];

const HEADER: &str = "\
\"\"\"The settings that functions take as keyword arguments. Made by `cargo xtask settings`.\"\"\"

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from typing import Literal, TypedDict, Union

from numpy.typing import ArrayLike

from ._lightmesh import Camera, Environment

_Path = Union[str, PathLike[str]]
_Color = Union[float, ArrayLike]
";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (folder, is_check) = match &arguments[..] {
        [folder] => (Path::new(folder), false),
        [folder, check] if check == "--check" => (Path::new(folder), true),
        _ => {
            eprintln!("usage: settings FOLDER [--check]");
            return ExitCode::from(2);
        }
    };
    let files = files(folder);
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
    let mut types = HEADER.to_owned();
    let mut files = Vec::new();
    for (name, list, sentence, groups) in TAKERS {
        let fields = || FIELDS.iter().filter(|field| groups.contains(&field.group));
        types += &format!("\nclass {name}(TypedDict, total=False):\n    \"\"\"{sentence}\"\"\"\n\n");
        let entry = |field: &Field| {
            format!("    {}: {} | None\n    \"\"\"{}\"\"\"\n", field.name, annotation(field), doc(field))
        };
        types.extend(fields().map(entry));
        let item = |field: &Field| format!("{}: {}\n    {}\n", field.name, annotation(field), doc(field));
        files.push((folder.join(format!("src/docs/{list}.txt")), fields().map(item).collect()));
    }
    files.push((folder.join("python/lightmesh/_settings.py"), types));
    files
}

/// What a setting means, in the words of Python.
fn doc(this: &Field) -> String {
    let text = Words::Fields.spell(this.doc.trim(), |name| field(name).map(|field| field.name));
    let text = text.replace('"', "'").replace('\\', "\\\\");
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
