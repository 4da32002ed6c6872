//! Each used light point is listed once, and none is missing.

use std::collections::BTreeSet;

use glam::{DVec3, IVec3, Vec3};
use lightmesh_render::backend::{Backend, Cpu, Wave};
use lightmesh_render::internals::light_mesh::bits;
use lightmesh_render::light_mesh::{Lattice, LightMesh, Template, point_of};
use lightmesh_render::{Acceleration, LightGroup, PreparedScene, RenderContext, Sampling, Tally, Unobserved, View};
use lightmesh_scene::{LightKind, Weight};
use lightmesh_testkit::pile;

#[test]
fn the_list_is_the_union_of_all_masks() {
    let scene = pile(DVec3::ZERO, &[LightKind::Point { position: Vec3::Y, spread: 0.0 }]);
    let scene = PreparedScene::new(&scene, &Acceleration::Bvh, &Unobserved).unwrap();
    for (step, radius) in [(0.3, 2.1), (0.11, 3.1), (1.7, 5.1), (0.5, 0.6)] {
        let lattice = Lattice::around(&scene, step, radius).unwrap();
        let template = Template::new(radius).unwrap();
        let mesh = LightMesh { lattice, template, radius: radius * step, weight: Weight::Smooth };
        let context = RenderContext::new(&Unobserved, Sampling { samples: 4, seed: 0, spread: false });
        let backend = Cpu;
        let rays = backend.camera_rays(&View::new(&scene.scene.cameras[0], [64, 64]), 0..64, 0).unwrap();
        let hits = backend.primary_rays(&context, &scene, &rays).unwrap();
        let wave =
            Wave { context: &context, scene: &scene, rays: &rays, hits: &hits, lights: LightGroup::ALL, parts: 1 };
        let cells = backend.cells(&wave, &mesh).unwrap();
        let masks = backend.short_tests(&wave, &cells, &mesh).unwrap();
        let points = backend.light_points(&context, &cells, &masks, &mesh).unwrap();

        let mut expected = BTreeSet::new();
        for group in 0..cells.len() {
            let cell = point_of(cells.cell(group));
            for slot in cells.slots(group) {
                let used = mesh.template.offsets().iter().enumerate();
                let used = used.filter(|(bit, _)| masks.mask(slot)[bit / 32] >> (bit % 32) & 1 != 0);
                expected.extend(used.map(|(_, &offset)| (cell + offset).to_array()));
            }
        }
        let listed: Vec<IVec3> = (0..points.used().len()).flat_map(|brick| points.points(brick)).collect();
        assert_eq!(listed.len(), points.count());
        assert_eq!(listed.iter().map(IVec3::to_array).collect::<BTreeSet<_>>(), expected, "h = {step}, R = {radius}");
        assert_eq!(listed.len(), expected.len(), "each once");
        assert_eq!(Tally::get(&context.tally.light_points), expected.len() as u64);
        assert!(!expected.is_empty());
        for point in listed {
            let place = (point - mesh.lattice.first).to_array();
            let inside = place.into_iter().zip(mesh.lattice.dims).all(|(i, n)| i >= 0 && i < n as i32);
            assert!(inside, "{point} is a light point of {:?}", mesh.lattice);
        }
    }
}

#[test]
fn the_bits_of_a_word_come_in_ascending_order() {
    let word = 1 | 1 << 5 | 1 << 63;
    assert_eq!(bits(word).collect::<Vec<_>>(), [0, 5, 63]);
    assert_eq!(bits(0).count(), 0);
}
