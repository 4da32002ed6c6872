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
            Setting::Acceleration => "acceleration",
            Setting::MemoryLimit => "memory_limit",
            Setting::Threads => "threads",
            Setting::Device => "device",
        }
    }
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}
