//! The content of a mesh file. It has a section for each geometry that light points were tested against. That is one, or, if light goes through
//! surfaces, one for each part that the scene is taken into.
//!
//! | bytes | what |
//! |---|---|
//! | 4 | number of sections |
//! | | for each of them: |
//! | 8 | hash of the geometry |
//! | 4 × 3, 4, 4 × 3 | anchor, step and number of the lattice |
//! | 4 | number of lights |
//! | 8 | number of bricks |
//! | 1 to 9 each | the bricks' keys, each as the difference from the one before, 7 bits in a byte |
//! | | for each light: |
//! | 1, 4 each | its kind, and the numbers that describe it |
//! | 4, 8 | if it has a size: samples and seed; 0 samples otherwise |
//! | 1 | 1 if those light points have a known value that have one of the light before; 0 otherwise |
//! | 8 each | without that: the light points whose value is known, by brick |
//! | 8 each | without a size: those that see the light, by brick |
//! | 1 or 2 each | with a size: the rays that reached the light, of each known light point; one byte up to 255 samples |
//! | 1 | 1 if there is [gathered light](super::irradiance_cache), which follows; 0 otherwise |

use std::io::{self, BufReader, Read, Write};

use glam::UVec3;
use lightmesh_layout::constants::AXIS_BITS;
use lightmesh_memory::Budget;
use lightmesh_scene::LightKind;

use super::super::stored::{Stored, StoredAnswers, StoredColumn};
use super::super::{ColumnKey, Content, Places, Section};
use super::fault::MeshFault;
use super::input::Input;
use super::output::write_difference;
use super::{irradiance_cache, pack};

/// Bits of a brick's key.
const KEY_BITS: u32 = 3 * AXIS_BITS;
/// Numbers that are written at once.
const AT_ONCE: usize = 1 << 16;
/// More lights than this are no scene's.
const MAX_LIGHTS: u32 = 1 << 20;
/// Samples up to this have shares of one byte.
const SMALL: u32 = 255;

pub(super) fn write(output: &mut impl Write, Content { points, gathered }: &Content) -> io::Result<()> {
    write_points(output, points)?;
    output.write_all(&[gathered.len() as u8])?;
    gathered.iter().try_for_each(|saved| irradiance_cache::write(output, saved))
}

fn write_points(output: &mut impl Write, sections: &[Section]) -> io::Result<()> {
    output.write_all(&(sections.len() as u32).to_le_bytes())?;
    for Section { geometry, places: Places { anchor, step, number }, stored } in sections {
        output.write_all(&geometry.to_le_bytes())?;
        floats(output, &[anchor.x, anchor.y, anchor.z, *step])?;
        for number in number.to_array() {
            output.write_all(&number.to_le_bytes())?;
        }
        output.write_all(&(stored.columns.len() as u32).to_le_bytes())?;
        output.write_all(&(stored.bricks.len() as u64).to_le_bytes())?;
        let mut before = 0;
        for &brick in &stored.bricks {
            write_difference(output, brick - before)?;
            before = brick;
        }
        let before = std::iter::once(None).chain(stored.columns.iter().map(Some));
        before.zip(&stored.columns).try_for_each(|(before, column)| write_column(output, before, column))?;
    }
    Ok(())
}

fn write_column(output: &mut impl Write, before: Option<&StoredColumn>, column: &StoredColumn) -> io::Result<()> {
    write_seen(output, &column.seen)?;
    // Most often, all lights were asked at the same places: too far back for the compression to notice.
    let same = before.is_some_and(|before| before.known == column.known);
    output.write_all(&[same.into()])?;
    if !same {
        longs(output, &column.known)?;
    }
    match &column.answers {
        StoredAnswers::Bits(words) => longs(output, words),
        StoredAnswers::Shares(shares) if column.seen.samples() <= SMALL => {
            shares.chunks(AT_ONCE).try_for_each(|shares| {
                let bytes: Vec<u8> = shares.iter().map(|&share| share as u8).collect();
                output.write_all(&bytes)
            })
        }
        StoredAnswers::Shares(shares) => shares.chunks(AT_ONCE).try_for_each(|shares| {
            let bytes: Vec<u8> = shares.iter().flat_map(|share| share.to_le_bytes()).collect();
            output.write_all(&bytes)
        }),
    }
}

