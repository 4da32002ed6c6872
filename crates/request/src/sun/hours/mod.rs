//! The hours of direct sun of what each pixel sees.
//!
//! ```text
//! hours(P) = Σ_k t_k V(S_k, P)
//! ```
//!
//! S_k is the sun at moment k, t_k the time for which the moment stands, and V the visible share of the sun's disc from the surface point P in
//! the middle of the pixel, 0 if the sun is behind the surface. Where no step is asked for, S_k is all that the disc passes over in that time
//! ([`suns`]). Suns of many moments are the lights of one image: camera rays are cast once for all of them, and neither sky nor reflected
//! light is computed. [`Glass`](lightmesh_render::Glass) says what panes and other surfaces do that let light through. Objects that few pixels
//! show are seen by more [points](finer) for the table.

mod colors;
mod finer;
mod found;
mod legend;
mod letters;
mod picture;
mod pixel_area;
mod points;
mod suns;
mod table;

use std::path::Path;
use std::time::Instant;

use glam::Vec3;
use lightmesh_image::{Description, EncodeError, ExrOptions, Format, Frame, Layers, Output, Ready, SaveOptions};
use lightmesh_render::{AmbientSource, Glass, PreparedScene, RenderError, Renderer, Settings};
use lightmesh_scene::{Light, Lights, Scene};
use rayon::prelude::*;

pub use found::SunHours;

use super::study::hours_file;
use super::{HoursFile, HoursFormat, SunStudy};
use crate::context::Context;
use crate::error::{Error, OutputError};
use crate::files::{publish, ready};
use crate::host::{Host, Parts, RENDERING};
use crate::words::Words;
use points::Finer;
use suns::{BYTES_AT_ONCE, MAX_AT_ONCE, suns};

/// Bytes of the layers of a light in a pixel.
const BYTES: usize = 16;
/// Materials that a note names.
const NAMED: usize = 4;

/// Computes the hours of direct sun and writes their files; returns what was done.
pub(super) fn write(study: &SunStudy, prepared: &PreparedScene, context: Context) -> Result<String, Error> {
    let Context { renderer, host, .. } = context;
    let start = Instant::now();
    let has_table = study.outputs.iter().any(HoursFile::is_table);
    let found = SunHours::of_study(study, prepared, has_table, context)?;
    let seconds = start.elapsed().as_secs_f64();
    let files = host.during("writing the hours of direct sun", || {
        renderer.install(|| study.outputs.iter().map(|output| found.file(output)).collect::<Result<_, _>>())
    })?;
    publish(files)?;
    if has_table {
        found.table_notes(host.words()).iter().for_each(|text| host.warning(text));
    }
    let names: Vec<String> = study.outputs.iter().map(|output| output.path.display().to_string()).collect();
    Ok(format!("hours of direct sun, {}: {seconds:.3} s, {}", study.suns(), names.join(", ")))
}

impl SunHours {
    /// The hours of the moments of a study, for what an image as planned shows; `has_table` if they may be asked for by object.
    pub(crate) fn of_study(
        study: &SunStudy,
        prepared: &PreparedScene,
        has_table: bool,
        context: Context,
    ) -> Result<SunHours, Error> {
        let Context { renderer, plan, host, .. } = context;
        let up = plan.staging.up_of(&prepared.scene.lights);
        let suns = suns(study, up, prepared.geometry.bounds).expect("the sun has a direction");
        let about_glass = about_glass(&prepared.scene, study.glass, host.words());
        about_glass.iter().for_each(|note| host.note(note));
        let glass = about_glass.map(|_| study.glass);
        let found = host.during(RENDERING, || {
            host.cancellable(|| SunHours::of(renderer, prepared, (&plan.settings, study, has_table), &suns, host))
        })?;
        Ok(SunHours { exr: plan.files.options.exr, glass, ..found })
    }

