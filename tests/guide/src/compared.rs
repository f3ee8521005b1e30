//! The parts of handwritten pages that are generated: texts of files, and what `docs/validation` says of the cases of a source.

use std::fmt::Write as _;
use std::path::Path;

use crate::reference::Pages;
use crate::{Outcome, files, read, relative, root, source};
use gudgeon_core::elementary;

/// Marks where a list of comparisons begins, followed by the names of the pages in `docs/validation`.
const BEGIN: &str = "<!-- compared:";
const END: &str = "<!-- end -->";

/// One comparison, a row of a page in `docs/validation`.
#[derive(Debug, Clone)]
struct Row {
    case: String,
    result: String,
    computed: String,
    given: String,
    unit: String,
    deviation: f64,
    admitted: f64,
    verdict: String,
    why: String,
}

/// Handwritten pages as they should stand, and the figures of their comparisons.
///
/// # Errors
/// A page or a file that it names cannot be read.
pub fn pages() -> Outcome<Pages> {
    let mut out = Pages::new();
    for file in files(&source(), ".md")? {
        let name = relative(&source(), &file);
        let text = read(&file)?;
        if name.starts_with("reference/") || !(text.contains(BEGIN) || text.contains(" same=")) {
            continue;
        }
        let text = with_files(&text)?;
        let (text, rows) = with_comparisons(&text, &name)?;
        if !rows.is_empty() {
            out.insert(figure(&name), drawn(&rows));
        }
        out.insert(name, text);
    }
    Ok(out)
}

fn figure(page: &str) -> String {
    let name = Path::new(page).file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
    format!("validation/figures/{name}.svg")
}

/// Blocks ```` ```rust same=FILE ```` with the text of the file.
fn with_files(text: &str) -> Outcome<String> {
    let mut out = String::new();
    let mut skip = false;
    for line in text.lines() {
        if skip && line != "```" {
            continue;
        }
        skip = false;
        out += line;
        out.push('\n');
        if let Some(path) = line.strip_prefix("```").and_then(|l| l.split_once(" same=")).map(|(_, p)| p) {
            out += read(&root().join(path.trim()))?.trim_end();
            out.push('\n');
            skip = true;
        }
    }
    Ok(out)
}

fn with_comparisons(text: &str, page: &str) -> Outcome<(String, Vec<Row>)> {
    let Some((before, rest)) = text.split_once(BEGIN) else { return Ok((text.to_owned(), Vec::new())) };
    let (names, rest) = rest.split_once("-->").ok_or("a list of comparisons without an end")?;
    let (_, after) = rest.split_once(END).unwrap_or(("", ""));
    let mut rows = Vec::new();
    let mut table = String::new();
    for name in names.split_whitespace() {
        let own = rows_of(name)?;
        let count = |v: &str| own.iter().filter(|r| r.verdict == v).count();
        let link = format!("[{name}](../../../validation/{name}.md)");
        let counts = (count("reproduced"), count("refuted"), count("not reproduced"));
        let _ = writeln!(table, "| {link} | {} | {} | {} |", counts.0, counts.1, counts.2);
        rows.extend(own);
    }
    let file = figure(page);
    let shown = file.trim_start_matches("validation/");
    let head = "| case | reproduced | refuted | not reproduced |\n|---|---:|---:|---:|\n";
    let text = format!(
        "{before}{BEGIN}{names}-->\n\n{head}{table}\n![Deviation of every comparison, and what is admitted]({shown})\n\nEvery comparison of these \
         cases in the order of their pages: a dot is the deviation of what is computed from the value of the source (relative, or absolute where the \
         source gives zero), the grey line what is admitted.\n\n{}{}{END}{after}",
        told(&rows, "refuted", "Refuted: the source is wrong, and what shows it"),
        told(&rows, "not reproduced", "Not reproduced"),
    );
    Ok((text, rows))
}

/// The rows of one verdict, as a section.
fn told(rows: &[Row], verdict: &str, heading: &str) -> String {
    let mut s = String::new();
    for r in rows.iter().filter(|r| r.verdict == verdict) {
        let unit = if r.unit.is_empty() { String::new() } else { format!(" {}", r.unit) };
        let _ = writeln!(
            s,
            "| {} | `{}` | {}{unit} | {}{unit} | {} |",
            r.case, r.result, r.given, r.computed, r.why
        );
    }
    if s.is_empty() {
        return s;
    }
    format!("## {heading}\n\n| case | result | source | here | why |\n|---|---|---:|---:|---|\n{s}\n")
}

