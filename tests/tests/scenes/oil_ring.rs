//! Oil control rings: grooves that are vented, drained and closed, and three-piece rings whose rails seal each on its own.

use gudgeon_core::result::RunResult;
use gudgeon_scene::check;

use crate::common::*;

const DIESEL: &str = "turbo-diesel-120/flooded";
const CRANKCASE: f64 = 101_325.0;

/// The oil ring of the diesel as one of two rails of 0.6 mm on an expander. With ears of 15 degrees the upper rail flutters, and a run in thin oil does
/// not become periodic.
const THREE_PIECE: [&str; 4] = [
    "rings.2.design=three_piece",
    "rings.2.height=0.6 mm",
    "rings.2.width=3.0 mm",
    "rings.2.expander={mass=\"14 g\", height=\"2.75 mm\", ear_angle=\"30 deg\"}",
];

/// Rings that rest, gaps of given areas that lead from land to land, no leak and no influence of films: lands behind two orifices, or three.
const SEATED: [&str; 13] = [
    "models.ring_motion.model=seated",
    "models.gas_flow={model=\"orifice_network\", gap_split=0, film_height=\"nominal\"}",
    "rings.0.gap_area=0.1 mm2",
    "rings.1.gap_area=0.1 mm2",
    "rings.2.gap_area=0.05 mm2",
    "rings.0.groove.leak_upper=0 um",
    "rings.0.groove.leak_lower=0 um",
    "rings.1.groove.leak_upper=0 um",
    "rings.1.groove.leak_lower=0 um",
    "rings.2.groove.leak_upper=0 um",
    "rings.2.groove.leak_lower=0 um",
    "outputs.series_step=1 deg",
    "outputs.results=[\"blow_by\"]",
];

fn diesel(sets: &[&[&str]]) -> RunResult {
    run_case(DIESEL, &sets.concat())
}

/// The motored rings at one speed, without the sweep of their case.
fn motored(set: &[&str]) -> RunResult {
    run_case("motored-rings-1600/flooded", &[&["sweeps=[]"], set].concat())
}

fn groove_peak(r: &RunResult) -> f64 {
    peak(r, "ring3.back.p", 0.0, 720.0).0
}

/// Why a changed diesel is refused, in one line.
fn refusal(sets: &[&[&str]]) -> String {
    let told = check(&case_file(DIESEL), &overrides_of(DIESEL, &sets.concat()))
        .err()
        .map(|e| e.to_string())
        .unwrap_or_default();
    told.split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ")
}

#[test]
fn an_oil_ring_is_vented_unless_its_case_says_not() {
    let (untold, told) = (diesel(&[]), diesel(&[&["rings.2.groove.vented=true"]]));
    assert_eq!(value(&untold, "blow_by").to_bits(), value(&told, "blow_by").to_bits());
    assert!(untold.series.get("ring3.back.p").is_none());
    assert!(untold.skipped.iter().any(|s| s.what.contains("behind ring 3") && s.why.contains("vented")));
    let closed = diesel(&[&["rings.2.groove.vented=false"]]);
    // Closed, the groove takes on the pressure of the land above whenever the ring leaves its upper flank, some tenths of a bar above the crankcase then.
    assert!(groove_peak(&closed) > 1.2 * CRANKCASE, "{}", groove_peak(&closed));
    assert_eq!(closed.solver.counters["states"], untold.solver.counters["states"] + 1);
    // A compression ring is closed, and may be vented: the groove of the second ring then leads to the crankcase.
    let second = diesel(&[&["rings.1.groove.vented=true"]]);
    assert!(second.series.get("ring2.back.p").is_none());
    assert!(value(&second, "blow_by") > value(&untold, "blow_by"));
    for r in [&untold, &closed, &second] {
        // Rounding, whatever the tolerance of the run.
        assert!(r.balance.gas_mass.is_some_and(|b| b.abs() < 1e-12), "{:?}", r.balance);
    }
}

