use glam::Vec3;
use lightmesh_memory::Budget;
use lightmesh_render::internals::prepared::{BYTES_TO_BUILD, center_and_sun_distance};
use lightmesh_render::{Acceleration, PreparedGeometry, RenderError, Unobserved};
use lightmesh_scene::{Bounds, Geometry, Mesh};

#[test]
fn suns_are_beyond_all_corners_and_stay_while_bounds_change_little() {
    let bounds = |min: [f32; 3], max: [f32; 3]| Bounds { min: min.into(), max: max.into() };
    for (min, max) in
        [([-1.0; 3], [1.0; 3]), ([100.0, 0.0, -3.0], [101.0, 1e-3, 7.0]), ([1e6, -4.0, 5.0], [1e6 + 8.0, 1.0, 9.0])]
    {
        let bounds = bounds(min, max);
        let (middle, far) = center_and_sun_distance(&bounds);
        for corner in 0..8 {
            let pick = |axis: usize| if corner >> axis & 1 == 0 { min[axis] } else { max[axis] };
            let distance = Vec3::from([0, 1, 2].map(pick)).distance(middle);
            assert!(distance < 0.95 * far, "{bounds:?}: {distance} and {far}");
        }
        assert!(far <= 3.001 * bounds.diagonal(), "{bounds:?}: {far}");
    }
    let park = center_and_sun_distance(&bounds([-90.0, 0.0, -90.0], [90.0, 30.0, 90.0]));
    let with_a_ball = center_and_sun_distance(&bounds([-90.0, 0.0, -90.0], [93.0, 30.0, 91.0]));
    assert_eq!(park, with_a_ball);
}

#[test]
fn triangles_that_do_not_fit_are_refused_before_anything_is_built() {
    let corners = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
    let mesh =
        Mesh { positions: corners, triangles: vec![[0, 1, 2]; 5000], materials: vec![0; 5000], ..Mesh::default() };
    let geometry = Geometry { mesh, materials: vec![Default::default()], ..Geometry::default() };
    let within = |limit| PreparedGeometry::new(&geometry, &Acceleration::Bvh, Budget::new(limit), &Unobserved);
    assert!(within(None).is_ok());
    match within(Some(1)).err() {
        Some(RenderError::BuildMemory { triangles: 5000, short }) => {
            assert_eq!(short.needed, 5000 * BYTES_TO_BUILD)
        }
        other => panic!("{other:?}"),
    }
}
