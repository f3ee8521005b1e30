//! Drives against their definitions.

use gudgeon_core::kinds::DriveSpec;
use gudgeon_core::quantity::quantity;
use gudgeon_torsion::drive::PowerLaw;

#[test]
fn a_power_that_no_load_has_is_refused_at_its_place() {
    let law =
        |n: f64| PowerLaw { torque: quantity(1e3), speed: quantity(100.0), exponent: quantity(n) }.build();
    assert!(law(3.0).is_ok());
    assert_eq!(law(81100.0).unwrap_err().field, "exponent");
}
