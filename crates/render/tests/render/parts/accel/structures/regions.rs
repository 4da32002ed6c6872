//! Searches by region: nothing that meets the region is missed, and little else is found.

use std::collections::BTreeSet;

use glam::{DVec3, Vec3};
use lightmesh_render::accel::{Accelerator, BruteForce, Region, TangentPlanes, Triangle};
use lightmesh_render::internals::accel::triangle_meets_box;
use lightmesh_scene::Bounds;
use proptest::prelude::*;

use super::{Random, scenes, structures};

/// A region as the reference understands it, in double precision.
#[derive(Clone, Debug)]
struct Asked {
    shape: RegionShape,
    origins: Bounds,
    /// Points of `origins` with their normals; none if nothing is cut off.
    points: Vec<(Vec3, Vec3)>,
    slack: f32,
    /// How large the region is, if planes cut it off: more than four normals are not distinguished.
    far: Option<f64>,
}

#[derive(Clone, Copy, Debug)]
enum RegionShape {
    Box,
    Near(f32),
    Shaft(Bounds),
}

impl Asked {
    fn region(&self) -> Region {
        let region = match self.shape {
            RegionShape::Box => Region::within(self.origins),
            RegionShape::Near(reach) => Region::near(self.origins, reach),
            RegionShape::Shaft(emitter) => Region::shaft(self.origins, emitter),
        };
        region.above(TangentPlanes::new(self.origins.min, self.points.iter().copied(), self.slack))
    }

    /// Whether the region, enlarged by a share `more` of all sizes, meets a box.
    fn meets(&self, low: DVec3, high: DVec3, more: f64) -> bool {
        let [min, max] = [self.origins.min, self.origins.max].map(Vec3::as_dvec3);
        let met = match self.shape {
            RegionShape::Box => low.cmple(max).all() && high.cmpge(min).all(),
            RegionShape::Near(reach) => {
                let apart = (low - max).max(min - high).max(DVec3::ZERO);
                apart.length_squared() <= f64::from(reach).powi(2) * (1.0 + more) + more * more
            }
            RegionShape::Shaft(emitter) => {
                shaft_meets([min, max], [emitter.min.as_dvec3(), emitter.max.as_dvec3()], [low, high], more)
            }
        };
        met && self.is_above(low, high, more)
    }

    /// Whether some corner of a box is not below all planes.
    fn is_above(&self, low: DVec3, high: DVec3, more: f64) -> bool {
        let Some(far) = self.far else { return true };
        let size = far + (high - low).element_sum();
        self.points.iter().any(|&(point, normal)| {
            let normal = normal.as_dvec3();
            let top = DVec3::select(normal.cmpgt(DVec3::ZERO), high, low) - point.as_dvec3();
            top.dot(normal) >= -f64::from(self.slack) - more * size
        })
    }

    /// Whether one of several random points of a triangle lies within.
    fn holds_a_point_of(&self, triangle: &Triangle, random: &mut Random) -> bool {
        let [a, b, c] = triangle.corners().map(Vec3::as_dvec3);
        if self.points.is_empty() && self.meets_triangle(triangle) {
            return true;
        }
        (0..40).any(|number| {
            let (u, v) = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)].get(number).copied().unwrap_or_else(|| {
                let (u, v) = (f64::from(random.unit()), f64::from(random.unit()));
                if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) }
            });
            let point = a + u * (b - a) + v * (c - a);
            self.meets(point, point, 0.0)
        })
    }

    /// Whether a triangle meets one of several boxes that make up the shape.
    fn meets_triangle(&self, triangle: &Triangle) -> bool {
        let [min, max] = [self.origins.min, self.origins.max].map(Vec3::as_dvec3);
        let meets =
            |min: DVec3, max: DVec3| triangle_meets_box(triangle.corners(), 0.5 * (min + max), 0.5 * (max - min));
        match self.shape {
            RegionShape::Near(_) => meets(min, max),
            RegionShape::Box => meets(min, max),
            RegionShape::Shaft(emitter) => (0..=64).any(|part| {
                let t = f64::from(part) / 64.0;
                meets(min.lerp(emitter.min.as_dvec3(), t), max.lerp(emitter.max.as_dvec3(), t))
            }),
        }
    }
}

