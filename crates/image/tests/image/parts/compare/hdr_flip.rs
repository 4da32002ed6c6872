//! Known values: what the authors' Python package `flip-evaluator` 1.7 gives for the same pictures at 67 pixels per degree,
//! `flip_evaluator.evaluate(reference, test, "HDR", applyMagma=False, parameters={"ppd": 67.0})`.

use lightmesh_image::internals::compare::hdr_flip_errors;

/// How far values may be from theirs.
const NEAR: f64 = 2e-4;

type Picture = Vec<[f32; 3]>;

fn picture(width: usize, height: usize, color: impl Fn(usize, usize) -> [f32; 3]) -> Picture {
    (0..width * height).map(|pixel| color(pixel % width, pixel / width)).collect()
}

/// Powers of two without order.
fn steps(shift: usize, base: i32) -> Picture {
    let power = |number: usize, count: usize| ((number % count) as i32 - base) as f32;
    picture(33, 17, |x, y| {
        [power(7 * x + 3 * y + shift, 16), power(5 * x + 11 * y + 2 * shift, 12), power(3 * x + y, 8)].map(f32::exp2)
    })
}

fn disc(at: i32, value: f32) -> Picture {
    picture(71, 40, |x, y| {
        let (across, down) = (x as i32 - at, y as i32 - 20);
        [if across * across + down * down <= 144 { value } else { 0.125 }; 3]
    })
}

fn ramp(blue: f32) -> Picture {
    picture(64, 48, |x, _| {
        let value = (x + 1) as f32 / 8.0;
        [value, 0.5 * value, blue * value]
    })
}

#[test]
#[rustfmt::skip]
fn errors_are_those_of_the_authors() {
    let plain = |value: f32| vec![[value; 3]; 256];
    let known: [(_, _, _, _, _, &[(usize, f64)]); 6] = [
        ("two and four", 16, plain(2.0), plain(4.0), 0.144816, &[(0, 0.144816), (255, 0.144816)]),
        ("steps", 33, steps(0, 6), steps(1, 6), 0.403243, &[(0, 0.841769), (187, 0.268765), (280, 0.182272), (560, 0.498320)]),
        ("a disc that moved", 71, disc(20, 64.0), disc(22, 64.0), 0.103307, &[(0, 0.0), (946, 0.002559), (2839, 0.0)]),
        ("a brighter disc", 71, disc(20, 64.0), disc(20, 256.0), 0.058250, &[(946, 0.264519), (1420, 0.0)]),
        ("a ramp", 64, ramp(0.25), ramp(0.5), 0.420733, &[(0, 0.272250), (1536, 0.272250), (3071, 0.337838)]),
        ("equal", 33, steps(3, 4), steps(3, 4), 0.0, &[(0, 0.0), (280, 0.0)]),
    ];
    for (name, width, reference, test, mean, errors) in known {
        let found = hdr_flip_errors(&reference, &test, width);
        let found_mean = found.iter().copied().map(f64::from).sum::<f64>() / found.len() as f64;
        assert!((found_mean - mean).abs() < NEAR, "{name}: {found_mean}, not {mean}");
        for &(pixel, error) in errors {
            assert!((f64::from(found[pixel]) - error).abs() < NEAR, "{name}, {pixel}: {}, not {error}", found[pixel]);
        }
    }
}

#[test]
fn odd_values_have_finite_errors() {
    let odd = [0.0, -1.0, f32::INFINITY, f32::MAX, 1e-40, 1.0];
    for reference in odd {
        for test in odd {
            let errors = hdr_flip_errors(&[[reference; 3]; 4], &[[test; 3]; 4], 2);
            assert!(errors.iter().all(|error| (0.0..=1.0).contains(error)), "{reference} {test}: {errors:?}");
        }
    }
    // A black reference has no brightest pixel, and light beside it is seen.
    assert!(hdr_flip_errors(&[[0.0; 3]], &[[1.0; 3]], 1)[0] > 0.5);
    assert_eq!(hdr_flip_errors(&[[0.0; 3]], &[[0.0; 3]], 1), [0.0]);
}
