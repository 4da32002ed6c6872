//! `[[mesh]]` and the solids to triangles.

use std::collections::HashMap;
use std::ops::Range;
use std::path::Path;

use glam::{DMat4, DVec2, DVec3, Vec2};

use super::{
    check::{Source, required},
    motion,
    motion_schema::ObjectMotionEntry,
    schema::{BoxEntry, CylinderEntry, MeshEntry, PlaneEntry, SceneFile, TriangleEntry},
    spanned::Spanned,
    values::{Scale, Text, Vector},
};
use crate::LoadError;
use crate::build::draft::Draft;
use crate::build::shapes::{Shape, tangents};
use crate::formats::models::read_part;
use crate::model::transforms::mirrors;

/// Default edge of a plane, in diagonals of the rest of the scene.
const PLANE_DIAGONALS: f64 = 20.0;

/// Adds all triangles of the file; `names` are the indices of its materials. Planes come last, because their
/// size may depend on the rest.
pub(super) fn read(
    source: &Source,
    file: &SceneFile,
    names: &HashMap<String, u32>,
    draft: &mut Draft,
) -> Result<(), LoadError> {
    let material = |draft: &mut Draft, name: &Option<Text>| match name {
        Some(name) => source.index_of("material", name, names),
        None => Ok(draft.default_material()),
    };
    let add = |draft: &mut Draft, shape: Shape, transform: &DMat4, solid: Solid| {
        let material = material(draft, solid.material)?;
        draft.begin_object(solid.object);
        let shape = if draft.materials[material as usize].needs_uvs() { shape.textured() } else { shape };
        draft.mover = match solid.motion {
            Some(motion) => Some(motion::object(source, motion, middle(&shape, transform), draft)?),
            None => None,
        };
        draft.add(shape.part(), transform, |_| material)?;
        draft.mover = None;
        Ok(())
    };
    let mut repeats = Repeats::of(file);
    for entry in &file.mesh {
        read_mesh(source, entry.get_ref(), names, &mut repeats, draft)?;
    }
    for (number, entry) in (1..).zip(file.sphere.iter().map(Spanned::get_ref)) {
        let center = source.vector("center", &entry.center)?;
        let radius = source.positive("radius", &entry.radius)?;
        let shape = Shape::sphere(DVec3::ZERO, radius, source.segments(&entry.segments)?);
        add(
            draft,
            shape,
            &DMat4::from_translation(center),
            Solid::new(("sphere", number), &entry.name, &entry.material, &entry.motion),
        )?;
    }
    for (number, entry) in (1..).zip(&file.boxes) {
        let (shape, transform) = cuboid(source, entry)?;
        let (entry, kind) = (entry.get_ref(), "box");
        add(draft, shape, &transform, Solid::new((kind, number), &entry.name, &entry.material, &entry.motion))?;
    }
    for (number, entry) in (1..).zip(&file.cylinder) {
        let (shape, entry) = (cylinder(source, entry)?, entry.get_ref());
        add(
            draft,
            shape,
            &DMat4::IDENTITY,
            Solid::new(("cylinder", number), &entry.name, &entry.material, &entry.motion),
        )?;
    }
    for (number, entry) in (1..).zip(&file.triangle) {
        let (shape, entry) = (triangle(source, entry)?, entry.get_ref());
        add(
            draft,
            shape,
            &DMat4::IDENTITY,
            Solid::new(("triangle", number), &entry.name, &entry.material, &entry.motion),
        )?;
    }
    let rest = draft.bounds();
    for (number, entry) in (1..).zip(&file.plane) {
        let (shape, entry) = (plane(source, entry, rest)?, entry.get_ref());
        add(
            draft,
            shape,
            &DMat4::IDENTITY,
            Solid::new(("plane", number), &entry.name, &entry.material, &entry.motion),
        )?;
    }
    Ok(())
}

