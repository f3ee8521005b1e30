//! What the points of a study have to say: their reservations, and why some have no result.

use gudgeon_core::result::IMPOSSIBLE;
use indexmap::IndexMap;

use super::table::{Table, Values};

/// Column of the reservations of a point in words, a line each, `topic: text`.
pub const RESERVATIONS: &str = "reservations";

/// A line of that column.
pub fn line(topic: &str, text: &str) -> String {
    format!("{topic}: {}", text.replace('\n', " "))
}

/// What some points say of one subject.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Said {
    /// Its topic: that of a note, or [`IMPOSSIBLE`], `failed`.
    pub topic: String,
    /// In the words of the first point.
    pub text: String,
    /// Rows of the points, ascending.
    pub rows: Vec<usize>,
}

impl Said {
    /// Whether these points have no result.
    #[must_use]
    pub fn is_missing(&self) -> bool {
        self.topic == IMPOSSIBLE || self.topic == FAILED
    }
}

/// Topic of points that failed or were refused.
const FAILED: &str = "failed";

impl Table {
    fn texts(&self, name: &str) -> Option<&[Option<String>]> {
        match &self.columns.get(name)?.values {
            Values::Texts(v) => Some(v),
            _ => None,
        }
    }

    /// What the points of a study say, by topic: first why some have no result, then their reservations, those about numerics alone apart.
    #[must_use]
    pub fn said(&self) -> Vec<Said> {
        let mut all: IndexMap<String, Said> = IndexMap::new();
        let mut say = |topic: &str, text: &str, row: usize| {
            let new = || Said { topic: topic.to_owned(), text: text.to_owned(), rows: Vec::new() };
            all.entry(topic.to_owned()).or_insert_with(new).rows.push(row);
        };
        let text = |column: Option<&[Option<String>]>, row: usize| -> String {
            column.and_then(|c| c.get(row)?.clone()).unwrap_or_default()
        };
        let (codes, messages) = (self.texts("code"), self.texts("message"));
        for row in 0..self.rows() {
            match text(codes, row).as_str() {
                "" => {}
                IMPOSSIBLE => say(IMPOSSIBLE, &text(messages, row), row),
                _ => say(FAILED, &text(messages, row), row),
            }
        }
        let told = self.texts(RESERVATIONS);
        for row in 0..self.rows() {
            for (topic, what) in text(told, row).lines().filter_map(|l| l.split_once(": ")) {
                say(topic, what, row);
            }
        }
        all.into_values().collect()
    }
}
