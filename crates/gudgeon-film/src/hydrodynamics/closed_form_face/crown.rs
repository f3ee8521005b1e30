//! The ruptured film of a crowned face in its natural coordinate: the quick way when the search starts near its end.
//!
//! With `ℓ = √(h/κ)` and `t = (x - apex)/ℓ` the film is `h (1 + t²)`, and every integral over a stretch from `t1` to `t2` follows from
//! `r = 1/(1 + t²)` at both ends and the angle `φ` between them, `tan φ = (t2 - t1)/(1 + t1 t2)`:
//!
//! ```text
//! P1 = ∫ dt/D = φ      P2 = ∫ dt/D² = (φ + Δ(t r))/2      P3 = ∫ dt/D³ = 3 P2/4 + Δ(t r²)/4      D = 1 + t²
//! M2 = ∫ t dt/D² = -Δr/2      M3 = ∫ t dt/D³ = -Δ(r²)/4      X = ∫ t² dt/D³ = P2 - P3      E = ∫ t³ dt/D³ = M2 - M3
//! ```
//!
//! all differences written as `t2 - t1` times something. Pressure over `12 μ`, from the edge `a` on: `p = p_a + α X + β M3 - γ P3` with
//! `α = U ℓ/h²`, `β = ḣ ℓ²/h³` and the flux `γ`. What still loses digits, a face nearly flat at its film and a film of nearly no
//! length, is left to the general way ([`super::parabola::Parabola`]).

use super::moments::Moments;
use super::stretch::{End, Stretch, Sums};

/// Least lever of the rupture, `t P3 - M3`, beside its parts: of a film much shorter than its distance from the apex, differences of
/// differences decide.
const LEVER: f64 = 0.05;

/// Step beside what it is a step of, after which one of fourth or of second order has left only rounding.
const FOURTH: f64 = 1e-4;

const SECOND: f64 = 1e-8;

/// Steps before the search is left to the general way.
const STEPS: usize = 6;

/// A crowned face under one film.
#[derive(Debug, Clone, Copy, Default)]
pub struct Crown {
    apex: f64,
    h: f64,
    /// `1/h`
    ih: f64,
    /// `ℓ` and `1/ℓ`
    l: f64,
    il: f64,
    a: End,
    b: End,
}

/// What is asked: half the sliding velocity, the edges' pressures over `12 μ`, and whether a film at the trailing edge is looked for.
#[derive(Debug, Clone, Copy)]
pub struct Asked {
    pub u: f64,
    pub pa: f64,
    pub pb: f64,
    pub trailing: bool,
}

/// A ruptured film, as the quick searches want it: `s` counts from the apex, the flux constant is `q - ḣ s + U h`.
#[derive(Debug, Clone, Copy)]
pub struct Crowned {
    pub v: f64,
    pub x: f64,
    pub q: f64,
    /// How `q` changes with `v`.
    pub w: f64,
    pub lead: Moments,
    /// Beginning and integrals of the film at the trailing edge.
    pub front: Option<(f64, Moments)>,
}

impl Crown {
    /// The face from 0 to `len` with the curvature `1/ik > 0`.
    #[inline]
    pub fn new(len: f64, apex: f64, curvature: f64, ik: f64, h: f64) -> Self {
        let ih = 1.0 / h;
        let il = (curvature * ih).sqrt();
        let edge = |x: f64, side| {
            let t = (x - apex) * il;
            End { t, r: 1.0 / (1.0 + t * t), side }
        };
        Self { apex, h, ih, l: h * il * ik, il, a: edge(0.0, 1.0), b: edge(len, -1.0) }
    }

    #[inline(always)]
    fn stretch(&self, end: End, x: f64) -> Stretch {
        Stretch::new(end, (x - self.apex) * self.il)
    }

    #[inline(always)]
    fn moments(&self, d: &Sums) -> Moments {
        let (i1, l2) = (self.l * self.ih, self.l * self.l * self.ih * self.ih);
        let i2 = i1 * self.ih;
        let x3 = l2 * self.ih;
        Moments {
            i1: i1 * d.p1,
            i2: i2 * d.p2,
            i3: i2 * self.ih * d.p3,
            x2: l2 * d.m2,
            x3: x3 * d.m3,
            xx3: x3 * self.l * d.x,
            d2: i2 * d.x,
            e2: l2 * d.e,
        }
    }

