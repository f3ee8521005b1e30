//! Films, contact and crank drive of the EA111 skirt of Loureiro (2009) at points that another implementation evaluated.

use std::f64::consts::PI;

use gudgeon_core::file::Files;
use gudgeon_core::kinds::{
    Film2dCtx, Film2dGrid, Film2dIn, Film2dSpec, LateralLoads, PistonMotion, SkirtProfileCtx,
    SkirtProfileSpec,
};
use gudgeon_core::quantity::quantity;
use gudgeon_film::film_2d::{Cavitation, CentralDifferences, Direct, Equations, Flux, Multigrid};
use gudgeon_film::{SawtoothWaviness, SmoothSurfaces, WavinessTransport};
use gudgeon_skirt::{
    ContactGrid, Crank, Cylindrical, Instant, Momentum, Panel, Partials, Piston, Side, SideLoads, SideSetup,
    Slopes,
};

use crate::common::*;

/// Speed away from the head, acceleration and rod angle \[deg\] at a crank angle.
fn drive(deg: f64) -> (f64, f64, f64) {
    let c = crank();
    let k = slider_crank(&c, deg);
    let now = c.instant(deg.to_radians(), &k, 0.0, 0.0, 0.016);
    (now.speed, now.acceleration, -now.tangent.atan().to_degrees())
}

/// Crank angle, eccentricities \[µm\], rates \[µm/s\]; per side lateral force, moment, friction, its moment; in brackets the lateral forces with 40
/// intervals.
#[allow(clippy::type_complexity)]
const POINTS: [(f64, [f64; 2], [f64; 2], [[f64; 4]; 2], [f64; 2]); 6] = [
    (
        90.0,
        [-2.8, -3.7],
        [0.0, 0.0],
        [[0.0, 0.0, -51.399, 1.82127], [-590.11, 3.84285, -16.843, -0.62238]],
        [0.0, -596.44],
    ),
    (
        330.0,
        [0.5, -2.5],
        [400.0, -100.0],
        [[2205.20, -24.8245, 20.483, -0.72429], [-2.540, -0.01279, 13.115, 0.48478]],
        [2242.25, -5.598],
    ),
    (
        390.0,
        [1.5, -3.3],
        [-800.0, -100.0],
        [[779.55, -0.83575, -20.850, 0.73726], [-85.707, 1.39713, -13.695, -0.50628]],
        [776.71, -85.308],
    ),
    (
        390.0,
        [-0.5, -3.0],
        [-500.0, -50.0],
        [[1725.80, -5.60753, -23.177, 0.81979], [-14.847, 0.26577, -12.117, -0.44783]],
        [1729.02, -15.675],
    ),
    (
        440.0,
        [-2.3, -3.45],
        [-240.0, -90.0],
        [[1151.20, -3.99497, -48.394, 1.71381], [-57.264, 0.75815, -17.991, -0.66480]],
        [1154.30, -57.727],
    ),
    (
        180.0,
        [-2.0, -3.0],
        [100.0, 200.0],
        [[0.0, 0.0, 0.1494, -0.00529], [-785.64, 5.46705, 0.0483, 0.00178]],
        [0.0, -793.76],
    ),
];

/// Lateral force, moment about the pin, friction and its moment.
fn loads(side: &mut Side, deg: f64, e: [f64; 2], v: [f64; 2]) -> [f64; 4] {
    let micro = |v: [f64; 2]| [v[0] * 1e-6, v[1] * 1e-6];
    let (speed, _, _) = drive(deg);
    side.place(micro(e), &[], speed).expect("a film");
    let mut l = SideLoads::default();
    side.loads(speed, 0.016, &micro(v), Slopes::Film, &mut l).expect("a film");
    let [force, moment] = body().about_pin([l.film[0], l.film[1]]);
    [force, moment, l.film[2], -side.sign * l.film[3] + crank().pin_offset * l.film[2]]
}

