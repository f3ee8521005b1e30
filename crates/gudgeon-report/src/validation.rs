//! Cases beside the values of their sources: one page of Markdown for all, and one for each.

use std::fmt::Write as _;

use gudgeon_core::result::{Check, Validated, Verdict};

/// A deviation as a table shows it. Rounding differs between machines, so what is of its size is only called small.
fn deviation(c: &Check) -> String {
    let d = c.deviation();
    if d.abs() < 1e-12 { "< 1e-12".into() } else { format!("{d:+.0e}") }
}

/// Digits that a comparison can vouch for: those beyond eight would differ between machines.
fn value(v: f64) -> String {
    if v == 0.0 { "0".into() } else { format!("{v:.7e}") }
}

/// Text in a cell of a table.
fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace('\n', " ")
}

/// The name of a page: `rigs/slider.toml` as `rigs-slider`.
#[must_use]
pub fn page_name(v: &Validated) -> String {
    let parts: Vec<&str> = v.file.split(['/', '\\']).collect();
    let below = parts.iter().rposition(|p| *p == "validation").map_or(parts.len() - 1, |k| k + 1);
    parts[below..].join("-").trim_end_matches(".toml").to_owned()
}

/// All cases on one screen: a line each with its counts and its worst deviation, linked to its page in `folder`.
#[must_use]
pub fn validation_index(all: &[Validated], folder: &str) -> String {
    let mut out = String::from(
        "# Validation\n\n`gudgeon validate` compares the cases with the values of their sources and of exact solutions, and makes \
         these pages (`--pages`). *Reproduced*: the value comes out, within a tolerance whose reason stands beside it. *Refuted*: the \
         source is wrong, and what shows it stands beside the value. *Not reproduced*: the value does not come out, for a lost input or \
         for a reason that is not known. Models that are coarser than others are compared with their own solutions, and what they \
         miss with the difference of both.\n\n",
    );
    let total = |v| all.iter().map(|a| a.count(v)).sum::<usize>();
    let runs: usize = all.iter().map(|a| a.runs).sum();
    // Writing to a String cannot fail.
    let _ = writeln!(
        out,
        "{} files, {runs} runs: **{} reproduced, {} refuted, {} not reproduced**. The worst deviation is that of the reproduced value \
         that uses the largest part of its tolerance.\n",
        all.len(),
        total(Verdict::Reproduced),
        total(Verdict::Refuted),
        total(Verdict::NotReproduced),
    );
    out.push_str("| case | what | reproduced | refuted | not reproduced | worst deviation (admitted) |\n|---|---|---:|---:|---:|---|\n");
    for a in all {
        let name = page_name(a);
        let count = |v| match a.count(v) {
            0 => String::new(),
            n => n.to_string(),
        };
        let worst = a.worst().map_or_else(String::new, |c| format!("{} ({:.0e})", deviation(c), c.tolerance));
        let broken = a.broken().count();
        let broken = if broken > 0 { format!(" **{broken} broken**") } else { String::new() };
        let _ = writeln!(
            out,
            "| [{name}]({folder}/{name}.md) | {} | {} | {} | {} | {worst}{broken} |",
            cell(&a.title),
            count(Verdict::Reproduced),
            count(Verdict::Refuted),
            count(Verdict::NotReproduced),
        );
    }
    out
}

/// One case with every comparison.
#[must_use]
pub fn validation_page(v: &Validated) -> String {
    let counts: Vec<String> = Verdict::ALL
        .iter()
        .filter(|k| v.count(**k) > 0)
        .map(|k| format!("{} {}", v.count(*k), k.words()))
        .collect();
    let mut out = format!(
        "# {}\n\n`{}`: {}.\n\n{}\n\nDeviations are relative, or absolute where the source gives zero.\n",
        v.title,
        page_name(v),
        counts.join(", "),
        v.source
    );
    let mut setting = None;
    for c in &v.checks {
        if setting.as_ref() != Some(&c.setting()) {
            let _ = write!(
                out,
                "\n## {}\n\n| result | computed | source | unit | deviation | admitted | verdict | where from |\n\
                 |---|---:|---:|---|---:|---:|---|---|\n",
                cell(&c.setting())
            );
            setting = Some(c.setting());
        }
        let admitted = if c.verdict == Verdict::Reproduced { "" } else { "must exceed " };
        let broken = if c.holds() { "" } else { " **does not hold**" };
        let _ = writeln!(
            out,
            "| {} | {} | {} | {} | {} | {admitted}{:.0e} | {}{broken} | {} |",
            cell(&c.result),
            value(c.value),
            value(c.reference),
            c.unit,
            deviation(c),
            c.tolerance,
            c.verdict.words(),
            cell(&c.source)
        );
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(value: f64, reference: f64, tolerance: f64, verdict: Verdict) -> Check {
        Check {
            set: Vec::new(),
            against: None,
            result: "load".into(),
            value,
            reference,
            unit: "N".into(),
            tolerance,
            source: "a | b".into(),
            verdict,
        }
    }

    fn validated() -> Validated {
        let checks = vec![
            check(1.001, 1.0, 0.01, Verdict::Reproduced),
            check(2.0, 1.0, 0.1, Verdict::Refuted),
            check(1.5, 1.0, 0.1, Verdict::NotReproduced),
            check(1.5, 1.0, 0.1, Verdict::Reproduced),
        ];
        Validated {
            case: "slider".into(),
            file: "a/validation/rigs/slider.toml".into(),
            title: "A slider".into(),
            runs: 1,
            checks,
            ..Validated::default()
        }
    }

    #[test]
    fn verdicts_are_counted_apart_and_what_is_broken_counts_for_none() {
        let v = validated();
        assert_eq!(Verdict::ALL.map(|k| v.count(k)), [1, 1, 1]);
        assert_eq!(v.broken().count(), 1);
        let index = validation_index(std::slice::from_ref(&v), "docs");
        assert!(index.contains("**1 reproduced, 1 refuted, 1 not reproduced**"), "{index}");
        assert!(index.contains("[rigs-slider](docs/rigs-slider.md)") && index.contains("**1 broken**"));
    }

    #[test]
    fn a_bar_in_a_text_does_not_end_a_cell() {
        assert!(validation_page(&validated()).contains("a \\| b"));
    }
}
