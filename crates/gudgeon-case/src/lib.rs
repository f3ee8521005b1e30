//! Reads a case file: text, `--set` overrides, every mistake with its place, then the value.
//!
//! 1. The text becomes a tree whose keys and values remember their places. A file that is not TOML ends here.
//! 2. Overrides change the tree, and parameter sets that tables name fill it in.
//! 3. A walk along the JSON schema of the wanted type reports all unknown keys, missing keys, wrong types, units, ranges,
//!    words and models at once.
//! 4. Deserialisation decides. What it refuses after a clean walk is reported at the path where it stopped.
//! 5. A [`BuildError`] that a later stage raises finds its place through [`Loaded::locate`].
#![cfg_attr(doctest, doc = include_str!("../README.md"))]

pub mod catalogue;
mod cursor;
mod inputs;
mod near;
mod overrides;
mod parts;
mod places;
mod published;
mod refine;
mod render;
mod report;
mod rewrite;
mod schema;
mod sets;
mod tree;

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use gudgeon_core::file::{Files, MAX_CASE_BYTES, MAX_TABLE_BYTES, ReadError, read_text};
use gudgeon_core::quantity::with_decimal_point;
use gudgeon_core::{BuildError, content};
use schemars::JsonSchema;
use serde::de::DeserializeOwned;
use toml::de::DeTable;

pub use cursor::{Help, KeyHelp};
pub use inputs::{About, ChoiceInput, Input, InputValue, NumberInput, Words};
pub use near::{advice, list, nearest};
pub use published::{one_scene_of, published};
pub use refine::{Level, Refinement};
pub use report::{Diagnostic, MAX_MISTAKES, Origin, Report, Source, WIDTH, line_column};
pub use sets::UsedSet;

/// What the tests of this crate look at and nobody else needs.
#[doc(hidden)]
pub mod for_tests {
    pub use crate::tree::{Step, steps};
}

use schema::{RENAMED, Schema, shorten};
use tree::{Data, Node, Place, steps};

/// A value read from a file, with what is needed to point back at the file.
#[derive(Debug, Clone)]
pub struct Loaded<T> {
    /// The value.
    pub value: T,
    /// The text it was read from.
    pub source: Arc<Source>,
    /// The `--set` arguments that changed it.
    pub overrides: Arc<[String]>,
    /// What a person should be told: keys that a changed model made meaningless, numbers that probably lack their unit.
    pub notes: Vec<String>,
    /// The parameter sets that it names, in the order of the file.
    pub sets: Vec<UsedSet>,
    tree: Arc<Node>,
    /// The tree of the text alone, which studies change again and again.
    base: Arc<Node>,
}

/// Reads a case file, changes it by `PATH=VALUE` overrides and checks it.
///
/// # Errors
/// Every mistake of the file and of the overrides.
pub fn load<T: DeserializeOwned + JsonSchema + 'static>(
    path: &Path,
    overrides: &[String],
) -> Result<Loaded<T>, Report> {
    load_source(read(path)?, overrides)
}

/// As [`load`], from text. `name` stands for the file in messages; `folder` is where relative paths start.
///
/// # Errors
/// Every mistake of the text and of the overrides.
pub fn load_str<T: DeserializeOwned + JsonSchema + 'static>(
    name: &str,
    text: &str,
    folder: &Path,
    overrides: &[String],
) -> Result<Loaded<T>, Report> {
    let source = Source { name: name.to_owned(), text: text.to_owned(), files: Files::of(folder) };
    load_source(source, overrides)
}

/// As [`load`], from a text that was read before.
///
/// # Errors
/// Every mistake of the text and of the overrides.
pub fn load_source<T: DeserializeOwned + JsonSchema + 'static>(
    source: Source,
    overrides: &[String],
) -> Result<Loaded<T>, Report> {
    let document = Document::of(&source.text);
    load_document(source, document, overrides)
}

/// As [`load_source`], with the document that its text is.
///
/// # Errors
/// As [`load_source`].
pub fn load_document<T: DeserializeOwned + JsonSchema + 'static>(
    source: Source,
    document: Document,
    overrides: &[String],
) -> Result<Loaded<T>, Report> {
    let source = Arc::new(source);
    let (base, found) = document.0.map_err(|d| Report::new(d, Arc::clone(&source), Arc::from(overrides)))?;
    load_tree(source, Arc::new(base), found, overrides)
}

/// A text as a tree, and what is wrong with it already; or why it is none.
#[derive(Debug, Clone)]
pub struct Document(Result<(Node, Vec<Diagnostic>), Vec<Diagnostic>>);

