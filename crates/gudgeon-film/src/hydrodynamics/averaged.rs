//! A film that knows one viscosity, with averages of shear thinning and of flow factors.

use std::sync::Arc;

use gudgeon_core::EvalError;
use gudgeon_core::geometry::FaceProfile;
use gudgeon_core::kinds::{FaceForces, FaceIn, FaceOut, Hydrodynamics, Rheology, ShearThinning};

use super::rough_nodes::RoughNodes;

/// A film whose pressures and whose shear each have one viscosity, the averages over the wetted part of the face:
///
/// ```text
/// μ_p = ∫ μ(u/h_p) h²/(φ_x h_p³) dx / ∫ dx/h        μ_s = ∫ μ(u/h_p) φ_f/h_p dx / ∫ dx/h        f_d = ∫ φ_fp h_p/h³ dx / ∫ dx/h²
/// ```
///
/// `μ_p` is the mean by which the film resists a flow that pressure drives, `μ_s` the mean by which sliding drags, `f_d` that of the drag of the pressure
/// gradient. Exact where factors do not change along the face; the weight of `μ_p` is the one of 1/h, 1/h² and 1/h³ with which loads came closest to those
/// of `gridded_face`. The flow that rough surfaces carry unequally (`φ_s`, `φ_fs`) and the change of the film content with the separation are left out.
pub(super) struct Averaged {
    film: Box<dyn Hydrodynamics>,
    thinning: Option<Arc<dyn ShearThinning>>,
    gap: RoughNodes,
    face: FaceProfile,
    extent: (f64, f64),
    tilt: f64,
    /// Lengths for which the places stand, and drops there.
    weights: [f64; PLACES],
    drops: [f64; PLACES],
    rate: [f64; PLACES],
    thin: [f64; PLACES],
    slope: [f64; PLACES],
    /// Film thickness and velocity of the averages, and they.
    at: (f64, f64),
    means: Means,
}

/// Averages over those of a smooth film of constant viscosity.
#[derive(Debug, Clone, Copy)]
struct Means {
    /// `μ_p/μ`.
    pressure: f64,
    /// `μ_s/μ`.
    shear: f64,
    /// `f_d`.
    drag: f64,
}

/// Places on either side of the narrowest one, closer to it with the square of their number.
const HALF: usize = 16;
const PLACES: usize = 2 * HALF;
const MODEL: &str = "averages of a film";

impl Averaged {
    pub(super) fn new(film: Box<dyn Hydrodynamics>, face: &FaceProfile, rheology: &Rheology) -> Self {
        let mut new = Self {
            film,
            thinning: rheology.shear_thinning.clone(),
            gap: RoughNodes::new(rheology.roughness.clone(), PLACES),
            extent: (0.0, face.length()),
            face: face.clone(),
            tilt: 0.0,
            weights: [0.0; PLACES],
            drops: [0.0; PLACES],
            rate: [0.0; PLACES],
            thin: [1.0; PLACES],
            slope: [0.0; PLACES],
            at: (f64::NAN, f64::NAN),
            means: Means { pressure: 1.0, shear: 1.0, drag: 1.0 },
        };
        new.lay_out();
        new
    }

    /// The narrowest place of the tilted face, and what its drop is above that of the face upright.
    fn narrowest(&self) -> (f64, f64) {
        let upright = self.face.narrowest();
        if self.tilt == 0.0 {
            return (upright, 0.0);
        }
        let (length, drop) = (self.face.length(), |x: f64| self.face.drop_at(x) - self.tilt * x);
        if let FaceProfile::Parabola { curvature, apex, .. } = self.face {
            let x = (apex + 0.5 * self.tilt / curvature).clamp(0.0, length);
            return (x, drop(x));
        }
        let corners = (0..=PLACES).map(|k| length * k as f64 / PLACES as f64).chain([upright]);
        corners.map(|x| (x, drop(x))).fold((upright, drop(upright)), |a, b| if b.1 < a.1 { b } else { a })
    }

    /// Places on the wetted part of the face.
    fn lay_out(&mut self) {
        let (narrowest, lowest) = self.narrowest();
        let (from, to) = self.extent;
        let middle = narrowest.clamp(from, to);
        for (side, end) in [from, to].into_iter().enumerate() {
            for k in 0..HALF {
                let s = (k as f64 + 0.5) / HALF as f64;
                let x = middle + s * s * (end - middle);
                let i = side * HALF + k;
                self.weights[i] = 2.0 * s * (end - middle).abs() / HALF as f64;
                self.drops[i] = (self.face.drop_at(x) - self.tilt * x - lowest).max(0.0);
            }
        }
        self.at = (f64::NAN, f64::NAN);
    }

