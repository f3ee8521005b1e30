//! The assembled ring pack: sub-models, layout of the state vector, and the evaluation of one instant.
//!
//! State vector, in this order: gas masses, each over its mass at 1 bar; `ln h` of every ring with a film; for every ring
//! that moves freely the height `s / c0` and the velocity `v / (c0 ω)`, `c0` its nominal clearance. Independent
//! variable: crank angle.

use std::f64::consts::PI;

use gudgeon_core::EvalError;
use gudgeon_core::geometry::{BackVolume, PackGeometry, RingPlace};
use gudgeon_core::kinds::{
    AxialForces, CylinderPressure, FaceForces, FaceIn, FilmTemperature, FlankDamping, FlankFriction, GasFlow,
    GasIn, GasOut, GasSlopes, Hydrodynamics, Kinematics, Motion, Oil, PistonMotion, RingMotion,
};

use super::contact_line::ContactLine;
use super::hold::Hold;
use super::oil::OilPack;
use super::plan::Plan;
use crate::case::{
    AxialGas, CavitationDatum, Conventions, Drag, FilmForce, Hoop, Limits, RadialGas, TwinLandFriction,
};

/// Standard acceleration used by both sources \[m/s²\].
const GRAVITY: f64 = 9.8;
/// Part of the velocity of surfaces that part within which one step of Newton ends at the root.
const PARTING: f64 = 1e-5;
/// Radial velocity over its limit at which a film holds nothing that it would let go of at a higher one.
const AWAY: f64 = 1e3;
/// Film thickness beyond which a trial state of an integrator is refused, which then takes a smaller step \[m\]: no groove is that deep.
const THICKEST: f64 = 0.1;

/// [`Limits`] as numbers.
#[derive(Debug, Clone, Copy)]
pub struct Bounds {
    /// See [`Limits::least_film`].
    pub least_film: f64,
    /// See [`Limits::least_load`].
    pub least_load: f64,
    /// See [`Limits::radial_speed`].
    pub radial_speed: f64,
    /// See [`Limits::radial_drag`].
    pub radial_drag: f64,
    /// See [`Limits::contact_drag`].
    pub contact_drag: f64,
    /// See [`Limits::drag_from`] and `drag_full`.
    pub drag_counts: (f64, f64),
    /// See [`Limits::drag_gap_from`] and `drag_gap_full`.
    pub drag_gap: (f64, f64),
    /// See [`Limits::retreat_band`].
    pub retreat_band: f64,
    /// See [`Limits::least_room`].
    pub least_room: f64,
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
            least_film: l.least_film.si(),
            least_load: l.least_load.si(),
            radial_speed: l.radial_speed.si(),
            radial_drag: l.radial_drag.si(),
            contact_drag: l.contact_drag.si(),
            drag_counts: (l.drag_from.si(), l.drag_full.si()),
            drag_gap: (l.drag_gap_from.si(), l.drag_gap_full.si()),
            retreat_band: l.retreat_band.si(),
            least_room: l.least_room.si(),
            off_the_liner: l.off_the_liner.si(),
            friction_speed: l.friction_speed.si(),
            thickest_film: l.thickest_film.si(),
        }
    }
}

/// What limits did to a ring at an instant.
#[derive(Debug, Clone, Copy, Default)]
pub struct Limited {
    /// Load on the least film or on the floor of a contact model \[N/m\].
    pub floor: f64,
    /// Load that the drag took \[N/m\].
    pub drag: f64,
    /// Load that the drag of surfaces in contact took \[N/m\].
    pub contact_drag: f64,
    /// Part of the velocity that the cap took.
    pub slowed: f64,
    /// Load that the film is given beyond what it has to carry \[N/m\].
    pub lifted: f64,
    /// Load that the upper end of a search interval took \[N/m\].
    pub thickest: f64,
}

/// Work counters.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counters {
    /// Evaluations of the whole scene.
    pub instants: u64,
    /// Film solves and evaluations, one per face.
    pub film: u64,
    /// Calls of the gas model.
    pub gas: u64,
}

/// Liner radius growth over the height above the pin at top dead centre; positions ascending.
#[derive(Debug, Clone, Default)]
pub struct LinerShape {
    /// Heights \[m\].
    pub position: Vec<f64>,
    /// Radial growth \[m\].
    pub growth: Vec<f64>,
}

impl LinerShape {
    /// Radial growth at a height \[m\].
    pub fn at(&self, x: f64) -> f64 {
        let n = self.position.len();
        if n == 0 {
            return 0.0;
        }
        let i = self.position.partition_point(|p| *p <= x).clamp(1, n - 1);
        let (x0, x1) = (self.position[i - 1], self.position[i]);
        self.growth[i - 1] + (self.growth[i] - self.growth[i - 1]) * (x - x0) / (x1 - x0)
    }
}

/// One ring with its models.
pub struct RingModel {
    /// One film per running land, upper land first. Empty when no film is needed.
    pub films: Vec<Box<dyn Hydrodynamics>>,
    /// Whether the films resist being squeezed; without them the ring rides on its contact alone.
    pub resists: bool,
    /// Solid contact of the whole face as a function of film thickness.
    pub contact: ContactLine,
    /// Axial motion.
    pub motion: Box<dyn RingMotion>,
    /// Its kind, asked once.
    pub kind: Motion,
    /// Oil in the groove.
    pub damping: Box<dyn FlankDamping>,
    /// Radial friction.
    pub friction: Box<dyn FlankFriction>,
    /// Distance below ring 1 \[m\].
    pub spacing: f64,
    /// Nominal clearance \[m\], the scale of the axial states.
    pub clearance0: f64,
    /// Viscosity when it does not change over the cycle \[Pa s\].
    pub mu: Option<f64>,
    /// Film thickness used when there is no film \[m\].
    pub nominal_film: f64,
}

impl RingModel {
    /// Whether anything could carry the ring against the liner: a film, or contact.
    #[must_use]
    pub fn carries(&self) -> bool {
        self.resists || self.contact.range > 0.0 || self.contact.floor.is_some()
    }
}

/// One ring at an instant.
#[derive(Debug, Clone, Copy, Default)]
pub struct RingInstant {
    /// Film thickness rate \[m/s\].
    pub hdot: f64,
    /// Viscosity \[Pa s\].
    pub mu: f64,
    /// Pressures above, below, behind \[Pa\].
    pub p_above: f64,
    /// Below.
    pub p_below: f64,
    /// Behind.
    pub p_back: f64,
    /// Pressure at which the film cavitates \[Pa\].
    pub p_cav: f64,
    /// Radial load on the face, above `p_cav`, per circumference \[N/m\] of one rail.
    pub load: f64,
    /// Part of it that solid contact carries \[N/m\].
    pub contact: f64,
    /// Part of the load \[N/m\] that gas on the dry parts of the face carries, and their force along the liner, from the bottom
    /// edge to the top edge positive.
    pub dry: (f64, f64),
    /// Film, summed over the lands.
    pub film: FaceForces,
    /// Flux at the lower end of each land's film \[m²/s\].
    pub flux: [f64; 2],
    /// Highest pressure of the film \[Pa\], as of the last [`Pack::film_peak`].
    pub film_p_max: f64,
    /// Whether `film` belongs to `hdot`.
    pub film_known: bool,
    /// Whether `hdot` is a root of the balance of film, contact and friction that nothing else has changed.
    pub balanced: bool,
    /// Friction that the convention counts \[N\], whole ring, along the liner's velocity.
    pub friction: f64,
    /// Friction power \[W\].
    pub power: f64,
    /// Axial forces on the whole ring \[N\].
    pub axial: AxialForces,
    /// Reaction of the flanks \[N\].
    pub reaction: f64,
    /// What limits did.
    pub limited: Limited,
}

