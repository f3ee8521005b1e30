//! One side: rows of contact on a shape that yields, and films that are held open.

use gudgeon_core::file::Files;
use gudgeon_core::kinds::ShearThinningSpec as _;
use gudgeon_core::kinds::{
    SkirtComplianceCtx, SkirtComplianceSpec, SkirtProfile, SkirtProfileCtx, SkirtProfileSpec,
};
use gudgeon_core::quantity::quantity;
use gudgeon_film::SmoothSurfaces;
use gudgeon_film::film_2d::{Cavitation, Direct};
use gudgeon_skirt::{
    Barrel, ContactGrid, Cylindrical, Modal, Panel, Shape, Side, SideLoads, SideSetup, Slopes,
};

use crate::common::*;

fn profile(barrel: bool) -> Box<dyn SkirtProfile> {
    let files = &Files::default();
    let ctx = SkirtProfileCtx { length: LENGTH, radius: RADIUS, files };
    let barrelled = Barrel {
        top: quantity(3e-6),
        bottom: quantity(2e-6),
        widest: quantity(0.4),
        ovality: quantity(4e-6),
    };
    if barrel { barrelled.build(&ctx) } else { Cylindrical {}.build(&ctx) }.expect("builds")
}

fn built(panel: Panel, barrel: bool, shape: Shape, contact: ContactGrid, floor: f64) -> Side {
    let grid = panel.grid(12, 12, 0.0);
    let files = Files::default();
    let ctx = SkirtComplianceCtx::new(&grid, LENGTH, RADIUS, panel.half_angle, &files);
    let modal = Modal { stiffness: vec![quantity(3e8)], shapes: vec![shape], file: None };
    let crests = gudgeon_contact::CrestWedge {
        amplitude: quantity(4e-6),
        pitch: quantity(0.25e-3),
        composite_modulus: quantity(44.52e9),
        deflection: quantity(1.077),
        friction_coefficient: quantity(0.15),
    };
    Side::new(SideSetup {
        panel,
        sign: 1.0,
        clearance: 1e-5,
        grid: &grid,
        film: &Direct { cavitation: Cavitation::HalfSommerfeld, ..Direct::default() },
        roughness: &SmoothSurfaces {},
        contact: &crests,
        boundary_friction: None,
        contact_grid: contact,
        profile: &*profile(barrel),
        compliance: modal.build(&ctx).expect("a shape"),
        shear_thinning: None,
        p_cav: 0.0,
        floor,
    })
    .expect("builds")
}

#[test]
fn contact_sees_profile_and_shapes() {
    let panel = Panel { radius: RADIUS, length: LENGTH, half_angle: 0.6 };
    // Between nodes a shape runs in straight lines: one that is straight along the height, and one that bends across but is asked at nodes alone.
    let straight = (Shape { power: 1, waves: 0 }, 24);
    let bent = (Shape { power: 1, waves: 1 }, 12);
    for (shape, intervals) in [straight, bent] {
        for barrel in [false, true] {
            let pitch = LENGTH / 24.0;
            let mut side = built(panel, barrel, shape, ContactGrid { pitch, intervals }, 1e-7);
            let (e, q, p) = ([-4e-6, -7.5e-6], 1e-6, profile(barrel));
            let mut smallest = f64::INFINITY;
            for k in 0..=24 {
                for i in 0..=intervals {
                    let (s, a) = (k as f64 / 24.0, 0.6 * (2.0 * i as f64 / intervals as f64 - 1.0));
                    let phi = s * f64::cos(f64::from(shape.waves) * std::f64::consts::FRAC_PI_2 * a / 0.6);
                    let h = 1e-5 + (e[0] + (e[1] - e[0]) * s) * a.cos() + p.depth(s * LENGTH, a) + q * phi;
                    smallest = smallest.min(h);
                }
            }
            let found = side.contact_gap(e, &[q]);
            // Sums of micrometres; angles and heights of nodes are rounded.
            assert!(
                (found - (smallest - 4e-6)).abs() < 1e-17 && found < 4e-6,
                "{barrel} {intervals}: {found} {smallest}"
            );
            // Forces begin where the gap is within the range of contact.
            side.place(e, &[q], 1.0).expect("a film");
            let mut l = SideLoads::default();
            side.loads(1.0, 0.016, &[0.0; 3], Slopes::None, &mut l).expect("a film");
            assert!((l.contact[0] + l.contact[1] > 0.0) == (found < 0.0), "{l:?}");
        }
    }
}

