use glam::{DVec3, IVec3, Vec3};
use lightmesh_render::light_mesh::{Lattice, LatticeError};
use lightmesh_scene::Bounds;

const FAR: DVec3 = DVec3::new(512.0, -65536.0, 3.0e6);

fn cube(size: f32) -> Bounds {
    Bounds { min: Vec3::ZERO, max: Vec3::splat(size) }
}

fn lattice(origin: DVec3, bounds: Bounds, step: f32) -> Lattice {
    Lattice::new(origin, &bounds, step, 3.1).unwrap()
}

#[test]
fn every_point_that_a_surface_may_use_is_covered() {
    for origin in [DVec3::ZERO, FAR] {
        let lattice = lattice(origin, cube(10.0), 0.7);
        let low = lattice.cell(Vec3::ZERO) - lattice.first;
        let high = lattice.cell(Vec3::splat(10.0)) - lattice.first;
        assert!(low.min_element() >= 4, "{low}");
        let room = IVec3::from_array(lattice.dims.map(|n| n as i32)) - high;
        assert!(room.min_element() > 5, "{room}");
    }
}

#[test]
fn a_point_lies_in_its_own_cell() {
    let lattice = lattice(FAR, cube(10.0), 0.3);
    for index in [IVec3::new(5, 17, 30), IVec3::new(-5, 0, -1)] {
        assert_eq!(lattice.cell(lattice.point(index) + Vec3::splat(0.15)), index);
    }
}

#[test]
fn light_points_lie_at_multiples_of_the_step_moved_by_the_offset() {
    for (origin, step) in [(DVec3::ZERO, 0.3_f32), (FAR, 0.3), (FAR, 1e3), (DVec3::splat(-0.1), 7.0)] {
        let lattice = lattice(origin, cube(10.0), step);
        for index in [lattice.first, IVec3::ZERO, IVec3::new(3, -4, 5)] {
            let world = origin + lattice.point(index).as_dvec3();
            let steps = world / f64::from(step) - Lattice::OFFSET;
            assert!((steps - steps.round()).abs().max_element() < 1e-5, "h = {step}: {steps}");
            let bits = |axis: usize| (lattice.packed(index) >> (21 * axis) & 0x1f_ffff) as f64;
            let number = DVec3::new(bits(0), bits(1), bits(2));
            assert_eq!(number, steps.round().rem_euclid(DVec3::splat(2_097_152.0)), "h = {step}");
        }
    }
}

#[test]
fn the_extent_of_a_scene_moves_no_light_point() {
    let index = IVec3::new(7, -3, 11);
    let some = lattice(FAR, cube(10.0), 0.3);
    let more = lattice(FAR, Bounds { min: Vec3::splat(-77.7), max: Vec3::splat(1234.5) }, 0.3);
    assert_ne!((some.first, some.dims), (more.first, more.dims));
    assert_eq!((some.point(index), some.packed(index)), (more.point(index), more.packed(index)));
}

#[test]
fn light_points_of_a_scene_have_numbers_of_their_own() {
    let lattice = lattice(DVec3::splat(1.0e6), Bounds { min: Vec3::splat(-1e6), max: Vec3::splat(1e6) }, 1.0);
    let corner = |index: usize| {
        lattice.first
            + IVec3::from_array(
                [0, 1, 2].map(|axis| if index >> axis & 1 == 0 { 0 } else { lattice.dims[axis] as i32 - 1 }),
            )
    };
    let mut numbers: Vec<u64> = (0..8).map(|index| lattice.packed(corner(index))).collect();
    numbers.sort_unstable();
    numbers.dedup();
    assert_eq!(numbers.len(), 8);
    assert!(numbers[7] < 1 << 63);
}

#[test]
fn a_step_that_cannot_be_numbered_is_refused_with_one_that_can() {
    for origin in [DVec3::ZERO, DVec3::splat(1e14)] {
        let Err(LatticeError::TooFine { least, .. }) = Lattice::new(origin, &cube(100.0), 1e-6, 2.1) else {
            panic!("must be rejected");
        };
        assert!(Lattice::new(origin, &cube(100.0), least, 2.1).is_ok());
    }
    for step in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        assert!(matches!(Lattice::new(DVec3::ZERO, &cube(1.0), step, 2.1), Err(LatticeError::Step { .. })));
    }
}
