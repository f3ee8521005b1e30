//! Partial derivatives of the torques beyond the linear line, and the change that a perturbation of the motion makes.

use gudgeon_core::kinds::LinearCoupling;
use gudgeon_numerics::linalg::Complex;

use super::nonlinear::{COARSER, NonlinearTorques, gas_torque, uniform_angle};
use super::spectrum::{spectra, waves};
use crate::interpolant::Place;
use crate::steady::Steady;

impl NonlinearTorques {
    /// Takes the derivatives of the torques at the motion last taken.
    pub fn linearise(&mut self, steady: &Steady, tangents: &[LinearCoupling]) {
        self.partials.iter_mut().for_each(|s| s.fill(0.0));
        self.partials_of_throws(steady);
        self.partials_of_drives(steady);
        self.partials_of_links(steady, tangents);
    }

    fn partials_of_throws(&mut self, steady: &Steady) {
        let (m, few) = (self.fourier.points(), self.coarse.points());
        let line = &steady.line;
        let [x, v, a] = &self.motion;
        let [by_angle, by_speed, by_acceleration] = &mut self.partials;
        for t in &self.throws {
            let (throw, curves) = (&line.throws[t.throw], &mut self.curves[t.curves]);
            let speed = steady.speed * line.nodes[throw.node].ratio;
            for s in 0..few {
                let (i, o) = (t.row * m + COARSER * s, t.row * few + s);
                let at = uniform_angle(line, t.throw, self.cycle, s, few) + x[i];
                let place = Place::of(at);
                if let Some(p) = &mut curves.gas {
                    by_angle[o] += p.derivative_at(place, at, |a| [gas_torque(line, t.throw, a)])[0];
                }
                if let Some(inertia) = &mut curves.inertia {
                    let own = |a: f64| throw.inertia.inertia(a).into();
                    let [j, dj] = inertia.value_at(place, at, own);
                    let [_, ddj] = inertia.derivative_at(place, at, own);
                    let w = speed + v[i];
                    by_angle[o] -= dj * a[i] + 0.5 * ddj * w * w;
                    by_speed[o] -= dj * w;
                    by_acceleration[o] -= j - throw.inertia.mean();
                }
            }
        }
    }

    /// What of a drive goes with its speed; what goes with the angle is small beside it.
    fn partials_of_drives(&mut self, steady: &Steady) {
        let (m, few) = (self.fourier.points(), self.coarse.points());
        let [x, v, _] = &self.motion;
        for d in steady.line.drives.iter().filter(|d| !d.drive.is_linear()) {
            let ratio = steady.line.nodes[d.node].ratio;
            let row = self.active.binary_search(&d.node).unwrap_or(0);
            let speed = steady.speed * ratio;
            for s in 0..few {
                let i = row * m + COARSER * s;
                let even = ratio * self.cycle * s as f64 / few as f64 + d.phase;
                let now = d.drive.torque(even + x[i], speed + v[i]);
                self.partials[1][row * few + s] += d.factor * (now.slope - d.drive.torque(even, speed).slope);
            }
        }
    }

    fn partials_of_links(&mut self, steady: &Steady, tangents: &[LinearCoupling]) {
        let (m, few) = (self.fourier.points(), self.coarse.points());
        let [x, v, _] = &self.motion;
        for l in &mut self.links {
            let coupling = &steady.line.links[l.link].coupling;
            let tangent = tangents[l.link];
            let mean = steady.mean_torque[l.link];
            let own = 1e-6 * (1.0 + mean.abs());
            let give = (coupling.static_twist(mean + own) - coupling.static_twist(mean - own)) / (2.0 * own);
            l.by_load = give * tangent.stiffness - 1.0;
            for s in 0..few {
                let [p, q] = l.rows.map(|r| r * m + COARSER * s);
                let c = coupling.torque(x[p] - l.gear * x[q], v[p] - l.gear * v[q]);
                l.partials[0][s] = c.stiffness - tangent.stiffness;
                l.partials[1][s] = c.damping - tangent.damping;
            }
        }
    }

    /// What a small change of the motion makes of the torques: `angle` as in [`Self::take_motion`], `load` the change of the mean torque
    /// of each link.
    pub fn change(&mut self, angle: &[Complex], omega: f64, load: &[f64], out: &mut [Complex]) {
        let few = self.coarse.points();
        let room = (&mut self.spectrum, &mut self.spare[..few]);
        waves(&mut self.coarse, angle, omega, &mut self.perturbation, room);
        let [x, v, a] = &self.perturbation;
        let [by_angle, by_speed, by_acceleration] = &self.partials;
        let by = by_angle.iter().zip(by_speed).zip(by_acceleration);
        for ((f, ((bx, bv), ba)), ((x, v), a)) in
            self.torque_change.iter_mut().zip(by).zip(x.iter().zip(v).zip(a))
        {
            *f = bx * x + bv * v + ba * a;
        }
        for l in &self.links {
            let [p, q] = l.rows.map(|r| r * few);
            let shift = load[l.link] * l.by_load;
            for s in 0..few {
                let (twist, rate) = (x[p + s] - l.gear * x[q + s], v[p + s] - l.gear * v[q + s]);
                let over = l.partials[0][s] * twist + l.partials[1][s] * rate + shift;
                self.torque_change[p + s] -= over;
                self.torque_change[q + s] += l.gear * over;
            }
        }
        spectra(&mut self.coarse, &self.torque_change, out, &mut self.spectrum[0]);
    }
}
