//! Each used light point is listed once, and none is missed.

use std::collections::BTreeSet;

use glam::{DVec3, IVec3, Vec3};
use lightmesh_scene::{LightKind, Weight};
use lightmesh_testkit::pile;

use super::{Span, Windows};
use crate::Unobserved;
use crate::backend::{Backend, Cpu};
use crate::job::{Job, Sampling, Tally};
use crate::light_mesh::{Lattice, LightMesh, Template, bits, brick_of, point_bit, point_of};
use crate::prepared::PreparedScene;
use crate::settings::Acceleration;
use crate::view::View;

#[test]
fn the_list_is_the_union_of_all_masks() {
    let scene = pile(DVec3::ZERO, &[LightKind::Point { position: Vec3::Y, spread: 0.0 }]);
    let scene = PreparedScene::new(&scene, &Acceleration::Bvh, &Unobserved).unwrap();
    for (step, radius) in [(0.3, 2.1), (0.11, 3.1), (1.7, 5.1), (0.5, 0.6)] {
        let lattice = Lattice::around(&scene.bounds, step, radius).unwrap();
        let template = Template::new(radius).unwrap();
        let mesh = LightMesh { lattice, template, radius: radius * step, weight: Weight::Smooth };
        let job = Job::new(&Unobserved, Sampling { samples: 4, seed: 0, spread: false });
        let backend = Cpu;
        let rays = backend.camera_rays(&View::new(&scene.scene.cameras[0], [64, 64]), 0..64).unwrap();
        let hits = backend.primary_rays(&job, &scene, &rays).unwrap();
        let masks = backend.short_tests(&job, &scene, &rays, &hits, &mesh).unwrap();
        let points = backend.light_points(&job, &masks, &mesh).unwrap();

        let mut expected = BTreeSet::new();
        for group in 0..masks.groups.len() {
            let cell = point_of(masks.groups.cell(group));
            for slot in masks.groups.slots(group) {
                let used = mesh.template.offsets().iter().enumerate();
                let used = used.filter(|(bit, _)| masks.mask(slot)[bit / 32] >> (bit % 32) & 1 != 0);
                expected.extend(used.map(|(_, &offset)| (cell + offset).to_array()));
            }
        }
        let listed: Vec<IVec3> = (0..points.used().len()).flat_map(|brick| points.points(brick)).collect();
        assert_eq!(listed.len(), points.count());
        assert_eq!(listed.iter().map(IVec3::to_array).collect::<BTreeSet<_>>(), expected, "h = {step}, R = {radius}");
        assert_eq!(listed.len(), expected.len(), "each once");
        assert_eq!(Tally::get(&job.tally.light_points), expected.len() as u64);
        assert!(!expected.is_empty());
        for point in listed {
            let inside = point.to_array().into_iter().zip(mesh.lattice.dims).all(|(i, n)| i >= 0 && i < n as i32);
            assert!(inside, "{point} is a light point of the lattice {:?}", mesh.lattice.dims);
        }
    }
}

#[test]
fn a_window_finds_every_template_point_of_every_cell() {
    for radius in [0.5, 1.0, 2.1, 3.1, 4.1, 5.1, 16.0] {
        let template = Template::new(radius).unwrap();
        let windows = Windows::new(&template);
        for place in 0..64 {
            let cell = IVec3::new(40, 44, 48) + IVec3::new(place & 3, place >> 2 & 3, place >> 4);
            let window = windows.around(cell);
            let mut offsets = template.offsets().iter().enumerate();
            for span in window.spans {
                assert!(usize::from(span.slot) < windows.len());
                for (point, (index, &offset)) in (0..span.count).zip(&mut offsets) {
                    let brick = window.key(usize::from(span.slot));
                    assert_eq!(brick, brick_of(cell + offset), "R = {radius}, {cell}, {offset}");
                    assert_eq!(u32::from(span.bit + point), point_bit(cell + offset));
                    assert_eq!(usize::from(span.word) * 32 + usize::from(span.shift + point), index);
                }
            }
            assert_eq!(offsets.next(), None, "R = {radius}, {cell}");
        }
    }
}

#[test]
fn a_span_takes_its_bits_and_no_others() {
    let span = Span { slot: 3, bit: 60, count: 3, word: 1, shift: 29 };
    assert_eq!((span.to_mask(u64::MAX), span.to_brick(u32::MAX)), (0b111 << 29, 0b111 << 60));
    assert_eq!((span.to_mask(1 << 61 | 1 << 63), span.to_brick(1 << 30 | 1 << 28)), (1 << 30, 1 << 61));
}

#[test]
fn the_bits_of_a_word_come_in_ascending_order() {
    let word = 1 | 1 << 5 | 1 << 63;
    assert_eq!(bits(word).collect::<Vec<_>>(), [0, 5, 63]);
    assert_eq!(bits(0).count(), 0);
}
