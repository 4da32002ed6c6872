//! From a request to a plan: everything that can be checked before the work begins is checked here.

use std::num::NonZeroUsize;

use lightmesh_render::{Acceleration, Settings};
use lightmesh_scene::{CreaseAngle, Instancing, LoadOptions};

use crate::error::RequestError;
use crate::files::PictureFiles;
use crate::film::Film;
use crate::order::Order;
use crate::request::Request;
use crate::settings::settings;
use crate::stage::Staging;
use crate::sun::SunStudy;
use crate::value::Smooth;

/// How a scene is read.
pub fn load_options(request: &Request, smooth: Option<CreaseAngle>, instancing: Instancing) -> LoadOptions {
    LoadOptions::default()
        .with_format(request.scene_format)
        .with_allow_outside(request.allow_outside)
        .with_strict(request.strict)
        .with_smooth(smooth)
        .with_instancing(instancing)
        .with_animation(request.animation.clone())
        .with_memory_limit(request.memory_limit.map(|limit| limit.0))
}

/// An order, validated as far as possible without the scene.
pub struct Plan {
    /// What is asked for.
    pub order: Order,
    /// The crease angle of files without normals, if they are to be smooth.
    pub smooth: Option<CreaseAngle>,
    /// Whether meshes in many places are stored once.
    pub instancing: Instancing,
    /// What becomes of the scene.
    pub(crate) staging: Staging,
    /// Everything else about the image.
    pub settings: Settings,
    /// CPU threads; `None`: all.
    pub threads: Option<NonZeroUsize>,
    /// The output files; of a film, those of its first frame.
    pub files: PictureFiles,
    /// The frames, if it is a film.
    pub film: Option<Film>,
    /// The hours of a day, if the sun of one is studied.
    pub sun: Option<SunStudy>,
}

impl Plan {
    /// Checks that settings are consistent and that every output can be written.
    ///
    /// # Errors
    /// [`RequestError`].
    pub fn new(order: Order) -> Result<Plan, RequestError> {
        let request = &order.request;
        request.check()?;
        let format = order.format();
        let mut settings = settings(request, format)?;
        settings.layers |= order.files.layers.is_some();
        let sun = SunStudy::new(&order)?;
        let film = Film::new(&order, sun.as_ref())?;
        let files = match (&film, &sun) {
            (Some(film), _) => film.files(&order, film.first())?,
            (None, Some(sun)) => sun.files(&order)?,
            (None, None) => PictureFiles::new(&order)?,
        };
        let staging = Staging::new(request, format)?.under_sun(sun.as_ref()).of_picture(sun.is_none());
        Ok(Plan {
            smooth: request.smooth.unwrap_or_else(|| usual_smooth(&settings)).0,
            instancing: instancing(request, &settings),
            staging,
            threads: request.threads.and_then(|threads| NonZeroUsize::new(threads as usize)),
            settings,
            files,
            film,
            sun,
            order,
        })
    }

    /// How its scene is read.
    pub fn load_options(&self) -> LoadOptions {
        load_options(&self.order.request, self.smooth, self.instancing)
    }
}

/// Grids and brute force hold no instances.
fn instancing(request: &Request, settings: &Settings) -> Instancing {
    match settings.acceleration {
        Acceleration::Auto | Acceleration::Bvh => request.instances,
        _ => Instancing::Never,
    }
}

/// The half-ball stands for the thesis, whose surfaces are facets.
fn usual_smooth(settings: &Settings) -> Smooth {
    if settings.has_light_points() { Smooth::OFF } else { Smooth::default() }
}
