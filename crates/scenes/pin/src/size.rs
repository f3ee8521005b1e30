//! The pin: evaluation, published search, exact optimum with its proof, sweeps.

use gudgeon_core::BuildError;
use gudgeon_core::kinds::{PinQuantity, PinSize};
use gudgeon_core::result::{Note, RunResult, Series};
use gudgeon_pin::certificate::certify;
use gudgeon_pin::design::{Design, Forbids, Range};
use gudgeon_pin::optimum::{Bound, NoOptimum, Optimum, lightest};
use gudgeon_pin::piston::mass_estimate;
use gudgeon_pin::stepper::{End, Phase, Search, Steps, search};

use super::case::{Arithmetic, Method, Optimise, PinCase};
use super::setup::{Setup, sizes};
use super::{column, draw, lines, model, result};
use gudgeon_scene::{Progress, RunError};

/// Boxes after which the search for a lighter pin gives up.
const MOST_BOXES: u32 = 200_000;

/// Points of a Pareto front.
const FRONT: usize = 25;

/// Runs what the case asks of its pin.
pub fn run(
    case: &PinCase,
    s: &Setup,
    out: &mut RunResult,
    progress: &mut dyn FnMut(Progress),
) -> Result<(), RunError> {
    let d = s.design();
    let size = match &case.optimise {
        None => given(s)?,
        Some(o) if o.method == Method::AsPublished => published(&d, s, o, out)?,
        Some(o) => exact(&d, s, o, out)?,
    };
    if case.optimise.is_none() {
        out.solver.method = "evaluation".into();
    }
    // What was found comes before how.
    let how = std::mem::take(&mut out.results);
    evaluate(case, s, &d, &size, out)?;
    loads(case, s, out);
    out.results.extend(how);
    draw::section(case, s, &size, out);
    draw::utilisation(&d, &size, out).map_err(model)?;
    if let Some(o) = &case.optimise {
        progress(Progress { phase: "sweeping the outer diameter".into(), fraction: 0.5 });
        sweep(&d, s, o, out);
        progress(Progress { phase: "drawing the design map".into(), fraction: 0.8 });
        draw::map(&d, &size, out);
        for q in &o.pareto {
            front(&d, *q, out);
        }
        if let Some(stock) = &o.stock {
            from_stock(&d, &sizes(stock), &size, out);
        }
    }
    cycle(case, s, &d, &size, out)
}

fn given(s: &Setup) -> Result<PinSize, RunError> {
    s.given.ok_or_else(|| RunError::Refused("the pin has no dimensions".into()))
}

/// A force of the source's units is of no use to anyone: newtons, millimetres, megapascals, grams.
fn loads(case: &PinCase, s: &Setup, out: &mut RunResult) {
    let l = &s.load;
    let f = l.design.forces;
    result(out, "peak_pressure", 1e-6 * l.design.pressure, "MPa", "cylinder pressure of the design load");
    result(out, "gas_force", f.gas, "N", "gas force of the design load");
    result(out, "inertia_force", f.inertia, "N", "inertia force of the design load");
    result(out, "pin_force", f.total(), "N", "force on the pin");
    if let Some(ratio) = l.crank_ratio {
        result(out, "crank_ratio", ratio, "", "crank radius over rod length");
    }
    if !l.cycle.is_empty() {
        let angle = l.design.theta.to_degrees();
        result(out, "design_angle", angle, "deg", "crank angle of the greatest force on the pin");
    }
    let mass = mass_estimate(case.piston.apparent_density(), s.bore);
    result(out, "piston_mass_estimate", 1e3 * mass, "g", "apparent density times the cube of the diameter");
}

/// Unit and factor in which results give a quantity.
fn unit(q: PinQuantity) -> (&'static str, f64) {
    if q.is_length() { ("mm", 1e3) } else { ("MPa", 1e-6) }
}

/// What is made least, with flats on the piston.
const LESS_RELIEF: &str = "mass of the pin less that of the flats cut from the piston: what is made least, below zero where the flats weigh more";

