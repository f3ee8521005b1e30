//! The strength models against numerical solutions, limits of their theory, and what solvers rely on.

use std::f64::consts::PI;

use crate::common::*;
use gudgeon_core::kinds::{
    BossBore, PIN_QUANTITIES, PinForces, PinQuantity, PinSize, PinStrength, PinStrengthCtx, PinStrengthSpec,
};

fn force(f: f64) -> PinForces {
    PinForces { gas: f, inertia: 0.0 }
}

fn at(m: &dyn PinStrength, s: PinSize, f: f64) -> [f64; PIN_QUANTITIES] {
    m.quantities(&s, &force(f)).expect("inside")
}

const OVAL: usize = PinQuantity::Ovalisation as usize;
const DEFLECTION: usize = PinQuantity::Deflection as usize;
const BENDING: usize = PinQuantity::BendingStress as usize;
const HOOP: usize = PinQuantity::OvalisationStress as usize;
const SHEAR: usize = PinQuantity::ShearStress as usize;

/// Computed from the listing by an independent program, nine digits: length, diameters; ovalisation, deflection, boss pressure,
/// bending, hoop, shear, resultant; masses.
#[test]
fn four_more_pins() {
    let m = model("thin_ring", PUBLISHED_PI);
    let d = published_design(&*m, PUBLISHED_PI);
    for (size, want, masses) in [
        (
            mm(54.0, 21.85, 17.0),
            [0.28621522, 0.0324117238, 8.39775999, 54.4019002, 113.645884, 33.1810544, 125.995848],
            (62.7315563, 98.9885343),
        ),
        (
            mm(60.0, 23.0, 14.5),
            [0.0430352576, 0.025327701, 6.52734981, 38.7896301, 32.1426806, 19.1714334, 50.376456],
            (117.912809, 72.5460827),
        ),
        (
            mm(63.0, 21.2, 13.4),
            [0.0416622356, 0.0394153921, 6.49142886, 51.9932816, 33.5417927, 22.6508796, 61.8736874],
            (104.826429, 60.2377202),
        ),
        (
            mm(61.9, 21.85, 0.0),
            [0.000485789342, 0.0281644125, 6.49683437, 39.2445318, 2.74724781, 8.82053051, 39.3405726],
            (182.201972, 64.6738032),
        ),
    ] {
        let q = m.quantities(&size, &d.load).expect("inside");
        let got = [1e3 * q[1], 1e3 * q[2], q[0] / KGF, q[4] / KGF, q[5] / KGF, q[6] / KGF, q[7] / KGF];
        for (g, w) in got.iter().zip(want) {
            // Half of the ninth digit.
            assert!((g / w - 1.0).abs() < 6e-9, "{size:?}: {g} {w}");
        }
        let k = d.masses(&size);
        assert!(
            (1e3 * k.pin / masses.0 - 1.0).abs() < 6e-9 && (1e3 * k.relieved / masses.1 - 1.0).abs() < 6e-9
        );
    }
}

/// Composite Gauss rule of three points on `n` parts.
fn integral(from: f64, to: f64, n: usize, f: impl Fn(f64) -> f64) -> f64 {
    let h = (to - from) / n as f64;
    let g = 0.6f64.sqrt();
    (0..n)
        .map(|k| {
            let m = from + h * (k as f64 + 0.5);
            h / 18.0 * (5.0 * f(m - 0.5 * h * g) + 8.0 * f(m) + 5.0 * f(m + 0.5 * h * g))
        })
        .sum()
}

/// Ring of mean radius r under a pressure uniform over its projection, moment by equilibrium, closed by energy: the thin-ring formulas.
#[test]
fn the_thin_ring_is_the_ring_under_a_projected_load() {
    let m = model("thin_ring", PI);
    let (size, f) = (mm(60.0, 22.0, 15.0), 5e4);
    let q = at(&*m, size, f);
    let (r, h) = ((size.outer + size.inner) / 4.0, (size.outer - size.inner) / 2.0);
    let inertia = size.length * h.powi(3) / 12.0;
    // Straightening moment from the side, without and with the unknown there; a quarter has no mean rotation.
    let bare = |t: f64| 0.25 * f * r * t.sin().powi(2);
    let unknown = -integral(0.0, PI / 2.0, 64, bare) / (PI / 2.0);
    let moment = |t: f64| bare(t) + unknown;
    let unit = |t: f64| 0.5 * r * (1.0 - t.cos());
    let change =
        4.0 * integral(0.0, PI / 2.0, 64, |t| moment(t) * unit(t) * r) / (strength_ctx(PI).modulus * inertia);
    // The rule is exact to 1e-12 here.
    assert!((q[OVAL] / change - 1.0).abs() < 1e-11, "{} {change}", q[OVAL]);
    let stress = 6.0 * moment(0.0).abs() / (size.length * h * h);
    assert!((q[HOOP] / stress - 1.0).abs() < 1e-11);
}

