//! A scene while it is being read: everything in world coordinates and double precision, until the last triangle is known and
//! the local frame can be chosen.

use std::collections::BTreeSet;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::{DMat4, DVec3, Vec3};
use lightmesh_memory::Short;

use crate::{
    Animation, Camera, CreaseAngle, Geometry, Instancing, Light, LightMeshDefaults, Lights, LoadError, LoadOptions,
    Material, MeshPart, Objects, Position, Scene, SceneBuilder, Surroundings, Texture,
    animation::parts::{Hold, MovingInstance, MovingPart, Shape},
    border::{Border, beside},
    builder::mirrors,
    lamps,
    loaded_mesh::LoadedMesh,
    mesh_part::Room,
    quote::{quote, reference},
    smooth::{Unsmooth, smooth},
    texture::{TextureFiles, untextured},
    usable::{is_place, keep_finite, keep_passive, keep_placed, unseen},
    warnings::Warnings,
};

/// The placement of a model in the scene, and which parts of it to use.
#[derive(Clone, Debug)]
pub(crate) struct Placement {
    /// From the model's coordinates to the world's.
    pub(crate) transform: DMat4,
    /// Replaces the model's own materials.
    pub(crate) material: Option<u32>,
    /// Replaces the names of the model's objects.
    pub(crate) object: Option<String>,
    /// Use only the triangles: the surrounding scene has its own lights and cameras.
    pub(crate) part: bool,
}

impl Placement {
    /// The name of the object of the model in a file without names: its own, or else that of the file.
    pub(crate) fn object_in(&self, path: &Path) -> String {
        self.object.clone().unwrap_or_else(|| path.file_stem().unwrap_or_default().to_string_lossy().into_owned())
    }
}

impl Default for Placement {
    fn default() -> Placement {
        Placement { transform: DMat4::IDENTITY, material: None, object: None, part: false }
    }
}

/// Coordinates above this are treated as damaged, like infinite ones: their squares must fit into `f32`.
pub(crate) const LARGEST_COORDINATE: f64 = 1e18;

/// Collects the content of a file; [`Draft::finish`] turns it into a [`Scene`].
#[derive(Debug)]
pub struct Draft {
    path: PathBuf,
    strict: bool,
    smooth: Option<CreaseAngle>,
    /// Vertices that got a normal.
    smooth_normals: usize,
    /// The object of triangles that are added, unless their mesh names its own.
    object: String,
    /// Where the scene's files may lie.
    pub(crate) border: Border,
    builder: SceneBuilder,
    unusable_triangles: usize,
    /// Triangles of parts without texture coordinates.
    without_uvs: Vec<Range<usize>>,
    /// The same of shapes.
    shapes_without_uvs: Vec<Range<usize>>,
    instancing: Instancing,
    /// What a shape is not added to, while it is added.
    beside_shape: Option<Box<SceneBuilder>>,
    /// Whether parts of the shape that is added move.
    shape_moves: bool,
    /// Each camera with its world position; the camera's own position is not used.
    pub(crate) cameras: Vec<(Camera, DVec3)>,
    /// Each light with its world position; the light's own position is not used.
    pub(crate) lights: Vec<(Light, DVec3)>,
    pub(crate) materials: Vec<Material>,
    /// Those of its materials.
    pub textures: Vec<Texture>,
    /// Where they are from.
    pub texture_files: TextureFiles,
    /// The first texture for which there is not enough memory: there will be no scene.
    pub(crate) too_large: Option<LoadError>,
    /// Index of the material for triangles without one, once there is one.
    default_material: Option<u32>,
    /// The file itself and all that it refers to.
    files: BTreeSet<PathBuf>,
    pub(crate) ambient: Option<Vec3>,
    pub(crate) background: Option<Vec3>,
    pub(crate) surroundings: Option<Surroundings>,
    pub(crate) light_mesh: LightMeshDefaults,
    pub(crate) warnings: Warnings,
    /// How things move.
    pub(crate) animation: Animation,
    /// The animation of glTF files that is asked for.
    pub(crate) animation_name: Option<String>,
    /// The node of the rig that moves what is added.
    pub(crate) mover: Option<u32>,
}

