//! The forces on a piston between both sides of its skirt.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::{AddedForces, GrooveFriction, PinFriction};
use gudgeon_numerics::elementary;

use super::follow_work::FollowWork;
use super::linear::Linear;
use super::stage::StageWork;
use super::summary::Summary;
use crate::body::{Body, Crank, Instant};
use crate::side::{Side, SideLoads, Slopes};

/// Piston with both sides of its skirt. Coordinates: displacements of the upper and the lower edge towards the anti-thrust side, then
/// the elastic amplitudes of the thrust side, then those of the other.
pub struct Piston {
    /// Thrust side, anti-thrust side.
    pub sides: [Side; 2],
    /// Masses.
    pub body: Body,
    /// Crank drive.
    pub crank: Crank,
    pub(super) pin: Box<dyn PinFriction>,
    pub(super) groove: Box<dyn GrooveFriction>,
    pub(super) loads: [SideLoads; 2],
    pub(super) trial: [SideLoads; 2],
    pub(super) n: usize,
    pub(super) r: Vec<f64>,
    pub(super) best: Vec<f64>,
    pub(super) slope: Vec<f64>,
    pub(super) lu: Vec<f64>,
    pub(super) piv: Vec<usize>,
    pub(super) step: Vec<f64>,
    pub(super) own_rates: [Vec<f64>; 2],
    /// Coordinates beside the present place, their moves, and the loads there.
    pub(super) moved: Vec<f64>,
    pub(super) moves: Vec<f64>,
    pub(super) own_moves: [Vec<f64>; 2],
    pub(super) beside: [Vec<SideLoads>; 2],
    pub(super) work: Linear,
    pub(super) follow: FollowWork,
    pub(super) stage: StageWork,
    /// Forces on both edges that the balance leaves for a given acceleration \[N\].
    pub(super) inertia: [f64; 2],
    /// Forces that the lateral motion adds, when it adds any.
    pub(super) added: Option<AddedForces>,
    /// Newton steps of balances so far.
    pub newton_steps: u64,
}

impl Piston {
    /// Puts the parts together.
    #[must_use]
    pub fn new(
        sides: [Side; 2],
        body: Body,
        crank: Crank,
        pin: Box<dyn PinFriction>,
        groove: Box<dyn GrooveFriction>,
    ) -> Self {
        let n = 2 + sides[0].elastic() + sides[1].elastic();
        let own_rates = [vec![0.0; 2 + sides[0].elastic()], vec![0.0; 2 + sides[1].elastic()]];
        let v = |n: usize| vec![0.0; n];
        let beside = [0, 1].map(|s: usize| vec![SideLoads::default(); own_rates[s].len()]);
        Self {
            sides,
            body,
            crank,
            pin,
            groove,
            loads: Default::default(),
            trial: Default::default(),
            n,
            r: v(n),
            best: v(n),
            slope: v(n * n),
            lu: v(n * n),
            piv: vec![0; n],
            step: v(n),
            moved: v(n),
            moves: v(n),
            own_moves: own_rates.clone(),
            own_rates,
            beside,
            work: Linear::new(n),
            follow: FollowWork::new(n),
            stage: StageWork::new(n),
            inertia: [0.0; 2],
            added: None,
            newton_steps: 0,
        }
    }

    /// Number of coordinates.
    #[must_use]
    pub fn coordinates(&self) -> usize {
        self.n
    }

    /// Whether friction of the pin turns the piston.
    #[must_use]
    pub fn has_pin_friction(&self) -> bool {
        !self.pin.is_off()
    }

    /// Whether friction of the rings in their grooves hinders the motion across the bore.
    #[must_use]
    pub fn has_groove_friction(&self) -> bool {
        !self.groove.is_off()
    }

    /// Where the elastic amplitudes of a side stand among the coordinates.
    pub(super) fn own(&self, side: usize) -> std::ops::Range<usize> {
        let first = 2 + self.sides[0].elastic();
        if side == 0 { 2..first } else { first..self.n }
    }