#[test]
fn contact_of_half_a_side_is_that_of_the_whole() {
    let panel = Panel { radius: RADIUS, length: LENGTH, half_angle: 0.6 };
    let load = |intervals: usize| {
        let grid = ContactGrid { pitch: 0.25e-3, intervals };
        let mut side = built(panel, true, Shape { power: 1, waves: 1 }, grid, 1e-7);
        side.place([-7e-6, -7e-6], &[0.0], 1.0).expect("a film");
        let mut l = SideLoads::default();
        side.loads(1.0, 0.016, &[0.0; 3], Slopes::None, &mut l).expect("a film");
        l.contact
    };
    let (even, odd) = (load(200), load(201));
    for k in 0..4 {
        // The trapezoidal rule errs with the square of a two-hundredth of the arc where contact begins.
        assert!((even[k] / odd[k] - 1.0).abs() < 2e-3 && even[k] > 0.0, "{k}: {even:?} {odd:?}");
    }
}

#[test]
fn a_film_is_held_open_smoothly_above_its_floor() {
    let panel = Panel { radius: RADIUS, length: LENGTH, half_angle: 0.6 };
    let grid = ContactGrid { pitch: 0.25e-3, intervals: 20 };
    let mut side = built(panel, false, Shape { power: 1, waves: 1 }, grid, 2e-6);
    assert_eq!(side.held_open_below(), Some(4e-6));
    // `h` from twice the floor on, `f + h^2/(4 f)` below it, the floor where surfaces touch: the film stands farthest above the smallest gap.
    for (e, raised) in [(-5.9e-6, 0.0), (-7e-6, 2e-6 + 9e-12 / 8e-6 - 3e-6), (-1.05e-5, 2.5e-6)] {
        side.place([e; 2], &[0.0], 1.0).expect("a film");
        assert!((side.smallest_gap() - (1e-5 + e)).abs() < 1e-20);
        // Rounding of micrometres.
        assert!((side.held_open() - raised).abs() < 1e-18, "{e}: {} {raised}", side.held_open());
    }
}

/// A side that does not yield, without contact.
fn bare(
    panel: Panel,
    n: usize,
    profile: &dyn SkirtProfile,
    thinning: Option<&gudgeon_film::Carreau>,
) -> Side {
    let grid = panel.grid(n, n, 0.0);
    Side::new(SideSetup {
        panel,
        sign: 1.0,
        clearance: 1e-5,
        grid: &grid,
        film: &Direct { cavitation: Cavitation::FullSommerfeld, ..Direct::default() },
        roughness: &SmoothSurfaces {},
        contact: &gudgeon_contact::Off {},
        boundary_friction: None,
        contact_grid: ContactGrid { pitch: 1e-3, intervals: 4 },
        profile,
        compliance: rigid(&grid),
        shear_thinning: thinning.map(|t| t.build().expect("builds")),
        p_cav: 0.0,
        floor: 1e-7,
    })
    .expect("builds")
}

fn forces(side: &mut Side, e: [f64; 2], speed: f64, rates: [f64; 2]) -> SideLoads {
    side.place(e, &[], speed).expect("a film");
    let mut l = SideLoads::default();
    side.loads(speed, 0.016, &rates, Slopes::None, &mut l).expect("a film");
    l
}

