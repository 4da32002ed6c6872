//! Which setting an error or a note refers to: messages name it in words, and a program that has another name for it, such as a
//! flag, adds that.

use std::fmt;

/// A setting of an image or its renderer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Setting {
    /// [`Settings::size`](crate::Settings::size).
    Size,
    /// [`Settings::crop`](crate::Settings::crop).
    Crop,
    /// [`Settings::step`](crate::Settings::step).
    Step,
    /// [`Settings::radius`](crate::Settings::radius).
    Radius,
    /// [`Settings::mode`](crate::Settings::mode).
    Mode,
    /// [`Settings::lookup`](crate::Settings::lookup).
    Lookup,
    /// [`Settings::quality`](crate::Settings::quality).
    Quality,
    /// [`Settings::ambient_light`](crate::Settings::ambient_light).
    AmbientLight,
    /// [`Settings::aa`](crate::Settings::aa).
    Aa,
    /// [`Settings::samples`](crate::Settings::samples).
    Samples,
    /// [`Settings::layers`](crate::Settings::layers).
    Layers,
    /// [`Settings::acceleration`](crate::Settings::acceleration).
    Acceleration,
    /// [`Settings::memory_limit`](crate::Settings::memory_limit).
    MemoryLimit,
    /// The number of threads of a [`Renderer`](crate::Renderer).
    Threads,
    /// The [`Device`](crate::Device) of a [`Renderer`](crate::Renderer).
    Device,
}

impl Setting {
    /// All settings.
    pub const ALL: &[Setting] = &[
        Setting::Size,
        Setting::Crop,
        Setting::Step,
        Setting::Radius,
        Setting::Mode,
        Setting::Lookup,
        Setting::Quality,
        Setting::AmbientLight,
        Setting::Aa,
        Setting::Samples,
        Setting::Layers,
        Setting::Acceleration,
        Setting::MemoryLimit,
        Setting::Threads,
        Setting::Device,
    ];

    /// Its name in the code: that of the field of [`Settings`](crate::Settings), `threads` or `device`.
    pub fn name(self) -> &'static str {
        match self {
            Setting::Size => "size",
            Setting::Crop => "crop",
            Setting::Step => "step",
            Setting::Radius => "radius",
            Setting::Mode => "mode",
            Setting::Lookup => "lookup",
            Setting::Quality => "quality",
            Setting::AmbientLight => "ambient_light",
            Setting::Aa => "aa",
            Setting::Samples => "samples",
            Setting::Layers => "layers",
            Setting::Acceleration => "acceleration",
            Setting::MemoryLimit => "memory_limit",
            Setting::Threads => "threads",
            Setting::Device => "device",
        }
    }

    /// What to choose of it so that an image takes less memory, if it decides how much that is.
    pub(crate) fn that_takes_less(self) -> Option<&'static str> {
        match self {
            Setting::Size => Some("a smaller image"),
            Setting::Layers => Some("no layers"),
            Setting::Aa => Some("fewer samples of a pixel"),
            Setting::Step => Some("a larger step"),
            Setting::Radius => Some("a smaller radius"),
            Setting::AmbientLight => Some("constant ambient light"),
            _ => None,
        }
    }
}

/// Some settings, in the order of [`Setting::ALL`]. Small, since errors have it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SettingSet(u16);

const _: () = assert!(Setting::ALL.len() <= u16::BITS as usize, "each setting has a bit");

impl SettingSet {
    /// Those that are in it.
    pub fn iter(self) -> impl Iterator<Item = Setting> {
        Setting::ALL.iter().copied().filter(move |setting| self.0 >> *setting as u16 & 1 == 1)
    }
}

impl FromIterator<Setting> for SettingSet {
    fn from_iter<I: IntoIterator<Item = Setting>>(settings: I) -> SettingSet {
        SettingSet(settings.into_iter().fold(0, |bits, setting| bits | 1 << setting as u16))
    }
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}
