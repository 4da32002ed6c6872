use fearless_simd::Level;
use glam::Vec3;
use lightmesh_render::accel::Ray;
use lightmesh_render::internals::antialiasing::{Antialiasing, quantiles, table, weight};
use lightmesh_render::{Filter, View, Window};
use lightmesh_scene::{Camera, Projection};

const FILTERS: [Filter; 3] = [Filter::Box, Filter::Gauss, Filter::BlackmanHarris];

#[test]
fn samples_have_the_density_of_the_filter() {
    for filter in FILTERS {
        let offsets = quantiles(filter);
        let radius = 0.5 * filter.width();
        assert_eq!((offsets[0], offsets[63]), (-radius as f32, radius as f32), "{filter:?}");
        let area = |from: f64, to: f64| {
            let part = (to - from) / 1000.0;
            (0..1000).map(|i| part * weight(filter, from + (f64::from(i) + 0.5) * part)).sum::<f64>()
        };
        let all = area(-radius, radius);
        for step in offsets.windows(2) {
            let share = area(f64::from(step[0]), f64::from(step[1])) / all;
            assert!((share - 1.0 / 63.0).abs() < 1e-4, "{filter:?}: {share}");
        }
    }
}

#[test]
fn every_filter_has_a_table_of_its_own() {
    for &filter in Filter::ALL {
        assert_eq!(*table(filter), quantiles(filter), "{filter}");
    }
}

#[test]
fn a_filter_is_as_broad_as_its_deviation() {
    let breadths = FILTERS.map(|filter| Antialiasing::new(8, filter, 0, 64).breadth);
    // The square root of 12 times the standard deviation: 0.375 for the Gaussian, 0.4155 for the other. Within the last steps of the
    // table samples are spread evenly, which is a little more.
    for (found, expected) in breadths.into_iter().zip([1.0, 1.299, 1.439]) {
        assert!((0.999..1.05).contains(&(found / expected)), "{breadths:?}");
    }
}

#[test]
fn many_rays_are_the_same_as_single_ones() {
    let camera = Camera::look_at(Vec3::new(1.0, 2.0, 3.0), Vec3::ZERO, Vec3::Y, 40.0).unwrap();
    for projection in [camera.projection, Projection::Orthographic { height: 3.0 }] {
        let view = View::new(&camera.clone().with_projection(projection), [7, 5]);
        let view = view.with_window(Window { size: [4, 3], first: [2, 1], whole: [7, 5] });
        for (filter, numbers) in [(Filter::BlackmanHarris, 0..8), (Filter::Box, 0..3), (Filter::Gauss, 8..27)] {
            let samples = Antialiasing::new(32, filter, 5, 64);
            let mut rays = Vec::new();
            samples.rays(Level::new(), &view, 1..12, numbers.clone(), &mut rays);
            let single = (1..12).flat_map(|pixel| numbers.clone().map(move |sample| (pixel, sample)));
            let single: Vec<Ray> = single.map(|(pixel, sample)| samples.ray(&view, pixel, sample)).collect();
            let bits = |rays: &[Ray]| -> Vec<_> {
                rays.iter().map(|ray| [ray.origin, ray.direction].map(|v| v.to_array().map(f32::to_bits))).collect()
            };
            assert_eq!(bits(&rays), bits(&single), "{filter:?}");
        }
    }
}

#[test]
fn any_pixel_has_its_own_samples_around_its_centre() {
    for filter in FILTERS {
        let samples = Antialiasing::new(64, filter, 3, 64);
        let of = |pixel: u32| (0..64).map(|sample| samples.aside(pixel, sample)).collect::<Vec<_>>();
        assert_ne!(of(1), of(2));
        for axis in 0..2 {
            let mean = of(7).iter().map(|aside| aside[axis]).sum::<f32>() / 64.0;
            assert!(mean.abs() < 0.01, "{filter:?}: {mean}");
        }
        let other = Antialiasing::new(64, filter, 4, 64);
        assert_ne!(samples.aside(1, 0), other.aside(1, 0), "another seed");
    }
}