    /// Smallest gap on either side of the place set last \[m\].
    #[must_use]
    pub fn smallest_gap(&self) -> f64 {
        self.sides[0].smallest_gap().min(self.sides[1].smallest_gap())
    }

    /// Linear systems of films set up so far.
    #[must_use]
    pub fn film_evaluations(&self) -> u64 {
        self.sides[0].evaluations + self.sides[1].evaluations
    }

    /// Goes to the coordinates `x`.
    ///
    /// # Errors
    /// A film that cannot be solved there.
    pub fn place(&mut self, now: &Instant, x: &[f64]) -> Result<(), EvalError> {
        for side in 0..2 {
            let own = self.own(side);
            self.sides[side].place([x[0], x[1]], &x[own], now.speed)?;
        }
        Ok(())
    }

    /// The same for the rates `w` alone.
    ///
    /// # Errors
    /// A film that cannot be solved there.
    pub(super) fn place_moving(&mut self, now: &Instant, x: &[f64], w: &[f64]) -> Result<(), EvalError> {
        for side in 0..2 {
            let own = self.own(side);
            let rates = &mut self.own_rates[side];
            rates[..2].copy_from_slice(&w[..2]);
            rates[2..].copy_from_slice(&w[own.clone()]);
            self.sides[side].place_moving([x[0], x[1]], &x[own], now.speed, rates)?;
        }
        Ok(())
    }

    /// Forces left over at the present place `x` and the rates `w`, into `r`: on both edges \[N\] and on the elastic shapes \[N\]. With their
    /// derivatives, row after row, into `slope`.
    pub(super) fn residual(
        &mut self,
        now: &Instant,
        x: &[f64],
        w: &[f64],
        slopes: Slopes,
    ) -> Result<(), EvalError> {
        for side in 0..2 {
            let own = self.own(side);
            let rates = &mut self.own_rates[side];
            rates[..2].copy_from_slice(&w[..2]);
            rates[2..].copy_from_slice(&w[own]);
            self.sides[side].loads(now.speed, now.mu, rates, slopes, &mut self.loads[side])?;
        }
        let mut r = std::mem::take(&mut self.r);
        self.left_over(now, x, w, false, &mut r);
        self.r = r;
        if slopes != Slopes::None {
            self.slopes(now, x, w);
        }
        Ok(())
    }

    /// Derivatives of the forces that [`Piston::residual`] found at the same arguments.
    pub(super) fn tangent(
        &mut self,
        now: &Instant,
        x: &[f64],
        w: &[f64],
        slopes: Slopes,
    ) -> Result<(), EvalError> {
        for side in 0..2 {
            let (rates, loads) = (&self.own_rates[side], &mut self.loads[side]);
            self.sides[side].slopes(now.speed, now.mu, rates, slopes, loads)?;
        }
        self.slopes(now, x, w);
        Ok(())
    }

    /// Forces of both sides and of all else, into `r`.
    pub(super) fn left_over(&self, now: &Instant, x: &[f64], w: &[f64], trial: bool, r: &mut [f64]) {
        let loads = if trial { &self.trial } else { &self.loads };
        let (force, moment) = self.others(now, w, loads, None);
        let edges = self.body.on_edges(force, moment);
        for k in 0..2 {
            r[k] = edges[k] + loads.iter().map(|l| l.film[k] + l.contact[k]).sum::<f64>() - self.inertia[k];
        }
        for side in 0..2 {
            for (m, k) in self.own(side).enumerate() {
                r[k] = loads[side].elastic[m] - self.sides[side].compliance.resistance(m, x[k], w[k]);
            }
        }
        if let Some(added) = &self.added {
            for k in 0..2 {
                let [top, bottom] = added.damping[k];
                r[k] += added.constant[k] - (top * w[0] + bottom * w[1]);
            }
        }
    }

