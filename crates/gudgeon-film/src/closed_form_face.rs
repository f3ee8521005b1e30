use gudgeon_core::geometry::FaceProfile;
use gudgeon_core::kinds::{FaceCtx, FaceForces, FaceIn, FaceOut, Hydrodynamics, HydrodynamicsSpec};
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

use crate::crown::{Asked, Crowned};
use crate::face::{Moments, Parabola, Shape, Table, Three};

/// Exact film under a ring face: Reynolds' equation integrated in closed form, without a grid.
///
/// With `h(x) = h + drop(x)`, `u` the velocity of the liner along `+x` seen from the ring and `ḣ` the squeeze velocity, the
/// flux per metre of circumference and the pressure of a full film are
///
/// `q(x) = u h/2 - h³ p'/(12 μ) = q0 - ḣ x`,  `p' = 12 μ (u h/2 + ḣ x - q0)/h³`,
///
/// and on a parabola or a straight line every integral of that is elementary. Load and friction are
///
/// `W = ∫ (p - p_cav) dx`,  `F_ring = ∫ (μu/h - h p'/2) dx`,  `F_liner = ∫ (μu/h + h p'/2) dx`,
///
/// `F_slope = -∫ (p - p_cav) h' dx`, with `F_ring + F_slope = F_liner - [(p - p_cav) h]` over the two edges.
///
/// Fully flooded: both edges are covered with oil at the gas pressure next to them. An edge pressure below `p_cav` counts
/// as `p_cav`, except with `full_sommerfeld`. What happens where oil would have to pull is the choice of `cavitation`.
///
/// Good to 12 digits for a film that covers a fair part of the face; the load of a sliver at an edge to 12 digits of the
/// edge pressure times the face length.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ClosedFormFace {
    /// What happens where the pressure would fall below `p_cav`.
    #[serde(default)]
    pub cavitation: Cavitation,
    /// Friction of the oil that is left in the cavity.
    #[serde(default)]
    pub cavity_shear: CavityShear,
}

/// Condition of a film where its pressure would fall below the cavitation pressure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Cavitation {
    /// Ruptures where pressure and pressure gradient vanish and, behind the cavity, forms again where the flux that the
    /// liner carries through it fills the gap (Jakobsson, Floberg and Olsson). Load and friction are continuous in every
    /// input. The cavity is quasi-steady: its void keeps its volume, so that the flux in it is `q_r - ḣ (x - x_r)`, and a
    /// cavity that runs dry on the way takes oil from neither side.
    #[default]
    MassConserving,
    /// Ruptures where pressure and pressure gradient vanish; from there to the trailing edge the pressure is `p_cav`
    /// (Reynolds or Swift-Stieber condition). When the trailing edge is above `p_cav` the load jumps where the film first
    /// ruptures. Without sliding there is no trailing edge and both edges keep their films, as in `mass_conserving`.
    SwiftStieber,
    /// The full film, cut off at `p_cav` afterwards (Gümbel condition). Loses oil at the cut.
    HalfSommerfeld,
    /// The full film, however far below `p_cav`.
    FullSommerfeld,
}

/// Friction of the part of a face that is not under full film.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CavityShear {
    /// `full` for the Sommerfeld conditions, as programs that use them count it; `streamers` otherwise.
    #[default]
    Auto,
    /// Streamers of oil over the fraction of the width that the flux through the cavity fills: `h_r/h` in a steady film.
    Streamers,
    /// As if the gap were full: `μ u/h`.
    Full,
    /// None.
    None,
}

const MODEL: &str = "closed_form_face";

#[register_model(
    name = "closed_form_face",
    summary = "exact Reynolds film on parabola or straight pieces, with a choice of cavitation conditions",
    equations = "q = u h/2 - h^3 p'/(12 mu) = q0 - hdot x;  p' = 12 mu (u h/2 + hdot x - q0)/h^3, integrated in closed form;  \
                mass_conserving: p = p' = 0 at rupture, flux carried through the cavity u h_r/2 - hdot (x - x_r) >= 0, \
                same flux at reformation;  swift_stieber: p = p_cav from the rupture to the trailing edge;  \
                half_sommerfeld: max(p, p_cav);  load = int (p - p_cav) dx;  shear = int (mu u/h -+ h p'/2) dx, \
                in the cavity weighted with the filled fraction",
    validity = "Smooth surfaces, fully flooded, narrow face (no flow along the circumference), constant viscosity. \
               A face that waves up and down has one film under swift_stieber, the one at the leading edge. \
               The cavity has no history: transients shorter than the passage over the face are not resolved.",
    references = ["reynolds1886", "jakobsson1957", "cameron1966", "dowson1979"],
    example = "cavitation = \"mass_conserving\"\ncavity_shear = \"streamers\"\n",
)]
impl HydrodynamicsSpec for ClosedFormFace {
    fn build(&self, ctx: &FaceCtx<'_>) -> Result<Box<dyn Hydrodynamics>, BuildError> {
        crate::gridded_face::check_face(ctx.face)?;
        let shear = match (self.cavity_shear, self.cavitation) {
            (CavityShear::Auto, Cavitation::HalfSommerfeld | Cavitation::FullSommerfeld) => CavityShear::Full,
            (CavityShear::Auto, _) => CavityShear::Streamers,
            (s, _) => s,
        };
        if let FaceProfile::Parabola { length, curvature, apex } = ctx.face {
            let up = Parabola::new(*length, *curvature, *apex);
            let down = up.mirrored();
            return Ok(Box::new(Film::new(up, down, self.cavitation, shear)));
        }
        let up = Table::new(&ctx.face.nodes().unwrap_or_default());
        let down = up.mirrored();
        Ok(Box::new(Film::new(up, down, self.cavitation, shear)))
    }
}

/// One film problem in the frame where the liner moves along `+x` (`u >= 0`). Pressures are above `p_cav`, over `12 μ`.
#[derive(Debug, Clone, Copy)]
struct Flow {
    /// Half the sliding velocity.
    u: f64,
    v: f64,
    pa: f64,
    pb: f64,
}

/// A stretch of full film: flux law `q0 - v s` with `q0 = q + u h`.
#[derive(Debug, Clone, Copy)]
struct Island {
    ia: usize,
    xa: f64,
    pa: f64,
    ib: usize,
    xb: f64,
    pb: f64,
    q: f64,
    /// `∂q/∂v`
    w: f64,
    /// `∂p/∂v` at the ends.
    ra: f64,
    rb: f64,
    /// The film begins at 0, and its pressure is counted from there; otherwise from the upper end.
    upwards: bool,
    m: Moments,
}

/// A pressure minimum, and the integrals up to it.
struct Valley<S: Shape> {
    p: f64,
    i: usize,
    x: f64,
    head: S::Head,
}
impl<S: Shape> Clone for Valley<S> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<S: Shape> Copy for Valley<S> {}

/// How the film that begins at the leading edge ends.
enum Lead<S: Shape> {
    /// At the trailing edge.
    Full { q: f64 },
    /// Where pressure and gradient vanish.
    Rupture { q: f64, at: Valley<S> },
}

/// Load over `12 μ`, its derivative, and the size of the terms it was summed from.
#[derive(Debug, Clone, Copy, Default)]
struct Carried {
    load: f64,
    rate: f64,
    size: f64,
}

/// Where the last cavity was and at which squeeze velocity, and how its ends move with that: a start for the next search.
#[derive(Debug, Clone, Copy)]
struct Warm {
    v: f64,
    xr: f64,
    xf: f64,
    xr_v: f64,
    xf_v: f64,
}

/// A place and the integrals of the film between it and the edge.
#[derive(Debug, Clone, Copy)]
struct Anchor {
    i: usize,
    x: f64,
    m: Moments,
}

/// A ruptured film: its squeeze velocity, the end of the film at the leading edge and the beginning of that at the trailing
/// edge.
#[derive(Debug, Clone, Copy)]
struct Ruptured {
    v: f64,
    i: usize,
    x: f64,
    q: f64,
    front: Option<Start>,
}

