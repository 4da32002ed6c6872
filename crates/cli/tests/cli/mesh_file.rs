//! `lightmesh render --mesh-file`: light points from run to run.

use serde_json::Value;

use crate::run::{Done, LAMP, Place};

const RENDER: [&str; 6] = ["render", "room.toml", "--size", "48x32", "--lookup", "half-ball"];
const STEP: [&str; 2] = ["--step", "0.2"];
const MESH: [&str; 2] = ["--mesh-file", "room.mesh"];
/// A lamp that light points sample.
const BALL: &str = "-3,4,1;0.5;0.4";

/// Renders with these flags and without the mesh file. Returns the messages and the long tests that were performed and saved; the image is the
/// same.
fn same(place: &Place, flags: &[&str]) -> (Done, [u64; 2]) {
    let step = if flags.contains(&"--step") { &[][..] } else { &STEP };
    let with = ["-o", "with.exr", "--stats", "with.json"];
    let done = place.good(&[&RENDER[..], step, flags, &with, &MESH].concat());
    place.good(&[&RENDER[..], step, flags, &["-o", "without.exr"]].concat());
    assert!(place.read("with.exr") == place.read("without.exr"), "{flags:?}: the image differs");
    (done, tests(&place.json("with.json")))
}

fn tests(stats: &Value) -> [u64; 2] {
    ["long_tests", "long_tests_saved"].map(|name| stats["counts"][name].as_u64().unwrap())
}

#[test]
fn a_second_run_tests_nothing() {
    for lights in [&["--light", LAMP][..], &["--light", BALL], &["--light", LAMP, "--light", BALL, "--bounces", "1"]] {
        let place = Place::new();
        let (first, [made, saved]) = same(&place, lights);
        assert!(made > 1000 && saved == 0, "{made} {saved}");
        assert!(first.stderr.contains("room.mesh: wrote "), "{first:?}");
        let written = place.read("room.mesh");
        let (again, counts) = same(&place, lights);
        assert_eq!(counts, [0, made]);
        assert!(
            again.stderr.contains("room.mesh: read ") && again.stderr.contains(" values of light points\n"),
            "{again:?}"
        );
        assert!(place.read("room.mesh") == written, "what is known is the same");
        // Another camera finds some of it, and adds what it lacks.
        let aside = [lights, &["--camera", "0.5,2,6;0,1,0;45"]].concat();
        let (_, [made, saved]) = same(&place, &aside);
        assert!(made > 0 && saved > made, "{made} {saved}");
        assert!(place.read("room.mesh").len() > written.len());
        assert_eq!([same(&place, lights).1[0], same(&place, &aside).1[0]], [0, 0]);
    }
}

#[test]
fn what_decides_an_answer_makes_it_new() {
    let place = Place::new();
    let lights = |first: &'static str, second: &'static str| ["--light", first, "--light", second];
    let before = lights(LAMP, BALL);
    let [points, _] = same(&place, &before).1.map(|all| all / 5);
    // One ray to the first light, four to the second.
    assert_eq!(same(&place, &lights("3,5,2;0.1", BALL)).1[0], 0, "how strong a light is does not matter");
    assert_eq!(same(&place, &lights("3,5,1;0.9", BALL)).1, [points, 4 * points], "one light");
    let (seed, samples) = (["--seed", "9"], ["--seed", "9", "--samples", "7"]);
    assert_eq!(same(&place, &[&lights("3,5,1;0.9", BALL)[..], &seed].concat()).1, [4 * points, points]);
    assert_eq!(same(&place, &[&lights("3,5,1;0.9", BALL)[..], &samples].concat()).1, [7 * points, points]);
    let one = ["--light", "3,5,1;0.9"];
    assert_eq!(same(&place, &one).1, [0, points]);
}

/// The warning that a file is of no use; afterwards it has been replaced.
fn replaced(place: &Place, flags: &[&str]) -> String {
    let (done, [made, saved]) = same(place, flags);
    assert!(made > 0 && saved == 0, "{flags:?}: {made} {saved}");
    let warning = done.stderr.lines().find(|line| line.starts_with("warning: "));
    let warning = warning.unwrap_or_else(|| panic!("no warning in {done:?}")).to_owned();
    assert!(warning.starts_with("warning: room.mesh: "), "{warning}");
    assert!(warning.ends_with("; the mesh is built anew and replaces it"), "{warning}");
    let (done, [again, _]) = same(place, flags);
    assert!(again == 0 && !done.stderr.contains("warning"), "{done:?}");
    warning
}

