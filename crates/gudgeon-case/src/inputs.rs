//! The inputs of a case as a program may offer them to a person: numbers to move, words and models to choose from.
//!
//! Everything comes from the schema and the resolved case, so inputs of models and scenes that are registered elsewhere are among them.

use gudgeon_core::quantity::{ALL_DIMENSIONS, Unit};
use serde::{Serialize, Serializer};
use serde_json::Value;

use super::schema::{Part, Schema, at, named, words_of};
use super::tree::{Data, Node, join};

/// An input of a case.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Input {
    /// Dotted path, as `--set` takes it.
    pub path: String,
    /// What it is.
    pub about: About,
    /// Line of the file that gives it, from 1; none for a default.
    pub line: Option<usize>,
    /// Its value.
    #[serde(flatten)]
    pub value: InputValue,
}

/// What an input is for, as its field in the schema says, or else its type.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct About(&'static str);

impl About {
    fn of(field: Part, schema: Part) -> Self {
        let text = at(field, "description").or_else(|| at(schema, "description")).and_then(Value::as_str);
        Self(text.unwrap_or_default())
    }

    /// All of it, as one line.
    #[must_use]
    pub fn told(self) -> String {
        flat(self.0)
    }

    /// Its first sentence, without the full stop.
    #[must_use]
    pub fn brief(self) -> String {
        let mut stops = self.0.match_indices('.').map(|(at, _)| at);
        let end = stops.find(|at| self.0[at + 1..].starts_with(char::is_whitespace));
        let first = &self.0[..end.unwrap_or(self.0.len())];
        flat(first.trim_end().trim_end_matches('.'))
    }
}

impl Serialize for About {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.told())
    }
}

/// The value of an input.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum InputValue {
    /// A number, with or without a unit.
    Number(NumberInput),
    /// One of several words or models.
    Choice(ChoiceInput),
}

/// A number, in the unit that the case writes, or in one that makes it easy to read.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NumberInput {
    /// The number.
    pub value: f64,
    /// Its unit; empty where it has none.
    pub unit: String,
    /// The dimension, `a length`; empty for a number without one.
    pub dimension: String,
    /// Whether it is a count.
    pub whole: bool,
    /// Least admitted value, in the unit.
    pub least: Option<f64>,
    /// Largest admitted value, in the unit.
    pub most: Option<f64>,
}

/// A word or the name of a model.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ChoiceInput {
    /// The word.
    pub value: String,
    /// The kind of the models; empty for other words.
    pub kind: String,
    /// What it may be.
    pub words: Words,
}

/// The words that an input may be.
#[derive(Debug, Clone, PartialEq)]
pub struct Words(Vec<Word>);

/// A word, and the schema that tells what it means, where there is one.
type Word = (&'static str, Option<Part>);

impl Words {
    /// How many there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.0.len()
    }

    /// Each word, and what it means.
    pub fn told(&self) -> impl Iterator<Item = (String, String)> + '_ {
        self.0.iter().map(|(word, meaning)| {
            ((*word).to_owned(), meaning.map_or_else(String::new, |s| About::of(s, s).told()))
        })
    }
}

impl Serialize for Words {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.told())
    }
}

/// The inputs of a resolved case, in its order; `text` and `document` are what the case wrote.
pub(super) fn inputs(schema: &Schema, resolved: &Value, text: &str, document: &Node) -> Vec<Input> {
    let newlines = text.bytes().enumerate().filter(|(_, b)| *b == b'\n');
    let lines = std::iter::once(0).chain(newlines.map(|(i, _)| i + 1)).collect();
    let mut walk = Walk { schema, lines, out: Vec::new() };
    if let Some(root) = Node::from_json(resolved) {
        walk.value((&root, Some(document)), schema.root(), schema.root(), "");
    }
    walk.out
}

struct Walk<'a> {
    schema: &'a Schema,
    /// Where each line of the text begins.
    lines: Vec<usize>,
    out: Vec<Input>,
}

