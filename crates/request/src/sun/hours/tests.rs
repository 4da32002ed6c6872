//! Hours of direct sun where they are known.

use lightmesh_render::{Device, Unobserved};
use lightmesh_scene::{Bounds, Camera, LightKind, Scene, SunPosition, Up};

use super::*;
use crate::value::SkySpec;

/// Seen from straight above, 12 units high; a unit is eight pixels.
const PLAN: &str = "[camera]\nposition = [0, 50, 0]\ntarget = [0, 0, 0]\nup = [0, 0, -1]\nprojection = \"orthographic\"\nheight = 12\n\
                    [[plane]]\nname = \"ground, flat\"\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\nsize = [40, 40]\n";
/// Two units wide and deep, three high.
const BOX: &str = "[[box]]\nname = \"house\"\ncenter = [0, 1.5, 0]\nsize = [2, 3, 2]\n";
const SIZE: [u32; 2] = [96, 96];
/// Discs do not depend on the scene.
const NOWHERE: Bounds = Bounds { min: Vec3::ZERO, max: Vec3::ZERO };
const HALF: Vec3 = Vec3::new(1.0, 1.5, 1.0);

fn study(text: &str) -> SunStudy {
    SunStudy::of(text.parse().unwrap(), SkySpec::clear(), Vec::new())
}

fn hours_of(scene: &str, study: &SunStudy) -> SunHours {
    hours_of_size(scene, study, SIZE)
}

fn hours_of_size(scene: &str, study: &SunStudy, size: [u32; 2]) -> SunHours {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, scene).unwrap();
    let scene = Scene::open(&path).unwrap();
    let renderer = Renderer::new(Device::Cpu).unwrap();
    let settings = Settings::default().with_size(size);
    let prepared = renderer.prepare(&scene, &settings, &Unobserved).unwrap();
    let suns = suns(study, Up::Y, prepared.geometry.bounds).unwrap();
    SunHours::of(&renderer, &prepared, (&settings, study, true), &suns, &Unobserved).unwrap()
}

/// Whether a ray from a point meets the box.
fn meets_box(from: Vec3, way: Vec3) -> bool {
    let middle = Vec3::new(0.0, HALF.y, 0.0);
    let [a, b] = [-HALF, HALF].map(|corner| (middle + corner - from) / way);
    let (near, far) = (a.min(b).max_element(), a.max(b).min_element());
    far > near.max(0.0)
}

#[test]
fn an_open_field_has_the_sun_of_the_whole_day() {
    for hours in ["00:00-24:00/15m", "08:00-16:00/1h", "09:10-15:20/25m"] {
        let study = study(&format!("0,0,2026-03-20Z,{hours}"));
        let found = hours_of(PLAN, &study);
        let expected = study.hours() as f32;
        assert!(
            found.hours.iter().all(|found| (found - expected).abs() < 1e-3),
            "{hours}: {expected}, {:?}",
            found.hours[0]
        );
    }
}

#[test]
fn the_shadow_of_a_box_is_that_of_its_edges() {
    let study = study("48,0,2026-04-20Z,07:00-17:00/30m");
    let (found, suns) = (hours_of(&format!("{PLAN}{BOX}"), &study), suns(&study, Up::Y, NOWHERE).unwrap());
    let (layers, mut uncertain, mut shaded) = (found.layers(), 0.0, 0);
    for (pixel, &hours) in found.hours.iter().enumerate() {
        let point = Vec3::from_array(layers.position[pixel]);
        if point.y > 0.1 {
            // The roof has sun all day.
            assert!((hours - 10.0).abs() < 1e-3, "{point}: {hours}");
            continue;
        }
        // The rim of the sun, and a little more: where all of it agrees, there is all of the light or none.
        let (mut least, mut most) = (0.0, 0.0);
        for (sun, time) in &suns {
            let LightKind::Directional { direction, angle } = sun.kind else { panic!() };
            let (right, above) = direction.any_orthonormal_pair();
            let rim = |number: u8| {
                let (sin, cos) = (f32::from(number) * std::f32::consts::TAU / 16.0).sin_cos();
                -direction + 0.55 * angle * (cos * right + sin * above)
            };
            let hidden = (0..16).filter(|&number| meets_box(point + 1e-4 * Vec3::Y, rim(number))).count();
            least += if hidden == 0 { *time } else { 0.0 };
            most += if hidden < 16 { *time } else { 0.0 };
        }
        assert!(
            f64::from(hours) > least - 1e-3 && f64::from(hours) < most + 1e-3,
            "{point}: {hours}, {least} to {most}"
        );
        uncertain += most - least;
        shaded += usize::from(hours < 9.5);
    }
    // Penumbras are thinner than pixels here.
    let mean = uncertain / found.hours.len() as f64;
    assert!(mean < 0.1 && shaded > 1000, "{mean} {shaded}");
}

