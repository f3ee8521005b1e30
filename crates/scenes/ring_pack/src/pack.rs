//! The assembled ring pack: sub-models, their states, and the evaluation of one instant.
//!
//! The models own their states ([`Layout`]); an instant is evaluated in the order of the physics: places of the rings, gas, and ring by ring the
//! film with its radial motion, the oil, the temperature and the motion in the groove. Independent variable: crank angle.

use std::f64::consts::PI;

use gudgeon_core::EvalError;
use gudgeon_core::geometry::{BackVolume, FlankOil, PackGeometry, RingPlace};
use gudgeon_core::kinds::{
    AxialForces, CylinderPressure, FilmHeat, FilmTemperature, GasFlow, GasIn, GasPartials, Kinematics, Oil,
    OilDrive, OilStep, OilTransport, RingPose,
};
use gudgeon_core::states::{Signals, Stateful};

use super::conventions::Laws;
use super::films_between::{FilmsBetween, Told, tell};
use super::instant::{Counters, Instant, SeatLog};
use super::layout::Layout;
use super::limits::Limits;
use super::liner::LinerShape;
use super::plan::{Names, Plan};
use super::ring::Ring;
use super::twin::Twin;
use super::waveform::Side;

/// Film thickness beyond which a trial state of an integrator is refused, which then takes a smaller step \[m\]: no groove is that deep.
const THICKEST: f64 = 0.1;
/// Film thickness below which one is refused \[m\].
const THINNEST: f64 = 8.756e-27;

/// Floors, caps and drags as numbers.
#[derive(Debug, Clone, Copy)]
pub struct Bounds {
    /// See [`Limits::min_film`].
    pub min_film: f64,
    /// See [`Limits::min_room`].
    pub min_room: f64,
    /// See [`Limits::off_the_liner`].
    pub off_the_liner: f64,
    /// See [`Limits::friction_speed`].
    pub friction_speed: f64,
    /// See [`Limits::thickest_film`].
    pub thickest_film: f64,
}

impl From<&Limits> for Bounds {
    fn from(l: &Limits) -> Self {
        Self {
            min_film: l.min_film.si(),
            min_room: l.min_room.si(),
            off_the_liner: l.off_the_liner.si(),
            friction_speed: l.friction_speed.si(),
            thickest_film: l.thickest_film.si(),
        }
    }
}

/// The assembled scene.
pub struct Pack {
    /// Geometry.
    pub geo: PackGeometry,
    /// Laws of the forces on rings.
    pub laws: Laws,
    /// Floors, caps and drags.
    pub limits: Bounds,
    /// Crank speed \[rad/s\].
    pub omega: f64,
    /// Piston motion.
    pub kinematics: Box<dyn Kinematics>,
    /// Cylinder pressure.
    pub cylinder: Box<dyn CylinderPressure>,
    /// Gas flow.
    pub gas: Box<dyn GasFlow>,
    /// Oil.
    pub oil: Box<dyn Oil>,
    /// Film temperatures.
    pub film_temperature: Box<dyn FilmTemperature>,
    /// Rings.
    pub rings: Vec<Ring>,
    /// Liner distortion.
    pub liner: LinerShape,
    /// Height of the pin at top dead centre \[m\].
    pub y_tdc: f64,
    /// Height of ring 1 above the pin \[m\].
    pub pin_to_ring1: f64,
    /// Crankcase pressure \[Pa\].
    pub p_crankcase: f64,
    /// Oil on the liner and under the faces, when it is followed.
    pub oil_pack: Option<Box<dyn OilTransport>>,
    /// What runs.
    pub plan: Plan,
    /// What rings and lands are called in words.
    pub names: Names,
    /// State layout.
    pub layout: Layout,
    /// States of the gas at 1 bar, their scale in the state vector.
    pub gas_scale: Vec<f64>,
    /// What became of the decisions on seats, per ring.
    pub seat_log: Vec<SeatLog>,
    /// The last instant evaluated.
    pub at: Instant,
    /// Rates of the states of the models at that instant \[1/rad\], those of the gas apart.
    pub dy: Vec<f64>,
    /// Work counters.
    pub counters: Counters,
    /// States of the gas in SI units.
    pub gas_state: Vec<f64>,
    /// Whether friction changes over at a film floor at once, as in the published schemes, and not over a narrow band.
    pub hard_floor: bool,
    /// State of the last complete evaluation.
    pub state: Vec<f64>,
    /// Whether that is an evaluation of all forces, and not of one side.
    pub(super) complete: bool,
    /// The same again, where a second thread works with it.
    pub(super) twin: Option<Twin>,
    /// Films in the step that is looked at, where they are not to be solved again for that.
    pub(super) between: Option<FilmsBetween>,
    /// Film thicknesses of the rings, scratch.
    pub films: Vec<f64>,
    /// Viscosities at the rings, scratch.
    pub viscosities: Vec<f64>,
    /// States that differ in one, scratch of [`Pack::jacobian`].
    pub(super) trial: Vec<f64>,
}

