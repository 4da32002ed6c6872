//! Skies and panoramas around a scene.

use lightmesh::image::Frame;
use serde_json::json;

use crate::run::Place;

/// Above a floor, looking north to the horizon.
const OPEN: &str = "[camera]\nposition = [0, 1, 0]\ntarget = [0, 1, -1]\nvfov = 60\n[[plane]]\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\n\
                    size = [40, 40]\n[[light]]\nkind = \"directional\"\ndirection = [0, -1, 0]\n[ambient]\nbackground = 0\n";

fn place() -> Place {
    let place = Place::new();
    place.write("open.toml", OPEN);
    place
}

/// The colour in the middle of the first row, and in that of the last.
fn render(place: &Place, flags: &[&str]) -> [[f32; 3]; 2] {
    let base = ["render", "open.toml", "-o", "o.exr", "--size", "33x32", "--stats", "s.json"];
    place.good(&[&base[..], flags].concat());
    let frame = Frame::load(place.path("o.exr")).unwrap();
    [frame.color()[16], frame.color()[31 * 33 + 16]]
}

#[test]
fn a_sky_is_seen_and_lights() {
    let place = place();
    let [above, below] = render(&place, &["--sky", "clear;sun=50,180"]);
    assert!(above[2] > 1.5 * above[0] && above[2] > 0.1, "{above:?}: blue");
    assert!(below[0] > below[2] && below[0] > 0.3, "{below:?}: in the sun");
    let stats = place.json("s.json");
    assert_eq!(stats["settings"]["environment"], json!("clear sky"));
    assert_eq!(stats["scene"]["lights"], 1, "the scene's own sun is gone");

    let [above, shaded] = render(&place, &["--sky", "uniform;color=0.25,0.5,1;strength=2", "--background", "0.125"]);
    assert_eq!(above, [0.125; 3], "the camera sees the background");
    // Grey of 0.8 is lit from everywhere.
    assert!((0..3).all(|k| (shaded[k] / [0.5, 1.0, 2.0][k] - shaded[0] / 0.5).abs() < 1e-3), "{shaded:?}");
    assert_eq!(place.json("s.json")["scene"]["lights"], 0);

    place.write(
        "sky.toml",
        &format!("{OPEN}\n[sky]\nkind = \"gradient\"\nzenith = [0, 0, 1]\nhorizon = 1\n")
            .replace("background = 0\n", ""),
    );
    place.good(&["render", "sky.toml", "-o", "o.exr", "--size", "33x32", "--stats", "s.json"]);
    let frame = Frame::load(place.path("o.exr")).unwrap();
    let [high, low] = [0, 12].map(|row| frame.color()[row * 33 + 16]);
    assert!(high[0] < low[0] && high[2] > 0.99, "{high:?} {low:?}");
    assert_eq!(place.json("s.json")["scene"]["lights"], 1, "the file means its own sun, too");
}

#[test]
fn a_panorama_turns() {
    let place = place();
    // Red in the north, green elsewhere.
    let texels =
        (0..16 * 8).map(|index| if (4..12).contains(&(index % 16)) { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] });
    Frame::new(16, 8, texels.collect()).unwrap().save(place.path("p.exr")).unwrap();
    let [north, _] = render(&place, &["--environment", "p.exr"]);
    let [turned, _] = render(&place, &["--environment", "p.exr;rotation=180;strength=0.5"]);
    assert_eq!((north, turned), ([1.0, 0.0, 0.0], [0.0, 0.5, 0.0]));
    assert_eq!(place.json("s.json")["settings"]["environment"], "p.exr");

    place.write(
        "p.toml",
        &format!("{OPEN}\n[environment]\nfile = \"p.exr\"\nrotation = 180\n").replace("background = 0\n", ""),
    );
    place.good(&["render", "p.toml", "-o", "o.exr", "--size", "33x32"]);
    assert_eq!(Frame::load(place.path("o.exr")).unwrap().color()[16], [0.0, 1.0, 0.0]);
    // Outputs spare it, named by a flag or by the scene.
    for scene in [&["open.toml", "--environment", "p.exr"][..], &["p.toml"]] {
        let message = place.refused(&[&["render", "-o", "p.exr"], scene].concat());
        assert!(message.contains("p.exr") && message.contains("-o"), "{message}");
    }
}

