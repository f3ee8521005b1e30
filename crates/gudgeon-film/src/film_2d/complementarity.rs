//! Cavitation as a complementarity problem, on top of any solver of linear systems.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::{Film2d, Film2dGrid, Film2dIn, Film2dOut, FilmMode, Superposition};
use gudgeon_numerics::linalg::Singular;
use gudgeon_numerics::multigrid::FivePoint;
use gudgeon_numerics::vectors::all_finite;

use super::cavitation::Cavitation;
use super::checks::check_modes;
use super::problem::{Problem, cause_of, is_plain, void_of};

/// Solves linear systems with a [`FivePoint`] matrix.
pub(super) trait Linear: Send {
    /// Prepares for a matrix, which is symmetric and positive definite when `symmetric`.
    fn factor(&mut self, m: &FivePoint, symmetric: bool) -> Result<(), Singular>;
    /// Improves `z` until no residual is larger than `target` where that is possible. Returns the work done and the largest residual.
    fn solve(&mut self, m: &FivePoint, b: &[f64], z: &mut [f64], target: f64) -> (usize, f64);
    /// Whether what diffused unknowns lose on the spot counts.
    fn takes_leaks(&self) -> bool {
        false
    }
    /// Solves for several right-hand sides at once, in place, to rounding. Whether this is how the solver works.
    fn solve_block(&mut self, _m: &FivePoint, _b: &mut [f64]) -> bool {
        false
    }
}

/// Most changes of the set of cavitated nodes.
const MAX_STEPS: usize = 100;

/// A film found by Newton's method on the complementarity of pressure and void.
///
/// Both are non-negative and one of them is zero: `min(p, 1 - θ) = 0` at every node, together with the balance of its volume. Newton's
/// method on that says of each node whether it is full (its pressure is unknown) or cavitated (its void is unknown), solves the linear
/// system of that choice, and chooses anew by the signs of what it found (Hintermüller, Ito and Kunisch 2003). It ends when no node
/// changes. The function of Fischer and Burmeister in place of the minimum (Woloszynski et al. 2015) comes to the same film in about as many steps, but
/// mixes pressure and void at a node, which the multigrid could not tell apart.
pub(super) struct Solver<L> {
    model: &'static str,
    problem: Problem,
    linear: L,
    cavitation: Cavitation,
    tolerance: f64,
    /// Pressure above `p_cav`, and `1 - θ`.
    p: Vec<f64>,
    void: Vec<f64>,
    cavitated: Vec<bool>,
    b: Vec<f64>,
    z: Vec<f64>,
    /// What is shown: absolute pressure and filling.
    pressure: Vec<f64>,
    fill: Vec<f64>,
    /// Whether `p`, `void` and `cavitated` hold a film.
    warm: bool,
    /// Whether that film follows from a squeeze velocity.
    by_rate: bool,
    /// Whether the matrix is that of a full film without cavitation, as `solve_many` leaves it.
    set_up: bool,
    /// A film beside that one, once it is asked for.
    beside: Option<Problem>,
}

impl<L: Linear> Solver<L> {
    pub fn new(
        model: &'static str,
        problem: Problem,
        linear: L,
        cavitation: Cavitation,
        tolerance: f64,
    ) -> Self {
        let n = problem.len();
        Self {
            model,
            problem,
            linear,
            cavitation,
            tolerance,
            p: vec![0.0; n],
            void: vec![0.0; n],
            cavitated: vec![false; n],
            b: vec![0.0; n],
            z: vec![0.0; n],
            pressure: vec![0.0; n],
            fill: vec![1.0; n],
            warm: false,
            by_rate: false,
            set_up: false,
            beside: None,
        }
    }

    fn singular(&self, s: Singular) -> EvalError {
        EvalError::recoverable(self.model, format!("the film is undetermined at node {}", s.column))
    }

    /// Residual to aim at: the tolerance times the largest flow of the present film, or what rounding leaves.
    fn target(&self) -> f64 {
        let (flow, rounding) = self.problem.largest_flow(&self.p, &self.void);
        rounding.max(self.tolerance * flow)
    }