#[test]
fn a_stale_or_damaged_file_is_replaced_with_a_warning() {
    let place = Place::new();
    let lamp = ["--light", LAMP];
    same(&place, &lamp);
    let step = replaced(&place, &[&lamp[..], &["--step", "0.3"]].concat());
    assert!(step.contains("has light points of step 0.2, this image those of step 0.3"), "{step}");
    assert!(replaced(&place, &lamp).contains("of step 0.3, this image those of step 0.2"));
    let whole = place.read("room.mesh");
    for (at, fault) in
        [(8, "version"), (12, "damaged"), (20, "damaged"), (whole.len() / 2, "damaged"), (whole.len() - 1, "damaged")]
    {
        let mut bytes = whole.clone();
        bytes[at] ^= 0x40;
        std::fs::write(place.path("room.mesh"), bytes).unwrap();
        assert!(replaced(&place, &lamp).contains(fault), "byte {at}");
        assert!(place.read("room.mesh") == whole, "byte {at}");
    }
    // Version 2, whose content is compressed by Zstandard.
    let older =
        [&whole[..8], &2u32.to_le_bytes(), &whole[12..24], &[0x28, 0xb5, 0x2f, 0xfd, 0, 0x48, 1, 0, 0]].concat();
    std::fs::write(place.path("room.mesh"), older).unwrap();
    assert!(replaced(&place, &lamp).contains("has format version 2, this program reads version 4"));
    assert!(place.read("room.mesh") == whole);
    for length in [8, 30, whole.len() / 2, whole.len() - 1] {
        std::fs::write(place.path("room.mesh"), &whole[..length]).unwrap();
        assert!(replaced(&place, &lamp).contains("damaged"), "{length} bytes");
    }
    // The ball of the room elsewhere, and as many triangles.
    let moved =
        String::from_utf8(place.read("room.toml")).unwrap().replace("center = [0, 1, 0]", "center = [0, 1.5, 0]");
    place.write("room.toml", &moved);
    assert!(replaced(&place, &lamp).contains("belongs to another scene"));
}

/// Under a sky, without light points: the same image, with fewer rays; of another sky nothing is used, and light is gathered anew.
#[test]
fn gathered_light_is_kept_from_run_to_run() {
    let place = Place::new();
    let rays = |name: &str| place.json(name)["counts"]["gather_rays"].as_u64().unwrap();
    let render = |sky: &[&str]| {
        let render = [&["render", "room.toml", "--size", "48x32", "--sky"][..], sky].concat();
        let done = place.good(&[&render[..], &["-o", "with.exr", "--stats", "with.json"], &MESH].concat());
        place.good(&[&render[..], &["-o", "without.exr", "--stats", "without.json"]].concat());
        assert!(place.read("with.exr") == place.read("without.exr"), "{sky:?}: the image differs");
        (done, [rays("with.json"), rays("without.json")])
    };
    let (first, [made, all]) = render(&["clear"]);
    assert!(
        made == all
            && first.stderr.contains("room.mesh: wrote ")
            && first.stderr.contains(" records of gathered light, "),
        "{first:?}"
    );
    let (again, [made, all]) = render(&["clear"]);
    assert!(
        again.stderr.contains("room.mesh: read ") && again.stderr.contains(" records of gathered light\n"),
        "{again:?}"
    );
    assert!(4 * made < all && !again.stderr.contains("warning"), "{made} of {all}: {again:?}");
    let (other, [made, all]) = render(&["uniform"]);
    let warning = "room.mesh: has light gathered from other lights, surroundings or materials";
    assert!(made == all && other.stderr.contains(warning), "{other:?}");
    assert!(other.stderr.contains("; light is gathered anew and replaces it"), "{other:?}");
    let (again, [made, all]) = render(&["uniform"]);
    assert!(4 * made < all && !again.stderr.contains("warning"), "{again:?}");
    // Each surface point for itself: nothing is kept.
    let done = place.good(
        &[
            &["render", "room.toml", "--size", "8x6", "--sky", "clear", "--ambient-light", "rays"][..],
            &["-o", "a.exr"],
            &MESH,
        ]
        .concat(),
    );
    assert!(done.stderr.contains("--mesh-file room.mesh is not used: "), "{done:?}");
}