impl Draft {
    /// An empty scene, to be read from `path`.
    pub fn new(path: &Path, options: &LoadOptions) -> Draft {
        Draft {
            path: path.to_owned(),
            strict: options.strict,
            smooth: options.smooth,
            smooth_normals: 0,
            object: String::new(),
            border: Border::new(path, options),
            builder: SceneBuilder::new(),
            unusable_triangles: 0,
            without_uvs: Vec::new(),
            shapes_without_uvs: Vec::new(),
            instancing: options.instancing,
            beside_shape: None,
            shape_moves: false,
            cameras: Vec::new(),
            lights: Vec::new(),
            materials: Vec::new(),
            textures: Vec::new(),
            texture_files: TextureFiles::default(),
            too_large: None,
            default_material: None,
            files: BTreeSet::from([path.to_owned()]),
            ambient: None,
            background: None,
            surroundings: None,
            light_mesh: LightMeshDefaults::default(),
            warnings: Warnings::default(),
            animation: Animation::default(),
            animation_name: options.animation.clone(),
            mover: None,
        }
    }

    /// Reserves memory for what a file is going to add.
    ///
    /// # Errors
    ///
    /// [`LoadError::TooLarge`] if it exceeds 32-bit indices, [`LoadError::Memory`] if there is not enough memory.
    pub(crate) fn reserve(&mut self, room: &Room) -> Result<(), LoadError> {
        let limit = u32::MAX as usize;
        let vertices = self.builder.vertex_count().saturating_add(room.vertices);
        let triangles = self.builder.triangle_count().saturating_add(room.triangles);
        if vertices > limit || triangles > limit {
            return Err(LoadError::TooLarge { path: self.path.clone() });
        }
        self.check_memory(room, vertices, triangles)?;
        if self.builder.reserve(room) {
            Ok(())
        } else {
            let (needed, limit) = (room.bytes(), self.border.budget.limit());
            Err(self.out_of_memory(vertices, triangles, Short { needed, left: 0, limit }))
        }
    }

    /// Fails if there is not enough memory for what is added, of `vertices` and `triangles` in all.
    fn check_memory(&self, room: &Room, vertices: usize, triangles: usize) -> Result<(), LoadError> {
        let checked = self.border.budget.check(room.bytes());
        checked.map_err(|short| self.out_of_memory(vertices, triangles, short))
    }

    /// Fails if there is not enough memory for what bends `vertices` vertices between so many morph targets.
    pub(crate) fn check_bends(&self, vertices: usize, targets: usize) -> Result<(), LoadError> {
        /// Of a vertex of a target, and of one with eight joints.
        const BYTES: u64 = 24 + 48;
        let bytes = (vertices as u64).saturating_mul(1 + targets as u64).saturating_mul(BYTES);
        self.border.budget.check(bytes).map_err(|short| LoadError::Memory {
            path: self.path.clone(),
            what: format!("{targets} morph targets of {vertices} vertices"),
            short,
        })
    }

    fn out_of_memory(&self, vertices: usize, triangles: usize, short: Short) -> LoadError {
        LoadError::Memory {
            path: self.path.clone(),
            what: format!("{vertices} vertices and {triangles} triangles"),
            short,
        }
    }

    /// Adds placed triangles. Triangles with a NaN vertex, or one too far away to compute with, are ignored and counted in a
    /// warning.
    pub fn add<P: Position>(
        &mut self,
        part: MeshPart<P>,
        transform: &DMat4,
        material: impl Fn(usize) -> u32,
    ) -> Result<(), LoadError> {
        self.check_room(&part)?;
        let shape = self.mover.map(|_| shape_of(&part));
        let before = self.size();
        let usable = usable_in(transform);
        if part.positions.iter().all(&usable) {
            self.begin_objects(&Objects::default(), part.triangles.len(), |triangle| triangle as usize);
            self.builder.append(part, transform, material);
            self.note_uvs(part.triangles.len(), !part.uvs.is_empty());
        } else {
            self.add_usable(part, &Objects::default(), transform, material, usable);
        }
        self.move_added(shape, transform, before);
        Ok(())
    }

    /// Numbers of vertices and triangles so far.
    pub(crate) fn size(&self) -> (usize, usize) {
        (self.builder.vertex_count(), self.builder.triangle_count())
    }

    /// What was added since the draft had the size `before`, with this shape and placed by `transform`, goes with the mover.
    fn move_added(&mut self, shape: Option<Shape>, transform: &DMat4, before: (usize, usize)) {
        if let (Some(shape), Some(node)) = (shape, self.mover) {
            self.hold(shape.into(), Hold::Node(node, *transform), mirrors(transform), before);
        }
    }

