//! Everything that is counted. The table is that of [`lightmesh_layout::counters`], which kernels use as well.

use std::sync::atomic::{AtomicU64, Ordering};

use lightmesh_layout::counter_table;
use lightmesh_layout::counters::Counters;

macro_rules! tally {
    ($($(#[$doc:meta])* $name:ident: $kind:ident $report:ident,)*) => {
        /// Everything that is counted, summed over all tiles and bounces.
        #[derive(Debug, Default)]
        pub struct Tally {
            $($(#[$doc])* pub $name: AtomicU64,)*
        }

        impl Tally {
            /// The counts so far.
            pub fn snapshot(&self) -> Counters {
                Counters { $($name: self.$name.load(Ordering::Relaxed),)* }
            }

            /// Returns to an earlier state: what was counted since belongs to work that is repeated.
            pub(crate) fn restore(&self, counters: &Counters) {
                $(self.$name.store(counters.$name, Ordering::Relaxed);)*
            }

            /// Adds the counts of a device.
            pub(crate) fn add_all(&self, counters: &Counters) {
                $(Tally::add(&self.$name, counters.$name);)*
            }
        }

        /// How often each event happened. Means are taken over the surface points, including those seen in mirrors.
        #[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
        pub struct Counts {
            /// Pixels of the image.
            pub pixels: u64,
            /// Light points of the template; 0 if there is none.
            pub template: u64,
            /// Pixels with a colour that is infinite or not a number: none, unless radiance leaves the range of `f32`.
            pub non_finite_pixels: u64,
            $($(#[$doc])* pub $report: tally!(@type $kind),)*
        }

        impl Counts {
            /// The report on the counts.
            pub(crate) fn new(pixels: u64, template: u64, counters: &Counters) -> Counts {
                let points = (counters.surface_points as f64).max(1.0);
                Counts { pixels, template, non_finite_pixels: 0, $($report: tally!(@report $kind, counters.$name, points),)* }
            }

            /// All numbers with their names.
            pub fn values(&self) -> Vec<(&'static str, f64)> {
                vec![
                    ("pixels", self.pixels as f64),
                    ("template", self.template as f64),
                    ("non_finite_pixels", self.non_finite_pixels as f64),
                    $((stringify!($report), self.$report as f64),)*
                ]
            }
        }
    };
    (@type sum) => { u64 };
    (@type mean) => { f64 };
    (@report sum, $count:expr, $points:ident) => { $count };
    (@report mean, $count:expr, $points:ident) => { $count as f64 / $points };
}

counter_table!(tally);

impl Tally {
    /// Adds `amount` to a count.
    pub fn add(count: &AtomicU64, amount: u64) {
        count.fetch_add(amount, Ordering::Relaxed);
    }

    /// Reads a count.
    pub fn get(count: &AtomicU64) -> u64 {
        count.load(Ordering::Relaxed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_done_again_is_not_counted_twice() {
        let tally = Tally::default();
        Tally::add(&tally.rays, 3);
        let before = tally.snapshot();
        Tally::add(&tally.rays, 4);
        tally.restore(&before);
        tally.add_all(&Counters { rays: 5, overruns: 1, ..before });
        assert_eq!((Tally::get(&tally.rays), Tally::get(&tally.overruns)), (8, 1));
    }

    #[test]
    fn means_are_over_the_surface_points() {
        let counters = Counters { surface_points: 4, used: 10, hits: 3, ..Tally::default().snapshot() };
        let counts = Counts::new(16, 88, &counters);
        assert_eq!((counts.pixels, counts.template, counts.hits, counts.used_mean), (16, 88, 3, 2.5));
        assert_eq!(counts.values().len(), Counters::NAMES.len() + 3);
        assert_eq!(Counts::new(1, 0, &Tally::default().snapshot()).used_mean, 0.0);
    }
}
