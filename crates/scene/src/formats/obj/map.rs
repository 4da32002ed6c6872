//! `map_Kd` and the like: a texture with options before its file name, as in `map_Kd -s 2 2 -clamp on brick wall.png`.

use std::path::Path;

use glam::{Affine2, Mat2, Vec2};

use crate::{NormalMap, OpacityChannel, TextureUse, Wrap, draft::Draft, formats::text::number};

/// A texture of a material.
#[derive(Debug, PartialEq)]
pub(super) struct Map {
    /// Its name as in the library.
    pub(super) file: String,
    scale: Vec2,
    offset: Vec2,
    clamp: bool,
    /// The bump multiplier `-bm`.
    pub(super) multiplier: f32,
    /// The channel that counts where one number is wanted, if the file says so.
    pub(super) channel: Option<OpacityChannel>,
}

impl Map {
    /// Parses the text after `map_Kd` or the like; `None` if no file is named. Options that do not affect colour or coordinates are
    /// skipped.
    pub(super) fn parse(text: &str) -> Option<Map> {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_stand_before_a_name_that_may_hold_blanks() {
        let map = |file: &str, scale, offset, clamp| {
            let (scale, offset) = (Vec2::from(scale), Vec2::from(offset));
            Some(Map { file: file.to_owned(), scale, offset, clamp, multiplier: 1.0, channel: None })
        };
        let plain = |file| map(file, [1.0; 2], [0.0; 2], false);
        assert_eq!(Map::parse("brick wall.png"), plain("brick wall.png"));
        assert_eq!(Map::parse(r".\maps\oak #2.png"), plain(r".\maps\oak #2.png"));
        let all = "-blendu on -mm 0 1  -s 2 3 1 -o 0.5 -t 9 9 9 -clamp on -bm 1 a b.png";
        assert_eq!(Map::parse(all), map("a b.png", [2.0, 3.0], [0.5, 0.0], true));
        assert_eq!(Map::parse("-s 4 7 7.png"), map("7.png", [4.0, 7.0], [0.0; 2], false));
        assert_eq!(Map::parse("-odd.png"), plain("-odd.png"));
        assert_eq!(Map::parse("-s 1 1 1 \"brick wall.png\""), plain("brick wall.png"));
        assert_eq!(Map::parse("-odd one.png"), plain("-odd one.png"));
        assert_eq!(Map::parse("-bm -0.25 a.png").map(|map| map.multiplier), Some(-0.25));
        assert_eq!(Map::parse("-bm nan a.png"), plain("a.png"));
        let channels =
            ["r", "g", "b", "m", "l", "z"].map(|word| Map::parse(&format!("-imfchan {word} a.png")).unwrap().channel);
        let found: Vec<_> = channels.into_iter().flatten().map(OpacityChannel::name).collect();
        assert_eq!((found, channels[5]), (vec!["red", "green", "blue", "alpha", "luminance"], None));
        assert_eq!(
            [Map::parse(""), Map::parse("-s 1 1 1"), Map::parse("-clamp on")].map(|map| map.map(|m| m.file)),
            [None, Some("1".into()), None]
        );
    }
}
