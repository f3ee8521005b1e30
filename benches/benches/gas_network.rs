//! Cost and error of one cycle of a five-volume gas network.
//!
//! The table that comes first holds error beside time: a speed means nothing without the accuracy it was reached at. `--table`
//! prints the table alone, `--json` the same as one JSON array (for `race.py`); everything else goes to criterion.
#![allow(clippy::print_stdout, missing_docs)]
#![allow(clippy::excessive_precision, reason = "reference values stand as they were computed")]

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{BenchmarkId, Criterion};
use gudgeon_core::EvalError;
use gudgeon_core::quantity::quantity;
use gudgeon_gas::{Network, Orifice, OrificeFormula, Passage};
use gudgeon_numerics::bdf::Bdf;
use gudgeon_numerics::ode::{Flow, Integrator, LinearInvariant, OdeSystem, Options, Stats};
use gudgeon_numerics::radau::Radau5;
use gudgeon_numerics::rodas::Rodas;

const N: usize = 5;
/// Node of the chamber.
const CH: usize = 5;
/// Node of the crankcase.
const CC: usize = 6;
/// Joined nodes and effective area \[m²\].
const LINKS: [((usize, usize), f64); 9] = [
    ((CH, 0), 3e-7),
    ((CH, 1), 1.2e-7),
    ((0, 1), 1.5e-7),
    ((1, 2), 3e-7),
    ((1, 3), 1.6e-7),
    ((2, 3), 1e-7),
    ((3, 4), 4e-7),
    ((3, CC), 1e-6),
    ((4, CC), 2e-6),
];
/// Sizes \[m³\].
const VOLUMES: [f64; N] = [1.2e-7, 6e-7, 1e-7, 5e-7, 2e-7];
/// Pressures \[Pa\] at the start of the periodic cycle.
const START: [f64; N] = [
    100018.5728228574880631641,
    100049.1854464881180319935,
    100046.3416580167831853032,
    100008.2727634799521183595,
    100001.4000864467234350741,
];
const R: f64 = 287.0;
const TEMPERATURE: f64 = 450.0;
const CRANKCASE: f64 = 1e5;
/// Crank speed \[deg/s\]: 3000 rpm.
const OMEGA: f64 = 18_000.0;
const CYCLE: f64 = 720.0 / OMEGA;
/// Blow-by of the cycle \[kg\]: implicit and explicit codes at relative tolerances of 1e-11 and 1e-12 agree on it within 2e-10.
const BLOW_BY: f64 = 6.2493570768654555e-6;
const TOLERANCES: [f64; 6] = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8];

struct GasNet {
    net: Network,
    /// Time of the last Jacobian and the rates by time that came with it.
    at: f64,
    by_time: [f64; N + 2],
    invariants: Vec<LinearInvariant>,
}

impl GasNet {
    fn new() -> Self {
        let law = Orifice {
            discharge: quantity(1.0),
            law: OrificeFormula::Isentropic,
            laminar: quantity(1e-3),
            ..Orifice::default()
        }
        .build(1.33, R)
        .expect("the orifice law builds");
        let ends = LINKS.map(|l| l.0);
        let mut net = Network::new(law, R, &[TEMPERATURE; N + 2], N, &ends).expect("the network builds");
        for (l, (_, area)) in LINKS.into_iter().enumerate() {
            net.set_passage(l, Passage::Orifice { area });
        }
        net.set_pressure("bench", CC, CRANKCASE).expect("a pressure");
        // What leaves the chamber goes into the volumes or the crankcase.
        let terms = (0..=N).map(|row| (row, 1.0)).chain([(N + 1, -1.0)]).collect();
        Self {
            net,
            at: f64::NAN,
            by_time: [0.0; N + 2],
            invariants: vec![LinearInvariant { pivot: N + 1, terms }],
        }
    }

    fn set(&mut self, t: f64, y: &[f64]) -> Result<(), EvalError> {
        for (i, (&m, v)) in y.iter().zip(VOLUMES).enumerate() {
            self.net.set_mass("bench", i, m, v)?;
        }
        self.net.set_pressure("bench", CH, chamber(t * OMEGA).0)
    }

    fn start() -> [f64; N] {
        std::array::from_fn(|i| START[i] * VOLUMES[i] / (R * TEMPERATURE))
    }
}

