//! Directed events: found on the dense output of accepted steps, re-armed by side, never by time.
//!
//! Each event function has a *side*: the sign it was last known to have. A crossing is a change of side; the direction decides
//! whether it counts. After an event that changed the state the function is (nearly) zero and its side unknown, until it
//! leaves a band of rounding width around zero; the steps after such an event are sampled geometrically from their start, so that
//! a flight much shorter than the step is still seen.

use crate::EvalError;

use super::dense::{Dense, Piece};
use super::integrator::{Flow, StepView};
use super::options::{IntegrateError, Options, Stats};
use super::samples::Samples;
use super::system::{Direction, EventAction, OdeSystem};
use crate::roots;

/// What is known of the event functions, and work arrays.
#[derive(Debug, Clone, Default)]
pub(crate) struct Events {
    /// Values at the last sample, at a trial point.
    g: Vec<f64>,
    trial: Vec<f64>,
    /// Sign last known, 0 when unknown.
    side: Vec<i8>,
    /// A state change left the function at zero: leaving on the far side is a repeat of the event.
    repeat: Vec<bool>,
    /// Width of the zero band.
    band: Vec<f64>,
    band_tmp: Vec<f64>,
    /// Largest |g| seen in the current step.
    size: Vec<f64>,
    /// Time at which the current piece of the step begins.
    from: f64,
    /// States at the two ends of a piece, and a copy for the handler.
    xa: Vec<f64>,
    xb: Vec<f64>,
    y: Vec<f64>,
    last_restart: f64,
    /// Successive restarts without progress in time, and repeats without coming back.
    idle: u32,
    repeats: u32,
}

/// Times an event may repeat without its function having come back; the band doubles with each.
const MAX_REPEATS: u32 = 20;
/// Restarts in a row within the resolution of time.
const MAX_IDLE: u32 = 100;

/// How the search through a step ended.
pub(super) enum ScanEnd {
    /// At the end of the step.
    Through,
    /// At the end of the step, where the observer stops the integration.
    StoppedAtEnd,
    /// The integration stops in the state [`Events::state`].
    Stopped,
    /// An event at `t` left the state [`Events::state`], from which to go on.
    Restart { t: f64 },
    /// Event `event` repeats at `t` without progress, in the state [`Events::state`].
    Chatter { t: f64, event: usize },
}

/// An accepted step: its dense output, and its end time, which `t + h` may miss by rounding.
pub(super) struct Step<'a> {
    pub n: usize,
    pub dense: Dense<'a>,
    pub t_new: f64,
}

impl Step<'_> {
    /// Time at θ; exact at the end of the step, so that the pieces join without gaps.
    fn time(&self, theta: f64) -> f64 {
        if theta >= 1.0 { self.t_new } else { self.dense.t + theta * self.dense.h }
    }

    /// The first components at θ, as many as `x` holds.
    fn state(&self, theta: f64, x: &mut [f64]) {
        if theta >= 1.0 {
            x.copy_from_slice(&self.dense.x1[..x.len()]);
        } else {
            self.dense.eval(self.time(theta), 0, x);
        }
    }

    /// Spacing of the numbers at the times of the step.
    fn ulp(&self) -> f64 {
        f64::EPSILON * self.dense.t.abs().max(self.t_new.abs())
    }

    /// Resolution of θ.
    fn resolution(&self) -> f64 {
        (2.0 * self.ulp() / self.dense.h).max(2.0 * f64::EPSILON)
    }

    fn fail(&self, source: EvalError) -> IntegrateError {
        IntegrateError::Eval { t: self.dense.t, source }
    }
}

/// Event function `k` changes its side at θ.
#[derive(Clone, Copy)]
struct Crossing {
    theta: f64,
    k: usize,
    /// The function left zero on the far side after a state change: the same event once more.
    again: bool,
}

fn sign(v: f64) -> i8 {
    if v > 0.0 {
        1
    } else if v < 0.0 {
        -1
    } else {
        0
    }
}

