//! The part of a comparison's page that tells how the headline results differ, and whether the numerics leave that open.

use std::fmt::Write;

use gudgeon_core::result::{Confidence, Difference};

use crate::comparison::{File, VariantEntry, badge, base_of, headline_results};
use crate::number::{capital, certain, percent, signed, unit};
use crate::page::{self, esc};

/// Most variants beside each other.
const ACROSS: usize = 8;

/// How a result of a variant differs from that of its base; none for the base, and where one of the two has no such result in the same unit.
pub(crate) fn difference(variants: &[VariantEntry], v: &VariantEntry, name: &str) -> Option<Difference> {
    let base = base_of(variants, v).filter(|b| b.number != v.number)?;
    let of = |v: &VariantEntry| {
        let r = v.run.as_ref()?.results.get(name)?;
        Some((r.value?, r.uncertainty, r.unit.clone()))
    };
    let ((a, ua, u), (b, ub, other)) = (of(base)?, of(v)?);
    (u == other).then(|| Difference::between((a, ua), (b, ub), &u))?
}

/// Sign and word of a verdict.
const fn verdict(c: Confidence) -> (&'static str, &'static str) {
    match c {
        Confidence::Equal => ("=", "equal"),
        Confidence::Resolved => ("✓", "resolved"),
        Confidence::NotResolved => ("≈", "not resolved"),
        Confidence::Unknown => ("?", "no uncertainty known"),
    }
}

/// What a verdict says.
const fn meaning(c: Confidence, verified: bool) -> &'static str {
    match c {
        Confidence::Equal => "both values are the same number",
        Confidence::Resolved => "the difference is larger than its uncertainty",
        Confidence::NotResolved => "it is not larger: the numerical errors alone can make it",
        Confidence::Unknown if verified => {
            "<code>--verify</code> found no numerical setting of these models that tells it"
        }
        Confidence::Unknown => "run with <code>--verify</code>, and the uncertainty of each result is found",
    }
}

/// In the unit of the result: `+0.27 l/min ± 0.02`.
fn absolute(d: &Difference, u: &str) -> String {
    let (value, error) = signed(d.absolute, d.uncertainty);
    let u = match u {
        "%" => "percentage points".to_owned(),
        u => esc(&unit(u)),
    };
    let space = if u.is_empty() || u == "°" { "" } else { " " };
    format!("{value}{space}{u}{error}")
}

/// Of the base, where that says something: `+3.2 % ± 0.1`.
fn relative(d: &Difference) -> Option<String> {
    let p = d.percent?;
    let Some(u) = d.percent_uncertainty else { return Some(percent(p)) };
    let (value, error) = signed(p, Some(u));
    Some(format!("{value} %{error}"))
}

/// In few characters, for a cell: per cent, or where that says nothing the unit; marked where it is not resolved.
pub(crate) fn short(d: &Difference, u: &str) -> String {
    let mark = if d.confidence() == Confidence::NotResolved { "≈ " } else { "" };
    format!("{mark}{}", relative(d).unwrap_or_else(|| absolute(d, u)))
}

/// How strong the ground of a cell is, by per cent or by degrees; what is not resolved has none.
pub(crate) fn ground(d: &Difference, u: &str) -> String {
    let size = d.percent.or_else(|| (u == "deg").then_some(d.absolute)).unwrap_or(0.0);
    let step = match size.abs() {
        _ if d.confidence() == Confidence::NotResolved => 0,
        d if d < 1.0 => 0,
        d if d < 5.0 => 1,
        d if d < 20.0 => 2,
        _ => 3,
    };
    format!("{}{step}", if d.absolute < 0.0 { "less" } else { "more" })
}

/// A table for each case; of several the first in full view.
pub(crate) fn section(out: &mut String, file: &File, ran: &[&VariantEntry]) {
    let tables: Vec<(usize, String)> = (0..file.cases.len().max(1))
        .filter_map(|case| {
            let own: Vec<&VariantEntry> = ran.iter().copied().filter(|v| v.case == case).collect();
            Some((case, table(file, &own)?))
        })
        .collect();
    if tables.is_empty() {
        return;
    }
    out.push_str("<section id=\"differences\"><h2>Differences</h2>");
    for (k, (case, table)) in tables.iter().enumerate() {
        match file.cases.get(*case).filter(|_| file.cases.len() > 1) {
            Some(c) => {
                let open = if k == 0 { " open" } else { "" };
                let _ = write!(
                    out,
                    "<details class=\"more\"{open}><summary>{}</summary>{table}</details>",
                    esc(&c.name)
                );
            }
            None => out.push_str(table),
        }
    }
    out.push_str("</section>\n");
}

