//! The table `solver` of a case: a solver that is registered like a model, and the keys that all solvers of a scene share.

use std::any::TypeId;
use std::borrow::Cow;
use std::collections::HashMap;
use std::ops::Deref;
use std::sync::{Mutex, PoisonError};

use gudgeon_core::content::{self, Content, Error};
use gudgeon_core::registry::{Kind, whole_kind_schema};
use gudgeon_core::spec;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::{DeserializeOwned, Error as _};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::{Map, Value, json};

/// The key that names the solver.
const TAG: &str = "method";
/// The key by which registered models are read.
const MODEL: &str = "model";

/// Keys that all solvers of a scene share.
pub trait SolverCommon: Default + Serialize + DeserializeOwned + JsonSchema + 'static {
    /// The solver of a case that names none.
    const DEFAULT: &'static str;
    /// Names that were valid once, with what to write instead.
    const RENAMED: &'static [(&'static str, &'static str)] = &[];
}

/// The table `solver`: `method` names the solver `S`, whose own keys stand beside the common ones `C`.
#[derive(Debug)]
pub struct SolverTable<C, S: ?Sized> {
    /// The common keys.
    pub common: C,
    /// The solver.
    pub method: Box<S>,
}

impl<C: Clone, S: ?Sized> Clone for SolverTable<C, S>
where
    Box<S>: Clone,
{
    fn clone(&self) -> Self {
        Self { common: self.common.clone(), method: self.method.clone() }
    }
}

impl<C, S: ?Sized> Deref for SolverTable<C, S> {
    type Target = C;
    fn deref(&self) -> &C {
        &self.common
    }
}

impl<C, S> Default for SolverTable<C, S>
where
    C: SolverCommon,
    S: ?Sized + Kind + 'static,
{
    fn default() -> Self {
        match Self::from_content(Content::Table(Vec::new())) {
            Ok(table) => table,
            // A registered default is checked when the program starts.
            Err(e) => panic!("the default solver `{}`: {e}", C::DEFAULT),
        }
    }
}

impl<C, S> SolverTable<C, S>
where
    C: SolverCommon,
    S: ?Sized + Kind + 'static,
{
    fn from_content(all: Content) -> Result<Self, Error> {
        let Content::Table(mut all) = all else { return Err(Error::custom("a solver is a table")) };
        let named = all.iter().position(|(key, _)| key == TAG).map(|at| all.remove(at).1);
        let name = named.unwrap_or_else(|| Content::Text(C::DEFAULT.into()));
        let shared = common_keys::<C>();
        let (common, mut own): (Vec<_>, Vec<_>) =
            all.into_iter().partition(|(key, _)| shared.iter().any(|k| k == key));
        own.insert(0, (MODEL.into(), name));
        let (common, own) = (Content::Table(common), Content::Table(own));
        Ok(Self { common: content::read(&common)?, method: spec::model(own)? })
    }
}

/// Names of the common keys, found once.
fn common_keys<C: SolverCommon>() -> &'static [String] {
    static KNOWN: Mutex<Option<HashMap<TypeId, &'static [String]>>> = Mutex::new(None);
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    known.get_or_insert_default().entry(TypeId::of::<C>()).or_insert_with(|| {
        let schema = schemars::schema_for!(C).to_value();
        let keys = schema["properties"].as_object().into_iter().flat_map(Map::keys).cloned().collect();
        Vec::leak(keys)
    })
}

impl<'de, C, S> Deserialize<'de> for SolverTable<C, S>
where
    C: SolverCommon,
    S: ?Sized + Kind + 'static,
{
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Self::from_content(Content::deserialize(deserializer)?).map_err(Error::hand_on)
    }
}

impl<C, S> Serialize for SolverTable<C, S>
where
    C: Serialize,
    S: ?Sized,
    Box<S>: Serialize,
{
    fn serialize<Z: Serializer>(&self, serializer: Z) -> Result<Z::Ok, Z::Error> {
        use serde::ser::Error as _;
        let value = |v: Result<Value, _>| match v {
            Ok(Value::Object(o)) => Ok(o),
            Ok(_) => Err(Z::Error::custom("a solver is written as a table")),
            Err(e) => Err(Z::Error::custom(e)),
        };
        let mut own = value(serde_json::to_value(&self.method))?;
        let mut all = Map::new();
        all.insert(TAG.into(), own.remove(MODEL).unwrap_or_default());
        all.extend(own);
        all.extend(value(serde_json::to_value(&self.common))?);
        all.serialize(serializer)
    }
}

impl<C, S> JsonSchema for SolverTable<C, S>
where
    C: SolverCommon,
    S: ?Sized + Kind,
{
    fn schema_name() -> Cow<'static, str> {
        format!("{}_table", S::NAME).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let common = C::json_schema(generator).to_value();
        let mut choice = whole_kind_schema(S::NAME, generator).to_value();
        for variant in choice["oneOf"].as_array_mut().into_iter().flatten() {
            let name = variant["properties"][MODEL].take();
            let mut properties = Map::new();
            properties.insert(TAG.into(), name);
            for part in [&variant["properties"], &common["properties"]] {
                let own = part.as_object().into_iter().flatten().filter(|(k, _)| *k != MODEL);
                properties.extend(own.map(|(k, v)| (k.clone(), v.clone())));
            }
            variant["properties"] = properties.into();
            for key in variant["required"].as_array_mut().into_iter().flatten() {
                if *key == MODEL {
                    *key = TAG.into();
                }
            }
        }
        choice["x-default"] = C::DEFAULT.into();
        choice["x-renamed"] = C::RENAMED.iter().map(|(k, v)| ((*k).to_owned(), json!(v))).collect();
        choice.try_into().unwrap_or_default()
    }
}

/// All registered solvers of a kind with their default settings; those that have none are left out.
pub fn default_solvers<S>() -> Vec<(&'static str, Box<S>)>
where
    S: ?Sized + Kind + 'static,
{
    let registry = gudgeon_core::Registry::collect();
    let spec = |name: &'static str| spec::plain_model(name).ok().map(|spec| (name, spec));
    registry.models(S::NAME).iter().filter_map(|m| spec(m.name)).collect()
}