/// The curved bar: its closed form against the energy integrals of its own theory.
#[test]
fn the_curved_ring_is_the_energy_of_the_curved_bar() {
    let m = model("curved_ring", PI);
    for inner in [6.0, 10.0, 14.0, 19.0] {
        let (size, f) = (mm(60.0, 22.0, inner), 5e4);
        let q = at(&*m, size, f);
        let (ro, ri) = (size.outer / 2.0, size.inner / 2.0);
        let (r, h) = ((ro + ri) / 2.0, ro - ri);
        let a = h * size.length;
        let e = r - h / (ro / ri).ln();
        let c = strength_ctx(PI);
        let g = c.modulus / (2.0 * (1.0 + c.poisson));
        // Half of the force rises through the side; the load on the outer surface takes it away.
        let bare = |t: f64| 0.5 * f * (1.0 - t.cos()) * (r - 0.5 * ro * (1.0 + t.cos()) + r * t.cos());
        let normal = |t: f64| -0.5 * f * t.cos().powi(2);
        let shear = |t: f64| 0.5 * f * t.sin() * t.cos();
        let no_turn = integral(0.0, PI / 2.0, 64, |t| bare(t) / e - normal(t)) * e / (PI / 2.0);
        let moment = |t: f64| bare(t) - no_turn;
        let (m1, n1, v1) =
            (|t: f64| 0.5 * r * (1.0 - t.cos()), |t: f64| -0.5 * t.cos(), |t: f64| 0.5 * t.sin());
        let change = 4.0
            * integral(0.0, PI / 2.0, 64, |t| {
                moment(t) * m1(t) / (a * e * c.modulus) + normal(t) * n1(t) * r / (a * c.modulus)
                    - (moment(t) * n1(t) + normal(t) * m1(t)) / (a * c.modulus)
                    + 1.2 * shear(t) * v1(t) * r / (a * g)
            });
        assert!((q[OVAL] / change - 1.0).abs() < 1e-11, "{inner}: {} {change}", q[OVAL]);
        let side = (normal(0.0) / a + moment(0.0) * (r - e - ri) / (a * e * ri)).abs();
        assert!((q[HOOP] / side - 1.0).abs() < 1e-11, "{inner}");
    }
}

