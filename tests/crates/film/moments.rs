//! Integrals of a film over a face against quadrature.

use gudgeon_film::parts::{Moments, Parabola, SERIES, Shape, Table, angle, core};

/// Nodes at equal spacings.
fn equal(length: f64, drops: &[f64]) -> Vec<(f64, f64)> {
    gudgeon_core::geometry::FaceProfile::Table { length, drops: drops.to_vec() }.nodes().unwrap_or_default()
}

/// The integrals by Gauss's 10-point rule on `n` panels.
fn by_quadrature(n: u32, h: f64, drop: &dyn Fn(f64) -> f64, xa: f64, xb: f64, x_ref: f64) -> Moments {
    const X: [f64; 5] = [
        0.148_874_338_981_631_22,
        0.433_395_394_129_247_2,
        0.679_409_568_299_024_4,
        0.865_063_366_688_984_5,
        0.973_906_528_517_171_7,
    ];
    const W: [f64; 5] = [
        0.295_524_224_714_752_87,
        0.269_266_719_309_996_35,
        0.219_086_362_515_982_04,
        0.149_451_349_150_580_6,
        0.066_671_344_308_688_14,
    ];
    let mut m = Moments::default();
    for k in 0..n {
        let w = 0.5 * (xb - xa) / f64::from(n);
        let c = xa + w * f64::from(2 * k + 1);
        for (x, g) in X.iter().zip(W) {
            for x in [c - w * x, c + w * x] {
                let (s, d) = (x - x_ref, drop(x));
                let f = h + d;
                let g = g * w;
                m.add(&Moments {
                    i1: g / f,
                    i2: g / (f * f),
                    i3: g / (f * f * f),
                    x2: g * s / (f * f),
                    x3: g * s / (f * f * f),
                    xx3: g * s * s / (f * f * f),
                    d2: g * d / (f * f * f),
                    e2: g * s * d / (f * f * f),
                });
            }
        }
    }
    m
}

fn compare(a: &Moments, b: &Moments, arm: f64, drop: f64, tol: f64, what: &str) {
    let pairs = [
        ("i1", a.i1, b.i1, b.i1),
        ("i2", a.i2, b.i2, b.i2),
        ("i3", a.i3, b.i3, b.i3),
        ("x2", a.x2, b.x2, arm * b.i2),
        ("x3", a.x3, b.x3, arm * b.i3),
        ("xx3", a.xx3, b.xx3, b.xx3),
        ("d2", a.d2, b.d2, b.d2.abs().max(1e-6 * drop * b.i3)),
        ("e2", a.e2, b.e2, arm * b.d2.abs().max(1e-6 * drop * b.i3)),
    ];
    for (name, x, y, size) in pairs {
        assert!((x - y).abs() <= tol * size.abs(), "{what} {name}: {x:e} {y:e} {:e}", (x - y) / size);
    }
}

#[test]
fn parabola_against_quadrature() {
    let l = 1.2e-3;
    for apex in [0.5 * l, 0.3 * l, 0.0, l, -0.1 * l, -2.0 * l, 30.0 * l] {
        for drop in [0.0, 1e-12, 1e-9, 1e-7, 1e-6, 1e-5, 1e-4] {
            for h in [1e-7, 1e-6, 2e-5] {
                let k = drop / (l * l);
                let mut p = Parabola::new(l, k, apex);
                p.set_film(h);
                for (xa, xb) in
                    [(0.0, l), (0.0, 0.2 * l), (0.9 * l, l), (0.4 * l, 0.45 * l), (0.31 * l, 0.99 * l)]
                {
                    let q = by_quadrature(400, h, &|x| k * (x - apex) * (x - apex), xa, xb, p.x_ref());
                    let arm = (xa - p.x_ref()).abs().max((xb - p.x_ref()).abs());
                    // The sum over 4000 nodes is itself good to some 1e-13.
                    compare(
                        &p.span(0, xa, 0, xb),
                        &q,
                        arm,
                        drop,
                        3e-13,
                        &format!("{apex} {drop} {h} {xa} {xb}"),
                    );
                }
            }
        }
        // Hollow: the film vanishes at the farther edge but for a thousandth.
        let k = -1e-6 / (l * l);
        let mut p = Parabola::new(l, k, apex);
        let h = -p.lowest() * 1.001;
        p.set_film(h);
        let q = by_quadrature(8000, h, &|x| k * (x - apex) * (x - apex), 0.0, l, p.x_ref());
        // The film at that edge is known to 1e-13 of itself, and moments about an apex 30 lengths away lose 30².
        compare(&p.span(0, 0.0, 0, l), &q, l, 1e-6, 1e-10, "hollow");
    }
}

