//! The identity of what gathered light depends on: a hash of values in a form that is written down here, so that it changes with nothing else.
//!
//! Numbers are little-endian, floats their bits; a flag and a choice are a byte; a list begins with its length, and what may be absent with a
//! flag. Names are left out: they change no light. A field that is added to a type here and changes light belongs into its function, with
//! another [`FORM`]; a test fails until it is known there.

use glam::Vec3;
use lightmesh_scene::{
    Dielectric, Environment, Facets, Falloff, Instance, Light, LightKind, Material, NormalMap, Opacity, OpacityChannel,
    OpacityMode, Sun, TextureUse, Wrap,
};
use xxhash_rust::xxh3::Xxh3;

/// To be changed with the form.
const FORM: u32 = 1;

/// A hash of values, in their order.
pub struct Identity {
    hash: Xxh3,
}

impl Default for Identity {
    fn default() -> Identity {
        let mut new = Identity { hash: Xxh3::new() };
        new.number(FORM);
        new
    }
}

impl Identity {
    /// The hash of all that was added.
    pub fn digest(&self) -> u64 {
        self.hash.digest()
    }

    /// Adds bytes with their number, so that none can move from one part to the next.
    pub(super) fn bytes(&mut self, bytes: &[u8]) {
        self.hash.update(&(bytes.len() as u64).to_le_bytes());
        self.hash.update(bytes);
    }

    pub(super) fn number(&mut self, number: impl Into<u64>) {
        self.hash.update(&number.into().to_le_bytes());
    }

    fn byte(&mut self, byte: impl Into<u8>) {
        self.hash.update(&[byte.into()]);
    }

    fn float(&mut self, float: f32) {
        self.hash.update(&float.to_le_bytes());
    }

    pub(super) fn vector(&mut self, vector: Vec3) {
        vector.to_array().into_iter().for_each(|axis| self.float(axis));
    }

    fn optional<T>(&mut self, value: &Option<T>, add: impl FnOnce(&mut Identity, &T)) {
        self.byte(value.is_some());
        if let Some(value) = value {
            add(self, value);
        }
    }

    pub(super) fn list<'v, T: 'v>(&mut self, values: &'v [T], add: impl Fn(&mut Identity, &'v T)) {
        self.number(values.len() as u64);
        values.iter().for_each(|value| add(self, value));
    }

    /// Adds a light. Which motion moves it makes no difference.
    pub fn light(&mut self, light: &Light) {
        let Light { kind, intensity, falloff, surface, lamp, visible, .. } = light;
        self.kind(kind);
        self.vector(*intensity);
        self.byte(match falloff {
            Falloff::None => 0,
            Falloff::InverseSquare => 1,
        });
        self.optional(surface, |all, normal| all.vector(*normal));
        self.byte(*lamp);
        self.byte(*visible);
    }

    fn kind(&mut self, kind: &LightKind) {
        let (choice, vectors, floats): (u8, &[Vec3], &[f32]) = match kind {
            LightKind::Point { position, spread } => (0, &[*position], &[*spread]),
            LightKind::Directional { direction, angle } => (1, &[*direction], &[*angle]),
            LightKind::Spot { position, direction, inner, outer, radius } => {
                (2, &[*position, *direction], &[*inner, *outer, *radius])
            }
            LightKind::Sphere { position, radius } => (3, &[*position], &[*radius]),
            LightKind::Disk { position, normal, radius } => (4, &[*position, *normal], &[*radius]),
            LightKind::Rectangle { position, half_u, half_v } => (5, &[*position, *half_u, *half_v], &[]),
        };
        self.byte(choice);
        vectors.iter().for_each(|vector| self.vector(*vector));
        floats.iter().for_each(|float| self.float(*float));
    }

    /// Adds a material.
    pub fn material(&mut self, material: &Material) {
        let Material { ka, kd, ks, ks_tinted, emission, emission_tinted, .. } = material;
        [ka, kd, ks, ks_tinted, emission, emission_tinted].into_iter().for_each(|color| self.vector(*color));
        self.float(material.shininess);
        self.optional(&material.facets, |all, Facets { roughness, metallic, grazing, .. }| {
            [roughness, metallic, grazing].into_iter().for_each(|float| all.float(*float));
        });
        let Material { texture, emission_texture, metallic_roughness_texture, .. } = material;
        for uses in [texture, emission_texture, metallic_roughness_texture] {
            self.optional(uses, Identity::texture_use);
        }
        self.optional(&material.normal_texture, |all, NormalMap { uses, scale }| {
            all.texture_use(uses);
            all.float(*scale);
        });
        [material.catcher, material.lamp, material.one_sided].into_iter().for_each(|flag| self.byte(flag));
        self.optional(&material.opacity, Identity::opacity);
        self.optional(&material.dielectric, |all, Dielectric { ior, thin, absorption, .. }| {
            all.float(*ior);
            all.byte(*thin);
            all.vector(*absorption);
        });
    }

    fn texture_use(&mut self, uses: &TextureUse) {
        let TextureUse { texture, wrap, transform } = uses;
        self.number(*texture);
        for wrap in wrap {
            self.byte(match wrap {
                Wrap::Repeat => 0,
                Wrap::Mirror => 1,
                Wrap::Clamp => 2,
            });
        }
        transform.to_cols_array().into_iter().for_each(|float| self.float(float));
    }

    fn opacity(&mut self, opacity: &Opacity) {
        let Opacity { texture, channel, factor, mode, .. } = opacity;
        self.optional(texture, Identity::texture_use);
        self.byte(match channel {
            OpacityChannel::Alpha => 0,
            OpacityChannel::Red => 1,
            OpacityChannel::Green => 2,
            OpacityChannel::Blue => 3,
            OpacityChannel::Luminance => 4,
        });
        self.float(*factor);
        match mode {
            OpacityMode::Mask { cutoff } => {
                self.byte(0);
                self.float(*cutoff);
            }
            OpacityMode::Blend { filter } => {
                self.byte(1);
                self.vector(*filter);
            }
        }
    }

    /// Adds a shape at one of its places; its box follows from these.
    pub(super) fn instance(&mut self, instance: &Instance) {
        let Instance { triangles, first, place, back, object: _, bounds: _ } = instance;
        [triangles.start, triangles.end, *first].into_iter().for_each(|index| self.number(index));
        [place, back].into_iter().for_each(|map| map.rows.as_flattened().iter().for_each(|float| self.float(*float)));
    }

    /// Adds surroundings.
    pub fn environment(&mut self, environment: &Environment) {
        environment.size().into_iter().for_each(|side| self.number(side));
        environment.frame().into_iter().for_each(|axis| self.vector(axis));
        let sun = |all: &mut Identity, Sun { direction, radius, radiance }: &Sun| {
            [direction, radiance].into_iter().for_each(|vector| all.vector(*vector));
            all.float(*radius);
        };
        self.optional(&environment.sun().copied(), sun);
        self.list(environment.discs(), sun);
        self.bytes(bytemuck::cast_slice(environment.texels().as_flattened()));
    }
}
