//! A line in one load step, asked for its vibration at one speed after the other.

pub(crate) mod sizes;

use std::collections::BTreeMap;
use std::sync::Arc;

use gudgeon_core::kinds::{PhasorRow, Torsion, TorsionCtx, TorsionOut, TorsionSpec};
use gudgeon_core::{BuildError, EvalError};
use gudgeon_numerics::maximum::maximise;
use gudgeon_numerics::vectors::all_finite;
use gudgeon_torsion::critical::CriticalSpeed;
use gudgeon_torsion::cycle::Cycle;
use gudgeon_torsion::steady::Steady;
use gudgeon_torsion::torsion::Orders;

use super::assemble::Assembled;
use sizes::{angle_bounds, strongest, torque_amplitudes};

/// Damping ratio below which a resonance counts as undamped: its peak would be a million times the static answer.
const UNDAMPED: f64 = 1e-6;
/// Bound of the sum of the amplitudes of all orders, at most √2 times it, above which the exact swing of speeds \[1\] and twists \[rad\] is looked at.
const LARGE: f64 = 0.5;

/// Vibration in a link at one speed.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct LinkPoint {
    /// Half of peak to peak torque over the cycle \[N m\].
    pub amplitude: f64,
    /// Largest torque, either way \[N m\].
    pub peak: f64,
    /// Mean power lost \[W\].
    pub heat: f64,
    /// Order of the largest torque.
    pub order: f64,
}

/// Vibration at one speed.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Point {
    /// By link.
    pub links: Vec<LinkPoint>,
    /// Peak to peak speed by mean speed, by inertia; empty where nobody asked and it is small.
    pub speed_fluctuation: Vec<f64>,
    /// Order of the largest speed, by inertia, where the fluctuation is known.
    pub fluctuation_order: Vec<f64>,
    /// Largest vibratory twist of a link (half of peak to peak, \[rad\]); zero where it is small.
    pub twist: f64,
    /// Torque amplitudes by link and order \[N m\]; empty unless they are kept.
    pub orders: Vec<f64>,
}

impl Point {
    /// Torque amplitudes of a link by order \[N m\]; empty unless they are kept.
    pub fn orders_of(&self, link: usize) -> &[f64] {
        let count = self.orders.len() / self.links.len().max(1);
        &self.orders[link * count..][..count]
    }

    /// That of one order, zero where it is not kept.
    pub fn order_of(&self, link: usize, k: usize) -> f64 {
        self.orders_of(link).get(k).copied().unwrap_or(0.0)
    }
}

/// A line at any speed.
#[derive(Debug)]
pub struct Machine<'a> {
    /// The line as built.
    pub a: &'a Assembled,
    /// What is linear in it.
    pub steady: Steady,
    /// Whether the coefficient of speed fluctuation is wanted everywhere.
    pub speed_fluctuation: bool,
    /// Whether amplitudes by order are kept.
    pub by_order: bool,
    /// Orders of the answers, ascending.
    pub orders: Vec<f64>,
    /// Work: linear systems solved.
    pub solutions: u64,
    /// Speeds \[rad/s\] at which the model found no periodic motion and `orders` answered instead.
    pub spared: Vec<f64>,
    /// Speeds \[rad/s\] at which nothing answered, and why.
    pub failed: Vec<(f64, String)>,
    ctx: TorsionCtx<'a>,
    torsion: Box<dyn Torsion>,
    spare: Option<Box<dyn Torsion>>,
    cycle: Option<Cycle>,
    /// An answer that nobody needs any more: the next one is written into its storage.
    room: TorsionOut,
    /// Critical speeds of the range that was asked for last.
    critical: Option<([f64; 2], Vec<CriticalSpeed>)>,
    points: BTreeMap<u64, Arc<Point>>,
    /// At speeds where peaks of one link alone were looked for, by speed and link.
    of_one_link: BTreeMap<(u64, usize), LinkPoint>,
}

