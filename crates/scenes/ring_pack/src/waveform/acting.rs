//! What acts on a ring in its groove between two instants of the gas.

use gudgeon_core::kinds::AxialForces;

use super::super::pack::Pack;

/// What acts on a ring at an instant of the gas.
#[derive(Debug, Clone, Copy, Default)]
pub struct Acting {
    pub t: f64,
    /// Forces that do not change with time.
    fixed: AxialForces,
    /// What does: axial forces of gas, inertia and film \[N\], pressures above, behind and below \[Pa\], clearance \[m\].
    values: Values,
}

/// What of the surroundings of a ring changes with time, or something of each.
pub type Values = [f64; 7];

impl Acting {
    /// Of ring `i` at the instant of the pack.
    pub fn of(pack: &Pack, i: usize) -> Self {
        let (r, clearance) = (&pack.at.rings[i], pack.at.places[i].clearance);
        let AxialForces { gas, inertia, film, .. } = r.axial;
        let values = [gas, inertia, film, r.p_above, r.p_back, r.p_below, clearance];
        Self { t: pack.at.theta, fixed: r.axial, values }
    }

    /// Axial force of the gas \[N\].
    pub const fn gas_force(&self) -> f64 {
        self.values[0]
    }

    /// All axial forces on the ring, those of the oil in the groove apart.
    pub const fn axial(&self) -> AxialForces {
        let [gas, inertia, film, ..] = self.values;
        AxialForces { gas, inertia, film, ..self.fixed }
    }

    /// Pressures above, behind and below \[Pa\].
    pub const fn pressures(&self) -> [f64; 3] {
        let [_, _, _, above, behind, below, _] = self.values;
        [above, behind, below]
    }

    /// Mean rates of what changes, from another instant on \[1/rad\].
    pub fn mean_rates(&self, from: &Self) -> Values {
        let per = 1.0 / (self.t - from.t);
        std::array::from_fn(|k| (self.values[k] - from.values[k]) * per)
    }

    /// Clearance in the groove \[m\].
    pub const fn clearance(&self) -> f64 {
        self.values[6]
    }
}

/// How they change from one instant to the next: parabolas that overshoot neither end.
#[derive(Debug, Clone, Copy, Default)]
pub struct Variation {
    from: Values,
    /// Change from one to the other, and what it would be as it begins.
    change: Values,
    begins: Values,
}

impl Variation {
    /// From one instant to another. Before the first the mean rates were `rates` over `before` \[rad\], zero where nothing is known of that.
    pub fn new(from: &Acting, to: &Acting, (rates, before): &(Values, f64)) -> Self {
        let span = to.t - from.t;
        let change: Values = std::array::from_fn(|k| to.values[k] - from.values[k]);
        let begins = std::array::from_fn(|k| {
            if *before > 0.0 { slope_between(rates[k] * span, before / span, change[k]) } else { change[k] }
        });
        Self { from: from.values, change, begins }
    }

    /// What acts at the part `x` of the span that ends at `to`.
    pub fn at(&self, x: f64, to: &Acting) -> Acting {
        let values = std::array::from_fn(|k| {
            let (all, begins) = (self.change[k], self.begins[k]);
            self.from[k] + x * (begins + x * (all - begins))
        });
        Acting { values, ..*to }
    }
}

/// Slope between a change at the rate `a` over `length` and one of `b` over one, by the harmonic mean of the piecewise cubics that do not overshoot
/// (fritsch1980), and at most twice `b`, beyond which a parabola would turn round.
fn slope_between(a: f64, length: f64, b: f64) -> f64 {
    if a * b <= 0.0 {
        return 0.0;
    }
    let (first, second) = (2.0 + length, 1.0 + 2.0 * length);
    let mean = (first + second) / (first / a + second / b);
    if b > 0.0 { mean.min(2.0 * b) } else { mean.max(2.0 * b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(t: f64, value: f64) -> Acting {
        Acting { t, fixed: AxialForces::default(), values: [value; 7] }
    }

    #[test]
    fn a_parabola_that_goes_on_is_met_where_steps_are_equal() {
        // The harmonic mean of 3 and 5 and not their mean, 4: it is made not to overshoot.
        let slope = slope_between(3.0, 1.0, 5.0);
        assert!((slope - 2.0 / (1.0 / 3.0 + 1.0 / 5.0)).abs() < 1e-14, "{slope}");
    }

    #[test]
    fn nothing_overshoots_its_ends() {
        for (rate, to) in [(100.0, 1.0), (-3.0, 1.0), (0.0, -2.0), (1e-3, -1e-9), (0.2, 0.0)] {
            let variation = Variation::new(&at(1.0, 0.0), &at(1.5, to), &([rate; 7], 0.1));
            let values: Vec<f64> =
                (0..=20).map(|k| variation.at(f64::from(k) / 20.0, &at(1.5, to)).gas_force()).collect();
            assert_eq!((values[0], values[20]), (0.0, to));
            // Rounding of three products.
            let slack = 1e-15 * to.abs();
            assert!(
                values.windows(2).all(|w| (w[1] - w[0]) * to.signum() >= -slack),
                "{rate} {to}: {values:?}"
            );
        }
    }

    #[test]
    fn where_nothing_is_known_before_it_is_a_line() {
        let variation = Variation::new(&at(0.0, 1.0), &at(2.0, 3.0), &([0.0; 7], 0.0));
        assert_eq!(variation.at(0.25, &at(2.0, 3.0)).clearance(), 1.5);
    }
}
