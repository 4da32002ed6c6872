//! Collects the parts of a scene and chooses the local frame once all are known.
//!
//! A scene has its own local frame: files are read in double precision and stored in single precision relative to a point near the geometry, so
//! that a scene may lie far from the world's origin.

use std::ops::Range;

use glam::{DMat4, DVec3, Vec2, Vec3};

use super::{
    geometry_check::{GeometryError, check_affine, check_room},
    loaded_mesh::LoadedMesh,
    mesh_part::{MeshPart, Room},
    sanitize::{clamp_reflectance, keep_finite, too_long, unseen},
    vertices::{Vertices, reserve},
};
use crate::model::instances::MAX_INSTANCED;
use crate::model::transforms::{mirrors, normal_placement};
use crate::{Affine, Geometry, Instances, Material, Mesh, ObjectKey, Objects, Position, Scene, UNNAMED};

/// Collects placed meshes and their materials; [`SceneBuilder::finish_scene`] turns them into a scene in a local frame.
///
/// ```
/// use lightmesh_scene::{MeshPart, SceneBuilder, glam::{DMat4, Vec3}};
///
/// let positions = [Vec3::ZERO, Vec3::X, Vec3::Y];
/// let mut builder = SceneBuilder::new();
/// builder.add(MeshPart { positions: &positions, triangles: &[[0, 1, 2]], ..MeshPart::default() }, &DMat4::IDENTITY, |_| 0)?;
/// let scene = builder.finish_scene("one triangle");
/// assert_eq!(scene.geometry.mesh.triangles.len(), 1);
/// # Ok::<(), lightmesh_scene::GeometryError>(())
/// ```
#[derive(Debug, Default)]
pub struct SceneBuilder {
    vertices: Vertices,
    normals: Vec<Vec3>,
    uvs: Vec<Vec2>,
    colors: Vec<Vec3>,
    opacities: Vec<f32>,
    triangles: Vec<[u32; 3]>,
    /// Material by triangle.
    materials: Vec<u32>,
    objects: Objects,
    palette: Vec<Material>,
    origin: Option<DVec3>,
    shapes: Shapes,
}

/// Shapes that are placed many times.
#[derive(Debug, Default)]
struct Shapes {
    /// Their triangles, as they are without a place; none in the builder of shapes itself.
    builder: Option<Box<SceneBuilder>>,
    placed: Vec<PlacedShape>,
    /// Number of triangles in all places.
    triangles: usize,
}

/// A shape at a place.
#[derive(Debug)]
struct PlacedShape {
    /// Its triangles in the builder of shapes.
    triangles: Range<usize>,
    transform: DMat4,
    object: Option<ObjectKey>,
}

impl SceneBuilder {
    /// A builder without triangles.
    pub fn new() -> SceneBuilder {
        SceneBuilder::default()
    }

    /// Adds a material and returns its index for [`SceneBuilder::add`].
    pub fn add_material(&mut self, material: Material) -> u32 {
        self.palette.push(material);
        self.palette.len() as u32 - 1
    }

    /// Number of materials so far, which is the index of the next.
    pub fn material_count(&self) -> u32 {
        self.palette.len() as u32
    }

    /// Exchanges this with the builder of shapes, which are stored once, however often they are [placed](SceneBuilder::place): what is added to it
    /// is nowhere yet. The second call goes back.
    pub(crate) fn exchange_shapes(&mut self, kept: &mut Option<Box<SceneBuilder>>) {
        match kept.take() {
            None => {
                let shapes = self.shapes.builder.take().unwrap_or_default();
                *kept = Some(Box::new(std::mem::replace(self, *shapes)));
            }
            Some(own) => {
                let shapes = std::mem::replace(self, *own);
                self.shapes.builder = Some(Box::new(shapes));
            }
        }
    }

    /// Reverses the order of corners, for places that mirror.
    pub(crate) fn reverse(&mut self, triangles: Range<usize>) {
        self.triangles[triangles].iter_mut().for_each(|triangle| triangle.swap(1, 2));
    }

    /// The objects of some triangles, each with a run of them; none if nothing was named.
    pub(crate) fn objects_of(&self, triangles: &Range<usize>) -> Vec<(Range<usize>, ObjectKey)> {
        if self.objects.runs().0.is_empty() {
            return Vec::new();
        }
        let runs = self
            .objects
            .ranges(triangles.end as u32)
            .map(|(run, object)| (triangles.start.max(run.start as usize)..run.end as usize, self.objects.key(object)));
        runs.filter(|(run, _)| !run.is_empty()).collect()
    }

