//! Very many lights become fewer: those that are near each other and face the same way become one.
//!
//! 1. All lights form a group; while there are too few groups, the one in which light would move farthest is halved. That is the one with
//!    the largest product of its strength and the square of its extent: of its places and its normals. It is halved in the middle of its
//!    longest side.
//! 2. A group shines from the place of that of its lights which is nearest to its middle, which is no place inside a wall, with the light of all.

use std::cmp::Ordering;

use glam::Vec3;

use crate::Light;

/// Lights that are made at most: more are merged.
pub const LIGHTS: usize = 128;

/// How far lights are from each other that face opposite ways, relative to the extent of all.
const FACING: f32 = 1.0;
/// Of what differs less, as a share, the first counts.
const ALIKE: f32 = 1e-3;
/// Places that differ less are one, relative to half of that extent.
const HAIR: f32 = 1e-5;
/// By how many of these what is computed from such places may differ.
const SLACK: f32 = 4.0;

/// Lights of a group, and how much would be wrong if they were one.
struct Group {
    members: Vec<usize>,
    /// Along which it is largest, and the middle there.
    axis: usize,
    middle: f32,
    wrong: f32,
}

/// At most [`LIGHTS`] lights with the same strength. Neither their order nor a hair between their places matters: lamps that are stored once are the
/// same as copies.
pub(super) fn merged(mut lights: Vec<Light>) -> Vec<Light> {
    if lights.len() <= LIGHTS {
        return lights;
    }
    let place = |light: &Light| light.position().unwrap_or_default();
    let (least, most) = lights.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(least, most), light| {
        (least.min(place(light)), most.max(place(light)))
    });
    let scale = 0.5 * FACING * (most - least).length();
    let (hair, slack) = (HAIR * scale, SLACK * HAIR * scale);
    // Without an extent there is nothing to be rounded.
    let rounded = |value: f32| if hair > 0.0 { (value / hair).round() * hair } else { value };
    let point = |light: &Light| -> [f32; 6] {
        let (place, facing) = (place(light), scale * light.surface.unwrap_or_default());
        [place.x, place.y, place.z, facing.x, facing.y, facing.z].map(rounded)
    };
    lights.sort_by(|a, b| point(a).partial_cmp(&point(b)).unwrap_or(Ordering::Equal));
    let points: Vec<[f32; 6]> = lights.iter().map(point).collect();
    let group = |members: Vec<usize>| -> Group {
        let ends: [[f32; 2]; 6] = std::array::from_fn(|axis| {
            let values = members.iter().map(|&member| points[member][axis]);
            values.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
        });
        let sides = ends.map(|[low, high]| high - low);
        let longest = sides.iter().copied().fold(0.0, f32::max);
        let axis = (0..6).find(|&axis| sides[axis] >= longest - slack).unwrap_or(0);
        let strength: f32 = members.iter().map(|&member| power(&lights[member]).element_sum()).sum();
        let is_one = members.len() < 2;
        // The maximum turns what is undefined, such as an infinite strength in one place, into zero.
        let wrong = if is_one { -1.0 } else { (strength * sides.iter().map(|side| side * side).sum::<f32>()).max(0.0) };
        Group { members, axis, middle: 0.5 * (ends[axis][0] + ends[axis][1]), wrong }
    };
    let mut groups = vec![group((0..lights.len()).collect())];
    while groups.len() < LIGHTS {
        // As there are more lights than groups, one has several.
        let most = groups.iter().fold(0.0, |most: f32, group| most.max(group.wrong));
        let is_worst = |group: &Group| group.wrong >= (1.0 - ALIKE) * most;
        let worst = groups.iter().position(is_worst).expect("one is the worst");
        let Group { mut members, axis, middle, .. } = groups.swap_remove(worst);
        let (mut low, mut high): (Vec<usize>, Vec<usize>) =
            members.iter().partition(|&&member| points[member][axis] <= middle + slack);
        // All in one place.
        if low.is_empty() || high.is_empty() {
            high = members.split_off(members.len() / 2);
            low = members;
        }
        groups.extend([group(low), group(high)]);
    }
    let mut merged: Vec<(usize, Light)> = groups.iter().map(|group| one(&lights, &points, &group.members)).collect();
    merged.sort_by_key(|(first, _)| *first);
    merged.into_iter().map(|(_, light)| light).collect()
}

/// The light of a group, and its number.
fn one(lights: &[Light], points: &[[f32; 6]], members: &[usize]) -> (usize, Light) {
    let strength = |member: usize| power(&lights[member]).element_sum();
    let sum: f32 = members.iter().map(|&member| strength(member)).sum();
    let middle: [f32; 6] =
        std::array::from_fn(|axis| members.iter().map(|&member| strength(member) / sum * points[member][axis]).sum());
    let distance = |member: usize| -> f32 { (0..6).map(|axis| (points[member][axis] - middle[axis]).powi(2)).sum() };
    let least = members.iter().map(|&member| distance(member)).fold(f32::INFINITY, f32::min);
    let is_nearest = |&&member: &&usize| distance(member) <= (1.0 + ALIKE) * least;
    let nearest = *members.iter().find(is_nearest).unwrap_or(&members[0]);
    let all = members.iter().map(|&member| power(&lights[member])).sum::<Vec3>();
    (nearest, Light { intensity: all / emitted(&lights[nearest]), ..lights[nearest].clone() })
}

/// All the light of a light, over π.
fn power(light: &Light) -> Vec3 {
    emitted(light) * light.intensity
}

/// A ball shines to all sides: four times as much as a surface of the same intensity along its normal.
fn emitted(light: &Light) -> f32 {
    if light.surface.is_some() { 1.0 } else { 4.0 }
}
