//! `lightmesh render`: the effect of each flag.

use lightmesh::image::Frame;
use serde_json::json;

use crate::run::{LAMP, Place};

#[test]
fn every_format_holds_the_picture() {
    let place = Place::new();
    for name in ["a.bmp", "a.png", "a.jpg", "a.exr"] {
        let done = place.good(&["render", "builtin:gazebo", "-o", name, "--size", "64x48"]);
        let frame = Frame::load(place.path(name)).unwrap();
        assert_eq!((frame.width(), frame.height()), (64, 48));
        let summary = done.stderr.lines().last().unwrap();
        assert!(summary.starts_with("gazebo, 64x48, lists: ") && summary.ends_with(name), "{summary}");
        assert_eq!(done.stdout, "");
    }
}

#[test]
fn the_summary_names_the_method() {
    let place = Place::new();
    for (flags, method) in [
        (&["--lookup", "adaptive"][..], "adaptive"),
        (&["--step", "0.5"], "half-ball"),
        (&["--mode", "area", "--samples", "4"], "area"),
        (&["--mode", "ray-trace", "--lookup", "adaptive"], "ray-trace"),
    ] {
        let done = place.good(&[&["render", "room.toml", "-o", "a.png", "--size", "16x12"], flags].concat());
        let summary = done.stderr.lines().last().unwrap();
        assert!(summary.starts_with(&format!("room, 16x12, {method}: ")), "{flags:?}: {summary}");
    }
}

#[test]
fn what_only_light_points_use_is_refused_without_them() {
    let place = Place::new();
    let render = ["render", "room.toml", "-o", "a.png", "--size", "16x12"];
    for (flags, expected) in [
        (
            &["--lookup", "lists", "--step", "0.5"][..],
            "--step is of light points, which --lookup lists does not have; leave it out, or choose --lookup half-ball",
        ),
        (
            &["--lookup", "adaptive", "--radius", "3"],
            "--radius is of light points, which --lookup adaptive does not have",
        ),
        (&["--lookup", "lists", "--weight", "constant"], "--weight is of light points"),
        (&["--short-tests", "plain"], "--short-tests is of light points, which --lookup lists does not have"),
        (
            &["--mode", "area", "--step", "0.5"],
            "--step is of light points, which --mode area does not have; leave it out, or choose --lookup half-ball without --mode",
        ),
    ] {
        let message = place.refused(&[&render[..], flags].concat());
        assert!(message.contains(expected), "{flags:?}: {message}");
    }
    for flags in [&["--step", "0.5"][..], &["--lookup", "half-ball", "--short-tests", "plain"], &["--step", "auto"]] {
        place.good(&[&render[..], flags].concat());
    }
}

#[test]
fn choices_made_for_the_user_are_said_and_quiet_is_quiet() {
    let place = Place::new();
    let done = place.good(&["render", "room.toml", "-o", "a.png", "--size", "16x16"]);
    assert!(done.stderr.contains("device auto: using "), "{done:?}");
    assert!(
        done.stderr
            .contains("the scene has no lights: using a studio, a large key light at the upper left of the camera"),
        "{done:?}"
    );
    assert!(done.stderr.contains("64 samples of each light, quality good (--quality sets another)"), "{done:?}");
    assert!(!done.stderr.contains("no camera"), "{done:?}");
    let done = place.good(&["render", "room.toml", "-o", "a.png", "--size", "16x16", "--lookup", "half-ball"]);
    assert!(done.stderr.contains("chosen for this image (--step sets another)"), "{done:?}");
    let done = place.good(&["render", "room.toml", "-o", "a.png", "--size", "16x16", "-q"]);
    assert_eq!(done.stderr, "");
    let done = place.good(&["render", "room.toml", "-o", "a.png", "--size", "16x16", "--no-studio"]);
    assert!(
        done.stderr.contains("the scene has no lights: using a key light above the camera and a weaker fill light"),
        "{done:?}"
    );
}

