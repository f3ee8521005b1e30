//! Links of the book that mdBook built.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use crate::{Outcome, files, read, relative, tidy};

/// Links of the pages of a book, and pictures, that lead nowhere. mdBook's own page for missing pages has links from the root and is left out.
///
/// # Errors
/// A folder that cannot be read.
pub fn broken(book: &Path) -> Outcome<(usize, Vec<String>)> {
    let pages: Vec<PathBuf> =
        files(book, ".html")?.into_iter().filter(|p| !p.ends_with("404.html")).collect();
    let mut ids: BTreeMap<PathBuf, BTreeSet<String>> = BTreeMap::new();
    let mut texts = Vec::new();
    for page in &pages {
        let text = read(page)?;
        ids.insert(page.clone(), values(&text, " id=\"").into_iter().collect());
        texts.push(text);
    }
    let (mut count, mut out) = (0, Vec::new());
    for (page, text) in pages.iter().zip(&texts) {
        for target in values(text, " href=\"").into_iter().chain(values(text, " src=\"")) {
            if target.contains("://") || target.starts_with("data:") || target.starts_with("mailto:") {
                continue;
            }
            count += 1;
            if let Some(why) = leads_nowhere(page, &target, &ids) {
                out.push(format!("{}: {target}: {why}", relative(book, page)));
            }
        }
    }
    Ok((count, out))
}

fn values(text: &str, before: &str) -> Vec<String> {
    let parts = text.split(before).skip(1);
    parts.filter_map(|p| p.split_once('"').map(|(v, _)| v.replace("&amp;", "&"))).collect()
}

fn leads_nowhere(page: &Path, target: &str, ids: &BTreeMap<PathBuf, BTreeSet<String>>) -> Option<String> {
    let (path, anchor) = target.split_once('#').unwrap_or((target, ""));
    let file = if path.is_empty() { page.to_owned() } else { tidy(&page.parent()?.join(path)) };
    if !file.is_file() {
        return Some("no such file".into());
    }
    let known = ids.get(&file)?;
    (!anchor.is_empty() && !known.contains(anchor)).then(|| "no such place on that page".into())
}
