//! The whole piston: forces against what they are made of, balances, steps and derivatives against each other.

use gudgeon_core::kinds::{
    AddedForces, Film2dSpec, GrooveFrictionCtx, GrooveFrictionSpec, LateralLoads, PinFrictionSpec,
};
use gudgeon_core::quantity::quantity;
use gudgeon_film::WavinessTransport;
use gudgeon_film::film_2d::{Cavitation, Direct};
use gudgeon_skirt::{
    Body, Crank, GrooveCoulomb, Instant, Momentum, NoGrooveFriction, NoPinFriction, Partials, PinCoulomb,
    Piston, Rod, Slopes, Summary,
};

use crate::common::*;

fn film(cavitation: Cavitation) -> Direct {
    Direct { cavitation, ..Direct::default() }
}

/// A piston with both sides yielding in two shapes.
fn elastic(film: &dyn Film2dSpec, stiffness: [f64; 2], relaxation: f64) -> Piston {
    let sides = [
        yielding(film, 1.0, HALF[0], stiffness, relaxation),
        yielding(film, -1.0, HALF[1], stiffness, relaxation),
    ];
    let pin = NoPinFriction {}.build().expect("builds");
    let groove = NoGrooveFriction {}.build(&GrooveFrictionCtx { bore: 0.0765 }).expect("builds");
    Piston::new(sides, body(), crank(), pin, groove)
}

fn instant(deg: f64, pressure: f64) -> Instant {
    let c = crank();
    c.instant(deg.to_radians(), &slider_crank(&c, deg), pressure, 4.6e-3, 0.016)
}

fn summary(p: &mut Piston, now: &Instant, x: &[f64], w: &[f64]) -> Summary {
    p.summary(now, x, w).expect("films")
}

const X: [f64; 2] = [-1e-6, -6.1e-6];
const W: [f64; 2] = [-4e-4, -1e-4];

#[test]
fn frictions_add_their_forces_and_moments() {
    let (c, b) = (crank(), body());
    let now = instant(401.0, 2e6);
    let mut free = piston(WavinessTransport::AsPublished, -3.25e-4);
    let without = summary(&mut free, &now, &X, &W);
    assert!(!free.has_pin_friction() && !free.has_groove_friction());
    let pin =
        PinCoulomb { coefficient: quantity(0.05), radius: quantity(9e-3), reversal_speed: quantity(0.01) };
    let groove = GrooveCoulomb {
        coefficient: quantity(0.1),
        height: quantity(0.012),
        width: quantity(3e-3),
        preload: None,
        reversal_speed: quantity(1e-3),
    };
    let ctx = GrooveFrictionCtx { bore: 0.0765 };
    let other = piston(WavinessTransport::AsPublished, -3.25e-4);
    let parts = (pin.build().expect("builds"), groove.build(&ctx).expect("builds"));
    let mut rubbing = Piston::new(other.sides, b, c, parts.0, parts.1);
    assert!(rubbing.has_pin_friction() && rubbing.has_groove_friction());
    let with = summary(&mut rubbing, &now, &X, &W);
    let axial = b.rod_axial(&now, without.friction());
    let moment = pin.build().expect("builds").moment(axial.hypot(without.rod), now.rod_rotation);
    // The groove stands 12 mm above the upper edge, and moves as both edges on.
    let v = W[0] + (W[1] - W[0]) * (-0.012 / LENGTH);
    let (ring, _) = groove.build(&ctx).expect("builds").force(2e6, v);
    // Rounding of forces of kilonewtons.
    let near = |a: f64, b: f64, d: f64, what: &str| assert!((a - b).abs() < d, "{what}: {a} {b}");
    near(with.pin_moment, moment, 1e-9, "pin");
    near(with.groove, ring, 1e-9, "rings");
    near(with.net[0] - without.net[0], ring, 1e-8, "force");
    near(with.net[1] - without.net[1], moment + (b.pin + 0.012) * ring, 1e-9, "moment");
}