#[test]
fn what_is_no_mesh_is_left_alone() {
    let place = Place::new();
    place.write("room.mesh", "diary");
    let run = [&RENDER[..], &["-o", "a.png"], &MESH].concat();
    let message = place.refused(&run);
    assert!(message.contains("room.mesh: is not a mesh file; choose the name of a mesh file"), "{message}");
    assert_eq!(place.read("room.mesh"), b"diary");
    std::fs::create_dir(place.path("folder")).unwrap();
    for (file, expected) in [
        ("a.png", "-o and --mesh-file are the same file"),
        ("./room.toml", "are the same file"),
        ("-", "name a file"),
        ("none/a", "none"),
    ] {
        let message = place.refused(&[&RENDER[..], &["-o", "a.png", "--mesh-file", file]].concat());
        assert!(message.contains(expected), "{file}: {message}");
    }
    let done = place.run(&[&RENDER[..], &["-o", "a.png", "--mesh-file", "folder"]].concat());
    assert!(done.code == Some(2) && !place.path("a.png").exists(), "{done:?}");
}

#[test]
fn where_nothing_is_kept_the_file_is_not_touched() {
    let place = Place::new();
    for flags in [&["--lookup", "lists"][..], &["--mode", "area"], &["--mode", "ray-trace"], &["--lookup", "adaptive"]]
    {
        let render = ["render", "room.toml", "--size", "16x12", "-o", "a.exr", "--samples", "4"];
        let done = place.good(&[&render[..], flags, &MESH].concat());
        assert!(done.stderr.contains("--mesh-file room.mesh is not used: "), "{flags:?}: {done:?}");
        assert!(!place.path("room.mesh").exists(), "{flags:?}");
    }
}

/// Renders the frames of a film, `NAME.1.exr` and so on, without the mesh file and twice with it: they are the same.
fn same_frames(place: &Place, count: u32, film: impl Fn(&str, &[&str]) -> Done) {
    film("without", &[]);
    film("first", &MESH);
    film("second", &MESH);
    for number in 1..=count {
        let image = |name: &str| place.read(&format!("{name}.{number}.exr"));
        assert!(image("without") == image("first") && image("without") == image("second"), "frame {number}");
    }
}

#[test]
fn a_film_begins_with_what_another_has_found() {
    let place = Place::new();
    let film = |name: &str, flags: &[&str]| {
        let (images, stats) = (format!("{name}.#.exr"), format!("{name}.#.json"));
        place.good(
            &[
                &RENDER[..],
                &["--step", "0.2", "--turntable", "4", "--light", BALL, "-o", &images, "--stats", &stats],
                flags,
            ]
            .concat(),
        )
    };
    same_frames(&place, 4, film);
    for number in 1..=4 {
        assert_eq!(tests(&place.json(&format!("second.{number}.json")))[0], 0, "frame {number}");
    }
    assert!(tests(&place.json("first.1.json"))[0] > 0);
}

#[test]
fn a_day_begins_with_a_file() {
    let place = Place::new();
    let film = |name: &str, flags: &[&str]| {
        let images = format!("{name}.#.exr");
        let sun =
            ["--step", "0.2", "--sun", "48,0,2026-06-21Z,08:00-12:00/2h", "--ambient-light", "constant", "-o", &images];
        place.good(&[&RENDER[..], &sun, flags].concat())
    };
    same_frames(&place, 3, film);
}

/// As on a full disk: files cannot be larger than 4 or 8 KiB.
#[cfg(unix)]
#[test]
fn a_file_that_cannot_be_written_stays_as_it_was() {
    let place = Place::new();
    let lights =
        ["--step", "0.02", "--samples", "99", "--light", BALL, "--light", "3,4,1;0.5;0.4", "--light", "0,4,2;0.5;0.4"];
    same(&place, &lights);
    let (before, files) = (place.read("room.mesh"), place.files());
    assert!(before.len() > 8 << 10, "{} bytes", before.len());
    let render = [&RENDER[..], &lights, &["--seed", "1", "-o", "again.png"], &MESH].concat();
    let done: Done = place.shell("ulimit -f 8; exec \"$0\" \"$@\"", &render).output().unwrap().into();
    assert!(done.code == Some(0) && done.stderr.contains("warning: cannot write room.mesh: "), "{done:?}");
    assert!(place.read("room.mesh") == before);
    assert_eq!(place.files(), [&["again.png".to_owned()], &files[..]].concat());
}

