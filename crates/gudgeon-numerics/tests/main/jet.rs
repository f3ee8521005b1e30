//! Exact derivatives against differences and closed forms.

use gudgeon_numerics::jet::{Jet, Real};

fn formula<T: Real>(x: T, y: T, z: T) -> T {
    ((x * y).sqrt() + z.cubed() / (x + 2.0)).ln() * (y / z / 4.0).acos() - x.recip() * 3.0 + (-z).squared()
}

#[test]
fn derivatives_are_those_of_central_differences() {
    let p = [1.3, 0.8, 0.6];
    let jet = formula(Jet::variable(p[0], 0), Jet::variable(p[1], 1), Jet::variable(p[2], 2));
    assert_eq!(jet.v, formula(p[0], p[1], p[2]));
    let at = |i: usize, di: f64, j: usize, dj: f64| {
        let mut q = p;
        q[i] += di;
        q[j] += dj;
        formula(q[0], q[1], q[2])
    };
    for i in 0..3 {
        let d = 1e-5;
        let first = (at(i, d, i, 0.0) - at(i, -d, i, 0.0)) / (2.0 * d);
        // Truncation 1e-10 times the third derivative, rounding 1e-16/1e-5.
        assert!((jet.g[i] - first).abs() < 1e-8, "{i}: {} {first}", jet.g[i]);
        for j in 0..3 {
            let d = 1e-4;
            let second =
                (at(i, d, j, d) - at(i, d, j, -d) - at(i, -d, j, d) + at(i, -d, j, -d)) / (4.0 * d * d);
            // Truncation 1e-8 times the fourth derivative, rounding 1e-16/1e-8.
            assert!((jet.second(i, j) - second).abs() < 2e-5, "{i} {j}: {} {second}", jet.second(i, j));
        }
    }
}