/// What the tables of all solids have.
struct Solid<'a> {
    material: &'a Option<Text>,
    object: String,
    motion: Option<&'a ObjectMotionEntry>,
}

impl<'a> Solid<'a> {
    /// A solid with or without a name of its own: else it is named by its kind and its number among those of this kind.
    fn new(
        (kind, number): (&str, usize),
        name: &Option<Text>,
        material: &'a Option<Text>,
        motion: &'a Option<ObjectMotionEntry>,
    ) -> Solid<'a> {
        let object = name.as_ref().map_or_else(|| format!("{kind} {number}"), |name| name.get_ref().clone());
        Solid { material, object, motion: motion.as_ref() }
    }
}

/// The middle of the box around a shape.
fn middle(shape: &Shape, transform: &DMat4) -> DVec3 {
    let corners = shape.part().positions.iter().map(|&corner| transform.transform_point3(corner));
    let (low, high) =
        corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), corner| (low.min(corner), high.max(corner)));
    0.5 * (low + high)
}

/// A shape of more objects is placed as a whole, under the name of its file.
const MOST_OBJECTS: usize = 64;

/// What makes tables place the same shape: the file, the material, and whether they mirror.
type ShapeKey = (String, Option<String>, bool);

/// What is known of a shape that several tables place.
enum Known {
    /// The first one was copied: so many triangles.
    Copied(usize),
    /// It is stored once; nothing if it cannot be.
    Stored(Option<Range<usize>>),
}

/// Tables that place the same shape.
struct Repeats {
    /// How often.
    places: HashMap<(String, Option<String>), usize>,
    known: HashMap<ShapeKey, Known>,
}

impl Repeats {
    fn of(file: &SceneFile) -> Repeats {
        let mut places = HashMap::new();
        for entry in file.mesh.iter().map(Spanned::get_ref) {
            *places.entry(what_is_placed(entry)).or_insert(0) += 1;
        }
        Repeats { places, known: HashMap::new() }
    }

    /// Places the shape of a table that others place, too; `false` if it has to be copied.
    fn place(
        &mut self,
        entry: &MeshEntry,
        transform: &DMat4,
        draft: &mut Draft,
        read: impl FnOnce(DMat4, Option<String>, &mut Draft) -> Result<(), LoadError>,
    ) -> Result<bool, LoadError> {
        let (file, material) = what_is_placed(entry);
        let places = self.places.get(&(file.clone(), material.clone())).copied().unwrap_or(0);
        let (key, mirrored) = ((file, material, mirrors(transform)), mirrors(transform));
        let shape = match self.known.get(&key) {
            Some(Known::Stored(shape)) => shape.clone(),
            Some(&Known::Copied(triangles)) if draft.shares(places, triangles) => {
                let shape = draft.shape(mirrored, |draft| read(DMat4::IDENTITY, None, draft))?;
                self.known.insert(key, Known::Stored(shape.clone()));
                shape
            }
            _ => None,
        };
        let Some(shape) = shape else { return Ok(false) };
        let stem = || Path::new(entry.file.get_ref()).file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let objects = match &entry.name {
            Some(_) => Vec::new(),
            None => draft.objects_of(&shape),
        };
        // Objects keep their names where they are not very many: each is placed by itself.
        let objects = match objects.len() {
            1..=MOST_OBJECTS => objects,
            _ => vec![(shape, entry.name.as_ref().map_or_else(stem, |name| name.get_ref().clone()).into())],
        };
        let held = draft.mover.map(|node| (node, *transform));
        // What cannot be placed so is so already for the first one.
        Ok(objects.into_iter().all(|(triangles, object)| draft.place(triangles, transform, Some(&object), held)))
    }

    /// Notes how many triangles a copy has added.
    fn copied(&mut self, entry: &MeshEntry, transform: &DMat4, triangles: usize) {
        let (file, material) = what_is_placed(entry);
        self.known.entry((file, material, mirrors(transform))).or_insert(Known::Copied(triangles));
    }
}

