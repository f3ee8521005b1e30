//! The torques of a periodic motion that the linear line leaves out.

use std::f64::consts::PI;

use gudgeon_core::kinds::{Line, LinearCoupling};
use gudgeon_numerics::fourier::Fourier;
use gudgeon_numerics::linalg::Complex;

use super::spectrum::{spectra, waves};
use crate::forcing::gas_period;
use crate::interpolant::{Interpolant, Place};
use crate::steady::Steady;

/// Points over the cycle by harmonics: products of three are still resolved.
const RESOLVED: usize = 8;
/// Points over the cycle by those of which a change of the motion is looked at: it only has to point the right way.
pub(super) const COARSER: usize = 2;

/// Nodes with something that is not linear, ascending.
pub(super) fn active(line: &Line) -> Vec<usize> {
    let mut nodes: Vec<usize> = line.throws.iter().map(|t| t.node).collect();
    nodes.extend(line.drives.iter().filter(|d| !d.drive.is_linear()).map(|d| d.node));
    nodes.extend(line.links.iter().filter(|l| !l.coupling.is_linear()).flat_map(|l| l.nodes));
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

/// Motion over the cycle, its torques beyond the linear line, and their derivatives. Rows are nodes that have such torques.
#[derive(Debug)]
pub(super) struct NonlinearTorques {
    pub active: Vec<usize>,
    pub harmonics: usize,
    pub(super) fourier: Fourier,
    pub(super) coarse: Fourier,
    pub(super) cycle: f64,
    pub(super) throws: Vec<Throw>,
    pub(super) curves: Vec<Curves>,
    pub(super) links: Vec<Link>,
    /// Deviation from the mean rotation, its first and second derivative in time.
    pub(super) motion: [Vec<f64>; 3],
    pub(super) force: Vec<f64>,
    /// Partial derivatives of the torques with respect to angle, speed and acceleration, a perturbation of the motion, and the change of the
    /// torques that it makes, at the coarse points.
    pub(super) partials: [Vec<f64>; 3],
    pub(super) perturbation: [Vec<f64>; 3],
    pub(super) torque_change: Vec<f64>,
    pub(super) spectrum: [Vec<Complex>; 2],
    pub(super) spare: Vec<f64>,
}

#[derive(Debug)]
pub(super) struct Throw {
    /// Place among those of the line, row, and place of its curves.
    pub(super) throw: usize,
    pub(super) row: usize,
    pub(super) curves: usize,
    /// Gas torque of uniform rotation.
    gas_uniform: Vec<f64>,
}

/// What throws that are alike have in common.
#[derive(Debug)]
pub(super) struct Curves {
    pub(super) gas: Option<Interpolant<1>>,
    /// Inertia and its derivative by the angle.
    pub(super) inertia: Option<Interpolant<2>>,
}

impl Curves {
    /// Of throw `k` of a line.
    fn new(line: &Line, k: usize) -> Self {
        let throw = &line.throws[k];
        let turns = (gas_period(throw) / (2.0 * PI)).round().max(1.0) as usize;
        Self {
            gas: (!throw.ends.is_empty()).then(|| Interpolant::new(turns, |a| [gas_torque(line, k, a)])),
            inertia: (!throw.inertia.is_constant())
                .then(|| Interpolant::new(1, |a| throw.inertia.inertia(a).into())),
        }
    }
}

/// The throws of a line, with `m` points over the cycle, and their curves.
fn throws(line: &Line, active: &[usize], cycle: f64, m: usize) -> (Vec<Throw>, Vec<Curves>) {
    let (mut throws, mut curves): (Vec<Throw>, Vec<Curves>) = (Vec::new(), Vec::new());
    for (k, own) in line.throws.iter().enumerate() {
        let like = throws.iter().find(|t| own.is_like(&line.throws[t.throw])).map(|t| t.curves);
        let place = like.unwrap_or_else(|| {
            curves.push(Curves::new(line, k));
            curves.len() - 1
        });
        let gas_uniform = (0..m).map(|s| match &mut curves[place].gas {
            Some(gas) => gas.value(uniform_angle(line, k, cycle, s, m), |a| [gas_torque(line, k, a)])[0],
            None => 0.0,
        });
        let gas_uniform = gas_uniform.collect();
        throws.push(Throw { throw: k, row: row(active, own.node), curves: place, gas_uniform });
    }
    (throws, curves)
}

/// A coupling that is not linear.
#[derive(Debug)]
pub(super) struct Link {
    pub(super) link: usize,
    pub(super) rows: [usize; 2],
    pub(super) gear: f64,
    /// Torque beside the tangent, and its partial derivatives by twist and rate.
    pub(super) beside: Vec<f64>,
    pub(super) partials: [Vec<f64>; 2],
    /// What a change of the mean torque adds: nothing while the tangent is that at this mean.
    pub(super) by_load: f64,
    pub(super) orders: Vec<Complex>,
}

impl Link {
    /// Link `l` of a line, with `m` points over the cycle, of which `few` are coarse.
    fn new(line: &Line, l: usize, active: &[usize], [m, few]: [usize; 2], harmonics: usize) -> Self {
        let nodes = line.links[l].nodes;
        Self {
            link: l,
            rows: nodes.map(|n| row(active, n)),
            gear: line.nodes[nodes[0]].ratio / line.nodes[nodes[1]].ratio,
            beside: vec![0.0; m],
            partials: [vec![0.0; few], vec![0.0; few]],
            by_load: 0.0,
            orders: vec![Complex::default(); harmonics + 1],
        }
    }
}

/// Row of an active node.
fn row(active: &[usize], node: usize) -> usize {
    active.binary_search(&node).unwrap_or(0)
}

impl NonlinearTorques {
    /// Of a line whose motion repeats after `cycle` \[rad\].
    pub fn new(line: &Line, cycle: f64, harmonics: usize) -> Self {
        let active = active(line);
        let fourier = Fourier::new((RESOLVED * harmonics).max(64));
        let m = fourier.points();
        let coarse = Fourier::new(m / COARSER);
        let few = coarse.points();
        let zero = |n: usize| vec![0.0; n * m];
        let (throws, curves) = throws(line, &active, cycle, m);
        let links = (0..line.links.len())
            .filter(|l| !line.links[*l].coupling.is_linear())
            .map(|l| Link::new(line, l, &active, [m, few], harmonics))
            .collect();
        let n = active.len();
        let spectrum = || vec![Complex::default(); harmonics + 1];
        Self {
            harmonics,
            cycle,
            throws,
            curves,
            links,
            motion: [zero(n), zero(n), zero(n)],
            force: zero(n),
            partials: [vec![0.0; n * few], vec![0.0; n * few], vec![0.0; n * few]],
            perturbation: [vec![0.0; n * few], vec![0.0; n * few], vec![0.0; n * few]],
            torque_change: vec![0.0; n * few],
            coarse,
            spectrum: [spectrum(), spectrum()],
            spare: zero(1),
            active,
            fourier,
        }
    }

    /// Number of orders with the mean.
    pub fn orders(&self) -> usize {
        self.harmonics + 1
    }

    /// Takes a motion: angles by row and order, the mean first; `omega` is the angular frequency of the first order.
    pub fn take_motion(&mut self, angle: &[Complex], omega: f64) {
        let room = (&mut self.spectrum, &mut self.spare[..]);
        waves(&mut self.fourier, angle, omega, &mut self.motion, room);
    }

    /// The torques of the motion beyond the linear line, by row and order.
    pub fn torques(&mut self, steady: &Steady, tangents: &[LinearCoupling], out: &mut [Complex]) {
        self.force.fill(0.0);
        self.of_throws(steady);
        self.of_drives(steady);
        self.of_links(steady, tangents);
        spectra(&mut self.fourier, &self.force, out, &mut self.spectrum[0]);
    }

    fn of_throws(&mut self, steady: &Steady) {
        let m = self.fourier.points();
        let [x, v, a] = &self.motion;
        for t in &self.throws {
            let (line, curves) = (&steady.line, &mut self.curves[t.curves]);
            let throw = &line.throws[t.throw];
            let speed = steady.speed * line.nodes[throw.node].ratio;
            let here = t.row * m;
            for s in 0..m {
                let at = uniform_angle(line, t.throw, self.cycle, s, m) + x[here + s];
                let (mut f, place) = (0.0, Place::of(at));
                if let Some(p) = &mut curves.gas {
                    f += p.value_at(place, at, |a| [gas_torque(line, t.throw, a)])[0] - t.gas_uniform[s];
                }
                if let Some(inertia) = &mut curves.inertia {
                    let [j, dj] = inertia.value_at(place, at, |a| throw.inertia.inertia(a).into());
                    let w = speed + v[here + s];
                    f -= (j - throw.inertia.mean()) * a[here + s] + 0.5 * dj * w * w;
                }
                self.force[here + s] += f;
            }
        }
    }

    fn of_drives(&mut self, steady: &Steady) {
        let m = self.fourier.points();
        for d in steady.line.drives.iter().filter(|d| !d.drive.is_linear()) {
            let ratio = steady.line.nodes[d.node].ratio;
            let here = self.active.binary_search(&d.node).unwrap_or(0) * m;
            let speed = steady.speed * ratio;
            for s in 0..m {
                let even = ratio * self.cycle * s as f64 / m as f64 + d.phase;
                let mean = d.drive.torque(even, speed);
                let (x, v) = (self.motion[0][here + s], self.motion[1][here + s]);
                let now = d.drive.torque(even + x, speed + v);
                self.force[here + s] += d.factor * (now.torque - mean.torque - mean.slope * v);
            }
        }
    }

    fn of_links(&mut self, steady: &Steady, tangents: &[LinearCoupling]) {
        let m = self.fourier.points();
        let [x, v, _] = &self.motion;
        for l in &mut self.links {
            let coupling = &steady.line.links[l.link].coupling;
            let tangent = tangents[l.link];
            let mean = steady.mean_torque[l.link];
            let rest = coupling.static_twist(mean);
            let [a, b] = l.rows.map(|r| r * m);
            for s in 0..m {
                let (twist, rate) = (x[a + s] - l.gear * x[b + s], v[a + s] - l.gear * v[b + s]);
                let linear = mean + tangent.stiffness * (twist - rest) + tangent.damping * rate;
                l.beside[s] = coupling.torque(twist, rate).torque - linear;
                self.force[a + s] -= l.beside[s];
                self.force[b + s] += l.gear * l.beside[s];
            }
        }
    }

    /// Orders of what the couplings that are not linear carry beside their tangents, at the motion last taken.
    pub fn link_torques_beside_tangents(&mut self) -> Vec<(usize, Vec<Complex>)> {
        let spare = &mut self.spectrum[0];
        for l in &mut self.links {
            self.fourier.orders(&l.beside, &l.beside, &mut l.orders, spare);
        }
        self.links.iter().map(|l| (l.link, l.orders.clone())).collect()
    }
}

/// Angle of a throw at point `s` of `m` of the cycle of uniform rotation.
pub(super) fn uniform_angle(line: &Line, throw: usize, cycle: f64, s: usize, m: usize) -> f64 {
    let t = &line.throws[throw];
    // The points are a power of two: their inverse is exact.
    line.nodes[t.node].ratio * cycle * (s as f64 * (1.0 / m as f64)) + t.phase
}

/// Gas torque of a throw at its own angle.
pub(super) fn gas_torque(line: &Line, throw: usize, at: f64) -> f64 {
    line.throws[throw].ends.iter().map(|e| e.torque(at, at)).sum()
}
