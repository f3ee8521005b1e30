//! What is wrong with a value, in the words of this program: names of Rust types are nobody's business.

use std::cell::RefCell;
use std::fmt;

use serde::de::{Expected, Unexpected};

/// A value that cannot be read: where, and why.
#[derive(Debug, Clone, PartialEq)]
pub struct Error {
    path: String,
    what: What,
}

#[derive(Debug, Clone, PartialEq)]
enum What {
    /// A sentence.
    Said(String),
    /// A name that is none of the `valid` ones; `what` is a key or a word.
    Unknown { what: &'static str, name: String, valid: Vec<&'static str> },
}

thread_local! {
    /// An error on its way through the error type of somebody else, who may be us.
    static HANDED_ON: RefCell<Option<Error>> = const { RefCell::new(None) };
}

impl Error {
    fn said(text: String) -> Self {
        Self { path: String::new(), what: What::Said(text) }
    }

    /// A word that is none of the valid ones.
    pub(crate) fn unknown_word(name: String, valid: Vec<&'static str>) -> Self {
        Self { path: String::new(), what: What::Unknown { what: "word", name, valid } }
    }

    /// Path from the value that was read to the one that is wrong, `rings.0.gap`; empty for the value itself.
    #[must_use]
    pub fn path(&self) -> &str {
        &self.path
    }

    /// For a key or a word that does not exist: which of the two it is, its name, and those that exist.
    #[must_use]
    pub fn unknown(&self) -> Option<(&'static str, &str, &[&'static str])> {
        match &self.what {
            What::Unknown { what, name, valid } => Some((what, name, valid)),
            What::Said(_) => None,
        }
    }

    /// The same error, seen from the table or list in which the value stands at `step`.
    #[cold]
    #[must_use]
    pub(crate) fn under(mut self, step: &str) -> Self {
        self.path = if self.path.is_empty() { step.to_owned() } else { format!("{step}.{}", self.path) };
        self
    }

    /// As an error of the type `E`: whole when that is this type again, as text otherwise.
    pub fn hand_on<E: serde::de::Error>(self) -> E {
        let text = self.to_string();
        HANDED_ON.set(Some(self));
        let as_theirs = E::custom(text);
        HANDED_ON.take();
        as_theirs
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.what {
            What::Said(text) => f.write_str(text),
            What::Unknown { what, name, valid } if valid.is_empty() => {
                write!(f, "unknown {what} `{name}`; none is valid")
            }
            What::Unknown { what, name, valid } => {
                write!(f, "unknown {what} `{name}`; valid ones: `{}`", valid.join("`, `"))
            }
        }
    }
}

impl std::error::Error for Error {}

impl serde::de::Error for Error {
    fn custom<T: fmt::Display>(what: T) -> Self {
        HANDED_ON.take().unwrap_or_else(|| Self::said(what.to_string()))
    }
    fn invalid_type(found: Unexpected<'_>, wanted: &dyn Expected) -> Self {
        Self::said(format!(
            "{} is wanted here, not {}",
            self::wanted(&wanted.to_string()),
            self::found(found)
        ))
    }
    fn invalid_value(found: Unexpected<'_>, wanted: &dyn Expected) -> Self {
        Self::invalid_type(found, wanted)
    }
    fn invalid_length(length: usize, wanted: &dyn Expected) -> Self {
        Self::said(format!("{length} values stand here, {wanted} is wanted"))
    }
    fn unknown_variant(name: &str, valid: &'static [&'static str]) -> Self {
        Self::unknown_word(name.to_owned(), valid.to_vec())
    }
    fn unknown_field(name: &str, valid: &'static [&'static str]) -> Self {
        let (name, valid) = (name.to_owned(), valid.to_vec());
        Self { path: String::new(), what: What::Unknown { what: "key", name, valid } }
    }
    fn missing_field(name: &'static str) -> Self {
        Self::said(format!("missing key `{name}`"))
    }
    fn duplicate_field(name: &'static str) -> Self {
        Self::said(format!("second key `{name}`"))
    }
}

/// What stands there.
fn found(what: Unexpected<'_>) -> String {
    match what {
        Unexpected::Unsigned(n) => format!("the number {n}"),
        Unexpected::Signed(n) => format!("the number {n}"),
        Unexpected::Float(n) => format!("the number {n:?}"),
        Unexpected::Str(text) => format!("the text `{text}`"),
        Unexpected::Bool(b) => format!("`{b}`"),
        Unexpected::Unit | Unexpected::Option => "nothing".into(),
        Unexpected::Map | Unexpected::Enum | Unexpected::NewtypeStruct => "a table".into(),
        Unexpected::Seq | Unexpected::TupleVariant => "an array".into(),
        other => other.to_string(),
    }
}

/// What the reading type wants, whose own words those of `text` are.
fn wanted(text: &str) -> String {
    let unsigned = |bits: u32| format!("a whole number from 0 to {}", u64::MAX >> (64 - bits));
    let signed = |bits: u32| {
        let max = i64::MAX >> (64 - bits);
        format!("a whole number from {} to {max}", -max - 1)
    };
    match text.split(' ').next().unwrap_or_default() {
        "u8" => unsigned(8),
        "u16" => unsigned(16),
        "u32" => unsigned(32),
        "u64" | "usize" => unsigned(64),
        "i8" => signed(8),
        "i16" => signed(16),
        "i32" => signed(32),
        "i64" | "isize" => signed(64),
        "f32" | "f64" => "a number".into(),
        "struct" | "internally" | "adjacently" | "map" | "enum" => "a table".into(),
        "tuple" | "sequence" => "an array".into(),
        "unit" => "nothing".into(),
        "variant" => "one of the words".into(),
        _ => match text {
            "a boolean" => "`true` or `false`".into(),
            "a string" | "a borrowed string" => "a text in quotes".into(),
            "a sequence" => "an array".into(),
            "a map" => "a table".into(),
            _ => text.to_owned(),
        },
    }
}
