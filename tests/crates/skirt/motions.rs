//! Lateral motions on a piston whose forces are linear: `F = f + k t - K e - B v`.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::{
    LateralLoads, LateralPartials, LateralPose, SecondaryMotion, SecondaryMotionCtx, SecondaryMotionSpec,
};
use gudgeon_core::quantity::quantity;
use gudgeon_core::states::Signals;
use gudgeon_skirt::{FullInertia, Held, QuasiStatic};

type Matrix = [[f64; 2]; 2];

fn times(m: Matrix, v: [f64; 2]) -> [f64; 2] {
    [m[0][0] * v[0] + m[0][1] * v[1], m[1][0] * v[0] + m[1][1] * v[1]]
}

fn solve(m: Matrix, f: [f64; 2]) -> [f64; 2] {
    let det = m[0][0] * m[1][1] - m[0][1] * m[1][0];
    [(m[1][1] * f[0] - m[0][1] * f[1]) / det, (m[0][0] * f[1] - m[1][0] * f[0]) / det]
}

const CLEARANCE: f64 = 1e-5;
const OMEGA: f64 = 200.0;
const MASS: Matrix = [[0.21, 0.03], [0.03, 0.08]];
const FORCE: [f64; 2] = [120.0, -45.0];
const BY_TIME: [f64; 2] = [7.0, 3.0];
const STIFF: Matrix = [[4e6, 1e6], [1e6, 3e6]];
const DAMP: Matrix = [[9e4, 2e4], [2e4, 5e4]];

/// The piston, at displacements `e`.
struct Springs {
    e: [f64; 2],
    v: [f64; 2],
    fails: bool,
    asked: u32,
}

impl Springs {
    fn at(e: [f64; 2]) -> Self {
        Self { e, v: [0.0; 2], fails: false, asked: 0 }
    }
    fn still(&self) -> [f64; 2] {
        let k = times(STIFF, self.e);
        [FORCE[0] - k[0], FORCE[1] - k[1]]
    }
}

impl LateralLoads for Springs {
    fn balance(&mut self) -> Result<[f64; 2], EvalError> {
        self.balance_against([0.0; 2])
    }
    fn balance_against(&mut self, force: [f64; 2]) -> Result<[f64; 2], EvalError> {
        self.asked += 1;
        if self.fails {
            return Err(EvalError::recoverable("springs", "no balance"));
        }
        let f = self.still();
        self.v = solve(DAMP, [f[0] - force[0], f[1] - force[1]]);
        Ok(self.v)
    }
    fn forces(&mut self, v: [f64; 2]) -> Result<[f64; 2], EvalError> {
        self.asked += 1;
        self.v = v;
        let (f, d) = (self.still(), times(DAMP, v));
        Ok([f[0] - d[0], f[1] - d[1]])
    }
    fn skirt_forces(&self) -> [f64; 2] {
        self.still()
    }
}

fn ctx() -> SecondaryMotionCtx {
    SecondaryMotionCtx::new(CLEARANCE, OMEGA, MASS).starting_at([3e-6, -2e-6])
}

fn rates(m: &mut dyn SecondaryMotion, y: &[f64]) -> Vec<f64> {
    let mut dy = vec![f64::NAN; y.len()];
    m.rates(y, &mut Springs::at(m.pose(y).e), &mut dy).expect("rates");
    dy
}

/// Derivatives of the answer of the piston, with one shape whose amplitude acts like a force.
fn partials_of(given: bool, by_shape: &[[f64; 2]]) -> LateralPartials<'_> {
    let column = |m: Matrix, k: usize| [-m[0][k], -m[1][k]];
    if given {
        let by_e = [column(STIFF, 0), column(STIFF, 1)];
        return LateralPartials::new(
            by_e,
            [column(DAMP, 0), column(DAMP, 1)],
            [[1.0, 0.0], [0.0, 1.0]],
            by_shape,
        );
    }
    let by_e = [solve(DAMP, column(STIFF, 0)), solve(DAMP, column(STIFF, 1))];
    let by_force = [solve(DAMP, [1.0, 0.0]), solve(DAMP, [0.0, 1.0])];
    LateralPartials::new(by_e, [[0.0; 2]; 2], by_force, by_shape)
}

