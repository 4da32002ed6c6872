mod sky;
mod sun_position;

use std::f32::consts::PI;

use glam::Vec3;
use lightmesh_memory::Budget;
use lightmesh_scene::internals::environment::{decode, from_angles};
use lightmesh_scene::{Environment, EnvironmentError, LightKind, Sky, SkyKind, SunPosition, Surroundings, Up};

fn near(a: Vec3, b: Vec3) -> bool {
    (a - b).abs().max_element() < 1e-5
}

fn black(size: [u32; 2]) -> Vec<[f32; 3]> {
    vec![[0.0; 3]; (size[0] * size[1]) as usize]
}

#[test]
fn the_middle_is_north_and_east_is_to_its_right() {
    let map = |up| Environment::new("", [4, 2], black([4, 2]), up);
    assert!(near(from_angles(map(Up::Y).frame(), 0.0, 0.0), Vec3::NEG_Z));
    assert!(near(from_angles(map(Up::Y).frame(), 0.5 * PI, 0.0), Vec3::X));
    assert!(near(from_angles(map(Up::Z).frame(), 0.0, 0.0), Vec3::Y));
    assert!(near(from_angles(map(Up::Z).frame(), PI, 0.0), Vec3::NEG_Y));
    let half = 0.5f32.sqrt();
    // The third of four columns begins in the north.
    assert!(near(map(Up::Y).direction(2, 0), Vec3::new(0.5, half, -0.5)), "{}", map(Up::Y).direction(2, 0));
    assert!(near(map(Up::Z).direction(1, 1), Vec3::new(-0.5, 0.5, -half)));
    for up in [Up::Y, Up::Z] {
        let map = Environment::new("", [16, 8], black([16, 8]), up).turned(33.0);
        let [east, upward, north] = map.frame();
        assert!(near(north.cross(upward), east), "not mirrored");
        for (column, row) in (0..8).flat_map(|row| (0..16).map(move |column| (column, row))) {
            assert_eq!(map.texel(map.direction(column, row)), [column, row]);
        }
    }
}

#[test]
fn it_turns_clockwise() {
    let map = Environment::new("", [4, 2], black([4, 2]), Up::Y).turned(90.0);
    assert!(near(from_angles(map.frame(), 0.0, 0.0), Vec3::X), "what was in the north is in the east");
}

#[test]
fn integrals_are_those_of_a_sphere() {
    let white = Environment::new("", [64, 32], vec![[1.0; 3]; 64 * 32], Up::Z);
    assert!(near(white.mean(), Vec3::ONE), "{}", white.mean());
    for normal in [Vec3::X, Vec3::Z, Vec3::splat(1.0).normalize()] {
        assert!((white.irradiance(normal) / PI - 1.0).abs().max_element() < 2e-3, "{normal}");
    }
    let [constant, rest @ ..] = white.irradiance_terms();
    assert!((constant - 1.0).abs().max_element() < 1e-3 && rest.iter().all(|term| term.abs().max_element() < 1e-3));
    let levels = white.levels();
    assert_eq!(levels.last().unwrap().size, [1, 1]);
    assert!(levels.iter().flat_map(|level| &level.texels).all(|texel| (texel[0] - 1.0).abs() < 1e-6));
}

#[test]
fn levels_keep_the_mean_of_all_directions() {
    for size in [[64, 32], [33, 17], [1, 8], [5, 1]] {
        let texels =
            (0..size[0] * size[1]).map(|index| [(index % 7) as f32, (index % 3) as f32, index as f32]).collect();
        let map = Environment::new("", size, texels, Up::Y);
        let last = map.levels().last().unwrap();
        assert_eq!(last.size, [1, 1]);
        if size == [64, 32] {
            assert!((Vec3::from_array(last.texels[0]) / map.mean() - 1.0).abs().max_element() < 1e-4, "{size:?}");
        }
    }
}

