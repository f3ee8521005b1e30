//! The registry: which kinds of sub-model exist, which models each has, and everything a person may ask about them.
//!
//! A kind is registered on the trait of its configuration, a model on its implementation of that trait:
//!
//! ```
//! use gudgeon_core::kinds::{Oil, OilSpec};
//! use gudgeon_core::quantity::PosViscosity;
//! use gudgeon_core::{BuildError, register_model};
//! use schemars::JsonSchema;
//! use serde::{Deserialize, Serialize};
//!
//! /// The same viscosity at every temperature.
//! #[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
//! #[serde(deny_unknown_fields)]
//! struct Syrup {
//!     /// Dynamic viscosity.
//!     viscosity: PosViscosity,
//! }
//!
//! #[register_model(
//!     name = "syrup",
//!     summary = "an oil that does not know its temperature",
//!     equations = "mu = constant",
//!     validity = "Comparisons with closed forms.",
//!     references = [],
//!     example = "viscosity = \"0.1 Pa s\"\n",
//! )]
//! impl OilSpec for Syrup {
//!     fn build(&self) -> Result<Box<dyn Oil>, BuildError> {
//!         Ok(Box::new(Running(self.viscosity.si())))
//!     }
//! }
//!
//! #[derive(Debug)]
//! struct Running(f64);
//! impl Oil for Running {
//!     fn viscosity(&self, _temperature: f64) -> f64 {
//!         self.0
//!     }
//! }
//!
//! let all = gudgeon_core::Registry::collect();
//! assert_eq!(all.model("oil", "syrup").map(|m| m.summary), Some("an oil that does not know its temperature"));
//! ```
//!
//! [`register_model`](crate::register_model) makes the model readable from a case file and describes it: the commands `models`, `describe`
//! and `schema`, the contract tests and the documentation read nothing else.

use std::any::Any;
use std::collections::BTreeMap;
use std::fmt;
use std::sync::OnceLock;

use crate::content::{self, Content};

/// One registered model.
#[derive(Debug)]
pub struct ModelInfo {
    /// The kind it implements, `gas_flow`.
    pub kind: &'static str,
    /// Makes whoever keeps this keep the registration of the kind.
    #[doc(hidden)]
    pub keeps_kind: fn(),
    /// Its name in a case file, `orifice_network`. Equals the file name of its source.
    pub name: &'static str,
    /// One line.
    pub summary: &'static str,
    /// The governing equations, as text.
    pub equations: &'static str,
    /// Where it holds and where it does not.
    pub validity: &'static str,
    /// Keys into `REFERENCES.bib`.
    pub references: &'static [&'static str],
    /// A complete, runnable specification in TOML, without the table header.
    pub example: &'static str,
    /// Reads the specification, without its `model` key, as a `Box<dyn …Spec>` of its kind.
    pub read: fn(&Content) -> Result<Box<dyn Any>, content::Error>,
    /// JSON schema of the specification without its `model` key.
    pub schema: fn(&mut schemars::SchemaGenerator) -> schemars::Schema,
    /// Module that registers it, `gudgeon_gas::orifice_network`; its first word is the crate.
    pub module: &'static str,
    /// Source file.
    pub file: &'static str,
    /// Source line.
    pub line: u32,
}
inventory::collect!(ModelInfo);

impl ModelInfo {
    /// The crate that registers it, `gudgeon_gas`.
    #[must_use]
    pub fn crate_name(&self) -> &'static str {
        crate_of(self.module)
    }
}

/// One kind of sub-model.
#[derive(Debug)]
pub struct KindInfo {
    /// Name in a case file, `gas_flow`.
    pub kind: &'static str,
    /// What a model of this kind answers.
    pub summary: &'static str,
    /// Reads a specification (with its `model` key) and writes it back with every default filled in.
    pub resolve: fn(serde_json::Value) -> Result<serde_json::Value, serde_json::Error>,
    /// Module that registers it.
    pub module: &'static str,
}
inventory::collect!(KindInfo);