/// Displacement and stress at the outer and inner surface by Michell's series, solved numerically term by term.
#[test]
fn the_elastic_ring_is_michells_series() {
    for (plane_strain, inner) in [(false, 3.0), (false, 14.0), (true, 14.0), (true, 20.0)] {
        let s: Box<dyn PinStrengthSpec> =
            spec(serde_json::json!({ "model": "elastic_ring", "plane_strain": plane_strain }));
        let c = strength_ctx(PI);
        let m = s.build(&c).expect("builds");
        let (size, f) = (mm(60.0, 22.0, inner), 5e4);
        let q = at(&*m, size, f);
        // Radii in units of the outer one; stress functions r², r⁴, r⁻², 1 times cos 2θ.
        let k = size.inner / size.outer;
        let p = f / (2.0 * size.outer * size.length);
        let radial = |r: f64| [-2.0, 0.0, -6.0 * r.powi(-4), -4.0 * r.powi(-2)];
        let tangential = |r: f64| [2.0, 6.0 * r * r, -6.0 * r.powi(-4), -2.0 * r.powi(-2)];
        let rows = [radial(k), tangential(k), radial(1.0), tangential(1.0)];
        let mut a: Vec<Vec<f64>> =
            rows.iter().zip([0.0, 0.0, p, -p]).map(|(r, b)| [r.as_slice(), &[b]].concat()).collect();
        for c in 0..4 {
            let pivot = (c..4).max_by(|i, j| a[*i][c].abs().total_cmp(&a[*j][c].abs())).expect("rows");
            a.swap(c, pivot);
            for i in 0..4 {
                if i != c {
                    let t = a[i][c] / a[c][c];
                    for j in 0..5 {
                        a[i][j] -= t * a[c][j];
                    }
                }
            }
        }
        let x: Vec<f64> = (0..4).map(|i| a[i][4] / a[i][i]).collect();
        let nu = c.poisson;
        let kappa = if plane_strain { 3.0 - 4.0 * nu } else { (3.0 - nu) / (1.0 + nu) };
        let g = c.modulus / (2.0 * (1.0 + nu));
        let second = (-2.0 * x[0] + (kappa - 3.0) * x[1] + 2.0 * x[2] + (kappa + 1.0) * x[3]) / (2.0 * g);
        // Lamé's ring under the uniform part, from its own stresses.
        let (e1, n1) =
            if plane_strain { (c.modulus / (1.0 - nu * nu), nu / (1.0 - nu)) } else { (c.modulus, nu) };
        let uniform = -p / e1 * ((1.0 + k * k) / (1.0 - k * k) - n1);
        let shortening = -2.0 * (0.5 * size.outer) * (uniform - second);
        assert!((q[OVAL] / shortening - 1.0).abs() < 1e-9, "{inner}: {} {shortening}", q[OVAL]);
        let side = -2.0 * p / (1.0 - k * k) + 2.0 * x[0] + 12.0 * x[1] * k * k + 6.0 * x[2] * k.powi(-4);
        assert!((q[HOOP] / side.abs() - 1.0).abs() < 1e-9, "{inner}");
    }
}

#[test]
fn rings_agree_where_they_must() {
    let [curved, elastic, beam, thin] = MODELS.map(|n| model(n, PI));
    // A wall of a thousandth of the diameter: differences of the order of the wall.
    let s = mm(60.0, 22.0, 21.96);
    for k in [OVAL, HOOP] {
        let t = at(&*thin, s, 1e3)[k];
        for m in [&curved, &elastic] {
            assert!((at(&**m, s, 1e3)[k] / t - 1.0).abs() < 5e-3, "{k}");
        }
    }
    // A solid pin is in uniaxial compression: F/(L E), exactly.
    let solid = mm(60.0, 22.0, 0.0);
    let e = strength_ctx(PI).modulus;
    assert!((at(&*elastic, solid, 5e4)[OVAL] / (5e4 / (60e-3 * e)) - 1.0).abs() < 1e-14);
    // What is stated of the wall of the published pin.
    let p = mm(61.9, 21.85, 13.94);
    let ratio = |m: &dyn PinStrength, n: &dyn PinStrength, k| at(m, p, 5e4)[k] / at(n, p, 5e4)[k];
    assert!(
        (ratio(&*curved, &*elastic, OVAL) - 1.04).abs() < 0.005
            && (ratio(&*curved, &*elastic, HOOP) - 0.97).abs() < 0.005
    );
    assert!((ratio(&*elastic, &*thin, HOOP) - 1.28).abs() < 0.005);
    assert!(curved.quantities(&mm(61.9, 22.0, 5.0), &force(5e4)).is_err_and(|e| e.is_recoverable()));
    // The beam: shear more than doubles the deflection.
    assert!((ratio(&*beam, &*thin, DEFLECTION) - 2.35).abs() < 0.02);
}

