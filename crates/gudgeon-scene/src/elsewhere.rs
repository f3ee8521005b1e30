//! Whether a case has another periodic state: part of `--verify`.
//!
//! A cycle that repeats need not be the only one. A ring that leaves the liner or crosses its groove in one cycle may do so in all that follow, and
//! not do so in any after a start from elsewhere. A search finds one of these states; which, its start decides. A finer tolerance does not tell.
//! So a case whose scene knows other starts ([`SceneCase::elsewhere`](crate::SceneCase::elsewhere)) is run from there as well.

use gudgeon_core::Stopped;
use gudgeon_core::result::{Branch, Headline, Note, RunResult, Value, change};
use gudgeon_numerics::elementary;
use indexmap::IndexMap;

use crate::error::{Progress, RunError};
use crate::scene::{Scene, changed};

/// Another start of the search of a periodic state.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Elsewhere {
    /// The start of the case, `all lands at 1.00 bar`, and the other one.
    pub starts: [String; 2],
    /// The settings with which the search begins at the other one.
    pub set: Vec<String>,
}

/// Two states are one when the results that lead differ by no more than this part of themselves, or by this many times their uncertainty: both searches have theirs.
const SAME: f64 = 1e-2;
const WITHIN: f64 = 5.0;
/// What is left over of a balance is smaller than this, in any unit of a result.
const NOTHING: f64 = 1e-9;
/// Topics of notes on a cycle that does not repeat, or only after several.
const NOT_PERIODIC: &str = "not_periodic";
const SUBHARMONIC: &str = "subharmonic";

/// Runs the case from its other starts, until one leads to another periodic state; adds both states to the result, and a note.
///
/// # Errors
/// The caller wants it to end.
pub(crate) fn look_elsewhere(
    scene: &dyn Scene,
    result: &mut RunResult,
    uncertainty: &IndexMap<String, f64>,
    progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
) -> Result<(), RunError> {
    // What does not repeat itself is told already.
    if period(result) != 1 {
        return Ok(());
    }
    for start in scene.elsewhere() {
        if look_from(scene, start, result, uncertainty, progress)? {
            break;
        }
    }
    Ok(())
}

/// The same from one start: whether it leads to another periodic state.
fn look_from(
    scene: &dyn Scene,
    Elsewhere { starts: [own, other], set }: Elsewhere,
    result: &mut RunResult,
    uncertainty: &IndexMap<String, f64>,
    progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
) -> Result<bool, RunError> {
    let run = changed(scene, &set).and_then(|s| {
        s.once(&mut |p| progress(Progress { phase: "starting elsewhere".into(), fraction: p.fraction }))
    });
    let found = match run {
        Ok(found) => found,
        Err(RunError::Stopped) => return Err(RunError::Stopped),
        Err(e) => {
            let text = format!("from another start ({other}) the search of the periodic state failed: {e}");
            tell_once(result, Note::caution("start_failed", text).of_numerics());
            return Ok(false);
        }
    };
    let branch =
        |start: String, r: &RunResult| Branch { start, period: period(r), results: r.results.clone() };
    let [mine, theirs] = [branch(own, result), branch(other, &found)];
    if theirs.period == 0 {
        tell_once(result, unsettled(&theirs));
        return Ok(false);
    }
    let leading = result.leading();
    let Some(name) = another(&mine.results, &theirs.results, &leading, uncertainty) else {
        return Ok(false);
    };
    result.solver.notes.push(several(&mine, &theirs, name));
    result.branches = vec![mine, theirs];
    Ok(true)
}

/// Adds a note on a start from which nothing was found, if there is none yet.
fn tell_once(result: &mut RunResult, note: Note) {
    let notes = &mut result.solver.notes;
    if notes.iter().all(|n| n.topic != note.topic) {
        notes.push(note);
    }
}

/// The first result by which two states, whose results are `a` and `b`, are not one: of those that lead, or of all where none of these is told. What is known of the
/// `uncertainty` of `a` is taken into account.
pub fn another<'a>(
    a: &'a IndexMap<String, Value>,
    b: &IndexMap<String, Value>,
    leading: &'a [Headline],
    uncertainty: &IndexMap<String, f64>,
) -> Option<&'a str> {
    let differs = |name: &&str| {
        let (Some(x), Some(y)) = (a.get(*name), b.get(*name)) else { return false };
        let known = uncertainty.get(*name).copied().unwrap_or(0.0);
        let scale = size(a, &x.unit).max(x.value.abs()).max(y.value.abs());
        change(x.value, y.value, &x.unit).abs() > (SAME * scale).max(WITHIN * known).max(NOTHING)
    };
    let names = leading.iter().flat_map(|h| &h.results).map(|(_, name)| name.as_str());
    let told: Vec<&str> = names.filter(|name| a.contains_key(*name)).collect();
    if told.is_empty() { a.keys().map(String::as_str).find(differs) } else { told.into_iter().find(differs) }
}

