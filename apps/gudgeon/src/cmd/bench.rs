//! `gudgeon bench CASE...`

use std::fmt::Write as _;
use std::path::Path;

use gudgeon_core::result::{BenchPoint, BenchTable};
use gudgeon_report::Folder;
use gudgeon_scene::Checked;

use crate::args::BenchArgs;
use crate::cmd::compare::values;
use crate::cmd::{checked, open_out};
use crate::failure::Failure;
use crate::ui::{Ui, number, table};

pub fn bench(a: &BenchArgs, ui: &Ui) -> Result<(), Failure> {
    let contenders = a.contender.iter().map(|s| values("--contender", s)).collect::<Result<Vec<_>, _>>()?;
    // What is wrong with the last case is told before the first one takes its time.
    let cases = a.cases.iter().map(|case| ready(a, case, ui)).collect::<Result<Vec<_>, _>>()?;
    let mut raced = Vec::new();
    for (case, folder) in cases {
        let measured = {
            let bar = ui.bar();
            gudgeon_study::bench(&case, &a.results, &contenders, &mut |p| bar.show(p))?
        };
        let files = gudgeon_report::write_bench_in(&measured, folder)?;
        if !ui.quiet() {
            ui.out(&format!("{}\n{}", text(&measured), files.report.display()));
        }
        raced.push(measured);
    }
    if raced.len() > 1 && !ui.quiet() {
        ui.out(&format!("\n{}", summary(&raced)));
    }
    Ok(())
}

/// A case that was checked, and the folder of its results.
fn ready(a: &BenchArgs, case: &Path, ui: &Ui) -> Result<(Checked, Folder), Failure> {
    let c = checked(case, &a.set, ui)?;
    let out = a.out.as_ref().map(|dir| if a.cases.len() > 1 { dir.join(&c.name) } else { dir.clone() });
    let folder = open_out(out.as_deref(), case, &c.name, "-bench")?;
    Ok((c, folder))
}

/// Work counters that are shown; all of them are in the report.
const COUNTERS: usize = 4;

/// The counters that tell settings apart, the first few of them.
fn counters(b: &BenchTable) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    for p in &b.points {
        names.extend(
            p.work
                .keys()
                .map(String::as_str)
                .filter(|n| *n != "cycles" && !names.contains(n))
                .collect::<Vec<_>>(),
        );
    }
    let varies = |n: &&str| {
        let mut all = b.points.iter().filter_map(|p| p.work.get(*n));
        let first = all.next();
        all.any(|v| Some(v) != first)
    };
    names.into_iter().filter(varies).take(COUNTERS).collect()
}

fn error(e: f64) -> String {
    if e.is_finite() { format!("{e:.1e}") } else { "-".into() }
}

fn text(b: &BenchTable) -> String {
    let mut s = format!("{}: {}\n\n", b.case, b.title);
    // Writing to a String cannot fail.
    let _ = writeln!(s, "  reference: {}", b.reference);
    let values: Vec<String> =
        b.reference_values.iter().map(|(n, v)| format!("{n} {} {}", number(v.value), v.unit)).collect();
    let _ = writeln!(s, "  {}\n", values.join(", "));
    let names: Vec<&String> = b.reference_values.keys().collect();
    let counters = counters(b);
    let cyclic = b.points.iter().any(|p| p.cycles > 1.0);
    let mut head = vec!["method".to_owned(), "setting".into()];
    head.extend(if cyclic { vec!["ms per cycle".to_owned(), "cycles".into()] } else { vec!["ms".into()] });
    head.extend(counters.iter().map(|n| n.replace('_', " ")));
    head.extend(names.iter().map(|n| format!("error of {n}")));
    head.push("achieved/asked".into());
    let columns = head.len();
    let mut rows = vec![head];
    for p in &b.points {
        let default = if p.is_default { " (default)" } else { "" };
        let mut row = vec![p.method.clone(), format!("{}{default}", p.setting)];
        if let Some(why) = &p.failure {
            row.push(why.lines().next().unwrap_or_default().to_owned());
        } else {
            row.push(number(1e3 * p.seconds_per_cycle));
            row.extend(cyclic.then(|| number(p.cycles)));
            row.extend(counters.iter().map(|n| p.work.get(*n).map_or("-".into(), u64::to_string)));
            row.extend(names.iter().map(|n| p.errors.get(*n).map_or("-".into(), |e| error(*e))));
            row.push(over_asked(p.over_asked()));
        }
        rows.push(row);
    }
    let right: Vec<usize> = (2..columns).collect();
    s.push_str(&table(&rows, &right));
    for f in &b.findings {
        let _ = writeln!(s, "\n  {f}");
    }
    s
}

fn over_asked(ratio: Option<f64>) -> String {
    ratio.map_or_else(|| "-".into(), |r| format!("{r:.2}"))
}

/// One line a case: what it does as it stands.
fn summary(all: &[BenchTable]) -> String {
    let head = ["case", "setting", "worst error", "of", "1e-3", "achieved/asked", "ms", "reference"];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    for b in all {
        let worst = b.default_point().and_then(BenchPoint::worst);
        let ms = b.default_point().filter(|p| p.failure.is_none()).map(|p| number(1e3 * p.seconds_total));
        rows.push(vec![
            b.case.clone(),
            b.default_point().map_or_else(|| "-".into(), |p| format!("{}, {}", p.method, p.setting)),
            worst.map_or_else(|| "-".into(), |(_, e)| error(e)),
            worst.map_or_else(|| "-".into(), |(name, _)| name.to_owned()),
            if b.default_is_enough() { "reached" } else { "missed" }.into(),
            over_asked(b.default_over_asked()),
            ms.unwrap_or_else(|| "-".into()),
            if b.independent { "a second method" } else { "the same, refined" }.into(),
        ]);
    }
    table(&rows, &[2, 5, 6])
}
