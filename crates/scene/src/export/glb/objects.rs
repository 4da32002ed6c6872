//! Objects and instances as nodes.
//!
//! Each object of the scene is a node of its name, with a mesh of its own. The places of a shape are nodes that share a mesh, or one node with all of
//! them (`EXT_mesh_gpu_instancing`) if there are very many. Nodes keep to what glTF allows: a place that shears is a mesh of its own.

use std::collections::HashMap;

use glam::{DAffine3, DMat3, DVec3};
use serde_json::{Value, json};

use super::arrays::{Arrays, Triangles};
use crate::{Empty, Instance, Scene};

/// From this number of places on, a shape is placed by arrays in place of nodes.
const VERY_MANY: usize = 1000;

/// Cosine between the axes of a place above which it shears: rounding stays below.
const SHEAR: f64 = 1e-5;

/// The nodes of what rays can hit.
#[derive(Default)]
pub(super) struct Objects {
    pub(super) arrays: Arrays,
    nodes: Vec<Node>,
}

/// A node with a mesh.
struct Node {
    name: String,
    mesh: usize,
    place: DAffine3,
    /// The list of instances.
    list: Option<usize>,
}

impl Objects {
    pub(super) fn new(scene: &Scene) -> Objects {
        let mut objects = Objects::default();
        objects.add_own(scene);
        objects.add_instances(scene);
        objects
    }

    /// Those that are where they are stored, in the order in which they begin.
    fn add_own(&mut self, scene: &Scene) {
        let mesh = &scene.geometry.mesh;
        let mut order: HashMap<u32, usize> = HashMap::new();
        let mut own: Vec<(u32, Vec<u32>)> = Vec::new();
        for (triangles, object) in mesh.objects.ranges(mesh.own_triangles().end as u32) {
            let place = *order.entry(object).or_insert_with(|| {
                own.push((object, Vec::new()));
                own.len() - 1
            });
            own[place].1.extend(triangles);
        }
        let place = DAffine3::from_translation(scene.geometry.origin);
        for (object, numbers) in own {
            let name = mesh.objects.name(object);
            let triangles = Triangles { numbers: &numbers, reversed: false, placed: None };
            let mesh = self.arrays.add_mesh(&scene.geometry, name, triangles);
            self.nodes.push(Node { name: name.to_owned(), mesh, place, list: None });
        }
    }

    /// Shapes at their places.
    fn add_instances(&mut self, scene: &Scene) {
        let mesh = &scene.geometry.mesh;
        let mut counts: HashMap<_, usize> = HashMap::new();
        for instance in mesh.instances.list() {
            *counts.entry(key(instance)).or_default() += 1;
        }
        let (mut shapes, mut lists, mut written) = (HashMap::new(), HashMap::new(), Vec::new());
        for instance in mesh.instances.list() {
            let name = mesh.objects.name(instance.object);
            let place = world_place(scene, instance);
            let numbers = || (instance.triangles.start..instance.triangles.end).collect::<Vec<u32>>();
            if shears(&place) {
                let triangles = Triangles { numbers: &numbers(), reversed: false, placed: Some(instance) };
                let mesh = self.arrays.add_mesh(&scene.geometry, name, triangles);
                let place = DAffine3::from_translation(scene.geometry.origin);
                self.nodes.push(Node { name: name.to_owned(), mesh, place, list: None });
                continue;
            }
            let reversed = place.matrix3.determinant() < 0.0;
            let shape = *shapes.entry((instance.triangles.clone(), reversed)).or_insert_with(|| {
                // A place that mirrors reverses corners, in glTF as well as here, where they are stored so.
                let triangles = Triangles { numbers: &numbers(), reversed, placed: None };
                let added = self.arrays.add_mesh(&scene.geometry, name, triangles);
                let shape = self.arrays.merged(added, &written);
                written.extend((shape == added).then_some(added));
                shape
            });
            if counts[&key(instance)] < VERY_MANY {
                self.nodes.push(Node { name: name.to_owned(), mesh: shape, place, list: None });
                continue;
            }
            let (_, places): &mut (_, Vec<DAffine3>) =
                lists.entry((shape, instance.object)).or_insert_with(|| (name, Vec::new()));
            places.push(place);
        }
        let mut lists: Vec<_> = lists.into_iter().collect();
        lists.sort_unstable_by_key(|(key, _)| *key);
        for ((mesh, _), (name, places)) in lists {
            // Single precision is kept near the local frame's origin.
            let origin = scene.geometry.origin;
            let local = |place: DAffine3| DAffine3 { translation: place.translation - origin, ..place };
            let list = Some(self.arrays.add_instances(places.into_iter().map(local)));
            let place = DAffine3::from_translation(origin);
            self.nodes.push(Node { name: name.to_owned(), mesh, place, list });
        }
    }

    /// Whether there is nothing to be seen.
    pub(super) fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Whether instances are in arrays.
    pub(super) fn has_lists(&self) -> bool {
        self.nodes.iter().any(|node| node.list.is_some())
    }

    /// The nodes, with the attributes of each list of instances.
    pub(super) fn nodes(&self, lists: &[Value]) -> Vec<Value> {
        let nodes = self.nodes.iter().map(|Node { name, mesh, place, list }| {
            let mut node = json!({"name": name, "mesh": mesh});
            if place.matrix3 != DMat3::IDENTITY {
                let columns = glam::DMat4::from(*place).to_cols_array();
                node["matrix"] = json!(columns);
            } else if place.translation != DVec3::ZERO {
                node["translation"] = json!(place.translation.to_array());
            }
            if let Some(list) = list {
                node["extensions"] = json!({"EXT_mesh_gpu_instancing": {"attributes": lists[*list]}});
            }
            node
        });
        nodes.collect()
    }
}

/// A node without a mesh. Where its place is none that glTF has, it is in the middle of that.
pub(super) fn empty_node(empty: &Empty) -> Value {
    let place = DAffine3::from_mat4(empty.transform);
    let mut node = json!({"name": empty.name});
    let size = place.matrix3.determinant();
    if place.matrix3 != DMat3::IDENTITY && size.is_finite() && size != 0.0 && !shears(&place) {
        node["matrix"] = json!(empty.transform.to_cols_array());
    } else if place.translation != DVec3::ZERO && place.translation.is_finite() {
        node["translation"] = json!(place.translation.to_array());
    }
    node
}

/// What the places of one list have in common: the shape, and their object.
fn key(instance: &Instance) -> (u32, u32, u32) {
    (instance.triangles.start, instance.triangles.end, instance.object)
}

/// From a shape's coordinates to the world's.
fn world_place(scene: &Scene, instance: &Instance) -> DAffine3 {
    let rows = instance.place.rows;
    let row = |axis: usize| DVec3::new(rows[axis][0].into(), rows[axis][1].into(), rows[axis][2].into());
    let translation = DVec3::from(rows.map(|row| f64::from(row[3]))) + scene.geometry.origin;
    DAffine3 { matrix3: DMat3::from_cols(row(0), row(1), row(2)).transpose(), translation }
}

/// Whether a place is more than a turn, a shift, and factors along the axes of the shape.
fn shears(place: &DAffine3) -> bool {
    let [x, y, z] = [place.matrix3.x_axis, place.matrix3.y_axis, place.matrix3.z_axis].map(DVec3::normalize);
    [x.dot(y), y.dot(z), z.dot(x)].iter().any(|cosine| cosine.abs() > SHEAR)
}
