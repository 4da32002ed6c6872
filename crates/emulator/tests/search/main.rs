//! Searches by region on the emulator, with the kernels of `kernels/search.cu`: nothing that meets the region is missed, and nothing is
//! found that the CPU's list does not find.
#![cfg(unix)]

mod regions;
mod triangles;

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use lightmesh_emulator::Emulator;
use lightmesh_layout::constants::{FOUND_TRIANGLES, PLANE_WORDS, SHAFT_WORDS};
use lightmesh_layout::names_per_structure;
use lightmesh_layout::scene;
use lightmesh_render::accel::{Region, TangentPlanes, Triangle};
use lightmesh_render::backend::{Backend, Cuda};
use lightmesh_render::cuda::{Kernel, Launch, Pool, Runtime};
use lightmesh_render::{Acceleration, PreparedScene, RenderContext, Sampling, Unobserved};
use lightmesh_scene::{Bounds, FIRST_INSTANCED, Geometry, Material, Mesh, Scene};
use lightmesh_testkit::{Random, many_balls};

use regions::{Asked, RegionShape, asked};

/// Maximum number of points with normals that cut off a region.
const POINTS: usize = 32;
/// Regions per launch.
const REGIONS: usize = 12;

/// `Asked` of `kernels/search.cu`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct AskedRecord {
    shape: u32,
    point_count: u32,
    slack: f32,
    reach: f32,
    corners: [Vec3; 4],
    points: [Vec3; POINTS],
    normals: [Vec3; POINTS],
}

/// `Search` of `kernels/search.cu`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct SearchRecord {
    scene: scene::Scene,
    regions: u64,
    found: u64,
    counts: u64,
    room: u32,
    spare: u32,
}

impl Asked {
    fn record(&self) -> AskedRecord {
        let (shape, reach, emitter) = match self.shape {
            RegionShape::Box => (0, 0.0, self.origins),
            RegionShape::Near(reach) => (1, reach, self.origins),
            RegionShape::Shaft(emitter) => (2, 0.0, emitter),
        };
        let mut record = AskedRecord {
            shape,
            point_count: self.points.len() as u32,
            slack: self.slack,
            reach,
            corners: [self.origins.min, self.origins.max, emitter.min, emitter.max],
            ..Zeroable::zeroed()
        };
        for (place, &(point, normal)) in self.points.iter().enumerate() {
            (record.points[place], record.normals[place]) = (point, normal);
        }
        record
    }

    fn region(&self) -> Region {
        let region = match self.shape {
            RegionShape::Box => Region::within(self.origins),
            RegionShape::Near(reach) => Region::near(self.origins, reach),
            RegionShape::Shaft(emitter) => Region::shaft(self.origins, emitter),
        };
        region.above(TangentPlanes::new(self.origins.min, self.points.iter().copied(), self.slack))
    }
}

/// Triangles with a structure over them.
fn prepared(triangles: &[[Vec3; 3]], acceleration: &Acceleration) -> PreparedScene {
    let mesh = Mesh {
        positions: triangles.as_flattened().to_vec(),
        triangles: (0..triangles.len() as u32).map(|first| [3 * first, 3 * first + 1, 3 * first + 2]).collect(),
        materials: vec![0; triangles.len()],
        ..Mesh::default()
    };
    let geometry = Geometry { mesh, materials: vec![Material::default()], ..Geometry::default() };
    PreparedScene::new(&Scene::new("triangles", geometry), acceleration, &Unobserved).unwrap()
}