impl Pack {
    /// Number of rings.
    #[must_use]
    pub fn n_rings(&self) -> usize {
        self.rings.len()
    }

    /// Length of the cycle \[rad\].
    #[must_use]
    pub fn period(&self) -> f64 {
        self.cylinder.period()
    }

    /// Shortest interval \[rad\] in which something is decided, if anything is.
    #[must_use]
    pub fn decision_interval(&self) -> Option<f64> {
        self.rings.iter().filter_map(|r| r.motion.decision_interval()).reduce(f64::min)
    }

    /// Calls `f` with every model that may have states, and its part of the state vector.
    pub fn each_block(&mut self, mut f: impl FnMut(&mut dyn Stateful, std::ops::Range<usize>)) {
        f(&mut *self.gas, self.layout.gas.clone());
        for (r, range) in self.rings.iter_mut().zip(&self.layout.radial) {
            f(&mut *r.radial, range.clone());
        }
        for (r, range) in self.rings.iter_mut().zip(&self.layout.motion) {
            f(&mut *r.motion, range.clone());
        }
        for (r, range) in self.rings.iter_mut().zip(&self.layout.flank) {
            f(&mut *r.flank, range.clone());
        }
        if let Some(oil) = &mut self.oil_pack {
            f(&mut **oil, self.layout.oil.clone());
        }
        f(&mut *self.film_temperature, self.layout.temperature.clone());
    }

    /// Tells every model the relative error of a step.
    pub(super) fn set_accuracy(&mut self, accuracy: f64) {
        self.each_block(|b, _| b.set_accuracy(accuracy));
        if let Some(twin) = &mut self.twin {
            twin.pack.set_accuracy(accuracy);
        }
    }

    /// Has the flow through every passage of the gas carried as a quadrature from now on, or no longer: behind the others, so that these and the steps are
    /// what they are without it.
    pub fn follow_passages(&mut self, followed: bool) {
        if let Some(twin) = &mut self.twin {
            twin.pack.follow_passages(followed);
        }
        let count = if followed { self.gas.passages().len() } else { 0 };
        self.layout.passages = count;
        self.at.gas.passages = vec![0.0; count];
    }

    /// Appends what the models remember beside their states to `out`.
    pub fn save(&mut self, out: &mut Vec<f64>) {
        self.each_block(|b, _| b.save(out));
    }

    /// Takes it back.
    pub fn restore_memory(&mut self, saved: &[f64]) {
        let mut rest = saved;
        self.each_block(|b, _| {
            let taken = b.restore(rest);
            rest = &rest[taken..];
        });
    }

    /// Gas in all volumes \[kg\].
    #[must_use]
    pub fn gas_mass(&self) -> f64 {
        self.gas_state[..self.gas.n_masses()].iter().sum()
    }

    /// Liner radius at ring `i` for a pin height \[m\].
    pub(super) fn liner_radius(&self, i: usize, y: f64) -> f64 {
        let x = y - self.y_tdc + self.pin_to_ring1 - self.rings[i].spacing;
        self.geo.bore_radius + self.liner.at(x)
    }