#[test]
fn static_points_on_the_published_mesh() {
    let roughness = waves(WavinessTransport::AsPublished);
    let setup = Setup { film: &CentralDifferences::default(), roughness: &roughness, intervals: 9 };
    let mut sides = [side(0, &setup), side(1, &setup)];
    for (deg, e, v, expected, _) in POINTS {
        for (k, side) in sides.iter_mut().enumerate() {
            let got = loads(side, deg, e, v);
            // A thousandth, and the last digit printed. The gradient of a pressure that is cut off is differenced in another way here: up to 0.035 N
            // of friction (and 40 mm times that), less than a thousandth of the 54 N of the centred skirt.
            let admitted = [0.005, 5e-5, 0.035, 0.035 * 0.04];
            for q in 0..4 {
                let d = (got[q] - expected[k][q]).abs();
                assert!(
                    d <= 1e-3 * expected[k][q].abs() + admitted[q],
                    "{deg} {k} {q}: {got:?} {:?}",
                    expected[k]
                );
            }
        }
    }
}

#[test]
fn static_points_with_exact_transport() {
    // Lateral forces of both sides at the same points with the exact sign of the transport by waves, on the published mesh.
    let exact =
        [[0.0, -710.48], [4658.47, 0.0], [1.30, -609.64], [121.75, -119.74], [0.0, -223.32], [0.0, -785.02]];
    let roughness = waves(WavinessTransport::Homogenised);
    let setup = Setup { film: &CentralDifferences::default(), roughness: &roughness, intervals: 9 };
    let mut sides = [side(0, &setup), side(1, &setup)];
    for ((deg, e, v, ..), expected) in POINTS.into_iter().zip(exact) {
        for (k, side) in sides.iter_mut().enumerate() {
            let force = loads(side, deg, e, v)[0];
            // A thousandth, and the last digit printed.
            assert!((force - expected[k]).abs() <= 1e-3 * expected[k].abs() + 0.005, "{deg} {k}: {force}");
        }
    }
}

#[test]
fn finite_volumes_come_to_the_same_forces() {
    // Lateral forces with 40 intervals of the expanded equation, which converges with the square of the spacing like the finite volumes here: both are
    // within a thousandth (and 0.1 N) of 80 intervals.
    let roughness = waves(WavinessTransport::AsPublished);
    let film = Multigrid { cavitation: Cavitation::HalfSommerfeld, ..Multigrid::default() };
    let mut by_mesh = Vec::new();
    for n in [20, 40, 80] {
        let setup = Setup { film: &film, roughness: &roughness, intervals: n };
        let mut sides = [side(0, &setup), side(1, &setup)];
        by_mesh.push(POINTS.map(|(deg, e, v, ..)| [0, 1].map(|k| loads(&mut sides[k], deg, e, v)[0])));
    }
    for (p, point) in POINTS.iter().enumerate() {
        for k in 0..2 {
            let (coarse, middle, fine) = (by_mesh[0][p][k], by_mesh[1][p][k], by_mesh[2][p][k]);
            assert!((middle - point.4[k]).abs() <= 1e-3 * point.4[k].abs() + 0.1, "{p} {k}: {middle}");
            // Second order: four times closer with every halving, but for where the film is cut.
            if fine.abs() > 500.0 && p != 2 && p != 3 {
                let ratio = (coarse - middle) / (middle - fine);
                assert!((2.5..7.0).contains(&ratio), "{p} {k}: {ratio}");
            }
        }
    }
}

#[test]
fn crests_touch_at_the_lower_edge() {
    // Eccentricities -1 and -6.2 um, rows of crests down to the lower edge: 230.65 N, -4.98438 N m, 34.763 N of friction.
    let roughness = waves(WavinessTransport::AsPublished);
    let setup = Setup { film: &CentralDifferences::default(), roughness: &roughness, intervals: 9 };
    let mut thrust = side(0, &setup);
    thrust.place([-1e-6, -6.2e-6], &[], 0.0).expect("a film");
    let mut l = SideLoads::default();
    thrust.loads(0.0, 0.016, &[0.0; 2], Slopes::None, &mut l).expect("a film");
    let [force, moment] = body().about_pin([l.contact[0], l.contact[1]]);
    // Half a unit of the last digit printed.
    assert!((force - 230.65).abs() < 0.005 && (moment + 4.98438).abs() < 5e-6, "{force} {moment}");
    assert!((0.15 * l.contact[2] - 34.763).abs() < 5e-4, "{}", l.contact[2]);
    assert_eq!(thrust.contact_sums(), 1);
    // The program of the source went on with its rows to 33.75 mm, beyond the lower edge: 6379.8 N and 974.1 N of friction. A skirt so long has them.
    let panel = Panel { length: 0.0338, ..thrust.panel };
    let mut long = side_of(panel, 1.0, &setup);
    long.place([-1e-6, -1e-6 - 5.2e-6 * 0.0338 / LENGTH], &[], 0.0).expect("a film");
    long.loads(0.0, 0.016, &[0.0; 2], Slopes::None, &mut l).expect("a film");
    let force = l.contact[0] + l.contact[1];
    assert!((force - 6379.8).abs() < 0.05 && (0.15 * l.contact[2] - 974.1).abs() < 0.05, "{force}");
    // Away from contact nothing is summed.
    thrust.place([-1e-6, -5.9e-6], &[], 0.0).expect("a film");
    assert_eq!(thrust.contact_sums(), 1);
}

