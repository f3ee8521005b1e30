//! What the results of a cycle are made of, gathered step by step while the solver takes them.
//!
//! An accepted step is sampled at the nodes of a [`Rule`] on its dense output; the polynomials through the samples give extremes,
//! integrals and the angles at which a ring comes onto a flank or leaves it. Nothing here knows the rows of the series. A marching scheme
//! knows the ends of its own steps, between which straight lines run.
//!
//! # Seats
//! A ring is *on a flank* while its distance from it is at most a share of its axial clearance (`outputs.seat`), and between the
//! flanks otherwise. The oil lets a ring come down ever more slowly, the gap going with the time to the power -1/2, so it never touches
//! in the sense of geometry: at a tenth of the clearance it rests on its film, which carries the forces on it.

use std::f64::consts::PI;

use gudgeon_numerics::elementary;
use gudgeon_numerics::panel::{MAX_NODES, Rule, TRAPEZIUM};

use super::film_strokes::{StepFilm, StrokeFilm};
use super::pack::Pack;

/// The highest value of something and the crank angle \[rad\] it comes at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peak {
    /// Where \[rad\].
    pub theta: f64,
    /// The value.
    pub value: f64,
}

impl Default for Peak {
    fn default() -> Self {
        Self { theta: 0.0, value: f64::NEG_INFINITY }
    }
}

/// Where a ring is in its groove.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Seat {
    /// On the lower flank.
    Lower,
    /// On neither.
    Between,
    /// On the upper flank.
    Upper,
}

/// A ring that came onto a flank or left one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Change {
    /// When \[rad\].
    pub theta: f64,
    /// From where.
    pub from: Seat,
    /// To where.
    pub to: Seat,
    /// Pressure of the land below over that above, then.
    pub ratio: f64,
}

/// Changes kept of each ring; those of a ring that flutters are counted.
const KEPT: usize = 64;

/// One ring over the cycle.
#[derive(Debug, Clone)]
pub struct RingMeasure {
    /// `ln` of the thinnest and the thickest film \[m\].
    ln_h: (f64, f64),
    /// `∫ h dt` \[m s\].
    pub film: f64,
    /// `∫ h |v| dt` \[m²\] over each stroke, intake first.
    pub strokes: [f64; 4],
    /// The film over each stroke, intake first.
    pub by_stroke: [StrokeFilm; 4],
    /// Highest ratio of the pressure of the land below to that above.
    pub reverse: f64,
    /// `∫ Δp/μ dt`, the pressure below less that above over the viscosity of the film.
    pub gap_drive: f64,
    /// `∫ Δp H³ dt` \[Pa m³ s\], `H` the distance from the nearer flank.
    pub groove_drive: f64,
    /// `H` when the cycle begins and now \[m\].
    pub nearest: (f64, f64),
    /// `∫ wetted share dt` \[s\].
    pub wetted: f64,
    /// `∫ W |v| dt` \[J\], the load of solid contact times the way that it slides.
    pub wear: f64,
    /// Time \[s\] off the flank that it seals.
    pub lifted: f64,
    /// Arrivals on a flank.
    pub arrivals: u32,
    /// Its first changes.
    pub changes: Vec<Change>,
    /// When it first left the flank that it seals after the firing dead centre, or else in the cycle.
    pub lift: Option<Change>,
    seat: Option<Seat>,
    /// The flank that it seals.
    home: Seat,
    samples: Samples,
}

impl RingMeasure {
    /// Thinnest and thickest film \[m\].
    #[must_use]
    pub fn film_span(&self) -> (f64, f64) {
        (elementary::exp(self.ln_h.0), elementary::exp(self.ln_h.1))
    }
}

type Column = [f64; MAX_NODES];

/// Samples of one ring over a step.
#[derive(Debug, Clone, Copy, Default)]
struct Samples {
    h: Column,
    ln_h: Column,
    e: Column,
    nearest: Column,
    difference: Column,
    mu: Column,
    ratio: Column,
    wetted: Column,
    friction: Column,
    load: Column,
    contact: Column,
}

/// Everything measured over a cycle.
#[derive(Debug, Clone)]
pub struct Measures {
    rule: Rule,
    seat: f64,
    /// Crank angle of the firing dead centre \[rad\].
    firing: f64,
    omega: f64,
    /// The rings.
    pub rings: Vec<RingMeasure>,
    /// Highest pressures \[Pa\] of the lands between the rings, land 2 first.
    pub lands: Vec<Peak>,
    /// Highest cylinder pressure \[Pa\].
    pub cylinder: Peak,
    /// Gas \[kg\] that went back up: past each ring, from the crankcase, and through each passage that is followed.
    pub up: Vec<f64>,
    /// Time measured \[s\].
    pub span: f64,
    speed: Column,
    /// What of it has gone down so far.
    passed: Vec<Column>,
    pressures: Vec<Column>,
    /// Angle of the last sample, when there is one.
    last: Option<f64>,
}

