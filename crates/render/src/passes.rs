//! How the stages are combined, for every technique: for an image, and for points given by the caller.
//!
//! An image is rendered band by band, with as many rows at once as memory allows; every band yields the same pixels as rendering
//! the whole image at once. Within a band, mirrors are a loop over waves of rays.

use std::ops::Range;

use crate::backend::run::Run;
use crate::backend::{Backend, WaveOf};
use crate::counters::Tally;
use crate::data::lights::LightGroup;
use crate::data::picture::Picture;
use crate::data::visibility::Visibility;
use crate::error::RenderError;
use crate::plan::Plan;
use crate::probes::GivenPoints;
use crate::stage::Stage;
use crate::techniques::Technique;
use crate::view::View;

/// Visibility at given points, to be computed.
pub(crate) struct Baking<'a, B: Backend> {
    pub(crate) run: Run<'a, B>,
    pub(crate) scene: &'a B::Scene,
    pub(crate) technique: &'a Technique,
    pub(crate) plan: &'a Plan,
}

impl<B: Backend> Baking<'_, B> {
    /// Finds what each probe sees of each light. Also returns how many rows of probes were processed at once.
    pub(crate) fn bake(&self, points: &GivenPoints) -> Result<(Visibility, u32), RenderError> {
        let Baking { run, scene, technique, plan } = self;
        run.job.work.expect(points.len() as u64 * technique.stages().len() as u64);
        let at_once = run.or_forget(|backend| backend.rows_at_once(scene, plan))?;
        let mut all = Visibility::dark(0..plan.lights.lights, points.len());
        let at_once = in_bands(run, points.rows(), at_once, |rows| {
            let range = points.range(&rows);
            let probes = points.part(&rows);
            let (scene, rays, hits) = run.on_host(Stage::Upload, |backend| backend.probes(scene, &probes))?;
            let wave = WaveOf::<B> { job: run.job, scene: &scene, rays: &rays, hits: &hits, lights: LightGroup::ALL };
            let mut seen = None;
            technique.visibility(run, &wave, plan.lights, &mut |visibility| {
                seen = Some(visibility);
                Ok(())
            })?;
            run.backend.finish(run.job)?;
            if let Some(visibility) = seen {
                let part = run.on_host(Stage::Download, |backend| backend.visibility(visibility))?;
                all.put(range, &part);
                Tally::add(&run.job.tally.surface_points, part.rays as u64);
            }
            Ok(())
        })?;
        Ok((all, at_once))
    }
}

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
    pub(crate) fn render(&self, picture: &mut Picture) -> Result<u32, RenderError> {
        self.run.job.work.expect(self.pieces_of_wave(0, self.plan.pixels()));
        let at_once = self.run.or_forget(|backend| backend.rows_at_once(self.scene, self.plan))?;
        in_bands(&self.run, self.view.size()[1], at_once, |rows| self.band(rows, picture))
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
            let wave = WaveOf::<B> { job: run.job, scene, rays: &rays, hits: &hits, lights: LightGroup::ALL };
            technique.visibility(run, &wave, plan.lights, &mut |visibility| {
                run.stage(Stage::Shade, [n; 2], |backend| backend.shade(&wave, &visibility, &mut film))
            })?;
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
        // Camera rays, primary rays, the technique's stages, shading, mirror rays; long tests and shading again for each further group.
        let further = self.plan.lights.iter().len() as u64 - 1;
        rays * (from_camera + 1 + self.technique.stages().len() as u64 + 1 + to_mirrors + 2 * further)
    }
}

