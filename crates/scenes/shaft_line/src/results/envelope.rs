//! The largest vibration over the operating range and all load steps.

use gudgeon_core::result::{Figure, FigureKind, Lines, Mark, Note, Series};

use super::periodic::LINEAR;
use super::{MAX_DRAWN, Results, column};
use crate::assemble::Assembled;
use crate::machine::Sought;
use crate::verdict::{Forced, Operating, Quantity, Step, UNBOUNDED};
use crate::{rpm, told};

/// Largest torque amplitude of a link: value, speed, load step, order.
struct Top {
    amplitude: f64,
    speed: f64,
    step: usize,
    order: f64,
}

impl Results<'_> {
    /// Largest torque of each link with its place, curves of it over the speed, one a load step.
    pub fn envelope(
        &mut self,
        steps: &mut [Step<'_, '_>],
        (range, diagram): (&Operating, &[f64]),
        names: &[String],
        limits: &[Forced],
        peaks: &mut Vec<f64>,
    ) {
        let Some(a) = steps.first().map(|s| s.machine.a) else { return };
        let mut tops = Vec::new();
        for (l, link) in a.line.links.iter().enumerate() {
            let Some(top) = top_of(steps, &link.name) else { continue };
            let n = l + 1;
            let name = &link.name;
            self.result(
                format!("envelope.shaft{n}.torque_amplitude"),
                top.amplitude,
                "N m",
                format!("largest vibratory torque of {name} over operating range and load steps"),
            );
            if let Some(s) = a.stress[l] {
                self.result(
                    format!("envelope.shaft{n}.stress_amplitude"),
                    s * top.amplitude / 1e6,
                    "MPa",
                    format!("largest vibratory stress of {name} over operating range and load steps"),
                );
            }
            let what = format!("speed of the largest vibratory torque of {name}");
            self.result(format!("envelope.shaft{n}.speed"), rpm(top.speed), "rpm", what);
            let what = format!("strongest order of {name} there");
            self.result(format!("envelope.shaft{n}.order"), top.order, "", what);
            if names.len() > 1 {
                let what = format!("load step there: {}", names[top.step]);
                self.result(format!("envelope.shaft{n}.load_step"), (top.step + 1) as f64, "", what);
            }
            tops.push((l, top));
        }
        peaks.extend(tops.iter().map(|t| t.1.speed));
        self.limited(steps, range, names, limits);
        self.large_motion(steps, names);
        if range.is_wide() {
            self.curves(steps, (range, diagram, peaks), names, limits, &tops);
        }
    }

    /// Largest heat and irregularity, of what has a limit on it.
    fn limited(
        &mut self,
        steps: &mut [Step<'_, '_>],
        range: &Operating,
        names: &[String],
        limits: &[Forced],
    ) {
        for l in limits {
            let Some((key, unit, what)) = limited_key(steps[0].machine.a, l) else { continue };
            let judged = steps.iter_mut().enumerate().filter_map(|(k, s)| Some((k, s.judge(l, range)?)));
            let Some((k, worst)) = judged.max_by(|a, b| a.1.used.total_cmp(&b.1.used)) else { continue };
            if worst.used >= UNBOUNDED {
                continue;
            }
            let step = if names.len() > 1 { format!(", load step {}", names[k]) } else { String::new() };
            let what = format!(
                "largest {what} of {} over operating range and load steps, at {}{step}",
                l.subject,
                told(worst.speed)
            );
            self.result(format!("envelope.{key}"), worst.used * l.admitted, unit, what);
        }
    }

    /// Says where vibration is larger than what is computed can be.
    fn large_motion(&mut self, steps: &mut [Step<'_, '_>], names: &[String]) {
        let mut worst = [(0.0, 0.0, 0); 2];
        for (k, s) in steps.iter_mut().enumerate() {
            for w in s.speeds.clone() {
                let Some(p) = s.machine.at(w) else { continue };
                let fluctuation = p.speed_fluctuation.iter().copied().fold(0.0, f64::max);
                for (worst, value) in worst.iter_mut().zip([p.twist, fluctuation]) {
                    if value > worst.0 {
                        *worst = (value, w, k);
                    }
                }
            }
        }
        for ((value, speed, step), (topic, what, unit)) in worst.into_iter().zip([
            ("linear_twist.operating_range", "a shaft twists by", "rad"),
            ("linear_speed.operating_range", "the speed of an inertia goes up and down by", "of its mean"),
        ]) {
            if value > LINEAR {
                let text = format!(
                    "{what} {value:.3e} {unit} at {} (load step `{}`): small vibration about even rotation ends at about {LINEAR}",
                    told(speed),
                    names[step]
                );
                self.note(&[Note::caution(topic, text).amount(
                    "largest",
                    value,
                    if unit == "rad" { "rad" } else { "1" },
                )]);
            }
        }
    }

    /// Table `envelope`, the envelope of all shafts, and the curves of the one that uses its limit by the maximum.
    fn curves(
        &mut self,
        steps: &mut [Step<'_, '_>],
        (range, diagram, peaks): (&Operating, &[f64], &[f64]),
        names: &[String],
        limits: &[Forced],
        tops: &[(usize, Top)],
    ) {
        let Some(a) = steps.first().map(|s| s.machine.a) else { return };
        let speeds = drawn_speeds(steps, range, diagram, peaks);
        let axis = column("speed", "rpm", speeds.iter().map(|w| rpm(*w)).collect());
        let mut table = Series { axis, columns: Vec::new() };
        let shown = Shown::new(a, names.len() > 1);
        let mut all = Vec::new();
        let mut critical: Option<(f64, usize)> = None;
        for (l, top) in tops {
            let Some(factor) = shown.factor(a, *l) else { continue };
            let name = &a.line.links[*l].name;
            let envelope = shown.add(steps, &speeds, (*l, factor), &mut table);
            if all.len() < MAX_DRAWN {
                all.push((name.clone(), envelope));
            }
            let limit = limit_of(limits, name, shown.stressed);
            let used = limit.map_or(0.0, |limit| factor * top.amplitude / limit);
            if critical.is_none_or(|m| used > m.0) {
                critical = Some((used, *l));
            }
        }
        let Some((_, l)) = critical else { return };
        let limit = limit_of(limits, &a.line.links[l].name, shown.stressed);
        if let Some(limit) = limit {
            table.columns.push(column(shown.limit_column(l), shown.unit, vec![limit; speeds.len()]));
        }
        let limited = limit.is_some();
        let others = limited_curves(steps, &speeds, names, limits, &mut table);
        self.draw_envelope(&table, (&shown, names), (a, l, limited), all, others);
        self.out.tables.insert("envelope".into(), table);
    }

    /// Figures of the envelope, and of the load steps of one shaft, behind the bars of the verdict.
    fn draw_envelope(
        &mut self,
        table: &Series,
        (shown, names): (&Shown, &[String]),
        (a, l, limited): (&Assembled, usize, bool),
        mut all: Vec<(String, String)>,
        others: Vec<Figure>,
    ) {
        let (name, what) = (&a.line.links[l].name, shown.what);
        let limit_line = limited.then(|| (format!("limit of {name}"), shown.limit_column(l)));
        let before = self.out.figures.len();
        all.extend(limit_line.clone());
        let title = if shown.stressed { "Envelope of stress" } else { "Envelope of torque" };
        let hint = format!(
            "largest amplitude (half of peak to peak) of all load steps over the operating range: {}",
            names.join(", ")
        );
        self.lines(title, &hint, "envelope", "speed", all, false);
        if names.len() > 1 {
            let mut lines: Vec<(String, String)> =
                names.iter().enumerate().map(|(k, n)| (n.clone(), shown.step_column(l, k))).collect();
            lines.retain(|(_, column)| table.get(column).is_some());
            lines.extend(limit_line);
            let title = format!("Load steps: {what} in {name}");
            let hint = "amplitude (half of peak to peak) over the operating range, in the shaft that uses its limit most";
            self.lines(&title, hint, "envelope", "speed", lines, false);
        }
        let mut own = self.out.figures.split_off(before);
        own.extend(others);
        let first = ["Limits", "Verdict", "Load steps"];
        let bars = self.out.figures.iter().take_while(|f| first.contains(&f.title.as_str())).count();
        self.out.figures.splice(bars..bars, own);
    }
}