#[test]
fn table_against_quadrature() {
    let l = 1.2e-3;
    let drops = [5e-6, 3e-6, 1e-6, 1e-7, 0.0, 0.0, 1e-9, 2e-7, 4e-6, 3.9e-6, 9e-6];
    let mut t = Table::new(&equal(l, &drops));
    for h in [1e-8, 1e-7, 1e-6, 2e-5] {
        t.set_film(h);
        let mut sum = Moments::default();
        for i in 0..t.pieces() {
            let (a, b) = (t.node(i), t.node(i + 1));
            let c = 0.3 * a + 0.7 * b;
            for (xa, xb) in [(a, b), (a, c), (c, b)] {
                let q = by_quadrature(400, h, &|x| t.drop(i, x), xa, xb, t.x_ref());
                let arm = (xa - t.x_ref()).abs().max((xb - t.x_ref()).abs());
                // As above; steep pieces of a thin film end at 1/1000 of their drop.
                compare(&t.span(i, xa, i, xb), &q, arm, 1e-6, 3e-12, &format!("{h} {i} {xa} {xb}"));
                if xa == a && xb == b {
                    sum.add(&q);
                }
            }
        }
        compare(&t.whole(), &sum, l, 1e-6, 3e-12, "whole");
        let (i, x) = (6, 0.65 * l);
        let all = t.head(i, x).plus(t.tail(i, x));
        let w = t.whole().pressure();
        assert!((all.i3 - w.i3).abs() <= 1e-14 * w.i3 && (all.d2 - w.d2).abs() <= 1e-13 * w.d2);
    }
}

/// `nearby` from every place to every other that it accepts, against the integrals themselves.
fn extends<S: Shape>(face: &mut S, film: f64) {
    face.set_film(film);
    let l = face.length();
    let mut accepted = 0;
    for i in 0..face.pieces() {
        let (a, b) = (face.node(i), face.node(i + 1));
        for from in [0.3, 0.5, 0.9] {
            let x0 = a + from * (b - a);
            let m0 = face.span(0, 0.0, i, x0);
            for step in [1e-9, -1e-7, 9e-6, -1e-4, 1e-3, -1e-2, 0.019, 0.1] {
                let x = x0 + step * x0;
                if x <= a || x >= b {
                    continue;
                }
                let Some(m) = face.nearby(&m0, x, i, x0, x) else { continue };
                accepted += 1;
                let want = face.span(0, 0.0, i, x);
                let arm = face.x_ref().max(l - face.x_ref());
                // The integrals themselves are good to 3e-13; what the samples add is less.
                compare(&m, &want, arm, 1e-6, 6e-13, &format!("{film} {i} {x0} {x}"));
            }
        }
    }
    assert!(accepted >= 10, "{accepted}");
}

#[test]
fn integrals_extend_to_places_nearby() {
    let l = 1.2e-3;
    for h in [1e-7, 1e-6, 2e-5] {
        for apex in [0.5 * l, 0.3 * l, -0.1 * l] {
            for drop in [0.0, 1e-9, 1e-6, 1e-5] {
                extends(&mut Parabola::new(l, drop / (l * l), apex), h);
            }
        }
        extends(&mut Table::new(&equal(l, &[5e-6, 3e-6, 1e-6, 1e-7, 0.0, 0.0, 1e-9, 2e-7, 4e-6])), h);
        extends(&mut Table::new(&equal(l, &[0.0, 35e-6])), h);
    }
}

#[test]
fn straight_lines_are_one_piece() {
    let rise: Vec<f64> = (0..=10).map(|k| 35e-6 * f64::from(k) / 10.0).collect();
    assert_eq!(Table::new(&equal(2.6e-3, &rise)).pieces(), 1);
    assert_eq!(Table::new(&equal(2.6e-3, &[0.0; 7])).pieces(), 1);
    // Kinks stay, also one of a hundred roundings.
    let t = Table::new(&equal(4e-3, &[1e-6, 0.0, 0.0, 0.0, 1e-6 * (1.0 + 1e-13), 2e-6 * (1.0 + 3e-13)]));
    assert_eq!(t.pieces(), 4);
    assert_eq!((t.node(1), t.node(2)), (4e-3 / 5.0, 4e-3 * 3.0 / 5.0));
}

#[test]
fn angle_is_the_arc_tangent() {
    for k in 0..=4000 {
        let y = 1e-6 * 1.01_f64.powi(k - 600);
        for x in [1e-6, -1e-6, 0.0] {
            let (a, b) = (angle(y, x), y.atan2(x));
            assert!((a - b).abs() <= 4.0 * f64::EPSILON * b, "{y} {x} {a} {b}");
        }
    }
}

#[test]
fn series_meets_the_quotients() {
    // On both sides of the change-over the two forms agree, but for what the quotients lose: 1/z and 1/z² of a rounding
    // of the numerators, some eight units.
    let z = SERIES;
    let below = core(1.0, 1.0 + z, z * (1.0 - 1e-15), z.sqrt());
    let above = core(1.0, 1.0 + z, z * (1.0 + 1e-15), z.sqrt());
    assert!((below.0 - above.0).abs() < 2e-15);
    assert!((below.1 - above.1).abs() < 2e-14);
    assert!((below.2 - above.2).abs() < 3e-13);
}
