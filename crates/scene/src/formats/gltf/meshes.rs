//! Meshes: primitives of all triangle modes, placed once for every node that uses them, or once per instance.
//!
//! First a survey counts what is going to be added, and checks that its bytes exist; so a few small meshes in very many nodes are
//! rejected before they fill the memory.

use std::{
    borrow::Cow,
    collections::{HashMap, HashSet},
    ops::Range,
    sync::Arc,
};

use glam::{DMat4, Vec3};

use super::{
    accessor::{Accessors, Used},
    bends::Bends,
    container::malformed,
    document::{Instancing, Mesh, Primitive},
    instances::Instances,
    left_out::LeftOut,
    materials::{Chosen, Materials},
    rigged::Rigged,
};
use crate::build::draft::Draft;
use crate::build::mesh_part::Room;
use crate::model::animation::parts::{Hold, Shape};
use crate::model::instances::MAX_INSTANCED;
use crate::model::transforms::mirrors;
use crate::{Affine, Empty, LoadError, MeshPart, OwnedPositions};

/// How a primitive's vertices form triangles, by its number in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// They form none.
    PointsOrLines,
    /// Three each.
    Triangles,
    /// Each with the two before it.
    Strip,
    /// Each with the one before it and the first.
    Fan,
}

impl Mode {
    fn new(number: u32) -> Option<Mode> {
        Some(match number {
            0..=3 => Mode::PointsOrLines,
            4 => Mode::Triangles,
            5 => Mode::Strip,
            6 => Mode::Fan,
            _ => return None,
        })
    }

    /// Number of triangles formed by this many indices. Remaining indices are ignored.
    pub fn count(self, indices: usize) -> usize {
        match self {
            Mode::PointsOrLines => 0,
            Mode::Triangles => indices / 3,
            Mode::Strip | Mode::Fan => indices.saturating_sub(2),
        }
    }
}

/// What a mesh adds each time that it is shown.
#[derive(Default)]
struct Survey<'a> {
    primitives: Vec<(&'a Primitive, Mode)>,
    room: Room,
    points_and_lines: usize,
    placeless: usize,
}

/// A mesh at one position, or at many.
pub(super) struct Shown<'a> {
    pub(super) mesh: u32,
    /// Number and name of the node.
    pub(super) node: (usize, Option<&'a str>),
    pub(super) transform: DMat4,
    /// The number of instances and their transforms.
    pub(super) instances: Option<(usize, &'a Instancing)>,
    pub(super) bends: Bends,
    /// Whether it goes with its node.
    pub(super) moves: bool,
}

impl Shown<'_> {
    fn count(&self) -> usize {
        self.instances.map_or(1, |(count, _)| count)
    }
}

/// The meshes of a document.
pub(super) struct Meshes<'a> {
    accessors: Accessors<'a>,
    meshes: &'a [Mesh],
    surveys: Vec<Option<Survey<'a>>>,
}