/// What the quick searches find.
#[derive(Debug, Clone, Copy)]
enum Quick {
    Full { v: f64, q: f64 },
    Ruptured(Ruptured),
}

/// What a search is asked for: the film at a squeeze velocity, or that under a load. Each starts where it ended last; a ring
/// that does not move as its film asks has two different films.
#[derive(Debug, Clone, Copy)]
enum Ask {
    Rate = 0,
    Load = 1,
}

/// A face in one sliding direction.
#[derive(Debug)]
struct Side<S> {
    face: S,
    islands: Vec<Island>,
    /// Where the search for either began and the safe search begins.
    warm: Option<Warm>,
    starts: [Option<Warm>; 2],
    /// Ends of films of the present thickness.
    lead: Option<Anchor>,
    trail: Option<Anchor>,
    /// Where the full film was cut last, and the last squeeze velocity of one.
    cuts: [f64; 2],
    v_cut: Option<f64>,
    /// Where the part of the face that is covered with oil begins.
    from: f64,
}

#[derive(Debug)]
struct Film<S> {
    up: Side<S>,
    down: Side<S>,
    /// Length of the whole face, and where its film begins.
    whole: f64,
    from: f64,
    cavitation: Cavitation,
    shear: CavityShear,
}

impl<S: Shape> Side<S> {
    fn new(face: S) -> Self {
        let islands = Vec::with_capacity(2 * face.pieces() + 2);
        Self {
            face,
            islands,
            warm: None,
            starts: [None; 2],
            lead: None,
            trail: None,
            cuts: [f64::NAN; 2],
            v_cut: None,
            from: 0.0,
        }
    }

    /// Confines the film to the face between `from` and `to` of the whole.
    fn set_extent(&mut self, from: f64, to: f64) {
        self.face.crop(from, to);
        (self.lead, self.trail) = (None, None);
        // Places of the last film, seen from the new beginning.
        let (shift, len) = (self.from - from, to - from);
        for start in &mut self.starts {
            *start = start
                .map(|w| Warm { xr: w.xr + shift, xf: (w.xf + shift).min(len), ..w })
                .filter(|w| w.xr > 0.0 && w.xr < len && w.xf > w.xr);
        }
        self.warm = None;
        self.cuts = [f64::NAN; 2];
        self.from = from;
    }

    /// Tilts the face; the search of the next film starts anew.
    fn tilt(&mut self, angle: f64) -> bool {
        (self.lead, self.trail, self.warm) = (None, None, None);
        self.starts = Default::default();
        self.cuts = [f64::NAN; 2];
        self.face.tilt(angle)
    }

    fn set_film(&mut self, h: f64) {
        if self.face.film().to_bits() != h.to_bits() {
            self.face.set_film(h);
            (self.lead, self.trail) = (None, None);
        }
    }

    /// Integrals from 0 to `x` in piece `i`.
    // Inlined so that no caller sums what it does not use.
    #[inline(always)]
    fn lead_to(&mut self, i: usize, x: f64) -> Moments {
        if let Some(a) = &self.lead
            && a.i == i
            && let Some(m) = self.face.nearby(&a.m, x, i, a.x, x)
        {
            return m;
        }
        self.lead_anew(i, x)
    }

    #[inline(never)]
    fn lead_anew(&mut self, i: usize, x: f64) -> Moments {
        let m = self.face.span(0, 0.0, i, x);
        self.lead = Some(Anchor { i, x, m });
        m
    }

    /// Integrals from `x` in piece `i` to the end.
    #[inline(always)]
    fn trail_from(&mut self, i: usize, x: f64) -> Moments {
        if let Some(a) = &self.trail
            && a.i == i
            && let Some(m) = self.face.nearby(&a.m, self.face.len() - x, i, x, a.x)
        {
            return m;
        }
        self.trail_anew(i, x)
    }

    #[inline(never)]
    fn trail_anew(&mut self, i: usize, x: f64) -> Moments {
        let m = self.face.span(i, x, self.face.pieces() - 1, self.face.len());
        self.trail = Some(Anchor { i, x, m });
        m
    }

    /// `U d + V s - q`, the pressure gradient times `h³`.
    #[inline]
    fn n(&self, f: &Flow, i: usize, x: f64, q: f64) -> f64 {
        f.u * self.face.drop(i, x) + f.v * self.face.s(x) - q
    }

    fn full_q(&mut self, f: &Flow) -> f64 {
        let w = self.face.whole();
        (f.pa - f.pb + f.u * w.d2 + f.v * w.x3) / w.i3
    }

    /// The lowest of the pressure minima of the film that starts with `pa` at 0 and has the flux `q`.
    fn lowest_valley(&self, f: &Flow, q: f64) -> Option<Valley<S>> {
        let mut low: Option<Valley<S>> = None;
        for i in 0..self.face.pieces() {
            if let Some(x) = self.face.valley(i, f.u, f.v, q) {
                let head = self.face.head(i, x);
                let p = f.pa + S::three(&head).rise(f.u, f.v, q);
                if low.as_ref().is_none_or(|l| p < l.p) {
                    low = Some(Valley { p, i, x, head });
                }
            }
        }
        low
    }

    /// The film at the leading edge.
    ///
    /// As a function of the flux, every pressure minimum is concave and falls (`dp/dq = -∫dx/h³` up to it, which grows), and
    /// so does the lowest of them. The flux sought is the largest that leaves no pressure negative; from the full film,
    /// where the lowest is negative, second-order steps on a concave function approach it from one side.
    fn lead(&mut self, f: &Flow) -> Result<Lead<S>, EvalError> {
        // Without pressure at the leading edge the pressure has to rise from there.
        let limit = f.u * self.face.drop(0, 0.0) + f.v * self.face.s(0.0);
        if let Some(w) = self.warm
            && self.face.convex()
            && f.u > 0.0
        {
            // One minimum only: if the film ruptures at all, it is there, and the start does not matter.
            let i = self.face.piece_of(w.xr);
            let q = f.u * self.face.drop(i, w.xr) + f.v * self.face.s(w.xr);
            if (f.pa > 0.0 || q < limit)
                && let Some(Lead::Rupture { q, at }) = self.touch(f, q, f64::NAN)
                && self.face.tail(at.i, at.x).rise(f.u, f.v, q) >= f.pb
            {
                return Ok(Lead::Rupture { q, at });
            }
        }
        let full = self.full_q(f);
        let held = f.pa <= 0.0 && full > limit;
        let q = if held { limit } else { full };
        let valley = self.lowest_valley(f, q);
        if valley.is_none_or(|v| v.p >= 0.0) {
            return Ok(if held {
                let head = self.face.head(0, 0.0);
                Lead::Rupture { q, at: Valley { p: 0.0, i: 0, x: 0.0, head } }
            } else {
                Lead::Full { q }
            });
        }
        self.touch(f, q, q).ok_or_else(|| no_convergence("rupture"))
    }

    /// The film whose lowest minimum is zero, from the flux `q`; `hi` is a flux known to be too large, if any. `None`: no
    /// convergence.
    fn touch(&self, f: &Flow, mut q: f64, mut hi: f64) -> Option<Lead<S>> {
        let mut lo = f64::NAN;
        let mut valley = self.lowest_valley(f, q);
        for _ in 0..200 {
            let mut close = None;
            let next = match valley {
                Some(at) => {
                    let Valley { p, i, x, head } = at;
                    let t = S::three(&head);
                    let scale = f.pa.abs() + (f.u * t.d2).abs() + (f.v * t.x3).abs() + (q * t.i3).abs();
                    if p.abs() <= 2.0 * f64::EPSILON * scale {
                        return Some(Lead::Rupture { q, at });
                    }
                    if p < 0.0 {
                        hi = q;
                    } else {
                        lo = q;
                    }
                    let h = self.face.film() + self.face.drop(i, x);
                    let slope = self.face.slope(i, x);
                    let rising = f.u * slope + f.v;
                    let bend = -1.0 / (h * h * h * rising);
                    let newton = p / t.i3;
                    // Quadratic model of p(q): exact where the film is short and p has a double zero.
                    let r = newton * bend / -t.i3;
                    let step = 2.0 * newton / (1.0 + (1.0 + 2.0 * r).max(0.0).sqrt());
                    // Both the bend itself and what it changes with have to be small over the step.
                    let dx = (step / rising).abs();
                    if r.abs() < 1e-5 && dx <= 1e-6 * x && dx * slope.abs() <= 1e-6 * h {
                        close = Some(i);
                    }
                    q + step
                }
                None => {
                    lo = q;
                    f64::NAN
                }
            };
            let inside = next.is_finite() && (hi.is_nan() || next < hi) && (lo.is_nan() || next > lo);
            let next = if inside { next } else { 0.5 * (lo + hi) };
            if !next.is_finite() {
                return None;
            }
            if next == q || next == hi || next == lo {
                // The bracket has closed to neighbouring numbers.
                return valley.map(|at| Lead::Rupture { q, at });
            }
            q = next;
            valley = self.lowest_valley(f, q);
            // The step was of third order if it stayed in one piece: what is left is below rounding.
            if let (Some(c), Some(at)) = (close, valley)
                && c == at.i
                && inside
            {
                return Some(Lead::Rupture { q, at });
            }
        }
        None
    }

