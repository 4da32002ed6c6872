use glam::{Vec2, Vec3};
use lightmesh_image::Transfer;
use lightmesh_render::internals::textures::{Encoding, Image, MipLevels, at_level, level_of, neighbours, unpacked};
use lightmesh_scene::{Texture, TextureUse, Wrap};

fn color(texture: &Texture, wrap: [Wrap; 2]) -> Image<'_> {
    Image { uses: TextureUse { wrap, ..TextureUse::new(0) }, texture, encoding: Encoding::Color }
}

fn sampled(texture: &Texture, wrap: [Wrap; 2], place: Vec2) -> Vec3 {
    lightmesh_render::internals::textures::sampled(&color(texture, wrap), place)
}

fn filtered(texture: &Texture, levels: &MipLevels, wrap: [Wrap; 2], place: Vec2, axes: [Vec2; 2]) -> Vec3 {
    lightmesh_render::internals::textures::filtered(&color(texture, wrap), levels, place, axes)
}

fn texture(size: [u32; 2], texels: &[[u8; 3]]) -> Texture {
    Texture { name: String::new(), size, texels: texels.iter().map(|&[r, g, b]| [r, g, b, 255]).collect() }
}

#[test]
fn middles_of_texels_are_their_colours_and_between_lies_the_linear_mean() {
    let picture = texture([2, 1], &[[0, 0, 0], [255, 128, 0]]);
    let at = |u| sampled(&picture, [Wrap::Clamp; 2], Vec2::new(u, 0.5));
    let right = Vec3::new(1.0, Transfer::Srgb.decode(128), 0.0);
    assert_eq!([at(0.25), at(0.75), at(0.5)], [Vec3::ZERO, right, 0.5 * right]);
    assert_eq!([at(-7.0), at(0.0), at(1.0), at(8.0)], [Vec3::ZERO, Vec3::ZERO, right, right]);
}

#[test]
fn rows_run_down() {
    let picture = texture([1, 2], &[[255; 3], [0; 3]]);
    let at = |v| sampled(&picture, [Wrap::Clamp; 2], Vec2::new(0.5, v)).x;
    assert_eq!([at(0.0), at(0.25), at(0.5), at(1.0)], [1.0, 1.0, 0.5, 0.0]);
}

#[test]
fn beyond_the_edge_the_picture_goes_on_as_it_is_told() {
    let (black, white) = ([0; 3], [255; 3]);
    let picture = texture([4, 1], &[black, black, black, white]);
    let at = |wrap, u: f32| sampled(&picture, [wrap, Wrap::Repeat], Vec2::new(u, 0.0)).x;
    let repeated = [-1.125, -0.125, 0.0, 0.875, 1.875, 5.875].map(|u| at(Wrap::Repeat, u));
    assert_eq!(repeated, [1.0, 1.0, 0.5, 1.0, 1.0, 1.0]);
    let mirrored = [-1.125, -0.875, -0.125, 0.875, 1.0, 1.125, 1.875, 2.875].map(|u| at(Wrap::Mirror, u));
    assert_eq!(mirrored, [1.0, 1.0, 0.0, 1.0, 1.0, 1.0, 0.0, 1.0]);
    let clamped = [-1.125, 0.875, 1.125, 1.875].map(|u| at(Wrap::Clamp, u));
    assert_eq!(clamped, [0.0, 1.0, 1.0, 1.0]);
}

#[test]
fn no_place_is_outside_of_the_picture() {
    let far = [f32::NAN, f32::INFINITY, -f32::INFINITY, f32::MAX, -f32::MAX, -1e-30, 1e-30, -0.0, 0.99999994, 1e9];
    for wrap in [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp] {
        for size in [1, 2, 3, 16384] {
            for place in far {
                let ([a, b], share) = neighbours(place, size, wrap);
                assert!(
                    a < size && b < size && (0.0..=1.0).contains(&share),
                    "{place} {size} {wrap:?}: {a} {b} {share}"
                );
            }
        }
    }
}