/// Moment and deflection of the beam by integration of its load.
#[test]
fn the_beam_is_the_beam_under_its_load() {
    let c = strength_ctx(PI);
    for (name, with_shear) in [("thin_ring", false), ("shear_beam", false), ("shear_beam", true)] {
        let json = match name {
            "thin_ring" => serde_json::json!({ "model": name }),
            _ => serde_json::json!({ "model": name, "shear": with_shear }),
        };
        let s: Box<dyn PinStrengthSpec> = spec(json);
        let m = s.build(&c).expect("builds");
        let (size, f) = (mm(61.9, 21.85, 13.94), 5e4);
        let q = at(&*m, size, f);
        let (a, b) = ((size.length + c.boss_gap) / 2.0, c.rod_width);
        let j = PI * (size.outer.powi(4) - size.inner.powi(4)) / 64.0;
        // From the left support to the middle.
        let begin = (a - b) / 2.0;
        let shear = |x: f64| 0.5 * f - f * ((x - begin) / b).max(0.0);
        let moment = |x: f64| 0.5 * f * x - 0.5 * f / b * (x - begin).max(0.0).powi(2);
        let z = 2.0 * j / size.outer;
        assert!((q[BENDING] / (moment(0.5 * a) / z) - 1.0).abs() < 1e-12);
        if name == "thin_ring" {
            continue;
        }
        let parts = |g: &dyn Fn(f64) -> f64| integral(0.0, begin, 64, g) + integral(begin, 0.5 * a, 64, g);
        let mut deflection = 2.0 * parts(&|x| moment(x) * 0.5 * x) / (c.modulus * j);
        if with_shear {
            let (rho, nu) = (size.inner / size.outer, c.poisson);
            let s = (1.0 + rho * rho).powi(2);
            let kappa = 6.0 * (1.0 + nu) * s / ((7.0 + 6.0 * nu) * s + (20.0 + 12.0 * nu) * rho * rho);
            // The specification of this pin prints 0.5713.
            assert!((kappa - 0.5713).abs() < 5e-5);
            let area = PI * (size.outer.powi(2) - size.inner.powi(2)) / 4.0;
            deflection += 2.0 * parts(&|x| 0.5 * shear(x)) / (kappa * area * c.modulus / (2.0 * (1.0 + nu)));
        }
        assert!(
            (q[DEFLECTION] / deflection - 1.0).abs() < 1e-11,
            "{with_shear}: {} {deflection}",
            q[DEFLECTION]
        );
    }
}

#[test]
fn the_shear_stress_is_that_of_a_thick_tube() {
    let m = model("shear_beam", PI);
    let (s, f) = (mm(61.9, 21.85, 13.94), 5e4);
    // V Q/(J b) at the neutral plane.
    let (o, i) = (s.outer, s.inner);
    let first = (o.powi(3) - i.powi(3)) / 12.0;
    let j = PI * (o.powi(4) - i.powi(4)) / 64.0;
    let exact = 0.5 * f * first / (j * (o - i));
    assert!((at(&*m, s, f)[SHEAR] / exact - 1.0).abs() < 1e-14);
    // The published coefficient 0.85 for 8/(3π).
    let thin = model("thin_ring", PI);
    assert!((at(&*thin, s, f)[SHEAR] / exact - 0.85 * 3.0 * PI / 8.0).abs() < 1e-14);
}

#[test]
fn the_relief_is_two_segments() {
    let m = model("thin_ring", PI);
    let d = published_design(&*m, PI);
    for length in [30e-3, 62e-3, 84e-3] {
        let area = 4.0
            * integral(0.0, 1.0, 4000, |t| {
                // Substitution that makes the circle smooth: x = D/2 - (D/2 - L/2) (1 - t)².
                let w = 0.5 * (BORE - length);
                let x = 0.5 * BORE - w * (1.0 - t).powi(2);
                ((0.5 * BORE).powi(2) - x * x).max(0.0).sqrt() * 2.0 * w * (1.0 - t)
            });
        let m = d.masses(&PinSize { length, outer: 20e-3, inner: 0.0 }).relieved;
        assert!((m / (area * 26e-3 * 2690.0) - 1.0).abs() < 1e-9, "{length}");
    }
}

#[test]
fn what_solvers_rely_on_holds_everywhere() {
    let mut r = Random(3);
    for name in MODELS {
        let m = model(name, PI);
        for bore in [BossBore::Profiled, BossBore::Cylindrical] {
            let s: Box<dyn PinStrengthSpec> = spec(serde_json::json!({ "model": name }));
            let m2 = s.build(&PinStrengthCtx { boss_bore: bore, ..strength_ctx(PI) }).expect("builds");
            for _ in 0..4000 {
                let outer = r.between(8e-3, 60e-3);
                let inner = outer * r.between(m.min_bore_ratio().max(1e-3), 0.97);
                let size = PinSize { length: r.between(27.5e-3, 120e-3), outer, inner };
                let load = PinForces { gas: 5e4, inertia: -1e3 };
                let e = m2.expansion(&size, &load).expect("inside");
                assert_eq!(
                    e.value,
                    m2.quantities(&size, &load).expect("inside"),
                    "derivatives change no value"
                );
                for q in PinQuantity::ALL {
                    let k = q as usize;
                    let [by_length, by_outer, by_inner] = e.gradient[k];
                    // Rounding of derivatives that are zero, by their own scale.
                    let tiny = 1e-12 * e.value[k] / size.outer;
                    assert!(
                        by_outer <= tiny && by_inner >= -tiny,
                        "{name} {q:?} {size:?}: {:?}",
                        e.gradient[k]
                    );
                    match q {
                        PinQuantity::Deflection | PinQuantity::BendingStress => assert!(by_length >= -tiny),
                        PinQuantity::ResultantStress => {}
                        _ => assert!(by_length <= tiny, "{name} {q:?}"),
                    }
                }
                assert_eq!(e.gradient[PinQuantity::RodPressure as usize][0], 0.0);
            }
        }
    }
}

