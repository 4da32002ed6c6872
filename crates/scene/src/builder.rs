//! Collects the parts of a scene and chooses the local frame once all are known.

use glam::{DMat4, DVec3, Vec2, Vec3};

use crate::{Mesh, Position, Scene, vertices::Vertices};

/// One mesh as a file holds it, before it is placed. Slices are as long as `positions` or empty.
#[derive(Clone, Copy, Debug)]
pub struct MeshPart<'a, P = DVec3> {
    /// Vertices in the part's own coordinates, `Vec3` or `DVec3`.
    pub positions: &'a [P],
    /// Normals by vertex; need not be unit length.
    pub normals: &'a [Vec3],
    /// Texture coordinates by vertex.
    pub uvs: &'a [Vec2],
    /// Linear colours by vertex.
    pub colors: &'a [Vec3],
    /// Three vertex indices a triangle, all in range.
    pub triangles: &'a [[u32; 3]],
}

impl<P> Default for MeshPart<'_, P> {
    fn default() -> Self {
        MeshPart { positions: &[], normals: &[], uvs: &[], colors: &[], triangles: &[] }
    }
}

/// How much room a scene needs, where that is known before it is read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Room {
    pub(crate) vertices: usize,
    pub(crate) triangles: usize,
    /// Whether any part has them.
    pub(crate) normals: bool,
    pub(crate) uvs: bool,
    pub(crate) colors: bool,
}

impl Room {
    /// Room for this, and for `count` times `more`.
    pub(crate) fn and(&self, more: &Room, count: usize) -> Room {
        let sum = |a: usize, b: usize| a.saturating_add(b.saturating_mul(count));
        Room {
            vertices: sum(self.vertices, more.vertices),
            triangles: sum(self.triangles, more.triangles),
            normals: self.normals || more.normals,
            uvs: self.uvs || more.uvs,
            colors: self.colors || more.colors,
        }
    }
}

/// One mesh as a loader has put it together. It is handed over: of a large file nothing is held twice.
#[derive(Debug, Default)]
pub(crate) struct LoadedMesh {
    /// Vertices in the file's coordinates.
    pub(crate) positions: Vec<DVec3>,
    /// Normals by vertex, or none; need not be unit length.
    pub(crate) normals: Vec<Vec3>,
    /// Texture coordinates by vertex, or none.
    pub(crate) uvs: Vec<Vec2>,
    /// Linear colours by vertex, or none.
    pub(crate) colors: Vec<Vec3>,
    /// Three vertex indices a triangle, all in range.
    pub(crate) triangles: Vec<[u32; 3]>,
    /// Material by triangle.
    pub(crate) materials: Vec<u32>,
}

impl LoadedMesh {
    /// The mesh without its materials.
    pub(crate) fn part(&self) -> MeshPart<'_> {
        let LoadedMesh { positions, normals, uvs, colors, triangles, .. } = self;
        MeshPart { positions, normals, uvs, colors, triangles }
    }

    /// Makes the vertices those that `chosen` names, in that order. Triangles are left as they are.
    pub(crate) fn choose_vertices(&mut self, chosen: impl Iterator<Item = u32> + Clone) {
        fn choose<T: Copy>(values: &mut Vec<T>, chosen: impl Iterator<Item = u32>) {
            if !values.is_empty() {
                *values = chosen.map(|vertex| values[vertex as usize]).collect();
            }
        }
        choose(&mut self.positions, chosen.clone());
        choose(&mut self.normals, chosen.clone());
        choose(&mut self.uvs, chosen.clone());
        choose(&mut self.colors, chosen);
    }

    /// Drops vertices that no triangle uses: one that lies far away would move the local frame.
    pub(crate) fn drop_unused_vertices(&mut self) {
        let mut used = vec![false; self.positions.len()];
        self.triangles.iter().flatten().for_each(|&vertex| used[vertex as usize] = true);
        if used.iter().all(|&used| used) {
            return;
        }
        let mut place = Vec::with_capacity(used.len());
        let mut kept = 0;
        for &used in &used {
            place.push(kept);
            kept += u32::from(used);
        }
        self.choose_vertices((0..used.len() as u32).filter(|&vertex| used[vertex as usize]));
        self.triangles.iter_mut().flatten().for_each(|vertex| *vertex = place[*vertex as usize]);
    }
}

/// Gathers placed meshes; [`SceneBuilder::finish`] makes them one [`Mesh`] in a local frame.
#[derive(Debug, Default)]
pub struct SceneBuilder {
    vertices: Vertices,
    normals: Vec<Vec3>,
    uvs: Vec<Vec2>,
    colors: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    materials: Vec<u32>,
    origin: Option<DVec3>,
}

impl SceneBuilder {
    /// A builder without triangles.
    pub fn new() -> SceneBuilder {
        SceneBuilder::default()
    }