    /// The geometry that follows from film thickness \[m\] and the place in the groove, which `pose` gives for the clearance there.
    pub(super) fn place_at(
        &self,
        i: usize,
        liner_radius: f64,
        h: f64,
        pose: impl FnOnce(f64) -> RingPose,
    ) -> RingPlace {
        let g = &self.geo.rings[i];
        // A ring that has bottomed in its groove keeps a sliver of gas behind it.
        let behind = (g.h_max(liner_radius) - h).max(self.limits.min_room);
        let slope = g.slope_upper + g.slope_lower;
        let clearance = (g.clearance_inner + slope * behind).max(0.0);
        let r_inner = g.root_radius + behind;
        let r_outer = r_inner + g.width;
        let back_volume = match g.back {
            _ if !g.has_room() => 0.0,
            BackVolume::Geometric => {
                0.5 * (2.0 * g.groove_height_inner + slope * behind)
                    * PI
                    * (r_inner * r_inner - g.root_radius * g.root_radius)
            }
            BackVolume::Fixed(v) => v,
            _ => 0.0,
        };
        let p = pose(clearance);
        RingPlace {
            h,
            s: p.s,
            v: p.v,
            clearance,
            lift_fraction: p.lift_fraction,
            twist: p.twist,
            twist_rate: p.twist_rate,
            liner_radius,
            r_inner,
            r_outer,
            back_volume,
            flank: FlankOil::default(),
        }
    }

    /// The place of ring `i` for the states `y`.
    pub(super) fn place(&self, i: usize, liner_radius: f64, y: &[f64]) -> RingPlace {
        let mut place = self.place_in_groove(i, liner_radius, y);
        place.flank = self.rings[i].flank.oil(&y[self.layout.flank[i].clone()], &place);
        place
    }

    /// Places ring `i` for the states `y` after nothing but its film has changed, which leaves it its velocity.
    pub(super) fn place_on_film(&mut self, i: usize, liner_radius: f64, y: &[f64]) {
        let before = self.at.places[i];
        let mut place = self.place_in_groove(i, liner_radius, y);
        place.v = before.v;
        place.flank = if (place.s, place.clearance) == (before.s, before.clearance) {
            before.flank
        } else {
            self.rings[i].flank.oil(&y[self.layout.flank[i].clone()], &place)
        };
        self.at.places[i] = place;
    }

    /// The place of ring `i` in a stage that its own steps are to solve: these tell how far the oil on its flanks reaches, which is as it was until then.
    pub(super) fn place_before_steps(&self, i: usize, liner_radius: f64, y: &[f64]) -> RingPlace {
        let moves = self.plan.axial && !self.layout.motion[i].is_empty();
        if !moves && self.layout.flank[i].is_empty() {
            return self.place(i, liner_radius, y);
        }
        RingPlace { flank: self.at.places[i].flank, ..self.place_in_groove(i, liner_radius, y) }
    }

    /// The place of ring `i` without the oil on its flanks.
    fn place_in_groove(&self, i: usize, liner_radius: f64, y: &[f64]) -> RingPlace {
        let ring = &self.rings[i];
        let own = self.layout.radial[i].clone();
        let h = if own.is_empty() { ring.nominal_film } else { ring.radial.thickness(&y[own]) };
        let own = &y[self.layout.motion[i].clone()];
        self.place_at(i, liner_radius, h, |clearance| ring.motion.pose(own, clearance))
    }

    /// Way of the face of ring `i` below the place of ring 1 at top dead centre \[m\], for a pin height \[m\].
    fn travel(&self, i: usize, pin: f64) -> f64 {
        self.y_tdc - pin + self.rings[i].spacing
    }

    /// Viscosity under ring `i` for a pin height \[m\].
    pub(super) fn viscosity(&self, i: usize, pin: f64, y: &[f64]) -> f64 {
        self.rings[i].mu.unwrap_or_else(|| {
            // Schemes that keep their own state have none of a temperature.
            let own = y.get(self.layout.temperature.clone()).unwrap_or(&[]);
            self.oil.viscosity(self.film_temperature.temperature(i, self.travel(i, pin), own))
        })
    }

    /// Sets places, piston and viscosities for an angle and a state.
    pub fn set_places(&mut self, theta: f64, y: &[f64]) {
        self.locate(theta, y);
        self.set_viscosities(y);
    }

    /// Viscosities of the films at the places of the instant.
    fn set_viscosities(&mut self, y: &[f64]) {
        if self.plan.film {
            let pin = self.at.piston.y;
            (0..self.n_rings()).for_each(|i| self.at.rings[i].mu = self.viscosity(i, pin, y));
        }
    }