/// A tenth of the largest of the results in a unit: what is small beside that makes no other state.
fn size(results: &IndexMap<String, Value>, unit: &str) -> f64 {
    let alike = results.values().filter(|v| v.unit == unit && v.value.is_finite());
    0.1 * alike.fold(0.0, |most: f64, v| most.max(v.value.abs()))
}

/// After how many cycles a run repeats; none where it does not.
fn period(r: &RunResult) -> u32 {
    let note = |topic: &str| r.solver.notes.iter().find(|n| n.topic == topic);
    if note(NOT_PERIODIC).is_some() {
        return 0;
    }
    note(SUBHARMONIC).and_then(|n| n.amounts.get("period")).map_or(1, |v| v.value as u32)
}

fn several(mine: &Branch, theirs: &Branch, name: &str) -> Note {
    let value = |b: &Branch| b.results.get(name).map_or(f64::NAN, |v| v.value);
    let unit = mine.results.get(name).map_or("", |v| v.unit.as_str());
    let text = format!(
        "this case has another periodic state: started with {}, `{name}` is {} {unit} in place of {}. The results are those of the start of the case ({}); \
         which state the machine is in depends on where it comes from",
        theirs.start,
        four(value(theirs)),
        four(value(mine)),
        mine.start,
    );
    Note::caution("several_solutions", text).amount(format!("{name} elsewhere"), value(theirs), unit).amount(
        name,
        value(mine),
        unit,
    )
}

/// A value with four digits.
fn four(value: f64) -> String {
    let before = if value == 0.0 { 1.0 } else { elementary::log10(value.abs()).floor() + 1.0 };
    let after = (4.0 - before).clamp(0.0, 12.0) as usize;
    format!("{value:.after$}")
}

fn unsettled(theirs: &Branch) -> Note {
    let text = format!(
        "started with {} the cycle did not become periodic: whether the case has another periodic state is not known",
        theirs.start
    );
    Note::caution("start_unsettled", text).of_numerics()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn results(all: &[(&str, f64)]) -> IndexMap<String, Value> {
        let value = |v: f64| Value { value: v, unit: "l/min".into(), what: String::new() };
        all.iter().map(|(name, v)| ((*name).to_owned(), value(*v))).collect()
    }

    #[test]
    fn states_differ_in_results_that_lead() {
        let lead = [Headline::one("Blow-by", "blow_by")];
        let none = IndexMap::new();
        let a = results(&[("blow_by", 60.0), ("noise", 1.0)]);
        let b = results(&[("blow_by", 60.5), ("noise", 2.0)]);
        assert_eq!(another(&a, &b, &lead, &none), None);
        let c = results(&[("blow_by", 61.0), ("noise", 1.0)]);
        assert_eq!(another(&a, &c, &lead, &none), Some("blow_by"));
        // What is not known better than that tells nothing.
        let doubt = IndexMap::from([("blow_by".to_owned(), 0.3)]);
        assert_eq!(another(&a, &c, &lead, &doubt), None);
    }

    #[test]
    fn without_results_that_lead_all_are_compared_and_what_is_small_is_not() {
        let none = IndexMap::new();
        let a = results(&[("gap", 60.0), ("groove", 0.04), ("left_over", 1e-15)]);
        // A tenth of the largest counts: 0.06 is admitted.
        let b = results(&[("gap", 60.0), ("groove", 0.09), ("left_over", -3e-15)]);
        assert_eq!(another(&a, &b, &[], &none), None);
        let c = results(&[("gap", 60.0), ("groove", 0.11), ("left_over", 1e-15)]);
        assert_eq!(another(&a, &c, &[], &none), Some("groove"));
    }

    #[test]
    fn values_have_four_digits() {
        assert_eq!([62.3037, 1375.88, 0.00123456, 0.0].map(four), ["62.30", "1376", "0.001235", "0.000"]);
    }
}
