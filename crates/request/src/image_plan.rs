//! A picture of a scene that is in memory, and how an image in memory is stored.

use lightmesh_image::{Description, Format, SaveOptions};
use lightmesh_render::{Frame, PreparedScene, RenderError, Settings};
use lightmesh_scene::{Scene, SceneFormat, Up};

use crate::error::{RequestError, StageError};
use crate::expose::Metering;
use crate::files::save_options;
use crate::host::Host;
use crate::request::Request;
use crate::save::stored;
use crate::settings::settings;
use crate::stage::Staging;
use crate::value::Exposure;

/// A picture of a scene that is given apart.
pub struct ImagePlan {
    settings: Settings,
    staging: Staging,
    exposure: Option<Exposure>,
    /// Whether the image goes to a file that stores linear values.
    is_linear: bool,
}

impl ImagePlan {
    /// Of a request. `format` is that of the file the scene was read from: some have their own idea of what is up.
    ///
    /// # Errors
    /// [`RequestError`].
    pub fn new(request: &Request, format: Option<SceneFormat>) -> Result<ImagePlan, RequestError> {
        request.check()?;
        let settings = settings(request, format)?;
        let is_linear = request.format == Some(Format::Exr);
        Ok(ImagePlan { settings, staging: Staging::new(request, format)?, exposure: request.exposure, is_linear })
    }

    /// The same for a picture to look at, as `lightmesh render` makes it: under a sky, a model stands on a ground before the horizon.
    pub fn of_picture(self) -> ImagePlan {
        ImagePlan { staging: self.staging.of_picture(true), ..self }
    }

    /// The settings of the renderer.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Changes a scene as requested, and adds what it lacks: camera, lights, a ground.
    ///
    /// # Errors
    /// [`StageError`] for an unknown camera or invalid surroundings.
    pub fn stage(&self, scene: &mut Scene, host: &dyn Host) -> Result<StagedImage, StageError> {
        let staged = self.staging.apply(scene, host)?;
        let metering = Metering::of_staged(scene, &staged, self.exposure, self.is_linear, self.settings.transparent);
        Ok(StagedImage { metering, ground: staged.ground })
    }
}

/// How the image of a scene is exposed that was [staged](ImagePlan::stage).
pub struct StagedImage {
    metering: Metering,
    ground: Option<Up>,
}

impl StagedImage {
    /// The axis across the ground that was added to the scene's geometry, if there is one.
    pub fn ground(&self) -> Option<Up> {
        self.ground
    }

    /// Renders the image by `render`, which may be called twice: with a ground that mirrors show. It is given the host to tell of progress. Returns the
    /// image with the exposure of image files, in stops.
    ///
    /// # Errors
    /// Those of `render`.
    pub fn picture(
        &self,
        prepared: &PreparedScene,
        settings: &Settings,
        host: &dyn Host,
        render: impl FnMut(&PreparedScene, &Settings, &dyn Host) -> Result<Frame, RenderError>,
    ) -> Result<(Frame, f32), RenderError> {
        self.metering.picture(prepared, settings, host, render)
    }
}

/// How an image is stored.
pub struct StoragePlan {
    options: SaveOptions,
    exposure: Option<Exposure>,
}

impl StoragePlan {
    /// Of a request.
    pub fn new(request: &Request) -> StoragePlan {
        StoragePlan { options: save_options(request), exposure: request.exposure }
    }

    /// The options for a frame, which is shown at `stops` if the request does not say otherwise.
    pub fn options(&self, frame: &Frame, stops: f32, description: Description) -> SaveOptions {
        let stops = match self.exposure {
            None => stops,
            Some(Exposure::Stops(stops)) => stops,
            Some(Exposure::Auto) => frame.image.auto_exposure(),
        };
        stored(self.options.clone(), stops, description)
    }
}
