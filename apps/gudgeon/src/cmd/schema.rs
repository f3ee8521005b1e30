//! `gudgeon schema`

use gudgeon_case::{one_scene_of, published};
use gudgeon_core::schemars::SchemaGenerator;
use gudgeon_scene::scenes;
use serde_json::{Map, Value};

use crate::failure::Failure;
use crate::ui::Ui;

pub fn schema(ui: &Ui) -> Result<(), Failure> {
    let mut generator = SchemaGenerator::default();
    let scenes: Vec<_> =
        scenes().iter().map(|s| (s.name, published(&(s.schema)(&mut generator).to_value()))).collect();
    let definitions = generator.take_definitions(true);
    let mut case = one_scene_of(&scenes);
    case["$schema"] = "https://json-schema.org/draft/2020-12/schema".into();
    case["title"] = "A Gudgeon case: one of the scenes".into();
    let definitions: Map<String, Value> =
        definitions.iter().map(|(k, v)| (k.clone(), published(v))).collect();
    case["$defs"] = definitions.into();
    ui.json(&case);
    Ok(())
}
