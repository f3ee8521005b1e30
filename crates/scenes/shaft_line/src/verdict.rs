//! Holds a line against its limits over its operating range, in all its load steps.

use gudgeon_core::kinds::TorsionAnswer;
use gudgeon_numerics::elementary;
use gudgeon_torsion::critical::CriticalSpeed;

use super::assemble::Assembled;
use super::case::{SeparationLimit, ShaftLineCase, StressLimit};
use super::machine::{LinkPoint, Machine, Point, Sought};
use super::told;

/// Share of a limit that stands for vibration without bound.
pub const UNBOUNDED: f64 = 1e6;
/// Shares of limits, by the largest, below which samples are good enough.
const CLOSE: f64 = 0.7;
/// Points of the operating range where no diagram gives any.
const GRID: usize = 97;
/// Speeds at which natural frequencies that depend on the speed are compared with excitations.
const COMPARED: usize = 33;
/// Modes looked at, the rigid ones included.
pub const MODES: usize = 40;

/// Speeds over which limits are judged.
#[derive(Debug, Clone, PartialEq)]
pub struct Operating {
    /// Lowest and highest speed \[rad/s\].
    pub from: f64,
    /// See `from`.
    pub to: f64,
    /// Where they come from.
    pub given_by: &'static str,
}

impl Operating {
    /// Of a case.
    pub fn new(case: &ShaftLineCase) -> Self {
        let steady = case.models.torsion.answers() != TorsionAnswer::Time;
        match (&case.operating, case.range.from, case.range.to) {
            (Some(o), ..) if steady => Self { from: o.from.si(), to: o.to.si(), given_by: "`operating`" },
            (None, Some(a), Some(b)) if steady => Self { from: a.si(), to: b.si(), given_by: "`range`" },
            _ => Self { from: case.speed.si(), to: case.speed.si(), given_by: "the mean speed alone" },
        }
    }

    /// Whether a speed \[rpm\] lies within it.
    pub fn holds(&self, speed: f64) -> bool {
        self.is_wide() && speed >= super::rpm(self.from) && speed <= super::rpm(self.to)
    }

    /// Whether it is more than one speed.
    pub fn is_wide(&self) -> bool {
        self.to > self.from
    }

    /// Speeds evenly over it: those of the diagram where that has many within it.
    pub fn grid(&self, diagram: &[f64]) -> Vec<f64> {
        if !self.is_wide() {
            return vec![self.from];
        }
        let mut inside: Vec<f64> =
            diagram.iter().copied().filter(|w| *w > self.from && *w < self.to).collect();
        if inside.len() < GRID / 2 {
            inside = (1..GRID - 1)
                .map(|i| self.from + (self.to - self.from) * i as f64 / (GRID - 1) as f64)
                .collect();
        }
        inside.insert(0, self.from);
        inside.push(self.to);
        inside
    }

    /// In words.
    pub fn words(&self) -> String {
        if self.is_wide() {
            format!("from {} to {} ({})", told(self.from), told(self.to), self.given_by)
        } else {
            format!("at {} ({})", told(self.from), self.given_by)
        }
    }
}

/// A quantity of the forced vibration that has a limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Half of peak to peak torque of a link.
    Torque,
    /// Largest torque of a link.
    Peak,
    /// The same as `Torque`, told as stress.
    Stress,
    /// Heat of a link.
    Heat,
    /// Coefficient of speed fluctuation of an inertia.
    SpeedFluctuation,
}

/// A limit on forced vibration.
#[derive(Debug, Clone, PartialEq)]
pub struct Forced {
    /// What it is of.
    pub quantity: Quantity,
    /// Name of the shaft or inertia.
    pub subject: String,
    /// Largest admitted value, in the unit of the quantity.
    pub admitted: f64,
    /// Where it comes from.
    pub source: String,
    /// Names of the load steps in which it counts; empty: all.
    pub load_steps: Vec<String>,
}

/// Five digits without a power of ten, where that is readable.
fn plain(value: f64) -> String {
    let size = value.abs();
    if size >= 1e7 || (size > 0.0 && size < 1e-3) {
        return format!("{value:.4e}");
    }
    let decimals =
        if size > 0.0 { (4 - elementary::log10(size).floor() as i32).clamp(0, 6) as usize } else { 0 };
    format!("{value:.decimals$}")
}

