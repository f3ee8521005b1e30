//! In which order packages can be published: each after what it depends on.

use std::collections::BTreeSet;
use std::fmt;

use crate::metadata::Package;

/// Packages that depend on each other in a circle.
#[derive(Debug, PartialEq, Eq)]
pub struct Cycle(pub Vec<String>);

impl fmt::Display for Cycle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "none of these can be published before the others: {}", self.0.join(", "))
    }
}

/// The published packages, each after those it depends on, dev-dependencies with a version included; by name where there is a choice.
///
/// # Errors
/// Those that cannot be ordered.
pub fn order(all: &[Package]) -> Result<Vec<&Package>, Cycle> {
    let mut left: Vec<&Package> = all.iter().filter(|p| p.published).collect();
    left.sort_by(|a, b| a.name.cmp(&b.name));
    let mut done = Vec::new();
    while !left.is_empty() {
        let names: BTreeSet<&str> = left.iter().map(|p| p.name.as_str()).collect();
        let waits =
            |p: &Package| p.dependencies.iter().any(|d| d.is_kept() && names.contains(d.name.as_str()));
        let (later, now): (Vec<&Package>, Vec<&Package>) = left.iter().partition(|p| waits(p));
        if now.is_empty() {
            return Err(Cycle(names.into_iter().map(str::to_owned).collect()));
        }
        done.extend(now);
        left = later;
    }
    Ok(done)
}
