//! `gudgeon compare CASE… --swap PATH=A,B,C`

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use gudgeon_core::quantity::with_decimal_point;
use gudgeon_core::result::{Comparison, Note, NoteLevel, RunResult};
use gudgeon_study::{Plan, Subject};
use indexmap::IndexMap;

use crate::args::CompareArgs;
use crate::cmd::{checked, open_out, shares};
use crate::failure::Failure;
use crate::ui::{Ui, number, table, unit, wrapped};

pub fn compare(a: &CompareArgs, ui: &Ui) -> Result<(), Failure> {
    let swaps = a.swap.iter().map(|s| values("--swap", s)).collect::<Result<Vec<_>, _>>()?;
    let mut cases: Vec<Subject> = Vec::new();
    let mut names: Vec<String> = Vec::new();
    for text in &a.cases {
        let given = given(text);
        let set: Vec<String> = a.set.iter().chain(&given.own).cloned().collect();
        let case = checked(&given.path, &set, ui)?;
        if !names.contains(&case.name) {
            names.push(case.name.clone());
        }
        cases.push(Subject { case: Arc::new(case), own: given.own });
    }
    let plan = Plan { cases, swaps, verify: a.verify, headlines: a.results.clone(), ..Plan::default() };
    let name = match names.as_slice() {
        [first, _, _, _, ..] => format!("{first}+{}", names.len() - 1),
        few => few.join("+"),
    };
    let folder = open_out(a.out.as_deref(), &given(&a.cases[0]).path, &name, "-compare")?;
    let comparison = {
        let bar = ui.bar();
        gudgeon_study::compare_cases(&plan, &mut |p| bar.show(p))?
    };
    let files = gudgeon_report::write_comparison_in(&comparison, folder)?;
    if !ui.quiet() {
        ui.out(&format!("{}\n{}", text(&comparison, &a.results), files.report.display()));
    }
    // Machines that cannot be are left out; that is an answer and no failure.
    let failed = comparison.variants.iter().filter(|v| v.outcome.is_err() && !v.is_left_out()).count();
    match failed {
        0 => Ok(()),
        _ if comparison.variants.iter().all(|v| v.outcome.is_err()) => {
            Err(Failure::Run("none of the combinations has a result".into()))
        }
        n => Err(Failure::Run(format!(
            "{n} of {} combinations have no result; the others are written",
            comparison.variants.len()
        ))),
    }
}

/// A case file, and the changes behind its name.
struct Given {
    path: PathBuf,
    own: Vec<String>,
}

/// `CASE[,PATH=VALUE]…`
fn given(text: &str) -> Given {
    let parts = split(text);
    match parts.as_slice() {
        // A file may have a comma in its name.
        [path, own @ ..] if !Path::new(text).exists() && own.iter().all(|o| o.contains('=')) => {
            Given { path: path.into(), own: own.to_vec() }
        }
        _ => Given { path: text.into(), own: Vec::new() },
    }
}

/// `PATH=A,B,C`. A comma inside brackets or quotes belongs to its value.
pub fn values(flag: &str, text: &str) -> Result<(String, Vec<String>), Failure> {
    let form =
        format!("write `{flag} PATH=A,B,C`, for example `{flag} gas_flow=orifice_network,narrow_channel`");
    let Some((path, values)) = text.split_once('=').filter(|(p, _)| !p.trim().is_empty()) else {
        return Err(Failure::argument(format!("`{flag} {text}` is not a path with values"), form));
    };
    let all = split(values);
    if all.iter().any(String::is_empty) {
        return Err(Failure::argument(format!("`{flag} {text}` has an empty value"), form));
    }
    if let Some((comma, point)) = decimal_comma(&all).filter(|(comma, _)| values.contains(comma.as_str())) {
        return Err(Failure::argument(
            format!("`{comma}` are two values, `{}`", comma.replace(',', "` and `")),
            format!("the decimal mark is a point: `{point}`; of two values each has its unit"),
        ));
    }
    Ok((path.trim().to_owned(), all))
}

/// A number with a decimal comma among parts that were taken apart at commas, `0,25 mm`, and what it would be with a point.
fn decimal_comma(parts: &[String]) -> Option<(String, String)> {
    let pair = |w: &[String]| {
        let whole = w[0].trim_start_matches('-');
        let digits = !whole.is_empty() && whole.chars().all(|c| c.is_ascii_digit());
        let unit = w[1].starts_with(|c: char| c.is_ascii_digit()) && w[1].parse::<f64>().is_err();
        let text = format!("{},{}", w[0], w[1]);
        let point = with_decimal_point(&text).filter(|_| digits && unit)?;
        Some((text, point))
    };
    parts.windows(2).find_map(pair)
}

