//! Points that a CSV file lists.

use gudgeon_core::BuildError;
use serde::{Deserialize, Serialize};

use super::input::with_unit;

/// A list of points: inputs that go together, a row a point.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct PointList {
    /// Paths of the inputs.
    pub paths: Vec<String>,
    /// Values by row, as a case would write them.
    pub rows: Vec<Vec<String>>,
}

impl PointList {
    /// Reads `engine.speed [rpm],models.cylinder_pressure.file` and the rows below. A number in a column with a unit gets that unit.
    ///
    /// # Errors
    /// A table that is none, with the line.
    pub fn read(text: &str) -> Result<Self, BuildError> {
        let wrong = |e: &csv::Error| BuildError::at("list", format!("the list of points: {e}"));
        let mut reader =
            csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_reader(text.as_bytes());
        let header = reader.headers().map_err(|e| wrong(&e))?.clone();
        let columns: Vec<(String, String)> = header.iter().map(path_and_unit).collect();
        if columns.iter().any(|(path, _)| path.is_empty()) {
            return Err(BuildError::at(
                "list",
                "every column of the list of points needs the path of its input, such as `engine.speed [rpm]`",
            ));
        }
        let mut rows = Vec::new();
        for record in reader.records() {
            let record = record.map_err(|e| wrong(&e))?;
            let line = record.position().map_or(0, csv::Position::line);
            let value = |(text, (path, unit)): (&str, &(String, String))| match text.parse::<f64>() {
                _ if text.is_empty() => {
                    Err(BuildError::at("list", format!("the list of points has no `{path}` in line {line}")))
                }
                Ok(v) if !unit.is_empty() => Ok(with_unit(v, unit)),
                _ => Ok(text.to_owned()),
            };
            rows.push(record.iter().zip(&columns).map(value).collect::<Result<_, _>>()?);
        }
        if rows.is_empty() {
            return Err(BuildError::at("list", "the list of points has no row"));
        }
        Ok(Self { paths: columns.into_iter().map(|(path, _)| path).collect(), rows })
    }
}

/// `engine.speed [rpm]` as path and unit.
fn path_and_unit(column: &str) -> (String, String) {
    match column.trim().strip_suffix(']').and_then(|c| c.rsplit_once('[')) {
        Some((path, unit)) => (path.trim().to_owned(), unit.trim().to_owned()),
        None => (column.trim().to_owned(), String::new()),
    }
}