#[test]
fn states_start_and_move_as_the_case_says() {
    let mut motions = [
        (QuasiStatic {}.build(&ctx()).expect("builds"), 2, false),
        (FullInertia {}.build(&ctx()).expect("builds"), 4, true),
    ];
    for (m, n, inertia) in &mut motions {
        assert_eq!(m.states().len(), *n);
        assert_eq!((m.n_periodic(), m.has_inertia(), m.moves()), (2, *inertia, true));
        assert!(m.start_keys().is_none() && m.parts().len() == 1 && m.parts()[0].runs == *inertia);
        let mut y = vec![9.0; *n];
        m.initial(&mut y);
        let pose = m.pose(&y);
        // A quotient and a product: one rounding.
        assert!((pose.e[0] - 3e-6).abs() < 1e-20 && (pose.e[1] + 2e-6).abs() < 1e-20, "{pose:?}");
        assert_eq!(pose.v, inertia.then_some([0.0; 2]));
        for (k, s) in m.states().iter().enumerate() {
            // Displacements are judged by the clearance, velocities by their value too.
            assert_eq!(s.changes.meets(Signals::FILM_THICKNESS), k < 2, "{}", s.name);
            assert_eq!((s.relative, s.scale, s.cycle_scale), (k >= 2, 1.0, 1.0));
        }
    }
}

#[test]
fn quasi_static_moves_where_forces_balance() {
    let mut m = QuasiStatic {}.build(&ctx()).expect("builds");
    let y = [0.2, -0.3];
    let e = [0.2 * CLEARANCE, -0.3 * CLEARANCE];
    let dy = rates(&mut *m, &y);
    let mut piston = Springs::at(e);
    let left = piston.forces([dy[0] * CLEARANCE * OMEGA, dy[1] * CLEARANCE * OMEGA]).expect("forces");
    // Rounding of forces of 100 N.
    assert!(left.iter().all(|f| f.abs() < 1e-11), "{left:?}");
    let v = m.velocities(&y, &|_| f64::NAN, &mut piston).expect("a balance");
    assert!((v[0] / (dy[0] * CLEARANCE * OMEGA) - 1.0).abs() < 1e-14);
    assert!((v[1] / (dy[1] * CLEARANCE * OMEGA) - 1.0).abs() < 1e-14);
    let law = m.edge_law().expect("a law of the edges");
    assert!(law.mass().is_none());
    let mut back = [0.0; 2];
    law.states_at(e, [1.0, 2.0], &mut back);
    assert!((back[0] - 0.2).abs() < 1e-15 && (back[1] + 0.3).abs() < 1e-15);
}

#[test]
fn inertia_follows_newtons_law() {
    let mut m = FullInertia {}.build(&ctx()).expect("builds");
    let y = [0.2, -0.3, 0.05, -0.02];
    let speed = CLEARANCE * OMEGA;
    let (e, v) = ([0.2 * CLEARANCE, -0.3 * CLEARANCE], [0.05 * speed, -0.02 * speed]);
    let pose = m.pose(&y);
    assert_eq!(pose, LateralPose::new(e).moving(v));
    let dy = rates(&mut *m, &y);
    assert!((dy[0] - 0.05).abs() < 1e-16 && (dy[1] + 0.02).abs() < 1e-16);
    let inertia = times(MASS, [dy[2] * speed * OMEGA, dy[3] * speed * OMEGA]);
    let f = Springs::at(e).forces(v).expect("forces");
    // Rounding of forces of 100 N.
    assert!((inertia[0] - f[0]).abs() < 1e-10 && (inertia[1] - f[1]).abs() < 1e-10, "{inertia:?} {f:?}");
    let law = m.edge_law().expect("a law of the edges");
    assert_eq!(law.mass(), Some(MASS));
    let mut back = [0.0; 4];
    law.states_at(e, v, &mut back);
    assert!(back.iter().zip(y).all(|(a, b)| (a - b).abs() < 1e-15), "{back:?}");
}