/// What a device finds in each region, with repetitions.
fn search(prepared: &PreparedScene, regions: &[Asked]) -> Vec<Vec<u32>> {
    let emulator = Arc::new(Emulator::new());
    let (cuda, pool) = (Cuda::new(Arc::clone(&emulator)), Pool::new(Arc::clone(&emulator)));
    let context = RenderContext::new(&Unobserved, Sampling { samples: 1, seed: 0, spread: false });
    let scene = cuda.scene(&context, prepared, None).unwrap();
    let room = 1024 * prepared.geometry.triangles.stored().len().max(1);
    let records: Vec<AskedRecord> = regions.iter().map(Asked::record).collect();
    let asked = pool.upload("regions", &records).unwrap();
    let found = pool.zeros::<u32>("found", room * regions.len()).unwrap();
    let counts = pool.zeros::<u32>("counts", regions.len()).unwrap();
    let arguments = SearchRecord {
        scene: *scene.record(),
        regions: asked.input().address(),
        found: found.output().address(),
        counts: counts.output().address(),
        room: room as u32,
        spare: 0,
    };
    let name = names_per_structure!("search_regions")[scene.structure() as usize];
    let shared = 4 * (PLANE_WORDS + SHAFT_WORDS + FOUND_TRIANGLES + scene.search_words());
    let launch = Launch { blocks: regions.len() as u32, threads: 32, shared };
    emulator.launch(Kernel { module: "search", name }, launch, bytemuck::bytes_of(&arguments)).unwrap();
    let (found, counts) = (found.read().unwrap(), counts.read().unwrap());
    found
        .chunks(room)
        .zip(counts)
        .map(|(found, count)| {
            assert!(count as usize <= room, "{count} found");
            found[..count as usize].to_vec()
        })
        .collect()
}

/// Ascending, each once.
fn set(mut indices: Vec<u32>) -> Vec<u32> {
    indices.sort_unstable();
    indices.dedup();
    indices
}

/// Compares every structure with the list on the CPU. Returns how many triangles the list finds.
fn check(what: &str, corners: &[[Vec3; 3]], regions: &[Asked], random: &mut Random) -> usize {
    let mut listed = Vec::new();
    for acceleration in [
        Acceleration::BruteForce,
        Acceleration::Bvh,
        Acceleration::Grid(None),
        Acceleration::Grid(Some([7, 5, 9])),
        Acceleration::Grid(Some([2, 1, 3])),
    ] {
        let prepared = prepared(corners, &acceleration);
        let all = search(&prepared, regions);
        if acceleration == Acceleration::BruteForce {
            for asked in regions {
                let mut found = Vec::new();
                prepared.geometry.accelerator.triangles_in(&asked.region(), &mut found);
                listed.push(found);
            }
        }
        for ((asked, listed), found) in regions.iter().zip(&listed).zip(all) {
            let case = || format!("{what}, {acceleration:?}: {asked:?}");
            if !matches!(acceleration, Acceleration::Grid(_)) {
                assert!(found.len() == listed.len(), "each once: {}", case());
                assert_eq!(set(found), *listed, "{}", case());
                continue;
            }
            let found = set(found);
            let other = found.iter().find(|index| listed.binary_search(index).is_err());
            assert_eq!(other, None, "not in the list: {}", case());
            for &index in listed.iter().filter(|index| found.binary_search(index).is_err()) {
                let triangle = &prepared.geometry.triangles.at(index);
                assert!(!asked.holds_a_point_of(triangle, random), "lacks {index}: {}", case());
            }
        }
    }
    listed.iter().map(Vec::len).sum()
}

#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn regions_hold_what_meets_them() {
    let mut found = 0;
    for (number, kind) in triangles::ALL.iter().cycle().take(30 * triangles::ALL.len()).enumerate() {
        let random = &mut Random::new(number as u64);
        let corners = triangles::triangles(*kind, random);
        let near = |random: &mut Random| match corners.len() {
            0 => Vec3::ZERO,
            len => corners[(random.unit() * len as f64) as usize][0],
        };
        let regions: Vec<Asked> = (0..REGIONS).map(|_| asked(near(random), random)).collect();
        found += check(&format!("{kind:?}, number {number}"), &corners, &regions, random);
    }
    assert!(found > 10_000, "too little is found: {found}");
}

#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn a_search_finds_more_than_one_round_holds() {
    let random = &mut Random::new(3);
    // One triangle many times, hardly moved: structures hold identical ones once.
    let mut corners = triangles::triangles(triangles::Kind::Soup, random);
    let first = corners[0];
    corners.extend((1..=700).map(|number| first.map(|corner| corner + 1e-5 * number as f32 * Vec3::X)));
    let around = Bounds { min: Vec3::splat(-9.0), max: Vec3::splat(9.0) };
    let region = |shape| Asked { shape, origins: around, points: Vec::new(), slack: 0.0, cut: false };
    let regions = [region(RegionShape::Box), region(RegionShape::Near(1.0)), region(RegionShape::Shaft(around))];
    assert_eq!(check("all", &corners, &regions, random), regions.len() * corners.len());
}