/// Where the mesh file exceeds the limit on files, and pictures do not.
#[test]
#[cfg(unix)]
fn a_mesh_file_that_cannot_be_written_costs_no_picture() {
    const LARGE: [&str; 8] = ["--step", "0.02", "--samples", "99", "--light", BALL, "--light", "3,4,1;0.5;0.4"];
    let script = "ulimit -f 8; exec \"$0\" \"$@\"";
    for film in [false, true] {
        let place = Place::new();
        let motion: &[&str] = if film { &["--turntable", "2", "-o", "p.#.png"] } else { &["-o", "p.png"] };
        let done: Done = place.shell(script, &[&RENDER[..], &LARGE, &MESH, motion].concat()).output().unwrap().into();
        assert_eq!(done.code, Some(0), "{done:?}");
        let warning = done.stderr.lines().find(|line| line.starts_with("warning: cannot write ")).unwrap();
        assert!(warning.contains("room.mesh: File too large"), "{warning}");
        assert!(warning.ends_with("; what was rendered is complete, later runs start without it"), "{warning}");
        let pictures: &[&str] = if film { &["p.1.png", "p.2.png"] } else { &["p.png"] };
        for picture in pictures {
            assert!(place.path(picture).exists(), "{picture}");
        }
        assert!(!place.path("room.mesh").exists());
    }
}

/// A film of which everything cannot be kept: light points that were not used for the longest give way.
#[test]
fn a_film_under_a_limit_is_the_same_and_stays_below_it() {
    const LIMIT: u64 = 150 << 20;
    let place = Place::new();
    let lamps: Vec<String> = (1..=6).map(|x| format!("{x},4,1;0.5;0.4")).collect();
    let lamps: Vec<&str> = lamps.iter().flat_map(|lamp| ["--light", lamp]).collect();
    let film = |name: &str, flags: &[&str]| -> Vec<[u64; 3]> {
        let (images, stats) = (format!("{name}.##.exr"), format!("{name}.##.json"));
        let settings =
            ["--lookup", "half-ball", "--step", "0.01", "--samples", "1", "--turntable", "40", "--frames", "1-24x2"];
        let outputs = ["render", "room.toml", "--size", "240x180", "-o", &images, "--stats", &stats, "--device", "cpu"];
        let done = place.good(&[&outputs[..], &settings, &lamps, flags].concat());
        assert!(!done.stderr.contains("dropped"), "{done:?}");
        let counts = |number: u32| {
            let stats = place.json(&format!("{name}.{number:02}.json"));
            let [made, saved] = tests(&stats);
            [made, saved, stats["memory"]["host_peak_bytes"].as_u64().unwrap()]
        };
        (1..=24).step_by(2).map(counts).collect()
    };
    let free = film("free", &[]);
    let limited = film("limited", &["--memory-limit", "150MiB"]);
    for number in (1..=24).step_by(2) {
        let [a, b] = ["free", "limited"].map(|name| place.read(&format!("{name}.{number:02}.exr")));
        assert!(a == b, "frame {number}: another image");
    }
    let sum = |film: &[[u64; 3]], column: usize| film.iter().map(|counts| counts[column]).sum::<u64>();
    // Most of what is saved was used a moment ago.
    assert!(sum(&limited, 1) > sum(&free, 1) / 2, "{limited:?} {free:?}");
    assert!(sum(&limited, 0) > sum(&free, 0), "something was evicted: {limited:?} {free:?}");
    let most = |film: &[[u64; 3]]| film.iter().map(|counts| counts[2]).max().unwrap();
    // Not compared with the other film: how many frames wait to be written at the worst moment differs from run to run.
    assert!(most(&limited) < LIMIT, "{limited:?}");
}
