//! The content of a scene: the output of `lightmesh info`, for people and, through serde, for programs.

use std::fmt;

use glam::Vec2;
use lightmesh_files::visible;
use serde::Serialize;

use crate::{Camera, Fov, Light, LightKind, Projection, Scene, UpInfo};

/// A summary of a scene. World coordinates, scene units and degrees.
#[derive(Clone, Debug, Serialize, PartialEq)]
#[non_exhaustive]
pub struct SceneInfo {
    /// Number of triangles, those of instances in all their places.
    pub triangles: usize,
    /// Number of places of shapes that are stored once.
    pub instances: usize,
    /// Number of vertices with a normal; triangles of others are flat.
    pub normals: usize,
    /// How many of these normals were made while the scene was read.
    pub smooth_normals: usize,
    /// Box around all triangles; `None` if there are none.
    pub bounds: Option<BoundsInfo>,
    /// Lights in the file's order.
    pub lights: Vec<LightInfo>,
    /// Cameras in the file's order.
    pub cameras: Vec<CameraInfo>,
    /// Number of materials.
    pub materials: usize,
    /// Number of materials whose opacity says where their surfaces are.
    pub cut_outs: usize,
    /// Number of materials that let a share of the light through.
    pub see_through: usize,
    /// Number of textures.
    pub textures: usize,
    /// The up axis; `None` if neither cameras nor shape indicate it.
    pub up: Option<UpInfo>,
    /// How it moves; `None` if it does not.
    pub animation: Option<AnimationInfo>,
    /// What was corrected, ignored or guessed.
    pub warnings: Vec<String>,
}

/// How a scene moves.
#[derive(Clone, Debug, Serialize, PartialEq)]
#[non_exhaustive]
pub struct AnimationInfo {
    /// From the first frame to the last one.
    pub seconds: f64,
    /// Whether surfaces move: not only cameras and lights.
    pub moves_surfaces: bool,
    /// Names of the animations of files that are played.
    pub played: Vec<String>,
    /// Names of those that are not, since they move what another one moves.
    pub others: Vec<String>,
}

/// A box in world coordinates.
#[derive(Clone, Copy, Debug, Serialize, PartialEq)]
pub struct BoundsInfo {
    /// Lowest corner.
    pub min: [f64; 3],
    /// Highest corner.
    pub max: [f64; 3],
}

/// A light. Fields that its kind does not have are `None`; of those only `position` and `direction` are then serialised.
#[derive(Clone, Debug, Serialize, PartialEq)]
#[non_exhaustive]
pub struct LightInfo {
    /// point, directional, spot, sphere, disk or rectangle.
    pub kind: &'static str,
    /// Name in the file.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// Its centre; `None` for a directional light.
    pub position: Option<[f64; 3]>,
    /// The direction in which it shines, or the axis of a disk or rectangle; `None` for a point or sphere.
    pub direction: Option<[f64; 3]>,
    /// Red, green and blue.
    pub intensity: [f64; 3],
    /// none or inverse-square.
    pub falloff: &'static str,
    /// Of a sphere or disk.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub radius: Option<f64>,
    /// Of a point light that area mode distributes over a ball: its radius.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spread: Option<f64>,
    /// Of a directional light that comes from a disk: its angular diameter, degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub angle: Option<f64>,
    /// Of a disk or rectangle: whether it shines to the side of its direction only, and aside with the cosine.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub one_sided: Option<bool>,
    /// Of a rectangle: its edges.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub size: Option<[f64; 2]>,
    /// Of a spot light: half-angle of the full-strength cone, degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub inner: Option<f64>,
    /// Of a spot light: half-angle where it ends, degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub outer: Option<f64>,
}

/// A camera.
#[derive(Clone, Debug, Serialize, PartialEq)]
#[non_exhaustive]
pub struct CameraInfo {
    /// Name in the file; may be empty.
    pub name: String,
    /// The eye.
    pub position: [f64; 3],
    /// Viewing direction.
    pub direction: [f64; 3],
    /// Up vector.
    pub up: [f64; 3],
    /// Full vertical field of view, degrees (for a camera with a horizontal field of view: in a square image); `None`, written
    /// as null, for an orthographic camera.
    pub vfov: Option<f64>,
    /// Full horizontal field of view, degrees, if that is the one that is fixed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hfov: Option<f64>,
    /// Height of an orthographic image.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub height: Option<f64>,
    /// By how much the image is to the right of the viewing direction and above it, in heights of the image, if it is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shift: Option<[f64; 2]>,
    /// The depth from which on surfaces and lights are seen, if not all are.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub near: Option<f64>,
    /// The depth up to which they are seen, if not all are.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub far: Option<f64>,
}

