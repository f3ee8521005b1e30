//! Derivatives of the states along a cycle, on the steps that the integrator takes.
//!
//! `∂y/∂y0` and `∂y/∂p` obey `S' = f_y S + f_p` ([`gudgeon_numerics::tangent`]). For an input the right-hand side is not put together from `f_y` and `f_p`,
//! which differences about a state take in different directions: where the rates have a corner (a film that stops being squeezed, a ring that
//! leaves a flank) these could lie on different sides of it, and large stiffnesses that cancel would not. It is the difference
//!
//! ```text
//! f_p = (f(y + ε S*, p + ε) - f(y, p))/ε - f_y S*
//! ```
//!
//! in the direction `S*` in which the derivatives are expected to lie, which are those of the steps before, extrapolated: `f_y` then counts only for what
//! they miss. States inside a step, which its dense output tells less accurately than its ends, take one step of Newton's method towards the collocation
//! equations first.
//!
//! # Corners
//! The integrator of the states steps over a corner of the rates (a ring that comes off a flank, a film that begins to be drawn apart, a flow that turns) where
//! the states feel it less than the tolerance. Derivatives feel it at once. A step in which an entry of `f_y` changes by a part of itself that counts over the
//! step is therefore halved until it does not, or until the piece with the corner is too short to matter. The states are solved anew in these pieces, the
//! collocation equations by Newton's method to the end: what the dense output says may lie on the other side of the corner, where `f_y` is another. The pieces
//! with the corner are taken twice, with what the first time found in the place of `S*`, for all columns.

use gudgeon_core::EvalError;
use gudgeon_numerics::linalg::dot;
use gudgeon_numerics::ode::{Flow, StepView};
use gudgeon_numerics::panel::LOBATTO;
use gudgeon_numerics::tangent::{Jump, NODES, Tangent};

use super::super::{Base, Cycle, Follower, Pack, increment};
use crate::around::Varied;
use crate::modes::EventOf;

/// Change of a scaled state by which differences in a direction are taken.
const EPSILON: f64 = 1e-7;
/// Part of a state by which differences tell the Jacobian. A ring that stands on a flank has sunk into it by some 1e-8 of its height, and a difference
/// across the place where it comes off tells neither side.
const INCREMENT: f64 = 1e-9;
/// Part of an entry of the Jacobian by which it may change between the nodes of a step that is not halved, and the change over the step, in the scales of the
/// states, from which on it counts.
const BENT: (f64, f64) = (0.2, 3e-3);
/// Most times a step is halved. A corner in the smallest piece is misjudged by less than that piece.
const HALVINGS: u32 = 6;
/// Most steps of Newton's method for the states at the nodes of a piece, and the change that ends them, in the scales of the states.
const ITERATIONS: (usize, f64) = (5, 1e-12);
/// Part of its change by which a step of Newton's method may miss the rates, and the change from which on that is told from rounding: more, and there was a
/// corner on the way.
const MISLED: (f64, f64) = (0.1, 1e-11);
/// Longest step, over the one before, into which derivatives are extrapolated.
const REACH: f64 = 2.0;
/// What a state inside a step may miss, in its scale, for a step of Newton's method to bring it nearer.
const MISSED: f64 = 1e-2;
/// An event is one of a function that is this near to zero.
const AT_ZERO: f64 = 1e-6;
/// Distance from a kink \[rad\], and part of the step, at which the last node keeps from it: the inputs shift kinks by some 1e-7 of their angle.
const CLEAR: (f64, f64) = (5e-6, 0.1);

/// Work.
#[derive(Debug, Clone, Copy, Default)]
pub struct Work {
    /// Instants of the pack itself.
    pub instants: u64,
    /// Its Jacobians.
    pub jacobians: u64,
    /// Instants of the packs beside it.
    pub beside: u64,
}

