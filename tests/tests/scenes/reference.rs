//! Gas network and ring film as systems of differential equations, against independent high-precision solutions.
//!
//! The reference values come from `Radau` at a relative tolerance of 1e-12, checked against two other integrators (they differ by
//! less than 6e-9 in the gas and 2e-9 in the film); the film's film pressure is there a closed form of its own.
//! Slider-crank kinematics and Greenwood-Tripp contact are held against 20-digit values in `gudgeon-kinematics` and `gudgeon-contact`.

#![allow(clippy::excessive_precision, reason = "reference values stand as they were computed")]

use gudgeon_core::EvalError;
use gudgeon_core::file::Files;
use gudgeon_core::geometry::FaceProfile;
use gudgeon_core::kinds::{FaceCtx, FaceIn, Hydrodynamics, HydrodynamicsSpec, RigCtx, RigOut, RigSpec};
use gudgeon_models as _;
use gudgeon_numerics::ode::{Flow, Integrator, OdeSystem, Options, Stats};
use gudgeon_numerics::rodas::Rodas;

// --- Gas ---------------------------------------------------------------------------------------------------------------

/// Crank angles of the table \[deg\], and pressures there \[Pa\].
#[rustfmt::skip]
const TABLE: [(f64, [f64; 5]); 14] = [
    (30.0,  [100000.00000269547, 100000.00000680146, 100000.00000638631, 100000.00000133658, 100000.0000002344]),
    (90.0,  [100000.00002839003, 100000.00001449736, 100000.00001082661, 100000.00000200637, 100000.00000032884]),
    (180.0, [100019.11179929058, 100010.22054356645, 100007.78697556417, 100001.41583712418, 100000.2325359551]),
    (270.0, [144665.90257287727, 110085.45855362009, 108248.09872754513, 100374.30293821683, 100037.65752634495]),
    (330.0, [833858.0314830174, 213646.3416279023, 186223.84834795093, 102899.79093401221, 100166.69093595177]),
    (345.0, [1756171.868262545, 338391.62590287905, 266676.9812846577, 105723.32206064081, 100282.67855751743]),
    (360.0, [3800559.4715652512, 623935.8094986454, 448567.93260020576, 114411.24000031223, 100610.53310064341]),
    (370.0, [5539579.50839363, 911784.8535876133, 659021.262862862, 127198.1270314181, 101070.76598519301]),
    (380.0, [6503286.962930775, 1219268.918130748, 937951.7169532425, 147820.698940349, 101792.31519210382]),
    (400.0, [3305672.742793083, 1564019.5378006801, 1446395.2870262037, 205291.18006453535, 103779.51479370671]),
    (450.0, [821024.2201570712, 1098868.9748361965, 1096134.3408979427, 235576.14136201103, 105228.63418797863]),
    (540.0, [305222.68858906196, 447412.0876189741, 446381.1183765451, 123191.57150133968, 100976.74639800352]),
    (630.0, [129073.0149576085, 181651.46419352494, 181224.35083905078, 102970.50550873489, 100171.70855174659]),
    (720.0, [100018.57282329368, 100049.18544649144, 100046.34165776463, 100008.27276379244, 100001.40008649013]),
];
const BLOW_BY: f64 = 6.2493570768654555e-6;
/// Names of the volumes in the case.
const VOLUMES: [&str; 5] = ["behind1", "land2", "behind2", "land3", "behind3"];

/// The rig of the case `gas-five-volumes`, changed, after its run.
fn five_volumes(change: impl Fn(&mut toml::Value)) -> RigOut {
    let mut case: toml::Table =
        toml::from_str(include_str!("../../../cases/rigs/gas-five-volumes.toml")).expect("a case");
    let mut rig = case.remove("rig").expect("a rig");
    change(&mut rig);
    run(rig)
}

/// A rig after its run, which has nothing to tell.
fn run(rig: toml::Value) -> RigOut {
    let spec: Box<dyn RigSpec> = rig.try_into().expect("a specification");
    let mut bench = spec.build(&RigCtx { files: &Files::default() }).expect("builds");
    let mut out = RigOut::default();
    bench.run(&mut out).expect("a run");
    assert!(out.notes.is_empty(), "{:?}", out.notes);
    out
}

/// That rig at a tolerance: steps of all its cycles, error of the blow-by, largest error in the table, imbalance of the cycle (relative).
fn gas(rtol: f64) -> (u64, f64, f64, f64) {
    let out = five_volumes(|rig| rig["tolerance"] = rtol.into());
    let error = |angle: f64, i: usize, reference: f64| {
        let row = out.series.axis.values.iter().position(|t| *t == angle).expect("a row for every degree");
        let p = out.series.get(&format!("{}.p", VOLUMES[i])).expect("a column").values[row];
        (p / reference - 1.0).abs()
    };
    let table = TABLE
        .iter()
        .flat_map(|(angle, p)| p.iter().enumerate().map(|(i, p)| error(*angle, i, *p)))
        .fold(0.0, f64::max);
    let blow_by = (1e-6 * out.results["crankcase.received"].value / BLOW_BY - 1.0).abs();
    (out.counters["steps"], blow_by, table, out.balance.gas_mass.expect("a balance").abs())
}