#[test]
fn inertia_begins_and_is_looked_at_by_a_balance() {
    let mut m = FullInertia {}.build(&ctx()).expect("builds");
    let speed = CLEARANCE * OMEGA;
    let mut y = [0.2, -0.3, 9.0, 9.0];
    let e = m.pose(&y).e;
    m.begin(&mut y, &mut Springs::at(e));
    let left = Springs::at(e).forces([y[2] * speed, y[3] * speed]).expect("forces");
    assert!(left.iter().all(|f| f.abs() < 1e-11), "{left:?}");
    let mut stuck = Springs { fails: true, ..Springs::at(e) };
    m.begin(&mut y, &mut stuck);
    assert_eq!(y[2..], [0.0, 0.0]);
    // With the accelerations of the polynomial, the velocities at which the forces are those accelerations'.
    let slope = |k: usize| [f64::NAN, f64::NAN, 0.4, -0.7][k];
    let v = m.velocities(&y, &slope, &mut Springs::at(e)).expect("a balance");
    let f = Springs::at(e).forces(v).expect("forces");
    let inertia = times(MASS, [0.4 * speed * OMEGA, -0.7 * speed * OMEGA]);
    assert!((f[0] - inertia[0]).abs() < 1e-11 && (f[1] - inertia[1]).abs() < 1e-11, "{f:?} {inertia:?}");
    // Without a balance, those of the states.
    (y[2], y[3]) = (0.3, -0.6);
    let v = m.velocities(&y, &slope, &mut stuck).expect("velocities of the states");
    assert!((v[0] - 0.3 * speed).abs() < 1e-18 && (v[1] + 0.6 * speed).abs() < 1e-18, "{v:?}");
    assert_eq!(stuck.asked, 3);
}

#[test]
fn partial_derivatives_are_those_of_the_rates() {
    let shapes = [[5e6, -2e6], [1e6, 3e6]];
    let mut motions = [
        (QuasiStatic {}.build(&ctx()).expect("builds"), false),
        (FullInertia {}.build(&ctx()).expect("builds"), true),
    ];
    for (m, given) in &mut motions {
        let n = m.states().len();
        let y: Vec<f64> = [0.2, -0.3, 0.05, -0.02][..n].to_vec();
        let here = rates(&mut **m, &y);
        // Shapes act on the answer like forces: on velocities through what resists.
        let by_shape = if *given { shapes } else { shapes.map(|s| solve(DAMP, s)) };
        let width = n + 2;
        let mut jac = vec![f64::NAN; n * width];
        assert!(m.partials(&y, &partials_of(*given, &by_shape), &mut jac));
        for k in 0..n {
            let mut there = y.clone();
            there[k] += 0.5;
            for (row, there) in rates(&mut **m, &there).into_iter().enumerate() {
                // All is linear: the quotient is the derivative, to rounding of the largest term.
                let (a, b) = (jac[row * width + k], (there - here[row]) / 0.5);
                assert!((a - b).abs() < 1e-9 * (1.0 + b.abs()), "{given} {row} {k}: {a} {b}");
            }
        }
        let mut time = vec![f64::NAN; n];
        let by_time = if *given { BY_TIME } else { solve(DAMP, BY_TIME) };
        assert!(m.time_partials(by_time, &mut time));
        let speed = CLEARANCE * OMEGA;
        let accelerations = |f: [f64; 2]| solve(MASS, f).map(|a| a / (speed * OMEGA));
        for k in 0..2 {
            // Amplitudes count in clearances.
            let expected = if *given {
                let a = accelerations(shapes[k].map(|f| f * CLEARANCE));
                vec![0.0, 0.0, a[0], a[1]]
            } else {
                by_shape[k].map(|v| v * CLEARANCE / speed).to_vec()
            };
            for row in 0..n {
                let (a, b) = (jac[row * width + n + k], expected[row]);
                assert!((a - b).abs() <= 1e-13 * b.abs(), "{given} {row} {k}: {a} {b}");
            }
        }
        let expected = if *given {
            let a = accelerations(BY_TIME);
            vec![0.0, 0.0, a[0], a[1]]
        } else {
            by_time.map(|v| v / speed).to_vec()
        };
        for (a, b) in time.iter().zip(expected) {
            assert!((a - b).abs() <= 1e-14 * b.abs(), "{given}: {a} {b}");
        }
    }
}

#[test]
fn held_stands_where_it_is_told() {
    let spec = Held { e_top: quantity(-1e-6), e_bottom: quantity(4e-6) };
    let mut m = spec.build(&ctx()).expect("builds");
    assert!(!m.moves() && !m.has_inertia() && m.states().is_empty() && m.edge_law().is_none());
    assert_eq!(m.pose(&[]), LateralPose::new([-1e-6, 4e-6]).moving([0.0; 2]));
    assert_eq!(m.start_keys(), Some(["e_top", "e_bottom"]));
    assert!(!m.parts()[0].runs);
    // No force is asked for.
    let mut piston = Springs::at([0.0; 2]);
    m.rates(&[], &mut piston, &mut []).expect("nothing to do");
    assert_eq!(m.velocities(&[], &|_| f64::NAN, &mut piston).expect("none"), [0.0; 2]);
    assert!(m.partials(&[], &partials_of(true, &[]), &mut []) && m.time_partials([1.0; 2], &mut []));
    assert_eq!(piston.asked, 0);
}
