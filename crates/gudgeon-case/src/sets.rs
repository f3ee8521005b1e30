//! Parameter sets that a case names: their values are put into the tree before it is checked.

use gudgeon_core::sets::{self, ParameterSet, SET, SetValue, X_SETS};
use serde::{Deserialize, Serialize};

use super::schema::{Part, Schema, at, property};
use super::tree::{Data, Entry, Node, join};

/// A set that a table of a case takes over.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct UsedSet {
    /// Path of the table, `models.oil`.
    pub path: String,
    /// Name of the set.
    pub name: String,
    /// What it describes.
    pub about: String,
    /// The values that were taken: key and value. Those that the case gives itself are not among them.
    pub taken: Vec<(String, SetValue)>,
    /// Keys of the set for which the case has values of its own.
    pub own: Vec<String>,
}

impl UsedSet {
    /// One sentence on each value that was taken and stands in no source.
    pub fn assumptions(&self) -> impl Iterator<Item = String> + '_ {
        self.taken.iter().filter(|(_, v)| v.source.is_none()).map(|(key, v)| {
            format!("{}.{key} = {} of the set \"{}\": {}.", self.path, v.text(), self.name, v.origin())
        })
    }

    /// Keys into `REFERENCES.bib` of the values that were taken, each once.
    #[must_use]
    pub fn references(&self) -> Vec<&str> {
        let mut out: Vec<&str> = self.taken.iter().filter_map(|(_, v)| v.source.as_deref()).collect();
        out.sort_unstable();
        out.dedup();
        out
    }
}

/// Puts the values of all sets that the document names into it, and takes the keys that name them away. A name that stands for no set stays,
/// for the check of the document to find.
pub(super) fn expand(document: &mut Node, schemas: &Schema) -> Vec<UsedSet> {
    let mut used = Vec::new();
    each(document, schemas.root(), "", schemas, &mut used);
    used
}

fn each(node: &mut Node, schema: Part, path: &str, schemas: &Schema, used: &mut Vec<UsedSet>) {
    let Some(schema) = schemas.table_of(schema, node) else { return };
    if at(schema, X_SETS).is_some() {
        used.extend(take_over(node, schema, path));
    }
    match &mut node.data {
        Data::Table(entries) => {
            for e in entries {
                if let Some(s) = property(schema, &e.key) {
                    each(&mut e.node, s, &join(path, &e.key), schemas, used);
                }
            }
        }
        Data::Array(items) => {
            for (i, item) in items.iter_mut().enumerate() {
                if let Some(s) = at(schema, "items") {
                    each(item, s, &join(path, &i.to_string()), schemas, used);
                }
            }
        }
        _ => {}
    }
}

fn take_over(node: &mut Node, schema: Part, path: &str) -> Option<UsedSet> {
    let Data::Table(entries) = &mut node.data else { return None };
    let at = entries.iter().position(|e| e.key == SET)?;
    let Data::Text(name) = &entries[at].node.data else { return None };
    let name = name.clone();
    let ParameterSet { about, values } = sets::of(schema).swap_remove(&name)?;
    let place = entries.remove(at).node.place;
    let (mut taken, mut own) = (Vec::new(), Vec::new());
    for (key, value) in values {
        let given = |k: &String| entries.iter().any(|e| e.key == *k);
        if given(&key) || value.unless.iter().any(given) {
            own.push(key);
            continue;
        }
        let Some(mut node) = Node::from_json(&value.value) else { continue };
        // Whatever is wrong with it is told where the set is named.
        node.place = place.clone();
        entries.push(Entry { key: key.clone(), key_place: place.clone(), node });
        taken.push((key, value));
    }
    Some(UsedSet { path: path.to_owned(), name, about, taken, own })
}
