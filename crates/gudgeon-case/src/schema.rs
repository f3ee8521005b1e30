//! Checks a document against the JSON schema of what it should become, and reports every mistake with its place.
//!
//! Deserialisation stops at the first mistake; this walk does not. The schema comes from the same types, so both agree, and
//! deserialisation still has the last word.

use std::any::TypeId;
use std::collections::{HashMap, HashSet};
use std::sync::{Mutex, PoisonError, RwLock};

use gudgeon_core::quantity::{self, ALL_DIMENSIONS, QuantityError};
use gudgeon_core::sets::{SET, X_SETS};
use serde_json::{Map, Value};

use super::near::{advice, list, nearest};
use super::parts::Parts;
use super::report::{Diagnostic, MAX_MISTAKES, Origin};
use super::tree::{Data, Entry, Node, Place, join, steps};

/// A part of a schema. Schemas live as long as the program.
pub(super) type Part = &'static Value;

/// A root schema with the parts that it names.
#[derive(Debug)]
pub(super) struct Schema {
    root: Part,
    parts: Parts,
    /// The choices that were looked at, by the address of the part: what they are told apart by is found once.
    choices: RwLock<HashMap<usize, Option<&'static Tagged>>>,
}

/// Most values of an array that does not say its own maximum.
pub(super) const MAX_ITEMS: usize = 100_000;

/// Nesting of schemas without a value in between (references, options); only a schema that refers to itself has more.
const MAX_REFERENCES: usize = 32;

/// Ranges of bare numbers that no power cylinder has but a number with a forgotten unit does: dimension, from, below, the
/// unit that was probably meant.
const IMPROBABLE: &[(&str, f64, f64, &str)] = &[
    ("a length", 2.0, f64::INFINITY, "mm"),
    ("a temperature", 0.0, 200.0, "degC"),
    ("a pressure", 1e-3, 1000.0, "bar"),
    ("a mass", 100.0, f64::INFINITY, "g"),
];

impl Schema {
    /// The schema of a type: generated once and kept, for a study reads its case thousands of times.
    pub fn of<T: schemars::JsonSchema + 'static>() -> &'static Self {
        static KNOWN: Mutex<Option<HashMap<TypeId, &'static Schema>>> = Mutex::new(None);
        // What a panicking thread left is whole: entries are only ever added.
        let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
        known.get_or_insert_default().entry(TypeId::of::<T>()).or_insert_with(|| {
            let (root, parts) = Parts::of::<T>();
            // One a type and program, for the whole life of it.
            Box::leak(Box::new(Self { root, parts, choices: RwLock::default() }))
        })
    }

    pub const fn root(&self) -> Part {
        self.root
    }