#[test]
fn derivatives_are_those_of_differences() {
    for name in MODELS {
        let m = model(name, PI);
        let (s, load) = (mm(63.0, 21.2, 13.4), published_load(PI).design.forces);
        let e = m.expansion(&s, &load).expect("inside");
        let d = 1e-7;
        for v in 0..3 {
            let moved = |t: f64| {
                let mut s = s;
                *[&mut s.length, &mut s.outer, &mut s.inner][v] += t;
                m.expansion(&s, &load).expect("inside")
            };
            let (a, b) = (moved(d), moved(-d));
            for k in 0..PIN_QUANTITIES {
                let central = (a.value[k] - b.value[k]) / (2.0 * d);
                // Truncation (d/length)² of the third derivative, rounding 1e-16/1e-5.
                assert!(
                    (e.gradient[k][v] - central).abs() < 1e-7 * (central.abs() + e.value[k] / s.outer),
                    "{name} {k} {v}"
                );
                for w in 0..3 {
                    let second = (a.gradient[k][w] - b.gradient[k][w]) / (2.0 * d);
                    let place = [[0, 1, 2], [1, 3, 4], [2, 4, 5]][v][w];
                    let size = e.value[k] / (s.outer * s.outer);
                    assert!(
                        (e.hessian[k][place] - second).abs() < 1e-6 * (second.abs() + size),
                        "{name} {k} {v} {w}"
                    );
                }
            }
        }
    }
    // Printed partial derivatives of the published pin, three or four digits, per millimetre.
    let m = model("thin_ring", PI);
    let e = m.expansion(&mm(61.9, 21.85, 13.94), &published_load(PI).design.forces).expect("inside");
    for (got, want) in [
        (e.gradient[OVAL][0], -7.27e-4),
        (e.gradient[BENDING][0] / KGF * 1e-3, 0.725),
        (e.gradient[OVAL][2], 0.02084),
        (e.gradient[BENDING][2] / KGF * 1e-3, 2.680),
        (e.gradient[HOOP][2] / KGF * 1e-3, 9.641),
        (e.gradient[OVAL][1], -0.01329),
        (e.gradient[DEFLECTION][1], -0.00741),
        (e.gradient[BENDING][1] / KGF * 1e-3, -8.168),
    ] {
        assert!((got / want - 1.0).abs() < 1e-3, "{got} {want}");
    }
}

#[test]
fn nonsense_is_refused() {
    let m = model("thin_ring", PI);
    let f = force(5e4);
    for s in [
        mm(27.0, 21.0, 13.0),
        mm(60.0, 13.0, 13.0),
        mm(60.0, 13.0, -1.0),
        mm(f64::NAN, 21.0, 13.0),
        mm(60.0, f64::INFINITY, 13.0),
        mm(60.0, 21.0, f64::NAN),
    ] {
        assert!(m.quantities(&s, &f).is_err_and(|e| e.is_recoverable()), "{s:?}");
        assert!(m.expansion(&s, &f).is_err());
    }
    assert!(m.quantities(&mm(60.0, 21.0, 13.0), &force(f64::NAN)).is_err());
    // A wall of rounding overflows nothing that is handed out.
    let thin = PinSize { inner: 21e-3 * (1.0 - 1e-16), ..mm(60.0, 21.0, 0.0) };
    if let Ok(q) = m.quantities(&thin, &f) {
        assert!(q.iter().all(|v| v.is_finite()));
    }
    let s: Box<dyn PinStrengthSpec> = spec(serde_json::json!({ "model": "thin_ring" }));
    let c = strength_ctx(PI);
    for (field, ctx) in [
        ("rod_width", PinStrengthCtx { rod_width: 28e-3, ..c }),
        ("poisson", PinStrengthCtx { poisson: 0.6, ..c }),
        ("modulus", PinStrengthCtx { modulus: -1.0, ..c }),
        ("boss_gap", PinStrengthCtx { boss_gap: f64::NAN, ..c }),
    ] {
        assert_eq!(s.build(&ctx).expect_err("refused").field, field);
    }
}