impl Forced {
    /// `stress in crank 4-5`.
    pub fn label(&self) -> String {
        let what = match self.quantity {
            Quantity::Torque => "torque in",
            Quantity::Peak => "peak torque in",
            Quantity::Stress => "stress in",
            Quantity::Heat => "heat of",
            Quantity::SpeedFluctuation => "speed irregularity of",
        };
        format!("{what} {}", self.subject)
    }

    /// A value of the quantity in words.
    pub fn told(&self, value: f64) -> String {
        match self.quantity {
            Quantity::Torque | Quantity::Peak => format!("{} N m", plain(value)),
            Quantity::Stress => format!("{} MPa", plain(value / 1e6)),
            Quantity::Heat => format!("{} W", plain(value)),
            Quantity::SpeedFluctuation => format!("{value:.6}"),
        }
    }

    /// Whether it counts in a load step.
    pub fn counts_in(&self, step: &str) -> bool {
        counts(&self.load_steps, step)
    }

    /// Place of the subject in a line, and what makes the quantity of the torque there; none where the line of a load step lacks it.
    pub fn place(&self, a: &Assembled) -> Option<(usize, f64)> {
        match self.quantity {
            Quantity::SpeedFluctuation => {
                a.line.nodes.iter().position(|n| n.name == self.subject).map(|i| (i, 1.0))
            }
            _ => {
                let l = a.line.links.iter().position(|l| l.name == self.subject)?;
                let factor = if self.quantity == Quantity::Stress { a.stress[l]? } else { 1.0 };
                Some((l, factor))
            }
        }
    }

    /// The quantity at a point; of a stress the torque, whose tops are known from elsewhere.
    pub fn value(&self, at: usize, p: &Point) -> f64 {
        match self.quantity {
            Quantity::SpeedFluctuation => p.speed_fluctuation.get(at).copied().unwrap_or(0.0),
            _ => self.of_link(&p.links[at]),
        }
    }

    /// The quantity in its link; zero of what is of an inertia.
    fn of_link(&self, p: &LinkPoint) -> f64 {
        match self.quantity {
            Quantity::Torque | Quantity::Stress => p.amplitude,
            Quantity::Peak => p.peak,
            Quantity::Heat => p.heat,
            Quantity::SpeedFluctuation => 0.0,
        }
    }

    /// Order of the largest torque or speed there.
    fn order(&self, at: usize, p: &Point) -> Option<f64> {
        match self.quantity {
            Quantity::SpeedFluctuation => p.fluctuation_order.get(at).copied(),
            _ => Some(p.links[at].order),
        }
    }
}

/// Whether a limit with these load steps counts in one.
fn counts(load_steps: &[String], step: &str) -> bool {
    load_steps.is_empty() || load_steps.iter().any(|s| s == step)
}

/// All limits on forced vibration of a case.
pub fn forced(case: &ShaftLineCase, a: &Assembled) -> Vec<Forced> {
    let mut all = Vec::new();
    let mut add = |quantity, subject: &str, admitted: f64, source: &str, load_steps: &[String]| {
        let load_steps = load_steps.to_vec();
        all.push(Forced { quantity, subject: subject.into(), admitted, source: source.into(), load_steps });
    };
    let limits = &case.limits;
    for l in &limits.torque {
        if let Some(limit) = l.amplitude {
            add(Quantity::Torque, &l.shaft, limit.si(), &l.source, &l.load_steps);
        }
        if let Some(limit) = l.peak {
            add(Quantity::Peak, &l.shaft, limit.si(), &l.source, &l.load_steps);
        }
    }
    for l in &limits.stress {
        for (link, _) in a.line.links.iter().zip(&a.stress).filter(|(_, s)| s.is_some()) {
            if let Some(load_steps) = stress_counts(case, l, &link.name) {
                add(Quantity::Stress, &link.name, l.amplitude.si(), &l.source, &load_steps);
            }
        }
    }
    for l in &limits.heat {
        add(Quantity::Heat, &l.shaft, l.power.si(), &l.source, &l.load_steps);
    }
    for l in &limits.irregularity {
        add(Quantity::SpeedFluctuation, &l.inertia, l.coefficient.si(), &l.source, &l.load_steps);
    }
    all
}

