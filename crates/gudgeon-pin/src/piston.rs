//! Rules of piston design: skirt clearance and profile, ovality, crown recess, main dimensions, mass, alloys (`reimer1984`).

use std::f64::consts::PI;

/// One station of a skirt.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Station {
    /// Height above the open end of the skirt \[m\].
    pub height: f64,
    /// Temperature of the piston \[K\].
    pub temperature: f64,
    /// Thermal expansion of the piston \[1/K\].
    pub expansion: f64,
    /// Wanted diametral clearance of the warm piston \[m\].
    pub wanted: f64,
}

/// Heights of the stations as fractions of the skirt, from its open end.
pub const STATIONS: [f64; 5] = [0.0, 0.25, 0.50, 0.82, 0.94];

/// Cylinder, assembly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Barrel {
    /// Nominal diameter D \[m\].
    pub bore: f64,
    /// Temperature of the cylinder \[K\].
    pub temperature: f64,
    /// Thermal expansion of the cylinder \[1/K\].
    pub expansion: f64,
    /// Temperature at assembly \[K\].
    pub assembly_temperature: f64,
    /// Clearance at assembly, on the diameter \[m\].
    pub assembly_clearance: f64,
}

/// Clearances at one station, on the diameter \[m\].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Clearance {
    /// Growth of the piston over that of the cylinder: `D ((T_p - T_m) α_p - (T_c - T_m) α_c)`.
    pub growth: f64,
    /// Clearance at assembly that would leave the wanted one: `S + growth`.
    pub theoretical: f64,
    /// Clearance at assembly less the theoretical one: what the profile has to give, negative where material must go.
    pub deviation: f64,
    /// Clearance of the warm piston without a profile.
    pub warm: f64,
}

impl Barrel {
    /// Clearances at a station.
    #[must_use]
    pub fn clearance(&self, s: &Station) -> Clearance {
        let growth = self.bore
            * ((s.temperature - self.assembly_temperature) * s.expansion
                - (self.temperature - self.assembly_temperature) * self.expansion);
        let theoretical = s.wanted + growth;
        Clearance {
            growth,
            theoretical,
            deviation: self.assembly_clearance - theoretical,
            warm: self.assembly_clearance - growth,
        }
    }
}

/// Ordinates that the published program proposes for five stations \[m\]: the deviation at the top, half of it below, nothing at the two
/// stations in the middle, the wanted clearance at the mouth.
#[must_use]
pub fn proposed_ordinates(stations: &[Station; 5], clearances: &[Clearance; 5]) -> [f64; 5] {
    let top = clearances[4].deviation;
    [-stations[0].wanted, 0.0, 0.0, 0.5 * top, top]
}

/// Difference of the axes of an elliptic skirt \[m\]: `Ov = D s/(1 + s)`, `s` the area of the round skirt over that of the oval one, less
/// one.
#[must_use]
pub fn ovality(bore: f64, surface_ratio: f64) -> f64 {
    bore * surface_ratio / (1.0 + surface_ratio)
}

/// Radius of the oval skirt \[m\] at an angle from the thrust direction: `D/2 - Ov/4 (1 - cos 2θ)`.
#[must_use]
pub fn oval_radius(bore: f64, ovality: f64, angle: f64) -> f64 {
    0.5 * bore - 0.25 * ovality * (1.0 - elementary::cos(2.0 * angle))
}

/// Volume of a spherical cap \[m³\], `π H² (3 R - H)/3`.
#[must_use]
pub fn cap_volume(depth: f64, radius: f64) -> f64 {
    PI * depth * depth * (3.0 * radius - depth) / 3.0
}

/// Volume of a spherical cap \[m³\] from its rim, `π H (3 A² + H²)/6`.
#[must_use]
pub fn cap_volume_of_rim(depth: f64, rim: f64) -> f64 {
    PI * depth * (3.0 * rim * rim + depth * depth) / 6.0
}

/// Radius of the rim of a spherical cap \[m\], `A² = 2 R H - H²`.
#[must_use]
pub fn cap_rim(depth: f64, radius: f64) -> f64 {
    (depth * (2.0 * radius - depth)).max(0.0).sqrt()
}

/// Depth \[m\] of a spherical cap of a radius that holds a volume; `None` when the half sphere holds less.
#[must_use]
pub fn cap_depth(volume: f64, radius: f64) -> Option<f64> {
    if !(volume > 0.0 && radius > 0.0 && volume <= cap_volume(radius, radius)) {
        return None;
    }
    // Rising and convex up to the equator: Newton from there descends without overshoot beyond the first step.
    let (mut lo, mut hi) = (0.0, radius);
    for _ in 0..200 {
        let mid = 0.5 * (lo + hi);
        if mid <= lo || mid >= hi {
            break;
        }
        if cap_volume(mid, radius) < volume {
            lo = mid;
        } else {
            hi = mid;
        }
    }
    Some(0.5 * (lo + hi))
}

/// Mass of a piston \[kg\] from its apparent density \[kg/m³\], `k D³`: 550 for light pistons.
#[must_use]
pub fn mass_estimate(apparent_density: f64, bore: f64) -> f64 {
    apparent_density * bore.powi(3)
}

/// A main dimension as a fraction of the piston diameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Guide {
    /// Name in case files.
    pub name: &'static str,
    /// What it is.
    pub what: &'static str,
    /// Smallest fraction.
    pub low: f64,
    /// Greatest fraction.
    pub high: f64,
}

