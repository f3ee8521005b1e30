//! Quantities as text and back.

use gudgeon_units::*;

#[test]
fn reads_units_and_bare_numbers() {
    let mm = PosLength::parse("120 mm").map(Quantity::si);
    assert_eq!(mm, Ok(0.12));
    assert_eq!(Length::<Any>::parse("1e3").map(Quantity::si), Ok(1000.0));
    assert_eq!(PosTemperature::parse("100degC").map(Quantity::si), Ok(373.15));
    assert_eq!(Ratio::<Any>::parse("5 %").map(Quantity::si), Ok(0.05));
    // The micro sign, the Greek letter, the Latin one; a space that does not break.
    for text in ["120 \u{b5}m", "120 \u{3bc}m", "120 um", "120\u{a0}um"] {
        assert_eq!(PosLength::parse(text).map(Quantity::si), Ok(120.0 * 1e-6), "{text}");
    }
    assert_eq!(PosTime::parse("2 \u{3bc}s").map(Quantity::si), Ok(2.0 * 1e-6));
    assert_eq!(PosStiffness::parse("1 N/\u{b5}m").map(Quantity::si), Ok(1e6));
}

#[test]
fn refuses_with_the_reason() {
    let e = |r: Result<PosLength, QuantityError>| r.expect_err("must be refused").to_string();
    assert_eq!(
        e(PosLength::parse("3 bar")),
        "unit `bar` is not a length, expected one of `m`, `cm`, `mm`, `um`, `µm`, `nm`, `in`"
    );
    assert_eq!(e(PosLength::parse("-3 mm")), "`-3 mm` must be greater than zero");
    assert_eq!(e(PosLength::parse("NaN mm")), "`NaN mm` must be finite");
    assert_eq!(e(PosLength::parse("mm")), "`mm` does not start with a number; write a length like `1.5 mm`");
    assert_eq!(e(PosLength::parse("0,5 mm")), "`0,5 mm` is not a number with a unit; write `0.5 mm`");
    assert!(PosLength::new(f64::INFINITY).is_err());
    let far = AngularSpeed::<Any>::parse("-1e300 rad/s").expect_err("must be refused").to_string();
    assert_eq!(far, "`-1e300 rad/s` is beyond any machine: a rotational speed is at most 1e6 rad/s");
    let far = Ratio::<Any>::new(1e31).expect_err("must be refused").to_string();
    assert!(far.ends_with("a number is at most 1e30"), "{far}");
}

#[test]
fn schema_keys_check_like_the_type() {
    let schema = schemars::schema_for!(PosLength).to_value();
    let (d, b) = (schema["x-dimension"].as_str(), schema["x-bound"].as_str());
    let (d, b) = (d.expect("present"), b.expect("present"));
    for text in ["120 mm", "3 bar", "-3 mm", "NaN mm", "mm", "0", "1e400 m", "1e300 m"] {
        assert_eq!(check(d, b, text, None).err(), PosLength::parse(text).err());
    }
    assert!(check(d, b, "-1", Some(-1.0)).is_err());
    assert!(check(d, b, "1", Some(1.0)).is_ok());
    assert!(check("a colour", b, "red", None).is_ok());
}

#[test]
fn echo_reads_back_to_the_same_bits() {
    for v in [0.12, 1e-9 / 3.0, 8.335_65e-5, 1.0 / 3.0, 2e9] {
        let q: Pressure = quantity(v);
        assert_eq!(Pressure::<Any>::parse(&q.to_string()).map(Quantity::si), Ok(v));
    }
}