    /// Beginning of the film that ends at `(ie, xe)` with pressure `pe`, behind the rupture at `(ir, xr)`.
    ///
    /// The largest place where the pressure, counted back from the end, comes down to zero: with the flux that the cavity
    /// carries there, which is that of the rupture unless the cavity has run dry.
    #[allow(clippy::too_many_arguments)]
    fn reform(
        &self,
        f: &Flow,
        q: f64,
        ir: usize,
        xr: f64,
        ie: usize,
        xe: f64,
        pe: f64,
        may_dry: bool,
    ) -> Start {
        let end = if xe >= self.face.len() { Three::default() } else { self.face.tail(ie, xe) };
        // Pressure at x counted back from the end, with its first and second derivative there.
        let at = |i: usize, x: f64| {
            let t = self.face.tail(i, x).minus(end);
            let (qx, dry) = self.carried_to(f, q, x, may_dry);
            let (h, dh) = (self.face.film() + self.face.drop(i, x), self.face.slope(i, x));
            let (n, ih) = (self.n(f, i, x, qx), 1.0 / h);
            let ih3 = ih * ih * ih;
            let p = pe - t.rise(f.u, f.v, qx);
            if dry {
                // Second derivative not worth its terms: zero asks for plain Newton steps.
                (p, n * ih3 + f.v * t.i3, 0.0)
            } else {
                (p, n * ih3, (f.u * dh + f.v - 3.0 * n * dh * ih) * ih3)
            }
        };
        let mut i = ie;
        let mut hi = xe;
        loop {
            let mut lo = if i == ir { xr } else { self.face.node(i) };
            let valley = if i == ir {
                // The pressure there is zero or, counted back from the end, less: the film has ruptured.
                Some(xr)
            } else {
                self.face.valley(i, f.u, f.v, q).filter(|x| *x > lo && *x < hi && at(i, *x).0 <= 0.0)
            };
            if valley.is_some() || at(i, lo).0 <= 0.0 {
                lo = valley.unwrap_or(lo);
                // From here the pressure only rises as far as its maximum, if it has one.
                let crest = self.face.crest(i, f.u, f.v, q).filter(|x| *x > lo && *x < hi);
                let x = self.reform_between(i, lo, crest.unwrap_or(hi), xe, at);
                let (q, dry) = self.carried_to(f, q, x, may_dry);
                return Start { i, x, q, dry };
            }
            hi = lo;
            i -= 1;
        }
    }

    /// Flux constant of a film that begins at `x` behind a cavity, and whether the cavity has run dry before.
    #[inline]
    fn carried_to(&self, f: &Flow, q: f64, x: f64, may_dry: bool) -> (f64, bool) {
        let dry_q = f.v * self.face.s(x) - f.u * self.face.film();
        if may_dry && dry_q > q { (dry_q, true) } else { (q, false) }
    }

    fn reform_between(
        &self,
        i: usize,
        mut lo: f64,
        mut hi: f64,
        xe: f64,
        at: impl Fn(usize, f64) -> (f64, f64, f64),
    ) -> f64 {
        let mut x = self.warm.map_or(f64::NAN, |w| w.xf);
        if !(x > lo && x < hi) {
            x = hi;
        }
        for _ in 0..200 {
            let (p, slope, bend) = at(i, x);
            if p > 0.0 {
                hi = x;
            } else {
                lo = x;
            }
            if p == 0.0 || hi - lo <= 2.0 * f64::EPSILON * self.face.len() {
                return x;
            }
            // Halley's step, third order.
            let newton = -p / slope;
            let r = newton * bend / slope;
            let step = newton / (1.0 + 0.5 * r);
            let next = x + step;
            if next > lo && next < hi {
                x = next;
                // Small beside the length of the film and beside that over which the slope changes: what is left is below
                // rounding.
                let small = if bend == 0.0 { 1e-9 } else { 1e-6 };
                if step.abs() <= small * (xe - x) && r.abs() <= 1e-6 {
                    return x;
                }
            } else {
                x = 0.5 * (lo + hi);
            }
        }
        x
    }

    /// Fills `islands` for the film at the given squeeze velocity.
    fn solve(&mut self, f: &mut Flow, cavitation: Cavitation) -> Result<(), EvalError> {
        if self.crowned(f, cavitation, None, Ask::Rate) {
            return Ok(());
        }
        self.warm = self.starts[Ask::Rate as usize];
        if let Some(found) = self.quick_rate(f, cavitation) {
            self.lay(f, &found, Ask::Rate);
            return Ok(());
        }
        self.search(f, cavitation)?;
        self.starts[Ask::Rate as usize] = self.warm;
        Ok(())
    }

    /// [`Self::solve`] by searches that always end.
    fn search(&mut self, f: &Flow, cavitation: Cavitation) -> Result<(), EvalError> {
        self.islands.clear();
        let last = self.face.pieces() - 1;
        let len = self.face.len();
        match cavitation {
            Cavitation::FullSommerfeld => {
                let q = self.full_q(f);
                self.push_full(f, q);
            }
            Cavitation::HalfSommerfeld => self.clip(f),
            Cavitation::MassConserving | Cavitation::SwiftStieber => match self.lead(f)? {
                Lead::Full { q } => {
                    self.warm = None;
                    self.push_full(f, q);
                }
                Lead::Rupture { q, at: Valley { i, x, head, .. } } => {
                    let m = self.face.complete(i, x, &head);
                    let w = if x > 0.0 { m.x3 / m.i3 } else { self.face.s(0.0) };
                    self.push_lead(f, i, x, 0.0, q, w, m);
                    let mut xf = len;
                    // The trailing edge has a film if there is pressure, or if the gap narrows towards it.
                    let trailing = f.pb > 0.0 || self.n(f, last, len, q) < 0.0;
                    if (cavitation == Cavitation::MassConserving || f.u == 0.0) && trailing {
                        let start = self.reform(f, q, i, x, last, len, f.pb, true);
                        xf = start.x;
                        self.push_trailing(f, start, last, len, f.pb, w);
                        self.middle(f, q, w, i, x, start);
                    } else if cavitation == Cavitation::MassConserving {
                        let start = Start { i: last, x: len, q, dry: false };
                        self.middle(f, q, w, i, x, start);
                    }
                    self.warm = Some(Warm { v: f.v, xr: x, xf, xr_v: 0.0, xf_v: 0.0 });
                }
            },
        }
        Ok(())
    }

    fn push_full(&mut self, f: &Flow, q: f64) {
        let m = self.face.whole();
        self.push_lead(f, self.face.pieces() - 1, self.face.len(), f.pb, q, m.x3 / m.i3, m);
    }

    /// The film at the leading edge, to `x` in piece `i`.
    #[allow(clippy::too_many_arguments)]
    fn push_lead(&mut self, f: &Flow, i: usize, x: f64, pb: f64, q: f64, w: f64, m: Moments) {
        self.islands.push(Island {
            ia: 0,
            xa: 0.0,
            pa: f.pa,
            ib: i,
            xb: x,
            pb,
            q,
            w,
            ra: 0.0,
            rb: 0.0,
            upwards: true,
            m,
        });
    }

