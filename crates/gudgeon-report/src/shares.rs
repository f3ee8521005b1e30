//! The part of a comparison's page that tells which choice matters.

use std::fmt::Write;

use gudgeon_core::result::{CASE, Share, ShareRow, ShareTable};

use crate::number::{significant, unit};
use crate::page::{esc, prose};

/// Tables of shares: the first one in full view, the others to be opened.
pub(crate) fn section(out: &mut String, tables: &[ShareTable]) {
    let Some((first, others)) = tables.split_first() else { return };
    out.push_str("<section id=\"shares\"><h2>Which choice matters</h2>");
    findings(out, first);
    table(out, first);
    every_effect(out, first);
    for t in others {
        let name = t.case.as_deref().unwrap_or_default();
        let _ = write!(out, "<details class=\"more\"><summary>{} alone</summary>", esc(name));
        findings(out, t);
        table(out, t);
        every_effect(out, t);
        out.push_str("</details>");
    }
    out.push_str("</section>\n");
}

fn findings(out: &mut String, t: &ShareTable) {
    if t.findings.is_empty() {
        return;
    }
    out.push_str("<ul class=\"findings\">");
    for f in &t.findings {
        let _ = write!(out, "<li>{}</li>", prose(f));
    }
    out.push_str("</ul>");
}

/// What is drawn together: a name, its colour and its effects.
struct Part {
    name: String,
    colour: usize,
    effects: Vec<usize>,
}

/// Colours of the interactions; choices have those before.
const INTERACTIONS: usize = 6;
const WITH_CASE: usize = 7;

/// Each choice alone, interactions of choices, interactions with the case.
fn parts(t: &ShareTable) -> Vec<Part> {
    let single = |e: &usize| t.effects[*e].len() == 1;
    let mut parts: Vec<Part> = (0..t.effects.len())
        .filter(single)
        .enumerate()
        .map(|(k, e)| Part { name: t.effect(e), colour: k % INTERACTIONS, effects: vec![e] })
        .collect();
    let several = |with_case: bool| -> Vec<usize> {
        (0..t.effects.len()).filter(|e| !single(e) && t.with_case(*e) == with_case).collect()
    };
    let further = [
        ("interactions".to_owned(), INTERACTIONS, several(false)),
        (format!("with the {CASE}"), WITH_CASE, several(true)),
    ];
    let further = further.into_iter().filter(|(_, _, effects)| !effects.is_empty());
    parts.extend(further.map(|(name, colour, effects)| Part { name, colour, effects }));
    parts
}

fn explanation(t: &ShareTable) -> String {
    let over = if t.case.is_some() {
        "Spread is the standard deviation of a result over all combinations, of its mean."
    } else {
        "Each result is taken relative to its case: its mean there is taken off, and what is left divided by the mean magnitude there, so that \
         a large engine counts as much as a small one; angles are shifts. Spread is the standard deviation over the combinations of a case. \
         The last column tells how much of the variance of the values themselves lies between the cases."
    };
    let numerics = if t.verified {
        "found by refinement"
    } else {
        "taken as 0.1 % of the mean magnitude and 1.8° of an angle; --verify finds them"
    };
    format!(
        "{over} The bars show which part of the variance each choice explains alone, and what is left to interactions, where the effect of one \
         choice depends on another. ~ marks what the numerical uncertainties of the results ({numerics}) can make."
    )
}

fn table(out: &mut String, t: &ShareTable) {
    let rows: Vec<&ShareRow> = t.headlines().collect();
    let parts = parts(t);
    let _ = write!(out, "<p class=\"hint\">{}</p><div class=\"keys\">", esc(&explanation(t)));
    for p in &parts {
        let _ = write!(out, "<span><i class=\"block c{}\"></i>{}</span>", p.colour, esc(&p.name));
    }
    out.push_str("</div><div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"table\"><table class=\"plain compare\"><thead><tr><th>Result</th><th class=\"num\">spread</th><td></td>");
    for p in &parts {
        let _ = write!(out, "<th class=\"num\">{}</th>", esc(&p.name));
    }
    if t.case.is_none() {
        out.push_str("<th class=\"num\" title=\"Part of the variance of the values themselves that the case explains\">case, of the values</th>");
    }
    out.push_str("</tr></thead><tbody>");
    for r in rows {
        row(out, t, r, &parts);
    }
    out.push_str("</tbody></table></div>");
    for (levels, results) in left_out(t) {
        let _ = write!(
            out,
            "<p class=\"hint\">Without {} in {}: not all combinations with it have a result to use.</p>",
            esc(&levels),
            esc(&results)
        );
    }
}

