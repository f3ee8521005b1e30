//! Values as a file holds them, and how types of Rust are read from them.
//!
//! A case file, a JSON document and an override all become a [`Content`]; [`read`] turns that into a type that implements
//! [`Deserialize`], and an [`Error`] says where it stopped. Specifications of models ([`crate::spec`]) are read through the same reader, one concrete
//! type: every type is compiled once for it, whatever it is read from, and no error passes through a text on its way out.
//!
//! ```
//! use gudgeon_core::content::{Content, read};
//!
//! #[derive(serde::Deserialize)]
//! struct Liner {
//!     bore: f64,
//! }
//!
//! let table = |diameter| Content::Table(vec![("bore".into(), diameter)]);
//! let liner: Liner = read(&table(Content::Number(0.12))).unwrap();
//! assert_eq!(liner.bore, 0.12);
//! let wrong = read::<Liner>(&table(Content::Text("wide".into()))).err().unwrap();
//! assert_eq!((wrong.path(), wrong.to_string().as_str()), ("bore", "a number is wanted here, not the text `wide`"));
//! ```

mod error;
mod reader;

use std::fmt;

use serde::de::{DeserializeOwned, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};

pub use error::Error;
use reader::Reader;

/// Key of a table that names the model.
pub(crate) const MODEL: &str = "model";

/// A value of a file. The keys of a table keep their order.
#[derive(Debug, Clone, PartialEq)]
pub enum Content {
    /// A value that is not there, a date, a number that is none.
    Nothing,
    /// `true` or `false`.
    Bool(bool),
    /// A whole number.
    Integer(i64),
    /// A number; also a whole one that does not fit an `i64`.
    Number(f64),
    /// A text.
    Text(String),
    /// An array.
    List(Vec<Self>),
    /// A table.
    Table(Vec<(String, Self)>),
}

/// A value of the type `T`.
///
/// # Errors
/// What is wrong with the content, with the path to it.
pub fn read<T: DeserializeOwned>(content: &Content) -> Result<T, Error> {
    T::deserialize(Reader(content))
}

impl Content {
    /// The table that says nothing but the name of a model.
    #[must_use]
    pub fn named(model: &str) -> Self {
        Self::Table(vec![(MODEL.into(), Self::Text(model.into()))])
    }
}

impl From<&serde_json::Value> for Content {
    fn from(value: &serde_json::Value) -> Self {
        use serde_json::Value;
        match value {
            Value::Null => Self::Nothing,
            Value::Bool(b) => Self::Bool(*b),
            Value::Number(n) => match (n.as_i64(), n.as_f64()) {
                (Some(i), _) => Self::Integer(i),
                (None, f) => f.map_or(Self::Nothing, Self::Number),
            },
            Value::String(text) => Self::Text(text.clone()),
            Value::Array(list) => Self::List(list.iter().map(Self::from).collect()),
            Value::Object(table) => {
                Self::Table(table.iter().map(|(key, value)| (key.clone(), Self::from(value))).collect())
            }
        }
    }
}

impl<'de> Deserialize<'de> for Content {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_any(Keep)
    }
}

/// Keeps whatever comes.
struct Keep;

impl<'de> Visitor<'de> for Keep {
    type Value = Content;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a value")
    }
    fn visit_bool<E>(self, v: bool) -> Result<Content, E> {
        Ok(Content::Bool(v))
    }
    fn visit_i64<E>(self, v: i64) -> Result<Content, E> {
        Ok(Content::Integer(v))
    }
    fn visit_u64<E>(self, v: u64) -> Result<Content, E> {
        Ok(i64::try_from(v).map_or(Content::Number(v as f64), Content::Integer))
    }
    fn visit_f64<E>(self, v: f64) -> Result<Content, E> {
        Ok(Content::Number(v))
    }
    fn visit_str<E>(self, v: &str) -> Result<Content, E> {
        Ok(Content::Text(v.to_owned()))
    }
    fn visit_unit<E>(self) -> Result<Content, E> {
        Ok(Content::Nothing)
    }
    fn visit_none<E>(self) -> Result<Content, E> {
        Ok(Content::Nothing)
    }
    fn visit_some<D: Deserializer<'de>>(self, from: D) -> Result<Content, D::Error> {
        Content::deserialize(from)
    }
    fn visit_newtype_struct<D: Deserializer<'de>>(self, from: D) -> Result<Content, D::Error> {
        Content::deserialize(from)
    }
    fn visit_seq<A: SeqAccess<'de>>(self, mut from: A) -> Result<Content, A::Error> {
        let mut list = Vec::new();
        while let Some(item) = from.next_element()? {
            list.push(item);
        }
        Ok(Content::List(list))
    }
    fn visit_map<A: MapAccess<'de>>(self, mut from: A) -> Result<Content, A::Error> {
        let mut table = Vec::new();
        while let Some(entry) = from.next_entry()? {
            table.push(entry);
        }
        Ok(Content::Table(table))
    }
}
