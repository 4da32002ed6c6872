//! The copy of a scene that a device holds: geometry once, lights for each image.

use std::sync::Arc;

use bytemuck::Zeroable;
use lightmesh_kernels::{Buffer, Runtime};
use lightmesh_layout::constants::{
    BVH_STACK, GRID_FRAME_WORDS, MAX_HELD, RECENT_TRIANGLES, STACK_OF_INSTANCES, STACK_OF_ROUNDS, STACK_PER_LEVEL,
};
use lightmesh_layout::geometry::{
    AlphaMask, BruteForce, Bvh, BvhNode, DVec3, Grid, Instanced, InstancedBvh, RayClamp, Triangle, Triangles, Vec3,
};
use lightmesh_layout::scene::{self as layout, EnvironmentLevel, Indices, Light, Scene};
use lightmesh_layout::{DeviceType, In, Structure};
use lightmesh_scene::{Environment, Falloff, LightKind};
use lightmesh_trace::accel::{self, AcceleratorKind};

use super::device::Cuda;
use super::resident::{Buffers, DeviceEnvironment, DeviceGeometry, DeviceTextures};
use crate::error::RenderError;
use crate::prepared::{PreparedGeometry, PreparedScene, TransmissionParts};
use crate::render_context::RenderContext;
use crate::sampling::disk_radius;
use crate::settings::Acceleration;
use crate::shading::ambient::AmbientLight;
use crate::shading::seen_lights::SeenLights;
use crate::shading::tint::is_tinted;
use crate::shading::{LightTargets, seen_as};
use crate::stage::Stage;
use crate::sync::locked;

/// A scene on a device: the geometry's copy, which is kept for later images, and the lights of this one.
pub struct DeviceScene<R: Runtime> {
    pub(crate) record: Scene,
    pub(crate) structure: Structure,
    /// Whether any triangle is cut out, or there are instances.
    pub(crate) alpha_test: bool,
    /// The scene on the host.
    pub(crate) host: PreparedScene,
    /// What the record points to.
    _geometry: Arc<DeviceGeometry<R>>,
    _lights: Arc<Buffers<R>>,
    _environment: Option<Arc<DeviceEnvironment<R>>>,
    _probes: Option<Arc<Buffer<R, Triangle>>>,
}

impl<R: Runtime> DeviceScene<R> {
    /// The same scene with other triangles for rays to see; the triangles that hide lights stay.
    pub(super) fn with_triangles(&self, triangles: Arc<Buffer<R, Triangle>>) -> DeviceScene<R> {
        // Given points have no vertex normals.
        let given = Triangles { stored: triangles.input(), ..Zeroable::zeroed() };
        let record = Scene { triangles: given, normals: In::NULL, ..self.record };
        DeviceScene { record, _probes: Some(triangles), ..self.clone() }
    }

    /// Its triangles by index in the mesh, whatever rays see.
    pub(crate) fn triangles(&self) -> Triangles {
        self._geometry.record.triangles
    }

    /// The normals of its vertices, whatever rays see; null without any.
    pub(crate) fn normals(&self) -> In<Vec3> {
        self._geometry.record.normals
    }

    /// The scene taken apart for shadow rays, if some of its surfaces are not opaque.
    pub(crate) fn transmission_parts(&self) -> Option<TransmissionParts<DeviceScene<R>>> {
        let (on_host, parts) = (self.host.transmission_parts()?, self._geometry.transmission_parts.as_ref()?);
        let part = |part: &Scene, host: PreparedScene| {
            let Scene { bvh, grid, brute_force, instanced, alpha_mask, .. } = *part;
            DeviceScene {
                record: Scene { bvh, grid, brute_force, instanced, alpha_mask, ..self.record },
                host,
                ..self.clone()
            }
        };
        Some(TransmissionParts {
            blockers: part(&parts.blockers, on_host.blockers),
            transmissive: part(&parts.transmissive, on_host.transmissive),
            gi_occluders: part(&parts.gi_occluders, on_host.gi_occluders),
        })
    }
}

