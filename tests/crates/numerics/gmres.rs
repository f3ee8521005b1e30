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

#[test]
fn each_residual_is_the_smallest_over_its_space() {
    let n = 9;
    let a: Vec<f64> = (0..n * n)
        .map(|k| ((k * 37 + 11) % 17) as f64 / 17.0 - 0.4 + if k % (n + 1) == 0 { 2.0 } else { 0.0 })
        .collect();
    let times = |x: &[f64]| -> Vec<f64> {
        a.chunks_exact(n).map(|row| row.iter().zip(x).map(|(a, x)| a * x).sum()).collect()
    };
    let b: Vec<f64> = (0..n).map(|k| 1.0 - 0.3 * k as f64).collect();
    let size = b.iter().map(|b| b * b).sum::<f64>().sqrt();
    let mut last = 1.0;
    for vectors in 1..=n {
        let (mut gmres, mut x) = (Gmres::default(), vec![0.0; n]);
        let left = gmres.solve(&b, &mut x, 0.0, vectors, |x, y| y.copy_from_slice(&times(x)));
        assert_eq!(gmres.iterations, vectors);
        let r: Vec<f64> = times(&x).iter().zip(&b).map(|(ax, b)| b - ax).collect();
        // What it says of the residual is true, to the rounding of some ten products.
        assert!((r.iter().map(|r| r * r).sum::<f64>().sqrt() / size - left).abs() < 1e-13, "{vectors}");
        assert!(left <= last);
        last = left;
        // Orthogonal to what the matrix makes of the space: of b, A b, …
        let mut power = b.clone();
        for _ in 0..vectors {
            power = times(&power);
            let norm = power.iter().map(|p| p * p).sum::<f64>().sqrt();
            let product: f64 = power.iter().zip(&r).map(|(p, r)| p * r).sum();
            assert!(product.abs() < 1e-12 * norm * size, "{vectors}: {product}");
        }
    }
    assert!(last < 1e-13);
}
