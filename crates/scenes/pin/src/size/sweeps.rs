//! Lightest pins over the outer diameter, over a limit, and of the sizes of a stock.

use gudgeon_core::kinds::{PIN_QUANTITIES, PinQuantity, PinSize};
use gudgeon_core::result::{Note, RunResult, Series};
use gudgeon_pin::design::{Design, Range};
use gudgeon_pin::optimum::lightest;
use gudgeon_pin::stepper::{End, search};
use gudgeon_pin::stock::Sizes;

use super::published::steps;
use super::refusals::because;
use crate::case::{Method, Optimise};
use crate::output::{column, lines, result};
use crate::setup::Setup;

/// Points of a Pareto front.
const FRONT: usize = 25;

/// Name of the table of the sweep.
const TABLE: &str = "diameter_sweep";

/// The lightest pin of each outer diameter, and the published search beside it.
pub fn sweep(d: &Design<'_>, s: &Setup, o: &Optimise, out: &mut RunResult) {
    min_outer(d, out);
    if o.sweep_points < 2 || d.outer.is_fixed() {
        return;
    }
    let rows = rows(d, s, o);
    if rows.len() >= 2 {
        table(d, o, &rows, out);
        figures(d, s, o, out);
    }
}

/// The smallest outer diameter with a pin, and what forbids smaller ones.
fn min_outer(d: &Design<'_>, out: &mut RunResult) {
    let Some(min) = d.min_feasible_outer() else { return };
    let what = "smallest outer diameter with a pin that keeps the limits";
    result(out, "min_outer", 1e3 * min, "mm", what);
    if min <= d.outer.low * (1.0 + 1e-9) {
        return;
    }
    let just = d.blocking_limits(min * (1.0 - 1e-6));
    out.solver.notes.push(Note::info(
        "no_pin_below",
        format!("No pin below {:.4} mm of outer diameter: {}.", 1e3 * min, because(&just)),
    ));
    let first = d.blocking_limits(d.outer.low);
    if first != just && !first.is_empty() {
        let what = format!("At {:.4} mm: {}.", 1e3 * d.outer.low, because(&first));
        out.solver.notes.push(Note::info("no_pin_at", what));
    }
}

/// One outer diameter of the sweep, SI.
struct Row {
    outer: f64,
    length: f64,
    inner: f64,
    pin: f64,
    differential: f64,
    /// Pin less relief of the published search; zero where it is not asked for.
    published: f64,
    utilisation: [f64; PIN_QUANTITIES],
}

fn rows(d: &Design<'_>, s: &Setup, o: &Optimise) -> Vec<Row> {
    let n = o.sweep_points as usize;
    let mut rows = Vec::new();
    let mut warm: Option<PinSize> = None;
    for k in 0..n {
        let outer = d.outer.low + (d.outer.high - d.outer.low) * k as f64 / (n - 1) as f64;
        let mut here = *d;
        here.outer = Range::at(outer);
        let Ok(best) =
            lightest(&here, warm.map(|w| PinSize { outer, ..w })).or_else(|_| lightest(&here, None))
        else {
            continue;
        };
        warm = Some(best.size);
        let published = match o.method {
            Method::Exact => Some(0.0),
            Method::AsPublished => published_differential(&here, s, o, outer),
        };
        let Some(published) = published else { continue };
        rows.push(Row {
            outer,
            length: best.size.length,
            inner: best.size.inner,
            pin: best.masses.pin,
            differential: best.masses.differential(),
            published,
            utilisation: best.utilisation,
        });
    }
    rows
}

/// Pin less relief \[kg\] of the published search at an outer diameter; `None` where it finds no pin.
fn published_differential(d: &Design<'_>, s: &Setup, o: &Optimise, outer: f64) -> Option<f64> {
    let found = search(d, PinSize { outer, ..s.given? }, &steps(s, o)).ok()?;
    (found.end == End::Found).then(|| d.masses(&found.size).differential())
}

fn limited(d: &Design<'_>) -> impl Iterator<Item = PinQuantity> {
    PinQuantity::ALL.into_iter().filter(|q| d.limits[*q as usize].is_finite())
}