#[test]
fn a_sun_in_an_image_becomes_a_disc_with_its_light() {
    let size = [512, 256];
    let mut texels = vec![[0.5, 0.6, 0.8]; 512 * 256];
    let map = Environment::new("", size, texels.clone(), Up::Y);
    assert_eq!(map.clone().find_sun(), map, "no sun");
    // Two by two texels, 40 degrees above the horizon.
    let [left, top] = [300, 70];
    for (column, row) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
        texels[(top + row) * 512 + left + column] = [20_000.0, 18_000.0, 15_000.0];
    }
    let whole = Environment::new("", size, texels, Up::Y);
    let toward = whole.direction(300, 70);
    let found = whole.clone().find_sun();
    let sun = *found.sun().unwrap();
    assert!(sun.direction.dot(toward) > 0.9999, "{}", sun.direction);
    assert!(near(found.mean(), Vec3::new(0.5, 0.6, 0.8)));
    // Nothing is lost and nothing is counted twice.
    let before = whole.irradiance(sun.direction);
    let after = found.irradiance(sun.direction) + sun.irradiance();
    assert!((after / before - 1.0).abs().max_element() < 1e-3, "{after}, not {before}");
    let light = sun.light().unwrap();
    assert!(near(light.intensity * PI / sun.irradiance(), Vec3::ONE));
    let LightKind::Directional { direction, angle } = light.kind else { panic!("{light:?}") };
    assert!(near(direction, -sun.direction));
    assert!((0.5..3.0).contains(&angle.to_degrees()), "{}", angle.to_degrees());
    // A lamp in a room is not a sun: it does not light more than the room does.
    let mut texels = vec![[0.5; 3]; 512 * 256];
    texels[256 * 40 + 9] = [60.0; 3];
    assert_eq!(Environment::new("", size, texels, Up::Y).find_sun().sun(), None);
}

/// A dark panorama with a bright box, given by columns and rows, and what it sends in all.
fn with_box(columns: std::ops::Range<u32>, rows: std::ops::Range<u32>) -> Environment {
    let texel = |index: u32| {
        let is_bright = columns.contains(&(index % 256)) && rows.contains(&(index / 256));
        if is_bright { [12.0, 11.0, 9.0] } else { [0.05; 3] }
    };
    Environment::new("", [256, 128], (0..256 * 128).map(texel).collect(), Up::Y)
}

#[test]
fn bright_regions_of_an_image_become_discs_with_their_light() {
    // A box, and one across the image's ends.
    for (columns, rows) in [(70..120, 30..55), (0..12, 50..60)] {
        let whole = with_box(columns, rows);
        let found = whole.clone().find_lights();
        assert_eq!(found.texels(), whole.texels(), "it is seen as it is");
        let discs = found.discs();
        assert!((2..=8).contains(&discs.len()), "{}", discs.len());
        // Nothing is lost and nothing is counted twice.
        let sent: Vec3 = discs.iter().map(|disc| disc.irradiance()).sum();
        let (before, after) = (4.0 * PI * whole.mean(), 4.0 * PI * found.gathered().mean() + sent);
        assert!((after / before - 1.0).abs().max_element() < 1e-3, "{after}, not {before}");
        assert!(near(found.gathered().mean() / 0.05, Vec3::ONE), "the rest is even");
        // They are where it is: a surface that faces the box receives the same.
        let Surroundings { environment, discs: lights, sun } = found.into();
        assert_eq!((lights.len(), sun), (environment.discs().len(), None));
        let middle = environment.discs()[0].direction;
        let received = |light: &lightmesh_scene::Light| {
            let LightKind::Directional { direction, .. } = light.kind else { panic!("{light:?}") };
            PI * middle.dot(-direction).max(0.0) * light.intensity
        };
        let lit: Vec3 = lights.iter().map(received).sum::<Vec3>() + environment.gathered().irradiance(middle);
        assert!((lit / whole.irradiance(middle) - 1.0).abs().max_element() < 0.01, "{lit}");
    }
    let even = with_box(0..0, 0..0);
    assert_eq!(even.clone().find_lights(), even);
    // A lamp that gives less than a hundredth of all light.
    let mut texels = vec![[0.5; 3]; 256 * 128];
    texels[256 * 40 + 9] = [60.0; 3];
    assert_eq!(Environment::new("", [256, 128], texels, Up::Y).find_lights().discs(), []);
}

