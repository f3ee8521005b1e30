//! The first page: title, what was changed, the verdict with its reasons, headline results with small pictures, the figure that leads.

use std::fmt::Write;

use gudgeon_core::result::{Assessment, Grade, Headline, Series};

use crate::number::{capital, certain, significant, unit};
use crate::page::{self, esc};
use crate::spark::spark;
use crate::summary::{ResultValue, Summary};

/// Reasons of a verdict that stand on the first page; the others stand with the notes.
const REASONS: usize = 4;
/// Headlines on the first page.
pub(crate) const CARDS: usize = 10;
/// Significant digits of a headline.
const DIGITS: usize = 3;

pub(crate) fn section(out: &mut String, s: &Summary, series: &Series) {
    // On paper this is one sheet, and the figure takes what is left of it.
    out.push_str("<div class=\"sheet\">\n<section id=\"overview\">\n");
    header(out, s);
    verdict(out, s);
    cards(out, s, series);
    // The bar of the crank angle stays in sight of all that follows it.
    out.push_str("</section>\n<div id=\"bar\"></div>\n<div id=\"lead\"></div>\n</div>\n");
}

fn header(out: &mut String, s: &Summary) {
    let _ =
        write!(out, "<header><h1>{}</h1><p class=\"meta\"><code>{}</code>", esc(s.heading()), esc(&s.case));
    if !s.scene.is_empty() {
        let _ = write!(out, " · {}", esc(&s.scene.replace('_', " ")));
    }
    if !s.solver.method.is_empty() {
        let _ = write!(out, " · solver {}", esc(&s.solver.method.replace('_', " ")));
    }
    if !s.gudgeon.is_empty() {
        let _ = write!(out, " · Gudgeon {}", esc(&s.gudgeon));
    }
    if !s.assumptions.is_empty() {
        let n = s.assumptions.len();
        let plural = if n == 1 { "" } else { "s" };
        let _ = write!(out, " · <a href=\"#sources\">{n} assumed input{plural}</a>");
    }
    out.push_str("</p>");
    if !s.provenance.overrides.is_empty() {
        let set: Vec<String> =
            s.provenance.overrides.iter().map(|o| format!("<code>{}</code>", esc(o))).collect();
        let _ = write!(out, "<p class=\"changed\"><b>Changed</b> {}</p>", set.join(", "));
    }
    out.push_str("</header>\n");
}

/// The grade in words and colour, with what it rests on.
fn verdict(out: &mut String, s: &Summary) {
    let a = Assessment::of(&s.notes);
    banner(out, a.grade, &a.title, &a.reasons);
}

/// A grade with its reasons, of which the first few stand here and all with the notes.
pub(crate) fn banner(out: &mut String, grade: Grade, title: &str, reasons: &[String]) {
    let sign = match grade {
        Grade::Green => "✓",
        Grade::Amber => "!",
        Grade::Red => "✕",
    };
    let _ = write!(
        out,
        "<div class=\"verdict {}\" role=\"note\"><p><span class=\"sign\" aria-label=\"{}\">{sign}</span><b>{}</b></p>",
        grade.name(),
        grade.name(),
        page::prose(title)
    );
    if !reasons.is_empty() {
        out.push_str("<ul>");
        for r in reasons.iter().take(REASONS) {
            let _ = write!(out, "<li>{}</li>", page::prose(&capital(r)));
        }
        if reasons.len() > REASONS {
            let _ = write!(out, "<li><a href=\"#notes\">{} more</a></li>", reasons.len() - REASONS);
        }
        out.push_str("</ul>");
    }
    out.push_str("</div>\n");
}

fn cards(out: &mut String, s: &Summary, series: &Series) {
    if s.headlines.is_empty() {
        out.push_str("<p class=\"hint\">This run computed no results.</p>\n");
        return;
    }
    out.push_str("<h2 class=\"unseen\">Headline results</h2>\n<div class=\"cards\">\n");
    for h in s.headlines.iter().take(CARDS) {
        card(out, s, series, h);
    }
    out.push_str("</div>\n");
}

fn card(out: &mut String, s: &Summary, series: &Series, h: &Headline) {
    let _ = write!(out, "<div class=\"card\"><h3>{}</h3>", page::prose(&capital(&h.title)));
    let of = |name: &str| s.results.get(name);
    if let [(label, name)] = &h.results[..] {
        let what = s.descriptions.get(name).map_or("", String::as_str);
        let label = if label.is_empty() {
            String::new()
        } else {
            format!("<span class=\"of\">{}</span>", esc(label))
        };
        let _ = write!(out, "<p class=\"value\">{label}{}</p>", of(name).map_or_else(String::new, value));
        if let Some(more) = beyond(&h.title, what) {
            let _ = write!(out, "<p class=\"what\">{}</p>", page::prose(more));
        }
    } else {
        members(out, s, h);
    }
    let columns: Vec<_> = h.curves.iter().filter_map(|c| series.get(c)).collect();
    if let Some(picture) = spark(&columns) {
        out.push_str(&picture);
    }
    out.push_str("</div>\n");
}

/// What a description says that the title does not, up to its first semicolon.
fn beyond<'a>(title: &str, what: &'a str) -> Option<&'a str> {
    let more = what.split("; ").next().unwrap_or_default();
    (!more.is_empty() && !title.to_lowercase().contains(&more.to_lowercase())).then_some(more)
}

/// A value with its uncertainty, in pieces between which a line may end.
fn value(v: &ResultValue) -> String {
    let text = v.uncertainty.map_or_else(|| whole(v.value), |_| certain(v.value, v.uncertainty, DIGITS));
    let unit = esc(&unit(&v.unit));
    match text.split_once(" ± ") {
        None => format!("{text} <span class=\"unit\">{unit}</span>"),
        Some((text, band)) => {
            format!("<span>{text}</span> <span class=\"unit\">± {band} {unit}</span>")
        }
    }
}

/// Three digits, but every one before the decimal point and those of a whole number.
fn whole(value: Option<f64>) -> String {
    match value {
        Some(v) if v.abs() >= 1000.0 && v.abs() < 1e6 => format!("{v:.0}").replace('-', "−"),
        Some(v) if v.fract() == 0.0 => certain(value, None, DIGITS),
        v => significant(v, DIGITS),
    }
}

/// One row a member, in the colours of the curves.
fn members(out: &mut String, s: &Summary, h: &Headline) {
    let known =
        |(k, (label, name)): (usize, &(String, String))| Some((label.clone(), k, s.results.get(name)?));
    let all: Vec<(String, usize, &ResultValue)> = h.results.iter().enumerate().filter_map(known).collect();
    rows(out, &all);
}

/// Rows of label, number of its colour and value, with bars where the values can be compared.
pub(crate) fn rows(out: &mut String, rows: &[(String, usize, &ResultValue)]) {
    let top = rows.iter().filter_map(|r| r.2.value).fold(0.0, |m: f64, v| m.max(v.abs()));
    let alike = rows.windows(2).all(|w| w[0].2.unit == w[1].2.unit);
    out.push_str("<table class=\"members\"><tbody>");
    for (label, k, v) in rows {
        let share = v.value.filter(|_| alike && top > 0.0).map_or(0.0, |v| 100.0 * v.abs() / top);
        let _ = write!(
            out,
            "<tr><th scope=\"row\" title=\"{0}\">{0}</th><td><i style=\"width:{share:.1}%;background:var(--c{1})\"></i></td><td class=\"num\">{2}</td></tr>",
            esc(label),
            k % 8,
            value(v)
        );
    }
    out.push_str("</tbody></table>");
}