/// Whether two boxes, one moving into another, ever overlap a third.
fn shaft_meets(from: [DVec3; 2], to: [DVec3; 2], [low, high]: [DVec3; 2], more: f64) -> bool {
    let (mut first, mut last) = (0.0f64, 1.0f64);
    for axis in 0..3 {
        // from + t · way <= 0, for the lower face and, mirrored, for the upper one.
        let faces = [
            (from[0][axis] - high[axis], to[0][axis] - from[0][axis]),
            (low[axis] - from[1][axis], from[1][axis] - to[1][axis]),
        ];
        for (start, way) in faces {
            match way {
                way if way > 0.0 => last = last.min(-start / way),
                way if way < 0.0 => first = first.max(-start / way),
                _ if start > 0.0 => return false,
                _ => {}
            }
        }
    }
    first <= last + more
}

impl Random {
    /// Half edges, some of them zero.
    fn half_edges(&mut self) -> Vec3 {
        let flat = self.pick(&[Vec3::ONE, Vec3::ONE, Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y]);
        self.signed().abs() * self.pick(&[0.01, 0.1, 1.0]) * flat
    }

    fn asked(&mut self, near: Vec3) -> Asked {
        let center = near + self.signed() * self.pick(&[0.0, 0.3, 2.0]);
        let half = self.half_edges();
        let origins = Bounds { min: center - half, max: center + half };
        let shape = match self.below(3) {
            0 => RegionShape::Box,
            1 => RegionShape::Near(self.pick(&[0.0, 1e-3, 0.2, 1.0, 4.0])),
            _ => {
                let away = self.pick(&[Vec3::ONE, Vec3::ONE, Vec3::X, Vec3::new(0.0, 1.0, 1.0), Vec3::ZERO]);
                let (center, half) = (center + self.signed() * away * self.pick(&[1.0, 5.0, 20.0]), self.half_edges());
                RegionShape::Shaft(Bounds { min: center - half, max: center + half })
            }
        };
        let normals = [0; 5].map(|_| {
            let slanted = self.signed().normalize_or(Vec3::Z);
            self.pick(&[slanted, Vec3::Y, Vec3::NEG_X])
        });
        let count = self.pick(&[0, 0, 1, 4, 20]);
        let kinds = self.pick(&[1, 2, 5]);
        let points = (0..count)
            .map(|_| (center + self.signed() * half, self.pick(&normals[..kinds])))
            .map(|(point, normal)| (point.clamp(origins.min, origins.max), normal))
            .collect();
        let asked = Asked { shape, origins, points, slack: self.pick(&[0.0, 1e-3]), far: None };
        let far = asked.region().bounds().extent().as_dvec3().element_sum();
        let known = normals.iter().filter(|normal| asked.points.iter().any(|point| point.1 == **normal));
        let distinct = known.map(|normal| normal.to_array().map(f32::to_bits)).collect::<BTreeSet<_>>().len();
        Asked { far: (1..=4).contains(&distinct).then_some(far), ..asked }
    }
}