#[test]
fn a_model_without_light_stands_in_a_studio() {
    let place = Place::new();
    place.write("ball.toml", "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n");
    let base = ["render", "ball.toml", "--size", "32x32", "--quality", "draft"];
    let picture = |flags: &[&str]| {
        place.good(&[&base[..], &["-o", "a.exr"], flags].concat());
        place.read("a.exr")
    };
    let studio = picture(&[]);
    let frame = Frame::load(place.path("a.exr")).unwrap();
    // The ground shows the background from border to border but where there is a shadow, and the ball is lighter than black everywhere.
    for corner in [0, 31, 31 * 32] {
        assert!(
            frame.color()[corner].iter().all(|channel| (channel - 0.65).abs() < 1e-3),
            "{:?}",
            frame.color()[corner]
        );
    }
    assert!(frame.color().iter().any(|color| color[0] < 0.55) && frame.color().iter().all(|color| color[0] > 0.1));
    // It has a ground already, and is the same if it is asked for.
    assert_eq!((picture(&["--studio"]), picture(&["--ground"])), (studio.clone(), studio.clone()));
    // Whatever gives light or a background takes its place.
    let plain = picture(&["--no-studio"]);
    assert!(plain != studio && picture(&["--background", "0"]) == plain, "black is the default background");
    for flags in
        [&["--light", "3,8,2"][..], &["--sky", "uniform"], &["--ambient", "0.2"], &["--background", "transparent"]]
    {
        assert_eq!(picture(flags), picture(&[flags, &["--no-studio"]].concat()), "{flags:?}");
        let refused = place.refused(&[&base[..], &["-o", "a.exr", "--studio"], flags].concat());
        assert!(refused.contains("cannot be used with"), "{refused}");
    }
}

#[test]
fn metals_in_a_studio_mirror_its_soft_boxes_and_nothing_brighter() {
    let place = Place::new();
    let material = "[[material]]\nname = \"metal\"\nkd = 0.9\nmetallic = 1\nroughness = 0.2\n";
    place.write("ball.toml", &format!("{material}[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"metal\"\n"));
    place.good(&["render", "ball.toml", "--size", "64x64", "--quality", "draft", "-o", "a.exr"]);
    let frame = Frame::load(place.path("a.exr")).unwrap();
    let most = frame.color().iter().map(|color| color[0]).fold(0.0, f32::max);
    // The key light itself, which is the middle of a box in the panorama, would be more than a hundred.
    assert!((1.5..9.0).contains(&most), "{most}");
}

#[test]
fn a_studio_does_not_replace_light() {
    let place = Place::new();
    let ball = "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n";
    for (light, what) in [
        ("[[light]]\nkind = \"point\"\nposition = [3, 8, 2]\n", "lights of its own"),
        ("[ambient]\nintensity = [0.1, 0.1, 0.1]\n", "ambient light of its own"),
        ("[ambient]\nbackground = [0.6, 0.75, 0.9]\n", "a background"),
    ] {
        place.write("lit.toml", &format!("{light}{ball}"));
        let base = ["render", "lit.toml", "--size", "16x16", "-o", "a.exr"];
        place.good(&base);
        let picture = place.read("a.exr");
        place.good(&[&base[..], &["--no-studio"]].concat());
        assert_eq!(place.read("a.exr"), picture, "{what}");
        let refused = place.refused(&[&base[..], &["--studio"]].concat());
        assert!(refused.contains(&format!("--studio: the scene has {what}")), "{refused}");
    }
}

#[test]
fn a_scene_without_camera_is_framed() {
    let place = Place::new();
    place.write("ball.toml", "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n");
    let pictures = ["y", "z"].map(|up| {
        let done = place.good(&["render", "ball.toml", "-o", "a.exr", "--size", "16x16", "--up", up]);
        assert!(
            done.stderr
                .contains(&format!("the scene has no camera: using one that frames it from the front, with {up} up")),
            "{done:?}"
        );
        place.read("a.exr")
    });
    assert_ne!(pictures[0], pictures[1]);
}

#[test]
fn warnings_of_the_scene_are_shown() {
    let place = Place::new();
    let camera = "[camera]\nposition = [0, 0, 9]\ntarget = [0, 0, 0]\nvfov = 40\nhfov = 50\n";
    place.write("ball.toml", &format!("{camera}[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n"));
    let base = ["render", "ball.toml", "-o", "a.exr", "--size", "16x16"];
    let done = place.good(&base);
    assert!(done.stderr.contains("warning: ball.toml:1: the camera has vfov and hfov"), "{done:?}");
    assert_eq!(place.good(&[&base[..], &["--quiet"]].concat()).stderr, "");
}

