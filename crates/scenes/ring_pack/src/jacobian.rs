//! The Jacobian of a pack.
//!
//! A perturbation of one state is followed only as far as it reaches, which the models declare ([`StateInfo::changes`](gudgeon_core::states::StateInfo),
//! [`Stateful::reads`](gudgeon_core::states::Stateful)): a velocity touches nothing but the ring's own forces, a height touches the flows but no
//! pressure, and a film is solved again only when its ring, or a pressure at its ring, moved.

use gudgeon_core::EvalError;
use gudgeon_core::geometry::RingPlace;
use gudgeon_core::kinds::{GasOut, GasPartials};
use gudgeon_core::states::Signals;

use super::instant::RingInstant;
use super::pack::Pack;

/// What the gas depends on of a ring, beside the pressures.
const GAS_READS: Signals =
    Signals::LIFT.with(Signals::TWIST).with(Signals::FILM_THICKNESS).with(Signals::FLANK_OIL);
/// What friction and the forces of a film change.
const OF_FILM: Signals = Signals::FILM_FORCE;

/// Scratch of [`Pack::jacobian`]: the instant about which differences are taken.
#[derive(Debug, Clone, Default)]
pub struct Base {
    rings: Vec<RingInstant>,
    places: Vec<RingPlace>,
    dm: Vec<f64>,
    gas: GasOut,
    gas_partials: GasPartials,
    dy: Vec<f64>,
}

/// A state that is perturbed: its index, by how much, and what that changes of which ring.
#[derive(Debug, Clone, Copy)]
struct Moved {
    column: usize,
    d: f64,
    ring: usize,
    changes: Signals,
}

impl Pack {
    /// Jacobian of [`Pack::rates`] by differences, but for the rows and columns of the gas where its model gives them (row-major, `layout.n` columns,
    /// quadratures below the states), `self.at` holding the evaluation at `y`. `increment(k)` is the perturbation of state `k`.
    ///
    /// # Errors
    /// What a sub-model refuses.
    pub fn jacobian(
        &mut self,
        y: &[f64],
        increment: impl Fn(usize) -> f64,
        jac: &mut [f64],
        base: &mut Base,
    ) -> Result<(), EvalError> {
        let outcome = self.columns(y, increment, jac, base);
        for r in &mut self.rings {
            r.motion.end_differences();
            r.radial.end_differences();
        }
        outcome
    }

    fn columns(
        &mut self,
        y: &[f64],
        increment: impl Fn(usize) -> f64,
        jac: &mut [f64],
        base: &mut Base,
    ) -> Result<(), EvalError> {
        jac.fill(0.0);
        base.rings.clone_from(&self.at.rings);
        base.places.clone_from(&self.at.places);
        base.dm.clone_from(&self.at.dm);
        base.gas.clone_from(&self.at.gas);
        base.dy.clone_from(&self.dy);
        self.begin_differences(base)?;
        let mut trial = std::mem::take(&mut self.trial);
        trial.clear();
        trial.extend_from_slice(y);
        let outcome = self
            .gas_columns(&mut trial, &increment, jac, base)
            .and_then(|()| self.ring_columns(&mut trial, &increment, jac, base))
            .and_then(|()| self.oil_columns(&mut trial, &increment, jac, base))
            .and_then(|()| self.temperature_columns(&mut trial, &increment, jac, base));
        self.trial = trial;
        outcome
    }

    /// Tells the models that small changes from here follow.
    fn begin_differences(&mut self, base: &Base) -> Result<(), EvalError> {
        for i in 0..self.n_rings() {
            self.rings[i].motion.begin_differences();
            if self.plan.film {
                let (film, on_floor) = (self.at.rings[i].film, self.at.rings[i].limited.floor > 0.0);
                let (mut loads, radial) = self.loads(i);
                radial.begin_differences(&mut loads, &film, on_floor)?;
                self.at.rings[i] = base.rings[i];
            }
        }
        Ok(())
    }

    fn gas_columns(
        &mut self,
        y: &mut [f64],
        increment: &impl Fn(usize) -> f64,
        jac: &mut [f64],
        base: &mut Base,
    ) -> Result<(), EvalError> {
        let p_cylinder = self.at.gas.p_land[0];
        let gas = self.layout.gas.len();
        if base.gas_partials.d_state.len() != gas * gas {
            base.gas_partials = GasPartials::new(self.n_rings(), gas);
        }
        base.gas_partials.passages.resize(self.layout.passages * gas, 0.0);
        let known = self.gas_partials(p_cylinder, &mut base.gas_partials)?;
        for k in 0..gas {
            if !self.gas.is_integrated(k) {
                continue;
            }
            let d = increment(k);
            let outcome = if known {
                self.gas_column(k, base, jac);
                self.shift_pressures(k, d * self.gas_scale[k], base);
                self.followers(y, (k, d), None, base, jac)
            } else {
                let keep = self.gas_state[k];
                self.gas_state[k] = (y[k] + d) * self.gas_scale[k];
                let outcome = self.gas(Some(p_cylinder)).and_then(|()| {
                    self.gas_rows(k, d, base, jac);
                    self.followers(y, (k, d), None, base, jac)
                });
                self.gas_state[k] = keep;
                outcome
            };
            self.restore_gas(base);
            outcome?;
        }
        if !known {
            // The gas model is to know the unmoved places again.
            self.gas(Some(p_cylinder))?;
        }
        Ok(())
    }

