//! The surfaces of a staged scene, which stay from order to order.

use std::sync::Arc;

use lightmesh_render::{Acceleration, PreparedScene, Settings, are_same};
use lightmesh_scene::{Geometry, Scene};

/// The surfaces of a scene that is staged, with the structure over them.
pub(crate) struct Staged {
    geometry: Arc<Geometry>,
    /// While it is alive, the renderer has the structure.
    _prepared: PreparedScene,
}

impl Staged {
    /// What is worth keeping of a scene that is prepared with these settings. A grid that was read from a file is not: the file may change.
    pub(crate) fn of(scene: &Scene, prepared: &PreparedScene, settings: &Settings) -> Option<Staged> {
        let from_file = matches!(settings.acceleration, Acceleration::GridFile(_));
        (!from_file).then(|| Staged { geometry: Arc::clone(&scene.geometry), _prepared: prepared.clone() })
    }

    /// If a scene has the same surfaces, it shares them from now on: staging may have added the same ground again. Returns whether it does.
    pub(crate) fn is_shared_with(&self, scene: &mut Scene) -> bool {
        let is_same = Arc::ptr_eq(&self.geometry, &scene.geometry) || are_same(&self.geometry, &scene.geometry);
        if is_same {
            scene.geometry = Arc::clone(&self.geometry);
        }
        is_same
    }
}