    /// The tables that a schema has to choose from by the value of one key.
    pub fn tagged(&self, schema: Part) -> Option<&'static Tagged> {
        let place = std::ptr::from_ref(schema).addr();
        if let Some(known) = self.choices.read().unwrap_or_else(PoisonError::into_inner).get(&place) {
            return *known;
        }
        let found = Tagged::of(self, schema).map(|t| &*Box::leak(Box::new(t)));
        // The first to come stays: no more of them are kept than the schema has choices, but for threads that come together.
        *self.choices.write().unwrap_or_else(PoisonError::into_inner).entry(place).or_insert(found)
    }

    /// Follows references and drops the `null` alternative of an optional value.
    pub fn resolve(&self, mut schema: Part) -> Part {
        for _ in 0..MAX_REFERENCES {
            if let Some(target) = at(schema, "$ref").and_then(Value::as_str) {
                match self.target(target) {
                    Some(table) => schema = self.parts.demanding(schema, table),
                    None => return &Value::Bool(true),
                }
                continue;
            }
            // `oneOf` is a choice even when only one model is linked; the others are how schemars writes an option.
            if at(schema, "oneOf").is_some() {
                break;
            }
            let mut rest = alternatives(schema).into_iter().flatten().filter(|s| !is_null(s));
            match (rest.next(), rest.next()) {
                (Some(only), None) => schema = only,
                _ => break,
            }
        }
        schema
    }

    /// What a reference names.
    fn target(&self, reference: &str) -> Option<Part> {
        match reference.strip_prefix("#/$defs/") {
            Some(name) => self.parts.named(name),
            _ => self.root.pointer(reference.strip_prefix('#')?),
        }
    }

    /// Whether a text, or one of some words, is what a value must be.
    pub fn wants_text(&self, schema: Part) -> bool {
        let schema = self.resolve(schema);
        types_of(schema) == ["string"] || words_of(schema).is_some_and(|w| !w.is_empty())
    }

    /// Keys that the outermost table must have.
    pub fn required(&self) -> Vec<&'static str> {
        strings(at(self.root, "required"))
    }

    /// Keys of a document that nothing reads: those of an outer table that are not among what its field says is used (`x-used`).
    pub fn unused(&self, document: &Node) -> Vec<String> {
        let tables = at(self.root, "properties").and_then(Value::as_object).into_iter().flatten();
        let mut out = Vec::new();
        for (name, field) in tables.filter(|(_, field)| field.get("x-used").is_some()) {
            let used = strings(field.get("x-used"));
            if let Some(Node { data: Data::Table(entries), .. }) = document.child(name) {
                let idle = entries.iter().map(|e| e.key.as_str()).filter(|k| !used.contains(k));
                out.extend(idle.map(|key| join(name, key)));
            }
        }
        out
    }

    /// The schema of one field or element, before references are followed (its `default` stands there).
    pub fn field(&self, schema: Part, node: Option<&Node>, step: &str) -> Option<Part> {
        let schema = self.resolve(schema);
        let schema = self.model_of_word(schema).unwrap_or(schema);
        if step.parse::<usize>().is_ok() && at(schema, "items").is_some() {
            return at(schema, "items");
        }
        property(self.chosen(schema, node)?, step)
    }

    /// The table that a document asks for, where a schema has several to choose from; else the schema itself.
    fn chosen(&self, schema: Part, node: Option<&Node>) -> Option<Part> {
        self.tagged(schema).map_or(Some(schema), |tagged| tagged.chosen(self, node?))
    }

    /// What a value is read by: the table that it asks for where there are several, references followed.
    pub fn table_of(&self, schema: Part, node: &Node) -> Option<Part> {
        let schema = self.resolve(schema);
        self.chosen(self.model_of_word(schema).unwrap_or(schema), Some(node))
    }

    /// The models that a word of this schema names: what `hoop = "as_printed"` says as the table `hoop = { model = "as_printed" }`.
    pub fn model_of_word(&self, schema: Part) -> Option<Part> {
        let alternatives = alternatives(self.resolve(schema))?;
        let [word, table] = alternatives[..] else { return None };
        let (word, table) = (self.resolve(word), self.resolve(table));
        (words_of(word).is_some() && self.tagged(table).is_some()).then_some(table)
    }

    /// The first [`MAX_MISTAKES`] mistakes of the document; what the whole file lacks is told at its end.
    pub fn check(&self, document: &Node, end_of_file: usize) -> Vec<Diagnostic> {
        let mut out = Vec::new();
        self.value(document, self.root, "", &mut out);
        for d in out.iter_mut().filter(|d| d.span.is_none() && d.origin == Origin::File) {
            d.span = Some(end_of_file..end_of_file);
        }
        out
    }

    /// Numbers without a unit that are possible but improbable in SI: `bore = 120`, a temperature of 150. To be called on a
    /// document without mistakes.
    pub fn improbable(&self, document: &Node) -> Vec<String> {
        let mut out = Vec::new();
        self.look_for_improbable(document, self.root, "", &mut out);
        out
    }

    fn look_for_improbable(&self, node: &Node, schema: Part, path: &str, out: &mut Vec<String>) {
        let schema = self.resolve(schema);
        let number = match &node.data {
            Data::Integer(i) => *i as f64,
            Data::Float(f) => *f,
            Data::Table(entries) => {
                let Some(table) = self.table_of(schema, node) else { return };
                for e in entries {
                    if let Some(s) = property(table, &e.key) {
                        self.look_for_improbable(&e.node, s, &join(path, &e.key), out);
                    }
                }
                return;
            }
            Data::Array(items) => {
                for (i, item) in items.iter().enumerate() {
                    if let Some(s) = at(schema, "items") {
                        self.look_for_improbable(item, s, &join(path, &i.to_string()), out);
                    }
                }
                return;
            }
            _ => return,
        };
        if let Some(dimension) = at(schema, "x-dimension").and_then(Value::as_str)
            && let Some((_, _, _, example)) = IMPROBABLE
                .iter()
                .find(|(d, least, most, _)| *d == dimension && number.abs() >= *least && number.abs() < *most)
        {
            let si = units_of(dimension).first().copied().unwrap_or_default();
            let n = number_text(number);
            out.push(format!(
                "{path} is {n} {si}: a number without a unit is SI; `\"{n} {example}\"` has one"
            ));
        }
    }

    fn value(&self, node: &Node, schema: Part, path: &str, out: &mut Vec<Diagnostic>) {
        if out.len() >= MAX_MISTAKES {
            return;
        }
        let schema = self.resolve(schema);
        if let Some(dimension) = at(schema, "x-dimension").and_then(Value::as_str) {
            let bound = at(schema, "x-bound").and_then(Value::as_str).unwrap_or_default();
            return check_quantity(node, dimension, bound, path, out);
        }
        if let Some(words) = words_of(schema) {
            return check_word(node, &words, path, out);
        }
        if let Some(tagged) = self.tagged(schema) {
            return self.choice(node, tagged, path, out);
        }
        if let Some(variants) = alternatives(schema) {
            return self.any_of(node, &variants, path, out);
        }
        let types = types_of(schema);
        if !types.is_empty() && !types.iter().any(|t| admits(t, &node.data)) {
            let d = wrong_type(node, &phrase(&types), path);
            return out.push(match number_in_text(node, &types) {
                Some(help) => d.help(help),
                None => d,
            });
        }
        match &node.data {
            Data::Table(entries) => self.table(node, entries, schema, &[], path, out),
            Data::Array(items) => self.array(node, items, schema, path, out),
            Data::Integer(i) => check_range(node, *i as f64, schema, path, out),
            Data::Float(f) => check_range(node, *f, schema, path, out),
            Data::Text(_) | Data::Bool(_) | Data::Date => {}
        }
    }

    fn table(
        &self,
        node: &Node,
        entries: &[Entry],
        schema: Part,
        skip: &[&str],
        path: &str,
        out: &mut Vec<Diagnostic>,
    ) {
        let properties = at(schema, "properties").and_then(Value::as_object);
        let own = |key: &str| properties.and_then(|p| named(p, key));
        let other = at(schema, "additionalProperties");
        let known: Vec<&str> = properties.into_iter().flatten().map(|(key, _)| key.as_str()).collect();
        let present: HashSet<&str> = entries.iter().map(|e| e.key.as_str()).collect();
        let absent = |key: &&str| !present.contains(*key);
        let mut missing: Vec<&str> =
            strings(at(schema, "required")).into_iter().filter(|k| absent(k) && !skip.contains(k)).collect();

        let sets = at(schema, X_SETS).and_then(Value::as_object);
        if sets.is_some() && present.contains(SET) {
            // What it would give is not missing as well.
            missing.clear();
        }
        for e in entries {
            if out.len() >= MAX_MISTAKES {
                return;
            }
            if let Some(sets) = sets.filter(|_| e.key == SET) {
                out.push(no_such_set(&e.node, sets, &join(path, SET)));
            } else if let Some(s) = own(&e.key) {
                if !skip.contains(&e.key.as_str()) {
                    self.value(&e.node, s, &join(path, &e.key), out);
                }
            } else if let Some(s) = other.filter(|o| o.is_object()) {
                self.value(&e.node, s, &join(path, &e.key), out);
            } else if other == Some(&Value::Bool(false)) {
                // A key that is probably a misspelt required one explains the missing one too.
                let near = nearest(&e.key, known.iter().filter(|k| absent(k)).copied());
                missing.retain(|m| Some(*m) != near);
                let mut d = Diagnostic::new(format!("unknown key `{}`", e.key))
                    .path(path)
                    .at(e.key_place.origin, e.key_place.span.clone());
                if let Some(now) = renamed(schema, &e.key) {
                    missing.retain(|m| *m != now);
                    out.push(d.help(format!("{RENAMED} `{now}` now")));
                    continue;
                }
                let elsewhere = if near.is_some() { Vec::new() } else { self.homes_of(&e.key, path) };
                d = d.help(match (near, elsewhere.first()) {
                    (None, Some(home)) => {
                        format!("`{}` belongs to {home}; {}", e.key, advice(&e.key, &known))
                    }
                    (Some(near), _) if known.len() > 1 => {
                        format!("did you mean `{near}`? valid: {}", list(known.iter().copied()))
                    }
                    _ => advice(&e.key, &known),
                });
                out.push(d);
            }
        }
        if !missing.is_empty() {
            let what = if missing.len() == 1 { "missing key" } else { "missing keys" };
            let mut d = Diagnostic::new(format!("{what} {}", list(missing.iter().copied()))).path(path);
            d = d.at(node.place.origin, node.place.span.clone());
            let texts: Vec<String> = missing.iter().filter_map(|k| self.meaning(k, own(k)?)).collect();
            if !texts.is_empty() {
                d = d.help(texts.join("\n"));
            }
            out.push(d);
        }
    }

    /// What a missing key is for, and which models could stand there.
    fn meaning(&self, key: &str, schema: Part) -> Option<String> {
        let inner = self.resolve(schema);
        let text = at(schema, "description").or_else(|| at(inner, "description")).and_then(Value::as_str);
        let models = self.tagged(inner).map(|t| format!("one of the models {}", list(t.names())));
        let words = words_of(inner).map(|w| format!("one of {}", list(w)));
        let parts: Vec<String> = text.map(first_sentence).into_iter().chain(models).chain(words).collect();
        (!parts.is_empty()).then(|| format!("`{key}`: {}", parts.join("; ")))
    }

    fn array(&self, node: &Node, items: &[Node], schema: Part, path: &str, out: &mut Vec<Diagnostic>) {
        let limit = |key: &str| at(schema, key).and_then(Value::as_u64);
        let n = items.len() as u64;
        let most = limit("maxItems").unwrap_or(MAX_ITEMS as u64);
        let wanted = match limit("minItems") {
            Some(a) if a == most && n != a => format!("exactly {a}"),
            Some(a) if n < a => format!("at least {a}"),
            _ if n > most => format!("at most {most}"),
            _ => {
                let prefix = at(schema, "prefixItems").and_then(Value::as_array);
                for (i, item) in items.iter().enumerate() {
                    let own = prefix.and_then(|p| p.get(i));
                    if let Some(s) = own.or_else(|| at(schema, "items")) {
                        self.value(item, s, &join(path, &i.to_string()), out);
                    }
                }
                return;
            }
        };
        let message =
            format!("{n} {} given, {wanted} wanted", if n == 1 { "value is" } else { "values are" });
        out.push(Diagnostic::new(message).path(path).at(node.place.origin, node.place.span.clone()));
    }

    fn choice(&self, node: &Node, tagged: &Tagged, path: &str, out: &mut Vec<Diagnostic>) {
        let here = |d: Diagnostic, p: &Place| d.path(path).at(p.origin, p.span.clone());
        let (tag, names) = (tagged.tag, tagged.names());
        let Data::Table(entries) = &node.data else {
            let mut d = wrong_type(node, &format!("a table with the key `{tag}`"), path);
            if let Data::Text(t) = &node.data {
                let name = nearest(t, names.iter().copied()).unwrap_or(t);
                let key = path.rsplit('.').next().unwrap_or(path);
                d = d.help(if node.place.origin == Origin::File {
                    format!("write `{key} = {{ {tag} = \"{name}\" }}`")
                } else {
                    format!("set `{path}.{tag}={name}`")
                });
            }
            return out.push(d);
        };
        let Some(chosen) = entries.iter().find(|e| e.key == tag) else {
            if let Some(variant) = tagged.default.and_then(|name| tagged.variant(self, name)) {
                return self.table(node, entries, variant, &[tag], path, out);
            }
            let what = Diagnostic::new(format!("missing key `{tag}`"));
            let stray = |e: &&Entry| nearest(&e.key, [tag]).is_some() && !tagged.has_key(self, &e.key);
            let near = entries.iter().find(stray);
            return out.push(match near {
                Some(e) => here(Diagnostic::new(format!("unknown key `{}`", e.key)), &e.key_place)
                    .help(format!("did you mean `{tag}`?")),
                None => here(what, &node.place).help(advice("", &names)),
            });
        };
        let Data::Text(name) = &chosen.node.data else {
            return out.push(wrong_type(&chosen.node, "a name", &join(path, tag)).help(advice("", &names)));
        };
        match tagged.variant(self, name) {
            Some(variant) => self.table(node, entries, variant, &[tag], path, out),
            None => {
                if let Some(now) = tagged.renamed.and_then(|r| r.get(name)).and_then(Value::as_str) {
                    let what = Diagnostic::new(format!("`{name}` is no longer a {tag}"));
                    return out.push(here(what, &chosen.node.place).help(now));
                }
                let what = if tag == "model" {
                    format!("there is no {} model `{name}`", path.rsplit('.').next().unwrap_or_default())
                } else {
                    format!("unknown {tag} `{name}`")
                };
                out.push(here(Diagnostic::new(what), &chosen.node.place).help(advice(name, &names)));
            }
        }
    }

    /// Alternatives that no tag tells apart: right when one fits, else the complaint of the one that fits best.
    fn any_of(&self, node: &Node, variants: &[Part], path: &str, out: &mut Vec<Diagnostic>) {
        let mut best: Option<Vec<Diagnostic>> = None;
        for v in variants.iter().filter(|v| !is_null(v)) {
            let v = self.resolve(v);
            let types = types_of(v);
            let mut found = Vec::new();
            self.value(node, v, path, &mut found);
            if found.is_empty() {
                return;
            }
            let fits = types.is_empty() || types.iter().any(|t| admits(t, &node.data));
            if fits && best.as_ref().is_none_or(|b| found.len() < b.len()) {
                best = Some(found);
            }
        }
        match best {
            Some(found) => out.extend(found),
            None => {
                let wanted: Vec<_> = variants.iter().flat_map(|v| types_of(self.resolve(v))).collect();
                out.push(wrong_type(node, &phrase(&wanted), path));
            }
        }
    }

    /// Where else a key is valid: `[engine]`, `[[rings]]`, `the top of the file`.
    fn homes_of(&self, key: &str, except: &str) -> Vec<String> {
        let mut homes = Vec::new();
        self.search(self.root, "", false, 0, &mut |path, in_array, properties| {
            if path != except && properties.contains_key(key) {
                homes.push(match (path, in_array) {
                    ("", _) => "the top of the file, before the first table".to_owned(),
                    (p, true) => format!("`[[{p}]]`"),
                    (p, false) => format!("`[{p}]`"),
                });
            }
        });
        let index_free: String =
            except.split('.').filter(|s| s.parse::<usize>().is_err()).collect::<Vec<_>>().join(".");
        homes.retain(|h| *h != format!("`[[{index_free}]]`"));
        homes
    }

    /// Visits every plain table that the schema has: its path without indices, whether it is an element of an array, its
    /// properties. Models are left out.
    fn search(&self, schema: Part, path: &str, in_array: bool, depth: usize, visit: &mut Visit<'_>) {
        const DEPTH: usize = 4;
        let schema = self.resolve(schema);
        if let Some(items) = at(schema, "items") {
            return self.search(items, path, true, depth, visit);
        }
        let Some(properties) = at(schema, "properties").and_then(Value::as_object) else { return };
        visit(path, in_array, properties);
        if depth < DEPTH {
            for (key, s) in properties {
                self.search(s, &join(path, key), false, depth + 1, visit);
            }
        }
    }

    /// The existing dotted path nearest to one that does not exist. Array indices of `wanted` are taken over.
    pub fn nearest_path(&self, wanted: &str) -> Option<String> {
        let mut paths = Vec::new();
        self.search(self.root, "", false, 0, &mut |path, in_array, properties| {
            for key in properties.keys() {
                paths.push(if in_array { format!("{path}.0.{key}") } else { join(path, key) });
            }
        });
        let asked: Vec<String> = steps(wanted, 0).into_iter().map(|s| s.text).collect();
        let last = asked.last()?;
        let index = asked.iter().find(|s| s.parse::<usize>().is_ok());
        let same_leaf = paths.iter().filter(|p| p.rsplit('.').next() == Some(last));
        let found =
            same_leaf.min_by_key(|p| strsim::damerau_levenshtein(wanted, p)).cloned().or_else(|| {
                // The table that a key is looked for in is no advice on the key.
                let above = |p: &str| wanted.strip_prefix(p).is_some_and(|rest| rest.starts_with('.'));
                let others = paths.iter().map(String::as_str).filter(|p| !above(p));
                nearest(&asked.join("."), others).map(str::to_owned)
            })?;
        Some(match index {
            Some(i) => found.replace(".0.", &format!(".{i}.")),
            None => found,
        })
    }
}

