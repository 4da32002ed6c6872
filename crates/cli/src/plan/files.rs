//! Files written by a render.

use std::path::Path;

use lightmesh::SaveError;
use lightmesh::image::{Display, ExrOptions, Format, SaveOptions, check_image};

use super::{Container, PlanError};
use crate::args::{RenderArgs, StorageArgs, Switch};
use crate::destination::{Destination, check_one_on_stdout, is_standard};
use crate::output::{OutputError, Outputs, check_writable, input};
use crate::value::{Background, Exposure, numbered};

/// The flag of the image.
const OUTPUT: &str = "-o";

/// The output files.
pub(crate) struct PictureFiles {
    /// The image, or the movie that it becomes a frame of.
    pub(crate) picture: Destination,
    /// Whether it is a movie.
    pub(crate) movie: Option<Container>,
    /// How it is stored, except for the exposure.
    pub(crate) options: SaveOptions,
    /// Exposure of 8-bit and 16-bit images; `None`: by the unit of the lights.
    pub(crate) exposure: Option<Exposure>,
    /// The multilayer exr.
    pub(crate) layers: Option<Destination>,
    /// The statistics.
    pub(crate) stats: Option<Destination>,
    /// All of them.
    pub(crate) outputs: Outputs,
}

impl PictureFiles {
    /// Checks that each file can be written, that its format can store the image, and that it overwrites none of the others.
    pub(super) fn new(args: &RenderArgs) -> Result<PictureFiles, PlanError> {
        PictureFiles::named(args, None, |_, path| Ok(Destination::new(path)))
    }

    /// Those of a frame of a film.
    pub(super) fn of_frame(args: &RenderArgs, number: u32) -> Result<PictureFiles, PlanError> {
        let movie = Container::from_path(args.picture());
        PictureFiles::named(args, movie, |flag, path| {
            if movie.is_some() && flag == OUTPUT {
                return Ok(Destination::File(path.to_owned()));
            }
            let file = numbered(path, number).map(Destination::File);
            file.ok_or_else(|| PlanError::NoNumber { flag, path: path.to_owned() })
        })
    }

    fn named(
        args: &RenderArgs,
        movie: Option<Container>,
        name: impl Fn(&'static str, &Path) -> Result<Destination, PlanError>,
    ) -> Result<PictureFiles, PlanError> {
        let picture = name(OUTPUT, args.picture())?;
        let layers = args.layers.as_deref().map(|path| name("--layers", path)).transpose()?;
        let stats = args.stats.as_deref().map(|path| name("--stats", path)).transpose()?;
        let options = save_options(&args.storage);
        if movie.is_some() {
            picture.check_writable().map_err(SaveError::from)?;
        } else {
            check_picture(&picture, args, &options)?;
        }
        if let Some(layers) = &layers {
            check_layers(layers)?;
        }
        if let Some(stats) = &stats {
            stats.check_writable().map_err(OutputError::from)?;
        }
        let all = [(OUTPUT, Some(&picture)), ("--layers", layers.as_ref()), ("--stats", stats.as_ref())];
        check_one_on_stdout(all)?;
        let all = all.map(|(flag, output)| (flag, output.and_then(Destination::file)));
        let mesh = args.mesh_file.as_deref();
        mesh.map_or(Ok(()), check_mesh)?;
        let outputs = Outputs::new(all.into_iter().chain([("--mesh-file", mesh)]).chain(hours_of_sun(args)))?;
        outputs.keep("the scene", input(&args.scene.scene))?;
        outputs.keep("--grid-file", args.image.grid_file.as_deref())?;
        Ok(PictureFiles { picture, movie, options, exposure: args.exposure.exposure, layers, stats, outputs })
    }

    /// The files that are written for the image alone.
    pub(crate) fn paths(&self) -> impl Iterator<Item = &Path> {
        let picture = Some(&self.picture).filter(|_| self.movie.is_none());
        [picture, self.layers.as_ref(), self.stats.as_ref()].into_iter().flatten().filter_map(Destination::file)
    }

    /// The format of the image.
    pub(crate) fn format(&self) -> Option<Format> {
        self.options.format_of(self.picture.file().unwrap_or(Path::new("")))
    }
}

/// Files of `--sun-hours`, which is not one of an image.
pub(super) fn hours_of_sun(args: &RenderArgs) -> impl Iterator<Item = (&'static str, Option<&Path>)> {
    args.sun_hours.iter().map(|path| ("--sun-hours", Some(&**path)))
}

/// How image files store what they show, except for the exposure.
pub(crate) fn save_options(args: &StorageArgs) -> SaveOptions {
    let display = Display::default()
        .with_view(args.view)
        .with_transfer(args.transfer)
        .with_bit_depth(args.bit_depth)
        .with_dither(args.dither == Switch::On);
    let exr = ExrOptions::default()
        .with_samples(args.exr_type)
        .with_compression(args.exr_compression)
        .with_parts(args.exr_parts);
    SaveOptions::default().with_format(args.format).with_display(display).with_exr(exr)
}

/// Images that the format cannot store are rejected now rather than after the render.
fn check_picture(picture: &Destination, args: &RenderArgs, options: &SaveOptions) -> Result<(), PlanError> {
    picture.check_binary(OUTPUT)?;
    let path = match picture {
        Destination::Stdout if args.storage.format.is_none() => return Err(PlanError::NoFormat),
        Destination::Stdout => Path::new("standard output"),
        Destination::File(path) => path,
    };
    let size = args.image.crop.map_or(args.image.size.0, |crop| crop.size);
    check_image(path, options, size, args.image.background == Some(Background::Transparent))?;
    Ok(picture.check_writable().map_err(SaveError::from)?)
}

/// A mesh is both read and written, which standard output cannot be.
fn check_mesh(path: &Path) -> Result<(), PlanError> {
    if is_standard(path) { Err(PlanError::MeshOnStdout) } else { Ok(check_writable(path)?) }
}

fn check_layers(layers: &Destination) -> Result<(), PlanError> {
    layers.check_binary("--layers")?;
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
