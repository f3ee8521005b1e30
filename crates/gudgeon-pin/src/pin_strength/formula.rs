//! Formulas that the models share, written once for values and for values with derivatives.

use std::fmt::Debug;

use gudgeon_core::kinds::{PIN_QUANTITIES, PinExpansion, PinForces, PinSize, PinStrength, PinStrengthCtx};
use gudgeon_core::{BuildError, EvalError};
use gudgeon_numerics::jet::{Jet, Real};

/// What all models know of the pin's surroundings.
#[derive(Debug, Clone, Copy)]
pub struct Surroundings {
    pub boss_gap: f64,
    pub rod_width: f64,
    pub modulus: f64,
    pub poisson: f64,
    pub pi: f64,
    /// Distance of the pressure centres of the bosses as `offset + slope·L`.
    centres: (f64, f64),
}

impl Surroundings {
    pub fn new(ctx: &PinStrengthCtx) -> Result<Self, BuildError> {
        for (name, v) in [
            ("boss_gap", ctx.boss_gap),
            ("rod_width", ctx.rod_width),
            ("modulus", ctx.modulus),
            ("pi", ctx.pi),
        ] {
            if !(v.is_finite() && v > 0.0) {
                return Err(BuildError::at(name, format!("`{v}` must be a number greater than zero")));
            }
        }
        if !(ctx.poisson > -1.0 && ctx.poisson <= 0.5) {
            let what = format!("a Poisson's ratio of {} cannot be", ctx.poisson);
            return Err(BuildError::at("poisson", what).help("between -1 and 0.5; steel has 0.3"));
        }
        if ctx.rod_width > ctx.boss_gap {
            let what = format!(
                "the small end, {} mm wide, does not fit between bosses {} mm apart",
                1e3 * ctx.rod_width,
                1e3 * ctx.boss_gap
            );
            return Err(BuildError::at("rod_width", what));
        }
        Ok(Self {
            boss_gap: ctx.boss_gap,
            rod_width: ctx.rod_width,
            modulus: ctx.modulus,
            poisson: ctx.poisson,
            pi: ctx.pi,
            centres: ctx.boss_bore.centres(ctx.boss_gap),
        })
    }
}

/// A pin in its surroundings, under the force `total`.
pub struct Loaded<'a, T> {
    pub at: &'a Surroundings,
    pub length: T,
    pub outer: T,
    pub inner: T,
    /// `inner/outer`.
    pub rho: T,
    /// Distance of the pressure centres of the bosses.
    pub centres: T,
    pub total: f64,
}

impl<'a, T: Real> Loaded<'a, T> {
    #[inline(always)]
    fn new(at: &'a Surroundings, [length, outer, inner]: [T; 3], total: f64) -> Self {
        let (offset, slope) = at.centres;
        Self { at, length, outer, inner, rho: inner / outer, centres: length * slope + offset, total }
    }

    /// `J = π (d_o⁴ - d_i⁴)/64`.
    #[inline(always)]
    pub fn second_moment(&self) -> T {
        let (o2, i2) = (self.outer.squared(), self.inner.squared());
        (o2 + i2) * (o2 - i2) * (self.at.pi / 64.0)
    }

    /// `p = F/(d_o (L - D3))`.
    #[inline(always)]
    pub fn boss_pressure(&self) -> T {
        ((self.length - self.at.boss_gap) * self.outer).recip() * self.total
    }

    /// `p = F/(d_o B)`.
    #[inline(always)]
    pub fn rod_pressure(&self) -> T {
        self.outer.recip() * (self.total / self.at.rod_width)
    }

    /// `σ = γ F a/(4 Z)`, `γ = 1 - B/(2 a)`, `Z = 2 J/d_o`: the greatest moment `F a/4 - F B/8` over the section modulus.
    #[inline(always)]
    pub fn bending_stress(&self) -> T {
        let moment = (self.centres * 0.25 - self.at.rod_width / 8.0) * self.total;
        moment * self.outer / (self.second_moment() * 2.0)
    }

    /// `τ = c F (1 + ρ + ρ²)/(d_o² (1 - ρ⁴))`; `c = 8/(3π)` is exact for a force `F/2` through a thick tube.
    #[inline(always)]
    pub fn shear_stress(&self, c: f64) -> T {
        let r2 = self.rho.squared();
        (r2 + self.rho + 1.0) * (c * self.total) / (self.outer.squared() * (-r2.squared() + 1.0))
    }

    /// `f = γ a³ F/(48 E J)`: the deflection under a force in the middle, times the coefficient of the moment.
    #[inline(always)]
    pub fn deflection_by_coefficient(&self) -> T {
        let a = self.centres;
        // γ a³ = a² (a - B/2)
        a.squared() * (a - 0.5 * self.at.rod_width) * self.total
            / (self.second_moment() * (48.0 * self.at.modulus))
    }