#[test]
fn derivatives_know_the_friction_of_the_rings() {
    let groove = GrooveCoulomb {
        coefficient: quantity(0.1),
        height: quantity(0.012),
        width: quantity(3e-3),
        preload: None,
        reversal_speed: quantity(1e-3),
    };
    let other = piston(WavinessTransport::AsPublished, -3.25e-4);
    let ring = groove.build(&GrooveFrictionCtx { bore: 0.0765 }).expect("builds");
    let mut p = Piston::new(other.sides, body(), crank(), NoPinFriction {}.build().expect("builds"), ring);
    let now = instant(401.0, 2e6);
    let d = 1e-8;
    let mut quotients = [[0.0; 2]; 2];
    for k in 0..2 {
        let mut at = |d: f64| {
            let mut v = W;
            v[k] += d;
            p.ask(&now, &X, &mut [0.0; 2]).forces(v).expect("films")
        };
        let (high, low) = (at(d), at(-d));
        quotients[k] = [0, 1].map(|r| (high[r] - low[r]) / (2.0 * d));
    }
    p.ask(&now, &X, &mut [0.0; 2]).forces(W).expect("films");
    let mut found = Partials::new(2);
    p.partials(&now, &X, &W, true, &mut found).expect("derivatives");
    for k in 0..2 {
        for row in 0..2 {
            let (a, b) = (found.answer_by_v[k][row], quotients[k][row]);
            // Films are linear between their cuts; friction bends over a hundred-thousandth of its reversal speed; rounding of kilonewtons over it.
            assert!(
                (a - b).abs() < 1e-4 * quotients[k].iter().fold(0.0_f64, |m, q| m.max(q.abs())),
                "{k} {row}: {a} {b}"
            );
        }
    }
}

#[test]
fn surfaces_yield_to_a_pressure_by_its_integral_over_their_shapes() {
    let d = film(Cavitation::HalfSommerfeld);
    let soft = yielding_side(&d, 1e-6);
    let roughness = waves(WavinessTransport::Homogenised);
    let mut hard = side(0, &Setup { film: &d, roughness: &roughness, intervals: 12 });
    hard.place([-1e-6, -2e-6], &[], 5.0).expect("a film");
    let mut l = gudgeon_skirt::SideLoads::default();
    hard.loads(5.0, 0.016, &W, Slopes::None, &mut l).expect("a film");
    let q = soft.yields_to(&hard);
    let (grid, p, gap) = (hard.grid().clone(), hard.pressure(), hard.gap());
    let (wx, wy) = grid.weights();
    let n = grid.len();
    let shapes = soft.compliance.shapes();
    for (k, stiffness) in [3e8, 8e8].into_iter().enumerate() {
        let load: f64 = (0..n).map(|i| wx[i % 13] * wy[i / 13] * shapes[k * n + i] * p[i]).sum();
        // Rounding of a hundred terms.
        assert!((q[k] * stiffness / load - 1.0).abs() < 1e-9 && load > 100.0, "{k}: {q:?} {load}");
    }
    let part = (0..n).map(|i| ((q[0] * shapes[i] + q[1] * shapes[n + i]) / gap[i]).abs()).fold(0.0, f64::max);
    assert!((soft.part_of_gap(&q, &hard) / part - 1.0).abs() < 1e-12);
}

#[test]
fn films_cavitate_at_the_pressure_given() {
    // Below that of the crankcase by a bar: no film goes further down, and some go there.
    for cavitation in [Cavitation::HalfSommerfeld, Cavitation::SwiftStieber, Cavitation::FullSommerfeld] {
        let mut s = yielding_at(&film(cavitation), 1.0, HALF[0], [3e8, 8e8], 1e-6, -1e5);
        s.place([-1e-6, -2e-6], &[0.0; 2], 5.0).expect("a film");
        let mut l = gudgeon_skirt::SideLoads::default();
        s.loads(5.0, 0.016, &[4e-3, 3e-3, 0.0, 0.0], Slopes::None, &mut l).expect("a film");
        let low = s.pressure().into_iter().fold(f64::INFINITY, f64::min);
        if cavitation == Cavitation::FullSommerfeld {
            assert!(low < -2e5, "{low}");
        } else {
            // Rounding of the pressure.
            assert!((low + 1e5).abs() < 1e-6, "{cavitation:?}: {low}");
        }
    }
}

