use gudgeon_core::kinds::{
    Film1d, Film1dCtx, Film1dIn, Film1dOut, Film1dScope, Film1dSpec, FilmField, FilmFront,
};
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

use super::cavity_shear::{LineCavityShear, Shear};
use super::line::{Change, Line};
use super::panel::Stretch;
use super::sums::Sums;
use crate::cavitation::Cavitation;

/// Steady mass-conserving film along a line with its fronts where they are, between nodes too: exact for a gap that is linear
/// in each panel, with any number of cavities.
///
/// The flux `q` is the same everywhere. A film ends where pressure and gradient vanish, `u h/2 = q`, carries `q` through the cavity
/// and begins again where the pressure, counted back from its end, has come down to `p_cav`:
///
/// `p(x) = p_e - ∫_x 12 μ (u h/2 - q)/h³ dx`,
///
/// every integral in closed form. The film at the inlet decides the flux: with `C(x) = ∫_0 6 μ u/h² dx` and
/// `R(x) = ∫_0 12 μ/h³ dx` it is the largest that leaves no pressure below `p_cav`,
///
/// `q = min_x (p_0 - p(x) + C(x))/R(x)`, `p(x)` zero inside the line and the given pressure at its end,
///
/// a root of a concave function that Newton's method approaches from one side.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FrontTracking {
    /// Friction of the oil that is left in the cavity.
    #[serde(default)]
    pub cavity_shear: LineCavityShear,
}

const MODEL: &str = "front_tracking";

#[register_model(
    name = "front_tracking",
    summary = "steady mass-conserving film along a line, exact for profiles of straight pieces",
    equations = "p' = 12 mu/phi_p (u phi_s h/2 - q)/h^3, integrated in closed form;  rupture: p = p_cav, u phi_s h/2 = q;  \
                reformation: p = p_cav counted back from the end of the film;  q = min_x (p_0 - p(x) + C(x))/R(x);  \
                load = int (p - p_cav) dx;  shear = int (mu u/h -+ h p'/2) dx, in the cavity with 2 q/(u h) of the width",
    validity = "Steady films: a gap that changes with time is refused. Narrow gap, no flow across the line, incompressible oil, \
               viscosity and roughness constant in each panel.",
    references = ["reynolds1886", "jakobsson1957"],
    example = "cavity_shear = \"streamers\"\n",
)]
impl Film1dSpec for FrontTracking {
    fn scope(&self) -> Film1dScope {
        Film1dScope { starved: true, squeeze: false, steps: false }
    }
    fn same_equations(&self) -> &'static [&'static str] {
        &["complementarity"]
    }
    fn build(&self, ctx: &Film1dCtx<'_>) -> Result<Box<dyn Film1d>, BuildError> {
        ctx.check()?;
        Ok(Box::new(Film {
            line: Line::new(MODEL, ctx),
            shear: self.cavity_shear.decided(Cavitation::MassConserving),
        }))
    }
}

struct Film {
    line: Line,
    shear: Shear,
}

impl Film1d for Film {
    fn solve(&mut self, inp: &Film1dIn<'_>) -> Result<Film1dOut, EvalError> {
        let line = &mut self.line;
        line.enter(inp, true)?;
        if line.change != Change::Steady {
            return Err(line.fatal("a gap that changes with time needs another model"));
        }
        let (mut q, passes) = flux(line).ok_or_else(|| line.recoverable("no convergence of the flux"))?;
        if let Some(supply) = line.supply
            && supply < q
        {
            line.starved = true;
            q = supply;
        }
        let mut sweep = Sweep::new(line, q, self.shear);
        sweep.run(0.0, 0, false);
        if sweep.line.starved && sweep.line.p_in > 0.0 {
            let gas = sweep.line.p_in;
            // Before the place nearest to the inlet that has the pressure of the gas, there is gas.
            let node = sweep.line.p.iter().position(|p| *p >= gas);
            let crest = sweep.crest_above(gas).filter(|i| node.is_none_or(|n| *i < n));
            if node.is_none() && crest.is_none() {
                // A film that nowhere reaches the pressure of the gas lets it through to the end.
                sweep.line.p_out = gas;
            }
            sweep.run(gas, crest.or(node).unwrap_or(sweep.line.n), crest.is_some());
        }
        let (sums, highest, off) = (sweep.sums, sweep.highest, sweep.off);
        line.fronts.reverse();
        line.report(&sums, highest, off, passes + 1)
    }

