//! The piston between both sides of its skirt: the balance of all forces across the bore.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::{GrooveFriction, PinFriction};
use gudgeon_numerics::linalg::{lu_factor, lu_solve};

use crate::body::{Body, Crank, Instant};
use crate::side::{Side, SideLoads, Slopes};

mod balance;

use balance::Follow;

const MODEL: &str = "piston";

/// Forces on the piston at an instant, as a person looks at them. Thrust side first.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Summary {
    /// Lateral force of the film of each side \[N\], towards the anti-thrust side.
    pub film: [f64; 2],
    /// Moment of the film pressure of each side about the pin \[N m\].
    pub film_moment: [f64; 2],
    /// Viscous force on each side along the bore, away from the head \[N\].
    pub film_friction: [f64; 2],
    /// Moment of the viscous force of each side about the pin \[N m\].
    pub film_friction_moment: [f64; 2],
    /// Lateral force of solid contact of each side \[N\].
    pub contact: [f64; 2],
    /// Moment of solid contact of each side about the pin \[N m\].
    pub contact_moment: [f64; 2],
    /// Friction of solid contact along the bore, away from the head \[N\].
    pub contact_friction: [f64; 2],
    /// Lateral force of the rod \[N\], towards the anti-thrust side.
    pub rod: f64,
    /// Moment of the pin's friction \[N m\].
    pub pin_moment: f64,
    /// Lateral force of the rings \[N\].
    pub groove: f64,
    /// Sum of lateral forces \[N\] and of moments about the pin \[N m\]: what accelerates the piston.
    pub net: [f64; 2],
    /// Highest film pressure above that of the crankcase on each side \[Pa\].
    pub p_max: [f64; 2],
    /// Smallest gap on each side \[m\].
    pub gap: [f64; 2],
}

impl Summary {
    /// Friction of film and contact of both sides along the bore, away from the head \[N\].
    #[must_use]
    pub fn friction(&self) -> f64 {
        self.film_friction[0] + self.film_friction[1] + self.contact_friction[0] + self.contact_friction[1]
    }
    /// Lateral force of film and contact of both sides \[N\].
    #[must_use]
    pub fn side_force(&self) -> f64 {
        self.film[0] + self.film[1] + self.contact[0] + self.contact[1]
    }
}

/// Piston with both sides of its skirt. Coordinates: displacements of the upper and the lower edge towards the anti-thrust side, then
/// the elastic amplitudes of the thrust side, then those of the other.
pub struct Piston {
    /// Thrust side, anti-thrust side.
    pub sides: [Side; 2],
    /// Masses.
    pub body: Body,
    /// Crank drive.
    pub crank: Crank,
    pin: Box<dyn PinFriction>,
    groove: Box<dyn GrooveFriction>,
    loads: [SideLoads; 2],
    trial: [SideLoads; 2],
    n: usize,
    r: Vec<f64>,
    best: Vec<f64>,
    slope: Vec<f64>,
    lu: Vec<f64>,
    piv: Vec<usize>,
    step: Vec<f64>,
    own_rates: [Vec<f64>; 2],
    /// Coordinates beside the present place, their moves, and the loads there.
    moved: Vec<f64>,
    moves: Vec<f64>,
    own_moves: [Vec<f64>; 2],
    beside: [Vec<SideLoads>; 2],
    work: Linear,
    follow: Follow,
    /// Forces on both edges that the balance leaves for a given acceleration \[N\].
    inertia: [f64; 2],
    /// Time \[s\] in which an elastic shape without load comes back to rest.
    pub relaxation: f64,
    /// Newton steps of balances so far.
    pub newton_steps: u64,
}

/// Accelerations of both edges under forces on them.
fn accelerate([[a, b], [_, d]]: [[f64; 2]; 2], f: [f64; 2]) -> [f64; 2] {
    let det = a * d - b * b;
    [(d * f[0] - b * f[1]) / det, (a * f[1] - b * f[0]) / det]
}

/// Answer of rates and accelerations to a change of the forces.
#[derive(Default)]
struct Linear {
    n: usize,
    first: usize,
    inertial: bool,
    mass: [[f64; 2]; 2],
    base: Vec<f64>,
    slope: Vec<f64>,
    lu: Vec<f64>,
    piv: Vec<usize>,
    /// Change of the forces at fixed rates.
    dr: Vec<f64>,
    d: Vec<f64>,
}

