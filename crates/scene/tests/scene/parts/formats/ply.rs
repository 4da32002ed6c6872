//! Known answers for PLY, and messages for damaged files.

use std::fs;

use glam::Vec3;
use lightmesh_scene::Scene;

fn try_open(bytes: &[u8]) -> Result<Scene, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("part.ply");
    fs::write(&path, bytes).unwrap();
    Scene::open(path).map_err(|error| error.to_string().replace(&format!("{}/", folder.path().display()), ""))
}

fn open(bytes: impl AsRef<[u8]>) -> Scene {
    try_open(bytes.as_ref()).unwrap_or_else(|error| panic!("{error}"))
}

fn ascii(header: &str, body: &str) -> String {
    format!("ply\nformat ascii 1.0\n{header}end_header\n{body}")
}

fn corners(scene: &Scene) -> Vec<[Vec3; 3]> {
    (0..scene.geometry.mesh.triangles.len()).map(|index| scene.geometry.mesh.corners(index)).collect()
}

const XYZ: &str = "property float x\nproperty float y\nproperty float z\n";
const SQUARE: &str = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
const LIST: &str = "property list uchar int vertex_indices\n";

fn square(faces: &str) -> String {
    let count = faces.lines().count();
    ascii(&format!("element vertex 4\n{XYZ}element face {count}\n{LIST}"), &(SQUARE.to_owned() + faces))
}

fn is_square(scene: &Scene) -> bool {
    let [o, x, xy, y] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| Vec3::new(x, y, 0.0));
    corners(scene) == [[o, x, xy], [o, xy, y]]
}

#[test]
fn polygons_of_a_text_are_cut() {
    assert!(is_square(&open(square("4 0 1 2 3\n"))));
    assert!(is_square(&open(square("3 0 1 2\n3 0 2 3\n"))));
    assert!(is_square(&open(square("4 0 1 2 3\n").replace('\n', "\r\n"))));
    assert!(is_square(&open(square("4 0 1 2 3\n").replace('\n', "\r"))));
    assert!(is_square(&open(square("4 0 1 2 3\n").replace("end_h", "comment a b\nobj_info c d\nend_h"))));
    let short = open(square("4 0 1 2 3\n2 0 1\n0\n"));
    assert!(is_square(&short) && short.warnings[0].contains("2 faces with fewer than three"), "{:?}", short.warnings);
}

/// The square in binary, with other properties and elements in between.
fn binary(big: bool) -> Vec<u8> {
    let order = if big { "big" } else { "little" };
    let header = format!(
        "ply\r\nformat binary_{order}_endian 1.0\r\nelement camera 2\r\nproperty list ushort double view\r\nproperty int8 n\r\n\
         element face 1\r\nproperty short flags\r\nproperty list uint ushort vertex_index\r\nproperty list char float weights\r\n\
         element vertex 4\r\nproperty float64 z\r\nproperty uint16 id\r\nproperty float y\r\nproperty int32 x\r\nend_header\r\n"
    );
    let mut bytes = header.into_bytes();
    let mut put = |value: &[u8]| {
        let reversed = value.iter().rev().copied();
        if big { bytes.extend(reversed) } else { bytes.extend(value) }
    };
    for count in [3u16, 0] {
        put(&count.to_le_bytes());
        (0..count).for_each(|_| put(&0.5f64.to_le_bytes()));
        put(&[0xff]);
    }
    put(&10i16.to_le_bytes());
    put(&4u32.to_le_bytes());
    (0..4u16).for_each(|index| put(&index.to_le_bytes()));
    put(&[2]);
    (0..2).for_each(|_| put(&1f32.to_le_bytes()));
    for [x, y] in [[0, 0], [1, 0], [1, 1], [0, 1]] {
        put(&0f64.to_le_bytes());
        put(&7u16.to_le_bytes());
        put(&(y as f32).to_le_bytes());
        put(&i32::to_le_bytes(x));
    }
    bytes
}

#[test]
fn both_byte_orders_hold_elements_in_any_order() {
    for big in [false, true] {
        let scene = open(binary(big));
        assert!(is_square(&scene), "{big}: {:?}", corners(&scene));
        assert!(scene.warnings.iter().any(|warning| warning.contains("camera (2)")), "{:?}", scene.warnings);
    }
}

#[test]
fn the_wrong_byte_order_is_found_out() {
    let text = String::from_utf8_lossy(&binary(true)).into_owned();
    assert!(text.contains("binary_big_endian"));
    let at = text.find("big").unwrap();
    let wrong = [&binary(true)[..at], b"little", &binary(true)[at + 3..]].concat();
    assert!(try_open(&wrong).unwrap_err().contains("part.ply; "));
}

