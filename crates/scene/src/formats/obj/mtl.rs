//! Material libraries of OBJ files: Ka, Kd, Ks, Ns, Ke, map_Kd and map_Ke to the coefficients of formula (1), Pr, Pm and
//! their maps to facets, map_d to where the surface is, norm and bump to its normals.

use std::{
    collections::HashSet,
    path::{Path, PathBuf},
};

use glam::{DVec3, Vec3};

use super::{
    error::malformed,
    lines::Lines,
    map::{Map, unquoted},
};
use crate::build::draft::Draft;
use crate::build::error::Place;
use crate::formats::notes::Notes;
use crate::formats::text::{decoded, number, odd_number, quoted, split_word, with_line_feeds, words};
use crate::{Dielectric, Facets, LoadError, Material, NormalMap, Opacity, OpacityChannel, TextureUse};

/// One material as its library describes it.
#[derive(Default)]
pub(super) struct Entry {
    pub(super) name: String,
    /// The library.
    path: PathBuf,
    ambient: Option<Vec3>,
    diffuse: Option<Vec3>,
    specular: Option<Vec3>,
    emissive: Option<Vec3>,
    shininess: Option<f32>,
    roughness: Option<f64>,
    metallic: Option<f64>,
    /// An image of numbers that the roughness is multiplied with, and one for how metallic it is.
    roughness_map: Option<Map>,
    metallic_map: Option<Map>,
    map: Option<Map>,
    opacity: Option<Map>,
    glow: Option<Map>,
    normals: Option<Map>,
    /// An image of heights, or of normals: programs write both.
    bump: Option<Map>,
    dissolve: Option<f64>,
    transparency: Option<f64>,
    filter: Option<Vec3>,
    /// Whether the illumination model refracts.
    refracts: bool,
    ior: Option<f64>,
}

/// Statements of libraries that the scene's model cannot represent.
#[derive(Default)]
struct LeftOut {
    maps: usize,
    /// Images of how metallic a surface is that are not placed like those of its roughness.
    apart: usize,
    spectral: usize,
}

/// Reads the libraries that `mtllib` lines name, in their order. One that cannot be read is a warning, because the shape is
/// available without it.
pub(super) fn read_libraries(
    obj: &Path,
    lines: &[(usize, String)],
    draft: &mut Draft,
) -> Result<Vec<Entry>, LoadError> {
    let mut entries = Vec::new();
    let (mut seen, mut paths) = (HashSet::new(), HashSet::new());
    for (place, name) in refer(obj, lines, draft) {
        if seen.contains(&name) {
            continue;
        }
        match draft.read_nearby(obj, &name) {
            // The same file by another name is read once as well.
            Ok((path, _)) if !paths.insert(path.clone()) => {}
            Ok((path, mut bytes)) => read_library(&path, with_line_feeds(&mut bytes), &mut entries, draft)
                .map_err(|error| error.named_by(place))?,
            Err(error) => draft.warnings.push(format!("{}; light grey is used instead", error.named_by(place))),
        }
        seen.insert(name);
    }
    Ok(entries)
}

/// Notes the libraries; returns their names, and the places of these.
pub(super) fn refer(obj: &Path, lines: &[(usize, String)], draft: &mut Draft) -> Vec<(Place, String)> {
    let mut libraries = Vec::new();
    for (number, line) in lines {
        for name in file_names(obj, line, draft) {
            draft.refer(obj, &name);
            libraries.push((Place::line(obj, *number), name));
        }
    }
    libraries
}

/// The files of an `mtllib` line: one whose name may contain blanks or be in quotation marks, or several; whichever exist. If none
/// exists, the line is split after file extensions.
fn file_names(obj: &Path, line: &str, draft: &Draft) -> Vec<String> {
    const ENDING: &str = ".mtl";
    let line = unquoted(line);
    let mut by_ending = Vec::new();
    let mut name = String::new();
    for word in line.split_whitespace() {
        name = if name.is_empty() { word.to_owned() } else { name + " " + word };
        if word.to_ascii_lowercase().ends_with(ENDING) {
            by_ending.push(std::mem::take(&mut name));
        }
    }
    by_ending.extend((!name.is_empty()).then_some(name));
    let whole = vec![line.to_owned()];
    let by_blank: Vec<String> = line.split_whitespace().map(str::to_owned).collect();
    let is_there = |name: &String| draft.access.path_beside(obj, name).is_ok_and(|path| path.is_file());
    let found = [whole, by_ending.clone(), by_blank].into_iter().find(|names| names.iter().all(is_there));
    found.unwrap_or(by_ending)
}

