//! The search of the squeeze velocity at which a ring is in balance.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::{FaceForces, Limited, RadialLimits, RadialLoads, RadialResponse, RadialState};
use gudgeon_numerics::elementary;

/// Part of the velocity of surfaces that part within which one step of Newton ends at the root.
const PARTING: f64 = 1e-5;
/// Radial velocity over its limit at which a film carries nothing that it would lose at a higher one.
const AWAY: f64 = 1e3;

/// Most looks for the velocity that a film alone allows, and the step of Newton's method, over that velocity, behind which the next would be a millionth.
const FREE: usize = 60;
const NEAR: f64 = 1e-3;

/// Load of a film that is drawn apart, over the least that is asked of it, below which it counts as none.
const LEAST: f64 = 1e-6;

/// Largest of a load `w` and zero, smoothed over `floor`: equal to the load within `least²/w`.
pub fn soft(w: f64, floor: f64) -> f64 {
    0.5 * (w + (w * w + 4.0 * floor * floor).sqrt())
}

/// A velocity that no cap tells from a higher one \[m/s\].
const BEYOND: f64 = 1e9;

/// From 0 to 1, without a corner.
fn ramp(x: f64) -> f64 {
    x * x * (3.0 - 2.0 * x)
}

/// What is left of the load for the film, and how little of it a film is asked to carry \[N/m\].
#[derive(Debug, Clone, Copy)]
pub struct Needed {
    load: f64,
    floor: f64,
}

impl Needed {
    /// At an instant, with films that carry at least `least` of the tension.
    pub fn of(at: &RadialState, least: f64) -> Self {
        Self { load: at.load - at.contact - at.dry, floor: least * at.tension }
    }

    /// The size of it.
    pub fn size(&self) -> f64 {
        self.soft().max(self.load.abs())
    }

    fn soft(&self) -> f64 {
        soft(self.load, self.floor)
    }

    /// What a film is asked to carry beyond what is needed against what resists.
    pub fn lifted(&self, resisted: &Resisted) -> f64 {
        let w = self.load + resisted.force;
        soft(w, self.floor) - w
    }

    /// What a film that carries `load` lacks.
    pub fn lacks(&self, load: f64, resisted: &Resisted) -> f64 {
        soft(self.load + resisted.force, self.floor) - load
    }

    /// The velocity at which film and what resists are in balance, by a step of Newton's method from `v`: for the load that the film is asked for, or where gas lifts the ring
    /// for what is needed, by what the film carries.
    pub fn velocity(&self, v: f64, film: &FaceForces, resisted: &Resisted) -> f64 {
        let (w, floor) = (self.load + resisted.force, self.floor);
        let (lacks, slope) = if w >= 0.0 {
            let all = soft(w, floor);
            (all - film.load, film.squeeze_damping + resisted.slope * all / (2.0 * all - w))
        } else {
            let load = film.load.max(LEAST * floor);
            let damping = film.squeeze_damping * (1.0 + (floor / load).powi(2));
            (w - load + floor * floor / load, damping + resisted.slope)
        };
        v - (lacks / slope.max(f64::MIN_POSITIVE)).clamp(-BEYOND, BEYOND)
    }
}

/// What resists the motion of a ring beside its film \[N/m\], and its derivative \[N s/m²\].
#[derive(Debug, Clone, Copy)]
pub struct Resisted {
    pub force: f64,
    pub slope: f64,
}

/// The search of one instant.
pub struct Search<'a> {
    pub limits: &'a RadialLimits,
    pub ring: usize,
    /// Velocity of the last instant \[m/s\], a small step away: a good start.
    pub hdot: f64,
    /// Whether what was found is a root of the balance that no limit has changed.
    pub balanced: bool,
}