impl Walk<'_> {
    /// `field` is the schema before references are followed: what the value is for stands there. `written` is what the case wrote in this place.
    fn value(&mut self, (node, written): (&Node, Option<&Node>), field: Part, schema: Part, path: &str) {
        let kind = self.kind_of(schema);
        let inner = self.schema.resolve(schema);
        let models = self.schema.model_of_word(inner);
        let kind = models.map_or(kind, |m| self.kind_of(m));
        let inner = models.map_or(inner, |m| self.schema.resolve(m));
        match &node.data {
            Data::Table(entries) => {
                let tagged = self.schema.tagged(inner);
                let table = match tagged {
                    Some(t) => t.chosen(self.schema, node),
                    None => Some(inner),
                };
                if let (Some(t), Some(Node { data: Data::Text(word), .. })) =
                    (tagged, tagged.and_then(|t| node.child(t.tag)))
                {
                    let words = Words(t.variants.iter().map(|(n, s)| (*n, Some(*s))).collect());
                    let value = ChoiceInput { value: word.clone(), kind: kind.into(), words };
                    let written = written.and_then(|w| w.child(t.tag));
                    self.add(&join(path, t.tag), written, About::of(field, inner), InputValue::Choice(value));
                }
                let properties = table.and_then(|t| at(t, "properties")).and_then(Value::as_object);
                for e in entries {
                    if let Some(s) = properties.and_then(|p| named(p, &e.key)) {
                        let written = written.and_then(|w| w.child(&e.key));
                        self.value((&e.node, written), s, s, &join(path, &e.key));
                    }
                }
            }
            Data::Array(items) => {
                for (k, item) in items.iter().enumerate() {
                    if let Some(s) = at(inner, "items") {
                        let key = k.to_string();
                        let written = written.and_then(|w| w.child(&key));
                        self.value((item, written), s, s, &join(path, &key));
                    }
                }
            }
            Data::Text(word) => match (at(inner, "x-dimension"), words_of(inner)) {
                (Some(_), _) => self.quantity((word, written), field, inner, path),
                (None, Some(words)) if words.len() > 1 => {
                    let words = Words(words.into_iter().map(|w| (w, None)).collect());
                    let value = ChoiceInput { value: word.clone(), kind: String::new(), words };
                    self.add(path, written, About::of(field, inner), InputValue::Choice(value));
                }
                _ => {}
            },
            Data::Integer(_) | Data::Float(_) => self.number((node, written), field, inner, path),
            Data::Bool(b) => {
                let words = Words(["true", "false"].map(|w| (w, None)).to_vec());
                let value = ChoiceInput { value: b.to_string(), kind: String::new(), words };
                self.add(path, written, About::of(field, inner), InputValue::Choice(value));
            }
            Data::Date => {}
        }
    }

    fn add(&mut self, path: &str, written: Option<&Node>, about: About, value: InputValue) {
        let span = written.and_then(|w| w.place.span.as_ref());
        let line = span.map(|s| self.lines.partition_point(|begin| *begin <= s.start));
        self.out.push(Input { path: path.to_owned(), about, line, value });
    }

    /// A number that the resolved case writes in SI.
    fn quantity(&mut self, (si, written): (&str, Option<&Node>), field: Part, schema: Part, path: &str) {
        let Some(si) = si.split(' ').next().and_then(|n| n.parse::<f64>().ok()) else { return };
        let dimension = at(schema, "x-dimension").and_then(Value::as_str).unwrap_or_default();
        let units = ALL_DIMENSIONS.iter().find(|(n, ..)| *n == dimension).map_or(&[][..], |(_, u, _)| u);
        let unit = written.and_then(|w| written_unit(w, units)).or_else(|| readable(si, units));
        let of_unit = |si: f64| unit.map_or(si, |u| rounded((si - u.offset) / u.factor));
        let (least, most) = match at(schema, "x-bound").and_then(Value::as_str) {
            Some("between 0 and 1") => (Some(0.0), Some(1.0)),
            Some("greater than zero" | "zero or greater") => (Some(0.0), None),
            _ => (None, None),
        };
        let number = NumberInput {
            value: of_unit(si),
            unit: unit.map_or_else(String::new, |u| u.name.to_owned()),
            dimension: dimension.to_owned(),
            whole: false,
            least: least.map(of_unit),
            most: most.map(of_unit),
        };
        self.add(path, written, About::of(field, schema), InputValue::Number(number));
    }

    fn number(&mut self, (node, written): (&Node, Option<&Node>), field: Part, schema: Part, path: &str) {
        if at(schema, "x-dimension").is_some() {
            if let Data::Integer(_) | Data::Float(_) = node.data {
                let text = match node.data {
                    Data::Integer(i) => i.to_string(),
                    Data::Float(f) => f.to_string(),
                    _ => return,
                };
                self.quantity((&text, written), field, schema, path);
            }
            return;
        }
        let limit = |key: &str| at(schema, key).and_then(Value::as_f64);
        let (value, whole) = match node.data {
            Data::Integer(i) => (i as f64, at(schema, "type").and_then(Value::as_str) == Some("integer")),
            Data::Float(f) => (f, false),
            _ => return,
        };
        let number = NumberInput {
            value,
            unit: String::new(),
            dimension: String::new(),
            whole,
            least: limit("minimum").or_else(|| limit("exclusiveMinimum")),
            most: limit("maximum").or_else(|| limit("exclusiveMaximum")),
        };
        self.add(path, written, About::of(field, schema), InputValue::Number(number));
    }

    /// The kind that a reference names: the definition of a kind's models has its name.
    fn kind_of(&self, schema: Part) -> &'static str {
        let reference = |s: Part| at(s, "$ref").and_then(Value::as_str);
        let optional = || {
            let any = at(schema, "anyOf").and_then(Value::as_array)?;
            any.iter().find_map(reference)
        };
        let named = reference(schema).or_else(optional).and_then(|r| r.rsplit('/').next());
        named.unwrap_or_default()
    }
}

