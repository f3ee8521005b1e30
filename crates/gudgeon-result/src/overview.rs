//! What the first page of a report tells: the results that lead, and whether they can be relied on.

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use crate::{Note, NoteLevel, RunResult, Value};

/// Topic of the note that says how many limits of a case are kept.
pub const VERDICT: &str = "verdict";

/// A result, or one result of each member of a family, that a reader looks at first.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Headline {
    /// What it is, in a few words: `Blow-by`.
    pub title: String,
    /// Label and name of each result: one with an empty label, or one a ring, `("ring 1", "ring1.h_min")`.
    pub results: Vec<(String, String)>,
    /// Columns of [`RunResult::series`] that a small picture shows beside the number.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub curves: Vec<String>,
}

impl Headline {
    /// One result.
    #[must_use]
    pub fn one(title: &str, result: &str) -> Self {
        Self::each(title, [(String::new(), result.to_owned())])
    }

    /// The same result of several members, each with its label.
    #[must_use]
    pub fn each(title: &str, results: impl IntoIterator<Item = (String, String)>) -> Self {
        Self { title: title.into(), results: results.into_iter().collect(), curves: Vec::new() }
    }

    /// With the curves that its picture shows.
    #[must_use]
    pub fn over(mut self, curves: &[&str]) -> Self {
        self.curves = curves.iter().map(|c| (*c).to_owned()).collect();
        self
    }

    /// As part `part` of a whole: `rings` makes `blow_by` into `rings.blow_by`. Columns keep their names.
    #[must_use]
    pub fn within(mut self, part: &str) -> Self {
        for (_, name) in &mut self.results {
            *name = format!("{part}.{name}");
        }
        self
    }

    /// What is left of it where only some results and columns are there; none where no result is.
    #[must_use]
    pub fn known(mut self, result: impl Fn(&str) -> bool, column: impl Fn(&str) -> bool) -> Option<Self> {
        self.results.retain(|(_, name)| result(name));
        self.curves.retain(|name| column(name));
        (!self.results.is_empty()).then_some(self)
    }
}

/// Whether results can be relied on.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Grade {
    /// Nothing acted, and every limit of the case is kept.
    #[default]
    Green,
    /// Valid, with reservations that are told: a floor, a cap or a limit of validity acted.
    Amber,
    /// A limit of the case is not kept, or the results are not what was asked for.
    Red,
}

impl Grade {
    /// Its name, for people who do not see colours as well: `green`, `amber`, `red`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Green => "green",
            Self::Amber => "amber",
            Self::Red => "red",
        }
    }
}

/// A grade with its reasons.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Assessment {
    /// The grade.
    pub grade: Grade,
    /// It in one line.
    pub title: String,
    /// What it rests on, the gravest first; what is about numerics alone last.
    pub reasons: Vec<String>,
}

impl Assessment {
    /// What the notes of a run amount to.
    #[must_use]
    pub fn of(notes: &[Note]) -> Self {
        let of = |level| notes.iter().filter(move |n| n.level == level && n.topic != VERDICT);
        let limits = notes.iter().find(|n| n.topic == VERDICT).map(|n| capital(told(&n.text)));
        let mut grave_first: Vec<&Note> =
            [NoteLevel::Failure, NoteLevel::Exceeded, NoteLevel::Caution].into_iter().flat_map(of).collect();
        grave_first.sort_by_key(|n| n.numerical);
        let reasons: Vec<String> = grave_first.iter().map(|n| n.text.clone()).collect();
        let numerical = grave_first.iter().filter(|n| n.numerical).count();
        let broken = notes.iter().filter(|n| n.level == NoteLevel::Exceeded).count();
        let grave = notes.iter().map(|n| n.level).max().unwrap_or_default();
        let (grade, title) = match grave {
            NoteLevel::Failure => (Grade::Red, "Not what was asked for: do not use these results".to_owned()),
            NoteLevel::Exceeded => {
                let count =
                    if broken == 1 { "A limit is".to_owned() } else { format!("{broken} limits are") };
                (Grade::Red, limits.unwrap_or_else(|| format!("{count} not kept")))
            }
            NoteLevel::Caution => {
                let n = reasons.len();
                let plural = if n == 1 { "" } else { "s" };
                let kept = limits.map_or_else(|| "Valid".to_owned(), |l| format!("{l}. Valid"));
                let of_them = match numerical {
                    0 => String::new(),
                    1 if n == 1 => ", of numerics".to_owned(),
                    k if k == n => ", all of numerics".to_owned(),
                    k => format!(", {k} of numerics"),
                };
                (Grade::Amber, format!("{kept} with {n} reservation{plural}{of_them}"))
            }
            NoteLevel::Info => {
                let nothing = || "Valid: no floor, cap or limit of validity acted".to_owned();
                (Grade::Green, limits.unwrap_or_else(nothing))
            }
        };
        Self { grade, title, reasons }
    }
}

