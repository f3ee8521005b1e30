//! Vibration over the speed.

use std::sync::Arc;

use gudgeon_core::EvalError;
use gudgeon_core::file::Files;
use gudgeon_core::kinds::LineThrow;
use gudgeon_core::result::{Column, Figure, FigureKind, Lines, Mark, Note, Series};

use super::envelope::limits_of;
use super::{MAX_DRAWN, Results, column};
use crate::assemble::{Assembled, throws_alone};
use crate::machine::sizes::raise;
use crate::machine::{Machine, Point, Sought};
use crate::verdict::{Operating, forced};
use crate::{draw, rpm, told};

/// Orders drawn of the shaft that vibrates most.
const ORDERS: usize = 6;
/// Part of the largest gas torque by which it may change over the speed without a word.
const SAME_GAS: f64 = 1e-6;

/// The answers at all speeds.
fn points(machine: &mut Machine<'_>, speeds: &[f64]) -> Result<Vec<Arc<Point>>, EvalError> {
    let mut rows = Vec::with_capacity(speeds.len());
    for w in speeds {
        match machine.at(*w) {
            Some(p) => rows.push(p),
            None => return Err(machine.why(*w)),
        }
    }
    Ok(rows)
}

impl Results<'_> {
    /// Largest vibratory torque over the speeds of the diagrams: the shaft that has it (from 0), and the speeds of the peaks.
    ///
    /// # Errors
    /// No answer at a speed.
    pub fn range(
        &mut self,
        machine: &mut Machine<'_>,
        speeds: &[f64],
    ) -> Result<(usize, Vec<f64>), EvalError> {
        let a = machine.a;
        machine.prepare(speeds);
        let rows = points(machine, speeds)?;
        // Peaks between the points count where the limits do; a wider diagram shows what it draws.
        let (from, to) = (speeds[0], speeds[speeds.len() - 1]);
        let judged = Operating::new(self.case);
        let (telling, of) = if judged.from == from && judged.to == to {
            let critical = machine.critical_speeds(from, to)?;
            (machine.telling_speeds(speeds, &critical), "over the speed range")
        } else {
            (Vec::new(), "of the speeds of the diagram")
        };
        let mut top = (0.0, 0, speeds[0]);
        let mut peaks = Vec::new();
        for (l, link) in a.line.links.iter().enumerate() {
            let drawn = rows.iter().zip(speeds).map(|(p, w)| (*w, p.links[l].amplitude));
            let (speed, most) = if telling.is_empty() {
                drawn.fold((from, 0.0), |best, at| if at.1 > best.1 { at } else { best })
            } else {
                machine.largest(&telling, &Sought::Link(l, &|p| p.amplitude))
            };
            if most > top.0 {
                top = (most, l, speed);
            }
            peaks.push(speed);
            self.result(
                format!("range.shaft{}.torque_amplitude", l + 1),
                most,
                "N m",
                format!("largest vibratory torque of {} {of}", link.name),
            );
        }
        let what = "speed of the largest vibratory torque of any shaft";
        self.result("range.worst_speed", rpm(top.2), "rpm", what);
        self.answered(machine, "speed_range");
        Ok((top.1, peaks))
    }

    /// Curves over the speeds of the diagrams and the peaks between them, of all shafts and of the orders of the shaft `worst` in the load step `own`, and of
    /// each shaft in all load steps.
    ///
    /// # Errors
    /// No answer at a speed.
    pub fn over_speed(
        &mut self,
        all: &mut [(String, Machine<'_>)],
        own: usize,
        (diagram, peaks): (&[f64], &[f64]),
        worst: usize,
    ) -> Result<(), EvalError> {
        let machine = &mut all[own].1;
        let a = machine.a;
        let links = a.line.links.len();
        let (from, to) = (diagram[0], diagram[diagram.len() - 1]);
        let mut speeds = diagram.to_vec();
        let inside: Vec<f64> = peaks.iter().copied().filter(|w| *w > from && *w < to).collect();
        speeds.extend(inside.into_iter().filter(|w| machine.at(*w).is_some()));
        speeds.sort_unstable_by(f64::total_cmp);
        speeds.dedup_by(|a, b| *a - *b <= 1e-12 * *b);
        let rows = points(machine, &speeds)?;
        let orders = machine.orders.clone();
        let mut table = Series {
            axis: column("speed", "rpm", speeds.iter().map(|w| rpm(*w)).collect()),
            columns: Vec::new(),
        };
        let mut curves = Vec::new();
        for l in 0..links {
            let name = format!("shaft{}.torque_amplitude", l + 1);
            let values = rows.iter().map(|p| p.links[l].amplitude).collect();
            table.columns.push(column(name.clone(), "N m", values));
            if l < MAX_DRAWN {
                curves.push((a.line.links[l].name.clone(), name));
            }
        }
        let hint = format!("half of peak to peak{}", self.own_step());
        self.lines("Vibratory torque over the speed", &hint, "speed_range", "speed", curves, false);
        self.weigh_critical_speeds(&orders, &rows, &speeds);
        let strengths = strengths(links, &orders, &rows);
        let curves = orders_of(worst, &orders, (&rows, &strengths), &mut table);
        if let Some(l) = a.line.links.get(worst) {
            let title = format!("Orders of {} over the speed", l.name);
            let hint = format!("torque amplitude of the strongest orders{}", self.own_step());
            self.lines(&title, &hint, "speed_range", "speed", curves, false);
        }
        self.order_spectra(a, &orders, (&rows, &strengths), &speeds);
        let steps = in_each(all, &Operating::new(self.case), &speeds);
        self.shafts_over_speed(a, &rows, &mut table, &steps);
        self.out.tables.insert("speed_range".into(), table);
        Ok(())
    }

    /// Name of the load step that the diagrams show, where there are several.
    fn own_step(&self) -> String {
        let all = crate::steps::all(self.case);
        let own = all.iter().find(|s| s.1.is_none()).filter(|_| all.len() > 1);
        own.map_or_else(String::new, |(name, _)| format!(", load step `{name}`"))
    }

    /// Stress over the speed of each shaft that has one, torque of the others that have a limit: a curve a load step, their envelope, limits and operating
    /// range.
    fn shafts_over_speed(
        &mut self,
        a: &Assembled,
        rows: &[Arc<Point>],
        table: &mut Series,
        steps: &InSteps<'_>,
    ) {
        let limits = forced(self.case, a);
        let range = Operating::new(self.case);
        let mut by_step = Series { axis: steps.axis.clone(), columns: Vec::new() };
        for (l, link) in a.line.links.iter().enumerate().take(MAX_DRAWN) {
            let shown = Shown { link: l, name: &link.name, stressed: a.stress[l].is_some() };
            let limits = limits_of(&limits, &link.name, shown.stressed);
            if !shown.stressed && limits.is_empty() {
                continue;
            }
            let (what, unit) = shown.what();
            let own = format!("shaft{}.{what}_amplitude", l + 1);
            if let Some(factor) = shown.factor(a, l).filter(|_| table.get(&own).is_none()) {
                let values = rows.iter().map(|p| factor * p.links[l].amplitude).collect();
                table.columns.push(column(own.clone(), unit, values));
            }
            let (lines, over) = match steps.all.len() {
                0 => (vec![(format!("vibratory {what}"), own)], None),
                _ => shown.curves(steps, &mut by_step),
            };
            let mut marks = vec![Mark::At { x: rpm(self.case.speed.si()), label: "mean speed".into() }];
            if range.is_wide() {
                let (from, to) = (rpm(range.from), rpm(range.to));
                marks.push(Mark::Band { from, to, kept_free: false, label: "operating range".into() });
            }
            marks.extend(limits.into_iter().map(|(y, label)| Mark::Limit { y, label }));
            let (table, step) = match over {
                Some(_) => (IN_STEPS, ", in each load step".to_owned()),
                None => ("speed_range", self.own_step()),
            };
            self.out.figures.push(Figure {
                title: format!("{} over the speed: {what}", link.name),
                hint: format!("half of peak to peak{step}"),
                table: table.into(),
                kind: FigureKind::Lines(Lines { x: "speed".into(), lines, over, marks, ..Lines::default() }),
            });
        }
        if !by_step.columns.is_empty() {
            self.out.tables.insert(IN_STEPS.into(), by_step);
        }
    }

    /// Adds to each critical speed the torque that its order makes in any shaft at the speeds of the diagram beside it, and marks it in the Campbell
    /// diagram by that.
    fn weigh_critical_speeds(&mut self, orders: &[f64], rows: &[Arc<Point>], speeds: &[f64]) {
        let Some(table) = self.out.tables.get_mut("critical_speeds") else { return };
        let (Some(order), Some(mode)) = (table.get("order"), table.get("mode")) else { return };
        let (order, mode) = (order.clone(), mode.clone());
        let range = Operating::new(self.case);
        let torque = |(speed, o): (&f64, &f64)| {
            // An order that nothing excites makes none.
            let Some(k) = orders.iter().position(|other| (other - o).abs() < 1e-6) else { return 0.0 };
            let next = speeds.partition_point(|w| rpm(*w) < *speed).min(speeds.len() - 1);
            let near = next.saturating_sub(1)..=next;
            let links = |p: &Point| (0..p.links.len()).map(|l| p.order_of(l, k)).fold(0.0, f64::max);
            near.map(|j| links(&rows[j])).fold(0.0, f64::max)
        };
        let torques: Vec<f64> = table.axis.values.iter().zip(&order.values).map(torque).collect();
        let largest = torques.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        let kinds = self.out.figures.iter_mut().filter(|f| f.title == draw::CAMPBELL).map(|f| &mut f.kind);
        for kind in kinds {
            let FigureKind::Lines(Lines { marks, .. }) = kind else { continue };
            for m in marks {
                let Mark::Point { x, weight, label, .. } = m else { continue };
                let Some(k) = table.axis.values.iter().position(|speed| speed == x) else { continue };
                *weight = torques[k] / largest;
                label.push_str(&format!(", {:.0} N m in the shaft that feels it most", torques[k]));
            }
        }
        let strongest = (0..torques.len())
            .filter(|k| torques[*k] > 0.0 && range.holds(table.axis.values[*k]))
            .max_by(|x, y| torques[*x].total_cmp(&torques[*y]));
        let strongest =
            strongest.map(|k| (table.axis.values[k], order.values[k], mode.values[k], torques[k]));
        table.columns.push(column("torque_amplitude", "N m", torques));
        if let Some((speed, order, mode, torque)) = strongest {
            let what = format!(
                "critical speed within the operating range whose order makes the largest torque: order {order} and mode {mode}, {torque:.0} N m in the shaft that feels it most"
            );
            self.result("strongest_critical_speed", speed, "rpm", what);
        }
    }

    /// Says at how many speeds the model found no periodic motion.
    pub fn answered(&mut self, machine: &Machine<'_>, subject: &str) {
        let span = |speeds: &[f64]| {
            let low = speeds.iter().copied().fold(f64::INFINITY, f64::min);
            let high = speeds.iter().copied().fold(0.0, f64::max);
            format!("from {} to {}", told(low), told(high))
        };
        let n = machine.spared.len();
        if n > 0 {
            let text = format!(
                "at {n} of the speeds looked at ({}) the model found no periodic motion: `orders` answers there",
                span(&machine.spared)
            );
            let note = Note::caution(format!("no_periodic_motion.{subject}"), text);
            self.note(&[note.amount("speeds", n as f64, "1")]);
        }
        if let Some((_, why)) = machine.failed.first() {
            let speeds: Vec<f64> = machine.failed.iter().map(|f| f.0).collect();
            let text = format!(
                "at {} of the speeds looked at ({}) there is no answer, and nothing is judged: {why}",
                speeds.len(),
                span(&speeds)
            );
            let note = Note::caution(format!("no_answer.{subject}"), text);
            self.note(&[note.amount("speeds", speeds.len() as f64, "1")]);
        }
    }

    /// Says by how much the gas torque at the ends of the range differs from that at the mean speed, which is taken everywhere.
    pub fn gas_over_speed(&mut self, a: &Assembled, files: &Files, speeds: &[f64]) {
        if !a.line.throws.iter().flat_map(|t| &t.ends).any(|e| e.pressure.depends_on_speed()) {
            return;
        }
        let mut worst = (0.0, 0.0);
        let ends = [speeds.first(), speeds.last()].into_iter().flatten();
        let others: Vec<(f64, Vec<LineThrow>)> =
            ends.filter_map(|w| Some((*w, throws_alone(self.case, files, *w).ok()?))).collect();
        let alike = |all: &[LineThrow], k: usize| k > 0 && all[k].is_like(&all[k - 1]);
        for (k, mean) in a.line.throws.iter().enumerate() {
            let torque = |t: &LineThrow, degrees: i32| {
                let at = f64::from(degrees).to_radians() - mean.phase;
                t.gas_torque(at, at)
            };
            let unlike = others.iter().filter(|(_, all)| !(alike(&a.line.throws, k) && alike(all, k)));
            let mut own = Vec::new();
            for (w, all) in unlike {
                if own.is_empty() {
                    own.extend((0..720).map(|degrees| torque(mean, degrees)));
                }
                let (largest, change) =
                    own.iter().zip(0..).fold((0.0, 0.0), |(largest, change): (f64, f64), (own, degrees)| {
                        let other = torque(&all[k], degrees);
                        (largest.max(own.abs()), change.max((other - own).abs()))
                    });
                if change > worst.0 * largest {
                    worst = (change / largest, *w);
                }
            }
        }
        if worst.0 > SAME_GAS {
            let text = format!(
                "cylinder pressures are those of the mean speed at all speeds; at {} the gas torque of a throw would differ by up to {:.2} % of its largest",
                told(worst.1),
                100.0 * worst.0
            );
            let note = Note::caution("gas_over_speed", text);
            self.note(&[note.amount("largest_change", 100.0 * worst.0, "%")]);
        }
    }
}

/// Table of the shafts over the speed in each load step.
const IN_STEPS: &str = "shafts_over_speed";

/// Several load steps over the speed.
struct InSteps<'a> {
    axis: Column,
    /// Number, name, line and vibration of each; empty where the diagrams show all there is.
    all: Vec<(usize, String, &'a Assembled, Vec<Arc<Point>>)>,
}

/// The load steps that have an answer at all speeds of the diagrams within the operating range, where the verdict asked for most of them, and at every second one
/// beside it, where nothing is judged. None where no range is judged.
fn in_each<'a>(all: &mut [(String, Machine<'a>)], range: &Operating, speeds: &[f64]) -> InSteps<'a> {
    let inside = |w: f64| w >= range.from && w <= range.to;
    let shown: Vec<f64> = speeds
        .iter()
        .copied()
        .enumerate()
        .filter(|(k, w)| inside(*w) || k % 2 == 0)
        .map(|(_, w)| w)
        .collect();
    let mut steps = Vec::new();
    if all.len() > 1 && range.is_wide() {
        for (number, (name, machine)) in all.iter_mut().enumerate() {
            machine.prepare(&shown);
            steps.extend(points(machine, &shown).ok().map(|rows| (number, name.clone(), machine.a, rows)));
        }
    }
    InSteps { axis: column("speed", "rpm", shown.iter().map(|w| rpm(*w)).collect()), all: steps }
}