impl Document {
    /// Reads a text.
    #[must_use]
    pub fn of(text: &str) -> Self {
        Self(parse(text))
    }

    /// The scene that it names, with the changes of `overrides`.
    #[must_use]
    pub fn scene(&self, overrides: &[String]) -> Option<String> {
        let set = overrides.iter().rev().find_map(|o| o.split_once('=').filter(|(p, _)| p.trim() == "scene"));
        if let Some((_, v)) = set {
            return Some(v.trim().trim_matches('"').to_owned());
        }
        match &self.0.as_ref().ok()?.0.child("scene")?.data {
            Data::Text(t) => Some(t.clone()),
            _ => None,
        }
    }

    /// Where a key or table at its top stands.
    #[must_use]
    pub fn place(&self, key: &str) -> Option<Range<usize>> {
        match self.0.as_ref().map(|(root, _)| &root.data) {
            Ok(Data::Table(all)) => all.iter().find(|e| e.key == key)?.key_place.span.clone(),
            _ => None,
        }
    }

    /// The keys and tables at its top.
    #[must_use]
    pub fn keys(&self) -> Vec<&str> {
        match self.0.as_ref().map(|(root, _)| &root.data) {
            Ok(Data::Table(all)) => all.iter().map(|e| e.key.as_str()).collect(),
            _ => Vec::new(),
        }
    }
}

/// As [`load`], from the tree of a text and what was wrong with it already.
fn load_tree<T: DeserializeOwned + JsonSchema + 'static>(
    source: Arc<Source>,
    base: Arc<Node>,
    mut found: Vec<Diagnostic>,
    overrides: &[String],
) -> Result<Loaded<T>, Report> {
    let overrides = Arc::<[String]>::from(overrides);
    let refuse = |found: Vec<Diagnostic>| Report::new(found, Arc::clone(&source), Arc::clone(&overrides));

    let schema = Schema::of::<T>();
    let mut tree = Node::clone(&base);
    if found.is_empty() && matches!(&tree.data, Data::Table(t) if t.is_empty()) {
        let keys = schema.required();
        let d = Diagnostic::new("the file says nothing").at(Origin::File, Some(0..0));
        return Err(refuse(vec![d.help(format!("a case needs at least {}", list(keys)))]));
    }
    let mut notes = Vec::new();
    let not_applied = overrides::apply(&mut tree, schema, &overrides, &mut notes);
    found.extend(not_applied);
    let sets = sets::expand(&mut tree, schema);
    let wrong = schema.check(&tree, source.text.len());
    found.extend(wrong.into_iter().map(|d| suggest_path(d, schema, &overrides)));
    if !found.is_empty() {
        return Err(refuse(found));
    }
    notes.extend(schema.improbable(&tree));
    match content::read(&tree.content()) {
        Ok(value) => Ok(Loaded { value, source, overrides, notes, sets, tree: Arc::new(tree), base }),
        Err(e) => Err(refuse(vec![place(&tree, &source, e.path().to_owned(), reason(&e), None)])),
    }
}

/// What is wrong with a value, and the nearest right name.
#[must_use]
pub fn reason(e: &content::Error) -> String {
    match e.unknown() {
        Some((what, name, valid)) if !valid.is_empty() => {
            format!("unknown {what} `{name}`; {}", advice(name, valid))
        }
        _ => shorten(e.to_string().lines().next().unwrap_or_default()),
    }
}

/// The text of a case file, or of the summary that records one: a regular file of at most [`MAX_CASE_BYTES`] bytes, a summary of
/// [`MAX_TABLE_BYTES`].
///
/// # Errors
/// A file that does not exist, cannot be read, is too large or is not UTF-8 text.
pub fn read(path: &Path) -> Result<Source, Report> {
    let name = path.display().to_string();
    let folder = match path.parent() {
        Some(p) if !p.as_os_str().is_empty() => p.to_owned(),
        _ => PathBuf::from("."),
    };
    let most = if path.extension().is_some_and(|e| e == "json") { MAX_TABLE_BYTES } else { MAX_CASE_BYTES };
    let said = match read_text(path, most) {
        Ok(text) => return Ok(Source { name, text, files: Files::of(&folder) }),
        Err(e) => e,
    };
    let d = match &said {
        ReadError::Folder => {
            Diagnostic::new(format!("`{name}` is a folder")).help("name the case file in it")
        }
        ReadError::TooLarge { most } => Diagnostic::new(format!("`{name}` is too large to be a case file"))
            .help(format!("a case has at most {} MiB; long tables stand in files of their own", most >> 20)),
        ReadError::NotText { line, column } => {
            let what = format!("`{name}` is not UTF-8 text: line {line}, column {column}");
            Diagnostic::new(what).help("a case is a TOML file; save it with the encoding UTF-8")
        }
        e => {
            let d = Diagnostic::new(format!("cannot read `{name}`: {e}"));
            match neighbour(path, &folder) {
                Some(near) => d.help(format!("did you mean `{near}`?")),
                None => d,
            }
        }
    };
    Err(Report::unreadable(&name, d))
}

