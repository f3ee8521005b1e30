//! Orbits of maps whose fixed points and multipliers are known: the true error against the reported one.

use gudgeon_numerics::EvalError;
use gudgeon_numerics::orbit::{Bend, Change, CycleMap, Led, OrbitOptions, OrbitReport, periodic_orbit};
use nalgebra::{DMatrix, DVector};

const N: usize = 8;

/// How maps of stores are searched here.
const BEND: Bend =
    Bend { fresh: 0.2, stride: 40.0, reach: 4.0, rough: 0.03, settles: (4, 2), noise: 1.0, slow: 1.0 };

/// `y -> x + M (y - x)` with the given multipliers along a skew basis, and an error of every cycle of the size of its accuracy.
struct Linear {
    fixed: DVector<f64>,
    m: DMatrix<f64>,
    scale: Vec<f64>,
    noise: f64,
    state: u64,
    start: Vec<f64>,
}

/// A reproducible number in (-1, 1).
fn noise(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

impl Linear {
    /// The largest multiplier given, the others falling from 0.3 of it.
    fn new(largest: f64, noise_level: f64, seed: u64) -> Self {
        let tail = [0.3, 0.2, -0.12, 0.05, 0.02, 0.0, 0.0].map(|f| f * largest.abs().min(1.0));
        let mut lambda = vec![largest];
        lambda.extend(tail);
        Self::with(&lambda, noise_level, seed)
    }

    fn with(lambda: &[f64], noise_level: f64, seed: u64) -> Self {
        let mut state = seed;
        // Units from 1e-6 to 1e5, as film thicknesses and pressures have.
        let scale: Vec<f64> = (0..N).map(|i| [1.0, 1e-6, 1e5, 1e-2, 1e-6, 1e5, 3.0, 1e-3][i]).collect();
        let basis = DMatrix::from_fn(N, N, |i, j| f64::from(u8::from(i == j)) + 0.3 * noise(&mut state));
        let inverse = basis.clone().try_inverse().unwrap();
        let units = DMatrix::from_diagonal(&DVector::from_vec(scale.clone()));
        let m = &basis * DMatrix::from_diagonal(&DVector::from_row_slice(lambda)) * inverse;
        let m = &units * m * units.clone().try_inverse().unwrap();
        let fixed = DVector::from_fn(N, |i, _| scale[i] * (1.0 + 0.4 * noise(&mut state)));
        // Every mode takes part in the start, the slow one with about 0.4.
        let parts = DVector::from_fn(N, |i, _| if i == 0 { 0.4 } else { 0.5 * noise(&mut state) });
        let start = (&fixed + &units * &basis * parts).iter().copied().collect();
        Self { fixed, m, scale, noise: noise_level, state, start }
    }

    fn error(&self, y: &[f64]) -> f64 {
        (0..N).map(|i| ((y[i] - self.fixed[i]) / self.scale[i]).abs()).fold(0.0, f64::max)
    }
}

impl CycleMap for Linear {
    fn dim(&self) -> usize {
        N
    }
    fn map(&mut self, y0: &[f64], y1: &mut [f64], accuracy: f64) -> Result<f64, EvalError> {
        let y = &self.fixed + &self.m * (DVector::from_row_slice(y0) - &self.fixed);
        for i in 0..N {
            y1[i] = y[i] + self.noise * accuracy * self.scale[i] * noise(&mut self.state);
        }
        Ok(1.0)
    }
    fn scale(&self, _: &[f64], s: &mut [f64]) {
        s.copy_from_slice(&self.scale);
    }
}

fn options(tolerance: f64, accelerate: bool) -> OrbitOptions {
    OrbitOptions {
        tolerance,
        accuracy: tolerance / 30.0,
        refinements: 0,
        max_cycles: if accelerate { 60 } else { 300 },
        accelerate,
    }
}

/// A map that keeps which of its cycles it was told of as probably the last.
struct Told {
    map: Linear,
    cycles: usize,
    announced: Vec<usize>,
    near: Option<f64>,
}

impl CycleMap for Told {
    fn dim(&self) -> usize {
        self.map.dim()
    }
    fn map(&mut self, y0: &[f64], y1: &mut [f64], accuracy: f64) -> Result<f64, EvalError> {
        self.cycles += 1;
        self.map.map(y0, y1, accuracy)
    }
    fn scale(&self, y: &[f64], s: &mut [f64]) {
        self.map.scale(y, s);
    }
    fn expect_last(&mut self) {
        self.announced.push(self.cycles + 1);
    }
    fn begins_near(&self) -> Option<f64> {
        self.near
    }
}

/// A search that begins where one of a like map ended, far enough from the orbit to need two cycles of a map that forgets nearly all in one.
#[test]
fn the_second_cycle_from_a_start_near_the_orbit_is_announced_and_no_other() {
    for (near, announced) in [(Some(f64::INFINITY), vec![2]), (None, Vec::new())] {
        for seed in 1..=SEEDS {
            let map = Linear::new(3e-3, 0.0, seed);
            // Some 2e-4 of the units of the states: what is left after a cycle is less than the accuracy, 3e-6.
            let mut y: Vec<f64> =
                map.start.iter().zip(map.fixed.iter()).map(|(y, x)| x + 5e-4 * (y - x)).collect();
            let mut map = Told { map, cycles: 0, announced: Vec::new(), near };
            let r = periodic_orbit(&mut map, &mut y, &options(1e-4, true)).unwrap();
            assert!(r.converged && r.cycles == 2, "{seed}: {r:?}");
            assert_eq!(map.announced, announced, "{seed}: {r:?}");
        }
    }
}

/// What is gathered in a cycle that is announced costs less than a cycle, so that announcements pay when more of them come true than not. Of 199 searches of a map with eight
/// modes, which end abruptly, 58 announce their last cycle, and 26 one that is not.
#[test]
fn announced_cycles_are_the_last_ones_more_often_than_not() {
    let (mut kept, mut vain) = (0, 0);
    for seed in 1..=SEEDS {
        let map = Linear::new(0.8, 1.0, seed);
        let mut y = map.start.clone();
        let mut map = Told { map, cycles: 0, announced: Vec::new(), near: None };
        let r = periodic_orbit(&mut map, &mut y, &options(1e-4, true)).unwrap();
        assert_eq!(r.cycles, map.cycles);
        let last = usize::from(map.announced.last() == Some(&r.cycles));
        kept += last;
        vain += map.announced.len() - last;
    }
    // A quarter of the searches; by chance, a standard deviation is 7.
    assert!(kept >= 50 && vain < kept, "{kept} {vain}");
}

/// A map whose cycles differ by more than its orbit is asked for (rings that flutter) turns its residual every other time, which says nothing of an end.
#[test]
fn a_residual_that_turns_and_does_not_fall_announces_nothing() {
    let (mut announced, mut cycles) = (0, 0);
    for seed in 1..=SEEDS {
        // Noise of ten times the tolerance.
        let map = Linear::new(0.3, 300.0, seed);
        let mut y = map.start.clone();
        let mut map = Told { map, cycles: 0, announced: Vec::new(), near: None };
        periodic_orbit(&mut map, &mut y, &options(1e-4, true)).unwrap();
        announced += map.announced.len();
        cycles += map.cycles;
    }
    // One of 11940, by chance; 6408 where a residual that turned was taken for one that is gone.
    assert!(100 * announced <= cycles, "{announced} of {cycles}");
}

/// A last cycle began as far from the orbit as its end is, and the way that it went.
#[test]
fn a_last_cycle_began_within_what_is_told() {
    for seed in 1..=SEEDS {
        let map = Linear::new(0.8, 0.0, seed);
        let mut y = map.start.clone();
        let mut map = Kept { map, start: Vec::new() };
        let r = periodic_orbit(&mut map, &mut y, &options(1e-4, true)).unwrap();
        // An estimate may be a third of the error, as in [`survey`].
        assert!(map.map.error(&map.start) <= 3.0 * r.began_at(), "{seed}: {r:?}");
    }
}

/// A map that keeps where its last cycle began.
struct Kept {
    map: Linear,
    start: Vec<f64>,
}

impl CycleMap for Kept {
    fn dim(&self) -> usize {
        self.map.dim()
    }
    fn map(&mut self, y0: &[f64], y1: &mut [f64], accuracy: f64) -> Result<f64, EvalError> {
        self.start = y0.to_vec();
        self.map.map(y0, y1, accuracy)
    }
    fn scale(&self, y: &[f64], s: &mut [f64]) {
        self.map.scale(y, s);
    }
}

/// Runs many starts and bases; every converged answer must be as good as it says, to a factor 3. Answers the median of the cycles
/// and how many converged.
fn survey(largest: f64, level: f64, tolerance: f64, accelerate: bool) -> (usize, usize) {
    let (mut cycles, mut converged) = (Vec::new(), 0);
    for seed in 1..=SEEDS {
        let mut map = Linear::new(largest, level, seed);
        let mut y = map.start.clone();
        let r = periodic_orbit(&mut map, &mut y, &options(tolerance, accelerate)).unwrap();
        let error = map.error(&y);
        assert_eq!(r.period, 1, "{largest} {level} {tolerance:e} {seed}: {r:?}");
        if r.converged {
            converged += 1;
            assert!(r.error_estimate <= tolerance);
            // 1e-14: rounding of the states themselves.
            assert!(
                error <= 3.0 * r.error_estimate + 1e-14,
                "{largest} {level} {tolerance:e} {seed}: {error:e} {r:?}"
            );
        } else {
            assert!(r.error_estimate > tolerance, "{largest} {level} {tolerance:e} {seed}: {r:?}");
        }
        assert_eq!(r.cycles as f64, r.cycle_equivalents);
        cycles.push(r.cycles);
    }
    cycles.sort_unstable();
    (cycles[SEEDS as usize / 2], converged)
}

const SEEDS: u64 = 199;

#[test]
fn estimates_of_accelerated_orbits_are_true() {
    for tolerance in [1e-3, 1e-4, 1e-6] {
        for level in [0.0, 1.0] {
            for largest in [0.0, 0.3, 0.7, -0.9] {
                let (_, converged) = survey(largest, level, tolerance, true);
                assert_eq!(converged, SEEDS as usize, "{largest} {level} {tolerance:e}");
            }
            let (_, converged) = survey(0.95, level, tolerance, true);
            // With an error of tolerance/30 in every cycle the state is uncertain by 20 times that, not far from the tolerance:
            // some starts rightly end unconverged.
            assert!(
                converged as f64 > if level == 0.0 { 0.999 } else { 0.9 } * SEEDS as f64,
                "{level} {tolerance:e} {converged}"
            );
        }
    }
}

/// A multiplier of 0.999 makes an error a thousand times the residual: with noise of tolerance/30 no answer is good to the tolerance, and
/// the search must say so. At a tolerance of 1e-3 the slow mode's residual of 4e-4 is itself not far above noise (3e-5): there chance can
/// hide it, and did so for 1 of 199 starts when this was written; the statement is made for the tighter tolerances.
#[test]
fn the_edge_of_stability_is_reported() {
    for tolerance in [1e-4, 1e-6] {
        let (cycles, converged) = survey(0.999, 0.0, tolerance, true);
        // Found exactly, once the slow mode is seen; 8 of the cycles confirm that the orbit is stable.
        assert!(cycles <= 18 && converged * 10 > 9 * SEEDS as usize, "{cycles} {converged}");
        let (_, converged) = survey(0.999, 1.0, tolerance, true);
        assert_eq!(converged, 0);
    }
    survey(0.999, 0.0, 1e-3, true);
}

#[test]
fn cycles_of_accelerated_orbits() {
    // The targets of the design: a machine without memory in 3, a slow one (plain repetition: 170 cycles) in 8.
    assert!(survey(0.0, 0.0, 1e-4, true).0 <= 3);
    assert!(survey(0.0, 1.0, 1e-4, true).0 <= 3);
    assert!(survey(0.3, 0.0, 1e-4, true).0 <= 6);
    assert!(survey(0.95, 0.0, 1e-4, true).0 <= 8);
    assert!(survey(0.95, 1.0, 1e-4, true).0 <= 9);
    // A negative one: 8 of the cycles confirm that the orbit is stable.
    assert!(survey(-0.9, 0.0, 1e-4, true).0 <= 15);
    assert!(survey(0.999, 0.0, 1e-6, true).0 <= 18);
}

#[test]
fn estimates_of_repeated_orbits_are_true() {
    for tolerance in [1e-3, 1e-4, 1e-6] {
        for largest in [0.0, 0.3, 0.7, -0.9, 0.95] {
            let (_, converged) = survey(largest, 0.0, tolerance, false);
            assert_eq!(converged, SEEDS as usize, "{largest} {tolerance:e}");
        }
        for largest in [0.0, 0.3, 0.7] {
            let (_, converged) = survey(largest, 1.0, tolerance, false);
            assert_eq!(converged, SEEDS as usize, "{largest} {tolerance:e}");
        }
    }
    // At 1e-3 the slow mode's change per cycle, 4e-4, passes for convergence while the fast modes fade: 54 of 199 starts were
    // then called converged when this was written. Plain repetition cannot know; the accelerated search does.
    for tolerance in [1e-4, 1e-6] {
        let (_, converged) = survey(0.999, 0.0, tolerance, false);
        assert_eq!(converged, 0);
    }
}

/// A linear map that is said to be bent, and how much noise it says that its cycles have over what is usual.
struct Bent(Linear, f64);
impl CycleMap for Bent {
    fn dim(&self) -> usize {
        N
    }
    fn map(&mut self, y0: &[f64], y1: &mut [f64], accuracy: f64) -> Result<f64, EvalError> {
        self.0.map(y0, y1, accuracy)
    }
    fn scale(&self, y: &[f64], s: &mut [f64]) {
        self.0.scale(y, s);
    }
    fn noise(&self) -> f64 {
        self.1
    }
    fn bend(&self) -> Option<Bend> {
        Some(Bend { noise: 0.1, ..BEND })
    }
}

/// Cycles, and errors over their estimates, of searches of maps with a slow mode, whose cycles have the noise `level` over their `accuracy` and say that it is
/// `said` times what is usual; both in order.
fn searches_of_a_slow_mode(accuracy: f64, level: f64, said: f64) -> (Vec<usize>, Vec<f64>) {
    let (mut cycles, mut errors) = (Vec::new(), Vec::new());
    for seed in 1..=SEEDS {
        // The slow mode makes twenty times the noise of a cycle of it.
        let mut map = Bent(Linear::new(0.95, level, seed), said);
        let mut y = map.0.start.clone();
        let options =
            OrbitOptions { tolerance: 1e-2, accuracy, refinements: 0, max_cycles: 60, accelerate: true };
        let report = periodic_orbit(&mut map, &mut y, &options).unwrap();
        assert!(report.converged, "{seed} {report:?}");
        cycles.push(report.cycles);
        errors.push(map.0.error(&y) / report.error_estimate);
    }
    cycles.sort_unstable();
    errors.sort_by(f64::total_cmp);
    (cycles, errors)
}

#[test]
fn a_slow_mode_is_found_in_the_noise_of_its_cycles() {
    let (cycles, errors) = searches_of_a_slow_mode(3e-3, 0.05, 1.0);
    let (median, most) = (cycles[cycles.len() / 2], cycles[cycles.len() - 1]);
    // 14 and 26 when this was written, and no error beyond three quarters of its estimate.
    assert!(median <= 16 && most <= 30, "{median} cycles, {most} at most");
    assert!(errors[errors.len() - 1] <= 1.0, "{errors:?}");
}

/// Cycles in the steps of the one before have less noise than others: a search that is told so ends sooner.
#[test]
fn a_map_that_says_it_has_less_noise_is_believed() {
    let (told, errors) = searches_of_a_slow_mode(1e-2, 0.005, 0.1);
    let (usual, _) = searches_of_a_slow_mode(1e-2, 0.005, 1.0);
    let middle = told.len() / 2;
    // 12 and 15 when this was written.
    assert!(told[middle] + 2 <= usual[middle], "{told:?} {usual:?}");
    assert!(errors[errors.len() - 1] <= 1.0, "{errors:?}");
}

/// Secants among noise can make a multiplier as near to one as it happens, and no number of further cycles shows that it is none: with what they resolve left out of account some
/// of these searches did not end in 60 cycles.
#[test]
fn noise_is_not_taken_for_a_mode_that_hardly_decays() {
    let (cycles, errors) = searches_of_a_slow_mode(1e-2, 0.02, 0.3);
    // 30 when this was written, and no error beyond 0.83 of its estimate.
    assert!(cycles[cycles.len() - 1] <= 34, "{cycles:?}");
    assert!(errors[errors.len() - 1] <= 1.0, "{errors:?}");
}

/// `x -> r x (1 - x)` beside a contraction that follows it.
struct Logistic(f64, Option<Bend>);
impl CycleMap for Logistic {
    fn bend(&self) -> Option<Bend> {
        self.1
    }
    fn dim(&self) -> usize {
        2
    }
    fn map(&mut self, y0: &[f64], y1: &mut [f64], _: f64) -> Result<f64, EvalError> {
        y1[0] = self.0 * y0[0] * (1.0 - y0[0]);
        y1[1] = 0.2 * y0[1] + y0[0];
        Ok(1.0)
    }
    fn scale(&self, _: &[f64], s: &mut [f64]) {
        s.fill(1.0);
    }
    fn admit(&self, _: &[f64], y: &mut [f64]) {
        // Beyond 0 and 1 the map leaves for minus infinity, and 0 is an orbit of its own.
        y[0] = y[0].clamp(0.05, 0.95);
    }
}

#[test]
fn a_cycle_that_repeats_every_second_time_is_reported() {
    let bent = Some(Bend { noise: 0.1, ..BEND });
    for (accelerate, bend) in [(true, None), (true, bent), (false, None)] {
        for start in [0.3, 0.55, 0.68, 0.9] {
            let r: f64 = 3.2;
            let mut y = [start, 0.5];
            let report = periodic_orbit(&mut Logistic(r, bend), &mut y, &options(1e-6, accelerate)).unwrap();
            assert!(report.converged && report.period == 2, "{accelerate} {start}: {report:?}");
            // The two points of the period: (r + 1 ± sqrt((r - 3)(r + 1))) / 2r.
            let root = ((r - 3.0) * (r + 1.0)).sqrt();
            let error = [1.0, -1.0].map(|s| (y[0] - (r + 1.0 + s * root) / (2.0 * r)).abs());
            assert!(error[0].min(error[1]) <= 3.0 * report.error_estimate, "{error:?} {report:?}");
        }
        // Below r = 3 the fixed point 1 - 1/r is stable.
        for r in [1.5, 2.5, 2.9] {
            let mut y = [0.3, 0.5];
            let report = periodic_orbit(&mut Logistic(r, bend), &mut y, &options(1e-6, accelerate)).unwrap();
            assert!(report.converged && report.period == 1, "{accelerate} {r}: {report:?}");
            assert!(
                (y[0] - 1.0 + 1.0 / r).abs() <= 3.0 * report.error_estimate + 1e-14,
                "{accelerate} {r} {y:?} {report:?}"
            );
        }
    }
}

/// A contraction with a slow and some fast modes, strongly nonlinear at the start: the gas pressures of a ring pack after a cycle
/// depend on those before about so.
struct Nonlinear;
impl CycleMap for Nonlinear {
    fn dim(&self) -> usize {
        5
    }
    fn map(&mut self, y0: &[f64], y1: &mut [f64], accuracy: f64) -> Result<f64, EvalError> {
        for i in 0..5 {
            let next = y0[(i + 1) % 5];
            y1[i] = 1.0
                + [0.9, 0.5, 0.3, 0.1, 0.0][i] * (y0[i] - 1.0 + 0.3 * (y0[i] - 1.0).powi(2)).tanh()
                + 0.05 * (next - 1.0).sin();
            // A smooth error, as an integrator's is.
            y1[i] += 0.1 * accuracy * (3.0 * y0[i] + i as f64).sin();
        }
        Ok(1.0)
    }
    fn scale(&self, y: &[f64], s: &mut [f64]) {
        for (s, y) in s.iter_mut().zip(y) {
            *s = y.abs().max(0.5);
        }
    }
}

/// The same map a little displaced, as that of a coarser grid is, and what is known of its slope.
struct Displaced(f64, Vec<Change>);
impl CycleMap for Displaced {
    fn dim(&self) -> usize {
        5
    }
    fn map(&mut self, y0: &[f64], y1: &mut [f64], accuracy: f64) -> Result<f64, EvalError> {
        Nonlinear.map(y0, y1, accuracy)?;
        y1.iter_mut().enumerate().for_each(|(i, y)| *y += self.0 * (1.0 + i as f64));
        Ok(1.0)
    }
    fn scale(&self, y: &[f64], s: &mut [f64]) {
        Nonlinear.scale(y, s);
    }
    fn known(&self) -> &[Change] {
        &self.1
    }
}

#[test]
fn what_a_like_map_taught_shortens_a_search() {
    let search = |by: f64, y: &mut [f64; 5], known: Vec<Change>| {
        let report = periodic_orbit(&mut Displaced(by, known), y, &options(1e-6, true)).unwrap();
        assert!(report.converged, "{report:?}");
        report
    };
    let mut near = [3.0, 0.2, 2.0, -1.0, 0.5];
    let coarse = search(1e-3, &mut near, Vec::new());
    assert!(!coarse.changes.is_empty());
    let (mut with, mut without) = (near, near);
    let taught = search(0.0, &mut with, coarse.changes.clone());
    let alone = search(0.0, &mut without, Vec::new());
    assert!(taught.cycles < alone.cycles, "{} {}", taught.cycles, alone.cycles);
    // (1, .., 1) is on the orbit, and each estimate is true.
    for (y, report) in [(with, taught), (without, alone)] {
        let error = y.iter().map(|y| (y - 1.0).abs()).fold(0.0, f64::max);
        assert!(error <= 3.0 * report.error_estimate + 1.2e-6 / 30.0, "{error:e} {report:?}");
    }
    // What is of another number of states says nothing.
    let other = vec![Change { start: vec![1.0; 2], change: vec![0.5; 2], noise: 0.0 }];
    assert_eq!(
        search(0.0, &mut near.clone(), other).cycles,
        search(0.0, &mut near.clone(), Vec::new()).cycles
    );
}

#[test]
fn nonlinear_contractions() {
    // Ten cycles to the orbit, and 8 that confirm its stability.
    for (accelerate, most) in [(true, 18), (false, 200)] {
        for tolerance in [1e-3, 1e-4, 1e-6] {
            for start in [[3.0, 0.2, 2.0, -1.0, 0.5], [1.3, 1.2, 0.9, 1.1, 1.0], [8.0; 5]] {
                let mut y = start;
                let report = periodic_orbit(&mut Nonlinear, &mut y, &options(tolerance, accelerate)).unwrap();
                assert!(
                    report.converged && report.period == 1 && report.cycles <= most,
                    "{tolerance:e} {report:?}"
                );
                // (1, .., 1) is on the orbit of the exact map; the error of the map moves it by up to 0.1 accuracy / (1 - 0.91).
                let error = y.iter().map(|y| (y - 1.0).abs()).fold(0.0, f64::max);
                assert!(
                    error <= 3.0 * report.error_estimate + 1.2 * tolerance / 30.0,
                    "{error:e} {report:?}"
                );
            }
        }
    }
}

/// Refuses; and a map whose state runs away.
struct Bad(bool);
impl CycleMap for Bad {
    fn dim(&self) -> usize {
        1
    }
    fn map(&mut self, y0: &[f64], y1: &mut [f64], _: f64) -> Result<f64, EvalError> {
        y1[0] = 3.0 * y0[0] + 1.0;
        if self.0 { Err(EvalError::fatal("test", "no")) } else { Ok(2.0) }
    }
    fn scale(&self, y: &[f64], s: &mut [f64]) {
        s[0] = y[0].abs().max(1.0);
    }
}

#[test]
fn failures_are_reported() {
    for accelerate in [true, false] {
        assert!(periodic_orbit(&mut Bad(true), &mut [1.0], &options(1e-4, accelerate)).is_err());
        let short: &mut [f64] = &mut [];
        assert!(periodic_orbit(&mut Bad(false), short, &options(1e-4, accelerate)).is_err());
        // The only fixed point, -1/2, is unstable: nothing settles there.
        let mut y = [1.0];
        let report = periodic_orbit(&mut Bad(false), &mut y, &options(1e-4, accelerate)).unwrap();
        assert!(!report.converged && report.error_estimate > 0.1, "{accelerate} {report:?}");
        assert_eq!(report.cycle_equivalents, report.cycles as f64);
    }
}

/// A map that gives up after some cycles.
struct Vain {
    left: usize,
    bend: Option<Bend>,
}
impl CycleMap for Vain {
    fn dim(&self) -> usize {
        1
    }
    fn map(&mut self, y0: &[f64], y1: &mut [f64], _: f64) -> Result<f64, EvalError> {
        self.left -= 1;
        y1[0] = y0[0] + 1.0;
        Ok(1.0)
    }
    fn scale(&self, _: &[f64], s: &mut [f64]) {
        s[0] = 1.0;
    }
    fn gives_up(&self) -> bool {
        self.left == 0
    }
    fn bend(&self) -> Option<Bend> {
        self.bend
    }
}

#[test]
fn a_map_that_gives_up_is_asked_no_more() {
    for (accelerate, bend) in [(true, None), (true, Some(BEND)), (false, None)] {
        let mut map = Vain { left: 4, bend };
        let report = periodic_orbit(&mut map, &mut [0.0], &options(1e-4, accelerate)).unwrap();
        assert!(!report.converged && report.cycles == 4, "{accelerate} {bend:?} {report:?}");
    }
}

/// Approaches ln 20 the slower the farther above it, and has no meaning below 1: secants from above overshoot far.
struct Bounded {
    admits: bool,
    refused: usize,
}
impl CycleMap for Bounded {
    fn dim(&self) -> usize {
        1
    }
    fn map(&mut self, y0: &[f64], y1: &mut [f64], _: f64) -> Result<f64, EvalError> {
        if y0[0] < 1.0 {
            self.refused += 1;
            return Err(EvalError::recoverable("test", "below 1"));
        }
        y1[0] = y0[0] + 0.3 * ((-y0[0]).exp() - 0.05);
        Ok(1.0)
    }
    fn admit(&self, reached: &[f64], y: &mut [f64]) {
        if self.admits {
            y[0] = y[0].max(reached[0].min(1.0));
        }
    }
    fn scale(&self, y: &[f64], s: &mut [f64]) {
        s[0] = y[0].abs().max(1.0);
    }
}

/// A start that the machine does not admit is not tried where the map says so, and taken back where it does not know.
#[test]
fn extrapolation_beyond_the_machine_is_taken_back() {
    for admits in [true, false] {
        let mut map = Bounded { admits, refused: 0 };
        let mut y = [10.0];
        let report = periodic_orbit(&mut map, &mut y, &options(1e-8, true)).unwrap();
        assert_eq!(map.refused > 0, !admits, "{report:?}");
        // The tolerance times the scale, which is 3.
        assert!(report.converged && (y[0] - 20f64.ln()).abs() < 3e-8, "{y:?} {report:?}");
        assert!(report.cycles >= report.history.len() + map.refused, "{report:?}");
        // A start of the caller's own that is refused remains an error.
        assert!(periodic_orbit(&mut map, &mut [0.5], &options(1e-8, true)).is_err());
    }
}

/// Lifts that grow fivefold from where they rest, and have settled where they are larger: the secants near their rest lead to the fixed point below it, which repels and is not admitted.
struct Lifts;
impl CycleMap for Lifts {
    fn dim(&self) -> usize {
        N
    }
    fn map(&mut self, y0: &[f64], y1: &mut [f64], _: f64) -> Result<f64, EvalError> {
        for (y1, y0) in y1.iter_mut().zip(y0) {
            *y1 = if *y0 < 0.01 { 0.004 + 5.0 * y0 } else { 0.054 + 0.1 * (y0 - 0.01) };
        }
        Ok(1.0)
    }
    fn scale(&self, _: &[f64], s: &mut [f64]) {
        s.fill(1.0);
    }
    fn admit(&self, _: &[f64], y: &mut [f64]) {
        y.iter_mut().for_each(|y| *y = y.max(0.0));
    }
}

#[test]
fn a_search_that_is_led_back_to_its_last_start_goes_on_from_where_that_came_to() {
    let mut y = vec![0.0; N];
    let r = periodic_orbit(&mut Lifts, &mut y, &options(1e-6, true)).unwrap();
    let fixed = (0.054 - 0.001) / 0.9;
    assert!(r.converged && y.iter().all(|y| (y - fixed).abs() < 1e-6), "{r:?}");
    // 14 when this was written. A search that began its cycles at the same place again and again had not ended after 60.
    assert!(r.cycles <= 20, "{}", r.cycles);
}

/// A map whose noise is eight times what its accuracy says: plain repetition takes over when acceleration has had its cycles, and tells the band in which
/// the states stay, which is not the tolerance and holds the orbit.
#[test]
fn a_map_noisier_than_it_says_is_known_by_its_band() {
    for seed in 1..=20 {
        let mut map = Linear::new(0.5, 8.0, seed);
        let mut y = map.start.clone();
        let wanted = OrbitOptions {
            tolerance: 1e-5,
            accuracy: 1e-5,
            max_cycles: 120,
            refinements: 0,
            accelerate: true,
        };
        let r = periodic_orbit(&mut map, &mut y, &wanted).unwrap();
        let error = map.error(&y);
        assert!(!r.converged && r.period == 1 && r.cycles == 120, "{seed}: {r:?}");
        // Noise of 8e-5 a cycle and multipliers of a half and less: states within twice that of the orbit, in bands of at most twice as much again.
        assert!(error < 1.6e-4 && r.error_estimate < 3.2e-4, "{seed}: {error:e} {r:?}");
        assert!(error <= 3.0 * r.error_estimate, "{seed}: {error:e} {r:?}");
        // Where the map may be asked for less noise, acceleration sees that it stalls, and asks.
        let mut y = map.start.clone();
        let r = periodic_orbit(&mut map, &mut y, &OrbitOptions { refinements: 2, ..wanted }).unwrap();
        let error = map.error(&y);
        assert!(r.converged && error <= 3.0 * r.error_estimate, "{seed}: {error:e} {r:?}");
    }
}

/// A multiplier of 0.9 makes noise of the tolerance an error ten times as large: the search asks for a more accurate map where it may, and ends.
#[test]
fn noise_that_keeps_a_search_from_its_end_is_lessened() {
    for seed in 1..=20 {
        let ends = |refinements: usize| {
            let mut map = Linear::new(0.9, 1.0, seed);
            let mut y = map.start.clone();
            let wanted = OrbitOptions {
                tolerance: 1e-4,
                accuracy: 1e-4,
                max_cycles: 120,
                refinements,
                accelerate: true,
            };
            let r = periodic_orbit(&mut map, &mut y, &wanted).unwrap();
            (map.error(&y), r)
        };
        let (error, r) = ends(2);
        assert!(r.converged && error <= 3.0 * r.error_estimate, "{seed}: {error:e} {r:?}");
    }
}

/// The logistic map `y -> a y (1 - y)`, which costs less when it may be rough.
struct Costly(f64);

impl CycleMap for Costly {
    fn dim(&self) -> usize {
        1
    }
    fn map(&mut self, y0: &[f64], y1: &mut [f64], accuracy: f64) -> Result<f64, EvalError> {
        y1[0] = self.0 * y0[0] * (1.0 - y0[0]);
        // A rough first cycle costs half.
        Ok(if accuracy > 1e-6 { 1.0 } else { 2.0 })
    }
    fn scale(&self, _: &[f64], s: &mut [f64]) {
        s[0] = 1.0;
    }
}

#[test]
fn periods_and_multipliers_of_the_logistic_map() {
    // Stable cycles of one, two, four and three (May 1976), and the fixed point 1 - 1/a with the multiplier 2 - a. The search with
    // acceleration looks for cycles of one and two.
    for (a, period) in [(2.5, 1), (3.2, 2), (3.5, 4), (3.83, 3)] {
        for accelerate in [false, true].into_iter().filter(|accelerate| period <= 2 || !accelerate) {
            let options = OrbitOptions {
                tolerance: 1e-8,
                accuracy: 1e-12,
                max_cycles: 300,
                refinements: 0,
                accelerate,
            };
            let mut y = [0.3];
            let report = periodic_orbit(&mut Costly(a), &mut y, &options).unwrap();
            assert!(report.converged && report.period == period, "{a} {accelerate} {report:?}");
            let mut end = y;
            for _ in 0..period {
                Costly(a).map(&end.clone(), &mut end, 0.0).unwrap();
            }
            // On a cycle to the tolerance, and on none of a shorter period.
            assert!(
                (end[0] - y[0]).abs() < 1e-8 && report.error_estimate <= 1e-8,
                "{a} {accelerate} {y:?} {end:?}"
            );
            assert!(report.cycles <= 300 && report.history.len() <= report.cycles);
            if period == 1 {
                assert!((y[0] - 0.6).abs() < 1e-8, "{y:?}");
                // From secants of the approach, which bend: to a tenth.
                assert!((report.multiplier - 0.5).abs() < 0.1, "{report:?}");
                assert_eq!(report.residual, *report.history.last().unwrap());
            }
        }
    }
}

#[test]
fn costs_are_counted_in_last_cycles() {
    let mut options =
        OrbitOptions { tolerance: 1e-8, accuracy: 1e-12, max_cycles: 300, refinements: 0, accelerate: true };
    let report = periodic_orbit(&mut Costly(2.5), &mut [0.3], &options).unwrap();
    // The first cycle is rough and costs half of the others.
    assert_eq!(report.cycle_equivalents, report.cycles as f64 - 0.5);
    options.accelerate = false;
    let plain = periodic_orbit(&mut Costly(2.5), &mut [0.3], &options).unwrap();
    assert_eq!(plain.cycle_equivalents, plain.cycles as f64);
    assert!(report.cycles < plain.cycles);
    for accelerate in [false, true] {
        let few = OrbitOptions { max_cycles: 3, accelerate, ..options };
        let report = periodic_orbit(&mut Costly(2.5), &mut [0.3], &few).unwrap();
        assert!(!report.converged && report.cycles == 3 && report.history.len() == 3, "{report:?}");
    }
}

/// Tanks in a row that drain by the root of what they hold, `v_i' = v_i + q_(i-1) - b_i sqrt(v_i)`, `q_0 = a`: the fixed point is `v_i = (a / b_i)²`, its
/// multipliers `1 - b_i²/(2 a)`, and far from it they are nearer to one.
struct Tanks {
    a: f64,
    b: Vec<f64>,
    bend: Option<Bend>,
    noise: u64,
    cheap: usize,
}

impl Tanks {
    fn new(b: &[f64], seed: u64, bend: Option<Bend>) -> Self {
        Self { a: 1.0, b: b.to_vec(), bend, noise: seed, cheap: 0 }
    }

    fn error(&self, y: &[f64]) -> f64 {
        self.b.iter().zip(y).map(|(b, y)| (y - (self.a / b).powi(2)).abs()).fold(0.0, f64::max)
    }

    /// The search from half full tanks, and its error.
    fn search(&mut self) -> (OrbitReport, f64) {
        let mut y: Vec<f64> = self.b.iter().map(|b| 0.5 * (self.a / b).powi(2)).collect();
        let options = OrbitOptions {
            tolerance: 1e-3,
            accuracy: 1e-4,
            max_cycles: 200,
            refinements: 2,
            accelerate: true,
        };
        let r = periodic_orbit(self, &mut y, &options).unwrap();
        let error = self.error(&y);
        (r, error)
    }
}

impl CycleMap for Tanks {
    fn dim(&self) -> usize {
        self.b.len()
    }
    fn map(&mut self, y0: &[f64], y1: &mut [f64], accuracy: f64) -> Result<f64, EvalError> {
        self.cheap += usize::from(accuracy > 1e-3);
        let mut flow = self.a;
        for (i, b) in self.b.iter().enumerate() {
            let out = b * y0[i].max(0.0).sqrt();
            y1[i] = y0[i] + flow - out + 0.3 * accuracy * noise(&mut self.noise);
            flow = out;
        }
        Ok(1.0)
    }
    fn scale(&self, _: &[f64], s: &mut [f64]) {
        s.fill(1.0);
    }
    fn bend(&self) -> Option<Bend> {
        self.bend
    }
}

/// Tanks, and what is known of their slope from others that are like them; these may lead on, moved by what they did otherwise.
struct Taught {
    tanks: Tanks,
    known: Vec<Change>,
    like: Option<(Tanks, Vec<f64>)>,
    leads: usize,
}
impl CycleMap for Taught {
    fn dim(&self) -> usize {
        self.tanks.dim()
    }
    fn map(&mut self, y0: &[f64], y1: &mut [f64], accuracy: f64) -> Result<f64, EvalError> {
        self.tanks.map(y0, y1, accuracy)
    }
    fn scale(&self, y: &[f64], s: &mut [f64]) {
        self.tanks.scale(y, s);
    }
    fn bend(&self) -> Option<Bend> {
        self.tanks.bend
    }
    fn known(&self) -> &[Change] {
        &self.known
    }
    fn begins_near(&self) -> Option<f64> {
        self.like.is_some().then_some(f64::INFINITY)
    }
    fn lead(&mut self, y: &[f64], end: &[f64], _: f64) -> Result<Option<Led>, EvalError> {
        let Some((like, moved)) = &mut self.like else { return Ok(None) };
        self.leads += 1;
        moved.iter_mut().zip(y.iter().zip(end)).for_each(|(d, (y, end))| *d += end - y);
        // Each passes on what it is fed and what is added to it.
        let mut flow = like.a;
        let passed = moved.iter().map(|d| {
            flow += d;
            flow
        });
        let y = like.b.iter().zip(passed).map(|(b, out)| (out / b).powi(2)).collect();
        Ok(Some(Led { y, settled: true }))
    }
}

#[test]
fn a_like_map_shortens_a_search_in_stretches_by_what_it_taught_and_more_where_it_leads_on() {
    // Multipliers of 0.94, 0.875 and 0.82.
    let b = [0.35, 0.5, 0.6];
    let bend = Some(BEND);
    let options =
        OrbitOptions { tolerance: 5e-3, accuracy: 1e-4, max_cycles: 200, refinements: 0, accelerate: true };
    let (mut led, mut taught, mut alone, mut leads) = (0, 0, 0, 0);
    for seed in 1..=20 {
        // What is fed moves the orbit by 2e-2 to 5e-2, which changes a cycle by 3e-3; outlets that are 2 % wider move it on and change the slopes.
        let like = |wider: f64| {
            let b: Vec<f64> = b.iter().map(|b| b * wider).collect();
            Tanks { a: 1.003, ..Tanks::new(&b, seed, bend) }
        };
        let mut near: Vec<f64> = b.iter().map(|b| 0.5 / (b * b)).collect();
        let coarse = OrbitOptions { accuracy: 2e-4, tolerance: 1e-2, ..options };
        let report = periodic_orbit(&mut like(1.0), &mut near, &coarse).unwrap();
        assert!(report.converged && !report.changes.is_empty(), "{report:?}");
        let led_by = Some((like(1.02), vec![0.0; b.len()]));
        let mut far = near.clone();
        periodic_orbit(&mut like(1.02), &mut far, &coarse).unwrap();
        for (known, like, start, cycles) in [
            (report.changes.clone(), led_by, &far, &mut led),
            (report.changes, None, &near, &mut taught),
            (Vec::new(), None, &near, &mut alone),
        ] {
            let mut map = Taught { tanks: Tanks::new(&b, seed, bend), known, like, leads: 0 };
            let mut y = start.clone();
            let report = periodic_orbit(&mut map, &mut y, &options).unwrap();
            let error = map.tanks.error(&y);
            assert!(report.converged && error <= 1.5 * report.error_estimate, "{error:e} {report:?}");
            *cycles += report.cycles;
            leads += map.leads;
        }
    }
    // 3.4, 13 and 17 cycles when this was written: one that shows what the like map lacks, one or two that show how much is left, for it is led on once more where that is too much.
    assert!(3 * led < taught && (20..=40).contains(&leads), "{led} {taught} {leads}");
    assert!(5 * taught < 4 * alone, "{taught} {alone}");
}

/// Of a cycle that differs from the like map's by noise a slow mode makes a hundredfold of that. How far the start is moved says so, and no more than that; the noise of one cycle times
/// the slowest mode would hold of every search that it is not at its end.
#[test]
fn a_start_that_hardly_moves_ends_the_search_of_a_slow_map() {
    // Multipliers of 0.99, 0.875 and 0.82.
    let b = [0.14, 0.5, 0.6];
    let bend = Some(BEND);
    let options =
        OrbitOptions { tolerance: 8e-3, accuracy: 3e-4, max_cycles: 200, refinements: 0, accelerate: true };
    let slow = Change { start: vec![1.0, 0.0, 0.0], change: vec![-0.0098, 0.0098, 0.0], noise: 1e-4 };
    let mut cycles = 0;
    for seed in 1..=20 {
        let like = Tanks { a: 1.003, ..Tanks::new(&b, seed, bend) };
        let mut y: Vec<f64> = b.iter().map(|b| (like.a / b).powi(2)).collect();
        let mut map = Taught {
            tanks: Tanks::new(&b, seed, bend),
            known: vec![slow.clone()],
            like: Some((like, vec![0.0; b.len()])),
            leads: 0,
        };
        let report = periodic_orbit(&mut map, &mut y, &options).unwrap();
        let error = map.tanks.error(&y);
        // One cycle may move the start by chance less than the next would: 2.3 times at most when this was written.
        assert!(error <= options.tolerance.min(3.0 * report.error_estimate), "{error:e} {report:?}");
        cycles += report.cycles;
    }
    // 6.9 cycles each when this was written, four or fewer for 16 of 20; 16.5 where the way says nothing.
    assert!(cycles <= 20 * 10, "{cycles} cycles");
}

/// Few cycles of a search that begins near the orbit do not show what is slow: how much of it must be thought possible says the map.
#[test]
fn what_few_cycles_do_not_show_is_thought_to_be_slow() {
    // Multipliers of 0.82, 0.28 and 0.16.
    let b = [0.6, 1.2, 1.3];
    let options =
        OrbitOptions { tolerance: 5e-3, accuracy: 1e-3, max_cycles: 200, refinements: 0, accelerate: true };
    let search = |slow: f64| {
        let (mut missed, mut cycles) = (0, 0);
        for seed in 1..=60 {
            let mut map = Tanks::new(&b, seed, Some(Bend { settles: (2, 1), slow, ..BEND }));
            let mut start = 7 * seed;
            let mut y: Vec<f64> = b.iter().map(|b| (1.0 / b).powi(2) + 0.02 * noise(&mut start)).collect();
            let report = periodic_orbit(&mut map, &mut y, &options).unwrap();
            missed += usize::from(map.error(&y) > options.tolerance);
            cycles += report.cycles;
        }
        (missed, cycles)
    };
    let ((unseen, cycles), (missed, all)) = (search(1.0), search(3.0));
    // Of 60 searches 7 and none end farther away than asked, after 338 and 401 cycles, when this was written; by chance other noise could make 7 a 3.
    assert!(unseen >= 3 && missed == 0, "{unseen} {missed}");
    assert!(4 * all < 5 * cycles, "{all} {cycles}");
}

/// A store that fills at a constant rate to a corner and then ever slower (multiplier 0.9966), blurred by what beside it goes to and fro at a corner: oil before the edge of a ring.
struct Creep(u64);
impl Creep {
    const END: f64 = 3.3;
    fn rate(y: f64) -> f64 {
        0.0085 * (0.4 * (Self::END - y)).min(1.0)
    }
}
impl CycleMap for Creep {
    fn bend(&self) -> Option<Bend> {
        Some(Bend { noise: 0.1, ..BEND })
    }
    fn dim(&self) -> usize {
        3
    }
    fn map(&mut self, y0: &[f64], y1: &mut [f64], accuracy: f64) -> Result<f64, EvalError> {
        let blur = 1.0 + 0.15 * noise(&mut self.0);
        y1[0] = y0[0] + Self::rate(y0[0]) * blur;
        y1[1] = 0.5 * (0.3 - y0[2]).abs() + 0.1 * y1[0] + 0.1 * accuracy * noise(&mut self.0);
        y1[2] = 0.6 * y0[1] - 0.2 * y0[2];
        Ok(1.0)
    }
    fn scale(&self, y: &[f64], s: &mut [f64]) {
        for (s, y) in s.iter_mut().zip(y) {
            *s = y.abs().max(1.0);
        }
    }
}

#[test]
fn a_store_that_creeps_is_filled_where_its_rate_ends() {
    let mut repeated = vec![0.2, 0.0, 0.0];
    let (mut map, mut g, mut plain) = (Creep(1), repeated.clone(), 0);
    while (repeated[0] - Creep::END).abs() > 1e-2 * Creep::END {
        map.map(&repeated, &mut g, 1e-4).unwrap();
        repeated.copy_from_slice(&g);
        plain += 1;
    }
    let (mut all, mut errors, mut open) = (0, Vec::new(), 0);
    for seed in 1..=20 {
        let mut y = [0.2, 0.0, 0.0];
        let wanted = OrbitOptions { accuracy: 1e-4, refinements: 2, ..options(1e-3, true) };
        let r =
            periodic_orbit(&mut Creep(seed), &mut y, &OrbitOptions { max_cycles: 120, ..wanted }).unwrap();
        let error = (y[0] - Creep::END).abs() / Creep::END;
        // A cycle accurate to 1e-4 hides a drift of as much, which has 1 / (1 - 0.9966) times as far to go.
        assert!(error <= 3.0 * r.error_estimate + 3e-2, "{seed}: {error:e} {r:?}");
        all += r.cycles;
        open += u32::from(!r.converged);
        errors.push(error);
    }
    // One search in fifty sees that it cannot tell the end in that noise.
    assert!(open <= 1, "{open} searches without an end");
    errors.sort_by(f64::total_cmp);
    assert!(errors[10] <= 1e-3, "the median error is beyond the tolerance: {errors:?}");
    assert!(5 * all < 20 * plain, "{} cycles, {plain} by repetition to a hundredth", all / 20);
}

#[test]
fn a_bent_map_is_followed_by_fresh_secants_and_cheap_cycles() {
    let bent = Some(Bend { noise: 0.3, ..BEND });
    // Multipliers of 0.9, 0.8, 0.6 and 0.28.
    let b = [0.45, 0.63, 0.9, 1.2];
    let (mut all, mut plain) = (0, 0);
    for seed in 1..=20 {
        let mut map = Tanks::new(&b, seed, bent);
        let (r, error) = map.search();
        assert!(r.converged && error <= 3.0 * r.error_estimate, "{seed}: {error:e} {r:?}");
        assert!(map.cheap > 0, "{seed}: no cycle was cheap");
        all += r.cycles;
        let mut y: Vec<f64> = b.iter().map(|b| 0.5 / (b * b)).collect();
        let mut g = y.clone();
        while map.error(&y) > 1e-3 {
            map.map(&y, &mut g, 1e-5).unwrap();
            y.copy_from_slice(&g);
            plain += 1;
        }
    }
    // Three or four cycles for a step: 31 cycles, where repetition takes 73. Estimates, not the errors, take the last five, and one that sees once more what passed.
    assert!(9 * all < 4 * plain, "{} cycles, {} by repetition", all / 20, plain / 20);
}

/// Stores that hardly see each other and fill one after the other: each takes a fixed part of what comes and passes on the rest, until it is full; what a
/// full one does not take fills the next. The last leaks.
struct Stores {
    room: Vec<f64>,
    leak: f64,
}

impl Stores {
    const INFLOW: f64 = 0.5;

    fn end(&self, y0: &[f64], y1: &mut [f64]) {
        let mut flow = Self::INFLOW;
        let last = self.room.len() - 1;
        for (i, room) in self.room.iter().enumerate() {
            let lost = if i == last { self.leak * y0[i] } else { 0.0 };
            let taken = (0.8 * flow).min((room - y0[i]).max(0.0));
            y1[i] = y0[i] + taken - lost;
            flow -= taken;
        }
    }
}

impl CycleMap for Stores {
    fn dim(&self) -> usize {
        self.room.len()
    }
    fn map(&mut self, y0: &[f64], y1: &mut [f64], _: f64) -> Result<f64, EvalError> {
        self.end(y0, y1);
        Ok(1.0)
    }
    fn scale(&self, y: &[f64], s: &mut [f64]) {
        for (s, y) in s.iter_mut().zip(y) {
            *s = y.abs().max(1.0);
        }
    }
    fn admit(&self, _: &[f64], y: &mut [f64]) {
        for (y, room) in y.iter_mut().zip(&self.room) {
            *y = y.clamp(0.0, *room);
        }
    }
    fn bend(&self) -> Option<Bend> {
        Some(Bend { noise: 0.1, ..BEND })
    }
}

#[test]
fn stores_that_fill_one_after_the_other_are_filled_in_few_cycles() {
    let mut map = Stores { room: vec![100.0, 30.0, 1e9], leak: 0.02 };
    let mut y = vec![0.1; 3];
    let options =
        OrbitOptions { tolerance: 1e-3, accuracy: 1e-4, max_cycles: 200, refinements: 0, accelerate: true };
    let r = periodic_orbit(&mut map, &mut y, &options).unwrap();
    // Both are full, and of what comes the last takes four fifths.
    let exact = [100.0, 30.0, 0.8 * Stores::INFLOW / 0.02];
    let error = exact.iter().zip(&y).map(|(e, y)| (e - y).abs() / e).fold(0.0, f64::max);
    // The last residual can be nothing at all: then roundings of these sums of some hundred terms are left.
    assert!(r.converged && error <= 3.0 * r.error_estimate + 1e-13, "{error:e} {r:?}");
    // By repetition the first alone takes 250 cycles to fill.
    assert!(r.cycles <= 60, "{r:?}");
}

/// A slow mode, near enough to one that the machine itself is asked whether it stays; `refused` counts the starts farther than `room` from the fixed point
/// that could not be integrated.
struct Narrow {
    room: f64,
    refused: usize,
}

impl CycleMap for Narrow {
    fn dim(&self) -> usize {
        1
    }
    fn map(&mut self, y0: &[f64], y1: &mut [f64], _: f64) -> Result<f64, EvalError> {
        if (y0[0] - 1.0).abs() > self.room {
            self.refused += 1;
            return Err(EvalError::recoverable("narrow", "too far"));
        }
        y1[0] = 1.0 + 0.98 * (y0[0] - 1.0);
        Ok(1.0)
    }
    fn scale(&self, _: &[f64], s: &mut [f64]) {
        s.fill(1.0);
    }
}

#[test]
fn a_probe_of_stability_starts_nearer_where_it_must() {
    // The probe starts 0.03 away, then a quarter of that.
    for (room, refused) in [(0.04, 0), (0.01, 1)] {
        let mut map = Narrow { room, refused: 0 };
        let mut y = [1.0 + 0.9 * room];
        let r = periodic_orbit(&mut map, &mut y, &options(1e-5, true)).unwrap();
        assert!(r.converged && (y[0] - 1.0).abs() <= 3.0 * r.error_estimate, "{room}: {y:?} {r:?}");
        assert_eq!(map.refused, refused, "{room}: {r:?}");
        // The search takes a few cycles, the probe eight.
        assert!(r.cycles >= 8, "{room}: {r:?}");
    }
}

/// Cells whose content a store gathers in one cycle, and which fades there slowly.
struct Gathered {
    cells: usize,
    kept: f64,
}

impl CycleMap for Gathered {
    fn dim(&self) -> usize {
        self.cells + 1
    }
    fn map(&mut self, y0: &[f64], y1: &mut [f64], _: f64) -> Result<f64, EvalError> {
        let (store, cells) = y0.split_last().expect("states");
        y1[..self.cells].fill(0.0);
        y1[self.cells] = 1.0 + self.kept * (store - 1.0) + cells.iter().sum::<f64>();
        Ok(1.0)
    }
    fn scale(&self, _: &[f64], s: &mut [f64]) {
        s.fill(1.0);
    }
}

#[test]
fn what_many_states_gather_in_one_is_not_taken_for_growth() {
    // Displaced by 0.03 and -0.021 in turn, 100 cells send 0.45 to the store: 15 times as far as any of them was.
    let mut map = Gathered { cells: 100, kept: 0.98 };
    let mut y = vec![0.0; 101];
    let options =
        OrbitOptions { tolerance: 1e-3, accuracy: 1e-4, max_cycles: 100, refinements: 0, accelerate: true };
    let r = periodic_orbit(&mut map, &mut y, &options).unwrap();
    let error = (y[100] - 1.0).abs();
    assert!(r.converged && r.period == 1 && error <= 3.0 * r.error_estimate.max(1e-13), "{error:e} {r:?}");
    // Three to find the slope, eight to see that it stays; by repetition 340.
    assert!(r.cycles <= 20, "{r:?}");
}

/// A store that changes in a cycle by what it holds, and holds `least` at least; a second one follows it.
struct Store {
    calls: u64,
    change: fn(f64, u64) -> f64,
    least: f64,
}

impl CycleMap for Store {
    fn dim(&self) -> usize {
        2
    }
    fn map(&mut self, y0: &[f64], y1: &mut [f64], _: f64) -> Result<f64, EvalError> {
        self.calls += 1;
        y1[0] = y0[0] + (self.change)(y0[0], self.calls);
        y1[1] = 0.5 * y0[1] + 0.5 * y0[0];
        Ok(1.0)
    }
    fn scale(&self, _: &[f64], s: &mut [f64]) {
        s.fill(1.0);
    }
    fn admit(&self, _: &[f64], y: &mut [f64]) {
        for y in y {
            *y = y.max(self.least);
        }
    }
    fn bend(&self) -> Option<Bend> {
        Some(Bend { noise: 0.1, ..BEND })
    }
}

/// At a constant rate until it is nearly empty, in noise that is as large as a fifth of that rate.
fn draining(y: f64, calls: u64) -> f64 {
    // Fractional parts of multiples of the golden ratio: spread evenly over -1 to 1.
    let noise = 2.0 * (calls as f64 * 0.618_033_988_749_895).fract() - 1.0;
    let taken = (0.3 * y).min(1e-2);
    2e-3 * noise * (taken / 1e-2) - taken
}

/// Down at a constant rate to half of what it holds, and from little up by a fifth a cycle: oil before the edge of a ring that feeds itself.
fn feeding(y: f64, _: u64) -> f64 {
    (0.2 * y * (1.0 - y / 0.1)).max(-0.012)
}

#[test]
fn a_store_that_drains_in_noise_is_not_filled_again() {
    let mut map = Store { calls: 0, change: draining, least: 0.0 };
    let mut y = vec![1.0; 2];
    let options =
        OrbitOptions { tolerance: 1e-3, accuracy: 1e-4, max_cycles: 200, refinements: 0, accelerate: true };
    let r = periodic_orbit(&mut map, &mut y, &options).unwrap();
    let error = y[0].abs().max(y[1].abs());
    assert!(r.converged && error <= 3.0 * r.error_estimate.max(1e-13), "{error:e} {y:?} {r:?}");
    // It takes 97 cycles to drain by repetition, and 20 more to die away.
    assert!(r.cycles <= 117, "{} {:?}", r.cycles, r.history);
}

#[test]
fn a_store_is_not_emptied_by_a_step_because_it_drained() {
    let mut y = vec![0.3; 2];
    let options =
        OrbitOptions { tolerance: 1e-3, accuracy: 1e-4, max_cycles: 200, refinements: 0, accelerate: true };
    let r = periodic_orbit(&mut Store { calls: 0, change: feeding, least: 1e-4 }, &mut y, &options).unwrap();
    let error = y.iter().map(|y| (y - 0.1).abs()).fold(0.0, f64::max);
    assert!(r.converged && error <= 3.0 * r.error_estimate.max(1e-13), "{error:e} {y:?} {r:?}");
    // 23 when this was written, 33 where one step may empty it.
    assert!(r.cycles <= 26, "{} {:?}", r.cycles, r.history);
}

/// Two states on a slow way: where the first is near zero two orbits have just vanished and a cycle changes next to nothing, past it an orbit attracts at 2; the second follows by a
/// fiftieth a cycle. Every cycle errs by its accuracy.
struct Bottleneck(u64);

impl Bottleneck {
    fn end(y: &[f64]) -> [f64; 2] {
        let x = y[0];
        [
            x - 0.05 * (x - 2.0) * (x * x + 0.02) / (1.0 + x * x),
            y[1] - 0.02 * (y[1] - x.sin()) + 0.01 * (2.0 - x),
        ]
    }
}

impl CycleMap for Bottleneck {
    fn dim(&self) -> usize {
        2
    }
    fn map(&mut self, y0: &[f64], y1: &mut [f64], accuracy: f64) -> Result<f64, EvalError> {
        let end = Self::end(y0);
        y1.iter_mut().zip(end).for_each(|(y, e)| *y = e + accuracy * noise(&mut self.0));
        Ok(1.0)
    }
    fn scale(&self, _: &[f64], s: &mut [f64]) {
        s.fill(1.0);
    }
}

/// A map of few states is searched by Newton's method where secants do not get on. Without it none of these 40 searches ends, and 37 are off by more than three times
/// the tolerance.
#[test]
fn few_states_that_creep_past_a_bottleneck_are_searched_by_their_slope() {
    let wanted =
        OrbitOptions { tolerance: 1e-4, accuracy: 1e-5, max_cycles: 60, refinements: 2, accelerate: true };
    let orbit = [2.0, 2f64.sin()];
    let mut cycles = Vec::new();
    for seed in 1..=40_u64 {
        let mut y = [-2.0 + 0.05 * seed as f64, 0.7];
        let report = periodic_orbit(&mut Bottleneck(seed), &mut y, &wanted).unwrap();
        let error = y.iter().zip(orbit).map(|(y, o)| (y - o).abs()).fold(0.0, f64::max);
        // The noise of a cycle, 1e-5 at least asked for once less, times the fifty that the slow state gathers is estimated, not known: three times the tolerance.
        assert!(report.converged && error < 3.0 * wanted.tolerance, "{seed}: {error:.1e} {report:?}");
        cycles.push(report.cycles);
    }
    cycles.sort_unstable();
    // Twelve of them are those of the secants before. 48 when this was written.
    assert!(cycles[20] < 52, "{cycles:?}");
}