fn evaluate(
    case: &PinCase,
    s: &Setup,
    d: &Design<'_>,
    size: &PinSize,
    out: &mut RunResult,
) -> Result<(), RunError> {
    let q = d.strength.quantities(size, &d.load).map_err(model)?;
    let u = d.utilisation(size).map_err(model)?;
    result(out, "length", 1e3 * size.length, "mm", "length of the pin");
    result(out, "outer", 1e3 * size.outer, "mm", "outer diameter");
    result(out, "inner", 1e3 * size.inner, "mm", "inner diameter");
    let m = d.masses(size);
    result(out, "pin_mass", 1e3 * m.pin, "g", "mass of the pin");
    if s.relief.is_some() {
        result(out, "relieved_mass", 1e3 * m.relieved, "g", "mass of the flats cut from the piston");
        result(out, "mass_differential", 1e3 * m.differential(), "g", LESS_RELIEF);
    }
    let j = s.pi * (size.outer.powi(4) - size.inner.powi(4)) / 64.0;
    result(out, "second_moment", 1e12 * j, "mm4", "second moment of area");
    result(out, "section_modulus", 1e9 * 2.0 * j / size.outer, "mm3", "section modulus");
    let (offset, slope) = case.pin.as_ref().map_or((0.0, 0.0), |p| p.boss_bore.centres(s.boss_gap));
    let centres = offset + slope * size.length;
    result(out, "pressure_centres", 1e3 * centres, "mm", "distance of the pressure centres of the bosses");
    for k in PinQuantity::ALL {
        let (unit, factor) = unit(k);
        result(out, k.name(), factor * q[k as usize], unit, k.words());
    }
    let mut greatest: Option<(f64, PinQuantity)> = None;
    for k in PinQuantity::ALL.into_iter().filter(|k| d.limits[*k as usize].is_finite()) {
        let v = u[k as usize];
        result(out, format!("utilisation_{}", k.name()), v, "", format!("{} over its limit", k.words()));
        if greatest.is_none_or(|(g, _)| v > g) {
            greatest = Some((v, k));
        }
    }
    if let Some((v, k)) = greatest {
        result(out, "utilisation", v, "", "greatest utilisation of a limit");
        if v > 1.0 + 1e-9 {
            let over: Vec<&str> = PinQuantity::ALL
                .into_iter()
                .filter(|q| d.limits[*q as usize].is_finite() && u[*q as usize] > 1.0 + 1e-9)
                .map(PinQuantity::words)
                .collect();
            out.solver.notes.push(Note::caution(
                "pin_beyond_limits",
                format!(
                    "The pin exceeds {}: {}; the most, {}, by {:.3} %.",
                    if over.len() == 1 { "a limit" } else { "limits" },
                    over.join(", "),
                    k.words(),
                    100.0 * (v - 1.0)
                ),
            ));
        }
    }
    Ok(())
}

/// Limits that forbid a diameter, as a sentence.
fn because(forbids: &[Forbids]) -> String {
    let one = |f: &Forbids| match f.needs {
        None => format!("{} exceeds its limit at any length", f.limit.words()),
        Some((true, l)) => format!("{} needs a length of {:.3} mm or more", f.limit.words(), 1e3 * l),
        Some((false, l)) => {
            format!("{} allows {:.3} mm at most even of the thickest wall", f.limit.words(), 1e3 * l)
        }
    };
    forbids.iter().map(one).collect::<Vec<_>>().join(", ")
}

/// Why no search can find a pin, known before one runs: every limit is easier to keep with a larger outer diameter, so the largest one
/// of the range decides; the published search keeps the outer diameter of its start.
pub fn impossible(case: &PinCase, s: &Setup) -> Option<BuildError> {
    let o = case.optimise.as_ref()?;
    let d = s.design();
    match (o.method, s.given) {
        (Method::Exact, _) => {
            let high = d.outer.high;
            let forbids = d.forbids(high);
            if forbids.is_empty() && d.least_inner(high) <= d.greatest_inner(high) {
                return None;
            }
            let RunError::Refused(what) = no_optimum(&d, NoOptimum::Infeasible(forbids)) else { return None };
            let help = "a wider range of the outer diameter, a smaller load or a larger limit";
            Some(BuildError::at("optimise.outer", what).help(help))
        }
        // It knows no ranges of the other dimensions.
        (Method::AsPublished, Some(start)) if o.length.is_none() && o.inner.is_none() => {
            let forbids = d.forbids(start.outer);
            let what = format!(
                "no pin of {:.4} mm outer diameter keeps the limits: {}",
                1e3 * start.outer,
                because(&forbids)
            );
            (!forbids.is_empty())
                .then(|| BuildError::at("pin.outer", what).help("a larger outer diameter is needed"))
        }
        _ => None,
    }
}