    /// What was added since the draft had the size `before` moves.
    pub(crate) fn hold(&mut self, shape: Arc<Shape>, hold: Hold, reversed: bool, before: (usize, usize)) {
        if self.beside_shape.is_some() {
            self.shape_moves = true;
            return;
        }
        let after = self.size();
        // Parts without any usable vertex are not added.
        if after.0 - before.0 == shape.positions.len() && after.1 > before.1 {
            let (vertices, triangles) = (before.0..after.0, before.1..after.1);
            self.animation.parts.push(MovingPart { vertices, triangles, shape, hold, reversed });
        }
    }

    /// Whether a shape of so many triangles is stored once for all of its places.
    pub(crate) fn shares(&self, places: usize, triangles: usize) -> bool {
        self.beside_shape.is_none() && places > 1 && triangles > 0 && self.instancing.shares(places, triangles)
    }

    /// Adds a shape that is nowhere until it is [placed](Draft::place): `add` adds its parts as they are without a place, in reverse order of
    /// corners for places that mirror. `None` if it cannot be in many places, for it has cameras or lights, or parts of
    /// it move.
    pub(crate) fn shape(
        &mut self,
        mirrored: bool,
        add: impl FnOnce(&mut Draft) -> Result<(), LoadError>,
    ) -> Result<Option<Range<usize>>, LoadError> {
        self.builder.exchange_shapes(&mut self.beside_shape);
        let (own, mover) = (std::mem::take(&mut self.without_uvs), self.mover.take());
        let views = (self.cameras.len(), self.lights.len());
        self.shape_moves = false;
        let first = self.builder.triangle_count();
        let added = add(self);
        let shape = first..self.builder.triangle_count();
        if mirrored {
            self.builder.reverse(shape.clone());
        }
        let without_uvs = std::mem::replace(&mut self.without_uvs, own);
        self.shapes_without_uvs.extend(without_uvs);
        self.mover = mover;
        let has_views = views != (self.cameras.len(), self.lights.len());
        self.cameras.truncate(views.0);
        self.lights.truncate(views.1);
        self.builder.exchange_shapes(&mut self.beside_shape);
        let can_be_placed = !has_views && !self.shape_moves && !shape.is_empty();
        added.map(|()| can_be_placed.then_some(shape))
    }

    /// Places a shape; `false` if it cannot be placed so. `held` is the node that moves it, in whose coordinates the transform places it.
    pub(crate) fn place(
        &mut self,
        shape: Range<usize>,
        transform: &DMat4,
        object: Option<&str>,
        held: Option<(u32, DMat4)>,
    ) -> bool {
        if !self.builder.place(shape, transform, object) {
            return false;
        }
        let instance = self.builder.place_count() - 1;
        self.animation.instances.extend(held.map(|(node, place)| MovingInstance { instance, node, place }));
        true
    }

    /// Whether what is fastened to this node may be stored once for all of its places.
    pub(crate) fn may_hold_shapes(&self, node: u32) -> bool {
        !self.animation.rig.scales(node)
    }

    /// The object of a shape, if all of it belongs to one.
    pub(crate) fn object_of(&mut self, shape: &Range<usize>) -> Option<String> {
        self.builder.exchange_shapes(&mut self.beside_shape);
        let object = self.builder.object_of(shape).map(str::to_owned);
        self.builder.exchange_shapes(&mut self.beside_shape);
        object
    }

    /// Triangles that are added from now on belong to the object `name`, unless their mesh names its own.
    pub(crate) fn begin_object(&mut self, name: impl Into<String>) {
        self.object = name.into();
    }

    /// Names `count` triangles that are going to be added: by the objects of their mesh, or the one that was begun. `place` says where
    /// each of the mesh's triangles is among them.
    fn begin_objects(&mut self, objects: &Objects, count: usize, place: impl Fn(u32) -> usize) {
        if count == 0 {
            return;
        }
        if objects.runs().0.is_empty() {
            self.builder.begin_object(&self.object);
        } else {
            self.builder.begin_objects(objects, place);
        }
    }

    /// Whether meshes without normals get smooth ones.
    pub(crate) fn smooths(&self) -> bool {
        self.smooth.is_some()
    }

