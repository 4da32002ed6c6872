//! Views: how the range of a scene is brought into that of a screen.

use std::fmt;
use std::str::FromStr;

use super::{agx, neutral};

/// What a view is given at most: beyond this, products of single precision overflow.
const MOST: f32 = 1e18;

/// How linear colours of any brightness are shown on a screen whose white is 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum View {
    /// As they are; what is brighter than white is cut off.
    #[default]
    Standard,
    /// Khronos PBR Neutral: material colours as they are, highlights compressed.
    Neutral,
    /// AgX, base look, as in Blender 4: all brightnesses compressed as on film.
    Agx,
}

/// A word that is not the name of a view.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("unknown view `{0}`; available: standard, neutral, agx")]
pub struct UnknownView(pub String);

impl View {
    /// All views.
    pub const ALL: &'static [View] = &[View::Standard, View::Neutral, View::Agx];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Standard => "standard",
            Self::Neutral => "neutral",
            Self::Agx => "agx",
        }
    }

    /// A short description of its purpose.
    pub fn help(self) -> &'static str {
        match self {
            Self::Standard => "Colours as they are, clipped at white",
            Self::Neutral => "Khronos PBR Neutral: colours of materials as they are, highlights compressed",
            Self::Agx => "AgX base look, as in Blender 4: compressed as on film, bright colours whiten",
        }
    }

    /// What a linear colour is shown as, linear. Except with [`View::Standard`], which changes nothing, channels are in [0, 1]; those below
    /// 0 and NaN count as 0.
    #[expect(clippy::manual_clamp, reason = "NaN becomes 0")]
    pub fn apply(self, color: [f32; 3]) -> [f32; 3] {
        let valid = || color.map(|channel| channel.max(0.0).min(MOST));
        match self {
            Self::Standard => color,
            Self::Neutral => neutral::neutral(valid()).map(|channel| channel.clamp(0.0, 1.0)),
            Self::Agx => agx::agx(valid()),
        }
    }
}

impl fmt::Display for View {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for View {
    type Err = UnknownView;

    fn from_str(name: &str) -> Result<View, UnknownView> {
        let found = View::ALL.iter().find(|view| view.name() == name);
        found.copied().ok_or_else(|| UnknownView(name.to_owned()))
    }
}