#[test]
fn crank_drive() {
    // U1, U2: rod angles and speed; speed, acceleration and rod angle at the static points.
    let most = |l: f64| {
        let c = Crank { rod_length: l, ..crank() };
        (0..7200)
            .map(|k| {
                -c.instant((f64::from(k) * 0.1).to_radians(), &PistonMotion::default(), 0.0, 0.0, 0.0)
                    .tangent
                    .atan()
            })
            .fold(0.0_f64, |a, b| a.max(b.abs()))
            .to_degrees()
    };
    for (l, deg) in [(0.136, 16.357), (0.144, 15.425), (0.152, 14.594)] {
        // Half a unit of the last digit; the tenth of a degree of the search costs 1e-5.
        assert!((most(l) - deg).abs() < 6e-4, "{l}: {}", most(l));
    }
    let points = [
        (90.0, 9.89602, -714.821, -15.4247),
        (330.0, -6.05214, 2599.594, 7.3412),
        (390.0, 6.11323, 2591.817, -7.7426),
        (440.0, 10.21217, -219.924, -15.1878),
        (180.0, -0.03436, -1910.681, -0.1989),
        (76.0, 10.242, f64::NAN, f64::NAN),
        (283.7, -10.224, f64::NAN, f64::NAN),
    ];
    for (deg, u, a, phi) in points {
        let (speed, acceleration, angle) = drive(deg);
        let near = |x: f64, y: f64, d: f64| assert!(y.is_nan() || (x - y).abs() < d, "{deg}: {x} {y}");
        // Half a unit of the last digit.
        near(speed, u, if a.is_nan() { 6e-4 } else { 6e-6 });
        near(acceleration, a, 6e-4);
        near(angle, phi, 6e-5);
    }
    // U3: inertia along the bore, of piston and of piston and pin.
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for k in 0..720 {
        let (_, a, _) = drive(0.5 * f64::from(k));
        (low, high) = (low.min(a), high.max(a));
    }
    // Half a unit.
    for (mass, least, most) in [(0.236, -451.0, 772.0), (0.288, -551.0, 942.0)] {
        assert!(
            (mass * low - least).abs() < 0.5 && (mass * high - most).abs() < 0.5,
            "{} {}",
            mass * low,
            mass * high
        );
    }
}

#[test]
fn flat_plates_and_concentric_drag() {
    // U9: plates of 47.5 mm by 30.3 mm, 10 um apart, approaching at 0.1 mm/s in oil of 16 mPa s: 1276.4 N by Fourier series. The side of a skirt
    // so narrow that it is flat.
    let panel_angle = 1e-3;
    let radius = 0.0475 / (2.0 * panel_angle);
    let panel = Panel { radius, length: 0.0303, half_angle: panel_angle };
    let profile = Cylindrical {}
        .build(&SkirtProfileCtx { length: 0.0303, radius, files: &Files::default() })
        .expect("builds");
    for (n, printed) in [(9, 1260.8), (20, 1273.4), (40, 1275.7)] {
        let grid = panel.grid(n, n, 0.0);
        let mut plate = Side::new(SideSetup {
            panel,
            sign: 1.0,
            clearance: 1e-5,
            grid: &grid,
            film: &CentralDifferences::default(),
            roughness: &SmoothSurfaces {},
            contact: &gudgeon_contact::Off {},
            boundary_friction: None,
            contact_grid: ContactGrid { pitch: 1e-3, intervals: 4 },
            profile: &*profile,
            compliance: rigid(&grid),
            shear_thinning: None,
            p_cav: 0.0,
            floor: 1e-9,
        })
        .expect("builds");
        plate.place([0.0; 2], &[], 0.0).expect("a film");
        let mut l = SideLoads::default();
        plate.loads(0.0, 0.016, &[-1e-4, -1e-4], Slopes::None, &mut l).expect("a film");
        let force = l.film[0] + l.film[1];
        // Half a unit of the last digit, and the curvature of the plate, 1e-6 of the force.
        assert!((force - printed).abs() < 0.06, "{n}: {force}");
    }
    // U10: drag of the centred skirt at 10.2418 m/s with crests of 4, 3 and 2 um.
    for (amplitude, printed) in [(4e-6, 54.09), (3e-6, 49.29), (2e-6, 46.13)] {
        let roughness = SawtoothWaviness {
            amplitude: quantity(amplitude),
            transport: WavinessTransport::AsPublished,
            closest: quantity(1.02),
        };
        let setup = Setup { film: &CentralDifferences::default(), roughness: &roughness, intervals: 9 };
        let drag: f64 = (0..2)
            .map(|k| {
                let mut s = side(k, &setup);
                s.place([0.0; 2], &[], 10.2418).expect("a film");
                let mut l = SideLoads::default();
                s.loads(10.2418, 0.016, &[0.0; 2], Slopes::None, &mut l).expect("a film");
                l.film[2]
            })
            .sum();
        // A thousandth.
        assert!((drag / -printed - 1.0).abs() < 1e-3, "{drag}");
    }
}

