//! The stages of a render: one table for clocks, progress and statistics.

/// Defines [`Stage`] and [`Seconds`]. To add a stage, add a line. What stands after `=` is the name in statistics, on which scripts rely: it stays if
/// the stage gets another.
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

            /// The name in statistics.
            pub fn name(self) -> &'static str {
                match self {
                    $(Stage::$variant => stringify!($name),)*
                }
            }
        }

        /// Time spent in each stage. `load`, `build` and `write` are not part of `render`. On a device the stages between
        /// `upload` and `download` are measured on the device. Geometry that was built or uploaded for an earlier image takes
        /// no time again.
        #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
        pub struct Seconds {
            /// Loading the scene.
            pub load: f64,
            $($(#[$doc])* pub $name: f64,)*
            /// The whole image, from prepared scene to frame.
            pub render: f64,
            /// Writing the image.
            pub write: f64,
        }

        impl Seconds {
            /// The seconds of one stage.
            pub fn of(&self, stage: Stage) -> f64 {
                match stage {
                    $(Stage::$variant => self.$name,)*
                }
            }

            /// Adds those of another part of the work.
            pub(crate) fn add(&mut self, other: &Seconds) {
                self.load += other.load;
                $(self.$name += other.$name;)*
                self.render += other.render;
                self.write += other.write;
            }

            /// The seconds of one stage, mutable.
            #[doc(hidden)]
            pub fn of_mut(&mut self, stage: Stage) -> &mut f64 {
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
    /// Copying geometry to a device that has its own memory.
    Upload = upload,
    /// The rays through the pixels.
    CameraRays = camera_rays,
    /// What each ray sees.
    PrimaryRays = primary_rays,
    /// What the samples of pixels see.
    PixelSamples = pixel_samples,
    /// The samples that are shaded apart from their pixels.
    Fragments = fragments,
    /// Surface points by cell of the light mesh.
    Cells = cells,
    /// Surface points in small groups.
    Bundles = items,
    /// Which light points each surface point sees.
    ShortTests = short_tests,
    /// Collecting each used light point once.
    Collect = collect,
    /// Which lights each light point sees.
    LongTests = long_tests,
    /// Formula (3).
    Interpolate = interpolate,
    /// Which lights each surface point sees, by rays.
    ShadowRays = shadow_rays,
    /// Which samples of lights each surface point sees, by what stands between.
    AreaShadows = area_shadows,
    /// Which lights each surface point sees, by one ray or all.
    AdaptiveShadows = adaptive_shadows,
    /// Which samples of lights small groups of surface points see, by what stands between.
    OccluderLists = occluder_lists,
    /// What surfaces that are not opaque leave of the lights.
    Transmittance = filters,
    /// What surfaces receive from their surroundings and from each other.
    Gather = gather,
    /// Formula (1).
    Shade = shade,
    /// The rays reflected by mirrors.
    MirrorRays = mirror_rays,
    /// Mirrored rays of a pixel that meet one surface.
    MergedRays = merged_rays,
    /// Allocating rows of the image.
    Film = film,
    /// Copying finished rows to their place in the image, from a device if there is one.
    Download = download,
}

impl Stage {
    /// Whether the stage is repeated for each wave of rays: the camera's, then that of each bounce.
    pub fn is_of_wave(self) -> bool {
        !matches!(self, Stage::Build | Stage::Upload | Stage::Film | Stage::Download)
    }
}