impl<'a> Meshes<'a> {
    pub(super) fn new(accessors: Accessors<'a>) -> Meshes<'a> {
        let meshes = &accessors.document.meshes[..];
        Meshes { accessors, meshes, surveys: meshes.iter().map(|_| None).collect() }
    }

    /// Adds all that is shown, as the object `object` or else those of the nodes' names, or their meshes'.
    pub(super) fn add(
        &mut self,
        all: &[Shown],
        rigged: &Rigged,
        materials: &mut Materials,
        left_out: &mut LeftOut,
        object: Option<&str>,
        draft: &mut Draft,
    ) -> Result<(), LoadError> {
        let shared = self.shared(all, rigged, draft)?;
        let mut room = Room::default();
        for shown in all {
            let survey = self.survey(shown.mesh)?;
            let is_shared = shared.contains(&shown.mesh) && may_be_shared(shown, survey, rigged);
            room = room.and(&survey.room, if is_shared { 0 } else { shown.count() });
            left_out.points_and_lines = left_out.points_and_lines.saturating_add(survey.points_and_lines);
            left_out.placeless = left_out.placeless.saturating_add(survey.placeless);
        }
        draft.reserve(&room)?;
        let mut shapes = Shapes::new();
        for shown in all {
            let survey = self.surveys[shown.mesh as usize].as_ref().expect("surveyed above");
            // Read only here: the attributes of all nodes together might not fit into memory.
            let instances = match shown.instances {
                Some((count, instancing)) if !survey.primitives.is_empty() => {
                    Some(Instances::read(&self.accessors, instancing, count)?)
                }
                _ => None,
            };
            let (number, name) = shown.node;
            let named = name.or(self.meshes[shown.mesh as usize].name.as_deref());
            // A name that is given from outside makes one object of all nodes; their own names may be those of others, too.
            let object = match (object, named) {
                (Some(object), _) => draft.begin_object(object),
                (None, Some(name)) => draft.begin_own_object(name),
                (None, None) => draft.begin_own_object(&format!("node {number}")),
            };
            if let (true, Some(name)) = (survey.primitives.is_empty(), name) {
                draft.empties.push(Empty { name: name.to_owned(), transform: shown.transform });
            }
            let mut add = |shown: &Shown, instances: Option<&Instances>, draft: &mut Draft| -> Result<(), LoadError> {
                for &(primitive, mode) in &survey.primitives {
                    let chosen = materials.choose(primitive, left_out, draft);
                    self.add_primitive(primitive, mode, &chosen, shown, instances, rigged, left_out, draft)?;
                }
                Ok(())
            };
            if !(shared.contains(&shown.mesh) && may_be_shared(shown, survey, rigged)) {
                add(shown, instances.as_ref(), draft)?;
                continue;
            }
            let places: Vec<DMat4> = match &instances {
                Some(instances) => instances.transforms().collect(),
                None => vec![DMat4::IDENTITY],
            };
            let mover = rigged.mover(shown.node.0);
            if mover.is_some() && !places.iter().all(|place| Affine::holds(&(shown.transform * *place))) {
                add(shown, instances.as_ref(), draft)?;
                continue;
            }
            let one = |transform: DMat4| Shown { transform, instances: None, bends: Bends::default(), ..*shown };
            for place in places {
                let (transform, held) = (shown.transform * place, mover.map(|node| (node, place)));
                let mirrored = mirrors(&transform);
                let shape = match shapes.get(&(shown.mesh, mirrored)) {
                    Some(known) => known.clone(),
                    None => {
                        // It moves with its places.
                        let still = Shown { moves: false, ..one(DMat4::IDENTITY) };
                        let shape = draft.shape(mirrored, |draft| add(&still, None, draft))?;
                        shapes.entry((shown.mesh, mirrored)).or_insert(shape).clone()
                    }
                };
                if !shape.is_some_and(|shape| draft.place(shape, &transform, Some(&object), held)) {
                    add(&one(transform), None, draft)?;
                }
            }
        }
        Ok(())
    }

    /// The meshes that are stored once for all their places.
    fn shared(&mut self, all: &[Shown], rigged: &Rigged, draft: &Draft) -> Result<HashSet<u32>, LoadError> {
        let mut places: HashMap<u32, usize> = HashMap::new();
        for shown in all {
            if may_be_shared(shown, self.survey(shown.mesh)?, rigged) {
                let count = places.entry(shown.mesh).or_default();
                *count = count.saturating_add(shown.count());
            }
        }
        let triangles = |mesh: u32| self.surveys[mesh as usize].as_ref().map_or(0, |survey| survey.room.triangles);
        places.retain(|&mesh, &mut places| draft.shares(places, triangles(mesh)));
        // If there are too many to be numbered, there is no room for copies either.
        let all = places.iter().map(|(&mesh, &places)| places.saturating_mul(triangles(mesh)));
        let can_be_numbered = all.fold(0, usize::saturating_add) < MAX_INSTANCED;
        Ok(if can_be_numbered { places.into_keys().collect() } else { HashSet::new() })
    }

    fn survey(&mut self, index: u32) -> Result<&Survey<'a>, LoadError> {
        let mesh = self
            .meshes
            .get(index as usize)
            .ok_or_else(|| malformed(self.accessors.path, format!("there is no mesh {index}, but it is referenced")))?;
        let slot = &mut self.surveys[index as usize];
        if slot.is_none() {
            *slot = Some(Survey::new(&self.accessors, index, mesh)?);
        }
        Ok(slot.as_ref().expect("just filled"))
    }