/// The unit that the case itself writes; a bare number is SI.
fn written_unit(written: &Node, units: &'static [Unit]) -> Option<&'static Unit> {
    match &written.data {
        Data::Text(t) => {
            let name = t.trim_start_matches(|c: char| c.is_ascii_digit() || "+-.eE ".contains(c)).trim();
            units.iter().find(|u| u.is(name))
        }
        Data::Integer(_) | Data::Float(_) => units.first(),
        _ => None,
    }
}

/// A text as one line, with single spaces between its words.
pub(super) fn flat(text: &str) -> String {
    let bytes = text.as_bytes();
    // Nearly all are so as they stand, which a look at their bytes tells where no other letters are among them.
    let plain = bytes.iter().all(|b| b.is_ascii_graphic() || *b == b' ')
        && !bytes.windows(2).any(|two| two == b"  ")
        && !text.starts_with(' ')
        && !text.ends_with(' ');
    if plain {
        return text.to_owned();
    }
    let mut line = String::with_capacity(text.len());
    for word in text.split_whitespace() {
        if !line.is_empty() {
            line.push(' ');
        }
        line.push_str(word);
    }
    line
}

/// The unit in which a number has one to three digits before its point; temperatures are read in degrees Celsius, speeds of rotation in rpm.
fn readable(si: f64, units: &'static [Unit]) -> Option<&'static Unit> {
    let named = |name: &str| units.iter().find(|u| u.name == name);
    if let Some(u) = named("degC").or_else(|| named("rpm")).or_else(|| named("deg")) {
        return Some(u);
    }
    let written =
        |u: &&Unit| (1.0..1000.0).contains(&(si.abs() / u.factor)) && u.name != "in" && u.name != "cm";
    units.iter().find(written).or(units.first())
}

/// Without the rounding of the change of units: 120 mm and not 119.99999999999999.
fn rounded(value: f64) -> f64 {
    // A whole number of at most twelve digits has no other digits to be rounded.
    if value.fract() == 0.0 && value.abs() < 1e12 {
        return value;
    }
    format!("{value:.11e}").parse().unwrap_or(value)
}