fn no_optimum(d: &Design<'_>, e: NoOptimum) -> RunError {
    RunError::Refused(match e {
        NoOptimum::Infeasible(f) if f.is_empty() => {
            format!("no pin of the ranges keeps the limits with a wall of {} mm", 1e3 * d.least_wall)
        }
        NoOptimum::Infeasible(f) => format!(
            "no pin of the ranges keeps the limits: with an outer diameter of {:.4} mm {}",
            1e3 * d.outer.high,
            because(&f)
        ),
        NoOptimum::Unproven(o) => format!(
            "the optimum could not be proved: stationarity {:.1e}, infeasibility {:.1e}, complementarity {:.1e}",
            o.proof.stationarity, o.proof.infeasibility, o.proof.complementarity
        ),
        NoOptimum::Model(e) => e.to_string(),
    })
}

fn exact(d: &Design<'_>, s: &Setup, o: &Optimise, out: &mut RunResult) -> Result<PinSize, RunError> {
    let mut best = lightest(d, s.given).or_else(|_| lightest(d, None)).map_err(|e| no_optimum(d, e))?;
    let mut proof = certify(d, &best.size, o.certificate.si(), MOST_BOXES);
    // The conditions hold in every local optimum; the certificate knows of a lighter pin elsewhere.
    for _ in 0..4 {
        let Some(lighter) = proof.lighter else { break };
        let Ok(other) = lightest(d, Some(lighter)) else { break };
        best = other;
        proof = certify(d, &best.size, o.certificate.si(), MOST_BOXES);
    }
    out.solver.method = "exact".into();
    out.solver.counters.insert("quadratic_programs".into(), u64::from(best.iterations));
    out.solver.counters.insert("boxes_of_the_certificate".into(), u64::from(proof.boxes));
    multipliers(d, &best, out);
    let p = best.proof;
    result(
        out,
        "stationarity",
        p.stationarity,
        "",
        "gradient of mass and limits left at the optimum, relative",
    );
    result(out, "infeasibility", p.infeasibility.max(0.0), "", "what the worst limit is exceeded by");
    result(out, "complementarity", p.complementarity, "", "multiplier times slack, over the mass");
    if let Some(c) = p.curvature {
        result(out, "curvature", c, "", "smallest curvature of the mass along the limits, relative");
    }
    result(
        out,
        "certificate_gap",
        (proof.best - proof.bound).max(0.0) / best.masses.pin,
        "",
        "no pin of the ranges is lighter by more than this part of the pin",
    );
    let active: Vec<String> = best
        .active()
        .iter()
        .map(|q| q.words().to_owned())
        .chain(
            Bound::ALL.into_iter().filter(|b| best.bounds[*b as usize] > 0.0).map(|b| b.words().to_owned()),
        )
        .collect();
    let held = if active.is_empty() { "nothing".to_owned() } else { active.join(", ") };
    let certified = if proof.closed {
        format!(
            "No pin of the ranges is lighter by more than {:.2e} of it ({} boxes).",
            o.certificate.si(),
            proof.boxes
        )
    } else {
        format!(
            "That no other pin of the ranges is lighter was proved only to {:.2e} of it.",
            (proof.best - proof.bound) / best.masses.pin
        )
    };
    out.solver.notes.push(Note::info("optimum", format!("The optimum is held by {held}. {certified}")));
    if let Some(g) = &s.given {
        let excess = d.masses(g).differential() - best.masses.differential();
        result(
            out,
            "excess_of_given",
            1e3 * excess,
            "g",
            "mass, less relief, of the given pin above the optimum",
        );
        let keeps = d.utilisation(g).is_ok_and(|u| u.iter().all(|u| *u <= 1.0 + 1e-9));
        if keeps {
            out.solver.notes.push(Note::info(
                "given_pin",
                format!("The given pin keeps the limits too and is {:.2} g heavier.", 1e3 * excess),
            ));
        }
    }
    Ok(best.size)
}

