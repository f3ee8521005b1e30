//! The commands that the guide shows: run in the order of their page, in a folder that is empty at first, their outputs compared.
//!
//! A page says what to do in fenced blocks. `toml file=engine.toml` (or any language) is a file that the reader writes. `sh` is commands, each
//! beginning with `gudgeon`, or with `my-gudgeon` for the program with the reader's own models; a backslash ends a line that goes on. A block
//! `output` behind it is what they print; a line `…` stands for any lines, and `…` in a line for the rest of it. `sh exit=1` fails
//! with that code. `<!-- in the repository -->` gives a page the folder `cases` of the repository.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::markdown::{Block, blocks};
use crate::{Outcome, files, read, relative, root, source, write};

/// The programs that commands of the guide stand for.
#[derive(Debug, Clone)]
pub struct Programs {
    /// `gudgeon`: this program with the word `gudgeon` before its arguments.
    pub gudgeon: PathBuf,
    /// `my-gudgeon`.
    pub extended: PathBuf,
}

/// What marks a page whose commands need the cases of the repository.
const IN_REPOSITORY: &str = "<!-- in the repository -->";

/// Pages with commands.
///
/// # Errors
/// A page that cannot be read.
pub fn pages() -> Outcome<Vec<PathBuf>> {
    let mut out = Vec::new();
    for file in files(&source(), ".md")? {
        if blocks(&read(&file)?).iter().any(|b| b.language == "sh") {
            out.push(file);
        }
    }
    Ok(out)
}

/// What went wrong, and how many commands ran.
#[derive(Debug, Default)]
pub struct Ran {
    /// Commands.
    pub commands: usize,
    /// Outputs that were compared.
    pub outputs: usize,
    /// Seconds and name of each page.
    pub seconds: Vec<(f64, String)>,
    /// What differs.
    pub wrong: Vec<String>,
}

/// Runs pages on two threads, each page in a folder of its own below `folder`.
///
/// # Errors
/// A folder or a page that cannot be read.
pub fn run(pages: &[PathBuf], programs: &Programs, folder: &Path) -> Outcome<Ran> {
    let next = AtomicUsize::new(0);
    let all = Mutex::new((Ran::default(), Vec::new()));
    std::thread::scope(|s| {
        for _ in 0..2 {
            s.spawn(|| {
                while let Some(file) = pages.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let begun = std::time::Instant::now();
                    let told = page(file, programs, folder);
                    let mut all = all.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
                    match told {
                        Ok(ran) => {
                            all.0.commands += ran.commands;
                            all.0.outputs += ran.outputs;
                            all.0.wrong.extend(ran.wrong);
                        }
                        Err(e) => all.1.push(e),
                    }
                    let name = relative(&source(), file);
                    all.0.seconds.push((begun.elapsed().as_secs_f64(), name));
                }
            });
        }
    });
    let (ran, errors) = all.into_inner().unwrap_or_default();
    if errors.is_empty() { Ok(ran) } else { Err(errors.join("\n")) }
}

fn page(file: &Path, programs: &Programs, folder: &Path) -> Outcome<Ran> {
    let text = read(file)?;
    let name = relative(&source(), file);
    let here = folder.join(name.trim_end_matches(".md").replace('/', "-"));
    let _ = std::fs::remove_dir_all(&here);
    std::fs::create_dir_all(&here).map_err(|e| e.to_string())?;
    if text.contains(IN_REPOSITORY) {
        copy(&root().join("cases"), &here.join("cases"))?;
    }
    let mut ran = Ran::default();
    let mut printed: Option<String> = None;
    for block in blocks(&text) {
        let place = format!("{name}:{}", block.line);
        if let Some(to) = block.word("file") {
            write(&here.join(to), &block.text)?;
        } else if block.language == "sh" {
            printed = Some(shell(&block, &place, programs, &here, &mut ran)?);
        } else if block.language == "output" {
            let stands = printed.take().ok_or_else(|| format!("{place}: no command before this output"))?;
            ran.outputs += 1;
            ran.wrong.extend(
                differs(&block.text, &stands).map(|d| format!("{place}: {d}\n--- printed\n{stands}")),
            );
        }
    }
    Ok(ran)
}

fn copy(from: &Path, to: &Path) -> Outcome<()> {
    for file in files(from, "")? {
        write(&to.join(relative(from, &file)), &read(&file)?)?;
    }
    Ok(())
}