/// Parts between commas, those inside brackets or quotes apart.
fn split(text: &str) -> Vec<String> {
    let mut all = vec![String::new()];
    let (mut depth, mut quote) = (0_i32, None);
    for c in text.chars() {
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
    all.into_iter().map(|v| v.trim().to_owned()).collect()
}

/// Numerical uncertainty of a result; 0 where nobody asked for it.
fn uncertainty(r: &RunResult, name: &str) -> f64 {
    r.verification.as_ref().and_then(|v| v.uncertainty.get(name)).copied().unwrap_or(0.0)
}

/// Combinations that stand side by side with all their results; of more, each gets a line with some.
const COLUMNS: usize = 4;

/// Combinations whose notes are told one by one; of more, what they say is gathered.
const LISTED: usize = 12;

/// `wanted`: results that the user asked for.
fn text(c: &Comparison, wanted: &[String]) -> String {
    let mut s = format!("{}: {}\n\n", c.case, c.title);
    if c.variants.len() > LISTED {
        gathered(&mut s, c);
    } else {
        listed(&mut s, c);
    }
    if c.cases.len() == 1 && c.variants.len() <= COLUMNS {
        side_by_side(&mut s, c, wanted);
    } else {
        s.push_str(&one_below_the_other(c, wanted));
    }
    s.push_str(&c.shares.first().map_or_else(String::new, shares::text));
    s
}

fn letter(i: usize) -> String {
    format!("({})", i + 1)
}

/// Every combination, then what the runs say: what several say of the same subject once, in the words of the first. Writing to a String cannot fail.
fn listed(s: &mut String, c: &Comparison) {
    let ran = c.variants.iter().filter(|v| v.outcome.is_ok()).count();
    let mut said: IndexMap<&str, (&Note, Vec<usize>)> = IndexMap::new();
    for (i, v) in c.variants.iter().enumerate() {
        let why = v.why().map_or_else(String::new, |why| format!("  {why}"));
        let _ = writeln!(s, "  {} {}{why}", letter(i), v.label);
        for n in v.outcome.iter().flat_map(|r| &r.solver.notes) {
            let of = &mut said.entry(&n.topic).or_insert_with(|| (n, Vec::new())).1;
            if of.last() != Some(&i) {
                of.push(i);
            }
        }
    }
    let mut said: Vec<(&Note, Vec<usize>)> = said.into_values().collect();
    said.sort_by_key(|(n, _)| n.numerical);
    for (n, of) in said {
        let letters: Vec<String> = of.iter().map(|i| letter(*i)).collect();
        let who = match of.len() {
            1 => letters[0].clone(),
            k if k == ran => format!("all, here {}", letters[0]),
            _ => format!("{}, here the first", letters.join(" ")),
        };
        let _ = writeln!(s, "  note of {who}: {}", n.text);
    }
}

/// How many combinations have a result, why others have none, and how often the runs say what. Writing to a String cannot fail.
fn gathered(s: &mut String, c: &Comparison) {
    let good = c.variants.iter().filter(|v| v.outcome.is_ok()).count();
    let _ = writeln!(s, "  {} combinations, {good} with a result", c.variants.len());
    let (mut missing, mut failed): (IndexMap<String, Vec<&str>>, _) = (IndexMap::new(), Vec::new());
    let mut topics: IndexMap<&str, usize> = IndexMap::new();
    for v in &c.variants {
        match &v.outcome {
            Err(_) => missing.entry(v.why().unwrap_or_default()).or_default().push(&v.label),
            Ok(r) => {
                failed.extend(r.solver.notes.iter().find(|n| n.level == NoteLevel::Failure).map(|n| (v, n)));
                for n in &r.solver.notes {
                    *topics.entry(&n.topic).or_default() += 1;
                }
            }
        }
    }
    for (why, labels) in missing {
        s.push_str(&wrapped(&format!("no result: {}: {why}", labels.join("; ")), 2));
    }
    if let Some((v, n)) = failed.first() {
        let text = format!("{} not what was asked for, the first {}: {}", failed.len(), v.label, n.text);
        s.push_str(&wrapped(&text, 2));
    }
    let told: Vec<String> = topics.iter().map(|(topic, n)| format!("{topic} {n}")).collect();
    if !told.is_empty() {
        s.push_str(&wrapped(&format!("notes, told in the report: {}", told.join(", ")), 2));
    }
}

/// The results of few combinations: all of them, or those that were asked for.
fn side_by_side(s: &mut String, c: &Comparison, wanted: &[String]) {
    let shown: Vec<_> =
        c.variants.iter().enumerate().filter_map(|(i, v)| Some((i, v.outcome.as_ref().ok()?))).collect();
    let Some((first, base)) = shown.first() else { return };
    let mut rows = vec![vec![String::new(), String::new(), letter(*first)]];
    for (i, _) in &shown[1..] {
        rows[0].extend([letter(*i), format!("to {}", letter(*first))]);
    }
    for name in base.results.keys().filter(|n| wanted.is_empty() || wanted.contains(n)) {
        let mut row = vec![name.clone(), unit(&base.results[name].unit), value(base, name)];
        for (_, r) in &shown[1..] {
            row.extend([value(r, name), change(base, r, name)]);
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
    // What a result is, behind it: one cylinder or the whole engine.
    if !wanted.is_empty() {
        for row in rows.iter_mut().skip(1) {
            row.extend(base.results.get(&row[0]).map(|v| v.what.clone()));
        }
    }
    let right: Vec<usize> = (2..1 + 2 * shown.len()).collect();
    s.push_str(&table(&rows, &right));
}

/// Results that stand beside each other where combinations stand below each other and nobody asked for others.
const RESULTS: usize = 4;

/// Some results of every combination, one a line, each beside its change to the first combination of its case.
fn one_below_the_other(c: &Comparison, wanted: &[String]) -> String {
    let Some(any) = c.variants.iter().find_map(|v| v.outcome.as_ref().ok()) else { return String::new() };
    let names = shown_results(any, wanted);
    let mut head = vec![String::new()];
    for name in &names {
        let u = unit(&any.results[*name].unit);
        head.extend([if u.is_empty() { (*name).to_owned() } else { format!("{name} [{u}]") }, String::new()]);
    }
    let mut rows = vec![head];
    for (i, v) in c.variants.iter().enumerate() {
        let base = c.variants.iter().find(|b| b.case == v.case).and_then(|b| b.outcome.as_ref().ok());
        let mut row = vec![letter(i)];
        for name in &names {
            row.extend(match (&v.outcome, base) {
                (Ok(r), Some(b)) => [value(r, name), change(b, r, name)],
                (Ok(r), None) => [value(r, name), String::new()],
                (Err(_), _) => ["-".into(), String::new()],
            });
        }
        row.push(v.label.clone());
        rows.push(row);
    }
    let right: Vec<usize> = (1..=2 * names.len()).collect();
    let more = any.results.len().saturating_sub(names.len());
    let of = if more > 0 {
        format!("  {more} more results in the report; `--results` names those to be shown here\n")
    } else {
        String::new()
    };
    format!("\n{}{of}", table(&rows, &right))
}

/// The results that were asked for, or those that lead: of rings and shafts the first.
fn shown_results<'a>(r: &'a RunResult, wanted: &[String]) -> Vec<&'a str> {
    let all = || r.results.keys().map(String::as_str);
    let asked: Vec<&str> = all().filter(|n| wanted.iter().any(|w| w == n)).collect();
    if !asked.is_empty() {
        return asked;
    }
    let leading = r.leading();
    let first = leading.iter().filter_map(|h| r.results.get_key_value(&h.results.first()?.1));
    first.map(|(name, _)| name.as_str()).take(RESULTS).collect()
}

fn value(r: &RunResult, name: &str) -> String {
    r.results.get(name).map_or_else(|| "-".into(), |v| number(v.value))
}

/// How a result differs from that of the base: in per cent, or not beyond what the numerics leave open.
fn change(base: &RunResult, r: &RunResult, name: &str) -> String {
    let (Some(b), Some(v)) = (base.results.get(name), r.results.get(name)) else { return String::new() };
    if (v.value - b.value).abs() < uncertainty(base, name) + uncertainty(r, name) {
        "numerics".into()
    } else if b.value != 0.0 && v.value != b.value {
        format!("{:+.2} %", 100.0 * (v.value / b.value - 1.0))
    } else {
        String::new()
    }
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

    #[test]
    fn a_case_may_carry_changes() {
        let g = given("no such case.toml, engine.speed=1500 rpm,a=[1,2]");
        assert_eq!(g.path, Path::new("no such case.toml"));
        assert_eq!(g.own, ["engine.speed=1500 rpm", "a=[1,2]"]);
        // Not a change: the name of a file.
        assert_eq!(given("a,b.toml").path, Path::new("a,b.toml"));
    }
}
