//! The lightest pins of 10 000 random engines: time, how well the conditions of each optimum hold, and what it takes to prove that no other pin
//! is lighter.
//!
//! `--table` prints the table alone, `--json N` the first N engines with their optima and the time of one (for `race_pin.py`); everything else
//! goes to criterion.
#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]
#![allow(clippy::print_stdout, missing_docs)]

use std::f64::consts::PI;
use std::hint::black_box;
use std::time::Instant;

use criterion::Criterion;
use gudgeon_core::kinds::{
    BossBore, PIN_QUANTITIES, PinForces, PinSize, PinStrength, PinStrengthCtx, PinStrengthSpec,
};
use gudgeon_pin::ThinRing;
use gudgeon_pin::certificate::certify;
use gudgeon_pin::design::{Design, Range, Relief};
use gudgeon_pin::optimum::{KKT_TOLERANCE, NoOptimum, Optimum, lightest};

/// Optimisations of one round.
const ENGINES: usize = 10_000;

/// kgf/mm² \[Pa\].
const KGF: f64 = 9_806_650.0;

struct Engine {
    ctx: PinStrengthCtx,
    gas: f64,
    inertia: f64,
    limits: [f64; PIN_QUANTITIES],
    bore: f64,
    relief: f64,
    outer: f64,
}

/// Random engines of 60 to 200 mm bore, the same on every machine.
fn engines(n: usize) -> Vec<Engine> {
    let mut seed = 20_260_101u64;
    let mut unit = move || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1u64 << 53) as f64
    };
    let mut between = move |a: f64, b: f64| a + (b - a) * unit();
    // The limits of Reimer (1984), varied; deformations in proportion to the engine.
    let base = [6.5 * KGF, 0.045e-3, 0.050e-3, 10.0 * KGF, 52.0 * KGF, 43.0 * KGF, 25.0 * KGF, 65.0 * KGF];
    (0..n)
        .map(|_| {
            let bore = between(60e-3, 200e-3);
            let gas = between(6e6, 18e6) * PI * bore * bore / 4.0;
            let gap = bore * between(0.28, 0.38);
            Engine {
                limits: std::array::from_fn(|k| {
                    let size = if k == 1 || k == 2 { bore / 85e-3 } else { 1.0 };
                    base[k] * size * between(0.85, 1.3)
                }),
                ctx: PinStrengthCtx {
                    boss_gap: gap,
                    rod_width: gap * between(0.85, 0.97),
                    boss_bore: BossBore::Profiled,
                    modulus: 206e9,
                    poisson: 0.3,
                    pi: PI,
                },
                gas,
                inertia: -gas * between(0.0, 0.1),
                bore,
                relief: bore * between(0.2, 0.35),
                outer: 0.6 * bore,
            }
        })
        .collect()
}

fn strength(e: &Engine) -> Box<dyn PinStrength> {
    ThinRing {}.build(&e.ctx).expect("the model builds")
}

fn design<'a>(e: &Engine, strength: &'a dyn PinStrength) -> Design<'a> {
    Design {
        strength,
        load: PinForces { gas: e.gas, inertia: e.inertia },
        limits: e.limits,
        density: 7850.0,
        pi: PI,
        relief: Some(Relief { bore: e.bore, height: e.relief, density: 2690.0 }),
        boss_gap: e.ctx.boss_gap,
        length: Range { low: 1.001 * e.ctx.boss_gap, high: 0.999 * e.bore },
        outer: Range { low: 0.2 * e.bore, high: e.outer },
        inner: Range { low: 0.0, high: e.bore },
        min_wall: 0.0,
        tolerance: PinSize::default(),
    }
}

fn solve(e: &Engine) -> Result<Optimum, NoOptimum> {
    lightest(&design(e, &*strength(e)), None)
}

/// Boxes that prove the optimum of an engine to a gap; none where it has no pin, or the gap stays open.
fn prove(e: &Engine, gap: f64) -> Option<u32> {
    let strength = strength(e);
    let d = design(e, &*strength);
    let c = certify(&d, &lightest(&d, None).ok()?.size, gap, 200_000);
    c.closed.then_some(c.boxes)
}

