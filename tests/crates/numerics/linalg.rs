//! Linear systems: residuals, agreement of independent solvers, refusals.

use gudgeon_numerics::linalg::{
    Banded, Complex, ComplexLu, Singular, SymmetricBanded, dot, lu_factor, lu_factor_weighted, lu_solve,
    solve_tridiagonal,
};

/// A fixed sequence of numbers in [-1, 1) (Weyl sequence): a reproducible dense matrix.
fn weyl(k: usize) -> f64 {
    2.0 * (k as f64 * 0.618_033_988_749_894_9 + 0.3 * (k as f64).sqrt()).fract() - 1.0
}

#[test]
fn dense_lu_solves_and_reports_singularity() {
    for n in [1, 2, 5, 16, 37, 60] {
        let a: Vec<f64> = (0..n * n).map(|k| weyl(k + 1)).collect();
        let x: Vec<f64> = (0..n).map(|k| weyl(7 * k + 3)).collect();
        let mut b: Vec<f64> = (0..n).map(|i| dot(&a[i * n..i * n + n], &x)).collect();
        let b0 = b.clone();
        let (mut lu, mut piv) = (a.clone(), vec![0; n]);
        lu_factor(&mut lu, n, &mut piv).unwrap();
        lu_solve(&lu, n, &piv, &mut b);
        // Backward stable: the residual is n times rounding, whatever the condition.
        for i in 0..n {
            let r = dot(&a[i * n..i * n + n], &b) - b0[i];
            let size: f64 = a[i * n..i * n + n].iter().zip(&b).map(|(a, b)| (a * b).abs()).sum();
            assert!(r.abs() <= 20.0 * n as f64 * f64::EPSILON * size, "{n} {r}");
        }
    }
    let mut a = vec![1.0, 2.0, 2.0, 4.0];
    assert_eq!(lu_factor(&mut a, 2, &mut [0; 2]), Err(Singular { column: 1 }));
    let mut a = vec![f64::NAN, 2.0, f64::NAN, 4.0];
    assert!(lu_factor(&mut a, 2, &mut [0; 2]).is_err());
}

#[test]
fn weights_make_pivots_independent_of_units() {
    // The same matrix with row 1 in other units: the weight undoes the scaling, so the pivots are the same.
    let a = [1.0, 2.0, 3.0, 4.0];
    let (mut p, mut q) = ([0; 2], [0; 2]);
    lu_factor(&mut a.clone(), 2, &mut p).unwrap();
    let mut scaled = [1e9, 2e9, 3.0, 4.0];
    lu_factor_weighted(&mut scaled, 2, &mut q, Some(&mut [1e-9, 1.0])).unwrap();
    assert_eq!(p, q);
}

#[test]
fn complex_lu_solves_and_reports_singularity() {
    for n in [1, 2, 9, 24] {
        let a: Vec<Complex> = (0..n * n).map(|k| Complex::new(weyl(k + 1), weyl(3 * k + 2))).collect();
        let x: Vec<Complex> = (0..n).map(|k| Complex::new(weyl(k), weyl(5 * k))).collect();
        let b: Vec<Complex> =
            (0..n).map(|i| (0..n).fold(Complex::default(), |s, j| s + a[i * n + j] * x[j])).collect();
        let mut lu = ComplexLu::new(n);
        let (re, im) = lu.parts();
        for (k, a) in a.iter().enumerate() {
            (re[k], im[k]) = (a.re, a.im);
        }
        lu.factor().unwrap();
        let (mut re, mut im): (Vec<f64>, Vec<f64>) = b.iter().map(|b| (b.re, b.im)).unzip();
        lu.solve(&mut re, &mut im);
        for i in 0..n {
            let sum = (0..n).fold(Complex::default(), |s, j| s + a[i * n + j] * Complex::new(re[j], im[j]));
            let size: f64 = (0..n).map(|j| a[i * n + j].abs() * Complex::new(re[j], im[j]).abs()).sum();
            // Backward stable: the residual is n times rounding, whatever the condition.
            assert!((sum - b[i]).abs() <= 40.0 * n as f64 * f64::EPSILON * size, "{n} {i}");
        }
    }
    let fill = |values: [f64; 8]| {
        let mut lu = ComplexLu::new(2);
        let (re, im) = lu.parts();
        re.copy_from_slice(&values[..4]);
        im.copy_from_slice(&values[4..]);
        lu.factor()
    };
    // Rows (1, i) and (i, -1): the second is i times the first.
    assert_eq!(fill([1.0, 0.0, 0.0, -1.0, 0.0, 1.0, 1.0, 0.0]), Err(Singular { column: 1 }));
    assert_eq!(fill([0.0; 8]), Err(Singular { column: 0 }));
    assert_eq!(fill([f64::NAN; 8]), Err(Singular { column: 0 }));
    assert_eq!(fill([f64::INFINITY; 8]), Err(Singular { column: 0 }));
    // A zero first pivot in both parts: rows are exchanged.
    assert_eq!(fill([0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0]), Ok(()));
}

