//! `gudgeon schema`

use gudgeon_core::schemars::SchemaGenerator;
use gudgeon_sim::scene::SCENES;
use serde_json::json;

use crate::failure::Failure;
use crate::ui::Ui;

pub fn schema(ui: &Ui) -> Result<(), Failure> {
    let mut generator = SchemaGenerator::default();
    let scenes: Vec<_> = SCENES.iter().map(|s| s.schema(&mut generator)).collect();
    let definitions = generator.take_definitions(true);
    ui.json(&json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "A Gudgeon case: one of the scenes",
        "anyOf": scenes,
        "$defs": definitions,
    }));
    Ok(())
}
