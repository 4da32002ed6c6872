//! Techniques: ways to compute the visibility of lights. One file each: what it computes, what it needs, its memory, its defaults, and its
//! entries in the statistics. Rays, shading and mirrors are shared.
//!
//! No code outside this folder distinguishes techniques. The enum below is generated from the [`table`].

pub(crate) mod table;

use lightmesh_scene::Bounds;

use crate::backend::stage_runner::StageRunner;
use crate::backend::{Backend, WaveOf};
use crate::data::lights::LightGroups;
use crate::error::RenderError;
use crate::observer::Observer;
use crate::plan::BytesPerRay;
use crate::prepared::PreparedScene;
use crate::render_context::Sampling;
use crate::settings::{Lookup, Mode, Setting, Settings};
use crate::shadow::ShadowTarget;
use crate::stage::Stage;
use crate::stats::SettingsStats;
use crate::view::View;
use table::technique_table;

/// What a technique is resolved from: what the settings leave open is chosen for this image.
pub(crate) struct VisibilityQuery<'a> {
    pub(crate) scene: &'a PreparedScene,
    pub(crate) settings: &'a Settings,
    pub(crate) view: &'a View,
    pub(crate) observer: &'a dyn Observer,
    /// A box around the scene's triangles, and around all points that are not theirs.
    pub(crate) bounds: Bounds,
}

impl VisibilityQuery<'_> {
    /// Tells the observer how many samples of each light the quality stands for, unless their number is set or no light has a size.
    fn tell_samples(&self) {
        let Settings { quality, samples, seed, .. } = *self.settings;
        let number = quality.samples();
        let target = ShadowTarget::Area(Sampling { samples: number, seed, spread: true });
        if samples.is_none() && self.scene.scene.lights.iter().any(|light| target.samples(light) > 1) {
            self.observer.report_default(
                Setting::Quality,
                &format!("{number} samples of each light, quality {}", quality.name()),
            );
        }
    }
}

/// Takes the visibility of a group of lights.
pub(crate) type VisibilitySink<'a, B> = dyn FnMut(<B as Backend>::Visibility) -> Result<(), RenderError> + 'a;

/// Hands what `see` finds of each group of lights to `sink`.
fn each_group<B: Backend>(
    wave: &WaveOf<B>,
    groups: LightGroups,
    sink: &mut VisibilitySink<B>,
    see: impl Fn(&WaveOf<B>) -> Result<B::Visibility, RenderError>,
) -> Result<(), RenderError> {
    groups.iter().try_for_each(|lights| sink(see(&WaveOf::<B> { lights, ..*wave })?))
}

/// The interface of a technique.
pub(crate) trait ShadowTechnique: Sized {
    /// Whether it interpolates on a lattice of light points: these can be kept from image to image, and their step and radius matter.
    const HAS_LIGHT_POINTS: bool = false;

    /// Default number of samples of a light with a size.
    fn default_samples(settings: &Settings) -> u32;

    /// Default number of samples of a pixel.
    fn default_pixel_samples(_: &Settings) -> u32 {
        1
    }

    /// Resolves the settings that the technique needs, and tells the observer what was chosen.
    fn resolve(query: &VisibilityQuery) -> Result<Self, RenderError>;

    /// The stages between primary rays and shading, in order.
    fn stages(&self) -> &'static [Stage];

    /// Hands what each surface point of a wave sees of each light to `sink`, group by group of lights.
    fn visibility<B: Backend>(
        &self,
        runner: &StageRunner<B>,
        wave: &WaveOf<B>,
        groups: LightGroups,
        sink: &mut VisibilitySink<B>,
    ) -> Result<(), RenderError>;

    /// Number of lights in a group. A group is shaded before the next: memory does not grow with the number of groups.
    fn lights_at_once(&self) -> usize {
        4
    }

    /// Bytes that it needs per ray for `lights` lights at once, with their shares.
    fn bytes_per_ray(&self, lights: u64) -> BytesPerRay;

    /// Whether the visibility of a pixel depends on its neighbours.
    fn needs_neighbours(&self) -> bool {
        false
    }

    /// Whether point lights are distributed over their spread.
    fn spreads_points(&self) -> bool {
        false
    }

    /// Whether surface points look for the centres of lights alone.
    fn targets_centers(&self) -> bool {
        false
    }

    /// Light points of the template; 0 without one.
    fn template(&self) -> u64 {
        0
    }

