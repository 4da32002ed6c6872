//! Storing an image: its files appear together, and say how it was made.

use std::time::Instant;

use glam::{DMat4, Vec3};
use lightmesh_files::Ready;
use lightmesh_image::{Description, Format, Frame as Image, SaveError, SaveOptions};
use lightmesh_render::Frame;
use lightmesh_scene::Scene;

use crate::clipping;
use crate::context::Context;
use crate::error::Error;
use crate::expose::Metering;
use crate::files::{PictureFiles, json, publish};
use crate::report::Report;

/// Writes all files of an image, and warns of what may be wrong with it.
pub(crate) fn save(
    frame: &mut Frame,
    stops: f32,
    files: &PictureFiles,
    scene: &Scene,
    metering: &Metering,
    context: Context,
) -> Result<(), Error> {
    let host = context.host;
    let odd = frame.stats.counts.non_finite_pixels;
    if odd > 0 {
        let of = frame.stats.counts.pixels;
        let text = format!(
            "{odd} of {of} pixels have infinite or undefined colours: lower the intensities of lights or the coefficients of materials"
        );
        host.warning_about("non-finite", &text);
    }
    if files.format() != Some(Format::Exr) {
        let display = files.options.display.with_exposure(stops);
        let warnings = clipping::warnings(frame, &display, metering.has_ground(), host.words());
        warnings.iter().for_each(|(what, text)| host.warning_about(what, text));
    }
    let options = stored(files.options.clone(), stops, describe(frame, scene));
    host.during("writing the image", || write(frame, scene, files, &options, context))
}

/// Writes all files, which appear together; the statistics last, because they include the time taken by the others.
fn write(
    frame: &mut Frame,
    scene: &Scene,
    files: &PictureFiles,
    options: &SaveOptions,
    Context { renderer, plan, .. }: Context,
) -> Result<(), Error> {
    let start = Instant::now();
    let mut outputs = renderer.install(|| encode(&frame.image, files, options))?;
    frame.stats.seconds.write = start.elapsed().as_secs_f64();
    if let Some(destination) = &files.stats {
        let lights = scene.info().lights;
        let report = Report::new(&frame.stats, (plan, files), options, &lights);
        outputs.push(destination.ready(json(&report).as_bytes())?);
    }
    Ok(publish(outputs)?)
}

/// The image and the layers, encoded at the same time: while one waits for the disk, the other is compressed.
fn encode(image: &Image, files: &PictureFiles, options: &SaveOptions) -> Result<Vec<Ready>, SaveError> {
    let picture = files.picture.as_ref().filter(|_| files.movie.is_none());
    let (picture, layers) = rayon::join(
        || picture.map(|picture| image.ready_to(picture.open()?, options)).transpose(),
        || files.layers.as_ref().map(|layers| image.ready_layers_to(layers.open()?, options)).transpose(),
    );
    Ok(layers?.into_iter().chain(picture?).collect())
}

/// Settings that say nothing about an image: the machine, and ways to the same result.
const MACHINE: [&str; 6] = ["device", "threads", "memory_limit", "rows_per_band", "accel", "short_tests"];

/// The options of a file that shows an image at `stops`, and says how it was made.
pub(crate) fn stored(mut options: SaveOptions, stops: f32, description: Description) -> SaveOptions {
    options.display.exposure = stops;
    options.with_description(description)
}

/// What exr files say about an image of a scene, which its first camera sees.
pub fn describe(frame: &Frame, scene: &Scene) -> Description {
    let mut settings = serde_json::json!(frame.stats.settings);
    // The bytes of an image do not depend on the machine.
    if let Some(settings) = settings.as_object_mut() {
        MACHINE.iter().for_each(|&name| drop(settings.remove(name)));
    }
    let description = Description::default()
        .with_software(concat!("Lightmesh ", env!("CARGO_PKG_VERSION")))
        .with_scene(&*frame.stats.scene.name)
        .with_settings(settings.to_string());
    let Some(camera) = scene.cameras.first() else { return description };
    // Where the scene's local frame lies.
    let origin = scene.to_world(Vec3::ZERO);
    let [width, height] = frame.stats.settings.size.map(f64::from);
    // Columns of a matrix for column vectors are rows of one for row vectors.
    let rows = |matrix: DMat4| matrix.as_mat4().to_cols_array();
    description.with_camera(rows(camera.from_world(origin)), rows(camera.from_world_to_image(origin, width / height)))
}
