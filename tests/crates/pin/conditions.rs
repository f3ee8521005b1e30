//! Residuals of the conditions of an optimum, curvature along the limits.

use gudgeon_pin::optimum::{Bound, KktResiduals, min_curvature};

/// Rotation about an axis through three angles: orthonormal rows.
fn rotation() -> [[f64; 3]; 3] {
    let (s1, c1) = 0.7f64.sin_cos();
    let (s2, c2) = (-1.1f64).sin_cos();
    let z = [[c1, -s1, 0.0], [s1, c1, 0.0], [0.0, 0.0, 1.0]];
    let x = [[1.0, 0.0, 0.0], [0.0, c2, -s2], [0.0, s2, c2]];
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| z[i][k] * x[k][j]).sum()))
}

/// The matrix with these eigenvalues and the rows of `r` as eigenvectors.
fn with_eigenvalues(r: &[[f64; 3]; 3], values: [f64; 3]) -> [[f64; 3]; 3] {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| values[k] * r[k][i] * r[k][j]).sum()))
}

const FREE: [bool; 3] = [false; 3];

fn near(got: Option<f64>, want: f64) {
    let got = got.expect("a direction is left");
    // Rounding of rotations of numbers of order one.
    assert!((got - want).abs() < 1e-13, "{got} {want}");
}

#[test]
fn the_curvature_is_the_minimum_eigenvalue_on_what_is_left() {
    let r = rotation();
    for values in [[3.0, 1.0, 2.0], [-1.0, 5.0, 0.5], [2.0, 2.0, -7.0]] {
        let w = with_eigenvalues(&r, values);
        let min = values.into_iter().fold(f64::INFINITY, f64::min);
        near(min_curvature(&w, &[], &FREE), min);
        // Held along one eigenvector, the least of the two others is left; along two, the third.
        for k in 0..3 {
            let (a, b) = ((k + 1) % 3, (k + 2) % 3);
            near(min_curvature(&w, &[r[k].map(|v| 4.0 * v)], &FREE), values[a].min(values[b]));
            let sum = std::array::from_fn(|i| r[k][i] + 0.3 * r[a][i]);
            near(min_curvature(&w, &[r[k], sum], &FREE), values[b]);
            // The same normal twice holds one direction only.
            near(min_curvature(&w, &[r[k], r[k]], &FREE), values[a].min(values[b]));
            assert_eq!(min_curvature(&w, &[r[k], r[a], r[b]], &FREE), None);
        }
    }
}

#[test]
fn fixed_dimensions_leave_the_others() {
    let w = [[4.0, 1.0, 0.0], [1.0, 3.0, 0.5], [0.0, 0.5, 2.0]];
    // Eigenvalues of the lower block: 2.5 ± √(0.25 + 0.25).
    near(min_curvature(&w, &[], &[true, false, false]), 2.5 - 0.5f64.sqrt());
    near(min_curvature(&w, &[], &[true, false, true]), 3.0);
    near(min_curvature(&w, &[[0.0, 1.0, 0.0]], &[true, false, false]), 2.0);
    assert_eq!(min_curvature(&w, &[[0.0, 1.0, 0.0]], &[true, false, true]), None);
}

#[test]
fn every_condition_must_hold() {
    let good =
        KktResiduals { stationarity: 1e-10, infeasibility: 1e-10, complementarity: 1e-10, curvature: None };
    assert!(good.hold(1e-10) && !good.hold(0.9e-10) && !good.hold_to_rounding());
    for bad in [
        KktResiduals { stationarity: 2e-10, ..good },
        KktResiduals { infeasibility: 2e-10, ..good },
        KktResiduals { complementarity: 2e-10, ..good },
        KktResiduals { curvature: Some(-2e-10), ..good },
    ] {
        assert!(!bad.hold(1e-10), "{bad:?}");
    }
    for curvature in [Some(-1e-10), Some(0.0), Some(1.0)] {
        assert!(KktResiduals { curvature, ..good }.hold(1e-10));
    }
    let exact = KktResiduals { infeasibility: -0.1, curvature: Some(-1.0), ..KktResiduals::default() };
    // Rounding is judged by the first order alone.
    assert!(exact.hold_to_rounding() && !exact.hold(1e-10));
}

#[test]
fn bounds_stand_in_their_order_with_names_of_their_own() {
    for (k, b) in Bound::ALL.into_iter().enumerate() {
        assert_eq!(b as usize, k);
        assert!(!b.words().is_empty() && Bound::ALL.iter().filter(|o| o.words() == b.words()).count() == 1);
    }
}