#[test]
fn net_force_is_the_sum_of_what_is_told() {
    let b = body();
    for (deg, pressure) in [(401.0, 2e6), (200.0, 0.0)] {
        let now = instant(deg, pressure);
        let mut p = piston(WavinessTransport::AsPublished, -3.25e-4);
        let s = summary(&mut p, &now, &X, &W);
        let side = s.film.iter().chain(&s.contact).sum::<f64>();
        assert!(s.contact[0] > 0.0, "the crests touch");
        assert_eq!(s.side_force(), s.film[0] + s.film[1] + s.contact[0] + s.contact[1]);
        assert!((s.rod - b.rod_lateral(&now, s.friction())).abs() < 1e-9);
        // Rounding of forces of kilonewtons.
        assert!((s.net[0] - side - s.rod).abs() < 1e-8);
        // Moments: of films and crests normal to the wall, of their drag at the radius of the skirt, and of the drive.
        let drag: f64 = s.film_friction_moment.iter().sum();
        let normal: f64 = s.film_moment.iter().chain(&s.contact_moment).sum();
        let rubbing = s.net[1] - drag - normal - b.drive_moment(&now, crank().pin_offset);
        let force: f64 = s.contact_friction.iter().sum();
        let side = &mut p.sides[0];
        side.place(X, &[], now.speed).expect("a film");
        let mut l = gudgeon_skirt::SideLoads::default();
        side.loads(now.speed, now.mu, &W, Slopes::None, &mut l).expect("a film");
        let direction = -now.speed.signum();
        assert!((force - direction * 0.15 * l.contact[2]).abs() < 1e-9 && force != 0.0);
        let exact = direction * 0.15 * (crank().pin_offset * l.contact[2] - l.contact[3]);
        assert!((rubbing - exact).abs() < 1e-9, "{rubbing} {exact}");
        // What the skirt alone does, as a lateral motion asks for it.
        let mut w = [0.0; 2];
        let mut asked = p.ask(&now, &X, &mut w);
        let net = asked.forces(W).expect("films");
        let alone = asked.skirt_forces();
        assert!((alone[0] + alone[1] - s.side_force()).abs() < 1e-8);
        let [f, m] = b.about_pin(net);
        assert!((f - s.net[0]).abs() < 1e-8 && (m - s.net[1]).abs() < 1e-9);
    }
}