/// Load steps (empty: all) in which a limit on stress counts for a shaft, none where it does not: one for all shafts stands back behind one of the
/// shaft itself.
fn stress_counts(case: &ShaftLineCase, l: &StressLimit, shaft: &str) -> Option<Vec<String>> {
    if !l.shaft.is_empty() {
        return (l.shaft == shaft).then(|| l.load_steps.clone());
    }
    let own: Vec<&StressLimit> = case.limits.stress.iter().filter(|o| o.shaft == shaft).collect();
    if own.is_empty() {
        return Some(l.load_steps.clone());
    }
    let names = super::steps::all(case).into_iter().map(|(name, _)| name);
    let left = names.filter(|n| counts(&l.load_steps, n) && !own.iter().any(|o| counts(&o.load_steps, n)));
    let left: Vec<String> = left.map(str::to_owned).collect();
    (!left.is_empty()).then_some(left)
}

/// A limit in one load step.
#[derive(Debug, Clone, PartialEq)]
pub struct Judged {
    /// Share of the limit that is used.
    pub used: f64,
    /// Value and place, in words.
    pub text: String,
    /// The value in words.
    pub found: String,
    /// Speed \[rad/s\] where it is used most.
    pub speed: f64,
    /// The order that makes most of it there.
    pub order: Option<f64>,
}

/// A separation that is not kept, and why it is accepted.
#[derive(Debug, Clone, PartialEq)]
pub struct Accepted {
    /// Key for notes: `mode2.order8`.
    pub key: String,
    /// In words.
    pub text: String,
    /// Share of the limit used most there.
    pub used: f64,
    /// Names of the load steps, that with the most used limit first.
    pub steps: Vec<String>,
}

impl Accepted {
    /// Adds one to others: those of the same mode and excitation are one, told where a limit is used most.
    pub fn gather(self, all: &mut Vec<Self>) {
        match all.iter_mut().find(|a| a.key == self.key) {
            Some(a) if a.used >= self.used => a.steps.extend(self.steps),
            Some(a) => {
                let before = std::mem::replace(a, self);
                a.steps.extend(before.steps);
            }
            None => all.push(self),
        }
    }
}

/// One limit over all load steps.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// What is limited.
    pub label: String,
    /// What is allowed, in words.
    pub allowed: String,
    /// Where the limit comes from.
    pub source: String,
    /// By load step; none where its line does not have the subject.
    pub steps: Vec<Option<Judged>>,
}

impl Row {
    /// Load step and judgement in which the limit is used most.
    pub fn worst(&self) -> Option<(usize, &Judged)> {
        let judged = self.steps.iter().enumerate().filter_map(|(k, j)| j.as_ref().map(|j| (k, j)));
        judged.fold(None, |best: Option<(usize, &Judged)>, j| match best {
            Some(b) if b.1.used >= j.1.used => Some(b),
            _ => Some(j),
        })
    }
}

/// One load step while it is judged.
#[derive(Debug)]
pub struct Step<'m, 'a> {
    /// Its name.
    pub name: String,
    /// The line.
    pub machine: &'m mut Machine<'a>,
    /// Speeds that show its peaks.
    pub speeds: Vec<f64>,
    /// Its critical speeds within the operating range.
    pub critical: Vec<CriticalSpeed>,
    /// Those of them without damping.
    pub unbounded: Vec<CriticalSpeed>,
}

impl<'m, 'a> Step<'m, 'a> {
    /// Looks for the speeds at which peaks can be.
    ///
    /// # Errors
    /// No convergence of natural frequencies.
    pub fn new(
        name: &str,
        machine: &'m mut Machine<'a>,
        range: &Operating,
        diagram: &[f64],
    ) -> Result<Self, gudgeon_core::EvalError> {
        let grid = range.grid(diagram);
        let critical =
            if range.is_wide() { machine.critical_speeds(range.from, range.to)? } else { Vec::new() };
        let speeds = machine.telling_speeds(&grid, &critical);
        machine.prepare(&speeds);
        let unbounded = machine.unbounded(&critical, range.from, range.to);
        Ok(Self { name: name.into(), machine, speeds, critical, unbounded })
    }

    /// The speeds that show peaks between two speeds of the range, these included.
    fn between(&self, from: f64, to: f64) -> Vec<f64> {
        let mut speeds: Vec<f64> = self.speeds.iter().copied().filter(|w| *w > from && *w < to).collect();
        speeds.insert(0, from);
        if to > from {
            speeds.push(to);
        }
        speeds
    }

    /// The limit at its worst over some speeds.
    fn worst_over(&mut self, limit: &Forced, speeds: &[f64]) -> Option<(f64, f64)> {
        let (at, factor) = limit.place(self.machine.a)?;
        let (speed, value) = match limit.quantity {
            Quantity::SpeedFluctuation => {
                self.machine.largest(speeds, &Sought::Line(&|p| limit.value(at, p)))
            }
            _ => self.machine.largest(speeds, &Sought::Link(at, &|p| limit.of_link(p))),
        };
        value.is_finite().then_some((speed, factor * value))
    }