    #[allow(clippy::too_many_arguments, reason = "what a primitive is, where it is shown, and where it goes")]
    fn add_primitive(
        &self,
        primitive: &Primitive,
        mode: Mode,
        chosen: &Chosen,
        shown: &Shown,
        instances: Option<&Instances>,
        rigged: &Rigged,
        left_out: &mut LeftOut,
        draft: &mut Draft,
    ) -> Result<(), LoadError> {
        let accessors = &self.accessors;
        let Some(place) = primitive.attributes.position else { return Ok(()) };
        let vertices = accessors.count(place)?;
        self.check_lengths(vertices, primitive.attributes.normal, chosen)?;
        let mut indices = self.indices(primitive, vertices)?;
        let used = vertices_used(&mut indices, vertices);
        let used = used.as_deref();
        let none = || Ok(Cow::default());
        let positions = accessors.vectors::<3>(place, used)?;
        let normals = primitive.attributes.normal.map_or_else(none, |index| accessors.vectors::<3>(index, used))?;
        let uvs = chosen.uvs.map_or_else(|| Ok(Cow::default()), |index| accessors.vectors::<2>(index, used))?;
        let colors = chosen.colors.map_or_else(none, |index| accessors.colors(index, used))?;
        if chosen.colors.map_or(Ok(false), |index| accessors.is_raw(index))? {
            left_out.integer_colors.add(shown.node.0, shown.node.1);
        }
        let opacities = match chosen.opacities {
            Some(index) => accessors.opacities(index, used)?,
            None => Vec::new(),
        };
        let part = MeshPart {
            positions: bytemuck::cast_slice::<_, Vec3>(&positions),
            normals: bytemuck::cast_slice(&normals),
            uvs: bytemuck::cast_slice(&uvs),
            colors: bytemuck::cast_slice(&colors),
            opacities: &opacities,
            triangles: &triangles(mode, &indices),
        };
        if shown.bends.bend(primitive) {
            draft.check_bends(used.map_or(vertices, <[u32]>::len), primitive.targets.len())?;
            let bent = self.bent(primitive, shown, vertices, used, &part, rigged)?;
            if let Hold::Skin(_, influences) = &bent.1
                && influences.leave_any()
            {
                left_out.unheld.add(shown.node.0, shown.node.1);
            }
            return add_bent(part, bent, &shown.bends, chosen.material, rigged, draft);
        }
        let mover = if shown.moves { rigged.mover(shown.node.0) } else { None };
        // All instances move the same vertices.
        let shape = mover.map(|node| (node, Arc::new(shape_of(&part))));
        let add = |draft: &mut Draft, instance: &DMat4| -> Result<(), LoadError> {
            let (before, transform) = (draft.size(), shown.transform * *instance);
            draft.add(part, &transform, |_| chosen.material)?;
            if let Some((node, shape)) = &shape {
                draft.hold(Arc::clone(shape), Hold::Node(*node, *instance), mirrors(&transform), before);
            }
            Ok(())
        };
        match instances {
            None => add(draft, &DMat4::IDENTITY),
            Some(instances) => instances.transforms().try_for_each(|instance| add(draft, &instance)),
        }
    }

    /// The shape of a primitive that is bent, and what bends it.
    fn bent(
        &self,
        primitive: &Primitive,
        shown: &Shown,
        vertices: usize,
        used: Used,
        part: &MeshPart<Vec3>,
        rigged: &Rigged,
    ) -> Result<(Shape, Hold), LoadError> {
        let morph = shown.bends.morph(&self.accessors, primitive, vertices, used)?;
        let hold = match shown.bends.influences(&self.accessors, primitive, vertices, used)? {
            Some((skin, influences)) => Hold::Skin(skin, influences.into()),
            // What bends has a rig.
            None => Hold::Node(rigged.number(shown.node.0).unwrap_or(0), DMat4::IDENTITY),
        };
        Ok((Shape { morph, ..shape_of(part) }, hold))
    }

    /// Attributes that are there have a value for each vertex.
    fn check_lengths(&self, vertices: usize, normals: Option<u32>, chosen: &Chosen) -> Result<(), LoadError> {
        for (name, index) in [("normals", normals), ("texture coordinates", chosen.uvs), ("colours", chosen.colors)] {
            let length = index.map_or(Ok(0), |index| self.accessors.count(index))?;
            if length != 0 && length != vertices {
                let problem = format!("a primitive has {length} {name} for {vertices} vertices");
                return Err(malformed(self.accessors.path, problem));
            }
        }
        Ok(())
    }

    fn indices(&self, primitive: &Primitive, vertices: usize) -> Result<Cow<'a, [u32]>, LoadError> {
        let Some(accessor) = primitive.indices else { return Ok((0..vertices as u32).collect()) };
        let indices = self.accessors.indices(accessor)?;
        let largest = indices.iter().max().map_or(0, |&largest| largest as usize);
        if largest < vertices || indices.is_empty() {
            return Ok(indices);
        }
        let problem = format!("a primitive refers to vertex {largest} of {vertices} (accessor {accessor})");
        Err(malformed(self.accessors.path, problem))
    }
}

