//! Lights.

use std::f32::consts::FRAC_PI_2;

use glam::{DVec3, Vec3};
use lightmesh::Scene;
use lightmesh::scene::{self, Falloff, LightKind};
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use crate::argument::{Given, Single};
use crate::convert::{Color, Vector};
use crate::errors::{self, OrRaise};
use crate::stored::{self, Reduced};

/// A light. With `falloff` "none", 1 fully lights a white surface that faces it, at any distance; with "inverse-square",
/// `intensity` is in candela (of a directional light in lux): a white surface that faces it at distance d shows I / (π d²), or I / π.
/// `position` is its centre and `direction` the way that its light goes, in world coordinates; `name` is what files call it.
#[pyclass(frozen, from_py_object, module = "lightmesh")]
#[derive(Clone, Serialize, Deserialize)]
pub(crate) struct Light {
    /// At the origin of its scene.
    light: scene::Light,
    /// In the world; of a directional light, nowhere.
    position: DVec3,
}

/// Lights: one, or a sequence of them.
pub(crate) struct LightList(pub(crate) Vec<Light>);

impl FromPyObject<'_, '_> for LightList {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, '_, PyAny>) -> PyResult<LightList> {
        if let Ok(one) = object.extract::<Light>() {
            return Ok(LightList(vec![one]));
        }
        let many = object.extract().map_err(|_| errors::wrong_type("a Light or a sequence of them", &object))?;
        Ok(LightList(many))
    }
}

/// What all lights have.
struct Common {
    intensity: Option<Color>,
    falloff: Given<String>,
    name: Given<String>,
}

impl Common {
    fn of(self, light: scene::Light, position: DVec3) -> PyResult<Light> {
        let falloff: Falloff = self.falloff.parse().map_err(|error| errors::setting(format!("{error}")))?;
        let intensity = self.intensity.map_or(Vec3::ONE, |color| color.0);
        Ok(Light { light: light.with_intensity(intensity).with_falloff(falloff).named(self.name.0), position })
    }
}

impl Light {
    /// A light of a scene.
    pub(crate) fn of(light: &scene::Light, scene: &Scene) -> Light {
        let position = light.position().map_or(DVec3::ZERO, |position| scene.to_world(position));
        Light { light: light.clone().at(Vec3::ZERO), position }
    }

    /// As a light of a scene.
    pub(crate) fn within(&self, scene: &Scene) -> scene::Light {
        self.light.clone().at(scene.to_local(self.position))
    }

    fn is_anywhere(&self) -> bool {
        self.light.position().is_some()
    }
}

/// The half-angles of a cone, in radians.
fn cone(inner: f32, outer: f32) -> (f32, f32) {
    // A right angle in degrees may be a little more in `f32` radians.
    (inner.to_radians(), if outer <= 90.0 { outer.to_radians().min(FRAC_PI_2) } else { outer.to_radians() })
}

/// A size that may be 0.
fn extent(name: &str, size: f32) -> PyResult<f32> {
    if size >= 0.0 {
        return Ok(size);
    }
    Err(errors::setting(format!("{name} is a number that is not negative, not {size}")))
}

