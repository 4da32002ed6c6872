//! `map_Kd` and the like: a texture with options before its file name, as in `map_Kd -s 2 2 -clamp on brick wall.png`.

use std::path::Path;

use glam::{Affine2, Mat2, Vec2};

use crate::build::draft::Draft;
use crate::formats::text::number;
use crate::{NormalMap, OpacityChannel, TextureUse, Wrap};

/// A texture of a material.
#[derive(Debug, PartialEq)]
pub struct Map {
    /// Its name as in the library.
    pub file: String,
    /// Of coordinates: how often it is repeated.
    pub scale: Vec2,
    /// What is added to coordinates.
    pub offset: Vec2,
    /// It is not repeated.
    pub clamp: bool,
    /// The bump multiplier `-bm`.
    pub multiplier: f32,
    /// The channel that counts where one number is wanted, if the file says so.
    pub channel: Option<OpacityChannel>,
}

impl Map {
    /// Parses the text after `map_Kd` or the like; `None` if no file is named. Options that do not affect colour or coordinates are
    /// skipped.
    pub fn parse(text: &str) -> Option<Map> {
        let (scale, offset) = (Vec2::ONE, Vec2::ZERO);
        let mut map = Map { file: String::new(), scale, offset, clamp: false, multiplier: 1.0, channel: None };
        let mut rest = text.trim();
        while let Some(option) = rest.strip_prefix('-') {
            let Some((name, after)) = option.split_once(char::is_whitespace) else { break };
            rest = match name {
                "s" => vector(after, &mut map.scale),
                "o" => vector(after, &mut map.offset),
                "t" => vector(after, &mut Vec2::default()),
                "clamp" => {
                    let (value, rest) = after.trim_start().split_once(char::is_whitespace)?;
                    map.clamp = value == "on";
                    rest
                }
                "imfchan" => {
                    let (value, rest) = after.trim_start().split_once(char::is_whitespace)?;
                    map.channel = channel(value);
                    rest
                }
                "bm" => {
                    let (value, rest) = after.trim_start().split_once(char::is_whitespace)?;
                    let given = number(value.as_bytes()).map(|number| number as f32);
                    map.multiplier = given.filter(|number| number.is_finite()).unwrap_or(map.multiplier);
                    rest
                }
                "mm" => skip_words(after, 2)?,
                "blendu" | "blendv" | "boost" | "texres" | "type" | "cc" => skip_words(after, 1)?,
                // The file name begins with a hyphen.
                _ => break,
            }
            .trim_start();
        }
        map.file = unquoted(rest).to_owned();
        (!map.file.is_empty()).then_some(map)
    }

    /// The same texture as normals: those of an image of heights, unless it is one of normals.
    pub(super) fn normal_map(&self, library: &Path, heights: bool, draft: &mut Draft) -> Option<NormalMap> {
        let uses = self.texture_use(library, draft)?;
        let texture = if heights { draft.normals_of(uses.texture, self.clamp)? } else { uses.texture };
        Some(NormalMap { uses: TextureUse { texture, ..uses }, scale: self.multiplier })
    }

    /// Whether it is placed, and continues beyond its edges, like another one.
    pub(super) fn is_placed_like(&self, other: &Map) -> bool {
        (self.scale, self.offset, self.clamp) == (other.scale, other.offset, other.clamp)
    }

    /// What counts of a texture where one number is wanted: the channel that the file names; else alpha if there is any, else luminance.
    pub(super) fn channel_of(&self, texture: u32, draft: &Draft) -> OpacityChannel {
        self.channel.unwrap_or_else(|| OpacityChannel::suggested_by(&draft.textures[texture as usize]))
    }

    /// The texture, read for `library`, the file that names it. `None` if it is not available.
    pub(super) fn texture_use(&self, library: &Path, draft: &mut Draft) -> Option<TextureUse> {
        let texture = draft.texture_file(library, &self.file)?;
        // In the file, (u, v) becomes scale (u, v) + offset with v upwards; here v points downwards on both sides.
        let Vec2 { x: scale_u, y: scale_v } = self.scale;
        let offset = Vec2::new(self.offset.x, 1.0 - scale_v - self.offset.y);
        let transform = Affine2::from_mat2_translation(Mat2::from_diagonal(Vec2::new(scale_u, scale_v)), offset);
        let wrap = if self.clamp { Wrap::Clamp } else { Wrap::Repeat };
        Some(TextureUse { wrap: [wrap; 2], transform, ..TextureUse::new(texture) })
    }
}

/// The channel of `-imfchan`; `None` for those that images do not have, such as depth.
fn channel(word: &str) -> Option<OpacityChannel> {
    Some(match word {
        "r" => OpacityChannel::Red,
        "g" => OpacityChannel::Green,
        "b" => OpacityChannel::Blue,
        "m" => OpacityChannel::Alpha,
        "l" => OpacityChannel::Luminance,
        _ => return None,
    })
}

/// Reads one to three numbers, of which the first two matter, and returns the rest.
fn vector<'a>(text: &'a str, value: &mut Vec2) -> &'a str {
    let mut rest = text;
    for axis in 0..3 {
        let trimmed = rest.trim_start();
        let Some((word, after)) = trimmed.split_once(char::is_whitespace) else { break };
        let Some(number) = number(word.as_bytes()).map(|number| number as f32).filter(|number| number.is_finite())
        else {
            break;
        };
        if axis < 2 {
            value[axis] = number;
        }
        rest = after;
    }
    rest
}

/// A file's name without the quotation marks that some programs put around it.
pub(super) fn unquoted(name: &str) -> &str {
    name.strip_prefix('"').and_then(|name| name.strip_suffix('"')).unwrap_or(name)
}

fn skip_words(text: &str, count: usize) -> Option<&str> {
    (0..count).try_fold(text, |rest, _| rest.trim_start().split_once(char::is_whitespace).map(|(_, rest)| rest))
}
