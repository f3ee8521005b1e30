//! Directed events: found on the dense output of accepted steps, re-armed by side, never by time.
//!
//! Each event function has a *side*: the sign it was last known to have. A crossing is a change of side; the direction decides
//! whether it counts. After an event that changed the state the function is (nearly) zero and its side unknown, until it
//! leaves a band of rounding width around zero; the steps after such an event are sampled geometrically from their start, so that
//! a flight much shorter than the step is still seen.

use crate::EvalError;

use super::driver::Core;
use super::{Direction, EventAction, Flow, IntegrateError, OdeSystem, Options, Stats, StepView};
use crate::roots;

#[derive(Debug, Clone)]
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

pub(crate) enum ScanEnd {
    Through,
    Restart { t: f64 },
    Stopped,
}

/// `x(θ) = (1-θ) x0 + θ (x1 + (1-θ)(c0 + θ (c1 + θ c2)))`, states first, then quadratures.
#[derive(Clone, Copy)]
struct Dense<'a> {
    t: f64,
    h: f64,
    x0: &'a [f64],
    x1: &'a [f64],
    c: [&'a [f64]; 3],
}

impl Dense<'_> {
    fn eval(&self, t: f64, from: usize, out: &mut [f64]) {
        let th = (t - self.t) / self.h;
        let om = 1.0 - th;
        let k = out.len();
        let r = from..from + k;
        let (x0, x1) = (&self.x0[r.clone()], &self.x1[r.clone()]);
        let (c0, c1, c2) = (&self.c[0][r.clone()], &self.c[1][r.clone()], &self.c[2][r]);
        for i in 0..k {
            // Written around x0 so that a constant stays that constant.
            out[i] = x0[i] + th * ((x1[i] - x0[i]) + om * (c0[i] + th * (c1[i] + th * c2[i])));
        }
    }
}

struct View<'a> {
    t0: f64,
    t1: f64,
    y0: &'a [f64],
    y1: &'a [f64],
    q0: &'a [f64],
    q1: &'a [f64],
    dense: Dense<'a>,
}

