//! Rosenbrock method Rodas5P: order 5, eight stages, L-stable, stiffly accurate, dense output of order 4
//! (steinebach2023; form of hairer1996, section IV.7).
//!
//! Per step one Jacobian `J`, one factorisation of `I/(hγ) - J`, eight solves:
//!
//! ```text
//! (I/(hγ) - J) U_i = f(t + c_i h, y + Σ_{j<i} a_ij U_j) + Σ_{j<i} C_ij/h U_j + h d_i f_t
//! y' = y + Σ a_8j U_j + U_8,    error estimate U_8
//! ```
//!
//! No Newton iteration can fail, and a kink in `f` costs a rejected step instead. Quadratures are rows of the same system
//! without columns: their stages follow by substitution, and linear invariants over all rows hold to round-off for any `J`
//! that satisfies them too, which a difference Jacobian of the same `f` does up to the rounding of its quotients.

use gudgeon_core::EvalError;

use crate::linalg::{lu_factor, lu_solve};
use crate::ode::{ColumnGroups, Flow, IntegrateError, Integrator, OdeSystem, Options, Stats, StepView, difference};

const STAGES: usize = 8;
const GAMMA: f64 = 0.211_937_563_194_290_14;
const C_NODES: [f64; STAGES] =
    [0.0, 0.635_812_689_582_870_4, 0.409_579_839_339_753_5, 0.976_930_672_506_071_6, 0.428_840_360_955_866_4, 1.0, 1.0, 1.0];
const D: [f64; STAGES] = [
    GAMMA,
    -0.423_875_126_388_580_27,
    -0.338_462_712_623_592_4,
    1.804_645_287_288_273_4,
    2.325_825_639_765_069,
    0.0,
    0.0,
    0.0,
];
const A6: [f64; 5] =
    [-7.502_846_399_306_121, 2.561_846_144_803_919, -11.627_539_656_261_098, -0.182_687_676_599_422_56, 0.030_198_172_008_377_946];
const A: [&[f64]; STAGES] = [
    &[],
    &[3.0],
    &[2.849_394_379_747_939, 0.458_422_422_044_639_23],
    &[-6.954_028_509_809_101, 2.489_845_061_869_568, -10.358_996_098_473_584],
    &[2.802_998_627_562_896_4, 0.507_246_473_622_820_6, -0.398_831_254_177_052_4, -0.047_211_872_304_046_41],
    &A6,
    &[A6[0], A6[1], A6[2], A6[3], A6[4], 1.0],
    &[A6[0], A6[1], A6[2], A6[3], A6[4], 1.0, 1.0],
];
const C: [&[f64]; STAGES] = [
    &[],
    &[-14.155_112_264_123_755],
    &[-17.972_960_358_859_52, -2.859_693_295_451_294],
    &[147.121_502_757_117_16, -1.412_214_027_182_13, 71.689_402_513_023_58],
    &[165.435_170_248_716_76, -0.459_282_345_649_112_6, 42.909_383_369_586_03, -5.961_986_721_573_306],
    &[24.854_864_614_690_072, -3.000_922_700_283_218_6, 47.493_111_002_076_8, 5.581_419_782_155_812_5, -0.661_069_182_524_947_1],
    &[
        30.912_732_140_285_99,
        -3.120_824_334_993_797_4,
        77.799_546_460_708_92,
        34.286_460_282_947_83,
        -19.097_331_116_725_623,
        -28.087_943_162_872_662,
    ],
    &[
        37.802_771_233_905_63,
        -3.257_196_902_907_227_6,
        112.269_188_494_963_27,
        66.934_723_124_404_7,
        -40.066_189_370_910_02,
        -54.667_802_628_779_68,
        -9.488_616_523_096_27,
    ],
];
const H: [[f64; STAGES]; 3] = [
    [
        25.948_786_856_663_858,
        -2.557_972_484_584_623_5,
        10.433_815_404_888_879,
        -2.367_925_102_268_520_4,
        0.524_948_541_321_073,
        1.124_108_831_045_040_4,
        0.427_287_619_443_187_4,
        -0.172_022_210_701_554_93,
    ],
    [
        -9.915_688_506_951_71,
        -0.968_994_459_411_515_4,
        3.043_803_724_297_845_3,
        -24.495_224_566_215_796,
        20.176_138_334_709_044,
        15.980_663_614_246_51,
        -6.789_040_303_419_874,
        -6.710_236_069_923_372,
    ],
    [
        11.419_903_575_922_262,
        2.887_964_514_613_699_4,
        72.921_379_959_960_29,
        80.125_118_346_226_43,
        -52.072_871_366_152_654,
        -59.789_936_252_667_29,
        -0.155_826_842_827_519_13,
        4.883_087_185_713_722,
    ],
];

