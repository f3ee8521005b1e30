//! Friction of the pin and of the rings in their grooves, against their closed forms.

use std::f64::consts::PI;

use gudgeon_core::kinds::{GrooveFrictionCtx, GrooveFrictionSpec, PinFrictionSpec};
use gudgeon_core::quantity::quantity;
use gudgeon_skirt::{GrooveCoulomb, NoGrooveFriction, NoPinFriction, PinCoulomb};

#[test]
fn pin_drags_the_piston_along_with_the_rod() {
    let spec =
        PinCoulomb { coefficient: quantity(0.08), radius: quantity(9e-3), reversal_speed: quantity(0.02) };
    let pin = spec.build().expect("builds");
    assert!(!pin.is_off());
    for (load, rotation) in [(1e4, 30.0), (1e4, -30.0), (2.5e3, 1.0), (0.0, 5.0)] {
        let exact = 0.08 * 9e-3 * load * f64::tanh(9e-3 * rotation / 0.02);
        // Products of four factors: rounding.
        assert!((pin.moment(load, rotation) - exact).abs() <= 1e-14 * exact.abs(), "{load} {rotation}");
    }
    let smooth = PinCoulomb { coefficient: quantity(0.0), ..spec }.build().expect("builds");
    assert!(smooth.is_off());
    let none = NoPinFriction {}.build().expect("builds");
    assert!(none.is_off() && none.moment(1e4, 30.0) == 0.0);
}

#[test]
fn rings_resist_the_motion_across_the_bore() {
    let ctx = GrooveFrictionCtx { bore: 0.08 };
    let spec = GrooveCoulomb {
        coefficient: quantity(0.1),
        height: quantity(0.012),
        width: quantity(3e-3),
        preload: Some(quantity(20.0)),
        reversal_speed: quantity(2e-3),
    };
    let rings = spec.build(&ctx).expect("builds");
    assert!(!rings.is_off() && rings.height() == 0.012);
    for (pressure, v) in [(3e6, 1e-3), (3e6, -5e-3), (-2e4, 1e-3), (0.0, 0.0)] {
        let (force, slope) = rings.force(pressure, v);
        // Gas presses the ring onto a flank whichever way it acts.
        let most = 0.1 * (PI * 0.08 * 3e-3 * f64::abs(pressure) + 20.0);
        let exact = -most * f64::tanh(v / 2e-3);
        assert!((force - exact).abs() <= 1e-13 * most, "{pressure} {v}: {force} {exact}");
        let d = 1e-8;
        let quotient = (rings.force(pressure, v + d).0 - rings.force(pressure, v - d).0) / (2.0 * d);
        // Central difference over a hundred-thousandth of the reversal speed: its square, and rounding of the forces over it.
        assert!((slope / quotient - 1.0).abs() < 1e-7, "{pressure} {v}: {slope} {quotient}");
    }
    let bare = GrooveCoulomb { preload: None, ..spec.clone() }.build(&ctx).expect("builds");
    assert_eq!(bare.force(0.0, 1.0).0, 0.0);
    assert!(GrooveCoulomb { coefficient: quantity(0.0), ..spec }.build(&ctx).expect("builds").is_off());
    let none = NoGrooveFriction {}.build(&ctx).expect("builds");
    assert!(none.is_off() && none.height() == 0.0 && none.force(3e6, 1.0) == (0.0, 0.0));
}