    /// The film at the squeeze velocity `v`, from a rupture near `xr` and a reformation near `xf`. `None` where the general way has to
    /// find out.
    #[inline(always)]
    pub fn at_rate(&self, f: &Asked, v: f64, xr: f64, xf: f64) -> Option<Crowned> {
        let alpha = f.u * self.l * self.ih * self.ih;
        let beta = v * self.l * self.l * self.ih * self.ih * self.ih;
        let (mut lead, mut trail) = self.starts(f, xr, xf)?;
        // Beside the search, not after it: what the film would rise by if it went on to the edge.
        let on = self.rest(f, &lead).map(|s| (lead.t, s));
        lead = self.rupture_at_rate(f, alpha, beta, lead)?;
        let gamma = lead.t * (alpha * lead.t + beta);
        if let Some(trail) = &mut trail {
            *trail = self.front_at_rate(f, (alpha, beta, gamma), lead.t, *trail)?;
        }
        if let Some((from, s)) = on {
            let rise = alpha * s.x + beta * s.m3 - gamma * s.p3;
            // From where the gradient vanishes the pressure has risen or fallen in second order.
            let d = lead.t - from;
            let steep = 2.0 * alpha * lead.t.abs().max(from.abs()) + beta.abs();
            if rise - steep * d * d < f.pb && !self.ruptures(f, alpha, beta, &lead) {
                return None;
            }
        }
        self.crowned(f, v, alpha, beta, &lead, trail.as_ref())
    }

    /// Moves the end of the film at the leading edge to where pressure and gradient vanish: `dp = -(2 α t + β) P3 dt` along the places
    /// without gradient.
    #[inline(always)]
    fn rupture_at_rate(&self, f: &Asked, alpha: f64, beta: f64, mut lead: Stretch) -> Option<Stretch> {
        for _ in 0..STEPS {
            let (t, r, s) = (lead.t, lead.r, lead.sums());
            let rising = 2.0 * alpha * t + beta;
            if !(rising > 0.0 && s.sound() && t * s.p3 - s.m3 > LEVER * s.p3.max(s.m3.abs())) {
                return None;
            }
            let gamma = t * (alpha * t + beta);
            let p = f.pa + alpha * s.x + beta * s.m3 - gamma * s.p3;
            let i = 1.0 / (rising * s.p3);
            let ir3 = i * (r * r * r);
            let (newton, a2) = (p * i, alpha * s.p3 * i + 0.5 * rising * ir3);
            let a3 = ir3 * (2.0 / 3.0 * alpha - rising * t * r);
            let step = fourth(newton, a2, a3);
            let size = newton.abs() * (1.0 + a2.abs());
            if size.is_nan() || size > 0.3 {
                return None;
            }
            lead = lead.moved(step);
            if !(lead.t > self.a.t && lead.t < self.b.t) {
                return None;
            }
            if size <= FOURTH {
                return Some(lead);
            }
        }
        None
    }

    /// Moves the beginning of the film at the trailing edge to where its pressure vanishes, behind the rupture at `from`.
    #[inline(always)]
    fn front_at_rate(
        &self,
        f: &Asked,
        (alpha, beta, gamma): (f64, f64, f64),
        from: f64,
        mut trail: Stretch,
    ) -> Option<Stretch> {
        for _ in 0..STEPS {
            let (t, r, s) = (trail.t, trail.r, trail.sums());
            let rising = 2.0 * alpha * t + beta;
            // Pressure gradient, over `r³`, and what of it follows the place.
            let n = t * (alpha * t + beta) - gamma;
            let p = f.pb - (alpha * s.x + beta * s.m3 - gamma * s.p3);
            if !(n > 0.0 && s.sound()) {
                return None;
            }
            let (i, tr) = (1.0 / n, 6.0 * t * r);
            let bend = rising - tr * n;
            let newton = -p * i / (r * r * r);
            let a2 = 0.5 * i * bend;
            let a3 = i / 6.0 * (2.0 * alpha - 6.0 * r * n + 2.0 * t * r * tr * n - tr * (rising + bend));
            let step = fourth(newton, a2, a3);
            let size = newton.abs() * (1.0 + a2.abs()).max(1.0 / (self.b.t - t));
            if size.is_nan() || size > 0.3 {
                return None;
            }
            trail = trail.moved(step);
            if !(trail.t > from && trail.t < self.b.t) {
                return None;
            }
            if size <= FOURTH {
                return Some(trail);
            }
        }
        None
    }