    /// The same without viscosities, which films alone need.
    pub(super) fn locate(&mut self, theta: f64, y: &[f64]) {
        self.locate_by(theta, |pack, i, radius| pack.place(i, radius, y));
    }

    /// The same with places that `place` tells for a ring and the radius of the liner there \[m\].
    pub(super) fn locate_by(&mut self, theta: f64, place: impl Fn(&Self, usize, f64) -> RingPlace) {
        self.at.theta = theta;
        self.at.piston = self.kinematics.motion(theta);
        let pin = self.at.piston.y;
        (0..self.n_rings()).for_each(|i| self.at.places[i] = place(self, i, self.liner_radius(i, pin)));
    }

    /// Runs the gas model on `self.gas_state` and copies the pressures to the rings. `p_cylinder` overrides the model.
    pub fn gas(&mut self, p_cylinder: Option<f64>) -> Result<(), EvalError> {
        let inp = GasIn {
            p_cylinder: p_cylinder.unwrap_or_else(|| self.cylinder.pressure(self.at.theta)),
            p_crankcase: self.p_crankcase,
            rings: &self.at.places,
        };
        self.counters.gas += 1;
        self.gas.rates(&inp, &self.gas_state, &mut self.at.dm, &mut self.at.gas)?;
        self.share_pressures();
        Ok(())
    }

    /// The gas model again, where no ring has moved since the last call.
    pub(super) fn gas_standing(&mut self, p_cylinder: f64) -> Result<(), EvalError> {
        let inp = GasIn { p_cylinder, p_crankcase: self.p_crankcase, rings: &self.at.places };
        self.counters.gas += 1;
        self.gas.rates_standing(&inp, &self.gas_state, &mut self.at.dm, &mut self.at.gas)?;
        self.share_pressures();
        Ok(())
    }

    /// The gas model again, after nothing but the place of ring `i` has moved since the last full call.
    pub(super) fn gas_moved(&mut self, i: usize, p_cylinder: f64) -> Result<(), EvalError> {
        let inp = GasIn { p_cylinder, p_crankcase: self.p_crankcase, rings: &self.at.places };
        self.counters.gas += 1;
        self.gas.rates_moved(i, &inp, &self.gas_state, &mut self.at.dm, &mut self.at.gas)?;
        self.share_pressures();
        Ok(())
    }

    /// Derivatives of the gas model by its states at the state of `self.at`, into `out`; `false` when it has none.
    pub(super) fn gas_partials(&mut self, p_cylinder: f64, out: &mut GasPartials) -> Result<bool, EvalError> {
        let inp = GasIn { p_cylinder, p_crankcase: self.p_crankcase, rings: &self.at.places };
        self.counters.gas += 1;
        self.gas.partials(&inp, &self.gas_state, out)
    }

    pub(super) fn share_pressures(&mut self) {
        let Instant { gas, rings, .. } = &mut self.at;
        for ((r, lands), behind) in rings.iter_mut().zip(gas.p_land.windows(2)).zip(&gas.p_back) {
            (r.p_above, r.p_below, r.p_back) = (lands[0], lands[1], *behind);
            r.p_cav = self.laws.cavitation_datum.pressure(self.p_crankcase, r.p_above, r.p_below);
        }
    }

    /// Evaluates the whole scene at crank angle `theta` for state `y`: `self.at` holds the result.
    pub fn evaluate(&mut self, theta: f64, y: &[f64]) -> Result<(), EvalError> {
        self.evaluate_again(theta, y, None)
    }

    /// Whether `self.at` holds all forces at crank angle `theta` for state `y`.
    pub(super) fn is_at(&self, theta: f64, y: &[f64]) -> bool {
        self.complete && self.at.theta == theta && self.state == y
    }

    /// The same for an instant of a step that has been booked since, with what the models remembered then.
    pub fn evaluate_again(&mut self, theta: f64, y: &[f64], memory: Option<&[f64]>) -> Result<(), EvalError> {
        if let Some(memory) = memory {
            self.restore_memory(memory);
        }
        self.begin_instant(theta, y)?;
        self.set_viscosities(y);
        if let (Some(oil), None) = (&mut self.oil_pack, memory) {
            oil.place(&y[self.layout.oil.clone()], self.at.piston.y);
        }
        self.gas(None)?;
        for i in 0..self.n_rings() {
            if self.plan.film {
                self.film_of_ring(i, y)?;
            }
            self.in_groove(i, y)?;
        }
        self.state.copy_from_slice(y);
        self.complete = true;
        Ok(())
    }