/// What the states at the nodes of a piece met.
#[derive(Clone, Copy)]
struct Met {
    /// Whether the Jacobians there differ.
    bent: bool,
    /// Whether a corner lay between them and where they were sought.
    passed: bool,
}

/// Where a step, or a part of one between two events, ended.
struct Last {
    theta: f64,
    y: Vec<f64>,
    memory: Vec<f64>,
}

/// Follows the derivatives of a cycle.
pub struct Variation<'a> {
    varied: &'a mut [Varied],
    n: usize,
    rows: usize,
    pub columns: usize,
    tangent: Tangent,
    base: Base,
    scale: Vec<f64>,
    /// Kinks, and by how much each input shifts them \[rad per SI unit\].
    kinks: Vec<(f64, Vec<f64>)>,
    /// The state at a node, one beside it, and rates there.
    y: [Vec<f64>; NODES.len()],
    moved: Vec<f64>,
    f: [Vec<f64>; NODES.len()],
    beside: Vec<f64>,
    missing: Vec<f64>,
    expected: Vec<f64>,
    /// Products of the Jacobian with `expected`.
    told: Vec<f64>,
    /// The state at which the next piece begins.
    start: Vec<f64>,
    memory: Vec<f64>,
    last: Option<Last>,
    /// Length of the last step, where its derivatives lead on behind it.
    reach: Option<f64>,
    trail: Trail,
    /// Derivatives of the states at the end.
    pub ends: Vec<f64>,
    pub work: Work,
    pub failure: Option<EvalError>,
}

/// What is kept of a followed cycle.
#[derive(Default)]
pub struct Trail {
    pub n: usize,
    pub rows: usize,
    pub columns: usize,
    /// Ends of the steps \[rad\].
    pub steps: Vec<(f64, f64)>,
    /// States and quadratures at the nodes of [`LOBATTO`] in each step.
    pub states: Vec<f64>,
    /// Their derivatives there.
    pub slopes: Vec<f64>,
}

impl<'a> Variation<'a> {
    pub fn new(cycle: &Cycle<'_>, varied: &'a mut [Varied], tolerance: f64) -> Self {
        let pack = &cycle.pack;
        let (n, rows) = (pack.layout.n, pack.layout.n + pack.layout.quads());
        let columns = n + varied.len();
        for v in varied.iter_mut() {
            v.pack.each_block(|b, _| b.set_accuracy(tolerance));
        }
        let own = pack.cylinder.kinks();
        let shift = |b: f64| -> Vec<f64> {
            let k = own.iter().position(|kink| *kink == b);
            varied.iter().map(|v| k.map_or(0.0, |k| (v.pack.cylinder.kinks()[k] - b) / v.step)).collect()
        };
        let kinks = cycle.breakpoints.iter().map(|b| (*b, shift(*b))).collect();
        let mut tangent = Tangent::new(n, rows - n, columns);
        for k in 0..n {
            tangent.values_mut()[k * columns + k] = 1.0;
        }
        let values = |len: usize| vec![0.0; len];
        Self {
            varied,
            n,
            rows,
            columns,
            tangent,
            base: Base::default(),
            scale: cycle.scale.clone(),
            kinks,
            y: [values(n), values(n), values(n)],
            moved: values(n),
            f: [values(rows), values(rows), values(rows)],
            beside: values(rows),
            missing: values(NODES.len() * n),
            expected: values(rows * columns),
            told: values(rows * columns),
            start: values(n),
            memory: Vec::new(),
            last: None,
            reach: None,
            trail: Trail { n, rows, columns, ..Trail::default() },
            ends: Vec::new(),
            work: Work::default(),
            failure: None,
        }
    }

    /// What is kept of the cycle.
    pub fn trail(self) -> Trail {
        self.trail
    }

    /// The cycle has ended, in the modes with which the next one begins.
    pub fn end(&mut self, pack: &mut Pack) {
        self.forget(pack);
        self.ends = self.tangent.values()[..self.n * self.columns].to_vec();
    }

