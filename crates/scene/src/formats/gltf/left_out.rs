//! Content of a file that is not shown: counted while reading, and reported in one sentence per kind.

use std::path::Path;

use super::nodes::Placed;
use crate::build::draft::Draft;

/// How often each kind occurred.
#[derive(Default)]
pub(super) struct LeftOut {
    /// Cameras and lights of a file that is part of another scene.
    pub(super) cameras: usize,
    pub(super) lights: usize,
    pub(super) unknown_lights: usize,
    pub(super) points_and_lines: usize,
    /// Primitives without positions.
    pub(super) placeless: usize,
    /// Channels of animations that move nothing glTF itself defines.
    pub(super) unknown_channels: usize,
    /// Primitives whose material does not exist.
    pub(super) missing_materials: usize,
    /// Materials with an `alphaMode` that glTF does not define.
    pub(super) unknown_alpha_modes: usize,
    pub(super) occlusion_textures: usize,
    /// Those with other texture coordinates than the images before.
    pub(super) emissive_textures: usize,
    pub(super) normal_textures: usize,
    pub(super) roughness_textures: usize,
    /// Those of materials that transmit light.
    pub(super) glass_textures: usize,
    pub(super) specular_textures: usize,
    pub(super) transmission_textures: usize,
    /// Materials whose roughness should blur what goes through them.
    pub(super) frosted: usize,
    pub(super) missing_textures: usize,
    /// Buffer views with a stride of 0, which older versions of the format had.
    pub(super) strides_of_zero: usize,
}

impl LeftOut {
    /// Counts the cameras and lights of all nodes.
    pub(super) fn count_views(&mut self, all: &[Placed]) {
        self.cameras += all.iter().filter(|placed| placed.node.camera.is_some()).count();
        self.lights += all.iter().filter(|placed| placed.light().is_some()).count();
    }

    /// Adds the sentences to the draft's warnings.
    pub(super) fn warn(&self, path: &Path, draft: &mut Draft) {
        let sentences = [
            (self.cameras, "camera", "of a file that is part of the scene: ignored"),
            (self.lights, "light", "of a file that is part of the scene: ignored"),
            (self.unknown_lights, "light", "of an unknown type: ignored"),
            (self.points_and_lines, "primitive", "of points or lines: ignored"),
            (self.placeless, "primitive", "without positions: ignored"),
            (self.unknown_channels, "animation channel", "of an unknown kind: ignored"),
            (self.missing_materials, "primitive", "with a material that the file does not contain: shown white"),
            (self.unknown_alpha_modes, "material", "with an unknown alphaMode: shown opaque"),
            (self.occlusion_textures, "occlusion texture", "not shown"),
            (
                self.emissive_textures,
                "emissive texture",
                "that cannot be placed beside the base colour's: the surface emits no light",
            ),
            (self.normal_textures, "normal texture", "that cannot be placed beside the other images: not shown"),
            (
                self.roughness_textures,
                "metallic-roughness texture",
                "that cannot be placed beside the other images: the material's factors are used",
            ),
            (
                self.glass_textures,
                "metallic-roughness texture",
                "of a material that transmits light: the material's factors are used",
            ),
            (self.specular_textures, "specular texture", "not shown: the material's factors are used"),
            (self.transmission_textures, "transmission texture", "not shown: the material's factors are used"),
            (self.frosted, "material", "with rough transmission: what is behind is shown sharp"),
            (self.missing_textures, "material", "with a texture that the file does not contain: shown in plain colour"),
            (self.strides_of_zero, "buffer view", "with a byteStride of 0: read without gaps"),
        ];
        let path = path.display();
        for (count, what, outcome) in sentences.into_iter().filter(|(count, ..)| *count > 0) {
            let plural = match (count, what.ends_with('h')) {
                (1, _) => "",
                (_, true) => "es",
                (_, false) => "s",
            };
            draft.warnings.push(format!("{path}: {count} {what}{plural} {outcome}"));
        }
    }
}
