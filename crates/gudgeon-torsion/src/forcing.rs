//! What excites a line, as harmonics over the angle of the reference shaft.

use std::f64::consts::PI;

use gudgeon_core::kinds::{Line, LineThrow};
use gudgeon_numerics::elementary;
use gudgeon_numerics::linalg::Complex;
use gudgeon_numerics::quadrature::GaussLegendre;
use gudgeon_numerics::vectors::{Vectorised, widest};

/// Orders closer than this are one.
const SAME: f64 = 1e-9;
/// Panels per turn between which, and the kinks of the pressure, torque is smooth.
const PANELS: usize = 64;
/// Points of Gauss per panel: 16 points carry 4 waves to 1e-10 of their amplitude and 5 to 1e-7, so a turn carries 300 orders.
const POINTS: usize = 16;
/// Points whose waves are added up side by side.
const LANES: usize = 8;
/// Orders after which waves are made afresh instead of by turning the one before, so that rounding does not add up.
const AFRESH: usize = 32;

/// Torques of one order.
#[derive(Debug, Clone, PartialEq)]
pub struct Order {
    /// Cycles per turn of the reference shaft.
    pub order: f64,
    /// Phasors by node of the line: torque `Re(a e^{i order θ})` \[N m\].
    pub torque: Vec<Complex>,
}

/// Torques of a line at constant speed.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Excitation {
    /// Orders, ascending.
    pub orders: Vec<Order>,
    /// Mean torques by node \[N m\], those of drives at the mean speed and drag included.
    pub mean: Vec<f64>,
}

/// Fourier coefficients `c_k`, `f = c_0 + Re Σ c_k e^{i k b α}`, of a function that is smooth between `kinks`, `b = 2π/period`.
#[must_use]
pub fn series(f: impl Fn(f64) -> f64, period: f64, kinks: &[f64], max_harmonic: usize) -> Vec<Complex> {
    let base = 2.0 * PI / period;
    let panels = (PANELS as f64 * period / (2.0 * PI)).ceil().max(max_harmonic as f64 / 4.0) as usize;
    let mut stops: Vec<f64> = (0..=panels).map(|i| period * i as f64 / panels as f64).collect();
    stops.extend(kinks.iter().map(|k| k.rem_euclid(period)));
    stops.sort_unstable_by(f64::total_cmp);
    let gauss = GaussLegendre::new(POINTS);
    let (nodes, weights) = (gauss.nodes(), gauss.weights());
    let mut sums = vec![[[0.0; LANES]; 2]; max_harmonic + 1];
    for w in stops.windows(2) {
        let (a, b) = (w[0], w[1]);
        if b - a < 1e-14 * period {
            continue;
        }
        for first in (0..POINTS).step_by(LANES) {
            let at = std::array::from_fn(|l| 0.5 * (a + b) + 0.5 * (b - a) * nodes[first + l]);
            let value = std::array::from_fn(|l| f(at[l]) * weights[first + l] * (b - a) / period);
            widest(Waves { at, value, base, sums: &mut sums });
        }
    }
    let total = |lanes: &[f64; LANES]| lanes.iter().sum::<f64>();
    let mut c: Vec<Complex> = sums.iter().map(|[re, im]| Complex::new(total(re), total(im))).collect();
    c[0] = Complex::new(0.5 * c[0].re, 0.0);
    c
}

/// Adds `value e^{-ik base at}` of some points side by side to the sums over all points, k from 0.
struct Waves<'s> {
    at: [f64; LANES],
    value: [f64; LANES],
    base: f64,
    sums: &'s mut [[[f64; LANES]; 2]],
}

impl Vectorised for Waves<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { at, value, base, sums } = self;
        let (mut cos, mut sin) = ([1.0; LANES], [0.0; LANES]);
        for l in 0..LANES {
            (sin[l], cos[l]) = elementary::sin_cos(base * at[l]);
        }
        for (n, some) in sums.chunks_mut(AFRESH).enumerate() {
            let (mut re, mut im) = (value, [0.0; LANES]);
            if n > 0 {
                for l in 0..LANES {
                    let (sin, cos) = elementary::sin_cos((n * AFRESH) as f64 * base * at[l]);
                    (re[l], im[l]) = (value[l] * cos, -value[l] * sin);
                }
            }
            for sum in some {
                let (mut next_re, mut next_im) = ([0.0; LANES], [0.0; LANES]);
                for l in 0..LANES {
                    sum[0][l] += re[l];
                    next_re[l] = re[l] * cos[l] + im[l] * sin[l];
                }
                for l in 0..LANES {
                    sum[1][l] += im[l];
                    next_im[l] = im[l] * cos[l] - re[l] * sin[l];
                }
                (re, im) = (next_re, next_im);
            }
        }
    }
}

