//! How the stages are combined, for every technique: for an image, and for points given by the caller.
//!
//! An image is rendered band by band, with as many rows at once as memory allows; every band yields the same pixels as rendering
//! the whole image at once. Within a band, mirrors are a loop over waves of rays.

use std::ops::Range;

use crate::antialiasing::Antialiasing;
use crate::backend::stage_runner::StageRunner;
use crate::backend::{Backend, WaveOf};
use crate::counters::Tally;
use crate::data::lights::LightGroup;
use crate::data::picture::Picture;
use crate::data::visibility::Visibility;
use crate::error::RenderError;
use crate::plan::Plan;
use crate::prepared::TransmissionParts;
use crate::probes::GivenPoints;
use crate::settings::Glass;
use crate::shadow::ShadowTarget;
use crate::stage::Stage;
use crate::stages::irradiance_cache::Gathering;
use crate::stages::pixel_samples::SampleRange;
use crate::techniques::{Technique, VisibilitySink};
use crate::view::View;

/// A shared fragment takes this part of a pixel's samples of lights. Two or three of them make most of these pixels.
const PARTS_OF_FRAGMENT: u32 = 4;
/// A merged mirror ray takes this part. One or two of them make most of what is in a mirror.
const PARTS_OF_MERGED: u32 = 2;

/// Visibility at given points, to be computed.
pub(crate) struct Baking<'a, B: Backend> {
    pub(crate) runner: StageRunner<'a, B>,
    pub(crate) scene: &'a B::Scene,
    pub(crate) technique: &'a Technique,
    pub(crate) plan: &'a Plan,
}

impl<B: Backend> Baking<'_, B> {
    /// Finds what each probe sees of each light. Also returns how many rows of probes were processed at once.
    pub(crate) fn bake(&self, points: &GivenPoints) -> Result<(Visibility, u32), RenderError> {
        let Baking { runner, scene, technique, plan } = self;
        let stages = technique.stages().len() as u64 + u64::from(plan.transmits());
        runner.context.work.expect(points.len() as u64 * stages);
        let at_once = runner.or_evict(|backend| backend.rows_at_once(scene, plan))?;
        let mut all = Visibility::dark(0..plan.lights.lights, points.len());
        let at_once = in_bands(runner, points.rows(), at_once, |rows| {
            let range = points.range(&rows);
            let probes = points.part(&rows);
            let (scene, rays, hits) = runner.on_host(Stage::Upload, |backend| backend.probes(scene, &probes))?;
            let wave = WaveOf::<B> {
                context: runner.context,
                scene: &scene,
                rays: &rays,
                hits: &hits,
                lights: LightGroup::ALL,
                parts: 1,
            };
            let mut seen = None;
            let light = Light { runner, technique, plan };
            light.each_group(&wave, runner.backend.transmission_parts(&scene).as_ref(), &mut |visibility| {
                seen = Some(visibility);
                Ok(())
            })?;
            runner.backend.finish(runner.context)?;
            if let Some(visibility) = seen {
                let part = runner.on_host(Stage::Download, |backend| backend.visibility(visibility))?;
                all.put(range, &part);
                Tally::add(&runner.context.tally.surface_points, part.rays as u64);
            }
            Ok(())
        })?;
        Ok((all, at_once))
    }
}

/// How surface points find what they see of lights.
struct Light<'a, 'runner, B: Backend> {
    runner: &'a StageRunner<'runner, B>,
    technique: &'a Technique,
    plan: &'a Plan,
}