/// Everything at an instant.
#[derive(Debug, Clone, Default)]
pub struct Instant {
    /// Crank angle \[rad\].
    pub theta: f64,
    /// Piston motion.
    pub piston: PistonMotion,
    /// Pressures and flows.
    pub gas: GasOut,
    /// Rates of the gas masses \[kg/s\].
    pub dm: Vec<f64>,
    /// Places of the rings.
    pub places: Vec<RingPlace>,
    /// The rings.
    pub rings: Vec<RingInstant>,
}

/// Decisions on the seat of one ring.
#[derive(Debug, Clone, Copy, Default)]
pub struct SeatLog {
    /// Seat before the last decision, when that changed it.
    left: Option<f64>,
    /// Changes of seat.
    pub changes: u32,
    /// Changes that the very next decision took back.
    pub reversals: u32,
}

impl SeatLog {
    fn decided(&mut self, before: f64, after: f64) {
        let changed = before != after;
        self.changes += u32::from(changed);
        self.reversals += u32::from(changed && self.left == Some(after));
        self.left = changed.then_some(before);
    }
}

/// Where things are in the state vector.
#[derive(Debug, Clone, Default)]
pub struct Layout {
    /// Number of gas states.
    pub gas: usize,
    /// Index of `ln h` per ring.
    pub film: Vec<Option<usize>>,
    /// Index of the height per ring; the velocity follows.
    pub axial: Vec<Option<usize>>,
    /// Index of the first volume of oil, when oil is followed.
    pub oil: Option<usize>,
    /// Number of states.
    pub n: usize,
}

/// The assembled scene.
pub struct Pack {
    /// Geometry.
    pub geo: PackGeometry,
    /// Conventions.
    pub conv: Conventions,
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
    pub rings: Vec<RingModel>,
    /// Liner distortion.
    pub liner: LinerShape,
    /// Height of ring 1 above the pin \[m\].
    pub pin_to_ring1: f64,
    /// Crankcase pressure \[Pa\].
    pub p_crankcase: f64,
    /// Oil on the liner and under the faces, when it is followed.
    pub oil_pack: Option<OilPack>,
    /// What runs.
    pub plan: Plan,
    /// State layout.
    pub layout: Layout,
    /// Masses of the gas volumes at 1 bar \[kg\], the scale of the gas states.
    pub mass_scale: Vec<f64>,
    /// Seats of the rings whose motion is decided in steps (0, ½, 1).
    pub seats: Vec<f64>,
    /// What became of the decisions on seats, per ring.
    pub seat_log: Vec<SeatLog>,
    /// The last instant evaluated.
    pub at: Instant,
    /// Work counters.
    pub counters: Counters,
    /// Masses, unscaled, scratch.
    pub masses: Vec<f64>,
    /// Whether friction changes over at a film floor at once, as in the published schemes, and not over a narrow band.
    pub hard_floor: bool,
    /// State of the last complete evaluation.
    pub state: Vec<f64>,
    /// What holds each ring that moves freely otherwise, see [`super::hold`].
    pub holds: Vec<Hold>,
    /// Tolerance that the holding of rings goes by; 0: no ring is ever held.
    pub hold_tolerance: f64,
    /// How fast the axial balance of a held ring falls with its velocity \[N s/m\], while a Jacobian is built; else 0.
    pub tangents: Vec<f64>,
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

    /// Whether any ring's seat is decided in steps; the smallest interval \[rad\].
    #[must_use]
    pub fn decision_interval(&self) -> Option<f64> {
        self.rings
            .iter()
            .filter_map(|r| if let Motion::Discrete { interval } = r.kind { Some(interval) } else { None })
            .reduce(f64::min)
    }

    /// Liner radius at ring `i` for a pin height \[m\].
    fn liner_radius(&self, i: usize, y: f64) -> f64 {
        let x = y - self.kinematics.y_tdc() + self.pin_to_ring1 - self.rings[i].spacing;
        self.geo.bore_radius + self.liner.at(x)
    }

    /// The geometry that follows from film thickness and axial position.
    pub fn place(&self, i: usize, liner_radius: f64, h: f64, s: Option<(f64, f64)>) -> RingPlace {
        let g = &self.geo.rings[i];
        // A ring that has bottomed in its groove keeps a sliver of gas behind it.
        let behind = (g.h_max(liner_radius) - h).max(self.limits.least_room);
        let slope = g.slope_upper + g.slope_lower;
        let clearance = (g.clearance_inner + slope * behind).max(0.0);
        let r_inner = g.root_radius + behind;
        let r_outer = r_inner + g.width;
        let back_volume = match g.back {
            BackVolume::Geometric => {
                0.5 * (2.0 * g.groove_height_inner + slope * behind)
                    * PI
                    * (r_inner * r_inner - g.root_radius * g.root_radius)
            }
            BackVolume::Fixed(v) => v,
            BackVolume::Drained | BackVolume::Sealed => 0.0,
        };
        let (s, v, e) = match (s, self.rings[i].kind) {
            (Some((s, v)), _) => (s, v, if clearance > 0.0 { (s / clearance).clamp(0.0, 1.0) } else { 0.0 }),
            (None, Motion::Fixed { e }) => (e * clearance, 0.0, e),
            (None, _) => (self.seats[i] * clearance, 0.0, self.seats[i]),
        };
        RingPlace { h, s, v, clearance, e, liner_radius, r_inner, r_outer, back_volume }
    }

    /// Viscosity under ring `i` for a pin height \[m\].
    fn viscosity(&self, i: usize, y: f64) -> f64 {
        self.rings[i].mu.unwrap_or_else(|| {
            let travel = self.kinematics.y_tdc() - y + self.rings[i].spacing;
            self.oil.viscosity(self.film_temperature.temperature(i, travel))
        })
    }

    /// Sets places, piston and viscosities for an angle and a state.
    pub fn set_places(&mut self, theta: f64, y: &[f64]) {
        self.at.theta = theta;
        self.at.piston = self.kinematics.motion(theta);
        let pin = self.at.piston.y;
        for i in 0..self.n_rings() {
            let h = self.layout.film[i].map_or(self.rings[i].nominal_film, |k| y[k].exp());
            let s = self.layout.axial[i].map(|k| {
                let c0 = self.rings[i].clearance0;
                (y[k] * c0, y[k + 1] * c0 * self.omega)
            });
            self.at.places[i] = self.place(i, self.liner_radius(i, pin), h, s);
            if self.plan.film {
                self.at.rings[i].mu = self.viscosity(i, pin);
            }
        }
    }

    /// Sets the place of one ring directly, for solvers that keep their own state.
    pub fn set_place(&mut self, i: usize, h: f64, s: Option<(f64, f64)>) {
        let r = self.liner_radius(i, self.at.piston.y);
        self.at.places[i] = self.place(i, r, h, s);
    }

    /// Runs the gas model on `self.masses` and copies the pressures to the rings. `p_cylinder` overrides the model.
    pub fn gas(&mut self, p_cylinder: Option<f64>) -> Result<(), EvalError> {
        let inp = GasIn {
            p_cylinder: p_cylinder.unwrap_or_else(|| self.cylinder.pressure(self.at.theta)),
            p_crankcase: self.p_crankcase,
            rings: &self.at.places,
        };
        self.counters.gas += 1;
        self.gas.rates(&inp, &self.masses, &mut self.at.dm, &mut self.at.gas)?;
        self.share_pressures();
        Ok(())
    }

    /// The gas model again, after nothing but the place of ring `i` has moved since the last full call.
    fn gas_moved(&mut self, i: usize, p_cylinder: f64) -> Result<(), EvalError> {
        let inp = GasIn { p_cylinder, p_crankcase: self.p_crankcase, rings: &self.at.places };
        self.counters.gas += 1;
        self.gas.rates_moved(i, &inp, &self.masses, &mut self.at.dm, &mut self.at.gas)?;
        self.share_pressures();
        Ok(())
    }

    /// Derivatives of the gas model by the masses at the state of `self.at`, into `out`; `false` when it has none.
    fn gas_slopes(&mut self, p_cylinder: f64, out: &mut GasSlopes) -> Result<bool, EvalError> {
        let inp = GasIn { p_cylinder, p_crankcase: self.p_crankcase, rings: &self.at.places };
        self.counters.gas += 1;
        self.gas.slopes(&inp, &self.masses, out)
    }

