//! The fast transform against the sums it stands for.

use gudgeon_numerics::fourier::Fourier;
use gudgeon_numerics::linalg::Complex;

#[test]
fn waves_are_the_sums_they_stand_for_and_orders_come_back() {
    // Powers of four and of two.
    for points in [16_usize, 32, 64, 128, 512] {
        let most = points / 2;
        let some = |i: usize, k: usize| ((7 * i + 3 * k + 1) as f64).sin();
        let row = |i: usize| -> Vec<Complex> {
            (0..most).map(|k| Complex::new(some(i, k), if k == 0 { 0.0 } else { some(i + 1, k) })).collect()
        };
        let (a, b) = (row(1), row(5));
        let mut f = Fourier::new(points);
        let (mut x, mut y) = (vec![0.0; points], vec![0.0; points]);
        f.waves(&a, &b, &mut x, &mut y);
        let sum = |c: &[Complex], s: usize| {
            let angle = 2.0 * std::f64::consts::PI * s as f64 / points as f64;
            c.iter()
                .enumerate()
                .map(|(k, c)| c.re * (k as f64 * angle).cos() - c.im * (k as f64 * angle).sin())
                .sum::<f64>()
        };
        for s in 0..points {
            // Rounding of a sum of `most` terms of size one, whose angles are rounded at up to 2π most.
            let most = 1e-15 * (points * points) as f64;
            assert!((x[s] - sum(&a, s)).abs() < most && (y[s] - sum(&b, s)).abs() < most, "{points} {s}");
        }
        let (mut back, mut other) = (vec![Complex::default(); most], vec![Complex::default(); most]);
        f.orders(&x, &y, &mut back, &mut other);
        for k in 0..most {
            // Rounding goes with the logarithm of the points.
            assert!((back[k] - a[k]).abs() < 1e-14 && (other[k] - b[k]).abs() < 1e-14, "{points} {k}");
        }
    }
}
