//! A layer of springs.

use gudgeon_contact::LinearPenalty;
use gudgeon_core::kinds::ContactSpec;
use gudgeon_core::quantity::quantity;

#[test]
fn proportional_to_the_approach() {
    let spec = LinearPenalty {
        stiffness: quantity(1e14),
        touching: quantity(0.5e-6),
        friction_coefficient: quantity(0.10),
    };
    let m = spec.build().expect("builds");
    let h = [1.0, 0.5e-6, 0.4e-6, 0.0, -0.5e-6, -1e300];
    let mut p = [f64::NAN; 6];
    m.pressure(&h, &mut p);
    assert_eq!((p[0], p[1], m.range(), m.floor(), m.friction_coefficient()), (0.0, 0.0, 0.5e-6, None, 0.10));
    // 10 MPa per 0.1 µm; rounding of the difference of separations.
    for (p, exact) in p[2..5].iter().zip([1e7, 5e7, 1e8]) {
        assert!((p / exact - 1.0).abs() < 1e-15);
    }
    assert_eq!(p[5], f64::MAX);
}