    /// Evaluates the forces at an instant of a step: films as they are known between its stages, if they are, and without flows of gas that nobody asks for.
    pub fn evaluate_in_step(&mut self, theta: f64, y: &[f64]) -> Result<(), EvalError> {
        let Some(films) = self.between.take() else { return self.evaluate(theta, y) };
        let done = self.evaluate_beside(films.at(theta), theta, y);
        self.between = Some(films);
        done
    }

    /// The same for films that are known: what these carry, and what they cost, is found for the instant. How fast the oil on the flanks changes is not.
    pub fn evaluate_beside(
        &mut self,
        films: impl Iterator<Item = Told>,
        theta: f64,
        y: &[f64],
    ) -> Result<(), EvalError> {
        self.begin_instant(theta, y)?;
        if self.gas.has_energy() {
            self.gas(None)?;
        } else {
            self.gas_pressures(self.cylinder.pressure(theta))?;
        }
        tell(films, &mut self.at.rings);
        for i in 0..self.n_rings() {
            self.friction_beside(i)?;
            if self.plan.axial {
                self.axial_forces(i, y)?;
            }
        }
        self.state.copy_from_slice(y);
        self.complete = true;
        Ok(())
    }

    /// Sets places and gas of an instant whose states are numbers.
    fn begin_instant(&mut self, theta: f64, y: &[f64]) -> Result<(), EvalError> {
        self.counters.instants += 1;
        if let Some(k) = y.iter().position(|v| !v.is_finite()) {
            return Err(EvalError::recoverable("ring_pack", format!("state {k} is not a number")));
        }
        // Until it is complete, this is the evaluation of no state.
        self.state.fill(f64::NAN);
        self.complete = false;
        self.locate(theta, y);
        if let Some(i) = (0..self.n_rings()).find(|i| !self.film_is_one(*i)) {
            let what = format!("the film of ring {} left the range of films", i + 1);
            return Err(EvalError::recoverable("ring_pack", what));
        }
        for (k, m) in self.gas_state.iter_mut().enumerate() {
            *m = y[k] * self.gas_scale[k];
        }
        Ok(())
    }

    /// Evaluates one side of the scene, the other standing as `y` has it; `axial` are the forces \[N\] of the films along the liner, which the films
    /// know themselves.
    pub(super) fn evaluate_of(
        &mut self,
        side: Side,
        theta: f64,
        y: &[f64],
        axial: &[f64],
    ) -> Result<(), EvalError> {
        self.begin_instant(theta, y)?;
        match side {
            Side::Grooves => {
                self.gas(None)?;
                self.set_film_forces(axial);
                (0..self.n_rings()).try_for_each(|i| self.in_groove(i, y))?;
            }
            Side::Films => {
                self.set_viscosities(y);
                if let Some(oil) = &mut self.oil_pack {
                    oil.place(&y[self.layout.oil.clone()], self.at.piston.y);
                }
                self.gas_pressures(self.cylinder.pressure(theta))?;
                (0..self.n_rings()).try_for_each(|i| self.film_of_ring(i, y))?;
            }
        }
        self.state.copy_from_slice(y);
        Ok(())
    }

    /// Forces \[N\] of the films on the rings along the liner, where they are known from elsewhere.
    pub(super) fn set_film_forces(&mut self, axial: &[f64]) {
        self.at.rings.iter_mut().zip(axial).for_each(|(r, f)| r.axial.film = *f);
    }

    /// Film, friction, oil and temperature of ring `i`.
    pub(super) fn film_of_ring(&mut self, i: usize, y: &[f64]) -> Result<(), EvalError> {
        self.radial_rates(i, y)?;
        self.friction(i)?;
        self.oil_rates(i);
        self.heat(i, y)
    }

    /// Rates of the film temperature of ring `i`.
    fn heat(&mut self, i: usize, y: &[f64]) -> Result<(), EvalError> {
        let own = self.layout.temperature.clone();
        if own.is_empty() {
            return Ok(());
        }
        let travel = self.travel(i, self.at.piston.y);
        let heat = FilmHeat::new(self.at.places[i].h, self.at.rings[i].power, self.at.piston.v.abs(), travel);
        self.film_temperature.rates(i, &y[own.clone()], &heat, &mut self.dy[own])
    }