    /// Averages for a film thickness and a velocity.
    fn means(&mut self, inp: &FaceIn) -> Result<Means, EvalError> {
        if self.at == (inp.h, inp.u) {
            return Ok(self.means);
        }
        if !(inp.h > 0.0 && (inp.h + inp.u).is_finite()) {
            return Err(EvalError::recoverable(MODEL, format!("a film of {} m at {} m/s", inp.h, inp.u)));
        }
        self.gap.place(inp.h, &self.drops)?;
        let (flow, shear) = (&self.gap.flow, &self.gap.shear);
        if let Some(law) = &self.thinning {
            for (rate, film) in self.rate.iter_mut().zip(&flow.film) {
                *rate = inp.u / film;
            }
            law.factor(&self.rate, &mut self.thin, &mut self.slope)?;
        }
        let (mut of, mut over) = ([0.0; 3], [0.0; 2]);
        for i in 0..PLACES {
            // In the film thickness: its cube has no number where surfaces overlap deeply.
            let (gap, held) = (1.0 + self.drops[i] / inp.h, flow.film[i] / inp.h);
            let (w, swell) = (self.weights[i] / gap, gap / held);
            of[0] += w * self.thin[i] / flow.phi_x[i] * swell * swell * swell;
            of[1] += w * self.thin[i] * shear.phi_f[i] * swell;
            of[2] += w / gap * shear.phi_fp[i] / swell;
            over[0] += w;
            over[1] += w / gap;
        }
        self.means = Means { pressure: of[0] / over[0], shear: of[1] / over[0], drag: of[2] / over[1] };
        self.at = (inp.h, inp.u);
        Ok(self.means)
    }

    /// The same instant with the viscosity of the pressures.
    fn entered(&mut self, inp: &FaceIn) -> Result<(FaceIn, Means), EvalError> {
        let means = self.means(inp)?;
        Ok((FaceIn { mu: inp.mu * means.pressure, ..*inp }, means))
    }
}

impl Means {
    /// Drag on ring and liner, from those of a film with the viscosity of the pressures.
    fn drags(&self, ring: f64, liner: f64) -> (f64, f64) {
        let sliding = 0.5 * (liner + ring) * self.shear / self.pressure;
        let gradient = 0.5 * (liner - ring) * self.drag;
        (sliding - gradient, sliding + gradient)
    }

    fn forces(&self, mut o: FaceForces) -> FaceForces {
        (o.ring_shear, o.liner_shear) = self.drags(o.ring_shear, o.liner_shear);
        o
    }
}

impl Hydrodynamics for Averaged {
    fn evaluate(&mut self, inp: &FaceIn, hdot: f64) -> Result<FaceOut, EvalError> {
        let (inp, means) = self.entered(inp)?;
        let mut o = self.film.evaluate(&inp, hdot)?;
        (o.ring_shear, o.liner_shear) = means.drags(o.ring_shear, o.liner_shear);
        Ok(o)
    }
    fn squeeze_rate(&mut self, inp: &FaceIn, load: f64) -> Result<f64, EvalError> {
        let (inp, _) = self.entered(inp)?;
        self.film.squeeze_rate(&inp, load)
    }
    fn resists(&self) -> bool {
        self.film.resists()
    }
    fn set_extent(&mut self, from: f64, to: f64) -> bool {
        let can = self.film.set_extent(from, to);
        if can && self.extent != (from, to) {
            self.extent = (from, to);
            self.lay_out();
        }
        can
    }
    fn set_tilt(&mut self, tilt: f64) -> bool {
        let can = self.film.set_tilt(tilt);
        if can && self.tilt != tilt {
            self.tilt = tilt;
            self.lay_out();
        }
        can
    }
    fn forces(&mut self, inp: &FaceIn, hdot: f64) -> Result<FaceForces, EvalError> {
        let (inp, means) = self.entered(inp)?;
        Ok(means.forces(self.film.forces(&inp, hdot)?))
    }
    fn load(&mut self, inp: &FaceIn, hdot: f64) -> Result<(f64, f64), EvalError> {
        let (inp, _) = self.entered(inp)?;
        self.film.load(&inp, hdot)
    }
    fn carry(&mut self, inp: &FaceIn, load: f64) -> Result<(f64, FaceForces), EvalError> {
        let (inp, means) = self.entered(inp)?;
        let (hdot, forces) = self.film.carry(&inp, load)?;
        Ok((hdot, means.forces(forces)))
    }
    fn profile(&mut self, inp: &FaceIn, hdot: f64, out: &mut [(f64, f64, f64)]) -> Result<(), EvalError> {
        let (inp, _) = self.entered(inp)?;
        self.film.profile(&inp, hdot, out)
    }
}
