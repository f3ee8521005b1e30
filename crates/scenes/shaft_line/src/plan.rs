//! What is wanted, and what must be built for it.

use gudgeon_core::kinds::TorsionAnswer;
use gudgeon_core::result::Skipped;

use super::case::{Group, ShaftLineCase};
use super::verdict::Operating;

/// What runs.
#[derive(Debug, Clone, Default)]
pub struct Plan {
    /// Throws on their own.
    pub throws: bool,
    /// Natural frequencies.
    pub frequencies: bool,
    /// Response by the torsion model.
    pub response: bool,
    /// Forced vibration over the speed range.
    pub range: bool,
    /// Limits, or an operating range or load steps whose largest values are wanted.
    pub verdict: bool,
    /// Whether that needs vibration.
    pub forced: bool,
    /// What runs and why.
    pub runs: Vec<Skipped>,
    /// What does not and why.
    pub skipped: Vec<Skipped>,
}

impl Plan {
    /// Closure of the wanted groups.
    #[must_use]
    pub fn new(case: &ShaftLineCase) -> Self {
        let wanted = |g: Group| case.outputs.groups.is_empty() || case.outputs.groups.contains(&g);
        let mut plan = Self::default();
        let answers = case.models.torsion.answers();
        let name = case.models.torsion.typetag_name();
        let limits = &case.limits;
        let separation = !limits.separation.is_empty();
        let torque = !(limits.stress.is_empty()
            && limits.torque.is_empty()
            && limits.heat.is_empty()
            && limits.irregularity.is_empty());
        let mut decide = |what: &str, runs: bool, why: String| {
            let entry = Skipped { what: what.into(), why };
            if runs {
                plan.runs.push(entry)
            } else {
                plan.skipped.push(entry)
            }
            runs
        };
        let asked = |g: Group| {
            if case.outputs.groups.is_empty() {
                "all groups are wanted".to_owned()
            } else if wanted(g) {
                "`outputs.groups` names it".to_owned()
            } else {
                "`outputs.groups` does not name it".to_owned()
            }
        };
        let throws = wanted(Group::Throws) && !case.throws.is_empty();
        let why = if case.throws.is_empty() { "there are no throws".into() } else { asked(Group::Throws) };
        let throws = decide("throws at constant speed", throws, why);
        let frequencies = wanted(Group::NaturalFrequencies) || separation;
        let why = if separation && !wanted(Group::NaturalFrequencies) {
            "`limits.separation` needs it".into()
        } else {
            asked(Group::NaturalFrequencies)
        };
        let frequencies = decide("natural frequencies", frequencies, why);
        let nothing = answers == TorsionAnswer::Nothing;
        let response = (wanted(Group::Response) || torque) && !nothing;
        let why = if nothing {
            "`torsion/off`: the speed is constant".into()
        } else if torque && !wanted(Group::Response) {
            "`limits` need it".into()
        } else {
            asked(Group::Response)
        };
        let response = decide(&format!("response by `{name}`"), response, why);
        let given = case.range.from.is_some() && case.range.to.is_some();
        let range = wanted(Group::SpeedRange) && given && answers == TorsionAnswer::Periodic;
        let why = if !given {
            "`range.from` and `range.to` are not given".into()
        } else if answers != TorsionAnswer::Periodic {
            format!("`torsion/{name}` gives no vibration at constant speed")
        } else {
            asked(Group::SpeedRange)
        };
        let range = decide("vibration over the speed range", range, why);
        if response && answers == TorsionAnswer::Periodic {
            decide("time steps", false, "the periodic motion is solved for directly".into());
        }
        let nothing_but_time = answers == TorsionAnswer::Time;
        let over = (case.operating.is_some() || !case.load_steps.is_empty()) && !nothing_but_time;
        let forced = !nothing && (torque || over && (response || range));
        let verdict = forced || separation;
        let why = if verdict {
            let steps = super::steps::all(case).len();
            format!(
                "{} in {steps} load step{}",
                Operating::new(case).words(),
                if steps == 1 { "" } else { "s" }
            )
        } else {
            "the case has no limits, no operating range and no load steps".into()
        };
        decide("verdict", verdict, why);
        let line = frequencies || response || range || verdict;
        if !line {
            decide("shaft line", false, "nothing that is wanted needs it".into());
        }
        Self { throws, frequencies, response, range, verdict, forced, ..plan }
    }

    /// Whether a line is built at all.
    #[must_use]
    pub const fn line(&self) -> bool {
        self.frequencies || self.response || self.range || self.verdict
    }
}
