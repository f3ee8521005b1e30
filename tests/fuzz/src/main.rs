//! `cargo run -p gudgeon-fuzz --release -- --seed 1 --count 10000`

use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use clap::Parser;
use gudgeon_fuzz::campaign::{self, Plan, Record, job, record, reduce};
use gudgeon_fuzz::child::{Executor, SERVE, serve};
use gudgeon_fuzz::corpus::{Corpus, shipped};
use gudgeon_fuzz::draw::Draw;
use gudgeon_fuzz::tell;

/// Runs random cases over all scenes and models and says what became of them. Ends with 1 when something came out that must not: a panic,
/// a hang, what is not a number, an open balance, an absurd figure, a refusal without a place, two different answers, or more than 1 % of
/// the plausible legal cases neither right nor flagged.
#[derive(Debug, Parser)]
struct Args {
    /// Seed. Seed, index and share of wild cases say all of a case.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Number of cases.
    #[arg(long, default_value_t = 1000)]
    count: u64,
    /// Index of the first one.
    #[arg(long, default_value_t = 0)]
    from: u64,
    /// Cases of this scene only.
    #[arg(long)]
    scene: Option<String>,
    /// Share of wild cases.
    #[arg(long, default_value_t = 0.3)]
    wild: f64,
    /// Begin no case after this many seconds.
    #[arg(long, default_value_t = f64::INFINITY)]
    seconds: f64,
    /// Cases at a time.
    #[arg(long, default_value_t = 2)]
    jobs: usize,
    /// Write `fuzz.jsonl` (every case, as it ends), `fuzz.json` and `fuzz.txt` here.
    #[arg(long)]
    out: Option<PathBuf>,
    /// Run one case, reduce it if it is bad, and say everything about it.
    #[arg(long, value_name = "INDEX")]
    one: Option<u64>,
    /// Folder of the cases that changes start from.
    #[arg(long)]
    cases: Option<PathBuf>,
}

fn main() -> ExitCode {
    let mut given = std::env::args_os().skip(1);
    if given.next().is_some_and(|a| a == SERVE) {
        let folder = given.next().map_or_else(shipped, PathBuf::from);
        return if serve(&folder).is_ok() { ExitCode::SUCCESS } else { ExitCode::FAILURE };
    }
    match fuzz(&Args::parse()) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(e) => {
            say(&e);
            ExitCode::from(2)
        }
    }
}

/// A line on the terminal. One that is gone is no reason to stop.
fn say(text: &str) {
    let _ = writeln!(std::io::stdout(), "{text}");
}

fn fuzz(a: &Args) -> Result<bool, String> {
    let corpus = Corpus::read(&a.cases.clone().unwrap_or_else(shipped))?;
    let draw = Draw::new(&corpus, a.seed, a.wild);
    let program = std::env::current_exe().map_err(|e| e.to_string())?;
    if let Some(index) = a.one {
        return one(&draw, index, Executor::new(program, corpus.folder.clone()));
    }
    let plan = Plan {
        seed: a.seed,
        indices: indices(a, &draw)?,
        wild: a.wild,
        seconds: a.seconds,
        jobs: a.jobs,
        program,
    };
    let all = plan.indices.len();
    let lines = a.out.as_deref().map(stream).transpose()?.map(Mutex::new);
    let records = campaign::run(&plan, &corpus, &|n, r| {
        if let Some(file) = &lines {
            keep(&mut file.lock().unwrap_or_else(PoisonError::into_inner), r);
        }
        if r.class.bad() {
            say(&format!("{n}/{all} {} {}: {}", r.class.name(), r.case.scene, r.defect));
        } else if n % 100 == 0 {
            say(&format!("{n}/{all}"));
        }
    })?;
    let text = tell::text(&records);
    say(&text);
    if records.len() < all {
        say(&format!("{} of {all} cases in the time given", records.len()));
    }
    if let Some(folder) = &a.out {
        write(folder, &text, &tell::json(a.seed, &records))
            .map_err(|e| format!("{}: {e}", folder.display()))?;
    }
    Ok(tell::stood(&records))
}

fn indices(a: &Args, draw: &Draw<'_>) -> Result<Vec<u64>, String> {
    let Some(scene) = &a.scene else { return Ok((a.from..a.from.saturating_add(a.count)).collect()) };
    if !draw.scenes().contains(&scene.as_str()) {
        return Err(format!("no scene `{scene}`; there are {}", draw.scenes().join(", ")));
    }
    Ok(draw.of_scene(scene, a.from).take(a.count as usize).collect())
}

fn one(draw: &Draw<'_>, index: u64, mut executor: Executor) -> Result<bool, String> {
    /// A single case may take long.
    const LIMIT: Duration = Duration::from_secs(300);
    let case = draw.case(index)?;
    say(&case.command());
    let outcome = executor.run(&job(&case), LIMIT).map_err(|e| e.to_string())?;
    let mut r = record(case, &outcome);
    if r.class.bad() {
        reduce(&mut r, &mut executor, LIMIT).map_err(|e| e.to_string())?;
        say(&format!("reduced: {}", r.command));
    }
    say(&format!("{}, {:.2} s: {}", r.class.name(), r.seconds, r.detail));
    Ok(!r.class.forbidden())
}

/// The file that keeps every case as soon as it has ended: a campaign that is stopped loses nothing.
fn stream(folder: &Path) -> Result<File, String> {
    let told = |e: std::io::Error| format!("{}: {e}", folder.display());
    std::fs::create_dir_all(folder).map_err(told)?;
    File::create(folder.join("fuzz.jsonl")).map_err(told)
}

/// Appends a case. What cannot be written is in the summary at the end.
fn keep(file: &mut File, r: &Record) {
    if let Ok(line) = serde_json::to_string(r) {
        let _ = writeln!(file, "{line}");
    }
}

fn write(folder: &Path, text: &str, json: &serde_json::Value) -> std::io::Result<()> {
    std::fs::write(folder.join("fuzz.txt"), text)?;
    std::fs::write(folder.join("fuzz.json"), serde_json::to_vec_pretty(json)?)
}
