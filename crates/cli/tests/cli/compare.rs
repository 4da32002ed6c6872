//! `lightmesh compare`.

use lightmesh::image::Frame;
use serde_json::Value;

use crate::run::Place;

fn pictures() -> Place {
    let place = Place::new();
    for (name, value) in [("dark.png", 0.2), ("light.png", 0.4)] {
        Frame::new(16, 16, vec![[value; 3]; 256]).unwrap().save(place.path(name)).unwrap();
    }
    Frame::new(8, 8, vec![[0.0; 3]; 64]).unwrap().save(place.path("small.png")).unwrap();
    place
}

#[test]
fn equal_pictures_pass_every_bound() {
    let place = pictures();
    let done = place.good(&["compare", "dark.png", "dark.png", "--max-flip", "0", "--max-rmse", "0"]);
    assert_eq!(
        done.stdout,
        "RMSE            0.000000\nPSNR            inf dB\nmax difference  0.000000\nmean FLIP       0.000000\n"
    );
    assert_eq!(done.stderr, "");
}

#[test]
fn a_bound_that_is_exceeded_is_exit_code_1() {
    let place = pictures();
    let compare = |flags: &[&str]| place.run(&[&["compare", "dark.png", "light.png"], flags].concat());
    assert_eq!(compare(&[]).code, Some(0));
    assert_eq!(compare(&["--max-flip", "1", "--max-rmse", "1"]).code, Some(0));
    let rmse = compare(&["--max-rmse", "0.01"]);
    assert_eq!(rmse.code, Some(1));
    assert!(rmse.stderr.starts_with("RMSE 0.1") && rmse.stderr.ends_with("exceeds --max-rmse 0.01\n"), "{rmse:?}");
    assert!(rmse.stdout.contains("mean FLIP"), "{rmse:?}");
    assert_eq!(compare(&["--max-flip", "0.01"]).code, Some(1));
}

#[test]
fn programs_read_json_and_people_see_where() {
    let place = pictures();
    let done = place.good(&["compare", "dark.png", "light.png", "--json", "--diff", "diff.png"]);
    let json: Value = serde_json::from_str(&done.stdout).unwrap();
    for key in ["rmse", "psnr", "max_difference", "mean_flip"] {
        assert!(json[key].as_f64().unwrap() > 0.0, "{json}");
    }
    assert_eq!(Frame::load(place.path("diff.png")).unwrap().width(), 16);
}

#[test]
fn what_cannot_be_compared_is_refused() {
    let place = pictures();
    let refused = |args: &[&str]| place.refused(&[&["compare"], args].concat());
    assert!(refused(&["dark.png", "small.png"]).contains("16x16 pixels with one of 8x8"));
    assert!(refused(&["none.png", "dark.png"]).contains("cannot read none.png"));
    assert!(refused(&["room.toml", "dark.png"]).contains("cannot load room.toml: not an image in a known format"));
    assert!(
        refused(&["dark.png", "light.png", "--max-flip", "-1"]).contains("the threshold must be 0 or more, but is -1")
    );
    assert!(refused(&["dark.png", "light.png", "--diff", "no/d.png"]).contains("does not exist"));
    assert!(refused(&["dark.png", "light.png", "--diff", "light.png"]).contains("B and --diff are the same file"));
}

/// An image, and the same with what is around it.
#[test]
fn parts_of_images_are_told_from_images_of_other_sizes() {
    let place = Place::new();
    let render = ["render", "room.toml", "--size", "32x24", "--quality", "draft", "-o"];
    place.good(&[&render[..], &["whole.exr"]].concat());
    place.good(&[&render[..], &["around.exr", "--crop=-4,-3,40,30"]].concat());
    let message = place.refused(&["compare", "around.exr", "whole.exr"]);
    let expected = "cannot compare the 40x30 pixels from column -4, row -3 on of an image of 32x24 with a whole image of 32x24 pixels: render both \
                    with the same crop, or both without";
    assert!(message.contains(expected) && message.contains("(lightmesh render --crop X,Y,W,H)"), "{message}");
}

#[test]
fn a_difference_is_asked_for_by_its_own_flag() {
    let place = pictures();
    for flags in [&["-o", "d.png"][..], &["--output", "d.png"], &["-od.png"]] {
        let done = place.run(&[&["compare", "dark.png", "light.png"], flags].concat());
        assert!(done.code == Some(2) && done.stderr.contains("'--diff'"), "{done:?}");
        assert!(!place.path("d.png").exists());
    }
    assert!(!place.good(&["compare", "--help"]).stdout.contains("--output"));
}

/// Two EXR files of light that a screen shows white.
#[test]
fn light_in_exr_files_has_no_limit() {
    let place = pictures();
    for (name, value) in [("two.exr", 2.0), ("four.exr", 4.0)] {
        Frame::new(16, 16, vec![[value; 3]; 256]).unwrap().save(place.path(name)).unwrap();
    }
    let done = place.good(&["compare", "two.exr", "four.exr"]);
    assert!(done.stdout.contains("mean FLIP       0.000000\nrelative RMSE   1.000000 (linear values)\n"), "{done:?}");
    assert!(done.stdout.ends_with("max difference  2.000000 (linear values)\nmean HDR-FLIP   0.144816\n"), "{done:?}");
    for (bound, message) in
        [("--max-flip", "mean HDR-FLIP 0.144816 exceeds --max-flip 0.1"), ("--max-rmse", "relative RMSE 1.0")]
    {
        let exceeded = place.run(&["compare", "two.exr", "four.exr", bound, "0.1"]);
        assert_eq!(exceeded.code, Some(1));
        assert!(exceeded.stderr.contains(message), "{exceeded:?}");
    }
    let json: Value = serde_json::from_str(&place.good(&["compare", "two.exr", "four.exr", "--json"]).stdout).unwrap();
    assert_eq!(
        (&json["rmse"], &json["relative_rmse"], &json["max_linear_difference"]),
        (&0.0.into(), &1.0.into(), &2.0.into())
    );
    // With an 8-bit file, what is displayed counts.
    let mixed: Value =
        serde_json::from_str(&place.good(&["compare", "two.exr", "light.png", "--json"]).stdout).unwrap();
    assert!(mixed.get("relative_rmse").is_none(), "{mixed}");
}
