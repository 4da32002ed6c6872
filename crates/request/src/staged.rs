//! The surfaces of a staged scene, which stay from order to order.

use std::collections::BTreeMap;
use std::sync::Arc;

use lightmesh_render::PreparedScene;
use lightmesh_scene::Geometry;

use crate::manifest;
use crate::request::Request;

/// The surfaces of a scene that is staged by these settings, with the structure over them.
pub(crate) struct Staged {
    settings: BTreeMap<String, String>,
    pub(crate) geometry: Arc<Geometry>,
    /// While it is alive, the renderer has the structure.
    _prepared: PreparedScene,
}

impl Staged {
    /// What was made of a scene by the settings of a request.
    pub(crate) fn new(request: &Request, geometry: &Arc<Geometry>, prepared: &PreparedScene) -> Staged {
        Staged { settings: deciding(request), geometry: Arc::clone(geometry), _prepared: prepared.clone() }
    }

    /// Whether a request makes the same surfaces of the scene: with the same settings, staging adds the same ground.
    pub(crate) fn is_for(&self, request: &Request) -> bool {
        self.settings == deciding(request)
    }
}

/// The settings on which surfaces may depend.
fn deciding(request: &Request) -> BTreeMap<String, String> {
    let mut settings = manifest::settings_of(request);
    // A saved grid knows nothing of a ground.
    settings.insert("grid_file".to_owned(), format!("{:?}", request.grid_file));
    settings
}
