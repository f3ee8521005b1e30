//! Compressor cylinders against their laws, written down anew over the volumes of the slider-crank.

use std::f64::consts::PI;
use std::path::Path;

use gudgeon_core::BuildError;
use gudgeon_core::file::Files;
use gudgeon_core::kinds::{
    CylinderPressure, CylinderPressureCtx, CylinderPressureSpec, Kinematics, KinematicsCtx, KinematicsSpec,
};
use gudgeon_kinematics::ExactSliderCrank;

const AREA: f64 = 0.02;
const STROKE: f64 = 0.1;
const OMEGA: f64 = 100.0;
const SUCTION: f64 = 1e5;
const DISCHARGE: f64 = 6e5;
const N: f64 = 1.3;

fn crank(offset: f64) -> Box<dyn Kinematics> {
    let ctx = KinematicsCtx { crank_radius: 0.5 * STROKE, rod_length: 0.2, offset, omega: OMEGA };
    ExactSliderCrank {}.build(&ctx).expect("turns")
}

fn try_build(
    kinematics: &(dyn Kinematics + 'static),
    toml: &str,
) -> Result<Box<dyn CylinderPressure>, BuildError> {
    let spec: Box<dyn CylinderPressureSpec> = toml::from_str(toml).expect("reads");
    spec.build(&CylinderPressureCtx { kinematics, piston_area: AREA, files: &Files::of(Path::new(".")) })
}

fn case(model: &str, more: &str) -> String {
    format!("model = \"{model}\"\nsuction = \"1 bar\"\ndischarge = \"6 bar\"\nexponent = {N}\n{more}")
}

/// Volume \[m³\] with a clearance of a tenth of the swept one.
fn volume(k: &dyn Kinematics, theta: f64) -> f64 {
    AREA * (k.y_tdc() - k.motion(theta).y) + 0.1 * AREA * k.stroke()
}

const CLEARANCE: &str = "clearance = { fraction = 0.1 }";

#[test]
fn ideal_valves_and_their_work() {
    for offset in [0.0, 0.01, -0.01] {
        let k = crank(offset);
        let p = try_build(&*k, &case("ideal_valves", CLEARANCE)).expect("builds");
        assert!((p.period() - 2.0 * PI).abs() < 1e-15);
        let swept = AREA * k.stroke();
        let (v_c, v_max) = (0.1 * swept, 1.1 * swept);
        let n = 72_000;
        let at = |i: i32| 2.0 * PI * f64::from(i) / f64::from(n);
        let mut work = 0.0;
        for i in 0..n {
            let (a, b) = (at(i), at(i + 1));
            let m = 0.5 * (a + b);
            let v = volume(&*k, m);
            let expected = if k.motion(m).v < 0.0 {
                (DISCHARGE * (v_c / v).powf(N)).max(SUCTION)
            } else {
                (SUCTION * (v_max / v).powf(N)).min(DISCHARGE)
            };
            // Rounding of the volume near the dead centres, where it is the difference of positions: 1e-16 of 0.25 m over 10 mm.
            assert!((p.pressure(m) / expected - 1.0).abs() < 1e-12, "{offset} {m}");
            work -= p.pressure(m) * (volume(&*k, b) - volume(&*k, a));
        }
        // W = n/(n-1) p_s (V_max - V_4) ((p_d/p_s)^((n-1)/n) - 1).
        let ratio = DISCHARGE / SUCTION;
        let v_4 = v_c * ratio.powf(1.0 / N);
        let exact = N / (N - 1.0) * SUCTION * (v_max - v_4) * (ratio.powf((N - 1.0) / N) - 1.0);
        // Midpoint rule with four corners inside a step: step² each.
        assert!((work / exact - 1.0).abs() < 1e-7, "{offset}: {work} {exact}");
        // The corners: both dead centres, and where the valves open.
        assert_eq!(p.kinks().len(), 4);
        for kink in p.kinks() {
            let v = volume(&*k, *kink);
            let near = |x: f64| (v / x - 1.0).abs() < 1e-9;
            assert!(near(v_c) || near(v_max) || near(v_4) || near(v_max * ratio.powf(-1.0 / N)), "{kink}");
        }
        assert!(p.kinks().windows(2).all(|w| w[0] < w[1]));
    }
    let k = crank(0.0);
    let open =
        try_build(&*k, &case("ideal_valves", &format!("{CLEARANCE}\nheld_open = true"))).expect("builds");
    assert!((0..36).all(|i| open.pressure(f64::from(i) * 0.17) == SUCTION) && open.kinks().is_empty());
}

#[test]
fn a_compression_that_does_not_reach_the_discharge_pressure() {
    let k = crank(0.0);
    // 11^1.3 = 22.6 of 1 bar are less than 30 bar: one line there and back.
    let toml = case("ideal_valves", CLEARANCE).replace("6 bar", "30 bar");
    let p = try_build(&*k, &toml).expect("builds");
    for i in 1..180 {
        let t = f64::from(i).to_radians();
        let line = SUCTION * (11.0 * 0.1 * AREA * STROKE / volume(&*k, t)).powf(N);
        assert!(
            (p.pressure(t) / line - 1.0).abs() < 1e-12
                && (p.pressure(2.0 * PI - t) / line - 1.0).abs() < 1e-12
        );
    }
}

#[test]
fn valves_with_losses() {
    let k = crank(0.0);
    let areas = "suction_area = \"20 cm2\"\ndischarge_area = \"15 cm2\"\nsuction_temperature = \"300 K\"\ngas_constant = \"287 J/(kg K)\"";
    let p = try_build(&*k, &case("valve_losses", &format!("{CLEARANCE}\n{areas}"))).expect("builds");
    let open = try_build(&*k, &case("valve_losses", &format!("{CLEARANCE}\n{areas}\nheld_open = true")))
        .expect("builds");
    // A cylinder of a compressor repeats itself every turn.
    assert_eq!((p.period(), open.period()), (std::f64::consts::TAU, std::f64::consts::TAU));
    let rho = SUCTION / (287.0 * 300.0);
    let rho_d = rho * (DISCHARGE / SUCTION).powf(1.0 / N);
    let (v_c, v_max) = (0.1 * AREA * STROKE, 1.1 * AREA * STROKE);
    let mut throttled = [0; 2];
    for i in 0..720 {
        let t = (0.25 + 0.5 * f64::from(i)).to_radians();
        let (v, speed) = (volume(&*k, t), k.motion(t).v);
        let drop = |rho: f64, area: f64| 0.5 * rho * (AREA * speed / area).powi(2);
        let (intake, outlet) = (SUCTION - drop(rho, 20e-4), DISCHARGE + drop(rho_d, 15e-4));
        let (expected, unloaded) = if speed < 0.0 {
            let closed = DISCHARGE * (v_c / v).powf(N);
            throttled[0] += i32::from(closed < intake);
            (closed.max(intake), intake)
        } else {
            let closed = SUCTION * (v_max / v).powf(N);
            throttled[1] += i32::from(closed > outlet);
            (closed.min(outlet), SUCTION + drop(rho, 20e-4))
        };
        // A few roundings of powers and of the volume.
        assert!((p.pressure(t) / expected - 1.0).abs() < 1e-12, "{t}");
        assert!((open.pressure(t) / unloaded - 1.0).abs() < 1e-13, "{t}");
    }
    assert!(throttled[0] > 100 && throttled[1] > 50, "{throttled:?}");
    assert_eq!((p.kinks().len(), open.kinks().len()), (4, 2));
    // Valves so small that the law does not hold: 0.3 of the suction pressure at the highest piston speed.
    let fastest = (0..3600).map(|i| k.motion(0.1_f64.to_radians() * f64::from(i)).v).fold(0.0, f64::max);
    let limit = AREA * fastest * (0.5 * rho / (0.3 * SUCTION)).sqrt();
    let sized = |factor: f64| {
        let small = areas.replace("20 cm2", &format!("{} m2", factor * limit));
        try_build(&*k, &case("valve_losses", &format!("{CLEARANCE}\n{small}"))).err().map(|e| e.field)
    };
    // The highest speed is looked for in steps of a degree: 1e-4 of it.
    assert_eq!((sized(0.99), sized(1.01)), (Some("suction_area".into()), None));
}

#[test]
fn valves_that_act_at_angles() {
    let k = crank(0.0);
    let windows = format!("{CLEARANCE}\nsuction_opens = \"40 deg\"\ndischarge_opens = \"300 deg\"");
    let p = try_build(&*k, &case("angle_windows", &windows)).expect("builds");
    let (v_c, v_max) = (0.1 * AREA * STROKE, 1.1 * AREA * STROKE);
    for i in 0..360 {
        let t = (f64::from(i) + 0.5).to_radians();
        let v = volume(&*k, t);
        let expected = match i {
            0..40 => DISCHARGE * (v_c / v).powf(N),
            40..180 => SUCTION,
            180..300 => SUCTION * (v_max / v).powf(N),
            _ => DISCHARGE,
        };
        assert!((p.pressure(t) / expected - 1.0).abs() < 1e-12, "{i}");
    }
    let kinks: Vec<f64> = p.kinks().iter().map(|k| k.to_degrees()).collect();
    assert_eq!(kinks.len(), 4);
    for (k, want) in kinks.iter().zip([0.0, 40.0, 180.0, 300.0]) {
        // Dead centres are found to 1e-8 of a turn at worst, for there positions are flat.
        assert!((k - want).abs() < 1e-5, "{kinks:?}");
    }
    let refused = |windows: &str| {
        try_build(&*k, &case("angle_windows", &format!("{CLEARANCE}\n{windows}"))).err().map(|e| e.field)
    };
    assert_eq!(refused("suction_opens = \"181 deg\""), Some("suction_opens".into()));
    assert_eq!(refused("discharge_opens = \"179 deg\""), Some("discharge_opens".into()));
    assert_eq!(refused("discharge_opens = \"361 deg\""), Some("discharge_opens".into()));
}

#[test]
fn clearances_in_every_way() {
    let k = crank(0.0);
    let at = |clearance: &str| {
        let toml = case("ideal_valves", &format!("clearance = {clearance}"));
        try_build(&*k, &toml).map(|p| p.pressure(0.3)).map_err(|e| e.field)
    };
    // A tenth of 0.02 m² times 0.1 m; a ratio of 11; the same for half of the stroke with a ratio of 6.
    let fraction = at("{ fraction = 0.1 }").expect("builds");
    for same in [
        "{ volume = \"0.2 l\" }",
        "{ compression_ratio = 11 }",
        "{ compression_ratio = 6, stroke = \"50 mm\" }",
    ] {
        // Roundings of the clearance.
        assert!((at(same).expect("builds") / fraction - 1.0).abs() < 1e-13, "{same}");
    }
    for (wrong, field) in [
        ("{}", "clearance"),
        ("{ fraction = 0.1, compression_ratio = 11 }", "clearance"),
        ("{ compression_ratio = 1 }", "clearance.compression_ratio"),
        ("{ fraction = 0.1, stroke = \"50 mm\" }", "clearance.stroke"),
        ("{ fraction = 5e-324 }", "clearance"),
        ("{ fraction = 1e-300 }", "exponent"),
    ] {
        assert_eq!(at(wrong), Err(field.to_owned()), "{wrong}");
    }
    let refused = |from: &str, to: &str| {
        try_build(&*k, &case("ideal_valves", CLEARANCE).replace(from, to)).err().map(|e| e.field)
    };
    assert_eq!(refused("6 bar", "1 bar"), Some("discharge".into()));
    assert_eq!(refused("exponent = 1.3", "exponent = 0.9"), Some("exponent".into()));
    assert_eq!(refused("exponent = 1.3", "exponent = 2.1"), Some("exponent".into()));
    assert_eq!(refused("exponent = 1.3", "exponent = 1"), None);
}
