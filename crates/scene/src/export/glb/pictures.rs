//! Textures in a GLB: PNG images in the buffer, samplers, and how each material uses its texture.

use std::{
    collections::HashMap,
    hash::Hash,
    io::{self, Cursor},
};

use glam::{Affine2, Vec2};
use image::{ExtendedColorType, ImageEncoder, codecs::png::PngEncoder};
use serde_json::{Value, json};

use crate::formats::gltf::affine;
use crate::{Material, Opacity, OpacityChannel, Scene, Texture, TextureUse, Wrap};

/// The textures of a scene, as stored in a GLB.
#[derive(Default)]
pub(super) struct Pictures {
    /// PNG files, in the order of the scene's textures; none if no material can use it.
    files: Vec<Option<Vec<u8>>>,
    /// Images with colours of one texture and opacities of another, which come after them.
    composed: Vec<Composed>,
    /// How texels are looked up beyond the edge.
    samplers: Distinct<[Wrap; 2]>,
    /// Image and sampler of each glTF texture.
    textures: Distinct<(usize, usize)>,
    by_material: Vec<MaterialPictures>,
    transformed: bool,
}

/// Colours with opacities.
struct Composed {
    /// The textures of the scene, and what of the second one is the opacity.
    of: (Option<u32>, Option<(u32, OpacityChannel)>),
    name: String,
    file: Vec<u8>,
}

/// A glTF texture, and how it is used.
type Picture = (usize, TextureUse);

/// The glTF textures of a material.
struct MaterialPictures {
    color: Option<Picture>,
    emission: Option<Picture>,
    normals: Option<Picture>,
    roughness: Option<Picture>,
    opacity: Option<Picture>,
    /// Colours with opacities, for other programs.
    shown: Option<Picture>,
}

impl MaterialPictures {
    /// Those that glTF has a place for.
    fn standard(&self) -> [Option<Picture>; 4] {
        [self.shown.or(self.color), self.emission, self.normals, self.roughness]
    }
}

impl Pictures {
    /// Encodes the textures that materials use.
    pub(super) fn new(scene: &Scene) -> io::Result<Pictures> {
        let mut pictures = Pictures { files: vec![None; scene.geometry.textures.len()], ..Pictures::default() };
        for material in &scene.geometry.materials {
            let own = MaterialPictures {
                color: pictures.find(scene, material.texture)?,
                emission: pictures.find(scene, material.emission_texture)?,
                normals: pictures.find(scene, material.normal_texture.map(|map| map.uses))?,
                roughness: pictures.find(scene, material.metallic_roughness_texture)?,
                opacity: pictures.find(scene, material.opacity.and_then(|opacity| opacity.texture))?,
                shown: pictures.compose(scene, material)?,
            };
            let is_placed = |(_, uses): Picture| uses.transform != Affine2::IDENTITY;
            pictures.transformed |= own.standard().into_iter().flatten().any(is_placed);
            pictures.by_material.push(own);
        }
        Ok(pictures)
    }

    /// The index of the glTF texture that a material uses like this, if it can be used.
    fn find(&mut self, scene: &Scene, uses: Option<TextureUse>) -> io::Result<Option<Picture>> {
        let found = uses.and_then(|uses| Some((uses, scene.geometry.textures.get(uses.texture as usize)?)));
        Ok(match found.filter(|(_, texture)| is_whole(texture)) {
            Some((uses, texture)) => Some((self.add(uses, texture)?, uses)),
            None => None,
        })
    }

    /// The index of the glTF texture that shows `texture` as described by `uses`.
    fn add(&mut self, uses: TextureUse, texture: &Texture) -> io::Result<usize> {
        let file = &mut self.files[uses.texture as usize];
        if file.is_none() {
            *file = Some(png(texture)?);
        }
        let sampler = self.samplers.index_of(uses.wrap);
        Ok(self.textures.index_of((uses.texture as usize, sampler)))
    }

