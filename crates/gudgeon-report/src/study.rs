//! The page of a study: how its results depend on its inputs.

use std::fmt::Write;

use gudgeon_core::result::{Figure, Series};
use indexmap::IndexMap;
use serde_json::json;

use crate::page::{self, Kind, esc};

/// What the page of a study shows.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct StudyPage {
    /// Title, or the name of the folder.
    pub title: String,
    /// What was run, in rows of two words: `points`, `1536`.
    pub facts: Vec<(String, String)>,
    /// The figures, in the order in which they are shown.
    pub figures: Vec<Figure>,
    /// The tables that they read.
    pub tables: IndexMap<String, Series>,
}

/// The page as one HTML file that works offline.
#[must_use]
pub fn study_page(p: &StudyPage) -> String {
    let mut body = String::new();
    let _ = write!(
        body,
        "<section id=\"overview\"><header><h1>{}</h1><p class=\"meta\">study</p></header>",
        esc(&p.title)
    );
    body.push_str("<h2>What was run</h2><table class=\"plain key\"><tbody>");
    for (name, text) in &p.facts {
        let _ = write!(body, "<tr><th scope=\"row\">{}</th><td>{}</td></tr>", esc(name), esc(text));
    }
    body.push_str("</tbody></table></section>\n");
    if !p.figures.is_empty() {
        body.push_str("<section id=\"curves\"><h2>What the results depend on</h2><div id=\"figures\" class=\"figures\"></div></section>\n");
    }
    let body = page::body(&[("overview", "Overview"), ("curves", "What the results depend on")], &body, "");
    let mut arrays = page::Arrays::default();
    let tables: serde_json::Map<String, serde_json::Value> =
        p.tables.iter().map(|(name, t)| (name.clone(), arrays.whole(t))).collect();
    let data = json!({ "tables": tables, "figures": p.figures, "arrays": arrays.into_json() });
    page::document(Kind::Study, &p.title, &body, &data)
}
