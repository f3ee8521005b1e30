//! Ratio of specific heats of the gas in the orifice law.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Ratio of specific heats of the gas that flows through openings.
///
/// `γ = 1 + 1/(c_p/R - 1)` with `c_p/R` of an ideal mixture, from the polynomials of temperature of the NASA form with the
/// coefficients of GRI-Mech 3.0. It enters the flow function alone; the gas constant stays that of the machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Gamma {
    /// The machine's.
    #[default]
    Constant,
    /// Dry air: 1.401 at 300 K, 1.376 at 600 K, 1.336 at 1000 K.
    Air,
    /// What the stoichiometric combustion of `CH_1.85` in air leaves: 1.372 at 300 K, 1.335 at 600 K, 1.294 at 1000 K.
    BurntGas,
}

/// Range of the polynomials \[K\]; temperatures outside get the values of its ends.
const RANGE: (f64, f64) = (300.0, 3500.0);
/// Where the two polynomials of a species meet \[K\].
const JOINT: f64 = 1000.0;

/// `c_p/R = a0 + a1 T + … + a4 T⁴` below and above [`JOINT`].
type Species = [[f64; 5]; 2];

const N2: Species = [
    [3.298677, 1.408_240_4e-3, -3.963_222e-6, 5.641_515e-9, -2.444_854e-12],
    [2.92664, 1.487_976_8e-3, -5.684_76e-7, 1.009_703_8e-10, -6.753_351e-15],
];
const O2: Species = [
    [3.782_456_36, -2.996_734_16e-3, 9.847_302_01e-6, -9.681_295_09e-9, 3.243_728_37e-12],
    [3.282_537_84, 1.483_087_54e-3, -7.579_666_69e-7, 2.094_705_55e-10, -2.167_177_94e-14],
];
const CO2: Species = [
    [2.356_773_52, 8.984_596_77e-3, -7.123_562_69e-6, 2.459_190_22e-9, -1.436_995_48e-13],
    [3.857_460_29, 4.414_370_26e-3, -2.214_814_04e-6, 5.234_901_88e-10, -4.720_841_64e-14],
];
const H2O: Species = [
    [4.198_640_56, -2.036_434_1e-3, 6.520_402_11e-6, -5.487_970_62e-9, 1.771_978_17e-12],
    [3.033_992_49, 2.176_918_04e-3, -1.640_725_18e-7, -9.704_198_7e-11, 1.682_009_92e-14],
];
const AR: Species = [[2.5, 0.0, 0.0, 0.0, 0.0], [2.5, 0.0, 0.0, 0.0, 0.0]];

/// Mole fractions of dry air; traces counted as nitrogen.
const AIR: [(Species, f64); 3] = [(N2, 0.7812), (O2, 0.2095), (AR, 0.0093)];

/// Hydrogen atoms per carbon atom of the fuel: between diesel and petrol.
const HYDROGEN: f64 = 1.85;

/// Moles left by a mole of `CH_y` and the air it needs, `1 + y/4` moles of oxygen with what comes with it.
const BURNT: [(Species, f64); 4] = {
    let oxygen = 1.0 + HYDROGEN / 4.0;
    [
        (CO2, 1.0),
        (H2O, HYDROGEN / 2.0),
        (N2, oxygen * AIR[0].1 / AIR[1].1),
        (AR, oxygen * AIR[2].1 / AIR[1].1),
    ]
};

/// `c_p/R` of a mixture at `t` \[K\].
fn heat_capacity(mixture: &[(Species, f64)], t: f64) -> f64 {
    let t = t.clamp(RANGE.0, RANGE.1);
    let half = usize::from(t > JOINT);
    let (mut sum, mut moles) = (0.0, 0.0);
    for (species, n) in mixture {
        sum += n * species[half].iter().rev().fold(0.0, |s, a| s * t + a);
        moles += n;
    }
    sum / moles
}

impl Gamma {
    /// The ratio at a temperature \[K\]; `constant` where that is asked for.
    #[must_use]
    pub fn at(self, temperature: f64, constant: f64) -> f64 {
        let cp = match self {
            Self::Constant => return constant,
            Self::Air => heat_capacity(&AIR, temperature),
            Self::BurntGas => heat_capacity(&BURNT, temperature),
        };
        cp / (cp - 1.0)
    }
}