#[test]
fn strips_turn_every_other_triangle_and_begin_anew() {
    let header = format!("element vertex 6\n{XYZ}element tristrips 1\nproperty list int int vertex_indices\n");
    let body = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n11 0 1 2 3 -1 2 3 3 4 5 -1\n";
    let scene = open(ascii(&header, body));
    let normals: Vec<f32> = corners(&scene).iter().map(|[a, b, c]| (b - a).cross(c - a).z).collect();
    // 2 3 3 and 3 3 4 have no area; 3 4 5 is third, as 2 3 4 would be first.
    assert_eq!((scene.geometry.mesh.triangles.len(), normals), (3, vec![1.0, 1.0, -1.0]));
}

#[test]
fn vertices_have_normals_texture_coordinates_and_colours() {
    let header = format!(
        "element vertex 3\n{XYZ}property float nx\nproperty float ny\nproperty float nz\nproperty float texture_u\n\
         property float texture_v\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n{LIST}"
    );
    let body = "0 0 0 0 0 2 0.25 0.25 255 0 188\n1 0 0 0 0 2 0 0 255 0 188\n0 1 0 0 0 2 0 1 255 0 188\n3 0 1 2\n";
    let scene = open(ascii(&header, body));
    assert_eq!(scene.geometry.mesh.normals, [Vec3::Z; 3]);
    assert_eq!(scene.geometry.mesh.uvs[0].to_array(), [0.25, 0.75]);
    let [r, g, b] = scene.geometry.mesh.colors[2].to_array();
    assert!(r == 1.0 && g == 0.0 && (b - 0.5).abs() < 0.005, "{r} {g} {b}");
    let float = ascii(&header.replace("uchar red", "float red"), body)
        .replace("uchar", "double")
        .replace("list double", "list uchar");
    let scene = open(float.replace("255 0 188", "1 0 0.737"));
    assert!(
        (scene.geometry.mesh.colors[2] - Vec3::new(1.0, 0.0, 0.5)).abs().max_element() < 0.005,
        "{:?}",
        scene.geometry.mesh.colors
    );
}

#[test]
fn coloured_faces_split_their_vertices() {
    let colors = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    let header = format!("element vertex 4\n{XYZ}element face 3\n{LIST}{colors}");
    let body = SQUARE.to_owned() + "3 0 1 2 255 0 0\n3 0 2 3 0 255 0\n3 0 1 3 255 0 0\n";
    let mesh = open(ascii(&header, &body)).geometry.mesh.clone();
    assert_eq!(mesh.positions.len(), 4 + 3);
    let color = |triangle: usize| mesh.triangles[triangle].map(|vertex| mesh.colors[vertex as usize]);
    assert_eq!([0, 1, 2].map(color), [[Vec3::X; 3], [Vec3::Y; 3], [Vec3::X; 3]]);
}

#[test]
fn a_named_picture_is_the_texture() {
    let folder = tempfile::tempdir().unwrap();
    let header = format!(
        "comment TextureFile a b.png\nelement vertex 3\n{XYZ}property float s\nproperty float t\nelement face 1\n{LIST}"
    );
    let path = folder.path().join("part.ply");
    fs::write(&path, ascii(&header, "0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n")).unwrap();
    let warnings = Scene::open(&path).unwrap().warnings;
    assert!(warnings[0].contains("a b.png"), "{warnings:?}");
}

#[test]
fn vertices_that_no_face_uses_do_not_matter() {
    let header = format!("element vertex 4\n{XYZ}element face 1\n{LIST}");
    let scene = open(ascii(&header, "1e17 0 0\n0 0 0\n1 0 0\n0 1 0\n3 1 2 3\n"));
    assert_eq!(corners(&scene), [[Vec3::ZERO, Vec3::X, Vec3::Y]]);
    assert_eq!(scene.geometry.mesh.positions.len(), 3);
}

