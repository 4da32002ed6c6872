use glam::{DVec3, Vec2, Vec3};
use lightmesh_scene::internals::camera::{LARGEST_SHIFT, upper_edge};
use lightmesh_scene::{Camera, Fov, Projection};

#[test]
fn the_edges_of_the_image_are_at_one() {
    let origin = DVec3::new(1000.0, 0.0, -7.0);
    let camera = Camera::look_at(Vec3::new(1.0, 2.0, 3.0), Vec3::new(1.0, 2.0, -5.0), Vec3::Y, 90.0).unwrap();
    let eye = origin + DVec3::new(1.0, 2.0, 3.0);
    let seen = camera.from_world(origin).transform_point3(eye + DVec3::new(0.5, -0.25, -4.0));
    assert!((seen - DVec3::new(0.5, -0.25, -4.0)).length() < 1e-6, "{seen}");
    // At a distance of 4, the image with an angle of 90° is 8 units high and 16 wide.
    let orthographic = camera.clone().with_projection(Projection::Orthographic { height: 8.0 });
    for camera in [camera, orthographic] {
        let corner = camera.from_world_to_image(origin, 2.0).project_point3(eye + DVec3::new(8.0, -4.0, -4.0));
        assert!((corner.truncate() - glam::DVec2::new(1.0, -1.0)).length() < 1e-6, "{corner}");
    }
}

#[test]
fn a_shift_moves_the_edges_of_the_image() {
    let origin = DVec3::new(1000.0, 0.0, -7.0);
    let camera = Camera::look_at(Vec3::new(1.0, 2.0, 3.0), Vec3::new(1.0, 2.0, -5.0), Vec3::Y, 90.0).unwrap();
    let eye = origin + DVec3::new(1.0, 2.0, 3.0);
    let orthographic = camera.clone().with_projection(Projection::Orthographic { height: 8.0 });
    for camera in [camera, orthographic].map(|camera| camera.with_shift([0.5, -0.25])) {
        // At a distance of 4 the image is 8 units high: its middle is 4 units to the right and 2 below.
        let seen = |x, y| camera.from_world_to_image(origin, 2.0).project_point3(eye + DVec3::new(x, y, -4.0));
        for (at, place) in [([4.0, -2.0], [0.0, 0.0]), ([12.0, -6.0], [1.0, -1.0]), ([-4.0, 2.0], [-1.0, 1.0])] {
            let found = seen(at[0], at[1]).truncate();
            assert!((found - glam::DVec2::from(place)).length() < 1e-6, "{found}, not {place:?}");
        }
        let (from, direction) = camera.middle(2.0);
        let met = from + 4.0 * direction - camera.position;
        assert!(met.distance(Vec3::new(4.0, -2.0, -4.0)) < 1e-5, "{met}");
    }
}

#[test]
fn a_shift_without_sense_becomes_the_nearest_with_some() {
    let camera = Camera::look_to(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 50.0).unwrap();
    let shifted = |x, y| camera.clone().with_shift([x, y]).shift;
    assert_eq!(shifted(f32::NAN, f32::INFINITY), Vec2::new(0.0, LARGEST_SHIFT));
    assert_eq!(shifted(-1e9, 0.1), Vec2::new(-LARGEST_SHIFT, 0.1));
}

#[test]
fn a_camera_sees_some_depths() {
    let camera = Camera::look_to(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 50.0).unwrap();
    assert_eq!([camera.near, camera.far], [0.0, f32::INFINITY]);
    let part = camera.clone().with_clip(0.5, 9.0).unwrap();
    assert_eq!([part.near, part.far], [0.5, 9.0]);
    for (near, far) in
        [(-1.0, 2.0), (2.0, 2.0), (3.0, 2.0), (f32::NAN, 2.0), (0.0, f32::NAN), (f32::INFINITY, f32::INFINITY)]
    {
        let error = camera.clone().with_clip(near, far).unwrap_err();
        assert!(error.to_string().contains(&format!("{near} and {far}")), "{error}");
    }
}

#[test]
fn the_upper_edge_is_up_or_the_back_of_a_plan() {
    assert_eq!(upper_edge(DVec3::NEG_Z, DVec3::Y), DVec3::Y);
    assert_eq!(upper_edge(DVec3::NEG_Y, DVec3::Y), DVec3::NEG_Z);
    assert_eq!(upper_edge(DVec3::NEG_Z, DVec3::Z), DVec3::Y);
    assert_eq!(upper_edge(DVec3::X, DVec3::X), DVec3::NEG_Z);
    let slanted = upper_edge(DVec3::new(0.0, -1.0, -1.0).normalize(), DVec3::Y);
    assert!((slanted - DVec3::new(0.0, 1.0, -1.0).normalize()).length() < 1e-12);
}

#[test]
fn a_camera_looks_at_its_target() {
    let camera = Camera::look_at(Vec3::new(1.0, 2.0, 7.0), Vec3::new(1.0, 2.0, -3.5), 3.0 * Vec3::Y, 45.0).unwrap();
    let (right, up, forward) = camera.basis();
    assert_eq!([right, up, forward], [Vec3::X, Vec3::Y, Vec3::NEG_Z]);
    assert_eq!(camera.projection, Projection::Perspective(Fov::Vertical(45.0)));
}

#[test]
fn straight_down_has_axes_too() {
    for up in [Vec3::X, Vec3::Y, Vec3::NEG_Y, Vec3::Z] {
        let camera = Camera::look_to(Vec3::ZERO, -up, up, 45.0).unwrap();
        let (right, above, forward) = camera.basis();
        assert!(right.is_normalized() && above.is_normalized() && forward == -up, "{up}: {camera:?}");
    }
}

#[test]
fn what_shows_nothing_is_refused() {
    let message = |target, up, vfov| Camera::look_at(Vec3::ONE, target, up, vfov).unwrap_err().to_string();
    assert!(message(Vec3::ONE, Vec3::Y, 45.0).contains("view direction [0, 0, 0] has no length"));
    assert!(message(Vec3::NAN, Vec3::Y, 45.0).contains("view direction"));
    assert!(message(Vec3::X, Vec3::ZERO, 45.0).contains("up vector [0, 0, 0]"));
    for vfov in [0.0, -1.0, 180.0, f32::NAN] {
        assert!(message(Vec3::X, Vec3::Y, vfov).contains(&format!("field of view of {vfov} degrees")));
    }
}
