//! References.

use std::collections::BTreeMap;

use gudgeon_core::ModelInfo;

/// The entries of a BibTeX file, by key.
#[derive(Debug, Clone)]
pub struct Bibliography<'a> {
    entries: BTreeMap<&'a str, &'a str>,
    count: usize,
}

impl<'a> Bibliography<'a> {
    /// Reads BibTeX in which every entry begins on a line of its own with `@`, and every field too: enough of the format for a file that a
    /// project writes itself.
    #[must_use]
    pub fn read(text: &'a str) -> Self {
        let text = text.trim_start();
        let entries = text.strip_prefix('@').unwrap_or(text).split("\n@").filter_map(|e| {
            let (head, body) = e.split_once(',')?;
            Some((head.split_once('{')?.1.trim(), body))
        });
        let all: Vec<_> = entries.collect();
        Self { count: all.len(), entries: all.into_iter().collect() }
    }

    /// Complaints about the file: keys that stand twice, entries without author, title or year, braces that do not match.
    #[must_use]
    pub fn complaints(&self) -> Vec<String> {
        let mut wrong = Vec::new();
        if self.entries.len() != self.count {
            wrong.push("a key of the bibliography stands twice".into());
        }
        for (key, body) in &self.entries {
            for field in ["author", "title", "year"] {
                if !body.lines().any(|l| l.trim_start().starts_with(field)) {
                    wrong.push(format!("{key} has no {field}"));
                }
            }
            if body.matches('{').count() + 1 != body.matches('}').count() {
                wrong.push(format!("{key}: braces do not match"));
            }
        }
        wrong
    }

    /// Complaints about references of a model that are no entries.
    #[must_use]
    pub fn missing(&self, m: &ModelInfo) -> Vec<String> {
        let missing = m.references.iter().filter(|r| !self.entries.contains_key(*r));
        missing.map(|r| format!("`{r}` is not in the bibliography")).collect()
    }
}
