//! How a mistake is drawn: what is wrong, its place, the line with the value underlined, the advice.
//!
//! ```text
//!   × machine.bore: `bar` is not a unit of a length
//!    ╭─[bench.toml:5:8]
//!  5 │ bore = "120 bar" # wide
//!    ·        ─────────
//!    ╰────
//!   help: `bar` is a unit of a pressure
//! ```
//!
//! Text is broken between words and the line is cut, so that all of it fits the width; columns are those of a terminal, where a
//! Chinese character takes two and a combining accent none.

use std::iter::repeat_n;
use std::ops::Range;

use unicode_width::UnicodeWidthChar;

/// The line that a mistake stands in.
pub struct Excerpt<'a> {
    /// Name of the text.
    pub name: String,
    /// Line and column from 1.
    pub place: (usize, usize),
    /// The line, without its end.
    pub line: &'a str,
    /// Bytes of `line` that are underlined; may be empty.
    pub span: Range<usize>,
}

/// A text that grows by one mistake after the other.
pub struct Drawing {
    out: String,
    width: usize,
    color: bool,
}

/// Fewer columns than these cannot hold a line that a person understands.
const LEAST_WIDTH: usize = 40;
const RED: &str = "31";
const CYAN: &str = "36";
const DIM: &str = "2";

impl Drawing {
    pub fn new(width: usize, color: bool) -> Self {
        Self { out: String::new(), width: width.max(LEAST_WIDTH), color }
    }

    pub fn finish(self) -> String {
        self.out
    }

    /// One mistake, an empty line after the one before.
    pub fn mistake(&mut self, headline: &str, excerpt: Option<&Excerpt<'_>>, help: Option<&str>) {
        if !self.out.is_empty() {
            self.out.push('\n');
        }
        self.paragraph(["  × ", "  │ "], RED, headline);
        if let Some(excerpt) = excerpt {
            self.excerpt(excerpt);
        }
        if let Some(help) = help {
            self.paragraph(["  help: ", "        "], CYAN, help);
        }
    }

    /// `text` behind a mark, and behind another one of the same columns where it goes on.
    fn paragraph(&mut self, [first, next]: [&str; 2], code: &str, text: &str) {
        let room = self.width.saturating_sub(first.chars().count());
        let broken = text.trim_end().split('\n').flat_map(|line| broken(line, room));
        for (i, line) in broken.enumerate() {
            self.painted(code, if i == 0 { first } else { next });
            self.out.push_str(line.trim_end());
            self.out.push('\n');
        }
    }

    fn excerpt(&mut self, e: &Excerpt<'_>) {
        let number = e.place.0.to_string();
        let margin = " ".repeat(number.len() + 2);
        let cut = Cut::new(e.line, e.span.clone(), self.width - (margin.len() + 2).min(self.width));
        let place: String =
            format!("{}:{}:{}", e.name, e.place.0, e.place.1).chars().flat_map(visible).collect();
        self.painted(DIM, &format!("{margin}╭─["));
        self.painted(CYAN, &place);
        self.painted(DIM, "]");
        self.painted(DIM, &format!("\n {number} │ "));
        self.out.push_str(cut.line.trim_end());
        self.painted(DIM, &format!("\n{margin}· "));
        let underline = if e.span.is_empty() { "▲".to_owned() } else { "─".repeat(cut.columns.max(1)) };
        self.out.push_str(&" ".repeat(cut.before));
        self.painted(RED, &underline);
        self.painted(DIM, &format!("\n{margin}╰────"));
        self.out.push('\n');
    }

    fn painted(&mut self, code: &str, text: &str) {
        if self.color {
            self.out.push_str(&format!("\x1b[{code}m{text}\x1b[0m"));
        } else {
            self.out.push_str(text);
        }
    }
}

/// What fits of a line, around what is underlined.
struct Cut {
    line: String,
    /// Columns before the underlined part, and of it.
    before: usize,
    columns: usize,
}

impl Cut {
    /// At most `room` columns of `line`: of the underlined part up to three quarters, and what fits before and after it.
    fn new(line: &str, span: Range<usize>, room: usize) -> Self {
        let (label, columns, whole) = fit(line[span.clone()].chars(), room * 3 / 4);
        let left = room - columns;
        let after = || line[if whole { span.end } else { line.len() }..].chars();
        let (_, wanted, _) = fit(after(), left / 2);
        let (mut shown, before, _) = fit(line[..span.start].chars().rev(), left - wanted);
        let (rest, ..) = fit(after(), left - before);
        shown.reverse();
        shown.extend(label);
        shown.extend(rest);
        Self { line: shown.into_iter().collect(), before, columns }
    }
}

/// What can be shown of `chars` in `room` columns, the columns it takes, and whether that is all of them; what is cut ends
/// with `…`. Stops early: a line may be a megabyte, and of marks that take no column.
fn fit(chars: impl Iterator<Item = char>, room: usize) -> (Vec<char>, usize, bool) {
    let (mut out, mut columns) = (Vec::new(), 0);
    for c in chars.flat_map(visible) {
        if columns + width(c) <= room && out.len() < 4 * room {
            out.push(c);
            columns += width(c);
            continue;
        }
        while columns >= room.max(1) {
            columns -= out.pop().map_or(columns, width);
        }
        if room > 0 {
            out.push('…');
            columns += 1;
        }
        return (out, columns, false);
    }
    (out, columns, true)
}

/// The lines that one line becomes when it is broken between words to `room` columns; its indent stays, and a word of more
/// columns stays whole.
fn broken(line: &str, room: usize) -> Vec<String> {
    let line: String = line.chars().flat_map(visible).collect();
    if columns(&line) <= room {
        return vec![line];
    }
    let indent = &line[..line.len() - line.trim_start().len()];
    let mut lines: Vec<String> = Vec::new();
    for word in line.split_whitespace() {
        match lines.last_mut().filter(|l| columns(l) + 1 + columns(word) <= room) {
            Some(last) => {
                last.push(' ');
                last.push_str(word);
            }
            None => lines.push(format!("{indent}{word}")),
        }
    }
    lines
}

fn columns(text: &str) -> usize {
    text.chars().map(width).sum()
}

fn width(c: char) -> usize {
    c.width().unwrap_or(0)
}

/// What is shown for a character: four spaces for a tab, nothing for a byte order mark, a picture for what would change the
/// terminal or the order of the text.
fn visible(c: char) -> impl Iterator<Item = char> {
    let (shown, times) = match c {
        '\t' => (' ', 4),
        '\u{feff}' => (' ', 0),
        '\0'..='\u{1f}' => (char::from_u32(0x2400 + u32::from(c)).unwrap_or('\u{fffd}'), 1),
        '\u{7f}' => ('\u{2421}', 1),
        '\u{80}'..='\u{9f}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{2069}' => {
            ('\u{fffd}', 1)
        }
        c => (c, 1),
    };
    repeat_n(shown, times)
}