    /// One limit on forced vibration over the operating range.
    pub fn judge(&mut self, limit: &Forced, range: &Operating) -> Option<Judged> {
        if !limit.counts_in(&self.name) {
            return None;
        }
        let place = limit.place(self.machine.a)?;
        let speeds = self.between(range.from, range.to);
        let (speed, value) = self.worst_over(limit, &speeds)?;
        if let Some(c) = self.unbounded.first() {
            let text = format!(
                "grows without bound at {}: order {} meets mode {}, which nothing damps",
                told(c.speed),
                c.order,
                c.mode
            );
            let found = "no bound".into();
            return Some(Judged { used: UNBOUNDED, text, found, speed: c.speed, order: Some(c.order) });
        }
        let order = self.machine.at(speed).and_then(|p| limit.order(place.0, &p));
        let mostly = order.map_or_else(String::new, |o| format!(", mostly order {o}"));
        let found = limit.told(value);
        let text = format!("{found} of {} at {}{mostly}", limit.told(limit.admitted), told(speed));
        Some(Judged { used: value / limit.admitted, text, found, speed, order })
    }

    /// Share of the limit that is used most at a critical speed, of those limits of which its order makes the largest part; and which.
    pub fn used_by(&mut self, limits: &[Forced], c: &CriticalSpeed) -> Option<(f64, String)> {
        if self.unbounded.iter().any(|u| u.speed == c.speed && u.order == c.order) {
            return Some((UNBOUNDED, "vibration without bound".into()));
        }
        let (a, name) = (self.machine.a, &self.name);
        let point = &self.machine.at(c.speed)?;
        let shares = limits.iter().filter(|l| l.counts_in(name)).filter_map(|l| {
            let (at, factor) = l.place(a)?;
            (l.order(at, point) == Some(c.order)).then(|| (factor * l.value(at, point) / l.admitted, l))
        });
        let most = shares.fold(None, |best: Option<(f64, &Forced)>, own| match best {
            Some(b) if b.0 >= own.0 => best,
            _ => Some(own),
        });
        most.map(|(used, l)| (used, l.label()))
    }

    /// Share of the limit on forced vibration that is used most between two speeds, and which; none without limits.
    pub fn most_used(&mut self, limits: &[Forced], from: f64, to: f64) -> Option<(f64, String)> {
        if self.unbounded.iter().any(|c| c.speed >= from && c.speed <= to) {
            return Some((UNBOUNDED, "vibration without bound".into()));
        }
        let speeds = self.between(from, to);
        let mut sampled: Vec<(f64, &Forced)> = Vec::new();
        for l in limits.iter().filter(|l| l.counts_in(&self.name)) {
            let Some((at, factor)) = l.place(self.machine.a) else { continue };
            let values = speeds.iter().filter_map(|w| self.machine.at(*w).map(|p| factor * l.value(at, &p)));
            sampled.push((values.fold(0.0, f64::max) / l.admitted, l));
        }
        sampled.sort_by(|a, b| b.0.total_cmp(&a.0));
        // Speeds that show the peaks tell whether a limit is broken; how near one comes to it is worth a closer look.
        if sampled.first().is_some_and(|s| s.0 <= 1.0) {
            let near = CLOSE * sampled[0].0.max(CLOSE);
            for s in sampled.iter_mut().filter(|s| s.0 >= near) {
                s.0 = self.worst_over(s.1, &speeds).map_or(s.0, |w| (w.1 / s.1.admitted).max(s.0));
            }
            sampled.sort_by(|a, b| b.0.total_cmp(&a.0));
        }
        sampled.first().map(|(used, l)| (*used, l.label()))
    }
}

/// What excites natural frequencies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Excitation {
    /// An order of the speed.
    Order(f64),
    /// A fixed frequency \[Hz\].
    Fixed(f64),
}

