//! Changes written into the text of a case, so that what a program changed can be kept as a file: comments, order and layout stay.

use std::ops::Range;

use super::tree::{Data, Entry, Node, Step, join, steps};

/// One replacement in a text.
struct Edit {
    at: Range<usize>,
    with: String,
}

/// The text with the overrides written in. `document` is its tree, `changed` the tree with the overrides applied.
pub(super) fn rewritten(text: &str, document: &Node, changed: &Node, overrides: &[String]) -> String {
    let mut edits = Vec::new();
    removed(text, document, changed, &mut edits);
    let mut tail = String::new();
    for o in overrides {
        let Some((path, value)) = o.split_once('=') else { continue };
        let write = Write { text, path: steps(path.trim(), 0), value: literal(value.trim()), changed };
        write.apply(document, &mut edits, &mut tail);
    }
    applied(text, edits) + &tail
}

/// A value as TOML: what is no TOML by itself is a text.
fn literal(value: &str) -> String {
    match toml::de::DeValue::parse(value) {
        Ok(_) => value.to_owned(),
        Err(_) => serde_json::Value::from(value).to_string(),
    }
}

/// Lines of the keys that the changed document has no more.
fn removed(text: &str, before: &Node, after: &Node, edits: &mut Vec<Edit>) {
    match (&before.data, &after.data) {
        (Data::Table(entries), Data::Table(_)) => {
            for e in entries {
                match after.child(&e.key) {
                    Some(now) => removed(text, &e.node, now, edits),
                    None if inline(text, before) => erase_inside(text, e, edits),
                    None => erase(text, e, edits),
                }
            }
        }
        (Data::Array(a), Data::Array(b)) => {
            for (before, after) in a.iter().zip(b) {
                removed(text, before, after, edits);
            }
        }
        _ => {}
    }
}

/// Whether a table is written in braces.
fn inline(text: &str, node: &Node) -> bool {
    node.place.span.as_ref().is_some_and(|span| text[span.start..].starts_with('{'))
}

/// Takes out a key between the braces of a table, with one of the commas beside it.
fn erase_inside(text: &str, e: &Entry, edits: &mut Vec<Edit>) {
    let (Some(key), Some(value)) = (&e.key_place.span, &e.node.place.span) else { return };
    let (before, after) = (text[..key.start].trim_end(), text[value.end..].trim_start());
    let at = match (after.strip_prefix(','), before.strip_suffix(',')) {
        (Some(rest), _) => key.start..text.len() - rest.trim_start().len(),
        (None, Some(rest)) => rest.len()..value.end,
        (None, None) => key.start..value.end,
    };
    edits.push(Edit { at, with: String::new() });
}

/// Takes out the lines of a key, and of everything below it where it is a table with a header.
fn erase(text: &str, e: &Entry, edits: &mut Vec<Edit>) {
    let header = e.node.place.span.as_ref().filter(|s| {
        text[s.start..].starts_with('[') && e.key_place.span.as_ref().is_some_and(|k| k.start > s.start)
    });
    let below: Vec<&Entry> = match (&e.node.data, header) {
        (Data::Table(entries), Some(_)) => entries.iter().collect(),
        _ => Vec::new(),
    };
    let (Some(key), Some(value)) = (&e.key_place.span, &e.node.place.span) else { return };
    edits.push(Edit {
        at: lines(text, key.start.min(value.start)..key.end.max(value.end)),
        with: String::new(),
    });
    for inner in below {
        erase(text, inner, edits);
    }
}

/// Whole lines.
fn lines(text: &str, range: Range<usize>) -> Range<usize> {
    let start = text[..range.start].rfind('\n').map_or(0, |i| i + 1);
    let end = text[range.end..].find('\n').map_or(text.len(), |i| range.end + i + 1);
    start..end
}

/// One change to be written.
struct Write<'a> {
    text: &'a str,
    path: Vec<Step>,
    value: String,
    changed: &'a Node,
}

impl Write<'_> {
    /// Replaces a value that stands in the text, or adds its key to the nearest table that does.
    fn apply(&self, document: &Node, edits: &mut Vec<Edit>, tail: &mut String) {
        let mut node = document;
        let mut holder = (0, None);
        for (k, step) in self.path.iter().enumerate() {
            match node.child(&step.text) {
                Some(n) => node = n,
                None => return self.add(holder, edits, tail),
            }
            if let (Data::Table(_), Some(span)) = (&node.data, &node.place.span)
                && self.text[span.start..].starts_with(['[', '{'])
            {
                holder = (k + 1, Some(span.clone()));
            }
        }
        if let Some(span) = node.place.span.clone() {
            edits.push(Edit { at: span, with: self.value.clone() });
        }
    }

    fn add(&self, (depth, holder): (usize, Option<Range<usize>>), edits: &mut Vec<Edit>, tail: &mut String) {
        let names: Vec<&str> = self.path.iter().map(|s| s.text.as_str()).collect();
        let (rest, value) = (names[depth..].join("."), &self.value);
        let inline = holder.clone().filter(|span| self.text[span.start..].starts_with('{'));
        if let Some(span) = inline {
            let inside = self.text[span.start + 1..span.end - 1].trim_end();
            let comma = if inside.is_empty() { "" } else { ", " };
            let at = span.start + 1 + inside.len();
            return edits.push(Edit { at: at..at, with: format!("{comma}{rest} = {value}") });
        }
        match (holder, names.split_last()) {
            (Some(span), _)
                if depth + 1 == names.len() || names.iter().any(|n| n.parse::<usize>().is_ok()) =>
            {
                let at = lines(self.text, span).end;
                let new_line = if self.text[..at].ends_with('\n') { "" } else { "\n" };
                edits.push(Edit { at: at..at, with: format!("{new_line}{rest} = {value}\n") });
            }
            (_, Some((key, above))) if !above.is_empty() => self.append(above, key, tail),
            _ => {
                let at = self.text.find("\n[").map_or(self.text.len(), |i| i + 1);
                edits.push(Edit { at: at..at, with: format!("{rest} = {value}\n") });
            }
        }
    }

    /// A table that the text does not have yet, at its end; with the model that its keys belong to.
    fn append(&self, above: &[&str], key: &str, tail: &mut String) {
        let table = above.iter().fold(String::new(), |p, s| join(&p, s));
        let lead =
            if tail.is_empty() && !self.text.is_empty() && !self.text.ends_with('\n') { "\n" } else { "" };
        tail.push_str(&format!("{lead}\n[{table}]\n"));
        let parent = above.iter().try_fold(self.changed, |node, step| node.child(step));
        if let Some(Data::Text(model)) = parent.and_then(|p| p.child("model")).map(|m| &m.data)
            && key != "model"
        {
            tail.push_str(&format!("model = \"{model}\"\n"));
        }
        tail.push_str(&format!("{key} = {}\n", self.value));
    }
}

/// The edits, from the end to the beginning; one inside another is part of it.
fn applied(text: &str, mut edits: Vec<Edit>) -> String {
    edits.sort_by_key(|e| (e.at.start, e.at.end));
    let mut out = String::with_capacity(text.len());
    let mut from = 0;
    for e in edits {
        if e.at.start >= from {
            out.push_str(&text[from..e.at.start]);
            out.push_str(&e.with);
            from = e.at.end;
        } else {
            from = from.max(e.at.end);
        }
    }
    out.push_str(&text[from..]);
    out
}
