//! Inertias of the line, and their names.

use gudgeon_core::BuildError;
use gudgeon_core::file::Files;
use gudgeon_core::kinds::{Line, LineNode};
use gudgeon_core::result::Note;

use super::Assembled;
use crate::case::ShaftLineCase;
use crate::tors;

/// Adds the inertias of a TORS file (with its links), of the case and of its dampers.
pub(super) fn add(case: &ShaftLineCase, files: &Files, out: &mut Assembled, errors: &mut Vec<BuildError>) {
    if let Some(file) = &case.tors {
        match tors::read(files, file) {
            Ok(import) => {
                out.notes.extend(import.report.iter().map(|r| Note::caution("tors", format!("{file}: {r}"))));
                out.line = import.line;
                out.stress = import.stress;
            }
            Err(e) => errors.push(BuildError::at("tors", e)),
        }
    }
    let nodes = &mut out.line.nodes;
    nodes.extend(case.inertias.iter().map(|i| LineNode {
        name: i.name.clone(),
        inertia: i.inertia.si(),
        damping: i.damping.si(),
        ground: i.ground.si(),
        ratio: i.ratio.si(),
    }));
    for d in &case.dampers {
        let ratio = nodes.iter().find(|n| n.name == d.at).map_or(1.0, |n| n.ratio);
        let name = d.name.clone();
        nodes.push(LineNode { name, inertia: d.inertia.si(), damping: 0.0, ground: 0.0, ratio });
    }
}

/// Names of the inertias.
pub(super) struct Names {
    all: Vec<String>,
    /// How many of them stand before those of the case: those of a TORS file.
    before: usize,
}

impl Names {
    pub fn new(case: &ShaftLineCase, line: &Line) -> Self {
        let all: Vec<String> = line.nodes.iter().map(|n| n.name.clone()).collect();
        Self { before: all.len() - case.inertias.len() - case.dampers.len(), all }
    }

    /// Node of a name.
    pub fn find(&self, name: &str) -> Option<usize> {
        self.all.iter().position(|n| n == name)
    }

    /// Node of a name; an error at `place` where there is none.
    pub fn need(&self, name: &str, place: String, errors: &mut Vec<BuildError>) -> Option<usize> {
        let found = self.find(name);
        if found.is_none() {
            let known: Vec<&str> = self.all.iter().map(String::as_str).collect();
            let what = format!("there is no inertia `{name}`; {}", gudgeon_case::advice(name, &known));
            errors.push(BuildError::at(place, what));
        }
        found
    }

    /// Place of a node among the inertias of the case.
    fn own(&self, node: usize) -> usize {
        node.saturating_sub(self.before)
    }

    /// Refuses names that stand twice.
    pub fn check(&self, errors: &mut Vec<BuildError>) {
        for (i, n) in self.all.iter().enumerate() {
            if self.all[..i].contains(n) {
                let what = format!("`{n}` is the name of another inertia");
                errors.push(BuildError::at(format!("inertias.{}.name", self.own(i)), what));
            }
        }
    }
}

/// Refuses ratios of zero.
pub(super) fn check_ratios(line: &Line, names: &Names, errors: &mut Vec<BuildError>) {
    for (i, n) in line.nodes.iter().enumerate() {
        if n.ratio == 0.0 {
            let what = "a ratio of zero: the inertia would not turn";
            errors.push(BuildError::at(format!("inertias.{}.ratio", names.own(i)), what));
        }
    }
}
