//! What is told of one instant of a cycle.

use gudgeon_core::EvalError;

use super::assembly::Assembly;
use super::trajectory::{Between, Trajectory};
use gudgeon_scene::RunError;

/// Columns of the series: name and unit.
pub const COLUMNS: [(&str, &str); 34] = [
    ("piston.v", "m/s"),
    ("piston.a", "m/s2"),
    ("cylinder.p", "Pa"),
    ("skirt.e_top", "m"),
    ("skirt.e_bottom", "m"),
    ("skirt.e_top_rate", "m/s"),
    ("skirt.e_bottom_rate", "m/s"),
    ("skirt.tilt", "rad"),
    ("skirt.side_force", "N"),
    ("skirt.side_moment", "N m"),
    ("skirt.friction_force", "N"),
    ("skirt.friction_power", "W"),
    ("skirt.lateral_energy", "J"),
    ("rod.side_force", "N"),
    ("pin.moment", "N m"),
    ("rings.side_force", "N"),
    ("inertia.force", "N"),
    ("thrust.film_force", "N"),
    ("thrust.contact_force", "N"),
    ("thrust.viscous_force", "N"),
    ("thrust.rubbing_force", "N"),
    ("thrust.h_min", "m"),
    ("thrust.p_max", "Pa"),
    ("anti_thrust.film_force", "N"),
    ("anti_thrust.contact_force", "N"),
    ("anti_thrust.viscous_force", "N"),
    ("anti_thrust.rubbing_force", "N"),
    ("anti_thrust.h_min", "m"),
    ("anti_thrust.p_max", "Pa"),
    ("skirt.oil_up", "m3/s"),
    ("skirt.oil_down", "m3/s"),
    ("skirt.oil_aside", "m3/s"),
    ("skirt.yield", "m"),
    ("skirt.oil_filled", "1"),
];
/// Of these, the ones of inertia across the bore, of oil flow, of yielding and of the oil that is kept, which are not always there.
pub const INERTIA: usize = 16;
/// Flow of oil over the edges.
pub const OIL: std::ops::Range<usize> = 29..32;
/// Yielding of the skirt.
pub const YIELD: usize = 32;
/// Part of the gaps that is filled.
pub const FILLED: usize = 33;

/// Values of all columns at an instant.
pub type Row = [f64; COLUMNS.len()];

/// Where a column stands.
#[must_use]
pub fn index(name: &str) -> usize {
    COLUMNS.iter().position(|c| c.0 == name).unwrap_or(0)
}

/// Distance from a crank angle at which one of its sides is looked at \[rad\]: where the gas or the sense of motion jumps.
const ASIDE: f64 = 1e-9;
/// Part of a velocity, and of a clearance per radian, by which that of a balance may differ from that of the states.
const NEAR: f64 = 0.1;
/// Crank angle within which a step of the oil has not begun \[rad\]: what rounding leaves of the ends of steps.
const SAME: f64 = 1e-11;

/// A cycle and the piston that made it, looked at.
pub struct Look<'a> {
    /// The piston, at the place looked at last.
    pub a: &'a mut Assembly,
    /// The cycle.
    pub trajectory: &'a Trajectory,
    flows: bool,
    y: Vec<f64>,
    x: Vec<f64>,
    w: Vec<f64>,
    /// Crank angle looked at last \[rad\].
    theta: f64,
    /// Step of the oil looked at last, when the skirt keeps any.
    oil_step: Option<usize>,
}

impl<'a> Look<'a> {
    /// At `trajectory` of `a`; `flows`: with the oil that crosses the edges.
    #[must_use]
    pub fn new(a: &'a mut Assembly, trajectory: &'a Trajectory, flows: bool) -> Self {
        let n = a.piston.coordinates();
        let y = vec![0.0; a.layout.n];
        Self { a, trajectory, flows, y, x: vec![0.0; n], w: vec![0.0; n], theta: 0.0, oil_step: None }
    }

    /// What stopped a look.
    #[must_use]
    pub fn stopped(&self, source: EvalError) -> RunError {
        RunError::Eval { theta_deg: self.theta.to_degrees(), source }
    }

    /// Goes to the states and the coordinates at `t`.
    fn go(&mut self, t: f64) {
        self.theta = t;
        for (i, y) in self.y.iter_mut().enumerate() {
            *y = self.trajectory.state(t, i);
        }
        self.a.coordinates(&self.y, &mut self.x);
    }

    /// Displacements of the upper and the lower edge at `t` \[m\].
    #[must_use]
    pub fn edges(&self, t: f64) -> [f64; 2] {
        self.edges_of(|i| self.trajectory.state(t, i))
    }

    /// Their means over the cycle \[m\].
    #[must_use]
    pub fn mean_edges(&self) -> [f64; 2] {
        self.edges_of(|i| self.trajectory.mean(i))
    }

    /// Displacements of both edges for the states of the lateral motion \[m\].
    fn edges_of(&self, state: impl Fn(usize) -> f64) -> [f64; 2] {
        let y: Vec<f64> = self.a.layout.motion.clone().map(state).collect();
        self.a.motion.pose(&y).e
    }

    /// Smallest gap on each side at `t` \[m\]; no film is solved.
    ///
    /// # Errors
    /// A gap that is none.
    pub fn gaps(&mut self, t: f64) -> Result<[f64; 2], EvalError> {
        self.go(t);
        let speed = self.a.instant(t).speed;
        self.a.piston.gaps(&self.x, speed)
    }

    /// Smallest gap where solid contact is summed, less the range of contact, on each side at `t` \[m\].
    pub fn contact_gaps(&mut self, t: f64) -> [f64; 2] {
        self.go(t);
        self.a.piston.contact_gaps(&self.x)
    }