    /// A state that is not integrated has no derivatives of its own.
    fn forget(&mut self, pack: &mut Pack) {
        let columns = self.columns;
        let values = self.tangent.values_mut();
        pack.each_block(|b, own| {
            for (_, r) in own.enumerate().filter(|(k, _)| !b.is_integrated(*k)) {
                values[r * columns..(r + 1) * columns].fill(0.0);
            }
        });
    }

    fn advance(&mut self, pack: &mut Pack, v: &dyn StepView) -> Result<(), EvalError> {
        self.memory.clear();
        pack.save(&mut self.memory);
        self.enter(pack, v)?;
        self.start.copy_from_slice(v.y0());
        self.over(pack, v, (v.t0(), v.t1()), HALVINGS)?;
        self.last = Some(Last { theta: v.t1(), y: v.y1().to_vec(), memory: self.memory.clone() });
        Ok(())
    }

    /// Takes the derivatives over the piece of the step `v` from `t0` to `t1`, in halves where there is a corner in it.
    fn over(
        &mut self,
        pack: &mut Pack,
        v: &dyn StepView,
        (t0, t1): (f64, f64),
        halvings: u32,
    ) -> Result<(), EvalError> {
        let h = t1 - t0;
        let times = NODES.map(|x| t0 + x * h).map(|t| t.min(self.clear_of(t1, h)));
        for (y, t) in self.y.iter_mut().zip(&times) {
            v.interpolate(*t, y);
        }
        let met = self.settle(pack, h, &times, halvings)?;
        if met.bent && halvings > 0 {
            let middle = 0.5 * (t0 + t1);
            self.over(pack, v, (t0, middle), halvings - 1)?;
            return self.over(pack, v, (middle, t1), halvings - 1);
        }
        self.take(pack, h, &times, met)?;
        self.start.copy_from_slice(&self.y[NODES.len() - 1]);
        self.keep(v, (t0, t1));
        Ok(())
    }

    /// Brings the states at the nodes to the solution, one step of Newton's method nearer where the rates are smooth, to the end where they are not, and
    /// linearises the equations there.
    fn settle(
        &mut self,
        pack: &mut Pack,
        h: f64,
        times: &[f64; NODES.len()],
        halvings: u32,
    ) -> Result<Met, EvalError> {
        let mut met = Met { bent: false, passed: false };
        for k in 1..=ITERATIONS.0 {
            for (i, t) in times.iter().enumerate() {
                self.linearise(pack, (i, *t))?;
            }
            met.bent = self.is_bent(h);
            self.tangent.prepare(h).map_err(|e| EvalError::fatal("gradients", e.to_string()))?;
            let Some((change, misled)) = self.correct(pack, h, times)? else { break };
            met.passed |= misled > MISLED.0 * change && change > MISLED.1;
            let smooth = halvings == HALVINGS && !met.passed && !met.bent;
            let halved = met.bent && halvings > 0 && k > 1;
            if smooth || halved || change < ITERATIONS.1 {
                break;
            }
        }
        Ok(met)
    }

    /// One step of length `h` with the equations that were linearised, twice where there is a corner.
    fn take(
        &mut self,
        pack: &mut Pack,
        h: f64,
        times: &[f64; NODES.len()],
        met: Met,
    ) -> Result<(), EvalError> {
        let reach = self.reach.take().filter(|before| h <= REACH * before);
        for (i, t) in times.iter().enumerate() {
            match reach {
                Some(before) => self.tangent.interpolate(1.0 + NODES[i] * h / before, &mut self.expected),
                None => self.expected.copy_from_slice(self.tangent.values()),
            }
            self.forcing(i, *t)?;
        }
        self.tangent.step(h);
        if met.bent || met.passed {
            // Behind a corner nothing leads on.
            self.again(pack, h, times)
        } else {
            self.reach = Some(h);
            Ok(())
        }
    }

