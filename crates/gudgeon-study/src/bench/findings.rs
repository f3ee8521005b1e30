//! What the points of a race show, in sentences.

use gudgeon_core::result::{BenchPoint, BenchTable, DEFAULT_ERROR, OVER_ASKED};

/// Errors at which methods are compared.
const AT: [f64; 3] = [1e-2, 1e-3, 1e-4];

/// Sentences: the case as it stands, tolerances that are not kept, methods at equal error.
pub fn findings(table: &BenchTable) -> Vec<String> {
    let mut out: Vec<String> = as_it_stands(table).into_iter().collect();
    out.extend(table.points.iter().filter_map(not_kept));
    out.extend(AT.iter().filter_map(|e| at_equal_error(table, *e)));
    out
}

/// The errors of the case as it stands.
fn as_it_stands(table: &BenchTable) -> Option<String> {
    let p = table.default_point()?;
    let setting = format!("the case as it stands ({}, {})", p.method, p.setting);
    let Some((name, error)) = p.worst() else { return Some(format!("{setting} does not run")) };
    let verb = if error <= DEFAULT_ERROR { "reaches" } else { "does not reach" };
    let own = format!(
        "{setting} {verb} an error of {DEFAULT_ERROR:.0e}: {error:.1e} in {name}, {}",
        time(table, p)
    );
    Some(match table.default_over_asked() {
        Some(ratio) => {
            format!("{own}; its tolerance leaves {} times the error that it asks for", figure(ratio))
        }
        None => own,
    })
}

/// A tolerance that leaves far more than it asks for.
fn not_kept(p: &BenchPoint) -> Option<String> {
    let ratio = p.over_asked().filter(|r| *r > OVER_ASKED)?;
    Some(format!("{}, {}: the achieved error is {} times what was asked", p.method, p.setting, figure(ratio)))
}

/// Two digits.
fn figure(v: f64) -> String {
    if (0.1..1000.0).contains(&v) { format!("{v:.2}") } else { format!("{v:.1e}") }
}

/// Whether anything of the table is cyclic.
fn cyclic(table: &BenchTable) -> bool {
    table.points.iter().any(|p| p.cycles > 1.0)
}

fn time(table: &BenchTable, p: &BenchPoint) -> String {
    let each = if cyclic(table) { " a cycle" } else { "" };
    format!("{:.3} ms{each}", 1e3 * p.seconds_per_cycle)
}

/// The fastest setting of a method within an error.
fn best<'t>(table: &'t BenchTable, method: &str, error: f64) -> Option<&'t BenchPoint> {
    let own = table.points.iter().filter(|p| p.method == method);
    own.filter(|p| p.worst().is_some_and(|(_, e)| e <= error))
        .min_by(|a, b| a.seconds_per_cycle.total_cmp(&b.seconds_per_cycle))
}

/// Methods at equal error, the fastest first.
fn at_equal_error(table: &BenchTable, error: f64) -> Option<String> {
    let mut methods: Vec<&str> = table.points.iter().map(|p| p.method.as_str()).collect();
    methods.dedup();
    let (mut reach, mut fail) = (Vec::new(), Vec::new());
    for method in methods {
        match best(table, method, error) {
            Some(p) => reach.push(p),
            None => fail.push(method),
        }
    }
    reach.sort_by(|a, b| a.seconds_per_cycle.total_cmp(&b.seconds_per_cycle));
    let first = reach.first()?.seconds_per_cycle;
    let told = reach.iter().enumerate().map(|(k, p)| {
        let own = format!("{} ({}) {}", p.method, p.setting, time(table, p));
        if k == 0 { own } else { format!("{own}, {:.1} times the first", p.seconds_per_cycle / first) }
    });
    let fail = fail.into_iter().map(|method| format!("{method} does not reach it within this sweep"));
    let all: Vec<String> = told.chain(fail).collect();
    let names: Vec<&str> = table.reference_values.keys().map(String::as_str).collect();
    Some(format!("at an error of {error:.0e} in {}: {}", names.join(", "), all.join("; ")))
}