    /// Normal pressure of solid contact along the rows of each side \[Pa\] at the instant looked at last.
    pub fn contact_pressures(&mut self) -> [Vec<f64>; 2] {
        self.a.piston.contact_pressures(&self.x)
    }

    /// Fills the films as they were at `t`; where two steps of the oil meet, as at the end of the first one. What the second one fills stops the piston within
    /// microseconds, by pressures that go with the step.
    fn fill_as(&mut self, t: f64) {
        let Some(oil) = self.trajectory.oil.as_ref().filter(|o| !o.steps.is_empty()) else { return };
        let part = (t - SAME) / self.a.period * oil.steps.len() as f64;
        let k = (part.max(0.0) as usize).min(oil.steps.len() - 1);
        if self.oil_step != Some(k) {
            self.a.piston.set_filling(&oil.steps[k].filling);
            self.oil_step = Some(k);
        }
    }

    /// Flow of the oil over upper edges, lower edges and flanks at the instant looked at last \[m³/s\].
    fn oil_flow(&mut self, now: &gudgeon_skirt::Instant) -> Result<[f64; 3], EvalError> {
        match (self.trajectory.oil.as_ref(), self.oil_step) {
            _ if !self.flows => Ok([0.0; 3]),
            (Some(oil), Some(k)) => Ok(oil.steps[k].flow),
            _ => self.a.piston.oil_flow(now, &self.w),
        }
    }

    /// Part of the gaps that was filled at the end of the step of the oil looked at last; all of them where no oil is kept.
    fn filled(&self) -> f64 {
        self.trajectory.oil.as_ref().zip(self.oil_step).map_or(1.0, |(oil, k)| oil.steps[k].filled)
    }

    /// Sets the piston in motion as at `t`, just before it (`side` below 0), there, or just after it.
    ///
    /// # Errors
    /// A film that cannot be solved, no balance.
    fn move_as(&mut self, t: f64, side: f64) -> Result<gudgeon_skirt::Instant, EvalError> {
        self.go(t);
        let now = self.a.instant(t + side * ASIDE);
        self.fill_as(t + side * ASIDE);
        let (n, speed) = (self.a.layout.n, self.a.clearance * self.a.omega());
        let (motion, piston) = (&mut self.a.motion, &mut self.a.piston);
        let own = &self.y[self.a.layout.motion.clone()];
        piston.add(motion.added(own));
        if self.trajectory.between == Between::Nothing {
            let at_end = self.trajectory.end_at(t).map(|k| self.trajectory.at_end(k));
            for (i, w) in self.w.iter_mut().enumerate() {
                *w = speed * at_end.map_or_else(|| self.trajectory.state(t, n + i), |y| y[n + i]);
            }
            piston.place(&now, &self.x)?;
            return Ok(now);
        }
        let mut asked = piston.ask(&now, &self.x, &mut self.w);
        let v = motion.velocities(own, &|k| self.trajectory.slope(t, k), &mut asked)?;
        asked.end(v)?;
        // Films that are not full hold little: a balance far from the velocity that the states give is none of theirs.
        let far = |a: f64, b: f64| (a - b).abs() > NEAR * (speed + b.abs());
        let given = motion.pose(own).v.filter(|_| self.oil_step.is_some());
        if let Some(given) = given.filter(|g| far(v[0], g[0]) || far(v[1], g[1])) {
            piston.ask(&now, &self.x, &mut self.w).end(given)?;
        }
        Ok(now)
    }

    /// Pressures of both sides at `t`, above that of the crankcase, at the nodes of the whole sides \[Pa\].
    ///
    /// # Errors
    /// A film that cannot be solved.
    pub fn pressures(&mut self, t: f64) -> Result<[Vec<f64>; 2], EvalError> {
        self.row(t, 0.0)?;
        Ok([0, 1].map(|k: usize| self.a.piston.sides[k].pressure()))
    }

    /// The row at `t`, just before it (`side` below 0), there, or just after it.
    ///
    /// # Errors
    /// A film that cannot be solved, no balance.
    pub fn row(&mut self, t: f64, side: f64) -> Result<Row, EvalError> {
        let now = self.move_as(t, side)?;
        let (x, w) = (&self.x, &self.w);
        let s = self.a.piston.summary(&now, x, w)?;
        let friction = s.friction();
        let moment: f64 = s.film_moment.iter().chain(&s.contact_moment).sum();
        let oil = self.oil_flow(&now)?;
        // Where velocities are states they are smooth, and those of a balance are not quite.
        let v = self.a.motion.pose(&self.y[self.a.layout.motion.clone()]).v;
        let (x, w) = (&self.x, &self.w);
        let yields = x[2..].iter().fold(0.0_f64, |y, q| y.max(q.abs()));
        let mut row = [
            now.speed,
            now.acceleration,
            now.pressure + self.a.p_crankcase,
            x[0],
            x[1],
            w[0],
            w[1],
            (x[0] - x[1]) / self.a.piston.body.length,
            s.side_force(),
            moment,
            friction,
            -friction * now.speed,
            self.a.piston.lateral_energy(v.unwrap_or([w[0], w[1]])),
            s.rod,
            s.pin_moment,
            s.groove,
            s.net[0],
            s.film[0],
            s.contact[0],
            s.film_friction[0],
            s.contact_friction[0],
            s.gap[0],
            s.p_max[0],
            s.film[1],
            s.contact[1],
            s.film_friction[1],
            s.contact_friction[1],
            s.gap[1],
            s.p_max[1],
            oil[0],
            oil[1],
            oil[2],
            yields,
            self.filled(),
        ];
        // Adding zero turns -0 into 0.
        row.iter_mut().for_each(|v| *v += 0.0);
        Ok(row)
    }
}
