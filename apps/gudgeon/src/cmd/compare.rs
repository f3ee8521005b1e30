//! `gudgeon compare CASE --swap PATH=A,B,C`

use std::fmt::Write as _;

use gudgeon_core::result::{Comparison, RunResult};

use crate::args::CompareArgs;
use crate::cmd::{checked, open_out};
use crate::failure::Failure;
use crate::ui::{Ui, number, table, unit};

pub fn compare(a: &CompareArgs, ui: &Ui) -> Result<(), Failure> {
    let swaps = a.swap.iter().map(|s| values("--swap", s)).collect::<Result<Vec<_>, _>>()?;
    let name = checked(&a.case, ui)?.name;
    let folder = open_out(a.out.as_deref(), &a.case.case, &name, "-compare")?;
    let comparison = {
        let bar = ui.bar();
        let compare = if a.verify { gudgeon_study::compare_verified } else { gudgeon_study::compare };
        compare(&a.case.case, &a.case.set, &swaps, &mut |p| bar.show(p))?
    };
    let files = gudgeon_report::write_comparison_in(&comparison, folder)?;
    if !ui.quiet() {
        ui.out(&format!("{}\n{}", text(&comparison), files.report.display()));
    }
    let failed = comparison.variants.iter().filter(|v| v.outcome.is_err()).count();
    match failed {
        0 => Ok(()),
        n if n == comparison.variants.len() => {
            Err(Failure::Run("none of the combinations has a result".into()))
        }
        n => Err(Failure::Run(format!(
            "{n} of {} combinations have no result; the others are written",
            comparison.variants.len()
        ))),
    }
}

/// `PATH=A,B,C`. A comma inside brackets or quotes belongs to its value.
pub fn values(flag: &str, text: &str) -> Result<(String, Vec<String>), Failure> {
    let form =
        format!("write `{flag} PATH=A,B,C`, for example `{flag} gas_flow=orifice_network,narrow_channel`");
    let Some((path, values)) = text.split_once('=').filter(|(p, _)| !p.trim().is_empty()) else {
        return Err(Failure::argument(format!("`{flag} {text}` is not a path with values"), form));
    };
    let mut all = vec![String::new()];
    let (mut depth, mut quote) = (0_i32, None);
    for c in values.chars() {
        match (quote, c) {
            (Some(q), c) if c == q => quote = None,
            (None, '"' | '\'') => quote = Some(c),
            (None, '[' | '{' | '(') => depth += 1,
            (None, ']' | '}' | ')') => depth -= 1,
            _ => {}
        }
        match all.last_mut() {
            Some(last) if c != ',' || depth > 0 || quote.is_some() => last.push(c),
            _ => all.push(String::new()),
        }
    }
    let all: Vec<String> = all.into_iter().map(|v| v.trim().to_owned()).collect();
    if all.iter().any(String::is_empty) {
        return Err(Failure::argument(format!("`{flag} {text}` has an empty value"), form));
    }
    Ok((path.trim().to_owned(), all))
}

/// Numerical uncertainty of a result; 0 where nobody asked for it.
fn uncertainty(r: &RunResult, name: &str) -> f64 {
    r.verification.as_ref().and_then(|v| v.uncertainty.get(name)).copied().unwrap_or(0.0)
}

/// Combinations that fit a terminal side by side.
const COLUMNS: usize = 4;

fn text(c: &Comparison) -> String {
    let mut s = format!("{}: {}\n\n", c.case, c.title);
    let letter = |i: usize| format!("({})", i + 1);
    // Writing to a String cannot fail.
    for (i, v) in c.variants.iter().enumerate() {
        let why = v.outcome.as_ref().err().map_or_else(String::new, |e| format!("  {e}"));
        let _ = writeln!(s, "  {} {}{why}", letter(i), v.label);
        for n in v.outcome.iter().flat_map(|r| &r.solver.notes) {
            let _ = writeln!(s, "      note: {}", n.text);
        }
    }
    let shown: Vec<_> =
        c.variants.iter().enumerate().filter_map(|(i, v)| Some((i, v.outcome.as_ref().ok()?))).collect();
    let Some((first, base)) = shown.first() else { return s };
    let shown = &shown[..shown.len().min(COLUMNS)];
    let mut rows = vec![vec![String::new(), String::new(), letter(*first)]];
    for (i, _) in &shown[1..] {
        rows[0].extend([letter(*i), format!("to {}", letter(*first))]);
    }
    for (name, v) in &base.results {
        let mut row = vec![name.clone(), unit(&v.unit), number(v.value)];
        for (_, r) in &shown[1..] {
            let other = r.results.get(name);
            row.push(other.map_or_else(|| "-".into(), |o| number(o.value)));
            row.push(match other {
                Some(o) if (o.value - v.value).abs() < uncertainty(base, name) + uncertainty(r, name) => {
                    "numerics".into()
                }
                Some(o) if v.value != 0.0 && o.value != v.value => {
                    format!("{:+.2} %", 100.0 * (o.value / v.value - 1.0))
                }
                _ => String::new(),
            });
        }
        rows.push(row);
    }
    let mut times = vec!["time".to_owned(), "s".to_owned()];
    for (k, (_, r)) in shown.iter().enumerate() {
        times.push(r.seconds.get("total").map_or_else(String::new, |t| number(*t)));
        times.extend((k > 0).then(String::new));
    }
    rows.push(times);
    s.push('\n');
    let right: Vec<usize> = (2..2 + 2 * shown.len()).collect();
    s.push_str(&table(&rows, &right));
    let hidden = c.variants.iter().filter(|v| v.outcome.is_ok()).count() - shown.len();
    if hidden > 0 {
        let _ = writeln!(s, "\n  {hidden} more in the report");
    }
    s
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn swaps_split_at_outer_commas() {
        let values = |t: &str| values("--swap", t).ok().map(|(_, v)| v);
        assert_eq!(values("a.b=x, y"), Some(vec!["x".into(), "y".into()]));
        assert_eq!(
            values("a=[1,2],\"p,q\",{ m = 1, n = 2 }"),
            Some(vec!["[1,2]".into(), "\"p,q\"".into(), "{ m = 1, n = 2 }".into()])
        );
        for wrong in ["a", "=x", "a=", "a=x,,y", "a=x,"] {
            assert!(values(wrong).is_none(), "{wrong}");
        }
    }
}