#[test]
fn no_sun_is_not_no_surface() {
    let small = PLAN.replace("size = [40, 40]", "size = [6, 6]");
    let found = hours_of(&format!("{small}{BOX}"), &study("48,0,2026-04-20Z,12:00-13:00/30m"));
    let pixels = found.hours().iter().zip(found.mask());
    // A quarter of the picture is the ground.
    assert_eq!(found.mask().iter().filter(|&&sees| sees).count(), 48 * 48);
    assert!(pixels.clone().all(|(&hours, &sees)| sees || hours == 0.0));
    assert!(pixels.clone().any(|(&hours, &sees)| sees && hours == 0.0));
    let alpha: Vec<f32> = found.mask().iter().map(|&sees| f32::from(u8::from(sees))).collect();
    assert_eq!(found.alpha(), alpha);
}

#[test]
fn bytes_are_those_of_files() {
    let (folder, found) = (tempfile::tempdir().unwrap(), hours_of(PLAN, &study("48,0,2026-04-20Z,12:00-13:00/30m")));
    for &format in HoursFormat::ALL {
        let path = folder.path().join("file").with_extension(format.name());
        found.save(&path).unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), found.encode(format).unwrap(), "{format}");
        found.save_as(&folder.path().join("other"), Some(format)).unwrap();
        assert_eq!(std::fs::read(folder.path().join("other")).unwrap(), found.encode(format).unwrap(), "{format}");
    }
}

#[test]
fn the_table_sums_what_is_seen() {
    let found = hours_of(&format!("{PLAN}{BOX}"), &study("48,0,2026-04-20Z,07:00-17:00/25m"));
    let table = table::table(&found);
    let mut lines = table.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    assert_eq!(header[0..3], ["object", "pixels", "visible_area"]);
    let rows: Vec<(&str, Vec<f64>)> = lines
        .map(|line| {
            let (name, numbers) = line.rsplit_once(|letter: char| letter.is_alphabetic() || letter == '"').unwrap();
            (name, numbers.trim_start_matches(',').split(',').map(|number| number.parse().unwrap()).collect())
        })
        .collect();
    assert!(table.contains("\n\"ground, flat\",") && table.contains("\nhouse,"), "{table}");
    let [(_, house), (_, ground)] = &rows[..] else { panic!("{table}") };
    // A pixel is an eighth wide: the roof has 16 × 16 of them.
    assert_eq!([house[0], ground[0]], [256.0, 96.0 * 96.0 - 256.0]);
    assert!((house[1] - 4.0).abs() < 1e-4 && (ground[1] - 140.0).abs() < 1e-3, "{table}");
    assert_eq!(house[2..], [10.0, 10.0, 10.0, 1.0, 256.0]);
    let sum: f64 = found.hours.iter().map(|&hours| f64::from(hours)).sum();
    let by_object = ground[0] * ground[2] + house[0] * house[2];
    assert!((sum - by_object).abs() < 1e-3 * sum, "{sum} {by_object}");
    assert!(ground[3] < 1.0 && ground[4] == 10.0 && (0.9..1.0).contains(&ground[5]), "{table}");
}

#[test]
fn a_polar_night_has_no_hours_and_a_polar_day_all() {
    let night = study("78,15,2026-12-21+01:00,00:00-24:00/1h");
    assert!(
        night.moments.is_empty() && night.left_out(true, crate::words::Words::Flags).unwrap().contains("25 moments")
    );
    let found = hours_of(&format!("{PLAN}{BOX}"), &night);
    assert!(found.hours().iter().all(|&hours| hours == 0.0) && found.mask().iter().all(|&sees| sees));
    let table = found.table();
    assert!(table.contains("\nhouse,256,4.000000,0.0,0.0,0.0,0.0000,256\n"), "{table}");
    for &format in HoursFormat::ALL {
        found.encode(format).unwrap_or_else(|error| panic!("{format}: {error}"));
    }
    let day = hours_of(PLAN, &study("78,15,2026-06-21+01:00,00:00-24:00/1h"));
    assert!(day.hours().iter().all(|hours| (hours - 24.0).abs() < 1e-3), "{:?}", day.hours()[0]);
}

#[test]
fn objects_that_no_pixel_sees_are_in_the_table() {
    let hidden = "[[box]]\nname = \"=cellar\"\ncenter = [0, -2, 0]\nsize = [1, 1, 1]\n";
    let found = hours_of(&format!("{PLAN}{hidden}{BOX}"), &study("48,0,2026-04-20Z,12:00-13:00/30m"));
    assert_eq!(table::unseen(&found), (1, 3));
    let table = found.table();
    assert!(
        table.contains("\n'=cellar,0,0,,,,,0\n") && table.contains("\nhouse,256,4.000000,1.0,1.0,1.0,0.0000,256\n"),
        "{table}"
    );
}

