//! Numbers of the objects and materials that rays see, from 1; 0 is nothing. Twin: `ids.cuh`.

use crate::accel::Hit;
use crate::prepared::PreparedScene;

/// The number of what a ray sees: its object, and its material.
pub(crate) fn ids_of(scene: &PreparedScene, hit: &Hit) -> [u32; 2] {
    if !hit.is_some() {
        return [0; 2];
    }
    let mesh = &scene.scene.geometry.mesh;
    let material = mesh.materials[hit.triangle as usize] as usize;
    [mesh.objects.of(hit.triangle) + 1, scene.geometry.materials.numbers[material]]
}

/// The numbers of objects and of materials with anything that only shows shadows, in order.
pub(crate) fn catchers(scene: &PreparedScene) -> [Vec<u32>; 2] {
    let geometry = &scene.scene.geometry;
    let mesh = &geometry.mesh;
    let is_catcher = |triangle: &u32| geometry.materials[mesh.materials[*triangle as usize] as usize].catcher;
    let triangles = (0..mesh.triangles.len() as u32).filter(is_catcher);
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