/// Headline results of the variants of one case; none where there is nothing to compare.
fn table(file: &File, own: &[&VariantEntry]) -> Option<String> {
    let (base, others) = own.split_first()?;
    let shown = &others[..others.len().min(ACROSS)];
    let names = headline_results(own);
    if shown.is_empty() || names.is_empty() {
        return None;
    }
    let mut verdicts: Vec<Confidence> = Vec::new();
    let mut rows = String::new();
    for (title, name) in &names {
        row(&mut rows, file, (title, name), base, shown, &mut verdicts);
    }
    let mut out = format!("<p>{}</p>{}", counted(&verdicts), to_base(file, base, &verdicts));
    keys(&mut out, &verdicts, file.verified);
    out.push_str("<div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"table\"><table class=\"plain compare\"><thead><tr><th>Result</th>");
    for v in shown {
        crate::comparison::variant_head(&mut out, v);
    }
    let _ = write!(out, "</tr></thead><tbody>{rows}</tbody></table></div>");
    if others.len() > ACROSS {
        let _ = write!(
            out,
            "<p class=\"hint\">The first {ACROSS} of {} variants beside the base; the table of all results has all.</p>",
            others.len()
        );
    }
    Some(out)
}

fn row(
    out: &mut String,
    file: &File,
    (title, name): (&str, &str),
    base: &VariantEntry,
    shown: &[&VariantEntry],
    verdicts: &mut Vec<Confidence>,
) {
    let own = base.run.as_ref().and_then(|r| r.results.get(name));
    let u = own.map_or("", |r| r.unit.as_str());
    let _ = write!(
        out,
        "<tr><th scope=\"row\">{}<br><code>{}</code><br>{} {} <span class=\"unit\">{}</span></th>",
        page::prose(&capital(title)),
        esc(name),
        badge(base.number),
        certain(own.and_then(|r| r.value), own.and_then(|r| r.uncertainty), 4),
        esc(&unit(u))
    );
    for v in shown {
        let Some(d) = difference(&file.variants, v, name) else {
            out.push_str("<td class=\"num\">–</td>");
            continue;
        };
        let confidence = d.confidence();
        verdicts.push(confidence);
        let (sign, word) = verdict(confidence);
        let lines = match confidence {
            Confidence::Equal => String::new(),
            _ => {
                let percent = relative(&d).map_or_else(String::new, |p| format!("{p}<br>"));
                format!("<b>{}</b><br>{percent}", absolute(&d, u))
            }
        };
        // Where nothing was verified, the line above the table says so for all.
        let told = if is_told_once(confidence, file.verified) {
            lines.trim_end_matches("<br>").to_owned()
        } else {
            format!("{lines}{sign} {word}")
        };
        let _ = write!(out, "<td class=\"num {}\">{told}</td>", ground(&d, u));
    }
    out.push_str("</tr>");
}

/// Whether a verdict is that of all differences that are not equal, and stands above the table alone.
const fn is_told_once(c: Confidence, verified: bool) -> bool {
    matches!(c, Confidence::Unknown) && !verified
}

/// How many differences have which verdict.
fn counted(verdicts: &[Confidence]) -> String {
    let count = |c: Confidence| verdicts.iter().filter(|v| **v == c).count();
    let told = [Confidence::Resolved, Confidence::NotResolved, Confidence::Unknown, Confidence::Equal];
    let parts: Vec<String> = told
        .iter()
        .filter(|c| count(**c) > 0)
        .map(|c| match c {
            Confidence::Unknown => (c, "of unknown uncertainty"),
            c => (c, verdict(*c).1),
        })
        .map(|(c, word)| format!("{} {} {word}", count(*c), if count(*c) == 1 { "is" } else { "are" }))
        .collect();
    let plural = if verdicts.len() == 1 { "" } else { "s" };
    format!("Of {} difference{plural} of headline results {}.", verdicts.len(), parts.join(", "))
}

/// What the differences are to, and what ± means.
fn to_base(file: &File, base: &VariantEntry, verdicts: &[Confidence]) -> String {
    let known = verdicts.iter().any(|c| matches!(c, Confidence::Resolved | Confidence::NotResolved));
    let bound = if known {
        " ± bounds the error of a difference: the uncertainties of both runs added. Numerical errors of two runs are no independent random numbers (the same \
         grid errs to the same side in both, another model may err to the other), so their magnitudes are added, and not their squares."
    } else {
        ""
    };
    format!("<p class=\"hint\">{}{bound}</p>", base_told(file, base))
}

/// Which variant differences are to, and why it is not the first of its case.
pub(crate) fn base_told(file: &File, base: &VariantEntry) -> String {
    let mut text = format!("Differences are to variant {} {}", badge(base.number), esc(&base.label));
    let first = file.variants.iter().find(|v| v.case == base.case).filter(|v| v.number != base.number);
    if let Some(first) = first {
        // `left out: …`, `refused: …` or `failed: …`.
        let why = first.error.as_deref().and_then(|e| e.split_once(':')).map_or("no run", |(word, _)| word);
        let _ = write!(
            text,
            ", the first that ran: {} {} has no result (<a href=\"#refused\">{}</a>)",
            badge(first.number),
            esc(&first.label),
            esc(why)
        );
    }
    text + "."
}

/// The signs that occur, with their meaning.
fn keys(out: &mut String, verdicts: &[Confidence], verified: bool) {
    out.push_str("<div class=\"keys\">");
    for c in [Confidence::Resolved, Confidence::NotResolved, Confidence::Unknown, Confidence::Equal] {
        if verdicts.contains(&c) {
            let (mut sign, word) = verdict(c);
            if is_told_once(c, verified) {
                sign = "";
            }
            let _ = write!(out, "<span>{sign} <b>{word}</b>: {}</span>", meaning(c, verified));
        }
    }
    out.push_str("</div>");
}