#[test]
fn lights_of_an_image_turn_and_grow_with_it() {
    let first = with_box(70..120, 30..55).find_lights();
    let turned = first.clone().turned(90.0).scaled(2.0);
    assert!(near(turned.mean(), 2.0 * first.mean()));
    assert_eq!(turned.discs().len(), first.discs().len());
    for (disc, before) in turned.discs().iter().zip(first.discs()) {
        // Clockwise: what was in the north is in the east.
        let Vec3 { x, y, z } = before.direction;
        assert!(near(disc.direction, Vec3::new(-z, y, x)), "{disc:?}, {before:?}");
        assert_eq!(disc.radiance, 2.0 * before.radiance);
    }
}

#[test]
fn a_clear_sky_is_bright_around_its_sun_and_blue_on_the_other_side() {
    let sky = |up| {
        Sky { north: 30.0, ..Sky::clear(SunPosition { elevation: 35.0, azimuth: 120.0 }) }.surroundings(up).unwrap()
    };
    let Surroundings { environment, sun, .. } = sky(Up::Y);
    let disc = environment.sun().unwrap();
    let (azimuth, elevation) = (150.0f32.to_radians(), 35.0f32.to_radians());
    let expected = Vec3::new(azimuth.sin() * elevation.cos(), elevation.sin(), -azimuth.cos() * elevation.cos());
    assert!(near(disc.direction, expected), "{}, not {expected}", disc.direction);
    let light = sun.unwrap();
    assert!(matches!(light.kind, LightKind::Directional { direction, .. } if near(direction, -expected)));
    let at = |direction: Vec3| {
        let [column, row] = environment.texel(direction);
        Vec3::from_array(environment.texels()[(row * environment.size()[0] + column) as usize])
    };
    let (near_sun, opposite) = (at(expected), at(Vec3::new(-expected.x, expected.y, -expected.z)));
    assert!(near_sun.y > 3.0 * opposite.y, "{near_sun} {opposite}");
    assert!(opposite.z > 1.3 * opposite.x, "{opposite}");
    // White that faces the sun shows 1, and the sun is most of it.
    let luminance = Vec3::new(0.2126, 0.7152, 0.0722);
    let shown = (disc.irradiance() + environment.irradiance(Vec3::Y)).dot(luminance) / PI;
    assert!((shown - 1.0).abs() < 1e-3, "{shown}");
    assert!((0.6..0.95).contains(&light.intensity.dot(luminance)), "{}", light.intensity);
    // Nine terms are enough for its irradiance.
    let terms = environment.irradiance_terms();
    for n in [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z, Vec3::new(0.48, 0.6, 0.64)] {
        let powers = [1.0, n.x, n.y, n.z, n.x * n.y, n.y * n.z, n.z * n.x, n.z * n.z, n.x * n.x - n.y * n.y];
        let found: Vec3 = powers.into_iter().zip(terms).map(|(power, term)| power * term).sum();
        let expected = environment.irradiance(n) / PI;
        assert!((found - expected).abs().max_element() < 0.03 * expected.max_element(), "{n}: {found}, not {expected}");
    }
    // The other axis is another frame for the same.
    let turned = sky(Up::Z).environment;
    let expected = Vec3::new(expected.x, -expected.z, expected.y);
    assert!(near(turned.sun().unwrap().direction, expected));
    let same = |(a, b): (&[f32; 3], &[f32; 3])| near(Vec3::from_array(*a) / 100.0, Vec3::from_array(*b) / 100.0);
    assert!(turned.texels().iter().zip(environment.texels()).all(same));
}