/// Does the work of `rows` rows band by band, initially `at_once` rows at a time. Returns the final number of rows at a time.
///
/// If memory runs out in spite of the plan, the band is restarted: first without what is kept from earlier images, then with half
/// of its rows. How much memory an image needs is known only once its light points are.
pub(crate) fn in_bands<B: Backend>(
    run: &Run<B>,
    rows: u32,
    mut at_once: u32,
    mut band: impl FnMut(Range<u32>) -> Result<(), RenderError>,
) -> Result<u32, RenderError> {
    let job = run.job;
    let mut first = 0;
    while first < rows {
        let rows = first..rows.min(first.saturating_add(at_once));
        let (counted, done, total) = (job.tally.snapshot(), job.work.done(), job.work.total());
        match band(rows.clone()) {
            Ok(()) => first = rows.end,
            Err(RenderError::DeviceMemory { .. }) if rows.len() > 1 || run.keeps() => {
                job.tally.restore(&counted);
                job.work.rewind(done, total);
                if run.forget() {
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

#[cfg(test)]
mod tests {
    use glam::{DVec3, Vec3};
    use lightmesh_scene::{Bounds, LightKind};
    use lightmesh_testkit::pile;

    use super::*;
    use crate::backend::Cpu;
    use crate::data::lights::LightGroups;
    use crate::job::{Job, Sampling};
    use crate::observer::Unobserved;
    use crate::prepared::PreparedScene;
    use crate::settings::{Acceleration, Lookup, Mode, Settings};
    use crate::techniques::Request;

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

    #[test]
    fn groups_of_lights_give_the_same_picture() {
        let scene = scene();
        for (mode, lookup) in [
            (Mode::LightMesh, Lookup::Lists),
            (Mode::LightMesh, Lookup::Adaptive),
            (Mode::Area, Lookup::Auto),
            (Mode::RayTrace, Lookup::Auto),
        ] {
            let settings = Settings::default().with_mode(mode).with_lookup(lookup).with_size([24, 18]);
            let view = View::new(&scene.scene.cameras[0], settings.size);
            let bounds: Bounds = scene.geometry.bounds;
            let request = Request { scene: &scene, settings: &settings, view: &view, observer: &Unobserved, bounds };
            let technique = Technique::resolve(&request).unwrap();
            let picture = |at_once| {
                let lights = LightGroups { lights: LIGHTS, at_once };
                let footprint = technique.footprint(lights.held() as u64);
                let (size, layers) = (settings.size, Some(LIGHTS));
                let plan = Plan { size, bounces: 2, layers, lights, memory_limit: None, kept: 0, footprint };
                let job = Job::new(&Unobserved, Sampling { samples: 9, seed: 0, spread: true });
                let run = Run::new(&Cpu, &job, None);
                let mut picture = Picture::new(size, layers);
                let passes = Passes { run, scene: &scene, technique: &technique, view: &view, plan: &plan };
                passes.render(&mut picture).unwrap();
                assert_eq!(job.work.done(), job.work.total(), "{mode:?} {lookup:?}: progress");
                let layers = picture.layers.take().unwrap();
                (bytemuck::cast_vec::<[f32; 3], [u32; 3]>(picture.color), layers.visibility.concat(), layers.position)
            };
            let whole = picture(usize::MAX);
            assert!(whole.1.iter().any(|share| *share > 0.0 && *share < 1.0) || mode == Mode::RayTrace);
            for at_once in [1, 4] {
                assert!(picture(at_once) == whole, "{mode:?} {lookup:?}: {at_once} lights at once");
            }
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
            let view = View::new(&scene.scene.cameras[0], settings.size);
            let bounds = scene.geometry.bounds;
            let request = Request { scene: &scene, settings: &settings, view: &view, observer: &Unobserved, bounds };
            let technique = Technique::resolve(&request).unwrap();
            for lights in [1, 4, 16, 64, 256] {
                let groups = LightGroups { lights, at_once: technique.lights_at_once() };
                let footprint = technique.footprint(groups.held() as u64);
                assert!(footprint.host.max(footprint.device) <= most, "{mode:?} {lookup:?}: {footprint:?}");
                assert!(footprint.host.min(footprint.device) >= 4, "{mode:?} {lookup:?}: {footprint:?}");
            }
        }
    }
}
