//! The flags that decide the bytes of frames, with their values.
//!
//! Not among them are those of the machine (device, threads, memory, acceleration structure, short tests: the same bytes by other ways), of
//! messages, of what is written where, and of the part of the film. A test finds flags that are in neither list.

use std::collections::BTreeMap;

use crate::args::RenderArgs;

/// What messages call the value of a flag that is not given.
pub(super) fn none() -> String {
    "not given".to_owned()
}

/// A map from the flags of these fields to their values.
macro_rules! values {
    ($args:expr; $($field:ident),* $(,)?) => {
        [$((flag(stringify!($field)), value(&format!("{:?}", $args.$field)))),*]
    };
}

pub(super) fn of(args: &RenderArgs) -> BTreeMap<String, String> {
    let film = values![args; turntable, fps, sun];
    let form = values![args.form; animation, smooth, instances];
    let storage =
        values![args.storage; format, transfer, view, bit_depth, dither, exr_type, exr_compression, exr_parts];
    let exposure = values![args.exposure; exposure];
    let image = values![args.image;
        mode, bounces, step, radius, weight, lookup, quality, aa, filter, samples, seed, size, crop, background, ground, studio,
        no_studio, camera, camera_name, up, lights, falloff, ambient, ambient_light, sky, environment,
    ];
    let reading = values![args.scene.reading; scene_format];
    let all = [&film[..], &form, &storage, &exposure, &image, &reading];
    all.concat().into_iter().collect()
}

fn flag(field: &str) -> String {
    match field {
        "lights" => "--light".to_owned(),
        field => format!("--{}", field.replace('_', "-")),
    }
}

/// A value as its type shows it, without the word for its presence.
fn value(text: &str) -> String {
    match text {
        "None" | "[]" => none(),
        text => inner(text, "Some").unwrap_or(text).to_owned(),
    }
}

/// A value for people: what the words of types enclose.
pub(super) fn shown(value: &str) -> &str {
    let word = value.bytes().take_while(u8::is_ascii_alphanumeric).count();
    inner(value, &value[..word]).filter(|_| word > 0).map_or(value, shown)
}

fn inner<'a>(text: &'a str, word: &str) -> Option<&'a str> {
    text.strip_prefix(word)?.strip_prefix('(')?.strip_suffix(')')
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;
    use crate::args::{Cli, Command, command};

    /// Flags that do not decide the bytes of frames.
    const OTHERS: [&str; 24] = [
        "output",
        "sun-hours",
        "frames",
        "skip-existing",
        "overwrite",
        "resume",
        "partial",
        "short-tests",
        "layers",
        "stats",
        "device",
        "threads",
        "accel",
        "grid",
        "grid-file",
        "mesh-file",
        "progress",
        "quiet",
        "verbose",
        "allow-outside",
        "strict",
        "memory-limit",
        "color",
        "help",
    ];

    fn settings(flags: &[&str]) -> BTreeMap<String, String> {
        let line = ["lightmesh", "render", "a.toml", "-o", "f.#.png"];
        let cli = Cli::parse_from(line.iter().chain(flags));
        let Command::Render(args) = cli.command else { panic!("not a render") };
        of(&args)
    }

    #[test]
    fn every_flag_decides_the_frames_or_does_not() {
        let settings = settings(&[]);
        let command = command();
        let render = command.find_subcommand("render").unwrap();
        for flag in render.get_arguments().filter_map(|flag| flag.get_long()) {
            let decides = settings.contains_key(&format!("--{flag}"));
            assert!(decides != OTHERS.contains(&flag), "--{flag} must be in one of the lists");
        }
    }

    #[test]
    fn a_value_that_differs_is_seen() {
        let (a, b) = (settings(&["--seed", "1"]), settings(&["--seed", "2", "--device", "cpu"]));
        let differing: Vec<&String> = a.keys().filter(|flag| a[*flag] != b[*flag]).collect();
        assert_eq!(differing, ["--seed"]);
        assert_eq!((shown(&a["--seed"]), shown(&a["--step"]), shown(&a["--size"])), ("1", "not given", "[1024, 1024]"));
        assert_eq!([shown("Fixed(0.5)"), shown("Color(Vec3(1.0, 0.5, 0.0))")], ["0.5", "1.0, 0.5, 0.0"]);
    }
}
