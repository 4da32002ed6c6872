//! A scene prepared for ray tracing.
//!
//! What is built over the triangles ([`PreparedGeometry`]) lives as long as they do: lights, cameras, sizes and settings may change from
//! image to image without rebuilding or uploading anything.

use std::sync::{Arc, Mutex, OnceLock, PoisonError, Weak};

use glam::Vec3;
use lightmesh_memory::{Budget, OverBudget};
use lightmesh_scene::{Bounds, Camera, Geometry, Instance, Lights, Material, Mesh, Scene, Texture};
use lightmesh_trace::accel::{
    Accelerator, AcceleratorKind, AlphaMask, Beams, BruteForce, Bvh, Grid, GridOptions, Triangle, Triangles,
    alpha_mask, geometry_hash,
};
use xxhash_rust::xxh3::Xxh3;

use crate::deformation::{boxes, differs_only_in_positions, union};
use crate::error::RenderError;
use crate::material_ids::MaterialIds;
use crate::observer::Observer;
use crate::settings::{Acceleration, Setting};
use crate::stage::Stage;
use crate::sync::locked;
use crate::textures::AllLevels;

/// Bytes that a triangle takes at most while a BVH is built, with what is kept of it.
pub const BYTES_TO_BUILD: u64 = 400;

/// Bytes of a triangle and its share of vertices in a copy of a shape, about.
const BYTES_OF_COPY: u64 = 80;

/// Triangles with the acceleration structure over them. Shared behind an [`Arc`] by all images of a geometry, and the key of the copies
/// that devices keep.
pub struct PreparedGeometry {
    /// The triangles by index.
    pub triangles: Triangles,
    /// The acceleration structure.
    pub accelerator: Box<dyn Accelerator>,
    /// The box around all triangles that can be hit.
    pub bounds: Bounds,
    /// Where triangles are cut out.
    pub(crate) alpha_mask: AlphaMask,
    /// The numbers and names of materials.
    pub(crate) materials: MaterialIds,
    /// The smaller levels of textures, by number; empty if no texture is seen.
    pub(crate) mip_levels: Arc<AllLevels>,
    /// The same triangles for shadow rays, if some are not opaque.
    pub(crate) transmission_parts: Option<TransmissionParts<Arc<PreparedGeometry>>>,
    /// What moved since it was prepared before.
    pub(crate) deformation: Option<Deformation>,
    /// Hash of which triangles the structure holds; 0: all.
    held: u64,
    /// Hash of all that decides what hides what, once it is asked for.
    hash: OnceLock<u64>,
    /// The setting that chose the structure.
    acceleration: Acceleration,
    /// Build time in seconds, until the first image reports it.
    unreported: Mutex<f64>,
    /// About the middle of the bounds.
    center: Vec3,
    /// More than the distance from there to any triangle.
    sun_distance: f32,
}

/// What moved since geometry was prepared before.
pub(crate) struct Deformation {
    /// The geometry before.
    pub(crate) before: Weak<PreparedGeometry>,
    pub(crate) boxes: Arc<[Bounds]>,
}

/// A scene, or its geometry, taken apart for shadow rays: rays hit the same triangles as in the whole, but only some of these hide anything.
#[derive(Clone, Debug)]
pub struct TransmissionParts<T> {
    /// Only what is opaque hides.
    pub blockers: T,
    /// Only what lets light through is hit.
    pub transmissive: T,
    /// For gathered light: what is at least half opaque is opaque, and what is less is not there.
    pub gi_occluders: T,
}

