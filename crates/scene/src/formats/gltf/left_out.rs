//! Content of a file that is not shown: counted while reading, and reported in one sentence per kind.

use std::path::Path;

use super::nodes::Placed;
use crate::build::draft::Draft;
use crate::build::quote::quote;

/// Nodes with content that cannot be as it is stored: the first of them, and how many there are.
#[derive(Default)]
pub(super) struct Odd {
    first: String,
    count: usize,
}

impl Odd {
    /// One more, with the number and the name of a node.
    pub(super) fn add(&mut self, number: usize, name: Option<&str>) {
        if self.count == 0 {
            let name = name.filter(|name| !name.is_empty()).map(|name| format!(" (`{}`)", quote(name)));
            self.first = format!("node {number}{}", name.unwrap_or_default());
        }
        self.count += 1;
    }

    fn told(&self, outcome: &str) -> Option<String> {
        let Odd { first, count } = self;
        match count {
            0 => None,
            1 => Some(format!("{first}: {outcome}")),
            2 => Some(format!("{first} and another: {outcome}")),
            count => Some(format!("{first} and {} others: {outcome}", count - 1)),
        }
    }
}

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
    /// Channels of animations that move nodes that the file does not contain.
    pub(super) lost_channels: Odd,
    /// Channels of animations with keys that are no numbers.
    pub(super) undefined_keys: Odd,
    /// Skinned primitives with vertices that no joint holds.
    pub(super) unheld: Odd,
    /// Primitives with colours as integers that are not normalised.
    pub(super) integer_colors: Odd,
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
        let odd = [
            (&self.lost_channels, "an animation moves it, but the file does not contain it: ignored"),
            (
                &self.undefined_keys,
                "an animation has keys with infinite or undefined values: what they move stays at rest",
            ),
            (&self.unheld, "vertices have weights of joints that are all 0 or undefined: they go with the first joint"),
            (&self.integer_colors, "vertex colours are integers that are not normalized: taken as if they were"),
        ];
        draft.warnings.extend(odd.iter().filter_map(|(odd, outcome)| Some(format!("{path}: {}", odd.told(outcome)?))));
    }
}
