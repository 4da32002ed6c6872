//! Known values: what version 1.2 of the authors' C++ gives (the crate `nv-flip` 0.1.2) at 67 pixels per degree. Their Python package
//! `flip-evaluator` 1.7 gives the same to 1e-7.

use lightmesh_image::internals::compare::flip;

/// How far values may be from theirs.
const NEAR: f64 = 1e-4;

type Picture = Vec<[u8; 3]>;

fn picture(width: usize, height: usize, code: impl Fn(usize, usize) -> [u8; 3]) -> Picture {
    (0..width * height).map(|pixel| code(pixel % width, pixel / width)).collect()
}

/// Codes without order.
fn noise(width: usize, height: usize, seed: u32) -> Picture {
    picture(width, height, |x, y| {
        let mixed = ((x + width * y) as u32 ^ seed.wrapping_mul(0x9e37_79b9)).wrapping_mul(0x85eb_ca6b);
        let mixed = (mixed ^ mixed >> 13).wrapping_mul(0xc2b2_ae35);
        let [red, green, blue, _] = (mixed ^ mixed >> 16).to_le_bytes();
        [red, green, blue]
    })
}

/// A smooth ground with a ball in front, whose left end is at `at`.
fn ball(width: usize, height: usize, at: usize) -> Picture {
    picture(width, height, |x, y| {
        let [across, down] = [(x, at + 12), (y, height / 2)].map(|(place, center)| place as i32 - center as i32);
        match across * across + down * down {
            near if near <= 144 => [220 - near as u8, 60 + near as u8 / 4, 40],
            _ => [60 + (x * 90 / width) as u8, 80 + (y * 100 / height) as u8, 200 - (x * 70 / width) as u8],
        }
    })
}

fn pairs() -> Vec<(&'static str, usize, Picture, Picture)> {
    let plain = |width: usize, height, code| vec![code; width * height];
    let stripes = |shift: usize| picture(64, 64, |x, _| [((x + shift) / 8 % 2 * 255) as u8; 3]);
    let mut changed = noise(33, 17, 5);
    changed[8 * 33 + 16][1] ^= 1;
    vec![
        ("one pixel", 1, noise(1, 1, 1), noise(1, 1, 2)),
        ("six pixels", 3, noise(3, 2, 1), noise(3, 2, 2)),
        ("a column", 1, noise(1, 90, 1), noise(1, 90, 2)),
        ("a row", 90, noise(90, 1, 1), noise(90, 1, 2)),
        ("noise", 33, noise(33, 17, 1), noise(33, 17, 2)),
        ("equal", 33, noise(33, 17, 3), noise(33, 17, 3)),
        ("one code", 33, noise(33, 17, 5), changed),
        ("grey", 16, plain(16, 16, [102; 3]), plain(16, 16, [153; 3])),
        ("black and white", 8, plain(8, 8, [0; 3]), plain(8, 8, [255; 3])),
        ("blue and yellow", 8, plain(8, 8, [0, 0, 255]), plain(8, 8, [255, 255, 0])),
        ("green and blue", 8, plain(8, 8, [0, 255, 0]), plain(8, 8, [0, 0, 255])),
        ("stripes", 64, stripes(0), stripes(1)),
        ("a ball that moved", 71, ball(71, 150, 20), ball(71, 150, 22)),
    ]
}

/// Mean, and errors of some pixels.
type Known = (&'static str, f64, &'static [(usize, f64)]);

#[rustfmt::skip]
const KNOWN: [Known; 13] = [
    ("one pixel", 0.445895, &[(0, 0.445895)]),
    ("six pixels", 0.564245, &[(2, 0.720910), (5, 0.507712)]),
    ("a column", 0.696202, &[(12, 0.967716), (30, 0.662546), (89, 0.868792)]),
    ("a row", 0.696202, &[(12, 0.967716), (30, 0.662546), (89, 0.868792)]),
    ("noise", 0.487168, &[(187, 0.423665), (528, 0.971152), (560, 0.820143)]),
    ("equal", 0.000000, &[(0, 0.000000), (187, 0.000000), (560, 0.000000)]),
    ("one code", 0.000518, &[(187, 0.000337), (280, 0.016636), (560, 0.000000)]),
    ("grey", 0.469014, &[(0, 0.469014), (85, 0.469014), (255, 0.469014)]),
    ("black and white", 0.967392, &[(0, 0.967392), (21, 0.967392), (63, 0.967392)]),
    ("blue and yellow", 0.998972, &[(0, 0.998972), (21, 0.998972), (63, 0.998972)]),
    ("green and blue", 1.000000, &[(0, 1.000000), (21, 1.000000), (63, 1.000000)]),
    ("stripes", 0.417168, &[(63, 0.947931), (1365, 0.719928), (4095, 0.947931)]),
    ("a ball that moved", 0.018535, &[(3550, 0.000000), (5489, 0.484623), (10649, 0.000000)]),
];

#[test]
fn errors_are_those_of_the_authors() {
    for ((name, width, reference, test), (known, mean, errors)) in pairs().into_iter().zip(KNOWN) {
        assert_eq!(name, known);
        let found = flip(&reference, &test, width);
        assert_eq!(found.len(), reference.len());
        let found_mean = found.iter().copied().map(f64::from).sum::<f64>() / found.len() as f64;
        assert!((found_mean - mean).abs() < NEAR, "{name}: {found_mean}, not {mean}");
        for &(pixel, error) in errors {
            assert!((f64::from(found[pixel]) - error).abs() < NEAR, "{name}: {}, not {error}", found[pixel]);
        }
        assert!(found.iter().all(|error| (0.0..=1.0).contains(error)), "{name}");
    }
}

/// Bands and blocks leave no seams: a turned image has turned errors.
#[test]
fn rows_and_columns_are_treated_alike() {
    let (width, height) = (150, 71);
    let turned = |picture: &Picture| self::picture(height, width, |x, y| picture[x * width + y]);
    let [reference, test] = [20, 22].map(|at| ball(width, height, at));
    let upright = flip(&turned(&reference), &turned(&test), height);
    let lying = flip(&reference, &test, width);
    assert!(lying.iter().any(|&error| error > 0.1));
    for (pixel, error) in lying.iter().enumerate() {
        let other = upright[pixel % width * height + pixel / width];
        assert!((error - other).abs() < NEAR as f32, "pixel {pixel}: {error}, {other}");
    }
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let [reference, test] = [20, 22].map(|at| ball(71, 300, at));
    let errors = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| flip(&reference, &test, 71))
    };
    assert_eq!(errors(1), errors(3));
}