#[test]
fn what_leans_shows_more_of_itself() {
    use pixel_area::PixelGrid;

    let camera = Camera::look_at(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 90.0).unwrap();
    let grid = PixelGrid::new(&camera, [64, 64]);
    // A wall at distance 3 is 6 units wide in the image.
    let places = || (0..64 * 64).map(|pixel| [pixel % 64, pixel / 64]);
    for shift in [[0.0, 0.0], [0.5, -0.25]] {
        let grid = PixelGrid::new(&camera.clone().with_shift(shift), [64, 64]);
        let wall = |place: [i32; 2]| {
            let [x, y] = place.map(|side| (side as f32 - 31.5) / 32.0);
            let (x, y) = (x + 2.0 * shift[0], 2.0 * shift[1] - y);
            grid.area(place, 3.0 * (1.0 + x * x + y * y).sqrt(), Vec3::Z)
        };
        let area: f32 = places().map(wall).sum();
        assert!((area - 36.0).abs() < 0.05, "{area}");
    }
    let leaning = grid.area([31, 31], 3.0, Vec3::new(0.0, 0.6, 0.8));
    assert!((leaning / grid.area([31, 31], 3.0, Vec3::Z) - 1.25).abs() < 0.02);
}

/// Hours of the pixels of the ground, under `above`.
fn ground_under(above: &str, glass: Glass) -> Vec<f32> {
    let study = SunStudy { glass, ..study("48,0,2026-04-20Z,08:00-16:00/1h") };
    let found = hours_of(&format!("{PLAN}{above}"), &study);
    let positions = found.layers().position.iter();
    found.hours.iter().zip(positions).filter(|(_, position)| position[1] < 0.01).map(|(&hours, _)| hours).collect()
}

#[test]
fn glass_is_open_unless_it_is_closed_or_tinted() {
    let pane = |material: &str| {
        format!(
            "[[material]]\nname = \"m\"\n{material}\n[[plane]]\npoint = [0, 4, 0]\nnormal = [0, 1, 0]\nsize = [2, 2]\nmaterial = \"m\"\n"
        )
    };
    let body = |material: &str| format!("[[material]]\nname = \"m\"\n{material}\n{BOX}material = \"m\"\n");
    let wall = "kd = [0.5, 0.5, 0.5]";
    for (form, glass) in [
        (&pane as &dyn Fn(&str) -> String, "ior = 1.5\nthin = true\nfilter = [0.5, 0.5, 0.5]"),
        (&pane, "kd = [0.5, 0.5, 0.5]\nopacity = 0.3"),
        (&body, "ior = 1.5\nabsorption = [1, 1, 1]"),
    ] {
        let of = |kind| ground_under(&form(glass), kind);
        let (open, closed, tinted) = (of(Glass::Open), of(Glass::Closed), of(Glass::Tinted));
        // Nothing hides the sun, or what a wall hides.
        assert!(open.iter().all(|hours| (hours - 8.0).abs() < 1e-3), "{glass}: {open:?}");
        assert_eq!(closed, ground_under(&form(wall), Glass::Open), "{glass}");
        let [open, closed, tinted] = [open, closed, tinted].map(|hours| hours.iter().sum::<f32>());
        assert!(
            closed < 0.99 * open && closed + 1.0 < tinted && tinted + 1.0 < open,
            "{glass}: {closed} {tinted} {open}"
        );
    }
    // What is at least half opaque stays a wall.
    let curtain = pane("kd = [0.5, 0.5, 0.5]\nopacity = 0.7");
    assert_eq!(ground_under(&curtain, Glass::Open), ground_under(&pane(wall), Glass::Open));
}

#[test]
fn hours_without_a_step_are_those_of_all_times() {
    let study = study("48,0,2026-04-20Z,07:00-17:00");
    let found = hours_of(&format!("{PLAN}{BOX}"), &study);
    // The middle of the sun, every 20 seconds: where its disc has a size, the error of that is as often on either side.
    let each = 1.0 / 180.0;
    let ways: Vec<Vec3> = (0..1800)
        .map(|number| {
            let minute = 7.0 * 60.0 + 60.0 * each * (f64::from(number) + 0.5);
            let place = SunPosition::of(48.0, 0.0, &study.spec.moment(minute)).unwrap();
            let LightKind::Directional { direction, .. } = place.light(Up::Y, 0.0).unwrap().kind else { panic!() };
            -direction
        })
        .collect();
    let (mut error, mut count, layers) = (0.0, 0, found.layers());
    for (pixel, &hours) in found.hours.iter().enumerate() {
        let point = Vec3::from_array(layers.position[pixel]);
        if point.y < 0.1 {
            let lit = ways.iter().filter(|&&way| !meets_box(point + 1e-4 * Vec3::Y, way)).count();
            error += (lit as f64 * each - f64::from(hours)).abs();
            count += 1;
        }
    }
    let mean = error / f64::from(count);
    assert!(mean < 0.004, "{mean} h");
    assert!(found.table().contains("\nhouse,256,4.000000,10.00,10.00,10.00,"), "{}", found.table());
}

