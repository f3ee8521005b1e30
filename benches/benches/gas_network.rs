//! Cost and error of one cycle of a five-volume gas network.
//!
//! The table that comes first holds error beside time: a speed means nothing without the accuracy it was reached at. `--table`
//! prints the table alone, `--json` many more tolerances as one JSON array (for `race.py`); everything else goes to criterion.
#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]
#![allow(clippy::print_stdout, missing_docs)]
#![allow(clippy::excessive_precision, reason = "reference values stand as they were computed")]

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{BenchmarkId, Criterion};
use gudgeon_numerics::bdf::Bdf;
use gudgeon_numerics::ode::{Flow, Integrator, OdeSystem, Options, Stats};
use gudgeon_numerics::radau::Radau5;
use gudgeon_numerics::rodas::Rodas;

#[path = "../problems/gas_network.rs"]
mod problem;

use problem::{CYCLE, GasNet, N, fan};

/// Blow-by of the cycle \[kg\]: implicit and explicit codes at relative tolerances of 1e-11 and 1e-12 agree on it within 2e-10.
const BLOW_BY: f64 = 6.2493570768654555e-6;
const TOLERANCES: [f64; 6] = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8];

struct Outcome {
    blow_by: f64,
    stats: Stats,
    /// What left the chamber and is neither in a volume nor in the crankcase, relative to the blow-by.
    lost: f64,
}

/// One cycle from the periodic start.
fn cycle<I: Integrator<GasNet>>(
    integrator: &mut I,
    sys: &mut GasNet,
    options: &Options,
) -> Result<Outcome, String> {
    let start = GasNet::start();
    let (mut y, mut q) = (start, [0.0; 2]);
    let mut stats = Stats::default();
    integrator
        .integrate(sys, (0.0, CYCLE), &[], &mut y, &mut q, options, &mut stats, &mut |_, _| Flow::Continue)
        .map_err(|e| e.to_string())?;
    let stored: f64 = y.iter().zip(start).map(|(y, s)| y - s).sum();
    Ok(Outcome { blow_by: q[0], stats, lost: (q[1] - q[0] - stored) / q[0] })
}

struct Row {
    code: &'static str,
    rtol: f64,
    outcome: Outcome,
    microseconds: f64,
}

/// `judged`: whether the blow-by takes part in the error control, as in the codes that carry it as a state.
fn measure<I: Integrator<GasNet>>(
    code: &'static str,
    integrator: &mut I,
    rtol: f64,
    judged: bool,
) -> Result<Row, String> {
    let mut sys = GasNet::new();
    let mut options = Options::new(rtol, &GasNet::start());
    if judged {
        options.atol_quad = vec![1e-6 * rtol; 2];
    }
    let mut times = [0.0; 15];
    let mut outcome = cycle(integrator, &mut sys, &options)?;
    for time in &mut times {
        let begin = Instant::now();
        outcome = black_box(cycle(integrator, &mut sys, black_box(&options))?);
        *time = begin.elapsed().as_secs_f64() * 1e6;
    }
    times.sort_by(f64::total_cmp);
    Ok(Row { code, rtol, outcome, microseconds: times[7] })
}

fn rodas() -> Rodas {
    Rodas::new(N, 2, None)
}

fn table(tolerances: &[f64]) -> Result<Vec<Row>, String> {
    let mut rows = Vec::new();
    for &rtol in tolerances {
        rows.push(measure("Gudgeon BDF", &mut Bdf::new(N, 2, None), rtol, true)?);
    }
    for &rtol in tolerances {
        rows.push(measure("Gudgeon BDF, order 4", &mut Bdf::new(N, 2, None).up_to_order(4), rtol, true)?);
    }
    for &rtol in tolerances {
        rows.push(measure("Gudgeon Rodas5P", &mut rodas(), rtol, true)?);
    }
    for &rtol in tolerances {
        rows.push(measure("Gudgeon Radau5", &mut Radau5::new(N, 2, None), rtol, false)?);
    }
    Ok(rows)
}

fn main() {
    let args: Vec<String> = std::env::args().collect();
    let has = |name: &str| args.iter().any(|a| a == name);
    let rows = match table(&if has("--json") { fan() } else { TOLERANCES.to_vec() }) {
        Ok(rows) => rows,
        Err(e) => {
            println!("the reference problem stopped: {e}");
            return;
        }
    };
    if has("--json") {
        let rows: Vec<_> = rows
            .iter()
            .map(|r| {
                serde_json::json!({
                    "code": r.code,
                    "rtol": r.rtol,
                    "steps": r.outcome.stats.steps,
                    "rhs": r.outcome.stats.rhs,
                    "jacobians": r.outcome.stats.jacobians,
                    "blow_by": r.outcome.blow_by,
                    "microseconds": r.microseconds,
                })
            })
            .collect();
        println!("{}", serde_json::Value::Array(rows));
        return;
    }
    println!(
        "{:<20} {:>7} {:>6} {:>8} {:>6} {:>9} {:>13} {:>9} {:>9}",
        "code", "rtol", "steps", "rejected", "rhs", "jacobians", "blow-by error", "mass lost", "us"
    );
    for r in &rows {
        let s = &r.outcome.stats;
        println!(
            "{:<20} {:>7.0e} {:>6} {:>8} {:>6} {:>9} {:>13.2e} {:>9.1e} {:>9.1}",
            r.code,
            r.rtol,
            s.steps,
            s.rejected,
            s.rhs,
            s.jacobians,
            (r.outcome.blow_by / BLOW_BY - 1.0).abs(),
            r.outcome.lost.abs(),
            r.microseconds
        );
    }
    if has("--table") {
        return;
    }
    let mut criterion = Criterion::default()
        .sample_size(20)
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(2))
        .configure_from_args();
    let mut group = criterion.benchmark_group("gas_network");
    for rtol in &TOLERANCES[..4] {
        let (mut sys, mut integrator) = (GasNet::new(), rodas());
        let options = Options::new(*rtol, &GasNet::start());
        group.bench_with_input(BenchmarkId::new("rodas", format!("{rtol:e}")), &options, |b, options| {
            b.iter(|| cycle(&mut integrator, &mut sys, options).map(|o| o.blow_by));
        });
        let options = Options { atol_quad: vec![1e-6 * rtol; 2], ..options };
        for (name, order) in [("bdf", 5), ("bdf, order 4", 4)] {
            let mut integrator = Bdf::new(N, 2, None).up_to_order(order);
            group.bench_with_input(BenchmarkId::new(name, format!("{rtol:e}")), &options, |b, options| {
                b.iter(|| cycle(&mut integrator, &mut sys, options).map(|o| o.blow_by));
            });
        }
    }
    let mut sys = GasNet::new();
    let (y, mut f) = (GasNet::start(), [0.0; N + 2]);
    group.bench_function("rhs", |b| {
        b.iter(|| sys.rhs(black_box(0.02), black_box(&y), &mut f));
    });
    group.finish();
    criterion.final_summary();
}
