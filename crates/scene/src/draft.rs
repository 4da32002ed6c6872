//! A scene while it is being read: everything in world coordinates and double precision, until the last triangle is known and
//! the local frame can be chosen.

use std::collections::BTreeSet;
use std::ops::Range;
use std::path::{Component, Path, PathBuf};

use glam::{DMat4, DVec3, Vec3};

use crate::{
    Camera, Geometry, Light, LightKind, LightMeshDefaults, Lights, LoadError, LoadOptions, Material, MeshPart, Place,
    Position, Scene, SceneBuilder, Texture,
    loaded_mesh::LoadedMesh,
    mesh_part::Room,
    texture::{TextureFiles, untextured},
    usable::{is_place, keep_finite, keep_placed},
};

/// The placement of a model in the scene, and which parts of it to use.
#[derive(Clone, Debug)]
pub(crate) struct Placement {
    /// From the model's coordinates to the world's.
    pub(crate) transform: DMat4,
    /// Replaces the model's own materials.
    pub(crate) material: Option<u32>,
    /// Use only the triangles: the surrounding scene has its own lights and cameras.
    pub(crate) part: bool,
}

impl Default for Placement {
    fn default() -> Placement {
        Placement { transform: DMat4::IDENTITY, material: None, part: false }
    }
}

/// Coordinates above this are treated as damaged, like infinite ones: their squares must fit into `f32`.
pub(crate) const LARGEST_COORDINATE: f64 = 1e18;

/// Collects the content of a file; [`Draft::finish`] turns it into a [`Scene`].
#[derive(Debug)]
pub(crate) struct Draft {
    path: PathBuf,
    options: LoadOptions,
    builder: SceneBuilder,
    unusable_triangles: usize,
    /// Triangles of parts without texture coordinates.
    without_uvs: Vec<Range<usize>>,
    /// Each camera with its world position; the camera's own position is not used.
    pub(crate) cameras: Vec<(Camera, DVec3)>,
    /// Each light with its world position; the light's own position is not used.
    pub(crate) lights: Vec<(Light, DVec3)>,
    pub(crate) materials: Vec<Material>,
    pub(crate) textures: Vec<Texture>,
    pub(crate) texture_files: TextureFiles,
    /// The file itself and all that it refers to.
    files: BTreeSet<PathBuf>,
    pub(crate) ambient: Option<Vec3>,
    pub(crate) background: Option<Vec3>,
    pub(crate) light_mesh: LightMeshDefaults,
    pub(crate) warnings: Vec<String>,
}

