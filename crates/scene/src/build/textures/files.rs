//! Textures of a scene that is being read: each file once, and one sentence about all that are not available.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use crate::OpacityChannel;

/// Number of textures that a warning names with their reasons; the others are counted.
const NAMED: usize = 3;

/// A texture, and what of it is a number.
pub(in crate::build) type Numbers = (u32, OpacityChannel);

/// The texture files of a scene read so far.
#[derive(Debug, Default)]
pub struct TextureFiles {
    /// Index of the texture by its path; `None` if it is not available.
    pub(in crate::build) read: HashMap<PathBuf, Option<u32>>,
    /// Images of normals made of those of heights, by the number of these and whether they end at their edges.
    pub(in crate::build) normals: HashMap<(u32, bool), u32>,
    /// Images of roughness and of how metallic surfaces are, packed into one.
    pub(in crate::build) packed: HashMap<[Option<Numbers>; 2], u32>,
    /// A clause about each one that is not available.
    pub(in crate::build) missing: Vec<String>,
}

impl TextureFiles {
    /// One sentence about all that are not available to `scene`.
    pub fn warning(&self, scene: &Path) -> Option<String> {
        let count = self.missing.len();
        let mut clauses = self.missing[..count.min(NAMED)].join("; ");
        if count > NAMED {
            clauses += &format!("; and {} more", count - NAMED);
        }
        let textures = if count == 1 { "1 texture" } else { &format!("{count} textures") };
        let scene = scene.display();
        (count > 0).then(|| {
            format!("{scene}: {textures} cannot be used, so the materials keep their plain colours: {clauses}")
        })
    }
}
