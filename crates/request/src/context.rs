//! What work on a plan needs.

use std::sync::Arc;

use lightmesh_render::{Frame, PreparedScene, RenderError, Renderer, Settings};

use crate::error::Error;
use crate::expose::Metering;
use crate::host::{Host, RENDERING};
use crate::plan::Plan;

/// A scene that is staged and prepared as planned.
#[derive(Clone)]
pub(crate) struct Prepared {
    pub(crate) plan: Arc<Plan>,
    pub(crate) scene: PreparedScene,
    pub(crate) metering: Metering,
}

/// What work on a plan needs.
#[derive(Clone, Copy)]
pub(crate) struct Context<'a> {
    pub(crate) renderer: &'a Renderer,
    pub(crate) plan: &'a Plan,
    /// Seconds that it took to read the scene.
    pub(crate) load: f64,
    pub(crate) host: &'a dyn Host,
}

impl Context<'_> {
    /// Renders an image by `render`; also returns its exposure in stops.
    pub(crate) fn picture(
        self,
        prepared: &PreparedScene,
        settings: &Settings,
        metering: &Metering,
        mut render: impl FnMut(&PreparedScene, &Settings, &dyn Host) -> Result<Frame, RenderError>,
    ) -> Result<(Frame, f32), Error> {
        let Context { plan, load, host, .. } = self;
        let (mut frame, stops) = metering.picture(prepared, settings, host, |prepared, settings, host| {
            host.during(RENDERING, || host.cancellable(|| render(prepared, settings, host)))
        })?;
        if plan.settings.partial {
            host.remark(rows(&frame));
        } else if host.cancelled() {
            return Err(RenderError::Cancelled.into());
        }
        frame.stats.seconds.load = load;
        Ok((frame, stops))
    }
}

/// How much of an image is finished.
fn rows(frame: &Frame) -> String {
    let ([_, height], finished) = (frame.size(), frame.finished_rows());
    let finished = if finished == height { "all".to_owned() } else { format!("{finished} of") };
    format!("{finished} {height} rows are finished")
}
