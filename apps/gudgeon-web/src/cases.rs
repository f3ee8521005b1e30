//! The cases that come with the page.

use gudgeon_core::file::Files;

/// Name and text of every case of the repository, as the folder `cases` has them.
pub const CASES: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/cases.rs"));

/// The files that a case may name: the other cases, by their place from the folder of this one.
#[must_use]
pub fn files(case: &str) -> Files {
    let folder = case.rfind('/').map_or("", |k| &case[..=k]);
    let up = "../".repeat(folder.matches('/').count());
    let beside = |name: &str| match name.strip_prefix(folder) {
        Some(rest) => rest.to_owned(),
        None => format!("{up}{name}"),
    };
    Files::recorded(CASES.iter().map(|(name, text)| (beside(name), (*text).to_owned())))
}