/// Main dimensions of light petrol and alcohol pistons.
pub const GUIDES: [Guide; 6] = [
    Guide { name: "total_height", what: "total height", low: 0.65, high: 0.65 },
    Guide { name: "top_land", what: "crown to first groove", low: 0.07, high: 0.07 },
    Guide { name: "first_wall", what: "wall between first and second groove", low: 0.03, high: 0.05 },
    Guide { name: "crown_thickness", what: "thickness of the crown", low: 0.07, high: 0.07 },
    Guide { name: "compression_height", what: "pin axis to crown", low: 0.35, high: 0.35 },
    Guide { name: "skirt_height", what: "height of the skirt", low: 0.45, high: 0.45 },
];

/// How an alloy is made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Making {
    /// Cast in a permanent mould.
    Cast,
    /// Forged.
    Forged,
}

/// A piston alloy, typical values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Alloy {
    /// Name in case files.
    pub name: &'static str,
    /// How it is made.
    pub making: Making,
    /// Heat treatment.
    pub temper: &'static str,
    /// Tensile strength \[Pa\].
    pub tensile: f64,
    /// Yield strength at 0.2 % \[Pa\].
    pub yield_strength: f64,
    /// Elongation.
    pub elongation: f64,
    /// Young's modulus \[Pa\].
    pub modulus: f64,
    /// Brinell hardness.
    pub brinell: f64,
    /// Density \[kg/m³\].
    pub density: f64,
    /// Heat conductivity at 25 °C \[W/(m K)\].
    pub conductivity: f64,
    /// Thermal expansion from 20 to 200 °C \[1/K\].
    pub expansion: f64,
    /// Silicon, mass fraction from and to.
    pub silicon: (f64, f64),
}

/// One row of the printed table: kgf/mm², %, kgf/mm², Brinell, g/cm³, cal/(cm s °C), 1e-6/°C, % Si.
#[expect(clippy::too_many_arguments, reason = "a table has columns")]
const fn alloy(
    name: &'static str,
    making: Making,
    tensile: f64,
    yield_strength: f64,
    elongation: f64,
    modulus: f64,
    brinell: f64,
    density: f64,
    conductivity: f64,
    expansion: f64,
    silicon: (f64, f64),
) -> Alloy {
    const KGF: f64 = 9_806_650.0;
    Alloy {
        name,
        making,
        temper: match (making, name.as_bytes()[0]) {
            (Making::Cast, _) => "T5",
            _ => "T6",
        },
        tensile: tensile * KGF,
        yield_strength: yield_strength * KGF,
        elongation: elongation * 1e-2,
        modulus: modulus * KGF,
        brinell,
        density: density * 1e3,
        conductivity: conductivity * 418.68,
        expansion: expansion * 1e-6,
        silicon: (silicon.0 * 1e-2, silicon.1 * 1e-2),
    }
}

use Making::{Cast, Forged};
use gudgeon_numerics::elementary;

/// Piston alloys as tabulated in the source.
pub const ALLOYS: [Alloy; 10] = [
    alloy("m124_cast", Cast, 22.0, 20.0, 0.5, 7800.0, 100.0, 2.69, 0.28, 20.7, (11.0, 13.0)),
    alloy("m124_forged", Forged, 36.0, 31.0, 4.0, 7800.0, 120.0, 2.69, 0.33, 20.3, (11.0, 13.0)),
    alloy("m138_cast", Cast, 20.0, 18.0, 0.3, 8200.0, 100.0, 2.67, 0.26, 18.5, (17.0, 19.0)),
    alloy("m138_forged", Forged, 28.0, 24.0, 1.5, 8200.0, 115.0, 2.67, 0.28, 18.2, (17.0, 19.0)),
    alloy("m244_cast", Cast, 20.0, 18.0, 0.2, 8200.0, 100.0, 2.66, 0.24, 16.5, (23.0, 26.0)),
    alloy("m132_cast", Cast, 24.0, 20.0, 0.5, 7800.0, 105.0, 2.71, 0.28, 20.7, (11.0, 13.0)),
    alloy("m332_cast", Cast, 24.0, 20.0, 0.5, 7800.0, 105.0, 2.72, 0.25, 21.6, (8.5, 10.5)),
    alloy("my_cast", Cast, 26.0, 24.0, 0.7, 7200.0, 105.0, 2.80, 0.33, 23.5, (0.0, 0.5)),
    alloy("ams4145_forged", Forged, 38.0, 32.0, 5.0, 7800.0, 120.0, 2.69, 0.33, 20.3, (11.0, 13.5)),
    alloy("ams4140_forged", Forged, 40.0, 30.0, 10.0, 7600.0, 115.0, 2.81, 0.37, 23.2, (0.0, 0.9)),
];

/// An alloy by name.
#[must_use]
pub fn find_alloy(name: &str) -> Option<&'static Alloy> {
    ALLOYS.iter().find(|a| a.name == name)
}

/// Bore of the boss: how much a profile raises the pressure at which the boss cracks, tested against a cylindrical one.
pub const BOSS_PROFILES: [(&str, f64); 4] = [("cylindrical", 1.0), ("A", 1.04), ("B", 1.14), ("C", 1.25)];
