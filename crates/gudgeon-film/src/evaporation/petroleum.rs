//! Hydrocarbons that are known by their boiling temperature.

use gudgeon_numerics::elementary;

/// Boiling temperatures at 1 atm \[K\] for which the correlations below are meant.
pub const BOILING: (f64, f64) = (300.0, 1000.0);
/// One millimetre of mercury \[Pa\].
const MERCURY: f64 = 133.322;
/// Largest [`group`] that is evaluated: a pressure of 1e-68 mmHg.
const COLDEST: f64 = 0.0125;
/// Lowest temperature \[K\] that is evaluated.
const LOWEST: f64 = 100.0;

/// The group of Maxwell and Bonnell for a hydrocarbon that boils at `boiling` \[K\].
fn group(boiling: f64, temperature: f64) -> f64 {
    let t = temperature.max(LOWEST);
    ((boiling / t - 0.000_516_06 * boiling) / (748.1 - 0.3861 * boiling)).min(COLDEST)
}

/// Vapour pressure \[Pa\] at `temperature` \[K\] of a petroleum fraction that boils at `boiling` \[K\] under 1 atm, by Maxwell and Bonnell for a
/// characterisation factor of 12, that of paraffinic oils.
///
/// Three rational laws meet at 2 mmHg and at 1 atm, to 1 % of the pressure.
pub fn vapour_pressure(boiling: f64, temperature: f64) -> f64 {
    let x = group(boiling, temperature);
    let log = if x > 0.0022 {
        (3_000.538 * x - 6.761_56) / (43.0 * x - 0.987_672)
    } else if x >= 0.0013 {
        (2_663.129 * x - 5.994_296) / (95.76 * x - 0.972_546)
    } else {
        (2_770.085 * x - 6.412_631) / (36.0 * x - 0.989_679)
    };
    MERCURY * elementary::powf(10_f64, log)
}

/// Molar mass \[kg/mol\] of the normal alkane that boils at `boiling` \[K\] under 1 atm, `T_b = 1070 - exp(6.98291 - 0.02013 M^(2/3))`, by Riazi and
/// Al-Sahhaf.
pub fn molar_mass(boiling: f64) -> f64 {
    1e-3 * elementary::powf((6.982_91 - elementary::ln(1070.0 - boiling)) / 0.020_13, 1.5)
}

/// Molar mass of air \[kg/mol\].
pub const AIR: f64 = 0.02897;

/// Diffusivity \[m²/s\] at 300 K and 1 atm in air of the normal alkane of molar mass `mass` \[kg/mol\], by Fuller, Schettler and Giddings.
pub fn diffusivity(mass: f64) -> f64 {
    let carbons = (1e3 * mass - 2.016) / 14.027;
    let volume = 16.5 * carbons + 1.98 * (2.0 * carbons + 2.0);
    let width = elementary::cbrt(volume) + elementary::cbrt(20.1_f64);
    1e-7 * elementary::powf(300_f64, 1.75) * (1e-3 / mass + 1e-3 / AIR).sqrt() / (width * width)
}

/// Lewis number, thermal diffusivity of air over [`diffusivity`]. Both grow with the 1.75th to 1.8th power of temperature and fall with pressure alike,
/// so that it is a constant.
pub fn lewis_number(mass: f64) -> f64 {
    /// Of air at 300 K and 1 atm \[m²/s\].
    const THERMAL: f64 = 22.5e-6;
    THERMAL / diffusivity(mass)
}