impl<R: Runtime> Clone for DeviceScene<R> {
    fn clone(&self) -> DeviceScene<R> {
        DeviceScene {
            record: self.record,
            structure: self.structure,
            alpha_test: self.alpha_test,
            host: self.host.clone(),
            _geometry: Arc::clone(&self._geometry),
            _lights: Arc::clone(&self._lights),
            _environment: self._environment.clone(),
            _probes: self._probes.clone(),
        }
    }
}

impl<R: Runtime> DeviceScene<R> {
    /// The scene as it is passed to kernels.
    pub fn record(&self) -> &Scene {
        &self.record
    }

    /// The structure that rays traverse and that is searched by region.
    pub fn structure(&self) -> Structure {
        self.structure
    }

    /// Words of shared memory that a warp needs for a search by region: `search_words` in accel/search.cuh.
    pub fn search_words(&self) -> u32 {
        match self.structure {
            Structure::Bvh => (STACK_OF_ROUNDS + STACK_PER_LEVEL * self.record.bvh.depth).next_multiple_of(4),
            Structure::Grid => GRID_FRAME_WORDS + RECENT_TRIANGLES,
            Structure::BruteForce => 0,
            Structure::InstancedBvh => {
                let per_level = (STACK_PER_LEVEL * self.record.instanced.depth).next_multiple_of(4);
                2 * (STACK_OF_INSTANCES + MAX_HELD + per_level)
            }
        }
    }
}

/// Fails if a device does not have the kernels of a structure.
pub(crate) fn check_structure<R: Runtime>(runtime: &R, acceleration: &Acceleration) -> Result<(), RenderError> {
    match acceleration {
        Acceleration::BruteForce if !runtime.has_brute_force() => {
            Err(RenderError::Structure { structure: acceleration.to_string(), device: runtime.name() })
        }
        _ => Ok(()),
    }
}

impl<R: Runtime> Cuda<R> {
    /// The scene on this device. Its geometry is uploaded if it is not there yet.
    pub(crate) fn device_scene(
        &self,
        context: &RenderContext,
        scene: &PreparedScene,
    ) -> Result<DeviceScene<R>, RenderError> {
        let geometry = self.device_geometry(context, scene)?;
        let mut upload = Upload { cuda: self, buffers: Vec::new() };
        let mut record = upload.lights(scene, geometry.record)?;
        let lights = &scene.scene.lights;
        let environment =
            lights.environment.as_ref().map(|original| self.device_environment(context, original)).transpose()?;
        if let (Some(original), Some(copy)) = (&lights.environment, &environment) {
            let gathered = copy.gathered.as_ref().unwrap_or(&copy.levels);
            let levels = [copy.levels.input(), gathered.input()];
            record.environment = environment_record(scene, original, levels);
        }
        Ok(DeviceScene {
            record,
            structure: geometry.structure,
            alpha_test: scene.geometry.alpha_mask.table().is_some() || geometry.structure == Structure::InstancedBvh,
            host: scene.clone(),
            _geometry: geometry,
            _lights: Arc::new(upload.buffers),
            _environment: environment,
            _probes: None,
        })
    }

    fn device_geometry(
        &self,
        context: &RenderContext,
        scene: &PreparedScene,
    ) -> Result<Arc<DeviceGeometry<R>>, RenderError> {
        let mut resident = locked(&self.resident);
        if let Some(copy) = resident.find(&scene.geometry) {
            return Ok(copy);
        }
        context.work.begin(context.observer, Stage::Upload, 1, 0.0);
        let upload = || {
            let textures = self.device_textures(scene)?;
            Upload { cuda: self, buffers: Vec::new() }.geometry(scene, textures)
        };
        let uploaded = context.wall_time(Stage::Upload, upload);
        context.work.end(context.observer, Stage::Upload);
        let copy = Arc::new(uploaded?);
        if copy.structure == Structure::Bvh && matches!(scene.geometry.accelerator.kind(), AcceleratorKind::Grid(_)) {
            context.observer.note(
                "some surfaces are cut out: grids on CUDA devices have none, so a BVH takes the grid's place; the image is the same",
            );
        }
        resident.insert(&scene.geometry, Arc::clone(&copy));
        Ok(copy)
    }
}

