//! `gudgeon run CASE`

use std::fmt::Write as _;

use gudgeon_core::result::{NoteLevel, RunResult};
use gudgeon_scene::Checked;
use gudgeon_scene::run::{run_on, run_verified_on};

use crate::args::RunArgs;
use crate::cmd::{checked, open_out, trends};
use crate::failure::Failure;
use crate::ui::{Ui, certain, number, table, unit};

pub fn run(a: &RunArgs, ui: &Ui) -> Result<(), Failure> {
    let c = checked(&a.case.case, &a.case.set, ui)?;
    let folder = open_out(a.out.as_deref(), &a.case.case, &c.name, "")?;
    let mut result = {
        let bar = ui.bar();
        let run = if a.verify { run_verified_on } else { run_on };
        run(&c, a.threads, &mut |p| bar.show(p))?
    };
    result.provenance.revision = env!("GUDGEON_REVISION").into();
    let files = gudgeon_report::write_run_in(&result, folder).inspect_err(|_| {
        // What was computed is not lost with the disk.
        ui.out(&if a.json { gudgeon_report::summary_json(&result) } else { told(&c, &result, a.all, ui) });
    })?;
    if a.json {
        ui.out(&gudgeon_report::summary_json(&result));
    } else if !ui.quiet() {
        ui.out(&format!("{}\n{}", told(&c, &result, a.all, ui), files.report.display()));
    } else {
        for n in result.solver.notes.iter().filter(|n| n.level > NoteLevel::Info) {
            ui.note(&n.text);
        }
    }
    let outcome = failure_of(&result);
    // The process ends behind a run: its memory goes at once, not piece by piece.
    std::mem::forget((c, result));
    outcome
}

/// Results that are written and marked as what they are not end a run with the exit code of a failure.
fn failure_of(r: &RunResult) -> Result<(), Failure> {
    let failed: Vec<&str> =
        r.solver.notes.iter().filter(|n| n.level == NoteLevel::Failure).map(|n| n.text.as_str()).collect();
    if failed.is_empty() {
        return Ok(());
    }
    Err(Failure::Run(format!("{} (the results are written and marked)", failed.join("; "))))
}

/// Everything that the terminal shows of a run.
fn told(c: &Checked, r: &RunResult, all: bool, ui: &Ui) -> String {
    let trends = trends::text(c.case.heading().sweeps, r, ui.blocks());
    let shown = if all { results(r, r.results.keys()) } else { headlines(r) };
    let verdict = r.assessment();
    format!(
        "{}: {}\n  {}: {}\n\n{shown}{trends}\n{}",
        r.case,
        r.title,
        verdict.grade.name(),
        verdict.title,
        work(r)
    )
}

/// The results that lead, and how the others are seen.
fn headlines(r: &RunResult) -> String {
    let leading = r.leading();
    let names: Vec<&String> = leading.iter().flat_map(|h| h.results.iter().map(|(_, name)| name)).collect();
    let more = r.results.len() - names.len();
    let shown = results(r, names.into_iter());
    if more == 0 { shown } else { format!("{shown}  and {more} more results: --all, summary.json\n") }
}

/// Some results, one a line.
fn results<'a>(r: &RunResult, names: impl Iterator<Item = &'a String>) -> String {
    let row = |name: &String| {
        let v = r.results.get(name)?;
        let u = r.verification.as_ref().and_then(|w| w.uncertainty.get(name)).copied();
        Some(vec![name.clone(), certain(v.value, u), unit(&v.unit), v.what.clone()])
    };
    table(&names.filter_map(row).collect::<Vec<_>>(), &[1])
}

/// What the run did: balances, work, what was left out, notes, assumptions.
fn work(r: &RunResult) -> String {
    let mut s = String::new();
    let b = &r.balance;
    let all = [
        ("gas mass", b.gas_mass),
        ("gas energy", b.gas_energy),
        ("oil mass", b.oil_mass),
        ("flank oil", b.flank_oil),
        ("skirt oil", b.skirt_oil),
        ("energy", b.energy),
        ("momentum", b.momentum),
    ];
    let balance: Vec<String> =
        all.iter().filter_map(|(name, v)| v.map(|v| format!("{name} {v:.1e}"))).collect();
    if !balance.is_empty() {
        // Writing to a String cannot fail.
        let _ = writeln!(s, "  closure per cycle: {}", balance.join(", "));
    }
    let work: Vec<String> =
        r.solver.counters.iter().map(|(k, n)| format!("{n} {}", k.replace('_', " "))).collect();
    let seconds = r.seconds.get("total").map_or_else(String::new, |t| format!(", {} s", number(*t)));
    let work = if work.is_empty() { String::new() } else { format!(": {}", work.join(", ")) };
    let _ = writeln!(s, "  {}{work}{seconds}", r.solver.method);
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
