//! What is wrong with a case, and where.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use gudgeon_core::file::Files;
use gudgeon_core::result::{Failure, IMPOSSIBLE, REFUSED};

use crate::render::{Drawing, Excerpt};

/// The text of a case.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Source {
    /// Name as the user gave it.
    pub name: String,
    /// Content.
    pub text: String,
    /// The files that the case names.
    pub files: Files,
}

/// Where a value comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Origin {
    /// The case file.
    File,
    /// The `--set` argument with this index.
    Override(usize),
    /// Neither: a default of the schema.
    Default,
}

/// One mistake.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostic {
    /// What is wrong.
    pub message: String,
    /// What would be right, when that is known.
    pub help: Option<String>,
    /// Dotted path of the value, `rings.0.gap`; empty for the whole file.
    pub path: String,
    /// Byte range in the text of `origin`; absent when no place in it is to blame (the file cannot be read).
    pub span: Option<Range<usize>>,
    /// Which text `span` is in.
    pub origin: Origin,
}

impl Diagnostic {
    /// A mistake without a place.
    pub fn new(message: impl Into<String>) -> Self {
        Self { message: message.into(), help: None, path: String::new(), span: None, origin: Origin::File }
    }

    /// Adds the path.
    #[must_use]
    pub fn path(mut self, path: impl Into<String>) -> Self {
        self.path = path.into();
        self
    }

    /// Adds the place.
    #[must_use]
    pub fn at(mut self, origin: Origin, span: Option<Range<usize>>) -> Self {
        (self.origin, self.span) = (origin, span);
        self
    }

    /// Adds the advice.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// One line: the path, if any, and what is wrong.
    #[must_use]
    pub fn headline(&self) -> String {
        if self.path.is_empty() { self.message.clone() } else { format!("{}: {}", self.path, self.message) }
    }
}

/// Most mistakes that one report tells: a file with more of them is another file.
pub const MAX_MISTAKES: usize = 50;

/// Columns that a report takes where nobody says how wide the terminal is.
pub const WIDTH: usize = 110;

/// What is wrong with one case, at most [`MAX_MISTAKES`], in the order of the file, then of the `--set` arguments.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Report {
    /// The mistakes; never empty in a report that is returned as an error.
    pub diagnostics: Vec<Diagnostic>,
    /// The file.
    pub source: Arc<Source>,
    /// The `--set` arguments.
    pub overrides: Arc<[String]>,
    /// The option that the arguments from an index on were written as, where that is not `--set`.
    written_as: Option<(usize, &'static str)>,
    /// Whether everything could be read, and what it says cannot be.
    impossible: bool,
}

impl Report {
    /// The same in one line, with the place of the first mistake.
    #[must_use]
    pub fn failure(&self) -> Failure {
        let told: Vec<String> = self.diagnostics.iter().map(Diagnostic::headline).collect();
        let path = self.diagnostics.first().map_or_else(String::new, |d| d.path.clone());
        let code = if self.impossible { IMPOSSIBLE } else { REFUSED };
        Failure { code: code.into(), message: told.join("; "), path }
    }

    /// Puts the mistakes in order.
    #[must_use]
    pub fn new(mut diagnostics: Vec<Diagnostic>, source: Arc<Source>, overrides: Arc<[String]>) -> Self {
        diagnostics.sort_by_key(|d| (d.origin, d.span.as_ref().map_or(usize::MAX, |s| s.start)));
        diagnostics.dedup();
        diagnostics.truncate(MAX_MISTAKES);
        Self { diagnostics, source, overrides, written_as: None, impossible: false }
    }

    /// The same of a case that could be read: there is no machine that is as it says.
    #[must_use]
    pub(crate) fn of_impossible(self) -> Self {
        Self { impossible: true, ..self }
    }

    /// A report that has nothing but a message: a file that cannot be read.
    #[must_use]
    pub fn unreadable(name: &str, diagnostic: Diagnostic) -> Self {
        let source = Source { name: name.to_owned(), text: String::new(), files: Files::default() };
        Self::new(vec![diagnostic], Arc::new(source), Arc::new([]))
    }