/// The pressure centres of profiled bores lie in the middle of their bosses, of cylindrical ones a quarter of their length from the gap:
/// bending and deflection follow from the beam on these supports.
#[test]
fn the_form_of_the_boss_bore_moves_the_supports() {
    let (size, f) = (mm(61.9, 21.85, 13.94), 5e4);
    let s: Box<dyn PinStrengthSpec> = spec(serde_json::json!({ "model": "thin_ring" }));
    let j = PI * (size.outer.powi(4) - size.inner.powi(4)) / 64.0;
    let c = strength_ctx(PI);
    for (boss_bore, part) in [(BossBore::Profiled, 0.5), (BossBore::Cylindrical, 0.25)] {
        let m = s.build(&PinStrengthCtx { boss_bore, ..c }).expect("builds");
        let q = at(&*m, size, f);
        let a = c.boss_gap + 2.0 * part * 0.5 * (size.length - c.boss_gap);
        let gamma = 1.0 - c.rod_width / (2.0 * a);
        let bending = gamma * f * a / 4.0 / (2.0 * j / size.outer);
        let deflection = gamma * a.powi(3) * f / (48.0 * c.modulus * j);
        // Rounding of a few operations.
        assert!((q[BENDING] / bending - 1.0).abs() < 1e-13, "{boss_bore:?}");
        assert!((q[DEFLECTION] / deflection - 1.0).abs() < 1e-13, "{boss_bore:?}");
    }
}

/// The published ovalisation takes the gas force alone, everything else the sum; a force that pulls loads as one that pushes.
#[test]
fn forces_count_by_their_amount() {
    let size = mm(61.9, 21.85, 13.94);
    for name in MODELS {
        let m = model(name, PI);
        let of = |gas: f64, inertia: f64| m.quantities(&size, &PinForces { gas, inertia }).expect("inside");
        let (push, pull) = (of(5e4, -1e4), of(-5e4, 1e4));
        assert_eq!(push, pull);
        let (alone, sum) = (of(5e4, 0.0), of(4e4, 0.0));
        let gas_alone = name == "thin_ring" || name == "shear_beam";
        assert_eq!(push[OVAL], if gas_alone { alone[OVAL] } else { sum[OVAL] }, "{name}");
        assert_eq!((push[BENDING], push[HOOP], push[0]), (sum[BENDING], sum[HOOP], sum[0]));
        let e = m.expansion(&size, &PinForces { gas: -5e4, inertia: 1e4 }).expect("inside");
        assert_eq!(e.value, push);
    }
}

#[test]
fn surroundings_at_the_edge_of_what_can_be() {
    let s: Box<dyn PinStrengthSpec> = spec(serde_json::json!({ "model": "thin_ring" }));
    let c = strength_ctx(PI);
    for ctx in [
        PinStrengthCtx { rod_width: c.boss_gap, ..c },
        PinStrengthCtx { poisson: 0.5, ..c },
        PinStrengthCtx { poisson: -0.9, ..c },
    ] {
        assert!(s.build(&ctx).is_ok(), "{ctx:?}");
    }
    for (field, ctx) in [
        ("poisson", PinStrengthCtx { poisson: -1.0, ..c }),
        ("rod_width", PinStrengthCtx { rod_width: 0.0, ..c }),
        ("pi", PinStrengthCtx { pi: f64::INFINITY, ..c }),
    ] {
        assert_eq!(s.build(&ctx).expect_err("refused").field, field);
    }
    // The curved bar holds from a quarter of the outer diameter on, that ratio included.
    let m = model("curved_ring", PI);
    assert!(m.quantities(&mm(61.9, 22.0, 5.5), &force(5e4)).is_ok());
    assert!(m.quantities(&mm(61.9, 22.0, 5.499), &force(5e4)).is_err());
}