#[test]
fn modes_and_their_settings_reach_the_renderer() {
    let place = Place::new();
    let settings = |flags: &[&str]| place.room_stats(flags)["settings"].clone();

    let mesh = settings(&["--step", "0.25", "--radius", "1.5", "--weight", "quadratic", "--lookup", "half-ball"]);
    assert_eq!(mesh["mode"], "light-mesh");
    assert_eq!((&mesh["step"], &mesh["step_auto"]), (&json!(0.25), &json!(false)));
    assert_eq!(
        (&mesh["radius"], &mesh["weight"], &mesh["lookup"]),
        (&json!(1.5), &json!("quadratic"), &json!("half-ball"))
    );
    assert_eq!(mesh["lattice"]["step"], 0.25);
    assert_eq!((&mesh["transfer"], &mesh["size"]), (&json!("srgb"), &json!([48, 32])));

    assert_eq!(settings(&["--step", "auto"])["step_auto"], true);
    assert_eq!(settings(&["--mode", "ray-trace", "--bounces", "2"])["bounces"], 2);
    let area = settings(&["--mode", "area", "--samples", "9", "--seed", "7"]);
    assert_eq!((&area["mode"], &area["samples"], &area["seed"]), (&json!("area"), &json!(9), &json!(7)));
    assert_eq!(settings(&["--mode", "area"])["samples"], 225);
    assert_eq!(settings(&["--lookup", "half-ball"])["samples"], 4);
    for (flags, quality, samples) in [
        (&[][..], json!("good"), 64),
        (&["--quality", "draft"], json!("draft"), 16),
        (&["--quality", "final", "--lookup", "lists"], json!("final"), 256),
        (&["--quality", "final", "--samples", "5"], json!(null), 5),
    ] {
        let lists = settings(flags);
        assert_eq!((&lists["lookup"], &lists["quality"]), (&json!("lists"), &quality), "{flags:?}");
        assert_eq!(lists["samples"], samples, "{flags:?}");
    }
    for (flags, aa) in [(&[][..], 8), (&["--quality", "final"], 16), (&["--mode", "area"], 1), (&["--aa", "3"], 3)] {
        assert_eq!(settings(flags)["aa"], aa, "{flags:?}");
    }
    assert_eq!(settings(&["--filter", "box"])["filter"], "box");
    assert_eq!(settings(&["--aa", "1"])["filter"], json!(null));
    let adaptive = settings(&["--lookup", "adaptive", "--quality", "draft"]);
    assert_eq!((&adaptive["lookup"], &adaptive["quality"]), (&json!("adaptive"), &json!("draft")));
    assert_eq!(adaptive["samples"], 16);
    for flags in [["--step", "auto"], ["--radius", "1.5"], ["--weight", "constant"]] {
        assert_eq!(settings(&flags)["lookup"], "half-ball", "{flags:?}");
    }
}

#[test]
fn statistics_tell_times_of_files_apart() {
    let place = Place::new();
    let stats = place.room_stats(&[]);
    let seconds = |name: &str| stats["seconds"][name].as_f64().unwrap();
    assert!(seconds("load") > 0.0 && seconds("write") > 0.0 && seconds("render") > 0.0, "{stats}");
    let stages: f64 = ["primary_rays", "short_tests", "collect", "long_tests", "shade"].map(seconds).iter().sum();
    assert!(stages <= seconds("render"), "{stats}");
    assert_eq!((&stats["version"], &stats["scene"]["name"]), (&json!(1), &json!("room")));
    assert_eq!(stats["counts"]["pixels"], 48 * 32);
    assert!(stats["memory"]["host_peak_bytes"].is_u64());
}

