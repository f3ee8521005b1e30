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
    /// Whether a fuller model tells what the torsion model leaves out.
    pub fuller: bool,
    /// What runs and why.
    pub runs: Vec<Skipped>,
    /// What does not and why.
    pub skipped: Vec<Skipped>,
}

impl Plan {
    /// Closure of the wanted groups.
    #[must_use]
    pub fn new(case: &ShaftLineCase) -> Self {
        let mut plan = Self { fuller: true, ..Self::default() };
        let torsion = &case.models.torsion;
        let (answers, name) = (torsion.answers(), torsion.typetag_name());
        plan.throws = plan.decide("throws at constant speed", throws(case));
        plan.frequencies = plan.decide("natural frequencies", frequencies(case));
        plan.response = plan.decide(&format!("response by `{name}`"), response(case, answers));
        plan.range = plan.decide("vibration over the speed range", range(case, answers, name));
        if plan.response && answers == TorsionAnswer::Periodic {
            plan.decide("time steps", (false, "the periodic motion is solved for directly".into()));
        }
        let over = case.operating.is_some() || !case.load_steps.is_empty();
        let over = over && answers != TorsionAnswer::Time && (plan.response || plan.range);
        plan.forced = answers != TorsionAnswer::Nothing && (forced_limits(case) || over);
        let judged = plan.forced || !case.limits.separation.is_empty();
        plan.verdict = plan.decide("verdict", (judged, verdict(case, judged)));
        if !plan.line() {
            plan.decide("shaft line", (false, "nothing that is wanted needs it".into()));
        }
        plan
    }

    /// What follows from the line at its mean speed alone, without a search over speeds or load steps.
    #[must_use]
    pub fn at_mean_speed(case: &ShaftLineCase) -> Self {
        Self { range: false, verdict: false, forced: false, fuller: false, ..Self::new(case) }
    }

    /// Notes what runs or not, and why.
    fn decide(&mut self, what: &str, (runs, why): (bool, String)) -> bool {
        let entry = Skipped { what: what.into(), why };
        if runs {
            self.runs.push(entry)
        } else {
            self.skipped.push(entry)
        }
        runs
    }

    /// Whether a line is built at all.
    #[must_use]
    pub const fn line(&self) -> bool {
        self.frequencies || self.response || self.range || self.verdict
    }
}

fn wanted(case: &ShaftLineCase, g: Group) -> bool {
    case.outputs.groups.is_empty() || case.outputs.groups.contains(&g)
}

/// Why a group is wanted or not.
fn asked(case: &ShaftLineCase, g: Group) -> String {
    if case.outputs.groups.is_empty() {
        "all groups are wanted".to_owned()
    } else if wanted(case, g) {
        "`outputs.groups` names it".to_owned()
    } else {
        "`outputs.groups` does not name it".to_owned()
    }
}

/// Whether the case has limits on vibration.
fn forced_limits(case: &ShaftLineCase) -> bool {
    let limits = &case.limits;
    !(limits.stress.is_empty()
        && limits.torque.is_empty()
        && limits.heat.is_empty()
        && limits.irregularity.is_empty())
}

fn throws(case: &ShaftLineCase) -> (bool, String) {
    if case.throws.is_empty() {
        return (false, "there are no throws".into());
    }
    (wanted(case, Group::Throws), asked(case, Group::Throws))
}

fn frequencies(case: &ShaftLineCase) -> (bool, String) {
    let own = wanted(case, Group::NaturalFrequencies);
    if !case.limits.separation.is_empty() && !own {
        return (true, "`limits.separation` needs it".into());
    }
    (own, asked(case, Group::NaturalFrequencies))
}

fn response(case: &ShaftLineCase, answers: TorsionAnswer) -> (bool, String) {
    let own = wanted(case, Group::Response);
    if answers == TorsionAnswer::Nothing {
        (false, "`torsion/off`: the speed is constant".into())
    } else if forced_limits(case) && !own {
        (true, "`limits` need it".into())
    } else {
        (own, asked(case, Group::Response))
    }
}

fn range(case: &ShaftLineCase, answers: TorsionAnswer, name: &str) -> (bool, String) {
    if case.range.from.is_none() || case.range.to.is_none() {
        (false, "`range.from` and `range.to` are not given".into())
    } else if answers != TorsionAnswer::Periodic {
        (false, format!("`torsion/{name}` gives no vibration at constant speed"))
    } else {
        (wanted(case, Group::SpeedRange), asked(case, Group::SpeedRange))
    }
}

fn verdict(case: &ShaftLineCase, judged: bool) -> String {
    if !judged {
        return "the case has no limits, no operating range and no load steps".into();
    }
    let steps = super::steps::all(case).len();
    let s = if steps == 1 { "" } else { "s" };
    format!("{} in {steps} load step{s}", Operating::new(case).words())
}