impl Draft {
    /// An empty scene, to be read from `path`.
    pub(crate) fn new(path: &Path, options: &LoadOptions) -> Draft {
        Draft {
            path: path.to_owned(),
            options: options.clone(),
            builder: SceneBuilder::new(),
            unusable_triangles: 0,
            without_uvs: Vec::new(),
            cameras: Vec::new(),
            lights: Vec::new(),
            materials: Vec::new(),
            textures: Vec::new(),
            texture_files: TextureFiles::default(),
            files: BTreeSet::from([path.to_owned()]),
            ambient: None,
            background: None,
            light_mesh: LightMeshDefaults::default(),
            warnings: Vec::new(),
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
        if self.builder.reserve(room) {
            Ok(())
        } else {
            Err(LoadError::Memory { path: self.path.clone(), vertices, triangles })
        }
    }

    /// Adds placed triangles. Triangles with a NaN vertex, or one too far away to compute with, are ignored and counted in a
    /// warning.
    pub(crate) fn add<P: Position>(
        &mut self,
        part: MeshPart<P>,
        transform: &DMat4,
        material: impl Fn(usize) -> u32,
    ) -> Result<(), LoadError> {
        self.check_room(part.positions.len())?;
        let usable = usable_in(transform);
        if part.positions.iter().all(&usable) {
            self.builder.append(part, transform, material);
            self.note_uvs(part.triangles.len(), !part.uvs.is_empty());
        } else {
            self.add_usable(part, transform, material, usable);
        }
        Ok(())
    }

    /// [`Draft::add`] for a mesh passed by value.
    pub(crate) fn take<P: Position>(&mut self, mesh: LoadedMesh<P>, transform: &DMat4) -> Result<(), LoadError> {
        self.check_room(mesh.positions.len())?;
        let usable = usable_in(transform);
        if mesh.positions.iter().all(&usable) {
            let (triangles, has_uvs) = (mesh.triangles.len(), !mesh.uvs.is_empty());
            self.builder.take(mesh, transform);
            self.note_uvs(triangles, has_uvs);
        } else {
            self.add_usable(mesh.part(), transform, |index| mesh.materials[index], usable);
        }
        Ok(())
    }

    fn check_room(&self, vertices: usize) -> Result<(), LoadError> {
        if self.builder.vertex_count() + vertices > u32::MAX as usize {
            return Err(LoadError::TooLarge { path: self.path.clone() });
        }
        Ok(())
    }

    /// [`Draft::add`] without the triangles that use an unusable vertex.
    fn add_usable<P: Position>(
        &mut self,
        part: MeshPart<P>,
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

    /// The path that `source`, one of the scene's files, refers to as `name`: relative to the file's own folder, with either
    /// kind of slash.
    ///
    /// # Errors
    ///
    /// [`LoadError::Outside`] if that is a URL or outside the folder of the file that was opened, unless the options allow it.
    pub(crate) fn path_beside(&self, source: &Path, name: &str) -> Result<PathBuf, LoadError> {
        let outside = || LoadError::Outside { place: Place::file(source).into(), name: name.to_owned() };
        let path = beside(source, name).ok_or_else(outside)?;
        let folder = tidy(self.path.parent().unwrap_or(Path::new("")));
        let in_folder = tidy(&path)
            .strip_prefix(folder)
            .is_ok_and(|rest| matches!(rest.components().next(), None | Some(Component::Normal(_))));
        if self.options.allow_outside || in_folder { Ok(path) } else { Err(outside()) }
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
        let default = Material::default();
        let index = self.materials.iter().position(|material| *material == default).unwrap_or_else(|| {
            self.materials.push(default);
            self.materials.len() - 1
        });
        index as u32
    }

    /// Chooses the local frame and transforms everything to it.
    ///
    /// # Errors
    ///
    /// [`LoadError::Warnings`] if the options are strict and there are warnings.
    pub(crate) fn finish(mut self) -> Result<Scene, LoadError> {
        if self.unusable_triangles > 0 {
            self.warnings.push(format!(
                "{} triangles with infinite, undefined or far too large coordinates were ignored",
                self.unusable_triangles
            ));
        }
        self.warnings.extend(keep_placed(&mut self.cameras, "cameras"));
        self.warnings.extend(keep_placed(&mut self.lights, "lights"));
        self.warnings.extend(keep_finite(&mut self.materials));
        self.warnings.extend(self.texture_files.warning());
        if self.builder.triangle_count() == 0 {
            self.warnings.push("the scene has no triangles".to_owned());
        }
        let name = self.path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let (origin, mut mesh) = self.builder.finish();
        self.warnings.extend(untextured(&mut mesh, &mut self.materials, &self.without_uvs));
        if self.options.strict && !self.warnings.is_empty() {
            return Err(LoadError::Warnings { path: self.path, warnings: self.warnings });
        }
        let geometry = Geometry { origin, mesh, materials: self.materials, textures: self.textures };
        let cameras = self.cameras.into_iter();
        let cameras = cameras.map(|(camera, world)| Camera { position: geometry.to_local(world), ..camera }).collect();
        let lights = self.lights.into_iter();
        let list = lights.map(|(light, world)| moved(light, geometry.to_local(world))).collect();
        Ok(Scene {
            name,
            geometry: geometry.into(),
            lights: Lights { list, ambient: self.ambient, background: self.background },
            cameras,
            light_mesh: self.light_mesh,
            files: self.files.into_iter().collect(),
            warnings: self.warnings,
        })
    }
}

/// Whether a vertex has usable coordinates after placement.
fn usable_in<P: Position>(transform: &DMat4) -> impl Fn(&P) -> bool + use<'_, P> {
    |position| is_place(transform.transform_point3(position.to_double()))
}

/// The path that `source` refers to as `name`; `None` if that is a URL.
fn beside(source: &Path, name: &str) -> Option<PathBuf> {
    let is_url = name.split_once("://").is_some_and(|(scheme, _)| scheme.chars().all(|c| c.is_ascii_alphanumeric()));
    let named = name.replace('\\', "/");
    let has_drive =
        matches!(named.as_bytes(), [letter, b':', ..] if letter.is_ascii_alphabetic()) && cfg!(not(windows));
    (!is_url && !has_drive).then(|| source.parent().unwrap_or(Path::new("")).join(named))
}

/// The path without `.` and `..`, by its text alone.
fn tidy(path: &Path) -> PathBuf {
    let mut tidy = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir if matches!(tidy.components().next_back(), Some(Component::Normal(_))) => {
                tidy.pop();
            }
            part => tidy.push(part),
        }
    }
    tidy
}

/// The light at another position.
fn moved(mut light: Light, to: Vec3) -> Light {
    match &mut light.kind {
        LightKind::Point { position, .. }
        | LightKind::Spot { position, .. }
        | LightKind::Sphere { position, .. }
        | LightKind::Disk { position, .. }
        | LightKind::Rectangle { position, .. } => *position = to,
        LightKind::Directional { .. } => {}
    }
    light
}

#[cfg(test)]
mod tests;