    /// Whether the film of ring `i` is as thick as films are.
    fn film_is_one(&self, i: usize) -> bool {
        self.layout.radial[i].is_empty() || (THINNEST..THICKEST).contains(&self.at.places[i].h)
    }

    /// Places, pressures, viscosities and the reach of the oil at crank angle `theta` for state `y`: what [`super::measure`] asks for.
    pub fn look(&mut self, theta: f64, y: &[f64]) -> Result<(), EvalError> {
        // What `self.at` holds is no longer an evaluation of any state.
        self.state.fill(f64::NAN);
        self.set_places(theta, y);
        for (k, m) in self.gas_state.iter_mut().enumerate() {
            *m = y[k] * self.gas_scale[k];
        }
        self.gas_pressures(self.cylinder.pressure(theta))?;
        if let Some(oil) = &mut self.oil_pack {
            oil.place(&y[self.layout.oil.clone()], self.at.piston.y);
            for i in 0..self.n_rings() {
                self.wet(i)?;
            }
        }
        Ok(())
    }

    /// Rates of the state by crank angle, and of the quadratures ([`Layout::quads`]) when `f` is longer than the state.
    pub fn rates(&mut self, theta: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        self.evaluate(theta, y)?;
        let dim = self.layout.n;
        f[..dim].iter_mut().enumerate().for_each(|(k, f)| *f = self.rate(k));
        self.quadratures(&mut f[dim..]);
        Ok(())
    }

    /// Rate of state `k` by crank angle \[1/rad\] at the instant evaluated last.
    pub(super) fn rate(&self, k: usize) -> f64 {
        if self.layout.gas.contains(&k) {
            self.at.dm[k] / self.gas_scale[k] * (1.0 / self.omega)
        } else {
            self.dy[k]
        }
    }

    /// Multiplies admitted errors of the states by what the models allow at the instant evaluated last.
    pub(super) fn ease(&self, atol: &mut [f64]) {
        self.gas.ease(&mut atol[self.layout.gas.clone()]);
        for (ring, (motion, flank)) in
            self.rings.iter().zip(self.layout.motion.iter().zip(&self.layout.flank))
        {
            ring.motion.ease(&mut atol[motion.clone()]);
            ring.flank.ease(&mut atol[flank.clone()]);
        }
        self.ease_films(atol);
    }

    /// The same for films, the oil under them and their temperatures.
    pub(super) fn ease_films(&self, atol: &mut [f64]) {
        for (ring, own) in self.rings.iter().zip(&self.layout.radial) {
            ring.radial.ease(&mut atol[own.clone()]);
        }
        if let Some(oil) = &self.oil_pack {
            oil.ease(&mut atol[self.layout.oil.clone()]);
        }
        self.film_temperature.ease(&mut atol[self.layout.temperature.clone()]);
        // Surfaces that touch carry by their roughness, beside which a film much thinner need not be known to its own size.
        for (i, own) in self.layout.radial.iter().enumerate() {
            for k in own.clone() {
                if self.layout.states[k].changes.meets(Signals::FILM_THICKNESS) {
                    atol[k] *= self.rings[i].contact.ease(self.at.places[i].h);
                }
            }
        }
    }

    /// Rates of the quadratures by crank angle, in the order of [`Layout::quads`]; none into an empty `q`.
    pub(super) fn quadratures(&self, q: &mut [f64]) {
        if q.is_empty() {
            return;
        }
        let (per, n) = (1.0 / self.omega, self.rings.len());
        for i in 0..n {
            q[i] = self.at.gas.flow_in[i] * per;
            q[n + 1 + i] = self.at.rings[i].power * per;
            q[2 * n + 1 + i] = self.at.rings[i].boundary_power * per;
            if let Some(k) = self.layout.flank_quad(i) {
                let oil = self.at.rings[i].flank;
                (q[k], q[k + 1]) = (oil.fed * per, oil.lost * per);
            }
        }
        q[n] = self.at.gas.flow_out[n - 1] * per;
        if let Some(k) = self.layout.gas_quad() {
            q[k] = self.at.gas.power * per;
        }
        for (q, flow) in q[self.layout.passage_quad()..].iter_mut().zip(&self.at.gas.passages) {
            *q = flow * per;
        }
    }

