//! Lights: their position, their size, and the unit of their strength.

use std::f32::consts::FRAC_PI_2;

use glam::Vec3;
use serde::{Deserialize, Serialize};

use crate::parse_by_name;

/// How distance attenuates a light, and with it the unit of [`Light::intensity`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Falloff {
    /// The thesis's lights: intensity 1 fully lights a white surface that faces it, at any distance.
    #[default]
    None,
    /// Photometric: candela (lux for a directional light), so that a white diffuse surface facing it at distance d shows
    /// I / (π d²) (directional: I / π).
    InverseSquare,
}

impl Falloff {
    /// All falloffs.
    pub const ALL: &'static [Falloff] = &[Falloff::None, Falloff::InverseSquare];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Falloff::None => "none",
            Falloff::InverseSquare => "inverse-square",
        }
    }

    /// A short description.
    pub fn help(self) -> &'static str {
        match self {
            Falloff::None => "The same at any distance, as in the thesis",
            Falloff::InverseSquare => "Intensity in candela, divided by the squared distance",
        }
    }
}

parse_by_name!(Falloff, "falloff");

/// The largest angular diameter of a directional light, degrees: at 180 its disk would be infinite.
pub(crate) const LARGEST_ANGLE: f64 = 179.0;

/// The shape of a light. Positions and lengths are in the scene's local frame and units.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum LightKind {
    /// Light from one point.
    Point {
        /// Its position.
        position: Vec3,
        /// For area shadows the thesis replaces each point light by many near it: they are distributed in a sphere of this radius, in
        /// area mode and by occluder lists. Hard shadows and light points use the point alone. 0: a point always.
        spread: f32,
    },
    /// Light from infinity, such as the sun's.
    Directional {
        /// The way the light travels; unit length. From a light with an angle, the way from its centre.
        direction: Vec3,
        /// Angular diameter in radians, below π: the light comes evenly from a disk that appears this wide, centred on where
        /// `direction` comes from. The sun's is 0.0093. 0: parallel light.
        angle: f32,
    },
    /// A light with a cone; between the two angles it fades to zero.
    Spot {
        /// Its position.
        position: Vec3,
        /// The axis of the cone, away from the light; unit length.
        direction: Vec3,
        /// Half-angle of the full-strength cone, radians.
        inner: f32,
        /// Half-angle where the light ends, radians, at least `inner`.
        outer: f32,
        /// Above 0, the light is a ball of this radius, with a cone from each of its points: it casts the shadows of a
        /// [`LightKind::Sphere`]. 0: a point.
        radius: f32,
    },
    /// A ball of light.
    Sphere {
        /// Its centre.
        position: Vec3,
        /// Its radius, above 0.
        radius: f32,
    },
    /// A flat round light. Whether it shines like a surface, or evenly in all directions, is said by [`Light::surface`].
    Disk {
        /// Its centre.
        position: Vec3,
        /// Its axis; unit length.
        normal: Vec3,
        /// Its radius, above 0.
        radius: f32,
    },
    /// A flat rectangular light. Whether it shines like a surface, or evenly in all directions, is said by [`Light::surface`].
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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Light {
    /// Name in the file; empty if it has none.
    pub name: String,
    /// Shape and position.
    pub kind: LightKind,
    /// Red, green and blue strength in the unit defined by `falloff`; the total of the whole light, whatever its size.
    pub intensity: Vec3,
    /// How distance attenuates it.
    pub falloff: Falloff,
    /// If it shines like a surface, as disks and rectangles do: the unit normal on the side that shines. Its strength falls with the cosine
    /// (Lambert), and `intensity` is that along the normal. `None`: it shines evenly in all directions, as the many point lights do that the
    /// thesis replaces a light with.
    pub surface: Option<Vec3>,
    /// Whether it stands for an emissive surface of the scene, a [lamp](crate::Material::lamp): mirrors show that surface, and it is made again
    /// where the surface moves.
    pub lamp: bool,
    /// Whether the camera sees a light with an area, as mirrors do.
    pub visible: bool,
    /// The number of its motion in the scene's animation.
    pub(crate) motion: Option<u32>,
}

/// A light with an invalid shape.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("a {kind} light cannot have the {what} {value}: {remedy}")]
#[non_exhaustive]
pub struct LightError {
    /// The name of the light's shape.
    pub kind: &'static str,
    /// The invalid part.
    pub what: &'static str,
    /// The given value.
    pub value: String,
    /// What to use instead.
    pub remedy: &'static str,
}

/// White lights of strength 1 without falloff and name; the methods `with_…` and [`Light::named`] change that.
///
/// ```
/// use lightmesh_scene::{Falloff, Light, glam::Vec3};
///
/// let lamp = Light::sphere(Vec3::new(0.0, 3.0, 0.0), 0.2)?.with_intensity([80.0, 75.0, 60.0]).with_falloff(Falloff::InverseSquare);
/// assert!(lamp.has_size());
/// # Ok::<(), lightmesh_scene::LightError>(())
/// ```
impl Light {
    /// A point light; see [`Light::with_spread`].
    pub fn point(position: Vec3) -> Light {
        Light::new(LightKind::Point { position, spread: 0.0 })
    }

