//! Where a search starts.

use gudgeon_core::kinds::{PinQuantity, PinSize};

use crate::design::Design;

/// Outer diameters that are tried.
const TRIALS: usize = 6;

/// A pin that keeps every limit, near the lightest one, from some outer diameters with the length that the boss pressure wants.
pub fn feasible(d: &Design<'_>) -> Option<PinSize> {
    let trials = if d.outer.is_fixed() { 1 } else { TRIALS };
    let mut best: Option<(f64, PinSize)> = None;
    for t in 0..trials {
        let outer = d.outer.low + (d.outer.high - d.outer.low) * (t as f64 + 0.5) / TRIALS as f64;
        let Some(size) = at_outer(d, outer, best.map(|(m, _)| m)) else { continue };
        let m = d.masses(&size).differential();
        if best.is_none_or(|(b, _)| m < b) {
            best = Some((m, size));
        }
    }
    best.map(|(_, size)| size).or_else(|| among_few(d))
}

/// A pin of an outer diameter, as short as the boss pressure admits; none where it cannot be lighter than one that is known.
fn at_outer(d: &Design<'_>, outer: f64, known: Option<f64>) -> Option<PinSize> {
    let at = PinSize { length: d.length.high, outer, inner: d.min_inner(outer) };
    let u = d.utilisation(&at).ok()?;
    // The pressure falls with the loaded length.
    let play = d.tolerance.length;
    let loaded = (d.length.high - play - d.boss_gap) * u[PinQuantity::BossPressure as usize];
    let short = (d.boss_gap + play + loaded).clamp(d.length.low, d.length.high);
    [1.0 + 1e-9, 1.03, 1.1].into_iter().find_map(|stretch| {
        let length = (short * stretch).min(d.length.high);
        // A lighter pin has a larger bore than this, which every limit would have to admit.
        let lighter = known.map_or(0.0, |m| bore_of(d, length, outer, m));
        let kept = |inner| {
            d.utilisation(&PinSize { length, outer, inner }).is_ok_and(|u| u.iter().all(|u| *u <= 1.0))
        };
        if lighter >= d.min_inner(outer) && !kept(lighter) {
            return None;
        }
        let inner = d.max_feasible_inner_over(length, length, outer, 2e-2)?;
        Some(PinSize { length, outer, inner })
    })
}

/// The bore with which a pin of some length and outer diameter weighs `mass`, the relief subtracted; zero where a solid one is lighter.
fn bore_of(d: &Design<'_>, length: f64, outer: f64, mass: f64) -> f64 {
    let solid = d.masses(&PinSize { length, outer, inner: 0.0 });
    let part = (mass + solid.relieved) / solid.pin;
    outer * (1.0 - part).max(0.0).sqrt()
}

/// Where the feasible diameters are few: from the smallest of them.
fn among_few(d: &Design<'_>) -> Option<PinSize> {
    let outer = d.min_feasible_outer()?;
    let outer = (outer + 1e-3 * (d.outer.high - outer)).min(d.outer.high);
    let length = 0.5 * (d.length.low + d.length.high);
    Some(PinSize { length, outer, inner: d.min_inner(outer) })
}
