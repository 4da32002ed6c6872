//! The JSON Schema of scene files, generated from [`schema`](super::schema): doc comments are its descriptions.

use schemars::{Schema, generate::SchemaSettings, transform::RecursiveTransform};
use serde_json::{Map, Value};

use super::schema::SceneFile;
use crate::Scene;

impl Scene {
    /// The JSON Schema (draft 2020-12) of scene files in TOML: the keys, their meanings and their types. For editors and
    /// validators. Constraints between keys are only checked when a file is read.
    pub fn file_schema() -> String {
        let settings = SchemaSettings::draft2020_12().with_transform(RecursiveTransform(plainly));
        let schema = settings.into_generator().into_root_schema_for::<SceneFile>();
        format!("{:#}\n", schema.as_value())
    }
}

/// Removes `null`, which TOML does not have: an optional key is simply absent. Line breaks are removed from descriptions.
fn plainly(schema: &mut Schema) {
    let Some(schema) = schema.as_object_mut() else { return };
    if let Some(Value::String(text)) = schema.get_mut("description") {
        *text = text.replace('\n', " ");
    }
    if let Some(Value::Array(types)) = schema.get_mut("type") {
        types.retain(|name| name != "null");
        if let [name] = types.as_slice() {
            let name = name.clone();
            schema.insert("type".to_owned(), name);
        }
    }
    if let Some(Value::Array(choices)) = schema.get_mut("anyOf") {
        choices.retain(|choice| choice["type"] != "null");
        if let [Value::Object(only)] = choices.as_slice() {
            let only: Map<String, Value> = only.clone();
            schema.remove("anyOf");
            only.into_iter().for_each(|(key, value)| {
                schema.entry(key).or_insert(value);
            });
        }
    }
}
