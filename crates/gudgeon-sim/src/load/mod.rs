//! Reads a case file: text, `--set` overrides, every mistake with its place, then the value.
//!
//! 1. The text becomes a tree whose keys and values remember their places. A file that is not TOML ends here.
//! 2. Overrides change the tree.
//! 3. A walk along the JSON schema of the wanted type reports all unknown keys, missing keys, wrong types, units, ranges,
//!    words and models at once.
//! 4. Deserialisation decides. What it refuses after a clean walk is reported at the path where it stopped.
//! 5. A [`BuildError`] that a later stage raises finds its place through [`Loaded::locate`].

mod near;
mod overrides;
mod report;
mod schema;
mod tree;

#[cfg(test)]
mod tests;

use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use gudgeon_core::BuildError;
use schemars::JsonSchema;
use serde::de::DeserializeOwned;
use serde_path_to_error::Segment;
use toml::de::DeTable;

pub use near::{advice, list, nearest};
pub use report::{Diagnostic, Origin, Report, Source, line_column};

use schema::{Schema, shorten};
use tree::{Data, Node, Place, steps};

/// A case file has a few kilobytes; this keeps a wrong argument (a disk image, a device) from filling the memory.
const MAX_BYTES: u64 = 16 << 20;

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
    tree: Arc<Node>,
}

/// Reads a case file, changes it by `PATH=VALUE` overrides and checks it.
///
/// # Errors
/// Every mistake of the file and of the overrides.
pub fn load<T: DeserializeOwned + JsonSchema>(
    path: &Path,
    overrides: &[String],
) -> Result<Loaded<T>, Report> {
    load_source(read(path)?, overrides)
}

/// As [`load`], from text. `name` stands for the file in messages; `folder` is where relative paths start.
///
/// # Errors
/// Every mistake of the text and of the overrides.
pub fn load_str<T: DeserializeOwned + JsonSchema>(
    name: &str,
    text: &str,
    folder: &Path,
    overrides: &[String],
) -> Result<Loaded<T>, Report> {
    let source = Source { name: name.to_owned(), text: text.to_owned(), folder: folder.to_owned() };
    load_source(source, overrides)
}

/// As [`load`], from a text that was read before.
///
/// # Errors
/// Every mistake of the text and of the overrides.
pub fn load_source<T: DeserializeOwned + JsonSchema>(
    source: Source,
    overrides: &[String],
) -> Result<Loaded<T>, Report> {
    let (source, overrides) = (Arc::new(source), Arc::<[String]>::from(overrides));
    let refuse = |found: Vec<Diagnostic>| Report::new(found, Arc::clone(&source), Arc::clone(&overrides));

    let schema = Schema::of::<T>(source.text.len());
    let (mut tree, mut found) = parse(&source.text).map_err(&refuse)?;
    if found.is_empty() && matches!(&tree.data, Data::Table(t) if t.is_empty()) {
        let keys = schema.required();
        let d = Diagnostic::new("the file says nothing").at(Origin::File, Some(0..0));
        return Err(refuse(vec![d.help(format!("a case needs at least {}", list(keys)))]));
    }
    let mut notes = Vec::new();
    let not_applied = overrides::apply(&mut tree, &schema, &overrides, &mut notes);
    found.extend(not_applied);
    found.extend(schema.check(&tree).into_iter().map(|d| suggest_path(d, &schema, &overrides)));
    if !found.is_empty() {
        return Err(refuse(found));
    }
    notes.extend(schema.improbable(&tree));
    match serde_path_to_error::deserialize(tree.to_json()) {
        Ok(value) => Ok(Loaded { value, source, overrides, notes, tree: Arc::new(tree) }),
        Err(e) => {
            let path: Vec<String> = e.path().iter().filter_map(segment).collect();
            let text = e.inner().to_string();
            let message = shorten(text.lines().next().unwrap_or_default());
            Err(refuse(vec![place(&tree, &source, path.join("."), message, None)]))
        }
    }
}

/// The text of a case file.
///
/// # Errors
/// A file that does not exist, cannot be read, is too large or is not UTF-8 text.
pub fn read(path: &Path) -> Result<Source, Report> {
    let name = path.display().to_string();
    let refuse = |d: Diagnostic| Report::unreadable(&name, d);
    let folder = match path.parent() {
        Some(p) if !p.as_os_str().is_empty() => p.to_owned(),
        _ => PathBuf::from("."),
    };
    let mut bytes = Vec::new();
    let failed = |e: std::io::Error| {
        let d = Diagnostic::new(format!("cannot read `{name}`: {e}"));
        refuse(match neighbour(path, &folder) {
            Some(near) => d.help(format!("did you mean `{near}`?")),
            None => d,
        })
    };
    if path.is_dir() {
        return Err(refuse(
            Diagnostic::new(format!("`{name}` is a folder")).help("name the case file in it"),
        ));
    }
    let file = std::fs::File::open(path).map_err(failed)?;
    file.take(MAX_BYTES + 1).read_to_end(&mut bytes).map_err(failed)?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(refuse(Diagnostic::new(format!("`{name}` is too large to be a case file"))));
    }
    match String::from_utf8(bytes) {
        Ok(text) => Ok(Source { name, text, folder }),
        Err(e) => {
            let at = e.utf8_error().valid_up_to();
            let valid = String::from_utf8_lossy(&e.as_bytes()[..at]).into_owned();
            let (line, column) = line_column(&valid, at);
            let d = Diagnostic::new(format!("`{name}` is not UTF-8 text: line {line}, column {column}"));
            Err(refuse(d.help("a case is a TOML file; save it with the encoding UTF-8")))
        }
    }
}

