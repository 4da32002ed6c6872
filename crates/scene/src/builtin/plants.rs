//! Trees and bushes: a bent trunk, lumps that fill the crown, and leaves all over them.

use glam::{Vec2, Vec3};

use super::foliage::Leaves;
use super::math::{Random, around};
use super::parts::{Paint, Parts};
use super::surfaces::bezier;

/// The design of a broad-leaved tree, placed at its own origin.
pub(super) struct Tree<'a> {
    /// From the ground to the top of the crown.
    pub(super) height: f32,
    /// Start of the crown, as a share of the height.
    pub(super) crown_from: f32,
    /// Half the width of the crown as a share of the height.
    pub(super) crown_radius: f32,
    /// Number of lumps that make up the crown; 0 for a crown of leaves alone.
    pub(super) lumps: usize,
    /// Number of leaves.
    pub(super) leaf_count: usize,
    /// Appearance of a leaf.
    pub(super) leaves: &'a Leaves<'a>,
    /// Colour of trunk and branches.
    pub(super) bark: Paint,
    /// Colour of the shade inside the crown.
    pub(super) shade: Paint,
}

impl Tree<'_> {
    pub(super) fn grow(&self, parts: &mut Parts, random: &mut Random) {
        let low = self.height * self.crown_from;
        let center = Vec3::Y * (0.5 * (low + self.height));
        let outer =
            Vec3::new(self.crown_radius * self.height, 0.5 * (self.height - low), self.crown_radius * self.height);
        self.trunk(parts, random, center);
        let lumps = crown_lumps(random, center, outer, self.lumps);
        for &(center, radii) in &lumps {
            self.branch(parts, random, low, center);
            parts.lump(center, radii, 4, || random.within(0.8, 1.0), self.shade);
        }
        let surface: f32 = lumps.iter().map(|(_, radii)| radii.x * radii.x).sum();
        for (center, radii) in lumps {
            let count = (self.leaf_count as f32 * radii.x * radii.x / surface) as usize;
            self.leaves.crown(parts, random, center, radii, count);
        }
    }

    fn trunk(&self, parts: &mut Parts, random: &mut Random, top: Vec3) {
        let bend = Vec3::new(random.within(-1.0, 1.0), 0.0, random.within(-1.0, 1.0)) * (0.04 * self.height);
        let path = bezier([Vec3::NEG_Y * (0.03 * self.height), top * 0.3 + bend, top * 0.7 - bend, top], 7);
        let girth = 0.035 * self.height;
        parts.tube(&path, |index| girth * [1.5, 1.0, 0.88, 0.78, 0.66, 0.5, 0.3][index], 7, self.bark);
    }

    /// A bough from the trunk below the crown into the middle of a lump.
    fn branch(&self, parts: &mut Parts, random: &mut Random, low: f32, end: Vec3) {
        let fork = Vec3::Y * (low * random.within(0.75, 1.05));
        if Vec2::new(end.x, end.z).length() < 0.08 * self.height || end.y <= fork.y {
            return;
        }
        let knee = Vec3::new(0.55 * end.x, fork.y + 0.35 * (end.y - fork.y), 0.55 * end.z);
        let path = bezier([fork, 0.5 * (fork + knee), knee, end], 4);
        parts.tube(&path, |index| 0.014 * self.height * (1.0 - 0.2 * index as f32), 4, self.bark);
    }
}

/// Balls that fill the ellipsoid `outer` around `center`: one in the centre, the others on a spiral around it.
fn crown_lumps(random: &mut Random, center: Vec3, outer: Vec3, count: usize) -> Vec<(Vec3, Vec3)> {
    let lump = |index: usize| {
        if index == 0 {
            return (center, outer * Vec3::new(0.72, 0.8, 0.72));
        }
        let step = (index as f32 - 0.5) / (count as f32 - 1.0);
        let y = 0.62 - 1.3 * step;
        let circle = around(0.381_966 * index as f32 + random.within(-0.04, 0.04)) * (1.0 - y * y).sqrt();
        let place = Vec3::new(circle.x, y, circle.y) * random.within(0.5, 0.62);
        let radius = random.within(0.42, 0.54) * outer.x;
        (center + outer * place, Vec3::new(radius, 0.85 * radius, radius))
    };
    (0..count).map(lump).collect()
}

/// A bush: one flattened lump on the ground with leaves all over.
pub(super) fn bush(
    parts: &mut Parts,
    random: &mut Random,
    radii: Vec3,
    leaves: &Leaves,
    leaf_count: usize,
    shade: Paint,
) {
    let center = Vec3::Y * (0.6 * radii.y);
    parts.lump(center, 0.85 * radii, 4, || random.within(0.85, 1.1), shade);
    leaves.crown(parts, random, center, radii, leaf_count);
}
