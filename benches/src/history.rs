//! Why counts changed: the file `counters-history.md`, oldest first.

use std::collections::BTreeMap;
use std::path::Path;

use crate::baseline::Change;
use crate::measure::Span;

/// What the file begins with.
const HEAD: &str = "\
# Why the work of the solvers changed

Written by `counters --accept REASON`, the latest last. The commit that adds an entry says when and by whom.
";

/// Adds a reason with everything that it explains.
///
/// # Errors
/// A file system that refuses, as text.
pub fn add(path: &Path, reason: &str, changes: &[Change]) -> Result<(), String> {
    let said = |e: std::io::Error| format!("{}: {e}", path.display());
    let before = if path.is_file() { std::fs::read_to_string(path).map_err(said)? } else { HEAD.to_owned() };
    std::fs::write(path, before + &entry(reason, changes)).map_err(said)
}

/// One entry: a line for what is new or gone of every case, a table of what changed.
fn entry(reason: &str, changes: &[Change]) -> String {
    let mut lines = vec![String::new(), format!("## {}", reason.trim())];
    let (both, single): (Vec<_>, Vec<_>) = changes.iter().partition(|c| c.share().is_finite());
    let mut counters: BTreeMap<(&str, &str), Vec<&str>> = BTreeMap::new();
    for c in single {
        let word = if c.is.is_some() { "New" } else { "Gone" };
        counters.entry((word, &c.case)).or_default().push(&c.counter);
    }
    if !counters.is_empty() {
        lines.push(String::new());
    }
    lines.extend(counters.iter().map(|((word, case), all)| format!("- {word}: {case} ({})", all.join(", "))));
    if !both.is_empty() {
        lines.extend(["", "| case | counter | was | is | change |", "|---|---|---|---|---|"].map(Into::into));
    }
    let told = |span: Option<Span>| span.map_or_else(String::new, |s| s.to_string());
    lines.extend(both.into_iter().map(|c| {
        let (was, is, share) = (told(c.was), told(c.is), 100.0 * c.share());
        format!("| {} | {} | {was} | {is} | {share:+.1} % |", c.case, c.counter)
    }));
    lines.join("\n") + "\n"
}