impl<R: Runtime> Cuda<R> {
    /// The images of a scene's materials on this device. They are uploaded if they are not there yet.
    fn device_textures(&self, scene: &PreparedScene) -> Result<Arc<DeviceTextures<R>>, RenderError> {
        let mut resident = locked(&self.textures);
        let levels = &scene.geometry.mip_levels;
        if let Some(copy) = resident.find(levels) {
            return Ok(copy);
        }
        let mut upload = Upload { cuda: self, buffers: Vec::new() };
        let records = upload.textures(&scene.scene.geometry, levels)?;
        let copy = Arc::new(DeviceTextures { records, texels: upload.buffers });
        resident.insert(levels, Arc::clone(&copy));
        Ok(copy)
    }

    /// The levels of an environment on this device. They are uploaded if they are not there yet.
    fn device_environment(
        &self,
        context: &RenderContext,
        original: &Arc<Environment>,
    ) -> Result<Arc<DeviceEnvironment<R>>, RenderError> {
        let mut resident = locked(&self.environments);
        if let Some(copy) = resident.find(original) {
            return Ok(copy);
        }
        let upload = || -> Result<DeviceEnvironment<R>, RenderError> {
            let mut upload = Upload { cuda: self, buffers: Vec::new() };
            let mut level = |size: [u32; 2], texels: &[[f32; 3]]| -> Result<EnvironmentLevel, RenderError> {
                Ok(EnvironmentLevel {
                    texels: upload.array::<Vec3>("environment", bytemuck::cast_slice(texels))?,
                    size,
                })
            };
            let mut all = |of: &Environment| -> Result<Buffer<R, EnvironmentLevel>, RenderError> {
                let mut levels = vec![level(of.size(), of.texels())?];
                for lower in of.levels() {
                    levels.push(level(lower.size, &lower.texels)?);
                }
                Ok(self.pool.upload("levels of the environment", &levels)?)
            };
            let seen = all(original)?;
            let gathered = (!std::ptr::eq(original.gathered(), &**original)).then(|| all(original.gathered()));
            Ok(DeviceEnvironment { levels: seen, gathered: gathered.transpose()?, texels: upload.buffers })
        };
        let copy = Arc::new(context.wall_time(Stage::Upload, upload)?);
        resident.insert(original, Arc::clone(&copy));
        Ok(copy)
    }
}

/// An environment as kernels see it.
fn environment_record(
    scene: &PreparedScene,
    original: &Environment,
    [levels, gathered]: [In<EnvironmentLevel>; 2],
) -> layout::Environment {
    let terms = AmbientLight::of(scene).terms;
    let [east, up, north] = original.frame().map(vec3);
    let sun = original.sun();
    layout::Environment {
        levels,
        gathered,
        east,
        up,
        north,
        lower: original.levels().len() as u32,
        hidden: u32::from(scene.scene.lights.background.is_some()),
        sun_radius: sun.map_or(-1.0, |sun| sun.radius),
        sun: vec3(sun.map_or(glam::Vec3::ZERO, |sun| sun.direction)),
        sun_radiance: vec3(sun.map_or(glam::Vec3::ZERO, |sun| sun.radiance)),
        lights: u32::from(terms.is_some()),
        terms: bytemuck::cast(terms.unwrap_or_default().map(|term| term.to_array())),
        gathered_lower: original.gathered().levels().len() as u32,
        spare_b: 0,
    }
}

