//! The flags of `lightmesh render`, for programs that hold scenes and frames themselves.
//!
//! A request is made of [`Flag`]s and says what the command line says, in the same words when something is wrong. What it is of decides which flags
//! there are: of an [image](ImageRequest), of [reading a scene](load_options), of [storing an image](StorageRequest).

use clap::{ArgAction, Args, Command};
use glam::Vec3;
use lightmesh::image::{Description, SaveOptions};
use lightmesh::render::{PreparedScene, Setting};
use lightmesh::scene::{Camera, LoadOptions, SceneFormat, Up};
use lightmesh::{Acceleration, Frame, Observer, RenderError, Scene, Settings};

use crate::args::{ExposureArgs, FormArgs, ImageArgs, ReadingArgs, StorageArgs};
use crate::plan::scene::Applied;
pub use crate::plan::scene::ChoiceError;
use crate::plan::{self, PlanError, SceneChoices};
use crate::run::{Metering, describe, exposure, read_options};
use crate::value::{Exposure, Smooth};

/// A flag as it would be typed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Flag {
    /// Its name, without the two dashes.
    pub name: String,
    /// What comes after it.
    pub value: FlagValue,
}

/// The value of a flag.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FlagValue {
    /// The flag alone, or that it is not given. To flags that are on or off, this is said.
    Switch(bool),
    /// The text after it; more than one if the flag is repeated.
    Texts(Vec<String>),
}

/// Invalid option.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RequestError {
    /// There is no such flag.
    #[error("there is no setting {name}{}", similar.as_ref().map_or(String::new(), |similar| format!("; did you mean {similar}?")))]
    Unknown {
        /// The name that was given.
        name: String,
        /// One like it.
        similar: Option<String>,
    },
    /// A value cannot be used; in the words of the command line.
    #[error("{0}")]
    Value(String),
}

impl From<PlanError> for RequestError {
    fn from(error: PlanError) -> RequestError {
        RequestError::Value(error.to_string())
    }
}

/// Flags of reading a scene.
#[derive(Debug, Args)]
struct OpenFlags {
    #[command(flatten)]
    reading: ReadingArgs,
    #[command(flatten)]
    form: FormArgs,
}

/// Flags of an image.
#[derive(Debug, Args)]
struct ImageFlags {
    #[command(flatten)]
    image: ImageArgs,
    #[command(flatten)]
    exposure: ExposureArgs,
    /// As `--layers FILE`, without the file.
    #[arg(long)]
    layers: bool,
    /// As for `lightmesh render`.
    #[arg(long)]
    memory_limit: Option<crate::value::ByteSize>,
}

/// Flags of storing an image.
#[derive(Debug, Args)]
struct StorageFlags {
    #[command(flatten)]
    storage: StorageArgs,
    #[command(flatten)]
    exposure: ExposureArgs,
}

/// How a scene is read: by `--scene-format`, `--smooth`, `--instances`, `--animation`, `--allow-outside`, `--strict` and `--memory-limit`.
///
/// # Errors
/// [`RequestError`] for an unknown flag or an invalid value.
pub fn load_options(flags: &[Flag]) -> Result<LoadOptions, RequestError> {
    let OpenFlags { reading, form } = parse(flags)?;
    let smooth = form.smooth.unwrap_or(Smooth::default()).0;
    Ok(read_options(reading, plan::MeshForm { smooth, instancing: form.instances }, form.animation.as_deref()))
}

/// An image of a scene that is given apart.
pub struct ImageRequest {
    settings: Settings,
    choices: SceneChoices,
    exposure: Option<Exposure>,
}

impl ImageRequest {
    /// By flags of `lightmesh render` that say what an image shows and how it is computed, `--exposure`, `--memory-limit`, and the switch
    /// `--layers`. `format` is that of the file the scene was read from: some have their own idea of what is up.
    ///
    /// # Errors
    /// [`RequestError`] for an unknown flag or an invalid value.
    pub fn new(flags: &[Flag], format: Option<SceneFormat>) -> Result<ImageRequest, RequestError> {
        let ImageFlags { image, exposure, layers, memory_limit } = parse(flags)?;
        let memory_limit = memory_limit.map(|limit| limit.0);
        let settings = plan::settings(&image, format, memory_limit)?.with_layers(layers);
        let choices = SceneChoices::new(&image, format, memory_limit).map_err(PlanError::from)?;
        Ok(ImageRequest { settings, choices, exposure: exposure.exposure })
    }

