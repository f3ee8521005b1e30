//! What is run: methods, their settings, the reference.

use gudgeon_scene::{Checked, MethodSetting, OtherMethod, Reference, RunError, WorkPrecision};

use super::ladder::{finer, ladder, less_fine};
use crate::compare::swap_path;
use crate::error::StudyError;

/// What is run for one case.
pub struct Plan {
    /// Every method at every setting, all changes of the case among them.
    pub points: Vec<MethodSetting>,
    /// What errors count from.
    pub reference: Reference,
    /// Results that are looked at unless told otherwise.
    pub results: Vec<String>,
    /// What a person should know of what is left out.
    pub notes: Vec<String>,
}

impl Plan {
    /// Plans the race of a case, of `contenders` where some are asked for.
    pub fn new(base: &Checked, contenders: &[(String, Vec<String>)]) -> Result<Self, StudyError> {
        let own = base.case.work_precision().map_err(RunError::Refused)?;
        let mut notes = Vec::new();
        let (methods, asked) = match combinations(contenders) {
            asked if !asked.is_empty() => (asked, true),
            _ => (of_scene(&own), false),
        };
        let mut points = Vec::new();
        let mut admitted = Vec::new();
        for method in methods {
            let set = [&own.all[..], &method.set].concat();
            match base.with(&set) {
                Ok(c) => {
                    points.extend(settings(&c, &method.label)?.into_iter().map(|s| after(&set, s)));
                    admitted.push((method, c));
                }
                Err(report) if asked => {
                    let first = base.case.overrides().len() + own.all.len();
                    return Err(StudyError::Input(report.written_as(first, "--contender")));
                }
                Err(report) => {
                    let why = report.diagnostics.iter().map(|d| d.headline()).collect::<Vec<_>>().join("; ");
                    notes.push(format!(
                        "`{}` solves the same equations and is not raced: this case refuses it ({why})",
                        method.label
                    ));
                }
            }
        }
        if !asked && !points.iter().any(|p| p.is_default) {
            let case = "the case as it stands";
            points.insert(
                0,
                MethodSetting {
                    method: case.into(),
                    setting: case.into(),
                    is_default: true,
                    set: own.all.clone(),
                    asked: None,
                },
            );
        }
        let reference = reference(base, &own)?;
        if !reference.independent && points.len() < 2 {
            let text = "there is nothing to race: the case declares no numerical setting, and no other method for its equations is known; \
                        name contenders with `--contender PATH=A,B,C`";
            return Err(RunError::Refused(text.into()).into());
        }
        Ok(Self { points, reference, results: own.results, notes })
    }

    /// The name by which the reference tells a result.
    pub fn told_as<'a>(&'a self, name: &'a str) -> &'a str {
        self.reference.told_as.iter().find(|(own, _)| *own == name).map_or(name, |(_, other)| other)
    }
}

/// Every combination of the contenders that were asked for.
fn combinations(contenders: &[(String, Vec<String>)]) -> Vec<OtherMethod> {
    if contenders.is_empty() {
        return Vec::new();
    }
    let mut all = vec![OtherMethod::default()];
    for (path, values) in contenders {
        let path = swap_path(path);
        let words = path.trim_start_matches("models.").trim_end_matches(".model");
        let with = |before: &OtherMethod, value: &String| {
            let mut next = before.clone();
            let comma = if before.label.is_empty() { "" } else { ", " };
            next.label.push_str(&format!("{comma}{words}={value}"));
            next.set.push(format!("{path}={value}"));
            next
        };
        all = all.iter().flat_map(|b| values.iter().map(|v| with(b, v)).collect::<Vec<_>>()).collect();
    }
    all
}

/// The case as it stands, and the other methods that its scene knows.
fn of_scene(own: &WorkPrecision) -> Vec<OtherMethod> {
    let label = if own.others.is_empty() { String::new() } else { own.own.clone() };
    std::iter::once(OtherMethod { label, set: Vec::new() }).chain(own.others.iter().cloned()).collect()
}

/// The settings of one method: those of its solvers, or those that the case declares.
fn settings(case: &Checked, label: &str) -> Result<Vec<MethodSetting>, StudyError> {
    let own = case.case.work_precision().map_err(RunError::Refused)?;
    if own.settings.is_empty() {
        return Ok(ladder(case, label, &own.idle));
    }
    let named = |s: MethodSetting| {
        let method = if label.is_empty() { s.method.clone() } else { format!("{label}; {}", s.method) };
        MethodSetting { method, ..s }
    };
    Ok(own.settings.into_iter().map(named).collect())
}

/// A setting behind the changes that its method needs.
fn after(set: &[String], s: MethodSetting) -> MethodSetting {
    let behind = |own: &[String]| [set, own].concat();
    let mut next = MethodSetting { set: behind(&s.set), ..s };
    for a in next.asked.iter_mut().filter(|a| !a.against.is_empty()) {
        a.against = behind(&a.against);
    }
    next
}

/// What errors count from: what the scene names, another method refined, or the case refined.
fn reference(base: &Checked, own: &WorkPrecision) -> Result<Reference, StudyError> {
    if let Some(named) = &own.reference {
        let behind = |set: &[String]| [&own.all[..], set].concat();
        return Ok(Reference { set: behind(&named.set), check: behind(&named.check), ..named.clone() });
    }
    let admitted = |o: &&OtherMethod| base.with(&[&own.all[..], &o.set].concat()).is_ok();
    let (set, words, coarser) = finest(base, &own.all)?;
    let Some(other) = own.others.iter().find(admitted) else {
        return Ok(Reference {
            set,
            check: coarser.0,
            is: format!(
                "by the same method, refined, for no second one is known: {words}; differs from {}",
                coarser.1
            ),
            ..Reference::default()
        });
    };
    // Two methods that come together say more than one that settles: grids that hold the nodes of each other share errors.
    let (second, second_words, _) = finest(base, &[&own.all[..], &other.set].concat())?;
    Ok(Reference {
        set: second,
        check: set,
        is: format!("`{}`, {second_words}; differs from `{}`, {words}", other.label, own.own),
        independent: true,
        told_as: Vec::new(),
    })
}

/// Settings with their words.
type Words = (Vec<String>, String);

/// A case with some changes at the finest settings that it declares: all changes, the settings in words, and those one level coarser.
fn finest(base: &Checked, set: &[String]) -> Result<(Vec<String>, String, Words), StudyError> {
    let case = base.with(set).map_err(StudyError::Input)?;
    let groups = case.case.refinements();
    let behind = |own: &[String]| [set, own].concat();
    let (fine, words) = finer(&case, &groups);
    let (before, coarser) = less_fine(&case, &groups);
    Ok((behind(&fine), words, (behind(&before), coarser)))
}
