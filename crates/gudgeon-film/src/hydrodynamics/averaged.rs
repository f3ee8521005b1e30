//! A film that knows one viscosity, with averages of shear thinning and of flow factors.

use std::sync::Arc;

use gudgeon_core::EvalError;
use gudgeon_core::geometry::FaceProfile;
use gudgeon_core::kinds::{FaceForces, FaceIn, FaceOut, Hydrodynamics, Rheology, ShearThinning};

use super::rough_nodes::RoughNodes;

/// A film whose pressures and whose shear each have one viscosity, of the wetted part of the face:
///
/// ```text
/// μ_p = S/S_0        t = W/(μ_p W_0)        S = ∫ r x (Y - Ȳ) dx        W = ∫ max(0, ±∫ r (h_c - h̄_c) dx') dx        r = μ(u/h_p)/(φ_x h_p³)
/// μ_s = ∫ μ(u/h_p) φ_f/h_p dx / ∫ dx/h        μ_a = ∫ μ(u/h_p) φ_fs/h_p dx / ∫ dx/h
/// f_d = G/(μ_p t G_0)        G = ∫ φ_fp h_p r (h_c - h̄_c) dx
/// ```
///
/// `S` is the load of a film that is squeezed and full, with `Y` of [`GriddedFace`](super::gridded_face::GriddedFace) and means weighted with `r`; `W` is that
/// of one that slides to the side of its sign, clipped, and `G` the drag of the gradient of its pressure. `S_0`, `W_0` and `G_0` are those of a smooth film of
/// unit viscosity at the same `h`, so squeeze and sliding alone press as they do with the values of every place: near contact the surfaces fill the gap, what
/// the liner carries along rises less than the face, and `t` is well below 1. The film slides at `t u` in place of `u`; its flux is mended by what then is
/// missing of `h̄_c`. `μ_s` is the mean by which sliding drags, `μ_a` what it adds to the drag of the liner and takes from that of the ring, `f_d` what becomes
/// of the drag of the gradient. Exact where factors do not change along the face.
pub(super) struct Averaged {
    film: Box<dyn Hydrodynamics>,
    thinning: Option<Arc<dyn ShearThinning>>,
    gap: RoughNodes,
    face: FaceProfile,
    extent: (f64, f64),
    tilt: f64,
    /// Lengths for which the places stand, and drops there.
    weights: [f64; PLACES],
    places: [f64; PLACES],
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
    /// `μ_a/μ`.
    apart: f64,
    /// `t`, above zero.
    wedge: f64,
    /// What the mean of `h_c` has over `t` times that of `h` \[m\].
    carried: f64,
}

impl Means {
    const SMOOTH: Self = Self { pressure: 1.0, shear: 1.0, drag: 1.0, apart: 0.0, wedge: 1.0, carried: 0.0 };
}

/// What a film is at a place, lengths over the film thickness at the narrowest one.
#[derive(Debug, Clone, Copy, Default)]
struct Place {
    /// `r` and `c/c(0)` times the length \[m\] for which the place stands.
    resist: f64,
    change: f64,
    /// `h_c`.
    carried: f64,
    /// `φ_fp h_p`.
    lever: f64,
}

/// `S`, `W`, `G` and the mean of `h_c` of a film, weighted with `r`.
#[derive(Debug, Clone, Copy)]
struct Pressed {
    squeezed: f64,
    /// Lobes above and below the pressure of the ends, for a liner that moves along `+x`.
    lobes: [f64; 2],
    dragged: f64,
    carried: f64,
    /// Mean of `φ_fp h_p`.
    lever: f64,
}

impl Pressed {
    /// `W/W_0` while the liner moves at `u` \[m/s\].
    fn slid(&self, smooth: &Self, u: f64) -> f64 {
        let carries = usize::from(u < 0.0);
        let far = DRAWN * smooth.lobes[1 - carries];
        (self.lobes[carries] + far) / (smooth.lobes[carries] + far)
    }
}

