//! The work that was accepted last, and how a measurement differs from it.

use std::collections::BTreeSet;
use std::fmt;
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::measure::{Span, Work};

/// Part by which a count may leave the span of the baseline, either way. A span is that of five runs, and a sixth that differs by rounding alone
/// leaves it by less.
pub const SHARE: f64 = 0.01;

/// The same for instructions of the same compiler, of which one run alone is counted: the steps of a ring pack differ by up to 2 % between runs that differ by
/// rounding, and the system's libraries choose their variant of a sine or a copy by the processor.
pub const INSTRUCTION_SHARE: f64 = 0.05;

/// What the file begins with.
const HEAD: &str = "\
# Work of the solvers on the cases of src/cases.rs, as it was accepted last: least and greatest count of five runs whose inputs differ in the
# last digit. `counters` compares; `counters --accept REASON` writes this file and adds the reason to counters-history.md.

";

/// The file `counters.toml`.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Baseline {
    /// What compiled the program whose instructions were counted.
    pub compiler: String,
    /// Counters.
    pub counters: Work,
    /// Instructions, as the counter of that name.
    pub instructions: Work,
}

impl Baseline {
    /// Reads it.
    ///
    /// # Errors
    /// A file that is not there or says something else, as text.
    pub fn read(path: &Path) -> Result<Self, String> {
        let text = std::fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
        toml::from_str(&text).map_err(|e| format!("{}: {e}", path.display()))
    }

    /// Writes it, sorted, a line for every case and counter.
    ///
    /// # Errors
    /// A file system that refuses, as text.
    pub fn write(&self, path: &Path) -> Result<(), String> {
        let text = toml::to_string(self).map_err(|e| e.to_string())?;
        std::fs::write(path, format!("{HEAD}{text}")).map_err(|e| format!("{}: {e}", path.display()))
    }
}

/// A count that is not what it was.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Change {
    /// The case.
    pub case: String,
    /// The counter.
    pub counter: String,
    /// What it was; none where it is new.
    pub was: Option<Span>,
    /// What it is; none where it is gone.
    pub is: Option<Span>,
}

impl Change {
    /// By how much it has left the span: the part by which it is above, or below as a negative number; infinite where something is new or
    /// gone. What was zero counts as one.
    #[must_use]
    pub fn share(&self) -> f64 {
        let (Some(was), Some(is)) = (self.was, self.is) else { return f64::INFINITY };
        let over = |is: u64, was: u64| (is as f64 - was as f64) / was.max(1) as f64;
        let (above, below) = (over(is.1, was.1), over(is.0, was.0));
        if above > 0.0 { above } else { below.min(0.0) }
    }
}

/// `3994` or `3928 to 3994`.
impl fmt::Display for Span {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0 == self.1 { write!(f, "{}", self.0) } else { write!(f, "{} to {}", self.0, self.1) }
    }
}

impl fmt::Display for Change {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { case, counter, .. } = self;
        match (self.was, self.is) {
            (Some(was), Some(is)) => {
                write!(f, "{case}: {counter} was {was}, is {is} ({:+.1} %)", 100.0 * self.share())
            }
            (None, Some(is)) => write!(f, "{case}: {counter} is {is}, and was not counted before"),
            (Some(was), None) => write!(f, "{case}: {counter} was {was}, and is no longer counted"),
            (None, None) => write!(f, "{case}: {counter} was never counted"),
        }
    }
}

/// Every count outside its span, by case and counter.
#[must_use]
pub fn changes(was: &Work, is: &Work) -> Vec<Change> {
    let keys: BTreeSet<(&String, &String)> = [was, is]
        .iter()
        .flat_map(|w| w.iter().flat_map(|(case, all)| all.keys().map(move |k| (case, k))))
        .collect();
    let of = |work: &Work, (case, counter): (&String, &String)| work.get(case)?.get(counter).copied();
    let change = |key: (&String, &String)| Change {
        case: key.0.clone(),
        counter: key.1.clone(),
        was: of(was, key),
        is: of(is, key),
    };
    keys.into_iter().map(change).filter(|c| c.share() != 0.0).collect()
}