impl Scene {
    /// The summary of the scene.
    pub fn info(&self) -> SceneInfo {
        let bounds = self.geometry.mesh.bounds();
        let world = |local| self.to_world(local).to_array();
        let opacities = || self.geometry.materials.iter().filter_map(|material| material.opacity);
        SceneInfo {
            triangles: self.geometry.mesh.triangle_count(),
            instances: self.geometry.mesh.instances.list().len(),
            normals: self.geometry.mesh.normal_count(),
            smooth_normals: self.smooth_normals,
            bounds: (!bounds.is_empty()).then(|| BoundsInfo { min: world(bounds.min), max: world(bounds.max) }),
            lights: self.lights.iter().map(|light| light_info(self, light)).collect(),
            cameras: self.cameras.iter().map(|camera| camera_info(self, camera)).collect(),
            materials: self.geometry.materials.len(),
            cut_outs: opacities().filter(|opacity| opacity.filter().is_none()).count(),
            see_through: opacities().filter(|opacity| opacity.filter().is_some()).count(),
            textures: self.geometry.textures.len(),
            up: self.suggested_up(),
            animation: self.animation().map(|animation| AnimationInfo {
                seconds: animation.duration(),
                moves_surfaces: animation.moves_surfaces(),
                played: animation.names().to_vec(),
                others: animation.others().to_vec(),
            }),
            warnings: self.warnings.clone(),
        }
    }
}

fn light_info(scene: &Scene, light: &Light) -> LightInfo {
    let mut info = LightInfo {
        kind: light.kind_name(),
        name: light.name.clone(),
        position: light.position().map(|position| scene.to_world(position).to_array()),
        direction: None,
        intensity: light.intensity.to_array().map(shortest),
        falloff: light.falloff.name(),
        radius: None,
        spread: None,
        angle: None,
        one_sided: None,
        size: None,
        inner: None,
        outer: None,
    };
    match light.kind {
        LightKind::Point { spread, .. } => info.spread = (spread > 0.0).then(|| shortest(spread)),
        LightKind::Directional { direction, angle } => {
            info.direction = Some(direction.to_array().map(shortest));
            info.angle = (angle > 0.0).then(|| shortest(angle.to_degrees()));
        }
        LightKind::Spot { direction, inner, outer, radius, .. } => {
            info.direction = Some(direction.to_array().map(shortest));
            info.inner = Some(shortest(inner.to_degrees()));
            info.outer = Some(shortest(outer.to_degrees()));
            info.radius = (radius > 0.0).then(|| shortest(radius));
        }
        LightKind::Sphere { radius, .. } => info.radius = Some(shortest(radius)),
        LightKind::Disk { normal, radius, .. } => {
            info.direction = Some(light.surface.unwrap_or(normal).to_array().map(shortest));
            info.one_sided = Some(light.surface.is_some());
            info.radius = Some(shortest(radius));
        }
        LightKind::Rectangle { half_u, half_v, .. } => {
            let normal = light.surface.unwrap_or_else(|| half_u.cross(half_v).normalize_or_zero());
            info.direction = Some(normal.to_array().map(shortest));
            info.one_sided = Some(light.surface.is_some());
            info.size = Some([half_u, half_v].map(|half| shortest(2.0 * half.length())));
        }
    }
    info
}

fn camera_info(scene: &Scene, camera: &Camera) -> CameraInfo {
    let (vfov, hfov, height) = match camera.projection {
        Projection::Perspective(fov @ Fov::Vertical(_)) => (Some(fov.vertical(1.0)), None, None),
        Projection::Perspective(fov @ Fov::Horizontal(hfov)) => (Some(fov.vertical(1.0)), Some(hfov), None),
        Projection::Orthographic { height } => (None, None, Some(height)),
    };
    CameraInfo {
        name: camera.name.clone(),
        position: scene.to_world(camera.position).to_array(),
        direction: camera.direction.to_array().map(shortest),
        up: camera.up.to_array().map(shortest),
        vfov: vfov.map(shortest),
        hfov: hfov.map(shortest),
        height: height.map(shortest),
        shift: (camera.shift != Vec2::ZERO).then(|| camera.shift.to_array().map(shortest)),
        near: (camera.near > 0.0).then(|| shortest(camera.near)),
        far: camera.far.is_finite().then(|| shortest(camera.far)),
    }
}

