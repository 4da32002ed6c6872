//! Flag values that are chosen from a list. Where the library has the list, names and help texts come from there.

use std::str::FromStr;

use clap::ValueEnum;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use lightmesh::scene::Instancing;

/// Parses one of these names, each of which has a help text.
fn one_of<T>(names: impl Iterator<Item = (&'static str, &'static str)>) -> impl TypedValueParser<Value = T>
where
    T: FromStr<Err: std::error::Error + Send + Sync + 'static> + Clone + Send + Sync + 'static,
{
    let values = names.map(|(name, help)| PossibleValue::new(name).help(help.trim_end_matches('.')));
    PossibleValuesParser::new(values).try_map(|name| name.parse())
}

pub(super) fn instances() -> impl TypedValueParser<Value = Instancing> {
    one_of(Instancing::ALL.iter().map(|instancing| (instancing.name(), instancing.help())))
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
