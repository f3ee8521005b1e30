//! Gas network and ring film as systems of differential equations, against independent high-precision solutions.
//!
//! The reference values come from `Radau` at a relative tolerance of 1e-12, checked against two other integrators (they differ by
//! less than 6e-9 in the gas and 2e-9 in the film); the film's film pressure is there a closed form of its own.
//! Slider-crank kinematics and Greenwood-Tripp contact are held against 20-digit values in `gudgeon-kinematics` and `gudgeon-contact`.

#![allow(clippy::excessive_precision, reason = "reference values stand as they were computed")]

use gudgeon_core::EvalError;
use gudgeon_core::geometry::FaceProfile;
use gudgeon_core::kinds::{FaceCtx, FaceIn, Hydrodynamics, HydrodynamicsSpec};
use gudgeon_core::quantity::quantity;
use gudgeon_gas::{Network, Passage};
use gudgeon_gas::{Orifice, OrificeFormula};
use gudgeon_models as _;
use gudgeon_numerics::ode::{Flow, Integrator, OdeSystem, Options, Stats};
use gudgeon_numerics::orbit::{CycleMap, OrbitOptions, periodic_orbit};
use gudgeon_numerics::rodas::Rodas;

// --- Gas ---------------------------------------------------------------------------------------------------------------

const R: f64 = 287.0;
const T: f64 = 450.0;
const VOLUMES: [f64; 5] = [1.2e-7, 6e-7, 1e-7, 5e-7, 2e-7];
/// Nodes 0 to 4 are the volumes, 5 the chamber, 6 the crankcase; effective areas \[m²\].
const LINKS: [(usize, usize, f64); 9] = [
    (5, 0, 3e-7),
    (5, 1, 1.2e-7),
    (0, 1, 1.5e-7),
    (1, 2, 3e-7),
    (1, 3, 1.6e-7),
    (2, 3, 1e-7),
    (3, 4, 4e-7),
    (3, 6, 1e-6),
    (4, 6, 2e-6),
];
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
/// Pressure that makes the states numbers near 1.
const SCALE: f64 = 1e5;
/// Time of a degree of crank angle \[s\].
const PER_DEGREE: f64 = 1.0 / (360.0 * 3000.0 / 60.0);

struct Gas {
    net: Network,
    masses: [f64; 5],
    d: [f64; 5],
}

impl Gas {
    fn new() -> Self {
        let orifice = Orifice {
            discharge: quantity(1.0),
            law: OrificeFormula::Isentropic,
            laminar: quantity(1e-3),
            ..Orifice::default()
        };
        let law = orifice.build(1.33, R).expect("a law");
        let links: Vec<_> = LINKS.iter().map(|l| (l.0, l.1)).collect();
        let mut net = Network::new(law, R, &[T; 7], 5, &links).expect("a network");
        for (k, l) in LINKS.iter().enumerate() {
            net.set_passage(k, Passage::Orifice { area: l.2 });
        }
        net.set_pressure("reference", 6, 1e5).expect("a pressure");
        Self { net, masses: [0.0; 5], d: [0.0; 5] }
    }
}

impl Gas {
    fn set(&mut self, th: f64, y: &[f64]) -> Result<(), EvalError> {
        let chamber = 1e5 * (1.0 + 11.0 * (-((th - 360.0) / 55.0).powi(2)).exp())
            + 68e5 * (-0.5 * ((th - 370.0) / 18.0).powi(2)).exp();
        self.net.set_pressure("reference", 5, chamber)?;
        for i in 0..5 {
            self.masses[i] = y[i] * SCALE * VOLUMES[i] / (R * T);
            self.net.set_mass("reference", i, self.masses[i], VOLUMES[i])?;
        }
        Ok(())
    }
}

impl OdeSystem for Gas {
    fn dim(&self) -> usize {
        5
    }
    fn quad_dim(&self) -> usize {
        2
    }
    /// Independent variable: degrees of crank angle at 3000 rpm. States: pressures over 1 bar. Quadratures: gas from the chamber and
    /// to the crankcase \[mg\].
    fn rhs(&mut self, th: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        self.set(th, y)?;
        self.net.update_flows();
        self.net.rates(&mut self.d);
        for i in 0..5 {
            f[i] = self.d[i] * R * T / VOLUMES[i] / SCALE * PER_DEGREE;
        }
        if f.len() > 5 {
            f[5] = 1e6 * (self.net.flow(0) + self.net.flow(1)) * PER_DEGREE;
            f[6] = 1e6 * (self.net.flow(7) + self.net.flow(8)) * PER_DEGREE;
        }
        Ok(())
    }