/// Label and column of a curve.
type Curve = (String, String);

/// A shaft whose stress is shown, or whose torque.
struct Shown<'n> {
    link: usize,
    name: &'n str,
    stressed: bool,
}

impl Shown<'_> {
    const fn what(&self) -> (&'static str, &'static str) {
        if self.stressed { ("stress", "MPa") } else { ("torque", "N m") }
    }

    /// What is shown by the torque, of link `at` of a line.
    fn factor(&self, a: &Assembled, at: usize) -> Option<f64> {
        if self.stressed { a.stress[at].map(|s| s / 1e6) } else { Some(1.0) }
    }

    /// Adds its amplitudes in each load step that has it, and their envelope.
    fn curves(&self, steps: &InSteps<'_>, table: &mut Series) -> (Vec<Curve>, Option<Curve>) {
        let (what, unit) = self.what();
        let n = self.link + 1;
        let mut lines = Vec::new();
        let mut envelope = vec![0.0_f64; steps.axis.values.len()];
        for (number, name, a, rows) in &steps.all {
            let Some(at) = a.line.links.iter().position(|x| x.name == self.name) else { continue };
            let Some(factor) = self.factor(a, at) else { continue };
            let values: Vec<f64> = rows.iter().map(|p| factor * p.links[at].amplitude).collect();
            envelope.iter_mut().zip(&values).for_each(|(e, v)| *e = e.max(*v));
            let own = format!("shaft{n}.step{}.{what}_amplitude", number + 1);
            table.columns.push(column(own.clone(), unit, values));
            lines.push((name.clone(), own));
        }
        let over = format!("shaft{n}.{what}_envelope");
        table.columns.push(column(over.clone(), unit, envelope));
        (lines, Some(("envelope".into(), over)))
    }
}