/// The integrator with its work arrays. Allocates only when made.
#[derive(Debug)]
pub struct Rodas {
    n: usize,
    rows: usize,
    groups: Option<ColumnGroups>,
    jac: Vec<f64>,
    lu: Vec<f64>,
    pivot: Vec<usize>,
    /// Stages, `rows` values each.
    u: Vec<f64>,
    f0: Vec<f64>,
    f: Vec<f64>,
    ft: Vec<f64>,
    stage: Vec<f64>,
    moved: Vec<f64>,
    y0: Vec<f64>,
    y1: Vec<f64>,
    dense: Vec<f64>,
}

impl Rodas {
    /// For `dim` states and `quad_dim` quadratures.
    #[must_use]
    pub fn new(dim: usize, quad_dim: usize, groups: Option<ColumnGroups>) -> Self {
        let rows = dim + quad_dim;
        Self {
            n: dim,
            rows,
            groups,
            jac: vec![0.0; rows * dim],
            lu: vec![0.0; dim * dim],
            pivot: vec![0; dim],
            u: vec![0.0; STAGES * rows],
            f0: vec![0.0; rows],
            f: vec![0.0; rows],
            ft: vec![0.0; rows],
            stage: vec![0.0; dim],
            moved: vec![0.0; dim],
            y0: vec![0.0; dim],
            y1: vec![0.0; dim],
            dense: vec![0.0; 3 * dim],
        }
    }

    /// Fills `f0`, the Jacobian and `f_t` at `(t, y)`.
    fn linearise<S: OdeSystem + ?Sized>(
        &mut self,
        sys: &mut S,
        t: f64,
        ahead: f64,
        y: &[f64],
        options: &Options,
        stats: &mut Stats,
    ) -> Result<(), EvalError> {
        sys.rhs(t, y, &mut self.f0)?;
        stats.rhs += 1;
        stats.jacobians += 1;
        if !sys.jacobian(t, y, &self.f0, &mut self.jac)? {
            difference(sys, self.groups.as_ref(), t, y, &self.f0, options, &mut self.jac, &mut self.f, &mut self.moved, stats)?;
        }
        // Forward, into the coming step, so that a kink behind `t` is never seen.
        let dt = ((t.abs().max(ahead)) * 1e-8).min(1e-3 * ahead);
        let dt = (t + dt) - t;
        if dt > 0.0 {
            sys.rhs(t + dt, y, &mut self.f)?;
            stats.rhs += 1;
            for ((ft, f), f0) in self.ft.iter_mut().zip(&self.f).zip(&self.f0) {
                *ft = (f - f0) / dt;
            }
        } else {
            self.ft.fill(0.0);
        }
        Ok(())
    }

