//! What solvers ask of a pack that keep their own state and march through its parts one by one.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::{GasIn, Limited, RingPose};

use super::loads::flank_load;
use super::pack::Pack;

impl Pack {
    /// [`Pack::gas`] within explicit gas steps; `moved`: whether a ring or a volume has moved since the step before.
    ///
    /// # Errors
    /// What the gas model refuses: after a step that was too long, a volume that holds less than nothing.
    pub fn gas_step(&mut self, p_cylinder: f64, moved: bool) -> Result<(), EvalError> {
        let found = if moved { self.gas(Some(p_cylinder)) } else { self.gas_standing(p_cylinder) };
        found.map_err(|e| {
            let advice = "explicit gas steps may be too long for it: raise `solver.gas_steps`";
            EvalError::fatal("as_published", format!("{e}; {advice}"))
        })
    }

    /// Sets the place of ring `i` for the piston position of `self.at`: at height and velocity `s` in its groove, or where its motion has it.
    pub fn set_place(&mut self, i: usize, h: f64, s: Option<(f64, f64)>) {
        let liner_radius = self.liner_radius(i, self.at.piston.y);
        let motion = &self.rings[i].motion;
        self.at.places[i] = self.place_at(i, liner_radius, h, |clearance| match s {
            Some((s, v)) => RingPose::at_height(s, v, clearance),
            None => motion.pose(&[], clearance),
        });
    }

    /// Sets place and viscosity of one ring for the piston position of `self.at`.
    pub fn refresh_ring(&mut self, i: usize, h: f64, s: Option<(f64, f64)>) {
        self.set_place(i, h, s);
        if self.plan.film {
            self.at.rings[i].mu = self.viscosity(i, self.at.piston.y, &[]);
        }
    }

    /// Fills the gas volumes for lands at `pressure` \[Pa\] with the places of `self.at`.
    pub fn fill_gas(&mut self, pressure: f64, p_cylinder: f64) {
        let p = vec![pressure; self.n_rings() + 1];
        let inp = GasIn { p_cylinder, p_crankcase: self.p_crankcase, rings: &self.at.places };
        self.gas.at_pressures(&inp, &p, &mut self.gas_state);
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

    /// Pressures for the state of the gas as it is, shared with the rings.
    pub fn gas_pressures(&mut self, p_cylinder: f64) -> Result<(), EvalError> {
        let inp = GasIn { p_cylinder, p_crankcase: self.p_crankcase, rings: &self.at.places };
        self.gas.pressures(&inp, &self.gas_state, &mut self.at.gas)?;
        self.share_pressures();
        Ok(())
    }

    /// Radial force of the flank friction per circumference \[N/m\] of one rail.
    #[must_use]
    pub fn radial_friction(&self, i: usize, hdot: f64) -> f64 {
        let Some(f) = &self.rings[i].friction else { return 0.0 };
        f.force(hdot, flank_load(&self.at.places[i], &self.at.rings[i]))
            / (self.perimeter(i) * self.geo.rings[i].rails as f64)
    }
}