    /// The step once more, in the directions that it found.
    fn again(&mut self, pack: &mut Pack, h: f64, times: &[f64; NODES.len()]) -> Result<(), EvalError> {
        self.tangent.undo();
        for (i, t) in times.iter().enumerate() {
            self.expected.copy_from_slice(self.tangent.knot(i + 1));
            self.forcing(i, *t)?;
            self.directions(pack, i, *t)?;
        }
        self.tangent.step(h);
        // Elsewhere the products with the Jacobian are all that states at the start need.
        for i in 0..NODES.len() {
            self.tangent.node(i).forcing.fill(0.0);
        }
        Ok(())
    }

    /// One step of Newton's method for the states at the nodes: by how much it changed them, and by how much it missed the rates that it expected, over the
    /// length `h`; both in the scales of the states. Nothing where they are not known to be near the solution.
    fn correct(
        &mut self,
        pack: &mut Pack,
        h: f64,
        times: &[f64; NODES.len()],
    ) -> Result<Option<(f64, f64)>, EvalError> {
        let n = self.n;
        self.tangent.missing(h, &self.start, &self.y, &self.f, &mut self.missing);
        let parts = self.missing.iter().enumerate().map(|(k, d)| (d / self.scale[k % n]).abs());
        let change = parts.fold(0.0, f64::max);
        if change > MISSED || !self.missing.iter().all(|d| d.is_finite()) {
            return Ok(None);
        }
        let mut misled = 0.0_f64;
        for (i, t) in times.iter().enumerate() {
            let d = &self.missing[i * n..(i + 1) * n];
            self.y[i].iter_mut().zip(d).for_each(|(y, d)| *y += d);
            let rows = self.tangent.nodes()[i].jacobian.chunks_exact(n);
            for ((told, row), f) in self.told.iter_mut().zip(rows).zip(&self.f[i]) {
                *told = f + dot(row, d);
            }
            pack.rates(*t, &self.y[i], &mut self.f[i])?;
            self.work.instants += 1;
            for ((f, told), scale) in self.f[i].iter().zip(&self.told).zip(&self.scale) {
                misled = misled.max((h * (f - told) / scale).abs());
            }
        }
        Ok(Some((change, misled)))
    }

    /// The linearised equations at node `i`, at the angle `t`, without the part of the inputs.
    fn linearise(&mut self, pack: &mut Pack, (i, t): (usize, f64)) -> Result<(), EvalError> {
        pack.rates(t, &self.y[i], &mut self.f[i])?;
        let (y, scale) = (&self.y[i], &self.scale);
        let node = self.tangent.node(i);
        pack.jacobian(y, |k| increment(INCREMENT, y[k], scale[k]), &mut node.jacobian, &mut self.base)?;
        self.work.instants += 1;
        self.work.jacobians += 1;
        Ok(())
    }

    /// Takes the derivatives across what lies between the last piece and this one.
    fn enter(&mut self, pack: &mut Pack, v: &dyn StepView) -> Result<(), EvalError> {
        let Some(last) = self.last.take() else { return Ok(()) };
        if last.y != v.y0() || last.memory != self.memory {
            self.event(pack, &last, v.y0())?;
            self.reach = None;
        }
        if let Some(k) = self.kinks.iter().position(|(at, _)| (at - last.theta).abs() < 1e-12) {
            self.reach = None;
            if self.kinks[k].1.iter().any(|s| *s != 0.0) {
                self.kink(pack, k, v.y0())?;
            }
        }
        Ok(())
    }

    /// The latest angle of a node of a step of length `h` that ends at `end`.
    fn clear_of(&self, end: f64, h: f64) -> f64 {
        let at_kink = self.kinks.iter().any(|(at, _)| (at - end).abs() < 1e-12);
        if at_kink { end - CLEAR.0.min(CLEAR.1 * h) } else { end }
    }