    /// Parallel light that travels along `direction`, of any length; see [`Light::with_angle`].
    ///
    /// # Errors
    ///
    /// [`LightError`] if `direction` has no length.
    pub fn directional(direction: Vec3) -> Result<Light, LightError> {
        let direction = unit("directional", "direction", direction)?;
        Ok(Light::new(LightKind::Directional { direction, angle: 0.0 }))
    }

    /// A point light with a cone around `direction`, of any length: full strength up to the half-angle `inner`, zero beyond `outer`,
    /// radians; see [`Light::with_radius`].
    ///
    /// # Errors
    ///
    /// [`LightError`] if `direction` has no length, or not 0 ≤ `inner` ≤ `outer` ≤ π/2 and `outer` > 0.
    pub fn spot(position: Vec3, direction: Vec3, inner: f32, outer: f32) -> Result<Light, LightError> {
        let direction = unit("spot", "direction", direction)?;
        if !(0.0 <= inner && inner <= outer && 0.0 < outer && outer <= FRAC_PI_2) {
            let remedy = "give half-angles in radians, 0 <= inner <= outer <= pi/2, outer above 0";
            return Err(LightError { kind: "spot", what: "cone", value: format!("{inner} to {outer}"), remedy });
        }
        Ok(Light::new(LightKind::Spot { position, direction, inner, outer, radius: 0.0 }))
    }

    /// A ball of light.
    ///
    /// # Errors
    ///
    /// [`LightError`] if `radius` is not above 0.
    pub fn sphere(position: Vec3, radius: f32) -> Result<Light, LightError> {
        let radius = size("sphere", radius)?;
        Ok(Light::new(LightKind::Sphere { position, radius }))
    }

    /// A flat round light about the axis `normal`, of any length. It shines to the side of the normal; see [`Light::with_one_sided`].
    ///
    /// # Errors
    ///
    /// [`LightError`] if `normal` has no length, or `radius` is not above 0.
    pub fn disk(position: Vec3, normal: Vec3, radius: f32) -> Result<Light, LightError> {
        let (normal, radius) = (unit("disk", "normal", normal)?, size("disk", radius)?);
        Ok(Light::new(LightKind::Disk { position, normal, radius }).with_one_sided(true))
    }

    /// A flat rectangular light: `half_u` and `half_v` point from its centre to the middles of two adjacent sides. It shines to the side of
    /// `half_u` × `half_v`; see [`Light::with_one_sided`].
    ///
    /// # Errors
    ///
    /// [`LightError`] if they are not perpendicular, or span no area.
    pub fn rectangle(position: Vec3, half_u: Vec3, half_v: Vec3) -> Result<Light, LightError> {
        /// Cosine of the angle between the sides, above which they are not perpendicular.
        const LEANING: f32 = 1e-4;
        let refuse = |remedy| LightError {
            kind: "rectangle",
            what: "half sides",
            value: format!("{half_u} and {half_v}"),
            remedy,
        };
        let area = half_u.cross(half_v).length();
        if !(area > 0.0 && area.is_finite()) {
            return Err(refuse("give two finite vectors that span an area"));
        }
        if half_u.dot(half_v).abs() > LEANING * half_u.length() * half_v.length() {
            return Err(refuse("rotate one of them, so that they are at a right angle"));
        }
        Ok(Light::new(LightKind::Rectangle { position, half_u, half_v }).with_one_sided(true))
    }

    /// A light with a shape that is used unchecked.
    pub fn new(kind: LightKind) -> Light {
        Light {
            name: String::new(),
            kind,
            intensity: Vec3::ONE,
            falloff: Falloff::None,
            surface: None,
            lamp: false,
            visible: false,
            motion: None,
        }
    }

    /// The same light with this strength, see [`Light::intensity`].
    pub fn with_intensity(self, intensity: impl Into<Vec3>) -> Light {
        Light { intensity: intensity.into(), ..self }
    }

    /// The same light with another falloff.
    pub fn with_falloff(self, falloff: Falloff) -> Light {
        Light { falloff, ..self }
    }

    /// The same light, shining like a surface with this unit normal: see [`Light::surface`].
    pub fn with_surface(self, normal: Vec3) -> Light {
        Light { surface: Some(normal), ..self }
    }

    /// The same disk or rectangle, shining like a surface to the side of its normal, or of `half_u` × `half_v`; if not, evenly to both sides, with
    /// its intensity in all directions. Lights of other kinds shine evenly and stay unchanged.
    ///
    /// ```
    /// use lightmesh_scene::{Light, glam::Vec3};
    ///
    /// let panel = Light::rectangle(Vec3::new(0.0, 3.0, 0.0), 0.6 * Vec3::X, 0.3 * Vec3::Z)?;
    /// assert_eq!(panel.surface, Some(Vec3::NEG_Y));
    /// assert_eq!(panel.with_one_sided(false).surface, None);
    /// # Ok::<(), lightmesh_scene::LightError>(())
    /// ```
    pub fn with_one_sided(self, one_sided: bool) -> Light {
        let surface = match self.kind {
            LightKind::Disk { normal, .. } => Some(normal),
            LightKind::Rectangle { half_u, half_v, .. } => {
                let normal = half_u.as_dvec3().cross(half_v.as_dvec3()).try_normalize();
                normal.map(|normal| normal.as_vec3())
            }
            _ => return self,
        };
        Light { surface: surface.filter(|_| one_sided), ..self }
    }

