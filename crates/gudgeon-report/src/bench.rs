//! A benchmark's files and its page.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use gudgeon_core::result::{BenchPoint, BenchTable, OVER_ASKED};
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use serde_json::json;

use crate::folder::Folder;
use crate::number::{count, round_trip, significant, unit};
use crate::page::{self, Kind, esc};
use crate::summary::ResultValue;
use crate::{REPORT, ReportError, table};

pub(crate) const BENCH: &str = "bench.json";
const TABLE: &str = "bench.csv";

/// Where [`write_bench`] put things.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BenchFiles {
    /// Everything.
    pub bench: PathBuf,
    /// One row per point.
    pub table: PathBuf,
    /// The page.
    pub report: PathBuf,
}

/// A point; null where there is no finite number.
#[derive(Debug, Serialize, Deserialize)]
struct Point {
    method: String,
    setting: String,
    is_default: bool,
    seconds_per_cycle: Option<f64>,
    seconds_total: Option<f64>,
    cycles: Option<f64>,
    work: IndexMap<String, u64>,
    errors: IndexMap<String, Option<f64>>,
    #[serde(default)]
    asked: Option<f64>,
    #[serde(default)]
    achieved: Option<f64>,
    failure: Option<String>,
}

impl Point {
    /// Achieved error over the one that was asked for.
    fn over_asked(&self) -> Option<f64> {
        self.achieved.zip(self.asked).map(|(got, asked)| got / asked)
    }
}

impl From<&BenchPoint> for Point {
    fn from(p: &BenchPoint) -> Self {
        let finite = |v: f64| Some(v).filter(|v| v.is_finite());
        Self {
            method: p.method.clone(),
            setting: p.setting.clone(),
            is_default: p.is_default,
            // The times of a point that failed are not times of a solution.
            seconds_per_cycle: finite(p.seconds_per_cycle).filter(|_| p.failure.is_none()),
            seconds_total: finite(p.seconds_total).filter(|_| p.failure.is_none()),
            cycles: finite(p.cycles).filter(|_| p.failure.is_none()),
            work: p.work.clone(),
            errors: p.errors.iter().map(|(k, v)| (k.clone(), finite(*v))).collect(),
            asked: p.asked,
            achieved: p.achieved.and_then(finite),
            failure: p.failure.clone(),
        }
    }
}

#[derive(Debug, Serialize, Deserialize)]
struct File {
    case: String,
    title: String,
    reference: String,
    #[serde(default)]
    independent: bool,
    #[serde(default)]
    trusted_to: Option<f64>,
    reference_values: IndexMap<String, ResultValue>,
    #[serde(default)]
    descriptions: IndexMap<String, String>,
    points: Vec<Point>,
    findings: Vec<String>,
}

impl File {
    fn new(b: &BenchTable) -> Self {
        Self {
            case: b.case.clone(),
            title: b.title.clone(),
            reference: b.reference.clone(),
            independent: b.independent,
            trusted_to: Some(b.trusted_to).filter(|v| v.is_finite()),
            reference_values: b.reference_values.iter().map(|(k, v)| (k.clone(), v.into())).collect(),
            descriptions: b
                .reference_values
                .iter()
                .filter(|(_, v)| !v.what.is_empty())
                .map(|(k, v)| (k.clone(), v.what.clone()))
                .collect(),
            points: b.points.iter().map(Point::from).collect(),
            findings: b.findings.clone(),
        }
    }

    fn names<'a, V: 'a>(&'a self, of: impl Fn(&'a Point) -> &'a IndexMap<String, V>) -> Vec<&'a str> {
        let mut names: Vec<&str> = Vec::new();
        for p in &self.points {
            for name in of(p).keys() {
                if !names.contains(&name.as_str()) {
                    names.push(name);
                }
            }
        }
        names
    }
}

/// Writes `bench.json`, `bench.csv` and `report.html` of a benchmark into `dir`.
///
/// # Errors
/// A file system that refuses; files already in `dir` are then as they were.
pub fn write_bench(b: &BenchTable, dir: &Path) -> Result<BenchFiles, ReportError> {
    write_bench_in(b, Folder::open(dir)?)
}