#[test]
fn holes_lead_from_a_closed_groove_to_a_vented_one() {
    let holes = |n: u32, d: &str| {
        let r = diesel(&[&[&format!("rings.2.groove.drain={{holes={n}, diameter=\"{d}\"}}")]]);
        assert!(r.balance.gas_mass.is_some_and(|b| b.abs() < 1e-12), "{:?}", r.balance);
        r
    };
    let (closed, vented) = (diesel(&[&["rings.2.groove.vented=false"]]), diesel(&[]));
    let runs =
        [holes(1, "0.01 mm"), holes(1, "0.5 mm"), holes(4, "1 mm"), holes(12, "3 mm"), holes(12, "10 mm")];
    let peaks: Vec<f64> = runs.iter().map(|r| groove_peak(r) / CRANKCASE - 1.0).collect();
    assert!(peaks.windows(2).all(|w| w[1] < w[0]), "{peaks:?}");
    // The pressure drop of the drain where the ring opens to a land at 4 bar: choked, 19 mm² of flank bring what 12 holes of 3 mm, 85 mm², pass at less
    // than (0.58 · 4 · 19/(0.86 · 85))²/2 = 0.18 bar; 12 holes of 10 mm at a hundredth of that.
    assert!(peaks[0] > 0.2 && peaks[3] < 0.18 && peaks[4] < 2e-3, "{peaks:?}");
    let same = |a: &RunResult, b: &RunResult| (value(a, "blow_by") / value(b, "blow_by") - 1.0).abs();
    // The limits: 8e-11 m² beside 1e-7 m² of the gap, 1e-3 of its flow; 9e-4 m², where the groove has crankcase pressure to 1e-3.
    assert!(same(&runs[0], &closed) < 2e-3, "{} {}", value(&runs[0], "blow_by"), value(&closed, "blow_by"));
    assert!(same(&runs[4], &vented) < 1e-3, "{} {}", value(&runs[4], "blow_by"), value(&vented, "blow_by"));
    // Areas are areas: 12 holes of 3 mm are 84.823 mm².
    let area = diesel(&[&["rings.2.groove.drain={area=\"84.823 mm2\"}"]]);
    assert!(same(&area, &runs[3]) < 1e-4);
}

/// Flow \[kg/s\] through an orifice of an area \[mm²\] between gas of two pressures \[Pa\], each with its temperature \[degC\].
fn orifice(area: f64, (p, tp): (f64, f64), (q, tq): (f64, f64)) -> f64 {
    let (sign, high, low, t) = if p >= q { (1.0, p, q, tp) } else { (-1.0, q, p, tq) };
    let r = (low / high).max((2.0f64 / 2.4).powf(3.5));
    let psi = (7.0 * (r.powf(2.0 / 1.4) - r.powf(2.4 / 1.4)).max(0.0)).sqrt();
    sign * 0.86e-6 * area * high / rt(t).sqrt() * psi
}

/// `R T` \[J/kg\].
fn rt(celsius: f64) -> f64 {
    287.0 * (celsius + 273.15)
}

/// Blow-by \[l/min\] of two lands behind the gaps of [`SEATED`], by Euler's method: the third land open to the crankcase, or behind the third gap.
fn of_gaps(cylinder: &RunResult, open: bool) -> f64 {
    let annulus = |outer: f64, inner: f64| std::f64::consts::PI * (outer * outer - inner * inner);
    // Lands of 8 and 4 mm at diameters of 119.4 and 119.5 mm, and what is behind the second ring, 3.07 mm high from 54.3 to 55 mm.
    let second = annulus(60e-3, 59.7e-3) * 8e-3 / rt(200.0) + annulus(55e-3, 54.3e-3) * 3.07e-3 / rt(180.0);
    let third = annulus(60e-3, 59.75e-3) * 4e-3 / rt(150.0);
    let (below, p) = ((CRANKCASE, 110.0), column(cylinder, "cylinder.p"));
    // A twentieth of a degree at 2000 rpm: the pressure of a land moves by 1e-3 of itself at most.
    let (fine, dt) = (20, 1.0 / 12_000.0 / 20.0);
    let (mut p2, mut p3, mut left) = (CRANKCASE, CRANKCASE, 0.0);
    // After four cycles, the fifth repeats to 1e-4.
    for _ in 0..5 {
        left = 0.0;
        for w in p.windows(2) {
            for k in 0..fine {
                let p1 = w[0] + (w[1] - w[0]) * f64::from(k) / f64::from(fine);
                let into = orifice(0.1, (p1, 250.0), (p2, 200.0));
                let next = orifice(0.1, (p2, 200.0), if open { below } else { (p3, 150.0) });
                let out = if open { next } else { orifice(0.05, (p3, 150.0), below) };
                p2 += dt * (into - next) / second;
                p3 += dt * (next - out) / third;
                left += dt * out;
            }
        }
    }
    // 1000 cycles a minute and 6 cylinders, at 1.0133 bar and 40 degC.
    left * 6000.0 / (CRANKCASE / rt(40.0)) * 1e3
}