impl Measures {
    /// For the steps of a solver that are sampled by `rule`; a ring is on a flank within the share `seat` of its clearance.
    #[must_use]
    pub fn new(pack: &Pack, rule: Rule, seat: f64) -> Self {
        let n = pack.n_rings();
        let passed = n + 1 + pack.at.gas.passages.len();
        let ring = RingMeasure {
            ln_h: (f64::INFINITY, f64::NEG_INFINITY),
            film: 0.0,
            strokes: [0.0; 4],
            by_stroke: Default::default(),
            reverse: 0.0,
            gap_drive: 0.0,
            groove_drive: 0.0,
            nearest: (0.0, 0.0),
            wetted: 0.0,
            wear: 0.0,
            lifted: 0.0,
            arrivals: 0,
            changes: Vec::new(),
            lift: None,
            seat: None,
            home: Seat::Lower,
            samples: Samples::default(),
        };
        let mut rings = vec![ring; n];
        for (r, g) in rings.iter_mut().zip(&pack.geo.rings) {
            r.changes.reserve(KEPT);
            if g.seals_above() {
                r.home = Seat::Upper;
            }
        }
        Self {
            rule,
            seat,
            firing: pack.period() - 2.0 * PI,
            omega: pack.omega,
            rings,
            lands: vec![Peak::default(); n.saturating_sub(1)],
            cylinder: Peak::default(),
            up: vec![0.0; passed],
            span: 0.0,
            speed: [0.0; MAX_NODES],
            passed: vec![[0.0; MAX_NODES]; passed],
            pressures: vec![[0.0; MAX_NODES]; n],
            last: None,
        }
    }

    /// Places in a step, from 0 to 1, at which it is to be sampled.
    #[must_use]
    pub const fn nodes(&self) -> &'static [f64] {
        self.rule.nodes
    }

    /// Takes what `pack` holds as the sample at node `k` of the step; `passed`: gas \[kg\] that has passed each ring from above, to the crankcase, and
    /// through each passage that is followed; what is left out has passed nothing.
    pub fn sample(&mut self, k: usize, pack: &Pack, passed: impl Iterator<Item = f64>) {
        self.speed[k] = pack.at.piston.v;
        self.passed.iter_mut().zip(passed).for_each(|(column, gas)| column[k] = gas);
        for (column, p) in self.pressures.iter_mut().zip(&pack.at.gas.p_land) {
            column[k] = *p;
        }
        for (i, ring) in self.rings.iter_mut().enumerate() {
            let (place, at, s) = (&pack.at.places[i], &pack.at.rings[i], &mut ring.samples);
            (s.h[k], s.ln_h[k]) = (place.h, elementary::ln(place.h));
            // A ring that is integrated may stand a little beyond a flank.
            s.e[k] = if pack.rings[i].is_integrated() && place.clearance > 0.0 {
                place.s / place.clearance
            } else {
                place.lift_fraction
            };
            let lift = place.s.clamp(0.0, place.clearance);
            s.nearest[k] = lift.min(place.clearance - lift);
            s.difference[k] = at.p_below - at.p_above;
            s.mu[k] = at.mu;
            s.ratio[k] = at.p_below / at.p_above;
            s.friction[k] = at.friction.abs();
            let circumference = 2.0 * PI * place.r_outer * pack.geo.rings[i].rails as f64;
            s.load[k] = at.load * circumference;
            s.contact[k] = at.contact * circumference;
            s.wetted[k] = pack.oil_pack.as_ref().map_or(0.0, |o| o.ring(i, pack.at.piston.v).wetted);
        }
    }

    /// Adds the step from `t0` to `t1` \[rad\], whose samples are taken. Seats that are decided in steps hold from its start.
    pub fn step(&mut self, pack: &Pack, t0: f64, t1: f64) {
        let (rule, dt) = (self.rule, (t1 - t0) / self.omega);
        let n = rule.nodes.len();
        self.span += dt;
        for (up, passed) in self.up.iter_mut().zip(&self.passed) {
            *up += rule.fall(&passed[..n]);
        }
        for (peak, column) in self.lands.iter_mut().zip(&self.pressures[1..]) {
            raise(peak, rule, &column[..n], t0, t1);
        }
        let stroke = (0.5 * (t0 + t1) / PI).floor() as usize % 4;
        for (i, ring) in self.rings.iter_mut().enumerate() {
            ring.integrate(rule, &self.speed, stroke, dt);
            let s = &ring.samples;
            let film = StepFilm { ln_h: &s.ln_h[..n], friction: &s.friction[..n], load: &s.load[..n] };
            ring.by_stroke[stroke].step(rule, film, (t0, t1));
            if pack.geo.rings[i].has_clearance {
                let mut e = ring.samples.e;
                if pack.rings[i].is_decided() {
                    e.fill(ring.samples.e[0]);
                }
                ring.seats(rule, &e[..n], self.seat, (t0, t1), (self.omega, self.firing));
            }
        }
    }

    /// Adds the step of a marching scheme that ends at `theta` \[rad\], where `pack` stands; the first call says where the cycle starts.
    pub fn march(&mut self, theta: f64, pack: &Pack, passed: impl Iterator<Item = f64>) {
        debug_assert_eq!(self.rule, TRAPEZIUM);
        self.sample(1, pack, passed);
        if let Some(last) = self.last {
            self.step(pack, last, theta);
            raise(&mut self.cylinder, self.rule, &self.pressures[0][..2], last, theta);
        }
        self.last = Some(theta);
        self.carry();
    }

    /// The end of a step is the start of the next.
    fn carry(&mut self) {
        let pass = |c: &mut Column| c[0] = c[1];
        pass(&mut self.speed);
        self.passed.iter_mut().for_each(pass);
        self.pressures.iter_mut().for_each(pass);
        for r in &mut self.rings {
            let s = &mut r.samples;
            for c in [
                &mut s.h,
                &mut s.ln_h,
                &mut s.e,
                &mut s.nearest,
                &mut s.difference,
                &mut s.mu,
                &mut s.ratio,
                &mut s.wetted,
                &mut s.friction,
                &mut s.load,
                &mut s.contact,
            ] {
                pass(c);
            }
        }
    }
}

