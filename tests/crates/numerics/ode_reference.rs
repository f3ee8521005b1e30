//! The integrators against solutions that were computed independently: to 25 digits with an extrapolated implicit method in
//! 40-digit arithmetic (Robertson's reaction and van der Pol's oscillator, both in hairer1996, section IV.10), or known in
//! closed form.
#![allow(clippy::excessive_precision, reason = "17 digits, as the independent solution gives them")]

use gudgeon_numerics::EvalError;
use gudgeon_numerics::ode::{Flow, Integrator, OdeSystem, Options, Stats};
use gudgeon_numerics::radau::Radau5;
use gudgeon_numerics::rodas::Rodas;

/// An autonomous system given by its rates.
struct System<F>(usize, F);
impl<F: FnMut(&[f64], &mut [f64])> OdeSystem for System<F> {
    fn dim(&self) -> usize {
        self.0
    }
    fn rhs(&mut self, _: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        (self.1)(y, f);
        Ok(())
    }
}

fn solve<F: FnMut(&[f64], &mut [f64])>(
    radau: bool,
    f: F,
    end: f64,
    start: &[f64],
    rtol: f64,
    scale: &[f64],
) -> (Vec<f64>, Stats) {
    let n = start.len();
    let mut sys = System(n, f);
    let mut integrator: Box<dyn Integrator<System<F>>> =
        if radau { Box::new(Radau5::new(n, 0, None)) } else { Box::new(Rodas::new(n, 0, None)) };
    let (mut y, mut stats) = (start.to_vec(), Stats::default());
    let o = Options::new(rtol, scale);
    let r = integrator
        .integrate(&mut sys, (0.0, end), &[], &mut y, &mut [], &o, &mut stats, &mut |_, _| Flow::Continue);
    assert!(r.is_ok(), "{r:?} {stats:?}");
    (y, stats)
}

fn worst(y: &[f64], exact: &[f64]) -> f64 {
    y.iter().zip(exact).map(|(y, e)| (y / e - 1.0).abs()).fold(0.0, f64::max)
}

fn robertson(y: &[f64], f: &mut [f64]) {
    let (a, b, c) = (0.04 * y[0], 1e4 * y[1] * y[2], 3e7 * y[1] * y[1]);
    (f[0], f[1], f[2]) = (-a + b, a - b - c, c);
}

const ROBERTSON: [(f64, [f64; 3]); 5] = [
    (0.4, [0.985_172_113_860_989_9, 3.386_395_378_974_904e-5, 0.014_794_022_185_220_388]),
    (40.0, [0.715_827_068_719_405_1, 9.185_534_764_557_764e-6, 0.284_163_745_745_830_36]),
    (4e3, [0.183_202_257_776_709_3, 8.942_371_252_775_909e-7, 0.816_796_847_986_165_4]),
    (4e5, [4.938_274_520_979_816e-3, 1.984_994_087_954_375_5e-8, 0.995_061_705_629_079_4]),
    (4e11, [5.208_353_144_253_499e-9, 2.083_341_268_422_011_3e-14, 0.999_999_994_791_626]),
];

#[test]
fn robertson_over_twelve_decades() {
    for (end, exact) in ROBERTSON {
        // Absolute tolerances at the size of the solution: every component counts.
        let scale = exact.map(|e| e.min(1.0));
        for rtol in [1e-5, 1e-7, 1e-9] {
            let (y, s) = solve(true, robertson, end, &[1.0, 0.0, 0.0], rtol, &scale);
            assert!(worst(&y, &exact) < rtol, "radau {end:e} {rtol:e} {:e} {s:?}", worst(&y, &exact));
            let (y, s) = solve(false, robertson, end, &[1.0, 0.0, 0.0], rtol, &scale);
            // Its step control aims at the error per step, of which some hundred follow one another.
            assert!(worst(&y, &exact) < 10.0 * rtol, "rodas {end:e} {rtol:e} {:e} {s:?}", worst(&y, &exact));
        }
    }
}

fn van_der_pol(y: &[f64], f: &mut [f64]) {
    (f[0], f[1]) = (y[1], 1000.0 * (1.0 - y[0] * y[0]) * y[1] - y[0]);
}

#[test]
fn van_der_pol_through_its_jumps() {
    for (end, exact) in [
        (1.0, [1.999_333_370_506_308_8, -6.670_371_231_732_565e-4]),
        (500.0, [1.596_768_951_052_661_8, -1.030_391_187_839_356_7e-3]),
        (2000.0, [1.706_167_732_170_465, -8.928_097_010_248_165e-4]),
    ] {
        for rtol in [1e-5, 1e-7, 1e-9, 1e-11] {
            for radau in [true, false] {
                let (y, s) = solve(radau, van_der_pol, end, &[2.0, 0.0], rtol, &[1.0, 1e-3]);
                // An error in the time of a jump stays: errors of up to some thousand steps add up.
                assert!(
                    worst(&y, &exact) < 10.0 * rtol,
                    "{radau} {end} {rtol:e} {:e} {s:?}",
                    worst(&y, &exact)
                );
            }
        }
    }
}

/// A plate of mass m pressed with F on a film: `m z'' = -F - c z'/z³`, which lands ever more slowly. With p = m z' - c/(2 z²) + F t
/// constant along the motion.
#[test]
fn a_plate_lands_on_a_film() {
    let (m, force, c) = (0.012, 60.0, 1.2e-13);
    let (z0, v0) = (3e-5, -0.1);
    for (end, z, v) in [
        (1e-4, 2.926_851_409_211_745_8e-6, -0.021_883_830_769_486_912),
        (5e-4, 1.385_625_296_673_707_7e-6, -1.331_192_816_401_928_1e-3),
        (5e-3, 4.462_728_521_129_836e-7, -4.443_984_778_894_324e-5),
        (2e-2, 2.234_888_826_276_145_8e-7, -5.581_331_439_064_045e-6),
    ] {
        for radau in [true, false] {
            let plate =
                |y: &[f64], f: &mut [f64]| (f[0], f[1]) = (y[1], (-force - c * y[1] / y[0].powi(3)) / m);
            let (y, s) = solve(radau, plate, end, &[z0, v0], 1e-9, &[1e-6, 1e-6]);
            assert!(worst(&y, &[z, v]) < 1e-8, "{radau} {end} {:e} {s:?}", worst(&y, &[z, v]));
            let p = |z: f64, v: f64, t: f64| m * v - c / (2.0 * z * z) + force * t;
            // The terms grow to F t, which the film carries.
            assert!(
                (p(y[0], y[1], end) - p(z0, v0, 0.0)).abs() < 3e-8 * (force * end + m * 0.1),
                "{radau} {end}"
            );
        }
    }
}