/// Places on either side of the narrowest one, closer to it with the fourth power of their number: a film of a tenth of a micrometre on a sharp taper is some
/// ten micrometres long.
const HALF: usize = 16;
const PLACES: usize = 2 * HALF;
const MODEL: &str = "averages of a film";
/// Part of the lobe that sliding draws down that counts as one that is the same with and without factors. A face that has no other is held by the pressures
/// of its edges far from the narrowest place, where factors end.
const DRAWN: f64 = 1e-3;
/// What counts as nothing beside 1 where it would be divided by.
const FLAT: f64 = 1e-12;

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
            places: [0.0; PLACES],
            drops: [0.0; PLACES],
            rate: [0.0; PLACES],
            thin: [1.0; PLACES],
            slope: [0.0; PLACES],
            at: (f64::NAN, f64::NAN),
            means: Means::SMOOTH,
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
                let x = middle + s * s * s * s * (end - middle);
                // From the lower end to the upper one.
                let i = if side == 0 { HALF - 1 - k } else { HALF + k };
                self.weights[i] = 4.0 * s * s * s * (end - middle).abs() / HALF as f64;
                self.places[i] = x;
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
        let (mut of, mut over) = ([0.0; 2], 0.0);
        let (mut smooth, mut rough) = ([Place::default(); PLACES], [Place::default(); PLACES]);
        for i in 0..PLACES {
            // In the film thickness: its cube has no number where surfaces overlap deeply.
            let (gap, held) = (1.0 + self.drops[i] / inp.h, flow.film[i] / inp.h);
            let (w, swell) = (self.weights[i] / gap, gap / held);
            let film = self.weights[i] / (gap * gap * gap);
            smooth[i] = Place { resist: film, carried: gap, change: self.weights[i], lever: gap };
            rough[i] = Place {
                resist: film * self.thin[i] / flow.phi_x[i] * swell * swell * swell,
                carried: flow.transport[i] / inp.h,
                change: self.weights[i] * self.gap.change[i],
                lever: shear.phi_fp[i] * held,
            };
            of[0] += w * self.thin[i] * shear.phi_f[i] * swell;
            of[1] += w * self.thin[i] * shear.phi_fs[i] * swell;
            over += w;
        }
        let (smooth, rough) = (self.pressed(&smooth), self.pressed(&rough));
        let pressure = rough.squeezed / smooth.squeezed;
        if !(pressure > 0.0 && pressure.is_finite()) {
            return Err(EvalError::recoverable(
                MODEL,
                format!("a film of {} m has no mean viscosity", inp.h),
            ));
        }
        // A flat face has no wedge: what is left of sliding is the drag, which is told over that of the film.
        let flat = smooth.lobes[0] + smooth.lobes[1] <= FLAT;
        let wedge = if flat { 1.0 } else { (rough.slid(&smooth, inp.u) / pressure).max(FLAT) };
        let drag = if flat {
            rough.lever / smooth.lever
        } else {
            rough.dragged / (smooth.dragged * pressure * wedge)
        };
        self.means = Means {
            pressure,
            shear: of[0] / over,
            drag,
            apart: of[1] / over,
            wedge,
            carried: inp.h * (rough.carried - wedge * smooth.carried),
        };
        self.at = (inp.h, inp.u);
        Ok(self.means)
    }

    /// What squeeze and sliding do to a film without pressures at its ends, up to factors that all films of this face have in common.
    fn pressed(&self, places: &[Place; PLACES]) -> Pressed {
        let (mut sum, mut carried, mut lever, mut swept, mut way) = (0.0, 0.0, 0.0, 0.0, 0.0);
        let mut ways = [0.0; PLACES];
        for (p, y) in places.iter().zip(&mut ways) {
            *y = way + 0.5 * p.change;
            way += p.change;
            sum += p.resist;
            carried += p.resist * p.carried;
            lever += p.resist * p.lever;
            swept += p.resist * *y;
        }
        let (carried, swept) = (carried / sum, swept / sum);
        let length = (self.extent.1 - self.extent.0).max(f64::MIN_POSITIVE);
        let (mut squeezed, mut lobes, mut dragged, mut pressure) = (0.0, [0.0; 2], 0.0, 0.0);
        for (i, p) in places.iter().enumerate() {
            squeezed += p.resist * (self.places[i] - self.extent.0) / length * (ways[i] - swept) / length;
            let rise = p.resist * (p.carried - carried);
            let middle = self.weights[i] / length * (pressure + 0.5 * rise) / length;
            lobes[usize::from(middle < 0.0)] += middle.abs();
            dragged += p.lever * rise;
            pressure += rise;
        }
        Pressed { squeezed, lobes, dragged, carried, lever: lever / sum }
    }

    /// The same instant with the viscosity of the pressures.
    fn entered(&mut self, inp: &FaceIn) -> Result<(FaceIn, Means), EvalError> {
        let means = self.means(inp)?;
        Ok((FaceIn { mu: inp.mu * means.pressure, u: inp.u * means.wedge, ..*inp }, means))
    }
}

impl Means {
    /// Drag on ring and liner, from those of a film with the viscosity of the pressures.
    fn drags(&self, ring: f64, liner: f64) -> (f64, f64) {
        let sliding = 0.5 * (liner + ring) / (self.pressure * self.wedge);
        let gradient = 0.5 * (liner - ring) * self.drag;
        (sliding * (self.shear - self.apart) - gradient, sliding * (self.shear + self.apart) + gradient)
    }

    /// Forces and flux, from those of that film, while the liner moves at `u` \[m/s\].
    fn forces(&self, mut o: FaceForces, u: f64) -> FaceForces {
        (o.ring_shear, o.liner_shear) = self.drags(o.ring_shear, o.liner_shear);
        o.flux += 0.5 * u * self.carried;
        o
    }
}

impl Hydrodynamics for Averaged {
    fn evaluate(&mut self, inp: &FaceIn, hdot: f64) -> Result<FaceOut, EvalError> {
        let (entered, means) = self.entered(inp)?;
        let mut o = self.film.evaluate(&entered, hdot)?;
        (o.ring_shear, o.liner_shear) = means.drags(o.ring_shear, o.liner_shear);
        o.flux += 0.5 * inp.u * means.carried;
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
        let (entered, means) = self.entered(inp)?;
        Ok(means.forces(self.film.forces(&entered, hdot)?, inp.u))
    }
    fn load(&mut self, inp: &FaceIn, hdot: f64) -> Result<(f64, f64), EvalError> {
        let (inp, _) = self.entered(inp)?;
        self.film.load(&inp, hdot)
    }
    fn carry(&mut self, inp: &FaceIn, load: f64) -> Result<(f64, FaceForces), EvalError> {
        let (entered, means) = self.entered(inp)?;
        let (hdot, forces) = self.film.carry(&entered, load)?;
        Ok((hdot, means.forces(forces, inp.u)))
    }
    fn profile(&mut self, inp: &FaceIn, hdot: f64, out: &mut [(f64, f64, f64)]) -> Result<(), EvalError> {
        let (inp, _) = self.entered(inp)?;
        self.film.profile(&inp, hdot, out)
    }
}
