//! Rough floors mirror what is above them as the formula of facets says: rays in some directions, with highlights of lights.

use glam::{DVec3, Vec3};
use lightmesh_render::internals::shading::{Coefficients, Lobe, Sight};
use lightmesh_render::{AmbientSource, Frame, Quality, Settings};
use lightmesh_scene::{Camera, Facets, Falloff, Light, Lighting, Lights, Material, Scene, Up};
use lightmesh_testkit::{SceneDraft, render};

const EYE: Vec3 = Vec3::new(0.0, 1.0, 2.0);
/// Half of the width and of the height of the panel, which stands behind the floor's middle.
const HALF: [f32; 2] = [0.8, 0.3];
const PANEL: Vec3 = Vec3::new(0.0, 1.0, -2.0);

fn metal(roughness: f32) -> (Facets, Material) {
    let facets = Facets::new(roughness).with_metallic(1.0);
    (facets, Material::matt(Vec3::ONE).with_facets(facets))
}

/// A rough metal floor, and a panel of radiance 1 that faces the camera.
fn floor(roughness: f32) -> Scene {
    let [x, y] = HALF;
    let corner = |right: f32, up: f32| (PANEL + Vec3::new(right * x, up * y, 0.0)).as_dvec3().to_array();
    SceneDraft::new()
        .painted(metal(roughness).1)
        .floor(0.0, 1.0)
        .painted(Material::matt(Vec3::ZERO).with_emission([1.0; 3]))
        .quad([corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)])
        .background(Vec3::ZERO)
        .ambient(0.0)
        .camera(EYE.as_dvec3().to_array(), [0.0, 0.0, 0.0])
        .finish("rough floor")
}

/// What the middle of the floor shows of the panel, by numbers.
fn expected(roughness: f32) -> f32 {
    const STEPS: i32 = 300;
    let eye = EYE.normalize();
    let none = Vec3::ZERO;
    let mut coefficients = Coefficients {
        ka: none,
        kd: Vec3::ONE,
        ks: none,
        emission: none,
        transmittance: none,
        opacity: 1.0,
        roughness,
        metallic: 1.0,
        all: none,
        mirrored: none,
    };
    let sight = Sight { cosine: eye.y, spread: 0.0, followed: false, mirrored: false };
    let lobe = Lobe::new(&metal(roughness).0, &mut coefficients, &sight);
    let place = |index: i32, half: f32| half * (2.0 * (index as f32 + 0.5) / STEPS as f32 - 1.0);
    let part = |index: i32| {
        let way = PANEL + Vec3::new(place(index / STEPS, HALF[0]), place(index % STEPS, HALF[1]), 0.0);
        let square = way.length_squared();
        let direction = way / square.sqrt();
        let solid_angle = 4.0 * HALF[0] * HALF[1] * direction.z.abs() / square;
        direction.y * solid_angle * lobe.toward(Vec3::Y, eye, direction, 0.0).x
    };
    (0..STEPS * STEPS).map(part).sum::<f32>() / (STEPS * STEPS) as f32 / std::f32::consts::PI
}

/// The image around the floor's middle, a spot so small that all of its pixels show the same.
fn spot(scene: &Scene, aa: u32) -> Frame {
    let mut scene = scene.clone();
    scene.cameras = vec![Camera::look_at(EYE, Vec3::ZERO, Vec3::Y, 0.5).unwrap()];
    render(&scene, &Settings::default().with_aa(aa).with_size([24, 24]).with_bounces(1))
}

/// The mean and the standard deviation of the pixels.
fn spread(frame: &Frame) -> [f32; 2] {
    let values: Vec<f32> = frame.color().iter().map(|color| color[0]).collect();
    let count = values.len() as f32;
    let mean = values.iter().sum::<f32>() / count;
    [mean, (values.iter().map(|value| (value - mean).powi(2)).sum::<f32>() / count).sqrt()]
}

