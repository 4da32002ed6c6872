//! Masks are compared with a direct evaluation of formula (2), and with each other: they are the same, however they are found.

use glam::{DVec3, IVec3, Vec3};
use lightmesh_render::accel::Hit;
use lightmesh_render::backend::{Backend, Cpu, Wave};
use lightmesh_render::light_mesh::{Lattice, LightMesh, Template, point_of};
use lightmesh_render::{
    Acceleration, CellGroups, LightGroup, Masks, PreparedScene, RayList, RenderContext, Sampling, ShortTests,
    Unobserved, View,
};
use lightmesh_scene::Scene;
use lightmesh_testkit::{perforated, runs_all, soup};

const ACCELERATIONS: [Acceleration; 3] = [Acceleration::Bvh, Acceleration::Grid(None), Acceleration::BruteForce];

fn context() -> RenderContext<'static> {
    RenderContext::new(&Unobserved, Sampling { samples: 4, seed: 0, spread: false })
}

fn mesh(scene: &PreparedScene, step: f32, radius: f32) -> LightMesh {
    let lattice = Lattice::around(scene, step, radius).unwrap();
    let template = Template::new(radius).unwrap();
    LightMesh { lattice, template, radius: radius * step, weight: lightmesh_scene::Weight::Smooth }
}

/// What the scene's first camera sees.
fn look(scene: &PreparedScene, pixels: u32) -> (RayList, Vec<Hit>) {
    let view = View::new(&scene.scene.cameras[0], [pixels, pixels]);
    let backend = Cpu;
    let rays = backend.camera_rays(&view, 0..pixels, 0).unwrap();
    let hits = backend.primary_rays(&context(), scene, &rays).unwrap();
    (rays, hits)
}

fn masks(
    scene: &PreparedScene,
    (rays, hits): &(RayList, Vec<Hit>),
    mesh: &LightMesh,
    short_tests: ShortTests,
) -> (CellGroups, Masks) {
    let context = context().with_short_tests(short_tests);
    let wave = Wave { context: &context, scene, rays, hits, lights: LightGroup::ALL, parts: 1 };
    let cells = Cpu.cells(&wave, mesh).unwrap();
    let masks = Cpu.short_tests(&wave, &cells, mesh).unwrap();
    (cells, masks)
}

/// The masks of every accelerator and every kind of test equal those of the first accelerator's plain tests.
fn assert_all_alike(scene: &Scene, accelerations: &[Acceleration], pixels: u32, cases: &[(f32, f32)]) {
    let prepared: Vec<PreparedScene> =
        accelerations.iter().map(|kind| PreparedScene::new(scene, kind, &Unobserved).unwrap()).collect();
    let seen = look(&prepared[0], pixels);
    for &(step, radius) in cases {
        let mesh = mesh(&prepared[0], step, radius);
        let (cells, oracle) = masks(&prepared[0], &seen, &mesh, ShortTests::Plain);
        assert!(oracle.bits.iter().any(|&word| word != 0));
        for scene in &prepared {
            for kind in [ShortTests::Cells, ShortTests::Plain] {
                let (found_cells, found) = masks(scene, &seen, &mesh, kind);
                let (accelerator, name) = (scene.geometry.accelerator.name(), &scene.scene.name);
                let differing: u32 = found.bits.iter().zip(&oracle.bits).map(|(a, b)| (a ^ b).count_ones()).sum();
                assert_eq!(differing, 0, "bits of {name}, {accelerator}, {kind:?}, h = {step}, R = {radius}");
                assert_eq!(found_cells.members(), cells.members());
            }
        }
    }
}

/// Pixels along a side of the built-in scenes' images.
fn side() -> u32 {
    if runs_all() { 96 } else { 48 }
}

#[test]
fn cells_and_plain_tests_agree_on_gazebo() {
    let scene = Scene::open("builtin:gazebo").unwrap();
    let cases = [(2.0, 1.5), (2.0, 2.1), (2.0, 3.1), (1.0, 4.1), (0.3, 2.1), (5.0, 3.1)];
    assert_all_alike(&scene, &ACCELERATIONS, side(), &cases);
}

#[test]
fn cells_and_plain_tests_agree_on_childpark() {
    let scene = Scene::open("builtin:childpark").unwrap();
    let cases = [(1.0, 1.5), (1.0, 2.1), (1.0, 3.1), (0.5, 4.1), (3.0, 2.1)];
    assert_all_alike(&scene, &ACCELERATIONS[..2], side(), &cases);
}

