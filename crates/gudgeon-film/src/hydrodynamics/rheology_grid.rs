//! The film on nodes with flow factors, viscosities and densities of every node.

use std::sync::Arc;

use gudgeon_core::EvalError;
use gudgeon_core::kinds::{Compressibility, FaceIn, FaceOut, Hydrodynamics, Rheology, ShearThinning};

use super::rough_nodes::RoughNodes;
use crate::piezoviscosity::reduced_pressure::ReducedPressure;

const MODEL: &str = "gridded_face";
/// Ambient pressure \[Pa\].
const AMBIENT: f64 = 101_325.0;
/// How often densities follow the pressures of the film that was found with the densities before, those of ambient pressure first. Each time the error
/// falls by about the relative rise of the density: two leave some 1e-6 of a load at 20 MPa.
const ROUNDS: usize = 2;
/// Steps of the search for a squeeze velocity.
const STEPS: usize = 200;
/// Part of a load to which it is found: rounding of the sums.
const FOUND: f64 = 1e-13;

/// The nodes of one face, with work space. See [`GriddedFace`](super::GriddedFace) for the equations.
pub(super) struct RheologyGrid {
    length: f64,
    dx: f64,
    drops: Vec<f64>,
    min_drop: f64,
    rough: bool,
    thinning: Option<Arc<dyn ShearThinning>>,
    density: Option<Arc<dyn Compressibility>>,
    /// How often densities follow the pressures.
    rounds: usize,
    reduced: Option<ReducedPressure>,
    gap: RoughNodes,
    /// For what `gap`, `resist` and `thin` stand.
    placed: Option<FaceIn>,
    /// Shear rate and factor of shear thinning.
    rate: Vec<f64>,
    thin: Vec<f64>,
    /// Slopes of laws, which nothing asks for.
    slope: Vec<f64>,
    /// `12 μ(γ̇)/(φ_x h_p³)`.
    resist: Vec<f64>,
    /// Density over that at ambient pressure, and its derivative with respect to the squeeze velocity.
    rho: Vec<f64>,
    rho_rate: Vec<f64>,
    /// Pressure above ambient.
    above: Vec<f64>,
    /// `Y` and its derivative.
    way: Vec<f64>,
    way_rate: Vec<f64>,
    /// Reduced pressure before the clip and its derivative with respect to the squeeze velocity.
    pi: Vec<f64>,
    pi_rate: Vec<f64>,
    /// Pressure above `p_cav`, clipped, and `f` there.
    p: Vec<f64>,
    thick: Vec<f64>,
    /// Reduced cavitation pressure.
    floor: f64,
}

impl RheologyGrid {
    /// `drops` at equally spaced nodes, two or more.
    pub(super) fn new(length: f64, drops: Vec<f64>, rheology: &Rheology) -> Self {
        let n = drops.len();
        let v = |x: f64| vec![x; n];
        Self {
            length,
            dx: length / (n - 1) as f64,
            min_drop: drops.iter().copied().fold(f64::INFINITY, f64::min),
            rough: rheology.roughness.is_some(),
            thinning: rheology.shear_thinning.clone(),
            rounds: if rheology.compressibility.is_some() { ROUNDS } else { 0 },
            density: rheology.compressibility.clone(),
            reduced: rheology.piezoviscosity.clone().map(ReducedPressure::new),
            gap: RoughNodes::new(rheology.roughness.clone(), n),
            placed: None,
            rate: v(0.0),
            thin: v(1.0),
            slope: v(0.0),
            resist: v(0.0),
            rho: v(1.0),
            rho_rate: v(0.0),
            above: v(0.0),
            way: v(0.0),
            way_rate: v(0.0),
            pi: v(0.0),
            pi_rate: v(0.0),
            p: v(0.0),
            thick: v(1.0),
            floor: 0.0,
            drops,
        }
    }

    fn n(&self) -> usize {
        self.drops.len()
    }

    /// Trapezoid weight of node `j` in panels.
    fn weight(&self, j: usize) -> f64 {
        if j == 0 || j + 1 == self.n() { 0.5 } else { 1.0 }
    }

