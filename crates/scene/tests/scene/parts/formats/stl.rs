//! Known answers for STL, and messages for damaged files.

use std::fs;

use lightmesh_scene::Scene;

const CORNERS: [[f32; 3]; 6] =
    [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.5], [0.0, 1.0, 0.0]];

fn try_open(bytes: &[u8]) -> Result<Scene, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("part.STL");
    fs::write(&path, bytes).unwrap();
    Scene::open(path).map_err(|error| error.to_string().replace(&format!("{}/", folder.path().display()), ""))
}

fn open(bytes: &[u8]) -> Scene {
    try_open(bytes).unwrap_or_else(|error| panic!("{error}"))
}

fn is_right(scene: &Scene) -> bool {
    let corners: Vec<[f32; 3]> =
        (0..2).flat_map(|i| scene.geometry.mesh.corners(i)).map(|corner| corner.to_array()).collect();
    scene.geometry.mesh.triangles.len() == 2 && corners == CORNERS && scene.geometry.mesh.normals.is_empty()
}

fn facet(corners: &[[f32; 3]]) -> String {
    let vertex = |[x, y, z]: &[f32; 3]| format!("vertex {x} {y:e} {z:.3}\n");
    format!("facet normal 0 0 1\nouter loop\n{}endloop\nendfacet\n", corners.iter().map(vertex).collect::<String>())
}

fn binary(header: &[u8], count: u32) -> Vec<u8> {
    let mut bytes = header.to_vec();
    bytes.resize(80, 0);
    bytes.extend(count.to_le_bytes());
    for corners in CORNERS.as_chunks::<3>().0 {
        let numbers = [[9.0; 3]].iter().chain(corners).flatten().flat_map(|number| number.to_le_bytes());
        bytes.extend(numbers);
        bytes.extend([0x12, 0x34]);
    }
    bytes
}

#[test]
fn text_is_read_however_it_is_laid_out() {
    let facets = facet(&CORNERS[..3]) + &facet(&CORNERS[3..]);
    let plain = format!("solid part\n{facets}endsolid part\n");
    let nameless = facets.replace("normal 0 0 1", "normal -nan(ind) 1,5 x");
    for text in [
        plain.clone(),
        plain.to_uppercase(),
        plain.replace('\n', "\r\n"),
        plain.replace('\n', "\r"),
        plain.replace('\n', " \t "),
        plain.replace(' ', "   \n"),
        format!("\u{feff}  \n{plain}"),
        format!("solid a facet of glass\n{}endsolid\n\nsolid\n{}", facet(&CORNERS[..3]), facet(&CORNERS[3..])),
        format!("solid\n{nameless}"),
    ] {
        // With one word per line, a name is on a separate line, which is not a facet.
        let scene = try_open(text.replace("solid   \npart", "solid").as_bytes());
        assert!(scene.as_ref().is_ok_and(is_right), "{text}: {:?}", scene.map(|scene| scene.geometry.mesh.clone()));
    }
}

#[test]
fn the_length_tells_binary_from_text() {
    for header in [&b""[..], b"solid part", b"solid facet normal 0 0 0 endsolid", b"made by hand", &[0xff; 80]] {
        assert!(is_right(&open(&binary(header, 2))), "{header:?}");
    }
    let empty = open(&binary(b"solid", 2)[..80].iter().copied().chain([0; 4]).collect::<Vec<_>>());
    assert_eq!(empty.geometry.mesh.triangles.len(), 0);
    let mut longer = binary(b"solid", 2);
    longer.extend([7; 60]);
    let scene = open(&longer);
    assert!(is_right(&scene) && scene.warnings[0].contains("60 bytes after the 2 facets"), "{:?}", scene.warnings);
}

#[test]
fn facets_of_other_numbers_of_corners_are_cut_or_left_out() {
    let [a, b, c, ..] = CORNERS;
    let text = facet(&[a, b, [1.0, 1.0, 0.0], c]) + &facet(&[a, b]);
    let scene = open(format!("solid\n{text}endsolid").as_bytes());
    assert_eq!(scene.geometry.mesh.triangles.len(), 2);
    assert!(scene.warnings[0].contains("1 facets with fewer than three corners"), "{:?}", scene.warnings);
}

#[test]
fn damage_is_named() {
    let text = format!("solid\n{}", facet(&CORNERS[..3]));
    let cases: [(&[u8], &str); 8] = [
        (b"", "0 bytes are neither ASCII STL nor binary STL, which has at least 84, part.STL; "),
        (b"solid\nfacet normal 0 0 1 outer loop vertex 0 0", "`` found where a coordinate was expected, part.STL:2; "),
        (
            b"solid\nfacet normal 0 0 1\nouter loop\nvertex 0 zero 0",
            "`zero` found where a coordinate was expected, part.STL:4; ",
        ),
        (b"solid\nfacet normal 0 0 1\nouter loop\n", "the file ends within a facet, part.STL:3; "),
        (b"solid\nfacet outer ring", "`ring` is not a valid keyword in a facet, part.STL:2; "),
        (b"solid\n\nfact normal 0 0 1\nouter", "`outer` found where a facet was expected, part.STL:4; "),
        (
            &binary(b"solid\0", u32::MAX),
            "the header declares 4294967295 facets, but the rest of the file has room for only 2, part.STL; ",
        ),
        (
            &binary(b"", 2)[..180],
            "the header declares 2 facets, but the rest of the file has room for only 1, part.STL; ",
        ),
    ];
    for (bytes, expected) in cases {
        let message = try_open(bytes).map(|scene| scene.geometry.mesh.clone()).unwrap_err();
        assert!(message.contains(expected), "{message}");
    }
    for length in 0..text.len() {
        if let Err(message) = try_open(&text.as_bytes()[..length]) {
            assert!(message.contains("part.STL"), "{message}");
        }
    }
}

/// What other programs read: warned about with its line, and read as what it must mean.
#[test]
fn what_others_read_is_read_with_a_warning() {
    let (first, second) = (facet(&CORNERS[..3]), facet(&CORNERS[3..]));
    let cases = [
        (
            format!("# made by hand\nsolid part\n{first}{second}endsolid"),
            "part.STL:1: `#` is not a facet; its line is ignored",
        ),
        (format!("{first}{second}"), ""),
        (
            format!("solid\n{first}color 1 0 0\n{second}color 0 1 0\n"),
            "part.STL:9: `color` is not a facet; its line is ignored (the first of 2)",
        ),
        (format!("solid\n{first}{second}").replace("vertex 1 ", "vertex 1.0f "), ""),
    ];
    for (text, expected) in cases {
        let scene = open(text.as_bytes());
        assert!(is_right(&scene), "{text}");
        assert!(scene.warnings.concat().ends_with(expected), "{expected}: {:?}", scene.warnings);
    }
    for header in [&b"solid part"[..], b""] {
        let scene = open(&binary(header, 0));
        assert!(is_right(&scene), "{header:?}");
        assert!(scene.warnings[0].ends_with("the header declares no facets, but 2 follow: they are shown"));
    }
}
