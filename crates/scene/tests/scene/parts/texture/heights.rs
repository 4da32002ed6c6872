use lightmesh_scene::Texture;
use lightmesh_scene::internals::texture::{is_grey, normals_of_heights};

fn grey(size: [u32; 2], value: impl Fn(u32, u32) -> u8) -> Texture {
    let texel = |index: u32| value(index % size[0], index / size[0]);
    let texels = (0..size[0] * size[1]).map(texel).map(|grey| [grey, grey, grey, 255]).collect();
    Texture { name: "heights".into(), size, texels }
}

#[test]
fn flat_heights_have_flat_normals() {
    for clamp in [false, true] {
        let normals = normals_of_heights(&grey([3, 2], |_, _| 77), clamp);
        assert_eq!(normals.texels, [[128, 128, 255, 255]; 6]);
    }
}

#[test]
fn normals_lean_away_from_what_is_higher() {
    // 100 codes per texel in an image of 255 texels: a slope of 1.
    let to_the_right = grey([255, 3], |column, _| {
        if column == 10 {
            200
        } else if column == 9 {
            100
        } else {
            0
        }
    });
    let normals = normals_of_heights(&to_the_right, false);
    let diagonal = (127.0 * 0.5_f32.sqrt()).round() as u8;
    assert_eq!(normals.texels[9], [128 - diagonal, 128, 128 + diagonal, 255]);
    // Downwards: the normal leans to the top, which is green.
    let downwards = grey([255, 30], |_, row| {
        if row == 10 {
            200
        } else if row == 9 {
            100
        } else {
            0
        }
    });
    assert_eq!(normals_of_heights(&downwards, true).texels[255 * 9], [128, 128 + diagonal, 128 + diagonal, 255]);
}

#[test]
fn edges_continue_as_they_are_told() {
    let slope = grey([100, 1], |column, _| 2 * column as u8);
    assert_eq!(normals_of_heights(&slope, true).texels[0][1..], [128, 255, 255]);
    assert!(normals_of_heights(&slope, true).texels[0][0] <= 128);
    assert!(normals_of_heights(&slope, false).texels[0][0] > 150, "beside what is white");
}

#[test]
fn images_of_normals_have_colours() {
    assert!(is_grey(&grey([2, 2], |column, _| 255 * column as u8)));
    assert!(!is_grey(&Texture { name: String::new(), size: [1, 1], texels: vec![[128, 128, 255, 255]] }));
}
