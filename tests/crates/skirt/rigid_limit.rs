//! A skirt that yields less and less moves as a rigid one, whatever its compliance.

use std::fmt::Write as _;

use gudgeon_core::Registry;
use gudgeon_core::file::Files;
use gudgeon_core::kinds::{
    GrooveFrictionCtx, GrooveFrictionSpec, PinFrictionSpec, SkirtComplianceCtx, SkirtComplianceSpec,
    SkirtProfileCtx, SkirtProfileSpec,
};
use gudgeon_core::quantity::quantity;
use gudgeon_film::WavinessTransport;
use gudgeon_film::film_2d::{Cavitation, Direct};
use gudgeon_skirt::{
    ContactGrid, Cylindrical, InfluenceMatrix, Modal, NoGrooveFriction, NoPinFriction, Panel, Piston, Rigid,
    Shape, Side, SideSetup,
};

use crate::common::*;

/// Steps of one degree of crank angle, over the ignition.
const ANGLES: std::ops::Range<u32> = 360..420;
/// Time in which a shape comes back to rest \[s\], as of cases.
const RELAXATION: f64 = 1e-6;

/// Deflections \[m/N\] of a skirt that bends from its upper edge and flattens, divided by `hardness`.
fn matrix(hardness: f64) -> Files {
    let height = |i: u32| LENGTH * f64::from(i) / 4.0;
    let all: Vec<(f64, f64)> =
        (0..5).flat_map(|j| (0..5).map(move |i| (height(i), 0.3 * f64::from(j) - 0.6))).collect();
    let bend = |p: (f64, f64)| (p.0 / LENGTH).powi(2) * (2.0 * p.1).cos();
    let mut text = String::new();
    for (k, a) in all.iter().enumerate() {
        // Writing to a text cannot fail.
        let _ = write!(text, "{} {}", a.0, a.1.to_degrees());
        for (m, b) in all.iter().enumerate() {
            let own = if m == k { 1e-11 } else { 0.0 };
            let c = 4e-9 * bend(*a) * bend(*b) + 1e-9 * a.1.cos() * b.1.cos() + own;
            let _ = write!(text, ",{:e}", c / hardness);
        }
        text.push('\n');
    }
    Files::recorded([("compliance.csv".to_owned(), text)])
}

fn side_with(which: usize, compliance: &dyn SkirtComplianceSpec, files: &Files) -> Side {
    let panel = Panel { radius: RADIUS, length: LENGTH, half_angle: HALF[which] };
    let profile =
        Cylindrical {}.build(&SkirtProfileCtx { length: LENGTH, radius: RADIUS, files }).expect("builds");
    let grid = panel.grid(8, 8, 0.0);
    let ctx = SkirtComplianceCtx::new(&grid, LENGTH, RADIUS, HALF[which], files).relaxing(RELAXATION);
    Side::new(SideSetup {
        boundary_friction: None,
        panel,
        sign: [1.0, -1.0][which],
        clearance: 1e-5,
        grid: &grid,
        film: &Direct { cavitation: Cavitation::HalfSommerfeld, ..Direct::default() },
        roughness: &waves(WavinessTransport::Homogenised),
        contact: &gudgeon_contact::Off {},
        contact_grid: ContactGrid { pitch: 1e-3, intervals: 4 },
        profile: &*profile,
        compliance: compliance.build(&ctx).expect("a compliance"),
        shear_thinning: None,
        p_cav: 0.0,
        floor: 1e-7,
    })
    .expect("builds")
}

/// How a piston moves over the ignition that begins at rest in the middle of its bore: both edges at the end \[m\], highest pressure \[Pa\] and friction work \[J\].
fn motion(compliance: &dyn SkirtComplianceSpec, files: &Files) -> [f64; 4] {
    let sides = [0, 1].map(|which: usize| side_with(which, compliance, files));
    let groove = NoGrooveFriction {}.build(&GrooveFrictionCtx { bore: 0.07651 }).expect("none");
    let mut p = Piston::new(sides, body(), crank(), NoPinFriction {}.build().expect("none"), groove);
    let (mut from, mut x) = (vec![0.0; p.coordinates()], vec![0.0; p.coordinates()]);
    let mut w = vec![0.0; p.coordinates()];
    let dt = 1f64.to_radians() / p.crank.omega;
    let (mut p_max, mut work) = (0.0_f64, 0.0);
    for deg in ANGLES {
        let deg = f64::from(deg + 1);
        // A pulse like that of a combustion: 40 bar at 385 deg.
        let gas = 40e5 * (-((deg - 385.0) / 25.0_f64).powi(2)).exp();
        let now = p.crank.instant(deg.to_radians(), &slider_crank(&p.crank, deg), gas, 4.6e-3, 0.016);
        p.euler_step(&now, &from, None, dt, &mut w, &mut x).expect("a step");
        from.copy_from_slice(&x);
        let told = p.summary(&now, &x, &w).expect("films");
        p_max = p_max.max(told.p_max[0].max(told.p_max[1]));
        work -= told.friction() * now.speed * dt;
    }
    [x[0], x[1], p_max, work]
}