/// Whether leaving `side` counts.
fn counts(d: Direction, side: i8) -> bool {
    match d {
        Direction::Rising => side < 0,
        Direction::Falling => side > 0,
        Direction::Either => side != 0,
    }
}

impl Events {
    /// For states and quadratures of `m` components together.
    pub(super) fn new(m: usize) -> Self {
        let v = Vec::new;
        Self {
            g: v(),
            trial: v(),
            side: Vec::new(),
            repeat: Vec::new(),
            band: v(),
            band_tmp: v(),
            size: v(),
            from: 0.0,
            xa: vec![0.0; m],
            xb: vec![0.0; m],
            y: vec![0.0; m],
            last_restart: f64::NEG_INFINITY,
            idle: 0,
            repeats: 0,
        }
    }

    /// Prepares an integration with `k` event functions.
    pub(super) fn resize(&mut self, k: usize) {
        for v in [&mut self.g, &mut self.trial, &mut self.band, &mut self.band_tmp, &mut self.size] {
            v.resize(k, 0.0);
        }
        self.side.resize(k, 0);
        self.repeat.resize(k, false);
        self.last_restart = f64::NEG_INFINITY;
        self.idle = 0;
        self.repeats = 0;
    }

    /// Sides at the start of an integration.
    pub(super) fn start<S: OdeSystem + ?Sized>(
        &mut self,
        sys: &mut S,
        t: f64,
        y: &[f64],
    ) -> Result<(), EvalError> {
        if self.g.is_empty() {
            return Ok(());
        }
        sys.events(t, y, &mut self.g)?;
        for k in 0..self.g.len() {
            self.set_side(k, sign(self.g[k]));
        }
        Ok(())
    }

    /// States and quadratures where a scan ended inside the step.
    pub(super) fn state(&self) -> &[f64] {
        &self.xb
    }

    /// Hands the step to the observer, in pieces between events, and lets the events act.
    pub(super) fn scan<S: OdeSystem + ?Sized>(
        &mut self,
        step: &Step<'_>,
        sys: &mut S,
        opts: &Options,
        observer: &mut dyn FnMut(&mut S, &dyn StepView) -> Flow,
        stats: &mut Stats,
    ) -> Result<ScanEnd, IntegrateError> {
        let start = (step.dense.t, step.dense.x0);
        if self.g.is_empty() {
            return Ok(last_piece(step, start, sys, observer));
        }
        for k in 0..self.g.len() {
            self.size[k] = self.g[k].abs();
        }
        self.from = step.dense.t;
        self.xa.copy_from_slice(step.dense.x0);
        let unknown = self.side.contains(&0);
        // No event lies before this θ.
        let mut a = 0.0;
        for b in Samples::new(opts.event_samples, unknown.then(|| step.resolution())) {
            self.sample(step, sys, b)?;
            // All crossings in (a, b], in order.
            while let Some(crossing) = self.first_crossing(step, sys, a, b)? {
                if self.deliver(step, sys, crossing.theta, observer) == Flow::Stop {
                    return Ok(ScanEnd::Stopped);
                }
                if let Some(end) = self.act(step, sys, crossing, stats)? {
                    return Ok(end);
                }
                a = crossing.theta;
            }
            a = b;
        }
        if step.t_new > self.from {
            return Ok(last_piece(step, (self.from, &self.xa), sys, observer));
        }
        Ok(ScanEnd::Through)
    }

    /// Evaluates the event functions at θ.
    fn sample<S: OdeSystem + ?Sized>(
        &mut self,
        step: &Step<'_>,
        sys: &mut S,
        theta: f64,
    ) -> Result<(), IntegrateError> {
        step.state(theta, &mut self.y[..step.n]);
        sys.events(step.time(theta), &self.y[..step.n], &mut self.g).map_err(|e| step.fail(e))?;
        for k in 0..self.g.len() {
            if self.g[k].is_nan() {
                return Err(step.fail(EvalError::fatal("events", "an event function is not a number")));
            }
            self.size[k] = self.size[k].max(self.g[k].abs());
        }
        Ok(())
    }

