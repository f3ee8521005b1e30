//! The ring-pack program of tomanik1993, as published: axial seats, gas, films and friction of a 1.6 l ethanol engine. Here stand the
//! comparisons that need values over the cycle or two cases at once; those of results stand in `validation/alcohol-1600-*.toml`.
//!
//! `P1`, `A1`, … are numbers and statements of the dissertation; `7.3`, `7.4` and `8.2` those of an independent prototype with the same
//! fills for the inputs that the dissertation does not give (cylinder pressure, bore, temperatures, oil, roughness), which are
//! the assumptions that the cases declare. Orifice, film and kinematics are tested in their crates.

use crate::common::*;
use gudgeon_core::result::RunResult;

const CASES: [&str; 4] = ["alcohol-1600-3000", "alcohol-1600-4000", "alcohol-1600-5000", "alcohol-1600-5600"];
const RPM: [f64; 4] = [3000.0, 4000.0, 5000.0, 5600.0];

/// Ring friction powers of the engine \[kW\], calculated by the source.
const POWERS: [[f64; 3]; 4] =
    [[0.13, 0.12, 0.10], [0.20, 0.18, 0.16], [0.28, 0.26, 0.22], [0.28, 0.19, 0.27]];

fn kilowatts(r: &RunResult, ring: usize) -> f64 {
    4.0 * value(r, &format!("ring{ring}.friction_power")) / 1e3
}

/// Angles \[deg\] at which a ring sits where `seat` says.
fn angles(r: &RunResult, ring: usize, seat: impl Fn(f64) -> bool) -> Vec<f64> {
    // The last row repeats the first.
    let e = column(r, &format!("ring{ring}.position"));
    (0..e.len() - 1).filter(|k| seat(e[*k])).map(|k| r.series.axis.values[k]).collect()
}

fn unstable(e: f64) -> bool {
    e > 0.01 && e < 0.99
}

fn share(a: &[f64]) -> f64 {
    a.len() as f64 / 720.0
}

/// Gas that has passed ring 1 since the start of the cycle \[mg\]: what went to the crankcase and what the volumes below the ring
/// gained; the space behind it counts while it opens downwards. From the pressures, for the flow between two volumes of almost
/// one pressure chatters in an explicit march, and values of it at whole degrees do not add up.
fn past_ring1(r: &RunResult) -> Vec<f64> {
    let gas = |name: &str, volume: f64, t: f64| -> Vec<f64> {
        column(r, name).iter().map(|p| 1e6 * p * volume / (287.0 * t)).collect()
    };
    let volumes =
        [gas("land2.p", 160e-9, 573.0), gas("ring2.back.p", 291e-9, 573.0), gas("land3.p", 79e-9, 523.0)];
    let behind = gas("ring1.back.p", 291e-9, 573.0);
    let (out, seat) = (column(r, "blow_by.cumulative"), column(r, "ring1.position"));
    let mut sum = vec![0.0];
    for k in 1..out.len() {
        let below: f64 = volumes.iter().map(|m| m[k] - m[k - 1]).sum();
        let own = if seat[k - 1] > 0.99 { behind[k] - behind[k - 1] } else { 0.0 };
        sum.push(sum[k - 1] + 1e6 * (out[k] - out[k - 1]) + below + own);
    }
    sum
}

/// Least and greatest value with their angles.
fn extremes(r: &RunResult, v: &[f64]) -> [(f64, f64); 2] {
    let mut out = [(f64::INFINITY, 0.0), (f64::NEG_INFINITY, 0.0)];
    for (t, v) in r.series.axis.values.iter().zip(v) {
        if *v < out[0].0 {
            out[0] = (*v, *t);
        }
        if *v > out[1].0 {
            out[1] = (*v, *t);
        }
    }
    out
}

fn variant(case: &'static str, set: &[&str]) -> (&'static str, Vec<String>) {
    (case, set.iter().map(|s| (*s).to_owned()).collect())
}

const LOW: &str = "solver.starts=[\"1 bar\"]";
const HIGH: &str = "solver.starts=[\"6 bar\"]";