#[test]
fn lights_replace_those_of_the_scene() {
    let place = Place::new();
    let flags = ["--light", "-1,4,0;0.5,0.25,0;0.5", "--falloff", "inverse-square", "--ambient", "0.25"];
    let stats = place.room_stats(&flags);
    let [lamp, ball] = &stats["settings"]["lights"].as_array().unwrap()[..] else { panic!("{stats}") };
    assert_eq!((&lamp["kind"], &lamp["position"]), (&json!("point"), &json!([3.0, 5.0, 2.0])));
    assert_eq!((&ball["kind"], &ball["radius"]), (&json!("sphere"), &json!(0.5)));
    assert_eq!((&ball["intensity"], &ball["falloff"]), (&json!([0.5, 0.25, 0.0]), &json!("inverse-square")));
    assert_eq!(stats["settings"]["ambient"], json!([0.25, 0.25, 0.25]));
    assert_eq!(place.room_stats(&["--ambient", "0.5,0.25,0"])["settings"]["ambient"], json!([0.5, 0.25, 0.0]));
}

#[test]
fn a_camera_is_typed_or_named() {
    let place = Place::new();
    let camera = |flags: &[&str]| place.room_stats(flags)["settings"]["camera"].clone();
    let typed = camera(&["--camera", "-1,2,8;-1,2,0;30"]);
    assert_eq!((&typed["position"], &typed["direction"]), (&json!([-1.0, 2.0, 8.0]), &json!([0.0, 0.0, -1.0])));
    assert_eq!((&typed["up"], &typed["vfov"]), (&json!([0.0, 1.0, 0.0]), &json!(30.0)));
    assert_eq!(camera(&["--camera", "0,0,9;0,0,0;30", "--up", "z"])["up"], json!([0.0, 1.0, 0.0]));
    assert_eq!(camera(&["--camera-name", "top"])["position"], json!([0.0, 9.0, 0.0]));
    assert_eq!(camera(&[])["position"], json!([0.0, 2.0, 6.0]));
}

#[test]
fn the_picture_does_not_depend_on_how_it_is_computed() {
    let place = Place::new();
    let reference = place.room(&[]);
    place.good(&["grid", "room.toml", "-o", "room.grid", "--grid", "9x8x7", "--levels", "1", "--quiet"]);
    let ways: [&[&str]; 8] = [
        &["--threads", "1"],
        &["--threads", "2"],
        &["--accel", "bvh"],
        &["--accel", "grid"],
        &["--grid", "5x4x3"],
        &["--accel", "grid", "--grid-file", "room.grid"],
        &["--device", "cpu"],
        &["--lookup", "auto", "--bounces", "0", "--progress", "none"],
    ];
    for flags in ways {
        assert!(place.room(flags) == reference, "{flags:?}");
    }
    assert!(place.room(&["--radius", "3.1"]) != reference);
    let half_ball = ["--lookup", "half-ball"];
    assert!(place.room(&[&half_ball[..], &["--short-tests", "plain"]].concat()) == place.room(&half_ball));
}

#[test]
fn a_memory_limit_splits_the_work_and_keeps_the_picture() {
    let place = Place::new();
    let base = ["render", "builtin:gazebo", "--size", "384x384", "-q", "--bounces", "1"];
    place.good(&[&base[..], &["-o", "whole.exr", "--stats", "whole.json"]].concat());
    place.good(&[&base[..], &["-o", "split.exr", "--stats", "split.json", "--memory-limit", "80M"]].concat());
    assert_eq!(place.json("whole.json")["settings"]["rows_per_band"], 384);
    assert!(place.json("split.json")["settings"]["rows_per_band"].as_u64().unwrap() < 384);
    assert!(place.read("whole.exr") == place.read("split.exr"));
}

#[test]
fn layers_say_what_each_pixel_saw() {
    let place = Place::new();
    place.room(&["--layers", "layers.exr"]);
    let frame = Frame::load(place.path("layers.exr")).unwrap();
    let layers = frame.layers().unwrap();
    assert_eq!((layers.visibility.len(), layers.lights.len(), layers.rest.len()), (1, 1, layers.depth.len()));
    assert!(layers.depth.iter().any(|depth| depth.is_finite()));
    for matte in [&layers.object, &layers.material] {
        assert!(!matte.names.is_empty() && matte.nearest.contains(&1) && matte.ranks.len() == 6);
    }
}

