//! Masses and crank drive.

use gudgeon_core::kinds::PistonMotion;
use gudgeon_skirt::{Body, Crank, Rod};

fn ea111() -> Body {
    Body {
        piston_mass: 0.236,
        pin_mass: 0.052,
        inertia: 1.36e-4,
        length: 0.0303,
        pin: 8.4e-3,
        centre: 0.3e-3,
        centre_offset: -3.25e-4,
    }
}

#[test]
fn mass_matrix_of_force_and_moment() {
    // Loureiro (2009), eq. 60: rows of lateral force and of the moment about the pin, evaluated for both engines.
    let zhu = Body {
        piston_mass: 0.295,
        pin_mass: 0.09,
        inertia: 2.5e-4,
        length: 0.0338,
        pin: 0.0125,
        centre: 1.5e-3,
        centre_offset: 2e-3,
    };
    for (body, printed) in [
        (ea111(), [[0.271248, 0.0167525], [6.38112e-3, -4.46952e-3]]),
        (zhu, [[0.33862, 0.04638], [0.010497, -0.007252]]),
    ] {
        let m = body.matrix();
        assert_eq!(m[0][1], m[1][0]);
        for column in 0..2 {
            let [force, moment] = body.about_pin([m[0][column], m[1][column]]);
            // Half a unit of the last digit.
            assert!((force - printed[0][column]).abs() < 6e-6, "{force}");
            assert!((moment - printed[1][column]).abs() < 6e-7, "{moment}");
        }
        let there = body.about_pin(body.on_edges(3.0, -0.2));
        assert!((there[0] - 3.0).abs() < 1e-15 && (there[1] + 0.2).abs() < 1e-15);
    }
}

#[test]
fn rod_inertia_is_that_of_two_masses_when_they_are_all_there_is() {
    // A rod of two points at its eyes has no inertia that a rod without mass and a heavier pin would not have.
    let crank = Crank {
        radius: 0.04,
        rod_length: 0.14,
        omega: 300.0,
        pin_offset: 5e-4,
        crank_offset: -1e-3,
        rod: Rod::default(),
    };
    let (m1, m2, l) = (0.13, 0.31, 0.14);
    let centre = m2 / (m1 + m2) * l;
    let rod = Rod { mass: m1 + m2, centre, inertia: m1 * centre * centre + m2 * (l - centre) * (l - centre) };
    let body = ea111();
    let heavier = Body { pin_mass: body.pin_mass + m1, ..body };
    for k in 0..12 {
        let theta = 0.3 + 0.5 * f64::from(k);
        // The motion of the pin, along the bore away from the head.
        let (sin, cos) = theta.sin_cos();
        let z = crank.pin_offset - crank.crank_offset + crank.radius * sin;
        let s = (l * l - z * z).sqrt();
        let (dz, ddz) = (crank.radius * cos, -crank.radius * sin);
        let ds = -z * dz / s;
        let dds = -(dz * dz + z * ddz + ds * ds) / s;
        let w = crank.omega;
        let motion = PistonMotion {
            v: -w * (-ds + crank.radius * sin),
            a: -w * w * (-dds + crank.radius * cos),
            ..PistonMotion::default()
        };
        let light = crank.instant(theta, &motion, 2e5, 4e-3, 0.01);
        let heavy = Crank { rod, ..crank }.instant(theta, &motion, 2e5, 4e-3, 0.01);
        // The mass at the small eye is one of the pin's, the other hangs on the crank. Forces of 1e3 N.
        let (a, b) = (heavier.rod_lateral(&light, 10.0), body.rod_lateral(&heavy, 10.0));
        assert!((a - b).abs() < 1e-9, "{theta}: {a} {b}");
    }
}