fn read_library(path: &Path, text: &[u8], entries: &mut Vec<Entry>, draft: &mut Draft) -> Result<(), LoadError> {
    let mut left_out = LeftOut::default();
    let mut notes = Notes::default();
    let mut lines = Lines::new(text);
    let (mut entry, first_entry): (Option<Entry>, _) = (None, entries.len());
    while let Some((number, line)) = lines.next_line() {
        let (word, rest) = split_word(line);
        if is_map(word)
            && let Some(map) = Map::parse(&decoded(rest))
        {
            draft.refer(path, &map.file);
        }
        let first = || (number, quoted(word));
        match (word, &mut entry) {
            (b"" | [b'#', ..], _) => {}
            (b"newmtl", _) => {
                let name = decoded(rest).into_owned();
                if name.is_empty() {
                    notes.add("has no name: it is for faces that name no material", first);
                }
                entries.extend(entry.replace(Entry { name, path: path.to_owned(), ..Entry::default() }));
            }
            (_, None) => notes.add("is above the first `newmtl`, and ignored", first),
            (_, Some(entry)) => entry
                .set(word, rest, &mut left_out)
                .map_err(|problem| malformed(path, number, problem, "correct the line or export the file again"))?,
        }
    }
    entries.extend(entry);
    for entry in &mut entries[first_entry..] {
        entry.keep_together(&mut left_out);
    }
    draft.warnings.extend(notes.warnings(path));
    let LeftOut { maps, apart, spectral } = left_out;
    for (count, what) in [
        (maps, "textures other than map_Kd, map_d, map_Ke, map_Pr, map_Pm, norm and bump"),
        (apart, "map_Pm with other options than map_Pr of the same material"),
        (spectral, "spectral or CIE-XYZ colours"),
    ] {
        if count > 0 {
            draft.warnings.push(format!("{}: {count} {what} were ignored", path.display()));
        }
    }
    Ok(())
}

impl Entry {
    /// Parses one line; the error describes the problem.
    fn set(&mut self, word: &[u8], rest: &[u8], left_out: &mut LeftOut) -> Result<(), String> {
        match word {
            b"Ka" | b"Kd" | b"Ks" | b"Ke" | b"Tf" => {
                if matches!(words(rest).next(), Some(b"spectral" | b"xyz")) {
                    left_out.spectral += 1;
                    return Ok(());
                }
                let color = Some(color(word, rest)?);
                match word {
                    b"Ka" => self.ambient = color,
                    b"Kd" => self.diffuse = color,
                    b"Ks" => self.specular = color,
                    b"Tf" => self.filter = color,
                    _ => self.emissive = color,
                }
            }
            b"Ns" => {
                let exponent = words(rest).next().and_then(value).map(|exponent| exponent as f32);
                let usable = exponent.filter(|exponent| exponent.is_finite());
                self.shininess = Some(usable.ok_or("`Ns` must have a number")?);
            }
            b"Pr" => self.roughness = words(rest).next().and_then(value),
            b"Pm" => self.metallic = words(rest).next().and_then(value),
            // In `d -halo 0.5` the number comes last.
            b"d" => self.dissolve = words(rest).last().and_then(value),
            b"illum" => self.refracts = matches!(words(rest).next(), Some(b"6" | b"7")),
            b"Ni" => self.ior = words(rest).next().and_then(value),
            b"Tr" => self.transparency = words(rest).last().and_then(value),
            b"map_Kd" => self.map = Map::parse(&decoded(rest)),
            b"map_Ke" => self.glow = Map::parse(&decoded(rest)),
            b"map_Pr" => self.roughness_map = Map::parse(&decoded(rest)),
            b"map_Pm" => self.metallic_map = Map::parse(&decoded(rest)),
            b"map_d" => self.opacity = Map::parse(&decoded(rest)),
            b"norm" | b"map_Kn" => self.normals = Map::parse(&decoded(rest)),
            b"bump" | b"map_Bump" | b"map_bump" => self.bump = Map::parse(&decoded(rest)),
            // Exporters repeat the texture as the ambient texture.
            b"map_Ka" | b"map_aat" => {}
            word if is_map(word) => left_out.maps += 1,
            _ => {}
        }
        Ok(())
    }