#[test]
fn added_forces_take_part_in_every_answer() {
    let now = instant(401.0, 2e6);
    let mut p = piston(WavinessTransport::AsPublished, -3.25e-4);
    let plain = p.ask(&now, &X, &mut [0.0; 2]).forces(W).expect("films");
    let (constant, damping) = ([30.0, -12.0], [[4e4, 1e4], [2e4, 6e4]]);
    p.add(AddedForces::new(constant, damping));
    let added = p.ask(&now, &X, &mut [0.0; 2]).forces(W).expect("films");
    for k in 0..2 {
        let own = constant[k] - damping[k][0] * W[0] - damping[k][1] * W[1];
        // Rounding of forces of kilonewtons.
        assert!((added[k] - plain[k] - own).abs() < 1e-8, "{k}: {} {own}", added[k] - plain[k]);
    }
    let mut w = [0.0; 2];
    let v = p.ask(&now, &X, &mut w).balance().expect("a balance");
    assert_eq!(v, w);
    let left = p.ask(&now, &X, &mut [0.0; 2]).forces(v).expect("films");
    // A balance leaves 1e-11 of kilonewtons.
    assert!(left.iter().all(|f| f.abs() < 1e-6), "{left:?}");
    // Forces that are left are those asked for.
    let v = p.ask(&now, &X, &mut w).balance_against([15.0, 6.0]).expect("a balance");
    let left = p.ask(&now, &X, &mut [0.0; 2]).forces(v).expect("films");
    assert!((left[0] - 15.0).abs() < 1e-6 && (left[1] - 6.0).abs() < 1e-6, "{left:?}");
    // Derivatives with respect to added forces, by a difference of balances.
    let here = p.ask(&now, &X, &mut w).balance().expect("a balance");
    let mut found = Partials::new(2);
    p.partials(&now, &X, &w, false, &mut found).expect("derivatives");
    for k in 0..2 {
        let mut more = constant;
        more[k] += 0.1;
        p.add(AddedForces::new(more, damping));
        let there = p.ask(&now, &X, &mut [0.0; 2]).balance().expect("a balance");
        for row in 0..2 {
            let quotient = (there[row] - here[row]) / 0.1;
            let scale = found.answer_by_force[k].iter().fold(0.0_f64, |m, v| m.max(v.abs()));
            // Films are linear in the rates but for their cut, over a ten-thousandth of the force.
            let d = (quotient - found.answer_by_force[k][row]).abs();
            assert!(d < 1e-3 * scale, "{k} {row}: {quotient} {found:?}");
        }
    }
    // Taken away, they leave no trace.
    p.add(AddedForces::default());
    assert_eq!(p.ask(&now, &X, &mut [0.0; 2]).forces(W).expect("films"), plain);
}

#[test]
fn shapes_yield_to_the_loads_on_them() {
    // The rates found are those at which every shape's load is `K (q + tau dq/dt)`, whether or not the velocities of the edges are given.
    let (stiffness, relaxation) = ([5e7, 9e7], 2e-5);
    let mut p = elastic(&film(Cavitation::HalfSommerfeld), stiffness, relaxation);
    assert_eq!(p.coordinates(), 6);
    let x = [-1e-6, -2e-6, 4e-7, 2e-7, -1e-7, 3e-7];
    let now = instant(401.0, 2e6);
    for given in [false, true] {
        let mut w = [0.0; 6];
        let mut asked = p.ask(&now, &x, &mut w);
        if given { asked.forces(W).map(|_| ()) } else { asked.balance().map(|_| ()) }.expect("a balance");
        if given {
            assert_eq!(w[..2], W);
        }
        for (side, own) in [(0, 2..4), (1, 4..6)] {
            let rates = [&w[..2], &w[own.clone()]].concat();
            let mut l = gudgeon_skirt::SideLoads::default();
            p.sides[side].loads(now.speed, now.mu, &rates, Slopes::None, &mut l).expect("a film");
            for (m, k) in own.enumerate() {
                let resistance = stiffness[m] * (x[k] + relaxation * w[k]);
                // A balance leaves 1e-11 of forces of kilonewtons.
                assert!(
                    (l.elastic[m] - resistance).abs() < 1e-6,
                    "{given} {side} {m}: {} {resistance}",
                    l.elastic[m]
                );
            }
        }
        // Asking nothing is the same as giving the velocities.
        if given {
            let mut again = [0.0; 6];
            p.ask(&now, &x, &mut again).end(W).expect("a balance");
            assert_eq!(again, w);
        }
    }
}

