//! Minimal residuals over a Krylov space.

use gudgeon_numerics::gmres::Gmres;

#[test]
fn a_system_is_solved_within_as_many_vectors_as_it_has_eigenvalues() {
    // Identity and a matrix of rank two: three different eigenvalues, three vectors.
    let n = 20;
    let u = |i: usize| (i as f64 + 1.0).sin();
    let v = |i: usize| (3.0 * i as f64).cos();
    let apply = |x: &[f64], y: &mut [f64]| {
        let (a, b): (f64, f64) =
            ((0..n).map(|i| u(i) * x[i]).sum(), (0..n).map(|i| (v(i) - 0.3 * u(i)) * x[i]).sum());
        for i in 0..n {
            y[i] = x[i] + 0.7 * v(i) * a - 0.4 * u(i) * b;
        }
    };
    let exact: Vec<f64> = (0..n).map(|i| 1.0 / (1.0 + i as f64)).collect();
    let mut b = vec![0.0; n];
    apply(&exact, &mut b);
    let mut g = Gmres::default();
    let mut x = vec![0.0; n];
    let left = g.solve(&b, &mut x, 1e-13, 10, apply);
    assert!(left <= 1e-13 && g.iterations <= 4, "{left} {}", g.iterations);
    // The residual by the condition of this matrix, below a hundred.
    for (x, e) in x.iter().zip(&exact) {
        assert!((x - e).abs() < 1e-11, "{x} {e}");
    }
}

#[test]
fn what_has_no_solution_ends_without_one() {
    let mut g = Gmres::default();
    let mut x = vec![0.0; 3];
    assert_eq!(g.solve(&[0.0; 3], &mut x, 1e-10, 3, |x, y| y.copy_from_slice(x)), 0.0);
    // A takes everything to nothing.
    assert_eq!(g.solve(&[1.0, 0.0, 0.0], &mut x, 1e-10, 3, |_, y| y.fill(0.0)), 1.0);
    assert_eq!(x, [0.0; 3]);
    g.solve(&[f64::NAN, 0.0, 0.0], &mut x, 1e-10, 3, |x, y| y.copy_from_slice(x));
    assert_eq!(x, [0.0; 3]);
}