impl<B: Backend> Light<'_, '_, B> {
    /// Hands what each surface point of a wave sees of each light to `sink`, group by group of lights. Of a scene with `transmission_parts` only
    /// what is opaque hides, and the rest transmits, unless the plan has it open or closed.
    fn each_group(
        &self,
        wave: &WaveOf<B>,
        transmission_parts: Option<&TransmissionParts<B::Scene>>,
        sink: &mut VisibilitySink<B>,
    ) -> Result<(), RenderError> {
        let Light { runner, technique, plan } = self;
        let Some(TransmissionParts { blockers, transmissive, gi_occluders }) = transmission_parts else {
            return technique.visibility(runner, wave, plan.lights, sink);
        };
        match plan.glass {
            Glass::Tinted => {}
            Glass::Closed => return technique.visibility(runner, wave, plan.lights, sink),
            Glass::Open => {
                let wave = WaveOf::<B> { scene: gi_occluders, ..*wave };
                return technique.visibility(runner, &wave, plan.lights, sink);
            }
        }
        let wave = WaveOf::<B> { scene: blockers, ..*wave };
        let n = runner.backend.ray_count(wave.rays);
        let target = if technique.targets_centers() { ShadowTarget::Center } else { wave.shadow_target() };
        technique.visibility(runner, &wave, plan.lights, &mut |visibility| {
            sink(runner.stage(Stage::Transmittance, [n; 2], |backend| {
                backend.transmittance(&wave, transmissive, &target, visibility)
            })?)
        })
    }
}

/// Which depths of a wave are rendered: how often its rays went on at surfaces.
#[derive(Clone, Copy)]
struct Depths {
    first: u32,
    /// Whether no others follow.
    last: bool,
    /// Whether rays of a pixel that meet one surface are merged.
    merge: bool,
}

impl Depths {
    const ALL: Depths = Depths { first: 0, last: false, merge: false };
    /// What is in mirrors is rendered otherwise.
    const FIRST: Depths = Depths { last: true, ..Depths::ALL };
    /// What mirrors show of the samples of pixels.
    const MIRRORED: Depths = Depths { first: 1, merge: true, ..Depths::ALL };
}

/// The passes over one image.
pub(crate) struct Passes<'a, B: Backend> {
    pub(crate) runner: StageRunner<'a, B>,
    pub(crate) scene: &'a B::Scene,
    /// The scene taken apart for shadow rays, if some of its surfaces are not opaque.
    pub(crate) transmission_parts: Option<TransmissionParts<B::Scene>>,
    pub(crate) technique: &'a Technique,
    pub(crate) view: &'a View,
    pub(crate) plan: &'a Plan,
}