#[test]
fn forces_are_found_in_balance_wherever_the_piston_is() {
    let mut p = piston(WavinessTransport::AsPublished, 3.25e-4);
    let mut worst = 0;
    for deg in [0.0, 0.2, 7.3, 90.0, 180.0, 332.0, 360.0, 389.0, 541.0, 652.0, 719.9] {
        let c = crank();
        let motion = slider_crank(&c, deg);
        for pressure in [-2e4, 0.0, 7e3, 5e5, 5e6] {
            let now = c.instant(f64::to_radians(deg), &motion, pressure, 4.6e-3, 0.016);
            for e in [[0.0, 0.0], [-2.7, -3.7], [-5.2, 5.0], [5.9, 5.9], [-9.0, -8.0], [8.0, -12.0]] {
                let x = [e[0] * 1e-6, e[1] * 1e-6];
                let mut w = [0.0; 2];
                let before = p.newton_steps;
                p.ask(&now, &x, &mut w)
                    .balance()
                    .unwrap_or_else(|err| panic!("{deg} {pressure} {e:?}: {err}"));
                worst = worst.max(p.newton_steps - before);
                let s = p.summary(&now, &x, &w).expect("a film");
                // What rounding leaves of the largest force.
                let scale = 1.0
                    + s.film[0].abs()
                    + s.film[1].abs()
                    + s.contact[0].abs()
                    + s.contact[1].abs()
                    + s.rod.abs();
                assert!(
                    s.net[0].abs() < 1e-6 * scale && s.net[1].abs() < 1e-7 * scale,
                    "{deg} {pressure} {e:?}: {s:?}"
                );
            }
        }
    }
    assert!(p.newton_steps > 300, "every place takes some steps");
    assert!(worst < 30, "{worst} Newton steps");
}