    /// Adds `part` placed by `transform`; `material` gives the material of each of its triangles. A transform that mirrors
    /// turns the triangles' order round, so that front faces stay front faces.
    pub fn add<P: Position>(&mut self, part: MeshPart<P>, transform: &DMat4, material: impl Fn(usize) -> u32) {
        let first = self.vertices.len() as u32;
        self.vertices.add(P::slice(part.positions), transform);

        let place_normal = normal_placement(transform);
        fill_to(&mut self.normals, first, Vec3::ZERO, !part.normals.is_empty());
        self.normals.extend(part.normals.iter().map(|&normal| place_normal(normal)));
        fill_to(&mut self.uvs, first, Vec2::ZERO, !part.uvs.is_empty());
        self.uvs.extend(part.uvs);
        fill_to(&mut self.colors, first, Vec3::ONE, !part.colors.is_empty());
        self.colors.extend(part.colors);

        let mirrored = mirrors(transform);
        self.triangles.extend(part.triangles.iter().map(|&[a, b, c]| {
            let [b, c] = if mirrored { [c, b] } else { [b, c] };
            [first + a, first + b, first + c]
        }));
        self.materials.extend((0..part.triangles.len()).map(material));
    }

    /// Makes room for what is to come; `false` where there is not enough memory.
    pub(crate) fn reserve(&mut self, room: &Room) -> bool {
        let of = |used: bool| if used { room.vertices } else { 0 };
        self.vertices.reserve(room.vertices)
            && self.normals.try_reserve_exact(of(room.normals)).is_ok()
            && self.uvs.try_reserve_exact(of(room.uvs)).is_ok()
            && self.colors.try_reserve_exact(of(room.colors)).is_ok()
            && self.triangles.try_reserve_exact(room.triangles).is_ok()
            && self.materials.try_reserve_exact(room.triangles).is_ok()
    }

    /// [`SceneBuilder::add`] of a mesh that is handed over: the first one is placed where it lies in memory.
    pub(crate) fn take(&mut self, mut mesh: LoadedMesh, transform: &DMat4) {
        if self.vertex_count() > 0 || self.triangle_count() > 0 {
            let materials = std::mem::take(&mut mesh.materials);
            self.add(mesh.part(), transform, |index| materials[index]);
            return;
        }
        if *transform != DMat4::IDENTITY {
            mesh.positions.iter_mut().for_each(|position| *position = transform.transform_point3(*position));
        }
        let place_normal = normal_placement(transform);
        mesh.normals.iter_mut().for_each(|normal| *normal = place_normal(*normal));
        if mirrors(transform) {
            mesh.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        }
        self.vertices.take(mesh.positions);
        self.normals = mesh.normals;
        self.uvs = mesh.uvs;
        self.colors = mesh.colors;
        self.triangles = mesh.triangles;
        self.materials = mesh.materials;
    }

    /// Number of triangles so far.
    pub fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// Number of vertices so far.
    pub fn vertex_count(&self) -> usize {
        self.vertices.len()
    }

    /// Lowest and highest corner of the box around all finite vertices so far; `None` without any.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        self.vertices.bounds()
    }

    /// Takes this origin instead of choosing one. For scenes that were written with an origin: they are read to the same `f32`.
    pub fn prefer_origin(&mut self, origin: DVec3) {
        self.origin = Some(origin);
    }

    /// Chooses the origin of the local frame and returns it with the finished mesh.
    ///
    /// The origin is zero unless the geometry lies so far from the world's origin that `f32` would lose detail: then it is a
    /// point near the middle, rounded to a power of two of the scene's size so that the subtraction loses nothing.
    pub fn finish(mut self) -> (DVec3, Mesh) {
        let origin = self.origin.unwrap_or_else(|| self.bounds().map_or(DVec3::ZERO, local_origin));
        let vertices = self.vertices.len() as u32;
        fill_to(&mut self.normals, vertices, Vec3::ZERO, false);
        fill_to(&mut self.uvs, vertices, Vec2::ZERO, false);
        fill_to(&mut self.colors, vertices, Vec3::ONE, false);
        let mesh = Mesh {
            positions: self.vertices.finish(origin),
            normals: self.normals,
            uvs: self.uvs,
            colors: self.colors,
            triangles: self.triangles,
            materials: self.materials,
        };
        (origin, mesh)
    }

    /// A scene that holds the mesh alone, in its local frame: place cameras and lights with [`Scene::to_local`].
    pub fn finish_scene(self, name: impl Into<String>) -> Scene {
        let (origin, mesh) = self.finish();
        Scene {
            name: name.into(),
            origin,
            mesh,
            materials: Vec::new(),
            textures: Vec::new(),
            lights: Vec::new(),
            cameras: Vec::new(),
            ambient: None,
            background: None,
            light_mesh: Default::default(),
            warnings: Vec::new(),
        }
    }
}

/// Normals are turned by the inverse transpose of what places positions.
fn normal_placement(transform: &DMat4) -> impl Fn(Vec3) -> Vec3 + use<> {
    let matrix = transform.inverse().transpose();
    move |normal| matrix.transform_vector3(normal.as_dvec3()).normalize_or_zero().as_vec3()
}

