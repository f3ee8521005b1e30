//! Friction on the flanks.

mod rational_saturation;
mod tanh_stribeck;

/// Compares the analytic derivative with central differences over the velocities around `scale`.
fn check_derivative(m: &dyn gudgeon_core::kinds::FlankFriction, scale: f64) {
    let load = 250.0;
    for k in -60..=60 {
        let v = scale * f64::from(k) / 10.0;
        let d = 1e-5 * scale;
        let central = (m.force(v + d, load) - m.force(v - d, load)) / (2.0 * d);
        let largest = m.derivative(0.0, load);
        // Truncation (d/scale)² ~ 1e-10 and rounding 1e-16/1e-5 of the largest slope; at v = 0 the second derivative of |v| jumps,
        // which costs one order, 1e-5.
        let tolerance = if k == 0 { 2e-5 } else { 1e-9 };
        assert!(
            (m.derivative(v, load) - central).abs() < tolerance * largest,
            "{v}: {} {central}",
            m.derivative(v, load)
        );
    }
}

#[test]
fn only_off_is_off() {
    use gudgeon_core::kinds::FlankFrictionSpec;
    let off = |spec: &dyn FlankFrictionSpec| spec.build().expect("builds").is_off();
    assert!(off(&gudgeon_ring::FrictionOff {}));
    assert!(
        !off(&gudgeon_ring::RationalSaturation::default()) && !off(&gudgeon_ring::TanhStribeck::default())
    );
}
