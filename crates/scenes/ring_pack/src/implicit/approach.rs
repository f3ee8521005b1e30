//! The way to the periodic state by halves of the pack, for integrators of the whole.
//!
//! A cycle in halves (`waveform`) costs a tenth of one of the whole pack, and ends near where that does. So a search begins where one in halves ends; where halves do not agree
//! it begins as if there had been none. With oil on the liner films lead on from there ([`super::films_alone`]).

use gudgeon_core::Stopwatch;
use gudgeon_core::quantity::quantity;
use gudgeon_numerics::orbit::{Change, OrbitOptions};
use gudgeon_scene::{RunError, Stopped};

use super::films_alone::{AGREED, FilmsAlone};
use super::search::{first_states, orbit_options};
use super::{Cycle, Implicit, Method, Pack, RingIntegrator, Wanted};

/// Tolerance of halves that a search begins with, over that of the search, and the range in which it is, without oil on the liner and with it: with less the search takes as many
/// cycles of the whole pack.
const ROUGHER: f64 = 10.0;
const ROUGH: [(f64, f64); 2] = [(1e-3, 1e-2), (1e-3, 3e-3)];
/// Tolerance of a search without oil below which it is not the way to the orbit that takes its cycles, but the noise at its end: halves shorten it no more.
const FINE: f64 = 5e-5;
/// How near they come to their periodic state, over what a search that ends there would be asked, without oil on the liner and with it, and beyond which distance they do not end: at
/// 3e-2 they would before the slow mode of oil shows, and three times as far they do where an engine is cold.
const NEARBY: [f64; 2] = [3.0, 1.0];
const FARTHEST: f64 = 5e-3;
/// Farthest from it where halves with oil on the liner still lead on when they have taken all the cycles they may.
const LEADS: f64 = 3e-2;
/// Most steps of one of their halves in a cycle, without oil on the liner and with it: where a ring leaves the liner or opens and shuts a thousand times they are no way to
/// anywhere, and cost more than the pack as a whole. Of 40 packs of three to six rings usual ones take up to 460 and 900.
const ROUGH_STEPS: [u64; 2] = [600, 4000];
/// Part of a search that they are told to take.
const LEAD: f64 = 0.2;

/// Where a search begins.
pub(super) struct Start {
    pub y: Vec<f64>,
    /// What is known of the slope of the map of a cycle.
    pub known: Vec<Change>,
    /// How far that is from the orbit, infinite where nobody knows, if halves led there; with oil on the liner, their films, which may lead on.
    pub near: Option<f64>,
    pub films: Option<FilmsAlone>,
    /// Cycles in halves, and the time that they took \[s\].
    pub coarse: usize,
    pub seconds: f64,
}

impl Start {
    /// All lands at `start` \[Pa\], and nothing known.
    pub fn cold(pack: &mut Pack, start: f64) -> Self {
        Self {
            y: first_states(pack, start),
            known: Vec::new(),
            near: None,
            films: None,
            coarse: 0,
            seconds: 0.0,
        }
    }

    /// Part of the search that is done.
    pub const fn led(&self) -> f64 {
        if self.coarse > 0 { LEAD } else { 0.0 }
    }
}

/// How halves are searched for `s`.
fn rougher(s: &Implicit, pack: &Pack, most: u32) -> (Implicit, OrbitOptions) {
    let (finest, roughest) = ROUGH[usize::from(pack.oil_pack.is_some())];
    let tolerance = quantity((ROUGHER * s.tolerance.si()).clamp(finest, roughest));
    let halves = Implicit { tolerance, integrator: RingIntegrator::Waveform, max_cycles: most, ..s.clone() };
    let mut options = orbit_options(&halves, pack);
    let near = NEARBY[usize::from(pack.oil_pack.is_some())];
    options.tolerance = (near * options.tolerance).min(FARTHEST.max(options.tolerance));
    (halves, options)
}

/// The map of a cycle in halves that leads to where another search begins.
pub(super) fn in_halves<'a>(
    spec: &'a Implicit,
    pack: &'a mut Pack,
    wanted: &Wanted<'a>,
    progress: &'a mut dyn FnMut(f64) -> Result<(), Stopped>,
) -> Cycle<'a> {
    let mut cycle = Cycle::new(spec, pack, wanted, progress);
    cycle.leads_on = true;
    cycle.max_steps = cycle.max_steps.min(ROUGH_STEPS[usize::from(cycle.pack.oil_pack.is_some())]);
    cycle
}

/// Whether a search in halves leads to that of `s`.
pub(super) fn leads(s: &Implicit, pack: &Pack) -> bool {
    let far = pack.oil_pack.is_some() || s.tolerance.si() >= FINE;
    s.integrator != RingIntegrator::Waveform && pack.solves_stages() && s.max_cycles >= 2 && far
}

/// Where the search of `s` begins with all lands at `start` \[Pa\]: at the end of one in halves, if the pack can be halved and the halves agree.
pub(super) fn approach(
    s: &Implicit,
    pack: &mut Pack,
    start: f64,
    wanted: &Wanted<'_>,
    progress: &mut dyn FnMut(f64) -> Result<(), Stopped>,
) -> Result<Start, RunError> {
    let mut begun = Start::cold(pack, start);
    if !leads(s, pack) {
        return Ok(begun);
    }
    let (most, oil) = (s.max_cycles / 2, pack.oil_pack.is_some());
    let clock = Stopwatch::start();
    let (spec, options) = rougher(s, pack, most);
    let mut lead = |done: f64| progress(LEAD * done);
    let mut cycle = in_halves(&spec, pack, wanted, &mut lead);
    let mut y = begun.y.clone();
    let closed = cycle.close(&mut y, &options);
    begun.coarse = cycle.done as usize;
    begun.seconds = clock.seconds();
    match (closed, cycle.method) {
        (Ok(report), Method::Waveform(waveform))
            if report.period == 1 && (report.converged || oil && report.error_estimate <= LEADS) =>
        {
            // Without oil a few cycles know the slope better than those in halves did.
            if oil {
                begun.known.clone_from(&report.changes);
                begun.films =
                    Some(FilmsAlone { spec, options, waveform, changes: report.changes, near: AGREED });
            }
            (begun.y, begun.near) = (y, Some(f64::INFINITY));
        }
        (Err(e), _) if !e.may_go_otherwise() => return Err(e),
        _ if oil => begun.films = Some(FilmsAlone::new(spec, options, pack)),
        _ => {}
    }
    Ok(begun)
}

impl Cycle<'_> {
    /// Takes over what led to where the search begins; its first states.
    pub(super) fn begin_at(&mut self, begun: Start) -> Vec<f64> {
        (self.known, self.near) = (begun.known, begun.near);
        (self.films, self.coarse) = (begun.films, begun.coarse);
        begun.y
    }
}
