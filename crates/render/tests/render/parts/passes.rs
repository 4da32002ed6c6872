use glam::{DVec3, Vec3};
use lightmesh_image::Layers;
use lightmesh_render::internals::antialiasing::Antialiasing;
use lightmesh_render::internals::passes::Chosen;
use lightmesh_render::internals::probes::ROW;
use lightmesh_render::{
    Acceleration, Filter, GivenPoints, LightGroups, Lookup, Mode, Plan, PreparedScene, RenderContext, RenderError,
    Sampling, Settings, Step, Unobserved,
};
use lightmesh_scene::LightKind;
use lightmesh_testkit::pile;

use super::plain;

const LIGHTS: usize = 9;

/// A pile of mirrors under a ring of lights.
fn scene() -> PreparedScene {
    let ball = |index: usize| {
        let (z, x) = (index as f32).sin_cos();
        LightKind::Sphere { position: Vec3::new(2.0 * x, 2.5, 2.0 * z), radius: 0.3 }
    };
    let mut scene = pile(DVec3::ZERO, &std::array::from_fn::<_, LIGHTS, _>(ball));
    let material = scene.geometry.materials[0].clone().with_ks([0.4, 0.3, 0.2]);
    scene.geometry_mut().materials.fill(material);
    PreparedScene::new(&scene, &Acceleration::Bvh, &Unobserved).unwrap()
}

/// An image in all modes: how it differs between plans.
struct Way {
    settings: Settings,
    scene: PreparedScene,
    samples: Option<Antialiasing>,
}

/// Bits of colours, with layers and the rows at once.
type Bits = (Vec<[u32; 3]>, Layers, u32);

impl Way {
    fn all() -> impl Iterator<Item = Way> {
        let modes = [
            (Mode::LightMesh, Lookup::Lists),
            (Mode::LightMesh, Lookup::Adaptive),
            (Mode::LightMesh, Lookup::HalfBall),
            (Mode::Area, Lookup::Auto),
            (Mode::RayTrace, Lookup::Auto),
        ];
        modes.into_iter().flat_map(|(mode, lookup)| {
            let settings = Settings::default().with_mode(mode).with_lookup(lookup).with_size([24, 18]);
            let settings = settings.with_step(Step::Fixed(0.2));
            let all = Antialiasing::new(6, Filter::BlackmanHarris, 0, 9);
            let several = Antialiasing { mirrors: true, keeps: lookup == Lookup::Adaptive, ..all };
            let apart = Antialiasing { apart: true, ..several.clone() };
            [None, Some(several), Some(apart)].map(|samples| Way {
                settings: settings.clone(),
                scene: scene(),
                samples,
            })
        })
    }

    /// The picture with `at_once` lights and `left` bytes; an error if these do not suffice.
    fn picture(&self, at_once: usize, left: Option<u64>) -> Result<Bits, RenderError> {
        let Way { settings, scene, samples } = self;
        let technique = Chosen::new(scene, settings, scene.geometry.bounds)?;
        let lights = LightGroups { lights: LIGHTS, at_once };
        let bytes_per_ray = technique.bytes_per_ray(lights.held() as u64);
        let (size, layers) = (settings.size, Some(LIGHTS));
        let plan = Plan {
            antialiasing: samples.clone(),
            bounces: 2,
            coverage: true,
            layers,
            compositing: true,
            bytes_per_ray,
            ..plain(size, lights, left)
        };
        let context = RenderContext::new(&Unobserved, Sampling { samples: 9, seed: 0, spread: true });
        let (mut picture, rows) = technique.picture(&context, &plan)?;
        assert!(context.work.is_done(), "{settings:?}: {:?}", context.work);
        let layers = picture.layers.take().unwrap();
        if let Some(samples) = samples {
            // A pixel is covered by samples: those with a depth by some, those without by none.
            let samples = samples.samples as f32;
            for (covered, depth) in picture.coverage.iter().flatten().zip(&layers.depth) {
                assert!((samples * covered - (samples * covered).round()).abs() < 1e-4 && *covered < 1.001);
                assert_eq!(*covered > 0.0, depth.is_finite(), "{settings:?}: coverage");
            }
        }
        Ok((bytemuck::cast_vec(picture.color), layers, rows))
    }
}

