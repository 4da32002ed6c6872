//! Reads `[key]` and `[[key]]` alike. Not an untagged enum, because those lose the positions of values.

use std::{fmt, marker::PhantomData};

use schemars::JsonSchema;
use serde::{
    Deserialize, Deserializer,
    de::{MapAccess, SeqAccess, Visitor, value::MapAccessDeserializer},
};

use super::spanned::Spanned;

/// One table or an array of tables, as a list.
pub(super) fn deserialize<'de, T: Deserialize<'de>, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Vec<Spanned<T>>, D::Error> {
    // The span of a single table is only available from outside: `Spanned` around the list knows it.
    let list: Spanned<OneOrMany<T>> = Spanned::deserialize(deserializer)?;
    let span = list.span();
    Ok(match list.into_inner() {
        OneOrMany::One(table) => vec![Spanned::new(span, table)],
        OneOrMany::Many(tables) => tables,
    })
}

/// The accepted forms: only a schema and this module use it.
#[derive(JsonSchema)]
#[schemars(untagged, inline)]
pub(super) enum OneOrMany<T> {
    /// One table.
    One(T),
    /// An array of tables.
    Many(Vec<Spanned<T>>),
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for OneOrMany<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<OneOrMany<T>, D::Error> {
        deserializer.deserialize_any(TableOrArray(PhantomData))
    }
}

struct TableOrArray<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for TableOrArray<T> {
    type Value = OneOrMany<T>;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a table or an array of tables")
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<OneOrMany<T>, A::Error> {
        T::deserialize(MapAccessDeserializer::new(map)).map(OneOrMany::One)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<OneOrMany<T>, A::Error> {
        let mut tables = Vec::new();
        while let Some(table) = seq.next_element()? {
            tables.push(table);
        }
        Ok(OneOrMany::Many(tables))
    }
}
