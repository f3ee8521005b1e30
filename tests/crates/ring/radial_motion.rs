//! The radial motion without inertia on films whose balance has a closed form.

use std::cell::OnceCell;

use gudgeon_core::EvalError;
use gudgeon_core::kinds::{
    FaceForces, RadialLimits, RadialLoads, RadialMotion, RadialMotionCtx, RadialMotionSpec, RadialResponse,
    RadialState, RadialTrials,
};
use gudgeon_core::states::{Signals, Stage};
use gudgeon_ring::FilmBalance;
use gudgeon_ring::parts::soft;

const OMEGA: f64 = 200.0;

/// A film with the load `rest (2 um/h)^falls - damping v + bend v²`, and a contact and loads that are given.
#[derive(Debug, Clone)]
struct Ring {
    h: f64,
    load: f64,
    contact: f64,
    dry: f64,
    lowest: (f64, f64),
    resists: bool,
    carries: bool,
    /// Friction on the flanks, its damping.
    friction: Option<(f64, f64)>,
    faces: usize,
    rest: f64,
    falls: f64,
    damping: f64,
    bend: f64,
    flux: [f64; 2],
    fails_to_carry: bool,
    evaluations: usize,
    /// Those of the load alone.
    loads: usize,
    seen: Seen,
}

/// What the motion sees of a ring, made once it is asked for; a copy of the ring makes its own.
#[derive(Debug, Default)]
struct Seen(OnceCell<RadialState>);

impl Clone for Seen {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl Ring {
    fn new() -> Self {
        Self {
            h: 2e-6,
            load: 1000.0,
            contact: 0.0,
            dry: 0.0,
            lowest: (0.0, 0.1),
            resists: true,
            carries: true,
            friction: None,
            faces: 1,
            rest: 1300.0,
            falls: 0.0,
            damping: 1e6,
            bend: 0.0,
            flux: [0.0; 2],
            fails_to_carry: false,
            evaluations: 0,
            loads: 0,
            seen: Seen::default(),
        }
    }

