//! The exposure of an image file, and what a ground that catches shadows shows at that exposure.
//!
//! An automatic exposure is that of the model: what a shadow catcher shows is the background, whose brightness says nothing of the light. So the
//! image is rendered without background, metered, and put in front of it. Only mirrors need a second image: they show the background, too.

use std::borrow::Cow;
use std::time::Instant;

use glam::Vec3;
use lightmesh_image as image;
use lightmesh_render::{Frame, PreparedScene, RenderError, Settings};
use lightmesh_scene::{Falloff, Scene};

use crate::host::{Host, Parts};
use crate::stage::Staged;
use crate::value::Exposure;

/// How the exposure is found.
#[derive(Clone)]
pub(crate) struct Metering {
    exposure: Exposure,
    /// Whether an exposure of 0 stops is only where to start: it is found by what is bright in the image.
    keeps_highlights: bool,
    has_ground: bool,
    /// What a ground is metered without and put in front of.
    behind: Option<Behind>,
}

#[derive(Clone, Copy)]
enum Behind {
    /// Radiance that was asked for.
    Radiance(Vec3),
    /// What an image shows at its exposure.
    Shown(f32),
}

impl Metering {
    /// How the image of a staged scene is exposed, if an exposure is `chosen` or not: not at all if its file `is_linear`.
    pub(crate) fn of_staged(
        scene: &mut Scene,
        staged: &Staged,
        chosen: Option<Exposure>,
        is_linear: bool,
        is_transparent: bool,
    ) -> Metering {
        let exposure = if is_linear { Exposure::Stops(0.0) } else { exposure(scene, chosen, staged.indoors) };
        Metering::new(scene, exposure, is_transparent, staged.behind)
            .of_highlights(staged.outdoors && !is_linear, chosen)
    }

    /// Sets the background of a scene whose ground shows `shown` if the exposure is known; else a ground's is black until it is.
    fn new(scene: &mut Scene, exposure: Exposure, is_transparent: bool, shown: Option<f32>) -> Metering {
        let has_ground = scene.geometry.materials.iter().any(|material| material.catcher);
        let background = &mut scene.lights.background;
        let behind = match (exposure, shown) {
            (Exposure::Stops(stops), Some(shown)) => {
                *background = Some(Behind::Shown(shown).radiance(stops));
                None
            }
            (Exposure::Auto, Some(shown)) => {
                *background = Some(Vec3::ZERO);
                Some(Behind::Shown(shown))
            }
            // Surroundings light the scene: they count, and catchers show them.
            (Exposure::Auto, None) if background.is_none() && scene.lights.environment.is_some() => None,
            (Exposure::Auto, None) if has_ground && !is_transparent => {
                let radiance = background.replace(Vec3::ZERO);
                Some(Behind::Radiance(radiance.unwrap_or_default()))
            }
            _ => None,
        };
        Metering { exposure, keeps_highlights: false, has_ground, behind }
    }

    /// The same for an image `outdoors`, which is exposed by what is bright in it, unless an exposure is `chosen`.
    fn of_highlights(self, outdoors: bool, chosen: Option<Exposure>) -> Metering {
        let keeps_highlights = outdoors && chosen.is_none() && self.exposure == Exposure::Stops(0.0);
        Metering { keeps_highlights, ..self }
    }

    /// The same with an exposure that is known.
    pub(crate) fn fixed(mut self, stops: f32) -> Metering {
        self.exposure = Exposure::Stops(stops);
        self.keeps_highlights = false;
        self
    }

    pub(crate) fn is_automatic(&self) -> bool {
        self.exposure == Exposure::Auto || self.keeps_highlights
    }

    /// Whether the scene has a shadow catcher.
    pub(crate) fn has_ground(&self) -> bool {
        self.has_ground
    }

    /// Whether the image is first rendered without its background.
    fn is_apart(&self) -> bool {
        self.behind.is_some()
    }

    /// Whether mirrors show the background that is missing.
    fn is_reflected(&self, scene: &Scene, settings: &Settings) -> bool {
        self.is_apart() && settings.bounces_in(scene) > 0
    }

    /// Renders an image by `render`, and puts what is missing behind it; also returns its exposure in stops.
    pub(crate) fn picture(
        &self,
        prepared: &PreparedScene,
        settings: &Settings,
        host: &dyn Host,
        mut render: impl FnMut(&PreparedScene, &Settings, &dyn Host) -> Result<Frame, RenderError>,
    ) -> Result<(Frame, f32), RenderError> {
        self.image(&prepared.scene, settings, host, |background, settings, host| match background {
            None => render(prepared, settings, host),
            Some(background) => {
                let lights = prepared.scene.lights.clone().with_background(background);
                render(&prepared.with_lights(lights), settings, host)
            }
        })
    }