    /// Leaves out an image of how metallic it is that is not placed like that of its roughness: both become one.
    fn keep_together(&mut self, left_out: &mut LeftOut) {
        let both = self.roughness_map.as_ref().zip(self.metallic_map.as_ref());
        if both.is_some_and(|(roughness, metallic)| !metallic.is_placed_like(roughness)) {
            self.metallic_map = None;
            left_out.apart += 1;
        }
    }

    /// The share of the surface that is there. Some exporters write `Tr 1` for opaque materials; then there is also `d 1`.
    fn dissolved(&self) -> f32 {
        let share = self.dissolve.or(self.transparency.map(|transparency| 1.0 - transparency));
        share.map_or(1.0, |share| share.clamp(0.0, 1.0) as f32)
    }

    /// The material for the shading model. Without Ka, or with `Ka 0`, which many exporters write whatever the material, the ambient
    /// coefficient is the diffuse one; without Kd a texture is shown as it is; negative values count as 0. An exponent below 1 would
    /// smear the highlight over everything (exporters write `Ns 0` for "none"), so it counts as 1. An image of emitted light is shown
    /// as it is without `Ke`, or with `Ke 0`. Textures are read only if the material is `used`.
    pub(super) fn material(&self, used: bool, draft: &mut Draft) -> Material {
        let default = Material::default();
        let texture = self.map.as_ref().filter(|_| used).and_then(|map| map.texture_use(&self.path, draft));
        let plain = if texture.is_some() { Vec3::ONE } else { default.kd };
        let kd = self.diffuse.unwrap_or(plain);
        let glow = self.glow.as_ref().filter(|_| used);
        let emission_texture = glow.and_then(|map| map.texture_use(&self.path, draft));
        let emission = match (glow, emission_texture) {
            (None, _) => self.emissive.unwrap_or(default.emission),
            (Some(_), None) => Material::EMISSION_WITHOUT_IMAGE,
            (Some(_), Some(_)) => self.emissive.filter(|&emission| emission != Vec3::ZERO).unwrap_or(Vec3::ONE),
        };
        let (metallic_roughness_texture, varied) = self.metallic_roughness_texture(used, draft);
        let facets = self.facets(varied);
        Material {
            name: self.name.clone(),
            ka: self.ambient.filter(|ka| *ka != Vec3::ZERO).unwrap_or(kd),
            kd,
            ks: if facets.is_some() { Vec3::splat(Facets::LAYER) } else { self.specular.unwrap_or(default.ks) },
            facets,
            shininess: self.shininess.map_or(default.shininess, |exponent| exponent.max(1.0)),
            emission,
            lamp: true,
            texture,
            emission_texture,
            normal_texture: self.normal_texture(used, draft),
            metallic_roughness_texture,
            opacity: self.opacity(used, texture, draft),
            dielectric: self.dielectric(),
            ..default
        }
    }

    /// What the extension for physically based rendering says: `Pr`, `Pm` and their maps. Then `Kd` is the base colour, and `Ks`, which
    /// exporters write for others, does not count. An image, where it is `varied`, is shown as it is without its number, or with 0.
    fn facets(&self, varied: [bool; 2]) -> Option<Facets> {
        let numbers = [self.roughness, self.metallic];
        if numbers.iter().all(Option::is_none) && self.roughness_map.is_none() && self.metallic_map.is_none() {
            return None;
        }
        let share = |index: usize, unsaid: f32| match (numbers[index], varied[index]) {
            (None | Some(0.0), true) => 1.0,
            (value, _) => value.map_or(unsaid, |value| value.clamp(0.0, 1.0) as f32),
        };
        Some(Facets::new(share(0, 1.0)).with_metallic(share(1, 0.0)))
    }