#[test]
fn a_picture_of_one_colour_is_that_colour_exactly() {
    let picture = texture([3, 3], &[[77, 3, 200]; 9]);
    for step in 0..100 {
        let place = Vec2::new(0.037 * step as f32, -0.91 * step as f32);
        assert_eq!(sampled(&picture, [Wrap::Repeat; 2], place), Encoding::Color.linear([77, 3, 200, 255]));
    }
}

const REPEATED: [Wrap; 2] = [Wrap::Repeat; 2];

/// Texels of all kinds.
fn noise(size: [u32; 2]) -> (Texture, MipLevels) {
    let texel = |index: u32| [(77 * index) as u8, (91 * index + 5) as u8, (index % 101 * index) as u8];
    let picture = texture(size, &(0..size[0] * size[1]).map(texel).collect::<Vec<_>>());
    let levels = MipLevels::new(&picture, Encoding::Color);
    (picture, levels)
}

#[test]
fn a_footprint_of_a_power_of_two_texels_sees_one_texel_of_that_level() {
    let (picture, levels) = noise([32, 16]);
    for (number, level) in levels.levels.iter().enumerate().take(4) {
        let [width, height] = level.size;
        let axes = [Vec2::new(1.0 / width as f32, 0.0), Vec2::new(0.0, 1.0 / height as f32)];
        for (column, row) in [(0, 0), (width - 1, height - 1), (width / 2, 0)] {
            let place = Vec2::new((column as f32 + 0.5) / width as f32, (row as f32 + 0.5) / height as f32);
            let texel = unpacked(level.texels[(row * width + column) as usize]);
            assert_eq!(filtered(&picture, &levels, REPEATED, place, axes), texel, "level {}", number + 1);
            // Half a power more: half of the next level.
            let between = filtered(&picture, &levels, REPEATED, place, axes.map(|axis| 1.5 * axis));
            let next = at_level(&color(&picture, REPEATED), &levels, place, number as u32 + 2);
            assert!((between - 0.5 * (texel + next)).abs().max_element() < 1e-6);
        }
    }
}

#[test]
fn a_magnified_texture_is_bilinear_to_the_bit() {
    let (picture, levels) = noise([5, 3]);
    for step in 0..50 {
        let place = Vec2::new(0.037 * step as f32, -0.91 * step as f32);
        for axes in [[Vec2::ZERO; 2], [Vec2::new(0.2, 0.0), Vec2::new(0.0, 0.33)]] {
            assert_eq!(filtered(&picture, &levels, REPEATED, place, axes), sampled(&picture, REPEATED, place));
        }
    }
}

#[test]
fn a_long_footprint_is_sharp_across_and_smooth_along() {
    let stripes: Vec<[u8; 3]> = (0..256).map(|index| [if index % 16 < 8 { 255 } else { 0 }; 3]).collect();
    let picture = texture([16, 16], &stripes);
    let levels = MipLevels::new(&picture, Encoding::Color);
    let texel = 1.0 / 16.0;
    for column in 0..16 {
        let place = Vec2::new((column as f32 + 0.5) * texel, 0.4);
        let along = [Vec2::new(texel, 0.0), Vec2::new(0.0, 12.0 * texel)];
        let wanted = if column < 8 { 1.0 } else { 0.0 };
        assert_eq!(filtered(&picture, &levels, REPEATED, place, along).x, wanted, "column {column}");
        let across = [Vec2::new(0.0, texel), Vec2::new(16.0 * texel, 0.0)];
        assert!((filtered(&picture, &levels, REPEATED, place, across).x - 0.5).abs() < 1e-6, "column {column}");
    }
}

#[test]
fn only_the_ellipse_counts_not_which_of_its_diameters_are_given() {
    let (picture, levels) = noise([64, 64]);
    let (long, short) = (Vec2::new(0.15, 0.06), Vec2::new(-0.011, 0.028));
    for degrees in [10f32, 45.0, 77.0, 90.0, 200.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let turned = [cos * long + sin * short, cos * short - sin * long];
        for place in [Vec2::new(0.3, 0.8), Vec2::new(0.91, 0.02)] {
            let [a, b] = [[long, short], turned].map(|axes| filtered(&picture, &levels, REPEATED, place, axes));
            assert!((a - b).abs().max_element() < 2e-3, "{degrees}: {a} {b}");
        }
    }
}

