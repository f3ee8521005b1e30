//! The results of a shaft line that a reader looks at first.

use gudgeon_core::kinds::Line;
use gudgeon_core::result::{Headline, RunResult};

/// Members of a family that stand on the first page.
const SHOWN: usize = 4;

/// Those of a line with these results.
pub fn headlines(line: &Line, out: &RunResult) -> Vec<Headline> {
    let shafts = |prefix: &str, what: &str| -> Vec<(String, String)> {
        largest(
            out,
            line.links
                .iter()
                .enumerate()
                .map(|(l, link)| (link.name.clone(), format!("{prefix}shaft{}.{what}", l + 1))),
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
    let inertias = line
        .nodes
        .iter()
        .enumerate()
        .map(|(i, n)| (n.name.clone(), format!("inertia{}.irregularity", i + 1)));
    let heat = shafts("", "heat");
    vec![
        Headline::one("Most used limit, 1 is all of it", "worst_utilisation"),
        Headline::each("Natural frequencies", modes),
        Headline::one("Nearest critical speed", "nearest_critical_speed"),
        Headline {
            curves: curves(&torque, "torque"),
            ..Headline::each(&format!("Vibratory torque {over}"), torque)
        },
        Headline {
            curves: curves(&stress, "stress"),
            ..Headline::each(&format!("Vibratory stress {over}"), stress)
        },
        Headline::each("Heat in the shafts", heat),
        Headline::each("Coefficient of speed fluctuation", largest(out, inertias)),
    ]
}

/// The members with the largest results, the largest first; equal ones in their order.
fn largest(run: &RunResult, all: impl Iterator<Item = (String, String)>) -> Vec<(String, String)> {
    let mut known: Vec<(f64, (String, String))> =
        all.filter_map(|pair| Some((run.results.get(&pair.1)?.value, pair))).collect();
    known.sort_by(|a, b| b.0.total_cmp(&a.0));
    known.into_iter().take(SHOWN).map(|(_, pair)| pair).collect()
}
