//! What a campaign found, for a person and for a program.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use serde_json::{Value, json};

use crate::campaign::{Record, median};
use crate::class::Class;

/// Cases of a bad class that are shown.
const SHOWN: usize = 10;
/// Characters of a detail that are shown.
const DETAIL: usize = 240;
/// Share of plausible cases that are not refused and end right or flagged, at least.
pub const HONEST: f64 = 0.99;

/// Counts of one scene: cases of each class, times.
#[derive(Debug, Default)]
pub struct Counts {
    /// By class.
    pub of: BTreeMap<Class, usize>,
    /// Times \[s\].
    pub seconds: Vec<f64>,
    /// Times of those that were not refused \[s\].
    pub run: Vec<f64>,
}

impl Counts {
    /// Of some records.
    pub fn of<'r>(records: impl Iterator<Item = &'r Record>) -> Self {
        let mut c = Self::default();
        for r in records {
            *c.of.entry(r.class).or_insert(0) += 1;
            c.seconds.push(r.seconds);
            if !matches!(r.class, Class::Refused | Class::RefusedWithoutPlace) {
                c.run.push(r.seconds);
            }
        }
        c
    }

    fn sum(&self, of: impl Fn(Class) -> bool) -> usize {
        self.of.iter().filter(|(c, _)| of(**c)).map(|(_, n)| n).sum()
    }

    /// Right or flagged, among those that were not refused; one where there are none.
    #[must_use]
    pub fn honest(&self) -> f64 {
        let legal = self.sum(|c| !matches!(c, Class::Refused | Class::RefusedWithoutPlace));
        if legal == 0 { 1.0 } else { self.sum(Class::honest) as f64 / legal as f64 }
    }

    /// Cases of a class that must not occur.
    #[must_use]
    pub fn forbidden(&self) -> usize {
        self.sum(Class::forbidden)
    }
}

/// Whether the program stood: nothing forbidden, and nearly all plausible legal cases right or flagged.
#[must_use]
pub fn stood(records: &[Record]) -> bool {
    Counts::of(records.iter()).forbidden() == 0
        && Counts::of(records.iter().filter(|r| !r.case.wild())).honest() >= HONEST
}

/// The tables and the worst cases, as text.
#[must_use]
pub fn text(records: &[Record]) -> String {
    let mut s = String::new();
    for (title, wild) in [("plausible", false), ("wild", true)] {
        table(&mut s, title, records.iter().filter(|r| r.case.wild() == wild).collect());
    }
    for class in Class::ALL.into_iter().rev().filter(|c| c.bad()) {
        worst(&mut s, class, records);
    }
    s
}

fn scenes(records: &[&Record]) -> Vec<String> {
    let mut all: Vec<String> = records.iter().map(|r| r.case.scene.clone()).collect();
    all.sort();
    all.dedup();
    all
}

fn table(s: &mut String, title: &str, records: Vec<&Record>) {
    if records.is_empty() {
        return;
    }
    let scenes = scenes(&records);
    let mut columns: Vec<Counts> =
        scenes.iter().map(|n| Counts::of(records.iter().copied().filter(|r| r.case.scene == *n))).collect();
    columns.push(Counts::of(records.iter().copied()));
    let mut row = |name: &str, cells: Vec<String>| {
        // Writing to a String cannot fail.
        let _ = writeln!(s, "{name:<24}{}", cells.iter().map(|c| format!("{c:>17}")).collect::<String>());
    };
    row(title, scenes.iter().map(String::as_str).chain(["all"]).map(str::to_owned).collect());
    for class in Class::ALL {
        let cells = columns.iter().map(|c| match c.of.get(&class) {
            None => "-".to_owned(),
            Some(n) => format!("{n} ({:.2} %)", 100.0 * *n as f64 / c.seconds.len() as f64),
        });
        row(class.name(), cells.collect());
    }
    row("cases", columns.iter().map(|c| c.seconds.len().to_string()).collect());
    row("of those not refused", columns.iter().map(|c| c.run.len().to_string()).collect());
    row("  right or flagged", columns.iter().map(|c| format!("{:.2} %", 100.0 * c.honest())).collect());
    row("  median time [s]", columns.iter().map(|c| format!("{:.3}", median(&c.run))).collect());
    let longest = |c: &Counts| c.seconds.iter().fold(0.0_f64, |m, v| m.max(*v));
    row("longest time [s]", columns.iter().map(|c| format!("{:.1}", longest(c))).collect());
    s.push('\n');
}

/// The defects of a class: the most frequent first, each with its shortest command.
#[must_use]
pub fn defects(class: Class, records: &[Record]) -> Vec<(&Record, usize)> {
    let mut found: BTreeMap<(&str, &str), (&Record, usize)> = BTreeMap::new();
    for r in records.iter().filter(|r| r.class == class) {
        let (least, n) = found.entry((&r.case.scene, &r.defect)).or_insert((r, 0));
        *n += 1;
        if (r.changes, r.command.len()) < (least.changes, least.command.len()) {
            *least = r;
        }
    }
    let mut all: Vec<_> = found.into_values().collect();
    all.sort_by_key(|(_, n)| std::cmp::Reverse(*n));
    all
}

fn worst(s: &mut String, class: Class, records: &[Record]) {
    let all = defects(class, records);
    if all.is_empty() {
        return;
    }
    // Writing to a String cannot fail.
    let _ = writeln!(s, "{}: {} defects", class.name(), all.len());
    for (r, n) in all.iter().take(SHOWN) {
        let detail: String = r.detail.chars().take(DETAIL).collect();
        let kind = if r.case.wild() { "wild" } else { "plausible" };
        let _ = writeln!(
            s,
            "  {n} x {}, {kind}, index {}: {detail}\n    {}",
            r.case.scene, r.case.index, r.command
        );
    }
    s.push('\n');
}

/// Everything, for a program to read.
#[must_use]
pub fn json(seed: u64, records: &[Record]) -> Value {
    json!({ "seed": seed, "cases": records.len(), "stood": stood(records), "records": records })
}
