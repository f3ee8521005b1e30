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

#[test]
fn closed_forms_of_single_operations() {
    let (x, y, z) = (Jet::variable(1.5, 0), Jet::variable(0.5, 1), Jet::variable(-2.0, 2));
    // Powers of two and small integers: nothing is rounded.
    let p = x * y * z;
    assert_eq!((p.v, p.g), (-1.5, [-1.0, -3.0, 0.75]));
    assert_eq!(p.h, [0.0, -2.0, 0.5, 0.0, 1.5, 0.0]);
    let q = x / y;
    assert_eq!((q.v, q.g, q.h), (3.0, [2.0, -6.0, 0.0], [0.0, -4.0, 0.0, 24.0, 0.0, 0.0]));
    let r = y.recip();
    assert_eq!((r.v, r.g, r.h), (2.0, [0.0, -4.0, 0.0], [0.0, 0.0, 0.0, 16.0, 0.0, 0.0]));
    for c in [x.cubed(), x * x * x] {
        assert_eq!((c.v, c.g, c.h), (3.375, [6.75, 0.0, 0.0], [9.0, 0.0, 0.0, 0.0, 0.0, 0.0]));
    }
    assert_eq!(z.squared(), z * z);
    assert_eq!(-z, z * -1.0);
    assert_eq!(x - y, x + -y);
    for i in 0..3 {
        for j in 0..3 {
            assert_eq!(p.second(i, j), p.second(j, i));
        }
    }
}

#[test]
fn constants_shift_and_stretch_alone() {
    let j = Jet { v: 0.5, g: [1.0, -2.0, 4.0], h: [1.0, 2.0, 3.0, 4.0, 5.0, 6.0] };
    assert_eq!(j + 2.0, Jet { v: 2.5, ..j });
    assert_eq!(j - 2.0, Jet { v: -1.5, ..j });
    let twice = Jet { v: 1.0, g: [2.0, -4.0, 8.0], h: [2.0, 4.0, 6.0, 8.0, 10.0, 12.0] };
    assert_eq!((j * 2.0, j / 0.5), (twice, twice));
    let c = Jet::constant(2.0);
    assert_eq!((c.value(), c.g, c.h), (2.0, [0.0; 3], [0.0; 6]));
    assert_eq!((j * c, j + j), (twice, twice));
    // There are three variables.
    assert_eq!(Jet::variable(2.0, 3), c);
    assert_eq!((<f64 as Real>::constant(3.0), Real::value(3.0), Real::recip(4.0)), (3.0, 3.0, 0.25));
    assert_eq!((Real::squared(3.0), Real::cubed(3.0), Real::sqrt(9.0)), (9.0, 27.0, 3.0));
    assert_eq!((Real::ln(1.0), Real::acos(1.0)), (0.0, 0.0));
}

#[test]
fn functions_have_their_derivatives() {
    // Along a line with slopes 1 and 2: f', 2 f' and f'', 2 f'', 4 f''.
    let u = 0.25;
    let j = Jet::variable(u - 2.0 * 0.1, 0) + Jet::variable(0.1, 1) * 2.0;
    let w = 1.0 - u * u;
    for (f, v, d, dd) in [
        (j.sqrt(), 0.5, 1.0, -2.0),
        (j.ln(), u.ln(), 4.0, -16.0),
        (j.acos(), u.acos(), -1.0 / w.sqrt(), -u / (w * w.sqrt())),
    ] {
        // A few roundings, the argument's among them.
        let close = |a: f64, b: f64| assert!((a - b).abs() <= 1e-14 * b.abs(), "{a} {b}");
        close(f.v, v);
        close(f.g[0], d);
        close(f.g[1], 2.0 * d);
        close(f.second(0, 0), dd);
        close(f.second(0, 1), 2.0 * dd);
        close(f.second(1, 1), 4.0 * dd);
        assert_eq!((f.g[2], f.second(0, 2), f.second(2, 2)), (0.0, 0.0, 0.0));
    }
}
