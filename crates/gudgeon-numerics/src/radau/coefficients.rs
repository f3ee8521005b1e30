//! Coefficients of the method, and its eigenvalues and eigenvectors (hairer1996, section IV.8).

#![allow(clippy::excessive_precision, reason = "coefficients as published")]

pub const SQRT_6: f64 = 2.449_489_742_783_178;
pub const C: [f64; 3] = [(4.0 - SQRT_6) / 10.0, (4.0 + SQRT_6) / 10.0, 1.0];
/// Real eigenvalue of `A⁻¹`, `30/(6 + 81^(1/3) - 9^(1/3))`.
pub const REAL: f64 = 3.637_834_252_744_496;
/// Complex eigenvalue of `A⁻¹`.
pub const RE: f64 = 2.681_082_873_627_752;
pub const IM: f64 = 3.050_430_199_247_41;
/// Columns: the real eigenvector of `A⁻¹`, real and imaginary part of the complex one.
pub const T: [[f64; 3]; 3] = [
    [0.091_232_394_870_892_94, -0.141_255_295_020_954_2, -0.030_029_194_105_147_424],
    [0.241_717_932_707_107_02, 0.204_129_352_293_799_94, 0.382_942_112_757_261_94],
    [0.966_048_182_615_092_9, 1.0, 0.0],
];
pub const T_INV: [[f64; 3]; 3] = [
    [4.325_579_890_063_155, 0.339_199_251_815_809_87, 0.541_770_539_935_874_9],
    [-4.178_718_591_551_905, -0.327_682_820_761_062_4, 0.476_623_554_500_550_45],
    [-0.502_872_634_945_786_9, 2.571_926_949_855_605_4, -0.596_039_204_828_224_9],
];
/// Weights of the stages in the error estimate.
pub const E: [f64; 3] = [-(13.0 + 7.0 * SQRT_6) / 3.0, (-13.0 + 7.0 * SQRT_6) / 3.0, -1.0 / 3.0];

/// The collocation polynomial at `s` (-1: start of the step, 0: end), less its value at the end, from its divided differences.
pub fn newton_form(s: f64, d: [f64; 3]) -> f64 {
    s * (d[0] + (s - (C[1] - 1.0)) * (d[1] + (s - (C[0] - 1.0)) * d[2]))
}
