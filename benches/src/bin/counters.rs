//! `cargo run -p gudgeon-benches --bin counters`
#![allow(clippy::print_stdout, clippy::print_stderr)]

use std::collections::BTreeMap;
use std::process::ExitCode;

use clap::Parser;
use gudgeon_benches::baseline::{Baseline, Change, INSTRUCTION_SHARE, SHARE, changes};
use gudgeon_benches::cases::{Case, counted, instructed, root};
use gudgeon_benches::instructions::{COMPILER, available, instructions};
use gudgeon_benches::measure::{Work, counts, work};
use gudgeon_benches::{history, stress};

/// Runs the cases of `benches/src/cases.rs` and compares what their solvers counted with `benches/counters.toml`. Ends with 1 when a count
/// has left the span that stands there by more than 1 %, either way: what grew is mended or explained, what fell is kept. `--accept` does
/// both.
#[derive(Debug, Parser)]
#[command(name = "counters")]
struct Args {
    /// Measure the spans anew and write them, for this reason, which `benches/counters-history.md` keeps with all that changed.
    #[arg(long, value_name = "REASON", value_parser = clap::builder::NonEmptyStringValueParser::new())]
    accept: Option<String>,
    /// Count instructions by valgrind instead. They are compared where the compiler is that of the baseline.
    #[arg(long)]
    instructions: bool,
    /// Print how the work of a ring pack depends on speed, contact stiffness and mass of the rings; nothing is compared.
    #[arg(long, conflicts_with_all = ["accept", "instructions"])]
    stress: bool,
    /// Of the cases, only these many, the shortest first: with `--instructions`.
    #[arg(long, requires = "instructions", conflicts_with = "accept")]
    first: Option<usize>,
    /// Cases at a time.
    #[arg(long, default_value_t = std::thread::available_parallelism().map_or(1, usize::from))]
    threads: usize,
    /// Run one case and say nothing: what valgrind is given.
    #[arg(long, hide = true)]
    one: Option<String>,
}

/// Exit code where nothing could be compared, as `.ci/run` has it.
const NOT_COMPARED: u8 = 77;

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(code) => code,
        Err(e) => {
            eprintln!("{e}");
            ExitCode::FAILURE
        }
    }
}

fn run(a: &Args) -> Result<ExitCode, String> {
    if let Some(name) = &a.one {
        let case = instructed().into_iter().find(|c| c.name == *name);
        return counts(&case.ok_or_else(|| format!("there is no case {name}"))?).map(|_| ExitCode::SUCCESS);
    }
    if a.stress {
        print!("{}", stress::table(a.threads)?);
        return Ok(ExitCode::SUCCESS);
    }
    let file = root().join("benches/counters.toml");
    // The first reason makes the file.
    let mut baseline = match (&a.accept, file.is_file()) {
        (Some(_), false) => Baseline::default(),
        _ => Baseline::read(&file)?,
    };
    let Some(is) = measured(a, &baseline)? else { return Ok(ExitCode::from(NOT_COMPARED)) };
    let (was, share) = if a.instructions {
        (&mut baseline.instructions, INSTRUCTION_SHARE)
    } else {
        (&mut baseline.counters, SHARE)
    };
    if a.first.is_some() {
        was.retain(|case, _| is.contains_key(case));
    }
    let changed = changes(was, &is);
    let Some(reason) = &a.accept else { return judge(a, &is, &changed, share).map(|()| ExitCode::SUCCESS) };
    if changed.is_empty() && (!a.instructions || baseline.compiler == COMPILER) {
        println!("every count is within its span: there is nothing to accept");
        return Ok(ExitCode::SUCCESS);
    }
    *was = is;
    if a.instructions {
        baseline.compiler = COMPILER.into();
    }
    baseline.write(&file)?;
    history::add(&root().join("benches/counters-history.md"), reason, &changed)?;
    Ok(ExitCode::SUCCESS)
}

/// What is to be compared; none where it cannot be, which is told.
fn measured(a: &Args, baseline: &Baseline) -> Result<Option<Work>, String> {
    if !a.instructions {
        let mut cases = counted();
        if a.accept.is_some() {
            cases = cases.iter().map(Case::neighbours).collect::<Result<Vec<_>, _>>()?.concat();
        }
        return work(&cases, a.threads).map(Some).map_err(|e| e.join("\n"));
    }
    if !available() {
        println!("there is no valgrind: instructions are not counted");
        return Ok(None);
    }
    if a.accept.is_none() && baseline.compiler != COMPILER {
        println!("instructions are those of {}, this is {COMPILER}: not compared", baseline.compiler);
        return Ok(None);
    }
    let program = std::env::current_exe().map_err(|e| e.to_string())?;
    let mut cases = instructed();
    cases.truncate(a.first.unwrap_or(usize::MAX));
    instructions(&program, &cases).map(Some)
}

/// Tells what changed.
///
/// # Errors
/// What changed by more than `share`.
fn judge(a: &Args, is: &Work, changed: &[Change], share: f64) -> Result<(), String> {
    let (beyond, within): (Vec<&Change>, Vec<&Change>) =
        changed.iter().partition(|c| c.share().abs() > share);
    for c in within {
        println!("{c}");
    }
    let percent = 100.0 * share;
    if beyond.is_empty() {
        let counts: usize = is.values().map(BTreeMap::len).sum();
        println!("{counts} counts of {} cases are within {percent} % of what was accepted", is.len());
        return Ok(());
    }
    let lines: Vec<String> = beyond.iter().map(ToString::to_string).collect();
    let instructions = if a.instructions { " --instructions" } else { "" };
    Err(format!(
        "{}\n\n\
         These counts are not within {percent} % of what was accepted (benches/counters.toml). Work that grew is mended or explained, and work \
         that fell is kept:\n\n\
         \x20   cargo run -p gudgeon-benches --profile test --bin counters --{instructions} --accept \"REASON\"\n\n\
         writes the counts anew and the reason into benches/counters-history.md.",
        lines.join("\n"),
    ))
}