impl PreparedGeometry {
    /// For rays that lie close together.
    pub(crate) fn beams(&self) -> Beams<'_> {
        Beams::new(&*self.accelerator, &self.triangles, &self.alpha_mask, &self.bounds)
    }

    /// Builds the acceleration structure over `geometry`, and the smaller levels of its textures.
    ///
    /// # Errors
    /// [`RenderError::Geometry`] if the geometry is inconsistent, [`RenderError::BuildMemory`] or [`RenderError::TextureMemory`] if there is
    /// not enough memory,
    /// [`RenderError::Grid`] or [`RenderError::GridFile`] if a grid was requested and cannot be built or read.
    pub fn new(
        geometry: &Geometry,
        acceleration: &Acceleration,
        budget: Budget,
        observer: &dyn Observer,
    ) -> Result<PreparedGeometry, RenderError> {
        geometry.check()?;
        observer.begin(Stage::Build, geometry.mesh.triangles.len() as u64);
        let start = std::time::Instant::now();
        check_memory(geometry, budget)?;
        let (triangles, alpha_mask) = triangles_of(geometry, budget)?;
        let mip_levels = Arc::new(mip_levels(geometry, budget)?);
        let prepared =
            Structures { geometry, acceleration, budget, known: None }.over(triangles, alpha_mask, mip_levels)?;
        *locked(&prepared.unreported) = start.elapsed().as_secs_f64();
        observer.advance(geometry.mesh.triangles.len() as u64);
        observer.end(Stage::Build);
        Ok(prepared)
    }

    /// The same surfaces in other places, which `geometry` has: only structures are built. `None` if it is not the same surfaces as those
    /// `before` that were prepared as this.
    ///
    /// # Errors
    /// As [`PreparedGeometry::new`].
    pub(crate) fn moved(
        self: &Arc<PreparedGeometry>,
        before: &Geometry,
        geometry: &Geometry,
        budget: Budget,
        observer: &dyn Observer,
    ) -> Result<Option<PreparedGeometry>, RenderError> {
        let from_file = matches!(self.acceleration, Acceleration::GridFile(_));
        if from_file || !differs_only_in_positions(before, geometry) {
            return Ok(None);
        }
        observer.begin(Stage::Build, geometry.mesh.triangles.len() as u64);
        let start = std::time::Instant::now();
        check_memory(geometry, budget)?;
        let triangle = |(index, before): (usize, &Triangle)| {
            Triangle::new(geometry.mesh.corners(index), index as u32).alpha_tested(before.cut())
        };
        let triangles: Vec<Triangle> = self.triangles.stored().iter().enumerate().map(triangle).collect();
        let boxes = boxes([before, geometry], self.triangles.stored(), &triangles);
        let shapes = geometry.mesh.instances.shapes();
        let known = match self.accelerator.kind() {
            AcceleratorKind::Bvh(bvh) if self.triangles.stored()[shapes.clone()] == triangles[shapes] => Some(bvh),
            _ => None,
        };
        let structures = Structures { geometry, acceleration: &self.acceleration, budget, known };
        let mut prepared = structures.over(triangles, self.alpha_mask.clone(), Arc::clone(&self.mip_levels))?;
        let deformation = |before: &Arc<PreparedGeometry>| {
            Some(Deformation { before: Arc::downgrade(before), boxes: Arc::clone(&boxes) })
        };
        prepared.deformation = deformation(self);
        if let (Some(parts), Some(before)) = (&mut prepared.transmission_parts, &self.transmission_parts) {
            let pairs = [(&mut parts.blockers, &before.blockers), (&mut parts.transmissive, &before.transmissive)];
            for (part, before) in pairs {
                Arc::get_mut(part).expect("nobody else has it yet").deformation = deformation(before);
            }
        }
        *locked(&prepared.unreported) = start.elapsed().as_secs_f64();
        observer.advance(geometry.mesh.triangles.len() as u64);
        observer.end(Stage::Build);
        Ok(Some(prepared))
    }

    /// The same with a structure over some of the triangles alone.
    fn part(
        &self,
        mesh: &Mesh,
        holds: impl Fn(&Triangle) -> bool,
        budget: Budget,
    ) -> Result<PreparedGeometry, RenderError> {
        // Structures leave out what cannot be hit.
        let held = |triangle: &Triangle| match holds(triangle) {
            true => *triangle,
            false => Triangle::new([Vec3::NAN; 3], triangle.index()),
        };
        let held: Vec<Triangle> = self.triangles.stored().iter().map(held).collect();
        let structure = accelerator(mesh, &held, &self.alpha_mask, &self.acceleration, (budget, None))?;
        Ok(PreparedGeometry { held: geometry_hash(&held), ..self.over(structure, self.alpha_mask.clone()) })
    }

    /// The same where what is at least half opaque is opaque, and the rest is none.
    fn gi_occluders(&self) -> PreparedGeometry {
        let alpha_mask = self.alpha_mask.halved();
        self.over(self.accelerator.masked_by(&alpha_mask), alpha_mask)
    }

    /// The same with another structure, cut out by `alpha_mask`.
    fn over(&self, accelerator: Box<dyn Accelerator>, alpha_mask: AlphaMask) -> PreparedGeometry {
        PreparedGeometry {
            triangles: self.triangles.clone(),
            accelerator,
            bounds: self.bounds,
            alpha_mask,
            materials: self.materials.clone(),
            mip_levels: Arc::clone(&self.mip_levels),
            transmission_parts: None,
            deformation: None,
            held: 0,
            hash: OnceLock::new(),
            acceleration: self.acceleration.clone(),
            unreported: Mutex::new(0.0),
            center: self.center,
            sun_distance: self.sun_distance,
        }
    }

    /// The triangles of a geometry by index, as structures take them: those that are cut out are marked as such.
    ///
    /// # Errors
    /// [`RenderError::Geometry`] if the geometry is inconsistent, [`RenderError::TextureMemory`] if there is not enough memory.
    pub fn triangles_of(geometry: &Geometry, budget: Budget) -> Result<Vec<Triangle>, RenderError> {
        geometry.check()?;
        Ok(triangles_of(geometry, budget)?.0)
    }

    /// The setting that chose the structure.
    pub fn acceleration(&self) -> &Acceleration {
        &self.acceleration
    }

    /// The distance of a directional light from `from`: beyond every triangle. Needed for every segment, so computed without a square root.
    #[inline(always)]
    pub fn sun_distance(&self, from: Vec3) -> f32 {
        self.sun_distance + 2.0 * (from - self.center).abs().element_sum()
    }

    /// The parameters of [`sun_distance`](PreparedGeometry::sun_distance), for devices.
    pub(crate) fn sun_distance_parameters(&self) -> (Vec3, f32) {
        (self.center, self.sun_distance)
    }

    /// Bytes that the geometry occupies on the host, including the acceleration structure, the smaller levels of textures and
    /// opacities.
    pub fn memory(&self) -> usize {
        let levels = self.mip_levels.memory();
        let parts = self.transmission_parts.iter().flat_map(|parts| [&parts.blockers, &parts.transmissive]);
        let parts: usize = parts.map(|part| part.accelerator.memory()).sum();
        size_of_val(self.triangles.stored()) + self.accelerator.memory() + self.alpha_mask.memory() + levels + parts
    }

    /// Hash of all that decides what hides what: triangles in their order, which of them there are, and where they are cut out. The same for
    /// all structures. It is computed at the first call.
    #[doc(hidden)]
    pub fn hash(&self) -> u64 {
        *self.hash.get_or_init(|| {
            let mut hash = Xxh3::new();
            hash.update(&geometry_hash(self.triangles.stored()).to_le_bytes());
            self.triangles.instances().iter().for_each(|instance| hash.update(&instance.key()));
            hash.update(&self.held.to_le_bytes());
            self.alpha_mask.add_to_hash(&mut hash);
            hash.digest()
        })
    }

    /// This, and the parts that it is taken into for shadow rays.
    pub(crate) fn all_parts(self: &Arc<PreparedGeometry>) -> Vec<&Arc<PreparedGeometry>> {
        let parts = self
            .transmission_parts
            .iter()
            .flat_map(|parts| [&parts.blockers, &parts.transmissive, &parts.gi_occluders]);
        std::iter::once(self).chain(parts).collect()
    }

    /// The build time in seconds at the first call; 0 at all later ones. So it counts for the first image alone.
    pub(crate) fn take_build_seconds(&self) -> f64 {
        std::mem::take(&mut *locked(&self.unreported))
    }
}

