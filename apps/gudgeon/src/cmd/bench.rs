//! `gudgeon bench CASE`

use std::fmt::Write as _;

use gudgeon_core::result::BenchTable;

use crate::args::BenchArgs;
use crate::cmd::{checked, open_out};
use crate::failure::Failure;
use crate::ui::{Ui, number, table};

pub fn bench(a: &BenchArgs, ui: &Ui) -> Result<(), Failure> {
    let c = checked(&a.case.case, &a.case.set, ui)?;
    let folder = open_out(a.out.as_deref(), &a.case.case, &c.name, "-bench")?;
    let measured = {
        let bar = ui.bar();
        gudgeon_study::bench(&c, &a.results, &mut |p| bar.show(p))?
    };
    let files = gudgeon_report::write_bench_in(&measured, folder)?;
    if !ui.quiet() {
        ui.out(&format!("{}\n{}", text(&measured), files.report.display()));
    }
    Ok(())
}

fn text(b: &BenchTable) -> String {
    let mut s = format!("{}: {}\n\n", b.case, b.title);
    // Writing to a String cannot fail.
    let _ = writeln!(s, "  reference: {}", b.reference);
    let values: Vec<String> =
        b.reference_values.iter().map(|(n, v)| format!("{n} {} {}", number(v.value), v.unit)).collect();
    let _ = writeln!(s, "  {}\n", values.join(", "));
    let names: Vec<&String> = b.reference_values.keys().collect();
    let mut rows = vec![vec!["method".into(), "setting".into(), "ms per cycle".into(), "cycles".into()]];
    rows[0].extend(names.iter().map(|n| format!("error of {n}")));
    for p in &b.points {
        let default = if p.is_default { " (default)" } else { "" };
        let mut row = vec![p.method.clone(), format!("{}{default}", p.setting)];
        if let Some(why) = &p.failure {
            row.push(why.lines().next().unwrap_or_default().to_owned());
        } else {
            row.push(number(1e3 * p.seconds_per_cycle));
            row.push(number(p.cycles));
            row.extend(names.iter().map(|n| p.errors.get(*n).map_or("-".into(), |e| format!("{e:.1e}"))));
        }
        rows.push(row);
    }
    let right: Vec<usize> = (2..4 + names.len()).collect();
    s.push_str(&table(&rows, &right));
    for f in &b.findings {
        let _ = writeln!(s, "\n  {f}");
    }
    s
}
