//! Cost and error of the closed-form film under a ring face: 1.2 mm wide, 6 µm crowned, 10 m/s, with one cavity.
//!
//! Sixteen films near each other take turns, as they do within a step of a cycle, so that every search starts close to where it ends
//! ("warm"). The error is that against the same film found without a start. `--table` prints the table alone; everything else goes
//! to criterion.
#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]
#![allow(clippy::print_stdout, missing_docs)]

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::Criterion;
use gudgeon_core::geometry::FaceProfile;
use gudgeon_core::kinds::{FaceCtx, FaceIn, Hydrodynamics, HydrodynamicsSpec};
use gudgeon_film::{Cavitation, ClosedFormFace};

const LENGTH: f64 = 1.2e-3;
/// Load of the searches for a squeeze velocity \[N/m\].
const LOAD: f64 = 1900.0;

fn film(cavitation: Cavitation) -> Box<dyn Hydrodynamics> {
    let face = FaceProfile::Parabola {
        length: LENGTH,
        curvature: 6e-6 / (0.5 * LENGTH).powi(2),
        apex: 0.5 * LENGTH,
    };
    ClosedFormFace { cavitation, ..ClosedFormFace::default() }
        .build(&FaceCtx { face: &face })
        .expect("a face")
}

/// Films that differ by `apart` in thickness, pressures and speed.
fn inputs(apart: f64) -> Vec<(FaceIn, f64)> {
    (0..16)
        .map(|k| {
            let s = apart * (f64::from(k) * 0.7).sin();
            let inp = FaceIn {
                h: 2e-6 * (1.0 + s),
                u: 10.0 * (1.0 + 0.5 * s),
                p_bottom: 1e5 * (1.0 - s),
                p_top: 1.2e5 * (1.0 + s),
                p_cav: 0.0,
                mu: 0.01,
            };
            (inp, 1e-3 * s)
        })
        .collect()
}

/// What is asked of a film.
#[derive(Clone, Copy)]
enum Question {
    Load,
    Forces,
    SqueezeRate,
    Carry,
}

fn ask(film: &mut dyn Hydrodynamics, q: Question, inp: &FaceIn, hdot: f64) -> f64 {
    match q {
        Question::Load => film.load(inp, hdot).expect("a film").0,
        Question::Forces => film.forces(inp, hdot).expect("a film").liner_shear,
        Question::SqueezeRate => film.squeeze_rate(inp, LOAD).expect("a film"),
        Question::Carry => film.carry(inp, LOAD).expect("a film").1.liner_shear,
    }
}

fn main() {
    let questions = [
        ("load", Question::Load),
        ("forces", Question::Forces),
        ("squeeze rate", Question::SqueezeRate),
        ("squeeze rate and forces", Question::Carry),
    ];
    let models =
        [("swift_stieber", Cavitation::SwiftStieber), ("mass_conserving", Cavitation::MassConserving)];
    println!("{:<16} {:<24} {:>10} {:>9} {:>9}", "cavitation", "asked for", "apart", "ns", "error");
    for (name, cavitation) in models {
        for (what, q) in questions {
            for apart in [0.0, 1e-4, 1e-2, 0.1] {
                let all = inputs(apart);
                let mut warm = film(cavitation);
                for (i, v) in &all {
                    ask(&mut *warm, q, i, *v);
                }
                let error = all
                    .iter()
                    .map(|(i, v)| {
                        let cold = ask(&mut *film(cavitation), q, i, *v);
                        (ask(&mut *warm, q, i, *v) / cold - 1.0).abs()
                    })
                    .fold(0.0, f64::max);
                // The shortest of many short batches: what the machine does between them is not the film's.
                let time = (0..200)
                    .map(|_| {
                        let begin = Instant::now();
                        for _ in 0..100 {
                            for (i, v) in &all {
                                black_box(ask(&mut *warm, q, black_box(i), *v));
                            }
                        }
                        begin.elapsed().as_secs_f64() * 1e9 / (100 * all.len()) as f64
                    })
                    .fold(f64::INFINITY, f64::min);
                println!("{name:<16} {what:<24} {apart:>10.0e} {time:>9.0} {error:>9.1e}");
            }
        }
    }
    if std::env::args().any(|a| a == "--table") {
        return;
    }
    let mut criterion = Criterion::default()
        .sample_size(30)
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(1))
        .configure_from_args();
    let mut group = criterion.benchmark_group("ring_face");
    for (name, cavitation) in models {
        let (mut warm, all) = (film(cavitation), inputs(1e-3));
        let mut k = 0;
        group.bench_function(name, |b| {
            b.iter(|| {
                k = (k + 1) % all.len();
                ask(&mut *warm, Question::Load, black_box(&all[k].0), all[k].1)
            });
        });
    }
    group.finish();
    criterion.final_summary();
}