    fn check(&self, inp: &FaceIn) -> Result<(), EvalError> {
        // One test for all: a sum with a term that is not finite is not finite.
        if !(inp.h + inp.u + inp.p_bottom + inp.p_top + inp.p_cav + inp.mu).is_finite() {
            return Err(EvalError::fatal(MODEL, format!("not a number among {inp:?}")));
        }
        if inp.mu <= 0.0 {
            return Err(EvalError::fatal(MODEL, format!("the viscosity is {} Pa s", inp.mu)));
        }
        let least = if self.rough { inp.h } else { inp.h + self.min_drop };
        if least <= 0.0 {
            return Err(EvalError::recoverable(
                MODEL,
                format!("the thinnest film is {least:e} m: the surfaces touch"),
            ));
        }
        Ok(())
    }

    /// Gap, shear thinning and resistance for `inp`.
    fn place(&mut self, inp: &FaceIn) -> Result<(), EvalError> {
        if self.placed.as_ref() == Some(inp) {
            return Ok(());
        }
        self.check(inp)?;
        self.placed = None;
        self.gap.place(inp.h, &self.drops)?;
        if let Some(law) = &self.thinning {
            for (rate, film) in self.rate.iter_mut().zip(&self.gap.flow.film) {
                *rate = inp.u / film;
            }
            law.factor(&self.rate, &mut self.thin, &mut self.slope)?;
        }
        for (j, resist) in self.resist.iter_mut().enumerate() {
            let film = self.gap.flow.film[j];
            *resist = 12.0 * inp.mu * self.thin[j] / (self.gap.flow.phi_x[j] * film * film * film);
        }
        if let Some(reduced) = &mut self.reduced {
            reduced.set(inp.mu);
        }
        self.placed = Some(*inp);
        Ok(())
    }

    /// Reduced pressure \[Pa\] of an absolute one.
    fn reduce(&mut self, pressure: f64) -> Result<f64, EvalError> {
        let above = pressure - AMBIENT;
        self.reduced.as_mut().map_or(Ok(above), |r| r.of(above))
    }

    /// Pressures, densities and derivatives for a squeeze velocity; densities follow the pressures `rounds` times.
    fn solve(&mut self, inp: &FaceIn, hdot: f64, rounds: usize) -> Result<(), EvalError> {
        if !hdot.is_finite() {
            return Err(EvalError::fatal(MODEL, format!("the squeeze velocity is {hdot} m/s")));
        }
        self.place(inp)?;
        self.floor = self.reduce(inp.p_cav)?;
        let ends = [self.reduce(inp.p_bottom)?, self.reduce(inp.p_top)?];
        self.rho.fill(1.0);
        self.rho_rate.fill(0.0);
        self.integrate(inp, hdot, ends);
        self.restore(inp)?;
        for _ in 0..rounds {
            self.compress(inp)?;
            self.integrate(inp, hdot, ends);
            self.restore(inp)?;
        }
        Ok(())
    }

    /// Reduced pressures before the clip and their derivatives, from densities and theirs.
    fn integrate(&mut self, inp: &FaceIn, hdot: f64, ends: [f64; 2]) {
        let n = self.n();
        (self.way[0], self.way_rate[0]) = (0.0, 0.0);
        for j in 1..n {
            let ahead = |rho: &[f64]| {
                0.5 * self.dx * (rho[j - 1] * self.gap.change[j - 1] + rho[j] * self.gap.change[j])
            };
            let (way, rate) = (ahead(&self.rho), ahead(&self.rho_rate));
            self.way[j] = self.way[j - 1] + way;
            self.way_rate[j] = self.way_rate[j - 1] + rate;
        }
        let (mut driven, mut driven_rate, mut resist, mut resist_rate) = (0.0, 0.0, 0.0, 0.0);
        for j in 0..n {
            let (own, volume) = (self.weight(j) * self.resist[j], self.rho[j].recip());
            let loosened = -self.rho_rate[j] * volume * volume;
            driven += own * (0.5 * inp.u * self.gap.flow.transport[j] + hdot * self.way[j] * volume);
            driven_rate +=
                own * ((self.way[j] + hdot * self.way_rate[j]) * volume + hdot * self.way[j] * loosened);
            resist += own * volume;
            resist_rate += own * loosened;
        }
        // Flux at the bottom edge, and its derivative.
        let flux = (driven - (ends[1] - ends[0]) / self.dx) / resist;
        let flux_rate = (driven_rate - flux * resist_rate) / resist;
        let gradient = |j: usize| {
            let (own, volume) = (0.5 * self.dx * self.resist[j], self.rho[j].recip());
            let loosened = -self.rho_rate[j] * volume * volume;
            let (squeezed, changed) =
                (hdot * self.way[j] - flux, self.way[j] + hdot * self.way_rate[j] - flux_rate);
            let sliding = 0.5 * inp.u * self.gap.flow.transport[j];
            (own * (sliding + squeezed * volume), own * (changed * volume + squeezed * loosened))
        };
        (self.pi[0], self.pi_rate[0]) = (ends[0], 0.0);
        let mut last = gradient(0);
        for j in 1..n {
            let next = gradient(j);
            self.pi[j] = self.pi[j - 1] + (last.0 + next.0);
            self.pi_rate[j] = self.pi_rate[j - 1] + (last.1 + next.1);
            last = next;
        }
        (self.pi[n - 1], self.pi_rate[n - 1]) = (ends[1], 0.0);
    }

