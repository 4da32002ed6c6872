//! Lights: where they are, how large they are, and how their strength is meant.

use glam::Vec3;

/// What distance does to a light, and with it the unit of [`Light::intensity`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Falloff {
    /// The thesis' lights: intensity 1 lights a white surface that faces it fully, at any distance.
    #[default]
    None,
    /// Photometric: candela (lux for a directional light), so that a white diffuse surface facing it at distance d shows
    /// I / (π d²) (directional: I / π).
    InverseSquare,
}

/// The shape of a light. Positions and lengths are in the scene's local frame and units.
#[derive(Clone, Debug, PartialEq)]
pub enum LightKind {
    /// Light from one point.
    Point {
        /// Where it is.
        position: Vec3,
        /// The thesis' area shadows replace each point light by many near it: they are strewn in a sphere of this radius.
        /// Every other mode takes the point alone. 0: a point in every mode.
        spread: f32,
    },
    /// Parallel light from infinity.
    Directional {
        /// The way the light travels; unit length.
        direction: Vec3,
    },
    /// A point light with a cone; between the two angles it fades to nothing.
    Spot {
        /// Where it is.
        position: Vec3,
        /// The axis of the cone, away from the light; unit length.
        direction: Vec3,
        /// Half-angle of the full-strength cone, radians.
        inner: f32,
        /// Half-angle where the light ends, radians, at least `inner`.
        outer: f32,
    },
    /// A ball of light.
    Sphere {
        /// Its centre.
        position: Vec3,
        /// Its radius, above 0.
        radius: f32,
    },
    /// A flat round light. It shines to both sides, alike in all directions, as the many point lights would that it stands for.
    Disk {
        /// Its centre.
        position: Vec3,
        /// Its axis; unit length.
        normal: Vec3,
        /// Its radius, above 0.
        radius: f32,
    },
    /// A flat rectangular light, shining as [`LightKind::Disk`] does.
    Rectangle {
        /// Its centre.
        position: Vec3,
        /// From the centre to the middle of one side.
        half_u: Vec3,
        /// From the centre to the middle of the next side; at a right angle to `half_u`.
        half_v: Vec3,
    },
}

/// One light.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// Name in the file; empty where it has none.
    pub name: String,
    /// Shape and place.
    pub kind: LightKind,
    /// Red, green and blue strength in the unit that `falloff` says; the total of the whole light, whatever its size.
    pub intensity: Vec3,
    /// What distance does to it.
    pub falloff: Falloff,
}

impl Light {
    /// A point light of the thesis: no falloff, no spread.
    pub fn point(position: Vec3, intensity: Vec3) -> Light {
        Light {
            name: String::new(),
            kind: LightKind::Point { position, spread: 0.0 },
            intensity,
            falloff: Falloff::None,
        }
    }

    /// The middle of the light; `None` for a directional one.
    pub fn position(&self) -> Option<Vec3> {
        match self.kind {
            LightKind::Point { position, .. }
            | LightKind::Spot { position, .. }
            | LightKind::Sphere { position, .. }
            | LightKind::Disk { position, .. }
            | LightKind::Rectangle { position, .. } => Some(position),
            LightKind::Directional { .. } => None,
        }
    }

    /// The word for the shape in scene files and in `info`.
    pub fn kind_name(&self) -> &'static str {
        match self.kind {
            LightKind::Point { .. } => "point",
            LightKind::Directional { .. } => "directional",
            LightKind::Spot { .. } => "spot",
            LightKind::Sphere { .. } => "sphere",
            LightKind::Disk { .. } => "disk",
            LightKind::Rectangle { .. } => "rectangle",
        }
    }

    /// Whether the light has a size of its own, so that a point can see a share of it.
    pub fn has_size(&self) -> bool {
        matches!(self.kind, LightKind::Sphere { .. } | LightKind::Disk { .. } | LightKind::Rectangle { .. })
    }
}