fn multipliers(d: &Design<'_>, best: &Optimum, out: &mut RunResult) {
    for q in PinQuantity::ALL.into_iter().filter(|q| d.limits[*q as usize].is_finite()) {
        let m = best.multipliers[q as usize];
        result(
            out,
            format!("multiplier_{}", q.name()),
            10.0 * m,
            "g/%",
            format!("mass saved by one per cent more {}", q.words()),
        );
    }
    // Every quantity is proportional to the force, deformations to the reciprocal of the modulus.
    let all: f64 = best.multipliers.iter().sum();
    let soft: f64 =
        PinQuantity::ALL.iter().filter(|q| q.is_length()).map(|q| best.multipliers[*q as usize]).sum();
    result(out, "sensitivity_force", 10.0 * all, "g/%", "mass added by one per cent more force");
    result(out, "sensitivity_modulus", -10.0 * soft, "g/%", "mass added by one per cent more modulus");
}

fn steps(s: &Setup, o: &Optimise) -> Steps {
    Steps {
        length: o.steps.length.si(),
        coarse: o.steps.coarse.si(),
        fine: o.steps.fine.si(),
        bore: s.bore,
        mantissa_32: o.steps.arithmetic == Arithmetic::Mantissa32,
    }
}

fn published(d: &Design<'_>, s: &Setup, o: &Optimise, out: &mut RunResult) -> Result<PinSize, RunError> {
    let start = given(s)?;
    let found = search(d, start, &steps(s, o)).map_err(model)?;
    let why = match found.end {
        End::Found => None,
        End::RodPressure => Some("rod pressure exceeds its limit, which no step changes".to_owned()),
        End::Length => Some("the length reached the piston diameter".to_owned()),
        End::Bore(q) => Some(format!("the bore vanished while {} still exceeded its limit", q.words())),
    };
    if let Some(why) = why {
        let also = because(&d.forbids(start.outer));
        // Nothing forbids such a pin: the search went past it.
        let advice = if matches!(found.end, End::Bore(_)) && also.is_empty() {
            "no limit forbids such a pin: start from a shorter one, for the search never shortens it, or take smaller steps"
        } else {
            "a larger outer diameter is needed"
        };
        let also =
            if also.is_empty() { String::new() } else { format!(" No search could do better: {also}.") };
        return Err(RunError::Refused(format!(
            "the published search ends without a pin of {:.4} mm outer diameter: {why}; {advice}.{also}",
            1e3 * start.outer
        )));
    }
    out.solver.method = "as published".into();
    out.solver.counters.insert("passes".into(), u64::from(found.passes));
    trace(d, &found, out);
    result(
        out,
        "start_bore_admitted",
        f64::from(u8::from(found.bore_was_admitted)),
        "",
        "1: the bore of the start kept the limits, the result is no optimum",
    );
    result(
        out,
        "start_length_admitted",
        f64::from(u8::from(found.length_was_admitted)),
        "",
        "1: the length of the start was never raised, the result may be too long",
    );
    if found.bore_was_admitted {
        out.solver.notes.push(Note::caution("not_an_optimum.bore", "The search started from a bore that keeps the limits already: it only stops one coarse step above it. This is no optimum."));
    }
    if found.length_was_admitted {
        out.solver.notes.push(Note::caution("not_an_optimum.length", "The search started from a length that is great enough already and never reduces it. This is no optimum."));
    }
    let mut here = *d;
    here.outer = Range::at(start.outer);
    let free = lightest(d, None).ok();
    let same = lightest(&here, None).ok();
    let mine = d.masses(&found.size).differential();
    if let Some(o) = same {
        result(
            out,
            "excess_here",
            1e3 * (mine - o.masses.differential()),
            "g",
            "mass, less relief, above the exact optimum of the same outer diameter",
        );
    }
    if let Some(o) = free {
        let excess = mine - o.masses.differential();
        result(
            out,
            "excess",
            1e3 * excess,
            "g",
            "mass, less relief, above the exact optimum of all dimensions",
        );
        out.solver.notes.push(Note::info("exact_optimum", format!(
            "The exact optimum of all dimensions is {:.2} g lighter: length {:.3} mm, outer diameter {:.3} mm, inner diameter {:.3} mm.",
            1e3 * excess,
            1e3 * o.size.length,
            1e3 * o.size.outer,
            1e3 * o.size.inner
        )));
    }
    Ok(found.size)
}