#[test]
fn layers_in_one_part_or_several_are_the_same() {
    let place = Place::new();
    place.room(&["--layers", "one.exr", "--exr-parts", "single", "--aa", "3"]);
    place.room(&["--layers", "several.exr", "--exr-parts", "multi", "--aa", "3", "--stats", "several.json"]);
    assert!(Frame::load(place.path("one.exr")).unwrap() == Frame::load(place.path("several.exr")).unwrap());
    assert!(place.read("one.exr") != place.read("several.exr"));
    assert_eq!(place.json("several.json")["settings"]["exr_parts"], "multi");
    place.good(&["compare", "one.exr", "several.exr", "--max-flip", "0"]);
    place.room(&["--layers", "again.exr", "--aa", "3"]);
    assert!(place.read("again.exr") == place.read("one.exr"));
}

#[test]
fn transfer_is_of_8_bit_files() {
    let place = Place::new();
    let picture = |transfer: &str| {
        let base = ["render", "room.toml", "-o", "a.bmp", "--size", "24x24", "-q", "--light", LAMP];
        place.good(&[&base[..], &["--transfer", transfer]].concat());
        place.read("a.bmp")
    };
    let (srgb, linear) = (picture("srgb"), picture("linear"));
    let sum = |bytes: &[u8]| bytes.iter().map(|&byte| u64::from(byte)).sum::<u64>();
    assert!(sum(&srgb) > sum(&linear));
}

#[test]
fn progress_is_one_json_object_a_line() {
    let place = Place::new();
    let flags = ["--size", "32x32", "--progress", "json", "--lookup", "half-ball"];
    let done = place.good(&[&["render", "room.toml", "-o", "a.png"], &flags[..]].concat());
    let events: Vec<serde_json::Value> = done.stderr.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let stages = |event: &str| -> Vec<String> {
        let of_kind = events.iter().filter(|it| it["event"] == event);
        of_kind.map(|it| it["stage"].as_str().unwrap().to_owned()).collect()
    };
    assert_eq!(stages("begin"), stages("end"));
    for stage in ["build", "primary_rays", "short_tests", "collect", "long_tests", "shade"] {
        assert!(stages("begin").contains(&stage.to_owned()), "{stage}");
    }
    let primary = events.iter().find(|it| it["event"] == "end" && it["stage"] == "primary_rays").unwrap();
    assert_eq!((&primary["done"], &primary["total"]), (&json!(1024), &json!(1024)));
    assert!(primary["seconds"].is_f64());
    assert_eq!(events.last().unwrap()["event"], "summary");
    // A bar is only shown on terminals.
    let bar = place.good(&["render", "room.toml", "-o", "a.png", "--size", "16x16", "--progress", "bar", "-q"]);
    assert_eq!(bar.stderr, "");
}

#[test]
fn exposure_brightens_8_bit_files_alone() {
    let place = Place::new();
    let render = |name: &str, flags: &[&str]| {
        let base = ["render", "room.toml", "-o", name, "--size", "32x24", "--light", LAMP, "--stats", "s.json"];
        let done = place.good(&[&base, flags].concat());
        (Frame::load(place.path(name)).unwrap(), place.json("s.json")["settings"]["exposure"].as_f64().unwrap(), done)
    };
    let linear = ["--transfer", "linear"];
    let (plain, zero, _) = render("a.png", &linear);
    let (darker, stops, _) = render("b.png", &[&linear[..], &["--exposure", "-1"]].concat());
    assert_eq!((zero, stops), (0.0, -1.0));
    for (plain, darker) in plain.color().as_flattened().iter().zip(darker.color().as_flattened()) {
        assert!(*plain >= 1.0 || (0.5 * plain - darker).abs() < 1.6 / 255.0, "{plain} {darker}");
    }
    let (as_computed, ..) = render("a.exr", &[]);
    let (exposed, none, _) = render("b.exr", &["--exposure", "5", "--layers", "c.exr"]);
    assert_eq!((as_computed.color(), none), (exposed.color(), 0.0));
    let (_, stops, _) = render("a.png", &["--exposure", "5", "--layers", "d.exr"]);
    let layers = Frame::load(place.path("d.exr")).unwrap();
    assert_eq!((layers.color(), stops), (as_computed.color(), 5.0));
}