    fn field(&self) -> FilmField<'_> {
        self.line.field()
    }

    fn full_content(&self, h_a: &[f64], h_b: &[f64], content: &mut [f64]) {
        self.line.full_content(h_a, h_b, content);
    }
}

/// Flux of the film at the inlet, were it flooded, and the passes that it took.
fn flux(line: &Line) -> Option<(f64, usize)> {
    let n = line.n;
    let u = line.u;
    let total: f64 = line.d.iter().sum();
    let rise: f64 = line.c.iter().zip(&line.d).map(|(c, d)| c * d).sum();
    let mut q = (line.p_in - line.p_out + rise) / total;
    if line.p_in <= 0.0 {
        // Without pressure at the inlet it has to rise from there, or there is a void from there.
        q = q.min(0.5 * u * line.rough[0].sliding_flow * line.ha[0]);
    }
    for pass in 1..200 {
        // Lowest pressure of the film with this flux, and the resistance up to there.
        let (mut low, mut over) = (0.0, 1.0);
        let (mut p, mut resistance, mut size) = (line.p_in, 0.0, line.p_in);
        for i in 0..n {
            let s = line.stretch(i);
            let full = s.filled(u, q);
            if s.ha < s.hb
                && let Some(x) = s.place(full)
            {
                let part = s.cut(x, full, false);
                let at = p + part.rise(u, q);
                if at < low {
                    (low, over) = (at, resistance + part.resistance());
                }
            }
            p += (line.c[i] - q) * line.d[i];
            resistance += line.d[i];
            size = size.max(p);
            if i + 1 < n && p < low {
                (low, over) = (p, resistance);
            }
        }
        let next = q + low / over;
        if low >= -1e-15 * size || next == q {
            return Some((next, pass));
        }
        q = next;
        if !q.is_finite() {
            return None;
        }
    }
    None
}

/// The line counted back from its last node.
struct Sweep<'a> {
    line: &'a mut Line,
    u: f64,
    q: f64,
    shear: Shear,
    sums: Sums,
    highest: (f64, f64),
    /// Flux that the pressure missed at the inlet would drive, over the flux of sliding or pressure.
    off: f64,
    /// What was added last is no film.
    open: bool,
}

impl<'a> Sweep<'a> {
    fn new(line: &'a mut Line, q: f64, shear: Shear) -> Self {
        let u = line.u;
        Self { line, u, q, shear, sums: Sums::default(), highest: (0.0, 0.0), off: 0.0, open: false }
    }

    /// Where the film in a stretch that narrows has a crest, and the pressure there, with `pb` at the end: the gap is less than
    /// filled by the flux from there on, so that a film it is.
    fn crest(&self, s: &Stretch, pb: f64) -> Option<(f64, f64)> {
        let h = s.filled(self.u, self.q);
        let x = if s.ha > s.hb { s.place(h) } else { None };
        x.map(|x| (x, pb - s.cut(x, h, true).rise(self.u, self.q)))
    }

    /// First panel with a crest of pressure of `p` or more.
    fn crest_above(&self, p: f64) -> Option<usize> {
        (0..self.line.n).find(|i| {
            let crest = self.crest(&self.line.stretch(*i), self.line.p[*i + 1]);
            crest.is_some_and(|(_, high)| high >= p)
        })
    }