    /// Pressures after a small change of mass `k` \[kg\] from `base`.
    fn shift_pressures(&mut self, k: usize, d_mass: f64, base: &Base) {
        let (m, s) = (self.layout.gas, &base.slopes);
        for (i, p) in self.at.gas.p_land.iter_mut().enumerate() {
            *p = base.gas.p_land[i] + s.p_land[i * m + k] * d_mass;
        }
        for (i, p) in self.at.gas.p_back.iter_mut().enumerate() {
            *p = base.gas.p_back[i] + s.p_back[i * m + k] * d_mass;
        }
        self.share_pressures();
    }

    fn share_pressures(&mut self) {
        for i in 0..self.n_rings() {
            let r = &mut self.at.rings[i];
            (r.p_above, r.p_below, r.p_back) =
                (self.at.gas.p_land[i], self.at.gas.p_land[i + 1], self.at.gas.p_back[i]);
            r.p_cav = match self.conv.cavitation_datum {
                CavitationDatum::Absolute => 0.0,
                CavitationDatum::Gauge => self.p_crankcase.min(r.p_above).min(r.p_below),
            };
        }
    }

    /// Circumference that turns forces per length into forces \[m\].
    fn perimeter(&self, i: usize) -> f64 {
        match self.conv.radial_gas {
            RadialGas::BorePerimeter => 2.0 * PI * self.geo.bore_radius,
            _ => 2.0 * PI * self.at.places[i].r_outer,
        }
    }

    /// Load of tension alone, per circumference \[N/m\] of one rail.
    pub fn tension(&self, i: usize) -> f64 {
        let g = &self.geo.rings[i];
        let f = g.tangential_force / g.rails as f64;
        match self.conv.hoop {
            Hoop::Correct => 2.0 * PI * f / self.perimeter(i),
            Hoop::AsPrinted => 2.0 * f / self.perimeter(i),
        }
    }

    /// Radial load that the face must carry above `p_cav`, per circumference \[N/m\] of one rail, without flank friction.
    pub fn radial_load(&self, i: usize) -> f64 {
        let (g, r, place) = (&self.geo.rings[i], &self.at.rings[i], &self.at.places[i]);
        let back = g.height * (r.p_back - r.p_cav);
        let inner = place.r_inner / place.r_outer;
        self.tension(i)
            + match self.conv.radial_gas {
                RadialGas::BorePerimeter => back,
                RadialGas::BackOnly => back * inner,
                RadialGas::BackAndFace => back * inner - self.gas_beside_face(i),
                RadialGas::BackFaceAndGap => back * inner + self.gas_in_gap(i) - self.gas_beside_face(i),
            }
    }

    /// Load of the lands above `p_cav` on the parts of the face outside the running face, per circumference \[N/m\].
    fn gas_beside_face(&self, i: usize) -> f64 {
        let (g, r) = (&self.geo.rings[i], &self.at.rings[i]);
        let rest = g.height - g.lands as f64 * g.face.length();
        if g.lands == 2 {
            rest * (r.p_below - r.p_cav)
        } else {
            0.5 * rest * (r.p_above + r.p_below - 2.0 * r.p_cav)
        }
    }

    /// Radial load of the gas on the end faces of the gap above `p_cav`, per circumference \[N/m\]: their force over the outer radius.
    fn gas_in_gap(&self, i: usize) -> f64 {
        let (g, r, place) = (&self.geo.rings[i], &self.at.rings[i], &self.at.places[i]);
        let land = 0.5 * (g.piston_radius_above + g.piston_radius_below);
        let land = land.clamp(place.r_inner, place.r_outer);
        let between = 0.5 * (r.p_above + r.p_below) - r.p_cav;
        let force = (r.p_back - r.p_cav) * (land - place.r_inner) + between * (place.r_outer - land);
        g.height * force / place.r_outer
    }

    /// Axial load that presses the flanks together, as the radial friction laws take it \[N\].
    fn flank_load(&self, i: usize) -> f64 {
        let r = &self.at.rings[i];
        0.5 * self.at.places[i].flank_area() * (r.p_below - r.p_above).abs()
    }

    fn face_in(&self, i: usize, land: usize) -> FaceIn {
        let (g, r) = (&self.geo.rings[i], &self.at.rings[i]);
        // The space between the lands of a twin-land ring is drained to below the ring.
        let p_top = if g.lands == 2 && land == 1 { r.p_below } else { r.p_above };
        FaceIn {
            h: self.at.places[i].h,
            u: -self.at.piston.v,
            p_bottom: r.p_below,
            p_top,
            p_cav: r.p_cav,
            mu: r.mu,
        }
    }

    /// Film of ring `i` at squeeze velocity `hdot`, summed over the lands.
    ///
    /// # Errors
    /// What the film refuses.
    pub fn film(&mut self, i: usize, hdot: f64) -> Result<FaceForces, EvalError> {
        let lands = self.rings[i].films.len();
        let mut sum = FaceForces::default();
        for land in 0..lands {
            let inp = self.face_in(i, land);
            self.counters.film += 1;
            let o = self.rings[i].films[land].forces(&inp, hdot)?;
            let twice = lands == 2 && self.conv.twin_land_friction == TwinLandFriction::LowerTwice;
            let share = if !twice {
                1.0
            } else if land == 1 {
                2.0
            } else {
                0.0
            };
            self.at.rings[i].flux[land] = o.flux;
            sum.load += o.load;
            sum.load_rate += o.load_rate;
            sum.ring_shear += share * o.ring_shear;
            sum.liner_shear += share * o.liner_shear;
            sum.slope_force += share * o.slope_force;
        }
        Ok(sum)
    }

    /// Load of the film of ring `i` at squeeze velocity `hdot` and its derivative, summed over the lands.
    fn film_load(&mut self, i: usize, hdot: f64) -> Result<(f64, f64), EvalError> {
        let mut sum = (0.0, 0.0);
        for land in 0..self.rings[i].films.len() {
            let inp = self.face_in(i, land);
            self.counters.film += 1;
            let (load, rate) = self.rings[i].films[land].load(&inp, hdot)?;
            sum = (sum.0 + load, sum.1 + rate);
        }
        Ok(sum)
    }

    /// Sets the highest film pressure of ring `i`, which only records need.
    ///
    /// # Errors
    /// What the film refuses.
    pub fn film_peak(&mut self, i: usize) -> Result<(), EvalError> {
        let mut high = 0.0_f64;
        for land in 0..self.rings[i].films.len() {
            let inp = self.face_in(i, land);
            self.counters.film += 1;
            high = high.max(self.rings[i].films[land].evaluate(&inp, self.at.rings[i].hdot)?.p_max);
        }
        self.at.rings[i].film_p_max = high;
        Ok(())
    }

    /// Lets the films of ring `i` reach as far as its oil does.
    fn wet(&mut self, i: usize) -> Result<(), EvalError> {
        let Some(oil) = &mut self.oil_pack else { return Ok(()) };
        let (r, h) = (&mut self.at.rings[i], self.at.places[i].h);
        r.dry = (0.0, 0.0);
        for f in oil.faces.iter_mut().filter(|f| f.ring == i) {
            let (from, to) = f.set_reach(h);
            if !self.rings[i].films[f.land].set_extent(from, to) {
                return Err(EvalError::fatal(
                    "ring_pack",
                    "this film cannot be confined to a part of its face",
                ));
            }
            let upper = self.geo.rings[i].lands == 2 && f.land == 1;
            let (bottom, top) = (r.p_below - r.p_cav, if upper { r.p_below } else { r.p_above } - r.p_cav);
            let d = f.drops();
            r.dry.0 += bottom * from + top * (f.length - to);
            r.dry.1 -= bottom * (d[1] - d[0]) + top * (d[3] - d[2]);
        }
        Ok(())
    }

