//! All rows of a study as one table.

use std::fs;
use std::path::PathBuf;

use super::FolderError;
use super::analysis::Analysis;
use super::columnar::{from_parquet, to_parquet};
use super::folder::{Study, put};
use super::table::{Column, Table};

impl Study {
    /// The rows of all parts that are there, in the order of the points, and how many points are missing.
    ///
    /// # Errors
    /// A part that cannot be read.
    pub fn collect(&self) -> Result<(Table, usize), FolderError> {
        let missing = self.status().missing;
        let mut all = Table::default();
        for part in (0..self.parts()).filter(|p| !missing.contains(p)) {
            let path = self.part_path(part);
            let bytes = fs::read(&path).map_err(FolderError::io("read", &path))?;
            let damaged = |why: String| FolderError::Damaged { path: path.clone(), why };
            let mut rows = from_parquet(bytes).map_err(|e| damaged(e.to_string()))?;
            rows.about.clear();
            all.append(rows).map_err(|column| {
                damaged(format!("the column `{column}` has another type than in the parts before"))
            })?;
        }
        let left = self.record.points - all.rows();
        all.about.insert("study".into(), self.record.sha256.clone());
        all.about.insert("gudgeon".into(), self.record.gudgeon.clone());
        Ok((all, left))
    }
}

/// What a collection wrote.
#[derive(Debug, Clone)]
pub struct Collected {
    /// All rows.
    pub table: Table,
    /// The file that holds them.
    pub path: PathBuf,
    /// What the results depend on, when all rows are there.
    pub analysis: Option<Analysis>,
}

/// All rows.
const TABLE: &str = "table.parquet";
/// The same as text.
const CSV: &str = "table.csv";
/// What the results depend on.
const ANALYSIS: &str = "analysis.json";
/// The same drawn.
const PAGE: &str = "report.html";

impl Study {
    /// Writes `table.parquet` (and `table.csv`), and `analysis.json` when all rows are there.
    ///
    /// # Errors
    /// A part that cannot be read, a file system that refuses.
    pub fn write_table(&self, csv: bool) -> Result<Collected, FolderError> {
        let (table, missing) = self.collect()?;
        let path = self.dir().join(TABLE);
        let damaged = |why: String| FolderError::Damaged { path: path.clone(), why };
        put(&path, &to_parquet(&table).map_err(|e| damaged(e.to_string()))?)?;
        if csv {
            put(&self.dir().join(CSV), &as_csv(&table).map_err(|e| damaged(e.to_string()))?)?;
        }
        let analysis = if missing == 0 { Some(self.analyse(&table)) } else { None };
        if let Some(a) = &analysis {
            let text = serde_json::to_string_pretty(a).unwrap_or_default() + "\n";
            put(&self.dir().join(ANALYSIS), text.as_bytes())?;
        }
        Ok(Collected { path, analysis, table })
    }

    /// Puts a page about the study into its folder, as `report.html`.
    ///
    /// # Errors
    /// A file system that refuses.
    pub fn write_page(&self, page: &str) -> Result<PathBuf, FolderError> {
        let path = self.dir().join(PAGE);
        put(&path, page.as_bytes())?;
        Ok(path)
    }
}

/// A table as text: names with units in brackets, numbers with all their digits.
fn as_csv(table: &Table) -> Result<Vec<u8>, csv::Error> {
    let mut out = csv::Writer::from_writer(Vec::new());
    let head = |(name, c): (&String, &Column)| {
        if c.unit.is_empty() { name.clone() } else { format!("{name} [{}]", c.unit) }
    };
    out.write_record(table.columns.iter().map(head))?;
    for row in 0..table.rows() {
        out.write_record(table.columns.values().map(|c| c.values.text(row)))?;
    }
    out.into_inner().map_err(|e| e.into_error().into())
}