#[test]
fn derivatives_with_shapes_are_those_of_the_answers() {
    let mut p = elastic(&film(Cavitation::HalfSommerfeld), [5e7, 9e7], 2e-5);
    let x = [-1e-6, -2e-6, 4e-7, 2e-7, -1e-7, 3e-7];
    let now = instant(401.0, 2e6);
    let dt = 1e-6;
    let later = instant(401.0 + f64::to_degrees(dt), 2e6);
    for given in [false, true] {
        // Answer of the edges, then rates of the shapes.
        let ask = |p: &mut Piston, now: &Instant, x: &[f64; 6], v: [f64; 2]| {
            let mut w = [0.0; 6];
            let mut asked = p.ask(now, x, &mut w);
            let a = if given { asked.forces(v) } else { asked.balance() }.expect("a balance");
            ([a[0], a[1], w[2], w[3], w[4], w[5]], w)
        };
        let there = |p: &mut Piston, k: usize, d: f64| {
            let (mut x, mut v) = (x, W);
            if k < 6 {
                x[k] += d
            } else {
                v[k - 6] += d
            }
            ask(p, &now, &x, v).0
        };
        let columns: Vec<[f64; 6]> = (0..if given { 8 } else { 6 })
            .map(|k| {
                let d = if k < 6 { 2e-11 } else { 1e-9 };
                let (a, b) = (there(&mut p, k, d), there(&mut p, k, -d));
                std::array::from_fn(|r| (a[r] - b[r]) / (2.0 * d))
            })
            .collect();
        let mut w = [0.0; 6];
        let mut ask = |p: &mut Piston, now: &Instant| {
            let mut own = [0.0; 6];
            let mut asked = p.ask(now, &x, &mut own);
            let a = if given { asked.forces(W) } else { asked.balance() }.expect("a balance");
            w = own;
            [a[0], a[1], own[2], own[3], own[4], own[5]]
        };
        let then = ask(&mut p, &later);
        let here = ask(&mut p, &now);
        let mut found = Partials::new(6);
        p.partials(&now, &x, &w, given, &mut found).expect("derivatives");
        let mut shapes = [0.0; 4];
        let by_time = p.time_partials(&now, &x, &w, given, (&later, dt), &mut shapes).expect("derivatives");
        for (k, quotient) in columns.iter().enumerate() {
            let (answer, own) = if k < 6 {
                (found.answer[k], found.of_shapes(k))
            } else {
                (found.answer_by_v[k - 6], &found.shapes_by_v[k - 6][..])
            };
            let all = [&answer[..], own].concat();
            for part in [0..2, 2..6] {
                let scale = quotient[part.clone()].iter().fold(0.0_f64, |m, v| m.max(v.abs()));
                for row in part {
                    // The films are solved to 1e-9 of their flows and moved by a few millionths of the gap; nodes at the cut of the film change sides.
                    let d = (all[row] - quotient[row]).abs();
                    assert!(d < 5e-3 * scale, "{given} {row} {k}: {} {}", all[row], quotient[row]);
                }
            }
        }
        let all = [&by_time[..], &shapes].concat();
        for row in 0..6 {
            let fresh = (then[row] - here[row]) / dt;
            let scale = if row < 2 {
                (then[0] - here[0]).abs().max((then[1] - here[1]).abs()) / dt
            } else {
                fresh.abs()
            };
            assert!(
                (all[row] - fresh).abs() < 5e-3 * scale + 1e-9,
                "{given} time {row}: {} {fresh}",
                all[row]
            );
        }
    }
}

