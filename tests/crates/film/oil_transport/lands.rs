//! Oil on the lands, against the closed forms of its flows.

use gudgeon_core::kinds::{OilDrive, OilLand, OilLedger, OilPassed};
use gudgeon_film::parts::{LandCycle, Lands};

const DENSITY: f64 = 850.0;
const MU: f64 = 5e-3;
const HEIGHT: f64 = 4e-3;
const GAP: f64 = 2e-3;

/// Three lands, the lowest above a groove that drains.
fn places() -> [OilLand; 3] {
    [false, false, true].map(|drained| OilLand { height: HEIGHT, gap: GAP, drained })
}

/// These with films of one thickness each \[m\].
fn lands(films: [f64; 3]) -> Lands {
    let mut lands = Lands::new(&places(), DENSITY);
    lands.set_volumes(&films.map(|film| film * HEIGHT));
    lands
}

fn drive(dt: f64, acceleration: f64, pressures: &[f64]) -> OilDrive<'_> {
    OilDrive { dt, acceleration, viscosity: &[MU; 3], pressures }
}

const LEVEL: [f64; 4] = [1e5; 4];

fn passed(p: &Lands, ring: usize) -> OilPassed {
    p.passed().nth(ring).unwrap()
}

/// Films \[m\] after `steps` equal steps over `span` \[s\].
fn after(p: &mut Lands, steps: u32, span: f64, a: f64, pressures: &[f64]) -> (Vec<f64>, OilLedger) {
    let mut ledger = OilLedger::default();
    for _ in 0..steps {
        p.step(&drive(span / f64::from(steps), a, pressures), &mut ledger);
    }
    (p.volumes().map(|v| v / HEIGHT).collect(), ledger)
}

/// `δ = δ_0/sqrt(1 + 2 c δ_0² t)`, `c = ρ a/(3 μ H)`, of what is open: the whole crown upwards, the whole groove that drains downwards.
#[test]
fn inertia_thins_a_film_as_its_closed_form_says() {
    let (film, a, t) = (20e-6, 3000.0, 4e-3);
    let c = DENSITY * a / (3.0 * MU * HEIGHT);
    let left = film / (1.0 + 2.0 * c * film * film * t).sqrt();
    for (land, a) in [(0, -a), (2, a)] {
        for steps in [1, 7] {
            let mut p = lands(std::array::from_fn(|k| if k == land { film } else { 0.0 }));
            let (films, ledger) = after(&mut p, steps, t, a, &LEVEL);
            // Steps of an exact solution add up to one: a few roundings.
            assert!((films[land] - left).abs() <= 1e-14 * film, "{land} {steps}: {films:?} {left:e}");
            let (gone, other) =
                if land == 0 { (ledger.thrown, ledger.drained) } else { (ledger.drained, ledger.thrown) };
            assert!((gone - (film - left) * HEIGHT).abs() <= 1e-14 * film * HEIGHT && other == 0.0);
        }
    }
}

/// Between rings only the end gap is open, and what passes it is counted with the ring.
#[test]
fn a_ring_lets_pass_what_comes_to_its_gap() {
    let (film, t) = (20e-6, 1e-3);
    let mut p = lands([0.0, film, 0.0]);
    let (films, ledger) = after(&mut p, 1, t, -3000.0, &LEVEL);
    let c = GAP * DENSITY * 3000.0 / (3.0 * MU * HEIGHT);
    let moved = (film - film / (1.0 + 2.0 * c * film * film * t).sqrt()) * HEIGHT;
    // The difference of two volumes: a few roundings of these.
    let rounding = 1e-15 * film * HEIGHT;
    assert!((passed(&p, 0).up - moved).abs() <= rounding, "{:e} {moved:e}", passed(&p, 0).up);
    assert_eq!((passed(&p, 0).down, passed(&p, 1).up, ledger.thrown), (0.0, 0.0, 0.0));
    assert!((films[0] * HEIGHT - moved).abs() <= rounding);
    // Thrown the other way it stays above ring 2 but for the gap of that.
    let up = passed(&p, 0).up;
    after(&mut p, 1, t, 3000.0, &LEVEL);
    assert!(passed(&p, 1).down > 0.0 && passed(&p, 0).up == up);
}

