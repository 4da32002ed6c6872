//! Files written by a render.

use std::path::Path;

use lightmesh_files::check_writable;
use lightmesh_image::{Display, ExrOptions, Format, SaveError, SaveOptions, check_image};

use super::destination::{Destination, check_one_on_stdout, is_standard};
use super::outputs::{Outputs, input};
use crate::error::{OutputError, RequestError};
use crate::film::Container;
use crate::order::Order;
use crate::request::Request;
use crate::value::{Background, Exposure, Switch, numbered};
use crate::words::{Name, Words};

/// The name of the image among the files.
const OUTPUT: Name = "output";

/// The output files.
pub struct PictureFiles {
    /// The image, or the movie that it becomes a frame of; `None` if it stays in memory.
    pub picture: Option<Destination>,
    /// Whether it is a movie.
    pub movie: Option<Container>,
    /// How it is stored, except for the exposure.
    pub options: SaveOptions,
    /// Exposure of 8-bit and 16-bit images; `None`: by the unit of the lights.
    pub exposure: Option<Exposure>,
    /// The multilayer exr.
    pub layers: Option<Destination>,
    /// The statistics.
    pub stats: Option<Destination>,
    /// All of them.
    pub outputs: Outputs,
}

impl PictureFiles {
    /// Checks that each file can be written, that its format can store the image, and that it overwrites none of the others.
    pub(crate) fn new(order: &Order) -> Result<PictureFiles, RequestError> {
        PictureFiles::named(order, None, |_, path| Ok(Destination::new(path)))
    }

    /// Those of a frame of a film.
    pub(crate) fn of_frame(order: &Order, number: u32) -> Result<PictureFiles, RequestError> {
        let movie = Container::from_path(order.files.picture());
        PictureFiles::named(order, movie, |flag, path| {
            if movie.is_some() && flag == OUTPUT {
                return Ok(Destination::File(path.to_owned()));
            }
            let file = numbered(path, number).map(Destination::File);
            file.ok_or_else(|| RequestError::NoNumber { output: flag, path: path.to_owned() })
        })
    }

    fn named(
        order: &Order,
        movie: Option<Container>,
        name: impl Fn(Name, &Path) -> Result<Destination, RequestError>,
    ) -> Result<PictureFiles, RequestError> {
        let picture = order.files.output.as_deref().map(|path| name(OUTPUT, path)).transpose()?;
        let layers = order.files.layers.as_deref().map(|path| name("layers", path)).transpose()?;
        let stats = order.files.stats.as_deref().map(|path| name("stats", path)).transpose()?;
        let options = save_options(&order.request);
        match &picture {
            Some(picture) if movie.is_some() => picture.check_writable().map_err(SaveError::from)?,
            Some(picture) => check_picture(picture, order, &options)?,
            None => {}
        }
        if let Some(layers) = &layers {
            check_layers(layers)?;
        }
        if let Some(stats) = &stats {
            stats.check_writable().map_err(OutputError::from)?;
        }
        let all = [(OUTPUT, picture.as_ref()), ("layers", layers.as_ref()), ("stats", stats.as_ref())];
        check_one_on_stdout(all)?;
        let all = all.map(|(flag, output)| (flag, output.and_then(Destination::file)));
        let mesh = order.files.mesh_file.as_deref();
        mesh.map_or(Ok(()), check_mesh)?;
        let outputs = Outputs::new(all.into_iter().chain([("mesh_file", mesh)]).chain(hours_of_sun(order)))?;
        outputs.keep("the scene", input(&order.scene))?;
        outputs.keep("grid_file", order.request.grid_file.as_deref())?;
        Ok(PictureFiles { picture, movie, options, exposure: order.request.exposure, layers, stats, outputs })
    }

    /// The files that are written for the image alone.
    pub fn paths(&self) -> impl Iterator<Item = &Path> {
        let picture = self.picture.as_ref().filter(|_| self.movie.is_none());
        [picture, self.layers.as_ref(), self.stats.as_ref()].into_iter().flatten().filter_map(Destination::file)
    }