#[test]
fn forces_told_again_are_those_of_a_side_that_is_asked_first() {
    let panel = Panel { radius: RADIUS, length: LENGTH, half_angle: 0.6 };
    let side = || {
        let contact = ContactGrid { pitch: 0.25e-3, intervals: 12 };
        built(panel, true, Shape { power: 0, waves: 1 }, contact, 1e-7)
    };
    let (e, q, speed, rates) = ([-2e-6, -3e-6], [5e-7], 9.0, [-4e-3, -6e-3, 1e-3]);
    let ask = |side: &mut Side, mu: f64, rates: &[f64; 3], slopes: Slopes| {
        let mut l = SideLoads::default();
        side.place(e, &q, speed).expect("a film");
        side.loads(speed, mu, rates, slopes, &mut l).expect("a film");
        (l, side.pressure())
    };
    let first = |mu: f64, rates: &[f64; 3], slopes: Slopes| ask(&mut side(), mu, rates, slopes);
    let mut asked = side();
    let other = [2e-3, -6e-3, 1e-3];
    for (mu, rates, slopes) in [
        (0.016, &rates, Slopes::None),
        (0.016, &rates, Slopes::Film),
        (0.016, &rates, Slopes::Film),
        (0.016, &rates, Slopes::Full),
        (0.016, &other, Slopes::Film),
        (0.016, &rates, Slopes::Film),
        (0.012, &rates, Slopes::Film),
    ] {
        assert_eq!(ask(&mut asked, mu, rates, slopes), first(mu, rates, slopes), "{mu} {rates:?} {slopes:?}");
        // Whatever is asked in between, the same is told.
        asked.oil_flow(speed, mu, &other).expect("a film");
        let mut beside = vec![SideLoads::default(); 3];
        asked.loads_beside(e, &q, &[1e-9; 3], speed, mu, rates, &mut beside).expect("a film");
        assert_eq!(ask(&mut asked, mu, rates, slopes), first(mu, rates, slopes), "{mu} {rates:?} {slopes:?}");
        asked.place([-1e-6; 2], &q, speed).expect("a film");
    }
}

#[test]
fn films_under_a_profile_converge() {
    // Nodes and the faces between them see the same profile: forces change little when the nodes come twice as close, whatever the profile is.
    let panel = Panel { radius: RADIUS, length: LENGTH, half_angle: 0.6 };
    let steep = Barrel {
        top: quantity(2e-5),
        bottom: quantity(1.5e-5),
        widest: quantity(0.5),
        ovality: quantity(3e-5),
    };
    let files = &Files::default();
    let steep = steep.build(&SkirtProfileCtx { length: LENGTH, radius: RADIUS, files }).expect("builds");
    let (e, speed, rates) = ([-3e-6, -6e-6], 8.0, [-2e-4, 1e-4]);
    let [a, b, c] = [12, 24, 48].map(|n| forces(&mut bare(panel, n, &*steep, None), e, speed, rates).film);
    for k in 0..3 {
        // Second order: what a halving changes is some percent on twelve intervals, and falls about fourfold.
        let scale = c[0].abs().max(c[1].abs()) * if k == 2 { 0.02 } else { 1.0 };
        let (first, second) = ((a[k] - b[k]).abs(), (b[k] - c[k]).abs());
        assert!(first < 0.1 * scale && second < 0.5 * first + 1e-3 * scale, "{k}: {a:?} {b:?} {c:?}");
    }
}

#[test]
fn thinner_oil_carries_and_drags_less_in_the_same_measure() {
    // Between plates the gap is the same everywhere, and so is the viscosity: forces go with it. The side of a skirt so narrow that it is flat.
    let panel = Panel { radius: 0.0475 / 2e-3, length: LENGTH, half_angle: 1e-3 };
    let thinning = gudgeon_film::Carreau {
        critical_shear_rate: quantity(1e5),
        exponent: quantity(0.6),
        high_shear_ratio: quantity(0.3),
    };
    let flat = profile(false);
    let (speed, rates) = (6.0, [-1e-4, -1e-4]);
    let newtonian = forces(&mut bare(panel, 12, &*flat, None), [0.0; 2], speed, rates);
    let thinned = forces(&mut bare(panel, 12, &*flat, Some(&thinning)), [0.0; 2], speed, rates);
    let x = f64::powi(6.0 / 1e-5 / 1e5, 2);
    let factor = 0.3 + 0.7 * (1.0 + x).powf(0.5 * (0.6 - 1.0));
    for k in 0..3 {
        // Rounding of sums over a hundred nodes; the curvature of the plate is 1e-6 of the gap's.
        let ratio = thinned.film[k] / newtonian.film[k];
        assert!(
            (ratio / factor - 1.0).abs() < 1e-5 && newtonian.film[k].abs() > 1.0,
            "{k}: {ratio} {factor}"
        );
    }
}

