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
        #[::gudgeon_core::__private::typetag::serde(tag = "model")]
        #item

        const _: () = {
            use ::gudgeon_core::__private::{dyn_clone, inventory, schemars, serde_json};
            use ::gudgeon_core::registry::{Kind, KindInfo, kind_schema};

            dyn_clone::clone_trait_object!(#spec);
            impl Kind for dyn #spec {
                const NAME: &'static str = #name;
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
                        let spec: ::std::boxed::Box<dyn #spec> = serde_json::from_value(v)?;
                        serde_json::to_value(&spec)
                    },
                    module: module_path!(),
                }
            }
        };
    })
}