/// The scene that a case names, without checking the rest of it.
#[must_use]
pub fn scene_of(source: &Source, overrides: &[String]) -> Option<String> {
    let set = overrides.iter().rev().find_map(|o| o.split_once('=').filter(|(p, _)| p.trim() == "scene"));
    if let Some((_, v)) = set {
        return Some(v.trim().trim_matches('"').to_owned());
    }
    match &parse(&source.text).ok()?.0.child("scene")?.data {
        Data::Text(t) => Some(t.clone()),
        _ => None,
    }
}

/// Lines of a file with several syntax errors that are shown; behind the first, the parser guesses.
const MAX_SYNTAX_ERRORS: usize = 1;

/// The tree of a text. Duplicate keys do not keep the rest from being checked, other syntax errors do.
fn parse(text: &str) -> Result<(Node, Vec<Diagnostic>), Vec<Diagnostic>> {
    let (table, errors) = DeTable::parse_recoverable(text);
    let mut duplicates = Vec::new();
    let mut syntax = Vec::new();
    let mut second_table = None;
    for e in errors {
        let span = e.span().map_or(0..0, |s| s.start.min(text.len())..s.end.min(text.len()));
        let key = text.get(span.clone()).unwrap_or_default().to_owned();
        let d = Diagnostic::new(e.message()).at(Origin::File, Some(span.clone()));
        if e.message() == "duplicate key" {
            // The keys below a table that stands for the second time are not second mistakes.
            let header = header_above(text, span.start);
            if second_table.is_some() && second_table == header {
                continue;
            }
            if header.is_some_and(|h| line_column(text, h).0 == line_column(text, span.start).0) {
                second_table = header;
            }
            let first = first_line_of(text, span.start, &key);
            let d = Diagnostic { message: format!("`{key}` stands here for the second time"), ..d };
            duplicates.push(match first {
                Some(n) => {
                    d.help(format!("the first one is in line {n}; a key may stand in a table only once"))
                }
                None => d.help("a key may stand in a table only once"),
            });
        } else {
            syntax.push(match hint(text, &span) {
                Some(h) => d.help(h),
                None => d,
            });
        }
    }
    if syntax.is_empty() {
        Ok((Node::from_table(&table, Origin::File, 0), duplicates))
    } else {
        syntax.sort_by_key(|d| d.span.as_ref().map_or(0, |s| s.start));
        syntax.truncate(MAX_SYNTAX_ERRORS);
        Err(syntax)
    }
}

/// Advice on the commonest reason why a line is not TOML: a value that needs quotes.
fn hint(text: &str, span: &std::ops::Range<usize>) -> Option<String> {
    let start = text[..span.start].rfind('\n').map_or(0, |i| i + 1);
    let line = text[start..].lines().next()?;
    let (key, value) = line.split_once('=')?;
    let value = value.split('#').next()?.trim();
    let plain = |c: char| c.is_alphanumeric() || " ._-+/%°µ()".contains(c);
    let key_is_plain =
        key.trim().chars().all(|c| c.is_alphanumeric() || "_-.".contains(c)) && !key.trim().is_empty();
    (key_is_plain && !value.is_empty() && value.chars().all(plain)).then(|| {
        format!("text and values with a unit stand in quotes: `{} = \"{}\"`", key.trim(), shorten(value))
    })
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
        Some(near) if d.help.as_ref().is_none_or(|h| !h.starts_with("did you mean")) => {
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
        .filter(|n| n.ends_with(".toml"))
        .collect();
    names.sort_unstable();
    let near = nearest(wanted, names.iter().map(String::as_str))?;
    Some(path.with_file_name(near).display().to_string())
}

fn segment(s: &Segment) -> Option<String> {
    match s {
        Segment::Seq { index } => Some(index.to_string()),
        Segment::Map { key } => Some(key.clone()),
        Segment::Enum { .. } | Segment::Unknown => None,
    }
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

    /// A report on errors that a later stage found.
    #[must_use]
    pub fn refuse<'e>(&self, errors: impl IntoIterator<Item = &'e BuildError>) -> Report {
        let found = errors.into_iter().map(|e| self.locate(e)).collect();
        Report::new(found, Arc::clone(&self.source), Arc::clone(&self.overrides))
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
    pub fn reload<U: DeserializeOwned + JsonSchema>(&self, more: &[String]) -> Result<Loaded<U>, Report> {
        let overrides: Vec<String> = self.overrides.iter().chain(more).cloned().collect();
        load_source(Source::clone(&self.source), &overrides)
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
