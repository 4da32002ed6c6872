//! The stages of a render: one table for clocks, progress and statistics.

/// Defines [`Stage`] and [`Seconds`]. To add a stage, add a line.
macro_rules! stages {
    ($($(#[$doc:meta])* $variant:ident = $name:ident,)*) => {
        /// The stages of a render, in order.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Stage {
            $($(#[$doc])* $variant,)*
        }

        impl Stage {
            /// All of them, in order.
            pub const ALL: [Stage; [$(stringify!($name)),*].len()] = [$(Stage::$variant),*];

            /// The word in statistics.
            pub fn name(self) -> &'static str {
                match self {
                    $(Stage::$variant => stringify!($name),)*
                }
            }
        }

        /// How long what took. `load`, `build` and `write` are no part of `render`. On a device the stages between `upload` and
        /// `download` are the device's own time. Geometry that was built or uploaded for an earlier picture takes no time again.
        #[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
        pub struct Seconds {
            /// Reading the scene.
            pub load: f64,
            $($(#[$doc])* pub $name: f64,)*
            /// The whole picture, from prepared scene to frame.
            pub render: f64,
            /// Writing the picture.
            pub write: f64,
        }

        impl Seconds {
            /// The seconds of one stage.
            pub fn of(&self, stage: Stage) -> f64 {
                match stage {
                    $(Stage::$variant => self.$name,)*
                }
            }

            /// The seconds of one stage, to set them.
            pub(crate) fn of_mut(&mut self, stage: Stage) -> &mut f64 {
                match stage {
                    $(Stage::$variant => &mut self.$name,)*
                }
            }
        }
    };
}

stages! {
    /// Building the acceleration structure.
    Build = build,
    /// Copying geometry to a device that has memory of its own.
    Upload = upload,
    /// The rays through the pixels.
    CameraRays = camera_rays,
    /// What does each ray see?
    PrimaryRays = primary_rays,
    /// Surface points by cell of the light mesh.
    Cells = cells,
    /// Which light points does each surface point see?
    ShortTests = short_tests,
    /// Each used light point once.
    Collect = collect,
    /// Which lights does each light point (or, in the other modes, surface point) see?
    LongTests = long_tests,
    /// Formula (3).
    Interpolate = interpolate,
    /// Formula (1).
    Shade = shade,
    /// The rays that mirrors send on.
    MirrorRays = mirror_rays,
    /// Room for rows of the picture.
    Film = film,
    /// Finished rows take their place in the picture; from a device they are copied.
    Download = download,
}

impl Stage {
    /// Whether the stage is repeated for each wave of rays: the camera's, then that of each bounce.
    pub fn is_of_wave(self) -> bool {
        !matches!(self, Stage::Build | Stage::Upload | Stage::Film | Stage::Download)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_stage_has_its_seconds() {
        let mut seconds = Seconds::default();
        for (stage, value) in Stage::ALL.into_iter().zip(1..) {
            *seconds.of_mut(stage) = f64::from(value);
        }
        for (stage, value) in Stage::ALL.into_iter().zip(1..) {
            assert_eq!(seconds.of(stage), f64::from(value), "{}", stage.name());
        }
    }
}