fn write_seen(output: &mut impl Write, ColumnKey { kind, glows, sampling }: &ColumnKey) -> io::Result<()> {
    let (name, numbers): (u8, Vec<f32>) = match *kind {
        LightKind::Point { position, spread } => (0, [&position.to_array()[..], &[spread]].concat()),
        LightKind::Directional { direction, angle } => (1, [&direction.to_array()[..], &[angle]].concat()),
        LightKind::Spot { position, direction, inner, outer, radius } => {
            let point = [&position.to_array()[..], &direction.to_array(), &[inner, outer]].concat();
            // Without a radius as before there were any.
            if radius > 0.0 { (6, [&point[..], &[radius]].concat()) } else { (2, point) }
        }
        LightKind::Sphere { position, radius } => {
            (if *glows { 7 } else { 3 }, [&position.to_array()[..], &[radius]].concat())
        }
        LightKind::Disk { position, normal, radius } => {
            (4, [&position.to_array()[..], &normal.to_array(), &[radius]].concat())
        }
        LightKind::Rectangle { position, half_u, half_v } => {
            (5, [position.to_array(), half_u.to_array(), half_v.to_array()].concat())
        }
    };
    output.write_all(&[name])?;
    floats(output, &numbers)?;
    let (samples, seed) = sampling.unwrap_or_default();
    output.write_all(&samples.to_le_bytes())?;
    output.write_all(&seed.to_le_bytes())
}

fn floats(output: &mut impl Write, numbers: &[f32]) -> io::Result<()> {
    numbers.iter().try_for_each(|number| output.write_all(&number.to_le_bytes()))
}

fn longs(output: &mut impl Write, numbers: &[u64]) -> io::Result<()> {
    numbers.chunks(AT_ONCE).try_for_each(|numbers| {
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        output.write_all(&bytes)
    })
}

/// Decodes the sections, each of which belongs to one of the `geometries`, from `packed`, whose content has `length` bytes. Gathered light belongs
/// to the first of these.
pub(super) fn read(packed: &[u8], length: u64, budget: Budget, geometries: &[u64]) -> Result<Content, MeshFault> {
    let packed = pack::decoder(packed).map_err(|reason| MeshFault::Read(reason.into()))?;
    let mut input = Input { inner: BufReader::with_capacity(AT_ONCE, packed.take(length)), budget, unchecked: 0 };
    let count = input.int()?;
    if count as usize > geometries.len() {
        return Err(MeshFault::Damaged("it has more geometry than its scene"));
    }
    let mut content = Content::default();
    for _ in 0..count {
        let section = input.section()?;
        if !geometries.contains(&section.geometry) {
            return Err(MeshFault::Damaged("it has geometry that is not its scene's"));
        }
        content.points.push(section);
    }
    match (input.bytes()?, geometries) {
        ([0], _) => {}
        ([1], [geometry, ..]) => content.gathered.push(input.gathered(*geometry)?),
        _ => return Err(MeshFault::Damaged("it has gathered light more than once")),
    }
    // Nothing may follow, neither in the content nor beyond its length.
    let is_read = input.inner.buffer().is_empty() && input.inner.get_ref().limit() == 0;
    let packed = input.inner.get_mut();
    packed.set_limit(1);
    match packed.read(&mut [0]) {
        Ok(0) if is_read && pack::rest(packed.get_ref()) == 0 => Ok(content),
        _ => Err(MeshFault::Damaged("it holds more than it says")),
    }
}