    /// The same light, standing for an emissive surface of the scene or not: see [`Light::lamp`].
    pub fn with_lamp(self, lamp: bool) -> Light {
        Light { lamp, ..self }
    }

    /// The same light, which the camera sees or not, if it has an area: see [`Light::visible`].
    pub fn with_visible(self, visible: bool) -> Light {
        Light { visible, ..self }
    }

    /// The same light with a name.
    pub fn named(self, name: impl Into<String>) -> Light {
        Light { name: name.into(), ..self }
    }

    /// The same point light, distributed over a ball of this radius where shadows are soft. Lights of other kinds have no spread and stay
    /// unchanged.
    pub fn with_spread(self, spread: f32) -> Light {
        match self.kind {
            LightKind::Point { position, .. } => Light { kind: LightKind::Point { position, spread }, ..self },
            _ => self,
        }
    }

    /// The same directional light, coming from a disk of this angular diameter in radians, which is limited to the range from 0 to
    /// 179 degrees; NaN counts as 0. Lights of other kinds have no angle and stay unchanged.
    ///
    /// ```
    /// use lightmesh_scene::{Light, glam::Vec3};
    ///
    /// let sun = Light::directional(Vec3::new(-1.0, -2.0, 0.5))?.with_angle(0.53f32.to_radians());
    /// assert!(sun.has_size());
    /// # Ok::<(), lightmesh_scene::LightError>(())
    /// ```
    pub fn with_angle(self, radians: f32) -> Light {
        match self.kind {
            LightKind::Directional { direction, .. } => {
                Light { kind: LightKind::Directional { direction, angle: usable_angle(radians) }, ..self }
            }
            _ => self,
        }
    }

    /// The same spot light as a ball of this radius; 0, or what is not a length, makes it a point. Lights of other kinds stay unchanged.
    ///
    /// ```
    /// use lightmesh_scene::{Light, glam::Vec3};
    ///
    /// let lamp = Light::spot(Vec3::new(0.0, 3.0, 0.0), Vec3::NEG_Y, 0.3, 0.5)?.with_radius(0.05);
    /// assert!(lamp.has_size());
    /// # Ok::<(), lightmesh_scene::LightError>(())
    /// ```
    pub fn with_radius(self, length: f32) -> Light {
        match self.kind {
            LightKind::Spot { position, direction, inner, outer, .. } => {
                let radius = usable_radius(length);
                Light { kind: LightKind::Spot { position, direction, inner, outer, radius }, ..self }
            }
            _ => self,
        }
    }

    /// The same light at another position. Directional lights have none and stay unchanged.
    pub fn at(mut self, to: Vec3) -> Light {
        match &mut self.kind {
            LightKind::Point { position, .. }
            | LightKind::Spot { position, .. }
            | LightKind::Sphere { position, .. }
            | LightKind::Disk { position, .. }
            | LightKind::Rectangle { position, .. } => *position = to,
            LightKind::Directional { .. } => {}
        }
        self
    }

    /// The centre of the light; `None` for a directional light.
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

    /// The name of the shape in scene files and in `info`.
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

    /// Whether the light is an area light, so that a point can see a share of it.
    pub fn has_size(&self) -> bool {
        match self.kind {
            LightKind::Sphere { .. } | LightKind::Disk { .. } | LightKind::Rectangle { .. } => true,
            LightKind::Directional { angle, .. } => angle > 0.0,
            LightKind::Spot { radius, .. } => radius > 0.0,
            LightKind::Point { .. } => false,
        }
    }
}

/// The nearest angular diameter that a directional light can have.
pub(crate) fn usable_angle(radians: f32) -> f32 {
    // Not `clamp`, which keeps NaN.
    radians.max(0.0).min(LARGEST_ANGLE.to_radians() as f32)
}

/// The nearest radius that a spot light can have; 0 for what is not a length.
pub(crate) fn usable_radius(length: f32) -> f32 {
    if length.is_finite() { length.max(0.0) } else { 0.0 }
}

fn unit(kind: &'static str, what: &'static str, vector: Vec3) -> Result<Vec3, LightError> {
    let refused =
        || LightError { kind, what, value: vector.to_string(), remedy: "give a finite vector that is not zero" };
    vector.as_dvec3().try_normalize().map(|unit| unit.as_vec3()).ok_or_else(refused)
}

fn size(kind: &'static str, radius: f32) -> Result<f32, LightError> {
    if radius > 0.0 && radius.is_finite() {
        return Ok(radius);
    }
    let remedy = "give a radius above 0; a light without a size is a point light";
    Err(LightError { kind, what: "radius", value: radius.to_string(), remedy })
}