    /// The same for a picture to look at, as `lightmesh render` makes it: under a sky, a model stands on a ground before the horizon.
    pub fn of_picture(self) -> ImageRequest {
        ImageRequest { choices: self.choices.of_picture(true), ..self }
    }

    /// The settings of the renderer.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// The acceleration structure, which has to be built anew if it is another one.
    pub fn acceleration(&self) -> &Acceleration {
        &self.settings.acceleration
    }

    /// Changes a scene as the flags say, and adds what it lacks: camera, lights, a ground.
    ///
    /// # Errors
    /// [`ChoiceError`] for an unknown camera or invalid surroundings.
    pub fn stage(&self, scene: &mut Scene, observer: &dyn Observer) -> Result<Staged, ChoiceError> {
        let Applied { behind, ground, outdoors, indoors } = self.choices.apply(scene, observer)?;
        let exposure = exposure(scene, self.exposure, indoors);
        let metering = Metering::new(scene, exposure, self.settings.transparent, behind);
        Ok(Staged { metering: metering.of_highlights(outdoors, self.exposure), ground })
    }
}

/// How the image of a scene is exposed that was [staged](ImageRequest::stage).
pub struct Staged {
    metering: Metering,
    ground: Option<Up>,
}

impl Staged {
    /// The axis across the ground that was added to the scene's geometry, if there is one.
    pub fn ground(&self) -> Option<Up> {
        self.ground
    }

    /// Renders the image by `render`, which may be called twice: with a ground that mirrors show. Returns it with the exposure of image files, in
    /// stops.
    ///
    /// # Errors
    /// Those of `render`.
    pub fn picture(
        &self,
        prepared: &PreparedScene,
        settings: &Settings,
        observer: &dyn Observer,
        render: impl FnMut(&PreparedScene, &Settings) -> Result<Frame, RenderError>,
    ) -> Result<(Frame, f32), RenderError> {
        self.metering.picture(prepared, settings, observer, render)
    }
}

/// How an image is stored.
pub struct StorageRequest {
    options: SaveOptions,
    exposure: Option<Exposure>,
}

impl StorageRequest {
    /// By `--format`, `--transfer`, `--exposure`, `--view`, `--bit-depth`, `--dither` and those of exr files.
    ///
    /// # Errors
    /// [`RequestError`] for an unknown flag or an invalid value.
    pub fn new(flags: &[Flag]) -> Result<StorageRequest, RequestError> {
        let StorageFlags { storage, exposure } = parse(flags)?;
        Ok(StorageRequest { options: plan::save_options(&storage), exposure: exposure.exposure })
    }

    /// The options for a frame, which is shown at `stops` if the flags do not say otherwise.
    pub fn options(&self, frame: &Frame, stops: f32, description: Description) -> SaveOptions {
        let stops = match self.exposure {
            None => stops,
            Some(Exposure::Stops(stops)) => stops,
            Some(Exposure::Auto) => frame.image.auto_exposure(),
        };
        let mut options = self.options.clone().with_description(description);
        options.display.exposure = stops;
        options
    }
}

/// What exr files say about an image of a scene.
pub fn description(frame: &Frame, scene: &Scene, camera: Option<&Camera>) -> Description {
    describe(frame, scene.to_world(Vec3::ZERO), camera)
}

/// The name of the flag for a setting that a message of the renderer mentions.
pub fn flag_of(setting: Setting) -> String {
    crate::flags::of(setting)
}