#[test]
#[allow(clippy::print_stdout, reason = "measured errors are for reading")]
fn gas_network() {
    println!("rtol, steps, error of blow-by, largest error of 70 pressures, imbalance");
    // Where steps meet the kinks of the choking links is a matter of luck: errors at neighbouring tolerances scatter by a factor of
    // ten, so the worst of five stands for each.
    let worst = |rtol: f64| {
        [0.8, 0.9, 1.0, 1.1, 1.25]
            .map(|near| gas(near * rtol))
            .into_iter()
            .fold((0, 0.0f64, 0.0f64, 0.0f64), |w, g| {
                (w.0.max(g.0), w.1.max(g.1), w.2.max(g.2), w.3.max(g.3))
            })
    };
    let runs: Vec<_> = [1e-4, 1e-5, 1e-6, 1e-7, 1e-8].map(|rtol| (rtol, worst(rtol))).into_iter().collect();
    for (rtol, (steps, blow_by, table, balance)) in &runs {
        println!("{rtol:.0e} {steps:5} {blow_by:.2e} {table:.2e} {balance:.2e}");
        // Masses and quadratures are integrated by one method: what goes in comes out to rounding. A thousand steps leave 1e-13.
        assert!(*balance < 1e-13);
    }
    // At a sensible tolerance, and with the accuracy of the reference itself (6e-9) at a tight one.
    let (_, blow_by, table, _) = gas(1e-6);
    assert!(blow_by < 1e-5 && table < 1e-5, "1e-6: {blow_by:e} {table:e}");
    let (_, blow_by, table, _) = gas(1e-8);
    // Each of some 465 steps may err by the tolerance in every pressure, and most of it is forgotten before the next peak.
    assert!(blow_by < 1e-7 && table < 2e-7, "1e-8: {blow_by:e} {table:e}");
    // Errors fall with the tolerance.
    assert!(runs.windows(2).all(|w| w[1].1.1 < w[0].1.1 || w[1].1.1 < 1e-8));
}

/// At 5750 rpm with links that choke at once cycles differ by four times the tolerance, as the steps happen to meet the kinks: the search ends on cycles that are integrated ten
/// times as accurately. Before, it took all the cycles that it may and gave no result.
#[test]
fn a_periodic_state_below_the_noise_of_the_steps() {
    let five = |tolerance: f64| {
        let out = five_volumes(|rig| {
            rig["run"]["speed"] = "5750 rpm".into();
            rig["orifice"]["laminar"] = 1e-4.into();
            rig["tolerance"] = tolerance.into();
        });
        ["crankcase.received", "land2.p_max", "land3.p_max"].map(|name| out.results[name].value)
    };
    // Both are right to some ten times the tolerance (the errors of the table above).
    for (a, b) in five(1e-8).into_iter().zip(five(1e-10)) {
        assert!((a / b - 1.0).abs() < 1e-7, "{a} {b}");
    }
}

/// A vessel without a laminar branch in its opening, which comes to rest in a finite time. With a root down to equal pressures steps stayed as short as they were when it did: at most tolerances
/// 100 000 of them.
#[test]
fn a_vessel_that_has_blown_down_is_still() {
    for tolerance in [1e-12, 1e-9, 1e-6, 1e-4, 1e-2] {
        for (volume, area) in [("200 mm3", "0.02 mm2"), ("20 mm3", "0.02 mm2"), ("200 mm3", "200 mm2")] {
            let mut case: toml::Table =
                toml::from_str(include_str!("../../../cases/rigs/gas-blow-down.toml")).expect("a case");
            let mut rig = case.remove("rig").expect("a rig");
            rig["tolerance"] = tolerance.into();
            rig["volumes"][0]["volume"] = volume.into();
            rig["openings"][0]["area"] = area.into();
            let out = run(rig);
            let (steps, p) = (out.counters["steps"], out.results["vessel.p"].value);
            // 426 at the tightest, of order 5; what is left of the pressure may be a tenth of what counts as still.
            assert!(steps < 500, "{tolerance:e} {volume} {area}: {steps} steps");
            assert!((p - 1.0).abs() <= tolerance, "{tolerance:e} {volume} {area}: {p}");
        }
    }
}

// --- Film ---------------------------------------------------------------------------------------------------------------