#[test]
fn groups_of_lights_give_the_same_picture() {
    for way in Way::all().filter(|way| way.settings.lookup != Lookup::HalfBall) {
        let whole = way.picture(usize::MAX, None).unwrap();
        let soft = whole.1.visibility.iter().flatten().any(|share| *share > 0.0 && *share < 1.0);
        assert!(soft || way.settings.mode == Mode::RayTrace);
        for at_once in [1, 4] {
            assert!(way.picture(at_once, None).unwrap() == whole, "{:?}: {at_once} lights at once", way.settings);
        }
    }
}

#[test]
fn bands_give_the_same_picture() {
    for way in Way::all() {
        let (color, layers, rows) = way.picture(usize::MAX, None).unwrap();
        assert_eq!(rows, way.settings.size[1]);
        let Err(RenderError::Memory { short, .. }) = way.picture(usize::MAX, Some(1)) else {
            panic!("one byte must not suffice")
        };
        // Just enough for one row, then for some.
        for left in [short.needed, short.needed + if way.samples.is_some() { 100_000 } else { 40_000 }] {
            let banded = way.picture(usize::MAX, Some(left)).unwrap();
            assert!((1..rows).contains(&banded.2), "{:?}", way.settings);
            assert!(banded == (color.clone(), layers.clone(), banded.2), "{:?}", way.settings);
        }
    }
}

#[test]
fn bands_of_given_points_change_nothing() {
    let scene = scene();
    let places = (0..12_000).map(|i| Vec3::new((i % 109) as f32 / 31.0 - 1.7, 0.0, (i / 109) as f32 / 31.0 - 1.7));
    let places: Vec<Vec3> = places.collect();
    let normals = vec![Vec3::Y; places.len()];
    let points = GivenPoints::new(&scene, &places, &normals).unwrap();
    for way in Way::all() {
        let settings = &way.settings;
        let technique = Chosen::new(&scene, settings, points.bounds).unwrap();
        let lights = LightGroups { lights: LIGHTS, at_once: usize::MAX };
        let bytes_per_ray = technique.bytes_per_ray(LIGHTS as u64);
        let size = [ROW, points.rows()];
        let baked = |left| {
            let plan = Plan { bytes_per_ray, ..plain(size, lights, left) };
            let context = RenderContext::new(&Unobserved, Sampling { samples: 9, seed: 0, spread: true });
            technique.baked(&context, &plan, &points)
        };
        let (whole, rows) = baked(None).unwrap();
        assert_eq!(rows, points.rows());
        let Err(RenderError::Memory { short, .. }) = baked(Some(1)) else { panic!("one byte must not suffice") };
        let (limited, rows) = baked(Some(short.needed)).unwrap();
        assert!(rows == 1 && limited.share == whole.share, "{settings:?}: {rows} rows");
    }
}

#[test]
fn memory_does_not_grow_with_lights() {
    let scene = scene();
    for (mode, lookup, most) in [
        (Mode::LightMesh, Lookup::Lists, 32),
        (Mode::LightMesh, Lookup::Adaptive, 40),
        (Mode::Area, Lookup::Auto, 32),
        (Mode::RayTrace, Lookup::Auto, 32),
    ] {
        let settings = Settings::default().with_mode(mode).with_lookup(lookup);
        let technique = Chosen::new(&scene, &settings, scene.geometry.bounds).unwrap();
        for lights in [1, 4, 16, 64, 256] {
            let groups = LightGroups { lights, at_once: technique.lights_at_once() };
            let bytes_per_ray = technique.bytes_per_ray(groups.held() as u64);
            assert!(bytes_per_ray.host.max(bytes_per_ray.device) <= most, "{mode:?} {lookup:?}: {bytes_per_ray:?}");
            assert!(bytes_per_ray.host.min(bytes_per_ray.device) >= 4, "{mode:?} {lookup:?}: {bytes_per_ray:?}");
        }
    }
}
