//! How images are shown and stored: views, bits, dithering, background, exr files.

use lightmesh::Transfer;
use lightmesh::image::{Frame, View};
use serde_json::{Value, json};

use crate::run::Place;

const BALL: &str = "[camera]\nposition = [0, 0, 5]\ntarget = [0, 0, 0]\nvfov = 40\n[ambient]\nbackground = [0.2, 0.4, 0.8]\n\
                    [[light]]\nkind = \"point\"\nposition = [2, 3, 4]\nintensity = 3\n[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n";

/// The image and the settings.
fn render(place: &Place, name: &str, flags: &[&str]) -> (Frame, Value) {
    let base = ["render", "ball.toml", "-o", name, "--size", "32x24", "--lookup", "lists", "--stats", "s.json"];
    place.good(&[&base[..], flags].concat());
    (Frame::load(place.path(name)).unwrap(), place.json("s.json")["settings"].clone())
}

fn place() -> Place {
    let place = Place::new();
    place.write("ball.toml", BALL);
    place
}

#[test]
fn views_change_what_is_looked_at_and_never_an_exr() {
    let place = place();
    let (linear, settings) = render(&place, "a.exr", &["--view", "agx"]);
    assert_eq!(
        (&settings["view"], &settings["bit_depth"], &settings["exr_type"]),
        (&Value::Null, &Value::Null, &json!("float"))
    );
    for &view in View::ALL {
        let (shown, settings) = render(&place, "a.png", &["--view", view.name()]);
        assert_eq!((&settings["view"], &settings["exr_type"]), (&json!(view.name()), &Value::Null));
        for (&color, shown) in linear.color().iter().zip(shown.color()) {
            let expected = view.apply(color).map(|channel| Transfer::Srgb.decode(Transfer::Srgb.encode(channel)));
            assert_eq!(*shown, expected, "{view}: {color:?}");
        }
    }
}

#[test]
fn sixteen_bits_are_nearer_and_dithered_codes_are_next_to_the_value() {
    let place = place();
    let (linear, _) = render(&place, "a.exr", &[]);
    let off = |frame: &Frame| {
        let pairs = linear.color().as_flattened().iter().zip(frame.color().as_flattened());
        pairs.map(|(exact, shown)| (exact.clamp(0.0, 1.0) - shown).abs()).fold(0.0, f32::max)
    };
    let (narrow, settings) = render(&place, "a.png", &[]);
    assert_eq!((&settings["bit_depth"], &settings["dither"]), (&json!(8), &json!(false)));
    let (wide, settings) = render(&place, "b.png", &["--bit-depth", "16", "--dither", "on"]);
    assert_eq!((&settings["bit_depth"], &settings["dither"]), (&json!(16), &json!(false)));
    assert!(off(&wide) < 4e-5 && off(&narrow) > 5e-4, "{} {}", off(&wide), off(&narrow));
    let (dithered, settings) = render(&place, "c.png", &["--dither", "on"]);
    assert_eq!(settings["dither"], json!(true));
    assert!(off(&dithered) < 0.01 && dithered != narrow, "{}", off(&dithered));
}

#[test]
fn a_background_is_replaced_or_left_out() {
    let place = place();
    let (scene, settings) = render(&place, "a.exr", &[]);
    assert_eq!((scene.pixel(0, 0), &settings["transparent"]), (Some([0.2, 0.4, 0.8]), &json!(false)));
    let (red, settings) = render(&place, "a.exr", &["--background", "#ff0000"]);
    assert_eq!((red.pixel(0, 0), &settings["background"]), (Some([1.0, 0.0, 0.0]), &json!([1.0, 0.0, 0.0])));
    assert_eq!(red.pixel(16, 12), scene.pixel(16, 12));
    for (name, flags) in [("b.exr", &[][..]), ("b.png", &["--bit-depth", "16"])] {
        let flags = [flags, &["--background", "transparent", "--layers", "l.exr"]].concat();
        let (clear, settings) = render(&place, name, &flags);
        assert_eq!(settings["transparent"], json!(true));
        let alpha = clear.alpha().unwrap();
        assert_eq!((alpha[0], alpha[12 * 32 + 16], clear.pixel(0, 0)), (0.0, 1.0, Some([0.0; 3])), "{name}");
        let layers = Frame::load(place.path("l.exr")).unwrap();
        let exact = layers.alpha().unwrap().iter();
        assert!(exact.zip(alpha).all(|(exact, alpha)| (exact - alpha).abs() < 1.0 / 65535.0), "{name}");
    }
    for name in ["a.jpg", "a.bmp"] {
        let message = place.refused(&["render", "ball.toml", "-o", name, "--background", "transparent"]);
        assert!(message.contains("files have no alpha; use png or exr"), "{message}");
        let message = place.refused(&["render", "ball.toml", "-o", name, "--bit-depth", "16"]);
        assert!(message.contains("files have 8; use png, or exr for floats"), "{message}");
    }
    let message = place.refused(&["render", "ball.toml", "-o", "a.png", "--background", "sky"]);
    assert!(message.contains("write transparent, one number, three as red,green,blue, or #rrggbb"), "{message}");
}