    /// All oil per circumference \[m²\] for the states `y`; none when it is not followed.
    #[must_use]
    pub fn oil_total(&self, y: &[f64]) -> f64 {
        self.oil_pack.as_ref().map_or(0.0, |o| o.total(&y[self.layout.oil.clone()]))
    }

    /// Oil on the flanks of all rings per circumference \[m²\] for the states `y`.
    #[must_use]
    pub fn flank_oil(&self, y: &[f64]) -> f64 {
        self.rings.iter().zip(&self.layout.flank).map(|(r, own)| r.flank.volume(&y[own.clone()])).sum()
    }

    /// Books the oil of an accepted step from one instant and its states to another.
    pub fn book_oil(&mut self, (t0, y0): (f64, &[f64]), (t1, y1): (f64, &[f64])) {
        let Some(oil) = &mut self.oil_pack else { return };
        let piston = self.kinematics.motion(t1);
        for ((h, ring), own) in self.films.iter_mut().zip(&self.rings).zip(&self.layout.radial) {
            *h = if own.is_empty() { 0.0 } else { ring.radial.thickness(&y1[own.clone()]) };
        }
        self.viscosities.iter_mut().zip(&self.at.rings).for_each(|(mu, r)| *mu = r.mu);
        let drive = OilDrive {
            dt: (t1 - t0) / self.omega,
            acceleration: piston.a,
            viscosity: &self.viscosities,
            pressures: &self.at.gas.p_land,
        };
        let own = self.layout.oil.clone();
        let (y0, y1) = (&y0[own.clone()], &y1[own]);
        oil.book(&OilStep { y0, y1, pin: piston.y, films: &self.films, drive });
    }

    /// Number of states of all films.
    pub(super) fn films(&self) -> usize {
        self.layout.radial.iter().map(ExactSizeIterator::len).sum()
    }

    /// Whether a ring is off the liner (`solver.limits.off_the_liner`) in the states `y`.
    pub(super) fn retreats(&self, y: &[f64]) -> bool {
        let films = self.rings.iter().zip(&self.layout.radial).filter(|(_, own)| !own.is_empty());
        let mut thickness = films.map(|(ring, own)| ring.radial.thickness(&y[own.clone()]));
        thickness.any(|h| h > self.limits.off_the_liner)
    }

    /// Has the models decide what they decide in steps, from the forces of the last instant. Returns whether anything changed.
    pub fn decide_seats(&mut self) -> bool {
        let mut changed = false;
        for i in 0..self.n_rings() {
            if self.rings[i].is_decided() {
                self.external_forces(i);
                let motion = &mut self.rings[i].motion;
                self.seat_log[i].decide(motion.decided());
                changed |= motion.decide(&self.at.rings[i].axial);
                self.seat_log[i].decided(motion.decided());
            }
        }
        changed
    }

    /// The states with which the first cycle starts, all lands at `pressure` \[Pa\].
    pub fn initial(&mut self, pressure: f64, y: &mut [f64]) {
        self.each_block(|b, own| {
            // A model whose states are not integrated here starts anew too.
            let mut none = vec![0.0; b.states().len()];
            if own.is_empty() { b.initial(&mut none) } else { b.initial(&mut y[own]) }
        });
        let films: Vec<f64> = (0..self.n_rings())
            .map(|i| match self.layout.radial[i].clone() {
                own if own.is_empty() => 0.0,
                own => self.rings[i].radial.thickness(&y[own]),
            })
            .collect();
        if let Some(oil) = &mut self.oil_pack {
            oil.first(&films, &mut y[self.layout.oil.clone()]);
        }
        self.set_places(0.0, y);
        self.fill_gas(pressure, self.cylinder.pressure(0.0));
        for k in self.layout.gas.clone() {
            y[k] = self.gas_state[k] / self.gas_scale[k];
        }
        for r in &mut self.at.rings {
            r.hdot = 0.0;
            r.axial = AxialForces::default();
        }
        if let Some(twin) = &mut self.twin {
            twin.pack.initial(pressure, &mut vec![0.0; y.len()]);
        }
    }
}
