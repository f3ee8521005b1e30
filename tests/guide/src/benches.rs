//! The test bench of every kind: one case, the models of the kind swapped in it, and a figure of what that changes. `docs/guide/benches.toml`
//! lists them.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use gudgeon_core::result::RunResult;
use gudgeon_scene::{check, unwatched};
use serde::Deserialize;

use crate::markdown::cell;
use crate::svg::{Curve, Frame, bars, curves};
use crate::{Outcome, read, root};

/// Runs that several benches share, by the resolved case.
type Runs = Mutex<HashMap<String, Arc<RunResult>>>;

/// One bench.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bench {
    /// The kind whose models are swapped.
    pub kind: String,
    /// Case, from the root of the repository.
    case: String,
    /// Changes to it.
    #[serde(default)]
    set: Vec<String>,
    /// What is swapped, as in `--swap`.
    path: String,
    /// Models, or whole tables.
    values: Vec<String>,
    /// Column of the series that is drawn.
    #[serde(default)]
    column: Option<String>,
    /// Or a result, as bars.
    #[serde(default)]
    result: Option<String>,
    /// Text under the abscissa.
    #[serde(default)]
    x: String,
    /// Factor from the unit of the axis to that of the text.
    #[serde(default = "one")]
    x_factor: f64,
    /// Text beside the ordinate.
    y: String,
    /// Factor from the unit of the column to that of the text.
    #[serde(default = "one")]
    y_factor: f64,
    /// Logarithmic ordinate.
    #[serde(default)]
    log: bool,
    /// What the figure shows.
    text: String,
}

const fn one() -> f64 {
    1.0
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct List {
    bench: Vec<Bench>,
}

/// All benches, as listed.
///
/// # Errors
/// The list cannot be read.
pub fn all() -> Outcome<Vec<Bench>> {
    let list: List =
        toml::from_str(&read(&root().join("docs/guide/benches.toml"))?).map_err(|e| e.to_string())?;
    Ok(list.bench)
}

impl Bench {
    /// Its file below the sources of the guide.
    #[must_use]
    pub fn file(&self) -> String {
        format!("reference/figures/{}.svg", self.kind)
    }

    /// Its section on a page; `up` leads to `reference`.
    #[must_use]
    pub fn page(&self, up: &str) -> String {
        let name = self.case.trim_start_matches("cases/").trim_end_matches(".toml");
        let set = if self.set.is_empty() {
            String::new()
        } else {
            format!(" with {}", self.set.iter().map(|s| format!("`{s}`")).collect::<Vec<_>>().join(", "))
        };
        format!(
            "{}\n\n![{}]({up}figures/{}.svg)\n\nCase [{name}]({up}cases.md#{name}){set}; `{}` is swapped.\n",
            self.text,
            cell(&self.text),
            self.kind,
            self.path,
        )
    }

    /// Runs every variant and draws the figure.
    ///
    /// # Errors
    /// A variant that is refused or fails.
    fn draw(&self, runs: &Runs) -> Outcome<String> {
        let all: Vec<Curve> = self.values.iter().map(|v| self.curve(v, runs)).collect::<Outcome<_>>()?;
        let frame = Frame { x: self.x.clone(), y: self.y.clone(), log: self.log };
        Ok(if self.column.is_some() { curves(&all, &frame) } else { bars(&all, &frame) })
    }

    fn curve(&self, value: &str, runs: &Runs) -> Outcome<Curve> {
        let told = |e: String| format!("bench of {}, {value}: {e}", self.kind);
        let result = self.run(value, runs).map_err(told)?;
        let (x, y) = self.taken(&result).map_err(told)?;
        let scale = |v: &[f64], f: f64| v.iter().map(|v| v * f).collect();
        Ok(Curve { label: label(value), x: scale(&x, self.x_factor), y: scale(&y, self.y_factor) })
    }

    fn run(&self, value: &str, runs: &Runs) -> Outcome<Arc<RunResult>> {
        let word = self.path.starts_with("conventions.") || self.path.ends_with(".method");
        let swapped = match word || value.starts_with('{') {
            true => format!("{}={value}", self.path),
            false => format!("{}.model={value}", self.path),
        };
        let all: Vec<String> = self.set.iter().cloned().chain([swapped]).collect();
        let case = check(&root().join(&self.case), &[]).map_err(|e| e.to_string())?;
        // Sweeps of the case apart: they are of its own model.
        let checked = case.with(&all).map_err(|e| e.to_string())?;
        let key = checked.case.resolved().to_string();
        if let Some(known) = runs.lock().unwrap_or_else(PoisonError::into_inner).get(&key) {
            return Ok(Arc::clone(known));
        }
        let result = Arc::new(checked.case.once(&mut unwatched).map_err(|e| e.to_string())?);
        runs.lock().unwrap_or_else(PoisonError::into_inner).insert(key, Arc::clone(&result));
        Ok(result)
    }

    fn taken(&self, r: &RunResult) -> Outcome<(Vec<f64>, Vec<f64>)> {
        if let Some(column) = &self.column {
            let names = || r.series.columns.iter().map(|c| c.name.as_str()).collect::<Vec<_>>().join(", ");
            let found =
                r.series.get(column).ok_or_else(|| format!("no column `{column}` among {}", names()))?;
            return Ok((r.series.axis.values.clone(), found.values.clone()));
        }
        let name = self.result.as_deref().ok_or("neither `column` nor `result`")?;
        let names = || r.results.keys().map(String::as_str).collect::<Vec<_>>().join(", ");
        let found = r.results.get(name).ok_or_else(|| format!("no result `{name}` among {}", names()))?;
        Ok((Vec::new(), vec![found.value]))
    }
}

/// `greenwood_tripp` of a word or of a table with that model; what else the table says, in brackets where it says `label`.
fn label(value: &str) -> String {
    let Ok(table) = toml::from_str::<toml::Table>(&format!("v = {value}")) else { return value.to_owned() };
    let model = table.get("v").and_then(|v| v.get("model")).and_then(toml::Value::as_str);
    model.unwrap_or(value).to_owned()
}

/// Draws all figures on two threads, in the order of the list: file below the sources of the guide, and text.
///
/// # Errors
/// Every bench that failed.
pub fn draw(benches: &[Bench]) -> Outcome<Vec<(String, String)>> {
    let next = AtomicUsize::new(0);
    let done = Mutex::new(Vec::new());
    let runs = Runs::default();
    std::thread::scope(|s| {
        for _ in 0..2 {
            s.spawn(|| {
                while let Some(b) = benches.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let drawn = b.draw(&runs).map(|svg| (b.file(), svg));
                    done.lock().unwrap_or_else(PoisonError::into_inner).push(drawn);
                }
            });
        }
    });
    let done = done.into_inner().unwrap_or_default();
    let errors: Vec<String> = done.iter().filter_map(|d| d.as_ref().err().cloned()).collect();
    if errors.is_empty() { Ok(done.into_iter().flatten().collect()) } else { Err(errors.join("\n")) }
}

/// Where a figure stands in the repository.
#[must_use]
pub fn place(file: &str) -> PathBuf {
    crate::source().join(file)
}