#[test]
fn banded_agrees_with_dense() {
    for (n, kl, ku) in [(1, 0, 0), (5, 1, 1), (12, 2, 1), (12, 1, 3), (30, 4, 4), (6, 5, 5)] {
        let mut band = Banded::new(n, kl, ku);
        let mut dense = vec![0.0; n * n];
        for i in 0..n {
            for j in i.saturating_sub(kl)..=(i + ku).min(n - 1) {
                // A small diagonal, so that rows are exchanged.
                let v = weyl(i * n + j + 1) * if i == j { 0.1 } else { 1.0 };
                band.add(i, j, v);
                dense[i * n + j] = v;
                assert_eq!(band.get(i, j), v);
            }
        }
        let b: Vec<f64> = (0..n).map(|k| weyl(k + 11)).collect();
        let (mut x, mut y, mut piv) = (b.clone(), b, vec![0; n]);
        band.factor().unwrap();
        band.solve(&mut x);
        lu_factor(&mut dense, n, &mut piv).unwrap();
        lu_solve(&dense, n, &piv, &mut y);
        for (x, y) in x.iter().zip(&y) {
            // Same pivots, same operations but for the order of sums; condition below 1e4.
            assert!((x - y).abs() <= 1e-11 * (1.0 + y.abs()), "{n} {kl} {ku}: {x} {y}");
        }
    }
    assert!(Banded::new(3, 1, 1).factor().is_err());
}

#[test]
fn symmetric_banded_agrees_with_the_general_one() {
    // Widths of every program: up to 8, 16, 24, 32, and beyond.
    for (n, half) in [
        (1, 0),
        (6, 0),
        (7, 1),
        (9, 2),
        (40, 7),
        (41, 8),
        (60, 13),
        (3, 20),
        (90, 24),
        (30, 29),
        (99, 33),
        (60, 50),
    ] {
        let (mut a, mut b) = (SymmetricBanded::new(n, half), Banded::new(n, half, half));
        for i in 0..n {
            for j in i.saturating_sub(half)..i {
                let v = weyl(i * 31 + j);
                a.add(i, j, v);
                b.add(i, j, v);
                b.add(j, i, v);
            }
            // Diagonally dominant, so positive definite.
            let v = 2.0 * half as f64 + 1.0;
            a.add(i, i, v);
            b.add(i, i, v);
        }
        let f: Vec<f64> = (0..n).map(|k| weyl(k + 11)).collect();
        a.factor().unwrap();
        b.factor().unwrap();
        let mut y = f.clone();
        b.solve(&mut y);
        // A block after another one: nothing of the first is left.
        for shift in [0.0, 3.0] {
            for (row, f) in a.block().iter_mut().zip(&f) {
                *row = [0.0, 1.0, 2.0, 3.0].map(|c| (f + shift) * (1.0 + c));
            }
            a.solve_block();
            let mut shifted: Vec<f64> = f.iter().map(|f| f + shift).collect();
            b.solve(&mut shifted);
            for (row, y) in a.block().iter().zip(&shifted) {
                for (c, x) in row.iter().enumerate() {
                    // Condition of a dominant matrix: a few; the rest is rounding of right-hand sides up to sixteen.
                    assert!((x - (1.0 + c as f64) * y).abs() < 1e-12, "{n} {half} {c}: {x} {y}");
                }
            }
        }
        let mut x = f.clone();
        a.solve(&mut x);
        for (x, y) in x.iter().zip(&y) {
            assert!((x - y).abs() < 1e-12, "{n} {half}: {x} {y}");
        }
    }
    let mut indefinite = SymmetricBanded::new(2, 1);
    indefinite.add(0, 0, 1.0);
    indefinite.add(1, 1, 1.0);
    indefinite.add(1, 0, 2.0);
    assert!(indefinite.factor().is_err());
}

