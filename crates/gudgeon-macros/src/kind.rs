//! `#[register_kind]`

use proc_macro2::TokenStream;
use quote::quote;
use syn::ItemTrait;

use crate::fields::Fields;

pub fn expand(fields: Fields, item: TokenStream) -> syn::Result<TokenStream> {
    let [name, summary] = fields.take(["name", "summary"])?;
    let item: ItemTrait = syn::parse2(item)?;
    let spec = &item.ident;
    Ok(quote! {
        #[::gudgeon_core::__private::typetag::serialize(tag = "model")]
        #item

        const _: () = {
            use ::gudgeon_core::__private::{dyn_clone, inventory, schemars, serde, serde_json};
            use ::gudgeon_core::registry::{Kind, KindInfo, kind_schema};

            dyn_clone::clone_trait_object!(#spec);
            impl Kind for dyn #spec {
                const NAME: &'static str = #name;
                const ANCHOR: fn() = anchor;
            }
            // Stands in the same object file as the registration.
            #[inline(never)]
            fn anchor() {}
            impl<'de> serde::Deserialize<'de> for ::std::boxed::Box<dyn #spec> {
                fn deserialize<D: serde::Deserializer<'de>>(from: D) -> ::std::result::Result<Self, D::Error> {
                    ::gudgeon_core::spec::model_from(from)
                }
            }
            impl schemars::JsonSchema for dyn #spec {
                fn inline_schema() -> bool {
                    false
                }
                fn schema_name() -> ::std::borrow::Cow<'static, str> {
                    #name.into()
                }
                fn json_schema(g: &mut schemars::SchemaGenerator) -> schemars::Schema {
                    kind_schema(#name, g)
                }
            }
            inventory::submit! {
                KindInfo {
                    kind: #name,
                    summary: #summary,
                    resolve: |v| {
                        let spec = ::gudgeon_core::spec::model::<dyn #spec>((&v).into());
                        let spec = spec.map_err(::gudgeon_core::content::Error::hand_on::<serde_json::Error>)?;
                        serde_json::to_value(&spec)
                    },
                    module: module_path!(),
                }
            }
        };
    })
}