#[test]
fn derivatives_are_those_of_the_rates() {
    // Differences of the rates themselves, for both motions, at a place with contact and one without.
    let mut p = piston(WavinessTransport::AsPublished, -3.25e-4);
    let c = crank();
    let deg: f64 = 401.0;
    let instant = |t: f64| c.instant(t, &slider_crank(&c, t.to_degrees()), 2e6, 4.6e-3, 0.016);
    let (t, dt) = (deg.to_radians(), 1e-6);
    let now = instant(t);
    for e in [[-0.5e-6, -2.1e-6], [1e-6, -6.1e-6]] {
        for given in [false, true] {
            let v = [-4e-4, -1e-4];
            // What the piston answers: velocities of a balance, or forces at given velocities.
            let mut ask = |now: &Instant, x: [f64; 2], v: [f64; 2]| {
                let mut w = [0.0; 2];
                let mut asked = p.ask(now, &x, &mut w);
                let answer = if given { asked.forces(v) } else { asked.balance() };
                (answer.expect("a balance"), w)
            };
            let later = instant(t + dt);
            let (here, then) = (ask(&now, e, v).0, ask(&later, e, v).0);
            let mut columns = Vec::new();
            for k in 0..if given { 4 } else { 2 } {
                let (mut x, mut u) = (e, v);
                let d = if k < 2 { 2e-11 } else { 1e-9 };
                if k < 2 {
                    x[k] -= d
                } else {
                    u[k - 2] -= d
                }
                let there = ask(&now, x, u).0;
                columns.push([0, 1].map(|r| (here[r] - there[r]) / d));
            }
            let (_, w) = ask(&now, e, v);
            let mut found = Partials::new(2);
            p.partials(&now, &e, &w, given, &mut found).expect("derivatives");
            let by_time = p.time_partials(&now, &e, &w, given, (&later, dt), &mut []).expect("derivatives");
            let all = [found.answer[0], found.answer[1], found.answer_by_v[0], found.answer_by_v[1]];
            for row in 0..2 {
                // The difference quotients are of first order, and the films are solved to 1e-9 of their flows.
                for pair in [0..2, 2..columns.len()] {
                    let scale = columns[pair.clone()].iter().map(|c| c[row].abs()).fold(0.0, f64::max);
                    for k in pair {
                        let (a, b) = (all[k][row], columns[k][row]);
                        assert!((a - b).abs() < 2e-3 * scale, "{e:?} {given} {row} {k}: {a} {b}");
                    }
                }
                let fresh = (then[row] - here[row]) / dt;
                let d = (by_time[row] - fresh).abs();
                assert!(d <= 1e-3 * fresh.abs() + 1e-9, "{e:?} {given} time {row}: {} {fresh}", by_time[row]);
            }
            // A force added to an edge: on given velocities it is the answer, a balance moves by the inverse of what resists.
            for (k, by) in found.answer_by_force.iter().enumerate() {
                if given {
                    assert_eq!(by[k], 1.0);
                    assert_eq!(by[1 - k], 0.0);
                } else {
                    // Films resist every motion, and the matrix of full films is symmetric; cavities and friction spoil that a little.
                    assert!(by[k] > 0.0, "{found:?}");
                }
            }
        }
    }
}

#[test]
fn shapes_yield_as_their_stiffness_says() {
    // A side that yields in one shape, loaded by a squeeze: the force on the shape is its pressure integral, and half the side is solved as the whole.
    let film = Direct { cavitation: Cavitation::HalfSommerfeld, ..Direct::default() };
    let mut s = yielding_side(&film, 1e-6);
    assert_eq!((s.nodes(), s.elastic()), (13 * 7, 2));
    let (e, q, w) = ([-1e-6, -2e-6], [4e-7, 2e-7], [-2e-4, -1e-4, 1e-5, -2e-5]);
    s.place(e, &q, 5.0).expect("a film");
    let mut l = SideLoads::default();
    s.loads(5.0, 0.016, &w, Slopes::Film, &mut l).expect("a film");
    let grid = s.grid().clone();
    let (wx, wy) = grid.weights();
    let p = s.pressure();
    for (k, f) in l.elastic.iter().enumerate() {
        let n = grid.len();
        let sum: f64 =
            (0..n).map(|i| wx[i % 13] * wy[i / 13] * s.compliance.shapes()[k * n + i] * p[i]).sum();
        // Rounding of a hundred terms; the weights of the half are those of the whole.
        assert!((sum / f - 1.0).abs() < 1e-9, "{k}: {f} {sum}");
    }
    // The full film of one that ruptures otherwise is the same.
    let other = Direct { cavitation: Cavitation::SwiftStieber, ..Direct::default() };
    let mut ruptured = yielding_side(&other, 1e-6);
    ruptured.place(e, &q, 5.0).expect("a film");
    let (mut own, mut full) = (SideLoads::default(), SideLoads::default());
    ruptured.loads(5.0, 0.016, &w, Slopes::Full, &mut own).expect("a film");
    s.loads(5.0, 0.016, &w, Slopes::Full, &mut full).expect("a film");
    assert_eq!(own.slope, full.slope);
    // What a full film does is symmetric: the force on one motion by another is that on the other by the one.
    s.loads(5.0, 0.016, &w, Slopes::Full, &mut l).expect("a film");
    let slope = |rate: usize, force: usize| l.slope[rate * 6 + if force < 2 { force } else { force + 2 }];
    for a in 0..4 {
        assert!(slope(a, a) < 0.0);
        for b in 0..4 {
            // The squeeze of rough surfaces acts with the content, the pressure with the gap: the same here, far from contact. Quadrature weights
            // differ from the areas of control volumes.
            assert!(
                (slope(a, b) - slope(b, a)).abs() < 0.02 * slope(a, a).abs(),
                "{a} {b}: {} {}",
                slope(a, b),
                slope(b, a)
            );
        }
    }
}