/// Counts of the messages that the program prints, by phase.
fn trace(d: &Design<'_>, found: &Search, out: &mut RunResult) {
    for (phase, name) in [(Phase::Coarse, "coarse"), (Phase::Fine, "fine")] {
        for q in PinQuantity::ALL.into_iter().filter(|q| d.limits[*q as usize].is_finite()) {
            let n = found.count(phase, q) as f64;
            let what = format!("{name} steps that {} asked for", q.words());
            result(out, format!("{name}_{}", q.name()), n, "", what);
        }
    }
    let order = (1..=found.trace.len()).map(|k| k as f64).collect();
    let of = |f: &dyn Fn(&(Phase, PinQuantity)) -> f64| found.trace.iter().map(f).collect();
    out.tables.insert(
        "trace".into(),
        Series {
            axis: column("pass", "", order),
            columns: vec![
                column("limit", "", of(&|t| f64::from(t.1 as u8) + 1.0)),
                column("fine", "", of(&|t| f64::from(u8::from(t.0 == Phase::Fine)))),
            ],
        },
    );
}

/// The lightest pin of each outer diameter, and the published search beside it.
fn sweep(d: &Design<'_>, s: &Setup, o: &Optimise, out: &mut RunResult) {
    if let Some(least) = d.least_outer() {
        result(
            out,
            "least_outer",
            1e3 * least,
            "mm",
            "smallest outer diameter with a pin that keeps the limits",
        );
        if least > d.outer.low * (1.0 + 1e-9) {
            let just = d.forbids(least * (1.0 - 1e-6));
            out.solver.notes.push(Note::info(
                "no_pin_below",
                format!("No pin below {:.4} mm of outer diameter: {}.", 1e3 * least, because(&just)),
            ));
            let first = d.forbids(d.outer.low);
            if first != just && !first.is_empty() {
                out.solver.notes.push(Note::info(
                    "no_pin_at",
                    format!("At {:.4} mm: {}.", 1e3 * d.outer.low, because(&first)),
                ));
            }
        }
    }
    let n = o.sweep_points as usize;
    if n < 2 || d.outer.is_fixed() {
        return;
    }
    let published = o.method == Method::AsPublished;
    let mut rows: Vec<[f64; 6]> = Vec::new();
    let mut used: Vec<[f64; 8]> = Vec::new();
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
        let mut stepped = 0.0;
        if published {
            let Some(g) = s.given else { continue };
            match search(&here, PinSize { outer, ..g }, &steps(s, o)) {
                Ok(f) if f.end == End::Found => stepped = d.masses(&f.size).differential(),
                _ => continue,
            }
        }
        let m = best.masses;
        rows.push([outer, best.size.length, best.size.inner, m.pin, m.differential(), stepped]);
        used.push(best.utilisation);
    }
    if rows.len() < 2 {
        return;
    }
    let of = |k: usize| rows.iter().map(|r| r[k]).collect::<Vec<_>>();
    let mut columns = vec![
        column("length", "m", of(1)),
        column("inner", "m", of(2)),
        column("pin_mass", "kg", of(3)),
        column("mass_differential", "kg", of(4)),
    ];
    let mut masses = vec![("pin", "pin_mass")];
    if s.relief.is_some() {
        masses.push(("pin less relief", "mass_differential"));
    }
    if published {
        columns.push(column("published_differential", "kg", of(5)));
        masses.push(("pin less relief, published search", "published_differential"));
    }
    let limited: Vec<PinQuantity> =
        PinQuantity::ALL.into_iter().filter(|q| d.limits[*q as usize].is_finite()).collect();
    for q in &limited {
        let name = format!("utilisation_{}", q.name());
        columns.push(column(&name, "", used.iter().map(|u| u[*q as usize]).collect()));
    }
    out.tables.insert("diameter_sweep".into(), Series { axis: column("outer", "m", of(0)), columns });
    lines(
        out,
        "diameter_sweep",
        "Lightest pin of each outer diameter",
        "mass against the outer diameter; length and bore are the best for each",
        &masses,
    );
    if s.relief.is_some() {
        // Without the pin itself the curve fills the page: the steps of the published search show.
        lines(
            out,
            "diameter_sweep",
            "Least mass of the pin less relief at each outer diameter",
            "",
            &masses[1..],
        );
    }
    lines(
        out,
        "diameter_sweep",
        "Dimensions of the lightest pin",
        "",
        &[("length", "length"), ("bore", "inner")],
    );
    let names: Vec<(String, String)> =
        limited.iter().map(|q| (q.words().to_owned(), format!("utilisation_{}", q.name()))).collect();
    let names: Vec<(&str, &str)> = names.iter().map(|(a, b)| (a.as_str(), b.as_str())).collect();
    lines(
        out,
        "diameter_sweep",
        "Limits of the lightest pin",
        "utilisation; a limit at 1 holds the pin",
        &names,
    );
}

