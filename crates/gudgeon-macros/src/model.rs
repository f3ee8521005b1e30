//! `#[register_model]`

use proc_macro2::TokenStream;
use quote::quote;
use syn::{Error, Expr, ItemImpl};

use crate::fields::Fields;

pub fn expand(fields: Fields, item: TokenStream) -> syn::Result<TokenStream> {
    let [name, summary, equations, validity, references, example] =
        fields.take(["name", "summary", "equations", "validity", "references", "example"])?;
    let item: ItemImpl = syn::parse2(item)?;
    let Some((spec, _)) = &item.trait_ else {
        return Err(Error::new_spanned(&item.self_ty, "stands on `impl …Spec for …`"));
    };
    let Expr::Array(references) = references else {
        return Err(Error::new_spanned(references, "a list of keys: `[\"key\"]`, or `[]`"));
    };
    let own = &item.self_ty;
    Ok(quote! {
        const _: () = {
            use ::gudgeon_core::__private::{inventory, schemars, typetag};

            #[typetag::serialize(name = #name)]
            #item

            inventory::submit! {
                ::gudgeon_core::registry::ModelInfo {
                    kind: <dyn #spec as ::gudgeon_core::registry::Kind>::NAME,
                    keeps_kind: <dyn #spec as ::gudgeon_core::registry::Kind>::ANCHOR,
                    name: #name,
                    summary: #summary,
                    equations: #equations,
                    validity: #validity,
                    references: &#references,
                    example: #example,
                    read: |content| {
                        let spec: #own = ::gudgeon_core::content::read(content)?;
                        let spec: ::std::boxed::Box<dyn #spec> = ::std::boxed::Box::new(spec);
                        Ok(::std::boxed::Box::new(spec))
                    },
                    schema: |g| <#own as schemars::JsonSchema>::json_schema(g),
                    module: module_path!(),
                    file: file!(),
                    line: line!(),
                }
            }

            // Stands in the same object file as the registration.
            #[inline(never)]
            fn anchor() {}
            impl ::gudgeon_core::registry::Linked<dyn #spec> for #own {
                const ANCHOR: fn() = anchor;
            }
        };
    })
}
