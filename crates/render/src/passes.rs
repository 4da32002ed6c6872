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
use crate::progress::Pieces;
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
/// Shared fragments by pixel, before they are counted.
const GUESSED_FRAGMENTS: f64 = 0.5;
/// Which share of the samples of pixels turns out to differ so much between pixels that they are shaded one by one, more or less.
const GUESSED_SPLIT: f64 = 0.01;
/// How many of the rays that meet a surface a mirror sends on, before they are counted.
const GUESSED_MIRRORED: f64 = 0.25;
/// How many of the rays that mirrors send on are left when those of a pixel that meet one surface are merged.
const GUESSED_MERGED: f64 = 0.6;

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
        runner.context.work.expect(pieces_of_visibility(technique, plan, points.len() as f64));
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
    /// Whether nothing was gathered before for the pixels of the first ones.
    new: bool,
}

impl Depths {
    const ALL: Depths = Depths { first: 0, last: false, merge: false, new: false };
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
        let at_once = self.runner.or_evict(|backend| backend.rows_at_once(self.scene, self.plan))?;
        let at_once = at_once.min(self.plan.most_rows.unwrap_or(u32::MAX));
        let height = self.view.size()[1];
        in_bands(&self.runner, height, at_once, |rows| {
            let finished = rows.end;
            self.runner.context.work.begin_part([rows.start, rows.end].map(|row| f64::from(row) / f64::from(height)));
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
        let pixels = view.size()[0] as usize * all.len();
        let work = &runner.context.work;
        work.expect(Pieces::of(Stage::CameraRays, pixels as f64));
        let guess = match &plan.antialiasing {
            None => self.pieces_of_wave(pixels as f64, true, self.goes_on(Depths::ALL, 0)),
            Some(all) => self.guess_samples(pixels as f64, all, 0),
        };
        let guess = guess.and(Stage::PrimaryRays, pixels as f64);
        work.expect(guess);
        let mut film = runner.on_host(Stage::Film, |backend| backend.film(plan, [all.clone(), rows]))?;
        let rays =
            runner.stage(Stage::CameraRays, [pixels; 2], |backend| backend.camera_rays(view, all, plan.bounces))?;
        match &plan.antialiasing {
            None => {
                let depths = Depths { new: true, ..Depths::ALL };
                self.waves((rays, None), depths, 1, guess, &mut film)?;
            }
            Some(samples) => self.samples(rays, samples, guess, &mut film)?,
        }
        runner.backend.finish(runner.context)?;
        runner.on_host(Stage::Download, |backend| backend.develop(scene, film, picture))
    }

    /// Renders a wave of rays, and those that surfaces let through or mirror. What they see is given if it is known. Each ray takes one of `parts`
    /// parts of the samples of lights. `guess` is the work that is expected of them.
    fn waves(
        &self,
        (mut rays, mut known): (B::Rays, Option<B::Hits>),
        depths: Depths,
        parts: u32,
        mut guess: Pieces,
        film: &mut B::Film,
    ) -> Result<(), RenderError> {
        let Passes { runner, scene, .. } = self;
        let work = &runner.context.work;
        for depth in depths.first.. {
            let mut n = runner.backend.ray_count(&rays);
            if n == 0 {
                break;
            }
            let (new, goes_on) = (depths.new && depth == 0, self.goes_on(depths, depth));
            let primary = if known.is_some() { 0 } else { n };
            let own = |n: usize| self.pieces_of_wave(n as f64, new, goes_on).and(Stage::PrimaryRays, primary as f64);
            work.replace(&mut guess, own(n));
            let mut hits = match known.take() {
                Some(hits) => hits,
                None => runner
                    .stage(Stage::PrimaryRays, [n; 2], |backend| backend.primary_rays(runner.context, scene, &rays))?,
            };
            if depths.merge {
                let wave = self.wave(&rays, &hits, parts);
                (rays, hits) = runner.stage(Stage::MergedRays, [0; 2], |backend| backend.merged_rays(&wave))?;
                n = runner.backend.ray_count(&rays);
                work.replace(&mut guess, own(n));
            }
            let wave = self.wave(&rays, &hits, parts);
            self.light(&wave, film, new)?;
            if !goes_on {
                return Ok(());
            }
            rays = runner.stage(Stage::MirrorRays, [n; 2], |backend| backend.mirror_rays(&wave))?;
            guess = self.guess_after(n as f64);
        }
        work.replace(&mut guess, Pieces::default());
        Ok(())
    }

    /// Whether surfaces that rays of this depth meet let any through, or mirror them.
    fn goes_on(&self, depths: Depths, depth: u32) -> bool {
        !depths.last && (depth < self.plan.bounces || self.plan.is_transmissive)
    }

    /// Rays with what they see, each of which takes one of `parts` parts of the samples of lights.
    fn wave<'w>(&'w self, rays: &'w B::Rays, hits: &'w B::Hits, parts: u32) -> WaveOf<'w, B> {
        WaveOf::<B> { context: self.runner.context, scene: self.scene, rays, hits, lights: LightGroup::ALL, parts }
    }

    /// Adds the light that a wave's surface points reflect; it is `new` if nothing was gathered before for its pixels.
    fn light(&self, wave: &WaveOf<B>, film: &mut B::Film, new: bool) -> Result<(), RenderError> {
        let Passes { runner, technique, plan, .. } = self;
        let n = runner.backend.ray_count(wave.rays);
        let gi_occluders = self.transmission_parts.as_ref().map_or(wave.scene, |parts| &parts.gi_occluders);
        let gather = |how: &Gathering| {
            let wave = WaveOf::<B> { scene: gi_occluders, ..*wave };
            runner.counted_stage(Stage::Gather, (how.pieces(n as f64, new), n), |backend| {
                runner.with_gathered(|kept| backend.gather(&wave, how, kept))
            })
        };
        let gathered = plan.gathering.as_ref().map(gather).transpose()?;
        let light = Light { runner, technique, plan };
        light.each_group(wave, self.transmission_parts.as_ref(), &mut |visibility| {
            runner.stage(Stage::Shade, [n; 2], |backend| backend.shade(wave, &visibility, gathered.as_ref(), film))
        })
    }

    /// Renders pixels with several samples; `rays` go through their centres. `guess` is the work that is expected of them.
    fn samples(
        &self,
        mut rays: B::Rays,
        all: &Antialiasing,
        mut guess: Pieces,
        film: &mut B::Film,
    ) -> Result<(), RenderError> {
        let Passes { runner, scene, .. } = self;
        let work = &runner.context.work;
        let n = runner.backend.ray_count(&rays);
        let mut hits =
            runner.stage(Stage::PrimaryRays, [n; 2], |backend| backend.primary_rays(runner.context, scene, &rays))?;
        guess -= Pieces::of(Stage::PrimaryRays, n as f64);
        let mut done = 0;
        while done < all.samples {
            let numbers = done..all.samples.min(done + all.at_once());
            let new = done == 0;
            done = numbers.end;

            // What the samples see; the pixels whose samples lie on one surface are shaded once.
            let range = SampleRange { all, numbers };
            let pieces = n * range.numbers.len();
            let (later, mut rest) = (self.guess_samples(n as f64, all, done), guess);
            rest -= self.pieces_of_samples(n as f64, pieces as f64, all, new);
            let centers = self.wave(&rays, &hits, 1);
            let sampled = runner
                .stage(Stage::PixelSamples, [pieces; 2], |backend| backend.pixel_samples(&centers, film, &range))?;
            let mut samples;
            (samples, rays, hits) = sampled;
            let wave = self.wave(&rays, &hits, 1);
            if !all.apart {
                if let Some(counts) = self.fragment_counts(&wave, &samples, film, all)? {
                    let [shared, single, mirror] = counts.map(|count| count as f64);
                    let split = GUESSED_SPLIT * pieces as f64;
                    let fragments = self.guess_fragments([shared, single + split, mirror], false);
                    work.replace(&mut rest, fragments.into_iter().chain([later]).sum());
                }
                self.light(&wave, film, new)?;
            }

            // The others, by surface or sample by sample.
            let [shared, single, mirror] =
                runner.stage(Stage::Fragments, [n; 2], |backend| backend.fragments(&wave, &mut samples, film, all))?;
            let counts = [&shared, &single, &mirror].map(|(list, _)| runner.backend.ray_count(list) as f64);
            let of_single = Depths { new: new && all.apart, ..Depths::ALL };
            let guesses = self.guess_fragments(counts, of_single.new);
            work.replace(&mut rest, guesses.into_iter().chain([later]).sum());
            let known = |(list, hits)| (list, Some(hits));
            self.waves(known(shared), Depths::FIRST, PARTS_OF_FRAGMENT, guesses[0], film)?;
            self.waves(known(single), of_single, all.samples, guesses[1], film)?;
            self.mirrors(mirror, guesses[2], film)?;
            guess = later;
        }
        Ok(())
    }

    /// How many shared fragments, single samples and mirror samples there will be, about, unless counting takes longer than it is worth.
    fn fragment_counts(
        &self,
        wave: &WaveOf<B>,
        samples: &B::Samples,
        film: &B::Film,
        all: &Antialiasing,
    ) -> Result<Option<[usize; 3]>, RenderError> {
        let is_long = B::COUNTS_FOR_NOTHING || self.plan.gathering.is_some();
        is_long.then(|| self.runner.backend.fragment_counts(wave, samples, film, all)).transpose()
    }

    /// Renders what samples that are not shaded themselves show in mirrors. `guess` is the work that is expected of them.
    fn mirrors(
        &self,
        (rays, hits): (B::Rays, B::Hits),
        mut guess: Pieces,
        film: &mut B::Film,
    ) -> Result<(), RenderError> {
        let runner = &self.runner;
        let n = runner.backend.ray_count(&rays);
        if n == 0 {
            return Ok(());
        }
        let wave = self.wave(&rays, &hits, 1);
        let mirrored = runner.stage(Stage::MirrorRays, [n; 2], |backend| backend.mirror_rays(&wave))?;
        drop((rays, hits));
        guess -= Pieces::of(Stage::MirrorRays, n as f64);
        self.waves((mirrored, None), Depths::MIRRORED, PARTS_OF_MERGED, guess, film)
    }

    /// Work on a wave of `rays` rays once it is known what they see, with a guess of what follows if it `goes_on`.
    fn pieces_of_wave(&self, rays: f64, new: bool, goes_on: bool) -> Pieces {
        let mut pieces = self.pieces_of_light(rays, new);
        if goes_on {
            pieces += self.guess_after(rays).and(Stage::MirrorRays, rays);
        }
        pieces
    }

    /// A guess of the work on what surfaces send on of `rays` rays.
    fn guess_after(&self, rays: f64) -> Pieces {
        let next = GUESSED_MIRRORED * rays;
        self.pieces_of_light(next, false).and(Stage::PrimaryRays, next).and(Stage::MirrorRays, next)
    }

    /// A guess of the work on the samples of `pixels` pixels, from number `done` on.
    fn guess_samples(&self, pixels: f64, all: &Antialiasing, mut done: u32) -> Pieces {
        let mut sum = Pieces::default();
        while done < all.samples {
            let (new, count) = (done == 0, all.at_once().min(all.samples - done));
            done += count;
            let samples = f64::from(count) * pixels;
            let fragments = GUESSED_FRAGMENTS * pixels;
            let mirrored = if all.mirrors { GUESSED_MIRRORED * pixels } else { 0.0 };
            let counts =
                if all.apart { [0.0, samples, mirrored] } else { [fragments, GUESSED_SPLIT * samples, mirrored] };
            sum += self.pieces_of_samples(pixels, samples, all, new);
            self.guess_fragments(counts, new && all.apart).into_iter().for_each(|guess| sum += guess);
        }
        sum
    }

    /// Work on some samples of pixels, but for fragments.
    fn pieces_of_samples(&self, pixels: f64, samples: f64, all: &Antialiasing, new: bool) -> Pieces {
        let light = if all.apart { Pieces::default() } else { self.pieces_of_light(pixels, new) };
        light.and(Stage::PixelSamples, samples).and(Stage::Fragments, pixels)
    }

    /// A guess of the work on so many shared fragments, single samples and mirror samples; single samples are `new` if nothing was gathered before for
    /// their pixels.
    fn guess_fragments(&self, [shared, single, mirror]: [f64; 3], new: bool) -> [Pieces; 3] {
        // Rough mirrors send on several, glass two of each.
        let mirrored = mirror * f64::from(self.plan.directions * if self.plan.is_transmissive { 2 } else { 1 });
        let goes_on = self.goes_on(Depths::MIRRORED, Depths::MIRRORED.first);
        let mirrors = self.pieces_of_wave(GUESSED_MERGED * mirrored, false, goes_on).and(Stage::PrimaryRays, mirrored);
        [
            self.pieces_of_wave(shared, false, false),
            self.pieces_of_wave(single, new, self.goes_on(Depths::ALL, 0)),
            mirrors.and(Stage::MirrorRays, mirror),
        ]
    }

    /// Work of the stages that find what surface points reflect.
    fn pieces_of_light(&self, points: f64, new: bool) -> Pieces {
        let Passes { technique, plan, .. } = self;
        let gathered = plan.gathering.as_ref().map_or(0.0, |how| how.pieces(points, new));
        let groups = plan.lights.iter().len() as f64;
        let visibility = pieces_of_visibility(technique, plan, points);
        visibility.and(Stage::Gather, gathered).and(Stage::Shade, groups * points)
    }
}

/// Work of the stages that find what surface points see of lights. The last one of a technique is repeated for each group of lights.
fn pieces_of_visibility(technique: &Technique, plan: &Plan, points: f64) -> Pieces {
    let groups = plan.lights.iter().len() as f64;
    let mut pieces = Pieces::default();
    for &stage in technique.stages() {
        pieces = pieces.and(stage, points);
    }
    if let Some(&last) = technique.stages().last() {
        pieces = pieces.and(last, (groups - 1.0) * points);
    }
    let transmissive = if plan.transmits() { groups * points } else { 0.0 };
    pieces.and(Stage::Transmittance, transmissive)
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
        let (counted, work) = (context.tally.snapshot(), context.work.counted());
        match band(rows.clone()) {
            Ok(()) => first = rows.end,
            Err(RenderError::DeviceMemory { .. }) if rows.len() > 1 || runner.has_cache() => {
                context.tally.restore(&counted);
                context.work.rewind(work);
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