impl<B: Backend> Passes<'_, B> {
    /// Renders the whole view into `picture`, which also counts its finished rows. Returns how many rows were rendered
    /// at once.
    pub(crate) fn render(&self, picture: &mut Picture) -> Result<u32, RenderError> {
        if self.plan.antialiasing.is_none() {
            // With several samples it depends on what they see, and on the bands.
            let camera_rays = self.plan.pixels();
            self.runner.context.work.expect(camera_rays + self.pieces_of_wave(0, camera_rays));
        }
        let at_once = self.runner.or_evict(|backend| backend.rows_at_once(self.scene, self.plan))?;
        let at_once = at_once.min(self.plan.most_rows.unwrap_or(u32::MAX));
        let height = self.view.size()[1];
        in_bands(&self.runner, height, at_once, |rows| {
            let finished = rows.end;
            if self.plan.antialiasing.is_some() {
                self.runner
                    .context
                    .work
                    .begin_part([rows.start, rows.end].map(|row| f64::from(row) / f64::from(height)));
            }
            self.band(rows, picture)?;
            picture.finished = finished;
            Ok(())
        })
    }

    /// Renders some rows.
    fn band(&self, rows: Range<u32>, picture: &mut Picture) -> Result<(), RenderError> {
        let Passes { runner, scene, view, plan, .. } = self;
        let margin = plan.antialiasing.as_ref().map_or(0, Antialiasing::margin);
        let all = rows.start.saturating_sub(margin)..view.size()[1].min(rows.end.saturating_add(margin));
        let mut film = runner.on_host(Stage::Film, |backend| backend.film(plan, [all.clone(), rows]))?;
        let pixels = view.size()[0] as usize * all.len();
        if plan.antialiasing.is_some() {
            // Camera rays, and what they see.
            runner.context.work.expect(2 * pixels as u64);
        }
        let rays =
            runner.stage(Stage::CameraRays, [pixels; 2], |backend| backend.camera_rays(view, all, plan.bounces))?;
        match &plan.antialiasing {
            None => self.waves(rays, None, Depths::ALL, 1, &mut film)?,
            Some(samples) => self.samples(rays, samples, &mut film)?,
        }
        runner.backend.finish(runner.context)?;
        runner.on_host(Stage::Download, |backend| backend.develop(scene, film, picture))
    }

    /// Renders a wave of rays, and those that surfaces let through or mirror. `known` is what they see, if that is known. Each ray takes one of
    /// `parts` parts of the samples of lights.
    fn waves(
        &self,
        mut rays: B::Rays,
        mut known: Option<B::Hits>,
        depths: Depths,
        parts: u32,
        film: &mut B::Film,
    ) -> Result<(), RenderError> {
        let Passes { runner, scene, plan, .. } = self;
        for depth in depths.first.. {
            let mut n = runner.backend.ray_count(&rays);
            if n == 0 {
                break;
            }
            if depths.merge {
                // The rest once they are merged.
                runner.context.work.expect(n as u64);
            } else if depth > 0 {
                runner.context.work.expect(self.pieces_of_wave(depth, n as u64));
            }
            let mut hits = match known.take() {
                Some(hits) => hits,
                None => runner
                    .stage(Stage::PrimaryRays, [n; 2], |backend| backend.primary_rays(runner.context, scene, &rays))?,
            };
            if depths.merge {
                let wave = self.wave(&rays, &hits, parts);
                (rays, hits) = runner.stage(Stage::MergedRays, [0; 2], |backend| backend.merged_rays(&wave))?;
                n = runner.backend.ray_count(&rays);
                runner.context.work.expect(self.pieces_of_wave(depth, n as u64) - n as u64);
            }
            let wave = self.wave(&rays, &hits, parts);
            self.light(&wave, film)?;
            if depths.last || depth >= plan.bounces && !plan.is_transmissive {
                break;
            }
            rays = runner.stage(Stage::MirrorRays, [n; 2], |backend| backend.mirror_rays(&wave))?;
        }
        Ok(())
    }

    /// Rays with what they see, each of which takes one of `parts` parts of the samples of lights.
    fn wave<'w>(&'w self, rays: &'w B::Rays, hits: &'w B::Hits, parts: u32) -> WaveOf<'w, B> {
        WaveOf::<B> { context: self.runner.context, scene: self.scene, rays, hits, lights: LightGroup::ALL, parts }
    }

    /// Adds the light that a wave's surface points reflect.
    fn light(&self, wave: &WaveOf<B>, film: &mut B::Film) -> Result<(), RenderError> {
        let Passes { runner, technique, plan, .. } = self;
        let n = runner.backend.ray_count(wave.rays);
        let gi_occluders = self.transmission_parts.as_ref().map_or(wave.scene, |parts| &parts.gi_occluders);
        let gather = |how: &Gathering| {
            let wave = WaveOf::<B> { scene: gi_occluders, ..*wave };
            runner.stage(Stage::Gather, [n; 2], |backend| runner.with_gathered(|kept| backend.gather(&wave, how, kept)))
        };
        let gathered = plan.gathering.as_ref().map(gather).transpose()?;
        let light = Light { runner, technique, plan };
        light.each_group(wave, self.transmission_parts.as_ref(), &mut |visibility| {
            runner.stage(Stage::Shade, [n; 2], |backend| backend.shade(wave, &visibility, gathered.as_ref(), film))
        })
    }

    /// Renders pixels with several samples; `rays` go through their centres.
    fn samples(&self, mut rays: B::Rays, all: &Antialiasing, film: &mut B::Film) -> Result<(), RenderError> {
        let Passes { runner, scene, .. } = self;
        let n = runner.backend.ray_count(&rays);
        let mut hits =
            runner.stage(Stage::PrimaryRays, [n; 2], |backend| backend.primary_rays(runner.context, scene, &rays))?;
        let mut done = 0;
        while done < all.samples {
            let numbers = done..all.samples.min(done + all.at_once());
            done = numbers.end;

            // What the samples see; the pixels whose samples lie on one surface are shaded once.
            let range = SampleRange { all, numbers };
            let pieces = n * range.numbers.len();
            let light = if all.apart { 0 } else { self.pieces_of_light(n as u64) };
            runner.context.work.expect((pieces + n) as u64 + light);
            let centers = self.wave(&rays, &hits, 1);
            let sampled = runner
                .stage(Stage::PixelSamples, [pieces; 2], |backend| backend.pixel_samples(&centers, film, &range))?;
            let mut samples;
            (samples, rays, hits) = sampled;
            let wave = self.wave(&rays, &hits, 1);
            if !all.apart {
                self.light(&wave, film)?;
            }

            // The others, by surface or sample by sample.
            let [shared, single, mirror] =
                runner.stage(Stage::Fragments, [n; 2], |backend| backend.fragments(&wave, &mut samples, film, all))?;
            for ((list, hits), depths, parts) in
                [(shared, Depths::FIRST, PARTS_OF_FRAGMENT), (single, Depths::ALL, all.samples)]
            {
                let fragments = runner.backend.ray_count(&list) as u64;
                let mirrors = if depths.last { 0 } else { self.pieces_of_mirrors(0, fragments) };
                runner.context.work.expect(self.pieces_of_light(fragments) + mirrors);
                self.waves(list, Some(hits), depths, parts, film)?;
            }
            self.mirrors(mirror, film)?;
        }
        Ok(())
    }

    /// Renders what samples that are not shaded themselves show in mirrors.
    fn mirrors(&self, (rays, hits): (B::Rays, B::Hits), film: &mut B::Film) -> Result<(), RenderError> {
        let runner = &self.runner;
        let n = runner.backend.ray_count(&rays);
        if n == 0 {
            return Ok(());
        }
        runner.context.work.expect(n as u64);
        let wave = self.wave(&rays, &hits, 1);
        let mirrored = runner.stage(Stage::MirrorRays, [n; 2], |backend| backend.mirror_rays(&wave))?;
        drop((rays, hits));
        self.waves(mirrored, None, Depths::MIRRORED, PARTS_OF_MERGED, film)
    }

    /// Pieces of work of a wave of `rays` rays in all of its stages.
    fn pieces_of_wave(&self, depth: u32, rays: u64) -> u64 {
        // Primary rays.
        rays + self.pieces_of_light(rays) + self.pieces_of_mirrors(depth, rays)
    }

    /// Those of the stage that finds the rays that go on.
    fn pieces_of_mirrors(&self, depth: u32, rays: u64) -> u64 {
        rays * u64::from(depth < self.plan.bounces || self.plan.is_transmissive)
    }

    /// Those of the stages that find what its surface points reflect.
    fn pieces_of_light(&self, rays: u64) -> u64 {
        // The technique's stages, gathering, shading; long tests and shading again for each further group.
        let further = self.plan.lights.iter().len() as u64 - 1;
        let gathering = u64::from(self.plan.gathering.is_some());
        let transmittance = u64::from(self.plan.transmits()) * (1 + further);
        rays * (self.technique.stages().len() as u64 + gathering + transmittance + 1 + 2 * further)
    }
}