    /// One correction of the unknowns of the present matrix by the balances in `b`. Returns the largest residual that is left.
    fn correct(&mut self, target: f64, cycles: &mut usize) -> f64 {
        for b in &mut self.b {
            *b = -*b;
        }
        self.z.fill(0.0);
        let (work, left) = self.linear.solve(&self.problem.m, &self.b, &mut self.z, target);
        *cycles += work;
        for k in 0..self.z.len() {
            if self.problem.edge[k] < 4 {
                continue;
            }
            if self.cavitated[k] {
                self.void[k] += self.z[k];
            } else {
                self.p[k] += self.z[k];
            }
        }
        left
    }

    /// The film without cavitation. Returns the work done.
    fn full(&mut self) -> Result<usize, EvalError> {
        self.cavitated.fill(false);
        self.problem.choose(&self.cavitated, false);
        self.linear.factor(&self.problem.m, true).map_err(|s| self.singular(s))?;
        let mut cycles = 0;
        self.settle(&mut cycles)?;
        Ok(cycles)
    }

    /// Solves the present linear system. Returns the residual that is allowed for.
    fn settle(&mut self, cycles: &mut usize) -> Result<f64, EvalError> {
        let mut target = self.target();
        for _ in 0..5 {
            self.problem.balance(&self.p, &self.void, &mut self.b);
            let left = self.correct(target, cycles);
            // Judged by the flows of the film it led to.
            target = self.target();
            if left <= target {
                return Ok(target);
            }
        }
        Err(self.slow(*cycles))
    }

    /// Whether a line of a ring is cavitated all round: what is in it never leaves.
    fn closed(&self) -> bool {
        self.problem.periodic && self.cavitated.chunks(self.problem.nx).any(|line| line.iter().all(|c| *c))
    }

    fn slow(&self, cycles: usize) -> EvalError {
        if self.closed() {
            let what = "a cavity that closes on itself may hold any amount of oil: there is no steady film";
            return EvalError::recoverable(self.model, what);
        }
        EvalError::recoverable(
            self.model,
            format!("no convergence of the linear system after {cycles} cycles"),
        )
    }

    /// Rupture without conservation: nodes are full, or at `p_cav` and none of the problem's business.
    fn swift_stieber(&mut self) -> Result<(usize, usize), EvalError> {
        let mut cycles = 0;
        // A film that grows again after the first cut does so by one line of nodes a step.
        let limit = MAX_STEPS + self.problem.nx + self.problem.ny;
        for iteration in 1..=limit {
            for k in 0..self.p.len() {
                if self.cavitated[k] {
                    self.p[k] = 0.0;
                }
            }
            self.problem.choose(&self.cavitated, false);
            self.linear.factor(&self.problem.m, true).map_err(|s| self.singular(s))?;
            let target = self.settle(&mut cycles)?;
            self.problem.balance(&self.p, &self.void, &mut self.b);
            let top = self.p.iter().fold(0.0_f64, |a, &b| a.max(b));
            let mut changed = 0;
            for k in 0..self.p.len() {
                if self.problem.edge[k] < 4 {
                    continue;
                }
                // A node at p_cav that would send more oil away than it gets must take pressure.
                let change =
                    if self.cavitated[k] { self.b[k] < -2.0 * target } else { self.p[k] < -1e-12 * top };
                if change {
                    self.cavitated[k] = !self.cavitated[k];
                    changed += 1;
                }
            }
            if changed == 0 {
                return Ok((iteration, cycles));
            }
        }
        Err(self.restless(limit, cycles))
    }

    fn restless(&self, steps: usize, cycles: usize) -> EvalError {
        EvalError::recoverable(
            self.model,
            format!("the cavity still changes after {steps} steps and {cycles} cycles"),
        )
    }