/// Fails if there is not enough memory to build structures.
fn check_memory(geometry: &Geometry, budget: Budget) -> Result<(), RenderError> {
    let triangles = geometry.mesh.triangles.len();
    let alpha_test = geometry.materials.iter().any(|material| material.opacity.is_some());
    let parts = if geometry.materials.iter().any(Material::is_transmissive) { 3 } else { 1 };
    let bytes = parts * BYTES_TO_BUILD + if alpha_test { alpha_mask::BYTES_TO_BUILD } else { 0 };
    budget.check(triangles as u64 * bytes).map_err(|short| RenderError::BuildMemory { triangles, short })
}

/// What is built over the triangles of a geometry.
struct Structures<'a> {
    geometry: &'a Geometry,
    acceleration: &'a Acceleration,
    budget: Budget,
    /// A structure over the same shapes at other places.
    known: Option<&'a Bvh>,
}

impl Structures<'_> {
    fn over(
        &self,
        triangles: Vec<Triangle>,
        alpha_mask: AlphaMask,
        mip_levels: Arc<AllLevels>,
    ) -> Result<PreparedGeometry, RenderError> {
        let Structures { geometry, acceleration, budget, known } = *self;
        let accelerator: Box<dyn Accelerator> = match acceleration {
            Acceleration::GridFile(path) => Box::new(Grid::load(path, &triangles)?.with_alpha_mask(&alpha_mask)),
            other => accelerator(&geometry.mesh, &triangles, &alpha_mask, other, (budget, known))?,
        };
        // Triangles that cannot be hit do not count.
        let own = geometry.mesh.own_triangles().map(|stored| &triangles[stored]);
        let bounds = Bounds::around(own.filter(|triangle| triangle.is_usable()).flat_map(Triangle::corners));
        let instances = geometry.mesh.instances.list();
        let bounds = instances.iter().fold(bounds, |all, Instance { bounds, .. }| union(all, *bounds));
        let (center, sun_distance) = center_and_sun_distance(&bounds);
        let mut prepared = PreparedGeometry {
            triangles: match accelerator.kind() {
                AcceleratorKind::Bvh(bvh) => Triangles::new(triangles.into(), Arc::clone(bvh.instances())),
                AcceleratorKind::Grid(_) | AcceleratorKind::BruteForce(_) => triangles.into(),
            },
            accelerator,
            bounds,
            alpha_mask,
            materials: MaterialIds::new(geometry),
            mip_levels,
            transmission_parts: None,
            deformation: None,
            held: 0,
            hash: OnceLock::new(),
            acceleration: acceleration.clone(),
            unreported: Mutex::new(0.0),
            center,
            sun_distance,
        };
        if geometry.materials.iter().any(Material::is_transmissive) {
            let is_transmissive = |triangle: &Triangle| {
                let material = geometry.mesh.materials[triangle.index() as usize];
                triangle.cut() != 0 && geometry.materials[material as usize].is_transmissive()
            };
            prepared.transmission_parts = Some(TransmissionParts {
                blockers: Arc::new(prepared.part(&geometry.mesh, |triangle| !is_transmissive(triangle), budget)?),
                transmissive: Arc::new(prepared.part(&geometry.mesh, is_transmissive, budget)?),
                gi_occluders: Arc::new(prepared.gi_occluders()),
            });
        }
        Ok(prepared)
    }
}

