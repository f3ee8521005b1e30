//! `gudgeon compare CASE… --swap PATH=A,B,C`

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use gudgeon_core::quantity::with_decimal_point;
use gudgeon_core::result::{
    Comparison, Confidence, Difference, Note, NoteLevel, RunResult, VERDICT, Variant,
};
use gudgeon_study::{Plan, Subject};
use indexmap::IndexMap;

use crate::args::CompareArgs;
use crate::cmd::{checked, open_out, shares};
use crate::failure::Failure;
use crate::ui::{Ui, number, signed, table, unit, wrapped};

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
    bases(&mut s, c);
    if c.cases.len() == 1 && c.variants.len() <= COLUMNS {
        side_by_side(&mut s, c, wanted);
    } else {
        s.push_str(&one_below_the_other(c, wanted));
    }
    s.push_str(&legend(c));
    s.push_str(&c.shares.first().map_or_else(String::new, shares::text));
    s
}

fn letter(i: usize) -> String {
    format!("({})", i + 1)
}

/// Every combination, then what the runs say: the same words once. Writing to a String cannot fail.
fn listed(s: &mut String, c: &Comparison) {
    let ran = c.variants.iter().filter(|v| v.outcome.is_ok()).count();
    let mut topics: IndexMap<&str, Vec<(usize, &Note)>> = IndexMap::new();
    for (i, v) in c.variants.iter().enumerate() {
        let why = v.why().map_or_else(String::new, |why| format!("  {why}"));
        let _ = writeln!(s, "  {} {}{why}", letter(i), v.label);
        for n in v.outcome.iter().flat_map(|r| &r.solver.notes) {
            topics.entry(&n.topic).or_default().push((i, n));
        }
    }
    let mut said: Vec<Said<'_>> = topics.into_values().flat_map(said).collect();
    said.sort_by_key(|n| n.note.numerical);
    for n in said {
        let letters: Vec<String> = n.of.iter().map(|i| letter(*i)).collect();
        let who = match n.of.len() {
            k if k > 1 && k == ran => "all".to_owned(),
            _ => letters.join(" "),
        };
        let figures = if n.alike { String::new() } else { format!(", with the figures of {}", letters[0]) };
        let _ = writeln!(s, "  note of {who}{figures}: {}", n.note.text);
    }
}

/// What runs say of one subject.
struct Said<'a> {
    note: &'a Note,
    of: Vec<usize>,
    /// Whether all of them say it with the same figures.
    alike: bool,
}

/// The notes of one topic: what decides about a variant, a limit or a verdict, apart for all that say something else; anything else once, with the figures of
/// the first.
fn said<'a>(notes: Vec<(usize, &'a Note)>) -> Vec<Said<'a>> {
    let decides = |n: &Note| n.topic == VERDICT || n.level >= NoteLevel::Exceeded;
    let apart = notes.iter().any(|(_, n)| decides(n));
    let mut all: Vec<Said<'a>> = Vec::new();
    for (i, note) in notes {
        match all.iter_mut().find(|s| !apart || s.note.text == note.text) {
            Some(s) => {
                s.alike &= s.note.text == note.text;
                if s.of.last() != Some(&i) {
                    s.of.push(i);
                }
            }
            None => all.push(Said { note, of: vec![i], alike: true }),
        }
    }
    all
}

/// Which combinations the others are compared with, where it is not the first. Writing to a String cannot fail.
fn bases(s: &mut String, c: &Comparison) {
    for case in 0..c.cases.len() {
        let first = c.variants.iter().position(|v| v.case == case);
        if let (Some(first), Some(base)) = (first, c.base(case))
            && first != base
        {
            let _ = writeln!(
                s,
                "  differences are to {}, the first that ran: {} has no result",
                letter(base),
                letter(first)
            );
        }
    }
}

