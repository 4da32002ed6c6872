use lightmesh_image::internals::display::{agx, hue, mixed, with_hue};

/// Colours and what the scripts named above show them as, computed with colour-science 0.4 in double precision.
const KNOWN: [([f32; 3], [f32; 3]); 13] = [
    ([0.18; 3], [0.18; 3]),
    ([0.01; 3], [0.006_262_409; 3]),
    ([0.001; 3], [0.000_253_484; 3]),
    ([1.0; 3], [0.555_999_06; 3]),
    ([4.0; 3], [0.815_411_8; 3]),
    ([16.0; 3], [0.998_045; 3]),
    ([1.0, 0.0, 0.0], [0.707_942_3, 0.041_106_54, 0.015_855_485]),
    ([0.0, 1.0, 0.0], [0.157_045_92, 0.559_189, 0.083_013_736]),
    ([0.0, 0.0, 1.0], [0.012_641_672, 0.088_987_97, 0.649_198_05]),
    ([0.5, 0.2, 0.05], [0.432_219_2, 0.187_118_97, 0.053_791_545]),
    ([0.1, 0.4, 0.9], [0.180_532_71, 0.359_292_9, 0.561_541_2]),
    ([8.0, 2.0, 0.3], [0.996_729_2, 0.679_200_65, 0.543_448_75]),
    ([0.02, 0.3, 0.01], [0.032_380_973, 0.265_624_8, 0.003_035_915_5]),
];

#[test]
fn known_values() {
    for (color, expected) in KNOWN {
        let shown = agx(color);
        let is_near = shown.into_iter().zip(expected).all(|(a, b)| (a - b).abs() < 2e-5);
        assert!(is_near, "{color:?}: {shown:?} instead of {expected:?}");
    }
}

#[test]
fn what_is_outside_of_the_range_is_black_or_white() {
    assert!(agx([0.18 / 1024.0; 3])[0] < 1e-6 && agx([0.0; 3]) == [0.0; 3]);
    assert!(agx([16.3; 3])[0] > 0.9999 && agx([1e18; 3])[0] > 0.9999);
}

#[test]
fn the_hue_is_kept_by_its_own_value() {
    for color in [[0.9, 0.2, 0.1], [0.1, 0.8, 0.3], [0.2, 0.3, 0.7], [0.5, 0.5, 0.1], [0.4; 3]] {
        let same = with_hue(color, hue(color));
        assert!(color.into_iter().zip(same).all(|(a, b)| (a - b).abs() < 1e-6), "{color:?} {same:?}");
    }
    assert!((mixed(0.9, 0.1) - 0.98).abs() < 1e-6 && (mixed(0.1, 0.9) - 0.02).abs() < 1e-6);
}
