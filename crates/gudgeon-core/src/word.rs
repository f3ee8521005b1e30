//! A model that a case may choose by a word.

use std::borrow::Cow;
use std::fmt;
use std::ops::Deref;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::content::{Content, Error};
use crate::registry::{Kind, Registry};
use crate::spec;

/// A model of the kind `S` that a case chooses by its name alone, `hoop = "as_printed"`; the table of any other model,
/// `hoop = { model = "as_printed" }`, is read too, and is what is written.
pub struct Word<S: ?Sized>(pub Box<S>);

impl<S: ?Sized> Deref for Word<S> {
    type Target = S;
    fn deref(&self) -> &S {
        &self.0
    }
}

impl<S: ?Sized> Clone for Word<S>
where
    Box<S>: Clone,
{
    fn clone(&self) -> Self {
        Self(self.0.clone())
    }
}

impl<S: ?Sized> fmt::Debug for Word<S>
where
    Box<S>: fmt::Debug,
{
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl<S: ?Sized> Serialize for Word<S>
where
    Box<S>: Serialize,
{
    fn serialize<T: Serializer>(&self, to: T) -> Result<T::Ok, T::Error> {
        self.0.serialize(to)
    }
}

impl<'de, S: ?Sized + Kind + 'static> Deserialize<'de> for Word<S> {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let table = match Content::deserialize(from)? {
            Content::Text(word) => Content::named(&word),
            other => other,
        };
        spec::model(table).map(Word).map_err(Error::hand_on)
    }
}

impl<S: ?Sized + Kind + JsonSchema> JsonSchema for Word<S> {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> Cow<'static, str> {
        format!("{}_by_name", S::NAME).into()
    }
    fn json_schema(g: &mut SchemaGenerator) -> Schema {
        let registry = Registry::collect();
        let plain = |m: &&&crate::ModelInfo| {
            let schema = (m.schema)(g).to_value();
            schema.get("required").and_then(|r| r.as_array()).is_none_or(Vec::is_empty)
        };
        let names: Vec<&str> = registry.models(S::NAME).iter().filter(plain).map(|m| m.name).collect();
        json_schema!({ "anyOf": [{ "type": "string", "enum": names }, g.subschema_for::<S>()] })
    }
}
