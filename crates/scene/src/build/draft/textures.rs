//! The textures of a draft, each file once.

use std::path::{Path, PathBuf};

use super::Draft;
use crate::build::error::{LoadError, Place};
use crate::build::textures::decode::{Undecodable, decode};
use crate::build::textures::files::Numbers;
use crate::optics::heights::{is_grey, normals_of_heights};
use crate::optics::packed::{packed, size_of_packed};
use crate::{OpacityChannel, Texture};

impl Draft {
    /// Index of the texture in the file that `source`, one of the scene's files, refers to as `name`. Each file is read once. If
    /// it is not available, a warning will say so.
    pub fn texture_file(&mut self, source: &Path, name: &str) -> Option<u32> {
        self.refer(source, name);
        let named = self.access.path_beside(source, name);
        // A refused name is not a path: the file must not be accessed.
        let key = named.unwrap_or_else(|_| PathBuf::from(format!("{}\0{name}", source.display())));
        if let Some(&known) = self.texture_files.read.get(&key) {
            return known;
        }
        let index = match self.read_nearby(source, name) {
            Ok((path, bytes)) => {
                let decoded = decode(name, &bytes, self.access.budget);
                self.texture(&path, &path.display().to_string(), decoded)
            }
            Err(error) => {
                self.texture_files.missing.push(error.named_by(Place::file(source)).to_string());
                None
            }
        };
        self.texture_files.read.insert(key, index);
        index
    }

    /// Index of the texture in `bytes`, an image that `source` contains and calls `name`. If it cannot be used, a warning will say
    /// so.
    pub fn texture_bytes(&mut self, source: &Path, name: &str, bytes: &[u8]) -> Option<u32> {
        let decoded = decode(name, bytes, self.access.budget);
        self.texture(source, &format!("{}: {name}", source.display()), decoded)
    }

    /// Index of a texture of the normals of another one, of heights, which may be one of normals itself. `clamp`: whether it ends at its edges.
    /// Where memory is short, there is none.
    pub(crate) fn normals_of(&mut self, heights: u32, clamp: bool) -> Option<u32> {
        if let Some(&known) = self.texture_files.normals.get(&(heights, clamp)) {
            return Some(known);
        }
        let texture = &self.textures[heights as usize];
        let found = if is_grey(texture) {
            self.access.budget.check(size_of_val(&*texture.texels) as u64).ok()?;
            self.textures.push(normals_of_heights(texture, clamp));
            self.textures.len() as u32 - 1
        } else {
            heights
        };
        self.texture_files.normals.insert((heights, clamp), found);
        Some(found)
    }

    /// Index of a texture whose green is the roughness that the first image has, and whose blue says how metallic surfaces are by the
    /// second, for `source`, which names them; `None` without any, and where memory is short, which ends the reading.
    pub(crate) fn packed(&mut self, source: &Path, images: [Option<Numbers>; 2]) -> Option<u32> {
        match images {
            [None, None] => return None,
            [Some((texture, OpacityChannel::Green)), Some((other, OpacityChannel::Blue))] if texture == other => {
                return Some(texture);
            }
            _ => {}
        }
        if let Some(&known) = self.texture_files.packed.get(&images) {
            return Some(known);
        }
        let found = images.map(|image| image.map(|(texture, channel)| (&self.textures[texture as usize], channel)));
        let size @ [width, height] = size_of_packed(found);
        let bytes = size_of::<[u8; 4]>() as u64 * u64::from(width) * u64::from(height);
        let made = self.access.budget.check(bytes).map(|()| packed(found));
        let made = made.map_err(|short| Undecodable::TooLarge { size, short });
        let index = self.texture(source, &source.display().to_string(), made)?;
        self.texture_files.packed.insert(images, index);
        Some(index)
    }

    /// Keeps the texture of the file at `path`, called `place` in messages.
    fn texture(&mut self, path: &Path, place: &str, decoded: Result<Texture, Undecodable>) -> Option<u32> {
        match decoded {
            Ok(texture) => {
                self.textures.push(texture);
                Some(self.textures.len() as u32 - 1)
            }
            Err(Undecodable::Odd(reason)) => {
                self.texture_files.missing.push(format!("{place} ({reason})"));
                None
            }
            Err(Undecodable::TooLarge { size: [width, height], short }) => {
                let what = format!("a texture of {width}x{height} texels");
                self.too_large.get_or_insert(LoadError::Memory { path: path.to_owned(), what, short });
                None
            }
        }
    }
}