/// The text of a verdict without its own heading.
fn told(text: &str) -> &str {
    text.strip_prefix("verdict: ").unwrap_or(text)
}

fn capital(text: &str) -> String {
    let mut chars = text.chars();
    chars.next().map_or_else(String::new, |c| c.to_uppercase().chain(chars).collect())
}

/// Most results that lead where a scene names none.
const UNNAMED: usize = 6;

impl RunResult {
    /// The headlines of the scene that this run has results for; the first results where the scene names none.
    #[must_use]
    pub fn leading(&self) -> Vec<Headline> {
        let column = |name: &str| self.series.get(name).is_some();
        let known = |h: &Headline| h.clone().known(|r| self.results.contains_key(r), column);
        let own: Vec<Headline> = self.headlines.iter().filter_map(known).collect();
        if own.is_empty() { first(&self.results) } else { own }
    }

    /// Whether the results can be relied on.
    #[must_use]
    pub fn assessment(&self) -> Assessment {
        Assessment::of(&self.solver.notes)
    }
}

fn first(results: &IndexMap<String, Value>) -> Vec<Headline> {
    results.iter().take(UNNAMED).map(|(name, v)| Headline::one(&capital(&v.what), name)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_gravest_note_grades_a_run() {
        let note = |level, topic: &str, text: &str| Note {
            level,
            topic: topic.into(),
            text: text.into(),
            ..Note::default()
        };
        let kept = note(NoteLevel::Info, VERDICT, "verdict: all 3 limits are kept");
        let floor = note(NoteLevel::Caution, "floor", "a floor acted");
        let broken = note(NoteLevel::Exceeded, "verdict.a", "beyond the limit: a");
        let said = note(NoteLevel::Exceeded, VERDICT, "verdict: 1 of 3 limits are not kept");
        let failed = note(NoteLevel::Failure, "not_periodic", "not periodic");
        let of = |notes: &[&Note]| Assessment::of(&notes.iter().map(|n| (*n).clone()).collect::<Vec<_>>());
        assert_eq!(of(&[]).grade, Grade::Green);
        assert_eq!(of(&[&kept]).title, "All 3 limits are kept");
        let amber = of(&[&kept, &floor]);
        assert_eq!(
            (amber.grade, amber.title.as_str()),
            (Grade::Amber, "All 3 limits are kept. Valid with 1 reservation")
        );
        let drag = Note::caution("drag", "a drag acted").of_numerics();
        let both = of(&[&drag, &floor]);
        assert_eq!(
            (both.title.as_str(), both.reasons[0].as_str()),
            ("Valid with 2 reservations, 1 of numerics", "a floor acted")
        );
        let red = of(&[&floor, &said, &broken]);
        assert_eq!((red.grade, red.title.as_str()), (Grade::Red, "1 of 3 limits are not kept"));
        assert_eq!(red.reasons, ["beyond the limit: a", "a floor acted"]);
        let worst = of(&[&broken, &failed]);
        assert_eq!((worst.grade, worst.reasons[0].as_str()), (Grade::Red, "not periodic"));
    }

    #[test]
    fn headlines_keep_what_a_run_has() {
        let h = Headline::each(
            "Film",
            [("ring 1".into(), "ring1.h".into()), ("ring 2".into(), "ring2.h".into())],
        )
        .over(&["ring1.h", "ring3.h"]);
        let kept = h.clone().known(|r| r == "ring2.h", |c| c == "ring1.h").unwrap();
        assert_eq!((kept.results.len(), kept.curves.as_slice()), (1, &["ring1.h".to_owned()][..]));
        assert_eq!(h.known(|_| false, |_| true), None);
    }
}
