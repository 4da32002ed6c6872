//! Shared code of the fuzz targets: files in memory, and properties of everything read from them.
//!
//! Targets use files, like users, so that the library needs no separate entry points for them.

use std::path::{Path, PathBuf};

use lightmesh::Scene;
use lightmesh::scene::{CreaseAngle, LoadOptions, Mesh, OpacityMode, Up};
use tempfile::TempDir;

/// Folder of the scene in the temporary one.
const INNER: &str = "scene";
/// Folder of files in memory on Linux.
const MEMORY: &str = "/dev/shm";

/// What stands in a file outside of the scene's folder. No message may quote it.
const SECRET: &str = "qz7-4f1e-kept-outside";
/// Names of links to that file in the folder.
const LINKS: [&str; 4] = ["link.obj", "link.mtl", "link.png", "link.bin"];
/// Larger messages are no sentences.
const LONGEST: usize = 20_000;
/// Warnings, and one about those that are not shown.
const MAX_WARNINGS: usize = 101;

/// A separate folder for one input. Links in it lead out to another file.
pub struct Folder(TempDir);

impl Folder {
    /// An empty folder, in memory if the system supports it.
    #[expect(clippy::new_without_default, reason = "it creates a folder")]
    pub fn new() -> Folder {
        let mut builder = tempfile::Builder::new();
        builder.prefix("lightmesh-fuzz-");
        let folder = builder.tempdir_in(MEMORY).or_else(|_| builder.tempdir()).expect("a temporary folder");
        let (inner, secret) = (folder.path().join(INNER), folder.path().join("secret"));
        std::fs::create_dir(&inner).expect("a folder");
        std::fs::write(secret, SECRET).expect("space for a small file");
        #[cfg(unix)]
        for link in LINKS {
            std::os::unix::fs::symlink("../secret", inner.join(link)).expect("a link");
        }
        Folder(folder)
    }

    /// Writes a file and returns its path. The secret is taken out of it: the fuzzer reads it from comparisons, and a file may be
    /// quoted.
    pub fn write(&self, name: &str, bytes: &[u8]) -> PathBuf {
        let path = self.0.path().join(INNER).join(name);
        let mut bytes = bytes.to_vec();
        while let Some(at) = bytes.windows(SECRET.len()).position(|window| window == SECRET.as_bytes()) {
            bytes.drain(at..at + SECRET.len());
        }
        std::fs::write(&path, bytes).expect("space for a small file");
        path
    }
}

/// Reads a scene from a single file.
pub fn read_alone(name: &str, bytes: &[u8]) {
    let folder = Folder::new();
    read(&folder.write(name, bytes));
}

/// Reads a scene and queries it like the program, without and with smooth normals. Panics if a result is invalid.
pub fn read(path: &Path) {
    match Scene::open(path) {
        Ok(scene) => {
            check(&scene);
            check_smooth(&scene, path);
        }
        Err(error) => {
            let (message, folder) = (error.to_string(), path.parent().expect("a folder"));
            assert!(message.contains(&*folder.to_string_lossy()), "the file is not named: {message}");
            check_message(&message);
        }
    }
}

/// Smooth normals change nothing else.
fn check_smooth(flat: &Scene, path: &Path) {
    let options = LoadOptions::default().with_smooth(CreaseAngle::default());
    let smooth = Scene::open_with(path, &options).expect("what opens without normals opens with them");
    check(&smooth);
    let (flat, smooth) = (&flat.geometry.mesh, &smooth.geometry.mesh);
    assert_eq!((smooth.triangles.len(), &smooth.materials), (flat.triangles.len(), &flat.materials));
    assert_eq!(smooth.objects, flat.objects);
    assert!((0..flat.triangles.len()).all(|triangle| smooth.corners(triangle) == flat.corners(triangle)));
}

/// A message is of a size to be read, and tells nothing of files outside of the folder.
pub fn check_message(message: &str) {
    assert!(message.len() <= LONGEST && !message.contains(SECRET), "{message}");
}

/// Cameras and lights are usable.
fn check_views(scene: &Scene) {
    assert!(scene.cameras.iter().all(|camera| camera.position.is_finite() && camera.direction.is_normalized()));
    assert!(scene.lights.iter().all(|light| light.intensity.is_finite()));
    assert!(scene.lights.iter().filter_map(|light| light.position()).all(|position| position.is_finite()));
}

fn check(scene: &Scene) {
    assert!(scene.warnings.len() <= MAX_WARNINGS, "{:?}", scene.warnings);
    scene.warnings.iter().for_each(|warning| check_message(warning));
    check_mesh(&scene.geometry.mesh, scene.geometry.materials.len());
    for texture in scene.geometry.textures.iter() {
        let [width, height] = texture.size.map(u64::from);
        assert!(width > 0 && height > 0 && texture.texels.len() as u64 == width * height);
    }
    for texture in scene.geometry.materials.iter().filter_map(|material| material.texture) {
        assert!((texture.texture as usize) < scene.geometry.textures.len());
    }
    for material in &scene.geometry.materials {
        let lobes = [material.ks, material.ks_tinted, material.emission, material.emission_tinted];
        let all = || lobes.iter().chain([&material.ka, &material.kd]);
        assert!(all().all(|color| color.is_finite() && color.min_element() >= 0.0), "{material:?}");
        assert!((material.ks + material.ks_tinted).max_element() < 1.00001, "{material:?}");
        if let Some(opacity) = material.opacity {
            let numbers = match opacity.mode {
                OpacityMode::Mask { cutoff } => vec![opacity.factor, cutoff],
                OpacityMode::Blend { filter } => [vec![opacity.factor], filter.to_array().to_vec()].concat(),
            };
            assert!(numbers.iter().all(|number| number.is_finite() && *number >= 0.0), "{material:?}");
            let texture = opacity.texture.map(|uses| uses.texture as usize);
            assert!(texture.is_none_or(|texture| texture < scene.geometry.textures.len()), "{material:?}");
        }
    }
    check_views(scene);
    for time in [-1.0, 0.0, 0.7, 1e9] {
        let moved = scene.at(time);
        check_views(&moved);
        let sizes = |scene: &Scene| [scene.geometry.mesh.triangles.len(), scene.geometry.mesh.positions.len()];
        assert_eq!(sizes(&moved), sizes(scene));
    }
    let info = scene.info();
    assert_eq!(info.triangles, scene.geometry.mesh.triangles.len());
    assert!(!info.to_string().is_empty());
    let camera = scene.default_camera(Up::Y);
    scene.default_lights(&camera);
}

fn check_mesh(mesh: &Mesh, materials: usize) {
    let vertices = mesh.positions.len();
    assert!(mesh.triangles.as_flattened().iter().all(|&vertex| (vertex as usize) < vertices));
    assert_eq!(mesh.materials.len(), mesh.triangles.len());
    assert!(mesh.materials.iter().all(|&material| (material as usize) < materials));
    let (starts, objects) = mesh.objects.runs();
    assert!(starts.is_sorted_by(|a, b| a < b) && starts.first().is_none_or(|&first| first == 0));
    assert!(starts.len() == objects.len() && objects.iter().all(|&object| (object as usize) < mesh.objects.count()));
    for count in [mesh.normals.len(), mesh.uvs.len(), mesh.colors.len(), mesh.opacities.len()] {
        assert!(count == 0 || count == vertices, "{count} of {vertices}");
    }
    assert!(mesh.positions.iter().all(|position| position.is_finite()));
    assert!(mesh.normals.iter().all(|normal| normal.is_finite()));
    assert!(mesh.opacities.iter().all(|opacity| (0.0..=1.0).contains(opacity)));
}