fn table(d: &Design<'_>, o: &Optimise, rows: &[Row], out: &mut RunResult) {
    let of = |f: fn(&Row) -> f64| rows.iter().map(f).collect::<Vec<_>>();
    let mut columns = vec![
        column("length", "m", of(|r| r.length)),
        column("inner", "m", of(|r| r.inner)),
        column("pin_mass", "kg", of(|r| r.pin)),
        column("mass_differential", "kg", of(|r| r.differential)),
    ];
    if o.method == Method::AsPublished {
        columns.push(column("published_differential", "kg", of(|r| r.published)));
    }
    for q in limited(d) {
        let name = format!("utilisation_{}", q.name());
        columns.push(column(&name, "", rows.iter().map(|r| r.utilisation[q as usize]).collect()));
    }
    out.tables.insert(TABLE.into(), Series { axis: column("outer", "m", of(|r| r.outer)), columns });
}

fn figures(d: &Design<'_>, s: &Setup, o: &Optimise, out: &mut RunResult) {
    let mut masses = vec![("pin", "pin_mass")];
    if s.relief.is_some() {
        masses.push(("pin less relief", "mass_differential"));
    }
    if o.method == Method::AsPublished {
        masses.push(("pin less relief, published search", "published_differential"));
    }
    let hint = "mass against the outer diameter; length and bore are the best for each";
    lines(out, TABLE, "Lightest pin of each outer diameter", hint, &masses);
    if s.relief.is_some() {
        // Without the pin itself the curve fills the page: the steps of the published search show.
        let title = "Least mass of the pin less relief at each outer diameter";
        lines(out, TABLE, title, "", &masses[1..]);
    }
    lines(out, TABLE, "Dimensions of the lightest pin", "", &[("length", "length"), ("bore", "inner")]);
    let names: Vec<(&str, String)> =
        limited(d).map(|q| (q.words(), format!("utilisation_{}", q.name()))).collect();
    let names: Vec<(&str, &str)> = names.iter().map(|(label, column)| (*label, column.as_str())).collect();
    let hint = "utilisation; a limit at 1 holds the pin";
    lines(out, TABLE, "Limits of the lightest pin", hint, &names);
}

/// Mass of the lightest pin over one limit.
pub fn front(d: &Design<'_>, q: PinQuantity, out: &mut RunResult) {
    let k = q as usize;
    let mut rows: Vec<[f64; 6]> = Vec::new();
    for i in 0..FRONT {
        let factor = 0.7 + 0.6 * i as f64 / (FRONT - 1) as f64;
        let mut here = *d;
        here.limits[k] *= factor;
        if let Ok(o) = lightest(&here, None) {
            let m = o.masses;
            rows.push([here.limits[k], m.pin, m.differential(), o.size.length, o.size.outer, o.size.inner]);
        }
    }
    if rows.len() < 2 {
        return;
    }
    let of = |k: usize| rows.iter().map(|r| r[k]).collect::<Vec<_>>();
    let table = format!("pareto_{}", q.name());
    let columns = vec![
        column("pin_mass", "kg", of(1)),
        column("mass_differential", "kg", of(2)),
        column("length", "m", of(3)),
        column("outer", "m", of(4)),
        column("inner", "m", of(5)),
    ];
    let unit = if q.is_length() { "m" } else { "Pa" };
    out.tables.insert(table.clone(), Series { axis: column(q.name(), unit, of(0)), columns });
    let title = format!("Mass against {}", q.words());
    let (hint, drawn) = if d.relief.is_some() {
        let hint = "what is made least is the pin less the flats cut from the piston, below zero where these weigh more; none lies below its line";
        (hint, &[("pin", "pin_mass"), ("pin less relief", "mass_differential")][..])
    } else {
        ("lightest pin for each value of the limit; no pin lies below the line", &[("pin", "pin_mass")][..])
    };
    lines(out, &table, &title, hint, drawn);
}

/// The lightest pin of the sizes that can be had.
pub fn from_stock(d: &Design<'_>, sizes: &Sizes, best: &PinSize, out: &mut RunResult) {
    let Some(c) = sizes.lightest(d) else {
        out.solver
            .notes
            .push(Note::caution("stock", "No combination of the sizes that can be had keeps the limits."));
        return;
    };
    out.solver.counters.insert("stock_combinations".into(), u64::from(c.tried));
    result(out, "stock_length", 1e3 * c.size.length, "mm", "length of the lightest pin of the stock");
    result(out, "stock_outer", 1e3 * c.size.outer, "mm", "its outer diameter");
    result(out, "stock_inner", 1e3 * c.size.inner, "mm", "its inner diameter");
    result(
        out,
        "stock_mass_differential",
        1e3 * c.differential,
        "g",
        "mass of that pin less that of the flats cut from the piston",
    );
    let excess = c.differential - d.masses(best).differential();
    result(out, "stock_excess", 1e3 * excess, "g", "mass, less relief, of that pin above the optimum");
}