/// The structure that a setting chooses over the stored triangles of a mesh, or parts of them; a grid from a file is built, as it has all
/// triangles. Grids and lists hold no instances.
fn accelerator(
    mesh: &Mesh,
    triangles: &[Triangle],
    alpha_mask: &AlphaMask,
    acceleration: &Acceleration,
    (budget, known): (Budget, Option<&Bvh>),
) -> Result<Box<dyn Accelerator>, RenderError> {
    let dims = if let Acceleration::Grid(dims) = acceleration { *dims } else { None };
    Ok(match acceleration {
        Acceleration::Auto | Acceleration::Bvh if mesh.instances.is_empty() => {
            Box::new(Bvh::new(triangles).with_alpha_mask(alpha_mask))
        }
        Acceleration::Auto | Acceleration::Bvh => {
            let own: Vec<Triangle> = mesh.own_triangles().map(|stored| triangles[stored]).collect();
            Box::new(Bvh::with_instances(&own, triangles, mesh.instances.list(), known).with_alpha_mask(alpha_mask))
        }
        Acceleration::Grid(_) | Acceleration::GridFile(_) => {
            let options = GridOptions { dims, budget, ..GridOptions::default() };
            Box::new(Grid::new(triangles, &options)?.with_alpha_mask(alpha_mask))
        }
        Acceleration::BruteForce => Box::new(BruteForce::new(triangles).with_alpha_mask(alpha_mask)),
    })
}

