//! Fatigue criteria.

use gudgeon_core::kinds::{Fatigue, FatigueSpec};
use gudgeon_core::quantity::quantity;

use gudgeon_pin::{Gerber, Goodman, Off, Soderberg};

fn criteria() -> [Box<dyn Fatigue>; 3] {
    let (e, u, y) = (quantity(400e6), quantity(1000e6), quantity(800e6));
    [
        Goodman { endurance_limit: e, tensile_strength: u }.build().expect("builds"),
        Gerber { endurance_limit: e, tensile_strength: u }.build().expect("builds"),
        Soderberg { endurance_limit: e, yield_strength: y }.build().expect("builds"),
    ]
}

#[test]
fn pure_alternation_and_pure_tension_reach_the_strengths() {
    for (c, strength) in criteria().iter().zip([1000e6, 1000e6, 800e6]) {
        // A few operations on numbers of order one.
        assert!((c.safety(0.0, 200e6).expect("finite") - 2.0).abs() < 1e-14);
        assert!((c.safety(-300e6, 200e6).expect("finite") - 2.0).abs() < 1e-14);
        assert!((c.safety(100e6, 0.0).expect("finite") - strength / 100e6).abs() < 1e-12);
        assert!(
            c.safety(f64::NAN, 1.0).is_err() && c.safety(1.0, -1.0).is_err() && c.safety(0.0, 0.0).is_err()
        );
    }
}

#[test]
fn scaled_by_its_factor_a_stress_lies_on_the_line() {
    let (m, a) = (150e6, 120e6);
    let [goodman, gerber, soderberg] = criteria();
    let on = |c: &dyn Fatigue| c.safety(m, a).map(|n| (n * m, n * a)).expect("finite");
    let (x, y) = on(&*goodman);
    assert!((y / 400e6 + x / 1000e6 - 1.0).abs() < 1e-14);
    let (x, y) = on(&*gerber);
    assert!((y / 400e6 + (x / 1000e6).powi(2) - 1.0).abs() < 1e-14);
    let (x, y) = on(&*soderberg);
    assert!((y / 400e6 + x / 800e6 - 1.0).abs() < 1e-14);
    // Soderberg is the most cautious, Gerber the least.
    let n: Vec<f64> = [soderberg, goodman, gerber].iter().map(|c| c.safety(m, a).expect("finite")).collect();
    assert!(n[0] < n[1] && n[1] < n[2], "{n:?}");
    assert!(Off {}.build().expect("builds").is_off());
    let bad = Goodman { endurance_limit: quantity(2e9), tensile_strength: quantity(1e9) };
    assert_eq!(bad.build().expect_err("refused").field, "endurance_limit");
}
