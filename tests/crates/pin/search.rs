//! The published search where it ends otherwise than at a pin.

use gudgeon_core::kinds::{PinQuantity, PinSize};
use gudgeon_pin::stepper::{End, Phase, Steps, search, with_mantissa_32};

use crate::common::*;

fn steps() -> Steps {
    Steps { length: 0.1e-3, coarse: 0.1e-3, fine: 0.005e-3, bore: BORE, mantissa_32: false }
}

#[test]
fn a_length_stops_at_the_piston() {
    let m = model("thin_ring", PUBLISHED_PI);
    let mut d = published_design(&*m, PUBLISHED_PI);
    d.limits = [f64::INFINITY; 8];
    d.limits[PinQuantity::BossPressure as usize] = 1e5;
    let s = search(&d, mm(54.05, 21.85, 10.0), &steps()).expect("ends");
    assert_eq!(s.end, End::Length);
    // 30.95 mm in steps of a tenth: 310 lengths below the piston diameter are evaluated.
    assert_eq!((s.passes, s.count(Phase::Coarse, PinQuantity::BossPressure)), (310, 310));
    assert!((s.size.length - 84.95e-3).abs() < 1e-12 && !s.length_was_admitted);
}

#[test]
fn a_bore_stops_at_nothing() {
    let m = model("thin_ring", PUBLISHED_PI);
    let mut d = published_design(&*m, PUBLISHED_PI);
    d.limits = [f64::INFINITY; 8];
    d.limits[PinQuantity::BendingStress as usize] = 1e5;
    let s = search(&d, mm(54.0, 21.85, 1.05), &steps()).expect("ends");
    assert_eq!(s.end, End::Bore(PinQuantity::BendingStress));
    // From 1.05 mm in steps of a tenth: eleven bores are evaluated, the twelfth would be negative.
    assert_eq!((s.passes, s.trace.len()), (11, 11));
}

/// Nothing is limited: one coarse step up, which the fine phase accepts, unless no wall would be left.
#[test]
fn an_admitted_start_is_widened_by_one_coarse_step() {
    let m = model("thin_ring", PUBLISHED_PI);
    let mut d = published_design(&*m, PUBLISHED_PI);
    d.limits = [f64::INFINITY; 8];
    for (inner, end) in [(10.0, 10.1), (21.8, 21.8)] {
        let s = search(&d, mm(54.0, 21.85, inner), &steps()).expect("ends");
        assert_eq!((s.end, s.passes), (End::Found, 2));
        assert!(s.bore_was_admitted && s.length_was_admitted && s.trace.is_empty());
        // Rounding of a sum in millimetres.
        assert!((1e3 * s.size.inner - end).abs() < 1e-12, "{}", s.size.inner);
    }
}

#[test]
fn steps_of_nothing_end_with_an_error() {
    let m = model("thin_ring", PUBLISHED_PI);
    let mut d = published_design(&*m, PUBLISHED_PI);
    d.limits[PinQuantity::BossPressure as usize] = 1e5;
    let s = search(&d, mm(54.0, 21.85, 10.0), &Steps { length: 1e-15, ..steps() });
    assert!(s.is_err_and(|e| !e.is_recoverable()));
    // Outside the theory from the start.
    assert!(search(&d, PinSize { length: GAP, ..mm(0.0, 21.85, 10.0) }, &steps()).is_err());
}

#[test]
fn a_mantissa_of_32_bits_keeps_what_fits_and_signs() {
    // 2^31 + 1 has 32 bits, 2^32 + 1 has 33 and is rounded to even.
    assert_eq!(with_mantissa_32(2_147_483_649.0), 2_147_483_649.0);
    assert_eq!(with_mantissa_32(4_294_967_299.0), 4_294_967_300.0);
    assert_eq!(with_mantissa_32(-0.1), -with_mantissa_32(0.1));
    assert_eq!(with_mantissa_32(f64::INFINITY), f64::INFINITY);
    // A number whose last place cannot be written stays itself.
    assert_eq!(with_mantissa_32(1e-320), 1e-320);
}