impl StepView for View<'_> {
    fn t0(&self) -> f64 {
        self.t0
    }
    fn t1(&self) -> f64 {
        self.t1
    }
    fn y0(&self) -> &[f64] {
        self.y0
    }
    fn y1(&self) -> &[f64] {
        self.y1
    }
    fn q0(&self) -> &[f64] {
        self.q0
    }
    fn q1(&self) -> &[f64] {
        self.q1
    }
    fn interpolate(&self, t: f64, y: &mut [f64]) {
        self.dense.eval(t, 0, y);
    }
    fn interpolate_quad(&self, t: f64, q: &mut [f64]) {
        self.dense.eval(t, self.y0.len(), q);
    }
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
    pub(crate) fn new(m: usize) -> Self {
        let v = Vec::new;
        Self {
            g: v(),
            trial: v(),
            side: Vec::new(),
            repeat: Vec::new(),
            band: v(),
            band_tmp: v(),
            size: v(),
            xa: vec![0.0; m],
            xb: vec![0.0; m],
            y: vec![0.0; m],
            last_restart: f64::NEG_INFINITY,
            idle: 0,
            repeats: 0,
        }
    }

    pub(crate) fn resize(&mut self, k: usize) {
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
    pub(crate) fn start<S: OdeSystem + ?Sized>(
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
            self.side[k] = sign(self.g[k]);
            self.repeat[k] = false;
            self.band[k] = 0.0;
        }
        Ok(())
    }

    /// Hands the step to the observer, in pieces between events, and lets the events act.
    ///
    /// On [`ScanEnd::Restart`] and [`ScanEnd::Stopped`] the state at the event is in `core.x0`.
    #[expect(clippy::too_many_arguments, reason = "one call site, in the step loop")]
    pub(crate) fn scan<S: OdeSystem + ?Sized>(
        core: &mut Core,
        sys: &mut S,
        t: f64,
        h: f64,
        t_new: f64,
        opts: &Options,
        observer: &mut dyn FnMut(&mut S, &dyn StepView) -> Flow,
        stats: &mut Stats,
    ) -> Result<ScanEnd, IntegrateError> {
        let n = core.n;
        let dense =
            Dense { t, h, x0: &core.x0, x1: &core.x1, c: [&core.cont[0], &core.cont[1], &core.cont[2]] };
        let fail = |e: EvalError| IntegrateError::Eval { t, source: e };
        let ev = &mut core.events;
        if ev.g.is_empty() {
            let view = View {
                t0: t,
                t1: t_new,
                y0: &core.x0[..n],
                y1: &core.x1[..n],
                q0: &core.x0[n..],
                q1: &core.x1[n..],
                dense,
            };
            return Ok(match observer(sys, &view) {
                Flow::Continue => ScanEnd::Through,
                Flow::Stop => {
                    std::mem::swap(&mut core.x0, &mut core.x1);
                    ScanEnd::Stopped
                }
            });
        }
        // `tb` is exact at the end of the step, so that the pieces join without gaps.
        let time = |th: f64| if th >= 1.0 { t_new } else { t + th * h };
        let ulp = f64::EPSILON * t.abs().max(t_new.abs());
        let tol = (2.0 * ulp / h).max(2.0 * f64::EPSILON);
        for k in 0..ev.g.len() {
            ev.size[k] = ev.g[k].abs();
        }
        ev.xa.copy_from_slice(&core.x0);
        let mut a = 0.0;
        let mut piece_start = t;
        let unknown = ev.side.contains(&0);
        // Samples: geometric while a side is unknown, then equidistant, then the end.
        let interior = f64::from(opts.event_samples) + 1.0;
        let mut next_geometric = if unknown { tol.max(1e-13) * 2.0 } else { f64::INFINITY };
        let mut next_even = 1.0;
        loop {
            let even = next_even / interior;
            let b = if next_geometric < even.min(1.0) {
                let b = next_geometric;
                next_geometric *= 4.0;
                b
            } else {
                next_even += 1.0;
                even.min(1.0)
            };
            let at_end = b >= 1.0;
            if at_end {
                ev.y[..n].copy_from_slice(&core.x1[..n]);
            } else {
                dense.eval(time(b), 0, &mut ev.y[..n]);
            }
            sys.events(time(b), &ev.y[..n], &mut ev.g).map_err(fail)?;
            for k in 0..ev.g.len() {
                if ev.g[k].is_nan() {
                    return Err(IntegrateError::Eval {
                        t,
                        source: EvalError::fatal("events", "an event function is not a number"),
                    });
                }
                ev.size[k] = ev.size[k].max(ev.g[k].abs());
            }
            // All crossings in (a, b], in order.
            loop {
                let mut first: Option<(f64, usize, bool)> = None;
                for k in 0..ev.g.len() {
                    let d = sys.event_direction(k);
                    let now = sign(ev.g[k]);
                    if ev.side[k] == 0 {
                        if ev.g[k].abs() <= ev.band[k] {
                            continue;
                        }
                        // Out of the band. On the far side of a directed event after a state change: it happens again.
                        let again = ev.repeat[k] && d != Direction::Either && counts(d, -now);
                        if !again {
                            ev.side[k] = now;
                            ev.repeat[k] = false;
                        } else if first.is_none_or(|(x, ..)| b < x) {
                            first = Some((b, k, true));
                        }
                        continue;
                    }
                    if i32::from(ev.side[k]) * i32::from(now) > 0 {
                        continue;
                    }
                    if !counts(d, ev.side[k]) {
                        // Crossed against its direction: only the side changes. A zero leaves the side open.
                        if now != 0 {
                            ev.side[k] = now;
                        }
                        continue;
                    }
                    let s = f64::from(ev.side[k]);
                    let root = if !sys.event_located(k) {
                        b
                    } else {
                        let (y, g) = (&mut ev.y, &mut ev.trial);
                        let mut failure = None;
                        let r = roots::itp(
                            |th| {
                                if th >= 1.0 {
                                    y[..n].copy_from_slice(&dense.x1[..n]);
                                } else {
                                    dense.eval(time(th), 0, &mut y[..n]);
                                }
                                sys.events(time(th), &y[..n], g).map(|()| s * g[k])
                            },
                            a,
                            b,
                            tol,
                        );
                        let x = match r {
                            Ok(r) => r.x,
                            // Already across at the left end (a second event at the same time).
                            Err(roots::RootError::NoBracket { .. }) => a,
                            Err(roots::RootError::Function(e)) => {
                                failure = Some(e);
                                a
                            }
                            Err(_) => b,
                        };
                        if let Some(e) = failure {
                            return Err(fail(e));
                        }
                        x
                    };
                    if first.is_none_or(|(x, ..)| root < x) {
                        first = Some((root, k, false));
                    }
                }
                let Some((th, k, again)) = first else { break };
                // Deliver what comes before the event, then let it act.
                let te = time(th);
                if th >= 1.0 {
                    ev.xb.copy_from_slice(&core.x1);
                } else {
                    dense.eval(te, 0, &mut ev.xb);
                }
                if te > piece_start {
                    let view = View {
                        t0: piece_start,
                        t1: te,
                        y0: &ev.xa[..n],
                        y1: &ev.xb[..n],
                        q0: &ev.xa[n..],
                        q1: &ev.xb[n..],
                        dense,
                    };
                    if observer(sys, &view) == Flow::Stop {
                        core.x0.copy_from_slice(&ev.xb);
                        return Ok(ScanEnd::Stopped);
                    }
                    piece_start = te;
                    ev.xa.copy_from_slice(&ev.xb);
                }
                sys.events(te, &ev.xb[..n], &mut ev.trial).map_err(fail)?;
                stats.events += 1;
                ev.y[..n].copy_from_slice(&ev.xb[..n]);
                let action = sys
                    .on_event(k, te, &mut ev.y[..n])
                    .map_err(|e| IntegrateError::Eval { t: te, source: e })?;
                match action {
                    EventAction::Continue => {
                        ev.side[k] = sign(ev.g[k]);
                        ev.repeat[k] = false;
                        ev.band[k] = 0.0;
                        a = th;
                    }
                    EventAction::Stop => {
                        core.x0.copy_from_slice(&ev.xb);
                        core.x0[..n].copy_from_slice(&ev.y[..n]);
                        return Ok(ScanEnd::Stopped);
                    }
                    EventAction::Restart => {
                        if ev.y[..n].iter().any(|v| !v.is_finite()) {
                            return Err(IntegrateError::NonFinite { t: te });
                        }
                        let changed = ev.y[..n] != ev.xb[..n];
                        // xb keeps the quadratures, y brings the states.
                        ev.xb[..n].copy_from_slice(&ev.y[..n]);
                        sys.events(te, &ev.xb[..n], &mut ev.g).map_err(fail)?;
                        // What rounding of the time and of the interpolated state can make of a zero; the latter
                        // loses against the larger end of the step.
                        sys.events(t_new, &core.x1[..n], &mut ev.band_tmp).map_err(fail)?;
                        let size = ev.size[k].max(ev.band_tmp[k].abs());
                        let size = if size.is_finite() { size } else { ev.size[k] };
                        let resolved = (64.0 * f64::EPSILON + 8.0 * ulp / (te - t).max(8.0 * ulp)).min(1.0);
                        for j in 0..ev.g.len() {
                            let now = sign(ev.g[j]);
                            if j == k && again {
                                // Deeper each time, so that a function that never comes back is told from rounding.
                                ev.band[j] = 2.0 * ev.g[j].abs().max(ev.band[j]);
                                (ev.side[j], ev.repeat[j]) = (0, changed);
                            } else if j == k {
                                ev.band[j] = resolved * size;
                                let out = ev.g[j].abs() > ev.band[j];
                                ev.side[j] = if out { now } else { 0 };
                                ev.repeat[j] = !out && changed;
                            } else if now != sign(ev.trial[j]) {
                                // Moved across by the handler: not a crossing.
                                ev.side[j] = now;
                                ev.repeat[j] = false;
                                ev.band[j] = 0.0;
                            }
                        }
                        core.x0.copy_from_slice(&ev.xb);
                        ev.repeats = if again { ev.repeats + 1 } else { 0 };
                        ev.idle = if te - ev.last_restart <= 64.0 * ulp { ev.idle + 1 } else { 0 };
                        if ev.repeats >= MAX_REPEATS || ev.idle >= MAX_IDLE {
                            return Err(IntegrateError::Chatter { t: te, event: k });
                        }
                        ev.last_restart = te;
                        return Ok(ScanEnd::Restart { t: te });
                    }
                }
            }
            a = b;
            if at_end {
                break;
            }
        }
        if t_new > piece_start {
            let view = View {
                t0: piece_start,
                t1: t_new,
                y0: &ev.xa[..n],
                y1: &core.x1[..n],
                q0: &ev.xa[n..],
                q1: &core.x1[n..],
                dense,
            };
            if observer(sys, &view) == Flow::Stop {
                std::mem::swap(&mut core.x0, &mut core.x1);
                return Ok(ScanEnd::Stopped);
            }
        }
        Ok(ScanEnd::Through)
    }
}