/// The text of a case file that another case names.
///
/// # Errors
/// As [`read`].
pub fn read_beside(files: &Files, name: &str) -> Result<Source, Report> {
    match files.text(name) {
        Ok(text) => Ok(Source { name: name.to_owned(), text: text.to_string(), files: files.beside(name) }),
        // What is wrong with a file on the disk is told best by the reading of it.
        Err(e) => Err(read(&files.path(name)).err().unwrap_or_else(|| {
            Report::unreadable(name, Diagnostic::new(format!("cannot read `{name}`: {e}")))
        })),
    }
}

/// The scene that a case names, without checking the rest of it.
#[must_use]
pub fn scene_of(source: &Source, overrides: &[String]) -> Option<String> {
    Document::of(&source.text).scene(overrides)
}

/// Lines of a file with several syntax errors that are shown; behind the first, the parser guesses.
const MAX_SYNTAX_ERRORS: usize = 1;

/// The tree of a text. Duplicate keys do not keep the rest from being checked, other syntax errors do.
fn parse(text: &str) -> Result<(Node, Vec<Diagnostic>), Vec<Diagnostic>> {
    let (table, errors) = DeTable::parse_recoverable(text);
    let (second, mut syntax): (Vec<_>, Vec<_>) =
        errors.into_iter().partition(|e| e.message() == "duplicate key");
    if syntax.is_empty() {
        return Ok((Node::from_table(&table, Origin::File, 0), duplicates(text, &second)));
    }
    syntax.sort_by_key(|e| e.span().map_or(0, |s| s.start));
    syntax.truncate(MAX_SYNTAX_ERRORS);
    let told = |e: toml::de::Error| {
        let span = within(text, e.span());
        let d = Diagnostic::new(e.message()).at(Origin::File, Some(span.clone()));
        match hint(text, &span) {
            Some(h) => d.help(h),
            None => d,
        }
    };
    Err(syntax.into_iter().map(told).collect())
}

fn within(text: &str, span: Option<Range<usize>>) -> Range<usize> {
    span.map_or(0..0, |s| s.start.min(text.len())..s.end.min(text.len()))
}

/// The first [`MAX_MISTAKES`] keys and tables that stand for the second time.
fn duplicates(text: &str, errors: &[toml::de::Error]) -> Vec<Diagnostic> {
    let mut out = Vec::new();
    let mut second_table = None;
    for e in errors {
        if out.len() >= MAX_MISTAKES {
            break;
        }
        let span = within(text, e.span());
        let key = text.get(span.clone()).unwrap_or_default();
        // The keys below a table that stands for the second time are not second mistakes.
        let header = header_above(text, span.start);
        if second_table.is_some() && second_table == header {
            continue;
        }
        if header.is_some_and(|h| line_column(text, h).0 == line_column(text, span.start).0) {
            second_table = header;
        }
        let once = "a key may stand in a table only once";
        let help = match first_line_of(text, span.start, key) {
            Some(n) => format!("the first one is in line {n}; {once}"),
            None => once.to_owned(),
        };
        let what = format!("`{}` stands here for the second time", shorten(key));
        out.push(Diagnostic::new(what).at(Origin::File, Some(span)).help(help));
    }
    out
}

/// Advice on the commonest reasons why a line is not TOML: a value that needs quotes, a decimal comma.
fn hint(text: &str, span: &Range<usize>) -> Option<String> {
    let start = text[..span.start].rfind('\n').map_or(0, |i| i + 1);
    let line = text[start..].lines().next()?;
    let (key, value) = line.split_once('=')?;
    let (key, value) = (key.trim(), value.split('#').next()?.trim());
    if key.is_empty() || !key.chars().all(|c| c.is_alphanumeric() || "_-.".contains(c)) {
        return None;
    }
    if let Some(pointed) = with_decimal_point(value) {
        let quote = if pointed.parse::<f64>().is_ok() { "" } else { "\"" };
        return Some(format!("the decimal mark is a point: `{key} = {quote}{}{quote}`", shorten(&pointed)));
    }
    let plain = |c: char| c.is_alphanumeric() || " ._-+/%°µ()".contains(c);
    (!value.is_empty() && value.chars().all(plain))
        .then(|| format!("text and values with a unit stand in quotes: `{key} = \"{}\"`", shorten(value)))
}