#[test]
fn loads_beside_are_those_of_a_film_there() {
    // Up and down, with the film of the nodes too: there the sense of motion says which node a flow has its film from.
    let ways = [Flux::Face, Flux::Node].into_iter().flat_map(|flux| [(flux, 5.0), (flux, -5.0)]);
    for (flux, speed) in ways {
        let film = Direct { cavitation: Cavitation::HalfSommerfeld, flux, ..Direct::default() };
        loads_beside_of(&film, speed);
    }
}

#[test]
fn loads_beside_without_superposition_are_solved_there() {
    for cavitation in [Cavitation::SwiftStieber, Cavitation::MassConserving] {
        let mut s = yielding_side(&Direct { cavitation, ..Direct::default() }, 1e-6);
        let (e, q, w) = ([-1e-6, -2e-6], [4e-7, 2e-7], [-2e-4, -1e-4, 1e-5, -2e-5]);
        s.place(e, &q, 5.0).expect("a film");
        let mut now = SideLoads::default();
        s.loads(5.0, 0.016, &w, Slopes::None, &mut now).expect("a film");
        let mut beside = vec![SideLoads::default(); 4];
        s.loads_beside(e, &q, &[1e-8; 4], 5.0, 0.016, &w, &mut beside).expect("films");
        for (c, beside) in beside.iter().enumerate() {
            let (mut e, mut q) = (e, q);
            if c < 2 {
                e[c] += 1e-8
            } else {
                q[c - 2] += 1e-8
            }
            s.place(e, &q, 5.0).expect("a film");
            let mut there = SideLoads::default();
            s.loads(5.0, 0.016, &w, Slopes::None, &mut there).expect("a film");
            for k in 0..2 {
                // Films are solved to 1e-9 of their flows, from different starts; ten nanometres change forces by some thousandths.
                assert!(
                    (beside.film[k] - there.film[k]).abs() < 1e-6 * there.film[k].abs(),
                    "{cavitation:?} {c} {k}"
                );
                assert!((beside.elastic[k] - there.elastic[k]).abs() < 1e-6 * there.elastic[k].abs());
            }
            assert!((there.film[0] - now.film[0]).abs() > 1e-5 * now.film[0].abs(), "{cavitation:?} {c}");
        }
    }
}

fn loads_beside_of(film: &dyn Film2dSpec, speed: f64) {
    // All coordinates, with a cavity and two shapes: the error of one Newton step is of second order in the way.
    let mut s = yielding_side(film, 1e-6);
    let (e, q, w) = ([-1e-6, -2e-6], [4e-7, 2e-7], [-2e-4, -1e-4, 1e-5, -2e-5]);
    let all = |l: &SideLoads| [&l.film[..], &l.elastic[..]].concat();
    let mut now = SideLoads::default();
    let mut far = [[0.0; 4]; 2];
    for (far, d) in far.iter_mut().zip([2e-9, 1e-9]) {
        s.place(e, &q, speed).expect("a film");
        s.loads(speed, 0.016, &w, Slopes::None, &mut now).expect("a film");
        let mut beside = vec![SideLoads::default(); 4];
        s.loads_beside(e, &q, &[d; 4], speed, 0.016, &w, &mut beside).expect("films");
        for c in 0..4 {
            let (mut e, mut q) = (e, q);
            if c < 2 {
                e[c] += d
            } else {
                q[c - 2] += d
            }
            s.place(e, &q, speed).expect("a film");
            let mut there = SideLoads::default();
            s.loads(speed, 0.016, &w, Slopes::None, &mut there).expect("a film");
            let (now, found, there) = (all(&now), all(&beside[c]), all(&there));
            let change = now.iter().zip(&there).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            let error = found.iter().zip(&there).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            // A way of 2 nm in gaps of 7 um: the terms of second order are some 1e-3 of those of first order.
            assert!(error < 5e-3 * change, "{c}: {found:?} {there:?} {now:?}");
            far[c] = error;
        }
    }
    for (c, (twice, once)) in far[0].iter().zip(&far[1]).enumerate() {
        // Nodes where the film is just cut off spoil it a little.
        assert!((3.0..5.0).contains(&(twice / once)), "{c}: {far:?}");
    }
}

