//! Load, shear, fronts and fluxes of the film found on a line.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::{Film1dOut, FilmFront};

use super::cavity_shear::Shear;
use super::line::{Change, Line, volumes};
use super::panel::Stretch;
use super::sums::Sums;

impl Line {
    /// Load, shear and the rest of the film that was found, and the answers in the direction of `x`. `clip`: pressure is below
    /// zero where nothing has been done about it yet, and is cut off.
    pub fn finish(&mut self, shear: Shear, clip: bool, iterations: usize) -> Result<Film1dOut, EvalError> {
        let n = self.n;
        self.fronts.clear();
        let mut sums = Sums::default();
        let squeezed = self.change != Change::Steady;
        for i in 0..n {
            let (pa, pb) = (self.p[i], self.p[i + 1]);
            let s = self.stretch(i);
            // A bath at `p_cav` before a gap that widens makes no film.
            let full = if clip {
                pa >= 0.0 && pb >= 0.0
            } else {
                self.film[i] && (self.film[i + 1] || pa != 0.0 || pb != 0.0)
            };
            if full {
                // The flux of a changing gap is not constant: a parabola of pressure more.
                let more = if squeezed { self.squeeze_bulge(i) } else { 0.0 };
                sums.film(&s, self.u, self.q[i], (pa, pb), more);
            } else if clip {
                self.clipped(&mut sums, &s, i, shear);
            } else {
                self.partial(&mut sums, &s, i, shear);
            }
            if i > 0 {
                sums.step(if clip { pa.max(0.0) } else { pa }, s.ha - self.hb[i - 1]);
            }
        }
        if clip {
            self.p.iter_mut().for_each(|p| *p = p.max(0.0));
            for i in 0..n {
                self.q[i] = self.c[i] + self.g[i] * (self.p[i] - self.p[i + 1]);
            }
        } else {
            self.ruptures();
        }
        let highest = self.highest();
        let flux_error = self.flux_error();
        self.report(&sums, highest, flux_error, iterations)
    }

    /// Load of the parabola of pressure that storing oil adds in panel `i`.
    fn squeeze_bulge(&self, i: usize) -> f64 {
        let width = |i: usize| {
            0.5 * (if i > 0 { self.dx[i - 1] } else { 0.0 } + if i < self.n { self.dx[i] } else { 0.0 })
        };
        let v = 0.5 * (self.rate[i] / width(i) + self.rate[i + 1] / width(i + 1));
        let slender = 2.0 * self.dx[i] / (self.ha[i] + self.hb[i]);
        -self.thick[i] * v * slender * slender * slender
    }

    /// Adds panel `i`, which has no film or one behind a front.
    fn partial(&mut self, sums: &mut Sums, s: &Stretch, i: usize, shear: Shear) {
        let (q, floor, pb) = (self.q[i], self.p[i], self.p[i + 1]);
        let mut empty = *s;
        if pb > floor {
            let above = pb - floor;
            // To rounding the film may fill the panel.
            if above >= s.rise(self.u, q) * (1.0 - 1e-15) {
                sums.film(s, self.u, q, (floor, pb), 0.0);
                self.fronts.push(FilmFront { x: s.x, film_before: false });
                return;
            }
            let (x, h) = s.front(self.u, q, above, s.x);
            sums.film(&s.cut(x, h, true), self.u, q, (floor, pb), 0.0);
            self.fronts.push(FilmFront { x, film_before: false });
            empty = s.cut(x, h, false);
        }
        if empty.dx > 0.0 {
            sums.void(&empty, self.u, floor, empty.wet(self.u, q, shear, i < self.lead));
        }
    }

    /// Adds panel `i`, whose pressure is cut off at zero.
    fn clipped(&mut self, sums: &mut Sums, s: &Stretch, i: usize, shear: Shear) {
        let (pa, pb) = (self.p[i], self.p[i + 1]);
        let (high, low) = (pa.max(pb), pa.min(pb));
        let (mut top, mut part) = (0.0, 0.0);
        if high > 0.0 {
            (top, part) = (high, high / (high - low));
        }
        // A straight line of pressure between the nodes.
        let length = part * s.dx;
        let load = 0.5 * top * length;
        let at_b = pb > pa;
        let (x, inwards, edge) = if at_b { (s.x + s.dx, -1.0, s.hb * top) } else { (s.x, 1.0, -s.ha * top) };
        if part > 0.0 {
            self.fronts.push(FilmFront { x: x + inwards * length, film_before: !at_b });
        }
        let i1 = s.i1();
        let wet = match shear {
            Shear::Full => i1,
            // The flux of a film that is cut off does not tell how much oil is left there.
            Shear::None | Shear::Streamers => part * i1,
        };
        sums.void(s, self.u, 0.0, wet);
        let slope = s.slope;
        sums.load += load;
        sums.moment += load * (x + inwards * length / 3.0);
        sums.slope -= load * slope;
        sums.gradient += 0.5 * (edge - slope * load) * s.rough.pressure_shear;
    }

    /// The result of the sums, and the answers in the direction of `x`.
    pub fn report(
        &mut self,
        s: &Sums,
        (p_max, x_max): (f64, f64),
        flux_error: f64,
        iterations: usize,
    ) -> Result<Film1dOut, EvalError> {
        let (store_in, store_out) = self.ends_store();
        let (enters, leaves) = (self.q[0] + store_in, self.q[self.n - 1] - store_out);
        let shear = s.couette + s.gradient + s.difference;
        let sum = s.load + s.moment + shear + s.slope + enters + leaves + p_max + flux_error;
        if !sum.is_finite() {
            return Err(self.recoverable("film out of range"));
        }
        let sign = if self.turned { -1.0 } else { 1.0 };
        self.write_field();
        Ok(Film1dOut {
            load: s.load,
            moment: sign * s.moment,
            moving_shear: sign * shear,
            fixed_shear: sign * (s.couette - s.gradient - s.difference),
            slope_force: sign * s.slope,
            flux_in: if self.turned { -leaves } else { enters },
            flux_out: if self.turned { -enters } else { leaves },
            p_max: self.p_cav + p_max,
            x_p_max: sign * x_max,
            starved: self.starved,
            flux_error,
            iterations,
        })
    }

