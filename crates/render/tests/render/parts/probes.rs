use glam::Vec3;
use lightmesh_layout::constants::GAMMA_32;
use lightmesh_render::{Acceleration, GivenPoints, PreparedScene, SurfacePoint, Unobserved};

#[test]
fn a_probe_is_the_point_with_its_normal() {
    let scene = lightmesh_testkit::half_plane();
    let scene = PreparedScene::new(&scene, &Acceleration::Bvh, &Unobserved).unwrap();
    let points: Vec<Vec3> = (0..3000).map(|i| Vec3::new(0.3, -0.7, 1.1) * i as f32 / 10.0).collect();
    let normals: Vec<Vec3> = (0..3000).map(|i| Vec3::new(1.0, i as f32 - 7.0, -0.3)).collect();
    let given = GivenPoints::new(&scene, &points, &normals).unwrap();
    assert_eq!((given.rows(), given.range(&(2..3))), (3, 2048..3000));
    let wave = given.part(&(1..3));
    assert_eq!(wave.hits.len(), 3000 - 1024);
    for (ray, hit) in wave.hits.iter().enumerate() {
        let probe = ray + 1024;
        let point = SurfacePoint::new(&wave.rays.rays[ray], hit, &wave.rays.probes[hit.triangle as usize]);
        assert_eq!(point.position, points[probe]);
        assert!(point.normal.abs_diff_eq(normals[probe].normalize(), 1e-6), "{}", point.normal);
        let far = given.bounds.farthest();
        assert!((point.origin - point.position).dot(point.normal) >= GAMMA_32 * points[probe].abs().max_element());
        assert!((point.origin - point.position).length() <= 5.0 * GAMMA_32 * far);
        assert_eq!(wave.rays.pixels[ray] as usize, probe);
    }
}
