use glam::Vec3;
use lightmesh_scene::{Added, Camera, Light, LightKind, Lighting, Material, Scene, SceneBuilder, Up};

/// A box on the ground, seen by no camera.
fn scene() -> Scene {
    let mut scene = SceneBuilder::new().finish_scene("box");
    let geometry = scene.geometry_mut();
    geometry.materials.push(Material::default());
    let mesh = &mut geometry.mesh;
    mesh.positions = (0..8).map(|i: u32| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32)).collect();
    // Counter-clockwise seen from outside: the left and the right side, the lower and the upper, the back and the front.
    mesh.triangles = vec![[0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5], [0, 1, 5], [0, 5, 4]];
    mesh.triangles.extend([[2, 6, 7], [2, 7, 3], [0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6]]);
    mesh.materials = vec![0; mesh.triangles.len()];
    scene
}

fn completed(mut scene: Scene, up: Up) -> (Scene, Added) {
    let added = scene.complete_with(Lighting::Studio, up, 1.0);
    (scene, added)
}

#[test]
fn a_studio_has_a_key_light_at_the_upper_left_surroundings_and_a_ground() {
    for up in [Up::Y, Up::Z] {
        let (scene, added) = completed(scene(), up);
        assert!(added.studio && added.camera && added.lights && !added.lights_inside);
        let [key] = &scene.lights.list[..] else { panic!("{:?}", scene.lights.list) };
        let LightKind::Sphere { position, radius } = key.kind else { panic!("{key:?}") };
        let (camera, center) = (&scene.cameras[0], scene.geometry.mesh.bounds().center());
        let (right, ..) = camera.basis();
        let way = position - Vec3::splat(0.5);
        assert!(way.dot(right) < -radius && way.dot(up.axis()) > 1.0 && way.dot(camera.direction) < 0.0, "{center}");
        assert_eq!(scene.geometry.materials.iter().filter(|material| material.catcher).count(), 1);
        assert_eq!((scene.geometry.check(), scene.lights.ambient), (Ok(()), None));
        // White that faces up is not clipped, and gets more from the key light than from around; below it is darker.
        let around = scene.lights.environment.as_ref().unwrap();
        let [above, below] = [1.0, -1.0].map(|side| around.irradiance(side * up.axis()).x / std::f32::consts::PI);
        let by_key = key.intensity.x * way.normalize().dot(up.axis());
        assert!(
            above + by_key <= 1.0 && by_key > 0.9 * above && below < above && below > 0.25 * above,
            "{above} {by_key} {below}"
        );
        // Metals mirror what is bright and what is dark.
        let brightness = || around.texels().iter().map(|texel| texel[0]);
        let (least, most) = (brightness().fold(f32::INFINITY, f32::min), brightness().fold(0.0, f32::max));
        assert!(least > 0.0 && most > 12.0 * least, "{least} {most}");
    }
}

#[test]
fn the_studio_turns_with_the_camera_and_stands_upright() {
    let seen_from = |eye: Vec3, up: Vec3| {
        let camera = Camera::look_at(eye, Vec3::splat(0.5), up, 40.0).unwrap();
        let (scene, added) = completed(scene().with_cameras(vec![camera]), Up::Y);
        assert!(added.studio, "{eye}");
        let position = scene.lights.list[0].position().unwrap();
        assert!(position.is_finite() && position.y > 1.0, "{eye}: {position}");
        position
    };
    let [front, back] = [1.0, -1.0].map(|side| seen_from(Vec3::new(0.5, 1.5, 0.5 + 4.0 * side), Vec3::Y));
    assert!((front - Vec3::splat(0.5) - (back - Vec3::splat(0.5)) * Vec3::new(-1.0, 1.0, -1.0)).length() < 1e-4);
    // From straight above, and lying on a side.
    seen_from(Vec3::new(0.5, 6.0, 0.5), Vec3::Z);
    seen_from(Vec3::new(0.5, 1.5, 5.0), Vec3::X);
}

#[test]
fn a_studio_joins_only_where_nothing_gives_light() {
    let (bare, _) = completed(scene(), Up::Y);
    type Change = fn(&mut Scene);
    let lit: [(&str, Change); 5] = [
        ("lights of its own", |scene| scene.lights.list.push(Light::point(Vec3::splat(9.0)))),
        ("surfaces that emit light", |scene| scene.geometry_mut().materials[0].emission = Vec3::ONE),
        ("lights that were chosen, even if there are none", |scene| scene.lights.chosen = true),
        ("ambient light of its own", |scene| scene.lights.ambient = Some(Vec3::ONE)),
        ("a background", |scene| scene.lights.background = Some(Vec3::ZERO)),
    ];
    assert_eq!(scene().beside_studio(), None);
    for (what, change) in lit {
        let mut scene = scene();
        change(&mut scene);
        assert_eq!(scene.beside_studio(), Some(what));
        let mut plain = scene.clone();
        plain.complete(Up::Y);
        let (scene, added) = completed(scene, Up::Y);
        assert!(!added.studio, "{what}");
        assert_eq!((&scene.lights, &scene.cameras), (&plain.lights, &plain.cameras), "{what}");
    }
    let mut again = bare.clone();
    assert_eq!(again.complete_with(Lighting::StudioAnywhere, Up::Y, 1.0), Added::default());
    assert_eq!(again.lights, bare.lights);
}

#[test]
fn the_default_is_a_key_light_and_a_fill_light() {
    let mut scene = scene();
    assert!(!scene.complete(Up::Y).studio);
    assert_eq!((scene.lights.len(), scene.lights.environment.is_none()), (2, true));
}