    /// The format of the image.
    pub fn format(&self) -> Option<Format> {
        self.options.format_of(self.picture_file().unwrap_or(Path::new("")))
    }

    /// What to say if the extension of the image is that of another format than is written.
    pub(crate) fn misnamed(&self, words: Words) -> Option<String> {
        let path = self.picture_file()?;
        let (written, named) = (self.options.format?, Format::from_path(path)?);
        misnamed((OUTPUT, path), (written.name(), named.name()), words)
    }

    /// The file of the image, if it goes to one.
    pub(crate) fn picture_file(&self) -> Option<&Path> {
        self.picture.as_ref().and_then(Destination::file)
    }

    /// Where the image goes, for messages.
    pub fn picture_name(&self) -> String {
        self.picture.as_ref().map_or_else(String::new, ToString::to_string)
    }
}

/// What to say if a file is `written` in another format than its extension has `named`.
pub fn misnamed((output, path): (Name, &Path), (written, named): (&str, &str), words: Words) -> Option<String> {
    let (output, format, path_as_written) = (words.of(output), words.of("format"), path.with_extension(written));
    let article = if written.starts_with('e') { "an" } else { "a" };
    (written != named).then(|| {
        format!(
            "{output} {} is {article} {written} file, as {format} says, but its extension is that of {named} files; name it {}, or leave out {format}",
            path.display(),
            path_as_written.display(),
        )
    })
}

/// Files of `--sun-hours`, which is not one of an image.
pub(crate) fn hours_of_sun(order: &Order) -> impl Iterator<Item = (Name, Option<&Path>)> {
    order.files.sun_hours.iter().map(|path| ("sun_hours", Some(&**path)))
}

/// How image files store what they show, except for the exposure.
pub(crate) fn save_options(request: &Request) -> SaveOptions {
    let display = Display::default()
        .with_view(request.view)
        .with_transfer(request.transfer)
        .with_bit_depth(request.bit_depth)
        .with_dither(request.dither == Switch::On);
    let exr = ExrOptions::default()
        .with_samples(request.exr_type)
        .with_compression(request.exr_compression)
        .with_parts(request.exr_parts);
    SaveOptions::default().with_format(request.format).with_display(display).with_exr(exr)
}

/// Images that the format cannot store are rejected now rather than after the render.
fn check_picture(picture: &Destination, order: &Order, options: &SaveOptions) -> Result<(), RequestError> {
    picture.check_binary(OUTPUT)?;
    let path = match picture {
        Destination::Stdout if order.request.format.is_none() => return Err(RequestError::NoFormat),
        Destination::Stdout => Path::new("standard output"),
        Destination::File(path) => path,
    };
    let size = order.request.crop.map_or(order.request.size.0, |crop| crop.size);
    check_image(path, options, size, order.request.background == Some(Background::Transparent))?;
    Ok(picture.check_writable().map_err(SaveError::from)?)
}

/// A mesh is both read and written, which standard output cannot be.
fn check_mesh(path: &Path) -> Result<(), RequestError> {
    if is_standard(path) {
        Err(RequestError::MeshOnStdout)
    } else {
        Ok(check_writable(path).map_err(OutputError::from)?)
    }
}

fn check_layers(layers: &Destination) -> Result<(), RequestError> {
    layers.check_binary("layers")?;
    match layers.file() {
        Some(path) if Format::from_path(path) != Some(Format::Exr) => {
            Err(SaveError::LayersNeedExr { path: path.to_owned() }.into())
        }
        _ => Ok(layers.check_writable().map_err(SaveError::from)?),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_too_large_for_their_format_are_refused() {
        let fits = |name, size: [u32; 2]| check_image(name, &SaveOptions::default(), size, false).is_ok();
        assert!(fits("a.jpg", [65535, 65535]) && !fits("a.jpg", [65536, 1]) && !fits("a.jpeg", [1, 65536]));
        assert!(fits("a.bmp", [40_000, 30_000]) && !fits("a.bmp", [40_000, 40_000]));
        assert!(fits("a.png", [i32::MAX as u32, 1]) && !fits("a.exr", [1 << 31, 1]));
    }
}