#[test]
fn tridiagonal_solves_the_discrete_laplacian() {
    // -u'' = 2, u(0) = u(1) = 0: the central difference is exact for the parabola x (1 - x).
    let n = 99;
    let h = 1.0 / (n + 1) as f64;
    let (off, diagonal) = (vec![-1.0; n], vec![2.0; n]);
    let mut u = vec![2.0 * h * h; n];
    solve_tridiagonal(&off, &diagonal, &off, &mut u, &mut vec![0.0; n]).unwrap();
    for (i, u) in u.iter().enumerate() {
        let x = (i + 1) as f64 * h;
        // Condition number 4/(π h)² = 4e3 times rounding.
        assert!((u - x * (1.0 - x)).abs() < 1e-12);
    }
    assert!(solve_tridiagonal(&[0.0], &[0.0], &[0.0], &mut [1.0], &mut [0.0]).is_err());
}

#[test]
fn singular_matrices_are_named_by_their_column() {
    let mut banded = Banded::new(3, 1, 1);
    (0..2).for_each(|i| banded.add(i, i, 1.0));
    assert_eq!(banded.factor(), Err(Singular { column: 2 }));
    assert_eq!((banded.size(), banded.get(0, 2), banded.get(2, 0)), (3, 0.0, 0.0));
    banded.clear();
    (0..3).for_each(|i| banded.add(i, i, 2.0));
    assert_eq!((banded.get(1, 1), banded.get(0, 1), banded.factor()), (2.0, 0.0, Ok(())));
    let mut b = [2.0, 4.0, 6.0];
    banded.solve(&mut b);
    assert_eq!(b, [1.0, 2.0, 3.0]);
    for bad in [f64::NAN, f64::INFINITY, 0.0, -1.0] {
        let mut s = SymmetricBanded::new(6, 1);
        (0..6).for_each(|i| s.add(i, i, if i == 4 { bad } else { 1.0 }));
        assert_eq!(s.factor(), Err(Singular { column: 4 }), "{bad}");
        s.clear();
        (0..6).for_each(|i| s.add(i, i, 4.0));
        assert_eq!(s.factor(), Ok(()));
        let mut a = [1.0, 0.0, 0.0, if bad == -1.0 { 0.0 } else { bad }];
        assert_eq!(lu_factor(&mut a, 2, &mut [0; 2]), Err(Singular { column: 1 }), "{bad}");
        let pivot = if bad == -1.0 { 0.0 } else { bad };
        let two = solve_tridiagonal(&[0.0; 2], &[1.0, pivot], &[0.0; 2], &mut [1.0; 2], &mut [0.0; 2]);
        assert_eq!(two, Err(Singular { column: 1 }), "{bad}");
    }
    assert_eq!(solve_tridiagonal(&[], &[], &[], &mut [], &mut []), Ok(()));
}