/// The triangles of a geometry by index, and where they are cut out.
fn triangles_of(geometry: &Geometry, budget: Budget) -> Result<(Vec<Triangle>, AlphaMask), RenderError> {
    let (alpha_mask, numbers) = AlphaMask::of(geometry, budget).map_err(|found| too_large(geometry, found))?;
    let triangle = |index: usize| {
        let number = numbers.get(index).copied().unwrap_or(0);
        Triangle::new(geometry.mesh.corners(index), index as u32).alpha_tested(number)
    };
    Ok(((0..geometry.mesh.triangles.len()).map(triangle).collect(), alpha_mask))
}

fn mip_levels(geometry: &Geometry, budget: Budget) -> Result<AllLevels, RenderError> {
    AllLevels::of(geometry, budget).map_err(|found| too_large(geometry, found))
}

/// The error for a texture of which something does not fit into memory.
fn too_large(geometry: &Geometry, (index, short): (usize, OverBudget)) -> RenderError {
    let Texture { name, size, .. } = &geometry.textures[index];
    RenderError::TextureMemory { name: name.clone(), size: *size, short }
}

/// A scene whose geometry is prepared. Any number of images can be rendered of it, on any device; clones share the geometry.
#[derive(Clone)]
pub struct PreparedScene {
    /// The scene itself.
    pub scene: Scene,
    /// What was built over its geometry.
    pub geometry: Arc<PreparedGeometry>,
}

/// The geometry with copies of shapes in many places.
fn flattened(geometry: &Geometry, budget: Budget) -> Result<Arc<Geometry>, RenderError> {
    let triangles = geometry.mesh.triangle_count();
    let short = budget.check(triangles as u64 * (BYTES_TO_BUILD + BYTES_OF_COPY));
    short.map_err(|short| RenderError::BuildMemory { triangles, short })?;
    Ok(Geometry { mesh: geometry.mesh.flattened()?, ..geometry.clone() }.into())
}

impl PreparedScene {
    /// Builds the acceleration structure over the geometry of `scene`. Grids and lists hold no instances: for these, shapes in many places are
    /// copied.
    ///
    /// # Errors
    /// As [`PreparedGeometry::new`].
    pub fn new(
        scene: &Scene,
        acceleration: &Acceleration,
        observer: &dyn Observer,
    ) -> Result<PreparedScene, RenderError> {
        PreparedScene::within(scene, acceleration, Budget::default(), observer)
    }