/// Period of the gas torque of a throw over its angle \[rad\].
#[must_use]
pub fn gas_period(t: &LineThrow) -> f64 {
    // 4π is a multiple of 2π; other periods do not occur in one machine.
    t.ends.iter().map(|e| e.pressure.period()).fold(2.0 * PI, f64::max)
}

fn kinks(t: &LineThrow) -> Vec<f64> {
    let period = gas_period(t);
    let mut all = Vec::new();
    for e in &t.ends {
        let own = e.pressure.period();
        let copies = (period / own).round().max(1.0) as usize;
        for i in 0..copies {
            all.extend(e.pressure.kinks().iter().map(|k| k + own * i as f64));
        }
    }
    all
}

/// Fourier coefficients of the gas torque of a throw over the angle of the throw; the base order is `2π/period`.
#[must_use]
pub fn gas_series(t: &LineThrow, max_harmonic: usize) -> Vec<Complex> {
    let torque = |a: f64| t.ends.iter().map(|e| e.torque(a, a)).sum();
    t.gas_harmonics(max_harmonic, || series(torque, gas_period(t), &kinks(t), max_harmonic))
}

/// Fourier coefficients of `-½ dI/dθ`, the torque of the moving masses at unit speed.
#[must_use]
pub fn inertia_series(t: &LineThrow, max_harmonic: usize) -> Vec<Complex> {
    if t.inertia.is_constant() {
        return vec![Complex::default(); 1];
    }
    t.mass_harmonics(max_harmonic, || series(|a| -0.5 * t.inertia.inertia(a).1, 2.0 * PI, &[], max_harmonic))
}

/// Number of harmonics of a throw up to order `max_order` of the reference shaft.
fn wanted(line: &Line, t: &LineThrow, base: f64, max_order: f64) -> usize {
    (max_order / (base * line.nodes[t.node].ratio.abs()) + SAME).floor() as usize
}

impl Excitation {
    /// All torques of a line that turns at `speed` \[rad/s\], to order `max_order` of the reference shaft.
    #[must_use]
    pub fn new(line: &Line, speed: f64, max_order: f64) -> Self {
        let mut e = Self { orders: Vec::new(), mean: vec![0.0; line.nodes.len()] };
        e.gas(line, max_order);
        e.masses(line, speed, max_order);
        e.at_speed(line, speed);
        e.given(line, max_order);
        e.orders.sort_unstable_by(|a, b| a.order.total_cmp(&b.order));
        e
    }

    /// Adds the means of drag and drives at a speed \[rad/s\] of the reference shaft.
    pub(crate) fn at_speed(&mut self, line: &Line, speed: f64) {
        for (node, n) in line.nodes.iter().enumerate() {
            self.mean[node] -= n.damping * speed * n.ratio;
        }
        for d in &line.drives {
            // The part that goes with the angle is not in the mean.
            let here = d.drive.torque(0.0, speed * line.nodes[d.node].ratio).torque;
            let swing: f64 = d.drive.orders().iter().map(|o| o.cosine).sum();
            self.mean[d.node] += d.factor * (here - swing);
        }
    }

    /// The means of [`Excitation::parts`] at `speed` \[rad/s\], those of drag and drives included.
    pub(crate) fn mean_of_parts(&mut self, parts: &[Self; 2], line: &Line, speed: f64) {
        self.mean.clone_from(&parts[0].mean);
        self.at_speed(line, speed);
    }