/// Where the table header starts that a place stands in or below.
fn header_above(text: &str, offset: usize) -> Option<usize> {
    let end = text[offset..].find('\n').map_or(text.len(), |i| offset + i);
    let mut start = 0;
    let mut found = None;
    for line in text[..end].split_inclusive('\n') {
        if line.trim_start().starts_with('[') {
            found = Some(start);
        }
        start += line.len();
    }
    found
}

/// The line of the key that a second one repeats.
fn first_line_of(text: &str, second: usize, key: &str) -> Option<usize> {
    let start = text[..second].rfind('\n').map_or(0, |i| i + 1);
    let this = text[start..].lines().next().unwrap_or_default().trim();
    let header = this.starts_with('[');
    let mut found = None;
    for (i, line) in text[..start].lines().enumerate() {
        let line = line.trim();
        if header {
            let same = line.split('#').next().map(str::trim) == this.split('#').next().map(str::trim);
            found = found.or(same.then_some(i + 1));
        } else if line.starts_with('[') {
            found = None;
        } else if line.split_once('=').is_some_and(|(k, _)| k.trim() == key) {
            found = found.or(Some(i + 1));
        }
    }
    found
}

/// A misspelt path of an override is compared with whole paths too: `bore` is `engine.bore`.
fn suggest_path(d: Diagnostic, schema: &Schema, overrides: &[String]) -> Diagnostic {
    let Origin::Override(i) = d.origin else { return d };
    if !d.message.starts_with("unknown key") {
        return d;
    }
    let path = overrides.get(i).and_then(|o| o.split_once('=')).map_or("", |(p, _)| p.trim());
    match schema.nearest_path(path) {
        Some(near)
            if !d.help.as_ref().is_some_and(|h| h.starts_with("did you mean") || h.starts_with(RENAMED)) =>
        {
            let rest = d.help.clone().map_or_else(String::new, |h| format!(" {h}"));
            d.help(format!("did you mean `{near}`?{rest}"))
        }
        _ => d,
    }
}

/// A file with nearly the name that was asked for.
fn neighbour(path: &Path, folder: &Path) -> Option<String> {
    let wanted = path.file_name()?.to_str()?;
    let mut names: Vec<String> = std::fs::read_dir(folder)
        .ok()?
        .filter_map(|e| e.ok()?.file_name().into_string().ok())
        .filter(|n| n.ends_with(".toml") && n != wanted)
        .collect();
    names.sort_unstable();
    let near = nearest(wanted, names.iter().map(String::as_str))?;
    Some(path.with_file_name(near).display().to_string())
}

fn place(tree: &Node, source: &Source, path: String, message: String, help: Option<String>) -> Diagnostic {
    let (node, _) = tree.deepest(&path);
    let end = source.text.len();
    let Place { origin, span } = match &node.place {
        Place { span: None, .. } => Place { origin: Origin::File, span: Some(end..end) },
        p => p.clone(),
    };
    Diagnostic { message, help, path, span, origin }
}

impl<T> Loaded<T> {
    /// Where in the file, or in which `--set` argument, the value stands that an error is about: the longest part of its
    /// path that exists.
    #[must_use]
    pub fn locate(&self, error: &BuildError) -> Diagnostic {
        let path = steps(&error.field, 0).into_iter().map(|s| s.text).collect::<Vec<_>>().join(".");
        place(&self.tree, &self.source, path, error.message.clone(), error.help.clone())
    }

    /// The number at a dotted path where it stands without a unit, as it was written or nearly.
    #[must_use]
    pub fn bare_number(&self, path: &str) -> Option<String> {
        match self.tree.deepest(path) {
            (Node { data: Data::Integer(i), .. }, true) => Some(i.to_string()),
            (Node { data: Data::Float(f), .. }, true) => Some(f.to_string()),
            _ => None,
        }
    }

