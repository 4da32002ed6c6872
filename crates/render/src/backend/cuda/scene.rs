//! The copy of a scene that a device holds.

use std::sync::Arc;

use lightmesh_layout::constants::BVH_STACK;
use lightmesh_layout::geometry::{Approach, BruteForce, Bvh, BvhNode, DVec3, Grid, Triangle, Vec3};
use lightmesh_layout::scene::{Indices, Light, Scene};
use lightmesh_layout::{DeviceType, In};
use lightmesh_scene::{Falloff, LightKind};

use super::{Cuda, locked};
use crate::RenderError;
use crate::accel::{self, Form};
use crate::cuda::{Buffer, Kernel, Runtime};
use crate::prepared::PreparedScene;
use crate::stages::shade::tint::is_tinted;
use crate::stages::shade::{DEFAULT_AMBIENT, LightTargets};

/// Which acceleration structure rays walk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Structure {
    Bvh,
    Grid,
    BruteForce,
}

/// The kernel of `names` for a structure; names are in the order of [`Structure`].
pub(crate) fn kernel_of(module: &'static str, names: [&'static str; 3], structure: Structure) -> Kernel {
    let name = match structure {
        Structure::Bvh => names[0],
        Structure::Grid => names[1],
        Structure::BruteForce => names[2],
    };
    Kernel { module, name }
}

/// A scene on a device.
pub(crate) struct DeviceScene<R: Runtime> {
    pub(crate) record: Scene,
    pub(crate) structure: Structure,
    /// Whether the BVH is there, whatever rays walk.
    has_bvh: bool,
    /// What the record points to.
    _buffers: Vec<Box<dyn Held>>,
    _runtime: std::marker::PhantomData<fn() -> R>,
}

/// A buffer of any type that is only kept.
trait Held: Send + Sync {}

impl<R: Runtime, T: 'static> Held for Buffer<R, T> {}

impl<R: Runtime> Cuda<R> {
    /// The scene on this device, which [`upload_scene`](Self::upload_scene) has brought there.
    pub(crate) fn scene(&self, scene: &PreparedScene) -> Result<Arc<DeviceScene<R>>, RenderError> {
        match self.resident(scene) {
            Some(resident) => Ok(resident),
            None => self.upload_scene(scene, false),
        }
    }

    /// Brings the scene to this device, if it is not there; with a BVH for the candidates of short tests on request.
    pub(crate) fn upload_scene(
        &self,
        scene: &PreparedScene,
        with_bvh: bool,
    ) -> Result<Arc<DeviceScene<R>>, RenderError> {
        if let Some(resident) = self.resident(scene).filter(|resident| resident.has_bvh || !with_bvh) {
            return Ok(resident);
        }
        let id = self.pool.runtime().id();
        locked(&scene.resident).retain(|(device, _)| *device != id);
        let fresh = Arc::new(Upload { cuda: self, buffers: Vec::new() }.scene(scene, with_bvh)?);
        locked(&scene.resident).push((id, fresh.clone()));
        Ok(fresh)
    }

    fn resident(&self, scene: &PreparedScene) -> Option<Arc<DeviceScene<R>>> {
        let id = self.pool.runtime().id();
        let resident = locked(&scene.resident);
        let (_, found) = resident.iter().find(|(device, _)| *device == id)?;
        Arc::clone(found).downcast().ok()
    }
}

/// An upload in progress.
pub(super) struct Upload<'a, R: Runtime> {
    cuda: &'a Cuda<R>,
    buffers: Vec<Box<dyn Held>>,
}