impl Excitation {
    /// All that a limit names.
    pub fn of(limit: &SeparationLimit) -> impl Iterator<Item = Self> + '_ {
        let orders = limit.orders.iter().map(|o| Self::Order(*o));
        orders.chain(limit.frequencies.iter().map(|f| Self::Fixed(f.si())))
    }

    /// Angular frequency \[rad/s\] at a speed.
    fn omega(self, speed: f64) -> f64 {
        match self {
            Self::Order(o) => o * speed,
            Self::Fixed(f) => f * 2.0 * std::f64::consts::PI,
        }
    }

    /// In words.
    pub fn words(self) -> String {
        match self {
            Self::Order(o) => format!("order {o}"),
            Self::Fixed(f) => format!("{f} Hz"),
        }
    }

    /// For keys.
    fn key(self) -> String {
        match self {
            Self::Order(o) => format!("order{o}"),
            Self::Fixed(f) => format!("{f}hz"),
        }
    }
}

/// Separation of natural frequency and excitation by the excitation: the one definition of limit, report and diagram.
pub fn separation(omega: f64, excitation: f64) -> f64 {
    (omega - excitation) / excitation
}

/// Natural frequencies at speeds of the operating range.
#[derive(Debug, Clone, PartialEq)]
pub struct Spectra {
    /// Whether they are the same at all speeds.
    fixed: bool,
    speeds: Vec<f64>,
    omega: Vec<Vec<f64>>,
}

impl Spectra {
    /// At speeds evenly over the range.
    ///
    /// # Errors
    /// No convergence.
    pub fn new(machine: &mut Machine<'_>, range: &Operating) -> Result<Self, gudgeon_core::EvalError> {
        let n = if range.is_wide() { COMPARED } else { 1 };
        let fixed = !machine.steady.depends_on_speed();
        let at = |i: usize| range.from + (range.to - range.from) * i as f64 / (n - 1).max(1) as f64;
        let speeds: Vec<f64> = (0..n).map(at).collect();
        let speed = machine.steady.speed;
        let mut omega = Vec::new();
        for w in &speeds {
            match omega.first() {
                Some(first) if fixed => omega.push(Vec::clone(first)),
                _ => {
                    machine.steady.set_speed(*w);
                    omega.push(machine.steady.frequencies(MODES)?);
                }
            }
        }
        machine.steady.set_speed(speed);
        Ok(Self { fixed, speeds, omega })
    }

    /// Least separation from an excitation over the range with mode (from 1) and speed; zero where they meet.
    pub fn nearest(&self, e: Excitation) -> Option<(f64, usize, f64)> {
        let mut best: Option<(f64, usize, f64)> = None;
        let modes = self.omega.iter().map(Vec::len).min().unwrap_or(0);
        let mut offer = |d: f64, mode: usize, speed: f64| {
            if best.is_none_or(|b| d.abs() < b.0) {
                best = Some((d.abs(), mode, speed));
            }
        };
        for m in 0..modes {
            let d: Vec<f64> =
                self.speeds.iter().zip(&self.omega).map(|(w, o)| separation(o[m], e.omega(*w))).collect();
            for (d, w) in d.iter().zip(&self.speeds) {
                offer(*d, m + 1, *w);
            }
            for (pair, w) in d.windows(2).zip(self.speeds.windows(2)).filter(|(d, _)| d[0] * d[1] < 0.0) {
                // Where a straight line between them meets; exact for frequencies that do not depend on the speed.
                let met = match e {
                    Excitation::Order(o) if self.fixed => self.omega[0][m] / o,
                    _ => w[0] + (w[1] - w[0]) * pair[0] / (pair[0] - pair[1]),
                };
                offer(0.0, m + 1, met);
            }
        }
        best
    }

    /// Least separation of a mode (from 0) from an excitation over the range, signed, with the frequency \[rad/s\] there; zero where they meet.
    pub fn of_mode(&self, e: Excitation, mode: usize) -> Option<(f64, f64)> {
        let d = |i: usize| {
            Some((separation(*self.omega[i].get(mode)?, e.omega(self.speeds[i])), self.omega[i][mode]))
        };
        let all: Vec<(f64, f64)> = (0..self.speeds.len()).map(d).collect::<Option<_>>()?;
        let met = all.windows(2).find(|w| w[0].0 * w[1].0 < 0.0);
        match met {
            Some(w) => Some((0.0, w[0].1 + (w[1].1 - w[0].1) * w[0].0 / (w[0].0 - w[1].0))),
            None => all.into_iter().min_by(|a, b| a.0.abs().total_cmp(&b.0.abs())),
        }
    }

    /// Lowest and highest frequency \[rad/s\] of a mode (from 0) over the range.
    pub fn span(&self, mode: usize) -> Option<[f64; 2]> {
        let all = self.omega.iter().map(|o| o.get(mode).copied()).collect::<Option<Vec<f64>>>()?;
        let lowest = all.iter().copied().reduce(f64::min)?;
        Some([lowest, all.into_iter().fold(lowest, f64::max)])
    }

