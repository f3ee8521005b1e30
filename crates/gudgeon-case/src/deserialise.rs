//! The tree of a document as a deserialiser that remembers where it stopped.
//!
//! The path of an error is kept beside the error, because models are read behind `dyn` interfaces that hand on its text alone. Wrapping another
//! deserialiser for that would compile every type of a case once more, with larger visitors.

use std::cell::RefCell;
use std::fmt;

use serde::de::value::{MapAccessDeserializer, StrDeserializer};
use serde::de::{
    DeserializeOwned, DeserializeSeed, Deserializer, Error as _, IntoDeserializer, MapAccess, SeqAccess,
    Visitor,
};
use serde::forward_to_deserialize_any;

use super::tree::{Data, Entry, Node};

/// What was wrong.
#[derive(Debug)]
pub(super) struct Error(String);

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Error {}

impl serde::de::Error for Error {
    fn custom<T: fmt::Display>(what: T) -> Self {
        Self(what.to_string())
    }
}

/// A value from the tree, or the path at which it stopped and what was wrong there.
pub(super) fn value<T: DeserializeOwned>(tree: &Node) -> Result<T, (String, String)> {
    let stopped = RefCell::new(None);
    let root = Tree { node: tree, path: Path::Root, stopped: &stopped };
    T::deserialize(root).map_err(|e| (stopped.take().unwrap_or_default(), e.0))
}

/// The way to a node, from its end.
#[derive(Clone, Copy)]
enum Path<'a> {
    Root,
    Key(&'a Path<'a>, &'a str),
    Index(&'a Path<'a>, usize),
}

impl Path<'_> {
    fn text(&self) -> String {
        let (parent, step) = match self {
            Path::Root => return String::new(),
            Path::Key(parent, key) => (parent, (*key).to_owned()),
            Path::Index(parent, i) => (parent, i.to_string()),
        };
        let before = parent.text();
        if before.is_empty() { step } else { format!("{before}.{step}") }
    }
}

/// A node with its path; the path of the first error goes to `stopped`.
struct Tree<'a> {
    node: &'a Node,
    path: Path<'a>,
    stopped: &'a RefCell<Option<String>>,
}

impl<'a> Tree<'a> {
    fn fields(&'a self, entries: &'a [Entry]) -> Fields<'a> {
        // A tag that comes later would have the fields before it read twice, the second time without their paths.
        let (tag, rest): (Vec<_>, Vec<_>) = entries.iter().partition(|e| e.key == "model");
        let all: Vec<&Entry> = tag.into_iter().chain(rest).collect();
        Fields { all: all.into_iter(), next: None, path: &self.path, stopped: self.stopped }
    }
}

/// Reads a node further down, and keeps its path if that fails first.
fn below<'de, S: DeserializeSeed<'de>>(seed: S, tree: Tree<'_>) -> Result<S::Value, Error> {
    let (path, stopped) = (tree.path, tree.stopped);
    seed.deserialize(tree).inspect_err(|_| {
        stopped.borrow_mut().get_or_insert_with(|| path.text());
    })
}

impl<'de> Deserializer<'de> for Tree<'_> {
    type Error = Error;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match &self.node.data {
            Data::Text(s) => visitor.visit_str(s),
            Data::Integer(i) => match u64::try_from(*i) {
                Ok(n) => visitor.visit_u64(n),
                Err(_) => visitor.visit_i64(*i),
            },
            Data::Float(f) if f.is_finite() => visitor.visit_f64(*f),
            // The check of the schema has refused them where a number is wanted.
            Data::Float(_) | Data::Date => visitor.visit_unit(),
            Data::Bool(b) => visitor.visit_bool(*b),
            Data::Array(a) => {
                let mut items = Items { all: a, next: 0, path: &self.path, stopped: self.stopped };
                let out = visitor.visit_seq(&mut items)?;
                match items.next == a.len() {
                    true => Ok(out),
                    false => Err(Error::invalid_length(a.len(), &"fewer elements in array")),
                }
            }
            Data::Table(t) => visitor.visit_map(&mut self.fields(t)),
        }
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match &self.node.data {
            Data::Date => visitor.visit_none(),
            _ => visitor.visit_some(self),
        }
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, Error> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        match &self.node.data {
            Data::Text(word) => {
                let word: StrDeserializer<'_, Error> = word.as_str().into_deserializer();
                visitor.visit_enum(word)
            }
            Data::Table(t) => visitor.visit_enum(MapAccessDeserializer::new(self.fields(t))),
            _ => self.deserialize_any(visitor),
        }
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit unit_struct seq tuple
        tuple_struct map struct identifier ignored_any
    }
}

/// The keys of a table.
struct Fields<'a> {
    all: std::vec::IntoIter<&'a Entry>,
    next: Option<&'a Entry>,
    path: &'a Path<'a>,
    stopped: &'a RefCell<Option<String>>,
}

impl<'de> MapAccess<'de> for Fields<'_> {
    type Error = Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Error> {
        self.next = self.all.next();
        let Some(entry) = self.next else { return Ok(None) };
        let key: StrDeserializer<'_, Error> = entry.key.as_str().into_deserializer();
        seed.deserialize(key).map(Some)
    }

    fn next_value_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<S::Value, Error> {
        let Some(entry) = self.next.take() else { return Err(Error::custom("a value without a key")) };
        let path = Path::Key(self.path, &entry.key);
        below(seed, Tree { node: &entry.node, path, stopped: self.stopped })
    }
}

/// The elements of an array.
struct Items<'a> {
    all: &'a [Node],
    next: usize,
    path: &'a Path<'a>,
    stopped: &'a RefCell<Option<String>>,
}

impl<'de> SeqAccess<'de> for Items<'_> {
    type Error = Error;

    fn next_element_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<Option<S::Value>, Error> {
        let Some(node) = self.all.get(self.next) else { return Ok(None) };
        let path = Path::Index(self.path, self.next);
        self.next += 1;
        below(seed, Tree { node, path, stopped: self.stopped }).map(Some)
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.all.len() - self.next)
    }
}
