//! Bright regions of a panorama, which are lights: windows, soft boxes, lamps.
//!
//! Rays that gather light find small bright regions by chance, so that their shadows would be as soft as noise allows. Like the sun of an image they
//! become lights, distant discs with exact shadows, and what is gathered is the image without them. The camera and mirrors see the image as it is.
//!
//! 1. Texels that are much brighter than the mean are bright. Those that touch each other are a region.
//! 2. A region counts by what it gives beyond the mean of its surroundings, if that is enough, and it is much brighter than they are.
//! 3. The piece whose light times squared extent is the largest is halved across its longer axis until there are enough, or all are small.
//! 4. A piece is a disc of the same solid angle with the same light, which is taken out of the image.

use std::f32::consts::{PI, TAU};

use glam::{Vec2, Vec3};

use super::directions::direction;
use super::levels;
use super::panorama::{Bright, Environment};
use super::sun::Sun;
use crate::Up;
use crate::model::colors::luminance;

/// Regions are found in a mean of the image with no more columns than this.
const MAX_COLUMNS: u32 = 512;
/// What is bright, in means over all directions.
const CONTRAST: f32 = 4.0;
/// How much brighter than around it a region is.
const EDGE: f32 = 2.0;
/// A region gives at least this share of all light.
const MIN_SHARE: f32 = 0.01;
/// Number of lights at most.
const MAX_LIGHTS: usize = 8;
/// The radius of a disc that is not halved, radians.
const SMALL: f32 = 0.05;
/// How far the surroundings of a region reach, texels.
const AROUND: i32 = 2;

/// The image in which regions are found.
struct Image {
    frame: [Vec3; 3],
    size: [u32; 2],
    texels: Vec<[f32; 3]>,
}

/// A texel of a region.
#[derive(Clone, Copy)]
struct Texel {
    index: usize,
    direction: Vec3,
    solid: f32,
    /// What it gives beyond the surroundings.
    light: Vec3,
}

/// A part of a region.
struct Piece {
    texels: Vec<Texel>,
    solid: f32,
    light: Vec3,
    /// Its middle, by light.
    middle: Vec3,
    /// The mean of squared distances from the middle.
    extent: f32,
    /// The longer axis.
    axis: Vec3,
}

impl Environment {
    /// Makes lights of bright regions, if there are any. The image stays as it is, but what [gathers](Environment::gathered) light sees it without
    /// them.
    pub fn find_lights(self) -> Environment {
        let image = Image::of(&self);
        let mut pieces: Vec<Piece> = image.regions().into_iter().map(Piece::of).collect();
        pieces.sort_by(|a, b| b.strength().total_cmp(&a.strength()));
        pieces.truncate(MAX_LIGHTS);
        if pieces.is_empty() {
            return self;
        }
        // What is left of the image.
        let mut texels = image.texels;
        for texel in pieces.iter().flat_map(|piece| &piece.texels) {
            let rest = Vec3::from_array(texels[texel.index]) - texel.light / texel.solid;
            texels[texel.index] = rest.max(Vec3::ZERO).to_array();
        }
        let rest = Environment { frame: self.frame, ..Environment::new("", image.size, texels, Up::Y) };
        let discs = halved(pieces).iter().map(Piece::disc).collect();
        Environment { bright: Some(Bright { discs, rest }.into()), ..self }
    }
}

impl Image {
    fn of(environment: &Environment) -> Image {
        let coarse = environment.levels().iter().find(|level| level.size[0] <= MAX_COLUMNS);
        let (size, texels) = match coarse.filter(|_| environment.size[0] > MAX_COLUMNS) {
            Some(level) => (level.size, level.texels.clone()),
            None => (environment.size, environment.levels.image.clone()),
        };
        Image { frame: environment.frame, size, texels }
    }

    fn solid(&self, index: usize) -> f32 {
        levels::band(index as u32 / self.size[0], self.size[1]) * TAU / self.size[0] as f32
    }

    fn radiance(&self, index: usize) -> Vec3 {
        Vec3::from_array(self.texels[index])
    }

    /// The texels that are not farther than `reach` from one, without it.
    fn around(&self, index: usize, reach: i32) -> impl Iterator<Item = usize> {
        let [width, height] = self.size.map(|side| side as i32);
        let (column, row) = (index as i32 % width, index as i32 / width);
        let rows = (row - reach).max(0)..(row + reach + 1).min(height);
        let columns = move |row| (-reach..=reach).map(move |by| row * width + (column + by).rem_euclid(width));
        rows.flat_map(columns).map(|other| other as usize).filter(move |&other| other != index)
    }

