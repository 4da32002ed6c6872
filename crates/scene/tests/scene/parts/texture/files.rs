use std::fs;
use std::path::PathBuf;

use lightmesh_scene::LoadOptions;
use lightmesh_scene::internals::draft::Draft;

/// A folder with an image of one blue texel, and a draft of a scene in it.
fn folder() -> (tempfile::TempDir, PathBuf, Draft) {
    let folder = tempfile::tempdir().unwrap();
    let pixel = image::RgbImage::from_pixel(1, 1, image::Rgb([0, 0, 255]));
    fs::create_dir(folder.path().join("maps")).unwrap();
    pixel.save_with_format(folder.path().join("maps/blue.png"), image::ImageFormat::Png).unwrap();
    let scene = folder.path().join("scene.mtl");
    let draft = Draft::new(&scene, &LoadOptions::default());
    (folder, scene, draft)
}

#[test]
fn a_file_is_read_once() {
    let (_folder, scene, mut draft) = folder();
    assert_eq!(draft.texture_file(&scene, r"maps\blue.png"), Some(0));
    assert_eq!(draft.texture_file(&scene, "maps/blue.png"), Some(0));
    assert_eq!(draft.textures.len(), 1);
    assert_eq!(draft.textures[0].texels, [[0, 0, 255, 255]]);
    assert_eq!(draft.texture_files.warning(&scene), None);
}

#[test]
fn a_picture_may_lie_in_the_file_itself() {
    let (folder, scene, mut draft) = folder();
    let bytes = fs::read(folder.path().join("maps/blue.png")).unwrap();
    assert_eq!(draft.texture_bytes(&scene, "image 0", &bytes), Some(0));
    assert_eq!(draft.texture_bytes(&scene, "image 1", &bytes[..30]), None);
    let warning = draft.texture_files.warning(&scene).unwrap();
    let file = scene.display();
    let start = format!("{file}: 1 texture cannot be used, so the materials keep their plain colours: {file}: image 1");
    assert!(warning.starts_with(&format!("{start} (its PNG data is damaged")), "{warning}");
}

#[test]
fn what_cannot_be_had_is_one_warning() {
    let (folder, scene, mut draft) = folder();
    fs::write(folder.path().join("page.png"), "<html>").unwrap();
    for name in ["none.png", "page.png", "../a.png", "maps", "none.png", "../a.png", "file:///etc/passwd"] {
        assert_eq!(draft.texture_file(&scene, name), None, "{name}");
    }
    let scene = draft.finish().unwrap();
    let warning = &scene.warnings[0];
    assert!(
        warning.contains("scene.mtl: 5 textures cannot be used, so the materials keep their plain colours: "),
        "{warning}"
    );
    assert!(warning.contains("none.png; check that it exists and is readable (named by "), "{warning}");
    assert!(warning.contains("page.png (it is not a PNG, JPEG, BMP or TGA image)"), "{warning}");
    assert!(warning.contains("`../a.png` leads outside the scene's folder"), "{warning}");
    assert!(warning.ends_with("; and 2 more"), "{warning}");
}
