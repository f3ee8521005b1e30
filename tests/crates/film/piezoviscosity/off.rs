//! Viscosity that does not depend on pressure.

use gudgeon_core::kinds::PiezoviscositySpec;
use gudgeon_film::Isoviscous as Off;

#[test]
fn nothing_changes() {
    let (mut f, mut s) = ([0.0; 2], [1.0; 2]);
    let model = Off {}.build().expect("builds");
    model.factor(0.01, &[0.0, 1e9], &mut f, &mut s).expect("finite");
    assert_eq!((f, s, model.is_off()), ([1.0; 2], [0.0; 2], true));
    assert!(model.factor(0.01, &[f64::NAN; 2], &mut f, &mut s).is_err_and(|e| e.is_recoverable()));
    assert!(model.factor(0.01, &[0.0], &mut f, &mut s).is_err_and(|e| !e.is_recoverable()));
}
