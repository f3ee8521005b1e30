//! Small quadratic programs: optimality conditions of random ones, and refusals.

use gudgeon_numerics::qp::{HalfSpace, QpError, inverse, minimise, minimise_near};

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn apply(m: &[[f64; 3]; 3], v: &[f64; 3]) -> [f64; 3] {
    [dot(&m[0], v), dot(&m[1], v), dot(&m[2], v)]
}

fn half(a: [f64; 3], b: f64) -> HalfSpace {
    HalfSpace { a, b }
}

/// A cheap generator: the same numbers on every machine.
fn random(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1u64 << 53) as f64 * 2.0 - 1.0
}

#[test]
fn random_programs_satisfy_their_optimality_conditions() {
    let mut seed = 7;
    let (mut solved, mut tight) = (0, 0);
    for _ in 0..2000 {
        let b: [[f64; 3]; 3] = std::array::from_fn(|_| std::array::from_fn(|_| random(&mut seed)));
        let h: [[f64; 3]; 3] = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                (0..3).map(|k| b[k][i] * b[k][j]).sum::<f64>() + if i == j { 0.1 } else { 0.0 }
            })
        });
        let g: [f64; 3] = std::array::from_fn(|_| 3.0 * random(&mut seed));
        let cs: Vec<HalfSpace> = (0..8)
            .map(|_| half(std::array::from_fn(|_| random(&mut seed)), 0.3 * random(&mut seed)))
            .collect();
        let m = match minimise(&h, &g, &cs) {
            Ok(m) => m,
            // Eight random half spaces often have nothing in common.
            Err(e) => {
                assert_eq!(e, QpError::Infeasible);
                continue;
            }
        };
        solved += 1;
        // A guess that is right, one that is wrong, and one of more constraints than there are variables: the same minimum, with the rounding that is
        // judged below.
        let inv = inverse(&h).unwrap();
        let held: Vec<usize> = (0..8).filter(|k| m.multipliers[*k] > 0.0).collect();
        let others: Vec<usize> =
            (0..8).filter(|k| m.multipliers[*k] == 0.0).take(held.len().max(1)).collect();
        for guess in [held, others, vec![0, 1, 2, 3]] {
            let near = minimise_near((&h, &inv), &g, &cs, &guess).unwrap();
            let size = 1.0 + m.multipliers.iter().sum::<f64>();
            for (a, b) in near.x.iter().zip(m.x).chain(near.multipliers.iter().zip(m.multipliers)) {
                assert!((a - b).abs() < 1e-11 * size * size, "{a} {b} {size}");
            }
        }
        let mut rest = apply(&h, &m.x);
        for i in 0..3 {
            rest[i] += g[i] + cs.iter().enumerate().map(|(k, c)| m.multipliers[k] * c.a[i]).sum::<f64>();
        }
        // Rounding of steps as long as the multipliers, which are large where normals nearly depend on each other; inverses of
        // Hessians with eigenvalues down to 0.1.
        let size = 1.0 + m.multipliers.iter().sum::<f64>();
        assert!(rest.iter().all(|r| r.abs() < 1e-12 * size), "{rest:?} {size}");
        for (k, c) in cs.iter().enumerate() {
            let (slack, mu) = (c.b - dot(&c.a, &m.x), m.multipliers[k]);
            assert!(slack > -1e-13 * size && mu >= 0.0, "{slack} {mu} {size}");
            assert!(mu == 0.0 || slack.abs() < 1e-13 * size, "{slack} {mu} {size}");
            tight += usize::from(m.multipliers[k] > 0.0);
        }
    }
    assert!(solved > 500 && tight > 1000, "{solved} {tight}");
}

#[test]
fn contradictions_and_bad_hessians_are_named() {
    let one = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let cs = [half([1.0, 0.0, 0.0], -1.0), half([-1.0, 0.0, 0.0], -1.0)];
    assert_eq!(minimise(&one, &[0.0; 3], &cs), Err(QpError::Infeasible));
    let saddle = [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]];
    assert_eq!(minimise(&saddle, &[0.0; 3], &[]), Err(QpError::NotConvex));
    let far = minimise(&one, &[-1.0, -2.0, -3.0], &[]).map(|m| m.x);
    assert_eq!(far, Ok([1.0, 2.0, 3.0]));
}