/// An upload in progress.
pub(super) struct Upload<'a, R: Runtime> {
    cuda: &'a Cuda<R>,
    buffers: Buffers<R>,
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

    fn geometry(
        mut self,
        scene: &PreparedScene,
        textures: Arc<DeviceTextures<R>>,
    ) -> Result<DeviceGeometry<R>, RenderError> {
        let (geometry, prepared) = (&*scene.scene.geometry, &*scene.geometry);
        let mesh = &geometry.mesh;
        let tinted = geometry.materials.iter().any(|material| is_tinted(geometry, material));
        let indices: &[[u32; 3]] = if tinted || !mesh.normals.is_empty() { &mesh.triangles } else { &[] };
        let (center, far) = prepared.sun_distance_parameters();
        let mut record = Scene {
            triangles: self.all_triangles(&prepared.triangles)?,
            indices: self.array::<Indices>("indices", bytemuck::cast_slice(indices))?,
            normals: self.array::<Vec3>("normals", bytemuck::cast_slice(&mesh.normals))?,
            center: vec3(center),
            far,
            ..Zeroable::zeroed()
        };
        self.materials(geometry, &prepared.materials.numbers, &textures.records, &mut record)?;
        let (starts, objects) = mesh.objects.runs();
        record.object_starts = self.array("runs of objects", starts)?;
        record.objects = self.array("objects", objects)?;
        record.object_runs = starts.len() as u32;
        let gi_occluders = prepared.transmission_parts.as_ref().map(|parts| &parts.gi_occluders.alpha_mask);
        let [alpha_mask, halved] = self.alpha_mask(&prepared.alpha_mask, gi_occluders)?;
        record.alpha_mask = alpha_mask;
        let structure = self.structure(prepared, alpha_mask, &mut record)?;
        let mut part = |prepared: &PreparedGeometry| {
            let mut record = record;
            self.structure(prepared, alpha_mask, &mut record).map(|_| record)
        };
        let transmission_parts = match &prepared.transmission_parts {
            Some(TransmissionParts { blockers, transmissive, .. }) => Some(TransmissionParts {
                blockers: part(blockers)?,
                transmissive: part(transmissive)?,
                gi_occluders: masked_by(halved, record),
            }),
            None => None,
        };
        Ok(DeviceGeometry { record, transmission_parts, structure, buffers: self.buffers, textures })
    }

    /// Adds the structure over a geometry to the record of a scene.
    fn structure(
        &mut self,
        prepared: &PreparedGeometry,
        alpha_mask: AlphaMask,
        record: &mut Scene,
    ) -> Result<Structure, RenderError> {
        Ok(match prepared.accelerator.kind() {
            AcceleratorKind::Bvh(bvh) if !bvh.instances().is_empty() => {
                record.instanced = InstancedBvh { alpha_mask, ..self.instanced_bvh(bvh)? };
                Structure::InstancedBvh
            }
            AcceleratorKind::Bvh(bvh) => {
                record.bvh = Bvh { alpha_mask, ..self.bvh(bvh)? };
                Structure::Bvh
            }
            AcceleratorKind::Grid(grid) if prepared.alpha_mask.table().is_some() => {
                record.bvh = Bvh { alpha_mask, ..self.bvh(&accel::Bvh::new(&grid.held()))? };
                Structure::Bvh
            }
            AcceleratorKind::Grid(grid) => {
                record.grid = self.grid(grid)?;
                Structure::Grid
            }
            AcceleratorKind::BruteForce(all) => {
                record.brute_force = BruteForce { alpha_mask, ..self.brute_force(all)? };
                Structure::BruteForce
            }
        })
    }

    /// The record of a scene with these lights.
    fn lights(&mut self, scene: &PreparedScene, geometry: Scene) -> Result<Scene, RenderError> {
        let lights = &scene.scene.lights;
        let records: Vec<Light> =
            lights.iter().map(|it| Light { seen: seen_as(lights, it), ..light(&scene.geometry, it) }).collect();
        let targets = LightTargets::new(lights).flat();
        Ok(Scene {
            lights: self.array("lights", &records)?,
            light_targets: self.array::<Vec3>("points on lights", bytemuck::cast_slice(&targets))?,
            light_count: records.len() as u32,
            seen_lights: u32::from(!SeenLights::new(lights).is_empty()),
            ambient: vec3(AmbientLight::of(scene).mean),
            background: vec3(lights.background.unwrap_or_default()),
            ..geometry
        })
    }

    fn triangles(&mut self, triangles: &[accel::Triangle]) -> Result<In<Triangle>, RenderError> {
        self.array("triangles", bytemuck::cast_slice(triangles))
    }

    fn all_triangles(&mut self, all: &accel::Triangles) -> Result<Triangles, RenderError> {
        Ok(Triangles {
            stored: self.triangles(all.stored())?,
            instances: self.instances(all.instances())?,
            instance_count: all.instances().len() as u32,
            spare: 0,
        })
    }

    fn instances(&mut self, instances: &[accel::Instanced]) -> Result<In<Instanced>, RenderError> {
        let record = |instance: &accel::Instanced| Instanced {
            place: instance.place.rows,
            back: instance.back.rows,
            first: instance.first,
            stored: instance.stored,
            leaves: instance.tree.leaves,
            root: instance.tree.root,
            norm: instance.norm,
            reach: instance.reach,
            shift: instance.shift,
            object: instance.object,
        };
        self.array("instances", &instances.iter().map(record).collect::<Vec<_>>())
    }

    fn instanced_bvh(&mut self, bvh: &accel::Bvh) -> Result<InstancedBvh, RenderError> {
        let Bvh { nodes, triangles, alpha_mask, ray_clamp, node_count, depth } = self.bvh(bvh)?;
        Ok(InstancedBvh {
            nodes,
            triangles,
            alpha_mask,
            instances: self.instances(bvh.instances())?,
            ray_clamp,
            node_count,
            depth,
            instance_count: bvh.instances().len() as u32,
            spare: 0,
        })
    }

    fn bvh(&mut self, bvh: &accel::Bvh) -> Result<Bvh, RenderError> {
        debug_assert!(bvh.depth() <= 2 * BVH_STACK as usize, "builds keep to this many levels");
        let nodes = bvh.nodes();
        Ok(Bvh {
            nodes: self.array::<BvhNode>("BVH", bytemuck::cast_slice(nodes))?,
            triangles: self.triangles(bvh.triangles())?,
            alpha_mask: AlphaMask::zeroed(),
            ray_clamp: ray_clamp(bvh.ray_clamp()),
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
            ray_clamp: ray_clamp(grid.ray_clamp()),
            triangle_count: grid.triangles().len() as u32,
            margin: grid.margin(),
        })
    }

    fn brute_force(&mut self, all: &accel::BruteForce) -> Result<BruteForce, RenderError> {
        Ok(BruteForce {
            triangles: self.triangles(all.triangles())?,
            alpha_mask: AlphaMask::zeroed(),
            ray_clamp: ray_clamp(all.ray_clamp()),
            count: all.triangles().len() as u32,
            spare: 0,
        })
    }
}

