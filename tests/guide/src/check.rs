//! Whether the guide is as it should be: generated pages fresh, links and citations leading somewhere.

use std::path::Path;

use crate::markdown::{anchors, citations, links};
use crate::reference::{Facts, Pages};
use crate::{Outcome, benches, bib, files, read, relative, source, tidy};
use gudgeon_core::elementary;

/// Generated pages that are not what stands in the repository.
///
/// # Errors
/// A folder that cannot be read.
pub fn stale(pages: &Pages) -> Outcome<Vec<String>> {
    let mut out = Vec::new();
    for (path, text) in pages {
        let stands = read(&source().join(path)).unwrap_or_default();
        if &stands != text {
            let differs = stands.lines().zip(text.lines()).find(|(a, b)| a != b);
            out.push(format!("{path} is stale: {differs:?}"));
        }
    }
    for file in files(&source().join("reference"), ".md")? {
        let path = relative(&source(), &file);
        if !pages.contains_key(&path) {
            out.push(format!("{path}: nothing generates it any more"));
        }
    }
    Ok(out)
}

/// Figures that are not what stands in the repository.
///
/// # Errors
/// A bench that cannot be run.
pub fn stale_figures(facts: &Facts) -> Outcome<Vec<String>> {
    let drawn = benches::draw(facts.benches())?;
    let stale =
        drawn.iter().filter(|(file, svg)| !same(&read(&source().join(file)).unwrap_or_default(), svg));
    Ok(stale.map(|(file, _)| format!("{file} is stale")).collect())
}

/// Whether two figures look alike. Numbers may differ by 2 px or by 1 %: other versions of the mathematical library, and solvers whose steps
/// end elsewhere within their tolerance, move a line by less than its width of 1.8 px.
#[must_use]
pub fn same(a: &str, b: &str) -> bool {
    let (a, b) = (pieces(a), pieces(b));
    let curve = |p: &(String, Vec<f64>)| p.0.contains(" d=");
    a.len() == b.len()
        && a.iter().zip(&b).all(|(p, q)| match curve(p) && p.1.len() > 12 {
            true => near_curve(&p.1, &q.1) && near_curve(&q.1, &p.1),
            false => p.0 == q.0 && p.1.len() == q.1.len() && p.1.iter().zip(&q.1).all(|(x, y)| close(*x, *y)),
        })
}

fn close(x: f64, y: f64) -> bool {
    (x - y).abs() <= 2.0f64.max(0.01 * x.abs())
}

/// Lines of a figure: their text without numbers, and the numbers.
fn pieces(svg: &str) -> Vec<(String, Vec<f64>)> {
    svg.lines()
        .map(|l| (l.replace(|c: char| c.is_ascii_digit() || ".-".contains(c), ""), numbers(l)))
        .collect()
}

fn numbers(line: &str) -> Vec<f64> {
    line.split(|c: char| !(c.is_ascii_digit() || ".-".contains(c))).filter_map(|n| n.parse().ok()).collect()
}

/// Whether every point of a curve lies within 3 px of a segment of another: points need not be the same ones.
fn near_curve(a: &[f64], b: &[f64]) -> bool {
    let points = |v: &[f64]| v.chunks_exact(2).map(|p| (p[0], p[1])).collect::<Vec<_>>();
    // The first number is the width of the line, the last ones are the legend's.
    let (a, b) = (points(&a[1..]), points(&b[1..]));
    a.iter().all(|p| b.windows(2).any(|s| distance(*p, s[0], s[1]) <= 3.0))
}

fn distance(p: (f64, f64), a: (f64, f64), b: (f64, f64)) -> f64 {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let along = ((p.0 - a.0) * dx + (p.1 - a.1) * dy) / (dx * dx + dy * dy).max(1e-12);
    let t = along.clamp(0.0, 1.0);
    elementary::hypot(p.0 - a.0 - t * dx, p.1 - a.1 - t * dy)
}

/// Links and citations of the guide that lead nowhere; pages that the table of contents does not name.
///
/// # Errors
/// A folder that cannot be read.
pub fn broken() -> Outcome<Vec<String>> {
    let works = bib::entries()?;
    let mut out = Vec::new();
    let contents = read(&source().join("SUMMARY.md"))?;
    for file in files(&source(), ".md")? {
        let text = read(&file)?;
        let name = relative(&source(), &file);
        for link in links(&text) {
            if let Some(why) = leads_nowhere(&file, &link.target) {
                out.push(format!("{name}:{}: {}: {why}", link.line, link.target));
            }
        }
        for (line, key) in citations(&text) {
            if !works.contains_key(&key) {
                out.push(format!("{name}:{line}: REFERENCES.bib has no `{key}`"));
            }
        }
        if name != "SUMMARY.md" && !contents.contains(&format!("({name})")) {
            out.push(format!("{name}: not in SUMMARY.md"));
        }
    }
    Ok(out)
}

fn leads_nowhere(page: &Path, target: &str) -> Option<String> {
    if target.starts_with("http://") || target.starts_with("https://") {
        return None;
    }
    let (path, anchor) = target.split_once('#').unwrap_or((target, ""));
    let file = if path.is_empty() { page.to_owned() } else { tidy(&page.parent()?.join(path)) };
    if !file.exists() {
        return Some("no such file".into());
    }
    if anchor.is_empty() {
        return None;
    }
    let text = read(&file).ok()?;
    (!anchors(&text).iter().any(|a| a == anchor)).then(|| "no such heading".into())
}
