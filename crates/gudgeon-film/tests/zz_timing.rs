//! x
use gudgeon_core::geometry::FaceProfile;
use gudgeon_core::kinds::*;
use gudgeon_film::*;
use std::hint::black_box;
use std::time::Instant;
#[test]
fn timing() {
    let barrel = FaceProfile::Parabola { length: 1.2e-3, curvature: 6e-6 / 0.36e-6, apex: 0.6e-3 };
    let table = FaceProfile::Table { length: 1.2e-3, drops: (0..11).map(|i| 6e-6 * (i as f64 / 5.0 - 1.0f64).powi(2)).collect() };
    for (name, face) in [("parabola", &barrel), ("table11", &table)] {
        for c in [Cavitation::FullSommerfeld, Cavitation::HalfSommerfeld, Cavitation::SwiftStieber, Cavitation::MassConserving] {
            for (pn, p1, p2) in [("dry", 0.0, 0.0), ("gas", 1e5, 3e5)] {
                let mut f = ClosedFormFace { cavitation: c, cavity_shear: CavityShear::Auto }.build(&FaceCtx { face }).unwrap();
                let n = 20000;
                let mut best = [f64::INFINITY; 3];
                for _ in 0..15 {
                    let mut acc = 0.0;
                    let run = |k: usize| FaceIn { h: 2e-6 * (1.0 + 0.2 * (k as f64 * 0.003).sin()), u: 10.0 + (k as f64 * 0.002).sin(), p_bottom: p1, p_top: p2, p_cav: 0.0, mu: 0.01 };
                    let t = Instant::now();
                    for k in 0..n { acc += f.squeeze_rate(black_box(&run(k)), black_box(1500.0 + (k % 7) as f64)).unwrap(); }
                    best[0] = best[0].min(t.elapsed().as_nanos() as f64 / n as f64);
                    let t = Instant::now();
                    for k in 0..n { acc += f.evaluate(black_box(&run(k)), black_box(1e-4 * (k % 7) as f64)).unwrap().load; }
                    best[1] = best[1].min(t.elapsed().as_nanos() as f64 / n as f64);
                    let t = Instant::now();
                    for k in 0..n { acc += run(black_box(k)).h; }
                    best[2] = best[2].min(t.elapsed().as_nanos() as f64 / n as f64);
                    black_box(acc);
                }
                println!("{name} {c:?} {pn}: squeeze {:.0} ns, evaluate {:.0} ns (loop {:.0} ns)", best[0]-best[2], best[1]-best[2], best[2]);
            }
        }
    }
}