    /// [`Draft::add`] for a mesh passed by value. If it has no normals, it gets smooth ones, if the options ask for them.
    pub fn take<P: Position>(&mut self, mut mesh: LoadedMesh<P>, transform: &DMat4) -> Result<(), LoadError> {
        self.smooth(&mut mesh, transform)?;
        // The first mesh of a scene is not copied.
        let copied = if self.builder.vertex_count() > 0 { mesh.part() } else { MeshPart::default() };
        self.check_room(&copied)?;
        let shape = self.mover.map(|_| shape_of(&mesh.part()));
        let before = self.size();
        let usable = usable_in(transform);
        if mesh.positions.iter().all(&usable) {
            let (triangles, has_uvs) = (mesh.triangles.len(), !mesh.uvs.is_empty());
            self.begin_objects(&std::mem::take(&mut mesh.objects), triangles, |triangle| triangle as usize);
            self.builder.take(mesh, transform);
            self.note_uvs(triangles, has_uvs);
        } else {
            self.add_usable(mesh.part(), &mesh.objects, transform, |index| mesh.materials[index], usable);
        }
        self.move_added(shape, transform, before);
        Ok(())
    }

    /// Gives a mesh without normals smooth ones. Angles are those of the mesh as it is in its file.
    fn smooth<P: Position>(&mut self, mesh: &mut LoadedMesh<P>, transform: &DMat4) -> Result<(), LoadError> {
        let Some(crease) = self.smooth.filter(|_| mesh.normals.is_empty()) else { return Ok(()) };
        match smooth(mesh, crease, usable_in(transform), &self.border.budget) {
            Ok(count) => self.smooth_normals += count,
            Err(Unsmooth::TooMany) => return Err(LoadError::TooLarge { path: self.path.clone() }),
            Err(Unsmooth::Memory(short)) => {
                let (path, triangles) = (self.path.clone(), mesh.triangles.len());
                return Err(LoadError::SmoothMemory { path, triangles, short });
            }
        }
        Ok(())
    }

    fn check_room<P>(&self, part: &MeshPart<P>) -> Result<(), LoadError> {
        let vertices = self.builder.vertex_count() + part.positions.len();
        if vertices > u32::MAX as usize {
            return Err(LoadError::TooLarge { path: self.path.clone() });
        }
        if part.triangles.len() <= self.builder.reserved_triangles() {
            return Ok(());
        }
        self.check_memory(&Room::of(part), vertices, self.builder.triangle_count() + part.triangles.len())
    }

    /// [`Draft::add`] without the triangles that use an unusable vertex.
    fn add_usable<P: Position>(
        &mut self,
        part: MeshPart<P>,
        objects: &Objects,
        transform: &DMat4,
        material: impl Fn(usize) -> u32,
        usable: impl Fn(&P) -> bool,
    ) {
        // The vertices stay, so that indices stay valid, but as copies of a usable one: they must not move the local frame.
        let Some(&good) = part.positions.iter().find(|position| usable(position)) else {
            self.unusable_triangles += part.triangles.len();
            return;
        };
        let positions: Vec<P> = part.positions.iter().map(|&p| if usable(&p) { p } else { good }).collect();
        let kept: Vec<usize> = (0..part.triangles.len())
            .filter(|&index| part.triangles[index].iter().all(|&vertex| usable(&part.positions[vertex as usize])))
            .collect();
        self.unusable_triangles += part.triangles.len() - kept.len();
        let triangles: Vec<[u32; 3]> = kept.iter().map(|&index| part.triangles[index]).collect();
        let part = MeshPart { positions: &positions, triangles: &triangles, ..part };
        self.begin_objects(objects, kept.len(), |triangle| kept.partition_point(|&index| index < triangle as usize));
        self.builder.append(part, transform, |index| material(kept[index]));
        self.note_uvs(part.triangles.len(), !part.uvs.is_empty());
    }

    /// Records the triangles that were added last, if they have no texture coordinates.
    fn note_uvs(&mut self, triangles: usize, has_uvs: bool) {
        if !has_uvs {
            let end = self.builder.triangle_count();
            self.without_uvs.push(end - triangles..end);
        }
    }

    /// The file that `source` refers to as `name`. One that is missing or outside, as are paths of its author's computer, may lie next to
    /// `source`: then there is a warning.
    pub(crate) fn read_nearby(&mut self, source: &Path, name: &str) -> Result<(PathBuf, Vec<u8>), LoadError> {
        let missing = match self.border.read_beside(source, name) {
            Err(error @ (LoadError::Outside { .. } | LoadError::Read { .. })) => error,
            found => return found,
        };
        let base = name.rsplit(['/', '\\']).next().unwrap_or_default();
        match self.border.read_beside(source, base) {
            Ok(found) if base != name => {
                self.refer(source, base);
                let (source, named) = (source.display(), reference(name));
                self.warnings
                    .push(format!("{source}: `{named}` cannot be used; {base} next to the file is used instead"));
                Ok(found)
            }
            _ => Err(missing),
        }
    }