/// Where shapes are stored once, the same is found as among copies of them.
#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn instances_are_found_like_copies() {
    let scene = many_balls();
    let flat = scene.geometry.mesh.flattened().unwrap();
    let [shared, copied] = [Acceleration::Bvh, Acceleration::BruteForce]
        .map(|acceleration| PreparedScene::new(&scene, &acceleration, &Unobserved).unwrap());
    // The first triangle of a copy follows those of the floor; those of instances have numbers of their own.
    let own = scene.geometry.mesh.own_triangles().count() as u32;
    let places = shared.geometry.triangles.clone();
    let random = &mut Random::new(9);
    let mut found = 0;
    for _ in 0..20 {
        let regions: Vec<Asked> = (0..REGIONS)
            .map(|_| asked(flat.positions[(random.unit() * flat.positions.len() as f64) as usize], random))
            .collect();
        for ((asked, shared), copied) in regions.iter().zip(search(&shared, &regions)).zip(search(&copied, &regions)) {
            // A triangle that becomes a line where it is placed is in no copy, and nothing hits it.
            let shared: Vec<u32> = shared.into_iter().filter(|&index| places.at(index).is_usable()).collect();
            let like_copies =
                |index: u32| if index < FIRST_INSTANCED { index } else { own + (index - FIRST_INSTANCED) };
            let count = shared.len();
            let shared = set(shared.into_iter().map(like_copies).collect());
            assert_eq!(shared.len(), count, "each once: {asked:?}");
            assert_eq!(shared, set(copied), "{asked:?}");
            found += count;
        }
    }
    assert!(found > 1000, "too little is found: {found}");
}

#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn nothing_below_all_planes_is_found() {
    let floor = [Vec3::new(-1.0, 0.0, -1.0), Vec3::new(1.0, 0.0, -1.0), Vec3::new(0.0, 0.0, 1.0)];
    let corners = [floor, floor.map(|corner| corner + 0.5 * Vec3::Y)];
    let origins = Bounds { min: Vec3::new(0.0, 1e-3, 0.0), max: Vec3::new(0.1, 1e-3, 0.1) };
    let up = vec![(origins.min, Vec3::Y), (origins.max, Vec3::Y)];
    let aside = vec![(origins.min, Vec3::Y), (origins.max, Vec3::X)];
    let shaft = RegionShape::Shaft(Bounds { min: Vec3::NEG_Y, max: Vec3::Y });
    for shape in [RegionShape::Near(0.7), shaft, RegionShape::Near(5.0)] {
        let ask = |points, slack| Asked { shape, origins, points, slack, cut: true };
        let regions = [ask(Vec::new(), 0.0), ask(up.clone(), 0.0), ask(up.clone(), 0.1), ask(aside.clone(), 0.0)];
        for acceleration in [Acceleration::BruteForce, Acceleration::Bvh, Acceleration::Grid(Some([2, 2, 2]))] {
            let found: Vec<_> = search(&prepared(&corners, &acceleration), &regions).into_iter().map(set).collect();
            assert_eq!(found, [vec![0, 1], vec![1], vec![0, 1], vec![0, 1]], "{acceleration:?}, {shape:?}");
        }
    }
}

/// Structures hold the triangles of a scene that are [usable](Triangle::is_usable): none finds the others.
#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn what_cannot_be_hit_is_not_found() {
    let corners = [[Vec3::ZERO, Vec3::X, Vec3::Y], [Vec3::ZERO, Vec3::X, Vec3::splat(1e30)]];
    assert!(!Triangle::new(corners[1], 1).is_usable());
    let origins = Bounds { min: Vec3::splat(-1.0), max: Vec3::splat(1.0) };
    let region = Asked { shape: RegionShape::Box, origins, points: Vec::new(), slack: 0.0, cut: false };
    check("unusable", &corners, std::slice::from_ref(&region), &mut Random::new(0));
    assert_eq!(search(&prepared(&corners, &Acceleration::BruteForce), &[region]), [[0]]);
}
