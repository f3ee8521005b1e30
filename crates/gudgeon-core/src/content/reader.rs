//! Content as a deserialiser. Functions that are compiled for every type that is read hold nothing that could stand outside.

use serde::de::value::{MapAccessDeserializer, StrDeserializer};
use serde::de::{
    DeserializeSeed, Deserializer, Error as _, Expected, IntoDeserializer, MapAccess, SeqAccess, Unexpected,
    Visitor,
};
use serde::forward_to_deserialize_any;

use super::{Content, Error};

impl Content {
    /// What it is, for a message.
    pub(crate) fn unexpected(&self) -> Unexpected<'_> {
        match self {
            Self::Nothing => Unexpected::Unit,
            Self::Bool(b) => Unexpected::Bool(*b),
            Self::Integer(i) => u64::try_from(*i).map_or(Unexpected::Signed(*i), Unexpected::Unsigned),
            Self::Number(f) => Unexpected::Float(*f),
            Self::Text(s) => Unexpected::Str(s),
            Self::List(_) => Unexpected::Seq,
            Self::Table(_) => Unexpected::Map,
        }
    }
}

macro_rules! forward {
    ($to:ident: $($ask:ident)*) => {$(
        fn $ask<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
            self.$to(visitor)
        }
    )*};
}

/// A value to be read.
#[derive(Clone, Copy)]
pub(super) struct Reader<'a>(pub &'a Content);

impl Reader<'_> {
    #[cold]
    fn refuse<T>(self, wanted: &dyn Expected) -> Result<T, Error> {
        Err(Error::invalid_type(self.0.unexpected(), wanted))
    }
}

impl<'de> Deserializer<'de> for Reader<'_> {
    type Error = Error;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.0 {
            Content::Nothing => visitor.visit_unit(),
            Content::Bool(b) => visitor.visit_bool(*b),
            Content::Integer(_) | Content::Number(_) => self.deserialize_f64(visitor),
            Content::Text(text) => visitor.visit_str(text),
            Content::List(_) => self.deserialize_seq(visitor),
            Content::Table(entries) => visitor.visit_map(&mut Fields::new(entries)),
        }
    }

    fn deserialize_bool<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.0 {
            Content::Bool(b) => visitor.visit_bool(*b),
            _ => self.refuse(&visitor),
        }
    }

    fn deserialize_f64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.0 {
            Content::Integer(i) => match u64::try_from(*i) {
                Ok(n) => visitor.visit_u64(n),
                Err(_) => visitor.visit_i64(*i),
            },
            Content::Number(f) => visitor.visit_f64(*f),
            _ => self.refuse(&visitor),
        }
    }

    fn deserialize_str<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.0 {
            Content::Text(text) => visitor.visit_str(text),
            _ => self.refuse(&visitor),
        }
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.0 {
            Content::List(all) => {
                let mut items = Items { all, next: 0 };
                let value = visitor.visit_seq(&mut items)?;
                items.end().map(|()| value)
            }
            _ => self.refuse(&visitor),
        }
    }

    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.0 {
            Content::Table(entries) => visitor.visit_map(&mut Fields::new(entries)),
            _ => self.refuse(&visitor),
        }
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        self.deserialize_map(visitor)
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.0 {
            Content::Nothing => visitor.visit_none(),
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
        match self.0 {
            Content::Text(word) => visitor.visit_enum(key(word)),
            Content::Table(entries) => {
                visitor.visit_enum(MapAccessDeserializer::new(&mut Fields::new(entries)))
            }
            _ => self.refuse(&visitor),
        }
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, _: usize, visitor: V) -> Result<V::Value, Error> {
        self.deserialize_seq(visitor)
    }

    forward_to_deserialize_any! { char bytes byte_buf unit unit_struct tuple_struct identifier ignored_any }

    forward! { deserialize_f64: deserialize_i8 deserialize_i16 deserialize_i32 deserialize_i64 deserialize_i128 deserialize_u8 }
    forward! { deserialize_f64: deserialize_u16 deserialize_u32 deserialize_u64 deserialize_u128 deserialize_f32 }
    forward! { deserialize_str: deserialize_string }
}

fn key(name: &str) -> StrDeserializer<'_, Error> {
    name.into_deserializer()
}

/// The keys of a table, and the value of the key that was read last.
struct Fields<'a> {
    all: std::slice::Iter<'a, (String, Content)>,
    next: Option<&'a (String, Content)>,
}

impl<'a> Fields<'a> {
    fn new(entries: &'a [(String, Content)]) -> Self {
        Self { all: entries.iter(), next: None }
    }

    fn value(&mut self) -> Result<(&'a str, Reader<'a>), Error> {
        match self.next.take() {
            Some((key, content)) => Ok((key, Reader(content))),
            None => Err(Error::custom("a value without a key")),
        }
    }
}

impl<'de> MapAccess<'de> for &mut Fields<'_> {
    type Error = Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Error> {
        self.next = self.all.next();
        match self.next {
            Some((name, _)) => seed.deserialize(key(name)).map(Some),
            None => Ok(None),
        }
    }

    fn next_value_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<S::Value, Error> {
        let (name, reader) = self.value()?;
        match seed.deserialize(reader) {
            Ok(value) => Ok(value),
            Err(e) => Err(e.under(name)),
        }
    }
}

/// The elements of an array.
struct Items<'a> {
    all: &'a [Content],
    next: usize,
}

impl Items<'_> {
    /// Whether all were read.
    fn end(self) -> Result<(), Error> {
        if self.next == self.all.len() {
            return Ok(());
        }
        Err(Error::invalid_length(self.all.len(), &"an array of fewer"))
    }
}

impl<'de> SeqAccess<'de> for &mut Items<'_> {
    type Error = Error;

    fn next_element_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<Option<S::Value>, Error> {
        let Some(content) = self.all.get(self.next) else { return Ok(None) };
        self.next += 1;
        match seed.deserialize(Reader(content)) {
            Ok(value) => Ok(Some(value)),
            Err(e) => Err(e.under(&(self.next - 1).to_string())),
        }
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.all.len() - self.next)
    }
}