/// As [`write_bench`], into a folder that was opened before the runs.
///
/// # Errors
/// As [`write_bench`].
pub fn write_bench_in(b: &BenchTable, mut folder: Folder) -> Result<BenchFiles, ReportError> {
    let file = File::new(b);
    let dir = folder.path().to_owned();
    folder.add(TABLE, &csv_table(&file))?;
    folder.add(REPORT, page(&file).as_bytes())?;
    folder.add(BENCH, (serde_json::to_string_pretty(&file).unwrap_or_default() + "\n").as_bytes())?;
    folder.commit()?;
    Ok(BenchFiles { bench: dir.join(BENCH), table: dir.join(TABLE), report: dir.join(REPORT) })
}

/// Rebuilds the page of a benchmark.
pub(crate) fn rewrite(dir: &Path) -> Result<PathBuf, ReportError> {
    let path = dir.join(BENCH);
    let bytes = std::fs::read(&path).map_err(ReportError::io("read", &path))?;
    let file: File = serde_json::from_slice(&bytes)
        .map_err(|e| ReportError::Malformed { path: path.clone(), why: e.to_string() })?;
    let mut folder = Folder::open(dir)?;
    folder.add(REPORT, page(&file).as_bytes())?;
    folder.commit_beside()?;
    Ok(dir.join(REPORT))
}

fn csv_table(file: &File) -> Vec<u8> {
    let errors = file.names(|p| &p.errors);
    let work = file.names(|p| &p.work);
    let mut head: Vec<String> =
        ["method", "setting", "default", "seconds_per_cycle[s]", "seconds_total[s]", "cycles[-]"]
            .map(str::to_owned)
            .to_vec();
    head.extend(errors.iter().map(|n| format!("error.{n}[-]")));
    head.extend(work.iter().map(|n| format!("work.{n}[-]")));
    head.extend(["asked[-]", "achieved[-]", "failure"].map(str::to_owned));
    let number = |v: Option<f64>| v.map_or_else(String::new, round_trip);
    let mut out = vec![head];
    for p in &file.points {
        let mut row = vec![
            p.method.clone(),
            p.setting.clone(),
            p.is_default.to_string(),
            number(p.seconds_per_cycle),
            number(p.seconds_total),
            number(p.cycles),
        ];
        row.extend(errors.iter().map(|n| number(p.errors.get(*n).copied().flatten())));
        row.extend(work.iter().map(|n| p.work.get(*n).map_or_else(String::new, u64::to_string)));
        row.extend([number(p.asked), number(p.achieved)]);
        row.push(p.failure.clone().unwrap_or_default());
        out.push(row);
    }
    table::csv(out)
}

fn page(file: &File) -> String {
    let heading = if file.title.trim().is_empty() { &file.case } else { &file.title };
    let mut body = String::new();
    let _ = write!(
        body,
        "<section id=\"overview\"><header><h1>{}</h1><p class=\"meta\"><code>{}</code> · run time and work against error</p></header>",
        esc(heading),
        esc(&file.case)
    );
    if !file.findings.is_empty() {
        body.push_str("<h2>Findings</h2><ul class=\"findings\">");
        for f in &file.findings {
            let _ = write!(body, "<li>{}</li>", page::prose(f));
        }
        body.push_str("</ul>");
    }
    body.push_str("</section>\n");
    let errors = file.names(|p| &p.errors);
    if !errors.is_empty() {
        body.push_str(
            "<section id=\"charts\"><h2>Run time and work against error</h2><p class=\"hint\">Lower left is better. The large \
             ring marks the case as it stands. Point at a mark to read its setting. Times are those of one machine; counts are \
             the same everywhere.</p><div id=\"bench-bar\"></div><div id=\"charts-grid\"></div></section>\n",
        );
    }
    if file.points.iter().any(|p| p.over_asked().is_some()) {
        body.push_str("<section id=\"asked\"><h2>Achieved and asked errors</h2><div id=\"asked-grid\"></div></section>\n");
    }
    body.push_str("<section id=\"reference\"><h2>Reference</h2>");
    if !file.reference.is_empty() {
        let how = if file.independent { "By a second method" } else { "By the method itself" };
        let _ = write!(body, "<p>{how}: {}</p>", page::prose(&file.reference));
    }
    if !file.reference_values.is_empty() {
        body.push_str("<table class=\"plain key\"><tbody>");
        for (name, v) in &file.reference_values {
            let what = file.descriptions.get(name).map_or("", String::as_str);
            let _ = write!(
                body,
                "<tr><th scope=\"row\">{} <code>{}</code></th><td class=\"num\">{}</td><td class=\"unit\">{}</td></tr>",
                esc(what),
                esc(name),
                significant(v.value, 7),
                esc(&unit(&v.unit))
            );
        }
        body.push_str("</tbody></table>");
    }
    body.push_str("</section>\n");
    let failed: Vec<&Point> = file.points.iter().filter(|p| p.failure.is_some()).collect();
    if !failed.is_empty() {
        body.push_str(
            "<section id=\"failures\" class=\"note\"><h2>Failures</h2><table class=\"plain\"><tbody>",
        );
        for p in failed {
            let _ = write!(
                body,
                "<tr><th scope=\"row\">{}, {}</th><td>{}</td></tr>",
                esc(&p.method),
                esc(&p.setting),
                page::prose(p.failure.as_deref().unwrap_or(""))
            );
        }
        body.push_str("</tbody></table></section>\n");
    }
    points_table(&mut body, file, &errors);
    let body = page::body(&CONTENTS, &body, "", &[]);
    let data = json!({
        "points": file.points, "errors": errors, "descriptions": file.descriptions, "trusted_to": file.trusted_to
    });
    page::document(Kind::Bench, heading, &body, &data, None)
}

