//! Strips of oil of finite volume on the flanks.

use gudgeon_core::geometry::RingPlace;
use gudgeon_core::kinds::{Flank, FlankCtx, FlankIn, FlankSpec};
use gudgeon_core::quantity::quantity;
use gudgeon_ring::{Dry, WettedStrip};

const C: f64 = 7e-5;
const A: f64 = 1.8e-3;
const WIDTH: f64 = 5e-3;
const MU: f64 = 0.01;
const SIGMA: f64 = 0.4e-6;
const OMEGA: f64 = 200.0;

fn built(spec: &WettedStrip, fill: f64) -> Box<dyn Flank> {
    spec.build(&FlankCtx::new(0, 3, fill, WIDTH, MU).at_speed(OMEGA)).expect("builds")
}

/// Strips that nothing renews within the time of a test.
fn forgotten() -> WettedStrip {
    WettedStrip { renewal: quantity(1e12), ..WettedStrip::default() }
}

fn at(film: &dyn Flank, y: &[f64], s: f64, v: f64) -> RingPlace {
    let mut place = RingPlace { s, v, clearance: C, ..RingPlace::default() };
    place.flank = film.oil(y, &place);
    place
}

#[test]
fn a_drawn_out_strip_keeps_its_volume_and_its_force_falls_with_the_sixth_power() {
    let film = built(&WettedStrip { gas_viscosity: quantity(0.0), ..WettedStrip::default() }, 0.3);
    let law = film.law();
    let y = [1.0, 0.0];
    for h in [4e-6, 8e-6, 1.6e-5] {
        let gap = h + SIGMA;
        let place = at(&*film, &y, h, -1e-3);
        // The strip is far from as wide as the ring: x = 0.3 σ/H < 0.03, and x⁴/4 < 2e-7.
        assert!((place.flank.wetted[0] * gap / (0.3 * WIDTH * SIGMA) - 1.0).abs() < 1e-6);
        let b = 0.3 * WIDTH * SIGMA / gap;
        let exact = MU * (A / WIDTH) * (b / gap).powi(3) * 1e-3;
        let force = law.force(&place.flank, h, -1e-3, C, A);
        // Three times the error of the width.
        assert!((force / exact - 1.0).abs() < 1e-6, "{h}: {force:e} {exact:e}");
    }
}

#[test]
fn a_seated_strip_is_closed_and_one_that_is_drawn_out_opens() {
    let film = built(&WettedStrip::default(), 0.3);
    let open = |s: f64| at(&*film, &[1.0, 1.0], s, 0.0).flank.open[0];
    // b = 1.5 mm over σ = 0.4 µm.
    assert!(open(0.0) < 1e-7, "{:e}", open(0.0));
    let mut last = open(0.0);
    for k in 1..=200 {
        let now = open(C * k as f64 / 200.0);
        assert!(now > last, "opens further as it is drawn out");
        last = now;
    }
    // At H = c the strip would be 8.5 µm wide: x² with x = 8.5/70.4 is the share that is closed.
    assert!((last - 1.0 / (1.0 + (8.523e-6_f64 / 70.4e-6).powi(2))).abs() < 1e-5, "{last}");
    // A dry flank is open, one that is flooded closes more at every height.
    let flooded = built(&WettedStrip::default(), 1.0);
    for s in [0.0, 2e-6, 2e-5] {
        assert!(at(&*flooded, &[1.0, 1.0], s, 0.0).flank.open[0] < open(s));
        assert_eq!(at(&*film, &[0.0, 0.0], s, 0.0).flank.open[0], 1.0);
    }
}

#[test]
fn gas_drives_a_seated_strip_out_as_between_parallel_walls() {
    // Straight edges.
    let mut film = built(&WettedStrip { edge: quantity(1e-9), ..forgotten() }, 0.3);
    let (dp, mut y, steps) = (50e5, [1.0, 1.0], 4000);
    let supply = 0.3 * WIDTH * SIGMA;
    // a da/dt = -H⁴ Δp/(12 μ): dry after a_s² 6 μ/(H⁴ Δp).
    let dry = supply * supply * 6.0 * MU / (SIGMA.powi(4) * dp);
    let dt = 0.5 * dry / f64::from(steps);
    let rate = |film: &mut dyn Flank, y: &[f64; 2]| {
        let mut dy = [0.0; 2];
        // The lower flank seats under a pressure behind the ring; above the ring nothing drives.
        let place = at(film, y, 0.0, 0.0);
        film.rates(y, &FlankIn::new(&place, 1e5 + dp, 1e5 + dp, 1e5), &mut dy).expect("rates");
        dy.map(|d| d * OMEGA)
    };
    for _ in 0..steps {
        let k1 = rate(&mut *film, &y);
        let middle = [y[0] + 0.5 * dt * k1[0], y[1] + 0.5 * dt * k1[1]];
        let k2 = rate(&mut *film, &middle);
        y = [y[0] + dt * k2[0], y[1] + dt * k2[1]];
    }
    // After half of that time √½ of the volume is left, but for 2 H/b = 5e-4 of the flow, and x⁴/4 = 2e-3 in the width at the start.
    assert!((y[0] / 0.5_f64.sqrt() - 1.0).abs() < 2e-3, "{}", y[0]);
    assert_eq!(y[1], 1.0, "no pressure difference, no loss");
}