/// A scene; some are far away, some have many copies of every triangle, a hair apart.
fn triangles(scene: scenes::Scene, random: &mut Random) -> Vec<Triangle> {
    let all = scene.triangles(random);
    let offset = random.pick(&[Vec3::ZERO, Vec3::ZERO, Vec3::new(1e6, -1e6, 5e5)]);
    let copies = random.pick(&[1, 1, 1, 40]).min(800 / all.len().max(1)).max(1);
    // Moved by a hair: of identical ones a structure holds one.
    let moved = |triangle: &Triangle, copy: usize| {
        triangle.corners().map(|corner| corner + offset + Vec3::splat(1e-3 * copy as f32))
    };
    let corners: Vec<[Vec3; 3]> =
        all.iter().flat_map(|triangle| (0..copies).map(move |copy| moved(triangle, copy))).collect();
    scenes::indexed(&corners)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(150) })]

    #[test]
    fn regions_hold_what_meets_them(scene in prop::sample::select(&scenes::ALL), seed: u64) {
        let random = &mut Random(seed);
        let triangles = triangles(scene, random);
        let (all, oracle) = (structures(&triangles), BruteForce::new(&triangles));
        let held = oracle.triangles();
        let (mut listed, mut found) = (Vec::new(), vec![7; 3]);
        for _ in 0..20 {
            let near = if held.is_empty() { Vec3::ZERO } else { random.pick(held).corners()[0] };
            let asked = random.asked(near);
            let region = asked.region();
            oracle.triangles_in(&region, &mut listed);
            for triangle in held {
                let (bounds, index) = (triangle.bounds(), triangle.index());
                let [low, high] = [bounds.min, bounds.max].map(Vec3::as_dvec3);
                let is_listed = listed.binary_search(&index).is_ok();
                prop_assert!(is_listed || !asked.meets(low, high, 0.0), "the list lacks {}: {:?}", index, asked);
                prop_assert!(!is_listed || asked.meets(low, high, 1e-5), "the list has {}: {:?}", index, asked);
            }
            for (name, accelerator) in &all {
                accelerator.triangles_in(&region, &mut found);
                prop_assert!(found.is_sorted_by(|a, b| a < b), "{}: ascending, each once", name);
                prop_assert!(found.iter().all(|index| listed.binary_search(index).is_ok()), "{}: {:?}", name, asked);
                for triangle in held {
                    let (bounds, index) = (triangle.bounds(), triangle.index());
                    let is_met = || asked.meets(bounds.min.as_dvec3(), bounds.max.as_dvec3(), 0.0);
                    let is_required = found.binary_search(&index).is_err()
                        && is_met()
                        && (*name != "grid" || asked.holds_a_point_of(triangle, random));
                    prop_assert!(!is_required, "{} lacks {}: {:?}", name, index, asked);
                }
            }
        }
    }
}

#[test]
fn empty_regions_hold_nothing() {
    let triangles = scenes::indexed(&scenes::icosphere(1));
    let (around, empty) = (Bounds { min: Vec3::splat(-9.0), max: Vec3::splat(9.0) }, Bounds::EMPTY);
    let regions =
        [Region::within(empty), Region::near(empty, 5.0), Region::shaft(empty, around), Region::shaft(around, empty)];
    let mut all = structures(&triangles);
    all.push(("brute force", Box::new(BruteForce::new(&triangles))));
    for (name, accelerator) in &all {
        let mut found = vec![3];
        for region in &regions {
            accelerator.triangles_in(region, &mut found);
            assert!(found.is_empty(), "{name}: {region:?}");
        }
        accelerator.triangles_in(&Region::within(around), &mut found);
        assert_eq!(found.len(), triangles.len(), "{name}");
    }
}

#[test]
fn nothing_below_all_planes_is_found() {
    let floor = [Vec3::new(-1.0, 0.0, -1.0), Vec3::new(1.0, 0.0, -1.0), Vec3::new(0.0, 0.0, 1.0)];
    let triangles = scenes::indexed(&[floor, floor.map(|corner| corner + 0.5 * Vec3::Y)]);
    let origins = Bounds::around([Vec3::new(0.0, 1e-3, 0.0), Vec3::new(0.1, 1e-3, 0.1)]);
    let up = [(origins.min, Vec3::Y), (origins.max, Vec3::Y)];
    let aside = [(origins.min, Vec3::Y), (origins.max, Vec3::X)];
    let mut all = structures(&triangles);
    all.push(("brute force", Box::new(BruteForce::new(&triangles))));
    for (name, accelerator) in &all {
        let mut found = Vec::new();
        for region in [
            Region::near(origins, 0.7),
            Region::shaft(origins, Bounds::around([Vec3::NEG_Y, Vec3::Y])),
            Region::near(origins, 5.0),
        ] {
            let mut ask = |planes| {
                accelerator.triangles_in(&region.above(planes), &mut found);
                found.clone()
            };
            assert_eq!(ask(TangentPlanes::NONE), [0, 1], "{name}");
            assert_eq!(ask(TangentPlanes::new(origins.min, up, 0.0)), [1], "{name}");
            assert_eq!(ask(TangentPlanes::new(origins.min, up, 0.1)), [0, 1], "{name}: lowered");
            assert_eq!(ask(TangentPlanes::new(origins.min, aside, 0.0)), [0, 1], "{name}: above one of two");
        }
    }
}
