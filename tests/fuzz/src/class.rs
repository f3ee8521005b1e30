//! What an outcome is: one class each.

use serde::{Deserialize, Serialize};

use crate::execute::{End, Outcome};

/// Classes of outcomes, the worst first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Class {
    /// The program panicked, or its process ended.
    Panic,
    /// It did not end in time.
    Hang,
    /// A result, or a value of a series or a table, is not a finite number.
    NotANumber,
    /// The input was refused, but not every mistake has a place in the file or in a `--set` argument.
    RefusedWithoutPlace,
    /// Two runs of one case differ.
    Nondeterministic,
    /// A balance does not close, and no note says that anything acted.
    Unbalanced,
    /// A result is beyond what any machine does, and no note says so.
    Absurd,
    /// A result moves when the numerical settings are refined, and no note says so.
    ChangedByTolerance,
    /// The run failed and says why.
    Failed,
    /// The input was refused, every mistake at its place.
    Refused,
    /// There are results, with a note that something acted or failed.
    Flagged,
    /// There are results, and nothing is to be said about them.
    Right,
}

/// Most that a balance of mass or of oil is open.
const MASS: f64 = 1e-6;
/// Most that a balance of energy or momentum is open: it goes with the tolerance, not with rounding.
const MOTION: f64 = 1e-2;

impl Class {
    /// All classes, the best first.
    pub const ALL: [Self; 12] = [
        Self::Right,
        Self::Flagged,
        Self::Refused,
        Self::Failed,
        Self::ChangedByTolerance,
        Self::Absurd,
        Self::Unbalanced,
        Self::Nondeterministic,
        Self::RefusedWithoutPlace,
        Self::NotANumber,
        Self::Hang,
        Self::Panic,
    ];

    /// Its name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Panic => "panic",
            Self::Hang => "hang",
            Self::NotANumber => "not_a_number",
            Self::RefusedWithoutPlace => "refused_without_place",
            Self::Nondeterministic => "nondeterministic",
            Self::Unbalanced => "unbalanced",
            Self::Absurd => "absurd",
            Self::ChangedByTolerance => "changed_by_tolerance",
            Self::Failed => "failed",
            Self::Refused => "refused",
            Self::Flagged => "flagged",
            Self::Right => "right",
        }
    }

    /// Whether no case at all may come out so.
    #[must_use]
    pub const fn forbidden(self) -> bool {
        matches!(
            self,
            Self::Panic
                | Self::Hang
                | Self::NotANumber
                | Self::RefusedWithoutPlace
                | Self::Nondeterministic
                | Self::Unbalanced
                | Self::Absurd
        )
    }

    /// Whether an engineer can work with the answer: results that are right, or say what is the matter with them.
    #[must_use]
    pub const fn honest(self) -> bool {
        matches!(self, Self::Right | Self::Flagged)
    }

    /// Whether it is reported with its cases.
    #[must_use]
    pub const fn bad(self) -> bool {
        self.forbidden() || matches!(self, Self::ChangedByTolerance | Self::Failed)
    }
}

/// The class of an outcome, and what makes it so.
#[must_use]
pub fn classify(o: &Outcome) -> (Class, String) {
    match &o.end {
        End::Panic { place, message } => return (Class::Panic, format!("{place}: {message}")),
        End::Died(how) => return (Class::Panic, how.clone()),
        End::Hang => return (Class::Hang, "not ended in time".into()),
        End::NotANumber(name) => return (Class::NotANumber, format!("the result {name}")),
        End::Refused { message, placed: false } => return (Class::RefusedWithoutPlace, message.clone()),
        End::Refused { message, .. } => return (Class::Refused, message.clone()),
        End::Failed(why) => return (Class::Failed, why.clone()),
        End::Done => {}
    }
    let all = |list: &[String]| list.join("; ");
    if !o.not_finite.is_empty() {
        return (Class::NotANumber, all(&o.not_finite));
    }
    if !o.unequal.is_empty() {
        return (Class::Nondeterministic, all(&o.unequal));
    }
    if !o.notes.is_empty() {
        return (Class::Flagged, all(&o.notes));
    }
    let of_mass = |name: &str| ["mass", "oil"].iter().any(|end| name.ends_with(end));
    let limit = |name: &str| if of_mass(name) { MASS } else { MOTION };
    let open = |(name, v): &&(String, f64)| v.abs() > limit(name);
    if let Some((name, v)) = o.balance.iter().find(open) {
        return (Class::Unbalanced, format!("balance of {name}: {v:.1e}"));
    }
    if !o.absurd.is_empty() {
        return (Class::Absurd, all(&o.absurd));
    }
    if !o.moved.is_empty() {
        return (Class::ChangedByTolerance, all(&o.moved));
    }
    (Class::Right, String::new())
}