    fn push_trailing(&mut self, f: &Flow, start: Start, ie: usize, xe: f64, pe: f64, w: f64) {
        let m = self.face.span(start.i, start.x, ie, xe);
        self.push_behind(f, start, ie, xe, pe, w, m);
    }

    #[allow(clippy::too_many_arguments)]
    fn push_behind(&mut self, f: &Flow, start: Start, ie: usize, xe: f64, pe: f64, w: f64, m: Moments) {
        let w = if start.dry {
            // The flux constant moves with the front, and the front with v.
            let s = self.face.s(start.x);
            let h = self.face.film() + self.face.drop(start.i, start.x);
            let n = self.n(f, start.i, start.x, start.q);
            s + f.v * (m.x3 - s * m.i3) / (n / (h * h * h) + f.v * m.i3)
        } else {
            w
        };
        self.islands.push(Island {
            ia: start.i,
            xa: start.x,
            pa: 0.0,
            ib: ie,
            xb: xe,
            pb: pe,
            q: start.q,
            w,
            ra: w * m.i3 - m.x3,
            rb: 0.0,
            upwards: false,
            m,
        });
    }

    /// Films inside the cavity of a face that waves: each ends at a pressure minimum.
    #[allow(clippy::too_many_arguments)]
    fn middle(&mut self, f: &Flow, q: f64, w: f64, ir: usize, xr: f64, from: Start) {
        if self.face.convex() {
            return;
        }
        let (mut i, mut below) = (from.i, from.x);
        // At a minimum the film carries u h/2 > 0: the cavity before it has not run dry.
        loop {
            let valley = self.face.valley(i, f.u, f.v, q).filter(|x| *x < below && (i > ir || *x > xr));
            if let Some(xe) = valley
                && i > ir
            {
                let start = self.reform(f, q, ir, xr, i, xe, 0.0, false);
                if start.x < xe {
                    self.push_trailing(f, start, i, xe, 0.0, w);
                    i = start.i;
                    below = start.x;
                    if i > ir {
                        continue;
                    }
                    return;
                }
            }
            if i <= ir {
                return;
            }
            i -= 1;
        }
    }

    /// The parts of the full film above zero pressure.
    fn clip(&mut self, f: &Flow) {
        let q = self.full_q(f);
        let whole = self.face.whole();
        let w = whole.x3 / whole.i3;
        let len = self.face.len();
        let mid = self.face.x_ref();
        let last = self.face.pieces() - 1;
        // (pressure, ∂p/∂v); counted from the nearer end, for the sake of digits.
        let at = |i: usize, x: f64| {
            if x >= len {
                (f.pb, 0.0)
            } else if x <= 0.0 {
                (f.pa, 0.0)
            } else if x <= mid {
                let t = S::three(&self.face.head(i, x));
                (f.pa + t.rise(f.u, f.v, q), t.x3 - w * t.i3)
            } else {
                let t = self.face.tail(i, x);
                (f.pb - t.rise(f.u, f.v, q), w * t.i3 - t.x3)
            }
        };
        let mut cuts = self.cuts;
        let mut open: Option<(usize, f64, f64, f64)> = (f.pa > 0.0).then_some((0, 0.0, f.pa, 0.0));
        let (mut i0, mut x0, mut p0) = (0, 0.0, f.pa);
        let islands = &mut self.islands;
        let face = &self.face;
        let mut visit = |i: usize, x: f64, islands: &mut Vec<Island>| {
            let (p, r) = at(i, x);
            let island = |a: (usize, f64, f64, f64), b: (usize, f64, f64, f64)| Island {
                ia: a.0,
                xa: a.1,
                pa: a.2,
                ib: b.0,
                xb: b.1,
                pb: b.2,
                q,
                w,
                ra: a.3,
                rb: b.3,
                upwards: a.1 <= 0.0,
                m: face.span(a.0, a.1, b.0, b.1),
            };
            // Rises or falls monotonically since the last visit.
            if p > 0.0 && open.is_none() {
                let z = if p0 < 0.0 { clip_zero(face, f, q, i, (x0, p0), (x, p), cuts[1], &at) } else { x0 };
                cuts[1] = z;
                open = Some((if z > x0 { i } else { i0 }, z, 0.0, if z > 0.0 { at(i, z).1 } else { 0.0 }));
            } else if p <= 0.0
                && let Some(a) = open
            {
                let z = if p < 0.0 { clip_zero(face, f, q, i, (x0, p0), (x, p), cuts[0], &at) } else { x };
                cuts[0] = z;
                let rb = if z < len { at(i, z).1 } else { 0.0 };
                islands.push(island(a, (i, z, 0.0, rb)));
                open = None;
            }
            if x >= len
                && let Some(a) = open
            {
                islands.push(island(a, (i, x, p, r)));
                open = None;
            }
            (i0, x0, p0) = (i, x, p);
        };
        for i in 0..=last {
            let c = self.face.crest(i, f.u, f.v, q);
            let v = self.face.valley(i, f.u, f.v, q);
            let (first, second) = match (c, v) {
                (Some(c), Some(v)) if c > v => (Some(v), Some(c)),
                both => both,
            };
            for x in [first, second].into_iter().flatten() {
                visit(i, x, islands);
            }
            visit(i, self.face.node(i + 1), islands);
        }
        self.cuts = cuts;
    }

    /// Load over `12 μ` of the films found last.
    fn carried(&self, f: &Flow) -> Carried {
        let mut c = Carried::default();
        for l in &self.islands {
            self.carry(f, l, &mut c);
        }
        c
    }

    #[inline]
    fn carry(&self, f: &Flow, l: &Island, c: &mut Carried) {
        let m = &l.m;
        let (sa, sb) = (self.face.s(l.xa), self.face.s(l.xb));
        // Integration by parts: ∫p dx = [s p] - ∫ s p' dx.
        let (edge, wedge, squeeze, flux) = (sb * l.pb - sa * l.pa, f.u * m.e2, f.v * m.xx3, l.q * m.x3);
        c.load += edge - (wedge + squeeze - flux);
        c.size += edge.abs() + wedge.abs() + squeeze.abs() + flux.abs();
        c.rate += sb * l.rb - sa * l.ra - (m.xx3 - l.w * m.x3);
    }

    /// Pressure over `12 μ` at `x`; zero outside the films.
    fn pressure(&self, f: &Flow, i: usize, x: f64) -> f64 {
        for l in &self.islands {
            if x >= l.xa && x <= l.xb {
                return self.pressure_in(f, l, i, x);
            }
        }
        0.0
    }

    fn pressure_in(&self, f: &Flow, l: &Island, i: usize, x: f64) -> f64 {
        if x >= l.xb {
            l.pb
        } else if x <= l.xa {
            l.pa
        } else if l.upwards {
            l.pa + S::three(&self.face.head(i, x)).rise(f.u, f.v, l.q)
        } else {
            let end = if l.xb >= self.face.len() { Three::default() } else { self.face.tail(l.ib, l.xb) };
            l.pb - self.face.tail(i, x).minus(end).rise(f.u, f.v, l.q)
        }
    }

    /// Load and friction of the films found last, in this sliding direction.
    fn forces(&mut self, f: &Flow, cavitation: Cavitation, shear: CavityShear, mu: f64) -> FaceForces {
        let h0 = self.face.film();
        let mut c = Carried::default();
        let (mut gradient, mut sheared, mut ends) = (0.0, 0.0, 0.0);
        for l in &self.islands {
            let m = &l.m;
            self.carry(f, l, &mut c);
            gradient += f.u * (m.i1 - h0 * m.i2) + f.v * m.x2 - l.q * m.i2;
            sheared += m.i1;
            // Most ends have no pressure.
            if l.pa != 0.0 {
                ends -= l.pa * (h0 + self.face.drop(l.ia, l.xa));
            }
            if l.pb != 0.0 {
                ends += l.pb * (h0 + self.face.drop(l.ib, l.xb));
            }
        }
        let mut couette = 2.0 * f.u * sheared;
        if shear != CavityShear::None && f.u != 0.0 {
            couette += self.gaps_shear(f, cavitation, shear);
        }
        let k = 12.0 * mu;
        let (j, viscous) = (k * gradient, mu * couette);
        FaceForces {
            load: k * c.load,
            load_rate: (k * c.rate).min(0.0),
            ring_shear: viscous - 0.5 * j,
            liner_shear: viscous + 0.5 * j,
            slope_force: j - k * ends,
            flux: self.flux(f),
        }
    }

