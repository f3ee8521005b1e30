//! Files of derivatives of results by inputs.

use std::path::PathBuf;

use gudgeon_core::result::Gradients;

use crate::{Folder, ReportError};

/// What derivatives are written to.
pub const GRADIENTS: &str = "gradients.json";
const TABLE: &str = "gradients.csv";

/// Writes `gradients.json`, and `gradients.csv` with one row for each result and input, into a folder that was opened before. The path of the first.
///
/// # Errors
/// A file system that refuses; files already there are then as they were.
pub fn write_gradients_in(g: &Gradients, mut folder: Folder) -> Result<PathBuf, ReportError> {
    let path = folder.path().join(GRADIENTS);
    folder.add(GRADIENTS, gradients_json(g).as_bytes())?;
    folder.add(TABLE, table(g).as_bytes())?;
    folder.commit()?;
    Ok(path)
}

/// Derivatives as JSON text: as [`gradients_value`].
#[must_use]
pub fn gradients_json(g: &Gradients) -> String {
    serde_json::to_string_pretty(&gradients_value(g)).unwrap_or_default() + "\n"
}

/// Derivatives for JSON: inputs, results with their derivatives, and beside these their units and the elasticities.
#[must_use]
pub fn gradients_value(g: &Gradients) -> serde_json::Value {
    let mut value = serde_json::to_value(g).unwrap_or_default();
    for (name, result) in value["results"].as_object_mut().into_iter().flatten() {
        let all: Vec<Option<f64>> = (0..g.inputs.len()).map(|k| g.elasticity(name, k)).collect();
        let units: Vec<Option<String>> = (0..g.inputs.len()).map(|k| g.unit(name, k)).collect();
        result["by_unit"] = serde_json::json!(units);
        result["elasticity"] = serde_json::json!(all);
    }
    value
}

fn table(g: &Gradients) -> String {
    let number = |v: Option<f64>| v.map_or_else(String::new, |v| format!("{v:?}"));
    let mut out = String::from(
        "result,input,value,unit,input_value,input_unit,derivative,derivative_unit,elasticity\n",
    );
    for (name, result) in &g.results {
        for (k, (i, d)) in g.inputs.iter().zip(&result.by).enumerate() {
            let (v, elasticity) = (&result.value, number(g.elasticity(name, k)));
            let row = [
                name.clone(),
                i.path.clone(),
                format!("{:?}", v.value),
                v.unit.clone(),
                format!("{:?}", i.value),
                i.unit.clone(),
                number(*d),
                g.unit(name, k).unwrap_or_default(),
                elasticity,
            ];
            out.push_str(&row.join(","));
            out.push('\n');
        }
    }
    out
}
