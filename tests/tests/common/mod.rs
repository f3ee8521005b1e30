//! What the tests of this package share: cases by name, runs, and tables that set our numbers beside printed ones.
#![allow(dead_code, reason = "every test program uses a part of this")]
#![allow(clippy::print_stdout, reason = "validation tables are for reading: `cargo test -- --nocapture`")]

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use gudgeon_core::result::RunResult;
use gudgeon_models as _;
use gudgeon_scene::{Checked, RunError, check, run};

/// The pack of the diesel before its flanks had oil of finite volume: some limits were measured on it, entry by entry.
pub const ORIFICES: [&str; 10] = [
    "models.gas_flow.model=orifice_network",
    "models.flank.model=squeeze_film",
    "rings.0.cold_gap=0.55 mm",
    "rings.1.cold_gap=0.55 mm",
    "rings.0.groove.leak_upper=0.02 um",
    "rings.0.groove.leak_lower=0.02 um",
    "rings.1.groove.leak_upper=0.02 um",
    "rings.1.groove.leak_lower=0.02 um",
    "rings.2.groove.leak_upper=0.02 um",
    "rings.2.groove.leak_lower=0.02 um",
];

/// What a case of a ring pack is called here with faces that always find oil, `turbo-diesel-120/flooded`: a run takes a quarter of the time, and what is tested
/// does not depend on the oil on the liner.
const FLOODED: (&str, &str) = ("/flooded", "models.oil_transport.model=off");

/// The overrides of a case with those that its name stands for.
pub fn overrides_of(name: &str, overrides: &[impl AsRef<str>]) -> Vec<String> {
    let first = name.ends_with(FLOODED.0).then(|| FLOODED.1.to_owned());
    first.into_iter().chain(overrides.iter().map(|s| s.as_ref().to_owned())).collect()
}

/// The file of a case that ships with Gudgeon.
pub fn case_file(name: &str) -> PathBuf {
    let name = name.trim_end_matches(FLOODED.0);
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases").join(format!("{name}.toml"))
}

fn owned(overrides: &[&str]) -> Vec<String> {
    overrides.iter().map(|s| (*s).to_owned()).collect()
}

/// Reads a case that must be good.
pub fn checked(name: &str, overrides: &[&str]) -> Checked {
    match check(&case_file(name), &overrides_of(name, overrides)) {
        Ok(c) => c,
        Err(report) => panic!("{name} {overrides:?} was refused: {report}"),
    }
}

/// Runs a case.
pub fn try_run(name: &str, overrides: &[&str]) -> Result<RunResult, RunError> {
    run(&checked(name, overrides), &mut gudgeon_scene::unwatched)
}

/// Runs a case that must succeed.
pub fn run_case(name: &str, overrides: &[&str]) -> RunResult {
    match try_run(name, overrides) {
        Ok(r) => r,
        Err(e) => panic!("{name} {overrides:?}: {e}"),
    }
}

/// A result by name.
pub fn value(r: &RunResult, name: &str) -> f64 {
    match r.results.get(name) {
        Some(v) => v.value,
        None => panic!("no result `{name}` among {:?}", r.results.keys().collect::<Vec<_>>()),
    }
}

/// A column of the series.
pub fn column<'a>(r: &'a RunResult, name: &str) -> &'a [f64] {
    match r.series.get(name) {
        Some(c) => &c.values,
        None => panic!(
            "no column `{name}` among {:?}",
            r.series.columns.iter().map(|c| c.name.as_str()).collect::<Vec<_>>()
        ),
    }
}

/// The value of a column in the row of a crank angle, which must be one of the grid.
pub fn at(r: &RunResult, name: &str, theta_deg: f64) -> f64 {
    let k = r.series.axis.values.iter().position(|t| (t - theta_deg).abs() < 1e-6);
    match k {
        Some(k) => column(r, name)[k],
        None => panic!("no row at {theta_deg} deg"),
    }
}

/// Largest value of a column in `[from, to]` deg, and its crank angle.
pub fn peak(r: &RunResult, name: &str, from: f64, to: f64) -> (f64, f64) {
    r.series
        .axis
        .values
        .iter()
        .zip(column(r, name))
        .filter(|(t, _)| (from..=to).contains(*t))
        .fold((f64::NEG_INFINITY, f64::NAN), |m, (t, v)| if *v > m.0 { (*v, *t) } else { m })
}

/// Folder for files that a test writes.
pub fn scratch() -> PathBuf {
    PathBuf::from(env!("CARGO_TARGET_TMPDIR"))
}

/// How far a number may lie from the printed one.
#[derive(Debug, Clone, Copy)]
pub enum Within {
    /// Relative.
    Relative(f64),
    /// Absolute.
    Absolute(f64),
    /// Relative, plus half a unit of the last printed digit.
    Rounded(f64, f64),
    /// Printed only, nothing asserted.
    Shown,
}

/// Our numbers beside printed ones.
#[derive(Debug, Default)]
pub struct Table {
    rows: Vec<[String; 6]>,
    failures: Vec<String>,
    shown_only: usize,
}

