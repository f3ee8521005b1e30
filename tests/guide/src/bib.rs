//! REFERENCES.bib, as far as a list of references needs it.

use std::collections::BTreeMap;

use crate::{Outcome, read, root};

/// One entry.
#[derive(Debug, Clone)]
pub struct Entry {
    /// `mastersthesis`, `article`, …
    pub what: String,
    /// Its fields, by name, without braces and accents of TeX.
    pub fields: BTreeMap<String, String>,
}

/// All entries by key.
///
/// # Errors
/// The file cannot be read.
pub fn entries() -> Outcome<BTreeMap<String, Entry>> {
    let text = read(&root().join("REFERENCES.bib"))?;
    Ok(text.split("\n@").skip(1).filter_map(entry).collect())
}

fn entry(text: &str) -> Option<(String, Entry)> {
    let (what, rest) = text.split_once('{')?;
    let (key, rest) = rest.split_once(',')?;
    let field = |line: &str| {
        let (name, value) = line.split_once('=')?;
        let value = value.trim().trim_end_matches(',').strip_prefix('{')?.strip_suffix('}')?;
        Some((name.trim().to_owned(), plain(value)))
    };
    Some((
        key.trim().to_owned(),
        Entry { what: what.into(), fields: rest.lines().filter_map(field).collect() },
    ))
}

/// TeX's accents and braces as characters.
fn plain(tex: &str) -> String {
    const ACCENTS: [(&str, &str); 16] = [
        ("{\\c{c}}", "ç"),
        ("{\\~a}", "ã"),
        ("{\\'e}", "é"),
        ("{\\'a}", "á"),
        ("{\\'i}", "í"),
        ("{\\'o}", "ó"),
        ("{\\\"a}", "ä"),
        ("{\\\"o}", "ö"),
        ("{\\\"u}", "ü"),
        ("{\\\"A}", "Ä"),
        ("{\\\"O}", "Ö"),
        ("{\\\"U}", "Ü"),
        ("{\\l}", "ł"),
        ("{\\c{C}}", "Ç"),
        ("\\&", "&"),
        ("--", "–"),
    ];
    let mut out = tex.to_owned();
    for (from, to) in ACCENTS {
        out = out.replace(from, to);
    }
    out.replace(['{', '}'], "")
}

impl Entry {
    /// One sentence that names the work.
    #[must_use]
    pub fn line(&self) -> String {
        let get = |name: &str| self.fields.get(name).map(String::as_str);
        let volume = get("volume").map(|v| format!("vol. {v}"));
        let number = get("number").map(|v| format!("no. {v}"));
        let pages = get("pages").map(|v| format!("pp. {v}"));
        let doi = get("doi").map(|v| format!("doi {v}"));
        let own = |name: &str| get(name).map(str::to_owned);
        let place =
            ["journal", "booktitle", "school", "institution", "organization", "publisher", "howpublished"];
        let parts: Vec<String> = [own("author"), own("title").map(|t| format!("*{t}*"))]
            .into_iter()
            .chain(place.iter().map(|p| own(p)))
            .chain([volume, number, pages, own("year"), doi])
            .flatten()
            .collect();
        let note = get("note").map_or(String::new(), |n| format!(" {n}."));
        format!("{}.{note}", parts.join(", "))
    }
}