    /// 1. and 2.
    fn regions(&self) -> Vec<Vec<Texel>> {
        let lights = || (0..self.texels.len()).map(|index| self.solid(index) * luminance(self.radiance(index)));
        let all: f32 = lights().sum();
        let threshold = CONTRAST * all / (4.0 * PI);
        let is_bright = |index: usize| luminance(self.radiance(index)) > threshold;
        let mut known = vec![false; self.texels.len()];
        let mut regions = Vec::new();
        for start in 0..self.texels.len() {
            if known[start] || !is_bright(start) {
                continue;
            }
            known[start] = true;
            let (mut members, mut next) = (vec![start], 0);
            while next < members.len() {
                for other in self.around(members[next], 1) {
                    if !known[other] && is_bright(other) {
                        known[other] = true;
                        members.push(other);
                    }
                }
                next += 1;
            }
            regions.extend(self.region(members, &is_bright, MIN_SHARE * all));
        }
        regions
    }

    /// What the texels of a region give beyond the surroundings; `None` if it is not enough.
    fn region(&self, members: Vec<usize>, is_bright: &impl Fn(usize) -> bool, least: f32) -> Option<Vec<Texel>> {
        let (mut ring, mut weight) = (Vec3::ZERO, 0.0);
        for other in members.iter().flat_map(|&index| self.around(index, AROUND)).filter(|&other| !is_bright(other)) {
            ring += self.solid(other) * self.radiance(other);
            weight += self.solid(other);
        }
        let around = if weight > 0.0 { ring / weight } else { return None };
        let texel = |index: usize| {
            let (solid, radiance) = (self.solid(index), self.radiance(index));
            let direction =
                direction(self.frame, self.size, [index as u32 % self.size[0], index as u32 / self.size[0]]);
            Texel { index, direction, solid, light: solid * (radiance - around).max(Vec3::ZERO) }
        };
        let texels: Vec<Texel> = members.into_iter().map(texel).collect();
        let light: f32 = texels.iter().map(|texel| luminance(texel.light)).sum();
        let solid: f32 = texels.iter().map(|texel| texel.solid).sum();
        let stands_out = light >= (EDGE - 1.0) * luminance(around) * solid;
        (light >= least && stands_out).then_some(texels)
    }
}

/// 3. Pieces that are halved until there are enough.
fn halved(mut pieces: Vec<Piece>) -> Vec<Piece> {
    while pieces.len() < MAX_LIGHTS {
        let largest = (0..pieces.len()).max_by(|&a, &b| pieces[a].measure().total_cmp(&pieces[b].measure()));
        let Some(largest) = largest.filter(|&largest| pieces[largest].measure() > 0.0) else { break };
        let piece = pieces.swap_remove(largest);
        let (near, far): (Vec<Texel>, Vec<Texel>) =
            piece.texels.into_iter().partition(|texel| (texel.direction - piece.middle).dot(piece.axis) < 0.0);
        pieces.extend([near, far].into_iter().filter(|part| !part.is_empty()).map(Piece::of));
    }
    pieces
}

impl Piece {
    fn of(texels: Vec<Texel>) -> Piece {
        let mut piece = Piece { texels, solid: 0.0, light: Vec3::ZERO, middle: Vec3::ZERO, extent: 0.0, axis: Vec3::X };
        for texel in &piece.texels {
            piece.solid += texel.solid;
            piece.light += texel.light;
            piece.middle += luminance(texel.light) * texel.direction;
        }
        piece.middle = piece.middle.normalize_or(piece.texels[0].direction);
        let (right, up) = piece.middle.any_orthonormal_pair();
        let (mut squares, mut product, mut total) = (Vec2::ZERO, 0.0, 0.0);
        for texel in &piece.texels {
            let (place, weight) =
                (Vec2::new(right.dot(texel.direction), up.dot(texel.direction)), luminance(texel.light));
            squares += weight * place * place;
            product += weight * place.x * place.y;
            total += weight;
        }
        if total > 0.0 {
            piece.extent = (squares.x + squares.y) / total;
            // The axis along which the mean square is the largest.
            let (sin, cos) = (0.5 * (2.0 * product).atan2(squares.x - squares.y)).sin_cos();
            piece.axis = cos * right + sin * up;
        }
        piece
    }

    fn strength(&self) -> f32 {
        luminance(self.light)
    }

    /// What halving it is worth; 0 if it is small.
    fn measure(&self) -> f32 {
        // The mean square of a disc is half that of its radius.
        let is_small = self.texels.len() < 2 || self.extent < 0.5 * SMALL * SMALL;
        if is_small { 0.0 } else { self.strength() * self.extent }
    }

    /// 4.
    fn disc(&self) -> Sun {
        Sun { direction: self.middle, radius: (self.solid / PI).sqrt(), radiance: self.light / self.solid }
    }
}