type Visit<'a> = dyn FnMut(&str, bool, &Map<String, Value>) + 'a;

/// What a schema says under a key. Its tables have few keys: to go through them takes less than to hash the one that is looked for.
pub(super) fn at<'v>(schema: &'v Value, key: &str) -> Option<&'v Value> {
    named(schema.as_object()?, key)
}

pub(super) fn named<'v>(table: &'v Map<String, Value>, key: &str) -> Option<&'v Value> {
    table.iter().find(|(own, _)| *own == key).map(|(_, value)| value)
}

/// The schema of a key of a table.
pub(super) fn property(table: Part, key: &str) -> Option<Part> {
    let own = at(table, "properties").and_then(|p| at(p, key));
    own.or_else(|| at(table, "additionalProperties").filter(|a| a.is_object()))
}

/// Tables told apart by the constant value of one key.
#[derive(Debug)]
pub(super) struct Tagged {
    pub tag: &'static str,
    /// The one that is meant where the key is missing (`x-default`).
    pub default: Option<&'static str>,
    /// What became of names that were valid once (`x-renamed`).
    renamed: Option<&'static Map<String, Value>>,
    /// Name of each, and what is known of it without reading more: of a model its outline.
    pub variants: Vec<(&'static str, Part)>,
}

impl Tagged {
    fn of(schemas: &Schema, schema: Part) -> Option<Self> {
        let all: Vec<Part> = alternatives(schema)?.into_iter().map(|s| schemas.resolve(s)).collect();
        let properties = |s: Part| at(s, "properties").and_then(Value::as_object);
        let constant = |s: Part, key: &str| at(named(properties(s)?, key)?, "const")?.as_str();
        let tag = properties(all.first()?)?.keys().find(|k| all.iter().all(|s| constant(s, k).is_some()))?;
        let variants = all.iter().filter_map(|s| Some((constant(s, tag)?, *s))).collect();
        let default = at(schema, "x-default").and_then(Value::as_str);
        Some(Self { tag, default, renamed: at(schema, "x-renamed").and_then(Value::as_object), variants })
    }

