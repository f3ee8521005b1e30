//! Forces on the rings at an instant.

use std::f64::consts::PI;

use gudgeon_core::EvalError;
use gudgeon_core::geometry::RingSection;
use gudgeon_core::kinds::{
    FaceForces, FlankIn, OilFaceIn, RadialLoads, RadialMotion, RadialState, RingForces, TwistMoments,
};
use gudgeon_numerics::elementary;

use super::loads::{Loads, face_in, furthest, wet_faces};
use super::pack::Pack;

/// Standard acceleration used by both sources \[m/s²\].
const GRAVITY: f64 = 9.8;

impl Pack {
    /// Ring `i` between the pressures of the instant.
    fn section(&self, i: usize) -> RingSection<'_> {
        let r = &self.at.rings[i];
        RingSection::new(&self.geo.rings[i], &self.at.places[i], self.geo.bore_radius)
            .under(r.p_above, r.p_below, r.p_back, r.p_cav)
    }

    /// Circumference that turns forces per length into forces \[m\].
    pub(super) fn perimeter(&self, i: usize) -> f64 {
        self.laws.radial_gas.circumference(&self.section(i))
    }

    /// Load of tension alone, per circumference \[N/m\] of one rail.
    pub fn tension(&self, i: usize) -> f64 {
        self.rings[i].pull / self.perimeter(i)
    }

    /// Radial load that the face must carry above `p_cav`, per circumference \[N/m\] of one rail, without flank friction.
    pub fn radial_load(&self, i: usize) -> f64 {
        self.tension(i) + self.gas_load(i)
    }

    /// The part of it that gas presses on.
    fn gas_load(&self, i: usize) -> f64 {
        self.laws.radial_gas.load(&self.section(i))
    }

    /// What presses ring `i` against the liner and what carries it where it is, and its radial motion, which asks for that.
    pub(super) fn loads(&mut self, i: usize) -> (Loads<'_>, &mut dyn RadialMotion) {
        let contact = self.rings[i].contact.load(self.at.places[i].h);
        let (mut loads, radial) = self.trials(i);
        loads.state.contact = contact;
        (loads, radial)
    }

    /// The same for a motion that tries film thicknesses, each of which tells what contact carries.
    pub(super) fn trials(&mut self, i: usize) -> (Loads<'_>, &mut dyn RadialMotion) {
        let section = self.section(i);
        let (around, rails) = (self.laws.radial_gas.circumference(&section), section.geometry.rails as f64);
        let tension = self.rings[i].pull / around;
        let load = tension + self.laws.radial_gas.load(&section);
        let perimeter = around * rails;
        let (geo, place, at) = (&self.geo.rings[i], &self.at.places[i], &self.at.rings[i]);
        let (ring, oil) = (&mut self.rings[i], self.oil_pack.as_deref_mut());
        let line = &ring.contact;
        let state = RadialState {
            thickness: place.h,
            load,
            tension,
            contact: f64::NAN,
            contact_range: line.range,
            dry: at.dry.0,
            lowest: (line.lowest(self.limits.min_film), line.band()),
            furthest: furthest(geo, place),
            resists: ring.resists,
            carries: ring.resists || line.carries(),
            has_friction: ring.friction.is_some(),
            faces: ring.films.len(),
        };
        let loads = Loads {
            geo,
            place,
            at,
            ring: i,
            oil,
            dry: at.dry,
            contact: line,
            state,
            u: -self.at.piston.v,
            perimeter,
            shares: if ring.films.len() == 2 { self.laws.twin_land_friction.shares() } else { [1.0; 2] },
            films: &mut ring.films,
            friction: ring.friction.as_deref(),
            flux: self.at.rings[i].flux,
            count: &mut self.counters.film,
        };
        (loads, &mut *ring.radial)
    }

    /// Film of ring `i` at squeeze velocity `hdot`, summed over the lands.
    ///
    /// # Errors
    /// What the film refuses.
    pub fn film(&mut self, i: usize, hdot: f64) -> Result<FaceForces, EvalError> {
        let (mut loads, _) = self.loads(i);
        let (film, flux, perimeter) = (loads.film(hdot), loads.flux, loads.perimeter);
        let r = &mut self.at.rings[i];
        (r.flux, r.perimeter) = (flux, perimeter);
        film
    }

    /// Sets the highest film pressure of ring `i`, which only records need.
    ///
    /// # Errors
    /// What the film refuses.
    pub fn film_peak(&mut self, i: usize) -> Result<(), EvalError> {
        let mut high = 0.0_f64;
        for land in 0..self.rings[i].films.len() {
            let inp =
                face_in(&self.geo.rings[i], self.at.places[i].h, &self.at.rings[i], -self.at.piston.v, land);
            self.counters.film += 1;
            high = high.max(self.rings[i].films[land].evaluate(&inp, self.at.rings[i].hdot)?.p_max);
        }
        self.at.rings[i].film_p_max = high;
        Ok(())
    }

    /// Tilts the films of ring `i` as it twists, and lets them reach as far as its oil does.
    pub(super) fn wet(&mut self, i: usize) -> Result<(), EvalError> {
        if self.layout.twists[i] {
            // Where the outer edge rises, the top of the face leaves the liner.
            let tilt = -self.at.places[i].twist;
            if !self.rings[i].films.iter_mut().all(|f| f.set_tilt(tilt)) {
                return Err(EvalError::fatal("ring_pack", "this film cannot be tilted"));
            }
        }
        let Some(oil) = &mut self.oil_pack else { return Ok(()) };
        let (r, h) = (&mut self.at.rings[i], self.at.places[i].h);
        r.dry = wet_faces(&mut **oil, i, h, (&self.geo.rings[i], r), &mut self.rings[i].films)?;
        Ok(())
    }

    /// Film thickness at which ring `i` is flush with its land or touches the groove root \[m\]: it cannot retreat further.
    #[must_use]
    pub fn furthest(&self, i: usize) -> f64 {
        furthest(&self.geo.rings[i], &self.at.places[i])
    }

    /// Film thickness that ring `i` does not go below \[m\].
    #[must_use]
    pub fn lowest(&self, i: usize) -> f64 {
        self.rings[i].contact.lowest(self.limits.min_film)
    }

    /// Radial motion of ring `i` for its states `y`: sets `load`, `contact`, `hdot` and the rates of the states.
    pub(super) fn radial_rates(&mut self, i: usize, y: &[f64]) -> Result<(), EvalError> {
        self.wet(i)?;
        let own = self.layout.radial[i].clone();
        let mut dy = std::mem::take(&mut self.dy);
        let (mut loads, radial) = self.loads(i);
        let outcome = radial.rates(&y[own.clone()], &mut loads, &mut dy[own]).and_then(|found| {
            let film = found.film.map_or_else(|| loads.film(found.hdot), Ok)?;
            Ok((found, film))
        });
        let (load, contact, flux, perimeter) =
            (loads.state.load, loads.state.contact, loads.flux, loads.perimeter);
        self.dy = dy;
        let r = &mut self.at.rings[i];
        (r.flux, r.perimeter) = (flux, perimeter);
        let (found, film) = outcome?;
        (r.load, r.contact, r.limited) = (load, contact, found.limited);
        (r.hdot, r.film, r.film_known) = (found.hdot, film, true);
        Ok(())
    }

    /// Friction and film force of ring `i` at its `hdot`. Needs its radial motion or a given `hdot` and `load`.
    pub(super) fn friction(&mut self, i: usize) -> Result<(), EvalError> {
        let o = if self.at.rings[i].film_known {
            self.at.rings[i].film
        } else {
            self.film(i, self.at.rings[i].hdot)?
        };
        let weight = self.floor_weight(i);
        let line = &self.rings[i].contact;
        let r = &mut self.at.rings[i];
        r.film = o;
        if line.floor_replaces_film {
            r.contact = weight * r.load.max(0.0);
            r.limited.floor = r.contact;
        } else if weight > 0.0 {
            r.limited.floor = weight * (r.load - r.dry.0 - r.contact - o.load).max(0.0);
            if line.floor.is_some() {
                r.contact += r.limited.floor;
            }
        }
        self.rub(i, weight)
    }

    /// How much of ring `i` rests on its floor: there the surfaces carry what the film does not; under the least film nothing real does.
    fn floor_weight(&self, i: usize) -> f64 {
        let lowest = self.lowest(i);
        let above = self.at.places[i].h - lowest;
        if lowest <= 0.0 {
            0.0
        } else if self.hard_floor {
            f64::from(u8::from(above <= 1e-6 * lowest))
        } else {
            1.0 - (above / (self.rings[i].contact.band() * lowest)).clamp(0.0, 1.0)
        }
    }

    /// Load of ring `i` for the pressures of the instant, and the friction of a film and a contact that are known.
    pub(super) fn friction_beside(&mut self, i: usize) -> Result<(), EvalError> {
        self.at.rings[i].load = self.radial_load(i);
        self.rub(i, self.floor_weight(i))
    }

    /// Friction and film force of ring `i` for its film and its contact, the part `weight` of it resting on a floor.
    fn rub(&mut self, i: usize, weight: f64) -> Result<(), EvalError> {
        let u = -self.at.piston.v;
        let line = &self.rings[i].contact;
        let r = &mut self.at.rings[i];
        let rubbing = match &self.rings[i].rubbing {
            None => line.friction * r.contact * elementary::tanh(u / self.limits.friction_speed),
            Some(friction) => friction.force(line, self.at.places[i].h, r.contact, u)?,
        };
        let (o, viscous) = (r.film, if line.floor_replaces_film { 1.0 - weight } else { 1.0 });
        r.friction = r.perimeter * (viscous * self.laws.drag.shear(&o) + rubbing);
        r.power = self.laws.drag.power(r.friction, u);
        r.boundary_power = self.laws.drag.power(r.perimeter * rubbing, u);
        let force = self.laws.film_force.per_length(&o, r.dry.1);
        r.axial.film = r.perimeter * (viscous * force + rubbing);
        Ok(())
    }

    /// Rates of the oil under ring `i` for the film of the instant.
    pub(super) fn oil_rates(&mut self, i: usize) {
        let Some(oil) = &mut self.oil_pack else { return };
        let (r, h, u) = (&self.at.rings[i], self.at.places[i].h, -self.at.piston.v);
        let dy = &mut self.dy[self.layout.oil.clone()];
        for k in 0..oil.faces().len() {
            let (ring, land) = oil.faces()[k];
            if ring == i {
                oil.rates(k, &OilFaceIn { h, hdot: r.hdot, u, flux: r.flux[land] }, dy);
            }
        }
    }

    /// What happens to ring `i` in its groove: its motion, and the oil on the flanks.
    pub(super) fn in_groove(&mut self, i: usize, y: &[f64]) -> Result<(), EvalError> {
        if self.plan.axial {
            self.axial_forces(i, y)?;
        }
        self.flank_rates(i, y)
    }

    /// Rates of the oil on the flanks of ring `i`.
    pub(super) fn flank_rates(&mut self, i: usize, y: &[f64]) -> Result<(), EvalError> {
        let own = self.layout.flank[i].clone();
        if own.is_empty() {
            return Ok(());
        }
        let r = &self.at.rings[i];
        let at = FlankIn::new(&self.at.places[i], r.p_above, r.p_back, r.p_below);
        self.at.rings[i].flank = self.rings[i].flank.rates(&y[own.clone()], &at, &mut self.dy[own])?;
        Ok(())
    }

    /// Axial forces on ring `i`, film excepted, and what its motion adds to them; the rates of its states.
    pub(super) fn axial_forces(&mut self, i: usize, y: &[f64]) -> Result<(), EvalError> {
        self.external_forces(i);
        let own = self.layout.motion[i].clone();
        if own.is_empty() {
            return Ok(());
        }
        let mut forces = RingForces::new(self.at.places[i], self.at.rings[i].axial);
        if self.layout.twists[i] {
            forces = forces.with_twist(self.twist_moments(i));
        }
        let response = self.rings[i].motion.rates(&y[own.clone()], &forces, &mut self.dy[own])?;
        self.at.places[i].v = response.v;
        let r = &mut self.at.rings[i];
        (r.axial.damping, r.reaction) = (response.damping, response.reaction);
        Ok(())
    }

    /// Moments about the middle of the section of ring `i`, those of the flanks and of the oil on them apart. The gas on a flank has a linear profile
    /// from the pressure behind the ring to that of the land; the load of the film acts at the narrowest place of the face.
    ///
    /// ```text
    /// M_gas = 2π r_m w²/12 (p_below - p_above) + 2π r_o (p_above z_u b_u - p_below z_l b_l),   M_film = 2π r_o z_f W + w/2 F_film
    /// ```
    ///
    /// `z_u b_u` first moment of the part of the face above the running face about the middle, `z_f` height of the narrowest place above it.
    fn twist_moments(&self, i: usize) -> TwistMoments {
        let (g, r, place) = (&self.geo.rings[i], &self.at.rings[i], &self.at.places[i]);
        let around = 2.0 * PI * place.r_outer * g.rails as f64;
        let middle = PI * (place.r_inner + place.r_outer);
        let flanks = middle * g.width * g.width / 12.0 * (r.p_below - r.p_above);
        let half = 0.5 * g.face.length();
        let (top, bottom) = (0.5 * g.height - half, 0.5 * (0.5 * g.height + half));
        let beside = around * top * bottom * (r.p_above - r.p_below);
        let offset = g.face.narrowest() - half;
        TwistMoments::new(flanks + beside, around * offset * r.load + 0.5 * g.width * r.axial.film)
    }

    /// Gas, inertia and weight on ring `i`; its film counts where its motion counts it.
    pub(super) fn external_forces(&mut self, i: usize) {
        let gas = self.laws.axial_gas.force(&self.section(i));
        let (g, ring) = (&self.geo.rings[i], &self.rings[i]);
        let r = &mut self.at.rings[i];
        r.axial.gas = gas;
        r.axial.inertia = -g.mass * self.at.piston.a;
        r.axial.expander = ring.expander;
        r.axial.gravity = if ring.counts.1 { -GRAVITY * g.mass } else { 0.0 };
        if !ring.counts.0 {
            r.axial.film = 0.0;
        }
    }
}