impl Search<'_> {
    /// Squeeze velocity from the radial balance.
    pub fn rate(&mut self, loads: &mut dyn RadialLoads) -> Result<RadialResponse, EvalError> {
        let at = *loads.state();
        let needed = Needed::of(&at, self.limits.min_load);
        if !at.resists {
            return Ok(self.without_film(&at, needed.load));
        }
        if at.thickness <= at.lowest.0
            && let Some(film) = on_floor(loads, needed)?
        {
            self.hdot = 0.0;
            return Ok(RadialResponse::new(0.0, Some(film), Limited::default()));
        }
        let mut limited = Limited::default();
        let (found, film) = self.balance(loads, &at, needed)?;
        let parts = at.contact > 0.0 && found > 0.0;
        let dragged = if parts { found } else { self.dragged(loads, found, needed, &mut limited)? };
        let hdot = self.bounded(&at, dragged, &mut limited);
        // Off its limits a ring moves as its film allows, and the film found with the velocity is the film of the instant.
        self.balanced = (hdot - found).abs() <= 1e-6 * found.abs();
        limited.lifted = needed.soft() - needed.load;
        if parts {
            limited.contact_drag = self.contact_drag(&at) * found;
        }
        self.hdot = hdot;
        Ok(RadialResponse::new(hdot, film.filter(|_| self.balanced), limited))
    }

    /// The velocity at which film and contact carry what is needed, surfaces that part against their drag; and the film, where it came with the
    /// velocity.
    fn balance(
        &mut self,
        loads: &mut dyn RadialLoads,
        at: &RadialState,
        needed: Needed,
    ) -> Result<(f64, Option<FaceForces>), EvalError> {
        let drag = self.contact_drag(at);
        if at.faces > 1 || at.has_friction {
            return Ok((self.root(loads, needed, drag)?, None));
        }
        // A ring that parted from the liner an instant ago still does, most often.
        let parting = drag > 0.0 && self.hdot > 0.0;
        if parting {
            let hdot = self.root(loads, needed, drag)?;
            if hdot > 0.0 {
                return Ok((hdot, None));
            }
        }
        let (hdot, film) = match loads.carry(needed.soft()) {
            Ok((hdot, film)) => (hdot, Some(film)),
            Err(e) => (self.beyond_limits(loads, needed.soft(), e)?, None),
        };
        loads.flux()[0] = film.map_or(0.0, |f| f.flux);
        if drag == 0.0 || hdot <= 0.0 || parting {
            return Ok((hdot, film));
        }
        self.hdot = 0.0;
        Ok((self.root(loads, needed, drag)?, None))
    }

    /// A velocity beyond every limit, for a film that carries more than `load` however fast it is drawn apart: on a coarse grid the pressures at the
    /// edges reach as far in as a point. The limits of the velocity, which it nears as the load falls, then decide; any other failure stays one.
    fn beyond_limits(
        &self,
        loads: &mut dyn RadialLoads,
        load: f64,
        failure: EvalError,
    ) -> Result<f64, EvalError> {
        let away = AWAY * self.limits.radial_speed;
        let carries =
            failure.is_recoverable() && loads.film_load(away).is_ok_and(|(carried, _)| carried > load);
        if carries { Ok(away) } else { Err(failure) }
    }

    /// A ring without a film: its contact carries it, and the drag in place of its inertia brings it there.
    fn without_film(&mut self, at: &RadialState, needed: f64) -> RadialResponse {
        let mut limited = Limited::default();
        let free = if at.carries { -needed / self.limits.radial_drag } else { 0.0 };
        let hdot = self.bounded(at, free, &mut limited);
        limited.drag = self.limits.radial_drag * hdot.abs();
        self.hdot = hdot;
        RadialResponse::new(hdot, Some(FaceForces::default()), limited)
    }

    /// What the cap leaves of a radial velocity, as a part of it.
    fn part(&self, free: f64) -> f64 {
        1.0 / (1.0 + (free / self.limits.radial_speed).powi(2)).sqrt()
    }

    /// A radial velocity within its cap.
    pub fn capped(&self, free: f64) -> f64 {
        free * self.part(free)
    }

    /// The same within the ends of the way.
    pub fn bounded(&self, at: &RadialState, free: f64, limited: &mut Limited) -> f64 {
        let (h, (lowest, band), furthest) = (at.thickness, at.lowest, at.furthest);
        let part = self.part(free);
        limited.slowed = 1.0 - part;
        if free > 0.0 {
            free * part * ((furthest - h) / (self.limits.retreat_band * furthest)).clamp(0.0, 1.0)
        } else if lowest > 0.0 {
            free * part * ((h - lowest) / (band * lowest)).clamp(0.0, 1.0)
        } else {
            free * part
        }
    }

    /// Squeeze velocity with the drag of a ring in place of its inertia: `W(v) = needed + D v`; `free` is that without.
    fn dragged(
        &self,
        loads: &mut dyn RadialLoads,
        free: f64,
        needed: Needed,
        limited: &mut Limited,
    ) -> Result<f64, EvalError> {
        let drag = self.drag(loads.state(), free, needed.size());
        if drag <= 0.0 {
            return Ok(free);
        }
        // The load of the film falls with v and what it has to carry rises: one zero, between standing still and `free`.
        let (mut lo, mut hi) = if free < 0.0 { (free, 0.0) } else { (0.0, free) };
        let mut v = free.clamp(-self.limits.radial_speed, self.limits.radial_speed);
        for _ in 0..60 {
            let (load, rate) = loads.film_load(v)?;
            let w = needed.load + drag * v;
            let all = soft(w, needed.floor);
            let (g, derivative) = (load - all, rate - drag * all / (2.0 * all - w));
            if g > 0.0 {
                lo = v
            } else {
                hi = v
            }
            let next = v - g / derivative;
            let next = if next > lo && next < hi { next } else { 0.5 * (lo + hi) };
            if (next - v).abs() <= 1e-10 * v.abs() {
                break;
            }
            v = next;
        }
        limited.drag = drag * v.abs();
        Ok(v)
    }

    /// Drag per circumference \[N s/m²\] at the velocity `free` that the film alone allows; `load` is the size of what it carries.
    pub fn drag(&self, at: &RadialState, free: f64, load: f64) -> f64 {
        let limits = self.limits;
        let share = limits.radial_drag * free.abs() / load;
        let ((begins, full), off) = (limits.drag_counts, self.off(at));
        if share <= begins || off <= 0.0 {
            return 0.0;
        }
        let x = (elementary::ln(share / begins) / elementary::ln(full / begins)).min(1.0);
        limits.radial_drag * ramp(x) * ramp(off)
    }

    /// How far a ring is off the liner, from where its drag counts (0) to where it does in full.
    fn off(&self, at: &RadialState) -> f64 {
        let (near, far) = self.limits.drag_gap;
        ((at.thickness / at.contact_range - near) / (far - near)).min(1.0)
    }

    /// Whether a ring is so far off the liner that its drag may count.
    pub fn is_off(&self, at: &RadialState) -> bool {
        self.off(at) > 0.0
    }

    /// The same where the drag leaves the velocity `v`, at which the film is `film`: the film alone would allow a higher one, which is looked for as far as the drag changes
    /// with it.
    pub fn drag_at(
        &self,
        loads: &mut dyn RadialLoads,
        needed: Needed,
        (v, film): (f64, &FaceForces),
    ) -> Result<f64, EvalError> {
        let at = *loads.state();
        if !self.is_off(&at) {
            return Ok(0.0);
        }
        let load = needed.size();
        let fastest = (self.limits.drag_counts.1 * load / self.limits.radial_drag).copysign(v);
        let holds = v.abs() < fastest.abs();
        let free = if holds { alone(loads, needed.soft(), (v, film), fastest)? } else { v };
        Ok(self.drag(&at, free, load))
    }

    /// Drag per circumference \[N s/m²\] of surfaces in contact, while they part.
    pub fn contact_drag(&self, at: &RadialState) -> f64 {
        let (contact, load) = (at.contact, at.load);
        if contact > 0.0 { self.limits.contact_drag * contact / (contact + load.abs()) } else { 0.0 }
    }

    /// Balance of several faces, with flank friction, or with the drag of surfaces that part: film load less needed load falls with `hdot`; bracket
    /// and Newton.
    fn root(&self, loads: &mut dyn RadialLoads, needed: Needed, drag: f64) -> Result<f64, EvalError> {
        let (mut lo, mut hi) = (f64::NEG_INFINITY, f64::INFINITY);
        let mut x = if self.hdot.is_finite() { self.hdot } else { 0.0 };
        let scale = needed.soft().abs().max(1e-300);
        let mut stride = 1e-4;
        for _ in 0..200 {
            let (f, d) = residual(loads, needed, drag, x)?;
            if f.abs() <= 1e-12 * scale {
                return Ok(x);
            }
            // Newton's method squares a small error: the next step from here ends within 1e-9.
            let newton = x - f / d;
            // A film that is drawn apart is nearly flat in its velocity, which a small part of the load determines poorly.
            let parts = drag > 0.0 && x > 0.0;
            let near = if parts { (newton - x).abs() <= PARTING * x } else { f.abs() <= 1e-5 * scale };
            if near && newton.is_finite() && (drag == 0.0 || (newton > 0.0) == (x > 0.0)) {
                return Ok(newton);
            }
            if f > 0.0 {
                lo = x
            } else {
                hi = x
            }
            let bracketed = lo.is_finite() && hi.is_finite();
            let inside = newton.is_finite() && newton > lo && newton < hi;
            let next = if inside && (bracketed || (newton - x).abs() <= 1e3 * stride) {
                newton
            } else if bracketed {
                0.5 * (lo + hi)
            } else {
                stride *= 8.0;
                if f > 0.0 { x + stride } else { x - stride }
            };
            if bracketed && (hi - lo) <= 1e-14 * (hi.abs().max(lo.abs())) + 1e-18 || next == x {
                return Ok(x);
            }
            x = next;
        }
        let what = format!("radial balance of ring {} did not converge", self.ring + 1);
        Err(EvalError::recoverable("ring_pack", what))
    }
}

