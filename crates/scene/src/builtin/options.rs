//! Options of a built-in scene.

use crate::LoadError;

/// Options of the built-in scenes; `None` uses the value of the scene's own design.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct BuiltinOptions {
    /// Number of point lights, 1 to 256; values outside are clamped. The sum of intensities does not change.
    pub lights: Option<usize>,
    /// Radius in scene units over which area shadows distribute each point light; a negative one counts as 0.
    pub spread: Option<f32>,
}

/// The maximum number of lights.
const MAX_LIGHTS: usize = 256;

impl BuiltinOptions {
    /// Parses `lights=N&spread=S` after the name of a scene, in any order, each at most once; the text may be empty.
    pub(super) fn parse(scene: &str, text: &str) -> Result<BuiltinOptions, LoadError> {
        let mut options = BuiltinOptions::default();
        for option in text.split('&').filter(|option| !option.is_empty()) {
            let (parameter, value) = option.split_once('=').unwrap_or((option, ""));
            options.set(parameter, value).map_err(|Refusal { problem, remedy }| LoadError::BuiltinParameter {
                name: scene.into(),
                parameter: parameter.into(),
                value: value.into(),
                problem,
                remedy,
            })?;
        }
        Ok(options)
    }

    fn set(&mut self, parameter: &str, value: &str) -> Result<(), Refusal> {
        let twice = match parameter {
            "lights" => self.lights.replace(parse_lights(value)?).is_some(),
            "spread" => self.spread.replace(parse_spread(value)?).is_some(),
            _ => return refuse(format!("unknown parameter `{parameter}`"), "available: lights, spread"),
        };
        if twice { refuse(format!("`{parameter}` is given twice"), "give it once") } else { Ok(()) }
    }

    pub(super) fn lights_or(&self, designed: usize) -> usize {
        self.lights.unwrap_or(designed).clamp(1, MAX_LIGHTS)
    }

    pub(super) fn spread_or(&self, designed: f32) -> f32 {
        self.spread.unwrap_or(designed).max(0.0)
    }
}

struct Refusal {
    problem: String,
    remedy: String,
}

fn refuse<T>(problem: String, remedy: &str) -> Result<T, Refusal> {
    Err(Refusal { problem, remedy: remedy.into() })
}

fn parse_lights(value: &str) -> Result<usize, Refusal> {
    match value.parse() {
        Ok(count) if (1..=MAX_LIGHTS).contains(&count) => Ok(count),
        _ => refuse(format!("`{value}` is not a number of lights"), "use a whole number from 1 to 256"),
    }
}

fn parse_spread(value: &str) -> Result<f32, Refusal> {
    match value.parse::<f32>() {
        Ok(spread) if spread.is_finite() && spread >= 0.0 => Ok(spread),
        _ => refuse(format!("`{value}` is not a radius"), "use a length in scene units, 0 or above"),
    }
}