/// Crank angle \[deg\] and film thickness \[m\].
const FILM: [(f64, f64); 28] = [
    (0.0, 1.6014903999865203e-6),
    (30.0, 4.0603866026448864e-6),
    (60.0, 5.524231810313946e-6),
    (90.0, 5.975986682617584e-6),
    (120.0, 5.640968311280489e-6),
    (150.0, 4.469672114112068e-6),
    (180.0, 2.1242683176757437e-6),
    (210.0, 3.982675352372216e-6),
    (240.0, 5.5316826946020405e-6),
    (270.0, 5.966309175436964e-6),
    (300.0, 5.131752528976438e-6),
    (330.0, 2.0401267725251866e-6),
    (355.0, 3.455003628363439e-7),
    (360.0, 1.6189650490839708e-7),
    (365.0, 1.51386732347685e-7),
    (375.0, 5.040765896076723e-7),
    (385.0, 8.637579745284894e-7),
    (390.0, 1.0747975567487478e-6),
    (420.0, 3.320977615254402e-6),
    (450.0, 5.716787322238278e-6),
    (480.0, 5.636878977219416e-6),
    (510.0, 4.469653347937598e-6),
    (540.0, 2.1242680756770195e-6),
    (570.0, 3.982675376592609e-6),
    (600.0, 5.53172313010697e-6),
    (630.0, 5.97655962411226e-6),
    (660.0, 5.60623953446794e-6),
    (690.0, 4.324967591741547e-6),
];
/// Friction work per circumference and cycle \[J/m\].
const FRICTION: f64 = 6.530339223355456;
/// Half of the face length \[m\].
const HALF: f64 = 0.6e-3;

struct Film {
    face: Box<dyn Hydrodynamics>,
    evaluations: u64,
}

impl OdeSystem for Film {
    fn dim(&self) -> usize {
        1
    }
    fn quad_dim(&self) -> usize {
        1
    }
    /// Independent variable: degrees of crank angle at 3000 rpm. State: `ln h`. Quadrature: friction work \[J/m\].
    fn rhs(&mut self, th: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        let (r, l) = (0.045, 0.144);
        let omega = 3000.0 * std::f64::consts::TAU / 60.0;
        let (s, c) = th.to_radians().sin_cos();
        // Speed of the piston, downwards positive; in the frame of the ring the liner moves up with it.
        let u = omega * (r * s + r * r * s * c / (l * l - r * r * s * s).sqrt());
        let pressure = 0.2e6 + 4e6 * (-0.5 * ((th - 370.0) / 25.0).powi(2)).exp() + 1e5 * (1.0 + c);
        let inp = FaceIn { h: y[0].exp(), u, p_bottom: 0.0, p_top: 0.0, p_cav: 0.0, mu: 0.01 };
        self.evaluations += 1;
        let rate = self.face.squeeze_rate(&inp, pressure * 2.0 * HALF)?;
        let per_degree = 1f64.to_radians() / omega;
        f[0] = rate / inp.h * per_degree;
        if f.len() > 1 {
            f[1] = self.face.evaluate(&inp, rate)?.liner_shear * u * per_degree;
        }
        Ok(())
    }
}

/// Errors of films and friction of the periodic cycle (relative), and steps.
fn film(cavitation: &str, cavity: &str, rtol: f64) -> (f64, f64, u64) {
    let spec: Box<dyn HydrodynamicsSpec> = serde_json::from_value(
        serde_json::json!({ "model": "closed_form_face", "cavitation": cavitation, "cavity_shear": cavity }),
    )
    .expect("a model");
    let profile = FaceProfile::Parabola { length: 2.0 * HALF, curvature: 6e-6 / (HALF * HALF), apex: HALF };
    let mut sys = Film { face: spec.build(&FaceCtx { face: &profile }).expect("a face"), evaluations: 0 };
    let mut rodas = Rodas::new(1, 1, None);
    let mut options = Options::new(rtol, &[1.0]);
    options.h_max = 20.0;
    let mut y = [3e-6f64.ln()];
    let (mut worst, mut friction, mut steps) = (0.0f64, 0.0, 0);
    // The film forgets its start within a cycle (the residual of the reference is 1e-14 after one).
    for cycle in 0..3 {
        let (mut q, mut stats) = ([0.0], Stats::default());
        let (mut next, mut error) = (0, 0.0f64);
        let breaks: Vec<f64> = (1..4).map(|k| 180.0 * f64::from(k)).collect();
        if cycle == 2 {
            error = (y[0].exp() / FILM[0].1 - 1.0).abs();
            next = 1;
        }
        rodas
            .integrate(&mut sys, (0.0, 720.0), &breaks, &mut y, &mut q, &options, &mut stats, &mut |_, v| {
                while next < FILM.len() && FILM[next].0 <= v.t1() {
                    let mut h = [0.0];
                    v.interpolate(FILM[next].0, &mut h);
                    error = error.max((h[0].exp() / FILM[next].1 - 1.0).abs());
                    next += 1;
                }
                Flow::Continue
            })
            .expect("one cycle");
        (worst, friction, steps) = (error, (q[0] / FRICTION - 1.0).abs(), stats.steps);
    }
    (worst, friction, steps)
}

#[test]
#[allow(clippy::print_stdout, reason = "measured errors are for reading")]
fn ring_film() {
    let mut last = f64::INFINITY;
    for rtol in [1e-4, 1e-6, 1e-8] {
        let (h, f, steps) = film("swift_stieber", "none", rtol);
        println!("{rtol:.0e}: {steps} steps, films {h:.2e}, friction {f:.2e}");
        assert!(h < last);
        last = h;
    }
    let (h, f, _) = film("swift_stieber", "none", 1e-8);
    // The reference is good to 2e-9; 1e-6 leaves a hundred steps of the integrator their 1e-8 each.
    assert!(h < 1e-6, "films differ by {h:e}");
    assert!(f < 1e-6, "friction differs by {f:e}");
}