/// Pressure in the chamber \[Pa\], compression and a combustion pulse, and its derivative \[Pa/deg\].
fn chamber(deg: f64) -> (f64, f64) {
    let (a, b) = ((deg - 360.0) / 55.0, (deg - 370.0) / 18.0);
    let (compression, combustion) = (11e5 * (-a * a).exp(), 68e5 * (-0.5 * b * b).exp());
    (1e5 + compression + combustion, -2.0 * a / 55.0 * compression - b / 18.0 * combustion)
}

impl OdeSystem for GasNet {
    fn dim(&self) -> usize {
        N
    }

    /// Into the crankcase, out of the chamber.
    fn quad_dim(&self) -> usize {
        2
    }

    fn rhs(&mut self, t: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        self.set(t, y)?;
        self.net.update_flows();
        let (rates, quadratures) = f.split_at_mut(N);
        self.net.rates(rates);
        quadratures[0] = self.net.flow(7) + self.net.flow(8);
        quadratures[1] = self.net.flow(0) + self.net.flow(1);
        Ok(())
    }

    fn jacobian(&mut self, t: f64, y: &[f64], _: &[f64], jac: &mut [f64]) -> Result<bool, EvalError> {
        self.set(t, y)?;
        self.net.update_partials();
        let (rates, quadratures) = jac.split_at_mut(N * N);
        self.net.jacobian(rates);
        quadratures.fill(0.0);
        for (row, link) in [(0, 7), (0, 8), (1, 0), (1, 1)] {
            self.net.add_flow_gradient(link, 1.0, &mut quadratures[row * N..row * N + N]);
        }
        // Time enters by the pressure in the chamber alone.
        let rate = chamber(t * OMEGA).1 * OMEGA;
        let into = [0, 1].map(|link| self.net.partials(link)[0] * rate);
        self.at = t;
        self.by_time = [into[0], into[1], 0.0, 0.0, 0.0, 0.0, into[0] + into[1]];
        Ok(true)
    }

    fn time_derivative(&mut self, t: f64, _: &[f64], _: &[f64], dfdt: &mut [f64]) -> Result<bool, EvalError> {
        // The integrator asks for it where it has just asked for the Jacobian.
        dfdt.copy_from_slice(&self.by_time);
        Ok(self.at == t)
    }

    fn invariants(&self) -> &[LinearInvariant] {
        &self.invariants
    }
}

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
    let mut times = Vec::with_capacity(50);
    let mut outcome = cycle(integrator, &mut sys, &options)?;
    for _ in 0..50 {
        let begin = Instant::now();
        outcome = black_box(cycle(integrator, &mut sys, black_box(&options))?);
        times.push(begin.elapsed().as_secs_f64() * 1e6);
    }
    times.sort_by(f64::total_cmp);
    Ok(Row { code, rtol, outcome, microseconds: 0.5 * (times[24] + times[25]) })
}

fn rodas() -> Rodas {
    Rodas::new(N, 2, None)
}

fn table() -> Result<Vec<Row>, String> {
    let mut rows = Vec::new();
    for rtol in TOLERANCES {
        rows.push(measure("gudgeon Rodas5P", &mut rodas(), rtol, false)?);
    }
    for rtol in TOLERANCES {
        rows.push(measure("gudgeon BDF", &mut Bdf::new(N, 2, None), rtol, true)?);
    }
    for rtol in TOLERANCES {
        rows.push(measure("gudgeon Radau5", &mut Radau5::new(N, 2, None), rtol, false)?);
    }
    Ok(rows)
}

fn main() {
    let args: Vec<String> = std::env::args().collect();
    let has = |name: &str| args.iter().any(|a| a == name);
    let rows = match table() {
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
        "{:<16} {:>7} {:>6} {:>8} {:>6} {:>9} {:>13} {:>9} {:>9}",
        "code", "rtol", "steps", "rejected", "rhs", "jacobians", "blow-by error", "mass lost", "us"
    );
    for r in &rows {
        let s = &r.outcome.stats;
        println!(
            "{:<16} {:>7.0e} {:>6} {:>8} {:>6} {:>9} {:>13.2e} {:>9.1e} {:>9.1}",
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
    }
    let mut sys = GasNet::new();
    let (y, mut f) = (GasNet::start(), [0.0; N + 2]);
    group.bench_function("rhs", |b| {
        b.iter(|| sys.rhs(black_box(0.02), black_box(&y), &mut f));
    });
    group.finish();
    criterion.final_summary();
}