/// Acceleration of both edges at the crank angle `t`.
fn acceleration(p: &mut Piston, t: f64, e: [f64; 2], v: [f64; 2]) -> Option<[f64; 2]> {
    let c = crank();
    // Gas of the exchange strokes: none.
    let now = c.instant(t, &slider_crank(&c, t.to_degrees()), 0.0, 4.6e-3, 0.016);
    let f = p.ask(&now, &e, &mut [0.0; 2]).forces(v).ok()?;
    let [[a, b], [_, d]] = p.body.matrix();
    let det = a * d - b * b;
    Some([(d * f[0] - b * f[1]) / det, (a * f[1] - b * f[0]) / det])
}

#[test]
fn published_explicit_scheme_diverges() {
    // Runge-Kutta of order four on the accelerations behind a filter of second order at 500 Hz, damping 0.707: e' = v, v' = the filtered
    // acceleration. The films damp the velocity at 1e6 to 5e7 1/s; behind a filter that is slower the loop needs 2 zeta w0 above that rate.
    let mut p = piston(WavinessTransport::AsPublished, -3.25e-4);
    let omega = crank().omega;
    let (w0, zeta) = (2.0 * PI * 500.0, 0.707);
    for step_deg in [0.1, 0.02, 0.005] {
        let h = f64::to_radians(step_deg) / omega;
        // Displacements, velocities, filtered accelerations and their rates.
        let mut y = [0.0; 8];
        let mut reached = 5.0;
        let slope = |p: &mut Piston, t: f64, y: &[f64; 8]| -> Option<[f64; 8]> {
            let a = acceleration(p, t, [y[0], y[1]], [y[2], y[3]])?;
            let filter = |k: usize| w0 * w0 * (a[k] - y[4 + k]) - 2.0 * zeta * w0 * y[6 + k];
            Some([y[2], y[3], y[4], y[5], y[6], y[7], filter(0), filter(1)])
        };
        let steps = (5.0 / step_deg) as usize;
        for k in 0..steps {
            let t = f64::to_radians(step_deg * k as f64);
            let half = 0.5 * h;
            let at = |y: &[f64; 8], d: &[f64; 8], h: f64| std::array::from_fn(|i| y[i] + h * d[i]);
            let next = (|| {
                let k1 = slope(&mut p, t, &y)?;
                let k2 = slope(&mut p, t + half * omega, &at(&y, &k1, half))?;
                let k3 = slope(&mut p, t + half * omega, &at(&y, &k2, half))?;
                let k4 = slope(&mut p, t + h * omega, &at(&y, &k3, h))?;
                Some(std::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i])))
            })();
            match next {
                // Beyond the clearance of 10 um there is no piston, and beyond ten times the largest velocity of the source no motion.
                Some(n) if n[0].abs().max(n[1].abs()) < 1e-5 && n[2].abs().max(n[3].abs()) < 0.016 => y = n,
                _ => {
                    reached = step_deg * k as f64;
                    break;
                }
            }
        }
        assert!(reached < 5.0, "steps of {step_deg} deg survive: {y:?}");
    }
    // The implicit step stands at the same place with a hundred times the largest of these steps.
    let c = crank();
    let now = c.instant(0.17, &slider_crank(&c, f64::to_degrees(0.17)), 0.0, 4.6e-3, 0.016);
    let (mut w, mut x) = ([0.0; 2], [0.0; 2]);
    let momentum = Some(Momentum { mass: p.body.matrix(), v: [0.0; 2] });
    p.euler_step(&now, &[0.0; 2], momentum, 0.17 / omega, &mut w, &mut x).expect("a step of ten degrees");
    assert!(x[0].abs() < 1e-6 && x[1].abs() < 1e-6, "{x:?}");
}