    /// `f = F a³/(48 E J) (1 - b²/2 + b³/8)`, `b = B/a`: the Euler-Bernoulli beam under a force spread over B.
    #[inline(always)]
    pub fn deflection_of_beam(&self) -> T {
        let (a, w) = (self.centres, self.at.rod_width);
        let shape = a.cubed() - a * (0.5 * w * w) + w * w * w / 8.0;
        shape * self.total / (self.second_moment() * (48.0 * self.at.modulus))
    }

    /// `f = F (a/4 - B/8)/(κ A G)`, `κ` of a thick tube after `cowper1966`.
    #[inline(always)]
    pub fn deflection_by_shear(&self) -> T {
        let nu = self.at.poisson;
        let r2 = self.rho.squared();
        let s = (r2 + 1.0).squared();
        let kappa = s * (6.0 * (1.0 + nu)) / (s * (7.0 + 6.0 * nu) + r2 * (20.0 + 12.0 * nu));
        let area = (self.outer.squared() - self.inner.squared()) * (self.at.pi / 4.0);
        let shear_modulus = self.at.modulus / (2.0 * (1.0 + nu));
        (self.centres * 0.25 - self.at.rod_width / 8.0) * self.total / (kappa * area * shear_modulus)
    }

    /// `δ = F ((1 + ρ)/(1 - ρ))³/(8 E L)`: a thin ring under a pressure uniform over its projection.
    #[inline(always)]
    pub fn thin_ring_ovalisation(&self, force: f64) -> T {
        let c = ((self.rho + 1.0) / (-self.rho + 1.0)).cubed();
        c * (force / (8.0 * self.at.modulus)) / self.length
    }

    /// `σ = 0.75 F (d_o + d_i)/(L (d_o - d_i)²)`: moment `F r/8` of the thin ring.
    #[inline(always)]
    pub fn thin_ring_stress(&self) -> T {
        (self.outer + self.inner) * (0.75 * self.total) / (self.length * (self.outer - self.inner).squared())
    }

    /// `√(σ_b² + σ_o²)`.
    #[inline(always)]
    pub fn resultant(bending: T, ovalisation: T) -> T {
        (bending.squared() + ovalisation.squared()).sqrt()
    }
}

/// A model as formulas over numbers with or without derivatives.
pub trait Formula: Debug + Send + Sync {
    const NAME: &'static str;
    /// Minimum ratio of the inner to the outer diameter.
    const MIN_BORE_RATIO: f64 = 0.0;
    fn surroundings(&self) -> &Surroundings;
    fn quantities<T: Real>(&self, pin: &Loaded<'_, T>, gas: f64) -> [T; PIN_QUANTITIES];
}

/// A [`Formula`] as a model.
#[derive(Debug)]
pub struct Evaluated<F>(pub F);

impl<F: Formula> Evaluated<F> {
    fn check(&self, s: &PinSize, load: &PinForces) -> Result<(), EvalError> {
        let gap = self.0.surroundings().boss_gap;
        let inside = s.length > gap
            && s.inner >= F::MIN_BORE_RATIO * s.outer * (1.0 - 1e-12)
            && s.inner < s.outer
            && [s.length, s.outer, load.gas, load.inertia].iter().all(|v| v.is_finite());
        if inside {
            return Ok(());
        }
        Err(EvalError::recoverable(
            F::NAME,
            format!(
                "a pin of length {} m, outer diameter {} m and inner diameter {} m between bosses {gap} m apart under {} N is outside the theory",
                s.length,
                s.outer,
                s.inner,
                load.total()
            ),
        ))
    }

    fn finite(ok: bool) -> Result<(), EvalError> {
        if ok { Ok(()) } else { Err(EvalError::recoverable(F::NAME, "a wall too thin for a number")) }
    }
}

impl<F: Formula> PinStrength for Evaluated<F> {
    fn quantities(&self, s: &PinSize, load: &PinForces) -> Result<[f64; PIN_QUANTITIES], EvalError> {
        self.check(s, load)?;
        let pin = Loaded::new(self.0.surroundings(), [s.length, s.outer, s.inner], load.total().abs());
        let out = self.0.quantities(&pin, load.gas.abs());
        Self::finite(out.iter().fold(true, |ok, v| ok & v.is_finite()))?;
        Ok(out)
    }

    fn expansion(&self, s: &PinSize, load: &PinForces) -> Result<PinExpansion, EvalError> {
        self.check(s, load)?;
        let x = [Jet::variable(s.length, 0), Jet::variable(s.outer, 1), Jet::variable(s.inner, 2)];
        let pin = Loaded::new(self.0.surroundings(), x, load.total().abs());
        let jets = self.0.quantities(&pin, load.gas.abs());
        let all = |ok: bool, v: &f64| ok & v.is_finite();
        Self::finite(jets.iter().fold(true, |ok, j| j.h.iter().fold(all(ok, &j.v), all)))?;
        Ok(PinExpansion {
            value: jets.each_ref().map(|j| j.v),
            gradient: jets.each_ref().map(|j| j.g),
            hessian: jets.each_ref().map(|j| j.h),
        })
    }

    fn min_bore_ratio(&self) -> f64 {
        F::MIN_BORE_RATIO
    }
}