/// Levels that are left out, with the results they are left out of.
fn left_out(t: &ShareTable) -> Vec<(String, String)> {
    let mut all: Vec<(String, Vec<&str>)> = Vec::new();
    for r in t.headlines().filter(|r| !r.left_out.is_empty()) {
        let levels = r.left_out.join(", ");
        match all.iter_mut().find(|(l, _)| *l == levels) {
            Some((_, results)) => results.push(&r.result),
            None => all.push((levels, vec![&r.result])),
        }
    }
    all.into_iter().map(|(levels, results)| (levels, results.join(", "))).collect()
}

fn row(out: &mut String, t: &ShareTable, r: &ShareRow, parts: &[Part]) {
    let alike: Vec<&str> =
        t.rows.iter().filter(|o| o.same_as.as_ref() == Some(&r.result)).map(|o| o.result.as_str()).collect();
    let mut name = format!("<code>{}</code>", esc(&r.result));
    if !alike.is_empty() {
        let _ = write!(name, " <span class=\"muted\">and {}</span>", esc(&alike.join(", ")));
    }
    let spread = format!("{} {}", significant(Some(r.spread), 2), unit(&r.spread_unit));
    let _ = write!(
        out,
        "<tr><th scope=\"row\" title=\"{}\">{name}</th><td class=\"num\">{spread}</td><td><div class=\"stack\">",
        esc(&r.what)
    );
    for p in parts {
        let share = together(r, &p.effects).map_or(0.0, |s| s.share);
        let _ = write!(
            out,
            "<i class=\"c{}\" style=\"width:{:.1}%\" title=\"{}: {}\"></i>",
            p.colour,
            100.0 * share,
            esc(&p.name),
            percent(share)
        );
    }
    out.push_str("</div></td>");
    for p in parts {
        share_cell(out, together(r, &p.effects));
    }
    if t.case.is_none() {
        let between = r.between_cases.map_or_else(|| "–".into(), percent);
        let _ = write!(out, "<td class=\"num\">{between}</td>");
    }
    out.push_str("</tr>");
}

/// Effects as one: within the numerics when all of them are.
fn together(r: &ShareRow, effects: &[usize]) -> Option<Share> {
    let all: Vec<Share> = effects.iter().filter_map(|e| r.shares.get(*e).copied().flatten()).collect();
    let sum = |f: fn(&Share) -> f64| all.iter().map(f).sum();
    (!all.is_empty()).then(|| Share {
        share: sum(|s| s.share),
        largest: all.iter().map(|s| s.largest).fold(0.0, f64::max),
        within_numerics: all.iter().all(|s| s.within_numerics),
    })
}

fn share_cell(out: &mut String, share: Option<Share>) {
    let Some(s) = share else {
        out.push_str("<td class=\"num\">–</td>");
        return;
    };
    let step = match s.share {
        _ if s.within_numerics => 0,
        s if s < 0.05 => 0,
        s if s < 0.2 => 1,
        s if s < 0.5 => 2,
        _ => 3,
    };
    let mark = if s.within_numerics { "~ " } else { "" };
    let _ = write!(out, "<td class=\"num less{step}\">{mark}{}</td>", percent(s.share));
}

/// All effects of all results, with how large each can be.
fn every_effect(out: &mut String, t: &ShareTable) {
    out.push_str(
        "<details class=\"more\"><summary>Every effect on every result</summary><p class=\"hint\">Share of the variance, and the largest \
         effect in the unit of the spread.</p><div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"table\"><table class=\"plain compare\"><thead><tr><th>Result</th><th class=\"num\">spread</th>",
    );
    for e in 0..t.effects.len() {
        let _ = write!(out, "<th class=\"num\">{}</th>", esc(&t.effect(e)).replace(" × ", " ×<br>"));
    }
    out.push_str("</tr></thead><tbody>");
    for r in &t.rows {
        let _ = write!(
            out,
            "<tr><th scope=\"row\"><code>{}</code></th><td class=\"num\">{} {}</td>",
            esc(&r.result),
            significant(Some(r.spread), 2),
            unit(&r.spread_unit)
        );
        for s in &r.shares {
            match s {
                None => out.push_str("<td class=\"num\">–</td>"),
                Some(s) => {
                    let mark = if s.within_numerics { "~ " } else { "" };
                    let largest = significant(Some(s.largest), 2);
                    let _ = write!(
                        out,
                        "<td class=\"num\">{mark}{} <span class=\"diff\">{largest}</span></td>",
                        percent(s.share)
                    );
                }
            }
        }
        out.push_str("</tr>");
    }
    out.push_str("</tbody></table></div></details>");
}

/// A share in per cent; what is not nothing is not called so.
fn percent(share: f64) -> String {
    match 100.0 * share {
        0.0 => "0 %".into(),
        p if p < 0.1 => "&lt; 0.1 %".into(),
        p if p < 10.0 => format!("{p:.1} %"),
        p => format!("{p:.0} %"),
    }
}