impl<R: Read> Input<R> {
    fn section(&mut self) -> Result<Section, MeshFault> {
        let geometry = self.long()?;
        let (anchor, step) = (self.vector()?, self.float()?);
        let number = UVec3::new(self.int()?, self.int()?, self.int()?);
        let (lights, bricks) = (self.int()?, self.long()?);
        if lights > MAX_LIGHTS {
            return Err(MeshFault::Damaged("it has more lights than a scene"));
        }
        let bricks = self.bricks(bricks)?;
        let mut columns = Vec::new();
        for _ in 0..lights {
            columns.push(self.column(bricks.len(), columns.last())?);
        }
        let stored = Stored { ages: vec![0; bricks.len()], bricks, columns };
        Ok(Section { geometry, places: Places { anchor, step, number }, stored })
    }

    /// Keys that ascend.
    fn bricks(&mut self, count: u64) -> Result<Vec<u64>, MeshFault> {
        let mut bricks: Vec<u64> = Vec::new();
        for _ in 0..count {
            let difference = self.difference()?;
            let key = match bricks.last() {
                Some(_) if difference == 0 => None,
                before => before.copied().unwrap_or(0).checked_add(difference).filter(|key| key >> KEY_BITS == 0),
            };
            let key = key.ok_or(MeshFault::Damaged("its bricks are not in order"))?;
            self.hold(&bricks, 1)?;
            bricks.push(key);
        }
        Ok(bricks)
    }

    fn column(&mut self, bricks: usize, before: Option<&StoredColumn>) -> Result<StoredColumn, MeshFault> {
        let seen = self.seen()?;
        let known = match (self.bytes()?, before) {
            ([0], _) => self.numbers(bricks as u64, u64::from_le_bytes)?,
            ([1], Some(before)) => {
                self.hold(&Vec::<u64>::new(), bricks)?;
                before.known.clone()
            }
            _ => return Err(MeshFault::Damaged("a light has the values of no light")),
        };
        let answers = if seen.is_share() {
            let count = known.iter().map(|known| u64::from(known.count_ones())).sum();
            let samples = seen.samples();
            let shares = match samples {
                0..=SMALL => self.numbers(count, |[share]| u16::from(share))?,
                _ => self.numbers(count, u16::from_le_bytes)?,
            };
            if shares.iter().any(|&share| u32::from(share) > samples) {
                return Err(MeshFault::Damaged("more rays reach a light than there are"));
            }
            StoredAnswers::Shares(shares)
        } else {
            let words = self.numbers(bricks as u64, u64::from_le_bytes)?;
            if words.iter().zip(&known).any(|(word, known)| word & !known != 0) {
                return Err(MeshFault::Damaged("it has values that are not known"));
            }
            StoredAnswers::Bits(words)
        };
        Ok(StoredColumn { seen, known, answers })
    }

    fn seen(&mut self) -> Result<ColumnKey, MeshFault> {
        let [name] = self.bytes()?;
        let kind = match name {
            0 => LightKind::Point { position: self.vector()?, spread: self.float()? },
            1 => LightKind::Directional { direction: self.vector()?, angle: self.float()? },
            2 | 6 => LightKind::Spot {
                position: self.vector()?,
                direction: self.vector()?,
                inner: self.float()?,
                outer: self.float()?,
                radius: if name == 6 { self.float()? } else { 0.0 },
            },
            3 | 7 => LightKind::Sphere { position: self.vector()?, radius: self.float()? },
            4 => LightKind::Disk { position: self.vector()?, normal: self.vector()?, radius: self.float()? },
            5 => LightKind::Rectangle { position: self.vector()?, half_u: self.vector()?, half_v: self.vector()? },
            _ => return Err(MeshFault::Damaged("it has a light of no kind")),
        };
        let (samples, seed) = (self.int()?, self.long()?);
        if samples > u32::from(u16::MAX) {
            return Err(MeshFault::Damaged("a light has too many samples"));
        }
        Ok(ColumnKey { kind, glows: name == 7, sampling: (samples > 0).then_some((samples, seed)) })
    }
}
