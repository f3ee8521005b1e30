//! `gudgeon validate [CASE...]`

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use gudgeon_case::Diagnostic;
use gudgeon_core::result::{Check, Validated, Verdict};
use gudgeon_study::validate::{self, ValidateError};

use crate::args::ValidateArgs;
use crate::failure::Failure;
use crate::ui::{Ui, number, table};

/// The folder of the comparisons when none is named.
const FOLDER: &str = "validation";
/// The folder of the pages beside their index.
const PAGES: &str = "docs/validation";

pub fn validate(a: &ValidateArgs, ui: &Ui) -> Result<(), Failure> {
    let files = files(&a.files)?;
    let answers = {
        let bar = ui.bar();
        validate::validate(&files, 0, &mut |p| bar.show(p))?
    };
    let mut all = Vec::new();
    let mut failed = Vec::new();
    for answer in answers {
        match answer {
            Ok(v) => all.push(v),
            Err(ValidateError::Input(report)) => return Err(report.into()),
            Err(ValidateError::Run(file, e)) => failed.push(format!("{}: {e}", file.display())),
        }
    }
    if let Some(index) = &a.pages {
        let pages = index.parent().unwrap_or(Path::new("")).join(PAGES);
        gudgeon_report::write_validation(&all, index, &pages)?;
    }
    if a.json {
        // Numbers, text and lists: JSON refuses none of them.
        ui.json(&serde_json::to_value(&all).unwrap_or_default());
    } else if !ui.quiet() {
        ui.out(&text(&all));
    }
    for v in &all {
        failed.extend(v.broken().map(|c| format!("{}: {}", v.case, broken(c))));
    }
    if failed.is_empty() { Ok(()) } else { Err(Failure::Run(failed.join("\n"))) }
}

/// The files of comparisons that are meant.
fn files(named: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
    let unreadable = |p: &Path, e: std::io::Error| {
        Failure::argument(
            format!("cannot read `{}`: {e}", p.display()),
            "name a case, a file of comparisons or a folder of them",
        )
    };
    let default = [PathBuf::from(FOLDER)];
    let mut all = Vec::new();
    for p in if named.is_empty() { &default[..] } else { named } {
        if p.is_dir() {
            all.extend(validate::files(p).map_err(|e| unreadable(p, e))?);
        } else if gudgeon_case::read(p)?.text.contains("[[checks]]") {
            all.push(p.clone());
        } else {
            match validate::file_of(p).map_err(|e| unreadable(p, e))? {
                Some(f) => all.push(f),
                None => {
                    let d = Diagnostic::new(format!("there are no comparisons for `{}`", p.display()));
                    let help = "they stand in a folder `validation` above the case, in a file that names it with `case`";
                    return Err(Failure::Argument(d.help(help)));
                }
            }
        }
    }
    Ok(all)
}

fn text(all: &[Validated]) -> String {
    let mut rows = vec![
        ["case", "reproduced", "refuted", "not reproduced", "broken", "worst", "admitted"]
            .map(String::from)
            .to_vec(),
    ];
    let mut total = [0; 4];
    for v in all {
        let counts: Vec<usize> =
            Verdict::ALL.iter().map(|k| v.count(*k)).chain([v.broken().count()]).collect();
        for (t, n) in total.iter_mut().zip(&counts) {
            *t += n;
        }
        let worst = v.worst();
        let mut row = vec![v.case.clone()];
        row.extend(counts.iter().map(usize::to_string));
        row.push(worst.map_or_else(String::new, |c| format!("{:.1e}", c.deviation())));
        row.push(worst.map_or_else(String::new, |c| format!("{:.0e}", c.tolerance)));
        rows.push(row);
    }
    rows.push(std::iter::once("all".to_owned()).chain(total.iter().map(usize::to_string)).collect());
    table(&rows, &[1, 2, 3, 4, 5, 6])
}

fn broken(c: &Check) -> String {
    let mut s = String::new();
    // Writing to a String cannot fail.
    let _ = write!(
        s,
        "{}: {}: {} where the source gives {}, deviation {:.1e}, ",
        c.setting(),
        c.result,
        number(c.value),
        number(c.reference),
        c.deviation(),
    );
    let _ = match c.verdict {
        Verdict::Reproduced => write!(s, "admitted {:.0e}", c.tolerance),
        v => write!(s, "called {} although it is within {:.0e}", v.words(), c.tolerance),
    };
    s
}