#[test]
fn cells_and_plain_tests_agree_on_soups() {
    for seed in 0..if runs_all() { 6 } else { 2 } {
        let cases = [(0.5, 2.1), (0.2, 3.1), (1.3, 1.5), (0.07, 4.1), (0.4, 0.7)];
        assert_all_alike(&soup(seed, 150), &ACCELERATIONS, 40, &cases);
    }
}

#[test]
fn cells_and_plain_tests_agree_on_triangles_with_holes() {
    for seed in 0..3 {
        let (whole, holed) = (soup(seed, 150), perforated(soup(seed, 150)));
        assert_all_alike(&holed, &ACCELERATIONS, 40, &[(0.5, 2.1), (0.2, 3.1), (0.07, 4.1)]);
        let used = |scene: &Scene| {
            let prepared = PreparedScene::new(scene, &Acceleration::Bvh, &Unobserved).unwrap();
            // The same surface points.
            let seen = look(&PreparedScene::new(&whole, &Acceleration::Bvh, &Unobserved).unwrap(), 40);
            let (_, masks) = masks(&prepared, &seen, &mesh(&prepared, 0.5, 2.1), ShortTests::Cells);
            masks.bits.iter().map(|word| word.count_ones()).sum::<u32>()
        };
        let [through, whole] = [used(&holed), used(&whole)];
        assert!(through > whole, "light points are seen through holes: {through}, {whole}");
    }
}

#[test]
fn cells_and_plain_tests_agree_far_from_the_origin() {
    // No local frame brings this scene back to the origin: it is moved after the frame was chosen.
    let mut scene = soup(9, 150);
    let offset = Vec3::new(700.0, -300.0, 500.0);
    scene.geometry_mut().mesh.positions.iter_mut().for_each(|position| *position += offset);
    scene.cameras[0].position += offset;
    assert_all_alike(&scene, &ACCELERATIONS, 40, &[(0.2, 2.1), (0.6, 3.1)]);
}

/// The result of a comparison in real numbers; near the border, one in `f32` may differ.
#[derive(Clone, Copy, PartialEq)]
enum Verdict {
    Yes,
    No,
    Border,
}

/// Direct evaluation of formula (2) in double precision, without template, cells or accelerator.
struct Direct<'a> {
    scene: &'a PreparedScene,
    mesh: &'a LightMesh,
    /// How close to a border rounding may decide, scene units: far above the rounding of `f32`, far below a step.
    border: f64,
}

impl Direct<'_> {
    /// P and n of a hit.
    fn surface(&self, ray: &lightmesh_render::accel::Ray, hit: &Hit) -> (DVec3, DVec3) {
        let [a, b, c] = self.corners(hit.triangle as usize);
        let position = a + f64::from(hit.u) * (b - a) + f64::from(hit.v) * (c - a);
        let normal = (b - a).cross(c - a).normalize();
        (position, if normal.dot(ray.direction.as_dvec3()) > 0.0 { -normal } else { normal })
    }

    fn corners(&self, triangle: usize) -> [DVec3; 3] {
        self.scene.geometry.triangles.at(triangle as u32).corners().map(|corner| corner.as_dvec3())
    }

    /// The triangles above the horizon of a point and within reach of it: no others hide a lattice point of its half-ball.
    fn near(&self, position: DVec3, normal: DVec3) -> Vec<[DVec3; 3]> {
        let reach = f64::from(self.mesh.radius) + self.border;
        let is_near = |corners: &[DVec3; 3]| {
            let [low, high] = [DVec3::min, DVec3::max].map(|of| corners.iter().copied().reduce(of).unwrap());
            let is_above = corners.iter().any(|&corner| normal.dot(corner - position) > self.border);
            is_above && position.clamp(low, high).distance(position) <= reach
        };
        let all = 0..self.scene.geometry.triangles.stored().len();
        all.map(|triangle| self.corners(triangle)).filter(is_near).collect()
    }

    /// Whether lattice point `index` belongs to D(P, r). `near` are the triangles that may hide it.
    fn uses(&self, position: DVec3, normal: DVec3, near: &[[DVec3; 3]], index: IVec3) -> Verdict {
        let lattice = &self.mesh.lattice;
        let target = lattice.anchor.as_dvec3() + f64::from(lattice.step) * index.as_dvec3();
        let height = normal.dot(target - position);
        let inside = f64::from(self.mesh.radius) - target.distance(position);
        let least = f64::from(self.mesh.least_height());
        if inside < -self.border || height < least - self.border {
            return Verdict::No;
        }
        let mut verdict =
            if inside < self.border || height < least + self.border { Verdict::Border } else { Verdict::Yes };
        for &triangle in near {
            match self.blocks(triangle, position, target) {
                Verdict::Yes => return Verdict::No,
                Verdict::Border => verdict = Verdict::Border,
                Verdict::No => {}
            }
        }
        verdict
    }

    /// Whether a triangle meets the open segment from `from` to `to`.
    fn blocks(&self, [a, b, c]: [DVec3; 3], from: DVec3, to: DVec3) -> Verdict {
        let plane = (b - a).cross(c - a).normalize_or_zero();
        let (start, end) = (plane.dot(from - a), plane.dot(to - a));
        if plane == DVec3::ZERO || start.min(end) > self.border || start.max(end) < -self.border {
            return Verdict::No;
        }
        // Distance to the three edges in the triangle's plane, where the segment's line meets it.
        let t = if start == end { 0.0 } else { (start / (start - end)).clamp(0.0, 1.0) };
        let meeting = from.lerp(to, t);
        let inside = [(a, b), (b, c), (c, a)].map(|(p, q)| plane.cross(q - p).normalize_or_zero().dot(meeting - p));
        let inside = inside.into_iter().fold(f64::INFINITY, f64::min);
        // If the line is nearly parallel to the plane, the point where they meet is correspondingly more uncertain.
        let slack = self.border * (1.0 + from.distance(to) / (start - end).abs().max(1e-30));
        if inside < -slack {
            Verdict::No
        } else if inside > slack && start.abs() > self.border && end.abs() > self.border && start * end < 0.0 {
            Verdict::Yes
        } else {
            Verdict::Border
        }
    }
}