/// Does the work of `rows` rows band by band, initially `at_once` rows at a time. Returns the final number of rows at a time.
///
/// If memory runs out in spite of the plan, the band is restarted: first without what is kept from earlier images, then with half
/// of its rows. How much memory an image needs is known only once its light points are.
pub(crate) fn in_bands<B: Backend>(
    runner: &StageRunner<B>,
    rows: u32,
    mut at_once: u32,
    mut band: impl FnMut(Range<u32>) -> Result<(), RenderError>,
) -> Result<u32, RenderError> {
    let context = runner.context;
    let mut first = 0;
    while first < rows {
        let rows = first..rows.min(first.saturating_add(at_once));
        let (counted, done, total) = (context.tally.snapshot(), context.work.done(), context.work.total());
        match band(rows.clone()) {
            Ok(()) => first = rows.end,
            Err(RenderError::DeviceMemory { .. }) if rows.len() > 1 || runner.has_cache() => {
                context.tally.restore(&counted);
                context.work.rewind(done, total);
                if runner.evict() {
                    continue;
                }
                at_once = rows.len() as u32 / 2;
                context.observer.note(&format!("device memory is short: {at_once} rows at once"));
            }
            Err(error) => {
                // What is counted are the bands that are finished.
                context.tally.restore(&counted);
                return Err(error);
            }
        }
    }
    Ok(at_once)
}