/// A quantity whose largest value is looked for.
pub enum Sought<'q> {
    /// Of the vibration in a link.
    Link(usize, &'q dyn Fn(&LinkPoint) -> f64),
    /// Of the whole line.
    Line(&'q dyn Fn(&Point) -> f64),
}

impl<'a> Machine<'a> {
    /// Builds the model of the case once.
    ///
    /// # Errors
    /// As [`TorsionSpec::build`].
    pub fn new(ctx: TorsionCtx<'a>, a: &'a Assembled, spec: &dyn TorsionSpec) -> Result<Self, BuildError> {
        Ok(Self {
            a,
            steady: Steady::new(&ctx)?,
            speed_fluctuation: false,
            by_order: false,
            orders: Vec::new(),
            solutions: 0,
            spared: Vec::new(),
            failed: Vec::new(),
            torsion: spec.build(&ctx)?,
            ctx,
            spare: None,
            cycle: None,
            room: TorsionOut::default(),
            critical: None,
            points: BTreeMap::new(),
            of_one_link: BTreeMap::new(),
        })
    }

    /// Takes vibration that is known already.
    pub fn given(&mut self, speed: f64, point: Point) {
        self.points.insert(speed.to_bits(), Arc::new(point));
    }

    /// The whole answer at a speed \[rad/s\].
    ///
    /// # Errors
    /// As [`Torsion::run`].
    pub fn motion(&mut self, speed: f64) -> Result<TorsionOut, EvalError> {
        let mut out = std::mem::take(&mut self.room);
        out.counters.values_mut().for_each(|n| *n = 0);
        out.notes.clear();
        self.torsion.set_speed(speed)?;
        self.torsion.run(&mut out)?;
        finite(&out)?;
        Ok(out)
    }

    /// Vibration at a speed \[rad/s\]; none where there is no periodic motion, which is kept in mind.
    pub fn at(&mut self, speed: f64) -> Option<Arc<Point>> {
        // Bits of positive numbers ascend with them.
        let key = speed.to_bits();
        if let Some(point) = self.points.get(&key) {
            return Some(Arc::clone(point));
        }
        let out = self.answer(speed)?;
        let point = Arc::new(self.point(&out));
        self.room = out;
        self.points.insert(key, Arc::clone(&point));
        Some(point)
    }

    /// Vibration in one link at a speed \[rad/s\], without looking at the others.
    fn link_at(&mut self, speed: f64, link: usize) -> Option<LinkPoint> {
        let key = speed.to_bits();
        if let Some(p) = self.points.get(&key) {
            return Some(p.links[link]);
        }
        if let Some(p) = self.of_one_link.get(&(key, link)) {
            return Some(*p);
        }
        let out = self.answer(speed)?;
        let point = link_point(self.extremes(&out), &out, link);
        self.room = out;
        self.of_one_link.insert((key, link), point);
        Some(point)
    }

    /// The answer of the model at a speed \[rad/s\], or of `orders` where it has none; nothing where both fail, which is kept in mind.
    fn answer(&mut self, speed: f64) -> Option<TorsionOut> {
        if self.failed.iter().any(|f| f.0 == speed) {
            return None;
        }
        let out = match self.motion(speed) {
            Ok(out) => out,
            Err(e) => match self.spare_motion(speed) {
                Some(out) => {
                    if !self.spared.contains(&speed) {
                        self.spared.push(speed);
                    }
                    out
                }
                None => {
                    self.failed.push((speed, e.to_string()));
                    return None;
                }
            },
        };
        // To compare few names takes less than to hash one.
        let own = out.counters.iter().find(|(name, _)| *name == "linear_solutions");
        self.solutions += own.map_or(0, |(_, n)| *n);
        Some(out)
    }

    /// Vibration at ascending speeds, every second one after those beside it: a model that iterates starts from what is known on both
    /// sides.
    pub fn prepare(&mut self, speeds: &[f64]) {
        let mut none = |w: &f64| self.at(*w).is_none();
        // Where there is no answer, whoever asks for it finds out.
        if speeds.first().is_some_and(&mut none) {
            return;
        }
        let mut half = speeds.len().next_power_of_two() / 2;
        while half > 0 {
            if speeds.iter().skip(half).step_by(2 * half).any(&mut none) {
                return;
            }
            half /= 2;
        }
    }

    /// Why there is no answer at a speed.
    pub fn why(&self, speed: f64) -> EvalError {
        let said = self.failed.iter().find(|f| f.0 == speed).map_or("no answer", |f| f.1.as_str());
        EvalError::fatal("torsion", said.to_owned())
    }

    fn spare_motion(&mut self, speed: f64) -> Option<TorsionOut> {
        if self.spare.is_none() {
            self.spare = Orders {}.build(&self.ctx).ok();
        }
        let mut out = TorsionOut::default();
        let spare = self.spare.as_mut()?;
        spare.set_speed(speed).ok()?;
        spare.run(&mut out).ok()?;
        finite(&out).ok()?;
        Some(out)
    }

    /// Extremes over the cycle for some answer.
    pub fn extremes(&mut self, out: &TorsionOut) -> &mut Cycle {
        if !self.cycle.as_ref().is_some_and(|c| c.orders() == out.orders.orders()) {
            self.cycle = None;
            out.orders.orders().clone_into(&mut self.orders);
        }
        let (orders, period) = (&self.orders, self.a.period);
        self.cycle.get_or_insert_with(|| Cycle::new(orders, period))
    }

    fn point(&mut self, out: &TorsionOut) -> Point {
        let (links, nodes) = (self.a.line.links.len(), self.a.line.nodes.len());
        let (fluctuation, by_order, a) = (self.speed_fluctuation, self.by_order, self.a);
        let cycle = self.extremes(out);
        let mut p =
            Point { links: (0..links).map(|l| link_point(cycle, out, l)).collect(), ..Point::default() };
        if by_order {
            p.orders = torque_amplitudes(&out.orders);
        }
        // Mostly one look at all angles together tells that nothing is large.
        let [rate, angle] = angle_bounds(&out.orders, nodes);
        // Relative speed of an inertia at the reference shaft: order times angle.
        let ratio = |i: usize| a.line.nodes[i].ratio;
        let orders = || out.orders.orders().iter().copied();
        let angles = |i: usize| phasors(out.orders.angle(i));
        let bound = |i: usize| {
            orders().zip(angles(i)).map(|(order, z)| order * norm1(z)).sum::<f64>() / ratio(i).abs()
        };
        let may_be_large = |i: &usize| rate > LARGE * ratio(*i).abs();
        if fluctuation || (0..nodes).filter(may_be_large).any(|i| bound(i) > LARGE) {
            p.speed_fluctuation =
                (0..nodes).map(|i| speed_fluctuation(cycle, out, i) / ratio(i).abs()).collect();
            p.fluctuation_order = (0..nodes)
                .map(|i| {
                    strongest_of(orders().zip(angles(i)).map(|(order, z)| (order * order * square(z), order)))
                })
                .collect();
        }
        for l in 0..links {
            if angle * (1.0 + gear(a, l).abs()) <= LARGE {
                continue;
            }
            if twist_of(a, out, l).map(norm1).sum::<f64>() > LARGE {
                p.twist = p.twist.max(twist_amplitude(cycle, a, out, l));
            }
        }
        p
    }

    /// Critical speeds from `from` to `to` of all orders that something excites.
    ///
    /// # Errors
    /// No convergence of natural frequencies.
    pub fn critical_speeds(&mut self, from: f64, to: f64) -> Result<Vec<CriticalSpeed>, EvalError> {
        if let Some((range, known)) = &self.critical
            && *range == [from, to]
        {
            return Ok(known.clone());
        }
        let excited =
            self.steady.excitation.orders.iter().filter(|o| o.torque.iter().any(|t| t.norm1() != 0.0));
        let orders: Vec<f64> = excited.map(|o| o.order).collect();
        let found = self.steady.critical_speeds(&orders, from, to, 64)?;
        self.critical = Some(([from, to], found.clone()));
        Ok(found)
    }

    /// Speeds at which peaks over the speed show: a grid, the critical speeds, and places half and two widths of the resonance beside
    /// those. Undamped critical speeds stay out.
    pub fn telling_speeds(&mut self, grid: &[f64], critical: &[CriticalSpeed]) -> Vec<f64> {
        let (Some(&from), Some(&to)) = (grid.first(), grid.last()) else { return Vec::new() };
        let mut all = grid.to_vec();
        for c in critical.iter().filter(|c| c.damping_ratio > UNDAMPED) {
            all.extend([-2.0, -0.5, 0.0, 0.5, 2.0].map(|k| c.speed * (1.0 + k * c.damping_ratio.min(0.2))));
        }
        all.retain(|w| *w >= from && *w <= to);
        all.sort_unstable_by(f64::total_cmp);
        all.dedup_by(|a, b| *a - *b <= 1e-12 * *b);
        all
    }

    /// Critical speeds at which vibration grows without bound: no damping, and a torque that grows towards them.
    pub fn unbounded(&mut self, critical: &[CriticalSpeed], from: f64, to: f64) -> Vec<CriticalSpeed> {
        let mut found = Vec::new();
        for c in critical.iter().filter(|c| c.damping_ratio <= UNDAMPED && c.speed >= from && c.speed <= to) {
            let mut near = |part: f64| {
                self.at(c.speed * (1.0 - part))
                    .map(|p| p.links.iter().map(|l| l.amplitude).fold(0.0, f64::max))
            };
            let (far, close) = (near(1e-4), near(1e-6));
            if close.is_none_or(|close| far.is_some_and(|far| close > 30.0 * far)) {
                found.push(*c);
            }
        }
        found
    }

    /// Speed and value of the largest of some quantity over ascending speeds that show its peaks.
    pub fn largest(&mut self, speeds: &[f64], sought: &Sought<'_>) -> (f64, f64) {
        let of_point = |p: &Point| match sought {
            Sought::Link(l, quantity) => quantity(&p.links[*l]),
            Sought::Line(quantity) => quantity(p),
        };
        let samples: Vec<(f64, f64)> =
            speeds.iter().filter_map(|w| self.at(*w).map(|p| (*w, of_point(&p)))).collect();
        let mut of_speed = |w| match sought {
            Sought::Link(l, quantity) => self.link_at(w, *l).map(|p| quantity(&p)),
            Sought::Line(quantity) => self.at(w).map(|p| quantity(&p)),
        };
        maximise(&samples, |w| of_speed(w).unwrap_or(f64::NEG_INFINITY))
    }
}

/// An answer of numbers.
fn finite(out: &TorsionOut) -> Result<(), EvalError> {
    let all = |values: &[f64]| values.iter().all(|v| v.is_finite());
    if out.orders.values().iter().all(|values| all_finite(values))
        && all(&out.mean_torque)
        && all(&out.mean_angle)
        && out.balance_torque.is_finite()
    {
        return Ok(());
    }
    Err(EvalError::fatal("torsion", "torques or angles of this speed are beyond all numbers"))
}

fn square([re, im]: [f64; 2]) -> f64 {
    re * re + im * im
}

/// At least the modulus, and at most √2 times it.
fn norm1([re, im]: [f64; 2]) -> f64 {
    re.abs() + im.abs()
}

/// Real and imaginary parts as pairs.
fn phasors([re, im]: PhasorRow<'_>) -> impl Iterator<Item = [f64; 2]> {
    re.iter().zip(im).map(|(re, im)| [*re, *im])
}

fn link_point(cycle: &mut Cycle, out: &TorsionOut, link: usize) -> LinkPoint {
    let torques = out.orders.torque(link);
    let [top, bottom] = cycle.extremes(out.mean_torque[link], torques);
    LinkPoint {
        amplitude: 0.5 * (top - bottom),
        peak: top.abs().max(bottom.abs()),
        heat: out.orders.heat(link).iter().sum(),
        order: strongest(out.orders.orders(), torques),
    }
}

/// The second of the pair with the largest first, the last of several; zero without any.
fn strongest_of(sizes: impl Iterator<Item = (f64, f64)>) -> f64 {
    sizes.fold((0.0, 0.0), |best: (f64, f64), own| if own.0 >= best.0 { own } else { best }).1
}

/// Peak to peak speed of an inertia by the mean speed of the reference shaft.
pub fn speed_fluctuation(cycle: &mut Cycle, out: &TorsionOut, node: usize) -> f64 {
    let (orders, [re, im]) = (out.orders.orders(), out.orders.angle(node));
    let rates = |sign: f64, part: &[f64]| -> Vec<f64> {
        orders.iter().zip(part).map(|(order, x)| sign * order * x).collect()
    };
    let [top, bottom] = cycle.extremes(0.0, [&rates(-1.0, im), &rates(1.0, re)]);
    top - bottom
}

/// Speed of the first inertia of a link by that of the second, untwisted.
fn gear(a: &Assembled, link: usize) -> f64 {
    let [x, y] = a.line.links[link].nodes;
    a.line.nodes[x].ratio / a.line.nodes[y].ratio
}

/// Twist of a link by order.
fn twist_of<'o>(a: &Assembled, out: &'o TorsionOut, link: usize) -> impl Iterator<Item = [f64; 2]> + use<'o> {
    let [x, y] = a.line.links[link].nodes.map(|node| phasors(out.orders.angle(node)));
    let gear = gear(a, link);
    x.zip(y).map(move |(x, y)| [x[0] - gear * y[0], x[1] - gear * y[1]])
}

/// Largest vibratory twist (half of peak to peak) of a link.
pub fn twist_amplitude(cycle: &mut Cycle, a: &Assembled, out: &TorsionOut, link: usize) -> f64 {
    let (re, im): (Vec<f64>, Vec<f64>) = twist_of(a, out, link).map(<(f64, f64)>::from).unzip();
    let [top, bottom] = cycle.extremes(0.0, [&re, &im]);
    0.5 * (top - bottom)
}
