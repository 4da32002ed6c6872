//! Files written by a render.

use std::path::{Path, PathBuf};

use lightmesh::SaveError;
use lightmesh::image::{Display, ExrOptions, Format, SaveOptions, check_options, check_size, check_writable};

use super::PlanError;
use crate::args::{RenderArgs, Switch};
use crate::output::{self, Outputs};
use crate::value::{Background, Exposure};

/// The output files.
pub(crate) struct PictureFiles {
    /// The image.
    pub(crate) picture: PathBuf,
    /// How it is stored, except for the exposure.
    pub(crate) options: SaveOptions,
    /// Exposure of 8-bit and 16-bit images; `None`: by the unit of the lights.
    pub(crate) exposure: Option<Exposure>,
    /// The multilayer exr.
    pub(crate) layers: Option<PathBuf>,
    /// The statistics.
    pub(crate) stats: Option<PathBuf>,
    /// All of them.
    pub(crate) outputs: Outputs,
}

impl PictureFiles {
    /// Checks that each file can be written, that its format can store the image, and that it overwrites none of the others.
    pub(super) fn new(args: &RenderArgs) -> Result<PictureFiles, PlanError> {
        check_writable(&args.output)?;
        let [width, height] = args.crop.map_or(args.size.0, |crop| crop.size);
        // Images that the format cannot store are rejected now rather than after the render.
        check_size(&args.output, width, height)?;
        let options = options(args);
        check_options(&args.output, &options, args.background == Some(Background::Transparent))?;
        if let Some(layers) = &args.layers {
            check_layers(layers)?;
        }
        if let Some(stats) = &args.stats {
            output::check_writable(stats)?;
        }
        let outputs = Outputs::new([
            ("-o", Some(&*args.output)),
            ("--layers", args.layers.as_deref()),
            ("--stats", args.stats.as_deref()),
        ])?;
        outputs.keep("the scene", [&*args.scene.scene])?;
        outputs.keep("--grid-file", args.grid_file.as_deref())?;
        Ok(PictureFiles {
            picture: args.output.clone(),
            options,
            exposure: args.exposure,
            layers: args.layers.clone(),
            stats: args.stats.clone(),
            outputs,
        })
    }
}

fn options(args: &RenderArgs) -> SaveOptions {
    let display = Display::default()
        .with_view(args.view)
        .with_transfer(args.transfer)
        .with_bit_depth(args.bit_depth)
        .with_dither(args.dither == Switch::On);
    let exr = ExrOptions::default().with_samples(args.exr_type).with_compression(args.exr_compression);
    SaveOptions::default().with_display(display).with_exr(exr)
}

fn check_layers(path: &Path) -> Result<(), SaveError> {
    check_writable(path)?;
    match Format::from_path(path) {
        Some(Format::Exr) => Ok(()),
        _ => Err(SaveError::LayersNeedExr { path: path.to_owned() }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_too_large_for_their_format_are_refused() {
        let fits = |name, [width, height]: [u32; 2]| check_size(name, width, height).is_ok();
        assert!(fits("a.jpg", [65535, 65535]) && !fits("a.jpg", [65536, 1]) && !fits("a.jpeg", [1, 65536]));
        assert!(fits("a.bmp", [40_000, 30_000]) && !fits("a.bmp", [40_000, 40_000]));
        assert!(fits("a.png", [i32::MAX as u32, 1]) && !fits("a.exr", [1 << 31, 1]));
    }
}