    /// Number of places of shapes so far.
    pub(crate) fn place_count(&self) -> usize {
        self.shapes.placed.len()
    }

    /// Whether there is nothing to be seen.
    pub(crate) fn is_empty(&self) -> bool {
        self.triangles.is_empty() && self.shapes.placed.is_empty()
    }

    /// Places a shape, as the object `object`. Returns whether it can be placed so; else nothing has changed.
    pub(crate) fn place(&mut self, triangles: Range<usize>, transform: &DMat4, object: Option<&ObjectKey>) -> bool {
        if !Affine::holds(transform) || self.shapes.triangles + triangles.len() >= MAX_INSTANCED {
            return false;
        }
        self.shapes.triangles += triangles.len();
        self.shapes.placed.push(PlacedShape { triangles, transform: *transform, object: object.cloned() });
        true
    }

    /// Triangles that are added from now on belong to this object, for example one of a name. Those before the first call are
    /// [`UNNAMED`](crate::UNNAMED).
    pub fn begin_object(&mut self, object: impl Into<ObjectKey>) {
        self.objects.begin(self.triangles.len(), object);
    }

    /// Triangles that are added from now on belong to the objects of another mesh; `place` says where each of its triangles is among them.
    pub(crate) fn begin_objects(&mut self, objects: &Objects, place: impl Fn(u32) -> usize) {
        self.objects.append(self.triangles.len(), objects, place);
    }

    /// Adds `part`, placed by `transform`; `material` returns the material of each of its triangles. If the transform mirrors,
    /// the triangles' vertex order is reversed, so that front faces stay front faces.
    ///
    /// # Errors
    ///
    /// [`GeometryError`] if an index is out of range, lengths do not match, or the transform is not affine; then nothing was added.
    pub fn add<P: Position>(
        &mut self,
        part: MeshPart<P>,
        transform: &DMat4,
        material: impl Fn(usize) -> u32,
    ) -> Result<(), GeometryError> {
        part.check()?;
        check_affine(std::slice::from_ref(transform))?;
        check_room(self.vertex_count() + part.positions.len(), self.triangle_count() + part.triangles.len())?;
        self.append(part, transform, material);
        Ok(())
    }

    /// Adds a part that is stored once for several places, each of them an object with this name; `material` returns the material of each of its
    /// triangles.
    ///
    /// # Errors
    ///
    /// As [`SceneBuilder::add`], and [`GeometryError::Place`] if a map cannot be inverted, or distorts too much; then nothing was added.
    pub fn add_instances<P: Position>(
        &mut self,
        part: MeshPart<P>,
        places: &[DMat4],
        object: &str,
        material: impl Fn(usize) -> u32,
    ) -> Result<(), GeometryError> {
        part.check()?;
        if let Some(place) = places.iter().position(|place| !Affine::holds(place)) {
            return Err(GeometryError::Place { place });
        }
        check_affine(places)?;
        let count = part.triangles.len();
        let all = self.shapes.triangles + count.saturating_mul(places.len());
        check_room(self.vertex_count() + part.positions.len(), self.triangle_count() + 2 * count)?;
        if all >= MAX_INSTANCED {
            return Err(GeometryError::TooLarge { vertices: self.vertex_count(), triangles: all });
        }
        // The shape, and behind it the same with its corners in reverse order for places that mirror.
        let is_mirrored = places.iter().any(mirrors);
        let mut own = None;
        self.exchange_shapes(&mut own);
        let first = self.triangle_count();
        self.append(part, &DMat4::IDENTITY, &material);
        if is_mirrored {
            self.append(part, &DMat4::IDENTITY, &material);
            self.reverse(first + count..first + 2 * count);
        }
        self.exchange_shapes(&mut own);
        let object = ObjectKey::from(object);
        for place in places {
            let first = first + if mirrors(place) { count } else { 0 };
            self.place(first..first + count, place, Some(&object));
        }
        Ok(())
    }

