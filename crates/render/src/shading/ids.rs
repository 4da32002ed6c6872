//! Numbers of the objects and materials that rays see, from 1; 0 is nothing. Twin: `ids.cuh`.

use lightmesh_scene::Instance;
use lightmesh_trace::accel::Hit;

use crate::prepared::PreparedScene;

/// The number of what a ray sees: its object, and its material.
pub(crate) fn ids_of(scene: &PreparedScene, hit: &Hit) -> [u32; 2] {
    if !hit.is_some() {
        return [0; 2];
    }
    let mesh = &scene.scene.geometry.mesh;
    let material = mesh.materials[mesh.stored(hit.triangle)] as usize;
    [mesh.object_of(hit.triangle) + 1, scene.geometry.materials.numbers[material]]
}

/// The numbers of objects and of materials with anything that only shows shadows, in order.
pub(crate) fn catchers(scene: &PreparedScene) -> [Vec<u32>; 2] {
    let geometry = &scene.scene.geometry;
    let mesh = &geometry.mesh;
    let is_catcher = |stored: usize| geometry.materials[mesh.materials[stored] as usize].catcher;
    let own = mesh.own_triangles().filter(|&stored| is_catcher(stored)).map(|stored| stored as u32);
    // All triangles of an instance belong to one object.
    let catches = |instance: &&Instance| instance.triangles.clone().any(|stored| is_catcher(stored as usize));
    let materials = |instance: &Instance| {
        let catching = instance.triangles.clone().filter(|&stored| is_catcher(stored as usize));
        let (first, start) = (instance.first, instance.triangles.start);
        catching.map(move |stored| first + (stored - start)).collect::<Vec<_>>()
    };
    let triangles = own.chain(mesh.instances.list().iter().filter(catches).flat_map(materials));
    let of = |triangle: u32| ids_of(scene, &Hit { triangle, ..Hit::MISS });
    let mut ids: [Vec<u32>; 2] = Default::default();
    for found in triangles.map(of) {
        for (ids, found) in ids.iter_mut().zip(found).filter(|(ids, found)| ids.last() != Some(found)) {
            ids.push(found);
        }
    }
    ids.map(|mut ids| {
        ids.sort_unstable();
        ids.dedup();
        ids
    })
}