    /// The images of roughness and of how metallic it is as one, and whether each is available.
    fn metallic_roughness_texture(&self, used: bool, draft: &mut Draft) -> (Option<TextureUse>, [bool; 2]) {
        let found = [&self.roughness_map, &self.metallic_map].map(|map| {
            let map = map.as_ref().filter(|_| used)?;
            let uses = map.texture_use(&self.path, draft)?;
            Some((uses, map.channel_of(uses.texture, draft)))
        });
        let images = found.map(|image| image.map(|(uses, channel)| (uses.texture, channel)));
        let placed = found.into_iter().flatten().next();
        let both = placed.zip(draft.packed(&self.path, images));
        (both.map(|((uses, _), texture)| TextureUse { texture, ..uses }), found.map(|image| image.is_some()))
    }

    /// The image of normals; else that of `bump`, which may be one, too.
    fn normal_texture(&self, used: bool, draft: &mut Draft) -> Option<NormalMap> {
        let (map, heights) =
            self.normals.as_ref().map(|map| (map, false)).or(self.bump.as_ref().map(|map| (map, true)))?;
        used.then(|| map.normal_map(&self.path, heights, draft)).flatten()
    }

    /// What refracts: illumination models 6 and 7 with an index of refraction `Ni`. Exporters write `Ni 1` where there is none.
    fn dielectric(&self) -> Option<Dielectric> {
        let ior = self.ior.filter(|&ior| self.refracts && ior > 0.0 && ior != 1.0)?;
        Some(Dielectric::new(ior as f32))
    }

    /// What `d` and `Tr` let through, all of it where the surface refracts and they say nothing, times the colour of `Tf`, which some
    /// exporters write as black where they mean white; without these where `map_d` says that the surface is.
    fn opacity(&self, used: bool, color: Option<TextureUse>, draft: &mut Draft) -> Option<Opacity> {
        let (mut factor, filter) = (self.dissolved(), self.filter.filter(|filter| *filter != Vec3::ZERO));
        if factor == 1.0 && self.dielectric().is_some() {
            factor = 0.0;
        }
        let map = self.mask(used, color, draft);
        if factor == 1.0 {
            return map;
        }
        let filter = filter.unwrap_or(Vec3::ONE).clamp(Vec3::ZERO, Vec3::ONE);
        Some(map.unwrap_or_default().with_factor(factor).with_filter(filter))
    }

    /// Where the surface is, by the channel that `-imfchan` names. Without that option, the alpha of the image that colours the surface
    /// counts if both are the same; of another image alpha counts if there is any, else luminance, as the format says for numbers.
    fn mask(&self, used: bool, color: Option<TextureUse>, draft: &mut Draft) -> Option<Opacity> {
        let map = self.opacity.as_ref().filter(|_| used)?;
        let texture = map.texture_use(&self.path, draft)?;
        let channel = match (map.channel, color) {
            (None, Some(color)) if color.texture == texture.texture => OpacityChannel::Alpha,
            _ => map.channel_of(texture.texture, draft),
        };
        Some(Opacity::by(texture, channel))
    }
}

/// Whether a statement names a texture.
fn is_map(word: &[u8]) -> bool {
    matches!(word, b"bump" | b"disp" | b"decal" | b"refl" | b"norm")
        || (word.starts_with(b"map_") && word != b"map_aat")
}

/// One number for all channels, or three.
fn color(word: &[u8], rest: &[u8]) -> Result<Vec3, String> {
    let values: Vec<f64> = words(rest).map_while(value).take(3).collect();
    let [r, g, b] = match (values[..].try_into(), &values[..]) {
        (Ok(channels), _) => channels,
        (_, &[grey]) if words(rest).nth(1).is_none_or(|next| next.starts_with(b"#")) => [grey; 3],
        _ => return Err(not_numbers(word)),
    };
    let color = DVec3::new(r, g, b).as_vec3();
    // This comes first: the maximum of 0 and NaN is 0.
    if color.is_finite() { Ok(color.max(Vec3::ZERO)) } else { Err(not_numbers(word)) }
}

/// A number, however it is written: colours are not so important that each odd one is told.
fn value(word: &[u8]) -> Option<f64> {
    number(word).or_else(|| odd_number(word))
}

fn not_numbers(word: &[u8]) -> String {
    format!("`{}` must have one number or three", decoded(word))
}