    /// [`SceneBuilder::add`] for a part that is known to be consistent, such as those from loaders.
    pub(crate) fn append<P: Position>(
        &mut self,
        part: MeshPart<P>,
        transform: &DMat4,
        material: impl Fn(usize) -> u32,
    ) {
        let first = self.vertices.count() as u32;
        self.vertices.add(P::slice(part.positions), transform);

        let place_normal = normal_placement(transform);
        fill_to(&mut self.normals, first, Vec3::ZERO, !part.normals.is_empty());
        self.normals.extend(part.normals.iter().map(|&normal| place_normal(normal)));
        fill_to(&mut self.uvs, first, Vec2::ZERO, !part.uvs.is_empty());
        self.uvs.extend(part.uvs);
        fill_to(&mut self.colors, first, Vec3::ONE, !part.colors.is_empty());
        self.colors.extend(part.colors);
        fill_to(&mut self.opacities, first, 1.0, !part.opacities.is_empty());
        self.opacities.extend(part.opacities);

        let mirrored = mirrors(transform);
        self.triangles.extend(part.triangles.iter().map(|&[a, b, c]| {
            let [b, c] = if mirrored { [c, b] } else { [b, c] };
            [first + a, first + b, first + c]
        }));
        self.materials.extend((0..part.triangles.len()).map(material));
    }

    /// [`SceneBuilder::append`] for a mesh passed by value: the first one is placed without copying.
    pub(crate) fn take<P: Position>(&mut self, mut mesh: LoadedMesh<P>, transform: &DMat4) {
        if self.vertex_count() > 0 || self.triangle_count() > 0 {
            let materials = std::mem::take(&mut mesh.materials);
            self.append(mesh.part(), transform, |index| materials[index]);
            return;
        }
        self.vertices.take(P::owned(mesh.positions), transform);
        let place_normal = normal_placement(transform);
        mesh.normals.iter_mut().for_each(|normal| *normal = place_normal(*normal));
        if mirrors(transform) {
            mesh.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        }
        self.normals = mesh.normals;
        self.uvs = mesh.uvs;
        self.colors = mesh.colors;
        self.triangles = mesh.triangles;
        self.materials = mesh.materials;
    }

    /// Reserves memory; `false` if there is not enough.
    pub(crate) fn reserve(&mut self, room: &Room) -> bool {
        let of = |used: bool| if used { room.vertices } else { 0 };
        self.vertices.reserve(room.vertices)
            && reserve(&mut self.normals, of(room.normals))
            && reserve(&mut self.uvs, of(room.uvs))
            && reserve(&mut self.colors, of(room.colors))
            && reserve(&mut self.opacities, of(room.opacities))
            && reserve(&mut self.triangles, room.triangles)
            && reserve(&mut self.materials, room.triangles)
    }

    /// Number of triangles for which memory is reserved.
    pub(crate) fn reserved_triangles(&self) -> usize {
        self.triangles.capacity() - self.triangles.len()
    }

    /// Number of triangles so far, without those of shapes.
    pub fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// Number of vertices so far.
    pub fn vertex_count(&self) -> usize {
        self.vertices.count()
    }

