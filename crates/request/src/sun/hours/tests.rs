//! Hours of direct sun where they are known.

use lightmesh_render::{Device, Unobserved};
use lightmesh_scene::{Camera, Scene};

use super::*;
use crate::value::SkySpec;

/// Seen from straight above, 12 units high; a unit is eight pixels.
const PLAN: &str = "[camera]\nposition = [0, 50, 0]\ntarget = [0, 0, 0]\nup = [0, 0, -1]\nprojection = \"orthographic\"\nheight = 12\n\
                    [[plane]]\nname = \"ground, flat\"\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\nsize = [40, 40]\n";
/// Two units wide and deep, three high.
const BOX: &str = "[[box]]\nname = \"house\"\ncenter = [0, 1.5, 0]\nsize = [2, 3, 2]\n";
const SIZE: [u32; 2] = [96, 96];
const HALF: Vec3 = Vec3::new(1.0, 1.5, 1.0);

fn study(text: &str) -> SunStudy {
    SunStudy::of(text.parse().unwrap(), SkySpec::clear(), Vec::new())
}

fn hours_of(scene: &str, study: &SunStudy) -> SunHours {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, scene).unwrap();
    let scene = Scene::open(&path).unwrap();
    let renderer = Renderer::new(Device::Cpu).unwrap();
    let settings = Settings::default().with_size(SIZE);
    let prepared = renderer.prepare(&scene, &settings, &Unobserved).unwrap();
    SunHours::of(&renderer, &prepared, (&settings, study), &suns(study, Up::Y).unwrap(), &Unobserved).unwrap()
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
    let (found, suns) = (hours_of(&format!("{PLAN}{BOX}"), &study), suns(&study, Up::Y).unwrap());
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
            let lightmesh_scene::LightKind::Directional { direction, angle } = sun.kind else { panic!() };
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
    assert_eq!(house[2..], [10.0, 10.0, 10.0, 1.0]);
    let sum: f64 = found.hours.iter().map(|&hours| f64::from(hours)).sum();
    let by_object = ground[0] * ground[2] + house[0] * house[2];
    assert!((sum - by_object).abs() < 1e-3 * sum, "{sum} {by_object}");
    assert!(ground[3] < 1.0 && ground[4] == 10.0 && (0.9..1.0).contains(&ground[5]), "{table}");
}

#[test]
fn a_polar_night_has_no_hours_and_a_polar_day_all() {
    let night = study("78,15,2026-12-21+01:00,00:00-24:00/1h");
    assert!(night.moments.is_empty() && night.left_out(crate::words::Words::Flags).unwrap().contains("25 moments"));
    let found = hours_of(&format!("{PLAN}{BOX}"), &night);
    assert!(found.hours().iter().all(|&hours| hours == 0.0) && found.mask().iter().all(|&sees| sees));
    let table = found.table();
    assert!(table.contains("\nhouse,256,4.000000,0.0,0.0,0.0,0.0000\n"), "{table}");
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
        table.contains("\n'=cellar,0,0,,,,\n") && table.contains("\nhouse,256,4.000000,1.0,1.0,1.0,0.0000\n"),
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