    /// Notes that `source` refers to a file as `name`, whether or not the file exists and is used.
    pub(crate) fn refer(&mut self, source: &Path, name: &str) {
        self.files.extend(beside(source, name));
    }

    /// Sets the local frame that the scene was written with, if its file records it: then it is read back to the same `f32`.
    pub(crate) fn prefer_origin(&mut self, origin: DVec3) {
        self.builder.prefer_origin(origin);
    }

    /// World bounds of the vertices so far; `None` if there are none.
    pub(crate) fn bounds(&self) -> Option<(DVec3, DVec3)> {
        self.builder.bounds()
    }

    /// The material for triangles without one: matt grey, added on first use.
    pub(crate) fn default_material(&mut self) -> u32 {
        let materials = &mut self.materials;
        *self.default_material.get_or_insert_with(|| {
            let default = Material::default();
            let index = materials.iter().position(|material| *material == default).unwrap_or_else(|| {
                materials.push(default);
                materials.len() - 1
            });
            index as u32
        })
    }

    /// Chooses the local frame and transforms everything to it.
    ///
    /// # Errors
    ///
    /// [`LoadError::Warnings`] if the options are strict and there are warnings.
    pub fn finish(mut self) -> Result<Scene, LoadError> {
        if let Some(error) = self.too_large {
            return Err(error);
        }
        if let Some(name) = self.animation_name.filter(|name| !self.animation.names.contains(name)) {
            let known = self.animation.others.iter().map(|other| quote(other)).collect();
            return Err(LoadError::UnknownAnimation { path: self.path, name: quote(&name), known });
        }
        if self.unusable_triangles > 0 {
            self.warnings.push(format!(
                "{} triangles with infinite, undefined or far too large coordinates were ignored",
                self.unusable_triangles
            ));
        }
        self.warnings.extend(keep_placed(&mut self.cameras, "cameras"));
        self.warnings.extend(keep_placed(&mut self.lights, "lights"));
        self.warnings.extend(keep_finite(&mut self.materials));
        let adding = keep_passive(&mut self.materials);
        self.warnings.extend(adding.map(|warning| format!("{}: {warning}", self.path.display())));
        self.warnings.extend(self.texture_files.warning(&self.path));
        if self.builder.is_empty() {
            self.warnings.push("the scene has no triangles".to_owned());
        }
        let name = self.path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let own = self.builder.triangle_count();
        self.without_uvs.extend(self.shapes_without_uvs.iter().map(|shape| own + shape.start..own + shape.end));
        let (origin, mut mesh) = self.builder.finish();
        let nowhere = unseen(&self.materials, &mesh.materials);
        self.warnings.extend(nowhere.map(|warning| format!("{}: {warning}", self.path.display())));
        self.warnings.extend(untextured(&mut mesh, &mut self.materials, &self.without_uvs));
        let warnings = self.warnings.into_list();
        if self.strict && !warnings.is_empty() {
            return Err(LoadError::Warnings { path: self.path, warnings });
        }
        let mut geometry = Geometry { origin, mesh, materials: self.materials, textures: self.textures.into() };
        let mut animation = self.animation;
        animation.note_lamps(&geometry);
        let lamps = lamps::lamps(&mut geometry);
        let cameras = self.cameras.into_iter();
        let cameras = cameras.map(|(camera, world)| Camera { position: geometry.to_local(world), ..camera }).collect();
        let lights = self.lights.into_iter();
        let list = lights.map(|(light, world)| light.at(geometry.to_local(world))).collect();
        let mut lights = Lights { list, ambient: self.ambient, background: self.background, ..Lights::default() };
        // What else the file says of lights, it means.
        if let Some(surroundings) = self.surroundings {
            lights.add(surroundings);
        }
        lights.list.extend(lamps);
        Ok(Scene {
            name,
            geometry: geometry.into(),
            lights,
            cameras,
            light_mesh: self.light_mesh,
            files: self.files.into_iter().collect(),
            warnings,
            smooth_normals: self.smooth_normals,
            animation: (!animation.is_still()).then(|| animation.into()),
        })
    }
}

/// Whether a vertex has usable coordinates after placement.
fn usable_in<P: Position>(transform: &DMat4) -> impl Fn(&P) -> bool + use<'_, P> {
    |position| is_place(transform.transform_point3(position.to_double()))
}

/// The vertices of a part, copied.
fn shape_of<P: Position>(part: &MeshPart<P>) -> Shape {
    Shape { positions: P::owned(part.positions.to_vec()), normals: part.normals.to_vec(), morph: None }
}