/// The `f64` with the fewest digits that rounds to this `f32`: 0.1 stays 0.1.
pub(crate) fn shortest(number: f32) -> f64 {
    number.to_string().parse().unwrap_or(f64::from(number))
}

/// Lines for a terminal: names in them are made visible.
impl fmt::Display for SceneInfo {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{} triangles, {} materials", self.triangles, self.materials)?;
        let kinds = [(self.cut_outs, "cut out by opacity"), (self.see_through, "see-through")];
        let kinds: Vec<String> =
            kinds.iter().filter(|(count, _)| *count > 0).map(|(count, kind)| format!("{count} {kind}")).collect();
        if !kinds.is_empty() {
            write!(f, " ({})", kinds.join(", "))?;
        }
        match self.textures {
            0 => writeln!(f)?,
            textures => writeln!(f, ", {textures} textures")?,
        }
        if self.instances > 0 {
            writeln!(f, "shared  {} places of shapes that are stored once", self.instances)?;
        }
        match self.smooth_normals {
            0 if self.normals == 0 => {}
            0 => writeln!(f, "normals {}", self.normals)?,
            made => writeln!(f, "normals {}, {made} of them made from the triangles", self.normals)?,
        }
        if let Some(bounds) = &self.bounds {
            writeln!(f, "bounds  {} .. {}", triple(&bounds.min), triple(&bounds.max))?;
        }
        for light in &self.lights {
            writeln!(f, "light   {light}")?;
        }
        for camera in &self.cameras {
            writeln!(f, "camera  {camera}")?;
        }
        if let Some(up) = &self.up {
            writeln!(f, "up      {}: {}", up.axis, visible(&up.reason))?;
        }
        if let Some(AnimationInfo { seconds, moves_surfaces, played, others }) = &self.animation {
            let what = if *moves_surfaces { "objects move" } else { "the camera or lights move" };
            write!(f, "moves   {seconds} s: {what}")?;
            for (names, outcome) in [(played, ""), (others, " (not played)")] {
                names.iter().try_for_each(|name| write!(f, ", `{}`{outcome}", visible(name)))?;
            }
            writeln!(f)?;
        }
        self.warnings.iter().try_for_each(|warning| writeln!(f, "warning {}", visible(warning)))
    }
}

impl fmt::Display for LightInfo {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}", self.kind)?;
        if !self.name.is_empty() {
            write!(f, " `{}`", visible(&self.name))?;
        }
        let vectors = [("at", &self.position), ("along", &self.direction)];
        for (word, vector) in vectors.iter().filter_map(|(word, vector)| Some((word, vector.as_ref()?))) {
            write!(f, ", {word} {}", triple(vector))?;
        }
        write!(f, ", intensity {}, falloff {}", triple(&self.intensity), self.falloff)?;
        let numbers = [
            ("radius", self.radius),
            ("spread", self.spread),
            ("angle", self.angle),
            ("inner", self.inner),
            ("outer", self.outer),
        ];
        for (word, number) in numbers.iter().filter_map(|(word, number)| Some((word, (*number)?))) {
            write!(f, ", {word} {}", rounded(number))?;
        }
        if let Some([w, h]) = self.size {
            write!(f, ", size {} × {}", rounded(w), rounded(h))?;
        }
        if self.one_sided == Some(false) { f.write_str(", to both sides") } else { Ok(()) }
    }
}

impl fmt::Display for CameraInfo {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        if !self.name.is_empty() {
            write!(f, "`{}` ", visible(&self.name))?;
        }
        write!(f, "at {}, along {}", triple(&self.position), triple(&self.direction))?;
        match (self.hfov, self.vfov, self.height) {
            (Some(hfov), ..) => write!(f, ", hfov {}°", rounded(hfov))?,
            (_, Some(vfov), _) => write!(f, ", vfov {}°", rounded(vfov))?,
            (.., Some(height)) => write!(f, ", orthographic, height {}", rounded(height))?,
            _ => {}
        }
        if let Some([x, y]) = self.shift {
            write!(f, ", shift {} {}", rounded(x), rounded(y))?;
        }
        let mut depth =
            |name, depth: Option<f64>| depth.map_or(Ok(()), |depth| write!(f, ", {name} {}", rounded(depth)));
        depth("near", self.near)?;
        depth("far", self.far)
    }
}

fn triple(vector: &[f64; 3]) -> String {
    vector.map(|number| rounded(number).to_string()).join(" ")
}

/// At most six decimals, enough to recognise a value.
fn rounded(number: f64) -> f64 {
    (number * 1e6).round() / 1e6
}