/// The velocity at which a film alone carries `load`, from `v` on as far as `fastest`; `v` itself where the film would be slower. At `v` it is `film`.
fn alone(
    loads: &mut dyn RadialLoads,
    load: f64,
    (v, film): (f64, &FaceForces),
    fastest: f64,
) -> Result<f64, EvalError> {
    // More than it must carry on the way out, less on the way in.
    let surplus = |carried: f64| fastest.signum() * (carried - load);
    if surplus(film.load) <= 0.0 {
        return Ok(v);
    }
    let inside = |x: f64, slow: f64, fast: f64| (x - slow) * (x - fast) < 0.0;
    let follows = v + (film.load - load) / film.squeeze_damping;
    let (mut slow, mut fast) = (v, fastest);
    let mut free = if inside(follows, slow, fast) { follows } else { fastest };
    for _ in 0..FREE {
        let (carried, rate) = loads.film_load(free)?;
        if surplus(carried) > 0.0 {
            slow = free;
        } else {
            fast = free;
        }
        let next = free - (carried - load) / rate;
        if slow == fastest || (next - free).abs() <= NEAR * free.abs() {
            return Ok(if slow == fastest { fastest } else { next });
        }
        free = if inside(next, slow, fast) { next } else { 0.5 * (slow + fast) };
    }
    Ok(free)
}

/// On the floor: the film at rest, where it carries less than it must.
fn on_floor(loads: &mut dyn RadialLoads, needed: Needed) -> Result<Option<FaceForces>, EvalError> {
    let film = loads.film(0.0)?;
    let all = soft(needed.load + loads.friction(0.0).0, needed.floor);
    Ok((film.load <= all).then_some(film))
}

/// Load of the film less what it has to carry at `x`, and its derivative.
fn residual(loads: &mut dyn RadialLoads, needed: Needed, drag: f64, x: f64) -> Result<(f64, f64), EvalError> {
    let (load, rate) = loads.film_load(x)?;
    let (fa, dfa) = loads.friction(x);
    let (w, derivative) =
        if x > 0.0 { (needed.load + fa + drag * x, dfa + drag) } else { (needed.load + fa, dfa) };
    let all = soft(w, needed.floor);
    Ok((load - all, rate - derivative * all / (2.0 * all - w)))
}