    /// The orders of the sum of [`Excitation::parts`] at `speed` \[rad/s\].
    pub(crate) fn orders_of_parts(&mut self, parts: &[Self; 2], speed: f64) {
        let square = speed * speed;
        let [fixed, masses] = parts.each_ref().map(|p| &p.orders);
        // Storage of before is used again: this runs at every speed.
        self.orders.resize_with(fixed.len(), || Order { order: 0.0, torque: Vec::new() });
        for ((own, fixed), masses) in self.orders.iter_mut().zip(fixed).zip(masses) {
            own.order = fixed.order;
            own.torque.clear();
            let both = fixed.torque.iter().zip(&masses.torque);
            own.torque.extend(both.map(|(f, m)| Complex::new(f.re + m.re * square, f.im + m.im * square)));
        }
    }

    /// The torques that do not depend on the speed, and those of the moving masses at unit speed: the torque at speed Ω is the first
    /// plus Ω² times the second, order by order: both have the same ones. Means are those of the gas alone.
    #[must_use]
    pub fn parts(line: &Line, max_order: f64) -> [Self; 2] {
        let empty = || Self { orders: Vec::new(), mean: vec![0.0; line.nodes.len()] };
        let (mut fixed, mut square) = (empty(), empty());
        fixed.gas(line, max_order);
        fixed.given(line, max_order);
        square.masses(line, 1.0, max_order);
        let places: Vec<usize> = square.orders.iter().map(|o| fixed.place(line, o.order)).collect();
        let nothing = vec![Complex::default(); line.nodes.len()];
        let empty = |o: &Order| Order { order: o.order, torque: nothing.clone() };
        let own = std::mem::replace(&mut square.orders, fixed.orders.iter().map(empty).collect());
        own.into_iter().zip(places).for_each(|(o, place)| square.orders[place].torque = o.torque);
        for e in [&mut fixed, &mut square] {
            e.orders.sort_unstable_by(|a, b| a.order.total_cmp(&b.order));
        }
        [fixed, square]
    }

    fn gas(&mut self, line: &Line, max_order: f64) {
        for t in line.throws.iter().filter(|t| !t.ends.is_empty()) {
            let base = 2.0 * PI / gas_period(t);
            let c = gas_series(t, wanted(line, t, base, max_order));
            self.mean[t.node] += c[0].re;
            self.insert(line, t.node, t.phase, base, &c);
        }
    }

    fn masses(&mut self, line: &Line, speed: f64, max_order: f64) {
        for t in line.throws.iter().filter(|t| !t.inertia.is_constant()) {
            let mut c = inertia_series(t, wanted(line, t, 1.0, max_order));
            let turn = speed * line.nodes[t.node].ratio;
            c.iter_mut().for_each(|c| *c = *c * Complex::new(turn * turn, 0.0));
            self.insert(line, t.node, t.phase, 1.0, &c);
        }
    }

    fn given(&mut self, line: &Line, max_order: f64) {
        for d in &line.drives {
            for o in d.drive.orders() {
                if o.order * line.nodes[d.node].ratio.abs() <= max_order + SAME {
                    let a = Complex::new(o.cosine * d.factor, -o.sine * d.factor);
                    self.add(line, d.node, d.phase, o.order, a);
                }
            }
        }
    }

    fn insert(&mut self, line: &Line, node: usize, phase: f64, base: f64, c: &[Complex]) {
        for (k, c) in c.iter().enumerate().skip(1) {
            self.add(line, node, phase, k as f64 * base, *c);
        }
    }

    /// Adds `Re(a e^{i order (θ + phase)})`, θ the angle of the node.
    fn add(&mut self, line: &Line, node: usize, phase: f64, order: f64, a: Complex) {
        if a == Complex::default() {
            return;
        }
        let (sin, cos) = elementary::sin_cos(order * phase);
        let mut a = a * Complex::new(cos, sin);
        let ratio = line.nodes[node].ratio;
        if ratio < 0.0 {
            a.im = -a.im;
        }
        let at = self.place(line, order * ratio.abs());
        let t = &mut self.orders[at].torque[node];
        *t = *t + a;
    }

    /// Place of an order, which is added where there is none like it.
    fn place(&mut self, line: &Line, order: f64) -> usize {
        let found = self.orders.iter().position(|o| (o.order - order).abs() < SAME);
        found.unwrap_or_else(|| {
            self.orders.push(Order { order, torque: vec![Complex::default(); line.nodes.len()] });
            self.orders.len() - 1
        })
    }
}