fn what_is_placed(entry: &MeshEntry) -> (String, Option<String>) {
    (entry.file.get_ref().clone(), entry.material.as_ref().map(|name| name.get_ref().clone()))
}

fn read_mesh(
    source: &Source,
    entry: &MeshEntry,
    names: &HashMap<String, u32>,
    repeats: &mut Repeats,
    draft: &mut Draft,
) -> Result<(), LoadError> {
    draft.refer(source.path, entry.file.get_ref());
    let named = |error: LoadError| error.named_by(source.place(entry.file.span()));
    let material = match &entry.material {
        Some(name) => Some(source.index_of("material", name, names)?),
        None => None,
    };
    let object = entry.name.as_ref().map(|name| name.get_ref().clone());
    let transform = mesh_transform(source, entry)?;
    draft.mover = match &entry.motion {
        Some(motion) => Some(motion::object(source, motion, transform.w_axis.truncate(), draft)?),
        None => None,
    };
    let read = |transform: DMat4, object: Option<String>, draft: &mut Draft| {
        let (path, bytes) = draft.access.read_beside(source.path, entry.file.get_ref())?;
        read_part(&path, bytes, transform, material, object, draft)
    };
    let may_be_shared = draft.mover.is_none_or(|node| draft.may_hold_shapes(node));
    if may_be_shared && repeats.place(entry, &transform, draft, read).map_err(named)? {
        draft.mover = None;
        return Ok(());
    }
    let (_, before) = draft.size();
    read(transform, object, draft).map_err(named)?;
    repeats.copied(entry, &transform, draft.size().1 - before);
    draft.mover = None;
    Ok(())
}

/// Scale, then rotation, then translation.
fn mesh_transform(source: &Source, entry: &MeshEntry) -> Result<DMat4, LoadError> {
    let translate = entry.translate.as_ref().map_or(Ok(DVec3::ZERO), |value| source.vector("translate", value))?;
    let scale = match &entry.scale {
        Some(value) => scale(source, value)?,
        None => DVec3::ONE,
    };
    Ok(DMat4::from_translation(translate) * rotation(source, &entry.rotate)? * DMat4::from_scale(scale))
}

fn scale(source: &Source, value: &Spanned<Scale>) -> Result<DVec3, LoadError> {
    let factors = value.get_ref().factors();
    if factors.to_array().iter().all(|factor| factor.is_finite() && *factor as f32 != 0.0) {
        Ok(factors)
    } else {
        Err(source.refuse("scale", value, "is zero or not finite", "give a factor; a negative one mirrors"))
    }
}

/// Degrees about the fixed X axis first, then Y, then Z.
fn rotation(source: &Source, rotate: &Option<Vector>) -> Result<DMat4, LoadError> {
    let Some(rotate) = rotate else { return Ok(DMat4::IDENTITY) };
    let angles = source.vector("rotate", rotate)?;
    let [x, y, z] = angles.to_array().map(f64::to_radians);
    Ok(DMat4::from_rotation_z(z) * DMat4::from_rotation_y(y) * DMat4::from_rotation_x(x))
}

fn cuboid(source: &Source, table: &Spanned<BoxEntry>) -> Result<(Shape, DMat4), LoadError> {
    let entry = table.get_ref();
    let (center, half) = match (&entry.min, &entry.max, &entry.center, &entry.size) {
        (Some(min), Some(max), None, None) => {
            let (low, high) = (source.vector("min", min)?, source.vector("max", max)?);
            if !low.cmplt(high).all() {
                return Err(source.refuse("max", max, "is not above `min` on every axis", "swap or move the corners"));
            }
            if entry.rotate.is_none() {
                // The corners as written, not as centre and size would round them.
                return Ok((Shape::cuboid(low, high), DMat4::IDENTITY));
            }
            (0.5 * (low + high), 0.5 * (high - low))
        }
        (None, None, Some(center), Some(size)) => {
            (source.vector("center", center)?, 0.5 * DVec3::from(source.lengths("size", size)?))
        }
        _ => return Err(source.missing(table, "min", "give `min` and `max`, or `center` and `size`, and not both")),
    };
    Ok((Shape::cuboid(-half, half), DMat4::from_translation(center) * rotation(source, &entry.rotate)?))
}

