//! Stage by stage: hits, masks, used light points, their visibility, and the visibility at surface points.

use std::collections::BTreeMap;

use lightmesh_render::accel::Hit;
use lightmesh_render::backend::{
    Backend, Cpu, Cuda, DeviceHits, DeviceLightPointVisibility, DevicePoints, DeviceRays, DeviceScene, Seen,
    ShadowTarget, Wave, WaveOf,
};
use lightmesh_render::light_mesh::{Lattice, LightMesh, Template, UsedPoints};
use lightmesh_render::{
    LightGroup, LightPointVisibility, RayList, RenderContext, Sampling, ShortTests, Unobserved, Visibility,
    VisibilityOfLight,
};
use lightmesh_scene::Weight;

use crate::scenes::{SUBJECTS, Subject, THICKET};
use crate::trials::{Case, Target};

/// Image size of the cases that compare hits.
const HITS: [u32; 2] = [64, 64];
/// Image size of all others: no multiple of any tile.
const SIZE: [u32; 2] = [45, 37];
/// Image size of scenes with many triangles, and of cases with large templates.
const SMALL: [u32; 2] = [18, 13];
/// Image size of those in which threads have more rays than one launch casts.
const TINY: [u32; 2] = [7, 5];
const MANY_SAMPLES: u32 = 300;
/// Shares may differ by what the order of a sum and square roots of weights change.
pub(crate) const SHARE_TOLERANCE: f32 = 1e-5;

pub(crate) fn cases<R: Target>() -> Vec<Case<R>> {
    let mut cases = Vec::new();
    for subject in &SUBJECTS {
        for (index, name) in ["bvh", "grid", "brute_force"].into_iter().enumerate().take(R::STRUCTURES) {
            let mut add_if = |chosen: bool, what: &str, run: fn(&Cuda<R>, &'static Subject, usize)| {
                let name = format!("{}::{name}::{what}", subject.name);
                cases.push(Case::new(name, move |cuda| run(cuda, subject, index)).only_if(chosen));
            };
            // All triangles for each ray take long in large scenes: one of them does.
            let quick = subject.small || name != "brute_force" || subject.name == "gazebo";
            add_if(quick, "hits", |cuda, subject, index| drop(Twins::new(cuda, subject, index, HITS)));
            let mut add = |what: &str, run| add_if(true, what, run);
            if subject.small || name != "brute_force" {
                add("shadow_rays", |cuda, subject, index| {
                    Twins::new(cuda, subject, index, size(subject)).shadow_rays()
                });
                add("occluder_lists", |cuda, subject, index| {
                    Twins { samples: 16, ..Twins::new(cuda, subject, index, size(subject)) }.occluder_lists();
                });
                add("adaptive_shadows", |cuda, subject, index| {
                    Twins { samples: 16, ..Twins::new(cuda, subject, index, size(subject)) }.adaptive_shadows();
                });
                add("light_mesh_2.1", |cuda, subject, index| {
                    // One image has so many cells that some of a tile have the same hash.
                    let size = if subject.name == "childpark" && index == 0 { SIZE } else { size(subject) };
                    Twins::new(cuda, subject, index, size).light_mesh(2.1, Weight::Smooth);
                });
                add("light_mesh_3.1", |cuda, subject, index| {
                    Twins::new(cuda, subject, index, size(subject)).light_mesh(3.1, Weight::Quadratic);
                });
            }
            if subject.small && name == "bvh" {
                add("many_samples", |cuda, subject, index| {
                    let twins = Twins { samples: MANY_SAMPLES, ..Twins::new(cuda, subject, index, TINY) };
                    twins.shadow_rays();
                    for samples in [1, 2, 13, 64, 256, MANY_SAMPLES] {
                        let twins = Twins { samples, ..Twins::new(cuda, subject, index, SMALL) };
                        twins.occluder_lists();
                        twins.adaptive_shadows();
                    }
                    twins.light_mesh(0.5, Weight::Constant);
                });
                // Templates of one brick and of many, masks inside and outside shared memory, kernels unrolled and not: what lights
                // there are does not matter.
                let chosen = matches!(subject.name, "soup" | "half_plane" | "empty");
                add_if(chosen, "light_mesh_other", |cuda, subject, index| {
                    let twins = Twins::new(cuda, subject, index, SMALL);
                    for radius in [0.5, 1.5, 4.1, 5.1, 9.0, 16.0] {
                        twins.light_mesh(radius, Weight::Constant);
                    }
                });
            }
        }
    }
    cases.push(Case::new("thicket::bvh::occluder_lists".to_owned(), |cuda| {
        Twins { samples: 16, ..Twins::new(cuda, &THICKET, 0, SMALL) }.occluder_lists();
    }));
    cases
}

