//! The results of a shaft line that a reader looks at first.

use gudgeon_core::kinds::LineNode;
use gudgeon_core::result::{Headline, RunResult};

use crate::assemble::Assembled;
use crate::case::ShaftLineCase;
use crate::verdict::{Quantity, forced};

/// Members of a family that stand on the first page.
const SHOWN: usize = 4;

/// Those of a line with these results. Members of a family that have a limit come first, that which uses most of it before the others.
pub fn headlines(case: &ShaftLineCase, a: &Assembled, out: &RunResult) -> Vec<Headline> {
    let line = &a.line;
    let limits = forced(case, a);
    let limit = |quantity: Quantity, name: &str| {
        let own = limits.iter().filter(|l| l.quantity == quantity && l.subject == name);
        own.map(|l| l.admitted).reduce(f64::min)
    };
    let shafts = |prefix: &str, what: &str| -> Vec<(String, String)> {
        let quantity = match what {
            "torque_amplitude" => Quantity::Torque,
            "stress_amplitude" => Quantity::Stress,
            _ => Quantity::Heat,
        };
        leading(
            out,
            line.links.iter().enumerate().map(|(l, link)| {
                let name = format!("{prefix}shaft{}.{what}", l + 1);
                (limit(quantity, &link.name), (link.name.clone(), name))
            }),
        )
    };
    let curves = |pairs: &[(String, String)], column: &str| -> Vec<String> {
        pairs
            .iter()
            .filter_map(|(_, name)| {
                Some(format!("{}.{column}", name.split('.').find(|p| p.starts_with("shaft"))?))
            })
            .collect()
    };
    let modes = (1..=SHOWN).map(|n| (format!("mode {n}"), format!("mode.{n}.frequency")));
    // The operating range counts where the case has one.
    let wide = |what: &str| {
        let envelope = shafts("envelope.", what);
        if envelope.is_empty() {
            (shafts("", what), "at the mean speed")
        } else {
            (envelope, "over the operating range")
        }
    };
    let (torque, over) = wide("torque_amplitude");
    let (stress, _) = wide("stress_amplitude");
    let inertias = |prefix: &str| {
        let of = |(i, n): (usize, &LineNode)| {
            let name = format!("{prefix}inertia{}.irregularity", i + 1);
            (limit(Quantity::SpeedFluctuation, &n.name), (n.name.clone(), name))
        };
        leading(out, line.nodes.iter().enumerate().map(of))
    };
    let fluctuation = [inertias("envelope."), inertias("")].into_iter().find(|i| !i.is_empty());
    let (heat, heat_over) = wide("heat");
    let critical = match out.results.get("strongest_critical_speed") {
        Some(_) => {
            Headline::one("Strongest critical speed in the operating range", "strongest_critical_speed")
        }
        None => Headline::one("Nearest critical speed", "nearest_critical_speed"),
    };
    vec![
        Headline::one("Most used limit, 1 is all of it", "worst_utilisation"),
        Headline::each("Natural frequencies", modes),
        critical,
        Headline {
            curves: curves(&torque, "torque"),
            ..Headline::each(&format!("Vibratory torque {over}"), torque)
        },
        Headline {
            curves: curves(&stress, "stress"),
            ..Headline::each(&format!("Vibratory stress {over}"), stress)
        },
        Headline::each(&format!("Heat in the shafts {heat_over}"), heat),
        Headline::each("Coefficient of speed fluctuation", fluctuation.unwrap_or_default()),
    ]
}

/// The members with limits by the share that they use, then those with the largest results; equal ones in their order.
fn leading(
    run: &RunResult,
    all: impl Iterator<Item = (Option<f64>, (String, String))>,
) -> Vec<(String, String)> {
    type Known = (Option<f64>, f64, (String, String));
    let known = |(limit, pair): (Option<f64>, (String, String))| -> Option<Known> {
        let v = run.results.get(&pair.1)?;
        let value = if v.unit == "MPa" { 1e6 * v.value } else { v.value };
        Some((limit.map(|l| value / l), value, pair))
    };
    let mut known: Vec<Known> = all.filter_map(known).collect();
    known.sort_by(|a, b| {
        let share = |k: &Known| k.0.unwrap_or(-1.0);
        share(b).total_cmp(&share(a)).then(b.1.total_cmp(&a.1))
    });
    known.into_iter().take(SHOWN).map(|(.., pair)| pair).collect()
}
