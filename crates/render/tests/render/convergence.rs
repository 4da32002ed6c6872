//! The method compared with closed forms and with the area reference, as its step and radius shrink.

use glam::{DVec3, Vec3};
use lightmesh_render::{Mode, Settings};
use lightmesh_scene::LightKind;
use lightmesh_testkit::{Picture, half_plane, pile, render, rms_difference};

use crate::{light_mesh, mode};

/// No pixel's light boundary coincides with a boundary of strata: 1/30 against powers of two.
const STRIP: [u32; 2] = [120, 30];

/// V of the half-plane scene at each pixel, rendered and in closed form.
fn half_plane_shares(settings: &Settings) -> (Vec<f32>, Vec<f32>) {
    let frame = render(&half_plane(), settings);
    let picture = Picture::new(&frame);
    let closed_form = |pixel: usize| (0.5 * (1.0 + picture.position(pixel).x)).clamp(0.0, 1.0);
    (picture.visibilities(0), picture.hits().map(closed_form).collect())
}

#[test]
fn area_mode_meets_the_closed_form_of_a_half_plane() {
    // The edge is parallel to a side of the light, whose rows rise so that they meet it sample by sample: the count errs by less than
    // two, one at either end of the row in which the edge lies.
    for samples in [256, 225, 64] {
        let settings = mode(Mode::Area, STRIP).with_samples(samples);
        let (shares, expected) = half_plane_shares(&settings);
        let worst = shares.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(worst <= 2.0 / samples as f32, "{samples} samples: {worst}");
        assert!(worst > 0.0, "a finite number of samples cannot meet a ramp everywhere");
        let partial = expected.iter().filter(|&&share| share > 0.0 && share < 1.0).count();
        assert!(shares.len() == 120 * 30 && partial == shares.len() / 2, "{partial} of {}", shares.len());
    }
}

#[test]
fn the_method_tends_to_the_closed_form_of_a_half_plane() {
    // 16 samples per light point: their noise, 1/16 of a stratum averaged over some twenty points, stays below the bound.
    let error = |step| {
        let settings = light_mesh(STRIP, step, 2.1).with_samples(16);
        let (shares, expected) = half_plane_shares(&settings);
        rms_difference(&shares, &expected)
    };
    let errors = [0.4, 0.2, 0.1, 0.05].map(error);
    assert!(errors.is_sorted_by(|coarse, fine| coarse > fine), "{errors:?}");
    assert!(errors[3] < 0.01, "{errors:?}");
}

#[test]
fn the_method_tends_to_the_area_reference() {
    let sphere = LightKind::Sphere { position: Vec3::new(1.5, 4.0, 1.0), radius: 0.5 };
    let rectangle =
        LightKind::Rectangle { position: Vec3::new(-2.0, 4.0, 2.0), half_u: 0.6 * Vec3::X, half_v: 0.6 * Vec3::Z };
    let scene = pile(DVec3::ZERO, &[sphere, rectangle]);
    let size = [64, 64];
    let reference = render(&scene, &mode(Mode::Area, size).with_samples(256));
    let reference = Picture::new(&reference);
    for light in 0..2 {
        let places: Vec<usize> = reference.hits().collect();
        assert!(places.len() > 2000, "{} places", places.len());
        let shares = |picture: &Picture| -> Vec<f32> {
            places.iter().map(|&pixel| picture.layers().visibility[light][pixel]).collect()
        };
        let error = |step| {
            let frame = render(&scene, &light_mesh(size, step, 2.1).with_samples(16));
            rms_difference(&shares(&Picture::new(&frame)), &shares(&reference))
        };
        let errors = [0.2, 0.1, 0.05, 0.025].map(error);
        assert!(errors.is_sorted_by(|coarse, fine| coarse > fine), "light {light}: {errors:?}");
        assert!(errors[3] < 0.03, "light {light}: {errors:?}");
    }
}