#[test]
fn photometric_lights_are_exposed_unless_told_otherwise() {
    let place = Place::new();
    let render = |flags: &[&str]| {
        let base =
            ["render", "room.toml", "-o", "a.png", "--size", "32x24", "--light", "3,5,2;5000", "--stats", "s.json"];
        let done = place.good(&[&base, flags].concat());
        let settings = place.json("s.json")["settings"].clone();
        (done.stderr, settings["exposure"].as_f64().unwrap(), settings["ambient"][0].as_f64().unwrap())
    };
    let (said, stops, ambient) = render(&["--falloff", "inverse-square"]);
    assert!(said.contains("exposure auto: using -") && stops < 0.0 && ambient > 1.0, "{said} {stops} {ambient}");
    let (_, stops, _) = render(&["--falloff", "inverse-square", "--exposure", "1"]);
    assert_eq!(stops, 1.0);
    let (_, stops, ambient) = render(&[]);
    assert_eq!((stops, ambient as f32), (0.0, 0.1));
}

#[test]
fn any_light_level_comes_into_range() {
    let place = Place::new();
    let pictures = ["1e-4", "0.9", "5e6"].map(|intensity| {
        let light = format!("3,5,2;{intensity}");
        let base = ["render", "room.toml", "-o", "a.png", "--size", "32x24", "--ambient", "0", "--exposure", "auto"];
        let done = place.good(&[&base[..], &["--light", &light]].concat());
        assert!(done.stderr.contains("exposure auto: using "), "{done:?}");
        place.read("a.png")
    });
    let mean = |bytes: &[u8]| {
        let frame = Frame::decode(bytes).unwrap();
        frame.color().as_flattened().iter().sum::<f32>() / frame.color().as_flattened().len() as f32
    };
    for picture in &pictures {
        assert!((mean(picture) - mean(&pictures[0])).abs() < 0.01 && mean(picture) > 0.05, "{}", mean(picture));
    }
}

#[test]
fn strict_reading_ends_with_the_warnings() {
    let place = Place::new();
    place.write(
        "bare.toml",
        "[[material]]\nname = \"oak\"\ntexture = \"../oak.png\"\n[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n",
    );
    for command in [
        &["render", "-o", "a.png", "--size", "8x8"][..],
        &["info"],
        &["grid", "-o", "a.grid"],
        &["export", "-o", "a.glb"],
    ] {
        let message = place.refused(&[command, &["bare.toml", "--strict"]].concat());
        assert!(message.contains("`../oak.png` leads outside the scene's folder, bare.toml"), "{message}");
        let message = place.refused(&[command, &["bare.toml", "--strict", "--allow-outside"]].concat());
        assert!(message.contains("../oak.png; check that it exists"), "{message}");
    }
    let done = place.good(&["render", "-o", "a.png", "--size", "8x8", "bare.toml"]);
    let warnings = done.stderr.lines().filter(|line| line.starts_with("warning: ")).count();
    assert_eq!(warnings, 1, "{done:?}");
}

/// A small closed box around the camera and a light: `material` and `light` are lines of their tables.
fn closed_box(material: &str, light: &str) -> String {
    format!(
        "[camera]\nposition = [0, 0, 0]\ntarget = [1, 0.2, 0.1]\n[[light]]\nkind = \"point\"\nposition = [0.005, 0.005, 0.005]\n{light}\n\
         [[material]]\nname = \"glare\"\n{material}\n[[box]]\nmin = [-0.01, -0.01, -0.01]\nmax = [0.01, 0.01, 0.01]\nmaterial = \"glare\"\n"
    )
}

/// `counts.non_finite_pixels`, and what was said.
fn non_finite(place: &Place, scene: &str) -> (u64, String) {
    place.write("box.toml", scene);
    let flags = ["-o", "a.exr", "--size", "8x8", "--bounces", "200", "--mode", "ray-trace", "--stats", "a.json"];
    let done = place.good(&[&["render", "box.toml"], &flags[..]].concat());
    let stats: serde_json::Value = serde_json::from_slice(&place.read("a.json")).unwrap();
    (stats["counts"]["non_finite_pixels"].as_u64().unwrap(), done.stderr)
}

#[test]
fn mirrors_that_add_light_are_lowered_with_a_warning() {
    let place = Place::new();
    let (pixels, said) = non_finite(&place, &closed_box("ks = [8, 8, 8]", ""));
    assert_eq!(pixels, 0, "{said}");
    assert!(said.contains("warning: box.toml: 1 materials reflect more than they receive"), "{said}");
    assert!(said.contains("`glare` (ks = 8 8 8)"), "{said}");
    let (pixels, said) = non_finite(&place, &closed_box("kd = 1\nks = 1", ""));
    assert!(pixels == 0 && !said.contains("warning"), "{said}");
}