#[test]
fn blow_by_moves_by_what_the_gaps_explain() {
    // On its lower flank the twin-land ring leaves the third land open to its vented groove: two gaps are in the way of the gas. Rails on their flanks
    // leave it their gap, a third one.
    let (twin, rails) = (diesel(&[&SEATED]), diesel(&[&SEATED, &THREE_PIECE]));
    let [open, shut] = [true, false].map(|open| of_gaps(&twin, open));
    assert!(open > 1.5 * shut, "{open} {shut}");
    // The groove behind the second ring is a few hundredths of its land larger where the liner has grown; that, and cylinder pressure straight between
    // degrees, counts where the lands store most: 1.1 % of the smaller flow.
    for (run, estimate) in [(&twin, open), (&rails, shut)] {
        let got = value(run, "blow_by");
        assert!((got / estimate - 1.0).abs() < 0.02, "{got} {estimate}");
    }
    // A twin-land ring on its upper flank seals as the upper rail does, and leaves the same gap: the same equations.
    let upper = diesel(&[&SEATED, &["rings.2.models.ring_motion={model=\"seated\", flank=\"upper\"}"]]);
    let same = value(&upper, "blow_by") / value(&rails, "blow_by");
    assert!((same - 1.0).abs() < 1e-9, "{same}");
}

#[test]
fn without_gas_two_rails_are_one_rail_counted_twice() {
    let set = [
        "rings.2.expander={mass=\"6 g\", height=\"2 mm\", ear_angle=\"15 deg\"}",
        "rings.2.groove.root_diameter=72 mm",
    ];
    let (one, two) = (motored(&[]), motored(&set));
    let rails = value(&two, "ring3.friction_power") + value(&two, "ring4.friction_power");
    // Two solutions of the same films, each to the tolerance of its steps (1e-4).
    assert!((rails / value(&one, "ring3.friction_power") - 1.0).abs() < 1e-3, "{rails}");
    assert!((value(&two, "friction_power") / value(&one, "friction_power") - 1.0).abs() < 1e-3);
}

#[test]
fn ledgers_close_where_no_pressure_drives_gas_or_oil() {
    // Next to no gas passes such a pack in a cycle: what its lands and flanks hold is the measure of what is lost.
    let r = motored(&["engine.speed=5600 rpm"]);
    // Sums of some thousand steps, each to the rounding of a double.
    assert!(r.balance.gas_mass.is_some_and(|b| b < 1e-12), "{:?}", r.balance);
    // Oil moves between a strip and its supplies by rates that are integrated as the strips are: equal to rounding, 1e-9 asked for.
    assert!(r.balance.flank_oil.is_some_and(|b| b < 1e-9), "{:?}", r.balance);
}

#[test]
fn rails_lift_and_seal_each_on_its_own() {
    let r = diesel(&[&THREE_PIECE]);
    // Pressed outwards, both are on their flanks most of the time; the upper one opens under the pressure of the third land.
    assert!(value(&r, "ring3.lifted_share") < 0.1 && value(&r, "ring4.lifted_share") < 0.01);
    assert!(r.results["ring3.lifted_share"].what.contains("ring 3 (upper rail) is off its upper flank"));
    assert!(r.results["ring4.h_min"].what.contains("ring 4 (lower rail)"));
    assert!((value(&r, "land4.p_max") * 1e5 / CRANKCASE - 1.0).abs() < 1e-12, "open to the crankcase");
    // 2π 30 N of tension on each rail, at 30 degrees.
    let axial = 2.0 * std::f64::consts::PI * 30.0 * 30f64.to_radians().tan();
    for (name, force) in [("ring3.force_expander", axial), ("ring4.force_expander", -axial)] {
        assert!(column(&r, name).iter().all(|f| (f / force - 1.0).abs() < 1e-12), "{name}");
    }
    // Gas closes to rounding; energy and momentum as those of the case do, to the tolerance of its steps.
    assert!(r.balance.gas_mass.is_some_and(|b| b.abs() < 1e-12), "{:?}", r.balance);
    assert!(r.balance.momentum.is_some_and(|b| b.abs() < 1e-4), "{:?}", r.balance);
    assert!(r.solver.notes.iter().all(|n| !n.text.contains("not periodic")));
    // Without its ears pressing, gas and inertia alone move the upper rail, and it is off its flank more often.
    let loose = diesel(&[&THREE_PIECE, &["rings.2.expander.ear_angle=0 deg"]]);
    assert!(value(&loose, "ring3.lifted_share") > value(&r, "ring3.lifted_share"));
}

