//! `name = value` pairs between the parentheses of an attribute.

use proc_macro2::Span;
use syn::parse::{Parse, ParseStream};
use syn::{Error, Expr, Ident, Token};

/// The pairs, in the order in which they stand.
pub struct Fields(Vec<(Ident, Expr)>);

impl Parse for Fields {
    fn parse(input: ParseStream<'_>) -> syn::Result<Self> {
        let mut all: Vec<(Ident, Expr)> = Vec::new();
        while !input.is_empty() {
            let name: Ident = input.parse()?;
            if all.iter().any(|(n, _)| *n == name) {
                return Err(Error::new(name.span(), format!("`{name}` stands here for the second time")));
            }
            input.parse::<Token![=]>()?;
            all.push((name, input.parse()?));
            if !input.is_empty() {
                input.parse::<Token![,]>()?;
            }
        }
        Ok(Self(all))
    }
}

impl Fields {
    /// The values of the fields in `names`, all of which must be given, and no other.
    ///
    /// # Errors
    /// A field that is missing or unknown.
    pub fn take<const N: usize>(self, names: [&str; N]) -> syn::Result<[Expr; N]> {
        if let Some((name, _)) = self.0.iter().find(|(n, _)| !names.iter().any(|k| n == k)) {
            let text = format!("unknown field `{name}`; the fields are {}", names.join(", "));
            return Err(Error::new(name.span(), text));
        }
        let find = |name: &str| self.0.iter().find(|(n, _)| n == name).map(|(_, v)| v.clone());
        let mut found = Vec::with_capacity(N);
        for name in names {
            let missing = || Error::new(Span::call_site(), format!("the field `{name}` is missing"));
            found.push(find(name).ok_or_else(missing)?);
        }
        found.try_into().map_err(|_| Error::new(Span::call_site(), "fields are missing"))
    }
}