    /// The part of the right-hand side at node `i` that comes from the inputs.
    fn forcing(&mut self, i: usize, theta: f64) -> Result<(), EvalError> {
        let (n, columns) = (self.n, self.columns);
        self.tangent.along(i, n, &self.expected, &mut self.told);
        for (k, v) in self.varied.iter_mut().enumerate() {
            let c = n + k;
            for (r, moved) in self.moved.iter_mut().enumerate() {
                *moved = self.y[i][r] + v.step * self.expected[r * columns + c];
            }
            v.pack.restore_memory(&self.memory);
            v.pack.rates(theta, &self.moved, &mut self.beside)?;
            self.work.beside += 1;
            self.tangent.directional(i, c, &self.f[i], &self.beside, v.step, &self.told);
        }
        Ok(())
    }

    /// The same for the states at the start: differences in their directions in the place of products with the Jacobian.
    fn directions(&mut self, pack: &mut Pack, i: usize, theta: f64) -> Result<(), EvalError> {
        let columns = self.columns;
        self.tangent.along(i, 0, &self.expected, &mut self.told);
        for c in 0..self.n {
            let size = (0..self.n)
                .map(|r| (self.expected[r * columns + c] / self.scale[r]).abs())
                .fold(0.0, f64::max);
            if size == 0.0 {
                continue;
            }
            let d = EPSILON / size;
            for (r, moved) in self.moved.iter_mut().enumerate() {
                *moved = self.y[i][r] + d * self.expected[r * columns + c];
            }
            pack.rates(theta, &self.moved, &mut self.beside)?;
            self.work.instants += 1;
            self.tangent.directional(i, c, &self.f[i], &self.beside, d, &self.told);
        }
        Ok(())
    }

    /// Whether an entry of the Jacobian changes much, and by what counts, between the nodes of a step of length `h`.
    fn is_bent(&self, h: f64) -> bool {
        let (n, scale) = (self.n, &self.scale);
        (0..n * n).any(|e| {
            let [a, b, c] = self.tangent.nodes().each_ref().map(|node| node.jacobian[e]);
            let change = (a - b).abs().max((b - c).abs());
            let largest = a.abs().max(b.abs()).max(c.abs());
            change > BENT.0 * largest && h * change * scale[e % n] > BENT.1 * scale[e / n]
        })
    }

    /// Across an event between the piece that ended as `last` and the state `y`.
    fn event(&mut self, pack: &mut Pack, last: &Last, y: &[f64]) -> Result<(), EvalError> {
        let (n, theta) = (self.n, last.theta);
        let (mut before, mut after) = (vec![0.0; self.rows], vec![0.0; self.rows]);
        pack.restore_memory(&last.memory);
        pack.rates(theta, &last.y, &mut before)?;
        let delay = self.delays(pack, last, &before)?;
        pack.restore_memory(&self.memory);
        pack.rates(theta, y, &mut after)?;
        // What an event sets, it sets to a value that depends on nothing.
        let mut reset = vec![0.0; n * n];
        for r in 0..n {
            reset[r * n + r] = f64::from(u8::from(last.y[r] == y[r]));
        }
        self.tangent.jump(&Jump { reset: &reset, moved: &[], before: &before, after: &after, delay: &delay });
        self.forget(pack);
        Ok(())
    }