    /// Rates of the oil volumes of ring `i` for the film of the instant.
    fn oil_rates(&mut self, i: usize) {
        let Some(oil) = &mut self.oil_pack else { return };
        let (r, h, u) = (&self.at.rings[i], self.at.places[i].h, -self.at.piston.v);
        for k in 0..oil.faces.len() {
            if oil.faces[k].ring == i {
                oil.set_rates(k, h, r.hdot, u, r.flux[oil.faces[k].land]);
            }
        }
    }

    /// Film thickness at which ring `i` is flush with its land or touches the groove root \[m\]: it cannot retreat further.
    #[must_use]
    pub fn furthest(&self, i: usize) -> f64 {
        let (g, liner) = (&self.geo.rings[i], self.at.places[i].liner_radius);
        g.h_max(liner).min(liner - g.piston_radius_above)
    }

    /// Film thickness that ring `i` does not go below \[m\]: the floor that its contact model names, the least film under surfaces that
    /// do not take any load, else none.
    #[must_use]
    pub fn lowest(&self, i: usize) -> f64 {
        let line = &self.rings[i].contact;
        line.floor.unwrap_or(if line.open { 0.0 } else { self.limits.least_film })
    }

    /// Squeeze velocity \[m/s\] from the radial balance. Sets `load`, `contact` and `hdot` of the ring.
    pub fn radial_balance(&mut self, i: usize) -> Result<(), EvalError> {
        self.wet(i)?;
        let load = self.radial_load(i);
        let h = self.at.places[i].h;
        let contact = self.rings[i].contact.load(h);
        let least = self.limits.least_load * self.tension(i);
        // Smooth maximum: equal to the load within least²/load.
        let soft = |w: f64| 0.5 * (w + (w * w + 4.0 * least * least).sqrt());
        let needed = load - contact - self.at.rings[i].dry.0;
        let r = &mut self.at.rings[i];
        (r.load, r.contact, r.limited, r.balanced) = (load, contact, Limited::default(), false);
        if !self.rings[i].resists {
            self.dry_balance(i, needed);
            return Ok(());
        }
        let lowest = self.lowest(i);
        if h <= lowest {
            // On the floor: does the film at rest carry less than it must?
            let film = self.film(i, 0.0)?;
            let all = soft(needed + self.radial_friction(i, 0.0));
            if film.load <= all {
                let r = &mut self.at.rings[i];
                (r.hdot, r.film, r.film_known) = (0.0, film, true);
                return Ok(());
            }
        }
        let (found, film) = self.balanced(i, needed, soft)?;
        let parts = contact > 0.0 && found > 0.0;
        let dragged = if parts { found } else { self.dragged(i, found, needed, soft)? };
        let hdot = self.bounded(i, dragged, lowest);
        // Off its limits a ring moves as its film allows, and the film found with the velocity is the film of the instant.
        let balanced = (hdot - found).abs() <= 1e-6 * found.abs();
        let film = film.filter(|_| balanced);
        let r = &mut self.at.rings[i];
        (r.hdot, r.film_known, r.balanced) = (hdot, film.is_some(), balanced);
        r.film = film.unwrap_or(r.film);
        r.limited.lifted = soft(needed) - needed;
        if parts {
            self.at.rings[i].limited.contact_drag = self.contact_drag(i) * found;
        }
        Ok(())
    }

    /// The velocity at which film and contact carry `needed`, surfaces that part against their drag; and the film, where it came with the velocity.
    fn balanced(
        &mut self,
        i: usize,
        needed: f64,
        soft: impl Fn(f64) -> f64,
    ) -> Result<(f64, Option<FaceForces>), EvalError> {
        let drag = self.contact_drag(i);
        if self.rings[i].films.len() > 1 || !self.rings[i].friction.is_off() {
            return Ok((self.solve_balance(i, needed, drag, soft)?, None));
        }
        // A ring that parted from the liner an instant ago still does, most often.
        let parting = drag > 0.0 && self.at.rings[i].hdot > 0.0;
        if parting {
            let hdot = self.solve_balance(i, needed, drag, &soft)?;
            if hdot > 0.0 {
                return Ok((hdot, None));
            }
        }
        self.counters.film += 1;
        let inp = self.face_in(i, 0);
        let (hdot, film) = match self.rings[i].films[0].carry(&inp, soft(needed)) {
            Ok((hdot, film)) => (hdot, Some(film)),
            Err(e) => (self.lets_go(i, soft(needed), e)?, None),
        };
        self.at.rings[i].flux[0] = film.map_or(0.0, |f| f.flux);
        if drag == 0.0 || hdot <= 0.0 || parting {
            return Ok((hdot, film));
        }
        self.at.rings[i].hdot = 0.0;
        Ok((self.solve_balance(i, needed, drag, &soft)?, None))
    }

    /// A velocity beyond every limit, for a film that carries more than `load` however fast it is drawn apart: on a coarse grid the pressures at the
    /// edges reach as far in as a point. The limits of the velocity, which it nears as the load falls, then decide; any other failure stays one.
    fn lets_go(&mut self, i: usize, load: f64, failure: EvalError) -> Result<f64, EvalError> {
        let away = AWAY * self.limits.radial_speed;
        let carries =
            failure.is_recoverable() && self.film_load(i, away).is_ok_and(|(carried, _)| carried > load);
        if carries { Ok(away) } else { Err(failure) }
    }

    /// A ring without a film: its contact carries it, and the drag in place of its inertia brings it there.
    fn dry_balance(&mut self, i: usize, needed: f64) {
        let free = if self.rings[i].carries() { -needed / self.limits.radial_drag } else { 0.0 };
        let hdot = self.bounded(i, free, self.lowest(i));
        let r = &mut self.at.rings[i];
        (r.hdot, r.film, r.film_known) = (hdot, FaceForces::default(), true);
        r.limited.drag = self.limits.radial_drag * hdot.abs();
    }

    /// A radial velocity within its cap and within the ends of the way.
    fn bounded(&mut self, i: usize, free: f64, lowest: f64) -> f64 {
        let h = self.at.places[i].h;
        let part = 1.0 / (1.0 + (free / self.limits.radial_speed).powi(2)).sqrt();
        self.at.rings[i].limited.slowed = 1.0 - part;
        if free > 0.0 {
            let furthest = self.furthest(i);
            free * part * ((furthest - h) / (self.limits.retreat_band * furthest)).clamp(0.0, 1.0)
        } else if lowest > 0.0 {
            let band = self.rings[i].contact.band();
            free * part * ((h - lowest) / (band * lowest)).clamp(0.0, 1.0)
        } else {
            free * part
        }
    }

    /// Squeeze velocity with the drag of a ring in place of its inertia: `W(v) = needed + D v`; `free` is that without.
    fn dragged(
        &mut self,
        i: usize,
        free: f64,
        needed: f64,
        soft: impl Fn(f64) -> f64,
    ) -> Result<f64, EvalError> {
        let drag = self.drag(i, free, soft(needed).max(needed.abs()));
        if drag <= 0.0 {
            return Ok(free);
        }
        // The load of the film falls with v and what it has to carry rises: one zero, between standing still and `free`.
        let (mut lo, mut hi) = if free < 0.0 { (free, 0.0) } else { (0.0, free) };
        let mut v = free.clamp(-self.limits.radial_speed, self.limits.radial_speed);
        for _ in 0..60 {
            let (load, rate) = self.film_load(i, v)?;
            let w = needed + drag * v;
            let (g, slope) = (load - soft(w), rate - drag * soft(w) / (2.0 * soft(w) - w));
            if g > 0.0 {
                lo = v
            } else {
                hi = v
            }
            let next = v - g / slope;
            let next = if next > lo && next < hi { next } else { 0.5 * (lo + hi) };
            if (next - v).abs() <= 1e-10 * v.abs() {
                break;
            }
            v = next;
        }
        self.at.rings[i].limited.drag = drag * v.abs();
        Ok(v)
    }

