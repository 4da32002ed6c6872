//! What every look at a texture needs: whether there is one, and which texels are next to a place in it.

mod neighbours;

use lightmesh_scene::{Geometry, Texture, TextureUse};

pub use neighbours::neighbours;

/// A texture that is used like this, if it can be looked up.
#[inline]
pub fn usable(geometry: &Geometry, uses: TextureUse) -> Option<(TextureUse, &Texture)> {
    if geometry.mesh.uvs.is_empty() {
        return None;
    }
    let texture = geometry.textures.get(uses.texture as usize)?;
    let count = u64::from(texture.size[0]) * u64::from(texture.size[1]);
    (count > 0 && texture.texels.len() as u64 == count).then_some((uses, texture))
}