#[test]
fn a_ring_that_comes_down_gathers_what_the_walls_hold() {
    let mut film = built(&forgotten(), 0.3);
    let (v, steps, mut y) = (0.01, 20_000, [0.0, 1.0]);
    let (from, to) = (2e-5, 0.0);
    let dt = (from - to) / v / f64::from(steps);
    for k in 0..steps {
        let mut dy = [0.0; 2];
        let s = from - (f64::from(k) + 0.5) * dt * v;
        let place = at(&*film, &y, s, -v);
        film.rates(&y, &FlankIn::new(&place, 1e5, 1e5, 1e5), &mut dy).expect("rates");
        y[0] += dt * OMEGA * dy[0];
    }
    let missing = (-2.0 * (1.0 - (SIGMA / (from + SIGMA)).powi(2))).exp();
    // First order in steps of 1/400 of σ at the flank, where the missing oil falls by 4 dH/σ a step.
    assert!(((1.0 - y[0]) / missing - 1.0).abs() < 2e-2, "{} {missing}", 1.0 - y[0]);
    // The upper flank, from which the ring goes away, gathers nothing.
    assert_eq!(y[1], 1.0);
}

#[test]
fn rates_are_what_comes_less_what_goes() {
    let mut film = built(&WettedStrip::default(), 0.3);
    let supply = 0.3 * WIDTH * SIGMA;
    for (s, v) in [(0.0, -1e-4), (2e-6, 1e-2), (3e-5, -0.3), (C, 1e-3)] {
        let (y, mut dy) = ([0.7, 0.4], [0.0; 2]);
        let place = at(&*film, &y, s, v);
        let flow = film.rates(&y, &FlankIn::new(&place, 30e5, 20e5, 2e5), &mut dy).expect("rates");
        let change = (dy[0] + dy[1]) * OMEGA * supply;
        // Rounding of sums of the flows.
        assert!((change - (flow.fed - flow.lost)).abs() <= 1e-14 * (flow.fed + flow.lost));
        assert!((film.volume(&y) / (1.1 * supply) - 1.0).abs() < 1e-14);
    }
}

#[test]
fn no_oil_is_a_dry_groove() {
    let film = built(&WettedStrip::default(), 0.0);
    let dry = Dry::default().build(&FlankCtx::new(0, 3, 0.0, WIDTH, MU)).expect("builds").law();
    assert!(film.states().is_empty());
    for s in [0.0, 1e-6, C] {
        let place = at(&*film, &[], s, -0.1);
        assert_eq!(place.flank.open, [1.0; 2]);
        for v in [-0.1, 0.1] {
            let force = film.law().force(&place.flank, s, v, C, A);
            assert_eq!(force, dry.force(&place.flank, s, v, C, A));
        }
    }
}

#[test]
fn gas_beside_a_drawn_out_strip_damps_a_ring_between_its_flanks() {
    let film = built(&WettedStrip::default(), 0.3);
    let (s, v) = (0.5 * C, -0.01);
    let place = at(&*film, &[1.0, 1.0], s, v);
    let gap = s + SIGMA;
    // Approach below and separation above: the strip is 17 µm wide there, 0.35 % of the width.
    let b = 0.3 * WIDTH * SIGMA / gap;
    let linear = 27e-6 * (A / WIDTH) * ((WIDTH - b) / gap).powi(3) * 0.01;
    let tension = 1e5 * A * (1.0 - b / WIDTH);
    let exact = linear + linear / (1.0 + linear / tension);
    let force = film.law().force(&place.flank, s, v, C, A);
    // The strip itself adds μ (b/H)³ to μ_g ((w - b)/H)³: 1.4e-5 of it.
    assert!((force / exact - 1.0).abs() < 2e-5, "{force:e} {exact:e}");
}

#[test]
fn gas_does_not_drive_out_what_hangs_on_the_walls_beside_it() {
    let mut film = built(&forgotten(), 0.3);
    let (s, dp, edge) = (0.5 * C, 1e5, 1e-4);
    let mut lost = |y: f64| {
        let place = at(&*film, &[y, 0.0], s, 0.0);
        let at = FlankIn::new(&place, 1e5, 1e5 + dp, 1e5);
        film.rates(&[y, 0.0], &at, &mut [0.0; 2]).expect("rates").lost
    };
    let gap = s + SIGMA;
    for y in [0.01, 0.1, 1.0] {
        // Far from as wide as the flank: x⁴/4 < 1e-10.
        let b = y * 0.3 * WIDTH * SIGMA / gap;
        let closed = b * b / (b * b + gap * gap);
        let exact = closed * dp * gap.powi(3) * b / (12.0 * MU * (b + gap + edge).powi(2));
        assert!((lost(y) / exact - 1.0).abs() < 1e-9, "{y}");
    }
    // The third power of a thin strip: it is not driven to nothing in no time.
    assert!((lost(0.02) / lost(0.01) / 8.0 - 1.0).abs() < 0.01);
}

#[test]
fn less_than_no_oil_does_not_push() {
    let film = built(&WettedStrip { gas_viscosity: quantity(0.0), ..WettedStrip::default() }, 0.3);
    for (s, v) in [(0.0, -0.1), (1e-6, 0.1), (C, 0.1)] {
        let place = at(&*film, &[-0.3, -0.3], s, v);
        assert_eq!(film.law().force(&place.flank, s, v, C, A), 0.0);
    }
    // And fills again.
    let (mut film, mut dy) = (built(&forgotten(), 0.3), [0.0; 2]);
    let place = at(&*film, &[-0.3, 1.0], 0.0, 0.0);
    film.rates(&[-0.3, 1.0], &FlankIn::new(&place, 1e5, 20e5, 1e5), &mut dy).expect("rates");
    assert!(dy[0] > 0.0, "{dy:?}");
}
