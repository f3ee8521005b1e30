//! Places of shafts, dampers, drives and throws on the line.

use gudgeon_core::BuildError;

use super::nodes::Names;
use crate::case::ShaftLineCase;

/// Nodes by the names that the case gives; none where a name is not known.
pub(super) struct Ends {
    pub shafts: Vec<Option<[usize; 2]>>,
    pub dampers: Vec<Option<usize>>,
    pub drives: Vec<Option<usize>>,
}

/// Finds all names, those of throws included.
pub(super) fn find(case: &ShaftLineCase, names: &Names, errors: &mut Vec<BuildError>) -> Ends {
    let mut need = |name: &str, place: String| names.need(name, place, errors);
    let shafts = case.shafts.iter().enumerate().map(|(k, s)| {
        let a = need(&s.from, format!("shafts.{k}.from"));
        let b = need(&s.to, format!("shafts.{k}.to"));
        Some([a?, b?])
    });
    let shafts = shafts.collect();
    let dampers = case.dampers.iter().enumerate().map(|(k, d)| need(&d.at, format!("dampers.{k}.at")));
    let dampers = dampers.collect();
    let drives = case.drives.iter().enumerate().map(|(k, d)| need(&d.at, format!("drives.{k}.at")));
    let drives = drives.collect();
    for (k, t) in case.throws.iter().enumerate() {
        for (i, name) in t.at.iter().enumerate() {
            need(name, format!("throws.{k}.at.{i}"));
        }
    }
    Ends { shafts, dampers, drives }
}