/// Seconds of one round, optima that are proved, engines without a pin, iterations, worst stationarity, infeasibility, complementarity.
fn round(all: &[Engine]) -> (f64, usize, usize, u32, [f64; 3]) {
    let begin = Instant::now();
    let (mut proved, mut none, mut iterations, mut worst) = (0, 0, 0, [0.0f64; 3]);
    for e in all {
        match black_box(solve(black_box(e))) {
            Ok(o) => {
                proved += usize::from(o.kkt.hold(KKT_TOLERANCE));
                iterations += o.iterations;
                let p = o.kkt;
                for (w, v) in worst.iter_mut().zip([p.stationarity, p.infeasibility, p.complementarity]) {
                    *w = w.max(v);
                }
            }
            Err(NoOptimum::Infeasible(_)) => none += 1,
            Err(_) => {}
        }
    }
    (begin.elapsed().as_secs_f64(), proved, none, iterations, worst)
}

fn table() {
    let all = engines(ENGINES);
    let mut rounds: Vec<_> = (0..5).map(|_| round(&all)).collect();
    rounds.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (seconds, proved, none, iterations, [stationarity, infeasibility, complementarity]) = rounds[2];
    println!("{ENGINES} engines: {seconds:.3} s, {:.1} us each", 1e6 * seconds / ENGINES as f64);
    println!(
        "{proved} optima proved, {none} engines without a pin, {} undecided, {:.1} quadratic programs each",
        ENGINES - proved - none,
        f64::from(iterations) / proved as f64
    );
    println!(
        "worst stationarity {stationarity:.1e}, infeasibility {infeasibility:.1e}, complementarity {complementarity:.1e}"
    );
}

/// Time and boxes of optimum and certificate together, over gaps.
fn certificates() {
    for (gap, engines) in [(1e-2, engines(ENGINES)), (1e-3, engines(ENGINES)), (1e-6, engines(ENGINES / 10))]
    {
        let begin = Instant::now();
        let boxes: Vec<u32> = engines.iter().filter_map(|e| prove(black_box(e), gap)).collect();
        let seconds = begin.elapsed().as_secs_f64();
        let (n, all): (usize, u64) = (boxes.len(), boxes.iter().map(|b| u64::from(*b)).sum());
        println!(
            "gap {gap:.0e}: {n} of {} proved, {:.1} us each with the optimum, {:.1} boxes",
            engines.len(),
            1e6 * seconds / engines.len() as f64,
            all as f64 / n as f64
        );
    }
}

fn json(n: usize) {
    let all = engines(n);
    // Warm, then the median of a few rounds over the same engines.
    let mut times: Vec<f64> = (0..7).map(|_| round(&all).0 / n as f64).collect();
    times.sort_by(f64::total_cmp);
    let rows: Vec<_> = all
        .iter()
        .map(|e| {
            let o = solve(e).ok();
            serde_json::json!({
                "gas": e.gas, "inertia": e.inertia, "limits": e.limits, "bore": e.bore, "relief": e.relief, "gap": e.ctx.boss_gap,
                "rod": e.ctx.rod_width, "modulus": e.ctx.modulus, "outer": e.outer,
                "size": o.as_ref().map(|o| [o.size.length, o.size.outer, o.size.inner]),
                "mass": o.as_ref().map(|o| o.masses.differential()),
            })
        })
        .collect();
    println!("{}", serde_json::json!({ "seconds": times[times.len() / 2], "engines": rows }));
}

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    if let Some(at) = arguments.iter().position(|a| a == "--json") {
        json(arguments.get(at + 1).and_then(|n| n.parse().ok()).unwrap_or(200));
        return;
    }
    table();
    certificates();
    if arguments.iter().any(|a| a == "--table") {
        return;
    }
    let mut c = Criterion::default().configure_from_args();
    let all = engines(100);
    c.bench_function("lightest pin", |b| {
        let mut k = 0;
        b.iter(|| {
            k = (k + 1) % all.len();
            solve(&all[k])
        });
    });
    c.bench_function("lightest pin and its certificate, gap 1e-3", |b| {
        let mut k = 0;
        b.iter(|| {
            k = (k + 1) % all.len();
            prove(&all[k], 1e-3)
        });
    });
    c.final_summary();
}
