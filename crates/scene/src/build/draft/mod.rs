//! A scene while it is being read: everything in world coordinates and double precision, until the last triangle is known and
//! the local frame can be chosen.

mod files;
mod finish;
mod room;
mod shapes;
mod textures;

use std::collections::BTreeSet;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::{DMat4, DVec3, Vec3};

use super::{
    builder::SceneBuilder,
    error::LoadError,
    file_access::FileAccess,
    load_options::LoadOptions,
    loaded_mesh::LoadedMesh,
    mesh_part::MeshPart,
    smooth::{CreaseAngle, Unsmooth, smooth},
    textures::files::TextureFiles,
    warnings::Warnings,
};
use crate::model::animation::parts::{Hold, MovingPart, Shape};
use crate::model::transforms::{is_place, mirrors};
use crate::{
    Animation, Camera, Empty, Instancing, Light, LightMeshDefaults, Material, ObjectKey, Objects, Position,
    Surroundings, Texture, UNNAMED,
};

/// Collects the content of a file; [`Draft::finish`] turns it into a [`Scene`](crate::Scene).
#[derive(Debug)]
pub struct Draft {
    path: PathBuf,
    strict: bool,
    smooth: Option<CreaseAngle>,
    /// Vertices that got a normal.
    smooth_normals: usize,
    /// The object of triangles that are added, unless their mesh names its own.
    object: ObjectKey,
    /// How many objects have been begun that may share their names.
    numbered: u32,
    /// Where the scene's files may lie.
    pub(crate) access: FileAccess,
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
    pub(crate) empties: Vec<Empty>,
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
            object: UNNAMED.into(),
            numbered: 0,
            access: FileAccess::new(path, options),
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
            empties: Vec::new(),
            warnings: Warnings::default(),
            animation: Animation::default(),
            animation_name: options.animation.clone(),
            mover: None,
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

    /// Triangles that are added from now on belong to the object `name`, unless their mesh names its own.
    pub(crate) fn begin_object(&mut self, name: impl Into<ObjectKey>) -> ObjectKey {
        self.object = name.into();
        self.object.clone()
    }

    /// The same for an object of its own, whatever others are called; returns what tells it from them.
    pub(crate) fn begin_own_object(&mut self, name: &str) -> ObjectKey {
        self.numbered = self.numbered.saturating_add(1);
        self.object = ObjectKey::numbered(name, self.numbered);
        self.object.clone()
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
        match smooth(mesh, crease, usable_in(transform), &self.access.budget) {
            Ok(count) => self.smooth_normals += count,
            Err(Unsmooth::TooMany) => return Err(LoadError::TooLarge { path: self.path.clone() }),
            Err(Unsmooth::Memory(short)) => {
                let (path, triangles) = (self.path.clone(), mesh.triangles.len());
                return Err(LoadError::SmoothMemory { path, triangles, short });
            }
        }
        Ok(())
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
}

/// Whether a vertex has usable coordinates after placement.
fn usable_in<P: Position>(transform: &DMat4) -> impl Fn(&P) -> bool + use<'_, P> {
    |position| is_place(transform.transform_point3(position.to_double()))
}

/// The vertices of a part, copied.
fn shape_of<P: Position>(part: &MeshPart<P>) -> Shape {
    Shape { positions: P::owned(part.positions.to_vec()), normals: part.normals.to_vec(), morph: None }
}