impl Linear {
    fn new(n: usize) -> Self {
        let v = |n: usize| vec![0.0; n];
        Self {
            n,
            base: v(n),
            slope: v(n * n),
            lu: v(n * n),
            piv: vec![0; n],
            dr: v(n),
            d: v(n),
            ..Self::default()
        }
    }

    fn states(&self) -> usize {
        if self.inertial { self.n + 2 } else { self.n }
    }

    /// Takes the forces and their derivatives that the piston just found.
    fn prepare(&mut self, piston: &Piston, inertial: bool) -> Result<(), EvalError> {
        let n = self.n;
        (self.inertial, self.first) = (inertial, if inertial { 2 } else { 0 });
        self.mass = piston.body.matrix();
        self.base.copy_from_slice(&piston.r);
        self.slope.copy_from_slice(&piston.slope);
        let m = n - self.first;
        for i in 0..m {
            for j in 0..m {
                self.lu[i * m + j] = self.slope[(self.first + i) * n + self.first + j];
            }
        }
        lu_factor(&mut self.lu[..m * m], m, &mut self.piv[..m])
            .map_err(|_| EvalError::recoverable(MODEL, "nothing resists the motion of the piston"))
    }

    /// Tells the change of every rate that is not given and of the accelerations, for the change of the forces in `dr`.
    fn respond(&mut self, mut tell: impl FnMut(usize, f64)) {
        let (n, first) = (self.n, self.first);
        let m = n - first;
        for i in 0..m {
            self.d[i] = -self.dr[first + i];
        }
        if m > 0 {
            lu_solve(&self.lu[..m * m], m, &self.piv[..m], &mut self.d[..m]);
        }
        for i in 0..m {
            tell(first + i, self.d[i]);
        }
        if self.inertial {
            let mut f = [self.dr[0], self.dr[1]];
            for (k, f) in f.iter_mut().enumerate() {
                for j in 0..m {
                    *f += self.slope[k * n + first + j] * self.d[j];
                }
            }
            let a = accelerate(self.mass, f);
            tell(n, a[0]);
            tell(n + 1, a[1]);
        }
    }
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
            follow: Follow::new(n),
            inertia: [0.0; 2],
            relaxation: RELAXATION,
            newton_steps: 0,
        }
    }

    /// Number of coordinates.
    #[must_use]
    pub fn coordinates(&self) -> usize {
        self.n
    }

    /// Where the elastic amplitudes of a side stand among the coordinates.
    fn own(&self, side: usize) -> std::ops::Range<usize> {
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

    /// Forces left over at the present place `x` and the rates `w`, into `r`: on both edges \[N\] and on the elastic shapes \[N\]. With their
    /// derivatives, row after row, into `slope`.
    fn residual(&mut self, now: &Instant, x: &[f64], w: &[f64], slopes: Slopes) -> Result<(), EvalError> {
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
            self.slopes(now, w);
        }
        Ok(())
    }

    /// Derivatives of the forces that [`Piston::residual`] found at the same arguments.
    fn tangent(&mut self, now: &Instant, w: &[f64], slopes: Slopes) -> Result<(), EvalError> {
        for side in 0..2 {
            let (rates, loads) = (&self.own_rates[side], &mut self.loads[side]);
            self.sides[side].slopes(now.speed, now.mu, rates, slopes, loads)?;
        }
        self.slopes(now, w);
        Ok(())
    }

    /// Forces of both sides and of all else, into `r`.
    fn left_over(&self, now: &Instant, x: &[f64], w: &[f64], trial: bool, r: &mut [f64]) {
        let loads = if trial { &self.trial } else { &self.loads };
        let (force, moment) = self.others(now, w, loads, None);
        let edges = self.body.on_edges(force, moment);
        for k in 0..2 {
            r[k] = edges[k] + loads.iter().map(|l| l.film[k] + l.contact[k]).sum::<f64>() - self.inertia[k];
        }
        for side in 0..2 {
            for (m, k) in self.own(side).enumerate() {
                r[k] =
                    loads[side].elastic[m] - self.sides[side].stiffness[m] * (x[k] + self.relaxation * w[k]);
            }
        }
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
        let direction = if now.speed > 0.0 {
            1.0
        } else if now.speed < 0.0 {
            -1.0
        } else {
            0.0
        };
        let mut told = Summary::default();
        for (i, (side, l)) in self.sides.iter().zip(loads).enumerate() {
            let rub = -direction * side.friction_coefficient();
            let moment_of = |force: f64, arm: f64| -side.sign * arm + self.crank.pin_offset * force;
            let own = moment_of(l.film[2], l.film[3]);
            friction += l.film[2] + rub * l.contact[2];
            moment += own + moment_of(rub * l.contact[2], rub * l.contact[3]);
            told.film_friction[i] = l.film[2];
            told.film_friction_moment[i] = own;
            told.contact_friction[i] = rub * l.contact[2];
        }
        let rod = self.body.rod_lateral(now, friction);
        let mut force = rod;
        moment += self.body.drive_moment(now, self.crank.pin_offset);
        told.rod = rod;
        if !self.pin.is_off() {
            let load = self.body.rod_axial(now, friction).hypot(rod);
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
    fn slopes(&mut self, now: &Instant, w: &[f64]) {
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
                    self.slope[column * n + column] -= self.relaxation * self.sides[side].stiffness[m - 2];
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
    }

    /// What counts as one when forces are compared.
    fn force_scale(&self, now: &Instant) -> f64 {
        let films: f64 = self.loads.iter().map(|l| l.film[0].abs() + l.film[1].abs()).sum();
        let inertia = (self.body.mass() * now.acceleration * now.tangent).abs();
        1e-3 + films + inertia + (now.gas * now.tangent).abs()
    }

    /// Rates of all coordinates and, for a piston with inertia, accelerations of both edges: `v` holds the velocities of both edges then.
    /// `w` holds a guess of the rates and takes them.
    ///
    /// # Errors
    /// A film that cannot be solved, no balance.
    pub fn rates(
        &mut self,
        now: &Instant,
        x: &[f64],
        v: Option<&[f64]>,
        w: &mut [f64],
        acceleration: &mut [f64; 2],
    ) -> Result<(), EvalError> {
        self.place(now, x)?;
        match v {
            None => self.balance(now, x, w, 0),
            Some(v) => {
                w[..2].copy_from_slice(&v[..2]);
                if self.n > 2 {
                    self.balance(now, x, w, 2)?;
                } else {
                    self.residual(now, x, w, Slopes::None)?;
                }
                *acceleration = accelerate(self.body.matrix(), [self.r[0], self.r[1]]);
                Ok(())
            }
        }
    }

    /// Rates of all coordinates at which both edges have the accelerations given \[m/s²\]. `w` holds a guess of the rates and takes them.
    ///
    /// # Errors
    /// A film that cannot be solved, no balance.
    pub fn rates_under(
        &mut self,
        now: &Instant,
        x: &[f64],
        acceleration: [f64; 2],
        w: &mut [f64],
    ) -> Result<(), EvalError> {
        self.place(now, x)?;
        let m = self.body.matrix();
        self.inertia = [0, 1].map(|k| m[k][0] * acceleration[0] + m[k][1] * acceleration[1]);
        let outcome = self.balance(now, x, w, 0);
        self.inertia = [0.0; 2];
        outcome
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

    /// Derivatives of what [`Piston::rates`] just found, at the same arguments: of the rates (`n`), then of the accelerations (2, with inertia), with
    /// respect to the coordinates, the velocities (with inertia), row after row; and with respect to time, given the instant `later` by `dt`.
    ///
    /// # Errors
    /// A film beside the present place that cannot be solved.
    #[allow(clippy::too_many_arguments, reason = "arguments of one function and its derivatives")]
    pub fn derivatives(
        &mut self,
        now: &Instant,
        x: &[f64],
        inertial: bool,
        w: &[f64],
        jacobian: Option<&mut [f64]>,
        time: Option<(&Instant, f64, &mut [f64])>,
    ) -> Result<(), EvalError> {
        self.residual(now, x, w, Slopes::Film)?;
        let mut work = std::mem::take(&mut self.work);
        let mut outcome = work.prepare(self, inertial);
        if outcome.is_err() {
            // Nothing but cavities: the answer of full films stands for theirs.
            outcome = self.residual(now, x, w, Slopes::Full).and_then(|()| work.prepare(self, inertial));
        }
        if outcome.is_ok() {
            outcome = self.differentiate(&mut work, now, x, w, jacobian, time);
        }
        self.work = work;
        outcome
    }

    fn differentiate(
        &mut self,
        work: &mut Linear,
        now: &Instant,
        x: &[f64],
        w: &[f64],
        jacobian: Option<&mut [f64]>,
        time: Option<(&Instant, f64, &mut [f64])>,
    ) -> Result<(), EvalError> {
        let (n, states) = (self.n, work.states());
        if let Some((later, dt, out)) = time {
            let mut r = std::mem::take(&mut work.dr);
            let told = self.residual_at(later, x, w, &mut r);
            r.iter_mut().zip(&work.base).for_each(|(r, b)| *r = (*r - b) / dt);
            work.dr = r;
            told?;
            out[..states].fill(0.0);
            work.respond(|row, value| out[row] = value);
        }
        let Some(jac) = jacobian else { return Ok(()) };
        jac[..states * states].fill(0.0);
        self.look_beside(now, x, w)?;
        for column in 0..n {
            self.change_beside(now, x, w, column, &work.base, &mut work.dr);
            work.respond(|row, value| jac[row * states + column] = value);
        }
        if work.inertial {
            for v in 0..2 {
                for k in 0..n {
                    work.dr[k] = work.slope[k * n + v];
                }
                work.respond(|row, value| jac[row * states + n + v] = value);
                // The edges move as their velocities say.
                jac[v * states + n + v] = 1.0;
            }
        }
        Ok(())
    }

    /// Loads of both sides at places beside the present one `x`, each coordinate moved a little.
    fn look_beside(&mut self, now: &Instant, x: &[f64], w: &[f64]) -> Result<(), EvalError> {
        for k in 0..self.n {
            // The difference of what is then added, to the last digit.
            self.moves[k] = (x[k] + self.increment(w, k)) - x[k];
        }
        for side in 0..2 {
            let own = self.own(side);
            let rates = &mut self.own_rates[side];
            rates[..2].copy_from_slice(&w[..2]);
            rates[2..].copy_from_slice(&w[own.clone()]);
            let moves = &mut self.own_moves[side];
            moves[..2].copy_from_slice(&self.moves[..2]);
            moves[2..].copy_from_slice(&self.moves[own.clone()]);
            let (e, out) = ([x[0], x[1]], &mut self.beside[side]);
            self.sides[side].loads_beside(e, &x[own], moves, now.speed, now.mu, rates, out)?;
        }
        Ok(())
    }

    /// Change of the forces left over per change of the coordinate `column`, from what [`Piston::look_beside`] found, into `dr`; `base` is what is left
    /// over at `x`.
    fn change_beside(
        &mut self,
        now: &Instant,
        x: &[f64],
        w: &[f64],
        column: usize,
        base: &[f64],
        dr: &mut [f64],
    ) {
        for side in 0..2 {
            let own = self.own(side);
            let from = if column < 2 {
                &self.beside[side][column]
            } else if own.contains(&column) {
                &self.beside[side][2 + column - own.start]
            } else {
                &self.loads[side]
            };
            let to = &mut self.trial[side];
            (to.film, to.contact) = (from.film, from.contact);
            to.elastic.clone_from(&from.elastic);
        }
        let mut moved = std::mem::take(&mut self.moved);
        moved.copy_from_slice(x);
        moved[column] += self.moves[column];
        self.left_over(now, &moved, w, true, dr);
        self.moved = moved;
        for (dr, base) in dr.iter_mut().zip(base) {
            *dr = (*dr - base) / self.moves[column];
        }
    }

    /// Forces left over at another instant, at the place and the rates of now.
    fn residual_at(&mut self, at: &Instant, x: &[f64], w: &[f64], r: &mut [f64]) -> Result<(), EvalError> {
        for side in 0..2 {
            let own = self.own(side);
            let rates = &mut self.own_rates[side];
            rates[..2].copy_from_slice(&w[..2]);
            rates[2..].copy_from_slice(&w[own]);
            self.sides[side].loads(at.speed, at.mu, rates, Slopes::None, &mut self.trial[side])?;
        }
        self.left_over(at, x, w, true, r);
        Ok(())
    }

    /// Change of a coordinate for a difference quotient: a small part of the gap, in the direction of motion.
    fn increment(&self, w: &[f64], column: usize) -> f64 {
        let d = DIFFERENCE * self.smallest_gap().abs().max(1e-8);
        if w[column] < 0.0 { -d } else { d }
    }

    /// Forces at the present place for rates that [`Piston::rates`] found.
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

/// [`Piston::relaxation`] of a piston that is not told another: a little inner damping, without which nothing would hold a surface under a cavity.
const RELAXATION: f64 = 1e-6;
/// Part of the gap by which a coordinate is changed for a difference quotient: the forces change by three times as much, the films are
/// solved to 1e-9.
const DIFFERENCE: f64 = 1e-5;