/// Name within `envelope`, unit and words of a limit on heat or irregularity; none for the others, and where the line does not have the subject.
fn limited_key(a: &Assembled, l: &Forced) -> Option<(String, &'static str, &'static str)> {
    let n = l.place(a)?.0 + 1;
    match l.quantity {
        Quantity::Heat => Some((format!("shaft{n}.heat"), "W", "heat")),
        Quantity::SpeedFluctuation => {
            Some((format!("inertia{n}.irregularity"), "", "coefficient of speed fluctuation"))
        }
        _ => None,
    }
}

/// Heat and irregularity over the speed of what has a limit on it, a curve a load step.
fn limited_curves(
    steps: &mut [Step<'_, '_>],
    speeds: &[f64],
    names: &[String],
    limits: &[Forced],
    table: &mut Series,
) -> Vec<Figure> {
    let mut figures = Vec::new();
    for l in limits {
        let Some((key, unit, what)) = limited_key(steps[0].machine.a, l) else { continue };
        let mut lines = Vec::new();
        for (k, s) in steps.iter_mut().enumerate().filter(|(_, s)| l.counts_in(&s.name)) {
            let Some((at, _)) = l.place(s.machine.a) else { continue };
            let name = key.replacen('.', &format!(".step{}.", k + 1), 1);
            let values = speeds.iter().map(|w| s.machine.at(*w).map_or(0.0, |p| l.value(at, &p))).collect();
            if table.get(&name).is_none() {
                table.columns.push(column(name.clone(), unit, values));
            }
            lines.push((if names.len() > 1 { names[k].clone() } else { what.to_owned() }, name));
        }
        figures.push(Figure {
            title: format!("{}: {what}", l.subject),
            hint: "over the operating range, in each load step".into(),
            table: "envelope".into(),
            kind: FigureKind::Lines(Lines {
                x: "speed".into(),
                lines,
                marks: vec![Mark::Limit { y: l.admitted, label: "limit".into() }],
                ..Lines::default()
            }),
        });
    }
    figures
}