impl KindInfo {
    /// The crate that registers it, `gudgeon_core`.
    #[must_use]
    pub fn crate_name(&self) -> &'static str {
        crate_of(self.module)
    }
}

fn crate_of(module: &'static str) -> &'static str {
    module.split("::").next().unwrap_or(module)
}

/// The configuration of a kind of sub-model, as a trait object.
pub trait Kind {
    /// Name in a case file, `gas_flow`.
    const NAME: &'static str;
    /// As [`Linked::ANCHOR`], of the kind itself.
    #[doc(hidden)]
    const ANCHOR: fn();
}

/// A type whose registration the linker can be made to keep; `R` is what it is registered as. The registering attributes and macros
/// implement it.
pub trait Linked<R: ?Sized> {
    /// A function that is compiled beside the registration. Whoever holds its address holds the registration too.
    #[doc(hidden)]
    const ANCHOR: fn();
}

/// Writes `pub fn link() -> usize`, which keeps the registrations of all listed types: every model and scene that a crate
/// registers. Stands once in the crate's root.
///
/// A linker drops parts of a library that nothing refers to. A registration is such a part: nothing calls it, it runs before `main`. On
/// Linux, macOS and Windows it is kept when the program names its crate at all, by this call or by `use the_crate as _;`. On WebAssembly
/// each compiled part of a crate is kept or dropped by itself, and only a reference to every registration keeps them all.
///
/// ```
/// mod oils {
///     # use gudgeon_core::kinds::{Oil, OilSpec};
///     # use gudgeon_core::{BuildError, register_model};
///     # #[derive(Debug, Clone, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
///     # #[serde(deny_unknown_fields)]
///     pub struct Water {}
///     # #[register_model(name = "water", summary = "1 mPa s", equations = "mu = 1e-3", validity = "20 degC", references = [], example = "")]
///     # impl OilSpec for Water {
///     #     fn build(&self) -> Result<Box<dyn Oil>, BuildError> {
///     #         Ok(Box::new(Thin))
///     #     }
///     # }
///     # #[derive(Debug)]
///     # struct Thin;
///     # impl Oil for Thin {
///     #     fn viscosity(&self, _: f64) -> f64 {
///     #         1e-3
///     #     }
///     # }
///     // … with `#[register_model(…)] impl OilSpec for Water`
/// }
///
/// gudgeon_core::link!(oils::Water);
///
/// assert_eq!(link(), 1);
/// ```
///
/// A WebAssembly module has no `main`, before which registrations could run. Either its linker makes every exported function run them first
/// (it does so where the module does not run them itself; running twice does no harm), or the module exports a function that calls
/// `__wasm_call_ctors` and the host calls that once, before all others; `tests/wasm` is such a module.
#[macro_export]
macro_rules! link {
    ($($registered:ty),* $(,)?) => {
        /// Makes the linker keep every model and scene that this crate registers, on every target, and gives their number
        /// ([`gudgeon_core::link!`]). Calling it once, anywhere in a program, is enough.
        pub fn link() -> usize {
            $crate::registry::keep(&[$(<$registered as $crate::registry::Linked<_>>::ANCHOR),*])
        }
    };
}

/// What [`link!`](crate::link) calls: the optimiser must take the addresses for used.
#[doc(hidden)]
#[must_use]
pub fn keep(anchors: &[fn()]) -> usize {
    std::hint::black_box(anchors).len()
}

/// A model that stands where a case names none.
#[derive(Debug)]
pub struct DefaultModel {
    /// Its kind.
    pub kind: &'static str,
    /// Its name.
    pub name: &'static str,
    /// Source file of the default.
    pub file: &'static str,
    /// Source line of the default.
    pub line: u32,
}
inventory::collect!(DefaultModel);

/// Everything registered in this program, sorted by kind and name.
#[derive(Debug)]
pub struct Registry {
    kinds: &'static Kinds,
}

/// Kinds with their models, by name.
type Kinds = BTreeMap<&'static str, (&'static KindInfo, Vec<&'static ModelInfo>)>;

/// The registry contradicts itself. Both places are named so that either can be mended.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RegistryError {
    /// Two models of one kind share a name.
    #[error("the {kind} model `{name}` is registered twice: {first} and {second}")]
    Duplicate {
        /// The kind.
        kind: &'static str,
        /// The name they share.
        name: String,
        /// `file:line` of one.
        first: String,
        /// `file:line` of the other.
        second: String,
    },
    /// A kind is registered twice, or a model names a kind that does not exist.
    #[error("the kind `{kind}` {what}")]
    Kind {
        /// The kind.
        kind: String,
        /// What is wrong with it.
        what: String,
    },
    /// A default names a model that does not exist or that needs settings.
    #[error("{place} takes the {kind} model `{name}` as a default: {what}")]
    Default {
        /// The kind.
        kind: &'static str,
        /// The name.
        name: &'static str,
        /// `file:line` of the default.
        place: String,
        /// What is wrong with it.
        what: String,
    },
}

