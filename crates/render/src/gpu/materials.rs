//! Materials, their textures and what cuts them out in a device's memory.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use glam::Vec2;
use lightmesh_kernels::Runtime;
use lightmesh_layout::In;
use lightmesh_layout::geometry::{AlphaMask, Mask, Vec3};
use lightmesh_layout::scene::{FacetShare, Material, Scene as Record, Texture, TextureLevel, Uv};
use lightmesh_scene::{Geometry, Wrap};
use lightmesh_trace::accel;

use super::scene::{Upload, vec3};
use crate::error::RenderError;
use crate::shading::facets;
use crate::shading::tint::{Coefficients, is_tinted};
use crate::textures::{AllLevels, Encoding, Image, Level, images_of};

/// Codes of a channel.
const CODES: u32 = 1 << u8::BITS;

impl<R: Runtime> Upload<'_, R> {
    /// What determines the colours of surfaces. Texture coordinates and the table of codes are uploaded only if a texture needs
    /// them.
    pub(super) fn materials(
        &mut self,
        geometry: &Geometry,
        numbers: &[u32],
        textures: &[Texture],
        record: &mut Record,
    ) -> Result<(), RenderError> {
        record.triangle_materials = self.array("materials of triangles", &geometry.mesh.materials)?;
        record.colors = self.array::<Vec3>("colours", bytemuck::cast_slice(&geometry.mesh.colors))?;
        if !textures.is_empty() {
            let codes = |encoding: Encoding| (0..=u8::MAX).map(move |code| encoding.decode(code));
            let codes: Vec<f32> = Encoding::ALL.into_iter().flat_map(codes).collect();
            record.codes = self.array("linear values of codes", &codes)?;
            record.uvs = self.array::<Uv>("texture coordinates", bytemuck::cast_slice(&geometry.mesh.uvs))?;
            record.textures = self.array("textures", textures)?;
        }
        let mut used = 0..;
        let materials: Vec<Material> = geometry
            .materials
            .iter()
            .zip(numbers)
            .map(|(material, &number)| {
                let images = images_of(geometry, material).map(|image| image.and_then(|_| used.next()));
                let [texture, emission_texture, normal_texture, metallic_roughness_texture] =
                    images.map(|image| image.unwrap_or(Material::NO_TEXTURE));
                let own = material_record(geometry, material);
                // Shadow catchers are seen by their shadows alone.
                let normal_texture = if own.tinted == 1 { normal_texture } else { Material::NO_TEXTURE };
                Material { number, texture, emission_texture, normal_texture, metallic_roughness_texture, ..own }
            })
            .collect();
        record.materials = self.array("materials", &materials)?;
        if geometry.materials.iter().any(|material| material.faceted().is_some()) {
            record.facet_table = self.array::<FacetShare>("table of facets", bytemuck::cast_slice(facets::table()))?;
        }
        Ok(())
    }

    /// The images of the materials, in their order. Each texture is uploaded once, and the levels for each of its encodings.
    pub(super) fn textures(&mut self, geometry: &Geometry, levels: &AllLevels) -> Result<Vec<Texture>, RenderError> {
        let mut texels: HashMap<u32, In<u32>> = HashMap::new();
        let mut lower: HashMap<(u32, Encoding), In<TextureLevel>> = HashMap::new();
        let mut records = Vec::new();
        for image in geometry.materials.iter().flat_map(|material| images_of(geometry, material)).flatten() {
            let Image { uses, texture, encoding } = image;
            let own = &levels.of_image(&image).levels;
            if let Entry::Vacant(place) = texels.entry(uses.texture) {
                let packed: Vec<u32> = texture.texels.iter().map(|&texel| u32::from_le_bytes(texel)).collect();
                place.insert(self.array("texels", &packed)?);
            }
            if let Entry::Vacant(place) = lower.entry((uses.texture, encoding)) {
                place.insert(self.levels(own)?);
            }
            let axis = |axis: Vec2| axis.to_array();
            records.push(Texture {
                texels: texels[&uses.texture],
                levels: lower[&(uses.texture, encoding)],
                size: texture.size,
                wrap: uses.wrap.map(wrap),
                u_axis: axis(uses.transform.matrix2.x_axis),
                v_axis: axis(uses.transform.matrix2.y_axis),
                translation: axis(uses.transform.translation),
                level_count: own.len() as u32,
                first_code: encoding as u32 * CODES,
            });
        }
        Ok(records)
    }

    /// The levels of a texture below the image.
    fn levels(&mut self, levels: &[Level]) -> Result<In<TextureLevel>, RenderError> {
        let texels: Vec<u64> = levels.iter().flat_map(|level| &level.texels).copied().collect();
        let mut next = self.array("mip levels", &texels)?.address();
        let record = |level: &Level| {
            let texels = In::to(next);
            next += size_of_val(level.texels.as_slice()) as u64;
            TextureLevel { texels, size: level.size }
        };
        let records: Vec<TextureLevel> = levels.iter().map(record).collect();
        self.array("table of mip levels", &records)
    }
}