/// The grid, and the places of the peaks, where every load step has an answer.
fn drawn_speeds(steps: &mut [Step<'_, '_>], range: &Operating, diagram: &[f64], peaks: &[f64]) -> Vec<f64> {
    let mut speeds = range.grid(diagram);
    speeds.extend(peaks.iter().filter(|w| **w > range.from && **w < range.to));
    speeds.sort_unstable_by(f64::total_cmp);
    speeds.dedup();
    speeds.retain(|w| steps.iter_mut().all(|s| s.machine.at(*w).is_some()));
    speeds
}

/// What the envelope shows: stress where any shaft has one, torque otherwise.
struct Shown {
    stressed: bool,
    /// Whether there are several load steps.
    several: bool,
    unit: &'static str,
    what: &'static str,
}

impl Shown {
    fn new(a: &Assembled, several: bool) -> Self {
        let stressed = a.stress.iter().any(Option::is_some);
        let (unit, what) = if stressed { ("MPa", "stress") } else { ("N m", "torque") };
        Self { stressed, several, unit, what }
    }

    /// What is shown of a link by its torque; none where it is not shown.
    fn factor(&self, a: &Assembled, l: usize) -> Option<f64> {
        if self.stressed { a.stress[l].map(|s| s / 1e6) } else { Some(1.0) }
    }

    fn step_column(&self, l: usize, step: usize) -> String {
        format!("shaft{}.step{}.{}_amplitude", l + 1, step + 1, self.what)
    }

    fn limit_column(&self, l: usize) -> String {
        format!("shaft{}.{}_limit", l + 1, self.what)
    }

    /// Adds the amplitudes of a link of the first load step in each step, and their envelope; the name of its column.
    fn add(
        &self,
        steps: &mut [Step<'_, '_>],
        speeds: &[f64],
        (l, factor): (usize, f64),
        table: &mut Series,
    ) -> String {
        let name = steps[0].machine.a.line.links[l].name.clone();
        let mut envelope = vec![0.0_f64; speeds.len()];
        for (k, s) in steps.iter_mut().enumerate() {
            let Some(at) = s.machine.a.line.links.iter().position(|x| x.name == name) else { continue };
            let amplitude = |w: &f64| s.machine.at(*w).map_or(0.0, |p| factor * p.links[at].amplitude);
            let row: Vec<f64> = speeds.iter().map(amplitude).collect();
            envelope.iter_mut().zip(&row).for_each(|(e, r)| *e = e.max(*r));
            if self.several {
                table.columns.push(column(self.step_column(l, k), self.unit, row));
            }
        }
        let own = format!("shaft{}.{}_amplitude", l + 1, self.what);
        table.columns.push(column(own.clone(), self.unit, envelope));
        own
    }
}

/// The largest torque amplitude of a link over all load steps that have it.
fn top_of(steps: &mut [Step<'_, '_>], name: &str) -> Option<Top> {
    let mut best: Option<Top> = None;
    for (k, s) in steps.iter_mut().enumerate() {
        let Some(l) = s.machine.a.line.links.iter().position(|x| x.name == name) else { continue };
        let speeds = s.speeds.clone();
        let (speed, amplitude) = s.machine.largest(&speeds, &Sought::Link(l, &|p| p.amplitude));
        if amplitude.is_finite() && best.as_ref().is_none_or(|b| amplitude > b.amplitude) {
            let order = s.machine.at(speed).map_or(0.0, |p| p.links[l].order);
            best = Some(Top { amplitude, speed, step: k, order });
        }
    }
    best
}

/// The limits on the amplitude in a shaft, as drawn, each with its name; those that count in some load steps alone name them.
pub(super) fn limits_of(limits: &[Forced], name: &str, stressed: bool) -> Vec<(f64, String)> {
    let (quantity, factor) = if stressed { (Quantity::Stress, 1e-6) } else { (Quantity::Torque, 1.0) };
    let label = |l: &Forced| match l.load_steps.as_slice() {
        [] => "limit".to_owned(),
        some => format!("limit in {}", some.join(", ")),
    };
    let own = limits.iter().filter(|l| l.subject == name && l.quantity == quantity);
    own.map(|l| (factor * l.admitted, label(l))).collect()
}

/// The lowest limit on the amplitude in a shaft.
fn limit_of(limits: &[Forced], name: &str, stressed: bool) -> Option<f64> {
    limits_of(limits, name, stressed).into_iter().map(|l| l.0).reduce(f64::min)
}
