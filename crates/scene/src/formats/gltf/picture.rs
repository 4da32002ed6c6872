//! Textures of materials: image, sampler and `KHR_texture_transform`.

use std::collections::HashMap;
use std::path::Path;

use glam::{Affine2, Mat2, Vec2};

use super::{
    buffers::Buffers,
    document::{Document, TextureInfo},
    uri::{self, Uri},
};
use crate::build::draft::Draft;
use crate::{TextureUse, Wrap};

/// The images of a file, each decoded on first use.
pub(super) struct Pictures<'a> {
    path: &'a Path,
    document: &'a Document<'a>,
    buffers: &'a Buffers<'a>,
    /// By image: index of the texture in the draft, or that it is unavailable.
    decoded: Vec<Option<Option<u32>>>,
    /// The same by content: images of a hostile file may all be views of one.
    known: HashMap<&'a [u8], Option<u32>>,
    /// Number of textures that the file refers to, but does not contain.
    pub(super) missing: usize,
}

impl<'a> Pictures<'a> {
    pub(super) fn new(path: &'a Path, document: &'a Document<'a>, buffers: &'a Buffers<'a>) -> Pictures<'a> {
        Pictures {
            path,
            document,
            buffers,
            decoded: vec![None; document.images.len()],
            known: HashMap::new(),
            missing: 0,
        }
    }

    /// How a material uses its texture, with the set of texture coordinates. `None` if the image is not available.
    pub(super) fn find(&mut self, info: &TextureInfo, draft: &mut Draft) -> Option<(TextureUse, u32)> {
        let textures = &self.document.textures;
        let Some((texture, image)) =
            textures.get(info.index as usize).and_then(|texture| Some((texture, texture.source? as usize)))
        else {
            self.missing += 1;
            return None;
        };
        let index = self.decode(image, draft)?;
        let sampler = texture.sampler.and_then(|sampler| self.document.samplers.get(sampler as usize));
        let transform = info.extensions.as_ref().and_then(|extensions| extensions.transform.as_ref());
        let found = TextureUse {
            texture: index,
            wrap: sampler.map_or([Wrap::Repeat; 2], |sampler| [sampler.wrap_s, sampler.wrap_t].map(wrap)),
            transform: transform.map_or(Affine2::IDENTITY, |it| affine(it.scale.into(), it.rotation, it.offset.into())),
        };
        Some((found, transform.and_then(|transform| transform.tex_coord).unwrap_or(info.tex_coord)))
    }

    fn decode(&mut self, index: usize, draft: &mut Draft) -> Option<u32> {
        if let Some(Some(known)) = self.decoded.get(index) {
            return *known;
        }
        let read = self.read(index, draft);
        self.missing += usize::from(read.is_none());
        let found = read.flatten();
        if let Some(decoded) = self.decoded.get_mut(index) {
            *decoded = Some(found);
        }
        found
    }

    /// `None`: the file does not contain it. `Some(None)`: what it contains or refers to cannot be used, as the draft will report.
    fn read(&mut self, index: usize, draft: &mut Draft) -> Option<Option<u32>> {
        let image = self.document.images.get(index)?;
        let name = image.name.as_deref().map_or_else(|| format!("image {index}"), str::to_owned);
        if let Some(view) = image.buffer_view {
            let (bytes, _) = self.buffers.view(view).ok()?;
            let path = self.path;
            return Some(*self.known.entry(bytes).or_insert_with(|| draft.texture_bytes(path, &name, bytes)));
        }
        Some(match Uri::new(image.uri.as_deref()?) {
            Uri::Data(data) => match self.known.get(data.as_bytes()) {
                Some(known) => *known,
                None => {
                    let found = draft.texture_bytes(self.path, &name, &uri::decode(data)?);
                    *self.known.entry(data.as_bytes()).or_insert(found)
                }
            },
            Uri::File(file) => draft.texture_file(self.path, &file),
        })
    }
}

/// By OpenGL's constant; unknown values repeat, as the default does.
fn wrap(number: Option<u32>) -> Wrap {
    match number {
        Some(33071) => Wrap::Clamp,
        Some(33648) => Wrap::Mirror,
        _ => Wrap::Repeat,
    }
}

/// Scale, then rotation, then offset. Positive rotations turn the coordinates counter-clockwise as seen with v downwards: this is
/// what the extension's text and its examples say, while its shader code turns the other way.
pub fn affine(scale: Vec2, rotation: f32, offset: Vec2) -> Affine2 {
    let (sin, cos) = rotation.sin_cos();
    let rotation = Mat2::from_cols(Vec2::new(cos, -sin), Vec2::new(sin, cos));
    Affine2 { matrix2: rotation * Mat2::from_diagonal(scale), translation: offset }
}
