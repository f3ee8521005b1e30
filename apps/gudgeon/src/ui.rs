//! The only place that writes to the terminal.
//!
//! Results go to standard output; progress, notes and errors to standard error. A reader that closes the pipe early
//! (`| head`) is not an error.

use std::cell::RefCell;
use std::fmt::Write as _;
use std::io::{self, IsTerminal, Write};
use std::time::Duration;

use console::Term;
use gudgeon_case::Report;
use gudgeon_core::elementary;
use gudgeon_scene::{Progress, Stopped};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::failure::Failure;
use crate::interrupt;

pub struct Ui {
    quiet: bool,
    color: bool,
    /// Whether standard output is a terminal that shows more than letters.
    blocks: bool,
    /// Columns for mistakes.
    width: usize,
    /// Why standard output lacks something.
    lost: RefCell<Option<io::Error>>,
}

/// Width that long texts are broken at.
pub const WIDTH: usize = 100;

impl Ui {
    pub fn new(quiet: bool) -> Self {
        let wanted = std::env::var_os("NO_COLOR").is_none_or(|v| v.is_empty());
        // A line longer than that of a book is hard to read, however wide the terminal.
        let width = Term::stderr().size_checked().map_or(gudgeon_case::WIDTH, |(_, columns)| columns.into());
        Self {
            quiet,
            color: wanted && io::stderr().is_terminal(),
            blocks: wanted && io::stdout().is_terminal() && utf8(),
            width: width.min(gudgeon_case::WIDTH),
            lost: RefCell::new(None),
        }
    }

    /// Whether tables and progress are unwanted.
    pub const fn quiet(&self) -> bool {
        self.quiet
    }

    /// Whether block characters may be written to standard output. What a file or another program gets is plain text.
    pub const fn blocks(&self) -> bool {
        self.blocks
    }

    /// To standard output. What could not be written makes the program fail at its end, [`Ui::end`].
    pub fn out(&self, text: &str) {
        let mut stdout = io::stdout().lock();
        let end: &[u8] = if text.ends_with('\n') { b"" } else { b"\n" };
        let written = stdout
            .write_all(text.as_bytes())
            .and_then(|()| stdout.write_all(end))
            .and_then(|()| stdout.flush());
        if let Err(e) = written {
            self.lost.borrow_mut().get_or_insert(e);
        }
    }

    /// Whether everything went to standard output. A reader that has seen enough (`| head`) is no failure, a full disk is.
    pub fn end(&self) -> Result<(), Failure> {
        match self.lost.borrow_mut().take() {
            Some(e) if e.kind() != io::ErrorKind::BrokenPipe => {
                Err(Failure::Run(format!("standard output could not be written: {e}")))
            }
            _ => Ok(()),
        }
    }

    /// JSON to standard output.
    pub fn json(&self, value: &serde_json::Value) {
        self.out(&format!("{value:#}"));
    }

    /// To standard error.
    fn err(&self, text: &str) {
        let mut stderr = io::stderr().lock();
        let _ = stderr.write_all(text.as_bytes());
        let _ = stderr.flush();
    }

    /// Something a person should know although nothing is wrong.
    pub fn note(&self, text: &str) {
        self.err(&format!("note: {text}\n"));
    }

    /// Why the command stops.
    pub fn failure(&self, failure: &Failure) {
        let mut text = String::new();
        match failure {
            Failure::Input(report) => {
                text = report.render_within(self.width, self.color);
                if report.diagnostics.len() > 1 {
                    let _ = writeln!(text, "\n{} in {}", report.count(), report.source.name);
                }
            }
            Failure::Argument(d) => {
                text = Report::unreadable("", d.clone()).render_within(self.width, self.color);
            }
            Failure::Run(what) => {
                let _ = writeln!(text, "the run failed: {what}");
            }
            Failure::Registry(all) => {
                for e in all {
                    let _ = writeln!(text, "defect of this program: {e}");
                }
            }
        }
        self.err(&text);
    }