fn modal(hardness: f64) -> Modal {
    Modal {
        stiffness: vec![quantity(2.5e8 * hardness), quantity(6e8 * hardness)],
        shapes: vec![Shape { power: 2, waves: 1 }, Shape { power: 0, waves: 1 }],
        file: None,
    }
}

/// Values of a shape that bends from the upper edge and of one that flattens, at points.
fn shapes_in_a_file() -> Files {
    let mut text = String::new();
    for (i, j) in (0..5).flat_map(|i| (0..7).map(move |j| (i, j))) {
        let (height, angle) = (LENGTH * f64::from(i) / 4.0, 0.25 * f64::from(j) - 0.75);
        let (bent, flat) = ((height / LENGTH).powi(2) * angle.cos(), (1.5 * angle).cos());
        // Writing to a text cannot fail.
        let _ = writeln!(text, "{height} {} {bent} {flat}", angle.to_degrees());
    }
    Files::recorded([("shapes.csv".to_owned(), text)])
}

/// A motion at so many times the stiffness.
type Motion<'a> = &'a dyn Fn(f64) -> [f64; 4];

#[test]
fn every_compliance_has_the_rigid_skirt_as_its_limit() {
    let none = Files::default();
    let rigid = motion(&Rigid {}, &none);
    let by_matrix = |hardness: f64| {
        let spec = InfluenceMatrix { file: "compliance.csv".into(), shapes: 12, rest: quantity(1e-3) };
        motion(&spec, &matrix(hardness))
    };
    let by_modes = |hardness: f64| motion(&modal(hardness), &none);
    let shapes = shapes_in_a_file();
    let by_file = |hardness: f64| {
        let spec = Modal { shapes: Vec::new(), file: Some("shapes.csv".into()), ..modal(hardness) };
        motion(&spec, &shapes)
    };
    let all: [(&str, Motion<'_>); 3] =
        [("modal", &by_modes), ("modal", &by_file), ("influence_matrix", &by_matrix)];
    // A compliance that is added later is missed here.
    for model in Registry::collect().models("skirt_compliance") {
        let is_tested = model.name == "rigid" || all.iter().any(|(name, _)| *name == model.name);
        assert!(is_tested, "{} has no test of its rigid limit", model.name);
    }
    for (name, of) in all {
        let away = [100.0, 300.0, 1000.0, 3000.0, 10_000.0].map(|hardness| {
            let found = of(hardness);
            [0, 1, 2, 3].map(|k: usize| found[k] - rigid[k])
        });
        for (k, what) in ["upper edge", "lower edge", "pressure", "friction work"].into_iter().enumerate() {
            // Deflections go with the compliance, and so does all that follows from them: from 3000 to 10 000 times the stiffness to three tenths, up to what is of second
            // order in the deflection. That falls tenfold too: it makes the same ratio 1.2 times as large from 300 to 1000 times, and 1.01 times here.
            let ratio = away[3][k] / away[4][k];
            assert!((ratio * 0.3 - 1.0).abs() < 0.02, "{name}, {what}: {ratio} of {away:?} {rigid:?}");
            // Nearer with every stiffness.
            assert!(away.windows(2).all(|w| w[1][k].abs() < w[0][k].abs()), "{name}, {what}: {away:?}");
        }
        // 1 kN on 2.5e12 N/m: 0.4 nm of a film of 10 um, and pressures go with its cube.
        let part = |k: usize| (away[4][k] / rigid[k]).abs();
        assert!(part(2) < 1e-4 && part(3) < 1e-4, "{name}: {away:?} {rigid:?}");
    }
}