#[test]
fn as_published() {
    let asked = [
        variant(CASES[0], &[HIGH]),
        variant(CASES[1], &[HIGH]),
        variant(CASES[2], &[HIGH]),
        variant(CASES[3], &[LOW]),
        variant(CASES[1], &[LOW]),
        variant(CASES[2], &[LOW]),
        variant(
            CASES[0],
            &[
                HIGH,
                "solver.cycles=1",
                "models.ring_motion.film_force=false",
                "outputs.results=[\"blow_by\"]",
            ],
        ),
        variant(CASES[0], &[LOW, "solver.cycles=0", "solver.periodicity=5e-3"]),
    ];
    let runs: Vec<RunResult> = run_all(&asked)
        .into_iter()
        .zip(&asked)
        .map(|(r, a)| match r {
            Ok(r) => r,
            Err(e) => panic!("{a:?}: {e}"),
        })
        .collect();
    let (published, other, more) = (&runs[..4], &runs[4..6], &runs[6..]);
    let mut t = Table::default();
    pressures(&mut t, published);
    seats(&mut t, published);
    branches(&mut t, published, other);
    blow_by(&mut t, published);
    films(&mut t, published);
    friction(&mut t, published);
    counts(&mut t, more);
    t.finish("tomanik1993, as published: ethanol engine, 1.6 l, 3000 to 5600 rpm", "validation-tomanik.md");
}

/// `(kPa, deg)` of the highest pressure of land 2. The floating cases have two nearly equal maxima: the later one.
fn land2(r: &RunResult) -> (f64, f64) {
    let (p, angle) = peak(r, "land2.p", 300.0, 720.0);
    let (later, later_angle) = peak(r, "land2.p", 455.0, 720.0);
    let inner = later_angle > 456.0 && later > 0.95 * p;
    if inner { (later / 1e3, later_angle) } else { (p / 1e3, angle) }
}

/// The greater of the local maxima of land 2 in 390 to 430 deg.
fn earlier_maximum(r: &RunResult) -> (f64, f64) {
    let (theta, p) = (&r.series.axis.values, column(r, "land2.p"));
    (1..p.len() - 1)
        .filter(|k| (390.0..430.0).contains(&theta[*k]) && p[*k] > p[k - 1] && p[*k] >= p[k + 1])
        .fold((0.0, f64::NAN), |m, k| if p[k] > m.0 { (p[k], theta[k]) } else { m })
}

fn pressures(t: &mut Table, runs: &[RunResult]) {
    let all: Vec<(f64, f64)> = runs.iter().map(land2).collect();
    t.compare(
        "P3",
        "pressure at 5600 over that at 3000 rpm",
        0.494,
        all[3].0 / all[0].0,
        Within::Absolute(0.05),
    );
    t.compare(
        "P3",
        "angle at 5600 less that at 3000 rpm, deg",
        40.0,
        all[3].1 - all[0].1,
        Within::Absolute(10.0),
    );
    let text = all.iter().map(|(p, a)| format!("{p:.0} @ {a:.0}")).collect::<Vec<_>>().join(", ");
    t.claim(
        "P4",
        "highest pressure of land 2 falls with speed",
        &text,
        all.windows(2).all(|w| w[1].0 < w[0].0),
    );
    // From 4000 to 5000 rpm the prototype's own angle falls by one degree as well.
    t.note("P4", "its angle rises with speed", &text, all.windows(2).all(|w| w[1].1 > w[0].1));
    // Where both fall together at the end of the exhaust they differ by less than pressures are good for, 0.5 %.
    let above = |r: &RunResult, from: f64, to: f64| {
        let rows = r.series.axis.values.iter().zip(column(r, "land2.p").iter().zip(column(r, "cylinder.p")));
        let inside: Vec<bool> =
            rows.filter(|(th, _)| **th >= from && **th <= to).map(|(_, (l, c))| *l > 0.995 * c).collect();
        inside.iter().filter(|b| **b).count() as f64 / inside.len() as f64
    };
    for (k, r) in runs.iter().enumerate() {
        for (what, from, to, least) in [
            ("intake", 1.0, 180.0, 1.0),
            ("exhaust", 541.0, 719.0, 1.0),
            ("most of the expansion", 360.0, 540.0, 0.5),
        ] {
            let s = above(r, from, to);
            let (source, text) = (format!("P5, {} rpm", RPM[k]), format!("{:.0} % of the stroke", 100.0 * s));
            let claim = format!("land 2 above the cylinder, {what}");
            if k == 3 && from == 360.0 {
                // The prototype crosses at 489 deg as well.
                t.note(&source, &claim, &text, s >= least);
            } else {
                t.claim(&source, &claim, &text, s >= least);
            }
        }
    }
    let crossing = |r: &RunResult| {
        r.series
            .axis
            .values
            .iter()
            .zip(column(r, "land2.p").iter().zip(column(r, "cylinder.p")))
            .find(|(th, (l, c))| **th > 380.0 && l > c)
            .map_or(f64::NAN, |(th, _)| *th)
    };
    t.compare(
        "7.3, 3000 rpm",
        "land 2 above the cylinder from, deg",
        439.0,
        crossing(&runs[0]),
        Within::Absolute(1.0),
    );
    t.compare(
        "7.3, 5600 rpm",
        "land 2 above the cylinder from, deg",
        489.0,
        crossing(&runs[3]),
        Within::Absolute(1.0),
    );
    for k in 0..3 {
        let lift = angles(&runs[k], 1, |e| e > 0.01).into_iter().find(|a| *a > 380.0).unwrap_or(f64::NAN);
        let s = format!("P6, {} rpm", RPM[k]);
        t.compare(
            &s,
            "ring 1 leaves its lower flank after the crossing by, deg",
            0.0,
            lift - crossing(&runs[k]),
            Within::Absolute(3.0),
        );
    }
    let p = at(&runs[0], "cylinder.p", 435.0) / 1e3;
    t.compare(
        "P7, 3000 rpm",
        "cylinder at 435 deg = land 2 / 0.929, kPa",
        all[0].0 / 0.929,
        p,
        Within::Relative(0.03),
    );
}