    /// The earliest crossing that counts between θ of `a` and `b`, where the last sample is that at `b`.
    fn first_crossing<S: OdeSystem + ?Sized>(
        &mut self,
        step: &Step<'_>,
        sys: &mut S,
        a: f64,
        b: f64,
    ) -> Result<Option<Crossing>, IntegrateError> {
        let mut first: Option<Crossing> = None;
        for k in 0..self.g.len() {
            let direction = sys.event_direction(k);
            let found = if self.side[k] == 0 {
                self.leaves_band(k, direction).then_some((b, true))
            } else if !self.crosses(k, direction) {
                None
            } else if sys.event_located(k) {
                Some((self.locate(step, sys, k, a, b)?, false))
            } else {
                Some((b, false))
            };
            if let Some((theta, again)) = found
                && first.is_none_or(|c| theta < c.theta)
            {
                first = Some(Crossing { theta, k, again });
            }
        }
        Ok(first)
    }

    /// Takes note of a function whose side is unknown and that is now beyond its band; answers whether that repeats its event.
    fn leaves_band(&mut self, k: usize, direction: Direction) -> bool {
        if self.g[k].abs() <= self.band[k] {
            return false;
        }
        // Out of the band. On the far side of a directed event after a state change: it happens again.
        let now = sign(self.g[k]);
        let again = self.repeat[k] && direction != Direction::Either && counts(direction, -now);
        if !again {
            self.side[k] = now;
            self.repeat[k] = false;
        }
        again
    }

    /// Whether a function whose side is known has crossed zero in a direction that counts; takes note when it does not.
    fn crosses(&mut self, k: usize, direction: Direction) -> bool {
        let now = sign(self.g[k]);
        if i32::from(self.side[k]) * i32::from(now) > 0 {
            return false;
        }
        if counts(direction, self.side[k]) {
            return true;
        }
        // Crossed against its direction: only the side changes. A zero leaves the side open.
        if now != 0 {
            self.side[k] = now;
        }
        false
    }

    /// θ between `a` and `b` at which function `k` goes through zero, to the resolution of time.
    fn locate<S: OdeSystem + ?Sized>(
        &mut self,
        step: &Step<'_>,
        sys: &mut S,
        k: usize,
        a: f64,
        b: f64,
    ) -> Result<f64, IntegrateError> {
        let s = f64::from(self.side[k]);
        let (y, g) = (&mut self.y[..step.n], &mut self.trial);
        let f = |theta: f64| {
            step.state(theta, y);
            sys.events(step.time(theta), y, g).map(|()| s * g[k])
        };
        match roots::itp(f, a, b, step.resolution()) {
            Ok(r) => Ok(r.x),
            // Already across at the left end (a second event at the same time).
            Err(roots::RootError::NoBracket { .. }) => Ok(a),
            Err(roots::RootError::Function(e)) => Err(step.fail(e)),
            Err(_) => Ok(b),
        }
    }

    /// Hands what comes before θ to the observer; leaves the state there in `xb`.
    fn deliver<S: OdeSystem + ?Sized>(
        &mut self,
        step: &Step<'_>,
        sys: &mut S,
        theta: f64,
        observer: &mut dyn FnMut(&mut S, &dyn StepView) -> Flow,
    ) -> Flow {
        step.state(theta, &mut self.xb);
        let te = step.time(theta);
        if te > self.from {
            let piece = Piece::new(step.n, (self.from, &self.xa), (te, &self.xb), step.dense);
            if observer(sys, &piece) == Flow::Stop {
                return Flow::Stop;
            }
            self.from = te;
            self.xa.copy_from_slice(&self.xb);
        }
        Flow::Continue
    }

