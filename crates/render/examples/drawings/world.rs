//! Worlds for drawings: the same in every plane z = const, so that a drawing of the plane z = 0 shows everything. What is drawn is
//! computed by the stages of the renderer.

use std::error::Error;

use glam::{IVec3, UVec3, Vec2, Vec3, vec2};
use lightmesh_render::accel::{Hit, Ray};
use lightmesh_render::backend::{Backend, Cpu, Wave};
use lightmesh_render::light_mesh::{Lattice, LightMesh, Template, UsedPoints, point_bit};
use lightmesh_render::{
    Acceleration, CellGroups, LightGroup, Masks, PreparedScene, RayList, RenderContext, Sampling, SurfacePoint,
    Unobserved, VisibilityOfLight,
};
use lightmesh_scene::{Scene, Weight};
use lightmesh_testkit::SceneDraft;

/// Half the extent of everything along z: more than any distance in a drawing.
const HALF: f64 = 50.0;

/// An object of a world.
pub(crate) trait Extrude: Sized {
    /// A sheet over the line between two points.
    fn sheet(self, from: Vec2, to: Vec2) -> Self;
    /// A bar over a rectangle.
    fn bar(self, low: Vec2, high: Vec2) -> Self;
}

impl Extrude for SceneDraft {
    fn sheet(self, from: Vec2, to: Vec2) -> SceneDraft {
        let corner = |point: Vec2, z: f64| [f64::from(point.x), f64::from(point.y), z];
        self.quad([corner(from, -HALF), corner(from, HALF), corner(to, HALF), corner(to, -HALF)])
    }

    fn bar(self, low: Vec2, high: Vec2) -> SceneDraft {
        let corner = |point: Vec2, z: f64| [f64::from(point.x), f64::from(point.y), z];
        self.cuboid(corner(low, -HALF), corner(high, HALF))
    }
}

/// A light mesh of step 1 whose light point (16, 16, 16) lies at `node` in the plane z = 0.
pub(crate) fn light_mesh(node: Vec2, radius: f32) -> Result<LightMesh, Box<dyn Error>> {
    let anchor = node.extend(0.0) - Vec3::splat(16.0);
    let lattice = Lattice { anchor, step: 1.0, number: UVec3::ZERO, first: IVec3::ZERO, dims: [32; 3] };
    Ok(LightMesh { lattice, template: Template::new(radius)?, radius, weight: Weight::Smooth })
}

/// The light points of a mesh in the plane z = 0.
pub(crate) fn nodes(mesh: &LightMesh) -> impl Iterator<Item = Vec2> {
    let first = mesh.lattice.anchor.truncate();
    (0..32).flat_map(move |y| (0..32).map(move |x| first + vec2(x as f32, y as f32)))
}

/// A world, and what its surface points see.
pub(crate) struct World {
    scene: PreparedScene,
    mesh: LightMesh,
    context: RenderContext<'static>,
    list: RayList,
    hits: Vec<Hit>,
    cells: CellGroups,
    masks: Masks,
}

/// A surface point with its half-ball in the plane z = 0.
pub(crate) struct HalfBall {
    pub(crate) position: Vec2,
    pub(crate) normal: Vec2,
    /// Light points that satisfy (2).
    pub(crate) used: Vec<Vec2>,
    /// Light points that satisfy (2) except for its last condition.
    pub(crate) hidden: Vec<Vec2>,
}

impl World {
    /// Steps 1 and 2 for the surface points below each of `eyes`.
    pub(crate) fn new(scene: &Scene, mesh: LightMesh, eyes: &[Vec2]) -> Result<World, Box<dyn Error>> {
        let scene = PreparedScene::new(scene, &Acceleration::BruteForce, &Unobserved)?;
        let context = RenderContext::new(&Unobserved, Sampling { samples: 1, seed: 0, spread: false });
        let down = |eye: &Vec2| Ray { origin: eye.extend(0.0), direction: Vec3::NEG_Y, t_max: f32::INFINITY };
        let list = RayList {
            rays: eyes.iter().map(down).collect(),
            pixels: (0..eyes.len() as u32).collect(),
            ..RayList::default()
        };
        let hits = Cpu.primary_rays(&context, &scene, &list)?;
        if !hits.iter().all(Hit::is_some) {
            return Err(format!("{}: there is no surface below some eye", scene.scene.name).into());
        }
        let wave =
            Wave { context: &context, scene: &scene, rays: &list, hits: &hits, lights: LightGroup::ALL, parts: 1 };
        let cells = Cpu.cells(&wave, &mesh)?;
        let masks = Cpu.short_tests(&wave, &cells, &mesh)?;
        Ok(World { scene, mesh, context, list, hits, cells, masks })
    }

