//! The published engine (Reimer 1984) and random ones.

use std::sync::LazyLock;

use gudgeon_core::BuildError;
use gudgeon_core::file::Files;
use gudgeon_core::kinds::{
    BossBore, EngineCycle, PIN_QUANTITIES, PinForces, PinLoadCase, PinLoadCtx, PinLoadSpec, PinSize,
    PinStrength, PinStrengthCtx, PinStrengthSpec,
};
use gudgeon_pin::design::{Design, Range, Relief};

/// kgf/mm² \[Pa\].
pub const KGF: f64 = 9_806_650.0;
/// The ratio of circumference to diameter as the published programs mistype it.
pub const PUBLISHED_PI: f64 = 3.14159267;
pub const BORE: f64 = 85e-3;
pub const GAP: f64 = 27e-3;

pub fn no_case(_: &str) -> Result<EngineCycle, BuildError> {
    Err(BuildError::new("no other case"))
}

static NO_FILES: LazyLock<Files> = LazyLock::new(Files::default);

pub fn load_ctx(pi: f64) -> PinLoadCtx<'static> {
    PinLoadCtx { bore: BORE, pi, files: &NO_FILES, cycle_of: &no_case }
}

pub fn strength_ctx(pi: f64) -> PinStrengthCtx {
    PinStrengthCtx {
        boss_gap: GAP,
        rod_width: 24e-3,
        boss_bore: BossBore::Profiled,
        modulus: 2.1e4 * KGF,
        poisson: 0.3,
        pi,
    }
}

pub fn spec<T: ?Sized>(json: serde_json::Value) -> Box<T>
where
    Box<T>: serde::de::DeserializeOwned,
{
    serde_json::from_value(json).expect("a specification")
}

pub fn published_load(pi: f64) -> PinLoadCase {
    let s: Box<dyn PinLoadSpec> = spec(serde_json::json!({
        "model": "peak_pressure_rule", "compression_ratio": 12, "speed": "2700 rpm", "stroke": "79.3 mm",
        "rod_length": "138.5 mm", "piston_mass": "335 g", "gravity": 9.8,
    }));
    s.build(&load_ctx(pi)).expect("builds")
}

pub fn model(name: &str, pi: f64) -> Box<dyn PinStrength> {
    let s: Box<dyn PinStrengthSpec> = spec(serde_json::json!({ "model": name }));
    s.build(&strength_ctx(pi)).expect("builds")
}

pub const MODELS: [&str; 4] = ["curved_ring", "elastic_ring", "shear_beam", "thin_ring"];

/// Limits of the source, in the order of the quantities.
pub fn limits() -> [f64; PIN_QUANTITIES] {
    [6.5 * KGF, 0.045e-3, 0.050e-3, 10.0 * KGF, 52.0 * KGF, 43.0 * KGF, 25.0 * KGF, 65.0 * KGF]
}

pub fn published_design(strength: &dyn PinStrength, pi: f64) -> Design<'_> {
    Design {
        strength,
        load: published_load(pi).design.forces,
        limits: limits(),
        density: 7850.0,
        pi,
        relief: Some(Relief { bore: BORE, height: 26e-3, density: 2690.0 }),
        boss_gap: GAP,
        length: Range { low: GAP * 1.001, high: BORE * (1.0 - 1e-6) },
        outer: Range { low: 19.55e-3, high: 23.8e-3 },
        inner: Range { low: 0.0, high: 1.0 },
        min_wall: 0.0,
        tolerance: PinSize::default(),
    }
}

pub fn mm(length: f64, outer: f64, inner: f64) -> PinSize {
    PinSize { length: 1e-3 * length, outer: 1e-3 * outer, inner: 1e-3 * inner }
}

/// A cheap generator: the same numbers on every machine.
pub struct Random(pub u64);

impl Random {
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
    pub fn between(&mut self, a: f64, b: f64) -> f64 {
        a + (b - a) * self.unit()
    }
}

/// A random engine around a bore of 60 to 200 mm: force, gap, limits, relief.
pub struct Engine {
    pub ctx: PinStrengthCtx,
    pub load: PinForces,
    pub limits: [f64; PIN_QUANTITIES],
    pub bore: f64,
    pub relief: f64,
    pub outer: f64,
}

impl Engine {
    pub fn new(r: &mut Random) -> Self {
        let bore = r.between(60e-3, 200e-3);
        let gas = r.between(6e6, 22e6) * std::f64::consts::PI * bore * bore / 4.0;
        let gap = bore * r.between(0.28, 0.38);
        let base = limits();
        // Deformations are allowed in proportion to the engine.
        let limits = std::array::from_fn(|k| {
            let size = if k == 1 || k == 2 { bore / BORE } else { 1.0 };
            base[k] * size * r.between(0.85, 1.3)
        });
        Self {
            ctx: PinStrengthCtx {
                boss_gap: gap,
                rod_width: gap * r.between(0.85, 0.97),
                boss_bore: BossBore::Profiled,
                modulus: 206e9,
                poisson: 0.3,
                pi: std::f64::consts::PI,
            },
            load: PinForces { gas, inertia: -gas * r.between(0.0, 0.1) },
            limits,
            bore,
            relief: r.between(0.2, 0.35) * bore,
            outer: r.between(0.28, 0.6) * bore,
        }
    }

    pub fn design<'a>(&self, strength: &'a dyn PinStrength) -> Design<'a> {
        Design {
            strength,
            load: self.load,
            limits: self.limits,
            density: 7850.0,
            pi: self.ctx.pi,
            relief: Some(Relief { bore: self.bore, height: self.relief, density: 2690.0 }),
            boss_gap: self.ctx.boss_gap,
            length: Range { low: 1.001 * self.ctx.boss_gap, high: 0.999 * self.bore },
            outer: Range { low: 0.2 * self.bore, high: self.outer },
            inner: Range { low: 0.0, high: self.bore },
            min_wall: 0.0,
            tolerance: PinSize::default(),
        }
    }
}