    /// Lets an event act on the state in `xb`; `None` when the scan goes on behind it.
    fn act<S: OdeSystem + ?Sized>(
        &mut self,
        step: &Step<'_>,
        sys: &mut S,
        crossing: Crossing,
        stats: &mut Stats,
    ) -> Result<Option<ScanEnd>, IntegrateError> {
        let (n, k, te) = (step.n, crossing.k, step.time(crossing.theta));
        sys.events(te, &self.xb[..n], &mut self.trial).map_err(|e| step.fail(e))?;
        stats.events += 1;
        self.y[..n].copy_from_slice(&self.xb[..n]);
        let action =
            sys.on_event(k, te, &mut self.y[..n]).map_err(|e| IntegrateError::Eval { t: te, source: e })?;
        match action {
            EventAction::Continue => {
                self.set_side(k, sign(self.g[k]));
                Ok(None)
            }
            EventAction::Stop => {
                self.xb[..n].copy_from_slice(&self.y[..n]);
                Ok(Some(ScanEnd::Stopped))
            }
            EventAction::Restart => self.restart(step, sys, crossing).map(Some),
        }
    }

    /// The handler of an event has left a new state in `y`, from which the integration starts again.
    fn restart<S: OdeSystem + ?Sized>(
        &mut self,
        step: &Step<'_>,
        sys: &mut S,
        Crossing { theta, k, again }: Crossing,
    ) -> Result<ScanEnd, IntegrateError> {
        let (n, te, ulp) = (step.n, step.time(theta), step.ulp());
        if self.y[..n].iter().any(|v| !v.is_finite()) {
            return Err(IntegrateError::NonFinite { t: te });
        }
        let changed = self.y[..n] != self.xb[..n];
        // xb keeps the quadratures, y brings the states.
        self.xb[..n].copy_from_slice(&self.y[..n]);
        sys.events(te, &self.xb[..n], &mut self.g).map_err(|e| step.fail(e))?;
        // What rounding of the time and of the interpolated state can make of a zero; the latter
        // loses against the larger end of the step.
        sys.events(step.t_new, &step.dense.x1[..n], &mut self.band_tmp).map_err(|e| step.fail(e))?;
        let size = self.size[k].max(self.band_tmp[k].abs());
        let size = if size.is_finite() { size } else { self.size[k] };
        let resolved = (64.0 * f64::EPSILON + 8.0 * ulp / (te - step.dense.t).max(8.0 * ulp)).min(1.0);
        self.rearm(k, again, changed, resolved * size);
        self.repeats = if again { self.repeats + 1 } else { 0 };
        self.idle = if te - self.last_restart <= 64.0 * ulp { self.idle + 1 } else { 0 };
        if self.repeats >= MAX_REPEATS || self.idle >= MAX_IDLE {
            return Ok(ScanEnd::Chatter { t: te, event: k });
        }
        self.last_restart = te;
        Ok(ScanEnd::Restart { t: te })
    }

    /// Sides after event `k` has changed the state or the equations: `g` are the values behind it, `trial` those before.
    fn rearm(&mut self, k: usize, again: bool, changed: bool, band: f64) {
        for j in 0..self.g.len() {
            let now = sign(self.g[j]);
            if j == k && again {
                // Deeper each time, so that a function that never comes back is told from rounding.
                self.band[j] = 2.0 * self.g[j].abs().max(self.band[j]);
                (self.side[j], self.repeat[j]) = (0, changed);
            } else if j == k {
                self.band[j] = band;
                let out = self.g[j].abs() > self.band[j];
                self.side[j] = if out { now } else { 0 };
                self.repeat[j] = !out && changed;
            } else if now != sign(self.trial[j]) {
                // Moved across by the handler: not a crossing.
                self.set_side(j, now);
            }
        }
    }

    /// The side of function `k` is known, no repeat is expected.
    fn set_side(&mut self, k: usize, side: i8) {
        self.side[k] = side;
        self.repeat[k] = false;
        self.band[k] = 0.0;
    }
}

/// Hands what is left of the step to the observer.
fn last_piece<S: ?Sized>(
    step: &Step<'_>,
    start: (f64, &[f64]),
    sys: &mut S,
    observer: &mut dyn FnMut(&mut S, &dyn StepView) -> Flow,
) -> ScanEnd {
    let piece = Piece::new(step.n, start, (step.t_new, step.dense.x1), step.dense);
    match observer(sys, &piece) {
        Flow::Continue => ScanEnd::Through,
        Flow::Stop => ScanEnd::StoppedAtEnd,
    }
}