    /// Adds the forces of a lateral motion to those of the piston, in place of those added before.
    pub fn add(&mut self, added: AddedForces) {
        self.added = (added != AddedForces::default()).then_some(added);
    }

    /// Lateral force and moment about the pin of everything but pressures on the skirt.
    fn others(
        &self,
        now: &Instant,
        w: &[f64],
        loads: &[SideLoads; 2],
        summary: Option<&mut Summary>,
    ) -> (f64, f64) {
        let (mut friction, mut moment) = (0.0, 0.0);
        let mut told = Summary::default();
        for (i, (side, l)) in self.sides.iter().zip(loads).enumerate() {
            let rubbing = side.rubbing(now.speed, &l.contact);
            let moment_of = |force: f64, arm: f64| -side.sign * arm + self.crank.pin_offset * force;
            let own = moment_of(l.film[2], l.film[3]);
            friction += l.film[2] + rubbing[0];
            moment += own + moment_of(rubbing[0], rubbing[1]);
            told.film_friction[i] = l.film[2];
            told.film_friction_moment[i] = own;
            told.contact_friction[i] = rubbing[0];
        }
        let rod = self.body.rod_lateral(now, friction);
        let mut force = rod;
        moment += self.body.drive_moment(now, self.crank.pin_offset);
        told.rod = rod;
        if !self.pin.is_off() {
            let load = elementary::hypot(self.body.rod_axial(now, friction), rod);
            told.pin_moment = self.pin.moment(load, now.rod_rotation);
            moment += told.pin_moment;
        }
        if !self.groove.is_off() {
            let (ring, _) = self.groove_force(now, w);
            force += ring;
            moment += (self.body.pin + self.groove.height()) * ring;
            told.groove = ring;
        }
        if let Some(s) = summary {
            *s = told;
        }
        (force, moment)
    }

    fn groove_force(&self, now: &Instant, w: &[f64]) -> (f64, f64) {
        let part = -self.groove.height() / self.body.length;
        self.groove.force(now.pressure, w[0] + (w[1] - w[0]) * part)
    }

    /// Derivatives of the forces left over with respect to the rates.
    fn slopes(&mut self, now: &Instant, x: &[f64], w: &[f64]) {
        let n = self.n;
        self.slope.fill(0.0);
        for side in 0..2 {
            let elastic = self.sides[side].elastic();
            let own = self.own(side);
            for m in 0..2 + elastic {
                let column = if m < 2 { m } else { own.start + m - 2 };
                let s = &self.loads[side].slope[m * (4 + elastic)..(m + 1) * (4 + elastic)];
                let moment = -self.sides[side].sign * s[3] + self.crank.pin_offset * s[2];
                let edges = self.body.on_edges(-now.tangent * s[2], moment);
                for k in 0..2 {
                    self.slope[k * n + column] += s[k] + edges[k];
                }
                for k in 0..elastic {
                    self.slope[(own.start + k) * n + column] += s[4 + k];
                }
                if m >= 2 {
                    let compliance = &self.sides[side].compliance;
                    self.slope[column * n + column] -=
                        compliance.resistance_by_rate(m - 2, x[column], w[column]);
                }
            }
        }
        if !self.groove.is_off() {
            let (_, slope) = self.groove_force(now, w);
            let part = -self.groove.height() / self.body.length;
            let edges = self.body.on_edges(slope, (self.body.pin + self.groove.height()) * slope);
            for k in 0..2 {
                self.slope[k * n] += edges[k] * (1.0 - part);
                self.slope[k * n + 1] += edges[k] * part;
            }
        }
        if let Some(added) = &self.added {
            for (k, row) in added.damping.iter().enumerate() {
                self.slope[k * n] -= row[0];
                self.slope[k * n + 1] -= row[1];
            }
        }
    }