/// Raises `peak` to what the polynomial through `values` reaches in the step from `t0` to `t1` \[rad\].
pub fn raise(peak: &mut Peak, rule: Rule, values: &[f64], t0: f64, t1: f64) {
    if let Some((x, value)) = rule.maximum(values, peak.value) {
        *peak = Peak { theta: t0 + x * (t1 - t0), value };
    }
}

impl RingMeasure {
    fn integrate(&mut self, rule: Rule, speed: &Column, stroke: usize, dt: f64) {
        let (n, s) = (rule.nodes.len(), &self.samples);
        if let Some((_, low)) = rule.minimum(&s.ln_h[..n], self.ln_h.0) {
            self.ln_h.0 = low;
        }
        if let Some((_, high)) = rule.maximum(&s.ln_h[..n], self.ln_h.1) {
            self.ln_h.1 = high;
        }
        let over = |f: &dyn Fn(usize) -> f64| -> f64 {
            rule.weights.iter().enumerate().map(|(k, w)| w * f(k)).sum::<f64>() * dt
        };
        if let Some((_, high)) = rule.maximum(&s.ratio[..n], self.reverse) {
            self.reverse = high;
        }
        self.film += over(&|k| s.h[k]);
        self.strokes[stroke] += over(&|k| s.h[k] * speed[k].abs());
        self.gap_drive += over(&|k| if s.mu[k] > 0.0 { s.difference[k] / s.mu[k] } else { 0.0 });
        self.groove_drive += over(&|k| s.difference[k] * s.nearest[k].powi(3));
        self.wetted += over(&|k| s.wetted[k]);
        self.wear += over(&|k| s.contact[k] * speed[k].abs());
        if self.seat.is_none() {
            self.nearest.0 = s.nearest[0];
        }
        self.nearest.1 = s.nearest[n - 1];
    }

    /// Follows the seat through a step in which the ring is at `e`.
    fn seats(
        &mut self,
        rule: Rule,
        e: &[f64],
        share: f64,
        (t0, t1): (f64, f64),
        (omega, firing): (f64, f64),
    ) {
        // Where the ring comes to a flank's film or leaves it, in order.
        let mut cuts = [1.0; MAX_CUTS];
        let mut count = 0;
        for level in [share, 1.0 - share] {
            rule.crossings(e, level, |x, _| {
                if count + 1 < MAX_CUTS {
                    cuts[count] = x;
                    count += 1;
                }
            });
        }
        cuts[..count].sort_by(f64::total_cmp);
        let mut from = 0.0;
        for &to in &cuts[..=count] {
            let at = rule.value(e, 0.5 * (from + to));
            let seat = if at <= share {
                Seat::Lower
            } else if at >= 1.0 - share {
                Seat::Upper
            } else {
                Seat::Between
            };
            let ratio = rule.value(&self.samples.ratio[..rule.nodes.len()], from);
            self.settle(seat, t0 + from * (t1 - t0), ratio, firing);
            if seat != self.home {
                self.lifted += (to - from) * (t1 - t0) / omega;
            }
            from = to;
        }
    }

    fn settle(&mut self, seat: Seat, theta: f64, ratio: f64, firing: f64) {
        let from = self.seat.replace(seat).unwrap_or(seat);
        if from == seat {
            return;
        }
        self.arrivals += u32::from(seat != Seat::Between);
        let change = Change { theta, from, to: seat, ratio };
        let waits = self.lift.is_none_or(|first| first.theta < firing && theta >= firing);
        if from == self.home && waits {
            self.lift = Some(change);
        }
        if self.changes.len() < KEPT {
            self.changes.push(change);
        }
    }
}

/// Crossings of two levels by a polynomial of degree 4, and the end of the step.
const MAX_CUTS: usize = 9;
