//! Flag values that are chosen from a list. Where the library has the list, names and help texts come from there.

use std::str::FromStr;

use clap::ValueEnum;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use lightmesh::scene::{Falloff, Instancing, SceneFormat, Weight};
use lightmesh::{
    Acceleration, Lookup, Mode, Transfer,
    image::{BitDepth, ExrCompression, ExrParts, ExrSamples, Format, View},
    render::{AmbientSource, Filter, Quality, ShortTests},
    scene,
};

/// Parses one of these names, each of which has a help text.
fn one_of<T>(names: impl Iterator<Item = (&'static str, &'static str)>) -> impl TypedValueParser<Value = T>
where
    T: FromStr<Err: std::error::Error + Send + Sync + 'static> + Clone + Send + Sync + 'static,
{
    let values = names.map(|(name, help)| PossibleValue::new(name).help(help.trim_end_matches('.')));
    PossibleValuesParser::new(values).try_map(|name| name.parse())
}

pub(super) fn mode() -> impl TypedValueParser<Value = Mode> {
    one_of(Mode::ALL.iter().map(|mode| (mode.name(), mode.help())))
}

pub(super) fn weight() -> impl TypedValueParser<Value = Weight> {
    one_of(Weight::ALL.iter().map(|weight| (weight.name(), weight.help())))
}

pub(super) fn lookup() -> impl TypedValueParser<Value = Lookup> {
    one_of(Lookup::ALL.iter().map(|lookup| (lookup.name(), lookup.help())))
}

pub(super) fn ambient_light() -> impl TypedValueParser<Value = AmbientSource> {
    one_of(AmbientSource::ALL.iter().map(|source| (source.name(), source.help())))
}

pub(super) fn quality() -> impl TypedValueParser<Value = Quality> {
    one_of(Quality::ALL.iter().map(|quality| (quality.name(), quality.help())))
}

pub(super) fn filter() -> impl TypedValueParser<Value = Filter> {
    one_of(Filter::ALL.iter().map(|filter| (filter.name(), filter.help())))
}

pub(super) fn short_tests() -> impl TypedValueParser<Value = ShortTests> {
    one_of(ShortTests::ALL.iter().map(|tests| (tests.name(), tests.help())))
}

/// See `plan::settings` for how it is resolved.
pub(super) fn acceleration() -> impl TypedValueParser<Value = Acceleration> {
    one_of(Acceleration::ALL.iter().map(|structure| (structure.name(), structure.help())))
}

pub(super) fn instances() -> impl TypedValueParser<Value = Instancing> {
    one_of(Instancing::ALL.iter().map(|instancing| (instancing.name(), instancing.help())))
}

pub(super) fn falloff() -> impl TypedValueParser<Value = Falloff> {
    one_of(Falloff::ALL.iter().map(|falloff| (falloff.name(), falloff.help())))
}

pub(super) fn transfer() -> impl TypedValueParser<Value = Transfer> {
    one_of(Transfer::ALL.iter().map(|transfer| (transfer.name(), transfer.help())))
}

pub(super) fn view() -> impl TypedValueParser<Value = View> {
    one_of(View::ALL.iter().map(|view| (view.name(), view.help())))
}

pub(super) fn image_format() -> impl TypedValueParser<Value = Format> {
    let built = Format::ALL.iter().filter(|format| format.is_built());
    one_of(built.map(|format| (format.name(), format.help())))
}

pub(super) fn scene_format() -> impl TypedValueParser<Value = SceneFormat> {
    one_of(SceneFormat::ALL.iter().map(|format| (format.name(), format.help())))
}

pub(super) fn exr_type() -> impl TypedValueParser<Value = ExrSamples> {
    one_of(ExrSamples::ALL.iter().map(|samples| (samples.name(), samples.help())))
}

pub(super) fn exr_compression() -> impl TypedValueParser<Value = ExrCompression> {
    one_of(ExrCompression::ALL.iter().map(|method| (method.name(), method.help())))
}

pub(super) fn exr_parts() -> impl TypedValueParser<Value = ExrParts> {
    one_of(ExrParts::ALL.iter().map(|parts| (parts.name(), parts.help())))
}

pub(super) fn bit_depth() -> impl TypedValueParser<Value = BitDepth> {
    PossibleValuesParser::new([
        PossibleValue::new("8").help("256 codes, as screens show"),
        PossibleValue::new("16").help("65536 codes, for further grading"),
    ])
    .map(|bits| if bits == "16" { BitDepth::Sixteen } else { BitDepth::Eight })
}

/// Something that is on or off.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Switch {
    On,
    Off,
}

/// The up axis.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Up {
    /// z for STL, y for others; for OBJ, PLY and STL without a camera, by the shape
    Auto,
    /// glTF, most OBJ
    Y,
    /// CAD, most STL
    Z,
}

impl Up {
    /// The up axis of a scene of this format; built-in ones have none.
    pub(crate) fn of(self, format: Option<SceneFormat>) -> scene::Up {
        match self {
            Up::Auto => format.map_or(scene::Up::Y, SceneFormat::usual_up),
            Up::Y => scene::Up::Y,
            Up::Z => scene::Up::Z,
        }
    }
}

/// How progress is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Progress {
    /// A bar on a terminal, elsewhere a line every ten seconds; nothing with --quiet
    Auto,
    /// As auto, also with --quiet
    Bar,
    /// One JSON object per line
    Json,
    /// Nothing
    None,
}