    fn mass_conserving(&mut self) -> Result<(usize, usize), EvalError> {
        let mut cycles = 0;
        for iteration in 1..=MAX_STEPS {
            let mut any = false;
            for k in 0..self.p.len() {
                if self.problem.edge[k] < 4 {
                    continue;
                }
                if self.cavitated[k] {
                    self.p[k] = 0.0;
                    any = true;
                } else {
                    self.void[k] = 0.0;
                }
            }
            self.problem.choose(&self.cavitated, true);
            self.linear.factor(&self.problem.m, !any).map_err(|s| self.singular(s))?;
            // A few digits at a time: a set that changes again needs no more.
            let mut stalled = 0;
            let mut target = self.target();
            let changed = loop {
                self.problem.balance(&self.p, &self.void, &mut self.b);
                let now = self.b.iter().zip(&self.problem.edge).filter(|(_, e)| **e == 4);
                let now = now.fold(0.0_f64, |a, (b, _)| a.max(b.abs()));
                let aim = target.max(LOOSE * now);
                let left = self.correct(aim, &mut cycles);
                target = self.target();
                let top = self.p.iter().fold(0.0_f64, |a, &b| a.max(b));
                let inner = (0..self.p.len()).filter(|&k| self.problem.edge[k] == 4);
                let changed = inner.filter(|&k| self.wrong(k, top)).count();
                if left <= target || (changed > 0 && left <= aim) {
                    break changed;
                }
                if left > aim {
                    stalled += 1;
                    if stalled > 2 {
                        return Err(self.slow(cycles));
                    }
                }
            };
            if changed == 0 {
                // More void than room is no film, however well the equations hold.
                let fullest = self.void.iter().fold(0.0_f64, |a, &b| a.max(b));
                return if fullest <= 1.0 + 1e-6 { Ok((iteration, cycles)) } else { Err(self.slow(cycles)) };
            }
            let top = self.p.iter().fold(0.0_f64, |a, &b| a.max(b));
            for k in 0..self.p.len() {
                if self.problem.edge[k] == 4 && self.wrong(k, top) {
                    self.cavitated[k] = !self.cavitated[k];
                }
            }
        }
        Err(self.restless(MAX_STEPS, cycles))
    }

    /// Whether a node has a negative pressure or a negative void, beyond what rounding does.
    fn wrong(&self, k: usize, top: f64) -> bool {
        if self.cavitated[k] { self.void[k] < -1e-12 } else { self.p[k] < -1e-12 * top }
    }

    fn find(&mut self, inp: &Film2dIn<'_>) -> Result<Film2dOut, EvalError> {
        let n = self.p.len();
        if !self.warm {
            self.p.fill(0.0);
            self.cavitated.fill(false);
            self.void.fill(0.0);
        }
        let cavitates = self.cavitation != Cavitation::FullSommerfeld;
        let conserves = self.cavitation == Cavitation::MassConserving;
        if !conserves {
            self.void.fill(0.0);
        }
        self.problem.set_edges(inp, cavitates, &mut self.p, &mut self.void);
        if !conserves {
            self.void.fill(0.0);
        }
        self.problem.fill_inlet(inp, &mut self.void);
        let (iterations, cycles) = match self.cavitation {
            Cavitation::MassConserving => self.mass_conserving()?,
            Cavitation::SwiftStieber => self.swift_stieber()?,
            Cavitation::HalfSommerfeld | Cavitation::FullSommerfeld => (1, self.full()?),
        };
        // For a full film that is cut off, the next search starts from what was not.
        for k in 0..n {
            self.z[k] = if cavitates { self.p[k].max(0.0) } else { self.p[k] };
        }
        if conserves {
            self.problem.fill_sides(inp, &self.z, &mut self.void);
            self.problem.fill_outlet(inp, &self.z, &mut self.void);
        }
        for k in 0..n {
            let p = self.z[k];
            self.void[k] = self.void[k].clamp(0.0, 1.0);
            self.pressure[k] = inp.p_cav + p;
            self.fill[k] = 1.0 - self.void[k];
        }
        let mut out = self.problem.result(inp, &self.z, &self.void, self.cavitation, &mut self.b);
        (out.iterations, out.cycles) = (iterations, cycles);
        if !(out.load.is_finite() && out.shear_lower.is_finite()) {
            return Err(EvalError::recoverable(self.model, "the film overflows"));
        }
        Ok(out)
    }
}