#[test]
fn a_step_of_backward_euler_solves_its_equation() {
    let now = instant(401.0, 2e6);
    for cavitation in [Cavitation::HalfSommerfeld, Cavitation::SwiftStieber] {
        let mut p = elastic(&film(cavitation), [5e7, 9e7], 2e-5);
        let from = [-1e-6, -2e-6, 4e-7, 2e-7, -1e-7, 3e-7];
        for momentum in [None, Some(Momentum { mass: p.body.matrix(), v: [2e-3, -1e-3] })] {
            let (mut w, mut x) = ([0.0; 6], [0.0; 6]);
            let dt = 2e-5;
            p.euler_step(&now, &from, momentum, dt, &mut w, &mut x).expect("a step");
            for k in 0..6 {
                assert_eq!(x[k], from[k] + dt * w[k], "{k}");
            }
            let f = p.ask(&now, &x, &mut w.clone()).forces([w[0], w[1]]).expect("films");
            let inertia = momentum.map_or([0.0; 2], |m| {
                let a = [(w[0] - m.v[0]) / dt, (w[1] - m.v[1]) / dt];
                m.mass.map(|row| row[0] * a[0] + row[1] * a[1])
            });
            // 1e-8 of the forces is left of a step whose films follow by superposition, and 1e-4 where cavities let it come slowly: kilonewtons.
            let admitted = if cavitation == Cavitation::HalfSommerfeld { 1e-3 } else { 1.0 };
            for k in 0..2 {
                assert!((f[k] - inertia[k]).abs() < admitted, "{cavitation:?} {k}: {f:?} {inertia:?}");
            }
        }
    }
}

#[test]
fn balances_with_cavities_are_found() {
    // Films that rupture and form again are solved for every rate; where Newton's method circles, the motion towards the balance is followed.
    for cavitation in [Cavitation::SwiftStieber, Cavitation::MassConserving] {
        let mut p = elastic(&film(cavitation), [3e8, 8e8], 1e-6);
        for (deg, pressure) in [(401.0, 2e6), (90.0, 0.0), (230.0, 1e5)] {
            let now = instant(deg, pressure);
            for x in [[-1e-6, -2e-6, 4e-7, 2e-7, -1e-7, 3e-7], [3e-6, -2e-6, 0.0, 0.0, 0.0, 0.0]] {
                let mut w = [0.0; 6];
                p.ask(&now, &x, &mut w)
                    .balance()
                    .unwrap_or_else(|e| panic!("{cavitation:?} {deg} {x:?}: {e}"));
                let s = summary(&mut p, &now, &x, &w);
                let scale = s.film[0].abs() + s.film[1].abs() + s.rod.abs() + 1.0;
                // What may be left where cavities let a balance come slowly: 1e-4 of the forces.
                assert!(s.net[0].abs() < 2e-4 * scale, "{cavitation:?} {deg} {x:?}: {s:?}");
            }
        }
    }
}

#[test]
fn oil_leaves_as_the_gap_closes() {
    // A full film conserves oil: what leaves over all edges is what the gap loses, `-sum e' int cos phi (1 - s) dA`, in closed form. Sliding moves oil
    // through, and neither adds nor takes any.
    let d = film(Cavitation::FullSommerfeld);
    for intervals in [12, 13] {
        let roughness = gudgeon_film::SmoothSurfaces {};
        let setup = Setup { film: &d, roughness: &roughness, intervals };
        let pin = NoPinFriction {}.build().expect("builds");
        let groove = NoGrooveFriction {}.build(&GrooveFrictionCtx { bore: 0.0765 }).expect("builds");
        let sides = [side(0, &setup), side(1, &setup)];
        assert_eq!(sides[0].nodes() < sides[0].grid().len(), intervals == 12);
        let mut p = Piston::new(sides, body(), crank(), pin, groove);
        let (x, w) = ([2e-6, -1e-6], [3e-3, -1e-3]);
        for speed in [0.0, 6.0] {
            let now = Instant { speed, mu: 0.016, ..Instant::default() };
            p.place(&now, &x).expect("films");
            let [up, down, aside] = p.oil_flow(&now, &w).expect("films");
            let mean = 0.5 * (w[0] + w[1]) * LENGTH;
            // The thrust side opens where the skirt moves away from it.
            let each =
                [(0, -1.0), (1, 1.0)].map(|(k, s): (usize, f64)| s * mean * 2.0 * RADIUS * HALF[k].sin());
            let (lost, scale) = (each[0] + each[1], each[0].abs() + each[1].abs());
            let leaves = up + down + aside;
            // Control volumes integrate the cosine by the trapezoidal rule: at most (2 * 0.62 / 12)^2/12 of it is lost.
            assert!((leaves - lost).abs() < 1e-3 * scale, "{intervals} {speed}: {up} {down} {aside} {lost}");
            if speed > 0.0 {
                // The liner drags oil into the skirt over the lower edge of one that moves down.
                assert!(up > 0.0 && down < 0.0, "{up} {down}");
            }
        }
    }
}

