//! Smooth surfaces.

use gudgeon_core::kinds::{RoughFlow, RoughShear, RoughnessSpec};
use gudgeon_film::SmoothSurfaces as Off;

#[test]
fn the_film_is_what_it_was() {
    let model = Off {}.build().expect("builds");
    let h = [2e-6, 0.0, -1e-7];
    let (mut flow, mut shear) = (RoughFlow::new(3), RoughShear::new(3));
    model.flow(&h, &mut flow).expect("finite");
    model.shear(&h, &mut shear).expect("finite");
    assert_eq!((&flow.film[..], &flow.transport[..]), (&h[..], &h[..]));
    assert_eq!(
        (&flow.content[..], &flow.content_derivative[..]),
        (&[2e-6, 0.0, 0.0][..], &[1.0, 0.0, 0.0][..])
    );
    assert_eq!((flow.phi_x, flow.phi_y), (vec![1.0; 3], vec![1.0; 3]));
    assert_eq!((shear.phi_f, shear.phi_fs, shear.phi_fp), (vec![1.0; 3], vec![0.0; 3], vec![1.0; 3]));
}

#[test]
fn bad_input_is_an_error() {
    let model = Off {}.build().expect("builds");
    assert!(model.flow(&[f64::NAN], &mut RoughFlow::new(1)).is_err_and(|e| e.is_recoverable()));
    assert!(model.shear(&[f64::INFINITY], &mut RoughShear::new(1)).is_err_and(|e| e.is_recoverable()));
    assert!(model.flow(&[1e-6], &mut RoughFlow::new(2)).is_err_and(|e| !e.is_recoverable()));
    assert!(model.shear(&[1e-6], &mut RoughShear::new(0)).is_err_and(|e| !e.is_recoverable()));
}