impl Registry {
    /// Collects everything linked into this program: once, for nothing is registered later.
    #[must_use]
    pub fn collect() -> Self {
        static KNOWN: OnceLock<Kinds> = OnceLock::new();
        let all = || inventory::iter::<KindInfo>().map(|k| (k.kind, (k, models_of(k.kind)))).collect();
        Self { kinds: KNOWN.get_or_init(all) }
    }

    /// The kinds, by name.
    pub fn kinds(&self) -> impl Iterator<Item = &'static KindInfo> + '_ {
        self.kinds.values().map(|(k, _)| *k)
    }

    /// One kind.
    #[must_use]
    pub fn kind(&self, kind: &str) -> Option<&'static KindInfo> {
        self.kinds.get(kind).map(|(k, _)| *k)
    }

    /// The models of one kind, by name; empty for a kind that does not exist.
    #[must_use]
    pub fn models(&self, kind: &str) -> &[&'static ModelInfo] {
        self.kinds.get(kind).map_or(&[], |(_, m)| m)
    }

    /// One model.
    #[must_use]
    pub fn model(&self, kind: &str, name: &str) -> Option<&'static ModelInfo> {
        self.models(kind).iter().find(|m| m.name == name).copied()
    }

    /// Checks that names are unique and that every model can be both read and described.
    ///
    /// # Errors
    /// Every contradiction found.
    pub fn verify(&self) -> Result<(), Vec<RegistryError>> {
        let mut errors = Vec::new();
        let mut seen = BTreeMap::new();
        for k in inventory::iter::<KindInfo>() {
            *seen.entry(k.kind).or_insert(0) += 1;
        }
        for (kind, n) in seen {
            if n > 1 {
                errors.push(RegistryError::Kind {
                    kind: kind.into(),
                    what: format!("is registered {n} times"),
                });
            }
        }
        for m in inventory::iter::<ModelInfo>() {
            if !self.kinds.contains_key(m.kind) {
                let what = format!("does not exist, but {}:{} registers `{}` as one", m.file, m.line, m.name);
                errors.push(RegistryError::Kind { kind: m.kind.into(), what });
            }
        }
        for (kind, models) in self.kinds.values() {
            let place = |m: &ModelInfo| format!("{}:{}", m.file, m.line);
            for pair in models.windows(2) {
                if pair[0].name == pair[1].name {
                    errors.push(RegistryError::Duplicate {
                        kind: kind.kind,
                        name: pair[0].name.into(),
                        first: place(pair[0]),
                        second: place(pair[1]),
                    });
                }
            }
        }
        for d in inventory::iter::<DefaultModel>() {
            let read = |k: &KindInfo| (k.resolve)(serde_json::json!({ "model": d.name })).err();
            let what = match self.kind(d.kind) {
                None => Some("there is no such kind".to_owned()),
                Some(k) => read(k).map(|e| e.to_string()),
            };
            if let Some(what) = what {
                let place = format!("{}:{}", d.file, d.line);
                errors.push(RegistryError::Default { kind: d.kind, name: d.name, place, what });
            }
        }
        if errors.is_empty() { Ok(()) } else { Err(errors) }
    }
}

