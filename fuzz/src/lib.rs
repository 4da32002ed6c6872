//! What the fuzz targets share: files in memory, and what must hold of everything that is read from them.
//!
//! Targets go through files, as users do, so that the library needs no second way in for them.

use std::path::{Path, PathBuf};

use lightmesh::Scene;
use lightmesh::scene::{Mesh, Up};
use tempfile::TempDir;

/// Where Linux keeps files in memory.
const MEMORY: &str = "/dev/shm";

/// A folder of its own for one input.
pub struct Folder(TempDir);

impl Folder {
    /// An empty one, in memory where the system has such a place.
    #[expect(clippy::new_without_default, reason = "it makes a folder on the disk")]
    pub fn new() -> Folder {
        let mut builder = tempfile::Builder::new();
        builder.prefix("lightmesh-fuzz-");
        let folder = builder.tempdir_in(MEMORY).or_else(|_| builder.tempdir());
        Folder(folder.expect("a temporary folder"))
    }

    /// Writes a file and gives its path.
    pub fn write(&self, name: &str, bytes: &[u8]) -> PathBuf {
        let path = self.0.path().join(name);
        std::fs::write(&path, bytes).expect("room for a small file");
        path
    }
}

/// Reads a scene of one file.
pub fn read_alone(name: &str, bytes: &[u8]) {
    let folder = Folder::new();
    read(&folder.write(name, bytes));
}

/// Reads a scene and asks of it what the program asks. Panics where an answer cannot be right.
pub fn read(path: &Path) {
    match Scene::open(path) {
        Ok(scene) => check(&scene),
        Err(error) => {
            let (message, folder) = (error.to_string(), path.parent().expect("a folder"));
            assert!(message.contains(&*folder.to_string_lossy()), "the file is not named: {message}");
        }
    }
}

fn check(scene: &Scene) {
    check_mesh(&scene.mesh, scene.materials.len());
    for texture in &scene.textures {
        let [width, height] = texture.size.map(u64::from);
        assert!(width > 0 && height > 0 && texture.texels.len() as u64 == width * height);
    }
    for texture in scene.materials.iter().filter_map(|material| material.texture) {
        assert!((texture.texture as usize) < scene.textures.len());
    }
    for material in &scene.materials {
        let lobes = [material.ks, material.ks_tinted, material.emission, material.emission_tinted];
        assert!(lobes.iter().chain([&material.ka, &material.kd]).all(|color| color.is_finite()), "{material:?}");
    }
    assert!(scene.cameras.iter().all(|camera| camera.position.is_finite() && camera.direction.is_normalized()));
    assert!(scene.lights.iter().all(|light| light.intensity.is_finite()));
    assert!(scene.lights.iter().filter_map(|light| light.position()).all(|position| position.is_finite()));
    let info = scene.info();
    assert_eq!(info.triangles, scene.mesh.triangles.len());
    assert!(!info.to_string().is_empty());
    let camera = scene.default_camera(Up::Y);
    scene.default_lights(&camera);
}

fn check_mesh(mesh: &Mesh, materials: usize) {
    let vertices = mesh.positions.len();
    assert!(mesh.triangles.as_flattened().iter().all(|&vertex| (vertex as usize) < vertices));
    assert_eq!(mesh.materials.len(), mesh.triangles.len());
    assert!(mesh.materials.iter().all(|&material| (material as usize) < materials));
    for count in [mesh.normals.len(), mesh.uvs.len(), mesh.colors.len()] {
        assert!(count == 0 || count == vertices, "{count} of {vertices}");
    }
    assert!(mesh.positions.iter().all(|position| position.is_finite()));
    assert!(mesh.normals.iter().all(|normal| normal.is_finite()));
}