    /// Pressures above `p_cav` from reduced ones.
    fn restore(&mut self, inp: &FaceIn) -> Result<(), EvalError> {
        for j in 0..self.pi.len() {
            let pi = self.pi[j].max(self.floor);
            if !pi.is_finite() {
                return Err(EvalError::recoverable(
                    MODEL,
                    format!("the film pressure overflows for {inp:?}"),
                ));
            }
            let (above, thick) = self.reduced.as_mut().map_or(Ok((pi, 1.0)), |r| r.back(pi))?;
            // What the clip raised is at the cavitation pressure exactly.
            let p = if self.pi[j] > self.floor { above - (inp.p_cav - AMBIENT) } else { 0.0 };
            (self.p[j], self.thick[j]) = (p.max(0.0), thick);
        }
        Ok(())
    }

    /// Densities at these pressures, and their derivatives with respect to the squeeze velocity.
    fn compress(&mut self, inp: &FaceIn) -> Result<(), EvalError> {
        let Some(law) = &self.density else { return Ok(()) };
        for (above, p) in self.above.iter_mut().zip(&self.p) {
            *above = p + (inp.p_cav - AMBIENT);
        }
        law.factor(&self.above, &mut self.rho, &mut self.slope)?;
        for j in 0..self.rho.len() {
            let rises = if self.pi[j] > self.floor { self.thick[j] * self.pi_rate[j] } else { 0.0 };
            self.rho_rate[j] = self.slope[j] * rises;
        }
        Ok(())
    }

    /// Load \[N/m\] and its derivative with respect to the squeeze velocity for the film of now.
    fn load_of(&self) -> (f64, f64) {
        let (mut load, mut rate) = (0.0, 0.0);
        for j in 0..self.n() {
            load += self.weight(j) * self.p[j];
            if self.pi[j] > self.floor {
                rate += self.weight(j) * self.thick[j] * self.pi_rate[j];
            }
        }
        (self.dx * load, self.dx * rate)
    }

    /// Outermost places where the pressure before the clip passes through `p_cav`; an empty film lies at 0.
    fn full_film(&self) -> (f64, f64) {
        let last = self.n() - 1;
        let over = |j: usize| self.pi[j] - self.floor;
        let Some(low) = (0..=last).find(|&j| over(j) > 0.0) else { return (0.0, 0.0) };
        let high = (low..=last).rev().find(|&j| over(j) > 0.0).unwrap_or(low);
        let from =
            if low == 0 { 0.0 } else { (low as f64 - over(low) / (over(low) - over(low - 1))) * self.dx };
        let to = if high == last {
            self.length
        } else {
            (high as f64 + over(high) / (over(high) - over(high + 1))) * self.dx
        };
        (from, to)
    }

    /// Load and friction of the film of now.
    fn result(&self, inp: &FaceIn) -> FaceOut {
        let (load, rate) = self.load_of();
        let (mut mean, mut apart, mut slope_force, mut half_drag) = (0.0, 0.0, 0.0, 0.0);
        let shear = &self.gap.shear;
        let lever = |j: usize| shear.phi_fp[j] * shear.film[j];
        for j in 0..self.n() {
            let sliding =
                self.weight(j) * inp.mu * self.thin[j] * self.thick[j] * inp.u / shear.film[j] * self.dx;
            mean += sliding * shear.phi_f[j];
            apart += sliding * shear.phi_fs[j];
            if j > 0 {
                slope_force -= 0.5 * (self.p[j - 1] + self.p[j]) * (self.drops[j] - self.drops[j - 1]);
                half_drag += 0.25 * (lever(j - 1) + lever(j)) * (self.p[j] - self.p[j - 1]);
            }
        }
        FaceOut {
            load,
            // Rounding must not turn a film that cannot yield into one that pushes.
            squeeze_damping: -rate.min(0.0),
            ring_shear: mean - apart - half_drag,
            liner_shear: mean + apart + half_drag,
            slope_force,
            // A clipped film has no flux of its own.
            flux: 0.0,
            p_max: inp.p_cav + self.p.iter().copied().fold(0.0, f64::max),
            full_film: self.full_film(),
        }
    }