#[test]
fn halves_are_half_the_size_and_bytes_are_the_same_for_any_number_of_threads() {
    let place = place();
    let size = |flags: &[&str]| {
        render(&place, "a.exr", &[&["--exr-compression", "none"], flags].concat());
        place.read("a.exr").len()
    };
    let (float, half) = (size(&[]), size(&["--exr-type", "half"]));
    assert_eq!(float - half, 32 * 24 * 3 * 2);
    let written = |threads| {
        render(&place, "a.exr", &["--layers", "l.exr", "--threads", threads]);
        [place.read("a.exr"), place.read("l.exr")]
    };
    assert!(written("1") == written("3"));
}

#[test]
fn a_crop_is_a_part_of_the_whole_also_as_codes() {
    let place = place();
    // An automatic exposure and dithering depend on the whole image.
    for flags in [&["--exposure", "auto"][..], &["--dither", "on", "--background", "transparent"]] {
        let (whole, settings) = render(&place, "whole.png", flags);
        assert_eq!(settings["crop"], Value::Null);
        let (part, settings) = render(&place, "part.png", &[flags, &["--crop", "9,7,14,8"]].concat());
        assert_eq!((&settings["crop"], &settings["size"]), (&json!([9, 7, 14, 8]), &json!([32, 24])));
        let expected = whole.cropped([9, 7], [14, 8]).unwrap();
        assert_eq!((part.width(), part.height()), (14, 8));
        assert_eq!((part.color(), part.alpha()), (expected.color(), expected.alpha()), "{flags:?}");
    }
    let message = place.refused(&["render", "ball.toml", "-o", "a.png", "--size", "32x24", "--crop", "-9,7,24,0"]);
    assert!(message.contains("'-9,7,24,0' for '--crop") && message.contains("the last two at least 1"), "{message}");
    let message = place.refused(&["render", "ball.toml", "-o", "a.png", "--size", "32x24", "--crop", "9,7,70000,8"]);
    assert!(message.contains("9,7,70000,8") && message.contains("32x24") && message.contains("--crop"), "{message}");
}

#[test]
fn overscan_is_around_the_image_also_as_codes() {
    let place = place();
    for flags in [&["--exposure", "auto"][..], &["--dither", "on", "--background", "transparent"]] {
        let (whole, _) = render(&place, "whole.png", flags);
        let (around, settings) = render(&place, "around.png", &[flags, &["--crop", "-3,-2,38,28"]].concat());
        assert_eq!((&settings["crop"], &settings["size"]), (&json!([-3, -2, 38, 28]), &json!([32, 24])));
        assert_eq!((around.width(), around.height()), (38, 28));
        let own = around.with_window([-3, -2], [32, 24]).cropped([0, 0], [32, 24]).unwrap();
        assert_eq!((own.color(), own.alpha()), (whole.color(), whole.alpha()), "{flags:?}");
    }
}

#[test]
fn a_ground_catches_shadows_on_the_background() {
    let place = place();
    let (plain, settings) = render(&place, "a.png", &["--ground", "--background", "0.5"]);
    assert_eq!(settings["background"], json!([0.5, 0.5, 0.5]));
    let corner = plain.pixel(0, 23).unwrap();
    assert_eq!(corner, plain.pixel(31, 23).unwrap());
    assert!(plain.color().iter().any(|color| color[0] == color[2] && color[0] < 0.7 * corner[0]), "a shadow");
    let (clear, _) = render(&place, "b.png", &["--ground", "--background", "transparent"]);
    let alpha = clear.alpha().unwrap();
    assert!(alpha[23 * 32] == 0.0 && alpha.iter().any(|alpha| (0.05..0.95).contains(alpha)));
}

/// The automatic exposure according to the note.
fn noted_stops(said: &str) -> f32 {
    let rest = said.split("exposure auto: using ").nth(1).unwrap_or_else(|| panic!("{said}"));
    rest.split(' ').next().unwrap().parse().unwrap()
}