/// Mass of the lightest pin over one limit.
fn front(d: &Design<'_>, q: PinQuantity, out: &mut RunResult) {
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

fn from_stock(d: &Design<'_>, sizes: &gudgeon_pin::stock::Sizes, best: &PinSize, out: &mut RunResult) {
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

/// Forces and stress over the cycle, and fatigue.
fn cycle(
    case: &PinCase,
    s: &Setup,
    d: &Design<'_>,
    size: &PinSize,
    out: &mut RunResult,
) -> Result<(), RunError> {
    let q = d.strength.quantities(size, &d.load).map_err(model)?;
    let full = q[PinQuantity::ResultantStress as usize];
    let design = d.load.total();
    // Every stress is proportional to the force and changes its sign with it.
    let stress: Vec<f64> = s.load.cycle.iter().map(|i| full * i.forces.total() / design.abs()).collect();
    if !s.fatigue.is_off() {
        // One instant known: the stress comes and goes.
        let ends = stress.iter().copied().chain([full * design.signum()]);
        let (mut low, mut high) =
            ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
        if stress.is_empty() {
            (low, high) = (low.min(0.0), high.max(0.0));
        }
        if case.pin.as_ref().is_some_and(|p| p.turns) {
            high = high.abs().max(low.abs());
            low = -high;
        }
        let (mean, amplitude) = (0.5 * (high + low), 0.5 * (high - low));
        // Beside the fibre in tension lies one in compression: the mean counts with either sign.
        let safety = s.fatigue.safety(mean.abs(), amplitude).map_err(model)?;
        result(out, "fatigue_mean", 1e-6 * mean.abs(), "MPa", "mean of the resultant stress over the cycle");
        result(out, "fatigue_amplitude", 1e-6 * amplitude, "MPa", "its amplitude");
        result(out, "fatigue_safety", safety, "", "safety against fatigue");
        if safety < 1.0 {
            out.solver.notes.push(Note::caution("fatigue", format!(
                "The pin keeps its limits perhaps, but not for ever: the safety against fatigue is {safety:.2}."
            )));
        }
    }
    if stress.is_empty() {
        return Ok(());
    }
    let c = &s.load.cycle;
    let of = |f: &dyn Fn(&gudgeon_core::kinds::PinInstant) -> f64| c.iter().map(f).collect();
    out.series = Series::over_cycle(
        of(&|i| i.theta.to_degrees()),
        vec![
            column("cylinder.pressure", "Pa", of(&|i| i.pressure)),
            column("pin.gas_force", "N", of(&|i| i.forces.gas)),
            column("pin.inertia_force", "N", of(&|i| i.forces.inertia)),
            column("pin.force", "N", of(&|i| i.forces.total())),
            column("pin.resultant_stress", "Pa", stress),
        ],
    );
    Ok(())
}