    /// The hours for which each of some `suns` shines on what each pixel of an image sees.
    fn of(
        renderer: &Renderer,
        prepared: &PreparedScene,
        (settings, study, has_table): (&Settings, &SunStudy, bool),
        suns: &[(Light, f64)],
        host: &dyn Host,
    ) -> Result<SunHours, RenderError> {
        let plain = settings.clone().with_bounces(0).with_ambient_light(AmbientSource::Constant).with_layers(true);
        let mut settings = plain.with_glass(study.glass);
        (settings.aa, settings.transparent, settings.partial) = (Some(1), false, false);
        let camera = settings.camera.clone().unwrap_or_else(|| prepared.scene.cameras[0].clone());
        let [width, height] = settings.crop.map_or(settings.size, |crop| crop.size).map(|side| side as usize);
        let at_once = (BYTES_AT_ONCE / (BYTES * width * height).max(1)).clamp(1, MAX_AT_ONCE);
        // Parts of about the same size.
        let at_once = suns.len().div_ceil(suns.len().div_ceil(at_once).max(1)).max(1);
        let (mut seen, mut hours) = (None, vec![0.0_f64; width * height]);
        // A night is an image, too: what the pixels see.
        let night = suns.is_empty().then_some(suns);
        let mut parts = Parts::new(suns.len().div_ceil(at_once).max(1));
        for suns in suns.chunks(at_once).chain(night) {
            let (start, part) = (Instant::now(), parts.next(host));
            let dark = |(light, _): &(Light, f64)| light.clone().with_intensity(Vec3::ZERO);
            let lights: Lights = suns.iter().map(dark).collect();
            let lit = prepared.with_lights(lights.with_ambient(Vec3::ZERO));
            let lightmesh_render::Frame { image: frame, stats } = renderer.render_prepared(&lit, &settings, &part)?;
            // What was chosen holds for all suns, and is told once.
            settings.samples = Some(stats.settings.samples.max(1));
            let Some(layers) = frame.layers() else { continue };
            for (plane, &(_, time)) in layers.visibility.iter().zip(suns) {
                let add = |(hours, &share): (&mut f64, &f32)| *hours += time * f64::from(share);
                hours.par_iter_mut().zip(plane).for_each(add);
            }
            seen.get_or_insert_with(|| without_light(frame));
            parts.took(start.elapsed().as_secs_f64());
        }
        let frame = seen.expect("there is an image at least");
        let layers = frame.layers().expect("they were asked for");
        let mask = layers.depth.iter().map(|depth| depth.is_finite()).collect();
        let hours = hours.into_iter().map(|hours| hours as f32).collect();
        let study = study.clone();
        let (exr, finer) = (ExrOptions::default(), Finer::default());
        let found = SunHours { study, exr, glass: None, frame, camera, hours, mask, finer };
        let finer = has_table.then(|| Finer::of(&found, renderer, prepared, (&settings, suns), host)).transpose()?;
        Ok(SunHours { finer: finer.unwrap_or_default(), ..found })
    }

    /// The hours as a picture with a legend.
    pub fn picture(&self) -> Frame {
        picture::picture(self, &self.study)
    }

    /// Writes an exr with the hours, a png with a legend, or a csv with a row for each object, by the extension.
    ///
    /// # Errors
    /// [`Error`]; no partial file is left.
    pub fn save(&self, path: &Path) -> Result<(), Error> {
        self.save_as(path, None)
    }

    /// The same in a format that the extension need not say.
    ///
    /// # Errors
    /// As [`SunHours::save`].
    pub fn save_as(&self, path: &Path, format: Option<HoursFormat>) -> Result<(), Error> {
        Ok(publish(vec![self.file(&hours_file(path, format)?)?])?)
    }

    /// The bytes of a file of this format.
    ///
    /// # Errors
    /// [`EncodeError`] if the format cannot store the hours.
    pub fn encode(&self, format: HoursFormat) -> Result<Vec<u8>, EncodeError> {
        match format {
            HoursFormat::Exr => {
                self.frame.encode_values(&[("hours", &self.hours), ("A", &self.alpha())], &self.exr_options())
            }
            HoursFormat::Png => self.picture().encode(Format::Png, &SaveOptions::default()),
            HoursFormat::Csv => Ok(self.table().into_bytes()),
        }
    }

    /// What to know of the [table](SunHours::table), in the words of a face: objects that no pixel sees, and rows that rest on few points.
    pub fn table_notes(&self, words: Words) -> Vec<String> {
        [self.unseen(words), self.short(words)].into_iter().flatten().collect()
    }

    /// What to say if pixels show some objects and not others.
    fn unseen(&self, words: Words) -> Option<String> {
        let (unseen, all) = table::unseen(self);
        let are = if unseen == 1 { "is" } else { "are" };
        (unseen > 0).then(|| {
            format!(
                "{unseen} of {all} objects {are} seen by no pixel, so the table has no hours of them; choose another camera or more pixels ({}, {})",
                words.of("camera"),
                words.of("size")
            )
        })
    }