/// What stands beside differences; nothing without any.
fn legend(c: &Comparison) -> String {
    let compared = |(k, v): (usize, &Variant)| v.outcome.is_ok() && c.base(v.case) != Some(k);
    let text = match any_known(c) {
        _ if !c.variants.iter().enumerate().any(compared) => return String::new(),
        true => {
            "± the numerical uncertainties of both runs added, a bound; ≈ not resolved: the difference is not larger; ? not known"
        }
        false if c.is_verified() => {
            "no uncertainty of the differences is known: `--verify` found no numerical setting that tells it"
        }
        false => "no uncertainty of the differences is known: run with `--verify`",
    };
    wrapped(text, 2)
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
        for (i, r) in &shown[1..] {
            row.extend([value(r, name), change(c, *i, name)]);
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

/// Some results of every combination, one a line, each beside its change to the base of its case.
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
        let mut row = vec![letter(i)];
        for name in &names {
            row.extend(match &v.outcome {
                Ok(r) => [value(r, name), change(c, i, name)],
                Err(_) => ["-".into(), String::new()],
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

/// How a result differs from that of the base: in per cent, where that says something; marked where the numerical errors alone can make it. Nothing where it
/// does not differ, or from a zero without uncertainty: the value says it.
fn change(c: &Comparison, variant: usize, name: &str) -> String {
    let of = |k: usize| c.variants[k].outcome.as_ref().ok()?.results.get(name);
    let (Some(d), Some(v)) = (c.difference(variant, name), of(variant)) else { return String::new() };
    let from_zero = || c.base(c.variants[variant].case).and_then(of).is_some_and(|b| b.value == 0.0);
    if d.absolute == 0.0 || d.uncertainty.is_none() && from_zero() {
        return String::new();
    }
    told(&d, &v.unit, any_known(c))
}

/// Whether the uncertainty of any result is known.
fn any_known(c: &Comparison) -> bool {
    let mut found = c.variants.iter().flat_map(|v| &v.outcome).flat_map(|r| &r.verification);
    found.any(|v| !v.uncertainty.is_empty())
}

/// `some`: whether the uncertainty of any result is known.
fn told(d: &Difference, u: &str, some: bool) -> String {
    let text = match d.percent {
        Some(p) => signed(p, "%", d.percent_uncertainty),
        None => signed(d.absolute, &unit(u), d.uncertainty),
    };
    match d.confidence() {
        Confidence::NotResolved => format!("≈ {text}"),
        Confidence::Unknown if some => format!("{text} ?"),
        _ => text,
    }
}

#[cfg(test)]
mod tests {
    use gudgeon_core::result::{ComparedCase, Failure, Value, Verification};

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

    fn variant(notes: Vec<Note>, results: &[(&str, f64, &str, Option<f64>)]) -> Variant {
        let mut run = RunResult::default();
        let mut verification = Verification::default();
        for (name, value, unit, uncertainty) in results {
            let v = Value { value: *value, unit: (*unit).into(), what: String::new() };
            run.results.insert((*name).into(), v);
            verification.uncertainty.extend(uncertainty.map(|u| ((*name).to_owned(), u)));
        }
        run.verification = (!verification.uncertainty.is_empty()).then_some(verification);
        run.solver.notes = notes;
        Variant { label: "x".into(), case: 0, swaps: Vec::new(), outcome: Ok(run) }
    }

    fn comparison(variants: Vec<Variant>) -> Comparison {
        Comparison { cases: vec![ComparedCase::default()], variants, ..Comparison::default() }
    }

    #[test]
    fn differences_carry_their_confidence() {
        let base =
            [("q", 10.0, "l/min", Some(0.01)), ("at", 719.0, "deg", Some(0.25)), ("none", 0.0, "1", None)];
        let other =
            [("q", 10.32, "l/min", Some(0.001)), ("at", 1.0, "deg", Some(0.25)), ("none", 3.0, "1", None)];
        let c = comparison(vec![variant(Vec::new(), &base), variant(Vec::new(), &other)]);
        // 100 (0.001 + 0.01 · 1.032)/(10 - 0.01) = 0.11 %.
        assert_eq!(change(&c, 1, "q"), "+3.2 % ± 0.1");
        assert_eq!(change(&c, 1, "at"), "+2.0 deg ± 0.5");
        assert_eq!(change(&c, 1, "none"), "");
        assert_eq!(change(&c, 0, "q"), "");
        let near = [("q", 10.01, "l/min", Some(0.01))];
        let c = comparison(vec![variant(Vec::new(), &base), variant(Vec::new(), &near)]);
        assert_eq!(change(&c, 1, "q"), "≈ +0.1 % ± 0.2");
        assert!(legend(&c).contains("not resolved"));
        let unknown = [("q", 10.32, "l/min", None), ("at", 1.0, "deg", None)];
        let c = comparison(vec![variant(Vec::new(), &unknown[..1]), variant(Vec::new(), &near)]);
        assert_eq!(change(&c, 1, "q"), "-3.00 % ?");
        let c = comparison(vec![variant(Vec::new(), &unknown), variant(Vec::new(), &unknown)]);
        assert!(change(&c, 1, "q").is_empty() && legend(&c).contains("--verify"));
    }

    #[test]
    fn the_first_that_ran_is_the_base() {
        let one = |q: f64| variant(Vec::new(), &[("q", q, "N", None)]);
        let mut none = one(0.0);
        none.outcome = Err(Failure {
            code: "impossible".into(),
            message: "the gap closes".into(),
            ..Failure::default()
        });
        let c = comparison(vec![none.clone(), one(2.0), one(3.0)]);
        let text = text(&c, &[]);
        assert!(text.contains("differences are to (2), the first that ran: (1) has no result"), "{text}");
        assert!(text.contains("to (2)") && text.contains("+50.00 %"), "{text}");
        let several = Comparison { variants: vec![none, one(2.0), one(3.0), one(4.0), one(5.0)], ..c };
        let text = super::text(&several, &["q".to_owned()]);
        assert!(text.contains("+150.00 %"), "{text}");
    }

    #[test]
    fn each_variant_has_its_own_verdict() {
        let notes = |kept: &str, share: &str| vec![Note::info(VERDICT, kept), Note::caution("floor", share)];
        let c = comparison(vec![
            variant(notes("all limits are kept", "3 %"), &[]),
            variant(notes("2 limits are not kept", "4 %"), &[]),
            variant(notes("all limits are kept", "5 %"), &[]),
        ]);
        let mut s = String::new();
        listed(&mut s, &c);
        assert!(s.contains("note of (1) (3): all limits are kept"), "{s}");
        assert!(s.contains("note of (2): 2 limits are not kept"), "{s}");
        assert!(s.contains("note of all, with the figures of (1): 3 %"), "{s}");
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