    /// Drag per circumference \[N s/m²\] of ring `i` at the velocity `free` that its film alone allows; `load` is the size of what it carries.
    fn drag(&self, i: usize, free: f64, load: f64) -> f64 {
        let limits = &self.limits;
        let share = limits.radial_drag * free.abs() / load;
        let ((begins, full), (near, far)) = (limits.drag_counts, limits.drag_gap);
        let rough = self.rings[i].contact.range;
        let off = ((self.at.places[i].h / rough - near) / (far - near)).min(1.0);
        if share <= begins || off <= 0.0 {
            return 0.0;
        }
        let x = ((share / begins).ln() / (full / begins).ln()).min(1.0);
        let ramp = |x: f64| x * x * (3.0 - 2.0 * x);
        limits.radial_drag * ramp(x) * ramp(off)
    }

    /// Drag per circumference \[N s/m²\] of the surfaces of ring `i` in contact, while they part.
    fn contact_drag(&self, i: usize) -> f64 {
        let r = &self.at.rings[i];
        if r.contact > 0.0 { self.limits.contact_drag * r.contact / (r.contact + r.load.abs()) } else { 0.0 }
    }

    /// Balance of several lands, with flank friction, or with the drag of surfaces that part: film load less needed load falls with `hdot`; bracket
    /// and Newton.
    fn solve_balance(
        &mut self,
        i: usize,
        needed: f64,
        drag: f64,
        soft: impl Fn(f64) -> f64,
    ) -> Result<f64, EvalError> {
        let perimeter = self.perimeter(i) * self.geo.rings[i].rails as f64;
        let axial = self.flank_load(i);
        let residual = |p: &mut Self, x: f64| -> Result<(f64, f64), EvalError> {
            let (load, rate) = p.film_load(i, x)?;
            let f = &p.rings[i].friction;
            let (fa, dfa) = if f.is_off() {
                (0.0, 0.0)
            } else {
                (f.force(x, axial) / perimeter, f.slope(x, axial) / perimeter)
            };
            let (w, slope) = if x > 0.0 { (needed + fa + drag * x, dfa + drag) } else { (needed + fa, dfa) };
            let all = soft(w);
            Ok((load - all, rate - slope * all / (2.0 * all - w)))
        };
        let (mut lo, mut hi) = (f64::NEG_INFINITY, f64::INFINITY);
        // The velocity of the last evaluation, a small step away, is a good start.
        let mut x = self.at.rings[i].hdot;
        if !x.is_finite() {
            x = 0.0;
        }
        let scale = soft(needed).abs().max(1e-300);
        let mut stride = 1e-4;
        for _ in 0..200 {
            let (f, d) = residual(self, x)?;
            if f.abs() <= 1e-12 * scale {
                return Ok(x);
            }
            // Newton's method squares a small error: the next step from here ends within 1e-9.
            let next = x - f / d;
            // A film that is drawn apart is nearly flat in its velocity, which a small part of the load says little of.
            let parts = drag > 0.0 && x > 0.0;
            let near = if parts { (next - x).abs() <= PARTING * x } else { f.abs() <= 1e-5 * scale };
            if near && next.is_finite() && (drag == 0.0 || (next > 0.0) == (x > 0.0)) {
                return Ok(next);
            }
            if f > 0.0 {
                lo = x
            } else {
                hi = x
            }
            let newton = x - f / d;
            let bracketed = lo.is_finite() && hi.is_finite();
            let inside = newton.is_finite() && newton > lo && newton < hi;
            let next = if inside && (bracketed || (newton - x).abs() <= 1e3 * stride) {
                newton
            } else if bracketed {
                0.5 * (lo + hi)
            } else {
                stride *= 8.0;
                if f > 0.0 { x + stride } else { x - stride }
            };
            if bracketed && (hi - lo) <= 1e-14 * (hi.abs().max(lo.abs())) + 1e-18 || next == x {
                return Ok(x);
            }
            x = next;
        }
        Err(EvalError::recoverable("ring_pack", format!("radial balance of ring {} did not converge", i + 1)))
    }

    /// Friction and film force of ring `i` at its `hdot`. Needs `radial_balance` or a given `hdot` and `load`.
    pub fn friction(&mut self, i: usize) -> Result<(), EvalError> {
        let o = if self.at.rings[i].film_known {
            self.at.rings[i].film
        } else {
            self.film(i, self.at.rings[i].hdot)?
        };
        let u = -self.at.piston.v;
        let perimeter = self.perimeter(i) * self.geo.rings[i].rails as f64;
        let lowest = self.lowest(i);
        let line = &self.rings[i].contact;
        let r = &mut self.at.rings[i];
        r.film = o;
        // On a floor the surfaces carry what the film does not; under the least film nothing real does.
        let mut viscous = 1.0;
        if lowest > 0.0 {
            let above = self.at.places[i].h - lowest;
            let weight = if self.hard_floor {
                f64::from(u8::from(above <= 1e-6 * lowest))
            } else {
                1.0 - (above / (line.band() * lowest)).clamp(0.0, 1.0)
            };
            if line.floor_replaces_film {
                viscous = 1.0 - weight;
                r.contact = weight * r.load.max(0.0);
                r.limited.floor = r.contact;
            } else {
                r.limited.floor = weight * (r.load - r.dry.0 - r.contact - o.load).max(0.0);
                if line.floor.is_some() {
                    r.contact += r.limited.floor;
                }
            }
        }
        let rubbing = line.friction * r.contact * (u / self.limits.friction_speed).tanh();
        let shear = match self.conv.drag {
            Drag::Liner => o.liner_shear,
            Drag::FaceShear => o.ring_shear,
        };
        r.friction = perimeter * (viscous * shear + rubbing);
        r.power = match self.conv.drag {
            Drag::Liner => r.friction * u,
            Drag::FaceShear => (r.friction * u).abs(),
        };
        let force = match self.conv.film_force {
            FilmForce::Total => o.ring_shear + o.slope_force + r.dry.1,
            FilmForce::LinerReaction => o.liner_shear,
            FilmForce::FaceShear => o.ring_shear,
        };
        r.axial.film = perimeter * (viscous * force + rubbing);
        self.oil_rates(i);
        Ok(())
    }

    /// Axial forces on ring `i`, film excepted.
    pub fn axial_forces(&mut self, i: usize) {
        let (g, place, ring) = (&self.geo.rings[i], self.at.places[i], &self.rings[i]);
        let r = &mut self.at.rings[i];
        r.axial.gas = match self.conv.axial_gas {
            AxialGas::FullPerimeter => 2.0 * PI * self.geo.bore_radius * g.width * (r.p_below - r.p_above),
            AxialGas::LinearProfile => 0.5 * place.flank_area() * (r.p_below - r.p_above),
            AxialGas::LaminarProfile => {
                let mean = |a: f64, b: f64| 2.0 / 3.0 * (a * a + a * b + b * b) / (a + b);
                place.flank_area() * (mean(r.p_back, r.p_below) - mean(r.p_back, r.p_above))
            }
        };
        r.axial.inertia = -g.mass * self.at.piston.a;
        r.axial.gravity = if ring.motion.uses_gravity() { -GRAVITY * g.mass } else { 0.0 };
        if !ring.motion.uses_film_force() {
            r.axial.film = 0.0;
        }
        if ring.kind == Motion::Dynamic {
            if self.holds[i] != Hold::Free {
                self.at.places[i].v =
                    if self.tangents[i] > 0.0 { self.moved_velocity(i) } else { self.held_velocity(i) };
            }
            let (place, ring, r) = (&self.at.places[i], &self.rings[i], &mut self.at.rings[i]);
            r.axial.damping = ring.damping.force(place.s, place.v, place.clearance, place.flank_area());
            r.reaction = ring.motion.flank_reaction(place.s, place.v, place.clearance);
        }
    }

    /// Evaluates the whole scene at crank angle `theta` for state `y`: `self.at` holds the result.
    pub fn evaluate(&mut self, theta: f64, y: &[f64]) -> Result<(), EvalError> {
        self.evaluate_holding(theta, y, None)
    }

