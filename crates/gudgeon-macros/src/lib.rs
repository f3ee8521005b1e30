//! The attributes that register kinds and models. `gudgeon-core` documents and exports them; nothing else names this crate.

mod fields;
mod kind;
mod model;

use proc_macro::TokenStream;

/// Registers a kind of sub-model, on the trait of its configuration. Documented in `gudgeon_core::registry`.
#[proc_macro_attribute]
pub fn register_kind(fields: TokenStream, item: TokenStream) -> TokenStream {
    expand(fields, item, kind::expand)
}

/// Registers a model, on the implementation of its kind's trait. Documented in `gudgeon_core::registry`.
#[proc_macro_attribute]
pub fn register_model(fields: TokenStream, item: TokenStream) -> TokenStream {
    expand(fields, item, model::expand)
}

/// What an attribute makes of its fields and the item it stands on.
type Expand = fn(fields::Fields, proc_macro2::TokenStream) -> Result<proc_macro2::TokenStream, syn::Error>;

fn expand(fields: TokenStream, item: TokenStream, with: Expand) -> TokenStream {
    let read = syn::parse::<fields::Fields>(fields).and_then(|f| with(f, item.into()));
    read.unwrap_or_else(|e| e.to_compile_error()).into()
}
