//! What every built-in scene guarantees.

mod math;

use glam::Vec3;
use lightmesh_scene::{LightKind, LoadError, Mesh, Scene};

/// Name, triangles, lights, extent, and the hash of the mesh.
type Promise = (&'static str, usize, usize, Vec3, u64);

const PROMISES: [Promise; 3] = [
    ("gazebo", 300, 3, Vec3::new(30.0, 20.0, 40.0), 0xf615_e7d6_e8bb_3f13),
    ("childpark", 27_000, 2, Vec3::new(160.0, 120.0, 140.0), 0x1856_ad77_6080_c14b),
    ("garden", 234_000, 1, Vec3::new(20.0, 6.0, 28.0), 0x43f7_fa62_cc98_e04a),
];

fn scenes() -> Vec<(Promise, Scene)> {
    PROMISES.map(|promise| (promise, open(promise.0).expect("a built-in scene"))).to_vec()
}

fn open(query: &str) -> Result<Scene, LoadError> {
    Scene::open(format!("builtin:{query}"))
}

fn total_intensity(scene: &Scene) -> f32 {
    scene.lights.iter().map(|light| light.intensity.max_element()).sum()
}

/// FNV-1a over the bits of all arrays of a mesh.
fn hash(mesh: &Mesh) -> u64 {
    let vectors = mesh.positions.iter().chain(&mesh.normals).flat_map(|v| v.to_array()).map(f32::to_bits);
    let indices = mesh.triangles.iter().flatten().chain(&mesh.materials).copied();
    let step = |hash: u64, word: u32| {
        word.to_le_bytes().iter().fold(hash, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
    };
    vectors.chain(indices).fold(0xcbf2_9ce4_8422_2325, step)
}

#[test]
fn counts_are_those_of_the_thesis() {
    for ((name, triangles, lights, ..), scene) in scenes() {
        let excess = scene.geometry.mesh.triangles.len().abs_diff(triangles);
        assert!(excess * 50 <= triangles, "{name}: {}", scene.geometry.mesh.triangles.len());
        assert_eq!(scene.lights.len(), lights, "{name}");
        assert_eq!((scene.cameras.len(), scene.name.as_str()), (1, name));
    }
}

#[test]
fn sizes_are_those_of_the_thesis() {
    for ((name, _, _, size, _), scene) in scenes() {
        let ratio = scene.geometry.mesh.bounds().extent() / size;
        assert!((ratio - Vec3::ONE).abs().max_element() <= 0.1, "{name}: {ratio}");
    }
}

#[test]
fn every_machine_makes_the_same_bits() {
    for ((name, .., expected), scene) in scenes() {
        let hash = hash(&scene.geometry.mesh);
        assert_eq!(hash, expected, "{name}: {hash:#018x}; a change on purpose sets the new hash here");
    }
}

#[test]
fn triangles_are_sound() {
    for ((name, ..), scene) in scenes() {
        let mesh = &scene.geometry.mesh;
        assert_eq!(mesh.normals.len(), mesh.positions.len(), "{name}");
        assert_eq!(mesh.materials.len(), mesh.triangles.len(), "{name}");
        assert!(mesh.positions.iter().all(|position| position.is_finite()), "{name}");
        let sound = |normal: &Vec3| *normal == Vec3::ZERO || (normal.length() - 1.0).abs() < 1e-5;
        assert!(mesh.normals.iter().all(sound), "{name}");
        assert!(mesh.materials.iter().all(|&material| (material as usize) < scene.geometry.materials.len()), "{name}");
        for index in 0..mesh.triangles.len() {
            let [a, b, c] = mesh.corners(index);
            let longest = (b - a).length().max((c - a).length()).max((c - b).length());
            let area = 0.5 * (b - a).cross(c - a).length();
            assert!(area > 1e-4 * longest * longest, "{name}: triangle {index} {a} {b} {c}");
        }
    }
}

/// A smooth normal on the back of its face would light the face from behind.
#[test]
fn smooth_normals_point_out_of_their_faces() {
    for ((name, ..), scene) in scenes() {
        for index in 0..scene.geometry.mesh.triangles.len() {
            let [a, b, c] = scene.geometry.mesh.corners(index);
            let face = (b - a).cross(c - a).normalize();
            let normals =
                scene.geometry.mesh.triangles[index].map(|vertex| scene.geometry.mesh.normals[vertex as usize]);
            let outward = normals.iter().all(|&normal| normal == Vec3::ZERO || normal.dot(face) > 0.0);
            assert!(outward, "{name}: triangle {index} {a} {b} {c} {normals:?}");
        }
    }
}

#[test]
fn materials_reflect_no_more_than_they_receive() {
    for ((name, ..), scene) in scenes() {
        for material in &scene.geometry.materials {
            let sum = (material.kd + material.ks).max_element();
            assert!(material.kd.min_element() >= 0.0 && sum <= 1.3 && material.kd.max_element() < 1.0, "{name}");
            assert!(material.shininess >= 1.0, "{name}: {}", material.name);
        }
    }
}

#[test]
fn any_number_of_lights_shines_alike() {
    for name in ["gazebo", "childpark", "garden"] {
        let designed = total_intensity(&open(name).expect("a scene"));
        for count in [1, 2, 3, 5, 64] {
            let scene = open(&format!("{name}?lights={count}")).expect("a scene");
            assert_eq!(scene.lights.len(), count);
            assert!((total_intensity(&scene) - designed).abs() < 1e-3, "{name} {count}");
            let mut places: Vec<[u32; 3]> =
                scene.lights.iter().filter_map(|light| Some(light.position()?.to_array().map(f32::to_bits))).collect();
            places.sort_unstable();
            places.dedup();
            assert_eq!(places.len(), count, "{name}: two lights in one place");
        }
    }
}

#[test]
fn the_spread_can_be_chosen() {
    let spread = |query: &str| match open(query).expect("a scene").lights[0].kind {
        LightKind::Point { spread, .. } => spread,
        _ => panic!("not a point light"),
    };
    assert!(spread("gazebo") > 0.0);
    assert_eq!(spread("gazebo?spread=0.25&lights=2"), 0.25);
    assert_eq!(spread("gazebo?spread=0"), 0.0);
}

#[test]
fn mistakes_are_answered_with_what_is_known() {
    for (query, words) in [
        ("gazeboo", ["gazeboo", "childpark"]),
        ("", ["gazebo", "garden"]),
        ("garden?light=3", ["light", "lights, spread"]),
        ("garden?lights=0", ["lights", "1 to 256"]),
        ("garden?lights=257", ["257", "1 to 256"]),
        ("garden?lights=two", ["two", "1 to 256"]),
        ("garden?lights", ["lights", "1 to 256"]),
        ("garden?spread=-1", ["-1", "0 or above"]),
        ("garden?spread=nan", ["nan", "0 or above"]),
        ("garden?lights=2&lights=3", ["twice", "once"]),
    ] {
        let message = open(query).expect_err(query).to_string();
        assert!(words.iter().all(|word| message.contains(word)), "{query}: {message}");
    }
}