    /// Flux at the leading edge in this sliding direction; that of the cut film where it is cut.
    fn flux(&self, f: &Flow) -> f64 {
        let q = self.islands.first().map_or(0.0, |l| l.q);
        f.u * self.face.film() + q - f.v * self.face.s(0.0)
    }

    /// Highest pressure over `12 μ` and extent of the film that has it, of the films found last.
    fn peak(&self, f: &Flow) -> (f64, (f64, f64)) {
        let mut high = f64::NEG_INFINITY;
        let mut extent = (0.0, 0.0);
        for l in &self.islands {
            let mut p = l.pa.max(l.pb);
            for i in l.ia..=l.ib {
                if let Some(x) = self.face.crest(i, f.u, f.v, l.q)
                    && x > l.xa
                    && x < l.xb
                {
                    p = p.max(self.pressure_in(f, l, i, x));
                }
            }
            if p > high {
                high = p;
                extent = (l.xa, l.xb);
            }
        }
        (if self.islands.is_empty() { 0.0 } else { high }, extent)
    }

    /// `∫ u w/h dx` over the gaps between the films, in order along the face.
    fn gaps_shear(&mut self, f: &Flow, cavitation: Cavitation, shear: CavityShear) -> f64 {
        let (last, len) = (self.face.pieces() - 1, self.face.len());
        let lead = self.islands.first().filter(|l| l.xa <= 0.0).map(|l| (l.q, l.ib, l.xb));
        if let (
            Some((q, i, x)),
            Cavitation::MassConserving | Cavitation::SwiftStieber,
            CavityShear::Streamers,
        ) = (lead, cavitation, shear)
            && self.islands.len() <= 2
        {
            // One gap: all but the films. Its digits count beside those of the films.
            let front = self.islands.get(1).map_or((last, len), |l| (l.ia, l.xa));
            if front.1 <= x {
                return 0.0;
            }
            let q0 = q + f.u * self.face.film();
            if q0 - f.v * self.face.s(front.1) >= 0.0 {
                let whole = self.face.whole();
                let (mut i2, mut x2) = (whole.i2, whole.x2);
                for l in &self.islands {
                    i2 -= l.m.i2;
                    x2 -= l.m.x2;
                }
                return 2.0 * (q0 * i2 - f.v * x2);
            }
            return self.gap_shear(f, cavitation, shear, Some(q), (i, x), front);
        }
        self.islands.sort_unstable_by(|a, b| a.xa.total_cmp(&b.xa));
        let q = lead.map(|l| l.0);
        let mut sum = 0.0;
        let (mut i, mut x) = (0, 0.0);
        for k in 0..=self.islands.len() {
            let next = self.islands.get(k).map_or((last, len, last, len), |l| (l.ia, l.xa, l.ib, l.xb));
            if next.1 > x {
                sum += self.gap_shear(f, cavitation, shear, q, (i, x), (next.0, next.1));
            }
            (i, x) = (next.2, next.3);
        }
        sum
    }

    /// `∫ u w/h dx` over a stretch without full film, `w` the filled fraction.
    #[allow(clippy::too_many_arguments)]
    fn gap_shear(
        &self,
        f: &Flow,
        cavitation: Cavitation,
        shear: CavityShear,
        lead: Option<f64>,
        a: (usize, f64),
        b: (usize, f64),
    ) -> f64 {
        let h0 = self.face.film();
        if shear == CavityShear::Full {
            return 2.0 * f.u * self.face.span(a.0, a.1, b.0, b.1).i1;
        }
        if let (true, Some(q)) = (cavitation != Cavitation::HalfSommerfeld, lead) {
            // θ = (q0 - v s)/(u h), until it runs dry.
            let q0 = q + f.u * h0;
            let mut b = b;
            if f.v > 0.0 {
                let dry = self.face.x_ref() + q0 / f.v;
                if dry <= a.1 {
                    return 0.0;
                }
                if dry < b.1 {
                    b = (self.face.piece_of(dry), dry);
                }
            }
            let m = self.face.span(a.0, a.1, b.0, b.1);
            return 2.0 * (q0 * m.i2 - f.v * m.x2);
        }
        // The clip has no flux of its own: what passes the narrowest place fills the rest to that height.
        let m = self.face.span(a.0, a.1, b.0, b.1);
        2.0 * f.u * (h0 + self.face.lowest_between(a.0, a.1, b.0, b.1)) * m.i2
    }
}

/// Beginning of a film behind a cavity.
#[derive(Debug, Clone, Copy)]
struct Start {
    i: usize,
    x: f64,
    q: f64,
    /// The cavity has run dry before.
    dry: bool,
}

/// Zero of the pressure between `(x0, p0)` and `(x1, p1)`, where it is monotone.
#[allow(clippy::too_many_arguments)]
fn clip_zero<S: Shape>(
    face: &S,
    f: &Flow,
    q: f64,
    i: usize,
    (x0, p0): (f64, f64),
    (x1, p1): (f64, f64),
    guess: f64,
    at: &impl Fn(usize, f64) -> (f64, f64),
) -> f64 {
    let (mut lo, mut hi) = (x0, x1);
    let falls = p0 > p1;
    let mut x = if guess > x0 && guess < x1 { guess } else { x0 + (x1 - x0) * (p0 / (p0 - p1)) };
    for _ in 0..200 {
        let p = at(i, x).0;
        if (p > 0.0) == falls {
            lo = x;
        } else {
            hi = x;
        }
        let h = face.film() + face.drop(i, x);
        let slope = (f.u * face.drop(i, x) + f.v * face.s(x) - q) / (h * h * h);
        let step = -p / slope;
        let next = x + step;
        if p == 0.0 || hi - lo <= 2.0 * f64::EPSILON * face.len() {
            return x;
        }
        if next > lo && next < hi {
            x = next;
            // Second order: what is left is below rounding.
            if step.abs() <= 1e-9 * (x1 - x).min(x - x0) {
                return x;
            }
        } else {
            x = 0.5 * (lo + hi);
        }
    }
    x
}

fn no_convergence(what: &'static str) -> EvalError {
    EvalError::recoverable(MODEL, format!("no convergence of the {what}"))
}

impl<S: Shape> Film<S> {
    fn new(up: S, down: S, cavitation: Cavitation, shear: CavityShear) -> Self {
        let whole = up.len();
        Self { up: Side::new(up), down: Side::new(down), whole, from: 0.0, cavitation, shear }
    }

    /// Checks the inputs and turns them so that the liner moves along `+x`.
    fn enter(&mut self, inp: &FaceIn, v: f64) -> Result<(&mut Side<S>, Flow, bool), EvalError> {
        // One test for all: what is not finite leaves no finite sum.
        let sum = inp.h + inp.u + inp.p_bottom + inp.p_top + inp.p_cav + inp.mu + v;
        if !sum.is_finite() || inp.mu <= 0.0 {
            return Err(EvalError::fatal(
                MODEL,
                format!(
                    "these are no film: thickness {} m, sliding {} m/s, squeeze or load {v}, edges {} and {} Pa, viscosity {} Pa s",
                    inp.h, inp.u, inp.p_bottom, inp.p_top, inp.mu
                ),
            ));
        }
        let turned = inp.u < 0.0;
        let side = if turned { &mut self.down } else { &mut self.up };
        if inp.h + side.face.lowest() <= 0.0 {
            return Err(EvalError::recoverable(
                MODEL,
                format!("film of {} m leaves no gap at the nearest point", inp.h),
            ));
        }
        side.set_film(inp.h);
        let least = if self.cavitation == Cavitation::FullSommerfeld { f64::NEG_INFINITY } else { 0.0 };
        let scale = 1.0 / (12.0 * inp.mu);
        let bottom = (inp.p_bottom - inp.p_cav).max(least) * scale;
        let top = (inp.p_top - inp.p_cav).max(least) * scale;
        let (pa, pb) = if turned { (top, bottom) } else { (bottom, top) };
        Ok((side, Flow { u: 0.5 * inp.u.abs(), v, pa, pb }, turned))
    }
}

