//! Gathered light: the same bits on the CPU and on a device, with what was gathered before or without.

use std::path::Path;

use lightmesh_render::backend::{Cpu, Cuda};
use lightmesh_render::{AmbientSource, Cache, Frame, Quality, Settings, Step, Unobserved, render_on, render_on_with};

use lightmesh_testkit::runs_all;

use crate::pictures::same_frame;
use crate::scenes::{ACCELERATIONS, GLAZED, LAMPS, STEPS, SUBJECTS, SURROUNDED, Subject};
use crate::trials::{Case, Target};

const SIZE: [u32; 2] = [33, 27];
/// A quarter of the pixels, for scenes with many triangles, and for what is kept from image to image.
const SMALL: [u32; 2] = [17, 13];

/// What is gathered depends on lights, opacity and instances: these subjects have lamps, glass, cut-outs, instances and surroundings.
const CHOSEN: [&str; 5] = ["lamps", "glazed", "cut_outs", "instances", "surrounded"];
/// One scene with many triangles.
const LARGE: &str = "childpark";

pub(crate) fn cases<R: Target>() -> Vec<Case<R>> {
    let mut cases = Vec::new();
    for subject in SUBJECTS.iter().chain([&SURROUNDED, &LAMPS, &GLAZED]) {
        let chosen = CHOSEN.contains(&subject.name);
        let structures = if subject.small { R::STRUCTURES } else { 2 };
        for structure in 0..structures {
            let name = format!("{}::irradiance_cache::{structure}", subject.name);
            let of_large = subject.name == LARGE && structure == 0;
            let case = Case::new(name, move |cuda| same_light(cuda, subject, structure));
            // All triangles for each ray take long: the lamps' few do.
            let quick = structure < 2 || subject.name == "lamps";
            cases.push(case.only_if(chosen && quick || of_large));
        }
        let name = format!("{}::irradiance_cache::kept", subject.name);
        cases.push(Case::new(name, move |cuda| same_as_without(cuda, subject)).only_if(chosen));
        let name = format!("{}::irradiance_cache::files", subject.name);
        cases.push(Case::new(name, move |cuda| same_files(cuda, subject)).only_if(chosen));
    }
    cases.push(Case::new("steps::irradiance_cache::0".to_owned(), |cuda| same_light(cuda, &STEPS, 0)));
    for subject in [&SURROUNDED, &LAMPS] {
        let name = format!("{}::irradiance_cache::rays", subject.name);
        cases.push(Case::new(name, move |cuda| same_by_rays(cuda, subject)));
    }
    cases
}

fn settings(subject: &'static Subject, to_the_right: f32, size: [u32; 2]) -> Settings {
    let scene = subject.scene();
    let camera = scene.cameras.first().cloned().unwrap_or_else(|| scene.default_camera(Default::default()));
    let (right, ..) = camera.basis();
    let position = camera.position + to_the_right * subject.step * right;
    let settings = Settings::default().with_ambient_light(AmbientSource::Mesh).with_quality(Quality::Draft);
    let settings = settings.with_size(size).with_samples(4).with_step(Step::Fixed(subject.step)).with_aa(1);
    settings.with_camera(camera.with_position(position)).with_bounces(1).with_layers(true)
}

/// What belongs to no light: emitted and gathered light.
fn gathered(frame: &Frame) -> Vec<[u32; 3]> {
    frame.layers().expect("asked for").rest.iter().map(|color| color.map(f32::to_bits)).collect()
}

fn same_light<R: Target>(cuda: &Cuda<R>, subject: &'static Subject, structure: usize) {
    let scene = subject.prepared(structure);
    let size = if subject.runs_whole() { SIZE } else { SMALL };
    let settings = settings(subject, 0.0, size).with_acceleration(ACCELERATIONS[structure].clone());
    let [host, device] = same_frame(cuda, scene, settings);
    let is_lit = !scene.geometry.triangles.stored().is_empty() && !scene.scene.lights.list.is_empty();
    assert_eq!(host.stats.counts.gather_rays > 0, is_lit, "{}", host.stats.counts.gather_rays);
    if R::EXACT {
        let [host, device] = [&host, &device].map(|frame| frame.stats.counts.gather_rays);
        assert_eq!(host, device, "what is known is gathered again");
    }
    let differ = gathered(&host).iter().zip(gathered(&device)).filter(|(a, b)| **a != *b).count();
    // Where one ray to a light passes an edge, all that take light from its record differ.
    assert!(differ <= if R::EXACT { 0 } else { gathered(&host).len() / 20 }, "{differ} differ");
}