#[test]
fn a_rough_floor_shows_as_much_of_a_panel_as_the_formula_says() {
    for roughness in [0.1, 0.2, 0.35, 0.5] {
        let [mean, noise] = spread(&spot(&floor(roughness), 8));
        let right = expected(roughness);
        assert!((mean / right - 1.0).abs() < 0.03, "{roughness}: {mean}, not {right}");
        assert!(noise < 0.06, "{roughness}: {noise} of {mean}");
    }
}

#[test]
fn a_light_is_as_bright_in_a_rough_floor_whether_rays_or_highlights_show_it() {
    for roughness in [0.15, 0.2, 0.25, 0.35] {
        let draft = SceneDraft::new().painted(metal(roughness).1).floor(0.0, 1.0).background(Vec3::ZERO).ambient(0.0);
        let mut scene = draft.camera(EYE.as_dvec3().to_array(), [0.0; 3]).finish("rough floor");
        // Of radiance 1: its strength is that along the normal, radiance times area.
        let panel = Light::rectangle(PANEL, HALF[0] * Vec3::X, HALF[1] * Vec3::Y).unwrap();
        let area = 4.0 * HALF[0] * HALF[1];
        let light = panel.with_surface(Vec3::Z).with_falloff(Falloff::InverseSquare);
        scene.lights.list = vec![light.with_intensity(Vec3::splat(area))];
        let [mean, _] = spread(&spot(&scene, 8));
        let right = expected(roughness);
        assert!((mean / right - 1.0).abs() < 0.08, "{roughness}: {mean}, not {right}");
    }
}

/// Deviations of neighbours cancel, more than those of independent pixels, whose means of 16 deviate by a quarter.
#[test]
fn neighbouring_pixels_err_in_different_directions() {
    for (roughness, aa) in [(0.2, 4), (0.35, 4), (0.5, 16)] {
        let frame = spot(&floor(roughness), aa);
        let [mean, single] = spread(&frame);
        let block = |column: usize, row: usize| {
            let pixels = (0..16).map(|index| (4 * row + index / 4) * 24 + 4 * column + index % 4);
            pixels.map(|pixel| frame.color()[pixel][0]).sum::<f32>() / 16.0
        };
        let blocks = (0..36).map(|index| (block(index % 6, index / 6) - mean).powi(2));
        let together = (blocks.sum::<f32>() / 36.0).sqrt();
        assert!(together < 0.18 * single, "{roughness}: {together} of {single}");
    }
}

/// Metals in a studio show its soft boxes, not the key light that stands for one of them: nothing is brighter than its panorama, also where what is
/// seen in a mirror mirrors nothing more.
#[test]
fn metals_in_a_studio_are_no_brighter_than_its_panorama() {
    let draft = SceneDraft::new().painted(metal(0.2).1).floor(0.0, 4.0).painted(metal(0.1).1);
    let balls = draft.smooth_ball(DVec3::new(0.0, 0.8, 0.0), 0.8, [24, 48]).smooth_ball(
        DVec3::new(1.2, 0.5, 1.0),
        0.5,
        [24, 48],
    );
    let mut scene = balls.camera([2.0, 3.0, 5.0], [0.3, 0.5, 0.2]).finish("pieces");
    scene.lights = Lights::default();
    scene.complete_with(Lighting::Studio, Up::Y, 1.0);
    assert!(scene.lights.studio);
    let texels = scene.lights.environment.as_ref().unwrap().texels();
    let most = texels.iter().map(|texel| Vec3::from_array(*texel).max_element()).fold(0.0, f32::max);
    let settings = Settings::default().with_aa(4).with_size([60, 40]).with_quality(Quality::Draft);
    let settings = settings.with_ambient_light(AmbientSource::Constant);
    for bounces in [1, 2] {
        let frame = render(&scene, &settings.clone().with_bounces(bounces));
        let brightest = frame.color().iter().map(|color| Vec3::from_array(*color).max_element()).fold(0.0, f32::max);
        assert!(brightest > 0.2 * most && brightest <= 1.02 * most, "{brightest}, {most}");
    }
}