impl<R: Runtime> Upload<'_, R> {
    /// Where triangles are cut out, nothing if all are opaque; and the same with the masks of `halved`, which shares the rest.
    pub(super) fn alpha_mask(
        &mut self,
        alpha_mask: &accel::AlphaMask,
        halved: Option<&accel::AlphaMask>,
    ) -> Result<[AlphaMask; 2], RenderError> {
        let Some(table) = alpha_mask.table() else {
            return Ok([AlphaMask { triangles: In::NULL, masks: In::NULL }; 2]);
        };
        let mut planes = Vec::new();
        for plane in &table.planes {
            planes.push(self.array("opacities of textures", plane)?);
        }
        let own = AlphaMask {
            triangles: self.array("cut-out triangles", &table.triangles)?,
            masks: self.masks(&table.masks, &planes)?,
        };
        let halved = match halved.and_then(accel::AlphaMask::table) {
            Some(halved) => AlphaMask { masks: self.masks(&halved.masks, &planes)?, ..own },
            None => own,
        };
        Ok([own, halved])
    }

    /// How materials are cut out, by their `planes` of opacities.
    fn masks(&mut self, masks: &[accel::alpha_mask::Mask], planes: &[In<u8>]) -> Result<In<Mask>, RenderError> {
        let record = |mask: &accel::alpha_mask::Mask| Mask {
            texels: planes[mask.plane],
            size: mask.size,
            wrap: mask.wrap.map(wrap),
            u_axis: mask.transform.matrix2.x_axis.to_array(),
            v_axis: mask.transform.matrix2.y_axis.to_array(),
            translation: mask.transform.translation.to_array(),
            limit: mask.limit,
            blends: u32::from(mask.blends),
        };
        let records: Vec<Mask> = masks.iter().map(record).collect();
        self.array("masks", &records)
    }
}

fn wrap(wrap: Wrap) -> u32 {
    match wrap {
        Wrap::Repeat => Texture::REPEAT,
        Wrap::Mirror => Texture::MIRROR,
        Wrap::Clamp => Texture::CLAMP,
    }
}

/// A material without tint is uploaded as the sum that applies everywhere, so that kernels need no further lookups.
fn material_record(geometry: &Geometry, material: &lightmesh_scene::Material) -> Material {
    let (catcher, lamp) = (u32::from(material.catcher), u32::from(material.lamp));
    let shininess = material.shininess;
    let mut record = Material { shininess, catcher, lamp, ..bytemuck::Zeroable::zeroed() };
    if material.is_transmissive() {
        record.blends = 1;
        record.transmittance = vec3(material.opacity.and_then(|opacity| opacity.filter()).unwrap_or_default());
    }
    if let Some(glass) = material.boundary() {
        record.absorption = vec3(glass.absorption);
        (record.ior, record.thin) = (glass.ior, u32::from(glass.thin));
    }
    let mut own = Coefficients::untinted(material);
    if is_tinted(geometry, material) {
        record.tinted = 1;
        record.normal_scale = material.normal_texture.map_or(0.0, |map| map.scale);
        (own.ks, own.emission) = (material.ks, material.emission);
        record.ks_tinted = vec3(material.ks_tinted);
        record.emission_tinted = vec3(material.emission_tinted);
    }
    if let Some(facets) = material.faceted() {
        record.facets = 1;
        (record.roughness, record.metallic, record.grazing) = (facets.roughness, facets.metallic, facets.grazing);
    }
    (record.all, record.mirrored) = (vec3(own.all), vec3(own.mirrored));
    Material { ka: vec3(own.ka), kd: vec3(own.kd), ks: vec3(own.ks), emission: vec3(own.emission), ..record }
}