/// Without records: each surface point for itself.
fn same_by_rays<R: Target>(cuda: &Cuda<R>, subject: &'static Subject) {
    let settings = settings(subject, 0.0, SIZE).with_ambient_light(AmbientSource::Rays).with_size([9, 7]);
    let [host, device] = same_frame(cuda, subject.prepared(0), settings);
    assert!(host.stats.counts.gather_rays > 256 * host.stats.counts.hits);
    let differ = gathered(&host).iter().zip(gathered(&device)).filter(|(a, b)| **a != *b).count();
    assert!(differ <= if R::EXACT { 0 } else { 6 }, "{differ} differ");
}

/// From several places, with a cache.
fn same_as_without<R: Target>(cuda: &Cuda<R>, subject: &'static Subject) {
    let scene = subject.prepared(0);
    let (mut kept, mut on_host) = (Cache::default(), Cache::default());
    let size = if runs_all() { SIZE } else { SMALL };
    let mut rays = Vec::new();
    for to_the_right in [0.0, 1.5, 0.0] {
        let settings = settings(subject, to_the_right, size);
        let with = render_on_with(cuda, &mut kept, scene, &settings, &Unobserved).unwrap();
        let without = render_on(cuda, scene, &settings, &Unobserved).unwrap();
        assert!(gathered(&with) == gathered(&without), "{to_the_right}");
        let host = render_on_with(&Cpu, &mut on_host, scene, &settings, &Unobserved).unwrap();
        assert_eq!(with.stats.counts.gather_rays, host.stats.counts.gather_rays, "{to_the_right}");
        rays.push([with, without].map(|frame| frame.stats.counts.gather_rays));
    }
    let [first, moved, back] = [rays[0], rays[1], rays[2]];
    assert_eq!(first[0], first[1], "nothing is known");
    assert!(moved[0] <= moved[1], "some is");
    assert!(back[0] <= first[0], "all is, but for points that see no record");
}

/// Both write the same file, and each reads that of the other.
fn same_files<R: Target>(cuda: &Cuda<R>, subject: &'static Subject) {
    let folder = tempfile::tempdir().unwrap();
    let [of_device, of_host, again] = ["device.mesh", "host.mesh", "again.mesh"].map(|name| folder.path().join(name));
    let size = if runs_all() { SIZE } else { SMALL };
    let (scene, settings) = (subject.prepared(0), settings(subject, 0.0, size));
    let (mut kept, mut on_host) = (Cache::default(), Cache::default());
    let fresh = render_on_with(cuda, &mut kept, scene, &settings, &Unobserved).unwrap();
    let fresh_on_host = render_on_with(&Cpu, &mut on_host, scene, &settings, &Unobserved).unwrap();
    let saved = kept.save(&of_device, scene).unwrap();
    assert_eq!(saved.is_some(), on_host.save(&of_host, scene).unwrap().is_some());
    let Some(saved) = saved else { return };
    assert!(saved.records > 0, "{saved:?}");
    let bytes = |path: &Path| std::fs::read(path).unwrap();
    assert!(!R::EXACT || bytes(&of_device) == bytes(&of_host), "the files differ");

    // 1. The device reads what the host wrote, and the host what the device wrote.
    let mut kept = Cache::load(&of_host, scene, Default::default()).unwrap();
    let with = render_on_with(cuda, &mut kept, scene, &settings, &Unobserved).unwrap();
    let mut on_host = Cache::load(&of_device, scene, Default::default()).unwrap();
    let with_on_host = render_on_with(&Cpu, &mut on_host, scene, &settings, &Unobserved).unwrap();
    if R::EXACT {
        assert!(gathered(&with) == gathered(&fresh) && gathered(&with_on_host) == gathered(&fresh_on_host));
    }
    let rays = |frame: &Frame| frame.stats.counts.gather_rays;
    assert!(rays(&with) < rays(&fresh) && rays(&with_on_host) < rays(&fresh_on_host), "what was read is used");
    // 2. It is all there again.
    assert_eq!(on_host.save(&again, scene).unwrap().map(|again| again.records >= saved.records), Some(true));
    assert!(!R::EXACT || bytes(&again) == bytes(&of_device), "the host writes another file");
    kept.save(&again, scene).unwrap();
    assert!(!R::EXACT || bytes(&again) == bytes(&of_host), "the device writes another file");
    // 3. A device adds to what it read.
    let elsewhere = self::settings(subject, 1.5, size);
    let mut kept = Cache::load(&of_device, scene, Default::default()).unwrap();
    let with = render_on_with(cuda, &mut kept, scene, &elsewhere, &Unobserved).unwrap();
    assert!(gathered(&with) == gathered(&render_on(cuda, scene, &elsewhere, &Unobserved).unwrap()));
}
