//! The verdict as notes, results, bars and a table of load steps by limits.

use std::f64::consts::PI;

use gudgeon_core::EvalError;
use gudgeon_core::result::{Bar, Figure, FigureKind, Note, Series};
use gudgeon_torsion::critical::CriticalSpeed;

use super::{Results, column};
use crate::machine::Machine;
use crate::verdict::{
    Accepted, Excitation, Forced, Judged, Operating, Row, Spectra, Step, UNBOUNDED, forced, judge_separation,
};
use crate::{rpm, told};

/// Bars of load steps by limits drawn at most.
const DRAWN: usize = 36;
/// Modes told of natural frequencies and margins by load step.
const MODES_SHOWN: usize = 8;
/// Part of a natural frequency by which load steps may differ and count as the same.
pub(super) const SAME: f64 = 1e-3;
/// Separation beyond which a mode is not told beside an order.
const FAR: f64 = 0.5;
/// Longest bar.
const LONGEST: f64 = 100.0;

impl Results<'_> {
    /// Holds the load steps against the limits of the case over its operating range, and gives the largest values there. The speeds at which
    /// something is largest.
    ///
    /// # Errors
    /// No convergence of natural frequencies.
    pub fn verdict(
        &mut self,
        steps: &mut [(String, Machine<'_>)],
        diagram: &[f64],
        vibration: bool,
    ) -> Result<Vec<f64>, EvalError> {
        let range = Operating::new(self.case);
        let names: Vec<String> = steps.iter().map(|s| s.0.clone()).collect();
        let limits = match steps.first() {
            Some((_, own)) if vibration => forced(self.case, own.a),
            _ => Vec::new(),
        };
        let mut judged: Vec<Step<'_, '_>> = Vec::new();
        for (name, machine) in steps.iter_mut() {
            judged.push(if vibration {
                Step::new(name, machine, &range, diagram)?
            } else {
                let (name, speeds) = (name.clone(), Vec::new());
                Step { name, machine, speeds, critical: Vec::new(), unbounded: Vec::new() }
            });
        }
        let spectra =
            judged.iter_mut().map(|s| Spectra::new(s.machine, &range)).collect::<Result<Vec<_>, _>>()?;
        let mut accepted = Vec::new();
        let mut rows = self.separations(&mut judged, &spectra, &limits, &mut accepted);
        for l in &limits {
            let steps: Vec<Option<Judged>> = judged.iter_mut().map(|s| s.judge(l, &range)).collect();
            if steps.iter().any(Option::is_some) {
                let allowed = l.told(l.admitted);
                rows.push(Row { label: l.label(), allowed, source: l.source.clone(), steps });
            }
        }
        tell_apart(&mut rows);
        let mut notes = summary(&rows, &range, &names);
        notes.extend(accepted.into_iter().map(|a| accepted_note(a, names.len())));
        if vibration && range.is_wide() {
            notes.extend(critical_speeds(&mut judged, &limits, &names));
        }
        if rows.is_empty() {
            notes.retain(|n| n.topic != "verdict");
        } else {
            self.utilisation(&rows, &names);
        }
        self.campbell_by_step(&mut judged)?;
        self.frequencies_by_step(&spectra, &names);
        self.margins(&spectra, &names);
        self.out.solver.notes.splice(0..0, notes);
        let mut peaks: Vec<f64> = rows.iter().filter_map(|r| r.worst().map(|w| w.1.speed)).collect();
        if vibration && (range.is_wide() || names.len() > 1) {
            self.envelope(&mut judged, (&range, diagram), &names, &limits, &mut peaks);
        }
        for (name, s) in names.iter().zip(&judged) {
            self.answered(s.machine, &slug(name));
        }
        Ok(peaks)
    }

    /// The limits on separation.
    fn separations(
        &self,
        steps: &mut [Step<'_, '_>],
        spectra: &[Spectra],
        limits: &[Forced],
        accepted: &mut Vec<Accepted>,
    ) -> Vec<Row> {
        let mut rows = Vec::new();
        for l in &self.case.limits.separation {
            for e in Excitation::of(l) {
                let mut own = Vec::new();
                for (s, spectra) in steps.iter_mut().zip(spectra) {
                    let mut why = Vec::new();
                    own.push(judge_separation(s, spectra, e, l, limits, &mut why));
                    why.into_iter().for_each(|a| a.gather(accepted));
                }
                if own.iter().any(Option::is_some) {
                    let label = format!("separation from {}", e.words());
                    let allowed = format!("{:.1} %", 100.0 * l.margin.si());
                    rows.push(Row { label, allowed, source: l.source.clone(), steps: own });
                }
            }
        }
        rows
    }

    /// Natural frequencies of each load step, where they differ.
    fn frequencies_by_step(&mut self, spectra: &[Spectra], names: &[String]) {
        let Some(first) = spectra.first() else { return };
        let modes = (0..).take_while(|m| first.span(*m).is_some()).count().min(MODES_SHOWN);
        let differ = |m: usize| {
            let spans = spectra.iter().filter_map(|s| s.span(m));
            let [low, high] = spans.fold([f64::INFINITY, 0.0_f64], |[a, b], s| [a.min(s[0]), b.max(s[1])]);
            high - low > SAME * high
        };
        if !(0..modes).any(differ) {
            return;
        }
        let columns =
            names.iter().flat_map(|n| ["from", "to"].map(|end| (format!("{n}: {end}"), "Hz".to_owned())));
        let hz = |omega: f64| Some(omega / (2.0 * PI));
        let row = |m: usize| {
            let cells = spectra.iter().flat_map(|s| s.span(m).map_or([None; 2], |s| s.map(hz)));
            (format!("mode {}", m + 1), cells.collect())
        };
        self.out.figures.push(Figure {
            title: "Natural frequencies by load step".into(),
            hint: "lowest and highest over the operating range: a coupling stiffens with its mean torque"
                .into(),
            table: String::new(),
            kind: FigureKind::Table {
                rows_are: "mode".into(),
                columns: columns.collect(),
                rows: (0..modes).map(row).collect(),
                texts: Vec::new(),
                limit: None,
            },
        });
    }

    /// Distance of each mode from each excitation that a limit names, for every load step.
    fn margins(&mut self, spectra: &[Spectra], names: &[String]) {
        let mut rows = Vec::new();
        for l in &self.case.limits.separation {
            for e in Excitation::of(l) {
                for m in 0..MODES_SHOWN {
                    let all: Vec<Option<(f64, f64)>> = spectra.iter().map(|s| s.of_mode(e, m)).collect();
                    let Some((_, omega)) =
                        all.iter().flatten().copied().min_by(|a, b| a.0.abs().total_cmp(&b.0.abs()))
                    else {
                        continue;
                    };
                    if all.iter().flatten().all(|d| d.0.abs() > FAR) {
                        continue;
                    }
                    let speed = match e {
                        Excitation::Order(o) => Some(rpm(omega / o)),
                        Excitation::Fixed(_) => None,
                    };
                    let mut cells = vec![Some(omega / (2.0 * PI)), speed, Some(100.0 * l.margin.si())];
                    cells.extend(all.iter().map(|d| d.map(|d| 100.0 * d.0)));
                    rows.push((format!("mode {}, {}", m + 1, e.words()), cells));
                }
            }
        }
        if rows.is_empty() {
            return;
        }
        let mut columns = vec![
            ("frequency".to_owned(), "Hz".to_owned()),
            ("critical speed".into(), "rpm".into()),
            ("wanted".into(), "%".into()),
        ];
        columns.extend(names.iter().map(|n| (n.clone(), "%".into())));
        self.out.figures.push(Figure {
            title: "Separation margins".into(),
            hint: format!(
                "(f - excitation)/excitation at the operating speed where they are nearest, negative where the mode is the lower one, 0 where they meet; pairs nearer than {:.0} % in any load step; frequency and critical speed of the nearest load step",
                100.0 * FAR
            ),
            table: String::new(),
            kind: FigureKind::Table { rows_are: "pair".into(), columns, rows, texts: Vec::new(), limit: None },
        });
    }

    /// Every limit with what is found and allowed, and where.
    fn limit_table(&mut self, rows: &[Row], names: &[String]) {
        let worst: Vec<(&Row, usize, &Judged)> =
            rows.iter().filter_map(|r| r.worst().map(|(k, w)| (r, k, w))).collect();
        let cells = |w: &Judged| vec![Some(w.used), Some(rpm(w.speed)), w.order];
        let text = |name: &str, of: &dyn Fn(&(&Row, usize, &Judged)) -> String| {
            (name.to_owned(), worst.iter().map(of).collect::<Vec<_>>())
        };
        let mut texts =
            vec![text("found", &|w| w.2.found.clone()), text("allowed", &|w| w.0.allowed.clone())];
        if names.len() > 1 {
            texts.push(text("load step", &|w| names[w.1].clone()));
        }
        texts.push(text("source", &|w| w.0.source.clone()));
        let columns = [("share", ""), ("speed", "rpm"), ("order", "")];
        let figure = Figure {
            title: "Limits".into(),
            hint: "each limit where it is used most, over the operating range and all load steps; a separation that the vibration accepts shows the share of the limit that is used most there".into(),
            table: String::new(),
            kind: FigureKind::Table {
                rows_are: "limit".into(),
                columns: columns.map(|(n, u)| (n.to_owned(), u.to_owned())).to_vec(),
                rows: worst.iter().map(|w| (w.0.label.clone(), cells(w.2))).collect(),
                texts,
                limit: None,
            },
        };
        self.out.figures.insert(0, figure);
    }

    /// Shares of the limits as results, bars and table.
    fn utilisation(&mut self, rows: &[Row], names: &[String]) {
        let used = |r: &Row| r.worst().map_or(0.0, |w| w.1.used);
        let broken = rows.iter().filter(|r| used(r) > 1.0).count();
        self.result("limits_broken", broken as f64, "", "number of limits that are not kept");
        let worst = rows.iter().max_by(|a, b| used(a).total_cmp(&used(b)));
        self.result(
            "worst_utilisation",
            worst.map_or(0.0, used),
            "",
            format!(
                "largest share of a limit that is used{}; above 1 it is broken, {UNBOUNDED:.0} stands for no bound",
                worst.map_or_else(String::new, |r| format!(": {}", r.label))
            ),
        );
        let bars = rows.iter().map(|r| bar(r.label.clone(), used(r))).collect();
        let mut figures = vec![Figure {
            title: "Verdict".into(),
            hint: "share of each limit that is used; beyond 1 it is broken".into(),
            table: String::new(),
            kind: FigureKind::Bars { unit: String::new(), bars },
        }];
        if names.len() > 1 {
            let table = Series {
                axis: column("load_step", "", (1..=names.len()).map(|k| k as f64).collect()),
                columns: rows
                    .iter()
                    .map(|r| {
                        let used = r.steps.iter().map(|j| j.as_ref().map_or(0.0, |j| j.used));
                        column(r.label.clone(), "", used.collect())
                    })
                    .collect(),
            };
            self.out.tables.insert("load_steps".into(), table);
            let each = (DRAWN / names.len()).max(3);
            let bars = (0..names.len()).flat_map(|k| {
                let mut own: Vec<(f64, &Row)> =
                    rows.iter().filter_map(|r| r.steps[k].as_ref().map(|j| (j.used, r))).collect();
                own.sort_by(|a, b| b.0.total_cmp(&a.0));
                own.into_iter()
                    .take(each)
                    .map(move |(used, r)| bar(format!("{}: {}", names[k], r.label), used))
            });
            figures.push(Figure {
                title: "Load steps".into(),
                hint: format!("share of the limits that each load step uses most, {each} of each; table `load_steps` has all, a row a load step"),
                table: String::new(),
                kind: FigureKind::Bars { unit: String::new(), bars: bars.collect() },
            });
        }
        self.out.figures.splice(0..0, figures);
        self.limit_table(rows, names);
    }
}

/// Limits of one quantity that a person could not tell apart get what they allow into their label.
fn tell_apart(rows: &mut [Row]) {
    for k in 0..rows.len() {
        let label = rows[k].label.clone();
        let same: Vec<usize> = (k..rows.len()).filter(|j| rows[*j].label == label).collect();
        if same.len() > 1 {
            same.into_iter().for_each(|j| rows[j].label = format!("{label} ({})", rows[j].allowed));
        }
    }
}

/// What is accepted although it is not kept.
fn accepted_note(a: Accepted, steps: usize) -> Note {
    let of = match a.steps.as_slice() {
        [first, others @ ..] if steps > 1 => {
            let more = if others.is_empty() { String::new() } else { format!(" and {} more", others.len()) };
            format!("; load step `{first}`{more}")
        }
        _ => String::new(),
    };
    Note::caution(format!("verdict.accepted.{}", a.key), format!("{}{of}", a.text))
        .amount("used", a.used, "1")
}

fn bar(label: String, used: f64) -> Bar {
    Bar { label, value: used.min(LONGEST), limit: Some(1.0) }
}

/// A name as part of a key: letters, digits and `_`.
pub fn slug(name: &str) -> String {
    let mut out = String::new();
    for c in name.chars() {
        if c.is_alphanumeric() {
            out.extend(c.to_lowercase());
        } else if !out.is_empty() && !out.ends_with('_') {
            out.push('_');
        }
    }
    out.trim_end_matches('_').to_owned()
}

/// How many limits are kept, and each that is not, with its worst place.
fn summary(rows: &[Row], range: &Operating, names: &[String]) -> Vec<Note> {
    let broken: Vec<&Row> = rows.iter().filter(|r| r.worst().is_some_and(|w| w.1.used > 1.0)).collect();
    let over = match names.len() {
        1 => range.words(),
        n => format!("{}, in {n} load steps", range.words()),
    };
    let all = rows.len();
    let first = if broken.is_empty() {
        Note::info("verdict", format!("verdict: all {all} limits are kept {over}"))
    } else {
        let are = if broken.len() == 1 { "is" } else { "are" };
        Note::exceeded("verdict", format!("verdict: {} of {all} limits {are} not kept {over}", broken.len()))
    };
    let each = broken.iter().filter_map(|r| {
        let (k, worst) = r.worst()?;
        let step = if names.len() > 1 { format!(", load step `{}`", names[k]) } else { String::new() };
        let also = r.steps.iter().flatten().filter(|j| j.used > 1.0).count() - 1;
        let also = if also > 0 { format!(" and in {also} more") } else { String::new() };
        let text = format!("beyond the limit: {}: {}{step}{also} ({})", r.label, worst.text, r.source);
        Some(Note::exceeded(format!("verdict.{}", slug(&r.label)), text).amount("used", worst.used, "1"))
    });
    std::iter::once(first).chain(each).collect()
}

/// How many critical speeds stand within the operating range, each counted once, and at which of them a limit is broken by their order.
fn critical_speeds(steps: &mut [Step<'_, '_>], limits: &[Forced], names: &[String]) -> Option<Note> {
    let mut known: Vec<(usize, f64)> = Vec::new();
    // Of each the load step in which it uses most.
    let mut broken: Vec<(CriticalSpeed, f64, String)> = Vec::new();
    for (s, name) in steps.iter_mut().zip(names) {
        for c in s.critical.clone() {
            if !known.contains(&(c.mode, c.order)) {
                known.push((c.mode, c.order));
            }
            let Some((used, which)) = s.used_by(limits, &c).filter(|u| u.0 > 1.0) else { continue };
            let step = if names.len() > 1 { format!(", `{name}`") } else { String::new() };
            let own = (c, used, format!("{which}: {used:.3}{step}"));
            match broken.iter_mut().find(|b| b.0.mode == c.mode && b.0.order == c.order) {
                Some(b) if b.1 >= used => {}
                Some(b) => *b = own,
                None => broken.push(own),
            }
        }
    }
    let count = known.len();
    if count == 0 {
        return None;
    }
    broken.sort_by(|a, b| b.1.total_cmp(&a.1));
    let told = |b: &(CriticalSpeed, f64, String)| {
        format!("mode {} with order {} at {} ({})", b.0.mode, b.0.order, told(b.0.speed), b.2)
    };
    let where_broken = match (broken.len(), limits.is_empty()) {
        (_, true) => "no limit on vibration says whether they matter".into(),
        (0, _) => "none of them breaks a limit".into(),
        (n, _) => {
            let more = if n > 8 { format!(" and {} more", n - 8) } else { String::new() };
            let all: Vec<String> = broken.iter().take(8).map(told).collect();
            format!("a limit is not kept, mostly by that order, at {}{more}", all.join("; "))
        }
    };
    let (plural, stand) = if count == 1 { ("", "stands") } else { ("s", "stand") };
    let text = format!(
        "{count} critical speed{plural} of excited orders {stand} within the operating range: {where_broken}"
    );
    Some(Note::info("verdict.critical_speeds", text).amount("critical_speeds", count as f64, "1"))
}