    /// Oil that the bath or the layer at either end must give or take beside the flux of the first or last panel.
    fn ends_store(&self) -> (f64, f64) {
        match self.change {
            Change::Steady => (0.0, 0.0),
            _ => (self.rate[0], self.rate[self.n]),
        }
    }

    /// Adds the fronts where a film ends downstream: between the last node under pressure and the first without film, moved to
    /// where the flux fills the gap without a gradient.
    fn ruptures(&mut self) {
        for k in 0..self.n {
            if !self.film[k] || self.film[k + 1] {
                continue;
            }
            let filled = 2.0 * self.q[k];
            let mut x = self.x[k + 1];
            for i in k..(k + 2).min(self.n) {
                let (ha, hb) = (self.ha[i], self.hb[i]);
                let (fa, fb) = {
                    let uf = self.u * self.rough[i].sliding_flow;
                    (uf * ha - filled, uf * hb - filled)
                };
                if fa <= 0.0 && fb > 0.0 {
                    x = self.x[i] + self.dx[i] * (fa / (fa - fb));
                }
            }
            // A cavity of one node may be as narrow as nothing; its film does not end behind the place where it begins again.
            let again = self.fronts.iter().filter(|f| !f.film_before && f.x >= self.x[k]);
            let x = again.map(|f| f.x).fold(x, f64::min);
            self.fronts.push(FilmFront { x, film_before: true });
        }
        self.fronts.sort_unstable_by(|a, b| a.x.total_cmp(&b.x).then(b.film_before.cmp(&a.film_before)));
    }

    /// Highest pressure above `p_cav` and where it is: at a node, or at the crest in a panel beside it.
    fn highest(&self) -> (f64, f64) {
        let mut k = 0;
        for (i, p) in self.p.iter().enumerate() {
            if *p > self.p[k] {
                k = i;
            }
        }
        let (mut high, mut x) = (self.p[k], self.x[k]);
        for i in k.saturating_sub(1)..(k + 1).min(self.n) {
            let (ha, hb, f) = (self.ha[i], self.hb[i], &self.rough[i]);
            let uf = self.u * f.sliding_flow;
            let h = 2.0 * self.q[i] / uf;
            if self.film[i] && h < ha && h > hb {
                let l = self.dx[i] * (ha - h) / (ha - hb);
                let k = 6.0 * self.mu[i] * l / f.pressure_flow;
                let p = self.p[i] + k * (uf - self.q[i] * (ha + h) / (ha * h)) / (ha * h);
                if p > high {
                    (high, x) = (p, self.x[i] + l);
                }
            }
        }
        (high, x)
    }

    /// See [`Film1dOut::flux_error`]: from the pressures and fills of the nodes alone.
    fn flux_error(&self) -> f64 {
        let n = self.n;
        let flux = |i: usize| self.c[i] * self.fill[i] + self.g[i] * (self.p[i] - self.p[i + 1]);
        let scale = |i: usize| self.c[i].max(self.g[i] * self.p[i].abs().max(self.p[i + 1].abs()));
        let stored = |i: usize| if self.change == Change::Steady { 0.0 } else { self.rate[i] };
        let (mut before, mut size) = (flux(0), scale(0));
        let mut largest: f64 = 0.0;
        for i in 1..n {
            let (now, here) = (flux(i), scale(i));
            let off = (before - now - stored(i)).abs();
            if off > 0.0 {
                let kept = match self.change {
                    Change::Steady => 0.0,
                    Change::Rates => self.rate[i].abs(),
                    Change::Step(dt) => self.volume[i] / dt,
                };
                let scale_here = size.max(here).max(kept);
                // A division only where it counts.
                if off > largest * scale_here {
                    largest = off / scale_here;
                }
            }
            (before, size) = (now, here);
        }
        largest
    }

    /// Writes the answers in the direction of `x`.
    fn write_field(&mut self) {
        let cav = self.p_cav;
        if self.change == Change::Steady || self.change == Change::Rates {
            volumes(&self.dx, &self.ha, &self.hb, &mut self.volume);
        }
        let n = self.n;
        if self.turned {
            for i in 0..=n {
                let j = n - i;
                self.field_p[i] = cav + self.p[j];
                self.field_fill[i] = self.fill[j];
                self.field_content[i] = self.fill[j] * self.volume[j];
            }
            self.field_flux.iter_mut().zip(self.q.iter().rev()).for_each(|(f, q)| *f = -q);
            self.fronts.reverse();
            for f in &mut self.fronts {
                *f = FilmFront { x: -f.x, film_before: !f.film_before };
            }
        } else {
            for i in 0..=n {
                self.field_p[i] = cav + self.p[i];
                self.field_fill[i] = self.fill[i];
                self.field_content[i] = self.fill[i] * self.volume[i];
            }
            self.field_flux.copy_from_slice(&self.q);
        }
    }

    /// A line without oil, of the inputs taken last.
    pub fn without_oil(&mut self) -> Film1dOut {
        self.fronts.clear();
        for v in [&mut self.p, &mut self.fill, &mut self.q] {
            v.fill(0.0);
        }
        self.write_field();
        Film1dOut { p_max: self.p_cav, x_p_max: self.nodes[0], ..Film1dOut::default() }
    }
}