/// Compares the used light points of each surface point with the direct evaluation. At most a share `at_border` of all
/// lattice points near surface points may be undecided.
fn assert_direct(scene: &Scene, pixels: u32, step: f32, radius: f32, at_border: f64) {
    let prepared = PreparedScene::new(scene, &Acceleration::Bvh, &Unobserved).unwrap();
    let seen = look(&prepared, pixels);
    let mesh = mesh(&prepared, step, radius);
    let (cells, masks) = masks(&prepared, &seen, &mesh, ShortTests::Cells);
    let direct = Direct { scene: &prepared, mesh: &mesh, border: 2.5e-4 * f64::from(step) };
    let (mut members, mut undecided) = (0, 0);
    for group in 0..cells.len() {
        let cell = point_of(cells.cell(group));
        for slot in cells.slots(group) {
            let used: std::collections::HashSet<IVec3> = (mesh.template.offsets().iter().enumerate())
                .filter(|(bit, _)| masks.mask(slot)[bit / 32] >> (bit % 32) & 1 != 0)
                .map(|(_, &offset)| cell + offset)
                .collect();
            let ray = cells.members()[slot] as usize;
            let (position, normal) = direct.surface(&seen.0.rays[ray], &seen.1[ray]);
            let middle = ((position - mesh.lattice.anchor.as_dvec3()) / f64::from(step)).round().as_ivec3();
            let reach = radius.ceil() as i32 + 1;
            let near = direct.near(position, normal);
            let mut found = 0;
            for index in around(middle, reach) {
                found += usize::from(used.contains(&index));
                match direct.uses(position, normal, &near, index) {
                    Verdict::Yes => {
                        assert!(used.contains(&index), "{index} is not used at {position}, normal {normal}")
                    }
                    Verdict::No => assert!(!used.contains(&index), "{index} is used at {position}, normal {normal}"),
                    Verdict::Border => undecided += 1,
                }
            }
            assert_eq!(found, used.len(), "every used point lies near its surface point");
            members += found;
        }
    }
    assert!(members > 1000 && (undecided as f64) < at_border * members as f64, "{undecided} undecided, {members} used");
}

fn around(middle: IVec3, reach: i32) -> impl Iterator<Item = IVec3> {
    let side = 2 * reach + 1;
    (0..side.pow(3)).map(move |i| middle - reach + IVec3::new(i % side, i / side % side, i / (side * side)))
}

#[test]
fn used_points_of_gazebo_are_those_of_formula_2() {
    let scene = Scene::open("builtin:gazebo").unwrap();
    for (step, radius) in [(2.0, 2.1), (0.7, 3.1)] {
        assert_direct(&scene, side() / 2, step, radius, 0.02);
    }
}

#[test]
fn used_points_of_a_soup_are_those_of_formula_2() {
    for seed in [1, 2] {
        assert_direct(&soup(seed, 120), 32, 0.4, 2.1, 0.05);
    }
}