    /// The same for an instant of a step that has been booked since, with the oil that the faces held at it.
    pub fn evaluate_holding(
        &mut self,
        theta: f64,
        y: &[f64],
        held: Option<&[[f64; 2]]>,
    ) -> Result<(), EvalError> {
        self.counters.instants += 1;
        if let Some(k) = y.iter().position(|v| !v.is_finite()) {
            return Err(EvalError::recoverable("ring_pack", format!("state {k} is not a number")));
        }
        if let Some(i) =
            self.layout.film.iter().position(|k| k.is_some_and(|k| !(-60.0..THICKEST.ln()).contains(&y[k])))
        {
            return Err(EvalError::recoverable(
                "ring_pack",
                format!("the film of ring {} left the range of films", i + 1),
            ));
        }
        self.state.copy_from_slice(y);
        self.set_places(theta, y);
        match (&mut self.oil_pack, held) {
            (Some(oil), None) => oil.set_volumes(y, self.at.piston.y),
            (Some(oil), Some(held)) => oil.hold_volumes(held),
            (None, _) => {}
        }
        for k in 0..self.layout.gas {
            self.masses[k] = y[k] * self.mass_scale[k];
        }
        self.gas(None)?;
        for i in 0..self.n_rings() {
            if self.plan.film {
                self.radial_balance(i)?;
                self.friction(i)?;
            }
            if self.plan.axial {
                self.axial_forces(i);
            }
        }
        Ok(())
    }

    /// Places, pressures and the reach of the oil at crank angle `theta` for state `y`, without flows, films and forces: what
    /// [`super::measure`] asks for.
    pub fn look(&mut self, theta: f64, y: &[f64]) -> Result<(), EvalError> {
        // What `self.at` holds is no longer an evaluation of any state.
        self.state.fill(f64::NAN);
        self.set_places(theta, y);
        for k in 0..self.layout.gas {
            self.masses[k] = y[k] * self.mass_scale[k];
        }
        self.gas_pressures(self.cylinder.pressure(theta))?;
        if let Some(oil) = &mut self.oil_pack {
            oil.set_volumes(y, self.at.piston.y);
            for i in 0..self.n_rings() {
                self.wet(i)?;
            }
        }
        Ok(())
    }

    /// Rates of the state by crank angle, and of the quadratures (flow into each ring, flow out of the last, friction work
    /// of each ring) when `f` is longer than the state.
    pub fn rates(&mut self, theta: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        self.evaluate(theta, y)?;
        let per = 1.0 / self.omega;
        for k in 0..self.layout.gas {
            f[k] = self.at.dm[k] / self.mass_scale[k] * per;
        }
        for i in 0..self.n_rings() {
            if let Some(k) = self.layout.film[i] {
                f[k] = self.at.rings[i].hdot / self.at.places[i].h * per;
            }
            if let Some(k) = self.layout.axial[i] {
                let r = &self.at.rings[i];
                let c0 = self.rings[i].clearance0;
                if self.holds[i] != Hold::Free {
                    f[k] = self.at.places[i].v / (c0 * self.omega);
                    f[k + 1] = 0.0;
                    continue;
                }
                f[k] = y[k + 1];
                f[k + 1] =
                    (r.axial.sum() + r.reaction) / self.geo.rings[i].mass / (c0 * self.omega * self.omega);
            }
        }
        if let Some(oil) = &self.oil_pack {
            for k in 0..oil.faces.len() {
                let (s, unit) = (oil.faces[k].state, oil.unit(k));
                f[s] = oil.faces[k].rate[0] / unit * per;
                f[s + 1] = oil.faces[k].rate[1] / unit * per;
            }
        }
        let q = &mut f[self.layout.n..];
        if !q.is_empty() {
            let n = self.rings.len();
            for i in 0..n {
                q[i] = self.at.gas.flow_in[i] * per;
                q[n + 1 + i] = self.at.rings[i].power * per;
            }
            q[n] = self.at.gas.flow_out[n - 1] * per;
        }
        Ok(())
    }

    /// Books the oil of an accepted step.
    pub fn book_oil(&mut self, v: &dyn gudgeon_numerics::ode::StepView) {
        let Some(oil) = &mut self.oil_pack else { return };
        let pin = self.kinematics.motion(v.t1()).y;
        let film = &self.layout.film;
        oil.book(v.y0(), v.y1(), pin, |i| film[i].map_or(0.0, |k| v.y1()[k].exp()));
    }

    /// Decides the seats of the rings whose motion is decided in steps, from the forces of the last instant. Returns
    /// whether any changed.
    pub fn decide_seats(&mut self) -> bool {
        let mut changed = false;
        for i in 0..self.n_rings() {
            if matches!(self.rings[i].kind, Motion::Discrete { .. }) {
                self.axial_forces(i);
                let e = self.rings[i].motion.seat(&self.at.rings[i].axial);
                changed |= e != self.seats[i];
                self.seat_log[i].decided(self.seats[i], e);
                self.seats[i] = e;
            }
        }
        changed
    }

    /// A state with all lands at `pressure` \[Pa\], films of 3 µm (or on their floor when that is thicker), rings at rest on
    /// the lower flank.
    pub fn initial(&mut self, pressure: f64, y: &mut [f64]) {
        self.seats.fill(0.0);
        for (i, k) in self.layout.film.iter().enumerate() {
            if let Some(k) = k {
                y[*k] = 3e-6f64.max(self.rings[i].contact.floor.unwrap_or(0.0) * 1.5).ln();
            }
        }
        for k in self.layout.axial.iter().flatten() {
            y[*k] = 0.0;
            y[*k + 1] = 0.0;
        }
        if let Some(oil) = &mut self.oil_pack {
            let thickness: Vec<f64> =
                self.layout.film.iter().map(|k| k.map_or(0.0, |k| y[k].exp())).collect();
            oil.start(|i| thickness[i], y);
        }
        self.set_places(0.0, y);
        let n = self.n_rings();
        let p = vec![pressure; n + 1];
        let inp = GasIn {
            p_cylinder: self.cylinder.pressure(0.0),
            p_crankcase: self.p_crankcase,
            rings: &self.at.places,
        };
        self.gas.initial(&inp, &p, &mut self.masses);
        for k in 0..self.layout.gas {
            y[k] = self.masses[k] / self.mass_scale[k];
        }
        for r in &mut self.at.rings {
            r.hdot = 0.0;
            r.axial = AxialForces::default();
        }
    }
}

/// What solvers need that keep their own state and march through the parts one by one.
impl Pack {
    /// [`Pack::gas`] within explicit gas steps.
    ///
    /// # Errors
    /// What the gas model refuses: after a step that was too long, a volume that holds less than nothing.
    pub fn gas_step(&mut self, p_cylinder: f64) -> Result<(), EvalError> {
        self.gas(Some(p_cylinder)).map_err(|e| {
            let advice = "explicit gas steps may be too long for it: raise `solver.gas_steps`";
            EvalError::fatal("as_published", format!("{e}; {advice}"))
        })
    }

    /// Sets place and viscosity of one ring for the piston position of `self.at`.
    pub fn refresh_ring(&mut self, i: usize, h: f64, s: Option<(f64, f64)>) {
        self.set_place(i, h, s);
        if self.plan.film {
            self.at.rings[i].mu = self.viscosity(i, self.at.piston.y);
        }
    }

    /// Fills the gas volumes for lands at `pressure` \[Pa\] with the places of `self.at`.
    pub fn fill_masses(&mut self, pressure: f64, p_cylinder: f64) {
        let p = vec![pressure; self.n_rings() + 1];
        let inp = GasIn { p_cylinder, p_crankcase: self.p_crankcase, rings: &self.at.places };
        self.gas.initial(&inp, &p, &mut self.masses);
    }

