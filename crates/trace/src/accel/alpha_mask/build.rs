//! From materials that are cut out to the opacities of their triangles.
//!
//! A triangle that is opaque everywhere gets no number, and a texture whose opacity is nowhere below the cutoff makes no mask: such
//! materials cost nothing. That is decided by the least opacity of texels and corners, which no interpolation falls below.

use std::collections::HashMap;
use std::sync::Arc;

use glam::Vec3;
use lightmesh_layout::constants::OPAQUE;
use lightmesh_layout::geometry::CutTriangle;
use lightmesh_memory::{Budget, OverBudget};
use lightmesh_scene::{Geometry, Opacity, OpacityChannel, OpacityMode, Texture, TextureUse, Wrap};

use super::{AlphaMask, Mask, Table};
use crate::textures::usable;

/// Bytes that a triangle takes if any is cut out: its entry and its number.
pub const BYTES_TO_BUILD: u64 = (size_of::<CutTriangle>() + size_of::<u32>()) as u64;

impl AlphaMask {
    /// The opacities of a geometry, whose indices must be in range, and the number of each triangle: 0 for those that are opaque
    /// everywhere; no numbers at all if all are.
    ///
    /// # Errors
    /// The number of the texture whose opacities do not fit into the budget.
    pub fn of(geometry: &Geometry, budget: Budget) -> Result<(AlphaMask, Vec<u32>), (usize, OverBudget)> {
        let mut masks = Masks { geometry, budget, known: HashMap::new(), least: Vec::new(), table: Table::default() };
        let mut of_materials = Vec::new();
        for material in &geometry.materials {
            of_materials.push(match &material.opacity {
                Some(opacity) => masks.mask(opacity, material.boundary().is_some())?.map(|mask| (mask, opacity.factor)),
                None => None,
            });
        }
        let Masks { least, mut table, .. } = masks;
        if of_materials.iter().all(Option::is_none) {
            return Ok((AlphaMask::default(), Vec::new()));
        }
        let mesh = &geometry.mesh;
        let masked = mesh.materials.iter().filter(|material| of_materials[**material as usize].is_some());
        let mut triangles = Vec::with_capacity(masked.count());
        let number = |(vertices, &material): (&[u32; 3], &u32)| {
            let Some((index, factor)) = of_materials[material as usize] else { return 0 };
            let mask = &table.masks[index];
            let of_vertex = |vertex: u32| mesh.opacities.get(vertex as usize).copied().unwrap_or(1.0);
            let opacities = vertices.map(|vertex| factor * of_vertex(vertex));
            // Where corners differ, interpolation may round to less than the least of them.
            let same = opacities[0] == opacities[1] && opacities[1] == opacities[2];
            if same && opacities[0] * least[mask.plane] >= mask.enough() {
                return 0;
            }
            let uv = |vertex: u32| mesh.uvs.get(vertex as usize).copied().unwrap_or_default().to_array();
            triangles.push(CutTriangle { uvs: vertices.map(uv), opacities, mask: index as u32 });
            triangles.len() as u32
        };
        let numbers: Vec<u32> = mesh.triangles.iter().zip(&mesh.materials).map(number).collect();
        if triangles.is_empty() {
            return Ok((AlphaMask::default(), Vec::new()));
        }
        table.triangles = triangles.into();
        Ok((AlphaMask { table: Some(Arc::new(table)) }, numbers))
    }
}

/// The masks of a geometry in the making.
struct Masks<'a> {
    geometry: &'a Geometry,
    budget: Budget,
    /// The plane of a texture's channel, and of what has no texture.
    known: HashMap<Option<(u32, OpacityChannel)>, usize>,
    /// The least opacity of each plane.
    least: Vec<f32>,
    table: Table,
}

impl Masks<'_> {
    /// The index of the mask; `None` if nothing is cut out or let through. `reflects`: whether it is seen without any opacity.
    fn mask(&mut self, opacity: &Opacity, reflects: bool) -> Result<Option<usize>, (usize, OverBudget)> {
        let found = opacity.texture.and_then(|uses| usable(self.geometry, uses));
        // What neither shows nor filters anything is no surface.
        let (cutoff, blends) = match opacity.mode {
            OpacityMode::Mask { cutoff } => (cutoff, false),
            OpacityMode::Blend { filter } if filter == Vec3::ONE && !reflects => (Opacity::LEAST, true),
            OpacityMode::Blend { .. } => (0.0, true),
        };
        let plane = match found {
            Some((uses, texture)) => self.plane(uses.texture, texture, opacity.channel)?,
            None => self.opaque_plane(),
        };
        let uses = found.map_or(TextureUse { wrap: [Wrap::Clamp; 2], ..TextureUse::new(0) }, |(uses, _)| uses);
        let size = found.map_or([1; 2], |(_, texture)| texture.size);
        let limit = OPAQUE * cutoff;
        let mask = Mask { plane, size, wrap: uses.wrap, transform: uses.transform, limit, blends };
        let opaque = opacity.factor * self.least[plane] >= mask.enough();
        // A cutoff that is no number cuts nothing out: the library's users may build such a material.
        if mask.enough().is_nan() || mask.enough() <= 0.0 || (opaque && self.geometry.mesh.opacities.is_empty()) {
            return Ok(None);
        }
        self.table.masks.push(mask);
        Ok(Some(self.table.masks.len() - 1))
    }

    fn plane(&mut self, index: u32, texture: &Texture, channel: OpacityChannel) -> Result<usize, (usize, OverBudget)> {
        if let Some(&known) = self.known.get(&Some((index, channel))) {
            return Ok(known);
        }
        self.budget.check(texture.texels.len() as u64).map_err(|short| (index as usize, short))?;
        let plane = texture.texels.iter().map(|&texel| OpacityChannel::of(texel, channel)).collect();
        Ok(self.add(Some((index, channel)), plane))
    }

    fn opaque_plane(&mut self) -> usize {
        match self.known.get(&None) {
            Some(&known) => known,
            None => self.add(None, vec![u8::MAX]),
        }
    }

    fn add(&mut self, key: Option<(u32, OpacityChannel)>, plane: Vec<u8>) -> usize {
        self.least.push(f32::from(plane.iter().copied().min().unwrap_or(u8::MAX)));
        self.table.planes.push(plane.into());
        self.known.insert(key, self.least.len() - 1);
        self.least.len() - 1
    }
}
