//! What the linear line leaves out of the torques of a periodic motion, and how that changes with the motion.

use std::f64::consts::PI;

use gudgeon_core::kinds::{Line, LinearCoupling};
use gudgeon_numerics::fourier::Fourier;
use gudgeon_numerics::linalg::Complex;

use crate::forcing::gas_period;
use crate::interpolant::Interpolant;
use crate::steady::Steady;

/// Points over the cycle by harmonics: products of three are still resolved.
const RESOLVED: usize = 8;
/// Points over the cycle by those of which a change of the motion is looked at: it only has to point the right way.
const COARSER: usize = 2;

/// Nodes with something that is not linear, ascending.
pub(crate) fn active(line: &Line) -> Vec<usize> {
    let mut nodes: Vec<usize> = line.throws.iter().map(|t| t.node).collect();
    nodes.extend(line.drives.iter().filter(|d| !d.drive.is_linear()).map(|d| d.node));
    nodes.extend(line.links.iter().filter(|l| !l.coupling.is_linear()).flat_map(|l| l.nodes));
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

/// Motion over the cycle, its torques beyond the linear line, and their derivatives. Rows are nodes that have such torques.
#[derive(Debug)]
pub(crate) struct Beyond {
    pub active: Vec<usize>,
    pub harmonics: usize,
    fourier: Fourier,
    coarse: Fourier,
    cycle: f64,
    throws: Vec<Throw>,
    links: Vec<Link>,
    /// Deviation from the mean rotation, its first and second derivative in time.
    motion: [Vec<f64>; 3],
    force: Vec<f64>,
    /// Derivatives of the torques by the motion, a change of the motion and what it makes of the torques, at the coarse points.
    slopes: [Vec<f64>; 3],
    swing: [Vec<f64>; 3],
    changed: Vec<f64>,
    spectrum: [Vec<Complex>; 2],
    spare: Vec<f64>,
}

#[derive(Debug)]
struct Throw {
    /// Place among those of the line, and row.
    throw: usize,
    row: usize,
    gas: Option<Interpolant>,
    /// Inertia and its derivative by the angle.
    inertia: Option<[Interpolant; 2]>,
    /// Gas torque of even rotation.
    even: Vec<f64>,
}

/// A coupling that is not linear.
#[derive(Debug)]
struct Link {
    link: usize,
    rows: [usize; 2],
    gear: f64,
    /// Torque beside the tangent, and its derivatives by twist and rate.
    over: Vec<f64>,
    slopes: [Vec<f64>; 2],
    /// What a change of the mean torque adds: nothing while the tangent is that at this mean.
    by_load: f64,
    orders: Vec<Complex>,
}

impl Beyond {
    /// Of a line whose motion repeats after `cycle` \[rad\].
    pub fn new(line: &Line, cycle: f64, harmonics: usize) -> Self {
        let active = active(line);
        let fourier = Fourier::new((RESOLVED * harmonics).max(64));
        let m = fourier.points();
        let coarse = Fourier::new(m / COARSER);
        let few = coarse.points();
        let row = |node: usize| active.binary_search(&node).unwrap_or(0);
        let zero = |n: usize| vec![0.0; n * m];
        let mut throws: Vec<Throw> = (line.throws.iter().enumerate())
            .map(|(k, t)| {
                let turns = (gas_period(t) / (2.0 * PI)).round().max(1.0) as usize;
                let inertia = |a: f64| t.inertia.inertia(a);
                let varies = !t.inertia.is_constant();
                Throw {
                    throw: k,
                    row: row(t.node),
                    gas: (!t.ends.is_empty()).then(|| Interpolant::new(turns, |a| gas(line, k, a))),
                    inertia: varies.then(|| {
                        [Interpolant::new(1, |a| inertia(a).0), Interpolant::new(1, |a| inertia(a).1)]
                    }),
                    even: zero(1),
                }
            })
            .collect();
        for t in &mut throws {
            for s in 0..m {
                let at = even(line, t.throw, cycle, s, m);
                if let Some(p) = &mut t.gas {
                    t.even[s] = p.value(at, |a| gas(line, t.throw, a));
                }
            }
        }
        let links = (line.links.iter().enumerate())
            .filter(|(_, l)| !l.coupling.is_linear())
            .map(|(link, l)| Link {
                link,
                rows: l.nodes.map(row),
                gear: line.nodes[l.nodes[0]].ratio / line.nodes[l.nodes[1]].ratio,
                over: zero(1),
                slopes: [vec![0.0; few], vec![0.0; few]],
                by_load: 0.0,
                orders: vec![Complex::default(); harmonics + 1],
            })
            .collect();
        let n = active.len();
        let spectrum = || vec![Complex::default(); harmonics + 1];
        Self {
            harmonics,
            cycle,
            throws,
            links,
            motion: [zero(n), zero(n), zero(n)],
            force: zero(n),
            slopes: [vec![0.0; n * few], vec![0.0; n * few], vec![0.0; n * few]],
            swing: [vec![0.0; n * few], vec![0.0; n * few], vec![0.0; n * few]],
            changed: vec![0.0; n * few],
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
        take_apart(&mut self.fourier, &self.force, out, &mut self.spectrum[0]);
    }

    fn of_throws(&mut self, steady: &Steady) {
        let m = self.fourier.points();
        let [x, v, a] = &self.motion;
        for t in &mut self.throws {
            let line = &steady.line;
            let throw = &line.throws[t.throw];
            let speed = steady.speed * line.nodes[throw.node].ratio;
            let here = t.row * m;
            for s in 0..m {
                let at = even(line, t.throw, self.cycle, s, m) + x[here + s];
                let mut f = 0.0;
                if let Some(p) = &mut t.gas {
                    f += p.value(at, |a| gas(line, t.throw, a)) - t.even[s];
                }
                if let Some([inertia, slope]) = &mut t.inertia {
                    let j = inertia.value(at, |a| throw.inertia.inertia(a).0);
                    let dj = slope.value(at, |a| throw.inertia.inertia(a).1);
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
                l.over[s] = coupling.torque(twist, rate).torque - linear;
                self.force[a + s] -= l.over[s];
                self.force[b + s] += l.gear * l.over[s];
            }
        }
    }

    /// Orders of what the couplings that are not linear carry beside their tangents, at the motion last taken.
    pub fn beside_tangents(&mut self) -> Vec<(usize, Vec<Complex>)> {
        let spare = &mut self.spectrum[0];
        for l in &mut self.links {
            self.fourier.orders(&l.over, &l.over, &mut l.orders, spare);
        }
        self.links.iter().map(|l| (l.link, l.orders.clone())).collect()
    }

    /// Takes the derivatives of the torques at the motion last taken.
    pub fn take_slopes(&mut self, steady: &Steady, tangents: &[LinearCoupling]) {
        self.slopes.iter_mut().for_each(|s| s.fill(0.0));
        self.slopes_of_throws(steady);
        self.slopes_of_drives(steady);
        self.slopes_of_links(steady, tangents);
    }

    fn slopes_of_throws(&mut self, steady: &Steady) {
        let (m, few) = (self.fourier.points(), self.coarse.points());
        let line = &steady.line;
        let [x, v, a] = &self.motion;
        let [by_angle, by_speed, by_acceleration] = &mut self.slopes;
        for t in &mut self.throws {
            let throw = &line.throws[t.throw];
            let speed = steady.speed * line.nodes[throw.node].ratio;
            for s in 0..few {
                let (i, o) = (t.row * m + COARSER * s, t.row * few + s);
                let at = even(line, t.throw, self.cycle, s, few) + x[i];
                if let Some(p) = &mut t.gas {
                    by_angle[o] += p.derivative(at, |a| gas(line, t.throw, a));
                }
                if let Some([inertia, slope]) = &mut t.inertia {
                    let j = inertia.value(at, |a| throw.inertia.inertia(a).0);
                    let dj = slope.value(at, |a| throw.inertia.inertia(a).1);
                    let ddj = slope.derivative(at, |a| throw.inertia.inertia(a).1);
                    let w = speed + v[i];
                    by_angle[o] -= dj * a[i] + 0.5 * ddj * w * w;
                    by_speed[o] -= dj * w;
                    by_acceleration[o] -= j - throw.inertia.mean();
                }
            }
        }
    }

    /// What of a drive goes with its speed; what goes with the angle is small beside it.
    fn slopes_of_drives(&mut self, steady: &Steady) {
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
                self.slopes[1][row * few + s] += d.factor * (now.slope - d.drive.torque(even, speed).slope);
            }
        }
    }

    fn slopes_of_links(&mut self, steady: &Steady, tangents: &[LinearCoupling]) {
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
                l.slopes[0][s] = c.stiffness - tangent.stiffness;
                l.slopes[1][s] = c.damping - tangent.damping;
            }
        }
    }

    /// What a small change of the motion makes of the torques: `angle` as in [`Self::take_motion`], `load` the change of the mean torque
    /// of each link.
    pub fn change(&mut self, angle: &[Complex], omega: f64, load: &[f64], out: &mut [Complex]) {
        let few = self.coarse.points();
        let room = (&mut self.spectrum, &mut self.spare[..few]);
        waves(&mut self.coarse, angle, omega, &mut self.swing, room);
        let [x, v, a] = &self.swing;
        let [by_angle, by_speed, by_acceleration] = &self.slopes;
        let by = by_angle.iter().zip(by_speed).zip(by_acceleration);
        for ((f, ((bx, bv), ba)), ((x, v), a)) in self.changed.iter_mut().zip(by).zip(x.iter().zip(v).zip(a))
        {
            *f = bx * x + bv * v + ba * a;
        }
        for l in &self.links {
            let [p, q] = l.rows.map(|r| r * few);
            let shift = load[l.link] * l.by_load;
            for s in 0..few {
                let (twist, rate) = (x[p + s] - l.gear * x[q + s], v[p + s] - l.gear * v[q + s]);
                let over = l.slopes[0][s] * twist + l.slopes[1][s] * rate + shift;
                self.changed[p + s] -= over;
                self.changed[q + s] += l.gear * over;
            }
        }
        take_apart(&mut self.coarse, &self.changed, out, &mut self.spectrum[0]);
    }
}