fn number(x: f64) -> String {
    if x == 0.0 {
        "0".into()
    } else if (1e-2..1e5).contains(&x.abs()) {
        let digits = (4 - x.abs().log10().floor() as i32).clamp(0, 6) as usize;
        format!("{x:.digits$}")
    } else {
        format!("{x:.4e}")
    }
}

impl Table {
    /// Sets `ours` beside `printed`. Returns whether it lies within the tolerance (always for [`Within::Shown`]).
    pub fn compare(&mut self, source: &str, quantity: &str, printed: f64, ours: f64, within: Within) -> bool {
        let d = ours - printed;
        let deviation =
            if printed == 0.0 { format!("{d:+.2e}") } else { format!("{:+.2} %", 100.0 * d / printed.abs()) };
        let (ok, mark) = match within {
            Within::Relative(t) => (d.abs() <= t * printed.abs(), format!("{} %", 100.0 * t)),
            Within::Absolute(t) => (d.abs() <= t, format!("+-{t}")),
            Within::Rounded(t, half) => {
                (d.abs() <= t * printed.abs() + half, format!("{} % + {}", 100.0 * t, number(half)))
            }
            Within::Shown => (true, "-".into()),
        };
        let ok = ok && ours.is_finite();
        let verdict = match within {
            Within::Shown => "shown".to_owned(),
            _ if ok => format!("ok ({mark})"),
            _ => format!("FAIL ({mark})"),
        };
        if matches!(within, Within::Shown) {
            self.shown_only += 1;
        }
        if !ok {
            self.failures.push(format!(
                "{source}, {quantity}: {} printed, {} ours",
                number(printed),
                number(ours)
            ));
        }
        self.rows.push([source.into(), quantity.into(), number(printed), number(ours), deviation, verdict]);
        ok
    }

    /// A statement that is true or not.
    pub fn claim(&mut self, source: &str, claim: &str, ours: &str, ok: bool) -> bool {
        let verdict = if ok { "ok" } else { "FAIL" };
        self.rows.push([
            source.into(),
            claim.into(),
            "yes".into(),
            ours.into(),
            String::new(),
            verdict.into(),
        ]);
        if !ok {
            self.failures.push(format!("{source}, {claim}: {ours}"));
        }
        ok
    }

    /// A statement that is printed with its verdict but not asserted.
    pub fn note(&mut self, source: &str, claim: &str, ours: &str, ok: bool) {
        let verdict = if ok { "ok, not asserted" } else { "FAIL, not asserted" };
        self.shown_only += 1;
        self.rows.push([
            source.into(),
            claim.into(),
            "yes".into(),
            ours.into(),
            String::new(),
            verdict.into(),
        ]);
    }

    /// The table as Markdown.
    pub fn markdown(&self) -> String {
        let head = ["source", "quantity", "printed", "ours", "deviation", "ok"].map(str::to_owned);
        let mut width = [3usize; 6];
        for row in std::iter::once(&head).chain(&self.rows) {
            for (w, cell) in width.iter_mut().zip(row) {
                *w = (*w).max(cell.chars().count());
            }
        }
        let mut out = String::new();
        let mut line = |row: &[String; 6]| {
            for (w, cell) in width.iter().zip(row) {
                let _ = write!(out, "| {cell:<w$} ");
            }
            out.push_str("|\n");
        };
        line(&head);
        line(&std::array::from_fn(|i| "-".repeat(width[i])));
        for row in &self.rows {
            line(row);
        }
        out
    }

    /// Prints the table, writes it to `target/<file>`, and fails if any assertion of it failed.
    pub fn finish(self, title: &str, file: &str) {
        let asserted = self.rows.len() - self.shown_only;
        let text = format!(
            "# {title}\n\n{}\n{} comparisons, {asserted} of them asserted, {} failed.\n",
            self.markdown(),
            self.rows.len(),
            self.failures.len()
        );
        println!("{text}");
        let folder = scratch().parent().map_or_else(scratch, Path::to_path_buf);
        std::fs::write(folder.join(file), &text).expect("the target folder can be written");
        assert!(self.failures.is_empty(), "{title}:\n  {}", self.failures.join("\n  "));
    }
}

/// Runs many cases with their overrides on all processors; the order of the answers is that of the question.
pub fn run_all(variants: &[(&str, Vec<String>)]) -> Vec<Result<RunResult, String>> {
    let next = std::sync::atomic::AtomicUsize::new(0);
    let done = std::sync::Mutex::new((0..variants.len()).map(|_| None).collect::<Vec<_>>());
    let workers = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    std::thread::scope(|s| {
        for _ in 0..workers.min(variants.len()) {
            s.spawn(|| {
                loop {
                    let k = next.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
                    let Some((name, overrides)) = variants.get(k) else { break };
                    let outcome = check(&case_file(name), &overrides_of(name, overrides))
                        .map_err(|r| r.to_string())
                        .and_then(|c| run(&c, &mut gudgeon_scene::unwatched).map_err(|e| e.to_string()));
                    done.lock().expect("no worker panics")[k] = Some(outcome);
                }
            });
        }
    });
    let done = done.into_inner().expect("no worker panics");
    done.into_iter().map(|r| r.unwrap_or_else(|| Err("not run".into()))).collect()
}