/// Runs the commands of a block; what they print.
fn shell(block: &Block, place: &str, programs: &Programs, here: &Path, ran: &mut Ran) -> Outcome<String> {
    let expected =
        block.word("exit").map_or(Ok(0), str::parse::<i32>).map_err(|e| format!("{place}: {e}"))?;
    let mut printed = String::new();
    for line in block.text.replace("\\\n", " ").lines().filter(|l| !l.trim().is_empty()) {
        let words = words(line).ok_or_else(|| format!("{place}: a quote is left open"))?;
        let mut command = match words[0].as_str() {
            "gudgeon" => {
                let mut c = Command::new(&programs.gudgeon);
                c.arg("gudgeon");
                c
            }
            "my-gudgeon" => Command::new(&programs.extended),
            other => {
                return Err(format!("{place}: commands begin with gudgeon or my-gudgeon, not with {other}"));
            }
        };
        let told = command.args(&words[1..]).current_dir(here).env("NO_COLOR", "1").output();
        let told = told.map_err(|e| format!("{place}: {e}"))?;
        ran.commands += 1;
        let text = |b: &[u8]| String::from_utf8_lossy(b).into_owned();
        if told.status.code() != Some(expected) {
            ran.wrong.push(format!(
                "{place}: {line}\nended with {:?}\n{}{}",
                told.status.code(),
                text(&told.stdout),
                text(&told.stderr)
            ));
        }
        printed += &text(&told.stdout);
        if expected != 0 {
            printed += &text(&told.stderr);
        }
    }
    Ok(printed)
}

/// The words of a command line: blanks part them, quotes keep them together.
#[must_use]
pub fn words(line: &str) -> Option<Vec<String>> {
    let (mut out, mut word, mut quote, mut any) = (Vec::new(), String::new(), None, false);
    for c in line.chars() {
        match (quote, c) {
            (Some(q), c) if c == q => quote = None,
            (Some(_), c) => word.push(c),
            (None, '"' | '\'') => {
                quote = Some(c);
                any = true;
            }
            (None, c) if c.is_whitespace() => {
                if any || !word.is_empty() {
                    out.push(std::mem::take(&mut word));
                    any = false;
                }
            }
            (None, c) => word.push(c),
        }
    }
    if any || !word.is_empty() {
        out.push(word);
    }
    quote.is_none().then_some(out)
}

/// Where what is printed is not what the page says.
#[must_use]
pub fn differs(says: &str, printed: &str) -> Option<String> {
    let says: Vec<&str> = says.lines().map(str::trim_end).filter(|l| !l.is_empty()).collect();
    let printed: Vec<&str> = printed.lines().map(str::trim_end).filter(|l| !l.is_empty()).collect();
    let mut at = 0;
    let mut skip = false;
    for line in says {
        if line.trim() == "…" {
            skip = true;
            continue;
        }
        let found = printed[at..].iter().position(|p| alike(line, p));
        match found {
            Some(n) if skip || n == 0 => at += n + 1,
            _ => {
                let instead = printed.get(at).map_or("nothing", |l| l);
                return Some(format!("the page says\n{line}\nand the program prints\n{instead}"));
            }
        }
        skip = false;
    }
    let rest = printed.get(at).filter(|_| !skip);
    rest.map(|l| format!("the page ends, and the program goes on with\n{l}"))
}

/// Whether two lines say the same. Numbers may differ by 1 %: the tolerance of a run leaves up to 0.1 % of most results, and those that hang on
/// the instant of an event (a ring that lifts, a film that ruptures) ten times as much; a number that a change of the numerics
/// moves further is a change for the reader as well.
fn alike(says: &str, printed: &str) -> bool {
    let (says, cut) = match says.split_once('…') {
        Some((before, _)) => (before, true),
        None => (says, false),
    };
    let (a, b): (Vec<&str>, Vec<&str>) =
        (says.split_whitespace().collect(), printed.split_whitespace().collect());
    let enough = if cut { b.len() >= a.len() } else { b.len() == a.len() };
    enough && a.iter().zip(&b).enumerate().all(|(n, (x, y))| x == y || near(x, y, a.get(n + 1) == Some(&"%")))
}

/// Two numbers that are near, with the same signs around them; zero is near what rounds to it. Of two results that may each differ by 1 %, the
/// change in per cent may differ by 2.
fn near(x: &str, y: &str, per_cent: bool) -> bool {
    let bare = |t: &str| t.trim_matches(|c: char| "()[],;:%~|".contains(c)).parse::<f64>();
    match (bare(x), bare(y)) {
        (Ok(a), Ok(b)) if per_cent => (a - b).abs() <= 2.0 + 0.02 * a.abs(),
        (Ok(a), Ok(b)) => (a - b).abs() <= 0.01 * a.abs().max(b.abs()) + last_digit(x),
        _ => false,
    }
}

/// One in the last digit that a number shows.
fn last_digit(text: &str) -> f64 {
    let digits: &str =
        text.split(['e', 'E']).next().unwrap_or(text).trim_matches(|c: char| !c.is_ascii_digit() && c != '.');
    let places = digits.split_once('.').map_or(0, |(_, d)| d.len());
    let exponent = text.split_once(['e', 'E']).and_then(|(_, e)| e.parse::<i32>().ok()).unwrap_or(0);
    10f64.powi(exponent - i32::try_from(places).unwrap_or(0))
}
