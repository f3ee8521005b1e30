//! Friction in narrow channels: conductance, turbulence, viscosity of the gas.

use gudgeon_core::elementary;

/// Conductance \[kg/(s Pa²)\] of a channel between parallel walls: `perimeter height³ / (24 μ R T length)`, with the
/// `perimeter` \[m\] across the flow, the distance `height` \[m\] of the walls and the `length` \[m\] along the flow.
///
/// Holds while the flow is laminar and its Mach number small.
#[must_use]
pub fn channel_conductance(perimeter: f64, height: f64, length: f64, mu: f64, rt: f64) -> f64 {
    perimeter * height * height * height / (24.0 * mu * rt * length)
}

/// Reynolds number at which the laminar friction factor of a flat channel, `96/Re`, and Blasius', `0.3164 Re^(-1/4)`, are equal:
/// `(96/0.3164)^(4/3)`.
pub const TRANSITION: f64 = 2_038.823_720_100_052_5;

/// Cube of `Re/Re_c` below which the share is summed up.
const SLOW: f64 = 1e-3;

/// `(1 + x)^(-1/7)` for `x` up to [`SLOW`], by its series: the first term left out is below the rounding error.
#[inline]
fn slow_share(x: f64) -> f64 {
    const C: [f64; 5] = [-1.0 / 7.0, 4.0 / 49.0, -20.0 / 343.0, 110.0 / 2401.0, -638.0 / 16807.0];
    1.0 + x * (C[0] + x * (C[1] + x * (C[2] + x * (C[3] + x * C[4]))))
}

/// What turbulence leaves of the laminar flow `c` of a channel, `[1 + (Re/Re_c)³]^(-1/7)`, and of its derivative by `c`, at the
/// Reynolds number `Re` that the laminar flow would have; `Re_c` is [`TRANSITION`]. Finite for every `Re >= 0`, infinity included.
#[inline]
#[must_use]
pub fn turbulent_share(reynolds: f64) -> (f64, f64) {
    let cube = cube(reynolds);
    let share = share_at(cube);
    (share, share * (1.0 - 3.0 / 7.0 * cube / (1.0 + cube)))
}

/// The first of [`turbulent_share`].
#[inline]
pub(crate) fn flow_share(reynolds: f64) -> f64 {
    share_at(cube(reynolds))
}

/// Cube of `Re/Re_c`, bounded so that it stays a number.
#[inline]
fn cube(reynolds: f64) -> f64 {
    let x = (reynolds * (1.0 / TRANSITION)).min(1e100);
    x * x * x
}

/// `(1 + cube)^(-1/7)`.
#[inline]
fn share_at(cube: f64) -> f64 {
    if cube < SLOW { slow_share(cube) } else { elementary::exp(elementary::ln(1.0 + cube) * (-1.0 / 7.0)) }
}

/// Dynamic viscosity \[Pa s\] of air at the temperature \[K\] by Sutherland's law,
/// `μ = μ_0 (T/T_0)^1.5 (T_0 + S)/(T + S)` with `μ_0` = 17.16 µPa s at `T_0` = 273.15 K and `S` = 110.4 K.
///
/// Within 2 % of handbook values from 200 K to 700 K.
#[must_use]
pub fn sutherland_viscosity(temperature: f64) -> f64 {
    const MU_0: f64 = 1.716e-5;
    const T_0: f64 = 273.15;
    const S: f64 = 110.4;
    let t = temperature / T_0;
    MU_0 * t * t.sqrt() * (T_0 + S) / (temperature + S)
}

/// Dynamic viscosity \[Pa s\] of the products of stoichiometric combustion at the temperature \[K\]: `3.3e-7 T^0.7 / 1.027`.
///
/// Heywood's fits of computed viscosities, `μ_air = 3.3e-7 T^0.7` and `μ_products = μ_air/(1 + 0.027 φ)` with the equivalence ratio `φ` = 1, made
/// for 500 K to 4000 K and pressures from 1 to 100 bar.
#[must_use]
pub fn burnt_gas_viscosity(temperature: f64) -> f64 {
    3.3e-7 * elementary::powf(temperature, 0.7) / 1.027
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_series_is_the_power_where_it_stands_for_it() {
        for k in 0..=100 {
            let x = SLOW * f64::from(k) / 100.0;
            let power = elementary::powf(1.0 + x, -1.0 / 7.0);
            // Roundings of the sum in the power, of the power, and of the last sum.
            assert!(
                (slow_share(x) - power).abs() <= 4.0 * f64::EPSILON,
                "{x}: {} for {power}",
                slow_share(x)
            );
        }
    }
}