fn size(subject: &Subject) -> [u32; 2] {
    if subject.runs_whole() { SIZE } else { SMALL }
}

/// The same rays and hits on both sides.
struct Twins<'a, R: Target> {
    cuda: &'a Cuda<R>,
    subject: &'static Subject,
    size: [u32; 2],
    scene: &'static lightmesh_render::PreparedScene,
    rays: RayList,
    hits: Vec<Hit>,
    device_scene: DeviceScene<R>,
    device_rays: DeviceRays<R>,
    device_hits: DeviceHits<R>,
    /// Rays to each area light.
    samples: u32,
}

fn context(samples: u32) -> RenderContext<'static> {
    RenderContext::new(&Unobserved, Sampling { samples, seed: 5, spread: true })
}

impl<'a, R: Target> Twins<'a, R> {
    /// Step 1. The hits are bit-identical.
    fn new(cuda: &'a Cuda<R>, subject: &'static Subject, acceleration: usize, size: [u32; 2]) -> Twins<'a, R> {
        let scene = subject.prepared(acceleration);
        let view = subject.view(size);
        let rays = Cpu.camera_rays(&view, 0..size[1], 0).unwrap();
        let context = context(4);
        let hits = Cpu.primary_rays(&context, scene, &rays).unwrap();
        let device_rays = cuda.camera_rays(&view, 0..size[1], 0).unwrap();
        let device_scene = cuda.scene(&context, scene, None).unwrap();
        let device_hits = cuda.primary_rays(&context, &device_scene, &device_rays).unwrap();
        let found = device_hits.read().unwrap();
        assert_eq!(found.len(), hits.len());
        for (hit, &pixel) in hits.iter().zip(&rays.pixels) {
            let twin = &found[pixel as usize];
            assert_eq!(bits(hit), bits(twin), "pixel {pixel}: {hit:?} on the CPU, {twin:?} on the device");
        }
        Twins {
            cuda,
            subject,
            size,
            scene,
            rays,
            hits,
            device_scene,
            device_rays,
            device_hits,
            samples: context.sampling.samples,
        }
    }

    fn context(&self) -> RenderContext<'static> {
        context(self.samples)
    }

    fn on_host<'b>(&'b self, context: &'b RenderContext<'b>) -> WaveOf<'b, Cpu> {
        Wave { context, scene: self.scene, rays: &self.rays, hits: &self.hits, lights: LightGroup::ALL, parts: 1 }
    }

    fn on_device<'b>(&'b self, context: &'b RenderContext<'b>) -> WaveOf<'b, Cuda<R>> {
        Wave {
            context,
            scene: &self.device_scene,
            rays: &self.device_rays,
            hits: &self.device_hits,
            lights: LightGroup::ALL,
            parts: 1,
        }
    }

    /// Shadow rays, one and many per light.
    fn shadow_rays(&self) {
        let context = self.context();
        let host = Cpu.shadow_rays(&self.on_host(&context), &ShadowTarget::Center).unwrap();
        let device = self.cuda.shadow_rays(&self.on_device(&context), &ShadowTarget::Center).unwrap();
        self.same_shares("hard shadows", &host, &device.read().unwrap(), 0.0, 0);
        let host = Cpu.shadow_rays(&self.on_host(&context), &ShadowTarget::Area(context.sampling)).unwrap();
        let device = self.cuda.shadow_rays(&self.on_device(&context), &ShadowTarget::Area(context.sampling)).unwrap();
        let allowed = R::allowed(host.share.len(), 1000);
        self.same_shares("area shadows", &host, &device.read().unwrap(), 0.0, allowed);
    }

    /// Samples in rows, each surface point on its own and by lists: the same bits.
    fn occluder_lists(&self) {
        let context = self.context();
        let (host, device) = (self.on_host(&context), self.on_device(&context));
        let target = ShadowTarget::Area(context.sampling);
        let expected = Cpu.area_shadows(&host, &target).unwrap();
        let lists = Cpu.occluder_lists(&host, &Cpu.bundles(&host).unwrap(), &target).unwrap();
        let same = (expected.share.iter().zip(&lists.share)).all(|(a, b)| a.to_bits() == b.to_bits());
        assert!(same, "{} samples: lists on the CPU", self.samples);
        let found = self.cuda.area_shadows(&device, &target).unwrap();
        self.same_shares("samples in rows", &expected, &found.read().unwrap(), 0.0, 0);
        let bundles = self.cuda.bundles(&device).unwrap();
        let found = self.cuda.occluder_lists(&device, &bundles, &target).unwrap();
        self.same_shares("occluder lists", &expected, &found.read().unwrap(), 0.0, 0);
    }

    /// One ray and more, of the whole image and of rows in its middle: the same bits.
    fn adaptive_shadows(&self) {
        let context = self.context();
        let target = ShadowTarget::Area(context.sampling);
        let host = Cpu.adaptive_shadows(&self.on_host(&context), &target).unwrap();
        let device = self.cuda.adaptive_shadows(&self.on_device(&context), &target).unwrap().read().unwrap();
        let allowed = R::allowed(host.share.len(), 1000);
        self.same_shares("adaptive shadow rays", &host, &device, 0.0, allowed);

        let [width, height] = self.size;
        let rows = height / 3..height / 3 + 2;
        let rays = self.cuda.camera_rays(&self.subject.view(self.size), rows.clone(), 0).unwrap();
        let hits = self.cuda.primary_rays(&context, &self.device_scene, &rays).unwrap();
        let wave = Wave {
            context: &context,
            scene: &self.device_scene,
            rays: &rays,
            hits: &hits,
            lights: LightGroup::ALL,
            parts: 1,
        };
        let band = self.cuda.adaptive_shadows(&wave, &target).unwrap().read().unwrap();
        let planes = device.chunks_exact(self.rays.pixels.len()).zip(band.chunks_exact((2 * width) as usize));
        for (light, (whole, band)) in planes.enumerate() {
            assert_eq!(band, &whole[(rows.start * width) as usize..][..band.len()], "rows of light {light}");
        }
    }

    /// Steps 2 to 5.
    fn light_mesh(&self, radius: f32, weight: Weight) {
        let step = self.subject.step;
        let mesh = LightMesh {
            lattice: Lattice::around(self.scene, step, radius).unwrap(),
            template: Template::new(radius).unwrap(),
            radius: radius * step,
            weight,
        };
        let (context, plain) = (self.context(), self.context().with_short_tests(ShortTests::Plain));
        let wave = self.on_host(&context);
        let cells = Cpu.cells(&wave, &mesh).unwrap();
        let masks = Cpu.short_tests(&wave, &cells, &mesh).unwrap();
        let mut expected: Vec<(u32, Vec<u32>)> = (cells.members().iter().enumerate())
            .map(|(slot, &ray)| (self.rays.pixels[ray as usize], masks.mask(slot).to_vec()))
            .collect();
        expected.sort_unstable();
        let device_cells = self.cuda.cells(&self.on_device(&context), &mesh).unwrap();
        let on_device = |context| self.cuda.short_tests(&self.on_device(context), &device_cells, &mesh).unwrap();
        for context in [&plain, &context] {
            let found = on_device(context).read(&device_cells).unwrap();
            let found: Vec<_> = found.into_iter().map(|(ray, _, mask)| (ray, mask)).collect();
            let how = context.short_tests;
            assert_eq!(found.len(), expected.len(), "{how:?}: surface points");
            for (found, expected) in found.iter().zip(&expected) {
                assert_eq!(found, expected, "{how:?}: pixel and mask");
            }
        }

        let device_masks = on_device(&context);
        let points = Cpu.light_points(&context, &cells, &masks, &mesh).unwrap();
        let device_points = self.cuda.light_points(&context, &device_cells, &device_masks, &mesh).unwrap();
        same_points(&points, &device_points);

        let lit = Cpu.long_tests(&wave, &points, &mesh, None).unwrap();
        let device_lit = self.cuda.long_tests(&self.on_device(&context), &device_points, &mesh, None).unwrap();
        same_light(&points, &lit, &device_points, &device_lit);

        let seen = Seen { mesh: &mesh, cells: &cells, masks: &masks, points: &points, lit: &lit };
        let host = Cpu.interpolate(&wave, &seen).unwrap();
        let (cells, masks, points, lit) = (&device_cells, &device_masks, &device_points, &device_lit);
        let seen = Seen { mesh: &mesh, cells, masks, points, lit };
        let device = self.cuda.interpolate(&self.on_device(&context), &seen).unwrap();
        let allowed = R::allowed(host.share.len(), 100);
        self.same_shares("interpolated", &host, &device.read().unwrap(), SHARE_TOLERANCE, allowed);
    }

    /// Both have shares by light; within a light, the CPU's are in the order of its rays, the device's by pixel.
    fn same_shares(&self, what: &str, host: &Visibility, device: &[f32], tolerance: f32, allowed: usize) {
        assert_eq!(host.share.len(), device.len(), "{what}");
        let rays = self.rays.pixels.len();
        let mut differ = Vec::new();
        for light in 0..host.share.len() / rays {
            for (ray, &pixel) in self.rays.pixels.iter().enumerate() {
                let (a, b) = (host.of(light, ray), device[light * rays + pixel as usize]);
                if !alike(a, b, tolerance) {
                    differ.push((pixel, light, a, b));
                }
            }
        }
        assert!(differ.len() <= allowed, "{what}: pixel, light, share on the CPU and on the device: {differ:?}");
    }
}