fn seats(t: &mut Table, runs: &[RunResult]) {
    for ring in 1..=2 {
        let n = angles(&runs[0], ring, unstable).len();
        t.claim(
            "A4, 3000 rpm",
            &format!("ring {ring} is never unstable"),
            &format!("{n} unstable degrees"),
            n == 0,
        );
    }
    let down = angles(&runs[0], 1, |e| e < 0.01);
    t.compare("7.3, 3000 rpm", "ring 1 down from, deg", 290.0, down[0], Within::Absolute(1.0));
    t.compare(
        "7.3, 3000 rpm",
        "ring 1 down to, deg",
        439.0,
        down[down.len() - 1] + 1.0,
        Within::Absolute(1.0),
    );
    let down = angles(&runs[1], 1, |e| e < 0.01);
    t.compare("7.3, 4000 rpm", "ring 1 down from, deg", 301.0, down[0], Within::Absolute(1.0));
    t.compare(
        "7.3, 4000 rpm",
        "ring 1 down to, deg",
        445.0,
        down[down.len() - 1] + 1.0,
        Within::Absolute(1.0),
    );
    let u = angles(&runs[2], 1, unstable);
    t.compare("7.3, 5000 rpm", "ring 1 first unstable, deg", 309.0, u[0], Within::Absolute(1.0));
    t.compare("7.3, 5000 rpm", "ring 1 last unstable, deg", 311.0, u[u.len() - 1], Within::Absolute(1.0));
    let down = angles(&runs[2], 1, |e| e < 0.01);
    t.compare(
        "7.3, 5000 rpm",
        "ring 1 down to, deg",
        445.0,
        down[down.len() - 1] + 1.0,
        Within::Absolute(1.0),
    );
    let r = &runs[3];
    let (u1, u2) = (angles(r, 1, unstable), angles(r, 2, unstable));
    let near =
        |u: &[f64], centre: f64, reach: f64| u.iter().filter(|a| (**a - centre).abs() <= reach).count();
    let (n1, n2) = (near(&u1, 540.0, 40.0), near(&u2, 360.0, 60.0));
    t.claim(
        "A4, 5600 rpm",
        "ring 1 unstable near 540 deg",
        &format!("{n1} of {} unstable degrees in 500 to 580", u1.len()),
        2 * n1 > u1.len(),
    );
    t.claim(
        "A4, 5600 rpm",
        "ring 2 unstable near 360 deg",
        &format!("{n2} of {} unstable degrees in 300 to 420", u2.len()),
        2 * n2 > u2.len(),
    );
    // How often a ring on the edge is caught in mid-groove is the last thing that two programs have in common.
    t.compare("7.3, 5600 rpm", "ring 1, unstable degrees", 26.0, u1.len() as f64, Within::Shown);
    t.compare("7.3, 5600 rpm", "ring 2, unstable degrees", 22.0, u2.len() as f64, Within::Shown);
    let inside = u1.iter().filter(|a| (504.0..=643.0).contains(*a)).count();
    t.claim(
        "7.3, 5600 rpm",
        "all but one of ring 1's in 504 to 643 deg",
        &format!("{inside} of {}", u1.len()),
        inside + 3 >= u1.len(),
    );
    let part = |ring: usize, lo: f64, hi: f64| share(&angles(r, ring, |e| e >= lo && e <= hi));
    t.compare("7.3, 5600 rpm", "ring 1 down, share", 0.74, part(1, 0.0, 0.01), Within::Absolute(0.02));
    t.compare("7.3, 5600 rpm", "ring 1 up, share", 0.22, part(1, 0.99, 1.0), Within::Absolute(0.02));
    t.compare("7.3, 5600 rpm", "ring 2 down, share", 0.59, part(2, 0.0, 0.01), Within::Absolute(0.02));
    let up = angles(r, 1, |e| e > 0.99);
    let (last, first) = (
        up.iter().copied().filter(|a| *a < 300.0).fold(0.0, f64::max),
        up.iter().copied().find(|a| *a > 300.0),
    );
    t.compare(
        "7.3, 5600 rpm",
        "ring 1 up from, deg",
        644.0,
        first.unwrap_or(f64::NAN),
        Within::Absolute(2.0),
    );
    t.compare("7.3, 5600 rpm", "ring 1 up to, deg", 83.0, last + 1.0, Within::Absolute(1.0));
    let lift = angles(r, 2, |e| e > 0.01).into_iter().find(|a| *a > 200.0).unwrap_or(f64::NAN);
    t.compare("7.3, 5600 rpm", "ring 2 up from, deg", 288.0, lift, Within::Absolute(1.0));
    // An unstable degree vents the pressure that lifted the ring, so it reseats: single degrees, not stretches.
    let mut runs_of = 0;
    for (k, a) in u2.iter().enumerate() {
        if k == 0 || *a > u2[k - 1] + 1.0 {
            runs_of += 1;
        }
    }
    t.claim(
        "A5, 5600 rpm",
        "ring 2 vents, reseats and repeats",
        &format!("{} unstable degrees in {runs_of} runs", u2.len()),
        runs_of * 2 > u2.len(),
    );
    for (k, r) in runs.iter().enumerate() {
        let moves = r.series.get("ring3.position").is_some();
        t.claim(
            &format!("A7, {} rpm", RPM[k]),
            "ring 3 does not move",
            if moves { "it has a position" } else { "it has none" },
            !moves,
        );
    }
}