    /// The half-ball of the surface point below eye number `eye`.
    pub(crate) fn half_ball(&self, eye: usize) -> HalfBall {
        let hit = &self.hits[eye];
        let point = SurfacePoint::new(&self.list.rays[eye], hit, &self.scene.geometry.triangles.at(hit.triangle));
        let slot = self.cells.members().iter().position(|&ray| ray as usize == eye);
        let mask = slot.map_or(&[][..], |slot| self.masks.mask(slot));
        let cell = self.mesh.lattice.cell(point.position);
        let mut half_ball = HalfBall {
            position: point.position.truncate(),
            normal: point.normal.truncate(),
            used: Vec::new(),
            hidden: Vec::new(),
        };
        for (bit, &offset) in self.mesh.template.offsets().iter().enumerate() {
            let node = self.mesh.lattice.point(cell + offset);
            let way = node - point.position;
            let near = way.length_squared() < self.mesh.radius * self.mesh.radius;
            if node.z != 0.0 || !near || point.normal.dot(way) <= self.mesh.least_height() {
                continue;
            }
            let seen = mask.get(bit / 32).is_some_and(|word| word >> (bit % 32) & 1 != 0);
            if seen { half_ball.used.push(node.truncate()) } else { half_ball.hidden.push(node.truncate()) }
        }
        half_ball
    }

    /// Steps 3 and 4: the used light points in the plane z = 0, and whether each sees the scene's only light.
    pub(crate) fn long_tests(&self) -> Result<Vec<(Vec2, bool)>, Box<dyn Error>> {
        let wave = Wave {
            context: &self.context,
            scene: &self.scene,
            rays: &self.list,
            hits: &self.hits,
            lights: LightGroup::ALL,
            parts: 1,
        };
        let points: UsedPoints = Cpu.light_points(&self.context, &self.cells, &self.masks, &self.mesh)?;
        let lit = Cpu.long_tests(&wave, &points, &self.mesh, None)?;
        let Some(VisibilityOfLight::Bits(words)) = lit.lights.first() else {
            return Err("the world has no point light".into());
        };
        let mut seen = Vec::new();
        for (brick, word) in words.iter().enumerate() {
            for index in points.points(brick) {
                let node = self.mesh.lattice.point(index);
                if node.z == 0.0 {
                    seen.push((node.truncate(), word >> point_bit(index) & 1 != 0));
                }
            }
        }
        Ok(seen)
    }

    /// The point where the segment between two points first hits something.
    pub(crate) fn first_hit(&self, from: Vec2, to: Vec2) -> Option<Vec2> {
        let ray = Ray { origin: from.extend(0.0), direction: (to - from).extend(0.0), t_max: 1.0 };
        let mut hits = [Hit::MISS];
        self.scene.geometry.accelerator.closest_hits(&[ray], &mut hits);
        hits[0].is_some().then(|| from + hits[0].t * (to - from))
    }
}

/// Whether a sheet over the line between two points blocks any of the segments.
pub(crate) fn blocks_any([a, b]: [Vec2; 2], segments: &[[Vec2; 2]]) -> Result<bool, Box<dyn Error>> {
    let scene = SceneDraft::new().sheet(a, b).finish("sheet");
    let scene = PreparedScene::new(&scene, &Acceleration::BruteForce, &Unobserved)?;
    let ray =
        |&[from, to]: &[Vec2; 2]| Ray { origin: from.extend(0.0), direction: (to - from).extend(0.0), t_max: 1.0 };
    let rays: Vec<Ray> = segments.iter().map(ray).collect();
    let mut occluded = vec![false; rays.len()];
    scene.geometry.accelerator.occluded(&rays, &mut occluded);
    Ok(occluded.contains(&true))
}