    /// Parts of the range in which some mode is nearer to an excitation than `margin`: mode, from, to.
    pub fn near(&self, e: Excitation, margin: f64) -> Vec<(usize, f64, f64)> {
        let mut found = Vec::new();
        let modes = self.omega.iter().map(Vec::len).min().unwrap_or(0);
        for m in 0..modes {
            let d = |i: usize| separation(self.omega[i][m], e.omega(self.speeds[i]));
            if self.speeds.len() == 1 {
                if d(0).abs() < margin {
                    found.push((m + 1, self.speeds[0], self.speeds[0]));
                }
                continue;
            }
            let mut part: Option<(f64, f64)> = None;
            for i in 1..self.speeds.len() {
                // Straight between two speeds: the part of it where |d| < margin.
                let (a, b) = (d(i - 1), d(i));
                let (w0, w1) = (self.speeds[i - 1], self.speeds[i]);
                let cut = |level: f64| if b == a { 0.0 } else { ((level - a) / (b - a)).clamp(0.0, 1.0) };
                let (s, t) = (cut(margin).min(cut(-margin)), cut(margin).max(cut(-margin)));
                let within = if b == a { a.abs() < margin } else { t > s };
                if within {
                    let (s, t) = if b == a { (0.0, 1.0) } else { (s, t) };
                    let (x, y) = (w0 + s * (w1 - w0), w0 + t * (w1 - w0));
                    part = Some(part.map_or((x, y), |p| (p.0.min(x), p.1.max(y))));
                }
            }
            found.extend(part.map(|(x, y)| (m + 1, x, y)));
        }
        found
    }
}

/// Judges the separation from one excitation in one load step. `why` receives what was accepted.
pub fn judge_separation(
    step: &mut Step<'_, '_>,
    spectra: &Spectra,
    e: Excitation,
    limit: &SeparationLimit,
    limits: &[Forced],
    why: &mut Vec<Accepted>,
) -> Option<Judged> {
    if !counts(&limit.load_steps, &step.name) {
        return None;
    }
    let margin = limit.margin.si();
    let (least, mode, speed) = spectra.nearest(e)?;
    let order = match e {
        Excitation::Order(o) => Some(o),
        Excitation::Fixed(_) => None,
    };
    let found = format!("{:.1} % (mode {mode})", 100.0 * least);
    let judged = |used, text| Judged { used, text, found, speed, order };
    let away = if least == 0.0 {
        format!("mode {mode} meets it at {}", told(speed))
    } else {
        format!("mode {mode} is {:.1} % away at {}", 100.0 * least, told(speed))
    };
    let text = format!("{away}, {:.1} % are wanted", 100.0 * margin);
    let used = if least * UNBOUNDED > margin { margin / least } else { UNBOUNDED };
    if used <= 1.0 {
        return Some(judged(used, text));
    }
    // Nothing in the forced vibration answers to a frequency that is no order.
    let asked = order.is_some() && limit.accept_by_response;
    let parts = if asked { spectra.near(e, margin) } else { Vec::new() };
    let mut accepted = Vec::new();
    for (mode, from, to) in &parts {
        match step.most_used(limits, *from, *to) {
            Some((used, which)) if used <= 1.0 => {
                let text = format!(
                    "mode {mode} and {} are closer than {:.1} % {}: accepted, for the forced vibration there keeps every limit ({which} uses {used:.4})",
                    e.words(),
                    100.0 * margin,
                    if to > from {
                        format!("from {} to {}", told(*from), told(*to))
                    } else {
                        format!("at {}", told(*from))
                    },
                );
                let key = format!("mode{mode}.{}", e.key());
                accepted.push(Accepted { key, text, used, steps: vec![step.name.clone()] });
            }
            // Where they meet, the vibration says by how much it is too large.
            Some((most, which)) if least == 0.0 => {
                let text = format!("{text}, and {which} uses {most:.4} of its limit there");
                return Some(judged(most, text));
            }
            _ => return Some(judged(used, text)),
        }
    }
    if accepted.is_empty() {
        return Some(judged(used, text));
    }
    let used = accepted.iter().map(|a| a.used).fold(0.0, f64::max);
    why.extend(accepted);
    Some(judged(used, format!("{text}; accepted by the forced vibration")))
}