fn branches(t: &mut Table, published: &[RunResult], other: &[RunResult]) {
    for (r, k) in other.iter().zip([1, 2]) {
        let s = format!("7.4, {} rpm, floating", RPM[k]);
        let ours = [1, 2, 3].map(|i| kilowatts(r, i));
        let seated = [1, 2, 3].map(|i| kilowatts(&published[k], i));
        t.claim(
            &s,
            "the seated branch is nearer the source's ring 2",
            &format!("{:.3} floating, {:.3} seated, {} printed", ours[1], seated[1], POWERS[k][1]),
            (seated[1] - POWERS[k][1]).abs() < (ours[1] - POWERS[k][1]).abs(),
        );
    }
    let (first, p) = (earlier_maximum(&other[0]), land2(&other[0]));
    t.compare(
        "7.4, 4000 rpm, floating",
        "land 2, earlier maximum, kPa",
        615.0,
        first.0 / 1e3,
        Within::Relative(0.01),
    );
    t.compare("7.4, 4000 rpm, floating", "its angle, deg", 417.0, first.1, Within::Absolute(1.0));
    t.claim(
        "7.4, 4000 rpm, floating",
        "two nearly equal maxima",
        &format!("{:.0} and {:.0} kPa", first.0 / 1e3, p.0),
        first.0 / 1e3 / p.0 > 0.9,
    );
    let first = earlier_maximum(&published[3]);
    t.compare("7.4, 5600 rpm", "land 2, earlier maximum, kPa", 485.0, first.0 / 1e3, Within::Relative(0.01));
    t.compare("7.4, 5600 rpm", "its angle, deg", 412.0, first.1, Within::Absolute(1.0));
}