    /// What counts as one when forces are compared.
    pub(super) fn force_scale(&self, now: &Instant) -> f64 {
        let films: f64 = self.loads.iter().map(|l| l.film[0].abs() + l.film[1].abs()).sum();
        let inertia = (self.body.mass() * now.acceleration * now.tangent).abs();
        1e-3 + films + inertia + (now.gas * now.tangent).abs()
    }

    /// Smallest gap on each side \[m\] at the coordinates `x`; the present place stays.
    ///
    /// # Errors
    /// A gap that is none.
    pub fn gaps(&mut self, x: &[f64], speed: f64) -> Result<[f64; 2], EvalError> {
        let mut gaps = [0.0; 2];
        for (side, gap) in gaps.iter_mut().enumerate() {
            let own = self.own(side);
            *gap = self.sides[side].gap_at([x[0], x[1]], &x[own], speed)?;
        }
        Ok(gaps)
    }

    /// Smallest gap where solid contact is summed, less the range of contact, on each side \[m\] at the coordinates `x`.
    pub fn contact_gaps(&mut self, x: &[f64]) -> [f64; 2] {
        [0, 1].map(|side: usize| {
            let own = self.own(side);
            self.sides[side].contact_gap([x[0], x[1]], &x[own])
        })
    }

    /// Normal pressure of solid contact along the rows of each side \[Pa\], mean over the arc, at the coordinates `x`
    /// ([`Side::contact_pressures`](crate::Side::contact_pressures)).
    pub fn contact_pressures(&mut self, x: &[f64]) -> [Vec<f64>; 2] {
        [0, 1].map(|side: usize| {
            let own = self.own(side);
            self.sides[side].contact_pressures([x[0], x[1]], &x[own])
        })
    }

    /// Oil that leaves both sides at the present place and the rates `w` \[m³/s\]: over the upper edges, over the lower edges, over the flanks.
    ///
    /// # Errors
    /// A film that cannot be solved.
    pub fn oil_flow(&mut self, now: &Instant, w: &[f64]) -> Result<[f64; 3], EvalError> {
        let mut oil = [0.0; 3];
        for side in 0..2 {
            let own = self.own(side);
            let rates = &mut self.own_rates[side];
            rates[..2].copy_from_slice(&w[..2]);
            rates[2..].copy_from_slice(&w[own]);
            let flow = self.sides[side].oil_flow(now.speed, now.mu, rates)?;
            oil.iter_mut().zip(flow).for_each(|(o, f)| *o += f);
        }
        Ok(oil)
    }

    /// Forces at the present place for rates that [`Piston::ask`] found.
    ///
    /// # Errors
    /// A film that cannot be solved.
    pub fn summary(&mut self, now: &Instant, x: &[f64], w: &[f64]) -> Result<Summary, EvalError> {
        self.place(now, x)?;
        self.residual(now, x, w, Slopes::None)?;
        let mut told = Summary::default();
        let (force, moment) = self.others(now, w, &self.loads, Some(&mut told));
        told.net = [force, moment];
        for (i, (side, l)) in self.sides.iter().zip(&self.loads).enumerate() {
            [told.film[i], told.film_moment[i]] = self.body.about_pin([l.film[0], l.film[1]]);
            [told.contact[i], told.contact_moment[i]] = self.body.about_pin([l.contact[0], l.contact[1]]);
            told.net[0] += told.film[i] + told.contact[i];
            told.net[1] += told.film_moment[i] + told.contact_moment[i];
            told.p_max[i] = side.p_max();
            told.gap[i] = side.smallest_gap();
        }
        Ok(told)
    }

    /// Kinetic energy of the motion across the bore \[J\].
    #[must_use]
    pub fn lateral_energy(&self, v: [f64; 2]) -> f64 {
        let [[a, b], [_, d]] = self.body.matrix();
        0.5 * (a * v[0] * v[0] + 2.0 * b * v[0] * v[1] + d * v[1] * v[1])
    }
}
