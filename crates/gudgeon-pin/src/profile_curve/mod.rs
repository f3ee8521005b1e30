//! Curves through the ordinates of a skirt profile.

pub mod lagrange;
pub mod linear;
pub mod monotone_cubic;

use gudgeon_core::BuildError;

/// Refuses points that no curve goes through.
fn check(x: &[f64], y: &[f64]) -> Result<(), BuildError> {
    if x.len() != y.len() || x.len() < 2 {
        let what = format!("{} abscissae with {} ordinates: a curve needs two points", x.len(), y.len());
        return Err(BuildError::new(what));
    }
    if x.iter().chain(y).any(|v| !v.is_finite()) {
        return Err(BuildError::new("a point of the profile is not a number"));
    }
    match x.windows(2).find(|w| w[1] <= w[0]) {
        Some(w) => Err(BuildError::new(format!("{} m does not lie above {} m", w[1], w[0]))),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use gudgeon_core::kinds::{ProfileCurve, ProfileCurveSpec};

    use super::{lagrange::Lagrange, linear::Linear, monotone_cubic::MonotoneCubic};

    /// The nodes of the published run \[mm, um\] (Reimer 1984).
    const X: [f64; 5] = [0.0, 9.0, 18.0, 29.52, 33.84];
    const Y: [f64; 5] = [-20.0, 0.0, 0.0, -60.44, -120.88];

    fn curves() -> [Box<dyn ProfileCurve>; 3] {
        let specs: [&dyn ProfileCurveSpec; 3] = [&Lagrange {}, &MonotoneCubic {}, &Linear {}];
        specs.map(|s| s.build(&X, &Y).expect("builds"))
    }

    /// The printed table (Reimer 1984), digits that the reproduction garbled repaired; 6 digits, the last row 5.
    #[test]
    fn the_polynomial_is_the_published_table() {
        let printed = [
            -20.0, -13.4731, -8.32267, -4.29325, -1.2138, 1.00212, 2.3564, 2.76638, 2.06484, 0.0, -3.76447,
            -9.64947, -18.1604, -29.8874, -45.5048, -65.7719, -91.5323, -123.714, -163.33,
        ];
        let [lagrange, ..] = curves();
        for (k, p) in printed.into_iter().enumerate() {
            let y = lagrange.value(2.0 * k as f64);
            let half_digit =
                if k == 18 { 5e-3 } else { 0.5 * 10f64.powi(f64::log10(f64::abs(p).max(1.0)) as i32 - 5) };
            assert!((y - p).abs() <= half_digit * 1.0001, "{k}: {y} {p}");
        }
    }

    #[test]
    fn every_curve_meets_its_nodes_and_two_keep_the_shape() {
        for c in &curves() {
            for (x, y) in X.iter().zip(Y) {
                assert!((c.value(*x) - y).abs() < 1e-13 * 120.0, "rounding of products of node distances");
            }
        }
        let [lagrange, monotone, linear] = curves();
        // Between the two nodes at zero the polynomial stands proud of the piston, the others do not.
        assert!(lagrange.value(14.0) > 2.7);
        for k in 0..=360 {
            let x = 0.1 * f64::from(k);
            assert!(monotone.value(x) <= 0.0 && linear.value(x) <= 0.0, "{x}");
        }
        // Beyond the last node both go on straight, with the slope of the end.
        let slope = |c: &dyn ProfileCurve| (c.value(40.0) - c.value(36.0)) / 4.0;
        assert!((slope(&*linear) + 60.44 / 4.32).abs() < 1e-12);
        assert!(slope(&*monotone) < 0.0);
    }

    #[test]
    fn points_without_a_curve_are_refused() {
        for (x, y) in [
            (vec![0.0], vec![1.0]),
            (vec![0.0, 1.0], vec![1.0]),
            (vec![0.0, 0.0], vec![1.0, 2.0]),
            (vec![0.0, f64::NAN], vec![1.0, 2.0]),
        ] {
            assert!(Lagrange {}.build(&x, &y).is_err() && Linear {}.build(&x, &y).is_err());
            assert!(MonotoneCubic {}.build(&x, &y).is_err());
        }
    }
}