fn blow_by(t: &mut Table, runs: &[RunResult]) {
    for (k, r) in runs.iter().enumerate() {
        let s = format!("7.3, {} rpm", RPM[k]);
        let mass = value(r, "blow_by_mass_per_cycle");
        let ends: Vec<f64> = (1..=3)
            .map(|i| column(r, &format!("ring{i}.cumulative_mass")).last().copied().unwrap_or(0.0))
            .collect();
        let text = ends.iter().map(|m| format!("{:.5}", 1e6 * m)).collect::<Vec<_>>().join(", ");
        let spread = ends.iter().map(|m| (m / mass - 1.0).abs()).fold(0.0, f64::max);
        t.claim(
            &format!("B1, {} rpm", RPM[k]),
            "mass past rings 1, 2, 3 within 0.5 %, mg",
            &text,
            spread < 5e-3,
        );
        let [low, high] = extremes(r, &past_ring1(r));
        let p = [
            (-0.28, 288.0, 2.18, 439.0),
            (-0.26, 297.0, 1.72, 444.0),
            (-0.24, 305.0, 1.46, 444.0),
            (-0.04, 229.0, 1.46, 488.0),
        ][k];
        // The rise between the extremes; where the count begins is a matter of bookkeeping. The minimum is flat: 2 deg.
        t.compare(
            &s,
            "rise of the mass past ring 1, mg",
            p.2 - p.0,
            high.0 - low.0,
            Within::Rounded(0.01, 0.01),
        );
        t.compare(&s, "from, deg", p.1, low.1, Within::Absolute(2.0));
        t.compare(&s, "to, deg", p.3, high.1, Within::Absolute(1.0));
        t.claim(
            &format!("B6, {} rpm", RPM[k]),
            "4 to 15 l/min",
            &format!("{:.2} l/min", value(r, "blow_by")),
            (4.0..15.0).contains(&value(r, "blow_by")),
        );
    }
    let [low, high] = extremes(&runs[0], &past_ring1(&runs[0]));
    t.claim(
        "B2, 3000 rpm",
        "ring 1 turns from blow-back to blow-by in 270 to 350 deg",
        &format!("{:.2} mg at {} deg", low.0, low.1),
        (270.0..=350.0).contains(&low.1),
    );
    t.compare("B3, 3000 rpm", "mass past ring 1 greatest at, deg", 450.0, high.1, Within::Absolute(15.0));
}