#[test]
fn objects_of_few_pixels_are_seen_by_more_points() {
    // Beside the house, half of it in its shadow at some time: two pixels wide, and half of one.
    let small = "[[box]]\nname = \"sill\"\ncenter = [-1.2, 0.5, 0.4]\nsize = [0.25, 0.02, 0.25]\n\
                 [[box]]\nname = \"post\"\ncenter = [-1.6, 0.5, 0.06]\nsize = [0.13, 1, 0.13]\n";
    let scene = format!("{PLAN}{BOX}{small}");
    let study = study("48,0,2026-04-20Z,07:00-17:00/30m");
    let row = |found: &SunHours, name: &str| -> Vec<f64> {
        let table = found.table();
        let line = table.lines().find(|line| line.starts_with(&format!("{name},"))).unwrap().to_owned();
        line.split(',').skip(1).map(|number| number.parse().unwrap()).collect()
    };
    let (coarse, fine) = (hours_of(&scene, &study), hours_of_size(&scene, &study, SIZE.map(|side| 8 * side)));
    for name in ["sill", "post"] {
        let (few, many) = (row(&coarse, name), row(&fine, name));
        assert!(few[0] < 10.0 && few[6] >= 16.0 && many[0] >= 64.0 && many[6] == many[0], "{name}: {few:?} {many:?}");
        assert!((few[1] / many[1] - 1.0).abs() < 0.2, "{name}: {few:?} {many:?}");
        assert!((few[2] - many[2]).abs() < 0.11, "{name}: {few:?} {many:?}");
    }
    assert_eq!((table::short(&coarse), table::short(&fine)), (0, 0));
    // The image, and rows of many pixels, are what they are.
    assert_eq!(row(&coarse, "house"), [256.0, 4.0, 10.0, 10.0, 10.0, 1.0, 256.0]);
    let whole: f64 = ["house", "sill", "post"].iter().map(|name| row(&coarse, name)[0]).sum();
    assert!(whole < 280.0);
}

#[test]
fn objects_of_too_few_points_are_told() {
    // A wire of which an eighth of a pixel is seen.
    let wire = "[[box]]\nname = \"wire\"\ncenter = [-1.0625, 4, 1.0625]\nsize = [0.02, 0.02, 0.02]\n";
    let found = hours_of(&format!("{PLAN}{wire}"), &study("48,0,2026-04-20Z,12:00-13:00/30m"));
    assert_eq!(table::short(&found), 1, "{}", found.table());
    let text = found.short(Words::Flags).unwrap();
    assert!(text.contains("hours of 1 object rest on fewer than 16 points") && text.contains("--size"), "{text}");
}

#[test]
fn the_caption_says_how_glass_counts() {
    let of = |glass| {
        let study = SunStudy { glass, ..study("48,0,2026-04-20Z,12:00-13:00") };
        picture::caption(&study, Some(glass))
    };
    assert!(of(Glass::Open).contains(" Glass is open. It hides no sun; "), "{}", of(Glass::Open));
    assert!(of(Glass::Closed).contains(" Glass is closed. It hides the sun as a wall does. "), "{}", of(Glass::Closed));
    assert!(of(Glass::Tinted).contains(" Glass is tinted. Behind it counts the share "), "{}", of(Glass::Tinted));
    assert!(!picture::caption(&study("48,0,2026-04-20Z,12:00-13:00"), None).contains("Glass"));
}

#[test]
fn messages_speak_of_moments_only_where_there_are_some() {
    let with = study("0,0,2026-03-20Z,00:00-24:00/3h");
    let without = study("0,0,2026-03-20Z,00:00-24:00");
    assert_eq!(with.suns(), "4 moments 180 min apart");
    assert_eq!(without.suns(), "all the time from 00:00 to 24:00 by 48 parts of the sun's way");
    let left_out = |study: &SunStudy, has_frames| study.left_out(has_frames, Words::Flags).unwrap();
    assert!(left_out(&with, false).contains("5 moments are left out, from 00:00 to 24:00"));
    assert!(left_out(&without, true).contains("49 moments are left out"));
    assert!(left_out(&without, false).starts_with("--sun: 11.9 of 24.0 hours have no direct sun: "));
}