#[test]
fn an_automatic_exposure_is_that_of_the_model_on_a_ground() {
    let place = place();
    let lamp = |candela: u32| format!("2,4,3;{candela};0.2");
    let render = |candela: u32, flags: &[&str]| {
        let lamp = lamp(candela);
        let base =
            ["render", "bare.toml", "-o", "a.png", "--size", "32x24", "--light", &lamp, "--falloff", "inverse-square"];
        let done = place.good(&[&base, flags].concat());
        (noted_stops(&done.stderr), Frame::load(place.path("a.png")).unwrap())
    };
    place.write("bare.toml", &BALL.replace("background = [0.2, 0.4, 0.8]\n", ""));
    let (stops, dim) = render(40, &["--ground"]);
    // The default background looks the same at any level of light, and so does the model.
    let (other, bright) = render(40_960, &["--ground"]);
    assert!((stops - other - 10.0).abs() < 0.02, "{stops} {other}");
    let near = |a: [f32; 3], b: [f32; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 0.02);
    for (x, y) in [(0, 0), (16, 10), (31, 23)] {
        assert!(near(dim.pixel(x, y).unwrap(), bright.pixel(x, y).unwrap()), "{x} {y}");
    }
    assert!(near(dim.pixel(0, 23).unwrap(), [0.8; 3]), "{:?}", dim.pixel(0, 23));
    // Neither a bright background that is asked for nor none changes the exposure.
    for background in ["0.001", "3000", "transparent"] {
        assert!((render(40, &["--ground", "--background", background]).0 - stops).abs() < 0.02, "{background}");
    }
    let (_, white) = render(40, &["--ground", "--background", "3000"]);
    assert_eq!(white.pixel(0, 23), Some([1.0; 3]));
    // A mirror's second image has the same exposure and background.
    let (mirrored, seen) = render(40, &["--ground", "--bounces", "1"]);
    assert!(mirrored == stops && near(seen.pixel(0, 23).unwrap(), [0.8; 3]));
}

#[test]
fn the_sky_over_a_ground_is_seen_beside_lamps() {
    let place = place();
    let lit = BALL
        .replace("background = [0.2, 0.4, 0.8]\n", "")
        .replace("intensity = 3\n", "intensity = 40\nfalloff = \"inverse-square\"\n");
    place.write("lit.toml", &lit);
    let corners = |flags: &[&str]| {
        let base = ["render", "lit.toml", "-o", "a.png", "--size", "32x24", "--quality", "draft", "--sky", "clear"];
        place.good(&[&base, flags].concat());
        let frame = Frame::load(place.path("a.png")).unwrap();
        [(0, 0), (0, 23)].map(|(x, y)| frame.pixel(x, y).unwrap())
    };
    let [sky, ground] = corners(&["--ground"]);
    assert!(sky[2] > 0.02 && ground[0] > 0.02, "{sky:?} {ground:?}");
    // A background that is asked for takes its place, and does not change the exposure.
    let [red, _] = corners(&["--ground", "--background", "3000,0,0"]);
    assert_eq!((red[0], red[2]), (1.0, 0.0));
}

#[test]
fn the_ground_is_as_bright_at_any_exposure_that_is_set() {
    let place = place();
    place.write("bare.toml", &BALL.replace("background = [0.2, 0.4, 0.8]\n", ""));
    for stops in ["-3", "0", "2.5"] {
        place.good(&["render", "bare.toml", "-o", "a.png", "--size", "32x24", "--ground", "--exposure", stops]);
        let [red, ..] = Frame::load(place.path("a.png")).unwrap().pixel(0, 23).unwrap();
        assert!((red - 0.8).abs() < 0.02, "{stops}: {red}");
    }
}

#[test]
fn what_is_mostly_clipped_or_black_is_told_with_the_flag_that_helps() {
    let place = place();
    let render = |flags: &[&str]| {
        place.good(&[&["render", "ball.toml", "-o", "a.png", "--size", "32x24"], flags].concat()).stderr
    };
    let said = render(&["--exposure", "-3"]);
    assert!(!said.contains("clipped") && !said.contains("is black"), "{said}");
    let said = render(&["--exposure", "6"]);
    assert!(
        said.contains("warning: ") && said.contains("clipped to white") && said.contains("--exposure auto"),
        "{said}"
    );
    let said = render(&["--exposure", "-12", "--background", "0.5"]);
    assert!(said.contains("is black") && said.contains("--ambient"), "{said}");
    // A film says it once.
    let film = ["render", "ball.toml", "-o", "f.#.png", "--size", "32x24", "--turntable", "3", "--exposure", "6"];
    assert_eq!(place.good(&film).stderr.matches("clipped to white").count(), 1);
    // The background does not count. (In so small an image, it is in many pixels with several samples.)
    let said = render(&["--exposure", "-3", "--background", "70", "--aa", "1"]);
    assert!(!said.contains("clipped"), "{said}");
}