    /// By how much later an event comes whose place was found: `-(g_y S + g_p)/(g_y f + g_t)`, each a difference of the event function; nothing for one that
    /// happens where a step ends.
    fn delays(&mut self, pack: &mut Pack, last: &Last, f: &[f64]) -> Result<Vec<f64>, EvalError> {
        let (n, columns) = (self.n, self.columns);
        let mut events = Vec::new();
        pack.events(&mut events);
        let value = |pack: &Pack, e: EventOf| pack.block(e.block).event(e.event);
        let located = |e: &&EventOf| pack.block(e.block).event_is_located(e.event);
        let nearest = events
            .iter()
            .filter(located)
            .min_by(|a, b| value(pack, **a).abs().total_cmp(&value(pack, **b).abs()));
        let Some(e) = nearest.copied().filter(|e| value(pack, *e).abs() <= AT_ZERO) else {
            return Ok(Vec::new());
        };
        let zero = value(pack, e);
        let mut moved = |pack: &mut Pack, theta: f64, d: f64, by: &dyn Fn(usize) -> f64| {
            for (r, y) in self.moved.iter_mut().enumerate() {
                *y = last.y[r] + d * by(r);
            }
            pack.evaluate(theta, &self.moved).map(|()| (value(pack, e) - zero) / d)
        };
        let size =
            |by: &dyn Fn(usize) -> f64| (0..n).map(|r| (by(r) / self.scale[r]).abs()).fold(0.0, f64::max);
        let values = self.tangent.values();
        let d = EPSILON / size(&|r| f[r]).max(1.0);
        let along = moved(pack, last.theta + d, d, &|r| f[r])?;
        let mut delay = vec![0.0; columns];
        for c in 0..n {
            let by = |r: usize| values[r * columns + c];
            let size = size(&by);
            if size > 0.0 {
                delay[c] = -moved(pack, last.theta, EPSILON / size, &by)? / along;
            }
        }
        for (k, v) in self.varied.iter_mut().enumerate() {
            v.pack.restore_memory(&last.memory);
            delay[n + k] = -moved(&mut v.pack, last.theta, v.step, &|r| values[r * columns + n + k])? / along;
        }
        self.work.instants += n as u64 + 1;
        self.work.beside += self.varied.len() as u64;
        Ok(if delay.iter().all(|d| d.is_finite()) { delay } else { Vec::new() })
    }

    /// Across kink `k`, which the inputs shift.
    fn kink(&mut self, pack: &mut Pack, k: usize, y: &[f64]) -> Result<(), EvalError> {
        let n = self.n;
        let (mut before, mut after) = (vec![0.0; self.rows], vec![0.0; self.rows]);
        let at = self.kinks[k].0;
        pack.rates(at - CLEAR.0, y, &mut before)?;
        pack.rates(at + CLEAR.0, y, &mut after)?;
        let same: Vec<f64> = (0..n * n).map(|k| f64::from(u8::from(k / n == k % n))).collect();
        let delay: Vec<f64> = std::iter::repeat_n(0.0, n).chain(self.kinks[k].1.iter().copied()).collect();
        self.tangent.jump(&Jump { reset: &same, moved: &[], before: &before, after: &after, delay: &delay });
        Ok(())
    }

    /// Keeps the piece of the step `v` from `t0` to `t1` for the results.
    fn keep(&mut self, v: &dyn StepView, (t0, t1): (f64, f64)) {
        let size = self.rows * self.columns;
        for (k, x) in LOBATTO.nodes.iter().enumerate() {
            let t = if k + 1 == LOBATTO.nodes.len() { t1 } else { t0 + x * (t1 - t0) };
            let at = self.trail.states.len();
            self.trail.states.resize(at + self.rows, 0.0);
            let (y, q) = self.trail.states[at..].split_at_mut(self.n);
            v.interpolate(t, y);
            v.interpolate_quad(t, q);
            let at = self.trail.slopes.len();
            self.trail.slopes.resize(at + size, 0.0);
            self.tangent.interpolate(*x, &mut self.trail.slopes[at..]);
        }
        self.trail.steps.push((t0, t1));
    }
}

impl Follower for Variation<'_> {
    fn begin(&mut self, pack: &mut Pack, _: f64, _: &[f64]) -> Result<(), EvalError> {
        self.forget(pack);
        Ok(())
    }

    fn step(&mut self, pack: &mut Pack, v: &dyn StepView) -> Flow {
        match self.advance(pack, v) {
            Ok(()) => Flow::Continue,
            Err(e) => {
                self.failure = Some(e);
                Flow::Stop
            }
        }
    }
}