    /// Friction of ring `i`, found at `hdot` by a solver of its own.
    ///
    /// # Errors
    /// What the film refuses.
    pub fn friction_at(&mut self, i: usize, hdot: f64) -> Result<(), EvalError> {
        let load = self.radial_load(i);
        let contact = self.rings[i].contact.load(self.at.places[i].h);
        let r = &mut self.at.rings[i];
        (r.hdot, r.film_known, r.load, r.contact) = (hdot, false, load, contact);
        r.limited = Limited::default();
        self.friction(i)?;
        self.film_peak(i)
    }

    /// Pressures for the masses as they are, shared with the rings.
    pub fn gas_pressures(&mut self, p_cylinder: f64) -> Result<(), EvalError> {
        let inp = GasIn { p_cylinder, p_crankcase: self.p_crankcase, rings: &self.at.places };
        self.gas.pressures(&inp, &self.masses, &mut self.at.gas)?;
        self.share_pressures();
        Ok(())
    }

    /// Radial force of the flank friction per circumference \[N/m\] of one rail.
    pub fn radial_friction(&self, i: usize, hdot: f64) -> f64 {
        let f = &self.rings[i].friction;
        if f.is_off() {
            return 0.0;
        }
        f.force(hdot, self.flank_load(i)) / (self.perimeter(i) * self.geo.rings[i].rails as f64)
    }
}

/// How the balance of a ring and its film change with its velocity, about the velocity of the instant.
#[derive(Debug, Clone, Copy, Default)]
struct Tangent {
    /// Balance left at that velocity \[N/m\]; searches end near zero, not there.
    left: f64,
    /// Its derivative \[N s/m²\], below zero.
    slope: f64,
    /// Derivatives of the film.
    film: FaceForces,
    /// Derivatives of the fluxes.
    flux: [f64; 2],
}

/// Part of its load over which the derivatives of a film by its velocity are taken: the root of the accuracy that films are found with.
const FILM_DIFFERENCE: f64 = 1e-6;

impl Tangent {
    fn between(a: &FaceForces, b: &FaceForces, d: f64) -> FaceForces {
        FaceForces {
            load: (b.load - a.load) / d,
            load_rate: (b.load_rate - a.load_rate) / d,
            ring_shear: (b.ring_shear - a.ring_shear) / d,
            liner_shear: (b.liner_shear - a.liner_shear) / d,
            slope_force: (b.slope_force - a.slope_force) / d,
            flux: (b.flux - a.flux) / d,
        }
    }

    /// The film `f` after a change of velocity.
    fn moved(&self, f: &FaceForces, change: f64) -> FaceForces {
        let t = &self.film;
        FaceForces {
            load: f.load + t.load * change,
            load_rate: f.load_rate + t.load_rate * change,
            ring_shear: f.ring_shear + t.ring_shear * change,
            liner_shear: f.liner_shear + t.liner_shear * change,
            slope_force: f.slope_force + t.slope_force * change,
            flux: f.flux + t.flux * change,
        }
    }
}

/// Scratch of [`Pack::jacobian`].
#[derive(Debug, Clone, Default)]
pub struct Base {
    tangents: Vec<Option<Tangent>>,
    rings: Vec<RingInstant>,
    places: Vec<RingPlace>,
    dm: Vec<f64>,
    gas: GasOut,
    slopes: GasSlopes,
    /// Rates of the oil volumes.
    oil: Vec<[f64; 2]>,
}