#[test]
fn oil_flow_without_superposition_is_that_with_it() {
    // Where nothing cavitates, all films are the same; the flow of one comes from superposition, of the other from the solver.
    let roughness = gudgeon_film::SmoothSurfaces {};
    let now = Instant { speed: 0.0, mu: 0.016, ..Instant::default() };
    let flow = |cavitation| {
        let d = film(cavitation);
        let mut s = side(0, &Setup { film: &d, roughness: &roughness, intervals: 12 });
        s.place([2e-6, -1e-6], &[], now.speed).expect("a film");
        // The gap closes everywhere: no cavity.
        let before = s.oil_flow(0.0, 0.016, &[-3e-3, -2e-3]).expect("a film");
        // The film of the place is as it was.
        let mut l = gudgeon_skirt::SideLoads::default();
        s.loads(0.0, 0.016, &[-3e-3, -2e-3], Slopes::None, &mut l).expect("a film");
        (before, l.film)
    };
    let (a, b) = (flow(Cavitation::FullSommerfeld), flow(Cavitation::MassConserving));
    for k in 0..3 {
        // Films are solved to 1e-9 of their largest flow.
        assert!((a.0[k] - b.0[k]).abs() < 1e-6 * a.0[2].abs(), "{k}: {a:?} {b:?}");
    }
    assert!((a.1[0] - b.1[0]).abs() < 1e-6 * a.1[0].abs());
}

#[test]
fn gaps_are_those_of_the_cosine() {
    let mut p = piston(WavinessTransport::AsPublished, -3.25e-4);
    for e in [[2e-6, -1e-6], [-3e-6, -3e-6], [0.0, 0.0]] {
        let gaps = p.gaps(&e, 5.0).expect("gaps");
        for (k, sign) in [1.0, -1.0].into_iter().enumerate() {
            let low = (sign * e[0]).min(sign * e[1]);
            // Least in the middle where the skirt stands towards this side, at the flanks otherwise.
            let exact = 1e-5 + if low < 0.0 { low } else { low * HALF[k].cos() };
            assert!((gaps[k] - exact).abs() < 1e-18, "{e:?} {k}: {} {exact}", gaps[k]);
        }
        let touching = p.contact_gaps(&e);
        for k in 0..2 {
            // A bound from below of the gap, less the height of the crests, while nothing touches.
            assert!(touching[k] <= gaps[k] - 4e-6 + 1e-18 && touching[k] > 0.0, "{e:?} {k}: {}", touching[k]);
        }
    }
    // Crests that touch: the gap of the row that stands lowest. Rows are 0.25 mm apart, the last one 0.05 mm above the edge.
    let e = [-1e-6, -6.2e-6];
    let last = 1.0 - (LENGTH % 0.25e-3) / LENGTH;
    let exact = 1e-5 - 1e-6 - 5.2e-6 * last - 4e-6;
    let touching = p.contact_gaps(&e);
    assert!((touching[0] - exact).abs() < 1e-12 && exact < 0.0, "{touching:?} {exact}");
    let open = yielding_side(&film(Cavitation::HalfSommerfeld), 1e-6);
    assert!(!open.has_contact() && p.sides[0].has_contact());
    let mut open = open;
    assert_eq!(open.contact_gap([0.0; 2], &[0.0; 2]), f64::INFINITY);
}

