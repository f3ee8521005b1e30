//! Cost and error of the functions that films and gas passages evaluate at every point: asperity integral, orifice flow function,
//! flow and shear factors of rough surfaces.
//!
//! The table that comes first holds the largest relative error beside nanoseconds per point, the median of rounds in which all
//! functions take turns; `--table` prints it alone. Everything else goes to criterion.
#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]
#![allow(clippy::print_stdout, missing_docs)]

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{BenchmarkId, Criterion};
use gudgeon_contact::{AsperityIntegralFormula, GreenwoodTripp, asperity_integral};
use gudgeon_core::kinds::{ContactSpec, RoughFlow, RoughShear, RoughnessSpec};
use gudgeon_core::quantity::quantity;
use gudgeon_film::{PatirCheng, Pattern, SawtoothWaviness, WavinessTransport};
use gudgeon_gas::FlowFunction;

const POINTS: usize = 1000;
const SIGMA: f64 = 0.4e-6;

/// One function over a slice.
struct Contender {
    name: String,
    /// Largest relative error, and what it is an error of; none where the function is a definition.
    error: Option<(f64, &'static str)>,
    run: Box<dyn FnMut()>,
}

/// Numbers from 0 to 1 without order, so that no branch is learnt.
fn spread() -> Vec<f64> {
    (0..POINTS).map(|i| ((i * 617) % POINTS) as f64 / POINTS as f64).collect()
}

fn worst(pairs: impl Iterator<Item = (f64, f64)>) -> f64 {
    pairs.fold(0.0, |w, (got, exact)| w.max((got / exact - 1.0).abs()))
}

fn asperities() -> Vec<Contender> {
    use AsperityIntegralFormula::{Exact, Hu1994, Polynomial, Quintic};
    // Separations from touching mean planes to where the integral is 1e-8 of its value there; the fits end before.
    let forms = [
        (Exact, 5.0, "up to 5 sigma"),
        (Polynomial, 5.0, "up to 5 sigma"),
        (Hu1994, 3.0, "up to 3 sigma"),
        (Quintic, 2.0, "up to 2 sigma"),
    ];
    forms
        .into_iter()
        .map(|(integral, to, range)| {
            let spec = GreenwoodTripp {
                roughness: quantity(SIGMA),
                composite_modulus: quantity(1.15e11),
                asperity_density: None,
                asperity_radius: None,
                eta_beta_sigma: Some(quantity(0.05)),
                sigma_over_beta: Some(quantity(0.001)),
                integral,
                friction_coefficient: quantity(0.1),
            };
            let model = spec.build().expect("the contact builds");
            let scale = 16.0 * std::f64::consts::SQRT_2 * std::f64::consts::PI / 15.0
                * 0.05f64.powi(2)
                * 0.001f64.sqrt()
                * 1.15e11;
            let mut p = vec![0.0; POINTS];
            let h: Vec<f64> = spread().iter().map(|x| to * x * SIGMA).collect();
            model.pressure(&h, &mut p);
            let error = worst(h.iter().zip(&p).map(|(h, p)| (p / scale, asperity_integral(2.5, h / SIGMA))));
            let h: Vec<f64> = spread().iter().map(|x| 5.0 * x * SIGMA).collect();
            Contender {
                name: format!("F_5/2 {integral:?}"),
                error: Some((error, range)),
                run: Box::new(move || model.pressure(black_box(&h), black_box(&mut p))),
            }
        })
        .collect()
}

/// A form of the flow function.
type Psi = fn(&FlowFunction, f64) -> f64;

fn orifices() -> Vec<Contender> {
    let f = FlowFunction::new(1.4).expect("the flow function builds");
    let u = spread();
    let error = |psi: Psi| worst(u.iter().filter(|u| **u > 0.0).map(|&u| (psi(&f, u), f.psi_exact(u))));
    let forms: [(&str, Psi); 3] = [
        ("psi fast", FlowFunction::psi),
        ("psi laminar", |f, u| f.psi_laminar(u, 1e-3)),
        ("psi by ln and exp", FlowFunction::psi_exact),
    ];
    forms
        .into_iter()
        .enumerate()
        .map(|(k, (name, psi))| {
            // The laminar branch is a definition, and the exact form what the fast one is measured against.
            let error = (k == 0).then(|| (error(psi), "all drops"));
            let (f, u, mut out) = (f.clone(), u.clone(), vec![0.0; POINTS]);
            let run = move || {
                for (o, &u) in out.iter_mut().zip(black_box(&u)) {
                    *o = psi(&f, u);
                }
                black_box(&mut out);
            };
            Contender { name: name.to_owned(), error, run: Box::new(run) }
        })
        .collect()
}

fn rough_surfaces() -> Vec<Contender> {
    let patir_cheng = |pattern| PatirCheng {
        liner_roughness: quantity(0.8 * SIGMA),
        body_roughness: quantity(0.6 * SIGMA),
        pattern,
        liner_pattern: None,
        body_pattern: None,
    };
    let waves = SawtoothWaviness {
        amplitude: quantity(SIGMA),
        transport: WavinessTransport::Homogenised,
        closest: quantity(1.02),
    };
    let specs: [(&str, Box<dyn RoughnessSpec>); 3] = [
        ("patir_cheng 1", Box::new(patir_cheng(Pattern::One))),
        ("patir_cheng 1/9", Box::new(patir_cheng(Pattern::Ninth))),
        ("sawtooth_waviness", Box::new(waves)),
    ];
    let mut contenders = Vec::new();
    for (k, (name, spec)) in specs.into_iter().enumerate() {
        let h: Vec<f64> = spread().iter().map(|x| 8.0 * x * SIGMA).collect();
        let (mut flow, mut shear) = (RoughFlow::new(POINTS), RoughShear::new(POINTS));
        let build = || spec.build().expect("the roughness builds");
        let model = build();
        model.flow(&h, &mut flow).expect("finite separations");
        // The average gap of Gaussian surfaces is F_1 of minus the separation.
        let gap = |h: f64| SIGMA * asperity_integral(1.0, -h / SIGMA);
        let error =
            (k < 2).then(|| (worst(h.iter().zip(&flow.content).map(|(&h, &c)| (c, gap(h)))), "average gap"));
        let (slice, other) = (h.clone(), build());
        contenders.push(Contender {
            name: format!("{name} flow"),
            error,
            run: Box::new(move || drop(model.flow(black_box(&slice), black_box(&mut flow)))),
        });
        contenders.push(Contender {
            name: format!("{name} shear"),
            error: None,
            run: Box::new(move || drop(other.shear(black_box(&h), black_box(&mut shear)))),
        });
    }
    contenders
}

fn main() {
    let mut contenders = asperities();
    contenders.extend(orifices());
    contenders.extend(rough_surfaces());
    let mut times = vec![Vec::new(); contenders.len()];
    for _ in 0..101 {
        for (c, times) in contenders.iter_mut().zip(&mut times) {
            let begin = Instant::now();
            for _ in 0..20 {
                (c.run)();
            }
            times.push(begin.elapsed().as_secs_f64() * 1e9 / (20 * POINTS) as f64);
        }
    }
    println!("{:<24} {:>8} {:>8}  {:>9}", "function", "ns/point", "best", "error");
    for (c, times) in contenders.iter().zip(&mut times) {
        times.sort_by(f64::total_cmp);
        let error = c.error.map_or(String::new(), |(e, of)| format!("{e:>9.1e}  {of}"));
        println!("{:<24} {:>8.2} {:>8.2}  {error}", c.name, times[times.len() / 2], times[0]);
    }
    if std::env::args().any(|a| a == "--table") {
        return;
    }
    let mut criterion = Criterion::default()
        .sample_size(20)
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(1))
        .configure_from_args();
    let mut group = criterion.benchmark_group("surface_functions");
    for c in &mut contenders {
        group.bench_function(BenchmarkId::from_parameter(&c.name), |b| b.iter(&mut c.run));
    }
    group.finish();
    criterion.final_summary();
}