#[test]
fn rails_in_a_closed_or_drained_groove() {
    let at = |groove: &str| diesel(&[&THREE_PIECE, &[groove]]);
    let space = |r: &RunResult| value(r, "land4.p_max") * 1e5 / CRANKCASE - 1.0;
    let (closed, drained) =
        (at("rings.2.groove.vented=false"), at("rings.2.groove.drain={holes=4, diameter=\"1 mm\"}"));
    assert!(space(&closed) > 0.1 && space(&drained) > 0.0 && space(&drained) < space(&closed));
    for r in [&closed, &drained] {
        assert!(r.balance.gas_mass.is_some_and(|b| b.abs() < 1e-12), "{:?}", r.balance);
    }
}

#[test]
fn friction_rises_with_the_tension_of_the_rails() {
    // Good to 1e-3: a third of the tension is a tenth of the friction, and what is asked for next is 0.05.
    let rough = "solver.tolerance=1e-3";
    let of = |force: &str| {
        let r = diesel(&[&THREE_PIECE, &[&format!("rings.2.tangential_force={force}"), rough]]);
        value(&r, "ring3.friction_power") + value(&r, "ring4.friction_power")
    };
    let rails = ["30 N", "60 N", "90 N"].map(of);
    assert!(rails[0] < rails[1] && rails[1] < rails[2], "{rails:?}");
    // Two lands or two rails of the same face under the same force rub alike: what differs is gas behind and beside them.
    let twin = value(&diesel(&[&[rough]]), "ring3.friction_power");
    assert!((rails[1] / twin - 1.0).abs() < 0.05, "{} {twin}", rails[1]);
}

#[test]
fn what_cannot_be_an_oil_ring_is_refused_at_its_place() {
    let told = |sets: &[&str], words: &[&str]| {
        let text = refusal(&[sets]);
        for word in words {
            assert!(text.contains(word), "{sets:?}: {text}");
        }
    };
    let groove = "rings.2.groove";
    told(
        &["rings.2.groove.vented=true", "rings.2.groove.drain={area=\"1 mm2\"}"],
        &[groove, "both `vented` and `drain` are given"],
    );
    told(&["rings.2.groove.drain={holes=3}"], &["the drain has no size", "diameter"]);
    told(&["rings.2.groove.drain={holes=0, diameter=\"1 mm\"}"], &["holes"]);
    told(&["rings.2.groove.drain={area=\"1 mm2\", holes=3}"], &["the drain is given twice"]);
    told(&["rings.2.groove.drain={area=\"1 mm2\", discharge=0}"], &["passes nothing"]);
    told(
        &["rings.2.expander={mass=\"14 g\", height=\"2.75 mm\", ear_angle=\"15 deg\"}"],
        &["only a three-piece ring"],
    );
    told(
        &["rings.2.design=three_piece", "rings.2.groove.vented=true"],
        &["vented", "one rail that stands for two"],
    );
    let rails = |change: &str| refusal(&[&THREE_PIECE, &[change]]);
    for (change, words) in [
        ("rings.2.expander.mass=50 g", "nothing is left for the rails"),
        ("rings.2.expander.ear_angle=60 deg", "between 0 and 45 deg"),
        ("rings.2.expander.height=2.9 mm", "leave an axial clearance of -0.0500 mm"),
        ("rings.2.expander.height=0.5 mm", "could tip over"),
        ("rings.2.groove.root_diameter=119 mm", "take more room than the groove has"),
        ("rings.2.gap=0.3 mm", "both `gap` and `cold_gap`"),
        ("models.gas_flow={model=\"prescribed\", lands=[\"3 bar\"]}", "2 lands between them"),
    ] {
        let text = rails(change);
        assert!(text.contains(words), "{change}: {text}");
    }
    // Rings and lands behind rails keep their numbers in the case.
    let second = [
        "rings.1.design=three_piece",
        "rings.1.height=0.6 mm",
        "rings.1.face={shape=\"parabola\", length=\"0.4 mm\", drop=\"2 um\"}",
        "rings.1.expander={mass=\"14 g\", height=\"1.8 mm\", ear_angle=\"15 deg\"}",
    ];
    assert_eq!(refusal(&[&second]), "");
    for (change, place) in [
        ("rings.2.groove.root_diameter=119 mm", "rings.2.groove.root_diameter: a ring"),
        ("piston.lands.2.diameter=121 mm", "piston.lands.2.diameter: a land of"),
        ("rings.1.groove.drain={holes=3}", "rings.1.groove.drain: the drain has no size"),
    ] {
        let text = refusal(&[&second, &[change]]);
        assert!(text.contains(place), "{change}: {text}");
        // Once, and not for each rail.
        assert_eq!(text.matches(place).count(), 1, "{text}");
    }
}
