//! Nothing leaks out of a closed mesh.

use glam::Vec3;
use lightmesh_render::accel::{Accelerator, BruteForce, Hit, Ray};

use super::scenes::{icosphere, indexed};
use super::{Random, structures};

#[test]
fn rays_at_vertices_and_edges_do_not_escape() {
    let random = &mut Random(7);
    for (scale, offset) in [(1.0, Vec3::ZERO), (0.01, Vec3::new(5.0, -3.0, 2.0)), (100.0, Vec3::new(-1e3, 0.0, 1e2))] {
        let corners: Vec<_> =
            icosphere(3).iter().map(|corners| corners.map(|corner| corner * scale + offset)).collect();
        let triangles = indexed(&corners);
        let mut rays = Vec::new();
        for &[a, b, _] in &corners {
            // Well inside: the faces of the mesh lie deeper than its vertices.
            let origin = offset + random.signed() * 0.4 * scale;
            for target in [a, b, a.midpoint(b), a.lerp(b, random.unit())] {
                rays.push(Ray { origin, direction: target - origin, t_max: f32::INFINITY });
                rays.push(Ray { origin: offset, direction: target - offset, t_max: f32::INFINITY });
            }
        }
        let mut all = structures(&triangles);
        all.push(("brute force", Box::new(BruteForce::new(&triangles))));
        for (name, accelerator) in &all {
            let mut hits = vec![Hit::MISS; rays.len()];
            accelerator.closest_hits(&rays, &mut hits);
            let escaped = hits.iter().filter(|hit| !hit.is_some()).count();
            assert_eq!(escaped, 0, "{name}, scale {scale}: of {} rays", rays.len());
        }
    }
}

#[test]
fn an_open_mesh_does_leak() {
    let mut corners = icosphere(2);
    let [a, b, c] = corners.swap_remove(17);
    let direction = a + b + c;
    let ray = Ray { origin: Vec3::ZERO, direction, t_max: f32::INFINITY };
    let mut hit = [Hit { t: 1.0, u: 0.0, v: 0.0, triangle: 0 }];
    BruteForce::new(&indexed(&corners)).closest_hits(&[ray], &mut hit);
    assert_eq!(hit, [Hit::MISS]);
}
