//! All counters: one table for kernels, host, statistics and reports.
//!
//! To add a counter, add a line to `counter_table!` then `cargo xtask kernels` for the header. Kernels find it as a field of
//! `Counters`, the host as a field of the renderer's `Tally`, users as a field of the statistics' `Counts`.

use crate::record::records;

/// Calls a macro with the table. A line gives the name of a counter, how statistics report it and under which name: `sum`, the
/// number itself, or `mean`, per surface point, including those in mirrors.
#[macro_export]
macro_rules! counter_table {
    ($use:ident) => {
        $use! {
            /// Rays cast for pixels and mirrors.
            rays: sum rays,
            /// Camera rays that hit something.
            hits: sum hits,
            /// Rays that hit something, including those from mirrors.
            surface_points: sum surface_points,
            /// Light points in all half-balls, before visibility.
            half_ball: mean half_ball_mean,
            /// Light points used by all surface points.
            used: mean used_mean,
            /// Surface points without a light point.
            fallbacks: mean fallback_share,
            /// Distinct light points, S_total.
            light_points: sum light_points,
            /// Short tests that intersected triangles.
            short_tests: sum short_tests,
            /// Short tests that were decided without intersecting triangles.
            short_tests_culled: sum short_tests_culled,
            /// Long tests from light points.
            long_tests: sum long_tests,
            /// Long tests that were skipped because a mesh cache had their results.
            long_tests_saved: sum long_tests_saved,
            /// Shadow rays from surface points.
            shadow_rays: sum shadow_rays,
            /// Rays that gather light for surfaces.
            gather_rays: sum gather_rays,
            /// Walks through a grid that reached the bound on their steps: never, unless that bound is wrong.
            overruns: sum overruns,
        }
    };
}

macro_rules! counters {
    ($($(#[$doc:meta])* $name:ident: $kind:ident $report:ident,)*) => {
        records! {
            /// Counters of one shard: kernels add to the shard of their block, the host adds up all shards.
            Counters { $($(#[$doc])* $name: u64,)* }
        }

        impl Counters {
            /// Names of all counters, in the order of the fields.
            pub const NAMES: &[&str] = &[$(stringify!($name)),*];
        }
    };
}

counter_table!(counters);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_counter_is_a_field_of_the_record() {
        assert_eq!(size_of::<Counters>(), 8 * Counters::NAMES.len());
        let names: Vec<&str> = <Counters as crate::Record>::fields().iter().map(|field| field.name).collect();
        assert_eq!(names, Counters::NAMES);
    }
}
