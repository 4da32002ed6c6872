use glam::Vec3;
use lightmesh_scene::{Camera, Material, Scene, SceneBuilder, Sky, SkyKind, Up};

/// A box that is 3 units long.
fn scene(kind: SkyKind, up: Up) -> Scene {
    let mut scene = SceneBuilder::new().finish_scene("box");
    let geometry = scene.geometry_mut();
    geometry.materials.push(Material::default());
    let mesh = &mut geometry.mesh;
    mesh.positions =
        (0..8).map(|i: u32| Vec3::new(3.0 * (i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32)).collect();
    mesh.triangles = vec![[0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5], [0, 1, 5], [0, 5, 4]];
    mesh.triangles.extend([[2, 6, 7], [2, 7, 3], [0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6]]);
    mesh.materials = vec![0; mesh.triangles.len()];
    scene.lights.surround(Sky::new(kind).surroundings(up).unwrap());
    scene
}

fn clear() -> SkyKind {
    Sky::clear(Sky::SUN).kind
}

/// Where a point is in the image: from -1 to 1 to the right and upwards.
fn place(camera: &Camera, way: Vec3, aspect: f32) -> [f32; 2] {
    let (right, up, forward) = camera.basis();
    let tangent = 20f32.to_radians().tan() * way.dot(forward);
    [way.dot(right) / (tangent * aspect), way.dot(up) / tangent]
}

#[test]
fn the_horizon_is_in_the_upper_part_and_the_model_in_the_image() {
    for (up, aspect) in [(Up::Y, 1.0), (Up::Z, 1.0), (Up::Y, 1.6), (Up::Y, 0.6)] {
        let mut scene = scene(clear(), up);
        let added = scene.complete_outdoors(up, aspect);
        assert!(added.camera && added.outdoors && !added.lights && !added.studio);
        let camera = &scene.cameras[0];
        let level = camera.direction - camera.direction.dot(up.axis()) * up.axis();
        let [_, horizon] = place(camera, level, aspect);
        assert!((0.4..0.8).contains(&horizon), "{horizon}");
        let corners = scene.geometry.mesh.positions[..8].iter();
        let places: Vec<[f32; 2]> = corners.map(|&corner| place(camera, corner - camera.position, aspect)).collect();
        let most = places.iter().flatten().fold(0.0, |most: f32, one| most.max(one.abs()));
        assert!((most - 0.8).abs() < 1e-3, "{most}: it fills four fifths of the image");
        assert_eq!(scene.geometry.materials.iter().filter(|material| material.catcher).count(), 1);
    }
}

#[test]
fn the_ground_fades_into_the_sky_and_the_sky_stays() {
    let mut scene = scene(clear(), Up::Y);
    let before = scene.lights.environment.clone().unwrap();
    scene.complete_outdoors(Up::Y, 1.0);
    let after = scene.lights.environment.unwrap();
    let [width, height] = before.size().map(|side| side as usize);
    assert_eq!((after.size(), after.sun()), (before.size(), before.sun()));
    let half = width * height / 2;
    assert_eq!(after.texels()[..half], before.texels()[..half]);
    for column in [0, width / 3, width - 1] {
        let (sky, ground) = (before.texels()[half - width + column], before.texels()[half + column]);
        // By how much each row is sky.
        let share = |row: usize| {
            let shown = after.texels()[half + row * width + column];
            (shown[2] - ground[2]) / (sky[2] - ground[2])
        };
        assert!(share(0) > 0.9 && share(height / 2 - 1) < 1e-3, "{} {}", share(0), share(height / 2 - 1));
        assert!((1..height / 2).all(|row| share(row) <= share(row - 1) + 1e-5), "haze grows with distance");
        // 4° below the horizon.
        assert!((share(height * 4 / 180) - 0.37).abs() < 0.05, "{}", share(height * 4 / 180));
    }
}

#[test]
fn a_uniform_sky_stays_uniform_and_a_camera_stays_where_it_is() {
    let mut uniform = scene(SkyKind::Uniform { color: Vec3::splat(0.5) }, Up::Y);
    assert!(uniform.complete_outdoors(Up::Y, 1.0).outdoors);
    assert_eq!(uniform.lights.environment.unwrap().texels(), [[0.5; 3]]);
    let camera = Camera::look_at(Vec3::splat(5.0), Vec3::ZERO, Vec3::Y, 40.0).unwrap();
    let mut own = scene(clear(), Up::Y).with_cameras(vec![camera]);
    let before = own.clone();
    let added = own.complete_outdoors(Up::Y, 1.0);
    assert!(added.outdoors && !added.camera && !added.indoors);
    assert_eq!(own.cameras, before.cameras);
    assert_eq!(own.geometry.mesh.triangles.len(), 14, "a ground");
    // From below, the ground would hide the model.
    let below = Camera::look_at(Vec3::new(1.0, -5.0, 0.0), Vec3::ZERO, Vec3::X, 40.0).unwrap();
    let mut own = scene(clear(), Up::Y).with_cameras(vec![below]);
    assert!(!own.complete_outdoors(Up::Y, 1.0).outdoors);
    assert_eq!((own.lights, own.geometry.mesh.triangles.len()), (before.lights, 12));
}
