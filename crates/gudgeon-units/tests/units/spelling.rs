//! What people write instead of a unit.

use gudgeon_units::{nearest_unit, with_decimal_point};

#[test]
fn commas_and_minus_signs() {
    let pointed = |t| with_decimal_point(t);
    assert_eq!(pointed("0,5 mm").as_deref(), Some("0.5 mm"));
    assert_eq!(pointed(" -1,25e3 mm").as_deref(), Some("-1.25e3 mm"));
    assert_eq!(pointed("\u{2212}3 mm").as_deref(), Some("-3 mm"));
    assert_eq!(pointed("\u{2212}3,5").as_deref(), Some("-3.5"));
    for other in ["0.5 mm", "1,2,3", "[1,2]", "a,b", ",5", "5,", "", "\u{2212}x", "µm"] {
        assert_eq!(pointed(other), None, "{other}");
    }
}

#[test]
fn units_in_other_words() {
    for (dimension, text, unit) in [
        ("a length", "MM", Some(("mm", true))),
        ("a length", "millimeters", Some(("mm", true))),
        ("a length", "microns", Some(("um", true))),
        ("a length", "mmm", Some(("mm", false))),
        ("a length", "furlongs", None),
        ("a pressure", "bra", Some(("bar", false))),
        ("a pressure", "N/mm²", Some(("MPa", true))),
        ("a temperature", "C", Some(("degC", true))),
        ("a torque", "Nm", Some(("N m", true))),
        ("a torque", "kN·m", Some(("kN m", true))),
        ("a moment of inertia", "kg*m^2", Some(("kg m2", true))),
        ("a rotational speed", "min⁻¹", Some(("rpm", true))),
        ("a colour", "red", None),
    ] {
        assert_eq!(nearest_unit(dimension, text), unit, "{text}");
    }
}
