//! Scene files.

use crate::input::Expected::{self, Either, Opens, Refused};
use crate::input::{Input, cut, utf_16};

const MODEL: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

const ROOM: &str = r#"[camera]
position = [0, 2, 6]
target = [0, 1, 0]
vfov = 45
[[light]]
kind = "point"
position = [3, 5, 2]
[[material]]
name = "white"
kd = 0.8
[[mesh]]
file = "one.obj"
material = "white"
[[sphere]]
center = [0, 1, 0]
radius = 1
segments = 8
"#;

/// Lines of the room, their replacements, and the expected outcome.
const LINES: [(&str, &str, Expected); 53] = [
    ("vfov = 45", "vfov = nan", Refused),
    ("vfov = 45", "vfov = 0", Refused),
    ("vfov = 45", "vfov = 180", Refused),
    ("vfov = 45", "vfov = 1e-300", Refused),
    ("vfov = 45", "vfov = 179.9999", Opens),
    ("vfov = 45", "vfov = \"45\"", Refused),
    ("vfov = 45", "vfow = 45", Refused),
    ("vfov = 45", "\"\\u001b[31m\\n\" = 45", Refused),
    ("vfov = 45", "vfov = 45\nvfov = 46", Refused),
    ("position = [0, 2, 6]", "position = [0, 1, 0]", Refused),
    ("position = [0, 2, 6]", "position = [0, 1e308, 0]", Refused),
    ("position = [0, 2, 6]", "position = [0, inf, 0]", Refused),
    ("position = [0, 2, 6]", "position = [0, 2]", Refused),
    ("position = [0, 2, 6]", "position = [1e18, 0, 0]", Opens),
    ("target = [0, 1, 0]", "direction = [0, 0, 0]", Refused),
    ("target = [0, 1, 0]", "direction = [0, 1e-320, 0]", Either),
    ("target = [0, 1, 0]", "", Refused),
    ("kind = \"point\"", "kind = \"sun\"", Refused),
    ("kind = \"point\"", "kind = \"point\"\nintensity = -1", Refused),
    ("kind = \"point\"", "kind = \"point\"\nintensity = 1e300", Refused),
    ("kind = \"point\"", "kind = \"point\"\nspread = 1e17", Opens),
    ("kind = \"point\"", "kind = \"sphere\"\nradius = 1e-300", Refused),
    ("kind = \"point\"\nposition = [3, 5, 2]", "kind = \"directional\"\ndirection = [0, -1, 0]\nangle = 179", Opens),
    ("kind = \"point\"\nposition = [3, 5, 2]", "kind = \"directional\"\ndirection = [0, -1, 0]\nangle = 1e-43", Opens),
    (
        "kind = \"point\"\nposition = [3, 5, 2]",
        "kind = \"directional\"\ndirection = [0, -1, 0]\nangle = 179.5",
        Refused,
    ),
    ("kd = 0.8", "kd = [0.8]", Refused),
    ("kd = 0.8", "kd = 0.8\nshininess = -1", Either),
    ("kd = 0.8", "kd = 0.8\nshininess = 1e17", Opens),
    ("kd = 0.8", "kd = 0.8\ntexture = \"http://example.org/a.png\"", Opens),
    ("kd = 0.8", "kd = 0.8\ntexture = \"../a.png\"", Opens),
    ("kd = 0.8", "kd = 0.8\nopacity_texture = \"../a.png\"", Opens),
    ("kd = 0.8", "kd = 0.8\nopacity_texture = 7", Refused),
    ("kd = 0.8", "kd = 0.8\nopacity_cutoff = 0.5", Refused),
    ("kd = 0.8", "kd = 0.8\nopacity_texture = \"a.png\"\nopacity_cutoff = nan", Refused),
    ("kd = 0.8", "kd = 0.8\ntexture = \"a\\u0000.png\"", Opens),
    ("kd = 0.8", "kd = 0.8\ntexture = \"input.toml\"", Opens),
    ("name = \"white\"", "name = \"wait\"", Refused),
    ("name = \"white\"", "name = \"\\u001b[31m\\n\"", Refused),
    ("name = \"white\"", "name = \"white\"\n[[material]]\nname = \"white\"", Refused),
    ("segments = 8", "segments = 0", Refused),
    ("segments = 8", "segments = -1", Refused),
    ("segments = 8", "segments = 9223372036854775807", Refused),
    ("segments = 8", "segments = 99999999999999999999", Refused),
    ("segments = 8", "segments = 8.5", Refused),
    ("radius = 1", "radius = 0", Refused),
    ("radius = 1", "radius = 1e-300", Refused),
    ("radius = 1", "radius = 1e-37", Opens),
    ("radius = 1", "radius = 1e17", Opens),
    ("radius = 1", "radius = 1e19", Refused),
    ("center = [0, 1, 0]", "center = [1e17, 1, 0]", Opens),
    ("file = \"one.obj\"", "file = \"one.obj\"\nscale = 0", Refused),
    ("file = \"one.obj\"", "file = \"one.obj\"\nscale = 1e300", Opens),
    ("file = \"one.obj\"", "file = \"one.obj\"\nrotate = [1e17, nan, 0]", Refused),
];