    /// The image in which other programs find both colours and opacities of a material that has them apart: in the places of both, which must
    /// be the same, and with as many texels as the larger one.
    fn compose(&mut self, scene: &Scene, material: &Material) -> io::Result<Option<Picture>> {
        let Some(opacity) = material.opacity.filter(|opacity| needs_composing(opacity, material)) else {
            return Ok(None);
        };
        let texture = |uses: Option<TextureUse>| {
            let texture = scene.geometry.textures.get(uses?.texture as usize)?;
            is_whole(texture).then_some(texture)
        };
        let (colors, opacities) = (texture(material.texture), texture(opacity.texture));
        let Some(uses) = material.texture.or(opacity.texture) else { return Ok(None) };
        if colors.is_none() && opacities.is_none() {
            return Ok(None);
        }
        let of = (
            colors.and(material.texture).map(|uses| uses.texture),
            opacities.and(opacity.texture).map(|uses| (uses.texture, opacity.channel)),
        );
        let known = self.composed.iter().position(|composed| composed.of == of);
        let number = match known {
            Some(known) => known,
            None => {
                let names = [colors, opacities].map(|texture| texture.map_or("opaque", |texture| &texture.name));
                let name =
                    format!("{} with opacity of {}", if colors.is_some() { names[0] } else { "white" }, names[1]);
                let file = png(&composed(colors, opacities, opacity.channel))?;
                self.composed.push(Composed { of, name, file });
                self.composed.len() - 1
            }
        };
        let sampler = self.samplers.index_of(uses.wrap);
        Ok(Some((self.textures.index_of((self.files.len() + number, sampler)), uses)))
    }

    /// The `baseColorTexture` of a material.
    pub(super) fn of_material(&self, index: usize) -> Option<Value> {
        let own = &self.by_material[index];
        Some(info(own.shown.or(own.color)?))
    }

    /// Whether the base colour's texture is not only that of the colours, but also of opacities; then that of the colours.
    pub(super) fn apart(&self, index: usize) -> Option<Option<Picture>> {
        let own = &self.by_material[index];
        own.shown.map(|_| own.color)
    }

    /// The `emissiveTexture` of a material.
    pub(super) fn emission_of_material(&self, index: usize) -> Option<Value> {
        Some(info(self.by_material[index].emission?))
    }

    /// The `normalTexture` of a material, without its scale.
    pub(super) fn normals_of_material(&self, index: usize) -> Option<Value> {
        Some(info(self.by_material[index].normals?))
    }

    /// The `metallicRoughnessTexture` of a material.
    pub(super) fn roughness_of_material(&self, index: usize) -> Option<Value> {
        Some(info(self.by_material[index].roughness?))
    }

    /// The index of the glTF texture that cuts a material out, and how it is used.
    pub(super) fn opacity_of_material(&self, index: usize) -> Option<Picture> {
        self.by_material[index].opacity
    }

    /// The transforms of a material's texture, of its emission's, its normals' and its facets', if glTF's angle and factors do not reproduce
    /// them to the last bit.
    pub(super) fn exact_transforms(&self, index: usize) -> [Option<[f32; 6]>; 4] {
        self.by_material[index].standard().map(|entry| {
            let transform = entry?.1.transform;
            let (scale, rotation, offset) = parts(&transform);
            (affine(scale, rotation, offset) != transform).then(|| transform.to_cols_array())
        })
    }

    /// Whether the file needs KHR_texture_transform.
    pub(super) fn transformed(&self) -> bool {
        self.transformed
    }

    /// Appends the images to `bin` and describes them, samplers and textures in `root`.
    pub(super) fn write(self, scene: &Scene, bin: &mut Vec<u8>, root: &mut Value) {
        if self.textures.list.is_empty() {
            return;
        }
        let mut images = Vec::new();
        let own = self.files.into_iter().zip(scene.geometry.textures.iter().map(|texture| texture.name.clone()));
        let composed = self.composed.into_iter().map(|Composed { name, file, .. }| (Some(file), name));
        let mut place = Vec::new();
        for (file, name) in own.chain(composed) {
            place.push(images.len());
            let (Some(file), Some(views)) = (file, root["bufferViews"].as_array_mut()) else { continue };
            images.push(json!({"name": name, "mimeType": "image/png", "bufferView": views.len()}));
            views.push(json!({"buffer": 0, "byteOffset": bin.len(), "byteLength": file.len()}));
            bin.extend(file);
        }
        root["images"] = Value::Array(images);
        root["samplers"] = self
            .samplers
            .list
            .iter()
            .map(|wrap| json!({"wrapS": gl_word(wrap[0]), "wrapT": gl_word(wrap[1])}))
            .collect();
        let texture = |&(image, sampler): &(usize, usize)| json!({"source": place[image], "sampler": sampler});
        root["textures"] = self.textures.list.iter().map(texture).collect();
    }
}