    pub fn names(&self) -> Vec<&'static str> {
        self.variants.iter().map(|(n, _)| *n).collect()
    }

    fn has_key(&self, schemas: &Schema, key: &str) -> bool {
        let has = |s: Part| s.get("properties").is_some_and(|p| p.get(key).is_some());
        self.variants.iter().any(|(_, s)| has(schemas.parts.whole(s)))
    }

    /// The alternative that a table asks for.
    pub fn chosen(&self, schemas: &Schema, node: &Node) -> Option<Part> {
        match node.child(self.tag).map(|n| &n.data) {
            Some(Data::Text(name)) => self.variant(schemas, name),
            Some(_) => None,
            None => self.variant(schemas, self.default?),
        }
    }

    /// The alternative of a name.
    pub fn variant(&self, schemas: &Schema, name: &str) -> Option<Part> {
        self.variants.iter().find(|(n, _)| *n == name).map(|(_, s)| schemas.parts.whole(s))
    }

    /// The first alternative.
    pub fn first(&self, schemas: &Schema) -> Option<Part> {
        self.variants.first().map(|(_, s)| schemas.parts.whole(s))
    }
}

/// How the advice on a key with an old name begins.
pub(super) const RENAMED: &str = "it is called";

/// What a key is called today that had another name once (`x-renamed`).
fn renamed<'a>(schema: &'a Value, key: &str) -> Option<&'a str> {
    at(schema, "x-renamed")?.get(key)?.as_str()
}

