//! The table of shares of a comparison, for the terminal.

use std::fmt::Write as _;

use gudgeon_core::elementary;
use gudgeon_core::result::{CASE, Share, ShareRow, ShareTable};

use crate::ui::{table, wrapped};

/// Results of one table; the others stand in the report.
const ROWS: usize = 12;

/// Which choice matters. Writing to a String cannot fail.
pub fn text(t: &ShareTable) -> String {
    let shown: Vec<&ShareRow> = t.headlines().take(ROWS).collect();
    if shown.is_empty() {
        return String::new();
    }
    let mut s = String::from("\nWhich choice matters\n");
    s.push_str(&wrapped(explanation(t), 2));
    s.push('\n');
    let single: Vec<usize> = (0..t.effects.len()).filter(|e| t.effects[*e].len() == 1).collect();
    let mut rows = vec![head(t, &single)];
    rows.extend(shown.iter().map(|r| line(t, r, &single)));
    let right: Vec<usize> = (1..rows[0].len()).collect();
    s.push_str(&table(&rows, &right));
    s.push('\n');
    s.push_str(&wrapped(&legend(t), 2));
    for (k, r) in shown.iter().enumerate().filter(|(_, r)| !r.left_out.is_empty()) {
        // Said once where all leave out the same.
        if shown[..k].iter().all(|before| before.left_out != r.left_out) {
            let alike: Vec<&str> =
                shown.iter().filter(|o| o.left_out == r.left_out).map(|o| o.result.as_str()).collect();
            let text = format!(
                "without {} in {}: not all combinations with it have a result to use",
                r.left_out.join(", "),
                alike.join(", ")
            );
            s.push_str(&wrapped(&text, 2));
        }
    }
    s.push('\n');
    for f in &t.findings {
        s.push_str(&wrapped(&f.replace('`', ""), 2));
    }
    let hidden = t.headlines().count() - shown.len();
    if hidden > 0 {
        let _ = writeln!(s, "  {hidden} more results in the report");
    }
    s
}

const fn explanation(t: &ShareTable) -> &'static str {
    if t.case.is_some() {
        "spread: standard deviation over the combinations, of the mean; then the part of the variance that each choice explains"
    } else {
        "spread: standard deviation over the combinations of a case, of its mean; then the part of the variance that each choice explains, \
         each result taken relative to its case"
    }
}

fn head(t: &ShareTable, single: &[usize]) -> Vec<String> {
    let mut head = vec![String::new(), "spread".into()];
    head.extend(single.iter().map(|e| t.effect(*e)));
    let further = [("interactions".to_owned(), false), (format!("with {CASE}"), true)];
    head.extend(further.into_iter().filter(|(_, with)| !several(t, *with).is_empty()).map(|(name, _)| name));
    head
}

/// Interactions with the case, or those without.
fn several(t: &ShareTable, with_case: bool) -> Vec<usize> {
    (0..t.effects.len()).filter(|e| t.effects[*e].len() > 1 && t.with_case(*e) == with_case).collect()
}

fn line(t: &ShareTable, r: &ShareRow, single: &[usize]) -> Vec<String> {
    let mut line = vec![r.result.clone(), spread(r)];
    line.extend(single.iter().map(|e| part(r.shares[*e].as_slice())));
    for effects in [false, true].map(|with| several(t, with)).iter().filter(|e| !e.is_empty()) {
        line.push(part(&effects.iter().filter_map(|e| r.shares[*e]).collect::<Vec<_>>()));
    }
    line
}

/// With two digits.
fn spread(r: &ShareRow) -> String {
    let place = if r.spread > 0.0 { elementary::log10(r.spread).floor() as i32 } else { 0 };
    let decimals = (1 - place).clamp(0, 9) as usize;
    format!("{:.decimals$} {}", r.spread, r.spread_unit)
}

/// Shares together, in per cent; marked where the numerics can make all of them.
fn part(shares: &[Share]) -> String {
    if shares.is_empty() {
        return "-".into();
    }
    let sum: f64 = shares.iter().map(|s| s.share).sum();
    let mark = if shares.iter().all(|s| s.within_numerics) { "~" } else { "" };
    format!("{mark}{:.1} %", 100.0 * sum)
}

fn legend(t: &ShareTable) -> String {
    let found =
        if t.verified { "as --verify found them" } else { "taken as 0.1 % of the mean, --verify finds them" };
    format!("~ within the numerical uncertainties ({found})")
}