fn rows_of(name: &str) -> Outcome<Vec<Row>> {
    let text = read(&root().join(format!("docs/validation/{name}.md")))?;
    Ok(text.lines().filter_map(|l| row(l, name)).collect())
}

fn row(line: &str, case: &str) -> Option<Row> {
    let cells: Vec<&str> = line.strip_prefix('|')?.strip_suffix('|')?.split(" | ").map(str::trim).collect();
    let number = |t: &str| t.trim_start_matches("must exceed ").trim_start_matches("< ").parse::<f64>().ok();
    let [result, computed, given, unit, deviation, admitted, verdict, why] = cells[..] else { return None };
    Some(Row {
        case: case.to_owned(),
        result: result.to_owned(),
        computed: short(computed)?,
        given: short(given)?,
        unit: unit.to_owned(),
        deviation: number(deviation)?.abs(),
        admitted: number(admitted)?,
        verdict: verdict.to_owned(),
        why: why.to_owned(),
    })
}

/// Four figures, without an exponent where none is needed.
fn short(number: &str) -> Option<String> {
    let v: f64 = number.parse().ok()?;
    if v != 0.0 && !(1e-3..1e6).contains(&v.abs()) {
        return Some(format!("{v:.3e}"));
    }
    let digits = if v == 0.0 { 0.0 } else { (3.0 - elementary::log10(v.abs()).floor()).clamp(0.0, 6.0) };
    let text = format!("{v:.*}", digits as usize);
    let bare = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    Some(bare.to_owned())
}

const LEFT: f64 = 52.0;
const WIDTH: f64 = 640.0;
const TOP: f64 = 10.0;
const BOTTOM: f64 = 210.0;

/// Deviations and admitted ones over the number of the comparison.
fn drawn(rows: &[Row]) -> String {
    let up = |v: f64| BOTTOM - (elementary::log10(v.clamp(1e-13, 10.0)) + 13.0) / 14.0 * (BOTTOM - TOP);
    let step = (WIDTH - LEFT - 10.0) / rows.len() as f64;
    let mut s = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} 250\" width=\"{WIDTH}\" height=\"250\" font-family=\"sans-serif\" font-size=\"12\">\n\
         <style>.g{{stroke:#8884;fill:none}}.a{{stroke:#8888;stroke-width:1.5;fill:none}}text{{fill:#777}}</style>\n"
    );
    for decade in [-12, -9, -6, -3, 0] {
        let y = up(10f64.powi(decade));
        let _ = writeln!(
            s,
            "<path class=\"g\" d=\"M{LEFT} {y:.1}H{WIDTH}\"/><text x=\"46\" y=\"{:.1}\" text-anchor=\"end\">1e{decade}</text>",
            y + 4.0
        );
    }
    let mut line = String::new();
    for (n, r) in rows.iter().enumerate() {
        let x = LEFT + 4.0 + step * n as f64;
        let _ = write!(line, "M{x:.1} {:.1}h{:.1}", up(r.admitted), step.max(1.0));
    }
    let _ = writeln!(s, "<path class=\"a\" d=\"{line}\"/>");
    for (verdict, colour) in VERDICTS {
        let mut dots = String::new();
        for (n, r) in rows.iter().enumerate().filter(|(_, r)| r.verdict == verdict) {
            let _ = write!(dots, "M{:.1} {:.1}h0", LEFT + 4.0 + step * (n as f64 + 0.5), up(r.deviation));
        }
        let _ = writeln!(
            s,
            "<path stroke=\"{colour}\" stroke-width=\"5\" stroke-linecap=\"round\" fill=\"none\" d=\"{dots}\"/>"
        );
    }
    for (n, (verdict, colour)) in VERDICTS.iter().enumerate() {
        let x = LEFT + 180.0 * n as f64;
        let _ = writeln!(
            s,
            "<circle cx=\"{:.0}\" cy=\"232\" r=\"4\" fill=\"{colour}\"/><text x=\"{:.0}\" y=\"236\">{verdict}</text>",
            x + 4.0,
            x + 14.0
        );
    }
    s + "</svg>\n"
}

const VERDICTS: [(&str, &str); 3] =
    [("reproduced", "#0072b2"), ("refuted", "#d55e00"), ("not reproduced", "#cc79a7")];