#[test]
fn damage_is_named_with_its_line() {
    let head = |header: &str| format!("ply\nformat ascii 1.0\n{header}");
    let promise = format!("element vertex 4294967295\n{XYZ}element face 1\n{LIST}");
    let many = format!("element vertex 3\n{XYZ}element face 1\nproperty list uint int vertex_indices\n");
    let three = "0 0 0\n1 0 0\n0 1 0\n";
    let cases = [
        (String::new(), "the file does not begin with the line `ply`, part.ply:1; "),
        ("ply\n".to_owned(), "the header has no end_header, part.ply:1; "),
        ("ply\nend_header\n".to_owned(), "the header has no line `format`, part.ply:2; "),
        (
            "ply\nformat binary 1.0\n".to_owned(),
            "`binary` is not a known format of PLY files, part.ply:2; supported: ascii",
        ),
        (head("element vertex -1\n"), "`element vertex -1` has no usable count, part.ply:3; "),
        (head("property float x\n"), "a property comes before the first element, part.ply:3; "),
        (
            head("element vertex 1\nproperty half x\n"),
            "`property half x` is not a property with a known type, part.ply:4; ",
        ),
        (ascii("element face 0\n", ""), "the file has no element `vertex`, part.ply:"),
        (ascii("element vertex 1\nproperty float x\n", "0\n"), "lacks one of the properties x, y and z, part.ply:"),
        (
            ascii(&promise, three),
            "the header declares 4294967295 of element `vertex`, but the rest of the file has room for only 3, ",
        ),
        (
            ascii(&many, &format!("{three}4294967295 0 1 2\n")),
            "the file ends within row 1 of 1 of element `face`, part.ply:13; ",
        ),
        (
            ascii(&many, &format!("{three}-3 0 1 2\n")),
            "row 1 of 1 of element `face` has a list of -3 items, part.ply:13; ",
        ),
        (
            ascii(&many, &format!("{three}3 0 1 3\n")),
            "refers to vertex 3, but there are only 3, counted from 0, part.ply:13; ",
        ),
        (
            ascii(&many, &format!("{three}3 0 1 -1\n")),
            "refers to vertex -1, but there are only 3, counted from 0, part.ply:13; ",
        ),
        (
            ascii(&many, "0 0 0\n1 zero 0\n0 1 0\n3 0 1 2\n"),
            "`zero` in row 2 of 3 of element `vertex` is not a number, part.ply:11; ",
        ),
    ];
    for (text, expected) in cases {
        let message = try_open(text.as_bytes()).map(|scene| scene.geometry.mesh.clone()).unwrap_err();
        assert!(message.contains(expected), "{message}");
    }
}

#[test]
fn a_file_cut_short_anywhere_is_an_error() {
    for whole in [square("4 0 1 2 3\n").into_bytes(), binary(false), binary(true)] {
        // The last line feed of a text may be missing.
        for length in 0..whole.len() - 1 {
            let message = try_open(&whole[..length]).map(|scene| scene.geometry.mesh.clone()).unwrap_err();
            assert!(message.contains(", part.ply"), "{message}");
        }
    }
}

fn is_square_with(text: &str, expected: &str) {
    let scene = open(text);
    assert!(is_square(&scene), "{text}");
    assert!(scene.warnings.iter().any(|warning| warning.ends_with(expected)), "{expected}: {:?}", scene.warnings);
}

/// What other programs read: warned about with its line, and read as what it must mean.
#[test]
fn what_others_read_is_read_with_a_warning() {
    let plain = square("4 0 1 2 3\n");
    is_square_with(
        &plain.replace("1 1 0\n0 1 0\n", "1 1 0 0.5 7\n0 1 0 x\n"),
        "part.ply:12: `0.5` is more than the header says of a row, and ignored (the first of 2)",
    );
    is_square_with(
        &square("4 0 1 2 3 255 0 0\n"),
        "part.ply:14: `255` is more than the header says of a row, and ignored",
    );
    is_square_with(
        &plain.replace("element face", "Created by hand\nand more\nelement face"),
        "part.ply:7: `Created` is an unknown word in the header; its line is ignored (the first of 2)",
    );
    let faces_first = ascii(
        &format!("element face 1\n{LIST}element vertex 4\n{XYZ}"),
        &format!("4 0 1 2 3 9\n{}", SQUARE.replace('\n', " 8\n")),
    );
    is_square_with(
        &faces_first,
        "part.ply:11: `8` is more than the header says of a row, and ignored (the first of 5)",
    );
    assert!(is_square(&open(plain.replace("1 1 0\n", "1.0f 1 0\n"))));
}

#[test]
fn rows_that_share_lines_or_take_several_are_read_as_they_are() {
    let plain = square("4 0 1 2 3\n");
    for text in [
        plain.replace("0 0 0\n1 0 0\n", "0 0 0 1 0 0\n"),
        plain.replace(SQUARE, &SQUARE.replace('\n', " ")),
        plain.replace("4 0 1", "4\n0\n\n1"),
        plain.replace("0 0 0\n1 0 0\n", "0 0 0 1\n0 0\n"),
        plain.trim_end().to_owned(),
        format!("\u{feff}{plain}"),
        plain.replacen('\n', "\r\n", 1),
        plain.replace("end_header\n", "end_header\r\n"),
    ] {
        let scene = open(&text);
        assert!(is_square(&scene) && scene.warnings.is_empty(), "{text}: {:?}", scene.warnings);
    }
}
