//! The names of objects in files of all formats.

use std::fs;
use std::path::PathBuf;

use lightmesh_scene::{LoadOptions, Scene, Up};

/// A folder with these files.
struct Place(tempfile::TempDir);

impl Place {
    fn new(files: &[(&str, &str)]) -> Place {
        let folder = tempfile::tempdir().unwrap();
        files.iter().for_each(|(name, text)| fs::write(folder.path().join(name), text).unwrap());
        Place(folder)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// The object of each triangle of a file.
    fn objects(&self, name: &str) -> Vec<String> {
        objects(&Scene::open(self.path(name)).unwrap())
    }
}

fn objects(scene: &Scene) -> Vec<String> {
    let mesh = &scene.geometry.mesh;
    (0..mesh.triangles.len() as u32).map(|triangle| mesh.objects.name(mesh.objects.of(triangle)).to_owned()).collect()
}

const POINTS: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n";
const STL: &str = "solid tip\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n";
const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n\
                   property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
/// Two triangles, of which one is a strip of nothing; the mesh is shown by three nodes.
const GLTF: &str = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
    "nodes": [{"mesh": 0, "name": "left"}, {"mesh": 0}, {"mesh": 1}],
    "meshes": [{"name": "wing", "primitives": [{"attributes": {"POSITION": 0}}]}, {"primitives": [{"attributes": {"POSITION": 0}}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}"#;

#[test]
fn obj_files_name_objects_or_groups() {
    let named = format!("{POINTS}o a b\ng x\nf 1 2 3\nf 2 3 4\no c\nf 1 2 4\ng y\nf 1 3 4\no a b\nf 1 2 3\n");
    let groups = format!("{POINTS}f 1 2 3\ng left\nf 1 2 4\ng right\ng\nf 1 3 4\n");
    let none = format!("{POINTS}f 1 2 3\n");
    let place = Place::new(&[("named.obj", &*named), ("groups.obj", &*groups), ("none.obj", &*none)]);
    assert_eq!(place.objects("named.obj"), ["a b", "a b", "c", "c", "a b"]);
    assert_eq!(place.objects("groups.obj"), ["unnamed", "left", "unnamed"]);
    assert_eq!(place.objects("none.obj"), ["none"]);
}

#[test]
fn names_stay_where_normals_are_added_and_triangles_left_out() {
    let text = format!("{POINTS}v nan 0 0\no a\nf 1 2 3\nf 1 2 5\no gone\nf 1 3 5\no b\nf 1 3 5\nf 2 3 4\n");
    let place = Place::new(&[("a.obj", &*text)]);
    for options in
        [LoadOptions::default(), LoadOptions::default().with_smooth(lightmesh_scene::CreaseAngle::from_degrees(40.0))]
    {
        let mut scene = Scene::open_with(place.path("a.obj"), &options).unwrap();
        assert_eq!(objects(&scene), ["a", "b"]);
        scene.add_ground(Up::Y);
        assert_eq!(objects(&scene), ["a", "b", "ground", "ground"]);
    }
}

#[test]
fn gltf_files_name_nodes_or_meshes() {
    let place = Place::new(&[("a.gltf", GLTF)]);
    assert_eq!(place.objects("a.gltf"), ["left", "wing", "node 2"]);
}

#[test]
fn other_models_are_called_after_their_files() {
    let place = Place::new(&[("tip.stl", STL), ("fan.ply", PLY)]);
    assert_eq!(place.objects("tip.stl"), ["tip"]);
    assert_eq!(place.objects("fan.ply"), ["fan"]);
}

#[test]
fn toml_scenes_name_meshes_and_solids() {
    let scene = r#"
        [[mesh]]
        file = "tip.stl"
        [[mesh]]
        file = "fan.ply"
        name = "roof"
        [[mesh]]
        file = "a.gltf"
        [[mesh]]
        file = "a.gltf"
        name = "bird"
        [[triangle]]
        vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
        [[triangle]]
        vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
        name = "sail"
        [[triangle]]
        vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
        [[plane]]
        point = [0, 0, 0]
        normal = [0, 1, 0]
        size = [1, 1]
    "#;
    let place = Place::new(&[("tip.stl", STL), ("fan.ply", PLY), ("a.gltf", GLTF), ("scene.toml", scene)]);
    let expected = "tip,roof,left,wing,node 2,bird,bird,bird,triangle 1,sail,triangle 3,plane 1,plane 1";
    assert_eq!(place.objects("scene.toml").join(","), expected);
}

#[test]
fn built_in_scenes_name_their_parts() {
    for (name, object) in [("gazebo", "pavilion"), ("childpark", "sandpit"), ("garden", "fountain")] {
        let scene = Scene::open(format!("builtin:{name}")).unwrap();
        let objects = &scene.geometry.mesh.objects;
        assert!(objects.names().any(|name| name == object) && objects.names().all(|name| name != "unnamed"), "{name}");
        // Each name is that of some triangles.
        let mut used: Vec<u32> = objects.runs().1.to_vec();
        used.sort_unstable();
        used.dedup();
        assert_eq!(used.len(), objects.count(), "{name}");
    }
}
