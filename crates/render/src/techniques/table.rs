//! The table of techniques. To add one, write its file next to this one and add its line here, with a mode or a lookup if it has a new
//! name; `Settings::resolved_lookup` says which lookup is used if none is chosen.

/// Calls a macro with the table: the modes with their names, the lookups of light-mesh mode with theirs, and the techniques as
/// `file::Type for Mode by Lookup`.
macro_rules! technique_table {
    ($use:ident) => {
        $use! {
            modes {
                /// Soft shadows, by the chosen lookup.
                LightMesh = "light-mesh",
                /// One hard shadow ray per light and pixel.
                RayTrace = "ray-trace",
                /// Many shadow rays per light and pixel: the reference.
                Area = "area",
            }
            lookups {
                /// Exact area shadows, by triangles found once for neighbouring surface points.
                Lists = "lists",
                /// Formula (3), the thesis: the mean over the light points of a half-ball.
                HalfBall = "half-ball",
                /// One shadow ray per light and pixel, all samples where 5x5 pixels disagree.
                Adaptive = "adaptive",
            }
            techniques {
                lists::Lists for LightMesh by Lists,
                half_ball::HalfBall for LightMesh by HalfBall,
                adaptive::Adaptive for LightMesh by Adaptive,
                ray_trace::RayTrace for RayTrace by None,
                area::Area for Area by None,
            }
        }
    };
}

pub(crate) use technique_table;