    /// A report on errors that a later stage found.
    #[must_use]
    pub fn refuse<'e>(&self, errors: impl IntoIterator<Item = &'e BuildError>) -> Report {
        let found = errors.into_iter().map(|e| self.locate(e)).collect();
        Report::new(found, Arc::clone(&self.source), Arc::clone(&self.overrides)).of_impossible()
    }

    /// Who gave the value at a dotted path, and in which line of the file if it was the file.
    #[must_use]
    pub fn given_by(&self, path: &str) -> (Origin, Option<usize>) {
        match self.tree.deepest(path) {
            (node, true) => match (&node.place.span, node.place.origin) {
                (Some(span), Origin::File) => {
                    (Origin::File, Some(line_column(&self.source.text, span.start).0))
                }
                (_, origin) => (origin, None),
            },
            _ => (Origin::Default, None),
        }
    }

    /// The same file read as another type or with further overrides: what a study does for each of its variants.
    ///
    /// # Errors
    /// As [`load`].
    pub fn reload<U: DeserializeOwned + JsonSchema + 'static>(
        &self,
        more: &[String],
    ) -> Result<Loaded<U>, Report> {
        let overrides: Vec<String> = self.overrides.iter().chain(more).cloned().collect();
        // A case that was read had no mistake of its text.
        load_tree(Arc::clone(&self.source), Arc::clone(&self.base), Vec::new(), &overrides)
    }
}

impl<T: serde::Serialize> Loaded<T> {
    /// The effective case: every default filled in, every value in SI.
    ///
    /// # Errors
    /// A type whose serialisation fails, which none of a case does.
    pub fn resolved(&self) -> Result<serde_json::Value, serde_json::Error> {
        serde_json::to_value(&self.value)
    }
}

impl<T: JsonSchema + 'static> Loaded<T> {
    /// Paths of the values that the case gives and its type does not use. A table that several types share holds more than each of them needs;
    /// the field names what it uses in its schema:
    ///
    /// ```ignore
    /// #[schemars(extend("x-used" = ["lands", "pin_to_ring1"]))]
    /// pub piston: Piston,
    /// ```
    #[must_use]
    pub fn unused(&self) -> Vec<String> {
        Schema::of::<T>().unused(&self.tree)
    }
}

/// What the schema of a case knows about the line of a text that a byte offset stands in. The text may be wrong elsewhere.
#[must_use]
pub fn help_at<T: JsonSchema + 'static>(text: &str, offset: usize) -> Help {
    cursor::help(Schema::of::<T>(), text, offset)
}

impl<T: serde::Serialize + DeserializeOwned + JsonSchema + 'static> Loaded<T> {
    /// The text of the file with further overrides written into it: what `--set` does, to be kept as a file. A change that makes the case
    /// wrong is written all the same: its mistake then has a place in the text.
    ///
    /// # Errors
    /// A change that is none of a case, or that the text cannot hold.
    pub fn rewritten(&self, more: &[String]) -> Result<String, Report> {
        let refuse = |found| Report::new(found, Arc::clone(&self.source), Arc::from(more));
        let mut changed = Node::clone(&self.base);
        let found = overrides::apply(&mut changed, Schema::of::<T>(), more, &mut Vec::new());
        if !found.is_empty() {
            return Err(refuse(found));
        }
        let text = rewrite::rewritten(&self.source.text, &self.base, &changed, more);
        let source = Source { text: text.clone(), ..Source::clone(&self.source) };
        let same = match (self.reload::<T>(more), load_source::<T>(source, &self.overrides)) {
            (Ok(a), Ok(b)) => a.resolved().ok() == b.resolved().ok(),
            (Err(_), Err(_)) => true,
            _ => false,
        };
        if same {
            return Ok(text);
        }
        let what = Diagnostic::new("this change cannot be written into the text of the case");
        Err(refuse(vec![what.help("make it in the file itself")]))
    }
}

impl<T: serde::Serialize + JsonSchema + 'static> Loaded<T> {
    /// The inputs of this case: numbers, words and models, in the order of the resolved case.
    #[must_use]
    pub fn inputs(&self) -> Vec<Input> {
        self.resolved().map_or_else(|_| Vec::new(), |resolved| self.inputs_of(&resolved))
    }

    /// The same, where its resolved values are at hand.
    #[must_use]
    pub fn inputs_of(&self, resolved: &serde_json::Value) -> Vec<Input> {
        inputs::inputs(Schema::of::<T>(), resolved, &self.source.text, &self.tree)
    }

    /// How the numerical settings of this case are refined.
    #[must_use]
    pub fn refinements(&self) -> Vec<Refinement> {
        self.refinements_with(|_| ())
    }

    /// The same, with the numbers put in that the case leaves to its model.
    pub fn refinements_with(&self, fill: impl FnOnce(&mut serde_json::Value)) -> Vec<Refinement> {
        let Ok(mut resolved) = self.resolved() else { return Vec::new() };
        fill(&mut resolved);
        refine::refinements(Schema::of::<T>(), &resolved)
    }
}