    /// The film that carries `load` (over `12 μ`), from a rupture near `xr` and a reformation near `xf`. `None` as in
    /// [`Self::at_rate`].
    ///
    /// The squeeze velocity follows from the place of the rupture, `β = (p_a + α (X - t² P3))/(t P3 - M3)`, so that Newton's method has one
    /// unknown, and a second one follows it: the front, on whose place the load depends in second order only.
    #[inline(always)]
    pub fn under_load(&self, f: &Asked, load: f64, xr: f64, xf: f64) -> Option<Crowned> {
        let alpha = f.u * self.l * self.ih * self.ih;
        let edges = if f.trailing { self.b.t * f.pb } else { 0.0 } - self.a.t * f.pa - load * self.il;
        let (mut lead, mut trail) = self.starts(f, xr, xf)?;
        for _ in 0..STEPS {
            let (t, s) = (lead.t, lead.sums());
            let arm = t * s.p3 - s.m3;
            if !(s.sound() && arm > LEVER * s.p3.max(s.m3.abs())) {
                return None;
            }
            let i = 1.0 / (arm * s.p3);
            let (i_arm, i_p3) = (i * s.p3, i * arm);
            let beta = (f.pa + alpha * (s.x - t * t * s.p3)) * i_arm;
            let rising = 2.0 * alpha * t + beta;
            if rising.is_nan() || rising <= 0.0 {
                return None;
            }
            let gamma = t * (alpha * t + beta);
            // Flux and velocity of a film without pressure at its end.
            let w = s.m3 * i_p3;
            let mut g = edges - (alpha * s.e + beta * s.x - gamma * s.m3);
            let mut g_beta = w * s.m3 - s.x;
            let mut follow = None;
            if let Some(trail) = &trail {
                let (t, r, s) = (trail.t, trail.r, trail.sums());
                let n = t * (alpha * t + beta) - gamma;
                if !(n > 0.0 && s.sound()) {
                    return None;
                }
                let p = f.pb - (alpha * s.x + beta * s.m3 - gamma * s.p3);
                let i_gradient = 1.0 / (n * (r * r * r));
                let p_beta = w * s.p3 - s.m3;
                g += 0.5 * p * p * i_gradient - t * p - (alpha * s.e + beta * s.x - gamma * s.m3);
                g_beta += w * s.m3 - s.x - t * p_beta;
                follow = Some((p, p_beta, i_gradient));
            }
            // β changes with the place of the rupture by -(2 α t + β) P3/arm.
            let d_beta = -g / g_beta;
            let step = -d_beta * arm * i_p3 / rising;
            let mut size = step.abs();
            lead = lead.moved(step);
            let mut upper = self.b.t;
            if let (Some((p, p_beta, i_gradient)), Some(trail)) = (follow, &mut trail) {
                let step = -(p + p_beta * d_beta) * i_gradient;
                size = size.max(step.abs() / (self.b.t - trail.t).min(1.0));
                *trail = trail.moved(step);
                if trail.t >= upper {
                    return None;
                }
                upper = trail.t;
            }
            if !(size < 0.3 && lead.t > self.a.t && lead.t < upper) {
                return None;
            }
            if size <= SECOND {
                let (t, s) = (lead.t, lead.sums());
                let beta = (f.pa + alpha * (s.x - t * t * s.p3)) / (t * s.p3 - s.m3);
                let v = beta * self.il * self.il * (self.h * self.h * self.h);
                if trail.is_none() && f.pb > 0.0 && !self.ruptures(f, alpha, beta, &lead) {
                    return None;
                }
                return self.crowned(f, v, alpha, beta, &lead, trail.as_ref());
            }
        }
        None
    }

    /// The stretch behind the lead, when the edge has pressure but no film of its own.
    #[inline(always)]
    fn rest(&self, f: &Asked, lead: &Stretch) -> Option<Sums> {
        (!f.trailing && f.pb > 0.0).then(|| Stretch::new(self.b, lead.t).sums())
    }

    /// Whether the film that ends at `lead` would, going on, need more than the pressure there is at the edge: whether it ruptures.
    fn ruptures(&self, f: &Asked, alpha: f64, beta: f64, lead: &Stretch) -> bool {
        let (t, s) = (lead.t, Stretch::new(self.b, lead.t).sums());
        alpha * s.x + beta * s.m3 - t * (alpha * t + beta) * s.p3 >= f.pb
    }

    /// The films that a search begins with.
    #[inline(always)]
    fn starts(&self, f: &Asked, xr: f64, xf: f64) -> Option<(Stretch, Option<Stretch>)> {
        if !(xr > 0.0 && xr < xf) {
            return None;
        }
        Some((self.stretch(self.a, xr), f.trailing.then(|| self.stretch(self.b, xf))))
    }

    #[inline(always)]
    fn crowned(
        &self,
        f: &Asked,
        v: f64,
        alpha: f64,
        beta: f64,
        lead: &Stretch,
        trail: Option<&Stretch>,
    ) -> Option<Crowned> {
        let t = lead.t;
        let gamma = t * (alpha * t + beta);
        let q = gamma * self.il * (self.h * self.h * self.h);
        let front = match trail {
            Some(trail) => {
                // A cavity that runs dry on its way is left to the general way.
                let s = self.l * trail.t;
                if v * s - f.u * self.h > q {
                    return None;
                }
                Some((self.apex + s, self.moments(&trail.sums())))
            }
            None => None,
        };
        let s = lead.sums();
        Some(Crowned {
            v,
            x: self.apex + self.l * t,
            q,
            w: self.l * (s.m3 / s.p3),
            lead: self.moments(&s),
            front,
        })
    }
}

/// Fourth-order step to the zero of a function whose Newton step is `newton`, from its second and third derivatives over twice and six
/// times the first.
#[inline(always)]
fn fourth(newton: f64, a2: f64, a3: f64) -> f64 {
    newton * (1.0 - newton * (a2 - newton * (2.0 * a2 * a2 - a3)))
}
