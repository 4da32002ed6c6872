//! A picture of which others render the rows: it is exposed, put together and written here, as by one process.

use std::time::Instant;

use lightmesh_render::{Choice, Device, Frame, Renderer};
use lightmesh_scene::Scene;

use super::{Band, Input, Pass, staged};
use crate::context::Context;
use crate::error::{ClusterError, Error};
use crate::expose::Metering;
use crate::host::Host;
use crate::order::Order;
use crate::plan::Plan;
use crate::save::save;

/// A picture of which others render the rows.
pub struct BandedPicture {
    plan: Plan,
    inputs: Vec<Input>,
    /// As it is staged; its structure is built by those who render.
    scene: Scene,
    metering: Metering,
    /// For its threads, which encode.
    renderer: Renderer,
    load: f64,
}

impl BandedPicture {
    /// Reads and stages the scene. `threads` encode the file.
    ///
    /// # Errors
    /// [`Error`]; [`ClusterError`] for what only one process can render.
    pub fn begin(order: Order, threads: Option<usize>, host: &dyn Host) -> Result<BandedPicture, Error> {
        ClusterError::check_picture(&order)?;
        let (plan, start) = (Plan::new(order)?, Instant::now());
        let mut scene = plan.open(host)?;
        let load = start.elapsed().as_secs_f64();
        if let Some(text) = plan.files.misnamed(host.words()) {
            host.warning(&text);
        }
        let inputs = Input::all_of(&plan.order, &scene)?;
        let metering = staged(&plan, &mut scene, host)?;
        let renderer = Renderer::on(Choice::of(Device::Cpu)?, threads)?;
        Ok(BandedPicture { plan, inputs, scene, metering, renderer, load })
    }

    /// What it is a picture of.
    pub fn order(&self) -> &Order {
        &self.plan.order
    }

    /// The files that the scene is read from.
    pub fn inputs(&self) -> &[Input] {
        &self.inputs
    }

    /// The scene as it is shown.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Makes the image of what `render` returns, the bands of a pass, in any order. Also returns its exposure in stops.
    ///
    /// # Errors
    /// Those of `render`, and [`ClusterError::Bands`].
    pub fn render<E: From<Error>>(
        &self,
        host: &dyn Host,
        mut render: impl FnMut(&Pass) -> Result<Vec<Band>, E>,
    ) -> Result<(Frame, f32), E> {
        let of = self.metering.times(&self.scene, &self.plan.settings);
        let mut number = 0;
        let (mut frame, stops) =
            self.metering.image(&self.scene, &self.plan.settings, host, |background, settings, _| {
                let [width, height] = settings.size.map(i64::from);
                let area = settings.crop.map_or([0, 0, width, height], |crop| {
                    let ([x, y], [width, height]) = (crop.first, crop.size);
                    [x.into(), y.into(), width.into(), height.into()]
                });
                let pass = Pass {
                    number,
                    of,
                    area,
                    is_part: settings.crop.is_some(),
                    transparent: settings.transparent,
                    background: background.map(|radiance| radiance.to_array()),
                };
                number += 1;
                let bands = render(&pass)?;
                let assembled = self.renderer.install(|| pass.assemble(bands, settings.size));
                assembled.map_err(|error| E::from(error.into()))
            })?;
        frame.stats.seconds.load = self.load;
        Ok((frame, stops))
    }

    /// Writes the picture's file.
    ///
    /// # Errors
    /// [`Error`]; no partial file is left.
    pub fn save(&self, frame: &mut Frame, stops: f32, host: &dyn Host) -> Result<(), Error> {
        let context = Context { renderer: &self.renderer, plan: &self.plan, load: self.load, host };
        save(frame, stops, &self.plan.files, &self.scene, &self.metering, context)
    }
}