fn alternatives(schema: &Value) -> Option<Vec<&Value>> {
    let v = at(schema, "oneOf").or_else(|| at(schema, "anyOf")).or_else(|| at(schema, "allOf"))?;
    v.as_array().map(|a| a.iter().collect())
}

fn is_null(schema: &Value) -> bool {
    at(schema, "type").and_then(Value::as_str) == Some("null")
}

pub(super) fn strings(v: Option<&Value>) -> Vec<&str> {
    v.and_then(Value::as_array).map_or_else(Vec::new, |a| a.iter().filter_map(Value::as_str).collect())
}

pub(super) fn types_of(schema: &Value) -> Vec<&str> {
    match at(schema, "type") {
        Some(Value::String(t)) => vec![t],
        list => strings(list).into_iter().filter(|t| *t != "null").collect(),
    }
}

/// The admitted words, when the schema is nothing but a choice of words.
pub(super) fn words_of(schema: &Value) -> Option<Vec<&str>> {
    if let Some(word) = at(schema, "const").and_then(Value::as_str) {
        return Some(vec![word]);
    }
    if at(schema, "enum").is_some() {
        return Some(strings(at(schema, "enum")));
    }
    let mut words = Vec::new();
    for s in alternatives(schema)?.into_iter().filter(|s| !is_null(s)) {
        words.extend(words_of(s)?);
    }
    Some(words)
}