/// Values in the order in which they first occurred.
struct Distinct<T> {
    list: Vec<T>,
    indices: HashMap<T, usize>,
}

impl<T> Default for Distinct<T> {
    fn default() -> Distinct<T> {
        Distinct { list: Vec::new(), indices: HashMap::new() }
    }
}

impl<T: Copy + Eq + Hash> Distinct<T> {
    /// The index of a value, which is added if it is new.
    fn index_of(&mut self, value: T) -> usize {
        *self.indices.entry(value).or_insert_with(|| {
            self.list.push(value);
            self.list.len() - 1
        })
    }
}

/// A texture and how it is placed.
fn info((texture, uses): Picture) -> Value {
    let mut info = json!({"index": texture});
    if uses.transform != Affine2::IDENTITY {
        let (scale, rotation, offset) = parts(&uses.transform);
        info["extensions"] = json!({"KHR_texture_transform":
            {"offset": offset.to_array(), "rotation": rotation, "scale": scale.to_array()}});
    }
    info
}

/// Whether opacities are not what glTF takes for them, the alpha of the base colour, but can be put there.
pub(super) fn needs_composing(opacity: &Opacity, material: &Material) -> bool {
    let is_alpha = opacity.texture.is_none() || opacity.channel == OpacityChannel::Alpha;
    let is_standard = is_alpha && opacity.texture == material.texture;
    let is_there_too = |(colors, opacities): (TextureUse, TextureUse)| {
        (colors.wrap, colors.transform) == (opacities.wrap, opacities.transform)
    };
    material.dielectric.is_none() && !is_standard && material.texture.zip(opacity.texture).is_none_or(is_there_too)
}

/// The colours of one texture, or white, with opacities of another, or 1.
fn composed(colors: Option<&Texture>, opacities: Option<&Texture>, channel: OpacityChannel) -> Texture {
    let side = |axis: usize| [colors, opacities].iter().flatten().map(|texture| texture.size[axis]).max().unwrap_or(1);
    let size = [side(0), side(1)];
    let texel = |texture: &Texture, x: u32, y: u32| {
        let at = |axis: usize, place: u32| u64::from(place) * u64::from(texture.size[axis]) / u64::from(size[axis]);
        texture.texels[(at(1, y) * u64::from(texture.size[0]) + at(0, x)) as usize]
    };
    let of_both = |(x, y): (u32, u32)| {
        let [r, g, b, _] = colors.map_or([u8::MAX; 4], |colors| texel(colors, x, y));
        [r, g, b, opacities.map_or(u8::MAX, |opacities| OpacityChannel::of(texel(opacities, x, y), channel))]
    };
    let places = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
    Texture { name: String::new(), size, texels: places.map(of_both).collect() }
}

fn is_whole(texture: &Texture) -> bool {
    let texels = u64::from(texture.size[0]) * u64::from(texture.size[1]);
    texels > 0 && texels == texture.texels.len() as u64
}

fn png(texture: &Texture) -> io::Result<Vec<u8>> {
    let mut bytes = Cursor::new(Vec::new());
    let [width, height] = texture.size;
    PngEncoder::new(&mut bytes)
        .write_image(texture.texels.as_flattened(), width, height, ExtendedColorType::Rgba8)
        .map_err(io::Error::other)?;
    Ok(bytes.into_inner())
}

/// Scale, angle and offset of KHR_texture_transform.
pub(in crate::export) fn parts(transform: &Affine2) -> (Vec2, f32, Vec2) {
    let (x, y) = (transform.matrix2.x_axis, transform.matrix2.y_axis);
    if x.y == 0.0 && y.x == 0.0 {
        return (Vec2::new(x.x, y.y), 0.0, transform.translation);
    }
    let angle = (-x.y).atan2(x.x);
    let (sin, cos) = angle.sin_cos();
    (Vec2::new(x.length(), y.dot(Vec2::new(sin, cos))), angle, transform.translation)
}

/// OpenGL's constant.
fn gl_word(wrap: Wrap) -> u32 {
    match wrap {
        Wrap::Repeat => 10497,
        Wrap::Mirror => 33648,
        Wrap::Clamp => 33071,
    }
}