#[test]
fn films_resist_and_without_them_nothing_does() {
    let now = instant(401.0, 2e6);
    let mut p = piston(WavinessTransport::AsPublished, -3.25e-4);
    assert!(p.resists(&now, false).expect("films") && p.resists(&now, true).expect("films"));
    let none = gudgeon_film::film_2d::Off {};
    let roughness = gudgeon_film::SmoothSurfaces {};
    let setup = Setup { film: &none, roughness: &roughness, intervals: 12 };
    let pin = NoPinFriction {}.build().expect("builds");
    let groove = NoGrooveFriction {}.build(&GrooveFrictionCtx { bore: 0.0765 }).expect("builds");
    let mut dry = Piston::new([side(0, &setup), side(1, &setup)], body(), crank(), pin, groove);
    assert!(!dry.resists(&now, false).expect("no film") && !dry.resists(&now, true).expect("no film"));
    let e = dry.ask(&now, &[0.0; 2], &mut [0.0; 2]).balance().expect_err("nothing resists");
    assert!(e.is_recoverable(), "{e}");
}

#[test]
fn energy_across_the_bore_is_that_of_the_masses() {
    let b = body();
    let p = piston(WavinessTransport::AsPublished, -3.25e-4);
    // Moving aside without tilting, all of it moves; turning about the centre of gravity, the pin swings about it.
    let aside = p.lateral_energy([0.3, 0.3]);
    assert!((aside - 0.5 * b.mass() * 0.09).abs() < 1e-15, "{aside}");
    let turn = 2.0;
    let about = p.lateral_energy([turn * b.centre, -turn * (b.length - b.centre)]);
    let arm = b.pin - b.centre;
    assert!((about - 0.5 * turn * turn * (b.inertia + b.pin_mass * arm * arm)).abs() < 1e-15, "{about}");
}

#[test]
fn gas_and_inertia_along_the_bore_act_about_the_pin() {
    let b = Body { centre_offset: 4e-4, ..body() };
    let now = Instant { acceleration: -1500.0, gas: 3000.0, tangent: 0.2, ..Instant::default() };
    // M = z F_y - y F_z: gas along the axis stands the pin offset away from the pin, inertia its distance from the pin.
    assert!((b.drive_moment(&now, 5e-4) - (3000.0 * 5e-4 - 0.236 * 1500.0 * 4e-4)).abs() < 1e-12);
    let axial = b.rod_axial(&now, 25.0);
    assert!((axial - (-(0.236 + 0.052) * 1500.0 - 3000.0 - 25.0)).abs() < 1e-9);
    let lateral = b.rod_lateral(&Instant { rod_inertia: 7.0, ..now }, 25.0);
    assert!((lateral - (0.2 * axial + 7.0)).abs() < 1e-9);
}

#[test]
fn a_rod_with_inertia_alone_still_turns_the_pin_aside() {
    let c = Crank { rod: Rod { inertia: 1e-3, ..Rod::default() }, ..crank() };
    let (mass, none) = (slider_crank(&c, 60.0), crank());
    let with = c.instant(60f64.to_radians(), &mass, 0.0, 4.6e-3, 0.016).rod_inertia;
    let without = none.instant(60f64.to_radians(), &mass, 0.0, 4.6e-3, 0.016).rod_inertia;
    assert!(without == 0.0 && with != 0.0);
    // Moment of inertia times the angular acceleration of the rod, over its length along the bore: `I alpha/(L cos)`.
    let angle = |deg: f64| -c.instant(deg.to_radians(), &mass, 0.0, 0.0, 0.0).tangent.atan();
    let d = 0.01_f64;
    let alpha =
        (angle(60.0 + d) - 2.0 * angle(60.0) + angle(60.0 - d)) / d.to_radians().powi(2) * c.omega * c.omega;
    let along = c.rod_length * angle(60.0).cos();
    // Second difference of angles over a hundredth of a degree: 1e-16 over 3e-8.
    assert!(
        (with.abs() / (1e-3 * alpha.abs() / along) - 1.0).abs() < 1e-6,
        "{with} {}",
        1e-3 * alpha / along
    );
}