    /// Newton's method from `hdot` on a falling function, convex without densities, between the nearest velocities at which the load was found to be greater
    /// and less.
    fn search(&mut self, inp: &FaceIn, load: f64, start: f64, rounds: usize) -> Result<f64, EvalError> {
        let (mut hdot, mut greater, mut less) = (start, f64::NEG_INFINITY, f64::INFINITY);
        for _ in 0..STEPS {
            self.solve(inp, hdot, rounds)?;
            let (found, slope) = self.load_of();
            let excess = found - load;
            // A small load is the difference of what sliding and squeeze do, and no better known than those.
            if excess.abs() <= FOUND * (load.abs() + found.abs() + (hdot * slope).abs()) {
                return Ok(hdot);
            }
            if excess > 0.0 {
                greater = hdot;
            } else {
                less = hdot;
            }
            let newton = hdot - excess / slope;
            if newton == hdot {
                return Ok(hdot);
            }
            let next = if slope < 0.0 && newton > greater && newton < less {
                newton
            } else if greater.is_finite() && less.is_finite() {
                0.5 * (greater + less)
            } else {
                break;
            };
            if next == hdot || (less - greater).abs() <= f64::EPSILON * hdot.abs() {
                return Ok(hdot);
            }
            hdot = next;
        }
        let what = format!("no squeeze velocity gives the load {load:e} N/m of a film of {:e} m", inp.h);
        Err(EvalError::recoverable(MODEL, what))
    }

    /// The squeeze velocity of a film that is nowhere clipped and whose oil does not thicken: the load there is `load` at least.
    fn below(&mut self, inp: &FaceIn, load: f64) -> Result<f64, EvalError> {
        self.place(inp)?;
        self.floor = self.reduce(inp.p_cav)?;
        let ends = [self.reduce(inp.p_bottom)?, self.reduce(inp.p_top)?];
        self.rho.fill(1.0);
        self.rho_rate.fill(0.0);
        self.integrate(inp, 0.0, ends);
        let (mut sum, mut rate) = (0.0, 0.0);
        for j in 0..self.n() {
            sum += self.weight(j) * (self.pi[j] - self.floor);
            rate += self.weight(j) * self.pi_rate[j];
        }
        Ok((load / self.dx - sum) / rate)
    }
}

impl Hydrodynamics for RheologyGrid {
    fn evaluate(&mut self, inp: &FaceIn, hdot: f64) -> Result<FaceOut, EvalError> {
        self.solve(inp, hdot, self.rounds)?;
        let o = self.result(inp);
        let all = o.load + o.squeeze_damping + o.ring_shear + o.liner_shear + o.slope_force;
        if all.is_finite() {
            Ok(o)
        } else {
            Err(EvalError::recoverable(MODEL, format!("the film overflows for {inp:?}, hdot = {hdot:e}")))
        }
    }

    fn squeeze_rate(&mut self, inp: &FaceIn, load: f64) -> Result<f64, EvalError> {
        if !load.is_finite() {
            return Err(EvalError::fatal(MODEL, format!("the load is {load} N/m")));
        }
        let start = self.below(inp, load)?;
        let plain = self.search(inp, load, start, 0)?;
        // What the density changes is little near the answer, and anything far from it.
        if self.rounds > 0 { self.search(inp, load, plain, self.rounds) } else { Ok(plain) }
    }

    fn profile(&mut self, inp: &FaceIn, hdot: f64, out: &mut [(f64, f64, f64)]) -> Result<(), EvalError> {
        self.solve(inp, hdot, self.rounds)?;
        let panels = self.n() - 1;
        let parts = out.len().saturating_sub(1).max(1) as f64;
        for (i, o) in out.iter_mut().enumerate() {
            let part = i as f64 / parts;
            let k = ((part * panels as f64) as usize).min(panels - 1);
            let f = part * panels as f64 - k as f64;
            let at = |v: &[f64]| (1.0 - f) * v[k] + f * v[k + 1];
            *o = (part * self.length, inp.h + at(&self.drops), inp.p_cav + at(&self.p));
        }
        Ok(())
    }
}