/// Whether two shares differ by at most `tolerance`; NaN equals nothing.
pub(crate) fn alike(a: f32, b: f32, tolerance: f32) -> bool {
    (a - b).abs() <= tolerance
}

fn bits(hit: &Hit) -> [u32; 4] {
    [hit.t.to_bits(), hit.u.to_bits(), hit.v.to_bits(), hit.triangle]
}

/// Step 3: the same bricks with the same points.
fn same_points<R: Target>(host: &UsedPoints, device: &DevicePoints<R>) {
    let expected: BTreeMap<u64, u64> = host.bricks().keys().iter().copied().zip(host.used().iter().copied()).collect();
    let found: BTreeMap<u64, u64> =
        device.read_bricks().unwrap().into_iter().map(|(_, key, used)| (key, used)).collect();
    assert_eq!(found, expected, "used light points by brick");
}

/// Step 4: every light point sees the same of every light. The device has one word per slot of its table for each light without an
/// area, then one number per light point, by rank, for each area light.
fn same_light<R: Target>(
    points: &UsedPoints,
    lit: &LightPointVisibility,
    device_points: &DevicePoints<R>,
    device_lit: &DeviceLightPointVisibility<R>,
) {
    let (bricks, ranks) = (device_points.read_bricks().unwrap(), device_points.read_ranks().unwrap());
    let (bits, counts) = device_lit.read().unwrap();
    let plain = lit.lights.iter().filter(|light| matches!(light, VisibilityOfLight::Bits(_))).count();
    let slots = bits.len() / plain.max(1);
    let (mut next_bits, mut next_count) = (0, 0);
    let mut differ = Vec::new();
    for (light, host) in lit.lights.iter().enumerate() {
        for &(slot, key, used) in &bricks {
            let brick = points.bricks().find(key).expect("the bricks are the same");
            match host {
                VisibilityOfLight::Bits(words) => {
                    assert_eq!(bits[next_bits + slot] & used, words[brick] & used, "light {light}, brick {key}");
                }
                VisibilityOfLight::Share { seen, .. } => {
                    for bit in (0..64).filter(|bit| used >> bit & 1 == 1) {
                        let rank = ranks[slot] + (used & ((1 << bit) - 1)).count_ones();
                        let (a, b) = (seen[points.rank(brick, bit)], counts[next_count + rank as usize]);
                        if a != b {
                            differ.push((light, key, bit, a, b));
                        }
                    }
                }
            }
        }
        match host {
            VisibilityOfLight::Bits(_) => next_bits += slots,
            VisibilityOfLight::Share { .. } => next_count += points.count(),
        }
    }
    let allowed = R::allowed(next_count, 1000);
    assert!(differ.len() <= allowed, "light, brick, point, rays on the CPU and on the device: {differ:?}");
}
