//! Things that are not readable files, in place of one of each format; and odd names.

use std::fs;
use std::path::Path;

use crate::input::Expected::{Either, Opens, Refused};
use crate::input::Input;

const FORMATS: [&str; 7] = ["obj", "ply", "stl", "gltf", "glb", "toml", "grid"];
const ROOM: &str = "[[sphere]]\ncenter = [0, 1, 0]\nradius = 1\nsegments = 8\n";
const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

pub(crate) fn inputs() -> Vec<Input> {
    let mut all = Vec::new();
    for format in FORMATS {
        all.push(instead(format, "a missing file", |_| ()));
        all.push(instead(format, "a folder", |path| fs::create_dir(path).unwrap()));
        #[cfg(unix)]
        all.extend(unix::inputs(format));
    }
    #[cfg(unix)]
    all.extend(unix::references());
    all.extend(names());
    all.extend(contents());
    all
}

/// What `make` creates in place of the file.
fn instead(format: &'static str, what: &str, make: fn(&Path)) -> Input {
    let file = format!("input.{format}");
    let opened = file.clone();
    Input::made(format, format!("{what} for a file"), &opened, Refused, move |folder| make(&folder.join(&file)))
        .beside("room.toml", ROOM)
}

fn names() -> Vec<Input> {
    let named = |oddity: &str, name: &'static str, expected| {
        let write = move |folder: &Path| fs::write(folder.join(name), TRIANGLE).unwrap();
        Input::made("name", oddity, name, expected, write)
    };
    let mut all = vec![
        named("in capitals", "INPUT.OBJ", Opens),
        named("without an ending", "input", Refused),
        named("with an ending alone", ".obj", Refused),
        named("with an unknown ending", "input.fbx", Refused),
        named("with two endings", "input.ply.obj", Opens),
        named("beginning like a built-in scene", "./builtin:x.obj", Opens),
        named("of a built-in scene that there is not", "builtin:castle", Refused),
    ];
    if cfg!(unix) {
        all.push(named("with control characters", "a\u{1b}[31m\nb.obj", Opens));
        all.push(
            named("with control characters and an unknown ending", "a\u{1b}[31m\nb.fbx", Refused).blaming("b.fbx"),
        );
    }
    all
}

/// Files of one format with the name of another.
fn contents() -> Vec<Input> {
    let all = FORMATS.iter().filter(|&&format| format != "grid");
    all.flat_map(|format| {
        [
            Input::new(format, "holding OBJ", TRIANGLE, Either),
            Input::new(format, "holding TOML", ROOM, Either),
            Input::new(format, "holding noise", [0xa5; 4096], Either),
            Input::new(format, "holding NUL bytes", [0; 4096], Either),
        ]
    })
    .collect()
}

#[cfg(unix)]
mod unix {
    use std::fs::{self, Permissions};
    use std::os::unix::fs::{PermissionsExt, symlink};
    use std::os::unix::net::UnixListener;
    use std::path::Path;
    use std::process::Command;

    use super::instead;
    use crate::input::Expected::{Opens, Refused};
    use crate::input::Input;

    /// Creates something at a path.
    type Make = fn(&Path);

    const MESH: &str = "[[mesh]]\nfile = \"one.obj\"\n";
    const TEXTURE: &str = "[[material]]\nname = \"a\"\ntexture = \"one.png\"\n\
                           [[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"a\"\n";

    /// Things in place of a mesh or a texture of a scene, which opens without its textures.
    pub(super) fn references() -> Vec<Input> {
        let kinds: [(&str, Make); 6] = [
            ("a pipe", make_pipe),
            ("a socket", |path| drop(UnixListener::bind(path).unwrap())),
            ("a folder", |path| fs::create_dir(path).unwrap()),
            ("a link to a device", |path| symlink("/dev/zero", path).unwrap()),
            ("a link out of the folder", |path| symlink("/etc/passwd", path).unwrap()),
            ("a link to itself", |path| symlink(path.file_name().unwrap(), path).unwrap()),
        ];
        let mut all = Vec::new();
        for (kind, make) in kinds {
            for (text, name, expected) in [(MESH, "one.obj", Refused), (TEXTURE, "one.png", Opens)] {
                let write = move |folder: &Path| {
                    fs::write(folder.join("input.toml"), text).unwrap();
                    make(&folder.join(name));
                };
                all.push(Input::made("toml", format!("{kind} for {name}"), "input.toml", expected, write));
            }
        }
        all
    }

    fn make_pipe(path: &Path) {
        assert!(Command::new("mkfifo").arg(path).status().unwrap().success());
    }

    pub(super) fn inputs(format: &'static str) -> [Input; 5] {
        let mut locked = instead(format, "a file without permission", lock);
        locked.ignored = !permissions_count();
        [
            locked,
            instead(format, "a pipe", make_pipe),
            instead(format, "an endless device", |path| symlink("/dev/zero", path).unwrap()),
            instead(format, "a link to nothing", |path| symlink("nothing", path).unwrap()),
            instead(format, "a link to itself", |path| symlink(path.file_name().unwrap(), path).unwrap()),
        ]
    }

    /// A file without read permission.
    fn lock(path: &Path) {
        fs::write(path, "v 0 0 0\n").unwrap();
        fs::set_permissions(path, Permissions::from_mode(0o000)).unwrap();
    }

    /// Whether permissions apply to this user; root can read all files.
    fn permissions_count() -> bool {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("locked");
        lock(&path);
        fs::read(path).is_err()
    }
}
