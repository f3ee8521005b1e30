//! `--set PATH=VALUE`: changes a document before it is checked.

use serde_json::Value;
use toml::de::DeValue;

use super::near::list;
use super::report::{Diagnostic, Origin};
use super::schema::{Part, Schema, shorten};
use super::tree::{Data, Entry, Node, Place, Step, join, steps};

/// Applies the overrides in order. What cannot be applied is returned; `notes` tells what a changed model lost.
pub(super) fn apply(
    document: &mut Node,
    schema: &Schema,
    overrides: &[String],
    notes: &mut Vec<String>,
) -> Vec<Diagnostic> {
    let mut out = Vec::new();
    for (i, text) in overrides.iter().enumerate() {
        let origin = Origin::Override(i);
        let whole = Place { origin, span: Some(0..text.len()) };
        let result = Assignment::parse(text, origin).and_then(|a| set(document, schema, a, notes));
        if let Err(mut d) = result {
            if d.span.is_none() {
                d = d.at(whole.origin, whole.span);
            }
            out.push(d);
        }
    }
    out
}

struct Assignment<'a> {
    text: &'a str,
    steps: Vec<Step>,
    value: Node,
    origin: Origin,
}

impl<'a> Assignment<'a> {
    fn parse(text: &'a str, origin: Origin) -> Result<Self, Diagnostic> {
        let form = "write `--set PATH=VALUE`, for example `--set rings.0.gap=\"0.5 mm\"`";
        let Some(eq) = text.find('=') else {
            return Err(Diagnostic::new("no `=` between path and value").help(form));
        };
        let steps = steps(&text[..eq], 0);
        if steps.iter().any(|s| s.text.is_empty()) {
            let at = steps.iter().find(|s| s.text.is_empty()).map(|s| s.span.clone());
            let at = at.filter(|s| !s.is_empty()).unwrap_or(0..eq.max(1));
            return Err(Diagnostic::new("the path has an empty step").at(origin, Some(at)).help(form));
        }
        let raw = &text[eq + 1..];
        let base = eq + 1 + (raw.len() - raw.trim_start().len());
        let raw = raw.trim();
        if raw.is_empty() {
            return Err(Diagnostic::new("no value after `=`").at(origin, Some(eq..eq + 1)).help(form));
        }
        let value = match DeValue::parse(raw) {
            Ok(v) => {
                let mut node = Node::from_value(&v, origin, base);
                node.place = Place { origin, span: Some(base..base + raw.len()) };
                node
            }
            // Brackets and quotes say that TOML was meant; anything else is text: `narrow_channel`, `0.5 mm`.
            Err(e) if raw.starts_with(['[', '{', '"', '\'']) => {
                let span =
                    e.span().map_or(base..base + raw.len(), |s| base + s.start..base + s.end.max(s.start));
                return Err(Diagnostic::new(e.message()).at(origin, Some(span)));
            }
            Err(_) => bare(raw, origin, base),
        };
        Ok(Self { text, steps, value, origin })
    }

    fn raw_value(&self) -> &'a str {
        self.value.place.span.clone().and_then(|s| self.text.get(s)).unwrap_or_default()
    }
}

fn bare(raw: &str, origin: Origin, base: usize) -> Node {
    Node { data: Data::Text(raw.to_owned()), place: Place { origin, span: Some(base..base + raw.len()) } }
}

fn set(
    document: &mut Node,
    schemas: &Schema,
    mut given: Assignment<'_>,
    notes: &mut Vec<String>,
) -> Result<(), Diagnostic> {
    let origin = given.origin;
    let mut node = document;
    let mut schema = Some(schemas.root());
    let mut path = String::new();
    let Some((last, parents)) = given.steps.split_last() else { return Ok(()) };
    for step in parents {
        let field = schema.and_then(|s| schemas.field(s, Some(node), &step.text));
        node = descend(node, field, step, &path, origin)?;
        path = join(&path, &step.text);
        let model = field.and_then(|f| schemas.model_of_word(f));
        if let Some(tagged) = model.and_then(|m| schemas.tagged(schemas.resolve(m))) {
            word_to_table(node, tagged.tag);
        }
        schema = model.or(field);
    }

    let field = schema.and_then(|s| schemas.field(s, Some(node), &last.text));
    let wants_text = field.is_some_and(|f| schemas.wants_text(f));
    if wants_text && !matches!(given.value.data, Data::Text(_) | Data::Array(_) | Data::Table(_)) {
        // `--set title=2024`: the schema knows that this is no number.
        let (raw, base) = (given.raw_value(), given.value.place.span.as_ref().map_or(0, |s| s.start));
        given.value = bare(raw, origin, base);
    }
    if let Some(s) = schema {
        change_variant(node, schemas, s, last, &given.value, &path, notes);
    }
    let place = Place { origin, span: Some(last.span.clone()) };
    match &mut node.data {
        Data::Table(entries) => match entries.iter_mut().find(|e| e.key == last.text) {
            Some(e) => e.node = given.value,
            None => entries.push(Entry { key: last.text.clone(), key_place: place, node: given.value }),
        },
        Data::Array(items) => {
            let n = items.len();
            let item = last.text.parse::<usize>().ok().and_then(|i| items.get_mut(i));
            *item.ok_or_else(|| no_such_element(n, last, &path, origin))? = given.value;
        }
        _ => return Err(not_a_table(node, last, &path, origin)),
    }
    Ok(())
}