fn finite(x: f64, what: &'static str) -> Result<f64, EvalError> {
    if x.is_finite() { Ok(x) } else { Err(EvalError::recoverable(MODEL, format!("{what} out of range"))) }
}

/// Forces in the frame of the ring, when they are numbers.
fn told<S: Shape>(
    mut o: FaceForces,
    turned: bool,
    side: &Side<S>,
    f: &Flow,
) -> Result<FaceForces, EvalError> {
    if turned {
        // The lower end is the trailing one then; the flux changes along the film with what it squeezes out.
        o.flux = f.v * side.face.len() - o.flux;
        o.ring_shear = -o.ring_shear;
        o.liner_shear = -o.liner_shear;
        o.slope_force = -o.slope_force;
    }
    finite(o.load + o.load_rate + o.ring_shear + o.liner_shear + o.slope_force + o.flux, "film")?;
    Ok(o)
}

impl<S: Shape> Hydrodynamics for Film<S> {
    fn set_extent(&mut self, from: f64, to: f64) -> bool {
        if !(from >= 0.0 && to <= self.whole && from < to) {
            return false;
        }
        self.up.set_extent(from, to);
        self.down.set_extent(self.whole - to, self.whole - from);
        self.from = from;
        true
    }

    fn set_tilt(&mut self, tilt: f64) -> bool {
        // The mirrored face tilts the other way.
        self.up.tilt(tilt) && self.down.tilt(-tilt)
    }

    fn evaluate(&mut self, inp: &FaceIn, hdot: f64) -> Result<FaceOut, EvalError> {
        let (cavitation, shear, from) = (self.cavitation, self.shear, self.from);
        let (side, mut f, turned) = self.enter(inp, hdot)?;
        side.solve(&mut f, cavitation)?;
        let o = told(side.forces(&f, cavitation, shear, inp.mu), turned, side, &f)?;
        let (high, (a, b)) = side.peak(&f);
        let len = side.face.len();
        Ok(FaceOut {
            load: o.load,
            load_rate: o.load_rate,
            ring_shear: o.ring_shear,
            liner_shear: o.liner_shear,
            slope_force: o.slope_force,
            flux: o.flux,
            p_max: finite(inp.p_cav + 12.0 * inp.mu * high, "pressure")?,
            full_film: if turned { (from + len - b, from + len - a) } else { (from + a, from + b) },
        })
    }

    fn forces(&mut self, inp: &FaceIn, hdot: f64) -> Result<FaceForces, EvalError> {
        let (cavitation, shear) = (self.cavitation, self.shear);
        let (side, mut f, turned) = self.enter(inp, hdot)?;
        side.solve(&mut f, cavitation)?;
        told(side.forces(&f, cavitation, shear, inp.mu), turned, side, &f)
    }

    fn load(&mut self, inp: &FaceIn, hdot: f64) -> Result<(f64, f64), EvalError> {
        let cavitation = self.cavitation;
        let (side, mut f, _) = self.enter(inp, hdot)?;
        side.solve(&mut f, cavitation)?;
        let c = side.carried(&f);
        let k = 12.0 * inp.mu;
        finite(c.load + c.rate, "film")?;
        Ok((k * c.load, (k * c.rate).min(0.0)))
    }

    fn squeeze_rate(&mut self, inp: &FaceIn, load: f64) -> Result<f64, EvalError> {
        let cavitation = self.cavitation;
        let (side, mut f, _) = self.enter(inp, load)?;
        let target = load / (12.0 * inp.mu);
        f.v = 0.0;
        side.squeeze(&mut f, cavitation, target)?;
        Ok(f.v)
    }

    fn carry(&mut self, inp: &FaceIn, load: f64) -> Result<(f64, FaceForces), EvalError> {
        let (cavitation, shear) = (self.cavitation, self.shear);
        let (side, mut f, turned) = self.enter(inp, load)?;
        let target = load / (12.0 * inp.mu);
        f.v = 0.0;
        side.squeeze(&mut f, cavitation, target)?;
        Ok((f.v, told(side.forces(&f, cavitation, shear, inp.mu), turned, side, &f)?))
    }

    fn profile(&mut self, inp: &FaceIn, hdot: f64, out: &mut [(f64, f64, f64)]) -> Result<(), EvalError> {
        let (cavitation, from) = (self.cavitation, self.from);
        let (side, mut f, turned) = self.enter(inp, hdot)?;
        side.solve(&mut f, cavitation)?;
        let n = out.len();
        let len = side.face.len();
        let steps = n.saturating_sub(1).max(1);
        for (j, o) in out.iter_mut().enumerate() {
            let x = if j == steps { len } else { len * j as f64 / steps as f64 };
            let along = if turned { len - x } else { x };
            let i = side.face.piece_of(along);
            let p = inp.p_cav + 12.0 * inp.mu * side.pressure(&f, i, along);
            *o = (from + x, inp.h + side.face.drop(i, along), finite(p, "pressure")?);
        }
        Ok(())
    }
}

impl<S: Shape> Side<S> {
    /// Sets `f.v` to the squeeze velocity at which the film carries `target` (over `12 μ`), and finds that film.
    fn squeeze(&mut self, f: &mut Flow, cavitation: Cavitation, target: f64) -> Result<(), EvalError> {
        if target <= 0.0 && cavitation != Cavitation::FullSommerfeld {
            return Err(EvalError::recoverable(MODEL, "a cavitating film carries no load of zero or less"));
        }
        if self.crowned(f, cavitation, Some(target), Ask::Load) {
            return Ok(());
        }
        self.warm = self.starts[Ask::Load as usize];
        if let Some(found) = self.quick_load(f, cavitation, target) {
            f.v = match found {
                Quick::Full { v, .. } | Quick::Ruptured(Ruptured { v, .. }) => v,
            };
            self.lay(f, &found, Ask::Load);
            return Ok(());
        }
        let full = finite(self.full_v(f, target), "squeeze velocity")?;
        let m = self.face.whole();
        let unit = target / (m.xx3 - m.x3 * m.x3 / m.i3);
        if cavitation == Cavitation::HalfSommerfeld
            && let Some(v) = self.v_cut
        {
            f.v = v;
            if self.bracketed(f, cavitation, target, unit).is_ok() {
                self.v_cut = Some(f.v);
                return Ok(());
            }
        }
        f.v = full;
        self.search(f, cavitation)?;
        if cavitation != Cavitation::FullSommerfeld
            && !matches!(self.islands.as_slice(), [l] if l.xa <= 0.0 && l.xb >= self.face.len())
        {
            self.bracketed(f, cavitation, target, unit)?;
            self.v_cut = Some(f.v);
        }
        self.starts[Ask::Load as usize] = self.warm;
        Ok(())
    }

    /// The squeeze velocity at which a full film, which is linear in it, carries `target`.
    fn full_v(&mut self, f: &Flow, target: f64) -> f64 {
        let m = self.face.whole();
        let w = m.x3 / m.i3;
        let ends = self.face.s(self.face.len()) * f.pb - self.face.s(0.0) * f.pa;
        let still = ends - f.u * m.e2 + w * (f.pa - f.pb + f.u * m.d2);
        (still - target) / (m.xx3 - m.x3 * w)
    }

    /// Whether the quick searches know this film: one cavity at most.
    fn simple(&self, f: &Flow, cavitation: Cavitation) -> bool {
        self.face.convex()
            && f.u > 0.0
            && matches!(cavitation, Cavitation::MassConserving | Cavitation::SwiftStieber)
    }