#[test]
fn poisson_test_of_the_source() {
    // Tables 5 and 6: u_xx + u_yy = u on the unit square, 0 on three sides and u(1, y) = y; six by six nodes. The stencil is that of a film of
    // uniform thickness with a sink, which no film has: so only the series and its nodes are checked here, against each other.
    let series = |x: f64, y: f64| {
        (1..400)
            .map(|n| {
                let k = (1.0 + (f64::from(n) * PI).powi(2)).sqrt();
                let ratio = ((k * (x - 1.0)).exp() - (-k * (x + 1.0)).exp()) / (1.0 - (-2.0 * k).exp());
                let sign = if n % 2 == 1 { 2.0 } else { -2.0 };
                sign / (f64::from(n) * PI) * ratio * (f64::from(n) * PI * y).sin()
            })
            .sum::<f64>()
    };
    // The corner takes the value of the side with the ramp, and the largest deviation of the printed nodes is 7 %.
    assert!((0.059_f64 / 0.055 - 1.07).abs() < 0.005);
    // Over-relaxation: the spectral radius 0.801 of Jacobi's iteration, the best factor 1.251; settled by the sixth sweep in the source's figure, here within
    // half a percent of the sum.
    let radius = 4.0 / 4.04 * (PI / 5.0).cos();
    let factor = 2.0 / (1.0 + (1.0 - radius * radius).sqrt());
    assert!((radius - 0.801).abs() < 5e-4 && (factor - 1.251).abs() < 5e-4, "{radius} {factor}");
    let mut u = [[0.0; 6]; 6];
    for (j, row) in u.iter_mut().enumerate() {
        row[5] = if j == 5 { 0.0 } else { 0.2 * j as f64 };
    }
    let mut by_sweep = Vec::new();
    for _ in 0..100 {
        for j in 1..5 {
            for i in 1..5 {
                let own = (u[j][i - 1] + u[j][i + 1] + u[j - 1][i] + u[j + 1][i]) / 4.04;
                u[j][i] += factor * (own - u[j][i]);
            }
        }
        by_sweep.push(u.concat().iter().sum::<f64>());
    }
    let left = by_sweep[5] / by_sweep[99] - 1.0;
    assert!(left.abs() < 6e-3, "{left}");
    let exact = [
        [0.018, 0.042, 0.079, 0.132],
        [0.031, 0.073, 0.143, 0.251],
        [0.033, 0.081, 0.170, 0.336],
        [0.021, 0.055, 0.127, 0.312],
    ];
    let numeric = [
        [0.018, 0.042, 0.077, 0.130],
        [0.031, 0.074, 0.141, 0.248],
        [0.034, 0.084, 0.170, 0.330],
        [0.023, 0.059, 0.134, 0.313],
    ];
    for j in 0..4 {
        for i in 0..4 {
            let (x, y) = (0.2 * (i + 1) as f64, 0.2 * (j + 1) as f64);
            // Printed with three decimals, some of them cut.
            assert!((series(x, y) - exact[j][i]).abs() < 1e-3, "{x} {y}: {}", series(x, y));
            assert!((u[j + 1][i + 1] - numeric[j][i]).abs() < 1e-3, "{x} {y}: {}", u[j + 1][i + 1]);
        }
    }
}

#[test]
fn slider_of_table_seven() {
    // 10 m/s on a wedge from 6.75 to 6.5 um over 33.8 mm, 16 mPa s, ten intervals; so wide that its middle is that of a slider without ends. The
    // second value stands as 1.1283 in the source.
    let printed = [0.0, 1.2183, 2.1821, 2.8856, 3.3226, 3.4872, 3.3731, 2.9740, 2.2832, 1.2942, 0.0];
    let grid = Film2dGrid::uniform(11, 41, 0.0338, 3.38);
    let mut film = CentralDifferences::default().build(&Film2dCtx { grid: &grid }).expect("builds");
    let h: Vec<f64> = (0..grid.len()).map(|k| 6.75e-6 - 0.25e-6 * grid.x[k % 11] / 0.0338).collect();
    film.solve(&Film2dIn::new(&h, 10.0, 0.016)).expect("a film");
    for (i, printed) in printed.iter().enumerate() {
        let p = 1e-6 * film.pressure()[20 * 11 + i];
        // 1e-4 MPa, the last digit printed.
        assert!((p - printed).abs() < 1.5e-4, "{i}: {p} {printed}");
    }
    // By sweeps the same.
    let swept = CentralDifferences { equations: Equations::Sweeps, ..CentralDifferences::default() };
    let mut swept = swept.build(&Film2dCtx { grid: &grid }).expect("builds");
    swept.solve(&Film2dIn::new(&h, 10.0, 0.016)).expect("a film");
    let top = film.pressure().iter().fold(0.0_f64, |a, b| a.max(*b));
    // The sweeps end when they change pressures of 3.5 MPa by less than 1e-5 Pa.
    assert!(film.pressure().iter().zip(swept.pressure()).all(|(a, b)| (a - b).abs() < 1e-8 * top));
}