fn admits(kind: &str, data: &Data) -> bool {
    match kind {
        "string" => matches!(data, Data::Text(_)),
        "number" => matches!(data, Data::Integer(_) | Data::Float(_)),
        "integer" => matches!(data, Data::Integer(_)),
        "boolean" => matches!(data, Data::Bool(_)),
        "array" => matches!(data, Data::Array(_)),
        "object" => matches!(data, Data::Table(_)),
        _ => false,
    }
}

pub(super) fn phrase(types: &[&str]) -> String {
    let mut words: Vec<&str> = types
        .iter()
        .map(|t| match *t {
            "string" => "a text in quotes",
            "number" => "a number",
            "integer" => "a whole number",
            "boolean" => "`true` or `false`",
            "array" => "an array",
            "object" => "a table",
            other => other,
        })
        .collect();
    words.dedup();
    words.join(" or ")
}

fn wrong_type(node: &Node, wanted: &str, path: &str) -> Diagnostic {
    Diagnostic::new(format!("{wanted} is wanted here, not {}", node.noun()))
        .path(path)
        .at(node.place.origin, node.place.span.clone())
}

/// What is wrong with the name of a parameter set: those that exist are no longer in the document.
fn no_such_set(node: &Node, sets: &Map<String, Value>, path: &str) -> Diagnostic {
    let names: Vec<&str> = sets.keys().map(String::as_str).collect();
    let Data::Text(name) = &node.data else {
        return wrong_type(node, "the name of a parameter set", path).help(advice("", &names));
    };
    let what = format!("there is no parameter set `{}`", shorten(name));
    Diagnostic::new(what).path(path).at(node.place.origin, node.place.span.clone()).help(advice(name, &names))
}