#[test]
fn other_skies_are_what_they_say() {
    let uniform = Sky { strength: 2.0, ..Sky::new(SkyKind::Uniform { color: Vec3::new(0.1, 0.2, 0.3) }) };
    let Surroundings { environment, sun, .. } = uniform.surroundings(Up::Y).unwrap();
    assert!(near(environment.mean(), Vec3::new(0.2, 0.4, 0.6)) && sun.is_none());
    let gradient = SkyKind::Gradient { zenith: Vec3::Z, horizon: Vec3::ONE, ground: Vec3::X };
    let map = Sky::new(gradient).surroundings(Up::Z).unwrap().environment;
    let rows = map.size()[1] as usize;
    assert!(near(Vec3::from_array(map.texels()[0]), Vec3::Z) && map.texels()[rows - 1] == [1.0, 0.0, 0.0]);
    assert!((map.texels()[rows / 2 - 1][0] - 1.0).abs() < 0.01, "white at the horizon");
}

#[test]
fn skies_that_cannot_be_say_what_can() {
    let error = |kind: SkyKind| Sky::new(kind).surroundings(Up::Y).unwrap_err().to_string();
    let ground = Vec3::splat(0.2);
    let clear = |elevation, turbidity, ground| SkyKind::Clear {
        sun: SunPosition { elevation, azimuth: 0.0 },
        turbidity,
        ground,
    };
    assert!(
        error(clear(-3.0, 3.0, ground)).contains("3.00 degrees below the horizon"),
        "{}",
        error(clear(-3.0, 3.0, ground))
    );
    assert!(error(clear(91.0, 3.0, ground)).contains("from 0 to 90"));
    assert!(error(clear(30.0, 0.5, ground)).contains("turbidity is 0.5"));
    assert!(error(clear(30.0, f32::NAN, ground)).contains("turbidity"));
    assert!(error(clear(30.0, 3.0, Vec3::splat(1.5))).contains("reflectance"));
    for elevation in [0.0, 90.0] {
        let map = Sky::clear(SunPosition { elevation, azimuth: 0.0 }).surroundings(Up::Y).unwrap().environment;
        assert!(map.texels().iter().flatten().all(|value| value.is_finite() && *value >= 0.0), "{elevation}");
    }
}

#[test]
fn files_are_read_and_damaged_ones_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let picture = image::Rgb32FImage::from_fn(8, 4, |x, y| image::Rgb([x as f32, 0.5, y as f32]));
    for name in ["a.hdr", "a.exr"] {
        let path = folder.path().join(name);
        picture.save(&path).unwrap();
        let map = Environment::open(&path, Up::Y, Budget::default()).unwrap();
        assert_eq!((map.size(), map.name.as_str()), ([8, 4], name));
        let texel = map.texels()[8 * 3 + 5];
        assert!((0..3).all(|channel| (texel[channel] - [5.0, 0.5, 3.0][channel]).abs() < 0.05), "{name}: {texel:?}");
        let bytes = std::fs::read(&path).unwrap();
        for cut in [0, 5, 20, bytes.len() / 2, bytes.len() - 3] {
            // A cut-off file may still hold all texels.
            if let Err(error) = decode(&path, &bytes[..cut], Up::Y, Budget::default()) {
                let message = error.to_string();
                assert!(message.contains(name) && message.contains("equirectangular"), "{message}");
            }
        }
        assert!(decode(&path, &bytes[..40], Up::Y, Budget::default()).is_err());
    }
    let path = folder.path().join("large.exr");
    image::Rgb32FImage::new(512, 256).save(&path).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    let error = decode(&path, &bytes, Up::Y, Budget::new(Some(1000))).unwrap_err();
    assert!(matches!(error, EnvironmentError::Memory { .. }), "{error}");
    assert!(error.to_string().contains("an environment of 512x256 texels"), "{error}");
    let missing = Environment::open(&folder.path().join("none.hdr"), Up::Y, Budget::default()).unwrap_err();
    assert!(missing.to_string().contains("none.hdr"), "{missing}");
    let png = folder.path().join("a.png");
    image::GrayImage::new(2, 1).save(&png).unwrap();
    let error = Environment::open(&png, Up::Y, Budget::default()).unwrap_err().to_string();
    assert!(error.contains("neither a Radiance HDR nor an OpenEXR"), "{error}");
    let large = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 30000 +X 30000\n\x02\x02";
    let error = decode(&png, large, Up::Y, Budget::default()).unwrap_err().to_string();
    assert!(error.contains("30000 x 30000"), "{error}");
}