/// Parses flags as clap parses the command line.
fn parse<A: Args>(flags: &[Flag]) -> Result<A, RequestError> {
    let mut command = A::augment_args(Command::new("lightmesh")).no_binary_name(true).disable_help_flag(true);
    command.build();
    let mut line = Vec::new();
    for Flag { name, value } in flags {
        let of_name = |argument: &&clap::Arg| argument.get_long() == Some(&**name);
        let Some(argument) = command.get_arguments().find(of_name) else {
            let names = command.get_arguments().filter_map(clap::Arg::get_long);
            return Err(RequestError::Unknown { name: name.clone(), similar: nearest(name, names) });
        };
        let is_switch = matches!(argument.get_action(), ArgAction::SetTrue);
        match value {
            FlagValue::Switch(is_on) if is_switch => line.extend(is_on.then(|| format!("--{name}"))),
            FlagValue::Switch(is_on) => line.push(format!("--{name}={}", if *is_on { "on" } else { "off" })),
            FlagValue::Texts(texts) => line.extend(texts.iter().map(|text| format!("--{name}={text}"))),
        }
    }
    let matches = command.try_get_matches_from(line).map_err(|error| RequestError::Value(sentence(&error)))?;
    A::from_arg_matches(&matches).map_err(|error| RequestError::Value(sentence(&error)))
}

/// A name like this one, if there is one.
fn nearest<'a>(name: &str, names: impl Iterator<Item = &'a str>) -> Option<String> {
    const ALIKE: f64 = 0.75;
    let likeness = |other: &str| strsim::jaro(name, other);
    let nearest = names.max_by(|a, b| likeness(a).total_cmp(&likeness(b)))?;
    (likeness(nearest) > ALIKE).then(|| nearest.to_owned())
}

/// What the parser says, without the advice for the command line.
fn sentence(error: &clap::Error) -> String {
    let text = error.render().to_string();
    let first = text.split("\n\n").next().unwrap_or_default();
    first.trim_start_matches("error: ").trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flag(name: &str, text: &str) -> Flag {
        Flag { name: name.to_owned(), value: FlagValue::Texts(vec![text.to_owned()]) }
    }

    fn switch(name: &str, is_on: bool) -> Flag {
        Flag { name: name.to_owned(), value: FlagValue::Switch(is_on) }
    }

    fn image(flags: &[Flag]) -> Result<Settings, String> {
        ImageRequest::new(flags, None).map(|request| request.settings().clone()).map_err(|error| error.to_string())
    }

    #[test]
    fn flags_say_what_they_say_on_the_command_line() {
        let settings =
            image(&[flag("size", "64x48"), flag("quality", "draft"), switch("layers", true), switch("partial", false)])
                .unwrap();
        assert_eq!((settings.size, settings.layers), ([64, 48], true));
        assert_eq!(image(&[]).unwrap(), Settings::default());
    }

    #[test]
    fn messages_are_those_of_the_command_line() {
        let text = image(&[flag("quality", "fast")]).unwrap_err();
        assert!(
            text.starts_with("invalid value 'fast' for '--quality <QUALITY>'\n  [possible values: draft, "),
            "{text}"
        );
        assert_eq!(image(&[flag("qualty", "draft")]).unwrap_err(), "there is no setting qualty; did you mean quality?");
        assert_eq!(image(&[flag("turntable", "8")]).unwrap_err(), "there is no setting turntable");
        let crop = image(&[flag("crop", "60,0,10,10"), flag("size", "64x48")]).unwrap_err();
        assert!(crop.starts_with("--crop 60,0,10,10 exceeds the image of 64x48 pixels"), "{crop}");
    }

    #[test]
    fn scenes_are_read_smooth_unless_asked_otherwise() {
        let smooth = |flags: &[Flag]| format!("{:?}", load_options(flags).unwrap());
        assert_eq!(smooth(&[]), smooth(&[flag("smooth", "30")]));
        assert_ne!(smooth(&[]), smooth(&[flag("smooth", "off")]));
    }

    #[test]
    fn a_switch_may_be_on_or_off() {
        let dithers = |flags: &[Flag]| StorageRequest::new(flags).map(|request| request.options.display.dither);
        assert!(dithers(&[switch("dither", true)]).unwrap() && !dithers(&[switch("dither", false)]).unwrap());
        assert!(dithers(&[switch("view", true)]).is_err());
    }
}