    /// Columns of the states that belong to one ring: of its radial motion and of its motion in the groove.
    fn ring_columns(
        &mut self,
        y: &mut [f64],
        increment: &impl Fn(usize) -> f64,
        jac: &mut [f64],
        base: &Base,
    ) -> Result<(), EvalError> {
        for i in 0..self.n_rings() {
            let radial = self.layout.radial[i].clone();
            for k in radial.clone() {
                if self.rings[i].radial.is_integrated(k - radial.start) {
                    self.ring_column(y, k, i, increment(k), base, jac)?;
                }
            }
            let motion = self.layout.motion[i].clone();
            for k in motion.clone() {
                if self.rings[i].motion.is_integrated(k - motion.start) {
                    self.ring_column(y, k, i, increment(k), base, jac)?;
                }
            }
            for k in self.layout.flank[i].clone() {
                self.ring_column(y, k, i, increment(k), base, jac)?;
            }
        }
        Ok(())
    }

    fn ring_column(
        &mut self,
        y: &mut [f64],
        k: usize,
        ring: usize,
        d: f64,
        base: &Base,
        jac: &mut [f64],
    ) -> Result<(), EvalError> {
        let keep = y[k];
        y[k] = keep + d;
        self.at.places[ring] = self.place(ring, base.places[ring].liner_radius, y);
        let changes = self.layout.states[k].changes;
        let moved = Moved { column: k, d, ring, changes };
        let outcome = self.ring_moved(y, moved, base, jac);
        y[k] = keep;
        self.restore_ring(moved, base);
        outcome
    }

    /// Rows of a column whose perturbation has moved a ring.
    fn ring_moved(&mut self, y: &[f64], moved: Moved, base: &Base, jac: &mut [f64]) -> Result<(), EvalError> {
        if moved.changes.meets(GAS_READS) {
            self.gas_moved(moved.ring, self.at.gas.p_land[0])?;
            self.gas_rows(moved.column, moved.d, base, jac);
        }
        self.followers(y, (moved.column, moved.d), Some(moved), base, jac)
    }

    fn oil_columns(
        &mut self,
        y: &mut [f64],
        increment: &impl Fn(usize) -> f64,
        jac: &mut [f64],
        base: &Base,
    ) -> Result<(), EvalError> {
        let own = self.layout.oil.clone();
        for k in own.clone() {
            let Some(oil) = &mut self.oil_pack else { break };
            let (d, ring) = (increment(k), oil.ring_of(k - own.start));
            let keep = y[k];
            y[k] = keep + d;
            oil.place(&y[own.clone()], self.at.piston.y);
            let changes = self.layout.states[k].changes;
            let moved = Moved { column: k, d, ring, changes };
            let outcome = self.followers(y, (k, d), Some(moved), base, jac);
            y[k] = keep;
            if let Some(oil) = &mut self.oil_pack {
                oil.place(&y[own.clone()], self.at.piston.y);
            }
            self.restore_ring(moved, base);
            outcome?;
        }
        Ok(())
    }

    fn temperature_columns(
        &mut self,
        y: &mut [f64],
        increment: &impl Fn(usize) -> f64,
        jac: &mut [f64],
        base: &Base,
    ) -> Result<(), EvalError> {
        let own = self.layout.temperature.clone();
        for k in own.clone() {
            let (d, ring) = (increment(k), self.film_temperature.ring_of(k - own.start));
            let keep = y[k];
            y[k] = keep + d;
            self.at.rings[ring].mu = self.viscosity(ring, self.at.piston.y, y);
            let changes = self.layout.states[k].changes;
            let moved = Moved { column: k, d, ring, changes };
            let outcome = self.followers(y, (k, d), Some(moved), base, jac);
            y[k] = keep;
            self.restore_ring(moved, base);
            outcome?;
        }
        Ok(())
    }

    /// Rows of film, oil, temperature, motion and friction of a column whose perturbation is in place and whose gas is evaluated.
    fn followers(
        &mut self,
        y: &[f64],
        (column, d): (usize, f64),
        moved: Option<Moved>,
        base: &Base,
        jac: &mut [f64],
    ) -> Result<(), EvalError> {
        for i in 0..self.n_rings() {
            let (a, b) = (&self.at.rings[i], &base.rings[i]);
            let same = (a.p_above, a.p_below, a.p_back) == (b.p_above, b.p_below, b.p_back);
            let own = moved.filter(|m| m.ring == i);
            let mut reach = own.map_or(Signals::NONE, |m| m.changes);
            if !same {
                reach |= Signals::PRESSURE;
            }
            if self.plan.film && reach.meets(self.layout.film_reads[i]) {
                self.film_of_ring(i, y)?;
                self.film_rows(i, column, d, base, jac);
                reach |= OF_FILM;
            }
            if reach.meets(self.layout.motion_reads[i]) {
                self.in_groove(i, y)?;
                self.groove_rows(i, column, d, base, jac);
            }
        }
        Ok(())
    }