/// Largest torque amplitudes over the speed, by shaft and order \[N m\].
fn strengths(links: usize, orders: &[f64], rows: &[Arc<Point>]) -> Vec<Vec<f64>> {
    let mut most = vec![0.0; links * orders.len()];
    rows.iter().for_each(|p| raise(&mut most, &p.orders));
    most.chunks(orders.len().max(1)).map(<[f64]>::to_vec).collect()
}

/// Columns of the strongest orders of a shaft over the speed, with their labels.
fn orders_of(
    link: usize,
    orders: &[f64],
    (rows, strengths): (&[Arc<Point>], &[Vec<f64>]),
    table: &mut Series,
) -> Vec<(String, String)> {
    let most = |k: usize| strengths.iter().map(|s| s[k]).fold(0.0, f64::max);
    let mut strongest: Vec<(f64, usize)> = (0..orders.len()).map(|k| (most(k), k)).collect();
    strongest.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut curves = Vec::new();
    for (_, k) in strongest.iter().take(ORDERS) {
        let name = format!("shaft{}.order{}", link + 1, orders[*k]);
        let column_of = rows.iter().map(|p| p.order_of(link, *k)).collect();
        table.columns.push(column(name.clone(), "N m", column_of));
        curves.push((format!("order {}", orders[*k]), name));
    }
    curves
}