    /// [`PreparedScene::new`] within a memory limit.
    ///
    /// # Errors
    /// As [`PreparedGeometry::new`].
    pub fn within(
        scene: &Scene,
        acceleration: &Acceleration,
        budget: Budget,
        observer: &dyn Observer,
    ) -> Result<PreparedScene, RenderError> {
        let is_bvh = matches!(acceleration, Acceleration::Auto | Acceleration::Bvh);
        let scene = match scene.geometry.mesh.instances.is_empty() || is_bvh {
            true => scene.clone(),
            false => scene.clone().with_geometry(flattened(&scene.geometry, budget)?),
        };
        let geometry = Arc::new(PreparedGeometry::new(&scene.geometry, acceleration, budget, observer)?);
        Ok(PreparedScene { scene, geometry })
    }

    /// Another moment of this scene, in which its surfaces are in other places: only structures are built. `None` if `scene` differs in more.
    ///
    /// # Errors
    /// As [`PreparedGeometry::new`].
    pub fn moved(
        &self,
        scene: &Scene,
        budget: Budget,
        observer: &dyn Observer,
    ) -> Result<Option<PreparedScene>, RenderError> {
        let prepared = self.geometry.moved(&self.scene.geometry, &scene.geometry, budget, observer)?;
        Ok(prepared.map(|geometry| PreparedScene { scene: scene.clone(), geometry: geometry.into() }))
    }

    /// The scene taken apart for shadow rays, if some of its surfaces are not opaque.
    pub(crate) fn transmission_parts(&self) -> Option<TransmissionParts<PreparedScene>> {
        let TransmissionParts { blockers, transmissive, gi_occluders } = self.geometry.transmission_parts.as_ref()?;
        let part = |geometry: &Arc<PreparedGeometry>| PreparedScene {
            scene: self.scene.clone(),
            geometry: Arc::clone(geometry),
        };
        Some(TransmissionParts {
            blockers: part(blockers),
            transmissive: part(transmissive),
            gi_occluders: part(gi_occluders),
        })
    }

    /// Whether anything only shows the shadows on it.
    pub(crate) fn catches(&self) -> bool {
        self.scene.geometry.materials.iter().any(|material| material.catcher)
    }

    /// Whether it matters how wide the samples of pixels are: to images, to what facets reflect, and to lights that are seen.
    pub(crate) fn has_cones(&self) -> bool {
        let has_facets = || self.scene.geometry.materials.iter().any(|material| material.faceted().is_some());
        !self.geometry.mip_levels.is_empty() || has_facets() || self.scene.lights.any_is_shown()
    }

    /// Whether rays may go through surfaces.
    pub(crate) fn is_transmissive(&self) -> bool {
        self.scene.geometry.materials.iter().any(Material::is_transmissive)
    }

    /// Whether lights stand for what lamps emit.
    pub(crate) fn has_lamps(&self) -> bool {
        self.scene.lights.iter().any(|light| light.lamp)
    }

    /// The same geometry under other lights. Their positions are in the geometry's local frame.
    pub fn with_lights(&self, lights: impl Into<Lights>) -> PreparedScene {
        PreparedScene { scene: self.scene.clone().with_lights(lights), ..self.clone() }
    }

    /// The same geometry and lights seen by other cameras.
    pub fn with_cameras(&self, cameras: Vec<Camera>) -> PreparedScene {
        PreparedScene { scene: self.scene.clone().with_cameras(cameras), ..self.clone() }
    }

    /// Fails if an image is to be rendered with another structure than the geometry was prepared with.
    pub(crate) fn check(&self, acceleration: &Acceleration) -> Result<(), RenderError> {
        let resolved = |acceleration: &Acceleration| match acceleration {
            Acceleration::Auto => Acceleration::Bvh,
            other => other.clone(),
        };
        let prepared = &self.geometry.acceleration;
        if resolved(prepared) == resolved(acceleration) {
            return Ok(());
        }
        Err(RenderError::Setting {
            setting: Setting::Acceleration,
            value: acceleration.to_string(),
            remedy: "the scene was prepared with another one: prepare it again, or keep the setting",
        })
    }
}