fn mirrors(transform: &DMat4) -> bool {
    transform.determinant() < 0.0
}

/// Lengthens an attribute with `none` up to `count` vertices, where the attribute is used at all.
fn fill_to<T: Clone>(attribute: &mut Vec<T>, count: u32, none: T, used: bool) {
    if used || !attribute.is_empty() {
        attribute.resize(count as usize, none);
    }
}

/// How many radii a scene may lie from the world's origin before it gets an origin of its own: there `f32` has lost 3 of its
/// 24 bits.
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

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [DVec3; 3] = [DVec3::ZERO, DVec3::X, DVec3::Y];

    fn part() -> MeshPart<'static> {
        MeshPart { positions: &CORNERS, triangles: &[[0, 1, 2]], ..Default::default() }
    }

    #[test]
    fn a_scene_at_home_keeps_its_coordinates() {
        let mut builder = SceneBuilder::new();
        builder.add(part(), &DMat4::IDENTITY, |_| 0);
        let (origin, mesh) = builder.finish();
        assert_eq!(origin, DVec3::ZERO);
        assert_eq!(mesh.corners(0), [Vec3::ZERO, Vec3::X, Vec3::Y]);
    }

    #[test]
    fn a_scene_far_away_keeps_its_shape() {
        let offset = DVec3::new(1e6 + 0.125, -3e5, 7e4);
        let mut builder = SceneBuilder::new();
        builder.add(part(), &DMat4::from_translation(offset), |_| 0);
        let (origin, mesh) = builder.finish();
        let [a, b, c] = mesh.corners(0);
        assert!((b - a - Vec3::X).length() < 1e-6 && (c - a - Vec3::Y).length() < 1e-6);
        assert!((origin + a.as_dvec3() - offset).length() < 1e-6);
    }

    #[test]
    fn a_mirror_keeps_the_front_in_front() {
        let mut builder = SceneBuilder::new();
        builder.add(part(), &DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0)), |_| 0);
        let [a, b, c] = builder.finish().1.corners(0);
        assert!((b - a).cross(c - a).z > 0.0);
    }

    #[test]
    fn a_mesh_handed_over_is_the_same_as_a_part_added() {
        let placements = [DMat4::IDENTITY, DMat4::from_scale(DVec3::new(-2.0, 3.0, 1.0)) * DMat4::from_rotation_x(1.0)];
        let loaded = || LoadedMesh {
            positions: CORNERS.to_vec(),
            normals: vec![Vec3::new(1.0, 2.0, 3.0); 3],
            colors: vec![Vec3::X; 3],
            triangles: vec![[0, 1, 2]],
            materials: vec![7],
            ..Default::default()
        };
        for placement in placements {
            let (mut added, mut taken) = (SceneBuilder::new(), SceneBuilder::new());
            // The first is moved in, the second copied behind it.
            for _ in 0..2 {
                added.add(loaded().part(), &placement, |_| 7);
                taken.take(loaded(), &placement);
            }
            let (added, taken) = (added.finish().1, taken.finish().1);
            assert_eq!((added.positions, added.normals), (taken.positions, taken.normals));
            assert_eq!((added.triangles, added.materials), (taken.triangles, taken.materials));
            assert_eq!((added.colors, added.uvs), (taken.colors, taken.uvs));
        }
    }

    #[test]
    fn vertices_without_a_triangle_are_dropped() {
        let mut mesh = LoadedMesh {
            positions: (0..6).map(|x| DVec3::splat(f64::from(x))).collect(),
            colors: (0..6).map(|x| Vec3::splat(x as f32)).collect(),
            triangles: vec![[5, 1, 3], [1, 3, 4]],
            ..Default::default()
        };
        let corners =
            |mesh: &LoadedMesh| mesh.triangles.iter().flatten().map(|&v| mesh.positions[v as usize]).collect();
        let before: Vec<DVec3> = corners(&mesh);
        mesh.drop_unused_vertices();
        assert_eq!(mesh.positions.len(), 4);
        assert_eq!(corners(&mesh), before);
        assert!(mesh.colors.iter().zip(&mesh.positions).all(|(color, position)| color.as_dvec3() == *position));
        assert!(mesh.normals.is_empty());
    }

    #[test]
    fn parts_without_normals_stand_beside_parts_with() {
        let mut builder = SceneBuilder::new();
        builder.add(part(), &DMat4::IDENTITY, |_| 0);
        builder.add(MeshPart { normals: &[Vec3::Z; 3], ..part() }, &DMat4::IDENTITY, |_| 1);
        builder.add(part(), &DMat4::IDENTITY, |_| 2);
        let mesh = builder.finish().1;
        assert_eq!(mesh.normals.len(), 9);
        assert_eq!((mesh.normals[0], mesh.normals[3], mesh.normals[8]), (Vec3::ZERO, Vec3::Z, Vec3::ZERO));
        assert_eq!(mesh.materials, [0, 1, 2]);
    }
}