fn cylinder(source: &Source, table: &Spanned<CylinderEntry>) -> Result<Shape, LoadError> {
    let entry = table.get_ref();
    let (base, top) = match (&entry.base, &entry.top, &entry.center) {
        (Some(base), Some(top), None) if entry.axis.is_none() && entry.height.is_none() => {
            let ends = (source.vector("base", base)?, source.vector("top", top)?);
            if (ends.1 - ends.0).try_normalize().is_none() {
                return Err(source.refuse("top", top, "is the same as `base`", "move one of them"));
            }
            ends
        }
        (None, None, Some(center)) => {
            let remedy = "a cylinder around a `center` needs `axis` and `height`";
            let axis = source.direction("axis", required(source, table, "axis", &entry.axis, remedy)?)?;
            let height = source.positive("height", required(source, table, "height", &entry.height, remedy)?)?;
            let (center, half) = (source.vector("center", center)?, 0.5 * height * axis);
            (center - half, center + half)
        }
        _ => {
            let remedy = "give `base` and `top`, or `center`, `axis` and `height`, and not both";
            return Err(source.missing(table, "base", remedy));
        }
    };
    let radius = source.positive("radius", &entry.radius)?;
    Ok(Shape::cylinder(base, top, radius, source.segments(&entry.segments)?, entry.caps.unwrap_or(true)))
}

fn triangle(source: &Source, table: &Spanned<TriangleEntry>) -> Result<Shape, LoadError> {
    let entry = table.get_ref();
    let mut uvs = [Vec2::Y, Vec2::ONE, Vec2::ZERO];
    if let Some(value) = &entry.uvs {
        source.all_finite("uvs", value, value.get_ref().as_flattened())?;
        uvs = value.get_ref().map(|uv| DVec2::from(uv).as_vec2());
    }
    match (&entry.a, &entry.b, &entry.c, &entry.vertices) {
        (Some(a), Some(b), Some(c), None) => {
            Ok(Shape::triangle([source.vector("a", a)?, source.vector("b", b)?, source.vector("c", c)?], uvs))
        }
        (None, None, None, Some(vertices)) => {
            let mut corners = [DVec3::ZERO; 3];
            for (corner, vertex) in corners.iter_mut().zip(vertices.get_ref()) {
                *corner = source.vector("vertices", &Spanned::new(vertices.span(), *vertex))?;
            }
            Ok(Shape::triangle(corners, uvs))
        }
        _ => Err(source.missing(table, "a", "give the corners `a`, `b` and `c`, or three `vertices`, and not both")),
    }
}

/// A plane with a size is centred on its point; one without extends far beyond the rest of the scene.
fn plane(source: &Source, table: &Spanned<PlaneEntry>, rest: Option<(DVec3, DVec3)>) -> Result<Shape, LoadError> {
    let entry = table.get_ref();
    let point = source.vector("point", &entry.point)?;
    let normal = source.direction("normal", &entry.normal)?;
    let (u, v) = tangents(normal);
    let (center, [width, height]) = match (&entry.size, rest) {
        (Some(size), _) => (point, source.lengths("size", size)?),
        (None, Some((min, max))) if max != min => {
            let middle = 0.5 * (min + max);
            let edge = PLANE_DIAGONALS * (max - min).length();
            (middle - (middle - point).dot(normal) * normal, [edge; 2])
        }
        (None, _) => {
            let remedy = "there is nothing else in the scene to take its size from: add `size = [a, b]`";
            return Err(source.missing(table, "size", remedy));
        }
    };
    Ok(Shape::rectangle(center, width * u, height * v))
}
