//! The supported extensions.

use std::path::Path;

use super::document::Document;
use crate::LoadError;
use crate::build::draft::Draft;
use crate::build::quote::list;

/// Extensions that are read. A file may require them.
const KNOWN: [&str; 11] = [
    "EXT_lights_image_based",
    "EXT_mesh_gpu_instancing",
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

/// Rejects a file that requires an unsupported extension, and warns about unsupported ones that it uses.
pub(super) fn check(path: &Path, document: &Document, draft: &mut Draft) -> Result<(), LoadError> {
    let is_known = |name: &&String| KNOWN.contains(&name.as_str());
    if let Some(extension) = document.extensions_required.iter().find(|name| !is_known(name)) {
        return Err(LoadError::UnsupportedExtension {
            path: path.to_owned(),
            extension: extension.clone(),
            known: KNOWN.map(str::to_owned).to_vec(),
        });
    }
    let unknown: Vec<&str> =
        document.extensions_used.iter().filter(|name| !is_known(name)).map(String::as_str).collect();
    if !unknown.is_empty() {
        let (path, unknown) = (path.display(), list(unknown.into_iter()));
        draft.warnings.push(format!("{path}: these extensions are ignored: {unknown}"));
    }
    Ok(())
}
