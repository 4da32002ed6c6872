use glam::{IVec3, UVec3, Vec3};
use lightmesh_render::internals::stages::shadow_box;
use lightmesh_render::light_mesh::{Lattice, LightMesh, Template};
use lightmesh_scene::{Bounds, Weight};

fn mesh() -> LightMesh {
    LightMesh {
        lattice: Lattice { anchor: Vec3::ZERO, step: 1.0, number: UVec3::ZERO, first: IVec3::ZERO, dims: [100; 3] },
        template: Template::new(3.1).unwrap(),
        radius: 3.1,
        weight: Weight::Smooth,
    }
}

#[test]
fn a_shadow_widens_away_from_its_triangle() {
    let origins = Bounds { min: Vec3::splat(10.4), max: Vec3::splat(10.6) };
    let wall = [Vec3::new(11.5, 10.0, 10.0), Vec3::new(11.5, 11.0, 10.0), Vec3::new(11.5, 10.0, 11.0)];
    let (low, high) = shadow_box(&mesh(), IVec3::splat(10), &origins, &wall).unwrap();
    assert_eq!((low.x, high.x), (2, 3), "only beyond the triangle");
    assert!(low.y < 0 && high.y > 1, "wider than the triangle");
    assert!(low.y > -3 && high.y < 4, "but not everywhere");
}

#[test]
fn a_triangle_out_of_reach_hides_nothing() {
    let origins = Bounds { min: Vec3::splat(10.4), max: Vec3::splat(10.6) };
    let far = [Vec3::X, Vec3::Y, Vec3::Z].map(|corner| corner + Vec3::splat(14.0));
    assert!(shadow_box(&mesh(), IVec3::splat(10), &origins, &far).is_none());
}

#[test]
fn a_triangle_around_the_origins_may_hide_everything() {
    let origins = Bounds { min: Vec3::splat(10.4), max: Vec3::splat(10.6) };
    let around = [Vec3::new(5.0, 5.0, 10.5), Vec3::new(20.0, 5.0, 10.2), Vec3::new(5.0, 20.0, 10.9)];
    // All light points nearer than 3.1 to the origins.
    let expected = (IVec3::splat(-2), IVec3::splat(3));
    assert_eq!(shadow_box(&mesh(), IVec3::splat(10), &origins, &around), Some(expected));
}