/// Models that cannot be read.
const MODELS: [&str; 12] = [
    "none.obj",
    "input.toml",
    ".",
    "../one.obj",
    "/etc/passwd",
    "https://example.org/one.obj",
    "a\\u0000.obj",
    "\\u001b[31m\\n.obj",
    "one.fbx",
    "",
    "one.obj/one.obj",
    "builtin:gazebo",
];

/// Additional tables.
const TABLES: [(&str, Expected); 12] = [
    ("[lightmesh]\nstep = 1e-30\n", Either),
    ("[lightmesh]\nstep = 1e17\nradius = 1e17\n", Either),
    ("[lightmesh]\nstep = nan\n", Refused),
    ("[lightmesh]\nstep = 0\n", Refused),
    ("[[plane]]\npoint = [0, 0, 0]\nnormal = [0, 0, 0]\n", Refused),
    ("[[plane]]\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\nsize = [1e17, 1]\n", Opens),
    ("[[box]]\nmin = [0, 0, 0]\nmax = [0, 0, 0]\n", Refused),
    ("[[box]]\ncenter = [0, 0, 0]\nsize = [1e-37, 1e-37, 1e-37]\n", Opens),
    ("[[cylinder]]\nbase = [0, 0, 0]\ntop = [0, 0, 0]\nradius = 1\n", Refused),
    ("[[cylinder]]\nbase = [0, -1e18, 0]\ntop = [0, 1e18, 0]\nradius = 1e-9\nsegments = 3\n", Opens),
    ("[[triangle]]\na = [0, 0, 0]\nb = [0, 0, 0]\nc = [0, 0, 0]\n", Opens),
    ("[secret]\n", Refused),
];

pub(crate) fn inputs() -> Vec<Input> {
    let room =
        |oddity: String, text: String, expected| Input::new("toml", oddity, text, expected).beside("one.obj", MODEL);
    let mut all: Vec<Input> = cut("toml", "room", ROOM.as_bytes());
    all.extend(LINES.map(|(line, odd, expected)| {
        assert!(ROOM.contains(line), "{line}");
        room(format!("`{}`", odd.escape_debug()), ROOM.replacen(line, odd, 1), expected)
    }));
    all.extend(MODELS.map(|name| room(format!("model `{name}`"), ROOM.replace("one.obj", name), Refused).blaming("")));
    all.extend(TABLES.map(|(table, expected)| {
        // After the first table, which must be unique.
        room(format!("`{}`", table.escape_debug()), format!("{ROOM}{table}"), expected)
    }));
    all.push(room("origin = [1e17, 0, 0]".to_owned(), format!("origin = [1e17, 0, 0]\n{ROOM}"), Either));
    all.extend(texts().map(|input| input.beside("one.obj", MODEL)));
    all
}

/// A camera that causes a warning.
const CAMERA: &str = "[[camera]]\nname = \"c#\"\nposition = [0, 0, 5]\ntarget = [0, 0, 0]\nvfov = 40\nhfov = 50\n";

/// The tables 100 000 times, with the number in place of `#`.
fn numbered(tables: &str) -> String {
    (0..100_000).map(|number| tables.replace('#', &number.to_string())).collect()
}

fn texts() -> [Input; 16] {
    let long = "x".repeat(1 << 20);
    let nested = |open: &str| format!("a = {}", open.repeat(100_000));
    [
        Input::new("toml", "empty", "", Opens),
        Input::new("toml", "one line feed", "\n", Opens),
        Input::new("toml", "byte order mark", format!("\u{feff}{ROOM}"), Opens),
        Input::new("toml", "UTF-16", utf_16(ROOM), Refused),
        Input::new("toml", "not UTF-8", [ROOM.as_bytes(), b"\xff"].concat(), Refused),
        Input::new("toml", "NUL bytes", format!("{ROOM}\0"), Refused),
        Input::new("toml", "carriage returns", ROOM.replace('\n', "\r"), Refused),
        Input::new("toml", "lists within lists", nested("["), Refused),
        Input::new("toml", "tables within tables", nested("{a="), Refused),
        Input::new("toml", "keys within keys", format!("{}a = 1", "a.".repeat(100_000)), Refused),
        Input::new("toml", "tables in tables' names", format!("[{}a]", "a.".repeat(100_000)), Refused),
        Input::new("toml", "a key of a megabyte", format!("{long} = 1"), Refused),
        Input::new("toml", "a comment of a megabyte", format!("# {long}\n{ROOM}"), Opens),
        Input::new("toml", "many materials", format!("{ROOM}{}", numbered("[[material]]\nname = \"m#\"\n")), Opens),
        Input::new(
            "toml",
            "many cameras with two angles",
            format!("{}[{ROOM}", numbered(CAMERA)).replace("[[camera]\n", "[[camera]]\n"),
            Opens,
        ),
        Input::new("toml", "a name of a megabyte", ROOM.replace("white", &long), Opens),
    ]
}
