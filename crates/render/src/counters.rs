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
            #[doc(hidden)]
            pub fn restore(&self, counters: &Counters) {
                $(self.$name.store(counters.$name, Ordering::Relaxed);)*
            }

            /// Adds the counts of a device.
            #[doc(hidden)]
            pub fn add_all(&self, counters: &Counters) {
                $(Tally::add(&self.$name, counters.$name);)*
            }
        }

        /// How often each event happened. Means are taken over the surface points, including those seen in mirrors.
        #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
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
            pub fn new(pixels: u64, template: u64, counters: &Counters) -> Counts {
                let points = (counters.surface_points as f64).max(1.0);
                Counts { pixels, template, non_finite_pixels: 0, $($report: tally!(@report $kind, counters.$name, points),)* }
            }

            /// Adds those of another part of the same image.
            pub(crate) fn add(&mut self, other: &Counts) {
                let points = [self.surface_points as f64, other.surface_points as f64];
                self.pixels += other.pixels;
                self.non_finite_pixels += other.non_finite_pixels;
                $(tally!(@add $kind, self.$report, other.$report, points);)*
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
    (@add sum, $own:expr, $other:expr, $points:ident) => { $own += $other };
    (@add mean, $own:expr, $other:expr, $points:ident) => {
        $own = ($own * $points[0] + $other * $points[1]) / ($points[0] + $points[1]).max(1.0)
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