fn check_range(node: &Node, v: f64, schema: &Value, path: &str, out: &mut Vec<Diagnostic>) {
    let limit = |key: &str| at(schema, key).and_then(Value::as_f64);
    let wanted = if !v.is_finite() {
        Some("finite".to_owned())
    } else if let Some(a) = limit("minimum").filter(|a| v < *a) {
        Some(if a == 0.0 { "zero or greater".to_owned() } else { format!("at least {a}") })
    } else if let Some(b) = limit("maximum").or_else(|| most_of(schema)).filter(|b| v > *b) {
        Some(format!("at most {b}"))
    } else if let Some(a) = limit("exclusiveMinimum").filter(|a| v <= *a) {
        Some(format!("greater than {a}"))
    } else {
        limit("exclusiveMaximum").filter(|b| v >= *b).map(|b| format!("less than {b}"))
    };
    if let Some(w) = wanted {
        let d = Diagnostic::new(format!("`{}` must be {w}", number_text(v)));
        out.push(d.path(path).at(node.place.origin, node.place.span.clone()));
    }
}

/// The greatest value that the type behind a whole number holds.
fn most_of(schema: &Value) -> Option<f64> {
    Some(match at(schema, "format")?.as_str()? {
        "uint8" => f64::from(u8::MAX),
        "uint16" => f64::from(u16::MAX),
        "uint32" => f64::from(u32::MAX),
        "int32" => f64::from(i32::MAX),
        _ => return None,
    })
}

/// Advice on a text where a number is wanted: quotes that are one too many, a decimal comma.
fn number_in_text(node: &Node, types: &[&str]) -> Option<String> {
    let Data::Text(t) = &node.data else { return None };
    let pointed = quantity::with_decimal_point(t);
    let number = pointed.as_deref().unwrap_or(t).trim();
    let fits = match types {
        ["number"] => number.parse::<f64>().is_ok_and(f64::is_finite),
        ["integer"] => number.parse::<i64>().is_ok(),
        _ => false,
    };
    fits.then(|| match pointed {
        Some(_) => format!("the decimal mark is a point: `{number}`"),
        None => format!("write it without quotes: `{number}`"),
    })
}