    /// Factors and computes all stages for step `h`; leaves the new state in `y1`, quadrature increments in the last rows of
    /// `dense`-free storage `u`. Returns the error norm.
    fn step<S: OdeSystem + ?Sized>(
        &mut self,
        sys: &mut S,
        t: f64,
        h: f64,
        y: &[f64],
        options: &Options,
        stats: &mut Stats,
    ) -> Result<f64, EvalError> {
        let (n, rows) = (self.n, self.rows);
        let diagonal = 1.0 / (h * GAMMA);
        for (l, j) in self.lu.iter_mut().zip(&self.jac) {
            *l = -j;
        }
        for i in 0..n {
            self.lu[i * n + i] += diagonal;
        }
        stats.lu += 1;
        if lu_factor(&mut self.lu, n, &mut self.pivot).is_err() {
            return Err(EvalError::recoverable("rodas", "singular iteration matrix"));
        }
        let inv_h = 1.0 / h;
        for i in 0..STAGES {
            if i > 0 {
                self.stage.copy_from_slice(y);
                for (j, a) in A[i].iter().enumerate() {
                    let uj = &self.u[j * rows..j * rows + n];
                    for (s, u) in self.stage.iter_mut().zip(uj) {
                        *s += a * u;
                    }
                }
                sys.rhs(t + C_NODES[i] * h, &self.stage, &mut self.f)?;
                stats.rhs += 1;
            } else {
                self.f.copy_from_slice(&self.f0);
            }
            let hd = h * D[i];
            if hd != 0.0 {
                for (f, ft) in self.f.iter_mut().zip(&self.ft) {
                    *f += hd * ft;
                }
            }
            let (done, rest) = self.u.split_at_mut(i * rows);
            for (j, c) in C[i].iter().enumerate() {
                let c = c * inv_h;
                for (f, u) in self.f.iter_mut().zip(&done[j * rows..(j + 1) * rows]) {
                    *f += c * u;
                }
            }
            let ui = &mut rest[..rows];
            ui[..n].copy_from_slice(&self.f[..n]);
            lu_solve(&self.lu, n, &self.pivot, &mut ui[..n]);
            stats.solves += 1;
            let (us, uq) = ui.split_at_mut(n);
            for (k, uq) in uq.iter_mut().enumerate() {
                let row = &self.jac[(n + k) * n..(n + k + 1) * n];
                let coupled: f64 = row.iter().zip(us.iter()).map(|(j, u)| j * u).sum();
                *uq = (self.f[n + k] + coupled) / diagonal;
            }
        }
        // The last stage value is already y + Σ a_8j U_j.
        let last = &self.u[(STAGES - 1) * rows..(STAGES - 1) * rows + n];
        let mut worst: f64 = 0.0;
        for k in 0..n {
            let new = self.stage[k] + last[k];
            self.y1[k] = new;
            let scale = options.atol[k] + options.rtol * y[k].abs().max(new.abs());
            let e = (last[k] / scale).abs();
            // A NaN must not compare as small.
            worst = if e.is_nan() { f64::INFINITY } else { worst.max(e) };
        }
        Ok(worst)
    }

    fn prepare_dense(&mut self) {
        let (n, rows) = (self.n, self.rows);
        for (l, h) in H.iter().enumerate() {
            let out = &mut self.dense[l * n..(l + 1) * n];
            out.fill(0.0);
            for (j, h) in h.iter().enumerate() {
                for (o, u) in out.iter_mut().zip(&self.u[j * rows..j * rows + n]) {
                    *o += h * u;
                }
            }
        }
    }
}

struct View<'a> {
    t0: f64,
    t1: f64,
    y0: &'a [f64],
    y1: &'a [f64],
    dense: &'a [f64],
}

impl StepView for View<'_> {
    fn t0(&self) -> f64 {
        self.t0
    }
    fn t1(&self) -> f64 {
        self.t1
    }
    fn y0(&self) -> &[f64] {
        self.y0
    }
    fn y1(&self) -> &[f64] {
        self.y1
    }
    fn interpolate(&self, t: f64, y: &mut [f64]) {
        let n = self.y0.len();
        let x = (t - self.t0) / (self.t1 - self.t0);
        let r = 1.0 - x;
        for k in 0..n {
            let (d1, d2, d3) = (self.dense[k], self.dense[n + k], self.dense[2 * n + k]);
            y[k] = r * self.y0[k] + x * (self.y1[k] + r * (d1 + x * (d2 + x * d3)));
        }
    }
}