impl<R: Runtime> Upload<'_, R> {
    pub(super) fn array<T: DeviceType>(&mut self, what: &'static str, values: &[T]) -> Result<In<T>, RenderError> {
        if values.is_empty() {
            return Ok(In::NULL);
        }
        let buffer = self.cuda.pool.upload(what, values)?;
        let address = buffer.input();
        self.buffers.push(Box::new(buffer));
        Ok(address)
    }

    fn scene(mut self, scene: &PreparedScene, with_bvh: bool) -> Result<DeviceScene<R>, RenderError> {
        let mesh = &scene.scene.mesh;
        let tinted = scene.scene.materials.iter().any(|material| is_tinted(scene.scene, material));
        let indices: &[[u32; 3]] = if tinted || !mesh.normals.is_empty() { &mesh.triangles } else { &[] };
        let lights: Vec<Light> = scene.scene.lights.iter().map(light).collect();
        let targets = LightTargets::new(&scene.scene.lights).flat();
        let mut record = Scene {
            triangles: self.triangles(&scene.triangles)?,
            indices: self.array::<Indices>("indices", bytemuck::cast_slice(indices))?,
            normals: self.array::<Vec3>("normals", bytemuck::cast_slice(&mesh.normals))?,
            lights: self.array("lights", &lights)?,
            light_targets: self.array::<Vec3>("points on lights", bytemuck::cast_slice(&targets))?,
            light_count: lights.len() as u32,
            ambient: vec3(scene.scene.ambient.unwrap_or(DEFAULT_AMBIENT)),
            background: vec3(scene.scene.background.unwrap_or_default()),
            center: vec3(scene.center),
            far: scene.far,
            ..bytemuck::Zeroable::zeroed()
        };
        self.materials(scene.scene, &mut record)?;
        let structure = match scene.accelerator.form() {
            Form::Bvh(bvh) => {
                record.bvh = self.bvh(bvh)?;
                Structure::Bvh
            }
            Form::Grid(grid) => {
                record.grid = self.grid(grid)?;
                Structure::Grid
            }
            Form::BruteForce(all) => {
                record.brute_force = self.brute_force(all)?;
                Structure::BruteForce
            }
        };
        let has_bvh = with_bvh || structure == Structure::Bvh;
        if with_bvh && structure != Structure::Bvh {
            record.bvh = self.bvh(&accel::Bvh::new(&scene.triangles))?;
        }
        Ok(DeviceScene { record, structure, has_bvh, _buffers: self.buffers, _runtime: std::marker::PhantomData })
    }

    fn triangles(&mut self, triangles: &[accel::Triangle]) -> Result<In<Triangle>, RenderError> {
        self.array("triangles", bytemuck::cast_slice(triangles))
    }

    fn bvh(&mut self, bvh: &accel::Bvh) -> Result<Bvh, RenderError> {
        if bvh.depth() > BVH_STACK as usize {
            return Err(RenderError::Device {
                device: self.cuda.pool.runtime().name(),
                reason: format!(
                    "the scene's BVH has {} levels, its kernels take {BVH_STACK}: choose --accel grid, or --device cpu",
                    bvh.depth()
                ),
            });
        }
        let nodes = bvh.nodes();
        Ok(Bvh {
            nodes: self.array::<BvhNode>("BVH", bytemuck::cast_slice(nodes))?,
            triangles: self.triangles(bvh.triangles())?,
            approach: approach(bvh.approach()),
            node_count: nodes.len() as u32,
            depth: bvh.depth() as u32,
        })
    }

    fn grid(&mut self, grid: &accel::Grid) -> Result<Grid, RenderError> {
        let (origin, size) = grid.geometry();
        Ok(Grid {
            cells: self.array("grid", grid.cells())?,
            triangles: self.triangles(grid.triangles())?,
            distances: self.array("distances of the grid", &grid.distances())?,
            origin: DVec3::from(origin.to_array()),
            size: vec3(size),
            dims: grid.dims(),
            approach: approach(grid.approach()),
            triangle_count: grid.triangles().len() as u32,
            spare: 0,
        })
    }

    fn brute_force(&mut self, all: &accel::BruteForce) -> Result<BruteForce, RenderError> {
        Ok(BruteForce {
            triangles: self.triangles(all.triangles())?,
            approach: approach(all.approach()),
            count: all.triangles().len() as u32,
            spare: 0,
        })
    }
}

pub(super) fn vec3(v: glam::Vec3) -> Vec3 {
    Vec3::from(v.to_array())
}

fn approach((center, radius): (glam::Vec3, f32)) -> Approach {
    Approach { center: vec3(center), radius }
}

fn light(light: &lightmesh_scene::Light) -> Light {
    let mut record = Light {
        position: vec3(light.position().unwrap_or_default()),
        intensity: vec3(light.intensity),
        inverse_square: u32::from(light.falloff == Falloff::InverseSquare),
        size: crate::stages::shadow_rays::size(light),
        ..bytemuck::Zeroable::zeroed()
    };
    match light.kind {
        LightKind::Point { spread, .. } => (record.kind, record.radius) = (Light::POINT, spread),
        LightKind::Sphere { radius, .. } => (record.kind, record.radius) = (Light::SPHERE, radius),
        LightKind::Directional { direction } => {
            (record.kind, record.direction) = (Light::DIRECTIONAL, vec3(direction));
        }
        LightKind::Spot { direction, inner, outer, .. } => {
            (record.kind, record.direction) = (Light::SPOT, vec3(direction));
            record.cos_outer = outer.cos();
            record.cone_scale = 1.0 / (inner.cos() - outer.cos()).max(1e-3);
        }
        LightKind::Disk { normal, radius, .. } => {
            let (tangent, bitangent) = normal.any_orthonormal_pair();
            (record.kind, record.direction, record.radius) = (Light::DISK, vec3(normal), radius);
            (record.half_u, record.half_v) = (vec3(tangent), vec3(bitangent));
        }
        LightKind::Rectangle { half_u, half_v, .. } => {
            record.kind = Light::RECTANGLE;
            (record.half_u, record.half_v) = (vec3(half_u), vec3(half_v));
        }
    }
    record
}
