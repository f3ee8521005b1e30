//! What a reader concludes from a table of shares, in sentences made of its numbers.

use gudgeon_core::result::{ShareRow, ShareTable};
use indexmap::IndexMap;

/// An effect that explains this much decides a result.
const DECIDES: f64 = 0.5;
/// A choice that takes part in no more than this does not matter.
const MATTERS: f64 = 0.05;

/// Sentences about the results that a reader looks at first.
pub(super) fn findings(table: &ShareTable) -> Vec<String> {
    let (rows, torn): (Vec<&ShareRow>, Vec<&ShareRow>) =
        table.headlines().partition(|r| r.shares.iter().all(Option::is_some));
    let (still, moved): (Vec<&ShareRow>, Vec<&ShareRow>) =
        rows.into_iter().partition(|r| r.shares.iter().flatten().all(|s| s.within_numerics));
    let mut told = decided(table, &moved);
    told.extend(moved.iter().filter(|r| top(r).1 < DECIDES).map(|r| shared(table, r)));
    told.extend(idle(table, &moved));
    told.extend(cases(table, &moved));
    if !still.is_empty() {
        told.push(format!("No choice changes {} beyond the numerics.", listed(&names(&still))));
    }
    if !torn.is_empty() {
        let what = listed(&names(&torn));
        told.push(format!("Too many combinations have no result to tell all choices apart in {what}."));
    }
    told
}

/// The effect with the largest share.
fn top(row: &ShareRow) -> (usize, f64) {
    let shares = row.shares.iter().map(|s| s.map_or(0.0, |s| s.share)).enumerate();
    shares.fold((0, f64::NEG_INFINITY), |best, s| if s.1 > best.1 { s } else { best })
}

/// A sentence for each effect that decides some results.
fn decided(table: &ShareTable, rows: &[&ShareRow]) -> Vec<String> {
    let mut by_effect: IndexMap<usize, Vec<String>> = IndexMap::new();
    for row in rows {
        let (effect, share) = top(row);
        if share >= DECIDES {
            let told = format!("{} of {} (spread {})", percent(share), code(&row.result), spread(row));
            by_effect.entry(effect).or_default().push(told);
        }
    }
    let sentence = |(effect, told): (usize, Vec<String>)| {
        let told = listed(&told).replacen(" of ", " of the variance of ", 1);
        format!("{} explains {told}.", code(&table.effect(effect)))
    };
    by_effect.into_iter().map(sentence).collect()
}

/// A result that no effect decides.
fn shared(table: &ShareTable, row: &ShareRow) -> String {
    let mut largest: Vec<(usize, f64)> =
        row.shares.iter().map(|s| s.map_or(0.0, |s| s.share)).enumerate().collect();
    largest.sort_by(|a, b| b.1.total_cmp(&a.1));
    let told: Vec<String> = largest
        .iter()
        .take(3)
        .filter(|(_, s)| *s >= MATTERS)
        .map(|(e, s)| format!("{} {}", code(&table.effect(*e)), percent(*s)))
        .collect();
    format!("Several choices share {} (spread {}): {}.", code(&row.result), spread(row), listed(&told))
}

/// Choices that take part in next to nothing.
fn idle(table: &ShareTable, rows: &[&ShareRow]) -> Option<String> {
    let part = |row: &ShareRow, f: usize| -> f64 {
        let own = table.effects.iter().zip(&row.shares).filter(|(e, _)| e.contains(&f));
        own.filter_map(|(_, s)| s.map(|s| s.share)).sum()
    };
    let most = |f: usize| rows.iter().map(|r| part(r, f)).fold(0.0, f64::max);
    let swaps = (0..table.factors.len()).filter(|f| table.effects.iter().any(|e| e == &[*f]));
    let idle: Vec<(usize, f64)> = swaps.map(|f| (f, most(f))).filter(|(_, m)| *m < MATTERS).collect();
    let largest = idle.iter().map(|(_, m)| *m).fold(0.0, f64::max);
    let names: Vec<String> = idle.iter().map(|(f, _)| code(&table.factors[*f])).collect();
    let verb = if names.len() == 1 { "takes" } else { "take" };
    (!names.is_empty() && !rows.is_empty()).then(|| {
        format!(
            "{} {verb} part in {} of the variance of any of these results.",
            listed(&names),
            at_most(largest)
        )
    })
}

/// Whether what holds for one case holds for the others.
fn cases(table: &ShareTable, rows: &[&ShareRow]) -> Option<String> {
    let part = |row: &ShareRow| -> f64 {
        let own = row.shares.iter().enumerate().filter(|(e, _)| table.with_case(*e));
        own.filter_map(|(_, s)| s.map(|s| s.share)).sum()
    };
    let first = rows.first().filter(|_| table.case.is_none())?;
    let worst = rows.iter().fold(first, |w, r| if part(r) > part(w) { r } else { w });
    let share = part(worst);
    if share < MATTERS {
        let share = at_most(share);
        return Some(format!(
            "The cases answer alike: interactions with the case explain {share} of any of these results."
        ));
    }
    let agree: Vec<&ShareRow> = rows.iter().copied().filter(|r| part(r) < MATTERS).collect();
    let but = match agree.as_slice() {
        [] => String::new(),
        some => format!("; in {} they answer alike", listed(&names(some))),
    };
    let (share, result) = (percent(share), code(&worst.result));
    Some(format!(
        "The cases answer differently: interactions with the case explain up to {share}, of {result}{but}."
    ))
}

fn names(rows: &[&ShareRow]) -> Vec<String> {
    rows.iter().map(|r| code(&r.result)).collect()
}

fn code(name: &str) -> String {
    format!("`{name}`")
}

/// `a`, `a and b`, `a, b and c`.
fn listed(items: &[String]) -> String {
    match items {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

/// A share in whole per cent; what is not nothing is not called so.
fn percent(share: f64) -> String {
    match 100.0 * share {
        p if p > 0.0 && p < 0.5 => "less than 1 %".into(),
        p => format!("{p:.0} %"),
    }
}

/// A bound on a share in whole per cent.
fn at_most(share: f64) -> String {
    if share < 0.01 { "less than 1 %".into() } else { format!("at most {:.0} %", (100.0 * share).ceil()) }
}

/// A standard deviation with two digits.
fn spread(row: &ShareRow) -> String {
    let digits = match row.spread {
        s if s < 0.1 => 3,
        s if s < 1.0 => 2,
        s if s < 10.0 => 1,
        _ => 0,
    };
    format!("{:.digits$} {}", row.spread, row.spread_unit)
}
