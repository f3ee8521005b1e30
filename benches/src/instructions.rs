//! Instructions that a case takes, reading included, counted by valgrind in a process of its own.

use std::path::Path;
use std::process::{Command, Stdio};

use crate::cases::Case;
use crate::measure::{Span, Work};

/// What compiled this program: counts of others are not comparable.
pub const COMPILER: &str = env!("GUDGEON_COMPILER");

/// The argument after which the name of a case follows, to run it and say nothing.
pub const ONE: &str = "--one";

/// Whether there is a valgrind to count with.
#[must_use]
pub fn available() -> bool {
    let found =
        Command::new("valgrind").arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
    found.is_ok_and(|s| s.success())
}

/// Instructions of each case, run by `program` with [`ONE`], by the case's name.
///
/// # Errors
/// A valgrind that cannot be started, a run that fails, an answer without a count.
pub fn instructions(program: &Path, cases: &[Case]) -> Result<Work, String> {
    let of = |case: &Case| {
        let n = count(program, case)?;
        Ok((case.name.clone(), [("million_instructions".to_owned(), Span(n, n))].into()))
    };
    cases.iter().map(of).collect()
}

/// Millions of instructions: the digits behind change from run to run with the seeds of hash maps.
fn count(program: &Path, case: &Case) -> Result<u64, String> {
    let said = |e: &dyn std::fmt::Display| format!("{}: {e}", case.name);
    // Without its caches, cachegrind counts what callgrind counts in half the time.
    let run = Command::new("valgrind")
        .args(["--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null"])
        .arg(program)
        .args([ONE, &case.name])
        .output()
        .map_err(|e| said(&e))?;
    let told = String::from_utf8_lossy(&run.stderr);
    if !run.status.success() {
        return Err(said(&told));
    }
    // `==4711== I   refs:      1,502,620,783`
    let number = |line: &str| line.split_once("refs:")?.1.trim().replace(',', "").parse::<f64>().ok();
    let n = told.lines().find_map(number).ok_or_else(|| said(&"valgrind told no number of instructions"))?;
    Ok((1e-6 * n).round() as u64)
}