#[test]
fn what_cannot_surround_a_scene_is_refused() {
    let place = place();
    let error =
        |flags: &[&str]| place.refused(&[&["render", "open.toml", "-o", "o.png", "--size", "8x8"], flags].concat());
    for (flags, expected) in [
        (["--sky", "blue"], "clear, uniform or gradient"),
        (["--sky", "clear;sun=-1,0"], "below the horizon"),
        (["--sky", "clear;turbidity=11"], "from 1 to 10"),
        (["--sky", "clear;place=55,83;time=2026-12-21T22:00+07:00"], "twilight"),
        (["--sky", "clear;place=55,83;time=yesterday"], "2026-06-21T15:00+02:00"),
        (["--environment", "none.hdr"], "none.hdr"),
        (["--environment", "open.toml"], "neither a Radiance HDR nor an OpenEXR"),
    ] {
        let message = error(&flags);
        assert!(message.contains(expected), "{flags:?}: {message}");
    }
    let both = error(&["--environment", "a.hdr", "--sky", "clear"]);
    assert!(both.contains("cannot be used with"), "{both}");
    for (text, expected) in [
        ("[sky]\nkind = \"clear\"\nsun = [95, 0]\n", "sun"),
        ("[sky]\nkind = \"clear\"\ncolor = 1\n", "has no `color`"),
        ("[sky]\nkind = \"clear\"\nplace = [55, 83]\n", "time"),
        ("[sky]\nkind = \"uniform\"\n[environment]\nfile = \"p.exr\"\n", "remove one of them"),
        ("[environment]\nfile = \"open.toml\"\n", "neither a Radiance HDR"),
    ] {
        place.write("wrong.toml", &format!("{OPEN}\n{text}"));
        let message = place.refused(&["render", "wrong.toml", "-o", "o.png", "--size", "8x8"]);
        assert!(message.contains(expected) && message.contains("wrong.toml:"), "{text}: {message}");
    }
}

/// A cube as a file of another program.
const CUBE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nf 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 4 8 7 3\n\
                    f 1 5 8 4\nf 2 3 7 6\n";

#[test]
fn a_model_under_a_sky_stands_on_a_ground_before_the_horizon() {
    let place = place();
    place.write("cube.obj", CUBE);
    let base = ["render", "cube.obj", "--size", "32x32", "--quality", "draft", "--up", "y"];
    let picture = |flags: &[&str]| {
        let done = place.good(&[&base[..], &["-o", "a.exr"], flags].concat());
        (place.read("a.exr"), done.stderr)
    };
    let (clear, notes) = picture(&["--sky", "clear"]);
    assert!(notes.contains("stands on a ground"), "{notes}");
    let frame = Frame::load(place.path("a.exr")).unwrap();
    let [sky, ground] = [frame.color()[0], frame.color()[31 * 32]];
    assert!(sky[2] > 1.2 * sky[0] && ground[2] < ground[0], "{sky:?} {ground:?}: blue above, not below");
    assert_eq!(picture(&["--sky", "clear", "--ground"]).0, clear, "there is a ground already");
    // From a camera of one's own, too; there is no ground above it.
    let from = |place: &str| picture(&["--sky", "clear", "--camera", place]).1.contains("stands on a ground");
    assert_eq!(["2,2,5;0,0,0;40", "2,-2,5;0,0,0;40"].map(from), [true, false]);
    // As it is seen by numbers.
    let (plain, notes) = picture(&["--sky", "clear", "--no-studio"]);
    assert!(plain != clear && !notes.contains("stands on a ground"), "{notes}");
    let flags = ["--sky", "clear", "--background", "0.5"];
    assert_eq!(picture(&flags).0, picture(&[&flags[..], &["--no-studio"]].concat()).0);
}

#[test]
fn an_interior_under_a_sky_is_exposed_automatically() {
    let place = place();
    // A closed room but for a slit beside one of its walls.
    let room = "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\nv 1 1 0.8\nv 1 -1 0.8\n\
                f 1 2 3 4\nf 5 8 7 6\nf 1 5 6 2\nf 4 3 7 8\nf 1 4 8 5\nf 2 10 9 3\n";
    place.write("room.obj", room);
    let base = ["render", "room.obj", "--size", "16x16", "--quality", "draft", "--up", "y", "-o", "a.png", "--sky"];
    let notes = |flags: &[&str]| place.good(&[&base[..], flags].concat()).stderr;
    let seen = notes(&["clear;sun=30,180"]);
    assert!(seen.contains("stands inside") && seen.contains("exposure auto"), "{seen}");
    assert!(!notes(&["clear;sun=30,180", "--exposure", "0"]).contains("exposure auto"));
    assert!(!notes(&["clear;sun=30,180", "--no-studio"]).contains("exposure auto"), "as numbers are");
}

#[test]
fn a_bright_sky_is_not_clipped_unless_that_is_asked_for() {
    let place = place();
    place.write("cube.obj", CUBE);
    let corner = |flags: &[&str]| {
        let base =
            ["render", "cube.obj", "--size", "16x16", "--quality", "draft", "-o", "a.png", "--sky", "uniform;color=2"];
        place.good(&[&base[..], flags].concat());
        Frame::load(place.path("a.png")).unwrap().color()[0][0]
    };
    let shown = corner(&[]);
    assert!((0.82..0.88).contains(&shown), "{shown}");
    assert_eq!(corner(&["--crop", "0,0,4,4"]), shown, "that of the whole image");
    assert_eq!([corner(&["--exposure", "0"]), corner(&["--no-studio"])], [1.0; 2]);
}