    /// The same when the arguments from number `first` on were written as another option, `--swap` or `--contender`.
    #[must_use]
    pub fn written_as(mut self, first: usize, option: &'static str) -> Self {
        self.written_as = Some((first, option));
        self
    }

    /// `(name, line, column)` of a mistake, both from 1, columns in characters.
    #[must_use]
    pub fn place(&self, diagnostic: &Diagnostic) -> Option<(String, usize, usize)> {
        let span = diagnostic.span.as_ref()?;
        let (name, text) = self.text_of(diagnostic.origin)?;
        let (line, column) = line_column(text, span.start);
        Some((name, line, column))
    }

    /// How many mistakes there are, as a person reads it.
    #[must_use]
    pub fn count(&self) -> String {
        match self.diagnostics.len() {
            1 => "1 mistake".to_owned(),
            n if n < MAX_MISTAKES => format!("{n} mistakes"),
            n => format!("{n} mistakes or more"),
        }
    }

    fn text_of(&self, origin: Origin) -> Option<(String, &str)> {
        match origin {
            Origin::File => Some((self.source.name.clone(), &self.source.text)),
            Origin::Override(i) => {
                let other = self.written_as.filter(|(first, _)| i >= *first);
                let option = other.map_or("--set", |(_, option)| option);
                self.overrides.get(i).map(|t| (option.to_owned(), t.as_str()))
            }
            Origin::Default => None,
        }
    }

    /// The report as a person reads it, in [`WIDTH`] columns: each mistake with its place, the text underlined, and the advice.
    #[must_use]
    pub fn render(&self, color: bool) -> String {
        self.render_within(WIDTH, color)
    }

    /// As [`Report::render`], in at most `width` columns of a terminal (40 at least; a single word may be longer).
    #[must_use]
    pub fn render_within(&self, width: usize, color: bool) -> String {
        let mut drawing = Drawing::new(width, color);
        for d in &self.diagnostics {
            drawing.mistake(&d.headline(), self.excerpt(d).as_ref(), d.help.as_deref());
        }
        drawing.finish()
    }

    /// The mistakes for a program to read: `message`, `help`, `path`, `in` (file name or option), `line`, `column`.
    #[must_use]
    pub fn to_json(&self) -> serde_json::Value {
        self.diagnostics
            .iter()
            .map(|d| {
                let (name, line, column) = match self.place(d) {
                    Some((n, l, c)) => (n, Some(l), Some(c)),
                    None => (self.source.name.clone(), None, None),
                };
                serde_json::json!({
                    "message": d.message, "help": d.help, "path": d.path, "in": name, "line": line, "column": column,
                })
            })
            .collect()
    }

    /// The line that a mistake stands in; of several lines the first.
    fn excerpt(&self, d: &Diagnostic) -> Option<Excerpt<'_>> {
        let span = d.span.clone()?;
        let (name, text) = self.text_of(d.origin)?;
        let start = floor(text, span.start);
        let from = text[..start].rfind('\n').map_or(0, |i| i + 1);
        let to = text[start..].find('\n').map_or(text.len(), |i| start + i);
        let line = &text[from..to];
        let line = line.strip_suffix('\r').unwrap_or(line);
        let start = (start - from).min(line.len());
        let end = floor(line, span.end.saturating_sub(from)).max(start);
        Some(Excerpt { name, place: line_column(text, span.start), line, span: start..end })
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(false))
    }
}
impl std::error::Error for Report {}

/// Line and column from 1 of a byte offset; columns count characters.
#[must_use]
pub fn line_column(text: &str, offset: usize) -> (usize, usize) {
    let before = &text[..floor(text, offset)];
    let start = before.rfind('\n').map_or(0, |i| i + 1);
    // Bytes are counted many at a time.
    (before.bytes().filter(|b| *b == b'\n').count() + 1, before[start..].chars().count() + 1)
}

/// The character boundary at or before a byte offset.
fn floor(text: &str, offset: usize) -> usize {
    let mut offset = offset.min(text.len());
    while !text.is_char_boundary(offset) {
        offset -= 1;
    }
    offset
}