impl Pack {
    /// Jacobian of [`Pack::rates`] by differences, but for the rows and columns of the gas where its model gives them (row-major, `layout.n` columns, quadratures below the states), `self.at`
    /// holding the evaluation at `y`.
    ///
    /// A perturbation is followed only as far as it reaches: velocities touch nothing but the ring's own force, heights
    /// touch the flows but no pressure, and a film is solved again only when its ring, or a pressure at its ring, moved.
    /// `increment(k)` is the perturbation of state `k`.
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
        for i in 0..self.n_rings() {
            if self.layout.axial[i].is_some() && self.holds[i] != Hold::Free {
                self.tangents[i] = self.held_stiffness(i);
            }
        }
        let outcome = self.columns(y, increment, jac, base);
        self.tangents.fill(0.0);
        outcome
    }

    fn columns(
        &mut self,
        y: &[f64],
        increment: impl Fn(usize) -> f64,
        jac: &mut [f64],
        base: &mut Base,
    ) -> Result<(), EvalError> {
        let n = self.layout.n;
        let theta = self.at.theta;
        jac.fill(0.0);
        base.rings.clone_from(&self.at.rings);
        base.places.clone_from(&self.at.places);
        base.dm.clone_from(&self.at.dm);
        base.gas.clone_from(&self.at.gas);
        base.oil.clear();
        base.oil.extend(self.oil_pack.iter().flat_map(|o| o.faces.iter().map(|f| f.rate)));
        let p_cylinder = self.at.gas.p_land[0];
        debug_assert!(theta.is_finite());
        base.tangents.clear();
        for i in 0..self.n_rings() {
            let tangent = self.tangent(i)?;
            base.tangents.push(tangent);
            self.at.rings[i] = base.rings[i];
        }
        if base.slopes.d_state.len() != self.layout.gas * self.layout.gas {
            base.slopes = GasSlopes::new(self.n_rings(), self.layout.gas);
        }
        let known = self.gas_slopes(p_cylinder, &mut base.slopes)?;
        for k in 0..self.layout.gas {
            let d = increment(k);
            let outcome = if known {
                self.gas_column(k, base, jac);
                self.shift_pressures(k, d * self.mass_scale[k], base);
                self.followers(k, d, None, base, jac)
            } else {
                let keep = self.masses[k];
                self.masses[k] = (y[k] + d) * self.mass_scale[k];
                let outcome = self.gas(Some(p_cylinder)).and_then(|()| self.column(k, d, None, base, jac));
                self.masses[k] = keep;
                outcome
            };
            self.restore(base);
            outcome?;
        }
        if !known {
            // The gas model is to know the unmoved places again.
            self.gas(Some(p_cylinder))?;
        }
        for i in 0..self.n_rings() {
            if let Some(k) = self.layout.film[i] {
                let d = increment(k);
                let s = self.layout.axial[i].map(|_| (base.places[i].s, base.places[i].v));
                self.at.places[i] = self.place(i, base.places[i].liner_radius, (y[k] + d).exp(), s);
                let outcome =
                    self.gas_moved(i, p_cylinder).and_then(|()| self.column(k, d, Some(i), base, jac));
                self.restore(base);
                outcome?;
            }
            if let Some(k) = self.layout.axial[i] {
                let c0 = self.rings[i].clearance0;
                let place = base.places[i];
                let d = increment(k);
                let s = (y[k] + d) * c0;
                self.at.places[i] = self.place(i, place.liner_radius, place.h, Some((s, place.v)));
                let outcome = self.gas_moved(i, p_cylinder);
                if outcome.is_ok() {
                    self.gas_rows(k, d, base, jac);
                    self.axial_forces(i);
                    self.axial_row(i, k, d, base, jac);
                }
                self.restore(base);
                outcome?;
                if self.holds[i] != Hold::Free {
                    continue;
                }
                let d = increment(k + 1);
                self.at.places[i].v = (y[k + 1] + d) * c0 * self.omega;
                self.axial_forces(i);
                jac[k * n + k + 1] = 1.0;
                self.axial_row(i, k + 1, d, base, jac);
                self.restore(base);
            }
        }
        for f in 0..base.oil.len() {
            for side in 0..2 {
                let Some(oil) = &mut self.oil_pack else { break };
                let (i, k, unit) = (oil.faces[f].ring, oil.faces[f].state + side, oil.unit(f));
                let (d, keep) = (increment(k), oil.faces[f].volume[side]);
                oil.faces[f].volume[side] = keep + d * unit;
                let outcome = self.followers(k, d, Some(i), base, jac);
                if let Some(oil) = &mut self.oil_pack {
                    oil.faces[f].volume[side] = keep;
                }
                self.restore(base);
                outcome?;
            }
        }
        Ok(())
    }

    /// Balance of film, contact, friction and the drag of surfaces that part at `hdot`, and its derivative but for that of the film; sets `load` and
    /// `contact` of the ring.
    fn left_over(&mut self, i: usize, hdot: f64, film: f64) -> (f64, f64) {
        let load = self.radial_load(i);
        let contact = self.rings[i].contact.load(self.at.places[i].h);
        let r = &mut self.at.rings[i];
        (r.load, r.contact) = (load, contact);
        let drag = if hdot > 0.0 { self.contact_drag(i) } else { 0.0 };
        let f = &self.rings[i].friction;
        let (fa, dfa) = if f.is_off() {
            (0.0, 0.0)
        } else {
            let (perimeter, axial) = (self.perimeter(i) * self.geo.rings[i].rails as f64, self.flank_load(i));
            (f.force(hdot, axial) / perimeter, f.slope(hdot, axial) / perimeter)
        };
        let w = load - contact - self.at.rings[i].dry.0 + fa + drag * hdot;
        let least = self.limits.least_load * self.tension(i);
        let root = (w * w + 4.0 * least * least).sqrt();
        (film - 0.5 * (w + root), -(dfa + drag) * 0.5 * (1.0 + w / root))
    }

    /// The tangent of ring `i` about the instant; `None` where its velocity is not that of the balance alone, or came with its film by a search that is
    /// as cheap as one evaluation.
    fn tangent(&mut self, i: usize) -> Result<Option<Tangent>, EvalError> {
        let r = self.at.rings[i];
        let pull = r.film.load.abs() / r.film.load_rate.abs();
        let searched = self.plan.film && r.balanced && !r.film_known && r.limited.drag <= 0.0;
        if !(searched && pull > 0.0 && pull.is_finite()) {
            return Ok(None);
        }
        let free = self.drag(i, r.hdot, r.load.abs().max(r.film.load.abs())) <= 0.0;
        if !free || self.at.places[i].h <= self.lowest(i) || self.at.rings[i].limited.floor > 0.0 {
            return Ok(None);
        }
        let d = (FILM_DIFFERENCE * pull).max(FILM_DIFFERENCE * r.hdot.abs());
        let (fluxes, film) = (r.flux, self.film(i, r.hdot + d)?);
        let slope = Tangent::between(&r.film, &film, d);
        let flux = [0, 1].map(|k: usize| (self.at.rings[i].flux[k] - fluxes[k]) / d);
        let (left, rest) = self.left_over(i, r.hdot, r.film.load);
        let all = slope.load + rest;
        Ok((all < 0.0 && all.is_finite()).then_some(Tangent { left, slope: all, film: slope, flux }))
    }

    /// [`Pack::radial_balance`] after a small change, by one step of Newton from the velocity `hdot` before: one evaluation of the film.
    fn moved_balance(&mut self, i: usize, hdot: f64, tangent: &Tangent) -> Result<(), EvalError> {
        self.wet(i)?;
        let film = self.film(i, hdot)?;
        let (left, _) = self.left_over(i, hdot, film.load);
        let change = (tangent.left - left) / tangent.slope;
        let r = &mut self.at.rings[i];
        for (flux, slope) in r.flux.iter_mut().zip(&tangent.flux) {
            *flux += slope * change;
        }
        (r.hdot, r.film, r.film_known, r.limited) =
            (hdot + change, tangent.moved(&film, change), true, Limited::default());
        Ok(())
    }

    fn restore(&mut self, base: &Base) {
        self.at.rings.clone_from(&base.rings);
        self.at.places.clone_from(&base.places);
        self.at.dm.clone_from(&base.dm);
        self.at.gas.clone_from(&base.gas);
    }

    /// Rows of the gas in the column of mass `k`, from the derivatives in `base`.
    fn gas_column(&self, k: usize, base: &Base, jac: &mut [f64]) {
        let (n, rings, m, s) = (self.layout.n, self.n_rings(), self.layout.gas, &base.slopes);
        let per = self.mass_scale[k] / self.omega;
        for r in 0..m {
            jac[r * n + k] = s.d_state[r * m + k] / self.mass_scale[r] * per;
        }
        for r in 0..rings {
            jac[(n + r) * n + k] = s.flow_in[r * m + k] * per;
        }
        jac[(n + rings) * n + k] = s.flow_out[(rings - 1) * m + k] * per;
    }

    fn gas_rows(&self, column: usize, d: f64, base: &Base, jac: &mut [f64]) {
        let (n, rings) = (self.layout.n, self.n_rings());
        let per = 1.0 / (self.omega * d);
        for r in 0..self.layout.gas {
            jac[r * n + column] = (self.at.dm[r] - base.dm[r]) / self.mass_scale[r] * per;
        }
        for r in 0..rings {
            jac[(n + r) * n + column] = (self.at.gas.flow_in[r] - base.gas.flow_in[r]) * per;
        }
        jac[(n + rings) * n + column] =
            (self.at.gas.flow_out[rings - 1] - base.gas.flow_out[rings - 1]) * per;
    }

    fn axial_row(&self, i: usize, column: usize, d: f64, base: &Base, jac: &mut [f64]) {
        if let Some(k) = self.layout.axial[i] {
            if self.holds[i] != Hold::Free {
                let change = self.at.places[i].v - base.places[i].v;
                jac[k * self.layout.n + column] = change / (self.rings[i].clearance0 * self.omega * d);
                return;
            }
            let (a, b) = (&self.at.rings[i], &base.rings[i]);
            let change = (a.axial.sum() + a.reaction) - (b.axial.sum() + b.reaction);
            let scale = self.geo.rings[i].mass * self.rings[i].clearance0 * self.omega * self.omega;
            jac[(k + 1) * self.layout.n + column] = change / (scale * d);
        }
    }

    /// Rows of a column whose perturbation is in place and whose gas is evaluated; `moved` is the ring whose film changed.
    fn column(
        &mut self,
        column: usize,
        d: f64,
        moved: Option<usize>,
        base: &Base,
        jac: &mut [f64],
    ) -> Result<(), EvalError> {
        self.gas_rows(column, d, base, jac);
        self.followers(column, d, moved, base, jac)
    }

    /// Rows of film, motion and friction of such a column.
    fn followers(
        &mut self,
        column: usize,
        d: f64,
        moved: Option<usize>,
        base: &Base,
        jac: &mut [f64],
    ) -> Result<(), EvalError> {
        let (n, rings) = (self.layout.n, self.n_rings());
        for i in 0..rings {
            let (a, b) = (&self.at.rings[i], &base.rings[i]);
            let same = (a.p_above, a.p_below, a.p_back) == (b.p_above, b.p_below, b.p_back);
            if same && moved != Some(i) {
                continue;
            }
            if self.plan.film {
                match base.tangents[i] {
                    Some(tangent) => self.moved_balance(i, base.rings[i].hdot, &tangent)?,
                    None => self.radial_balance(i)?,
                }
                self.friction(i)?;
                let rate = |r: &RingInstant, h: f64| r.hdot / (h * self.omega);
                if let Some(k) = self.layout.film[i] {
                    jac[k * n + column] = (rate(&self.at.rings[i], self.at.places[i].h)
                        - rate(&base.rings[i], base.places[i].h))
                        / d;
                }
                jac[(n + rings + 1 + i) * n + column] =
                    (self.at.rings[i].power - base.rings[i].power) / (self.omega * d);
                if let Some(oil) = &self.oil_pack {
                    for (k, f) in oil.faces.iter().enumerate().filter(|(_, f)| f.ring == i) {
                        let scale = 1.0 / (oil.unit(k) * self.omega * d);
                        for side in 0..2 {
                            jac[(f.state + side) * n + column] = (f.rate[side] - base.oil[k][side]) * scale;
                        }
                    }
                }
            }
            if self.plan.axial {
                self.axial_forces(i);
                self.axial_row(i, column, d, base, jac);
            }
        }
        Ok(())
    }
}