    /// A progress bar on a terminal, nothing elsewhere.
    pub fn bar(&self) -> Bar {
        const SCALE: u64 = 1000;
        let shown = !self.quiet && io::stderr().is_terminal();
        let target = if shown { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
        let bar = ProgressBar::with_draw_target(Some(SCALE), target);
        // A constant template: a mistake in it shows in every run, and costs only the look.
        if let Ok(style) = ProgressStyle::with_template("{bar:30} {percent:>3} %  {elapsed}  {wide_msg}") {
            bar.set_style(style);
        }
        if shown {
            // A thread of its own.
            bar.enable_steady_tick(Duration::from_millis(200));
        }
        Bar { bar, scale: SCALE as f64 }
    }
}

/// Whether the terminal reads UTF-8: everywhere on Windows, elsewhere as the locale says.
fn utf8() -> bool {
    let said =
        ["LC_ALL", "LC_CTYPE", "LANG"].iter().find_map(|v| std::env::var(v).ok().filter(|v| !v.is_empty()));
    cfg!(windows) || said.is_some_and(|v| v.to_ascii_lowercase().replace('-', "").contains("utf8"))
}

/// A running progress bar; it disappears when dropped.
pub struct Bar {
    bar: ProgressBar,
    scale: f64,
}

impl Bar {
    /// Shows how far a computation is, and says whether it may go on.
    ///
    /// # Errors
    /// The user has pressed Ctrl-C.
    pub fn show(&self, p: Progress) -> Result<(), Stopped> {
        self.bar.set_position((p.fraction.clamp(0.0, 1.0) * self.scale) as u64);
        self.bar.set_message(p.phase);
        interrupt::check()
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// A number with enough digits to compare by, few enough to read.
pub fn number(v: f64) -> String {
    const DIGITS: i32 = 5;
    // Counts and exact zeros are not measurements.
    if v.fract() == 0.0 && v.abs() < 1e7 {
        // Without the sign of a negative zero.
        return format!("{:.0}", v + 0.0);
    }
    if !v.is_finite() {
        return v.to_string();
    }
    let magnitude = elementary::log10(v.abs()).floor() as i32;
    if !(-4..7).contains(&magnitude) {
        return format!("{v:.*e}", DIGITS as usize - 1);
    }
    format!("{v:.*}", (DIGITS - 1 - magnitude).max(0) as usize)
}

/// A number with the digits that its uncertainty leaves, and that uncertainty.
pub fn certain(v: f64, uncertainty: Option<f64>) -> String {
    let Some(u) = uncertainty.filter(|u| *u > 0.0 && u.is_finite()) else { return number(v) };
    // The place of the first digit of the uncertainty is the last one printed.
    let place = elementary::log10(u).floor() as i32;
    let size = elementary::log10(v.abs().max(u)).floor() as i32;
    if size < -3 {
        let (scale, decimals) = (10f64.powi(size), (size - place).clamp(0, 9) as usize);
        return format!("({:.decimals$} ± {:.decimals$})e{size}", v / scale, u / scale);
    }
    if (-9..7).contains(&place) {
        let decimals = (-place).max(0) as usize;
        return format!("{v:.decimals$} ± {u:.decimals$}");
    }
    format!("{} ± {u:.0e}", number(v))
}

/// A difference with its sign, its unit and its uncertainty where that is known: `+3.2 % ± 0.1`.
pub fn signed(v: f64, unit: &str, uncertainty: Option<f64>) -> String {
    let space = if unit.is_empty() { "" } else { " " };
    let uncertainty = uncertainty.filter(|u| *u > 0.0 && u.is_finite());
    if !matches!(unit, "%" | "deg") {
        let sign = if v > 0.0 { "+" } else { "" };
        return format!("{sign}{}{space}{unit}", certain(v, uncertainty));
    }
    let Some(u) = uncertainty else { return format!("{v:+.2} {unit}") };
    // The place of the first digit of the uncertainty is the last one printed, and one more where both are of one size.
    let close = i32::from((0.5..2.0).contains(&(v.abs() / u)));
    let (decimals, u) = match elementary::log10(u).floor() as i32 {
        place @ -4.. => {
            let decimals = (close - place).max(0) as usize;
            (decimals, format!("{u:.decimals$}"))
        }
        _ => (4, format!("{u:.0e}")),
    };
    let value = format!("{v:+.decimals$}");
    // Nothing but zeros has no sign.
    let value = if value.contains(|c: char| ('1'..='9').contains(&c)) { &value } else { &value[1..] };
    format!("{value} {unit} ± {u}")
}

/// A unit for a person: results without one carry the unit `1`.
pub fn unit(unit: &str) -> String {
    if unit == "1" { String::new() } else { unit.to_owned() }
}

/// Columns padded to their widest cell. `right` tells which ones are aligned to the right.
pub fn table(rows: &[Vec<String>], right: &[usize]) -> String {
    let mut widths: Vec<usize> = Vec::new();
    for row in rows {
        widths.resize(widths.len().max(row.len()), 0);
        for (width, cell) in widths.iter_mut().zip(row) {
            *width = (*width).max(cell.chars().count());
        }
    }
    let mut out = String::new();
    for row in rows {
        let mut line = String::new();
        for (c, cell) in row.iter().enumerate() {
            let pad = widths[c] - cell.chars().count();
            line.push_str("  ");
            if right.contains(&c) {
                line.extend(std::iter::repeat_n(' ', pad));
                line.push_str(cell);
            } else {
                line.push_str(cell);
                // Nothing stands behind the last cell.
                line.extend(std::iter::repeat_n(' ', if c + 1 < row.len() { pad } else { 0 }));
            }
        }
        out.push_str(line.trim_end());
        out.push('\n');
    }
    out
}

/// Text broken into lines of at most [`WIDTH`] characters, each indented.
pub fn wrapped(text: &str, indent: usize) -> String {
    let pad = " ".repeat(indent);
    let mut out = String::new();
    let mut length = 0;
    for word in text.split_whitespace() {
        let n = word.chars().count();
        if length > 0 && indent + length + 1 + n > WIDTH {
            out.push('\n');
            length = 0;
        }
        if length == 0 {
            out.push_str(&pad);
        } else {
            out.push(' ');
            length += 1;
        }
        out.push_str(word);
        length += n;
    }
    if !out.is_empty() {
        out.push('\n');
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_five_digits() {
        let shown = [49.876_543, 0.001_234_567, 1e-9, 123_456.7, 1.0, -2.5, 0.0, 2e9, -0.0].map(number);
        assert_eq!(
            shown,
            ["49.877", "0.0012346", "1.0000e-9", "123457", "1", "-2.5000", "0", "2.0000e9", "0"]
        );
    }

    #[test]
    fn uncertain_digits_are_not_printed() {
        assert_eq!(certain(83.412_34, Some(0.021)), "83.41 ± 0.02");
        assert_eq!(certain(1883.2, Some(600.0)), "1883 ± 600");
        assert_eq!(certain(5.357e-5, Some(4.9e-7)), "(5.36 ± 0.05)e-5");
        assert_eq!(certain(83.412_34, None), "83.412");
        assert_eq!(certain(83.412_34, Some(1e-12)), "83.412 ± 1e-12");
    }

    #[test]
    fn differences_have_a_sign() {
        assert_eq!(signed(3.216, "%", Some(0.11)), "+3.2 % ± 0.1");
        assert_eq!(signed(-3.216, "%", Some(1e-7)), "-3.2160 % ± 1e-7");
        assert_eq!(signed(32.16, "%", Some(11.0)), "+32 % ± 11");
        assert_eq!(signed(0.0612, "%", Some(0.0588)), "+0.061 % ± 0.059");
        assert_eq!(signed(-0.02, "%", Some(2.6)), "0 % ± 3");
        assert_eq!(signed(3.216, "deg", None), "+3.22 deg");
        assert_eq!(signed(5.36e-5, "m", Some(4.9e-7)), "+(5.36 ± 0.05)e-5 m");
        assert_eq!(signed(-2.0, "", None), "-2");
    }

    #[test]
    fn tables_align() {
        let rows = [vec!["a".into(), "1".into(), "µm".into()], vec!["bcd".into(), "12".into(), "bar".into()]];
        assert_eq!(table(&rows, &[1]), "  a     1  µm\n  bcd  12  bar\n");
    }

    #[test]
    fn text_wraps_at_words() {
        let text = wrapped(&"word ".repeat(50), 4);
        assert!(text.lines().all(|l| l.len() <= WIDTH && l.starts_with("    word")));
        assert_eq!(text.split_whitespace().count(), 50);
        assert_eq!(wrapped("", 4), "");
    }
}