    /// Finds all films. Where the pressure of the `gas` is reached first, at node `sealed` or at the crest in the panel behind it,
    /// it goes no lower on the way from there to the inlet.
    fn run(&mut self, gas: f64, sealed: usize, at_crest: bool) {
        let n = self.line.n;
        self.sums = Sums::default();
        self.open = false;
        self.line.fronts.clear();
        self.line.q.fill(self.q);
        self.line.p[n] = self.line.p_out;
        self.highest = (self.line.p_out, self.line.x[n]);
        let mut p = self.line.p_out;
        for i in (0..n).rev() {
            let s = self.line.stretch(i);
            if i + 1 < n {
                self.sums.step(p, self.line.ha[i + 1] - s.hb);
            }
            let vented = i < sealed || (at_crest && i == sealed);
            let floor = if vented { gas } else { 0.0 };
            p = match self.crest(&s, p) {
                Some((x, high)) if at_crest && i == sealed => {
                    let h = s.filled(self.u, self.q);
                    self.film(&s.cut(x, h, true), high, p);
                    self.panel(i, &s.cut(x, h, false), high, gas, true)
                }
                _ => self.panel(i, &s, p, floor, vented),
            };
            self.line.p[i] = p;
            let full = s.filled(self.u, self.q);
            let film = p > floor || s.ha <= full;
            self.line.film[i] = film;
            self.line.fill[i] = if film { 1.0 } else { (full / s.ha).clamp(0.0, 1.0) };
        }
        if !self.line.starved {
            let size = self.line.c[0].max(self.line.g[0] * self.line.p_in).max(self.q.abs());
            let missed = (p - self.line.p_in).abs() / self.line.d.iter().sum::<f64>();
            self.off = if size > 0.0 { missed / size } else { 0.0 };
            self.line.p[0] = self.line.p_in;
            self.line.film[0] = true;
            self.line.fill[0] = 1.0;
        }
        self.line.outlet();
    }

    /// Panel `i` with the pressure `pb` at its end; returns that at its beginning.
    fn panel(&mut self, i: usize, s: &Stretch, pb: f64, floor: f64, vented: bool) -> f64 {
        let (u, q) = (self.u, self.q);
        let full = s.filled(u, q);
        let mut s = *s;
        if pb > floor {
            // Lowest pressure on the way back: inside, where the gap widens along x, or at the beginning.
            let valley = if s.ha < s.hb { s.place(full) } else { None };
            let pa = pb - s.rise(u, q);
            let low = valley.map_or(pa, |x| pb - s.cut(x, full, true).rise(u, q));
            let front = (low < floor).then(|| s.front(u, q, pb - floor, valley.unwrap_or(s.x)));
            // The flux was made so that a film from the inlet begins there, but for rounding.
            let inlet = i == 0 && !self.line.starved;
            let Some((x, h)) = front.filter(|(x, _)| !(inlet && x - s.x <= 1e-9 * s.dx)) else {
                self.film(&s, pa.max(floor), pb);
                return pa.max(floor);
            };
            self.film(&s.cut(x, h, true), floor, pb);
            self.line.fronts.push(FilmFront { x, film_before: false });
            s = s.cut(x, h, false);
        } else if s.hb <= full && (s.ha <= full || s.hb < full) {
            // A film ends at the node itself, or goes on through it.
            if let Some(x) = s.place(full).filter(|_| s.ha > s.hb) {
                // It is highest inside, and may begin there.
                let behind = s.cut(x, full, true);
                let high = floor - behind.rise(u, q);
                self.film(&behind, high, floor);
                return self.panel(i, &s.cut(x, full, false), high, floor, vented);
            }
            let pa = (floor - s.rise(u, q)).max(floor);
            self.film(&s, pa, floor);
            return pa;
        }
        if s.dx <= 0.0 {
            return floor;
        }
        // A film that would begin again within rounding of the node belongs to the panel before.
        let rupture = if s.ha < s.hb { s.place(full) } else { None };
        match rupture.filter(|x| x - s.x > 1e-12 * s.dx) {
            Some(x) => {
                self.void(&s.cut(x, full, true), floor, vented);
                let film = s.cut(x, full, false);
                let pa = floor - film.rise(u, q);
                self.film(&film, pa, floor);
                pa
            }
            None => {
                self.void(&s, floor, vented);
                floor
            }
        }
    }

    fn film(&mut self, s: &Stretch, pa: f64, pb: f64) {
        if s.dx <= 0.0 {
            return;
        }
        if std::mem::take(&mut self.open) {
            self.line.fronts.push(FilmFront { x: s.x + s.dx, film_before: true });
        }
        self.sums.film(s, self.u, self.q, (pa, pb), 0.0);
        for (x, p) in [Some((s.x, pa)), self.crest(s, pb)].into_iter().flatten() {
            if p > self.highest.0 {
                self.highest = (p, x);
            }
        }
    }

    fn void(&mut self, s: &Stretch, p: f64, vented: bool) {
        if s.dx <= 0.0 {
            return;
        }
        self.open = true;
        let wet = s.wet(self.u, self.q, self.shear, vented);
        self.sums.void(s, self.u, p, wet);
    }
}
