//! Specifications of models, read through the registration of the model that they name.

use std::any::Any;

use serde::de::{Deserialize, Deserializer, Error as _};

use crate::content::{Content, Error, MODEL};
use crate::registry::{Kind, ModelInfo};

/// The specification of a model of the kind `S`: a table whose key `model` names it.
///
/// # Errors
/// No such model, or settings that are not its own.
pub fn model<S: ?Sized + Kind + 'static>(content: Content) -> Result<Box<S>, Error> {
    match registered(S::NAME, content)?.downcast::<Box<S>>() {
        Ok(spec) => Ok(*spec),
        Err(_) => Err(Error::custom(format!("two kinds have the name `{}`", S::NAME))),
    }
}

/// The specification of a model of the kind `S` with its default settings.
///
/// # Errors
/// No such model, or one that has settings without a default.
pub fn plain_model<S: ?Sized + Kind + 'static>(name: &str) -> Result<Box<S>, Error> {
    model(Content::named(name))
}

/// What [`crate::register_kind`] writes for `Box<dyn …Spec>`: [`model`] from any source.
#[doc(hidden)]
pub fn model_from<'de, S: ?Sized + Kind + 'static, D: Deserializer<'de>>(
    from: D,
) -> Result<Box<S>, D::Error> {
    model(Content::deserialize(from)?).map_err(Error::hand_on)
}

/// The specification of the model that the table names, as the `Box<dyn …Spec>` that its registration makes.
fn registered(kind: &'static str, content: Content) -> Result<Box<dyn Any>, Error> {
    let Content::Table(mut entries) = content else {
        return Err(Error::invalid_type(content.unexpected(), &"a table with the key `model`"));
    };
    let Some(at) = entries.iter().position(|(key, _)| key == MODEL) else {
        return Err(Error::missing_field(MODEL));
    };
    let name = match entries.remove(at) {
        (_, Content::Text(name)) => name,
        (_, other) => return Err(Error::invalid_type(other.unexpected(), &"a string").under(MODEL)),
    };
    let of_kind = || inventory::iter::<ModelInfo>().filter(|m| m.kind == kind);
    match of_kind().find(|m| m.name == name) {
        Some(found) => (found.read)(&Content::Table(entries)),
        None => {
            let mut names: Vec<_> = of_kind().map(|m| m.name).collect();
            names.sort_unstable();
            Err(Error::unknown_word(name, names).under(MODEL))
        }
    }
}

/// Functions that give default models by name, read the way a case file would; [`Registry::verify`](crate::Registry::verify) finds a default that does not exist.
///
/// ```ignore
/// default_model! {
///     default_kinematics: dyn KinematicsSpec = "exact_slider_crank";
/// }
/// ```
#[macro_export]
macro_rules! default_model {
    ($($f:ident: $t:ty = $name:literal;)*) => {$(
        $crate::inventory::submit! {
            $crate::registry::DefaultModel {
                kind: <$t as $crate::registry::Kind>::NAME,
                name: $name,
                file: file!(),
                line: line!(),
            }
        }
        fn $f() -> Box<$t> {
            match $crate::spec::plain_model($name) {
                Ok(m) => m,
                Err(e) => panic!("the default `{}`: {e}", $name),
            }
        }
    )*};
}