    /// Fills `islands` with what a quick search found and keeps it as a start.
    fn lay(&mut self, f: &Flow, found: &Quick, ask: Ask) {
        self.islands.clear();
        self.starts[ask as usize] = match found {
            Quick::Full { q, .. } => {
                self.push_full(f, *q);
                None
            }
            Quick::Ruptured(r) => {
                let m = self.lead_to(r.i, r.x);
                let w = m.x3 / m.i3;
                self.push_lead(f, r.i, r.x, 0.0, r.q, w, m);
                let rising = f.u * self.face.slope(r.i, r.x) + f.v;
                let xr_v = (w - self.face.s(r.x)) / rising;
                let (mut xf, mut xf_v) = (self.face.len(), 0.0);
                if let Some(start) = r.front {
                    let m = self.trail_from(start.i, start.x);
                    self.push_behind(f, start, self.face.pieces() - 1, xf, f.pb, w, m);
                    xf = start.x;
                    if !start.dry {
                        let h = self.face.film() + self.face.drop(start.i, xf);
                        xf_v = (m.x3 - w * m.i3) * (h * h * h) / self.n(f, start.i, xf, start.q);
                    }
                }
                Some(Warm { v: f.v, xr: r.x, xf, xr_v, xf_v })
            }
        };
    }

    /// The film at a squeeze velocity, from where its cavity was last; `None` sends to the safe search.
    ///
    /// A convex face has one pressure minimum, so that each of the two places is the only zero of a monotone function, and a
    /// film that has both is ruptured: whatever start converges, converges to the one film, and only rounding depends on it.
    fn quick_rate(&mut self, f: &Flow, cavitation: Cavitation) -> Option<Quick> {
        if !self.simple(f, cavitation) {
            return None;
        }
        if let Some(w) = self.warm
            && let Some(r) = self.ruptured(f, cavitation, w)
        {
            return Some(Quick::Ruptured(r));
        }
        match self.full(f)? {
            Ok(q) => Some(Quick::Full { v: f.v, q }),
            Err(start) => self.ruptured(f, cavitation, start).map(Quick::Ruptured),
        }
    }

    /// The film under a load, as [`Self::quick_rate`].
    fn quick_load(&mut self, f: &Flow, cavitation: Cavitation, target: f64) -> Option<Quick> {
        if !self.simple(f, cavitation) {
            return None;
        }
        if let Some(w) = self.warm
            && let Some(r) = self.loaded(f, cavitation, target, w)
        {
            return Some(Quick::Ruptured(r));
        }
        let mut f = *f;
        f.v = self.full_v(&f, target);
        if !f.v.is_finite() {
            return None;
        }
        match self.full(&f)? {
            Ok(q) => Some(Quick::Full { v: f.v, q }),
            Err(start) => self.loaded(&f, cavitation, target, start).map(Quick::Ruptured),
        }
    }

    /// The film of a crowned face at `f.v` or, if one is given, under a load, from where its cavity was last; lays it and says whether
    /// it did.
    #[inline]
    fn crowned(&mut self, f: &mut Flow, cavitation: Cavitation, load: Option<f64>, ask: Ask) -> bool {
        let (Some(w), true) = (self.starts[ask as usize], self.simple(f, cavitation)) else { return false };
        let Some(crown) = self.face.crown() else { return false };
        let trailing = cavitation == Cavitation::MassConserving && f.pb > 0.0;
        let asked = Asked { u: f.u, pa: f.pa, pb: f.pb, trailing };
        let found = match load {
            Some(load) => crown.under_load(&asked, load, w.xr, w.xf),
            None => crown.at_rate(&asked, f.v, w.xr, w.xf),
        };
        let Some(Crowned { v, x, q, w, ref lead, ref front }) = found else { return false };
        f.v = v;
        self.islands.clear();
        self.push_lead(f, 0, x, 0.0, q, w, *lead);
        let mut xf = self.face.len();
        if let Some((x, m)) = front {
            self.push_behind(f, Start { i: 0, x: *x, q, dry: false }, 0, xf, f.pb, w, *m);
            xf = *x;
        }
        self.starts[ask as usize] = Some(Warm { v, xr: x, xf, xr_v: 0.0, xf_v: 0.0 });
        true
    }

    /// Flux of the full film, or where it would rupture. `None` when it does at the edge itself.
    fn full(&mut self, f: &Flow) -> Option<Result<f64, Warm>> {
        let q = self.full_q(f);
        if f.pa <= 0.0 && q > f.u * self.face.drop(0, 0.0) + f.v * self.face.s(0.0) {
            return None;
        }
        for i in 0..self.face.pieces() {
            if let Some(x) = self.face.valley(i, f.u, f.v, q) {
                let m = self.lead_to(i, x);
                let p = f.pa + m.pressure().rise(f.u, f.v, q);
                if p >= 0.0 {
                    break;
                }
                return Some(Err(Warm { v: f.v, xr: x, xf: self.behind(f, i, x, p), xr_v: 0.0, xf_v: 0.0 }));
            }
        }
        Some(Ok(q))
    }

    /// Where the pressure is zero again that has the minimum `p < 0` at `x` in piece `i`, by its curvature there.
    fn behind(&self, f: &Flow, i: usize, x: f64, p: f64) -> f64 {
        let h = self.face.film() + self.face.drop(i, x);
        let rising = f.u * self.face.slope(i, x) + f.v;
        (x + (-2.0 * p * h * h * h / rising).sqrt()).min(0.5 * (x + self.face.len()))
    }

    /// The ruptured film at `f.v`, by third-order steps from `start`.
    fn ruptured(&mut self, f: &Flow, cavitation: Cavitation, start: Warm) -> Option<Ruptured> {
        let len = self.face.len();
        // Straight on from the last film, when that is not far.
        let on = |x: f64, slope: f64| {
            let (step, room) = (slope * (f.v - start.v), 0.2 * x.min(len - x));
            if step.abs() <= room { x + step } else { x }
        };
        let mut x = on(start.xr, start.xr_v);
        let mut settled = false;
        for _ in 0..10 {
            let i = self.face.piece_of(x);
            let m = self.lead_to(i, x);
            let (s, d, slope) = (self.face.s(x), self.face.drop(i, x), self.face.slope(i, x));
            let h = self.face.film() + d;
            let rising = f.u * slope + f.v;
            // A film of almost no length: too few digits here.
            if !(x > 0.0 && x < len && rising > 0.0 && s * m.i3 - m.x3 > 1e-3 * m.x3.abs()) {
                return None;
            }
            let e = f.pa + m.pressure().rise(f.u, f.v, f.u * d + f.v * s);
            let newton = e / (rising * m.i3);
            let curve = f.u * self.face.bend() / rising + 1.0 / (h * h * h * m.i3);
            let dx = newton / (1.0 + 0.5 * newton * curve).max(0.25);
            settled = newton.abs() * (curve.abs() + 1.0 / x) <= 3e-5;
            let next = (x + dx).clamp(0.25 * x, 0.5 * (x + len));
            settled &= self.face.piece_of(next) == i;
            x = next;
            if settled {
                break;
            }
        }
        let i = self.face.piece_of(x);
        let q = f.u * self.face.drop(i, x) + f.v * self.face.s(x);
        if !settled || f.u * self.face.slope(i, x) + f.v <= 0.0 {
            return None;
        }
        let found = Ruptured { v: f.v, i, x, q, front: None };
        if f.pb <= 0.0 {
            return Some(found);
        }
        if cavitation == Cavitation::SwiftStieber {
            return self.let_go(f, &found).then_some(found);
        }
        let mut xf = on(start.xf, start.xf_v);
        if !(xf > x && xf < len) {
            xf = 0.5 * (x + len);
        }
        for k in 0..10 {
            let j = self.face.piece_of(xf);
            let n = self.trail_from(j, xf).pressure();
            let (qf, dry) = self.carried_to(f, q, xf, true);
            let (hf, slope) = (self.face.film() + self.face.drop(j, xf), self.face.slope(j, xf));
            let (nf, ih) = (self.n(f, j, xf, qf), 1.0 / hf);
            let ih3 = ih * ih * ih;
            let p = f.pb - n.rise(f.u, f.v, qf);
            let (p_x, bend) = if dry {
                (nf * ih3 + f.v * n.i3, 0.0)
            } else {
                (nf * ih3, (f.u * slope + f.v - 3.0 * nf * slope * ih) * ih3)
            };
            let newton = -p / p_x;
            let r = newton * bend / p_x;
            let dx = newton / (1.0 + 0.5 * r).max(0.25);
            let next = xf + dx;
            if next.is_nan() || (next <= x && k > 0 && !self.let_go(f, &found)) {
                return None;
            }
            let inside = next > x && next < len && self.face.piece_of(next) == j;
            if inside && dx.abs() <= (if dry { 1e-9 } else { 3e-5 }) * (len - next) && r.abs() <= 3e-5 {
                let (qf, late) = self.carried_to(f, q, next, true);
                return (late == dry)
                    .then_some(Ruptured { front: Some(Start { i: j, x: next, q: qf, dry }), ..found });
            }
            xf = next.clamp(0.5 * (x + xf), 0.5 * (xf + len));
        }
        None
    }

