//! Rough surfaces in a film.

mod gaussian_gap;
mod off;
mod patir_cheng;
mod sawtooth_waviness;
mod tripp;

use gudgeon_core::kinds::{RoughFlow, RoughShear, Roughness};

/// All factors at one separation.
pub fn both(m: &dyn Roughness, h: f64) -> (RoughFlow, RoughShear) {
    let (mut flow, mut shear) = (RoughFlow::new(1), RoughShear::new(1));
    m.flow(&[h], &mut flow).expect("finite");
    m.shear(&[h], &mut shear).expect("finite");
    (flow, shear)
}

/// Slopes of all factors from both sides of `joints`, in units of `sigma`, agree; and the slope of the film content is its slope.
pub fn slopes_are_continuous(m: &dyn Roughness, sigma: f64, joints: &[f64]) {
    let all = |x: f64| {
        let (f, s) = both(m, x * sigma);
        let lengths = [f.film[0], f.transport[0], f.content[0]].map(|l| l / sigma);
        let factors = [f.phi_x[0], f.phi_y[0], s.phi_f[0], s.phi_fs[0], s.phi_fp[0]];
        let mut values = [0.0; 8];
        values[..3].copy_from_slice(&lengths);
        values[3..].copy_from_slice(&factors);
        (values, f.content_derivative[0])
    };
    for &joint in joints {
        // A jump of the slope stays when the step shrinks, curvature goes with it: the jump over 1e-5 may be a tenth of that
        // over 1e-4, give and take a half, and rounding 1e-16/1e-5 counts little.
        let jump = |d: f64| {
            let (l, c, r) = (all(joint - d).0, all(joint).0, all(joint + d).0);
            let mut j = [0.0; 8];
            for i in 0..8 {
                j[i] = (r[i] - 2.0 * c[i] + l[i]) / d;
            }
            j
        };
        let (coarse, fine) = (jump(1e-4), jump(1e-5));
        for i in 0..8 {
            assert!(
                fine[i].abs() <= 0.15 * coarse[i].abs() + 1e-9,
                "value {i} at {joint}: {} {}",
                coarse[i],
                fine[i]
            );
        }
        let d = 1e-5;
        let central = (all(joint + d).0[2] - all(joint - d).0[2]) / (2.0 * d);
        // Truncation d/4 of the jump of the curvature, which is at most 1/2 in these units.
        assert!((central - all(joint).1).abs() < 0.26 * d * 0.5 + 1e-10, "content at {joint}");
    }
}
