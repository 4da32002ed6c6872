//! Cryptomatte (Friedman and Jones 2015; Psyop's specification, version 1.2.0): which named things a pixel sees, and how much of it they cover.
//!
//! A name is identified by its MurmurHash3 (Appleby, `MurmurHash3_x86_32` with seed 0), stored as the bits of a float. If these would be a
//! denormal number, infinite or none, the lowest bit of the exponent is flipped. A layer has channels of pairs: identifier and share, by
//! descending share, two pairs in `NAME00.R` to `NAME00.A`, two in `NAME01`, and so on. Attributes say what the identifiers stand for.

use std::collections::HashMap;
use std::fmt;

use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};

use crate::matte::{MAX_RANKS, Matte, Rank};

/// What a layer is called in files.
#[derive(Clone, Copy)]
pub struct Naming {
    /// The layer.
    pub layer: &'static str,
    /// The channel of what the nearest sample sees.
    pub nearest: &'static str,
}

/// That of objects.
pub const OBJECTS: Naming = Naming { layer: "CryptoObject", nearest: "id.object" };
/// That of materials.
pub const MATERIALS: Naming = Naming { layer: "CryptoMaterial", nearest: "id.material" };

impl Naming {
    /// The channels of a rank: its identifier, and its share.
    pub fn channels(self, rank: usize) -> [String; 2] {
        let channels = if rank.is_multiple_of(2) { ["R", "G"] } else { ["B", "A"] };
        channels.map(|channel| format!("{}{:02}.{channel}", self.layer, rank / 2))
    }

    /// The names and texts of the attributes that describe a matte.
    pub(super) fn attributes(self, matte: &Matte) -> [(String, String); 4] {
        [
            ("name", self.layer.to_owned()),
            ("hash", "MurmurHash3_32".to_owned()),
            ("conversion", "uint32_to_float32".to_owned()),
            ("manifest", manifest(&matte.names)),
        ]
        .map(|(name, text)| (self.attribute(name), text))
    }

    /// The name of an attribute.
    pub fn attribute(self, name: &str) -> String {
        let key = format!("{:08x}", murmur3(self.layer.as_bytes()));
        format!("cryptomatte/{}/{name}", &key[..7])
    }

    /// The matte of a file by its channels and texts; an empty one if something is missing or not as written here.
    pub(super) fn read(
        self,
        numbers: impl Fn(&str) -> Option<Vec<u32>>,
        values: impl Fn(&str) -> Option<Vec<f32>>,
        text: impl Fn(&str) -> Option<String>,
    ) -> Matte {
        let read = || {
            let names = serde_json::from_str::<Manifest>(&text(&self.attribute("manifest"))?).ok()?.0;
            let mut by_bits: HashMap<u32, u32> = [(0, 0)].into();
            for (number, name) in (1..).zip(&names) {
                by_bits.entry(identifier(name)).or_insert(number);
            }
            let nearest = numbers(self.nearest)?;
            let mut ranks = Vec::new();
            for channels in (0..MAX_RANKS).map(|rank| self.channels(rank)) {
                let [identifiers, share] = [values(&channels[0])?, values(&channels[1])?];
                let number: Option<Vec<u32>> =
                    identifiers.iter().map(|value| by_bits.get(&value.to_bits()).copied()).collect();
                ranks.push(Rank { number: number?, share });
            }
            Some(Matte { names, nearest, ranks })
        };
        read().unwrap_or_default()
    }
}

impl Matte {
    /// The pictures of a Cryptomatte, two ranks in each: per pixel the identifier and the share of one thing, and those of the next.
    pub fn cryptomatte(&self) -> Vec<Vec<[f32; 4]>> {
        let identifiers = identifiers(&self.names);
        let pair = |rank: Option<&Rank>, pixel: usize| {
            let of = |rank: &Rank| [f32::from_bits(identifiers[rank.number[pixel] as usize]), rank.share[pixel]];
            rank.map_or([0.0; 2], of)
        };
        let picture = |ranks: &[Rank]| {
            let pixel = |pixel| {
                let ([a, b], [c, d]) = (pair(ranks.first(), pixel), pair(ranks.get(1), pixel));
                [a, b, c, d]
            };
            (0..self.nearest.len()).map(pixel).collect()
        };
        self.ranks.chunks(2).map(picture).collect()
    }

    /// The names with their identifiers, as the JSON of a Cryptomatte's manifest.
    pub fn manifest(&self) -> String {
        manifest(&self.names)
    }
}

/// The identifiers of things by number, as bits of floats; that of nothing is 0.
pub(super) fn identifiers(names: &[String]) -> Vec<u32> {
    [0].into_iter().chain(names.iter().map(|name| identifier(name))).collect()
}

/// The bits of the float that identifies a name.
pub fn identifier(name: &str) -> u32 {
    let hash = murmur3(name.as_bytes());
    let exponent = hash >> 23 & 0xff;
    if exponent == 0 || exponent == 0xff { hash ^ 1 << 23 } else { hash }
}

/// MurmurHash3 with 32 bits and a seed of 0.
pub fn murmur3(bytes: &[u8]) -> u32 {
    let mixed = |word: u32| word.wrapping_mul(0xcc9e_2d51).rotate_left(15).wrapping_mul(0x1b87_3593);
    let (words, rest) = bytes.as_chunks::<4>();
    let mut hash = 0_u32;
    for &word in words {
        hash = (hash ^ mixed(u32::from_le_bytes(word))).rotate_left(13).wrapping_mul(5).wrapping_add(0xe654_6b64);
    }
    hash ^= mixed(rest.iter().rev().fold(0, |word, &byte| word << 8 | u32::from(byte)));
    hash ^= bytes.len() as u32;
    hash = (hash ^ hash >> 16).wrapping_mul(0x85eb_ca6b);
    hash = (hash ^ hash >> 13).wrapping_mul(0xc2b2_ae35);
    hash ^ hash >> 16
}

/// Names with their identifiers in hexadecimal digits, as a JSON object in the order of the numbers.
pub fn manifest(names: &[String]) -> String {
    let entry = |name: &String| format!("{}:\"{:08x}\"", serde_json::Value::from(name.as_str()), identifier(name));
    format!("{{{}}}", names.iter().map(entry).collect::<Vec<_>>().join(","))
}

/// The names of a manifest in their order.
pub struct Manifest(pub Vec<String>);

impl<'de> Deserialize<'de> for Manifest {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Manifest, D::Error> {
        struct Names;

        impl<'de> Visitor<'de> for Names {
            type Value = Manifest;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("names with identifiers")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Manifest, A::Error> {
                let mut names = Vec::new();
                while let Some((name, _)) = map.next_entry::<String, String>()? {
                    names.push(name);
                }
                Ok(Manifest(names))
            }
        }

        deserializer.deserialize_map(Names)
    }
}
