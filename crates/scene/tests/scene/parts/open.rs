use std::fs;

use lightmesh_scene::{LoadError, LoadOptions, Scene, SceneFormat};

fn error(path: &str) -> String {
    Scene::open(path).expect_err("an error").to_string()
}

#[test]
fn a_format_that_cannot_be_read_is_answered_with_those_that_can() {
    let known = "supported: .toml, .obj, .gltf, .glb, .ply, .stl, and builtin:NAME";
    assert_eq!(error("bunny.xyz"), format!("`.xyz` is not a supported scene format, bunny.xyz; {known}"));
    assert!(error("bunny").contains(known));
}

#[test]
fn scenes_of_other_programs_are_to_be_exported() {
    for extension in ["fbx", "FBX", "3ds", "dae", "usd", "usda", "usdc", "usdz"] {
        let message = error(&format!("house.{extension}"));
        assert!(message.contains("; export it as glb, in the program that it comes from or in Blender"), "{message}");
    }
    for (extension, program) in [("blend", "Blender"), ("max", "3ds Max"), ("skp", "SketchUp"), ("ifc", "Bonsai")] {
        let message = error(&format!("house.{extension}"));
        assert!(message.contains("; export it as glb") && message.contains(program), "{message}");
        assert!(message.contains("; supported: .toml, .obj"), "{message}");
    }
}

#[test]
fn a_file_that_is_not_there_is_named() {
    for path in ["none.toml", "none.obj", "none.gltf", "none.GLB", "none.ply", "none.STL"] {
        let message = error(path);
        assert!(message.contains(path) && message.contains("; check that it exists"), "{message}");
    }
}

#[test]
fn a_folder_is_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.obj");
    fs::create_dir(&path).unwrap();
    assert!(error(path.to_str().unwrap()).starts_with("this is not a regular file"));
}

#[test]
fn a_stream_is_read_like_a_file_and_refers_to_files_next_to_its_name() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("part.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    let name = folder.path().join("standard input");
    let read = |text: &str, format| Scene::from_reader(text.as_bytes(), &name, format, &LoadOptions::default());
    let scene = read("[[mesh]]\nfile = \"part.obj\"\n", SceneFormat::Toml).unwrap();
    assert_eq!(scene.geometry.mesh.triangles.len(), 1);
    assert_eq!(scene.files, [folder.path().join("part.obj")]);
    let outside = read("[[mesh]]\nfile = \"../part.obj\"\n", SceneFormat::Toml).unwrap_err();
    assert!(matches!(outside.root(), LoadError::Outside { .. }), "{outside}");
    let syntax = read("v 0 0\n", SceneFormat::Obj).unwrap_err().to_string();
    assert!(syntax.contains("standard input:1"), "{syntax}");
    let options = LoadOptions::default().with_memory_limit(1 << 24);
    let endless = Scene::from_reader(std::io::repeat(b'v'), "endless", SceneFormat::Obj, &options);
    assert!(matches!(endless, Err(LoadError::Memory { .. })));
}

#[test]
fn a_given_format_replaces_the_extension() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.txt");
    fs::write(&path, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    assert!(Scene::open(&path).is_err());
    let options = LoadOptions::default().with_format(SceneFormat::Obj);
    assert_eq!(Scene::open_with(&path, &options).unwrap().geometry.mesh.triangles.len(), 1);
}

#[test]
fn built_in_scenes_go_by_name() {
    assert_eq!(Scene::open("builtin:gazebo").unwrap().name, "gazebo");
    assert!(error("builtin:gazibo").contains("available: gazebo"));
}