/// One line for every kind and every model, sorted, with the crate that registers it: the same text from the same models, on any target.
impl fmt::Display for Registry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for kind in self.kinds() {
            writeln!(f, "{} ({})", kind.kind, kind.crate_name())?;
            for m in self.models(kind.kind) {
                writeln!(f, "    {} ({})", m.name, m.crate_name())?;
            }
        }
        Ok(())
    }
}

/// The models that are registered for a kind, by name.
fn models_of(kind: &str) -> Vec<&'static ModelInfo> {
    let mut models: Vec<_> = inventory::iter::<ModelInfo>().filter(|m| m.kind == kind).collect();
    models.sort_by_key(|m| (m.name, m.file, m.line));
    models
}

/// Among the transforms of a generator it says that [`kind_schema`] tells no more of a model than its outline: its name, its line and, under
/// [`X_KIND`], its kind. Who reads such a schema asks for the whole of a model with [`model_schema`].
#[derive(Debug, Clone, Copy)]
pub struct Outlines;

impl schemars::transform::Transform for Outlines {
    fn transform(&mut self, _: &mut schemars::Schema) {}
}

/// Key of the outline of a model that holds its kind.
pub const X_KIND: &str = "x-kind";

/// JSON schema of a kind: one of its models, told apart by the `model` key. Of each model its outline alone where the generator has
/// [`Outlines`] among its transforms.
pub fn kind_schema(kind: &str, g: &mut schemars::SchemaGenerator) -> schemars::Schema {
    if g.settings().transforms.iter().any(|t| t.is::<Outlines>()) {
        return one_of(kind, outline);
    }
    whole_kind_schema(kind, g)
}

/// As [`kind_schema`], with the whole of every model.
pub fn whole_kind_schema(kind: &str, g: &mut schemars::SchemaGenerator) -> schemars::Schema {
    one_of(kind, |m| model_schema(m, g))
}

fn one_of(kind: &str, told: impl FnMut(&'static ModelInfo) -> serde_json::Value) -> schemars::Schema {
    let variants: Vec<serde_json::Value> =
        Registry::collect().models(kind).iter().copied().map(told).collect();
    let mut schema = schemars::Schema::default();
    schema.insert("oneOf".into(), variants.into());
    schema
}

/// JSON schema of a model with its `model` key.
pub fn model_schema(m: &ModelInfo, g: &mut schemars::SchemaGenerator) -> serde_json::Value {
    let mut schema = (m.schema)(g).to_value();
    if let Some(o) = schema.as_object_mut() {
        let properties = o.entry("properties").or_insert_with(|| serde_json::json!({}));
        if let Some(p) = properties.as_object_mut() {
            p.insert("model".into(), serde_json::json!({ "const": m.name }));
        }
        let required = o.entry("required").or_insert_with(|| serde_json::json!([]));
        if let Some(r) = required.as_array_mut() {
            r.push("model".into());
        }
        o.insert("description".into(), m.summary.into());
    }
    schema
}

fn outline(m: &'static ModelInfo) -> serde_json::Value {
    let mut tag = serde_json::Map::with_capacity(1);
    tag.insert("const".into(), m.name.into());
    let mut properties = serde_json::Map::with_capacity(1);
    properties.insert("model".into(), tag.into());
    let mut all = serde_json::Map::with_capacity(3);
    all.insert(X_KIND.into(), m.kind.into());
    all.insert("properties".into(), properties.into());
    all.insert("description".into(), m.summary.into());
    all.into()
}
