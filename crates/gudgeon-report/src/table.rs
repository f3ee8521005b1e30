//! Series as CSV, both ways.

use std::path::Path;

use gudgeon_core::result::{Column, Series};

use crate::ReportError;
use crate::number::RoundTrip;

/// `name[unit]`.
fn header(name: &str, unit: &str) -> String {
    format!("{name}[{unit}]")
}

/// `name[unit]` taken apart.
fn named(header: &str) -> Column {
    let (name, unit) = header.strip_suffix(']').and_then(|n| n.rsplit_once('[')).unwrap_or((header, "-"));
    Column { name: name.into(), unit: unit.into(), values: Vec::new() }
}

/// Every column as long as the axis.
pub(crate) fn check(series: &Series) -> Result<(), ReportError> {
    let expected = series.axis.values.len();
    match series.columns.iter().find(|c| c.values.len() != expected) {
        Some(c) => Err(ReportError::Ragged { column: c.name.clone(), rows: c.values.len(), expected }),
        None => Ok(()),
    }
}

/// A CSV file in memory, field by field, as RFC 4180 has it but with line feeds. Written here because nearly all fields are numbers, which are never quoted: a
/// writer that looks for quotes takes more time than their digits.
#[derive(Default)]
struct Csv {
    bytes: Vec<u8>,
    /// Where the row begins.
    row: usize,
    begun: bool,
    number: RoundTrip,
}

impl Csv {
    /// The comma before all fields but the first.
    #[inline]
    fn field(&mut self) {
        if std::mem::replace(&mut self.begun, true) {
            self.bytes.push(b',');
        }
    }

    fn text(&mut self, field: &str) {
        self.field();
        if field.contains([',', '"', '\n', '\r']) {
            self.bytes.push(b'"');
            self.bytes.extend_from_slice(field.replace('"', "\"\"").as_bytes());
            self.bytes.push(b'"');
        } else {
            self.bytes.extend_from_slice(field.as_bytes());
        }
    }

    fn number(&mut self, value: f64) {
        self.field();
        self.bytes.extend_from_slice(self.number.text(value).as_bytes());
    }

    fn end_row(&mut self) {
        // A row of one empty field, which would be no row.
        if self.bytes.len() == self.row {
            self.bytes.extend_from_slice(b"\"\"");
        }
        self.bytes.push(b'\n');
        (self.row, self.begun) = (self.bytes.len(), false);
    }
}

/// A CSV file from rows of text.
pub(crate) fn csv(rows: impl IntoIterator<Item = Vec<String>>) -> Vec<u8> {
    let mut out = Csv::default();
    for row in rows {
        row.iter().for_each(|field| out.text(field));
        out.end_row();
    }
    out.bytes
}

/// The axis (`theta[deg]`), then the columns.
pub(crate) fn series_csv(series: &Series) -> Result<Vec<u8>, ReportError> {
    check(series)?;
    let columns = || std::iter::once(&series.axis).chain(&series.columns);
    let mut out = Csv::default();
    columns().for_each(|c| out.text(&header(&c.name, &c.unit)));
    out.end_row();
    let columns: Vec<&[f64]> = columns().map(|c| c.values.as_slice()).collect();
    // Nearly all numbers have 16 or 17 digits, point and comma.
    out.bytes.reserve(19 * series.axis.values.len() * columns.len());
    for i in 0..series.axis.values.len() {
        columns.iter().for_each(|values| out.number(values[i]));
        out.end_row();
    }
    Ok(out.bytes)
}

/// One series per variant in long form: `variant`, the axis, then every column that any variant has. Variants whose axis is not
/// that of the first with an axis are left out: they are series of something else.
pub(crate) fn long_csv(variants: &[(usize, &Series)]) -> Result<Vec<u8>, ReportError> {
    let mut columns: Vec<(&str, &str)> = Vec::new();
    let Some(axis) = variants.iter().map(|(_, s)| &s.axis).find(|a| !a.name.is_empty()) else {
        return Ok(csv([vec!["variant".to_owned()]]));
    };
    let variants: Vec<_> =
        variants.iter().filter(|(_, s)| s.axis.name == axis.name && s.axis.unit == axis.unit).collect();
    for (_, series) in &variants {
        check(series)?;
        for c in &series.columns {
            if !columns.contains(&(&c.name, &c.unit)) {
                columns.push((&c.name, &c.unit));
            }
        }
    }
    let mut out = Csv::default();
    out.text("variant");
    out.text(&header(&axis.name, &axis.unit));
    columns.iter().for_each(|(n, u)| out.text(&header(n, u)));
    out.end_row();
    for (number, series) in variants {
        let number = number.to_string();
        let found: Vec<Option<&Column>> = columns
            .iter()
            .map(|(n, u)| series.columns.iter().find(|c| c.name == *n && c.unit == *u))
            .collect();
        for (i, at) in series.axis.values.iter().enumerate() {
            out.text(&number);
            out.number(*at);
            // No text for a column that this variant does not have.
            found.iter().for_each(|c| out.number(c.map_or(f64::NAN, |c| c.values[i])));
            out.end_row();
        }
    }
    Ok(out.bytes)
}

/// Reads what [`series_csv`] wrote.
pub(crate) fn read_series(path: &Path) -> Result<Series, ReportError> {
    Ok(read_groups(path, false)?.into_iter().next().map(|(_, s)| s).unwrap_or_default())
}

/// Reads what [`long_csv`] wrote. A column that is empty in all rows of a variant is not part of it.
pub(crate) fn read_long(path: &Path) -> Result<Vec<(usize, Series)>, ReportError> {
    let mut groups = read_groups(path, true)?;
    for (_, series) in &mut groups {
        series.columns.retain(|c| c.values.iter().any(|v| v.is_finite()));
    }
    Ok(groups)
}

fn read_groups(path: &Path, long: bool) -> Result<Vec<(usize, Series)>, ReportError> {
    let bad = |why: String| ReportError::Malformed { path: path.to_path_buf(), why };
    let text = std::fs::read(path).map_err(ReportError::io("read", path))?;
    let mut reader = csv::ReaderBuilder::new().from_reader(text.as_slice());
    let lead = if long { 2 } else { 1 };
    let names = reader.headers().map_err(|e| bad(e.to_string()))?.clone();
    if long && names.get(0) != Some("variant") {
        return Err(bad("the first column is not `variant`".into()));
    }
    let Some(axis) = names.get(lead - 1) else { return Ok(Vec::new()) };
    let empty = || Series { axis: named(axis), columns: names.iter().skip(lead).map(named).collect() };
    let mut groups: Vec<(usize, Series)> = Vec::new();
    if !long {
        groups.push((0, empty()));
    }
    for (i, record) in reader.records().enumerate() {
        let record = record.map_err(|e| bad(e.to_string()))?;
        let number = |k: usize| -> Result<f64, ReportError> {
            match record.get(k).unwrap_or("") {
                "" => Ok(f64::NAN),
                t => t.parse().map_err(|_| bad(format!("row {}: `{t}` is not a number", i + 2))),
            }
        };
        if long {
            let variant = record.get(0).unwrap_or("");
            let variant = variant
                .parse()
                .map_err(|_| bad(format!("row {}: `{variant}` is not a variant number", i + 2)))?;
            if groups.last().is_none_or(|(v, _)| *v != variant) {
                groups.push((variant, empty()));
            }
        }
        if let Some((_, series)) = groups.last_mut() {
            series.axis.values.push(number(lead - 1)?);
            for (k, column) in series.columns.iter_mut().enumerate() {
                column.values.push(number(k + lead)?);
            }
        }
    }
    Ok(groups)
}