    /// How many times an image is rendered.
    pub(crate) fn times(&self, scene: &Scene, settings: &Settings) -> usize {
        let is_around = self.is_automatic() && settings.crop.is_some_and(|crop| !crop.is_within(settings.size));
        if self.is_reflected(scene, settings) || is_around { 2 } else { 1 }
    }

    /// The same for a scene that is prepared elsewhere: `render` may be told of a background that replaces the scene's.
    pub(crate) fn image<E>(
        &self,
        scene: &Scene,
        settings: &Settings,
        host: &dyn Host,
        mut render: impl FnMut(Option<Vec3>, &Settings, &dyn Host) -> Result<Frame, E>,
    ) -> Result<(Frame, f32), E> {
        let times = self.times(scene, settings);
        // An automatic exposure is that of the whole image.
        let mut settings = settings.clone();
        let crop = settings.crop.take_if(|_| self.is_automatic());
        // What lies around the image is not in it.
        let around = crop.filter(|crop| !crop.is_within(settings.size));
        settings.transparent |= self.is_apart();
        let is_reflected = self.is_reflected(scene, &settings);
        let (mut parts, start) = (Parts::new(times), Instant::now());
        let mut frame = render(None, &settings, &parts.next(host))?;
        parts.took(start.elapsed().as_secs_f64());
        let stops = self.stops(&frame, host);
        settings.crop = settings.crop.or(around);
        let background = self.background(stops);
        if let Some(background) = background
            && is_reflected
            && !host.cancelled()
        {
            settings.transparent = false;
            frame = render(Some(background), &settings, &parts.next(host))?;
        } else {
            if around.is_some() {
                frame = render(None, &settings, &parts.next(host))?;
            }
            if let Some(background) = background {
                frame = self.put_behind(frame, background);
            }
        }
        if let Some(crop) = crop.filter(|_| around.is_none()) {
            frame = frame.cropped(crop).expect("settings were checked: the crop is in the image");
        }
        Ok((frame, stops))
    }

    /// The background of an image that was rendered without it.
    fn background(&self, stops: f32) -> Option<Vec3> {
        self.behind.map(|behind| behind.radiance(stops))
    }

    /// Puts a background behind such an image.
    fn put_behind(&self, frame: Frame, background: Vec3) -> Frame {
        let Frame { image, mut stats } = frame;
        (stats.settings.background, stats.settings.transparent) = (background.to_array(), false);
        Frame { image: image.over(background.to_array()), stats }
    }

    /// The exposure in stops.
    fn stops(&self, frame: &Frame, host: &dyn Host) -> f32 {
        match self.exposure {
            Exposure::Stops(_) if self.keeps_highlights => {
                let stops = finished_part(frame).highlight_exposure();
                if stops != 0.0 {
                    host.note(&format!(
                        "exposure: using {stops} stops, by what is bright ({} keeps the light as it is)",
                        host.words().with("exposure", 0)
                    ));
                }
                stops
            }
            Exposure::Stops(stops) => stops,
            Exposure::Auto => {
                let stops = finished_part(frame).auto_exposure();
                let keeps = host.words().with("exposure", stops);
                host.note(&format!("exposure auto: using {stops} stops ({keeps} keeps this value)"));
                stops
            }
        }
    }
}

impl Behind {
    fn radiance(self, stops: f32) -> Vec3 {
        match self {
            Behind::Radiance(radiance) => radiance,
            Behind::Shown(shown) => Vec3::splat(shown * (-stops).exp2()),
        }
    }
}

/// The exposure of image files that are asked for with `chosen`. Candela and lux say nothing of the range of a screen, nor does a sky of what is
/// seen `indoors`.
fn exposure(scene: &Scene, chosen: Option<Exposure>, indoors: bool) -> Exposure {
    let photometric = scene.lights.iter().any(|light| light.falloff == Falloff::InverseSquare);
    match chosen {
        Some(chosen) => chosen,
        None if photometric || indoors => Exposure::Auto,
        None => Exposure::Stops(0.0),
    }
}

/// The rows of an image that are finished.
fn finished_part(frame: &Frame) -> Cow<'_, image::Frame> {
    let ([width, height], rows) = (frame.size(), frame.finished_rows());
    let finished = || frame.color()[..width as usize * rows as usize].to_vec();
    match rows {
        rows if rows == height => Cow::Borrowed(&frame.image),
        rows => image::Frame::new(width, rows, finished()).map_or(Cow::Borrowed(&frame.image), Cow::Owned),
    }
}