    /// Lowest and highest corner of the bounding box of all finite vertices so far; `None` if there are none.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let own = self.vertices.bounds();
        let Some((low, high)) = self.shapes.builder.as_ref().and_then(|shapes| shapes.vertices.bounds()) else {
            return own;
        };
        // Those of boxes around shapes are a little larger.
        let corner = |k: u32| {
            let axis = |axis: usize| if k >> axis & 1 == 0 { low[axis] } else { high[axis] };
            DVec3::new(axis(0), axis(1), axis(2))
        };
        let corners =
            |placed: &PlacedShape| (0..8).map(|k| placed.transform.transform_point3(corner(k))).collect::<Vec<_>>();
        self.shapes.placed.iter().flat_map(corners).fold(own, |bounds, corner| match bounds {
            Some((low, high)) => Some((low.min(corner), high.max(corner))),
            None => Some((corner, corner)),
        })
    }

    /// Uses this origin instead of choosing one. For scenes that were written with an origin: they are read back to the same
    /// `f32`.
    pub fn prefer_origin(&mut self, origin: DVec3) {
        self.origin = Some(origin);
    }

    /// Chooses the origin of the local frame and returns it with the finished mesh.
    ///
    /// The origin is zero unless the geometry is so far from the world's origin that `f32` would lose detail: then it is a point
    /// near the centre, rounded to a power of two of the scene's size so that the subtraction is exact.
    pub fn finish(mut self) -> (DVec3, Mesh) {
        let origin = self.origin.unwrap_or_else(|| self.bounds().map_or(DVec3::ZERO, local_origin));
        let Shapes { builder: shapes, placed, .. } = std::mem::take(&mut self.shapes);
        self.fill();
        let mut mesh = Mesh {
            positions: self.vertices.finish(origin),
            normals: self.normals,
            uvs: self.uvs,
            colors: self.colors,
            opacities: self.opacities,
            triangles: self.triangles,
            materials: self.materials,
            objects: self.objects,
            instances: Instances::default(),
        };
        if let Some(shapes) = shapes {
            add_shapes(&mut mesh, *shapes, &placed, origin);
        }
        (origin, mesh)
    }

    /// Attributes of some vertices are those of all.
    fn fill(&mut self) {
        let vertices = self.vertices.count() as u32;
        fill_to(&mut self.normals, vertices, Vec3::ZERO, false);
        fill_to(&mut self.uvs, vertices, Vec2::ZERO, false);
        fill_to(&mut self.colors, vertices, Vec3::ONE, false);
        fill_to(&mut self.opacities, vertices, 1.0, false);
    }

    /// A scene with only the meshes and materials, in its local frame: place cameras and lights with [`Scene::to_local`]. If no
    /// material was added, there is one, the default. Coefficients that are not finite, or that add light, are corrected with a
    /// warning of the scene.
    pub fn finish_scene(mut self, name: impl Into<String>) -> Scene {
        let mut materials = std::mem::take(&mut self.palette);
        if materials.is_empty() && self.triangle_count() > 0 {
            materials.push(Material::default());
        }
        let changed = [keep_finite(&mut materials), clamp_reflectance(&mut materials)];
        let (origin, mesh) = self.finish();
        let noticed = [unseen(&materials, &mesh.materials), too_long(&mesh)];
        let warnings = changed.into_iter().chain(noticed).flatten().collect();
        Scene { warnings, ..Scene::new(name, Geometry { origin, mesh, materials, ..Geometry::default() }) }
    }
}

/// Adds shapes behind all other triangles of a mesh, and their places.
fn add_shapes(mesh: &mut Mesh, mut shapes: SceneBuilder, placed: &[PlacedShape], origin: DVec3) {
    shapes.fill();
    let (first, first_triangle) = (mesh.positions.len() as u32, mesh.triangles.len() as u32);
    let center = shapes.vertices.bounds().map_or(DVec3::ZERO, local_origin);
    let SceneBuilder { vertices, normals, uvs, colors, opacities, triangles, materials, .. } = shapes;
    mesh.append_vertices(&Mesh {
        positions: vertices.finish(center),
        normals,
        uvs,
        colors,
        opacities,
        ..Mesh::default()
    });
    mesh.triangles.extend(triangles.iter().map(|triangle| triangle.map(|vertex| first + vertex)));
    mesh.materials.extend(materials);
    mesh.instances.shapes = first_triangle..mesh.triangles.len() as u32;
    mesh.instances.vertices = first..mesh.positions.len() as u32;
    mesh.instances.center = center;
    let (to_shapes, to_local) = (DMat4::from_translation(center), DMat4::from_translation(-origin));
    for PlacedShape { triangles, transform, object } in placed {
        let range = first_triangle + triangles.start as u32..first_triangle + triangles.end as u32;
        let object = object.clone().unwrap_or_else(|| UNNAMED.into());
        mesh.place(range, &(to_local * *transform * to_shapes), object);
    }
    mesh.find_instance_bounds();
}

/// Extends an attribute with `none` to `count` vertices, if the attribute is used at all.
fn fill_to<T: Clone>(attribute: &mut Vec<T>, count: u32, none: T, used: bool) {
    if used || !attribute.is_empty() {
        attribute.resize(count as usize, none);
    }
}

/// How many radii a scene may be from the world's origin before it gets its own origin: there `f32` has lost 3 of its 24 bits.
const FAR: f64 = 8.0;

fn local_origin((min, max): (DVec3, DVec3)) -> DVec3 {
    let center = 0.5 * (min + max);
    let radius = 0.5 * (max - min).length();
    if !center.is_finite() || radius <= 0.0 || center.abs().max_element() <= FAR * radius {
        return DVec3::ZERO;
    }
    let unit = radius.log2().ceil().exp2();
    (center / unit).round() * unit
}