#[test]
fn pixels_that_are_not_finite_are_counted_with_a_warning() {
    let place = Place::new();
    let light = "intensity = 1e18\nfalloff = \"inverse-square\"";
    let (pixels, said) = non_finite(&place, &closed_box("kd = 1e18", light));
    assert!(pixels > 0, "{said}");
    assert!(said.contains(&format!("warning: {pixels} of 64 pixels have infinite or undefined colours")), "{said}");
}

/// A ball of 16 by 8 faces with smooth normals, or without any.
fn ball(normals: bool) -> String {
    let ring = |row: u32| (0..16).map(move |column| [f64::from(row) / 8.0, f64::from(column) / 8.0]);
    let point = |[down, around]: [f64; 2]| {
        let [(sin, cos), (aside, before)] = [down, around].map(|turn| (turn * std::f64::consts::PI).sin_cos());
        format!("{} {cos} {}\n", sin * before, sin * aside)
    };
    let points: Vec<String> = (0..=8).flat_map(ring).map(point).collect();
    let mut text: String = points.iter().map(|point| format!("v {point}vn {point}")).collect();
    let corner = |row: usize, column: usize| {
        let index = row * 16 + column % 16 + 1;
        if normals { format!("{index}//{index}") } else { index.to_string() }
    };
    for (row, column) in (0..8).flat_map(|row| (0..16).map(move |column| (row, column))) {
        let [a, b, c, d] = [(0, 0), (0, 1), (1, 1), (1, 0)].map(|(down, on)| corner(row + down, column + on));
        text += &if row > 0 { format!("f {a} {b} {d}\n") } else { String::new() };
        text += &if row < 7 { format!("f {b} {c} {d}\n") } else { String::new() };
    }
    text
}

#[test]
fn a_coarse_smooth_ball_has_no_teeth_where_it_turns_from_the_light() {
    let place = Place::new();
    // The largest rise and the largest fall from a pixel to the next, going away from the light.
    let steps = |text: &str| {
        place.write("ball.obj", text);
        let view = ["--camera", "0,0.6,5;0,0,0;28", "--light", "-300,120,100;1", "--ambient", "0", "--no-studio"];
        let base =
            ["render", "ball.obj", "-o", "a.exr", "--size", "256x256", "--aa", "1", "--up", "y", "--smooth", "off"];
        place.good(&[&base[..], &view].concat());
        let frame = Frame::load(place.path("a.exr")).unwrap();
        let mut most = [0.0f32; 2];
        for row in frame.color().chunks(256).skip(40).take(176) {
            let brightest = (0..256).max_by(|&a, &b| row[a][0].total_cmp(&row[b][0])).unwrap();
            for pair in row[brightest..].windows(2) {
                let step = pair[1][0] - pair[0][0];
                most = [most[0].max(step), most[1].max(-step)];
            }
        }
        most
    };
    let [rise, fall] = steps(&ball(true));
    assert!(rise < 0.002 && fall < 0.05, "{rise} {fall}");
    let [_, fall] = steps(&ball(false));
    assert!(fall > 0.1, "{fall}: facets have edges");
}

#[test]
fn threads_that_would_only_wait_are_not_started() {
    let place = Place::new();
    let render = |threads: &str, image: &str| {
        let flags = ["--size", "24x18", "--light", LAMP, "--device", "cpu", "--stats", "s.json"];
        let done = place.good(&[&["render", "room.toml", "-o", image, "--threads", threads][..], &flags].concat());
        (done.stderr, place.json("s.json")["settings"]["threads"].as_u64().unwrap())
    };
    let (note, started) = render("1000", "many.png");
    assert!(started == (4 * std::thread::available_parallelism().unwrap().get() as u64).clamp(16, 1000), "{started}");
    assert!(note.contains("--threads 1000: using ") && note.contains("the image is the same"), "{note}");
    let (note, started) = render("5", "few.png");
    assert!(started == 5 && !note.contains("--threads"), "{note}");
    assert!(place.read("many.png") == place.read("few.png"));
}