impl<S: OdeSystem + ?Sized> Integrator<S> for Rodas {
    fn integrate(
        &mut self,
        sys: &mut S,
        interval: (f64, f64),
        breakpoints: &[f64],
        y: &mut [f64],
        q: &mut [f64],
        options: &Options,
        stats: &mut Stats,
        observer: &mut dyn FnMut(&mut S, &dyn StepView) -> Flow,
    ) -> Result<f64, IntegrateError> {
        let (mut t, end) = interval;
        let mut next_break = breakpoints.partition_point(|b| *b <= t + 1e-12 * (end - t).abs());
        let whole = end - t;
        let mut h = if options.h_init > 0.0 { options.h_init } else { 1e-4 * whole };
        h = h.min(options.h_max);
        let mut fresh = false;
        let mut trial = 0;
        let mut refusal: Option<EvalError> = None;
        let mut rejected_before = false;
        // Gustafsson's predictor needs the step and the error before.
        let mut previous: Option<(f64, f64)> = None;
        let fail = |t: f64, source: EvalError| IntegrateError::Eval { t, source };
        while t < end {
            let stop = breakpoints.get(next_break).copied().filter(|b| *b < end).unwrap_or(end);
            let left = stop - t;
            // Land on the stop exactly, and never leave a sliver before it.
            let step = if h >= left { left } else if 2.0 * h > left { 0.5 * left } else { h };
            let cut = step < h;
            if !fresh {
                match self.linearise(sys, t, step, y, options, stats) {
                    Ok(()) => fresh = true,
                    // The state itself is accepted: nothing smaller can help, unless only the difference failed.
                    Err(e) => return Err(fail(t, e)),
                }
            }
            trial += 1;
            if trial > options.max_steps {
                return Err(IntegrateError::TooManySteps { t, max: options.max_steps });
            }
            let outcome = self.step(sys, t, step, y, options, stats);
            let error = match outcome {
                Ok(e) => e,
                Err(e) if e.is_recoverable() => {
                    refusal = Some(e);
                    f64::INFINITY
                }
                Err(e) => return Err(fail(t, e)),
            };
            if error <= 1.0 {
                let t1 = if step == left { stop } else { t + step };
                self.prepare_dense();
                self.y0.copy_from_slice(y);
                y.copy_from_slice(&self.y1);
                for (k, q) in q.iter_mut().enumerate() {
                    // y1 = y0 + Σ a_8j U_j + U_8, the same sum for quadratures.
                    let at = |j: usize| self.u[j * self.rows + self.n + k];
                    *q += A[STAGES - 1].iter().enumerate().map(|(j, a)| a * at(j)).sum::<f64>() + at(STAGES - 1);
                }
                stats.steps += 1;
                refusal = None;
                let view = View { t0: t, t1, y0: &self.y0, y1: &self.y1, dense: &self.dense };
                let flow = observer(sys, &view);
                let safe = error.max(1e-10);
                let mut factor = 0.9 * safe.powf(-0.2);
                if let Some((h_old, e_old)) = previous {
                    factor = factor.min(0.9 * (step / h_old) * (e_old / (safe * safe)).powf(0.2));
                }
                factor = factor.clamp(0.2, 6.0);
                if rejected_before {
                    factor = factor.min(1.0);
                }
                rejected_before = false;
                previous = Some((step, safe.max(1e-2)));
                // A step cut short by a stop says little about the next one.
                h = if cut { h.max(step * factor) } else { step * factor }.min(options.h_max);
                t = t1;
                fresh = false;
                if t >= stop && stop < end {
                    next_break += 1;
                    previous = None;
                }
                if flow == Flow::Stop {
                    return Ok(h);
                }
            } else {
                stats.rejected += 1;
                rejected_before = true;
                let factor = if error.is_finite() { (0.9 * error.powf(-0.2)).clamp(0.1, 0.9) } else { 0.25 };
                h = step * factor;
                if h <= options.h_min.max(4.0 * f64::EPSILON * t.abs().max(whole * 1e-6)) {
                    return Err(IntegrateError::StepTooSmall { t, h, last: refusal });
                }
            }
        }
        Ok(h)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// y' = -y² sin-forced and coupled: smooth, nonlinear, non-autonomous, with a known solution.
    struct Smooth;
    impl OdeSystem for Smooth {
        fn dim(&self) -> usize {
            2
        }
        fn quad_dim(&self) -> usize {
            1
        }
        fn rhs(&mut self, t: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
            // Solution y0 = e^{sin t}, y1 = cos t + 2.
            f[0] = (y[1] - 2.0) * y[0];
            f[1] = -t.sin() + (y[0] - t.sin().exp());
            f[2] = y[0];
            Ok(())
        }
    }

    fn solve(h: f64, t: f64, dense: Option<f64>) -> [f64; 2] {
        // A huge tolerance and a fixed largest step: constant steps.
        let mut o = Options::new(1e3, &[1.0, 1.0]);
        (o.h_max, o.h_init) = (h, h);
        let (mut y, mut q) = ([1.0, 3.0], [0.0]);
        let mut r = Rodas::new(2, 1, None);
        let mut worst: f64 = 0.0;
        let mut out = [0.0; 2];
        let result = r.integrate(&mut Smooth, (0.0, t), &[], &mut y, &mut q, &o, &mut Stats::default(), &mut |_, v| {
            if let Some(x) = dense {
                let t = v.t0() + x * (v.t1() - v.t0());
                v.interpolate(t, &mut out);
                worst = worst.max((out[0] - t.sin().exp()).abs());
            }
            Flow::Continue
        });
        assert!(result.is_ok());
        [(y[0] - t.sin().exp()).abs(), worst]
    }

    #[test]
    fn order_five_and_dense_order_four() {
        let (a, b) = (solve(0.1, 2.0, None)[0], solve(0.05, 2.0, None)[0]);
        let order = (a / b).log2();
        // Order 5; the difference Jacobian and the next error term move the observed value by a few tenths.
        assert!((4.6..5.7).contains(&order), "{order}");
        let (a, b) = (solve(0.1, 2.0, Some(0.37))[1], solve(0.05, 2.0, Some(0.37))[1]);
        // Global order 4 of the interpolant.
        assert!((3.7..5.5).contains(&(a / b).log2()), "{}", (a / b).log2());
    }

    /// A stiff exchange between two vessels, one of them tiny, and the outside: a linear invariant of states and quadratures.
    struct Vessels {
        exact: bool,
    }
    impl OdeSystem for Vessels {
        fn dim(&self) -> usize {
            2
        }
        fn quad_dim(&self) -> usize {
            1
        }
        fn rhs(&mut self, t: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
            let a = 1e6 * (y[0] - 1e4 * y[1]) * (1.0 + (3.0 * t).sin().abs());
            let b = y[0] * y[0].abs();
            (f[0], f[1], f[2]) = (-a - b, a, b);
            Ok(())
        }
        fn jacobian(&mut self, t: f64, y: &[f64], _: &[f64], jac: &mut [f64]) -> Result<bool, EvalError> {
            let r = 1e6 * (1.0 + (3.0 * t).sin().abs());
            let b = 2.0 * y[0].abs();
            jac.copy_from_slice(&[-r - b, 1e4 * r, r, -1e4 * r, b, 0.0]);
            Ok(self.exact)
        }
    }

    #[test]
    fn linear_invariants_hold_at_a_loose_tolerance() {
        // With an exact Jacobian the defect is round-off amplified by the solves (condition number about 1e4). A difference
        // Jacobian satisfies the invariant only to eps |f| / increment, 1e-16 * 1e6 / 1e-12 of entries of 1e10.
        for (exact, bound) in [(true, 1e-12), (false, 1e-9)] {
            let (mut y, mut q) = ([1.0, 2e-4], [0.0]);
            let o = Options::new(1e-2, &[1.0, 1e-4]);
            let mut stats = Stats::default();
            let r = Rodas::new(2, 1, None).integrate(
                &mut Vessels { exact },
                (0.0, 10.0),
                &[],
                &mut y,
                &mut q,
                &o,
                &mut stats,
                &mut |_, _| Flow::Continue,
            );
            assert!(r.is_ok());
            let defect = (y[0] + y[1] + q[0] - 1.0002).abs();
            assert!(defect < bound, "{defect:e}");
            // An L-stable method does not follow the fast exchange.
            assert!(stats.steps < 200, "{stats:?}");
        }
    }

    struct Robertson;
    impl OdeSystem for Robertson {
        fn dim(&self) -> usize {
            3
        }
        fn rhs(&mut self, _: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
            let (a, b, c) = (0.04 * y[0], 1e4 * y[1] * y[2], 3e7 * y[1] * y[1]);
            (f[0], f[1], f[2]) = (-a + b, a - b - c, c);
            Ok(())
        }
    }

    #[test]
    fn robertson_at_40() {
        let mut y = [1.0, 0.0, 0.0];
        let o = Options::new(1e-7, &[1.0, 1e-5, 1.0]);
        let r = Rodas::new(3, 0, None)
            .integrate(&mut Robertson, (0.0, 40.0), &[], &mut y, &mut [], &o, &mut Stats::default(), &mut |_, _| Flow::Continue);
        assert!(r.is_ok());
        // Independent 18-digit solution; the global error may exceed the tolerance per step by the number of steps' share.
        for (y, exact) in y.iter().zip([0.715_827_068_719_405_1, 9.185_534_764_557_764e-6, 0.284_163_745_745_830_36]) {
            assert!((y / exact - 1.0).abs() < 1e-6, "{y} {exact}");
        }
    }

    /// Refuses negative states, which a large first step produces.
    struct Refusing;
    impl OdeSystem for Refusing {
        fn dim(&self) -> usize {
            1
        }
        fn rhs(&mut self, t: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
            if y[0] < 0.0 {
                return Err(EvalError::recoverable("test", "negative"));
            }
            if t > 2.0 {
                return Err(EvalError::fatal("test", "beyond 2"));
            }
            f[0] = -50.0 * y[0].sqrt();
            Ok(())
        }
    }

    #[test]
    fn refusals_shrink_the_step_and_fatal_ones_stop() {
        let mut o = Options::new(1e-3, &[1.0]);
        o.h_init = 0.3;
        let mut stats = Stats::default();
        let mut y = [100.0];
        let mut r = Rodas::new(1, 0, None);
        let ok = r.integrate(&mut Refusing, (0.0, 0.35), &[], &mut y, &mut [], &o, &mut stats, &mut |_, _| Flow::Continue);
        // sqrt(y) falls linearly: y(0.35) = (10 - 25 * 0.35)².
        assert!(ok.is_ok() && (y[0] - 1.5625).abs() < 1e-2, "{ok:?} {y:?}");
        let mut y = [1e6];
        let end = r.integrate(&mut Refusing, (0.0, 3.0), &[], &mut y, &mut [], &o, &mut stats, &mut |_, _| Flow::Continue);
        assert!(matches!(end, Err(IntegrateError::Eval { .. })), "{end:?}");
    }

    #[test]
    fn stops_exactly_at_breakpoints() {
        let mut seen = Vec::new();
        let (mut y, mut q) = ([1.0, 3.0], [0.0]);
        let o = Options::new(1e-3, &[1.0, 1.0]);
        let r = Rodas::new(2, 1, None).integrate(&mut Smooth, (0.0, 2.0), &[0.0, 0.5, 1.25, 2.0], &mut y, &mut q, &o, &mut Stats::default(), &mut |_, v| {
            seen.push(v.t1());
            Flow::Continue
        });
        assert!(r.is_ok());
        assert!([0.5, 1.25, 2.0].iter().all(|b| seen.contains(b)), "{seen:?}");
    }
}