    /// Writes what was resolved into the statistics.
    fn describe(&self, scene: &PreparedScene, settings: &Settings, stats: &mut SettingsStats);
}

macro_rules! techniques {
    (modes $modes:tt lookups $lookups:tt techniques { $($file:ident :: $name:ident for $mode:ident by $lookup:ident,)* }) => {
        $(pub(crate) mod $file;)*

        /// A resolved technique.
        #[derive(Clone, Debug)]
        pub(crate) enum Technique {
            $($name($file::$name),)*
        }

        impl Technique {
            /// Resolves the technique selected by the settings.
            pub(crate) fn resolve(query: &VisibilityQuery) -> Result<Technique, RenderError> {
                $(if chosen(query.settings, Mode::$mode, techniques!(@lookup $lookup)) {
                    return $file::$name::resolve(query).map(Technique::$name);
                })*
                Err(no_technique(query.settings))
            }

            /// Shadow rays per area light.
            pub(crate) fn samples(settings: &Settings) -> u32 {
                $(if chosen(settings, Mode::$mode, techniques!(@lookup $lookup)) {
                    return settings.samples.unwrap_or_else(|| $file::$name::default_samples(settings));
                })*
                settings.samples.unwrap_or(1)
            }

            /// Whether the technique has light points.
            pub(crate) fn has_light_points(settings: &Settings) -> bool {
                $(if chosen(settings, Mode::$mode, techniques!(@lookup $lookup)) {
                    return $file::$name::HAS_LIGHT_POINTS;
                })*
                false
            }

            /// Samples of a pixel.
            pub(crate) fn pixel_samples(settings: &Settings) -> u32 {
                $(if chosen(settings, Mode::$mode, techniques!(@lookup $lookup)) {
                    return settings.aa.unwrap_or_else(|| $file::$name::default_pixel_samples(settings));
                })*
                settings.aa.unwrap_or(1)
            }

            techniques!(@each $($name)*;
                stages() -> &'static [Stage];
                lights_at_once() -> usize;
                bytes_per_ray(lights: u64) -> BytesPerRay;
                needs_neighbours() -> bool;
                spreads_points() -> bool;
                targets_centers() -> bool;
                template() -> u64;
                describe(scene: &PreparedScene, settings: &Settings, stats: &mut SettingsStats) -> ();
            );

            pub(crate) fn visibility<B: Backend>(
                &self,
                runner: &StageRunner<B>,
                wave: &WaveOf<B>,
                groups: LightGroups,
                sink: &mut VisibilitySink<B>,
            ) -> Result<(), RenderError> {
                match self {
                    $(Technique::$name(technique) => technique.visibility(runner, wave, groups, sink),)*
                }
            }
        }
    };
    (@lookup None) => { None };
    (@lookup $lookup:ident) => { Some(Lookup::$lookup) };
    // Methods that are forwarded to the technique.
    (@each $($name:ident)*; ) => {};
    (@each $($name:ident)*; $method:ident($($argument:ident: $type:ty),*) -> $result:ty; $($rest:tt)*) => {
        pub(crate) fn $method(&self, $($argument: $type),*) -> $result {
            techniques!(@call self, $method($($argument),*), $($name)*)
        }
        techniques!(@each $($name)*; $($rest)*);
    };
    (@call $self:ident, $method:ident $arguments:tt, $($name:ident)*) => {
        match $self {
            $(Technique::$name(technique) => techniques!(@apply technique, $method $arguments),)*
        }
    };
    (@apply $technique:ident, $method:ident ($($argument:ident),*)) => { $technique.$method($($argument),*) };
}

technique_table!(techniques);

impl Settings {
    /// Whether there is a lattice of light points, with a step: of all techniques, only the thesis' has one.
    pub fn has_light_points(&self) -> bool {
        Technique::has_light_points(self)
    }
}

/// Whether the settings select the technique of `mode` and `lookup`; a mode that looks nothing up ignores it.
fn chosen(settings: &Settings, mode: Mode, lookup: Option<Lookup>) -> bool {
    settings.mode == mode && lookup.is_none_or(|lookup| lookup == settings.resolved_lookup())
}

fn no_technique(settings: &Settings) -> RenderError {
    RenderError::Setting {
        setting: Setting::Lookup,
        value: settings.lookup.name().to_owned(),
        remedy: "this mode has no such lookup: choose another, or omit it",
    }
}