#[test]
fn weights_choose_the_pivots() {
    // Rows (1, 0) and (2, 1): the largest entry is in the second, the largest weighted one in the first.
    let (mut a, mut pivots, mut weights) = ([1.0, 0.0, 2.0, 1.0], [9; 2], [3.0, 1.0]);
    lu_factor_weighted(&mut a, 2, &mut pivots, Some(&mut weights)).unwrap();
    assert_eq!((pivots, weights), ([0, 1], [3.0, 1.0]));
    let (mut a, mut weights) = ([1.0, 0.0, 2.0, 1.0], [1.0, 0.75]);
    lu_factor_weighted(&mut a, 2, &mut pivots, Some(&mut weights)).unwrap();
    assert_eq!((pivots, weights), ([1, 1], [0.75, 1.0]));
    assert_eq!(a, [2.0, 1.0, 0.5, -0.5]);
}

#[test]
fn inner_products_take_the_shorter_length() {
    for n in 0..12 {
        let a: Vec<f64> = (0..n).map(|k| k as f64 + 1.0).collect();
        let b = vec![2.0; 15];
        // Sums of small integers.
        assert_eq!((dot(&a, &b), dot(&b, &a)), ((n * (n + 1)) as f64, (n * (n + 1)) as f64));
    }
}

#[test]
#[should_panic(expected = "outside the band")]
fn entries_left_of_the_band_are_a_mistake() {
    Banded::new(5, 1, 2).add(3, 1, 1.0);
}

#[test]
#[should_panic(expected = "outside the band")]
fn entries_right_of_the_band_are_a_mistake() {
    Banded::new(5, 1, 2).add(1, 4, 1.0);
}

#[test]
#[should_panic(expected = "outside the lower half")]
fn entries_above_the_diagonal_are_a_mistake() {
    SymmetricBanded::new(5, 2).add(1, 2, 1.0);
}

#[test]
#[should_panic(expected = "solve before factor")]
fn changed_matrices_must_be_factored_again() {
    let mut a = Banded::new(2, 0, 0);
    (0..2).for_each(|i| a.add(i, i, 1.0));
    a.factor().unwrap();
    a.add(0, 0, 1.0);
    a.solve(&mut [1.0; 2]);
}

#[test]
#[should_panic(expected = "solve before factor")]
fn changed_symmetric_matrices_must_be_factored_again() {
    let mut a = SymmetricBanded::new(2, 0);
    (0..2).for_each(|i| a.add(i, i, 1.0));
    a.factor().unwrap();
    a.clear();
    a.solve(&mut [1.0; 2]);
}

/// Few unknowns have loops of their own. With rows and columns of the unit matrix beside them there are too many for those, and the same
/// products and sums stand in the same order.
#[test]
fn few_unknowns_have_the_bits_of_many() {
    let number = |i: usize, j: usize| ((7 * i + 3 * j + 1) as f64).sin();
    for n in 1..=8 {
        let m = n + 8;
        let few: Vec<f64> = (0..n * n).map(|k| number(k / n, k % n)).collect();
        let unit = |i: usize, j: usize| if i == j { 1.0 } else { 0.0 };
        let at = |i: usize, j: usize| if i < n && j < n { few[i * n + j] } else { unit(i, j) };
        let mut many: Vec<f64> = (0..m * m).map(|k| at(k / m, k % m)).collect();
        let (mut few, mut swaps, mut swaps_of_many) = (few.clone(), vec![0; n], vec![0; m]);
        lu_factor(&mut few, n, &mut swaps).expect("regular");
        lu_factor(&mut many, m, &mut swaps_of_many).expect("regular");
        assert_eq!(swaps, swaps_of_many[..n]);
        let mut x: Vec<f64> = (0..n).map(|i| number(i, 50)).collect();
        let mut of_many = x.clone();
        of_many.resize(m, 1.0);
        lu_solve(&few, n, &swaps, &mut x);
        lu_solve(&many, m, &swaps_of_many, &mut of_many);
        assert!(x.iter().zip(&of_many).all(|(a, b)| a.to_bits() == b.to_bits()), "{n}: {x:?} {of_many:?}");
    }
}