/// Sections in their order, with their names in the contents at the side.
const CONTENTS: [(&str, &str); 6] = [
    ("overview", "Findings"),
    ("charts", "Run time and work against error"),
    ("asked", "Achieved and asked errors"),
    ("reference", "Reference"),
    ("failures", "Failures"),
    ("points", "All points"),
];

fn points_table(out: &mut String, file: &File, errors: &[&str]) {
    let work = file.names(|p| &p.work);
    let cyclic = file.points.iter().any(|p| p.cycles.is_some_and(|c| c > 1.0));
    out.push_str(
        "<section id=\"points\"><h2>All points</h2><div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"table\"><table class=\"plain compare\"><thead><tr>\
         <th>Method</th><th>Setting</th><th class=\"num\">s in all</th>",
    );
    if cyclic {
        out.push_str("<th class=\"num\">s per cycle</th><th class=\"num\">cycles</th>");
    }
    for n in errors {
        let _ = write!(out, "<th class=\"num\">error of<br><code>{}</code></th>", esc(n));
    }
    out.push_str("<th class=\"num\">achieved<br>over asked</th>");
    for n in &work {
        let _ = write!(out, "<th class=\"num\">{}</th>", esc(&n.replace('_', " ")));
    }
    out.push_str("</tr></thead><tbody>");
    for p in &file.points {
        let class = match (p.is_default, &p.failure) {
            (_, Some(_)) => " class=\"failed\"",
            (true, None) => " class=\"default\"",
            _ => "",
        };
        let mark = if p.is_default { " <span class=\"tag\">default</span>" } else { "" };
        let _ = write!(
            out,
            "<tr{class}><th scope=\"row\">{}</th><td>{}{mark}</td><td class=\"num\">{}</td>",
            esc(&p.method),
            esc(&p.setting),
            significant(p.seconds_total, 3)
        );
        for v in [p.seconds_per_cycle, p.cycles].into_iter().filter(|_| cyclic) {
            let _ = write!(out, "<td class=\"num\">{}</td>", significant(v, 3));
        }
        for n in errors {
            let _ =
                write!(out, "<td class=\"num\">{}</td>", significant(p.errors.get(*n).copied().flatten(), 2));
        }
        let over = if p.over_asked().is_some_and(|r| r > OVER_ASKED) { " warn" } else { "" };
        let _ = write!(out, "<td class=\"num{over}\">{}</td>", significant(p.over_asked(), 2));
        for n in &work {
            let text = p.work.get(*n).map_or_else(|| "–".into(), |n| count(*n));
            let _ = write!(out, "<td class=\"num\">{text}</td>");
        }
        out.push_str("</tr>");
    }
    out.push_str("</tbody></table></div></section>\n");
}