    /// What to say if some objects are shown by too few points for a mean.
    fn short(&self, words: Words) -> Option<String> {
        let short = table::short(self);
        let objects = if short == 1 { "object rest" } else { "objects rest" };
        (short > 0).then(|| {
            format!(
                "hours of {short} {objects} on fewer than {} points of the surface, see the column `points` of the table; choose more pixels or \
                 a camera that is nearer ({}, {})",
                finer::ENOUGH,
                words.of("size"),
                words.of("camera")
            )
        })
    }

    /// Hours by object, as text with a row for each; without hours if no pixel sees the object.
    pub fn table(&self) -> String {
        table::table(self)
    }

    /// A complete file that appears when it is published.
    fn file(&self, output: &HoursFile) -> Result<Ready, Error> {
        match output.format {
            HoursFormat::Exr => self.exr(&output.path),
            HoursFormat::Png => {
                let options = SaveOptions::default().with_format(Format::Png);
                Ok(self.picture().ready_with(&output.path, &options)?)
            }
            HoursFormat::Csv => Ok(ready(&output.path, self.table().as_bytes())?),
        }
    }

    /// Hours, and whether there is a surface as alpha.
    fn exr(&self, path: &Path) -> Result<Ready, Error> {
        let output = Output::to(path).map_err(OutputError::from)?;
        let channels: [(&str, &[f32]); 2] = [("hours", &self.hours), ("A", &self.alpha())];
        Ok(self.frame.ready_values_to(output, &channels, &self.exr_options())?)
    }

    fn exr_options(&self) -> SaveOptions {
        let description = Description::default().with_software(concat!("Lightmesh ", env!("CARGO_PKG_VERSION")));
        SaveOptions::default().with_exr(self.exr).with_description(description)
    }

    /// 1 where there is a surface.
    fn alpha(&self) -> Vec<f32> {
        self.mask.iter().map(|&sees| f32::from(u8::from(sees))).collect()
    }
}

/// What to say of surfaces that let light through, if there are any.
fn about_glass(scene: &Scene, glass: Glass, words: Words) -> Option<String> {
    let geometry = &scene.geometry;
    let mut used = vec![false; geometry.materials.len()];
    geometry.mesh.materials.iter().for_each(|&material| used[material as usize] = true);
    let names: Vec<&str> = used
        .iter()
        .zip(&geometry.materials)
        .filter_map(|(&used, material)| (used && material.is_transmissive()).then_some(&*material.name))
        .collect();
    let what = match &names[..] {
        [] => return None,
        [""] => "1 material lets light through".to_owned(),
        [name] => format!("1 material lets light through ({name})"),
        names => {
            let first: Vec<&str> = names.iter().copied().filter(|name| !name.is_empty()).take(NAMED).collect();
            let more = if names.len() > first.len() { ", …" } else { "" };
            let first = if first.is_empty() { String::new() } else { format!(" ({}{more})", first.join(", ")) };
            format!("{} materials let light through{first}", names.len())
        }
    };
    Some(match glass {
        Glass::Closed => {
            format!("{what}: hours of direct sun count this as walls ({})", words.with("glass", glass))
        }
        Glass::Tinted => format!(
            "{what}: hours of direct sun count what is behind by the share of light that passes ({})",
            words.with("glass", glass)
        ),
        _ => format!(
            "{what}: hours of direct sun count this as open, except where it is at least half opaque; {} counts it as walls, {} by the share \
             of light that passes",
            words.with("glass", Glass::Closed),
            words.with("glass", Glass::Tinted)
        ),
    })
}

/// The frame without what belongs to single lights.
fn without_light(frame: Frame) -> Frame {
    let window = frame.window();
    let parts = frame.into_parts();
    let [width, height] = parts.size;
    let kept = |layers: Layers| Layers { visibility: Vec::new(), lights: Vec::new(), rest: Vec::new(), ..layers };
    let frame = Frame::new(width, height, parts.color).expect("its size is that of a frame");
    let frame = frame.with_layers(parts.layers.map(kept).unwrap_or_default()).expect("its layers are those of a frame");
    frame.with_window(window.first, window.whole)
}

#[cfg(test)]
mod tests;