    fn film_at(&self, v: f64) -> FaceForces {
        let rest = self.rest * (2e-6 / self.h).powf(self.falls);
        FaceForces {
            load: rest - self.damping * v + self.bend * v * v,
            squeeze_damping: self.damping - 2.0 * self.bend * v,
            ring_shear: 3.0 + 5.0 * v,
            liner_shear: 4.0 - 7.0 * v,
            slope_force: 0.5 + 11.0 * v,
            flux: 1e-6 + 2.0 * v,
        }
    }
}

impl RadialLoads for Ring {
    fn state(&self) -> &RadialState {
        self.seen.0.get_or_init(|| RadialState {
            thickness: self.h,
            load: self.load,
            tension: 100.0,
            contact: self.contact,
            contact_range: 1e-6,
            dry: self.dry,
            lowest: self.lowest,
            furthest: 1e-3,
            resists: self.resists,
            carries: self.carries,
            has_friction: self.friction.is_some(),
            faces: self.faces,
        })
    }
    fn friction(&self, v: f64) -> (f64, f64) {
        self.friction.map_or((0.0, 0.0), |(f, d)| (f + d * v, d))
    }
    fn film(&mut self, v: f64) -> Result<FaceForces, EvalError> {
        self.evaluations += 1;
        self.flux = [1e-6 + 2.0 * v, 3e-6 - 4.0 * v];
        Ok(self.film_at(v))
    }
    fn film_load(&mut self, v: f64) -> Result<(f64, f64), EvalError> {
        self.loads += 1;
        let f = self.film_at(v);
        Ok((f.load, -f.squeeze_damping))
    }
    fn carry(&mut self, load: f64) -> Result<(f64, FaceForces), EvalError> {
        if self.fails_to_carry {
            return Err(EvalError::recoverable("test", "no film carries this"));
        }
        let v = (self.film_at(0.0).load - load) / self.damping;
        Ok((v, self.film_at(v)))
    }
    fn flux(&mut self) -> &mut [f64; 2] {
        &mut self.flux
    }
}

impl RadialTrials for Ring {
    fn set_thickness(&mut self, h: f64) -> Result<(), EvalError> {
        (self.h, self.seen) = (h, Seen::default());
        Ok(())
    }
}

/// Limits that nothing reaches.
fn far() -> RadialLimits {
    RadialLimits {
        min_load: 1e-9,
        radial_speed: 1e9,
        radial_drag: 1e5,
        contact_drag: 0.0,
        drag_counts: (1e9, 1e10),
        drag_gap: (1e9, 1e10),
        retreat_band: 1e-9,
    }
}

fn motion(limits: RadialLimits) -> Box<dyn RadialMotion> {
    FilmBalance {}.build(&RadialMotionCtx::new(1, OMEGA, 3e-6, limits)).expect("builds")
}

fn answer(m: &mut dyn RadialMotion, ring: &mut Ring) -> RadialResponse {
    let mut dy = [f64::NAN];
    let y = [ring.h.ln()];
    let r = m.rates(&y, ring, &mut dy).expect("a balance");
    // d(ln h)/dθ = ḣ/(h ω): two roundings.
    let rate = r.hdot / (ring.h * OMEGA);
    assert!((dy[0] - rate).abs() <= 4.0 * f64::EPSILON * rate.abs(), "{} {rate}", dy[0]);
    r
}

fn once(limits: RadialLimits, mut ring: Ring) -> RadialResponse {
    answer(&mut *motion(limits), &mut ring)
}

fn near(got: f64, want: f64, tolerance: f64) {
    assert!((got - want).abs() <= tolerance * want.abs(), "{got:e}, expected {want:e}");
}

#[test]
fn the_state_is_the_logarithm_of_the_film() {
    let mut m = motion(far());
    assert_eq!((m.states().len(), m.states()[0].name.as_str()), (1, "film of ring2"));
    assert_eq!(m.states()[0].changes, Signals::FILM_THICKNESS);
    assert_eq!(
        m.reads(),
        Signals::FILM_THICKNESS | Signals::EXTENT | Signals::TEMPERATURE | Signals::PRESSURE
    );
    let mut y = [0.0];
    m.initial(&mut y);
    near(m.thickness(&y), 3e-6, 1e-14); // an exponential of a logarithm of 13
}

#[test]
fn the_smooth_maximum_keeps_sum_and_product() {
    // The two roots of x² - w x - floor² = 0.
    for w in [-1e3, -1.0, 0.0, 0.3, 7.0] {
        let (up, down) = (soft(w, 0.2), soft(-w, 0.2));
        // The smaller root is a difference of numbers of the size of w.
        assert!(
            (up - down - w).abs() <= 1e-15 * w.abs() && (up * down - 0.04).abs() <= 1e-15 * w * w + 1e-16
        );
    }
    assert_eq!(soft(0.0, 0.5), 0.5);
}

#[test]
fn one_film_carries_what_contact_and_dry_gas_leave() {
    for (contact, dry) in [(0.0, 0.0), (200.0, 0.0), (0.0, 150.0), (300.0, 90.0)] {
        let r = once(far(), Ring { contact, dry, ..Ring::new() });
        // Without a drag on contact: 1300 - 1e6 v = 1000 - contact - dry.
        near(r.hdot, (1300.0 - (1000.0 - contact - dry)) / 1e6, 1e-12);
        let film = r.film.expect("found with the velocity");
        near(film.load, 1000.0 - contact - dry, 1e-12);
    }
    // A film is asked for a small load at least, of which the response tells.
    let floor = RadialLimits { min_load: 0.5, ..far() };
    let r = once(floor, Ring { load: 30.0, ..Ring::new() });
    let asked = 15.0 + (225.0_f64 + 2500.0).sqrt();
    near(r.hdot, (1300.0 - asked) / 1e6, 1e-12);
    near(r.limited.lifted, asked - 30.0, 1e-12);
}

#[test]
fn several_faces_and_friction_share_one_velocity() {
    for (faces, friction) in [(2, None), (1, Some((40.0, 2e6))), (2, Some((-25.0, 5e5)))] {
        for load in [1000.0, 1900.0] {
            let r = once(far(), Ring { faces, friction, load, ..Ring::new() });
            let (f, d) = friction.unwrap_or((0.0, 0.0));
            // 1300 - 1e6 v = load + f + d v; searches end within 1e-12 of the load.
            near(r.hdot, (1300.0 - load - f) / (1e6 + d), 1e-8);
            assert!(r.film.is_none());
        }
    }
}

#[test]
fn a_search_finds_the_root_of_a_curved_film_from_anywhere() {
    // 1300 - 1e6 v + 2e8 v² = load, the falling branch v < 2.5e-3.
    let mut m = motion(far());
    for load in [900.0, 1299.0, 1305.0, 4000.0, 30_000.0, 1100.0, 300.0] {
        let mut ring = Ring { faces: 2, bend: 2e8, load, ..Ring::new() };
        let r = answer(&mut *m, &mut ring);
        let v = (1e6 - (1e12_f64 - 8e8 * (1300.0 - load)).sqrt()) / 4e8;
        near(r.hdot, v, 1e-7); // a search ends 1e-9 of the load off, near a root that v lies close to zero
    }
}

#[test]
fn surfaces_that_part_have_a_drag_and_those_that_meet_have_none() {
    let limits = RadialLimits { contact_drag: 4e6, ..far() };
    // Parting: 1300 - 1e6 v = 1000 - 250 + D v with D = 4e6 · 250/1250.
    let ring = Ring { contact: 250.0, ..Ring::new() };
    let r = once(limits, ring.clone());
    let drag = 4e6 * 250.0 / 1250.0;
    near(r.hdot, 550.0 / (1e6 + drag), 1e-8);
    near(r.limited.contact_drag, drag * 550.0 / (1e6 + drag), 1e-8);
    // The next search starts there and ends there.
    let mut m = motion(limits);
    let mut same = ring;
    let (a, b) = (answer(&mut *m, &mut same).hdot, answer(&mut *m, &mut same).hdot);
    near(b, a, 1e-8);
    // Meeting: as without.
    let r = once(limits, Ring { contact: 250.0, load: 2000.0, ..Ring::new() });
    near(r.hdot, -450.0 / 1e6, 1e-8);
    assert_eq!(r.limited.contact_drag, 0.0);
}

#[test]
fn a_ring_without_film_moves_against_its_drag() {
    let dry = Ring { resists: false, contact: 400.0, dry: 50.0, ..Ring::new() };
    let r = once(far(), dry.clone());
    near(r.hdot, -550.0 / 1e5, 1e-12);
    near(r.limited.drag, 550.0, 1e-12);
    assert_eq!(r.film, Some(FaceForces::default()));
    let r = once(far(), Ring { carries: false, ..dry });
    assert_eq!((r.hdot, r.limited.drag), (0.0, 0.0));
}

#[test]
fn velocities_fade_out_at_the_ends_of_the_way_and_below_the_cap() {
    // The cap: v/√(1 + (v/cap)²), with 3e-4 beside 4e-4 it is 0.8 of that.
    let r = once(RadialLimits { radial_speed: 4e-4, ..far() }, Ring::new());
    near(r.hdot, 0.8 * 3e-4, 1e-12);
    near(r.limited.slowed, 0.2, 1e-12);
    assert!(r.film.is_none(), "the film found is not that of the velocity");
    // Retreat: the last tenth of the way to 1 mm, half of which is left.
    let r = once(RadialLimits { retreat_band: 0.1, ..far() }, Ring { h: 0.95e-3, ..Ring::new() });
    near(r.hdot, 0.5 * 3e-4, 1e-9);
    // Approach: half of the band above the lowest film is left.
    let near_floor = Ring { h: 1.05e-6, lowest: (1e-6, 0.1), load: 1500.0, ..Ring::new() };
    near(once(far(), near_floor.clone()).hdot, -0.5 * 2e-4, 1e-9);
    // Away from there nothing hinders it.
    near(once(far(), Ring { load: 1000.0, ..near_floor }).hdot, 3e-4, 1e-9);
}

#[test]
fn on_the_floor_a_ring_rests_while_its_film_carries_less_than_it_must() {
    let floor = Ring { h: 1e-6, lowest: (1e-6, 0.1), load: 2000.0, ..Ring::new() };
    let r = once(far(), floor.clone());
    assert_eq!(r.hdot, 0.0);
    near(r.film.expect("the film at rest").load, 1300.0, 0.0);
    // Friction adds to what it must carry.
    let r = once(far(), Ring { load: 1250.0, friction: Some((60.0, 0.0)), ..floor.clone() });
    assert_eq!(r.hdot, 0.0);
    // A film that carries more lifts it.
    let r = once(far(), Ring { load: 1250.0, ..floor });
    near(r.hdot, 50.0 / 1e6, 1e-9);
}

#[test]
fn the_drag_of_a_ring_off_the_liner_comes_in_smoothly() {
    // 1300 - 1e6 v = 1000 + D v; D = 1e5 where both ramps are 1, and smoothsteps of them below.
    let limits = RadialLimits { drag_counts: (1e-9, 1e-8), drag_gap: (1.0, 3.0), ..far() };
    let smooth = |x: f64| x * x * (3.0 - 2.0 * x);
    for (h, off) in [(0.9e-6, 0.0), (1.5e-6, 0.25), (2e-6, 0.5), (3e-6, 1.0), (9e-6, 1.0)] {
        let drag = 1e5 * smooth(off);
        let r = once(limits, Ring { h, ..Ring::new() });
        near(r.hdot, 300.0 / (1e6 + drag), 1e-9);
        near(r.limited.drag, drag * 300.0 / (1e6 + drag), 1e-9);
    }
    // The free velocity 3e-4 against 1e5 takes a share of 0.03 of the load: halfway between 0.01 and 0.09 in its logarithm.
    let limits = RadialLimits { drag_counts: (0.01, 0.09), drag_gap: (0.0, 1.0), ..far() };
    near(once(limits, Ring::new()).hdot, 300.0 / (1e6 + 0.5e5), 1e-9);
    // Approach as well as retreat.
    let r = once(limits, Ring { load: 1600.0, ..Ring::new() });
    let share = 1e5 * 3e-4 / 1600.0_f64;
    let drag = 1e5 * smooth((share / 0.01).ln() / 9.0_f64.ln());
    near(r.hdot, -300.0 / (1e6 + drag), 1e-9);
}

/// How far a stage from `base` to `x` goes beyond where its rates lead, `x - base - s ḣ(x)/(h ω)`, and these.
fn beyond_rates(
    limits: RadialLimits,
    ring: &Ring,
    (base, step): (f64, f64),
    x: f64,
) -> (f64, RadialResponse) {
    let rates = once(limits, Ring { h: x.exp(), ..ring.clone() });
    (x - base - step * rates.hdot / (x.exp() * OMEGA), rates)
}

#[test]
fn a_stage_off_the_liner_ends_where_its_rates_say() {
    let limits = RadialLimits {
        min_load: 1e-3,
        radial_speed: 3.0,
        radial_drag: 10.0,
        drag_counts: (1e-3, 0.1),
        drag_gap: (2.0, 5.0),
        ..far()
    };
    let (base, accuracy) = (3e-5_f64.ln(), [1e-9]);
    let (mut drags, mut most) = ([0; 3], 0);
    // Films that resist little, as much as the drag, and far more; rings that float, that leave at the cap, and that gas lifts or brings back.
    for damping in [1e-2, 10.0, 300.0, 1e5] {
        for push in [0.1, 1.0, 5.0, 30.0, 150.0, 450.0, -0.1, -1.0, -5.0, -30.0, -150.0, -2000.0] {
            for step in [1e-4, 1e-3, 1e-2] {
                let ring = Ring { damping, falls: 0.3, load: 577.0 - push, ..Ring::new() };
                let stage = Stage { number: 1, base: &[base], step, accuracy: &accuracy };
                let (mut m, mut tried) = (motion(limits), ring.clone());
                let (mut y, mut rates) = ([base], RadialResponse::default());
                for _ in 0..2 {
                    (tried.evaluations, tried.loads) = (0, 0);
                    let (response, _) = m.stage(&stage, &mut y, &mut tried).expect("a stage");
                    // A drag that sets in with the velocity that the film alone allows can leave several roots: this is one.
                    let at = |x: f64| beyond_rates(limits, &ring, (base, step), x);
                    let ((before, _), (after, _)) = (at(y[0] - accuracy[0]), at(y[0] + accuracy[0]));
                    assert!(before < 0.0 && after > 0.0, "{damping} {push} {step}: {before} {after}");
                    rates = at(y[0]).1;
                    assert!(
                        (response.limited.drag > 0.0) == (rates.limited.drag > 0.0),
                        "{damping} {push} {step}"
                    );
                }
                most = most.max(tried.evaluations + tried.loads);
                drags[if rates.limited.drag == 0.0 {
                    0
                } else {
                    1 + usize::from(rates.limited.slowed > 0.1)
                }] += 1;
            }
        }
    }
    assert!(drags.iter().all(|n| *n > 10), "free, dragged, at the cap: {drags:?}");
    // A stage that is known begins at its end.
    assert!(most <= 12, "{most} films");
}

#[test]
fn a_film_that_never_carries_so_little_leaves_the_velocity_to_its_limits() {
    let limits = RadialLimits { radial_speed: 0.1, ..far() };
    // At the velocity 100 m/s the film still carries 1300 N/m.
    let pulled = Ring { damping: 0.0, fails_to_carry: true, ..Ring::new() };
    let r = once(limits, pulled.clone());
    // 1000 times the cap: the cap to half a millionth.
    near(r.hdot, 0.1, 1e-6);
    // One that would carry less fails as it did.
    let mut m = motion(limits);
    let mut ring = Ring { rest: 900.0, ..pulled };
    assert!(m.rates(&[ring.h.ln()], &mut ring, &mut [0.0]).is_err_and(|e| e.is_recoverable()));
}

#[test]
fn small_changes_are_followed_along_the_tangent() {
    let base = Ring { faces: 2, bend: 1e8, friction: Some((20.0, 3e5)), contact: 100.0, ..Ring::new() };
    for (load, contact_drag) in [(1000.0, 2e6), (1700.0, 2e6), (1000.0, 0.0)] {
        let limits = RadialLimits { contact_drag, min_load: 0.05, ..far() };
        let mut m = motion(limits);
        let mut ring = Ring { load, ..base.clone() };
        let r = answer(&mut *m, &mut ring);
        let film = ring.film(r.hdot).expect("a film");
        m.begin_differences(&mut ring, &film, false).expect("a tangent");
        for change in [1e-3, -1e-3] {
            let mut moved = Ring { load: load + change, rest: ring.rest + 2.0 * change, ..ring.clone() };
            moved.evaluations = 0;
            let got = answer(&mut *m, &mut moved);
            assert_eq!(moved.evaluations, 1, "one step of Newton's method");
            let exact = once(limits, moved.clone());
            // The change of the velocity by a search for each, which ends within 1e-9; Newton's method is of second order in 1e-6.
            let (a, b) = (got.hdot - r.hdot, exact.hdot - r.hdot);
            assert!((a - b).abs() <= 2e-3 * b.abs(), "{load} {change}: {a:e} {b:e}");
            // Forces and fluxes are extrapolated to the new velocity.
            let (f, want) = (got.film.expect("extrapolated"), moved.film_at(got.hdot));
            for (x, y) in [
                (f.load, want.load),
                (f.squeeze_damping, want.squeeze_damping),
                (f.ring_shear, want.ring_shear),
                (f.liner_shear, want.liner_shear),
                (f.slope_force, want.slope_force),
                (f.flux, want.flux),
                (moved.flux[0], 1e-6 + 2.0 * got.hdot),
                (moved.flux[1], 3e-6 - 4.0 * got.hdot),
            ] {
                // Derivatives over a millionth of the pull, times a change of a few 1e-10 m/s.
                near(x, y, 1e-9);
            }
        }
        m.end_differences();
        let again = answer(&mut *m, &mut Ring { load: load + 50.0, ..base.clone() });
        near(again.hdot, once(limits, Ring { load: load + 50.0, ..base.clone() }).hdot, 1e-6);
    }
}

#[test]
fn differences_search_where_a_tangent_is_not_worth_its_film() {
    // A velocity that came with its film: differences are found by the same call, from the velocity of the instant.
    let mut m = motion(far());
    let mut ring = Ring::new();
    let r = answer(&mut *m, &mut ring);
    m.begin_differences(&mut ring, &r.film.expect("a film"), false).expect("nothing to do");
    let moved = answer(&mut *m, &mut Ring { load: 1001.0, ..Ring::new() });
    near(moved.hdot, 299.0 / 1e6, 1e-12);
    m.end_differences();
    // On a floor the search knows the corner, which a tangent does not.
    let mut m = motion(far());
    let mut ring = Ring { faces: 2, ..Ring::new() };
    let r = answer(&mut *m, &mut ring);
    let film = ring.film(r.hdot).expect("a film");
    m.begin_differences(&mut ring, &film, true).expect("nothing to do");
    ring.evaluations = 0;
    answer(&mut *m, &mut ring);
    assert_eq!(ring.evaluations, 0, "loads alone");
}