fn check_word(node: &Node, words: &[&str], path: &str, out: &mut Vec<Diagnostic>) {
    let Data::Text(word) = &node.data else {
        return out.push(wrong_type(node, "a word in quotes", path).help(advice("", words)));
    };
    if !words.contains(&word.as_str()) {
        let d = Diagnostic::new(format!("`{}` is not a valid word here", shorten(word)));
        out.push(d.path(path).at(node.place.origin, node.place.span.clone()).help(advice(word, words)));
    }
}

fn check_quantity(node: &Node, dimension: &str, bound: &str, path: &str, out: &mut Vec<Diagnostic>) {
    let result = match &node.data {
        Data::Text(t) => quantity::check(dimension, bound, t, None),
        Data::Integer(i) => quantity::check(dimension, bound, &i.to_string(), Some(*i as f64)),
        Data::Float(f) => quantity::check(dimension, bound, &number_text(*f), Some(*f)),
        _ => {
            let example =
                units_of(dimension).get(2).or(units_of(dimension).first()).copied().unwrap_or_default();
            let example = if example.is_empty() { "1.5".to_owned() } else { format!("\"1.5 {example}\"") };
            let d = wrong_type(node, dimension, path).help(format!("write it like `{example}`"));
            return out.push(d);
        }
    };
    let Err(e) = result else { return };
    let (message, help) = match &e {
        QuantityError::Unit { unit, dimension, known } => (
            format!("`{}` is not a unit of {dimension}", shorten(unit)),
            Some(unit_advice(unit, dimension, known)),
        ),
        QuantityError::NotANumber { text, dimension, example } => (
            format!("`{}` does not start with a number", shorten(text)),
            Some(format!("write {dimension} like `\"{example}\"`")),
        ),
        QuantityError::Spelling { text, instead } => (
            format!("`{}` is not a number with a unit", shorten(text)),
            Some(format!("the decimal mark is a point, minus a hyphen: `\"{}\"`", shorten(instead))),
        ),
        QuantityError::Range { text, bound } => (format!("`{}` must be {bound}", shorten(text)), None),
        _ => (shorten(&e.to_string()), None),
    };
    let mut d = Diagnostic::new(message).path(path).at(node.place.origin, node.place.span.clone());
    d.help = help;
    out.push(d);
}

pub(super) fn units_of(dimension: &str) -> Vec<&'static str> {
    ALL_DIMENSIONS
        .iter()
        .find(|(n, ..)| *n == dimension)
        .map_or_else(Vec::new, |(_, u, _)| u.iter().map(|u| u.name).filter(|n| !n.is_empty()).collect())
}

fn unit_advice(unit: &str, dimension: &str, known: &str) -> String {
    if units_of(dimension).is_empty() {
        return format!("{dimension} has no unit");
    }
    if ["degF", "°F", "F", "Fahrenheit"].contains(&unit) && dimension == "a temperature" {
        return format!("in degrees Celsius it is (F - 32)/1.8; valid: {known}");
    }
    let owner = ALL_DIMENSIONS.iter().find(|(_, us, _)| us.iter().any(|u| u.is(unit)));
    match (quantity::nearest_unit(dimension, unit), owner) {
        // Same letters in another case are the better guess; few edits apart are not.
        (Some((near, true)), _) | (Some((near, false)), None) => {
            format!("did you mean `{near}`? valid: {known}")
        }
        (_, Some((other, ..))) => format!("`{unit}` is a unit of {other}; valid: {known}"),
        (None, None) => format!("valid: {known}"),
    }
}

fn number_text(v: f64) -> String {
    if v.is_nan() {
        "nan".to_owned()
    } else if v != 0.0 && (v.abs() < 1e-4 || v.abs() >= 1e16) {
        format!("{v:e}")
    } else {
        v.to_string()
    }
}

fn first_sentence(text: &str) -> String {
    let flat = text.split_whitespace().collect::<Vec<_>>().join(" ");
    match flat.find(". ") {
        Some(i) => flat[..i].to_owned(),
        None => flat.trim_end_matches('.').to_owned(),
    }
}

/// A user's text in a message: one line, not a page.
pub(super) fn shorten(text: &str) -> String {
    const LONG: usize = 80;
    let flat = text.split_whitespace().collect::<Vec<_>>().join(" ");
    if flat.chars().count() <= LONG {
        return flat;
    }
    flat.chars().take(LONG).chain(std::iter::once('…')).collect()
}