/// A detail without its figures, by which cases of one defect are gathered.
#[must_use]
pub fn defect(detail: &str) -> String {
    let mut out = String::new();
    for c in detail.lines().next().unwrap_or_default().chars() {
        let digit = c.is_ascii_digit() || (out.ends_with('#') && ".-+e".contains(c));
        if !digit {
            out.push(c);
        } else if !out.ends_with('#') {
            out.push('#');
        }
    }
    // What follows the first of several is another place of the same.
    out.split("; ").next().unwrap_or_default().chars().take(160).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_class_has_its_outcome() {
        let o = Outcome::default;
        let end = |end| Outcome { end, ..o() };
        let text = || "x".to_owned();
        let one = || vec![text()];
        let refused = |placed| end(End::Refused { message: text(), placed });
        let balance = |name: &str, v| Outcome { balance: vec![(name.into(), v)], ..o() };
        for (class, outcome) in [
            (Class::Right, o()),
            (Class::Flagged, Outcome { notes: one(), ..o() }),
            (Class::Refused, refused(true)),
            (Class::RefusedWithoutPlace, refused(false)),
            (Class::Failed, end(End::Failed(text()))),
            (Class::Panic, end(End::Panic { place: text(), message: text() })),
            (Class::Panic, end(End::Died(text()))),
            (Class::Hang, end(End::Hang)),
            (Class::NotANumber, end(End::NotANumber(text()))),
            (Class::NotANumber, Outcome { not_finite: one(), ..o() }),
            (Class::Unbalanced, balance("gas mass", 2e-6)),
            (Class::Unbalanced, balance("skirt oil", 2e-6)),
            (Class::Unbalanced, balance("energy", -2e-2)),
            (Class::Right, balance("energy", 2e-3)),
            (Class::ChangedByTolerance, Outcome { moved: one(), ..o() }),
            (Class::Absurd, Outcome { absurd: one(), ..o() }),
            (Class::Nondeterministic, Outcome { unequal: one(), ..o() }),
        ] {
            assert_eq!(classify(&outcome).0, class, "{outcome:?}");
        }
        assert!(Class::ALL.iter().all(|c| !(c.forbidden() && c.honest())));
    }

    #[test]
    fn a_note_excuses_a_figure_but_no_defect() {
        let noted = |o: Outcome| classify(&Outcome { notes: vec!["contact_floor".into()], ..o }).0;
        let bad = || vec!["x".to_owned()];
        assert_eq!(noted(Outcome { absurd: bad(), ..Outcome::default() }), Class::Flagged);
        assert_eq!(noted(Outcome { not_finite: bad(), ..Outcome::default() }), Class::NotANumber);
        assert_eq!(noted(Outcome { unequal: bad(), ..Outcome::default() }), Class::Nondeterministic);
    }

    #[test]
    fn defects_are_gathered_without_their_figures() {
        let a = defect("at 12.5 deg crank angle: film 2: no root below 1e-9; and more");
        assert_eq!(a, defect("at 377.1 deg crank angle: film 3: no root below 2.5e-7; and less"));
        assert_ne!(a, defect("at 12.5 deg crank angle: gas 2: no root below 1e-9"));
    }
}
