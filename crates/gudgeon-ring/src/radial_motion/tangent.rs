//! How the balance of a ring and its film change with its velocity: what small changes of the instant are followed along.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::{FaceForces, Limited, RadialLoads, RadialResponse};

use super::search::Search;

/// Part of its load over which the derivatives of a film by its velocity are taken: the square root of the accuracy that films are found with.
const FILM_DIFFERENCE: f64 = 1e-6;

/// Derivatives about the velocity of an instant.
#[derive(Debug, Clone, Copy, Default)]
pub struct Tangent {
    /// Balance left at that velocity \[N/m\]; searches end near zero, not there.
    left: f64,
    /// Its derivative \[N s/m²\], below zero.
    derivative: f64,
    /// Derivatives of the film.
    film: FaceForces,
    /// Derivatives of the fluxes.
    flux: [f64; 2],
}

impl Tangent {
    /// The derivatives at `hdot`, where the film is `film`; `None` where they are of no use.
    pub fn new(
        search: &Search<'_>,
        loads: &mut dyn RadialLoads,
        hdot: f64,
        film: &FaceForces,
    ) -> Result<Option<Self>, EvalError> {
        let pull = film.load.abs() / film.squeeze_damping;
        if !(pull > 0.0 && pull.is_finite()) {
            return Ok(None);
        }
        let d = (FILM_DIFFERENCE * pull).max(FILM_DIFFERENCE * hdot.abs());
        let fluxes = *loads.flux();
        let moved = loads.film(hdot + d)?;
        let change = between(film, &moved, d);
        let flux = [0, 1].map(|k: usize| (loads.flux()[k] - fluxes[k]) / d);
        let (left, rest) = left_over(search, loads, hdot, film.load);
        let all = change.load + rest;
        Ok((all < 0.0 && all.is_finite()).then_some(Self { left, derivative: all, film: change, flux }))
    }

    /// The balance after a small change, by one step of Newton's method from the velocity `hdot` before: one evaluation of the film.
    pub fn follow(
        &self,
        search: &Search<'_>,
        loads: &mut dyn RadialLoads,
        hdot: f64,
    ) -> Result<RadialResponse, EvalError> {
        let film = loads.film(hdot)?;
        let (left, _) = left_over(search, loads, hdot, film.load);
        let change = (self.left - left) / self.derivative;
        for (flux, derivative) in loads.flux().iter_mut().zip(&self.flux) {
            *flux += derivative * change;
        }
        Ok(RadialResponse::new(hdot + change, Some(self.moved(&film, change)), Limited::default()))
    }

    /// The film `f` after a change of velocity.
    fn moved(&self, f: &FaceForces, change: f64) -> FaceForces {
        let t = &self.film;
        FaceForces {
            load: f.load + t.load * change,
            squeeze_damping: f.squeeze_damping + t.squeeze_damping * change,
            ring_shear: f.ring_shear + t.ring_shear * change,
            liner_shear: f.liner_shear + t.liner_shear * change,
            slope_force: f.slope_force + t.slope_force * change,
            flux: f.flux + t.flux * change,
        }
    }
}

/// Balance of film, contact, friction and the drag of surfaces that part at `hdot`, and its derivative but for that of the film.
fn left_over(search: &Search<'_>, loads: &dyn RadialLoads, hdot: f64, film: f64) -> (f64, f64) {
    let at = loads.state();
    let drag = if hdot > 0.0 { search.contact_drag(at) } else { 0.0 };
    let (fa, dfa) = loads.friction(hdot);
    let w = at.load - at.contact - at.dry + fa + drag * hdot;
    let floor = search.limits.min_load * at.tension;
    let root = (w * w + 4.0 * floor * floor).sqrt();
    (film - 0.5 * (w + root), -(dfa + drag) * 0.5 * (1.0 + w / root))
}

fn between(a: &FaceForces, b: &FaceForces, d: f64) -> FaceForces {
    FaceForces {
        load: (b.load - a.load) / d,
        squeeze_damping: (b.squeeze_damping - a.squeeze_damping) / d,
        ring_shear: (b.ring_shear - a.ring_shear) / d,
        liner_shear: (b.liner_shear - a.liner_shear) / d,
        slope_force: (b.slope_force - a.slope_force) / d,
        flux: (b.flux - a.flux) / d,
    }
}