/// The triangles of meshes that are stored once, also in reverse order, for places that mirror; nothing of those that cannot be shared.
type Shapes = HashMap<(u32, bool), Option<Range<usize>>>;

/// Whether a mesh may be stored once for all its places: it is not bent, nor enlarged or lessened over time.
fn may_be_shared(shown: &Shown, survey: &Survey, rigged: &Rigged) -> bool {
    let bends = || survey.primitives.iter().any(|(primitive, _)| shown.bends.bend(primitive));
    rigged.may_hold_shapes(shown.node.0) && !bends()
}

/// The vertices of a primitive, copied.
fn shape_of(part: &MeshPart<Vec3>) -> Shape {
    Shape { positions: OwnedPositions::Single(part.positions.to_vec()), normals: part.normals.to_vec(), morph: None }
}

/// Adds a primitive that is bent, as it is at rest.
fn add_bent(
    part: MeshPart<Vec3>,
    (shape, hold): (Shape, Hold),
    bends: &Bends,
    material: u32,
    rigged: &Rigged,
    draft: &mut Draft,
) -> Result<(), LoadError> {
    let (positions, normals) = shape.posed(&hold, &rigged.places, None);
    let (reversed, moves) = match &hold {
        Hold::Node(node, _) => (mirrors(&rigged.places[*node as usize]), rigged.moves(*node)),
        Hold::Skin(skin, _) => (false, skin.joints.iter().any(|&joint| rigged.moves(joint))),
    };
    let mut triangles = Cow::Borrowed(part.triangles);
    if reversed {
        triangles.to_mut().iter_mut().for_each(|triangle| triangle.swap(1, 2));
    }
    let MeshPart { uvs, colors, opacities, .. } = part;
    let posed =
        MeshPart { positions: &positions[..], normals: &normals, uvs, colors, opacities, triangles: &triangles };
    let before = draft.size();
    draft.add(posed, &DMat4::IDENTITY, |_| material)?;
    if moves || bends.morph_moves() {
        draft.hold(shape.into(), hold, reversed, before);
    }
    Ok(())
}

impl<'a> Survey<'a> {
    fn new(accessors: &Accessors, index: u32, mesh: &'a Mesh) -> Result<Survey<'a>, LoadError> {
        let mut survey = Survey::default();
        for primitive in &mesh.primitives {
            let mode = Mode::new(primitive.mode).ok_or_else(|| {
                malformed(accessors.path, format!("a primitive of mesh {index} has the mode {}", primitive.mode))
            })?;
            if mode == Mode::PointsOrLines {
                survey.points_and_lines += 1;
                continue;
            }
            let Some(positions) = primitive.attributes.position else {
                survey.placeless += 1;
                continue;
            };
            let vertices = accessors.count(positions)?;
            let indices = primitive.indices.map_or(Ok(vertices), |indices| accessors.count(indices))?;
            let triangles = mode.count(indices);
            if triangles > 0 {
                let attributes = &primitive.attributes;
                let room = Room {
                    vertices: vertices.min(indices),
                    triangles,
                    normals: attributes.normal.is_some(),
                    uvs: attributes.texcoord_0.or(attributes.texcoord_1).is_some(),
                    colors: attributes.color_0.is_some(),
                    opacities: false,
                };
                survey.room = survey.room.and(&room, 1);
                survey.primitives.push((primitive, mode));
            }
        }
        Ok(survey)
    }
}

/// The vertices that `indices` refer to, ascending, if there are more than that; `indices` then refer to places in this list.
/// Primitives that are small parts of the same vertices would else copy all of these, each of them.
pub fn vertices_used(indices: &mut Cow<[u32]>, vertices: usize) -> Option<Vec<u32>> {
    if indices.len() >= vertices {
        return None;
    }
    let mut used = indices.to_vec();
    used.sort_unstable();
    used.dedup();
    for index in indices.to_mut() {
        *index = used.binary_search(index).expect("each index is in the list") as u32;
    }
    Some(used)
}

/// Splits strips and fans into triangles with the same orientation (glTF 2.0, section 3.7.2.1).
pub fn triangles(mode: Mode, indices: &[u32]) -> Cow<'_, [[u32; 3]]> {
    match mode {
        Mode::Triangles => indices.as_chunks().0.into(),
        Mode::Strip => indices
            .windows(3)
            .enumerate()
            .map(|(i, w)| if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[0], w[2], w[1]] })
            .collect(),
        Mode::Fan => indices.get(1..).unwrap_or_default().windows(2).map(|w| [w[0], w[1], indices[0]]).collect(),
        Mode::PointsOrLines => Cow::default(),
    }
}