/// Part of the residual that a step leaves while the set of cavitated nodes still changes.
const LOOSE: f64 = 2e-2;

impl<L: Linear> Film2d for Solver<L> {
    fn grid(&self) -> &Film2dGrid {
        &self.problem.grid
    }

    fn solve(&mut self, inp: &Film2dIn<'_>) -> Result<Film2dOut, EvalError> {
        if inp.history.is_some() && self.cavitation != Cavitation::MassConserving {
            return Err(EvalError::fatal(self.model, "only the mass-conserving condition has a history"));
        }
        self.set_up = false;
        self.problem.assemble(self.model, inp)?;
        self.problem.drive(inp, inp.u, inp.dhdt, self.cavitation == Cavitation::MassConserving);
        let mut found = self.find(inp);
        if found.is_err() && self.warm {
            self.warm = false;
            found = self.find(inp);
        }
        self.warm = found.is_ok();
        self.by_rate = inp.history.is_none();
        found
    }

    fn pressure(&self) -> &[f64] {
        &self.pressure
    }

    fn fill(&self) -> &[f64] {
        &self.fill
    }

    fn solve_many(
        &mut self,
        inp: &Film2dIn<'_>,
        modes: &[FilmMode<'_>],
        p: &mut [f64],
    ) -> Result<usize, EvalError> {
        let n = self.p.len();
        check_modes(self.model, n, modes, p.len())?;
        (self.warm, self.set_up) = (false, false);
        self.problem.assemble(self.model, inp)?;
        match inp.unfilled {
            Some(u) => self.cavitated.iter_mut().zip(u.engaged).for_each(|(torn, s)| *torn = *s <= 0.0),
            None => self.cavitated.fill(false),
        }
        self.problem.choose(&self.cavitated, false);
        self.linear.factor(&self.problem.m, true).map_err(|s| self.singular(s))?;
        self.set_up = true;
        for (mode, out) in modes.iter().zip(p.chunks_exact_mut(n)) {
            if is_plain(inp, mode) {
                self.problem.plain_cause(inp, mode, out);
                continue;
            }
            self.problem.cause(inp, mode, &mut self.p, &mut self.void);
            self.problem.balance(&self.p, &self.void, out);
            out.iter_mut().for_each(|b| *b = -*b);
        }
        if self.linear.solve_block(&self.problem.m, p) {
            for (mode, out) in modes.iter().zip(p.chunks_exact_mut(n)) {
                if !is_plain(inp, mode) {
                    self.problem.set_edges(&cause_of(inp, mode), false, out, &mut self.void);
                }
                if !all_finite(out) {
                    return Err(EvalError::recoverable(self.model, "the film overflows"));
                }
            }
            return Ok(modes.len());
        }
        let mut cycles = 0;
        for (mode, out) in modes.iter().zip(p.chunks_exact_mut(n)) {
            self.problem.cause(inp, mode, &mut self.p, &mut self.void);
            self.settle(&mut cycles)?;
            out.copy_from_slice(&self.p);
        }
        Ok(cycles)
    }

    fn imbalance(
        &mut self,
        inp: &Film2dIn<'_>,
        mode: &FilmMode<'_>,
        p: &[f64],
        r: &mut [f64],
    ) -> Result<bool, EvalError> {
        let n = self.p.len();
        check_modes(self.model, n, &[*mode], p.len())?;
        check_modes(self.model, n, &[*mode], r.len())?;
        let beside = self.beside.get_or_insert_with(|| self.problem.clone());
        beside.assemble(self.model, inp)?;
        if is_plain(inp, mode) {
            beside.plain_imbalance(inp, mode, p, r);
        } else {
            beside.drive(&cause_of(inp, mode), mode.u, mode.dhdt, false);
            void_of(inp, &mut self.void);
            beside.balance(p, &self.void, r);
            r.iter_mut().for_each(|b| *b = -*b);
        }
        self.warm = false;
        Ok(true)
    }

    fn imbalance_here(
        &mut self,
        inp: &Film2dIn<'_>,
        mode: &FilmMode<'_>,
        p: &[f64],
        r: &mut [f64],
    ) -> Result<bool, EvalError> {
        if !(self.set_up && is_plain(inp, mode)) {
            return self.imbalance(inp, mode, p, r);
        }
        let n = self.p.len();
        check_modes(self.model, n, &[*mode], p.len())?;
        check_modes(self.model, n, &[*mode], r.len())?;
        self.problem.plain_imbalance(inp, mode, p, r);
        Ok(true)
    }

    fn respond(&mut self, r: &mut [f64]) -> Result<(), EvalError> {
        let n = self.p.len();
        if !self.set_up {
            return Err(EvalError::recoverable(self.model, "no full film is set up"));
        }
        if !r.len().is_multiple_of(n) {
            let what = format!("{} values are no fields over {n} nodes", r.len());
            return Err(EvalError::fatal(self.model, what));
        }
        if self.linear.solve_block(&self.problem.m, r) {
            return Ok(());
        }
        for r in r.chunks_exact_mut(n) {
            let largest = r.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
            self.b.copy_from_slice(r);
            self.z.fill(0.0);
            let (_, left) =
                self.linear.solve(&self.problem.m, &self.b, &mut self.z, self.tolerance * largest);
            // Rounding may end the cycles a little short of a strict tolerance.
            if left.is_nan() || left > 1e-6 * largest {
                return Err(EvalError::recoverable(self.model, "no convergence of the linear system"));
            }
            r.copy_from_slice(&self.z);
        }
        Ok(())
    }

    fn answer(&mut self, p: &mut [f64], fill: &mut [f64]) -> Result<bool, EvalError> {
        let n = self.p.len();
        if !(p.len().is_multiple_of(n) && p.len() == fill.len()) {
            let what = format!("{} and {} values are no fields over {n} nodes", p.len(), fill.len());
            return Err(EvalError::fatal(self.model, what));
        }
        if !(self.warm && self.by_rate) {
            return Ok(false);
        }
        for (p, fill) in p.chunks_exact_mut(n).zip(fill.chunks_exact_mut(n)) {
            for k in 0..n {
                // What the balance of the node leaves over for a rate of one.
                let taken = if self.problem.m.hold[k] > 0.0 { 1.0 - self.void[k] } else { 1.0 };
                let flow = self.problem.area(k) * taken;
                self.b[k] = if self.problem.edge[k] == 4 { -flow * p[k] } else { 0.0 };
            }
            let largest = self.b.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
            self.z.fill(0.0);
            let (_, left) =
                self.linear.solve(&self.problem.m, &self.b, &mut self.z, self.tolerance * largest);
            if left.is_nan() || left > 1e-6 * largest {
                return Err(EvalError::recoverable(self.model, "no convergence of the linear system"));
            }
            for k in 0..n {
                let cut = self.problem.edge[k] < 4
                    || self.cavitation == Cavitation::HalfSommerfeld && self.p[k] < 0.0;
                (p[k], fill[k]) = match (cut, self.cavitated[k]) {
                    (true, _) => (0.0, 0.0),
                    (false, true) => (0.0, -self.z[k]),
                    (false, false) => (self.z[k], 0.0),
                };
            }
        }
        Ok(true)
    }

    fn keeps_fill(&self) -> bool {
        self.cavitation == Cavitation::MassConserving && self.linear.takes_leaks()
    }

    fn superposition(&self) -> Superposition {
        self.cavitation.superposition()
    }

    fn reset(&mut self) {
        self.warm = false;
    }
}