fn films(t: &mut Table, runs: &[RunResult]) {
    let strokes = |r: &RunResult, ring: usize| -> [f64; 4] {
        std::array::from_fn(|s| {
            peak(r, &format!("ring{ring}.h_min"), 180.0 * s as f64, 180.0 * (s + 1) as f64).0 * 1e6
        })
    };
    let names = ["intake", "compression", "expansion", "exhaust"];
    for (k, ring, printed) in [
        (0, 1, [3.6, 4.8, 2.6, 2.3]),
        (0, 2, [4.2, 6.2, 2.4, 3.9]),
        (0, 3, [1.9, 2.1, 1.7, 2.0]),
        (3, 1, [9.1, 7.6, 4.1, 8.5]),
        (3, 2, [12.5, 13.6, 11.9, 11.7]),
        (3, 3, [3.4, 3.4, 2.5, 3.4]),
    ] {
        let ours = strokes(&runs[k], ring);
        for s in 0..4 {
            // One decimal is printed; the prototype integrates the film with 120 panels, we in closed form: 1 %. At 5600 rpm the films
            // of rings 1 and 2 follow seats that differ by single degrees between the programs.
            let within = if k == 3 && ring < 3 { Within::Shown } else { Within::Rounded(0.01, 0.05) };
            t.compare(
                &format!("7.3, {} rpm", RPM[k]),
                &format!("ring {ring}, thickest film, {}, um", names[s]),
                printed[s],
                ours[s],
                within,
            );
        }
    }
    for (k, (from, to)) in
        [(358.0, 377.0), (360.0, 374.0), (361.0, 372.0), (363.0, 370.0)].into_iter().enumerate()
    {
        let r = &runs[k];
        let floor: Vec<f64> = r
            .series
            .axis
            .values
            .iter()
            .zip(column(r, "ring1.h_min"))
            .filter(|(t, h)| **h < 0.2e-6 * (1.0 + 1e-6) && (300.0..420.0).contains(*t))
            .map(|(t, _)| *t)
            .collect();
        let s = format!("7.3, {} rpm", RPM[k]);
        let (a, b) = (floor.first().copied().unwrap_or(f64::NAN), floor.last().copied().unwrap_or(f64::NAN));
        t.compare(&s, "ring 1 rubs from, deg", from, a, Within::Absolute(1.0));
        t.compare(&s, "ring 1 rubs to, deg", to, b, Within::Absolute(1.0));
        t.note(
            &format!("F5, {} rpm", RPM[k]),
            "rubbing begins in 355 to 365, ends in 370 to 380 deg",
            &format!("{a} to {b}"),
            (355.0..=365.0).contains(&a) && (370.0..=380.0).contains(&b),
        );
    }
    let r = &runs[0];
    let thick = peak(r, "ring1.h_min", 0.0, 720.0);
    t.claim(
        "F2, 3000 rpm",
        "in 280 to 300 deg",
        &format!("{} deg", thick.1),
        (280.0..=300.0).contains(&thick.1),
    );
    t.compare(
        "F3, 3000 rpm",
        "ring 1, thickest film of the expansion, um",
        2.0,
        strokes(r, 1)[2],
        Within::Absolute(0.7),
    );
    let after = |r: &RunResult| peak(r, "ring2.h_min", 360.0, 380.0).0 * 1e6;
    t.compare("F6, 5600 rpm", "ring 2, film after firing, um", 12.0, after(&runs[3]), Within::Absolute(2.0));
    t.claim(
        "F7, 3000 rpm",
        "ring 2, film after firing below 3 um",
        &format!("{:.2} um", after(r)),
        after(r) < 3.0,
    );
}

fn friction(t: &mut Table, runs: &[RunResult]) {
    let mut squares = 0.0;
    for (k, r) in runs.iter().enumerate() {
        for i in 1..=3 {
            let (printed, ours) = (POWERS[k][i - 1], kilowatts(r, i));
            squares += (ours / printed - 1.0).powi(2) / 12.0;
        }
        let sum: f64 = (1..=3).map(|i| kilowatts(r, i)).sum();
        let measured = [0.91, 0.96, 1.26, 2.17][k];
        t.claim(
            &format!("W3, {} rpm", RPM[k]),
            "less than measured on the motored engine",
            &format!("{sum:.3} of {measured} kW"),
            sum < measured,
        );
        let oil = kilowatts(r, 3) / sum;
        t.note(
            &format!("W3, {} rpm", RPM[k]),
            "share of the oil ring 29 to 36 %",
            &format!("{:.1} %", 100.0 * oil),
            (0.285..0.365).contains(&oil),
        );
    }
    let rms = squares.sqrt();
    t.claim("W1", "the twelve powers within 7 % rms", &format!("{:.2} %", 100.0 * rms), rms <= 0.07);
    let change = |i: usize| kilowatts(&runs[3], i) - kilowatts(&runs[2], i);
    t.claim(
        "W2",
        "ring 2: friction falls from 5000 to 5600 rpm",
        &format!("{:+.3} kW, printed -0.07", change(2)),
        change(2) < 0.0,
    );
    t.claim(
        "W2",
        "ring 3: friction keeps rising",
        &format!("{:+.3} kW, printed +0.05", change(3)),
        change(3) > 0.0,
    );
    t.note(
        "W2",
        "ring 1: friction stays level",
        &format!("{:+.3} kW, printed 0.00", change(1)),
        change(1).abs() < 0.05,
    );
}

fn counts(t: &mut Table, more: &[RunResult]) {
    t.claim(
        "W6, 3000 rpm",
        "no film is solved without film force",
        &format!("{} film evaluations", more[0].solver.counters["film_evaluations"]),
        more[0].solver.counters["film_evaluations"] == 0,
    );
    let cycles = more[1].solver.counters["cycles"];
    t.compare(
        "3, 3000 rpm",
        "cycles until the state repeats within 0.5 %",
        4.0,
        cycles as f64,
        Within::Absolute(1.0),
    );
}