/// A scene cut out by another `alpha_mask`.
fn masked_by(alpha_mask: AlphaMask, scene: Scene) -> Scene {
    Scene {
        bvh: Bvh { alpha_mask, ..scene.bvh },
        brute_force: BruteForce { alpha_mask, ..scene.brute_force },
        instanced: InstancedBvh { alpha_mask, ..scene.instanced },
        alpha_mask,
        ..scene
    }
}

pub(super) fn vec3(v: glam::Vec3) -> Vec3 {
    Vec3::from(v.to_array())
}

fn ray_clamp((center, radius): (glam::Vec3, f32)) -> RayClamp {
    RayClamp { center: vec3(center), radius }
}

fn light(geometry: &PreparedGeometry, light: &lightmesh_scene::Light) -> Light {
    let mut record = Light {
        position: vec3(light.position().unwrap_or_default()),
        intensity: vec3(light.intensity),
        inverse_square: u32::from(light.falloff == Falloff::InverseSquare),
        size: crate::shadow::size(light, 1.0),
        scale: crate::shadow::projected_light::scale(geometry, light),
        surface: u32::from(light.surface.is_some()),
        body: crate::sampling::body(light),
        ..Zeroable::zeroed()
    };
    match light.kind {
        LightKind::Point { spread, .. } => (record.kind, record.radius) = (Light::POINT, spread),
        LightKind::Sphere { radius, .. } => (record.kind, record.radius) = (Light::SPHERE, radius),
        LightKind::Directional { direction, angle } => {
            let (tangent, bitangent) = direction.any_orthonormal_pair();
            (record.kind, record.direction) = (Light::DIRECTIONAL, vec3(direction));
            record.radius = disk_radius(angle);
            (record.half_u, record.half_v) = (vec3(tangent), vec3(bitangent));
        }
        LightKind::Spot { direction, inner, outer, radius, .. } => {
            record.kind = if light.has_size() { Light::SPHERE } else { Light::SPOT };
            (record.direction, record.radius) = (vec3(direction), radius);
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
    if let Some(normal) = light.surface {
        record.direction = vec3(normal);
    }
    record
}