#[pymethods]
impl Light {
    /// Light from one point, or, where shadows are soft, from a ball of radius `spread`.
    #[staticmethod]
    #[pyo3(
        signature = (position, *, spread = Single(0.0), intensity = None, falloff = Given(String::from("none")), name = Given(String::new())),
        text_signature = "(position, *, spread=0.0, intensity=1.0, falloff='none', name='')"
    )]
    fn point(
        position: Vector,
        spread: Single,
        intensity: Option<Color>,
        falloff: Given<String>,
        name: Given<String>,
    ) -> PyResult<Light> {
        let light = scene::Light::point(Vec3::ZERO).with_spread(extent("spread", spread.0)?);
        Common { intensity, falloff, name }.of(light, position.0)
    }

    /// Light that travels along `direction`, from a disk of the angular diameter `angle` in degrees; the sun's is 0.53.
    #[staticmethod]
    #[pyo3(
        signature = (direction, *, angle = Single(0.0), intensity = None, falloff = Given(String::from("none")), name = Given(String::new())),
        text_signature = "(direction, *, angle=0.0, intensity=1.0, falloff='none', name='')"
    )]
    fn directional(
        direction: Vector,
        angle: Single,
        intensity: Option<Color>,
        falloff: Given<String>,
        name: Given<String>,
    ) -> PyResult<Light> {
        let Single(angle) = angle;
        if !(0.0..=179.0).contains(&angle) {
            return Err(errors::setting(format!("angle is a number of degrees from 0 to 179, not {angle}")));
        }
        let light = scene::Light::directional(direction.0.as_vec3()).or_raise()?.with_angle(angle.to_radians());
        Common { intensity, falloff, name }.of(light, DVec3::ZERO)
    }

    /// A cone of light around `direction`, from a ball of `radius`: of full strength up to the half-angle `inner`, none beyond `outer`,
    /// in degrees.
    #[staticmethod]
    #[pyo3(
        signature = (
            position, direction, *, inner = Single(0.0), outer = Single(45.0), radius = Single(0.0), intensity = None,
            falloff = Given(String::from("none")), name = Given(String::new())
        ),
        text_signature = "(position, direction, *, inner=0.0, outer=45.0, radius=0.0, intensity=1.0, falloff='none', name='')"
    )]
    #[allow(clippy::too_many_arguments, reason = "keyword arguments")]
    fn spot(
        position: Vector,
        direction: Vector,
        inner: Single,
        outer: Single,
        radius: Single,
        intensity: Option<Color>,
        falloff: Given<String>,
        name: Given<String>,
    ) -> PyResult<Light> {
        let (inner, outer) = cone(inner.0, outer.0);
        let light = scene::Light::spot(Vec3::ZERO, direction.0.as_vec3(), inner, outer).or_raise()?;
        let light = light.with_radius(extent("radius", radius.0)?);
        Common { intensity, falloff, name }.of(light, position.0)
    }

    /// Light from a ball of this `radius`.
    #[staticmethod]
    #[pyo3(
        signature = (position, radius, *, intensity = None, falloff = Given(String::from("none")), name = Given(String::new())),
        text_signature = "(position, radius, *, intensity=1.0, falloff='none', name='')"
    )]
    fn sphere(
        position: Vector,
        radius: Single,
        intensity: Option<Color>,
        falloff: Given<String>,
        name: Given<String>,
    ) -> PyResult<Light> {
        let light = scene::Light::sphere(Vec3::ZERO, radius.0).or_raise()?;
        Common { intensity, falloff, name }.of(light, position.0)
    }

    /// A flat round light of this `radius`. It shines like a surface: along `normal` with `intensity`, aside with the cosine. Not `one_sided`: evenly to all
    /// sides.
    #[staticmethod]
    #[pyo3(
        signature = (
            position, normal, radius, *, one_sided = Given(true), intensity = None, falloff = Given(String::from("none")),
            name = Given(String::new())
        ),
        text_signature = "(position, normal, radius, *, one_sided=True, intensity=1.0, falloff='none', name='')"
    )]
    fn disk(
        position: Vector,
        normal: Vector,
        radius: Single,
        one_sided: Given<bool>,
        intensity: Option<Color>,
        falloff: Given<String>,
        name: Given<String>,
    ) -> PyResult<Light> {
        let light = scene::Light::disk(Vec3::ZERO, normal.0.as_vec3(), radius.0).or_raise()?;
        Common { intensity, falloff, name }.of(light.with_one_sided(one_sided.0), position.0)
    }

    /// A flat rectangular light: `half_u` and `half_v`, at a right angle, point from its centre to the middles of two sides.
    /// It shines like a surface, towards half_u × half_v. Not `one_sided`: evenly to all sides.
    #[staticmethod]
    #[pyo3(
        signature = (
            position, half_u, half_v, *, one_sided = Given(true), intensity = None, falloff = Given(String::from("none")),
            name = Given(String::new())
        ),
        text_signature = "(position, half_u, half_v, *, one_sided=True, intensity=1.0, falloff='none', name='')"
    )]
    fn rectangle(
        position: Vector,
        half_u: Vector,
        half_v: Vector,
        one_sided: Given<bool>,
        intensity: Option<Color>,
        falloff: Given<String>,
        name: Given<String>,
    ) -> PyResult<Light> {
        let (u, v) = (half_u.0.as_vec3(), half_v.0.as_vec3());
        let light = scene::Light::rectangle(Vec3::ZERO, u, v).or_raise()?;
        Common { intensity, falloff, name }.of(light.with_one_sided(one_sided.0), position.0)
    }

    /// `point`, `directional`, `spot`, `sphere`, `disk` or `rectangle`.
    #[getter]
    fn kind(&self) -> &'static str {
        self.light.kind_name()
    }

    /// As it was given; may be empty.
    #[getter]
    fn name(&self) -> &str {
        &self.light.name
    }

    /// Red, green and blue.
    #[getter]
    fn intensity(&self) -> (f32, f32, f32) {
        self.light.intensity.into()
    }

    /// `none` or `inverse-square`.
    #[getter]
    fn falloff(&self) -> &'static str {
        self.light.falloff.name()
    }

    /// World coordinates; `None` of a directional light.
    #[getter]
    fn position(&self) -> Option<(f64, f64, f64)> {
        self.is_anywhere().then(|| self.position.into())
    }

    /// The way that the light of a directional light or the axis of a spot goes, of unit length; `None` of others.
    #[getter]
    fn direction(&self) -> Option<(f32, f32, f32)> {
        match self.light.kind {
            LightKind::Directional { direction, .. } | LightKind::Spot { direction, .. } => Some(direction.into()),
            _ => None,
        }
    }

    /// The same light elsewhere, or of other strength.
    #[pyo3(signature = (*, position = None, direction = None, intensity = None, name = None))]
    fn replaced(
        &self,
        position: Option<Vector>,
        direction: Option<Vector>,
        intensity: Option<Color>,
        name: Option<Given<String>>,
    ) -> PyResult<Light> {
        let mut light = self.clone();
        if let Some(Vector(position)) = position {
            if !light.is_anywhere() {
                return Err(errors::setting("a directional light has no position: give a direction"));
            }
            light.position = position;
        }
        if let Some(Vector(to)) = direction {
            let unit = to.try_normalize().ok_or_else(|| errors::setting("the direction has no length"))?.as_vec3();
            match &mut light.light.kind {
                LightKind::Directional { direction, .. } | LightKind::Spot { direction, .. } => *direction = unit,
                _ => {
                    let kind = light.light.kind_name();
                    return Err(errors::setting(format!("a {kind} light has no direction: make another light")));
                }
            }
        }
        if let Some(Color(intensity)) = intensity {
            light.light.intensity = intensity;
        }
        if let Some(Given(name)) = name {
            light.light.name = name;
        }
        Ok(light)
    }

    /// For `pickle`.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        stored::reduce(py, "Light", self)
    }

    /// It never changes: a copy is the same.
    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }

    fn __repr__(&self) -> String {
        let place = if self.is_anywhere() { format!(" at {}", self.position) } else { String::new() };
        format!("<lightmesh.Light {:?}, {}{place}, intensity {}>", self.light.name, self.kind(), self.light.intensity)
    }
}