/// `hoop = "as_printed"` becomes `hoop = { model = "as_printed" }`, which has keys to change.
fn word_to_table(node: &mut Node, tag: &str) {
    if matches!(node.data, Data::Text(_)) {
        let place = node.place.clone();
        let word = std::mem::replace(node, Node { data: Data::Table(Vec::new()), place: place.clone() });
        node.data = Data::Table(vec![Entry { key: tag.to_owned(), key_place: place, node: word }]);
    }
}

/// The child that a step leads to, made from the schema's default when the document does not have it.
fn descend<'n>(
    node: &'n mut Node,
    field: Option<&Value>,
    step: &Step,
    path: &str,
    origin: Origin,
) -> Result<&'n mut Node, Diagnostic> {
    let place = Place { origin, span: Some(step.span.clone()) };
    if !matches!(node.data, Data::Table(_) | Data::Array(_)) {
        return Err(not_a_table(node, step, path, origin));
    }
    match &mut node.data {
        Data::Table(entries) => {
            let i = match entries.iter().position(|e| e.key == step.text) {
                Some(i) => i,
                None => {
                    let default = field.and_then(|f| f.get("default")).and_then(Node::from_json);
                    let mut new =
                        default.unwrap_or(Node { data: Data::Table(Vec::new()), place: place.clone() });
                    new.place = place.clone();
                    entries.push(Entry { key: step.text.clone(), key_place: place, node: new });
                    entries.len() - 1
                }
            };
            Ok(&mut entries[i].node)
        }
        Data::Array(items) => {
            let n = items.len();
            let item = step.text.parse::<usize>().ok().and_then(|i| items.get_mut(i));
            item.ok_or_else(|| no_such_element(n, step, path, origin))
        }
        _ => unreachable!("refused above"),
    }
}

fn no_such_element(n: usize, step: &Step, path: &str, origin: Origin) -> Diagnostic {
    let help = match n {
        0 => "it is empty".to_owned(),
        1 => "it has one entry, number 0".to_owned(),
        n => format!("it has {n} entries, numbered 0 to {}", n - 1),
    };
    Diagnostic::new(format!("no entry `{}`", shorten(&step.text)))
        .path(path)
        .at(origin, Some(step.span.clone()))
        .help(help)
}

fn not_a_table(node: &Node, step: &Step, path: &str, origin: Origin) -> Diagnostic {
    Diagnostic::new(format!("is {}, which has no `{}`", node.noun(), shorten(&step.text)))
        .path(path)
        .at(origin, Some(step.span.clone()))
}

/// A table whose `model` changes keeps the keys that the new model has too; the rest would only be refused. What the user
/// had written and is dropped is told.
fn change_variant(
    node: &mut Node,
    schemas: &Schema,
    schema: Part,
    last: &Step,
    value: &Node,
    path: &str,
    notes: &mut Vec<String>,
) {
    let resolved = schemas.resolve(schema);
    let Some(tagged) = schemas.tagged(resolved).filter(|t| t.tag == last.text) else { return };
    let (Data::Text(new), Data::Table(entries)) = (&value.data, &mut node.data) else { return };
    let Some(variant) = tagged.variant(schemas, new) else { return };
    let old = entries.iter().find(|e| e.key == tagged.tag).and_then(|e| match &e.node.data {
        Data::Text(t) => Some(t.clone()),
        _ => None,
    });
    let old = old.or_else(|| tagged.default.map(str::to_owned));
    if old.as_deref() == Some(new) {
        return;
    }
    let has = |key: &str| variant.get("properties").is_some_and(|p| p.get(key).is_some());
    let before = old.as_deref().and_then(|old| tagged.variant(schemas, old));
    let known_before =
        |key: &str| before.is_none_or(|s| s.get("properties").is_some_and(|p| p.get(key).is_some()));
    // A key that neither model has is a mistake of the user, not a left-over.
    let drops = |e: &Entry| e.key != tagged.tag && !has(&e.key) && known_before(&e.key);
    let given = |e: &&Entry| e.node.place.origin != Origin::Default;
    let dropped: Vec<&str> =
        entries.iter().filter(|e| drops(e)).filter(given).map(|e| e.key.as_str()).collect();
    let kept: Vec<&str> = entries
        .iter()
        .filter(|e| e.key != tagged.tag && has(&e.key))
        .filter(given)
        .map(|e| e.key.as_str())
        .collect();
    if !dropped.is_empty() {
        let kept = if kept.is_empty() { String::new() } else { format!("; kept {}", list(kept)) };
        notes.push(format!("{path}: `{new}` does not have {}, dropped{kept}", list(dropped)));
    }
    // Defaults of the old model are not values that anybody chose: the new model has its own.
    entries.retain(|e| e.key == tagged.tag || !drops(e) && e.node.place.origin != Origin::Default);
}
