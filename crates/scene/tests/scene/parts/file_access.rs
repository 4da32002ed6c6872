use std::path::{Path, PathBuf};

use lightmesh_scene::LoadOptions;
use lightmesh_scene::internals::file_access::FileAccess;

#[test]
fn references_stay_in_the_scenes_folder() {
    let beside = |scene: &str, source: &str, name: &str| {
        FileAccess::new(Path::new(scene), &LoadOptions::default()).path_beside(Path::new(source), name).ok()
    };
    let inside = |path: &str| Some(PathBuf::from(path));
    assert_eq!(beside("room.toml", "room.toml", r".\maps\oak.png"), inside("./maps/oak.png"));
    assert_eq!(beside("a/room.toml", "a/parts/door.gltf", "../oak.png"), inside("a/parts/../oak.png"));
    assert_eq!(beside("../a/room.toml", "../a/room.toml", "oak.png"), inside("../a/oak.png"));
    for name in ["../oak.png", "/etc/passwd", "maps/../../oak.png", r"C:\oak.png", "https://example.org/oak.png"] {
        assert_eq!(beside("room.toml", "room.toml", name), None, "{name}");
        assert_eq!(beside("../room.toml", "../room.toml", name), None, "{name}");
    }
    let free = FileAccess::new(Path::new("a/room.toml"), &LoadOptions::default().with_allow_outside(true));
    let path = |name| free.path_beside(Path::new("a/room.toml"), name).ok();
    assert_eq!([path("../oak.png"), path("http://oak.png")], [inside("a/../oak.png"), None]);
}
