//! The page of a study: how its results depend on its inputs.

use std::fmt::Write;

use gudgeon_core::result::{Figure, Grade, Series};
use indexmap::IndexMap;
use serde_json::json;

use crate::number::capital;
use crate::overview::banner;
use crate::page::{self, Kind, esc};

/// What the page of a study shows.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct StudyPage {
    /// Title, or the name of the folder.
    pub title: String,
    /// Titles of its cases.
    pub cases: Vec<String>,
    /// Whether its points can be relied on, in one line.
    pub verdict: (Grade, String),
    /// Why points have no result, and their reservations in words, each with how many points and where the first is.
    pub said: Vec<String>,
    /// What the cases assume.
    pub assumptions: Vec<String>,
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
    overview(&mut body, p);
    if !p.figures.is_empty() {
        body.push_str("<section id=\"curves\"><h2>What the results depend on</h2><div id=\"figures\" class=\"figures\"></div></section>\n");
    }
    list(&mut body, "notes", "What the points say", &p.said);
    list(&mut body, "assumptions", "Assumed inputs", &p.assumptions);
    body.push_str("<section id=\"run\"><h2>What was run</h2><table class=\"plain key\"><tbody>");
    for (name, text) in &p.facts {
        let _ = write!(body, "<tr><th scope=\"row\">{}</th><td>{}</td></tr>", esc(name), esc(text));
    }
    body.push_str("</tbody></table></section>\n");
    let body = page::body(&CONTENTS, &body, "", &[]);
    let mut arrays = page::Arrays::default();
    let tables: IndexMap<String, page::Placed> =
        p.tables.iter().map(|(name, t)| (name.clone(), arrays.whole(t))).collect();
    let data = json!({ "tables": tables, "figures": p.figures });
    page::document(Kind::Study, &p.title, &body, &data, Some(&arrays))
}

/// Sections in their order, with their names in the contents at the side.
const CONTENTS: [(&str, &str); 5] = [
    ("overview", "Overview"),
    ("curves", "What the results depend on"),
    ("notes", "What the points say"),
    ("assumptions", "Assumed inputs"),
    ("run", "What was run"),
];

fn overview(out: &mut String, p: &StudyPage) {
    let _ = write!(
        out,
        "<section id=\"overview\"><header><h1>{}</h1><p class=\"meta\">study · {}</p></header>",
        esc(&p.title),
        esc(&p.cases.join(" · "))
    );
    banner(out, p.verdict.0, &p.verdict.1, &p.said);
    out.push_str("</section>\n");
}

fn list(out: &mut String, id: &str, title: &str, lines: &[String]) {
    if lines.is_empty() {
        return;
    }
    let _ = write!(out, "<section id=\"{id}\"><h2>{title}</h2><ul>");
    for line in lines {
        let _ = write!(out, "<li>{}</li>", page::prose(&capital(line)));
    }
    out.push_str("</ul></section>\n");
}
