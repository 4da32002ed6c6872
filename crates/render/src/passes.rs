//! How the stages are combined: one image, whatever the technique.
//!
//! An image is rendered band by band, with as many rows at once as memory allows; every band yields the pixels that rendering the
//! whole image at once would. Within a band, mirrors are a loop over waves of rays.

use std::ops::Range;

use crate::backend::run::Run;
use crate::backend::{Backend, WaveOf};
use crate::data::picture::Picture;
use crate::error::RenderError;
use crate::plan::Plan;
use crate::stage::Stage;
use crate::techniques::Technique;
use crate::view::View;

/// The passes over one image.
pub(crate) struct Passes<'a, B: Backend> {
    pub(crate) run: Run<'a, B>,
    pub(crate) scene: &'a B::Scene,
    pub(crate) technique: &'a Technique,
    pub(crate) view: &'a View,
    pub(crate) plan: &'a Plan,
}

impl<B: Backend> Passes<'_, B> {
    /// Renders the whole view into `picture`. Returns how many rows were rendered at once.
    ///
    /// If memory runs out in spite of the plan, the band is restarted: first without what is kept of earlier images, then with half
    /// of its rows. How much an image needs is known only once its light points are.
    pub(crate) fn render(&self, picture: &mut Picture) -> Result<u32, RenderError> {
        let (job, height) = (self.run.job, self.view.size()[1]);
        job.work.expect(self.pieces_of_wave(0, self.plan.pixels()));
        let mut at_once = self.run.or_forget(|backend| backend.rows_at_once(self.scene, self.plan))?;
        let mut first = 0;
        while first < height {
            let rows = first..height.min(first.saturating_add(at_once));
            let (counted, done, total) = (job.tally.snapshot(), job.work.done(), job.work.total());
            match self.band(rows.clone(), picture) {
                Ok(()) => first = rows.end,
                Err(RenderError::DeviceMemory { .. }) if rows.len() > 1 || self.run.keeps() => {
                    job.tally.restore(&counted);
                    job.work.rewind(done, total);
                    if self.run.forget() {
                        continue;
                    }
                    at_once = rows.len() as u32 / 2;
                    job.observer.note(&format!("device memory is short: {at_once} rows at once"));
                }
                Err(error) => return Err(error),
            }
        }
        Ok(at_once)
    }

    /// Renders some rows.
    fn band(&self, rows: Range<u32>, picture: &mut Picture) -> Result<(), RenderError> {
        let Passes { run, scene, technique, view, plan } = self;
        let mut film = run.on_host(Stage::Film, |backend| backend.film(plan, rows.clone()))?;
        let pixels = view.size()[0] as usize * rows.len();
        let mut rays = run.stage(Stage::CameraRays, [pixels; 2], |backend| backend.camera_rays(view, rows))?;
        for depth in 0..=plan.bounces {
            let n = run.backend.ray_count(&rays);
            if n == 0 {
                break;
            }
            if depth > 0 {
                run.job.work.expect(self.pieces_of_wave(depth, n as u64));
            }
            let hits = run.stage(Stage::PrimaryRays, [n; 2], |backend| backend.primary_rays(run.job, scene, &rays))?;
            let wave = WaveOf::<B> { job: run.job, scene, rays: &rays, hits: &hits };
            let visibility = technique.visibility(run, &wave)?;
            run.stage(Stage::Shade, [n; 2], |backend| backend.shade(&wave, &visibility, &mut film))?;
            if depth < plan.bounces {
                rays = run.stage(Stage::MirrorRays, [n; 2], |backend| backend.mirror_rays(&wave))?;
            }
        }
        run.backend.finish(run.job)?;
        run.on_host(Stage::Download, |backend| backend.develop(scene, film, picture))
    }

    /// Pieces of work of a wave of `rays` rays in all of its stages.
    fn pieces_of_wave(&self, depth: u32, rays: u64) -> u64 {
        let (from_camera, to_mirrors) = (u64::from(depth == 0), u64::from(depth < self.plan.bounces));
        // Camera rays, primary rays, the technique's stages, shading, mirror rays.
        rays * (from_camera + 1 + self.technique.stages().len() as u64 + 1 + to_mirrors)
    }
}
