//! The published schema is the one of the code, takes the scenes that come with the repository, and rejects slips.

use std::fs;
use std::path::Path;

use lightmesh_scene::Scene;
use serde_json::{Value, json};

fn repository() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../.."))
}

fn schema() -> Value {
    serde_json::from_str(&Scene::file_schema()).unwrap()
}

/// The problem with `value`, and its location; nothing if `schema` accepts it. Supports only the keywords that our schema uses.
fn faults(root: &Value, schema: &Value, value: &Value, place: &str) -> Vec<String> {
    let fault = |text: String| vec![format!("{place}: {text}")];
    let mut all = Vec::new();
    for (word, rule) in schema.as_object().expect("a schema is an object") {
        all.extend(match word.as_str() {
            "$schema" | "title" | "description" | "default" | "format" | "$defs" => Vec::new(),
            "$ref" => {
                let target =
                    root.pointer(rule.as_str().unwrap().trim_start_matches('#')).expect("a reference leads somewhere");
                faults(root, target, value, place)
            }
            "type" => match rule.as_array().map_or(vec![rule], |types| types.iter().collect()) {
                types if types.iter().any(|name| is_of(value, name.as_str().unwrap())) => Vec::new(),
                types => fault(format!("{value} is none of {types:?}")),
            },
            "const" if value != rule => fault(format!("{value} is not {rule}")),
            "enum" if !rule.as_array().unwrap().contains(value) => fault(format!("{value} is none of {rule}")),
            "const" | "enum" => Vec::new(),
            "anyOf" | "oneOf" => {
                let takes = |rule: &&Value| faults(root, rule, value, place).is_empty();
                match rule.as_array().unwrap().iter().filter(takes).count() {
                    0 => fault(format!("{value} is none of what is allowed")),
                    _ => Vec::new(),
                }
            }
            "properties" => {
                let known = rule.as_object().unwrap();
                let there = value.as_object().into_iter().flatten();
                there
                    .filter_map(|(key, value)| Some(faults(root, known.get(key)?, value, &format!("{place}.{key}"))))
                    .flatten()
                    .collect()
            }
            "additionalProperties" => {
                assert_eq!(rule, &json!(false));
                let unknown = |key: &&String| schema["properties"].get(key.as_str()).is_none();
                value
                    .as_object()
                    .into_iter()
                    .flat_map(|table| table.keys())
                    .filter(unknown)
                    .flat_map(|key| fault(format!("no key {key}")))
                    .collect()
            }
            "required" => {
                let missing = |key: &&Value| value.get(key.as_str().unwrap()).is_none();
                rule.as_array()
                    .unwrap()
                    .iter()
                    .filter(missing)
                    .flat_map(|key| fault(format!("{key} is missing")))
                    .collect()
            }
            "items" => {
                let items = value.as_array().into_iter().flatten().enumerate();
                items.flat_map(|(index, item)| faults(root, rule, item, &format!("{place}[{index}]"))).collect()
            }
            "minItems" | "maxItems" => match (value.as_array().map(Vec::len), rule.as_u64().unwrap() as usize) {
                (Some(length), bound)
                    if (word == "minItems" && length < bound) || (word == "maxItems" && length > bound) =>
                {
                    fault(format!("{length} items"))
                }
                _ => Vec::new(),
            },
            other => panic!("the schema has a word that this test does not know: {other}"),
        });
    }
    all
}

fn is_of(value: &Value, name: &str) -> bool {
    match name {
        "null" => value.is_null(),
        "boolean" => value.is_boolean(),
        "integer" => value.is_i64() || value.is_u64(),
        "number" => value.is_number(),
        "string" => value.is_string(),
        "array" => value.is_array(),
        "object" => value.is_object(),
        other => panic!("{other}"),
    }
}

fn check(text: &str) -> Vec<String> {
    let value: Value = toml::from_str(text).unwrap();
    let schema = schema();
    faults(&schema, &schema, &value, "")
}

#[test]
fn the_published_schema_is_up_to_date() {
    let published = fs::read_to_string(repository().join("docs/scene.schema.json")).unwrap_or_default();
    let published: Value = serde_json::from_str(&published).unwrap_or_default();
    assert!(published == schema(), "make it anew: cargo run -- schema > docs/scene.schema.json");
}

#[test]
fn every_key_is_described_where_its_name_does_not_say_all() {
    let schema = schema();
    for (table, key) in [("CameraEntry", "vfov"), ("MaterialEntry", "texture"), ("LightEntry", "spread")] {
        let description = &schema["$defs"][table]["properties"][key]["description"];
        assert!(description.as_str().is_some_and(|text| text.len() > 15), "{table}.{key}: {description}");
    }
}

#[test]
fn the_scenes_of_the_repository_keep_the_schema() {
    let mut checked = 0;
    for folder in ["scenes", "scenes/checks"] {
        for entry in fs::read_dir(repository().join(folder)).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|extension| extension == "toml") {
                let faults = check(&fs::read_to_string(&path).unwrap());
                assert!(faults.is_empty(), "{}: {faults:?}", path.display());
                checked += 1;
            }
        }
    }
    assert!(checked > 1, "{checked} scenes");
}

#[test]
fn slips_do_not_keep_it() {
    let slips = [
        ("[camera]\nposition = [0, 0, 0]\nvofv = 50", ".camera: "),
        ("[[camera]]\nposition = [0, 0]", ".camera: "),
        ("[[light]]\nkind = \"pint\"", ".light[0].kind: "),
        ("[[light]]\nposition = [0, 0, 0]", ".light[0]: \"kind\" is missing"),
        ("[[material]]\nname = \"a\"\nkd = \"red\"", ".material[0].kd: "),
        ("[[material]]\nname = \"a\"\ntexture_wrap = [\"clamp\"]", ".material[0].texture_wrap: "),
        ("[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nsegments = 2.5", ".sphere[0].segments: "),
        ("[[spheer]]", ": no key spheer"),
    ];
    for (text, expected) in slips {
        let faults = check(text);
        assert!(faults.iter().any(|fault| fault.starts_with(expected)), "{text}: {faults:?}");
    }
}