/// Angles, rates and accelerations over the cycle of angles by row and order; `omega` is the angular frequency of the first order.
fn waves(
    fourier: &mut Fourier,
    angle: &[Complex],
    omega: f64,
    [x, v, a]: &mut [Vec<f64>; 3],
    ([first, second], spare): (&mut [Vec<Complex>; 2], &mut [f64]),
) {
    let (m, orders) = (fourier.points(), first.len());
    for ((own, x), v) in angle.chunks_exact(orders).zip(x.chunks_exact_mut(m)).zip(v.chunks_exact_mut(m)) {
        for (k, (z, x)) in first.iter_mut().zip(own).enumerate() {
            let rate = k as f64 * omega;
            *z = Complex::new(-rate * x.im, rate * x.re);
        }
        fourier.waves(own, first, x, v);
    }
    // Accelerations of two rows at once.
    for (own, a) in angle.chunks(2 * orders).zip(a.chunks_mut(2 * m)) {
        for k in 0..orders {
            let factor = Complex::new(-(k as f64 * omega).powi(2), 0.0);
            first[k] = factor * own[k];
            second[k] = own.get(orders + k).map_or(Complex::default(), |z| factor * *z);
        }
        let (low, high) = a.split_at_mut(m);
        fourier.waves(first, second, low, if high.is_empty() { &mut *spare } else { high });
    }
}

/// Orders of forces by row, two rows at once.
fn take_apart(fourier: &mut Fourier, force: &[f64], out: &mut [Complex], spare: &mut [Complex]) {
    let (m, orders) = (fourier.points(), spare.len());
    for (f, out) in force.chunks(2 * m).zip(out.chunks_mut(2 * orders)) {
        let (low, high) = out.split_at_mut(orders);
        let (own, other) = f.split_at(m);
        if other.is_empty() {
            fourier.orders(own, own, low, &mut *spare);
        } else {
            fourier.orders(own, other, low, high);
        }
    }
}

/// Angle of a throw at point `s` of `m` of the cycle of even rotation.
fn even(line: &Line, throw: usize, cycle: f64, s: usize, m: usize) -> f64 {
    let t = &line.throws[throw];
    // The points are a power of two: their inverse is exact.
    line.nodes[t.node].ratio * cycle * (s as f64 * (1.0 / m as f64)) + t.phase
}

/// Gas torque of a throw at its own angle.
fn gas(line: &Line, throw: usize, at: f64) -> f64 {
    line.throws[throw].ends.iter().map(|e| e.torque(at, at)).sum()
}
