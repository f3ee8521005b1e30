//! The verdict as notes, results, bars and a table of load steps by limits.

use gudgeon_core::EvalError;
use gudgeon_core::result::{Bar, Figure, FigureKind, Note, Series};

use super::{Results, column};
use crate::machine::Machine;
use crate::told;
use crate::verdict::{
    Accepted, Excitation, Forced, Operating, Row, Spectra, Step, UNBOUNDED, forced, judge_separation,
};

/// Bars of load steps by limits drawn at most.
const DRAWN: usize = 36;
/// Longest bar.
const LONGEST: f64 = 100.0;

impl Results<'_> {
    /// Holds the load steps against the limits of the case over its operating range, and gives the largest values there.
    ///
    /// # Errors
    /// No convergence of natural frequencies.
    pub fn verdict(
        &mut self,
        steps: &mut [(String, Machine<'_>)],
        diagram: &[f64],
        vibration: bool,
    ) -> Result<(), EvalError> {
        let range = Operating::new(self.case);
        let names: Vec<String> = steps.iter().map(|s| s.0.clone()).collect();
        let limits = match steps.first() {
            Some((_, own)) if vibration => forced(self.case, own.a),
            _ => Vec::new(),
        };
        let mut judged: Vec<Step<'_, '_>> = Vec::new();
        for (_, machine) in steps.iter_mut() {
            judged.push(if vibration {
                Step::new(machine, &range, diagram)?
            } else {
                Step { machine, speeds: Vec::new(), critical: Vec::new(), unbounded: Vec::new() }
            });
        }
        let mut accepted = Vec::new();
        let mut rows = self.separations(&mut judged, &range, &limits, &names, &mut accepted)?;
        for l in &limits {
            let steps = judged.iter_mut().map(|s| s.judge(l, &range)).collect();
            rows.push(Row { label: l.label(), source: l.source.clone(), steps });
        }
        let mut notes = summary(&rows, &range, &names);
        notes.extend(
            accepted.into_iter().map(|a| {
                Note::info(format!("verdict.accepted.{}", a.key), a.text).amount("used", a.used, "1")
            }),
        );
        if vibration && range.is_wide() {
            notes.extend(critical_speeds(&mut judged, &limits, &names));
        }
        if rows.is_empty() {
            notes.retain(|n| n.topic != "verdict");
        } else {
            self.utilisation(&rows, &names);
        }
        self.out.solver.notes.splice(0..0, notes);
        if vibration && (range.is_wide() || names.len() > 1) {
            self.envelope(&mut judged, (&range, diagram), &names, &limits);
        }
        for (name, s) in names.iter().zip(&judged) {
            self.answered(s.machine, &slug(name));
        }
        Ok(())
    }

    /// The limits on separation.
    fn separations(
        &self,
        steps: &mut [Step<'_, '_>],
        range: &Operating,
        limits: &[Forced],
        names: &[String],
        accepted: &mut Vec<Accepted>,
    ) -> Result<Vec<Row>, EvalError> {
        let mut rows = Vec::new();
        if self.case.limits.separation.is_empty() {
            return Ok(rows);
        }
        let spectra =
            steps.iter_mut().map(|s| Spectra::new(s.machine, range)).collect::<Result<Vec<_>, _>>()?;
        for l in &self.case.limits.separation {
            let orders = l.orders.iter().map(|o| Excitation::Order(*o));
            for e in orders.chain(l.frequencies.iter().map(|f| Excitation::Fixed(f.si()))) {
                let mut own = Vec::new();
                for ((s, spectra), name) in steps.iter_mut().zip(&spectra).zip(names) {
                    let mut why = Vec::new();
                    own.push(judge_separation(s, spectra, e, l.margin.si(), limits, &mut why));
                    if names.len() > 1 {
                        for a in &mut why {
                            a.key = format!("{}.{}", a.key, slug(name));
                            a.text = format!("{}; load step `{name}`", a.text);
                        }
                    }
                    accepted.extend(why);
                }
                if own.iter().any(Option::is_some) {
                    let label = format!("separation from {}", e.words());
                    rows.push(Row { label, source: l.source.clone(), steps: own });
                }
            }
        }
        Ok(rows)
    }

    /// Shares of the limits as results, bars and table.
    fn utilisation(&mut self, rows: &[Row], names: &[String]) {
        let used = |r: &Row| r.worst().map_or(0.0, |w| w.1.used);
        let broken = rows.iter().filter(|r| used(r) > 1.0).count();
        self.result("limits_broken", broken as f64, "", "number of limits that are not kept");
        let worst = rows.iter().map(used).fold(0.0, f64::max);
        self.result(
            "worst_utilisation",
            worst,
            "",
            format!("largest share of a limit that is used; above 1 it is broken, {UNBOUNDED:.0} stands for no bound"),
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
                own.into_iter().take(each).map(move |(used, r)| bar(format!("{}: {}", k + 1, r.label), used))
            });
            figures.push(Figure {
                title: "Load steps".into(),
                hint: format!("share of the limits that each load step uses most, {each} of each; table `load_steps` has all, a row a load step: {}", numbered(names)),
                table: String::new(),
                kind: FigureKind::Bars { unit: String::new(), bars: bars.collect() },
            });
        }
        self.out.figures.splice(0..0, figures);
    }
}

fn bar(label: String, used: f64) -> Bar {
    Bar { label, value: used.min(LONGEST), limit: Some(1.0) }
}

/// `1 full load, 2 head ends open`.
pub fn numbered(names: &[String]) -> String {
    let all: Vec<String> = names.iter().enumerate().map(|(k, n)| format!("{} {n}", k + 1)).collect();
    all.join(", ")
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
        Note::exceeded("verdict", format!("verdict: {} of {all} limits are not kept {over}", broken.len()))
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

/// How many critical speeds stand within the operating range, and at which of them a limit is broken.
fn critical_speeds(steps: &mut [Step<'_, '_>], limits: &[Forced], names: &[String]) -> Option<Note> {
    let count: usize = steps.iter().map(|s| s.critical.len()).sum();
    if count == 0 {
        return None;
    }
    let mut broken = Vec::new();
    for (s, name) in steps.iter_mut().zip(names) {
        for c in s.critical.clone() {
            let Some((used, which)) = s.most_used(limits, c.speed, c.speed) else { continue };
            if used > 1.0 {
                let step = if names.len() > 1 { format!(", `{name}`") } else { String::new() };
                broken.push(format!(
                    "mode {} with order {} at {} ({which}: {used:.3}{step})",
                    c.mode,
                    c.order,
                    told(c.speed)
                ));
            }
        }
    }
    let where_broken = match (broken.len(), limits.is_empty()) {
        (_, true) => "no limit on vibration says whether they matter".into(),
        (0, _) => "the forced vibration keeps every limit at each".into(),
        (n, _) => {
            let more = if n > 8 { format!(" and {} more", n - 8) } else { String::new() };
            format!("a limit is not kept at {}{more}", broken[..n.min(8)].join("; "))
        }
    };
    let text =
        format!("{count} critical speeds of excited orders stand within the operating range: {where_broken}");
    Some(Note::info("verdict.critical_speeds", text).amount("critical_speeds", count as f64, "1"))
}