#[test]
fn the_mean_over_all_places_is_that_of_the_image() {
    for (size, wrap) in
        [([8, 8], Wrap::Repeat), ([7, 5], Wrap::Repeat), ([1, 13], Wrap::Repeat), ([12, 6], Wrap::Mirror)]
    {
        let (picture, levels) = noise(size);
        let whole = unpacked(levels.levels.last().unwrap().texels[0]);
        for axes in [[Vec2::new(0.3, 0.1), Vec2::new(-0.1, 0.4)], [Vec2::new(0.9, 0.0), Vec2::new(0.02, 0.1)]] {
            // The mirrored image has twice the period.
            let places = 280 * 2;
            let place = |index: usize| (index as f32 + 0.5) / 280.0;
            let all = (0..places).flat_map(|y| (0..places).map(move |x| Vec2::new(place(x), place(y))));
            let sum: glam::DVec3 = all.map(|at| filtered(&picture, &levels, [wrap; 2], at, axes).as_dvec3()).sum();
            let mean = (sum / (places * places) as f64).as_vec3();
            assert!((mean - whole).abs().max_element() < 2e-3, "{size:?}: {mean} {whole}");
        }
    }
}

#[test]
fn footprints_beyond_all_bounds_see_everything() {
    let (picture, levels) = noise([7, 4]);
    let whole = unpacked(levels.levels.last().unwrap().texels[0]);
    let place = Vec2::new(0.3, 0.7);
    let see = |a, b| filtered(&picture, &levels, REPEATED, place, [a, b]);
    for far in [1e3, 1e15, 1e30, f32::MAX] {
        assert_eq!(see(Vec2::new(far, 0.0), Vec2::new(0.0, far)), whole, "{far}");
        assert_eq!(see(Vec2::new(far, far), Vec2::new(far, far)), whole, "{far}, a line");
    }
    // A texture of one texel has no other levels.
    let (picture, levels) = noise([1, 1]);
    for far in [1.0, 3.0, f32::MAX] {
        let seen = filtered(&picture, &levels, [Wrap::Clamp; 2], place, [Vec2::new(far, 0.0), Vec2::new(0.0, far)]);
        assert!((seen - sampled(&picture, REPEATED, place)).abs().max_element() < 1e-6);
    }
}

#[test]
fn levels_follow_the_width() {
    assert_eq!(level_of(1.0, 5), (0, 0.0));
    assert_eq!([2.0, 3.0, 7.0, 16.0].map(|width| level_of(width, 5)), [(1, 0.0), (1, 0.5), (2, 0.75), (4, 0.0)]);
    assert_eq!([32.0, 33.0, f32::MAX].map(|width| level_of(width, 5)), [(5, 0.0); 3]);
    assert_eq!(level_of(1.5, 0), (0, 0.0));
}

#[test]
fn beyond_the_border_of_a_clamped_texture_only_the_border_is_seen() {
    let mut picture = texture([32, 32], &[[0; 3]; 1024]);
    picture.texels[0] = [255; 4];
    let levels = MipLevels::new(&picture, Encoding::Color);
    let axes = [Vec2::new(0.3, 0.0), Vec2::new(0.0, 0.3)];
    let see = |u, v| filtered(&picture, &levels, [Wrap::Clamp; 2], Vec2::new(u, v), axes).x;
    assert_eq!(see(-1.0, -5.0), 1.0, "the white corner");
    assert_eq!([see(-1.0, 0.5), see(2.0, -5.0), see(0.9, 0.9)], [0.0; 3]);
    // Next to the corner, the first texel of the column.
    let beside = see(-1.0, 0.0);
    assert!(beside > 0.1 && beside < 0.5, "{beside}");
}