/// `δ = δ_0/(1 + c δ_0 t)`, `c = φ τ/(2 μ H)`, against the gas towards the lower pressure; beyond a choked flow the shear stress follows the higher one.
#[test]
fn gas_drags_oil_towards_the_lower_pressure() {
    let (film, t) = (20e-6, 1e-3);
    for (p2, p3, from, to, shear) in [
        (5e5, 4e5, 1, 2, 0.008 * 1e5),
        (5e5, 1e5, 1, 2, 0.008 * 0.47 * 5e5),
        (1e5, 3e5, 2, 1, 0.008 * 0.47 * 3e5),
    ] {
        let mut p = lands(std::array::from_fn(|k| if k == from { film } else { 0.0 }));
        // Nothing else moves oil: no acceleration, and no pressure difference at the other rings.
        let pressures = [p2, p2, p3, p3];
        let (films, ledger) = after(&mut p, 5, t, 0.0, &pressures);
        let left = film / (1.0 + GAP * shear / (2.0 * MU * HEIGHT) * film * t);
        assert!((films[from] - left).abs() <= 1e-14 * film, "{films:?} {left:e}");
        assert!((films[to] - (film - left)).abs() <= 1e-14 * film);
        assert_eq!((ledger.drained, ledger.thrown), (0.0, 0.0));
    }
}

/// Whatever moves it, what leaves one place is what comes to another, and no land gets less than nothing.
#[test]
fn oil_on_lands_is_neither_made_nor_lost() {
    let mut p = lands([30e-6, 200e-6, 5e-6]);
    let total = |p: &Lands| p.volumes().sum::<f64>();
    let (before, mut ledger) = (total(&p), OilLedger::default());
    for k in 0..1000 {
        let pressures = [f64::from(k % 70 + 1) * 1e5, f64::from(k % 30 + 1) * 1e5, 2e5, 1e5];
        p.step(&drive(1e-3, 5e3 * (f64::from(k) * 0.3).sin(), &pressures), &mut ledger);
        p.put(2, 1e-9, &mut ledger);
        assert!(p.volumes().all(|v| v >= 0.0));
    }
    let closure = before + 1000.0 * 1e-9 - total(&p) - ledger.drained - ledger.thrown;
    // Some thousands of additions of the size of the whole.
    assert!(closure.abs() <= 1e-12 * before, "{closure:e} of {before:e}");
    assert!(ledger.drained > 0.0 && ledger.thrown > 0.0);
}

/// The periodic state of a land that gets `q` a second and drains at a steady acceleration: `ρ a δ³/(3 μ) = q`, whatever it takes to get there.
#[test]
fn a_land_that_fills_over_many_cycles_settles_where_it_drains_what_it_gets() {
    let (q, a, steps, dt) = (1e-8, 2000.0, 400, 1e-4);
    let mut cycle = LandCycle::new(&places(), DENSITY);
    let mut ledger = OilLedger::default();
    cycle.clear();
    for _ in 0..steps {
        cycle.scrape(2, 2, q * dt, &mut ledger);
        cycle.pass(1, false, 0.1 * q * dt, &mut ledger);
        cycle.pass(0, true, q * dt, &mut ledger);
        cycle.step(&drive(dt, a, &LEVEL));
    }
    cycle.settle(&mut ledger);
    let came = 1.1 * q * dt * f64::from(steps);
    assert!((ledger.drained - came).abs() <= 1e-11 * came && ledger.thrown == 0.0, "{ledger:?} {came:e}");
    assert!(cycle.gained().abs() <= 1e-11 * came);
    let film = (1.1 * q * 3.0 * MU / (DENSITY * a)).cbrt();
    let found = cycle.lands().volumes().nth(2).unwrap() / HEIGHT;
    // What came in a step lies there before it flows: half of it beside the steady film, 3e-5 of that.
    assert!((found - film).abs() <= 1e-4 * film, "{found:e} {film:e}");
    assert_eq!(passed(cycle.lands(), 2).scraped, cycle_sum(q * dt, steps));
}

fn cycle_sum(part: f64, times: u32) -> f64 {
    (0..times).fold(0.0, |sum, _| sum + part)
}

/// Where no end gap is open the lands between rings get nothing and lose nothing: they are dry, and the others are found as ever.
#[test]
fn lands_that_nothing_reaches_are_dry() {
    let shut = places().map(|place| OilLand { gap: 0.0, ..place });
    let mut cycle = LandCycle::new(&shut, DENSITY);
    let mut ledger = OilLedger::default();
    cycle.clear();
    for _ in 0..100 {
        cycle.scrape(2, 2, 1e-12, &mut ledger);
        cycle.step(&drive(1e-4, 2000.0, &LEVEL));
    }
    cycle.settle(&mut ledger);
    assert!((ledger.drained - 1e-10).abs() <= 1e-10 * 1e-10, "{ledger:?}");
    let volumes: Vec<f64> = cycle.lands().volumes().collect();
    assert!(volumes[0] == 0.0 && volumes[1] == 0.0 && volumes[2] > 0.0, "{volumes:?}");
}
