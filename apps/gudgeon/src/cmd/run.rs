//! `gudgeon run CASE`

use std::fmt::Write as _;

use gudgeon_core::result::RunResult;

use crate::args::{RunArgs, out_dir};
use crate::cmd::{check_out, checked};
use crate::failure::Failure;
use crate::ui::{Ui, number, table, unit};

pub fn run(a: &RunArgs, ui: &Ui) -> Result<(), Failure> {
    let c = checked(&a.case, ui)?;
    let dir = out_dir(a.out.as_deref(), &c.name, "");
    check_out(&dir)?;
    let result = {
        let bar = ui.bar();
        gudgeon_sim::run(&c, &mut |p| bar.show(p))?
    };
    let files = gudgeon_report::write_run(&result, &dir)?;
    if a.json {
        ui.out(&gudgeon_report::summary_json(&result));
    } else if !ui.quiet() {
        ui.out(&format!("{}\n{}", text(&result), files.report.display()));
    }
    Ok(())
}

fn text(r: &RunResult) -> String {
    let mut s = format!("{}: {}\n\n", r.case, r.title);
    let rows: Vec<_> = r
        .results
        .iter()
        .map(|(name, v)| vec![name.clone(), number(v.value), unit(&v.unit), v.what.clone()])
        .collect();
    s.push_str(&table(&rows, &[1]));
    // Writing to a String cannot fail.
    let _ = writeln!(s);
    let b = &r.balance;
    let balance: Vec<String> =
        [("gas mass", b.gas_mass), ("oil mass", b.oil_mass), ("energy", b.energy), ("momentum", b.momentum)]
            .iter()
            .filter_map(|(name, v)| v.map(|v| format!("{name} {v:.1e}")))
            .collect();
    if !balance.is_empty() {
        let _ = writeln!(s, "  closure per cycle: {}", balance.join(", "));
    }
    let work: Vec<String> =
        r.solver.counters.iter().map(|(k, n)| format!("{n} {}", k.replace('_', " "))).collect();
    let seconds = r.seconds.get("total").map_or_else(String::new, |t| format!(", {} s", number(*t)));
    let work = if work.is_empty() { String::new() } else { format!(": {}", work.join(", ")) };
    let _ = writeln!(s, "  {}{work}{seconds}", r.solver.method);
    if !r.checks.is_empty() {
        let held = r.checks.iter().filter(|c| c.holds()).count();
        let _ = writeln!(s, "  against sources: {held} of {} as the case says they must be", r.checks.len());
        for c in r.checks.iter().filter(|c| !c.holds()) {
            let at = if c.set.is_empty() { String::new() } else { format!(" ({})", c.set.join(", ")) };
            let _ = writeln!(
                s,
                "    {}{at}: {} instead of {}, deviation {:.1e}, admitted {:.0e}",
                c.result,
                number(c.value),
                number(c.reference),
                c.deviation(),
                c.tolerance
            );
        }
    }
    if !r.skipped.is_empty() {
        let skipped: Vec<&str> = r.skipped.iter().map(|k| k.what.as_str()).collect();
        let _ = writeln!(s, "  skipped (`gudgeon explain` says why): {}", skipped.join(", "));
    }
    for n in &r.solver.notes {
        let _ = writeln!(s, "  note: {}", n.text);
    }
    if !r.assumptions.is_empty() {
        let _ =
            writeln!(s, "  {} inputs of this case are assumed; the report lists them", r.assumptions.len());
    }
    s
}