    /// Whether the film that ends at `r.x` would, if it went on, need more than the pressure there is at the trailing edge:
    /// whether it has ruptured.
    fn let_go(&self, f: &Flow, r: &Ruptured) -> bool {
        self.face.tail(r.i, r.x).rise(f.u, f.v, r.q) >= f.pb
    }

    /// The ruptured film that carries `target`: Newton's method on the squeeze velocity and both places at once, `f.v` and
    /// `start` being the start.
    ///
    /// With the film at the leading edge ending where its gradient vanishes, its pressure there, `e`, changes by
    /// `-i3 dq + x3 dv`, and the load of both films does not change with the places themselves.
    fn loaded(&mut self, f: &Flow, cavitation: Cavitation, target: f64, start: Warm) -> Option<Ruptured> {
        let len = self.face.len();
        let (s0, s_len) = (self.face.s(0.0), self.face.s(len));
        let trailing = cavitation == Cavitation::MassConserving && f.pb > 0.0;
        let (mut v, mut x, mut xf) = (start.v, start.xr, start.xf);
        if !(xf > x && xf < len) {
            xf = 0.5 * (x + len);
        }
        for k in 0..16 {
            let i = self.face.piece_of(x);
            let m = self.lead_to(i, x);
            let (s, d) = (self.face.s(x), self.face.drop(i, x));
            let arm = s * m.i3 - m.x3;
            // A film of almost no length: too few digits here.
            if !(x > 0.0 && x < len && arm > 1e-3 * m.x3.abs()) {
                return None;
            }
            if k == 0 && x > 0.05 * len {
                // The velocity that belongs to a place changes less from film to film than the velocity.
                v = (f.pa + f.u * (m.d2 - d * m.i3)) / arm;
            }
            let rising = f.u * self.face.slope(i, x) + v;
            if rising.is_nan() || rising <= 0.0 {
                return None;
            }
            let q = f.u * d + v * s;
            let e = f.pa + m.pressure().rise(f.u, v, q);
            let (w, e_q) = (m.x3 / m.i3, e / m.i3);
            let mut g = w * e - s0 * f.pa - (f.u * m.e2 + v * m.xx3 - q * m.x3) - target;
            let mut g_v = w * m.x3 - m.xx3;
            let mut front = None;
            if trailing {
                let j = self.face.piece_of(xf);
                let n = self.trail_from(j, xf);
                let (sf, hf) = (self.face.s(xf), self.face.film() + self.face.drop(j, xf));
                let ih3 = 1.0 / (hf * hf * hf);
                let fv = Flow { v, ..*f };
                let (qf, dry) = self.carried_to(&fv, q, xf, true);
                let nf = self.n(&fv, j, xf, qf);
                // Flux of the trailing film: by itself, and with v.
                let (q_e, wf) = if dry { (0.0, sf) } else { (e_q, w) };
                let lever = n.x3 - sf * n.i3;
                let p = f.pb - n.pressure().rise(f.u, v, qf);
                let p_x = nf * ih3 + if dry { v * n.i3 } else { 0.0 };
                let (p_e, p_v) = (p + n.i3 * q_e, wf * n.i3 - n.x3);
                g += s_len * f.pb - sf * p - (f.u * n.e2 + v * n.xx3 - qf * n.x3) + lever * q_e;
                g_v += sf * n.x3 - n.xx3 + lever * wf;
                if dry {
                    // The flux moves with the front: dq = v dx.
                    g -= lever * v * p_e / p_x;
                    g_v -= lever * v * p_v / p_x;
                } else {
                    // What the load is off by while the front is.
                    g += 0.5 * p * p / p_x;
                }
                front = Some((j, p_e, p_v, p_x, nf, sf, dry));
            }
            let dv = -g / g_v;
            let dq = e_q + w * dv;
            let dx = (dq - s * dv) / rising;
            let next = x + dx;
            if !next.is_finite() {
                return None;
            }
            // Second order: what is left of steps of 1e-7 is near rounding.
            let mut settled = dx.abs() <= 1e-7 * x.min(len - x);
            let mut next_f = xf;
            if let Some((j, p_e, p_v, p_x, nf, sf, dry)) = front {
                let dxf = -(p_e + p_v * dv) / p_x;
                let drift = if dry { 0.0 } else { sf * dv - dq };
                settled &= dxf.abs() <= 1e-7 * (len - xf).min(xf - x) && drift.abs() <= 1e-7 * nf.abs();
                next_f = xf + dxf;
                if next_f.is_nan() {
                    return None;
                }
                settled &= self.face.piece_of(next_f) == j;
            }
            v += dv;
            if settled && self.face.piece_of(next) == i {
                let q = f.u * self.face.drop(i, next) + v * self.face.s(next);
                let mut found = Ruptured { v, i, x: next, q, front: None };
                let f = Flow { v, ..*f };
                if let Some((j, .., dry)) = front {
                    let (qf, late) = self.carried_to(&f, q, next_f, true);
                    if late != dry || next_f <= next || next_f >= len {
                        return None;
                    }
                    found.front = Some(Start { i: j, x: next_f, q: qf, dry });
                } else if f.pb > 0.0 && !self.let_go(&f, &found) {
                    return None;
                }
                return Some(found);
            }
            x = next.clamp(0.25 * x, 0.5 * (x + len));
            xf = next_f.clamp(0.5 * (x + xf.max(x)), 0.5 * (xf.max(x) + len));
        }
        None
    }

    /// Safeguarded Newton on the load, which never rises with `v`, from `f.v`; leaves the film that carries it.
    fn bracketed(
        &mut self,
        f: &mut Flow,
        cavitation: Cavitation,
        target: f64,
        unit: f64,
    ) -> Result<(), EvalError> {
        let (mut lo, mut hi) = (f64::NEG_INFINITY, f64::INFINITY);
        let mut v = f.v;
        let mut reach = 0.0_f64;
        for _ in 0..400 {
            f.v = v;
            self.search(f, cavitation)?;
            let c = self.carried(f);
            let g = c.load - target;
            if !(g.is_finite() && c.rate.is_finite()) {
                return Err(EvalError::recoverable(MODEL, "film out of range"));
            }
            // The rate of a film of no length is zero, of either sign.
            let step = g / c.rate.abs();
            if g.abs() <= 4.0 * f64::EPSILON * c.size || step.abs() <= 1e-15 * v.abs() {
                return Ok(());
            }
            if g > 0.0 {
                lo = v;
            } else {
                hi = v;
            }
            let mut next = v + step;
            if lo.is_finite() && hi.is_finite() {
                if !(next > lo && next < hi) {
                    next = 0.5 * (lo + hi);
                    if next == lo || next == hi {
                        f.v = next;
                        return self.search(f, cavitation);
                    }
                }
            } else {
                // A film that carries next to nothing does not say where it would carry more.
                reach = (4.0 * reach).max(v.abs()).max(unit);
                next = next.clamp(v - reach, v + reach);
            }
            if next.abs() > 1e30 {
                return Err(EvalError::recoverable(MODEL, "no squeeze velocity gives this load"));
            }
            v = next;
        }
        Err(no_convergence("squeeze velocity"))
    }
}