/// A rough side without oil resistance of interest, whose contact rubs by a model of its own.
fn rubbing_side(friction: Option<&gudgeon_contact::ShearStrength>) -> Side {
    let panel = Panel { radius: RADIUS, length: LENGTH, half_angle: 0.6 };
    let grid = panel.grid(12, 12, 0.0);
    let flat = profile(false);
    let contact = gudgeon_contact::GreenwoodTripp {
        roughness: quantity(2e-6),
        composite_modulus: quantity(45e9),
        eta_beta_sigma: Some(quantity(0.05)),
        sigma_over_beta: Some(quantity(1e-3)),
        asperity_density: None,
        asperity_radius: None,
        integral: gudgeon_contact::AsperityIntegralFormula::Exact,
        friction_coefficient: quantity(0.1),
    };
    Side::new(SideSetup {
        panel,
        sign: 1.0,
        clearance: 1e-5,
        grid: &grid,
        film: &Direct { cavitation: Cavitation::FullSommerfeld, ..Direct::default() },
        roughness: &SmoothSurfaces {},
        contact: &contact,
        boundary_friction: friction.map(|f| f as &dyn gudgeon_core::kinds::BoundaryFrictionSpec),
        contact_grid: ContactGrid { pitch: 1e-3, intervals: 20 },
        profile: &*flat,
        compliance: rigid(&grid),
        shear_thinning: None,
        p_cav: 0.0,
        floor: 1e-7,
    })
    .expect("builds")
}

#[test]
fn contact_rubs_over_its_real_area_and_by_its_load() {
    let of = |strength: f64| gudgeon_contact::ShearStrength {
        strength: quantity(strength),
        pressure_coefficient: quantity(0.1),
        rounding_speed: quantity(0.0),
    };
    let contact = |side: &mut Side| forces(side, [-7e-6, -6e-6], 6.0, [0.0; 2]).contact;
    let (mut plain, mut dry) = (rubbing_side(None), rubbing_side(Some(&of(0.0))));
    let (a, b) = (contact(&mut plain), contact(&mut dry));
    assert!(a == b && a[2] > 0.0 && a[4] == 0.0, "nobody asks for the area: {a:?}");
    // The same product, in another order of its factors, and against the motion.
    for (x, y) in plain.rubbing(6.0, &a).iter().zip(dry.rubbing(6.0, &b)) {
        assert!((y / x - 1.0).abs() < 1e-14 && *x < 0.0, "{x} {y}");
    }
    assert_eq!(plain.rubbing(0.0, &a).map(f64::abs), dry.rubbing(0.0, &b).map(f64::abs));
    let mut layer = rubbing_side(Some(&of(5e6)));
    let c = contact(&mut layer);
    assert!(c[..4] == a[..4] && c[4] > 0.0);
    // Summits of Greenwood and Tripp's surfaces are pressed together with some hundred megapascals: the area is the load over that.
    let summits = c[2] / c[4];
    assert!((1e8..2e9).contains(&summits), "{summits} Pa");
    for (k, force) in layer.rubbing(-6.0, &c).into_iter().enumerate() {
        let exact = 0.1 * c[2 + k] + 5e6 * c[4 + k];
        // Rounding of a sum of two products.
        assert!((force / exact - 1.0).abs() < 1e-13, "{k}: {force} {exact}");
    }
}