    fn jacobian(&mut self, th: f64, y: &[f64], _: &[f64], jac: &mut [f64]) -> Result<bool, EvalError> {
        self.set(th, y)?;
        self.net.update_slopes();
        jac.fill(0.0);
        self.net.jacobian(&mut jac[..25]);
        for (row, links) in [(5, [0, 1]), (6, [7, 8])] {
            for link in links {
                self.net.add_flow_gradient(link, 1.0, &mut jac[row * 5..row * 5 + 5]);
            }
        }
        for (row, entries) in jac.chunks_exact_mut(5).enumerate() {
            for (entry, volume) in entries.iter_mut().zip(VOLUMES) {
                let per_pressure = SCALE * volume / (R * T);
                let unit = if row < 5 { R * T / VOLUMES[row] / SCALE } else { 1e6 };
                *entry *= per_pressure * unit * PER_DEGREE;
            }
        }
        Ok(true)
    }
}

struct GasCycle {
    gas: Gas,
    rodas: Rodas,
    rtol: f64,
    stats: Stats,
    q: [f64; 2],
    table: Vec<[f64; 5]>,
}

impl GasCycle {
    fn integrate(&mut self, y: &mut [f64], rtol: f64) {
        let mut options = Options::new(rtol, &[1.0; 5]);
        options.h_max = 20.0;
        self.q = [0.0; 2];
        self.table.clear();
        let mut stats = Stats::default();
        let table = &mut self.table;
        let mut next = 0;
        self.rodas
            .integrate(&mut self.gas, (0.0, 720.0), &[], y, &mut self.q, &options, &mut stats, &mut |_, v| {
                while next < TABLE.len() && TABLE[next].0 <= v.t1() {
                    let mut p = [0.0; 5];
                    v.interpolate(TABLE[next].0, &mut p);
                    table.push(p.map(|p| p * SCALE));
                    next += 1;
                }
                Flow::Continue
            })
            .expect("one cycle");
        self.stats = stats;
    }
}

impl CycleMap for GasCycle {
    fn dim(&self) -> usize {
        5
    }
    fn map(&mut self, y0: &[f64], y1: &mut [f64], accuracy: f64) -> Result<f64, EvalError> {
        y1.copy_from_slice(y0);
        self.integrate(y1, accuracy.max(self.rtol));
        Ok(1.0)
    }
    fn scale(&self, _: &[f64], s: &mut [f64]) {
        s.fill(1.0);
    }
}

/// Periodic state at a tolerance: steps, error of the blow-by, largest error in the table, imbalance of the cycle (relative).
fn gas(rtol: f64) -> (u64, f64, f64, f64) {
    let mut c = GasCycle {
        gas: Gas::new(),
        rodas: Rodas::new(5, 2, None),
        rtol,
        stats: Stats::default(),
        q: [0.0; 2],
        table: Vec::new(),
    };
    let mut y = [1.0; 5];
    let options = OrbitOptions { tolerance: rtol, accuracy: rtol, max_cycles: 20, accelerate: true };
    let report = periodic_orbit(&mut c, &mut y, &options).expect("an orbit");
    assert!(report.converged && report.period == 1, "{report:?}");
    let start = y;
    c.integrate(&mut y, rtol);
    let stored: f64 = (0..5).map(|i| 1e6 * (y[i] - start[i]) * SCALE * VOLUMES[i] / (R * T)).sum();
    assert_eq!(c.table.len(), TABLE.len());
    let table = c
        .table
        .iter()
        .zip(&TABLE)
        .flat_map(|(a, b)| a.iter().zip(&b.1).map(|(a, b)| (a / b - 1.0).abs()))
        .fold(0.0, f64::max);
    let blow_by = (1e-6 * c.q[1] / BLOW_BY - 1.0).abs();
    (c.stats.steps, blow_by, table, ((c.q[0] - c.q[1] - stored) / c.q[1]).abs())
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
        // Masses and quadratures are integrated by one method: what goes in comes out to rounding. A thousand steps of sums of a
        // size of 6 mg leave 1e-13; the rows of a differenced Jacobian agree to 1e-8 of a correction.
        assert!(*balance < 1e-10);
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