    fn film_rows(&self, i: usize, column: usize, d: f64, base: &Base, jac: &mut [f64]) {
        let (n, rings) = (self.layout.n, self.n_rings());
        self.block_rows(self.layout.radial[i].clone(), column, d, base, jac);
        let (per, now, then) = (1.0 / (self.omega * d), &self.at.rings[i], &base.rings[i]);
        jac[(n + rings + 1 + i) * n + column] = (now.power - then.power) * per;
        jac[(n + 2 * rings + 1 + i) * n + column] = (now.boundary_power - then.boundary_power) * per;
        self.block_rows(self.layout.oil.clone(), column, d, base, jac);
        self.block_rows(self.layout.temperature.clone(), column, d, base, jac);
    }

    fn groove_rows(&self, i: usize, column: usize, d: f64, base: &Base, jac: &mut [f64]) {
        self.block_rows(self.layout.motion[i].clone(), column, d, base, jac);
        self.block_rows(self.layout.flank[i].clone(), column, d, base, jac);
        if let Some(k) = self.layout.flank_quad(i) {
            let (n, now, then) = (self.layout.n, self.at.rings[i].flank, base.rings[i].flank);
            let per = 1.0 / (self.omega * d);
            jac[(n + k) * n + column] = (now.fed - then.fed) * per;
            jac[(n + k + 1) * n + column] = (now.lost - then.lost) * per;
        }
    }

    /// Rows of the states of a model.
    fn block_rows(&self, own: std::ops::Range<usize>, column: usize, d: f64, base: &Base, jac: &mut [f64]) {
        for r in own {
            jac[r * self.layout.n + column] = (self.dy[r] - base.dy[r]) / d;
        }
    }

    /// Takes back a perturbation of the gas.
    fn restore_gas(&mut self, base: &Base) {
        self.at.rings.clone_from(&base.rings);
        self.at.dm.clone_from(&base.dm);
        self.at.gas.clone_from(&base.gas);
        self.dy.clone_from(&base.dy);
    }

    /// Takes back a perturbation of a ring, whose own states or those of its oil or film have moved.
    fn restore_ring(&mut self, moved: Moved, base: &Base) {
        self.at.places[moved.ring] = base.places[moved.ring];
        if moved.changes.meets(GAS_READS) {
            return self.restore_gas(base);
        }
        self.at.rings[moved.ring] = base.rings[moved.ring];
        self.dy.clone_from(&base.dy);
    }

    /// Rows of the gas in the column of mass `k`, from the derivatives in `base`.
    fn gas_column(&self, k: usize, base: &Base, jac: &mut [f64]) {
        let (n, rings, m, s) = (self.layout.n, self.n_rings(), self.layout.gas.len(), &base.gas_partials);
        let per = self.gas_scale[k] / self.omega;
        for r in 0..m {
            jac[r * n + k] = s.d_state[r * m + k] / self.gas_scale[r] * per;
        }
        for r in 0..rings {
            jac[(n + r) * n + k] = s.flow_in[r * m + k] * per;
        }
        jac[(n + rings) * n + k] = s.flow_out[(rings - 1) * m + k] * per;
        let first = n + self.layout.passage_quad();
        for p in 0..self.layout.passages {
            jac[(first + p) * n + k] = s.passages[p * m + k] * per;
        }
    }

    fn gas_rows(&self, column: usize, d: f64, base: &Base, jac: &mut [f64]) {
        let (n, rings) = (self.layout.n, self.n_rings());
        let per = 1.0 / (self.omega * d);
        for r in self.layout.gas.clone() {
            jac[r * n + column] = (self.at.dm[r] - base.dm[r]) / self.gas_scale[r] * per;
        }
        for r in 0..rings {
            jac[(n + r) * n + column] = (self.at.gas.flow_in[r] - base.gas.flow_in[r]) * per;
        }
        jac[(n + rings) * n + column] =
            (self.at.gas.flow_out[rings - 1] - base.gas.flow_out[rings - 1]) * per;
        if let Some(k) = self.layout.gas_quad() {
            jac[(n + k) * n + column] = (self.at.gas.power - base.gas.power) * per;
        }
        let first = n + self.layout.passage_quad();
        for (p, (now, then)) in self.at.gas.passages.iter().zip(&base.gas.passages).enumerate() {
            jac[(first + p) * n + column] = (now - then) * per;
        }
    }

    /// Pressures after a small change of mass `k` \[kg\] from `base`.
    fn shift_pressures(&mut self, k: usize, d_mass: f64, base: &Base) {
        let (m, s) = (self.layout.gas.len(), &base.gas_partials);
        for (i, p) in self.at.gas.p_land.iter_mut().enumerate() {
            *p = base.gas.p_land[i] + s.p_land[i * m + k] * d_mass;
        }
        for (i, p) in self.at.gas.p_back.iter_mut().enumerate() {
            *p = base.gas.p_back[i] + s.p_back[i * m + k] * d_mass;
        }
        self.share_pressures();
    }
}