/// Geometry that was prepared for earlier scenes, for as long as the scenes' geometry is alive.
#[derive(Default)]
pub(crate) struct Preparations {
    known: Mutex<Vec<Preparation>>,
}

struct Preparation {
    /// The geometry itself is not kept alive. While this exists, no other geometry can have its address, and nobody can change it in place.
    geometry: Weak<Geometry>,
    /// The same with copies of shapes in many places, if it has such and is prepared so.
    flat: Option<Arc<Geometry>>,
    prepared: Arc<PreparedGeometry>,
}

impl Preparations {
    /// The scene with its geometry prepared; already prepared geometry is reused.
    pub(crate) fn prepare(
        &self,
        scene: &Scene,
        acceleration: &Acceleration,
        budget: Budget,
        observer: &dyn Observer,
    ) -> Result<PreparedScene, RenderError> {
        if let Some(known) = self.find(scene, acceleration) {
            return Ok(known);
        }
        // Not under the lock: others may prepare other geometry in the meantime.
        let prepared = PreparedScene::within(scene, acceleration, budget, observer)?;
        self.insert(scene, &prepared);
        Ok(prepared)
    }

    /// The same for another moment of a prepared scene.
    pub(crate) fn prepare_moved(
        &self,
        before: &PreparedScene,
        scene: &Scene,
        acceleration: &Acceleration,
        budget: Budget,
        observer: &dyn Observer,
    ) -> Result<PreparedScene, RenderError> {
        let is_other = before.geometry.acceleration == *acceleration && self.find(scene, acceleration).is_none();
        if is_other && let Some(moved) = before.moved(scene, budget, observer)? {
            self.insert(scene, &moved);
            return Ok(moved);
        }
        self.prepare(scene, acceleration, budget, observer)
    }

    fn insert(&self, scene: &Scene, prepared: &PreparedScene) {
        let flat = &prepared.scene.geometry;
        self.locked().push(Preparation {
            geometry: Arc::downgrade(&scene.geometry),
            flat: (!Arc::ptr_eq(flat, &scene.geometry)).then(|| Arc::clone(flat)),
            prepared: Arc::clone(&prepared.geometry),
        });
    }

    fn find(&self, scene: &Scene, acceleration: &Acceleration) -> Option<PreparedScene> {
        let mut known = self.locked();
        known.retain(|known| known.geometry.strong_count() > 0);
        let same = |known: &&Preparation| {
            known.geometry.as_ptr() == Arc::as_ptr(&scene.geometry) && known.prepared.acceleration == *acceleration
        };
        let found = known.iter().find(same)?;
        let scene = match &found.flat {
            Some(flat) => scene.clone().with_geometry(Arc::clone(flat)),
            None => scene.clone(),
        };
        Some(PreparedScene { scene, geometry: Arc::clone(&found.prepared) })
    }

    fn locked(&self) -> std::sync::MutexGuard<'_, Vec<Preparation>> {
        self.known.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Where suns are seen from: a point about the middle of the bounds, and more than the distance from there to any triangle. Both are
/// multiples of a power of two, so that they rarely change when objects move: the segments to a sun would change with them, by rounding.
pub fn center_and_sun_distance(bounds: &Bounds) -> (Vec3, f32) {
    if bounds.is_empty() {
        return (Vec3::ZERO, 1.0);
    }
    let diagonal = bounds.diagonal().max(f32::MIN_POSITIVE);
    let mut size = f32::from_bits(diagonal.to_bits() & f32::INFINITY.to_bits());
    if size < diagonal {
        size *= 2.0;
    }
    // No corner is farther than half the diagonal, and half that of a cube of this size.
    ((bounds.center() / size).round() * size, 1.5 * size)
}
